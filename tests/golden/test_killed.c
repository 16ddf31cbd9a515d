/* kill -9 at any moment. Under a pack's name there is the pack of before or the new one, whole, since a rename is all that ever
 * happens to that name; a temporary file may be left, but not two, since the next save removes what the killed ones left. The
 * baker spends its time elsewhere, so a process that does nothing but save is killed as well: it dies in the middle of writing
 * most of the time. Moments come from a fixed sequence over the time that one run takes. */
#include "pack_write.h"
#include "test_packs.h"

#include <dirent.h>
#include <fcntl.h>
#include <signal.h>
#include <stdbool.h>
#include <time.h>

enum { KILLS = 50, SAVES = 50, SAVED = 1 << 20 };

#define PACK "scene.vit"

typedef struct folder {
    char path[64];
    char pack[96];
} folder;

static folder make_folder(void) {
    folder f = {.path = "/tmp/vitrine-test-XXXXXX"};
    assert_non_null(mkdtemp(f.path));
    (void)snprintf(f.pack, sizeof f.pack, "%s/" PACK, f.path);
    return f;
}

/* Files beside the pack; removes them if `clean`. */
static int others(const folder *f, bool clean) {
    int count = 0;
    DIR *d = opendir(f->path);
    assert_non_null(d);
    for (struct dirent *e = readdir(d); e; e = readdir(d)) {
        if (e->d_name[0] == '.' || strcmp(e->d_name, PACK) == 0)
            continue;
        assert_int_equal(strncmp(e->d_name, PACK ".tmp-", sizeof PACK ".tmp-" - 1), 0);
        count++;
        if (clean)
            assert_int_equal(unlinkat(dirfd(d), e->d_name, 0), 0);
    }
    (void)closedir(d);
    return count;
}

static void remove_folder(const folder *f) {
    (void)others(f, true);
    (void)unlink(f->pack);
    assert_int_equal(rmdir(f->path), 0);
}

static double seconds(void) {
    struct timespec t;
    (void)clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static void wait_seconds(double s) {
    const struct timespec t = {.tv_sec = (time_t)s, .tv_nsec = (long)((s - (double)(time_t)s) * 1e9)};
    (void)nanosleep(&t, NULL);
}

/* Place `i` of a sequence that fills 0..1 evenly from the start: the golden ratio's. */
static double moment(int i) {
    const double x = 0.6180339887498949 * i;
    return x - (double)(int)x;
}

/* True if it ended by itself. */
static bool kill_child(pid_t child) {
    int status;
    assert_int_equal(kill(child, SIGKILL), 0);
    assert_int_equal(waitpid(child, &status, 0), child);
    return WIFEXITED(status);
}

static void begin_bake(tool_run *r, const folder *f, const char *frames) {
    test_packs_begin();
    tool_line(r, TOOL_BAKE " " TEST_PACKS "/lamp.cfg -o %s --quiet --device host --frames %s", f->pack, frames);
    tool_begin(r);
}

static void bake_whole(const folder *f, const char *frames, void **bytes, size_t *size) {
    static tool_run r;
    begin_bake(&r, f, frames);
    tool_end(&r);
    tool_succeeds(&r);
    *bytes = test_packs_load(f->pack, size);
}

static void a_killed_baker_leaves_the_old_pack_or_the_new_one(void **state) {
    static tool_run r;
    const folder f = make_folder();
    void *packs[2];
    size_t sizes[2];
    int ended = 0, found[2] = {0, 0}, left = 0;
    (void)state;
    bake_whole(&f, "1", &packs[0], &sizes[0]);
    const double began = seconds();
    bake_whole(&f, "2", &packs[1], &sizes[1]);
    const double whole = seconds() - began;
    assert_int_not_equal(sizes[0], sizes[1]);
    vit_text why = {""};
    assert_int_equal(pack_save(f.pack, packs[0], sizes[0], &why), VIT_OK);
    for (int i = 0; i < KILLS; i++) {
        size_t size;
        begin_bake(&r, &f, "2");
        wait_seconds(1.3 * whole * moment(i));
        ended += kill_child(r.child);
        (void)fclose(r.to_out);
        (void)fclose(r.to_err);
        void *bytes = test_packs_load(f.pack, &size);
        const int which = size == sizes[1];
        assert_int_equal(size, sizes[which]);
        assert_memory_equal(bytes, packs[which], size);
        found[which]++;
        free(bytes);
        left = others(&f, false) > left ? others(&f, false) : left;
        assert_true(left <= 1);
        if (which == 1) /* the old one again */
            assert_int_equal(pack_save(f.pack, packs[0], sizes[0], &why), VIT_OK);
    }
    print_message("%d kills in %.2f s each: %d came late, %d old and %d new packs, at most %d file left\n", KILLS, whole, ended,
                  found[0], found[1], left);
    assert_true(found[0] > 0 && ended < KILLS);
    free(packs[0]);
    free(packs[1]);
    remove_folder(&f);
}

/* In a child: saves two packs in turn until it is killed. */
static void save_for_ever(const folder *f, unsigned char *bytes) {
    vit_text why = {""};
    for (unsigned char i = 0;; i = !i) {
        memset(bytes, 2 - i, SAVED);
        if (pack_save(f->pack, bytes, SAVED, &why) != VIT_OK)
            _exit(1);
    }
}

static void a_process_killed_while_it_saves_leaves_a_whole_pack_and_one_file_at_most(void **state) {
    const folder f = make_folder();
    unsigned char *bytes = malloc(SAVED);
    int with_rest = 0, replaced = 0;
    (void)state;
    assert_non_null(bytes);
    vit_text why = {""};
    memset(bytes, 1, SAVED);
    const double began = seconds();
    assert_int_equal(pack_save(f.pack, bytes, SAVED, &why), VIT_OK);
    const double whole = seconds() - began;
    for (int i = 0; i < SAVES; i++) {
        const pid_t child = fork();
        assert_true(child >= 0);
        if (child == 0)
            save_for_ever(&f, bytes);
        wait_seconds(3 * whole * moment(i));
        assert_false(kill_child(child));
        const int left = others(&f, false);
        assert_true(left <= 1);
        with_rest += left;
        size_t size;
        unsigned char *found = test_packs_load(f.pack, &size);
        assert_int_equal(size, SAVED);
        memset(bytes, found[0], SAVED);
        assert_true(found[0] == 1 || found[0] == 2);
        assert_memory_equal(found, bytes, SAVED);
        replaced += found[0] == 2;
        free(found);
    }
    print_message("%d kills: %d after the second pack, %d left a file\n", SAVES, replaced, with_rest);
    assert_true(with_rest > 0 && replaced > 0);
    free(bytes);
    remove_folder(&f);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_killed_baker_leaves_the_old_pack_or_the_new_one),
        cmocka_unit_test(a_process_killed_while_it_saves_leaves_a_whole_pack_and_one_file_at_most),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
