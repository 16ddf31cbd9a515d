/* Loops without an end: how they are ended, and what they say then.
 *
 * Why this is hard: the end comes from outside at some moment. Strategy: the player prints a line a frame, which is waited for;
 * the signal comes when it has begun its third round, however long that took. */
#include "test_packs.h"

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

/* Plays until two rounds are over, then sends the signal. */
static void play_and_end(const char *options, int number) {
    tool_line(&r, TOOL_PLAY " %s --device host --hash %s", test_pack("list"), options);
    tool_begin(&r);
    do {
        (void)nanosleep(&(struct timespec){.tv_nsec = 10000000}, NULL);
        tool_text(r.to_out, r.out);
    } while (lines_of(r.out) <= 2 * ROUND && waitpid(r.child, NULL, WNOHANG) == 0);
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
        cmocka_unit_test(what_a_loop_found_out_counts_when_it_is_ended),
        cmocka_unit_test(ctrl_c_is_an_interruption),
        cmocka_unit_test(every_round_has_the_same_frames),
    };
    return cmocka_run_group_tests_name("loops", tests, set_up, NULL);
}
