/* What tests of both tools share: a folder in which a tool may leave nothing that it was not asked for. A program defines
 * FOLDER before it includes this. */
#ifndef VIT_TESTS_TOOLS_LAB_H
#define VIT_TESTS_TOOLS_LAB_H

#include "test_packs.h"
#include "vitrine.h"
#include <dirent.h>

static tool_run r;

/* Removes what is in the folder and returns how many files that were; folders in it are left alone. */
static inline int empty(const char *folder) {
    int count = 0;
    DIR *d = opendir(folder);
    for (struct dirent *e; d && (e = readdir(d)) != NULL;) {
        char path[512];
        (void)snprintf(path, sizeof path, "%s/%s", folder, e->d_name);
        count += unlink(path) == 0;
    }
    if (d)
        (void)closedir(d);
    return count;
}

static inline int set_up(void **state) {
    (void)state;
    test_packs_begin();
    folder_make(FOLDER);
    (void)empty(FOLDER);
    return 0;
}

static inline int tear_down(void **state) {
    (void)state;
    static const char *const folders[] = {FOLDER "/png", FOLDER "/ppm", FOLDER};
    for (size_t i = 0; i < sizeof folders / sizeof folders[0]; i++) {
        (void)empty(folders[i]);
        (void)rmdir(folders[i]);
    }
    return 0;
}

#endif
