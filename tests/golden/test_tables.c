/* The product's tables are the only lists of what is in them: what is added to one and forgotten elsewhere does not compile.
 *
 * Strategy: the compiler is the judge. The headers are copied with a row more in a table; the source that must notice is
 * compiled with them, without a result, and with an untouched copy, which it accepts. */
#include "test_packs.h"

#define FOLDER TEST_PACKS "/tables"
#define COMPILE                                                                                                                \
    "cc -std=c11 -D_POSIX_C_SOURCE=200809L -DVIT_OPENCL=0 -Wall -Wextra -Werror -fsyntax-only -I" FOLDER                       \
    "/include -Iruntime -I. -I" VIT_BUILD_DIR " "

static tool_run r;

/* FOLDER/include with every header of include/; in `header`, `more` stands behind `after`. */
static void copy_headers(const char *header, const char *after, const char *more) {
    static const char *const headers[] = {"vitrine.h", "vitrine_frame.h", "vitrine_pack.h"};
    test_packs_begin();
    folder_make(FOLDER);
    folder_make(FOLDER "/include");
    if (access(FOLDER "/kernels", F_OK) != 0)
        assert_int_equal(symlink("../../../../kernels", FOLDER "/kernels"), 0);
    for (size_t i = 0; i < sizeof headers / sizeof headers[0]; i++) {
        char path[256], text[1 << 16], changed[sizeof text + 256];
        (void)snprintf(path, sizeof path, "include/%s", headers[i]);
        read_into(path, text, sizeof text);
        assert_in_range(strlen(text), 1, sizeof text - 2);
        const char *at = strcmp(headers[i], header) == 0 ? strstr(text, after) : text;
        assert_non_null(at);
        const int cut = at != text ? (int)(at - text) + (int)strlen(after) : 0;
        (void)snprintf(changed, sizeof changed, "%.*s%s%s", cut, text, at != text ? more : "", text + cut);
        (void)snprintf(path, sizeof path, FOLDER "/include/%s", headers[i]);
        put_bytes(path, changed, strlen(changed));
    }
}

/* `source`, with its own options first, compiles; with the row it does not, and the compiler names `missing`. */
static void a_row_needs(const char *source, const char *header, const char *after, const char *row, const char *missing) {
    copy_headers(header, after, "");
    tool(&r, COMPILE "%s", source);
    tool_succeeds(&r);
    copy_headers(header, after, row);
    tool(&r, COMPILE "%s", source);
    if (r.code == 0 || !strstr(r.err, missing))
        fail_msg("%s compiles with a further row%s of %s, or says nothing of %s: %s", source, row, header, missing, r.err);
}

static void a_section_without_its_check_does_not_compile(void **state) {
    (void)state;
    a_row_needs("runtime/pack_read.c", "vitrine_pack.h", "X(GOLD, vit_gold, s->frames)", " X(NEWS, vit_u32, 1u)",
                "vit_pack_check_NEWS");
}

/* As the Makefile compiles it; the width is the cheapest. */
#define KERNELS                                                                                                                \
    "-Wno-unknown-pragmas -Wno-sign-compare -Wno-unused-parameter -Wno-psabi -DVIT_LANES=1 -DHOST_ISA=\"baseline\" "           \
    "-DHOST_PROGRAM=host "                                                                                                     \
    "runtime/host/kernels.c"

static void a_view_that_no_kernel_draws_does_not_compile(void **state) {
    (void)state;
    a_row_needs(KERNELS, "vitrine_frame.h", "X(albedo, 0, \"diffuse reflectance\")", " X(dreams, 0, \"what is not there\")",
                "VIT_VIEW_dreams");
}

static void a_view_without_its_bytes_does_not_compile(void **state) {
    (void)state;
    a_row_needs("runtime/work.c", "vitrine_frame.h", "X(albedo, 0, \"diffuse reflectance\")",
                " X(dreams, 0, \"what is not there\")", "VIT_VIEW_dreams");
}

#define LAST_FORMAT "X(RGBA32F, rgba32f, 16, 4, \"four floats, linear radiance times exposure, alpha 1\")"
#define A_FORMAT " X(BGR888, bgr888, 3, 1, \"bytes\")"
static void a_format_that_no_kernel_writes_does_not_compile(void **state) {
    (void)state;
    a_row_needs(KERNELS, "vitrine_frame.h", LAST_FORMAT, A_FORMAT, "VIT_FORMAT_BGR888");
}

static void a_format_without_golden_hashes_does_not_compile(void **state) {
    (void)state;
    a_row_needs("runtime/open.c", "vitrine_frame.h", LAST_FORMAT, A_FORMAT, "bgr888");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_section_without_its_check_does_not_compile),
        cmocka_unit_test(a_view_that_no_kernel_draws_does_not_compile),
        cmocka_unit_test(a_view_without_its_bytes_does_not_compile),
        cmocka_unit_test(a_format_that_no_kernel_writes_does_not_compile),
        cmocka_unit_test(a_format_without_golden_hashes_does_not_compile),
    };
    return cmocka_run_group_tests_name("tables", tests, NULL, NULL);
}
