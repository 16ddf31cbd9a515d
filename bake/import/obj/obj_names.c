/* Names by number, kept beyond the file that they come from, found by their hash: files have thousands of materials. */
#include "import/obj/obj_file.h"
#include <stdlib.h>
#include <string.h>

/* FNV-1a. */
static uint64_t hash_of(obj_text name) {
    uint64_t hash = UINT64_C(14695981039346656037);
    for (const char *c = name.at; c < name.end; c++)
        hash = (hash ^ (uint8_t)*c) * UINT64_C(1099511628211);
    return hash ^ hash >> 32;
}

static bool same(obj_text a, obj_text b) {
    const size_t size = (size_t)(a.end - a.at);
    return size == (size_t)(b.end - b.at) && memcmp(a.at, b.at, size) == 0;
}

/* Where the name is, or would be. */
static uint32_t *slot_of(const obj_names *names, obj_text name) {
    size_t at = (size_t)hash_of(name) % names->slot_count;
    while (names->slot[at] != OBJ_NONE && !same(names->name[names->slot[at]], name))
        at = (at + 1) % names->slot_count;
    return &names->slot[at];
}

static bool grow(importer *im, obj_names *names) {
    obj_names grown = *names;
    grown.slot_count = names->slot_count ? 4 * names->slot_count : 64;
    grown.slot = malloc(grown.slot_count * sizeof *grown.slot);
    if (!grown.slot)
        return import_fail(im, "out of memory");
    memset(grown.slot, 0xff, grown.slot_count * sizeof *grown.slot); /* OBJ_NONE */
    for (uint32_t i = 0; i < grown.count; i++)
        *slot_of(&grown, grown.name[i]) = i;
    free(names->slot);
    names->slot = grown.slot;
    names->slot_count = grown.slot_count;
    return true;
}

uint32_t obj_find_name(const obj_names *names, obj_text name) {
    return names->slot_count ? *slot_of(names, name) : OBJ_NONE;
}

uint32_t obj_name(importer *im, obj_names *names, obj_text name) {
    if (2 * names->count >= names->slot_count && !grow(im, names))
        return OBJ_NONE;
    uint32_t *slot = slot_of(names, name);
    if (*slot == OBJ_NONE) {
        if (!import_room(im, &names->name, &names->room, names->count + 1, sizeof *names->name))
            return OBJ_NONE;
        const size_t size = (size_t)(name.end - name.at);
        char *copy = malloc(size + 1);
        if (!copy) {
            (void)import_fail(im, "out of memory");
            return OBJ_NONE;
        }
        memcpy(copy, name.at, size);
        names->name[names->count].at = copy;
        names->name[names->count].end = copy + size;
        *slot = (uint32_t)names->count++;
    }
    return *slot;
}

void obj_free_names(obj_names *names) {
    for (size_t i = 0; i < names->count; i++)
        free((void *)(uintptr_t)names->name[i].at);
    free(names->name);
    free(names->slot);
    *names = (obj_names){0};
}
