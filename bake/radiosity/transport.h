/* transport.c: irradiance of receivers from light that surfaces reflect, for many states of the lights at once. Rays from the
 * receivers find the cells of surfaces that light comes from, rays from these the ones behind them, a few times over (final
 * gathering: Reichert 1992). What is direct light on such a cell is asked at places where rays met it, so that hidden parts
 * count for nothing; light then goes to and fro between the cells along the rays. */
#ifndef VIT_RADIOSITY_TRANSPORT_H
#define VIT_RADIOSITY_TRANSPORT_H

#include "light/photon_emission.h"
#include "radiosity/receivers.h"

#define TRANSPORT_CONVERGED 0u

/* One state: lights that shine together. */
typedef struct transport_state {
    const photons_light *lights;
    uint32_t count;
} transport_state;

typedef struct transport_input {
    const photon_rays *rays;
    const geometry *geometry;
    const receiver *receivers;
    uint32_t receiver_count;
    const transport_state *states;
    uint32_t state_count;
    uint32_t reflections;                      /* between light and receiver, at most, or TRANSPORT_CONVERGED */
    uint32_t cells;                            /* about so many cells of surfaces where light comes from */
    uint32_t receiver_rays;                    /* per receiver */
    uint32_t bounce_rays;                      /* of all cells together, about */
    double looks;                              /* at lights, per cell, about, shared out by how much each adds to the error */
    bool panes;                                /* light comes through thin glass, too */
    unsigned threads;                          /* 0: all cores; changes no byte */
    void (*progress)(void *user, double done); /* may be NULL */
    void *user;
} transport_input;

typedef struct transport_report {
    uint32_t cells;       /* that light comes from */
    uint32_t splits;      /* of them, parted by what stands on them */
    uint64_t rays;        /* from receivers and cells */
    uint64_t light_rays;  /* from cells to lights */
    double spectral;      /* share of the light that a late reflection leaves */
    uint32_t reflections; /* that were computed */
} transport_report;

/* Of receivers. */
typedef struct transport_light {
    float *irradiance; /* receivers x states x 3, W/m2 */
    float *noise;      /* deviation, about, of a receiver's irradiance, all states and channels added up, W/m2; may be NULL */
} transport_light;

/* Fills what `out` points at. VIT_FAILED: out of memory. */
vit_status transport_find(const transport_input *in, const transport_light *out, transport_report *report, vit_text *why);

#endif
