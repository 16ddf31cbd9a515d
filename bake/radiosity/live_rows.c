#include "common/fail.h"
#include "common/parallel.h"
#include "radiosity/gather.h"
#include "radiosity/live_parts.h"
#include <stdlib.h>

#define BATCH 1024u /* receivers between two times that their hits are noted */
#define MOST_CODE 65535u

typedef struct seen {
    uint32_t point; /* VIT_NONE: nothing that reflects */
    float weight;
} seen;

typedef struct looking {
    const live_input *in;
    const patch_set *p;
    const live *out;
    uint32_t first;
    seen *hits;       /* receiver_rays a receiver */
    uint32_t *column; /* of one row */
    double *hits_of;  /* a column: hits, or what is left of them in mirrors */
} looking;

/* The patch's point that stands for the place: the nearest that faces the same way, if one does. */
static uint32_t point_at(const looking *w, uint32_t patch, const gather_hit *h) {
    const vit_patch *own = w->out->patches + patch;
    const vec3 place = side_place(w->in->geometry, h->side, h->b1, h->b2), face = side_face(w->in->geometry, h->side);
    uint32_t best = own->first;
    float least = INFINITY;
    for (uint32_t i = own->first; i < own->end; i++) {
        const vit_patch_point *q = w->out->points + i;
        const vec3 way = vec3_sub(vec3_load(q->position), place);
        const float turn = 2.0f - vec3_dot(vec3_load(q->normal), face), d2 = vec3_dot(way, way) * turn * turn;
        if (d2 < least) {
            least = d2;
            best = i;
        }
    }
    return best;
}

static int by_place(const void *a, const void *b) {
    const seen *x = a, *y = b;
    return x->point < y->point ? -1 : x->point > y->point;
}

static void look(void *user, uint32_t item) {
    const looking *w = user;
    const live_input *in = w->in;
    const uint32_t index = w->first + item, rays = in->receiver_rays, shift = pcg(index ^ 0x1d872b41u);
    const receiver *r = in->receivers + index;
    const vec3 face = side_face(in->geometry, r->side), about = side_shading(in->geometry, r->side, r->b1, r->b2);
    const vec3 from = vec3_along(side_place(in->geometry, r->side, r->b1, r->b2), face, in->rays->s->ray_offset);
    seen *hits = w->hits + (size_t)item * rays;
    for (uint32_t i = 0; i < rays; i++) {
        const float u = lattice_u(i, shift), v = lattice_v(i, pcg(shift));
        const vec3 d = vec3_cosine(about, u, v);
        hits[i] = (seen){.point = VIT_NONE};
        if (!(vec3_dot(d, face) > 0.0f))
            continue;
        const gather_hit h = gather(in->rays, in->geometry, from, d, pcg(shift ^ pcg(i)));
        const uint32_t patch = h.side == VIT_NONE ? VIT_NONE : patches_at(w->p, h.side, h.b1, h.b2);
        if (patch != VIT_NONE && h.weight > 0.0f)
            hits[i] = (seen){point_at(w, patch, &h), h.weight};
    }
    qsort(hits, rays, sizeof *hits, by_place);
}

/* A receiver's hits, which are sorted, as columns and how many. Columns are points: a patch's mean says too little of what is
 * seen of it, most beside a lamp. Returns how many. */
static uint32_t to_columns(const looking *w, const seen *hits) {
    const uint32_t rays = w->in->receiver_rays, stride = codec_stride(w->out->patch_count);
    uint32_t count = 0;
    for (uint32_t i = 0; i < rays && hits[i].point != VIT_NONE; i++) {
        if (i == 0 || hits[i].point != hits[i - 1].point) {
            w->column[count] = stride + hits[i].point;
            w->hits_of[count++] = 0.0;
        }
        w->hits_of[count - 1] += (double)hits[i].weight;
    }
    return count;
}

/* A column whose weight is not 1 hit, as often as its weight takes. */
static void note_weighted(uint32_t column, double hits, vit_gather_row *row, live *out) {
    for (uint32_t left = (uint32_t)(hits * VIT_GATHER_ONE + 0.5); left > 0;) {
        const uint32_t code = left < MOST_CODE ? left : MOST_CODE;
        out->words[out->word_count++] = code << 16 | column;
        row->weighted++;
        left -= code;
    }
}

/* The next receiver's row. */
static void note(const looking *w, const seen *hits, uint32_t index, live *out) {
    const uint32_t count = to_columns(w, hits);
    vit_gather_row *row = out->rows + index;
    *row = (vit_gather_row){.first = out->word_count, .scale = 1.0f / (float)w->in->receiver_rays};
    for (uint32_t i = 0; i < count; i++) {
        if (w->hits_of[i] != 1.0)
            continue;
        if (row->ones++ % 2u == 0)
            out->words[out->word_count++] = w->column[i];
        else
            out->words[out->word_count - 1] |= w->column[i] << 16;
    }
    for (uint32_t i = 0; i < count; i++)
        if (w->hits_of[i] != 1.0)
            note_weighted(w->column[i], w->hits_of[i], row, out);
}

/* Room for another batch's words. */
static bool make_room(const looking *w, size_t *room, live *out) {
    const size_t wanted = out->word_count + (size_t)BATCH * w->in->receiver_rays;
    if (wanted <= *room)
        return true;
    *room = wanted + wanted / 2;
    vit_u32 *words = realloc(out->words, *room * sizeof *words);
    if (!words)
        return false;
    out->words = words;
    return true;
}

vit_status live_rows(const live_input *in, const patch_set *p, live *out, vit_text *why) {
    const uint32_t count = in->receiver_count, rays = in->receiver_rays;
    size_t room = 0;
    looking w = {.in = in,
                 .p = p,
                 .out = out,
                 .hits = malloc((size_t)BATCH * rays * sizeof *w.hits),
                 .column = malloc(rays * sizeof *w.column),
                 .hits_of = malloc(rays * sizeof *w.hits_of)};
    out->rows = calloc(in->rows + 1u, sizeof *out->rows);
    bool fine = w.hits && w.column && w.hits_of && out->rows;
    for (; w.first < count && fine; w.first += BATCH) {
        const uint32_t batch = count - w.first < BATCH ? count - w.first : BATCH;
        fine = make_room(&w, &room, out);
        parallel_for(in->threads, fine ? batch : 0, look, &w);
        for (uint32_t i = 0; i < batch && fine; i++)
            note(&w, w.hits + (size_t)i * rays, w.first + i, out);
        if (in->progress)
            in->progress(in->user, 0.6 + 0.4 * (double)(w.first + batch) / count);
    }
    for (uint32_t i = count; fine && i < in->rows; i++)
        out->rows[i].first = out->word_count;
    free(w.hits);
    free(w.column);
    free(w.hits_of);
    return fine ? VIT_OK : bake_fail(why, VIT_FAILED, "live radiosity: out of memory");
}
