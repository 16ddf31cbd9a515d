/* Where glTF puts things. What is hard: places come from trees of nodes, instances, skins and morph targets together, names
 * from strangers, and trees that are none. Strategy: a triangle whose corners are easy to follow through each of these, alone;
 * box and vertices must be where the specification's own words have them. */
#define FOLDER VIT_BUILD_DIR "/tests/unit/gltf_scene"
#include "gltf_lab.h"

/* Nodes and all else that is behind the meshes, of a file with the triangle in mesh 0. */
static void import_nodes(const char *rest, model *m) {
    gltf_lab l = {.size = 0};
    char text[4096];
    (void)lab_triangle(&l);
    (void)snprintf(text, sizeof text, "\"meshes\":[{\"name\":\"part\",\"primitives\":[{\"attributes\":{\"POSITION\":0}}]}],%s",
                   rest);
    lab_write(&l, "lab", text);
    import_good(LAB_FILE, m);
    check_promises(m);
}

static void refuse_nodes(const char *rest, const char *what) {
    gltf_lab l = {.size = 0};
    char text[4096];
    (void)lab_triangle(&l);
    (void)snprintf(text, sizeof text, "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0}}]}],%s", rest);
    lab_refused(&l, text, what);
}

/* ---- nodes ---- */

static void matrices_and_turns_go_down_the_tree(void **state) {
    model m;
    (void)state;
    /* (1, 0, 0) turned by 90 degrees about z is (0, 1, 0), doubled, then 10 further along x; the matrix is by columns. */
    import_nodes("\"scenes\":[{\"nodes\":[1]}],\"nodes\":[{\"mesh\":0,\"rotation\":[0,0,0.70710678,0.70710678],"
                 "\"scale\":[2,2,2]},{\"children\":[0],\"matrix\":[1,0,0,0,0,1,0,0,0,0,1,0,10,0,0,1]}]",
                 &m);
    box_is(&m, 8, 0, 0, 10, 2, 0);
    model_free(&m);
}

/* Not allowed, and written by programs that so have instances. */
static void a_node_with_two_parents_is_in_two_places(void **state) {
    model m;
    (void)state;
    import_nodes("\"scenes\":[{\"nodes\":[0,1]}],\"nodes\":[{\"children\":[2]},{\"children\":[2],\"translation\":[5,0,0]},"
                 "{\"mesh\":0}]",
                 &m);
    assert_int_equal(m.triangles, 2);
    box_is(&m, 0, 0, 0, 6, 1, 0);
    assert_true(m.mesh_count == 1 && m.meshes[0].places == 2);
    assert_string_equal(m.meshes[0].name, "part");
    model_free(&m);
}

static void only_the_chosen_scene_is_shown(void **state) {
    model m;
    (void)state;
    import_nodes("\"scene\":1,\"scenes\":[{\"nodes\":[0]},{\"nodes\":[1,2]}],\"nodes\":[{\"mesh\":0},{\"children\":[2]},"
                 "{\"mesh\":0,\"translation\":[5,0,0]}]", /* the child is named as well: it is there once */
                 &m);
    box_is(&m, 5, 0, 0, 6, 1, 0);
    assert_int_equal(m.triangles, 1);
    assert_non_null(strstr(warnings, "1 of 2 scenes are left out"));
    model_free(&m);
    import_nodes("\"nodes\":[{\"children\":[1]},{\"mesh\":0}]", &m); /* without scenes all is */
    assert_int_equal(m.triangles, 1);
    model_free(&m);
}

static void trees_that_are_none_are_refused(void **state) {
    (void)state;
    refuse_nodes("\"scenes\":[{\"nodes\":[0]}],\"nodes\":[{\"children\":[1]},{\"children\":[2]},{\"children\":[0],\"mesh\":0}]",
                 "node 0 is among its own ancestors");
    refuse_nodes("\"scenes\":[{\"nodes\":[0]}],\"nodes\":[{\"mesh\":0},{\"children\":[1]}]",
                 "node 1 is among its own ancestors");
    refuse_nodes("\"scenes\":[{\"nodes\":[0]}],\"nodes\":[{\"mesh\":0,\"children\":[7]}]",
                 "node 0 has a child that is no node");
    refuse_nodes("\"scenes\":[{\"nodes\":[7]}],\"nodes\":[{\"mesh\":0}]", "scene 0 has a node that is none");
    refuse_nodes("\"scene\":3,\"scenes\":[{\"nodes\":[0]}],\"nodes\":[{\"mesh\":0}]", "scene 3 of 1");
    refuse_nodes("\"nodes\":[{\"mesh\":4}]", "node 'nodes[0]' has mesh 4 of 1");
    refuse_nodes("\"nodes\":[7]", "node 0 is none");
    refuse_nodes("\"nodes\":[]", "has no triangle");
}

/* Thirty levels of two children that are the same node: 2^30 places. */
static void places_without_end_are_refused(void **state) {
    char rest[4096] = "\"scenes\":[{\"nodes\":[0]}],\"nodes\":[";
    (void)state;
    for (int i = 0; i < 30; i++)
        lab_text(rest, sizeof rest, "{\"children\":[%d,%d]},", i + 1, i + 1);
    lab_text(rest, sizeof rest, "{\"mesh\":0}]");
    refuse_nodes(rest, "more than 1048576 places");
}

static void chains_of_nodes_may_be_deep(void **state) {
    static char rest[40000] = "\"scenes\":[{\"nodes\":[0]}],\"nodes\":[";
    gltf_lab l = {.size = 0};
    model m;
    (void)state;
    for (int i = 0; i < 700; i++)
        lab_text(rest, sizeof rest, "{\"children\":[%d],\"translation\":[1,0,0]},", i + 1);
    lab_text(rest, sizeof rest, "{\"mesh\":0}],\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0}}]}]");
    (void)lab_triangle(&l);
    lab_write(&l, "lab", rest);
    import_good(LAB_FILE, &m);
    box_is(&m, 700, 0, 0, 701, 1, 0);
    model_free(&m);
}

/* ---- instances ---- */

static void instances_stand_below_their_node(void **state) {
    static const float at[6] = {0, 0, 0, 5, 0, 0}, scale[6] = {1, 1, 1, 3, 3, 3};
    const int8_t turn[8] = {0, 0, 0, 127, 0, 0, 127, 0}; /* the second half round about z */
    gltf_lab l = {.size = 0};
    model m;
    (void)state;
    (void)lab_triangle(&l);
    (void)lab_data(&l, at, sizeof at, GLTF_FLOAT, "VEC3", 2, "");
    (void)lab_data(&l, turn, sizeof turn, GLTF_BYTE, "VEC4", 2, ",\"normalized\":true");
    (void)lab_data(&l, scale, sizeof scale, GLTF_FLOAT, "VEC3", 2, "");
    const char *node = "\"extensionsRequired\":[\"EXT_mesh_gpu_instancing\"],\"meshes\":[{\"primitives\":[{\"attributes\":"
                       "{\"POSITION\":0}}]}],\"nodes\":[{\"mesh\":0,\"translation\":[0,0,1],\"extensions\":"
                       "{\"EXT_mesh_gpu_instancing\":{\"attributes\":{\"TRANSLATION\":1,\"ROTATION\":2,\"SCALE\":3}}}}]";
    lab_write(&l, "lab", node);
    import_good(LAB_FILE, &m);
    box_is(&m, 0, -3, 1, 5, 1, 1);
    assert_true(m.triangles == 2 && m.meshes[0].places == 2);
    model_free(&m);
    (void)lab_data(&l, scale, 12, GLTF_FLOAT, "VEC3", 1, "");
    lab_refused(&l,
                "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0}}]}],\"nodes\":[{\"mesh\":0,\"extensions\":"
                "{\"EXT_mesh_gpu_instancing\":{\"attributes\":{\"TRANSLATION\":1,\"SCALE\":4}}}}]",
                "instances with 2 and 1 attributes");
}

/* ---- morph targets ---- */

static void morph(const char *mesh, const char *node, model *m) {
    static const float normals[9] = {0, 0, 1, 0, 0, 1, 0, 0, 1}, up[9] = {0, 0, 2, 0, 0, 2, 0, 0, 2};
    static const float right[9] = {4, 0, 0, 4, 0, 0, 4, 0, 0}, turned[9] = {1, 0, -1, 1, 0, -1, 1, 0, -1};
    gltf_lab l = {.size = 0};
    char rest[1024];
    (void)lab_triangle(&l);
    (void)lab_data(&l, normals, sizeof normals, GLTF_FLOAT, "VEC3", 3, "");
    (void)lab_data(&l, up, sizeof up, GLTF_FLOAT, "VEC3", 3, "");
    (void)lab_data(&l, right, sizeof right, GLTF_FLOAT, "VEC3", 3, "");
    (void)lab_data(&l, turned, sizeof turned, GLTF_FLOAT, "VEC3", 3, "");
    (void)snprintf(rest, sizeof rest,
                   "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0,\"NORMAL\":1},\"targets\":[{\"POSITION\":2},"
                   "{\"POSITION\":3,\"NORMAL\":4}]}]%s}],\"nodes\":[{\"mesh\":0%s}]",
                   mesh, node);
    lab_write(&l, "lab", rest);
    import_good(LAB_FILE, m);
    check_promises(m);
}

static void morph_targets_stand_at_their_weights(void **state) {
    model m;
    (void)state;
    morph("", "", &m);
    box_is(&m, 0, 0, 0, 1, 1, 0);
    model_free(&m);
    morph(",\"weights\":[0.5,0]", "", &m);
    box_is(&m, 0, 0, 1, 1, 1, 1);
    normal_at(&m, 0, 0, 1, 0, 0, 1);
    model_free(&m);
    morph(",\"weights\":[0.5,0]", ",\"weights\":[0,1]", &m); /* the node's go first */
    box_is(&m, 4, 0, 0, 5, 1, 0);
    normal_at(&m, 4, 0, 0, 1, 0, 0);
    assert_string_equal(warnings, "");
    model_free(&m);
}

/* ---- skins ---- */

#define SKINNED "\"attributes\":{\"POSITION\":0,\"NORMAL\":1,\"JOINTS_0\":2,\"WEIGHTS_0\":3}"

/* Two joints: at y 3, and turned by 90 degrees about z at x 5; the triangle's corners follow the first, half each, the second.
 */
static void skin(const char *skin_rest, const uint8_t joints[12], model *m) {
    static const float normals[9] = {1, 0, 0, 0, 0, 1, 1, 0, 0};
    static const float inverse[32] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 7, 1,
                                      1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 7, 1};
    const uint8_t weights[12] = {255, 0, 0, 0, 128, 127, 0, 0, 255, 0, 0, 0};
    gltf_lab l = {.size = 0};
    char rest[2048];
    (void)lab_triangle(&l);
    (void)lab_data(&l, normals, sizeof normals, GLTF_FLOAT, "VEC3", 3, "");
    (void)lab_data(&l, joints, 12, GLTF_UBYTE, "VEC4", 3, "");
    (void)lab_data(&l, weights, sizeof weights, GLTF_UBYTE, "VEC4", 3, ",\"normalized\":true");
    (void)lab_data(&l, inverse, sizeof inverse, GLTF_FLOAT, "MAT4", 2, "");
    (void)snprintf(rest, sizeof rest,
                   "\"meshes\":[{\"primitives\":[{" SKINNED "}]}],\"skins\":[{%s}],\"scenes\":[{\"nodes\":[0,1]}],"
                   "\"nodes\":[{\"mesh\":0,\"skin\":0,\"translation\":[100,0,0]},{\"translation\":[0,3,0],\"children\":[2]},"
                   "{\"translation\":[5,-3,0],\"rotation\":[0,0,0.70710678,0.70710678]}]",
                   skin_rest);
    lab_write(&l, "lab", rest);
    if (!m)
        return;
    import_good(LAB_FILE, m);
    check_promises(m);
}

static void skins_follow_their_joints_and_not_their_node(void **state) {
    const uint8_t joints[12] = {0, 0, 0, 0, 0, 1, 0, 0, 1, 0, 0, 0};
    model m;
    (void)state;
    skin("\"joints\":[1,2]", joints, &m); /* without inverse bind matrices: they are 1 */
    const double half = 128.0 / 255.0;
    /* (0,0,0) + (0,3,0); half (1,3,0), half (5,1,0), which is (1,0,0) turned and moved; (0,1,0) turned is (-1,0,0), moved
     * (4,0,0). */
    vertex_is(&m, vertex_at(&m, 0, 3, 0), 0, 3, 0);
    (void)vertex_at(&m, (float)(half * 1 + (1 - half) * 5), (float)(half * 3 + (1 - half) * 1), 0);
    normal_at(&m, 4, 0, 0, 0, 1, 0); /* x turned */
    normal_at(&m, 0, 3, 0, 1, 0, 0);
    model_free(&m);
    skin("\"joints\":[1,2],\"inverseBindMatrices\":4", joints, &m);
    box_is(&m, 0, 0, 7, 4, 3, 7);
    assert_string_equal(warnings, "");
    model_free(&m);
}

static void skins_that_are_none_are_refused(void **state) {
    const uint8_t joints[12] = {0}, beyond[12] = {0, 0, 0, 0, 0, 2}, unweighted[12] = {0, 9, 9, 9};
    model m;
    (void)state;
    skin("\"joints\":[1,2]", beyond, NULL);
    refuse(LAB_FILE, false, "a vertex has joint 2 of 2");
    skin("\"joints\":[1,9]", joints, NULL);
    refuse(LAB_FILE, false, "a joint that is no node");
    skin("\"joints\":[]", joints, NULL);
    refuse(LAB_FILE, false, "skin 0 has no joints");
    skin("\"joints\":[1,2,1],\"inverseBindMatrices\":4", joints, NULL);
    refuse(LAB_FILE, false, "skin 0 has 2 inverse bind matrices for 3 joints");
    skin("\"joints\":[1,2]", unweighted, &m); /* what has no weight is not looked at */
    model_free(&m);
}

/* ---- lights and cameras ---- */

#define LIGHTS                                                                                                                 \
    "\"extensions\":{\"KHR_lights_punctual\":{\"lights\":[{\"type\":\"spot\",\"intensity\":683,\"color\":[1,0.5,0],"           \
    "\"range\":9,\"spot\":{\"innerConeAngle\":0.1,\"outerConeAngle\":0.2}},{\"type\":\"point\"},{\"type\":\"ambient\"}]}}"
#define LIT(n) "\"extensions\":{\"KHR_lights_punctual\":{\"light\":" n "}}"
#define LIT_0 LIT("0")

static void a_light_on_two_nodes_is_two_lights_named_by_node(void **state) {
    model m;
    (void)state;
    import_nodes(LIGHTS ",\"nodes\":[{\"mesh\":0},"
                        "{\"name\":\"A\",\"translation\":[1,2,3]," LIT_0 "},"
                        "{\"name\":\"B\",\"rotation\":[0.70710678,0,0,0.70710678],\"children\":[3]},"
                        "{" LIT_0 "},{" LIT("1") "},{\"name\":\"odd\"," LIT("2") "}]",
                 &m);
    assert_int_equal(m.light_count, 3);
    const model_light *a = model_light_named(&m, "A"), *b = model_light_named(&m, "B");
    assert_non_null(a);
    assert_ptr_equal(b, model_light_named(&m, "nodes[3]"));
    assert_true(a->kind == (int)VIT_LIGHT_SPOT && near(a->position[1], 2) && near(a->direction[2], -1) && near(a->range, 9));
    assert_true(near(a->inner, 0.1 * 180 / 3.14159265358979) && near(a->outer, 0.2 * 180 / 3.14159265358979));
    assert_true(near(a->stated[1], 341.5) && near(a->power[1], 0.5 * 4 * 3.14159265358979) && a->states_unit);
    assert_true(near(b->position[0], 0) && near(b->direction[1], 1)); /* -z turned about x */
    const model_light *plain = model_light_named(&m, "nodes[4]");
    assert_true(plain->kind == (int)VIT_LIGHT_POINT && near(plain->stated[0], 1) && plain->range == 0.0);
    assert_non_null(strstr(warnings, "light 'odd' is no point, spot or directional light"));
    model_free(&m);
    refuse_nodes(LIGHTS ",\"nodes\":[{\"mesh\":0," LIT("3") "}]", "has light 3 of 3");
}

static void a_camera_looks_along_its_nodes_minus_z(void **state) {
    model m;
    (void)state;
    import_nodes("\"cameras\":[{\"type\":\"perspective\",\"perspective\":{\"yfov\":1,\"znear\":1}},{\"type\":\"orthographic\","
                 "\"orthographic\":{\"xmag\":1,\"ymag\":1,\"zfar\":9,\"znear\":1}}],\"nodes\":[{\"mesh\":0},"
                 "{\"name\":\"C\",\"camera\":0,\"translation\":[0,1,5]},{\"name\":\"D\",\"camera\":1}]",
                 &m);
    const model_camera *c = model_camera_named(&m, "C");
    assert_true(near(c->eye[2], 5) && near(c->target[2], 4) && near(c->up[1], 1) && near(c->fov, 180 / 3.14159265358979));
    assert_true(m.camera_count == 2 && model_camera_named(&m, "D")->fov == 0.0);
    assert_non_null(strstr(warnings, "camera 'D' is orthographic"));
    model_free(&m);
    refuse_nodes("\"nodes\":[{\"mesh\":0,\"camera\":0}]", "has camera 0 of 0");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        T(matrices_and_turns_go_down_the_tree),
        T(a_node_with_two_parents_is_in_two_places),
        T(only_the_chosen_scene_is_shown),
        T(trees_that_are_none_are_refused),
        T(places_without_end_are_refused),
        T(chains_of_nodes_may_be_deep),
        T(instances_stand_below_their_node),
        T(morph_targets_stand_at_their_weights),
        T(skins_follow_their_joints_and_not_their_node),
        T(skins_that_are_none_are_refused),
        T(a_light_on_two_nodes_is_two_lights_named_by_node),
        T(a_camera_looks_along_its_nodes_minus_z),
    };
    return cmocka_run_group_tests(tests, make_folder, NULL);
}
