/* gltf_draco_decode.cc: libdraco, which is C++, for gltf_draco.c. */
#ifndef VIT_BAKE_GLTF_DRACO_DECODE_H
#define VIT_BAKE_GLTF_DRACO_DECODE_H

#include <stddef.h>
#include <stdint.h>
#ifdef __cplusplus
extern "C" {
#else
#include <stdbool.h>
#endif

typedef struct draco_block draco_block;

/* A mesh of triangles. NULL: it cannot be read. */
draco_block *draco_open(const uint8_t *bytes, size_t size);
void draco_close(draco_block *block);
uint32_t draco_points(const draco_block *block);
uint32_t draco_faces(const draco_block *block);
void draco_corners(const draco_block *block, uint32_t *out); /* 3 a face */
/* Of the attribute with this unique id: components of a value (0: there is none), and values of all points, integers as they
 * stand. */
unsigned draco_components(const draco_block *block, uint32_t id);
bool draco_values(const draco_block *block, uint32_t id, double *out);

#ifdef __cplusplus
}
#endif
#endif
