/* Glossy floors seen from above through the real programs: every pixel's radiance is glTF 2.0's own formula (appendix B, in
 * double) of where the pixel looks, of the lamp and of what the file says of metalness, roughness and base colour. So a lobe
 * that is scaled, turned or mapped wrongly anywhere between the file and the frame shows as a figure, and as a pixel. */
#include "scene_lab.h"

#include <math.h>

#define PI 3.14159265358979323846
enum { SIDE = 48 }; /* pixels of the frame's edge */
#define FLOATS ((size_t)4 * SIDE * SIDE)
#define HEIGHT 0.8 /* of the camera, m: low, so that Fresnel matters */
#define EDGE 2.4   /* half of what it sees of the floor, m */
#define POWER 80.0 /* of the lamp, W */
static const double lamp[3] = {2.0, 0.3, -0.5};
static const double base[3] = {0.8, 0.5, 0.2};

/* more: of the scene file. */
static void bake_floor(scene_lab *l, const double color[3], double metallic, double roughness, const char *more,
                       const char *options) {
    FILE *f = scene_lab_create(l, "floor.gltf");
    (void)fprintf(f,
                  "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0]}],\"nodes\":[{\"mesh\":0}],"
                  "\"materials\":[{\"name\":\"floor\",\"pbrMetallicRoughness\":{\"baseColorFactor\":[%g,%g,%g,1],"
                  "\"metallicFactor\":%g,\"roughnessFactor\":%g}}],"
                  "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"indices\":1,\"material\":0}]}],"
                  "\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":4,\"type\":\"VEC3\",\"min\":[-5,0,-5],"
                  "\"max\":[5,0,5]},{\"bufferView\":1,\"componentType\":5123,\"count\":6,\"type\":\"SCALAR\"}],"
                  "\"bufferViews\":[{\"buffer\":0,\"byteLength\":48},{\"buffer\":0,\"byteOffset\":48,\"byteLength\":12}],"
                  "\"buffers\":[{\"byteLength\":60,\"uri\":\"data:application/octet-stream;base64,"
                  "AACgwAAAAAAAAKBAAACgQAAAAAAAAKBAAACgQAAAAAAAAKDAAACgwAAAAAAAAKDAAAABAAIAAAACAAMA\"}]}",
                  color[0], color[1], color[2], metallic, roughness);
    (void)fclose(f);
    f = scene_lab_create(l, "scene.cfg");
    (void)fprintf(
        f,
        "output: { width = %d; height = %d; frames = 1; };\n"
        "camera: { keys = ( { eye = [0.0, %.1f, 0.0]; target = [0.0, 0.0, 0.0]; up = [0.0, 0.0, -1.0]; fov = %.9g; } ); };\n%s",
        SIDE, SIDE, HEIGHT, 2.0 * atan(EDGE / HEIGHT) * 180.0 / PI, more);
    (void)fclose(f);
    scene_lab_bake(l, "scene.cfg", options);
}

static double unit(double v[3]) {
    const double length = sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    for (int k = 0; k < 3; k++)
        v[k] /= length;
    return length;
}

/* Radiance of the floor at (x, z), channel c: f_diffuse + f_specular (B.3.5), the metal's and the dielectric's mixed; `more`:
 * added to both reflectances. */
static double due(double x, double z, int c, const double material[2], double more) {
    const double metallic = material[0], roughness = material[1];
    double v[3] = {-x, HEIGHT, -z}, l[3] = {lamp[0] - x, lamp[1], lamp[2] - z}, h[3];
    (void)unit(v);
    const double d = unit(l), a2 = pow(roughness, 4), nl = l[1], nv = v[1];
    for (int k = 0; k < 3; k++)
        h[k] = l[k] + v[k];
    (void)unit(h);
    const double q = h[1] * h[1] * (a2 - 1) + 1,
                 lobe = a2 / (PI * q * q) * 0.5 / (nl * sqrt(nv * nv * (1 - a2) + a2) + nv * sqrt(nl * nl * (1 - a2) + a2));
    const double x5 = pow(1 - (v[0] * h[0] + v[1] * h[1] + v[2] * h[2]), 5), f0 = 0.04 + (base[c] - 0.04) * metallic + more,
                 fresnel = f0 + (1 - f0) * x5;
    /* 1 - F of the dielectric: 0.96 (1 - x5). */
    const double matt = ((1 - metallic) * base[c] * 0.96 + more) * (1 - x5) / PI;
    return (matt + fresnel * lobe) * POWER / (4 * PI) / (d * d) * nl;
}

/* Reflectances have ten bits a channel, the rest 1/100: places are a little before surfaces. */
static void floors_shine_as_gltf_says(void **state) {
    static const double cases[][2] = {{1, 0.3}, {1, 0.6}, {1, 1}, {0, 0.3}, {0, 0.7}, {0.5, 0.5}};
    static float pixels[FLOATS];
    char scene[512];
    scene_lab *l = *state;
    (void)snprintf(
        scene, sizeof scene,
        "meshes = ( { file = \"floor.gltf\"; } );\nlights = ( { type = \"point\"; keys = ( { position = [%.3f, %.3f, "
        "%.3f]; power = [%g, %g, %g]; } ); } );\nquality: { photons = 0; lobe = \"ggx\"; };\n",
        lamp[0], lamp[1], lamp[2], POWER, POWER, POWER);
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        bake_floor(l, base, cases[i][0], cases[i][1], scene, "");
        scene_lab_play(l, "final", pixels, FLOATS);
        for (int p = 0; p < SIDE * SIDE; p++)
            for (int c = 0; c < 3; c++) {
                const double x = EDGE * (2.0 * (p % SIDE + 0.5) / SIDE - 1), z = EDGE * (2.0 * (p / SIDE + 0.5) / SIDE - 1),
                             least = due(x, z, c, cases[i], -0.5 / 1023), most = due(x, z, c, cases[i], 0.5 / 1023),
                             is = (double)pixels[4 * p + c];
                if (!(is >= least * 0.99 && is <= most * 1.01))
                    fail_msg("metalness %g, roughness %g, pixel %d, %d, channel %d: %g, due %g to %g", cases[i][0], cases[i][1],
                             p % SIDE, p / SIDE, c, is, least, most);
            }
    }
}

/* Radiance by an even sky of radiance 1, seen at cosine nv: the integral of the lobe over directions of light, and the matt
 * part without what Fresnel's term takes of it, which is 3 % of that part at most. */
static double due_of_sky(double nv, int c, const double material[2]) {
    enum { STEPS = 300 };
    const double a2 = pow(material[1], 4), f0 = 0.04 + (base[c] - 0.04) * material[0], v[2] = {sqrt(1 - nv * nv), nv};
    double sum = 0;
    for (int a = 0; a < STEPS; a++)
        for (int b = 0; b < STEPS; b++) {
            const double nl = (a + 0.5) / STEPS, s = sqrt(1 - nl * nl),
                         turn = PI * (b + 0.5) / STEPS; /* and its mirror image */
            double h[3] = {s * cos(turn) + v[0], nl + v[1], s * sin(turn)};
            (void)unit(h);
            const double q = h[1] * h[1] * (a2 - 1) + 1, x5 = pow(1 - (v[0] * h[0] + v[1] * h[1]), 5),
                         smith = nl * sqrt(nv * nv * (1 - a2) + a2) + nv * sqrt(nl * nl * (1 - a2) + a2);
            sum += a2 / (PI * q * q) * 0.5 / smith * (f0 + (1 - f0) * x5) * nl * 2 * PI / STEPS / STEPS;
        }
    return sum + (1 - material[0]) * base[c] * 0.96;
}

static void floors_reflect_the_sky_as_gltf_says(void **state) {
    static const double cases[][2] = {{1, 0.3}, {1, 0.6}, {1, 1}, {0, 0.5}};
    static float pixels[FLOATS];
    scene_lab *l = *state;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        bake_floor(
            l, base, cases[i][0], cases[i][1],
            "meshes = ( { file = \"floor.gltf\"; } );\nlights = ();\nbackground = [1.0, 1.0, 1.0]; sky: { light = true; };\n"
            "quality: { photons = 0; lobe = \"ggx\"; gloss_rays = 16; };\n",
            "");
        scene_lab_play(l, "final", pixels, FLOATS);
        for (int p = SIDE / 2 * SIDE; p < SIDE * SIDE; p += SIDE + 3)
            for (int c = 0; c < 3; c += 2) {
                const double x = EDGE * (2.0 * (p % SIDE + 0.5) / SIDE - 1), z = EDGE * (2.0 * (p / SIDE + 0.5) / SIDE - 1),
                             want = due_of_sky(HEIGHT / sqrt(x * x + z * z + HEIGHT * HEIGHT), c, cases[i]),
                             is = (double)pixels[4 * p + c];
                const bool edge =
                    p % SIDE < 2 || p % SIDE > SIDE - 3 || p / SIDE > SIDE - 3; /* whose windows lie beside them */
                if (!edge && !(fabs(is / want - 1) < 0.03))
                    fail_msg("metalness %g, roughness %g, pixel %d, %d, channel %d: %g, due %g", cases[i][0], cases[i][1],
                             p % SIDE, p / SIDE, c, is, want);
            }
    }
}

/* A wall behind the floor, lit by a spot that the floor has no light of; the floor lights nothing that is seen. */
static void the_smoothest_metal_shows_what_a_mirror_shows(void **state) {
    static const char wall[] = "usemtl wall\nv -3 0 -2\nv 3 0 -2\nv 3 2 -2\nv -3 2 -2\nf 1 2 3 4\n";
    static const double white[3] = {1, 1, 1};
    static float mirror[FLOATS], metal[FLOATS];
    scene_lab *l = *state;
    double sum[2] = {0}, off = 0, square = 0;
    FILE *f = scene_lab_create(l, "wall.obj");
    (void)fputs(wall, f);
    (void)fclose(f);
#define WALL(floor)                                                                                                            \
    "meshes = ( { file = \"floor.gltf\"; }, { file = \"wall.obj\"; } );\nmaterials = ( { name = \"floor\"; " floor " } );\n"   \
    "lights = ( { type = \"spot\"; inner = 15.0; outer = 25.0; keys = ( { position = [0.5, 1.0, -1.0]; target = [0.0, 1.2, "   \
    "-2.0]; power = [50.0, 40.0, 30.0]; } ); } );\nquality: { lobe = \"ggx\"; };\n"
#define BASIS "--indirect basis --receiver-rays 64 --receiver-spacing 24 --bounces 2"
    bake_floor(l, white, 1, 0, WALL("kind = \"mirror\"; specular = [1.0, 1.0, 1.0];"), BASIS);
    scene_lab_play(l, "final", mirror, FLOATS);
    bake_floor(l, white, 1, 0, WALL("kind = \"matt\"; color = [0.0, 0.0, 0.0]; specular = [1.0, 1.0, 1.0]; roughness = 0.0;"),
               BASIS);
    scene_lab_play(l, "final", metal, FLOATS);
    for (int p = 0; p < SIDE * SIDE; p++) {
        const double z = EDGE * (2.0 * (p / SIDE + 0.5) / SIDE - 1);
        for (int c = 0; c < 3 && z > -1.9; c++) {
            const double a = (double)mirror[4 * p + c], b = (double)metal[4 * p + c];
            sum[0] += a;
            sum[1] += b;
            off += (b - a) * (b - a);
            square += a * a;
        }
    }
    if (!(sum[0] > 1) || !(fabs(sum[1] / sum[0] - 1) < 0.03) || !(off / square < 0.02))
        fail_msg("light %g, of a mirror %g; squared error %g of the mirror's", sum[1], sum[0], off / square);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(floors_shine_as_gltf_says),
        cmocka_unit_test(floors_reflect_the_sky_as_gltf_says),
        cmocka_unit_test(the_smoothest_metal_shows_what_a_mirror_shows),
    };
    return cmocka_run_group_tests(tests, scene_lab_set_up, scene_lab_tear_down);
}
