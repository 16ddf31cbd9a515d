/* Textures (3.8): which image, how it repeats, which coordinates, and KHR_texture_transform. */
#include "common/strict_math.h"
#include "import/gltf/gltf_file.h"
#include "import/webp.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

static uint32_t wrap_of(const json_t *sampler, const char *key) {
    switch ((int)gltf_number(sampler, key, 10497)) {
    case 33071:
        return VIT_WRAP_CLAMP;
    case 33648:
        return VIT_WRAP_MIRROR;
    default:
        return VIT_WRAP_REPEAT;
    }
}

/* A file of its own by its name, else one in the file by its number. */
static bool name_image(const gltf_file *g, uint32_t image, char out[SCENE_PATH]) {
    const json_t *json = gltf_item(g, "images", image);
    const char *uri = gltf_text(json, "uri", NULL);
    if (!json)
        return false;
    if (uri && !gltf_is_data(uri))
        (void)snprintf(out, SCENE_PATH, "%s", uri);
    else
        (void)snprintf(out, SCENE_PATH, "*%u", image);
    return true;
}

/* The image is there, and WebP by its head. */
static bool is_webp(gltf_file *g, uint32_t image) {
    const char *uri = gltf_text(gltf_item(g, "images", image), "uri", NULL);
    import_bytes file = {0};
    char path[SCENE_PATH];
    int width, height;
    const uint8_t *at = NULL;
    size_t size = 0;
    if (uri && !gltf_is_data(uri)) {
        if (!import_resolve(g->im, uri, path) || !import_map(g->im, path, &file))
            return false;
        at = file.at;
        size = file.size;
    } else if (gltf_image_bytes(g, image, &at, &size))
        return false;
    const bool fine = webp_is_it(at, size) && webp_size(at, size, &width, &height);
    import_drop_bytes(&file);
    return fine;
}

/* WebP where the file has it and its bytes are such; PNG or JPEG beside it are for those who cannot read it. */
static bool find_image(gltf_file *g, const json_t *texture, char out[SCENE_PATH]) {
    static const char *const others[] = {"KHR_texture_basisu", "MSFT_texture_dds", "EXT_texture_avif"};
    uint32_t webp, plain;
    const bool fallback = gltf_index(texture, "source", &plain);
    if (gltf_index(gltf_extension(texture, "EXT_texture_webp"), "source", &webp) && (!fallback || is_webp(g, webp)) &&
        name_image(g, webp, out))
        return true;
    if (fallback && name_image(g, plain, out))
        return true;
    /* It is told of as a picture that cannot be read. */
    for (size_t i = 0; i < sizeof others / sizeof *others; i++)
        if (gltf_index(gltf_extension(texture, others[i]), "source", &plain) && name_image(g, plain, out))
            return true;
    return false;
}

/* The extension's matrix, offset * rotation * scale, for v down as ours is. */
static void read_transform(gltf_texture *to, const json_t *how) {
    double offset[2] = {0.0, 0.0}, scale[2] = {1.0, 1.0};
    const double rotation = gltf_number(how, "rotation", 0.0), s = strict_sin(rotation), c = strict_cos(rotation);
    (void)gltf_numbers(how, "offset", offset, 2);
    (void)gltf_numbers(how, "scale", scale, 2);
    const double matrix[6] = {c * scale[0], s * scale[1], offset[0], -s * scale[0], c * scale[1], offset[1]};
    for (int i = 0; i < 6; i++)
        if (!isfinite(matrix[i]))
            return;
    memcpy(to->uv, matrix, sizeof matrix);
    to->has_transform = true;
}

bool gltf_find_texture(gltf_file *g, const json_t *info, gltf_texture *out) {
    const json_t *transform = gltf_extension(info, "KHR_texture_transform");
    uint32_t index, set;
    *out = (gltf_texture){.image = ""};
    if (!gltf_index(info, "index", &index))
        return false;
    const json_t *texture = gltf_item(g, "textures", index);
    if (!find_image(g, texture, out->image))
        (void)snprintf(out->image, sizeof out->image, "textures[%u]", index); /* is missing */
    uint32_t sampler;
    if (gltf_index(texture, "sampler", &sampler)) {
        out->wrap_u = wrap_of(gltf_item(g, "samplers", sampler), "wrapS");
        out->wrap_v = wrap_of(gltf_item(g, "samplers", sampler), "wrapT");
    } else
        out->wrap_u = out->wrap_v = VIT_WRAP_REPEAT;
    if (gltf_index(transform, "texCoord", &set) || gltf_index(info, "texCoord", &set))
        out->uv_set = set;
    if (transform)
        read_transform(out, transform);
    return true;
}

bool gltf_texture_mean(gltf_file *g, const json_t *info, const char *material, bool srgb, float mean[4]) {
    gltf_texture texture;
    if (gltf_find_texture(g, info, &texture))
        return import_texture_mean(g->im, texture.image, material, srgb, mean);
    for (int k = 0; k < 4; k++)
        mean[k] = 1.0f;
    return true;
}
