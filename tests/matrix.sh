#!/bin/sh
# The determinism matrix: every way of playing a pack that this machine offers must give the pack's golden hashes. A line a row: equal, DIFFERS or
# absent; exit 4 if any differs or cannot be played.
#   tests/matrix.sh [folder of the tools, default build/release] [folder for packs and cross builds, default build/matrix]
# Looked for: PoCL (devices, threads, work-group methods), Intel's OpenCL runtime ($INTEL_OPENCL: folder of libintelocl.so, as pip's intel-opencl-rt
# unpacks it), Oclgrind, the built-in device host with each instruction set, and cross compilers with qemu-user for other machines.
# VITRINE_MATRIX=smoke: one tiny pack and a way or two of each kind, so that none of this rots.
set -u
tools=$(cd "${1:-build/release}" && pwd) out=${2:-build/matrix} failed=0 rows=0
mkdir -p "$out" && out=$(cd "$out" && pwd)
packs="list zones buckets atrium shine basis basis-still basis-shine points points-shine progressive-shine live-float32 live-float16 live-log8 live-bc1 live-sparse live-shine" strict_packs="list zones buckets raw atrium shine basis basis-shine points-shine progressive-shine live-bc1 live-sparse" widths="1 8 16" threads_tried="1 2" devices="basic pthread"
if [ "${VITRINE_MATRIX:-}" = smoke ]; then packs="tiny-zones tiny-basis tiny-points-shine tiny-progressive-shine tiny-live-sparse" strict_packs="zones basis live-sparse" widths=8 threads_tried=2 devices=pthread; fi
row() { # name, then a command that plays $pack and exits 0 if every hash is the pack's
    label=$1 && shift
    rows=$((rows + 1))
    text=$("$@" 2>&1) && echo "equal    $label" && return
    case $?:$text in # the status of what played
    4:*) failed=$((failed + 1)); echo "DIFFERS  $label: $text" | head -3 ;;
    *) failed=$((failed + 1)); echo "FAILED   $label: $text" | head -3 ;;
    esac
}
absent() { echo "absent   $1"; }
bake() { "$tools/vitrine-bake" "$tools/scenes/$1.cfg" -o "$out/$2.vit" --quiet --no-check --device host --frames 2 --indirect photons $3 || exit 1; }
whole() { # the packs that a smoke run leaves out
    bake cornell list "--size 128x96 --photons 4000 --indirect-samples 1"
    bake cornell zones "--size 100x70 --photons 4000 --zones 2 --effective-area 1 --kernel flattened --indirect-samples 4"
    bake cornell buckets "--size 97x61 --photons 4000 --estimate buckets --normal-keys 1 --sample-bits 16 --indirect-samples 1"
    bake atrium atrium "--size 160x90 --photons 4000 --texture-filter trilinear"
    bake cornell basis "--size 97x61 $basis --tile 8 --sample-bits 16"
    bake rooms points "--size 128x96 $basis --basis-receivers points"
    bake rooms basis-still "--size 128x96 $basis --antialias 4"
    for codec in float32 float16 log8 bc1 sparse; do
        bake cornell live-$codec "--size 97x61 $live --codec $codec"
    done
    bake cornell tiny-live-bc1 "$tiny $live --codec bc1"
}
# Baked irradiance: of a light that moves, of light that is still; with the balls below, of the sky, a lamp and a light that moves.
basis="--indirect basis --receiver-rays 64 --receiver-spacing 24"
# Live radiosity of a light that moves, by each code of the matrix between patches; with the balls below, beside light that is baked.
live="--indirect radiosity --receiver-rays 64 --receiver-spacing 24 --patches 300"
tiny="--size 17x9 --photons 200 --tile 8"
[ "${VITRINE_MATRIX:-}" = smoke ] || whole
bake cornell tiny-list "$tiny --zones 0 --indirect-samples 1"
bake cornell tiny-zones "$tiny --zones 2 --effective-area 1 --kernel flattened --indirect-samples 4"
bake cornell tiny-buckets "$tiny --estimate buckets --normal-keys 1 --sample-bits 16 --indirect-samples 1"
bake cornell tiny-raw "$tiny --estimate buckets --smoothing raw --indirect-samples 16"
bake atrium tiny-atrium "$tiny --texture-filter trilinear"
bake cornell tiny-basis "$tiny $basis --indirect-samples 16"
bake cornell tiny-live-sparse "$tiny $live"
# Our balls in all effects that they can have; the sky is a picture of two texels.
printf '\0\0\2\0\0\0\0\0\0\0\0\0\2\0\1\0\30\0\200\140\100\100\140\200' > "$out/sky.tga"
cat > "$out/shine.cfg" <<EOF
output: { width = 128; height = 96; frames = 2; };
meshes = ( { file = "$tools/scenes/balls.obj"; } );
camera: { keys = ( { eye = [0.0, 2.9, 8.4]; target = [0.3, 0.55, 0.0]; fov = 46.0; } ); };
sky: { image = "sky.tga"; light = true; };
ambient = [0.02, 0.02, 0.03]; ambient_radius = 0.4;
materials = (
    { name = "mirror_silver"; kind = "mirror"; specular = [0.9, 0.9, 0.9]; }, { name = "mirror_gold"; kind = "thin_glass"; },
    { name = "glass_clear"; kind = "glass"; ior = 1.5; }, { name = "glass_green"; kind = "glass"; ior = 1.3; absorption = [1.2, 0.2, 0.8]; },
    { name = "tile_light"; specular = [0.2, 0.2, 0.2]; exponent = 30.0; }, { name = "matt_blue"; specular = [0.5, 0.4, 0.3]; roughness = 0.4; }, { name = "matt_red"; emission = [4.0, 3.0, 2.0]; } );
lights = (
    { type = "spot"; inner = 20.0; outer = 40.0; range = 40.0; keys = ( { position = [-4.5, 7.5, 5.5]; target = [0.0, 0.0, 0.0]; power = [900.0, 900.0, 900.0]; },
                                                                        { time = 1.0; position = [4.5, 7.5, 5.5]; } ); },
    { type = "directional"; keys = ( { position = [1.0, 3.0, 2.0]; target = [0.0, 0.0, 0.0]; irradiance = [1.0, 1.0, 0.8]; } ); } );
quality: { photons = 4000; antialias = 4; light_samples = 4; sky_samples = 4; cache_error = 0.1; };
EOF
"$tools/vitrine-bake" "$out/shine.cfg" -o "$out/shine.vit" --quiet --no-check --device host --indirect photons || exit 1
"$tools/vitrine-bake" "$out/shine.cfg" -o "$out/tiny-shine.vit" --quiet --no-check --device host --indirect photons $tiny || exit 1
"$tools/vitrine-bake" "$out/shine.cfg" -o "$out/basis-shine.vit" --quiet --no-check --device host $basis || exit 1
[ "${VITRINE_MATRIX:-}" = smoke ] ||
    "$tools/vitrine-bake" "$out/shine.cfg" -o "$out/live-shine.vit" --quiet --no-check --device host $live || exit 1
# A table that fills while playing, beside light of the sky and of the lamp that is baked.
"$tools/vitrine-bake" "$out/shine.cfg" -o "$out/progressive-shine.vit" --quiet --no-check --device host $basis --cache progressive --lightmap baked || exit 1
"$tools/vitrine-bake" "$out/shine.cfg" -o "$out/tiny-progressive-shine.vit" --quiet --no-check --device host $tiny $basis --cache progressive --lightmap baked || exit 1
"$tools/vitrine-bake" "$out/shine.cfg" -o "$out/tiny-basis-shine.vit" --quiet --no-check --device host $tiny $basis || exit 1
# Receivers at points in space.
[ "${VITRINE_MATRIX:-}" = smoke ] ||
    "$tools/vitrine-bake" "$out/shine.cfg" -o "$out/points-shine.vit" --quiet --no-check --device host $basis --basis-receivers points || exit 1
"$tools/vitrine-bake" "$out/shine.cfg" -o "$out/tiny-points-shine.vit" --quiet --no-check --device host $tiny $basis --basis-receivers points || exit 1

play="$tools/vitrine-play --verify --quiet"
pocl=$("$tools/vitrine-play" --list-devices | sed -n 's/^\([0-9]*\) Portable Computing Language .*/\1/p' | head -1)
[ -n "$pocl" ] || absent "PoCL"
for name in $packs; do
    pack=$out/$name.vit
    echo "== $name"
    for device in ${pocl:+$devices}; do
        for lanes in $widths; do
            for threads in $threads_tried; do
                [ $device$threads != basic2 ] || continue
                row "PoCL $device, $threads threads, $lanes lanes" env POCL_DEVICES=$device POCL_MAX_PTHREAD_COUNT=$threads $play "$pack" --device $pocl --lanes $lanes
            done
        done
    done
    for method in ${pocl:+loops loopvec}; do
        row "PoCL work-group method $method" env POCL_WORK_GROUP_METHOD=$method POCL_CACHE_DIR="$out/pocl-$method" sh -c "mkdir -p $out/pocl-$method; exec $play $pack --device $pocl"
    done
    [ -z "$pocl" ] || row "PoCL again" $play "$pack" --device $pocl
    for lanes in ${pocl:+$widths}; do
        row "PoCL, divisions through doubles, $lanes lanes" $play "$pack" --device $pocl --wide-divide --lanes $lanes
    done
    for isa in baseline avx2 avx512; do
        for lanes in $widths; do
            if "$tools/vitrine-play" "$pack" --quiet --frames 1 --device host --host-isa $isa --lanes $lanes 2>&1 | grep -q 'no kernels for'; then
                absent "host, $isa, $lanes lanes"
            else
                for threads in 1 2 3; do
                    row "host, $isa, $lanes lanes, $threads threads" $play "$pack" --device host --host-isa $isa --lanes $lanes --threads $threads
                done
            fi
        done
    done
done

if [ -n "${INTEL_OPENCL:-}" ]; then
    mkdir -p "$out/intel-icd" && echo "$INTEL_OPENCL/libintelocl.so" > "$out/intel-icd/intel.icd"
    for name in $packs; do
        for lanes in $widths; do
            row "Intel OpenCL, $name, $lanes lanes" env OCL_ICD_VENDORS="$out/intel-icd" LD_LIBRARY_PATH="$INTEL_OPENCL${LD_LIBRARY_PATH:+:$LD_LIBRARY_PATH}" $play "$out/$name.vit" --device 0 --lanes $lanes
        done
    done
else
    absent "Intel OpenCL (INTEL_OPENCL is not set)"
fi

# Every kernel under Oclgrind, which also finds accesses out of bounds and races, and as C under MemorySanitizer, which finds reads of what
# nobody wrote. (Oclgrind's own search for those takes what the host shares by CL_MEM_USE_HOST_PTR for unwritten.)
oclgrind_row() { # pack, group
    rm -f "$out/oclgrind.log"
    oclgrind --build-options -cl-opt-disable --data-races --check-api --log "$out/oclgrind.log" $play "$out/$1.vit" --device 0 --lanes 1 --group $2 || return
    [ ! -s "$out/oclgrind.log" ] || { cat "$out/oclgrind.log"; return 1; }
}
if command -v oclgrind >/dev/null; then
    for name in $strict_packs; do
        for group in 1 32; do
            row "Oclgrind, tiny $name, groups of $group: hashes, bounds, races" oclgrind_row tiny-$name $group
        done
    done
else
    absent "Oclgrind"
fi
rm -f "$out"/hashes-*
echo 'int main(void) { return 0; }' > "$out/empty.c"
if clang -fsanitize=memory "$out/empty.c" -o "$out/empty" 2>/dev/null; then
    make --no-print-directory -s OPENCL=0 B=build/msan CC="clang -fsanitize=memory -fno-sanitize-recover -w" HOST_ISAS=baseline HOST_LANES="$widths" build/msan/libvitrine.a >"$out/msan.log" 2>&1 &&
        clang -fsanitize=memory -fno-sanitize-recover -Iinclude tests/matrix/hashes.c build/msan/libvitrine.a -lpthread -lm -o "$out/hashes-msan" >>"$out/msan.log" 2>&1 ||
        echo "FAILED   MemorySanitizer: does not build, see $out/msan.log"
    for name in $strict_packs; do
        for lanes in $widths; do
            row "host under MemorySanitizer, tiny $name, $lanes lanes" "$out/hashes-msan" "$out/tiny-$name.vit" $lanes
        done
    done
else
    absent "MemorySanitizer (clang and its libraries)"
fi

for machine in aarch64 riscv64 s390x; do
    cc=$machine-linux-gnu-gcc qemu=qemu-$machine-static build=build/$machine
    if command -v $cc >/dev/null && command -v $qemu >/dev/null; then
        make --no-print-directory -s OPENCL=0 B="$build" CC=$cc "$build/libvitrine.a" >"$out/$machine.log" 2>&1 &&
            $cc -O2 -Iinclude tests/matrix/hashes.c "$build/libvitrine.a" -static -lpthread -lm -o "$out/hashes-$machine" >>"$out/$machine.log" 2>&1 || { failed=$((failed + 1)); echo "FAILED   $machine: does not build, see $out/$machine.log"; continue; }
        for name in $packs; do
            for lanes in 1 8; do
                row "$machine under qemu, $name, $lanes lanes" $qemu "$out/hashes-$machine" "$out/$name.vit" $lanes
            done
        done
    else
        absent "$machine ($cc, $qemu)"
    fi
done
echo "$rows rows, $failed not equal"
[ $failed = 0 ] && [ $rows -gt 0 ] || exit 4
