/* A pack opened through vitrine.h with the memory that it asks for. */
#ifndef VIT_TESTS_OPEN_PACK_H
#define VIT_TESTS_OPEN_PACK_H

#include "test_packs.h"
#include "vitrine.h"

typedef struct open_pack {
    void *bytes, *arena;
    uint8_t *frame;
    size_t stride; /* bytes a row of `frame` */
    vit_open_info info;
    vit_requirements need;
    vit *v;
    vit_text why;
} open_pack;

#define assert_vit_ok(p, call)                                                                                                 \
    do {                                                                                                                       \
        if ((call) != VIT_OK)                                                                                                  \
            fail_msg("%s: %s", #call, (p)->why.text);                                                                          \
    } while (0)

/* `bytes` are malloc'ed and become the open pack's; `how` is all of vit_open_info but pack and arena. */
static inline void pack_open_bytes(open_pack *p, void *bytes, size_t size, vit_open_info how) {
    memset(p, 0, sizeof *p);
    p->info = how;
    p->info.pack = p->bytes = bytes;
    p->info.pack_size = size;
    assert_vit_ok(p, vit_require(&p->info, &p->need, &p->why));
    p->info.arena = p->arena = aligned_alloc(64, (p->need.host_bytes + 63) / 64 * 64);
    p->info.arena_size = p->need.host_bytes;
    p->frame = malloc(p->need.frame_bytes);
    assert_non_null(p->arena);
    assert_non_null(p->frame);
    p->stride = p->need.frame_bytes / p->need.height;
    assert_vit_ok(p, vit_open(&p->info, &p->v, &p->why));
}

static inline void pack_open(open_pack *p, const char *name, vit_open_info how) {
    size_t size;
    void *bytes = read_file(test_pack(name), &size);
    pack_open_bytes(p, bytes, size, how);
}

static inline void pack_close(open_pack *p) {
    vit_close(p->v);
    free(p->frame);
    free(p->arena);
    free(p->bytes);
}

static inline void pack_frame(open_pack *p, uint32_t index) {
    assert_vit_ok(p, vit_frame(p->v, index, p->frame, p->stride, &p->why));
}

static inline uint64_t pack_frame_hash(open_pack *p, uint32_t index) {
    pack_frame(p, index);
    return vit_hash(p->frame, p->need.frame_bytes);
}

static inline vit_statistics pack_stats(open_pack *p) {
    vit_statistics s;
    assert_vit_ok(p, vit_stats(p->v, &s, &p->why));
    return s;
}

/* Bytes of a buffer of the pack; 0: it has none of that name. */
static inline uint64_t pack_buffer_bytes(const open_pack *p, const char *name) {
    for (uint32_t i = 0; i < p->need.buffer_count; i++)
        if (strcmp(p->need.buffers[i].name, name) == 0)
            return p->need.buffers[i].bytes;
    return 0;
}

#endif
