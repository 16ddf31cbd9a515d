/* Settings made from the table: each knob alone, combinations, and what lies beside a setting. */
#include "cost/knob_parts.h"
#include "common/fail.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void add(knob_list *l, const knob_setting *s) {
    if (l->count >= l->most)
        return;
    for (uint32_t i = 0; i < l->count; i++)
        if (knob_same(s, &l->settings[i]))
            return;
    l->settings[l->count++] = *s;
}

/* Every knob's first value counts before any knob's second one, should `most` not do for all. */
static void add_alone(knob_list *l) {
    int kept[KNOBS_MOST] = {0};
    uint32_t left = l->most - l->count;
    for (int i = 0; i < MOST_TRIED; i++)
        for (int k = 0; k < KNOBS; k++)
            if (i < l->values[k].count && left > 0) {
                kept[k]++;
                left--;
            }
    for (int k = 0; k < KNOBS; k++)
        for (int i = 0; i < kept[k]; i++) {
            knob_setting s = l->values[k].set[i];
            (void)snprintf(s.name, sizeof s.name, "%s %s", knob_name(k), l->values[k].label[i]);
            (void)snprintf(s.knob, sizeof s.knob, "%s", knob_name(k));
            s.digit[k] = (uint8_t)(i + 1);
            add(l, &s);
        }
}

/* Adds the setting whose combined knobs stand at `digit`: 0 leaves a knob as it is, i is its value i - 1. */
static vit_status add_combined(knob_list *l, const uint8_t digit[KNOBS_MOST], vit_text *why) {
    knob_setting s = l->base;
    size_t used = 0;
    int turned = 0, last = 0;
    s.name[0] = '\0';
    for (int k = 0; k < KNOBS; k++) {
        if (!knob_combined(k) || digit[k] == 0)
            continue;
        if (scene_quality_apply(l->values[k].text[digit[k] - 1], &s.quality, why) != VIT_OK)
            return VIT_BAD_INPUT;
        const int wrote = snprintf(s.name + used, sizeof s.name - used, "%s%s %s", used ? ", " : "", knob_name(k),
                                   l->values[k].label[digit[k] - 1]);
        used = wrote > 0 && used + (size_t)wrote < sizeof s.name ? used + (size_t)wrote : sizeof s.name - 1;
        s.digit[k] = digit[k];
        last = k;
        turned++;
    }
    (void)snprintf(s.knob, sizeof s.knob, "%s", turned > 1 ? "several" : turned ? knob_name(last) : "default");
    if (used == sizeof s.name - 1) /* cut off: its number tells it from the like */
        (void)snprintf(s.name + sizeof s.name - 8, 8, " #%u", l->count);
    add(l, &s);
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
vit_status knobs_spread(knob_list *l, uint32_t upto, vit_text *why) {
    uint64_t total = 1, stride;
    for (int k = 0; k < KNOBS; k++)
        total *= knob_combined(k) ? (uint64_t)l->values[k].count + 1 : 1;
    stride = (uint64_t)((double)total * 0.6180339887498949);
    while (stride > 0 && common_divisor(total, stride) != 1)
        stride++;
    for (uint64_t i = 1; i < total && l->count < upto; i++) {
        uint64_t at = i * stride % total;
        uint8_t digit[KNOBS_MOST] = {0};
        int turned = 0;
        for (int k = 0; k < KNOBS; k++) {
            const uint64_t values = knob_combined(k) ? (uint64_t)l->values[k].count + 1 : 1;
            digit[k] = (uint8_t)(at % values);
            at /= values;
            turned += digit[k] > 0;
        }
        vit_status status = turned >= 2 ? add_combined(l, digit, why) : VIT_OK;
        if (status != VIT_OK)
            return status;
    }
    return VIT_OK;
}

bool knobs_beside(knob_list *l, uint32_t of, uint32_t step, vit_status *status, vit_text *why) {
    uint8_t digit[KNOBS_MOST];
    memcpy(digit, l->settings[of].digit, sizeof digit);
    for (int k = 0; k < KNOBS; k++) {
        const uint32_t values = knob_combined(k) && l->values[k].count > 0 ? (uint32_t)l->values[k].count + 1 : 0;
        if (step < values) {
            digit[k] = (uint8_t)step;
            *status = add_combined(l, digit, why);
            return true;
        }
        step -= values;
    }
    return false;
}

vit_status knobs_open(const knobs_input *in, knob_list *out, vit_text *why) {
    *out = (knob_list){.base = {.name = "default", .knob = "default", .quality = *in->base, .scale = 1.0}, .most = in->most};
    out->settings = calloc(in->most, sizeof *out->settings);
    out->values = calloc((size_t)KNOBS, sizeof *out->values);
    if (!out->settings || !out->values) {
        knobs_close(out);
        return bake_fail(why, VIT_FAILED, "out of memory");
    }
    const vit_status status = knob_find_values(in, &out->base, out->values, why);
    if (status != VIT_OK) {
        knobs_close(out);
        return status;
    }
    add(out, &out->base);
    add_alone(out);
    return VIT_OK;
}

void knobs_close(knob_list *l) {
    free(l->settings);
    free(l->values);
    *l = (knob_list){0};
}
