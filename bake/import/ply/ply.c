#include "import/ply/ply.h"
#include "import/ply/ply_file.h"
#include <stdlib.h>
#include <string.h>

/* What the elements are, by their names. */
typedef enum subject { OTHER, VERTICES, FACES, STRIPS, EDGES } subject;

static subject subject_of(const ply_element *e) {
    static const struct {
        const char *name;
        subject subject;
    } known[] = {{"vertex", VERTICES}, {"face", FACES}, {"tristrips", STRIPS}, {"tristrip", STRIPS}, {"edge", EDGES}};
    for (size_t i = 0; i < sizeof known / sizeof *known; i++)
        if (strcmp(e->name, known[i].name) == 0)
            return known[i].subject;
    return OTHER;
}

/* By the header alone: what is not done, and whether there is anything to show. */
static bool check_elements(ply_file *p) {
    uint64_t rows[EDGES + 1] = {0};
    for (size_t i = 0; i < p->element_count; i++) {
        const ply_element *e = &p->elements[i];
        const subject what = subject_of(e);
        rows[what] += e->rows;
        if (what == OTHER && e->rows > 0 && !import_not_done(p->im, "element '%.60s' is left out", e->name))
            return false;
    }
    p->im->m->not_triangles += rows[EDGES];
    return rows[FACES] + rows[STRIPS] > 0 ||
           import_fail(p->im, "has no faces, but %llu points and %llu edges, which are not shown",
                       (unsigned long long)rows[VERTICES], (unsigned long long)rows[EDGES]);
}

static bool read_triangles(ply_file *p, const ply_element *e) {
    return subject_of(e) == FACES ? ply_read_faces(p, e) : ply_read_strips(p, e);
}

/* Faces that come before the vertices are passed over, and read when those are known. */
static bool read_element(ply_file *p, ply_element *e) {
    const subject what = subject_of(e);
    if (what == VERTICES)
        return ply_read_vertices(p, e);
    if ((what == FACES || what == STRIPS) && p->has_vertices)
        return read_triangles(p, e);
    e->waits = (what == FACES || what == STRIPS) && e->rows > 0;
    e->at = p->at;
    e->line = p->line;
    p->keep = p->keep || e->waits;
    return ply_skip_element(p, e);
}

static bool check_end(ply_file *p) {
    const uint8_t *at = p->at;
    while (at < p->end && strchr(" \t\r\n", *at)) /* the 0 that ends that text is padding, too */
        at++;
    return at == p->end || import_not_done(p->im, "%zu bytes behind the last element are left out", (size_t)(p->end - p->at));
}

static bool read_elements(ply_file *p) {
    for (size_t i = 0; i < p->element_count; i++)
        if (!read_element(p, &p->elements[i]))
            return false;
    if (!p->has_vertices)
        return import_fail(p->im, "has no element 'vertex'");
    if (!check_end(p))
        return false;
    for (size_t i = 0; i < p->element_count; i++) {
        const ply_element *e = &p->elements[i];
        if (!e->waits)
            continue;
        p->at = e->at;
        p->line = e->line;
        if (!read_triangles(p, e))
            return false;
    }
    return true;
}

static bool read_all(ply_file *p, const scene_mesh *mesh) {
    if (!import_map(p->im, p->im->file, &p->file))
        return import_fail(p->im, "is no PLY file");
    p->at = p->file.at;
    p->end = p->at + p->file.size;
    if (!ply_read_header(p) || !check_elements(p) || !read_elements(p))
        return false;
    import_drop_bytes(&p->file);
    return ply_place(p, mesh->transform);
}

static bool read(importer *im, const scene_mesh *mesh) {
    ply_file *p = calloc(1, sizeof *p);
    if (!p)
        return import_fail(im, "out of memory");
    p->im = im;
    im->reader = p;
    const bool fine = read_all(p, mesh);
    import_drop_bytes(&p->file);
    void *const all[] = {p->elements, p->properties, p->textures, p->position, p->normal, p->uv, p->next, p->key};
    for (size_t i = 0; i < sizeof all / sizeof *all; i++)
        free(all[i]);
    im->reader = NULL;
    free(p);
    return fine;
}

static bool is_it(const uint8_t *head, size_t size) {
    return size >= 4 && memcmp(head, "ply", 3) == 0 && head[3] && strchr(" \t\r\n", head[3]);
}

static const char *const suffixes[] = {".ply", NULL};
static const char *const cannot[] = {"points and edges", "vertex colours that vary", "alpha", NULL};
const import_format ply_format = {
    .name = "PLY", .suffixes = suffixes, .cannot = cannot, .is_it = is_it, .read = read, .material = ply_material};
