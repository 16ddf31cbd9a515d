/* Meshes (3.7) where nodes put them, each read once however many do. */
#include "import/gltf/gltf_file.h"
#include <stdio.h>
#include <stdlib.h>

void gltf_drop_mesh(gltf_mesh *mesh) {
    for (size_t i = 0; mesh->parts && i < mesh->part_count; i++)
        gltf_drop_part(&mesh->parts[i]);
    free(mesh->parts);
    mesh->parts = NULL;
}

bool gltf_read_mesh(gltf_file *g, uint32_t index) {
    gltf_mesh *mesh = &g->meshes[index];
    const json_t *json = gltf_item(g, "meshes", index), *primitives = json_object_get(json, "primitives");
    if (mesh->parts)
        return true;
    mesh->part_count = json_array_size(primitives);
    mesh->parts = calloc(mesh->part_count + 1, sizeof *mesh->parts);
    if (!mesh->parts)
        return import_fail(g->im, "out of memory");
    for (size_t i = 0; i < mesh->part_count; i++)
        if (!gltf_read_part(g, json_array_get(primitives, i), &mesh->parts[i]))
            return false;
    const char *name = gltf_text(json, "name", "");
    if (*name)
        (void)snprintf(mesh->name, sizeof mesh->name, "%.*s", SCENE_NAME - 1, name);
    else
        (void)snprintf(mesh->name, sizeof mesh->name, "meshes[%u]", index);
    return true;
}

static mesh_floats from(const gltf_floats *f, uint32_t first) {
    return (mesh_floats){f->at ? f->at + f->stride * first : NULL, f->stride};
}

/* Alpha of vertices is not done where it would count. */
static bool check_alpha(gltf_file *g, const gltf_part *part) {
    const json_t *material = gltf_item(g, "materials", part->material);
    const char *mode = gltf_text(material, "alphaMode", "OPAQUE");
    if (part->color.components < 4 || (mode[0] != 'M' && mode[0] != 'B'))
        return true;
    for (size_t i = 0; i < part->vertices; i++)
        if (part->color.at[part->color.stride * (part->first + i) + 3] < 1.0f)
            return gltf_remark_once(g, GLTF_SAID_ALPHA, "alpha of vertices is left out", gltf_text(material, "name", ""));
    return true;
}

static bool place_part(gltf_file *g, uint32_t mesh, const gltf_part *part, const gltf_posed *posed, const double world[12]) {
    mesh_part out = {.name = g->meshes[mesh].name,
                     .vertices = part->vertices,
                     .position = posed->position.at ? from(&posed->position, 0) : from(&part->position, part->first),
                     .normal = posed->normal.at ? from(&posed->normal, 0) : from(&part->normal, part->first),
                     .color = from(&part->color, part->first),
                     .corner = part->corner,
                     .triangles = part->triangles,
                     .material = part->material};
    for (size_t i = 0; i < IMPORT_UV_SETS; i++)
        out.uv[i] = from(&part->uv[i], part->first);
    if (part->vertices == 0)
        g->im->bad_index += part->triangles;
    return check_alpha(g, part) && import_place(g->im, mesh, &out, world);
}

/* All of a node's mesh in one place. */
static bool place_mesh(gltf_file *g, const gltf_place *place, uint32_t mesh, const double world[12], const double above[12]) {
    const gltf_mesh *m = &g->meshes[mesh];
    bool fine = true;
    import_count_place(g->im, mesh, m->name);
    for (size_t i = 0; fine && i < m->part_count; i++) {
        gltf_posed posed = {.skinned = false};
        if (m->parts[i].triangles == 0)
            continue;
        fine = gltf_pose(g, &m->parts[i], place, &posed) &&
               place_part(g, mesh, &m->parts[i], &posed, posed.skinned ? above : world);
        gltf_drop_floats(&posed.position);
        gltf_drop_floats(&posed.normal);
    }
    return fine;
}

/* An attribute of EXT_mesh_gpu_instancing: `count` becomes that of the first that is there. */
static bool read_instances(gltf_file *g, const json_t *how, const char *name, unsigned components, gltf_floats *out,
                           uint32_t *count) {
    uint32_t index;
    if (!gltf_index(json_object_get(how, "attributes"), name, &index))
        return true;
    if (!gltf_read_floats(g, index, components, out))
        return false;
    if (*count == GLTF_NONE)
        *count = out->count;
    return out->count == *count ? true : import_fail(g->im, "instances with %u and %u attributes", *count, out->count);
}

static void take(const gltf_floats *f, uint32_t i, size_t components, double *to) {
    for (size_t k = 0; f->at && k < components; k++)
        to[k] = (double)f->at[f->stride * i + k];
}

static bool place_instances(gltf_file *g, const gltf_place *place, uint32_t mesh, const json_t *how, const double above[12]) {
    gltf_floats translation = {0}, rotation = {0}, scale = {0};
    uint32_t count = GLTF_NONE;
    bool fine = read_instances(g, how, "TRANSLATION", 3, &translation, &count) &&
                read_instances(g, how, "ROTATION", 4, &rotation, &count) && read_instances(g, how, "SCALE", 3, &scale, &count);
    for (uint32_t i = 0; fine && i < (count == GLTF_NONE ? 1 : count); i++) {
        double t[3] = {0.0, 0.0, 0.0}, r[4] = {0.0, 0.0, 0.0, 1.0}, s[3] = {1.0, 1.0, 1.0}, own[12], there[12], world[12];
        take(&translation, i, 3, t);
        take(&rotation, i, 4, r);
        take(&scale, i, 3, s);
        gltf_compose(t, r, s, own);
        import_multiply(place->world, own, there);
        import_multiply(above, there, world);
        fine = place_mesh(g, place, mesh, world, above);
    }
    gltf_drop_floats(&translation);
    gltf_drop_floats(&rotation);
    gltf_drop_floats(&scale);
    return fine;
}

static bool mesh_of(gltf_file *g, uint32_t node, uint32_t *mesh) {
    if (!gltf_index(g->nodes[node].json, "mesh", mesh))
        return false;
    return *mesh < g->mesh_count ||
           !import_fail(g->im, "node '%.100s' has mesh %u of %zu", g->nodes[node].name, *mesh, g->mesh_count);
}

static bool show(gltf_file *g, const gltf_place *place, const double above[12]) {
    const uint32_t node = place->node;
    const json_t *instances = gltf_extension(g->nodes[node].json, "EXT_mesh_gpu_instancing");
    double world[12];
    uint32_t mesh;
    import_multiply(above, place->world, world);
    if (mesh_of(g, node, &mesh)) {
        if (mesh >= g->mesh_count || !gltf_read_mesh(g, mesh) ||
            !(instances ? place_instances(g, place, mesh, instances, above) : place_mesh(g, place, mesh, world, above)))
            return false;
        if (--g->meshes[mesh].places == 0)
            gltf_drop_mesh(&g->meshes[mesh]);
    }
    return gltf_add_camera(g, place, world) && gltf_add_light(g, place, world);
}

bool gltf_place_meshes(gltf_file *g, const scene_mesh *mesh) {
    for (size_t i = 0; i < g->shown; i++)
        if (!show(g, &g->places[i], mesh->transform))
            return false;
    return true;
}
