/* Frames whose work is counted, and what their passes left on the device. */
#ifndef VIT_TESTS_COUNTED_WORK_H
#define VIT_TESTS_COUNTED_WORK_H

#include "read_buffer.h"

static inline uint64_t work(const vit_statistics *s, const char *pass, uint32_t kind) {
    for (uint32_t i = 0; i < s->pass_count; i++)
        if (strcmp(s->pass_names[i], pass) == 0)
            return s->pass_work[i][kind];
    return 0;
}
#define WORK(s, pass, kind) work(s, #pass, VIT_WORK_##kind)

static inline uint64_t total(const vit_statistics *s, uint32_t kind) {
    uint64_t sum = 0;
    for (uint32_t i = 0; i < s->pass_count; i++)
        sum += s->pass_work[i][kind];
    return sum;
}

/* Every pass and kind; those that depend on the lanes only if asked. */
static inline void assert_equal_work(const vit_statistics *a, const vit_statistics *b, int all, const char *what) {
    assert_int_equal(a->pass_count, b->pass_count);
    assert_int_equal(a->work_count, VIT_WORK_COUNT);
    assert_int_equal(b->work_count, VIT_WORK_COUNT);
    for (uint32_t p = 0; p < a->pass_count; p++)
        for (uint32_t k = 0; k < a->work_count; k++)
            if ((all || a->work_same[k]) && a->pass_work[p][k] != b->pass_work[p][k])
                fail_msg("%s: %s of %s: %llu and %llu", what, a->work_names[k], a->pass_names[p],
                         (unsigned long long)a->pass_work[p][k], (unsigned long long)b->pass_work[p][k]);
}

/* Counts of frame 1, or of the only one, and its hash. */
static inline vit_statistics count(const char *pack, uint32_t device, uint32_t lanes, uint32_t group, uint64_t *hash) {
    open_pack p;
    pack_open(&p, pack, (vit_open_info){.device = device, .lanes = lanes, .group = group, .count_work = 1});
    (void)pack_frame_hash(&p, 0);
    *hash = pack_frame_hash(&p, p.need.frames > 1 ? 1 : 0);
    vit_statistics s = pack_stats(&p);
    pack_close(&p);
    return s;
}

/* The device host at every width, and of the first pack the first OpenCL device, too. */
static inline void assert_same_counts_for_any_lanes(const char *const *packs, size_t pack_count) {
    static const uint32_t ways[][2] = {{VIT_DEVICE_HOST, 1}, {VIT_DEVICE_HOST, 8}, {VIT_DEVICE_HOST, 16}, {0, 8}};
    static vit_statistics s[2]; /* large for a stack */
    for (size_t i = 0; i < pack_count; i++)
        for (size_t w = 0; w < (i < 1 ? 4 : 3); w++) {
            uint64_t hash;
            s[w > 0] = count(packs[i], ways[w][0], ways[w][1], 0, &hash);
            assert_equal_work(&s[0], &s[w > 0], 0, packs[i]);
        }
}

/* A frame that was counted, and what its passes left on the device. */
typedef struct counted {
    open_pack p;
    vit_statistics s;
    const vit_scene *scene;
    uint32_t *hits, *keys, *masks, *prefix, *first, *children, *list;
} counted;

static inline counted *count_frame(const char *pack, vit_open_info how) {
    counted *c = calloc(1, sizeof *c);
    assert_non_null(c);
    how.count_work = 1;
    pack_open(&c->p, pack, how);
    pack_frame(&c->p, 1);
    c->s = pack_stats(&c->p);
    c->scene = c->p.v->pack.scene;
    c->hits = read_buffer(&c->p, B_hit_triangle);
    if (c->scene->effects & VIT_BIT(PHOTONS)) {
        c->keys = read_buffer(&c->p, B_keys);
        c->masks = read_buffer(&c->p, B_masks);
        c->prefix = read_buffer(&c->p, B_prefix);
        c->first = read_buffer(&c->p, B_node_first);
        c->children = read_buffer(&c->p, B_node_count);
        c->list = read_buffer(&c->p, B_list_count);
    }
    return c;
}

static inline void drop(counted *c) {
    void *const all[] = {c->hits, c->keys, c->masks, c->prefix, c->first, c->children, c->list};
    for (size_t i = 0; i < sizeof all / sizeof all[0]; i++)
        free(all[i]);
    pack_close(&c->p);
    free(c);
}

#endif
