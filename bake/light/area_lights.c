#include "light/area_lights.h"
#include "common/fail.h"
#include "common/pi.h"
#include "common/parallel.h"
#include "light/photon_rays.h"
#include "common/sobol.h"
#include <float.h>
#include <stdlib.h>
#include <string.h>

#define OPEN_RAYS (1u << 20) /* in all */
#define OPEN_MOST 64u        /* a side */
#define OPEN_FAR 0.05f       /* of the scene's diagonal: light that goes so far lights more than what touches the area light */
#define EYES_MOST 64u        /* cameras of the path that are asked what they see, and rays of each */
#define OPEN_STEPS 4         /* weights are 1, 1/2, 1/4, 1/8: no photon is more than 8 times as strong as it would be */
#define CLASSES (6 * OPEN_STEPS)
#define NEAR_DISCS 2.0 /* of a point, in area: at its very edge one point is too much of the light */

static vec3 side_normal(const photon_scene *s, uint32_t side) {
    const vit_triangle *t = s->triangles + side / 2;
    return vec3_scale(vec3_unit((vec3){t->nx, t->ny, t->nz}), side & 1 ? -1.0f : 1.0f);
}

static double side_area(const photon_scene *s, uint32_t side) {
    const vit_triangle *t = s->triangles + side / 2;
    return 0.5 * sqrt((double)t->nx * (double)t->nx + (double)t->ny * (double)t->ny + (double)t->nz * (double)t->nz);
}

static const vit_material *side_material(const photon_scene *s, uint32_t side) {
    return s->materials + (s->attributes[side / 2].material & VIT_MATERIAL_INDEX);
}

static double radiance_sum(const vit_material *m) {
    return (double)m->emission[0] + (double)m->emission[1] + (double)m->emission[2];
}

static bool shines(const photon_scene *s, uint32_t side) {
    const vit_material *m = side_material(s, side);
    const uint32_t dark = side & 1 ? VIT_SIDE_DARK_BACK : VIT_SIDE_DARK_FRONT;
    return m->lights && m->kind == VIT_MATTE && radiance_sum(m) > 0 && !(s->attributes[side / 2].material & dark);
}

/* Weights of a point of the triangle, even over it: E. Heitz, A low-distortion map between triangle and square, 2019. */
static void triangle_weights(double x, double y, float b[3]) {
    double b1 = x, b2 = y;
    if (b2 > b1) {
        b1 *= 0.5;
        b2 -= b1;
    } else {
        b2 *= 0.5;
        b1 -= b2;
    }
    b[0] = (float)(1.0 - b1 - b2);
    b[1] = (float)b1;
    b[2] = (float)b2;
}

static vec3 point_of(const photon_scene *s, uint32_t side, const float b[3]) {
    const vit_triangle *t = s->triangles + side / 2;
    const vec3 p = vec3_along(vec3_along(vec3_scale(vec3_load(t->v0), b[0]), vec3_load(t->v1), b[1]), vec3_load(t->v2), b[2]);
    return vec3_along(p, side_normal(s, side), s->ray_offset);
}

#define ESCAPES (VIT_NONE - 1) /* instead of a side that shines: anything else, or nothing */

typedef struct opening {
    const area_lights *e;
    photon_rays rays;
    uint32_t tries;
    float far; /* m */
    uint32_t
        *lights; /* `tries` a side: the place in the list of the side that its light meets, or ESCAPES; VIT_NONE: covered */
    uint8_t *escapes; /* a side: its light gets to what does not shine itself, or to an eye */
} opening;

/* Place in the list of sides that shine; ESCAPES: not there. */
static uint32_t place_in_list(const uint32_t *list, uint32_t count, uint32_t side) {
    uint32_t low = 0, high = count;
    while (low < high) {
        const uint32_t middle = (low + high) / 2;
        if (list[middle] < side)
            low = middle + 1;
        else
            high = middle;
    }
    return low < count && list[low] == side ? low : ESCAPES;
}

static uint32_t side_met(const photon_scene *s, uint32_t triangle, vec3 d) {
    return 2 * triangle + (vec3_dot(side_normal(s, 2 * triangle), d) > 0.0f);
}

/* How open a side lies, 0..1: how far its light goes before it meets anything, at most OPEN_FAR; 0 where it is covered. Mirrors
 * and glass hand it on. */
static void look_out(void *user, uint32_t i) {
    const opening *o = user;
    const photon_scene *s = &o->e->scene;
    const uint32_t side = o->e->side[i];
    const vec3 n = side_normal(s, side);
    double sum = 0;
    vec3 ax, ay;
    vec3_across(n, &ax, &ay);
    for (uint32_t k = 0; k < o->tries; k++) {
        const uint32_t seed = pcg(side) + k;
        float b[3], sp, cp, t = 0;
        triangle_weights(unit_float(seed * 0xdb4f0b91u), unit_float(seed * 0xbbe05633u),
                         b); /* four dimensions of Roberts 2018 */
        const float u = unit_float(seed * 0xa0f2ec75u), r = sqrtf(u), h = sqrtf(float_max(1.0f - u, 4e-4f));
        sincos_turn(unit_float(seed * 0x89e18285u), &sp, &cp);
        const vec3 d = vec3_unit(vec3_along(vec3_along(vec3_scale(n, h), ax, r * cp), ay, r * sp));
        const vec3 from = point_of(s, side, b);
        uint32_t *lights = o->lights + (size_t)i * o->tries + k;
        *lights = VIT_NONE;
        if (photon_rays_covered(&o->rays, side / 2, from, n))
            continue;
        const uint32_t found = photon_rays_nearest(&o->rays, from, d, &t);
        *lights = found == VIT_NONE ? ESCAPES : place_in_list(o->e->side, o->e->count, side_met(s, found, d));
        sum += found == VIT_NONE || side_material(s, 2 * found)->kind != VIT_MATTE || t > o->far ? 1.0 : (double)(t / o->far);
    }
    o->e->sum[i] = sum / o->tries;
}

/* What shines and is seen by an eye: it may be in a room whose walls all shine. */
static void look_from_eyes(opening *o, const vit_camera *cameras, uint32_t frames) {
    const photon_scene *s = &o->e->scene;
    const uint32_t eyes = frames < EYES_MOST ? frames : EYES_MOST;
    for (uint32_t i = 0; i < eyes * EYES_MOST; i++) {
        const vit_camera *c = cameras + (size_t)(i / EYES_MOST) * frames / eyes;
        float sine, cosine, t;
        const float z = fmaf((float)(i % EYES_MOST), 2.0f / EYES_MOST, 1.0f / EYES_MOST - 1.0f);
        sincos_turn(unit_float(i * 0x9e3779b9u), &sine, &cosine); /* a spiral over the sphere */
        const float r = sqrtf(float_max(1.0f - z * z, 0.0f));
        const vec3 d = {r * cosine, z, r * sine};
        const uint32_t found = photon_rays_nearest(&o->rays, vec3_load(c->eye), d, &t);
        const uint32_t at = found == VIT_NONE ? ESCAPES : place_in_list(o->e->side, o->e->count, side_met(s, found, d));
        if (at != ESCAPES)
            o->escapes[at] = 1;
    }
}

/* The inside of a closed body that shines lights nothing but itself: such sides go. */
static void drop_enclosed(opening *o) {
    bool more = true;
    while (more) {
        more = false;
        for (uint32_t i = 0; i < o->e->count; i++)
            for (uint32_t k = 0; k < o->tries && !o->escapes[i]; k++) {
                const uint32_t to = o->lights[(size_t)i * o->tries + k];
                if (to != ESCAPES && (to == VIT_NONE || !o->escapes[to]))
                    continue;
                o->escapes[i] = 1;
                more = true;
            }
    }
    for (uint32_t i = 0; i < o->e->count; i++)
        o->e->sum[i] = o->escapes[i] ? o->e->sum[i] : 0.0;
}

static float diagonal(const photon_scene *s) {
    vec3 lo = vec3_load(s->triangles[0].v0), hi = lo;
    for (uint32_t i = 0; i < s->triangle_count; i++) {
        const float *v[3] = {s->triangles[i].v0, s->triangles[i].v1, s->triangles[i].v2};
        for (int k = 0; k < 3; k++) {
            lo = (vec3){float_min(lo.x, v[k][0]), float_min(lo.y, v[k][1]), float_min(lo.z, v[k][2])};
            hi = (vec3){float_max(hi.x, v[k][0]), float_max(hi.y, v[k][1]), float_max(hi.z, v[k][2])};
        }
    }
    const vec3 d = vec3_sub(hi, lo);
    return sqrtf(vec3_dot(d, d));
}

/* 0: weight 1 of a side that lies so open, 1: 1/2, ... */
static int open_step(double open) {
    int step = 0;
    for (double w = 0.7071; step + 1 < OPEN_STEPS && open < w; w *= 0.5)
        step++;
    return step;
}

/* From how open sides lie to the sum of their weights; covered and enclosed ones go. */
static void sum_up(area_lights *e) {
    double sum = 0;
    uint32_t kept = 0;
    for (uint32_t i = 0; i < e->count; i++) {
        const vit_material *m = side_material(&e->scene, e->side[i]);
        const double area = side_area(&e->scene, e->side[i]);
        const uint32_t side = e->side[i];
        if (!(e->sum[i] > 0))
            continue;
        sum += area * radiance_sum(m) * ldexp(1.0, -open_step(e->sum[i]));
        e->step[kept] = (uint8_t)open_step(e->sum[i]);
        e->side[kept] = side;
        e->sum[kept++] = sum;
        e->area += area;
        for (int k = 0; k < 3; k++)
            e->flux[k] += PI * area * (double)m->emission[k];
    }
    e->count = kept;
}

/* Makes what `o` needs; false: out of memory, or Embree fails. */
static bool open_up(opening *o, area_lights *out, uint32_t count, unsigned threads) {
    o->tries = OPEN_RAYS / count < 1 ? 1 : OPEN_RAYS / count < OPEN_MOST ? OPEN_RAYS / count : OPEN_MOST;
    out->side = malloc(count * sizeof *out->side);
    out->sum = malloc(count * sizeof *out->sum);
    out->step = malloc(count * sizeof *out->step);
    o->lights = malloc((size_t)count * o->tries * sizeof *o->lights);
    o->escapes = calloc(count, sizeof *o->escapes);
    return out->side && out->sum && out->step && o->lights && o->escapes && photon_rays_open(&out->scene, threads, &o->rays);
}

vit_status area_lights_find(const photon_scene *s, const vit_camera *cameras, uint32_t frames, unsigned threads,
                            area_lights *out, vit_text *why) {
    *out = (area_lights){.scene = *s};
    uint32_t count = 0;
    for (uint32_t side = 0; side < 2 * s->triangle_count; side++)
        count += shines(s, side);
    if (count == 0)
        return VIT_OK;
    opening o = {.e = out, .far = OPEN_FAR * diagonal(s)};
    vit_status status = VIT_OK;
    if (open_up(&o, out, count, threads)) {
        for (uint32_t side = 0; side < 2 * s->triangle_count; side++)
            if (shines(s, side))
                out->side[out->count++] = side;
        parallel_for(threads, count, look_out, &o);
        look_from_eyes(&o, cameras, frames);
        drop_enclosed(&o);
        photon_rays_close(&o.rays);
        sum_up(out);
    } else {
        status = bake_fail(why, VIT_FAILED, "area lights: out of memory, or Embree fails");
        area_lights_free(out);
    }
    free(o.lights);
    free(o.escapes);
    return status;
}

void area_lights_free(area_lights *e) {
    free(e->side);
    free(e->sum);
    free(e->step);
    *e = (area_lights){0};
}

/* x chooses the side and, what is left of it, goes on over the triangle: sides that lie together stay together, and points that
 * are even over the square are even over one light of a few triangles. */
static area_light_point place_among(const photon_scene *s, const uint32_t *sides, const double *sum, uint32_t count, double x,
                                    double y) {
    const double total = sum[count - 1], at = x * total;
    uint32_t low = 0, high = count - 1;
    while (low < high) {
        const uint32_t middle = (low + high) / 2;
        if (sum[middle] > at)
            high = middle;
        else
            low = middle + 1;
    }
    const double before = low > 0 ? sum[low - 1] : 0.0, weight = sum[low] - before;
    const uint32_t side = sides[low];
    float b[3];
    triangle_weights(fmin(fmax((at - before) / weight, 0.0), 1.0), y, b);
    area_light_point p = {.position = point_of(s, side, b), .normal = side_normal(s, side), .triangle = side / 2};
    p.area = (float)(side_area(s, side) * total / weight);
    if (photon_opaque_place(s, side / 2, b))
        p.power = vec3_scale(vec3_load(side_material(s, side)->emission), p.area);
    return p;
}

area_light_point area_lights_point(const area_lights *e, double x, double y) {
    return place_among(&e->scene, e->side, e->sum, e->count, x, y);
}

float area_lights_spread(const area_lights *e, uint32_t side) {
    const uint32_t at = place_in_list(e->side, e->count, side);
    if (at == ESCAPES)
        return 0.0f;
    const double weight = e->sum[at] - (at > 0 ? e->sum[at - 1] : 0.0);
    return (float)(side_area(&e->scene, side) * e->sum[e->count - 1] / weight);
}

/* Sides that face alike, of six directions. */
static int facing(vec3 n) {
    const float x = fabsf(n.x), y = fabsf(n.y), z = fabsf(n.z);
    const int axis = x >= y && x >= z ? 0 : y >= z ? 1 : 2;
    return 2 * axis + ((axis == 0 ? n.x : axis == 1 ? n.y : n.z) < 0.0f);
}

/* Sides that face alike and lie alike open: their points are equally strong. */
typedef struct class {
    uint32_t *side; /* ascending */
    double *sum;    /* weights of sides 0 .. i */
    uint32_t count;
    uint32_t points; /* of each set; 0: it has some of those of the rest, all classes that are too small for one */
} class;

static int class_of(const area_lights *e, uint32_t i) {
    return facing(side_normal(&e->scene, e->side[i])) * OPEN_STEPS + e->step[i];
}

/* The last class is the rest. All share the two arrays; the rest's parts begin behind the others'. */
static void sort_sides(const area_lights *e, uint32_t *side, double *sum, class all[CLASSES + 1]) {
    memset(all, 0, (CLASSES + 1) * sizeof *all);
    for (int fill = 0; fill < 2; fill++) {
        for (uint32_t i = 0; i < e->count; i++) {
            class *c = all + class_of(e, i);
            if (fill) {
                c->side[c->count] = e->side[i];
                c->sum[c->count] = (c->count ? c->sum[c->count - 1] : 0.0) + e->sum[i] - (i > 0 ? e->sum[i - 1] : 0.0);
            }
            c->count++;
        }
        for (int k = 0; k < CLASSES + 1 && !fill; k++) {
            all[k].side = side;
            all[k].sum = sum;
            side += all[k].count;
            sum += all[k].count;
            all[k].count = 0;
        }
    }
}

static void join_rest(const area_lights *e, class all[CLASSES + 1]) {
    class *rest = all + CLASSES;
    double sum = 0;
    for (uint32_t i = 0; i < e->count; i++) {
        if (all[class_of(e, i)].points)
            continue;
        sum += e->sum[i] - (i > 0 ? e->sum[i - 1] : 0.0);
        rest->side[rest->count] = e->side[i];
        rest->sum[rest->count++] = sum;
    }
}

static double weight_of(const class *c) {
    return c->count ? c->sum[c->count - 1] : 0.0;
}

/* Every set has as many points of a class as any other, so that all shine alike in each of six directions, and as much as they
 * should: by weight, what is left to the largest remainders. */
static void share_points(const area_lights *e, uint32_t samples, class all[CLASSES + 1]) {
    const double one = e->sum[e->count - 1] / samples; /* weight for a point */
    double rest = 0.0;
    uint32_t left = samples;
    for (int k = 0; k < CLASSES; k++) {
        all[k].points = (uint32_t)(weight_of(all + k) / one * (1 + 1e-12));
        left -= all[k].points;
        rest += all[k].points ? 0.0 : weight_of(all + k);
    }
    all[CLASSES].points = rest > 0.0 ? (uint32_t)fmin(fmax(floor(rest / one + 0.5), 1.0), left) : 0;
    for (left -= all[CLASSES].points; left > 0; left--) {
        int most = CLASSES;
        double remainder = -INFINITY;
        for (int k = 0; k < CLASSES; k++)
            if (all[k].points && weight_of(all + k) / one - all[k].points > remainder) {
                most = k;
                remainder = weight_of(all + k) / one - all[k].points;
            }
        all[most].points++;
    }
    join_rest(e, all);
}

/* Of the side of a point. */
static int class_at(const area_lights *e, const area_light_point *p) {
    return class_of(e, place_in_list(e->side, e->count, side_met(&e->scene, p->triangle, vec3_scale(p->normal, -1.0f))));
}

static vit_light_sample light_sample_of(const area_lights *e, area_light_point p, float share) {
    return (vit_light_sample){.position = {p.position.x, p.position.y, p.position.z},
                              .radius2 = float_max(p.area * share * KERNEL_INV_PI, FLT_MIN),
                              .normal = {p.normal.x, p.normal.y, p.normal.z},
                              .near2 = side_material(&e->scene, 2 * p.triangle)->near2,
                              .power = {p.power.x * share, p.power.y * share, p.power.z * share}};
}

/* Point i of a class in all sets. Which way round the sequence goes over the sides is free; so the halves of a rectangle, two
 * triangles, have points that make up for each other best (tests/numeric/test_soft_light.c). */
static area_light_point place_set(const area_lights *e, const class *c, uint32_t i) {
    double x, y;
    sobol_point(c->points, i / c->points, i % c->points, &x, &y);
    return place_among(&e->scene, c->side, c->sum, c->count, x, 1 - y);
}

static void place_class(const area_lights *e, const class *c, uint32_t samples, vit_light_sample *out) {
    const float share = 1.0f / (float)c->points;
    for (uint32_t i = 0; i < VIT_PATTERNS * c->points; i++)
        out[i / c->points * samples + i % c->points] = light_sample_of(e, place_set(e, c, i), share);
}

/* The rest's points in all sets together. */
typedef struct rest_points {
    area_light_point
        place[VIT_PATTERNS * CLASSES]; /* there are no more than classes that are too small for a point in each set */
    int class[VIT_PATTERNS * CLASSES];
    uint32_t of_class[CLASSES];
    double whole[CLASSES], found[CLASSES]; /* W/sr summed over channels, of all sets together */
} rest_points;

/* A class that has come off without a point takes one over from the class that has most. */
static void give_all_points(const area_lights *e, const class all[CLASSES + 1], uint32_t count, rest_points *r) {
    for (int k = 0; k < CLASSES; k++) {
        int most = 0;
        for (int i = 1; i < CLASSES; i++)
            most = r->of_class[i] > r->of_class[most] ? i : most;
        if (all[k].points || !all[k].count || r->of_class[k] || r->of_class[most] < 2)
            continue;
        uint32_t last = count - 1;
        while (r->class[last] != most)
            last--;
        r->place[last] = place_among(&e->scene, all[k].side, all[k].sum, all[k].count, 0.5, 0.5);
        r->class[last] = k;
        r->of_class[most]--;
        r->of_class[k]++;
    }
}

/* All sets together have of each class of the rest as much as they should, whichever points they have. Area lights with holes
 * are left alone. */
static void place_rest(const area_lights *e, const class all[CLASSES + 1], uint32_t samples, vit_light_sample *out) {
    const class *c = all + CLASSES;
    const uint32_t count = VIT_PATTERNS * c->points;
    const double share = 1.0 / c->points;
    rest_points r = {.of_class = {0}};
    for (uint32_t i = 0; i < count; i++) {
        r.place[i] = place_set(e, c, i);
        r.class[i] = class_at(e, r.place + i);
        r.of_class[r.class[i]]++;
    }
    give_all_points(e, all, count, &r);
    for (uint32_t i = 0; i < count; i++) {
        const vec3 p = r.place[i].power;
        r.found[r.class[i]] += ((double)p.x + (double)p.y + (double)p.z) * share / VIT_PATTERNS;
    }
    double whole = 0, some = 0;
    for (uint32_t i = 0; i < c->count; i++) {
        const vit_material *m = side_material(&e->scene, c->side[i]);
        const int k = class_of(e, place_in_list(e->side, e->count, c->side[i]));
        const double power = m->cutout ? -INFINITY : side_area(&e->scene, c->side[i]) * radiance_sum(m);
        r.whole[k] += power;
        whole += power;
        some += r.of_class[k] ? power : 0;
    }
    for (uint32_t i = 0; i < count; i++) {
        const int k = r.class[i];
        const double factor = whole > 0 ? r.whole[k] / r.found[k] * (whole / some) : 1.0;
        out[i / c->points * samples + i % c->points] = light_sample_of(e, r.place[i], (float)(share * factor));
    }
}

void area_lights_near(const area_lights *e, uint32_t samples, vit_material *materials) {
    for (uint32_t i = 0; i < e->count; i++) {
        const uint32_t m = e->scene.attributes[e->side[i] / 2].material & VIT_MATERIAL_INDEX;
        const double area = e->sum[e->count - 1] / (samples * radiance_sum(materials + m)) * ldexp(1.0, e->step[i]);
        materials[m].near2 = float_max(materials[m].near2, (float)(NEAR_DISCS * area * (double)KERNEL_INV_PI));
    }
}

vit_status area_lights_sets(const area_lights *e, uint32_t samples, vit_light_sample *out, vit_text *why) {
    class all[CLASSES + 1];
    uint32_t *side = malloc(2 * (size_t)e->count * sizeof *side);
    double *sum = malloc(2 * (size_t)e->count * sizeof *sum);
    vit_status status = VIT_OK;
    if (side && sum) {
        sort_sides(e, side, sum, all);
        share_points(e, samples, all);
        for (int k = 0; k < CLASSES; out += all[k++].points)
            if (all[k].points)
                place_class(e, all + k, samples, out);
        if (all[CLASSES].points)
            place_rest(e, all, samples, out);
    } else {
        status = bake_fail(why, VIT_FAILED, "area lights: out of memory");
    }
    free(side);
    free(sum);
    return status;
}
