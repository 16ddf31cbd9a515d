#include "import/3mf/threemf.h"
#include "import/assimp/assimp.h"
#include "import/gltf/gltf.h"
#include "import/import_format.h"
#include "import/obj/obj.h"
#include "import/ply/ply.h"
#include "import/stl/stl.h"
#include <string.h>
#include <strings.h>

const import_format *const import_formats[] = {&gltf_format,    &obj_format,    &ply_format, &stl_format,
                                               &threemf_format, &assimp_format, NULL};

bool import_has_suffix(const char *file, const char *suffix) {
    const size_t n = strlen(file), k = strlen(suffix);
    return n >= k && !strcasecmp(file + n - k, suffix);
}

const import_format *import_format_of(const char *file, const uint8_t *head, size_t size) {
    for (size_t i = 0; import_formats[i]; i++)
        if (import_formats[i]->is_it(head, size))
            return import_formats[i];
    for (size_t i = 0; import_formats[i]; i++)
        for (const char *const *suffix = import_formats[i]->suffixes; *suffix; suffix++)
            if (import_has_suffix(file, *suffix))
                return import_formats[i];
    return &assimp_format;
}
