/* Unit and up axis of files that Assimp reads: its releases differ in what they apply of a file's axes, and none applies FBX's
 * or AMF's unit. Each file is written here (foreign_lab.h); right is worked out by hand: the triangle in x and y, as long as
 * the unit. */
#define FOLDER VIT_BUILD_DIR "/tests/unit/import_frames"
#include "foreign_lab.h"
#include "import/import_frame.h"
#include <zip.h>

static void frame_is(const model *m, double unit, unsigned up, unsigned unit_by, unsigned up_by) {
    const model_frame *f = &m->formats[0].frame;
    assert_int_equal(m->format_count, 1);
    if (fabs(f->unit - unit) > 1e-9 || f->up != up || f->unit_by != unit_by || f->up_by != up_by)
        fail_msg("unit %.9g by %u, axis %u by %u", f->unit, f->unit_by, f->up, f->up_by);
}

/* ---- FBX ---- */

static void fbx_is_in_its_unit_and_on_its_axes(void **state) {
    static const struct {
        const char *corners;
        int axes[6];
        double unit, size;
        unsigned up;
    } rows[] = {
        {"0,0,0,1,0,0,0,1,0", {0, 1, 1, 1, 2, 1}, 1, 0.01, FRAME_Y},  /* Maya, Blender */
        {"0,0,0,1,0,0,0,0,1", {0, 1, 2, 1, 1, -1}, 1, 0.01, FRAME_Z}, /* 3ds Max */
        {"0,0,0,1,0,0,0,0,1", {0, 1, 2, 1, 1, -1}, 2.54, 0.0254, FRAME_Z},
        {"0,0,0,1,0,0,0,1,0", {0, 1, 1, 1, 2, 1}, 100, 1, FRAME_Y},
        {"0,0,0,0,1,0,1,0,0", {1, 1, 0, 1, 2, -1}, 100, 1, FRAME_X},
        {"0,0,0,-1,0,0,0,0,1", {0, -1, 2, 1, 1, 1}, 100, 1, FRAME_Z}, /* the front is +y */
    };
    model m;
    (void)state;
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        put_fbx(rows[i].corners, rows[i].axes, rows[i].unit, "", "");
        import_good(FILE_OF("t.fbx"), &m);
        box_is(&m, 0, 0, 0, rows[i].size, rows[i].size, 0);
        frame_is(&m, rows[i].size, rows[i].up, FRAME_BY_FILE, FRAME_BY_FILE);
        assert_string_equal(warnings, "");
        model_free(&m);
    }
}

static void a_unit_or_axes_that_are_none_are_told(void **state) {
    static const int twice[6] = {0, 1, 0, 1, 2, 1};
    model m;
    (void)state;
    put_fbx("0,0,0,1,0,0,0,1,0", y_up, -3, "", "");
    import_good(FILE_OF("t.fbx"), &m);
    box_is(&m, 0, 0, 0, 0.01, 0.01, 0);
    assert_non_null(strstr(warnings, "UnitScaleFactor of -3"));
    model_free(&m);
    refuse(FILE_OF("t.fbx"), true, "UnitScaleFactor of -3");
    put_fbx("0,0,0,1,0,0,0,1,0", twice, 1, "", "");
    import_good(FILE_OF("t.fbx"), &m);
    box_is(&m, 0, 0, 0, 0.01, 0.01, 0);
    assert_non_null(strstr(warnings, "its three axes are not three"));
    model_free(&m);
}

static void the_scene_file_beats_unit_and_axis(void **state) {
    model m;
    (void)state;
    put_fbx("0,0,0,1,0,0,0,0,1", z_up, 1, "", "");
    import_with("t.fbx", "units = 0.5;", &m);
    box_is(&m, 0, 0, 0, 0.5, 0.5, 0);
    frame_is(&m, 0.5, FRAME_Z, FRAME_BY_SCENE, FRAME_BY_FILE);
    model_free(&m);
    import_with("t.fbx", "up = \"y\"; scale = 10;", &m); /* z stays z, which is to the viewer */
    box_is(&m, 0, 0, 0, 0.1, 0, 0.1);
    frame_is(&m, 0.01, FRAME_Y, FRAME_BY_FILE, FRAME_BY_SCENE);
    model_free(&m);
    put(FILE_OF("t.obj"), "v 0 0 0\nv 1 0 0\nv 0 0 1\nf 1 2 3\n");
    import_with("t.obj", "units = 0.001; up = \"z\"; translate = [5, 0, 0];", &m);
    box_is(&m, 5, 0, 0, 5.001, 0.001, 0);
    frame_is(&m, 0.001, FRAME_Z, FRAME_BY_SCENE, FRAME_BY_SCENE);
    model_free(&m);
    import_with("t.obj", "up = \"auto\"; units = \"auto\";", &m);
    box_is(&m, 0, 0, 0, 1, 0, 1);
    frame_is(&m, 1, FRAME_Y, FRAME_BY_NOBODY, FRAME_BY_NOBODY);
    model_free(&m);
    put_gltf(UVS, MATERIAL("\"doubleSided\":true") "," ONE_NODE);
    import_with("quad.gltf", "up = \"x\";", &m);
    box_is(&m, -1, 0, 0, 0, 1, 0);
    frame_is(&m, 1, FRAME_X, FRAME_BY_FORMAT, FRAME_BY_SCENE);
    model_free(&m);
}

/* ---- COLLADA ---- */

static void collada_is_in_its_unit_and_on_its_axis(void **state) {
    static const struct {
        const char *asset, *corners;
        double unit;
        unsigned up;
    } rows[] = {{"", "0 0 0 1 0 0 0 1 0", 1, FRAME_Y},
                {DAE_UNIT("0.0254", "Y"), "0 0 0 1 0 0 0 1 0", 0.0254, FRAME_Y},
                {DAE_UNIT("0.01", "Z"), "0 0 0 1 0 0 0 0 1", 0.01, FRAME_Z},
                {DAE_UNIT("2", "X"), "0 0 0 0 -1 0 1 0 0", 2, FRAME_X}};
    model m;
    (void)state;
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        put_dae(rows[i].asset, rows[i].corners, "");
        import_good(FILE_OF("t.dae"), &m);
        box_is(&m, 0, 0, 0, rows[i].unit, rows[i].unit, 0);
        frame_is(&m, rows[i].unit, rows[i].up, FRAME_BY_FILE, FRAME_BY_FILE);
        model_free(&m);
        /* What Assimp has applied is taken back. */
        import_with("t.dae", "units = 3;", &m);
        box_is(&m, 0, 0, 0, 3, 3, 0);
        model_free(&m);
    }
    import_with("t.dae", "units = 1; up = \"y\";", &m); /* as the numbers stand */
    box_is(&m, 0, -1, 0, 1, 0, 0);
    frame_is(&m, 1, FRAME_Y, FRAME_BY_SCENE, FRAME_BY_SCENE);
    model_free(&m);
}

/* XML collapses the white space round numbers and words; comments say nothing; the library's own asset is not the file's. */
static void white_space_in_collada_means_nothing(void **state) {
    static const struct {
        const char *asset;
        unsigned up;
    } rows[] = {{"<unit name=\"x\" meter=\" 2\"/>", FRAME_Y},
                {"<unit meter = '\n\t2e0 ' name=\"meter\"/><up_axis>\n Y_UP\n</up_axis>", FRAME_Y},
                {"<!-- <unit meter=\"3\"/> --><unit meter=\"+2.\"/>", FRAME_Y},
                {"<unit meter=\"2 \"/><up_axis>Z_UP\n</up_axis>", FRAME_Z}};
    (void)state;
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        model m;
        put_dae(rows[i].asset, rows[i].up == FRAME_Z ? "0 0 0 1 0 0 0 0 1" : "0 0 0 1 0 0 0 1 0", "");
        import_good(FILE_OF("t.dae"), &m);
        box_is(&m, 0, 0, 0, 2, 2, 0);
        frame_is(&m, 2, rows[i].up, FRAME_BY_FILE, FRAME_BY_FILE);
        assert_string_equal(warnings, "");
        model_free(&m);
    }
}

static void units_and_axes_of_collada_that_are_none_are_told(void **state) {
    static const char *const units[] = {"", " ", "abc", "0,5", "1.0f", "2 3", "-1", "0", "inf", "1e400", "0x2"};
    model m;
    (void)state;
    for (size_t i = 0; i < sizeof units / sizeof *units; i++) {
        char text[64];
        (void)snprintf(text, sizeof text, "<unit meter=\"%s\"/>", units[i]);
        put_dae(text, "0 0 0 1 0 0 0 1 0", "");
        refuse(FILE_OF("t.dae"), false, "has a <unit> that is no positive number of metres");
    }
    put_dae("<up_axis>z_up</up_axis>", "0 0 0 1 0 0 0 1 0", "");
    import_good(FILE_OF("t.dae"), &m);
    assert_non_null(strstr(warnings, "its <up_axis> is none: y is taken as up"));
    model_free(&m);
    refuse(FILE_OF("t.dae"), true, "its <up_axis> is none");
}

/* ---- AMF ---- */

#define AMF_POINT(x, y) "<vertex><coordinates><x>" #x "</x><y>" #y "</y><z>0</z></coordinates></vertex>"
/* A file of one triangle; `before` and `behind` its object. */
#define AMF(attributes, before, volume, behind)                                                                                \
    "<?xml version=\"1.0\"?>\n<amf " attributes ">" before "<object id=\"1\"><mesh><vertices>" AMF_POINT(0, 0) AMF_POINT(1, 0) \
        AMF_POINT(0, 1) "</vertices><volume" volume                                                                            \
                        "><triangle><v1>0</v1><v2>1</v2><v3>2</v3></triangle></volume></mesh></object>" behind "</amf>"

/* An archive of that text alone. */
static void put_zip(const char *path, const char *text) {
    int error;
    zip_t *archive = zip_open(path, ZIP_CREATE | ZIP_TRUNCATE, &error);
    assert_non_null(archive);
    assert_true(zip_file_add(archive, "model.amf", zip_source_buffer(archive, text, strlen(text), 0), 0) >= 0);
    assert_int_equal(zip_close(archive), 0);
}

static void files_of_amf_are_in_their_unit(void **state) {
    static const char amf[] = AMF("%s", "", "", "");
    char text[1024];
    model m;
    (void)state;
    (void)snprintf(text, sizeof text, amf, "unit=\"inch\"");
    put(FILE_OF("t.amf"), text);
    import_good(FILE_OF("t.amf"), &m);
    box_is(&m, 0, 0, 0, 0.0254, 0.0254, 0);
    frame_is(&m, 0.0254, FRAME_Y, FRAME_BY_FILE, FRAME_BY_NOBODY);
    assert_true(m.materials[0].albedo[0] >= 0.6f); /* no colour is none, not black */
    model_free(&m);
    put_zip(FILE_OF("t.amf"), text); /* as FreeCAD writes it */
    import_good(FILE_OF("t.amf"), &m);
    box_is(&m, 0, 0, 0, 0.0254, 0.0254, 0);
    frame_is(&m, 0.0254, FRAME_Y, FRAME_BY_FILE, FRAME_BY_NOBODY);
    model_free(&m);
    (void)snprintf(text, sizeof text, amf, "");
    put(FILE_OF("t.amf"), text);
    import_good(FILE_OF("t.amf"), &m);
    frame_is(&m, 0.001, FRAME_Y, FRAME_BY_FORMAT, FRAME_BY_NOBODY);
    model_free(&m);
    (void)snprintf(text, sizeof text, amf, "unit=\"cubit\"");
    put_zip(FILE_OF("t.amf"), text);
    refuse(FILE_OF("t.amf"), false, "cubit");
}

static void a_colour_of_amf_is_all_of_it(void **state) {
    model m;
    (void)state;
    put(FILE_OF("t.amf"), AMF("unit=\"meter\"", "<material id=\"2\"><color><r>1</r><g>0.5</g><b>0</b></color></material>",
                              " materialid=\"2\"", ""));
    import_good(FILE_OF("t.amf"), &m);
    assert_true(m.materials[0].albedo[0] == 1.0f && m.materials[0].albedo[1] == 0.5f && m.materials[0].albedo[2] == 0.0f);
    model_free(&m);
}

/* Two of a triangle in a constellation, the second 5 m along x and turned by 90 degrees about z, or by none. */
static void instances_of_amf_stand_where_they_should_or_are_refused(void **state) {
    static const char amf[] = AMF("unit=\"meter\"", "", "",
                                  "<constellation id=\"2\"><instance objectid=\"1\"><deltax>0</deltax></instance>"
                                  "<instance objectid=\"1\"><deltax>5</deltax><rz> %s</rz></instance></constellation>");
    char text[1024];
    model m;
    (void)state;
    (void)snprintf(text, sizeof text, amf, "0.0");
    put(FILE_OF("t.amf"), text);
    import_good(FILE_OF("t.amf"), &m);
    box_is(&m, 0, 0, 0, 6, 1, 0);
    model_free(&m);
    (void)snprintf(text, sizeof text, amf, "90");
    put(FILE_OF("t.amf"), text);
    refuse(FILE_OF("t.amf"), false, "its constellation turns instances (<rx>, <ry>, <rz>)");
}

/* ---- the rest ---- */

static void a_format_without_a_unit_is_metres_and_y_up_unless_the_scene_says(void **state) {
    model m;
    (void)state;
    put(FILE_OF("t.stl"), "solid t\nfacet normal 0 -1 0\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 0 1\nendloop\n"
                          "endfacet\nendsolid t\n");
    import_good(FILE_OF("t.stl"), &m);
    box_is(&m, 0, 0, 0, 1, 0, 1);
    frame_is(&m, 1, FRAME_Y, FRAME_BY_NOBODY, FRAME_BY_NOBODY);
    model_free(&m);
    import_with("t.stl", "units = 0.001; up = \"z\";", &m);
    box_is(&m, 0, 0, 0, 0.001, 0.001, 0);
    normal_at(&m, 0, 0, 0, 0, 0, 1); /* -y of the file is to the viewer */
    model_free(&m);
}

static void put_x3d(const char *head) {
    char text[1024];
    (void)snprintf(text, sizeof text,
                   "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<X3D profile=\"Interchange\" version=\"3.3\">%s<Scene><Shape>"
                   "<IndexedFaceSet coordIndex=\"0 1 2 -1\"><Coordinate point=\"0 0 0 1 0 0 0 1 0\"/></IndexedFaceSet>"
                   "</Shape></Scene></X3D>\n",
                   head);
    put(FILE_OF("t.x3d"), text);
}

static void x3d_is_in_its_unit_and_y_is_up(void **state) {
    static const struct {
        const char *head;
        double unit;
        unsigned by;
    } rows[] = {{"", 1, FRAME_BY_FORMAT},
                {"<head><unit category=\"length\" name=\"inch\" conversionFactor=\"0.0254\"/></head>", 0.0254, FRAME_BY_FILE},
                {"<head><unit category='angle' name='degree' conversionFactor='0.0174533'/></head>", 1, FRAME_BY_FORMAT}};
    model m;
    (void)state;
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        put_x3d(rows[i].head);
        import_good(FILE_OF("t.x3d"), &m);
        box_is(&m, 0, 0, 0, rows[i].unit, rows[i].unit, 0);
        frame_is(&m, rows[i].unit, FRAME_Y, rows[i].by, FRAME_BY_FORMAT);
        model_free(&m);
    }
    put_x3d("<head><unit category=\"length\" name=\"x\" conversionFactor=\"-1\"/></head>");
    refuse(FILE_OF("t.x3d"), false, "has a <unit> of lengths that is no positive number of metres");
}

static void frames_in_words(void **state) {
    char text[FRAME_TEXT];
    (void)state;
    assert_string_equal(frame_text(&(model_frame){0.01f, FRAME_Z, FRAME_BY_FILE, FRAME_BY_FILE}, text),
                        "1 unit is 0.01 m and z is up: the file says so");
    assert_string_equal(frame_text(&(model_frame){0.001, FRAME_Z, FRAME_BY_SCENE, FRAME_BY_FORMAT}, text),
                        "1 unit is 0.001 m: the scene file says so; z is up: its format has it so");
}

/* ---- files of strangers ---- */

static void cases_units(void **state) {
    model m;
    (void)state;
    (void)import_case("units/k_zup.fbx", &m);
    box_is(&m, 0, 0, 0, 0.01, 0.01, 0);
    model_free(&m);
    (void)import_case("units/k_mm.3mf", &m);
    box_is(&m, 0.005, 0, 0, 0.006, 0.001, 0);
    model_free(&m);
    (void)import_case("units/k_zcm.dae", &m);
    box_is(&m, 0, 0, 0, 0.01, 0.01, 0);
    model_free(&m);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        T(fbx_is_in_its_unit_and_on_its_axes),
        T(a_unit_or_axes_that_are_none_are_told),
        T(the_scene_file_beats_unit_and_axis),
        T(collada_is_in_its_unit_and_on_its_axis),
        T(white_space_in_collada_means_nothing),
        T(units_and_axes_of_collada_that_are_none_are_told),
        T(files_of_amf_are_in_their_unit),
        T(a_colour_of_amf_is_all_of_it),
        T(instances_of_amf_stand_where_they_should_or_are_refused),
        T(a_format_without_a_unit_is_metres_and_y_up_unless_the_scene_says),
        T(x3d_is_in_its_unit_and_y_is_up),
        T(frames_in_words),
        T(cases_units),
    };
    return cmocka_run_group_tests(tests, make_folder, NULL);
}
