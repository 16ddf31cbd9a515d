/* The player's outside: exit codes, one-line errors and refused combinations.
 *
 * Why this is hard: most of the player only shows with a pack and a device, and both are slow to come by. Strategy: run the
 * real program, as a shell would, on everything that must be decided before a pack is read, and on files that are no pack.
 * Nothing here opens a device. What the frames are is the golden tests' subject. Each error is held to the same three
 * promises: the exit code says the cause, stderr is one line that begins with the program's name, stdout is empty. */
#include "play/sinks/sink.h"
#include "test_folder.h"
#include <fcntl.h>
#include <stdbool.h>
#include <sys/wait.h>

#define PLAYER VIT_BUILD_DIR "/vitrine-play"
#define WORDS_MAX 12
#define TEXT_MAX 16384
#define SECONDS_MAX 7200 /* a player that hangs is killed, and its exit code is no exit code then */

/* The folder of this run and what lies in it. */
typedef struct bench {
    char folder[64];
    char missing[96], empty[96], garbage[96], magic_only[96], pipe[96], out[96], err[96];
} bench;

typedef struct outcome {
    int code; /* exit code; -1: killed by a signal */
    char out[TEXT_MAX], err[TEXT_MAX];
} outcome;

static int set_up(void **state) {
    static bench b;
    folder_make_temporary(b.folder);
    path_join(b.missing, sizeof b.missing, b.folder, "missing.vit");
    path_join(b.empty, sizeof b.empty, b.folder, "empty.vit");
    path_join(b.garbage, sizeof b.garbage, b.folder, "garbage.vit");
    path_join(b.magic_only, sizeof b.magic_only, b.folder, "magic.vit");
    path_join(b.pipe, sizeof b.pipe, b.folder, "pipe.vit");
    path_join(b.out, sizeof b.out, b.folder, "out");
    path_join(b.err, sizeof b.err, b.folder, "err");
    unsigned char noise[8192];
    for (size_t i = 0; i < sizeof noise; i++)
        noise[i] = (unsigned char)(i * 2654435761u >> 13);
    put_bytes(b.empty, "", 0);
    put_bytes(b.garbage, noise, sizeof noise);
    put_bytes(b.magic_only, "VITRINE", 8);
    assert_int_equal(mkfifo(b.pipe, 0600), 0);
    *state = &b;
    return 0;
}

static int tear_down(void **state) {
    const bench *b = *state;
    const char *files[] = {b->empty, b->garbage, b->magic_only, b->pipe, b->out, b->err};
    for (size_t i = 0; i < sizeof files / sizeof files[0]; i++)
        (void)unlink(files[i]);
    return rmdir(b->folder); /* fails if the player left anything behind */
}

/* In the child: never returns. */
static void become_player(const char *out, const char *err, char *const words[]) {
    int to_out = open(out, O_WRONLY | O_CREAT | O_TRUNC, 0600), to_err = open(err, O_WRONLY | O_CREAT | O_TRUNC, 0600);
    if (to_out >= 0 && to_err >= 0 && dup2(to_out, STDOUT_FILENO) >= 0 && dup2(to_err, STDERR_FILENO) >= 0) {
        (void)alarm(SECONDS_MAX);
        (void)execv(PLAYER, words);
    }
    _exit(127);
}

/* Runs the player with the words of `line`, split at spaces; stdout goes to `out`. */
static void run_into(const bench *b, const char *out, const char *line, outcome *o) {
    char copy[1024];
    char *words[WORDS_MAX + 2] = {(char *)(uintptr_t)PLAYER};
    size_t count = 1;
    (void)snprintf(copy, sizeof copy, "%s", line);
    char *rest = NULL;
    for (char *word = strtok_r(copy, " ", &rest); word != NULL; word = strtok_r(NULL, " ", &rest)) {
        assert_true(count <= WORDS_MAX);
        words[count++] = word;
    }
    pid_t child = fork();
    assert_true(child >= 0);
    if (child == 0)
        become_player(out, b->err, words);
    int status;
    assert_int_equal(waitpid(child, &status, 0), child);
    o->code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    read_into(b->err, o->err, TEXT_MAX);
    o->out[0] = '\0';
    if (strcmp(out, b->out) == 0)
        read_into(out, o->out, TEXT_MAX);
}

static void run(const bench *b, const char *line, outcome *o) {
    run_into(b, b->out, line, o);
}

static bool is_one_line(const char *text) {
    const char *feed = strchr(text, '\n');
    return feed != NULL && feed != text && feed[1] == '\0';
}

/* The three promises, and that the line says `says`. */
static void refuses(const bench *b, const char *line, vit_status code, const char *says) {
    outcome o;
    run(b, line, &o);
    if (o.code != (int)code || !is_one_line(o.err) || strncmp(o.err, "vitrine-play: ", 14) != 0 || o.out[0] != '\0' ||
        strstr(o.err, says) == NULL)
        fail_msg("vitrine-play %s\nexit %d, want %d; stderr must be one line with '%s'\nstderr: %s\nstdout: %s", line, o.code,
                 (int)code, says, o.err, o.out);
}

static void help_names_every_exit_code_sink_view_and_format(void **state) {
    static outcome o;
    run(*state, "--help", &o);
    assert_int_equal(o.code, VIT_OK);
    assert_string_equal(o.err, "");
#define X(name, value, meaning) assert_non_null(strstr(o.out, "\n  " #value "  " meaning "\n"));
    VIT_STATUSES(X)
#undef X
#define X(name, light, meaning) assert_non_null(strstr(o.out, "\n  " #name " "));
    VIT_VIEWS(X)
#undef X
#define X(name, word, bytes, word_bytes, meaning) assert_non_null(strstr(o.out, meaning));
    VIT_FORMATS(X)
#undef X
#define X(name) assert_non_null(strstr(o.out, "\n  " #name));
    SINKS(X)
#undef X
}

static void version_is_the_librarys(void **state) {
    static outcome o;
    run(*state, "--version", &o);
    assert_int_equal(o.code, VIT_OK);
    assert_string_equal(o.out, "vitrine-play " VIT_VERSION "\n");
    assert_string_equal(o.err, "");
}

static void a_full_disk_behind_stdout_is_a_failure(void **state) {
    outcome o;
    run_into(*state, "/dev/full", "--help", &o);
    assert_int_equal(o.code, VIT_FAILED);
    assert_true(is_one_line(o.err));
    assert_non_null(strstr(o.err, "stdout: No space left"));
}

static void an_unknown_option_is_named(void **state) {
    refuses(*state, "--bogus", VIT_USAGE, "'--bogus'");
    refuses(*state, "--bogus=3", VIT_USAGE, "'--bogus'");
    refuses(*state, "-z", VIT_USAGE, "'-z'");
    refuses(*state, "scene.vit --verif", VIT_USAGE, "'--verif'");
}

static void no_pack_and_two_packs_are_usage_errors(void **state) {
    refuses(*state, "", VIT_USAGE, "no pack");
    refuses(*state, "--verify", VIT_USAGE, "no pack");
    refuses(*state, "a.vit b.vit", VIT_USAGE, "one pack");
}

static void a_file_that_is_no_pack_is_bad_input_and_is_named(void **state) {
    const bench *b = *state;
    const char *files[] = {b->missing, b->folder, b->empty, b->garbage, b->magic_only, b->pipe};
    static const char *const ways[] = {"", "--verify", "--hash", "--explain", "--trace"};
    for (size_t i = 0; i < sizeof files / sizeof files[0]; i++)
        for (size_t k = 0; k < sizeof ways / sizeof ways[0]; k++) {
            char line[256];
            (void)snprintf(line, sizeof line, "%s %s", files[i], ways[k]);
            refuses(b, line, VIT_BAD_INPUT, files[i]);
        }
}

static void a_bad_pack_makes_no_output(void **state) {
    const bench *b = *state;
    static const char *const kinds[] = {"png", "ppm", "raw", "y4m"};
    for (size_t i = 0; i < sizeof kinds / sizeof kinds[0]; i++) {
        char line[256], target[128];
        (void)snprintf(target, sizeof target, "%s/made", b->folder);
        (void)snprintf(line, sizeof line, "%s --out %s:%s", b->garbage, kinds[i], target);
        refuses(b, line, VIT_BAD_INPUT, b->garbage);
        assert_int_not_equal(access(target, F_OK), 0);
    }
}

static void a_size_is_refused_whatever_the_pack(void **state) {
    const bench *b = *state;
    char line[256];
    refuses(b, "nowhere.vit --size 640x480", VIT_USAGE, "the size is fixed by the pack");
    (void)snprintf(line, sizeof line, "--size=640x480 %s", b->garbage);
    refuses(b, line, VIT_USAGE, "set output in the scene file and bake again");
}

static void frames_that_name_no_range_are_refused(void **state) {
    static const char *const bad[] = {":",  "x",    "1:x",  "x:2",   "3:3",  "4:2",        "0:0",          ":0",
                                      "-1", "-1:2", "+1:2", "1:2:3", "1..2", "4294967296", "0:4294967296", "0x1:2"};
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        char line[64];
        (void)snprintf(line, sizeof line, "nowhere.vit --frames %s", bad[i]);
        refuses(*state, line, VIT_USAGE, "--frames");
    }
    refuses(*state, "nowhere.vit --frames", VIT_USAGE, "--frames A:B");
    refuses(*state, "nowhere.vit --frames=", VIT_USAGE, "--frames");
}

/* The pack is missing: that it is complained about says that the options passed. */
static void frames_in_each_form_are_accepted(void **state) {
    static const char *const good[] = {"0:24", "3:", ":3", "7", "0:1", "--frames=5:6"};
    for (size_t i = 0; i < sizeof good / sizeof good[0]; i++) {
        char line[64];
        (void)snprintf(line, sizeof line, "nowhere.vit %s%s", good[i][0] == '-' ? "" : "--frames ", good[i]);
        refuses(*state, line, VIT_BAD_INPUT, "nowhere.vit");
    }
}

static void values_out_of_range_are_refused_with_what_is_taken(void **state) {
    refuses(*state, "nowhere.vit --lanes 4", VIT_USAGE, "0, 1, 8 or 16");
    refuses(*state, "nowhere.vit --group 3", VIT_USAGE, "power of two");
    refuses(*state, "nowhere.vit --group 512", VIT_USAGE, "256");
    refuses(*state, "nowhere.vit --loop 0", VIT_USAGE, "--loop");
    refuses(*state, "nowhere.vit --loop info", VIT_USAGE, "or inf");
    refuses(*state, "nowhere.vit --threads 0", VIT_USAGE, "1 to 256");
    refuses(*state, "nowhere.vit --threads 257 --device host", VIT_USAGE, "1 to 256");
    refuses(*state, "nowhere.vit --threads 2 --device pocl", VIT_USAGE, "--threads is for --device host");
    refuses(*state, "nowhere.vit --host-isa avx2 --device 0", VIT_USAGE, "--host-isa is for --device host");
    refuses(*state, "nowhere.vit --host-isa avx2 --threads 2 --device gpu", VIT_USAGE, "--threads is for --device host");
    refuses(*state, "nowhere.vit --device -1", VIT_USAGE, "--device");
    refuses(*state, "nowhere.vit --max-nodes 0", VIT_USAGE, "--max-nodes");
    refuses(*state, "nowhere.vit --max-list ten", VIT_USAGE, "--max-list");
    refuses(*state, "nowhere.vit --view inside", VIT_USAGE, "'inside'");
    refuses(*state, "nowhere.vit --format jpeg", VIT_USAGE, "(xrgb8888, rgb565 or rgba32f)");
    refuses(*state, "nowhere.vit --out jpeg", VIT_USAGE, "(null, raw, map, y4m, ppm or png)");
    refuses(*state, "nowhere.vit --out png:-", VIT_USAGE, "to stdout: raw or y4m");
    refuses(*state, "nowhere.vit --quiet=1", VIT_USAGE, "--quiet takes no value");
    refuses(*state, "nowhere.vit --device", VIT_USAGE, "--device needs a value");
}

static void sinks_that_cannot_be_are_refused(void **state) {
    refuses(*state, "nowhere.vit --out gif:x", VIT_USAGE, "'gif'");
    refuses(*state, "nowhere.vit --out png", VIT_USAGE, "png:DIR");
    refuses(*state, "nowhere.vit --out raw:", VIT_USAGE, "raw:FILE|-");
    refuses(*state, "nowhere.vit --out null:x", VIT_USAGE, "no target");
    refuses(*state, "nowhere.vit --out y4m:x --format rgb565", VIT_USAGE, "xrgb8888");
    refuses(*state, "nowhere.vit --format rgba32f --out png:x", VIT_USAGE, "xrgb8888");
}

static void options_that_exclude_each_other_are_refused(void **state) {
    refuses(*state, "nowhere.vit --verify --view depth", VIT_USAGE, "--view");
    refuses(*state, "nowhere.vit --hash --out raw:-", VIT_USAGE, "stdout");
    refuses(*state, "nowhere.vit --trace --hash", VIT_USAGE, "--trace");
    refuses(*state, "nowhere.vit --trace --verify", VIT_USAGE, "--trace");
    refuses(*state, "nowhere.vit --trace --out ppm:x", VIT_USAGE, "--trace");
}

static void options_that_go_together_are_accepted(void **state) {
    refuses(*state, "nowhere.vit --verify --hash --out png:x", VIT_BAD_INPUT, "nowhere.vit");
    refuses(*state, "nowhere.vit --verify --view final --quiet", VIT_BAD_INPUT, "nowhere.vit");
    refuses(*state, "nowhere.vit --verify --format rgba32f --out raw:-", VIT_BAD_INPUT, "nowhere.vit");
    refuses(*state, "--loop inf --device host --threads 256 nowhere.vit", VIT_BAD_INPUT, "nowhere.vit");
    refuses(*state, "--lanes 16 --group 64 --fps --loop 2 -- nowhere.vit", VIT_BAD_INPUT, "nowhere.vit");
}

static void an_error_is_one_line_even_if_the_file_name_is_not(void **state) {
    refuses(*state, "no\nwhere.vit", VIT_BAD_INPUT, "no?where.vit");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(help_names_every_exit_code_sink_view_and_format),
        cmocka_unit_test(version_is_the_librarys),
        cmocka_unit_test(a_full_disk_behind_stdout_is_a_failure),
        cmocka_unit_test(an_unknown_option_is_named),
        cmocka_unit_test(no_pack_and_two_packs_are_usage_errors),
        cmocka_unit_test(a_file_that_is_no_pack_is_bad_input_and_is_named),
        cmocka_unit_test(a_bad_pack_makes_no_output),
        cmocka_unit_test(a_size_is_refused_whatever_the_pack),
        cmocka_unit_test(frames_that_name_no_range_are_refused),
        cmocka_unit_test(frames_in_each_form_are_accepted),
        cmocka_unit_test(values_out_of_range_are_refused_with_what_is_taken),
        cmocka_unit_test(sinks_that_cannot_be_are_refused),
        cmocka_unit_test(options_that_exclude_each_other_are_refused),
        cmocka_unit_test(options_that_go_together_are_accepted),
        cmocka_unit_test(an_error_is_one_line_even_if_the_file_name_is_not),
    };
    return cmocka_run_group_tests_name("player", tests, set_up, tear_down);
}
