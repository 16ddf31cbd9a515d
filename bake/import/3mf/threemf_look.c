/* What triangles look like: their properties (Core 4.1.4, Materials 1 to 5) as materials of the file, and texture coordinates
 * by keys. */
#include "common/strict_math.h"
#include "import/3mf/threemf_file.h"
#include "import/metallic_roughness.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define GREY 0.6f /* of what has no colour, as of STL and OBJ */

static bool add_look(threemf_file *f, const threemf_look *look, uint32_t *index) {
    if (f->look_count == THREEMF_LOOKS)
        return import_fail(f->im, "has more than %d materials", THREEMF_LOOKS);
    if (!import_room(f->im, &f->looks, &f->look_room, f->look_count + 1, sizeof *f->looks))
        return false;
    *index = (uint32_t)f->look_count;
    f->looks[f->look_count++] = *look;
    return true;
}

static const threemf_look blank = {
    .name = THREEMF_NONE, .rgba = {255, 255, 255, 255}, .group = THREEMF_NONE, .image = THREEMF_NONE};

static bool plain_look(threemf_file *f, uint32_t *look) {
    threemf_look l = blank;
    l.grey = true;
    if (f->plain == THREEMF_NONE && (!threemf_keep(f, "default", &l.name) || !add_look(f, &l, &f->plain)))
        return false;
    *look = f->plain;
    return true;
}

/* The triangle has a property that is not there: it is shown without. */
static bool bad_look(threemf_file *f, uint32_t *look) {
    f->bad_property++;
    return plain_look(f, look);
}

/* ---- colours ---- */

static void read_display(const threemf_file *f, const threemf_group *g, uint32_t index, threemf_look *l) {
    const threemf_resource *r = g->display == THREEMF_NONE ? NULL : threemf_find(f, g->part, g->display);
    const threemf_group *metals = r && r->kind == THREEMF_METALS ? &f->groups[r->index] : NULL;
    l->metal = metals && index < metals->count;
    if (l->metal) {
        l->metallic = f->metals[2 * (metals->first + index)];
        l->roughness = f->metals[2 * (metals->first + index) + 1];
    }
}

/* A base material, or a mixture of them. */
static bool base_look(threemf_file *f, const threemf_group *g, uint32_t index, uint32_t *look) {
    threemf_color *c = &f->colors[g->first + index];
    if (c->look == THREEMF_NONE) {
        threemf_look l = blank;
        char name[32];
        (void)snprintf(name, sizeof name, "material %u", index);
        l.name = c->name;
        if (l.name == THREEMF_NONE && !threemf_keep(f, name, &l.name))
            return false;
        memcpy(l.rgba, c->rgba, sizeof l.rgba);
        read_display(f, g, index, &l);
        if (!add_look(f, &l, &c->look))
            return false;
    }
    *look = c->look;
    return true;
}

static bool painted_look(threemf_file *f, uint32_t *look) {
    threemf_look l = blank;
    l.keyed = true;
    l.image = (uint32_t)f->group_count;
    l.wrap_u = l.wrap_v = VIT_WRAP_CLAMP;
    if (f->painted == THREEMF_NONE && (!threemf_keep(f, "colours of corners", &l.name) || !add_look(f, &l, &f->painted)))
        return false;
    *look = f->painted;
    return true;
}

/* The first THREEMF_COLORS colours are materials, the others places in the picture. */
static bool name_color(threemf_file *f, const threemf_group *g, uint32_t index) {
    threemf_color *c = &f->colors[g->first + index];
    const uint8_t *const rgba[3] = {c->rgba, c->rgba, c->rgba};
    threemf_look l = blank;
    char name[32];
    uint32_t place;
    memcpy(l.rgba, c->rgba, 3);
    read_display(f, g, index, &l);
    for (uint32_t i = 0; i < f->flat_looks; i++) {
        const threemf_look *other = &f->looks[f->flat_look[i]];
        if (memcmp(other->rgba, l.rgba, 3) == 0 && other->metal == l.metal && other->metallic == l.metallic &&
            other->roughness == l.roughness) {
            c->look = f->flat_look[i];
            return true;
        }
    }
    if (f->flat_looks == THREEMF_COLORS) {
        if (!threemf_paint(f, rgba, &place))
            return false;
        c->look = place | THREEMF_PAINTED;
        return true;
    }
    (void)snprintf(name, sizeof name, "#%02x%02x%02x", c->rgba[0], c->rgba[1], c->rgba[2]);
    if (!threemf_keep(f, name, &l.name) || !add_look(f, &l, &c->look))
        return false;
    f->flat_look[f->flat_looks++] = c->look;
    return true;
}

static bool color_look(threemf_file *f, const threemf_group *g, const uint32_t p[3], threemf_ref *out) {
    threemf_color *c[3];
    uint32_t place;
    for (int k = 0; k < 3; k++)
        c[k] = &f->colors[g->first + p[k]];
    if (memcmp(c[0]->rgba, c[1]->rgba, 3) == 0 && memcmp(c[0]->rgba, c[2]->rgba, 3) == 0) {
        if (c[0]->look == THREEMF_NONE && !name_color(f, g, p[0]))
            return false;
        if (c[0]->look < THREEMF_PAINTED) {
            out->pid = c[0]->look;
            return true;
        }
        for (int k = 0; k < 3; k++)
            out->p[k] = 4 * (c[0]->look - THREEMF_PAINTED) + 3;
        return painted_look(f, &out->pid);
    }
    const uint8_t *const rgba[3] = {c[0]->rgba, c[1]->rgba, c[2]->rgba};
    if (!threemf_paint(f, rgba, &place))
        return false;
    for (uint32_t k = 0; k < 3; k++)
        out->p[k] = 4 * place + k;
    return painted_look(f, &out->pid);
}

/* ---- textures ---- */

static const char *after_slash(const char *path) {
    const char *slash = strrchr(path, '/');
    return slash ? slash + 1 : path;
}

static bool texture_look(threemf_file *f, threemf_group *g, const uint32_t p[3], threemf_ref *out) {
    const threemf_resource *r = threemf_find(f, g->part, g->of);
    if (!r || r->kind != THREEMF_TEXTURE)
        return bad_look(f, &out->pid);
    const threemf_group *texture = &f->groups[r->index];
    if (g->look == THREEMF_NONE) {
        threemf_look l = blank;
        char name[SCENE_NAME];
        l.keyed = true;
        l.group = (uint32_t)(g - f->groups);
        l.image = r->index;
        l.wrap_u = texture->wrap_u;
        l.wrap_v = texture->wrap_v;
        read_display(f, g, 0, &l);
        (void)snprintf(name, sizeof name, "%s", after_slash(f->text + texture->path));
        if (!threemf_keep(f, name, &l.name) || !add_look(f, &l, &g->look))
            return false;
    }
    for (int k = 0; k < 3; k++) {
        const float *uv = f->uv + 2 * (size_t)(g->first + p[k]);
        const bool out_u = texture->none_u && !(uv[0] >= 0.0f && uv[0] <= 1.0f),
                   out_v = texture->none_v && !(uv[1] >= 0.0f && uv[1] <= 1.0f);
        if ((out_u || out_v) && threemf_is_new(f, "none") &&
            !import_not_done(f->im, "tile style 'none': a texture goes on beyond its edge"))
            return false;
        out->p[k] = p[k];
    }
    out->pid = g->look;
    return true;
}

/* ---- triangles ---- */

/* A property by group and indices; of layers the last. */
static bool look_of(threemf_file *f, uint32_t part, uint32_t pid, uint32_t p[3], threemf_ref *out) {
    const threemf_resource *r = threemf_find(f, part, pid);
    threemf_group *g = r && r->kind != THREEMF_OBJECT ? &f->groups[r->index] : NULL;
    for (int layer = 0; layer < 2; layer++) {
        if (!g || p[0] >= g->count || p[1] >= g->count || p[2] >= g->count)
            return bad_look(f, &out->pid);
        if (g->kind != THREEMF_MULTIS)
            break;
        for (int k = 0; k < 3; k++)
            p[k] = f->picks[g->first + p[k]];
        r = threemf_find(f, part, g->of);
        g = r && r->kind != THREEMF_OBJECT ? &f->groups[r->index] : NULL;
    }
    switch (g->kind) {
    case THREEMF_BASES:
    case THREEMF_COMPOSITES:
        return base_look(f, g, p[0], &out->pid);
    case THREEMF_COLORGROUP:
        return color_look(f, g, p, out);
    case THREEMF_COORDINATES:
        return texture_look(f, g, p, out);
    default:
        return bad_look(f, &out->pid);
    }
}

static bool resolve_triangle(threemf_file *f, const threemf_object *o, const threemf_ref *says, threemf_ref *out) {
    const bool own = says->p[0] != THREEMF_NONE;
    const uint32_t pid = own && says->pid != THREEMF_NONE ? says->pid : o->pid;
    uint32_t p[3];
    for (int k = 0; k < 3; k++)
        p[k] = !own ? o->pindex : says->p[k] != THREEMF_NONE ? says->p[k] : says->p[0];
    *out = (threemf_ref){.p = {0, 0, 0}};
    if (pid == THREEMF_NONE)
        return own ? bad_look(f, &out->pid) : plain_look(f, &out->pid);
    return look_of(f, o->part, pid, p, out);
}

/* Objects whose triangles are all alike need no list. */
static bool resolve_alike(threemf_file *f, threemf_object *o) {
    static const threemf_ref nothing = {THREEMF_NONE, {THREEMF_NONE, THREEMF_NONE, THREEMF_NONE}};
    threemf_ref all;
    if (!resolve_triangle(f, o, &nothing, &all))
        return false;
    o->look = all.pid;
    if (!f->looks[o->look].keyed)
        return true;
    if (!import_room(f->im, &o->ref, &o->ref_room, o->triangles, sizeof *o->ref))
        return false;
    for (size_t i = 0; i < o->triangles; i++)
        o->ref[i] = all;
    return true;
}

static bool count(threemf_file *f, uint32_t look, uint64_t triangles) {
    const size_t before = f->of_look ? f->of_look_room : 0;
    if (!import_room(f->im, &f->of_look, &f->of_look_room, f->look_count, sizeof *f->of_look))
        return false;
    memset(f->of_look + before, 0, (f->of_look_room - before) * sizeof *f->of_look);
    f->of_look[look] += triangles;
    return true;
}

static bool resolve_object(threemf_file *f, threemf_object *o) {
    if (!o->ref)
        return resolve_alike(f, o) && count(f, o->look, o->triangles * o->places);
    for (size_t i = 0; i < o->triangles; i++) {
        const threemf_ref says = o->ref[i];
        if (!resolve_triangle(f, o, &says, &o->ref[i]) || !count(f, o->ref[i].pid, o->places))
            return false;
    }
    return true;
}

bool threemf_resolve(threemf_file *f) {
    f->plain = f->painted = THREEMF_NONE;
    for (size_t i = 0; i < f->object_count; i++)
        if (f->objects[i].places > 0 && f->objects[i].triangles > 0 && !resolve_object(f, &f->objects[i]))
            return false;
    return f->bad_property == 0 || import_not_done(f->im, "%llu triangles have a property that is not there: they are grey",
                                                   (unsigned long long)f->bad_property);
}

/* ---- materials ---- */

bool threemf_material(importer *im, material_use *use) {
    const threemf_file *f = im->reader;
    const threemf_look *l = &f->looks[use->source];
    (void)snprintf(use->m.name, sizeof use->m.name, "%.*s", SCENE_NAME - 1, f->text + l->name);
    float color[3];
    for (int k = 0; k < 3; k++)
        color[k] = l->grey ? GREY : (float)srgb_linear(l->rgba[k] / 255.0);
    if (l->image != THREEMF_NONE) {
        (void)snprintf(use->image, sizeof use->image, "*%u", l->image);
        use->m.wrap_u = l->wrap_u;
        use->m.wrap_v = l->wrap_v;
    }
    use->m.alpha = (float)l->rgba[3] / 255.0f;
    if (use->m.alpha < 0.5f)
        use->m.cutoff = 0.5f;
    for (int k = 0; k < 3; k++)
        use->m.albedo[k] = import_clamp(color[k], VIT_MAX_ALBEDO);
    if (l->metal) {
        static const float dielectric[3] = {SPECULAR_DIELECTRIC, SPECULAR_DIELECTRIC, SPECULAR_DIELECTRIC};
        float mean[4] = {1.0f, 1.0f, 1.0f, 1.0f}, own[3];
        if (l->image != THREEMF_NONE && !import_texture_mean(im, use->image, use->m.name, true, mean))
            return false;
        for (int k = 0; k < 3; k++)
            own[k] = color[k] * mean[k];
        specular_mapping_of(im->s->quality.ggx)(&use->m, color, own, dielectric, l->metallic, l->roughness);
    }
    return true;
}
