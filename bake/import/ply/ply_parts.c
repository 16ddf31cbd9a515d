/* The triangles as parts of one texture and colour each, and what their materials are. */
#include "common/strict_math.h"
#include "import/ply/ply_file.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Linear. Integers are sRGB, as the programs that write them show them; floats are taken as they are. */
static void linear(const ply_color *c, float out[3]) {
    const bool encoded = c->type != PLY_FLOAT && c->type != PLY_DOUBLE;
    for (int k = 0; k < 3; k++) {
        const double value = c->value[k] / ply_most(c->type), within = value > 0.0 ? (value < 1.0 ? value : 1.0) : 0.0;
        out[k] = (float)(encoded ? srgb_linear(within) : within);
    }
}

/* The colour of triangles with this key, if they have one and it is shown. A texture is what a model looks like: colours
 * beside it are left, as in MeshLab. */
static bool color_of(ply_file *p, uint32_t key, float out[3], bool *there) {
    const bool textured = (key & 0xffff) < p->texture_count;
    const ply_color *c = key >> 16 ? &p->colors[key >> 16] : &p->color;
    *there = !textured && c->there && !c->varies;
    if (*there)
        linear(c, out);
    if (textured || !c->varies || p->said_color)
        return true;
    p->said_color = true;
    return import_not_done(p->im, "vertex colours that vary over a mesh are left out");
}

static bool place_part(ply_file *p, uint32_t key, const uint32_t *corner, size_t triangles, const double world[12]) {
    float color[3];
    bool has_color;
    if (!color_of(p, key, color, &has_color))
        return false;
    const mesh_part part = {.name = p->im->placed[0].name,
                            .vertices = p->vertices,
                            .position = {p->position, 3},
                            .normal = {p->normal, 3},
                            .color = {has_color ? color : NULL, 0},
                            .uv = {{p->uv, 2}},
                            .v_up = true,
                            .corner = corner,
                            .triangles = triangles,
                            .material = key & 0xffff};
    if (p->vertices == 0)
        p->im->bad_index += triangles;
    return import_place(p->im, 0, &part, world);
}

/* Keys of triangles that look alike become the same. Whether all are. */
static bool settle_keys(ply_file *p) {
    bool same = true;
    for (size_t i = 0; p->key && i < p->triangles; i++) {
        if (p->more_colors || (p->key[i] & 0xffff) < p->texture_count)
            p->key[i] &= 0xffff;
        same = same && p->key[i] == p->key[0];
    }
    return same;
}

static int by_value(const void *left, const void *right) {
    const uint64_t a = *(const uint64_t *)left, b = *(const uint64_t *)right;
    return (a > b) - (a < b);
}

/* By key, and as they stand in the file. */
static bool place_sorted(ply_file *p, uint64_t *order, uint32_t *corner, const double world[12]) {
    for (size_t i = 0; i < p->triangles; i++)
        order[i] = (uint64_t)p->key[i] << 32 | i;
    qsort(order, p->triangles, sizeof *order, by_value);
    for (size_t i = 0; i < p->triangles; i++)
        memcpy(corner + 3 * i, ply_corners(p) + 3 * (size_t)(uint32_t)order[i], 3 * sizeof *corner);
    for (size_t first = 0, end; first < p->triangles; first = end) {
        for (end = first + 1; end < p->triangles && order[end] >> 32 == order[first] >> 32; end++)
            ;
        if (!place_part(p, (uint32_t)(order[first] >> 32), corner + 3 * first, end - first, world))
            return false;
    }
    return true;
}

bool ply_place(ply_file *p, const double world[12]) {
    if (!import_begin_meshes(p->im, 1))
        return false;
    import_count_file(p->im, 0);
    if (p->more_colors &&
        !import_not_done(p->im, "colours of faces, of which there are more than %d, are left out", PLY_COLORS - 1))
        return false;
    if (settle_keys(p))
        return p->triangles == 0 || place_part(p, p->key ? p->key[0] : 0, ply_corners(p), p->triangles, world);
    uint64_t *order = malloc(p->triangles * sizeof *order);
    uint32_t *corner = malloc(p->triangles * 3 * sizeof *corner);
    const bool fine = order && corner ? place_sorted(p, order, corner, world) : import_fail(p->im, "out of memory");
    free(order);
    free(corner);
    return fine;
}

bool ply_material(importer *im, material_use *use) {
    const ply_file *p = im->reader;
    const char *texture = use->source < p->texture_count ? p->textures[use->source] : "";
    (void)snprintf(use->m.name, sizeof use->m.name, "%.*s", SCENE_NAME - 1, *texture ? texture : "default");
    (void)snprintf(use->image, sizeof use->image, "%s", texture);
    memcpy(use->m.albedo, use->tint, sizeof use->m.albedo);
    return true;
}
