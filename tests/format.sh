#!/bin/sh
# The layout of all C and OpenCL C, which .clang-format states: tests/format.sh rewrites files, tests/format.sh --check names those that
# differ. Versions of clang-format break lines in different places; the one that counts is Debian 12's, and others look at the lengths of
# lines alone. stb is not ours.
cd "$(dirname "$0")/.." || exit 2
files=$(git ls-files '*.c' '*.cc' '*.h' '*.cl' '*.clh' | grep -v '/stb_image\.c$')
[ -n "$files" ] || exit 2
columns=$(sed -n 's/^ColumnLimit: //p' .clang-format)
version=$(clang-format --version | sed -n 's/.*version \([0-9]*\)\..*/\1/p')
laid_out=$(mktemp) || exit 1
trap 'rm -f "$laid_out"' EXIT
bad=0
if [ "$version" = 14 ]; then
    for f in $files; do
        clang-format --assume-filename="$(printf %s "$f" | sed "s|\.clh*$|.c|")" < "$f" > "$laid_out" || exit 1
        cmp -s "$laid_out" "$f" && continue
        [ "$1" = --check ] || { cp "$laid_out" "$f"; continue; }
        echo "$f: not as .clang-format has it: make format" >&2
        bad=1
    done
else
    echo "format: clang-format $version is not version 14: only the lengths of lines are looked at" >&2
fi
for f in $files; do
    awk -v most="$columns" -v f="$f" 'length > most { printf "%s:%d: longer than %d columns\n", f, FNR, most; bad = 1 } END { exit bad }' "$f" >&2 || bad=1
done
exit $bad
