/* Dark sides, by a small radiosity solution over the sides of triangles:
 *   1. rays from the lights, over all frames and directions, give each side its direct irradiance;
 *   2. every side shoots GATHER_RAYS rays about its normal and notes which sides they find;
 *   3. E = direct + albedo * mean of E over what the rays found, repeated until light has gone everywhere (Jacobi);
 *   4. sides below the threshold ask again, with more rays of their own and rays towards the lights: triangles too small
 *      for 1 and 2 are not darkened by bad luck.
 *
 * Sums over threads are integers, everything else is computed by one thread in a fixed order: the result does not depend on
 * threads. In doubt a side is lit: all surfaces reflect more than most real ones, lights have no range, cut-outs stop no ray.
 * Every light that shines at all gives the same power; all together 1, and irradiance is in that unit a m2. */
#include "reach.h"
#include "parallel.h"
#include "reach_rays.h"
#include <math.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#define LIGHT_RAYS (1u << 20)
#define LIGHT_STREAM 0xffffffffu
#define GATHER_RAYS 16u /* of a side in step 2 */
#define ASK_LIGHTS 16u  /* in step 4 */
#define ASK_RAYS 96u
#define ITERATIONS 40   /* 0.8^40 = 1e-4 */
#define FLUX_ONE 0x1p56 /* fixed point of direct flux: all sides' sum is at most the lights' power, 1 */

typedef struct search {
    const tracks *t;
    geometry *g;
    uint32_t frames, sides;
    ray_scene rays;
    double power;        /* of all lights, mean over the frames, W */
    atomic_ullong *flux; /* a side, direct, in 1 / FLUX_ONE of all lights' power */
    uint32_t *found;     /* GATHER_RAYS a side */
    float *direct, *irradiance, *next_irradiance;
    float *path;         /* a side: summed length of the rays of step 2 that found something, m */
    float threshold;
    atomic_ullong shot;
} search;

static double mean_intensity(const vit_light *l) {
    return ((double)l->intensity[0] + (double)l->intensity[1] + (double)l->intensity[2]) / 3.0;
}

static double solid_angle(const vit_light *l) {
    return 6.283185307179586 * (l->kind == VIT_LIGHT_SPOT ? 1.0 - (double)l->cos_outer : 2.0);
}

/* Even over the light's sphere or cone. */
static vec light_direction(const vit_light *l, float u, float v) {
    const bool spot = l->kind == VIT_LIGHT_SPOT;
    const float z = 1.0f - u * (spot ? 1.0f - l->cos_outer : 2.0f), r = sqrtf(fmaxf(0.0f, 1.0f - z * z)), phi = 6.2831853f * v;
    const vec n = spot ? (vec){l->direction[0], l->direction[1], l->direction[2]} : (vec){0.0f, 0.0f, 1.0f};
    const float sign = copysignf(1.0f, n.z), a = -1.0f / (sign + n.z), b = n.x * n.y * a, x = r * cosf(phi), y = r * sinf(phi);
    return (vec){(1.0f + sign * n.x * n.x * a) * x + b * y + n.x * z, sign * b * x + (sign + n.y * n.y * a) * y + n.y * z,
                 -sign * n.x * x - n.y * y + n.z * z};
}

/* Step 1: a ray of one light, from its place in one frame. */
static void shoot_from_light(void *user, uint32_t ray) {
    search *s = user;
    const uint32_t light = ray % s->t->light_count, frame = (uint32_t)((uint64_t)ray * s->frames / LIGHT_RAYS);
    const vit_light *l = s->t->lights + (size_t)frame * s->t->light_count + light;
    const double power = mean_intensity(l) * solid_angle(l);
    if (!(power > 0.0))
        return;
    const vec origin = {l->position[0], l->position[1], l->position[2]};
    const vec direction = light_direction(l, sequence(LIGHT_STREAM, ray, 0), sequence(LIGHT_STREAM, ray, 1));
    float distance = INFINITY;
    const uint32_t side = ray_scene_cast(&s->rays, origin, direction, &distance);
    const double share = 1.0 / LIGHT_RAYS; /* every light counts alike: a weak one may be all that a room has */
    if (side < s->sides)
        atomic_fetch_add_explicit(s->flux + side, (unsigned long long)(share * FLUX_ONE), memory_order_relaxed);
    atomic_fetch_add_explicit(&s->shot, 1, memory_order_relaxed);
}

/* What ray `i` of a side finds, and how far away. */
static uint32_t look(const search *s, uint32_t side, uint32_t i, float *distance) {
    const vec origin = side_point(s->g, side, sequence(side, i, 0), sequence(side, i, 1));
    const vec direction = cosine_direction(side_normal(s->g, side), sequence(side, i, 2), sequence(side, i, 3));
    *distance = INFINITY;
    return ray_scene_cast(&s->rays, origin, direction, distance);
}

/* Step 2. */
static void gather(void *user, uint32_t side) {
    search *s = user;
    float sum = 0.0f;
    for (uint32_t i = 0; i < GATHER_RAYS; i++) {
        float distance;
        const uint32_t found = look(s, side, i, &distance);
        s->found[(size_t)side * GATHER_RAYS + i] = found;
        sum += found != RAY_NOTHING ? distance : 0.0f;
    }
    s->path[side] = sum;
    const double area = triangle_area(s->g->triangles + side / 2);
    s->direct[side] = (float)((double)atomic_load_explicit(s->flux + side, memory_order_relaxed) / FLUX_ONE / area);
    s->irradiance[side] = s->direct[side];
    atomic_fetch_add_explicit(&s->shot, GATHER_RAYS, memory_order_relaxed);
}

static float irradiance_of(const search *s, uint32_t found) {
    return found < s->sides ? s->irradiance[found] : 0.0f;
}

/* Step 3. */
static void reflect_once(void *user, uint32_t side) {
    search *s = user;
    float sum = 0.0f;
    for (uint32_t i = 0; i < GATHER_RAYS; i++)
        sum += irradiance_of(s, s->found[(size_t)side * GATHER_RAYS + i]);
    s->next_irradiance[side] = s->direct[side] + REACH_ALBEDO / (float)GATHER_RAYS * sum;
}

static void solve(search *s, unsigned threads) {
    for (int i = 0; i < ITERATIONS; i++) {
        parallel_for(threads, s->sides, reflect_once, s);
        float *last = s->irradiance;
        s->irradiance = s->next_irradiance;
        s->next_irradiance = last;
    }
}

static uint32_t pick(float u, uint32_t count) {
    const uint32_t i = (uint32_t)(u * (float)count);
    return i < count ? i : count - 1;
}

/* Direct irradiance of a side, estimated by shadow ray `i` to some light in some frame. */
static float ask_light(const search *s, uint32_t side, uint32_t i) {
    const uint32_t light = pick(sequence(side, i, 2), s->t->light_count);
    const uint32_t frame = pick(sequence(side, i, 3), s->frames);
    const vit_light *l = s->t->lights + (size_t)frame * s->t->light_count + light;
    const vec n = side_normal(s->g, side), o = side_point(s->g, side, sequence(side, i, 0), sequence(side, i, 1));
    const vec to = {l->position[0] - o.x, l->position[1] - o.y, l->position[2] - o.z};
    const float d = fmaxf(sqrtf(to.x * to.x + to.y * to.y + to.z * to.z), s->g->ray_offset);
    float within = d;
    const vec unit = {to.x / d, to.y / d, to.z / d};
    const float cosine = unit.x * n.x + unit.y * n.y + unit.z * n.z;
    const float axis = -(unit.x * l->direction[0] + unit.y * l->direction[1] + unit.z * l->direction[2]);
    const bool in_cone = l->kind != VIT_LIGHT_SPOT || axis >= l->cos_outer;
    if (!in_cone || !(cosine > 0.0f) || ray_scene_cast(&s->rays, o, unit, &within) != RAY_NOTHING)
        return 0.0f;
    return mean_intensity(l) > 0.0 ? cosine / (d * d) / (float)solid_angle(l) : 0.0f;
}

/* Step 4. A side that any light shines on is lit, however weakly; the threshold is for reflected light alone. What is enough
 * ends the search. */
static void ask_again(void *user, uint32_t side) {
    search *s = user;
    float found = s->irradiance[side], reflected = 0.0f;
    uint32_t rays = 0;
    float distance;
    if (s->direct[side] > 0.0f)
        found = fmaxf(found, s->threshold);
    for (uint32_t i = 0; i < ASK_LIGHTS && found < s->threshold; i++, rays++)
        if (ask_light(s, side, i) > 0.0f)
            found = s->threshold;
    for (uint32_t i = 0; i < ASK_RAYS && fmaxf(found, reflected) < s->threshold; i++, rays++)
        reflected += REACH_ALBEDO / (float)ASK_RAYS * irradiance_of(s, look(s, side, GATHER_RAYS + i, &distance));
    s->next_irradiance[side] = fmaxf(found, reflected);
    atomic_fetch_add_explicit(&s->shot, rays, memory_order_relaxed);
}

/* Mean length of the ways between sides, m, each with the light that goes it; light that leaves the scene goes none. 0: all does. */
static double mean_free_path(const search *s) {
    double sum = 0.0, light = 0.0;
    for (uint32_t side = 0; side < s->sides; side++) {
        const double flux = triangle_area(s->g->triangles + side / 2) * (double)s->irradiance[side];
        uint32_t finds = 0;
        for (uint32_t i = 0; i < GATHER_RAYS; i++)
            finds += s->found[(size_t)side * GATHER_RAYS + i] != RAY_NOTHING;
        sum += flux * (double)s->path[side];
        light += flux * finds;
    }
    return light > 0.0 ? sum / light : 0.0;
}

static void run_steps(search *s, unsigned threads, reach_progress_fn *progress, void *user) {
    parallel_for(threads, LIGHT_RAYS, shoot_from_light, s);
    if (progress)
        progress(user, 0.1);
    parallel_for(threads, s->sides, gather, s);
    if (progress)
        progress(user, 0.5);
    solve(s, threads);
    double mean = 0.0, area = 0.0;
    for (uint32_t side = 0; side < s->sides; side++) {
        const double a = triangle_area(s->g->triangles + side / 2);
        mean += a * (double)s->irradiance[side];
        area += a;
    }
    s->threshold = (float)((double)REACH_THRESHOLD * mean / area);
    if (progress)
        progress(user, 0.6);
    parallel_for(threads, s->sides, ask_again, s);
    if (progress)
        progress(user, 1.0);
}

static void flag_dark_sides(const search *s, reach *out) {
    out->rays = atomic_load(&s->shot);
    for (uint32_t side = 0; side < s->sides; side++) {
        const double area = triangle_area(s->g->triangles + side / 2);
        out->area += area;
        if (s->next_irradiance[side] >= s->threshold)
            continue;
        *(side & 1 ? &out->dark_back : &out->dark_front) += area;
        s->g->attributes[side / 2].material |= side & 1 ? VIT_SIDE_DARK_BACK : VIT_SIDE_DARK_FRONT;
        out->dark_sides++;
    }
}

/* Mean over the frames of all lights' power, W. */
static double total_power(const tracks *t, uint32_t frames) {
    double sum = 0.0;
    for (size_t i = 0; i < (size_t)frames * t->light_count; i++)
        sum += mean_intensity(t->lights + i) * solid_angle(t->lights + i);
    return frames ? sum / frames : 0.0;
}

static double seconds(void) {
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static bool allocate(search *s) {
    s->flux = calloc(s->sides, sizeof *s->flux);
    s->found = malloc((size_t)s->sides * GATHER_RAYS * sizeof *s->found);
    s->direct = malloc(s->sides * sizeof *s->direct);
    s->irradiance = malloc(s->sides * sizeof *s->irradiance);
    s->next_irradiance = malloc(s->sides * sizeof *s->next_irradiance);
    s->path = malloc(s->sides * sizeof *s->path);
    return s->flux && s->found && s->direct && s->irradiance && s->next_irradiance && s->path;
}

static void release(search *s) {
    ray_scene_close(&s->rays);
    free(s->flux);
    free(s->found);
    free(s->direct);
    free(s->irradiance);
    free(s->next_irradiance);
    free(s->path);
}

vit_status reach_dark_sides(const model *m, const tracks *t, uint32_t frames, geometry *g, unsigned threads,
                            reach_progress_fn *progress, void *user, reach *out, vit_text *why) {
    const double start = seconds();
    *out = (reach){0};
    search s = {.t = t, .g = g, .frames = frames, .sides = 2 * m->triangles, .power = total_power(t, frames)};
    if (!(s.power > 0.0))
        return VIT_OK;
    vit_status status = VIT_OK;
    if (!allocate(&s) || !ray_scene_open(m, g, threads, &s.rays)) {
        snprintf(why->text, sizeof why->text, "dark sides: out of memory, or Embree fails");
        status = VIT_FAILED;
    } else {
        run_steps(&s, threads, progress, user);
        out->free_path = mean_free_path(&s);
        flag_dark_sides(&s, out);
    }
    release(&s);
    out->seconds = seconds() - start;
    return status;
}
