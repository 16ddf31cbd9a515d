/* Zones: 32 colours for patches, so that a receiver can tell by a photon's colour whether to accept it. Patches that the same
 * receivers accept may share a colour; patches of one colour of which a receiver wants some and not others cost the smaller of
 * both weights. Greedy, then improved patch by patch; one thread, in a fixed order. */
#include "zones/parts.h"
#include <stdlib.h>
#include <string.h>

#define SWEEPS 4

typedef struct tally {
    float want[VIT_ZONES], refuse[VIT_ZONES]; /* a receiver: weight of its patches of each colour */
    float alike[VIT_ZONES];                   /* of those lit alike less the others */
} tally;

static void add(tally *t, const pair *p, uint32_t zone, float sign) {
    if (p->accept)
        t->want[zone] += sign * p->weight;
    else
        t->refuse[zone] += sign * p->wrong;
}

/* What each colour would cost the pair's receiver more. */
static void cost(const tally *t, const pair *p, float *sum) {
    const float want = p->accept ? p->weight : 0.0f, refuse = p->accept ? 0.0f : p->wrong;
    for (int c = 0; c < VIT_ZONES; c++)
        sum[c] += float_min(t->want[c] + want, t->refuse[c] + refuse) - float_min(t->want[c], t->refuse[c]);
}

bool zones_colour(zones *z) {
    tally *tallies = calloc(z->receiver_count + 1u, sizeof *tallies);
    size_t *first = calloc(z->patch_count + 2u, sizeof *first),
           *of = malloc((z->pair_count + 1) * sizeof *of); /* pairs by patch */
    bool fine = tallies && first && of;
    for (size_t i = 0; fine && i < z->pair_count; i++)
        first[z->pairs[i].patch + 2]++;
    for (uint32_t i = 2; fine && i < z->patch_count + 2u; i++)
        first[i] += first[i - 1];
    for (size_t i = 0; fine && i < z->pair_count; i++)
        of[first[z->pairs[i].patch + 1]++] = i;
    for (int sweep = 0; fine && sweep < SWEEPS; sweep++)
        for (uint32_t b = 0; b < z->patch_count; b++) {
            patch *p = z->patches + b;
            float sum[VIT_ZONES] = {0};
            uint32_t best = 0;
            for (size_t k = first[b]; k < first[b + 1]; k++) {
                const pair *q = z->pairs + of[k];
                if (sweep > 0)
                    add(tallies + q->receiver, q, p->zone, -1.0f);
                cost(tallies + q->receiver, q, sum);
            }
            for (uint32_t c = 1; c < VIT_ZONES; c++)
                best = sum[c] < sum[best] - 1e-6f * p->area ? c : best;
            p->zone = best;
            for (size_t k = first[b]; k < first[b + 1]; k++)
                add(tallies + z->pairs[of[k]].receiver, z->pairs + of[k], best, 1.0f);
        }
    for (size_t i = 0; fine && i < z->pair_count; i++) { /* what may stand in where too little is seen */
        const pair *q = z->pairs + i;
        tallies[q->receiver].alike[z->patches[q->patch].zone] += q->alike ? q->weight : -q->wrong;
    }
    double wrong = 0.0, all = 0.0;
    for (uint32_t i = 0; fine && i < z->receiver_count; i++)
        for (uint32_t c = 0; c < VIT_ZONES; c++) {
            const tally *t = tallies + i;
            const bool accept = z->in->zones ? t->want[c] > t->refuse[c] : true;
            z->receivers[i].accept |= accept ? 1u << c : 0u;
            z->receivers[i].alike |= t->alike[c] > 0.0f ? 1u << c : 0u;
            wrong += (double)float_min(t->want[c], t->refuse[c]);
            all += (double)t->want[c] + (double)t->refuse[c];
        }
    z->found->wrong = all > 0.0 ? wrong / all : 0.0;
    free(tallies);
    free(first);
    free(of);
    return fine;
}
