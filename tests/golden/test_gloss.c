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

static void bake_floor(scene_lab *l, double metallic, double roughness) {
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
                  base[0], base[1], base[2], metallic, roughness);
    (void)fclose(f);
    f = scene_lab_create(l, "scene.cfg");
    (void)fprintf(
        f,
        "output: { width = %d; height = %d; frames = 1; };\nmeshes = ( { file = \"floor.gltf\"; } );\n"
        "camera: { keys = ( { eye = [0.0, %.1f, 0.0]; target = [0.0, 0.0, 0.0]; up = [0.0, 0.0, -1.0]; fov = %.9g; } ); };\n"
        "lights = ( { type = \"point\"; keys = ( { position = [%.3f, %.3f, %.3f]; power = [%g, %g, %g]; } ); } );\n"
        "quality: { photons = 0; lobe = \"ggx\"; };\n",
        SIDE, SIDE, HEIGHT, 2.0 * atan(EDGE / HEIGHT) * 180.0 / PI, lamp[0], lamp[1], lamp[2], POWER, POWER, POWER);
    (void)fclose(f);
    scene_lab_bake(l, "scene.cfg", "");
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
    scene_lab *l = *state;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        bake_floor(l, cases[i][0], cases[i][1]);
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

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(floors_shine_as_gltf_says),
    };
    return cmocka_run_group_tests(tests, scene_lab_set_up, scene_lab_tear_down);
}
