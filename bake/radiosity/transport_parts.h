/* What the files of transport.h share. Private to bake/radiosity. */
#ifndef VIT_RADIOSITY_TRANSPORT_PARTS_H
#define VIT_RADIOSITY_TRANSPORT_PARTS_H

#include "radiosity/separation.h"
#include "radiosity/transport.h"

#define TRANSPORT_PLACES 8u   /* of a cell, where rays met it, at most */
#define TRANSPORT_SHADOWS 64u /* lights whose last shadow is known; others share */

/* What stopped the last ray to a light, for as many lights; places near each other are often in the same shadow. */
typedef struct transport_shadows {
    uint32_t triangle[TRANSPORT_SHADOWS], last;
} transport_shadows;

typedef struct transport_place {
    uint32_t side;
    float b1, b2;
    uint32_t rank; /* random; a cell keeps the places of least rank */
} transport_place;

/* Rows of a sparse matrix. */
typedef struct transport_rows {
    size_t *first; /* count + 1 */
    uint32_t *to;  /* an entry: a cell's number */
    float *factor;
    uint32_t count, row_room;
    size_t room;
} transport_rows;

/* Where a receiver's ray met a cell close by. */
typedef struct transport_near {
    uint32_t row, number;  /* of the receiver, of the cell */
    transport_place place; /* rank: any */
    float factor;          /* the ray's */
} transport_near;

typedef struct transport {
    const transport_input *in;
    transport_report *report;
    cells cells;
    float *edge;          /* a side: wanted edge of its cells, m; 0: no light comes from it */
    separations apart;    /* cells that something stands on */
    uint32_t *number;     /* SEPARATION_PARTS a cell: number among those that light comes from, VIT_NONE: none has come yet */
    uint32_t count, room; /* numbered */
    uint32_t *cell;       /* a number: SEPARATION_PARTS * cell + part */
    uint32_t *place_count;
    transport_place *places; /* TRANSPORT_PLACES per number */
    transport_rows gathers;  /* a receiver: rows over numbers */
    transport_rows bounces;  /* a number */
    transport_near *near;    /* in the order of rows */
    size_t near_count, near_room;
    bool *varies;     /* a number: direct light is not alike at all its places */
    uint32_t columns; /* 3 per state */
} transport;

/* Parts of the time, about: rays of receivers, of cells, looks at lights, and rays at bright cells. */
#define TRANSPORT_GATHERED 0.5
#define TRANSPORT_BOUNCED 0.65
#define TRANSPORT_LIT 0.85

/* Says that a part is done by `fraction`. */
static inline void transport_step(const transport *t, double from, double to, double fraction) {
    if (t->in->progress)
        t->in->progress(t->in->user, from + (to - from) * fraction);
}

/* transport_rows.c: cells, and who sees which. */
bool transport_divide(transport *t, vit_text *why);
bool transport_gather(transport *t);
/* Room for so many rows and entries; the first call makes row 0's beginning. False: out of memory. */
bool transport_make_room(transport_rows *r, uint32_t rows, size_t entries);
void transport_drop_rows(transport_rows *r);
/* transport_aim.c: replaces what receivers' rays met of far bright cells by rays aimed at them. */
bool transport_aim(transport *t, const float *radiosity);
/* transport_light.c: radiosity that direct light gives the numbered cells: count x columns. */
bool transport_direct(transport *t, float *radiosity);
/* Adds `scale` times what direct light gives a place of numbered cell n: columns. seed: of the lights found by chance. */
void transport_light_at(const transport *t, uint32_t n, const transport_place *p, uint32_t seed, float scale, float *to,
                        transport_shadows *known, uint64_t *rays);
/* transport_near.c: notes a ray's end; where it is close by, light there is asked for. False: out of memory. */
bool transport_note_near(transport *t, const transport_near *n);
/* irradiance: receivers x columns: what these places have more, or less, than their cells' mean. radiosity: direct light's. */
void transport_near_light(transport *t, const float *radiosity, float *irradiance);
/* Mean reflectance at a numbered cell's places, with that of lobes. */
void transport_albedo(const transport *t, uint32_t n, float out[3]);

static inline uint32_t transport_cell(const transport *t, uint32_t number) {
    return t->cell[number] / SEPARATION_PARTS;
}

/* Far away, for how large the cell is: then it is seen from its middle. */
static inline bool transport_is_far(const transport *t, uint32_t cell, vec3 from) {
    const vec3 way = vec3_sub(cells_center(&t->cells, t->in->geometry, cell), from);
    return vec3_dot(way, way) > 8.0f * cells_area(&t->cells, t->in->geometry, cell);
}

static inline vec3 transport_place_at(const transport *t, const transport_place *p) {
    return side_place(t->in->geometry, p->side, p->b1, p->b2);
}

#endif
