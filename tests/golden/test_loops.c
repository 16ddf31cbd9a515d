/* Loops without an end: how they are ended, and what they say then.
 *
 * Why this is hard: the end comes from outside at some moment. Strategy: the player prints a line a frame, which is waited for;
 * the signal comes when it has begun its third round, however long that took. */
#include "test_packs.h"

#include <fcntl.h>
#include <signal.h>
#include <time.h>

enum { ROUND = 3 }; /* frames of the pack */

static tool_run r;

static int set_up(void **state) {
    (void)state;
    test_packs_begin();
    return 0;
}

static int lines_of(const char *text) {
    int lines = 0;
    for (; *text; text++)
        lines += *text == '\n';
    return lines;
}

/* Plays until two rounds are over. */
static void play_two_rounds(const char *options) {
    tool_line(&r, TOOL_PLAY " %s --device host --hash %s", test_pack("list"), options);
    tool_begin(&r);
    do {
        (void)nanosleep(&(struct timespec){.tv_nsec = 10000000}, NULL);
        tool_text(r.to_out, r.out);
    } while (lines_of(r.out) <= 2 * ROUND && waitpid(r.child, NULL, WNOHANG) == 0);
}

static void play_and_end(const char *options, int number) {
    play_two_rounds(options);
    (void)kill(r.child, number);
    tool_end(&r);
}

static void sigterm_ends_a_loop_well(void **state) {
    (void)state;
    play_and_end("--loop inf --verify", SIGTERM);
    tool_succeeds(&r);
    assert_non_null(strstr(r.err, "every hash is the pack's"));
    assert_true(lines_of(r.out) > 2 * ROUND);
    assert_true(strlen(r.out) == TOOL_TEXT - 1 || r.out[strlen(r.out) - 1] == '\n'); /* or there are more lines than text */
    play_and_end("--loop 100000000", SIGTERM);
    tool_succeeds(&r);
}

/* timeout(1) signals the process and then its group. Several runs: the second one may come at any moment of the end. */
static void a_signal_that_comes_twice_is_one(void **state) {
    (void)state;
    for (int i = 0; i < 12; i++) {
        play_two_rounds("--loop inf");
        (void)kill(r.child, SIGTERM);
        for (int passed = 0; passed < i * 2000; passed++) /* later each time */
            (void)getppid();
        (void)kill(r.child, SIGTERM);
        tool_end(&r);
        tool_succeeds(&r);
    }
}

/* The pipe is never read: the first frame does not fit. */
static void who_keeps_on_signalling_ends_a_player_that_hangs(void **state) {
    (void)state;
    static const char pipe_path[] = TEST_PACKS "/unread";
    (void)unlink(pipe_path);
    assert_int_equal(mkfifo(pipe_path, 0666), 0);
    const int unread = open(pipe_path, O_RDWR | O_CLOEXEC);
    assert_true(unread >= 0);
    tool_line(&r, TOOL_PLAY " %s --device host --loop inf --out raw:%s", test_pack("list"), pipe_path);
    tool_begin(&r);
    char byte;
    assert_int_equal(read(unread, &byte, 1), 1); /* it writes */
    int status, sent = 0;
    do {
        (void)kill(r.child, SIGTERM);
        (void)nanosleep(&(struct timespec){.tv_nsec = 10000000}, NULL);
        sent++;
    } while (waitpid(r.child, &status, WNOHANG) == 0);
    (void)close(unread);
    (void)unlink(pipe_path);
    (void)fclose(r.to_out);
    (void)fclose(r.to_err);
    assert_true(sent >= 3);
    assert_true(WIFSIGNALED(status) && WTERMSIG(status) == SIGTERM);
}

static void what_a_loop_found_out_counts_when_it_is_ended(void **state) {
    (void)state;
    play_and_end("--loop inf --budget 0.000001", SIGTERM);
    assert_int_equal(r.code, 3);
}

static void ctrl_c_is_an_interruption(void **state) {
    (void)state;
    play_and_end("--loop inf", SIGINT);
    assert_int_equal(r.code, 1);
    assert_non_null(strstr(r.err, "interrupted at frame "));
}

static void every_round_has_the_same_frames(void **state) {
    (void)state;
    tool(&r, TOOL_PLAY " %s --device host --quiet --hash --loop 3", test_pack("list"));
    tool_succeeds(&r);
    assert_int_equal(lines_of(r.out), 3 * ROUND);
    const size_t round = strlen(r.out) / 3;
    assert_memory_equal(r.out, r.out + round, round);
    assert_memory_equal(r.out, r.out + 2 * round, round);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sigterm_ends_a_loop_well),
        cmocka_unit_test(a_signal_that_comes_twice_is_one),
        cmocka_unit_test(who_keeps_on_signalling_ends_a_player_that_hangs),
        cmocka_unit_test(what_a_loop_found_out_counts_when_it_is_ended),
        cmocka_unit_test(ctrl_c_is_an_interruption),
        cmocka_unit_test(every_round_has_the_same_frames),
    };
    return cmocka_run_group_tests_name("loops", tests, set_up, NULL);
}
