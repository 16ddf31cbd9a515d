/* Model files (Core 3.4, 4; Production 3): units, objects, the build. */
#include "import/3mf/threemf_file.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* What the element that is being read is in. */
typedef enum inside { TOP, MODEL, RESOURCES, OBJECT, MESH, VERTICES, TRIANGLES, COMPONENTS, BUILD, GROUP, LEAF } inside;

typedef struct prefix {
    char name[32], uri[128];
} prefix;

typedef struct reading {
    uint32_t part;
    inside in[8]; /* of each element that is open and not passed over, the last for all below */
    unsigned depth;
    prefix prefixes[64]; /* of the root element */
    unsigned prefix_count;
} reading;

bool threemf_keep(threemf_file *f, const char *text, uint32_t *out) {
    const size_t size = strlen(text) + 1;
    if (f->text_size + size >= THREEMF_NONE)
        return import_fail(f->im, "has more than 4 GiB of names");
    if (!import_room(f->im, &f->text, &f->text_room, f->text_size + size, 1))
        return false;
    memcpy(f->text + f->text_size, text, size);
    *out = (uint32_t)f->text_size;
    f->text_size += size;
    return true;
}

int threemf_read_index(threemf_xml *x, const threemf_element *e, const char *name, uint32_t *out) {
    const char *text = threemf_attribute(e, name);
    if (!text)
        return 0;
    if (threemf_index(text, out))
        return 1;
    (void)threemf_wrong(x, "%s '%.40s' of <%.40s> is no index", name, text, e->name);
    return -1;
}

bool threemf_add_resource(threemf_xml *x, const threemf_element *e, uint32_t part, threemf_kind kind, size_t index) {
    threemf_file *f = x->f;
    uint32_t id;
    const int has = threemf_read_index(x, e, "id", &id);
    if (has <= 0)
        return has < 0 ? false : threemf_wrong(x, "<%.40s> has no id", e->name);
    if (index >= THREEMF_NONE || f->resource_count >= THREEMF_NONE)
        return threemf_wrong(x, "has too many resources");
    if (!import_room(f->im, &f->resources, &f->resource_room, f->resource_count + 1, sizeof *f->resources))
        return false;
    f->resources[f->resource_count++] = (threemf_resource){part, id, kind, (uint32_t)index};
    return true;
}

/* ---- the model ---- */

static bool keep_prefix(threemf_xml *x, const char *name, const char *uri) {
    reading *r = x->user;
    if (r->prefix_count == sizeof r->prefixes / sizeof *r->prefixes)
        return threemf_wrong(x, "has more than %u namespaces", r->prefix_count);
    prefix *p = &r->prefixes[r->prefix_count++];
    (void)snprintf(p->name, sizeof p->name, "%s", name);
    (void)snprintf(p->uri, sizeof p->uri, "%s", uri);
    return true;
}

/* "m p": prefixes of the namespaces of extensions without which the file is not what it means. */
static bool read_required(threemf_xml *x, const char *list) {
    const reading *r = x->user;
    for (const char *at = list + strspn(list, " \t\r\n"); *at; at += strspn(at, " \t\r\n")) {
        const size_t length = strcspn(at, " \t\r\n");
        const char *uri = NULL;
        for (unsigned i = 0; i < r->prefix_count && !uri; i++)
            if (strlen(r->prefixes[i].name) == length && memcmp(r->prefixes[i].name, at, length) == 0)
                uri = r->prefixes[i].uri;
        if (!uri)
            return threemf_wrong(x, "requires an extension '%.*s' that has no namespace", length < 40 ? (int)length : 40, at);
        if (threemf_namespace(uri) != THREEMF_CORE && !threemf_note_extension(x->f, uri, true))
            return false;
        at += length;
    }
    return true;
}

static bool begin_model(threemf_xml *x, const threemf_element *e) {
    static const struct {
        const char *word;
        double metres;
    } units[] = {{"micron", 1e-6}, {"millimeter", 1e-3}, {"centimeter", 1e-2},
                 {"meter", 1.0},   {"inch", 0.0254},     {"foot", 0.3048}};
    threemf_part *p = &x->f->parts[((reading *)x->user)->part];
    const char *unit = threemf_attribute(e, "unit"), *required = threemf_attribute(e, "requiredextensions");
    p->has_unit = unit != NULL;
    p->unit = unit ? 0.0 : 1e-3;
    for (size_t i = 0; unit && i < sizeof units / sizeof *units; i++)
        if (strcmp(units[i].word, unit) == 0)
            p->unit = units[i].metres;
    if (p->unit <= 0.0)
        return threemf_wrong(x, "has unit '%.40s', which is none", unit);
    return !required || read_required(x, required);
}

/* ---- objects ---- */

static threemf_object *object(const threemf_xml *x) {
    return &x->f->objects[x->f->object_count - 1];
}

static bool begin_object(threemf_xml *x, const threemf_element *e) {
    static const char *const left_out[] = {"support", "solidsupport", "other"}, *const shown[] = {"model", "surface"};
    threemf_file *f = x->f;
    const char *type = threemf_attribute(e, "type"), *name = threemf_attribute(e, "name");
    if (!import_room(f->im, &f->objects, &f->object_room, f->object_count + 1, sizeof *f->objects) ||
        !threemf_add_resource(x, e, ((reading *)x->user)->part, THREEMF_OBJECT, f->object_count))
        return false;
    threemf_object *o = &f->objects[f->object_count++];
    *o = (threemf_object){.part = ((reading *)x->user)->part,
                          .id = f->resources[f->resource_count - 1].id,
                          .name = THREEMF_NONE,
                          .pid = THREEMF_NONE,
                          .pindex = 0,
                          .first_child = f->child_count,
                          .first_place = THREEMF_NONE};
    bool known = !type;
    for (size_t i = 0; type && i < sizeof left_out / sizeof *left_out; i++)
        o->left_out = o->left_out || strcmp(left_out[i], type) == 0;
    for (size_t i = 0; type && i < sizeof shown / sizeof *shown; i++)
        known = known || strcmp(shown[i], type) == 0;
    if (!known && !o->left_out)
        return threemf_wrong(x, "type '%.40s' of object %u is none", type, o->id);
    return threemf_read_index(x, e, "pid", &o->pid) >= 0 && threemf_read_index(x, e, "pindex", &o->pindex) >= 0 &&
           (!name || !*name || threemf_keep(f, name, &o->name));
}

static bool add_vertex(threemf_xml *x, const threemf_element *e) {
    threemf_object *o = object(x);
    unsigned has = 0;
    if (o->vertices >= THREEMF_NONE - 1)
        return threemf_wrong(x, "has too many vertices");
    if (!import_room(x->f->im, &o->position, &o->vertex_room, o->vertices + 1, 3 * sizeof *o->position))
        return false;
    float *to = o->position + 3 * o->vertices;
    for (size_t i = 0; i < e->count; i++) {
        const char *name = e->attributes[i].name, *at = e->attributes[i].value;
        const unsigned k = (unsigned)(name[0] - 'x');
        double value;
        if (k > 2 || name[1] || *e->attributes[i].uri)
            continue;
        if (!threemf_next_number(&at, true, &value) || *at)
            return threemf_wrong(x, "%s '%.40s' of a vertex is no number", name, e->attributes[i].value);
        to[k] = (float)value;
        has |= 1u << k;
    }
    o->vertices++;
    return has == 7 || threemf_wrong(x, "a vertex has no %s", !(has & 1) ? "x" : !(has & 2) ? "y" : "z");
}

/* Where the attribute's value goes: v1 v2 v3 0 to 2, pid 3, p1 p2 p3 4 to 6; 7: elsewhere. */
static unsigned slot(const char *name) {
    if ((name[0] == 'v' || name[0] == 'p') && name[1] >= '1' && name[1] <= '3' && !name[2])
        return (name[0] == 'v' ? 0u : 4u) + (unsigned)(name[1] - '1');
    return strcmp(name, "pid") == 0 ? 3 : 7;
}

/* From here on the object's triangles have refs; those so far say nothing. */
static bool begin_refs(threemf_xml *x, threemf_object *o) {
    if (!import_room(x->f->im, &o->ref, &o->ref_room, o->triangles + 1, sizeof *o->ref))
        return false;
    memset(o->ref, 0xff, o->triangles * sizeof *o->ref); /* THREEMF_NONE */
    return true;
}

static bool add_triangle(threemf_xml *x, const threemf_element *e) {
    threemf_object *o = object(x);
    uint32_t value[7];
    memset(value, 0xff, sizeof value); /* THREEMF_NONE */
    for (size_t i = 0; i < e->count; i++) {
        const threemf_attribute_value *a = &e->attributes[i];
        const unsigned k = *a->uri ? 7 : slot(a->name);
        if (k == 7 ? !threemf_leave_out_attribute(x->f, a->name) : !threemf_index(a->value, &value[k]))
            return k == 7 ? false : threemf_wrong(x, "%s '%.40s' of a triangle is no index", a->name, a->value);
    }
    for (unsigned k = 0; k < 3; k++)
        if (value[k] == THREEMF_NONE)
            return threemf_wrong(x, "a triangle has no v%u", k + 1);
    const bool says = value[4] != THREEMF_NONE;
    if (o->triangles >= VIT_MAX_TRIANGLES)
        return threemf_wrong(x, "has more than %u triangles", VIT_MAX_TRIANGLES);
    if (!import_room(x->f->im, &o->corner, &o->triangle_room, o->triangles + 1, 3 * sizeof *o->corner))
        return false;
    memcpy(o->corner + 3 * o->triangles, value, 3 * sizeof *value);
    if (says && !o->ref && !begin_refs(x, o))
        return false;
    if (o->ref) {
        if (!import_room(x->f->im, &o->ref, &o->ref_room, o->triangles + 1, sizeof *o->ref))
            return false;
        memcpy(&o->ref[o->triangles], value + 3, sizeof *o->ref);
    }
    o->triangles++;
    return true;
}

/* ---- components, items ---- */

/* Twelve numbers, four rows that a point's row stands before (Core 3.3). */
static bool read_transform(threemf_xml *x, const threemf_element *e, double out[12]) {
    static const double identity[12] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
    const char *text = threemf_attribute(e, "transform"), *at = text;
    double value;
    memcpy(out, identity, sizeof identity);
    for (int i = 0; text && i < 12; i++) {
        if (!threemf_next_number(&at, false, &value))
            return threemf_wrong(x, "transform '%.100s' of <%s> has not 12 numbers", text, e->name);
        out[4 * (i % 3) + i / 3] = value;
    }
    return !text || !*at || threemf_wrong(x, "transform '%.100s' of <%s> has more than 12 numbers", text, e->name);
}

/* The model file of that path, which will be read if it has not been. */
static bool part_of(threemf_file *f, const char *path, uint32_t *out) {
    for (size_t i = f->part_count; i-- > 0;)
        if (strcmp(f->text + f->parts[i].path, path) == 0) {
            *out = (uint32_t)i;
            return true;
        }
    if (f->part_count == THREEMF_PARTS)
        return import_fail(f->im, "has more than %d model files", THREEMF_PARTS);
    if (!import_room(f->im, &f->parts, &f->part_room, f->part_count + 1, sizeof *f->parts))
        return false;
    *out = (uint32_t)f->part_count;
    f->parts[f->part_count] = (threemf_part){.unit = 1e-3};
    return threemf_keep(f, path, &f->parts[f->part_count++].path);
}

static bool read_child(threemf_xml *x, const threemf_element *e, threemf_child *out) {
    static const char production[] = "http://schemas.microsoft.com/3dmanufacturing/production/2015/06";
    const reading *r = x->user;
    const char *path = threemf_production(e, "path");
    *out = (threemf_child){.part = r->part};
    const int has = threemf_read_index(x, e, "objectid", &out->id);
    if (has <= 0)
        return has < 0 ? false : threemf_wrong(x, "<%s> has no objectid", e->name);
    if (path && (!threemf_note_extension(x->f, production, false) || !part_of(x->f, path, &out->part)))
        return false;
    return read_transform(x, e, out->transform);
}

static bool add_component(threemf_xml *x, const threemf_element *e) {
    threemf_file *f = x->f;
    threemf_child child;
    if (!read_child(x, e, &child) || !import_room(f->im, &f->children, &f->child_room, f->child_count + 1, sizeof *f->children))
        return false;
    f->children[f->child_count++] = child;
    object(x)->children++;
    return true;
}

/* The builds of other model files than the root mean nothing (Production 2). */
static bool add_item(threemf_xml *x, const threemf_element *e) {
    threemf_file *f = x->f;
    const char *printable = threemf_attribute(e, "printable");
    threemf_child child;
    if (((const reading *)x->user)->part != 0)
        return true;
    if (printable && (strcmp(printable, "0") == 0 || strcmp(printable, "false") == 0)) {
        f->not_printed++;
        return true;
    }
    if (!read_child(x, e, &child) || !import_room(f->im, &f->items, &f->item_room, f->item_count + 1, sizeof *f->items))
        return false;
    f->items[f->item_count++] = child;
    return true;
}

/* ---- elements ---- */

static bool begin_group(threemf_xml *x, const threemf_element *e) {
    static const struct {
        const char *name;
        threemf_kind kind;
    } kinds[] = {{"basematerials", THREEMF_BASES},
                 {"colorgroup", THREEMF_COLORGROUP},
                 {"texture2dgroup", THREEMF_COORDINATES},
                 {"texture2d", THREEMF_TEXTURE},
                 {"compositematerials", THREEMF_COMPOSITES},
                 {"multiproperties", THREEMF_MULTIS},
                 {"pbmetallicdisplayproperties", THREEMF_METALS}};
    size_t i = 0;
    while (strcmp(kinds[i].name, e->name) != 0)
        i++;
    return threemf_begin_group(x, e, ((reading *)x->user)->part, kinds[i].kind);
}

typedef struct rule {
    inside in;
    threemf_ns ns;
    const char *name;
    inside to;
    bool (*begin)(threemf_xml *x, const threemf_element *e);
} rule;

static const rule rules[] = {
    {VERTICES, THREEMF_CORE, "vertex", LEAF, add_vertex},
    {TRIANGLES, THREEMF_CORE, "triangle", LEAF, add_triangle},
    {TOP, THREEMF_CORE, "model", MODEL, begin_model},
    {MODEL, THREEMF_CORE, "resources", RESOURCES, NULL},
    {MODEL, THREEMF_CORE, "build", BUILD, NULL},
    {RESOURCES, THREEMF_CORE, "object", OBJECT, begin_object},
    {RESOURCES, THREEMF_CORE, "basematerials", GROUP, begin_group},
    {RESOURCES, THREEMF_MATERIAL, "colorgroup", GROUP, begin_group},
    {RESOURCES, THREEMF_MATERIAL, "texture2dgroup", GROUP, begin_group},
    {RESOURCES, THREEMF_MATERIAL, "texture2d", LEAF, begin_group},
    {RESOURCES, THREEMF_MATERIAL, "compositematerials", GROUP, begin_group},
    {RESOURCES, THREEMF_MATERIAL, "multiproperties", GROUP, begin_group},
    {RESOURCES, THREEMF_MATERIAL, "pbmetallicdisplayproperties", GROUP, begin_group},
    {OBJECT, THREEMF_CORE, "mesh", MESH, NULL},
    {OBJECT, THREEMF_CORE, "components", COMPONENTS, NULL},
    {MESH, THREEMF_CORE, "vertices", VERTICES, NULL},
    {MESH, THREEMF_CORE, "triangles", TRIANGLES, NULL},
    {COMPONENTS, THREEMF_CORE, "component", LEAF, add_component},
    {BUILD, THREEMF_CORE, "item", LEAF, add_item},
    {GROUP, THREEMF_CORE, "base", LEAF, threemf_add_property},
    {GROUP, THREEMF_MATERIAL, "color", LEAF, threemf_add_property},
    {GROUP, THREEMF_MATERIAL, "tex2coord", LEAF, threemf_add_property},
    {GROUP, THREEMF_MATERIAL, "composite", LEAF, threemf_add_property},
    {GROUP, THREEMF_MATERIAL, "multi", LEAF, threemf_add_property},
    {GROUP, THREEMF_MATERIAL, "pbmetallic", LEAF, threemf_add_property},
};

static const rule *rule_of(inside in, const threemf_element *e) {
    for (size_t i = 0; i < sizeof rules / sizeof *rules; i++)
        if (rules[i].in == in && rules[i].ns == e->ns && strcmp(rules[i].name, e->name) == 0)
            return &rules[i];
    return NULL;
}

static bool is_metadata(const threemf_element *e) {
    return e->ns == THREEMF_CORE && (strcmp(e->name, "metadata") == 0 || strcmp(e->name, "metadatagroup") == 0);
}

static bool begin(threemf_xml *x, const threemf_element *e, bool *skip) {
    reading *r = x->user;
    const inside in = r->depth > 0 ? r->in[r->depth - 1] : TOP;
    const rule *to = rule_of(in, e);
    *skip = !to;
    if (in == TOP && !to)
        return threemf_wrong(x, "<%.40s> is no <model> of 3MF", e->name);
    if (!to)
        return is_metadata(e) || threemf_leave_out(x->f, e);
    /* No rule leads deeper than model, resources, object, mesh, triangles, triangle. */
    r->in[r->depth++] = to->to;
    if (in == RESOURCES && e->ns == THREEMF_MATERIAL && !threemf_note_extension(x->f, e->uri, false))
        return false;
    return !to->begin || to->begin(x, e);
}

static void end(threemf_xml *x) {
    ((reading *)x->user)->depth--;
}

/* Its name may move, as those of all are. */
static bool read_part(threemf_file *f, uint32_t part) {
    reading r = {.part = part};
    threemf_xml x = {.f = f, .begin = begin, .end = end, .prefix = keep_prefix, .user = &r};
    const char *name = f->text + f->parts[part].path;
    char *own = malloc(strlen(name) + 1);
    if (!own)
        return import_fail(f->im, "out of memory");
    strcpy(own, name); /* NOLINT(clang-analyzer-security.insecureAPI.strcpy): there is room for it */
    const bool fine = threemf_read_xml(&x, own);
    free(own);
    return fine;
}

bool threemf_read_models(threemf_file *f) {
    uint32_t path, root;
    if (!threemf_find_root(f, &path))
        return false;
    char name[SCENE_PATH];
    (void)snprintf(name, sizeof name, "%s", f->text + path);
    if (!part_of(f, name, &root))
        return false;
    for (uint32_t i = 0; i < f->part_count; i++)
        if (!read_part(f, i))
            return false;
    return true;
}

/* ---- by id ---- */

static uint64_t key(const threemf_resource *r) {
    return (uint64_t)r->part << 32 | r->id;
}

static int by_id(const void *left, const void *right) {
    const uint64_t a = key(left), b = key(right);
    return (a > b) - (a < b);
}

bool threemf_sort(threemf_file *f) {
    if (f->resource_count > 0)
        qsort(f->resources, f->resource_count, sizeof *f->resources, by_id);
    for (size_t i = 1; i < f->resource_count; i++)
        if (by_id(&f->resources[i - 1], &f->resources[i]) == 0)
            return import_fail(f->im, "%.200s has several resources of id %u", f->text + f->parts[f->resources[i].part].path,
                               f->resources[i].id);
    return true;
}

const threemf_resource *threemf_find(const threemf_file *f, uint32_t part, uint32_t id) {
    const threemf_resource wanted = {.part = part, .id = id};
    return f->resource_count == 0 ? NULL : bsearch(&wanted, f->resources, f->resource_count, sizeof *f->resources, by_id);
}
