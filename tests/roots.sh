#!/bin/sh
# Same file, same pack, whatever the libraries of the system: makes a root of each release with debootstrap, builds the baker there (without
# OpenCL, not optimised), and compares its packs of all mesh files among the cases, of the glTF samples, of small models and of what
# tests/tools_models.sh has made with this machine's, byte by byte; a file that both refuse is alike:
#   tests/roots.sh [folder for roots, default build/roots] [releases, default "trixie noble"] [tools, default build/release]
# Needs to be root, debootstrap and the network; new roots take a quarter of an hour. Exit 1 if a pack or an exit status differs, or a root cannot
# be made or built in.
set -u
roots=${1:-build/roots} releases=${2:-trixie noble} tools=${3:-build/release} failed=0
cases=${VITRINE_CASES:-../shared/cases} scenes=${VITRINE_SCENES:-../shared/scenes}
options="--no-check --quiet --device host --size 32x24 --frames 1 --photons 0"
packages=$(make -s OPENCL=0 --eval='print-deps:;@echo $(filter-out gnuplot-nox,$(DEPS))' print-deps | tr ' ' ',')
mkdir -p "$roots"
make_root() { # release
    [ ! -x "$roots/$1/usr/bin/gcc" ] || return 0
    case $1 in
    noble) set -- "$1" --no-check-gpg --components=main,universe /usr/share/debootstrap/scripts/gutsy ;; # Debian 12 does not know it by name
    *) set -- "$1" --force-check-gpg --components=main "" ;;
    esac
    # No mirror is named: the script's own is taken.
    debootstrap --variant=minbase "--include=$packages" "$2" "$3" "$1" "$roots/$1" "" ${4:+"$4"} > "$roots/$1.log" 2>&1
}
build_there() { # release
    mkdir -p "$roots/$1/src" "$roots/$1/models"
    git archive HEAD | tar x -C "$roots/$1/src" &&
        env -u CC -u CXX chroot "$roots/$1" sh -c 'cd /src && make -s -j"$(nproc)" config=debug OPENCL=0 build/debug-no-opencl/vitrine-bake' > "$roots/$1.log" 2>&1
}
for r in $releases; do
    if ! make_root "$r" || ! build_there "$r"; then
        echo "$r: no root, or no baker in it: $roots/$r.log"
        failed=1
        continue
    fi
    [ ! -d "$cases" ] || cp -r "$cases" "$roots/$r/models/"
    for folder in gltf odd stanford cornell_box; do
        [ ! -d "$scenes/$folder" ] || cp -r "$scenes/$folder" "$roots/$r/models/"
    done
    [ ! -d build/tools_models/models ] || { mkdir -p "$roots/$r/models/tools" && cp build/tools_models/models/*.* "$roots/$r/models/tools"; }
    same=0
    for model in $(cd "$roots/$r/models" && find . -name '*.gltf' -o -name '*.glb' -o -name '*.obj' -o -name '*.ply' -o -name '*.dae' -o -name '*.fbx' -o -name '*.3mf' \
        -o -name '*.x3d' -o -name '*.amf' -o -name '*.stl' -o -name '*.off' | sort); do
        rm -f "$roots/$r/there.vit" "$roots/here.vit"
        # shellcheck disable=SC2086 # options are several words
        chroot "$roots/$r" /src/build/debug-no-opencl/vitrine-bake "/models/$model" -o /there.vit $options 2> /dev/null
        there=$?
        # shellcheck disable=SC2086
        "$tools/vitrine-bake" "$roots/$r/models/$model" -o "$roots/here.vit" $options 2> /dev/null
        here=$?
        if [ $here = $there ] && { [ $here != 0 ] || cmp -s "$roots/$r/there.vit" "$roots/here.vit"; }; then
            same=$((same + 1))
        else
            echo "$r: $model differs (exit $here here, $there there)"
            failed=1
        fi
    done
    echo "$r: $same files alike"
done
exit $failed
