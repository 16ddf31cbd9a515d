/* What the files of transport.h share. Private to bake/radiosity. */
#ifndef VIT_RADIOSITY_TRANSPORT_PARTS_H
#define VIT_RADIOSITY_TRANSPORT_PARTS_H

#include "radiosity/separation.h"
#include "radiosity/transport.h"

#define TRANSPORT_PLACES 8u /* of a cell, where rays met it, at most */

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

typedef struct transport {
    const transport_input *in;
    transport_report *report;
    cells cells;
    float *edge;          /* a side: wanted edge of its cells, m; 0: no light comes from it */
    separations apart;    /* cells that something stands on: two parts */
    uint32_t *number;     /* 2 a cell, its two parts: number among those that light comes from, VIT_NONE: none has come yet */
    uint32_t count, room; /* numbered */
    uint32_t *cell;       /* a number: 2 * cell + part */
    uint32_t *place_count;
    transport_place *places; /* TRANSPORT_PLACES per number */
    transport_rows gathers;  /* a receiver: rows over numbers */
    transport_rows bounces;  /* a number */
    uint32_t columns;        /* 3 per state */
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
/* Mean reflectance at a numbered cell's places, with that of lobes. */
void transport_albedo(const transport *t, uint32_t n, float out[3]);

static inline vec3 transport_place_at(const transport *t, const transport_place *p) {
    return side_place(t->in->geometry, p->side, p->b1, p->b2);
}

#endif
