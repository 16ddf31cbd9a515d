/* Rounds of some paths per pixel, until the standard error is small enough. A pixel's numbers come from its own paths in
 * a fixed order, so that neither threads nor ranks show. */
#define _POSIX_C_SOURCE 200809L
#include "reference/caustics.h"
#include "common/fail.h"
#include "common/parallel.h"
#include "reference/paths.h"
#include "reference/spread.h"
#include "reference/state.h"
#include <stdlib.h>
#include <string.h>
#include <time.h>

#define CHUNK 32u                                     /* pixels that a thread takes at a time */
#define PATHS (REFERENCE_ROUND / REFERENCE_SEQUENCES) /* a sequence and round */
#define SAVE_SECONDS 30.0                             /* between writes of an unfinished reference */

typedef struct rendering {
    const reference_input *in;
    path_scene scene;
    reference_state state;
    view_sample *views;                     /* of the rank's own pixels */
    caustics caustics[REFERENCE_SEQUENCES]; /* of this round */
    float first_radius;                     /* of their photons; 0: there are none */
    pixel_sums *round;                      /* sums of this round; zero for other ranks' pixels until they are gathered */
    uint32_t chunks, most;                  /* most: rounds */
    double began, spent;                    /* clock; seconds of earlier runs */
    double error;                           /* so far */
    double first_share;                     /* of the work that was done before this run, for the time left */
} rendering;

static double now(void) {
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static vit_status fail(vit_text *why, vit_status status, const char *what) {
    return bake_fail(why, status, "reference: %s", what);
}

static uint32_t pixel_x(const rendering *r, uint32_t pixel) {
    return pixel % r->state.width * r->in->every + r->in->every / 2;
}

static uint32_t pixel_y(const rendering *r, uint32_t pixel) {
    return pixel / r->state.width * r->in->every + r->in->every / 2;
}

static uint32_t chunk_end(const rendering *r, uint32_t chunk) {
    return (chunk + 1) * CHUNK < r->state.pixels ? (chunk + 1) * CHUNK : r->state.pixels;
}

static void view_chunk(void *user, uint32_t chunk, uint64_t *rays) {
    rendering *r = user;
    for (uint32_t i = chunk * CHUNK; i < chunk_end(r, chunk); i++)
        paths_view(&r->scene, pixel_x(r, i), pixel_y(r, i), r->views + i, rays);
}

static void path_chunk(void *user, uint32_t chunk, uint64_t *rays) {
    rendering *r = user;
    for (uint32_t i = chunk * CHUNK; i < chunk_end(r, chunk); i++) {
        uint32_t seed = pcg(pixel_x(r, i) ^ pcg(pixel_y(r, i) ^ pcg(r->in->frame)));
        if (r->in->face_normals)
            seed = pcg(~seed);
        memcpy(r->round[i].direct, r->views[i].direct, sizeof r->round[i].direct);
        for (uint32_t q = 0; q < REFERENCE_SEQUENCES; q++)
            paths_trace(&r->scene, r->first_radius > 0.0f ? r->caustics + q : NULL, r->views + i, pcg(seed + q),
                        r->state.rounds * PATHS, PATHS, false, r->round[i].paths + q, rays);
    }
}

/* Rounds that the target will take, as far as is known. */
static double rounds_needed(const rendering *r) {
    if (r->state.rounds == 0)
        return r->most;
    const double needed = r->state.rounds * r->error / r->in->target;
    return needed < r->most ? (needed > r->state.rounds ? needed : r->state.rounds + 1.0) : r->most;
}

static void report(void *user, double of_round) {
    const rendering *r = user;
    const double share = (r->state.rounds + of_round) / rounds_needed(r), took = now() - r->began;
    if (!r->in->progress)
        return;
    const double fraction = share < 1 ? share : 1, done = fraction - r->first_share;
    r->in->progress(r->in->user, fraction, done > 0 ? took / done * (1 - fraction) : 0);
}

/* One function over this rank's chunks; what all ranks found ends in r->round. False: cancelled. */
static bool run_chunks(rendering *r, void (*run)(void *, uint32_t, uint64_t *), bool reports) {
    const parallel_work w = {.run = run,
                             .done = reports ? report : NULL,
                             .user = r,
                             .first = spread_rank(),
                             .step = spread_size(),
                             .count = r->chunks,
                             .threads = parallel_threads(r->in->threads, spread_neighbours()),
                             .cancel = r->in->cancel};
    uint64_t rays = 0;
    memset(r->round, 0, r->state.pixels * sizeof *r->round);
    const bool whole = parallel_run(&w, &rays);
    if (spread_any(!whole))
        return false;
    spread_gather((double *)r->round, (size_t)r->state.pixels * (sizeof *r->round / sizeof(double)));
    r->state.rays += spread_sum(rays);
    return true;
}

/* Rank 0 has the files; the others get what it read. */
static vit_status load(rendering *r, vit_text *why) {
    reference_state *s = &r->state;
    vit_status status = VIT_OK;
    s->key = state_key(r->in);
    if (spread_rank() == 0 && r->in->cache) {
        status = state_folder(r->in->cache, why);
        if (status == VIT_OK)
            state_load(s, r->in->cache);
    }
    if (spread_any(status != VIT_OK))
        return status == VIT_OK ? fail(why, VIT_FAILED, "rank 0 cannot write its cache") : status;
    uint64_t shared[3] = {s->key, s->rounds, s->rays};
    spread_share(shared, sizeof shared);
    if (spread_any(shared[0] != s->key))
        return fail(why, VIT_BAD_INPUT, "the ranks have different scenes");
    s->rounds = (uint32_t)shared[1];
    s->rays = shared[2];
    spread_share(&s->seconds, sizeof s->seconds);
    spread_share(s->sums, s->pixels * sizeof *s->sums);
    r->spent = s->seconds;
    return VIT_OK;
}

/* Saves now if `always`, else when it is time. */
static vit_status save(rendering *r, bool always, double *saved, vit_text *why) {
    r->state.seconds = r->spent + now() - r->began;
    vit_status status = VIT_OK;
    if (spread_rank() == 0 && r->in->cache && (always || now() - *saved >= SAVE_SECONDS)) {
        status = state_save(&r->state, r->in->cache, why);
        *saved = now();
    }
    if (spread_any(status != VIT_OK))
        return status == VIT_OK ? fail(why, VIT_FAILED, "rank 0 cannot write its cache") : status;
    return VIT_OK;
}

static void free_caustics(rendering *r) {
    for (uint32_t q = 0; q < REFERENCE_SEQUENCES; q++)
        caustics_free(r->caustics + q);
}

/* The round's photons, the same on all ranks, and a sequence's own each, so that variances hold theirs. */
static vit_status trace_caustics(rendering *r, uint64_t *rays, vit_text *why) {
    const unsigned threads = parallel_threads(r->in->threads, spread_neighbours());
    free_caustics(r);
    for (uint32_t q = 0; q < REFERENCE_SEQUENCES && r->first_radius > 0.0f; q++) {
        const uint32_t number = pcg(r->in->frame ^ pcg(r->state.rounds * REFERENCE_SEQUENCES + q));
        if (!caustics_trace(&r->scene, r->first_radius, number, r->state.rounds, threads, r->caustics + q, rays))
            return fail(why, VIT_FAILED, "out of memory");
    }
    return VIT_OK;
}

static bool finished(const rendering *r) {
    return r->state.rounds > 0 && (r->state.rounds >= r->most || r->error <= r->in->target);
}

static vit_status trace_rounds(rendering *r, vit_text *why) {
    const uint32_t before = r->state.rounds;
    double saved = now();
    r->first_share = r->state.rounds / rounds_needed(r);
    while (!finished(r)) {
        uint64_t rays = 0; /* counted when the round is done */
        vit_status status = trace_caustics(r, &rays, why);
        if (spread_any(status != VIT_OK))
            return status != VIT_OK ? status : fail(why, VIT_FAILED, "another rank failed");
        if (!run_chunks(r, path_chunk, true)) {
            status = r->state.rounds > before ? save(r, true, &saved, why) : VIT_OK;
            return status == VIT_OK ? fail(why, VIT_FAILED, "interrupted") : status;
        }
        state_add(&r->state, r->round);
        r->state.rays += rays;
        r->error = state_error(&r->state);
        status = save(r, false, &saved, why);
        if (status != VIT_OK)
            return status;
    }
    return save(r, true, &saved, why);
}

/* View samples that paths share, once a run: their rays count in the first. */
static vit_status trace(rendering *r, vit_text *why) {
    const uint64_t rays = r->state.rays;
    r->began = now();
    if (!run_chunks(r, view_chunk, false))
        return fail(why, VIT_FAILED, "interrupted");
    if (r->state.rounds > 0)
        r->state.rays = rays;
    return trace_rounds(r, why);
}

static vit_status check(const reference_input *in, vit_text *why) {
    const vit_scene *s = in->sections->data[VIT_SECTION_META];
    if (in->frame >= s->frames)
        return fail(why, VIT_BAD_INPUT, "there is no such frame");
    if (in->every == 0 || in->every / 2 >= s->width || in->every / 2 >= s->height)
        return fail(why, VIT_BAD_INPUT, "no pixel is on the grid: `every` is 0 or beyond the frame's size");
    if (in->bounces == 0 || !(in->target > 0))
        return fail(why, VIT_BAD_INPUT, "`bounces` and `target` must be positive");
    if (in->max_samples == 0 || in->max_samples > REFERENCE_MOST)
        return fail(why, VIT_BAD_INPUT, "`max_samples` is out of range");
    return VIT_OK;
}

/* Pixels of the grid along an edge: those with every * i + every / 2 < size. */
static uint32_t grid_size(uint32_t size, uint32_t every) {
    return (size - every / 2 + every - 1) / every;
}

static vit_status make_room(rendering *r, vit_text *why) {
    const vit_scene *s = r->in->sections->data[VIT_SECTION_META];
    const uint32_t width = grid_size(s->width, r->in->every), height = grid_size(s->height, r->in->every);
    r->most = (r->in->max_samples + REFERENCE_ROUND - 1) / REFERENCE_ROUND;
    const vit_status status = state_make(width, height, &r->state, why);
    if (status != VIT_OK)
        return status;
    r->chunks = (r->state.pixels + CHUNK - 1) / CHUNK;
    r->views = calloc(r->state.pixels, sizeof *r->views);
    r->round = calloc(r->state.pixels, sizeof *r->round);
    return r->views && r->round ? VIT_OK : fail(why, VIT_FAILED, "out of memory");
}

static vit_status render(rendering *r, reference *out, vit_text *why) {
    const unsigned threads = parallel_threads(r->in->threads, spread_neighbours());
    vit_status status = check(r->in, why);
    if (status == VIT_OK)
        status = make_room(r, why);
    if (status == VIT_OK)
        status = load(r, why);
    if (status != VIT_OK)
        return status;
    r->error = state_error(&r->state);
    if (!finished(r)) {
        if (!paths_open(r->in, threads, &r->scene))
            return fail(why, VIT_FAILED, "Embree fails");
        r->first_radius = caustics_possible(&r->scene) ? caustics_first_radius(&r->scene, threads) : 0.0f;
        status = r->first_radius < 0.0f ? fail(why, VIT_FAILED, "out of memory") : trace(r, why);
        free_caustics(r);
        paths_close(&r->scene);
    }
    return status == VIT_OK ? state_finish(&r->state, out, why) : status;
}

vit_status reference_render(const reference_input *in, reference *out, vit_text *why) {
    rendering r = {.in = in};
    *out = (reference){0};
    const vit_status status = render(&r, out, why);
    state_free(&r.state);
    free(r.views);
    free(r.round);
    return status;
}

void reference_free(reference *r) {
    double *const images[] = {r->direct,          r->limited,          r->unlimited,
                              r->direct_variance, r->limited_variance, r->unlimited_variance};
    for (size_t i = 0; i < sizeof images / sizeof images[0]; i++)
        free(images[i]);
    *r = (reference){0};
}
