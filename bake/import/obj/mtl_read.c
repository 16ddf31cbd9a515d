/* Material files: which there are, and which names none of them has. */
#include "import/obj/obj_file.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* A file that is there; an empty one has no materials. */
static bool read_file(obj_file *o, const char path[SCENE_PATH]) {
    size_t room = o->library_count;
    import_bytes bytes;
    if (!import_room(o->im, &o->library, &room, o->library_count + 1, sizeof *o->library))
        return false;
    if (!import_map(o->im, path, &bytes))
        return true;
    o->library[o->library_count++] = bytes;
    return mtl_read_lines(o, &o->library[o->library_count - 1]);
}

/* Reads the file of that name, if there is one. */
static bool try_name(obj_file *o, obj_text name, bool *there) {
    char text[SCENE_PATH], path[SCENE_PATH];
    mtl_name_of(name, text);
    *there = text[0] && import_resolve(o->im, text, path);
    return !*there || read_file(o, path);
}

/* Exporters forget to name the file after its new name: FILE.mtl beside FILE.obj is meant. */
static bool try_own_name(obj_file *o, bool *there) {
    char own[SCENE_PATH];
    const char *slash = strrchr(o->im->file, '/'), *base = slash ? slash + 1 : o->im->file, *dot = strrchr(base, '.');
    (void)snprintf(own, sizeof own, "%.*s.mtl", dot ? (int)(dot - base) : (int)strlen(base), base);
    return try_name(o, (obj_text){own, own + strlen(own)}, there);
}

/* One that is not there, told of once. */
static bool lack(obj_file *o, obj_text name) {
    bool there = false;
    if (o->no_library)
        return true;
    o->no_library = true;
    if (!import_not_done(o->im, "its material file '%.*s' is not there", obj_size(name, 100), name.at))
        return false;
    return try_own_name(o, &there);
}

/* Names of a line are parted by blanks, and have some of their own: it is one name if there is such a file; else a name
 * ends with ".mtl"; else with any blank. */
static bool read_names(obj_file *o, obj_text line) {
    bool there;
    if (!try_name(o, line, &there))
        return false;
    if (there)
        return true;
    while (!obj_is_empty(line)) {
        obj_text ahead = line, name = {line.at, line.at}, word;
        do {
            word = obj_word(&ahead);
            if (!obj_is_empty(word))
                name.end = word.end;
        } while (!obj_is_empty(word) && !(word.end - word.at > 4 && obj_is((obj_text){word.end - 4, word.end}, ".mtl")));
        if (!try_name(o, name, &there))
            return false;
        if (!there) { /* no such name of several words */
            ahead = line;
            name = obj_word(&ahead);
            if (!try_name(o, name, &there) || (!there && !lack(o, name)))
                return false;
        }
        line = obj_rest(ahead);
    }
    return true;
}

/* The scene file has something to say of it. */
static bool is_in_scene(const importer *im, obj_text name) {
    char text[SCENE_NAME];
    (void)snprintf(text, sizeof text, "%.*s", obj_size(name, SCENE_NAME - 1), name.at);
    for (int i = 0; i < im->s->material_count; i++)
        if (!strcmp(im->s->materials[i].name, text))
            return true;
    return false;
}

static bool check_names(obj_file *o) {
    size_t unknown = 0, first = 0;
    if (o->no_library) /* that has been said */
        return true;
    for (size_t i = o->materials.count; i-- > 0;)
        if (!o->mtl[i].defined && !is_in_scene(o->im, o->materials.name[i])) {
            unknown++;
            first = i;
        }
    if (unknown == 0)
        return true;
    const obj_text name = o->materials.name[first];
    if (unknown == 1)
        return import_not_done(o->im, "material '%.*s' is in no material file: it is plain grey", obj_size(name, 100), name.at);
    return import_not_done(o->im, "material '%.*s' and %zu others are in no material file: they are plain grey",
                           obj_size(name, 100), name.at, unknown - 1);
}

bool mtl_read(obj_file *o) {
    o->mtl = calloc(o->materials.count + 1, sizeof *o->mtl);
    if (!o->mtl)
        return import_fail(o->im, "out of memory");
    if (o->materials.count >= INT32_MAX)
        return import_fail(o->im, "too many materials");
    for (size_t i = 0; i <= o->materials.count; i++)
        o->mtl[i] = mtl_default();
    for (size_t i = 0; i < o->libraries.count; i++)
        if (!read_names(o, o->libraries.name[i]))
            return false;
    return check_names(o);
}
