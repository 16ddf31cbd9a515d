/* Polygons of five corners and more: cut here, by their ears, and alike for all releases of Assimp, of which 5.3 loses parts of
 * those that are not convex. */
#include "import/assimp/assimp_scene.h"
#include <math.h>
#include <stdlib.h>

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

static void see_from_front(const struct aiMesh *mesh, const unsigned *corner, unsigned count, outline *o) {
    double normal[3] = {0.0, 0.0, 0.0}, at[2][3];
    const struct aiVector3D *first = &mesh->mVertices[corner[0]];
    for (unsigned i = 0; i <= count; i++) {
        const struct aiVector3D *v = &mesh->mVertices[corner[i % count]];
        double *p = at[i % 2], *q = at[(i + 1) % 2];
        p[0] = (double)v->x - (double)first->x;
        p[1] = (double)v->y - (double)first->y;
        p[2] = (double)v->z - (double)first->z;
        for (size_t k = 0; i > 0 && k < 3; k++)
            normal[k] += q[(k + 1) % 3] * p[(k + 2) % 3] - q[(k + 2) % 3] * p[(k + 1) % 3];
    }
    size_t axis = 0;
    for (size_t k = 1; k < 3; k++)
        if (fabs(normal[k]) > fabs(normal[axis]))
            axis = k;
    for (unsigned i = 0; i < count; i++) {
        const struct aiVector3D *v = &mesh->mVertices[corner[i]];
        const double p[3] = {(double)v->x, (double)v->y, (double)v->z};
        o->x[i] = normal[axis] < 0.0 ? -p[(axis + 1) % 3] : p[(axis + 1) % 3];
        o->y[i] = p[(axis + 2) % 3];
        o->before[i] = (i + count - 1) % count;
        o->after[i] = (i + 1) % count;
    }
}

/* count - 2 triangles of mesh vertices; an outline that crosses itself, or has no area, is cut somehow. */
static void cut(const struct aiMesh *mesh, const unsigned *corner, unsigned count, outline *o, uint32_t *triangle) {
    see_from_front(mesh, corner, count, o);
    unsigned at = 1;
    for (unsigned left = count; left >= 3; left--) {
        unsigned ear = at, tried = 0;
        while (left > 3 && tried < left && !is_ear(o, ear)) {
            ear = o->after[ear];
            tried++;
        }
        const unsigned a = o->before[ear], c = o->after[ear];
        *triangle++ = corner[a];
        *triangle++ = corner[ear];
        *triangle++ = corner[c];
        o->after[a] = c;
        o->before[c] = a;
        at = o->after[c]; /* not the neighbour: fewer long fans */
    }
}

bool assimp_cut(assimp_scene *a, const struct aiMesh *mesh, polygon_cut *out) {
    size_t triangles = 0, polygons = 0;
    for (unsigned i = 0; i < mesh->mNumFaces; i++)
        if (mesh->mFaces[i].mNumIndices > 4) {
            polygons++;
            triangles += mesh->mFaces[i].mNumIndices - 2;
        }
    if (polygons == 0 || !mesh->mVertices)
        return true;
    outline *o = malloc(sizeof *o);
    out->corner = calloc(triangles, 3 * sizeof *out->corner);
    if (!o || !out->corner) {
        free(o);
        return import_fail(a->im, "out of memory");
    }
    for (unsigned i = 0; i < mesh->mNumFaces; i++) {
        struct aiFace *face = &mesh->mFaces[i];
        if (face->mNumIndices <= 4)
            continue;
        cut(mesh, face->mIndices, face->mNumIndices, o, out->corner + 3 * out->triangles);
        out->triangles += face->mNumIndices - 2;
        face->mNumIndices = 0;
    }
    free(o);
    return true;
}
