/* basis_points.c: receivers in space: the points of the world-space cache (cache/), whose light comes nearest, interpolated, to
 * that of places which cameras see. kernels/METHODS.md, "Irradiance basis". */
#ifndef VIT_RADIOSITY_BASIS_POINTS_H
#define VIT_RADIOSITY_BASIS_POINTS_H

#include "cache/sights.h"
#include "cache/table.h"
#include "radiosity/transport.h"

typedef struct basis_points_input {
    cache_sights_input seen;
    double spacing;   /* between points on the picture, pixels */
    uint32_t most;    /* places whose light is found, at most: those that a frame sees alike are left out first */
    uint32_t columns; /* of light */
    /* Light of places: count x columns. rough: of few rays, which tells where walls are. */
    vit_status (*light)(void *user, const receiver *places, uint32_t count, bool rough, const transport_light *out,
                        vit_text *why);
    void *user;
} basis_points_input;

typedef struct basis_points {
    cache_table table;      /* section RCEL with the effect POINTS */
    uint32_t levels;        /* vit_scene.point_levels, */
    float step, detail;     /* point_step, point_detail */
    uint32_t count;         /* points: receivers */
    uint32_t cells, parted; /* cells; by walls */
    uint32_t places;        /* whose light was found */
    double off;             /* root of the mean square of the error where places were left out, of the mean */
} basis_points;

/* *irradiance: of the points, count x columns, none below 0, ordered so that neighbours in space are near each other; the
 * caller frees it. VIT_FAILED: out of memory, or more cells than a table may hold; there is nothing to free. */
vit_status basis_points_find(const basis_points_input *in, basis_points *out, float **irradiance, vit_text *why);
void basis_points_free(basis_points *p);

#endif
