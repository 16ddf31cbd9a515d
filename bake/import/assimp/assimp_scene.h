/* assimp*.c: what the parts of Assimp's reader share. Private to them. */
#ifndef VIT_BAKE_ASSIMP_SCENE_H
#define VIT_BAKE_ASSIMP_SCENE_H

#include "import/importer.h"
#include <assimp/cfileio.h>
#include <assimp/material.h>
#include <assimp/scene.h>

/* What a mesh's polygons of five corners and more became: 3 vertices of the mesh a triangle. */
typedef struct polygon_cut {
    uint32_t *corner;
    size_t triangles;
} polygon_cut;

/* What is said once a file, of all its materials. */
typedef enum assimp_remark {
    ASSIMP_SAID_BUMP,
    ASSIMP_SAID_SPECULAR,
    ASSIMP_SAID_TRANSFORM,
    ASSIMP_SAID_LAYERS,
    ASSIMP_SAID_SET
} assimp_remark;

enum { ASSIMP_LOST = 4 }; /* names of elements that are told of */

/* A file that Assimp reads; importer.reader. */
typedef struct assimp_scene {
    importer *im;
    const struct aiScene *ai;
    bool inverse; /* the file's opacities are transparencies (assimp_transparency.c) */
    bool warned_morph, warned_bones;
    unsigned said;     /* a bit an assimp_remark */
    polygon_cut *cuts; /* a mesh of the file each */
    unsigned cut_count;
    double unit;                /* metres that the head of an X3D file says, or 0 */
    bool bad_unit, bad_axis;    /* what the file says of them is none */
    char amf_unit[64];          /* as the root element of an AMF file has it, or "" */
    bool other_set;             /* a COLLADA file binds a texture to another set of coordinates than that of number 0 */
    bool vertex_normals;        /* an FBX file has normals by vertex, which not all releases read */
    bool off_colors;            /* an OFF file has some, which are left out */
    bool amf_turns;             /* an AMF file turns instances, which Assimp takes for ways */
    char lost[ASSIMP_LOST][32]; /* elements that are left out, */
    unsigned lost_count;        /* so many or more kinds of them */
    unsigned lost_nodes;        /* that were NULL in Assimp's tree */
} assimp_scene;

/* assimp_files.c: what Assimp reads files through; `a` must outlive it. */
struct aiFileIO assimp_files(assimp_scene *a);

/* assimp_text.c: the text of a COLLADA file as Assimp reads it right; `text` has been freed then. Sets a->bad_unit, bad_axis,
 * lost, other_set. */
char *assimp_mend_collada(assimp_scene *a, char *text, size_t *size);
/* assimp_off.c: sets a->off_colors. */
void assimp_read_off(assimp_scene *a, const char *text, size_t size);
/* assimp_x3d.c: the text of an X3D file as Assimp reads it right; `text` has been freed then. Sets a->unit, bad_unit, lost. */
char *assimp_mend_x3d(assimp_scene *a, char *text, size_t *size);
/* assimp_text.c: one more element of that name that is left out; says which there were. */
void assimp_note_lost(assimp_scene *a, const char *name);
bool assimp_say_lost(assimp_scene *a);

/* assimp_tree.c: takes NULL out of the lists of Assimp's tree, or refuses it. */
bool assimp_mend_tree(assimp_scene *a);
/* A mesh that no node leads to, in a tree that had holes: its node was lost. */
bool assimp_is_stray(const assimp_scene *a, unsigned mesh);

/* assimp_frame.c: settles the file's unit and up axis, and the place in the world of what Assimp's root node stands in. */
bool assimp_frame(assimp_scene *a, const scene_mesh *mesh, double place[12]);
/* How Assimp's name of the reader that read the file begins, "Collada"; "" if it has none. */
const char *assimp_reader(const assimp_scene *a);

/* assimp_amf.c: the text of an AMF file, unpacked if it is an archive; `text` has been freed then. Sets a->amf_unit, amf_turns.
 */
char *assimp_read_amf(assimp_scene *a, char *text, size_t *size);
/* Metres a unit; the format's default, 0.001, where the file says none. False: the unit is none. */
bool assimp_unit_amf(const assimp_scene *a, double *unit, bool *stated);

/* assimp_faces.c: cuts polygons into triangles; those with a bad index or more than 1024 corners are emptied and counted, those
 * of five and more emptied, too, and their triangles kept in a->cuts. */
bool assimp_triangulate(assimp_scene *a);
void assimp_free_cuts(assimp_scene *a);
/* assimp_cut.c: does so with a mesh; its indices are in range. */
bool assimp_cut(assimp_scene *a, const struct aiMesh *mesh, polygon_cut *out);

/* assimp_mesh.c: one more place of mesh `index`. */
bool assimp_place(assimp_scene *a, unsigned index, const double world[12]);

/* assimp_material.c: as import_format.material has it. */
bool assimp_material(importer *im, material_use *use);
/* assimp_maps.c: the picture of a material's colour, how it repeats and which coordinates it has. False: strict, or out of
 * memory. */
bool assimp_color_map(assimp_scene *a, material_use *use, const struct aiMaterial *ai);
/* Says which other maps are left out. */
bool assimp_other_maps(assimp_scene *a, const material_use *use, const struct aiMaterial *ai);
/* What import_image() takes for a texture of that path: "*N" if the file holds it. */
void assimp_image_name(const assimp_scene *a, const struct aiString *path, char out[SCENE_PATH]);
/* `count` floats, if there are as many; keys are macros of three arguments, key, type, index. */
bool assimp_floats(const struct aiMaterial *ai, const char *key, unsigned type, unsigned index, float *out, unsigned count);

/* assimp_transparency.c: decides, before materials are read, how the file means transparency, and warns. */
bool assimp_transparency(assimp_scene *a);
/* 0..1, by that decision; and by the file's letter. */
float assimp_opacity(const assimp_scene *a, const struct aiMaterial *ai);
float assimp_stated_opacity(const struct aiMaterial *ai);

/* assimp_collada.c: vertical field of view in degrees of the camera that hangs on the node of this id; 0: the file has none. */
double assimp_collada_fov(importer *im, const char *node, bool *orthographic);
/* assimp_lights.c: the cameras and lights that hang on `node`, whose place in the world is `world` (3 x 4). */
bool assimp_cameras(assimp_scene *a, const struct aiNode *node, const double world[12]);
bool assimp_lights(assimp_scene *a, const struct aiNode *node, const double world[12]);

#endif
