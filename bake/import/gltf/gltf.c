#include "import/gltf/gltf.h"
#include "import/assimp/assimp.h"
#include "import/gltf/gltf_file.h"
#include <stdlib.h>
#include <string.h>

#define MOST_EXPECTED ((uint64_t)1 << 24) /* vertices, triangles: by its word alone a file gets no more room */

bool gltf_remark_once(gltf_file *g, gltf_remark remark, const char *text, const char *name) {
    const unsigned bit = 1u << remark;
    if (g->said & bit)
        return true;
    if (g->im->warn) /* it is not, while import_transparency.c takes stock */
        g->said |= bit;
    return *name ? import_not_done(g->im, "%s (material '%.100s' and perhaps others)", text, name)
                 : import_not_done(g->im, "%s", text);
}

/* "2.1" is 2.1, as is the number, which glTF 1 has; 0: no version. */
static double version_of(const json_t *asset, const char *key) {
    const char *text = gltf_text(asset, key, "");
    const double version = *text ? strtod(text, NULL) : gltf_number(asset, key, 0.0);
    return version > 0.0 && version < 1e6 ? version : 0.0;
}

static bool check_version(gltf_file *g) {
    const json_t *asset = json_object_get(g->root, "asset");
    const double version = version_of(asset, "version"), least = version_of(asset, "minVersion");
    if (!(version >= 2.0 && version < 3.0) || !gltf_text(asset, "version", NULL))
        return import_fail(g->im, "is no glTF 2: its asset's version is '%.20s'", gltf_text(asset, "version", ""));
    return least <= 2.0 || import_fail(g->im, "needs glTF %.20s", gltf_text(asset, "minVersion", ""));
}

static bool is_animated(const gltf_file *g) {
    const json_t *all = json_object_get(g->root, "animations");
    for (size_t i = 0; i < json_array_size(all); i++)
        if (json_array_size(json_object_get(json_array_get(all, i), "channels")) > 0)
            return true;
    return false;
}

/* ---- transparency ---- */

static bool may_hide(const json_t *material) {
    const bool masks = strcmp(gltf_text(material, "alphaMode", ""), "MASK") == 0;
    return (double)gltf_opacity(material) < (masks ? gltf_number(material, "alphaCutoff", 0.5) : 0.5);
}

static void count_triangles(gltf_file *g, uint64_t *of_material) {
    for (size_t i = 0; i < g->shown; i++) {
        uint32_t mesh, material;
        if (!gltf_index(g->nodes[g->places[i].node].json, "mesh", &mesh))
            continue;
        const json_t *primitives = json_object_get(gltf_item(g, "meshes", mesh), "primitives");
        for (size_t k = 0; k < json_array_size(primitives); k++) {
            const json_t *primitive = json_array_get(primitives, k);
            if (!gltf_index(primitive, "material", &material))
                material = g->material_count;
            if (material <= g->material_count)
                of_material[material] += gltf_triangles_stated(g, primitive);
        }
    }
}

static bool look_at_transparency(gltf_file *g) {
    bool any = false;
    for (unsigned i = 0; i < g->material_count; i++)
        any = any || may_hide(gltf_item(g, "materials", i));
    if (!any)
        return true;
    uint64_t *of_material = calloc((size_t)g->material_count + 1, sizeof *of_material);
    if (!of_material)
        return import_fail(g->im, "out of memory");
    count_triangles(g, of_material);
    const bool fine = import_transparency(g->im, of_material, g->material_count + 1);
    free(of_material);
    return fine;
}

/* ---- reading ---- */

/* Room for what the file says it has, so that nothing has to grow; what is not used of it costs addresses alone. */
static bool expect(gltf_file *g) {
    uint64_t triangles = 0, vertices = 0;
    for (size_t i = 0; i < g->shown; i++) {
        uint32_t mesh, position;
        if (!gltf_index(g->nodes[g->places[i].node].json, "mesh", &mesh))
            continue;
        const json_t *primitives = json_object_get(gltf_item(g, "meshes", mesh), "primitives");
        for (size_t k = 0; k < json_array_size(primitives); k++) {
            const json_t *attributes = json_object_get(json_array_get(primitives, k), "attributes");
            const uint64_t more = gltf_triangles_stated(g, json_array_get(primitives, k));
            (void)gltf_index(attributes, "POSITION", &position);
            const uint64_t stated = gltf_accessor_count(g, position);
            triangles += more;
            vertices += stated < 3 * more && json_object_get(attributes, "NORMAL") ? stated : 3 * more;
        }
    }
    return triangles > MOST_EXPECTED || vertices > MOST_EXPECTED ||
           import_make_room(g->im, (size_t)vertices, (size_t)triangles);
}

static bool prepare_meshes(gltf_file *g) {
    g->mesh_count = gltf_count(g, "meshes");
    g->meshes = calloc(g->mesh_count + 1, sizeof *g->meshes);
    if (!g->meshes)
        return import_fail(g->im, "out of memory");
    for (size_t i = 0; i < g->shown; i++) {
        uint32_t mesh;
        if (gltf_index(g->nodes[g->places[i].node].json, "mesh", &mesh) && mesh < g->mesh_count)
            g->meshes[mesh].places++;
    }
    return import_begin_meshes(g->im, g->mesh_count);
}

static bool read_all(gltf_file *g, const scene_mesh *mesh) {
    const size_t materials = gltf_count(g, "materials"), images = gltf_count(g, "images");
    if (materials >= INT32_MAX || images >= INT32_MAX)
        return import_fail(g->im, "too many materials or images");
    g->material_count = (unsigned)materials;
    g->im->embedded = (unsigned)images;
    g->im->states_units = true;
    if (!check_version(g) || !gltf_check_extensions(g) || !gltf_check_types(g) || !gltf_read_nodes(g))
        return false;
    if (is_animated(g) && !import_not_done(g->im, "animations are left out: what moves stands still"))
        return false;
    return prepare_meshes(g) && look_at_transparency(g) && expect(g) && gltf_place_meshes(g, mesh);
}

/* glTF 1, as JSON or as GLB. */
static bool is_old(const gltf_file *g) {
    const double version = version_of(json_object_get(g->root, "asset"), "version");
    return (g->file.size >= 8 && memcmp(g->file.at, "glTF\1\0\0\0", 8) == 0) || (version >= 1.0 && version < 2.0);
}

static bool read(importer *im, const scene_mesh *mesh) {
    gltf_file *g = calloc(1, sizeof *g);
    if (!g)
        return import_fail(im, "out of memory");
    g->im = im;
    im->reader = g;
    bool fine = gltf_open(g);
    const bool old = is_old(g);
    fine = fine && !old && read_all(g, mesh);
    gltf_close(g);
    im->reader = NULL;
    free(g);
    if (!old)
        return fine;
    im->format = &assimp_format;
    return assimp_format.read(im, mesh);
}

static const char *image(importer *im, unsigned index, model_image *out) {
    const uint8_t *at;
    size_t size;
    const char *wrong = gltf_image_bytes(im->reader, index, &at, &size);
    return wrong ? wrong : import_decode(im, at, size, out);
}

/* GLB of version 2 (older ones are Assimp's), or JSON that begins like a glTF file. */
static bool is_it(const uint8_t *head, size_t size) {
    static const char key[] = "\"asset\"";
    size_t at = size >= 3 && memcmp(head, "\xef\xbb\xbf", 3) == 0 ? 3 : 0;
    if (size >= 8 && memcmp(head, "glTF\2\0\0\0", 8) == 0)
        return true;
    while (at < size && (head[at] == ' ' || head[at] == '\t' || head[at] == '\r' || head[at] == '\n'))
        at++;
    if (at == size || head[at] != '{')
        return false;
    for (; at + sizeof key - 1 <= size; at++)
        if (memcmp(head + at, key, sizeof key - 1) == 0)
            return true;
    return false;
}

static const char *const suffixes[] = {".gltf", ".glb", NULL};
static const char *const cannot[] = {"animations",
                                     "emissive textures",
                                     "vertex colours that vary",
                                     "pictures in KTX2",
                                     "surfaces that are seen from one side alone",
                                     NULL};
const import_format gltf_format = {.name = "glTF 2.0",
                                   .suffixes = suffixes,
                                   .cannot = cannot,
                                   .states_frame = true,
                                   .is_it = is_it,
                                   .read = read,
                                   .material = gltf_material,
                                   .image = image};
