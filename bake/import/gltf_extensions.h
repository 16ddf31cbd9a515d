/* gltf_extensions.c: the extensions that a glTF file says it uses. */
#ifndef VIT_BAKE_GLTF_EXTENSIONS_H
#define VIT_BAKE_GLTF_EXTENSIONS_H

#include <stdbool.h>

typedef struct gltf_extension {
    char name[64];
    bool required; /* the file is not what it means without it */
    bool read;     /* what of it a vitrine can show is shown */
} gltf_extension;

enum { GLTF_EXTENSIONS = 64 };

/* Of a .gltf or .glb file, each once; returns how many, 0 for any other file. */
int gltf_extensions(const char *path, gltf_extension list[GLTF_EXTENSIONS]);

#endif
