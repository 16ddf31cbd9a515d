#include "emitters.h"
#include "parallel.h"
#include "photon_rays.h"
#include "sobol.h"
#include <float.h>
#include <stdio.h>
#include <stdlib.h>

#define OPEN_RAYS (1u << 20) /* in all */
#define OPEN_MOST 64u        /* a side */
#define OPEN_FAR 0.05f       /* of the scene's diagonal: light that goes so far lights more than what touches the lamp */
#define OPEN_LEAST 0.125     /* of weights: no photon is more than 8 times as strong as it would be */

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

typedef struct opening {
    const emitters *e;
    photon_rays rays;
    uint32_t tries;
    float far; /* m */
} opening;

/* How open a side lies, 0..1: how far its light goes before it meets anything, at most OPEN_FAR; 0 where it is covered. Mirrors and glass
 * hand it on. */
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
        triangle_weights(unit_float(seed * 0xdb4f0b91u), unit_float(seed * 0xbbe05633u), b); /* four dimensions of Roberts 2018 */
        const float u = unit_float(seed * 0xa0f2ec75u), r = sqrtf(u), h = sqrtf(float_max(1.0f - u, 4e-4f));
        sincos_turn(unit_float(seed * 0x89e18285u), &sp, &cp);
        const vec3 d = vec3_unit(vec3_along(vec3_along(vec3_scale(n, h), ax, r * cp), ay, r * sp));
        const vec3 from = point_of(s, side, b);
        if (photon_rays_covered(&o->rays, side / 2, from, n))
            continue;
        const uint32_t found = photon_rays_nearest(&o->rays, from, d, &t);
        sum += found == VIT_NONE || side_material(s, 2 * found)->kind != VIT_MATTE || t > o->far ? 1.0 : (double)(t / o->far);
    }
    o->e->sum[i] = sum / o->tries;
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

/* From how open sides lie to the sum of their weights; covered ones go. */
static void sum_up(emitters *e) {
    double sum = 0;
    uint32_t kept = 0;
    for (uint32_t i = 0; i < e->count; i++) {
        const vit_material *m = side_material(&e->scene, e->side[i]);
        const double area = side_area(&e->scene, e->side[i]);
        const uint32_t side = e->side[i];
        if (!(e->sum[i] > 0))
            continue;
        sum += area * radiance_sum(m) * fmax(e->sum[i], OPEN_LEAST);
        e->side[kept] = side;
        e->sum[kept++] = sum;
        e->area += area;
        for (int k = 0; k < 3; k++)
            e->flux[k] += 3.14159265358979324 * area * (double)m->emission[k];
    }
    e->count = kept;
}

vit_status emitters_find(const photon_scene *s, unsigned threads, emitters *out, vit_text *why) {
    *out = (emitters){.scene = *s};
    uint32_t count = 0;
    for (uint32_t side = 0; side < 2 * s->triangle_count; side++)
        count += shines(s, side);
    if (count == 0)
        return VIT_OK;
    out->side = malloc(count * sizeof *out->side);
    out->sum = malloc(count * sizeof *out->sum);
    opening o = {.e = out, .far = OPEN_FAR * diagonal(s)};
    if (!out->side || !out->sum || !photon_rays_open(&out->scene, threads, &o.rays)) {
        snprintf(why->text, sizeof why->text, "area lights: out of memory, or Embree fails");
        emitters_free(out);
        return VIT_FAILED;
    }
    for (uint32_t side = 0; side < 2 * s->triangle_count; side++)
        if (shines(s, side))
            out->side[out->count++] = side;
    o.tries = OPEN_RAYS / count < 1 ? 1 : OPEN_RAYS / count < OPEN_MOST ? OPEN_RAYS / count : OPEN_MOST;
    parallel_for(threads, count, look_out, &o);
    photon_rays_close(&o.rays);
    sum_up(out);
    return VIT_OK;
}

void emitters_free(emitters *e) {
    free(e->side);
    free(e->sum);
    *e = (emitters){0};
}

/* x chooses the side and, what is left of it, goes on over the triangle: sides that lie together stay together, and points that are
 * even over the square are even over one light of a few triangles. */
emitter_place emitters_place(const emitters *e, double x, double y) {
    const double total = e->sum[e->count - 1], at = x * total;
    uint32_t low = 0, high = e->count - 1;
    while (low < high) {
        const uint32_t middle = (low + high) / 2;
        if (e->sum[middle] > at)
            high = middle;
        else
            low = middle + 1;
    }
    const double before = low > 0 ? e->sum[low - 1] : 0.0, weight = e->sum[low] - before;
    const uint32_t side = e->side[low];
    float b[3];
    triangle_weights(fmin(fmax((at - before) / weight, 0.0), 1.0), y, b);
    emitter_place p = {.position = point_of(&e->scene, side, b), .normal = side_normal(&e->scene, side), .triangle = side / 2};
    p.area = (float)(side_area(&e->scene, side) * total / weight);
    if (photon_opaque_place(&e->scene, side / 2, b))
        p.power = vec3_scale(vec3_load(side_material(&e->scene, side)->emission), p.area);
    return p;
}

/* Sides that face alike, of six directions. */
static int facing(vec3 n) {
    const float x = fabsf(n.x), y = fabsf(n.y), z = fabsf(n.z);
    const int axis = x >= y && x >= z ? 0 : y >= z ? 1 : 2;
    return 2 * axis + ((axis == 0 ? n.x : axis == 1 ? n.y : n.z) < 0.0f);
}

/* What shines in each of the six directions, W/sr summed over channels, is the same in every set and as much as it should be, so that
 * pixels side by side do not differ because of a point more on this side of the lamp or that. If a set has no point for a direction all
 * sets together shine as much as they should. Lamps with holes are left alone. */
static void even_out(const emitters *e, uint32_t samples, vit_emitter *out) {
    double whole[6] = {0}, found[VIT_PATTERNS][6] = {{0}};
    for (uint32_t i = 0; i < e->count; i++) {
        const vit_material *m = side_material(&e->scene, e->side[i]);
        whole[facing(side_normal(&e->scene, e->side[i]))] += m->cutout ? -INFINITY : side_area(&e->scene, e->side[i]) * radiance_sum(m);
    }
    for (uint32_t i = 0; i < VIT_PATTERNS * samples; i++) {
        const vit_emitter *p = out + i;
        found[i / samples][facing(vec3_load(p->normal))] += (double)p->power[0] + (double)p->power[1] + (double)p->power[2];
    }
    for (int k = 0; k < 6; k++) {
        double all = 0, least = INFINITY;
        for (uint32_t set = 0; set < VIT_PATTERNS; set++) {
            all += found[set][k] / VIT_PATTERNS;
            least = fmin(least, found[set][k]);
        }
        for (uint32_t set = 0; set < VIT_PATTERNS && !(least > 0); set++)
            found[set][k] = all;
    }
    for (uint32_t i = 0; i < VIT_PATTERNS * samples; i++) {
        const int k = facing(vec3_load(out[i].normal));
        const float factor = whole[k] > 0 ? (float)(whole[k] / found[i / samples][k]) : 1.0f;
        out[i].radius2 *= factor;
        for (int c = 0; c < 3; c++)
            out[i].power[c] *= factor;
    }
}

void emitters_sets(const emitters *e, uint32_t samples, vit_emitter *out) {
    vit_emitter *next = out;
    const float share = 1.0f / (float)samples;
    for (uint32_t set = 0; set < VIT_PATTERNS; set++)
        for (uint32_t i = 0; i < samples; i++) {
            double x, y;
            sobol_point(samples, set, i, &x, &y);
            const emitter_place p = emitters_place(e, x, y);
            *next++ = (vit_emitter){.position = {p.position.x, p.position.y, p.position.z},
                                    .radius2 = float_max(p.area * share * PHOTON_INV_PI, FLT_MIN),
                                    .normal = {p.normal.x, p.normal.y, p.normal.z},
                                    .power = {p.power.x * share, p.power.y * share, p.power.z * share}};
        }
    even_out(e, samples, out);
}
