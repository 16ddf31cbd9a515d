/* list.c: what mesh files hold, for people and for programs. */
#ifndef VIT_BAKE_LIST_H
#define VIT_BAKE_LIST_H

#include "import/model.h"
#include <stdio.h>

/* Imports the meshes of `s` and prints meshes, materials, textures, lights, cameras, extensions, and what is not done of what
 * the files ask for. Bad input as model_import() has it. */
vit_status list_print(const scene *s, bool strict, bool json, FILE *to, vit_text *why);

#endif
