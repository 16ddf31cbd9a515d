#include "list.h"
#include "common/fail.h"
#include "import/import_format.h"
#include "import/import_frame.h"
#include "list_parts.h"
#include "vitrine_pack.h"
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

const char *list_word(const char *words, uint32_t place, char out[LIST_WORD]) {
    for (; place > 0 && strchr(words, '|'); place--)
        words = strchr(words, '|') + 1;
    (void)snprintf(out, LIST_WORD, "%.*s", (int)strcspn(words, "|"), words);
    return out;
}

const char *list_stated_unit(const model_light *l) {
    return !l->states_unit ? "" : l->kind == VIT_LIGHT_DIRECTIONAL ? "lx" : "cd";
}

const char *list_power_unit(const model_light *l) {
    return l->kind == VIT_LIGHT_DIRECTIONAL ? "W/m2" : "W";
}

/* Names come from strangers. */
static void print_name(FILE *to, const char *name) {
    (void)fputc('\'', to);
    for (; *name; name++)
        (void)fputc((unsigned char)*name < 0x20 || *name == 0x7f ? '?' : *name, to);
    (void)fputc('\'', to);
}

static void print_3(FILE *to, const double v[3]) {
    (void)fprintf(to, "(%.4g, %.4g, %.4g)", v[0], v[1], v[2]);
}

static void print_floats(FILE *to, const float v[3]) {
    (void)fprintf(to, "(%.3g, %.3g, %.3g)", (double)v[0], (double)v[1], (double)v[2]);
}

static void print_materials(const model *m, FILE *to) {
    char kind[LIST_WORD];
    (void)fprintf(to, "\nmaterials %d\n", m->material_count);
    for (int i = 0; i < m->material_count; i++) {
        const model_material *k = &m->materials[i];
        (void)fputs("  ", to);
        print_name(to, k->name);
        (void)fprintf(to, " %s, %" PRIu64 " triangles, albedo ", list_word(SCENE_MATERIAL_KINDS, k->kind, kind), k->triangles);
        print_floats(to, k->albedo);
        if (k->specular[0] > 0.0f || k->specular[1] > 0.0f || k->specular[2] > 0.0f) {
            (void)fputs(", specular ", to);
            print_floats(to, k->specular);
            if (k->lobe_alpha > 0.0f)
                (void)fprintf(to, " of GGX, alpha %.3g", (double)k->lobe_alpha);
        }
        if (k->emission[0] > 0.0f || k->emission[1] > 0.0f || k->emission[2] > 0.0f) {
            (void)fputs(", emission ", to);
            print_floats(to, k->emission);
            (void)fputs(" W/(m2 sr)", to);
        }
        if (k->image >= 0) {
            (void)fputs(", texture ", to);
            print_name(to, m->images[k->image].name);
        }
        if (MODEL_HAS_NORMAL_MAP(k)) {
            (void)fputs(", normal map ", to);
            print_name(to, m->images[k->normal_image].name);
        }
        (void)fputc('\n', to);
    }
}

static void print_lights(const model *m, FILE *to) {
    char kind[LIST_WORD];
    (void)fprintf(to, "\nlights %d\n", m->light_count);
    for (int i = 0; i < m->light_count; i++) {
        const model_light *l = &m->lights[i];
        (void)fputs("  ", to);
        print_name(to, l->name);
        (void)fprintf(to, " %s at ", list_word(SCENE_LIGHT_KINDS, (uint32_t)l->kind, kind));
        print_3(to, l->position);
        if (l->kind != VIT_LIGHT_POINT) {
            (void)fputs(" towards ", to);
            print_3(to, l->direction);
        }
        if (l->kind == VIT_LIGHT_SPOT)
            (void)fprintf(to, ", fading from %.4g to %.4g degrees off its axis", l->inner, l->outer);
        if (l->range > 0.0)
            (void)fprintf(to, ", range %.4g m", l->range);
        (void)fputs(": the file says ", to);
        print_3(to, l->stated);
        (void)fprintf(to, " %s, taken as ", list_stated_unit(l)[0] ? list_stated_unit(l) : "of no unit");
        print_3(to, l->power);
        (void)fprintf(to, " %s\n", list_power_unit(l));
    }
}

static void print_cameras(const model *m, FILE *to) {
    (void)fprintf(to, "\ncameras %d\n", m->camera_count);
    for (int i = 0; i < m->camera_count; i++) {
        const model_camera *c = &m->cameras[i];
        (void)fputs("  ", to);
        print_name(to, c->name);
        (void)fputs(" at ", to);
        print_3(to, c->eye);
        (void)fputs(" towards ", to);
        print_3(to, c->target);
        if (c->fov > 0.0)
            (void)fprintf(to, ", fov %.4g degrees", c->fov);
        (void)fputc('\n', to);
    }
}

/* Who reads each file, and what that reader never does. */
static void print_formats(const list *l, FILE *to) {
    (void)fprintf(to, "\nformats %d\n", l->model.format_count);
    for (int i = 0; i < l->model.format_count; i++) {
        const import_format *f = import_formats[l->model.formats[i].reader];
        char frame[FRAME_TEXT];
        (void)fputs("  ", to);
        print_name(to, l->s->meshes[i].file);
        (void)fprintf(to, " is read as %s, without", f->name);
        for (size_t k = 0; f->cannot[k]; k++)
            (void)fprintf(to, "%s %s", k ? "," : "", f->cannot[k]);
        (void)fprintf(to, "; %s\n", frame_text(&l->model.formats[i].frame, frame));
    }
}

void list_for_people(const list *l, FILE *to) {
    const model *m = &l->model;
    (void)fprintf(to, "%s: %u triangles, %u vertices, box ", l->s->path, m->triangles, m->vertices);
    print_3(to, m->lo);
    (void)fputs(" to ", to);
    print_3(to, m->hi);
    (void)fprintf(to, " m\n\nmeshes %d\n", m->mesh_count);
    for (int i = 0; i < m->mesh_count; i++) {
        (void)fputs("  ", to);
        print_name(to, m->meshes[i].name);
        (void)fprintf(to, " %" PRIu64 " triangles", m->meshes[i].triangles);
        if (m->meshes[i].places > 1)
            (void)fprintf(to, " in %u places", m->meshes[i].places);
        if (l->s->mesh_count > 1)
            (void)fprintf(to, ", of %s", l->s->meshes[m->meshes[i].file].file);
        (void)fputc('\n', to);
    }
    print_materials(m, to);
    (void)fprintf(to, "\ntextures %d\n", m->image_count);
    for (int i = 0; i < m->image_count; i++) {
        (void)fputs("  ", to);
        print_name(to, m->images[i].name);
        (void)fprintf(to, " %d x %d\n", m->images[i].width, m->images[i].height);
    }
    print_lights(m, to);
    print_cameras(m, to);
    print_formats(l, to);
    (void)fprintf(to, "\nextensions %d\n", m->extension_count);
    for (int i = 0; i < m->extension_count; i++) {
        const model_extension *e = &m->extensions[i];
        (void)fputs("  ", to);
        print_name(to, e->name);
        (void)fprintf(to, " %s, %s\n", e->required ? "required" : "used", e->read ? "read" : "not read");
    }
    (void)fprintf(to, "\nnot done %zu\n", l->not_done_count);
    for (size_t i = 0; i < l->not_done_count; i++)
        (void)fprintf(to, "  %s\n", l->not_done[i]);
}

/* ---- finding ---- */

static void remember(void *user, const char *line) {
    list *l = user;
    char **grown = realloc(l->not_done, (l->not_done_count + 1) * sizeof *grown);
    if (!grown) {
        l->failed = true;
        return;
    }
    l->not_done = grown;
    grown[l->not_done_count] = strdup(line);
    if (grown[l->not_done_count])
        l->not_done_count++;
    else
        l->failed = true;
}

vit_status list_print(const scene *s, bool strict, bool json, FILE *to, vit_text *why) {
    list l = {.s = s};
    vit_status status = model_import(s, strict ? MODEL_STRICT : MODEL_LISTS, remember, &l, &l.model, why);
    if (status == VIT_OK && l.failed) {
        status = bake_fail(why, VIT_FAILED, "out of memory");
    }
    if (status == VIT_OK)
        json ? list_for_programs(&l, to) : list_for_people(&l, to);
    for (size_t i = 0; i < l.not_done_count; i++)
        free(l.not_done[i]);
    free(l.not_done);
    model_free(&l.model);
    return status;
}
