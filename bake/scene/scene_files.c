#include "scene/scene_files.h"
#include "common/fail.h"
#include "common/file_trouble.h"
#include "scene/scene_text.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* Bytes a file; libconfig's own depth of includes; all of a scene. */
enum { MAX_FILE = 16 << 20, MAX_DEPTH = 10, MAX_INCLUDES = 256 };

/* Name between the quotes of an @include line; empty if libconfig would read another one than stands there: with zero bytes,
 * escapes or line feeds in it. False if the line is no @include. */
static bool include_name(const char *line, size_t length, char *name, size_t room) {
    const char *end = line + length;
    line += strspn(line, " \t");
    if (strncmp(line, "@include", 8) != 0)
        return false;
    line += 8;
    line += strspn(line, " \t");
    if (*line != '"')
        return false;
    const size_t used = strcspn(++line, "\"\\");
    const bool plain = line + used < end && line[used] == '"' && used < room;
    (void)snprintf(name, room, "%.*s", plain ? (int)used : 0, line);
    return true;
}

/* The files of a scene. */
typedef struct sources {
    inputs *files;
    char *missing; /* name of an include that is not there */
    int left;      /* includes that may follow: files that include the next one twice each make 2^depth of them */
} sources;

static bool check_file(const config_place *at, const char *path, int depth, sources *all);

/* libconfig hands includes to a scanner that ends the whole process on a folder or a device: look first. */
static bool check_includes(const config_place *at, const char *path, FILE *file, int depth, sources *all) {
    char *line = NULL;
    size_t size = 0;
    bool fine = true;
    ssize_t length;
    for (unsigned number = 1; fine && (length = getline(&line, &size, file)) >= 0; number++) {
        char name[SCENE_PATH], full[2 * SCENE_PATH];
        const size_t mark = number == 1 && strncmp(line, SCENE_BOM, 3) == 0 ? 3 : 0;
        if (!include_name(line + mark, (size_t)length - mark, name, sizeof name))
            continue;
        const int used = snprintf(full, sizeof full, "%s%s", at->folder, name);
        const bool below = name[0] && name[0] != '/' && used > 0 && used < SCENE_PATH;
        if (!below || depth >= MAX_DEPTH || all->left == 0) {
            (void)bake_fail(at->why, VIT_BAD_INPUT, "%.300s:%u: %s", path, number,
                            !below               ? "@include takes a path below the scene's folder"
                            : depth >= MAX_DEPTH ? "@include goes deeper than 10 files"
                                                 : "more than 256 files are included");
            fine = false;
        } else if (access(full, F_OK) == 0) { /* a missing one is libconfig's to report, unless a comment holds it */
            --all->left;
            fine = check_file(at, full, depth + 1, all);
        } else if (!all->missing[0])
            (void)snprintf(all->missing, SCENE_PATH, "%s", name);
    }
    free(line);
    return fine;
}

/* The file's text against what libconfig would misread. */
static bool check_text(const config_place *at, const char *path, FILE *file, size_t size, int depth) {
    char *text = malloc(size + 1);
    if (!text)
        return fields_fail(at, NULL, "out of memory");
    size = fread(text, 1, size, file);
    text[size] = '\0';
    const bool mark = size >= 3 && memcmp(text, SCENE_BOM, 3) == 0;
    const bool fine =
        mark && depth > 0
            ? fields_fail(at, NULL,
                          "begins with a byte order mark, which an included file must not: save it as UTF-8 without one")
            : scene_text_check(at, path, text, size);
    free(text);
    rewind(file);
    return fine;
}

static bool check_file(const config_place *at, const char *path, int depth, sources *all) {
    struct stat st;
    config_place here = *at;
    here.path = path;
    const char *trouble = file_trouble(path);
    if (trouble)
        return fields_fail(&here, NULL, "%s", trouble);
    FILE *file = fopen(path, "rb");
    if (!file || fstat(fileno(file), &st) != 0) {
        if (file)
            (void)fclose(file);
        return fields_fail(&here, NULL, "cannot be read");
    }
    inputs_add(all->files, path);
    bool fine = st.st_size <= MAX_FILE || fields_fail(&here, NULL, "is larger than %d MiB", MAX_FILE >> 20);
    fine = fine && check_text(&here, path, file, (size_t)st.st_size, depth) && check_includes(at, path, file, depth, all);
    (void)fclose(file);
    return fine;
}

bool scene_files_check(const config_place *at, inputs *files, char missing[SCENE_PATH]) {
    sources all = {files, missing, MAX_INCLUDES};
    missing[0] = '\0';
    return check_file(at, at->path, 0, &all);
}
