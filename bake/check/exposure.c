#include "check/exposure.h"
#include "check/check.h"
#include "common/colour.h"
#include <math.h>
#include <stdlib.h>

static double luminance_seen(const spot *s) {
    double sum = 0;
    for (uint32_t q = 0; q < REFERENCE_SEQUENCES; q++)
        sum += luminance(s->all[q][0], s->all[q][1], s->all[q][2]) / REFERENCE_SEQUENCES;
    return sum;
}

static int in_order(const void *a, const void *b) {
    const double x = *(const double *)a, y = *(const double *)b;
    return x < y ? -1 : x > y;
}

/* To 8 bits: a number that people can read, whatever a processor's last bits are. */
static double rounded(double factor) {
    int exponent;
    const double fraction = frexp(factor, &exponent);
    return ldexp(floor(fraction * 256 + 0.5) / 256, exponent);
}

static double factor_of(const check *c) {
    double seen[CHECK_PIXELS];
    uint32_t count = 0;
    for (uint32_t i = 0; i < c->count; i++)
        if (c->spots[i].hit && luminance_seen(c->spots + i) > 0)
            seen[count++] = luminance_seen(c->spots + i);
    if (count == 0)
        return 1;
    qsort(seen, count, sizeof *seen, in_order);
    return rounded(EXPOSURE_GREY / seen[count / 2]);
}

vit_status exposure_settle(pipeline *p, vit_text *why) {
    scene *s = &p->scene;
    pipeline_packed packed;
    check c;
    if (!s->exposure_auto)
        return VIT_OK;
    check_choose((uint32_t)s->frames, (uint32_t)s->width, (uint32_t)s->height, &c);
    pipeline_choice choice = pipeline_default(p);
    choice.quality.photons = 0; /* the light is the reference's */
    choice.frames = c.frames;
    choice.frame_count = c.frame_count;
    vit_status status = pipeline_pack(p, &choice, &packed, why);
    if (status != VIT_OK)
        return status;
    progress_stage(p->progress, "exposure");
    status = check_glance(p, &packed, &c, why);
    progress_end(p->progress);
    if (status == VIT_OK) {
        s->exposure_factor = factor_of(&c);
        progress_line(p->progress, false, "exposure \"auto\": %g in frame 0, the median of what is seen is %g of white",
                      (double)packed.tracks.cameras[0].exposure * s->exposure_factor, EXPOSURE_GREY);
    }
    pipeline_packed_free(&packed);
    return status;
}
