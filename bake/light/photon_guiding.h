/* photon_guiding.c: which photon paths matter: paths traced from the cameras of the path, whose every reflection is joined with
 * the lights. A photon that goes such a way backwards lights what is seen. */
#ifndef VIT_BAKE_GUIDES_H
#define VIT_BAKE_GUIDES_H

#include "light/guiding_tree.h"
#include "light/photons.h"
#include "motion/tracks.h"

typedef struct photon_guiding_input {
    photon_scene scene;
    const tracks *tracks; /* of all frames */
    uint32_t frames, width, height;
    uint32_t bounces;          /* hits of a photon path */
    const bool *gives_photons; /* a light */
    const area_lights *area;   /* that give photons, or NULL */
    const photons_light *sky;  /* the same */
    unsigned threads;          /* 0: all cores; changes no bit */
} photon_guiding_input;

/* Of the tracks' lights, then of all area lights together, then of the sky. */
typedef struct photon_guiding {
    guiding_tree *guide; /* empty where nothing was found, and of lights that move */
    double *worth;       /* of a light: its share of the indirect light that is seen; sum 1, or 0 if there is none */
    vec3 around;         /* as in photons_light: the middle of the cameras' places */
    uint32_t count;      /* light_count + 2; 0: not looked for */
} photon_guiding;

/* VIT_FAILED: out of memory, or Embree fails; *out is empty then. */
vit_status photon_guiding_find(const photon_guiding_input *in, photon_guiding *out, vit_text *why);
void photon_guiding_free(photon_guiding *g);
/* Of a light, of all area lights (light_count) or of the sky (light_count + 1); NULL: its paths go evenly. `g` may be NULL. */
const guiding_tree *photon_guiding_of(const photon_guiding *g, uint32_t source);

#endif
