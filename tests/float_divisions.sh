#!/bin/sh
# Is every division and square root of floats in kernels/ written by l_div, l_sqrt, vit_div, vit_sqrt (kernels/strict.clh)? Compiled by clang with
# VIT_WIDE_DIVIDE and without optimisation, none is left that works on floats; those of constants, which the compiler folds, are none.
# Effects, view and format are variables here, as in the kernels as C, so that no branch is left out.
#   tests/float_divisions.sh kernels/FILE...   in the order of the program; prints the lines that are wrong and exits 1
set -eu
tmp=$(mktemp -d) && trap 'rm -rf "$tmp"' EXIT
echo 'extern constant int vit_any;' > "$tmp/all.cl"
cat "$@" | sed -e 's/^#define VIT_WITH(effect) .*/#define VIT_WITH(effect) 1/' -e 's/^#define VIT_WITH_DENSE .*/#define VIT_WITH_DENSE 1/' >> "$tmp/all.cl"
[ "$(grep -c '^#define VIT_WITH.* 1$' "$tmp/all.cl")" = 2 ] || { echo "kernels/strict.clh defines VIT_WITH otherwise than this script knows"; exit 1; }
effects=$(sed -n '/define VIT_EFFECTS/,/[^\\]$/s/.*X([0-9]*, "[^"]*", \([A-Z0-9_]*\).*/\1/p' kernels/records.clh)
modes=$(sed -n 's/.*define VIT_MODES(X) //p' kernels/records.clh | tr -d 'X()')
wrong() { # program: lines of its text that divide floats
    for lanes in 1 8; do
        clang -x cl -cl-std=CL1.2 -D__OPENCL_VERSION__=120 -Xclang -finclude-default-header -target spir64 -O0 -gline-tables-only -S -emit-llvm -w \
            -DVIT_WIDE_DIVIDE -DVIT_LANES=$lanes -DVIT_VIEW=vit_any -DVIT_FORMAT=vit_any -DVIT_COUNT_WORK=1 \
            $(for e in $effects $modes; do echo "-DVIT_EFFECT_$e=vit_any"; done) "$1" -o "$tmp/all.ll"
        grep -q 'fdiv .*double' "$tmp/all.ll" || echo none
        grep -E 'fdiv (<[0-9]+ x )?float|call .*@_Z[0-9]+(native_|half_|r)?sqrt(f|Dv[0-9]+_f)\(' "$tmp/all.ll" | sed -E 's/.*!dbg (![0-9]+).*/\1/' |
            while read -r at; do sed -n "s/^$at = !DILocation(line: \([0-9]*\),.*/\1/p" "$tmp/all.ll"; done
    done
}
lines=$(wrong "$tmp/all.cl" | sort -u)
case $lines in *none*) echo "no division at all: does this compiler still call it fdiv?"; exit 1 ;; esac
for line in $lines; do sed -n "${line}s/^ */a division or root of floats that is not l_div, l_sqrt, vit_div, vit_sqrt: /p" "$tmp/all.cl"; done
[ -z "$lines" ] || exit 1
# What is searched for is found: the last division written plainly.
sed 's/l_div(1\.0f, d2)/1.0f \/ d2/' "$tmp/all.cl" > "$tmp/bad.cl"
[ -n "$(wrong "$tmp/bad.cl")" ] || { echo "a division of floats that was put in is not found"; exit 1; }
echo "divisions of floats: none beside l_div and vit_div"
