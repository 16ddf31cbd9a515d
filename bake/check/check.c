/* Pixels, reference, comparison; check_say.c has the words. */
#include "check/check.h"
#include "common/fail.h"
#include "common/kernel_math.h"
#include "pack/opened.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define ENOUGH 0.01      /* standard error of the reference's sums that is asked for */
#define MOST_PATHS 2048u /* a pixel */
#define FEW_PATHS 128u   /* for the share of the light that so many bounces find */
#define SAME 1e-4        /* of a pixel: it shows what it should, but for rounding */
#define BLACK 3e-4       /* radiance times exposure that shows as 0 or 1 of 255 */
#define NOTICED 1e-3     /* of the picture's mean: less than that in its dark half is nothing to see */

void check_choose(uint32_t frames, uint32_t width, uint32_t height, check *out) {
    memset(out, 0, sizeof *out);
    out->frame_count = frames < CHECK_FRAMES ? frames : CHECK_FRAMES;
    for (uint32_t i = 0; i < out->frame_count; i++)
        out->frames[i] = (2 * i + 1) * frames / (2 * out->frame_count);
    out->count = CHECK_PIXELS;
    for (uint32_t i = 0; i < out->count; i++) { /* an even sequence in two dimensions (Roberts 2018), 32 bits of its steps */
        spot *s = out->spots + i;
        s->frame = i * out->frame_count / out->count;
        s->x = (uint32_t)((uint64_t)(0x80000000u + i * LATTICE_U) * width >> 32);
        s->y = (uint32_t)((uint64_t)(0x80000000u + i * LATTICE_V) * height >> 32);
    }
}

/* A frame's place in the pack. */
static uint32_t place_of(const check *c, const pipeline_packed *packed, uint32_t k) {
    return packed->plan.scene.frames == c->frame_count ? k : c->frames[k];
}

/* Which lights give no indirect light. */
static bool *direct_only(const pipeline *p, uint32_t lights) {
    bool *only = calloc(lights + 1u, sizeof *only);
    for (uint32_t i = 0; only && i < lights; i++)
        only[i] = !p->scene.automatic && !p->scene.lights[i].photons;
    return only;
}

static void tracing(void *user, double fraction) {
    progress_step(user, fraction);
}

static vit_status trace(const pipeline *p, const pipeline_packed *packed, uint32_t most, check *c, vit_text *why) {
    bool *only = direct_only(p, packed->plan.scene.lights);
    if (!only) {
        return bake_fail(why, VIT_FAILED, "out of memory");
    }
    const spots_input in = {.sections = &packed->sections,
                            .direct_only = only,
                            .bounces = c->bounces,
                            .error = ENOUGH,
                            .most = most,
                            .threads = p->threads,
                            .progress = tracing,
                            .user = p->progress};
    const vit_status status = spots_render(&in, c->spots, c->count, &c->paths, why);
    free(only);
    return status;
}

static void place_spots(const pipeline_packed *packed, check *c) {
    c->bounces = packed->plan.scene.bounces;
    for (uint32_t i = 0; i < c->count; i++)
        c->spots[i].frame = place_of(c, packed, i * c->frame_count / c->count);
}

vit_status check_glance(const pipeline *p, const pipeline_packed *packed, check *c, vit_text *why) {
    place_spots(packed, c);
    return trace(p, packed, FEW_PATHS, c, why);
}

vit_status check_trace(const pipeline *p, const pipeline_packed *packed, check *c, vit_text *why) {
    place_spots(packed, c);
    progress_stage(p->progress, "check against path tracing");
    const vit_status status = trace(p, packed, MOST_PATHS, c, why);
    progress_end(p->progress);
    return status;
}

/* The pixels of the check as the pack shows them: 3 floats each. */
static vit_status play(const pipeline *p, const pipeline_packed *packed, const check *c, vit_view view, float *out,
                       vit_text *why) {
    const vit_open_info how = {.pack = packed->bytes,
                               .pack_size = packed->size,
                               .device = VIT_DEVICE_HOST,
                               .threads = p->threads,
                               .format = VIT_FORMAT_RGBA32F,
                               .view = view};
    opened o;
    vit_status status = opened_begin(&how, &o, why);
    if (status != VIT_OK)
        return status;
    for (uint32_t k = 0, i = 0; k < c->frame_count && status == VIT_OK; k++) {
        status = opened_frame(&o, place_of(c, packed, k), why);
        for (; i < c->count && i * c->frame_count / c->count == k; i++)
            memcpy(out + 3 * (size_t)i,
                   (const float *)(const void *)o.frame + 4 * ((size_t)c->spots[i].y * o.need.width + c->spots[i].x),
                   3 * sizeof *out);
    }
    opened_end(&o);
    return status;
}

static double sum3(const double v[3]) {
    return v[0] + v[1] + v[2];
}

static double shown(const float *picture, uint32_t i) {
    return (double)picture[3 * i] + (double)picture[3 * i + 1] + (double)picture[3 * i + 2];
}

static check_ratio ratio(double picture, double right, double variance) {
    if (!(right > 0))
        return (check_ratio){picture > 0 ? INFINITY : 1, 0};
    return (check_ratio){picture / right, picture / right * sqrt(variance) / right};
}

/* Mean of the sequences first and first + 1, all channels. */
static double half_of(const spot *s, uint32_t first) {
    return (sum3(s->all[first]) + sum3(s->all[first + 1])) / 2;
}

/* A pixel for the order of brightness. */
typedef struct ranked {
    double by;
    uint32_t spot;
} ranked;

static int in_order(const void *a, const void *b) {
    const ranked *x = a, *y = b;
    if (x->by != y->by)
        return x->by < y->by ? -1 : 1;
    return x->spot < y->spot ? -1 : 1;
}

/* Pixels that any light but their own could change: not the background, nor area lights alone. */
static bool counts(const spot *s, const float *picture, uint32_t i) {
    const double right = spot_brightness(s);
    return sum3(s->variance) > 0 || right > sum3(s->direct) || fabs(shown(picture, i) - right) > SAME * right;
}

static double limited_of(const spot *s, uint32_t first) {
    return (sum3(s->limited[first]) + sum3(s->limited[first + 1])) / 2;
}

/* The darker half by one pair of sequences, measured by the other pair, both ways: which pixels are in it would otherwise
 * follow the very noise that is measured, and the reference would seem too dark. */
static check_ratio compare_dark(const check *c, const float *picture, double mean, double *share) {
    ranked order[CHECK_PIXELS] = {{0}};
    unsigned in[CHECK_PIXELS] = {0};
    double right = 0, limited = 0, seen = 0, variance = 0, pixels = 0;
    for (uint32_t first = 0; first < REFERENCE_SEQUENCES; first += 2) {
        uint32_t count = 0;
        for (uint32_t i = 0; i < c->count; i++)
            if (counts(c->spots + i, picture, i))
                order[count++] = (ranked){half_of(c->spots + i, first), i};
        qsort(order, count, sizeof *order, in_order);
        for (uint32_t k = 0; k < (count + 1) / 2; k++) {
            const uint32_t i = order[k].spot;
            right += half_of(c->spots + i, 2 - first) / 2;
            limited += limited_of(c->spots + i, 2 - first) / 2;
            seen += shown(picture, i) / 2;
            pixels += 0.5;
            in[i]++;
        }
    }
    for (uint32_t i = 0; i < c->count; i++) /* all four sequences, or the mean of two at half weight */
        variance += (in[i] == 2 ? 1.0 : in[i] ? 0.5 : 0.0) * 3 * sum3(c->spots[i].variance);
    check_ratio r = ratio(seen, right, variance);
    if (fabs(seen - right) <= NOTICED * mean * pixels || seen + right <= BLACK * pixels)
        r.value = 1;
    *share = right > 0 ? limited / right : 1;
    return r;
}

static void look_at_brightness(const check *c, const float *picture, check_found *out) {
    ranked order[CHECK_PIXELS] = {{0}};
    uint32_t white = 0, hit = 0;
    for (uint32_t i = 0; i < c->count; i++) {
        const float *q = picture + 3 * (size_t)i;
        const double least = fmin((double)q[0], fmin((double)q[1], (double)q[2])),
                     most = fmax((double)q[0], fmax((double)q[1], (double)q[2]));
        out->black += (most < BLACK) / (double)c->count;
        white += c->spots[i].hit && least >= 1.0;
        hit += c->spots[i].hit;
        out->unlit += !(spot_brightness(c->spots + i) > 0) / (double)c->count;
        out->unhit += !c->spots[i].hit / (double)c->count;
        order[i] = (ranked){most, i};
    }
    qsort(order, c->count, sizeof *order, in_order);
    out->white = hit > 0 ? white / (double)hit : 0;
    out->median = order[c->count / 2].by;
}

static double beyond(check_ratio r) {
    return fabs(r.value - 1) - r.error;
}

static void compare(const check *c, const float *picture, check_found *out) {
    double right[3] = {0}, limited = 0, seen[3] = {0}, variance[3] = {0};
    for (uint32_t i = 0; i < c->count; i++)
        for (int k = 0; k < 3; k++) {
            seen[k] += (double)picture[3 * (size_t)i + (size_t)k];
            variance[k] += c->spots[i].variance[k];
            for (uint32_t q = 0; q < REFERENCE_SEQUENCES; q++) {
                right[k] += c->spots[i].all[q][k] / REFERENCE_SEQUENCES;
                limited += c->spots[i].limited[q][k] / REFERENCE_SEQUENCES;
            }
        }
    *out = (check_found){.direct = 1, .indirect = 1, .limited = sum3(right) > 0 ? limited / sum3(right) : 1};
    for (int k = 0; k < 3; k++) {
        out->flux[k] = ratio(seen[k], right[k], variance[k]);
        if ((right[k] <= 1e-3 * sum3(right) && seen[k] <= 2e-3 * sum3(right)) || /* a channel without light */
            (right[k] + seen[k] <= BLACK * c->count))                            /* nothing to see in either */
            out->flux[k].value = 1;
        out->worst = fmax(out->worst, beyond(out->flux[k]));
    }
    double share;
    out->dark = compare_dark(c, picture, sum3(right) / c->count, &share);
    out->limited = fmin(out->limited, share);
    out->worst = fmax(out->worst, beyond(out->dark));
    look_at_brightness(c, picture, out);
}

vit_status check_share(const pipeline *p, const pipeline_packed *packed, const check *c, uint32_t bounces, double *share,
                       vit_text *why) {
    float black[3 * CHECK_PIXELS] = {0};
    check *few = malloc(sizeof *few);
    check_found found;
    if (!few) {
        return bake_fail(why, VIT_FAILED, "out of memory");
    }
    *few = *c;
    few->bounces = bounces;
    const vit_status status = trace(p, packed, FEW_PATHS, few, why);
    if (status == VIT_OK)
        compare(few, black, &found);
    *share = status == VIT_OK ? found.limited : 0;
    free(few);
    return status;
}

/* Direct and indirect light alone. */
static void compare_parts(const check *c, const float *picture, const float *direct, check_found *out) {
    double right = 0, seen = 0, right_direct = 0, seen_direct = 0;
    for (uint32_t i = 0; i < c->count; i++) {
        right += spot_brightness(c->spots + i);
        seen += shown(picture, i);
        right_direct += sum3(c->spots[i].direct);
        seen_direct += shown(direct, i);
    }
    out->direct = ratio(seen_direct, right_direct, 0).value;
    out->indirect = ratio(seen - seen_direct, right - right_direct, 0).value;
}

vit_status check_compare(const pipeline *p, const pipeline_packed *packed, const check *c, bool parts, check_found *out,
                         vit_text *why) {
    float picture[3 * CHECK_PIXELS] = {0}, direct[3 * CHECK_PIXELS] = {0};
    vit_status status = play(p, packed, c, VIT_VIEW_final, picture, why);
    if (status == VIT_OK)
        compare(c, picture, out);
    if (status == VIT_OK && parts) {
        status = play(p, packed, c, VIT_VIEW_direct, direct, why);
        if (status == VIT_OK)
            compare_parts(c, picture, direct, out);
    }
    return status;
}
