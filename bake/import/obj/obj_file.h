/* obj*.c, mtl*.c: what the parts of the OBJ reader share. Private to them. Whatever fails says why by import_fail(). */
#ifndef VIT_BAKE_OBJ_FILE_H
#define VIT_BAKE_OBJ_FILE_H

#include "import/importer.h"

#define OBJ_NONE UINT32_MAX        /* no texture coordinate, no normal, no material */
#define OBJ_BAD (UINT32_MAX - 1)   /* an index that leads nowhere */
#define OBJ_MOST (UINT32_MAX - 16) /* elements of a list */

/* Characters of a file that is mapped. */
typedef struct obj_text {
    const char *at, *end;
} obj_text;

/* Lines of a file; `next` is NULL at its end. */
typedef struct obj_lines {
    obj_text rest;
    char newline; /* CR in files that have no LF */
    uint32_t number, next_number;
} obj_lines;

/* A list of names, each once, by their numbers. */
typedef struct obj_names {
    obj_text *name;
    uint32_t *slot; /* a hash table of slot_count; OBJ_NONE: empty */
    size_t count, room, slot_count;
} obj_names;

/* A picture, and where it lies: u' = scale u + offset, v upwards. */
typedef struct mtl_map {
    obj_text name; /* empty: none */
    float scale[2], offset[2];
    bool clamp;
} mtl_map;

/* What MTL says and is not done, told of once a file: X(name, words). */
#define MTL_NOT_DONE(X)                                                                                                        \
    X(BUMP, "bump and displacement maps are left out")                                                                         \
    X(NORMAL, "normal maps that lie otherwise than the colour are left out")                                                   \
    X(REFLECTION, "reflection maps are left out")                                                                              \
    X(DECAL, "decals are left out")                                                                                            \
    X(MAPPED_NUMBER, "maps of Ns, Ni, Tr, Tf, Ps and Pc are left out")                                                         \
    X(COAT, "sheen, clearcoat and anisotropy (Ps, Pc, Pcr, aniso) are left out")                                               \
    X(HALO, "'-halo' of d is left out")                                                                                        \
    X(OPTION, "options -t, -mm, -imfchan, -texres and -cc of maps are left out")                                               \
    X(SPECTRAL, "colours as 'spectral' or 'xyz' are left out")                                                                 \
    X(CONTRADICTION, "d and Tr contradict each other: d counts")

typedef enum mtl_remark {
#define X(name, words) MTL_##name,
    MTL_NOT_DONE(X)
#undef X
        MTL_REMARKS
} mtl_remark;

/* A material by its lines. */
typedef struct mtl {
    float color[3], ambient[3], specular[3], emission[3], filter[3]; /* Kd, Ka, Ks, Ke, Tf */
    float exponent, ior, opacity, transparency;                      /* Ns, Ni, d, Tr */
    float roughness, metallic;                                       /* Pr, Pm */
    float illum;
    float sheen, coat; /* Ps and Pc: only whether there is any */
    unsigned has;      /* bits of mtl_said */
    mtl_map color_map, specular_map, emission_map, opacity_map, roughness_map, metallic_map, normal_map;
    unsigned remarks; /* bits of mtl_remark */
    bool defined;     /* a material file has it */
} mtl;
enum mtl_said {
    MTL_HAS_COLOR = 1,
    MTL_HAS_OPACITY = 2,
    MTL_HAS_TRANSPARENCY = 4,
    MTL_HAS_ROUGHNESS = 8,
    MTL_HAS_METALLIC = 16
};

/* Faces of one mesh and one material, of which all or none have normals. */
typedef struct obj_part {
    uint32_t mesh, material;
    bool normals;
    size_t face, corner; /* its first; the next part's are its ends */
    uint64_t triangles;
} obj_part;

/* importer.reader */
typedef struct obj_file {
    importer *im;
    import_bytes bytes;
    obj_lines lines;

    float *position, *color, *uv, *normal; /* 3, 3, 2, 3; color: NULL, or one a position */
    size_t positions, colors, uvs, normals;
    size_t position_room, color_room, uv_room, normal_room;
    uint32_t *corner, *corner_uv, *corner_normal; /* the last two NULL until one has any */
    size_t corners, corner_room, corner_uv_room, corner_normal_room;
    uint16_t *face;      /* corners of each */
    uint32_t *smoothing; /* group of each; NULL until the file names one */
    size_t faces, face_room, smoothing_room;
    obj_part *part;
    size_t parts, part_room;
    obj_names meshes; /* those that have faces */

    obj_text mesh_name;                                     /* of faces to come */
    uint32_t mesh, material, group;                         /* the same; mesh: OBJ_NONE, its name is not looked up yet */
    bool curves, calls, textures, states, unknown, painted; /* said: what is left out */

    obj_names materials, libraries; /* as usemtl and mtllib name them; OBJ_NONE is the one without a name, the last */
    mtl *mtl;                       /* each of `materials`, and that one */
    import_bytes *library;          /* material files */
    size_t library_count;
    bool no_library; /* one is not there */
    bool inverse;    /* the file's opacities are transparencies */
    unsigned said;   /* bits of mtl_remark */
} obj_file;

/* ---- obj_text.c ---- */

obj_lines obj_lines_of(const import_bytes *bytes);
/* The next statement, with what continues it; false: there is none. */
bool obj_next_line(obj_lines *lines, obj_text *line);
/* The next word of `line`, which begins behind it then; empty at its end, or at a comment. */
obj_text obj_word(obj_text *line);
/* The rest of the line, without the blanks around it. */
obj_text obj_rest(obj_text line);
/* A number; the line begins behind it then. False: the next word is none, or there is none. */
bool obj_number(obj_text *line, float *out);
bool obj_is(obj_text text, const char *word); /* whatever the case of ASCII letters */
static inline bool obj_is_empty(obj_text text) {
    return text.at == text.end;
}
/* For "%.*s" of messages and fixed names. */
static inline int obj_size(obj_text text, int most) {
    return text.end - text.at < most ? (int)(text.end - text.at) : most;
}

/* obj_names.c: the number of a name, which is added if it is new; OBJ_NONE: out of memory. */
uint32_t obj_name(importer *im, obj_names *names, obj_text name);
uint32_t obj_find_name(const obj_names *names, obj_text name); /* OBJ_NONE: it is not there */
void obj_free_names(obj_names *names);

/* ---- obj_read.c, obj_face.c, obj_part.c ---- */

/* All statements of the file. */
bool obj_read(obj_file *o);
/* f, p, l: what follows the word. */
bool obj_read_face(obj_file *o, obj_text line);
void obj_count_elements(obj_file *o, obj_text line, bool lines);
/* Triangles of each material by its faces' corners; one count more than there are names. */
void obj_count_triangles(const obj_file *o, uint64_t *of_material);
/* All parts, placed by `world`. */
bool obj_place(obj_file *o, const double world[12]);

/* ---- mtl_*.c ---- */

/* mtl_read.c: o->mtl from o->libraries. */
bool mtl_read(obj_file *o);
/* mtl_lines.c: materials of one file, of those that are used. */
bool mtl_read_lines(obj_file *o, const import_bytes *bytes);
mtl mtl_default(void);

/* mtl_material.c: as import_format.material has it. */
bool mtl_material(importer *im, material_use *use);
/* How the file means transparency. */
bool mtl_transparency(obj_file *o);
void mtl_name_of(obj_text text, char out[SCENE_PATH]);

/* mtl_shine.c: kind, lobe, glass and what they leave of the albedo, once colour, emission and alpha are known. False: a
 * texture that is needed (strict), or out of memory. */
bool mtl_shine(importer *im, material_use *use, const mtl *m);
/* `illum` says that light goes through. */
bool mtl_is_glass(const mtl *m);

#endif
