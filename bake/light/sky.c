/* The picture comes as longitude and latitude, where texels crowd at the poles, and goes into the octahedral square, where they
 * are nearly alike: each texel of the picture is cut into parts, finer than the square's texels, and each part, weighted by its
 * solid angle, goes to the texel that it lies in; so none is lost, however small and bright. Directions are chosen by
 * hierarchical warping: P. Clarberg et al., Wavelet importance sampling, 2005. */
#include "light/sky.h"
#include "common/pi.h"
#include "common/fail.h"
#include "common/file_trouble.h"
#include "import/image_file.h"
#include "import/image_head.h"
#include "import/radiance.h"
#include "common/sobol.h"
#include "common/strict_math.h"
#include <math.h>
#include <stb/stb_image.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#define MAX_TEXELS (1u << 25) /* of the picture: 384 MiB as floats */
#define LEAST_SIZE 16u
#define MOST_SIZE 1024u
#define PARTS 8u /* a texel of the square is about as wide as so many parts */

/* ---- the octahedral square ---- */

vec3 sky_place(double u, double v, double *density) {
    const double z = 1.0 - fabs(u) - fabs(v);
    const double x = z >= 0.0 ? u : (1.0 - fabs(v)) * (u < 0.0 ? -1.0 : 1.0),
                 y = z >= 0.0 ? v : (1.0 - fabs(u)) * (v < 0.0 ? -1.0 : 1.0);
    const double l = sqrt(x * x + y * y + z * z);
    *density = 1.0 / (l * l * l);
    return (vec3){(float)(x / l), (float)(y / l), (float)(z / l)};
}

static vit_sky_texel *texel(const environment *s, int x, int y) {
    return s->texels + (size_t)(y + 1) * (s->size + 2) + (size_t)(x + 1);
}

/* Beyond an edge the picture goes on at the same edge, from the other end. */
static void fill_gutter(environment *s) {
    const int n = (int)s->size, last = n - 1;
    for (int i = 0; i < n; i++) {
        *texel(s, -1, i) = *texel(s, 0, last - i);
        *texel(s, n, i) = *texel(s, last, last - i);
        *texel(s, i, -1) = *texel(s, last - i, 0);
        *texel(s, i, n) = *texel(s, last - i, last);
    }
    *texel(s, -1, -1) = *texel(s, last, last);
    *texel(s, n, n) = *texel(s, 0, 0);
    *texel(s, -1, n) = *texel(s, last, 0);
    *texel(s, n, -1) = *texel(s, 0, last);
}

vec3 sky_radiance(const environment *s, vec3 d) {
    return s->size == 0 ? vec3_load(s->background) : sky_picture(s->texels, s->size, d);
}

/* ---- directions by importance ---- */

/* Power that a texel's interpolated picture sends, W/m2 a channel and, returned, of all: each quarter's mean is what its middle
 * has. */
static double texel_power(const environment *s, int x, int y, double power[3]) {
    const double width = 2.0 / s->size;
    memset(power, 0, 3 * sizeof *power);
    for (int q = 0; q < 4; q++) {
        const int across = q & 1 ? 1 : -1, down = q & 2 ? 1 : -1;
        double solid = 0.0;
        (void)sky_place((x + 0.5 + 0.25 * across) * width - 1.0, (y + 0.5 + 0.25 * down) * width - 1.0, &solid);
        solid *= 0.25 * width * width;
        const float *own = texel(s, x, y)->radiance, *beside = texel(s, x + across, y)->radiance,
                    *below = texel(s, x, y + down)->radiance, *corner = texel(s, x + across, y + down)->radiance;
        for (int k = 0; k < 3; k++)
            power[k] += solid * (0.5625 * (double)own[k] + 0.1875 * ((double)beside[k] + (double)below[k]) +
                                 0.0625 * (double)corner[k]);
    }
    return power[0] + power[1] + power[2];
}

/* Level l of the pyramid: 4^l squares, row after row, behind all coarser levels. */
static double *level_of(const environment *s, uint32_t size) {
    return s->weight + ((size_t)size * size - 1) / 3;
}

static bool weigh(environment *s) {
    s->weight = malloc(((size_t)4 * s->size * s->size - 1) / 3 * sizeof *s->weight);
    if (!s->weight)
        return false;
    double *finest = level_of(s, s->size), power[3];
    memset(s->irradiance, 0, sizeof s->irradiance);
    for (int y = 0; y < (int)s->size; y++)
        for (int x = 0; x < (int)s->size; x++) {
            *finest++ = texel_power(s, x, y, power);
            for (int k = 0; k < 3; k++)
                s->irradiance[k] += power[k];
        }
    for (uint32_t size = s->size / 2; size > 0; size /= 2) {
        double *to = level_of(s, size);
        const double *from = level_of(s, 2 * size);
        for (size_t y = 0; y < size; y++)
            for (size_t x = 0; x < size; x++) {
                const double *q = from + 4 * y * size + 2 * x;
                to[y * size + x] = (q[0] + q[1]) + (q[2 * size] + q[2 * size + 1]);
            }
    }
    return true;
}

/* Takes the part of 0..1 that *x lies in, `first` to `second`: false for the first; *x becomes its place there. */
static bool part(double first, double second, double *x) {
    const double at = *x * (first + second);
    const bool far = second > 0.0 && at >= first;
    *x = fmin(far ? (at - first) / second : at / first, 1.0 - 0x1p-32);
    return far;
}

sky_ray sky_choose(const environment *s, double x, double y) {
    if (s->size == 0) {
        const double z = 1.0 - 2.0 * y, r = sqrt(fmax(1.0 - z * z, 0.0));
        const vec3 d = {(float)(r * strict_cos(2.0 * PI * x)), (float)z, (float)(r * strict_sin(2.0 * PI * x))};
        return (sky_ray){vec3_unit(d), vec3_scale(vec3_load(s->background), (float)(4.0 * PI))};
    }
    size_t column = 0, row = 0;
    for (uint32_t size = 2; size <= s->size; size *= 2) {
        column *= 2;
        row *= 2;
        const double *q = level_of(s, size) + row * size + column;
        const bool right = part(q[0] + q[size], q[1] + q[size + 1], &x);
        row += part(q[right], q[size + right], &y);
        column += right;
    }
    const double width = 2.0 / s->size;
    double solid, power[3];
    const double chosen = texel_power(s, (int)column, (int)row, power) / s->weight[0]; /* probability */
    return (sky_ray){sky_place(((double)column + x) * width - 1.0, ((double)row + y) * width - 1.0, &solid),
                     {(float)(power[0] / chosen), (float)(power[1] / chosen), (float)(power[2] / chosen)}};
}

void sky_sets(const environment *s, uint32_t samples, vit_light_sample *out) {
    const float share = 1.0f / (float)samples;
    for (uint32_t set = 0; set < VIT_PATTERNS; set++)
        for (uint32_t i = 0; i < samples; i++) {
            double x, y;
            sobol_point(samples, set, i, &x, &y);
            const sky_ray r = sky_choose(s, x, y);
            *out++ = (vit_light_sample){.position = {r.direction.x, r.direction.y, r.direction.z},
                                        .power = {r.power.x * share, r.power.y * share, r.power.z * share}};
        }
}

void sky_sphere(const double lo[3], const double hi[3], float center[3], float *radius) {
    double square = 0.0;
    for (int k = 0; k < 3; k++) {
        center[k] = (float)(0.5 * (lo[k] + hi[k]));
        square += 0.25 * (hi[k] - lo[k]) * (hi[k] - lo[k]);
    }
    *radius = (float)(sqrt(square) * 1.001); /* however directions and planes are rounded */
}

/* ---- from longitude and latitude ---- */

typedef struct splat {
    double weight, radiance[3]; /* sums of solid angle, and of radiance times it */
} splat;

/* Gives each texel of the square what of the picture lies in it. Returns the picture's power, W/m2 a channel. */
static void splat_picture(const float *rgb, int width, int height, double rotate, uint32_t size, splat *to, double power[3]) {
    const uint32_t across = (2 * PARTS * size + (uint32_t)width - 1) / (uint32_t)width, parts = across < 2 ? 2 : across;
    const double columns = (double)width * parts, rows = (double)height * parts;
    for (int y = 0; y < height; y++)
        for (uint32_t j = 0; j < parts; j++) {
            const double upper = PI * ((double)y * parts + j) / rows, lower = PI * ((double)y * parts + j + 1.0) / rows;
            const double middle = 0.5 * (upper + lower), sine = strict_sin(middle),
                         solid = (strict_cos(upper) - strict_cos(lower)) * 2.0 * PI / columns;
            const float height_of = (float)strict_cos(middle);
            for (int x = 0; x < width; x++) {
                const float *c = rgb + 3 * ((size_t)y * (size_t)width + (size_t)x);
                for (int k = 0; k < 3; k++)
                    power[k] += solid * parts * (double)c[k];
                for (uint32_t i = 0; i < parts; i++) {
                    const double angle = 2.0 * PI * (((double)x * parts + i + 0.5) / columns - 0.5) - rotate;
                    float u, v;
                    octahedral_place((vec3){(float)(sine * strict_sin(angle)), height_of, (float)(-sine * strict_cos(angle))},
                                     &u, &v);
                    const int column = (int)((u * 0.5f + 0.5f) * (float)size), row = (int)((v * 0.5f + 0.5f) * (float)size);
                    const size_t at = (size_t)(row < (int)size ? row : (int)size - 1) * size +
                                      (size_t)(column < (int)size ? column : (int)size - 1);
                    to[at].weight += solid;
                    for (int k = 0; k < 3; k++)
                        to[at].radiance[k] += solid * (double)c[k];
                }
            }
        }
}

vit_status sky_from_texels(const float *rgb, int width, int height, double rotate, environment *out, vit_text *why) {
    uint32_t size = LEAST_SIZE;
    while (size < MOST_SIZE && 2 * size <= (uint32_t)width / 2 + (uint32_t)width / 4)
        size *= 2; /* texels as wide as the picture's at the horizon, or up to twice as fine */
    *out = (environment){.size = size, .texels = calloc((size_t)(size + 2) * (size + 2), sizeof *out->texels)};
    splat *sums = calloc((size_t)size * size, sizeof *sums);
    double power[3] = {0, 0, 0};
    bool fine = out->texels && sums;
    if (fine) {
        splat_picture(rgb, width, height, rotate * PI / 180.0, size, sums, power);
        for (uint32_t i = 0; i < size * size; i++)
            for (int k = 0; k < 3; k++)
                texel(out, (int)(i % size), (int)(i / size))->radiance[k] = (float)(sums[i].radiance[k] / sums[i].weight);
        fill_gutter(out);
        fine = weigh(out);
    }
    /* Texels and their sums of parts differ a little: what that changes of a small sun's power is put right over all. */
    for (uint32_t i = 0; fine && i < (size + 2) * (size + 2); i++)
        for (int k = 0; k < 3; k++)
            if (out->irradiance[k] > 0.0)
                out->texels[i].radiance[k] = (float)((double)out->texels[i].radiance[k] * (power[k] / out->irradiance[k]));
    free(sums);
    if (fine) {
        free(out->weight);
        fine = weigh(out);
    }
    if (fine)
        return VIT_OK;
    sky_free(out);
    return bake_fail(why, VIT_FAILED, "sky: out of memory");
}

/* ---- files ---- */

/* Codes of sRGB, in as many bits as the file has them, as light; NULL: broken. */
static float *decode_srgb(const uint8_t *bytes, int size, size_t values) {
    int width, height, channels;
    const bool wide = stbi_is_16_bit_from_memory(bytes, size);
    void *codes = wide ? (void *)stbi_load_16_from_memory(bytes, size, &width, &height, &channels, 3)
                       : (void *)stbi_load_from_memory(bytes, size, &width, &height, &channels, 3);
    float *rgb = codes ? malloc(values * sizeof *rgb) : NULL;
    for (size_t i = 0; rgb && i < values; i++)
        rgb[i] = (float)srgb_linear(wide ? ((const uint16_t *)codes)[i] / 65535.0 : ((const uint8_t *)codes)[i] / 255.0);
    stbi_image_free(codes);
    return rgb;
}

static bool scale_by(float *rgb, size_t values, double scale, const double divisor[3]) {
    for (size_t i = 0; i < values; i++) {
        const double c = (double)rgb[i] / divisor[i % 3] * scale;
        if (!(c >= 0.0 && c <= (double)VIT_MAX_RADIANCE))
            return false;
        rgb[i] = (float)c;
    }
    return true;
}

/* What is wrong with the size, or NULL. */
static const char *check_size(int size, int width, int height) {
    if (width < 1 || height < 1 || width * (int64_t)height < 2 || (uint64_t)width * (uint64_t)height > MAX_TEXELS)
        return "has no or more than 2^25 texels";
    if (width != 2 * height)
        return "is not twice as wide as high: a whole sky is wanted";
    if ((uint64_t)width * (uint64_t)height > (uint64_t)size * 8 * 1032) /* deflate's 1032 to 1, a bit a texel */
        return "is broken";
    return NULL;
}

/* The picture, linear and scaled; bytes of a Radiance picture are put in order. What is wrong with it, or NULL. */
static const char *decode(uint8_t *bytes, int size, double scale, int *width, int *height, float **rgb) {
    int channels;
    double divisor[3] = {1.0, 1.0, 1.0};
    radiance_order order = {.columns = false};
    const bool radiance = stbi_is_hdr_from_memory(bytes, size);
    const char *wrong = radiance ? radiance_stand(bytes, (size_t)size, &order) : image_head_jpeg(bytes, (size_t)size);
    *rgb = NULL;
    if (wrong)
        return wrong;
    if (!image_head_size(bytes, (size_t)size, width, height))
        return "is not an image that can be read (HDR, PNG, JPEG, TGA, BMP)";
    wrong = order.columns ? check_size(size, *height, *width) : check_size(size, *width, *height);
    if (!wrong && radiance)
        wrong = radiance_check(bytes, (size_t)size, *width, *height, divisor);
    if (wrong)
        return wrong;
    const size_t values = 3 * (size_t)*width * (size_t)*height;
    *rgb = radiance ? stbi_loadf_from_memory(bytes, size, width, height, &channels, 3) : decode_srgb(bytes, size, values);
    if (!*rgb || !radiance_turn(rgb, width, height, &order))
        return "is broken";
    return scale_by(*rgb, values, scale, divisor) ? NULL : "has radiances, times sky.scale, that are not in 0..1e12";
}

vit_status sky_load(const char *file, double scale, double rotate, environment *out, vit_text *why) {
    int size, width = 0, height = 0;
    float *rgb = NULL;
    uint8_t *bytes = image_file_read(file, &size);
    const char *wrong = bytes ? decode(bytes, size, scale, &width, &height, &rgb) : file_trouble(file);
    if (!bytes && !wrong)
        wrong = "is empty or cannot be read";
    vit_status status;
    *out = (environment){0};
    if (wrong)
        status = bake_fail(why, VIT_BAD_INPUT, "sky: '%.300s' %s", file, wrong);
    else
        status = sky_from_texels(rgb, width, height, rotate, out, why);
    free(rgb); /* stb's memory is malloc's */
    free(bytes);
    return status;
}

void sky_constant(const double radiance[3], environment *out) {
    *out = (environment){0};
    for (int k = 0; k < 3; k++) {
        out->background[k] = (float)radiance[k];
        out->irradiance[k] = 4.0 * PI * radiance[k];
    }
}

void sky_free(environment *s) {
    free(s->texels);
    free(s->weight);
    *s = (environment){0};
}
