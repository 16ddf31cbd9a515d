/* Stages that play the path: its frames, what none of them exceeds, effects that rays met; and the pack's bytes. */
#include "pack/stages.h"
#include <stdlib.h>

static void measuring(void *user, const char *stage, double fraction) {
    progress *p = user;
    if (p->stage != stage)
        progress_stage(p, stage);
    progress_step(p, fraction);
}

void stages_point(bake *b) {
    const pipeline *p = b->p;
    pipeline_packed *out = b->out;
    out->sections = (pack_sections){
        .data = {[VIT_SECTION_META] = &out->plan.scene,
                 [VIT_SECTION_CAMS] = out->tracks.cameras,
                 [VIT_SECTION_LITE] = out->tracks.lights,
                 [VIT_SECTION_GEOM] = out->geometry->triangles,
                 [VIT_SECTION_ATTR] = out->geometry->attributes,
                 [VIT_SECTION_BVHN] = out->bvh->nodes,
                 [VIT_SECTION_MATL] = out->plan.materials,
                 [VIT_SECTION_MAPS] = out->plan.maps,
                 [VIT_SECTION_TEXR] = p->atlas.textures,
                 [VIT_SECTION_MIPS] = p->atlas.mips,
                 [VIT_SECTION_ATLS] = p->atlas.texels,
                 [VIT_SECTION_SIDE] = out->baked.receivers.sides ? out->baked.receivers.sides : out->cells.sides,
                 [VIT_SECTION_RCEL] = out->baked.points.table.records ? (const void *)out->baked.points.table.records
                                                                      : out->baked.receivers.cells,
                 [VIT_SECTION_RSPL] = out->baked.receivers.splits,
                 [VIT_SECTION_RECV] = out->baked.still,
                 [VIT_SECTION_BGRP] = out->baked.basis.groups,
                 [VIT_SECTION_BWRD] = out->baked.basis.words,
                 [VIT_SECTION_BCOE] = out->baked.basis.coefficients,
                 [VIT_SECTION_BFRM] = out->baked.frames,
                 [VIT_SECTION_PATC] = out->live.patches,
                 [VIT_SECTION_PPNT] = out->live.points,
                 [VIT_SECTION_GROW] = out->live.rows,
                 [VIT_SECTION_GATH] = out->live.words,
                 [VIT_SECTION_LOOK] = out->live.looked,
                 [VIT_SECTION_CACH] = out->occlusion.table.records,
                 [VIT_SECTION_XFER] = out->live.transfer.words,
                 [VIT_SECTION_MSID] = out->lightmap.receivers.sides,
                 [VIT_SECTION_MCEL] = out->lightmap.receivers.cells,
                 [VIT_SECTION_MSPL] = out->lightmap.receivers.splits,
                 [VIT_SECTION_MREC] = out->lightmap.light,
                 [VIT_SECTION_CELL] = out->cells.cells,
                 [VIT_SECTION_EMIT] = out->area_lights,
                 [VIT_SECTION_SKYT] = p->sky.texels,
                 [VIT_SECTION_PHOT] = out->photons,
                 [VIT_SECTION_GOLD] = out->gold}};
    b->bounds = (bounds_input){.sections = &out->sections,
                               .scene = &out->plan.scene,
                               .gold = out->gold,
                               .device = p->device,
                               .threads = p->threads,
                               .all_formats = p->all_formats,
                               .progress = measuring,
                               .user = p->progress};
}

/* Keeps the chosen frames' cameras and lights. */
vit_status stage_frames(bake *b, vit_text *why) {
    const pipeline_choice *c = b->choice;
    tracks *t = &b->out->tracks;
    (void)why;
    if (!c->frames)
        return VIT_OK;
    for (uint32_t i = 0; i < c->frame_count; i++) { /* ascending: a frame moves towards the front */
        t->cameras[i] = t->cameras[c->frames[i]];
        for (uint32_t k = 0; k < t->light_count; k++)
            t->lights[(size_t)i * t->light_count + k] = t->lights[(size_t)c->frames[i] * t->light_count + k];
        for (uint32_t k = 0; k < b->out->baked.lights; k++)
            b->out->baked.frames[(size_t)i * b->out->baked.lights + k] =
                b->out->baked.frames[(size_t)c->frames[i] * b->out->baked.lights + k];
    }
    b->out->plan.scene.frames = c->frame_count;
    return VIT_OK;
}

/* Live radiosity: receivers that no view sample looks up are not kept. */
static vit_status keep_looked_up(bake *b, vit_text *why) {
    pipeline_packed *out = b->out;
    vit_scene *s = &out->plan.scene;
    const vit_status status = live_keep(&out->live, &out->baked, b->bounds.looked_up, s->frames, why);
    s->receivers = out->baked.receivers.count;
    s->gather_words = out->live.word_count;
    s->looked_frames = out->live.looked_frames;
    stages_point(b);
    return status;
}

/* Plays the path: bounds and golden hashes; what rays met settles the effects, and what samples looked up is kept. */
vit_status stage_bounds(bake *b, vit_text *why) {
    pipeline_packed *out = b->out;
    vit_scene *s = &out->plan.scene;
    const bool is_live = s->effects & VIT_BIT(RADIOSITY);
    const size_t bits = is_live ? (size_t)s->frames * (s->receivers / 32) : 0;
    effects_reached *reached = calloc(EFFECTS_RECORDS(s->materials), sizeof *reached);
    uint32_t *looked_up = malloc((bits + 1) * sizeof *looked_up);
    if (!reached || !looked_up || (is_live && live_look_at_all(&out->live, s->receivers, s->frames, why) != VIT_OK)) {
        free(reached);
        free(looked_up);
        return out_of_memory(why);
    }
    s->looked_frames = out->live.looked_frames;
    stages_point(b);
    b->bounds.looked_up = is_live ? looked_up : NULL;
    if ((s->effects | out->plan.effects.forced_off) & (EFFECTS_SETTLED | VIT_BIT(AREA_LIGHTS)))
        b->bounds.reached = reached; /* else there is nothing to find out */
    vit_status status = bounds_measure(&b->bounds, why);
    for (uint32_t i = 0; i < s->materials && status == VIT_OK; i++)
        reached[i].how |= out->met && out->met[i] ? EFFECTS_REACHED_BAKED : 0;
    if (status == VIT_OK)
        effects_settle(s, out->model, &(effects_looks){out->plan.materials, out->plan.maps}, reached, &out->plan.effects);
    if (status == VIT_OK && is_live)
        status = keep_looked_up(b, why);
    free(reached);
    free(looked_up);
    return status;
}

vit_status stage_assemble(bake *b, vit_text *why) {
    return pack_assemble(&b->out->sections, &b->out->bytes, &b->out->size, why);
}
