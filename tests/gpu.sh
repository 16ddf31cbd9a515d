#!/bin/sh
# Plays packs on a machine with an NVIDIA GPU. Every frame's hash must be the pack's golden hash, which a CPU made; every count of
# work must be, to the byte, that of the file beside the pack (scene.work for scene.vit, from vitrine-play --write-work-budget on a
# CPU), or else of the first way of playing it here:
#   tests/gpu.sh PLAYER PACK...        e.g. tests/gpu.sh build/release/vitrine-play build/demo/*.vit
# Needs no compiler, Embree or PoCL there. VIT_LIBS: a folder with libOpenCL.so.1 and libpng16.so.16, if the machine has none.
# Exit: 0 all equal, 1 no GPU, 4 a hash or a count differs. The last line counts passed and failed comparisons.
set -u
[ $# -ge 2 ] || { echo "usage: tests/gpu.sh PLAYER PACK..."; exit 2; }
player=$1; shift
[ -z "${VIT_LIBS:-}" ] || export LD_LIBRARY_PATH="$VIT_LIBS${LD_LIBRARY_PATH:+:$LD_LIBRARY_PATH}"
# The loader finds drivers through .icd files; make one where NVIDIA's driver came without.
if ! grep -qi nvidia /etc/OpenCL/vendors/*.icd 2>/dev/null && [ -z "${OCL_ICD_VENDORS:-}" ]; then
    OCL_ICD_VENDORS=$(mktemp -d)
    cp /etc/OpenCL/vendors/*.icd "$OCL_ICD_VENDORS" 2>/dev/null
    echo libnvidia-opencl.so.1 > "$OCL_ICD_VENDORS/nvidia.icd"
    export OCL_ICD_VENDORS
    made_icd=yes
fi
work=$(mktemp -d)
trap 'rm -rf "$work"; [ -z "${made_icd:-}" ] || rm -rf "$OCL_ICD_VENDORS"' EXIT
"$player" --list-devices || exit 1
device=$("$player" --list-devices | grep -i nvidia | head -1 | sed 's/[^0-9].*//')
[ -n "$device" ] || { echo "gpu.sh: no NVIDIA device"; exit 1; }
other=$("$player" --list-devices | grep -vi nvidia | head -1 | sed 's/ .*//')
passed=0 failed=0
compare() { # pack, options
    if out=$("$player" "$1" $2 --verify 2>&1); then
        passed=$((passed + 1)); echo "equal    $1 $2: $out"
    else
        failed=$((failed + 1)); echo "DIFFERS  $1 $2: $out"
    fi
}
count() { # pack, options; the counts that they must equal are in $work/first
    if ! out=$("$player" "$1" $2 --quiet --write-work-budget "$work/counts" 2>&1); then
        failed=$((failed + 1)); echo "FAILED   $1 $2: $out"; return
    fi
    [ -e "$work/first" ] || { cp "$work/counts" "$work/first"; echo "counts   $1 $2: the others are compared with these"; return; }
    if out=$(diff "$work/first" "$work/counts"); then
        passed=$((passed + 1)); echo "equal    $1 $2: $(wc -l < "$work/counts") lines of counts"
    else
        failed=$((failed + 1)); echo "DIFFERS  $1 $2: counts:"; echo "$out" | head -4
    fi
}
for pack in "$@"; do
    rm -f "$work/first"
    [ ! -e "${pack%.vit}.work" ] || cp "${pack%.vit}.work" "$work/first"
    for how in "--lanes 1" "--lanes 8" "--lanes 16" "--lanes 1 --group 1" "--lanes 1 --group 32" "--lanes 1 --group 256"; do
        compare "$pack" "--device $device $how"
    done
    [ -z "$other" ] || compare "$pack" "--device $other"
    for how in "--lanes 1" "--lanes 8" "--lanes 16" "--lanes 1 --group 256"; do
        count "$pack" "--device $device $how"
    done
    [ -z "$other" ] || count "$pack" "--device $other"
    "$player" "$pack" --device "$device" --report 2>&1 | sed -n '1,/frame, seen/p'
done
echo "$passed passed, $failed failed"
[ "$failed" = 0 ] || exit 4
