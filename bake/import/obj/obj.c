#include "import/obj/obj.h"
#include "import/obj/obj_file.h"
#include <stdlib.h>
#include <string.h>

static bool is_utf16(const import_bytes *bytes) {
    return bytes->size >= 2 && (memcmp(bytes->at, "\xfe\xff", 2) == 0 || memcmp(bytes->at, "\xff\xfe", 2) == 0);
}

static bool read_all(obj_file *o, const scene_mesh *mesh) {
    if (!import_map(o->im, o->im->file, &o->bytes))
        return import_fail(o->im, "is empty or cannot be read");
    if (is_utf16(&o->bytes))
        return import_fail(o->im, "is text of 16 bits a character, and has to be UTF-8");
    const bool fine = obj_read(o);
    import_drop_bytes(&o->bytes); /* a part of the memory that the model needs */
    return fine && mtl_read(o) && import_begin_meshes(o->im, o->meshes.count) && mtl_transparency(o) &&
           obj_place(o, mesh->transform);
}

static void close_file(obj_file *o) {
    for (size_t i = 0; i < o->library_count; i++)
        import_drop_bytes(&o->library[i]);
    free(o->library);
    free(o->mtl);
    obj_free_names(&o->materials);
    obj_free_names(&o->libraries);
    obj_free_names(&o->meshes);
    free(o->position);
    free(o->color);
    free(o->uv);
    free(o->normal);
    free(o->corner);
    free(o->corner_uv);
    free(o->corner_normal);
    free(o->face);
    free(o->smoothing);
    free(o->part);
    import_drop_bytes(&o->bytes);
}

static bool read(importer *im, const scene_mesh *mesh) {
    obj_file *o = calloc(1, sizeof *o);
    if (!o)
        return import_fail(im, "out of memory");
    o->im = im;
    im->reader = o;
    const bool fine = read_all(o, mesh);
    close_file(o);
    im->reader = NULL;
    free(o);
    return fine;
}

/* Its first statement is one of those that OBJ alone begins with. */
static bool is_it(const uint8_t *head, size_t size) {
    static const char *const words[] = {"mtllib", "usemtl", "vt", "vn", NULL};
    const import_bytes bytes = {.at = head, .size = size};
    obj_lines lines = obj_lines_of(&bytes);
    obj_text line;
    float number;
    while (obj_next_line(&lines, &line)) {
        const obj_text word = obj_word(&line);
        if (obj_is_empty(word))
            continue;
        for (size_t i = 0; words[i]; i++)
            if (obj_is(word, words[i]))
                return !obj_is_empty(obj_rest(line));
        return obj_is(word, "v") && obj_number(&line, &number) && obj_number(&line, &number) && obj_number(&line, &number);
    }
    return false;
}

static const char *const suffixes[] = {".obj", NULL};
static const char *const cannot[] = {"curves and surfaces of free form", "bump maps and emissive textures",
                                     "vertex colours that vary", NULL};
const import_format obj_format = {
    .name = "OBJ", .suffixes = suffixes, .cannot = cannot, .is_it = is_it, .read = read, .material = mtl_material};
