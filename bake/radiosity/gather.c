#include "radiosity/gather.h"
#include "light/photons.h"

#define MOST_MIRRORS 16u /* that a ray meets one after another */

bool gather_is_matt(const photon_scene *s, uint32_t triangle) {
    return photon_is_matt(s, s->materials + (s->attributes[triangle].material & VIT_MATERIAL_INDEX));
}

gather_hit gather(const photon_rays *rays, const geometry *g, vec3 o, vec3 d, uint32_t chance) {
    const photon_scene *s = rays->s;
    vec3 power = {1.0f, 1.0f, 1.0f};
    gather_hit r = {.side = VIT_NONE};
    for (uint32_t k = 0; k <= MOST_MIRRORS; k++) {
        float t;
        const uint32_t triangle = photon_rays_nearest(rays, o, d, &t);
        r.direction = d;
        r.weight = (power.x + power.y + power.z) / 3.0f;
        if (triangle == VIT_NONE)
            return r;
        if (gather_is_matt(s, triangle)) {
            const vit_triangle *p = s->triangles + triangle;
            const vec3 v0 = vec3_load(p->v0), e1 = vec3_sub(vec3_load(p->v1), v0), e2 = vec3_sub(vec3_load(p->v2), v0);
            const vec3 at = vec3_sub(vec3_along(o, d, t), v0);
            const double d11 = (double)vec3_dot(e1, e1), d12 = (double)vec3_dot(e1, e2), d22 = (double)vec3_dot(e2, e2);
            const double a1 = (double)vec3_dot(at, e1), a2 = (double)vec3_dot(at, e2), det = d11 * d22 - d12 * d12;
            r.b1 = det > 0.0 ? (float)((d22 * a1 - d12 * a2) / det) : 0.0f;
            r.b2 = det > 0.0 ? (float)((d11 * a2 - d12 * a1) / det) : 0.0f;
            r.side = 2 * triangle + (vec3_dot(d, side_face(g, 2 * triangle)) > 0.0f);
            return r;
        }
        const photon_surface at = photon_surface_at(s, o, d, t, triangle);
        chance = pcg(chance);
        d = photons_specular_bounce(&at, d, t, unit_float(chance), &o, &power);
        if (!(power.x + power.y + power.z > 0.0f))
            break;
    }
    r.side = VIT_NONE;
    r.weight = 0.0f;
    return r;
}
