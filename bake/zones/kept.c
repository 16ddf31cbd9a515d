#include "zones/kept.h"
#include "common/progress.h"
#include <stdlib.h>
#include <string.h>

static uint64_t bytes_of(const cells *c, uint32_t sides) {
    return (uint64_t)sides * sizeof *c->sides + (uint64_t)c->count * (sizeof *c->cells + sizeof *c->side_of);
}

static void drop(zones_kept_one *o) {
    cells_free(&o->cells);
    free(o->gives);
    memset(o, 0, sizeof *o);
}

static bool is_of(const zones_kept_one *o, const zones_input *in) {
    const vit_scene *s = in->scene;
    return o->asked > 0 && !(o->radius < s->radius) && !(o->radius > s->radius) && !(o->flatten < s->flatten) &&
           !(o->flatten > s->flatten) && o->width == s->width && o->height == s->height && o->bounces == s->bounces &&
           o->lights == s->lights && o->zones == in->zones && o->by_light == in->by_light && o->areas == in->areas &&
           o->guided == (in->guiding != NULL) &&
           (s->lights == 0 || memcmp(o->gives, in->gives_photons, s->lights * sizeof *o->gives) == 0);
}

static void *copied(const void *from, size_t size) {
    void *to = malloc(size + 1);
    return to ? memcpy(to, from, size) : NULL;
}

static bool copy_cells(const cells *from, uint32_t sides, cells *to) {
    *to = (cells){.sides = copied(from->sides, sides * sizeof *from->sides),
                  .cells = copied(from->cells, from->count * sizeof *from->cells),
                  .side_of = copied(from->side_of, from->count * sizeof *from->side_of),
                  .count = from->count};
    if (to->sides && to->cells && to->side_of)
        return true;
    cells_free(to);
    return false;
}

/* The one that was asked for longest ago; asked 0: a free place. */
static zones_kept_one *oldest(zones_kept *k, bool taken) {
    zones_kept_one *o = NULL;
    for (int i = 0; i < ZONES_KEPT; i++)
        if ((k->one[i].asked > 0 || !taken) && (!o || k->one[i].asked < o->asked))
            o = k->one + i;
    return o;
}

/* A place with room for so many bytes. */
static zones_kept_one *make_room(zones_kept *k, uint64_t bytes) {
    uint64_t sum = 0;
    int count = 0;
    for (int i = 0; i < ZONES_KEPT; i++) {
        sum += k->one[i].bytes;
        count += k->one[i].asked > 0;
    }
    for (; count > 1 && sum + bytes > ZONES_BYTES; count--) {
        zones_kept_one *o = oldest(k, true);
        sum -= o->bytes;
        drop(o);
    }
    zones_kept_one *o = oldest(k, false);
    drop(o);
    return o;
}

static void keep(zones_kept *k, const zones_input *in, const cells *c, const zones_found *found) {
    const vit_scene *s = in->scene;
    const uint64_t bytes = bytes_of(c, 2 * in->triangles);
    zones_kept_one *o = make_room(k, bytes);
    o->gives = copied(in->gives_photons, s->lights * sizeof *o->gives);
    if (!o->gives || !copy_cells(c, 2 * in->triangles, &o->cells)) {
        drop(o);
        return;
    }
    o->radius = s->radius;
    o->flatten = s->flatten;
    o->width = s->width;
    o->height = s->height;
    o->bounces = s->bounces;
    o->lights = s->lights;
    o->zones = in->zones;
    o->by_light = in->by_light;
    o->areas = in->areas;
    o->guided = in->guiding != NULL;
    o->found = *found;
    o->bytes = bytes;
    o->asked = ++k->asked;
}

vit_status zones_kept_bake(zones_kept *k, const zones_input *in, cells *out, zones_found *found, vit_text *why) {
    for (int i = 0; i < ZONES_KEPT; i++) {
        zones_kept_one *o = k->one + i;
        if (!is_of(o, in) || !copy_cells(&o->cells, 2 * in->triangles, out))
            continue;
        o->asked = ++k->asked;
        *found = o->found;
        return VIT_OK;
    }
    const double began = progress_now();
    vit_status status = zones_bake(in, out, found, why);
    found->seconds = progress_now() - began;
    if (status == VIT_OK)
        keep(k, in, out, found);
    return status;
}

void zones_kept_free(zones_kept *k) {
    for (int i = 0; i < ZONES_KEPT; i++)
        drop(k->one + i);
}
