#!/bin/sh
# What became of all tests that run.sh has written down: total.sh FOLDER NAME...; the names are those that had to run. Ends with the names of
# what failed and one line, "N passed, N failed, N skipped". Exit 1 if anything failed, did not run, or nothing passed.
folder=$1
shift
for name in "$@"; do
    [ -e "$folder/$(printf %s "$name" | tr '/ ' '__').tests" ] || echo "failed $name: did not run"
done > "$folder/missing.tests"
cat "$folder"/*.tests | sort > "$folder/all"
count() { grep -c "^$1 " "$folder/all"; }
listed() { [ "$(count "$1")" = 0 ] || { echo; echo "$1:"; sed -n "s/^$1 /  /p" "$folder/all"; }; }
echo
echo "longest, in seconds:"
sed -n 's/^seconds /  /p' "$folder/all" | sort -k1,1nr | head -n 10
listed skipped
listed failed
echo
echo "$(count passed) passed, $(count failed) failed, $(count skipped) skipped"
[ "$(count failed)" = 0 ] && [ "$(count passed)" != 0 ]
