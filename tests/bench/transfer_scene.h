/* Patches of a scene of the benches, their form factors, and what a moving directional light gives them. */
#ifndef VIT_BENCH_TRANSFER_SCENE_H
#define VIT_BENCH_TRANSFER_SCENE_H

#include "../pack_sections.h"
#include "common/parallel.h"
#include "radiosity/form_factors.h"
#include "scenes.h"

#define SUN_PANES 8u /* of glass that a ray to the light may pass */

typedef struct transfer_scene {
    void *pack;
    const vit_scene *meta;
    geometry geometry;
    atlas atlas;
    photon_scene lit;
    photon_rays rays;
    tracks tracks;
    patch_set patches;
    form_factors factors;
} transfer_scene;

static inline void *transfer_load(const char *path) {
    struct stat s;
    FILE *f = fopen(path, "rb");
    if (!f || fstat(fileno(f), &s) != 0)
        bench_fail("%s: %s", path, strerror(errno));
    void *bytes = bench_array((size_t)s.st_size, 1);
    if (fread(bytes, 1, (size_t)s.st_size, f) != (size_t)s.st_size)
        bench_fail("%s: cannot be read", path);
    fclose(f);
    return bytes;
}

/* The pack's geometry as the baker has it: records are read in place, never written or freed. */
static inline void transfer_open(transfer_scene *t, const char *path, uint32_t count, uint32_t samples) {
    vit_text why = {""};
    *t = (transfer_scene){.pack = transfer_load(path)};
    const pack_sections s = pack_sections_of(t->pack);
    const vit_scene *meta = t->meta = s.data[VIT_SECTION_META];
    t->geometry = (geometry){.triangles = (vit_triangle *)s.data[VIT_SECTION_GEOM],
                             .attributes = (vit_attributes *)s.data[VIT_SECTION_ATTR],
                             .ray_offset = meta->ray_offset,
                             .box_pad = meta->box_pad};
    t->atlas = (atlas){.texels = (vit_u32 *)s.data[VIT_SECTION_ATLS],
                       .texel_count = meta->texels,
                       .textures = (vit_texture *)s.data[VIT_SECTION_TEXR],
                       .texture_count = meta->textures,
                       .mips = (vit_mip *)s.data[VIT_SECTION_MIPS],
                       .mip_count = meta->mips};
    t->lit = (photon_scene){.triangles = t->geometry.triangles,
                            .attributes = t->geometry.attributes,
                            .triangle_count = meta->triangles,
                            .materials = s.data[VIT_SECTION_MATL],
                            .atlas = &t->atlas,
                            .ray_offset = meta->ray_offset,
                            .box_pad = meta->box_pad,
                            .effects = meta->effects};
    t->tracks = (tracks){.cameras = (vit_camera *)s.data[VIT_SECTION_CAMS],
                         .lights = (vit_light *)s.data[VIT_SECTION_LITE],
                         .light_count = meta->lights};
    if (!photon_rays_open(&t->lit, 0, &t->rays))
        bench_fail("Embree fails");
    const patches_input patches = {.rays = &t->rays,
                                   .geometry = &t->geometry,
                                   .tracks = &t->tracks,
                                   .frames = meta->frames,
                                   .width = meta->width,
                                   .height = meta->height,
                                   .count = count};
    if (patches_make(&patches, &t->patches, &why) != VIT_OK)
        bench_fail("%s", why.text);
    const form_factors_input factors = {.rays = &t->rays, .geometry = &t->geometry, .patches = &t->patches, .samples = samples};
    if (form_factors_find(&factors, &t->factors, &why) != VIT_OK)
        bench_fail("%s", why.text);
}

static inline void transfer_close(transfer_scene *t) {
    form_factors_free(&t->factors);
    patches_free(&t->patches);
    photon_rays_close(&t->rays);
    free(t->pack);
}

/* Light along `direction`: from outside, or as if nothing farther than `reach` metres shaded, so that it falls in through the
 * roof. */
typedef struct sun {
    vec3 direction;
    float reach;
} sun;

/* Does it get to `p`? Through panes of glass, too. */
static inline bool sun_reaches(const transfer_scene *t, vec3 p, const sun *s) {
    const vec3 back = vec3_scale(s->direction, -1.0f);
    float left = s->reach;
    for (uint32_t pane = 0; pane < SUN_PANES; pane++) {
        float distance;
        const uint32_t hit = photon_rays_nearest(&t->rays, p, back, &distance);
        if (hit == VIT_NONE || distance > left)
            return true;
        if (t->lit.materials[t->lit.attributes[hit].material & VIT_MATERIAL_INDEX].kind != VIT_GLASS)
            return false;
        left -= distance;
        p = vec3_along(p, back, distance + t->lit.ray_offset);
    }
    return false;
}

typedef struct sun_call {
    const transfer_scene *t;
    sun sun;
    float *light;
} sun_call;

static inline void sun_on_patch(void *user, uint32_t i) {
    const sun_call *c = user;
    const transfer_scene *t = c->t;
    const patch_point *points = t->patches.points + (size_t)i * PATCHES_POINTS;
    const uint32_t count = t->patches.point_count[i];
    double sum = 0.0;
    for (uint32_t k = 0; k < count; k++) {
        const vec3 face = side_face(&t->geometry, points[k].side);
        const float cosine = -vec3_dot(face, c->sun.direction);
        const vec3 at =
            vec3_along(side_place(&t->geometry, points[k].side, points[k].b1, points[k].b2), face, t->geometry.ray_offset);
        sum += cosine > 0.0f && sun_reaches(t, at, &c->sun) ? (double)cosine : 0.0;
    }
    for (uint32_t k = 0; k < 3; k++)
        c->light[3 * i + k] = count ? t->patches.patch[i].albedo[k] * (float)(10.0 * sum / count) : 0.0f;
}

/* Radiosity, W/m2, that 10 W/m2 across its direction give the patches: 3 a patch. At time 0..1 the light shines from low on one
 * side across the nave to low on the other. */
static inline void sun_on_patches(const transfer_scene *t, double time, float reach, float *light) {
    const double angle = 0.5 + 2.1 * time;
    sun_call c = {t, {vec3_unit((vec3){0.35f, (float)-sin(angle), (float)cos(angle)}), reach}, light};
    parallel_for(0, t->patches.count, sun_on_patch, &c);
}

#endif
