/* Signals at any moment. Under a pack's name there is the pack of before or the new one, whole, since a rename is all that ever
 * happens to that name; kill -9 may leave a temporary file, but not two, since the next save removes what the killed ones left,
 * and SIGINT and SIGTERM leave none. Moments are counted, not timed: a library put before libc's (tests/preload/signal_at.c)
 * signals the baker before, within and after each call that it makes on the output's folder, first to last, until a run ends by
 * itself. So every step of saving is met on the slowest machine as on the fastest, and the test knows which. A few kills at
 * arbitrary moments follow, of which only that is asked which must always hold. */
#include "pack/pack_write.h"
#include "test_packs.h"

#include <dirent.h>
#include <fcntl.h>
#include <signal.h>
#include <stdbool.h>
#include <time.h>

enum { MOST_MOMENTS = 200, KILLS = 12, SAVES = 30, SAVED = 1 << 20 };

#define PACK "scene.vit"

typedef struct folder {
    char path[TEST_FOLDER];
    char pack[96];
} folder;

/* The pack of before and the one that the baker saves over it. */
typedef struct packs {
    void *bytes[2];
    size_t sizes[2];
} packs;

static tool_run r;

static folder make_folder(void) {
    folder f;
    folder_make_temporary(f.path);
    path_join(f.pack, sizeof f.pack, f.path, PACK);
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

static void begin_bake(const folder *f, const char *environment, const char *frames) {
    tool_line(&r, "%s " TOOL_BAKE " " TEST_PACKS "/lamp.cfg -o %s --quiet --no-check --device host --frames %s", environment,
              f->pack, frames);
    tool_begin(&r);
}

static void save(const folder *f, const void *bytes, size_t size) {
    vit_text why = {""};
    if (pack_save(f->pack, bytes, size, &why) != VIT_OK)
        fail_msg("%s", why.text);
}

/* The folder then holds the old one alone. */
static packs bake_two(const folder *f) {
    static const char *const frames[2] = {"1", "2"};
    packs p;
    test_packs_begin();
    for (int i = 0; i < 2; i++) {
        begin_bake(f, "", frames[i]);
        tool_end(&r);
        tool_succeeds(&r);
        p.bytes[i] = read_file(f->pack, &p.sizes[i]);
    }
    assert_int_not_equal(p.sizes[0], p.sizes[1]);
    save(f, p.bytes[0], p.sizes[0]);
    assert_int_equal(others(f, false), 0);
    return p;
}

/* Which of the two is under the pack's name; anything else fails the test. */
static int which_is_there(const folder *f, const packs *p) {
    size_t size;
    void *bytes = read_file(f->pack, &size);
    const int which = size == p->sizes[1];
    assert_int_equal(size, p->sizes[which]);
    assert_memory_equal(bytes, p->bytes[which], size);
    free(bytes);
    return which;
}

static void free_packs(packs *p) {
    free(p->bytes[0]);
    free(p->bytes[1]);
}

/* What the preloaded library said of its moment; NULL: the run ended before that moment. */
static const char *told(void) {
    static char moment[64];
    const char *at = strstr(r.err, "signal: ");
    if (!at)
        return NULL;
    (void)snprintf(moment, sizeof moment, "%.*s", (int)strcspn(at + 8, "\n"), at + 8);
    return moment;
}

/* The moments that any way of saving safely has: with the old pack there, but for the last. */
static const char *const needed[] = {"after-open",   "before-write", "half-of-write", "after-write",
                                     "before-fsync", "after-fsync",  "before-rename", "after-rename"};
enum { NEEDED = sizeof needed / sizeof needed[0] };

typedef struct seen {
    int moments, left, is_new;
    bool met[NEEDED];
} seen;

/* The baker, signalled at moment `at`; false if it had ended by then. */
static bool meet(const folder *f, const packs *p, int number, int at, seen *s) {
    char environment[256];
    (void)snprintf(environment, sizeof environment, "SIGNAL_FOLDER=%s SIGNAL_AT=%d SIGNAL_NUMBER=%d LD_PRELOAD=" TOOL_SIGNAL_AT,
                   f->path, at, number);
    begin_bake(f, environment, "2");
    tool_end(&r);
    const char *moment = told();
    if (!moment) {
        tool_succeeds(&r);
        assert_int_equal(which_is_there(f, p), 1);
        assert_int_equal(others(f, false), 0);
        return false;
    }
    const int is_new = which_is_there(f, p), left = others(f, false);
    print_message("%3d %-14s %s pack, %d file left\n", at, moment, is_new ? "new" : "old", left);
    assert_int_equal(r.code, number == SIGKILL ? -1 : VIT_FAILED);
    assert_true(left <= (number == SIGKILL ? 1 : 0));
    assert_true(is_new || s->is_new == 0); /* from the rename on the new one */
    s->moments++;
    s->left += left;
    s->is_new += is_new;
    for (int i = 0; i < NEEDED; i++)
        s->met[i] |= strcmp(moment, needed[i]) == 0 && is_new == (i == NEEDED - 1);
    save(f, p->bytes[0], p->sizes[0]); /* the old one again; with it goes what was left */
    assert_int_equal(others(f, false), 0);
    return true;
}

static void signal_at_every_moment(int number) {
    const folder f = make_folder();
    packs p = bake_two(&f);
    seen s = {0};
    int at = 1;
    while (meet(&f, &p, number, at, &s))
        assert_true(++at < MOST_MOMENTS);
    for (int i = 0; i < NEEDED; i++)
        if (!s.met[i])
            fail_msg("no moment '%s' of saving was met", needed[i]);
    assert_true(s.is_new > 0 && s.is_new < s.moments);
    assert_true((s.left > 0) == (number == SIGKILL));
    free_packs(&p);
    remove_folder(&f);
}

static void a_baker_killed_at_any_step_of_saving_leaves_the_old_pack_or_the_new_one(void **state) {
    (void)state;
    signal_at_every_moment(SIGKILL);
}

static void an_interrupted_baker_leaves_no_other_file_at_any_step_of_saving(void **state) {
    (void)state;
    signal_at_every_moment(SIGINT);
    signal_at_every_moment(SIGTERM);
}

/* The process is stopped somewhere; where, nothing here depends on. */
static void after_a_while(long microseconds) {
    const struct timespec t = {.tv_sec = microseconds / 1000000, .tv_nsec = microseconds % 1000000 * 1000};
    (void)nanosleep(&t, NULL);
}

static void kill_child(pid_t child) {
    int status;
    assert_int_equal(kill(child, SIGKILL), 0);
    assert_int_equal(waitpid(child, &status, 0), child);
}

static void a_baker_killed_whenever_leaves_the_old_pack_or_the_new_one(void **state) {
    const folder f = make_folder();
    packs p = bake_two(&f);
    int is_new = 0;
    (void)state;
    for (int i = 0; i < KILLS; i++) {
        begin_bake(&f, "", "2");
        after_a_while(30000 * i);
        kill_child(r.child);
        (void)fclose(r.to_out);
        (void)fclose(r.to_err);
        const int which = which_is_there(&f, &p);
        is_new += which;
        assert_true(others(&f, false) <= 1);
        if (which == 1)
            save(&f, p.bytes[0], p.sizes[0]);
    }
    print_message("%d kills: %d after the new pack\n", KILLS, is_new);
    free_packs(&p);
    remove_folder(&f);
}

/* What begins as a pack does, and is one value else. */
static void fill(unsigned char *bytes, int value) {
    memset(bytes, value, SAVED);
    memcpy(bytes, VIT_PACK_MAGIC, sizeof VIT_PACK_MAGIC);
}

/* In a child: saves two packs in turn until it is killed. */
static void save_for_ever(const folder *f, unsigned char *bytes) {
    vit_text why = {""};
    for (unsigned char i = 0;; i = !i) {
        fill(bytes, 2 - i);
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
    fill(bytes, 1);
    save(&f, bytes, SAVED);
    for (int i = 0; i < SAVES; i++) {
        const pid_t child = fork();
        assert_true(child >= 0);
        if (child == 0)
            save_for_ever(&f, bytes);
        after_a_while(700 * i);
        kill_child(child);
        const int left = others(&f, false);
        assert_true(left <= 1);
        with_rest += left;
        size_t size;
        unsigned char *found = read_file(f.pack, &size);
        assert_int_equal(size, SAVED);
        assert_true(found[SAVED - 1] == 1 || found[SAVED - 1] == 2);
        fill(bytes, found[SAVED - 1]);
        assert_memory_equal(found, bytes, SAVED);
        replaced += found[SAVED - 1] == 2;
        free(found);
    }
    print_message("%d kills: %d after the second pack, %d left a file\n", SAVES, replaced, with_rest);
    free(bytes);
    remove_folder(&f);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_baker_killed_at_any_step_of_saving_leaves_the_old_pack_or_the_new_one),
        cmocka_unit_test(an_interrupted_baker_leaves_no_other_file_at_any_step_of_saving),
        cmocka_unit_test(a_baker_killed_whenever_leaves_the_old_pack_or_the_new_one),
        cmocka_unit_test(a_process_killed_while_it_saves_leaves_a_whole_pack_and_one_file_at_most),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
