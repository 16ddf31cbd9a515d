/* Curved pieces: sheets over a parameter square, and turned bodies. */
#include "shapes.h"

/* Central differences; where they vanish (a pole) the normal is that of a point slightly inside. */
static v3 normal_at(shape_point_fn *at, const void *user, double s, double t) {
    const double step = 1e-4;
    for (int tries = 0; tries < 2; tries++) {
        vertex s0 = {0}, s1 = {0}, t0 = {0}, t1 = {0};
        at(user, s - step, t, &s0);
        at(user, s + step, t, &s1);
        at(user, s, t - step, &t0);
        at(user, s, t + step, &t1);
        v3 n = v3_cross(v3_sub(s1.p, s0.p), v3_sub(t1.p, t0.p));
        if (v3_dot(n, n) > 1e-22)
            return v3_unit(n);
        t += t < 0.5 ? 0.004 : -0.004;
        s += s < 0.5 ? 0.004 : -0.004;
    }
    return v3_of(0, 1, 0);
}

void shape_sheet(mesh *m, int nu, int nv, shape_point_fn *at, const void *user, bool flip) {
    uint32_t first = 0;
    for (int j = 0; j <= nv; j++) {
        for (int i = 0; i <= nu; i++) {
            double s = (double)i / nu, t = (double)j / nv;
            vertex v = {0};
            at(user, s, t, &v);
            v.n = v3_scale(normal_at(at, user, s, t), flip ? -1.0 : 1.0);
            uint32_t index = mesh_vertex(m, v);
            first = i == 0 && j == 0 ? index : first;
        }
    }
    for (int j = 0; j < nv; j++) {
        for (int i = 0; i < nu; i++) {
            uint32_t a = first + (uint32_t)(j * (nu + 1) + i), b = a + (uint32_t)nu + 1;
            mesh_triangle(m, a, a + 1, b + 1);
            mesh_triangle(m, a, b + 1, b);
        }
    }
}

/* A smooth run of a profile. */
typedef struct run {
    const shape_lathe *lathe;
    const lathe_point *points;
    int steps;
    double scale, wide, length, v0;
} run;

/* Catmull-Rom through the run's points, ends doubled by reflection; a straight line for two points. */
static double curve(const run *r, double t, bool height) {
    double x = t * r->steps;
    int i = (int)floor(x);
    i = i < 0 ? 0 : i >= r->steps ? r->steps - 1 : i;
    double p[4];
    for (int k = 0; k < 4; k++) {
        int at = i + k - 1, inside = at < 0 ? 0 : at > r->steps ? r->steps : at;
        p[k] = height ? r->points[inside].y : r->points[inside].r;
    }
    if (i == 0)
        p[0] = 2.0 * p[1] - p[2];
    if (i == r->steps - 1)
        p[3] = 2.0 * p[2] - p[1];
    double f = x - i;
    return r->scale *
           (p[1] +
            0.5 * f *
                (p[2] - p[0] + f * (2.0 * p[0] - 5.0 * p[1] + 4.0 * p[2] - p[3] + f * (3.0 * (p[1] - p[2]) + p[3] - p[0]))));
}

static void run_point(const void *user, double s, double t, vertex *out) {
    const run *r = user;
    const shape_lathe *l = r->lathe;
    double a = -2.0 * PI * s, fade = 4.0 * clamp01(t) * (1.0 - clamp01(t));
    double radius = r->wide * curve(r, t, false) * (1.0 + l->lobe * fade * cosine(a * l->lobes));
    out->p = v3_add(l->foot, v3_of(radius * cosine(a), curve(r, t, true), radius * sine(a)));
    out->u = s * (l->around > 0.0 ? l->around : 1.0);
    out->v = r->v0 + r->length * t;
}

static double run_length(const run *r) {
    double length = 0.0;
    for (int i = 0; i < r->steps; i++) {
        double dr = r->points[i + 1].r - r->points[i].r, dy = r->points[i + 1].y - r->points[i].y;
        length += r->scale * sqrt(dr * dr + dy * dy);
    }
    return length / (r->lathe->uv > 0.0 ? r->lathe->uv : 1.0);
}

void shape_lathe_add(mesh *m, const shape_lathe *l) {
    run r = {.lathe = l, .scale = l->scale > 0.0 ? l->scale : 1.0, .wide = l->wide > 0.0 ? l->wide : 1.0};
    for (int first = 0; first + 1 < l->count; first += r.steps) {
        r.points = l->profile + first;
        r.steps = 1;
        while (first + r.steps + 1 < l->count && !l->profile[first + r.steps].sharp)
            r.steps++;
        r.length = run_length(&r);
        shape_sheet(m, l->segments, r.steps == 1 && l->lobes == 0 ? 1 : r.steps * l->rings, run_point, &r, false);
        r.v0 += r.length;
    }
}
