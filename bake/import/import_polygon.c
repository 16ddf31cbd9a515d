/* Polygons of four corners and more, cut by their ears: no corner is lost, whatever the outline. */
#include "import/importer.h"
#include <math.h>

/* A polygon seen along the largest component of its normal, so that it runs counter-clockwise. */
typedef struct outline {
    double x[IMPORT_CORNERS], y[IMPORT_CORNERS];
    unsigned before[IMPORT_CORNERS], after[IMPORT_CORNERS]; /* among the corners that are left */
} outline;

/* Twice the area of the triangle, positive where it runs counter-clockwise. */
static double turn(const outline *o, unsigned a, unsigned b, unsigned c) {
    return (o->x[b] - o->x[a]) * (o->y[c] - o->y[a]) - (o->y[b] - o->y[a]) * (o->x[c] - o->x[a]);
}

static bool same_point(const outline *o, unsigned a, unsigned b) {
    return o->x[a] == o->x[b] && o->y[a] == o->y[b];
}

/* The triangle at corner b lies inside the polygon: it is convex there, and no other corner is in it or on its edge. */
static bool is_ear(const outline *o, unsigned b) {
    const unsigned a = o->before[b], c = o->after[b];
    if (!(turn(o, a, b, c) > 0.0))
        return false;
    for (unsigned k = o->after[c]; k != a; k = o->after[k]) {
        if (same_point(o, k, a) || same_point(o, k, b) || same_point(o, k, c)) /* where an outline meets itself */
            continue;
        if (turn(o, a, b, k) >= 0.0 && turn(o, b, c, k) >= 0.0 && turn(o, c, a, k) >= 0.0)
            return false;
    }
    return true;
}

static void see_from_front(const mesh_floats *position, const uint32_t *corner, unsigned count, outline *o) {
    double normal[3] = {0.0, 0.0, 0.0}, at[2][3];
    const float *first = position->at + position->stride * corner[0];
    for (unsigned i = 0; i <= count; i++) {
        const float *v = position->at + position->stride * corner[i % count];
        double *p = at[i % 2], *q = at[(i + 1) % 2];
        for (size_t k = 0; k < 3; k++)
            p[k] = (double)v[k] - (double)first[k];
        for (size_t k = 0; i > 0 && k < 3; k++)
            normal[k] += q[(k + 1) % 3] * p[(k + 2) % 3] - q[(k + 2) % 3] * p[(k + 1) % 3];
    }
    size_t axis = 0;
    for (size_t k = 1; k < 3; k++)
        if (fabs(normal[k]) > fabs(normal[axis]))
            axis = k;
    for (unsigned i = 0; i < count; i++) {
        const float *v = position->at + position->stride * corner[i];
        const double p[3] = {(double)v[0], (double)v[1], (double)v[2]};
        o->x[i] = normal[axis] < 0.0 ? -p[(axis + 1) % 3] : p[(axis + 1) % 3];
        o->y[i] = p[(axis + 2) % 3];
        o->before[i] = (i + count - 1) % count;
        o->after[i] = (i + 1) % count;
    }
}

/* From its reflex corner, if it has one, else from its first. */
static void cut_quad(const outline *o, uint32_t triangle[6]) {
    static const unsigned fan[6] = {0, 1, 2, 0, 2, 3};
    unsigned start = 0;
    while (start < 4 && !(turn(o, o->before[start], start, o->after[start]) < 0.0))
        start++;
    for (unsigned i = 0; i < 6; i++)
        triangle[i] = (start + fan[i]) % 4;
}

/* An outline that crosses itself, or has no area, is cut somehow. */
void import_cut_polygon(const mesh_floats *position, const uint32_t *corner, unsigned count, uint32_t *triangle) {
    outline o;
    see_from_front(position, corner, count, &o);
    if (count == 4) {
        cut_quad(&o, triangle);
        return;
    }
    unsigned at = 1;
    for (unsigned left = count; left >= 3; left--) {
        unsigned ear = at, tried = 0;
        while (left > 3 && tried < left && !is_ear(&o, ear)) {
            ear = o.after[ear];
            tried++;
        }
        const unsigned a = o.before[ear], c = o.after[ear];
        *triangle++ = a;
        *triangle++ = ear;
        *triangle++ = c;
        o.after[a] = c;
        o.before[c] = a;
        at = o.after[c]; /* not the neighbour: fewer long fans */
    }
}
