/* The importer: triangles, their order, normals, places, and what is left out. */
#define FOLDER VIT_BUILD_DIR "/tests/unit/import_geometry_files"
#include "import_lab.h"

/* ---- geometry ---- */

static void nodes_instances_and_the_scene_place_the_triangles(void **state) {
    scene s;
    model m;
    vit_text why;
    (void)state;
    put_gltf("", "\"scenes\":[{\"nodes\":[0]}],\"nodes\":[{\"translation\":[10,0,0],\"children\":[1,2]},{\"mesh\":0},"
                 "{\"mesh\":0,\"scale\":[1,2,1],\"translation\":[0,5,0]}]," MATERIAL(BASE("")));
    put(FILE_OF("test.cfg"),
        "meshes = ( { file = \"quad.gltf\"; translate = (0, 0, 7); }, { file = \"quad.gltf\"; scale = 0.5; } );\n"
        "camera: { use = \"c\"; };\n");
    assert_int_equal(scene_read(FILE_OF("test.cfg"), &s, &why), VIT_OK);
    assert_int_equal(model_import(&s, false, NULL, NULL, &m, &why), VIT_OK);
    check_promises(&m);
    assert_int_equal(m.triangles, 8);
    (void)vertex_at(&m, 11, 1, 7);
    (void)vertex_at(&m, 10, 7, 7);
    (void)vertex_at(&m, 5.5f, 3.5f, 0);
    assert_true(m.lo[0] == 5.0 && m.hi[0] == 11.0 && m.lo[1] == 0.0 && m.hi[1] == 7.0 && m.hi[2] == 7.0);
    model_free(&m);
    scene_free(&s);
}

/* (v1 - v0) x (v2 - v0), z. */
static float winding(const model *m, size_t t) {
    const float *a = m->position + 3 * m->index[3 * t], *b = m->position + 3 * m->index[3 * t + 1];
    const float *c = m->position + 3 * m->index[3 * t + 2];
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

static void a_mirrored_node_keeps_its_front_in_front(void **state) {
    model m;
    (void)state;
    put_gltf("", "\"scenes\":[{\"nodes\":[0]}],\"nodes\":[{\"mesh\":0,\"scale\":[-1,1,1]}]," MATERIAL(BASE("")));
    import_good(FILE_OF("quad.gltf"), &m);
    assert_true(m.lo[0] == -1.0 && m.hi[0] == 0.0);
    assert_true(winding(&m, 0) > 0.0f && winding(&m, 1) > 0.0f);
    normal_at(&m, -1, 0, 0, 0, 0, 1);
    model_free(&m);
}

/* Normals of the file under scale (1, 4, 1): (0, 0.6, 0.8) becomes (0, 0.15, 0.8), normalised; mirrored in x, (1, 0, 0) turns.
 */
static void normals_go_by_the_inverse_transpose(void **state) {
    scene s;
    model m;
    vit_text why;
    (void)state;
    put(FILE_OF("n.obj"), "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0.6 0.8\nvn 1 0 0\nvn 0 0 0\nf 1//1 2//2 3//3\n");
    put(FILE_OF("test.cfg"), "meshes = ( { file = \"n.obj\"; scale = [-1.0, 4.0, 1.0]; } );\ncamera: { use = \"c\"; };\n");
    assert_int_equal(scene_read(FILE_OF("test.cfg"), &s, &why), VIT_OK);
    assert_int_equal(model_import(&s, false, NULL, NULL, &m, &why), VIT_OK);
    const float length = sqrtf(0.15f * 0.15f + 0.64f);
    normal_at(&m, 0, 0, 0, 0, 0.15f / length, 0.8f / length);
    normal_at(&m, -1, 0, 0, -1, 0, 0);
    normal_at(&m, 0, 4, 0, 0, 0, 1); /* a normal of no length: the face's */
    model_free(&m);
    scene_free(&s);
}

static void missing_normals_are_smooth_over_a_flat_ridge(void **state) {
    model m;
    (void)state;
    /* Two faces that fall by 45 degrees in all (slopes of 22.5 to each side of the ridge x = 0). */
    put(FILE_OF("ridge.obj"), "v 0 0 0\nv 0 0 1\nv 1 -0.41421356 0\nv -1 -0.41421356 0\nf 1 2 3\nf 1 4 2\n");
    import_good(FILE_OF("ridge.obj"), &m);
    check_promises(&m);
    normal_at(&m, 0, 0, 0, 0, 1, 0);
    normal_at(&m, 0, 0, 1, 0, 1, 0);
    normal_at(&m, 1, -0.41421356f, 0, 0.38268343f, 0.92387953f, 0);
    model_free(&m);
}

static void missing_normals_keep_an_edge_of_90_degrees(void **state) {
    model m;
    (void)state;
    put(FILE_OF("edge.obj"), "v 0 0 0\nv 0 0 1\nv 1 0 0\nv 0 -1 0\nf 1 2 3\nf 1 4 2\n");
    import_good(FILE_OF("edge.obj"), &m);
    for (size_t t = 0; t < m.triangles; t++)
        for (size_t k = 0; k < 3; k++) {
            const float *n = m.normal + 3 * m.index[3 * t + k];
            assert_true(fmaxf(fabsf(n[0]), fabsf(n[1])) > 0.99999f);
        }
    model_free(&m);
}

static void triangles_without_area_are_dropped_and_counted(void **state) {
    model m;
    (void)state;
    put(FILE_OF("flat.obj"), "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 2 0 0\nv 1 0 0\nf 1 2 3\nf 1 2 4\nf 1 2 5\nf 3 3 1\n");
    import_good(FILE_OF("flat.obj"), &m);
    assert_true(m.triangles == 1 && m.degenerate == 3 && m.warnings == 0);
    model_free(&m);
}

static void triangles_that_are_not_finite_are_dropped_with_one_warning(void **state) {
    model m;
    (void)state;
    put(FILE_OF("nan.obj"), "v 0 0 0\nv 1 0 0\nv 1 1 0\nv nan 0 0\nv 0 inf 0\nf 1 2 3\nf 1 2 4\nf 1 2 5\n");
    import_good(FILE_OF("nan.obj"), &m);
    assert_true(m.triangles == 1 && m.not_finite == 2 && m.warnings == 1 && m.hi[0] == 1.0);
    assert_non_null(strstr(last_warning, "nan.obj: 2 triangles"));
    model_free(&m);
}

static void triangles_that_go_too_far_out_are_dropped_with_one_warning(void **state) {
    model m;
    (void)state;
    put(FILE_OF("far.obj"),
        "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 -1e30 0\nv 2e9 0 0\nv 1e9 0 0\nf 1 2 3\nf 1 2 4\nf 1 3 5\nf 1 3 6\n");
    import_good(FILE_OF("far.obj"), &m);
    assert_true(m.triangles == 2 && m.not_finite == 0 && m.warnings == 1 && m.lo[1] == 0.0 && m.hi[0] == 1e9);
    assert_non_null(
        strstr(last_warning, "far.obj: 2 triangles with a vertex farther out than 1e+09 m dropped, one at 1e+30 m"));
    model_free(&m);
    put(FILE_OF("far.obj"), "v 0 0 0\nv 1 0 0\nv 1e30 1 0\nf 1 2 3\n");
    refuse(FILE_OF("far.obj"), false, "has no triangle nearer than 1e+09 m: a vertex is at 1e+30 m");
}

static void points_and_lines_are_dropped_and_counted(void **state) {
    model m;
    (void)state;
    put(FILE_OF("mixed.obj"), "v 0 0 0\nv 1 0 0\nv 1 1 0\np 1\nl 1 2\nf 1 2 3\n");
    import_good(FILE_OF("mixed.obj"), &m);
    assert_true(m.triangles == 1 && m.not_triangles == 2);
    model_free(&m);
}

static void a_ply_without_normals_is_imported(void **state) {
    model m;
    (void)state;
    put(FILE_OF("a.ply"),
        "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
        "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n");
    import_good(FILE_OF("a.ply"), &m);
    check_promises(&m);
    assert_int_equal(m.triangles, 2);
    normal_at(&m, 0, 1, 0, 0, 0, 1);
    model_free(&m);
}

static void importing_twice_gives_the_same_bytes(void **state) {
    model a, b;
    (void)state;
    put_image(FILE_OF("image.tga"), 255);
    put_obj("newmtl m\nKd 0.5 0.25 1\nmap_Kd image.tga\n");
    import_good(FILE_OF("quad.obj"), &a);
    import_good(FILE_OF("quad.obj"), &b);
    assert_true(a.vertices == b.vertices && a.triangles == b.triangles);
    assert_memory_equal(a.position, b.position, 12 * (size_t)a.vertices);
    assert_memory_equal(a.normal, b.normal, 12 * (size_t)a.vertices);
    assert_memory_equal(a.uv, b.uv, 8 * (size_t)a.vertices);
    assert_memory_equal(a.index, b.index, 12 * (size_t)a.triangles);
    assert_memory_equal(a.material, b.material, 4 * (size_t)a.triangles);
    model_free(&a);
    model_free(&b);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        T(nodes_instances_and_the_scene_place_the_triangles),
        T(a_mirrored_node_keeps_its_front_in_front),
        T(normals_go_by_the_inverse_transpose),
        T(missing_normals_are_smooth_over_a_flat_ridge),
        T(missing_normals_keep_an_edge_of_90_degrees),
        T(triangles_without_area_are_dropped_and_counted),
        T(triangles_that_are_not_finite_are_dropped_with_one_warning),
        T(triangles_that_go_too_far_out_are_dropped_with_one_warning),
        T(points_and_lines_are_dropped_and_counted),
        T(a_ply_without_normals_is_imported),
        T(importing_twice_gives_the_same_bytes),
    };
    return cmocka_run_group_tests(tests, make_folder, NULL);
}
