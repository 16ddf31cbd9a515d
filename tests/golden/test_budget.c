/* Budgets and reports of the player: exact counts as files, times as JSON, and exit codes that a CI run can trust.
 *
 * Why this is hard: times differ from run to run, so no test may depend on how long anything takes. Strategy: time budgets that
 * every machine meets or misses; counts, which are exact, are held to each other byte by byte over lanes, groups, threads and
 * devices, and files of them are changed by one unit to see that unit named. JSON is read by a checker of its own. */
#include "json_check.h"
#include "test_packs.h"
#include "vitrine.h"

#include <inttypes.h>

#define FOLDER TEST_PACKS "/budget"
#define JSON FOLDER "/out.json"
#define WORK FOLDER "/out.work"

static tool_run r;
static char first_file[TOOL_TEXT], file[TOOL_TEXT];

static int set_up(void **state) {
    (void)state;
    test_packs_begin();
    folder_make(FOLDER);
    return 0;
}

static int tear_down(void **state) {
    (void)state;
    static const char *const left[] = {JSON, WORK, FOLDER "/changed.work"};
    for (size_t i = 0; i < sizeof left / sizeof left[0]; i++)
        (void)unlink(left[i]);
    return rmdir(FOLDER); /* fails if a .part or anything else was left behind */
}

/* A budget that is missed or refused: exit code, one line, nothing on stdout. */
static void refuses(const char *pack, const char *options, int code, const char *says) {
    tool(&r, TOOL_PLAY " %s --quiet %s", pack, options);
    tool_refuses(&r, "vitrine-play", code, says);
}

static void succeeds(const char *pack, const char *options) {
    tool(&r, TOOL_PLAY " %s --quiet %s", pack, options);
    tool_succeeds(&r);
}

static void the_json_checker_finds_what_is_no_json(void **state) {
    (void)state;
    static const char *const bad[] = {"", "{", "{\"a\" 1}", "{\"a\": nan}", "[1,]", "\"x", "{\"a\": 1,}", "\"\\x\""};
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++)
        assert_false(json_valid(bad[i]));
    assert_true(json_valid(" {\"a\": [1, 2.5, {}], \"b\": true, \"c\": \"\\u00e9\"} "));
}

/* The number after `name`, searched from the place where `in` stands on. */
static double number_after(const char *text, const char *in, const char *name) {
    const char *at = strstr(text, in);
    char key[64];
    (void)snprintf(key, sizeof key, "\"%s\": ", name);
    at = at ? strstr(at, key) : NULL;
    if (!at)
        fail_msg("no %s in %s of\n%s", key, in, text);
    return strtod(at + strlen(key), NULL);
}

static void a_report_file_is_json_with_times_work_and_memory(void **state) {
    (void)state;
    succeeds(test_pack("list"), "--report " JSON);
    assert_string_equal(r.out, "");
    assert_string_equal(r.err, "");
    read_into(JSON, file, TOOL_TEXT);
    assert_true(json_valid(file));
    static const char *const parts[] = {"\"frames\": {\"first\"", "\"name\": \"visibility\"", "\"name\": \"resolve\""};
    for (size_t i = 0; i < sizeof parts / sizeof parts[0]; i++) {
        const double p50 = number_after(file, parts[i], "p50"), p95 = number_after(file, parts[i], "p95"),
                     p99 = number_after(file, parts[i], "p99"), most = number_after(file, parts[i], "max");
        assert_true(p50 > 0 && p95 >= p50 && p99 >= p95 && most >= p99);
        assert_true(number_after(file, parts[i], "mad") >= 0);
    }
    assert_true(number_after(file, "\"frames\": {\"first\"", "played") == 3.0);
    assert_true(number_after(file, "\"visibility\"", "sum") == 3 * 160 * 120);
    assert_true(number_after(file, "\"buffers\"", "device_bytes") > 0);
    assert_non_null(strstr(file, "\"indirect\": \"photons\",\n"));
    assert_non_null(strstr(file, "\"box_tests\", \"same\": false"));
    assert_non_null(strstr(file, "\"pairs\", \"same\": true"));
}

static void a_report_without_a_file_is_a_table(void **state) {
    (void)state;
    succeeds(test_pack("list"), "--report --frames 0:2");
    assert_non_null(strstr(r.out, "deviation"));
    assert_non_null(strstr(r.out, "\nindirect light: photons\n"));
    assert_non_null(strstr(r.out, "estimate_all"));
    tool(&r, TOOL_PLAY " --report %s --quiet --frames 0", test_pack("list")); /* the pack is not the report's file */
    tool_succeeds(&r);
    assert_non_null(strstr(r.out, "estimate_all"));
    assert_null(strstr(r.out, "node_tests"));
    succeeds(test_pack("dark"), "--report --frames 0");
    assert_non_null(strstr(r.out, "\nindirect light: none\n"));
    succeeds(test_pack("list"), "--count-work --frames 0");
    assert_non_null(strstr(r.out, "node_tests"));
    assert_null(strstr(r.out, "deviation"));
}

static void a_time_budget_is_met_or_missed_with_the_pass_to_blame(void **state) {
    (void)state;
    const char *pack = test_pack("list");
    succeeds(pack, "--budget 1000000");
    succeeds(pack, "--budget 1000000,resolve=1000000 --budget-percentile max");
    refuses(pack, "--budget 0.000001", VIT_BUDGET, "frame p"); /* which: the machine's load decides */
    refuses(pack, "--budget 0.000001 --budget-percentile 95", VIT_BUDGET, "frame p95");
    refuses(pack, "--budget 0.000001 --budget-percentile 50", VIT_BUDGET, "frame p50");
    refuses(pack, "--budget 0.000001 --budget-percentile max", VIT_BUDGET, "longest pass ");
    refuses(pack, "--budget=resolve=0.000001,visibility=0.000001,1000000", VIT_BUDGET, "pass visibility p");
    refuses(pack, "--budget resolve=0.000001", VIT_BUDGET, "pass resolve p");
    refuses(pack, "--budget 0.000001,resolve=0.000001 --report " JSON, VIT_BUDGET, "; pass resolve p");
    read_into(JSON, file, TOOL_TEXT); /* a run that missed its budget still reports */
    assert_true(json_valid(file));
}

static void a_time_budget_that_says_nothing_is_a_usage_error(void **state) {
    (void)state;
    static const char *const bad[] = {"",          "0",         "-1",    "ten",         "1e3",
                                      "nan",       "33,",       ",3",    "3,4",         "resolve=",
                                      "=3",        "resolve=0", "1.2.3", "99999999999", "resolve=1,resolve=2",
                                      "resolve==1"};
    char line[128];
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        (void)snprintf(line, sizeof line, "--budget=%s", bad[i]);
        refuses("nowhere.vit", line, VIT_USAGE, "--budget");
    }
    refuses("nowhere.vit", "--budget 3 --budget-percentile 90", VIT_USAGE, "50, 95, 99 or max");
    refuses("nowhere.vit", "--budget-percentile 99", VIT_USAGE, "needs a --budget");
    refuses("nowhere.vit", "--report=", VIT_USAGE, "--report");
    refuses("nowhere.vit", "--work-budget=", VIT_USAGE, "--work-budget");
    refuses("nowhere.vit", "--write-work-budget", VIT_USAGE, "--write-work-budget FILE");
    refuses("nowhere.vit", "--trace --count-work", VIT_USAGE, "--trace");
    refuses("nowhere.vit", "--trace --budget 3", VIT_USAGE, "--trace");
    refuses("nowhere.vit", "--trace --report " JSON, VIT_USAGE, "--trace");
    refuses(test_pack("list"), "--budget splat_buckets=3", VIT_USAGE, "'splat_buckets'");
}

/* Ways of playing that must not show in the counts; PoCL's compiler makes each width and group size anew, so that the first
 * pack alone is counted in all of them. */
static const struct {
    const char *environment, *options;
    size_t packs; /* the first of them */
} ways[] = {
    {"POCL_MAX_PTHREAD_COUNT=1", "", 3},
    {"", "--device host --lanes 1", 3},
    {"", "--device host --lanes 8 --threads 3", 3},
    {"", "--device host --lanes 16", 3},
    {"POCL_DEVICES=basic", "--lanes 1 --group 2", 1},
    {"POCL_MAX_PTHREAD_COUNT=2", "--lanes 8 --group 64", 1},
    {"", "--lanes 16", 1},
};

static void files_of_counts_are_equal_however_they_are_counted(void **state) {
    (void)state;
    static const char *const packs[] = {"list", "buckets", "room"};
    for (size_t i = 0; i < sizeof packs / sizeof packs[0]; i++)
        for (size_t k = 0; k < sizeof ways / sizeof ways[0]; k++) {
            if (i >= ways[k].packs)
                continue;
            tool(&r, "%s " TOOL_PLAY " %s --quiet --write-work-budget " WORK " %s", ways[k].environment, test_pack(packs[i]),
                 ways[k].options);
            tool_succeeds(&r);
            read_into(WORK, k == 0 ? first_file : file, TOOL_TEXT);
            if (k > 0)
                assert_string_equal(file, first_file);
        }
}

/* Writes what `from` has with the first `old` replaced. */
static void change(const char *from, const char *old, const char *now) {
    static char text[TOOL_TEXT];
    const char *at = strstr(from, old);
    if (!at)
        fail_msg("no '%s' in\n%s", old, from);
    const int size = snprintf(text, sizeof text, "%.*s%s%s", (int)(at - from), from, now, at + strlen(old));
    put_bytes(FOLDER "/changed.work", text, (size_t)size);
}

/* The line of a pass and kind, without its line feed. */
static void line_of(const char *text, const char *start, char line[128], uint64_t *sum, uint64_t *most) {
    const char *at = strstr(text, start);
    assert_non_null(at);
    assert_int_equal(sscanf(at + strlen(start), " %" SCNu64 " %" SCNu64, sum, most), 2);
    (void)snprintf(line, 128, "%.*s", (int)strcspn(at, "\n"), at);
}

#define CHANGED "--work-budget " FOLDER "/changed.work"

static void one_unit_of_work_more_than_allowed_is_named(void **state) {
    (void)state;
    const char *pack = test_pack("list");
    char line[128], other[160];
    uint64_t sum, most;
    succeeds(pack, "--write-work-budget " WORK);
    read_into(WORK, first_file, TOOL_TEXT);
    succeeds(pack, "--work-budget " WORK);
    assert_string_equal(r.err, "");

    line_of(first_file, "estimate_all evaluations", line, &sum, &most);
    (void)snprintf(other, sizeof other, "estimate_all evaluations %" PRIu64 " %" PRIu64, sum - 1, most);
    change(first_file, line, other);
    refuses(pack, CHANGED, VIT_BUDGET, "pass estimate_all, evaluations: ");
    assert_non_null(strstr(r.err, " allowed, 1 over\n"));
    (void)snprintf(other, sizeof other, "estimate_all evaluations %" PRIu64 " %" PRIu64, sum, most - 1);
    change(first_file, line, other);
    refuses(pack, CHANGED, VIT_BUDGET, "in the fullest frame");

    (void)snprintf(other, sizeof other, "estimate_all evaluations %" PRIu64 " %" PRIu64, sum + 7, most);
    change(first_file, line, other);
    tool(&r, TOOL_PLAY " %s " CHANGED, pack); /* less work is an improvement */
    tool_succeeds(&r);
    assert_non_null(strstr(r.err, "less than allowed: pass estimate_all, evaluations: "));
    assert_non_null(strstr(r.err, "within its budget"));
    succeeds(pack, CHANGED);
    assert_string_equal(r.err, "");

    (void)snprintf(other, sizeof other, "%s\n", line);
    change(first_file, other, ""); /* what is not listed is allowed none */
    refuses(pack, CHANGED, VIT_BUDGET, ", 0 allowed, ");
    change(first_file, "visibility view_rays", "visibility view_rats");
    refuses(pack, CHANGED, VIT_BUDGET, "pass visibility, view_rays");
}

static void counts_of_other_frames_are_not_compared(void **state) {
    (void)state;
    const char *pack = test_pack("list");
    succeeds(pack, "--write-work-budget " WORK " --frames 1:3");
    read_into(WORK, file, TOOL_TEXT);
    assert_non_null(strstr(file, "\nframes 1:3 view final format xrgb8888\n"));
    succeeds(pack, "--work-budget " WORK " --frames 1:3");
    refuses(pack, "--work-budget " WORK, VIT_USAGE, "--frames 1:3");
    refuses(pack, "--work-budget " WORK " --frames 1:3 --format rgba32f", VIT_USAGE, "xrgb8888");
    refuses(pack, "--work-budget " WORK " --frames 1:3 --view heat", VIT_USAGE, "final");
}

#define HEAD "vitrine-work 1\nframes 0:3 view final format xrgb8888\n"

static void a_file_that_is_no_work_budget_is_bad_input_with_its_line(void **state) {
    (void)state;
    static const struct {
        const char *text, *says;
    } bad[] = {
        {"", ":1: "},
        {"vitrine-work 2\n", ":1: "},
        {"vitrine-work 1\n", ":2: "},
        {"vitrine-work 1\nframes 0:3\n", ":2: "},
        {"vitrine-work 1\nframes 3:0 view final format xrgb8888\n", ":2: "},
        {"vitrine-work 1\nframes 0-3 view final format xrgb8888\n", ":2: "},
        {HEAD, "ends before the line 'end'"},
        {HEAD "resolve bytes 9 3\n", "ends before the line 'end'"},
        {HEAD "resolve bytes 9\nend\n", ":3: "},
        {HEAD "resolve bytes 9 3 1\nend\n", ":3: "},
        {HEAD "resolve bytes -9 3\nend\n", ":3: "},
        {HEAD "resolve bytes 3 9\nend\n", ":3: "},
        {HEAD "resolve bytes 9 2\nend\n", ":3: "},
        {HEAD "resolve bytes 99999999999999999999 3\nend\n", ":3: "},
        {HEAD "resolve  bytes 9 3\nend\n", ":3: "},
        {HEAD "# a remark\nresolve bytes 9 3\nresolve bytes 9 3\nend\n", ":5: "},
        {HEAD "end\nresolve bytes 9 3\n", "after the line 'end'"},
        {HEAD "end", "no end"},
    };
    const char *pack = test_pack("list");
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        put_bytes(FOLDER "/changed.work", bad[i].text, strlen(bad[i].text));
        refuses(pack, CHANGED, VIT_BAD_INPUT, bad[i].says);
        assert_non_null(strstr(r.err, "changed.work"));
    }
    refuses(pack, "--work-budget " FOLDER "/nowhere.work", VIT_BAD_INPUT, "nowhere.work");
    refuses(pack, "--work-budget " FOLDER, VIT_BAD_INPUT, FOLDER);
    refuses(pack, "--work-budget /dev/zero", VIT_BAD_INPUT, "/dev/zero:1: ");
    put_bytes(FOLDER "/changed.work", HEAD "end\n", sizeof HEAD "end\n" - 1);
    refuses(pack, CHANGED, VIT_BUDGET, "pass visibility, view_rays");
}

static void files_that_cannot_be_written_are_failures(void **state) {
    (void)state;
    const char *pack = test_pack("list");
    refuses(pack, "--frames 0 --write-work-budget " FOLDER "/no/such/folder", VIT_FAILED, FOLDER "/no/such/folder");
    refuses(pack, "--frames 0 --report=" FOLDER, VIT_FAILED, FOLDER);
    refuses(pack, "--frames 0 --write-work-budget /dev/full", VIT_FAILED, "/dev/full");
}

static void counting_goes_with_verifying_and_leaves_stdout_to_the_hashes(void **state) {
    (void)state;
    const char *pack = test_pack("list");
    static char plain[TOOL_TEXT];
    succeeds(pack, "--hash");
    memcpy(plain, r.out, sizeof plain);
    succeeds(pack, "--hash --verify --budget 1000000 --count-work --report " JSON " --write-work-budget " WORK);
    assert_string_equal(r.out, plain);
    assert_non_null(strstr(r.err, "evaluations"));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_json_checker_finds_what_is_no_json),
        cmocka_unit_test(a_report_file_is_json_with_times_work_and_memory),
        cmocka_unit_test(a_report_without_a_file_is_a_table),
        cmocka_unit_test(a_time_budget_is_met_or_missed_with_the_pass_to_blame),
        cmocka_unit_test(a_time_budget_that_says_nothing_is_a_usage_error),
        cmocka_unit_test(files_of_counts_are_equal_however_they_are_counted),
        cmocka_unit_test(one_unit_of_work_more_than_allowed_is_named),
        cmocka_unit_test(counts_of_other_frames_are_not_compared),
        cmocka_unit_test(a_file_that_is_no_work_budget_is_bad_input_with_its_line),
        cmocka_unit_test(files_that_cannot_be_written_are_failures),
        cmocka_unit_test(counting_goes_with_verifying_and_leaves_stdout_to_the_hashes),
    };
    return cmocka_run_group_tests_name("budget", tests, set_up, tear_down);
}
