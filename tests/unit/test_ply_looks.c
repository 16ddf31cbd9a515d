/* What PLY says of looks: colours of vertices and faces, textures by number and corner by corner, and what of it is not done.
 * Strategy: as test_ply_shapes.c; colours against the sRGB curve written out here. */
#define FOLDER VIT_BUILD_DIR "/tests/unit/ply_looks"
#include "ply_lab.h"

static double from_srgb(double c) {
    return c <= 0.04045 ? c / 12.92 : pow((c + 0.055) / 1.055, 2.4);
}

/* The square whose vertices all have this colour. */
static void import_colored(const char *type, const char *r, const char *g, const char *b, const char *values, model *m) {
    char header[512], body[256];
    (void)snprintf(header, sizeof header, "element vertex 4\n" XYZ "property %s %s\nproperty %s %s\nproperty %s %s\n" TWO_FACES,
                   type, r, type, g, type, b);
    (void)snprintf(body, sizeof body, "0 0 0 %s\n1 0 0 %s\n1 1 0 %s\n0 1 0 %s\n" TWO_TRIANGLES, values, values, values, values);
    import_all_encodings(header, body, m);
    quad_is(m);
    assert_int_equal(m->material_count, 1);
}

static void integers_are_srgb_and_floats_linear(void **state) {
    static const char *const bytes[] = {"uchar", "uint8", "int", "uint", "short"};
    static const char *const names[][3] = {
        {"red", "green", "blue"}, {"diffuse_red", "diffuse_green", "diffuse_blue"}, {"r", "g", "b"}};
    model m;
    (void)state;
    for (size_t i = 0; i < sizeof bytes / sizeof *bytes; i++) {
        import_colored(bytes[i], "red", "green", "blue", "128 10 255", &m);
        assert_true(near3(m.materials[0].albedo, from_srgb(128 / 255.0), from_srgb(10 / 255.0), 1.0));
        assert_string_equal(warnings, "");
        model_free(&m);
    }
    for (size_t i = 0; i < 3; i++) {
        import_colored("float", names[i][0], names[i][1], names[i][2], "0.5 0.25 1", &m);
        assert_true(near3(m.materials[0].albedo, 0.5, 0.25, 1.0));
        model_free(&m);
    }
    import_colored("ushort", "red", "green", "blue", "32768 0 65535", &m);
    assert_true(near3(m.materials[0].albedo, from_srgb(32768 / 65535.0), 0.0, 1.0));
    model_free(&m);
    import_colored("double", "red", "green", "blue", "2 -1 0.125", &m);
    assert_true(near3(m.materials[0].albedo, 1.0, 0.0, 0.125));
    model_free(&m);
}

static void a_file_without_colours_is_white(void **state) {
    model m;
    (void)state;
    import_all_encodings(QUAD_VERTICES TWO_FACES, QUAD_POINTS TWO_TRIANGLES, &m);
    assert_true(near3(m.materials[0].albedo, 1, 1, 1) && is_matt(&m.materials[0]));
    assert_string_equal(m.materials[0].name, "default");
    assert_string_equal(m.meshes[0].name, "a");
    model_free(&m);
}

#define RGB "property uchar red\nproperty uchar green\nproperty uchar blue\n"

static void colours_that_vary_and_alpha_are_said(void **state) {
    model m;
    (void)state;
    import_all_encodings("element vertex 4\n" XYZ RGB "property uchar alpha\n" TWO_FACES,
                         "0 0 0 1 2 3 255\n1 0 0 1 2 3 255\n1 1 0 1 2 3 254\n0 1 0 1 2 4 255\n" TWO_TRIANGLES, &m);
    quad_is(&m);
    assert_true(near3(m.materials[0].albedo, 1, 1, 1));
    assert_string_equal(warnings, FILE_OF("a.ply") ": alpha of vertices and faces is left out\n" FILE_OF(
                                      "a.ply") ": vertex colours that vary over a mesh are left out\n");
    model_free(&m);
    refuse(FILE_OF("a.ply"), true, "alpha of vertices and faces is left out");
    import_all_encodings("element vertex 4\n" XYZ RGB TWO_FACES,
                         "0 0 0 1 2 3\n1 0 0 1 2 3\n1 1 0 1 2 3\n0 1 0 1 2 4\n" TWO_TRIANGLES, &m);
    model_free(&m);
    refuse(FILE_OF("a.ply"), true, "vertex colours that vary over a mesh are left out");
}

static void colours_of_faces_become_materials(void **state) {
    model m;
    (void)state;
    import_all_encodings("element vertex 4\n" XYZ RGB "element face 4\n" INDICES RGB "property uchar alpha\n",
                         "0 0 0 9 9 9\n1 0 0 9 9 9\n1 1 0 9 9 9\n0 1 0 9 9 9\n"
                         "3 0 1 2 255 0 0 255\n3 0 2 3 0 128 0 255\n3 1 2 3 255 0 0 255\n4 0 1 2 3 0 128 0 255\n",
                         &m);
    check_promises(&m);
    assert_int_equal(m.material_count, 2);
    assert_true(m.materials[0].triangles == 2 && near3(m.materials[0].albedo, 1, 0, 0));
    assert_true(m.materials[1].triangles == 3 && near3(m.materials[1].albedo, 0, from_srgb(128 / 255.0), 0));
    assert_string_equal(warnings, "");
    model_free(&m);
}

static void more_than_256_colours_of_faces_are_left_out(void **state) {
    static char body[1 << 15];
    (void)state;
    for (int faces = 256; faces <= 257; faces++) {
        char header[512];
        model m;
        int used = snprintf(body, sizeof body, QUAD_POINTS);
        (void)snprintf(header, sizeof header, QUAD_VERTICES "element face %d\n" INDICES RGB, faces);
        for (int i = 0; i < faces; i++)
            used += snprintf(body + used, sizeof body - (size_t)used, "3 0 1 2 %d %d 7\n", i % 256, i / 256);
        put_ply(FILE_OF("many.ply"), LAB_LITTLE, header, body);
        import_good(FILE_OF("many.ply"), &m);
        check_promises(&m);
        assert_int_equal(m.material_count, faces == 256 ? 256 : 1);
        assert_true((strstr(warnings, "colours of faces, of which there are more than 256, are left out") != NULL) ==
                    (faces > 256));
        model_free(&m);
    }
}

/* ---- textures ---- */

static void coordinates_of_vertices_have_many_names(void **state) {
    static const char *const names[][2] = {{"s", "t"}, {"u", "v"}, {"texture_u", "texture_v"}, {"texture_s", "texture_t"}};
    (void)state;
    put_image(FILE_OF("my wood.tga"), 255);
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        char header[512];
        model m;
        (void)snprintf(header, sizeof header,
                       "comment TextureFile my wood.tga\nelement vertex 4\n" XYZ
                       "property float %s\nproperty float %s\n" TWO_FACES,
                       names[i][0], names[i][1]);
        import_all_encodings(header, "0 0 0 0 0\n1 0 0 1 0\n1 1 0 1 0.75\n0 1 0 0 0.75\n" TWO_TRIANGLES, &m);
        quad_is(&m);
        assert_int_equal(m.image_count, 1);
        assert_string_equal(m.materials[0].name, "my wood.tga");
        uv_at(&m, 0, 0, 0, 1); /* v goes up */
        uv_at(&m, 1, 1, 1, 0.25f);
        assert_string_equal(warnings, "");
        model_free(&m);
    }
}

static void a_texture_that_is_missing_is_a_warning(void **state) {
    model m;
    (void)state;
    import_all_encodings("comment TextureFile C:\\work\\none.png\n" QUAD_VERTICES TWO_FACES, QUAD_POINTS TWO_TRIANGLES, &m);
    quad_is(&m);
    assert_non_null(strstr(warnings, "texture 'C:\\work\\none.png' is missing"));
    model_free(&m);
    refuse(FILE_OF("a.ply"), true, "is missing");
}

/* As MeshLab writes them: a vertex on a seam has other coordinates in each face. */
#define WEDGES "element face 2\n" INDICES "property list uchar float texcoord\nproperty int texnumber\n"
static void coordinates_of_corners_split_vertices(void **state) {
    model m;
    (void)state;
    put_image(FILE_OF("image.tga"), 255);
    import_all_encodings("comment TextureFile image.tga\nelement vertex 4\n" XYZ
                         "property float nx\nproperty float ny\nproperty float nz\n" WEDGES,
                         "0 0 0 0 0 1\n1 0 0 0 0 1\n1 1 0 0 0 1\n0 1 0 0 0 1\n"
                         "3 0 1 2 6 0 0 1 0 1 1 0\n3 0 2 3 6 0 0 0.5 0.25 0 1 0\n",
                         &m);
    quad_is(&m);
    assert_int_equal(m.vertices, 5); /* corner (1, 1) twice */
    uv_at(&m, 0, 0, 0, 1);
    uv_at(&m, 0, 1, 0, 0);
    bool first = false, second = false;
    for (size_t i = 0; i < m.vertices; i++) {
        const float *p = m.position + 3 * i, *uv = m.uv + 2 * i;
        first = first || (p[0] == 1 && p[1] == 1 && uv[0] == 1 && uv[1] == 0);
        second = second || (p[0] == 1 && p[1] == 1 && uv[0] == 0.5f && uv[1] == 0.75f);
    }
    assert_true(first && second);
    model_free(&m);
}

static void textures_go_by_their_number(void **state) {
    model m;
    (void)state;
    put_image(FILE_OF("image.tga"), 255);
    put_image(FILE_OF("other.tga"), 200);
    import_all_encodings("comment TextureFile image.tga\ncomment texturefile other.tga\nelement vertex 4\n" XYZ RGB
                         "element face 3\n" INDICES "property list uchar float texcoord\nproperty int texnumber\n",
                         "0 0 0 9 9 9\n1 0 0 9 9 9\n1 1 0 9 9 9\n0 1 0 9 9 9\n3 0 1 2 6 0 0 1 0 1 1 1\n"
                         "4 0 1 2 3 8 0 0 1 0 1 1 0 1 0\n3 0 2 3 0 -1\n",
                         &m);
    check_promises(&m);
    assert_int_equal(m.material_count, 3);
    assert_true(m.materials[0].triangles == 2 && m.materials[1].triangles == 1 && m.materials[2].triangles == 1);
    assert_true(m.materials[0].image == 0 && m.materials[1].image == 1 && m.materials[2].image == -1);
    assert_string_equal(m.materials[0].name, "image.tga");
    assert_string_equal(m.materials[1].name, "other.tga");
    assert_true(near3(m.materials[0].albedo, 1, 1, 1)); /* a texture goes before colours */
    assert_true(near3(m.materials[2].albedo, from_srgb(9 / 255.0), from_srgb(9 / 255.0), from_srgb(9 / 255.0)));
    assert_string_equal(warnings, "");
    model_free(&m);
}

static void coordinates_of_a_wrong_length_are_said(void **state) {
    model m;
    (void)state;
    put_image(FILE_OF("image.tga"), 255);
    import_all_encodings("comment TextureFile image.tga\n" QUAD_VERTICES WEDGES,
                         QUAD_POINTS "3 0 1 2 4 0 0 1 0 0\n3 0 2 3 0 0\n", &m);
    quad_is(&m);
    assert_non_null(strstr(warnings, "texture coordinates of faces that are not two for each corner are left out"));
    model_free(&m);
}

static void looks_that_are_not_done_are_said(void **state) {
    model m;
    (void)state;
    import_all_encodings(QUAD_VERTICES "element face 2\n" INDICES
                                       "property int material_index\nproperty list uchar float color\n"
                                       "element material 1\nproperty uchar ambient_red\n",
                         QUAD_POINTS "3 0 1 2 0 0\n3 0 2 3 0 3 1 1 1\n7\n", &m);
    quad_is(&m);
    assert_non_null(strstr(warnings, "property 'material_index' of 'face' is left out"));
    assert_non_null(strstr(warnings, "property 'color' of 'face' is left out"));
    assert_non_null(strstr(warnings, "element 'material' is left out"));
    model_free(&m);
    refuse(FILE_OF("a.ply"), true, "property 'material_index' of 'face' is left out");
}

static void the_scene_file_names_its_material(void **state) {
    model m;
    (void)state;
    put_ply(FILE_OF("a.ply"), LAB_TEXT, QUAD_VERTICES TWO_FACES, QUAD_POINTS TWO_TRIANGLES);
    import_scene("a.ply", "materials = ( { name = \"default\"; color = (0.5, 0.25, 0.125); } );", &m);
    assert_true(near3(m.materials[0].albedo, 0.5, 0.25, 0.125));
    model_free(&m);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        T(integers_are_srgb_and_floats_linear),
        T(a_file_without_colours_is_white),
        T(colours_that_vary_and_alpha_are_said),
        T(colours_of_faces_become_materials),
        T(more_than_256_colours_of_faces_are_left_out),
        T(coordinates_of_vertices_have_many_names),
        T(a_texture_that_is_missing_is_a_warning),
        T(coordinates_of_corners_split_vertices),
        T(textures_go_by_their_number),
        T(coordinates_of_a_wrong_length_are_said),
        T(looks_that_are_not_done_are_said),
        T(the_scene_file_names_its_material),
    };
    return cmocka_run_group_tests(tests, make_folder, NULL);
}
