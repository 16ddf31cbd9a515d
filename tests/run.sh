#!/bin/sh
# Runs one test program, or whatever else is counted as a test, and shows its output in one piece: run.sh NAME COMMAND...
# With a folder in $VITRINE_RESULTS it writes down there what became of each test, succeeds in any case, and total.sh has the last word;
# without, its exit status is the program's. A test of cmocka's is what its lines say; one that had begun and came to no end failed; a
# program that ended badly though none of its tests failed, or that ran none, is a failure by its own name. Other commands are one test.
#   NAME.log: the output.   NAME.tests: a line a test, "passed|failed|skipped NAME: TEST", and "seconds S NAME"
name=$1
shift
results=${VITRINE_RESULTS:-}
if [ -z "$results" ]; then
    echo "== $name"
    exec "$@"
fi
file=$results/$(printf %s "$name" | tr '/ ' '__')
began=$(date +%s)
"$@" > "$file.log" 2>&1
status=$?
echo "== $name"
cat "$file.log"
awk -v name="$name" -v status=$status -v seconds=$(($(date +%s) - began)) '
    function say(verdict, what) { print verdict, name ": " what; count[verdict]++; now = "" }
    # The name that follows a mark; cmocka begins a line with it, but for what the test itself left unended.
    function named(mark) { return substr($0, index($0, mark) + length(mark)) }
    { sub(/\r$/, "") }
    index($0, "[ RUN      ] ") { if (now != "") say("failed", now); now = named("[ RUN      ] "); next }
    now != "" && index($0, "[       OK ] " now) { say("passed", now) }
    now != "" && index($0, "[  SKIPPED ] " now) { say("skipped", now) }
    now != "" && index($0, "[  FAILED  ] " now) { say("failed", now) }
    END {
        how = status > 128 ? "ended by signal " status - 128 : "exit " status
        if (now != "") say("failed", now " (" how ")")
        tests = count["passed"] + count["failed"] + count["skipped"]
        if (tests == 0 && status == 0 && name !~ /\/test_/) { print "passed", name; tests = 1 }
        else if (tests == 0 || (status != 0 && count["failed"] == 0)) print "failed", name ": " (status ? how : "ran no test")
        print "seconds", seconds, name
    }' "$file.log" > "$file.part" && mv "$file.part" "$file.tests"
