/* The archive: a ZIP file, in ZIP64 or not, whose relations name the model (Open Packaging Conventions). */
#include "import/3mf/threemf_file.h"
#include "import/import_zip.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

bool threemf_open(threemf_file *f) {
    zip_error_t error;
    if (!import_map(f->im, f->im->file, &f->bytes))
        return import_fail(f->im, "is empty or cannot be read");
    zip_error_init(&error);
    zip_source_t *source = zip_source_buffer_create(f->bytes.at, f->bytes.size, 0, &error);
    f->archive = source ? zip_open_from_source(source, ZIP_RDONLY, &error) : NULL;
    if (!f->archive) {
        (void)import_fail(f->im, "is no 3MF archive: %.100s", zip_error_strerror(&error));
        zip_source_free(source);
    }
    zip_error_fini(&error);
    return f->archive != NULL;
}

zip_file_t *threemf_open_part(threemf_file *f, const char *name, const char **wrong) {
    const zip_int64_t index = zip_name_locate(f->archive, name + strspn(name, "/"), ZIP_FL_NOCASE);
    zip_file_t *file = index >= 0 ? zip_fopen_index(f->archive, (zip_uint64_t)index, 0) : NULL;
    *wrong = file ? NULL : index < 0 ? "is missing" : "is packed or encrypted in a way that is not read";
    return file;
}

/* ---- relations ---- */

static bool begin_relation(threemf_xml *x, const threemf_element *e, bool *skip) {
    static const char ending[] = "/3dmodel";
    const char *type = threemf_attribute(e, "Type"), *target = threemf_attribute(e, "Target");
    uint32_t *path = x->user;
    *skip = false;
    if (strcmp(e->name, "Relationship") != 0 || !type || !target || *path != THREEMF_NONE)
        return true;
    const size_t length = strlen(type);
    if (length < sizeof ending - 1 || strcmp(type + length - (sizeof ending - 1), ending) != 0)
        return true;
    return threemf_keep(x->f, target, path);
}

bool threemf_find_root(threemf_file *f, uint32_t *path) {
    const char *wrong;
    zip_file_t *relations = threemf_open_part(f, "_rels/.rels", &wrong);
    *path = THREEMF_NONE;
    if (relations) {
        threemf_xml x = {.f = f, .begin = begin_relation, .user = path};
        (void)zip_fclose(relations);
        if (!threemf_read_xml(&x, "_rels/.rels"))
            return false;
    }
    return *path != THREEMF_NONE || threemf_keep(f, "/3D/3dmodel.model", path);
}

/* ---- pictures ---- */

const char *threemf_image(importer *im, unsigned index, model_image *out) {
    threemf_file *f = im->reader;
    const char *wrong;
    size_t size;
    if (index >= f->group_count)
        return threemf_paint_image(f, out);
    zip_file_t *file = threemf_open_part(f, f->text + f->groups[index].path, &wrong);
    if (!file)
        return wrong;
    uint8_t *bytes = import_unzipped(file, &size);
    (void)zip_fclose(file);
    wrong = bytes ? import_decode(im, bytes, size, out) : "is damaged, or too long";
    free(bytes);
    return wrong;
}
