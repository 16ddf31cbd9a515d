/* JSON of strangers: jansson's lookups give NULL for NULL and for other kinds, and these do not fail either. */
#include "import/gltf/gltf_file.h"
#include <math.h>

const json_t *gltf_item(const gltf_file *g, const char *list, uint32_t index) {
    const json_t *item = json_array_get(json_object_get(g->root, list), index);
    return json_is_object(item) ? item : NULL;
}

size_t gltf_count(const gltf_file *g, const char *list) {
    return json_array_size(json_object_get(g->root, list));
}

/* A whole number from 0 to `most`. */
static bool whole(const json_t *value, double most, double *out) {
    *out = json_is_number(value) ? json_number_value(value) : -1.0;
    return *out >= 0.0 && *out <= most && *out == floor(*out);
}

bool gltf_index(const json_t *object, const char *key, uint32_t *out) {
    double value;
    const json_t *found = json_object_get(object, key);
    *out = GLTF_NONE;
    if (found && whole(found, (double)GLTF_NONE - 1.0, &value))
        *out = (uint32_t)value;
    return found != NULL;
}

bool gltf_size(const json_t *object, const char *key, size_t *out) {
    double value = 0.0;
    const json_t *found = json_object_get(object, key);
    if (found && !whole(found, 0x1p53, &value))
        return false;
    *out = (size_t)value;
    return true;
}

double gltf_number(const json_t *object, const char *key, double otherwise) {
    const json_t *found = json_object_get(object, key);
    return json_is_number(found) ? json_number_value(found) : otherwise;
}

bool gltf_numbers(const json_t *object, const char *key, double *out, size_t count) {
    const json_t *found = json_object_get(object, key);
    if (json_array_size(found) < count)
        return false;
    for (size_t i = 0; i < count; i++)
        if (!json_is_number(json_array_get(found, i)))
            return false;
    for (size_t i = 0; i < count; i++)
        out[i] = json_number_value(json_array_get(found, i));
    return true;
}

const char *gltf_text(const json_t *object, const char *key, const char *otherwise) {
    const char *text = json_string_value(json_object_get(object, key));
    return text ? text : otherwise;
}

const json_t *gltf_extension(const json_t *object, const char *name) {
    const json_t *found = json_object_get(json_object_get(object, "extensions"), name);
    return json_is_object(found) ? found : NULL;
}
