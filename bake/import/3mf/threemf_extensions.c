/* Extensions by their namespaces, and what of a file is left out. */
#include "import/3mf/threemf_file.h"
#include <stdio.h>
#include <string.h>

typedef enum how { UNKNOWN, READ, HARMLESS } how; /* harmless: what it says changes nothing that is seen */

static const struct extension {
    const char *uri, *name;
    how how;
} extensions[] = {
    {"http://schemas.microsoft.com/3dmanufacturing/material/2015/02", "materials and properties", READ},
    {"http://schemas.microsoft.com/3dmanufacturing/production/2015/06", "production", READ},
    {"http://schemas.microsoft.com/3dmanufacturing/trianglesets/2021/07", "triangle sets", HARMLESS},
    {"http://schemas.microsoft.com/3dmanufacturing/production/alternatives/2021/04", "production alternatives", UNKNOWN},
    {"http://schemas.3mf.io/3dmanufacturing/productionalternatives/2021/04", "production alternatives", UNKNOWN},
    {"http://schemas.microsoft.com/3dmanufacturing/slice/2015/07", "slice", UNKNOWN},
    {"http://schemas.microsoft.com/3dmanufacturing/beamlattice/2017/02", "beam lattice", UNKNOWN},
    {"http://schemas.microsoft.com/3dmanufacturing/beamlattice/balls/2020/07", "beam lattice balls", UNKNOWN},
    {"http://schemas.microsoft.com/3dmanufacturing/securecontent/2019/04", "secure content", UNKNOWN},
    {"http://schemas.microsoft.com/3dmanufacturing/securecontent/2019/07", "secure content", UNKNOWN},
    {"http://schemas.3mf.io/3dmanufacturing/booleanoperations/2023/07", "boolean operations", UNKNOWN},
    {"http://schemas.3mf.io/3dmanufacturing/displacement/2023/10", "displacement", UNKNOWN},
    {"http://schemas.3mf.io/3dmanufacturing/volumetric/2022/01", "volumetric", UNKNOWN},
    {"http://schemas.3mf.io/3dmanufacturing/implicit/2023/12", "implicit", UNKNOWN},
};

/* NULL: of nobody that is known here. */
static const struct extension *known(const char *uri) {
    for (size_t i = 0; i < sizeof extensions / sizeof *extensions; i++)
        if (strcmp(extensions[i].uri, uri) == 0)
            return &extensions[i];
    return NULL;
}

/* The model's entry for it; NULL: out of memory. */
static model_extension *entry(threemf_file *f, const char *uri) {
    const struct extension *e = known(uri);
    model *m = f->im->m;
    model_extension fresh = {.file = f->im->file_index, .read = e && e->how != UNKNOWN};
    if (e)
        (void)snprintf(fresh.name, sizeof fresh.name, "%s", e->name);
    else
        (void)snprintf(fresh.name, sizeof fresh.name, "%.60s", uri);
    for (int i = 0; i < m->extension_count; i++)
        if (m->extensions[i].file == fresh.file && strcmp(m->extensions[i].name, fresh.name) == 0)
            return &m->extensions[i];
    size_t room = (size_t)m->extension_count;
    if (m->extension_count >= MODEL_EXTENSIONS) {
        (void)import_fail(f->im, "has more than %d extensions", MODEL_EXTENSIONS);
        return NULL;
    }
    if (!import_room(f->im, &m->extensions, &room, room + 1, sizeof *m->extensions))
        return NULL;
    m->extensions[m->extension_count++] = fresh;
    return &m->extensions[m->extension_count - 1];
}

bool threemf_note_extension(threemf_file *f, const char *uri, bool required) {
    model_extension *e = entry(f, uri);
    if (!e)
        return false;
    const bool fresh = required && !e->required;
    e->required |= required;
    if (e->read || !fresh)
        return true;
    if (f->im->rigour != MODEL_LISTS)
        return import_fail(f->im, "extension '%s' is required and not read", e->name);
    import_warn(f->im, "extension '%s' is required and not read", e->name);
    return true;
}

bool threemf_is_new(threemf_file *f, const char *name) {
    for (unsigned i = 0; i < f->said_count; i++)
        if (strcmp(f->said[i], name) == 0)
            return false;
    if (f->said_count == THREEMF_SAID)
        return false;
    (void)snprintf(f->said[f->said_count++], sizeof *f->said, "%s", name);
    return true;
}

bool threemf_leave_out(threemf_file *f, const threemf_element *e) {
    const struct extension *of = known(e->uri);
    char name[64];
    (void)snprintf(name, sizeof name, "element '%.40s'", e->name);
    if (e->ns == THREEMF_FOREIGN && !threemf_note_extension(f, e->uri, false))
        return false;
    if ((of && of->how == HARMLESS) || !threemf_is_new(f, name))
        return true;
    if (of)
        return import_not_done(f->im, "%s of the extension '%s' is left out", name, of->name);
    return import_not_done(f->im, "%s is left out", name);
}

bool threemf_leave_out_attribute(threemf_file *f, const char *name) {
    char what[64];
    (void)snprintf(what, sizeof what, "attribute '%.40s'", name);
    return !threemf_is_new(f, what) || import_not_done(f->im, "%s of triangles is left out", what);
}
