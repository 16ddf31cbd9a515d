/* baked.c: indirect light of a whole pack: receivers, their irradiance by light that stays as it is, and a basis for lights
 * that move. */
#ifndef VIT_RADIOSITY_BAKED_H
#define VIT_RADIOSITY_BAKED_H

#include "radiosity/basis.h"
#include "radiosity/basis_points.h"
#include "radiosity/receivers.h"
#include "radiosity/transport.h"

typedef struct baked_input {
    const photon_rays *rays;
    const geometry *geometry;
    const tracks *tracks;
    uint32_t frames, width, height;
    const photons_light *still; /* lights, area lights and sky that are the same in all frames */
    uint32_t still_count;
    const uint32_t *moving; /* lights of the tracks that are not */
    uint32_t moving_count;
    bool points; /* receivers are points in space, not on surfaces: quality.basis_receivers */
    bool live;   /* nothing is baked of lights that move: they tell where light changes, and so where receivers are, alone */
    double size; /* of the scene: radius of a sphere round it, m */
    uint32_t reflections;                      /* at most, or TRANSPORT_CONVERGED */
    double spacing, error;                     /* quality.receiver_spacing, quality.basis_error */
    double point_spacing;                      /* quality.point_spacing */
    uint32_t receiver_rays;                    /* quality.receiver_rays */
    bool within;                               /* receivers_input.within */
    bool panes;                                /* light comes through thin glass */
    unsigned threads;                          /* 0: all cores; changes no byte */
    void (*progress)(void *user, double done); /* may be NULL */
    void *user;
} baked_input;

typedef struct baked {
    basis_points points; /* where they are, if receivers are points in space; then of `receivers` the count alone is there */
    receivers receivers; /* its count is a multiple of VIT_BASIS_GROUP: the last do not matter, */
    uint32_t placed;     /* and receivers.receivers has but these */
    vit_receiver *still; /* section RECV */
    basis basis;
    vit_basis_frame *frames; /* section BFRM: frame x light */
    uint32_t lights;
    transport_report report;
    uint32_t more_rays; /* times baked_input.receiver_rays: more than 1 where light gets about by small gaps */
    double seconds;     /* that it took */
} baked;

/* What can be told beforehand. */
typedef struct baked_foreseen {
    uint32_t states;    /* of the lights: those that stay together, and each other at its knots */
    uint32_t receivers; /* at most, about */
    double bytes;       /* of all receivers' irradiance in all states, at most: what is compressed then */
    double live_bytes;  /* likewise, of the states that tell where receivers are if lights are live */
    double widest;      /* basis_knots.widest of any light */
} baked_foreseen;

/* Lights `moving` of the tracks; size: as baked_input's. VIT_FAILED: out of memory. */
vit_status baked_foresee(const tracks *t, uint32_t frames, const uint32_t *moving, uint32_t moving_count, double size,
                         baked_foreseen *out, vit_text *why);

/* VIT_FAILED: out of memory. On failure there is nothing to free. */
vit_status baked_find(const baked_input *in, baked *out, vit_text *why);
void baked_free(baked *b);

#endif
