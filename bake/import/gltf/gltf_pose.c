/* Meshes in the pose that the file states: morph targets at their weights (3.7.2.2), skins at their joints (3.7.3). */
#include "import/gltf/gltf_file.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- morph targets ---- */

/* Weight of target `i`: of the node, or else of its mesh. */
static double weight_of(const gltf_file *g, uint32_t node, size_t i) {
    uint32_t mesh;
    const json_t *weights = json_object_get(g->nodes[node].json, "weights");
    if (!weights && gltf_index(g->nodes[node].json, "mesh", &mesh))
        weights = json_object_get(gltf_item(g, "meshes", mesh), "weights");
    const json_t *weight = json_array_get(weights, i);
    return json_is_number(weight) ? json_number_value(weight) : 0.0;
}

static bool is_morphed(const gltf_file *g, const gltf_part *part, uint32_t node) {
    const size_t targets = json_array_size(json_object_get(part->json, "targets"));
    for (size_t i = 0; i < targets; i++)
        if (weight_of(g, node, i) != 0.0)
            return true;
    return false;
}

/* Adds the weighted displacements of one attribute of one target. */
static bool add_target(gltf_file *g, const gltf_part *part, uint32_t accessor, double weight, gltf_floats *to) {
    gltf_floats moves;
    if (!gltf_read_floats(g, accessor, 3, &moves))
        return false;
    const bool fine = moves.count >= part->first + part->vertices;
    for (size_t i = 0; fine && i < part->vertices; i++)
        for (size_t k = 0; k < 3; k++)
            to->owned[3 * i + k] += (float)(weight * (double)moves.at[moves.stride * (part->first + i) + k]);
    const uint32_t count = moves.count;
    gltf_drop_floats(&moves);
    return fine ? true
                : import_fail(g->im, "accessor %u has %u elements for %u vertices", accessor, count, part->position.count);
}

static bool morph(gltf_file *g, const gltf_part *part, const gltf_place *place, gltf_posed *out) {
    const json_t *targets = json_object_get(part->json, "targets");
    for (size_t i = 0; i < json_array_size(targets); i++) {
        const json_t *target = json_array_get(targets, i);
        const double weight = weight_of(g, place->node, i);
        uint32_t accessor;
        if (weight == 0.0)
            continue;
        if (gltf_index(target, "POSITION", &accessor) && !add_target(g, part, accessor, weight, &out->position))
            return false;
        if (out->normal.owned && gltf_index(target, "NORMAL", &accessor) &&
            !add_target(g, part, accessor, weight, &out->normal))
            return false;
        if ((json_object_get(target, "TEXCOORD_0") || json_object_get(target, "COLOR_0")) &&
            !gltf_remark_once(g, GLTF_SAID_MORPHS, "morph targets of texture coordinates and colours are left out", ""))
            return false;
    }
    return true;
}

/* ---- skins ---- */

typedef struct skin {
    double *joints; /* 3 x 4 a joint: from the mesh to the file's world */
    size_t count;
} skin;

static bool read_joint(gltf_file *g, const json_t *value, const gltf_floats *inverse, size_t i, double out[12]) {
    const double number = json_is_number(value) ? json_number_value(value) : -1.0;
    if (!(number >= 0.0 && number < (double)g->node_count && number == floor(number)))
        return import_fail(g->im, "a skin has a joint that is no node");
    const double *world = g->places[g->nodes[(size_t)number].place].world;
    if (!inverse->at) {
        memcpy(out, world, 12 * sizeof *out);
        return true;
    }
    double own[12];
    for (size_t k = 0; k < 12; k++) /* by columns */
        own[k] = (double)inverse->at[inverse->stride * i + 4 * (k % 4) + k / 4];
    import_multiply(world, own, out);
    return true;
}

static bool read_skin(gltf_file *g, uint32_t index, skin *out) {
    const json_t *json = gltf_item(g, "skins", index), *joints = json_object_get(json, "joints");
    gltf_floats inverse = {0};
    uint32_t accessor;
    *out = (skin){.count = json_array_size(joints)};
    if (!json || out->count == 0)
        return import_fail(g->im, "skin %u has no joints", index);
    if (gltf_index(json, "inverseBindMatrices", &accessor) && !gltf_read_floats(g, accessor, 16, &inverse))
        return false;
    out->joints = calloc(out->count, 12 * sizeof *out->joints);
    bool fine = out->joints ? true : import_fail(g->im, "out of memory");
    if (fine && inverse.at && inverse.count < out->count)
        fine = import_fail(g->im, "skin %u has %u inverse bind matrices for %zu joints", index, inverse.count, out->count);
    for (size_t i = 0; fine && i < out->count; i++)
        fine = read_joint(g, json_array_get(joints, i), &inverse, i, out->joints + 12 * i);
    gltf_drop_floats(&inverse);
    return fine;
}

/* The weighted sum of the vertex's joints; weights that do not sum up to 1 are made to. Without weights it follows `node`. */
static bool blend(gltf_file *g, const gltf_part *part, const skin *s, size_t vertex, const double node[12], double out[12]) {
    double sum = 0.0;
    memset(out, 0, 12 * sizeof *out);
    for (size_t set = 0; set < part->joint_sets; set++)
        for (size_t k = 0; k < 4; k++) {
            const double weight = (double)part->weights[set].at[part->weights[set].stride * vertex + k];
            const double joint = (double)part->joints[set].at[part->joints[set].stride * vertex + k];
            if (weight == 0.0)
                continue;
            if (!(joint >= 0.0 && joint < (double)s->count))
                return import_fail(g->im, "a vertex has joint %g of %zu", joint, s->count);
            sum += weight;
            for (size_t i = 0; i < 12; i++)
                out[i] += weight * s->joints[12 * (size_t)joint + i];
        }
    if (!(sum > 0.0))
        memcpy(out, node, 12 * sizeof *out);
    for (size_t i = 0; sum > 0.0 && i < 12; i++)
        out[i] /= sum;
    return true;
}

/* By the cofactors, as import_place.c does it. */
static void turn_normal(const double m[12], float n[3]) {
    const double a[3] = {(double)n[0], (double)n[1], (double)n[2]};
    double determinant = 0.0;
    for (int i = 0; i < 3; i++) {
        const double *p = m + 4 * ((i + 1) % 3), *q = m + 4 * ((i + 2) % 3);
        const double c[3] = {p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]};
        n[i] = (float)(c[0] * a[0] + c[1] * a[1] + c[2] * a[2]);
        determinant += i == 0 ? m[0] * c[0] + m[1] * c[1] + m[2] * c[2] : 0.0;
    }
    for (int i = 0; determinant < 0.0 && i < 3; i++)
        n[i] = -n[i];
}

static bool follow(gltf_file *g, const gltf_part *part, const gltf_place *place, const skin *s, gltf_posed *out) {
    for (size_t i = 0; out->position.owned && i < part->vertices; i++) {
        float *p = out->position.owned + 3 * i;
        const double from[3] = {(double)p[0], (double)p[1], (double)p[2]};
        double m[12], to[3];
        if (!blend(g, part, s, part->first + i, place->world, m))
            return false;
        import_transform_point(m, from, to);
        for (int k = 0; k < 3; k++)
            p[k] = (float)to[k];
        if (out->normal.owned)
            turn_normal(m, out->normal.owned + 3 * i);
    }
    out->skinned = true;
    return true;
}

/* ---- both ---- */

/* A copy of what the part uses, to be changed. */
static bool copy(gltf_file *g, const gltf_part *part, const gltf_floats *of, gltf_floats *out) {
    *out = (gltf_floats){.count = part->vertices, .components = 3, .stride = 3};
    if (!of->at)
        return true;
    out->at = out->owned = calloc((size_t)part->vertices + 1, 3 * sizeof *out->owned);
    if (!out->owned)
        return import_fail(g->im, "out of memory");
    for (size_t i = 0; i < part->vertices; i++)
        memcpy(out->owned + 3 * i, of->at + of->stride * (part->first + i), 3 * sizeof *out->owned);
    return true;
}

bool gltf_pose(gltf_file *g, const gltf_part *part, const gltf_place *place, gltf_posed *out) {
    uint32_t index;
    skin s = {0};
    const bool morphed = is_morphed(g, part, place->node);
    const bool skinned = gltf_index(g->nodes[place->node].json, "skin", &index) && part->joint_sets > 0;
    *out = (gltf_posed){0};
    if (!morphed && !skinned)
        return true;
    bool fine = copy(g, part, &part->position, &out->position) && copy(g, part, &part->normal, &out->normal);
    fine = fine && (!morphed || morph(g, part, place, out));
    if (fine && skinned)
        fine = read_skin(g, index, &s) && follow(g, part, place, &s, out);
    free(s.joints);
    return fine;
}
