/* mesh.c: a growing triangle mesh and its OBJ and MTL files. */
#ifndef VIT_SCENES_MESH_H
#define VIT_SCENES_MESH_H

#include "vector.h"
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* u, v as in OBJ: v = 0 is the image's last row. */
typedef struct vertex {
    v3 p, n;
    double u, v;
} vertex;

typedef struct mesh_material {
    const char *name;
    double color[3];     /* linear reflectance, multiplies the texture */
    const char *texture; /* file name, NULL if none */
} mesh_material;

/* Faces of one object with one material. */
typedef struct mesh_group {
    const char *object, *material;
    size_t first; /* triangle */
} mesh_group;

/* Where the next vertices go: p -> o + p.x * x + p.y * y + p.z * z, axes orthonormal. */
typedef struct mesh_frame {
    v3 o, x, y, z;
} mesh_frame;

typedef struct mesh {
    vertex *vertices;
    uint32_t *indices; /* 3 a triangle */
    mesh_group *groups;
    size_t vertex_count, vertex_room, triangle_count, triangle_room, group_count, group_room;
    mesh_frame frame;
    bool full; /* memory ran out: nothing more is added, mesh_write fails */
} mesh;

void mesh_init(mesh *m);
void mesh_free(mesh *m);

/* Turned about the upright axis by `quarters` quarter turns (x -> -z first), then moved to `o`. */
mesh_frame mesh_frame_at(v3 o, int quarters);

/* What follows belongs to `object` and has `material`; both names must outlive the mesh. */
void mesh_group_begin(mesh *m, const char *object, const char *material);

/* Positions are rounded to 1e-5 m here, so that equal positions are written equal. Returns the vertex's index. */
uint32_t mesh_vertex(mesh *m, vertex v);

/* The winding follows the vertices' normals, whatever the order given. A triangle without area is left out. */
void mesh_triangle(mesh *m, uint32_t a, uint32_t b, uint32_t c);

/* Writes DIR/NAME.obj, which names NAME.mtl, and DIR/NAME.mtl. False: errno says why. */
bool mesh_write(const mesh *m, const char *dir, const char *name, const mesh_material *materials, size_t material_count);

#endif
