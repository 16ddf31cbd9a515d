/* shapes.c: flat and curved pieces that scenes are put together from. Sizes are metres, angles radians. */
#ifndef VIT_SCENES_SHAPES_H
#define VIT_SCENES_SHAPES_H

#include "mesh.h"

/* Flat parallelogram o + s * a + t * b, facing a x b, in nu x nv cells; uv run over 0..|a| and 0..|b|, divided by `uv` (metres
 * a repeat of the texture), beginning at (u0, v0). */
typedef struct shape_quad {
    v3 o, a, b;
    int nu, nv; /* 0 counts as 1 */
    double uv;  /* 0 counts as 1 */
    double u0, v0;
} shape_quad;
void shape_quad_add(mesh *m, const shape_quad *q);

/* Sides of a box to leave out. */
enum { SIDE_LEFT = 1, SIDE_RIGHT = 2, SIDE_BOTTOM = 4, SIDE_TOP = 8, SIDE_BACK = 16, SIDE_FRONT = 32 };

/* Upright box from lo to hi, facing outward; `open` are sides left out. uv are metres / `uv`, measured from the frame's origin.
 */
void shape_box(mesh *m, v3 lo, v3 hi, double uv, unsigned open);

/* Curved surface: `at` gives position, u and v for s, t in [0, 1] and may be asked slightly outside. Normals are its
 * derivatives' d/ds x d/dt, turned round if `flip`. nu x nv cells. */
typedef void shape_point_fn(const void *user, double s, double t, vertex *out);
void shape_sheet(mesh *m, int nu, int nv, shape_point_fn *at, const void *user, bool flip);

/* A point of a turned profile, from the bottom up; runs between sharp points are smooth curves, two points make a cone. */
typedef struct lathe_point {
    double r, y;
    bool sharp;
} lathe_point;

/* Body turned about the upright axis through `foot`. Profile points count upward along the outside. */
typedef struct shape_lathe {
    v3 foot;
    const lathe_point *profile;
    int count;           /* points; the first and last are sharp anyway */
    int segments, rings; /* around; for each step of a smooth run */
    double scale, wide;  /* of r and y; of r besides; 0 counts as 1 */
    int lobes;           /* leaves or flutes around: r grows by up to lobe * r, fading towards the run's ends */
    double lobe;
    double around, uv; /* texture repeats around (0: 1); metres a repeat upward (0: 1) */
} shape_lathe;
void shape_lathe_add(mesh *m, const shape_lathe *l);

#endif
