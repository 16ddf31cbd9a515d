/* soft_light.c: irradiance of a place by what has an extent: the sky and area lights, shadows and all. By rays of the baker's,
 * as many as it takes. */
#ifndef VIT_RADIOSITY_SOFT_LIGHT_H
#define VIT_RADIOSITY_SOFT_LIGHT_H

#include "geometry/cells.h"
#include "light/area_lights.h"
#include "light/photon_rays.h"
#include "light/sky.h"

typedef struct soft_lights {
    const photon_rays *rays;
    const geometry *geometry;
    const area_lights *area; /* NULL: none */
    const environment *sky;  /* NULL: it gives no light */
    float error;             /* share of the irradiance that what is left out of a ray's neighbourhood may be, about; */
    float dim;               /* irradiance counts as this much at least, W/m2, channels added up */
} soft_lights;

/* W/m2 a channel on the side's place, a ray_offset above it. Returns how many rays it took. */
uint32_t soft_light_at(const soft_lights *l, uint32_t side, float b1, float b2, float irradiance[3]);

#endif
