/* sights.c: places that the cameras of the path see, behind mirrors and in glass too. */
#ifndef VIT_CACHE_SIGHTS_H
#define VIT_CACHE_SIGHTS_H

#include "light/photon_rays.h"
#include "motion/tracks.h"

typedef struct cache_sight {
    vec3 position;  /* a ray_offset before the surface, as view samples are */
    vec3 normal;    /* unit, interpolated, on the seen side */
    vec3 face;      /* unit, of the triangle */
    float distance; /* from the frame's eye, straight, m */
    uint32_t side;  /* of which triangle, */
    float b1, b2;   /* and where on it: barycentric weights */
} cache_sight;

typedef struct cache_sights {
    cache_sight *sight; /* frame after frame, row after row */
    uint32_t count;
    float nearest, farthest; /* distances; 0 where nothing is seen */
    float pixel;             /* the least width of a pixel a metre of way, of all frames */
} cache_sights;

typedef struct cache_sights_input {
    const photon_rays *rays;
    const tracks *tracks;
    uint32_t frames, width, height;
    unsigned threads; /* 0: all cores; changes no byte */
    void (*progress)(void *user, double fraction);
    void *user;
} cache_sights_input;

/* VIT_FAILED: out of memory. */
vit_status cache_sights_find(const cache_sights_input *in, cache_sights *out, vit_text *why);
void cache_sights_free(cache_sights *s);

#endif
