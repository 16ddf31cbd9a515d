/* The loader's checks of what a pack says, one section a function. pack_read.c has checked the container before: every section
 * has its hash and exactly the size that META counts. Each refuses with VIT_BAD_INPUT and one line. Records are as the file has them and
 * are looked at by VIT_RECORD alone; the scene is in the machine's byte order. */
#ifndef VIT_PACK_CHECK_H
#define VIT_PACK_CHECK_H

#include "byte_order.h"

#include <float.h>
#include <stdbool.h>

/* Writes "pack: " and the formatted line, returns VIT_BAD_INPUT. */
vit_status vit_pack_refuse(vit_text *why, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* pack_meta.c: the scene itself; after VIT_OK its counts are within the limits that vit_pack_derive() states. */
vit_status vit_pack_check_meta(const vit_scene *s, vit_text *why);

/* pack_check.c: the sections of plain records. */
vit_status vit_pack_check_cameras(const vit_scene *s, const vit_camera *cameras, vit_text *why);
vit_status vit_pack_check_lights(const vit_scene *s, const vit_light *lights, vit_text *why);
vit_status vit_pack_check_attributes(const vit_scene *s, const vit_attributes *attributes, vit_text *why);
vit_status vit_pack_check_materials(const vit_scene *s, const vit_material *materials, vit_text *why);
vit_status vit_pack_check_textures(const vit_scene *s, const vit_texture *textures, vit_text *why);
vit_status vit_pack_check_mips(const vit_scene *s, const vit_mip *mips, vit_text *why);
vit_status vit_pack_check_photons(const vit_scene *s, const vit_photon *photons, vit_text *why);
vit_status vit_pack_check_cells(const vit_scene *s, const vit_u32 *sides, const vit_cell *cells, vit_text *why);
vit_status vit_pack_check_emitters(const vit_scene *s, const vit_emitter *emitters, vit_text *why);
vit_status vit_pack_check_sky(const vit_scene *s, const vit_sky_texel *texels, vit_text *why);
vit_status vit_pack_check_golds(const vit_scene *s, const vit_gold *golds, vit_text *why);

/* vit_pack_check_tree.c: triangles, then the tree over them. */
vit_status vit_pack_check_triangles(const vit_scene *s, const vit_triangle *triangles, vit_text *why);
vit_status vit_pack_check_tree(const vit_scene *s, const vit_bvh_node *nodes, const vit_triangle *triangles, vit_text *why);

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
