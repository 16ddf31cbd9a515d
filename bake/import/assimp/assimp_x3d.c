/* The text of X3D files, where Assimp misreads it or leaves something out without a word: units, lists of names of files,
 * shapes without an appearance, lines, and elements that it does not know. */
#include "import/assimp/assimp_scene.h"
#include "import/assimp/assimp_tags.h"
#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char appearance[] = "<Appearance/>";

/* What has been written of the text. There is room for an appearance behind each tag. */
typedef struct written {
    assimp_scene *a;
    char *text;
    size_t size;
} written;

static void write(written *w, const char *from, const char *to) {
    memcpy(w->text + w->size, from, (size_t)(to - from));
    w->size += (size_t)(to - from);
}

/* A unit of lengths in the head (X3D 3.3, 7.2.5.1). */
static void read_unit(assimp_scene *a, tag_span all) {
    tag_span tag, value;
    char *from;
    if (tag_find(all, "Scene", &tag))
        all.end = tag.at;
    while (tag_find(all, "unit", &tag)) {
        all.at = tag.end;
        if (!tag_value(tag, "category", &value) || value.end - value.at != 6 || memcmp(value.at, "length", 6) != 0)
            continue;
        a->bad_unit = !tag_value(tag, "conversionFactor", &value) || !tag_length(value, &from, &a->unit);
    }
}

/* ---- files ---- */

/* The next of the names in a value, which are in quotes, written out or not; a value without quotes is one name. */
static bool next_name(tag_span *rest, tag_span *name) {
    static const char *const quotes[] = {"\"", "&quot;", "'", "&apos;"};
    const char *quote = NULL;
    while (rest->at < rest->end && (tag_blank(*rest->at) || *rest->at == ','))
        rest->at++;
    for (size_t i = 0; !quote && i < sizeof quotes / sizeof *quotes; i++)
        quote = tag_begins(*rest, quotes[i]) ? quotes[i] : NULL;
    if (quote)
        rest->at += strlen(quote);
    *name = (tag_span){rest->at, rest->at};
    while (name->end < rest->end && !(quote && tag_begins((tag_span){name->end, rest->end}, quote)))
        name->end++;
    rest->at = name->end < rest->end ? name->end + strlen(quote) : rest->end;
    return name->end > name->at;
}

/* Names of one file in order of preference (X3D 3.3, 9.2.1): the first that is there, or the first of all. Assimp takes them
 * for one name. */
static void write_names(written *w, tag_span tag) {
    tag_span value, first, name;
    if (!tag_value(tag, "url", &value) || value.at == value.end) {
        write(w, tag.at, tag.end);
        return;
    }
    tag_span rest = value;
    first = (tag_span){value.at, value.at};
    for (bool found = false; !found && next_name(&rest, &name);) {
        char text[SCENE_PATH], path[SCENE_PATH];
        (void)snprintf(text, sizeof text, "%.*s", name.end - name.at < SCENE_PATH ? (int)(name.end - name.at) : 0, name.at);
        found = text[0] && import_resolve(w->a->im, text, path);
        first = found || first.at == first.end ? name : first;
    }
    write(w, tag.at, value.at);
    write(w, first.at, first.end);
    write(w, value.end, tag.end);
}

/* ---- elements ---- */

static bool is_one_of(const char *name, const char *const *list) {
    while (*list && strcmp(name, *list) != 0)
        list++;
    return *list != NULL;
}

/* These Assimp reads, or they change no picture; animations are said to be left out of all files. */
static bool is_known(const char *name) {
    static const char *const known[] = {"X3D",
                                        "head",
                                        "component",
                                        "unit",
                                        "meta",
                                        "Scene",
                                        "WorldInfo",
                                        "NavigationInfo",
                                        "ROUTE",
                                        "Group",
                                        "StaticGroup",
                                        "Transform",
                                        "Switch",
                                        "Inline",
                                        "Shape",
                                        "Appearance",
                                        "Material",
                                        "ImageTexture",
                                        "TextureTransform",
                                        "TextureCoordinate",
                                        "Coordinate",
                                        "Color",
                                        "ColorRGBA",
                                        "Normal",
                                        "Box",
                                        "Cone",
                                        "Cylinder",
                                        "Sphere",
                                        "Extrusion",
                                        "ElevationGrid",
                                        "IndexedFaceSet",
                                        "IndexedTriangleSet",
                                        "IndexedTriangleFanSet",
                                        "IndexedTriangleStripSet",
                                        "TriangleSet",
                                        "TriangleFanSet",
                                        "Rectangle2D",
                                        "Disk2D",
                                        "ArcClose2D",
                                        "TriangleSet2D",
                                        "DirectionalLight",
                                        "PointLight",
                                        "SpotLight",
                                        NULL};
    return is_one_of(name, known) || strncmp(name, "Metadata", 8) == 0 || strstr(name, "Interpolator") ||
           strstr(name, "Sensor");
}

/* As tag_find() ends it; "" of a tag that ends an element. */
static void name_of(tag_span tag, char out[32]) {
    size_t length = 0;
    for (const char *c = tag.at + 1; c < tag.end && length < 31 && !tag_blank(*c) && *c != '/'; c++)
        out[length++] = isalnum((unsigned char)*c) || strchr("_-.:", *c) ? *c : '?';
    out[length] = '\0';
}

/* What is written of the tag, which ends before its ">"; where to go on. */
static char *write_tag(written *w, tag_span tag, char *end) {
    /* Assimp has some of them as surfaces. */
    static const char *const wires[] = {"IndexedLineSet", "LineSet",    "PointSet",    "Arc2D",
                                        "Circle2D",       "Polyline2D", "Polypoint2D", NULL};
    char name[32];
    tag_span inside;
    name_of(tag, name);
    if (name[0] && !is_known(name))
        assimp_note_lost(w->a, name);
    if (is_one_of(name, wires))
        return tag_behind(tag, name, end);
    if (strcmp(name, "ImageTexture") != 0 && strcmp(name, "Inline") != 0)
        write(w, tag.at, tag.end);
    else
        write_names(w, tag);
    if (strcmp(name, "Shape") != 0 || tag.end[-1] == '/' || tag.end == end)
        return tag.end;
    /* A shape without one has the file's first material. */
    write(w, tag.end, tag.end + 1);
    if (!tag_find((tag_span){tag.end, tag_behind(tag, name, end)}, "Appearance", &inside))
        write(w, appearance, appearance + sizeof appearance - 1);
    return tag.end + 1;
}

char *assimp_mend_x3d(assimp_scene *a, char *text, size_t *size) {
    size_t shapes = 0;
    tag_span rest = {text, text + *size}, tag;
    read_unit(a, rest);
    /* In comments too: what is one depends on where the search began. */
    for (tag_span s = rest; s.at < s.end; s.at++)
        shapes += tag_begins(s, "<Shape");
    written w = {.a = a, .text = malloc(*size + shapes * sizeof appearance + 1)};
    if (!w.text)
        return text;
    while (tag_find(rest, NULL, &tag)) {
        write(&w, rest.at, tag.at);
        rest.at = write_tag(&w, tag, rest.end);
    }
    write(&w, rest.at, rest.end);
    free(text);
    *size = w.size;
    return w.text;
}
