#include "import/importer.h"
#include "common/triangle.h"
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct instance {
    const mesh_part *part;
    const double *world; /* 3 x 4 */
    bool mirrored;       /* its determinant is negative */
    uint32_t *vertex;    /* a vertex of the part: its index in the model, VIT_NONE so far */
    uint8_t *kept;       /* a bit a triangle of the part: it survives */
    size_t triangles;    /* those that do */
    float *smooth;       /* 9 a surviving triangle; NULL if the part has normals */
} instance;

void import_multiply(const double a[12], const double b[12], double out[12]) {
    for (int r = 0; r < 3; r++)
        for (int c = 0; c < 4; c++) {
            out[4 * r + c] = c == 3 ? a[4 * r + 3] : 0.0;
            for (int k = 0; k < 3; k++)
                out[4 * r + c] += a[4 * r + k] * b[4 * k + c];
        }
}

static double determinant(const double m[12]) {
    return m[0] * (m[5] * m[10] - m[6] * m[9]) - m[1] * (m[4] * m[10] - m[6] * m[8]) + m[2] * (m[4] * m[9] - m[5] * m[8]);
}

/* By the normal, as vit_triangle has it. */
typedef enum shape { SHAPE_GOOD, SHAPE_FLAT, SHAPE_NOT_FINITE } shape;
static shape triangle_shape(const float *a, const float *b, const float *c) {
    float n[3];
    triangle_normal(a, b, c, n);
    const float square = n[0] * n[0] + n[1] * n[1] + n[2] * n[2];
    if (!isfinite(square)) /* any NaN or infinity among the nine ends up here, and what would overflow later */
        return SHAPE_NOT_FINITE;
    /* Also what is so thin that the normal could not be normalised in float: areas below 1e-19 m2. */
    return square < FLT_MIN ? SHAPE_FLAT : SHAPE_GOOD;
}

/* Vertex `v` of the part in the world. */
static void place_vertex(const instance *in, uint32_t v, float out[3]) {
    const float *at = in->part->position.at + in->part->position.stride * v;
    const double x = (double)at[0], y = (double)at[1], z = (double)at[2], *m = in->world;
    for (size_t k = 0; k < 3; k++, m += 4)
        out[k] = (float)(m[0] * x + m[1] * y + m[2] * z + m[3]);
}

static double larger(double a, double b) {
    return a > b ? a : b;
}

/* How far apart floats lie at this vertex's place from the file's origin. */
static void note_step(model *m, const instance *in, uint32_t v) {
    const float *at = in->part->position.at + in->part->position.stride * v;
    const double *row = in->world;
    double far = 0.0;
    for (size_t k = 0; k < 3; k++, row += 4)
        for (size_t i = 0; i < 3; i++)
            far = larger(fabs(row[i] * (double)at[i]), far);
    m->step = larger(far * 0x1p-23, m->step);
}

/* Corners of triangle `t`, turned round where the world is mirrored. */
static void corners_of(const instance *in, size_t t, uint32_t v[3]) {
    const uint32_t *corner = in->part->corner + 3 * t;
    v[0] = corner[0];
    v[1] = corner[in->mirrored ? 2 : 1];
    v[2] = corner[in->mirrored ? 1 : 2];
}

/* A vertex so far out that areas would not fit a float; infinity and NaN are told of otherwise. */
static bool is_far(importer *im, const float p[9]) {
    float far = 0.0f;
    for (int k = 0; k < 9; k++) {
        const float x = fabsf(p[k]);
        if (!isfinite(x))
            return false;
        far = x > far ? x : far;
    }
    if (far > IMPORT_FAR)
        im->farthest = larger((double)far, im->farthest);
    return far > IMPORT_FAR;
}

/* Keeps the triangle if it has an area, counts it otherwise. */
static void sift_triangle(importer *im, instance *in, size_t t) {
    const uint32_t vertices = in->part->vertices;
    uint32_t v[3];
    float p[9];
    corners_of(in, t, v);
    if (v[0] >= vertices || v[1] >= vertices || v[2] >= vertices) {
        im->bad_index++;
        return;
    }
    for (int k = 0; k < 3; k++)
        place_vertex(in, v[k], p + 3 * k);
    if (is_far(im, p)) {
        im->too_far++;
        return;
    }
    switch (triangle_shape(p, p + 3, p + 6)) {
    case SHAPE_NOT_FINITE:
        im->not_finite++;
        break;
    case SHAPE_FLAT:
        im->m->degenerate++;
        break;
    case SHAPE_GOOD:
        in->kept[t / 8] |= (uint8_t)(1u << t % 8);
        in->triangles++;
        break;
    }
}

static bool is_kept(const instance *in, size_t t) {
    return in->kept[t / 8] >> t % 8 & 1;
}

/* Normal of vertex `v` of the part in the world: by the cofactors of the matrix, which is its inverse transpose up to a
 * factor and needs no inverse. False if the part has none that is of any use there. */
static bool vertex_normal(const instance *in, uint32_t v, float out[3]) {
    const float *a = in->part->normal.at + in->part->normal.stride * v;
    const double *m = in->world, n[3] = {(double)a[0], (double)a[1], (double)a[2]};
    double w[3], square = 0.0;
    for (int i = 0; i < 3; i++) {
        const double *p = m + 4 * ((i + 1) % 3), *q = m + 4 * ((i + 2) % 3);
        w[i] = (p[1] * q[2] - p[2] * q[1]) * n[0] + (p[2] * q[0] - p[0] * q[2]) * n[1] + (p[0] * q[1] - p[1] * q[0]) * n[2];
        if (in->mirrored)
            w[i] = -w[i];
        square += w[i] * w[i];
    }
    const double length = sqrt(square);
    for (int i = 0; i < 3; i++)
        out[i] = (float)(w[i] / length);
    return length > 0.0 && isfinite(length);
}

static void face_normal(const instance *in, const uint32_t corner[3], float out[3]) {
    float a[3], b[3], c[3];
    double e[3], f[3], n[3];
    place_vertex(in, corner[0], a);
    place_vertex(in, corner[1], b);
    place_vertex(in, corner[2], c);
    for (int i = 0; i < 3; i++) {
        e[i] = (double)b[i] - (double)a[i];
        f[i] = (double)c[i] - (double)a[i];
    }
    for (int i = 0; i < 3; i++)
        n[i] = e[(i + 1) % 3] * f[(i + 2) % 3] - e[(i + 2) % 3] * f[(i + 1) % 3];
    const double length = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    for (int i = 0; i < 3; i++)
        out[i] = (float)(n[i] / length);
}

/* v = 0 is the first row of the image in the model. */
static void vertex_uv(const instance *in, const material_use *use, uint32_t v, float out[2]) {
    out[0] = out[1] = 0.0f;
    if (use->uv_set >= IMPORT_UV_SETS || !in->part->uv[use->uv_set].at)
        return;
    const float *a = in->part->uv[use->uv_set].at + in->part->uv[use->uv_set].stride * v;
    double u = (double)a[0], w = in->part->v_up ? 1.0 - (double)a[1] : (double)a[1];
    if (use->has_transform) {
        const double *t = use->uv, was = u;
        u = t[0] * was + t[1] * w + t[2];
        w = t[3] * was + t[4] * w + t[5];
    }
    out[0] = isfinite((float)u) ? (float)u : 0.0f;
    out[1] = isfinite((float)w) ? (float)w : 0.0f;
}

bool import_make_room(importer *im, size_t more, size_t triangles) {
    model *m = im->m;
    if (triangles > VIT_MAX_TRIANGLES - m->triangles)
        return import_fail(im, "more than %u triangles", VIT_MAX_TRIANGLES);
    const size_t vertices = m->vertices + more;
    size_t room[3] = {im->vertex_room, im->vertex_room, im->triangle_room};
    if (!import_room(im, &m->position, &room[0], vertices, 3 * sizeof *m->position) ||
        !import_room(im, &m->normal, &room[1], vertices, 3 * sizeof *m->normal) ||
        !import_room(im, &m->uv, &im->vertex_room, vertices, 2 * sizeof *m->uv) ||
        !import_room(im, &m->index, &room[2], m->triangles + triangles, 3 * sizeof *m->index) ||
        !import_room(im, &m->material, &im->triangle_room, m->triangles + triangles, sizeof *m->material))
        return false;
    return true;
}

static uint32_t add_vertex(model *m, const instance *in, const material_use *use, uint32_t v, const float normal[3]) {
    const size_t at = m->vertices;
    place_vertex(in, v, m->position + 3 * at);
    note_step(m, in, v);
    memcpy(m->normal + 3 * at, normal, 3 * sizeof *m->normal);
    vertex_uv(in, use, v, m->uv + 2 * at);
    return m->vertices++;
}

/* A vertex is shared by the part's triangles if the part has a normal for it; where we made the normals, each corner is one. */
static void add_triangles(importer *im, instance *in, const material_use *use, uint32_t material) {
    model *m = im->m;
    const float *smooth = in->smooth;
    for (size_t t = 0; t < in->part->triangles; t++) {
        uint32_t corner[3];
        if (!is_kept(in, t))
            continue;
        corners_of(in, t, corner);
        for (size_t k = 0; k < 3; k++) {
            const uint32_t v = corner[k];
            float normal[3];
            uint32_t index = smooth ? VIT_NONE : in->vertex[v];
            if (index == VIT_NONE) {
                if (smooth)
                    memcpy(normal, smooth + 3 * k, sizeof normal);
                else if (!vertex_normal(in, v, normal))
                    face_normal(in, corner, normal);
                index = in->vertex[v] = add_vertex(m, in, use, v, normal);
            }
            m->index[3 * (size_t)m->triangles + k] = index;
        }
        m->material[m->triangles++] = material;
        smooth = smooth ? smooth + 9 : NULL;
    }
    m->materials[material].triangles += in->triangles;
}

/* Normals for what survives. */
static bool make_normals(importer *im, instance *in) {
    const mesh_part *part = in->part;
    float *position = calloc(part->vertices, 3 * sizeof *position);
    uint32_t *corner = calloc(in->triangles, 3 * sizeof *corner), *to = corner;
    uint32_t *smoothing = part->smoothing ? calloc(in->triangles, sizeof *smoothing) : NULL;
    size_t kept = 0;
    in->smooth = calloc(in->triangles, 9 * sizeof *in->smooth);
    bool fine = position && corner && in->smooth && (smoothing || !part->smoothing);
    for (uint32_t v = 0; fine && v < part->vertices; v++)
        place_vertex(in, v, position + 3 * (size_t)v);
    for (size_t t = 0; fine && t < part->triangles; t++)
        if (is_kept(in, t)) {
            corners_of(in, t, to);
            to += 3;
            if (smoothing)
                smoothing[kept++] = part->smoothing[t];
        }
    fine = fine && import_normals(position, corner, smoothing, in->triangles, in->smooth);
    free(smoothing);
    free(position);
    free(corner);
    return fine ? true : import_fail(im, "out of memory");
}

/* A vertex colour multiplies the albedo if it is the same all over the part: that one, or NULL. False: strict. */
static bool constant_color(importer *im, const mesh_part *part, const float **tint) {
    const float *c = part->color.at;
    *tint = c;
    for (size_t i = 0; c && i < part->vertices; i++) {
        const float *other = c + i * part->color.stride;
        if (!(other[0] == c[0] && other[1] == c[1] && other[2] == c[2])) {
            const bool said = im->warned_colors;
            im->warned_colors = true;
            *tint = NULL;
            return said || import_not_done(im, "vertex colours that vary over a mesh are left out");
        }
    }
    return true;
}

static bool add_instance(importer *im, instance *in) {
    const mesh_part *part = in->part;
    const float *tint;
    material_use *use;
    uint32_t material;
    for (size_t t = 0; t < part->triangles; t++)
        sift_triangle(im, in, t);
    if (in->triangles == 0)
        return true;
    if (!constant_color(im, part, &tint) || !import_material(im, part->material, tint, &use))
        return false;
    if (use->hole) {
        if (im->clear == 0)
            memcpy(im->clear_name, use->m.name, sizeof im->clear_name);
        im->clear += in->triangles;
        return true;
    }
    if (!part->normal.at && !make_normals(im, in))
        return false;
    const size_t corners = 3 * in->triangles, most = in->smooth || corners < part->vertices ? corners : part->vertices;
    if (!import_material_index(im, use, &material) || !import_make_room(im, most, in->triangles))
        return false;
    const bool has_uv = use->uv_set < IMPORT_UV_SETS && part->uv[use->uv_set].at;
    if (im->m->materials[material].image >= 0 && !has_uv && !use->warned_uv) {
        use->warned_uv = true;
        if (!import_not_done(im,
                             "material '%.100s': mesh '%.100s' and perhaps others have no texture coordinates: of its "
                             "texture they show one colour",
                             use->m.name, part->name))
            return false;
    }
    if (MODEL_HAS_NORMAL_MAP(&im->m->materials[material]) && !has_uv && !use->warned_normal_uv) {
        use->warned_normal_uv = true;
        if (!import_not_done(im,
                             "material '%.100s': mesh '%.100s' and perhaps others have no texture coordinates: its normal map "
                             "does nothing there",
                             use->m.name, part->name))
            return false;
    }
    add_triangles(im, in, use, material);
    return true;
}

bool import_begin_meshes(importer *im, size_t count) {
    im->placed = calloc(count + 1, sizeof *im->placed);
    im->placed_count = im->placed ? count : 0;
    return im->placed ? true : import_fail(im, "out of memory");
}

void import_count_place(importer *im, size_t mesh, const char *name) {
    im->placed[mesh].places++;
    (void)snprintf(im->placed[mesh].name, sizeof im->placed[mesh].name, "%.*s", SCENE_NAME - 1, name);
}

void import_count_file(importer *im, size_t mesh) {
    const char *slash = strrchr(im->file, '/'), *name = slash ? slash + 1 : im->file, *dot = strrchr(name, '.');
    char text[SCENE_NAME];
    (void)snprintf(text, sizeof text, "%.*s", dot && dot > name && dot - name < SCENE_NAME ? (int)(dot - name) : SCENE_NAME - 1,
                   name);
    import_count_place(im, mesh, text);
}

bool import_place(importer *im, size_t mesh, const mesh_part *part, const double world[12]) {
    const uint32_t before = im->m->triangles;
    if (part->vertices == 0 || part->triangles == 0)
        return true;
    instance in = {.part = part, .world = world, .mirrored = determinant(world) < 0.0};
    in.vertex = malloc(part->vertices * sizeof *in.vertex);
    in.kept = calloc(part->triangles / 8 + 1, sizeof *in.kept);
    if (in.vertex)
        memset(in.vertex, 0xff, part->vertices * sizeof *in.vertex); /* VIT_NONE */
    const bool fine = in.vertex && in.kept ? add_instance(im, &in) : import_fail(im, "out of memory");
    free(in.vertex);
    free(in.kept);
    free(in.smooth);
    im->placed[mesh].triangles += im->m->triangles - before;
    return fine;
}
