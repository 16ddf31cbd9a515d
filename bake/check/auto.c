#include "check/auto.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define AUTO_LIMIT                                                                                                             \
    0.035 /* farthest that a sum may be from right: the rest of CHECK_LIMIT is for pixels that were not looked at */
#define AUTO_TRUNCATED 0.02 /* of the light, of the darker half's too, may be beyond the last bounce */
#define AUTO_DIRECT 0.015   /* direct light may be off by so much before more points are looked at */
#define MOST_SAMPLES 256
#define MOST_PHOTONS 960000.0
#define AUTO_GAIN 4.0 /* so many times as many paths where they are worth something are worth guiding */
#define FINER 2       /* times that the distance of receivers is halved */
#define FAR_OFF 0.2   /* so far from right, a step of one rung is not worth its time */

/* A rung: factors on the automatic radius and on the default number of paths. */
typedef struct rung {
    double radius, photons;
    bool zones, light_zones, areas;
} rung;

static const rung rungs[] = {
    {1.0, 1, false, false, false},   {1.0, 1, true, false, true},      {0.75, 2, true, false, true},
    {0.5, 4, true, false, true},     {0.5, 4, true, true, true},       {0.375, 12, true, false, true},
    {0.1875, 24, true, false, true}, {0.09375, 56, true, false, true},
};

static const int bounces[] = {4, 6, 8, 12, 16, 24, 32};

typedef struct search {
    pipeline *p;
    progress *loud; /* says what is tried; the pipeline's own shows no more than its stages */
    auto_found *out;
    scene_quality base;   /* defaults and what is kept */
    scene_quality stated; /* the same, to begin anew */
    double radius;        /* that is automatic with the base, m; 0: there are no photons */
    bool photons;         /* the scene has indirect light */
    scene_quality first;  /* of the plainest pack, */
    check_found found;    /* what that has, and from then on the parts that direct light has in what was found last */
} search;

static bool kept(const search *s, uint64_t setting) {
    return (s->p->scene.quality_kept & setting) != 0;
}

/* Packs the frames of the check. */
static vit_status pack(const search *s, const scene_quality *q, pipeline_packed *out, vit_text *why) {
    pipeline_choice c = pipeline_default(s->p);
    c.quality = *q;
    c.frames = s->out->check.frames;
    c.frame_count = s->out->check.frame_count;
    return pipeline_pack(s->p, &c, out, why);
}

/* A line of what was tried; counts it. */
static void say_tried(const search *s, const scene_quality *q, const check_found *found) {
    char settings[AUTO_TEXT], figures[128];
    scene_quality_difference(q, settings, sizeof settings);
    check_text(found, figures, sizeof figures);
    progress_line(s->loud, false, "  tried { %s}: %s", settings, figures);
    s->out->tried++;
}

/* parts: direct light alone, too. */
static vit_status measure(const search *s, const scene_quality *q, bool parts, check_found *found, vit_text *why) {
    pipeline_packed packed;
    vit_status status = pack(s, q, &packed, why);
    if (status != VIT_OK)
        return status;
    status = check_compare(s->p, &packed, &s->out->check, parts, found, why);
    pipeline_packed_free(&packed);
    if (status == VIT_OK)
        say_tried(s, q, found);
    return status;
}

/* Is light looked up where it was baked or is gathered, and not photons' at all? */
static bool at_receivers(const scene_quality *q) {
    return q->indirect == INDIRECT_BASIS || q->indirect == INDIRECT_RADIOSITY;
}

/* Is it so by the baker's own choice? */
static bool may_fall_back(const search *s) {
    return at_receivers(&s->base) && s->p->indirect_why[0];
}

/* As many bounces as leave hardly any light out. */
static vit_status choose_bounces(search *s, const pipeline_packed *packed, vit_text *why) {
    const int count = (int)(sizeof bounces / sizeof bounces[0]);
    for (int i = 0; i < count && !kept(s, SETTING_BIT(bounces)); i++) {
        double share;
        s->base.bounces = bounces[i];
        const vit_status status = check_share(s->p, packed, &s->out->check, (uint32_t)bounces[i], &share, why);
        if (status != VIT_OK || share >= 1 - AUTO_TRUNCATED)
            return status;
    }
    return VIT_OK;
}

/* More points on area lights, more directions to the sky, as long as direct light is off and that helps. */
static vit_status choose_samples(search *s, const pipeline_packed *packed, double direct, vit_text *why) {
    const uint64_t e = packed->plan.scene.effects;
    const bool rays = !(e & VIT_BIT(LIGHTMAP)) || (e & VIT_BIT(SPECULAR)),
               points = rays && (e & VIT_BIT(AREA_LIGHTS)) && !kept(s, SETTING_BIT(light_samples)),
               directions = rays && (e & VIT_BIT(SKY_LIGHT)) && !kept(s, SETTING_BIT(sky_samples));
    for (int samples = 64; (points || directions) && samples <= MOST_SAMPLES && fabs(direct - 1) > AUTO_DIRECT; samples *= 4) {
        scene_quality q = s->base;
        check_found found;
        q.light_samples = points ? samples : q.light_samples;
        q.sky_samples = directions ? samples : q.sky_samples;
        const vit_status status = measure(s, &q, true, &found, why);
        if (status != VIT_OK)
            return status;
        if (fabs(found.direct - 1) > 0.8 * fabs(direct - 1))
            return VIT_OK;
        direct = found.direct;
        s->base = s->first = q;
        s->found = found;
    }
    return VIT_OK;
}

/* The plainest pack, guided where that is worth it. */
static vit_status pack_guided(search *s, pipeline_packed *out, vit_text *why) {
    const bool may = !kept(s, SETTING_BIT(guiding));
    s->base.guiding = may || s->base.guiding;
    vit_status status = pack(s, &s->base, out, why);
    if (status != VIT_OK || !may || out->guided_gain >= AUTO_GAIN)
        return status;
    s->base.guiding = false;
    pipeline_packed_free(out);
    return pack(s, &s->base, out, why);
}

/* The reference, if it is not there yet, and what follows from it and from the plainest pack. */
static vit_status begin(search *s, vit_text *why) {
    pipeline_packed packed;
    vit_status status = at_receivers(&s->base) ? pack(s, &s->base, &packed, why) : pack_guided(s, &packed, why);
    if (status != VIT_OK)
        return status;
    if (s->out->check.paths == 0)
        status = check_trace(s->p, &packed, &s->out->check, why);
    if (status == VIT_OK)
        status = check_compare(s->p, &packed, &s->out->check, true, &s->found, why);
    if (status == VIT_OK)
        say_tried(s, &s->base, &s->found);
    s->first = s->base;
    s->photons = (packed.plan.scene.effects & VIT_BIT(PHOTONS)) != 0;
    s->radius = (double)packed.plan.scene.radius;
    if (status == VIT_OK && (s->photons || s->base.indirect == INDIRECT_RADIOSITY))
        status = choose_bounces(s, &packed, why);
    if (status == VIT_OK)
        status = choose_samples(s, &packed, s->found.direct, why);
    pipeline_packed_free(&packed);
    return status;
}

static scene_quality quality_of(const search *s, const rung *r) {
    scene_quality q = s->base;
    q.zones = kept(s, SETTING_BIT(zones)) ? q.zones : r->zones;
    q.light_zones = kept(s, SETTING_BIT(light_zones)) ? q.light_zones : r->light_zones && q.zones;
    q.effective_area = kept(s, SETTING_BIT(effective_area)) ? q.effective_area : r->areas;
    if (!kept(s, SETTING_BIT(radius)) && r->radius < 1)
        q.radius = s->radius * r->radius;
    if (!kept(s, SETTING_BIT(photons)))
        q.photons = (int)fmin(q.photons * r->photons, MOST_PHOTONS);
    return q;
}

static bool is_tried(const scene_quality *tried, size_t count, const scene_quality *q) {
    char a[SCENE_QUALITY], b[SCENE_QUALITY];
    scene_quality_text(q, a, sizeof a);
    for (size_t i = 0; i < count; i++) {
        scene_quality_text(tried + i, b, sizeof b);
        if (strcmp(a, b) == 0)
            return true;
    }
    return false;
}

static double distance(const check_found *f) {
    double most = fabs(f->dark.value - 1);
    for (int k = 0; k < 3; k++)
        most = fmax(most, fabs(f->flux[k].value - 1));
    return most;
}

static vit_status climb(search *s, vit_text *why) {
    enum { RUNGS = sizeof rungs / sizeof rungs[0] };
    scene_quality tried[RUNGS];
    auto_found *a = s->out;
    double best = INFINITY;
    for (size_t i = 0, count = 0; i < RUNGS && !a->right && (s->photons || i == 0); i++) {
        check_found found;
        tried[count] = quality_of(s, rungs + i);
        if (is_tried(tried, count, tried + count))
            continue;
        const bool known = is_tried(&s->first, 1, tried + count);
        const vit_status status = known ? VIT_OK : measure(s, tried + count, false, &found, why);
        if (status != VIT_OK)
            return status;
        if (known)
            found = s->found;
        found.direct = s->found.direct; /* the same in all of them */
        if (distance(&found) < best) {
            best = distance(&found);
            a->found = found;
            s->p->scene.quality = tried[count];
        }
        a->right = best <= AUTO_LIMIT;
        i += i == 1 && distance(&found) > FAR_OFF;
        count++;
    }
    return VIT_OK;
}

/* With as many bounces as were chosen, and with receivers closer to each other if the picture is off. */
static vit_status refine_receivers(search *s, vit_text *why) {
    const vit_status again = s->base.bounces != s->first.bounces ? measure(s, &s->base, true, &s->found, why) : VIT_OK;
    if (again != VIT_OK)
        return again;
    for (int i = 0; i < FINER && s->found.worst > CHECK_LIMIT && !kept(s, SETTING_BIT(receiver_spacing)); i++) {
        scene_quality q = s->base;
        check_found found;
        q.receiver_spacing = fmax(q.receiver_spacing / 2, 1);
        const vit_status status = measure(s, &q, true, &found, why);
        if (status != VIT_OK || distance(&found) > distance(&s->found))
            return status;
        s->base = q;
        s->found = found;
    }
    return VIT_OK;
}

/* What was baked is right, or photons have to show that they are nearer to it. */
static vit_status take_receivers(search *s, vit_text *why) {
    auto_found *a = s->out;
    vit_status status = refine_receivers(s, why);
    a->found = s->found;
    a->right = distance(&s->found) <= AUTO_LIMIT;
    s->p->scene.quality = s->base;
    if (status != VIT_OK || a->found.worst <= CHECK_LIMIT || !may_fall_back(s))
        return status;
    const scene_quality of_baked = s->base;
    const auto_found found_baked = *a;
    char had[128], has[128];
    s->base = s->stated;
    s->base.indirect = INDIRECT_PHOTONS;
    status = begin(s, why);
    if (status == VIT_OK)
        status = climb(s, why);
    if (status != VIT_OK)
        return status;
    if (distance(&a->found) < distance(&found_baked.found)) {
        check_text(&found_baked.found, had, sizeof had);
        check_text(&a->found, has, sizeof has);
        (void)snprintf(s->p->indirect_why, sizeof s->p->indirect_why, "%s has %s of path tracing's, photons %s",
                       of_baked.indirect == INDIRECT_BASIS ? "the basis" : "radiosity", had, has);
        return VIT_OK;
    }
    a->found = found_baked.found;
    s->p->scene.quality = of_baked;
    return VIT_OK;
}

vit_status auto_choose(pipeline *p, auto_found *out, vit_text *why) {
    search s = {.p = p, .loud = p->progress, .out = out, .base = p->scene.quality, .stated = p->scene.quality};
    progress *const loud = p->progress;
    progress within = progress_within(loud);
    memset(out, 0, sizeof *out);
    check_choose((uint32_t)p->scene.frames, (uint32_t)p->scene.width, (uint32_t)p->scene.height, &out->check);
    progress_stage(loud, "choosing the quality");
    p->progress = &within;
    vit_status status = begin(&s, why);
    if (status == VIT_OK)
        status = at_receivers(&s.base) ? take_receivers(&s, why) : climb(&s, why);
    progress_end(&within);
    p->progress = loud;
    progress_end(loud);
    if (status == VIT_OK)
        scene_quality_difference(&p->scene.quality, out->text, sizeof out->text);
    return status;
}

void auto_say(const pipeline *p, const pipeline_packed *packed, const auto_found *a) {
    char figures[128], cure[256];
    check_found found = a->found;
    check_text(&found, figures, sizeof figures);
    found.limited = 1; /* that of the chosen bounces is */
    check_cure(&found, &p->scene.quality, &packed->plan, cure, sizeof cure);
    if (a->found.worst > CHECK_LIMIT)
        progress_line(
            p->progress, true,
            "warning: quality \"auto\": the best of %u settings, { %s}, has %s of path tracing's at %u pixels of %u frames%s%s",
            a->tried, a->text, figures, a->check.count, a->check.frame_count, cure[0] ? "; " : "", cure);
    else if (!a->text[0])
        progress_line(p->progress, false,
                      "quality \"auto\": the defaults are right; checked against path tracing at %u pixels of %u frames: %s",
                      a->check.count, a->check.frame_count, figures);
    else
        progress_line(p->progress, false,
                      "quality \"auto\": { %s}, of %u tried %s; checked against path tracing at %u pixels of %u frames: %s",
                      a->text, a->tried, a->right ? "the cheapest that is right" : "the best", a->check.count,
                      a->check.frame_count, figures);
    check_exposure(p, packed, &a->check, &a->found);
}
