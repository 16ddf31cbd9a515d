/* Dark sides, by a small radiosity solution over the sides of triangles:
 *   1. rays from the lights (points, directions, area lights, the sky), over all frames and directions, give each side its
 * direct irradiance;
 *   2. every side shoots rays about its normal and notes which sides they find: the fewer, the more sides there are;
 *   3. E = direct + albedo * mean of E over what the rays found, repeated until light has gone everywhere (Jacobi);
 *   4. sides that hang together with sides that some light comes to, but are faint themselves, shoot more, and 3 is repeated:
 * light that comes through few ways is found by few rays;
 *   5. what dim frames see is lit by less (dark_sides/views.c);
 *   6. sides whose rays do not make them lit for sure ask with more rays of their own and rays towards the lights: triangles
 * too small for 1 and 2 are not darkened by bad luck (dark_sides/ask.c). A side gets about ten rays in all, whatever it is part
 * of, unless it lies where it gets dark.
 *
 * Sums over threads are integers, everything else is computed by one thread in a fixed order: the result does not depend on
 * threads. In doubt a side is lit: all surfaces reflect more than most real ones, lights have no range, cut-outs stop no ray,
 * mirrors and glass send light on, the sky shines alike all round. They themselves are never dark: no photon is stored there.
 * Every light that shines at all gives the same power, area lights together and the sky as one each; all together 1, and
 * irradiance is in that unit a m2. */
#include "common/parallel.h"
#include "common/fail.h"
#include "dark_sides/parts.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#define LEAST_LIGHT_RAYS (1u << 18) /* of step 1: two a side between these */
#define MOST_LIGHT_RAYS (1u << 20)
#define LEAST_GATHERED 4u /* rays per side in step 2, between these and so that they are GATHERED in all */
#define MOST_GATHERED 16u
#define GATHERED (1u << 20)
#define GATHERED_BY_AREA (1u << 17) /* and so many by area: what large sides give lights much */
#define ITERATIONS 40               /* 0.8^40 = 1e-4 */
#define STILL 4                     /* turns without news after which nothing more comes */
#define NEWS 1e-3                   /* of all light */
#define FLUX_ONE 0x1p56             /* fixed point of direct flux: all sides' sum is at most the lights' power, 1 */

/* Step 1: a ray of one light, from its place in one frame. */
static void shoot_from_light(void *user, uint32_t ray) {
    dark_sides_search *s = user;
    vec origin, direction;
    if (!lights_leave(s, ray, &origin, &direction))
        return;
    float distance = INFINITY;
    const uint32_t side = ray_scene_follow(&s->rays, origin, direction, ray, &distance);
    const double share = 1.0 / s->light_rays; /* every light counts alike: a weak one may be all that a room has */
    if (side < s->sides)
        atomic_fetch_add_explicit(s->flux + side, (unsigned long long)(share * FLUX_ONE), memory_order_relaxed);
    atomic_fetch_add_explicit(&s->shot, 1, memory_order_relaxed);
}

double dark_sides_part(const dark_sides_search *s, uint32_t side) {
    return (double)s->area[side / 2] / (2.0 * s->whole);
}

uint32_t dark_sides_look(const dark_sides_search *s, uint32_t side, const ray_side *from, uint32_t i, float *distance) {
    const vec origin = side_point(from, side_sequence(from, i, 0), side_sequence(from, i, 1));
    const vec direction = cosine_direction(from->normal, side_sequence(from, i, 2), side_sequence(from, i, 3));
    *distance = INFINITY;
    return ray_scene_follow(&s->rays, origin, direction, side + i, distance);
}

/* The rays of a side from `from` on. */
static void gather_from(dark_sides_search *s, uint32_t side, uint32_t from) {
    const ray_side face = side_of(s->g, side);
    const uint32_t first = s->found_first[side], count = s->found_first[side + 1] - first;
    float sum = 0.0f;
    for (uint32_t i = from; i < count; i++) {
        float distance;
        const uint32_t found = dark_sides_look(s, side, &face, i, &distance);
        s->found[first + i] = found;
        sum += found != RAY_NOTHING ? distance : 0.0f;
    }
    s->path[side] += sum;
    atomic_fetch_add_explicit(&s->shot, count - from, memory_order_relaxed);
}

/* Step 2. */
static void gather(void *user, uint32_t side) {
    dark_sides_search *s = user;
    gather_from(s, side, 0);
    const double flux = (double)atomic_load_explicit(s->flux + side, memory_order_relaxed) / FLUX_ONE;
    s->direct[side] = (float)(flux / (double)s->area[side / 2]);
    s->irradiance[side] = s->direct[side];
}

/* Step 3. */
static void reflect_once(void *user, uint32_t side) {
    dark_sides_search *s = user;
    const uint32_t *found = s->found + s->found_first[side], count = s->found_first[side + 1] - s->found_first[side];
    float sum = 0.0f;
    for (uint32_t i = 0; i < count; i++)
        sum += found[i] < s->sides ? s->irradiance[found[i]] : 0.0f;
    s->next_irradiance[side] = s->direct[side] + DARK_SIDES_ALBEDO / (float)count * sum;
    if (sum > 0.0f && !(s->irradiance[side] > 0.0f))
        atomic_fetch_add_explicit(&s->newly_reached, 1, memory_order_relaxed);
}

/* Of all sides, in the unit of power. */
static double all_flux(const dark_sides_search *s) {
    double flux = 0.0;
    for (uint32_t side = 0; side < s->sides; side++)
        flux += (double)s->area[side / 2] * (double)s->irradiance[side];
    return flux;
}

static void solve(dark_sides_search *s, unsigned threads) {
    double flux = all_flux(s);
    for (int i = 0, still = 0; i < ITERATIONS && still < STILL; i++) {
        atomic_store(&s->newly_reached, 0);
        parallel_for(threads, s->sides, reflect_once, s);
        float *last = s->irradiance;
        s->irradiance = s->next_irradiance;
        s->next_irradiance = last;
        const double before = flux;
        flux = all_flux(s);
        still = atomic_load(&s->newly_reached) == 0 && flux <= before * (1.0 + NEWS) ? still + 1 : 0;
    }
}

/* Mirrors and glass hand light on, and are neither lit nor dark. */
static bool is_matt(const dark_sides_search *s, uint32_t side) {
    return side_material(s->m, s->g, side)->kind == VIT_MATTE;
}

/* Mean length of the ways between sides, m, each with the light that goes it; light that leaves the scene goes none. 0: all
 * does. */
static double mean_free_path(const dark_sides_search *s) {
    double sum = 0.0, light = 0.0;
    for (uint32_t side = 0; side < s->sides; side++) {
        if (!is_matt(s, side))
            continue;
        const double flux = (double)s->area[side / 2] * (double)s->irradiance[side];
        const uint32_t first = s->found_first[side], end = s->found_first[side + 1];
        uint32_t finds = 0;
        for (uint32_t i = first; i < end; i++)
            finds += s->found[i] != RAY_NOTHING;
        sum += flux * (double)s->path[side] / (end - first);
        light += flux * finds / (end - first);
    }
    return light > 0.0 ? sum / light : 0.0;
}

/* Irradiance below which a side is dark; 0: none is. */
static float threshold_of(const dark_sides_search *s) {
    double mean = 0.0, area = 0.0;
    for (uint32_t side = 0; side < s->sides; side++) {
        const double a = is_matt(s, side) ? (double)s->area[side / 2] : 0.0;
        mean += a * (double)s->irradiance[side];
        area += a;
    }
    return area > 0.0 ? (float)((double)DARK_SIDES_THRESHOLD * mean / area) : 0.0f;
}

static void gather_added(void *user, uint32_t side) {
    dark_sides_search *s = user;
    if (s->more[side] > 0)
        gather_from(s, side, s->found_first[side + 1] - s->found_first[side] - s->more[side]);
}

/* Makes room for the rays that sides get. False: out of memory. */
static bool make_room(dark_sides_search *s) {
    uint64_t sum = 0;
    for (uint32_t side = 0; side < s->sides; side++)
        sum += s->more[side];
    const uint32_t all = s->found_first[s->sides];
    uint32_t *found = sum <= UINT32_MAX - all ? realloc(s->found, (size_t)(all + sum) * sizeof *found) : NULL;
    if (!found)
        return false;
    s->found = found;
    uint32_t more = (uint32_t)sum;
    for (uint32_t side = s->sides; side > 0; side--) { /* from the end, where the room is */
        const uint32_t first = s->found_first[side - 1], count = s->found_first[side] - first;
        s->found_first[side] += more;
        more -= s->more[side - 1];
        memmove(found + first + more, found + first, count * sizeof *found);
    }
    return true;
}

bool dark_sides_gather_more(dark_sides_search *s, unsigned threads) {
    if (!make_room(s))
        return false;
    parallel_for(threads, s->sides, gather_added, s);
    solve(s, threads);
    return true;
}

static uint32_t patches(const dark_sides_search *s) {
    return (s->m->triangles + PATCH_TRIANGLES - 1) / PATCH_TRIANGLES;
}

static void set_threshold(dark_sides_search *s) {
    s->threshold = threshold_of(s);
    for (uint32_t side = 0; side < s->sides; side++)
        s->least[side] = s->threshold;
}

/* Step 4. False: out of memory. */
static bool look_closer(dark_sides_search *s, unsigned threads) {
    parallel_for(threads, patches(s), dark_sides_find_faint, s);
    if (!dark_sides_gather_more(s, threads))
        return false;
    set_threshold(s);
    return true;
}

/* False: out of memory. */
static bool run_steps(dark_sides_search *s, unsigned threads, dark_sides_progress_fn *progress, void *user) {
    const tracks *t = s->lights.t;
    const uint32_t frames = s->lights.frames;
    parallel_for(threads, s->light_rays, shoot_from_light, s);
    if (progress)
        progress(user, 0.1);
    parallel_for(threads, s->sides, gather, s);
    if (progress)
        progress(user, 0.4);
    solve(s, threads);
    set_threshold(s);
    if (progress)
        progress(user, 0.5);
    if (s->threshold > 0.0f) {
        if (!look_closer(s, threads) || !dark_sides_judge_views(s, t, frames, threads))
            return false;
        if (progress)
            progress(user, 0.6);
        parallel_for(threads, patches(s), dark_sides_ask_patch, s);
    }
    if (progress)
        progress(user, 1.0);
    return true;
}

static void flag_dark_sides(const dark_sides_search *s, dark_sides *out) {
    out->rays = atomic_load(&s->shot);
    for (uint32_t side = 0; side < s->sides; side++) {
        const double area = (double)s->area[side / 2];
        if (!is_matt(s, side))
            continue;
        out->area += area;
        if (s->lit[side] || !(s->threshold > 0.0f))
            continue;
        *(side & 1 ? &out->dark_back : &out->dark_front) += area;
        s->g->attributes[side / 2].material |= side & 1 ? VIT_SIDE_DARK_BACK : VIT_SIDE_DARK_FRONT;
        out->dark_sides++;
    }
}

static double seconds(void) {
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static uint32_t between(uint32_t least, uint64_t x, uint32_t most) {
    return x < least ? least : x > most ? most : (uint32_t)x;
}

/* How many rays each side shoots in step 2. False: out of memory. */
static bool share_rays(dark_sides_search *s) {
    s->found_first = malloc(((size_t)s->sides + 1) * sizeof *s->found_first);
    if (!s->found_first)
        return false;
    s->found_first[0] = 0;
    for (uint32_t side = 0; side < s->sides; side++)
        s->found_first[side + 1] = s->found_first[side] + s->gathered + (uint32_t)(dark_sides_part(s, side) * GATHERED_BY_AREA);
    s->found = malloc((size_t)s->found_first[s->sides] * sizeof *s->found);
    return s->found != NULL;
}

static bool allocate(dark_sides_search *s) {
    s->flux = calloc(s->sides, sizeof *s->flux);
    s->direct = malloc(s->sides * sizeof *s->direct);
    s->irradiance = malloc(s->sides * sizeof *s->irradiance);
    s->next_irradiance = malloc(s->sides * sizeof *s->next_irradiance);
    s->path = calloc(s->sides, sizeof *s->path);
    s->least = malloc(s->sides * sizeof *s->least);
    s->lit = calloc(s->sides, sizeof *s->lit);
    s->more = calloc(s->sides, sizeof *s->more);
    return share_rays(s) && s->flux && s->direct && s->irradiance && s->next_irradiance && s->path && s->least && s->lit &&
           s->more;
}

static void release(dark_sides_search *s) {
    ray_scene_close(&s->rays);
    lights_close(&s->lights);
    free(s->area);
    free(s->flux);
    free(s->found);
    free(s->found_first);
    free(s->direct);
    free(s->irradiance);
    free(s->next_irradiance);
    free(s->path);
    free(s->least);
    free(s->lit);
    free(s->more);
}

/* Areas and lights. False: out of memory. */
static bool prepare(dark_sides_search *s, const tracks *t, uint32_t frames, bool sky) {
    s->area = malloc(s->m->triangles * sizeof *s->area);
    for (uint32_t i = 0; s->area && i < s->m->triangles; i++) {
        s->area[i] = (float)triangle_area(s->g->triangles + i);
        s->whole += (double)s->area[i];
    }
    return s->area && lights_open(s, t, frames, sky);
}

vit_status dark_sides_find(const dark_sides_input *in, geometry *g, dark_sides *out, vit_text *why) {
    const model *m = in->model;
    const double start = seconds();
    *out = (dark_sides){0};
    dark_sides_search s = {.g = g, .m = m, .sides = 2 * m->triangles};
    s.light_rays = between(LEAST_LIGHT_RAYS, 2 * (uint64_t)s.sides, MOST_LIGHT_RAYS);
    s.gathered = between(LEAST_GATHERED, GATHERED / s.sides, MOST_GATHERED);
    const bool fine = prepare(&s, in->tracks, in->frames, in->sky_light);
    vit_status status = VIT_OK;
    if (fine && !lights_emit(&s.lights)) {
        release(&s);
        return VIT_OK;
    }
    if (!fine || !allocate(&s) || !ray_scene_open(m, g, in->threads, &s.rays) ||
        !run_steps(&s, in->threads, in->progress, in->user)) {
        status = bake_fail(why, VIT_FAILED, "dark sides: out of memory, or Embree fails");
    } else {
        out->free_path = mean_free_path(&s);
        flag_dark_sides(&s, out);
    }
    release(&s);
    out->seconds = seconds() - start;
    return status;
}
