/* A closed box whose every point six views from within see once: means over its surface of what they show. */
#ifndef VIT_TESTS_FURNACE_BOX_H
#define VIT_TESTS_FURNACE_BOX_H

#include "scene_lab.h"
#include <math.h>

#define PI 3.14159265358979
#define SIDE 64 /* pixels of a frame's edge */
#define VIEWS 6
#define FLOATS ((size_t)4 * SIDE * SIDE * VIEWS)

static const double box_lo[3] = {-1.2, -0.7, -1.5}, box_hi[3] = {1.0, 0.9, 1.3}, eye[3] = {0.1, 0.05, -0.2};
/* View axis and up of each frame. */
static const double axis[VIEWS][3] = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
static const double up[VIEWS][3] = {{0, 1, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, 1}, {0, 1, 0}, {0, 1, 0}};

/* The camera of a scene file: one view a second from `from`. */
static inline void write_views(FILE *f, const double from[3]) {
    (void)fprintf(f, "camera: { near = 0.1; keys = (");
    for (int i = 0; i < VIEWS; i++)
        (void)fprintf(f, "%s{ time = %d.0; fov = 90.0; eye = [%g, %g, %g]; target = [%g, %g, %g]; up = [%g, %g, %g]; }",
                      i ? ", " : "", i, from[0], from[1], from[2], from[0] + axis[i][0], from[1] + axis[i][1],
                      from[2] + axis[i][2], up[i][0], up[i][1], up[i][2]);
    (void)fprintf(f, "); };\n");
}

/* The box of material `material` of half.mtl. */
static inline void write_box(scene_lab *l, const char *material) {
    static const int side[6][4] = {{1, 2, 4, 3}, {5, 7, 8, 6}, {1, 5, 6, 2}, {3, 4, 8, 7}, {1, 3, 7, 5}, {2, 6, 8, 4}};
    FILE *f = scene_lab_create(l, "box.obj");
    (void)fprintf(f, "mtllib half.mtl\nusemtl %s\n", material);
    for (int i = 0; i < 8; i++)
        (void)fprintf(f, "v %g %g %g\n", i & 4 ? box_hi[0] : box_lo[0], i & 2 ? box_hi[1] : box_lo[1],
                      i & 1 ? box_hi[2] : box_lo[2]);
    for (int k = 0; k < 3; k++)
        for (int i = 0; i < 2; i++) /* normals of the sides, so that none are made smooth */
            (void)fprintf(f, "vn %d %d %d\n", k == 0 ? 1 - 2 * i : 0, k == 1 ? 1 - 2 * i : 0, k == 2 ? 1 - 2 * i : 0);
    for (int i = 0; i < 6; i++) {
        static const int normal[6] = {1, 2, 3, 4, 5, 6};
        (void)fprintf(f, "f");
        for (int k = 0; k < 4; k++)
            (void)fprintf(f, " %d//%d", side[i][k], normal[i]);
        (void)fprintf(f, "\n");
    }
    (void)fclose(f);
}

static inline double box_area(void) {
    const double x = box_hi[0] - box_lo[0], y = box_hi[1] - box_lo[1], z = box_hi[2] - box_lo[2];
    return 2 * (x * y + y * z + z * x);
}

/* Solid angle, sr, of a square of 2 / n of the view's width about u, v in -1 .. 1. */
static inline double solid_angle(double u, double v, int n) {
    return 4.0 / (n * n) / pow(1 + u * u + v * v, 1.5);
}

/* Area of the box's surface that n x n pixels' worth of view i sees about u, v (up), m2. */
static inline double seen_area(int i, double u, double v, int n) {
    const double right[3] = {axis[i][1] * up[i][2] - axis[i][2] * up[i][1], axis[i][2] * up[i][0] - axis[i][0] * up[i][2],
                             axis[i][0] * up[i][1] - axis[i][1] * up[i][0]};
    double d[3], length = sqrt(1 + u * u + v * v), t = 1e30, cosine = 1;
    for (int k = 0; k < 3; k++)
        d[k] = (axis[i][k] + u * right[k] + v * up[i][k]) / length;
    for (int k = 0; k < 3; k++)
        if (fabs(d[k]) > 1e-12) {
            const double at = ((d[k] > 0 ? box_hi[k] : box_lo[k]) - eye[k]) / d[k];
            if (at < t) {
                t = at;
                cosine = fabs(d[k]);
            }
        }
    return t * t * solid_angle(u, v, n) / cosine;
}

/* The same of a pixel, summed over PARTS x PARTS points, since edges run through pixels. */
static inline double pixel_area(int i, int x, int y) {
    enum { PARTS = 8 };
    double sum = 0;
    for (int k = 0; k < PARTS * PARTS; k++)
        sum += seen_area(i, (2.0 * (x * PARTS + k % PARTS) + 1) / (SIDE * PARTS) - 1,
                         1 - (2.0 * (y * PARTS + k / PARTS) + 1) / (SIDE * PARTS), SIDE * PARTS);
    return sum;
}

/* Albedo as view samples store it: a square root in 10 bits. */
static inline double stored_albedo(double albedo) {
    const double root = floor(sqrt(albedo) * 1023 + 0.5) / 1023;
    return root * root;
}

#endif
