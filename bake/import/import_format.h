/* import_formats.c: the readers of mesh files, and which of them a file is for. */
#ifndef VIT_BAKE_IMPORT_FORMAT_H
#define VIT_BAKE_IMPORT_FORMAT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

struct importer;
struct material_use;
struct model_image;
struct scene_mesh;

/* A reader runs in a child process (import_child.c): whatever a file does to it, the file is refused with one line. What it
 * keeps of the file it is reading is its own, in importer.reader. */
typedef struct import_format {
    const char *name;            /* for users: "glTF 2.0" */
    const char *const *suffixes; /* ".gltf"; NULL at the end */
    const char *const *cannot;   /* what it never does, in words for --list; NULL at the end */
    /* Metres, y up, by the format itself. */
    bool states_frame;
    /* It settles unit and up axis by import_frame() and puts import_stand()'s place in front of all that it places. Else the
     * place that read() is given has them. */
    bool finds_frame;
    /* The file is of this format by its first bytes. */
    bool (*is_it)(const uint8_t *head, size_t size);
    /* Reads im->file: checks what the file needs, places its triangles (import_place.c), adds its lights and cameras
     * (import_lights.c). False: im->why says why. */
    bool (*read)(struct importer *im, const struct scene_mesh *mesh);
    /* Fills in what material `use->source` of the file is, for vertices of colour use->tint; the rest of `use` is as
     * import_material.c made it. */
    bool (*material)(struct importer *im, struct material_use *use);
    /* Texels of the image that the file holds as number `index`, < im->embedded. What is wrong with it, or NULL. The function
     * is NULL of formats whose files hold none. */
    const char *(*image)(struct importer *im, unsigned index, struct model_image *out);
} import_format;

/* By content first, then by the name's suffix; what no other reader knows is for Assimp. */
const import_format *import_format_of(const char *file, const uint8_t *head, size_t size);

/* All there are, NULL at the end. */
extern const import_format *const import_formats[];

bool import_has_suffix(const char *file, const char *suffix); /* ".PLY" is ".ply" */

#endif
