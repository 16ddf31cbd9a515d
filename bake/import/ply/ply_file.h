/* ply*.c: what the parts of the PLY reader share. Private to them. Whatever fails says why by import_fail(). */
#ifndef VIT_BAKE_PLY_FILE_H
#define VIT_BAKE_PLY_FILE_H

#include "import/importer.h"

enum { PLY_TEXTURES = 1024 };  /* that a file may name */
enum { PLY_COLORS = 256 + 1 }; /* of faces, each of which becomes a material, and none */

typedef enum ply_encoding { PLY_TEXT, PLY_LITTLE, PLY_BIG } ply_encoding;
typedef enum ply_type {
    PLY_INT8,
    PLY_UINT8,
    PLY_INT16,
    PLY_UINT16,
    PLY_INT32,
    PLY_UINT32,
    PLY_INT64,
    PLY_UINT64,
    PLY_FLOAT,
    PLY_DOUBLE
} ply_type;

/* What a property means to this reader. The members of a group are in order: what has the first has all. */
typedef enum ply_role {
    PLY_NOTHING,
    PLY_X,
    PLY_NORMAL = PLY_X + 3,
    PLY_RED = PLY_NORMAL + 3,
    PLY_ALPHA = PLY_RED + 3,
    PLY_U,
    PLY_TEXNUMBER = PLY_U + 2,
    PLY_INDICES,
    PLY_TEXCOORD,
    PLY_ROLES
} ply_role;

typedef struct ply_property {
    char name[SCENE_NAME];
    ply_type type, count; /* of a value; of the number before a list's */
    bool is_list;
    ply_role role;
} ply_property;

/* So many rows of the same properties, one behind the other. */
typedef struct ply_element {
    char name[SCENE_NAME];
    uint64_t rows;
    size_t first, properties; /* in ply_file.properties */
    bool waits;               /* for the vertices, which come behind it */
    const uint8_t *at;        /* where it begins, if so */
    uint64_t line;
} ply_element;

/* A colour as it stands in the file. */
typedef struct ply_color {
    double value[3];
    ply_type type;      /* of its red */
    bool there, varies; /* the latter: it is not that of all rows */
} ply_color;

/* importer.reader */
typedef struct ply_file {
    importer *im;
    import_bytes file;
    const uint8_t *at, *end; /* what is left of it */
    uint64_t line, row;      /* for messages: of `at`, in text; of the element */
    ply_encoding encoding;
    const char *wrong; /* why the value, or the list, could not be read */
    bool keep;         /* what has been read of the file is read again */
    bool said_alpha, said_texcoord, said_color;

    ply_element *elements;
    ply_property *properties;
    size_t element_count, element_room, property_count, property_room;
    char (*textures)[SCENE_PATH];
    unsigned texture_count;
    size_t texture_room;

    uint32_t stated, vertices; /* of the file; with those that ply_corner.c adds */
    bool has_vertices;
    float *position, *normal, *uv; /* 3, 3 and 2 a vertex; NULL: the file has none */
    uint32_t *next;                /* copies of vertices with other coordinates (ply_corner.c) */
    size_t position_room, normal_room, uv_room, next_room;
    ply_color color; /* of vertices */

    /* Corners of triangles, VIT_NONE where they are out of range, are kept where the model's next triangles go. */
    size_t triangles, triangle_room;
    uint32_t *key; /* of a triangle: texture + (colour << 16); NULL: all 0 */
    size_t key_room;
    ply_color colors[PLY_COLORS]; /* of faces, from 1 on; 0 is none */
    unsigned color_count;
    bool more_colors; /* than that */

    /* The face that is being read: how many corners and coordinates it has, and as many as there is room for. */
    uint64_t corners, coordinates;
    uint32_t polygon[IMPORT_CORNERS];
    float texcoord[2 * IMPORT_CORNERS];
} ply_file;

/* ---- ply_header.c ---- */

/* Reads the header; what follows is at p->at. */
bool ply_read_header(ply_file *p);
/* The element's property of that role, or NULL. */
const ply_property *ply_property_of(const ply_file *p, const ply_element *e, ply_role role);

/* ---- ply_rows.c ---- */

/* Called for each list of a row: reads its `count` values, or passes over them. False: p->wrong says why. */
typedef bool ply_list_fn(ply_file *p, const ply_property *property, uint64_t count);
/* The next row's scalars by their roles; `list` for its lists. */
bool ply_read_row(ply_file *p, const ply_element *e, ply_list_fn *list, double row[PLY_ROLES]);
/* False: p->wrong says why. */
bool ply_read_value(ply_file *p, ply_type type, double *out);
bool ply_skip_list(ply_file *p, const ply_property *property, uint64_t count);
bool ply_skip_element(ply_file *p, const ply_element *e);
/* That many rows can be in what is left. */
bool ply_rows_fit(ply_file *p, const ply_element *e);

/* ---- ply_vertices.c ---- */

bool ply_read_vertices(ply_file *p, const ply_element *e);
/* The largest value that a colour of this type has. */
double ply_most(ply_type type);
/* Says once that alpha is not done. */
bool ply_say_alpha(ply_file *p);

/* ---- ply_faces.c ---- */

bool ply_read_faces(ply_file *p, const ply_element *e);
bool ply_read_strips(ply_file *p, const ply_element *e);
/* 3 a triangle. */
uint32_t *ply_corners(const ply_file *p);
/* ply_corner.c: the vertex `v` of the file with these texture coordinates: `v` itself or a copy of it. */
bool ply_corner(ply_file *p, uint32_t v, const float uv[2], uint32_t *out);

/* ---- ply_parts.c ---- */

/* Places the triangles, a part for each texture and colour. */
bool ply_place(ply_file *p, const double world[12]);
bool ply_material(importer *im, struct material_use *use);

#endif
