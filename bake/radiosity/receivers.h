/* receivers.c: places on surfaces whose irradiance is baked, at the corners of cells as large as what the cameras see of them
 * allows, or where light changes much within one, smaller. A sample takes its cell's three; cells that share a corner share its
 * receiver, so that light is continuous. Where something stands on a cell, as a wall on a floor that goes on beneath it, a
 * plane parts it, and each side has receivers of its own. Where there are too many, light is computed at some, and others
 * follow. */
#ifndef VIT_RADIOSITY_RECEIVERS_H
#define VIT_RADIOSITY_RECEIVERS_H

#include "geometry/cells.h"
#include "light/photon_rays.h"
#include "motion/tracks.h"

struct receivers;

typedef struct receivers_input {
    const photon_rays *rays;
    const geometry *geometry;
    const tracks *tracks;           /* the path's cameras */
    uint32_t frames, width, height; /* of the path; pixels */
    float size;                     /* of the scene: radius of a sphere round it, m */
    float spacing;                  /* pixels between receivers where a camera comes nearest */
    bool within;                    /* samples are taken within pixels, not in their middles alone */
    uint32_t least;                 /* receivers wanted at least: the spacing shrinks to no less than a quarter for them */
    uint32_t most;                  /* receivers wanted at most: the spacing grows until they are no more, or nearly so */
    uint32_t records;               /* whose light is computed for the first look, about: above that others follow them */
    unsigned threads;               /* 0: all cores; changes no byte */
    /* A first look at the light of receivers that are asked, roughly: receivers x columns, and the deviation of each one's, all
     * columns added up. Cells whose corners differ much are divided. NULL: none is. Of `r` there are receivers, followers, and
     * cells as they are so far. */
    vit_status (*look)(void *user, const struct receivers *r, float *irradiance, float *noise, vit_text *why);
    void *user;
    uint32_t columns;
    /* Light of any place, columns of it. Not NULL: what is divided is told by how far off interpolation is in a cell's middle
     * rather than by how much the light of its corners differs; looks find the light of all, and the last one's is kept. */
    void (*light)(void *user, uint32_t side, float b1, float b2, float *irradiance);
    float error;      /* of that light: cells are divided until their middles are off by so much of it, about, */
    float off_limits; /* and where they are still off by so much in the end no light is said to be known */
} receivers_input;

typedef struct receiver {
    uint32_t side;
    float b1, b2;
    float reach;  /* m: records as near as that say what its light is; 0: none does */
    bool follows; /* its light follows from that of others: of followers. Those whose does not are records. */
    bool asked;   /* for its light, at this look */
    bool hangs;   /* on an edge that a neighbour divides less often, */
    bool carries; /* or is an end of it, and stays what it is */
} receiver;

#define RECEIVER_FROM 6u

/* Where records are near enough, or on an edge that a neighbour divides less often: the neighbour's light there, so that light
 * is continuous. */
typedef struct receiver_follower {
    uint32_t receiver, from[RECEIVER_FROM]; /* from: records, or followers of smaller index in the list */
    float weight[RECEIVER_FROM];            /* sum to 1; 0: not this one */
} receiver_follower;

typedef struct receivers {
    vit_u32 *sides;             /* 2 a triangle: section SIDE */
    vit_receiver_cell *cells;   /* section RCEL */
    vit_receiver_split *splits; /* section RSPL */
    receiver *receivers;        /* ordered so that neighbours in space are near each other in the list */
    receiver_follower *followers;
    uint32_t side_count, cell_count, split_count, count, follower_count;
    uint32_t seen_sides; /* of triangles, by the path's cameras */
    uint32_t lit_sides;  /* that light can reach, of matt materials */
    float *irradiance;   /* receivers x columns, if receivers_input.light says it */
    uint32_t unknown;    /* cells whose light is not known: VIT_RECEIVER_BY_RAYS; */
    float unknown_share; /* of what the cameras see, about */
} receivers;

/* VIT_FAILED: out of memory. On failure there is nothing to free. */
vit_status receivers_place(const receivers_input *in, receivers *out, vit_text *why);
void receivers_free(receivers *r);
/* receivers_copy.c: copies of what packs hold and of the first `placed` of `receivers`; none of followers and light. False: out
 * of memory; there is nothing to free. */
bool receivers_copy(const receivers *from, uint32_t placed, receivers *to);
/* NULL: out of memory, or there is nothing. */
void *receivers_copied(const void *from, size_t count, size_t size);
/* Light of followers, from that of records: receivers x columns. */
void receivers_follow(const receivers *r, float *irradiance, uint32_t columns);
/* receiver_smooth.c: a deviation is little known from rays few of which met what is bright: each one's becomes the root of the
 * mean square of its own and those of the corners of its cells, of receivers that are asked. At a look, too. False: out of
 * memory. */
bool receivers_pool_noise(const receivers *r, float *noise);
/* Takes out what is noise: irradiance, receivers x columns, and noise, as receivers_input.look gives them. False: out of
 * memory. */
bool receivers_smooth(const receivers *r, float *irradiance, float *noise, uint32_t columns, unsigned threads);

#endif
