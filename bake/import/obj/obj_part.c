/* Parts as the baker places them: of each the vertices that it uses, each combination of position, texture coordinate and
 * normal once, in the order of the faces. */
#include "import/obj/obj_file.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct vertex {
    uint32_t position, uv, normal;
    uint32_t next; /* of the same position, or OBJ_NONE */
} vertex;

/* What a part becomes; memory is kept for the next. */
typedef struct placing {
    obj_file *o;
    uint32_t *first; /* a position of the file: its first vertex, or OBJ_NONE */
    vertex *vertex;
    float *position, *normal, *color, *uv; /* of those vertices */
    uint32_t *corner, *smoothing;          /* of the triangles */
    size_t vertices, triangles;
    size_t vertex_room, position_room, normal_room, color_room, uv_room, corner_room, smoothing_room;
} placing;

void obj_count_triangles(const obj_file *o, uint64_t *of_material) {
    for (size_t i = 0; i < o->parts; i++) {
        const uint32_t material = o->part[i].material;
        of_material[material == OBJ_NONE ? o->materials.count : material] += o->part[i].triangles;
    }
}

/* Corner `c` of the file as a vertex of the part. */
static bool find_vertex(placing *p, size_t c, uint32_t *out) {
    const obj_file *o = p->o;
    const vertex want = {.position = o->corner[c],
                         .uv = o->corner_uv ? o->corner_uv[c] : OBJ_NONE,
                         .normal = o->corner_normal ? o->corner_normal[c] : OBJ_NONE,
                         .next = p->first[o->corner[c]]};
    for (uint32_t i = want.next; i != OBJ_NONE; i = p->vertex[i].next)
        /* `first` has vertices that are there. NOLINTNEXTLINE(clang-analyzer-core.NullDereference) */
        if (p->vertex[i].uv == want.uv && p->vertex[i].normal == want.normal) {
            *out = i;
            return true;
        }
    if (!import_room(o->im, &p->vertex, &p->vertex_room, p->vertices + 1, sizeof *p->vertex) ||
        !import_room(o->im, &p->position, &p->position_room, p->vertices + 1, 3 * sizeof *p->position))
        return false;
    p->vertex[p->vertices] = want;
    memcpy(p->position + 3 * p->vertices, o->position + 3 * (size_t)want.position, 3 * sizeof *p->position);
    *out = p->first[want.position] = (uint32_t)p->vertices++;
    return true;
}

static bool is_bad(const uint32_t *list, size_t c, size_t count) {
    return list && list[c] != OBJ_NONE && list[c] >= count;
}

static bool in_range(const obj_file *o, size_t corner, unsigned count) {
    for (size_t c = corner; c < corner + count; c++)
        if (o->corner[c] >= o->positions || is_bad(o->corner_uv, c, o->uvs) || is_bad(o->corner_normal, c, o->normals))
            return false;
    return true;
}

static void cut(const placing *p, const uint32_t *local, unsigned count) {
    const mesh_floats position = {p->position, 3};
    uint32_t *to = p->corner + 3 * p->triangles;
    import_cut_polygon(&position, local, count, to);
    for (unsigned k = 0; k < 3 * (count - 2); k++)
        to[k] = local[to[k]];
}

/* The face's triangles; those of a corner that leads nowhere are dropped. */
static bool add_face(placing *p, size_t face, size_t corner) {
    const obj_file *o = p->o;
    const unsigned count = o->face[face];
    uint32_t local[IMPORT_CORNERS];
    if (!in_range(o, corner, count)) {
        *(count == 3 ? &o->im->bad_index : &o->im->bad_polygon) += 1;
        return true;
    }
    for (unsigned k = 0; k < count; k++)
        if (!find_vertex(p, corner + k, &local[k]))
            return false;
    const size_t triangles = p->triangles + count - 2;
    if (!import_room(o->im, &p->corner, &p->corner_room, triangles, 3 * sizeof *p->corner) ||
        (o->smoothing && !import_room(o->im, &p->smoothing, &p->smoothing_room, triangles, sizeof *p->smoothing)))
        return false;
    if (count == 3)
        memcpy(p->corner + 3 * p->triangles, local, 3 * sizeof *local);
    else
        cut(p, local, count);
    for (; p->triangles < triangles; p->triangles++)
        if (o->smoothing)
            p->smoothing[p->triangles] = o->smoothing[face];
    return true;
}

/* Element `index` of a list of the file, or zeros. */
static void take(const float *list, uint32_t index, size_t size, float *to) {
    if (index == OBJ_NONE)
        memset(to, 0, size * sizeof *to);
    else
        memcpy(to, list + size * index, size * sizeof *to);
}

/* Attributes beside the position, where the part has them. */
static bool gather(placing *p, const obj_part *part) {
    obj_file *o = p->o;
    if ((part->normals && !import_room(o->im, &p->normal, &p->normal_room, p->vertices, 3 * sizeof *p->normal)) ||
        (o->colors > 0 && !import_room(o->im, &p->color, &p->color_room, p->vertices, 3 * sizeof *p->color)) ||
        (o->corner_uv && !import_room(o->im, &p->uv, &p->uv_room, p->vertices, 2 * sizeof *p->uv)))
        return false;
    for (size_t i = 0; i < p->vertices; i++) {
        const vertex *v = &p->vertex[i];
        p->first[v->position] = OBJ_NONE; /* for the next part */
        if (part->normals)
            take(o->normal, v->normal, 3, p->normal + 3 * i);
        if (o->colors > 0)
            take(o->color, v->position, 3, p->color + 3 * i);
        if (o->corner_uv)
            take(o->uv, v->uv, 2, p->uv + 2 * i);
    }
    return true;
}

static bool has_uv(const placing *p) {
    for (size_t i = 0; i < p->vertices; i++)
        if (p->vertex[i].uv != OBJ_NONE)
            return true;
    return false;
}

static bool place_part(placing *p, size_t index, const double world[12]) {
    obj_file *o = p->o;
    const obj_part *part = &o->part[index];
    const size_t end = index + 1 < o->parts ? part[1].face : o->faces;
    const obj_text mesh = o->meshes.name[part->mesh];
    char name[SCENE_NAME];
    p->vertices = p->triangles = 0;
    for (size_t f = part->face, c = part->corner; f < end; c += o->face[f++])
        if (!add_face(p, f, c))
            return false;
    if (p->triangles == 0)
        return true;
    if (!gather(p, part))
        return false;
    (void)snprintf(name, sizeof name, "%.*s", obj_size(mesh, SCENE_NAME - 1), mesh.at);
    const mesh_part out = {.name = name,
                           .vertices = (uint32_t)p->vertices,
                           .position = {p->position, 3},
                           .normal = {part->normals ? p->normal : NULL, 3},
                           .color = {o->colors > 0 ? p->color : NULL, 3},
                           .uv = {{has_uv(p) ? p->uv : NULL, 2}},
                           .v_up = true,
                           .corner = p->corner,
                           .smoothing = o->smoothing ? p->smoothing : NULL,
                           .triangles = p->triangles,
                           .material = part->material == OBJ_NONE ? (unsigned)o->materials.count : part->material};
    return import_place(o->im, part->mesh, &out, world);
}

static void drop(placing *p) {
    free(p->first);
    free(p->vertex);
    free(p->position);
    free(p->normal);
    free(p->color);
    free(p->uv);
    free(p->corner);
    free(p->smoothing);
}

static void count_meshes(obj_file *o) {
    for (size_t i = 0; i < o->meshes.count; i++) {
        const obj_text mesh = o->meshes.name[i];
        char name[SCENE_NAME];
        (void)snprintf(name, sizeof name, "%.*s", obj_size(mesh, SCENE_NAME - 1), mesh.at);
        import_count_place(o->im, i, name);
    }
}

bool obj_place(obj_file *o, const double world[12]) {
    placing p = {.o = o, .first = malloc((o->positions + 1) * sizeof *p.first)};
    bool fine = true;
    if (!p.first)
        return import_fail(o->im, "out of memory");
    memset(p.first, 0xff, (o->positions + 1) * sizeof *p.first); /* OBJ_NONE */
    count_meshes(o);
    for (size_t i = 0; fine && i < o->parts; i++)
        fine = place_part(&p, i, world);
    drop(&p);
    return fine;
}
