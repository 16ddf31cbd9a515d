/* Direct light of the compared frame. Settings that differ in indirect light alone share it, and few kernels need to be
 * compiled for it. */
#include "cost/sweep_parts.h"
#include "common/fail.h"
#include <stdlib.h>
#include <string.h>

/* META's part of direct light. */
typedef struct direct_settings {
    vit_u64 effects;
    vit_u32 width, height, area_samples, sky_samples, sky_size, chain, copies;
    float contrast, background[3], ambient[3], offset[VIT_MAX_COPIES][2];
    vit_u32 gloss_rays;
} direct_settings;

static uint64_t settings_key(const vit_scene *s) {
    direct_settings d;
    memset(&d, 0, sizeof d);
    d.effects = s->effects & ~vit_effects_upon(VIT_BIT(INDIRECT));
    d.width = s->width;
    d.height = s->height;
    d.area_samples = s->area_samples;
    d.sky_samples = s->sky_samples;
    d.sky_size = s->sky_size;
    d.chain = s->chain;
    d.gloss_rays = s->gloss_rays;
    d.copies = s->copies;
    d.contrast = s->contrast;
    memcpy(d.background, s->background, sizeof d.background);
    memcpy(d.ambient, s->ambient, sizeof d.ambient);
    memcpy(d.offset, s->offset, sizeof d.offset);
    return vit_hash(&d, sizeof d);
}

/* Of all that direct light is made from. Lights differ in their photon paths alone. */
static uint64_t key_of(const sweep_pack *pack) {
    static const int seen[] = {VIT_SECTION_CAMS, VIT_SECTION_GEOM, VIT_SECTION_ATTR, VIT_SECTION_MATL,
                               VIT_SECTION_TEXR, VIT_SECTION_MIPS, VIT_SECTION_ATLS, VIT_SECTION_EMIT,
                               VIT_SECTION_SKYT, VIT_SECTION_CACH, VIT_SECTION_MAPS};
    const vit_pack_entry *table = (const void *)((const char *)pack->bytes + sizeof(vit_pack_header));
    const vit_scene *meta = (const void *)((const char *)pack->bytes + table[VIT_SECTION_META].offset);
    uint64_t parts[sizeof seen / sizeof seen[0] + 1] = {settings_key(meta)};
    for (size_t i = 0; i < sizeof seen / sizeof seen[0]; i++)
        parts[i + 1] = table[seen[i]].hash;
    return vit_hash(parts, sizeof parts);
}

vit_status sweep_direct(sweep *s, uint32_t i, const float **image, vit_text *why) {
    const uint64_t key = key_of(&s->packs[i]);
    for (uint32_t k = 0; k < s->direct_count; k++)
        if (s->directs[k].key == key) {
            *image = s->directs[k].image;
            return VIT_OK;
        }
    sweep_direct_image *d = &s->directs[s->direct_count];
    *d = (sweep_direct_image){.key = key, .image = calloc(3 * s->points, sizeof *d->image)};
    if (!d->image) {
        return bake_fail(why, VIT_FAILED, "out of memory");
    }
    s->direct_count++; /* freed with the others from now on */
    *image = d->image;
    const vit_open_info info = {.pack = s->packs[i].bytes,
                                .pack_size = s->packs[i].size,
                                .device = s->in->pipeline->device,
                                .threads = s->in->pipeline->threads,
                                .view = VIT_VIEW_direct};
    return images_render(&info, sweep_place(s), &s->grid, d->image, NULL, why);
}

void sweep_compare_direct(sweep *s) {
    const reference *r = &s->out->reference;
    const float *image = s->directs[0].image; /* the default's: it comes first */
    double largest = 0, sum = 0;
    s->out->direct = metrics_compare(r->direct, image, NULL, r->width, r->height);
    for (size_t i = 0; i < 3 * s->points; i++) {
        const double d = (double)image[i] - r->direct[i];
        largest = d > largest ? d : -d > largest ? -d : largest;
        sum += r->direct[i];
    }
    s->out->direct_largest = sum > 0 ? largest * 3 * (double)s->points / sum : 0;
}
