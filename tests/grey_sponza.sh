#!/bin/sh
# Grey Sponza (folder sponza/ under $VITRINE_SCENES or ../shared/scenes): all albedos 0.6, one light, four bounces, 320x180. Error of the plain
# sphere and of zones with areas, 17 000 and 65 536 paths, against the path-traced reference:
#   tests/grey_sponza.sh [folder of the tools, default build/release] [folder for reports, default build/grey]
set -eu
tools=${1:-build/release} out=${2:-build/grey} scenes=$(cd "${VITRINE_SCENES:-../shared/scenes}" && pwd)
mkdir -p "$out"
try() { # name, quality
    {
        echo "output: { width = 320; height = 180; fps = 24.0; frames = 1; };"
        echo "meshes = ( { file = \"$scenes/sponza/sponza.gltf\"; } );"
        echo "materials = ("
        for m in bricks flagpole column_b vase_hanging column_c Material__57 vase_round column_a vase ceiling arch chain leaf fabric_c fabric_d \
            roof fabric_f details floor Material__25 Material__298 fabric_g fabric_e fabric_a Material__47; do
            [ $m = bricks ] || echo ","
            echo "{ name = \"$m\"; color = [0.6, 0.6, 0.6]; texture = \"\"; cutoff = 0.0; }"
        done
        echo ");"
        echo "camera: { keys = ( { eye = [-10.0, 2.0, -0.5]; target = [5.0, 4.0, -0.5]; fov = 60.0; } ); };"
        echo "lights = ( { type = \"point\"; keys = ( { position = [0.0, 10.0, 0.0]; power = [3000.0, 3000.0, 3000.0]; } ); } );"
        echo "quality: { indirect = \"photons\"; bounces = 4; radius = 1.5; tile = 32; estimate = \"list\"; $2 };"
    } > "$out/$1.cfg"
    "$tools/vitrine-cost" "$out/$1.cfg" --quiet --settings 1 --every 2 --reference-error 0.002 --repeats 7 -o "$out/$1"
    echo "== $1: $2"
    # from the end: names and values before may hold commas
    awk -F, 'NR == 1 { for (i = 1; i <= NF; i++) if ($i ~ /^total_(nmse|relmse)$|^indirect_bias$/) at[NF - i] = $i }
             NR == 2 { for (i in at) print at[i], $(NF - i) }' "$out/$1/report.csv"
}
better='zones = true; light_zones = true; effective_area = true;'
try sphere 'photons = 17000;'
try zones "photons = 17000; $better"
try zones-65536 "photons = 65536; $better kernel = \"flattened\"; flatten = 6.0;"
