/* report.c: makes the folder; each file is made in memory and put under its name whole. */
#include "report/report.h"
#include "common/fail.h"
#include "pack/pack_write.h"
#include "report/report_parts.h"

#include <errno.h>
#include <limits.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

static vit_status fail_folder(vit_text *why, const char *folder, int error) {
    return bake_fail(why, VIT_FAILED, "%.300s: cannot make this folder: %s", folder, strerror(error));
}

vit_status report_folder(const char *folder, vit_text *why) {
    char path[PATH_MAX];
    const size_t length = strlen(folder);
    if (length == 0 || length >= sizeof path)
        return fail_folder(why, folder, length ? ENAMETOOLONG : ENOENT);
    memcpy(path, folder, length + 1);
    for (size_t i = 1; i <= length; i++) {
        if (path[i] != '/' && path[i] != '\0')
            continue;
        path[i] = '\0';
        struct stat there;
        if (mkdir(path, 0777) != 0 && errno != EEXIST)
            return fail_folder(why, folder, errno);
        if (stat(path, &there) != 0 || !S_ISDIR(there.st_mode))
            return fail_folder(why, folder, ENOTDIR);
        path[i] = folder[i];
    }
    return VIT_OK;
}

static vit_status csv_part(const void *r, FILE *to, vit_text *why) {
    (void)why;
    report_csv(r, to);
    return VIT_OK;
}

static vit_status json_part(const void *r, FILE *to, vit_text *why) {
    (void)why;
    report_json(r, to);
    return VIT_OK;
}

static vit_status page_part(const void *r, FILE *to, vit_text *why) {
    return report_page(r, to, why);
}

vit_status report_file(const void *results, const char *folder, const char *name, report_part_fn *part, vit_text *why) {
    char path[PATH_MAX];
    const int length = snprintf(path, sizeof path, "%s/%s", folder, name);
    if (length < 0 || (size_t)length >= sizeof path)
        return fail_folder(why, folder, ENAMETOOLONG);
    char *bytes = NULL;
    size_t size = 0;
    FILE *to = open_memstream(&bytes, &size);
    vit_status status = to ? part(results, to, why) : VIT_FAILED;
    const bool whole = to && !ferror(to);
    if ((to && fclose(to) != 0) || !whole) {
        status = bake_fail(why, VIT_FAILED, "%s: out of memory", name);
    }
    if (status == VIT_OK)
        status = pack_save(path, bytes, size, why);
    free(bytes);
    return status;
}

static const struct {
    const char *name;
    report_part_fn *part;
} files[] = {{"report.csv", csv_part}, {"report.json", json_part}, {"index.html", page_part}};
enum { FILES = sizeof files / sizeof files[0] };

const char *report_name(uint32_t index) {
    return index < FILES ? files[index].name : NULL;
}

vit_status report_write(const cost_results *r, const char *folder, vit_text *why) {
    vit_status status = report_folder(folder, why);
    for (int i = 0; i < FILES && status == VIT_OK; i++)
        status = report_file(r, folder, files[i].name, files[i].part, why);
    return status;
}
