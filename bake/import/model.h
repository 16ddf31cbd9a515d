/* import.c: meshes of all files of a scene as one indexed triangle soup, in world space. */
#ifndef VIT_BAKE_MODEL_H
#define VIT_BAKE_MODEL_H

#include "scene/scene.h"

typedef struct model_image {
    char name[SCENE_PATH]; /* file, or "file#index" if embedded */
    int width, height;     /* 1..16384 */
    uint8_t *rgba;         /* 4 * width * height, sRGB colour, linear alpha, first row on top */
} model_image;

typedef struct model_material {
    char name[SCENE_NAME];
    float albedo[3];         /* linear, multiplies the texture; finite, clamped to 0..VIT_MAX_ALBEDO */
    float emission[3];       /* W/(m2 sr), finite, >= 0 */
    uint32_t kind;           /* VIT_MATTE, ...; mirrors and glass have no albedo and do not emit */
    float specular[3];       /* as in vit_material; VIT_MATTE: albedo + specular <= 1 */
    float exponent;          /* 1..VIT_MAX_EXPONENT; 1 without a lobe */
    float lobe_alpha;        /* of a GGX lobe, VIT_MIN_ALPHA..1; 0: Phong's, or none */
    float ior;               /* VIT_MIN_IOR..VIT_MAX_IOR; 1 unless glass */
    float absorption[3];     /* 1/m, finite, >= 0; 0 unless VIT_GLASS */
    bool area_light;         /* what it emits lights others */
    bool emits_by_file;      /* the emission is the mesh file's, not the scene file's */
    bool states_unit;        /* the mesh file's format says nits */
    int image;               /* index in model.images, -1 if none */
    uint32_t wrap_u, wrap_v; /* VIT_WRAP_* */
    float cutoff;            /* alpha test: texels with alpha * factor < cutoff are holes; 0: opaque */
    float alpha;             /* constant alpha factor */
    float normal_scale;      /* of x and y of the normal map, -VIT_MAX_NORMAL_SCALE..VIT_MAX_NORMAL_SCALE; 0: there is none */
    int normal_image;        /* of it, index in model.images, whose bytes are no sRGB then */
    uint32_t normal_wrap_u, normal_wrap_v;
    uint64_t triangles; /* that use it */
} model_material;
#define MODEL_HAS_NORMAL_MAP(material) ((material)->normal_scale != 0.0f) /* which has an image */

typedef struct model_camera {
    char name[SCENE_NAME], parent[SCENE_NAME]; /* of its node and the node above, "" if there is none */
    double eye[3], target[3], up[3], fov;      /* world space; fov vertical, degrees (0: not stated) */
} model_camera;

typedef struct model_light {
    char name[SCENE_NAME], parent[SCENE_NAME];      /* as with cameras */
    int kind;                                       /* VIT_LIGHT_* */
    double position[3], direction[3], inner, outer; /* world space; degrees from the axis */
    double power[3];                                /* W; directional: irradiance, W/m2 */
    double stated[3];                               /* intensity times colour as the file has it, in its unit (light_units.h) */
    bool states_unit;                               /* the format says candela and lux */
    double range;                                   /* metres; 0: none */
} model_light;

/* A mesh of a mesh file, as its author named it. */
typedef struct model_mesh {
    char name[SCENE_NAME];
    uint32_t file;      /* index in scene.meshes */
    uint32_t places;    /* where nodes put it */
    uint64_t triangles; /* that are in the model, of all places */
} model_mesh;

/* An extension that a glTF or 3MF file says it uses. */
typedef struct model_extension {
    char name[64];
    uint32_t file; /* index in scene.meshes */
    bool required; /* the file is not what it means without it */
    bool read;     /* what of it a vitrine can show is shown */
} model_extension;

enum { MODEL_EXTENSIONS = 256 }; /* of a file */

/* Who says in what unit a mesh file's numbers are and which axis is up. */
typedef enum frame_source { FRAME_BY_NOBODY, FRAME_BY_FORMAT, FRAME_BY_FILE, FRAME_BY_SCENE } frame_source;
enum { FRAME_X, FRAME_Y, FRAME_Z };
typedef struct model_frame {
    double unit;             /* metres that 1 of the file is */
    uint32_t up;             /* FRAME_*: axis of the file that is up */
    uint32_t unit_by, up_by; /* frame_source; FRAME_BY_NOBODY: 1 m, and y */
} model_frame;

/* How a mesh file is read. */
typedef struct model_format {
    uint32_t reader; /* index in import_formats */
    model_frame frame;
} model_format;

/* What is counted over all files, and travels from the child that reads one: X(name, meaning). */
#define MODEL_COUNTS(X)                                                                                                        \
    X(degenerate, "triangles dropped for zero area")                                                                           \
    X(not_finite, "triangles dropped for NaN or infinite positions")                                                           \
    X(not_triangles, "points and lines dropped")                                                                               \
    X(default_highlights, "materials whose highlight is an exporter's default: they are matt")                                 \
    X(principled, "MTL materials taken by Blender's Principled shader")

typedef struct model {
    float *position; /* 3 a vertex, finite */
    float *normal;   /* 3 a vertex, unit */
    float *uv;       /* 2 a vertex, finite; v = 0 is the image's first row */
    uint32_t vertices;
    uint32_t *index;    /* 3 a triangle, < vertices; no triangle of zero area (in float arithmetic of v1-v0, v2-v0) */
    uint32_t *material; /* 1 a triangle, < materials */
    uint32_t triangles; /* >= 1, <= VIT_MAX_TRIANGLES */
    model_material *materials;
    int material_count; /* >= 1 */
    model_image *images;
    int image_count;
    model_camera *cameras;
    int camera_count;
    model_light *lights;
    int light_count;
    model_mesh *meshes; /* those that a node puts somewhere */
    int mesh_count;
    model_extension *extensions;
    int extension_count;
    model_format *formats; /* a mesh file each */
    int format_count;
    double lo[3], hi[3]; /* box of the vertices in use */
    double step;         /* m between neighbouring floats where the files' vertices are farthest from their origin */
#define X(name, meaning) uint64_t name;
    MODEL_COUNTS(X)
#undef X
    uint64_t warnings;          /* lines given to `warn` */
    inputs files;               /* that were read: meshes, what they refer to, textures */
    char default_highlight[64]; /* the first of default_highlights */
} model;

/* One line, without a line feed, for the user to see. */
typedef void model_warn_fn(void *user, const char *line);

/* How what a file says and the baker does not do is taken. */
typedef enum model_rigour {
    MODEL_WARNS,  /* a warning; an error where the file says that it means nothing without it */
    MODEL_STRICT, /* an error, and so is a missing or broken texture */
    MODEL_LISTS   /* a warning in any case: to show what a file holds */
} model_rigour;

/* Imports every mesh of `s`, applies node and scene transforms and material overrides, decodes the textures in use.
 * VIT_BAD_INPUT: the text names file and cause. On failure nothing is left to free. */
vit_status model_import(const scene *s, model_rigour rigour, model_warn_fn *warn, void *user, model *out, vit_text *why);
/* The same in this process rather than in a child, for fuzzing and debuggers: a file may end it. */
vit_status model_import_here(const scene *s, model_rigour rigour, model_warn_fn *warn, void *user, model *out, vit_text *why);
void model_free(model *m);

/* The first whose node is called so, or else whose parent node is: exporters hang what they turn below the node that users
 * named (Blender's "Lamp_Orientation" below "Lamp"). NULL: there is none. import_lights.c */
const model_camera *model_camera_named(const model *m, const char *name);
const model_light *model_light_named(const model *m, const char *name);

#endif
