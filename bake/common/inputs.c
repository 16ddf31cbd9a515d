#include "common/inputs.h"
#include "common/fail.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

struct input_file {
    dev_t device;
    ino_t inode;
    char *path;
};

static const struct input_file *find(const inputs *in, const struct stat *s) {
    for (size_t i = 0; i < in->count; i++)
        if (in->files[i].device == s->st_dev && in->files[i].inode == s->st_ino)
            return &in->files[i];
    return NULL;
}

static bool make_room(inputs *in) {
    if (in->count < in->room)
        return true;
    const size_t room = in->room ? 2 * in->room : 16;
    struct input_file *grown = realloc(in->files, room * sizeof *grown);
    if (!grown)
        return false;
    in->files = grown;
    in->room = room;
    return true;
}

void inputs_add(inputs *in, const char *path) {
    struct stat s;
    if (stat(path, &s) != 0 || find(in, &s))
        return;
    in->lost = in->lost || !make_room(in);
    if (in->lost)
        return;
    struct input_file *to = &in->files[in->count];
    *to = (struct input_file){.device = s.st_dev, .inode = s.st_ino};
    to->path = strdup(path);
    if (to->path)
        in->count++;
    else
        in->lost = true;
}

void inputs_free(inputs *in) {
    for (size_t i = 0; i < in->count; i++)
        free(in->files[i].path);
    free(in->files);
    *in = (inputs){0};
}

const char *inputs_path(const inputs *in, size_t index) {
    return in->files[index].path;
}

bool inputs_hold(const inputs *in, const char *path) {
    struct stat s;
    return stat(path, &s) == 0 && find(in, &s);
}

vit_status inputs_check_output(const inputs *in, const char *option, const char *path, vit_text *why) {
    struct stat s;
    if (in->lost) {
        return bake_fail(why, VIT_FAILED, "out of memory");
    }
    const struct input_file *same = stat(path, &s) == 0 ? find(in, &s) : NULL;
    if (!same)
        return VIT_OK;
    if (strcmp(path, same->path) == 0)
        return bake_fail_plain(why, VIT_USAGE, "%s %.300s: is read, so it is not written to", option, path);
    return bake_fail_plain(why, VIT_USAGE, "%s %.200s: is the same file as %.200s, which is read, so it is not written to",
                           option, path, same->path);
}
