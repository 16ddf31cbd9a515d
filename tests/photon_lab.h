/* A closed room whose rays are traced by Embree: what tests of baked indirect light look into. */
#ifndef VIT_TESTS_PHOTON_LAB_H
#define VIT_TESTS_PHOTON_LAB_H

#include "light/photon_rays.h"
#include "photon_room.h"

typedef struct lab {
    room *r;
    photon_scene scene;
    photon_rays rays;
} lab;

static inline void open_lab(lab *l, room *r) {
    room_finish(r, 0, 2);
    for (uint32_t i = 0; i < r->m.triangles; i++) /* light stays inside; what stands there has two sides */
        r->g.attributes[i].material |= r->g.attributes[i].material < WALLS ? VIT_SIDE_DARK_BACK : 0;
    l->r = r;
    l->scene = room_scene(r);
    assert_true(photon_rays_open(&l->scene, 1, &l->rays));
}

static inline void close_lab(lab *l) {
    photon_rays_close(&l->rays);
    room_drop(l->r);
}

#endif
