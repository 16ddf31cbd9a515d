/* Scenes of the octree's bench, straight from their files: mesh, BVH, and in frame 0 the camera's rays and the first light. */
#ifndef VIT_BENCH_OCTREE_SCENES_H
#define VIT_BENCH_OCTREE_SCENES_H

#include "motion/tracks.h"
#include "ray_lab.h"
#include "scenes.h"

/* Whole tiles of 32 pixels: no padding. */
#define PICTURE_WIDTH (bench_smoke() ? 128u : 1024u)
#define PICTURE_HEIGHT (bench_smoke() ? 64u : 576u)
#define PICTURE_SIZE (bench_smoke() ? "128x64" : "1024x576")

typedef struct raced_scene {
    const char *name;
    ray_mesh mesh;
    vit_camera camera;
    float light[3];
} raced_scene;

static const bench_scene octree_bunny = {
    "bunny",
    "stanford/bun_zipper.ply",
    false,
    0,
    "eye = [-0.02, 0.15, 0.35]; target = [-0.02, 0.11, 0.0]; fov = 40.0;",
    "{ position = [0.2, 0.4, 0.4]; power = [10.0, 10.0, 10.0]; }",
};

/* Scene file of a mesh in the folder of test scenes; false, with a message, if there is none. */
static inline bool octree_scene_file(const bench_scene *s, char out[BENCH_PATH]) {
    char mesh[BENCH_PATH];
    if (bench_smoke() || !scene_mesh_path(s, mesh))
        return false;
    bench_folder(BENCH_FOLDER);
    snprintf(out, BENCH_PATH, BENCH_FOLDER "/octree-%s.cfg", s->name);
    scene_write(s, mesh, out);
    return true;
}

static inline const bench_scene *bench_scene_named(const char *name) {
    for (size_t i = 0; i < BENCH_SCENES; i++)
        if (strcmp(bench_scenes[i].name, name) == 0)
            return &bench_scenes[i];
    bench_fail("there is no scene %s", name);
}

static inline raced_scene scene_load(const char *name, const char *path) {
    raced_scene out = {.name = name};
    scene s;
    tracks t;
    vit_text why;
    vit_status status = scene_read(path, &s, &why);
    if (status == VIT_OK) {
        s.width = (int)PICTURE_WIDTH;
        s.height = (int)PICTURE_HEIGHT;
        status = model_import(&s, false, NULL, NULL, &out.mesh.m, &why);
    }
    if (status == VIT_OK)
        status = tracks_evaluate(&s, &out.mesh.m, &t, &why);
    if (status != VIT_OK || t.light_count == 0)
        bench_fail("%s: %s", path, status != VIT_OK ? why.text : "no light");
    out.camera = t.cameras[0];
    memcpy(out.light, t.lights[0].position, sizeof out.light);
    tracks_free(&t);
    scene_free(&s);
    mesh_bake(&out.mesh);
    return out;
}

/* Tile by tile, in a tile in blocks of 4 x 4 pixels, as the frame casts them: packets are coherent. */
static inline ray_set rays_of_view(const raced_scene *r) {
    const uint32_t tile = 32, tiles_x = PICTURE_WIDTH / tile;
    const vit_camera *c = &r->camera;
    ray_set s = rays_new(PICTURE_WIDTH * PICTURE_HEIGHT);
    for (uint32_t i = 0; i < s.n; i++) {
        const uint32_t t = i / (tile * tile), in = i % (tile * tile), block = in / 16;
        const float x = (float)(t % tiles_x * tile + block % (tile / 4) * 4 + in % 4) + 0.5f;
        const float y = (float)(t / tiles_x * tile + block / (tile / 4) * 4 + in / 4 % 4) + 0.5f;
        float d[3];
        for (int k = 0; k < 3; k++)
            d[k] = c->corner[k] + x * c->right[k] + y * c->down[k];
        unit_float(d);
        rays_set(&s, i, c->eye, d, RAY_FAR);
    }
    return s;
}

/* One ray to the light from each hit whose side that the camera sees faces it, from a little off the surface. Returns how many
 * in *count; the others are not cast. */
static inline ray_set rays_of_shadow(const raced_scene *r, const ray_set *view, const float *distance, const uint32_t *triangle,
                                     uint32_t *count) {
    ray_set s = rays_new(view->n);
    *count = 0;
    for (uint32_t i = 0; i < s.n; i++) {
        float o[3], d[3], n2 = 0, seen = 0, lit = 0;
        rays_get(view, i, o, d);
        rays_limit(&s)[i] = RAY_NOT_CAST;
        if (triangle[i] == VIT_NONE)
            continue;
        const vit_triangle *t = r->mesh.packed.triangles + triangle[i];
        const float n[3] = {t->nx, t->ny, t->nz};
        for (int k = 0; k < 3; k++) {
            n2 += n[k] * n[k];
            seen -= n[k] * d[k];
        }
        const float off = copysignf(r->mesh.packed.ray_offset, seen) / sqrtf(n2);
        float to[3], d2 = 0;
        for (int k = 0; k < 3; k++) {
            o[k] += distance[i] * d[k] + off * n[k];
            to[k] = r->light[k] - o[k];
            d2 += to[k] * to[k];
            lit += to[k] * n[k];
        }
        if (!(lit * seen > 0) || !(d2 > 0))
            continue;
        unit_float(to);
        rays_set(&s, i, o, to, sqrtf(d2));
        ++*count;
    }
    return s;
}

#endif
