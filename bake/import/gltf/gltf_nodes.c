/* The tree of nodes (3.5), in which nothing is its own ancestor. */
#include "import/gltf/gltf_file.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define MOST_MORE (1u << 20) /* places than nodes */

void gltf_compose(const double t[3], const double r[4], const double s[3], double out[12]) {
    const double length = sqrt(r[0] * r[0] + r[1] * r[1] + r[2] * r[2] + r[3] * r[3]);
    const bool turned = length > 0.0 && isfinite(length);
    const double x = turned ? r[0] / length : 0.0, y = turned ? r[1] / length : 0.0;
    const double z = turned ? r[2] / length : 0.0, w = turned ? r[3] / length : 1.0;
    const double turn[9] = {1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - z * w),       2.0 * (x * z + y * w),
                            2.0 * (x * y + z * w),       1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - x * w),
                            2.0 * (x * z - y * w),       2.0 * (y * z + x * w),       1.0 - 2.0 * (x * x + y * y)};
    for (int i = 0; i < 3; i++) {
        for (int k = 0; k < 3; k++)
            out[4 * i + k] = turn[3 * i + k] * s[k];
        out[4 * i + 3] = t[i];
    }
}

static void own_matrix(const json_t *node, double out[12]) {
    double m[16], t[3] = {0.0, 0.0, 0.0}, r[4] = {0.0, 0.0, 0.0, 1.0}, s[3] = {1.0, 1.0, 1.0};
    if (gltf_numbers(node, "matrix", m, 16)) { /* by columns */
        for (int i = 0; i < 12; i++)
            out[i] = m[4 * (i % 4) + i / 4];
        return;
    }
    (void)gltf_numbers(node, "translation", t, 3);
    (void)gltf_numbers(node, "rotation", r, 4);
    (void)gltf_numbers(node, "scale", s, 3);
    gltf_compose(t, r, s, out);
}

static bool read_node(gltf_file *g, uint32_t i) {
    gltf_node *node = &g->nodes[i];
    node->place = GLTF_NONE;
    node->json = gltf_item(g, "nodes", i);
    if (!node->json)
        return import_fail(g->im, "node %u is none", i);
    const char *name = gltf_text(node->json, "name", "");
    if (*name)
        (void)snprintf(node->name, sizeof node->name, "%.*s", SCENE_NAME - 1, name);
    else
        (void)snprintf(node->name, sizeof node->name, "nodes[%u]", i);
    return true;
}

/* Nodes that a list of children or of a scene names; GLTF_NONE: not one of the file's. */
static uint32_t named(const gltf_file *g, const json_t *list, size_t i) {
    const json_t *value = json_array_get(list, i);
    const double number = json_is_number(value) ? json_number_value(value) : -1.0;
    return number >= 0.0 && number < (double)g->node_count && number == floor(number) ? (uint32_t)number : GLTF_NONE;
}

static const json_t *children_of(const gltf_file *g, uint32_t node) {
    return json_object_get(g->nodes[node].json, "children");
}

static bool find_children(gltf_file *g) {
    for (uint32_t i = 0; i < g->node_count; i++)
        for (size_t k = 0; k < json_array_size(children_of(g, i)); k++) {
            const uint32_t child = named(g, children_of(g, i), k);
            if (child == GLTF_NONE)
                return import_fail(g->im, "node %u has a child that is no node", i);
            g->nodes[child].is_child = true;
        }
    return true;
}

static bool add_place(gltf_file *g, uint32_t node, uint32_t above) {
    static const double identity[12] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
    double own[12];
    if (g->place_count >= g->node_count + MOST_MORE)
        return import_fail(g->im, "nodes that are children of several make more than %u places", MOST_MORE);
    if (!import_room(g->im, &g->places, &g->place_room, g->place_count + 1, sizeof *g->places))
        return false;
    gltf_place *place = &g->places[g->place_count];
    *place = (gltf_place){.node = node, .above = above};
    own_matrix(g->nodes[node].json, own);
    import_multiply(above == GLTF_NONE ? identity : g->places[above].world, own, place->world);
    if (g->nodes[node].place == GLTF_NONE)
        g->nodes[node].place = (uint32_t)g->place_count;
    g->place_count++;
    return true;
}

/* A node on the way down, and how many of its children have been there. */
typedef struct step {
    uint32_t node, place;
    size_t child;
} step;

/* Places for `root` and all below, parents first, depth first. A node may have several parents, which glTF does not allow and
 * some files have for instances: it has a place below each. */
static bool walk(gltf_file *g, uint32_t root, step *way) {
    size_t depth = 1;
    if (!add_place(g, root, GLTF_NONE))
        return false;
    way[0] = (step){.node = root, .place = (uint32_t)g->place_count - 1};
    g->nodes[root].on_way = true;
    while (depth > 0) {
        step *at = &way[depth - 1];
        if (at->child == json_array_size(children_of(g, at->node))) {
            g->nodes[at->node].on_way = false;
            depth--;
            continue;
        }
        const uint32_t child = named(g, children_of(g, at->node), at->child++);
        if (g->nodes[child].on_way)
            return import_fail(g->im, "node %u is among its own ancestors", child);
        if (!add_place(g, child, at->place))
            return false;
        way[depth++] = (step){.node = child, .place = (uint32_t)g->place_count - 1};
        g->nodes[child].on_way = true;
    }
    return true;
}

/* Of the file's scene, or else of its first. Some exporters name children as well, which are there by way of their parents. */
static bool walk_scene(gltf_file *g, uint32_t scene_index, step *way) {
    const json_t *roots = json_object_get(gltf_item(g, "scenes", scene_index), "nodes");
    for (int children = 0; children < 2; children++)
        for (size_t k = 0; k < json_array_size(roots); k++) {
            const uint32_t root = named(g, roots, k);
            if (root == GLTF_NONE)
                return import_fail(g->im, "scene %u has a node that is none", scene_index);
            if (g->nodes[root].place == GLTF_NONE && (children || !g->nodes[root].is_child) && !walk(g, root, way))
                return false;
        }
    return true;
}

/* Those that are no child; or, if `all`, whatever has no place yet: nodes that go round. */
static bool walk_rest(gltf_file *g, bool all, step *way) {
    for (uint32_t i = 0; i < g->node_count; i++)
        if (g->nodes[i].place == GLTF_NONE && (all || !g->nodes[i].is_child) && !walk(g, i, way))
            return false;
    return true;
}

static bool place_all(gltf_file *g, step *way) {
    const size_t scenes = gltf_count(g, "scenes");
    uint32_t chosen;
    if (!gltf_index(g->root, "scene", &chosen))
        chosen = 0;
    if (chosen == GLTF_NONE)
        return import_fail(g->im, "its scene is no number");
    if (scenes > 0 && chosen >= scenes)
        return import_fail(g->im, "scene %u of %zu", chosen, scenes);
    if (scenes > 1 && !import_not_done(g->im, "%zu of %zu scenes are left out", scenes - 1, scenes))
        return false;
    if (!(scenes > 0 ? walk_scene(g, chosen, way) : walk_rest(g, false, way)))
        return false;
    g->shown = g->place_count;
    return walk_rest(g, false, way) && walk_rest(g, true, way); /* joints may be anywhere */
}

bool gltf_read_nodes(gltf_file *g) {
    g->node_count = gltf_count(g, "nodes");
    g->nodes = calloc(g->node_count + 1, sizeof *g->nodes);
    step *way = calloc(g->node_count + 1, sizeof *way);
    if (!g->nodes || !way) {
        free(way);
        return import_fail(g->im, "out of memory");
    }
    bool fine = true;
    for (uint32_t i = 0; fine && i < g->node_count; i++)
        fine = read_node(g, i);
    fine = fine && find_children(g) && place_all(g, way);
    free(way);
    return fine;
}
