/* Lines of MTL, and how OBJ finds them. What is hard: options with numbers that may be left out stand before names that may
 * hold blanks, names lead nowhere, and lines contradict each other. Strategy: as in test_obj_files.c, on a quad of one material
 * "m". What kinds of material come of it is the subject of test_import_materials.c, transparency that of
 * test_import_transparency.c. */
#define FOLDER VIT_BUILD_DIR "/tests/unit/mtl_lines"
#include "import_lab.h"
#include "import/metallic_roughness.h"

#define QUAD FILE_OF("quad.obj")

/* The quad with these lines of its material; `words`: the warning that it gets, or "" for none. */
static void import_lines(const char *lines, const char *words, model *m) {
    char text[1024];
    (void)snprintf(text, sizeof text, "newmtl m\n%s", lines);
    put_obj(text);
    put_image(FILE_OF("a.tga"), 255);
    put_image(FILE_OF("b c.tga"), 255);
    import_good(QUAD, m);
    check_promises(m);
    if (*words ? !strstr(warnings, words) : warnings[0] != '\0')
        fail_msg("%s: '%s' is not '%s'", lines, warnings, words);
}

static void a_colour_of_one_value_is_grey(void **state) {
    static const struct {
        const char *line;
        double r, g, b;
    } rows[] = {{"Kd .6", 0.6, 0.6, 0.6}, {"Kd .1 .2 .3", 0.1, 0.2, 0.3},     {"Kd .1 .2", 0.1, 0.2, 0.1},
                {"Kd 7 -1 nan", 1, 0, 0}, {"\tkd\t.6 # dull", 0.6, 0.6, 0.6}, {"", 0.6, 0.6, 0.6}};
    (void)state;
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        model m;
        import_lines(rows[i].line, "", &m);
        if (!near3(m.materials[0].albedo, fmin(rows[i].r, (double)VIT_MAX_ALBEDO), rows[i].g, rows[i].b))
            fail_msg("%s: %g", rows[i].line, (double)m.materials[0].albedo[0]);
        model_free(&m);
    }
}

static void a_texture_alone_is_not_dimmed(void **state) {
    model m;
    (void)state;
    import_lines("map_Kd a.tga", "", &m);
    assert_true(near3(m.materials[0].albedo, 1, 1, 1) && m.image_count == 1);
    model_free(&m);
    import_lines("map_Kd a.tga\nKd .5", "", &m);
    assert_true(near3(m.materials[0].albedo, 0.5, 0.5, 0.5));
    model_free(&m);
    import_lines("Kd 0 0 0\nmap_Kd a.tga", "black times a texture", &m);
    assert_true(near3(m.materials[0].albedo, 1, 1, 1));
    model_free(&m);
}

/* The corner (1, 1) has u = v = 1 in the file, v upwards, and the first row in ours. */
static void options_place_the_picture(void **state) {
    static const struct {
        const char *map;
        float near_u, near_v, far_u, far_v; /* of (0, 0) and (1, 1), v upwards */
    } rows[] = {{"a.tga", 0, 0, 1, 1},
                {"-s 2 3 1 a.tga", 0, 0, 2, 3},
                {"-s 2 a.tga", 0, 0, 2, 1},
                {"-o .25 .5 a.tga", 0.25f, 0.5f, 1.25f, 1.5f},
                {"-o .25 -s 2 2 a.tga", 0.25f, 0, 2.25f, 2},
                {"-blendu off -boost 2 -bm .5 -s 2 2 2 -type sphere a.tga", 0, 0, 2, 2},
                {"-s 2 2 \\\n b c.tga \t", 0, 0, 2, 2}};
    (void)state;
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        char line[256];
        model m;
        (void)snprintf(line, sizeof line, "Kd 1\nmap_Kd %s\n", rows[i].map);
        import_lines(line, "", &m);
        if (m.image_count != 1 || m.materials[0].wrap_u != VIT_WRAP_REPEAT)
            fail_msg("%s: no texture", rows[i].map);
        uv_at(&m, 0, 0, rows[i].near_u, 1 - rows[i].near_v);
        uv_at(&m, 1, 1, rows[i].far_u, 1 - rows[i].far_v);
        model_free(&m);
    }
    model m;
    import_lines("map_Kd -clamp on a.tga", "", &m);
    assert_true(m.materials[0].wrap_u == VIT_WRAP_CLAMP && m.materials[0].wrap_v == VIT_WRAP_CLAMP);
    model_free(&m);
    import_lines("map_Kd -clamp off a.tga", "", &m);
    assert_true(m.materials[0].wrap_u == VIT_WRAP_REPEAT);
    model_free(&m);
}

static void d_goes_before_tr(void **state) {
    model m;
    (void)state;
    import_lines("d .75\nTr .25", "half transparent", &m);
    assert_true(m.materials[0].alpha == 0.75f);
    model_free(&m);
    import_lines("Tr .25", "half transparent", &m);
    assert_true(m.materials[0].alpha == 0.75f);
    model_free(&m);
    import_lines("Tr 1\nd 1", "d and Tr contradict each other", &m);
    assert_true(m.materials[0].alpha == 1.0f);
    model_free(&m);
    import_lines("d -halo 0.9", "'-halo' of d is left out", &m);
    assert_true(m.materials[0].alpha == 0.9f && m.triangles == 2);
    model_free(&m);
}

static void roughness_and_metalness_are_gltfs(void **state) {
    model m;
    (void)state;
    import_lines("Kd .8 .6 .4\nPr .3\nPm 1\nillum 1", "", &m);
    assert_true(near3(m.materials[0].specular, 0.8, 0.6, 0.4) && near3(m.materials[0].albedo, 0, 0, 0));
    assert_true(m.materials[0].exponent == specular_exponent(0.3f));
    model_free(&m);
    import_lines("Kd .8\nPm 1\nPr .05", "", &m);
    assert_true(m.materials[0].kind == VIT_MIRROR);
    model_free(&m);
    import_lines("Kd .8\nPr 1\nKs .5\nNs 40\nillum 2", "", &m);
    assert_true(is_matt(&m.materials[0]) && near3(m.materials[0].albedo, 0.8, 0.8, 0.8));
    model_free(&m);
    import_lines("Kd .8\nPr 1\nmap_Pr a.tga", "", &m); /* red of red, green, blue, white: 0.5 */
    assert_true(fabsf(m.materials[0].exponent - specular_exponent(0.5f)) < 1e-4f);
    model_free(&m);
    import_lines("Kd .8\nd .1\nPr 0\nillum 7\nNi 1.5", "", &m);
    assert_true(m.materials[0].kind == VIT_GLASS);
    model_free(&m);
}

static void what_is_not_done_is_said(void **state) {
    static const char *const rows[][2] = {
        {"bump -bm 2 a.tga", "bump and displacement maps are left out (material 'm'"},
        {"map_Kd a.tga\nnorm -s 2 2 2 a.tga", "normal maps that lie otherwise than the colour are left out"},
        {"refl -type sphere a.tga", "reflection maps are left out"},
        {"decal a.tga", "decals are left out"},
        {"map_Ns a.tga", "maps of Ns"},
        {"Ps .5", "sheen, clearcoat and anisotropy"},
        {"Pc 1", "sheen, clearcoat and anisotropy"},
        {"map_Kd -t 1 1 a.tga", "options -t, -mm"},
        {"map_Kd -mm .5 .5 a.tga", "options -t, -mm"},
        {"map_Kd -cc on a.tga", "options -t, -mm"},
        {"map_Kd -imfchan r a.tga", "options -t, -mm"},
        {"Kd spectral a.rfl", "colours as 'spectral'"},
        {"map_Ke a.tga\nKe 1", "emissive textures are not supported"},
        {"map_Kd a.tga\nmap_d b c.tga", "opacity texture 'b c.tga' is not the colour texture"},
        {"Kd red", "line 2: no number: 'red'"},
        {"Ns", "line 2: a number is missing"},
        {"Qx 1", "line 2: 'Qx' is not known"}};
    model m;
    (void)state;
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        import_lines(rows[i][0], rows[i][1], &m);
        model_free(&m);
        refuse(QUAD, true, rows[i][1]);
    }
    import_lines("Ps 0\nPc 0\nmap_Kd -t 0 0 0 -mm 0 1 -cc off a.tga\nbump\nKa 1 1 1\nmap_Ka a.tga\nsharpness 60", "", &m);
    model_free(&m);
}

/* ---- which file has it ---- */

/* A triangle of the materials "a b" and "c". */
static void import_named(const char *head, const char *behind, const char *words, model *m) {
    char text[512];
    (void)snprintf(text, sizeof text, "%s\n" OBJ_QUAD "usemtl a b \nf 1 2 3\nusemtl\tc\nf 1 3 4\n%s\n", head, behind);
    put(FILE_OF("n.obj"), text);
    import_good(FILE_OF("n.obj"), m);
    if (*words ? !strstr(warnings, words) : warnings[0] != '\0')
        fail_msg("%s: '%s' is not '%s'", head, warnings, words);
}

static void material_files_are_found(void **state) {
    static const char *const heads[] = {"mtllib a.mtl c.mtl",         "mtllib a.mtl\nmtllib c.mtl",
                                        "mtllib c.mtl  one two.mtl ", "mtllib one two.mtl c.mtl",
                                        "mtllib both of them",        "mtllib .\\a.mtl /home/x/c.mtl"};
    (void)state;
    put(FILE_OF("a.mtl"), "newmtl a b\nKd .1\n");
    put(FILE_OF("one two.mtl"), "newmtl a b\nKd .1\n");
    put(FILE_OF("c.mtl"), "# two\r\nnewmtl c \r\nKd .2\r\nnewmtl a b\r\nKd .9\r\n");
    put(FILE_OF("both of them"), "newmtl c\nKd .2\nnewmtl unused\nbump x.png\nnewmtl a b\nKd .1");
    for (size_t i = 0; i < sizeof heads / sizeof *heads; i++) {
        model m;
        const bool backwards = strstr(heads[i], "c.mtl  one") != NULL; /* the first definition counts */
        import_named(heads[i], "", "", &m);
        assert_true(near3(named(&m, "a b")->albedo, backwards ? 0.9 : 0.1, backwards ? 0.9 : 0.1, backwards ? 0.9 : 0.1));
        assert_true(near3(named(&m, "c")->albedo, 0.2, 0.2, 0.2));
        model_free(&m);
        import_named("", heads[i], "", &m); /* behind usemtl */
        assert_true(near3(named(&m, "c")->albedo, 0.2, 0.2, 0.2));
        model_free(&m);
    }
}

static void what_is_nowhere_is_said(void **state) {
    model m;
    vit_text why;
    (void)state;
    (void)remove(FILE_OF("n.mtl")); /* of an earlier run */
    put(FILE_OF("a.mtl"), "newmtl a b\nKd .1\n");
    import_named("mtllib a.mtl gone.mtl", "", "its material file 'gone.mtl' is not there", &m);
    assert_true(near3(named(&m, "a b")->albedo, 0.1, 0.1, 0.1) && near3(named(&m, "c")->albedo, 0.6, 0.6, 0.6));
    model_free(&m);
    import_named("mtllib a.mtl", "", "material 'c' is in no material file: it is plain grey", &m);
    model_free(&m);
    refuse(FILE_OF("n.obj"), true, "material 'c' is in no material file");
    import_named("", "", "material 'a b' and 1 others are in no material file", &m);
    model_free(&m);
    put(FILE_OF("n.obj"), "mtllib a.mtl\n" OBJ_QUAD "usemtl c\n" OBJ_FACES); /* the scene file has it */
    assert_int_equal(import_in_scene("n.obj", "materials = ( { name = \"c\"; color = (1, 0, 0); } );", &m, &why), VIT_OK);
    assert_string_equal(warnings, "");
    model_free(&m);
    put(FILE_OF("n.mtl"), "newmtl c\nKd .3\n"); /* beside n.obj */
    import_named("mtllib old.mtl", "", "its material file 'old.mtl' is not there", &m);
    assert_true(near3(named(&m, "c")->albedo, 0.3, 0.3, 0.3));
    model_free(&m);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        T(a_colour_of_one_value_is_grey),     T(a_texture_alone_is_not_dimmed),
        T(options_place_the_picture),         T(d_goes_before_tr),
        T(roughness_and_metalness_are_gltfs), T(what_is_not_done_is_said),
        T(material_files_are_found),          T(what_is_nowhere_is_said),
    };
    return cmocka_run_group_tests(tests, make_folder, NULL);
}
