#include "radiosity/lightmap.h"
#include "common/fail.h"
#include "common/parallel.h"
#include "radiosity/soft_light.h"
#include <stdlib.h>
#include <string.h>

#define LEAST_RECEIVERS 2048u
#define MOST_RECEIVERS 131072u
#define LOOK_ERROR 0.15f /* of the error that is allowed: soft_lights.error */
#define OFF_LIMITS 3.0f  /* errors: where light is known no better, rays find it */
#define DIM 0.02f        /* of the mean light of the first receivers: less counts as so much */
#define PILOTS 256u      /* of these, at most */
#define CHUNK 64u        /* places between two looks at the clock */

typedef struct finding {
    const lightmap_input *in;
    soft_lights lights;
    const receivers *r;
    float *known; /* receivers whose light is known: 3 each */
    uint32_t known_count;
    int looks; /* that are over or under way */
    uint64_t rays;
} finding;

static void light_of(void *user, uint32_t side, float b1, float b2, float *irradiance) {
    const finding *f = user;
    soft_light_at(&f->lights, side, b1, b2, irradiance);
}

static void light_chunk(void *user, uint32_t chunk, uint64_t *rays) {
    const finding *f = user;
    const uint32_t first = f->known_count + chunk * CHUNK, left = f->r->count - first, count = left < CHUNK ? left : CHUNK;
    for (uint32_t i = first; i < first + count; i++) {
        const receiver *r = f->r->receivers + i;
        *rays += soft_light_at(&f->lights, r->side, r->b1, r->b2, f->known + 3 * (size_t)i);
    }
}

static void step(void *user, double fraction) {
    const finding *f = user;
    if (f->in->progress)
        f->in->progress(f->in->user, (f->looks - 1 + fraction) / (VIT_RECEIVER_LEVELS + 1));
}

/* What counts as dark, from the light of some. */
static void find_dim(finding *f) {
    const uint32_t apart = f->r->count / PILOTS + 1;
    double sum = 0.0;
    uint32_t count = 0;
    f->lights.dim = INFINITY;
    for (uint32_t i = 0; i < f->r->count; i += apart, count++) {
        const receiver *r = f->r->receivers + i;
        float e[3];
        soft_light_at(&f->lights, r->side, r->b1, r->b2, e);
        sum += (double)e[0] + (double)e[1] + (double)e[2];
    }
    f->lights.dim = count > 0 ? (float)(DIM * sum / count) : 0.0f;
}

/* receivers_input.look: of those that are new. */
static vit_status look(void *user, const receivers *r, float *irradiance, float *noise, vit_text *why) {
    finding *f = user;
    float *more = realloc(f->known, ((size_t)r->count * 3 + 1) * sizeof *more);
    if (!more)
        return bake_fail(why, VIT_FAILED, "lightmap: out of memory");
    f->known = more;
    f->r = r;
    f->looks++;
    if (f->known_count == 0)
        find_dim(f);
    const parallel_work work = {.run = light_chunk,
                                .done = step,
                                .user = f,
                                .step = 1,
                                .count = (r->count - f->known_count + CHUNK - 1) / CHUNK,
                                .threads = f->in->threads};
    parallel_run(&work, &f->rays);
    f->known_count = r->count;
    memcpy(irradiance, f->known, (size_t)r->count * 3 * sizeof *irradiance);
    receivers_follow(r, irradiance, 3);
    if (noise) /* what is left changes as slowly from place to place as light does */
        memset(noise, 0, r->count * sizeof *noise);
    return VIT_OK;
}

vit_status lightmap_find(const lightmap_input *in, lightmap *out, vit_text *why) {
    *out = (lightmap){0};
    finding f = {.in = in,
                 .lights = {.rays = in->rays,
                            .geometry = in->geometry,
                            .area = in->area,
                            .sky = in->sky,
                            .error = (float)in->error * LOOK_ERROR}};
    const receivers_input place = {.rays = in->rays,
                                   .geometry = in->geometry,
                                   .tracks = in->tracks,
                                   .frames = in->frames,
                                   .width = in->width,
                                   .height = in->height,
                                   .size = (float)in->size,
                                   .within = in->within,
                                   .spacing = (float)in->spacing,
                                   .least = LEAST_RECEIVERS,
                                   .most = MOST_RECEIVERS,
                                   .records = UINT32_MAX,
                                   .threads = in->threads,
                                   .look = look,
                                   .user = &f,
                                   .columns = 3,
                                   .light = light_of,
                                   .error = (float)in->error,
                                   .off_limits = (float)in->error * OFF_LIMITS};
    vit_status status = receivers_place(&place, &out->receivers, why);
    free(f.known);
    out->rays = f.rays;
    if (status != VIT_OK)
        return status;
    out->light = calloc(out->receivers.count + 1u, sizeof *out->light);
    if (!out->light) {
        lightmap_free(out);
        return bake_fail(why, VIT_FAILED, "lightmap: out of memory");
    }
    for (size_t i = 0; i < out->receivers.count; i++)
        memcpy(out->light[i].irradiance, out->receivers.irradiance + 3 * i, sizeof out->light[i].irradiance);
    return VIT_OK;
}

void lightmap_free(lightmap *m) {
    receivers_free(&m->receivers);
    free(m->light);
    *m = (lightmap){0};
}

static bool copy(const lightmap *from, lightmap *to) {
    *to = *from;
    to->light = receivers_copied(from->light, from->receivers.count, sizeof *from->light);
    if (receivers_copy(&from->receivers, 0, &to->receivers) && !to->light == !from->light)
        return true;
    lightmap_free(to);
    return false;
}

static bool same(double a, double b) {
    return !(a < b) && !(a > b);
}

static bool is_of(const lightmap_input *k, const lightmap_input *in) {
    return k->frames == in->frames && k->width == in->width && k->height == in->height && k->within == in->within &&
           !k->area == !in->area && !k->sky == !in->sky && same(k->spacing, in->spacing) && same(k->error, in->error);
}

bool lightmap_kept_get(lightmap_kept *k, const lightmap_input *in, lightmap *out) {
    for (int i = 0; i < LIGHTMAP_KEPT; i++)
        if (k->one[i].asked > 0 && is_of(&k->one[i].in, in) && copy(&k->one[i].map, out)) {
            k->one[i].asked = ++k->asked;
            return true;
        }
    return false;
}

void lightmap_kept_put(lightmap_kept *k, const lightmap_input *in, const lightmap *m) {
    int oldest = 0;
    for (int i = 1; i < LIGHTMAP_KEPT; i++)
        oldest = k->one[i].asked < k->one[oldest].asked ? i : oldest;
    lightmap_free(&k->one[oldest].map);
    k->one[oldest].in = *in;
    k->one[oldest].asked = copy(m, &k->one[oldest].map) ? ++k->asked : 0;
}

void lightmap_kept_free(lightmap_kept *k) {
    for (int i = 0; i < LIGHTMAP_KEPT; i++)
        lightmap_free(&k->one[i].map);
    *k = (lightmap_kept){0};
}
