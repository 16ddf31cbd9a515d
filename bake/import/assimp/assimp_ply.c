#include "import/assimp/assimp_scene.h"
#include <stdio.h>
#include <string.h>

enum { MAX_LINES = 4096 };

static bool known_line(const char *line) {
    static const char *const words[] = {"format", "element", "property", "comment", "obj_info"};
    line += strspn(line, " \t");
    const size_t length = strcspn(line, " \t\r\n");
    for (size_t i = 0; i < sizeof words / sizeof *words; i++)
        if (length == strlen(words[i]) && !strncmp(line, words[i], length))
            return true;
    return length == 0;
}

static bool check_header(importer *im, FILE *file) {
    char line[4096];
    for (int number = 2; number < MAX_LINES && fgets(line, sizeof line, file); number++) {
        const char *word = line + strspn(line, " \t");
        if (!strncmp(word, "end_header", 10) && strchr(" \t\r\n", word[10])) /* the terminating 0 is among them */
            return true;
        if (!known_line(line))
            return import_fail(im, "line %d: not a PLY header", number);
    }
    return import_fail(im, "the PLY header has no end");
}

bool assimp_check_ply(importer *im) {
    char magic[8] = {0};
    FILE *file = fopen(im->file, "rb");
    if (!file)
        return import_fail(im, "cannot be read");
    bool fine = true;
    if (fgets(magic, sizeof magic, file) && (!strcmp(magic, "ply\n") || !strcmp(magic, "ply\r\n")))
        fine = check_header(im, file);
    else if (import_has_suffix(im->file, ".ply"))
        fine = import_fail(im, "is no PLY file");
    (void)fclose(file);
    return fine;
}
