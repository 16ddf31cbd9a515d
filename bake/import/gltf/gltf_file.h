/* gltf*.c: what the parts of the glTF reader share. Private to them. Whatever fails says why by import_fail(). */
#ifndef VIT_BAKE_GLTF_FILE_H
#define VIT_BAKE_GLTF_FILE_H

#include "import/importer.h"
#include <jansson.h>

#define GLTF_NONE UINT32_MAX /* no element: also what is no index at all */

typedef struct gltf_node {
    const json_t *json;
    uint32_t place;        /* the first of its places */
    bool is_child, on_way; /* the latter while places are made */
    char name[SCENE_NAME];
} gltf_node;

/* A node below another, or below none. */
typedef struct gltf_place {
    uint32_t node, above; /* above: a place or GLTF_NONE */
    double world[12];     /* in the scene of the file, 3 x 4 */
} gltf_place;

/* What is said once a file. */
typedef enum gltf_remark {
    GLTF_SAID_UNLIT,
    GLTF_SAID_NORMALS,
    GLTF_SAID_ALPHA,
    GLTF_SAID_MORPHS,
    GLTF_SAID_POSITIONS,
    GLTF_SAID_TRANSMISSION
} gltf_remark;

/* Elements of an accessor as floats, one after another or `stride` apart. */
typedef struct gltf_floats {
    const float *at;
    float *owned;
    uint32_t count;
    unsigned components;
    size_t stride; /* floats */
} gltf_floats;

enum { GLTF_JOINT_SETS = 4 };

/* A primitive, from its first vertex in use to the last. */
typedef struct gltf_part {
    gltf_floats position, normal, color, uv[IMPORT_UV_SETS];
    gltf_floats joints[GLTF_JOINT_SETS], weights[GLTF_JOINT_SETS]; /* 4 a vertex */
    unsigned joint_sets;
    uint32_t first, vertices; /* of those, the first in use, and from it on to the last */
    const uint32_t *corner;   /* 3 a triangle, counted from `first` */
    uint32_t *owned;          /* what of it is to be freed */
    size_t triangles;
    unsigned material; /* the file's default one: the number of materials */
    const json_t *json;
} gltf_part;

typedef struct gltf_mesh {
    gltf_part *parts; /* NULL: not read yet */
    size_t part_count;
    uint32_t places; /* of nodes that have still to show it */
    char name[SCENE_NAME];
} gltf_mesh;

/* importer.reader */
typedef struct gltf_file {
    importer *im;
    json_t *root;
    import_bytes file;
    const uint8_t *json, *chunk; /* the JSON text; GLB's binary chunk, or NULL */
    size_t json_size, chunk_size;
    import_bytes *buffers, *views, *images; /* views: those that had to be decoded; images: data URIs; empty until asked for */
    size_t buffer_count, view_count, image_count;
    gltf_node *nodes;
    size_t node_count;
    gltf_place *places;                    /* those of the scene first, each behind the one above it */
    size_t place_count, place_room, shown; /* shown: how many are of the scene */
    gltf_mesh *meshes;
    size_t mesh_count;
    unsigned material_count;
    uint64_t bytes; /* of all files that were opened */
    unsigned said;  /* bits of gltf_remark */
} gltf_file;

/* ---- gltf_json.c: NULL, false or `otherwise` where something is not there, or not what it must be ---- */

/* Element of a list of the file's top level: "accessors". */
const json_t *gltf_item(const gltf_file *g, const char *list, uint32_t index);
size_t gltf_count(const gltf_file *g, const char *list);
/* Whether there is such a number; GLTF_NONE for one that is no index. */
bool gltf_index(const json_t *object, const char *key, uint32_t *out);
/* 0 where it is not there; false: no whole number that fits. */
bool gltf_size(const json_t *object, const char *key, size_t *out);
double gltf_number(const json_t *object, const char *key, double otherwise);
bool gltf_numbers(const json_t *object, const char *key, double *out, size_t count);
const char *gltf_text(const json_t *object, const char *key, const char *otherwise);
const json_t *gltf_extension(const json_t *object, const char *name);

/* ---- gltf_buffers.c ---- */

/* Maps the file and finds JSON and binary chunk. */
bool gltf_open(gltf_file *g);
void gltf_close(gltf_file *g);
/* A whole buffer view, decoded if it is compressed. */
bool gltf_view(gltf_file *g, uint32_t index, const uint8_t **at, size_t *size, size_t *stride);
/* A part of a buffer. */
bool gltf_buffer(gltf_file *g, uint32_t index, size_t offset, size_t size, const uint8_t **at);
/* The bytes of an image that the file itself holds; NULL, with what is wrong, if they are not to be had. */
const char *gltf_image_bytes(gltf_file *g, uint32_t index, const uint8_t **at, size_t *size);
/* gltf_base64.c: what a data URI holds. */
bool gltf_is_data(const char *uri);
bool gltf_data(const char *uri, import_bytes *out);
/* gltf_meshopt.c: a view of EXT_meshopt_compression (`how`: the extension's object). */
bool gltf_meshopt(gltf_file *g, uint32_t view, const json_t *how, import_bytes *out);

/* ---- gltf_accessor.c ---- */

/* Accessor `index` as floats, of `components` a element at least; normalized ones are. */
bool gltf_read_floats(gltf_file *g, uint32_t index, unsigned components, gltf_floats *out);
/* A scalar accessor of unsigned integers; free() what is owned. */
typedef struct gltf_indices {
    const uint32_t *at;
    uint32_t *owned;
    uint32_t count;
} gltf_indices;
bool gltf_read_indices(gltf_file *g, uint32_t index, gltf_indices *out);
void gltf_drop_floats(gltf_floats *f);
/* Number of elements; 0: no such accessor. */
uint32_t gltf_accessor_count(const gltf_file *g, uint32_t index);
/* componentType and normalized of an accessor, for data that comes from elsewhere: value as the accessor means it. */
float gltf_normalized(const gltf_file *g, uint32_t index, double value);

/* ---- gltf_nodes.c ---- */

/* Nodes and their places. */
bool gltf_read_nodes(gltf_file *g);
/* translation, rotation (x, y, z, w) and scale as a 3 x 4 matrix. */
void gltf_compose(const double t[3], const double r[4], const double s[3], double out[12]);

/* ---- gltf_mesh.c ---- */

/* Places the mesh of each node of the scene, in the scene file's world. */
bool gltf_place_meshes(gltf_file *g, const scene_mesh *mesh);
bool gltf_read_mesh(gltf_file *g, uint32_t index);
void gltf_drop_mesh(gltf_mesh *mesh);
/* Triangles of the primitive by its accessors' counts alone. */
uint64_t gltf_triangles_stated(const gltf_file *g, const json_t *primitive);
/* gltf_part.c: one primitive; empty where it has no triangles. */
bool gltf_read_part(gltf_file *g, const json_t *primitive, gltf_part *out);
void gltf_drop_part(gltf_part *part);
/* gltf_draco.c: attributes and triangles of KHR_draco_mesh_compression. */
bool gltf_read_draco(gltf_file *g, const json_t *primitive, const json_t *how, gltf_part *out);

/* gltf_pose.c: positions and normals from part->first on, as the node at `place` has them by its morph weights and skin. */
typedef struct gltf_posed {
    gltf_floats position, normal; /* left empty where they are the part's own */
    bool skinned;                 /* in the world of the file, not in the node's space */
} gltf_posed;
bool gltf_pose(gltf_file *g, const gltf_part *part, const gltf_place *place, gltf_posed *out);

/* ---- the rest ---- */

/* gltf_material.c: as import_format.material has it. */
bool gltf_material(importer *im, material_use *use);
/* gltf_shine.c: kind, lobe, glass, once colour, emission and alpha are known. */
bool gltf_shine(gltf_file *g, material_use *use, const json_t *material);
/* Opacity by the material's factor, 0..1; 1 for opaque ones. */
float gltf_opacity(const json_t *material);

/* gltf_texture.c: where a texture comes from, and how it lies. */
typedef struct gltf_texture {
    char image[SCENE_PATH]; /* as material_use has it; "" if there is none */
    uint32_t wrap_u, wrap_v;
    unsigned uv_set;
    bool has_transform;
    double uv[6]; /* as in material_use */
} gltf_texture;
/* By a textureInfo object or NULL; false: there is none. */
bool gltf_find_texture(gltf_file *g, const json_t *info, gltf_texture *out);
/* The mean of its texels; all 1 without one. */
bool gltf_texture_mean(gltf_file *g, const json_t *info, const char *material, bool srgb, float mean[4]);

/* gltf_lights.c: the light and the camera of the node at `place`, which lies at `world`. */
bool gltf_add_light(gltf_file *g, const gltf_place *place, const double world[12]);
bool gltf_add_camera(gltf_file *g, const gltf_place *place, const double world[12]);

/* gltf_extensions.c: notes the extensions that the file says it uses, and refuses what it cannot be understood without. */
bool gltf_check_extensions(gltf_file *g);
bool gltf_reads_extension(const char *name);
/* gltf_types.c: says so if a member is not of the kind that it must be. */
bool gltf_check_types(gltf_file *g);

/* gltf.c: what the file says and is not done, once a file. True if it is only a warning. */
bool gltf_remark_once(gltf_file *g, gltf_remark remark, const char *text, const char *name);

#endif
