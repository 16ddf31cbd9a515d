/* receivers.c: places on surfaces whose irradiance is baked, at the corners of cells as large as what the cameras see of them
 * allows. A sample takes its cell's three; cells that share a corner share its receiver, so that light is continuous. Where
 * something stands on a cell, as a wall on a floor that goes on beneath it, a plane parts it, and each side has receivers of
 * its own. */
#ifndef VIT_RADIOSITY_RECEIVERS_H
#define VIT_RADIOSITY_RECEIVERS_H

#include "geometry/cells.h"
#include "light/photon_rays.h"
#include "motion/tracks.h"

typedef struct receivers_input {
    const photon_rays *rays;
    const geometry *geometry;
    const tracks *tracks;           /* the path's cameras */
    uint32_t frames, width, height; /* of the path; pixels */
    float size;                     /* of the scene: radius of a sphere round it, m */
    float spacing;                  /* pixels between receivers where a camera comes nearest */
    bool within;                    /* samples are taken within pixels, not in their middles alone */
    uint32_t most;                  /* receivers wanted at most: the spacing grows until they are no more, or nearly so */
    unsigned threads;               /* 0: all cores; changes no byte */
} receivers_input;

typedef struct receiver {
    uint32_t side;
    float b1, b2;
} receiver;

typedef struct receivers {
    vit_u32 *sides;             /* 2 a triangle: section SIDE */
    vit_receiver_cell *cells;   /* section RCEL */
    vit_receiver_split *splits; /* section RSPL */
    receiver *receivers;        /* ordered so that neighbours in space are near each other in the list */
    uint32_t side_count, cell_count, split_count, count;
    uint32_t seen_sides; /* of triangles, by the path's cameras */
    uint32_t lit_sides;  /* that light can reach, of matt materials */
} receivers;

/* VIT_FAILED: out of memory. On failure there is nothing to free. */
vit_status receivers_place(const receivers_input *in, receivers *out, vit_text *why);
void receivers_free(receivers *r);

#endif
