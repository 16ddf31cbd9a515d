#include "common/effect_names.h"
#include <string.h>

static const char *const names[64] = {
#define X(bit, name, macro, when) [bit] = name,
    VIT_EFFECTS(X)
#undef X
};

const char *effects_name(int bit) {
    return names[bit];
}

uint64_t effects_named(const char *name) {
    for (int i = 0; i < 64; i++)
        if (names[i] && strcmp(names[i], name) == 0)
            return (uint64_t)1 << i;
    return strcmp(name, "gloss") == 0 ? VIT_BIT(SPECULAR) : 0; /* its former name */
}
