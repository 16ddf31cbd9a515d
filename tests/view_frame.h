/* What an open pack's device holds of a frame's view samples, and each of them as oracles take it. */
#ifndef VIT_TESTS_VIEW_FRAME_H
#define VIT_TESTS_VIEW_FRAME_H

#include "oracle/view_sample.h"
#include "read_buffer.h"

typedef struct view_frame {
    const vit_scene *s;
    vit_camera *cameras;
    const vit_camera *camera; /* the frame's */
    void *position;
    uint32_t *normal, *hit, *keys;
    uint32_t *accept;    /* NULL without zones */
    float *inverse_area; /* NULL without areas */
    float *indirect;
    vit_photon *photons;
} view_frame;

/* After that frame, of a pack with photons. */
static inline view_frame view_frame_read(const open_pack *p, uint32_t frame) {
    view_frame f = {.s = p->v->pack.scene};
    f.cameras = read_buffer(p, B_cameras);
    f.camera = f.cameras + frame;
    f.position = read_buffer(p, B_position);
    f.normal = read_buffer(p, B_normal);
    f.hit = read_buffer(p, B_hit_triangle);
    f.keys = read_buffer(p, B_keys);
    f.accept = f.s->effects & VIT_BIT(ZONES) ? read_buffer(p, B_accept) : NULL;
    f.inverse_area = f.s->effects & VIT_BIT(AREA) ? read_buffer(p, B_inverse_area) : NULL;
    f.indirect = read_buffer(p, B_indirect);
    f.photons = read_buffer(p, B_photons);
    return f;
}

static inline void view_frame_free(view_frame *f) {
    free(f->cameras);
    free(f->position);
    free(f->normal);
    free(f->hit);
    free(f->keys);
    free(f->accept);
    free(f->inverse_area);
    free(f->indirect);
    free(f->photons);
}

static inline oracle_sample view_frame_sample(const view_frame *f, uint32_t i) {
    oracle_sample at = {.accept = f->accept ? f->accept[i] : 0,
                        .inverse_area = f->inverse_area ? (double)f->inverse_area[i] : 1};
    oracle_position(f->s, f->position, i, at.position);
    oracle_normal(f->normal[i], at.normal);
    return at;
}

#endif
