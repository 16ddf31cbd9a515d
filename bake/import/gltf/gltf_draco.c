/* KHR_draco_mesh_compression: indices and attributes come out of one block of bytes (gltf_draco_decode.cc). */
#include "import/gltf/gltf_draco_decode.h"
#include "import/gltf/gltf_file.h"
#include <stdio.h>
#include <stdlib.h>

static bool take(gltf_file *g, const draco_block *block, const gltf_part *part, const json_t *ids, const char *name,
                 unsigned components, gltf_floats *out) {
    uint32_t id, accessor;
    const uint32_t points = draco_points(block);
    if (!gltf_index(json_object_get(part->json, "attributes"), name, &accessor))
        return true;
    if (!gltf_index(ids, name, &id)) { /* not in the block: an accessor like any other */
        if (!gltf_read_floats(g, accessor, components, out))
            return false;
        return out->count >= points
                   ? true
                   : import_fail(g->im, "accessor %u has %u elements for %u vertices", accessor, out->count, points);
    }
    const unsigned stored = draco_components(block, id);
    double *values = stored >= components && stored <= 4 ? calloc((size_t)points + 1, stored * sizeof *values) : NULL;
    float *to = calloc((size_t)points + 1, (stored ? stored : 1) * sizeof *to);
    const bool fine = values && to && draco_values(block, id, values);
    for (size_t i = 0; fine && i < (size_t)points * stored; i++)
        to[i] = gltf_normalized(g, accessor, values[i]);
    free(values);
    *out = (gltf_floats){.at = to, .owned = to, .count = points, .components = stored, .stride = stored};
    return fine ? true : import_fail(g->im, "Draco's block has no %s that could be", name);
}

static bool take_all(gltf_file *g, const draco_block *block, const json_t *ids, gltf_part *out) {
    char name[32];
    if (!take(g, block, out, ids, "POSITION", 3, &out->position) || !take(g, block, out, ids, "NORMAL", 3, &out->normal) ||
        !take(g, block, out, ids, "COLOR_0", 3, &out->color))
        return false;
    for (unsigned i = 0; i < IMPORT_UV_SETS; i++) {
        (void)snprintf(name, sizeof name, "TEXCOORD_%u", i);
        if (!take(g, block, out, ids, name, 2, &out->uv[i]))
            return false;
    }
    for (unsigned i = 0; i < GLTF_JOINT_SETS; i++) {
        (void)snprintf(name, sizeof name, "JOINTS_%u", i);
        if (!take(g, block, out, ids, name, 4, &out->joints[i]))
            return false;
        (void)snprintf(name, sizeof name, "WEIGHTS_%u", i);
        if (!take(g, block, out, ids, name, 4, &out->weights[i]))
            return false;
        if (!out->joints[i].at || !out->weights[i].at)
            break;
        out->joint_sets = i + 1;
    }
    return true;
}

bool gltf_read_draco(gltf_file *g, const json_t *primitive, const json_t *how, gltf_part *out) {
    const uint8_t *at;
    size_t size, stride;
    uint32_t view;
    out->json = primitive;
    (void)gltf_index(how, "bufferView", &view);
    if (!gltf_view(g, view, &at, &size, &stride))
        return false;
    draco_block *block = draco_open(at, size);
    if (!block)
        return import_fail(g->im, "buffer view %u: Draco's block cannot be read", view);
    bool fine = take_all(g, block, json_object_get(how, "attributes"), out);
    const uint32_t faces = draco_faces(block);
    if (fine) {
        out->corner = out->owned = calloc((size_t)faces + 1, 3 * sizeof *out->owned);
        out->triangles = out->owned ? faces : 0;
        fine = out->owned ? true : import_fail(g->im, "out of memory");
    }
    if (fine)
        draco_corners(block, out->owned);
    draco_close(block);
    return fine;
}
