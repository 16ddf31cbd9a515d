/* What --list says. What is hard: names come from strangers and go into JSON and onto terminals. Strategy: small files made
 * here, one with the worst of names, whose JSON must be valid by RFC 8259 and hold what was put in; extensions in all the
 * places where the words may stand without being the list. */
#define FOLDER VIT_BUILD_DIR "/tests/unit/list_files"
#include "json_check.h"
#include "list.h"
#include "test_folder.h"

/* What is printed of a mesh or scene file; the caller frees it. */
static char *list_of(const char *path, bool json) {
    scene s;
    vit_text why = {{0}};
    char *text = NULL;
    size_t size = 0;
    FILE *to = open_memstream(&text, &size);
    assert_non_null(to);
    const bool is_scene = strstr(path, ".cfg") != NULL;
    assert_int_equal(is_scene ? scene_read(path, &s, &why) : scene_for_mesh(path, &s, &why), VIT_OK);
    const vit_status status = list_print(&s, false, json, to, &why);
    if (status != VIT_OK)
        fail_msg("%s", why.text);
    scene_free(&s);
    assert_int_equal(fclose(to), 0);
    return text;
}

static void holds(const char *text, const char *what) {
    if (!strstr(text, what))
        fail_msg("'%s' is not in:\n%s", what, text);
}

/* A triangle, a lamp, a camera; the names of mesh and material end a line, close a string and are no UTF-8. */
static void put_odd(void) {
    static const float corners[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    put_bytes(FILE_OF("odd.bin"), corners, sizeof corners);
    put(FILE_OF("odd.gltf"),
        "{\"asset\":{\"version\":\"2.0\",\"extensionsUsed\":[\"NOT_THIS\"]},\"extras\":{"
        "\"extensionsRequired\":[\"NOR_THIS\"]},\"scene\":0,"
        "\"extensionsUsed\" : [ \"KHR_lights_punctual\",\"VENDOR_strange\\\"one\" , "
        "\"KHR_materials_ior\"],\"extensionsRequired\":[\"VENDOR_needed\"],"
        "\"scenes\":[{\"nodes\":[0,1,2,3]}],\"nodes\":[{\"mesh\":0},{\"name\":\"Lamp\",\"translation\":"
        "[0,2,0],\"extensions\":{\"KHR_lights_punctual\":"
        "{\"light\":0}}},{\"name\":\"Eye\",\"camera\":0},{\"name\":\"Spot\",\"translation\":[0,3,0],"
        "\"extensions\":{\"KHR_lights_punctual\":{\"light\":1}}}],\"cameras\":[{\"type\":\"perspective\","
        "\"perspective\":{\"yfov\":1.0,\"aspectRatio\":1,"
        "\"znear\":0.1}}],\"extensions\":{\"KHR_lights_punctual\":{\"lights\":[{\"type\":\"point\","
        "\"intensity\":68.3,\"name\":\"extensionsUsed\"},{\"type\":\"spot\",\"intensity\":68.3,\"range\":4,"
        "\"spot\":{\"innerConeAngle\":0.25,\"outerConeAngle\":0.5}}]}},"
        "\"buffers\":[{\"uri\":\"odd.bin\",\"byteLength\":36}],\"bufferViews\":[{\"buffer\":0,"
        "\"byteLength\":36}],\"accessors\":[{\"bufferView\":0,"
        "\"componentType\":5126,\"count\":3,\"type\":\"VEC3\",\"min\":[0,0,0],\"max\":[1,1,0]}],"
        "\"materials\":[{\"name\":\"m\\\"a\\\\t\\n</script>\"}],\"meshes\":[{\"name\":\"odd "
        "\xff\",\"primitives\":[{\"attributes\":{\"POSITION\":0},"
        "\"material\":0}]}]}");
}

static void odd_names_are_valid_json(void **state) {
    (void)state;
    put_odd();
    char *text = list_of(FILE_OF("odd.gltf"), true);
    if (!json_valid(text))
        fail_msg("no JSON:\n%s", text);
    holds(text, "\"name\": \"m\\\"a\\\\t\\u000a\\u003c/script\\u003e\"");
    holds(text, "{\"name\": \"Lamp\", \"kind\": \"point\", \"position\": [0, 2, 0]");
    holds(text, "\"stated_unit\": \"cd\"");
    holds(text, "\"power_unit\": \"W\"");
    holds(text, "\"range\": 4, \"inner\": 14.3239448");
    holds(text, ", \"outer\": 28.6478897");
    holds(text, "{\"name\": \"Eye\", \"eye\": [0, 0, 0]");
    holds(text, "\"triangles\": 1, \"places\": 1}");
    free(text);
}

static void people_see_one_line_a_thing(void **state) {
    (void)state;
    put_odd();
    char *text = list_of(FILE_OF("odd.gltf"), false);
    holds(text, "1 triangles, 3 vertices, box (0, 0, 0) to (1, 1, 0) m");
    holds(text, "\nmeshes 1\n  'odd ");
    holds(text, "\n  'm\"a\\t?</script>' matt, 1 triangles");
    holds(text,
          "\nlights 2\n  'Lamp' point at (0, 2, 0): the file says (68.3, 68.3, 68.3) cd, taken as (1.257, 1.257, 1.257) W\n"
          "  'Spot' spot at (0, 3, 0) towards (0, 0, -1), fading from 14.32 to 28.65 degrees off its axis, range 4 m: the file "
          "says (68.3, 68.3, 68.3) cd, taken as (1.257, 1.257, 1.257) W\n");
    holds(text, "\ncameras 1\n  'Eye' at (0, 0, 0)");
    holds(text, "'VENDOR_needed' required, not read");
    holds(text, "'KHR_materials_ior' used, read");
    free(text);
}

/* Of a file that is good but for this; the model is the caller's. */
static void import_listed(const char *path, model *m) {
    scene s;
    vit_text why = {{0}};
    assert_int_equal(scene_for_mesh(path, &s, &why), VIT_OK);
    const vit_status status = model_import(&s, MODEL_LISTS, NULL, NULL, m, &why);
    scene_free(&s);
    if (status != VIT_OK)
        fail_msg("%s", why.text);
}

static void only_the_files_own_lists_of_extensions_count(void **state) {
    model m;
    (void)state;
    put_odd();
    import_listed(FILE_OF("odd.gltf"), &m);
    assert_int_equal(m.extension_count, 4);
    assert_string_equal(m.extensions[0].name, "KHR_lights_punctual");
    assert_true(m.extensions[0].read && !m.extensions[0].required);
    assert_string_equal(m.extensions[1].name, "VENDOR_strange\"one");
    assert_string_equal(m.extensions[3].name, "VENDOR_needed");
    assert_true(m.extensions[3].required && !m.extensions[3].read);
    model_free(&m);
    put(FILE_OF("odd.obj"), "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    import_listed(FILE_OF("odd.obj"), &m);
    assert_int_equal(m.extension_count, 0);
    model_free(&m);
}

static void what_is_not_done_is_told(void **state) {
    (void)state;
    put(FILE_OF("b.mtl"), "newmtl m\nKd 1 1 1\nmap_Kd nowhere.png\n");
    put(FILE_OF("b.obj"), "mtllib b.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nusemtl m\nf 1/1 2/1 3/1\n");
    put(FILE_OF("b.cfg"), "meshes = ( { file = \"b.obj\"; units = 0.01; up = \"z\"; }, { file = \"odd.gltf\"; } );\n"
                          "camera: { use = \"Eye\"; };\n");
    put_odd();
    char *text = list_of(FILE_OF("b.cfg"), true);
    assert_true(json_valid(text));
    holds(text, "\"not_done\": [\n    ");
    holds(text, "nowhere.png");
    holds(text, "\"unit\": 0.01, \"unit_by\": \"scene\", \"up\": \"z\", \"up_by\": \"scene\"}");
    holds(text, "\"unit\": 1, \"unit_by\": \"format\", \"up\": \"y\", \"up_by\": \"format\"}");
    holds(text, "\"file\": \"" FOLDER "/odd.gltf\", \"triangles\": 1");
    free(text);
    text = list_of(FILE_OF("b.cfg"), false);
    holds(text, "\nnot done 3\n"); /* the texture, and of the extensions one that is required and one that is used */
    holds(text, "b.obj' is read as OBJ, without curves");
    holds(text, "odd.gltf' is read as glTF 2.0, without animations");
    holds(text, "; 1 unit is 0.01 m and z is up: the scene file says so\n");
    free(text);
}

int main(void) {
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(odd_names_are_valid_json),
        cmocka_unit_test(people_see_one_line_a_thing),
        cmocka_unit_test(only_the_files_own_lists_of_extensions_count),
        cmocka_unit_test(what_is_not_done_is_told),
    };
    return cmocka_run_group_tests(tests, make_folder, NULL);
}
