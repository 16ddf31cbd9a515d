/* lightmap.c: direct light of the sky and of area lights, which stay as they are, at places on surfaces: receivers of their
 * own, close to each other where it changes. Where it changes too much still, cells say that rays have to find it. */
#ifndef VIT_RADIOSITY_LIGHTMAP_H
#define VIT_RADIOSITY_LIGHTMAP_H

#include "light/area_lights.h"
#include "light/sky.h"
#include "radiosity/receivers.h"

typedef struct lightmap_input {
    const photon_rays *rays;
    const geometry *geometry;
    const tracks *tracks;
    uint32_t frames, width, height;
    const area_lights *area;                   /* NULL: none */
    const environment *sky;                    /* NULL: it gives no light */
    double size;                               /* of the scene: radius of a sphere round it, m */
    double spacing, error;                     /* quality.map_spacing, quality.map_error */
    bool within;                               /* receivers_input.within */
    unsigned threads;                          /* 0: all cores; changes no byte */
    void (*progress)(void *user, double done); /* may be NULL */
    void *user;
} lightmap_input;

typedef struct lightmap {
    receivers receivers;
    vit_receiver *light; /* section MREC */
    uint64_t rays;
    double seconds; /* that it took */
} lightmap;

/* VIT_FAILED: out of memory. On failure there is nothing to free. */
vit_status lightmap_find(const lightmap_input *in, lightmap *out, vit_text *why);
void lightmap_free(lightmap *m);

/* What was found before: quality "auto" and a sweep ask for it again and again. Zero to begin with; of one scene's triangles,
 * materials and tracks. */
#define LIGHTMAP_KEPT 4 /* at most; the one asked for longest ago goes first */
typedef struct lightmap_kept {
    struct {
        lightmap_input in; /* its numbers alone count, and whether there are area lights and a sky */
        uint64_t asked;
        lightmap map;
    } one[LIGHTMAP_KEPT];
    uint64_t asked;
} lightmap_kept;

/* A copy, if it is there. */
bool lightmap_kept_get(lightmap_kept *k, const lightmap_input *in, lightmap *out);
/* Keeps a copy, if there is memory. */
void lightmap_kept_put(lightmap_kept *k, const lightmap_input *in, const lightmap *m);
void lightmap_kept_free(lightmap_kept *k);

#endif
