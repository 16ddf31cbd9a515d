/* A ray along each axis through the light: of a plane that it lies nearer to than ray_offset, one of them meets it within
 * sqrt(3) times that. */
#include "light/lights_in_surfaces.h"

#define ALONG_AN_AXIS 1.7320508f /* the way along the axis next to a plane's normal over the distance to the plane, at most */

static bool is_in_surface(const triangle_rays *rays, vec3 at, float reach) {
    static const vec3 axis[3] = {{1.0f, 0.0f, 0.0f}, {0.0f, 1.0f, 0.0f}, {0.0f, 0.0f, 1.0f}};
    for (int k = 0; k < 3; k++)
        if (triangle_rays_any(rays, vec3_along(at, axis[k], -reach), axis[k], 2.0f * reach, NULL, NULL))
            return true;
    return false;
}

void lights_in_surfaces(const tracks *t, uint32_t frames, const triangle_rays *rays, float ray_offset,
                        light_in_surface *found) {
    for (uint32_t i = 0; i < t->light_count; i++) {
        found[i] = (light_in_surface){.frames = 0};
        for (uint32_t f = 0; f < frames; f++) {
            const vit_light *l = t->lights + (size_t)f * t->light_count + i;
            if (l->kind == VIT_LIGHT_DIRECTIONAL || !(l->intensity[0] + l->intensity[1] + l->intensity[2] > 0.0f))
                continue;
            if (t->still[i] && f > 0)
                found[i].frames += found[i].frames > 0;
            else if (is_in_surface(rays, vec3_load(l->position), ALONG_AN_AXIS * ray_offset) && found[i].frames++ == 0)
                found[i].first = f;
        }
    }
}
