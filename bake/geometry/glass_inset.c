#include "geometry/glass_inset.h"
#include "common/triangle.h"
#include "vitrine_pack.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define SAME_WAY (1.0 - 1e-4) /* cosine between normals that are taken for one */
#define MITRE 0.25            /* least cosine between a vertex's way and its faces' normals that is made up for */
#define MOST 64               /* normals at a place that count */

/* A corner of a glass triangle, number 3 * triangle + 0..2, and where it is. */
typedef struct corner_at {
    float p[3];
    uint32_t corner;
} corner_at;

static int compare(const void *a, const void *b) {
    const corner_at *x = a, *y = b;
    for (int k = 0; k < 3; k++)
        if (x->p[k] != y->p[k])
            return x->p[k] < y->p[k] ? -1 : 1;
    return x->corner < y->corner ? -1 : x->corner > y->corner;
}

static const float *position(const model *m, uint32_t triangle, uint32_t k) {
    return m->position + 3 * (size_t)m->index[3 * (size_t)triangle + k];
}

static bool unit_normal(const model *m, uint32_t triangle, double n[3]) {
    return triangle_unit_normal(position(m, triangle, 0), position(m, triangle, 1), position(m, triangle, 2), n);
}

static double dot(const double a[3], const double b[3]) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* Least height of the triangle, m: over its longest edge. */
static double height(const model *m, uint32_t triangle) {
    double longest = 0.0;
    float n[3];
    for (uint32_t k = 0; k < 3; k++) {
        const float *p = position(m, triangle, k), *q = position(m, triangle, (k + 1) % 3);
        const double e[3] = {(double)q[0] - (double)p[0], (double)q[1] - (double)p[1], (double)q[2] - (double)p[2]};
        longest = fmax(longest, sqrt(dot(e, e)));
    }
    triangle_normal(position(m, triangle, 0), position(m, triangle, 1), position(m, triangle, 2), n);
    const double twice_area[3] = {(double)n[0], (double)n[1], (double)n[2]};
    return longest > 0.0 ? sqrt(dot(twice_area, twice_area)) / longest : 0.0;
}

/* Moves the corners at one place so that each face there moves in by `gap`. */
static void draw_in(const model *m, corner_at *at, size_t count, double gap) {
    double normals[MOST][3], sum[3] = {0, 0, 0}, least_height = INFINITY, least = 1.0;
    size_t found = 0;
    for (size_t i = 0; i < count; i++) {
        double n[3];
        bool known = !unit_normal(m, at[i].corner / 3, n) || found == MOST;
        least_height = fmin(least_height, height(m, at[i].corner / 3));
        for (size_t k = 0; k < found && !known; k++)
            known = dot(n, normals[k]) > SAME_WAY;
        if (known)
            continue;
        memcpy(normals[found++], n, sizeof n);
        for (int k = 0; k < 3; k++)
            sum[k] += n[k];
    }
    const double length = sqrt(dot(sum, sum));
    if (!(length > 1e-6)) /* faces that look all ways have no inside */
        return;
    for (size_t k = 0; k < found; k++)
        least = fmin(least, dot(sum, normals[k]) / length);
    const double way = fmin(gap / fmax(least, MITRE), least_height / 8.0);
    for (size_t i = 0; i < count; i++)
        for (int k = 0; k < 3; k++)
            at[i].p[k] = (float)((double)at[i].p[k] - way * sum[k] / length);
}

bool glass_inset(model *m, float ray_offset) {
    size_t corners = 0;
    for (uint32_t t = 0; t < m->triangles; t++)
        corners += m->materials[m->material[t]].kind == VIT_GLASS ? 3 : 0;
    if (corners == 0)
        return true;
    corner_at *at = calloc(corners, sizeof *at);
    if (!at)
        return false;
    size_t n = 0;
    for (uint32_t t = 0; t < m->triangles; t++)
        for (uint32_t k = 0; k < 3 && m->materials[m->material[t]].kind == VIT_GLASS; k++, n++) {
            for (int x = 0; x < 3; x++)
                at[n].p[x] = position(m, t, k)[x] + 0.0f; /* -0 and 0 are one place */
            at[n].corner = 3 * t + k;
        }
    qsort(at, corners, sizeof *at, compare);
    for (size_t first = 0, end; first < corners; first = end) {
        for (end = first + 1; end < corners && !memcmp(at[end].p, at[first].p, sizeof at->p); end++)
            ;
        draw_in(m, at + first, end - first, GLASS_INSET * (double)ray_offset);
    }
    for (size_t i = 0; i < corners; i++)
        memcpy(m->position + 3 * (size_t)m->index[at[i].corner], at[i].p, sizeof at->p);
    free(at);
    return true;
}
