/* make-scenes SOURCE FOLDER: makes the demo scenes' meshes and textures in FOLDER and copies SOURCE's scene files beside them.
 */
#include "scenes.h"

#include <dirent.h>
#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static const struct {
    const char *name;
    scene_maker *make;
} makers[] = {
    {"cornell", cornell_make}, {"furnace", furnace_make}, {"atrium", atrium_make}, {"balls", balls_make}, {"rooms", rooms_make},
};

static const char usage[] =
    "usage: make-scenes SOURCE FOLDER\n"
    "Makes the meshes and textures of the demo scenes in FOLDER (made if missing; parents must exist) and\n"
    "copies their scene files, SOURCE/*.cfg, beside them. SOURCE is bake/scenes in Vitrine's own sources.\n"
    "Exit code: 0 done, 1 a file could not be read or written, 2 wrong usage, or FOLDER holds files of SOURCE.\n";

bool scenes_path(char out[SCENES_PATH], const char *dir, const char *name, const char *extension) {
    int length = snprintf(out, SCENES_PATH, "%s/%s%s", dir, name, extension);
    if (length >= 0 && length < SCENES_PATH)
        return true;
    errno = ENAMETOOLONG;
    return false;
}

static bool fail(const char *what, const char *path, const char *file) {
    fprintf(stderr, "make-scenes: cannot %s %s/%s: %s\n", what, path, file, strerror(errno));
    return false;
}

static bool copy(FILE *in, FILE *out) {
    char block[4096];
    for (size_t got; (got = fread(block, 1, sizeof block, in)) > 0;)
        if (fwrite(block, 1, got, out) != got)
            return false;
    return !ferror(in);
}

static bool copy_cfg(const char *source, const char *dir, const char *name) {
    char from[SCENES_PATH], to[SCENES_PATH];
    char file[64];
    snprintf(file, sizeof file, "%s.cfg", name);
    FILE *in = scenes_path(from, source, file, "") ? fopen(from, "rb") : NULL;
    if (!in)
        return fail("read", source, file);
    FILE *out = scenes_path(to, dir, file, "") ? fopen(to, "wb") : NULL;
    bool good = out && copy(in, out);
    if (out && fclose(out) != 0)
        good = false;
    if (!good)
        fail("write", dir, file);
    fclose(in);
    return good;
}

/* Whether the file is one of the scene files that are read. */
static bool is_source(const struct stat *file, const char *source) {
    char path[SCENES_PATH];
    struct stat s;
    for (size_t i = 0; i < sizeof makers / sizeof makers[0]; i++)
        if (scenes_path(path, source, makers[i].name, ".cfg") && stat(path, &s) == 0 && s.st_dev == file->st_dev &&
            s.st_ino == file->st_ino)
            return true;
    return false;
}

/* Nothing in the folder may lead to what is read: files are written in place. */
static bool check_apart(const char *source, const char *folder) {
    char path[SCENES_PATH];
    struct stat s;
    bool apart = true;
    DIR *d = opendir(folder);
    for (struct dirent *e = d ? readdir(d) : NULL; e && apart; e = readdir(d))
        if (scenes_path(path, folder, e->d_name, "") && stat(path, &s) == 0 && is_source(&s, source)) {
            fprintf(stderr, "make-scenes: %s is a scene file of %s, which is read: name another folder\n", path, source);
            apart = false;
        }
    if (d)
        closedir(d);
    return apart;
}

int main(int argc, char **argv) {
    if (argc == 2 && strcmp(argv[1], "--help") == 0) {
        fputs(usage, stdout);
        return 0;
    }
    if (argc != 3 || argv[1][0] == '-' || argv[2][0] == '-') {
        fputs(usage, stderr);
        return 2;
    }
    const char *source = argv[1], *dir = argv[2];
    if (mkdir(dir, 0777) != 0 && errno != EEXIST) {
        fprintf(stderr, "make-scenes: cannot make folder %s: %s\n", dir, strerror(errno));
        return 1;
    }
    if (!check_apart(source, dir))
        return 2;
    if (access(dir, W_OK | X_OK) != 0) {
        fprintf(stderr, "make-scenes: cannot write into folder %s: %s\n", dir, strerror(errno));
        return 1;
    }
    for (size_t i = 0; i < sizeof makers / sizeof makers[0]; i++) {
        scenes_report report = {.file = makers[i].name};
        if (!makers[i].make(dir, &report)) {
            fail("write", dir, report.file);
            return 1;
        }
        if (!copy_cfg(source, dir, makers[i].name))
            return 1;
        printf("%s: %zu triangles\n", makers[i].name, report.triangles);
    }
    return 0;
}
