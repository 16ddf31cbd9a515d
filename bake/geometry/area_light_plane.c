#include "geometry/area_light_plane.h"
#include "common/triangle.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define SAME_PLANE 2.0        /* ray offsets between places that are one for rays */
#define SAME_WAY (1.0 - 1e-6) /* cosine between normals, either way round, of one plane */

/* A triangle in double. */
typedef struct face {
    uint32_t triangle;
    double corner[3][3], normal[3], low[3], high[3];
    double side; /* +1: most cameras are where the normal points, -1: behind */
    bool shared; /* its plane's, with another face */
} face;

static double dot(const double a[3], const double b[3]) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static bool face_of(const model *m, uint32_t triangle, face *out) {
    const float *p[3];
    *out = (face){.triangle = triangle};
    for (size_t k = 0; k < 3; k++) {
        p[k] = m->position + 3 * (size_t)m->index[3 * (size_t)triangle + k];
        for (int x = 0; x < 3; x++) {
            out->corner[k][x] = (double)p[k][x] + 0.0; /* -0 and 0 are one place */
            out->low[x] = k == 0 || out->corner[k][x] < out->low[x] ? out->corner[k][x] : out->low[x];
            out->high[x] = k == 0 || out->corner[k][x] > out->high[x] ? out->corner[k][x] : out->high[x];
        }
    }
    return triangle_unit_normal(p[0], p[1], p[2], out->normal);
}

static bool emits(const model *m, uint32_t triangle) {
    const float *e = m->materials[m->material[triangle]].emission;
    return e[0] > 0.0f || e[1] > 0.0f || e[2] > 0.0f;
}

/* Whether p, near the plane of f, is within `near` of the plane and over the triangle. */
static bool lies_on(const double p[3], const face *f, double near) {
    double from[3];
    for (int x = 0; x < 3; x++)
        from[x] = p[x] - f->corner[0][x];
    if (fabs(dot(from, f->normal)) > near)
        return false;
    for (int k = 0; k < 3; k++) {
        const double *a = f->corner[k], *b = f->corner[(k + 1) % 3], *n = f->normal;
        const double e[3] = {b[0] - a[0], b[1] - a[1], b[2] - a[2]}, d[3] = {p[0] - a[0], p[1] - a[1], p[2] - a[2]};
        const double across[3] = {e[1] * d[2] - e[2] * d[1], e[2] * d[0] - e[0] * d[2], e[0] * d[1] - e[1] * d[0]};
        if (dot(across, n) < 0.0)
            return false;
    }
    return true;
}

/* Whether the middle of the face of an area light, or a place half-way from there to a corner or an edge's middle, lies on f.
 */
static bool shares_plane(const face *area_light, const face *f, double near) {
    for (int x = 0; x < 3; x++)
        if (area_light->low[x] > f->high[x] + near || area_light->high[x] < f->low[x] - near)
            return false;
    if (fabs(dot(area_light->normal, f->normal)) < SAME_WAY)
        return false;
    double middle[3], p[3];
    for (int x = 0; x < 3; x++)
        middle[x] = (area_light->corner[0][x] + area_light->corner[1][x] + area_light->corner[2][x]) / 3.0;
    if (lies_on(middle, f, near))
        return true;
    for (int k = 0; k < 3; k++)
        for (int edge = 0; edge < 2; edge++) {
            const double *a = area_light->corner[k], *b = area_light->corner[(k + edge) % 3];
            for (int x = 0; x < 3; x++)
                p[x] = (middle[x] + (a[x] + b[x]) / 2.0) / 2.0;
            if (lies_on(p, f, near))
                return true;
        }
    return false;
}

static double side_of(const face *f, const vit_camera *cameras, uint32_t frames) {
    int64_t before = 0;
    for (uint32_t i = 0; i < frames; i++) {
        double to[3];
        for (int x = 0; x < 3; x++)
            to[x] = (double)cameras[i].eye[x] - f->corner[0][x];
        before += dot(to, f->normal) > 0.0 ? 1 : -1;
    }
    return before >= 0 ? 1.0 : -1.0;
}

static void mark_shared(const model *m, face *area_lights, size_t count, double near) {
    double low[3], high[3];
    for (int x = 0; x < 3; x++) {
        low[x] = area_lights[0].low[x];
        high[x] = area_lights[0].high[x];
        for (size_t i = 1; i < count; i++) {
            low[x] = fmin(low[x], area_lights[i].low[x]);
            high[x] = fmax(high[x], area_lights[i].high[x]);
        }
    }
    for (uint32_t t = 0; t < m->triangles; t++) {
        face f;
        if (emits(m, t) || !face_of(m, t, &f))
            continue;
        bool apart = false;
        for (int x = 0; x < 3; x++)
            apart |= f.low[x] > high[x] + near || f.high[x] < low[x] - near;
        for (size_t i = 0; i < count && !apart; i++)
            area_lights[i].shared = area_lights[i].shared || shares_plane(&area_lights[i], &f, near);
    }
}

static bool same_edge(const face *a, int i, const face *b, int k) {
    const double *a0 = a->corner[i], *a1 = a->corner[(i + 1) % 3], *b0 = b->corner[k], *b1 = b->corner[(k + 1) % 3];
    const size_t size = sizeof a->corner[0];
    return (memcmp(a0, b0, size) == 0 && memcmp(a1, b1, size) == 0) || (memcmp(a0, b1, size) == 0 && memcmp(a1, b0, size) == 0);
}

/* A lid of a closed body that stands under a ceiling shines on nothing: only sheets, which end somewhere, are panels. Bodies
 * are triangles that hang together by whole edges; open[body[i]] says whether the one of area_lights[i] has an edge of one
 * triangle alone. */
static void keep_sheets(face *area_lights, size_t count, size_t *body, bool *open) {
    for (size_t i = 0; i < count; i++)
        body[i] = i;
    for (size_t i = 0; i < count; i++)
        for (int e = 0; e < 3; e++) {
            bool alone = true;
            for (size_t k = 0; k < count; k++)
                for (int f = 0; f < 3 && k != i; f++)
                    if (same_edge(&area_lights[i], e, &area_lights[k], f)) {
                        alone = false;
                        size_t a = i, b = k;
                        while (body[a] != a)
                            a = body[a];
                        while (body[b] != b)
                            b = body[b];
                        body[a > b ? a : b] = a > b ? b : a;
                    }
            open[i] = open[i] || alone;
        }
    for (size_t i = 0; i < count; i++) { /* a body's first triangle comes before the others */
        size_t first = i;
        while (body[first] != first)
            first = body[first];
        body[i] = first;
        open[first] = open[first] || open[i];
    }
    for (size_t i = 0; i < count; i++)
        area_lights[i].shared = area_lights[i].shared && open[body[i]];
}

/* Each vertex once, whichever of its triangles comes first. */
static uint32_t move_shared(model *m, const face *area_lights, size_t count, bool *done, double way) {
    uint32_t moved = 0;
    for (size_t i = 0; i < count; i++) {
        if (!area_lights[i].shared)
            continue;
        moved++;
        for (size_t k = 0; k < 3; k++) {
            const uint32_t v = m->index[3 * (size_t)area_lights[i].triangle + k];
            float *p = m->position + 3 * (size_t)v;
            for (int x = 0; x < 3 && !done[v]; x++) {
                p[x] = (float)((double)p[x] + way * area_lights[i].side * area_lights[i].normal[x]);
                m->lo[x] = fmin(m->lo[x], (double)p[x]);
                m->hi[x] = fmax(m->hi[x], (double)p[x]);
            }
            done[v] = true;
        }
    }
    return moved;
}

bool area_light_plane(model *m, const vit_camera *cameras, uint32_t frames, float ray_offset, uint32_t *moved) {
    uint32_t count = 0;
    *moved = 0;
    for (uint32_t t = 0; t < m->triangles; t++)
        count += emits(m, t);
    if (count == 0 || count > AREA_LIGHT_PLANE_MOST)
        return true;
    face *area_lights = malloc(count * sizeof *area_lights);
    size_t *body = malloc(count * sizeof *body), n = 0;
    bool *done = calloc(m->vertices, sizeof *done), *open = calloc(count, sizeof *open);
    const bool fine = area_lights && body && done && open;
    for (uint32_t t = 0; fine && t < m->triangles; t++)
        if (emits(m, t) && face_of(m, t, &area_lights[n])) {
            area_lights[n].side = side_of(&area_lights[n], cameras, frames);
            n++;
        }
    bool any = false;
    if (n > 0)
        mark_shared(m, area_lights, n, SAME_PLANE * (double)ray_offset);
    for (size_t i = 0; i < n; i++)
        any |= area_lights[i].shared;
    if (any) {
        keep_sheets(area_lights, n, body, open);
        *moved = move_shared(m, area_lights, n, done, AREA_LIGHT_PLANE * (double)ray_offset);
    }
    free(area_lights);
    free(body);
    free(done);
    free(open);
    return fine;
}
