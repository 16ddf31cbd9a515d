#include "outputs.h"
#include "failure.h"
#include "sinks/output.h"
#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#define PARTIAL ".part" /* as sinks/output.c names what it renames */

/* A file that is there, or the place where it would be. */
typedef struct place {
    bool there;
    dev_t device; /* of the file; else of its folder */
    ino_t inode;
    char name[256]; /* last part of the path, if it is not there */
} place;

typedef struct named_file {
    const char *option, *path;
} named_file;

enum { MOST = 5 };

static bool find_place(const char *path, place *out) {
    struct stat s;
    char folder[OUTPUT_PATH_SIZE], target[OUTPUT_PATH_SIZE];
    *out = (place){.there = stat(path, &s) == 0};
    if (!out->there) {
        output_follow(path, target);
        const char *slash = strrchr(target, '/');
        (void)snprintf(folder, sizeof folder, "%.*s", slash != NULL ? (int)(slash - target) + 1 : 1,
                       slash != NULL ? target : ".");
        (void)snprintf(out->name, sizeof out->name, "%.255s", slash != NULL ? slash + 1 : target);
        if (stat(folder, &s) != 0)
            return false;
    }
    out->device = s.st_dev;
    out->inode = s.st_ino;
    return true;
}

static bool same_file(const char *a, const char *b) {
    place at, bt;
    return find_place(a, &at) && find_place(b, &bt) && at.there == bt.there && at.device == bt.device && at.inode == bt.inode &&
           strcmp(at.name, bt.name) == 0;
}

/* What is read; returns how many. */
static size_t list_inputs(const play_options *o, named_file list[MOST]) {
    size_t count = 0;
    list[count++] = (named_file){"", o->pack};
    if (o->work_budget != NULL)
        list[count++] = (named_file){"--work-budget", o->work_budget};
    if (o->golden != NULL)
        list[count++] = (named_file){"--golden", o->golden};
    return count;
}

/* Files, not folders of frames, that are written; returns how many. The sink's comes first, if it has one. */
static size_t list_outputs(const play_options *o, named_file list[MOST]) {
    size_t count = 0;
    if ((o->sink->writes == SINK_STREAM && !sink_uses_stdout(o->sink, o->target)) || o->sink->writes == SINK_FILE)
        list[count++] = (named_file){"--out", o->target};
    if (o->report_file != NULL)
        list[count++] = (named_file){"--report", o->report_file};
    if (o->write_work_budget != NULL)
        list[count++] = (named_file){"--write-work-budget", o->write_work_budget};
    if (o->write_golden != NULL)
        list[count++] = (named_file){"--write-golden", o->write_golden};
    return count;
}

/* `path` against all that is read and all other outputs. */
static vit_status check_apart(const play_options *o, const char *option, const char *path, vit_text *why) {
    named_file in[MOST], out[MOST];
    const size_t ins = list_inputs(o, in), outs = list_outputs(o, out);
    for (size_t i = 0; i < ins; i++)
        if (same_file(path, in[i].path))
            return play_fail(why, VIT_USAGE, "%s %.200s would overwrite %s %.200s, which is read", option, path,
                             in[i].option[0] != '\0' ? in[i].option : "the pack", in[i].path);
    for (size_t i = 0; i < outs; i++)
        if (strcmp(out[i].option, option) != 0 && same_file(path, out[i].path))
            return play_fail(why, VIT_USAGE, "%s and %s would write the same file: %.200s", option, out[i].option, path);
    return VIT_OK;
}

static vit_status cannot(const char *path, int error, vit_text *why) {
    return play_fail(why, VIT_FAILED, "%.300s: cannot be written: %s", path, strerror(error));
}

/* Makes `path`, writes a page and removes it again. */
static vit_status try_new(const char *path, const char *asked, vit_text *why) {
    static const char page[4096];
    const int fd = open(path, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (fd < 0 && errno == EEXIST) /* a killed run has left it */
        return access(path, W_OK) == 0 ? VIT_OK : cannot(path, errno, why);
    if (fd < 0)
        return cannot(asked, errno, why);
    const bool wrote = write(fd, page, sizeof page) == (ssize_t)sizeof page;
    const int error = errno;
    (void)unlink(path);
    return close(fd) == 0 && wrote ? VIT_OK : cannot(asked, wrote ? errno : error, why);
}

/* `in_place`: the file is emptied and written; else it is replaced by one of its folder. */
static vit_status try_file(const char *path, bool in_place, vit_text *why) {
    struct stat s;
    char target[OUTPUT_PATH_SIZE], partial[OUTPUT_PATH_SIZE + sizeof PARTIAL];
    const bool there = stat(path, &s) == 0, plain = there && S_ISREG(s.st_mode);
    if (!there && errno != ENOENT) /* links in a circle, too */
        return cannot(path, errno, why);
    if (there && S_ISDIR(s.st_mode))
        return play_fail(why, VIT_FAILED, "%.300s: is a folder", path);
    if (there && access(path, W_OK) != 0)
        return cannot(path, errno, why);
    if (plain && (s.st_mode & (S_IWUSR | S_IWGRP | S_IWOTH)) == 0) /* root may, but is not meant to */
        return play_fail(why, VIT_FAILED, "%.300s: is read-only", path);
    if (!output_replaces(path, target) || (there && in_place))
        return VIT_OK;
    (void)snprintf(partial, sizeof partial, "%s%s", target, in_place ? "" : PARTIAL);
    return try_new(partial, path, why);
}

/* The folder, or the nearest one above it that is there. */
static vit_status try_folder(const char *path, vit_text *why) {
    char probe[OUTPUT_PATH_SIZE + 32];
    struct stat s;
    size_t length = strlen(path);
    if (length >= OUTPUT_PATH_SIZE)
        return cannot(path, ENAMETOOLONG, why);
    (void)snprintf(probe, sizeof probe, "%s", path);
    while (stat(probe[0] != '\0' ? probe : ".", &s) != 0) {
        if (errno != ENOENT)
            return cannot(path, errno, why);
        while (length > 0 && probe[length - 1] == '/')
            length--;
        while (length > 0 && probe[length - 1] != '/')
            length--;
        probe[length] = '\0';
    }
    if (!S_ISDIR(s.st_mode))
        return play_fail(why, VIT_FAILED, "%.300s: is there and is not a folder", probe);
    (void)snprintf(probe + length, sizeof probe - length, "%svitrine-%ld" PARTIAL,
                   length > 0 && probe[length - 1] != '/' ? "/" : "", (long)getpid());
    return try_new(probe, path, why);
}

/* Whoever replaces a file writes a partial one beside it. */
static vit_status check_replaced(const play_options *o, const char *option, const char *path, vit_text *why) {
    char target[OUTPUT_PATH_SIZE], partial[OUTPUT_PATH_SIZE + sizeof PARTIAL];
    output_follow(path, target);
    (void)snprintf(partial, sizeof partial, "%s" PARTIAL, target);
    vit_status status = check_apart(o, option, path, why);
    return status == VIT_OK ? check_apart(o, option, partial, why) : status;
}

/* Nobody has named the file of a frame: what a link there points to is left alone, and what is no file cannot be replaced. */
static vit_status check_plain(const char *path, vit_text *why) {
    struct stat s;
    if (lstat(path, &s) != 0 || S_ISREG(s.st_mode))
        return VIT_OK;
    return play_fail(why, VIT_USAGE, "--out %.300s: is there and is %s: remove it, or give another folder", path,
                     S_ISLNK(s.st_mode) ? "a link" : "not a file");
}

/* Each frame's own file; sinks into folders are named as their files end. */
static vit_status check_frame_files(const player *p, vit_text *why) {
    const play_options *o = p->options;
    char path[OUTPUT_PATH_SIZE];
    vit_status status = try_folder(o->target, why);
    for (uint32_t i = p->first; i < p->end && status == VIT_OK; i++) {
        (void)snprintf(path, sizeof path, "%s/frame_%05u.%s", o->target, i, o->sink->name);
        status = check_replaced(o, "--out", path, why);
        if (status == VIT_OK)
            status = check_plain(path, why);
    }
    return status;
}

vit_status outputs_check(const player *p, vit_text *why) {
    const play_options *o = p->options;
    named_file out[MOST];
    const size_t count = list_outputs(o, out);
    vit_status status = VIT_OK;
    for (size_t i = 0; i < count && status == VIT_OK; i++) {
        const bool in_place = strcmp(out[i].option, "--out") == 0;
        status = in_place ? check_apart(o, "--out", out[i].path, why) : check_replaced(o, out[i].option, out[i].path, why);
        if (status == VIT_OK)
            status = try_file(out[i].path, in_place, why);
    }
    if (status == VIT_OK && o->out_given && o->sink->writes == SINK_FOLDER)
        status = check_frame_files(p, why);
    return status;
}
