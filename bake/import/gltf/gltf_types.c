/* Members that are not of the kind that the specification gives them. The reader takes them for absent; it is said that it
 * does. Extras and extensions that are not read may hold anything. */
#include "import/gltf/gltf_file.h"
#include <stdio.h>
#include <string.h>

typedef enum kind { TEXT, SWITCH, NUMBER, NUMBERS, NUMERIC, LIST, OBJECT, ANYTHING } kind; /* numeric: a number or several */

static kind kind_of(const char *key) {
    static const struct {
        kind kind;
        const char *keys; /* each between blanks */
    } kinds[] = {
        {TEXT, " uri alphaMode name "},
        {SWITCH, " normalized doubleSided "},
        {NUMBER,
         " byteOffset byteLength byteStride count componentType bufferView buffer mesh camera skin material source sampler "
         "texCoord index metallicFactor roughnessFactor alphaCutoff yfov intensity range innerConeAngle outerConeAngle ior "
         "emissiveStrength transmissionFactor thicknessFactor attenuationDistance glossinessFactor light scene "},
        {NUMBERS,
         " children joints weights matrix translation baseColorFactor emissiveFactor diffuseFactor specularColorFactor "
         "attenuationColor color offset "},
        {NUMERIC, " scale rotation specularFactor "},
        {LIST, " nodes meshes accessors bufferViews buffers materials textures images samplers cameras skins scenes primitives "
               "targets extensionsUsed extensionsRequired lights "},
        {OBJECT,
         " attributes asset pbrMetallicRoughness baseColorTexture metallicRoughnessTexture normalTexture emissiveTexture "
         "perspective spot extensions sparse "},
    };
    char padded[64];
    const int length = snprintf(padded, sizeof padded, " %s ", key);
    if (length < 0 || (size_t)length >= sizeof padded)
        return ANYTHING;
    for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++)
        if (strstr(kinds[i].keys, padded))
            return kinds[i].kind;
    return ANYTHING;
}

static bool is_numbers(const json_t *value) {
    for (size_t i = 0; i < json_array_size(value); i++)
        if (!json_is_number(json_array_get(value, i)))
            return false;
    return json_is_array(value);
}

static bool fits(kind wanted, const json_t *value) {
    switch (wanted) {
    case TEXT:
        return json_is_string(value);
    case SWITCH:
        return json_is_boolean(value);
    case NUMBER:
        return json_is_number(value);
    case NUMBERS:
        return is_numbers(value);
    case NUMERIC:
        return json_is_number(value) || is_numbers(value);
    case LIST:
        return json_is_array(value);
    case OBJECT:
        return json_is_object(value);
    default:
        return true;
    }
}

/* The first such member below `value`, or NULL. */
static const char *find(const json_t *value, bool extensions) {
    const char *key, *found = NULL;
    json_t *member;
    size_t i;
    json_array_foreach(value, i, member) if ((found = find(member, false))) return found;
    json_object_foreach((json_t *)(uintptr_t)value, key, member) {
        if (strcmp(key, "extras") == 0 || (extensions && !gltf_reads_extension(key)))
            continue;
        if (!extensions && !fits(kind_of(key), member))
            return key;
        if ((found = find(member, strcmp(key, "extensions") == 0)))
            return found;
    }
    return NULL;
}

bool gltf_check_types(gltf_file *g) {
    const char *key = find(g->root, false);
    return !key || import_not_done(g->im, "a member '%.60s' is not of its kind; it counts as absent, and so may others", key);
}
