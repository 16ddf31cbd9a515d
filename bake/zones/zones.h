/* zones.c: what a fixed scene lets us bake against the errors of photon splatting (README.md, "Zones and areas"): which photons
 * may count for which samples, and how much of the photon kernel lies on surfaces there. */
#ifndef VIT_BAKE_ZONES_H
#define VIT_BAKE_ZONES_H

#include "geometry/atlas.h"
#include "light/photon_guiding.h"
#include "light/photons.h"
#include "motion/tracks.h"

typedef struct zones_input {
    const geometry *geometry;
    uint32_t triangles;
    const vit_material *materials; /* as in the pack */
    const atlas *atlas;
    const tracks *tracks;           /* of all frames */
    const bool *gives_photons;      /* a light */
    const area_lights *area_lights; /* that give photons, or NULL */
    const photons_light *sky;       /* the same */
    const photon_guiding *guiding;  /* of photons, or NULL */
    const vit_scene *scene;         /* frames, width, height, bounces, radius, flatten, box_pad, ray_offset, lights, effects */
    bool zones;                     /* accept bits and zones; otherwise every cell accepts zone 0 */
    bool by_light;                  /* unlike lit surfaces are kept apart too */
    bool areas;                     /* effective areas; otherwise 1 */
    unsigned threads;               /* 0: all cores; changes no byte */
    void (*progress)(void *user, double done); /* may be NULL; by the calling thread */
    void *user;
} zones_input;

typedef struct zones_found {
    uint32_t receivers, patches; /* cells seen from the path; groups of cells that share a zone */
    double wrong;                /* share of kernel weight that 32 zones keep or reject against the baked visibility */
    double open_area;            /* m2 of sides that light reaches */
    double seconds;              /* that it took */
} zones_found;

/* Divides the surface into cells and fills them in. VIT_FAILED: out of memory, or Embree fails. */
vit_status zones_bake(const zones_input *in, cells *out, zones_found *found, vit_text *why);
/* Turns photon->zone from the index of a cell (photons_input.cells) into its zone's bit. */
void zones_assign(const cells *c, vit_photon *photons, uint32_t count);

#endif
