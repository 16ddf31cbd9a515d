/* Two rooms side by side, a bright one at x < 0 and a dark one, for tests of light that gets through the wall between them:
 * each 3 m high and 4 m deep, seen from inside by a frame of its own, with one more frame for what the test looks at. */
#ifndef VIT_TWO_ROOMS_H
#define VIT_TWO_ROOMS_H

#include "scene_lab.h"
#include <math.h>

#define ROOMS_SIDE 48                     /* pixels of a frame's edge */
enum { BRIGHT, DARK, WALL, ROOMS_VIEWS }; /* frames: the bright room, the dark one, the place looked at */
#define ROOMS_FLOATS ((size_t)4 * ROOMS_SIDE * ROOMS_SIDE * ROOMS_VIEWS)

typedef float rooms_picture[ROOMS_FLOATS];

/* A box whose vertices follow `first` others; `without`: which of its faces to leave out, as bits: floor, ceiling, ends, sides.
 */
static inline void rooms_box(FILE *f, const double lo[3], const double hi[3], int first, unsigned without) {
    static const int face[6][4] = {{1, 5, 6, 2}, {3, 4, 8, 7}, {1, 3, 7, 5}, {2, 6, 8, 4}, {1, 2, 4, 3}, {5, 7, 8, 6}};
    for (int i = 0; i < 8; i++)
        (void)fprintf(f, "v %g %g %g\n", i & 1 ? hi[0] : lo[0], i & 2 ? hi[1] : lo[1], i & 4 ? hi[2] : lo[2]);
    for (int i = 0; i < 6; i++)
        if (!(without >> i & 1))
            (void)fprintf(f, "f %d %d %d %d\n", face[i][0] + first, face[i][1] + first, face[i][2] + first, face[i][3] + first);
}

/* Scene file `name` of the mesh rooms.obj; `third`: keys of the third camera; power: of the bright room's lamp, W, which with
 * `moves` goes a millimetre. The dark one has a lamp of a thousandth of 100 W, so that its sides count as lit; a test takes its
 * light away again. */
static inline void rooms_scene(scene_lab *l, const char *name, const char *third, double power, bool moves) {
    FILE *f = scene_lab_create(l, name);
    (void)fprintf(f,
                  "output: { width = %d; height = %d; fps = 1.0; frames = %d; };\nmeshes = ( { file = \"rooms.obj\"; } );\n"
                  "camera: { near = 0.1; keys = ("
                  "{ time = 0.0; fov = 80.0; eye = [-3.7, 1.5, 1.6]; target = [-0.05, 1.2, -0.4]; },"
                  "{ time = 1.0; fov = 80.0; eye = [3.7, 1.5, 1.6]; target = [0.05, 1.2, -0.4]; },"
                  "{ time = 2.0; %s }); };\n"
                  "lights = ("
                  "{ type = \"point\"; keys = ( { position = [-2.0, 2.0, 0.3]; power = [%g, %g, %g]; }%s ); },"
                  "{ type = \"point\"; keys = ( { position = [2.0, 2.0, -0.3]; power = [0.1, 0.1, 0.1]; } ); });\n"
                  "quality: { bounces = 4; tile = 16; };\n",
                  ROOMS_SIDE, ROOMS_SIDE, ROOMS_VIEWS, third, power, power, power,
                  moves ? ", { time = 2.0; position = [-2.001, 2.0, 0.3]; }" : "");
    (void)fclose(f);
}

/* rooms.obj, open for boxes. */
static inline FILE *rooms_mesh(scene_lab *l) {
    FILE *f = scene_lab_create(l, "rooms.mtl");
    (void)fprintf(f, "newmtl grey\nKd 0.6 0.6 0.6\n");
    (void)fclose(f);
    f = scene_lab_create(l, "rooms.obj");
    (void)fprintf(f, "mtllib rooms.mtl\nusemtl grey\n");
    return f;
}

/* Of a frame. */
static inline double rooms_mean(const rooms_picture p, int view) {
    const size_t pixels = (size_t)ROOMS_SIDE * ROOMS_SIDE;
    double sum = 0.0;
    for (size_t i = (size_t)view * pixels; i < (size_t)(view + 1) * pixels; i++)
        sum += (double)p[4 * i] + (double)p[4 * i + 1] + (double)p[4 * i + 2];
    return sum / (3.0 * (double)pixels);
}

/* Light of the bright room that arrives in the dark one, over that in the bright one; `dim`: with the bright lamp off. */
static inline double rooms_leak(const rooms_picture both, const rooms_picture dim, int view) {
    assert_true(rooms_mean(both, BRIGHT) > 0.01);
    assert_true(rooms_mean(dim, view) > 0.0); /* the dark room is lit at all */
    return fabs(rooms_mean(both, view) - rooms_mean(dim, view)) / rooms_mean(both, BRIGHT);
}

#endif
