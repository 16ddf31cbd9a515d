/* PLY files of strangers that came out wrong once, of VITRINE_CASES or ../shared/cases; test_ply_shapes.c makes files like
 * them. */
#define FOLDER VIT_BUILD_DIR "/tests/unit/ply_cases"
#include "case_model.h"

static void a_first_byte_like_a_line_s_end_is_data(void **state) {
    static const char *const names[] = {"ply-first-byte/grid.ply", "ply-first-byte/grid_0d.ply"};
    (void)state;
    for (int i = 0; i < 2; i++) {
        model m;
        (void)import_case(names[i], &m);
        assert_int_equal(m.triangles, 18);
        assert_true(fabs(m.lo[0]) < 0.02 && m.lo[1] == 0.0 && m.hi[0] == 1.0 && m.hi[1] == 1.0 && m.hi[2] == 0.0);
        assert_string_equal(warnings, "");
        model_free(&m);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {T(a_first_byte_like_a_line_s_end_is_data)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
