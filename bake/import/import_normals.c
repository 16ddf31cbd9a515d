#include "import/importer.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Faces that meet at more than 60 degrees keep their edge. */
#define COS_CREASE 0.5
/* Corners at one point up to which creases are looked at; the work is quadratic. The tip of a finer fan is averaged whole. */
#define MOST_AT_A_POINT 512

typedef struct corner_at {
    float p[3];
    uint32_t group, corner;
} corner_at;

static int compare(const void *left, const void *right) {
    const corner_at *a = left, *b = right;
    for (int i = 0; i < 3; i++)
        if (a->p[i] != b->p[i])
            return a->p[i] < b->p[i] ? -1 : 1;
    if (a->group != b->group)
        return a->group < b->group ? -1 : 1;
    return a->corner < b->corner ? -1 : a->corner > b->corner;
}

/* Unit normal of the corner's face, and its weight: |e1 x e2| / (|e1|^2 |e2|^2), which is exact where the vertices lie on a
 * sphere and needs no angle (N. Max, Weights for Computing Vertex Normals from Facet Normals, JGT 4(2), 1999). */
static double face(const float *position, const uint32_t *corner, uint32_t c, double unit[3]) {
    const uint32_t base = c - c % 3;
    const float *v[3];
    for (uint32_t i = 0; i < 3; i++)
        v[i] = position + 3 * (size_t)corner[base + (c - base + i) % 3];
    double e1[3], e2[3], n[3], n2 = 0.0, a2 = 0.0, b2 = 0.0;
    for (int i = 0; i < 3; i++) {
        e1[i] = (double)v[1][i] - (double)v[0][i];
        e2[i] = (double)v[2][i] - (double)v[0][i];
    }
    for (int i = 0; i < 3; i++) {
        n[i] = e1[(i + 1) % 3] * e2[(i + 2) % 3] - e1[(i + 2) % 3] * e2[(i + 1) % 3];
        n2 += n[i] * n[i];
        a2 += e1[i] * e1[i];
        b2 += e2[i] * e2[i];
    }
    const double length = sqrt(n2);
    for (int i = 0; i < 3; i++)
        unit[i] = length > 0.0 ? n[i] / length : (i == 1);
    return length > 0.0 ? length / (a2 * b2) : 0.0;
}

typedef struct weighted {
    double unit[3], weight;
} weighted;

/* Normals of `count` corners of one group that lie at one point. */
static void smooth(const weighted *faces, const corner_at *at, size_t count, float *normal) {
    for (size_t i = 0; i < count; i++) {
        double sum[3] = {0.0, 0.0, 0.0};
        for (size_t k = 0; k < count; k++) {
            const double *a = faces[i].unit, *b = faces[k].unit;
            if (count <= MOST_AT_A_POINT && a[0] * b[0] + a[1] * b[1] + a[2] * b[2] < COS_CREASE)
                continue;
            for (int x = 0; x < 3; x++)
                sum[x] += b[x] * faces[k].weight;
        }
        const double length = sqrt(sum[0] * sum[0] + sum[1] * sum[1] + sum[2] * sum[2]);
        for (int x = 0; x < 3; x++)
            normal[3 * (size_t)at[i].corner + (size_t)x] = (float)(length > 0.0 ? sum[x] / length : faces[i].unit[x]);
        if (count > MOST_AT_A_POINT) { /* the sum is the same for all */
            for (size_t k = 1; k < count; k++)
                memcpy(normal + 3 * (size_t)at[k].corner, normal + 3 * (size_t)at[0].corner, 3 * sizeof *normal);
            return;
        }
    }
}

/* At one point, of one group; a flat face is alone. */
static bool together(const corner_at *a, const corner_at *b) {
    return !memcmp(a->p, b->p, sizeof a->p) && a->group == b->group && a->group != IMPORT_FLAT;
}

bool import_normals(const float *position, const uint32_t *corner, const uint32_t *smoothing, size_t triangles, float *normal) {
    const size_t corners = 3 * triangles;
    corner_at *at = calloc(corners + 1, sizeof *at);
    weighted *faces = calloc(corners + 1, sizeof *faces);
    for (size_t i = 0; at && faces && i < corners; i++) {
        for (size_t x = 0; x < 3; x++)
            at[i].p[x] = position[3 * (size_t)corner[i] + x] + 0.0f; /* -0 and 0 are one place */
        at[i].corner = (uint32_t)i;
        at[i].group = smoothing ? smoothing[i / 3] : IMPORT_GROUPLESS;
    }
    if (at && faces) {
        qsort(at, corners, sizeof *at, compare);
        for (size_t i = 0; i < corners; i++)
            faces[i].weight = face(position, corner, at[i].corner, faces[i].unit);
        for (size_t first = 0, end; first < corners; first = end) {
            for (end = first + 1; end < corners && together(&at[first], &at[end]); end++)
                ;
            smooth(faces + first, at + first, end - first, normal);
        }
    }
    const bool fine = at && faces;
    free(at);
    free(faces);
    return fine;
}
