/* Golden hashes as files: --write-golden, --golden, and what the JSON report says of a verdict.
 *
 * Strategy: a file is written by the real player and changed by one digit, line or word; each change must be named and give its
 * own exit code. The file of one device must be the file of another, byte by byte. */
#include "json_check.h"
#include "test_packs.h"
#include "vitrine.h"

#include <fcntl.h>

#define FOLDER TEST_PACKS "/golden"
#define GOLDEN FOLDER "/a.golden"
#define CHANGED FOLDER "/changed.golden"
#define JSON FOLDER "/out.json"
#define LINK FOLDER "/link"
#define SECOND FOLDER "/second"
#define SCRIPT FOLDER "/run.sh"

static tool_run r;
static char whole[TOOL_TEXT], file[TOOL_TEXT];

static int set_up(void **state) {
    (void)state;
    test_packs_begin();
    folder_make(FOLDER);
    return 0;
}

static int tear_down(void **state) {
    (void)state;
    static const char *const left[] = {GOLDEN, CHANGED, JSON, LINK, SECOND, SCRIPT};
    for (size_t i = 0; i < sizeof left / sizeof left[0]; i++)
        (void)unlink(left[i]);
    return rmdir(FOLDER);
}

static void play(const char *options) {
    tool(&r, TOOL_PLAY " %s --quiet --device host %s", test_pack("list"), options);
}

static void refuses(const char *options, int code, const char *says) {
    play(options);
    tool_refuses(&r, "vitrine-play", code, says);
}

static void the_file_has_the_hashes_of_the_frames_and_every_device_agrees(void **state) {
    (void)state;
    char row[64];
    play("--write-golden " GOLDEN);
    tool_succeeds(&r);
    assert_string_equal(r.out, "");
    assert_string_equal(r.err, "");
    read_into(GOLDEN, whole, TOOL_TEXT);
    assert_non_null(strstr(whole, "\nframes 0:3 view final format xrgb8888 size 160x120\n"));
    play("--hash");
    for (unsigned i = 0; i < 3; i++) { /* "000001 0123456789abcdef" */
        (void)snprintf(row, sizeof row, "\n%u %.16s\n", i, r.out + 24 * i + 7);
        assert_non_null(strstr(whole, row));
    }
    tool(&r, TOOL_PLAY " %s --quiet --write-golden " CHANGED, test_pack("list")); /* on whatever is the default */
    tool_succeeds(&r);
    read_into(CHANGED, file, TOOL_TEXT);
    assert_string_equal(file, whole);
    play("--golden " GOLDEN " --loop 2");
    tool_succeeds(&r);
    assert_string_equal(r.err, "");
}

/* Writes what the golden file has with the first `old` replaced. */
static void change(const char *old, const char *now) {
    const char *at = strstr(whole, old);
    assert_non_null(at);
    const int size = snprintf(file, sizeof file, "%.*s%s%s", (int)(at - whole), whole, now, at + strlen(old));
    put_bytes(CHANGED, file, (size_t)size);
}

/* One digit of the frame's hash. */
static void change_frame(unsigned frame) {
    char old[32], now[32];
    (void)snprintf(old, sizeof old, "\n%u ", frame);
    const char *at = strstr(whole, old);
    assert_non_null(at);
    (void)snprintf(old, sizeof old, "%.19s", at);
    (void)snprintf(now, sizeof now, "%.18s%c", at, at[18] == 'a' ? 'b' : 'a');
    change(old, now);
}

static void the_first_wrong_frame_is_named(void **state) {
    (void)state;
    play("--write-golden " GOLDEN);
    read_into(GOLDEN, whole, TOOL_TEXT);
    change_frame(1);
    refuses("--golden " CHANGED, VIT_MISMATCH, "frame 1: expected ");
    assert_non_null(strstr(r.err, "(1 of 3 frames differ)"));
    refuses("--golden " CHANGED " --verify", VIT_MISMATCH, "frame 1: expected ");
}

static void the_report_holds_verdict_and_hashes(void **state) {
    (void)state;
    static char row[64];
    play("--write-golden " GOLDEN);
    read_into(GOLDEN, whole, TOOL_TEXT);
    change_frame(2);
    refuses("--golden " CHANGED " --report " JSON, VIT_MISMATCH, "frame 2: ");
    read_into(JSON, file, TOOL_TEXT);
    assert_true(json_valid(file));
    assert_non_null(
        strstr(file, "\"verdict\": {\"exit\": 4, \"verified\": false, \"golden\": true, \"text\": \"frame 2: expected "));
    (void)snprintf(row, sizeof row, "\"hashes\": [\"%.16s\", ", strstr(whole, "\n0 ") + 3);
    assert_non_null(strstr(file, row));
    play("--golden " GOLDEN " --verify --report " JSON);
    tool_succeeds(&r);
    read_into(JSON, file, TOOL_TEXT);
    assert_true(json_valid(file));
    assert_non_null(strstr(file, "\"verdict\": {\"exit\": 0, \"verified\": true, \"golden\": true, \"text\": \"\""));
    play("--budget 0.000001 --report " JSON);
    assert_int_equal(r.code, VIT_BUDGET);
    read_into(JSON, file, TOOL_TEXT);
    assert_true(json_valid(file));
    assert_non_null(strstr(file, "\"verdict\": {\"exit\": 3, "));
    assert_non_null(strstr(file, "\"budget\": \"budget by p"));
}

static void hashes_of_other_frames_views_formats_and_sizes_are_not_compared(void **state) {
    (void)state;
    play("--write-golden " GOLDEN " --frames 1:3 --view normals --format rgba32f");
    tool_succeeds(&r);
    read_into(GOLDEN, whole, TOOL_TEXT);
    play("--golden " GOLDEN " --frames 1:3 --view normals --format rgba32f");
    tool_succeeds(&r);
    refuses("--golden " GOLDEN " --view normals --format rgba32f", VIT_USAGE, "--frames 1:3");
    refuses("--golden " GOLDEN " --frames 1:3 --format rgba32f", VIT_USAGE, "--view normals");
    refuses("--golden " GOLDEN " --frames 1:3 --view normals", VIT_USAGE, "--format rgba32f");
    change("size 160x120", "size 160x121");
    refuses("--golden " CHANGED " --frames 1:3 --view normals --format rgba32f", VIT_USAGE, "160x121");
}

#define HEAD "vitrine-golden 1\nframes 0:3 view final format xrgb8888 size 160x120\n"
#define H " 0123456789abcdef\n"

static void a_file_that_is_no_golden_file_is_bad_input_with_its_line(void **state) {
    (void)state;
    static const struct {
        const char *text, *says;
    } bad[] = {
        {"", ":1: "},
        {"vitrine-work 1\n", ":1: "},
        {"vitrine-golden 1\nframes 0:3 view final\n", ":2: "},
        {"vitrine-golden 1\nframes 3:3 view final format xrgb8888 size 160x120\n", ":2: "},
        {"vitrine-golden 1\nframes 0:4294967299 view final format xrgb8888 size 160x120\n", ":2: "},
        {HEAD, ":3: "},
        {HEAD "0" H "1" H, "ends before the line 'end'"},
        {HEAD "0" H "2" H, ":4: frames must follow"},
        {HEAD "1" H, ":3: frames must follow"},
        {HEAD "0 0123456789abcde\n", ":3: "},
        {HEAD "0 0123456789ABCDEF\n", ":3: "},
        {HEAD "0 0x23456789abcdef\n", ":3: "},
        {HEAD "0  123456789abcdef\n", ":3: "},
        {HEAD "0" H "1" H "2" H "3" H "end\n", ":6: the line 'end' must come here"},
        {HEAD "0" H "1" H "2" H "end\nend\n", "after the line 'end'"},
        {HEAD "# a remark\n0" H "1" H "2 x\n", ":6: "},
        {HEAD "0" H "1" H "2" H "end", "no end"},
    };
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        put_bytes(CHANGED, bad[i].text, strlen(bad[i].text));
        refuses("--golden " CHANGED, VIT_BAD_INPUT, bad[i].says);
        assert_non_null(strstr(r.err, "changed.golden"));
    }
    refuses("--golden " FOLDER "/nowhere.golden", VIT_BAD_INPUT, "nowhere.golden");
    refuses("--golden /dev/zero", VIT_BAD_INPUT, "/dev/zero:1: ");
}

static void options_that_make_no_sense_are_refused(void **state) {
    (void)state;
    play("--write-golden " GOLDEN);
    refuses("--golden " GOLDEN " --write-golden " GOLDEN, VIT_USAGE, "not both");
    refuses("--golden " GOLDEN " --report=" GOLDEN, VIT_USAGE, "would overwrite --golden");
    refuses("--trace --golden " GOLDEN, VIT_USAGE, "--trace");
    refuses("--golden=", VIT_USAGE, "--golden needs a file's name");
    refuses("--write-golden " FOLDER "/no/such/folder", VIT_FAILED, "no/such/folder");
    tool(&r, TOOL_PLAY " %s --write-golden %s", test_pack("list"), test_pack("list"));
    tool_refuses(&r, "vitrine-play", VIT_USAGE, "would overwrite the pack");
}

/* stdout and stderr in one file: every line is whole. */
static void tables_and_messages_in_one_pipe_keep_their_lines(void **state) {
    (void)state;
    char script[1024];
    (void)snprintf(script, sizeof script, TOOL_PLAY " %s --device host --report --count-work --max-list 100 2>&1\n",
                   test_pack("list"));
    put(FOLDER "/run.sh", script);
    tool(&r, "sh " FOLDER "/run.sh");
    (void)unlink(FOLDER "/run.sh");
    tool_succeeds(&r);
    int faults = 0, tables = 0;
    char *rest = NULL;
    for (char *line = strtok_r(r.out, "\n", &rest); line; line = strtok_r(NULL, "\n", &rest)) {
        const char *message = strstr(line, "vitrine-play: ");
        if (message && message != line)
            fail_msg("a message within a line: %s", line);
        faults += message != NULL;
        tables += strncmp(line, "host, framebuffer", 17) == 0 || strncmp(line, "* depends on the lanes", 22) == 0;
    }
    assert_true(faults > 0);
    assert_int_equal(tables, 2);
}

static void frames_and_text_do_not_share_a_pipe(void **state) {
    (void)state;
    char script[1024];
    (void)snprintf(script, sizeof script, TOOL_PLAY " %s --device host --frames 0 --out raw:- $1 2>&1\n", test_pack("list"));
    put(FOLDER "/run.sh", script);
    tool(&r, "sh " FOLDER "/run.sh");
    const tool_run loud = r;
    tool(&r, "sh " FOLDER "/run.sh --quiet");
    (void)unlink(FOLDER "/run.sh");
    assert_int_equal(loud.code, VIT_USAGE);
    assert_non_null(strstr(loud.out, "text would be among the frames"));
    tool_succeeds(&r);
}

static void is_a_link(const char *path) {
    struct stat s;
    assert_int_equal(lstat(path, &s), 0);
    assert_true(S_ISLNK(s.st_mode));
}

/* A relative link to a link to a file, which is there or is not yet. */
static void links_are_followed(void **state) {
    (void)state;
    static const char *const options[] = {"--write-golden ", "--write-work-budget ", "--report=", "--out raw:"};
    char line[128];
    assert_int_equal(symlink("second", LINK), 0);
    assert_int_equal(symlink("changed.golden", SECOND), 0);
    for (size_t i = 0; i < sizeof options / sizeof options[0]; i++)
        for (int there = 0; there < 2; there++) {
            static const char old[] = "old";
            (void)unlink(CHANGED);
            if (there)
                put_bytes(CHANGED, old, sizeof old - 1);
            (void)snprintf(line, sizeof line, "%s" LINK, options[i]);
            play(line);
            tool_succeeds(&r);
            is_a_link(LINK);
            is_a_link(SECOND);
            struct stat s;
            assert_int_equal(stat(CHANGED, &s), 0);
            assert_true(s.st_size > (off_t)sizeof old);
        }
    refuses("--write-golden " LINK " --report=" CHANGED, VIT_USAGE, "would write the same file");
    (void)unlink(CHANGED);
    refuses("--write-golden " LINK " --report=" CHANGED, VIT_USAGE, "would write the same file");
    (void)unlink(SECOND);
    assert_int_equal(symlink("link", SECOND), 0); /* in a circle */
    play("--write-golden " LINK);
    assert_int_equal(r.code, VIT_FAILED);
    is_a_link(LINK);
    (void)unlink(SECOND);
    (void)unlink(LINK);
}

/* Plays in a shell, which sets stdout up. */
static void play_in_shell(const char *options) {
    char script[1024];
    (void)snprintf(script, sizeof script, TOOL_PLAY " %s --quiet --device host %s\n", test_pack("list"), options);
    put(SCRIPT, script);
    tool(&r, "sh " SCRIPT);
    (void)unlink(SCRIPT);
    tool_succeeds(&r);
}

/* LINK is a link such as /dev/stdout. */
static void what_is_no_file_or_is_stdout_is_written_to_in_place(void **state) {
    (void)state;
    play("--write-golden " GOLDEN);
    read_into(GOLDEN, whole, TOOL_TEXT);
    assert_int_equal(symlink("/proc/self/fd/1", LINK), 0);
    play("--write-golden " LINK); /* stdout is a file without a name */
    tool_succeeds(&r);
    assert_string_equal(r.out, whole);
    play_in_shell("--hash --write-golden " LINK " > " CHANGED);
    read_into(CHANGED, file, TOOL_TEXT);
    assert_int_equal(strlen(file), strlen(whole) + 3 * 24); /* the hashes' lines, too */
    assert_non_null(strstr(file, whole));
    play_in_shell("--write-golden " LINK " | cat > " CHANGED);
    read_into(CHANGED, file, TOOL_TEXT);
    assert_string_equal(file, whole);
    is_a_link(LINK);
    (void)unlink(LINK);
    assert_int_equal(mkfifo(LINK, 0666), 0);
    const int pipe_end = open(LINK, O_RDWR | O_CLOEXEC);
    play("--write-golden " LINK);
    tool_succeeds(&r);
    (void)memset(file, 0, sizeof file);
    assert_int_equal(read(pipe_end, file, sizeof file - 1), strlen(whole));
    (void)close(pipe_end);
    assert_string_equal(file, whole);
    struct stat s;
    assert_int_equal(lstat(LINK, &s), 0);
    assert_true(S_ISFIFO(s.st_mode));
    (void)unlink(LINK);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_file_has_the_hashes_of_the_frames_and_every_device_agrees),
        cmocka_unit_test(the_first_wrong_frame_is_named),
        cmocka_unit_test(the_report_holds_verdict_and_hashes),
        cmocka_unit_test(hashes_of_other_frames_views_formats_and_sizes_are_not_compared),
        cmocka_unit_test(a_file_that_is_no_golden_file_is_bad_input_with_its_line),
        cmocka_unit_test(options_that_make_no_sense_are_refused),
        cmocka_unit_test(links_are_followed),
        cmocka_unit_test(what_is_no_file_or_is_stdout_is_written_to_in_place),
        cmocka_unit_test(tables_and_messages_in_one_pipe_keep_their_lines),
        cmocka_unit_test(frames_and_text_do_not_share_a_pipe),
    };
    return cmocka_run_group_tests_name("golden files", tests, set_up, tear_down);
}
