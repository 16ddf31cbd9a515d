#include "import/stl/stl.h"
#include "common/strict_math.h"
#include "import/stl/stl_file.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

const char *stl_find(const char *at, const char *end, const char *word) {
    const size_t length = strlen(word);
    for (; (size_t)(end - at) >= length; at++)
        if (strncasecmp(at, word, length) == 0)
            return at;
    return NULL;
}

bool stl_is_text(const uint8_t *at, size_t size) {
    const char *c = (const char *)at, *end = c + size;
    if (size >= 3 && memcmp(c, "\xef\xbb\xbf", 3) == 0)
        c += 3;
    while (c < end && (*c == ' ' || (*c >= '\t' && *c <= '\r')))
        c++;
    return end - c >= 6 && strncasecmp(c, "solid", 5) == 0 && (c[5] == ' ' || (c[5] >= '\t' && c[5] <= '\r'));
}

/* ---- what is placed ---- */

/* Linear; NULL if it has none. */
static const float *color_of(const stl_file *f, uint16_t key, float out[3]) {
    if (key == STL_PLAIN && !f->has_color)
        return NULL;
    for (int k = 0; k < 3; k++)
        out[k] = (float)srgb_linear(key == STL_PLAIN ? f->color[k] / 255.0 : (key >> (5 * k) & 31) / 31.0);
    return out;
}

static size_t end_of(const stl_file *f, size_t solid) {
    return solid + 1 < f->solid_count ? f->solids[solid + 1].first : f->facets;
}

/* Facets of one colour. Their normals are those of their corners, which import_place.c finds where there is none: what files
 * say is that, or 0, or wrong. corner: 0, 1, 2 ... */
static bool place_part(stl_file *f, size_t solid, size_t first, size_t end, const uint32_t *corner, const double world[12]) {
    static const float none[3] = {0.0f, 0.0f, 0.0f};
    float color[3];
    const mesh_part part = {.name = f->im->placed[solid].name,
                            .vertices = (uint32_t)(3 * (end - first)),
                            .position = {f->position + 9 * first, 3},
                            .normal = {none, 0},
                            .color = {color_of(f, f->key ? f->key[first] : STL_PLAIN, color), 0},
                            .corner = corner,
                            .triangles = end - first};
    return import_place(f->im, solid, &part, world);
}

static int by_value(const void *left, const void *right) {
    const uint64_t a = *(const uint64_t *)left, b = *(const uint64_t *)right;
    return (a > b) - (a < b);
}

/* Sorts facets by colour, and as they stand in the file. */
static bool sort_colors(stl_file *f, uint64_t *order, float *position) {
    size_t colors = 0;
    for (size_t i = 0; i < f->facets; i++)
        order[i] = (uint64_t)f->key[i] << 32 | i;
    qsort(order, f->facets, sizeof *order, by_value);
    for (size_t i = 0; i < f->facets; i++)
        colors += i == 0 || order[i] >> 32 != order[i - 1] >> 32;
    if (colors > STL_COLORS) {
        for (size_t i = 0; i < f->facets; i++)
            f->key[i] = STL_PLAIN;
        return import_not_done(f->im, "colours of facets, of which there are more than %d, are left out", STL_COLORS);
    }
    for (size_t i = 0; i < f->facets; i++) {
        memcpy(position + 9 * i, f->position + 9 * (size_t)(uint32_t)order[i], 9 * sizeof *position);
        f->key[i] = (uint16_t)(order[i] >> 32);
    }
    memcpy(f->position, position, 9 * f->facets * sizeof *position);
    return true;
}

static bool settle_colors(stl_file *f) {
    size_t same = 0;
    while (f->key && same < f->facets && f->key[same] == f->key[0])
        same++;
    if (!f->key || same == f->facets)
        return true;
    uint64_t *order = malloc(f->facets * sizeof *order);
    float *position = malloc(9 * f->facets * sizeof *position);
    const bool fine = order && position ? sort_colors(f, order, position) : import_fail(f->im, "out of memory");
    free(order);
    free(position);
    return fine;
}

static bool place_solids(stl_file *f, uint32_t *corner, const double world[12]) {
    for (size_t i = 0; i < 3 * f->facets; i++)
        corner[i] = (uint32_t)i;
    for (size_t i = 0; i < f->solid_count; i++) {
        if (f->solids[i].name[0])
            import_count_place(f->im, i, f->solids[i].name);
        else
            import_count_file(f->im, i);
        for (size_t first = f->solids[i].first, end; first < end_of(f, i); first = end) {
            for (end = first + 1; end < end_of(f, i) && (!f->key || f->key[end] == f->key[first]); end++)
                ;
            if (!place_part(f, i, first, end, corner, world))
                return false;
        }
    }
    return true;
}

static bool place(stl_file *f, const double world[12]) {
    if (f->facets >= VIT_NONE / 3)
        return import_fail(f->im, "has more facets than %u", VIT_NONE / 3 - 1);
    if (!import_begin_meshes(f->im, f->solid_count) || !settle_colors(f))
        return false;
    uint32_t *corner = malloc((3 * f->facets + 1) * sizeof *corner);
    const bool fine = corner ? place_solids(f, corner, world) : import_fail(f->im, "out of memory");
    free(corner);
    return fine;
}

/* ---- the reader ---- */

static bool read(importer *im, const scene_mesh *mesh) {
    stl_file f = {.im = im};
    if (!import_map(im, im->file, &f.file))
        return import_fail(im, "is no STL file");
    const bool binary = stl_is_binary(f.file.at, f.file.size);
    bool fine = binary ? stl_read_binary(&f) : stl_read_text(&f);
    import_drop_bytes(&f.file);
    fine = fine && place(&f, mesh->transform);
    free(f.position);
    free(f.solids);
    free(f.key);
    return fine;
}

static bool material(importer *im, material_use *use) {
    (void)im;
    (void)snprintf(use->m.name, sizeof use->m.name, "default");
    memcpy(use->m.albedo, use->tint, sizeof use->m.albedo);
    return true;
}

/* Binary files are known by their suffix: their first bytes may be any. */
static bool is_it(const uint8_t *head, size_t size) {
    const char *text = (const char *)head;
    return stl_is_text(head, size) && stl_find(text, text + size, "facet") && stl_find(text, text + size, "vertex");
}

static const char *const suffixes[] = {".stl", ".stla", ".stlb", NULL};
static const char *const cannot[] = {"alpha", "colours in text", NULL};
const import_format stl_format = {
    .name = "STL", .suffixes = suffixes, .cannot = cannot, .is_it = is_it, .read = read, .material = material};
