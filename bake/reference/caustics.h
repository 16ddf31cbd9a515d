/* caustics.c: light that small lights (points, spots, directions) send by mirrors and glass, where no ray from a surface can
 * find it: photons that have met nothing else, stored where they land on a matt or glossy surface. Paths look about themselves
 * for them (photon mapping, Jensen 1996). Each round's photons are new and their radius is less, so that the mean over rounds
 * is without bias in the end: probabilistic progressive photon mapping, Knaus and Zwicker 2011, equation 20.
 *
 * Panes that are passed straight on alone are not among it: shadow rays see through them. */
#ifndef VIT_COST_CAUSTICS_H
#define VIT_COST_CAUSTICS_H

#include "reference/paths.h"

typedef struct caustic_photon {
    vec3 position, direction; /* m; unit, of travel */
    float power[3];           /* W */
    uint32_t passed;          /* mirrors and glass on its way, >= 1 */
} caustic_photon;

/* The photons of a round and sequence, by cells of a grid. Zeros: none. */
struct caustics {
    caustic_photon *photons; /* in the order of their cells' hashes */
    uint32_t *first;         /* of each hash, and one more */
    uint32_t count, hashes;  /* hashes: a power of two */
    float radius;            /* m */
};

/* Are there small lights that give indirect light, and mirrors or glass that could send it on? */
bool caustics_possible(const path_scene *p);
/* Radius of the first round's photons, by how close they lie to each other; 0: there are none. -1: out of memory. */
float caustics_first_radius(const path_scene *p, unsigned threads);
/* Traces and sorts. `number`: of the map among all of a picture; round, from 0 on: sets the radius. Threads change no bit.
 * False: out of memory; nothing to free. */
bool caustics_trace(const path_scene *p, float first_radius, uint32_t number, uint32_t round, unsigned threads, caustics *out,
                    uint64_t *rays);
void caustics_free(caustics *c);

/* What the photons about a place give it: irradiance, W/m2, times Pi times the BRDF where it has a lobe. Split by whether they
 * have passed at most `most` mirrors and glasses. */
void caustics_gather(const caustics *c, const path_vertex *place, int most, double limited[3], double all[3]);

#endif
