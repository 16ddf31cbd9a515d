/* One primitive (3.7.2): its attributes, and triangles by its mode. */
#include "import/gltf/gltf_file.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { POINTS, LINES, LINE_LOOP, LINE_STRIP, TRIANGLES, STRIP, FAN };

static uint32_t mode_of(const json_t *primitive) {
    uint32_t mode;
    return gltf_index(primitive, "mode", &mode) ? mode : (uint32_t)TRIANGLES;
}

static uint64_t triangles_of(uint32_t mode, uint64_t corners) {
    return mode == TRIANGLES ? corners / 3 : (mode == STRIP || mode == FAN) && corners > 2 ? corners - 2 : 0;
}

static uint64_t points_and_lines(uint32_t mode, uint64_t corners) {
    return mode == POINTS ? corners : mode == LINES ? corners / 2 : mode == LINE_LOOP ? corners : corners > 0 ? corners - 1 : 0;
}

static uint64_t corners_stated(const gltf_file *g, const json_t *primitive) {
    uint32_t index;
    if (!gltf_index(primitive, "indices", &index))
        (void)gltf_index(json_object_get(primitive, "attributes"), "POSITION", &index);
    return gltf_accessor_count(g, index);
}

uint64_t gltf_triangles_stated(const gltf_file *g, const json_t *primitive) {
    return triangles_of(mode_of(primitive), corners_stated(g, primitive));
}

/* An attribute that the primitive may have; it must be as long as the positions. */
static bool attribute(gltf_file *g, const gltf_part *part, const char *name, unsigned components, gltf_floats *out) {
    uint32_t index;
    if (!gltf_index(json_object_get(part->json, "attributes"), name, &index))
        return true;
    if (!gltf_read_floats(g, index, components, out))
        return false;
    return out->count >= part->position.count
               ? true
               : import_fail(g->im, "accessor %u has %u elements for %u vertices", index, out->count, part->position.count);
}

static bool read_attributes(gltf_file *g, gltf_part *part) {
    char name[32];
    uint32_t index;
    (void)gltf_index(json_object_get(part->json, "attributes"), "POSITION", &index);
    if (!gltf_read_floats(g, index, 3, &part->position) || !attribute(g, part, "NORMAL", 3, &part->normal) ||
        !attribute(g, part, "COLOR_0", 3, &part->color))
        return false;
    for (unsigned i = 0; i < IMPORT_UV_SETS; i++) {
        (void)snprintf(name, sizeof name, "TEXCOORD_%u", i);
        if (!attribute(g, part, name, 2, &part->uv[i]))
            return false;
    }
    for (unsigned i = 0; i < GLTF_JOINT_SETS; i++) {
        (void)snprintf(name, sizeof name, "JOINTS_%u", i);
        if (!attribute(g, part, name, 4, &part->joints[i]))
            return false;
        (void)snprintf(name, sizeof name, "WEIGHTS_%u", i);
        if (!attribute(g, part, name, 4, &part->weights[i]))
            return false;
        if (!part->joints[i].at || !part->weights[i].at)
            break;
        part->joint_sets = i + 1;
    }
    return true;
}

/* Strips turn every second triangle round. */
static bool unroll(gltf_file *g, gltf_part *part, bool fan, const uint32_t *index) {
    uint32_t *to = part->triangles <= VIT_MAX_TRIANGLES ? calloc(part->triangles + 1, 3 * sizeof *to) : NULL;
    part->corner = part->owned = to;
    if (!to)
        return import_fail(g->im, "out of memory for %zu triangles", part->triangles);
    for (size_t t = 0; t < part->triangles; t++) {
        const size_t odd = fan ? 0 : t & 1, at[3] = {fan ? 0 : t, t + 1 + odd, t + 2 - odd};
        for (int k = 0; k < 3; k++)
            *to++ = index ? index[at[k]] : (uint32_t)at[k];
    }
    return true;
}

/* 0, 1, 2, ... */
static bool count_up(gltf_file *g, gltf_part *part) {
    uint32_t *to = calloc(part->triangles + 1, 3 * sizeof *to);
    part->corner = part->owned = to;
    if (!to)
        return import_fail(g->im, "out of memory");
    for (uint32_t i = 0; i < 3 * (uint32_t)part->triangles; i++)
        to[i] = i;
    return true;
}

static bool read_corners(gltf_file *g, gltf_part *part) {
    const uint32_t mode = mode_of(part->json);
    gltf_indices index = {.count = part->position.count};
    uint32_t accessor;
    const bool indexed = gltf_index(part->json, "indices", &accessor);
    if (indexed && !gltf_read_indices(g, accessor, &index))
        return false;
    part->triangles = (size_t)triangles_of(mode, index.count);
    if (mode == TRIANGLES && indexed) {
        part->corner = index.at;
        part->owned = index.owned;
        return true;
    }
    const bool fine = mode == TRIANGLES ? count_up(g, part) : unroll(g, part, mode == FAN, index.at);
    free(index.owned);
    return fine;
}

/* Many primitives may share the vertices of all: each keeps to what is between its first and its last. Corners out of range
 * stay so. */
static bool find_range(gltf_file *g, gltf_part *part) {
    const size_t corners = 3 * part->triangles;
    uint32_t first = UINT32_MAX, last = 0;
    for (size_t i = 0; i < corners; i++)
        if (part->corner[i] < part->position.count) {
            first = part->corner[i] < first ? part->corner[i] : first;
            last = part->corner[i] > last ? part->corner[i] : last;
        }
    part->first = first <= last ? first : 0;
    part->vertices = first <= last ? last - first + 1 : 0;
    if (part->first == 0)
        return true;
    uint32_t *to = part->owned ? part->owned : calloc(corners + 1, sizeof *to);
    if (!to)
        return import_fail(g->im, "out of memory");
    for (size_t i = 0; i < corners; i++)
        to[i] = part->corner[i] < part->position.count ? part->corner[i] - first : GLTF_NONE;
    part->corner = part->owned = to;
    return true;
}

/* The file's default one comes behind those that it has. */
static bool choose_material(gltf_file *g, gltf_part *part) {
    uint32_t material;
    const bool stated = gltf_index(part->json, "material", &material);
    part->material = stated ? material : g->material_count;
    return !stated || material < g->material_count ||
           import_fail(g->im, "a primitive has material %u of %u", material, g->material_count);
}

bool gltf_read_part(gltf_file *g, const json_t *primitive, gltf_part *out) {
    const json_t *packed = gltf_extension(primitive, "KHR_draco_mesh_compression");
    const uint32_t mode = mode_of(primitive);
    uint32_t position;
    *out = (gltf_part){.json = primitive};
    if (!json_is_object(primitive))
        return import_fail(g->im, "a primitive is none");
    if (mode > FAN)
        return import_fail(g->im, "a primitive has mode %u", mode);
    if (!gltf_index(json_object_get(primitive, "attributes"), "POSITION", &position))
        return gltf_remark_once(g, GLTF_SAID_POSITIONS, "primitives without positions are left out", "");
    if (mode < TRIANGLES) {
        g->im->m->not_triangles += points_and_lines(mode, corners_stated(g, primitive));
        return true;
    }
    if (!choose_material(g, out))
        return false;
    if (!(packed ? gltf_read_draco(g, primitive, packed, out) : read_attributes(g, out) && read_corners(g, out)))
        return false;
    return find_range(g, out);
}

void gltf_drop_part(gltf_part *part) {
    gltf_floats *all[] = {&part->position, &part->normal, &part->color};
    for (size_t i = 0; i < sizeof all / sizeof *all; i++)
        gltf_drop_floats(all[i]);
    for (size_t i = 0; i < IMPORT_UV_SETS; i++)
        gltf_drop_floats(&part->uv[i]);
    for (size_t i = 0; i < GLTF_JOINT_SETS; i++) {
        gltf_drop_floats(&part->joints[i]);
        gltf_drop_floats(&part->weights[i]);
    }
    free(part->owned);
    *part = (gltf_part){0};
}
