#include "common/file_trouble.h"
#include "import/importer.h"
#include "common/names.h"
#include <ctype.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- messages and memory ---- */

static void one_line(char *text) {
    for (; *text; text++)
        if (iscntrl((unsigned char)*text))
            *text = ' ';
}

static void fail_by(importer *im, const char *format, va_list args) {
    const int used = snprintf(im->why->text, sizeof im->why->text, "%.200s: ", im->file);
    if (used >= 0)
        (void)vsnprintf(im->why->text + used, sizeof im->why->text - (size_t)used, format, args);
    one_line(im->why->text);
}

static void warn_by(importer *im, const char *format, va_list args) {
    char line[1024];
    const int used = snprintf(line, sizeof line, "%.400s: ", im->file);
    if (used >= 0)
        (void)vsnprintf(line + used, sizeof line - (size_t)used, format, args);
    one_line(line);
    im->m->warnings++;
    if (im->warn)
        im->warn(im->user, line);
}

bool import_fail(importer *im, const char *format, ...) {
    va_list args;
    va_start(args, format);
    fail_by(im, format, args);
    va_end(args);
    return false;
}

void import_warn(importer *im, const char *format, ...) {
    va_list args;
    va_start(args, format);
    warn_by(im, format, args);
    va_end(args);
}

bool import_not_done(importer *im, const char *format, ...) {
    va_list args;
    va_start(args, format);
    if (im->rigour == MODEL_STRICT)
        fail_by(im, format, args);
    else
        warn_by(im, format, args);
    va_end(args);
    return im->rigour != MODEL_STRICT;
}

bool import_room(importer *im, void *block, size_t *room, size_t count, size_t size) {
    void *old;
    memcpy(&old, block, sizeof old);
    if (old && count <= *room)
        return true;
    size_t want = *room < 8 ? 8 : *room;
    while (want < count)
        want += want / 2;
    void *grown = want <= SIZE_MAX / size ? realloc(old, want * size) : NULL;
    if (!grown)
        return import_fail(im, "out of memory");
    memcpy(block, &grown, sizeof grown);
    *room = want;
    return true;
}

/* ---- one file ---- */

/* In one line why nothing is left, if that is all there was to read. */
static bool refuse_empty(importer *im) {
    if (im->not_finite)
        return import_fail(im, "has no triangle with finite positions");
    if (im->too_far)
        return import_fail(im, "has no triangle nearer than %g m: a vertex is at %g m", (double)IMPORT_FAR, im->farthest);
    if (im->bad_index)
        return import_fail(im, "has no triangle whose indices are in range");
    if (im->bad_polygon)
        return import_fail(im, "has no triangle, and no polygon of at most 1024 corners whose indices are in range");
    if (im->clear)
        return import_fail(im, "has no triangle that is not transparent: transparency is not simulated; "
                               "'cutoff = 0' for its materials in the scene file shows them");
    return import_fail(im, "has no triangle");
}

/* Triangles that the reader has placed and that cannot be shown. */
static bool say_dropped(importer *im) {
    return (im->not_finite == 0 || import_not_done(im, "%llu triangles with positions that are not finite dropped",
                                                   (unsigned long long)im->not_finite)) &&
           (im->too_far == 0 || import_not_done(im, "%llu triangles with a vertex farther out than %g m dropped, one at %g m",
                                                (unsigned long long)im->too_far, (double)IMPORT_FAR, im->farthest)) &&
           (im->bad_index == 0 ||
            import_not_done(im, "%llu triangles with an index out of range dropped", (unsigned long long)im->bad_index)) &&
           (im->bad_polygon == 0 ||
            import_not_done(im, "%llu polygons with an index out of range or more than 1024 corners dropped",
                            (unsigned long long)im->bad_polygon)) &&
           (im->clear == 0 ||
            import_not_done(im,
                            "%llu triangles of transparent materials ('%.100s') are left as holes: transparency is not "
                            "simulated; 'cutoff = 0' for a material in a scene file shows it",
                            (unsigned long long)im->clear, im->clear_name));
}

/* What became of what the reader has placed. */
static bool settle_file(importer *im, uint32_t triangles, uint64_t not_triangles) {
    const uint64_t flat = im->m->not_triangles - not_triangles;
    im->m->not_finite += im->not_finite;
    if (im->m->triangles == triangles && im->s->mesh_count == 1)
        return refuse_empty(im);
    if (!say_dropped(im) || (flat > 0 && !import_not_done(im, "%llu points and lines are left out", (unsigned long long)flat)))
        return false;
    return im->m->triangles > triangles || import_not_done(im, "has no triangle");
}

static bool check_there(importer *im) {
    const char *trouble = file_trouble(im->file);
    return trouble ? import_fail(im, "%s", trouble) : true;
}

/* The model's list of meshes: those that a node puts somewhere. */
static bool list_meshes(importer *im) {
    model *m = im->m;
    size_t room = (size_t)m->mesh_count, more = 0;
    for (size_t i = 0; i < im->placed_count; i++)
        more += im->placed[i].places > 0;
    if (more > 0 && !import_room(im, &m->meshes, &room, (size_t)m->mesh_count + more, sizeof *m->meshes))
        return false;
    for (size_t i = 0; i < im->placed_count; i++)
        if (im->placed[i].places > 0) {
            im->placed[i].file = im->file_index;
            m->meshes[m->mesh_count++] = im->placed[i];
        }
    return true;
}

/* Enough of it to know its format. */
enum { HEAD_BYTES = 4096 };

static bool choose_format(importer *im) {
    uint8_t head[HEAD_BYTES];
    FILE *file = fopen(im->file, "rb");
    if (!file)
        return import_fail(im, "cannot be read");
    const size_t size = fread(head, 1, sizeof head, file);
    (void)fclose(file);
    im->format = import_format_of(im->file, head, size);
    return true;
}

/* Which reader it was that read the file; it may have handed it on. */
static bool note_format(importer *im) {
    model *m = im->m;
    size_t room = (size_t)m->format_count;
    model_format format = {.reader = 0, .frame = im->frame};
    while (import_formats[format.reader] != im->format)
        format.reader++;
    if (!import_room(im, &m->formats, &room, room + 1, sizeof *m->formats))
        return false;
    m->formats[m->format_count++] = format;
    return true;
}

/* The mesh for a reader that knows nothing of units and up axes: they are in its place. */
static scene_mesh stand(importer *im, const scene_mesh *mesh) {
    const uint32_t by = im->format->states_frame ? FRAME_BY_FORMAT : FRAME_BY_NOBODY;
    const model_frame stated = {1.0, FRAME_Y, by, by};
    scene_mesh placed = *mesh;
    double own[12];
    import_frame(im, mesh, &stated);
    import_frame_matrix(&im->frame, own);
    if (!im->format->finds_frame)
        import_multiply(mesh->transform, own, placed.transform);
    return placed;
}

static bool read_by_format(importer *im, const scene_mesh *mesh) {
    if (!choose_format(im))
        return false;
    const scene_mesh placed = stand(im, mesh);
    return im->format->read(im, &placed);
}

bool import_file(importer *im, const scene_mesh *mesh) {
    const uint32_t triangles = im->m->triangles;
    const uint64_t not_triangles = im->m->not_triangles;
    const bool fine =
        read_by_format(im, mesh) && list_meshes(im) && note_format(im) && settle_file(im, triangles, not_triangles);
    free(im->placed);
    im->placed = NULL;
    im->placed_count = 0;
    return fine;
}

/* ---- all files ---- */

static void find_box(model *m) {
    for (int k = 0; k < 3; k++) {
        m->lo[k] = m->hi[k] = (double)m->position[k];
        for (size_t i = 1; i < m->vertices; i++) {
            const double p = (double)m->position[3 * i + (size_t)k];
            m->lo[k] = p < m->lo[k] ? p : m->lo[k];
            m->hi[k] = p > m->hi[k] ? p : m->hi[k];
        }
    }
}

static void next_file(importer *im, const char *file) {
    free(im->uses);
    free(im->use_of);
    free(im->means);
    im->uses = NULL;
    im->use_of = NULL;
    im->use_count = im->use_room = im->use_of_room = 0;
    im->means = NULL;
    im->mean_count = im->mean_room = 0;
    im->bad_index = im->not_finite = im->clear = im->bad_polygon = im->too_far = 0;
    im->shown = SHOWN_AS_SAID;
    im->farthest = 0.0;
    im->allowed = im->allowed_texels = 0;
    im->warned_colors = im->states_units = false;
    im->format = NULL;
    im->reader = NULL;
    im->embedded = 0;
    im->file = file;
}

static const char *material_name(const void *list, int index) {
    return ((const model *)list)->materials[index].name;
}

static bool unknown_material(importer *im, const scene_material *o) {
    char names[NAMES_TEXT];
    names_offer(o->name, material_name, im->m, im->m->material_count, names);
    if (im->rigour == MODEL_STRICT)
        return import_fail(im, "line %d: no mesh uses a material '%.60s'%s", o->line, o->name, names);
    import_warn(im, "line %d: no mesh uses a material '%.60s'%s", o->line, o->name, names);
    return true;
}

typedef bool read_fn(importer *im, const scene_mesh *mesh);

static vit_status import_all(const scene *s, model_rigour rigour, model_warn_fn *warn, void *user, read_fn *read, model *out,
                             vit_text *why) {
    importer im = {
        .s = s, .m = out, .rigour = rigour, .warn = warn, .user = user, .why = why, .file = s->path, .status = VIT_BAD_INPUT};
    *out = (model){0};
    im.override_used = calloc((size_t)s->material_count + 1, sizeof *im.override_used);
    bool fine = im.override_used ? true : import_fail(&im, "out of memory");
    for (int i = 0; fine && i < s->mesh_count; i++) {
        next_file(&im, s->meshes[i].file);
        im.file_index = (uint32_t)i;
        fine = check_there(&im) && read(&im, &s->meshes[i]);
    }
    next_file(&im, s->path);
    for (int i = 0; fine && i < s->material_count; i++)
        if (!im.override_used[i])
            fine = unknown_material(&im, &s->materials[i]);
    free(im.override_used);
    if (fine && out->triangles == 0)
        fine = import_fail(&im, "no mesh has a triangle");
    if (fine) {
        find_box(out);
        return VIT_OK;
    }
    model_free(out);
    return im.status;
}

vit_status model_import(const scene *s, model_rigour rigour, model_warn_fn *warn, void *user, model *out, vit_text *why) {
    return import_all(s, rigour, warn, user, import_in_child, out, why);
}

vit_status model_import_here(const scene *s, model_rigour rigour, model_warn_fn *warn, void *user, model *out, vit_text *why) {
    return import_all(s, rigour, warn, user, import_file, out, why);
}

void model_free(model *m) {
    for (int i = 0; i < m->image_count; i++)
        free(m->images[i].rgba);
    free(m->position);
    free(m->normal);
    free(m->uv);
    free(m->index);
    free(m->material);
    free(m->materials);
    free(m->images);
    free(m->cameras);
    free(m->lights);
    free(m->meshes);
    free(m->extensions);
    free(m->formats);
    inputs_free(&m->files);
    *m = (model){0};
}
