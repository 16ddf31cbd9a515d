/* effects = "auto", "all", or a list of names. */
#include "common/effect_names.h"
#include "scene/scene_reader.h"
#include <string.h>

static bool read_name(const config_place *at, const config_setting_t *setting, const char *name, uint64_t *effects) {
    const uint64_t effect = name ? effects_named(name) : 0;
    char names[256] = "";
    if (effect & EFFECTS_NAMED) {
        *effects |= effect;
        return true;
    }
    for (int bit = 0; bit < 64; bit++)
        if (EFFECTS_NAMED >> bit & 1) {
            (void)strncat(names, names[0] ? ", " : "", sizeof names - strlen(names) - 1);
            (void)strncat(names, effects_name(bit), sizeof names - strlen(names) - 1);
        }
    return fields_fail(at, setting, "'effects': %s%.60s%s: \"auto\", \"all\", or a list of: %s", name ? "'" : "",
                       name ? name : "no name",
                       name ? (effect ? "' follows from the scene's lights and quality" : "' is no effect") : "", names);
}

bool reader_effects(reader *r, const config_setting_t *root) {
    const config_setting_t *setting = config_setting_get_member(root, "effects");
    if (!setting)
        return true;
    reader_at(r, "", -1);
    const char *word = config_setting_get_string(setting);
    const int choice = word ? fields_place(SCENE_EFFECTS, word) : -1;
    if (choice >= 0) {
        r->s->effects_choice = choice;
        return true;
    }
    if (word || !(config_setting_is_array(setting) || config_setting_is_list(setting)))
        return read_name(&r->at, setting, word, &r->s->effects) &&
               fields_fail(&r->at, setting, "'effects' takes a list: [\"%.60s\"]", word);
    r->s->effects_choice = EFFECTS_LISTED;
    for (int i = 0; i < config_setting_length(setting); i++)
        if (!read_name(&r->at, setting, config_setting_get_string_elem(setting, i), &r->s->effects))
            return false;
    return true;
}
