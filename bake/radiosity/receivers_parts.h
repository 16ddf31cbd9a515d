/* What the files of receivers.h share. Private to bake/radiosity. */
#ifndef VIT_RADIOSITY_RECEIVERS_PARTS_H
#define VIT_RADIOSITY_RECEIVERS_PARTS_H

#include "radiosity/receivers.h"
#include "radiosity/separation.h"

/* Where a ray of a camera ended. */
typedef struct receiver_sight {
    uint32_t side;
    float b1, b2;
    float wide; /* so far off another ray may be, m */
} receiver_sight;

/* A cell, or a part of one: cells first, then parts, level after level. */
typedef struct receiver_piece {
    cell_corners at;
    uint32_t side;
    uint32_t finer; /* so many along an edge of its cell: 1 for cells */
    uint32_t parts; /* of it, along each edge; 1 where it is not divided */
    uint32_t first; /* of its parts, a piece */
    float off;      /* with receivers_input.light: by so much of its light interpolation is off in its middle */
} receiver_piece;

typedef struct placing {
    const receivers_input *in;
    receivers *out;
    float *spacing; /* a side, m; 0: it is dark, or no light stays on it */
    bool *seen;     /* a side: by the cameras' rays, or beside one that they met */
    bool *met;      /* a side: by the cameras' rays */
    float (*at)[2]; /* a seen side: where the nearest of them met it, barycentric weights */
    float unseen;   /* spacing of the others, m */
    float finest;   /* receivers along the edge of a cell that its parts may have, at most: a quarter of a pixel apart */
    uint32_t step;  /* pixels between the cameras' rays, each way */
    receiver_sight *sights;
    size_t sight_count, sight_room;
    cells cells;
    bool *looked_at;        /* a cell: by the cameras, or none of its side's cells is */
    receiver_piece *pieces; /* receiver_parts.c */
    uint32_t piece_count;
    double mean;         /* of the light at the first look, columns added up */
    uint32_t begin, end; /* pieces that may be divided now: what is before is divided already, or stays whole */
    uint64_t *edges;     /* a hash table of pieces' edges: their two receivers, the larger in the high half */
    uint8_t *edge_parts; /* the fewest that a piece there is divided into; 0: no such edge */
    uint32_t edge_slots; /* a power of two */
    uint32_t room, split_room, follower_room;
    uint64_t *keys; /* a hash table of welded corners */
    uint32_t *found;
    uint32_t slots; /* of the table, a power of two */
    bool failed;
} placing;

/* receiver_spacing.c: `spacing`, `seen`, `met`, `at`, `sights`. False: out of memory. */
bool receivers_find_spacing(placing *p);
/* `looked_at`, once there are cells. */
bool receivers_find_looked_at(placing *p);
/* receiver_parts.c: `pieces`, none of the cells divided yet. */
bool receivers_start_pieces(placing *p);
/* Parts of pieces from `begin` to `end`, behind all others. irradiance, noise: of all receivers. */
bool receivers_find_parts(placing *p, const float *irradiance, const float *noise);
/* Pieces that should have been divided more, whose middles are too far off: their light is not known. */
void receivers_find_unknown(placing *p, const float *irradiance);
/* receiver_records.c: `followers` of the cells' receivers, of those that lie near records. */
bool receivers_find_records(placing *p);
/* Those whose records' light differs are records, too; mean: of the light of all, columns added up. */
void receivers_part_records(placing *p, const float *irradiance, double mean);
/* `edges`, once there are parts, which have no receivers yet. */
bool receivers_find_edges(placing *p);
#define RECEIVER_NODES (VIT_RECEIVER_PARTS + 1u)
/* `followers` of a piece's parts, whose corner i, j has receiver node[i][j], or VIT_NONE. */
bool receivers_hang(placing *p, uint32_t piece, uint32_t (*node)[RECEIVER_NODES]);

#endif
