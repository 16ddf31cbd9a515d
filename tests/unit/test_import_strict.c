/* What a mesh file says and a bake leaves out. What is hard: each reader has its own words for it, and a loss that only one of
 * them tells of is silent in the others. Strategy: small files that lose one thing each; a bake says so in one warning, a
 * strict one ends with the same words. */
#define FOLDER VIT_BUILD_DIR "/tests/unit/import_strict"
#include "gltf_lab.h"

#define OBJ FILE_OF("a.obj")
#define GLTF FILE_OF("quad.gltf")
#define CORNERS "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"
#define PLAIN MATERIAL(BASE("\"baseColorFactor\":[1,1,1,1]"))

static void said_and_refused(const char *path, const char *words) {
    model m;
    import_good(path, &m);
    check_promises(&m);
    model_free(&m);
    if (!strstr(warnings, words) || strchr(warnings, '\n') != warnings + strlen(warnings) - 1)
        fail_msg("not '%s', once, in '%s'", words, warnings);
    refuse(path, true, words);
}

static void obj_loses(const char *text, const char *words) {
    put(OBJ, text);
    said_and_refused(OBJ, words);
}

static void triangles_that_cannot_be_shown(void **state) {
    (void)state;
    obj_loses(CORNERS "v nan 0 0\nf 1 2 3\nf 1 2 5\n", "1 triangles with positions that are not finite dropped");
    obj_loses(CORNERS "v 1e20 0 0\nf 1 2 3\nf 1 2 5\n", "1 triangles with a vertex farther out than 1e+09 m dropped");
    obj_loses(CORNERS "f 1 2 3\nf 1 2 7\n", "1 triangles with an index out of range dropped");
    obj_loses(CORNERS "f 1 2 3\nf 1 2 3 7\n", "1 polygons with an index out of range");
}

static void points_and_lines(void **state) {
    (void)state;
    obj_loses(CORNERS "f 1 2 3\np 1 2\nl 1 2 3 4\n", "5 points and lines are left out");
}

static void triangles_of_transparent_materials(void **state) {
    (void)state;
    put(FILE_OF("a.mtl"), "newmtl glass\nKd 1 1 1\nd 0.2\nnewmtl wall\nKd 1 1 1\nd 1\n");
    obj_loses("mtllib a.mtl\n" CORNERS "usemtl wall\nf 1 2 3\nusemtl glass\nf 1 3 4\n",
              "1 triangles of transparent materials ('glass') are left as holes");
}

static void colours_of_vertices_that_vary(void **state) {
    (void)state;
    put_gltf(",\"COLOR_0\":4", ONE_NODE "," PLAIN);
    said_and_refused(GLTF, "vertex colours that vary over a mesh are left out");
    obj_loses("v 0 0 0 1 0 0\nv 1 0 0 0 1 0\nv 0 1 0 0 0 1\nf 1 2 3\n", "vertex colours that vary over a mesh are left out");
}

static void textures_of_meshes_without_coordinates(void **state) {
    (void)state;
    put_image(FILE_OF("image.tga"), 255);
    put_gltf("", ONE_NODE ",\"textures\":[{\"source\":0}],\"images\":[{\"uri\":\"image.tga\"}],"
                          "\"materials\":[{\"name\":\"m\",\"pbrMetallicRoughness\":{\"baseColorTexture\":{\"index\":0}}}]");
    said_and_refused(GLTF, "have no texture coordinates: of its texture they show one colour");
}

static void cameras_and_lights_that_are_none_of_ours(void **state) {
    (void)state;
#define CAMERA(type, node)                                                                                                     \
    "\"cameras\":[{\"type\":\"" type "\"}],\"scenes\":[{\"nodes\":[0,1]}],"                                                    \
    "\"nodes\":[{\"mesh\":0},{\"name\":\"C\",\"camera\":0" node "}]," PLAIN
    put_gltf("", CAMERA("orthographic", ""));
    said_and_refused(GLTF, "camera 'C' is orthographic");
    put_gltf("", CAMERA("perspective", ",\"scale\":[0,0,0]"));
    said_and_refused(GLTF, "camera 'C' has no direction; it is left out");
    put_gltf("", "\"extensionsUsed\":[\"KHR_lights_punctual\"],\"extensions\":{\"KHR_lights_punctual\":{\"lights\":["
                 "{\"type\":\"point\",\"intensity\":-1}]}},\"scenes\":[{\"nodes\":[0,1]}],\"nodes\":[{\"mesh\":0},"
                 "{\"name\":\"L\",\"extensions\":{\"KHR_lights_punctual\":{\"light\":0}}}]," PLAIN);
    said_and_refused(GLTF, "light 'L' has a negative intensity; it is left out");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        T(triangles_that_cannot_be_shown),         T(points_and_lines),
        T(triangles_of_transparent_materials),     T(colours_of_vertices_that_vary),
        T(textures_of_meshes_without_coordinates), T(cameras_and_lights_that_are_none_of_ours),
    };
    return cmocka_run_group_tests(tests, make_folder, NULL);
}
