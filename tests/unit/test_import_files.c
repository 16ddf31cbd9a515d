/* The importer: cameras and lights, files that are not good, and real scenes. */
#define FOLDER VIT_BUILD_DIR "/tests/unit/import_files_files"
#include "import_lab.h"

/* ---- cameras and lights ---- */

#define LIGHTS(text)                                                                                                           \
    "\"extensionsUsed\":[\"KHR_lights_punctual\"],\"extensions\":{\"KHR_lights_punctual\":{\"lights\":[" text "]}},"

static void a_camera_stands_where_its_node_is(void **state) {
    model m;
    (void)state;
    /* The node is turned by 90 degrees about y: -z becomes -x. */
    put_gltf("",
             "\"scenes\":[{\"nodes\":[0,1]}],\"nodes\":[{\"mesh\":0},{\"name\":\"Cam\",\"camera\":0,\"translation\":[1,2,3],"
             "\"rotation\":[0,0.70710678,0,0.70710678]}],\"cameras\":[{\"type\":\"perspective\",\"perspective\":"
             "{\"yfov\":1.0,\"aspectRatio\":2.0,\"znear\":0.1,\"zfar\":10}}]," MATERIAL(BASE("")));
    import_good(FILE_OF("quad.gltf"), &m);
    assert_int_equal(m.camera_count, 1);
    const model_camera *c = &m.cameras[0];
    assert_string_equal(c->name, "Cam");
    assert_true(c->eye[0] == 1.0 && c->eye[1] == 2.0 && c->eye[2] == 3.0);
    assert_true(fabs(c->target[0] - 0.0) < 1e-6 && fabs(c->target[1] - 2.0) < 1e-6 && fabs(c->target[2] - 3.0) < 1e-6);
    assert_true(fabs(c->up[1] - 1.0) < 1e-6 && fabs(c->fov - 57.29577951) < 1e-3);
    model_free(&m);
}

static void an_orthographic_camera_is_warned_of(void **state) {
    model m;
    (void)state;
    put_gltf("", "\"scenes\":[{\"nodes\":[0,1]}],\"nodes\":[{\"mesh\":0},{\"name\":\"Cam\",\"camera\":0}],"
                 "\"cameras\":[{\"type\":\"orthographic\","
                 "\"orthographic\":{\"xmag\":2,\"ymag\":1,\"znear\":0.1,\"zfar\":10}}]," MATERIAL(BASE("")));
    import_good(FILE_OF("quad.gltf"), &m);
    assert_true(m.camera_count == 1 && m.cameras[0].fov == 0.0 && m.warnings == 1);
    assert_non_null(strstr(last_warning, "camera 'Cam' is orthographic"));
    model_free(&m);
}

static void lights_have_their_power_cone_and_range(void **state) {
    model m;
    (void)state;
#define LIT_NODE(name, more, light)                                                                                            \
    "{\"name\":\"" name "\"," more "\"extensions\":{\"KHR_lights_punctual\":{\"light\":" light "}}}"
    /* clang-format off */
    put_gltf("",
             LIGHTS("{\"type\":\"point\",\"color\":[1,0.5,0.25],\"intensity\":8},"
                    "{\"type\":\"spot\",\"intensity\":1,\"range\":6,"
                    "\"spot\":{\"innerConeAngle\":0.25,\"outerConeAngle\":0.5}},"
                    "{\"type\":\"directional\",\"color\":[1,0.5,0.25],\"intensity\":3}")
             "\"scenes\":[{\"nodes\":[0,1,2,3]}],\"nodes\":[{\"mesh\":0},"
             LIT_NODE("Bulb", "\"translation\":[0,2,0],", "0") ","
             LIT_NODE("Spot", "\"rotation\":[-0.70710678,0,0,0.70710678],", "1") ","
             LIT_NODE("Sun", "\"rotation\":[-0.70710678,0,0,0.70710678],", "2") "],"
             MATERIAL(BASE("")));
    /* clang-format on */
    import_good(FILE_OF("quad.gltf"), &m);
    assert_true(m.light_count == 3 && m.warnings == 0);
    const model_light *bulb = &m.lights[0], *spot = &m.lights[1], *sun = &m.lights[2];
    const double watts = 4.0 * 3.14159265358979 * 8.0 / 683.0, lux = 1.0 / 683.0;
    assert_string_equal(bulb->name, "Bulb");
    assert_true(bulb->kind == VIT_LIGHT_POINT && bulb->position[1] == 2.0 && bulb->range == 0.0);
    assert_true(fabs(bulb->power[0] - watts) < 1e-6 && fabs(bulb->power[2] - 0.25 * watts) < 1e-6 && bulb->stated[0] == 8.0);
    assert_true(spot->kind == VIT_LIGHT_SPOT && spot->range == 6.0 && fabs(spot->direction[1] + 1.0) < 1e-6);
    assert_true(fabs(spot->inner - 14.3239449) < 1e-4 && fabs(spot->outer - 28.6478898) < 1e-4);
    assert_true(sun->kind == VIT_LIGHT_DIRECTIONAL && sun->range == 0.0 && fabs(sun->direction[1] + 1.0) < 1e-6);
    assert_true(fabs(sun->power[0] - 3.0 * lux) < 1e-9 && fabs(sun->power[1] - 1.5 * lux) < 1e-9 &&
                fabs(sun->power[2] - 0.75 * lux) < 1e-9);
    model_free(&m);
}

/* Blender up to 3.5 turns lamps and cameras by a node of its own below the one that the user named. */
static void lights_and_cameras_answer_to_the_node_above(void **state) {
    model m;
    (void)state;
    /* clang-format off */
    put_gltf("",
             LIGHTS("{\"type\":\"point\"},{\"type\":\"point\",\"intensity\":2}")
             "\"scenes\":[{\"nodes\":[0,1,3,5]}],\"nodes\":[{\"mesh\":0},{\"name\":\"Lamp\",\"children\":[2]},"
             LIT_NODE("Lamp_Orientation", "", "0")
             ",{\"name\":\"Eye\",\"children\":[4]},{\"name\":\"Eye_Orientation\",\"camera\":0},"
             LIT_NODE("Other", "", "1")
             "],\"cameras\":[{\"type\":\"perspective\",\"perspective\":{\"yfov\":1.0,\"znear\":0.1}}],"
             MATERIAL(BASE("")));
    /* clang-format on */
    import_good(FILE_OF("quad.gltf"), &m);
    assert_true(m.light_count == 2 && m.camera_count == 1);
    assert_ptr_equal(model_light_named(&m, "Lamp"), model_light_named(&m, "Lamp_Orientation"));
    assert_string_equal(model_light_named(&m, "Lamp")->name, "Lamp_Orientation");
    assert_true(model_light_named(&m, "Other")->stated[0] == 2.0 && !model_light_named(&m, "Lam"));
    assert_ptr_equal(model_camera_named(&m, "Eye"), &m.cameras[0]);
    assert_ptr_equal(model_camera_named(&m, "Eye_Orientation"), &m.cameras[0]);
    assert_null(model_camera_named(&m, "Lamp"));
    model_free(&m);
}

/* ---- files that are not good ---- */

static void a_file_without_a_triangle_is_refused(void **state) {
    (void)state;
    put(FILE_OF("none.obj"), "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n# and not a triangle more\n");
    refuse(FILE_OF("none.obj"), false, "has no triangle");
}

static void a_missing_mesh_is_refused(void **state) {
    (void)state;
    refuse(FILE_OF("nowhere.obj"), false, "is not there");
    refuse(FOLDER, false, "is a folder");
}

static void a_missing_material_file_is_a_warning_or_an_error_if_strict(void **state) {
    model m;
    (void)state;
    put(FILE_OF("lost.obj"), "mtllib gone.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl x\nf 1 2 3\n");
    import_good(FILE_OF("lost.obj"), &m);
    assert_int_equal(m.warnings, 1);
    assert_non_null(strstr(last_warning, "lost.obj: its material file 'gone.mtl' is not there"));
    model_free(&m);
    refuse(FILE_OF("lost.obj"), true, "its material file 'gone.mtl' is not there");
    put(FILE_OF("gone.mtl"), "newmtl x\nKd 1 1 1\n");
    import_good(FILE_OF("lost.obj"), &m);
    assert_int_equal(m.warnings, 0);
    assert_true(inputs_hold(&m.files, FILE_OF("gone.mtl")));
    model_free(&m);
    assert_int_equal(unlink(FILE_OF("gone.mtl")), 0);
}

static void files_of_no_known_kind_are_refused(void **state) {
    (void)state;
    put(FILE_OF("a.xyz"), "hello");
    put(FILE_OF("bad.gltf"), "{\"asset\":{\"version\":\"2.0\"},\"nodes\":[");
    put(FILE_OF("bad.glb"), "glTF\x02");
    refuse(FILE_OF("a.xyz"), false, "");
    refuse(FILE_OF("bad.gltf"), false, "");
    refuse(FILE_OF("bad.glb"), false, "");
}

/* In a tilted plane, from either side: n - 2 triangles, which cover the area of the outline once. */
static void assert_cut(double (*outline)[2], size_t n, bool backwards) {
    char text[8192];
    size_t used = 0;
    double area = 0.0, sum = 0.0, sides[3] = {0.0, 0.0, 0.0};
    model m;
    for (size_t i = 0; i < n; i++) {
        const double *p = outline[i], *q = outline[(i + 1) % n];
        used += (size_t)snprintf(text + used, sizeof text - used, "v %.9g %.9g %.9g\n", p[0], 0.6 * p[1], 0.8 * p[1]);
        area += (p[0] * q[1] - p[1] * q[0]) / 2.0;
    }
    used += (size_t)snprintf(text + used, sizeof text - used, "f");
    for (size_t i = 0; i < n; i++)
        used += (size_t)snprintf(text + used, sizeof text - used, " %zu", backwards ? n - i : i + 1);
    assert_true(area > 0.0 && used < sizeof text - 2);
    put(FILE_OF("polygon.obj"), strcat(text, "\n"));
    import_good(FILE_OF("polygon.obj"), &m);
    check_promises(&m);
    assert_int_equal(m.triangles + m.degenerate, n - 2);
    for (size_t t = 0; t < m.triangles; t++) {
        const float *a = m.position + 3 * (size_t)m.index[3 * t], *b = m.position + 3 * (size_t)m.index[3 * t + 1];
        const float *c = m.position + 3 * (size_t)m.index[3 * t + 2];
        double square = 0.0;
        for (int k = 0; k < 3; k++) {
            const int u = (k + 1) % 3, v = (k + 2) % 3;
            const double twice = (double)(b[u] - a[u]) * (double)(c[v] - a[v]) - (double)(b[v] - a[v]) * (double)(c[u] - a[u]);
            square += twice * twice;
            sides[k] += twice / 2.0;
        }
        sum += sqrt(square) / 2.0;
    }
    assert_true(fabs(sum - area) < 1e-5 * area);
    assert_true(fabs((0.6 * sides[2] - 0.8 * sides[1]) - (backwards ? -area : area)) < 1e-5 * area);
    model_free(&m);
}

/* Assimp 5.3 leaves out parts of such polygons. */
static void polygons_that_are_not_convex_are_cut_whole(void **state) {
    (void)state;
    enum { POINTS = 34, TEETH = 16 };
    double ring[][2] = {{0, 0}, {3, 0}, {3, 3}, {0, 3}, {0, 0}, {1, 1}, {1, 2}, {2, 2}, {2, 1}, {1, 1}};
    double house[][2] = {{0, 0}, {1, 0}, {2, 0}, {2, 1}, {1, 1.5}, {0, 1}};
    double star[POINTS][2], comb[4 * TEETH][2];
    for (int i = 0; i < POINTS; i++) {
        const double angle = 2.0 * 3.14159265358979 * i / POINTS, r = i % 2 ? 0.3 : 1.0;
        star[i][0] = r * cos(angle);
        star[i][1] = r * sin(angle);
    }
    for (int i = 0; i < 2 * TEETH; i++) { /* teeth up in a wave and back along it, so that no line across sees it all */
        const double x = i, y = 4.0 * sin(0.4 * i) + (i % 2 ? 3.0 : 0.0);
        comb[i][0] = comb[4 * TEETH - 1 - i][0] = x;
        comb[i][1] = y;
        comb[4 * TEETH - 1 - i][1] = y + 1.0;
    }
    for (int side = 0; side < 2; side++) {
        assert_cut(star, POINTS, side == 1);
        assert_cut(comb, 4 * TEETH, side == 1);
        assert_cut(ring, sizeof ring / sizeof ring[0], side == 1);
        assert_cut(house, sizeof house / sizeof house[0], side == 1);
    }
}

/* Assimp 5.4 cuts off no corner that is nearly straight, and drops what is left when it finds no other: more than half of
 * these. */
static void polygons_with_nearly_straight_corners_are_cut_whole(void **state) {
    enum { ROUND = 24 };
    double ring[2 * ROUND + 2][2];
    double strip[][2] = {{0, 0}, {4, 0}, {4, 0.001}, {3, 0.0011}, {2, 0.0011}, {1, 0.0011}, {0, 0.001}};
    (void)state;
    for (int i = 0; i < 2 * ROUND + 2; i++) { /* round, in by a pair of edges, back round the hole */
        const double angle = 2.0 * 3.14159265358979 * ((i <= ROUND ? i : 2 * ROUND + 1 - i) % ROUND) / ROUND;
        ring[i][0] = (i <= ROUND ? 1.0 : 0.8) * cos(angle);
        ring[i][1] = (i <= ROUND ? 1.0 : 0.8) * sin(angle);
    }
    for (int side = 0; side < 2; side++) {
        assert_cut(ring, 2 * ROUND + 2, side == 1);
        assert_cut(strip, sizeof strip / sizeof strip[0], side == 1);
    }
}

static void a_ply_with_a_broken_header_is_refused(void **state) {
    (void)state;
    put(FILE_OF("b.ply"), "ply\nformat ascii 1.0\nelement vertex 0\nend_headr\n");
    refuse(FILE_OF("b.ply"), false, "line 4: not a PLY header");
    put(FILE_OF("b.ply"), "ply\nformat ascii 1.0\nelement vertex 0\n");
    refuse(FILE_OF("b.ply"), false, "the PLY header has no end");
    put(FILE_OF("b.ply"), "");
    refuse(FILE_OF("b.ply"), false, "is no PLY file");
}

/* ---- the test scenes ---- */

static const char *scene_path(const char *name) {
    static char path[SCENE_PATH];
    const char *folder = getenv("VITRINE_SCENES");
    (void)snprintf(path, sizeof path, "%s/%s", folder ? folder : "../shared/scenes", name);
    if (access(path, R_OK) == 0)
        return path;
    print_message("%s is not here: skipped\n", path);
    skip();
    return NULL;
}

/* Triangles of the file, points and lines, textures in use; counted by other means. */
static void counts(const char *name, uint64_t triangles, uint64_t other, int images) {
    model m;
    const char *path = scene_path(name);
    import_good(path, &m);
    check_promises(&m);
    if (m.triangles + m.degenerate != triangles)
        print_error("%s: %u + %u triangles\n", name, m.triangles, (unsigned)m.degenerate);
    assert_true(m.triangles + m.degenerate == triangles && m.not_triangles == other && m.image_count == images);
    model_free(&m);
}

static void real_scenes_have_the_triangles_that_others_counted(void **state) {
    (void)state;
    counts("sponza/sponza.gltf", 262267, 0, 24);
    counts("sibenik/sibenik.obj", 80479, 0, 3);
    counts("cornell_box/CornellBox-Original.obj", 36, 0, 0);
    counts("cornell_box/CornellBox-Glossy.obj", 1112, 0, 0);
    counts("stanford/bun_zipper.ply", 69451, 0, 0);
    counts("stanford/DragonAttenuation/DragonAttenuation.gltf", 134995, 0, 1);
}

static void all_but_the_glass_of_the_kitchen_is_there(void **state) {
    model m;
    (void)state;
    import_good(scene_path("country_kitchen/country_kitchen.gltf"), &m);
    check_promises(&m);
    assert_true(m.triangles + m.degenerate + 3434 == 251099 && m.image_count == 11);
    model_free(&m);
}

static void gltf_samples_have_their_triangles_and_textures(void **state) {
    (void)state;
    counts("gltf/BoxTextured/BoxTextured.gltf", 12, 0, 1);
    counts("gltf/Duck/Duck.gltf", 4212, 0, 1);
    counts("gltf/TextureSettingsTest/TextureSettingsTest.gltf", 72, 0, 3);
    counts("gltf/TextureTransformTest/TextureTransformTest.gltf", 24, 0, 5);
    counts("gltf/MultiUVTest/MultiUVTest.gltf", 12, 0, 1);
    counts("gltf/VertexColorTest/VertexColorTest.gltf", 36, 0, 2);
    counts("gltf/SimpleSparseAccessor/SimpleSparseAccessor.gltf", 12, 0, 0);
    counts("gltf/CubeScaledInstances/cube_att.gltf", 48, 0, 0);
    counts("gltf/CesiumMilkTruck/CesiumMilkTruck.gltf", 3624, 0, 1);
    counts("gltf/Lantern/Lantern.gltf", 5394, 0, 2);
    counts("odd/testmixed.obj", 12, 42, 0);
    counts("odd/concave_polygon.obj", 64, 0, 0);
    counts("odd/deg_faces.obj", 4, 0, 0);
    counts("odd/malformed.obj", 8, 0, 0); /* and two polygons whose indices lead nowhere */
    counts("odd/partial_materials/three_meshes_two_materials_one_no_material.gltf", 36, 0, 2);
    counts("odd/PrimitiveMode/Mesh_PrimitiveMode_05.gltf", 2, 0, 0);
    counts("odd/PrimitiveMode/Mesh_PrimitiveMode_06.gltf", 2, 0, 0);
    counts("odd/IndexOutOfRange/IndexOutOfRange.gltf", 11, 0, 0);
}

static void malformed_files_are_refused_with_one_line(void **state) {
    static const char *const names[] = {
        "odd/BoxWithInfinites.glb",
        "odd/IndexOutOfRange/AllIndicesOutOfRange.gltf",
        "odd/MissingBin/BoxTextured.gltf",
        "odd/PrimitiveMode/Mesh_PrimitiveMode_00.gltf",
        "odd/PrimitiveMode/Mesh_PrimitiveMode_02.gltf",
        "odd/box_UTF16BE.obj",
        "odd/degenerate_mesh.obj",
        "odd/empty.obj",
        "odd/empty.ply",
        "odd/number_formats.obj",
    };
    (void)state;
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        refuse(scene_path(names[i]), false, ": ");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        T(a_camera_stands_where_its_node_is),
        T(an_orthographic_camera_is_warned_of),
        T(lights_have_their_power_cone_and_range),
        T(lights_and_cameras_answer_to_the_node_above),
        T(a_file_without_a_triangle_is_refused),
        T(a_missing_mesh_is_refused),
        T(a_missing_material_file_is_a_warning_or_an_error_if_strict),
        T(files_of_no_known_kind_are_refused),
        T(polygons_that_are_not_convex_are_cut_whole),
        T(polygons_with_nearly_straight_corners_are_cut_whole),
        T(a_ply_with_a_broken_header_is_refused),
        T(real_scenes_have_the_triangles_that_others_counted),
        T(all_but_the_glass_of_the_kitchen_is_there),
        T(gltf_samples_have_their_triangles_and_textures),
        T(malformed_files_are_refused_with_one_line),
    };
    return cmocka_run_group_tests(tests, make_folder, NULL);
}
