/* The loader's checks of what a pack says, one section a function. pack_read.c has checked the container before: every section
 * has its hash and, but for META itself, exactly the size that META counts. Each refuses with VIT_BAD_INPUT and one line.
 * Records are as the file has them and are looked at by VIT_RECORD alone; the scene is in the machine's byte order. */
#ifndef VIT_PACK_CHECK_H
#define VIT_PACK_CHECK_H

#include "byte_order.h"
#include "fail.h"
#include "pack_read.h"

#include <float.h>
#include <stdbool.h>

/* Says "pack: " and the line. */
#define vit_pack_refuse(why, ...) vit_fail(why, VIT_BAD_INPUT, "pack: " __VA_ARGS__)

/* A check for each section: pack_read.c calls them in the order of VIT_SECTIONS, and one that is missing here does not compile
 * there. */
typedef vit_status vit_pack_check(const vit_pack *p, vit_text *why);
/* pack_meta.c: the scene itself; after VIT_OK its counts are within the limits that vit_pack_derive() states. */
vit_pack_check vit_pack_check_META;
/* pack_check_tree.c: triangles, then the tree over them. */
vit_pack_check vit_pack_check_GEOM, vit_pack_check_BVHN;
/* pack_check.c: the sections of plain records. */
vit_pack_check vit_pack_check_CAMS, vit_pack_check_LITE, vit_pack_check_ATTR, vit_pack_check_MATL, vit_pack_check_MAPS,
    vit_pack_check_TEXR, vit_pack_check_MIPS, vit_pack_check_ATLS, vit_pack_check_SIDE, vit_pack_check_CELL,
    vit_pack_check_EMIT, vit_pack_check_SKYT, vit_pack_check_PHOT, vit_pack_check_GOLD;
/* pack_check_receivers.c: receivers of indirect light, and of the lightmap. */
vit_pack_check vit_pack_check_RCEL, vit_pack_check_RSPL, vit_pack_check_RECV, vit_pack_check_MSID, vit_pack_check_MCEL,
    vit_pack_check_MSPL, vit_pack_check_MREC;
/* Sides of triangles, SIDE or MSID, whose cells are among so many. */
vit_status vit_pack_check_sides(const vit_pack *p, vit_section section, vit_u32 cells, vit_text *why);
/* pack_check_basis.c: what light that moves does to receivers. */
vit_pack_check vit_pack_check_BGRP, vit_pack_check_BWRD, vit_pack_check_BCOE, vit_pack_check_BFRM;
/* pack_check_radiosity.c: patches, and what receivers see of them. */
vit_pack_check vit_pack_check_PATC, vit_pack_check_PPNT, vit_pack_check_GROW, vit_pack_check_GATH, vit_pack_check_LOOK,
    vit_pack_check_XFER;
/* pack_check_cache.c: the table of the world-space cache. */
vit_pack_check vit_pack_check_CACH;
/* Irradiance of any receiver by a light of the basis with an intensity of 1, at most; *still: by all other light, W/m2. Both 0
 * without receivers. */
double vit_pack_basis_bound(const vit_pack *p, double *still);
/* pack_check_cache.c: of RCEL where it has points. */
vit_pack_check vit_pack_check_points;
/* pack_check_brightness.c: all sections together, after their own checks: whether light stays finite up to the pixel. */
vit_pack_check vit_pack_check_brightness;
/* A traced photon's power over its disc, W/m2, at most; 0 of lights without paths. */
double vit_pack_photon_bound(const vit_scene *s, const vit_light *l);

/* False for NaN, as every comparison with it is. */
static inline bool in_range(float value, float least, float most) {
    return value >= least && value <= most;
}

static inline bool all_in_range(const float *values, int count, float least, float most) {
    for (int i = 0; i < count; i++)
        if (!in_range(values[i], least, most))
            return false;
    return true;
}

static inline bool all_finite(const float *values, int count) {
    return all_in_range(values, count, -FLT_MAX, FLT_MAX);
}

/* Length within 1e-3 of 1, compared squared: the library needs no libm. */
static inline bool is_unit(const float v[3]) {
    double length2 = (double)v[0] * v[0] + (double)v[1] * v[1] + (double)v[2] * v[2];
    return length2 >= 0.999 * 0.999 && length2 <= 1.001 * 1.001;
}

static inline bool all_zero(const vit_u32 *words, int count) {
    for (int i = 0; i < count; i++)
        if (words[i] != 0)
            return false;
    return true;
}

#endif
