/* Lines of MTL. */
#include "import/obj/obj_file.h"
#include <math.h>
#include <stddef.h>
#include <string.h>

/* Kd is the plain grey of what nobody gave a colour. */
mtl mtl_default(void) {
    return (mtl){.color = {0.6f, 0.6f, 0.6f},
                 .filter = {1.0f, 1.0f, 1.0f},
                 .ior = 1.0f,
                 .opacity = 1.0f,
                 .roughness = 0.5f,
                 .illum = 1.0f};
}

typedef struct reading {
    obj_file *o;
    const obj_lines *lines;
    mtl *to; /* of the lines that follow; NULL: none that is used */
    bool unknown;
} reading;

static const struct {
    const char *word;
    size_t at;
    enum { COLOR, NUMBER, MAP, REMARK, NOTHING } kind;
    unsigned what; /* bit of mtl_said, or mtl_remark */
} words[] = {
    {"Kd", offsetof(mtl, color), COLOR, MTL_HAS_COLOR},
    {"Ka", offsetof(mtl, ambient), COLOR, 0},
    {"Ks", offsetof(mtl, specular), COLOR, 0},
    {"Ke", offsetof(mtl, emission), COLOR, 0},
    {"Tf", offsetof(mtl, filter), COLOR, 0},
    {"Ns", offsetof(mtl, exponent), NUMBER, 0},
    {"Ni", offsetof(mtl, ior), NUMBER, 0},
    {"d", offsetof(mtl, opacity), NUMBER, MTL_HAS_OPACITY},
    {"Tr", offsetof(mtl, transparency), NUMBER, MTL_HAS_TRANSPARENCY},
    {"illum", offsetof(mtl, illum), NUMBER, 0},
    {"Pr", offsetof(mtl, roughness), NUMBER, MTL_HAS_ROUGHNESS},
    {"Pm", offsetof(mtl, metallic), NUMBER, MTL_HAS_METALLIC},
    {"Ps", offsetof(mtl, sheen), NUMBER, 0},
    {"Pc", offsetof(mtl, coat), NUMBER, 0},
    {"aniso", offsetof(mtl, sheen), NUMBER, 0},
    {"map_Kd", offsetof(mtl, color_map), MAP, 0},
    {"map_Ks", offsetof(mtl, specular_map), MAP, 0},
    {"map_Ke", offsetof(mtl, emission_map), MAP, 0},
    {"map_emissive", offsetof(mtl, emission_map), MAP, 0},
    {"map_d", offsetof(mtl, opacity_map), MAP, 0},
    {"map_Pr", offsetof(mtl, roughness_map), MAP, 0},
    {"map_Pm", offsetof(mtl, metallic_map), MAP, 0},
    {"norm", offsetof(mtl, normal_map), MAP, 0},
    {"map_Kn", offsetof(mtl, normal_map), MAP, 0},
    {"bump", 0, REMARK, MTL_BUMP},
    {"map_bump", 0, REMARK, MTL_BUMP},
    {"disp", 0, REMARK, MTL_BUMP},
    {"map_disp", 0, REMARK, MTL_BUMP},
    {"refl", 0, REMARK, MTL_REFLECTION},
    {"map_refl", 0, REMARK, MTL_REFLECTION},
    {"decal", 0, REMARK, MTL_DECAL},
    {"map_decal", 0, REMARK, MTL_DECAL},
    {"map_Ns", 0, REMARK, MTL_MAPPED_NUMBER},
    {"map_Ni", 0, REMARK, MTL_MAPPED_NUMBER},
    {"map_Tr", 0, REMARK, MTL_MAPPED_NUMBER},
    {"map_Tf", 0, REMARK, MTL_MAPPED_NUMBER},
    {"map_Ps", 0, REMARK, MTL_MAPPED_NUMBER},
    {"map_Pc", 0, REMARK, MTL_MAPPED_NUMBER},
    /* Light from nowhere, how smooth edges are, and how bright or fine what is left out would be. */
    {"map_Ka", 0, NOTHING, 0},
    {"map_aat", 0, NOTHING, 0},
    {"sharpness", 0, NOTHING, 0},
    {"Km", 0, NOTHING, 0},
    {"Pcr", 0, NOTHING, 0},
    {"anisor", 0, NOTHING, 0},
};

static bool no_number(const reading *r, obj_text line) {
    const obj_text word = obj_word(&line);
    return import_not_done(r->o->im, "material file, line %u: %s'%.*s'", r->lines->number,
                           obj_is_empty(word) ? "a number is missing " : "no number: ", obj_size(word, 40), word.at);
}

/* One value is all three; two are those, and the third is the first. */
static bool read_color(const reading *r, obj_text line, float color[3]) {
    obj_text ahead = line;
    const obj_text word = obj_word(&ahead);
    if (obj_is(word, "spectral") || obj_is(word, "xyz")) {
        r->to->remarks |= 1u << MTL_SPECTRAL;
        return true;
    }
    for (int i = 0; i < 3; i++) {
        float value;
        if (!obj_number(&line, &value)) {
            obj_text rest = line;
            return (i > 0 && obj_is_empty(obj_word(&rest))) || no_number(r, line);
        }
        for (int k = i; k < 3; k++)
            color[k] = i == 0 || k == i ? value : color[k];
    }
    return true;
}

static bool read_number(const reading *r, obj_text line, float *out) {
    obj_text ahead = line;
    if (obj_is(obj_word(&ahead), "-halo")) {
        r->to->remarks |= 1u << MTL_HALO;
        line = ahead;
    }
    return obj_number(&line, out) || no_number(r, line);
}

/* ---- maps ---- */

/* Up to `most` numbers of an option; those that are left out stay. */
static void numbers_of(obj_text *line, float *out, size_t most) {
    for (size_t i = 0; i < most && obj_number(line, &out[i]); i++)
        ;
}

static bool differ(const float *a, const float *b, size_t count) {
    for (size_t i = 0; i < count; i++)
        if (a[i] != b[i])
            return true;
    return false;
}

/* One option and what belongs to it. False: the word is none. */
static bool read_option(mtl *m, mtl_map *map, obj_text word, obj_text *line) {
    static const struct {
        const char *word, *plain; /* plain: what it says where nothing is lost; NULL: whatever it says */
    } words_behind[] = {{"-blendu", NULL}, {"-blendv", NULL}, {"-cc", "off"}, {"-imfchan", ""}, {"-type", NULL}};
    static const char *const numbers_behind[] = {"-boost", "-bm", "-texres", NULL};
    static const float none[3] = {0.0f, 0.0f, 0.0f}, plain[2] = {0.0f, 1.0f};
    float v[3] = {0.0f, 0.0f, 0.0f}, range[2] = {0.0f, 1.0f}, scale[3] = {map->scale[0], map->scale[1], 1.0f};
    bool kept = true;
    if (obj_is(word, "-s")) {
        numbers_of(line, scale, 3);
        memcpy(map->scale, scale, sizeof map->scale);
    } else if (obj_is(word, "-o")) {
        numbers_of(line, v, 3);
        memcpy(map->offset, v, sizeof map->offset);
    } else if (obj_is(word, "-t")) {
        numbers_of(line, v, 3);
        kept = !differ(v, none, 3);
    } else if (obj_is(word, "-mm")) {
        numbers_of(line, range, 2);
        kept = !differ(range, plain, 2);
    } else if (obj_is(word, "-clamp"))
        map->clamp = obj_is(obj_word(line), "on");
    else {
        for (size_t i = 0; i < sizeof words_behind / sizeof *words_behind; i++)
            if (obj_is(word, words_behind[i].word)) {
                const obj_text value = obj_word(line);
                kept = !words_behind[i].plain || obj_is(value, words_behind[i].plain);
                m->remarks |= kept ? 0 : 1u << MTL_OPTION;
                return true;
            }
        for (size_t i = 0; numbers_behind[i]; i++)
            if (obj_is(word, numbers_behind[i])) {
                numbers_of(line, v, 1);
                return true;
            }
        return false;
    }
    m->remarks |= kept ? 0 : 1u << MTL_OPTION;
    return true;
}

/* Options, and a name that goes to the end of the line. */
static void read_map(mtl *m, obj_text line, mtl_map *map) {
    *map = (mtl_map){.scale = {1.0f, 1.0f}};
    for (;;) {
        obj_text ahead = line;
        const obj_text word = obj_word(&ahead);
        if (obj_is_empty(word) || *word.at != '-' || !read_option(m, map, word, &ahead))
            break;
        line = ahead;
    }
    map->name = obj_rest(line);
}

/* ---- all of them ---- */

static bool read_word(reading *r, obj_text word, obj_text line) {
    mtl *m = r->to;
    size_t i = 0;
    while (i < sizeof words / sizeof *words && !obj_is(word, words[i].word))
        i++;
    if (i == sizeof words / sizeof *words) {
        if (r->unknown)
            return true;
        r->unknown = true;
        return import_not_done(r->o->im, "material file, line %u: '%.*s' is not known and left out, and so may be others",
                               r->lines->number, obj_size(word, 40), word.at);
    }
    void *to = (char *)m + words[i].at;
    if (words[i].kind == COLOR || words[i].kind == NUMBER)
        m->has |= words[i].what;
    if (words[i].kind == COLOR)
        return read_color(r, line, to);
    if (words[i].kind == NUMBER)
        return read_number(r, line, to);
    if (words[i].kind == MAP)
        read_map(m, line, to);
    else if (words[i].kind == REMARK && !obj_is_empty(obj_rest(line)))
        m->remarks |= 1u << words[i].what;
    return true;
}

/* What follows from several lines together. A texture without Kd is not dimmed. */
static void settle(mtl *m) {
    if (!(m->has & MTL_HAS_COLOR) && !obj_is_empty(m->color_map.name))
        m->color[0] = m->color[1] = m->color[2] = 1.0f;
    if (m->sheen > 0.0f || m->coat > 0.0f)
        m->remarks |= 1u << MTL_COAT;
    if (m->has & MTL_HAS_TRANSPARENCY) {
        if (!(m->has & MTL_HAS_OPACITY))
            m->opacity = 1.0f - m->transparency;
        else if (!(fabsf(m->opacity + m->transparency - 1.0f) < 0.01f))
            m->remarks |= 1u << MTL_CONTRADICTION;
    }
}

/* The first definition of a name counts. */
static void begin(reading *r, obj_text line) {
    obj_file *o = r->o;
    const uint32_t index = obj_find_name(&o->materials, obj_rest(line));
    r->to = index == OBJ_NONE || o->mtl[index].defined ? NULL : &o->mtl[index];
    if (r->to)
        r->to->defined = true;
}

bool mtl_read_lines(obj_file *o, const import_bytes *bytes) {
    obj_lines lines = obj_lines_of(bytes);
    reading r = {.o = o, .lines = &lines};
    obj_text line;
    bool fine = true;
    while (fine && obj_next_line(&lines, &line)) {
        const obj_text word = obj_word(&line);
        if (obj_is_empty(word))
            continue;
        if (obj_is(word, "newmtl")) {
            if (r.to)
                settle(r.to);
            begin(&r, line);
        } else if (r.to)
            fine = read_word(&r, word, line);
    }
    if (r.to)
        settle(r.to);
    return fine;
}
