#include "import/import_wire.h"
#include "import/importer.h"
#include <ctype.h>
#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* Cameras, lights, files: more than any sane scene has. */
enum { MOST_NAMED = 1 << 20 };
enum { MATERIAL_IMAGES = 2 }; /* of a material: colour and normal map */

/* The head of a model: how many of each follow, in this order, and what is added up. */
typedef struct model_head {
    uint64_t vertices, triangles, materials, images, cameras, lights, meshes, extensions, formats, files, overrides;
    uint64_t texels;
#define X(name, meaning) uint64_t name;
    MODEL_COUNTS(X)
#undef X
    double step;
    char default_highlight[sizeof((model *)0)->default_highlight];
} model_head;

typedef struct image_head {
    char name[SCENE_PATH];
    int32_t width, height;
} image_head;

/* ---- sending ---- */

static void put(wire *to, const void *bytes, size_t size) {
    const char *at = bytes;
    while (size > 0 && !to->failed) {
        const ssize_t n = write(to->fd, at, size < (1u << 30) ? size : 1u << 30);
        if (n > 0) {
            at += n;
            size -= (size_t)n;
        } else if (n < 0 && errno != EINTR)
            to->failed = true;
    }
}

void wire_send(wire *to, wire_kind kind, const void *bytes, size_t size) {
    const wire_head head = {(uint64_t)kind, size};
    put(to, &head, sizeof head);
    put(to, bytes, size);
}

static void send_image(const model_image *image, wire *to) {
    image_head head = {.width = image->width, .height = image->height};
    memcpy(head.name, image->name, sizeof head.name);
    put(to, &head, sizeof head);
    put(to, image->rgba, 4 * (size_t)image->width * (size_t)image->height);
}

void wire_send_model(const importer *im, int images, wire *to) {
    const model *m = im->m;
    model_head head = {.vertices = m->vertices,
                       .triangles = m->triangles,
                       .materials = (uint64_t)m->material_count,
                       .images = (uint64_t)(m->image_count - images),
                       .cameras = (uint64_t)m->camera_count,
                       .lights = (uint64_t)m->light_count,
                       .meshes = (uint64_t)m->mesh_count,
                       .extensions = (uint64_t)m->extension_count,
                       .formats = (uint64_t)m->format_count,
                       .files = m->files.count,
                       .overrides = (uint64_t)im->s->material_count,
#define X(name, meaning) .name = m->name,
                       MODEL_COUNTS(X)
#undef X
                           .texels = im->texels,
                       .step = m->step};
    memcpy(head.default_highlight, m->default_highlight, sizeof head.default_highlight);
    wire_send(to, WIRE_MODEL, &head, sizeof head);
    put(to, m->position, 3 * (size_t)m->vertices * sizeof *m->position);
    put(to, m->normal, 3 * (size_t)m->vertices * sizeof *m->normal);
    put(to, m->uv, 2 * (size_t)m->vertices * sizeof *m->uv);
    put(to, m->index, 3 * (size_t)m->triangles * sizeof *m->index);
    put(to, m->material, (size_t)m->triangles * sizeof *m->material);
    put(to, m->materials, (size_t)m->material_count * sizeof *m->materials);
    put(to, m->cameras, (size_t)m->camera_count * sizeof *m->cameras);
    put(to, m->lights, (size_t)m->light_count * sizeof *m->lights);
    put(to, m->meshes, (size_t)m->mesh_count * sizeof *m->meshes);
    put(to, m->extensions, (size_t)m->extension_count * sizeof *m->extensions);
    put(to, m->formats, (size_t)m->format_count * sizeof *m->formats);
    put(to, im->override_used, (size_t)im->s->material_count);
    for (int i = images; i < m->image_count; i++)
        send_image(&m->images[i], to);
    for (size_t i = 0; i < m->files.count; i++) {
        const char *path = inputs_path(&m->files, i);
        const uint64_t length = strlen(path);
        put(to, &length, sizeof length);
        put(to, path, (size_t)length);
    }
}

/* ---- receiving ---- */

static bool get(wire *from, void *bytes, size_t size) {
    char *at = bytes;
    while (size > 0) {
        const ssize_t n = read(from->fd, at, size < (1u << 30) ? size : 1u << 30);
        if (n > 0) {
            at += n;
            size -= (size_t)n;
        } else if (n == 0 || errno != EINTR) {
            from->ended = true;
            return false;
        }
    }
    return true;
}

bool wire_receive_head(wire *from, wire_head *out) {
    return get(from, out, sizeof *out);
}

bool wire_receive_text(wire *from, uint64_t size, char *text, size_t room) {
    if (size >= room || !get(from, text, (size_t)size))
        return false;
    text[size] = '\0';
    for (char *c = text; *c; c++)
        if (iscntrl((unsigned char)*c))
            *c = ' ';
    return true;
}

static bool all_finite(const float *values, size_t count) {
    for (size_t i = 0; i < count; i++)
        if (!isfinite(values[i]))
            return false;
    return true;
}

static bool all_finite_doubles(const double *values, size_t count) {
    for (size_t i = 0; i < count; i++)
        if (!isfinite(values[i]))
            return false;
    return true;
}

static bool within(const float *values, size_t count, float least, float most) {
    for (size_t i = 0; i < count; i++)
        if (!(values[i] >= least && values[i] <= most))
            return false;
    return true;
}

/* A byte that is neither 0 nor 1 is no bool that could be read. */
static bool is_bool(const bool *value) {
    unsigned char byte;
    memcpy(&byte, value, sizeof byte);
    return byte <= 1;
}

static bool good_material(model_material *m, int images) {
    m->name[sizeof m->name - 1] = '\0';
    return within(m->albedo, 3, 0.0f, VIT_MAX_ALBEDO) && within(m->emission, 3, 0.0f, VIT_MAX_RADIANCE) &&
           m->kind <= VIT_THIN_GLASS && within(m->specular, 3, 0.0f, 1.0f) && within(&m->exponent, 1, 1.0f, VIT_MAX_EXPONENT) &&
           within(&m->lobe_alpha, 1, 0.0f, 1.0f) && within(&m->ior, 1, VIT_MIN_IOR, VIT_MAX_IOR) &&
           within(m->absorption, 3, 0.0f, VIT_MAX_RADIANCE) && is_bool(&m->area_light) && m->image >= -1 && m->image < images &&
           m->wrap_u <= VIT_WRAP_MIRROR && m->wrap_v <= VIT_WRAP_MIRROR && within(&m->cutoff, 1, 0.0f, 1.0f) &&
           within(&m->alpha, 1, 0.0f, 1.0f) && within(&m->normal_scale, 1, -VIT_MAX_NORMAL_SCALE, VIT_MAX_NORMAL_SCALE) &&
           (!MODEL_HAS_NORMAL_MAP(m) || (m->normal_image >= 0 && m->normal_image < images)) &&
           m->normal_wrap_u <= VIT_WRAP_MIRROR && m->normal_wrap_v <= VIT_WRAP_MIRROR;
}

static bool good_camera(model_camera *c) {
    c->name[sizeof c->name - 1] = '\0';
    c->parent[sizeof c->parent - 1] = '\0';
    return all_finite_doubles(c->eye, 3) && all_finite_doubles(c->target, 3) && all_finite_doubles(c->up, 3) &&
           isfinite(c->fov);
}

static bool good_light(model_light *l) {
    l->name[sizeof l->name - 1] = '\0';
    l->parent[sizeof l->parent - 1] = '\0';
    return l->kind >= 0 && l->kind <= (int)VIT_LIGHT_DIRECTIONAL && all_finite_doubles(l->position, 3) &&
           all_finite_doubles(l->direction, 3) && all_finite_doubles(l->power, 3) && all_finite_doubles(l->stated, 3) &&
           isfinite(l->inner) && isfinite(l->outer) && isfinite(l->range) && is_bool(&l->states_unit);
}

static bool good_format(const model_format *f) {
    uint32_t count = 0;
    while (import_formats[count])
        count++;
    return f->reader < count && f->frame.unit > 0.0 && isfinite(f->frame.unit) && f->frame.up <= FRAME_Z &&
           f->frame.unit_by <= FRAME_BY_SCENE && f->frame.up_by <= FRAME_BY_SCENE;
}

/* Counts that can be together. */
static bool good_head(const importer *im, const model_head *h) {
    return h->triangles <= VIT_MAX_TRIANGLES && h->vertices <= 3 * h->triangles && h->materials <= h->triangles &&
           h->images <= MATERIAL_IMAGES * h->materials && h->cameras <= MOST_NAMED && h->lights <= MOST_NAMED &&
           h->meshes <= MOST_NAMED && h->extensions <= MODEL_EXTENSIONS * 2 && h->formats == 1 && h->files <= MOST_NAMED &&
           h->overrides == (uint64_t)im->s->material_count && h->texels >= im->texels && isfinite(h->step);
}

/* Vertices and triangles behind those of the model, and what they refer to. */
static bool receive_triangles(importer *im, const model_head *h, wire *from) {
    model *m = im->m;
    const size_t vertices = (size_t)h->vertices, triangles = (size_t)h->triangles;
    if (!import_make_room(im, vertices, triangles)) {
        from->refused = true;
        return false;
    }
    float *position = m->position + 3 * (size_t)m->vertices, *normal = m->normal + 3 * (size_t)m->vertices,
          *uv = m->uv + 2 * (size_t)m->vertices;
    uint32_t *index = m->index + 3 * (size_t)m->triangles, *material = m->material + m->triangles;
    if (!get(from, position, 3 * vertices * sizeof *position) || !get(from, normal, 3 * vertices * sizeof *normal) ||
        !get(from, uv, 2 * vertices * sizeof *uv) || !get(from, index, 3 * triangles * sizeof *index) ||
        !get(from, material, triangles * sizeof *material) || !all_finite(position, 3 * vertices) ||
        !all_finite(normal, 3 * vertices) || !all_finite(uv, 2 * vertices))
        return false;
    for (size_t i = 0; i < 3 * triangles; i++) {
        if (index[i] >= vertices)
            return false;
        index[i] += m->vertices;
    }
    for (size_t i = 0; i < triangles; i++) {
        if (material[i] >= h->materials)
            return false;
        material[i] += (uint32_t)m->material_count;
    }
    return true;
}

static bool receive_materials(importer *im, const model_head *h, wire *from) {
    model *m = im->m;
    const size_t count = (size_t)h->materials;
    if (!import_room(im, &m->materials, &im->material_room, (size_t)m->material_count + count + 1, sizeof *m->materials)) {
        from->refused = true;
        return false;
    }
    model_material *added = m->materials + m->material_count;
    if (!get(from, added, count * sizeof *added))
        return false;
    for (size_t i = 0; i < count; i++) {
        added[i].triangles = 0;
        if (!good_material(&added[i], m->image_count + (int)h->images))
            return false;
    }
    for (size_t i = 0; i < h->triangles; i++)
        m->materials[m->material[m->triangles + i]].triangles++;
    return true;
}

/* What the file said it uses, and who read it. */
static bool receive_extensions(importer *im, const model_head *h, wire *from) {
    model *m = im->m;
    size_t extensions = (size_t)m->extension_count, formats = (size_t)m->format_count;
    if ((h->extensions > 0 &&
         !import_room(im, &m->extensions, &extensions, extensions + (size_t)h->extensions, sizeof *m->extensions)) ||
        !import_room(im, &m->formats, &formats, formats + 1, sizeof *m->formats)) {
        from->refused = true;
        return false;
    }
    for (uint64_t i = 0; i < h->extensions; i++, m->extension_count++) {
        model_extension *e = &m->extensions[m->extension_count];
        if (!get(from, e, sizeof *e) || !is_bool(&e->required) || !is_bool(&e->read))
            return false;
        e->name[sizeof e->name - 1] = '\0';
        e->file = im->file_index;
    }
    model_format format;
    if (!get(from, &format, sizeof format) || !good_format(&format))
        return false;
    m->formats[m->format_count++] = format;
    return true;
}

static bool receive_named(importer *im, const model_head *h, wire *from) {
    model *m = im->m;
    size_t cameras = (size_t)m->camera_count, lights = (size_t)m->light_count,
           meshes = (size_t)m->mesh_count; /* the lists are as long as what they hold */
    if ((h->cameras > 0 && !import_room(im, &m->cameras, &cameras, cameras + (size_t)h->cameras, sizeof *m->cameras)) ||
        (h->lights > 0 && !import_room(im, &m->lights, &lights, lights + (size_t)h->lights, sizeof *m->lights)) ||
        (h->meshes > 0 && !import_room(im, &m->meshes, &meshes, meshes + (size_t)h->meshes, sizeof *m->meshes))) {
        from->refused = true;
        return false;
    }
    for (uint64_t i = 0; i < h->cameras; i++, m->camera_count++)
        if (!get(from, &m->cameras[m->camera_count], sizeof *m->cameras) || !good_camera(&m->cameras[m->camera_count]))
            return false;
    for (uint64_t i = 0; i < h->lights; i++, m->light_count++)
        if (!get(from, &m->lights[m->light_count], sizeof *m->lights) || !good_light(&m->lights[m->light_count]))
            return false;
    for (uint64_t i = 0; i < h->meshes; i++) {
        model_mesh *mesh = &m->meshes[m->mesh_count];
        if (!get(from, mesh, sizeof *mesh))
            return false;
        mesh->name[sizeof mesh->name - 1] = '\0';
        mesh->file = im->file_index;
        m->mesh_count++;
    }
    if (!receive_extensions(im, h, from))
        return false;
    for (uint64_t i = 0; i < h->overrides; i++) {
        unsigned char used;
        if (!get(from, &used, sizeof used))
            return false;
        im->override_used[i] = im->override_used[i] || used;
    }
    return true;
}

static bool receive_image(importer *im, wire *from) {
    model *m = im->m;
    image_head head;
    if (!get(from, &head, sizeof head) || head.width < 1 || head.width > IMPORT_EDGE || head.height < 1 ||
        head.height > IMPORT_EDGE)
        return false;
    const uint64_t texels = (uint64_t)head.width * (uint64_t)head.height;
    im->texels += texels;
    if (im->texels > IMPORT_TEXELS)
        return false;
    model_image image = {.width = head.width, .height = head.height, .rgba = malloc(4 * (size_t)texels)};
    memcpy(image.name, head.name, sizeof image.name);
    image.name[sizeof image.name - 1] = '\0';
    from->refused = !image.rgba || !import_room(im, &m->images, &im->image_room, (size_t)m->image_count + 1, sizeof *m->images);
    if (from->refused || !get(from, image.rgba, 4 * (size_t)texels)) {
        free(image.rgba);
        return from->refused ? import_fail(im, "out of memory") : false;
    }
    m->images[m->image_count++] = image;
    return true;
}

static bool receive_files(importer *im, const model_head *h, wire *from) {
    char path[4096];
    for (uint64_t i = 0, length; i < h->files; i++) {
        if (!get(from, &length, sizeof length) || length >= sizeof path || !get(from, path, (size_t)length))
            return false;
        path[length] = '\0';
        inputs_add(&im->m->files, path);
    }
    return true;
}

bool wire_receive_model(importer *im, uint64_t size, wire *from) {
    model *m = im->m;
    model_head h;
    if (size != sizeof h || !get(from, &h, sizeof h) || !good_head(im, &h))
        return false;
    const uint64_t texels = h.texels;
    if (!receive_triangles(im, &h, from) || !receive_materials(im, &h, from) || !receive_named(im, &h, from))
        return false;
    /* From here on all that the triangles refer to is there, but for the images. */
    m->vertices += (uint32_t)h.vertices;
    m->triangles += (uint32_t)h.triangles;
    m->material_count += (int)h.materials;
    if (m->default_highlights == 0)
        memcpy(m->default_highlight, h.default_highlight, sizeof m->default_highlight - 1); /* the last byte stays 0 */
#define X(name, meaning) m->name += h.name;
    MODEL_COUNTS(X)
#undef X
    m->step = fmax(m->step, h.step);
    for (uint64_t i = 0; i < h.images; i++)
        if (!receive_image(im, from))
            return false;
    return receive_files(im, &h, from) && im->texels == texels;
}
