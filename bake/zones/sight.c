/* Receivers and pairs: which patches' photons a piece of surface should accept. Seen from there, most of the patch must be
 * visible, and lit alike: light that does not reach round a corner should not be averaged round it. */
#include "zones/parts.h"
#include <float.h>
#include <stdlib.h>

#define LIFT 0.05f    /* rays start so many radii above the surface, or in the middle of the free space there */
#define EYES 8u       /* points of a patch that are looked at */
#define FIRST_EYES 4u /* if these agree, they decide */
#define DARK 0.5f     /* of accepting too little: less harm than too much */
#define MOST_HARM 16.0f
#define NOISE 0.02 /* of the mean irradiance */

typedef struct sight {
    zones *z;
    grid patches, points;
    vec3 *eyes;        /* EYES a patch, lifted */
    float *irradiance; /* a patch */
    float least;       /* what is less than this is noise */
    size_t *first;     /* a receiver: its first pair */
} sight;

static vec3 lift(const zones *z, vec3 p, vec3 n) {
    const float most = LIFT * z->radius, least = z->in->scene->ray_offset;
    const vec3 from = vec3_along(p, n, least);
    float t;
    if (photon_rays_occluded(&z->rays, from, n, 2.0f * most) && photon_rays_nearest(&z->rays, from, n, &t) != VIT_NONE)
        return vec3_along(from, n, 0.5f * float_min(t, 2.0f * most));
    return vec3_along(p, n, most);
}

static uint32_t eyes_of(const patch *p) {
    return p->count < EYES ? p->count : EYES;
}

static const area_point *eye_point(const zones *z, const patch *p, uint32_t k) {
    return z->points + p->first + (size_t)k * p->count / eyes_of(p);
}

static void open_eyes(void *user, uint32_t i) {
    const sight *s = user;
    const patch *p = s->z->patches + i;
    for (uint32_t k = 0; k < eyes_of(p); k++) {
        const area_point *q = eye_point(s->z, p, k);
        s->eyes[(size_t)i * EYES + k] = lift(s->z, q->p, q->n);
    }
}

static bool sees(const zones *z, vec3 a, vec3 b) {
    const vec3 d = vec3_sub(b, a);
    const float l2 = vec3_dot(d, d), l = sqrtf(l2);
    return !(l2 > 0.0f) || !photon_rays_occluded(&z->rays, a, vec3_scale(d, 1.0f / l), l * 0.999f);
}

/* Does p see at least half of the patch's points that the kernel reaches? */
static bool sees_patch(const sight *s, const receiver *r, vec3 from, uint32_t patch_number) {
    const patch *p = s->z->patches + patch_number;
    uint32_t looked = 0, seen = 0;
    for (uint32_t k = 0; k < eyes_of(p); k++) {
        if (!(zones_kernel(s->z, r->p, r->n, eye_point(s->z, p, k)->p) > 0.0f))
            continue;
        seen += sees(s->z, from, s->eyes[(size_t)patch_number * EYES + k]);
        looked++;
        if (looked == FIRST_EYES && (seen == 0 || seen == looked))
            break;
    }
    return 2 * seen >= looked;
}

/* Mean of the kernel over a patch. */
static float patch_weight(const zones *z, const receiver *r, const patch *p) {
    float sum = 0.0f;
    for (uint32_t k = 0; k < eyes_of(p); k++)
        sum += zones_kernel(z, r->p, r->n, eye_point(z, p, k)->p);
    return sum / (float)eyes_of(p) * p->area;
}

typedef struct visit {
    const sight *s;
    const receiver *r;
    vec3 from;
    float irradiance; /* at the receiver */
    float flux, area; /* of the points about it, weighted */
    size_t count;
    pair *out; /* NULL: count only */
} visit;

static void visit_patch(void *user, uint32_t number) {
    visit *v = user;
    const zones *z = v->s->z;
    const patch *p = z->patches + number;
    const float weight = p->count ? patch_weight(z, v->r, p) : 0.0f;
    if (!(weight > 0.0f))
        return;
    if (v->out) {
        const float ratio = (v->s->irradiance[number] + v->s->least) / (v->irradiance + v->s->least);
        const bool alike = !z->in->by_light || (ratio <= ZONES_LIKE && ratio >= 1.0f / ZONES_LIKE);
        pair *q = v->out + v->count;
        *q = (pair){.receiver = (uint32_t)(v->r - z->receivers), .patch = number, .weight = DARK * weight};
        q->alike = alike;
        q->accept = alike && sees_patch(v->s, v->r, v->from, number);
        q->wrong = weight * float_min(float_max(ratio, 1.0f), MOST_HARM);
    }
    v->count++;
}

/* Irradiance from the photons close by, on this surface: what hangs close before it is another. */
static void visit_point(void *user, uint32_t i) {
    visit *v = user;
    const area_point *q = v->s->z->points + i;
    const vec3 o = vec3_sub(q->p, v->r->p);
    const float near = v->s->z->radius * ZONES_NEAR, off = vec3_dot(o, v->r->n);
    const float w = 1.0f - fmaf(off * off, 24.0f, vec3_dot(o, o)) / (near * near);
    if (w > 0.0f && vec3_dot(q->n, v->r->n) > 0.5f) {
        v->flux += w * q->flux;
        v->area += w * q->area;
    }
}

static void count_pairs(void *user, uint32_t i) {
    const sight *s = user;
    visit v = {.s = s, .r = s->z->receivers + i};
    grid_near(&s->patches, v.r->p, s->z->radius * (1.0f + ZONES_COARSE), visit_patch, &v);
    s->z->receivers[i].count = (uint32_t)v.count;
}

static void fill_pairs(void *user, uint32_t i) {
    const sight *s = user;
    receiver *r = s->z->receivers + i;
    visit v = {.s = s, .r = r, .from = lift(s->z, r->p, r->n), .out = s->z->pairs + s->first[i]};
    grid_near(&s->points, r->p, s->z->radius * ZONES_NEAR, visit_point, &v);
    v.irradiance = v.area > 0.0f ? v.flux / v.area : 0.0f;
    grid_near(&s->patches, r->p, s->z->radius * (1.0f + ZONES_COARSE), visit_patch, &v);
}

/* The largest cell of a group stands for it, of those that the path is known to see if there are any. */
static void choose_receivers(zones *z) {
    for (uint32_t i = 0; i < z->receiver_count; i++)
        z->receivers[i].cell = VIT_NONE;
    for (uint32_t i = 0; i < z->c->count; i++) {
        if (z->receiver_of[i] == VIT_NONE)
            continue;
        receiver *r = z->receivers + z->receiver_of[i];
        const bool seen = z->seen_off[i] < FLT_MAX, had = r->cell != VIT_NONE && z->seen_off[r->cell] < FLT_MAX;
        if (r->cell == VIT_NONE || seen > had || (seen == had && cells_area(z->c, z->g, i) > cells_area(z->c, z->g, r->cell)))
            r->cell = i;
    }
}

/* A receiver looks from the point next to its cell's middle that the path sees: the middle may lie inside a wall. */
static void place_receivers(zones *z) {
    for (uint32_t i = 0; i < z->receiver_count; i++) {
        receiver *r = z->receivers + i;
        const uint32_t side = z->c->side_of[r->cell];
        const float *at = z->seen_at[r->cell];
        r->p = z->seen_off[r->cell] < FLT_MAX ? side_place(z->g, side, at[0], at[1]) : cells_center(z->c, z->g, r->cell);
        r->n = side_face(z->g, side);
    }
}

bool zones_pairs(zones *z) {
    sight s = {.z = z};
    z->receivers = calloc(z->receiver_count + 1u, sizeof *z->receivers);
    s.eyes = malloc((z->patch_count + 1u) * EYES * sizeof *s.eyes);
    s.irradiance = calloc(z->patch_count + 1u, sizeof *s.irradiance);
    s.first = calloc(z->receiver_count + 1u, sizeof *s.first);
    bool fine = z->receivers && s.eyes && s.irradiance && s.first &&
                grid_make(&s.patches, &z->patches[0].center, sizeof *z->patches, z->patch_count, z->radius * 0.5f) &&
                grid_make(&s.points, &z->points[0].p, sizeof *z->points, z->point_count, z->radius * 0.1f);
    if (fine) {
        for (uint32_t i = 0; i < z->patch_count; i++)
            s.irradiance[i] = z->patches[i].area > 0.0f ? z->patches[i].flux / z->patches[i].area : 0.0f;
        double flux = 0.0, area = 0.0;
        for (uint32_t i = 0; i < z->patch_count; i++) {
            flux += z->patches[i].area > 0.0f ? (double)z->patches[i].flux : 0.0;
            area += (double)z->patches[i].area;
        }
        s.least = area > 0.0 ? (float)(NOISE * flux / area) : 0.0f;
        choose_receivers(z);
        place_receivers(z);
        if (z->in->zones) {
            parallel_for(z->in->threads, z->patch_count, open_eyes, &s);
            parallel_for(z->in->threads, z->receiver_count, count_pairs, &s);
        }
        for (uint32_t i = 0; i < z->receiver_count; i++) {
            s.first[i] = z->pair_count;
            z->pair_count += z->receivers[i].count;
        }
        z->pairs = malloc((z->pair_count + 1) * sizeof *z->pairs);
        fine = z->pairs != NULL;
    }
    if (fine && z->in->zones)
        parallel_for(z->in->threads, z->receiver_count, fill_pairs, &s);
    grid_free(&s.patches);
    grid_free(&s.points);
    free(s.eyes);
    free(s.irradiance);
    free(s.first);
    return fine;
}
