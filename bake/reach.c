/* Dark sides, by a small radiosity solution over the sides of triangles:
 *   1. rays from the lights (points, directions, area lights, the sky), over all frames and directions, give each side its
 * direct irradiance;
 *   2. every side shoots GATHER_RAYS rays about its normal and notes which sides they find;
 *   3. E = direct + albedo * mean of E over what the rays found, repeated until light has gone everywhere (Jacobi);
 *   4. sides below the threshold ask again, with more rays of their own and rays towards the lights: triangles too small
 *      for 1 and 2 are not darkened by bad luck.
 *
 * Sums over threads are integers, everything else is computed by one thread in a fixed order: the result does not depend on
 * threads. In doubt a side is lit: all surfaces reflect more than most real ones, lights have no range, cut-outs stop no ray,
 * mirrors and glass send light on, the sky shines alike all round. They themselves are never dark: no photon is stored there.
 * Every light that shines at all gives the same power, area lights together and the sky as one each; all together 1, and
 * irradiance is in that unit a m2. */
#include "reach.h"
#include "parallel.h"
#include "reach_rays.h"
#include "sky.h"
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
    const model *m;
    uint32_t frames, sides;
    ray_scene rays;
    uint32_t sources; /* the tracks' lights, then the area lights if there are any, then the sky if it shines */
    bool sky;
    uint32_t *lamps;  /* triangles that are area lights */
    double *lamp_sum; /* weights of lamps 0 .. i, by their share of the area and of the number; 2 in all */
    uint32_t lamp_count;
    vec center; /* of a sphere round the scene */
    float radius;
    atomic_ullong *flux; /* a side, direct, in 1 / FLUX_ONE of all lights' power */
    uint32_t *found;     /* GATHER_RAYS a side */
    float *direct, *irradiance, *next_irradiance;
    float *path; /* a side: summed length of the rays of step 2 that found something, m */
    float threshold;
    atomic_ullong shot;
} search;

static double mean_intensity(const vit_light *l) {
    return ((double)l->intensity[0] + (double)l->intensity[1] + (double)l->intensity[2]) / 3.0;
}

static vec plus(vec a, float s, vec b) {
    return (vec){a.x + s * b.x, a.y + s * b.y, a.z + s * b.z};
}

static vec vec_of(const float p[3]) {
    return (vec){p[0], p[1], p[2]};
}

/* x and y along axes across the unit vector n, z along it (Duff et al. 2017). */
static vec about(vec n, float x, float y, float z) {
    const float sign = copysignf(1.0f, n.z), a = -1.0f / (sign + n.z), b = n.x * n.y * a;
    return (vec){(1.0f + sign * n.x * n.x * a) * x + b * y + n.x * z, sign * b * x + (sign + n.y * n.y * a) * y + n.y * z,
                 -sign * n.x * x - n.y * y + n.z * z};
}

/* Even over the cone cos >= least about n; the whole sphere for -1. */
static vec cone_direction(vec n, float least, float u, float v) {
    const float z = 1.0f - u * (1.0f - least), r = sqrtf(fmaxf(0.0f, 1.0f - z * z)), phi = 6.2831853f * v;
    return about(n, r * cosf(phi), r * sinf(phi), z);
}

static vec disc_point(vec center, vec n, float radius, float u, float v) {
    const float r = radius * sqrtf(u), phi = 6.2831853f * v;
    return plus(center, 1.0f, about(n, r * cosf(phi), r * sinf(phi), 0.0f));
}

static const vit_light *light_of(const search *s, uint32_t source, uint32_t frame) {
    return s->t->lights + (size_t)frame * s->t->light_count + source;
}

static bool is_sky(const search *s, uint32_t source) {
    return s->sky && source + 1 == s->sources;
}

static uint32_t choose_lamp(const search *s, float x) {
    uint32_t low = 0, high = s->lamp_count - 1;
    while (low < high) {
        const uint32_t middle = (low + high) / 2;
        if (s->lamp_sum[middle] > 2.0 * (double)x)
            high = middle;
        else
            low = middle + 1;
    }
    return s->lamps[low];
}

/* Ray `ray` of a source, in one frame. False: it does not shine, or not from there. */
static bool leave(const search *s, uint32_t source, uint32_t frame, uint32_t ray, vec *origin, vec *direction) {
    const float a = sequence(LIGHT_STREAM, ray, 0), b = sequence(LIGHT_STREAM, ray, 1), c = sequence(LIGHT_STREAM, ray, 2),
                d = sequence(LIGHT_STREAM, ray, 3);
    if (is_sky(s, source)) {
        const vec from = cone_direction((vec){0.0f, 0.0f, 1.0f}, -1.0f, a, b);
        *origin = disc_point(plus(s->center, s->radius, from), from, s->radius, c, d);
        *direction = (vec){-from.x, -from.y, -from.z};
        return true;
    }
    if (source == s->t->light_count) { /* no dimension is left for the lamp and its side */
        const uint32_t side = 2 * choose_lamp(s, sequence(ray, 0, 0)) + (sequence(ray, 0, 1) < 0.5f);
        *origin = side_point(s->g, side, a, b);
        *direction = cosine_direction(side_normal(s->g, side), c, d);
        return !ray_scene_covered(&s->rays, side, *origin);
    }
    const vit_light *l = light_of(s, source, frame);
    *origin = vec_of(l->position);
    if (l->kind == VIT_LIGHT_DIRECTIONAL) {
        *direction = vec_of(l->direction);
        *origin = disc_point(*origin, *direction, l->spot_scale, a, b);
    } else {
        const bool spot = l->kind == VIT_LIGHT_SPOT;
        *direction = cone_direction(spot ? vec_of(l->direction) : (vec){0.0f, 0.0f, 1.0f}, spot ? l->cos_outer : -1.0f, a, b);
    }
    return mean_intensity(l) > 0.0;
}

/* Step 1: a ray of one light, from its place in one frame. */
static void shoot_from_light(void *user, uint32_t ray) {
    search *s = user;
    vec origin, direction;
    if (!leave(s, ray % s->sources, (uint32_t)((uint64_t)ray * s->frames / LIGHT_RAYS), ray, &origin, &direction))
        return;
    float distance = INFINITY;
    const uint32_t side = ray_scene_follow(&s->rays, origin, direction, ray, &distance);
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
    return ray_scene_follow(&s->rays, origin, direction, side + i, distance);
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

/* Does some light in some frame shine on the side, by shadow ray `i`? */
static bool ask_light(const search *s, uint32_t side, uint32_t i) {
    const uint32_t source = pick(sequence(side, i, 2), s->sources), frame = pick(sequence(side, i, 3), s->frames);
    const vec n = side_normal(s->g, side), o = side_point(s->g, side, sequence(side, i, 0), sequence(side, i, 1));
    const uint32_t other = side + i; /* for other numbers */
    if (is_sky(s, source))
        return ray_scene_passes(&s->rays, o, cosine_direction(n, sequence(other, 1, 0), sequence(other, 1, 1)), INFINITY);
    const vit_light *l = source < s->t->light_count ? light_of(s, source, frame) : NULL;
    if (l && !(mean_intensity(l) > 0.0))
        return false;
    vec at = {0.0f, 0.0f, 0.0f}, axis = {0.0f, 0.0f, 0.0f};
    if (l) {
        at = vec_of(l->position);
        axis = vec_of(l->direction);
    } else {
        const uint32_t lamp = 2 * choose_lamp(s, sequence(other, 1, 0));
        const vec front = side_point(s->g, lamp, sequence(other, 1, 1), sequence(other, 1, 2)),
                  across = side_normal(s->g, lamp);
        const bool before = (o.x - front.x) * across.x + (o.y - front.y) * across.y + (o.z - front.z) * across.z > 0.0f;
        at = before ? front : plus(front, -2.0f * s->g->ray_offset, across);
        if (ray_scene_covered(&s->rays, lamp + !before, at))
            return false;
    }
    const vec to = {at.x - o.x, at.y - o.y, at.z - o.z};
    const float d = fmaxf(sqrtf(to.x * to.x + to.y * to.y + to.z * to.z), s->g->ray_offset);
    const bool parallel = l && l->kind == VIT_LIGHT_DIRECTIONAL;
    const vec unit = parallel ? (vec){-axis.x, -axis.y, -axis.z} : (vec){to.x / d, to.y / d, to.z / d};
    if (!(unit.x * n.x + unit.y * n.y + unit.z * n.z > 0.0f))
        return false;
    if (l && l->kind == VIT_LIGHT_SPOT && !(-(unit.x * axis.x + unit.y * axis.y + unit.z * axis.z) >= l->cos_outer))
        return false;
    return ray_scene_passes(&s->rays, o, unit, parallel ? INFINITY : d);
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
        if (ask_light(s, side, i))
            found = s->threshold;
    for (uint32_t i = 0; i < ASK_RAYS && fmaxf(found, reflected) < s->threshold; i++, rays++)
        reflected += REACH_ALBEDO / (float)ASK_RAYS * irradiance_of(s, look(s, side, GATHER_RAYS + i, &distance));
    s->next_irradiance[side] = fmaxf(found, reflected);
    atomic_fetch_add_explicit(&s->shot, rays, memory_order_relaxed);
}

/* Mirrors and glass hand light on, and are neither lit nor dark. */
static bool is_matt(const search *s, uint32_t side) {
    return side_material(s->m, s->g, side)->kind == VIT_MATTE;
}

/* Mean length of the ways between sides, m, each with the light that goes it; light that leaves the scene goes none. 0: all
 * does. */
static double mean_free_path(const search *s) {
    double sum = 0.0, light = 0.0;
    for (uint32_t side = 0; side < s->sides; side++) {
        if (!is_matt(s, side))
            continue;
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
        const double a = is_matt(s, side) ? triangle_area(s->g->triangles + side / 2) : 0.0;
        mean += a * (double)s->irradiance[side];
        area += a;
    }
    s->threshold = area > 0.0 ? (float)((double)REACH_THRESHOLD * mean / area) : 0.0f;
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
        if (!is_matt(s, side))
            continue;
        out->area += area;
        if (s->next_irradiance[side] >= s->threshold)
            continue;
        *(side & 1 ? &out->dark_back : &out->dark_front) += area;
        s->g->attributes[side / 2].material |= side & 1 ? VIT_SIDE_DARK_BACK : VIT_SIDE_DARK_FRONT;
        out->dark_sides++;
    }
}

static bool any_matt(const search *s) {
    for (uint32_t side = 0; side < s->sides; side += 2)
        if (is_matt(s, side))
            return true;
    return false;
}

/* The tracks' lights shine in some frame. */
static bool any_shines(const tracks *t, uint32_t frames) {
    for (size_t i = 0; i < (size_t)frames * t->light_count; i++)
        if (mean_intensity(t->lights + i) > 0.0)
            return true;
    return false;
}

/* False: out of memory. */
static bool find_lamps(search *s) {
    double area = 0.0, sum = 0.0;
    for (uint32_t i = 0; i < s->m->triangles; i++)
        if (material_lights(side_material(s->m, s->g, 2 * i))) {
            area += triangle_area(s->g->triangles + i);
            s->lamp_count++;
        }
    s->lamps = malloc((s->lamp_count + 1u) * sizeof *s->lamps);
    s->lamp_sum = malloc((s->lamp_count + 1u) * sizeof *s->lamp_sum);
    if (!s->lamps || !s->lamp_sum)
        return false;
    for (uint32_t i = 0, k = 0; k < s->lamp_count; i++)
        if (material_lights(side_material(s->m, s->g, 2 * i))) {
            sum += triangle_area(s->g->triangles + i) / area + 1.0 / s->lamp_count;
            s->lamps[k] = i;
            s->lamp_sum[k++] = sum;
        }
    return true;
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
    free(s->lamps);
    free(s->lamp_sum);
}

vit_status reach_dark_sides(const model *m, const tracks *t, uint32_t frames, bool sky_light, geometry *g, unsigned threads,
                            reach_progress_fn *progress, void *user, reach *out, vit_text *why) {
    const double start = seconds();
    *out = (reach){0};
    search s = {.t = t, .g = g, .m = m, .frames = frames, .sides = 2 * m->triangles, .sky = sky_light};
    bool fine = find_lamps(&s);
    s.sources = t->light_count + (s.lamp_count > 0) + sky_light;
    float center[3];
    sky_sphere(m->lo, m->hi, center, &s.radius);
    s.center = vec_of(center);
    vit_status status = VIT_OK;
    if (fine && (!any_matt(&s) || (!sky_light && s.lamp_count == 0 && !any_shines(t, frames)))) {
        release(&s);
        return VIT_OK;
    }
    if (!fine || !allocate(&s) || !ray_scene_open(m, g, threads, &s.rays)) {
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
