#include "radiosity/live.h"
#include "common/fail.h"
#include "radiosity/live_parts.h"
#include <stdlib.h>
#include <string.h>

#define FORM_FACTOR_RAYS 2048u /* a patch */
#define OF_FORM_FACTORS 0.3    /* of the progress, */
#define OF_TRANSFER 0.3

typedef struct stretch {
    const live_input *in;
    double from, part;
} stretch;

static void step(void *user, double done) {
    const stretch *s = user;
    if (s->in->progress)
        s->in->progress(s->in->user, s->from + s->part * done);
}

/* The matrix of all reflections between patches but the one that receivers see, as a code. */
static vit_status transfer(const live_input *in, const patch_set *p, live *out, vit_text *why) {
    stretch s = {in, 0.0, OF_FORM_FACTORS};
    form_factors f = {0};
    transfer_matrix m = {0};
    const form_factors_input factors = {.rays = in->rays,
                                        .geometry = in->geometry,
                                        .patches = p,
                                        .samples = FORM_FACTOR_RAYS,
                                        .threads = in->threads,
                                        .progress = step,
                                        .user = &s};
    vit_status status = form_factors_find(&factors, &f, why);
    if (status == VIT_OK) {
        s.from = OF_FORM_FACTORS;
        s.part = OF_TRANSFER;
        out->unequal = f.unequal;
        const transfer_matrix_input sum = {.factors = &f,
                                           .patches = p,
                                           .bounces = in->reflections == TRANSFER_CONVERGED ? TRANSFER_CONVERGED
                                                                                            : in->reflections - 1u,
                                           .threads = in->threads,
                                           .progress = step,
                                           .user = &s};
        status = transfer_matrix_make(&sum, &m, why);
        form_factors_free(&f);
    }
    float *area = status == VIT_OK ? malloc((p->count + 1u) * sizeof *area) : NULL;
    if (status == VIT_OK && !area)
        status = bake_fail(why, VIT_FAILED, "live radiosity: out of memory");
    if (status == VIT_OK) {
        for (uint32_t i = 0; i < p->count; i++)
            area[i] = p->patch[i].area;
        memcpy(out->spectral, m.spectral, sizeof out->spectral);
        const codec_input code = {.matrix = &m, .area = area, .codec = in->codec, .keep = -1.0, .threads = in->threads};
        status = codec_encode(&code, &out->transfer, why);
    }
    free(area);
    transfer_matrix_free(&m);
    return status;
}

vit_status live_find(const live_input *in, live *out, vit_text *why) {
    *out = (live){0};
    patch_set p;
    const patches_input patches = {.rays = in->rays,
                                   .geometry = in->geometry,
                                   .tracks = in->tracks,
                                   .frames = in->frames,
                                   .width = in->width,
                                   .height = in->height,
                                   .count = in->patches,
                                   .threads = in->threads};
    vit_status status = patches_make(&patches, &p, why);
    if (status != VIT_OK)
        return status;
    if (p.count > 0) {
        status = live_points(in, &p, out, why);
        if (status == VIT_OK && in->reflections != 1u)
            status = transfer(in, &p, out, why);
        if (status == VIT_OK)
            status = live_rows(in, &p, out, why);
    }
    patches_free(&p);
    if (status != VIT_OK)
        live_free(out);
    return status;
}

void live_free(live *l) {
    free(l->patches);
    free(l->points);
    free(l->rows);
    free(l->words);
    free(l->looked);
    coded_free(&l->transfer);
    *l = (live){0};
}
