/* A baked pack with another quality block, in memory: what vitrine-bake would write, but for golden hashes and bounds. Saves
 * baking each scene a dozen times; radius and estimate are constants of META that nothing else in a pack follows from. */
#ifndef VIT_BENCH_VARIANT_H
#define VIT_BENCH_VARIANT_H

#include "measure.h"
#include "pack_read.h"
#include "pack/pack_write.h"
#include "vit.h"

#define PAGE 4096u

/* A pack in memory, on a page as a mapped file is: records then do not straddle cache lines. */
typedef struct pack_image {
    void *bytes;
    size_t size;
} pack_image;

static inline void *page_copy(const void *from, size_t size) {
    void *p = aligned_alloc(PAGE, (size / PAGE + 1) * PAGE);
    if (!p)
        bench_fail("out of memory");
    return memcpy(p, from, size);
}

static inline pack_image image_load(const char *path) {
    struct stat s;
    FILE *f = fopen(path, "rb");
    if (!f || fstat(fileno(f), &s) != 0 || s.st_size <= 0)
        bench_fail("%s: %s", path, strerror(errno));
    pack_image p = {aligned_alloc(PAGE, ((size_t)s.st_size / PAGE + 1) * PAGE), (size_t)s.st_size};
    if (!p.bytes || fread(p.bytes, 1, p.size, f) != p.size)
        bench_fail("%s: cannot be read", path);
    fclose(f);
    return p;
}

static inline void image_free(pack_image *p) {
    free(p->bytes);
    *p = (pack_image){0};
}

typedef struct variant {
    uint32_t estimate; /* VIT_BIT(LIST), or _BUCKETS, with _RAW_BUCKETS or without; 0: no photons at all */
    double radius;     /* metres; 0: the pack's own */
    bool solid;        /* cut-outs filled: every triangle stops every ray, as in Embree without filters */
} variant;

/* The pack's records that a variant changes, its own to change. */
typedef struct variant_records {
    vit_scene scene;
    vit_light *lights;
    vit_material *materials;
} variant_records;

static inline void variant_apply(const variant *v, variant_records *r) {
    vit_scene *s = &r->scene;
    s->effects &= ~(v->estimate ? vit_effects_upon(VIT_BIT(LIST)) | vit_effects_upon(VIT_BIT(BUCKETS))
                                : vit_effects_upon(VIT_BIT(INDIRECT)));
    s->effects |= v->estimate;
    if (v->estimate && v->radius > 0)
        s->radius = (float)v->radius;
    if (!v->estimate) {
        s->paths = s->baked = s->cells = 0;
        for (size_t i = 0; i < (size_t)s->frames * s->lights; i++)
            r->lights[i].path_first = r->lights[i].path_count = 0;
    }
    if (v->solid) {
        s->effects &= ~VIT_BIT(CUTOUT);
        for (uint32_t i = 0; i < s->materials; i++)
            r->materials[i].cutout = 0;
    }
}

static inline pack_image image_variant(const pack_image *from, const variant *v) {
    vit_text why;
    vit_pack p;
    pack_sections sections;
    pack_image out = {0};
    if (vit_pack_read(from->bytes, from->size, &p, &why) != VIT_OK)
        bench_fail("%s", why.text);
    variant_records r = {*p.scene, page_copy(p.section[VIT_SECTION_LITE], p.bytes[VIT_SECTION_LITE]),
                         page_copy(p.section[VIT_SECTION_MATL], p.bytes[VIT_SECTION_MATL])};
    variant_apply(v, &r);
    memcpy(sections.data, p.section, sizeof sections.data);
    sections.data[VIT_SECTION_META] = &r.scene;
    sections.data[VIT_SECTION_LITE] = r.lights;
    sections.data[VIT_SECTION_MATL] = r.materials;
    if (vit_pack_derive(&r.scene, &why) != VIT_OK || pack_assemble(&sections, &out.bytes, &out.size, &why) != VIT_OK)
        bench_fail("%s", why.text);
    void *plain = out.bytes;
    out.bytes = page_copy(plain, out.size);
    free(plain);
    free(r.lights);
    free(r.materials);
    return out;
}

/* An open pack and its framebuffer. */
typedef struct player {
    vit *v;
    void *arena;
    uint8_t *pixels;
    vit_requirements need;
} player;

/* max_list: 0 for the pack's bound. Passes are timed. */
static inline player player_open(const pack_image *p, uint32_t max_list, unsigned device) {
    vit_text why;
    player out = {0};
    vit_open_info info = {.pack = p->bytes, .pack_size = p->size, .profile = 1, .max_list = max_list, .device = device};
    if (vit_require(&info, &out.need, &why) != VIT_OK)
        bench_fail("%s", why.text);
    out.arena = info.arena = aligned_alloc(64, out.need.host_bytes);
    info.arena_size = out.need.host_bytes;
    out.pixels = aligned_alloc(PAGE, (out.need.frame_bytes / PAGE + 1) * PAGE);
    if (!out.arena || !out.pixels)
        bench_fail("out of memory");
    if (vit_open(&info, &out.v, &why) != VIT_OK)
        bench_fail("%s", why.text);
    return out;
}

/* Milliseconds, seen from the host. */
static inline double player_frame(player *p, uint32_t index) {
    vit_text why;
    const double began = bench_seconds();
    if (vit_frame(p->v, index, p->pixels, p->need.frame_bytes / p->need.height, &why) != VIT_OK)
        bench_fail("%s", why.text);
    return (bench_seconds() - began) * 1e3;
}

static inline vit_statistics player_stats(player *p) {
    vit_text why;
    vit_statistics s;
    if (vit_stats(p->v, &s, &why) != VIT_OK)
        bench_fail("%s", why.text);
    return s;
}

/* A copy of a buffer of the frame just rendered; the caller frees it. */
static inline void *player_buffer(player *p, uint32_t buffer) {
    const size_t bytes = (size_t)vit_buffer_bytes(buffer, p->v->pack.scene, &p->v->launch);
    void *out = bench_array(bytes, 1);
    vit_text why;
    if (p->v->device->read(p->v->state, (vit_buffer)buffer, bytes, out, &why) != VIT_OK)
        bench_fail("%s", why.text);
    return out;
}

static inline double player_pass_ms(const player *p, const char *name) {
    for (uint32_t i = 0; i < vit_pass_count; i++)
        if (strcmp(vit_passes[i].name, name) == 0)
            return p->v->pass_ms[i];
    bench_fail("there is no pass %s", name);
}

static inline void player_close(player *p) {
    vit_close(p->v);
    free(p->arena);
    free(p->pixels);
    *p = (player){0};
}

#endif
