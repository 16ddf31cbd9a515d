#include "cache/sights.h"
#include "common/fail.h"
#include "common/parallel.h"
#include "light/photons.h"
#include <stdlib.h>
#include <string.h>

#define RAYS 2e6         /* from the cameras, over all frames; at most one a pixel */
#define MOST_FRAMES 512u /* of the path that are looked at */
#define MOST_MIRRORS 16u /* that a ray meets one after another */

typedef struct looking {
    const cache_sights_input *in;
    uint32_t frame, step, across;
    cache_sight *row; /* of the frame; distance 0: nothing */
} looking;

/* What the ray finds in the end. */
static cache_sight see(const looking *l, vec3 o, vec3 d, uint32_t chance) {
    const photon_rays *rays = l->in->rays;
    const vec3 eye = o;
    vec3 power = {1.0f, 1.0f, 1.0f};
    cache_sight r = {.distance = 0.0f};
    for (uint32_t k = 0; k <= MOST_MIRRORS; k++) {
        float t, b[3];
        const uint32_t triangle = photon_rays_nearest(rays, o, d, &t);
        if (triangle == VIT_NONE)
            break;
        const photon_surface at = photon_surface_seen(rays->s, o, d, t, triangle, PHOTON_CONE, b);
        if (photon_is_matt(rays->s, at.material)) {
            const vec3 way = vec3_sub(at.position, eye);
            return (cache_sight){at.position, at.normal, at.face, sqrtf(vec3_dot(way, way)), 2 * triangle + at.back,
                                 b[1],        b[2]};
        }
        chance = pcg(chance);
        d = photons_specular_bounce(&at, d, t, unit_float(chance), &o, &power);
        if (!(power.x + power.y + power.z > 0.0f))
            break;
    }
    return r;
}

static void look_row(void *user, uint32_t row) {
    const looking *l = user;
    const vit_camera *c = l->in->tracks->cameras + l->frame;
    for (uint32_t i = 0; i < l->across; i++) {
        const uint32_t chance = pcg(row * l->across + i + pcg(l->frame));
        const bool all = l->step == 1; /* then as the frame's own */
        const float x = ((float)i + (all ? 0.5f : unit_float(chance))) * (float)l->step,
                    y = ((float)row + (all ? 0.5f : unit_float(pcg(chance)))) * (float)l->step;
        const vec3 d = vec3_unit(vec3_along(vec3_along(vec3_load(c->corner), vec3_load(c->right), x), vec3_load(c->down), y));
        l->row[(size_t)row * l->across + i] = see(l, vec3_load(c->eye), d, pcg(chance ^ 1u));
    }
}

static bool is_same_view(const cache_sights_input *in, uint32_t frame, uint32_t other) {
    return memcmp(in->tracks->cameras + frame, in->tracks->cameras + other, sizeof *in->tracks->cameras) == 0;
}

static void keep(const looking *l, size_t count, cache_sights *out) {
    const vec3 right = vec3_load(l->in->tracks->cameras[l->frame].right);
    const float pixel = sqrtf(vec3_dot(right, right));
    out->pixel = out->pixel > 0.0f ? float_min(out->pixel, pixel) : pixel;
    for (size_t i = 0; i < count; i++) {
        const cache_sight *s = l->row + i;
        if (!(s->distance > 0.0f))
            continue;
        out->nearest = out->count > 0 ? float_min(out->nearest, s->distance) : s->distance;
        out->farthest = float_max(out->farthest, s->distance);
        out->sight[out->count++] = *s;
    }
}

vit_status cache_sights_find(const cache_sights_input *in, cache_sights *out, vit_text *why) {
    const uint32_t frames = in->frames < MOST_FRAMES ? in->frames : MOST_FRAMES;
    looking l = {.in = in, .step = (uint32_t)ceil(sqrt((double)in->width * in->height * frames / RAYS))};
    l.across = (in->width + l.step - 1) / l.step;
    const uint32_t down = (in->height + l.step - 1) / l.step;
    const size_t of_frame = (size_t)l.across * down;
    memset(out, 0, sizeof *out);
    l.row = malloc(of_frame * sizeof *l.row);
    out->sight = malloc(of_frame * frames * sizeof *out->sight);
    if (!l.row || !out->sight) {
        free(l.row);
        cache_sights_free(out);
        return bake_fail(why, VIT_FAILED, "out of memory");
    }
    for (uint32_t f = 0; f < frames; f++) {
        l.frame = (uint32_t)((uint64_t)f * in->frames / frames);
        if (f > 0 && l.step == 1 && is_same_view(in, l.frame, (uint32_t)((uint64_t)(f - 1) * in->frames / frames)))
            continue;
        parallel_for(in->threads, down, look_row, &l);
        keep(&l, of_frame, out);
        if (in->progress)
            in->progress(in->user, (double)(f + 1) / frames);
    }
    free(l.row);
    return VIT_OK;
}

void cache_sights_free(cache_sights *s) {
    free(s->sight);
    memset(s, 0, sizeof *s);
}
