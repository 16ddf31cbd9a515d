#!/bin/sh
# Plays packs on a machine with an NVIDIA GPU and compares every frame's hash with the packs' golden hashes, which a CPU made:
#   tests/gpu.sh PLAYER PACK...        e.g. tests/gpu.sh build/release/vitrine-play build/demo/*.vit
# Needs no compiler, Embree or PoCL there. VIT_LIBS: a folder with libOpenCL.so.1 and libpng16.so.16, if the machine has none.
# Exit: 0 all equal, 1 no GPU, 4 a hash differs. The last line counts passed and failed comparisons.
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
    trap 'rm -rf "$OCL_ICD_VENDORS"' EXIT
fi
"$player" --list-devices || exit 1
device=$("$player" --list-devices | grep -i nvidia | head -1 | sed 's/[^0-9].*//')
[ -n "$device" ] || { echo "gpu.sh: no NVIDIA device"; exit 1; }
other=$("$player" --list-devices | grep -vi nvidia | head -1 | sed 's/[^0-9].*//')
passed=0 failed=0
compare() { # pack, options
    if out=$("$player" "$1" $2 --verify 2>&1); then
        passed=$((passed + 1)); echo "equal    $1 $2: $out"
    else
        failed=$((failed + 1)); echo "DIFFERS  $1 $2: $out"
    fi
}
for pack in "$@"; do
    for how in "--lanes 1" "--lanes 8" "--lanes 16" "--lanes 1 --group 1" "--lanes 1 --group 32" "--lanes 1 --group 256"; do
        compare "$pack" "--device $device $how"
    done
    [ -z "$other" ] || compare "$pack" "--device $other"
    "$player" "$pack" --device "$device" --report 2>&1 | sed -n '1,/frame, seen/p'
done
echo "$passed passed, $failed failed"
[ "$failed" = 0 ] || exit 4
