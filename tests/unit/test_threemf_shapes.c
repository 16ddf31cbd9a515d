/* 3MF's shapes: archives in all forms, units, objects, components, the build, several model files, and files that are wrong.
 * Strategy: small files written here (threemf_lab.h), whose right values follow from the specifications: millimetres, z up and
 * transforms by rows make x, y, z of a file x, z, -y thousandths of ours. */
#define FOLDER VIT_BUILD_DIR "/tests/unit/threemf_shapes"
#include "threemf_lab.h"
#include <stdlib.h>

static void frame_is(const model *m, double unit, unsigned by) {
    const model_frame *f = &m->formats[0].frame;
    assert_true(fabs(f->unit - unit) < 1e-12 && f->up == FRAME_Z && f->unit_by == by && f->up_by == FRAME_BY_FORMAT);
}

#define SQUARE_MODEL(attributes) MODEL_OF(attributes, PLAIN_SQUARE(1), ITEM("objectid=\"1\""))

/* ---- archives ---- */

static void archives_of_every_form_are_read(void **state) {
    static const char text[] = SQUARE_MODEL("");
    const lab_part parts[] = {RELATION("/3D/3dmodel.model"), LAB_TEXT_PART("3D/3dmodel.model", text)};
    (void)state;
    for (int form = 0; form < 3; form++) {
        model m;
        if (form == 2)
            put_packed_archive(FILE_OF("t.3mf"), parts, 2);
        else
            put_archive(FILE_OF("t.3mf"), parts, 2, form == 1);
        import_good(FILE_OF("t.3mf"), &m);
        check_promises(&m);
        assert_int_equal(m.triangles, 2);
        box_is(&m, 0, 0, -0.01, 0.01, 0, 0);
        assert_string_equal(warnings, "");
        model_free(&m);
    }
}

static void the_relation_says_which_model(void **state) {
    static const char right[] = SQUARE_MODEL(""), wrong[] = MODEL_OF("unit=\"meter\"", PLAIN_SQUARE(1), ITEM("objectid=\"1\""));
    const lab_part rows[][3] = {
        {RELATION("/other/a.model"), LAB_TEXT_PART("other/a.model", right), LAB_TEXT_PART("3D/3dmodel.model", wrong)},
        {RELATION("Other/A.MODEL"), LAB_TEXT_PART("other/a.model", right), LAB_TEXT_PART("3D/3dmodel.model", wrong)},
        {LAB_TEXT_PART("x", ""), LAB_TEXT_PART("y", ""), LAB_TEXT_PART("3D/3dmodel.model", right)}};
    (void)state;
    for (size_t i = 0; i < 3; i++) {
        model m;
        put_archive(FILE_OF("t.3mf"), rows[i], 3, false);
        import_good(FILE_OF("t.3mf"), &m);
        box_is(&m, 0, 0, -0.01, 0.01, 0, 0);
        model_free(&m);
    }
}

static void an_archive_is_known_by_its_first_part(void **state) {
    static const char text[] = SQUARE_MODEL("");
    const lab_part parts[] = {RELATION("/3D/3dmodel.model"), LAB_TEXT_PART("3D/3dmodel.model", text)};
    model m;
    (void)state;
    put_archive(FILE_OF("t.stl"), parts, 2, false);
    import_good(FILE_OF("t.stl"), &m);
    frame_is(&m, 0.001, FRAME_BY_FORMAT);
    model_free(&m);
}

static void archives_that_are_wrong_are_refused(void **state) {
    static const char text[] = SQUARE_MODEL("");
    const lab_part parts[] = {RELATION("/3D/3dmodel.model"), LAB_TEXT_PART("3D/3dmodel.model", text)};
    (void)state;
    put(FILE_OF("t.3mf"), "solid a\nendsolid\n");
    refuse(FILE_OF("t.3mf"), false, "is no 3MF archive");
    put(FILE_OF("t.3mf"), "");
    refuse(FILE_OF("t.3mf"), false, "is empty");
    put_archive(FILE_OF("t.3mf"), parts, 1, false);
    refuse(FILE_OF("t.3mf"), false, "3D/3dmodel.model in the archive is missing");
    const lab_archive *a = make_archive(parts, 2, false);
    static uint8_t bytes[sizeof a->bytes];
    memcpy(bytes, a->bytes, a->size);
    put_bytes(FILE_OF("t.3mf"), bytes, a->size - 60);
    refuse(FILE_OF("t.3mf"), false, "is no 3MF archive");
    for (size_t i = 0; i + 8 < a->size; i++) /* another coordinate than the checksum's */
        if (memcmp(bytes + i, "x=\"10\"", 6) == 0)
            bytes[i + 3] = '2';
    put_bytes(FILE_OF("t.3mf"), bytes, a->size);
    refuse(FILE_OF("t.3mf"), false, "3D/3dmodel.model is damaged");
}

/* ---- units, numbers ---- */

static void files_are_in_their_unit_and_z_is_up(void **state) {
    static const struct {
        const char *text;
        double metres;
        unsigned by;
    } rows[] = {{SQUARE_MODEL(""), 0.001, FRAME_BY_FORMAT},
                {SQUARE_MODEL("unit=\"millimeter\""), 0.001, FRAME_BY_FILE},
                {SQUARE_MODEL("unit = 'inch'"), 0.0254, FRAME_BY_FILE},
                {SQUARE_MODEL("xml:lang=\"en-US\"\n unit=\"micron\""), 1e-6, FRAME_BY_FILE},
                {SQUARE_MODEL("unit=\"foot\""), 0.3048, FRAME_BY_FILE},
                {SQUARE_MODEL("unit=\"centimeter\""), 0.01, FRAME_BY_FILE},
                {SQUARE_MODEL("unit=\"meter\""), 1, FRAME_BY_FILE}};
    (void)state;
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        model m;
        import_3mf(rows[i].text, &m);
        box_is(&m, 0, 0, -10 * rows[i].metres, 10 * rows[i].metres, 0, 0);
        frame_is(&m, rows[i].metres, rows[i].by);
        normal_at(&m, 0, 0, 0, 0, 1, 0);
        model_free(&m);
    }
    put_3mf(SQUARE_MODEL("unit=\"cubit\""));
    refuse(FILE_OF("t.3mf"), false, "has unit 'cubit', which is none");
}

static void the_scene_file_beats_unit_and_axis(void **state) {
    vit_text why = {{0}};
    scene s;
    model m;
    (void)state;
    put_3mf(SQUARE_MODEL("unit=\"inch\""));
    put(FILE_OF("m.cfg"), "meshes = ( { file = \"t.3mf\"; units = 0.5; up = \"y\"; } );\n"
                          "camera: { keys = ( { eye = (0, 1, 3); target = (0, 1, 0); } ); };\n");
    assert_int_equal(scene_read(FILE_OF("m.cfg"), &s, &why), VIT_OK);
    assert_int_equal(model_import(&s, MODEL_WARNS, remember, NULL, &m, &why), VIT_OK);
    box_is(&m, 0, 0, 0, 5, 5, 0);
    model_free(&m);
    scene_free(&s);
}

static void numbers_are_those_of_xml(void **state) {
    static const char text[] = MODEL_OF("unit=\"meter\"",
                                        OBJECT("id=\" 7 \"", MESH(VERTEX(1e1, -.5, +3) VERTEX(2.5E-1, 0, 0) VERTEX(0, 4, 0),
                                                                  "<triangle v1=\" 0\" v2=\"1 \" v3=\"+2\"/>")),
                                        ITEM("objectid=\"7\" transform=\" 1 0 0\n0 1 0 0 0 1 0 0 1e0 \""));
    model m;
    (void)state;
    import_3mf(text, &m);
    box_is(&m, 0, 1, -4, 10, 4, 0.5);
    model_free(&m);
}

/* ---- the build ---- */

/* (x, y, z, 1) times the matrix of rows (0 1 0) (-1 0 0) (0 0 2) (5 6 7): x' = -y + 5, y' = x + 6, z' = 2 z + 7. */
static void transforms_stand_behind_a_row(void **state) {
    model m;
    (void)state;
    import_3mf(MODEL_OF("unit=\"meter\"",
                        OBJECT("id=\"1\"", MESH(VERTEX(1, 2, 3) VERTEX(4, 2, 3) VERTEX(1, 2, 5), TRIANGLE(0, 1, 2, ""))),
                        ITEM("objectid=\"1\" transform=\"0 1 0 -1 0 0 0 0 2 5 6 7\"")),
               &m);
    box_is(&m, 3, 13, -10, 3, 17, -7);
    model_free(&m);
}

/* Objects within objects: the innermost transform first. Twice the component at x = 1 and 21, doubled and 100 further on. */
static void components_are_placed_by_all_above_them(void **state) {
    model m;
    (void)state;
    import_3mf(MODEL_OF("unit=\"meter\"",
                        PLAIN_SQUARE(1) OBJECT("id=\"2\"", "<components><component objectid=\"1\" "
                                                           "transform=\"1 0 0 0 1 0 0 0 1 1 0 0\"/><component objectid=\"1\" "
                                                           "transform=\"1 0 0 0 1 0 0 0 1 21 0 0\"/></components>")
                            OBJECT("id=\"3\"", "<components><component objectid=\"2\" "
                                               "transform=\"2 0 0 0 2 0 0 0 2 0 0 0\"/></components>"),
                        ITEM("objectid=\"3\" transform=\"1 0 0 0 1 0 0 0 1 100 0 0\"") ITEM("objectid=\"1\"")),
               &m);
    assert_int_equal(m.triangles, 6);
    box_is(&m, 0, 0, -20, 162, 0, 0);
    (void)vertex_at(&m, 102, 0, 0);
    (void)vertex_at(&m, 142, 0, -20);
    assert_int_equal(m.meshes[0].places, 3);
    assert_string_equal(m.meshes[0].name, "object 1");
    model_free(&m);
}

static void objects_that_nothing_builds_are_not_there(void **state) {
    model m;
    (void)state;
    import_3mf(MODEL_OF("",
                        PLAIN_SQUARE(1) OBJECT("id=\"2\" name=\"far\"",
                                               MESH(VERTEX(0, 0, 0) VERTEX(99, 0, 0) VERTEX(0, 99, 0), TRIANGLE(0, 1, 2, ""))),
                        ITEM("objectid=\"1\"")),
               &m);
    assert_true(m.triangles == 2 && m.mesh_count == 1);
    model_free(&m);
}

static void what_is_not_to_be_printed_is_left_out_and_said(void **state) {
    static const char *const types[] = {"support", "solidsupport", "other"};
    model m;
    (void)state;
    put_3mf(MODEL_OF("", PLAIN_SQUARE(1) OBJECT("id=\"2\" type=\"surface\"", SQUARE_MESH("", "")),
                     ITEM("objectid=\"1\" printable=\"0\"") ITEM("objectid=\"2\" printable=\"1\"")));
    import_good(FILE_OF("t.3mf"), &m);
    assert_int_equal(m.triangles, 2);
    assert_non_null(strstr(warnings, "1 items of the build that are not to be printed are left out"));
    model_free(&m);
    refuse(FILE_OF("t.3mf"), true, "1 items of the build");
    for (size_t i = 0; i < 3; i++) {
        char text[4096];
        (void)snprintf(
            text, sizeof text,
            MODEL_OF("",
                     PLAIN_SQUARE(1) "<object id=\"2\" type=\"%s\">" SQUARE_MESH("", "") "</object>" OBJECT(
                         "id=\"3\"", "<components><component objectid=\"2\"/><component objectid=\"1\"/></components>"),
                     ITEM("objectid=\"3\"") ITEM("objectid=\"2\"")),
            types[i]);
        put_3mf(text);
        import_good(FILE_OF("t.3mf"), &m);
        assert_int_equal(m.triangles, 2);
        assert_non_null(strstr(warnings, "2 objects that are supports or of type 'other' are left out"));
        model_free(&m);
        refuse(FILE_OF("t.3mf"), true, "2 objects that are supports");
    }
}

/* trimesh 5.2.0 writes items for nodes that have no mesh. */
static void items_without_an_object_are_left_out_and_said(void **state) {
    model m;
    (void)state;
    put_3mf(MODEL_OF("", PLAIN_SQUARE(1) "<basematerials id=\"3\"/>",
                     ITEM("objectid=\"2\"") ITEM("objectid=\"1\"") ITEM("objectid=\"3\"")));
    import_good(FILE_OF("t.3mf"), &m);
    assert_int_equal(m.triangles, 2);
    assert_non_null(strstr(warnings, "2 items and components lead to no object (2 is the first): they are left out"));
    model_free(&m);
    refuse(FILE_OF("t.3mf"), true, "2 items and components lead to no object");
}

static void objects_do_not_go_round(void **state) {
    (void)state;
    put_3mf(MODEL_OF("",
                     OBJECT("id=\"1\"", "<components><component objectid=\"2\"/></components>")
                         OBJECT("id=\"2\"", "<components><component objectid=\"1\"/></components>"),
                     ITEM("objectid=\"1\"")));
    refuse(FILE_OF("t.3mf"), false, "object 1 is a component of itself");
}

/* A chain of `levels` objects, each of which has `width` times the next. */
static void put_chain(int levels, int width) {
    static char text[1 << 16];
    size_t used = (size_t)snprintf(text, sizeof text, "<model " CORE_NS "><resources>" PLAIN_SQUARE(1));
    for (int i = 2; i <= levels; i++) {
        used += (size_t)snprintf(text + used, sizeof text - used, "<object id=\"%d\"><components>", i);
        for (int k = 0; k < width; k++)
            used += (size_t)snprintf(text + used, sizeof text - used, "<component objectid=\"%d\"/>", i - 1);
        used += (size_t)snprintf(text + used, sizeof text - used, "</components></object>");
    }
    (void)snprintf(text + used, sizeof text - used, "</resources><build><item objectid=\"%d\"/></build></model>", levels);
    put_3mf(text);
}

static void components_are_bounded(void **state) {
    model m;
    (void)state;
    put_chain(200, 1);
    import_good(FILE_OF("t.3mf"), &m);
    assert_int_equal(m.triangles, 2);
    model_free(&m);
    put_chain(300, 1);
    refuse(FILE_OF("t.3mf"), false, "components are nested too deeply");
    put_chain(40, 2);
    refuse(FILE_OF("t.3mf"), false, "components make more than 1048576 places");
}

/* ---- several model files ---- */

static void objects_of_other_model_files_are_found(void **state) {
    static const char other[] = "<model unit=\"centimeter\" " CORE_NS "><resources>" PLAIN_SQUARE(
        1) "<object id=\"2\"><components><component "
           "objectid=\"1\" transform=\"1 0 0 0 1 0 0 0 1 0 0 1\"/></components></object></resources><build><item "
           "objectid=\"1\"/></build></model>";
    const lab_part more = LAB_TEXT_PART("3D/other.model", other);
    model m;
    (void)state;
    /* Object 1 here is another one than there. */
    put_3mf_with(MODEL_OF("requiredextensions=\"p m\" unit=\"meter\"",
                          PLAIN_SQUARE(1) OBJECT("id=\"5\" p:UUID=\"x\"",
                                                 "<components><component p:path=\"/3D/other.model\" objectid=\"2\" "
                                                 "transform=\"1 0 0 0 1 0 0 0 1 0 0 3\"/></components>"),
                          ITEM("objectid=\"5\" p:UUID=\"y\"")
                              ITEM("objectid=\"1\" p:path=\"/3d/OTHER.model\" transform=\"1 0 0 0 1 0 0 0 1 20 0 0\"")),
                 &more, 1);
    import_good(FILE_OF("t.3mf"), &m);
    assert_string_equal(warnings, "");
    assert_int_equal(m.triangles, 4);
    (void)vertex_at(&m, 0.1f, 3.01f, -0.1f);
    (void)vertex_at(&m, 20.1f, 0, -0.1f);
    box_is(&m, 0, 0, -0.1, (double)20.1f, (double)3.01f, 0);
    assert_true(m.extension_count == 2 && m.extensions[0].required && m.extensions[0].read && m.extensions[1].required);
    assert_string_equal(m.extensions[0].name, "production");
    assert_string_equal(m.extensions[1].name, "materials and properties");
    model_free(&m);
    put_3mf_with(MODEL_OF("", "", ITEM("objectid=\"1\" p:path=\"/3D/none.model\"")), &more, 1);
    refuse(FILE_OF("t.3mf"), false, "3D/none.model in the archive is missing");
    put_3mf_with(MODEL_OF("", "", ITEM("objectid=\"9\" p:path=\"/3D/other.model\"")), &more, 1);
    refuse(FILE_OF("t.3mf"), true, "1 items and components lead to no object (9 is the first)");
}

/* ---- extensions ---- */

static void required_extensions_that_are_not_read_are_refused(void **state) {
    vit_text why = {{0}};
    scene s;
    model m;
    (void)state;
    put_3mf(SQUARE_MODEL("xmlns:s=\"http://schemas.microsoft.com/3dmanufacturing/slice/2015/07\" requiredextensions=\"m s\""));
    refuse(FILE_OF("t.3mf"), false, "extension 'slice' is required and not read");
    assert_int_equal(scene_for_mesh(FILE_OF("t.3mf"), &s, &why), VIT_OK);
    assert_int_equal(model_import(&s, MODEL_LISTS, remember, NULL, &m, &why), VIT_OK);
    assert_true(m.extension_count == 2 && m.extensions[1].required && !m.extensions[1].read && m.triangles == 2);
    assert_string_equal(m.extensions[1].name, "slice");
    model_free(&m);
    scene_free(&s);
    put_3mf(SQUARE_MODEL("xmlns:z=\"http://example.org/z\" requiredextensions=\"z\""));
    refuse(FILE_OF("t.3mf"), false, "extension 'http://example.org/z' is required and not read");
    put_3mf(SQUARE_MODEL("requiredextensions=\"q\""));
    refuse(FILE_OF("t.3mf"), false, "requires an extension 'q' that has no namespace");
    import_3mf(
        SQUARE_MODEL("xmlns:t=\"http://schemas.microsoft.com/3dmanufacturing/trianglesets/2021/07\" requiredextensions=\"t\""),
        &m);
    model_free(&m);
}

static void what_is_left_out_is_said(void **state) {
    static const char beams[] = MODEL_OF(
        "xmlns:b=\"http://schemas.microsoft.com/3dmanufacturing/beamlattice/2017/02\" "
        "xmlns:t=\"http://schemas.microsoft.com/3dmanufacturing/trianglesets/2021/07\"",
        OBJECT("id=\"1\"", "<metadatagroup><metadata name=\"a\">b</metadata></metadatagroup><metadata name=\"c\"/>"
                           "<mesh><vertices>" SQUARE "</vertices><triangles>" TRIANGLE(0, 1, 2, "paint_color=\"4\"")
                               TRIANGLE(0, 2, 3, "paint_color=\"8\"") "</triangles><t:trianglesets><t:triangleset name=\"a\"/>"
                                                                      "</t:trianglesets><b:beamlattice><b:beams><b:beam "
                                                                      "v1=\"0\" v2=\"1\"/></b:beams></b:beamlattice></mesh>"),
        ITEM("objectid=\"1\""));
    model m;
    (void)state;
    put_3mf(beams);
    import_good(FILE_OF("t.3mf"), &m);
    assert_int_equal(m.triangles, 2);
    assert_non_null(strstr(warnings, "element 'beamlattice' of the extension 'beam lattice' is left out"));
    assert_non_null(strstr(warnings, "attribute 'paint_color' of triangles is left out"));
    assert_int_equal(m.warnings, 2);
    assert_true(m.extension_count == 2 && !m.extensions[1].read && !m.extensions[1].required);
    model_free(&m);
    refuse(FILE_OF("t.3mf"), true, "is left out");
}

/* ---- wrong ---- */

static void triangles_that_are_wrong_are_dropped_and_counted(void **state) {
    model m;
    (void)state;
    put_3mf(MODEL_OF("",
                     OBJECT("id=\"1\"", MESH(SQUARE VERTEX(nan, 0, 0), TRIANGLE(0, 1, 2, "") TRIANGLE(0, 1, 9, "")
                                                                           TRIANGLE(1, 1, 2, "") TRIANGLE(0, 1, 4, ""))),
                     ITEM("objectid=\"1\"")));
    import_good(FILE_OF("t.3mf"), &m);
    assert_true(m.triangles == 1 && m.degenerate == 1 && m.not_finite == 1);
    assert_non_null(strstr(warnings, "1 triangles with an index out of range dropped"));
    model_free(&m);
}

static void models_that_are_wrong_are_refused_with_their_line(void **state) {
    static const struct {
        const char *text, *what;
    } rows[] = {
        {"<model " CORE_NS ">\n<resources>\n<object id=\"1\"></objec>", "3D/3dmodel.model:3: is no well-formed XML: "},
        {"", "3D/3dmodel.model:1: is no well-formed XML: "},
        {"<a/>", "3D/3dmodel.model:1: <a> is no <model> of 3MF"},
        {"<q:model/>", "3D/3dmodel.model:1: <model> is no <model> of 3MF"},
        {"<!DOCTYPE model [<!ENTITY a \"aaaa\"><!ENTITY b \"&a;&a;\">]>\n<model " CORE_NS "/>",
         "has a document type, which 3MF forbids"},
        {MODEL_OF("", OBJECT("", SQUARE_MESH("", "")), ""), ":2: <object> has no id"},
        {MODEL_OF("", OBJECT("id=\"-1\"", ""), ""), "id '-1' of <object> is no index"},
        {MODEL_OF("", OBJECT("id=\"2147483648\"", ""), ""), "id '2147483648' of <object> is no index"},
        {MODEL_OF("", OBJECT("id=\"1\" type=\"ball\"", ""), ""), "type 'ball' of object 1 is none"},
        {MODEL_OF("", PLAIN_SQUARE(1) PLAIN_SQUARE(1), ""), "has several resources of id 1"},
        {MODEL_OF("", OBJECT("id=\"1\"", MESH("<vertex x=\"1\" y=\"0\"/>", "")), ""), "a vertex has no z"},
        {MODEL_OF("", OBJECT("id=\"1\"", MESH(VERTEX(1, 0x10, 0), "")), ""), "y '0x10' of a vertex is no number"},
        {MODEL_OF("", OBJECT("id=\"1\"", MESH(SQUARE, "<triangle v1=\"0\" v2=\"1\"/>")), ""), "a triangle has no v3"},
        {MODEL_OF("", OBJECT("id=\"1\"", MESH(SQUARE, TRIANGLE(0, 1, 1.5, ""))), ""), "v3 '1.5' of a triangle is no index"},
        {MODEL_OF("", PLAIN_SQUARE(1), ITEM("objectid=\"2\"")), "has no triangle"},
        {MODEL_OF("", PLAIN_SQUARE(1), ITEM("")), "<item> has no objectid"},
        {MODEL_OF("", PLAIN_SQUARE(1), ITEM("objectid=\"1\" transform=\"1 0 0 0 1 0 0 0 1 0 0\"")), "has not 12 numbers"},
        {MODEL_OF("", PLAIN_SQUARE(1), ITEM("objectid=\"1\" transform=\"1 0 0 0 1 0 0 0 1 0 0 0 0\"")),
         "has more than 12 numbers"},
        {MODEL_OF("", PLAIN_SQUARE(1), ""), "has no triangle"},
    };
    (void)state;
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        put_3mf(rows[i].text);
        refuse(FILE_OF("t.3mf"), false, rows[i].what);
    }
}

/* Packed, a megabyte of nothing is a kilobyte. */
static void markup_without_end_is_refused(void **state) {
    enum { LONG = 12 << 20 };
    char *text = malloc(LONG);
    (void)state;
    assert_non_null(text);
    memset(text, 'a', LONG);
    memcpy(text, "<model a=\"", 10);
    const lab_part parts[] = {RELATION("/3D/3dmodel.model"), {"3D/3dmodel.model", text, LONG}};
    put_packed_archive(FILE_OF("t.3mf"), parts, 2);
    refuse(FILE_OF("t.3mf"), false, "3D/3dmodel.model:1: is no well-formed XML: ");
    for (size_t i = 0; i < LONG; i += 4)
        memcpy(text + i, "<a> ", 4);
    memcpy(text, "<model " CORE_NS ">", strlen("<model " CORE_NS ">"));
    const size_t begun = (strlen("<model " CORE_NS ">") + 3) / 4 * 4;
    memset(text + strlen("<model " CORE_NS ">"), ' ', begun - strlen("<model " CORE_NS ">"));
    put_packed_archive(FILE_OF("t.3mf"), parts, 2);
    refuse(FILE_OF("t.3mf"), false, "elements are nested deeper than 256");
    free(text);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        T(archives_of_every_form_are_read),
        T(the_relation_says_which_model),
        T(an_archive_is_known_by_its_first_part),
        T(archives_that_are_wrong_are_refused),
        T(files_are_in_their_unit_and_z_is_up),
        T(the_scene_file_beats_unit_and_axis),
        T(numbers_are_those_of_xml),
        T(transforms_stand_behind_a_row),
        T(components_are_placed_by_all_above_them),
        T(objects_that_nothing_builds_are_not_there),
        T(what_is_not_to_be_printed_is_left_out_and_said),
        T(items_without_an_object_are_left_out_and_said),
        T(objects_do_not_go_round),
        T(components_are_bounded),
        T(objects_of_other_model_files_are_found),
        T(required_extensions_that_are_not_read_are_refused),
        T(what_is_left_out_is_said),
        T(triangles_that_are_wrong_are_dropped_and_counted),
        T(models_that_are_wrong_are_refused_with_their_line),
        T(markup_without_end_is_refused),
    };
    return cmocka_run_group_tests(tests, make_folder, NULL);
}
