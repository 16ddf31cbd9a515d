/* Textured pixels against the integral that they stand for: the mean of the texture over the pixel.
 *
 * Why this is hard: each step (the importer's v, sRGB to linear, texel centres, wrapping, mip levels, samples of anti-aliasing)
 * can be off by a little and the picture still looks right. Strategy: a wall or a floor, textured with random texels (no
 * symmetry forgives a shift or a flip), under ambient light of radiance 1, so that a pixel is the mean of its reflectances; the
 * right value is that mean over a dense grid in each pixel, of a bilinear filter of the linear image written in doubles, with
 * no mip level and nothing of the product. */
#include "scene_lab.h"
#include <math.h>
#include <stdint.h>

enum { WIDTH = 96, HEIGHT = 54, EDGE = 64, DENSE = 24 };

static const double fov = 0.8; /* radians, vertical */

typedef struct vec {
    double x, y, z;
} vec;

/* Where a camera looks at a textured plane: a wall of z = 0 or a floor of y = 0, `tile` metres a repetition. */
typedef struct shot {
    vec eye, target;
    bool floor;
    double tile;
    const char *quality;
    double most; /* NMSE */
} shot;

static uint8_t image[EDGE][EDGE][3]; /* sRGB, top row first */

static void make_image(void) {
    uint32_t random = 7;
    for (int y = 0; y < EDGE; y++)
        for (int x = 0; x < EDGE; x++)
            for (int k = 0; k < 3; k++) {
                random = random * 1664525u + 1013904223u;
                image[y][x][k] = (uint8_t)(random >> 24);
            }
}

static double linear(uint8_t srgb) {
    const double c = srgb / 255.0;
    return c <= 0.04045 ? c / 12.92 : pow((c + 0.055) / 1.055, 2.4);
}

static double linear_image[EDGE][EDGE][3];

/* Bilinear, repeated; u to the right, v downwards, 1 the whole image. */
static void add_texture(double u, double v, double sum[3]) {
    const double x = u * EDGE - 0.5, y = v * EDGE - 0.5, fx = x - floor(x), fy = y - floor(y);
    const int x0 = (int)((int64_t)floor(x) & (EDGE - 1)), y0 = (int)((int64_t)floor(y) & (EDGE - 1)), x1 = (x0 + 1) % EDGE,
              y1 = (y0 + 1) % EDGE;
    for (int k = 0; k < 3; k++)
        sum[k] += (1 - fy) * ((1 - fx) * linear_image[y0][x0][k] + fx * linear_image[y0][x1][k]) +
                  fy * ((1 - fx) * linear_image[y1][x0][k] + fx * linear_image[y1][x1][k]);
}

static vec sub(vec a, vec b) {
    return (vec){a.x - b.x, a.y - b.y, a.z - b.z};
}

static vec cross(vec a, vec b) {
    return (vec){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

static vec unit(vec a) {
    const double n = sqrt(a.x * a.x + a.y * a.y + a.z * a.z);
    return (vec){a.x / n, a.y / n, a.z / n};
}

static vec along(vec a, vec d, double t) {
    return (vec){a.x + d.x * t, a.y + d.y * t, a.z + d.z * t};
}

/* What a point of the frame, in pixels, sees of the texture. */
static void add_point(const shot *s, double px, double py, double sum[3]) {
    const vec forward = unit(sub(s->target, s->eye)), right = unit(cross(forward, (vec){0, 1, 0})), up = cross(right, forward);
    const double half = tan(fov / 2), x = (2 * px / WIDTH - 1) * half * WIDTH / HEIGHT, y = (1 - 2 * py / HEIGHT) * half;
    const vec d = along(along(forward, right, x), up, y);
    const vec at = along(s->eye, d, s->floor ? -s->eye.y / d.y : -s->eye.z / d.z);
    add_texture(at.x / s->tile, (s->floor ? at.z : -at.y) / s->tile, sum);
}

static void write_scene(scene_lab *l, const shot *s) {
    const double far = 40;
    FILE *f = scene_lab_create(l, "noise.tga");
    const uint8_t head[18] = {[2] = 2, [12] = EDGE, [14] = EDGE, [16] = 24, [17] = 0x20};
    assert_int_equal(fwrite(head, 1, sizeof head, f), sizeof head);
    for (int y = 0; y < EDGE; y++)
        for (int x = 0; x < EDGE; x++)
            for (int k = 2; k >= 0; k--)
                (void)fputc(image[y][x][k], f);
    (void)fclose(f);
    f = scene_lab_create(l, "plane.mtl");
    (void)fputs("newmtl noise\nKd 1 1 1\nmap_Kd noise.tga\n", f);
    (void)fclose(f);
    f = scene_lab_create(l, "plane.obj");
    (void)fputs("mtllib plane.mtl\nusemtl noise\n", f);
    for (int i = 0; i < 4; i++) { /* of a texture, v goes upwards in OBJ; on the floor that is away from the camera */
        const double x = i == 1 || i == 2 ? far : -far, y = i >= 2 ? far : -far;
        (void)fprintf(f, "v %.9g %.9g %.9g\nvt %.9g %.9g\n", x, s->floor ? 0 : y, s->floor ? -y : 0, x / s->tile, y / s->tile);
    }
    (void)fputs("f 1/1 2/2 3/3 4/4\n", f);
    (void)fclose(f);
    f = scene_lab_create(l, "scene.cfg");
    (void)fprintf(f,
                  "output: { width = %d; height = %d; frames = 1; };\nambient = [1.0, 1.0, 1.0];\nmeshes = ( { file = "
                  "\"plane.obj\"; } );\n"
                  "camera: { keys = ( { eye = [%.9f, %.9f, %.9f]; target = [%.9f, %.9f, %.9f]; fov = %.12f; } ); };\n"
                  "quality: { photons = 0; %s };\n",
                  WIDTH, HEIGHT, s->eye.x, s->eye.y, s->eye.z, s->target.x, s->target.y, s->target.z,
                  fov * 180 / 3.14159265358979323846, s->quality);
    (void)fclose(f);
}

static void check(void **state, const shot *s) {
    static float pixels[WIDTH * HEIGHT * 4];
    write_scene(*state, s);
    scene_lab_bake(*state, "scene.cfg", "");
    scene_lab_play(*state, "direct", pixels, WIDTH * HEIGHT * 4);
    double squares = 0, sum = 0, mine = 0;
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++) {
            double right[3] = {0};
            for (int i = 0; i < DENSE * DENSE; i++)
                add_point(s, x + (i % DENSE + 0.5) / DENSE, y + (i / DENSE + 0.5) / DENSE, right);
            for (int k = 0; k < 3; k++) {
                const double value = right[k] / (DENSE * DENSE), got = (double)pixels[(y * WIDTH + x) * 4 + k];
                squares += (got - value) * (got - value);
                sum += value;
                mine += got;
            }
        }
    const double count = 3.0 * WIDTH * HEIGHT, nmse = squares / count / (sum / count) / (sum / count);
    print_message("NMSE %.6f, of right %.5f\n", nmse, mine / sum);
    assert_true(nmse < s->most);
    assert_true(fabs(mine / sum - 1) < 0.005);
}

#define ALL "antialias = 16; antialias_contrast = 0.0;"

static void a_wall_near_by_shows_bilinear_texels_in_linear_light(void **state) {
    check(state, &(shot){{0.3, 0.2, 1}, {0.3, 0.2, 0}, false, 4, "", 1e-4}); /* 5 pixels a texel */
    check(state, &(shot){{0.3, 0.2, 1}, {0.3, 0.2, 0}, false, 4, ALL, 1e-4});
}

static void all_samples_of_a_pixel_average_the_texture_over_the_pixel_and_no_wider(void **state) {
    check(state, &(shot){{0.3, 0.2, 6}, {0.3, 0.2, 0}, false, 4, ALL, 0.003});  /* 1.2 pixels a texel */
    check(state, &(shot){{0.3, 0.2, 13}, {0.3, 0.2, 0}, false, 4, ALL, 0.003}); /* 0.4 */
    check(state, &(shot){{0, 1, 0}, {0, 0, -2}, true, 4, ALL, 0.003});
}

static void one_sample_a_pixel_averages_by_mip_levels(void **state) {
    check(state, &(shot){{0.3, 0.2, 13}, {0.3, 0.2, 0}, false, 4, "texture_filter = \"trilinear\";", 0.03});
}

int main(void) {
    make_image();
    for (int y = 0; y < EDGE; y++)
        for (int x = 0; x < EDGE; x++)
            for (int k = 0; k < 3; k++)
                linear_image[y][x][k] = linear(image[y][x][k]);
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_wall_near_by_shows_bilinear_texels_in_linear_light),
        cmocka_unit_test(all_samples_of_a_pixel_average_the_texture_over_the_pixel_and_no_wider),
        cmocka_unit_test(one_sample_a_pixel_averages_by_mip_levels),
    };
    return cmocka_run_group_tests(tests, scene_lab_set_up, scene_lab_tear_down);
}
