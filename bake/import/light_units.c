#include "import/light_units.h"
#include "common/pi.h"
#include "vitrine_pack.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

#define LUMENS_A_WATT 683.0 /* of light at 555 nm: what exporters take for white light, too */

double light_units_of_light(const scene *s, bool states_unit) {
    const bool photometric = s->light_units == LIGHT_UNITS_AUTO ? states_unit : s->light_units == LIGHT_UNITS_PHOTOMETRIC;
    return photometric ? 1.0 / LUMENS_A_WATT : 1.0;
}

double light_units_of_emission(const scene *s) {
    return s->light_units == LIGHT_UNITS_PHOTOMETRIC ? 1.0 / LUMENS_A_WATT : 1.0;
}

/* "5435.14", or "(1, 2, 3)" if the channels differ. */
static const char *channels(const double value[3], double factor, int digits, char text[80]) {
    const bool grey = value[0] == value[1] && value[0] == value[2];
    (void)snprintf(text, 80, grey ? "%.*g" : "(%.*g, %.*g, %.*g)", digits, value[0] * factor, digits, value[1] * factor, digits,
                   value[2] * factor);
    return text;
}

static void say_light(const scene *s, const model_light *l, progress *p) {
    char file[80], ours[80];
    const bool directional = l->kind == VIT_LIGHT_DIRECTIONAL, guessed = !l->states_unit && s->light_units == LIGHT_UNITS_AUTO;
    const char *unit = directional ? "W/m2" : "W/sr", *stated = directional ? "lx" : "cd";
    (void)channels(l->stated, 1.0, 6, file);
    (void)channels(l->power, directional ? 1.0 : 0.25 / PI, 3, ours);
    if (guessed)
        progress_line(p, true, "warning: light '%.100s': its format states no unit: %s taken as %s%s", l->name, file, unit,
                      directional ? "" : ", inverse-square");
    else if (light_units_of_light(s, l->states_unit) == 1.0)
        progress_line(p, false, "light '%.100s': %s taken as %s", l->name, file, unit);
    else
        progress_line(p, false, "light '%.100s': %s %s = %s %s", l->name, file, stated, ours, unit);
    if (!(l->power[0] > 0.0 || l->power[1] > 0.0 || l->power[2] > 0.0))
        progress_line(p, true, "warning: light '%.100s' has intensity 0", l->name);
}

static bool is_used(const scene *s, const model *m, const model_light *l) {
    bool used = false;
    for (int i = 0; i < s->light_count; i++)
        used = used || (s->lights[i].use[0] && model_light_named(m, s->lights[i].use) == l);
    return used;
}

/* Lights of the files that the scene leaves alone: nobody should look for them in the picture. */
static void say_unused(const scene *s, const model *m, progress *p) {
    const model_light *first = NULL;
    int count = 0;
    for (int i = 0; i < m->light_count; i++)
        if (!is_used(s, m, &m->lights[i])) {
            first = first ? first : &m->lights[i];
            count++;
        }
    if (count > 0)
        progress_line(
            p, false,
            "%d light%s of the mesh files %s not used ('%.100s'%s): a scene file's lights take them by { use = \"...\"; }",
            count, count > 1 ? "s" : "", count > 1 ? "are" : "is", first->name, count > 1 ? " is the first" : "");
}

static void say_emission(const scene *s, const model *m, progress *p) {
    int nits = 0, others = 0;
    for (int i = 0; i < m->material_count; i++) {
        const model_material *at = &m->materials[i];
        if (at->emits_by_file && (at->emission[0] > 0.0f || at->emission[1] > 0.0f || at->emission[2] > 0.0f))
            *(at->states_unit ? &nits : &others) += 1;
    }
    if (light_units_of_emission(s) != 1.0 && nits + others > 0)
        progress_line(p, false, "emission of %d materials of the mesh files is taken as nits: 683 nits = 1 W/(m2 sr)",
                      nits + others);
    else if (nits > 0)
        progress_line(p, false,
                      "emission of %d glTF materials is taken as W/(m2 sr), as exporters mean it (light_units = "
                      "\"photometric\": as nits)",
                      nits);
}

void light_units_say(const scene *s, const model *m, progress *p) {
    for (int i = 0; i < s->light_count; i++) {
        const model_light *used = s->lights[i].use[0] ? model_light_named(m, s->lights[i].use) : NULL;
        if (used)
            say_light(s, used, p);
    }
    say_unused(s, m, p);
    say_emission(s, m, p);
}
