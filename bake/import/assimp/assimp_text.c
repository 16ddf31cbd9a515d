/* What Assimp misreads, without a word, in the text of COLLADA files: numbers and words with white space round them, which XML
 * collapses (XML Schema, 2), and units; what is left out of COLLADA and X3D. */
#include "import/assimp/assimp_scene.h"
#include "import/assimp/assimp_tags.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Without the space between tags and text: Assimp 5.2 refuses it before numbers, which Godot's exporter writes, and knows no
 * axis with it behind. */
static size_t drop_space(char *text, size_t size) {
    size_t kept = 0;
    bool after_tag = false;
    for (size_t i = 0; i < size; i++) {
        const char c = text[i];
        if (after_tag && tag_blank(c))
            continue;
        while (c == '<' && kept > 0 && tag_blank(text[kept - 1]))
            kept--;
        after_tag = c == '>';
        text[kept++] = c;
    }
    return kept;
}

static bool is_axis(tag_span value) {
    return value.end - value.at == 4 && strchr("XYZ", *value.at) && memcmp(value.at + 1, "_UP", 3) == 0;
}

/* The first asset is the file's (COLLADA 1.4.1, 5-16). */
static void read_asset(assimp_scene *a, tag_span text) {
    tag_span asset, tag, value;
    char *from;
    double metres;
    if (!tag_find(text, "asset", &asset))
        return;
    tag_span inside = {asset.end, text.end}, end;
    if (tag_find(inside, "/asset", &end))
        inside.end = end.at;
    if (tag_find(inside, "unit", &tag) && tag_value(tag, "meter", &value)) {
        a->bad_unit = !tag_length(value, &from, &metres);
        if (!a->bad_unit && from > value.at) { /* blanks go behind the number */
            const size_t blanks = (size_t)(from - value.at);
            memmove(value.at, from, (size_t)(value.end - from));
            memset(value.end - blanks, ' ', blanks);
        }
    }
    if (tag_find(inside, "up_axis", &tag) && tag.end < inside.end) {
        value = (tag_span){tag.end + 1, tag.end + 1};
        while (value.end < inside.end && *value.end != '<')
            value.end++;
        a->bad_axis = !is_axis(value);
    }
}

/* Geometry that is no mesh, of which Assimp says nothing, and skews, at which some of its releases break down. */
static void drop_elements(assimp_scene *a, tag_span text) {
    static const char *const names[] = {"skew", "spline", "convex_mesh", "brep"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        for (tag_span rest = text, tag; tag_find(rest, names[i], &tag);) {
            rest.at = tag_behind(tag, names[i], text.end);
            assimp_note_lost(a, names[i]);
            if (i == 0)
                memset(tag.at, ' ', (size_t)(rest.at - tag.at));
        }
}

void assimp_note_lost(assimp_scene *a, const char *name) {
    for (unsigned i = 0; i < a->lost_count && i < ASSIMP_LOST; i++)
        if (strcmp(a->lost[i], name) == 0)
            return;
    if (a->lost_count < ASSIMP_LOST)
        (void)snprintf(a->lost[a->lost_count], sizeof a->lost[0], "%s", name);
    a->lost_count++;
}

bool assimp_say_lost(assimp_scene *a) {
    char text[ASSIMP_LOST * (sizeof a->lost[0] + 4)] = "";
    for (unsigned i = 0; i < a->lost_count && i < ASSIMP_LOST; i++)
        (void)snprintf(text + strlen(text), sizeof text - strlen(text), "%s'%s'", i ? ", " : "", a->lost[i]);
    if (a->off_colors && !import_not_done(a->im, "colours of vertices and faces are left out"))
        return false;
    return a->lost_count == 0 || import_not_done(a->im, "elements %s%s are left out, with all that is in them", text,
                                                 a->lost_count > ASSIMP_LOST ? " and others" : "");
}

/* Meshes without a material get the one of the least id from Assimp: this one, as Assimp's own for files that have none. */
static const char no_material[] =
    "<library_effects><effect id=\"!\"><profile_COMMON><technique sid=\"!\"><lambert><diffuse><color>0.6 0.6 0.6 1</color>"
    "</diffuse></lambert></technique></profile_COMMON></effect></library_effects><library_materials><material id=\"!\" "
    "name=\"DefaultMaterial\"><instance_effect url=\"#!\"/></material></library_materials>";

static char *add_material(char *text, size_t *size) {
    const size_t more = sizeof no_material - 1;
    tag_span all = {text, text + *size}, asset, tag;
    char *out =
        tag_find(all, "material", &tag) && tag_find(all, "/asset", &asset) && asset.end < all.end ? malloc(*size + more) : NULL;
    if (!out)
        return text;
    const size_t before = (size_t)(asset.end + 1 - text);
    memcpy(out, text, before);
    memcpy(out + before, no_material, more);
    memcpy(out + before + more, text + before, *size - before);
    *size += more;
    free(text);
    return out;
}

/* Is a texture bound to a set of coordinates whose number is not 0? */
static bool binds_other_set(tag_span text) {
    tag_span tag, value;
    for (tag_span rest = text; tag_find(rest, "bind_vertex_input", &tag); rest.at = tag.end)
        if (tag_value(tag, "input_set", &value) && !(value.end - value.at == 1 && *value.at == '0'))
            return true;
    return false;
}

char *assimp_mend_collada(assimp_scene *a, char *text, size_t *size) {
    drop_elements(a, (tag_span){text, text + *size});
    *size = drop_space(text, *size);
    read_asset(a, (tag_span){text, text + *size});
    a->other_set = binds_other_set((tag_span){text, text + *size});
    return add_material(text, size);
}
