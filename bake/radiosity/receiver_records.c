/* Which receivers' light is computed. Where triangles are small, or a side is hardly seen, many receivers lie closer to each
 * other than the cameras call for. If there are too many, some of them are records, and the others' light follows from that of
 * records round about (irradiance caching: Ward et al. 1988; here the records' places are chosen first). After a first look at
 * the light, those whose records differ become records, too. */
#include "common/parallel.h"
#include "radiosity/receivers_parts.h"
#include <stdlib.h>
#include <string.h>

#define ALIKE 0.85f       /* cosine of the normals of a record and of what follows from it, at least */
#define PLANE 0.5f        /* of the reach: how far off each other's planes they may lie */
#define WIDER 2.0f        /* reaches: records as far as that are taken besides the one that is near enough */
#define STIFF 0.05f       /* how much a slope of the light costs, against what records say of it */
#define STEP 0.3f         /* of the records' mean: where they differ more, the receiver becomes one */
#define DIM 0.02f         /* of the mean of all: less counts as so much */
#define MOST_NEAR 64u     /* records that are looked at for a receiver */
#define LEAST_SCALE 0.25f /* of reaches, which double until there are few enough records */
#define LEAST_PART 0.05f  /* of the light: records of less say nothing of a step */

typedef struct records {
    const placing *p;
    float scale;                 /* of all reaches */
    uint32_t *head;              /* a slot: the last record in it, or VIT_NONE */
    uint32_t *next;              /* a record: the one before it in its slot, or VIT_NONE */
    uint32_t slots;              /* a power of two */
    receiver_follower *follower; /* a receiver */
} records;

typedef struct place {
    vec3 at, normal, face;
    float reach, lift;
} place;

static place place_of(const records *w, uint32_t index) {
    const placing *p = w->p;
    const receiver *r = p->out->receivers + index;
    const geometry *g = p->in->geometry;
    return (place){.at = side_place(g, r->side, r->b1, r->b2),
                   .normal = side_shading(g, r->side, r->b1, r->b2),
                   .face = side_face(g, r->side),
                   .reach = r->reach * w->scale,
                   .lift = separation_lift(p->in->rays, p->spacing[r->side])};
}

static int level_of(float reach) {
    int level;
    frexpf(reach, &level);
    return level;
}

static uint32_t slot_of(const records *w, int level, const int32_t cube[3]) {
    return pcg((uint32_t)cube[0] ^ pcg((uint32_t)cube[1] ^ pcg((uint32_t)cube[2] ^ pcg((uint32_t)level)))) & (w->slots - 1);
}

static void cube_of(vec3 at, int level, int32_t cube[3]) {
    const float inverse = ldexpf(1.0f, -level), v[3] = {at.x * inverse, at.y * inverse, at.z * inverse};
    for (int k = 0; k < 3; k++)
        cube[k] = fabsf(v[k]) < 1e9f ? (int32_t)floorf(v[k]) : 0;
}

/* Does light there say what it is here? But for what stands between them. */
static bool is_alike(const place *here, const place *there, float reach) {
    const vec3 way = vec3_sub(there->at, here->at);
    return vec3_dot(way, way) <= reach * reach && vec3_dot(here->normal, there->normal) > ALIKE &&
           vec3_dot(here->face, there->face) > 0.0f && fabsf(vec3_dot(way, here->normal)) <= PLANE * here->reach &&
           fabsf(vec3_dot(way, there->normal)) <= PLANE * here->reach;
}

static bool sees(const placing *p, const place *here, const place *there) {
    return separation_sees(p->in->rays, vec3_along(here->at, here->face, here->lift),
                           vec3_along(there->at, there->face, there->lift));
}

/* Records within so many reaches that are alike and seen, nearest first; at most `most`. */
static uint32_t find_near(const records *w, const place *here, float reaches, uint32_t most, uint32_t *near) {
    const float reach = here->reach * reaches;
    uint32_t found[MOST_NEAR], count = 0, kept = 0;
    float far[MOST_NEAR];
    const int own = level_of(here->reach);
    for (int level = own; level <= own + 1; level++) {
        int32_t low[3], high[3], c[3];
        const vec3 reach_all = {reach, reach, reach};
        cube_of(vec3_sub(here->at, reach_all), level, low);
        cube_of(vec3_along(here->at, reach_all, 1.0f), level, high);
        for (c[0] = low[0]; c[0] <= high[0]; c[0]++)
            for (c[1] = low[1]; c[1] <= high[1]; c[1]++)
                for (c[2] = low[2]; c[2] <= high[2]; c[2]++)
                    for (uint32_t i = w->head[slot_of(w, level, c)]; i != VIT_NONE; i = w->next[i]) {
                        const place there = place_of(w, i);
                        const vec3 way = vec3_sub(there.at, here->at);
                        const float d2 = vec3_dot(way, way);
                        uint32_t k = count < MOST_NEAR ? count : MOST_NEAR - 1;
                        if (!is_alike(here, &there, reach) || (count == MOST_NEAR && !(d2 < far[k])))
                            continue;
                        for (uint32_t j = 0; j < count; j++)
                            k = found[j] == i ? VIT_NONE : k;
                        if (k == VIT_NONE)
                            continue;
                        for (; k > 0 && far[k - 1] > d2; k--) {
                            far[k] = far[k - 1];
                            found[k] = found[k - 1];
                        }
                        far[k] = d2;
                        found[k] = i;
                        count += count < MOST_NEAR;
                    }
    }
    for (uint32_t k = 0; k < count && kept < most; k++) {
        const place there = place_of(w, found[k]);
        if (sees(w->p, here, &there))
            near[kept++] = found[k];
    }
    return kept;
}

/* Weights of records for the light here: of a plane through it in the least squares (moving least squares: Shepard's weights,
 * made right for light that changes evenly). */
static void weigh(const records *w, const place *here, uint32_t count, receiver_follower *f) {
    vec3 across, up;
    double part[RECEIVER_FROM], x[RECEIVER_FROM], y[RECEIVER_FROM], s = 0, sx = 0, sy = 0, xx = 0, xy = 0, yy = 0, all = 0;
    vec3_across(here->normal, &across, &up);
    for (uint32_t k = 0; k < count; k++) {
        const vec3 way = vec3_scale(vec3_sub(place_of(w, f->from[k]).at, here->at), 1.0f / (here->reach * WIDER));
        const double beyond = 1.001 - (double)sqrtf(vec3_dot(way, way));
        x[k] = (double)vec3_dot(way, across);
        y[k] = (double)vec3_dot(way, up);
        part[k] = beyond * beyond;
        s += part[k];
        sx += part[k] * x[k];
        sy += part[k] * y[k];
        xx += part[k] * x[k] * x[k];
        xy += part[k] * x[k] * y[k];
        yy += part[k] * y[k] * y[k];
    }
    xx += STIFF * s;
    yy += STIFF * s;
    /* The first row of the normal equations' inverse, times their determinant. */
    const double m0 = xx * yy - xy * xy, m1 = sy * xy - sx * yy, m2 = sx * xy - sy * xx;
    for (uint32_t k = 0; k < count; k++) {
        part[k] *= m0 + m1 * x[k] + m2 * y[k];
        part[k] = part[k] > 0.0 ? part[k] : 0.0;
        all += part[k];
    }
    for (uint32_t k = 0; k < RECEIVER_FROM; k++) {
        f->weight[k] = k >= count ? 0.0f : all > 0.0 ? (float)(part[k] / all) : 1.0f / (float)count;
        f->from[k] = k < count ? f->from[k] : f->from[0];
    }
}

static void follow(void *user, uint32_t index) {
    const records *w = user;
    if (!w->p->out->receivers[index].follows)
        return;
    const place here = place_of(w, index);
    receiver_follower *f = w->follower + index;
    f->receiver = index;
    uint32_t near[RECEIVER_FROM];
    const uint32_t count = find_near(w, &here, WIDER, RECEIVER_FROM, near);
    if (count > 0) /* else too many that are hidden are nearer, and the record that it was found by stays */
        memcpy(f->from, near, sizeof near);
    weigh(w, &here, count > 0 ? count : 1, f);
}

static void add_record(records *w, uint32_t index) {
    const place here = place_of(w, index);
    int32_t cube[3];
    const int level = level_of(here.reach);
    cube_of(here.at, level, cube);
    const uint32_t slot = slot_of(w, level, cube);
    w->next[index] = w->head[slot];
    w->head[slot] = index;
}

/* Returns how many records there are. */
static uint32_t choose_records(records *w) {
    receivers *o = w->p->out;
    uint32_t count = 0;
    memset(w->head, 0xff, w->slots * sizeof *w->head);
    for (uint32_t i = 0; i < o->count; i++) {
        const place here = place_of(w, i);
        o->receivers[i].follows = here.reach > 0.0f && find_near(w, &here, 1.0f, 1, w->follower[i].from) > 0;
        if (here.reach > 0.0f && !o->receivers[i].follows)
            add_record(w, i);
        count += !o->receivers[i].follows;
    }
    return count;
}

bool receivers_find_records(placing *p) {
    receivers *o = p->out;
    records w = {.p = p, .scale = LEAST_SCALE, .slots = 1024};
    if (o->count <= p->in->records)
        return true;
    while (w.slots < o->count && w.slots < 1u << 30)
        w.slots *= 2;
    w.head = malloc(w.slots * sizeof *w.head);
    w.next = malloc((o->count + 1u) * sizeof *w.next);
    w.follower = malloc((o->count + 1u) * sizeof *w.follower);
    const bool fine = w.head && w.next && w.follower;
    if (fine) {
        while (choose_records(&w) > p->in->records && w.scale < 1.0f)
            w.scale *= 2.0f;
        parallel_for(p->in->threads, o->count, follow, &w);
        for (uint32_t i = 0; i < o->count; i++)
            if (o->receivers[i].follows)
                w.follower[o->follower_count++] = w.follower[i];
        o->followers = w.follower;
        p->follower_room = o->count + 1u;
    } else {
        free(w.follower);
    }
    free(w.head);
    free(w.next);
    return fine;
}

/* How much the light of the records differs, over its mean; all columns together. */
static double step_of(const receiver_follower *f, const float *irradiance, uint32_t columns, double mean) {
    double differ = 0.0, sum = 0.0;
    for (uint32_t c = 0; c < columns; c++) {
        float least = INFINITY, most = 0.0f;
        for (uint32_t k = 0; k < RECEIVER_FROM; k++) {
            const float e = irradiance[(size_t)f->from[k] * columns + c];
            sum += (double)e * (double)f->weight[k];
            least = f->weight[k] > LEAST_PART ? float_min(least, e) : least;
            most = f->weight[k] > LEAST_PART ? float_max(most, e) : most;
        }
        differ += (double)(most - float_min(least, most));
    }
    return sum + DIM * mean > 0.0 ? differ / (sum + DIM * mean) : 0.0;
}

void receivers_part_records(placing *p, const float *irradiance, double mean) {
    receivers *o = p->out;
    uint32_t left = 0;
    for (uint32_t i = 0; i < o->follower_count; i++) {
        const receiver_follower *f = o->followers + i;
        const uint32_t side = o->receivers[f->receiver].side;
        const bool apart = p->met[side] && step_of(f, irradiance, p->in->columns, mean) > STEP;
        o->receivers[f->receiver].follows = !apart;
        if (!apart)
            o->followers[left++] = *f;
    }
    o->follower_count = left;
}

void receivers_follow(const receivers *r, float *irradiance, uint32_t columns) {
    for (uint32_t i = 0; i < r->follower_count; i++) {
        const receiver_follower *f = r->followers + i;
        float *to = irradiance + (size_t)f->receiver * columns;
        for (uint32_t c = 0; c < columns; c++)
            to[c] = 0.0f;
        for (uint32_t k = 0; k < RECEIVER_FROM; k++) {
            const float *from = irradiance + (size_t)f->from[k] * columns, weight = f->weight[k];
            for (uint32_t c = 0; c < columns && weight > 0.0f; c++)
                to[c] += from[c] * weight;
        }
    }
}
