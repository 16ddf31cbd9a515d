/* The octree in the laboratory: octree.cl behind the library's kernels, over arrays of rays (ray_lab.h). */
#ifndef VIT_BASELINE_OCTREE_LAB_H
#define VIT_BASELINE_OCTREE_LAB_H

#include "baselines/octree.h"
#include "ray_lab.h"

/* Found by trial to be the fastest for the benches' scenes: tests/bench/LOG.md. */
#define OCTREE_USUAL ((octree_limits){.depth = 10, .leaf = 8})
#define OCTREE_BUFFERS 4u

/* The kernels' source, after `before`; the caller frees it. Programs run from the repository's root. */
static inline char *octree_source(const char *before) {
    FILE *f = fopen("tests/baselines/octree.cl", "rb");
    const size_t head = strlen(before), room = head + (1u << 16);
    char *text = ray_lab_array(room, 1);
    assert_non_null(f);
    memcpy(text, before, head);
    const size_t read = fread(text + head, 1, room - head, f);
    assert_in_range(read, 1, room - head - 1);
    assert_int_equal(fclose(f), 0);
    return text;
}

#define OCTREE_WITH_FMA " -DOCTREE_FUSED=1"

/* options: "" or OCTREE_WITH_FMA. */
static inline lab octree_lab_open(const char *options, const char *more_kernels) {
    char *source = octree_source(more_kernels);
    lab l = lab_open_with(1, 0, options, source);
    free(source);
    return l;
}

/* The kernels' first arguments; the caller releases them. */
static inline void octree_buffers(lab *l, const octree *o, cl_mem a[OCTREE_BUFFERS]) {
    static const uint32_t none = 0;
    const float box[8] = {o->lo[0], o->lo[1], o->lo[2], 0, o->hi[0], o->hi[1], o->hi[2], 0};
    a[0] = lab_buffer(l, box, sizeof box);
    a[1] = lab_buffer(l, o->nodes, o->node_count * sizeof *o->nodes);
    a[2] = o->index_count ? lab_buffer(l, o->index, o->index_count * sizeof *o->index) : lab_buffer(l, &none, sizeof none);
    a[3] = lab_buffer(l, o->triangles, o->triangle_count * sizeof *o->triangles);
}

static inline octree octree_of(const ray_mesh *r, octree_limits limits) {
    octree o;
    assert_true(octree_build(r->packed.triangles, r->m.triangles, limits, &o));
    return o;
}

/* Nearest and any hits by a kernel for the nearest ones; without a tree, occlusion is that there is one. */
static inline ray_hits octree_cast_by(lab *l, const char *nearest, const octree *o, const ray_set *s) {
    const uint32_t count[2] = {s->n, o->triangle_count};
    const size_t bytes = (size_t)s->n * 4;
    cl_mem a[OCTREE_BUFFERS + 4];
    octree_buffers(l, o, a);
    a[4] = lab_buffer(l, s->plane, 7 * bytes);
    a[5] = lab_buffer(l, count, sizeof count);
    a[6] = lab_buffer(l, NULL, bytes);
    a[7] = lab_buffer(l, NULL, bytes);
    ray_hits h = {s->n, ray_lab_array(s->n, 4), ray_lab_array(s->n, 4), ray_lab_array(s->n, 4)};
    lab_run(l, nearest, s->n, a, 8);
    lab_read(l, a[6], h.distance, bytes);
    lab_read(l, a[7], h.triangle, bytes);
    lab_run(l, "octree_any", s->n, a, 7);
    lab_read(l, a[6], h.occluded, bytes);
    for (size_t i = 0; i < sizeof a / sizeof *a; i++)
        clReleaseMemObject(a[i]);
    return h;
}

static inline ray_hits octree_cast(lab *l, const octree *o, const ray_set *s) {
    return octree_cast_by(l, "octree_nearest", o, s);
}

static inline ray_hits octree_cast_at_all(lab *l, const octree *o, const ray_set *s) {
    return octree_cast_by(l, "octree_nearest_of_all", o, s);
}

/* The first `most` of the rays that find nothing, alone, cast at every triangle without the tree: *checked of them, of which
 * some still find nothing. The rest was the tree's fault. */
static inline uint32_t octree_lost_without_tree(lab *l, const octree *o, const ray_set *s, const ray_hits *h, uint32_t most,
                                                uint32_t *checked) {
    uint32_t still = 0;
    ray_set few = rays_new((most + 15) / 16 * 16);
    for (uint32_t i = 0; i < few.n; i++)
        rays_limit(&few)[i] = RAY_NOT_CAST;
    *checked = 0;
    for (uint32_t i = 0; i < s->n && *checked < most; i++)
        if (h->triangle[i] == VIT_NONE) {
            float origin[3], direction[3];
            rays_get(s, i, origin, direction);
            rays_set(&few, (*checked)++, origin, direction, rays_limit(s)[i]);
        }
    ray_hits all = octree_cast_at_all(l, o, &few);
    for (uint32_t i = 0; i < *checked; i++)
        still += all.triangle[i] == VIT_NONE;
    hits_free(&all);
    free(few.plane);
    return still;
}

#endif
