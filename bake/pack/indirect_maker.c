/* The rules, in their order:
 *   photons where mirrors and glass send light on to matt surfaces: receivers are lit by surfaces, not by what those focus;
 *   live radiosity where a light's track is too long, or jumps too often, for the knots that the basis has, or where irradiance
 *   in all states of the lights would be too much (quality.basis_bytes), if radiosity itself is not too much; then photons;
 *   else the basis, which has no noise and costs a tenth.
 * Scenes have no lights but on tracks that are known. Lights that nobody knows beforehand, once there are such, are the second
 * rule's as well: take_live(). */
#include "pack/indirect_maker.h"
#include "common/fail.h"
#include "light/caustic_share.h"
#include "radiosity/baked.h"
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>

#define PATHS 65536u     /* of all lights together */
#define LEAST_PATHS 256u /* of one, in one frame */
#define FRAMES 8u        /* of a light that moves */

static void take(plan *p, int maker, const char *format, ...) __attribute__((format(printf, 3, 4)));
static void take(plan *p, int maker, const char *format, ...) {
    va_list list;
    va_start(list, format);
    (void)vsnprintf(p->indirect_why, sizeof p->indirect_why, format, list);
    va_end(list);
    p->indirect = maker;
}

static uint32_t paths_of(const plan_input *in, const plan *p, uint32_t light) {
    return p->baked_paths[light] + in->tracks->lights[light].path_count;
}

static uint32_t all_paths(const plan_input *in, const plan *p) {
    uint32_t all = p->area_paths + p->sky_paths;
    for (uint32_t i = 0; i < in->tracks->light_count; i++)
        all += paths_of(in, p, i);
    return all;
}

typedef struct looking {
    const plan_input *in;
    const photon_rays *rays;
    uint32_t all;      /* paths that the plan shares out */
    caustic_share sum; /* of all lights, a frame's mean */
} looking;

/* paths: that the plan gives the light; frames: of which this is one. */
static bool look(looking *w, photons_light l, uint32_t paths, uint32_t frames) {
    caustic_share s;
    if (paths == 0)
        return true;
    l.paths = (uint32_t)((uint64_t)PATHS * paths / w->all / frames);
    l.paths = l.paths < LEAST_PATHS ? LEAST_PATHS : l.paths;
    if (!caustic_share_find(w->rays, &l, w->in->threads, &s))
        return false;
    w->sum.straight += s.straight / frames;
    w->sum.by_specular += s.by_specular / frames;
    return true;
}

static bool look_at_lights(looking *w, const plan *p) {
    const tracks *t = w->in->tracks;
    const uint32_t frames = (uint32_t)w->in->scene->frames, most = frames < FRAMES ? frames : FRAMES;
    bool fine = look(w, (photons_light){.area = &p->area}, p->area_paths, 1);
    const vit_light round = {.position = {p->sky_center[0], p->sky_center[1], p->sky_center[2]}, .spot_scale = p->sky_radius};
    fine = fine && look(w, (photons_light){.light = round, .sky = w->in->sky}, p->sky_paths, 1);
    for (uint32_t i = 0; i < t->light_count; i++) {
        const uint32_t count = t->still[i] ? 1 : most;
        for (uint32_t k = 0; k < count && fine; k++) {
            const uint32_t frame = (2 * k + 1) * frames / (2 * count);
            fine =
                look(w, (photons_light){.light = t->lights[(size_t)frame * t->light_count + i]}, paths_of(w->in, p, i), count);
        }
    }
    return fine;
}

/* The part of light that comes by mirrors and glass. */
static vit_status caustic_part(const plan_input *in, const plan *p, double *part, vit_text *why) {
    const scene *s = in->scene;
    const uint64_t out = s->effects_choice == EFFECTS_LISTED ? EFFECTS_NAMED & ~s->effects : 0, e = p->scene.effects & ~out;
    *part = 0;
    if (!s->quality.caustics || !(e & (VIT_BIT(MIRROR) | VIT_BIT(GLASS))))
        return VIT_OK;
    const photon_scene lit = {.triangles = in->geometry->triangles,
                              .attributes = in->geometry->attributes,
                              .triangle_count = in->model->triangles,
                              .materials = p->materials,
                              .atlas = in->atlas,
                              .ray_offset = p->scene.ray_offset,
                              .box_pad = p->scene.box_pad,
                              .effects = e};
    photon_rays rays;
    if (!photon_rays_open(&lit, in->threads, &rays))
        return bake_fail(why, VIT_FAILED, "indirect light: Embree fails");
    looking w = {.in = in, .rays = &rays, .all = all_paths(in, p)};
    const bool fine = look_at_lights(&w, p);
    photon_rays_close(&rays);
    const double all = w.sum.straight + w.sum.by_specular;
    *part = all > 0 ? w.sum.by_specular / all : 0;
    return fine ? VIT_OK : bake_fail(why, VIT_FAILED, "indirect light: out of memory");
}

static vit_status foresee(const plan_input *in, const plan *p, baked_foreseen *out, vit_text *why) {
    uint32_t count = 0, *moving = malloc((in->tracks->light_count + 1u) * sizeof *moving);
    if (!moving)
        return bake_fail(why, VIT_FAILED, "indirect light: out of memory");
    for (uint32_t i = 0; i < in->tracks->light_count; i++)
        if (!in->tracks->still[i] && paths_of(in, p, i) > 0)
            moving[count++] = i;
    const vit_status status =
        baked_foresee(in->tracks, (uint32_t)in->scene->frames, moving, count, (double)p->sky_radius, out, why);
    free(moving);
    return status;
}

/* What live radiosity takes while it is baked: what receivers see, form factors, the irradiance of the first look. */
static double live_bytes(const scene_quality *q, const baked_foreseen *f) {
    const double patches = q->patches, seen = (double)f->receivers * q->receiver_rays;
    return sizeof(vit_u32) * seen + 3.0 * sizeof(float) * patches * patches + f->live_bytes;
}

/* For lights that the basis does not suit; `why` says what is wrong with it. Still light takes as much by either. */
static void take_live(plan *p, const scene_quality *q, const baked_foreseen *f, const char *why) {
    const double bytes = live_bytes(q, f);
    if (f->states > 1 && bytes <= q->basis_bytes)
        take(p, INDIRECT_RADIOSITY, "%s", why);
    else if (f->states > 1)
        take(p, INDIRECT_PHOTONS, "%s, and light between patches may take %.3g bytes", why, bytes);
    else
        take(p, INDIRECT_PHOTONS, "%s", why);
}

vit_status indirect_maker_choose(const plan_input *in, plan *p, vit_text *why) {
    static const char by_mirrors[] = "%.3g %% of the light on matt surfaces comes by mirrors and glass";
    const scene_quality *q = &in->scene->quality;
    char caustics[96] = "", why_live[160] = "";
    baked_foreseen f = {0};
    double part = 0;
    p->indirect = q->indirect;
    if (q->indirect != INDIRECT_AUTO || all_paths(in, p) == 0) {
        p->indirect = q->indirect == INDIRECT_AUTO ? INDIRECT_PHOTONS : q->indirect;
        return VIT_OK;
    }
    vit_status status = caustic_part(in, p, &part, why);
    if (status == VIT_OK)
        status = foresee(in, p, &f, why);
    if (status != VIT_OK)
        return status;
    (void)snprintf(caustics, sizeof caustics, by_mirrors, 100 * part);
    if (f.widest > MAKER_WIDEST)
        (void)snprintf(why_live, sizeof why_live,
                       "a light goes %.2g of the scene's size between two places of the basis; it may be %g", f.widest,
                       MAKER_WIDEST);
    else if (f.bytes > q->basis_bytes)
        (void)snprintf(why_live, sizeof why_live,
                       "irradiance in %u state%s of the lights may take %.3g bytes; basis_bytes = %.3g", f.states,
                       f.states == 1 ? "" : "s", f.bytes, q->basis_bytes);
    if (part > MAKER_CAUSTICS)
        take(p, INDIRECT_PHOTONS, "%s, which the basis has not; it may be %g %%", caustics, 100 * MAKER_CAUSTICS);
    else if (why_live[0])
        take_live(p, q, &f, why_live);
    else if (f.states == 1)
        take(p, INDIRECT_BASIS, "lights are still%s%s", part > 0 ? ", and only " : "", part > 0 ? caustics : "");
    else
        take(p, INDIRECT_BASIS, "lights have %u states%s%s", f.states, part > 0 ? ", and only " : "", part > 0 ? caustics : "");
    return VIT_OK;
}
