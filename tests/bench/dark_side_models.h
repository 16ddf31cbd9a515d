/* Meshes of any number of triangles for bench_dark_sides.c: what reach has most to do with.
 *   parts: a closed housing full of small closed parts, a fifth of them outside: nearly all sides are dark, as in a CAD model
 *   balls: finely tessellated balls on the floor of a room, a light in the room: fronts are lit, backs are dark */
#ifndef VIT_BENCH_REACH_MODELS_H
#define VIT_BENCH_REACH_MODELS_H

#include "measure.h"
#include "import/model.h"
#include "motion/tracks.h"

#define DARK_SIDES_FRAMES 24u
#define REACH_FACETS 24u /* of a part: a bolt of 4 * REACH_FACETS triangles */
#define REACH_BALLS 64u

typedef struct reach_model {
    model m;
    model_material material;
    vit_light lights[DARK_SIDES_FRAMES];
    tracks t;
} reach_model;

static inline uint32_t reach_vertex(model *m, double x, double y, double z) {
    const float p[3] = {(float)x, (float)y, (float)z};
    memcpy(m->position + 3 * (size_t)m->vertices, p, sizeof p);
    m->normal[3 * (size_t)m->vertices + 1] = 1.0f;
    return m->vertices++;
}

static inline void reach_triangle(model *m, uint32_t a, uint32_t b, uint32_t c) {
    const uint32_t corner[3] = {a, b, c};
    memcpy(m->index + 3 * (size_t)m->triangles++, corner, sizeof corner);
}

/* Closed, 12 triangles, fronts outside. */
static inline void reach_box(model *m, const double lo[3], const double hi[3]) {
    static const uint32_t quads[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
    const uint32_t first = m->vertices;
    for (int i = 0; i < 8; i++)
        reach_vertex(m, i & 1 ? hi[0] : lo[0], i & 2 ? hi[1] : lo[1], i & 4 ? hi[2] : lo[2]);
    for (int i = 0; i < 6; i++) {
        reach_triangle(m, first + quads[i][0], first + quads[i][1], first + quads[i][2]);
        reach_triangle(m, first + quads[i][0], first + quads[i][2], first + quads[i][3]);
    }
}

/* A bolt about the vertical axis through (x, z), from y up, closed. */
static inline void reach_bolt(model *m, double x, double y, double z, double radius, double height) {
    const uint32_t n = REACH_FACETS, first = m->vertices;
    for (uint32_t i = 0; i < n; i++) {
        const double angle = 6.283185307179586 * i / n, px = x + radius * cos(angle), pz = z + radius * sin(angle);
        reach_vertex(m, px, y, pz);
        reach_vertex(m, px, y + height, pz);
    }
    const uint32_t bottom = reach_vertex(m, x, y, z), top = reach_vertex(m, x, y + height, z);
    for (uint32_t i = 0; i < n; i++) {
        const uint32_t a = first + 2 * i, b = first + 2 * ((i + 1) % n);
        reach_triangle(m, a, a + 1, b + 1);
        reach_triangle(m, a, b + 1, b);
        reach_triangle(m, bottom, a, b);
        reach_triangle(m, top, b + 1, a + 1);
    }
}

/* About 2 * rows * columns triangles, closed. */
static inline void reach_ball(model *m, const double centre[3], double radius, uint32_t rows, uint32_t columns) {
    const uint32_t first = m->vertices;
    for (uint32_t j = 1; j < rows; j++)
        for (uint32_t i = 0; i < columns; i++) {
            const double v = 3.141592653589793 * j / rows, u = 6.283185307179586 * i / columns;
            reach_vertex(m, centre[0] + radius * sin(v) * cos(u), centre[1] + radius * cos(v),
                         centre[2] + radius * sin(v) * sin(u));
        }
    const uint32_t top = reach_vertex(m, centre[0], centre[1] + radius, centre[2]),
                   bottom = reach_vertex(m, centre[0], centre[1] - radius, centre[2]);
    for (uint32_t i = 0; i < columns; i++) {
        const uint32_t next = (i + 1) % columns, last = first + (rows - 2) * columns;
        reach_triangle(m, top, first + next, first + i);
        reach_triangle(m, bottom, last + i, last + next);
        for (uint32_t j = 0; j + 2 < rows; j++) {
            const uint32_t a = first + j * columns + i, b = first + j * columns + next;
            reach_triangle(m, a, b, b + columns);
            reach_triangle(m, a, b + columns, a + columns);
        }
    }
}

/* Parts on a lattice of 1 x 0.6 x 1 m, moved a little, so that many touch or cross; the housing's walls are 4 mm thick. */
static inline void reach_fill_parts(model *m, uint32_t parts) {
    const uint32_t inside = parts * 4 / 5;
    const double each = cbrt(0.6 / inside);
    const uint32_t nx = (uint32_t)(1.0 / each) + 1, ny = (uint32_t)(0.6 / each) + 1;
    uint32_t random = 1;
    for (uint32_t i = 0; i < parts; i++) {
        double jitter[3];
        for (int k = 0; k < 3; k++) {
            random = random * 1664525u + 1013904223u;
            jitter[k] = 0.4 * each * (random >> 8) * 0x1p-24;
        }
        const uint32_t at = i < inside ? i : (i - inside) * 5 % inside;
        const double x = 0.005 + 0.99 * (at % nx) / nx + jitter[0], y = 0.005 + 0.59 * (at / nx % ny) / ny + jitter[1],
                     z = 0.005 + 0.99 * (at / (nx * ny)) / nx + jitter[2];
        reach_bolt(m, x + 0.5 * each, i < inside ? y : y + 0.7, z + 0.5 * each, 0.3 * each, 0.5 * each);
    }
    const double out = 0.004, far = 1.0 + 2.0 * each;
    reach_box(m, (const double[]){-out, -out, -out}, (const double[]){far + out, 0.6 + each + out, far + out});
    reach_box(m, (const double[]){0, 0, 0}, (const double[]){far, 0.6 + each, far});
}

static inline void reach_fill_balls(model *m, uint32_t triangles) {
    const uint32_t rows = (uint32_t)sqrt(triangles / (4.0 * REACH_BALLS)) + 2;
    for (uint32_t i = 0; i < REACH_BALLS; i++) {
        const double centre[3] = {i % 8 - 3.5, 0.4 + 0.3 * (i % 3), i / 8 - 3.5};
        reach_ball(m, centre, 0.39, rows, 2 * rows);
    }
    reach_box(m, (const double[]){-5, 0, -5}, (const double[]){5, 5, 5});
}

static inline void reach_model_close(reach_model *r) {
    free(r->m.position);
    free(r->m.normal);
    free(r->m.uv);
    free(r->m.index);
    free(r->m.material);
}

/* `balls`, or else `parts`, of about so many triangles. */
static inline void reach_model_make(reach_model *r, bool balls, uint32_t triangles) {
    const size_t room = triangles + triangles / 2 + (size_t)1024 * REACH_BALLS;
    memset(r, 0, sizeof *r);
    r->m.position = bench_array(3 * room, sizeof(float));
    r->m.normal = bench_array(3 * room, sizeof(float));
    r->m.uv = bench_array(2 * room, sizeof(float));
    r->m.index = bench_array(3 * room, sizeof(uint32_t));
    r->m.material = bench_array(room, sizeof(uint32_t));
    r->material = (model_material){.image = -1, .exponent = 1.0f, .ior = 1.0f};
    r->m.materials = &r->material;
    r->m.material_count = 1;
    if (balls)
        reach_fill_balls(&r->m, triangles);
    else
        reach_fill_parts(&r->m, triangles / (4 * REACH_FACETS) + 1);
    for (uint32_t i = 0; i < DARK_SIDES_FRAMES; i++) {
        const double angle = 6.283185307179586 * i / DARK_SIDES_FRAMES;
        const float across = (float)cos(angle), along = (float)sin(angle);
        r->lights[i] = (vit_light){.intensity = {1.0f, 1.0f, 1.0f}, .cos_outer = -1.0f};
        const float balls_at[3] = {3.0f * across, 4.0f, 3.0f * along},
                    parts_at[3] = {0.5f + 2.0f * across, 2.0f, 0.5f + 2.0f * along};
        memcpy(r->lights[i].position, balls ? balls_at : parts_at, sizeof balls_at);
    }
    r->t = (tracks){.lights = r->lights, .light_count = 1};
    for (int k = 0; k < 3; k++) {
        r->m.lo[k] = INFINITY;
        r->m.hi[k] = -INFINITY;
    }
    for (size_t i = 0; i < 3 * (size_t)r->m.vertices; i++) {
        r->m.lo[i % 3] = fmin(r->m.lo[i % 3], (double)r->m.position[i]);
        r->m.hi[i % 3] = fmax(r->m.hi[i % 3], (double)r->m.position[i]);
    }
}

#endif
