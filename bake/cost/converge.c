/* steps, partners -> sweep.c -> pictures, reference -> errors and their parts -> lines. */
#include "cost/converge.h"
#include "common/fail.h"
#include "cost/knobs.h"
#include <math.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#define PARTNER 1.6 /* times its step's paths */

static vit_status fail(vit_status status, vit_text *why, const char *cause) {
    return bake_fail(why, status, "%s", cause);
}

/* Which step the scene's own setting is: the middle one, or a later one if there would be too many paths in the end. */
static uint32_t own_step(double paths, uint32_t steps) {
    uint32_t at = steps / 2;
    while (at + 1 < steps && paths * pow(CONVERGE_GROWTH, steps - 1 - at) > CONVERGE_MOST_PATHS)
        at++;
    return at;
}

static knob_setting setting(const scene_quality *base, double paths, double radius, bool partner) {
    knob_setting k = {.knob = "several", .scale = 1.0, .quality = *base};
    k.quality.photons = (int)(paths + 0.5);
    k.quality.radius = radius;
    k.quality.buckets = k.quality.raw = false;
    k.quality.indirect_samples = 1;
    if (partner)
        k.quality.bounce_sequence = !base->bounce_sequence;
    (void)snprintf(k.name, sizeof k.name, "%d photons, radius %.3g m%s", k.quality.photons, radius, partner ? ", partner" : "");
    return k;
}

vit_status converge_list(const void *user, const scene_quality *base, double radius, struct knob_list *out, vit_text *why) {
    const converge_plan *how = user;
    const uint32_t steps = how->steps, own = own_step(base->photons, steps);
    *out = (knob_list){.count = 2 * steps, .most = 2 * steps};
    if (base->photons == 0 || base->bounces < 2 || !(radius > 0))
        return fail(VIT_BAD_INPUT, why, "--converge: the scene has no indirect light (photons, bounces, lights)");
    out->settings = calloc(out->count, sizeof *out->settings);
    if (!out->settings)
        return fail(VIT_FAILED, why, "out of memory");
    for (uint32_t i = 0; i < steps; i++) {
        const double growth = pow(CONVERGE_GROWTH, (double)i - own), paths = fmax(base->photons * growth, 1),
                     shrunk = radius * pow(growth, -how->shrink),
                     others = paths * PARTNER <= CONVERGE_MOST_PATHS ? paths * PARTNER : paths / PARTNER;
        out->settings[i] = setting(base, paths, shrunk, false);
        out->settings[steps + i] = setting(base, others, shrunk, true);
    }
    return VIT_OK;
}

converge_line converge_fit(const double *x, const double *y, uint32_t count) {
    converge_line l = {NAN, NAN, NAN, 0};
    double mx = 0, my = 0, xx = 0, xy = 0, rest = 0;
    for (uint32_t i = 0; i < count; i++)
        if (x[i] > 0 && y[i] > 0) {
            mx += log(x[i]);
            my += log(y[i]);
            l.points++;
        }
    if (l.points < 3)
        return l;
    mx /= l.points;
    my /= l.points;
    for (uint32_t i = 0; i < count; i++)
        if (x[i] > 0 && y[i] > 0) {
            xx += (log(x[i]) - mx) * (log(x[i]) - mx);
            xy += (log(x[i]) - mx) * (log(y[i]) - my);
        }
    if (!(xx > 1e-12)) /* all x alike */
        return l;
    l.slope = xy / xx;
    for (uint32_t i = 0; i < count; i++)
        if (x[i] > 0 && y[i] > 0) {
            const double d = log(y[i]) - my - l.slope * (log(x[i]) - mx);
            rest += d * d;
        }
    l.slope_error = sqrt(rest / (l.points - 2) / xx);
    l.at_one = exp(my - l.slope * mx);
    return l;
}

/* Means over all values, of which there are 3 a pixel. */
typedef struct means {
    double total, indirect, direct; /* of the reference */
    size_t values;
} means;

static means means_of(const reference *f) {
    means m = {.values = 3 * (size_t)f->width * f->height};
    for (size_t i = 0; i < m.values; i++) {
        m.direct += f->direct[i] / (double)m.values;
        m.indirect += f->limited[i] / (double)m.values;
    }
    m.total = m.direct + m.indirect;
    return m;
}

/* Two frames with independent photons err alike by what photons do not remove, and by the reference's own error. */
static double common_error(const reference *f, const means *m, const float *a, const float *b) {
    double sum = 0;
    for (size_t i = 0; i < m->values; i++) {
        const double x = f->direct[i] + f->limited[i];
        sum += ((double)a[i] - x) * ((double)b[i] - x);
    }
    return sum / (double)m->values / (m->total * m->total) - f->error;
}

static void fill_step(const cost_results *r, const means *m, uint32_t i, uint32_t steps, converge_step *out) {
    const cost_setting *s = &r->settings[i];
    scene_quality q;
    vit_text why;
    if (sweep_quality(s, &q, &why) != VIT_OK) /* it was made from one */
        return;
    *out =
        (converge_step){.paths = (uint32_t)q.photons, .radius = q.radius, .total = s->total, .ms = s->ms, .ms_mad = s->ms_mad};
    const double brighter = m->total / m->indirect;
    out->indirect = s->indirect.nmse * brighter * brighter;
    out->blur = common_error(&r->reference, m, s->image, r->settings[steps + i].image);
    out->noise = s->total.nmse - r->reference.error - out->blur;
}

/* Line of the number at `field` of the steps, over their paths or radii. */
static converge_line line_of(const converge_results *c, bool over_radius, size_t field) {
    double x[CONVERGE_MOST] = {0}, y[CONVERGE_MOST] = {0};
    for (uint32_t i = 0; i < c->count; i++) {
        const converge_step *s = &c->steps[i];
        x[i] = over_radius ? s->radius : s->paths;
        memcpy(&y[i], (const char *)s + field, sizeof y[i]);
    }
    return converge_fit(x, y, c->count);
}

static void derive(const cost_results *r, uint32_t steps, converge_results *c) {
    const means m = means_of(&r->reference);
    memcpy(c->scene, r->scene, sizeof c->scene);
    memcpy(c->device, r->device, sizeof c->device);
    c->width = r->width;
    c->height = r->height;
    c->frame = r->frame;
    c->samples = r->reference.samples;
    c->own = r->reference.error;
    c->truncation = r->truncation;
    c->normals = r->normals;
    c->direct = r->direct.nmse;
    c->count = steps;
    for (uint32_t i = 0; i < steps; i++)
        fill_step(r, &m, i, steps, &c->steps[i]);
    c->error = line_of(c, false, offsetof(converge_step, total.nmse));
    c->indirect = line_of(c, false, offsetof(converge_step, indirect));
    c->noise = line_of(c, false, offsetof(converge_step, noise));
    c->blur = line_of(c, true, offsetof(converge_step, blur));
}

vit_status converge_run(const sweep_input *in, const converge_plan *how, converge_results *out, vit_text *why) {
    sweep_input own = *in;
    cost_results r;
    memset(out, 0, sizeof *out);
    out->shrink = how->shrink;
    own.knobs = NULL;
    own.pipeline->scene.quality.indirect = INDIRECT_PHOTONS; /* that have what is to converge */
    own.list = converge_list;
    own.list_user = how;
    own.timed = how->steps;
    own.frames = 1;
    own.normals = true;
    vit_status status = sweep_run(&own, &r, why);
    if (status == VIT_OK && r.count > 0) {
        derive(&r, how->steps, out);
        if (out->error.points < out->count) /* not a number, where the mean is 0 */
            status = fail(VIT_BAD_INPUT, why, "--converge: nothing to measure: the frame shows no light");
    }
    sweep_free(&r);
    return status;
}
