/* Scenes for tests of the reference: quads, lights, and cameras whose pixels lie evenly on a parallelogram, so that a frame is
 * a quadrature of that surface. Made by the baker's own steps (photon_room.h). */
#ifndef VIT_TESTS_REFERENCE_LAB_H
#define VIT_TESTS_REFERENCE_LAB_H

#include "reference/reference.h"
#include "photon_room.h"

#define LAB_PI 3.14159265358979323846
enum { LAB_FRAMES = 12 };

typedef struct reference_lab {
    room *room;
    vit_scene meta;
    vit_camera cameras[LAB_FRAMES];
    vit_light lights[LAB_FRAMES * ROOM_LIGHTS];
    pack_sections sections;
    reference_input in; /* with defaults */
} reference_lab;

/* Takes over the room, with all its quads; side: pixels of the frames' edges. */
static inline void lab_open(reference_lab *l, room *r, uint32_t side, uint32_t lights, uint32_t bounces) {
    memset(l, 0, sizeof *l);
    room_finish(r, lights, bounces);
    l->room = r;
    l->meta = (vit_scene){.width = side,
                          .height = side,
                          .frames = LAB_FRAMES,
                          .triangles = r->m.triangles,
                          .materials = ROOM_MATERIALS,
                          .textures = r->a.texture_count,
                          .mips = r->a.mip_count,
                          .texels = r->a.texel_count,
                          .lights = lights,
                          .bounces = bounces,
                          .ray_offset = r->g.ray_offset,
                          .box_pad = r->b.box_pad};
    for (uint32_t i = 0; i < LAB_FRAMES * lights; i++)
        l->lights[i] = r->lights[i % lights].light;
    l->sections = (pack_sections){.data = {[VIT_SECTION_META] = &l->meta,
                                           [VIT_SECTION_CAMS] = l->cameras,
                                           [VIT_SECTION_LITE] = l->lights,
                                           [VIT_SECTION_GEOM] = r->g.triangles,
                                           [VIT_SECTION_ATTR] = r->g.attributes,
                                           [VIT_SECTION_MATL] = r->materials,
                                           [VIT_SECTION_TEXR] = r->a.textures,
                                           [VIT_SECTION_MIPS] = r->a.mips,
                                           [VIT_SECTION_ATLS] = r->a.texels}};
    l->in = (reference_input){
        .sections = &l->sections, .every = 1, .bounces = bounces, .target = 1e-9, .max_samples = 64, .threads = 1};
}

static inline void lab_close(reference_lab *l) {
    room_drop(l->room);
}

/* Frame f sees the parallelogram from `eye`: pixel (x, y)'s ray goes to corner + (x + 1/2) / side u + (y + 1/2) / side v. */
static inline void lab_look(reference_lab *l, uint32_t f, const float eye[3], const float corner[3], const float u[3],
                            const float v[3]) {
    vit_camera *c = l->cameras + f;
    c->exposure = 1.0f;
    for (int k = 0; k < 3; k++) {
        c->eye[k] = eye[k];
        c->corner[k] = corner[k] - eye[k];
        c->right[k] = u[k] / (float)l->meta.width;
        c->down[k] = v[k] / (float)l->meta.height;
    }
}

static inline reference lab_render(reference_lab *l, uint32_t frame) {
    reference r;
    vit_text why = {""};
    l->in.frame = frame;
    if (reference_render(&l->in, &r, &why) != VIT_OK)
        fail_msg("reference_render: %s", why.text);
    return r;
}

/* Mean of a channel of an image of radiance, as irradiance on a surface of that albedo. */
static inline double lab_irradiance(const reference *r, const double *image, uint32_t channel, double albedo) {
    const size_t pixels = (size_t)r->width * r->height;
    double sum = 0;
    for (size_t i = 0; i < pixels; i++)
        sum += image[3 * i + channel];
    return sum / (double)pixels * LAB_PI / albedo;
}

#endif
