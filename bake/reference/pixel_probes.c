#include "reference/pixel_probes.h"
#include "common/fail.h"
#include "reference/caustics.h"
#include "common/parallel.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define CHUNK 4u                                      /* spots that a thread takes at a time */
#define PATHS (REFERENCE_ROUND / REFERENCE_SEQUENCES) /* a sequence and round */

/* A frame's lights and camera over the scene that all share. */
typedef struct frame_scene {
    path_scene scene;
    uint32_t frame;
    float caustic_radius; /* of the first round's photons; 0: there are none */
    caustics caustics[REFERENCE_SEQUENCES];
} frame_scene;

typedef struct tracing {
    const spots_input *in;
    spot *spots;
    uint32_t count, rounds;
    path_scene base;
    frame_scene *frames;
    uint32_t frame_count;
    uint32_t *frame_of; /* a spot */
    view_sample *views;
    path_sums (*sums)[REFERENCE_SEQUENCES];
} tracing;

static uint32_t chunk_end(const tracing *t, uint32_t chunk) {
    return (chunk + 1) * CHUNK < t->count ? (chunk + 1) * CHUNK : t->count;
}

static void view_chunk(void *user, uint32_t chunk, uint64_t *rays) {
    tracing *t = user;
    for (uint32_t i = chunk * CHUNK; i < chunk_end(t, chunk); i++)
        paths_view(&t->frames[t->frame_of[i]].scene, t->spots[i].x, t->spots[i].y, t->views + i, rays);
}

static void add_sums(path_sums *to, const path_sums *from) {
    for (int k = 0; k < 3; k++) {
        to->direct[k] += from->direct[k];
        to->limited[k] += from->limited[k];
        to->unlimited[k] += from->unlimited[k];
    }
}

static void path_chunk(void *user, uint32_t chunk, uint64_t *rays) {
    tracing *t = user;
    for (uint32_t i = chunk * CHUNK; i < chunk_end(t, chunk); i++) {
        const spot *s = t->spots + i;
        const frame_scene *f = t->frames + t->frame_of[i];
        const uint32_t seed = pcg(s->x ^ pcg(s->y ^ pcg(s->frame)));
        for (uint32_t q = 0; q < REFERENCE_SEQUENCES; q++) {
            path_sums round;
            paths_trace(&f->scene, f->caustic_radius > 0.0f ? f->caustics + q : NULL, t->views + i, pcg(seed + q),
                        t->rounds * PATHS, PATHS, false, &round, rays);
            add_sums(t->sums[i] + q, &round);
        }
    }
}

static void run_chunks(tracing *t, void (*run)(void *, uint32_t, uint64_t *)) {
    uint64_t rays = 0;
    const parallel_work w = {.run = run,
                             .user = t,
                             .step = 1,
                             .count = (t->count + CHUNK - 1) / CHUNK,
                             .threads = parallel_threads(t->in->threads, 1)};
    (void)parallel_run(&w, &rays);
}

static void free_caustics(tracing *t) {
    for (uint32_t f = 0; f < t->frame_count; f++)
        for (uint32_t q = 0; q < REFERENCE_SEQUENCES; q++)
            caustics_free(t->frames[f].caustics + q);
}

/* The round's photons of each frame, a sequence's own each. False: out of memory. */
static bool trace_caustics(tracing *t) {
    const unsigned threads = parallel_threads(t->in->threads, 1);
    uint64_t rays = 0;
    free_caustics(t);
    for (uint32_t i = 0; i < t->frame_count; i++) {
        frame_scene *f = t->frames + i;
        for (uint32_t q = 0; q < REFERENCE_SEQUENCES && f->caustic_radius > 0.0f; q++)
            if (!caustics_trace(&f->scene, f->caustic_radius, pcg(f->frame ^ pcg(t->rounds * REFERENCE_SEQUENCES + q)),
                                t->rounds, threads, f->caustics + q, &rays))
                return false;
    }
    return true;
}

/* What the spots are after the rounds so far. */
static void settle(tracing *t) {
    const double paths = (double)t->rounds * PATHS;
    for (uint32_t i = 0; i < t->count; i++) {
        spot *s = t->spots + i;
        s->hit = t->views[i].random || t->views[i].hit;
        for (int k = 0; k < 3; k++) {
            double mean = 0, square = 0;
            s->direct[k] = t->views[i].direct[k];
            for (uint32_t q = 0; q < REFERENCE_SEQUENCES; q++) {
                const path_sums *p = t->sums[i] + q;
                const double direct = t->views[i].direct[k] + p->direct[k] / paths;
                s->all[q][k] = direct + p->unlimited[k] / paths;
                s->limited[q][k] = direct + p->limited[k] / paths;
                s->direct[k] += p->direct[k] / paths / REFERENCE_SEQUENCES;
                mean += s->all[q][k] / REFERENCE_SEQUENCES;
            }
            for (uint32_t q = 0; q < REFERENCE_SEQUENCES; q++)
                square += (s->all[q][k] - mean) * (s->all[q][k] - mean);
            s->variance[k] = square / ((REFERENCE_SEQUENCES - 1.0) * REFERENCE_SEQUENCES);
        }
    }
}

double spot_brightness(const spot *s) {
    double sum = 0;
    for (uint32_t q = 0; q < REFERENCE_SEQUENCES; q++)
        sum += (s->all[q][0] + s->all[q][1] + s->all[q][2]) / REFERENCE_SEQUENCES;
    return sum;
}

static int by_brightness(const void *a, const void *b) {
    const double x = spot_brightness(*(const spot *const *)a), y = spot_brightness(*(const spot *const *)b);
    return x < y ? -1 : x > y;
}

/* Is the error of the sums small enough? False too where there is no memory. */
static bool is_enough(const tracing *t) {
    const spot **order = malloc((t->count + 1u) * sizeof *order);
    double sum = 0, variance = 0;
    bool enough = order != NULL;
    for (uint32_t i = 0; order && i < t->count; i++)
        order[i] = t->spots + i;
    if (order)
        qsort(order, t->count, sizeof *order, by_brightness);
    for (uint32_t i = 0; order && i < t->count; i++) {
        sum += spot_brightness(order[i]);
        variance += order[i]->variance[0] + order[i]->variance[1] + order[i]->variance[2];
        if (i + 1 == (t->count + 1) / 2 || i + 1 == t->count)
            enough = enough && sqrt(3 * variance) <= t->in->error * sum; /* as if all channels erred alike */
    }
    free(order);
    return enough;
}

static vit_status trace(tracing *t, vit_text *why) {
    const uint32_t most = (t->in->most + REFERENCE_ROUND - 1) / REFERENCE_ROUND;
    run_chunks(t, view_chunk);
    for (uint32_t next = most < 4 ? most : 4;; next = 2 * next < most ? 2 * next : most) {
        for (; t->rounds < next; t->rounds++) {
            if (!trace_caustics(t)) {
                return bake_fail(why, VIT_FAILED, "check: out of memory");
            }
            run_chunks(t, path_chunk);
            if (t->in->progress)
                t->in->progress(t->in->user, (t->rounds + 1.0) / most);
        }
        settle(t);
        if (t->rounds == most || is_enough(t))
            return VIT_OK;
    }
}

/* A scene for each frame that has spots. */
static bool open_frames(tracing *t) {
    const unsigned threads = parallel_threads(t->in->threads, 1);
    for (uint32_t i = 0; i < t->count; i++) {
        const uint32_t frame = t->spots[i].frame;
        if (t->frame_count == 0 || t->frames[t->frame_count - 1].frame != frame) {
            frame_scene *f = t->frames + t->frame_count++;
            f->frame = frame;
            f->scene = t->base;
            f->scene.camera = (const vit_camera *)t->in->sections->data[VIT_SECTION_CAMS] + frame;
            if (f->scene.lights)
                f->scene.lights =
                    (const vit_light *)t->in->sections->data[VIT_SECTION_LITE] + (size_t)frame * t->base.meta->lights;
            f->caustic_radius = caustics_possible(&f->scene) ? caustics_first_radius(&f->scene, threads) : 0.0f;
            if (f->caustic_radius < 0.0f)
                return false;
        }
        t->frame_of[i] = t->frame_count - 1;
    }
    return true;
}

vit_status spots_render(const spots_input *in, spot *spots, uint32_t count, uint32_t *paths, vit_text *why) {
    const reference_input input = {
        .sections = in->sections, .direct_only = in->direct_only, .frame = 0, .bounces = in->bounces};
    tracing t = {.in = in,
                 .spots = spots,
                 .count = count,
                 .frames = calloc(count + 1u, sizeof *t.frames),
                 .frame_of = calloc(count + 1u, sizeof *t.frame_of),
                 .views = calloc(count + 1u, sizeof *t.views),
                 .sums = calloc(count + 1u, sizeof *t.sums)};
    vit_status status = bake_fail(why, VIT_FAILED, "check: out of memory, or Embree fails");
    if (t.frames && t.frame_of && t.views && t.sums && paths_open(&input, parallel_threads(in->threads, 1), &t.base)) {
        if (open_frames(&t))
            status = trace(&t, why);
        free_caustics(&t);
        paths_close(&t.base);
    }
    *paths = t.rounds * REFERENCE_ROUND;
    free(t.frames);
    free(t.frame_of);
    free(t.views);
    free(t.sums);
    return status;
}
