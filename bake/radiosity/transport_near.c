/* Direct light close by. A cell's mean says little of what a receiver gets from it that is no further away than the cell is
 * large: the reveal of a window beside a spot of sun on its sill. There each ray that a receiver sent asks for the light at
 * the very place that it met, if light is not alike all over that cell. */
#include "common/parallel.h"
#include "radiosity/transport_parts.h"
#include <stdlib.h>
#include <string.h>

#define BATCH 64u /* receivers */

bool transport_note_near(transport *t, const transport_near *n) {
    if (t->near_count == t->near_room) {
        const size_t room = t->near_room ? 2 * t->near_room : 65536u;
        transport_near *near = realloc(t->near, room * sizeof *near);
        if (!near)
            return false;
        t->near = near;
        t->near_room = room;
    }
    t->near[t->near_count++] = *n;
    return true;
}

typedef struct near_work {
    const transport *t;
    const float *radiosity;
    float *irradiance;
} near_work;

/* The first entry of a row at or after `row`. */
static size_t first_of(const transport *t, uint32_t row) {
    size_t low = 0, high = t->near_count;
    while (low < high) {
        const size_t middle = low + (high - low) / 2;
        if (t->near[middle].row < row)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

static void light_batch(void *user, uint32_t batch, uint64_t *rays) {
    const near_work *w = user;
    const transport *t = w->t;
    transport_shadows known;
    memset(&known, 0xff, sizeof known);
    const size_t end = first_of(t, (batch + 1) * BATCH);
    for (size_t i = first_of(t, batch * BATCH); i < end; i++) {
        const transport_near *n = t->near + i;
        if (!t->varies[n->number])
            continue;
        float *to = w->irradiance + (size_t)n->row * t->columns;
        const float *mean = w->radiosity + (size_t)n->number * t->columns;
        transport_light_at(t, n->number, &n->place, pcg((uint32_t)i), n->factor, to, &known, rays);
        for (uint32_t c = 0; c < t->columns; c++)
            to[c] -= n->factor * mean[c];
    }
}

void transport_near_light(transport *t, const float *radiosity, float *irradiance) {
    near_work w = {t, radiosity, irradiance};
    memset(irradiance, 0, (size_t)t->in->receiver_count * t->columns * sizeof *irradiance);
    const parallel_work work = {.run = light_batch,
                                .user = &w,
                                .step = 1,
                                .count = (t->in->receiver_count + BATCH - 1) / BATCH,
                                .threads = t->in->threads};
    parallel_run(&work, &t->report->light_rays);
}
