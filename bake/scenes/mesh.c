#include "mesh.h"
#include "scenes.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>

void mesh_init(mesh *m) {
    *m = (mesh){.frame = mesh_frame_at(v3_of(0, 0, 0), 0)};
}

void mesh_free(mesh *m) {
    free(m->vertices);
    free(m->indices);
    free(m->groups);
    mesh_init(m);
}

mesh_frame mesh_frame_at(v3 o, int quarters) {
    static const v3 axis[4] = {{1, 0, 0}, {0, 0, -1}, {-1, 0, 0}, {0, 0, 1}};
    return (mesh_frame){.o = o, .x = axis[quarters & 3], .y = {0, 1, 0}, .z = axis[(quarters + 3) & 3]};
}

/* Makes room for one more element; doubling keeps this linear. */
static bool room(mesh *m, void **list, size_t *have, size_t count, size_t size) {
    if (m->full || count < *have)
        return !m->full;
    size_t want = *have ? *have * 2 : 1024;
    void *grown = want > SIZE_MAX / size ? NULL : realloc(*list, want * size);
    if (!grown) {
        m->full = true;
        return false;
    }
    *list = grown;
    *have = want;
    return true;
}

void mesh_group_begin(mesh *m, const char *object, const char *material) {
    void *list = m->groups;
    if (room(m, &list, &m->group_room, m->group_count, sizeof *m->groups)) {
        m->groups = list;
        m->groups[m->group_count++] = (mesh_group){.object = object, .material = material, .first = m->triangle_count};
    }
}

static v3 turned(const mesh_frame *f, v3 p) {
    return v3_add(v3_add(v3_scale(f->x, p.x), v3_scale(f->y, p.y)), v3_scale(f->z, p.z));
}

/* Adding 0 turns -0, which would be printed as -0.00000, into 0. */
static double rounded(double x) {
    return floor(x * 1e5 + 0.5) / 1e5 + 0.0;
}

uint32_t mesh_vertex(mesh *m, vertex v) {
    void *list = m->vertices;
    if (m->vertex_count >= UINT32_MAX)
        m->full = true;
    if (!room(m, &list, &m->vertex_room, m->vertex_count, sizeof *m->vertices))
        return 0;
    m->vertices = list;
    v3 p = v3_add(m->frame.o, turned(&m->frame, v.p));
    v.p = v3_of(rounded(p.x), rounded(p.y), rounded(p.z));
    v.n = v3_unit(turned(&m->frame, v.n));
    m->vertices[m->vertex_count] = v;
    return (uint32_t)m->vertex_count++;
}

void mesh_triangle(mesh *m, uint32_t a, uint32_t b, uint32_t c) {
    if (m->full)
        return;
    const vertex *v = m->vertices;
    v3 n = v3_cross(v3_sub(v[b].p, v[a].p), v3_sub(v[c].p, v[a].p));
    if (v3_dot(n, n) < 1e-16) /* sides of 0.1 mm */
        return;
    bool flipped = v3_dot(n, v3_add(v3_add(v[a].n, v[b].n), v[c].n)) < 0.0;
    void *list = m->indices;
    if (!room(m, &list, &m->triangle_room, m->triangle_count, 3 * sizeof *m->indices))
        return;
    m->indices = list;
    uint32_t *to = m->indices + 3 * m->triangle_count++;
    to[0] = a;
    to[1] = flipped ? c : b;
    to[2] = flipped ? b : c;
}

static FILE *create(const char *dir, const char *name, const char *extension) {
    char path[SCENES_PATH];
    if (!scenes_path(path, dir, name, extension))
        return NULL;
    return fopen(path, "wb");
}

static bool close_written(FILE *f) {
    bool good = !ferror(f);
    return fclose(f) == 0 && good;
}

static bool write_obj(const mesh *m, FILE *f, const char *name) {
    fprintf(f, "# %s: made by make-scenes\nmtllib %s.mtl\n", name, name);
    for (size_t i = 0; i < m->vertex_count; i++) {
        const vertex *v = m->vertices + i;
        fprintf(f, "v %.5f %.5f %.5f\nvt %.5f %.5f\nvn %.4f %.4f %.4f\n", v->p.x, v->p.y, v->p.z, v->u, v->v, v->n.x, v->n.y,
                v->n.z);
    }
    for (size_t g = 0; g < m->group_count; g++) {
        size_t end = g + 1 < m->group_count ? m->groups[g + 1].first : m->triangle_count;
        if (end == m->groups[g].first)
            continue;
        fprintf(f, "o %s\nusemtl %s\n", m->groups[g].object, m->groups[g].material);
        for (size_t t = m->groups[g].first; t < end; t++) {
            const uint32_t *i = m->indices + 3 * t;
            fprintf(f, "f %u/%u/%u %u/%u/%u %u/%u/%u\n", i[0] + 1, i[0] + 1, i[0] + 1, i[1] + 1, i[1] + 1, i[1] + 1, i[2] + 1,
                    i[2] + 1, i[2] + 1);
        }
    }
    return close_written(f);
}

bool mesh_write(const mesh *m, const char *dir, const char *name, const mesh_material *materials, size_t material_count) {
    if (m->full) {
        errno = ENOMEM;
        return false;
    }
    FILE *obj = create(dir, name, ".obj");
    if (!obj || !write_obj(m, obj, name))
        return false;
    FILE *mtl = create(dir, name, ".mtl");
    if (!mtl)
        return false;
    for (size_t i = 0; i < material_count; i++) {
        const mesh_material *k = materials + i;
        fprintf(mtl, "newmtl %s\nKd %.4f %.4f %.4f\n", k->name, k->color[0], k->color[1], k->color[2]);
        if (k->texture)
            fprintf(mtl, "map_Kd %s\n", k->texture);
    }
    return close_written(mtl);
}
