#!/bin/sh
# What accuracy costs in Sponza and Sibenik (folders sponza/ and sibenik/ under $VITRINE_SCENES or ../shared/scenes), 1280x720, a still light, 17 000
# photon paths, 4 bounces, the radius that is automatic for so many: reports by vitrine-cost, and of each the front and what a path tracer needs for the same error.
#   tests/real_reports.sh [folder of the tools, default build/release] [folder for reports, default build/cost] [more options of vitrine-cost]
set -eu
tools=${1:-build/release} out=${2:-build/cost} scenes=$(cd "${VITRINE_SCENES:-../shared/scenes}" && pwd)
[ $# -lt 2 ] || shift 2
mkdir -p "$out"
report() { # name, mesh, eye, target, exposure, light, radius, more options
    name=$1 && shift
    cat > "$out/$name.cfg" <<CFG
name = "$name";
output: { width = 1280; height = 720; fps = 24.0; frames = 1; };
meshes = ( { file = "$scenes/$name/$1"; } );
camera: { keys = ( { eye = [$2]; target = [$3]; fov = 60.0; exposure = $4; } ); };
lights = ( { type = "point"; keys = ( { position = [$5]; power = [3000.0, 2800.0, 2400.0]; } ); } );
quality: { indirect = "photons"; photons = 17000; bounces = 4; radius = $6; tile = 32; estimate = "list"; };
CFG
    shift 6
    "$tools/vitrine-cost" "$out/$name.cfg" -o "$out/$name" \
        --knobs photons,radius,estimate,kernel,zones,effective_area,indirect_samples "$@"
}
report sponza sponza.gltf "-10.0, 2.0, -0.5" "5.0, 4.0, -0.5" 1.2 "0.0, 8.0, 0.0" 0.77 "$@"
report sibenik sibenik.obj "24.0, 2.5, 0.0" "0.0, 5.0, 0.0" 1.5 "8.0, 10.0, 0.0" 1.65 "$@"
