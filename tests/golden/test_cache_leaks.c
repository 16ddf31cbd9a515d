/* What gets through a wall of 2 cm between the open and a closed, dark room, of light that is baked or cached at places:
 * ambient light with a radius, baked and progressive, the sky's and an area light's light as a lightmap, and the light of a
 * lamp by a basis whose receivers are points in space.
 *
 * Why this is hard: both stand on one floor, whose points on the two sides of the wall are nearer to one another than points
 * lie apart. The room is closed, so that all of its light is a leak, to be compared with none; what darkness leaks out is
 * compared with the same scene without the room, in which points lie where they did, but no cell is parted: light that is
 * found with fewer places a point differs by chance. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>

#include "scene_lab.h"

#include <math.h>
#include <stdlib.h>

/* The path looks at the wall from outside, from within the room and from outside again, so that what is found while playing
 * gets both ways. */
enum { SIDE = 64, VIEW = 4, FRAMES = 3 * VIEW, IN = 2 * VIEW - 1, OUT = FRAMES - 1 };
#define ALBEDO 0.5
#define FOV 60.0

static float pixels[(size_t)FRAMES * SIDE * SIDE * 4], bare[(size_t)FRAMES * SIDE * SIDE * 4];

/* Floor, and the wall at x = 0, 2 cm thick; behind it the room, 1 m high; over the floor before it a lamp. */
static void write_mesh(scene_lab *l, bool room, bool lamp) {
    FILE *f = scene_lab_create(l, "grey.mtl");
    (void)fprintf(f, "newmtl grey\nKd %g %g %g\nnewmtl lamp\nKd 0 0 0\nKe 3 3 3\n", ALBEDO, ALBEDO, ALBEDO);
    (void)fclose(f);
    f = scene_lab_create(l, "wall.obj");
    (void)fprintf(f, "mtllib grey.mtl\nusemtl grey\nv -9 0 -9\nv 9 0 -9\nv 9 0 9\nv -9 0 9\n"
                     "v 0 0 -1\nv 0 0 1\nv 0 1 1\nv 0 1 -1\nv 0.02 0 -1\nv 0.02 0 1\nv 0.02 1 1\nv 0.02 1 -1\n"
                     "v 2 0 -1\nv 2 0 1\nv 2 1 1\nv 2 1 -1\nv -1 2 -0.5\nv -1 2 0.5\nv -0.5 2 0.5\nv -0.5 2 -0.5\n"
                     "f 4 3 2 1\nf 5 6 7 8\nf 9 12 11 10\nf 5 8 12 9\nf 6 10 11 7\nf 8 7 11 12\n");
    if (room)
        (void)fprintf(f, "f 13 14 15 16\nf 9 13 16 12\nf 10 11 15 14\nf 12 16 15 11\n");
    if (lamp)
        (void)fprintf(f, "usemtl lamp\nf 17 18 19 20\n");
    (void)fclose(f);
}

static void render(scene_lab *l, bool room, const char *light, const char *options, float *out) {
    write_mesh(l, room, strstr(light, "sky") != NULL);
    FILE *f = scene_lab_create(l, "wall.cfg");
    (void)fprintf(f,
                  "output: { width = %d; height = %d; fps = 1.0; frames = %d; };\nmeshes = ( { file = \"wall.obj\"; } );\n%s\n"
                  "camera: { near = 0.05; keys = ( { fov = %g; eye = [-0.9, 0.7, 0.0]; target = [0.0, 0.1, 0.0]; },"
                  " { time = %d.0; }, { time = %d.0; eye = [0.92, 0.7, 0.0]; target = [0.02, 0.1, 0.0]; }, { time = %d.0; },"
                  " { time = %d.0; eye = [-0.9, 0.7, 0.0]; target = [0.0, 0.1, 0.0]; } ); };\n"
                  "quality: { tile = 8; photons = 0; };\n",
                  SIDE, SIDE, FRAMES, light, FOV, VIEW - 1, VIEW, 2 * VIEW - 1, 2 * VIEW);
    (void)fclose(f);
    scene_lab_bake(l, "wall.cfg", options);
    scene_lab_play(l, strstr(options, "basis") ? "indirect" : "direct", out, sizeof pixels / sizeof *pixels);
}

/* The row of pixels where the wall's foot is seen: 0.7 m below the eye and 0.9 before it, looking to 0.1 above. */
static double foot_row(void) {
    return SIDE * (0.5 + 0.5 * tan(atan2(0.7, 0.9) - atan2(0.6, 0.9)) / tan(FOV * acos(-1) / 360));
}

typedef struct leak {
    double most, mean, clear; /* of all light: the worst pixel, the mean, the worst 20 pixels from the foot: 2.5 times the way
                               * between points */
} leak;

/* Of a frame less another; NULL: less nothing. */
static leak leak_of(int frame, const float *from) {
    leak r = {0, 0, 0};
    for (int y = 0; y < SIDE; y++)
        for (int x = 0; x < SIDE; x++) {
            const size_t at = 4 * ((size_t)(frame * SIDE + y) * SIDE + (size_t)x);
            const double off = fabs((double)pixels[at] - (from ? (double)from[at] : 0)) / ALBEDO;
            r.most = fmax(r.most, off);
            r.mean += off / (SIDE * SIDE);
            if (fabs(y + 0.5 - foot_row()) > 20)
                r.clear = fmax(r.clear, off);
        }
    return r;
}

static void is_within(const char *what, leak l, leak bound) {
    print_message("%s: at most %.4f, mean %.5f, away from the foot %.4f\n", what, l.most, l.mean, l.clear);
    assert_true(l.most < bound.most && l.mean < bound.mean && l.clear < bound.clear);
}

static void check(scene_lab *l, const char *light, const char *options, leak into, leak out_of) {
    render(l, false, light, options, bare);
    render(l, true, light, options, pixels);
    assert_true(leak_of(OUT, NULL).mean > 0.2); /* outside there is light */
    is_within("into the room", leak_of(IN, NULL), into);
    is_within("out of it", leak_of(OUT, bare), out_of);
}

#define AMBIENT "ambient = [1.0, 1.0, 1.0]; ambient_radius = 3.0;"
static void of_baked_ambient_light(void **state) {
    check(*state, AMBIENT, "", (leak){0.01, 1e-4, 0.001}, (leak){0.06, 0.001, 0.006});
}

static void of_progressive_ambient_light(void **state) {
    check(*state, AMBIENT, "--cache progressive", (leak){0.01, 1e-4, 0.001}, (leak){0.12, 0.0015, 0.001});
}

/* Receivers lie on surfaces, and each side of a triangle has its own; what a cell cannot tell apart is left to rays. */
static void of_a_lightmap(void **state) {
    check(*state, "background = [1.0, 1.0, 1.0]; sky: { light = true; };", "--lightmap baked", (leak){0.01, 1e-4, 0.001},
          (leak){0.01, 1e-4, 0.001});
}

/* Of the light outside, where the lamp shines on floor and wall. */
static void of_a_basis_at_points(void **state) {
    render(*state, true,
           "lights = ( { type = \"point\"; keys = ( { position = [-0.7, 0.9, 0.0]; power = [20.0, 20.0, 20.0]; } ); } );",
           "--photons 1000 --indirect basis --basis-receivers points --receiver-rays 128 --point-spacing 8", pixels);
    const double outside = leak_of(OUT, NULL).mean;
    leak in = leak_of(IN, NULL);
    assert_true(outside > 0.05);
    in = (leak){in.most / outside, in.mean / outside, in.clear / outside};
    is_within("into the room", in, (leak){0.01, 1e-4, 0.001});
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(of_baked_ambient_light),
        cmocka_unit_test(of_progressive_ambient_light),
        cmocka_unit_test(of_a_lightmap),
        cmocka_unit_test(of_a_basis_at_points),
    };
    return cmocka_run_group_tests_name("leaks of what is cached", tests, scene_lab_set_up, scene_lab_tear_down);
}
