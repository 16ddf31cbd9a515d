/* images.c: a frame of a pack as the reference sees it: linear, on the reference's grid. */
#ifndef VIT_COST_IMAGES_H
#define VIT_COST_IMAGES_H

#include "vitrine.h"

typedef struct images_grid {
    uint32_t width, height; /* of the frame that the reference shows, pixels */
    uint32_t every;         /* grid point (i, j) is the centre of pixel (every * i + every / 2, every * j + every / 2) */
} images_grid;

/* Grid points across and down, at least 1 each. */
uint32_t images_across(const images_grid *g);
uint32_t images_down(const images_grid *g);

/* Takes `rgba` (width x height pixels, 4 floats each) at the grid's points into `out`, 3 floats a point. A picture of another
 * size is shown as large as the grid's frame, interpolated bilinearly between pixel centres, clamped at the rim. */
void images_sample(const images_grid *g, const float *rgba, uint32_t width, uint32_t height, float *out);

/* Renders frame `index` of the pack in `how` (pack, device, lanes, view, count_work) as RGBA32F and takes it on the grid.
 * `stats` may be NULL. */
vit_status images_render(const vit_open_info *how, uint32_t index, const images_grid *g, float *out, vit_statistics *stats,
                         vit_text *why);

#endif
