/* How far a coded matrix is from the matrix, entry by entry and in the light that it reflects. */
#include "common/fail.h"
#include "common/parallel.h"
#include "radiosity/codec_parts.h"
#include <math.h>
#include <stdlib.h>

typedef struct row_error {
    double sum, most, light_error, light;
} row_error;

typedef struct judging {
    const codec_input *in;
    const uint32_t *words;
    const float *lights;
    uint32_t count;
    row_error *rows;
} judging;

static void judge_row(void *user, uint32_t i) {
    const judging *g = user;
    const size_t n = g->in->matrix->count;
    row_error e = {0};
    float row[VIT_TRANSFER_MOST_PATCHES];
    for (uint32_t c = 0; c < TRANSFER_CHANNELS; c++) {
        const float *right = g->in->matrix->s[c] + i * n;
        codec_row(g->words, i, c, row);
        for (size_t j = 0; j < n; j++) {
            const double by = fabs((double)row[j] - (double)right[j]);
            e.sum += by;
            e.most = by > e.most ? by : e.most;
        }
        for (uint32_t l = 0; l < g->count; l++) {
            const float *light = g->lights + l * n * 3 + c;
            double off = 0.0, all = 0.0;
            for (size_t j = 0; j < n; j++)
                if (light[3 * j] > 0.0f) {
                    off += ((double)row[j] - (double)right[j]) * (double)light[3 * j];
                    all += (double)right[j] * (double)light[3 * j];
                }
            const double area = g->in->area ? (double)g->in->area[i] : 1.0;
            e.light_error += area * off * off;
            e.light += area * all * all;
        }
    }
    g->rows[i] = e;
}

vit_status codec_judge(const codec_input *in, const coded *c, const float *lights, uint32_t count, codec_errors *out,
                       vit_text *why) {
    const uint32_t n = in->matrix->count;
    judging g = {in, c->words, lights, count, malloc(n * sizeof *g.rows)};
    double light_error = 0.0, light = 0.0;
    *out = (codec_errors){.bytes = 4.0 * (double)c->count};
    if (!g.rows)
        return bake_fail(why, VIT_FAILED, "errors of a coded transfer matrix: out of memory");
    parallel_for(in->threads, n, judge_row, &g);
    for (uint32_t i = 0; i < n; i++) {
        out->sum += g.rows[i].sum;
        out->most = g.rows[i].most > out->most ? g.rows[i].most : out->most;
        light_error += g.rows[i].light_error;
        light += g.rows[i].light;
    }
    out->mean = out->sum / (3.0 * n * n);
    out->light = light > 0.0 ? sqrt(light_error / light) : 0.0;
    free(g.rows);
    return VIT_OK;
}
