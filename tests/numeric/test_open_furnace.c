/* Each material under an even sky, by the runtime: what gives back all light cannot be told from the sky; and glass on a floor.
 *
 * What can go wrong: a kernel gains or loses light where it splits, reflects, refracts or adds it up, in a way that no picture
 * betrays. A convex body sees nothing but the sky, of radiance 1 from everywhere: white paint, mirrors and glass that do not
 * absorb, whatever the shape and the number of reflections, have radiance 1 at each pixel; a lobe has the albedo of its
 * reflectance at that angle, integrated here; glass that absorbs, less. White paint and lobes see the sky by its fixed
 * directions, whose error falls with their number; the others follow rays and know none. */
#include "catalogue.h"
#include "scene_lab.h"
#include <math.h>

#define PI 3.14159265358979
#define DISTANCE 4.0 /* of the eye from the middle of the ball of radius 1, m */
#define LIMIT 0.97   /* of the ball's silhouette, so that the mesh is surely hit */
enum { SIDE = 64, FLOATS = 4 * SIDE * SIDE, ROWS = 36 };

/* Latitudes and longitudes, wound outwards. */
static void write_ball(scene_lab *l) {
    FILE *f = scene_lab_create(l, "ball.mtl");
    (void)fprintf(f, "newmtl ball\nKd 1 1 1\n");
    (void)fclose(f);
    f = scene_lab_create(l, "ball.obj");
    (void)fprintf(f, "mtllib ball.mtl\nusemtl ball\n");
    for (int i = 0; i <= ROWS; i++)
        for (int j = 0; j <= 2 * ROWS; j++) {
            const double a = PI * i / ROWS, b = PI * j / ROWS, n[3] = {sin(a) * cos(b), cos(a), sin(a) * sin(b)};
            (void)fprintf(f, "v %.9g %.9g %.9g\nvn %.9g %.9g %.9g\n", n[0], n[1], n[2], n[0], n[1], n[2]);
        }
    for (int i = 0; i < ROWS; i++)
        for (int j = 0; j < 2 * ROWS; j++) {
            const int a = 1 + i * (2 * ROWS + 1) + j, b = a + 1, c = a + 2 * ROWS + 1, d = c + 1;
            if (i > 0)
                (void)fprintf(f, "f %d//%d %d//%d %d//%d\n", a, a, b, b, d, d);
            if (i + 1 < ROWS)
                (void)fprintf(f, "f %d//%d %d//%d %d//%d\n", a, a, d, d, c, c);
        }
    (void)fclose(f);
}

/* `material`: settings of the ball's. */
static void render(scene_lab *l, const char *material, int samples, float *pixels) {
    FILE *f = scene_lab_create(l, "scene.cfg");
    (void)fprintf(f,
                  "output: { width = %d; height = %d; frames = 1; };\nmeshes = ( { file = \"ball.obj\"; } );\n"
                  "background = [1.0, 1.0, 1.0];\nsky: { light = true; };\nmaterials = ( { name = \"ball\"; %s } );\n"
                  "camera: { keys = ( { fov = 30.0; eye = [0.0, 0.0, %.1f]; target = [0.0, 0.0, 0.0]; } ); };\n"
                  "quality: { photons = 0; sky_samples = %d; specular_depth = 16; };\n",
                  SIDE, SIDE, material, DISTANCE, samples);
    (void)fclose(f);
    scene_lab_bake(l, "scene.cfg", "");
    scene_lab_play(l, "final", pixels, FLOATS);
}

/* Also what is no number. */
static double larger(double worst, double error) {
    return error <= worst ? worst : error;
}

/* Cosine between the ball's normal and the way to the eye at a pixel; 0 outside and near the silhouette. */
static double pixel_cosine(int i) {
    const double edge = tan(15 * PI / 180), x = edge * ((2 * (i % SIDE) + 1.0) / SIDE - 1),
                 y = edge * ((2 * (i / SIDE) + 1.0) / SIDE - 1);
    const double off = DISTANCE * sqrt(x * x + y * y) / sqrt(1 + x * x + y * y); /* of the ray from the middle */
    return off < LIMIT ? sqrt(1 - off * off) : 0;
}

/* Albedo of a lobe of reflectance 1 at the angle of the given cosine: the integral of (m + 2) / (2 pi) cos^m a cos l over the
 * ways out. */
static double lobe_albedo(double cosine, double m) {
    enum { STEPS = 100 };
    const double sine = sqrt(1 - cosine * cosine);
    double sum = 0;
    for (int i = 0; i < STEPS; i++)
        for (int j = 0; j < STEPS; j++) {
            const double up = (i + 0.5) / STEPS, out = sqrt(1 - up * up), turn = 2 * PI * (j + 0.5) / STEPS;
            const double along = up * cosine - out * cos(turn) * sine; /* with the mirrored way, (-sine, cosine) */
            if (along > 0)
                sum += (m + 2) / (2 * PI) * pow(along, m) * up * (2 * PI / STEPS) / STEPS;
        }
    return sum;
}

enum { TABLE = 64 }; /* of albedos, at cosines from 0 to 1 */

static double looked_up(const double *table, double cosine) {
    const int i = cosine < 1 ? (int)(cosine * TABLE) : TABLE - 1;
    return table[i] + (cosine * TABLE - i) * (table[i + 1] - table[i]);
}

static void white_paint_and_lobes_give_back_what_they_should(void **state) {
    static const struct {
        const char *name, *material;
        double matt, lobe, exponent, rms, mean;
    } balls[] = {
        {"white paint", "color = [1.0, 1.0, 1.0];", 1, 0, 1, 2e-3, 3e-4 /* of it 2e-4 the mesh */},
        {"lobe of exponent 10", "color = [0.0, 0.0, 0.0]; specular = [1.0, 1.0, 1.0]; exponent = 10.0;", 0, 1, 10, 0.01, 2e-3},
        {"lobe of exponent 60 on paint", "color = [0.5, 0.5, 0.5]; specular = [0.5, 0.5, 0.5]; exponent = 60.0;", 0.5, 0.5, 60,
         0.04, 2e-3}};
    static float pixels[FLOATS];
    for (size_t k = 0; k < sizeof balls / sizeof *balls; k++) {
        double square = 0, is = 0, should = 0, most = 0;
        int count = 0;
        double albedo[TABLE + 1];
        for (int i = 0; i <= TABLE; i++)
            albedo[i] = lobe_albedo((double)i / TABLE, balls[k].exponent);
        render(*state, balls[k].material, 1024, pixels);
        for (int i = 0; i < SIDE * SIDE; i++) {
            const double cosine = pixel_cosine(i);
            if (cosine == 0)
                continue;
            /* code of a reflectance: to the nearest of 1023 squares */
            const double step = floor(sqrt(balls[k].matt) * 1023 + 0.5) / 1023,
                         lobe = floor(sqrt(balls[k].lobe) * 1023 + 0.5) / 1023;
            const double truth = step * step + (balls[k].lobe > 0 ? lobe * lobe * looked_up(albedo, cosine) : 0);
            square += pow((double)pixels[4 * i] / truth - 1, 2);
            is += (double)pixels[4 * i];
            should += truth;
            most = fmax(most, truth);
            count++;
        }
        assert_true(count > SIDE * SIDE / 4);
        assert_true(most < 1 + 1e-3); /* the model itself adds nothing */
        char what[96];
        (void)snprintf(what, sizeof what, "%s: pixels against its albedo", balls[k].name);
        catalogue_row("open furnace", what, sqrt(square / count), balls[k].rms, "relative rms");
        (void)snprintf(what, sizeof what, "%s: mean against its albedo", balls[k].name);
        catalogue_row("open furnace", what, fabs(is / should - 1), balls[k].mean, "relative");
    }
}

static void mirrors_and_glass_cannot_be_told_from_the_sky(void **state) {
    static const struct {
        const char *name, *material;
        double left; /* of the sky's radiance */
    } balls[] = {{"mirror", "kind = \"mirror\"; specular = [1.0, 1.0, 1.0];", 1},
                 {"half a mirror", "kind = \"mirror\"; specular = [0.5, 0.5, 0.5];", 0.5},
                 {"glass", "kind = \"glass\"; ior = 1.5;", 1},
                 {"diamond", "kind = \"glass\"; ior = 2.4;", 1},
                 {"water", "kind = \"glass\"; ior = 1.333;", 1},
                 {"thin glass", "kind = \"thin_glass\"; ior = 1.5;", 1}};
    static float pixels[FLOATS];
    for (size_t k = 0; k < sizeof balls / sizeof *balls; k++) {
        double worst = 0;
        render(*state, balls[k].material, 1, pixels);
        for (int i = 0; i < SIDE * SIDE; i++)
            for (int c = 0; c < 3 && (balls[k].left == 1 || pixel_cosine(i) > 0); c++)
                worst = larger(worst, fabs((double)pixels[4 * i + c] - balls[k].left));
        char what[96];
        (void)snprintf(what, sizeof what, "%s: worst pixel against what it leaves of the sky", balls[k].name);
        catalogue_row("open furnace", what, worst, 1e-6, "W/(m2 sr)");
    }
}

/* The ray through the middle goes 2 m through the glass; what the first surface mirrors does not. */
static void glass_absorbs_along_the_way(void **state) {
    static float pixels[FLOATS];
    double middle[3] = {0};
    render(*state, "kind = \"glass\"; ior = 1.5; absorption = [0.5, 1.0, 2.0];", 1, pixels);
    for (int i = 0; i < 4; i++)
        for (int c = 0; c < 3; c++)
            middle[c] += 0.25 * (double)pixels[4 * ((SIDE / 2 - i / 2) * SIDE + SIDE / 2 - i % 2) + c];
    const double mirrored = 0.04; /* ((1.5 - 1) / (1.5 + 1))^2 */
    double worst = 0;
    for (int c = 0; c < 3; c++)
        worst = larger(worst, fabs(middle[c] / (mirrored + (1 - mirrored) * exp(-2 * 0.5 * (1 << c))) - 1));
    catalogue_row("open furnace", "absorbing glass: its middle against exp(-2 a)", worst, 5e-3, "relative");
}

/* A block of glass on a floor, `above` metres over it. */
static void render_block(scene_lab *l, double above, float *pixels) {
    static const int face[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
    FILE *f = scene_lab_create(l, "block.mtl");
    (void)fprintf(f, "newmtl block\nKd 0 0 0\nnewmtl floor\nKd 0.7 0.5 0.3\n");
    (void)fclose(f);
    f = scene_lab_create(l, "block.obj");
    (void)fprintf(f, "mtllib block.mtl\nv -3 0 -3\nv 3 0 -3\nv 3 0 3\nv -3 0 3\n");
    for (int i = 0; i < 8; i++)
        (void)fprintf(f, "v %g %g %g\n", i & 1 ? 0.4 : -0.4, above + (i & 2 ? 0.7 : 0.0), i & 4 ? 0.5 : -0.3);
    (void)fprintf(f, "usemtl floor\nf 4 3 2 1\nusemtl block\n");
    for (int i = 0; i < 6; i++)
        (void)fprintf(f, "f %d %d %d %d\n", 5 + face[i][0], 5 + face[i][1], 5 + face[i][2], 5 + face[i][3]);
    (void)fclose(f);
    f = scene_lab_create(l, "scene.cfg");
    (void)fprintf(f,
                  "output: { width = %d; height = %d; frames = 1; };\nmeshes = ( { file = \"block.obj\"; } );\n"
                  "background = [0.3, 0.4, 0.6];\nsky: { light = true; };\n"
                  "materials = ( { name = \"block\"; kind = \"glass\"; ior = 1.5; } );\n"
                  "camera: { keys = ( { fov = 30.0; eye = [0.5, 1.2, 2.6]; target = [0.0, 0.3, 0.0]; } ); };\n"
                  "quality: { photons = 0; sky_samples = 16; };\n",
                  SIDE, SIDE);
    (void)fclose(f);
    scene_lab_bake(l, "scene.cfg", "");
    scene_lab_play(l, "final", pixels, FLOATS);
}

/* Where its lowest face and the floor are in one place, which of them a ray meets must not be up to rounding, pixel by pixel.
 */
static void glass_on_a_floor_is_glass_just_above_it(void **state) {
    static float on[FLOATS], above[FLOATS];
    int differ = 0;
    render_block(*state, 0.0, on);
    render_block(*state, 0.001, above);
    for (int i = 0; i < SIDE * SIDE; i++)
        differ += !(fabs((double)on[4 * i + 2] - (double)above[4 * i + 2]) <= 0.05);
    catalogue_row("open furnace", "a block of glass on a floor: pixels unlike those of one 1 mm above",
                  (double)differ / (SIDE * SIDE), 0.01, "of all");
}

static int set_up(void **state) {
    static scene_lab lab;
    scene_lab_open(&lab);
    write_ball(&lab);
    *state = &lab;
    return 0;
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(white_paint_and_lobes_give_back_what_they_should),
                                       cmocka_unit_test(mirrors_and_glass_cannot_be_told_from_the_sky),
                                       cmocka_unit_test(glass_absorbs_along_the_way),
                                       cmocka_unit_test(glass_on_a_floor_is_glass_just_above_it)};
    return cmocka_run_group_tests_name("open furnace", tests, set_up, scene_lab_tear_down);
}
