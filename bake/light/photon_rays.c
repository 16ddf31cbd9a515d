#include "light/photon_rays.h"

#define ONE_PLACE 0x1p-6f /* of ray_offset: faces so close lie in one place, and the first of them is seen */

/* What decides whether a hit counts. */
typedef struct rule {
    const photon_scene *s;
    uint32_t covered; /* a triangle that is not there itself: only what covers it counts (photon_rays_covered()) */
} rule;

static bool opaque(const void *user, const triangle_hit *h) {
    const photon_scene *s = user;
    const float sum = h->weight[0] + h->weight[1] + h->weight[2], scale = sum == 0.0f ? 0.0f : 1.0f / sum;
    return photon_opaque_place(s, h->triangle,
                               (const float[]){h->weight[0] * scale, h->weight[1] * scale, h->weight[2] * scale});
}

/* Is what lies at this distance before the covered triangle's place, from where the ray comes, seen instead of it? */
static bool covers(const void *user, const triangle_hit *h) {
    const rule *r = user;
    const float own = r->s->ray_offset;
    const bool before = h->triangle < r->covered ? h->distance < own * (1.0f + ONE_PLACE)
                                                 : h->triangle > r->covered && h->distance < own * (1.0f - ONE_PLACE);
    return before && opaque(r->s, h);
}

static bool has_cutouts(const photon_scene *s) {
    for (uint32_t i = 0; i < s->triangle_count; i++)
        if (s->materials[s->attributes[i].material & VIT_MATERIAL_INDEX].cutout)
            return true;
    return false;
}

uint32_t photon_rays_nearest(const photon_rays *r, vec3 origin, vec3 direction, float *distance) {
    triangle_hit h;
    if (!triangle_rays_nearest(&r->rays, origin, direction, INFINITY, r->cutouts ? opaque : NULL, r->s, &h))
        return VIT_NONE;
    *distance = h.distance;
    return h.triangle;
}

bool photon_rays_covered(const photon_rays *r, uint32_t triangle, vec3 p, vec3 n) {
    const rule one = {.s = r->s, .covered = triangle};
    return triangle_rays_any(&r->rays, p, vec3_scale(n, -1.0f), 2.0f * r->s->ray_offset, covers, &one);
}

/* Hits count from t > 0 on, as in ray_triangle(): a point on an edge lies in two surfaces, and neither shadows it. */
bool photon_rays_occluded(const photon_rays *r, vec3 origin, vec3 direction, float distance) {
    return triangle_rays_any(&r->rays, origin, direction, distance, r->cutouts ? opaque : NULL, r->s);
}

bool photon_rays_occluded_likely(const photon_rays *r, vec3 origin, vec3 direction, float distance, uint32_t *likely) {
    return triangle_rays_any_likely(&r->rays, origin, direction, distance, r->cutouts ? opaque : NULL, r->s, likely);
}

bool photon_rays_open(const photon_scene *s, unsigned threads, photon_rays *out) {
    *out = (photon_rays){.s = s, .cutouts = has_cutouts(s)};
    return triangle_rays_open(s->triangles, s->triangle_count, s->box_pad, threads, &out->rays);
}

void photon_rays_close(photon_rays *r) {
    triangle_rays_close(&r->rays);
}
