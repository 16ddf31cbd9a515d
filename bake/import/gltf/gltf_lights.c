/* KHR_lights_punctual and cameras (3.10): each node that names one has one of its own, called as the node is. */
#include "common/pi.h"
#include "import/gltf/gltf_file.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

static const double origin[3] = {0.0, 0.0, 0.0}, ahead[3] = {0.0, 0.0, -1.0}, above[3] = {0.0, 1.0, 0.0};

static void take_names(const gltf_file *g, const gltf_place *place, char name[SCENE_NAME], char parent[SCENE_NAME]) {
    memcpy(name, g->nodes[place->node].name, SCENE_NAME);
    parent[0] = '\0';
    if (place->above != GLTF_NONE)
        memcpy(parent, g->nodes[g->places[place->above].node].name, SCENE_NAME);
}

bool gltf_add_camera(gltf_file *g, const gltf_place *place, const double world[12]) {
    uint32_t index;
    double forward[3];
    model_camera camera = {.fov = 0.0};
    if (!gltf_index(g->nodes[place->node].json, "camera", &index))
        return true;
    const json_t *json = gltf_item(g, "cameras", index);
    if (!json)
        return import_fail(g->im, "node '%.100s' has camera %u of %zu", g->nodes[place->node].name, index,
                           gltf_count(g, "cameras"));
    take_names(g, place, camera.name, camera.parent);
    import_transform_point(world, origin, camera.eye);
    import_transform_vector(world, ahead, forward);
    import_transform_vector(world, above, camera.up);
    camera.fov = gltf_number(json_object_get(json, "perspective"), "yfov", 0.0) * 180.0 / PI;
    return import_add_camera(g->im, &camera, forward, strcmp(gltf_text(json, "type", ""), "orthographic") == 0);
}

static bool kind_of(const char *type, int *kind) {
    static const struct {
        const char *type;
        int kind;
    } kinds[] = {{"point", VIT_LIGHT_POINT}, {"spot", VIT_LIGHT_SPOT}, {"directional", VIT_LIGHT_DIRECTIONAL}};
    for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++)
        if (strcmp(kinds[i].type, type) == 0) {
            *kind = kinds[i].kind;
            return true;
        }
    return false;
}

bool gltf_add_light(gltf_file *g, const gltf_place *place, const double world[12]) {
    const json_t *lights = json_object_get(gltf_extension(g->root, "KHR_lights_punctual"), "lights");
    uint32_t index;
    double color[3] = {1.0, 1.0, 1.0};
    model_light light = {.kind = VIT_LIGHT_POINT};
    if (!gltf_index(gltf_extension(g->nodes[place->node].json, "KHR_lights_punctual"), "light", &index))
        return true;
    const json_t *json = json_array_get(lights, index);
    if (!json_is_object(json))
        return import_fail(g->im, "node '%.100s' has light %u of %zu", g->nodes[place->node].name, index,
                           json_array_size(lights));
    take_names(g, place, light.name, light.parent);
    if (!kind_of(gltf_text(json, "type", ""), &light.kind))
        return import_not_done(g->im, "light '%.100s' is no point, spot or directional light; it is left out", light.name);
    import_transform_point(world, origin, light.position);
    import_transform_vector(world, ahead, light.direction);
    if (light.kind == VIT_LIGHT_POINT)
        memcpy(light.direction, (const double[3]){0.0, -1.0, 0.0}, sizeof light.direction);
    (void)gltf_numbers(json, "color", color, 3);
    for (int i = 0; i < 3; i++)
        light.stated[i] = color[i] * gltf_number(json, "intensity", 1.0);
    const double range = gltf_number(json, "range", 0.0);
    light.range = light.kind != VIT_LIGHT_DIRECTIONAL && range > 0.0 && isfinite(range) ? range : 0.0;
    if (light.kind == VIT_LIGHT_SPOT) {
        const json_t *cone = json_object_get(json, "spot");
        light.inner = gltf_number(cone, "innerConeAngle", 0.0) * 180.0 / PI;
        light.outer = gltf_number(cone, "outerConeAngle", 0.25 * PI) * 180.0 / PI;
    }
    return import_add_light(g->im, &light, 90.001);
}
