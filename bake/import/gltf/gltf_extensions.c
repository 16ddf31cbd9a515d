/* What extensions a file says it uses and needs (3.12), and which of them are done. */
#include "import/gltf/gltf_file.h"
#include <stdio.h>
#include <string.h>

typedef enum how { UNKNOWN, READ, HARMLESS } how; /* harmless: what it says changes nothing that is seen */

static how how_done(const char *name) {
    static const struct {
        const char *name;
        how how;
    } known[] = {{"EXT_mesh_gpu_instancing", READ},
                 {"EXT_meshopt_compression", READ},
                 {"EXT_texture_webp", READ},
                 {"KHR_draco_mesh_compression", READ},
                 {"KHR_lights_punctual", READ},
                 {"KHR_materials_emissive_strength", READ},
                 {"KHR_materials_ior", READ},
                 {"KHR_materials_pbrSpecularGlossiness", READ},
                 {"KHR_materials_specular", READ},
                 {"KHR_materials_transmission", READ},
                 {"KHR_materials_unlit", READ},
                 {"KHR_materials_volume", READ},
                 {"KHR_mesh_quantization", READ},
                 {"KHR_texture_transform", READ},
                 {"KHR_materials_variants", HARMLESS},
                 {"KHR_animation_pointer", HARMLESS},
                 {"KHR_xmp", HARMLESS},
                 {"KHR_xmp_json_ld", HARMLESS}};
    for (size_t i = 0; i < sizeof known / sizeof *known; i++)
        if (strcmp(known[i].name, name) == 0)
            return known[i].how;
    return UNKNOWN;
}

bool gltf_reads_extension(const char *name) {
    return how_done(name) == READ;
}

/* The model's entry for it; NULL: out of memory. */
static model_extension *entry(gltf_file *g, const char *name) {
    model *m = g->im->m;
    for (int i = 0; i < m->extension_count; i++)
        if (m->extensions[i].file == g->im->file_index && strcmp(m->extensions[i].name, name) == 0)
            return &m->extensions[i];
    size_t room = (size_t)m->extension_count;
    if (!import_room(g->im, &m->extensions, &room, room + 1, sizeof *m->extensions))
        return NULL;
    model_extension *e = &m->extensions[m->extension_count++];
    *e = (model_extension){.file = g->im->file_index, .read = how_done(name) != UNKNOWN};
    (void)snprintf(e->name, sizeof e->name, "%s", name);
    return e;
}

static bool note(gltf_file *g, const char *list, bool required) {
    const json_t *names = json_object_get(g->root, list);
    for (size_t i = 0; i < json_array_size(names) && i < MODEL_EXTENSIONS; i++) {
        const char *name = json_string_value(json_array_get(names, i));
        if (!name || strlen(name) >= sizeof((model_extension *)0)->name)
            continue;
        model_extension *e = entry(g, name);
        if (!e)
            return false;
        e->required |= required;
    }
    return true;
}

/* All that the extension is for are pictures, and each has a plain one beside it. */
static bool has_others_instead(const gltf_file *g, const char *name) {
    static const char *const pictures[] = {"KHR_texture_basisu", "MSFT_texture_dds", "EXT_texture_avif"};
    bool is_one = false;
    uint32_t source;
    for (size_t i = 0; i < sizeof pictures / sizeof *pictures; i++)
        is_one = is_one || strcmp(name, pictures[i]) == 0;
    for (uint32_t i = 0; is_one && i < gltf_count(g, "textures"); i++) {
        const json_t *texture = gltf_item(g, "textures", i);
        if (gltf_extension(texture, name) && !gltf_index(texture, "source", &source) &&
            !gltf_index(gltf_extension(texture, "EXT_texture_webp"), "source", &source))
            return false;
    }
    return is_one;
}

bool gltf_check_extensions(gltf_file *g) {
    const model *m = g->im->m;
    if (!note(g, "extensionsUsed", false) || !note(g, "extensionsRequired", true))
        return false;
    for (int i = 0; i < m->extension_count; i++) {
        const model_extension *e = &m->extensions[i];
        if (e->file != g->im->file_index || e->read || (!e->required && has_others_instead(g, e->name)))
            continue;
        if (e->required && g->im->rigour != MODEL_LISTS)
            return import_fail(g->im, "extension '%s' is required and not read", e->name);
        if (!import_not_done(g->im, "extension '%s' is %s and not read", e->name, e->required ? "required" : "used"))
            return false;
    }
    return true;
}
