/* sky.c: what is seen where rays meet nothing, and how it lights the scene: one radiance, or an octahedral picture. */
#ifndef VIT_BAKE_SKY_H
#define VIT_BAKE_SKY_H

#include "common/kernel_math.h"
#include "vitrine_pack.h"

typedef struct environment {
    uint32_t size;         /* texels per side, a power of two; 0: no picture */
    vit_sky_texel *texels; /* (size + 2)^2, section SKYT */
    float background[3];   /* radiance without a picture, W/(m2 sr) */
    double irradiance[3];  /* of all directions together on what faces them: the integral of radiance, W/m2 */
    double *
        weight; /* with a picture: quarters of quarters of the square, their power summed over channels: 1, 4, 16, ... size^2 */
} environment;

/* From a picture of the whole sky, twice as wide as high: u = 0.5 + atan2(x, -z) / (2 pi) to the right, v = acos(y) / pi from
 * the top, in front of the scene's -z in the middle. PNG and JPEG are sRGB, .hdr (Radiance) is linear. scale: W/(m2 sr) of a
 * value of 1; rotate: degrees about y, as meshes are. VIT_BAD_INPUT: the text names file and cause; VIT_FAILED: out of memory.
 */
vit_status sky_load(const char *file, double scale, double rotate, environment *out, vit_text *why);
/* From `width` x `height` linear texels, W/(m2 sr), three floats each. */
vit_status sky_from_texels(const float *rgb, int width, int height, double rotate, environment *out, vit_text *why);
/* The same in all directions. */
void sky_constant(const double radiance[3], environment *out);
void sky_free(environment *s);

/* Radiance in unit direction d, W/(m2 sr); sky_radiance() of kernels/samples.cl. */
vec3 sky_radiance(const environment *s, vec3 d);

/* The same of a picture of `size` texels per side, section SKYT. */
static inline vec3 sky_picture(const vit_sky_texel *texels, uint32_t size, vec3 d) {
    float x, y;
    const float wide = (float)size;
    octahedral_place(d, &x, &y);
    const float u = float_min(float_max(fmaf(fmaf(x, 0.5f, 0.5f), wide, -0.5f), -1.0f), wide - 0.5f);
    const float v = float_min(float_max(fmaf(fmaf(y, 0.5f, 0.5f), wide, -0.5f), -1.0f), wide - 0.5f);
    const float fu = floorf(u), fv = floorf(v);
    const vit_sky_texel *t = texels + (size_t)((int)fv + 1) * (size + 2) + (size_t)((int)fu + 1), *below = t + size + 2;
    const vec3 c00 = vec3_load(t->radiance), c10 = vec3_load(t[1].radiance);
    const vec3 c01 = vec3_load(below->radiance), c11 = vec3_load(below[1].radiance);
    const vec3 top = vec3_along(c00, vec3_sub(c10, c00), u - fu), bottom = vec3_along(c01, vec3_sub(c11, c01), u - fu);
    const vec3 c = vec3_along(top, vec3_sub(bottom, top), v - fv);
    return (vec3){float_max(c.x, 0.0f), float_max(c.y, 0.0f), float_max(c.z, 0.0f)};
}

/* Unit direction of a place of the octahedral square, -1..1; *density: solid angle over area of the square there, sr. */
vec3 sky_place(double u, double v, double *density);

typedef struct sky_ray {
    vec3 direction; /* to the sky, unit */
    vec3 power;     /* radiance, the mean of the direction's texel, / density of directions, W/m2 */
} sky_ray;

/* The direction for 0 < x, y < 1: even over the unit square is dense in proportion to radiance. Not for a black sky. */
sky_ray sky_choose(const environment *s, double x, double y);

/* Middle and radius, m, of a sphere round a box: photons of the sky leave the disc that it shows. */
void sky_sphere(const double lo[3], const double hi[3], float center[3], float *radius);

/* VIT_PATTERNS sets of `samples` directions, section EMIT's second part. */
void sky_sets(const environment *s, uint32_t samples, vit_light_sample *out);

#endif
