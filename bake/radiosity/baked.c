#include "radiosity/baked.h"
#include "common/fail.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define LEAST_RECEIVERS 4096.0 /* at a spacing of LEAST_SPACING pixels, as many more as that is closer: in small pictures */
#define LEAST_SPACING 16.0     /* pixels say little about where light changes */
#define MOST_RECEIVERS 196608u
#define MOST_RECORDS 49152u
#define CELLS_PER_RECEIVER 4u /* of surfaces that light comes from, about */
#define CELLS_LEAST 8192u
#define CELLS_MOST 65536u
#define BOUNCE_RAYS 4u /* a receiver has so many for one of a cell, about, */
#define BOUNCE_LEAST 4u
#define LOOKS 0.75       /* and for so many looks at lights of a cell */
#define NOISY 0.5        /* of the light there, that a receiver's deviation is at the first look by USUAL_RAYS, from which on */
#define NOISY_SHARE 0.05 /* of the receivers make the scene one that light gets about in by small gaps, */
#define MORE_RAYS 4u     /* and rays so many times as many, where receivers at the first look times that are at most */
#define MORE_MOST 49152u
#define DIM 0.1 /* of the logarithmic mean of all: less light counts as so much */
#define USUAL_RAYS 512.0
#define FEWER 4u        /* rays and cells of the first look, which tells where receivers must be near each other */
#define FIRST_LOOK 0.13 /* share of the time, about, of each look that tells where receivers must be near each other */
#define LIVE_STATES 64u /* of all lights that are live, at which the first look asks for their light, about */

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

/* Keeps at most so many of a light's knots, evenly: where nothing is baked of it they need not be near each other. */
static void thin(basis_knots *k, uint32_t most) {
    const uint32_t count = k->count;
    for (uint32_t i = 0; i < most && count > most; i++)
        k->frame[i] = k->frame[(uint64_t)i * count / most];
    k->count = count < most ? count : most;
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
        if (in->live && status == VIT_OK)
            thin(&s->knots[i], in->moving_count < LIVE_STATES ? LIVE_STATES / in->moving_count : 1);
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

static uint32_t baked_lights(const baked_input *in) {
    return in->live ? 0 : in->moving_count;
}

/* As sections have it. */
static vit_status keep(const baked_input *in, const states *s, const float *irradiance, baked *out, vit_text *why) {
    const uint32_t columns = 3 * s->count, count = out->receivers.count,
                   padded = (count + VIT_BASIS_GROUP - 1) / VIT_BASIS_GROUP * VIT_BASIS_GROUP;
    out->still = calloc(padded + 1u, sizeof *out->still);
    out->lights = baked_lights(in);
    out->frames = malloc(((size_t)in->frames * out->lights + 1u) * sizeof *out->frames);
    if (!out->still || !out->frames) {
        bake_fail(why, VIT_FAILED, "indirect light: out of memory");
        return VIT_FAILED;
    }
    for (uint32_t r = 0; r < count; r++)
        memcpy(out->still[r].irradiance, irradiance + (size_t)r * columns, sizeof out->still[r].irradiance);
    for (uint32_t f = 0; f < in->frames; f++)
        for (uint32_t l = 0; l < out->lights; l++)
            out->frames[(size_t)f * out->lights + l] = s->knots[l].place[f];
    const basis_input b = {.irradiance = irradiance,
                           .receivers = count,
                           .columns = columns,
                           .first = s->first,
                           .knots = s->counts,
                           .lights = out->lights,
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
    const uint32_t live_states = 1u + (moving_count > LIVE_STATES ? moving_count : LIVE_STATES);
    out->receivers = MOST_RECEIVERS;
    out->bytes = 3.0 * sizeof(float) * MOST_RECEIVERS * out->states;
    out->live_bytes = 3.0 * sizeof(float) * MOST_RECEIVERS * (live_states < out->states ? live_states : out->states);
    return VIT_OK;
}

typedef struct finding {
    const baked_input *in;
    const states *states;
    transport_report report;
    int looks;     /* of VIT_RECEIVER_LEVELS, that are over or under way */
    uint32_t more; /* times as many rays as stated */
} finding;

static void first_step(void *user, double done) {
    const finding *f = user;
    f->in->progress(f->in->user, (f->looks - 1 + done) * FIRST_LOOK);
}

static void second_step(void *user, double done) {
    const finding *f = user;
    const double looks = FIRST_LOOK * VIT_RECEIVER_LEVELS;
    f->in->progress(f->in->user, looks + done * (1.0 - looks));
}

/* Light of the records: records x columns. Without lights there is none. fewer: by how much rays and cells are fewer. */
static vit_status find(finding *f, const receiver *records, uint32_t count, uint32_t fewer, const transport_light *out,
                       vit_text *why) {
    const baked_input *in = f->in;
    uint32_t lights = 0, of_light = CELLS_PER_RECEIVER * count;
    of_light = (of_light < CELLS_LEAST ? CELLS_LEAST : of_light < CELLS_MOST ? of_light : CELLS_MOST) / fewer;
    of_light = of_light > CELLS_LEAST ? of_light : CELLS_LEAST;
    const uint32_t rays = in->receiver_rays * f->more, bounces = rays / BOUNCE_RAYS / fewer;
    const transport_input t = {.rays = in->rays,
                               .geometry = in->geometry,
                               .receivers = records,
                               .receiver_count = count,
                               .states = f->states->state,
                               .state_count = f->states->count,
                               .reflections = in->reflections,
                               .cells = of_light,
                               .receiver_rays = rays > fewer ? rays / fewer : 1,
                               .bounce_rays = of_light * (bounces > BOUNCE_LEAST ? bounces : BOUNCE_LEAST),
                               .looks = (double)in->receiver_rays * LOOKS,
                               .panes = in->panes,
                               .threads = in->threads,
                               .progress = !in->progress ? NULL
                                           : fewer > 1   ? first_step
                                                         : second_step,
                               .user = f};
    for (uint32_t i = 0; i < t.state_count; i++)
        lights += t.states[i].count;
    memset(out->irradiance, 0, (size_t)count * 3u * t.state_count * sizeof *out->irradiance);
    if (out->noise)
        memset(out->noise, 0, count * sizeof *out->noise);
    return lights > 0 ? transport_find(&t, out, &f->report, why) : VIT_OK;
}

static bool is_asked(const receiver *r) {
    return r->asked && !r->follows;
}

/* Light of receivers that are asked, and of those that follow them: receivers x columns. */
static vit_status find_all(finding *f, const receivers *r, uint32_t fewer, const transport_light *out, vit_text *why) {
    const uint32_t columns = 3 * f->states->count;
    uint32_t count = 0;
    receiver *records = malloc((r->count + 1u) * sizeof *records);
    if (!records)
        return bake_fail(why, VIT_FAILED, "indirect light: out of memory");
    for (uint32_t i = 0; i < r->count; i++)
        if (is_asked(r->receivers + i))
            records[count++] = r->receivers[i];
    const vit_status status = find(f, records, count, fewer, out, why);
    free(records);
    for (uint32_t i = r->count; i-- > 0 && status == VIT_OK;)
        if (is_asked(r->receivers + i)) {
            memmove(out->irradiance + (size_t)i * columns, out->irradiance + (size_t)--count * columns,
                    columns * sizeof *out->irradiance);
            out->noise[i] = out->noise[count];
        } else {
            memset(out->irradiance + (size_t)i * columns, 0, columns * sizeof *out->irradiance);
            out->noise[i] = 0.0f;
        }
    if (status == VIT_OK && !receivers_pool_noise(r, out->noise))
        return bake_fail(why, VIT_FAILED, "indirect light: out of memory");
    if (status == VIT_OK)
        receivers_follow(r, out->irradiance, columns);
    if (status == VIT_OK)
        receivers_follow(r, out->noise, 1);
    return status;
}

/* A receiver's light, all columns. */
static double light_of(const float *irradiance, uint32_t index, uint32_t columns) {
    double sum = 0.0;
    for (uint32_t c = 0; c < columns; c++)
        sum += (double)irradiance[(size_t)index * columns + c];
    return sum;
}

/* How many times as many rays the scene calls for, by the first look. */
static uint32_t more_rays(const finding *f, const receivers *r, const transport_light *found) {
    const uint32_t columns = 3 * f->states->count;
    const double limit = NOISY * sqrt(USUAL_RAYS / (double)f->in->receiver_rays);
    double logarithms = 0.0;
    uint32_t lit = 0, asked = 0, noisy = 0;
    for (uint32_t i = 0; i < r->count; i++) {
        const double light = is_asked(r->receivers + i) ? light_of(found->irradiance, i, columns) : 0.0;
        asked += is_asked(r->receivers + i);
        logarithms += light > 0.0 ? log(light) : 0.0;
        lit += light > 0.0;
    }
    const double dim = lit > 0 ? DIM * exp(logarithms / lit) : 0.0;
    for (uint32_t i = 0; i < r->count; i++)
        noisy +=
            is_asked(r->receivers + i) && (double)found->noise[i] > limit * (light_of(found->irradiance, i, columns) + dim);
    uint32_t more = noisy > NOISY_SHARE * asked ? MORE_RAYS : 1;
    while (more > 1 && (uint64_t)more * asked > MORE_MOST)
        more /= 2;
    return more;
}

/* receivers_input.look */
static vit_status look_first(void *user, const receivers *r, float *irradiance, float *noise, vit_text *why) {
    finding *f = user;
    const transport_light light = {irradiance, noise};
    f->looks++;
    vit_status status = find_all(f, r, FEWER, &light, why);
    if (status == VIT_OK && f->looks == 1 && (f->more = more_rays(f, r, &light)) > 1)
        status = find_all(f, r, FEWER, &light, why);
    return status;
}

static vit_status look_again(finding *f, baked *out, vit_text *why) {
    states s = *f->states;
    s.count = f->in->live ? 1 : s.count;
    const uint32_t columns = 3 * s.count;
    const receivers *r = &out->receivers;
    const transport_light light = {malloc(((size_t)r->count * columns + 1u) * sizeof *light.irradiance),
                                   malloc((r->count + 1u) * sizeof *light.noise)};
    finding again = {.in = f->in, .states = &s, .more = f->more};
    vit_status status = light.irradiance && light.noise ? find_all(&again, r, 1, &light, why) : VIT_FAILED;
    if (!light.irradiance || !light.noise ||
        (status == VIT_OK && !receivers_smooth(r, light.irradiance, light.noise, columns, f->in->threads)))
        status = bake_fail(why, VIT_FAILED, "indirect light: out of memory");
    out->report = again.report;
    out->more_rays = f->more;
    if (status == VIT_OK && light.irradiance) /* bake_fail() fails */
        status = keep(f->in, &s, light.irradiance, out, why);
    free(light.irradiance);
    free(light.noise);
    free(out->receivers.followers); /* they have said all */
    out->receivers.followers = NULL;
    out->receivers.follower_count = 0;
    return status;
}

/* basis_points_input.light */
static vit_status look_at_places(void *user, const receiver *places, uint32_t count, bool rough, const transport_light *out,
                                 vit_text *why) {
    finding *f = user;
    f->looks = rough ? 1 : VIT_RECEIVER_LEVELS;
    return find(f, places, count, rough ? FEWER : 1, out, why);
}

static vit_status find_points(finding *f, baked *out, vit_text *why) {
    const baked_input *in = f->in;
    const basis_points_input p = {.seen = {.rays = in->rays,
                                           .tracks = in->tracks,
                                           .frames = in->frames,
                                           .width = in->width,
                                           .height = in->height,
                                           .threads = in->threads},
                                  .spacing = in->point_spacing,
                                  .most = MOST_RECORDS,
                                  .columns = 3 * f->states->count,
                                  .light = look_at_places,
                                  .user = f};
    float *irradiance;
    vit_status status = basis_points_find(&p, &out->points, &irradiance, why);
    out->receivers.count = out->points.count;
    out->report = f->report;
    if (status == VIT_OK)
        status = keep(in, f->states, irradiance, out, why);
    out->placed = 0;
    free(irradiance);
    return status;
}

static vit_status find_receivers(finding *f, baked *out, vit_text *why) {
    const baked_input *in = f->in;
    const double closer = LEAST_SPACING / in->spacing;
    const receivers_input place = {.rays = in->rays,
                                   .geometry = in->geometry,
                                   .tracks = in->tracks,
                                   .frames = in->frames,
                                   .width = in->width,
                                   .height = in->height,
                                   .size = (float)in->size,
                                   .within = in->within,
                                   .spacing = (float)in->spacing,
                                   .least = (uint32_t)(LEAST_RECEIVERS * closer * closer),
                                   .most = MOST_RECEIVERS,
                                   .records = MOST_RECORDS,
                                   .threads = in->threads,
                                   .look = look_first,
                                   .user = f,
                                   .columns = 3 * f->states->count};
    const vit_status status = receivers_place(&place, &out->receivers, why);
    return status == VIT_OK ? look_again(f, out, why) : status;
}

vit_status baked_find(const baked_input *in, baked *out, vit_text *why) {
    *out = (baked){0};
    states s = {0};
    finding f = {.in = in, .states = &s, .more = 1};
    vit_status status = make_states(in, &s, why);
    if (status == VIT_OK)
        status = in->points ? find_points(&f, out, why) : find_receivers(&f, out, why);
    drop_states(&s, in->moving_count);
    if (status != VIT_OK)
        baked_free(out);
    return status;
}

void baked_free(baked *b) {
    receivers_free(&b->receivers);
    basis_points_free(&b->points);
    basis_free(&b->basis);
    free(b->still);
    free(b->frames);
    *b = (baked){0};
}
