#include "radiosity/baked.h"
#include "common/fail.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define MOST_RECEIVERS 196608u
#define CELLS_PER_RECEIVER 4u /* of surfaces that light comes from, about */
#define CELLS_LEAST 8192u
#define CELLS_MOST 65536u
#define BOUNCE_RAYS 128u /* per cell, about */

/* States of the lights: what stays first, then each moving light at its knots, with an intensity of 1. */
typedef struct states {
    basis_knots *knots; /* a moving light */
    transport_state *state;
    photons_light *light; /* of the states after the first */
    uint32_t count;
    uint32_t *first, *counts; /* a moving light: its first column beside the first state's, its knots */
} states;

static void drop_states(states *s, uint32_t moving) {
    for (uint32_t i = 0; s->knots && i < moving; i++)
        basis_knots_free(&s->knots[i]);
    free(s->knots);
    free(s->state);
    free(s->light);
    free(s->first);
    free(s->counts);
}

static vit_status make_states(const baked_input *in, states *s, vit_text *why) {
    s->knots = calloc(in->moving_count + 1u, sizeof *s->knots);
    s->first = calloc(in->moving_count + 1u, sizeof *s->first);
    s->counts = calloc(in->moving_count + 1u, sizeof *s->counts);
    vit_status status = VIT_OK;
    if (!s->knots || !s->first || !s->counts) {
        bake_fail(why, VIT_FAILED, "indirect light: out of memory");
        return VIT_FAILED;
    }
    s->count = 1;
    for (uint32_t i = 0; i < in->moving_count && status == VIT_OK; i++) {
        status = basis_knots_find(in->tracks, in->frames, in->moving[i], in->size, &s->knots[i], why);
        s->first[i] = 3 * s->count;
        s->counts[i] = s->knots[i].count;
        s->count += s->knots[i].count;
    }
    if (status != VIT_OK)
        return status;
    s->state = calloc(s->count, sizeof *s->state);
    s->light = calloc(s->count, sizeof *s->light);
    if (!s->state || !s->light) {
        bake_fail(why, VIT_FAILED, "indirect light: out of memory");
        return VIT_FAILED;
    }
    s->state[0] = (transport_state){in->still, in->still_count};
    for (uint32_t i = 0, n = 1; i < in->moving_count; i++)
        for (uint32_t k = 0; k < s->knots[i].count; k++, n++) {
            s->light[n].light = in->tracks->lights[(size_t)s->knots[i].frame[k] * in->tracks->light_count + in->moving[i]];
            for (int c = 0; c < 3; c++)
                s->light[n].light.intensity[c] = 1.0f;
            s->state[n] = (transport_state){&s->light[n], 1};
        }
    return VIT_OK;
}

/* As sections have it. */
static vit_status keep(const baked_input *in, const states *s, const float *irradiance, baked *out, vit_text *why) {
    const uint32_t columns = 3 * s->count, count = out->receivers.count,
                   padded = (count + VIT_BASIS_GROUP - 1) / VIT_BASIS_GROUP * VIT_BASIS_GROUP;
    out->still = calloc(padded, sizeof *out->still);
    out->frames = malloc(((size_t)in->frames * in->moving_count + 1u) * sizeof *out->frames);
    out->lights = in->moving_count;
    if (!out->still || !out->frames) {
        bake_fail(why, VIT_FAILED, "indirect light: out of memory");
        return VIT_FAILED;
    }
    for (uint32_t r = 0; r < count; r++)
        memcpy(out->still[r].irradiance, irradiance + (size_t)r * columns, sizeof out->still[r].irradiance);
    for (uint32_t f = 0; f < in->frames; f++)
        for (uint32_t l = 0; l < in->moving_count; l++)
            out->frames[(size_t)f * in->moving_count + l] = s->knots[l].place[f];
    const basis_input b = {.irradiance = irradiance,
                           .receivers = count,
                           .columns = columns,
                           .first = s->first,
                           .knots = s->counts,
                           .lights = in->moving_count,
                           .error = in->error,
                           .threads = in->threads};
    out->placed = count;
    out->receivers.count = padded;
    return basis_make(&b, &out->basis, why);
}

vit_status baked_foresee(const tracks *t, uint32_t frames, const uint32_t *moving, uint32_t moving_count, double size,
                         baked_foreseen *out, vit_text *why) {
    *out = (baked_foreseen){.states = 1};
    for (uint32_t i = 0; i < moving_count; i++) {
        basis_knots k;
        const vit_status status = basis_knots_find(t, frames, moving[i], size, &k, why);
        if (status != VIT_OK)
            return status;
        out->states += k.count;
        out->widest = fmax(out->widest, k.widest);
        basis_knots_free(&k);
    }
    out->bytes = 3.0 * sizeof(float) * MOST_RECEIVERS * out->states;
    return VIT_OK;
}

vit_status baked_find(const baked_input *in, baked *out, vit_text *why) {
    *out = (baked){0};
    states s = {0};
    float *irradiance = NULL;
    const receivers_input place = {.rays = in->rays,
                                   .geometry = in->geometry,
                                   .tracks = in->tracks,
                                   .frames = in->frames,
                                   .width = in->width,
                                   .height = in->height,
                                   .size = (float)in->size,
                                   .within = in->within,
                                   .spacing = (float)in->spacing,
                                   .most = MOST_RECEIVERS,
                                   .threads = in->threads};
    vit_status status = receivers_place(&place, &out->receivers, why);
    if (status == VIT_OK)
        status = make_states(in, &s, why);
    if (status == VIT_OK) {
        irradiance = calloc((size_t)out->receivers.count * 3u * s.count + 1u, sizeof *irradiance);
        const uint32_t wanted = CELLS_PER_RECEIVER * out->receivers.count, of_light = wanted < CELLS_LEAST  ? CELLS_LEAST
                                                                                      : wanted > CELLS_MOST ? CELLS_MOST
                                                                                                            : wanted;
        const transport_input t = {.rays = in->rays,
                                   .geometry = in->geometry,
                                   .receivers = out->receivers.receivers,
                                   .receiver_count = out->receivers.count,
                                   .states = s.state,
                                   .state_count = s.count,
                                   .reflections = in->reflections,
                                   .cells = of_light,
                                   .receiver_rays = in->receiver_rays,
                                   .bounce_rays = of_light * BOUNCE_RAYS,
                                   .panes = in->panes,
                                   .threads = in->threads,
                                   .progress = in->progress,
                                   .user = in->user};
        if (!irradiance)
            status = bake_fail(why, VIT_FAILED, "indirect light: out of memory");
        else if (in->still_count + in->moving_count > 0)
            status = transport_find(&t, irradiance, &out->report, why);
    }
    if (status == VIT_OK && irradiance)
        status = keep(in, &s, irradiance, out, why);
    free(irradiance);
    drop_states(&s, in->moving_count);
    if (status != VIT_OK)
        baked_free(out);
    return status;
}

void baked_free(baked *b) {
    receivers_free(&b->receivers);
    basis_free(&b->basis);
    free(b->still);
    free(b->frames);
    *b = (baked){0};
}
