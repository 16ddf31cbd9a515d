/* Step 5 of dark_sides.c. A room behind a slit may be far dimmer than what lies outside, and still be all that a frame shows:
 * what is dark there is judged by the light that the frame sees. A frame's level is the irradiance that 9 of 10 of the matt
 * places in it do not reach, so that one that looks at unlit backs with some light beside them is as bright as that light; its
 * threshold is DARK_SIDES_VIEW of that. Frames for which this is less than the scene's threshold are dim, and what they see has
 * theirs: sides that rays through their picture find, and those whose own rays, a few, find their eye. What no dim frame sees,
 * above all insides of walls, keeps the scene's. */
#include "common/parallel.h"
#include "dark_sides/parts.h"
#include <math.h>
#include <stdlib.h>

#define MOST_VIEWS 256u  /* frames looked at, evenly over the path */
#define VIEW_RAYS 65536u /* of all of them, as many of each, between these */
#define LEAST_RAYS 256u
#define MOST_RAYS 4096u         /* and so many of a dim one */
#define GATHERED_DIM (1u << 17) /* rays of step 2 that sides seen by dim frames get more */
#define EYE_RAYS 16u            /* of a side, towards the eyes of dim frames */
#define BELOW_LEVEL 0.9         /* share of a frame's matt places */
#define NEARLY_LIT 100.0f       /* thresholds of the scene: sides with more irradiance are lit in any case */
#define VIEW_STREAM 0x5eed0000u /* of the rays' sequences, for the first frame */

typedef struct views {
    dark_sides_search *s;
    const tracks *t;
    uint32_t frames, count, dim;   /* of the path; looked at; dim */
    float threshold[MOST_VIEWS];   /* of a frame looked at */
    uint32_t dim_view[MOST_VIEWS]; /* of those looked at */
    uint32_t *found;               /* sides that rays of dim frames found, MOST_RAYS each */
} views;

static vec vec_of(const float p[3]) {
    return (vec){p[0], p[1], p[2]};
}

static const vit_camera *camera_of(const views *v, uint32_t view) {
    return v->t->cameras + (uint64_t)view * v->frames / v->count;
}

/* Pixels across a picture whose middle is straight ahead. */
static float extent(const float corner[3], const float step[3]) {
    const float across = corner[0] * step[0] + corner[1] * step[1] + corner[2] * step[2];
    const float square = step[0] * step[0] + step[1] * step[1] + step[2] * step[2];
    return square > 0.0f ? -2.0f * across / square : 0.0f;
}

/* The side that the ray through some point of the picture finds. */
static uint32_t look_from(const views *v, uint32_t view, uint32_t ray) {
    const vit_camera *c = camera_of(v, view);
    const uint32_t stream = VIEW_STREAM + view;
    const float x = extent(c->corner, c->right) * sequence(stream, ray, 0),
                y = extent(c->corner, c->down) * sequence(stream, ray, 1);
    float d[3], length = 0.0f, distance = INFINITY;
    for (int k = 0; k < 3; k++) {
        d[k] = c->corner[k] + x * c->right[k] + y * c->down[k];
        length += d[k] * d[k];
    }
    length = sqrtf(length);
    if (!(length > 0.0f)) /* no camera */
        return RAY_NOTHING;
    return ray_scene_follow(&v->s->rays, vec_of(c->eye), (vec){d[0] / length, d[1] / length, d[2] / length}, stream + ray,
                            &distance);
}

static int in_order(const void *a, const void *b) {
    const float x = *(const float *)a, y = *(const float *)b;
    return x < y ? -1 : x > y;
}

/* Irradiance of `count` places, which it sorts, to threshold. */
static float threshold_of(const views *v, float *seen, uint32_t count) {
    if (count > 0)
        qsort(seen, count, sizeof *seen, in_order);
    const float level = count > 0 ? seen[(uint32_t)(BELOW_LEVEL * (double)(count - 1))] : 0.0f;
    return fminf(DARK_SIDES_VIEW * level, v->s->threshold);
}

static void judge_view(void *user, uint32_t view) {
    views *v = user;
    float seen[MOST_RAYS];
    uint32_t count = 0, rays = VIEW_RAYS / v->count;
    rays = rays < LEAST_RAYS ? LEAST_RAYS : rays > MOST_RAYS ? MOST_RAYS : rays;
    for (uint32_t ray = 0; ray < rays; ray++) {
        const uint32_t side = look_from(v, view, ray);
        if (side < v->s->sides)
            seen[count++] = v->s->irradiance[side];
    }
    v->threshold[view] = count > 0 ? threshold_of(v, seen, count) : v->s->threshold;
    atomic_fetch_add_explicit(&v->s->shot, rays, memory_order_relaxed);
}

/* The same of a dim frame, with more rays; of one without any light that of the scene. */
static void judge_dim_view(void *user, uint32_t dim) {
    views *v = user;
    float seen[MOST_RAYS];
    uint32_t count = 0;
    for (uint32_t ray = 0; ray < MOST_RAYS; ray++) {
        const uint32_t side = v->found[(size_t)dim * MOST_RAYS + ray];
        if (side < v->s->sides)
            seen[count++] = v->s->irradiance[side];
    }
    const float threshold = threshold_of(v, seen, count);
    v->threshold[v->dim_view[dim]] = threshold > 0.0f ? threshold : v->s->threshold;
}

static void look_around(void *user, uint32_t dim) {
    views *v = user;
    for (uint32_t ray = 0; ray < MOST_RAYS; ray++)
        v->found[(size_t)dim * MOST_RAYS + ray] = look_from(v, v->dim_view[dim], ray);
    atomic_fetch_add_explicit(&v->s->shot, MOST_RAYS, memory_order_relaxed);
}

/* Direct light of a side that dim frames see, where none was found: as many shadow rays as it gathers more rays. */
static void ask_for_light(void *user, uint32_t side) {
    dark_sides_search *s = ((views *)user)->s;
    const uint32_t rays = s->more[side];
    if (rays == 0 || s->direct[side] > 0.0f)
        return;
    const ray_side from = side_of(s->g, side);
    float sum = 0.0f;
    for (uint32_t i = 0; i < rays; i++)
        sum += lights_ask(s, side, &from, i);
    s->direct[side] = sum / (float)rays;
    atomic_fetch_add_explicit(&s->shot, rays, memory_order_relaxed);
}

/* What dim frames see gets more rays, by its share of their pictures: of a room that is a thousandth of the scene the rays
 * before may all have missed the slit by which its light comes. False: out of memory. */
static bool look_closer(views *v, unsigned threads) {
    dark_sides_search *s = v->s;
    const size_t all = (size_t)v->dim * MOST_RAYS;
    if (all == 0)
        return true;
    for (uint32_t side = 0; side < s->sides; side++)
        s->more[side] = 0;
    for (size_t i = 0; i < all; i++)
        if (v->found[i] < s->sides)
            s->more[v->found[i]]++;
    for (uint32_t side = 0; side < s->sides; side++)
        s->more[side] = (uint32_t)(((uint64_t)s->more[side] * GATHERED_DIM + all - 1) / all);
    parallel_for(threads, s->sides, ask_for_light, v);
    return dark_sides_gather_more(s, threads);
}

/* Of a side that may be too small to be found, by its own rays. */
static void look_for_eyes(void *user, uint32_t side) {
    const views *v = user;
    dark_sides_search *s = v->s;
    if (s->irradiance[side] >= NEARLY_LIT * s->threshold || side_material(s->m, s->g, side)->kind != VIT_MATTE)
        return;
    const ray_side from = side_of(s->g, side);
    uint32_t shot = 0;
    for (uint32_t i = 0; i < EYE_RAYS; i++) {
        const uint32_t dim = (uint32_t)(side_sequence(&from, i, 2) * (float)v->dim), view = v->dim_view[dim < v->dim ? dim : 0];
        if (!(v->threshold[view] < s->least[side]))
            continue;
        const vec o = side_point(&from, side_sequence(&from, i, 0), side_sequence(&from, i, 1)), n = from.normal;
        const vec eye = vec_of(camera_of(v, view)->eye), to = {eye.x - o.x, eye.y - o.y, eye.z - o.z};
        const float distance = sqrtf(to.x * to.x + to.y * to.y + to.z * to.z);
        if (!(to.x * n.x + to.y * n.y + to.z * n.z > 0.0f))
            continue;
        shot++;
        if (ray_scene_passes(&s->rays, o, (vec){to.x / distance, to.y / distance, to.z / distance}, distance))
            s->least[side] = v->threshold[view];
    }
    atomic_fetch_add_explicit(&s->shot, shot, memory_order_relaxed);
}

static void lower_thresholds(views *v, unsigned threads) {
    dark_sides_search *s = v->s;
    for (size_t i = 0; i < (size_t)v->dim * MOST_RAYS; i++)
        if (v->found[i] < s->sides)
            s->least[v->found[i]] = fminf(s->least[v->found[i]], v->threshold[v->dim_view[i / MOST_RAYS]]);
    parallel_for(threads, s->sides, look_for_eyes, v);
}

bool dark_sides_judge_views(dark_sides_search *s, const tracks *t, uint32_t frames, unsigned threads) {
    views v = {.s = s, .t = t, .frames = frames, .count = frames < MOST_VIEWS ? frames : MOST_VIEWS};
    if (!t->cameras)
        return true;
    parallel_for(threads, v.count, judge_view, &v);
    for (uint32_t view = 0; view < v.count; view++)
        if (v.threshold[view] < s->threshold)
            v.dim_view[v.dim++] = view;
    if (v.dim == 0)
        return true;
    v.found = malloc((size_t)v.dim * MOST_RAYS * sizeof *v.found);
    if (!v.found)
        return false;
    parallel_for(threads, v.dim, look_around, &v);
    const bool fine = look_closer(&v, threads);
    if (fine) {
        parallel_for(threads, v.dim, judge_dim_view, &v);
        lower_thresholds(&v, threads);
    }
    free(v.found);
    return fine;
}
