/* import*.c and the readers' folders: what the parts of the importer share. Private to them. */
#ifndef VIT_BAKE_IMPORTER_H
#define VIT_BAKE_IMPORTER_H

#include "import/import_format.h"
#include "import/import_wire.h"
#include "import/model.h"
#include "vitrine_pack.h"

/* Transparent materials that are shown after all, since too little would be left. */
typedef enum import_shown { SHOWN_AS_SAID, SHOWN_INVISIBLE, SHOWN_HOLES } import_shown; /* none; those of alpha 0; all */

enum { IMPORT_DEPTH = 256, IMPORT_EDGE = 16384 }; /* levels of the node tree; pixels of an image's edge */
enum { IMPORT_CORNERS = 1024 };                   /* of a polygon: cutting ears takes the square of them and more */
enum { IMPORT_UV_SETS = 8 };
#define IMPORT_TEXELS ((uint64_t)1 << 30) /* of all images together: 4 GiB decoded */
#define IMPORT_FAR 1e9f                   /* m: beyond, areas do not fit a float */

/* One mesh file being read. */
typedef struct importer {
    const scene *s;
    model *m;
    model_rigour rigour;
    model_warn_fn *warn;
    void *user;
    vit_text *why;

    const char *file; /* path as the scene gives it; every message starts with it */
    const import_format *format;
    void *reader;              /* what the format's reader keeps of the file */
    model_frame frame;         /* the file's unit and up axis, as they are taken */
    unsigned embedded;         /* images in the file itself */
    bool states_units;         /* the format says candela, lux and nits */
    struct material_use *uses; /* materials of this file that a triangle uses */
    size_t use_count, use_room;
    uint32_t *use_of; /* a material of the file: 1 + the index of the last of its uses, 0 for none */
    size_t use_of_room;
    bool *override_used; /* one a scene material: some mesh has a material of that name */
    size_t vertex_room, triangle_room, material_room, image_room;
    uint64_t texels;                       /* of all images so far */
    uint64_t bad_index, not_finite, clear; /* triangles of this file dropped for an index, a NaN, transparency */
    uint64_t bad_polygon;                  /* polygons dropped for an index or too many corners */
    char clear_name[SCENE_NAME];           /* material of the first that was dropped for transparency */
    import_shown shown;
    bool warned_colors;
    struct texture_mean *means; /* that were asked for, of this file */
    size_t mean_count, mean_room;
    uint64_t too_far;    /* triangles of this file with a vertex beyond IMPORT_FAR */
    double farthest;     /* m */
    uint32_t file_index; /* in scene.meshes */
    model_mesh *placed;  /* a mesh of the file each: places and triangles so far */
    size_t placed_count;

    vit_status status;                /* of what fails: VIT_BAD_INPUT, unless it is not the file's fault */
    wire *to_parent;                  /* in the child; else NULL */
    uint64_t allowed, allowed_texels; /* bytes of the files and texels of the images that earn time and memory */
    uint64_t mapped;                  /* bytes of address space that the child began with */
} importer;

/* A material as one mesh sees it: which texture coordinates, which constant vertex colour. */
typedef struct material_use {
    unsigned source;   /* material of the file */
    uint32_t before;   /* 1 + the index of another use of it, or 0 */
    bool tinted;       /* its vertices have a colour, all the same */
    float tint[3];     /* that one, 1 if none */
    model_material m;  /* image still -1 */
    bool hole;         /* all of it is transparent: its triangles are dropped */
    bool cutoff_asked; /* the scene file has a cutoff for it, or the mesh file asks for holes beyond doubt */
    bool alpha_mapped; /* the colour texture's alpha counts */
    float
        alpha_by_letter; /* by the file's letter, where the reader took it otherwise; what the scene file's cutoff is held to */
    char image[SCENE_PATH]; /* file, or "*index" of an image in the mesh file; "" if none */
    bool has_plain;         /* without the image the albedo is `plain` */
    float plain[3];
    char normal[SCENE_PATH];              /* the normal map, likewise; its scale is in m */
    bool image_resolved, normal_resolved; /* they come from the scene file: take them as they are */
    int image_line;                       /* there, for errors */
    unsigned uv_set;
    bool has_transform;
    double uv[6];                     /* u' = uv[0] u + uv[1] v + uv[2], v' = uv[3] u + uv[4] v + uv[5] */
    bool warned_uv, warned_normal_uv; /* of a mesh without texture coordinates: one warning will do */
    int index;                        /* in model.materials, -1 until a triangle uses it */
} material_use;

/* Some floats a vertex, which begin `stride` floats apart; NULL: there are none. */
typedef struct mesh_floats {
    const float *at;
    size_t stride;
} mesh_floats;

/* Triangles of one material, in the mesh's own space. */
typedef struct mesh_part {
    const char *name; /* of the mesh, for messages */
    uint32_t vertices;
    mesh_floats position;           /* 3 */
    mesh_floats normal;             /* 3, of any length; none: they are made */
    mesh_floats color;              /* 3, linear */
    mesh_floats uv[IMPORT_UV_SETS]; /* 2 */
    bool v_up;                      /* v = 0 is the images' last row */
    /* 3 a triangle; those out of range are counted and dropped. It may be where the model's next triangles go, if there is room
     * for all of the part's. */
    const uint32_t *corner;
    const uint32_t *smoothing; /* one a triangle, or NULL: groups by which normals are made */
    size_t triangles;
    unsigned material; /* of the file */
} mesh_part;

/* ---- import.c ---- */

/* Writes "file: ..." into why->text and returns false. */
bool import_fail(importer *im, const char *format, ...) __attribute__((format(printf, 2, 3)));
/* Gives "file: ..." to the user as a warning. */
void import_warn(importer *im, const char *format, ...) __attribute__((format(printf, 2, 3)));
/* What the file says and the baker does not do: import_fail() if strict, else import_warn() and true. */
bool import_not_done(importer *im, const char *format, ...) __attribute__((format(printf, 2, 3)));
/* Makes room for `count` things of `size` bytes in *block. */
bool import_room(importer *im, void *block, size_t *room, size_t count, size_t size);
/* Reads the file and appends it to the model, in this process. */
bool import_file(importer *im, const scene_mesh *mesh);

/* ---- import_child.c ---- */

/* Has a child process read the file and appends what it sends to the model. Foreign readers end the process on some malformed
 * files, by an assertion or a bad access, while they read, while they are asked, or while they clean up; others they do not
 * come back from. None of it happens here: that child has limits of processor time and memory, which grow with the files that
 * it opens. */
bool import_in_child(importer *im, const scene_mesh *mesh);
/* More bytes of files, more texels of images: more time and memory. */
void import_allow(importer *im, size_t bytes);
void import_allow_texels(importer *im, uint64_t texels);

/* ---- import_files.c ---- */

/* Notes a file of so many bytes as an input. */
void import_note_file(importer *im, const char *path, size_t bytes);
/* The plain file that `name`, relative to the mesh's folder, means; see there. False: there is none. */
bool import_resolve(const importer *im, const char *name, char path[SCENE_PATH]);
/* Bytes of a file, or made here. */
typedef struct import_bytes {
    const uint8_t *at; /* NULL: none */
    size_t size;
    size_t mapped; /* of the file, if it is mapped */
    void *owned;   /* to be freed, or NULL */
} import_bytes;
/* The whole of a plain file that is not empty, noted as an input. */
bool import_map(importer *im, const char *path, import_bytes *out);
void import_drop_bytes(import_bytes *bytes);
/* Up to `size` bytes at its beginning, which is mapped, are done with. */
void import_drop_front(import_bytes *bytes, size_t size);

/* ---- import_frame.c ---- */

/* Settles im->frame: what the scene file says, else `stated`. */
void import_frame(importer *im, const scene_mesh *mesh, const model_frame *stated);
/* 3 x 4, from the file's numbers to metres, y up. */
void import_frame_matrix(const model_frame *frame, double out[12]);

/* ---- import_place.c ---- */

/* Begins the list of the file's meshes. */
bool import_begin_meshes(importer *im, size_t count);
/* Appends the part's triangles, placed by `world` (3 x 4), to the model, as of the file's mesh `mesh`. */
bool import_place(importer *im, size_t mesh, const mesh_part *part, const double world[12]);
/* Counts one more place of that mesh. */
void import_count_place(importer *im, size_t mesh, const char *name);
/* The same of a mesh that is called as the file is, without folder and suffix. */
void import_count_file(importer *im, size_t mesh);
/* Makes room in the model for so many more vertices and triangles. */
bool import_make_room(importer *im, size_t vertices, size_t triangles);
/* out = a b, of which the last rows are 0 0 0 1. */
void import_multiply(const double a[12], const double b[12], double out[12]);

/* import_normals.c: a unit normal for each of the 3 * triangles corners, in `normal` (9 floats a triangle): smooth up to an
 * edge of 60 degrees, among triangles of one smoothing group; those of IMPORT_FLAT are flat. All are IMPORT_GROUPLESS if
 * `smoothing` is NULL. position: 3 floats a vertex; corner: 3 vertex indices a triangle, no triangle degenerate. False: out of
 * memory. */
#define IMPORT_FLAT 0u
#define IMPORT_GROUPLESS UINT32_MAX
bool import_normals(const float *position, const uint32_t *corner, const uint32_t *smoothing, size_t triangles, float *normal);

/* import_polygon.c: cuts a polygon of `count` corners, 3..IMPORT_CORNERS, which are vertices of `position`, into count - 2
 * triangles: three of 0..count - 1 each. */
void import_cut_polygon(const mesh_floats *position, const uint32_t *corner, unsigned count, uint32_t *triangle);

/* import_number.c: the decimal number that begins at `at`: where it ends, or NULL if there is none. It is the double nearest to
 * what is written, or with `single` the float nearest to it, whatever the locale. Also "inf", "nan" and MSVC's "1.#QNAN". */
const char *import_number(const char *at, const char *end, bool single, double *out);

/* ---- import_material.c ---- */

/* The use of material `source` with vertex colour `tint`, NULL if there is none; false: out of memory, or what the format's
 * reader says. The pointer is good until the next call. */
bool import_material(importer *im, unsigned source, const float *tint, material_use **use);
/* There are no uses any more. */
void import_forget_materials(importer *im);
/* Loads the use's image and appends its material to the model, on first call. */
bool import_material_index(importer *im, material_use *use, uint32_t *index);
float import_clamp(float value, float most); /* to 0..most; NaN is 0 */
/* Glass of this kind, which is no hole, whatever the file says of its opacity besides. Index 1.5 if `ior` can be none. */
void import_make_glass(model_material *m, uint32_t kind, float ior);
/* `color` times `strength` in the mesh file's unit. */
void import_emission(const importer *im, model_material *m, const float color[3], float strength);

/* import_override.c: what the scene file says of kind, lobe and glass. */
void import_override_specular(importer *im, model_material *m, const scene_material *o);
/* Last: no more is reflected than arrives, and nothing stays that the kind has no use for. */
void import_settle_specular(model_material *m);

/* import_texture_mean.c: means over all texels, 0..1, of colours (as if they were sRGB if `srgb`) and alpha. All 1 where the
 * image is missing or broken, with a warning that names `material` (not strict), or without one if that is NULL. */
bool import_texture_mean(importer *im, const char *name, const char *material, bool srgb, float mean[4]);

/* ---- import_texture.c ---- */

/* Decodes image `name` of this file; its texels are the caller's to free. What is wrong with it, or NULL. */
const char *import_image(importer *im, const char *name, bool resolved, model_image *out);
/* The same of an image file's bytes. */
const char *import_decode(importer *im, const uint8_t *bytes, size_t size, model_image *out);
/* A texture that is missing or broken: an error if strict, else a warning that says what is done `instead`. */
bool import_without(importer *im, const char *material, const char *name, const char *what, const char *instead);
/* image `name` of this file, decoded once; *image is its index in model.images, or -1 with a warning that
 * names `material` and what is done `instead` (not strict) where it is missing or broken. */
bool import_texture(importer *im, const char *name, bool resolved, const char *material, const char *instead, int *image);
#define IMPORT_PLAIN_COLOR "its plain colour is used"

/* ---- import_transparency.c ---- */

/* Whether the file writes transparency where it means opacity, or the other way round, with a warning if so: no material in
 * use is opaque by the letter, and some are invisible. stated: opacities by the letter, 0..1; IMPORT_SAYS_SO for materials
 * that say otherwise what they are. */
#define IMPORT_SAYS_SO (-1.0f)
bool import_is_inverse(importer *im, const uint64_t *of_material, const float *stated, unsigned materials);

/* Decides, before triangles are placed, whether the file's transparent materials are shown after all, and warns. of_material:
 * triangles of each of the file's materials, in all places. */
bool import_transparency(importer *im, const uint64_t *of_material, unsigned materials);
/* Sets `hole` by alpha, cutoff and that decision. */
void import_settle_holes(const importer *im, material_use *use);

/* ---- import_lights.c ---- */

/* Adds a camera of which name, parent, eye, up and fov are set; it looks along `forward`. up and forward are of any length.
 * What has no direction is left out with a warning; an fov that is not between 1 and 170 degrees becomes 0, with one, too. */
bool import_add_camera(importer *im, const model_camera *camera, const double forward[3], bool orthographic);
/* Adds a light of which name, parent, kind, position, direction (any length), inner, outer (degrees from the axis; most outer:
 * `widest`), stated and range are set. What cannot be one of ours is left out with a warning. */
bool import_add_light(importer *im, const model_light *light, double widest);
/* The point and the vector at `v` (world: 3 x 4). */
void import_transform_point(const double world[12], const double v[3], double out[3]);
void import_transform_vector(const double world[12], const double v[3], double out[3]);

#endif
