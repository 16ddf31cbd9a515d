#include "cost/effect_cost.h"
#include "common/fail.h"
#include "pack/effects.h"
#include "cost/fit.h"
#include "pack/opened.h"
#include <stdlib.h>
#include <string.h>

#define SOURCES (VIT_BIT(LIGHTS) | VIT_BIT(AREA_LIGHTS) | VIT_BIT(SKY_LIGHT))

/* The lights of all frames, with their photon paths or without. NULL: out of memory. */
static vit_light *lights_with_paths(const pack_sections *whole, const vit_scene *s, bool paths) {
    const size_t count = (size_t)s->frames * s->lights;
    vit_light *lights = malloc((count + 1) * sizeof *lights);
    if (!lights)
        return NULL;
    if (count > 0)
        memcpy(lights, whole->data[VIT_SECTION_LITE], count * sizeof *lights);
    for (size_t i = 0; i < count && !paths; i++)
        lights[i].path_first = lights[i].path_count = 0;
    return lights;
}

vit_status effect_cost_without(const pack_sections *whole, uint64_t effects, void **bytes, size_t *size, vit_text *why) {
    pack_sections sections = *whole;
    const vit_scene *all = whole->data[VIT_SECTION_META];
    vit_scene s = *all;
    effects_drop(&s, effects);
    if (!(s.effects & SOURCES))
        effects_drop(&s, VIT_BIT(INDIRECT));
    if (!(s.effects & VIT_BIT(LIGHTS)))
        s.lights = 0;
    if (!(s.effects & VIT_BIT(TRACED)))
        s.paths = 0;
    if (!(s.effects & VIT_BIT(PHOTONS)))
        s.baked = 0;
    if (!(s.effects & (VIT_BIT(ZONES) | VIT_BIT(AREA))))
        s.cells = 0;
    if (s.area_samples == 0 && all->area_samples > 0) /* the sky's come after them */
        sections.data[VIT_SECTION_EMIT] =
            (const vit_light_sample *)whole->data[VIT_SECTION_EMIT] + (size_t)VIT_PATTERNS * all->area_samples;
    if (!(s.effects & VIT_BIT(SKY_IMAGE)))
        s.sky_size = 0;
    sections.data[VIT_SECTION_META] = &s;
    vit_light *lights = lights_with_paths(whole, all, s.paths > 0);
    if (!lights) {
        return bake_fail(why, VIT_FAILED, "out of memory");
    }
    sections.data[VIT_SECTION_LITE] = lights;
    vit_status status = vit_pack_derive(&s, why);
    if (status == VIT_OK)
        status = pack_assemble(&sections, bytes, size, why);
    free(lights);
    return status;
}

/* Bytes and mean work of a pack. */
static vit_status measure(const void *pack, size_t size, unsigned threads, uint64_t *bytes, uint64_t *work, vit_text *why) {
    const vit_open_info how = {.pack = pack, .pack_size = size, .device = VIT_DEVICE_HOST, .threads = threads, .count_work = 1};
    opened o;
    vit_statistics counted;
    const vit_statistics *c = &counted;
    vit_status status = opened_begin(&how, &o, why);
    if (status != VIT_OK)
        return status;
    const uint32_t last = o.need.frames - 1;
    uint64_t sum = 0;
    *bytes = 0;
    for (uint32_t i = 0; i < o.need.buffer_count; i++)
        *bytes += strcmp(o.need.buffers[i].name, "work") == 0 ? 0 : o.need.buffers[i].bytes;
    for (uint32_t i = 0; i < EFFECT_COST_FRAMES && status == VIT_OK; i++) {
        status = opened_frame(&o, last * i / (EFFECT_COST_FRAMES - 1), why);
        if (status == VIT_OK)
            status = vit_stats(o.v, &counted, why);
        if (status == VIT_OK)
            sum += fit_work_units(c->pass_work, c->pass_count, c->work_names, c->work_count);
    }
    opened_end(&o);
    *work = sum / EFFECT_COST_FRAMES;
    return status;
}

static vit_status measure_without(const pipeline_packed *p, uint64_t effect, unsigned threads, const effect_costs *whole,
                                  effect_cost *out, vit_text *why) {
    void *pack = NULL;
    size_t size = 0;
    uint64_t bytes, work;
    vit_status status = effect_cost_without(&p->sections, effect, &pack, &size, why);
    if (status == VIT_OK)
        status = measure(pack, size, threads, &bytes, &work, why);
    free(pack);
    if (status == VIT_OK)
        *out = (effect_cost){true, (int64_t)(whole->device_bytes - bytes), (int64_t)(whole->work - work)};
    return status == VIT_BAD_INPUT ? VIT_OK : status; /* the loader does not take it: records call for the effect */
}

vit_status effect_cost_measure(const pipeline_packed *p, unsigned threads, progress *shown, effect_costs *out, vit_text *why) {
    memset(out, 0, sizeof *out);
    progress_stage(shown, "what each effect adds");
    const uint64_t called = p->plan.scene.effects & EFFECT_COST_MEASURED;
    vit_status status = measure(p->bytes, p->size, threads, &out->device_bytes, &out->work, why);
    for (int bit = 0; bit < 64 && status == VIT_OK; bit++) {
        progress_step(shown, bit / 64.0);
        if (called >> bit & 1)
            status = measure_without(p, (uint64_t)1 << bit, threads, out, &out->effect[bit], why);
    }
    return status;
}
