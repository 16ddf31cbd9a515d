/* Every input that was ever worth keeping, through the functions that `make fuzz` feeds: first seeds, each of which shows one
 * way through a reader, and what once crashed, hung or was wrongly accepted. A test an input, named after its file. Runs as
 * part of make test in plain code and under the sanitizers, which also look for leaks here. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>

#include "fuzz/targets/fuzz.h"

#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define SEEDS "tests/fuzz/seeds"

enum { MOST_INPUTS = 1000, ROOM = 1 << 20 };

typedef void fuzz_fn(const uint8_t *data, size_t size);

typedef struct input {
    char path[320];
    fuzz_fn *run;
} input;

static const struct {
    const char *name;
    fuzz_fn *run;
} targets[] = {
#define X(name, most) {#name, fuzz_##name},
    FUZZ_TARGETS(X)
#undef X
};

static input inputs[MOST_INPUTS];
static struct CMUnitTest tests[MOST_INPUTS];
static size_t count;

static void goes_through(void **state) {
    const input *in = *state;
    uint8_t *bytes = malloc(ROOM);
    FILE *file = fopen(in->path, "rb");
    assert_non_null(bytes);
    assert_non_null(file);
    const size_t size = fread(bytes, 1, ROOM, file);
    (void)fclose(file);
    uint8_t *exact = malloc(size + !size); /* so that a sanitizer sees any reading beyond it */
    assert_non_null(exact);
    memcpy(exact, bytes, size);
    free(bytes);
    in->run(exact, size);
    free(exact);
}

static int by_name(const void *a, const void *b) {
    return strcmp(((const input *)a)->path, ((const input *)b)->path);
}

static void find_inputs(const char *name, fuzz_fn *run) {
    char folder[64];
    (void)snprintf(folder, sizeof folder, SEEDS "/%s", name);
    DIR *d = opendir(folder);
    for (struct dirent *e = d ? readdir(d) : NULL; e && count < MOST_INPUTS; e = readdir(d)) {
        if (e->d_name[0] == '.')
            continue;
        (void)snprintf(inputs[count].path, sizeof inputs[count].path, "%s/%s", folder, e->d_name);
        inputs[count++].run = run;
    }
    if (d)
        (void)closedir(d);
}

static void every_target_has_seeds(void **state) {
    (void)state;
    for (size_t t = 0; t < sizeof targets / sizeof targets[0]; t++) {
        size_t seeds = 0;
        for (size_t i = 0; i < count; i++)
            seeds += inputs[i].run == targets[t].run;
        assert_true(seeds > 0);
    }
}

#if defined(__SANITIZE_ADDRESS__)
/* Leaks of the libraries that read meshes and scene files are not ours; they keep no frame pointers, so stacks are unwound
 * slowly. */
const char *__asan_default_options(void);
const char *__asan_default_options(void) {
    return "fast_unwind_on_malloc=0";
}
const char *__lsan_default_suppressions(void);
const char *__lsan_default_suppressions(void) {
    return "leak:libassimp\nleak:libembree\nleak:libtbb\nleak:libconfig\n";
}
#endif

int main(void) {
    for (size_t t = 0; t < sizeof targets / sizeof targets[0]; t++)
        find_inputs(targets[t].name, targets[t].run);
    qsort(inputs, count, sizeof inputs[0], by_name);
    fuzz_mesh_whole = true;
    for (size_t i = 0; i < count; i++)
        tests[i] =
            (struct CMUnitTest){.name = inputs[i].path + sizeof SEEDS, .test_func = goes_through, .initial_state = &inputs[i]};
    const struct CMUnitTest seeds[] = {cmocka_unit_test(every_target_has_seeds)};
    const int failed = cmocka_run_group_tests_name("seeds", seeds, NULL, NULL);
    return failed + _cmocka_run_group_tests("inputs", tests, count, NULL, NULL);
}
