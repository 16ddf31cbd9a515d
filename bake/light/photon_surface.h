/* photon_surface.c: what a photon finds where it hits: position, normal, reflectance from the atlas. */
#ifndef VIT_BAKE_PHOTON_SURFACE_H
#define VIT_BAKE_PHOTON_SURFACE_H

#include "geometry/atlas.h"
#include "common/kernel_math.h"

#define PHOTON_CONE 0.02f /* metres of footprint a metre of distance, for the choice of mip level; as in kernels/photons.cl */

/* The scene as the pack holds it. */
typedef struct photon_scene {
    const vit_triangle *triangles;
    const vit_attributes *attributes;
    uint32_t triangle_count;
    const vit_material *materials;
    const vit_maps *maps; /* a material each; NULL: none of them has any */
    const atlas *atlas;
    float ray_offset, box_pad; /* of vit_scene, metres */
    uint64_t effects;          /* of vit_scene: how textures are filtered, and what shines */
} photon_scene;

typedef struct photon_surface {
    vec3 position; /* on the ray, before the surface by ray_offset: surface_before() of kernels/surface.clh */
    vec3 beyond;   /* as far beyond the surface */
    vec3 face;     /* unit geometric normal on that side */
    vec3 normal;   /* unit interpolated normal on that side, by the normal map */
    vec3 albedo;
    const vit_material *material;
    bool back; /* the back of the triangle */
} photon_surface;

/* Photons and rays that look for light end there; they go on from mirrors and glass, as far as the scene has these effects. */
static inline bool photon_is_matt(const photon_scene *s, const vit_material *m) {
    return VIT_KIND_WITH(m->kind, s->effects & VIT_BIT(MIRROR), s->effects & VIT_BIT(GLASS)) == VIT_MATTE;
}

/* The surface `distance` metres along the unit direction, on `triangle`; as surface_at() of kernels/surface.clh. */
photon_surface photon_surface_at(const photon_scene *s, vec3 origin, vec3 direction, float distance, uint32_t triangle);
/* The same through a footprint of `cone` metres a metre of distance; b: the hit's barycentric weights. */
photon_surface photon_surface_seen(const photon_scene *s, vec3 origin, vec3 direction, float distance, uint32_t triangle,
                                   float cone, float b[3]);
/* What it reflects of light from all about, seen from all about, a channel: its albedo, and what its lobe does on average. */
vec3 photon_reflectance(const photon_scene *s, const photon_surface *at);
/* False: the ray meets the triangle where its material is cut out; as ray_opaque() of kernels/ray.clh. */
bool photon_opaque_at(const photon_scene *s, vec3 origin, vec3 direction, uint32_t triangle);
/* The same of the place of barycentric weights b. */
bool photon_opaque_place(const photon_scene *s, uint32_t triangle, const float b[3]);

#endif
