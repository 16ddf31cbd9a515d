/* What the files of reach share. */
#ifndef VIT_BAKE_REACH_PARTS_H
#define VIT_BAKE_REACH_PARTS_H

#include "dark_sides/dark_sides.h"
#include "dark_sides/rays.h"
#include <stdatomic.h>

/* The tracks' lights, then the area lights if there are any, then the sky if it shines. */
typedef struct dark_sides_lights {
    const tracks *t;
    uint32_t frames, sources;
    bool sky;
    uint32_t *area_lights;  /* triangles that are area lights */
    double *area_light_sum; /* weights of area lights 0 .. i, by their share of the area and of the number; 2 in all */
    uint32_t area_light_count;
    vec center; /* of a sphere round the scene */
    float radius;
} dark_sides_lights;

typedef struct dark_sides_search {
    geometry *g;
    const model *m;
    uint32_t sides;
    ray_scene rays;
    dark_sides_lights lights;
    float *area;         /* m2 a triangle */
    double whole;        /* m2 of all of them */
    atomic_ullong *flux; /* a side, direct, in fixed point of all lights' power */
    uint32_t light_rays; /* of step 1 */
    uint32_t gathered;   /* rays per side in step 2, at least */
    uint32_t *found;     /* sides that they found, those of side s from found_first[s] to found_first[s + 1] */
    uint32_t *found_first;
    float *direct, *irradiance, *next_irradiance;
    float *path;               /* a side: summed length of the rays of step 2 that found something, m */
    float threshold;           /* irradiance by reflection below which a side is dark, */
    float *least;              /* a side: its own, less where dim frames see it */
    bool *lit;                 /* a side */
    uint32_t *more;            /* a side: rays that step 4 or 5 adds to it */
    atomic_uint newly_reached; /* sides that light came to in the last turn of step 3 */
    atomic_ullong shot;        /* rays */
} dark_sides_search;

/* The side's part of the whole surface, both sides of all triangles. */
double dark_sides_part(const dark_sides_search *s, uint32_t side);
/* What ray `i` of a side finds, and how far away. */
uint32_t dark_sides_look(const dark_sides_search *s, uint32_t side, const ray_side *from, uint32_t i, float *distance);

/* dark_sides/light_paths.c. False: out of memory. */
bool lights_open(dark_sides_search *s, const tracks *t, uint32_t frames, bool sky_light);
void lights_close(dark_sides_lights *l);
/* Some light shines in some frame. */
bool lights_emit(const dark_sides_lights *l);
/* Ray `ray` of all that leave lights, spread over sources and frames. False: it does not leave. */
bool lights_leave(const dark_sides_search *s, uint32_t ray, vec *origin, vec *direction);
/* Irradiance of the side by shadow ray `i`, to some light in some frame: right on average; 0: it does not shine there. */
float lights_ask(const dark_sides_search *s, uint32_t side, const ray_side *from, uint32_t i);

/* dark_sides/edges.c: which sides of a patch, triangles first .. first + count - 1, hang together: neighbours across an edge
 * that only they share, on the same side of the surface. */
#define PATCH_TRIANGLES 128u
#define PATCH_SIDES (2u * PATCH_TRIANGLES)
typedef struct dark_sides_patch {
    uint32_t first, count;       /* triangles */
    uint16_t group[PATCH_SIDES]; /* a side, from 2 * first on: the least side that it hangs together with */
} dark_sides_patch;
void patch_link(const geometry *g, uint32_t first, uint32_t count, dark_sides_patch *out);

/* Gathers s->more rays more a side and repeats step 3. False: out of memory. */
bool dark_sides_gather_more(dark_sides_search *s, unsigned threads);

/* dark_sides/views.c. Sets s->least, which is s->threshold before, where dim frames see sides. False: out of memory. */
bool dark_sides_judge_views(dark_sides_search *s, const tracks *t, uint32_t frames, unsigned threads);

/* dark_sides/ask.c, both by what is known and for patch `patch`. */
/* Sets s->more to DARK_SIDES_LOOKED where faint: hanging together with sides that some light comes to, but having less than
 * DARK_SIDES_FAINT thresholds of it.
 */
#define DARK_SIDES_FAINT 1000.0f
#define DARK_SIDES_LOOKED 16u
void dark_sides_find_faint(void *search, uint32_t patch);
/* Sets s->lit, by further rays where it is not known. */
void dark_sides_ask_patch(void *search, uint32_t patch);

#endif
