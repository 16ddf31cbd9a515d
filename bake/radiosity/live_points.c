#include "common/fail.h"
#include "common/parallel.h"
#include "radiosity/live_parts.h"
#include <stdlib.h>

typedef struct pointing {
    const live_input *in;
    const patch_set *p;
    live *out;
    uint32_t *share;    /* a patch: points that it may have, */
    size_t *first;      /* and where they begin */
    patch_point *point; /* of one patch after another */
    float *weight;
    uint32_t *count; /* a patch */
} pointing;

static vec3 place_of(const pointing *w, const patch_point *q) {
    return side_place(w->in->geometry, q->side, q->b1, q->b2);
}

static float apart2(const pointing *w, const patch_point *a, const patch_point *b) {
    const vec3 way = vec3_sub(place_of(w, a), place_of(w, b));
    return vec3_dot(way, way);
}

/* Of the places where paths met the patch those that are farthest from each other, from the first on; the others count for the
 * one that they are nearest to. Of a patch that no path met, places by chance. */
static void choose(void *user, uint32_t patch) {
    const pointing *w = user;
    patch_point met[PATCHES_POINTS];
    float near[PATCHES_POINTS] = {0};
    const uint32_t share = w->share[patch];
    uint32_t all = w->p->point_count[patch], nearest[PATCHES_POINTS] = {0};
    for (uint32_t i = 0; i < all; i++)
        met[i] = w->p->points[(size_t)patch * PATCHES_POINTS + i];
    for (; w->p->point_count[patch] == 0 && all < share; all++) {
        const float u = unit_float(all * 0xd1b54a33u + pcg(patch)), v = unit_float(all * 0xabc98389u + 0x40000000u),
                    x = unit_float(all * 0x8cb92ba7u + 0x80000000u);
        met[all].side = patches_place(w->p, patch, u, v, x, &met[all].b1, &met[all].b2);
    }
    patch_point *to = w->point + w->first[patch];
    float *weight = w->weight + w->first[patch];
    uint32_t count = 0, next = 0;
    for (uint32_t i = 0; i < all; i++)
        near[i] = INFINITY;
    while (count < share && near[next] > 0.0f) {
        to[count] = met[next];
        for (uint32_t i = 0; i < all; i++) {
            const float d2 = apart2(w, &met[i], &to[count]);
            if (d2 < near[i]) {
                near[i] = d2;
                nearest[i] = count;
            }
        }
        count++;
        next = 0;
        for (uint32_t i = 1; i < all; i++)
            next = near[i] > near[next] ? i : next;
    }
    for (uint32_t i = 0; i < count; i++)
        weight[i] = 0.0f;
    for (uint32_t i = 0; i < all; i++)
        weight[nearest[i]] += 1.0f / (float)all;
    w->count[patch] = count;
}

static void describe(void *user, uint32_t patch) {
    const pointing *w = user;
    const photon_scene *s = w->in->rays->s;
    const radiosity_patch *from = w->p->patch + patch;
    const vit_patch *own = w->out->patches + patch;
    const float high = float_max(sqrtf(from->area / (float)w->count[patch]) * 0.5f, 4.0f * s->ray_offset);
    for (uint32_t i = own->first; i < own->end; i++) {
        const size_t at_point = w->first[patch] + (i - own->first);
        const patch_point *q = w->point + at_point;
        const vec3 face = side_face(w->in->geometry, q->side), place = place_of(w, q);
        float b[3];
        const photon_surface at =
            photon_surface_seen(s, vec3_along(place, face, high), vec3_scale(face, -1.0f), high, q->side / 2, 0.25f, b);
        const vec3 off = vec3_along(place, face, s->ray_offset);
        const vec3 reflectance = photon_reflectance(s, &at);
        const float albedo[3] = {reflectance.x, reflectance.y, reflectance.z};
        vit_patch_point *to = w->out->points + i;
        *to = (vit_patch_point){.position = {off.x, off.y, off.z},
                                .patch = patch,
                                .normal = {at.normal.x, at.normal.y, at.normal.z},
                                .weight = float_min(w->weight[at_point], 1.0f)};
        for (int k = 0; k < 3; k++) {
            to->albedo[k] = float_min(albedo[k], VIT_MAX_ALBEDO);
            to->reflect[k] = from->albedo[k] > 0.0f ? float_min(to->albedo[k] / from->albedo[k], VIT_MAX_REFLECT) : 0.0f;
        }
    }
}

/* Points beyond the last patch's fill up a whole sixteen. */
static bool number(pointing *w) {
    live *o = w->out;
    uint32_t end = 0;
    o->patch_count = w->p->count;
    o->patches = calloc(w->p->count, sizeof *o->patches);
    for (uint32_t i = 0; o->patches && i < w->p->count; i++) {
        o->patches[i] = (vit_patch){.first = end, .end = end + w->count[i]};
        end += w->count[i];
    }
    o->point_count = (end + 15u) / 16u * 16u;
    o->points = calloc(o->point_count, sizeof *o->points);
    for (uint32_t i = end; o->points && i < o->point_count; i++)
        o->points[i].normal[1] = 1.0f;
    return o->patches && o->points;
}

uint32_t live_points_room(uint32_t patches) {
    return (VIT_MAX_COLUMNS - codec_stride(patches) - 16u) / patches;
}

/* Room for all patches' points. False: out of memory. */
static bool make_room(pointing *w) {
    const uint32_t patches = w->p->count, room = live_points_room(patches);
    w->out->each = w->in->points < room ? w->in->points : room;
    w->share = malloc(patches * sizeof *w->share);
    w->first = malloc((patches + 1u) * sizeof *w->first);
    w->count = malloc(patches * sizeof *w->count);
    if (!w->share || !w->first || !w->count || !live_share(w->in, w->p, w->out->each, w->share))
        return false;
    w->first[0] = 0;
    for (uint32_t i = 0; i < patches; i++)
        w->first[i + 1] = w->first[i] + w->share[i];
    w->point = malloc((w->first[patches] + 1u) * sizeof *w->point);
    w->weight = malloc((w->first[patches] + 1u) * sizeof *w->weight);
    return w->point && w->weight;
}

vit_status live_points(const live_input *in, const patch_set *p, live *out, vit_text *why) {
    pointing w = {.in = in, .p = p, .out = out};
    bool fine = make_room(&w);
    if (fine) {
        parallel_for(in->threads, p->count, choose, &w);
        fine = number(&w);
    }
    if (fine)
        parallel_for(in->threads, p->count, describe, &w);
    free(w.share);
    free(w.first);
    free(w.point);
    free(w.weight);
    free(w.count);
    return fine ? VIT_OK : bake_fail(why, VIT_FAILED, "live radiosity: out of memory");
}
