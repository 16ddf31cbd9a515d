/* Packs, pictures and exact work of the settings. */
#include "cost/fit.h"
#include "common/fail.h"
#include "cost/sweep_parts.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static vit_status fail(vit_status status, vit_text *why, const char *name, const char *cause) {
    char text[sizeof why->text];
    (void)snprintf(text, sizeof text, "%s", cause);
    return bake_fail(why, status, "setting '%.*s': %.*s", COST_NAME, name, (int)sizeof text - 130, text);
}

static int scaled(int edge, double scale) {
    const int pixels = (int)(edge * scale + 0.5);
    return pixels > 0 ? pixels : 1;
}

vit_status sweep_take_pack(sweep *s, uint32_t i, vit_text *why) {
    pipeline *p = s->in->pipeline;
    const knob_setting *k = &s->knobs.settings[i];
    sweep_pack *pack = &s->packs[i];
    if (pack->bytes)
        return VIT_OK;
    progress quiet = progress_make(true), *loud = p->progress;
    const pipeline_choice choice = {.quality = k->quality,
                                    .width = scaled(p->scene.width, k->scale),
                                    .height = scaled(p->scene.height, k->scale),
                                    .frames = s->brief ? &s->frames[s->at] : s->frames,
                                    .frame_count = s->brief ? 1 : s->frame_count};
    pipeline_packed packed;
    p->progress = &quiet;
    vit_status status = pipeline_pack(p, &choice, &packed, why);
    p->progress = loud;
    if (status != VIT_OK)
        return fail(status, why, k->name, why->text);
    *pack = (sweep_pack){.bytes = packed.bytes, .size = packed.size};
    s->out->settings[i].bake_seconds = packed.seconds;
    s->kept += packed.size;
    packed.bytes = NULL;
    pipeline_packed_free(&packed);
    return VIT_OK;
}

void sweep_drop_pack(sweep *s, uint32_t i) {
    s->kept -= s->packs[i].bytes ? s->packs[i].size : 0;
    free(s->packs[i].bytes);
    s->packs[i].bytes = NULL;
}

uint32_t sweep_place(const sweep *s) {
    return s->brief ? 0 : s->at;
}

static vit_open_info how(const sweep *s, uint32_t i) {
    return (vit_open_info){.pack = s->packs[i].bytes,
                           .pack_size = s->packs[i].size,
                           .device = s->in->pipeline->device,
                           .threads = s->in->pipeline->threads,
                           .lanes = s->knobs.settings[i].lanes};
}

static void note_work(cost_results *r, cost_setting *c, const vit_statistics *t) {
    r->work_count = t->work_count;
    for (uint32_t k = 0; k < t->work_count; k++)
        (void)snprintf(r->work_names[k], sizeof r->work_names[k], "%s", t->work_names[k]);
    c->pass_count = t->pass_count;
    for (uint32_t p = 0; p < t->pass_count; p++)
        (void)snprintf(c->pass_names[p], sizeof c->pass_names[p], "%s", t->pass_names[p]);
    memcpy(c->pass_work, t->pass_work, sizeof c->pass_work);
    c->work = fit_work_units(t->pass_work, t->pass_count, t->work_names, t->work_count);
}

/* What must have the default's bits has them. */
static vit_status check_same(const sweep *s, uint32_t i, vit_text *why) {
    const size_t bytes = 3 * s->points * sizeof(float);
    if (s->knobs.settings[i].lanes == 0 || memcmp(s->out->settings[i].image, s->out->settings[0].image, bytes) == 0)
        return VIT_OK;
    return fail(VIT_MISMATCH, why, s->knobs.settings[i].name, "its frame has other bits than the default's");
}

static vit_status picture(sweep *s, uint32_t i, vit_text *why) {
    cost_setting *c = &s->out->settings[i];
    vit_requirements need;
    vit_statistics stats;
    const float *direct;
    vit_status status = sweep_take_pack(s, i, why);
    if (status != VIT_OK)
        return status;
    vit_open_info info = how(s, i);
    c->pack_bytes = s->packs[i].size;
    status = vit_require(&info, &need, why);
    c->device_bytes = status == VIT_OK ? need.device_bytes : 0;
    c->image = calloc(3 * s->points, sizeof *c->image);
    s->indirect[i] = calloc(3 * s->points, sizeof *c->image);
    if (!c->image || !s->indirect[i])
        return fail(VIT_FAILED, why, c->name, "out of memory");
    info.count_work = 1;
    if (status == VIT_OK)
        status = images_render(&info, sweep_place(s), &s->grid, c->image, &stats, why);
    if (status == VIT_OK)
        note_work(s->out, c, &stats);
    if (status == VIT_OK)
        status = sweep_direct(s, i, &direct, why);
    if (status != VIT_OK)
        return fail(status, why, c->name, why->text);
    for (size_t k = 0; k < 3 * s->points; k++)
        s->indirect[i][k] = c->image[k] - direct[k];
    return check_same(s, i, why);
}

vit_status sweep_pictures(sweep *s, uint32_t first, vit_text *why) {
    vit_status status = VIT_OK;
    for (uint32_t i = first; i < s->out->count && status == VIT_OK; i++) {
        status = sweep_cancelled(s, why) ? VIT_FAILED : picture(s, i, why);
        if (s->brief || s->kept > s->in->memory)
            sweep_drop_pack(s, i);
        progress_step(s->progress, (i + 1.0) / s->knobs.most);
    }
    return status;
}
