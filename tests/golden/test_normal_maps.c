/* Normal maps, by light whose amount is known.
 *
 * Why this is hard: a map with an axis the wrong way round, or read as a colour, still looks bumpy. Strategy: a floor of one
 * material under one directional light, so that each pixel is albedo / pi times irradiance times the cosine of light and
 * normal, and a map of one texel, so that the normal is known. Against the same floor without the map all but the cosines falls
 * out. Where the map has nothing to say the floor's frames keep their bits. */
#include "scene_lab.h"

#include <math.h>

enum { EDGE = 16, FLOATS = 4 * EDGE * EDGE, HEADER = 18 };
#define CLOSE                                                                                                                  \
    3e-4 /* of the light: normals of samples are off by 6.6e-5 radians, map's by 1 / 2040 of a byte's step at coarse levels */

/* What a floor is of. */
typedef struct floor_case {
    const char *coordinates; /* four vt lines, or "" */
    const char *corners[4];  /* how the face names them */
    unsigned char map[3];    /* red, green, blue; all 0: no map */
    const char *light;       /* `position` of a directional light that shines at the origin */
    double eye;              /* height of the camera, which looks at the origin from aside */
    double scale;            /* of the map, in glTF; 0: the floor is an OBJ, which has none */
} floor_case;

#define PLAIN "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n" /* u along x, v up the picture along -z */
#define CORNERS                                                                                                                \
    { "1/1", "2/2", "3/3", "4/4" }

static void write_map(scene_lab *l, const unsigned char rgb[3]) {
    unsigned char bytes[HEADER + 12] = {[2] = 2, [12] = 2, [14] = 2, [16] = 24};
    for (int i = 0; i < 4; i++) /* blue first */
        for (int k = 0; k < 3; k++)
            bytes[HEADER + 3 * i + k] = rgb[2 - k];
    FILE *f = scene_lab_create(l, "map.tga");
    assert_int_equal(fwrite(bytes, 1, sizeof bytes, f), sizeof bytes);
    (void)fclose(f);
}

/* The floor as glTF, u along x, with the map of write_map(). */
static void write_gltf(scene_lab *l, double scale, bool mapped) {
    static const float at[20] = {-3, 0, 3, 3, 0, 3, 3, 0, -3, -3, 0, -3, 0, 1, 1, 1, 1, 0, 0, 0};
    static const uint16_t index[6] = {0, 1, 2, 0, 2, 3};
    FILE *f = scene_lab_create(l, "floor.bin");
    assert_int_equal(fwrite(at, sizeof at, 1, f) + fwrite(index, sizeof index, 1, f), 2);
    (void)fclose(f);
    f = scene_lab_create(l, "floor.gltf");
    (void)fprintf(f, "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0]}],\"nodes\":[{\"mesh\":0}],"
                     "\"images\":[{\"uri\":\"map.tga\"}],\"textures\":[{\"source\":0}],\"materials\":[{"
                     "\"pbrMetallicRoughness\":{\"baseColorFactor\":[0.5,0.5,0.5,1],\"metallicFactor\":0}");
    if (mapped)
        (void)fprintf(f, ",\"normalTexture\":{\"index\":0,\"scale\":%g}", scale);
    (void)fprintf(f, "}],\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0,\"TEXCOORD_0\":1},\"indices\":2,"
                     "\"material\":0}]}],\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":4,"
                     "\"type\":\"VEC3\",\"min\":[-3,0,-3],\"max\":[3,0,3]},{\"bufferView\":1,\"componentType\":5126,"
                     "\"count\":4,\"type\":\"VEC2\"},{\"bufferView\":2,\"componentType\":5123,\"count\":6,"
                     "\"type\":\"SCALAR\"}],\"bufferViews\":[{\"buffer\":0,\"byteLength\":48},{\"buffer\":0,"
                     "\"byteOffset\":48,\"byteLength\":32},{\"buffer\":0,\"byteOffset\":80,\"byteLength\":12}],"
                     "\"buffers\":[{\"byteLength\":92,\"uri\":\"floor.bin\"}]}");
    (void)fclose(f);
}

/* Radiance at the picture's centre; pixels: the whole frame, or NULL. */
static double look(scene_lab *l, const floor_case *c, const char *quality, float *pixels) {
    static float frame[FLOATS];
    const bool mapped = c->map[0] + c->map[1] + c->map[2] > 0;
    write_map(l, c->map);
    write_gltf(l, c->scale, mapped);
    FILE *f = scene_lab_create(l, "floor.mtl");
    (void)fprintf(f, "newmtl floor\nKd 0.5 0.5 0.5\n%s", mapped ? "norm map.tga\n" : "");
    (void)fclose(f);
    f = scene_lab_create(l, "floor.obj");
    (void)fprintf(f, "mtllib floor.mtl\nusemtl floor\nv -3 0 3\nv 3 0 3\nv 3 0 -3\nv -3 0 -3\n%sf %s %s %s %s\n",
                  c->coordinates, c->corners[0], c->corners[1], c->corners[2], c->corners[3]);
    (void)fclose(f);
    f = scene_lab_create(l, "floor.cfg");
    (void)fprintf(f,
                  "output: { width = %d; height = %d; frames = 1; };\nmeshes = ( { file = \"floor.%s\"; } );\n"
                  "camera: { keys = ( { eye = [0.5, %.1f, 1.0]; target = [0.0, 0.0, 0.0]; fov = 30.0; } ); };\n"
                  "lights = ( { type = \"directional\"; keys = ( { position = %s; target = [0.0, 0.0, 0.0]; "
                  "irradiance = [2.0, 2.0, 2.0]; } ); } );\nquality: { photons = 0; %s };\n",
                  EDGE, EDGE, c->scale > 0 ? "gltf" : "obj", c->eye, c->light, quality);
    (void)fclose(f);
    scene_lab_bake(l, "floor.cfg", "");
    scene_lab_play(l, "final", frame, FLOATS);
    if (pixels)
        memcpy(pixels, frame, sizeof frame);
    return (double)frame[4 * (EDGE / 2 * EDGE + EDGE / 2)];
}

static void unit(double v[3]) {
    const double length = sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    for (int k = 0; k < 3; k++)
        v[k] /= length;
}

/* The map's normal in the world: x along the first axis, y along the second, z along the seen side's normal. */
static void mapped_normal(const floor_case *c, const double x_axis[3], const double y_axis[3], const double up[3],
                          double n[3]) {
    const double scale = c->scale > 0 ? c->scale : 1;
    for (int k = 0; k < 3; k++)
        n[k] = scale * (c->map[0] / 127.5 - 1) * x_axis[k] + scale * (c->map[1] / 127.5 - 1) * y_axis[k] +
               (c->map[2] / 127.5 - 1) * up[k];
    unit(n);
}

static double cosine(const double n[3], const char *light) {
    double l[3];
    assert_int_equal(sscanf(light, "[%lf, %lf, %lf]", &l[0], &l[1], &l[2]), 3);
    unit(l);
    return fmax(n[0] * l[0] + n[1] * l[1] + n[2] * l[2], 0);
}

/* Light with the map over light without one is as their normals' cosines are. */
static void shines_as(scene_lab *l, const floor_case *c, const double n[3], const double up[3]) {
    floor_case plain = *c;
    memset(plain.map, 0, sizeof plain.map);
    const double bare = look(l, &plain, "", NULL), bent = look(l, c, "", NULL);
    const double want = cosine(n, c->light) / cosine(up, c->light);
    if (!(fabs(bent / bare - want) < CLOSE))
        fail_msg("map %d %d %d, light %s: %.6f of the bare floor's light, want %.6f", c->map[0], c->map[1], c->map[2], c->light,
                 bent / bare, want);
}

static const double axis_x[3] = {1, 0, 0}, axis_y[3] = {0, 1, 0}, minus_z[3] = {0, 0, -1}, minus_x[3] = {-1, 0, 0},
                    minus_y[3] = {0, -1, 0}, axis_z[3] = {0, 0, 1};

static void a_tilted_texel_is_a_tilted_floor(void **state) {
    static const unsigned char maps[][3] = {{204, 128, 230}, {128, 204, 230}, {60, 90, 220}, {20, 200, 160}};
    static const char *const lights[] = {"[3.0, 4.0, 1.0]", "[-2.0, 3.0, -2.0]"};
    for (size_t i = 0; i < sizeof maps / sizeof *maps; i++)
        for (int k = 0; k < 2; k++) {
            floor_case c = {PLAIN, CORNERS, {0}, lights[k], 2.0, 0};
            double n[3];
            memcpy(c.map, maps[i], sizeof c.map);
            mapped_normal(&c, axis_x, minus_z, axis_y, n);
            shines_as(*state, &c, n, axis_y);
        }
}

static void a_mirrored_picture_tilts_the_other_way(void **state) {
    const floor_case c = {"vt 1 0\nvt 0 0\nvt 0 1\nvt 1 1\n", CORNERS, {204, 90, 220}, "[3.0, 4.0, 1.0]", 2.0, 0};
    double n[3];
    mapped_normal(&c, minus_x, minus_z, axis_y, n);
    shines_as(*state, &c, n, axis_y);
}

static void a_turned_picture_tilts_as_it_lies(void **state) {
    const floor_case c = {"vt 0 1\nvt 0 0\nvt 1 0\nvt 1 1\n", CORNERS, {204, 90, 220}, "[3.0, 4.0, 1.0]", 2.0, 0};
    double n[3];
    mapped_normal(&c, minus_z, minus_x, axis_y, n);
    shines_as(*state, &c, n, axis_y);
}

/* glTF's scale is of x and y. */
static void a_scale_tilts_less_or_more(void **state) {
    static const double scales[] = {0.5, 1, 2};
    for (size_t i = 0; i < sizeof scales / sizeof *scales; i++) {
        const floor_case c = {PLAIN, CORNERS, {160, 128, 240}, "[3.0, 4.0, 0.0]", 2.0, scales[i]};
        double n[3];
        mapped_normal(&c, axis_x, minus_z, axis_y, n);
        shines_as(*state, &c, n, axis_y);
    }
}

/* What stands out on one side is a dent on the other. */
static void from_behind_the_normal_is_turned_round(void **state) {
    const floor_case c = {PLAIN, CORNERS, {204, 90, 220}, "[3.0, -4.0, 1.0]", -2.0, 0};
    double n[3];
    mapped_normal(&c, minus_x, axis_z, minus_y, n);
    shines_as(*state, &c, n, minus_y);
}

/* Its part along the face's normal is made VIT_NORMAL_ABOVE: 1/16. */
static void a_normal_behind_the_face_is_brought_before_it(void **state) {
    floor_case c = {PLAIN, CORNERS, {230, 128, 40}, "[4.0, 1.0, 0.0]", 2.0, 0};
    double n[3];
    mapped_normal(&c, axis_x, minus_z, axis_y, n);
    assert_true(n[1] < 0);
    n[1] = 0.0625;
    unit(n);
    shines_as(*state, &c, n, axis_y);
}

static void keeps_the_bits(scene_lab *l, const floor_case *c, const char *quality) {
    float with[FLOATS], without[FLOATS];
    floor_case plain = *c;
    memset(plain.map, 0, sizeof plain.map);
    (void)look(l, c, quality, with);
    (void)look(l, &plain, quality, without);
    assert_memory_equal(with, without, sizeof with);
}

static void without_coordinates_nothing_is_bent(void **state) {
    const floor_case none = {"", {"1", "2", "3", "4"}, {204, 128, 230}, "[3.0, 4.0, 1.0]", 2.0, 0},
                     one = {"vt 0.5 0.5\n", {"1/1", "2/1", "3/1", "4/1"}, {204, 128, 230}, "[3.0, 4.0, 1.0]", 2.0, 0};
    keeps_the_bits(*state, &none, "");
    keeps_the_bits(*state, &one, "");
}

static void the_setting_leaves_it_out(void **state) {
    const floor_case c = {PLAIN, CORNERS, {204, 128, 230}, "[3.0, 4.0, 1.0]", 2.0, 0};
    keeps_the_bits(*state, &c, "normal_maps = false;");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_tilted_texel_is_a_tilted_floor),
        cmocka_unit_test(a_mirrored_picture_tilts_the_other_way),
        cmocka_unit_test(a_turned_picture_tilts_as_it_lies),
        cmocka_unit_test(a_scale_tilts_less_or_more),
        cmocka_unit_test(from_behind_the_normal_is_turned_round),
        cmocka_unit_test(a_normal_behind_the_face_is_brought_before_it),
        cmocka_unit_test(without_coordinates_nothing_is_bent),
        cmocka_unit_test(the_setting_leaves_it_out),
    };
    return cmocka_run_group_tests(tests, scene_lab_set_up, scene_lab_tear_down);
}
