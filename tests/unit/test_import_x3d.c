/* X3D, of which Assimp leaves much aside without a word or takes it for something else: what is read is right by X3D 3.3, and
 * what is not is said. */
#define FOLDER VIT_BUILD_DIR "/tests/unit/import_x3d"
#include "case_model.h"

#define SHAPE(looks, what) "<Shape>" looks what "</Shape>"
#define RED "<Appearance><Material diffuseColor=\"1 0 0\"/></Appearance>"
#define FACE                                                                                                                   \
    "<IndexedFaceSet coordIndex=\"0 1 2 -1\" texCoordIndex=\"0 1 2 -1\"><Coordinate point=\"0 0 0 1 0 0 0 1 0\"/>"             \
    "<TextureCoordinate point=\"0 0 1 0 0 1\"/></IndexedFaceSet>"

static void put_x3d(const char *name, const char *content) {
    char text[2048];
    (void)snprintf(text, sizeof text, "<?xml version=\"1.0\"?><X3D version=\"3.3\"><!-- <Anchor> --><Scene>%s</Scene></X3D>",
                   content);
    put(name, text);
}

/* What is in it, and what is said, an error if strict; NULL: nothing. */
static void import_x3d(const char *content, const char *said, model *m) {
    put_x3d(FILE_OF("t.x3d"), content);
    import_good(FILE_OF("t.x3d"), m);
    check_promises(m);
    if (said ? !strstr(warnings, said) : warnings[0] != '\0')
        fail_msg("'%s' is not '%s'", warnings, said ? said : "");
    if (said)
        refuse(FILE_OF("t.x3d"), true, said);
}

static void pictures_are_found_in_lists_of_names(void **state) {
    static const char *const urls[] = {"url='\"image.tga\"'",
                                       "url='\"image.tga\" \"http://nowhere/image.tga\"'",
                                       "url = '\"none.tga\", \"image.tga\"' repeatS='false'",
                                       "url=\"&quot;none.tga&quot; &quot;image.tga&quot;\"",
                                       "url=\"image.tga\"",
                                       "url=\"'image.tga'\""};
    (void)state;
    put_image(FILE_OF("image.tga"), 255);
    for (size_t i = 0; i < sizeof urls / sizeof *urls; i++) {
        char content[1024];
        model m;
        (void)snprintf(content, sizeof content,
                       SHAPE("<Appearance><ImageTexture %s/><Material diffuseColor=\"1 0 0\"/></Appearance>", FACE), urls[i]);
        import_x3d(content, NULL, &m);
        /* A picture stands in for the colour (17.2.2.3). */
        assert_true(m.materials[0].image == 0 && near3(m.materials[0].albedo, 1, 1, 1));
        assert_int_equal(m.materials[0].wrap_u, i == 2 ? VIT_WRAP_CLAMP : VIT_WRAP_REPEAT);
        assert_int_equal(m.materials[0].wrap_v, VIT_WRAP_REPEAT);
        model_free(&m);
    }
}

static void a_picture_that_is_missing_is_called_by_its_first_name(void **state) {
    model m;
    (void)state;
    import_x3d(
        SHAPE("<Appearance><ImageTexture url='\"first.tga\" \"second.tga\"'/><Material diffuseColor=\"1 0 0\"/></Appearance>",
              FACE),
        "texture 'first.tga' is missing", &m);
    assert_true(m.materials[0].image == -1 && near3(m.materials[0].albedo, 1, 0, 0));
    model_free(&m);
}

static void parts_in_other_files_are_there(void **state) {
    model m;
    (void)state;
    put_x3d(FILE_OF("part.x3d"), SHAPE(RED, FACE));
    import_x3d("<Transform translation=\"5 0 0\"><Inline url='\"part.x3d\"'/></Transform>" SHAPE(RED, FACE), NULL, &m);
    assert_int_equal(m.triangles, 2);
    box_is(&m, 0, 0, 0, 6, 1, 0);
    model_free(&m);
}

static void a_shape_without_an_appearance_is_not_the_first_ones_colour(void **state) {
    model m;
    (void)state;
    import_x3d(SHAPE(RED, FACE) SHAPE("", FACE) "<Shape DEF='s'>" FACE "</Shape>", NULL, &m);
    assert_int_equal(m.triangles, 3);
    assert_true(near3(m.materials[m.material[0]].albedo, 1, 0, 0));
    for (int i = 1; i < 3; i++)
        assert_true(near3(m.materials[m.material[i]].albedo, 0.8, 0.8, 0.8));
    model_free(&m);
}

static void colours_of_vertices_stand_in_for_the_materials(void **state) {
    model m;
    (void)state;
    import_x3d(SHAPE("<Appearance><Material diffuseColor=\"0.5 0.5 0.5\"/></Appearance>",
                     "<IndexedFaceSet coordIndex=\"0 1 2 -1\"><Coordinate point=\"0 0 0 1 0 0 0 1 0\"/>"
                     "<Color color=\"0 1 0.25 0 1 0.25 0 1 0.25\"/></IndexedFaceSet>"),
               NULL, &m);
    assert_true(near3(m.materials[0].albedo, 0, 1, 0.25));
    model_free(&m);
}

/* Assimp makes faces of them. */
static void lines_are_no_faces(void **state) {
    model m;
    (void)state;
    import_x3d(SHAPE(RED, FACE) SHAPE(RED, "<IndexedLineSet coordIndex=\"0 1 2 -1\"><Coordinate point=\"0 0 0 9 0 0 0 9 0\"/>"
                                           "</IndexedLineSet>") SHAPE("", "<Circle2D radius=\"7\"/>"),
               "elements 'IndexedLineSet', 'Circle2D' are left out", &m);
    assert_int_equal(m.triangles, 1);
    box_is(&m, 0, 0, 0, 1, 1, 0);
    model_free(&m);
}

static void elements_that_are_not_known_are_said(void **state) {
    model m;
    (void)state;
    import_x3d(
        "<WorldInfo title=\"t\"/><NavigationInfo/><TimeSensor/><PositionInterpolator/><MetadataString/>" SHAPE(RED, FACE), NULL,
        &m);
    model_free(&m);
    import_x3d("<LOD>" SHAPE(RED, "<Box/>") "</LOD><LOD/>" SHAPE(RED, FACE),
               "elements 'LOD' are left out, with all that is in them", &m);
    assert_int_equal(m.triangles, 1);
    model_free(&m);
    import_x3d("<Viewpoint/><Anchor/><Background/><Fog/><Script/>" SHAPE(RED, FACE),
               "elements 'Viewpoint', 'Anchor', 'Background', 'Fog' and others are left out", &m);
    model_free(&m);
}

/* Names that only begin like a shape's have no room for what a shape gets. */
static void elements_whose_names_begin_alike_are_others(void **state) {
    model m;
    (void)state;
    import_x3d("<Anchor><Shape.a></Shape.a><Shape-a></Shape-a><Shape:a></Shape:a></Anchor>" SHAPE(RED, FACE),
               "elements 'Anchor', 'Shape.a', 'Shape-a', 'Shape:a' are left out", &m);
    assert_int_equal(m.triangles, 1);
    model_free(&m);
}

static void lights_without_a_name_are_called_the_same_each_time(void **state) {
    model m;
    (void)state;
    import_x3d("<PointLight location=\"0 2 0\"/><SpotLight DEF='Light_1b'/>" SHAPE(RED, FACE), NULL, &m);
    assert_non_null(model_light_named(&m, "PointLight"));
    assert_non_null(model_light_named(&m, "Light_1b"));
    model_free(&m);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        T(pictures_are_found_in_lists_of_names),
        T(a_picture_that_is_missing_is_called_by_its_first_name),
        T(parts_in_other_files_are_there),
        T(a_shape_without_an_appearance_is_not_the_first_ones_colour),
        T(colours_of_vertices_stand_in_for_the_materials),
        T(lines_are_no_faces),
        T(elements_that_are_not_known_are_said),
        T(elements_whose_names_begin_alike_are_others),
        T(lights_without_a_name_are_called_the_same_each_time),
    };
    return cmocka_run_group_tests(tests, make_folder, NULL);
}
