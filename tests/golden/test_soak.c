/* A kiosk plays for months: a small pack in a loop for many frames must take the same memory and give the same bits all along,
 * and drop nothing. The player writes frames into a pipe; each is compared with that of the first round, and the player's
 * resident memory is read as frames come in. A few hundred frames are part of make test; `make soak` plays 20 000
 * (VITRINE_SOAK_FRAMES). */
#include "test_packs.h"

#include <stdbool.h>

#define PACK TEST_PACKS "/soak.vit"

enum { WIDTH = 32, HEIGHT = 24, FRAMES = 8, FRAME = 4 * WIDTH * HEIGHT, FEW = 600, MOST_GROWTH_KIB = 1024 };

static unsigned char first_round[FRAMES][FRAME];

static unsigned frames_wanted(void) {
    const char *text = getenv("VITRINE_SOAK_FRAMES");
    const unsigned long wanted = text ? strtoul(text, NULL, 10) : FEW;
    assert_in_range(wanted, 8 * FRAMES, 100000000);
    return (unsigned)(wanted / FRAMES * FRAMES);
}

static const char *device(void) {
    const char *wanted = getenv("VITRINE_SOAK_DEVICE");
    return wanted ? wanted : "host";
}

static void bake(void) {
    static tool_run r;
    test_packs_begin();
    tool(&r,
         TOOL_BAKE " " TEST_PACKS "/room.cfg -o " PACK
                   " --quiet --no-check --size %dx%d --frames %d --photons 200 --device host",
         WIDTH, HEIGHT, FRAMES);
    tool_succeeds(&r);
    tool(&r, TOOL_PLAY " " PACK " --verify --quiet --device %s", device()); /* kernels are compiled now */
    tool_succeeds(&r);
}

static pid_t begin_player(unsigned frames, int *from, FILE *to_err) {
    char loop[16];
    int ends[2];
    (void)snprintf(loop, sizeof loop, "%u", frames / FRAMES);
    assert_int_equal(pipe(ends), 0);
    const pid_t child = fork();
    assert_true(child >= 0);
    if (child == 0) {
        (void)dup2(ends[1], STDOUT_FILENO);
        (void)dup2(fileno(to_err), STDERR_FILENO);
        (void)close(ends[0]);
        (void)close(ends[1]);
        (void)execl(TOOL_PLAY, TOOL_PLAY, PACK, "--verify", "--quiet", "--out", "raw:-", "--loop", loop, "--device", device(),
                    (char *)NULL);
        _exit(127);
    }
    (void)close(ends[1]);
    *from = ends[0];
    return child;
}

/* False at the end. */
static bool read_frame(int from, unsigned char frame[FRAME]) {
    size_t done = 0;
    ssize_t got = 1;
    while (done < FRAME && (got = read(from, frame + done, FRAME - done)) > 0)
        done += (size_t)got;
    assert_true(done == 0 || done == FRAME);
    return done == FRAME;
}

/* Resident memory now. */
static long kib_of(pid_t process) {
    char path[64];
    long pages = 0, resident = 0;
    (void)snprintf(path, sizeof path, "/proc/%ld/statm", (long)process);
    FILE *file = fopen(path, "r");
    assert_non_null(file);
    assert_int_equal(fscanf(file, "%ld %ld", &pages, &resident), 2);
    (void)fclose(file);
    return resident * (sysconf(_SC_PAGESIZE) / 1024);
}

static void a_looping_pack_keeps_its_bits_and_its_memory(void **state) {
    static unsigned char frame[FRAME];
    const unsigned frames = frames_wanted();
    unsigned played = 0;
    long most[4] = {0, 0, 0, 0}; /* a quarter of the frames */
    int from, status;
    char said[TOOL_TEXT];
    FILE *to_err = tmpfile();
    (void)state;
    assert_non_null(to_err);
    bake();
    const pid_t player = begin_player(frames, &from, to_err);
    for (; read_frame(from, frame); played++) {
        if (played < FRAMES)
            memcpy(first_round[played], frame, FRAME);
        else if (memcmp(first_round[played % FRAMES], frame, FRAME) != 0)
            fail_msg("frame %u is not frame %u", played, played % FRAMES);
        const unsigned quarter = played / (frames / 4 + 1);
        const long now = played + FRAMES < frames ? kib_of(player) : 0; /* it may have ended before the last ones are read */
        most[quarter] = now > most[quarter] ? now : most[quarter];
    }
    (void)close(from);
    assert_int_equal(waitpid(player, &status, 0), player);
    assert_true(WIFEXITED(status) && WEXITSTATUS(status) == 0);
    assert_int_equal(played, frames);
    print_message("%u frames; most resident memory in each quarter: %ld %ld %ld %ld KiB\n", played, most[0], most[1], most[2],
                  most[3]);
    assert_true(most[0] > 0 && most[3] > 0 && most[3] <= most[0] + MOST_GROWTH_KIB);
    tool_text(to_err, said); /* what is dropped is told even when quiet */
    assert_string_equal(said, "");
    (void)fclose(to_err);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_looping_pack_keeps_its_bits_and_its_memory),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
