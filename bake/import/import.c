#include "common/file_trouble.h"
#include "import/gltf_extensions.h"
#include "import/importer.h"
#include "common/names.h"
#include <assimp/cimport.h>
#include <ctype.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

/* ---- messages and memory ---- */

static void one_line(char *text) {
    for (; *text; text++)
        if (iscntrl((unsigned char)*text))
            *text = ' ';
}

bool import_fail(importer *im, const char *format, ...) {
    va_list args;
    va_start(args, format);
    const int used = snprintf(im->why->text, sizeof im->why->text, "%.200s: ", im->file);
    if (used >= 0)
        (void)vsnprintf(im->why->text + used, sizeof im->why->text - (size_t)used, format, args);
    va_end(args);
    one_line(im->why->text);
    return false;
}

void import_warn(importer *im, const char *format, ...) {
    char line[1024];
    va_list args;
    va_start(args, format);
    const int used = snprintf(line, sizeof line, "%.400s: ", im->file);
    if (used >= 0)
        (void)vsnprintf(line + used, sizeof line - (size_t)used, format, args);
    va_end(args);
    one_line(line);
    im->m->warnings++;
    if (im->warn)
        im->warn(im->user, line);
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

static void multiply(const double a[12], const struct aiMatrix4x4 *b, double out[12]) {
    const float rows[12] = {b->a1, b->a2, b->a3, b->a4, b->b1, b->b2, b->b3, b->b4, b->c1, b->c2, b->c3, b->c4};
    for (int r = 0; r < 3; r++)
        for (int c = 0; c < 4; c++) {
            out[4 * r + c] = c == 3 ? a[4 * r + 3] : 0.0;
            for (int k = 0; k < 3; k++)
                out[4 * r + c] += a[4 * r + k] * (double)rows[4 * k + c];
        }
}

static bool place_mesh(importer *im, unsigned index, const double world[12]) {
    const uint32_t before = im->m->triangles;
    const bool fine = import_mesh(im, index, world);
    im->placed[index].places++;
    im->placed[index].triangles += im->m->triangles - before;
    return fine;
}

static bool add_node(importer *im, const struct aiNode *node, const double parent[12], int depth) {
    double world[12];
    if (depth > IMPORT_DEPTH)
        return import_fail(im, "nodes are nested deeper than %d", IMPORT_DEPTH);
    multiply(parent, &node->mTransformation, world);
    for (unsigned i = 0; i < node->mNumMeshes; i++) {
        if (node->mMeshes[i] >= im->ai->mNumMeshes)
            return import_fail(im, "node '%.100s' has mesh %u of %u", node->mName.data, node->mMeshes[i], im->ai->mNumMeshes);
        if (!place_mesh(im, node->mMeshes[i], world))
            return false;
    }
    if (!import_node_camera(im, node, world) || !import_node_light(im, node, world))
        return false;
    for (unsigned i = 0; i < node->mNumChildren; i++)
        if (!add_node(im, node->mChildren[i], world, depth + 1))
            return false;
    return true;
}

bool import_has_suffix(const char *file, const char *suffix) {
    const size_t n = strlen(file), k = strlen(suffix);
    return n >= k && !strcasecmp(file + n - k, suffix);
}

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

/* Meshes whose nodes Assimp has lost stand where the root does: in RAW files that is where they belong. */
static bool add_strays(importer *im, const scene_mesh *mesh) {
    unsigned strays = 0;
    double world[12];
    multiply(mesh->transform, &im->ai->mRootNode->mTransformation, world);
    for (unsigned i = 0; i < im->ai->mNumMeshes; i++)
        if (import_is_stray(im, i)) {
            strays++;
            if (!place_mesh(im, i, world))
                return false;
        }
    if (strays > 0 && !import_has_suffix(im->file, ".raw"))
        import_warn(im, "the mesh reader has lost the places of %u meshes; they stand at the origin", strays);
    return true;
}

/* The model's list of meshes. */
static bool list_meshes(importer *im) {
    model *m = im->m;
    size_t room = (size_t)m->mesh_count, more = 0;
    for (unsigned i = 0; i < im->ai->mNumMeshes; i++)
        more += im->placed[i].places > 0;
    if (more > 0 && !import_room(im, &m->meshes, &room, (size_t)m->mesh_count + more, sizeof *m->meshes))
        return false;
    for (unsigned i = 0; i < im->ai->mNumMeshes; i++)
        if (im->placed[i].places > 0) {
            model_mesh *to = &m->meshes[m->mesh_count++];
            *to = im->placed[i];
            to->file = im->file_index;
            (void)snprintf(to->name, sizeof to->name, "%.*s", SCENE_NAME - 1, im->ai->mMeshes[i]->mName.data);
        }
    return true;
}

static bool add_scene(importer *im, const scene_mesh *mesh) {
    const uint32_t before = im->m->triangles;
    if (!im->ai->mRootNode)
        return import_fail(im, "has no nodes");
    im->placed = calloc((size_t)im->ai->mNumMeshes + 1, sizeof *im->placed);
    if (!im->placed)
        return import_fail(im, "out of memory");
    const bool placed = import_transparency(im) && add_node(im, im->ai->mRootNode, mesh->transform, 0) &&
                        add_strays(im, mesh) && list_meshes(im);
    free(im->placed);
    im->placed = NULL;
    if (!placed)
        return false;
    im->m->not_finite += im->not_finite;
    if (im->m->triangles == before && im->s->mesh_count == 1)
        return refuse_empty(im);
    if (im->not_finite)
        import_warn(im, "%llu triangles with positions that are not finite dropped", (unsigned long long)im->not_finite);
    if (im->too_far)
        import_warn(im, "%llu triangles with a vertex farther out than %g m dropped, one at %g m",
                    (unsigned long long)im->too_far, (double)IMPORT_FAR, im->farthest);
    if (im->bad_index)
        import_warn(im, "%llu triangles with an index out of range dropped", (unsigned long long)im->bad_index);
    if (im->bad_polygon)
        import_warn(im, "%llu polygons with an index out of range or more than 1024 corners dropped",
                    (unsigned long long)im->bad_polygon);
    if (im->clear)
        import_warn(im,
                    "%llu triangles of transparent materials ('%.100s') are left as holes: transparency is not "
                    "simulated; 'cutoff = 0' for a "
                    "material in a scene file shows it",
                    (unsigned long long)im->clear, im->clear_name);
    if (im->m->triangles == before)
        import_warn(im, "has no triangle");
    return true;
}

/* What Assimp says, in one line. */
static bool fail_by_assimp(importer *im) {
    const char *text = aiGetErrorString();
    if (text && strstr(text, "bad_alloc"))
        return import_fail(im, "takes more memory than a file of its size is given");
    return import_fail(im, "%.250s", text && *text ? text : "cannot be understood");
}

static bool check_there(importer *im) {
    const char *trouble = file_trouble(im->file);
    return trouble ? import_fail(im, "%s", trouble) : true;
}

static bool has_materials(importer *im) {
    if (!im->no_materials[0])
        return true;
    if (im->strict)
        return import_fail(im, "its material file '%.100s' is not there", im->no_materials);
    import_warn(im, "its material file '%.100s' is not there", im->no_materials);
    return true;
}

bool import_file(importer *im, const scene_mesh *mesh) {
    struct aiFileIO io = import_file_io(im);
    /* Polygons become triangles later; everything else is done here, so that it is the same for all releases of Assimp. */
    im->ai = aiImportFileEx(mesh->file, 0, &io);
    if (!im->ai)
        return fail_by_assimp(im);
    const bool fine = has_materials(im) && import_mend_tree(im) && import_triangulate(im) && add_scene(im, mesh);
    import_free_cuts(im);
    if (im->ai && !im->to_parent) /* the child is thrown away whole: some readers' trees do not survive being freed */
        aiReleaseImport(im->ai);
    return fine;
}

/* ---- all files ---- */

/* What a glTF file cannot be understood without, by its own word. */
static bool check_required(importer *im) {
    gltf_extension found[GLTF_EXTENSIONS];
    const int count = im->gltf ? gltf_extensions(im->file, found) : 0;
    for (int i = 0; i < count; i++) {
        if (!found[i].required || found[i].read)
            continue;
        if (im->strict)
            return import_fail(im, "extension '%s' is required and not read", found[i].name);
        import_warn(im, "extension '%s' is required and not read", found[i].name);
    }
    return true;
}

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
    im->uses = NULL;
    im->use_count = im->use_room = 0;
    im->bad_index = im->not_finite = im->clear = im->bad_polygon = im->too_far = 0;
    im->inverse = false;
    im->shown = SHOWN_AS_SAID;
    im->farthest = 0.0;
    im->allowed = im->allowed_texels = 0;
    im->no_materials[0] = '\0';
    im->warned_colors = im->warned_morph = im->warned_bones = false;
    free(im->means);
    im->means = NULL;
    im->mean_count = im->mean_room = 0;
    im->ai = NULL;
    im->file = file;
    im->gltf = import_has_suffix(file, ".gltf") || import_has_suffix(file, ".glb");
}

static const char *material_name(const void *list, int index) {
    return ((const model *)list)->materials[index].name;
}

static bool unknown_material(importer *im, const scene_material *o) {
    char names[NAMES_TEXT];
    names_offer(o->name, material_name, im->m, im->m->material_count, names);
    if (im->strict)
        return import_fail(im, "line %d: no mesh uses a material '%.60s'%s", o->line, o->name, names);
    import_warn(im, "line %d: no mesh uses a material '%.60s'%s", o->line, o->name, names);
    return true;
}

typedef bool read_fn(importer *im, const scene_mesh *mesh);

static vit_status import_all(const scene *s, bool strict, model_warn_fn *warn, void *user, read_fn *read, model *out,
                             vit_text *why) {
    importer im = {
        .s = s, .m = out, .strict = strict, .warn = warn, .user = user, .why = why, .file = s->path, .status = VIT_BAD_INPUT};
    *out = (model){0};
    im.override_used = calloc((size_t)s->material_count + 1, sizeof *im.override_used);
    bool fine = im.override_used ? true : import_fail(&im, "out of memory");
    for (int i = 0; fine && i < s->mesh_count; i++) {
        next_file(&im, s->meshes[i].file);
        im.file_index = (uint32_t)i;
        fine = check_there(&im) && check_required(&im) && import_check_ply(&im) && read(&im, &s->meshes[i]);
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

vit_status model_import(const scene *s, bool strict, model_warn_fn *warn, void *user, model *out, vit_text *why) {
    return import_all(s, strict, warn, user, import_in_child, out, why);
}

vit_status model_import_here(const scene *s, bool strict, model_warn_fn *warn, void *user, model *out, vit_text *why) {
    return import_all(s, strict, warn, user, import_file, out, why);
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
    inputs_free(&m->files);
    *m = (model){0};
}
