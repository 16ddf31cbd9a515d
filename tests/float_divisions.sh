#!/bin/sh
# Is every division and square root of floats in kernels/ written by l_div, l_sqrt, vit_div, vit_sqrt (kernels/strict.clh)? Compiled by clang with
# VIT_WIDE_DIVIDE and without optimisation, none is left that works on floats; those of constants, which the compiler folds, are none.
#   tests/float_divisions.sh kernels/FILE...   in the order of the program; prints the lines that are wrong and exits 1
set -eu
tmp=$(mktemp -d) && trap 'rm -rf "$tmp"' EXIT
cat "$@" > "$tmp/all.cl"
effects=$(sed -n '/define VIT_EFFECTS/,/[^\\]$/s/.*X([0-9]*, "[^"]*", \([A-Z0-9_]*\).*/\1/p' kernels/records.clh)
views=$(sed -n '/define VIT_VIEWS/,/[^\\]$/s/ *X(\([a-z]*\),.*/\1/p' include/vitrine.h | wc -l)
compile() { # lanes, view, effects on
    clang -x cl -cl-std=CL1.2 -D__OPENCL_VERSION__=120 -Xclang -finclude-default-header -target spir64 -O0 -gline-tables-only -S -emit-llvm -w \
        -DVIT_WIDE_DIVIDE -DVIT_LANES=$1 -DVIT_VIEW=$2 -DVIT_FORMAT=0 -DVIT_EFFECT_DOTS=$3 -DVIT_COUNT_WORK=$3 \
        $(for e in $effects; do echo "-DVIT_EFFECT_$e=$3"; done) "$tmp/all.cl" -o -
}
: > "$tmp/bad"
seen=0 view=0
while [ $view -lt "$views" ]; do
    for on in 0 1; do
        compile 8 $view $on > "$tmp/all.ll"
        seen=$((seen + $(grep -c 'fdiv .*double' "$tmp/all.ll")))
        sed -nE '/fdiv (<[0-9]+ x )?float|call .*@_Z[0-9]+(native_|half_|r)?sqrt(f|Dv[0-9]+_f)\(/s/.*!dbg (![0-9]+).*/\1/p' "$tmp/all.ll" |
            while read -r at; do sed -n "s/^$at = !DILocation(line: \([0-9]*\),.*/\1/p" "$tmp/all.ll"; done >> "$tmp/bad"
    done
    view=$((view + 1))
done
[ $seen -gt 0 ] || { echo "no division at all: does this compiler still call it fdiv?"; exit 1; }
for line in $(sort -nu "$tmp/bad"); do sed -n "${line}s/^ */a division or root of floats that is not l_div, l_sqrt, vit_div, vit_sqrt: /p" "$tmp/all.cl"; done
[ ! -s "$tmp/bad" ] && echo "divisions of floats: none beside l_div and vit_div ($((seen / 2 / views)) a program)"
