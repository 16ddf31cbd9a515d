/* threemf*.c: what the parts of the 3MF reader share. Private to them. Whatever fails says why by import_fail(). "Core",
 * "Materials", "Production" are the specifications of the 3MF Consortium: core 1.3, materials and properties 1.2, production
 * 1.1. */
#ifndef VIT_BAKE_THREEMF_FILE_H
#define VIT_BAKE_THREEMF_FILE_H

#include "import/importer.h"
#include <zip.h>

#define THREEMF_NONE UINT32_MAX
enum {
    THREEMF_PARTS = 4096,    /* model files in the archive */
    THREEMF_LOOKS = 1 << 14, /* materials of a file */
    THREEMF_SAID = 64,
    THREEMF_COLORS = 256 /* of colour groups, each of which becomes a material; others are in a picture */
};

/* What has an id, and is referred to by it. */
typedef enum threemf_kind {
    THREEMF_OBJECT,
    THREEMF_BASES,
    THREEMF_COLORGROUP,
    THREEMF_COORDINATES, /* texture2dgroup */
    THREEMF_COMPOSITES,
    THREEMF_MULTIS, /* multiproperties */
    THREEMF_TEXTURE,
    THREEMF_METALS /* pbmetallicdisplayproperties */
} threemf_kind;

/* An object or a group of properties. */
typedef struct threemf_resource {
    uint32_t part, id; /* of which model file; unique there (Core 3.4.2) */
    threemf_kind kind;
    uint32_t index; /* in objects or groups */
} threemf_resource;

typedef struct threemf_group {
    threemf_kind kind;
    uint32_t part;
    uint32_t first, count;   /* in colors, uv, picks or metals */
    uint32_t of;             /* id of what it is about: texture, base materials, last layer */
    uint32_t display;        /* id of its display properties, or THREEMF_NONE */
    uint32_t mixed, mixes;   /* composites: where in `mixed` its indices are, how many */
    uint32_t path;           /* texture: in `text` */
    uint32_t wrap_u, wrap_v; /* texture */
    uint32_t look;           /* coordinates: the material, once it is used */
    bool none_u, none_v;     /* texture: tile style "none" */
} threemf_group;

/* A colour of base materials, colour groups and composites, as it stands in the file. */
typedef struct threemf_color {
    uint8_t rgba[4]; /* sRGB */
    uint32_t name;   /* in `text`, or THREEMF_NONE */
    uint32_t look;   /* once a triangle has it all over: material, or with THREEMF_PAINTED a place in the picture of colours */
} threemf_color;
#define THREEMF_PAINTED UINT32_C(0x80000000)

/* What a triangle says of its properties (Core 4.1.4); and what they are: see threemf_resolve(). */
typedef struct threemf_ref {
    uint32_t pid, p[3];
} threemf_ref;

/* A material of the file. */
typedef struct threemf_look {
    uint32_t name;   /* in `text` */
    uint8_t rgba[4]; /* sRGB */
    bool grey;       /* nothing says a colour */
    bool keyed;      /* vertices have texture coordinates, by key */
    uint32_t group;  /* texture coordinates of this group; THREEMF_NONE: those of the picture of colours */
    uint32_t image;  /* texture, as a group, or THREEMF_NONE; groups: the picture of colours */
    uint32_t wrap_u, wrap_v;
    bool metal; /* metallic, roughness are stated */
    float metallic, roughness;
} threemf_look;

/* An object somewhere: of a component, or of an item of the build. */
typedef struct threemf_child {
    uint32_t part, id;
    double transform[12]; /* 3 x 4 */
} threemf_child;

typedef struct threemf_object {
    uint32_t part, id;
    uint32_t name; /* in `text`, or THREEMF_NONE */
    uint32_t pid, pindex;
    bool left_out; /* a support, or of type "other" */
    bool open;     /* on the way from the build to what is being placed */
    float *position;
    uint32_t *corner; /* 3 a triangle */
    threemf_ref *ref; /* one a triangle, or NULL: none says anything */
    size_t vertices, triangles, vertex_room, triangle_room, ref_room;
    size_t first_child, children;
    uint32_t look;        /* without `ref` */
    uint32_t first_place; /* in places, or THREEMF_NONE; the others by `next` */
    uint64_t places;
} threemf_object;

typedef struct threemf_place {
    double world[12];
    uint32_t next;
} threemf_place;

/* A model file of the archive. */
typedef struct threemf_part {
    uint32_t path; /* in `text` */
    double unit;   /* metres */
    bool has_unit;
} threemf_part;

/* importer.reader */
typedef struct threemf_file {
    importer *im;
    import_bytes bytes;
    zip_t *archive;
    char said[THREEMF_SAID][64]; /* what is left out and has been told of */
    unsigned said_count;

    char *text; /* names and paths, each ended by a 0 */
    size_t text_size, text_room;
    threemf_part *parts; /* the root's first */
    size_t part_count, part_room;
    threemf_object *objects;
    size_t object_count, object_room;
    threemf_group *groups;
    size_t group_count, group_room;
    threemf_resource *resources; /* sorted by threemf_sort() */
    size_t resource_count, resource_room;
    threemf_color *colors;
    size_t color_count, color_room;
    float *uv; /* 2 each */
    size_t uv_count, uv_room;
    uint32_t *picks; /* of multis: the index in the last layer */
    size_t pick_count, pick_room;
    uint32_t *mixed;
    size_t mixed_count, mixed_room;
    float *metals; /* metallic, roughness */
    size_t metal_count, metal_room;
    threemf_child *children; /* of objects */
    size_t child_count, child_room;
    threemf_child *items; /* of the build */
    size_t item_count, item_room;
    threemf_place *places;
    size_t place_count, place_room;
    threemf_look *looks;
    size_t look_count, look_room;
    uint64_t *of_look; /* triangles of each, in all places */
    size_t of_look_room;
    uint32_t plain, painted; /* the look without a property; that of the picture of colours; or THREEMF_NONE */
    uint32_t flat_look[THREEMF_COLORS], flat_looks; /* of colour groups */
    uint8_t (*paint)[3][3];                         /* the picture: colours of the corners of each of its places, sRGB */
    size_t paint_count, paint_room;
    uint64_t supports, not_printed, missing, bad_property; /* counted: objects placed, items, items and components, triangles */
    uint32_t missing_id;                                   /* the first object that is not there */
} threemf_file;

/* ---- threemf_package.c: the archive ---- */

bool threemf_open(threemf_file *f);
/* A part of that name, which is absolute; NULL: there is none, or it cannot be read (*wrong). */
zip_file_t *threemf_open_part(threemf_file *f, const char *name, const char **wrong);
/* The root model's name by the archive's relations (Core 2.1) into `text`. */
bool threemf_find_root(threemf_file *f, uint32_t *path);
/* As import_format.image has it. */
const char *threemf_image(importer *im, unsigned index, model_image *out);

/* ---- threemf_xml.c: XML as it comes ---- */

typedef enum threemf_ns {
    THREEMF_CORE, /* also without a namespace */
    THREEMF_MATERIAL,
    THREEMF_PRODUCTION,
    THREEMF_FOREIGN
} threemf_ns;

typedef struct threemf_attribute_value {
    const char *name, *uri, *value; /* uri: of the namespace, or "" */
} threemf_attribute_value;

typedef struct threemf_element {
    threemf_ns ns;
    const char *uri; /* of the namespace, or "" */
    const char *name;
    const threemf_attribute_value *attributes;
    size_t count;
} threemf_element;

typedef struct threemf_xml threemf_xml;
struct threemf_xml {
    threemf_file *f;
    const char *part;
    void *parser; /* xmlParserCtxt */
    zip_file_t *from;
    /* False: it has failed, and said why. Where `skip` is set, the elements in it are passed over. */
    bool (*begin)(threemf_xml *x, const threemf_element *e, bool *skip);
    void (*end)(threemf_xml *x);
    /* A prefix of the root element's. */
    bool (*prefix)(threemf_xml *x, const char *prefix, const char *uri);
    void *user;
    bool failed, damaged;
    unsigned depth, skipped;             /* elements that are open; of those, that are passed over */
    threemf_attribute_value *attributes; /* of the element that begins */
    char *values;
    size_t attribute_room, value_room;
    const char *last_uri;
    threemf_ns last_ns;
};

/* Reads part `name` of the archive; x->f and the functions are set. */
bool threemf_read_xml(threemf_xml *x, const char *name);
/* import_fail() with part and line. */
bool threemf_wrong(threemf_xml *x, const char *format, ...) __attribute__((format(printf, 2, 3)));
threemf_ns threemf_namespace(const char *uri); /* "": none */
/* Value of the attribute without a namespace; NULL: it is not there. */
const char *threemf_attribute(const threemf_element *e, const char *name);
/* Likewise one of the production extension's. */
const char *threemf_production(const threemf_element *e, const char *name);
/* The whole text, but for blanks round it, as an index: 0..2^31 - 1. */
bool threemf_index(const char *text, uint32_t *out);
/* The number at *at, which moves behind it and the blanks there. */
bool threemf_next_number(const char **at, bool single, double *out);
bool threemf_next_index(const char **at, uint32_t *out);

/* ---- threemf_model.c, threemf_properties.c: model files ---- */

/* All model files that the build leads to. */
bool threemf_read_models(threemf_file *f);
/* A text as it will be found in f->text. */
bool threemf_keep(threemf_file *f, const char *text, uint32_t *out);
/* The element's attribute that is an index: 1; it has none: 0; it is no index: -1, and has failed. */
int threemf_read_index(threemf_xml *x, const threemf_element *e, const char *name, uint32_t *out);
/* A new thing with the id of the element. */
bool threemf_add_resource(threemf_xml *x, const threemf_element *e, uint32_t part, threemf_kind kind, size_t index);
bool threemf_begin_group(threemf_xml *x, const threemf_element *e, uint32_t part, threemf_kind kind);
/* An element in the group that was begun last. */
bool threemf_add_property(threemf_xml *x, const threemf_element *e);
/* By part and id; NULL: it is not there. After threemf_sort(). */
bool threemf_sort(threemf_file *f);
const threemf_resource *threemf_find(const threemf_file *f, uint32_t part, uint32_t id);

/* ---- threemf_extensions.c ---- */

/* The extension of this namespace is used or required (Core 2.3.1); false: it is required and not read. */
bool threemf_note_extension(threemf_file *f, const char *uri, bool required);
/* Tells once that such elements, or such attributes of triangles, are left out, if that changes a picture; strict: fails. */
bool threemf_leave_out(threemf_file *f, const threemf_element *e);
bool threemf_leave_out_attribute(threemf_file *f, const char *name);
/* That is told of for the first time. */
bool threemf_is_new(threemf_file *f, const char *name);

/* ---- threemf_look.c: triangles' properties as materials ---- */

/* Objects that are somewhere: each ref becomes pid: the look; p: keys of texture coordinates. */
bool threemf_resolve(threemf_file *f);
/* As import_format.material has it. */
bool threemf_material(importer *im, material_use *use);

/* ---- threemf_paint.c: colours of corners, as a picture ---- */

/* A place in it with these colours of three corners. The key of corner k is 4 * place + k; 3: its middle. */
bool threemf_paint(threemf_file *f, const uint8_t *const rgba[3], uint32_t *place);
void threemf_paint_uv(const threemf_file *f, uint32_t key, float uv[2]);
const char *threemf_paint_image(const threemf_file *f, model_image *out);

/* ---- threemf_place.c ---- */

/* Where the build puts which objects. */
bool threemf_find_places(threemf_file *f, const double stand[12]);
bool threemf_place_all(threemf_file *f);

#endif
