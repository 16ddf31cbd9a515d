#include "knobs.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define MOST_VALUES 8

/* What the numbers of a row do: a row has either texts or numbers. */
typedef enum knob_kind {
    KNOB_TEXTS,   /* values[].text: settings of the quality block */
    KNOB_PHOTONS, /* numbers: multiples of the default's photons */
    KNOB_RADIUS,  /* multiples of the default's radius */
    KNOB_SIZE,    /* multiples of the output's width and height */
    KNOB_LANES    /* samples a work-item */
} knob_kind;

typedef struct knob {
    const char *name; /* as --knobs takes it; of the setting in the quality block if it is there */
    const char *what;
    bool combined; /* also tried together with the others that are */
    knob_kind kind;
    struct {
        const char *label, *text; /* label: after the knob's name where it stands alone */
    } values[MOST_VALUES];        /* what matters most comes first */
    double numbers[MOST_VALUES];
} knob;

/* The one table of knobs. */
static const knob knobs[] = {
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
                {"bilinear", "texture_filter = \"bilinear\""}}},
    {"vertex_bits", "bits of each coordinate of a vertex", false, KNOB_TEXTS,
     .values = {{"16", "vertex_bits = 16"}, {"32", "vertex_bits = 32"}}},
    {"normal_bits", "bits of each of the two components of a vertex normal", false, KNOB_TEXTS,
     .values = {{"8", "normal_bits = 8"}, {"16", "normal_bits = 16"}}},
    {"sample_bits", "bits of each coordinate of a view sample", false, KNOB_TEXTS,
     .values = {{"16", "sample_bits = 16"}, {"32", "sample_bits = 32"}}},
    {"size", "output size, shown as large as the scene's", false, KNOB_SIZE, .numbers = {0.5, 0.75}},
    {"lanes", "samples a work-item: the same bits, another time", false, KNOB_LANES, .numbers = {1, 8, 16}},
};
enum { KNOBS = sizeof knobs / sizeof knobs[0], MOST_TRIED = 2 * MOST_VALUES };

static vit_status usage(vit_text *why, const char *name, int length) {
    int used = snprintf(why->text, sizeof why->text, "--knobs: there is no knob '%.*s', only", length > 60 ? 60 : length, name);
    for (int k = 0; k < KNOBS && used > 0 && (size_t)used < sizeof why->text; k++)
        used += snprintf(why->text + used, sizeof why->text - (size_t)used, "%s %s", k ? "," : "", knobs[k].name);
    return VIT_USAGE;
}

static vit_status select_knobs(const char *only, bool on[KNOBS], vit_text *why) {
    for (int k = 0; k < KNOBS; k++)
        on[k] = !only;
    while (only && *only) {
        const size_t length = strcspn(only, ",");
        int k = 0;
        while (k < KNOBS && (strlen(knobs[k].name) != length || strncmp(knobs[k].name, only, length) != 0))
            k++;
        if (k == KNOBS)
            return usage(why, only, (int)length);
        on[k] = true;
        only += length + (only[length] == ',');
    }
    return VIT_OK;
}

bool knobs_in_quality(const knob_setting *s) {
    return s->scale == 1.0 && s->lanes == 0;
}

void knobs_help(void) {
    for (int k = 0; k < KNOBS; k++)
        printf("  %-12s %s\n", knobs[k].name, knobs[k].what);
}

/* What a knob can be set to, for the scene at hand. */
typedef struct tried {
    int count;
    char label[MOST_TRIED][COST_NAME / 2];
    knob_setting set[MOST_TRIED];     /* the default with this knob alone turned */
    char text[MOST_TRIED][COST_NAME]; /* for the quality block; "": none */
} tried;

static bool same(const knob_setting *a, const knob_setting *b) {
    char text_a[SCENE_QUALITY], text_b[SCENE_QUALITY];
    scene_quality_text(&a->quality, text_a, sizeof text_a);
    scene_quality_text(&b->quality, text_b, sizeof text_b);
    return a->scale == b->scale && a->lanes == b->lanes && strcmp(text_a, text_b) == 0;
}

/* Adds a value unless it is the default's or there already. */
static vit_status try_value(const knob_setting *base, const knob *k, const char *label, const char *text, double number,
                            tried *t, vit_text *why) {
    knob_setting *s = &t->set[t->count];
    *s = *base;
    s->scale = k->kind == KNOB_SIZE ? number : base->scale;
    s->lanes = k->kind == KNOB_LANES ? (uint32_t)number : base->lanes;
    if (text[0] && scene_quality_apply(text, &s->quality, why) != VIT_OK)
        return VIT_BAD_INPUT;
    for (int i = 0; i < t->count; i++)
        if (same(s, &t->set[i]))
            return VIT_OK;
    if (same(s, base))
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

static vit_status try_values(const knobs_input *in, const knob_setting *base, const knob *k, tried *t, vit_text *why) {
    vit_status status = VIT_OK;
    t->count = 0;
    for (int i = 0; i < MOST_VALUES && k->numbers[i] > 0 && status == VIT_OK; i++) {
        char label[COST_NAME], text[COST_NAME];
        if (number_value(in, k, k->numbers[i], label, text, sizeof label))
            status = try_value(base, k, label, text, k->numbers[i], t, why);
    }
    for (int i = 0; i < MOST_VALUES && k->values[i].text && status == VIT_OK; i++)
        status = try_value(base, k, k->values[i].label, k->values[i].text, 0, t, why);
    return status;
}

/* The settings as they grow. */
typedef struct growing {
    knob_setting *settings;
    uint32_t count, most;
} growing;

static void add(growing *g, const knob_setting *s) {
    if (g->count >= g->most)
        return;
    for (uint32_t i = 0; i < g->count; i++)
        if (same(s, &g->settings[i]))
            return;
    g->settings[g->count++] = *s;
}

/* Every knob's first value counts before any knob's second one, should `most` not do for all. */
static void add_alone(growing *g, const tried t[KNOBS]) {
    int kept[KNOBS] = {0};
    uint32_t left = g->most - g->count;
    for (int i = 0; i < MOST_TRIED; i++)
        for (int k = 0; k < KNOBS; k++)
            if (i < t[k].count && left > 0) {
                kept[k]++;
                left--;
            }
    for (int k = 0; k < KNOBS; k++)
        for (int i = 0; i < kept[k]; i++) {
            knob_setting s = t[k].set[i];
            (void)snprintf(s.name, sizeof s.name, "%s %s", knobs[k].name, t[k].label[i]);
            (void)snprintf(s.knob, sizeof s.knob, "%s", knobs[k].name);
            add(g, &s);
        }
}

/* Number `at` of the product: digit 0 of a knob leaves it as it is, digit i is its value i - 1. */
static vit_status combine(const knob_setting *base, const tried t[KNOBS], uint64_t at, knob_setting *s, int *turned,
                          vit_text *why) {
    size_t used = 0;
    *s = *base;
    *turned = 0;
    s->name[0] = '\0';
    for (int k = 0; k < KNOBS; k++) {
        const uint64_t values = knobs[k].combined ? (uint64_t)t[k].count + 1 : 1, digit = at % values;
        at /= values;
        if (digit == 0)
            continue;
        if (scene_quality_apply(t[k].text[digit - 1], &s->quality, why) != VIT_OK)
            return VIT_BAD_INPUT;
        const int wrote =
            snprintf(s->name + used, sizeof s->name - used, "%s%s %s", used ? ", " : "", knobs[k].name, t[k].label[digit - 1]);
        used += wrote > 0 && used + (size_t)wrote < sizeof s->name ? (size_t)wrote : 0;
        ++*turned;
    }
    (void)snprintf(s->knob, sizeof s->knob, "several");
    return VIT_OK;
}

static uint64_t common_divisor(uint64_t a, uint64_t b) {
    while (b) {
        const uint64_t r = a % b;
        a = b;
        b = r;
    }
    return a;
}

/* Steps of about total / golden ratio, without a common divisor: every part of the walk is spread over the whole product. */
static vit_status add_combinations(growing *g, const knob_setting *base, const tried t[KNOBS], vit_text *why) {
    uint64_t total = 1, stride;
    for (int k = 0; k < KNOBS; k++)
        total *= knobs[k].combined ? (uint64_t)t[k].count + 1 : 1;
    stride = (uint64_t)((double)total * 0.6180339887498949);
    while (stride > 0 && common_divisor(total, stride) != 1)
        stride++;
    for (uint64_t i = 1; i < total && g->count < g->most; i++) {
        knob_setting s;
        int turned;
        vit_status status = combine(base, t, i * stride % total, &s, &turned, why);
        if (status != VIT_OK)
            return status;
        if (turned >= 2)
            add(g, &s);
    }
    return VIT_OK;
}

vit_status knobs_settings(const knobs_input *in, knob_setting **out, uint32_t *count, vit_text *why) {
    bool on[KNOBS];
    const knob_setting base = {.name = "default", .knob = "default", .quality = *in->base, .scale = 1.0};
    vit_status status = select_knobs(in->only, on, why);
    if (status != VIT_OK)
        return status;
    growing g = {.settings = calloc(in->most, sizeof *g.settings), .most = in->most};
    tried *t = calloc(KNOBS, sizeof *t);
    if (!g.settings || !t) {
        snprintf(why->text, sizeof why->text, "out of memory");
        status = VIT_FAILED;
    }
    for (int k = 0; k < KNOBS && status == VIT_OK; k++)
        if (on[k])
            status = try_values(in, &base, &knobs[k], &t[k], why);
    if (status == VIT_OK) {
        add(&g, &base);
        add_alone(&g, t);
        status = add_combinations(&g, &base, t, why);
    }
    free(t);
    if (status != VIT_OK) {
        free(g.settings);
        g.settings = NULL;
    }
    *out = g.settings;
    *count = g.count;
    return status;
}
