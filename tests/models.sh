#!/bin/sh
# Bakes and plays every model under $VITRINE_SCENES (or ../shared/scenes) that is a mesh of its own, with the automatic camera and light, and
# prints exit status, time and the effects that it calls for; a picture each, and one sheet of all if ImageMagick is there:
#   tests/models.sh [folder of the tools, default build/release] [folder for packs and pictures, default build/models] [options of the baker]
# Exit 1 if a tool ends with anything but 0 (done) or 5 (bad input, in one line).
set -u
tools=${1:-build/release} out=${2:-build/models} scenes=${VITRINE_SCENES:-../shared/scenes} failed=0
[ $# -lt 1 ] || shift
[ $# -lt 1 ] || shift
mkdir -p "$out"
sheet=
for model in $(find "$scenes" -name '*.gltf' -o -name '*.glb' -o -name '*.obj' -o -name '*.ply' | sort); do
    name=$(echo "${model#"$scenes"/}" | tr '/' '-')
    began=$(date +%s)
    said=$("$tools/vitrine-bake" "$model" -o "$out/$name.vit" --quiet --explain --device host --size 320x240 --frames 2 "$@" 2>&1)
    status=$?
    case $status in
    0)
        "$tools/vitrine-play" "$out/$name.vit" --quiet --verify --device host --frames 0 --out "png:$out/$name" || failed=1
        sheet="$sheet $out/$name/frame_00000.png"
        effects=$(echo "$said" | sed -n 's/^  \([a-z-]*\) *called for: .*/\1/p' | tr '\n' ' ')
        ;;
    5) effects=$(echo "$said" | tail -1 | cut -c1-150) ;;
    *) effects=$(echo "$said" | tail -1 | cut -c1-150) failed=1 ;;
    esac
    printf '%s %3d s  %-55s %s\n' "$status" $(($(date +%s) - began)) "$name" "$effects"
done
[ -z "$sheet" ] || ! command -v montage >/dev/null || montage -label '%d' -geometry 240x180+4+4 -tile 7x $sheet "$out/sheet.png"
exit $failed
