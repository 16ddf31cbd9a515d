/* Real files as strangers make them, through the real baker: everything under odd/ of the test scenes (VITRINE_SCENES or
 * ../shared/scenes) is baked or refused with exit 5 and one line, within 2 GiB, and ends: one that hangs is killed by its
 * alarm; every model under gltf/ is baked and plays. Which files there are is the folder's business: they are found, not
 * listed, and without the folder the tests are skipped. Frames are tiny: what is tested is the way through all steps, not the
 * picture. */
#include "tool_run.h"

#include <dirent.h>
#include <sys/resource.h>
#include <sys/stat.h>

#define PACK VIT_BUILD_DIR "/tests/golden/odd_files.vit"

enum { MOST_FILES = 256, MOST_KIB = 2 << 20, OK = 0, BAD_INPUT = 5 };

typedef struct found {
    char paths[MOST_FILES][512];
    int count;
} found;

static int is_mesh(const char *name) {
    static const char *const suffixes[] = {".obj", ".ply", ".gltf", ".glb"};
    const char *dot = strrchr(name, '.');
    for (size_t i = 0; dot && i < sizeof suffixes / sizeof suffixes[0]; i++)
        if (strcmp(dot, suffixes[i]) == 0)
            return 1;
    return 0;
}

/* All meshes in the folder and in the folders of it. */
static void find(found *f, const char *folder, int depth) {
    DIR *d = opendir(folder);
    assert_non_null(d);
    for (struct dirent *e = readdir(d); e; e = readdir(d)) {
        char path[512];
        struct stat st;
        assert_true(snprintf(path, sizeof path, "%s/%s", folder, e->d_name) < (int)sizeof path);
        if (e->d_name[0] == '.' || stat(path, &st) != 0)
            continue;
        if (S_ISDIR(st.st_mode) && depth < 3)
            find(f, path, depth + 1);
        else if (S_ISREG(st.st_mode) && is_mesh(e->d_name)) {
            assert_true(f->count < MOST_FILES);
            memcpy(f->paths[f->count++], path, sizeof path);
        }
    }
    (void)closedir(d);
}

/* The meshes of a folder of the test scenes; skips the test without it. */
static found *find_or_skip(const char *name) {
    char folder[384];
    const char *scenes = getenv("VITRINE_SCENES");
    (void)snprintf(folder, sizeof folder, "%s/%s", scenes ? scenes : "../shared/scenes", name);
    if (access(folder, R_OK | X_OK) != 0) {
        print_message("%s is not here: skipped\n", folder);
        skip();
    }
    found *f = calloc(1, sizeof *f);
    assert_non_null(f);
    find(f, folder, 0);
    assert_true(f->count > 0);
    return f;
}

/* Bakes the file on the device that needs no compiler, within the limit of memory. */
static int bake(tool_run *r, const char *path) {
    struct rusage used;
    (void)unlink(PACK);
    tool(r, TOOL_BAKE " %s -o " PACK " --quiet --quality stated --device host --size 32x24 --frames 2 --photons 100", path);
    assert_int_equal(getrusage(RUSAGE_CHILDREN, &used), 0); /* the largest so far */
    if (used.ru_maxrss > MOST_KIB || (r->code != OK && r->code != BAD_INPUT))
        fail_msg("%s: exit %d, at most %ld KiB\n%s", path, r->code, used.ru_maxrss, r->err);
    return r->code;
}

static void odd_files_are_baked_or_refused_with_one_line(void **state) {
    static tool_run r;
    found *f = find_or_skip("odd");
    int baked = 0;
    (void)state;
    for (int i = 0; i < f->count; i++)
        if (bake(&r, f->paths[i]) == BAD_INPUT) {
            tool_refuses(&r, "vitrine-bake", BAD_INPUT, f->paths[i]);
            assert_int_not_equal(access(PACK, F_OK), 0);
        } else {
            baked++;
            assert_int_equal(access(PACK, F_OK), 0);
        }
    print_message("%d odd files: %d baked, %d refused\n", f->count, baked, f->count - baked);
    free(f);
    (void)unlink(PACK);
}

static void every_gltf_sample_is_baked_and_plays(void **state) {
    static tool_run r;
    found *f = find_or_skip("gltf");
    (void)state;
    for (int i = 0; i < f->count; i++) {
        if (bake(&r, f->paths[i]) != OK)
            fail_msg("%s: exit %d\n%s", f->paths[i], r.code, r.err);
        tool(&r, TOOL_PLAY " " PACK " --verify --quiet --device host --frames 1");
        tool_succeeds(&r);
    }
    free(f);
    (void)unlink(PACK);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(odd_files_are_baked_or_refused_with_one_line),
        cmocka_unit_test(every_gltf_sample_is_baked_and_plays),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
