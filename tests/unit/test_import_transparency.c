/* Transparent materials are holes, but no file may vanish for it. What is hard: exporters write opacity where transparency is
 * asked for, and the other way round, and nothing in a file says so. Strategy: small files of three materials "a", "b", "c" of
 * 8, 1 and 1 triangles, one row each: which of them are left, and which warning says so. */
#define FOLDER VIT_BUILD_DIR "/tests/unit/import_transparency_files"
#include "import_lab.h"

static vit_status import_overridden(const char *mesh, const char *overrides, model *m, vit_text *why) {
    char text[1024];
    (void)snprintf(text, sizeof text, "materials = ( %s );", overrides);
    return import_in_scene(mesh, text, m, why);
}

/* Which materials have triangles, as "abc". */
static void kept(const model *m, char names[4]) {
    size_t n = 0;
    for (int i = 0; i < m->material_count && n < 3; i++)
        names[n++] = m->materials[i].name[0];
    names[n] = '\0';
}

#define INVERSE "taken the other way round"
#define OPAQUE "shown opaque"
#define HOLES "are left as holes"
#define VEILED "1 triangles of half transparent materials ('b') are shown opaque"

/* a, b, c: their lines in the MTL. */
static const struct {
    const char *a, *b, *c, *overrides, *kept, *warning;
} files[] = {
    /* By the letter. */
    {"d 1", "d 1", "d 1", "", "abc", ""},
    {"", "", "", "", "abc", ""},
    {"Tr 0", "Tr 0", "Tr 0.7", "", "ab", HOLES},
    {"d 1", "d 0", "", "", "ac", HOLES},
    {"", "d 0.3", "d 0", "", "a", HOLES},
    {"d 1", "d 0.7", "d 1", "", "abc", VEILED},
    {"d 1", "d 0.7", "d 1", "{ name = \"b\"; cutoff = 0.5; }", "abc", ""},
    {"d 1", "d 0.7\nillum 7\nNi 1.5", "d 1", "", "abc", ""},
    /* Exporters that mean opacity. */
    {"Tr 1", "Tr 1", "Tr 1", "", "abc", INVERSE},
    {"Tr 1.000000", "Tr 0.9", "Tr 0.3", "", "ab", INVERSE},
    {"d 0", "d 0", "d 0", "", "abc", INVERSE},
    {"d 0.0", "d 0.4", "d 0.8", "", "ab", INVERSE},
    /* Hardly anything would be left, or nothing. */
    {"d 0", "d 0", "d 1", "", "abc", OPAQUE},
    {"d 0", "d 1", "d 0.3", "", "b", HOLES}, /* 8 of 10 are not nearly all */
    {"d 0.2", "d 0.3", "d 0.4", "", "abc", OPAQUE},
    {"d 0.2", "d 0.3", "d 1", "", "c", HOLES}, /* glass, and something */
    /* Glass that MTL says is glass. */
    {"d 0\nillum 7\nNi 1.5", "d 0\nillum 7\nNi 1.5", "d 0\nillum 7\nNi 1.5", "", "abc", ""},
    {"d 1", "d 0\nillum 7\nNi 1.5", "d 0.2", "", "ab", HOLES},
    /* The scene file has the last word. */
    {"Tr 1", "Tr 1", "Tr 1", "{ name = \"b\"; cutoff = 0.5; }", "ac", INVERSE},
    {"d 0.2", "d 0.3", "d 0.4", "{ name = \"c\"; cutoff = 0.5; }", "ab", OPAQUE},
    {"d 1", "d 0", "d 0", "{ name = \"b\"; cutoff = 0; }", "ab", HOLES},
    {"d 1", "d 0.7", "d 1", "{ name = \"b\"; cutoff = 0.9; }", "ac", HOLES},
};

static void put_three(const char *a, const char *b, const char *c) {
    char text[1024];
    (void)snprintf(text, sizeof text, "newmtl a\nKd 1 1 1\n%s\nnewmtl b\nKd 1 1 1\n%s\nnewmtl c\nKd 1 1 1\n%s\n", a, b, c);
    put(FILE_OF("m.mtl"), text);
    put(FILE_OF("m.obj"), "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\nf 1 2 3\nf 1 2 3\nf 1 2 3\nf 1 2 3\nf 1 2 3\nf 1 "
                          "2 3\nf 1 2 3\nf 1 2 3\n"
                          "usemtl b\nf 1 2 3\nusemtl c\nf 1 2 3\n");
}

static void no_file_vanishes_for_its_transparency(void **state) {
    (void)state;
    for (size_t i = 0; i < sizeof files / sizeof files[0]; i++) {
        model m;
        vit_text why = {""};
        char names[4];
        put_three(files[i].a, files[i].b, files[i].c);
        if (import_overridden("m.obj", files[i].overrides, &m, &why) != VIT_OK)
            fail_msg("row %zu: %s", i, why.text);
        kept(&m, names);
        if (strcmp(names, files[i].kept) != 0)
            fail_msg("row %zu: materials %s are left, not %s\n%s", i, names, files[i].kept, warnings);
        if (files[i].warning[0] ? !strstr(warnings, files[i].warning) || !strstr(warnings, "cutoff") : warnings[0] != '\0')
            fail_msg("row %zu: '%s' is not '%s'", i, warnings, files[i].warning);
        model_free(&m);
    }
}

/* The texture is left out, with a warning, if it is not the colour's own. */
static void a_mapped_opacity_of_0_is_its_map(void **state) {
    model m;
    vit_text why = {""};
    char names[4];
    (void)state;
    put_three("d 1", "d 0\nmap_d mask.png", "d 0");
    if (import_overridden("m.obj", "", &m, &why) != VIT_OK)
        fail_msg("%s", why.text);
    kept(&m, names);
    assert_string_equal(names, "ab");
    assert_non_null(strstr(warnings, "opacity texture 'mask.png' is not the colour texture"));
    model_free(&m);
}

/* All of it by the user's own wish. */
static void a_scene_file_that_hides_everything_is_refused_with_the_cure(void **state) {
    model m;
    vit_text why = {""};
    (void)state;
    put_three("Tr 1", "Tr 1", "Tr 1");
    assert_int_equal(
        import_overridden("m.obj",
                          "{ name = \"a\"; cutoff = 0.5; }, { name = \"b\"; cutoff = 0.5; }, { name = \"c\"; cutoff = 0.5; }",
                          &m, &why),
        VIT_BAD_INPUT);
    assert_non_null(strstr(why.text, "transparency is not simulated; 'cutoff = 0'"));
}

/* A COLLADA file of materials "a" and "b", a triangle each, with these lines about their transparency. */
#define EFFECT(id)                                                                                                             \
    "<effect id=\"E" id "\"><profile_COMMON><technique sid=\"t\"><lambert><diffuse><color>0.5 0.5 0.5 "                        \
    "1</color></diffuse>%s</lambert></technique></profile_COMMON></effect>"
#define TRIANGLE(name)                                                                                                         \
    "<triangles count=\"1\" material=\"" name                                                                                  \
    "\"><input semantic=\"VERTEX\" source=\"#V\" offset=\"0\"/><p>0 1 2</p></triangles>"
static const char collada[] =
    "<?xml version=\"1.0\"?><COLLADA xmlns=\"http://www.collada.org/2005/11/COLLADASchema\" "
    "version=\"1.4.1\"><asset><up_axis>Y_UP</up_axis></asset>"
    "<library_effects>" EFFECT("a")
        EFFECT("b") "</library_effects>"
                    "<library_materials><material id=\"a\" name=\"a\"><instance_effect url=\"#Ea\"/></material>"
                    "<material id=\"b\" name=\"b\"><instance_effect url=\"#Eb\"/></material></library_materials>"
                    "<library_geometries><geometry id=\"G\"><mesh><source id=\"P\"><float_array id=\"PA\" count=\"9\">0 0 0 1 "
                    "0 0 0 1 0</float_array>"
                    "<technique_common><accessor source=\"#PA\" count=\"3\" stride=\"3\"><param name=\"X\" "
                    "type=\"float\"/><param name=\"Y\" type=\"float\"/>"
                    "<param name=\"Z\" type=\"float\"/></accessor></technique_common></source><vertices id=\"V\"><input "
                    "semantic=\"POSITION\" source=\"#P\"/></vertices>" TRIANGLE("a")
                        TRIANGLE("b") "</mesh></geometry></library_geometries>"
                                      "<library_visual_scenes><visual_scene id=\"S\"><node id=\"n\"><instance_geometry "
                                      "url=\"#G\"><bind_material><technique_common>"
                                      "<instance_material symbol=\"a\" target=\"#a\"/><instance_material symbol=\"b\" "
                                      "target=\"#b\"/></technique_common></bind_material></instance_geometry></node></"
                                      "visual_scene></library_visual_scenes>"
                                      "<scene><instance_visual_scene url=\"#S\"/></scene></COLLADA>";
#define DAE_CLEAR(value)                                                                                                       \
    "<transparent><color>1 1 1 1</color></transparent><transparency><float>" value "</float></transparency>"

/* Autodesk's exporter and Blender 2.4 write it for opaque materials. */
static void a_collada_transparency_of_0_is_opaque(void **state) {
    static const struct {
        const char *a, *b, *kept, *warning;
    } rows[] = {{DAE_CLEAR("0"), DAE_CLEAR("0"), "ab", INVERSE},
                {DAE_CLEAR("0"), DAE_CLEAR("0.7"), "a", INVERSE}, /* 70 % transparent */
                {DAE_CLEAR("0"), "", "ab", OPAQUE},
                {DAE_CLEAR("1"), DAE_CLEAR("0.3"), "a", HOLES}, /* by the letter */
                {DAE_CLEAR("1"), DAE_CLEAR("1"), "ab", ""}};
    (void)state;
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        model m;
        vit_text why = {""};
        char text[4096], names[4];
        (void)snprintf(text, sizeof text, collada, rows[i].a, rows[i].b);
        put(FILE_OF("m.dae"), text);
        if (import_overridden("m.dae", "", &m, &why) != VIT_OK)
            fail_msg("row %zu: %s", i, why.text);
        kept(&m, names);
        if (strcmp(names, rows[i].kept) != 0 || !strstr(warnings, rows[i].warning))
            fail_msg("row %zu: materials %s are left, not %s\n%s", i, names, rows[i].kept, warnings);
        model_free(&m);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(no_file_vanishes_for_its_transparency),
        cmocka_unit_test(a_mapped_opacity_of_0_is_its_map),
        cmocka_unit_test(a_scene_file_that_hides_everything_is_refused_with_the_cure),
        cmocka_unit_test(a_collada_transparency_of_0_is_opaque),
    };
    return cmocka_run_group_tests_name("transparency", tests, make_folder, NULL);
}
