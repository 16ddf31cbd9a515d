/* Scenes of boxes and plates made in memory, and which of their sides are dark. */
#ifndef VIT_TESTS_DARK_SIDES_LAB_H
#define VIT_TESTS_DARK_SIDES_LAB_H

#include "pack/planner.h"
#include "dark_sides/dark_sides.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
#include <stdlib.h>
#include <string.h>

#define MAX_TRIANGLES 40000
#define MAX_FRAMES 100

enum { OPAQUE, CUT_OUT, MIRROR, GLASS, THIN_GLASS, LAMP };

typedef struct fixture {
    model m;
    model_material materials[6]; /* opaque, cut out, mirror, glass, thin glass, lamp */
    bvh b;
    geometry g;
    vit_light lights[MAX_FRAMES];
    vit_camera *cameras; /* a frame; NULL: nothing is looked at */
    uint32_t frames;
    bool sky;
    uint32_t flags[MAX_TRIANGLES]; /* found, by the triangle's number in the model */
    dark_sides r;
} fixture;

static inline fixture *make(void) {
    fixture *f = calloc(1, sizeof *f);
    assert_non_null(f);
    f->m.position = calloc(9 * MAX_TRIANGLES, sizeof(float));
    f->m.normal = calloc(9 * MAX_TRIANGLES, sizeof(float));
    f->m.uv = calloc(6 * MAX_TRIANGLES, sizeof(float));
    f->m.index = calloc(3 * MAX_TRIANGLES, sizeof(uint32_t));
    f->m.material = calloc(MAX_TRIANGLES, sizeof(uint32_t));
    assert_true(f->m.position && f->m.normal && f->m.uv && f->m.index && f->m.material);
    f->m.materials = f->materials;
    f->m.material_count = 6;
    for (int i = 0; i < 6; i++)
        f->materials[i] = (model_material){.image = -1, .exponent = 1.0f, .ior = 1.5f};
    f->materials[MIRROR].kind = VIT_MIRROR;
    f->materials[GLASS].kind = VIT_GLASS;
    f->materials[THIN_GLASS].kind = VIT_THIN_GLASS;
    f->materials[LAMP].emission[1] = 1.0f;
    f->materials[LAMP].area_light = true;
    f->materials[1].cutoff = 0.5f;
    return f;
}

static inline void drop(fixture *f) {
    bvh_free(&f->b);
    geometry_free(&f->g);
    free(f->m.position);
    free(f->m.normal);
    free(f->m.uv);
    free(f->m.index);
    free(f->m.material);
    free(f);
}

static inline void add_triangle(fixture *f, const float a[3], const float b[3], const float c[3]) {
    assert_true(f->m.triangles < MAX_TRIANGLES);
    const float *corner[3] = {a, b, c};
    for (uint32_t i = 0; i < 3; i++) {
        memcpy(f->m.position + 3 * (size_t)f->m.vertices, corner[i], 3 * sizeof(float));
        f->m.normal[3 * (size_t)f->m.vertices + 1] = 1.0f;
        f->m.index[3 * (size_t)f->m.triangles + i] = f->m.vertices++;
    }
    f->m.triangles++;
}

/* Two triangles a cell; the front is where `u` x `v` points. */
static inline void add_plate(fixture *f, const float o[3], const float u[3], const float v[3], int cells) {
    for (int j = 0; j < cells; j++)
        for (int i = 0; i < cells; i++) {
            float p[4][3];
            for (int c = 0; c < 4; c++)
                for (int k = 0; k < 3; k++)
                    p[c][k] = o[k] + u[k] * (float)(i + (c & 1)) / (float)cells + v[k] * (float)(j + (c >> 1)) / (float)cells;
            add_triangle(f, p[0], p[1], p[3]);
            add_triangle(f, p[0], p[3], p[2]);
        }
}

/* A closed box: faces -x +x -y +y -z +z, each of 2 cells^2 triangles. Returns its first triangle. */
static inline uint32_t add_box(fixture *f, const float lo[3], const float hi[3], int cells) {
    const uint32_t first = f->m.triangles;
    for (int axis = 0; axis < 3; axis++)
        for (int side = 0; side < 2; side++) {
            float o[3] = {lo[0], lo[1], lo[2]}, u[3] = {0, 0, 0}, v[3] = {0, 0, 0};
            const int a = (axis + 1) % 3, b = (axis + 2) % 3;
            o[axis] = side ? hi[axis] : lo[axis];
            u[side ? a : b] = side ? hi[a] - lo[a] : hi[b] - lo[b];
            v[side ? b : a] = side ? hi[b] - lo[b] : hi[a] - lo[a];
            add_plate(f, o, u, v, cells);
        }
    return first;
}

static inline void add_light(fixture *f, float x, float y, float z) {
    f->lights[f->frames++] = (vit_light){.position = {x, y, z}, .intensity = {1.0f, 1.0f, 1.0f}, .cos_outer = -1.0f};
}

static inline void search(fixture *f, unsigned threads) {
    const tracks t = {.cameras = f->cameras, .lights = f->lights, .light_count = f->frames > 0};
    vit_text why = {""};
    bvh_free(&f->b);
    geometry_free(&f->g);
    const dark_sides_input in = {
        .model = &f->m, .tracks = &t, .frames = f->frames > 0 ? f->frames : 1, .sky_light = f->sky, .threads = threads};
    if (bvh_build(&f->m, 1, &f->b, &why) != VIT_OK || geometry_pack(&f->m, &f->b, &f->g, &why) != VIT_OK ||
        dark_sides_find(&in, &f->g, &f->r, &why) != VIT_OK)
        fail_msg("%s", why.text);
    for (uint32_t i = 0; i < f->m.triangles; i++)
        f->flags[f->b.order[i]] = f->g.attributes[i].material & (VIT_SIDE_DARK_FRONT | VIT_SIDE_DARK_BACK);
}

static inline void paint(fixture *f, uint32_t first, uint32_t count, uint32_t material) {
    for (uint32_t i = first; i < first + count; i++)
        f->m.material[i] = material;
}

static inline void expect(const fixture *f, uint32_t first, uint32_t count, uint32_t wanted) {
    for (uint32_t i = first; i < first + count; i++)
        assert_int_equal(f->flags[i], wanted);
}

#define ROOM ((const float[3]){-5, 0, -5}), ((const float[3]){5, 5, 5})

#endif
