/* What can be turned, and what it can be set to for the scene at hand. */
#include "cost/knob_parts.h"
#include "common/fail.h"
#include "pack/planner.h"
#include "scene/setting_rows.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* The knobs beyond the quality block. */
static const struct {
    const char *name, *what, *tried;
} own[] = {
    [KNOB_SIZE - SETTINGS] = {"size", "output size, shown as large as the scene's", "x0.5 | x0.75"},
    [KNOB_LANES - SETTINGS] = {"lanes", "samples a work-item: the same bits, another time", "1 | 8 | 16"},
};

static const char *knob_tried(int k) {
    return k < SETTINGS ? setting_rows[k].tried : own[k - SETTINGS].tried;
}

const char *knob_name(int k) {
    return k >= SETTINGS ? own[k - SETTINGS].name : setting_rows[k].tried ? setting_rows[k].field.name : NULL;
}

bool knob_combined(int k) {
    return k < SETTINGS && setting_rows[k].tried && (setting_rows[k].marks & SETTING_TOGETHER);
}

static vit_status usage(vit_text *why, const char *name, int length) {
    int used = snprintf(why->text, sizeof why->text, "--knobs: there is no knob '%.*s', only", length > 60 ? 60 : length, name);
    for (int k = 0, first = 1; k < KNOBS && used > 0 && (size_t)used < sizeof why->text; k++)
        if (knob_name(k)) {
            used += snprintf(why->text + used, sizeof why->text - (size_t)used, "%s %s", first ? "" : ",", knob_name(k));
            first = 0;
        }
    return VIT_USAGE;
}

static vit_status select_knobs(const char *only, bool on[KNOBS], vit_text *why) {
    for (int k = 0; k < KNOBS; k++)
        on[k] = !only && knob_name(k);
    while (only && *only) {
        const size_t length = strcspn(only, ",");
        int k = 0;
        while (k < KNOBS && (!knob_name(k) || strlen(knob_name(k)) != length || strncmp(knob_name(k), only, length) != 0))
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
        if (knob_name(k))
            printf("  %-18s %s\n", knob_name(k), k < SETTINGS ? setting_rows[k].help : own[k - SETTINGS].what);
}

/* Is a setting one of makers of indirect light, none of which is in `effects`? */
static bool is_others(int k, uint64_t effects) {
    const uint64_t needs = k < SETTINGS ? setting_rows[k].needs : 0;
    return needs != 0 && !(needs & ~vit_indirect_makers()) && !(needs & effects);
}

/* As scene_quality_text(), without what has no effect. */
static void text_of_effect(const scene_quality *q, char *text, size_t size) {
    const uint64_t maker = q->indirect == INDIRECT_BASIS       ? VIT_BIT(BASIS)
                           : q->indirect == INDIRECT_RADIOSITY ? VIT_BIT(RADIOSITY)
                                                               : VIT_BIT(PHOTONS);
    scene_quality plain = *q;
    size_t used = 0;
    if (plan_leaves_area_out(q))
        plain.effective_area = false;
    if (q->antialias == 1)
        plain.antialias_contrast = 0;
    text[0] = '\0';
    for (int i = 0; i < SETTINGS; i++)
        if (!is_others(i, maker) && (i != SETTING_AT_flatten || q->flattened))
            used += fields_write(&setting_rows[i].field, &plain, text + used, size - used);
}

void knobs_idle(const knobs_input *in, char *text, size_t room) {
    bool on[KNOBS];
    vit_text why;
    size_t used = 0;
    text[0] = '\0';
    if (select_knobs(in->only, on, &why) != VIT_OK)
        return;
    for (int k = 0; k < KNOBS && used < room; k++)
        if (on[k] && is_others(k, in->effects))
            used += (size_t)snprintf(text + used, room - used, "%s%s", used ? ", " : "", knob_name(k));
}

bool knob_same(const knob_setting *a, const knob_setting *b) {
    char text_a[SCENE_QUALITY], text_b[SCENE_QUALITY];
    text_of_effect(&a->quality, text_a, sizeof text_a);
    text_of_effect(&b->quality, text_b, sizeof text_b);
    return a->scale == b->scale && a->lanes == b->lanes && strcmp(text_a, text_b) == 0;
}

/* Adds *s unless it is the default or there already. text: what it changes in the quality block. */
static void add_value(const knob_setting *base, const knob_setting *s, const char *label, const char *text, knob_values *t) {
    for (int i = 0; i < t->count; i++)
        if (knob_same(s, &t->set[i]))
            return;
    if (knob_same(s, base))
        return;
    t->set[t->count] = *s;
    (void)snprintf(t->label[t->count], sizeof t->label[0], "%s", label);
    (void)snprintf(t->text[t->count], sizeof t->text[0], "%s", text);
    t->count++;
}

/* The value "x0.5" of what the scene has, as an option would have it: whole paths, three digits of a radius. False: it has
 * none. */
static bool multiple(const knobs_input *in, int k, const char *value, char *out, size_t room) {
    const double factor = strtod(value + 1, NULL);
    if (k == SETTING_AT_photons)
        (void)snprintf(out, room, "%.0f", fmin(round(in->base->photons * factor), 1000000));
    else if (k == SETTING_AT_radius)
        (void)snprintf(out, room, "%.3g", in->radius * factor);
    else
        return false;
    return strtod(out, NULL) > 0;
}

/* One word of a value, put into *s and written behind *used bytes of text. */
static bool put_word(const setting_row *row, const char *value, knob_setting *s, char *text, size_t room, size_t *used) {
    if (!settings_put(row, value, &s->quality))
        return false;
    *used += fields_write(&row->field, &s->quality, text + *used, room - *used);
    return true;
}

/* A value of `tried`: "[label: ]value[, word value]..." */
static vit_status try_value(const knobs_input *in, const knob_setting *base, int k, char *value, knob_values *t,
                            vit_text *why) {
    knob_setting s = *base;
    char number[COST_NAME], text[COST_NAME] = "", *colon = strstr(value, ": ");
    const char *label = value;
    size_t used = 0;
    if (colon) {
        *colon = '\0';
        value = colon + 2;
    }
    if (k == KNOB_SIZE || k == KNOB_LANES) {
        const double of = strtod(value + (*value == 'x'), NULL);
        s.scale = k == KNOB_SIZE ? of : s.scale;
        s.lanes = k == KNOB_LANES ? (uint32_t)of : s.lanes;
        add_value(base, &s, value + (*value == 'x'), text, t);
        return VIT_OK;
    }
    if (*value == 'x') {
        if (!multiple(in, k, value, number, sizeof number))
            return VIT_OK;
        label = value = number;
    }
    char *rest, *word = strtok_r(value, ",", &rest);
    bool fine = put_word(&setting_rows[k], word, &s, text, sizeof text, &used);
    if (!colon && setting_rows[k].field.kind == FIELD_SWITCH)
        label = strcmp(word, "0") ? "on" : "off";
    while (fine && (word = strtok_r(NULL, ",", &rest)) != NULL) {
        word += strspn(word, " ");
        const size_t length = strcspn(word, " ");
        const setting_row *other = settings_named(word, length);
        fine = other && put_word(other, word + length + 1, &s, text, sizeof text, &used);
    }
    if (!fine) {
        return bake_fail(why, VIT_FAILED, "values to try of '%s': '%.60s'", knob_name(k), word);
    }
    add_value(base, &s, label, text, t);
    return VIT_OK;
}

static vit_status try_values(const knobs_input *in, const knob_setting *base, int k, knob_values *t, vit_text *why) {
    vit_status status = VIT_OK;
    t->count = 0;
    if (k < SETTINGS ? setting_rows[k].needs && !(setting_rows[k].needs & in->effects) : in->in_quality)
        return VIT_OK;
    char values[256];
    (void)snprintf(values, sizeof values, "%s", knob_tried(k));
    for (char *at = values; at && status == VIT_OK && t->count < MOST_TRIED;) {
        char *bar = strstr(at, " | ");
        if (bar)
            *bar = '\0';
        status = try_value(in, base, k, at, t, why);
        at = bar ? bar + 3 : NULL;
    }
    return status;
}

vit_status knob_find_values(const knobs_input *in, const knob_setting *base, knob_values *values, vit_text *why) {
    bool on[KNOBS];
    vit_status status = select_knobs(in->only, on, why);
    for (int k = 0; k < KNOBS && status == VIT_OK; k++)
        if (on[k])
            status = try_values(in, base, k, &values[k], why);
    return status;
}
