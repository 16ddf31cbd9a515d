/* import*.c: what the parts of the importer share. Private to them. */
#ifndef VIT_BAKE_IMPORTER_H
#define VIT_BAKE_IMPORTER_H

#include "import/import_wire.h"
#include "import/model.h"
#include "vitrine_pack.h"
#include <assimp/cfileio.h>
#include <assimp/material.h>
#include <assimp/scene.h>

/* Transparent materials that are shown after all, since too little would be left. */
typedef enum import_shown { SHOWN_AS_SAID, SHOWN_INVISIBLE, SHOWN_HOLES } import_shown; /* none; those of alpha 0; all */

enum { IMPORT_DEPTH = 256, IMPORT_EDGE = 16384 }; /* levels of the node tree; pixels of an image's edge */
enum { IMPORT_CORNERS = 1024 };                   /* of a polygon: cutting ears takes the square of them and more */
#define IMPORT_TEXELS ((uint64_t)1 << 30)         /* of all images together: 4 GiB decoded */
#define IMPORT_FAR 1e9f                           /* m: beyond, areas do not fit a float */

/* What a mesh's polygons of five corners and more became: 3 vertices of the mesh a triangle. */
typedef struct polygon_cut {
    uint32_t *corner;
    size_t triangles;
} polygon_cut;

/* One mesh file being read. */
typedef struct importer {
    const scene *s;
    model *m;
    bool strict;
    model_warn_fn *warn;
    void *user;
    vit_text *why;

    const char *file; /* path as the scene gives it; every message starts with it */
    const struct aiScene *ai;
    bool gltf;                 /* the file is glTF: alpha modes and UV transforms follow its rules */
    struct material_use *uses; /* materials of this file that a triangle uses */
    size_t use_count, use_room;
    bool *override_used; /* one a scene material: some mesh has a material of that name */
    size_t vertex_room, triangle_room, material_room, image_room;
    uint64_t texels;                       /* of all images so far */
    uint64_t bad_index, not_finite, clear; /* triangles of this file dropped for an index, a NaN, transparency */
    uint64_t bad_polygon;                  /* polygons dropped for an index or too many corners */
    char clear_name[SCENE_NAME];           /* material of the first that was dropped for transparency */
    bool inverse;                          /* the file's opacities are transparencies (import_transparency.c) */
    import_shown shown;
    bool warned_colors, warned_morph, warned_bones;
    struct texture_mean *means; /* that were asked for, of this file */
    size_t mean_count, mean_room;
    uint64_t too_far;              /* triangles of this file with a vertex beyond IMPORT_FAR */
    double farthest;               /* m */
    char no_materials[SCENE_NAME]; /* material file that is not there; "" if all are */
    uint32_t file_index;           /* in scene.meshes */
    model_mesh *placed;            /* a mesh of the file each: places and triangles so far */
    polygon_cut *cuts;             /* a mesh of the file each */
    unsigned cut_count;
    unsigned lost_nodes; /* that were NULL in Assimp's tree */

    vit_status status;                /* of what fails: VIT_BAD_INPUT, unless it is not the file's fault */
    wire *to_parent;                  /* in the child; else NULL */
    uint64_t allowed, allowed_texels; /* bytes of the files and texels of the images that earn time and memory */
    uint64_t mapped;                  /* bytes of address space that the child began with */
} importer;

/* A material as one mesh sees it: which texture coordinates, which constant vertex colour. */
typedef struct material_use {
    unsigned ai_index;
    float tint[3];          /* constant vertex colour, 1 if none */
    model_material m;       /* image still -1 */
    bool hole;              /* all of it is transparent: its triangles are dropped */
    bool cutoff_asked;      /* the scene file has a cutoff for it */
    bool alpha_mapped;      /* the colour texture's alpha counts */
    char image[SCENE_PATH]; /* file or "*index" as Assimp gives it; "" if none */
    bool image_resolved;    /* `image` comes from the scene file: take it as it is */
    int image_line;         /* there, for errors */
    unsigned uv_set;
    bool has_transform;
    double uv[6];   /* u' = uv[0] u + uv[1] v + uv[2], v' = uv[3] u + uv[4] v + uv[5] */
    bool warned_uv; /* of a mesh without texture coordinates: one warning will do */
    int index;      /* in model.materials, -1 until a triangle uses it */
} material_use;

/* Writes "file: ..." into why->text and returns false. */
bool import_fail(importer *im, const char *format, ...) __attribute__((format(printf, 2, 3)));
/* Gives "file: ..." to the user as a warning. */
void import_warn(importer *im, const char *format, ...) __attribute__((format(printf, 2, 3)));
/* Makes room for `count` things of `size` bytes in *block. */
bool import_room(importer *im, void *block, size_t *room, size_t count, size_t size);

bool import_has_suffix(const char *file, const char *suffix); /* ".PLY" is ".ply" */

/* import_ply.c: refuses a PLY file whose header has no end or lines of no known kind: Assimp's reader never comes back from
 * them. Every other file passes. */
bool import_check_ply(importer *im);

/* import_child.c: has a child process read the file and appends what it sends to the model. Foreign readers end the process on
 * some malformed files, by an assertion or a bad access, while they read, while they are asked, or while they clean up; others
 * they do not come back from. None of it happens here: that child has limits of processor time and memory, which grow with the
 * files that it opens. */
bool import_in_child(importer *im, const scene_mesh *mesh);
/* More bytes of files, more texels of images: more time and memory. */
void import_allow(importer *im, size_t bytes);
void import_allow_texels(importer *im, uint64_t texels);

/* import.c: reads the file and appends it to the model, in this process. */
bool import_file(importer *im, const scene_mesh *mesh);

/* import_files.c: what Assimp reads files through; `im` must outlive it. */
struct aiFileIO import_file_io(importer *im);
/* Notes a file of so many bytes as an input. */
void import_note_file(importer *im, const char *path, size_t bytes);

/* import_tree.c: takes NULL out of the lists of Assimp's tree, or refuses it. */
bool import_mend_tree(importer *im);
/* A mesh that no node leads to, in a tree that had holes: its node was lost. */
bool import_is_stray(const importer *im, unsigned mesh);

/* import_faces.c: cuts polygons into triangles; those with a bad index or more than 1024 corners are emptied and counted, those
 * of five and more emptied, too, and their triangles kept in im->cuts. */
bool import_triangulate(importer *im);
void import_free_cuts(importer *im);
/* import_cut.c: does so with a mesh; its indices are in range. */
bool import_cut(importer *im, const struct aiMesh *mesh, polygon_cut *out);

/* import_material.c: the use of material `ai_index` with vertex colour `tint`; false: out of memory.
 * The pointer is good until the next call. */
bool import_material(importer *im, unsigned ai_index, const float tint[3], material_use **use);
/* Loads the use's image and appends its material to the model, on first call. */
bool import_material_index(importer *im, material_use *use, uint32_t *index);

/* import_material.c: of Assimp's material: `count` floats, if it has as many; keys are macros of three arguments, key, type,
 * index. */
bool import_floats(const struct aiMaterial *ai, const char *key, unsigned type, unsigned index, float *out, unsigned count);
float import_clamp(float value, float most); /* to 0..most; NaN is 0 */

/* import_specular.c: kind, lobe, glass and what they leave of the albedo, once colour, emission and alpha are known. False: a
 * texture that is needed (strict), or out of memory. */
bool import_shine(importer *im, material_use *use, const struct aiMaterial *ai);
/* What the scene file says of them. */
void import_override_specular(importer *im, model_material *m, const scene_material *o);
/* Last: no more is reflected than arrives, and nothing stays that the kind has no use for. */
void import_settle_specular(model_material *m);

/* import_texture_mean.c: means over all texels, 0..1, of colours (as if they were sRGB if `srgb`) and alpha. All 1 where the
 * image is missing or broken, with a warning that names `material` (not strict), or without one if that is NULL. */
bool import_texture_mean(importer *im, const char *name, const char *material, bool srgb, float mean[4]);
/* Of a texture of Assimp's material; all 1 if it has none. Its colours are sRGB but for metalness and roughness. */
bool import_texture_mean_of(importer *im, const struct aiMaterial *ai, enum aiTextureType type, unsigned index,
                            const char *material, float mean[4]);

/* import_texture.c: decodes image `name` of this file; its texels are the caller's to free. What is wrong with it, or NULL. */
const char *import_image(importer *im, const char *name, bool resolved, model_image *out);
/* A texture that is missing or broken: an error if strict, else a warning that says what is done `instead`. */
bool import_without(importer *im, const char *material, const char *name, const char *what, const char *instead);
/* image `name` of this file, decoded once; *image is its index in model.images, or -1 with a warning that
 * names `material` (not strict) where it is missing or broken. */
bool import_texture(importer *im, const char *name, bool resolved, const char *material, int *image);

/* import_transparency.c: decides, before materials are read, how the file means transparency, and warns. */
bool import_transparency(importer *im);
/* 0..1, by that decision. */
float import_opacity(const importer *im, const struct aiMaterial *ai);
/* Sets `hole` by alpha, cutoff and that decision. */
void import_settle_holes(const importer *im, material_use *use, const struct aiMaterial *ai);
/* import_specular.c: MTL's `illum` says that light goes through. */
bool import_is_glass_mtl(const struct aiMaterial *ai);

/* import_normals.c: a unit normal for each of the 3 * triangles corners, in `normal` (9 floats a triangle).
 * position: 3 floats a vertex; corner: 3 vertex indices a triangle, no triangle degenerate. False: out of memory. */
bool import_normals(const float *position, const uint32_t *corner, size_t triangles, float *normal);

/* import_mesh.c: appends the triangles of mesh `index`, placed by `world` (3 x 4), to the model. */
bool import_mesh(importer *im, unsigned index, const double world[12]);
/* Makes room in the model for so many more vertices and triangles. */
bool import_make_room(importer *im, size_t vertices, size_t triangles);

/* import_lights.c: the cameras and lights that hang on `node`, whose place in the world is `world` (3 x 4). */
bool import_node_camera(importer *im, const struct aiNode *node, const double world[12]);
bool import_node_light(importer *im, const struct aiNode *node, const double world[12]);

#endif
