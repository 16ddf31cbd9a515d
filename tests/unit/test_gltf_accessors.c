/* What glTF's accessors say. What is hard: six types of component, normalized or not, with gaps, with exceptions, with nothing
 * behind them, and every count and offset a stranger's. Strategy: the same triangle or its texture coordinates in each of these
 * ways, made here, must come out as the same floats; what reaches outside of its buffer must be refused with a line that says
 * so. */
#define FOLDER VIT_BUILD_DIR "/tests/unit/gltf_accessors"
#include "gltf_lab.h"

#define TEXTURED                                                                                                               \
    ",\"materials\":[{\"pbrMetallicRoughness\":{\"baseColorTexture\":{\"index\":0}}}],\"textures\":[{\"source\":0}],"          \
    "\"images\":[{\"uri\":\"image.tga\"}]"

static void uv_as(const void *bytes, size_t size, int kind, const char *more, double u, double v) {
    gltf_lab l = {.size = 0};
    model m;
    char attributes[128];
    const int position = lab_triangle(&l), uv = lab_data(&l, bytes, size, kind, "VEC2", 3, more);
    put_image(FILE_OF("image.tga"), 255);
    (void)snprintf(attributes, sizeof attributes, "\"POSITION\":%d,\"TEXCOORD_0\":%d", position, uv);
    lab_import(&l, attributes, ",\"material\":0", TEXTURED, &m);
    uv_is(&m, vertex_at(&m, 1, 0, 0), u, v);
    model_free(&m);
}

#define NORMALIZED ",\"normalized\":true"

static void components_of_all_types_are_read_normalized_or_not(void **state) {
    const uint8_t bytes[6] = {9, 9, 255, 51, 9, 9};
    const uint16_t words[6] = {9, 9, 65535, 13107, 9, 9};
    const int8_t signed_bytes[6] = {9, 9, 127, -128, 9, 9};
    const int16_t signed_words[6] = {9, 9, 32767, -32768, 9, 9};
    const uint32_t longs[6] = {9, 9, 7, 70000, 9, 9};
    const float floats[6] = {9, 9, 0.25f, -3, 9, 9};
    (void)state;
    uv_as(bytes, sizeof bytes, GLTF_UBYTE, NORMALIZED, 1, 0.2);
    uv_as(bytes, sizeof bytes, GLTF_UBYTE, "", 255, 51);
    uv_as(words, sizeof words, GLTF_USHORT, NORMALIZED, 1, 0.2);
    uv_as(words, sizeof words, GLTF_USHORT, "", 65535, 13107);
    uv_as(signed_bytes, sizeof signed_bytes, GLTF_BYTE, NORMALIZED, 1, -1); /* -128 is -1 as well (3.11) */
    uv_as(signed_bytes, sizeof signed_bytes, GLTF_BYTE, "", 127, -128);
    uv_as(signed_words, sizeof signed_words, GLTF_SHORT, NORMALIZED, 1, -1);
    uv_as(signed_words, sizeof signed_words, GLTF_SHORT, "", 32767, -32768);
    uv_as(longs, sizeof longs, GLTF_UINT, "", 7, 70000);
    uv_as(floats, sizeof floats, GLTF_FLOAT, "", 0.25, -3);
}

/* KHR_mesh_quantization. */
static void quantized_positions_and_normals(void **state) {
    const uint16_t corners[12] = {0, 0, 0, 7, 1000, 0, 0, 7, 0, 1000, 0, 7};
    const int8_t normals[12] = {0, 0, 127, 9, 0, 0, 127, 9, 0, 127, 0, 9};
    gltf_lab l = {.size = 0};
    model m;
    (void)state;
    (void)lab_accessor(&l, lab_view(&l, corners, sizeof corners, ",\"byteStride\":8"), GLTF_USHORT, "VEC3", 3, "");
    (void)lab_accessor(&l, lab_view(&l, normals, sizeof normals, ",\"byteStride\":4"), GLTF_BYTE, "VEC3", 3, NORMALIZED);
    lab_write(&l, "lab",
              "\"extensionsRequired\":[\"KHR_mesh_quantization\"],\"scenes\":[{\"nodes\":[0]}],"
              "\"nodes\":[{\"mesh\":0,\"scale\":[0.001,0.001,0.001]}],"
              "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0,\"NORMAL\":1}}]}]");
    import_good(LAB_FILE, &m);
    check_promises(&m);
    box_is(&m, 0, 0, 0, 1, 1, 0);
    normal_at(&m, 1, 0, 0, 0, 0, 1);
    normal_at(&m, 0, 1, 0, 0, 1, 0);
    model_free(&m);
}

/* Position and normal of each vertex side by side, at an address that no float has. */
static void interleaved_and_unaligned_floats(void **state) {
    static const float both[18] = {0, 0, 0, 0, 1, 0, 2, 0, 0, 0, 1, 0, 0, 2, 0, 0, 1, 0};
    uint8_t shifted[2 + sizeof both] = {7, 7};
    model m;
    (void)state;
    memcpy(shifted + 2, both, sizeof both);
    for (int k = 0; k < 2; k++) {
        gltf_lab l = {.size = 0};
        const int view = k ? lab_view(&l, shifted, sizeof shifted, ",\"byteStride\":24")
                           : lab_view(&l, both, sizeof both, ",\"byteStride\":24");
        (void)lab_accessor(&l, view, GLTF_FLOAT, "VEC3", 3, k ? ",\"byteOffset\":2" : "");
        (void)lab_accessor(&l, view, GLTF_FLOAT, "VEC3", 3, k ? ",\"byteOffset\":14" : ",\"byteOffset\":12");
        lab_import(&l, "\"POSITION\":0,\"NORMAL\":1", "", "", &m);
        box_is(&m, 0, 0, 0, 2, 2, 0);
        normal_at(&m, 2, 0, 0, 0, 1, 0);
        model_free(&m);
    }
}

static void sparse(int kind, const void *index, size_t size, bool base) {
    static const float corners[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0}, moved[6] = {5, 0, 0, 0, 5, 0};
    gltf_lab l = {.size = 0};
    char more[256];
    model m;
    const int view = base ? lab_view(&l, corners, sizeof corners, "") : -1, at = lab_view(&l, index, size, "");
    const int values = lab_view(&l, moved, sizeof moved, "");
    (void)snprintf(
        more, sizeof more,
        ",\"sparse\":{\"count\":2,\"indices\":{\"bufferView\":%d,\"componentType\":%d},\"values\":{\"bufferView\":%d}}", at,
        kind, values);
    (void)lab_accessor(&l, view, GLTF_FLOAT, "VEC3", 3, more);
    lab_import(&l, "\"POSITION\":0", "", "", &m);
    box_is(&m, 0, 0, 0, 5, 5, 0);
    model_free(&m);
}

static void sparse_accessors_change_elements_of_a_view_or_of_zeros(void **state) {
    const uint8_t bytes[2] = {1, 2};
    const uint16_t words[2] = {1, 2};
    const uint32_t longs[2] = {1, 2};
    (void)state;
    sparse(GLTF_UBYTE, bytes, sizeof bytes, true);
    sparse(GLTF_USHORT, words, sizeof words, false);
    sparse(GLTF_UINT, longs, sizeof longs, true);
}

static void indices(const void *bytes, size_t size, int kind, size_t count, const char *mode, uint32_t triangles, float area) {
    static const float corners[15] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0, 0, 2, 0};
    gltf_lab l = {.size = 0};
    model m;
    float sum = 0.0f;
    (void)lab_data(&l, corners, sizeof corners, GLTF_FLOAT, "VEC3", 5, "");
    if (count > 0)
        (void)lab_data(&l, bytes, size, kind, "SCALAR", count, "");
    char more[64];
    (void)snprintf(more, sizeof more, "%s%s", count > 0 ? ",\"indices\":1" : "", mode);
    lab_import(&l, "\"POSITION\":0", more, "", &m);
    assert_int_equal(m.triangles, triangles);
    for (uint32_t t = 0; t < m.triangles; t++) { /* all turn the same way: no area has the other sign */
        const float *a = m.position + 3 * m.index[3 * t], *b = m.position + 3 * m.index[3 * t + 1],
                    *c = m.position + 3 * m.index[3 * t + 2];
        sum += 0.5f * ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]));
    }
    assert_true(fabsf(sum - area) < 1e-6f);
    model_free(&m);
}

static void indices_of_all_types_and_modes(void **state) {
    const uint8_t bytes[6] = {0, 1, 2, 1, 3, 2}, fan[4] = {0, 1, 3, 2};
    const uint16_t words[6] = {0, 1, 2, 1, 3, 2};
    const uint32_t longs[7] = {0, 1, 2, 1, 3, 2, 0}; /* one too many */
    (void)state;
    indices(bytes, sizeof bytes, GLTF_UBYTE, 6, "", 2, 1.0f);
    indices(words, sizeof words, GLTF_USHORT, 6, ",\"mode\":4", 2, 1.0f);
    indices(longs, sizeof longs, GLTF_UINT, 7, "", 2, 1.0f);
    indices(bytes, 4, GLTF_UBYTE, 3, ",\"mode\":5", 1, 0.5f);
    indices(NULL, 0, 0, 0, ",\"mode\":5", 3, 1.5f); /* (0 1 2) (2 1 3) (2 3 4) */
    indices(fan, sizeof fan, GLTF_UBYTE, 4, ",\"mode\":6", 2, 1.0f);
}

/* A large buffer for many primitives: of each only what it uses is looked at. */
static void a_primitive_keeps_to_its_own_vertices(void **state) {
    static const float corners[21] = {NAN, 0, 0, 1e30f, 0, 0, 0, 0, 0, 1, 0, 0, 0, 1, 0, 5, 5, 5, NAN, 0, 0};
    const uint8_t first[3] = {2, 3, 4}, out[6] = {2, 3, 4, 2, 3, 7};
    gltf_lab l = {.size = 0};
    model m;
    (void)state;
    (void)lab_data(&l, corners, sizeof corners, GLTF_FLOAT, "VEC3", 7, "");
    (void)lab_data(&l, first, sizeof first, GLTF_UBYTE, "SCALAR", 3, "");
    (void)lab_data(&l, out, sizeof out, GLTF_UBYTE, "SCALAR", 6, "");
    lab_import(&l, "\"POSITION\":0", ",\"indices\":1", "", &m);
    box_is(&m, 0, 0, 0, 1, 1, 0);
    assert_true(m.step < 1e-6);
    model_free(&m);
    lab_import(&l, "\"POSITION\":0", ",\"indices\":2", "", &m);
    assert_int_equal(m.triangles, 1);
    assert_non_null(strstr(warnings, "1 triangles with an index out of range"));
    model_free(&m);
}

#define MESH_OF_0 LAB_SCENE "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0}}]}]"

/* One accessor of the triangle's 36 bytes, written like this. */
static void accessor_refused(int kind, const char *type, const char *more, const char *what) {
    static const float corners[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    gltf_lab l = {.size = 0};
    (void)lab_view(&l, corners, sizeof corners, "");
    (void)lab_accessor(&l, 0, kind, type, 3, more);
    lab_refused(&l, MESH_OF_0, what);
}

static void what_is_not_there_is_refused(void **state) {
    (void)state;
    accessor_refused(GLTF_FLOAT, "VEC3", ",\"byteOffset\":1", "accessor 0 is out of range");
    accessor_refused(GLTF_FLOAT, "VEC3", ",\"byteOffset\":-4", "no offset that could be");
    accessor_refused(GLTF_FLOAT, "VEC3", ",\"byteOffset\":1e300", "no offset that could be");
    accessor_refused(GLTF_FLOAT, "VEC3", ",\"byteOffset\":9007199254740992", "out of range");
    accessor_refused(GLTF_FLOAT, "VEC3", ",\"count\":4", "accessor 0 is out of range"); /* the later of two wins */
    accessor_refused(GLTF_FLOAT, "VEC3", ",\"count\":4294967294", "accessor 0 is out of range");
    accessor_refused(GLTF_FLOAT, "VEC3", ",\"count\":-1", "no type or count");
    accessor_refused(GLTF_FLOAT, "VEC3", ",\"bufferView\":1", "there is no buffer view 1");
    accessor_refused(GLTF_FLOAT, "VEC4", "", "out of range");
    accessor_refused(GLTF_FLOAT, "VEC2", "", "has 2 components, not 3");
    accessor_refused(GLTF_FLOAT, "VEC9", "", "no type or count");
    accessor_refused(5130, "VEC3", "", "no type or count");
    accessor_refused(
        GLTF_FLOAT, "VEC3",
        ",\"sparse\":{\"count\":1,\"indices\":{\"bufferView\":0,\"componentType\":5125},\"values\":{\"bufferView\":0,"
        "\"byteOffset\":28}}",
        "sparse part is out of range");
    accessor_refused(GLTF_FLOAT, "VEC3", ",\"sparse\":{\"count\":4,\"indices\":{\"bufferView\":0,\"componentType\":5125}}",
                     "sparse part cannot be");
    accessor_refused(
        GLTF_FLOAT, "VEC3",
        ",\"sparse\":{\"count\":1,\"indices\":{\"bufferView\":0,\"componentType\":5125,\"byteOffset\":12},\"values\":"
        "{\"bufferView\":0}}",
        "names element 1065353216 of 3");
    accessor_refused(GLTF_FLOAT, "VEC3", ",\"sparse\":{\"count\":1,\"indices\":{\"bufferView\":0,\"componentType\":5126}}",
                     "sparse part cannot be");
}

/* Zeros cost a file nothing, so it may not claim any number of them. */
static void zeros_without_end_are_refused(void **state) {
    gltf_lab l = {.size = 0};
    (void)state;
    (void)lab_accessor(&l, -1, GLTF_FLOAT, "VEC3", 4000000000u, "");
    lab_refused(&l, MESH_OF_0, "elements without data");
}

static void buffers_and_views_that_are_too_short_are_refused(void **state) {
    static const char *const cases[][2] = {
        {"\"buffers\":[{\"uri\":\"lab.bin\",\"byteLength\":37}]", "buffer 0 has 36 bytes of 37"},
        {"\"buffers\":[{\"uri\":\"nowhere.bin\",\"byteLength\":36}]", "'nowhere.bin' is not there"},
        {"\"buffers\":[{\"byteLength\":36}]", "buffer 0 has no data"},
        {"\"buffers\":[{\"uri\":\"lab.bin\"}]", "buffer 0 has no length"},
        {"\"buffers\":[{\"uri\":\"data:;base64,AA*A\",\"byteLength\":3}]", "data cannot be read"},
        {"\"buffers\":7", "there is no buffer 0"},
        {"\"bufferViews\":[{\"buffer\":0,\"byteOffset\":8,\"byteLength\":36}]", "lie outside of buffer 0"},
        {"\"bufferViews\":[{\"buffer\":1,\"byteLength\":36}]", "there is no buffer 1"},
        {"\"bufferViews\":[{\"buffer\":0,\"byteLength\":\"a\"}]", "buffer view 0 has no length"},
        {"\"bufferViews\":[{\"buffer\":0,\"byteLength\":36,\"byteStride\":20}]", "accessor 0 is out of range"},
    };
    gltf_lab l = {.size = 0};
    (void)state;
    (void)lab_triangle(&l);
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char rest[512];
        (void)snprintf(rest, sizeof rest, MESH_OF_0 ",%s", cases[i][0]); /* the later of two wins */
        lab_refused(&l, rest, cases[i][1]);
    }
}

static void attributes_that_are_shorter_than_the_positions_are_refused(void **state) {
    static const float two[6] = {0, 0, 1, 0, 0, 1};
    gltf_lab l = {.size = 0};
    (void)state;
    (void)lab_triangle(&l);
    (void)lab_data(&l, two, sizeof two, GLTF_FLOAT, "VEC3", 2, "");
    lab_refused(&l, LAB_SCENE "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0,\"NORMAL\":1}}]}]",
                "accessor 1 has 2 elements for 3 vertices");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        T(components_of_all_types_are_read_normalized_or_not),
        T(quantized_positions_and_normals),
        T(interleaved_and_unaligned_floats),
        T(sparse_accessors_change_elements_of_a_view_or_of_zeros),
        T(indices_of_all_types_and_modes),
        T(a_primitive_keeps_to_its_own_vertices),
        T(what_is_not_there_is_refused),
        T(zeros_without_end_are_refused),
        T(buffers_and_views_that_are_too_short_are_refused),
        T(attributes_that_are_shorter_than_the_positions_are_refused),
    };
    return cmocka_run_group_tests(tests, make_folder, NULL);
}
