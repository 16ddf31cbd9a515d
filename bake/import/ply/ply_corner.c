/* Texture coordinates of faces, corner by corner: where a vertex has several, it becomes several. */
#include "import/ply/ply_file.h"
#include <string.h>

/* In `next` of a vertex that no corner has used yet; VIT_NONE: it is the last of its copies. */
#define UNUSED (VIT_NONE - 1)
/* Copies that are looked through; a vertex of more coordinates gets some twice. */
enum { MOST_COPIES = 32 };

static bool make_room(ply_file *p, size_t count) {
    const bool first = !p->next;
    if (!import_room(p->im, &p->position, &p->position_room, count, 3 * sizeof *p->position) ||
        !import_room(p->im, &p->uv, &p->uv_room, count, 2 * sizeof *p->uv) ||
        !import_room(p->im, &p->next, &p->next_room, count, sizeof *p->next) ||
        (p->normal && !import_room(p->im, &p->normal, &p->normal_room, count, 3 * sizeof *p->normal)))
        return false;
    for (size_t i = 0; first && i < p->vertices; i++) {
        p->uv[2 * i] = p->uv[2 * i + 1] = 0.0f;
        p->next[i] = UNUSED;
    }
    return true;
}

static bool add_copy(ply_file *p, uint32_t of, const float uv[2], uint32_t *out) {
    const size_t at = p->vertices;
    if (p->vertices >= UNUSED - 1)
        return import_fail(p->im, "has more vertices than 2^32 - 3");
    if (!make_room(p, at + 1))
        return false;
    memcpy(p->position + 3 * at, p->position + 3 * (size_t)of, 3 * sizeof *p->position);
    if (p->normal)
        memcpy(p->normal + 3 * at, p->normal + 3 * (size_t)of, 3 * sizeof *p->normal);
    memcpy(p->uv + 2 * at, uv, 2 * sizeof *uv);
    p->next[at] = p->next[of];
    p->next[of] = *out = p->vertices++;
    return true;
}

bool ply_corner(ply_file *p, uint32_t v, const float uv[2], uint32_t *out) {
    if (!p->next && !make_room(p, p->vertices))
        return false;
    *out = v;
    if (p->next[v] == UNUSED) {
        memcpy(p->uv + 2 * (size_t)v, uv, 2 * sizeof *uv);
        p->next[v] = VIT_NONE;
        return true;
    }
    for (int i = 0; i < MOST_COPIES && *out != VIT_NONE; i++, *out = p->next[*out])
        if (memcmp(p->uv + 2 * (size_t)*out, uv, 2 * sizeof *uv) == 0)
            return true;
    return add_copy(p, v, uv, out);
}
