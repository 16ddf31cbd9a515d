/* Parts that the colonnades repeat. All stand in the mesh's frame of the moment. */
#ifndef VIT_SCENES_ATRIUM_PARTS_H
#define VIT_SCENES_ATRIUM_PARTS_H

#include "atrium.h"

/* atrium_columns.c. A column is 4.2 * scale high, plinth to abacus, and `wide` times as thick as its height asks for. */
void atrium_column(mesh *m, v3 foot, double scale, double wide, int segments);
void atrium_balustrade(mesh *m, double x0, double x1, double y, double z);
void atrium_pedestal(mesh *m, v3 foot, double half, double height);

/* A piece of wall with a round arch: x0..x1, from the springing at y0 up to y1, z0..z1 thick. */
typedef struct arch {
    double x0, x1, y0, y1, z0, z1;
    double middle, radius; /* of the arch */
    double uv;             /* metres a repeat of the wall's texture */
    int segments;
} arch;

/* atrium_arches.c. Both faces and the arch's inside; `wall` and `trim` are materials. */
void atrium_arch(mesh *m, const arch *a, const char *wall);
/* Moulding and keystone round the arch on its z1 face. */
void atrium_archivolt(mesh *m, const arch *a, const char *trim);

#endif
