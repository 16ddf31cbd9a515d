/* Work counters in the kernels: nothing of them is left without counting, and their 64-bit sums carry.
 *
 * The compiler's preprocessor stands in for OpenCL's: the same joined text, the same -D. */
#include "kernel_lab.h"
#include <ctype.h>
#include <stdbool.h>

#define TEXT (4u << 20)
#define KERNELS VIT_BUILD_DIR "/work-kernels.i"

/* The program as the preprocessor leaves it, all effects on; free() it. */
static char *preprocessed(unsigned lanes, int counting) {
    char command[4096];
    int n = snprintf(command, sizeof command,
                     VIT_CC " -E -P -x c " KERNELS " -D__OPENCL_VERSION__=120 -DVIT_LANES=%u -DVIT_VIEW=0 -DVIT_FORMAT=0 "
                            "-DVIT_COUNT_WORK=%d",
                     lanes, counting);
#define X(bit, name, macro, why) n += snprintf(command + n, sizeof command - (size_t)n, " -DVIT_EFFECT_" #macro "=1");
    VIT_EFFECTS(X)
#undef X
#define X(macro) n += snprintf(command + n, sizeof command - (size_t)n, " -DVIT_EFFECT_" #macro "=1");
    VIT_MODES(X)
#undef X
    assert_in_range(n, 1, sizeof command - 1);
    FILE *f = fopen(KERNELS, "w");
    assert_non_null(f);
    for (unsigned i = 0; i < vit_kernel_source_count; i++)
        assert_true(fputs(vit_kernel_sources[i], f) >= 0);
    assert_int_equal(fclose(f), 0);
    char *text = calloc(1, TEXT);
    assert_non_null(text);
    FILE *from = popen(command, "r");
    assert_non_null(from);
    assert_in_range(fread(text, 1, TEXT - 1, from), 10000, TEXT - 2);
    assert_int_equal(pclose(from), 0);
    (void)remove(KERNELS);
    return text;
}

static int occurrences(const char *text, const char *what) {
    int count = 0;
    for (const char *at = text; (at = strstr(at, what)) != NULL; at += strlen(what))
        count++;
    return count;
}

/* The constants are declared in either case: records.clh is for the host too. */
static char *after_the_records(char *text) {
    char *at = strstr(text, "VIT_WORK_COUNT");
    assert_non_null(at);
    return at + strlen("VIT_WORK_COUNT");
}

static void without_counting_no_counter_is_left_in_the_kernels(void **state) {
    (void)state;
    static const char *const counters[] = {"work_",          "WORK_",        "VIT_WORK", "box_tests",
                                           "triangle_tests", "cutout_tests", "textured", "ulong"};
    for (unsigned w = 0; w < LAB_WIDTHS; w++) {
        char *off = preprocessed(lab_lanes[w], 0), *on = preprocessed(lab_lanes[w], 1);
        const char *off_code = after_the_records(off), *on_code = after_the_records(on);
        for (size_t i = 0; i < sizeof counters / sizeof counters[0]; i++) {
            assert_int_equal(occurrences(off_code, counters[i]), 0);
            if (strcmp(counters[i], "WORK_") != 0 && occurrences(on_code, counters[i]) == 0)
                fail_msg("'%s' is no counter's name any more: this test looks for nothing", counters[i]);
        }
        free(off);
        free(on);
    }
}

/* Work-items add numbers whose low words wrap: the sum is that of 64 bits, in whatever order they come. */
static const char adding[] = "kernel void add_all(global const uint *numbers, volatile global uint *sum)\n"
                             "{\n"
                             "    uint i = (uint)get_global_id(0);\n"
                             "    work_add(sum, ((ulong)numbers[2 * i + 1] << 32) | numbers[2 * i]);\n"
                             "}\n";

static void sums_of_64_bits_carry(void **state) {
    (void)state;
    enum { COUNT = 1 << 15 };
    static uint32_t numbers[2 * COUNT];
    uint64_t random = 7, expected = 0;
    uint32_t sum[2];
    for (uint32_t i = 0; i < COUNT; i++) {
        numbers[2 * i] = i % 5 == 0 ? 0xffffffffu : i % 5 == 1 ? 0 : (uint32_t)lab_random(&random);
        numbers[2 * i + 1] = i % 3 == 0 ? (uint32_t)(lab_random(&random) >> 48) : 0;
        expected += (uint64_t)numbers[2 * i + 1] << 32 | numbers[2 * i];
    }
    lab l = lab_open_with(1, 0, " -DVIT_COUNT_WORK=1", adding);
    const cl_mem arguments[] = {lab_buffer(&l, numbers, sizeof numbers), lab_buffer(&l, NULL, sizeof sum)};
    lab_run(&l, "add_all", COUNT, arguments, 2);
    lab_read(&l, arguments[1], sum, sizeof sum);
    assert_true(((uint64_t)sum[1] << 32 | sum[0]) == expected);
    clReleaseMemObject(arguments[0]);
    clReleaseMemObject(arguments[1]);
    lab_close(&l);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(without_counting_no_counter_is_left_in_the_kernels),
        cmocka_unit_test(sums_of_64_bits_carry),
    };
    return cmocka_run_group_tests_name("work kernel", tests, NULL, NULL);
}
