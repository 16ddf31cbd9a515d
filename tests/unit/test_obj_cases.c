/* Small OBJ and MTL files of strangers that came out wrong once, in folders of VITRINE_CASES or ../shared/cases; the right
 * values are worked out by hand in their READMEs. Files like them are made by test_obj_files.c and test_mtl_lines.c, so that
 * nothing is lost where the folder is not at hand. */
#define FOLDER VIT_BUILD_DIR "/tests/unit/obj_cases"
#include "case_model.h"

/* No warning is due. */
static void import_whole(const char *name, model *m) {
    (void)import_case(name, m);
    if (warnings[0])
        fail_msg("%s", warnings);
}

static void lines_of_mtl(void **state) {
    model m;
    (void)state;
    import_whole("mtl-lines/kd.obj", &m);
    assert_true(near3(m.materials[0].albedo, 0.6, 0.6, 0.6));
    model_free(&m);
    import_whole("mtl-lines/scale.obj", &m);
    uv_at(&m, 1, 0, 2, 1);
    uv_at(&m, 0, 1, 0, -1);
    assert_int_equal(m.image_count, 1);
    model_free(&m);
    import_whole("mtl-lines/scale1.obj", &m);
    uv_at(&m, 1, 0, 2, 1);
    uv_at(&m, 0, 1, 0, 0);
    assert_int_equal(m.image_count, 1);
    model_free(&m);
    import_whole("mtl-lines/space.obj", &m);
    assert_int_equal(m.image_count, 1);
    model_free(&m);
    import_whole("mtl-lines/map.obj", &m);
    assert_true(near3(m.materials[0].albedo, 1, 1, 1) && m.image_count == 1);
    model_free(&m);
}

static void a_halo_is_opaque_in_front(void **state) {
    model m;
    (void)state;
    (void)import_case("mtl-lines/halo.obj", &m);
    assert_true(m.triangles == 2 && fabsf(m.materials[0].alpha - 0.9f) < 1e-6f);
    assert_non_null(strstr(warnings, "-halo"));
    model_free(&m);
}

static void exporters_defaults(void **state) {
    model m;
    (void)state;
    import_whole("obj-default-ks/m1.obj", &m);
    assert_true(is_matt(&m.materials[0]) && near3(m.materials[0].albedo, 0.8, 0.8, 0.8));
    model_free(&m);
    import_whole("obj-default-ks/m3.obj", &m);
    assert_int_equal(m.material_count, 3);
    for (int i = 0; i < 3; i++)
        assert_true(is_matt(&m.materials[i]) && near3(m.materials[i].albedo, 0.8, 0.8, 0.8));
    model_free(&m);
}

static void numbers_without_a_leading_zero(void **state) {
    model m;
    (void)state;
    import_whole("obj-leading-dot/shift.obj", &m);
    assert_true(m.triangles == 2 && m.lo[0] == 0 && m.lo[1] == 0 && m.hi[0] == 2 && m.hi[1] == 2);
    model_free(&m);
    import_whole("obj-leading-dot/colour.obj", &m);
    assert_true(m.hi[0] == 1 && near3(m.materials[0].albedo, 0.21404114, 0.05087609, 1));
    model_free(&m);
    import_whole("obj-leading-dot/uv.obj", &m);
    assert_true(m.triangles == 1);
    model_free(&m);
}

int main(void) {
    const struct CMUnitTest tests[] = {T(lines_of_mtl), T(a_halo_is_opaque_in_front), T(exporters_defaults),
                                       T(numbers_without_a_leading_zero)};
    return cmocka_run_group_tests(tests, make_folder, NULL);
}
