/* Small glTF files of strangers that came out wrong once, in folders of VITRINE_CASES or ../shared/cases; the right values are
 * worked out by hand in their READMEs. Files like them are made by test_gltf_accessors.c, test_gltf_scene.c and
 * test_import_gltf_materials.c, so that nothing is lost where the folder is not at hand. */
#define FOLDER VIT_BUILD_DIR "/tests/unit/gltf_cases"
#include "case_model.h"
#include "gltf_lab.h"

static void emissive_strength(void **state) {
    model m;
    (void)state;
    (void)import_case("gltf-emissive-strength/lamp.gltf", &m);
    assert_true(near3(m.materials[0].emission, 10, 10, 10));
    model_free(&m);
    (void)import_case("gltf-emissive-strength/default.gltf", &m);
    assert_true(near3(m.materials[0].emission, 1, 1, 1));
    model_free(&m);
}

static void ior_reflectance(void **state) {
    model m;
    (void)state;
    (void)import_case("gltf-ior-reflectance/quad.gltf", &m);
    assert_true(fabs((double)m.materials[0].specular[0] - 0.1696) < 1e-4);
    model_free(&m);
}

static void light_units(void **state) {
    model m;
    (void)state;
    (void)import_case("gltf-light-units/lamp.gltf", &m);
    const model_light *lamp = model_light_named(&m, "Lamp");
    assert_non_null(lamp);
    assert_true(fabs(lamp->power[0] / (4 * 3.14159265358979) - 7.96) < 0.01);
    model_free(&m);
}

static void morph_and_skin(void **state) {
    model m;
    (void)state;
    (void)import_case("gltf-morph-skin/morph.gltf", &m);
    box_is(&m, 0, 0, 2, 1, 1, 2);
    model_free(&m);
    (void)import_case("gltf-morph-skin/skin.gltf", &m);
    box_is(&m, 0, 3, 0, 1, 4, 0);
    model_free(&m);
    (void)import_case("gltf-morph-skin/skin_no_ibm.gltf", &m);
    box_is(&m, 0, 3, 0, 1, 4, 0);
    model_free(&m);
}

static void quantized(void **state) {
    model m;
    (void)state;
    (void)import_case("gltf-quantized/normals.gltf", &m);
    normal_at(&m, 0, 0, 0, 0, 0, 1);
    model_free(&m);
    (void)import_case("gltf-quantized/positions.gltf", &m);
    box_is(&m, 0, 0, 0, 1, 1, 0);
    model_free(&m);
}

static void required_extensions(void **state) {
    model m;
    (void)state;
    (void)import_case("gltf-required-extension/instances.gltf", &m);
    box_is(&m, 0, 0, 0, 6, 1, 0);
    assert_int_equal(m.triangles, 4);
    model_free(&m);
    refuse(case_file("gltf-required-extension/unknown.gltf"), false, "extension 'VENDOR_something' is required and not read");
}

static void cutoff_and_camera(void **state) {
    model m;
    (void)state;
    const char *path = import_case("gltf-small/ortho.gltf", &m);
    assert_non_null(strstr(warnings, "camera 'C' is orthographic"));
    assert_non_null(path);
    model_free(&m);
    refuse(case_file("gltf-small/cutoff15.gltf"), false, "no triangle that is not transparent");
}

static void transform_texcoord(void **state) {
    model m;
    (void)state;
    (void)import_case("gltf-transform-texcoord/quad.gltf", &m);
    for (size_t i = 0; i < m.vertices; i++)
        uv_is(&m, i, 0.35, 0.7);
    model_free(&m);
}

static void uv_normalized(void **state) {
    model m;
    float least = 1.0f, most = 0.0f;
    (void)state;
    (void)import_case("gltf-uv-normalized/quad.gltf", &m);
    for (size_t i = 0; i < 2 * (size_t)m.vertices; i++) {
        least = fminf(least, m.uv[i]);
        most = fmaxf(most, m.uv[i]);
    }
    assert_true(least == 0.0f && most == 1.0f);
    model_free(&m);
}

static void webp_only(void **state) {
    model m;
    (void)state;
    const char *path = import_case("gltf-webp-only/quad.gltf", &m);
    assert_non_null(strstr(warnings, "texture 'missing.webp' is missing"));
    model_free(&m);
    refuse(path, true, "texture 'missing.webp' is missing");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        T(emissive_strength),   T(ior_reflectance),   T(light_units),        T(morph_and_skin), T(quantized),
        T(required_extensions), T(cutoff_and_camera), T(transform_texcoord), T(uv_normalized),  T(webp_only),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
