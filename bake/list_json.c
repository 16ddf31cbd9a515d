#include "common/json.h"
#include "import/import_format.h"
#include "list_parts.h"
#include "vitrine_pack.h"
#include <inttypes.h>

/* "name": */
static void key(FILE *to, const char *name) {
    (void)fprintf(to, "\"%s\": ", name);
}

static void text(FILE *to, const char *name, const char *value) {
    key(to, name);
    text_json(to, value);
}

static void numbers(FILE *to, const char *name, const double *values, int count) {
    key(to, name);
    (void)fputc('[', to);
    for (int i = 0; i < count; i++) {
        (void)fputs(i ? ", " : "", to);
        text_number(to, values[i], "null");
    }
    (void)fputc(']', to);
}

static void floats(FILE *to, const char *name, const float values[3]) {
    const double wide[3] = {(double)values[0], (double)values[1], (double)values[2]};
    numbers(to, name, wide, 3);
}

static void open_list(FILE *to, const char *name) {
    (void)fprintf(to, ",\n  \"%s\": [", name);
}

static void next(FILE *to, size_t index) {
    (void)fputs(index ? ",\n    {" : "\n    {", to);
}

static void materials(const model *m, FILE *to) {
    char kind[LIST_WORD];
    open_list(to, "materials");
    for (int i = 0; i < m->material_count; i++) {
        const model_material *k = &m->materials[i];
        next(to, (size_t)i);
        text(to, "name", k->name);
        (void)fprintf(to, ", \"kind\": \"%s\", \"triangles\": %" PRIu64 ", ", list_word(SCENE_MATERIAL_KINDS, k->kind, kind),
                      k->triangles);
        floats(to, "albedo", k->albedo);
        (void)fputs(", ", to);
        floats(to, "specular", k->specular);
        (void)fprintf(to, ", \"ggx_alpha\": %.9g, ", (double)k->lobe_alpha);
        floats(to, "emission", k->emission);
        (void)fputs(", ", to);
        if (k->image >= 0)
            text(to, "texture", m->images[k->image].name);
        else
            (void)fputs("\"texture\": null", to);
        (void)fputs(", ", to);
        if (MODEL_HAS_NORMAL_MAP(k))
            text(to, "normal_map", m->images[k->normal_image].name);
        else
            (void)fputs("\"normal_map\": null", to);
        (void)fputc('}', to);
    }
    (void)fputs("]", to);
}

static void lights(const model *m, FILE *to) {
    char kind[LIST_WORD];
    open_list(to, "lights");
    for (int i = 0; i < m->light_count; i++) {
        const model_light *l = &m->lights[i];
        next(to, (size_t)i);
        text(to, "name", l->name);
        (void)fprintf(to, ", \"kind\": \"%s\", ", list_word(SCENE_LIGHT_KINDS, (uint32_t)l->kind, kind));
        numbers(to, "position", l->position, 3);
        (void)fputs(", ", to);
        numbers(to, "direction", l->direction, 3);
        (void)fputs(", ", to);
        numbers(to, "stated", l->stated, 3);
        (void)fputs(", ", to);
        if (list_stated_unit(l)[0])
            text(to, "stated_unit", list_stated_unit(l));
        else
            (void)fputs("\"stated_unit\": null", to);
        (void)fputs(", ", to);
        numbers(to, "power", l->power, 3);
        (void)fputs(", ", to);
        text(to, "power_unit", list_power_unit(l));
        (void)fputs(", \"range\": ", to);
        text_number(to, l->range, "null");
        if (l->kind == VIT_LIGHT_SPOT) {
            (void)fputs(", \"inner\": ", to);
            text_number(to, l->inner, "null");
            (void)fputs(", \"outer\": ", to);
            text_number(to, l->outer, "null");
        }
        (void)fputc('}', to);
    }
    (void)fputs("]", to);
}

static void cameras(const model *m, FILE *to) {
    open_list(to, "cameras");
    for (int i = 0; i < m->camera_count; i++) {
        const model_camera *c = &m->cameras[i];
        next(to, (size_t)i);
        text(to, "name", c->name);
        (void)fputs(", ", to);
        numbers(to, "eye", c->eye, 3);
        (void)fputs(", ", to);
        numbers(to, "target", c->target, 3);
        (void)fputs(", ", to);
        numbers(to, "up", c->up, 3);
        (void)fputs(", \"fov\": ", to);
        if (c->fov > 0.0)
            text_number(to, c->fov, "null");
        else
            (void)fputs("null", to);
        (void)fputc('}', to);
    }
    (void)fputs("]", to);
}

static void meshes(const list *l, FILE *to) {
    const model *m = &l->model;
    open_list(to, "meshes");
    for (int i = 0; i < m->mesh_count; i++) {
        next(to, (size_t)i);
        text(to, "name", m->meshes[i].name);
        (void)fputs(", ", to);
        text(to, "file", l->s->meshes[m->meshes[i].file].file);
        (void)fprintf(to, ", \"triangles\": %" PRIu64 ", \"places\": %u}", m->meshes[i].triangles, m->meshes[i].places);
    }
    (void)fputs("]", to);
}

static void textures(const model *m, FILE *to) {
    open_list(to, "textures");
    for (int i = 0; i < m->image_count; i++) {
        next(to, (size_t)i);
        text(to, "name", m->images[i].name);
        (void)fprintf(to, ", \"width\": %d, \"height\": %d}", m->images[i].width, m->images[i].height);
    }
    (void)fputs("]", to);
}

/* Metres a unit, the axis that is up, and who says so. */
static void frame(const model_frame *f, FILE *to) {
    static const char by[] = "default|format|file|scene"; /* frame_source */
    char word[LIST_WORD];
    key(to, "unit");
    text_number(to, f->unit, "null");
    (void)fprintf(to, ", \"unit_by\": \"%s\"", list_word(by, f->unit_by, word));
    (void)fprintf(to, ", \"up\": \"%c\", \"up_by\": \"%s\"", "xyz"[f->up], list_word(by, f->up_by, word));
}

static void formats(const list *l, FILE *to) {
    open_list(to, "formats");
    for (int i = 0; i < l->model.format_count; i++) {
        const import_format *f = import_formats[l->model.formats[i].reader];
        next(to, (size_t)i);
        text(to, "file", l->s->meshes[i].file);
        (void)fputs(", ", to);
        text(to, "format", f->name);
        (void)fputs(", \"without\": [", to);
        for (size_t k = 0; f->cannot[k]; k++) {
            (void)fputs(k ? ", " : "", to);
            text_json(to, f->cannot[k]);
        }
        (void)fputs("], ", to);
        frame(&l->model.formats[i].frame, to);
        (void)fputc('}', to);
    }
    (void)fputs("]", to);
}

static void extensions(const list *l, FILE *to) {
    open_list(to, "extensions");
    for (int i = 0; i < l->model.extension_count; i++) {
        const model_extension *e = &l->model.extensions[i];
        next(to, (size_t)i);
        text(to, "name", e->name);
        (void)fputs(", ", to);
        text(to, "file", l->s->meshes[e->file].file);
        (void)fprintf(to, ", \"required\": %s, \"read\": %s}", e->required ? "true" : "false", e->read ? "true" : "false");
    }
    (void)fputs("]", to);
}

void list_for_programs(const list *l, FILE *to) {
    const model *m = &l->model;
    (void)fputs("{\n  ", to);
    text(to, "file", l->s->path);
    (void)fprintf(to, ",\n  \"triangles\": %u,\n  \"vertices\": %u,\n  ", m->triangles, m->vertices);
    numbers(to, "lo", m->lo, 3);
    (void)fputs(",\n  ", to);
    numbers(to, "hi", m->hi, 3);
#define X(name, meaning) (void)fprintf(to, ",\n  \"" #name "\": %" PRIu64, m->name);
    MODEL_COUNTS(X)
#undef X
    meshes(l, to);
    materials(m, to);
    textures(m, to);
    lights(m, to);
    cameras(m, to);
    formats(l, to);
    extensions(l, to);
    open_list(to, "not_done");
    for (size_t i = 0; i < l->not_done_count; i++) {
        (void)fputs(i ? ",\n    " : "\n    ", to);
        text_json(to, l->not_done[i]);
    }
    (void)fputs("]\n}\n", to);
}
