#include "light/panes.h"
#include "light/photon_specular.h"

#define MOST_PANES 4u /* between a place and a light */

bool panes_there(const photon_scene *s) {
    for (uint32_t i = 0; i < s->triangle_count && s->effects & VIT_BIT(GLASS); i++)
        if (s->materials[s->attributes[i].material & VIT_MATERIAL_INDEX].kind == VIT_THIN_GLASS)
            return true;
    return false;
}

vec3 panes_pass(const photon_rays *rays, bool panes, vec3 p, vec3 d, float distance, float *mirror) {
    const photon_scene *s = rays->s;
    vec3 part = {1.0f, 1.0f, 1.0f};
    *mirror = -1.0f;
    for (uint32_t k = 0; panes && k < MOST_PANES; k++) {
        float t;
        const uint32_t triangle = photon_rays_nearest(rays, p, d, &t);
        if (triangle == VIT_NONE || t >= distance - 2.0f * s->ray_offset)
            return part;
        const photon_surface at = photon_surface_at(s, p, d, t, triangle);
        if (at.material->kind != VIT_THIN_GLASS)
            return (vec3){0.0f, 0.0f, 0.0f};
        *mirror = specular_at_glass(d, at.normal, at.face, at.back, true, at.material->ior).mirror;
        part = vec3_scale(vec3_times(part, vec3_load(at.material->specular)), 1.0f - *mirror);
        p = at.beyond;
        distance -= t;
    }
    return photon_rays_occluded(rays, p, d, distance - 2.0f * s->ray_offset) ? (vec3){0.0f, 0.0f, 0.0f} : part;
}
