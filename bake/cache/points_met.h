/* points_met.c: which cells and points of the cache places read, and how much of each: the rows of a linear system. */
#ifndef VIT_CACHE_POINTS_MET_H
#define VIT_CACHE_POINTS_MET_H

#include "cache/points.h"
#include "cache/sights.h"

#define CACHE_MOST_READ (2u * 3u * 27u) /* points that a place reads: of two levels and three sides */

/* A cell that some place reads. */
typedef struct cache_cell {
    int32_t at[3];        /* cells from the origin, of its level */
    uint32_t level, side; /* VIT_CACHE_SIDES; of a part more: cache_key() */
} cache_cell;

/* A point and its weight. */
typedef struct cache_read {
    uint32_t point; /* VIT_CACHE_POINTS * cell + point of it */
    float weight;
} cache_read;

typedef struct cache_met {
    cache_cell *cells;
    uint32_t cell_count, cell_room;
    uint8_t *places_of;          /* a point: places taken that read it, up to `enough` */
    uint32_t *slots, slot_count; /* a hash table of the cells */
    uint32_t *taken;             /* of the sights: those that are rows */
    uint32_t taken_count;
    size_t *first;     /* a row: in `reads`; one more at the end */
    cache_read *reads; /* weights of a row add up to 1 */
    size_t read_count, read_room;
} cache_met;

/* Levels of detail, and cache_step and cache_detail, so that boxes are `spacing` pixels wide on the picture, but those of level
 * 0 no less than `least` metres. */
void cache_levels_choose(const cache_sights *s, double spacing, float least, vit_scene *meta);
/* A cell's record, of which nothing is known. */
static inline vit_cache_cell cache_cell_record(const cache_cell *c) {
    return (vit_cache_cell){cache_key(cache_seed(c->at, c->level), c->side), {0, 0, cache_tag(c->at)}};
}

/* Cells that walls part. */
typedef struct cache_walls {
    const cache_met *met;
    cache_plane *plane; /* a cell of `met` */
    uint32_t count;     /* cells that have one */
} cache_walls;

/* Goes through the sights in their order and takes those that read a point which less than `enough` before it read. meta:
 * cache_levels, cache_step, cache_detail. walls: places read parts of these cells; NULL: there are none. VIT_FAILED: out of
 * memory. */
vit_status cache_met_find(const vit_scene *meta, const cache_sights *sights, uint32_t enough, const cache_walls *walls,
                          cache_met *out, vit_text *why);
void cache_met_free(cache_met *m);

#endif
