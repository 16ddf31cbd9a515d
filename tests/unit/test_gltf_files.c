/* What a glTF file is made of before any mesh: JSON, GLB's chunks, data URIs, names of files. What is hard: all of it comes in
 * several ways, and may end anywhere. Strategy: one triangle in each of these ways must be that triangle; each file cut short
 * after every byte must be refused in one line; what chooses the reader is asked alone. */
#define FOLDER VIT_BUILD_DIR "/tests/unit/gltf_files"
#include "import/import_format.h"
#include "gltf_lab.h"

#define BASE64 "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA" /* (0,0,0) (1,0,0) (0,1,0) */
#define ZERO "%00%00%00%00"
#define ONE "%00%00%80%3f"
#define PERCENT "data:," ZERO ZERO ZERO ONE ZERO ZERO ZERO "%00%00%80%3F" ZERO /* the same */
#define AROUND(buffer, rest)                                                                                                   \
    "\"nodes\":[{\"mesh\":0}],\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0}}]}],\"buffers\":[" buffer          \
    "],\"bufferViews\":[{\"buffer\":0,\"byteLength\":36}],\"accessors\":[{\"bufferView\":0,\"componentType\":5126,"            \
    "\"count\":3,\"type\":\"VEC3\"}]" rest
#define VERSION_2 "\"asset\":{\"version\":\"2.0\"},"
#define DATA(uri) "{\"byteLength\":36,\"uri\":\"" uri "\"}"

static void is_the_triangle(const char *path) {
    model m;
    import_good(path, &m);
    check_promises(&m);
    assert_int_equal(m.triangles, 1);
    box_is(&m, 0, 0, 0, 1, 1, 0);
    model_free(&m);
}

static void json_is(const char *text) {
    put(FILE_OF("a.gltf"), text);
    is_the_triangle(FILE_OF("a.gltf"));
}

static void json_refused(const char *text, const char *what) {
    put(FILE_OF("a.gltf"), text);
    refuse(FILE_OF("a.gltf"), false, what);
}

/* ---- JSON ---- */

static void buffers_are_data_or_files(void **state) {
    static const float corners[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    (void)state;
    json_is("{" VERSION_2 AROUND(DATA("data:application/octet-stream;base64," BASE64), "") "}");
    json_is("{" VERSION_2 AROUND(DATA("data:application/gltf-buffer;base64," BASE64), "") "}");
    json_is("{" VERSION_2 AROUND(DATA("data:;base64," BASE64 "AA=="), "") "}"); /* longer than it says */
    json_is("{" VERSION_2 AROUND(DATA(PERCENT), "") "}");
    put_bytes(FILE_OF("a b.bin"), corners, sizeof corners);
    json_is("{" VERSION_2 AROUND(DATA("a%20b.bin"), "") "}");
    json_is("{" VERSION_2 AROUND(DATA("a b.bin"), "") "}");
    json_refused("{" VERSION_2 AROUND(DATA("data:application/octet-stream;base64"), "") "}", "data cannot be read");
}

static void text_may_be_odd(void **state) {
    model m;
    (void)state;
    json_is("\xef\xbb\xbf \n{" VERSION_2 AROUND(DATA("data:;base64," BASE64), "") "}");
    json_is("{" VERSION_2 AROUND(DATA("data:;base64," BASE64),
                                 ",\"extras\":{\"n\":123456789012345678901234567890,\"z\":\"\\u0000\"}") "}");
    put(FILE_OF("a.gltf"), "{" VERSION_2 AROUND(DATA("data:;base64," BASE64), ",\"cameras\":[{}]") "}");
    json_is("{\"extras\":\"caf\xe9\"," VERSION_2 AROUND(DATA("data:;base64," BASE64), "") "}"); /* Latin 1 */
    put(FILE_OF("a.gltf"), "{\"asset\":{\"version\":\"2.0\"},\"nodes\":[{\"mesh\":0,\"name\":\"a\\nb\"}]}");
    assert_int_equal(import_file(FILE_OF("a.gltf"), false, &m, &(vit_text){{0}}), VIT_BAD_INPUT);
}

static void what_is_no_glTF_2_is_refused(void **state) {
    (void)state;
    json_refused("{" VERSION_2 "\"nodes\":[", "line 1, column");
    json_refused("[\"asset\"]", "is no glTF");
    json_refused("{}", "is no glTF 2: its asset's version is ''");
    json_refused("{\"asset\":{\"version\":\"3.1\"}}", "is no glTF 2: its asset's version is '3.1'");
    json_refused("{\"asset\":{\"version\":2}}", "is no glTF 2");
    json_refused("{" VERSION_2 "\"scene\":\"a\"}", "its scene is no number");
    json_refused("{\"asset\":{\"version\":\"2.0\",\"minVersion\":\"2.1\"}}", "needs glTF 2.1");
    json_refused("{" VERSION_2 "\"nodes\":[{\"mesh\":0}],\"meshes\":[{\"primitives\":[7]}]}", "a primitive is none");
    json_refused("{" VERSION_2
                 "\"nodes\":[{\"mesh\":0}],\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"mode\":9}]}]}",
                 "a primitive has mode 9");
    json_refused("{" VERSION_2
                 "\"nodes\":[{\"mesh\":0}],\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"material\":0}]}]}",
                 "a primitive has material 0 of 0");
    json_refused("{" VERSION_2 "\"nodes\":[{\"mesh\":0}],\"meshes\":[{\"primitives\":[{\"attributes\":{\"NORMAL\":0}}]}]}",
                 "has no triangle");
}

static void what_is_not_of_its_kind_is_said(void **state) {
    static const char *const cases[][2] = {
        {",\"materials\":[{\"alphaCutoff\":\"0.5\"}]", "a member 'alphaCutoff' is not of its kind"},
        {",\"materials\":[{\"pbrMetallicRoughness\":{\"baseColorFactor\":[1,null,1,1]}}]", "'baseColorFactor'"},
        {",\"materials\":[{\"extensions\":{\"KHR_materials_ior\":{\"ior\":[2]}}}]", "'ior'"},
        {",\"skins\":{}", "'skins'"},
        {",\"materials\":[{\"name\":7}]", "'name'"},
        {",\"extras\":{\"type\":7},\"extensions\":{\"VENDOR_x\":{\"ior\":[2]}}", NULL},
        {",\"samplers\":[{}],\"cameras\":[],\"materials\":[{\"doubleSided\":true,\"alphaCutoff\":1}]", NULL},
    };
    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char text[2048];
        model m;
        (void)snprintf(text, sizeof text, "{" VERSION_2 AROUND(DATA("data:;base64," BASE64), "%s") "}", cases[i][0]);
        put(FILE_OF("a.gltf"), text);
        import_good(FILE_OF("a.gltf"), &m);
        model_free(&m);
        if (!cases[i][1])
            assert_string_equal(warnings, "");
        else {
            assert_non_null(strstr(warnings, cases[i][1]));
            refuse(FILE_OF("a.gltf"), true, cases[i][1]);
        }
    }
}

/* Lists are objects there, and what names things are strings: Assimp reads it. */
static void glTF_1_is_handed_on(void **state) {
    (void)state;
    for (int k = 0; k < 2; k++) {
        char text[2048];
        (void)snprintf(text, sizeof text,
                       "{\"asset\":{\"version\":%s},\"scene\":\"s\",\"scenes\":{\"s\":{\"nodes\":[\"n\"]}},"
                       "\"nodes\":{\"n\":{\"meshes\":[\"m\"]}},\"meshes\":{\"m\":{\"primitives\":[{\"attributes\":"
                       "{\"POSITION\":\"a\"},\"mode\":4}]}},\"buffers\":{\"b\":{\"byteLength\":36,\"type\":\"arraybuffer\","
                       "\"uri\":\"data:application/octet-stream;base64," BASE64 "\"}},\"bufferViews\":{\"v\":{\"buffer\":\"b\","
                       "\"byteLength\":36,\"byteOffset\":0,\"target\":34962}},\"accessors\":{\"a\":{\"bufferView\":\"v\","
                       "\"byteOffset\":0,\"byteStride\":12,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\"}}}",
                       k ? "\"1.0\"" : "1");
        json_is(text);
    }
}

/* Nothing of it is right, and nothing may come of it but a line. */
static void lists_and_members_of_all_the_wrong_kinds_do_no_harm(void **state) {
    static const char *const members[] = {"nodes",    "meshes", "buffers",    "bufferViews", "accessors", "materials",
                                          "textures", "images", "samplers",   "skins",       "cameras",   "scenes",
                                          "scene",    "extras", "animations", "extensions",  "asset"};
    static const char *const values[] = {"7",  "-1", "1e300",  "\"a\"", "null", "true",
                                         "[]", "{}", "[null]", "[[7]]", "[{}]", "[1,2]"};
    (void)state;
    for (size_t i = 0; i < sizeof members / sizeof *members; i++)
        for (size_t k = 0; k < sizeof values / sizeof *values; k++) {
            char text[1024];
            model m;
            vit_text why;
            (void)snprintf(text, sizeof text, "{" VERSION_2 AROUND(DATA("data:;base64," BASE64), ",\"%s\":%s}"), members[i],
                           values[k]);
            put(FILE_OF("a.gltf"), text);
            if (import_file(FILE_OF("a.gltf"), false, &m, &why) == VIT_OK)
                model_free(&m);
            else
                assert_true(why.text[0] && !strstr(why.text, "breaks down"));
        }
}

/* ---- GLB ---- */

static void put_word(uint8_t *at, size_t value) {
    for (int k = 0; k < 4; k++)
        at[k] = (uint8_t)(value >> 8 * k);
}

/* A head and two chunks; returns the size. */
static size_t make_glb(uint8_t out[1024], const char *json, const void *bin, size_t bin_size) {
    const size_t length = strlen(json), padded = (length + 3) / 4 * 4;
    memcpy(out, "glTF\2\0\0\0", 8);
    put_word(out + 12, padded);
    memcpy(out + 16, "JSON", 4);
    memset(out + 20, ' ', padded);
    memcpy(out + 20, json, length);
    put_word(out + 20 + padded, bin_size);
    memcpy(out + 24 + padded, "BIN\0", 4);
    memcpy(out + 28 + padded, bin, bin_size);
    put_word(out + 8, 28 + padded + bin_size);
    return 28 + padded + bin_size;
}

static void a_glb_has_its_buffer_in_its_chunk(void **state) {
    static const float corners[10] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 77};
    static const char json[] = "{" VERSION_2 AROUND("{\"byteLength\":36}", "") "}";
    uint8_t glb[1024];
    const size_t size = make_glb(glb, json, corners, sizeof corners);
    (void)state;
    put_bytes(FILE_OF("a.glb"), glb, size);
    is_the_triangle(FILE_OF("a.glb"));
    put_bytes(FILE_OF("a.other"), glb, size); /* by its first bytes */
    is_the_triangle(FILE_OF("a.other"));
    for (size_t cut = 1; cut < size - 8; cut++) { /* what is missing of the last number is not asked for */
        put_bytes(FILE_OF("cut.glb"), glb, cut);
        refuse(FILE_OF("cut.glb"), false, "");
    }
    memcpy(glb + 16, "WHAT", 4);
    put_bytes(FILE_OF("b.glb"), glb, size);
    refuse(FILE_OF("b.glb"), false, "has no JSON in its first chunk");
    memcpy(glb + 16, "JSON", 4);
    put_word(glb + 12, 0xffffffff);
    put_bytes(FILE_OF("b.glb"), glb, size);
    refuse(FILE_OF("b.glb"), false, "is cut short: a chunk of 4294967295 bytes");
}

/* ---- which reader ---- */

static const char *reader_of(const char *name, const char *head) {
    return import_format_of(name, (const uint8_t *)head, strlen(head))->name;
}

static void content_goes_before_the_suffix(void **state) {
    (void)state;
    assert_string_equal(reader_of("a.gltf", "{ \"asset\": {"), "glTF 2.0");
    assert_string_equal(reader_of("a.json", " \n{ \"scene\": 0, \"asset\": {"), "glTF 2.0");
    assert_string_equal(reader_of("a.obj", "{\"asset\":"), "glTF 2.0");
    assert_string_equal(reader_of("a.GLTF", "nonsense"), "glTF 2.0");
    assert_string_equal(reader_of("a.json", "{\"metadata\":"), "Assimp");
    assert_string_equal(reader_of("a.obj", "nonsense"), "OBJ");
    assert_string_equal(reader_of("a", "\xef\xbb\xbf# by hand\r\n\r\nv -.5 0 1\n"), "OBJ");
    assert_string_equal(reader_of("a", "# by hand\nmtllib a.mtl\n"), "OBJ");
    assert_string_equal(reader_of("a.nff", "v\nfrom 0 0 1\n"), "Assimp");
    assert_string_equal(reader_of("gltf", ""), "Assimp");
    const uint8_t two[8] = {'g', 'l', 'T', 'F', 2}, one[8] = {'g', 'l', 'T', 'F', 1};
    assert_string_equal(import_format_of("a", two, sizeof two)->name, "glTF 2.0");
    assert_string_equal(import_format_of("a", one, sizeof one)->name, "Assimp");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        T(buffers_are_data_or_files),
        T(text_may_be_odd),
        T(what_is_no_glTF_2_is_refused),
        T(what_is_not_of_its_kind_is_said),
        T(glTF_1_is_handed_on),
        T(lists_and_members_of_all_the_wrong_kinds_do_no_harm),
        T(a_glb_has_its_buffer_in_its_chunk),
        T(content_goes_before_the_suffix),
    };
    return cmocka_run_group_tests(tests, make_folder, NULL);
}
