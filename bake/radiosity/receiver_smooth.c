/* Noise of receivers. Where neighbours differ by no more than noise makes them, each takes the mean of those round about
 * (bilateral filtering: Tomasi and Manduchi 1998, with the noise of each as the range); where light really changes they stay.
 */
#include "common/parallel.h"
#include "radiosity/receivers.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define ROUNDS 3  /* each as far as one cell is wide */
#define ALIKE 3.0 /* deviations of their difference, from which on two are not alike */

/* Neighbours: corners of one cell. */
typedef struct neighbours {
    uint32_t *first; /* a receiver, and an end */
    uint32_t *of;
} neighbours;

static void visit(const receivers *r, neighbours *n, bool count) {
    for (uint32_t i = 0; i < r->cell_count + r->split_count; i++) {
        const vit_u32 *corner = i < r->cell_count ? r->cells[i].receiver : r->splits[i - r->cell_count].receiver;
        if ((i < r->cell_count && VIT_RECEIVER_IS_DIVIDED(r->cells[i].split)) || corner[0] >= r->count ||
            corner[1] >= r->count || corner[2] >= r->count) /* of dark sides, while they have some */
            continue;
        for (int a = 0; a < 3; a++)
            for (int b = 0; b < 3; b++)
                if (corner[a] != corner[b] && count)
                    n->first[corner[a] + 2]++;
                else if (corner[a] != corner[b])
                    n->of[n->first[corner[a] + 1]++] = corner[b];
    }
}

/* False: out of memory. */
static bool find_neighbours(const receivers *r, neighbours *n) {
    n->first = calloc(r->count + 3u, sizeof *n->first);
    if (!n->first)
        return false;
    visit(r, n, true);
    for (uint32_t i = 2; i < r->count + 2u; i++)
        n->first[i] += n->first[i - 1];
    n->of = malloc((n->first[r->count + 1] + 1u) * sizeof *n->of);
    if (n->of)
        visit(r, n, false);
    return n->of != NULL;
}

static bool is_known(const receivers *r, uint32_t i) {
    return r->receivers[i].asked && !r->receivers[i].follows;
}

bool receivers_pool_noise(const receivers *r, float *noise) {
    neighbours n = {0};
    float *own = malloc((r->count + 1u) * sizeof *own);
    const bool fine = own && find_neighbours(r, &n);
    if (fine)
        memcpy(own, noise, r->count * sizeof *own);
    for (uint32_t i = 0; i < r->count && fine; i++) {
        double squares = (double)own[i] * (double)own[i], all = 1.0;
        for (uint32_t k = n.first[i]; k < n.first[i + 1] && is_known(r, i); k++)
            if (is_known(r, n.of[k])) {
                squares += (double)own[n.of[k]] * (double)own[n.of[k]];
                all += 1.0;
            }
        noise[i] = (float)sqrt(squares / all);
    }
    free(own);
    free(n.first);
    free(n.of);
    return fine;
}

typedef struct smoothing {
    const receivers *r;
    neighbours n;
    uint32_t columns;
    const float *irradiance, *noise;
    float *to, *noise_to;
} smoothing;

/* 1 where they are the same, 0 where they are not alike. */
static double alike(const smoothing *s, uint32_t a, uint32_t b) {
    const double noise = (double)s->noise[a] * (double)s->noise[a] + (double)s->noise[b] * (double)s->noise[b];
    double differ = 0.0;
    for (uint32_t c = 0; c < s->columns; c++)
        differ += fabs((double)s->irradiance[(size_t)a * s->columns + c] - (double)s->irradiance[(size_t)b * s->columns + c]);
    const double part = differ * differ, all = ALIKE * ALIKE * noise;
    return part < all ? (1.0 - part / all) * (1.0 - part / all) : 0.0;
}

static void smooth_one(void *user, uint32_t i) {
    const smoothing *s = user;
    float *to = s->to + (size_t)i * s->columns;
    const float *own = s->irradiance + (size_t)i * s->columns;
    double all = 1.0, squares = (double)s->noise[i] * (double)s->noise[i];
    memcpy(to, own, s->columns * sizeof *to);
    for (uint32_t k = s->n.first[i]; k < s->n.first[i + 1] && !s->r->receivers[i].follows; k++) {
        const uint32_t j = s->n.of[k];
        const double w = 0.5 * alike(s, i, j);
        const float *from = s->irradiance + (size_t)j * s->columns;
        for (uint32_t c = 0; c < s->columns && w > 0.0; c++)
            to[c] += (float)w * from[c];
        all += w;
        squares += w * w * (double)s->noise[j] * (double)s->noise[j];
    }
    for (uint32_t c = 0; c < s->columns; c++)
        to[c] /= (float)all;
    s->noise_to[i] = (float)(sqrt(squares) / all);
}

bool receivers_smooth(const receivers *r, float *irradiance, float *noise, uint32_t columns, unsigned threads) {
    const size_t numbers = (size_t)r->count * columns;
    smoothing s = {.r = r,
                   .columns = columns,
                   .irradiance = irradiance,
                   .noise = noise,
                   .to = malloc((numbers + 1u) * sizeof *s.to),
                   .noise_to = malloc((r->count + 1u) * sizeof *s.noise_to)};
    const bool fine = s.to && s.noise_to && find_neighbours(r, &s.n);
    for (int round = 0; round < ROUNDS && fine; round++) {
        parallel_for(threads, r->count, smooth_one, &s);
        memcpy(irradiance, s.to, numbers * sizeof *irradiance);
        memcpy(noise, s.noise_to, r->count * sizeof *noise);
        receivers_follow(r, irradiance, columns);
        receivers_follow(r, noise, 1);
    }
    free(s.n.first);
    free(s.n.of);
    free(s.to);
    free(s.noise_to);
    return fine;
}
