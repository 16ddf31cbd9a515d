/* Where the build puts objects (Core 3.4.3, 4.2), and their triangles as parts of one material each. */
#include "import/3mf/threemf_file.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define MOST_MORE (1u << 20) /* places than objects */

/* ---- the build ---- */

static bool add_place(threemf_file *f, threemf_object *o, const double world[12]) {
    if (f->place_count >= f->object_count + MOST_MORE)
        return import_fail(f->im, "components make more than %u places", MOST_MORE);
    if (!import_room(f->im, &f->places, &f->place_room, f->place_count + 1, sizeof *f->places))
        return false;
    threemf_place *p = &f->places[f->place_count];
    memcpy(p->world, world, sizeof p->world);
    p->next = o->first_place;
    o->first_place = (uint32_t)f->place_count++;
    o->places++;
    return true;
}

static bool visit(threemf_file *f, const threemf_child *child, uint32_t from, const double above[12], int depth) {
    const threemf_resource *r = threemf_find(f, child->part, child->id);
    const double ratio = f->parts[child->part].unit / f->parts[from].unit;
    double own[12], world[12];
    if (!r || r->kind != THREEMF_OBJECT) { /* trimesh writes such for nodes without a mesh */
        f->missing_id = f->missing++ ? f->missing_id : child->id;
        return true;
    }
    threemf_object *o = &f->objects[r->index];
    if (o->open || depth > IMPORT_DEPTH)
        return import_fail(
            f->im, o->open ? "object %u is a component of itself" : "components are nested too deeply: object %u", child->id);
    if (o->left_out) {
        f->supports++;
        return true;
    }
    for (int i = 0; i < 12; i++) /* the place is in units of the file that says it */
        own[i] = i % 4 < 3 ? child->transform[i] * ratio : child->transform[i];
    import_multiply(above, own, world);
    if (!add_place(f, o, world))
        return false;
    o->open = true;
    for (size_t i = 0; i < o->children; i++)
        if (!visit(f, &f->children[o->first_child + i], child->part, world, depth + 1))
            return false;
    o->open = false;
    return true;
}

/* The list of each object's places is the other way round. */
static void turn_lists(threemf_file *f) {
    for (size_t i = 0; i < f->object_count; i++) {
        uint32_t turned = THREEMF_NONE;
        for (uint32_t at = f->objects[i].first_place, next; at != THREEMF_NONE; at = next) {
            next = f->places[at].next;
            f->places[at].next = turned;
            turned = at;
        }
        f->objects[i].first_place = turned;
    }
}

bool threemf_find_places(threemf_file *f, const double stand[12]) {
    for (size_t i = 0; i < f->item_count; i++)
        if (!visit(f, &f->items[i], 0, stand, 0))
            return false;
    turn_lists(f);
    if (f->missing > 0 &&
        !import_not_done(f->im, "%llu items and components lead to no object (%u is the first): they are left out",
                         (unsigned long long)f->missing, f->missing_id))
        return false;
    if (f->supports > 0 && !import_not_done(f->im, "%llu objects that are supports or of type 'other' are left out",
                                            (unsigned long long)f->supports))
        return false;
    return f->not_printed == 0 || import_not_done(f->im, "%llu items of the build that are not to be printed are left out",
                                                  (unsigned long long)f->not_printed);
}

/* ---- parts ---- */

typedef struct vertex {
    uint32_t at, key;
    uint32_t next; /* of the same position, or THREEMF_NONE */
} vertex;

/* The vertices that a part uses, each with each key once; memory is kept for the next part. */
typedef struct parting {
    threemf_file *f;
    threemf_object *o;
    uint64_t *order; /* triangles: look << 32 | index */
    uint32_t *first; /* of a position: its first vertex, or THREEMF_NONE */
    vertex *vertex;
    float *position, *uv;
    uint32_t *corner;
    size_t vertices, vertex_room, position_room, uv_room;
} parting;

/* A corner that leads nowhere leads nowhere in the part, too. */
static bool find_vertex(parting *p, uint32_t at, uint32_t key, uint32_t *out) {
    *out = THREEMF_NONE;
    if (at >= p->o->vertices)
        return true;
    for (uint32_t i = p->first[at]; i != THREEMF_NONE; i = p->vertex[i].next)
        if (p->vertex[i].key == key) {
            *out = i;
            return true;
        }
    if (!import_room(p->f->im, &p->vertex, &p->vertex_room, p->vertices + 1, sizeof *p->vertex) ||
        !import_room(p->f->im, &p->position, &p->position_room, p->vertices + 1, 3 * sizeof *p->position) ||
        !import_room(p->f->im, &p->uv, &p->uv_room, p->vertices + 1, 2 * sizeof *p->uv))
        return false;
    p->vertex[p->vertices] = (vertex){at, key, p->first[at]};
    memcpy(p->position + 3 * p->vertices, p->o->position + 3 * (size_t)at, 3 * sizeof *p->position);
    *out = p->first[at] = (uint32_t)p->vertices++;
    return true;
}

static bool place_part(threemf_file *f, const threemf_object *o, const mesh_part *part) {
    for (uint32_t at = o->first_place; at != THREEMF_NONE; at = f->places[at].next)
        if (!import_place(f->im, (size_t)(o - f->objects), part, f->places[at].world))
            return false;
    return true;
}

static bool gather(parting *p, size_t begin, size_t end) {
    const threemf_look *l = &p->f->looks[p->order[begin] >> 32];
    p->vertices = 0;
    for (size_t i = begin; i < end; i++) {
        const size_t t = (uint32_t)p->order[i];
        for (size_t k = 0; k < 3; k++)
            if (!find_vertex(p, p->o->corner[3 * t + k], l->keyed ? p->o->ref[t].p[k] : 0, &p->corner[3 * (i - begin) + k]))
                return false;
    }
    for (size_t i = 0; i < p->vertices; i++) {
        const vertex *v = &p->vertex[i];
        p->first[v->at] = THREEMF_NONE; /* for the next part */
        if (l->keyed && l->group == THREEMF_NONE)
            threemf_paint_uv(p->f, v->key, p->uv + 2 * i);
        else if (l->keyed)
            memcpy(p->uv + 2 * i, p->f->uv + 2 * (size_t)(p->f->groups[l->group].first + v->key), 2 * sizeof *p->uv);
    }
    return true;
}

static int by_value(const void *left, const void *right) {
    const uint64_t a = *(const uint64_t *)left, b = *(const uint64_t *)right;
    return (a > b) - (a < b);
}

/* By look, and as they stand in the file. */
static bool place_looks(parting *p, const char *name) {
    const threemf_object *o = p->o;
    for (size_t i = 0; i < o->triangles; i++)
        p->order[i] = (uint64_t)o->ref[i].pid << 32 | i;
    qsort(p->order, o->triangles, sizeof *p->order, by_value);
    for (size_t begin = 0, end; begin < o->triangles; begin = end) {
        for (end = begin + 1; end < o->triangles && p->order[end] >> 32 == p->order[begin] >> 32; end++)
            ;
        if (!gather(p, begin, end))
            return false;
        const threemf_look *l = &p->f->looks[p->order[begin] >> 32];
        const mesh_part part = {.name = name,
                                .vertices = (uint32_t)p->vertices,
                                .position = {p->position, 3},
                                .uv = {{l->keyed ? p->uv : NULL, 2}},
                                .v_up = l->group != THREEMF_NONE,
                                .corner = p->corner,
                                .triangles = end - begin,
                                .material = (unsigned)(p->order[begin] >> 32)};
        if (p->vertices == 0)
            p->f->im->bad_index += part.triangles * o->places;
        if (!place_part(p->f, o, &part))
            return false;
    }
    return true;
}

static bool place_parts(threemf_file *f, threemf_object *o, const char *name) {
    parting p = {.f = f, .o = o};
    p.order = malloc(o->triangles * sizeof *p.order);
    p.first = malloc((o->vertices + 1) * sizeof *p.first);
    p.corner = malloc(3 * o->triangles * sizeof *p.corner);
    if (p.first)
        memset(p.first, 0xff, (o->vertices + 1) * sizeof *p.first); /* THREEMF_NONE */
    const bool fine = p.order && p.first && p.corner ? place_looks(&p, name) : import_fail(f->im, "out of memory");
    void *const all[] = {p.order, p.first, p.corner, p.vertex, p.position, p.uv};
    for (size_t i = 0; i < sizeof all / sizeof *all; i++)
        free(all[i]);
    return fine;
}

static void name_of(const threemf_file *f, const threemf_object *o, char name[SCENE_NAME]) {
    if (o->name != THREEMF_NONE)
        (void)snprintf(name, SCENE_NAME, "%s", f->text + o->name);
    else
        (void)snprintf(name, SCENE_NAME, "object %u", o->id);
}

static bool place_object(threemf_file *f, threemf_object *o) {
    char name[SCENE_NAME];
    name_of(f, o, name);
    for (uint64_t i = 0; i < o->places; i++)
        import_count_place(f->im, (size_t)(o - f->objects), name);
    if (o->vertices == 0)
        f->im->bad_index += o->triangles * o->places;
    if (o->ref)
        return place_parts(f, o, name);
    const mesh_part part = {.name = name,
                            .vertices = (uint32_t)o->vertices,
                            .position = {o->position, 3},
                            .corner = o->corner,
                            .triangles = o->triangles,
                            .material = o->look};
    return place_part(f, o, &part);
}

bool threemf_place_all(threemf_file *f) {
    if (!import_begin_meshes(f->im, f->object_count))
        return false;
    for (size_t i = 0; i < f->object_count; i++) {
        threemf_object *o = &f->objects[i];
        if (o->places > 0 && o->triangles > 0 && !place_object(f, o))
            return false;
        free(o->position);
        free(o->corner);
        free(o->ref);
        o->position = NULL;
        o->corner = NULL;
        o->ref = NULL;
    }
    return true;
}
