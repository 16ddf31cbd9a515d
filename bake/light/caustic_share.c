#include "light/caustic_share.h"
#include "common/parallel.h"
#include "light/light_model.h"
#include "light/photons.h"
#include <stdlib.h>

#define MOST_HITS 16u /* mirrors and glass that a path meets one after another */

typedef struct tracing {
    const photon_rays *rays;
    const photons_light *l;
    float *landed; /* a path: its power at the first matt surface; below 0: it came by mirrors or glass */
} tracing;

static void trace(void *user, uint32_t path) {
    const tracing *w = user;
    const photon_scene *of = w->rays->s;
    const emission start = photon_leave(w->rays, w->l, path, path);
    vec3 o = start.origin, d = start.direction, power = start.power;
    uint32_t chance = pcg(path);
    w->landed[path] = 0.0f;
    for (uint32_t hit = 0; hit < MOST_HITS && power.x + power.y + power.z > 0.0f; hit++) {
        float t = 0.0f;
        const uint32_t triangle = photon_rays_nearest(w->rays, o, d, &t);
        if (triangle == VIT_NONE)
            return;
        const photon_surface s = photon_surface_at(of, o, d, t, triangle);
        if (hit == 0 && !w->l->area && !w->l->sky)
            power = vec3_scale(power, light_left(&w->l->light, t * t));
        if (photon_is_matt(of, s.material)) {
            const float mean = (power.x + power.y + power.z) / 3.0f;
            w->landed[path] = hit > 0 ? -mean : mean;
            return;
        }
        chance = pcg(chance);
        d = photons_specular_bounce(&s, d, t, unit_float(chance), &o, &power);
    }
}

bool caustic_share_find(const photon_rays *rays, const photons_light *l, unsigned threads, caustic_share *out) {
    tracing w = {.rays = rays, .l = l, .landed = malloc(l->paths * sizeof *w.landed + 1)};
    *out = (caustic_share){0.0, 0.0};
    if (!w.landed)
        return false;
    parallel_for(threads, l->paths, trace, &w);
    for (uint32_t i = 0; i < l->paths; i++) {
        out->straight += w.landed[i] > 0.0f ? (double)w.landed[i] : 0.0;
        out->by_specular -= w.landed[i] < 0.0f ? (double)w.landed[i] : 0.0;
    }
    free(w.landed);
    return true;
}
