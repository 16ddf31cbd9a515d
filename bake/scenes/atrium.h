/* The atrium: a sunk court of 7 x 3 bays, colonnades around it on two storeys, vaulted aisles behind the lower one.
 *
 *    z = -8.0  outer wall          plan, one corner; the court's middle is the origin, x runs along it
 *              aisle
 *    z = -4.8  o    o    o ...     columns, a bay apart; arches from column to column
 *              court               floor at y = -0.3; aisles at 0; gallery at 6
 *
 * Each side of the court is built in a frame of its own: x along the side, z into the court, origin in the line of columns. */
#ifndef VIT_SCENES_ATRIUM_H
#define VIT_SCENES_ATRIUM_H

#include "shapes.h"

#define BAY 3.2
#define LONG_BAYS 7
#define SHORT_BAYS 3
#define COURT_X (BAY * LONG_BAYS / 2) /* line of columns */
#define COURT_Z (BAY * SHORT_BAYS / 2)
#define OUTER_X (COURT_X + BAY)
#define OUTER_Z (COURT_Z + BAY)
#define COURT_FLOOR (-0.3)
#define SPRING 4.2 /* arches and vaults of the ground storey begin here */
#define GALLERY 6.0
#define UPPER_SPRING 9.15
#define UPPER_TOP 11.3 /* the upper arcade's cornice ends here */
#define WALL 0.3       /* half the thickness of the arcades' walls */

/* A side of the court. */
typedef struct atrium_side {
    mesh_frame frame;
    int bays;
    bool is_long;
} atrium_side;

/* The four sides: -z, +x, +z, -x. */
atrium_side atrium_side_of(int i);

/* Middle of bay i, or place of column i - 1/2, along the side. */
static inline double atrium_bay(const atrium_side *s, double i) {
    return (i - 0.5 * (s->bays - 1)) * BAY;
}

/* Moulding round the inside of a rectangle of half sizes hx, hz: `profile` points are (out of the wall, height), from the
 * bottom up; `count` of them. */
void atrium_ring(mesh *m, double hx, double hz, const double (*profile)[2], int count, double uv);

/* Floors, outer walls, steps, roof. */
void atrium_hall(mesh *m);
/* Vaults and ribs of the ground storey's aisles, coffers of the gallery's. */
void atrium_ceilings(mesh *m);
/* Columns, arches, cornices and balustrades of both storeys. */
void atrium_colonnades(mesh *m);
void atrium_curtains(mesh *m);
void atrium_banners(mesh *m);
void atrium_props(mesh *m);

#endif
