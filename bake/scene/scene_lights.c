#include "scene/scene_reader.h"
#include "vitrine_pack.h"
#include <stdio.h>

enum { MAX_LIGHTS = 64 };

enum { LIGHT_USE, LIGHT_TYPE, LIGHT_INNER, LIGHT_OUTER, LIGHT_RANGE, LIGHT_FALLOFF };
static const config_field light_fields[] = {
    [LIGHT_USE] = {"use", FIELD_TEXT, offsetof(scene_light, use), NULL},
    [LIGHT_TYPE] = {"type", FIELD_WORD, offsetof(scene_light, kind), SCENE_LIGHT_KINDS},
    [LIGHT_INNER] = {"inner", FIELD_NUMBER, offsetof(scene_light, inner), "[0, 90]"},
    [LIGHT_OUTER] = {"outer", FIELD_NUMBER, offsetof(scene_light, outer), "(0, 90]"},
    [LIGHT_RANGE] = {"range", FIELD_NUMBER, offsetof(scene_light, range), "[0, 1e6]"},
    [LIGHT_FALLOFF] = {"falloff", FIELD_CHOICE, offsetof(scene_light, window), "inverse-square|window"},
    {"photons", FIELD_SWITCH, offsetof(scene_light, photons), NULL},
    {"keys", FIELD_OTHER, 0, NULL},
};

enum { LIGHT_POSITION, LIGHT_POWER, LIGHT_IRRADIANCE, LIGHT_TARGET };
static const config_field light_key_fields[] = {
    [LIGHT_POSITION] = {"position", FIELD_VECTOR, offsetof(scene_light_key, position), COORDINATE},
    [LIGHT_POWER] = {"power", FIELD_VECTOR, offsetof(scene_light_key, power), RADIOMETRIC},
    [LIGHT_IRRADIANCE] = {"irradiance", FIELD_VECTOR, offsetof(scene_light_key, power), RADIOMETRIC},
    [LIGHT_TARGET] = {"target", FIELD_VECTOR, offsetof(scene_light_key, target), COORDINATE},
    {"time", FIELD_NUMBER, offsetof(scene_light_key, time), TIME},
};

static bool at_target(const scene_light_key *k) {
    return k->position[0] == k->target[0] && k->position[1] == k->target[1] && k->position[2] == k->target[2];
}

/* What the keys of each kind of light hold, and what they must not hold. */
static bool check_key(const config_place *at, const config_setting_t *group, const scene_light *light, bool first,
                      uint64_t seen) {
    const bool directional = light->kind == VIT_LIGHT_DIRECTIONAL, aimed = light->kind != VIT_LIGHT_POINT;
    const uint32_t strength = directional ? FIELD_BIT(LIGHT_IRRADIANCE) : FIELD_BIT(LIGHT_POWER);
    if (directional && (seen & FIELD_BIT(LIGHT_POWER)))
        return fields_fail(at, group, "'power' is for point and spot lights; a directional one has 'irradiance'");
    if (!directional && (seen & FIELD_BIT(LIGHT_IRRADIANCE)))
        return fields_fail(at, group, "'irradiance' is for directional lights; others have 'power'");
    if (!aimed && (seen & FIELD_BIT(LIGHT_TARGET)))
        return fields_fail(at, group, "'target' is for spot and directional lights");
    if (first && (~seen & (FIELD_BIT(LIGHT_POSITION) | strength)))
        return fields_fail(at, group, "the first key needs 'position' and '%s'", directional ? "irradiance" : "power");
    if (first && aimed && !(seen & FIELD_BIT(LIGHT_TARGET)))
        return fields_fail(at, group, "the first key of a %s light needs a 'target'", directional ? "directional" : "spot");
    return true;
}

static bool read_light_key(reader *r, scene_light *light, config_setting_t *list, int i) {
    config_setting_t *group;
    uint64_t seen;
    scene_light_key *key = &light->keys[i];
    if (i)
        *key = key[-1];
    if (!fields_group(&r->at, list, i, &group) ||
        !fields_read(&r->at, group, light_key_fields, FIELD_COUNT(light_key_fields), key, &seen))
        return false;
    if (!check_key(&r->at, group, light, i == 0, seen))
        return false;
    if (i > 0 && key->time <= key[-1].time)
        return fields_fail(&r->at, group, "'time' must be after the key before (%g s), got %g", key[-1].time, key->time);
    if (light->kind != VIT_LIGHT_POINT && at_target(key))
        return fields_fail(&r->at, group, "'position' and 'target' are the same point");
    light->key_count = i + 1;
    return true;
}

static bool check_light(const config_place *at, const config_setting_t *group, const scene_light *light, uint64_t seen) {
    const uint32_t cone = FIELD_BIT(LIGHT_INNER) | FIELD_BIT(LIGHT_OUTER);
    if (light->use[0] && (seen & (cone | FIELD_BIT(LIGHT_TYPE))))
        return fields_fail(at, group, "'use' already gives 'type', 'inner' and 'outer'");
    if (!light->use[0] && !(seen & FIELD_BIT(LIGHT_TYPE)))
        return fields_fail(at, group, "needs a 'type' or 'use'");
    if (!light->use[0] && light->kind != VIT_LIGHT_SPOT && (seen & cone))
        return fields_fail(at, group, "'inner' and 'outer' are for spot lights");
    if (light->kind == VIT_LIGHT_DIRECTIONAL && (seen & (FIELD_BIT(LIGHT_RANGE) | FIELD_BIT(LIGHT_FALLOFF))))
        return fields_fail(at, group, "'range' and 'falloff' are for point and spot lights");
    if (light->inner > light->outer)
        return fields_fail(at, group, "'inner' (%g) must not be above 'outer' (%g)", light->inner, light->outer);
    if (light->window && light->range == 0.0 && !light->use[0])
        return fields_fail(at, group, "falloff \"window\" needs a 'range'");
    return true;
}

static bool read_light(reader *r, config_setting_t *lights, int i) {
    config_setting_t *group, *list;
    uint64_t seen;
    scene_light *light = &r->s->lights[i];
    reader_at(r, "light", i);
    *light = (scene_light){.outer = 45.0, .photons = true};
    if (!fields_group(&r->at, lights, i, &group) ||
        !fields_read(&r->at, group, light_fields, FIELD_COUNT(light_fields), light, &seen) ||
        !check_light(&r->at, group, light, seen) || !fields_list(&r->at, group, "keys", MAX_KEYS, &list))
        return false;
    const int count = list ? config_setting_length(list) : 0;
    if ((count > 0) == (light->use[0] != '\0'))
        return fields_fail(&r->at, group, "needs either 'keys' or 'use'");
    light->line = (int)config_setting_source_line(group);
    if (!reader_allocate(r, &light->keys, count, sizeof *light->keys))
        return false;
    r->s->light_count = i + 1; /* from here on scene_free() sees the keys */
    for (int k = 0; k < count; k++) {
        (void)snprintf(r->at.what, sizeof r->at.what, "light %d, key %d", i + 1, k + 1);
        if (!read_light_key(r, light, list, k))
            return false;
    }
    return true;
}

bool reader_lights(reader *r, const config_setting_t *root) {
    config_setting_t *list;
    r->at.what[0] = '\0';
    if (!fields_list(&r->at, root, "lights", MAX_LIGHTS, &list))
        return false;
    const int count = list ? config_setting_length(list) : 0;
    if (!reader_allocate(r, &r->s->lights, count, sizeof *r->s->lights))
        return false;
    for (int i = 0; i < count; i++)
        if (!read_light(r, list, i))
            return false;
    return true;
}
