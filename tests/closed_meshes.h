/* Closed meshes, and rays from inside them at vertices, along edges and anywhere: where two triangles that share an edge may
 * each find the ray just outside themselves. */
#ifndef VIT_TESTS_CLOSED_MESHES_H
#define VIT_TESTS_CLOSED_MESHES_H

#include "host_rays.h"

/* Whole numbers: every aim is exact. */
static inline void place_lattice(float p[3]) {
    p[0] = p[0] * 64 + 3;
    p[1] = p[1] * 32 - 2;
    p[2] = p[2] * 64 + 5;
}

typedef struct closed_mesh {
    const char *what;
    mesh_place_fn *place;
    int squares; /* an edge of a cube's face */
    float half;  /* origins lie in a cube of this half edge */
} closed_mesh;

enum { CLOSED_BALL, CLOSED_BOX, CLOSED_LATTICE, CLOSED_CRUMPLED, CLOSED_MESHES };

static const closed_mesh closed_meshes[CLOSED_MESHES] = {
    [CLOSED_BALL] = {"rays out of a ball", place_ball, 64, 5},
    [CLOSED_BOX] = {"rays out of a box", place_box, 48, 4},
    [CLOSED_LATTICE] = {"rays out of a box on whole numbers", place_lattice, 32, 20},
    [CLOSED_CRUMPLED] = {"rays out of a crumpled ball", place_crumpled, 64, 0.5f},
};

/* Packets share a triangle to aim at, so that they are fast. */
static inline void closed_aim(ray_set *s, const ray_mesh *r, uint64_t *state, float half) {
    static const float middle[3] = {3, -2, 5};
    const vit_triangle *t = r->packed.triangles;
    for (uint32_t i = 0; i < s->n; i++) {
        float o[3], d[3], b1, b2;
        if (i % HOST_LAB_LANES == 0)
            t = r->packed.triangles + lab_random(state) % r->m.triangles;
        triangle_place(state, i, &b1, &b2);
        triangle_point(t, b1, b2, d);
        for (int k = 0; k < 3; k++) {
            o[k] = middle[k] + half * (2 * lab_uniform(state) - 1);
            if (i % 3 == 0)
                o[k] = rintf(o[k]);
            d[k] -= o[k];
        }
        unit_float(d);
        rays_set(s, i, o, d, RAY_FAR);
    }
}

#endif
