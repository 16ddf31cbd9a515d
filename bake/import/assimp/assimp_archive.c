/* What 3MF and AMF files say and Assimp leaves out or reads differently from release to release: the unit, and colours. A 3MF
 * file is an archive whose relations name the model (3MF core specification, 2.1; Open Packaging Conventions). */
#include "import/assimp/assimp_scene.h"
#include <ctype.h>
#include <minizip/unzip.h>
#include <stdio.h>
#include <string.h>

enum { TAG = 4096, WORD = 64, CHUNK = 1 << 14 }; /* bytes of a tag and of a value that are looked at; of a read */

/* Text as it comes, in tags. */
typedef struct tags {
    char tag[TAG]; /* what stands between < and >, so far */
    size_t length;
    bool inside;
} tags;

/* The value of a tag's attribute, cut to WORD - 1 bytes; "" if it is not there. */
static void attribute(const char *tag, const char *name, char out[WORD]) {
    const size_t length = strlen(name);
    out[0] = '\0';
    for (const char *at = tag; (at = strstr(at, name)); at += length) {
        const char *c = at + length + strspn(at + length, " \t\r\n");
        if (at == tag || !isspace((unsigned char)at[-1]) || *c != '=')
            continue;
        c += 1 + strspn(c + 1, " \t\r\n");
        if (*c == '"' || *c == '\'') {
            const char quote[2] = {*c, '\0'};
            const size_t size = strcspn(c + 1, quote);
            (void)snprintf(out, WORD, "%.*s", (int)(size < WORD ? size : WORD - 1), c + 1);
        }
        return;
    }
}

/* The tag is of this name, whatever stands for its namespace. */
static bool is_tag(const char *tag, const char *name) {
    const size_t whole = strcspn(tag, " \t\r\n/"), length = strlen(name);
    return whole >= length && memcmp(tag + whole - length, name, length) == 0 &&
           (whole == length || tag[whole - length - 1] == ':');
}

typedef void tag_fn(void *user, const char *tag);

static void take_text(tags *t, const char *text, size_t size, tag_fn *take, void *user) {
    for (size_t i = 0; i < size; i++) {
        const char c = text[i];
        if (t->inside && c == '>') {
            t->tag[t->length] = '\0';
            take(user, t->tag);
            t->inside = false;
        } else if (c == '<') {
            t->inside = true;
            t->length = 0;
        } else if (t->inside && t->length < TAG - 1)
            t->tag[t->length++] = c != '\0' ? c : ' ';
    }
}

/* Metres; 0: no unit of 3MF's or AMF's. */
static double metres(const char *word) {
    static const struct {
        const char *word;
        double metres;
    } units[] = {{"micron", 1e-6}, {"millimeter", 1e-3}, {"centimeter", 1e-2}, {"meter", 1.0},
                 {"inch", 0.0254}, {"foot", 0.3048},     {"feet", 0.3048},     {"millimeters", 1e-3}};
    for (size_t i = 0; i < sizeof units / sizeof *units; i++)
        if (!strcmp(units[i].word, word))
            return units[i].metres;
    return 0.0;
}

static bool settle(importer *im, const char *word, double *unit, bool *stated) {
    *stated = word[0] != '\0';
    *unit = *stated ? metres(word) : 1e-3;
    return *unit > 0.0 || import_fail(im, "has unit '%.40s', which is none", word);
}

/* ---- AMF ---- */

static void take_amf(void *user, const char *tag) {
    if (is_tag(tag, "amf"))
        attribute(tag, "unit", user);
}

bool assimp_unit_amf(importer *im, double *unit, bool *stated) {
    char text[CHUNK], word[WORD] = "";
    tags t = {.inside = false};
    FILE *file = fopen(im->file, "rb");
    const size_t size = file ? fread(text, 1, sizeof text, file) : 0;
    if (file)
        (void)fclose(file);
    take_text(&t, text, size, take_amf, word);
    return settle(im, word, unit, stated);
}

/* ---- 3MF ---- */

enum { COLORS, TEXTURES, MIXES, BEAMS, SLICES, ELSEWHERE, SEVERAL, PARTS };

typedef struct package {
    char model[WORD * 4]; /* name of the model in the archive */
    char unit[WORD];
    char object[WORD], first[WORD]; /* materials of the object, and of its first triangle */
    bool begun;                     /* the object has a triangle */
    bool has[PARTS];
} package;

static void take_relation(void *user, const char *tag) {
    package *p = user;
    char type[256] = "", target[WORD];
    const char *at = strstr(tag, "Type");
    if (!is_tag(tag, "Relationship") || !at)
        return;
    (void)snprintf(type, sizeof type, "%s", at);
    attribute(tag, "Target", target);
    if (strstr(type, "/3dmodel\"") || strstr(type, "/3dmodel'"))
        (void)snprintf(p->model, sizeof p->model, "%s", target + strspn(target, "/"));
}

/* "pid/p1", the material of all three corners; "" if the triangle has that of its object. */
static void material_of(package *p, const char *tag, const char *index, char out[WORD]) {
    char pid[WORD], place[WORD];
    attribute(tag, "pid", pid);
    attribute(tag, index, place);
    (void)snprintf(out, WORD, "%.20s/%.20s", pid[0] ? pid : p->object, place);
}

static void take_triangle(package *p, const char *tag) {
    char all[WORD], other[WORD];
    attribute(tag, "p1", other);
    material_of(p, tag, "p1", all);
    if (!other[0])
        all[0] = '\0';
    for (const char *corner = "p2"; corner; corner = corner[1] == '2' ? "p3" : NULL) {
        attribute(tag, corner, other);
        if (other[0]) {
            material_of(p, tag, corner, other);
            p->has[SEVERAL] |= strcmp(other, all) != 0;
        }
    }
    p->has[SEVERAL] |= p->begun && strcmp(all, p->first) != 0;
    memcpy(p->first, all, sizeof p->first);
    p->begun = true;
}

static void take_model(void *user, const char *tag) {
    static const struct {
        const char *name;
        int part;
    } parts[] = {{"colorgroup", COLORS},     {"texture2dgroup", TEXTURES}, {"compositematerials", MIXES},
                 {"multiproperties", MIXES}, {"beamlattice", BEAMS},       {"slicestack", SLICES}};
    package *p = user;
    if (is_tag(tag, "triangle")) {
        take_triangle(p, tag);
        return;
    }
    for (size_t i = 0; i < sizeof parts / sizeof *parts; i++)
        p->has[parts[i].part] |= is_tag(tag, parts[i].name);
    if (is_tag(tag, "model") && !p->unit[0])
        attribute(tag, "unit", p->unit);
    if (is_tag(tag, "component") || is_tag(tag, "item"))
        p->has[ELSEWHERE] |= strstr(tag, ":path") != NULL;
    if (is_tag(tag, "object")) {
        attribute(tag, "pid", p->object);
        p->begun = false;
    }
}

static bool read_part(unzFile archive, const char *name, tag_fn *take, package *p) {
    char text[CHUNK];
    tags t = {.inside = false};
    int size = -1;
    if (unzLocateFile(archive, name, 2) != UNZ_OK || unzOpenCurrentFile(archive) != UNZ_OK) /* 2: either case */
        return false;
    while ((size = unzReadCurrentFile(archive, text, sizeof text)) > 0)
        take_text(&t, text, (size_t)size, take, p);
    (void)unzCloseCurrentFile(archive);
    return size == 0;
}

/* What the file says and nobody does. Assimp 5.4 has colours and textures of triangles, 5.2 has not. */
static bool say_parts(importer *im, const package *p) {
    static const char *const words[PARTS] = {[COLORS] = "colours of triangles are left out",
                                             [TEXTURES] = "textures are left out",
                                             [MIXES] = "mixed materials are left out",
                                             [BEAMS] = "beam lattices are left out",
                                             [SLICES] = "slices are left out",
                                             [ELSEWHERE] = "parts in other files of the archive are left out",
                                             [SEVERAL] = "triangles of an object have several materials: it is shown in one"};
    for (int i = 0; i < PARTS; i++)
        if (p->has[i] && !import_not_done(im, "3MF: %s", words[i]))
            return false;
    return true;
}

bool assimp_unit_3mf(importer *im, double *unit, bool *stated) {
    package p = {.model = "3D/3dmodel.model"};
    unzFile archive = unzOpen(im->file);
    const bool there =
        archive && read_part(archive, "_rels/.rels", take_relation, &p) && read_part(archive, p.model, take_model, &p);
    if (archive)
        (void)unzClose(archive);
    if (!there)
        return import_fail(im, "is an archive without a model that can be read");
    ((assimp_scene *)im->reader)->plain_colors = true;
    return settle(im, p.unit, unit, stated) && say_parts(im, &p);
}
