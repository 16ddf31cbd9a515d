/* What the check found, in words: what is wrong, and which setting mends it. */
#include "check/check.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

#define NEARLY_ALL 0.95 /* of the pixels */
#define MUCH 0.25       /* too much of indirect light */
#define MIDDLE 0.2      /* radiance times exposure that a suggested exposure gives the median pixel */

void check_text(const check_found *f, char *text, size_t room) {
    (void)snprintf(text, room, "flux %.2f %.2f %.2f, dark half %.2f", f->flux[0].value, f->flux[1].value, f->flux[2].value,
                   f->dark.value);
}

void check_cure(const check_found *f, const scene_quality *q, const plan *p, char *text, size_t room) {
    const uint64_t e = p->scene.effects;
    const bool indirect = (e & VIT_BIT(INDIRECT)) != 0, photons = (e & VIT_BIT(PHOTONS)) != 0;
    text[0] = '\0';
    const bool leaks = indirect && f->indirect - 1 > fmax(MUCH, fabs(f->direct - 1)); /* no direct light is to blame for */
    if (!leaks && fabs(f->direct - 1) > CHECK_LIMIT / 2 && (e & (VIT_BIT(AREA_LIGHTS) | VIT_BIT(SKY_LIGHT))))
        (void)snprintf(text, room,
                       e & VIT_BIT(LIGHTMAP) ? "lower lightmap_error, or raise %s with lightmap = \"rays\"" : "raise %s",
                       !(e & VIT_BIT(SKY_LIGHT))     ? "light_samples"
                       : !(e & VIT_BIT(AREA_LIGHTS)) ? "sky_samples"
                                                     : "light_samples and sky_samples");
    else if (!indirect)
        (void)snprintf(text, room, q->photons > 0 && q->bounces > 1 ? "" : "photons and bounces beyond 1 give indirect light");
    else if (f->limited < 1 - CHECK_LIMIT / 2 && f->indirect < 1)
        (void)snprintf(text, room, "bounces = %d leaves %.0f %% of the light out: raise it", q->bounces,
                       100 * (1 - f->limited));
    else if (!photons)
        (void)snprintf(text, room,
                       "indirect = \"photons\", or a smaller receiver_spacing than %g with more receiver_rays than %d",
                       q->receiver_spacing, q->receiver_rays);
    else if (!q->zones || !q->effective_area)
        (void)snprintf(text, room, "%s%s%s%s", !q->zones ? "zones = true" : "", !q->zones && !q->effective_area ? " and " : "",
                       !q->effective_area ? "effective_area = true" : "", " of the quality block keep light where it belongs");
    else
        (void)snprintf(text, room, "a smaller radius than %.3g m with more photons than %d", (double)p->scene.radius,
                       q->photons);
}

static const char *why_black(const pipeline *p, const pipeline_packed *packed, const check_found *f) {
    const vit_scene *s = &packed->plan.scene;
    bool lights = packed->plan.area.count > 0 || s->sky_samples > 0 || s->ambient[0] + s->ambient[1] + s->ambient[2] > 0.0f;
    for (size_t i = 0; i < (size_t)s->frames * s->lights; i++) {
        const vit_light *l = packed->tracks.lights + i;
        lights = lights || l->intensity[0] + l->intensity[1] + l->intensity[2] > 0.0f;
    }
    bool emits = false; /* a material of the scene, as the meshes or the scene file have it */
    for (uint32_t i = 0; i < s->materials; i++) {
        const vit_material *m = packed->plan.materials + i;
        emits = emits || m->emission[0] + m->emission[1] + m->emission[2] > 0.0f;
    }
    (void)p;
    if (f->unhit >= NEARLY_ALL)
        return "the camera sees no surface that could be lit";
    if (!lights && emits)
        return "what emits gives no light: it lies behind other faces in the same place, or area_light is false";
    if (!lights)
        return "the scene has no lights: none of its own, no area light, no sky that lights, no ambient";
    if (f->unlit >= NEARLY_ALL)
        return "no light reaches what the camera sees";
    return NULL;
}

void check_exposure(const pipeline *p, const pipeline_packed *packed, const check *c, const check_found *f) {
    const double now = (double)packed->tracks.cameras[0].exposure;
    const char *reason = f->black >= NEARLY_ALL ? why_black(p, packed, f) : NULL;
    (void)c;
    if (reason)
        progress_line(p->progress, true, "warning: %.0f %% of the picture is black: %s", 100 * f->black, reason);
    else if (f->black >= NEARLY_ALL && f->median > 0)
        progress_line(p->progress, true,
                      "warning: %.0f %% of the picture is black, underexposed: its median is %.2g of white; exposure = %.2g "
                      "would show it",
                      100 * f->black, f->median, now * MIDDLE / f->median);
    else if (f->black >= NEARLY_ALL)
        progress_line(p->progress, true, "warning: %.0f %% of the picture is black", 100 * f->black);
    else if (f->white >= NEARLY_ALL)
        progress_line(p->progress, true,
                      "warning: %.0f %% of the picture's surfaces are white, overexposed: its median is %.3g times white; "
                      "exposure = %.2g "
                      "would show it",
                      100 * f->white, f->median, now * MIDDLE / f->median);
}

vit_status check_pack(const pipeline *p, const pipeline_packed *packed, vit_text *why) {
    const vit_scene *s = &packed->plan.scene;
    static const char off[] = "warning: the picture differs from path tracing";
    check c;
    check_found f;
    char figures[128], cure[256];
    check_choose(s->frames, s->width, s->height, &c);
    vit_status status = check_trace(p, packed, &c, why);
    if (status == VIT_OK)
        status = check_compare(p, packed, &c, true, &f, why);
    if (status != VIT_OK)
        return status;
    check_exposure(p, packed, &c, &f);
    check_text(&f, figures, sizeof figures);
    check_cure(&f, &p->scene.quality, &packed->plan, cure, sizeof cure);
    if (f.worst > CHECK_LIMIT)
        progress_line(p->progress, true, "%s at %u pixels of %u frames: %s of right%s%s", off, c.count, c.frame_count, figures,
                      cure[0] ? "; " : "", cure);
    else
        progress_line(p->progress, false, "checked against path tracing at %u pixels of %u frames: %s", c.count, c.frame_count,
                      figures);
    return VIT_OK;
}
