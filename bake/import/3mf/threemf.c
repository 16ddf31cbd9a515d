#include "import/3mf/threemf.h"
#include "import/3mf/threemf_file.h"
#include <stdlib.h>
#include <string.h>

/* Z is up (Core 3.1). */
static void find_stand(threemf_file *f, const scene_mesh *mesh, double stand[12]) {
    const threemf_part *root = &f->parts[0];
    const model_frame stated = {root->unit, FRAME_Z, root->has_unit ? FRAME_BY_FILE : FRAME_BY_FORMAT, FRAME_BY_FORMAT};
    double own[12];
    import_frame(f->im, mesh, &stated);
    import_frame_matrix(&f->im->frame, own);
    import_multiply(mesh->transform, own, stand);
}

static bool read_all(threemf_file *f, const scene_mesh *mesh) {
    double stand[12];
    if (!threemf_open(f) || !threemf_read_models(f) || !threemf_sort(f))
        return false;
    find_stand(f, mesh, stand);
    f->im->embedded = (unsigned)f->group_count + 1;
    return threemf_find_places(f, stand) && threemf_resolve(f) &&
           (f->look_count == 0 || import_transparency(f->im, f->of_look, (unsigned)f->look_count)) && threemf_place_all(f);
}

static void close_file(threemf_file *f) {
    for (size_t i = 0; i < f->object_count; i++) {
        free(f->objects[i].position);
        free(f->objects[i].corner);
        free(f->objects[i].ref);
    }
    void *const all[] = {f->text,  f->parts,  f->objects,  f->groups, f->resources, f->colors, f->uv,      f->picks,
                         f->mixed, f->metals, f->children, f->items,  f->places,    f->looks,  f->of_look, f->paint};
    for (size_t i = 0; i < sizeof all / sizeof *all; i++)
        free(all[i]);
    if (f->archive)
        zip_discard(f->archive);
    import_drop_bytes(&f->bytes);
}

static bool read(importer *im, const scene_mesh *mesh) {
    threemf_file *f = calloc(1, sizeof *f);
    if (!f)
        return import_fail(im, "out of memory");
    f->im = im;
    im->reader = f;
    const bool fine = read_all(f, mesh);
    close_file(f);
    im->reader = NULL;
    free(f);
    return fine;
}

/* An archive that begins with a part that 3MF has. */
static bool is_it(const uint8_t *head, size_t size) {
    static const char *const parts[] = {"3D/", "_rels/.rels", "[Content_Types].xml"};
    enum { NAME = 30 }; /* where the first file's name begins */
    if (size < NAME || memcmp(head, "PK\3\4", 4) != 0)
        return false;
    for (size_t i = 0; i < sizeof parts / sizeof *parts; i++)
        if (size >= NAME + strlen(parts[i]) && memcmp(head + NAME, parts[i], strlen(parts[i])) == 0)
            return true;
    return false;
}

static const char *const suffixes[] = {".3mf", NULL};
static const char *const cannot[] = {"slices, beam lattices, volumes, displacement and boolean operations", "translucency",
                                     "layers of properties but the last", "supports", NULL};
const import_format threemf_format = {.name = "3MF",
                                      .suffixes = suffixes,
                                      .cannot = cannot,
                                      .finds_frame = true,
                                      .is_it = is_it,
                                      .read = read,
                                      .material = threemf_material,
                                      .image = threemf_image};
