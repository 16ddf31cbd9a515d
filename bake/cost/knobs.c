/* The one table of knobs, and what its rows can be set to. */
#include "knob_parts.h"
#include "planner.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

#define SPECULAR (VIT_BIT(MIRROR) | VIT_BIT(GLASS))

const knob knob_table[] = {
    {"photons", "photon paths a frame: 1/4 to 4 times the scene's", true, KNOB_PHOTONS, .numbers = {0.25, 2.0, 0.5, 4.0}},
    {"radius", "photon radius, metres: 0.35 to 2 times the scene's, and \"auto\"", true, KNOB_RADIUS,
     .values = {{"auto", "radius = \"auto\""}}, .numbers = {0.5, 1.4, 0.7, 2.0, 0.35}},
    {"estimate", "each photon of a cluster (list), or buckets, interpolated or raw", true, KNOB_TEXTS,
     .values = {{"list", "estimate = \"list\"; smoothing = \"interpolated\""},
                {"buckets", "estimate = \"buckets\"; smoothing = \"interpolated\""},
                {"raw buckets", "estimate = \"buckets\"; smoothing = \"raw\""}}},
    {"kernel", "sphere, or flattened along the normal", true, KNOB_TEXTS,
     .values = {{"flattened", "kernel = \"flattened\""}, {"sphere", "kernel = \"sphere\""}}},
    {"zones", "baked zones of photons: by sight, by sight and light, off", true, KNOB_TEXTS,
     .values = {{"sight and light", "zones = true; light_zones = true"},
                {"sight", "zones = true; light_zones = false"},
                {"off", "zones = false; light_zones = false"}}},
    {"effective_area", "whether sums are divided by the kernel's baked area", true, KNOB_TEXTS,
     .values = {{"on", "effective_area = true"}, {"off", "effective_area = false"}}},
    {"bounce_sequence", "whether reflections follow a low-discrepancy sequence", false, KNOB_TEXTS,
     .values = {{"on", "bounce_sequence = true"}, {"off", "bounce_sequence = false"}}},
    {"indirect_samples", "indirect light at one view sample of so many, interpolated between them", true, KNOB_TEXTS,
     .values = {{"4", "indirect_samples = 4"}, {"16", "indirect_samples = 16"}, {"1", "indirect_samples = 1"}}},
    {"bounces", "hits of a photon path", false, KNOB_TEXTS,
     .values = {{"2", "bounces = 2"},
                {"3", "bounces = 3"},
                {"6", "bounces = 6"},
                {"4", "bounces = 4"},
                {"5", "bounces = 5"},
                {"8", "bounces = 8"}}},
    {"tile", "tile edge, pixels", false, KNOB_TEXTS,
     .values = {{"16", "tile = 16"}, {"64", "tile = 64"}, {"8", "tile = 8"}, {"32", "tile = 32"}}},
    {"normal_keys", "whether cluster keys hold the normal", false, KNOB_TEXTS,
     .values = {{"on", "normal_keys = true"}, {"off", "normal_keys = false"}}},
    {"texture_filter", "how textures are read", false, KNOB_TEXTS,
     .values = {{"nearest", "texture_filter = \"nearest\""},
                {"trilinear", "texture_filter = \"trilinear\""},
                {"bilinear", "texture_filter = \"bilinear\""}},
     .needs = VIT_BIT(TEXTURES)},
    {"antialias", "samples a pixel", true, KNOB_TEXTS,
     .values = {{"1", "antialias = 1"},
                {"4", "antialias = 4"},
                {"2", "antialias = 2"},
                {"8", "antialias = 8"},
                {"16", "antialias = 16"}},
     .needs = VIT_BIT(ANTIALIAS)},
    {"antialias_contrast", "how much a pixel must differ from a neighbour to take all its samples; 0: all do", true, KNOB_TEXTS,
     .values = {{"0", "antialias_contrast = 0.0"},
                {"0.12", "antialias_contrast = 0.12"},
                {"0.03", "antialias_contrast = 0.03"},
                {"0.25", "antialias_contrast = 0.25"},
                {"0.06", "antialias_contrast = 0.06"}},
     .needs = VIT_BIT(ANTIALIAS)},
    {"light_samples", "points on area lights that a view sample looks at", true, KNOB_TEXTS,
     .values = {{"4", "light_samples = 4"},
                {"64", "light_samples = 64"},
                {"8", "light_samples = 8"},
                {"32", "light_samples = 32"},
                {"1", "light_samples = 1"},
                {"16", "light_samples = 16"}},
     .needs = VIT_BIT(AREA_LIGHTS)},
    {"sky_samples", "directions to the sky that a view sample looks in", true, KNOB_TEXTS,
     .values = {{"4", "sky_samples = 4"},
                {"64", "sky_samples = 64"},
                {"8", "sky_samples = 8"},
                {"32", "sky_samples = 32"},
                {"1", "sky_samples = 1"},
                {"16", "sky_samples = 16"}},
     .needs = VIT_BIT(SKY_LIGHT)},
    {"specular_depth", "reflections and refractions of a view ray", false, KNOB_TEXTS,
     .values = {{"2", "specular_depth = 2"},
                {"4", "specular_depth = 4"},
                {"16", "specular_depth = 16"},
                {"1", "specular_depth = 1"},
                {"8", "specular_depth = 8"}},
     .needs = SPECULAR},
    {"caustics", "whether photons go on from mirrors and glass", false, KNOB_TEXTS,
     .values = {{"on", "caustics = true"}, {"off", "caustics = false"}}, .needs = SPECULAR},
    {"vertex_bits", "bits of each coordinate of a vertex", false, KNOB_TEXTS,
     .values = {{"16", "vertex_bits = 16"}, {"32", "vertex_bits = 32"}}},
    {"normal_bits", "bits of each of the two components of a vertex normal", false, KNOB_TEXTS,
     .values = {{"8", "normal_bits = 8"}, {"16", "normal_bits = 16"}}},
    {"sample_bits", "bits of each coordinate of a view sample", false, KNOB_TEXTS,
     .values = {{"16", "sample_bits = 16"}, {"32", "sample_bits = 32"}}},
    {"size", "output size, shown as large as the scene's", false, KNOB_SIZE, .numbers = {0.5, 0.75}},
    {"lanes", "samples a work-item: the same bits, another time", false, KNOB_LANES, .numbers = {1, 8, 16}},
};
enum { KNOBS = sizeof knob_table / sizeof knob_table[0] };
_Static_assert(KNOBS <= KNOBS_MOST, "raise KNOBS_MOST");
const int knob_count = KNOBS;

static vit_status usage(vit_text *why, const char *name, int length) {
    int used = snprintf(why->text, sizeof why->text, "--knobs: there is no knob '%.*s', only", length > 60 ? 60 : length, name);
    for (int k = 0; k < KNOBS && used > 0 && (size_t)used < sizeof why->text; k++)
        used += snprintf(why->text + used, sizeof why->text - (size_t)used, "%s %s", k ? "," : "", knob_table[k].name);
    return VIT_USAGE;
}

static vit_status select_knobs(const char *only, bool on[KNOBS], vit_text *why) {
    for (int k = 0; k < KNOBS; k++)
        on[k] = !only;
    while (only && *only) {
        const size_t length = strcspn(only, ",");
        int k = 0;
        while (k < KNOBS && (strlen(knob_table[k].name) != length || strncmp(knob_table[k].name, only, length) != 0))
            k++;
        if (k == KNOBS)
            return usage(why, only, (int)length);
        on[k] = true;
        only += length + (only[length] == ',');
    }
    return VIT_OK;
}

vit_status knobs_check(const char *only, vit_text *why) {
    bool on[KNOBS];
    return select_knobs(only, on, why);
}

bool knobs_in_quality(const knob_setting *s) {
    return s->scale == 1.0 && s->lanes == 0;
}

void knobs_help(void) {
    for (int k = 0; k < KNOBS; k++)
        printf("  %-18s %s\n", knob_table[k].name, knob_table[k].what);
}

/* As scene_quality_text(), without what has no effect. */
static void text_of_effect(const scene_quality *q, char *text, size_t size) {
    scene_quality plain = *q;
    if (plan_leaves_area_out(q))
        plain.effective_area = false;
    if (q->antialias == 1)
        plain.antialias_contrast = 0;
    scene_quality_text(&plain, text, size);
}

bool knob_same(const knob_setting *a, const knob_setting *b) {
    char text_a[SCENE_QUALITY], text_b[SCENE_QUALITY];
    text_of_effect(&a->quality, text_a, sizeof text_a);
    text_of_effect(&b->quality, text_b, sizeof text_b);
    return a->scale == b->scale && a->lanes == b->lanes && strcmp(text_a, text_b) == 0;
}

/* Adds a value unless it is the default's or there already. */
static vit_status try_value(const knob_setting *base, const knob *k, const char *label, const char *text, double number,
                            knob_values *t, vit_text *why) {
    knob_setting *s = &t->set[t->count];
    *s = *base;
    s->scale = k->kind == KNOB_SIZE ? number : base->scale;
    s->lanes = k->kind == KNOB_LANES ? (uint32_t)number : base->lanes;
    if (text[0] && scene_quality_apply(text, &s->quality, why) != VIT_OK)
        return VIT_BAD_INPUT;
    for (int i = 0; i < t->count; i++)
        if (knob_same(s, &t->set[i]))
            return VIT_OK;
    if (knob_same(s, base))
        return VIT_OK;
    (void)snprintf(t->label[t->count], sizeof t->label[0], "%s", label);
    (void)snprintf(t->text[t->count], sizeof t->text[0], "%s", text);
    t->count++;
    return VIT_OK;
}

/* A number of the row as label and text; false: the scene has nothing that it could be a multiple of. */
static bool number_value(const knobs_input *in, const knob *k, double number, char *label, char *text, size_t room) {
    text[0] = '\0';
    switch (k->kind) {
    case KNOB_PHOTONS:
        number = fmin(round(in->base->photons * number), 1000000);
        (void)snprintf(text, room, "photons = %.0f", number);
        break;
    case KNOB_RADIUS:
        number *= in->radius;
        (void)snprintf(text, room, "radius = %.3g", number);
        break;
    case KNOB_SIZE:
    case KNOB_LANES:
    case KNOB_TEXTS:
        break;
    }
    (void)snprintf(label, room, k->kind == KNOB_RADIUS ? "%.3g" : "%.6g", number);
    return number > 0;
}

static vit_status try_values(const knobs_input *in, const knob_setting *base, const knob *k, knob_values *t, vit_text *why) {
    vit_status status = VIT_OK;
    t->count = 0;
    if ((k->needs && !(k->needs & in->effects)) || (in->in_quality && (k->kind == KNOB_SIZE || k->kind == KNOB_LANES)))
        return VIT_OK;
    for (int i = 0; i < MOST_VALUES && k->numbers[i] > 0 && status == VIT_OK; i++) {
        char label[COST_NAME], text[COST_NAME];
        if (number_value(in, k, k->numbers[i], label, text, sizeof label))
            status = try_value(base, k, label, text, k->numbers[i], t, why);
    }
    for (int i = 0; i < MOST_VALUES && k->values[i].text && status == VIT_OK; i++)
        status = try_value(base, k, k->values[i].label, k->values[i].text, 0, t, why);
    return status;
}

vit_status knob_find_values(const knobs_input *in, const knob_setting *base, knob_values *values, vit_text *why) {
    bool on[KNOBS];
    vit_status status = select_knobs(in->only, on, why);
    for (int k = 0; k < KNOBS && status == VIT_OK; k++)
        if (on[k])
            status = try_values(in, base, &knob_table[k], &values[k], why);
    return status;
}
