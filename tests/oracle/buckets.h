/* Buckets of clusters by their definition, in double: what photons give to one, and what a surface gets from its buckets. */
#ifndef VIT_TESTS_BUCKETS_H
#define VIT_TESTS_BUCKETS_H

#include "view_sample.h"

#define ORACLE_OCTANTS 8
#define ORACLE_DIRECTIONS 54
#define ORACLE_BEHIND 1e-6 /* how far a photon may come from behind for all normals and still be sorted in */

/* The samples of a key. */
typedef struct oracle_cluster {
    uint32_t key, accept;
    double lo[3], hi[3], nlo[3], nhi[3]; /* of positions, of normals */
} oracle_cluster;

typedef struct oracle_buckets {
    double sum[ORACLE_DIRECTIONS][3];
    double doubt; /* of photons which rounding may put elsewhere or leave out, the greatest channel's */
} oracle_buckets;

/* The key of a tile (x, y), slice z and direction n: bits of x, y, z in turns until each runs out, over the direction's. */
static inline uint32_t oracle_key(const vit_scene *s, const uint32_t place[3], uint32_t n) {
    const uint32_t bits[3] = {s->key_bits_x, s->key_bits_y, s->key_bits_z};
    uint32_t key = n, at = s->key_bits_n;
    for (uint32_t i = 0; i < 32; i++)
        for (int k = 0; k < 3; k++)
            if (i < bits[k])
                key |= (place[k] >> i & 1) << at++;
    return key;
}

/* The bucket of what arrives along `travel`: an octant, or one of 3 x 3 squares of a cube's face, faces in the order +x, -x, +y
 * ... *near: rounding may make it another one. */
static inline uint32_t oracle_bucket(const vit_scene *s, const float travel[3], int *near) {
    double from[3], side[2];
    int axis = 0, square[2];
    *near = 0;
    if (!(s->effects & VIT_BIT(RAW_BUCKETS)))
        return (travel[0] > 0) | (travel[1] > 0) << 1 | (travel[2] > 0) << 2;
    for (int k = 0; k < 3; k++) {
        from[k] = -(double)travel[k];
        axis = fabs(from[k]) > fabs(from[axis]) ? k : axis;
    }
    const double major = fabs(from[axis]);
    for (int k = 0, i = 0; k < 3; k++)
        if (k != axis)
            side[i++] = from[k] / major;
    for (int i = 0; i < 2; i++) {
        square[i] = side[i] < -1.0 / 3 ? 0 : side[i] < 1.0 / 3 ? 1 : 2;
        *near |= fabs(fabs(side[i]) - 1.0 / 3) < 1e-6 || fabs(side[i]) > 1 - 1e-6;
    }
    return (uint32_t)((axis * 2 + (from[axis] < 0)) * 9 + square[1] * 3 + square[0]);
}

/* Sums of power times 1 - d^2 / r^2 at the middle of the cluster's box, over the photons that come from the front for some
 * normal in its box of normals, or with zones, that some sample accepts. Flattened along the middle of the box of normals. */
static inline void oracle_fill(const vit_scene *s, const vit_photon *photons, const oracle_cluster *c, oracle_buckets *b) {
    *b = (oracle_buckets){0};
    double middle[3];
    for (int k = 0; k < 3; k++)
        middle[k] = c->nlo[k] + c->nhi[k];
    const double middle2 = oracle_dot(middle, middle);
    for (uint32_t i = 0; i < s->photons; i++) {
        const vit_photon *q = photons + i;
        double d2 = 0, least = 0, off = 0;
        int near;
        for (int k = 0; k < 3; k++) {
            const double o = (double)q->position[k] - 0.5 * (c->lo[k] + c->hi[k]), d = (double)q->direction[k];
            d2 += o * o;
            off += o * middle[k];
            least += fmin(d * c->nlo[k], d * c->nhi[k]);
        }
        if (s->effects & VIT_BIT(FLATTENED) && middle2 > 0)
            d2 += off * off / middle2 * (double)s->flatten;
        if (!(q->radius2 > 0) || d2 >= (double)q->radius2)
            continue;
        const double weight = 1 - d2 / (double)q->radius2;
        const uint32_t bucket = oracle_bucket(s, q->direction, &near);
        const int zones = (s->effects & VIT_BIT(ZONES)) != 0;
        if (near || (!zones && fabs(least - ORACLE_BEHIND) < 1e-6)) {
            b->doubt += weight * (double)fmaxf(q->power[0], fmaxf(q->power[1], q->power[2]));
            continue;
        }
        if (zones ? (c->accept & q->zone) == 0 : least >= ORACLE_BEHIND)
            continue;
        for (int k = 0; k < 3; k++)
            b->sum[bucket][k] += weight * (double)q->power[k];
    }
}

/* Irradiance on a surface of unit normal n from a cluster's buckets (x, y, z, weight each). Octants count as far as they lie in
 * front, clamp(1 + n o); directions as 2 max(0, n d). */
static inline void oracle_bucket_light(const vit_scene *s, const float *buckets, const double n[3], double e[3]) {
    e[0] = e[1] = e[2] = 0;
    for (int b = 0; b < (s->effects & VIT_BIT(RAW_BUCKETS) ? ORACLE_DIRECTIONS : ORACLE_OCTANTS); b++) {
        double d[3], w;
        if (s->effects & VIT_BIT(RAW_BUCKETS)) {
            const int axis = b / 18;
            d[axis] = b / 9 % 2 ? -1 : 1;
            d[axis == 0 ? 1 : 0] = (b % 3 - 1) * 2 / 3.0;
            d[axis == 2 ? 1 : 2] = (b % 9 / 3 - 1) * 2 / 3.0;
            w = 2 * fmax(oracle_dot(n, d) / sqrt(oracle_dot(d, d)), 0);
        } else {
            for (int k = 0; k < 3; k++)
                d[k] = b >> k & 1 ? -1 : 1;
            w = fmin(fmax(1 + oracle_dot(n, d), 0), 1);
        }
        for (int k = 0; k < 3; k++)
            e[k] += w * (double)buckets[4 * b + k];
    }
}

/* Which clusters pixel (x, y)'s sample p lies between, and how much each counts: the two tiles across, two down and two slices
 * deep whose middles are nearest; linear in each, times 1 - (distance of the box's middle from the tangent plane / a tile's
 * width there)^2, at least 1/100. key: its own, for the direction's bits. find(data, key): the cluster and its buckets; NULL:
 * none. */
typedef const oracle_cluster *oracle_find(const void *data, uint32_t key, const float **buckets);

static inline void oracle_smooth_light(const vit_scene *s, const vit_camera *camera, const oracle_sample *p, uint32_t x,
                                       uint32_t y, uint32_t key, oracle_find *find, const void *data, double e[3]) {
    double depth = 0, pixel = 0, weights = 0, f[3];
    const uint32_t most[3] = {s->tiles_x, s->tiles_y, s->slice_count};
    for (int k = 0; k < 3; k++) {
        pixel += (double)camera->right[k] * (double)camera->right[k];
        depth += (p->position[k] - (double)camera->eye[k]) * (double)camera->forward[k];
        e[k] = 0;
    }
    depth = fmax(depth, (double)s->slice_near);
    f[0] = (x + 0.5) / s->tile - 0.5;
    f[1] = (y + 0.5) / s->tile - 0.5;
    f[2] = log2(depth / (double)s->slice_near) * (double)s->slice_scale - s->slice_first - 0.5;
    f[2] = fmin(fmax(f[2], -0.5), s->slice_count - 0.5);
    for (int corner = 0; corner < 8; corner++) {
        double w = 1, o[3], own[3];
        uint32_t at[3];
        for (int k = 0; k < 3; k++) {
            const double low = floor(f[k]), place = low + (corner >> k & 1);
            w *= place < 0 || place >= most[k] ? 0 : corner >> k & 1 ? f[k] - low : 1 - (f[k] - low);
            at[k] = place < 0 ? 0 : (uint32_t)place;
        }
        const float *buckets = NULL;
        const oracle_cluster *c = w > 0 ? find(data, oracle_key(s, at, key & ((1u << s->key_bits_n) - 1)), &buckets) : NULL;
        if (!c)
            continue;
        for (int k = 0; k < 3; k++)
            o[k] = 0.5 * (c->lo[k] + c->hi[k]) - p->position[k];
        const double off = oracle_dot(o, p->normal) / (depth * sqrt(pixel) * s->tile);
        w *= fmax(1 - off * off, 0.01);
        oracle_bucket_light(s, buckets, p->normal, own);
        weights += w;
        for (int k = 0; k < 3; k++)
            e[k] += w * own[k];
    }
    for (int k = 0; k < 3 && weights > 0; k++)
        e[k] /= weights;
}

#endif
