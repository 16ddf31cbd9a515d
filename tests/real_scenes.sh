#!/bin/sh
# Bakes Sponza and Sibenik (folders sponza/ and sibenik/ under $VITRINE_SCENES or ../shared/scenes) with a moving light, 17 000 photon
# paths, 4 bounces, tile 32, as lists and as buckets, with a fixed and the automatic radius, 720p and 1080p; plays 24 frames, verifies
# every hash, prints milliseconds a pass and photon-cluster pairs, and keeps picture 12 of each:
#   tests/real_scenes.sh [folder of the tools, default build/release] [folder for packs and pictures, default build/real]
set -eu
tools=${1:-build/release} out=${2:-build/real} scenes=$(cd "${VITRINE_SCENES:-../shared/scenes}" && pwd)
mkdir -p "$out"
scene() { # name, mesh, eye, target, exposure, light from, light to
    cat > "$out/$1.cfg" <<CFG
name = "$1";
output: { width = 1280; height = 720; fps = 24.0; frames = 24; };
meshes = ( { file = "$scenes/$1/$2"; } );
camera: { keys = ( { eye = [$3]; target = [$4]; fov = 60.0; exposure = $5; } ); };
lights = ( { type = "point"; keys = ( { time = 0.0; position = [$6]; power = [3000.0, 2800.0, 2400.0]; }, { time = 1.0; position = [$7]; } ); } );
quality: { indirect = "photons"; photons = 17000; bounces = 4; radius = "auto"; tile = 32; estimate = "list"; };
CFG
}
scene sponza sponza.gltf "-10.0, 2.0, -0.5" "5.0, 4.0, -0.5" 1.2 "-4.0, 8.0, 0.0" "4.0, 8.0, 0.0"
scene sibenik sibenik.obj "24.0, 2.5, 0.0" "0.0, 5.0, 0.0" 1.5 "4.0, 10.0, 0.0" "12.0, 10.0, 0.0"
for name in sponza sibenik; do
    fixed=1.5
    [ $name = sponza ] || fixed=2.0
    for size in 1280x720 1920x1080; do
        for radius in $fixed auto; do
            for estimate in list buckets; do
                pack=$out/$name-$size-$radius-$estimate
                echo "== $pack"
                "$tools/vitrine-bake" "$out/$name.cfg" --quiet --size $size --radius $radius --estimate $estimate -o "$pack.vit"
                "$tools/vitrine-play" "$pack.vit" --verify --report
                "$tools/vitrine-play" "$pack.vit" --quiet --frames 12 --out "png:$pack"
                [ -n "${KEEP:-}" ] || rm "$pack.vit"
            done
        done
    done
done
