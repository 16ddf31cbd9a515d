/* A scene put together by hand in memory, opened as a pack without the baker: its mesh goes through the baker's BVH and
 * geometry, all else is what the test says. For cases that no scene file can state. */
#ifndef VIT_TESTS_RIG_H
#define VIT_TESTS_RIG_H

#include "common/octahedral.h"
#include "pack/pack_write.h"
#include "ray_lab.h"
#include "read_buffer.h"

#define RIG_PI 3.14159265358979

/* Sections that the pack is made of; rig_open() fills what follows from others. All arrays but these are the test's. */
typedef struct rig {
    ray_mesh mesh; /* after mesh_bake() */
    vit_scene scene;
    vit_camera *cameras; /* scene.frames */
    vit_light *lights;   /* scene.frames * scene.lights */
    vit_photon *photons; /* scene.baked */
    vit_material material;
    vit_u32 *sides; /* with zones and areas */
    vit_cell *cells;
} rig;

/* A pinhole at `eye` that looks along `forward` (unit), with the image's right and down axes, and `half` the tangent of half of
 * the horizontal angle. Exact if these are. */
static inline vit_camera rig_camera(const vit_scene *s, const float eye[3], const float forward[3], const float right[3],
                                    const float down[3], float half) {
    vit_camera c = {.exposure = 1};
    const float pixel = 2 * half / (float)s->width;
    for (int k = 0; k < 3; k++) {
        c.eye[k] = eye[k];
        c.forward[k] = forward[k];
        c.right[k] = right[k] * pixel;
        c.down[k] = down[k] * pixel;
        c.corner[k] = forward[k] - 0.5f * pixel * ((float)s->width * right[k] + (float)s->height * down[k]);
    }
    return c;
}

/* Along -z, x to the right. */
static inline vit_camera rig_camera_at(const vit_scene *s, float x, float y, float z) {
    static const float forward[3] = {0, 0, -1}, right[3] = {1, 0, 0}, down[3] = {0, -1, 0};
    const float eye[3] = {x, y, z};
    return rig_camera(s, eye, forward, right, down, 1);
}

static inline vit_light rig_light(float x, float y, float z, float watts) {
    const float i = watts / (float)(4 * RIG_PI);
    return (vit_light){.position = {x, y, z},
                       .kind = VIT_LIGHT_POINT,
                       .direction = {0, -1, 0},
                       .cos_outer = -1,
                       .intensity = {i, i, i},
                       .spot_offset = 1};
}

/* A photon of `watts` a channel at p, flying along the unit vector d. */
static inline vit_photon rig_photon(const float p[3], const float d[3], float radius, float watts) {
    const float r2 = radius * radius, inv = 1.0f / r2, power = watts * (2.0f / (float)RIG_PI) * inv;
    return (vit_photon){.position = {p[0], p[1], p[2]},
                        .radius2 = r2,
                        .direction = {d[0], d[1], d[2]},
                        .inv_radius2 = inv,
                        .power = {power, 0.5f * power, 0.25f * power}};
}

/* One frame of width x height, one grey material, no light; mesh and what the test adds come after. */
static inline void rig_begin(rig *r, uint32_t width, uint32_t height) {
    memset(r, 0, sizeof *r);
    r->material = (vit_material){.albedo = {1, 1, 1}, .texture = VIT_NONE, .exponent = 1, .ior = 1};
    r->scene = (vit_scene){.width = width,
                           .height = height,
                           .frames = 1,
                           .fps = 24,
                           .tile = 16,
                           .materials = 1,
                           .bounces = 4,
                           .slice_count = 1,
                           .slice_near = 0.125f,
                           .slice_scale = 4,
                           .copies = 1,
                           .max_nodes = 1u << 16,
                           .max_list = 1u << 16};
}

/* Photons that lie still in the pack, estimated from lists. */
static inline void rig_photons(rig *r, vit_photon *photons, uint32_t count, float radius) {
    r->photons = photons;
    r->scene.baked = count;
    r->scene.radius = radius;
    r->scene.effects |= VIT_BIT(LIGHTS) | VIT_BIT(INDIRECT) | VIT_BIT(PHOTONS) | VIT_BIT(LIST);
}

/* The pack's bytes; free() them. Scenes that say they have lights and have none get a dark one. */
static inline void *rig_pack(rig *r, size_t *size) {
    vit_scene *s = &r->scene;
    vit_text why = {""};
    void *bytes = NULL;
    const vit_light *lights = r->lights;
    vit_light *own = NULL;
    if ((s->effects & VIT_BIT(LIGHTS)) && !lights) {
        s->lights = 1;
        lights = own = ray_lab_array(s->frames, sizeof *own);
        for (uint32_t i = 0; i < s->frames; i++)
            own[i] = rig_light(0, 0, 0, 0);
    }
    s->triangles = r->mesh.m.triangles;
    s->nodes = r->mesh.tree.node_count;
    s->box_pad = r->mesh.tree.box_pad;
    s->ray_offset = r->mesh.packed.ray_offset;
    if (vit_pack_derive(s, &why) != VIT_OK)
        fail_msg("%s", why.text);
    vit_gold *golds = ray_lab_array(s->frames, sizeof *golds);
    const pack_sections sections = {.data = {[VIT_SECTION_META] = s,
                                             [VIT_SECTION_CAMS] = r->cameras,
                                             [VIT_SECTION_LITE] = lights,
                                             [VIT_SECTION_GEOM] = r->mesh.packed.triangles,
                                             [VIT_SECTION_ATTR] = r->mesh.packed.attributes,
                                             [VIT_SECTION_BVHN] = r->mesh.tree.nodes,
                                             [VIT_SECTION_MATL] = &r->material,
                                             [VIT_SECTION_SIDE] = r->sides,
                                             [VIT_SECTION_CELL] = r->cells,
                                             [VIT_SECTION_PHOT] = r->photons,
                                             [VIT_SECTION_GOLD] = golds}};
    if (pack_assemble(&sections, &bytes, size, &why) != VIT_OK)
        fail_msg("%s", why.text);
    free(golds);
    free(own);
    return bytes;
}

/* Opens it on the device `host`, or as `how` says; linear floats unless it says otherwise. */
static inline void rig_open(rig *r, open_pack *p, vit_open_info how) {
    size_t size;
    void *bytes = rig_pack(r, &size);
    pack_open_bytes(p, bytes, size, how);
}

static inline vit_open_info rig_on_host(void) {
    return (vit_open_info){.device = VIT_DEVICE_HOST, .format = VIT_FORMAT_RGBA32F};
}

/* The room -1..1 with n x n squares a side, inside to be seen; every wall's normals are its own. */
static inline void rig_keep(float p[3]) {
    (void)p;
}

static inline void rig_room(rig *r, int n, mesh_place_fn *place) {
    mesh_cube(&r->mesh, n, place);
    mesh_bake(&r->mesh);
    for (uint32_t i = 0; i < r->mesh.m.triangles; i++) {
        vit_triangle *t = r->mesh.packed.triangles + i;
        float normal[3] = {t->nx, t->ny, t->nz};
        int code[2];
        octahedral_encode(normal, 32767, code);
        for (int k = 0; k < 3; k++)
            r->mesh.packed.attributes[i].normal[k] = ((vit_u32)code[0] & 0xffffu) | (vit_u32)code[1] << 16;
    }
}

static inline void rig_free(rig *r) {
    mesh_free(&r->mesh);
}

/* Floats of the frame that are no number or infinite. */
static inline uint64_t rig_not_finite(const open_pack *p) {
    const float *f = (const float *)(const void *)p->frame;
    uint64_t count = 0;
    for (size_t i = 0; i < p->need.frame_bytes / sizeof *f; i++)
        count += isfinite(f[i]) ? 0 : 1;
    return count;
}

#endif
