/* vit_stats, vit_reached: read counters back; not for the frame loop. */
#include "vit.h"
#include "fail.h"
#include "work.h"
#include <string.h>

vit_status vit_reached(vit *v, uint32_t *words, uint32_t count, vit_text *why) {
    vit_text unused = {""};
    why = why ? why : &unused;
    const uint64_t bytes = vit_buffer_bytes(B_reached, v->pack.scene, &v->launch);
    if (bytes == 0 || bytes != (uint64_t)count * sizeof *words)
        return vit_fail(why, VIT_USAGE, "vit_reached: %u words asked for, there are %llu", count,
                        (unsigned long long)bytes / 4);
    return v->device->read(v->state, B_reached, (size_t)bytes, words, why);
}

vit_status vit_stats(vit *v, vit_statistics *out, vit_text *why) {
    vit_text unused = {""};
    why = why ? why : &unused;
    uint32_t counters[3 * VIT_COUNTER_COUNT], work[VIT_WORK_WORDS];
    const uint32_t *total = counters + VIT_COUNTER_COUNT, *c = counters + 2 * VIT_COUNTER_COUNT;
    memset(out, 0, sizeof *out);
    vit_status status = v->device->read(v->state, B_counters, sizeof counters, counters, why);
    if (status == VIT_OK && (v->launch.effects & ON_WORK))
        status = v->device->read(v->state, B_work, sizeof work, work, why);
    if (status != VIT_OK)
        return status;
    if (v->launch.effects & ON_WORK)
        vit_work_read(work, v->pack.scene, &v->launch, c, out);
    const vit_photon *baked = v->pack.section[VIT_SECTION_PHOT];
    out->frames = v->frames;
    out->lanes = v->launch.lanes;
    out->indirect = vit_effect_first(v->launch.effects & vit_indirect_makers());
    out->nodes = c[VIT_COUNTER_nodes];
    out->clusters = c[VIT_COUNTER_clusters];
    out->photons = c[VIT_COUNTER_photons];
    for (uint32_t i = 0; i < v->pack.scene->baked; i++)
        out->photons += baked[i].radius2 > 0;
    out->list = c[VIT_COUNTER_list];
    out->pairs = c[VIT_COUNTER_pairs];
    out->largest = c[VIT_COUNTER_largest];
    out->slice_min = c[VIT_COUNTER_slice_min];
    out->slice_max = c[VIT_COUNTER_slice_max];
    out->max_nodes = total[VIT_COUNTER_nodes];
    out->max_list = total[VIT_COUNTER_list];
    out->dropped_samples = total[VIT_COUNTER_dropped_samples];
    out->dropped_entries = total[VIT_COUNTER_dropped_entries];
    for (uint32_t p = 0; p < vit_pass_count; p++) {
        if (!vit_pass_called(p, &v->launch))
            continue;
        out->pass_names[out->pass_count] = vit_passes[p].name;
        out->pass_ms[out->pass_count++] = v->pass_ms[p];
    }
    return VIT_OK;
}
