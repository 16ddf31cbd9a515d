/* A mesh file of the cases that went wrong, imported. */
#ifndef VIT_TESTS_CASE_MODEL_H
#define VIT_TESTS_CASE_MODEL_H

#include "case_file.h"
#include "import_lab.h"

/* Its path. Skips the test if the case is not there. */
static inline const char *import_case(const char *name, model *m) {
    const char *path = case_file(name);
    if (!path)
        skip();
    import_good(path, m);
    check_promises(m);
    return path;
}

#endif
