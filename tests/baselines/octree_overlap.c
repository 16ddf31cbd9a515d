/* Triangle against box: a plane that separates them is across one of thirteen axes. */
#include "octree.h"
#include <math.h>

static double dot(const double a[3], const double b[3]) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void cross(const double a[3], const double b[3], double c[3]) {
    for (int k = 0; k < 3; k++)
        c[k] = a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3];
}

/* Do the shadows of vertices and of the box on the axis lie apart? */
static bool apart(double v[3][3], const double half[3], const double axis[3]) {
    const double a = dot(v[0], axis), b = dot(v[1], axis), c = dot(v[2], axis);
    const double reach = half[0] * fabs(axis[0]) + half[1] * fabs(axis[1]) + half[2] * fabs(axis[2]);
    return fmin(a, fmin(b, c)) > reach || fmax(a, fmax(b, c)) < -reach;
}

static bool apart_across_edges(double v[3][3], double edge[3][3], const double half[3]) {
    for (int e = 0; e < 3; e++)
        for (int k = 0; k < 3; k++) {
            double axis[3];
            const double unit[3] = {k == 0, k == 1, k == 2};
            cross(unit, edge[e], axis);
            if (apart(v, half, axis))
                return true;
        }
    return false;
}

bool octree_touches(const double middle[3], const double half[3], const vit_triangle *t) {
    double v[3][3], edge[3][3], normal[3];
    for (int k = 0; k < 3; k++) {
        v[0][k] = (double)t->v0[k] - middle[k];
        v[1][k] = (double)t->v1[k] - middle[k];
        v[2][k] = (double)t->v2[k] - middle[k];
        if (fmin(v[0][k], fmin(v[1][k], v[2][k])) > half[k] || fmax(v[0][k], fmax(v[1][k], v[2][k])) < -half[k])
            return false;
    }
    for (int e = 0; e < 3; e++)
        for (int k = 0; k < 3; k++)
            edge[e][k] = v[(e + 1) % 3][k] - v[e][k];
    cross(edge[0], edge[1], normal);
    return !apart(v, half, normal) && !apart_across_edges(v, edge, half);
}
