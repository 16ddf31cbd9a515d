/* A room for tests of photons: the cube -1..1 m, a material of its own for every wall, and whatever else a test puts in. It
 * goes through the baker's own BVH, geometry and atlas. In a convex room the path before a stored photon can be told from it.
 */
#ifndef VIT_TESTS_PHOTON_ROOM_H
#define VIT_TESTS_PHOTON_ROOM_H

#include "light/photons.h"
#include "geometry/bvh.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <cmocka.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { ROOM_QUADS = 600, ROOM_MATERIALS = 10, ROOM_IMAGES = 2, ROOM_LIGHTS = 2, ROOM_IMAGE_SIZE = 64 };
enum { WALL_LEFT, WALL_RIGHT, WALL_FLOOR, WALL_CEILING, WALL_BACK, WALL_FRONT, WALLS }; /* also their materials */

typedef struct room {
    model m;
    float position[12 * ROOM_QUADS], normal[12 * ROOM_QUADS], uv[8 * ROOM_QUADS];
    uint32_t index[6 * ROOM_QUADS], material[2 * ROOM_QUADS];
    model_material model_materials[ROOM_MATERIALS];
    model_image images[ROOM_IMAGES];
    uint8_t rgba[ROOM_IMAGES][4 * ROOM_IMAGE_SIZE * ROOM_IMAGE_SIZE];
    bvh b;
    geometry g;
    atlas a;
    vit_material materials[ROOM_MATERIALS];
    photons_light lights[ROOM_LIGHTS];
    photons_input in;
} room;

/* A parallelogram from `corner`; texture coordinates 0..1 along u and v. */
static inline void room_quad(room *r, const float corner[3], const float u[3], const float v[3], uint32_t material) {
    model *m = &r->m;
    const uint32_t first = m->vertices, order[6] = {0, 1, 2, 0, 2, 3};
    const float nx = u[1] * v[2] - u[2] * v[1], ny = u[2] * v[0] - u[0] * v[2], nz = u[0] * v[1] - u[1] * v[0];
    const float length = sqrtf(nx * nx + ny * ny + nz * nz), n[3] = {nx / length, ny / length, nz / length};
    assert_in_range(m->triangles, 0, 2 * ROOM_QUADS - 2);
    for (uint32_t i = 0; i < 4; i++) {
        const float a = i == 1 || i == 2 ? 1.0f : 0.0f, b = i >= 2 ? 1.0f : 0.0f;
        for (uint32_t k = 0; k < 3; k++) {
            m->position[3 * (first + i) + k] = corner[k] + a * u[k] + b * v[k];
            m->normal[3 * (first + i) + k] = n[k];
        }
        m->uv[2 * (first + i)] = a;
        m->uv[2 * (first + i) + 1] = b;
    }
    for (uint32_t i = 0; i < 6; i++)
        m->index[3 * (size_t)m->triangles + i] = first + order[i];
    m->material[m->triangles] = m->material[m->triangles + 1] = material;
    m->vertices += 4;
    m->triangles += 2;
    r->model_materials[material].triangles += 2;
}

/* A ball of triangles with the ball's normals at their vertices, facing outwards. */
static inline void room_ball(room *r, const float center[3], float radius, uint32_t material) {
    enum { ROUND = 16, DOWN = 8 };
    model *m = &r->m;
    for (int j = 0; j < DOWN; j++)
        for (int i = 0; i < 2 * ROUND; i++) { /* two triangles a quad, one at the poles */
            if ((j == 0 && i % 2 == 0) || (j == DOWN - 1 && i % 2))
                continue;
            const int column[2][3] = {{0, 1, 1}, {0, 1, 0}}, row[2][3] = {{0, 0, 1}, {0, 1, 1}};
            assert_in_range(m->vertices, 0, 4 * ROOM_QUADS - 3);
            assert_in_range(m->triangles, 0, 2 * ROOM_QUADS - 1);
            for (int k = 0; k < 3; k++) {
                const int across = i / 2 + column[i % 2][k], down = j + row[i % 2][k];
                const float a = (float)(across % ROUND) * (6.28318531f / ROUND), b = (float)down * (3.14159265f / DOWN);
                const float ring = down == 0 || down == DOWN ? 0.0f : sinf(b);
                const float n[3] = {ring * cosf(a), down == 0 ? 1.0f : down == DOWN ? -1.0f : cosf(b), ring * sinf(a)};
                const uint32_t v = m->vertices++;
                for (uint32_t c = 0; c < 3; c++) {
                    m->normal[3 * v + c] = n[c];
                    m->position[3 * v + c] = center[c] + radius * n[c];
                }
                m->index[3 * m->triangles + (uint32_t)k] = v;
            }
            m->material[m->triangles++] = material;
            r->model_materials[material].triangles++;
        }
}

/* Wall w: axis w / 2, at -1 or +1, facing inwards. The floor's u runs along x, its v along -z. */
static inline void room_wall(room *r, int w) {
    static const float corners[WALLS][3] = {{-1, -1, 1}, {1, -1, -1}, {-1, -1, 1}, {-1, 1, -1}, {-1, -1, -1}, {1, -1, 1}};
    static const float us[WALLS][3] = {{0, 0, -2}, {0, 0, 2}, {2, 0, 0}, {2, 0, 0}, {2, 0, 0}, {-2, 0, 0}};
    static const float vs[WALLS][3] = {{0, 2, 0}, {0, 2, 0}, {0, 0, -2}, {0, 0, 2}, {0, 2, 0}, {0, 2, 0}};
    room_quad(r, corners[w], us[w], vs[w], (uint32_t)w);
}

/* Everything but the walls; all materials of one grey. Free with room_drop(). */
static inline room *room_empty(float albedo) {
    room *r = calloc(1, sizeof *r);
    assert_non_null(r);
    r->m = (model){.position = r->position,
                   .normal = r->normal,
                   .uv = r->uv,
                   .index = r->index,
                   .material = r->material,
                   .materials = r->model_materials,
                   .material_count = ROOM_MATERIALS,
                   .images = r->images,
                   .image_count = ROOM_IMAGES,
                   .lo = {-1, -1, -1},
                   .hi = {1, 1, 1}};
    for (int i = 0; i < ROOM_MATERIALS; i++)
        r->model_materials[i] = (model_material){.albedo = {albedo, albedo, albedo}, .image = -1, .alpha = 1.0f};
    for (int i = 0; i < ROOM_IMAGES; i++)
        r->images[i] = (model_image){.width = ROOM_IMAGE_SIZE, .height = ROOM_IMAGE_SIZE, .rgba = r->rgba[i]};
    return r;
}

static inline room *room_closed(float albedo) {
    room *r = room_empty(albedo);
    for (int w = 0; w < WALLS; w++)
        room_wall(r, w);
    return r;
}

static inline void room_paint(room *r, uint32_t material, float red, float green, float blue) {
    float *a = r->model_materials[material].albedo;
    a[0] = red;
    a[1] = green;
    a[2] = blue;
}

/* Gives `material` image `i`: grey `left` and alpha `left_alpha` where u < 1/2, the right values elsewhere. */
static inline void room_texture(room *r, uint32_t material, int i, uint8_t left, uint8_t left_alpha, uint8_t right,
                                uint8_t right_alpha) {
    for (int t = 0; t < ROOM_IMAGE_SIZE * ROOM_IMAGE_SIZE; t++) {
        const int is_left = t % ROOM_IMAGE_SIZE < ROOM_IMAGE_SIZE / 2;
        memset(&r->rgba[i][4 * t], is_left ? left : right, 3);
        r->rgba[i][4 * t + 3] = is_left ? left_alpha : right_alpha;
    }
    r->model_materials[material].image = i;
}

static inline photons_light room_point_light(float x, float y, float z, uint32_t paths) {
    return (photons_light){.light = {.position = {x, y, z},
                                     .kind = VIT_LIGHT_POINT,
                                     .direction = {0, -1, 0},
                                     .cos_outer = -1.0f,
                                     .intensity = {1.0f, 2.0f, 3.0f},
                                     .spot_offset = 1.0f},
                           .paths = paths};
}

/* Bakes what photons need. The materials are those that the planner would write. */
static inline void room_finish(room *r, uint32_t lights, uint32_t bounces) {
    vit_text why = {""};
    assert_int_equal(bvh_build(&r->m, 1, &r->b, &why), VIT_OK);
    assert_int_equal(geometry_pack(&r->m, &r->b, &r->g, &why), VIT_OK);
    assert_int_equal(atlas_pack(&r->m, &r->a, &why), VIT_OK);
    for (int i = 0; i < ROOM_MATERIALS; i++) {
        memcpy(r->materials[i].albedo, r->model_materials[i].albedo, sizeof r->materials[i].albedo);
        r->materials[i].texture = r->a.material_texture[i];
        r->materials[i].cutout = r->model_materials[i].cutoff > 0.0f && r->materials[i].texture != VIT_NONE;
    }
    r->in = (photons_input){.triangles = r->g.triangles,
                            .attributes = r->g.attributes,
                            .triangle_count = r->m.triangles,
                            .materials = r->materials,
                            .atlas = &r->a,
                            .ray_offset = r->g.ray_offset,
                            .box_pad = r->b.box_pad,
                            .radius = 0.25f,
                            .bounces = bounces,
                            .lights = r->lights,
                            .light_count = lights};
}

/* What a finished room is to rays and photons. */
static inline photon_scene room_scene(const room *r) {
    return (photon_scene){.triangles = r->g.triangles,
                          .attributes = r->g.attributes,
                          .triangle_count = r->m.triangles,
                          .materials = r->materials,
                          .atlas = &r->a,
                          .ray_offset = r->g.ray_offset,
                          .box_pad = r->b.box_pad};
}

static inline vit_photon *room_bake(const room *r, unsigned threads, uint32_t *count) {
    vit_photon *photons = NULL;
    vit_text why = {""};
    if (photons_bake(&r->in, threads, &photons, count, &why) != VIT_OK)
        fail_msg("photons_bake: %s", why.text);
    return photons;
}

static inline void room_drop(room *r) {
    atlas_free(&r->a);
    geometry_free(&r->g);
    bvh_free(&r->b);
    free(r);
}

/* Incident power of a photon in a channel, W. */
static inline double room_watts(const vit_photon *p, int channel) {
    return (double)p->power[channel] * 3.14159265358979 * (double)p->radius2 / 2.0;
}

/* The wall from which the photon came in a closed, empty room, and the place there. */
static inline int room_origin(const vit_photon *p, double at[3]) {
    double nearest = 1e30;
    int wall = -1;
    for (int k = 0; k < 3; k++) {
        const double d = -(double)p->direction[k], t = ((d > 0 ? 1.0 : -1.0) - (double)p->position[k]) / d;
        if (d != 0.0 && t < nearest) {
            nearest = t;
            wall = 2 * k + (d > 0);
        }
    }
    for (int k = 0; k < 3; k++)
        at[k] = (double)p->position[k] - nearest * (double)p->direction[k];
    return wall;
}

#endif
