/* A file of the cases that went wrong, which are not part of the repository. */
#ifndef VIT_TESTS_CASE_FILE_H
#define VIT_TESTS_CASE_FILE_H

#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

/* Its path, until the next call; NULL: it is not here, and that was said. VITRINE_CASES: the folder. */
static inline const char *case_file(const char *name) {
    static char path[256];
    const char *folder = getenv("VITRINE_CASES");
    (void)snprintf(path, sizeof path, "%s/%s", folder ? folder : "../shared/cases", name);
    if (access(path, R_OK) == 0)
        return path;
    (void)printf("no %s: skipped\n", path);
    return NULL;
}

#endif
