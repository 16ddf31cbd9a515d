/* What the importer mends in Assimp's scenes before anything walks them, on scenes made here in memory: no file is read. */
#include "import/assimp/assimp_scene.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

/* A mesh of four vertices with up to two faces. */
typedef struct lab {
    struct aiVector3D position[4];
    unsigned index[2][IMPORT_CORNERS + 1];
    struct aiFace faces[2];
    struct aiMesh mesh;
    struct aiMesh *meshes[1];
    struct aiScene scene;
    importer im;
    assimp_scene a;
    vit_text why;
} lab;

static lab *make_lab(unsigned first, unsigned second) {
    lab *l = calloc(1, sizeof *l);
    assert_non_null(l);
    const struct aiVector3D corners[4] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    memcpy(l->position, corners, sizeof corners);
    for (unsigned f = 0; f < 2; f++) {
        for (unsigned k = 0; k <= IMPORT_CORNERS; k++)
            l->index[f][k] = k % 4;
        l->faces[f] = (struct aiFace){.mNumIndices = f ? second : first, .mIndices = l->index[f]};
    }
    l->mesh.mPrimitiveTypes = aiPrimitiveType_TRIANGLE | aiPrimitiveType_POLYGON;
    l->mesh.mNumVertices = 4;
    l->mesh.mVertices = l->position;
    l->mesh.mNumFaces = 2;
    l->mesh.mFaces = l->faces;
    l->meshes[0] = &l->mesh;
    l->scene.mNumMeshes = 1;
    l->scene.mMeshes = l->meshes;
    l->a.im = &l->im;
    l->a.ai = &l->scene;
    l->im.why = &l->why;
    l->im.file = "made here";
    return l;
}

static void drop_lab(lab *l) {
    assimp_free_cuts(&l->a);
    free(l);
}

static void a_polygon_with_a_bad_index_is_emptied_and_counted(void **state) {
    lab *l = make_lab(4, 3);
    (void)state;
    l->index[0][3] = 77;
    assert_true(assimp_triangulate(&l->a));
    assert_true(l->im.bad_polygon == 1 && l->faces[0].mNumIndices == 0 && l->faces[1].mNumIndices == 3);
    drop_lab(l);
}

static void so_is_one_of_too_many_corners(void **state) {
    lab *l = make_lab(3, IMPORT_CORNERS + 1);
    (void)state;
    assert_true(assimp_triangulate(&l->a));
    assert_true(l->im.bad_polygon == 1 && l->faces[0].mNumIndices == 3 && l->faces[1].mNumIndices == 0);
    drop_lab(l);
}

/* Assimp's cutter must not be called for it: the mesh no longer says that it has polygons. */
static void a_mesh_without_a_polygon_to_cut_says_so(void **state) {
    lab *l = make_lab(3, 0);
    (void)state;
    assert_true(assimp_triangulate(&l->a));
    assert_ptr_equal(l->a.ai, &l->scene);
    assert_true(l->im.bad_polygon == 0 && l->mesh.mPrimitiveTypes == aiPrimitiveType_TRIANGLE);
    drop_lab(l);
}

static void lists_with_holes_have_none_afterwards(void **state) {
    lab *l = make_lab(3, 3);
    struct aiNode root, child;
    struct aiNode *children[3] = {NULL, &child, NULL};
    unsigned meshes[2] = {0, 5};
    (void)state;
    memset(&root, 0, sizeof root);
    memset(&child, 0, sizeof child);
    root.mNumChildren = 3;
    root.mChildren = children;
    child.mNumMeshes = 2;
    child.mMeshes = meshes;
    l->scene.mRootNode = &root;
    assert_true(assimp_mend_tree(&l->a));
    assert_true(root.mNumChildren == 1 && root.mChildren[0] == &child && l->a.lost_nodes == 2);
    drop_lab(l);
}

static void a_face_whose_corners_are_missing_is_refused(void **state) {
    lab *l = make_lab(3, 3);
    (void)state;
    l->faces[1].mIndices = NULL;
    assert_false(assimp_mend_tree(&l->a));
    assert_non_null(strstr(l->why.text, "mesh 0 has faces without corners"));
    drop_lab(l);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_polygon_with_a_bad_index_is_emptied_and_counted),
        cmocka_unit_test(so_is_one_of_too_many_corners),
        cmocka_unit_test(a_mesh_without_a_polygon_to_cut_says_so),
        cmocka_unit_test(lists_with_holes_have_none_afterwards),
        cmocka_unit_test(a_face_whose_corners_are_missing_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
