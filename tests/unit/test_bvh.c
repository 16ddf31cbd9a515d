/* The BVH. What a ray hits must not depend on the tree, so the tests check what traversal relies on, for trees of many shapes:
 * each triangle in exactly one leaf, each box exactly around what is below it, indices that grow downwards, a bounded depth.
 * Models are made by hand from a fixed generator; the worst ones (all triangles alike, sizes that grow exponentially) drive the
 * builder into its fallbacks. Determinism is tested on more triangles than Embree's threshold for parallel work. */
#include "geometry/bvh.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

/* The builder once more, with so small a depth that Embree gives up: grown boxes keep real scenes far from the true limit. */
vit_status bvh_build_shallow(const model *m, unsigned threads, bvh *out, vit_text *why);
void bvh_free_shallow(bvh *b);
#define EMBREE_DEPTH 10
#define bvh_build bvh_build_shallow
#define bvh_free bvh_free_shallow
#include "geometry/bvh.c"
#undef bvh_build
#undef bvh_free

static uint32_t random_bits(uint32_t *state) {
    *state = *state * 747796405u + 2891336453u;
    const uint32_t w = ((*state >> ((*state >> 28) + 4)) ^ *state) * 277803737u;
    return (w >> 22) ^ w;
}

static float random_unit(uint32_t *state) {
    return (float)(random_bits(state) >> 8) * 0x1p-24f;
}

/* A soup of `triangles` separate triangles, positions to be filled in. */
static model soup(uint32_t triangles) {
    model m = {.vertices = 3 * triangles, .triangles = triangles};
    m.position = calloc(9 * (size_t)triangles, sizeof(float));
    m.index = calloc(3 * (size_t)triangles, sizeof(uint32_t));
    m.material = calloc(triangles, sizeof(uint32_t));
    assert_true(m.position && m.index && m.material);
    for (uint32_t i = 0; i < 3 * triangles; i++)
        m.index[i] = i;
    return m;
}

static void put_triangle(model *m, uint32_t i, float x, float y, float z, float size) {
    const float corners[9] = {x, y, z, x + size, y, z + 0.5f * size, x, y + size, z};
    memcpy(m->position + 9 * (size_t)i, corners, sizeof corners);
}

static void drop(model *m) {
    free(m->position);
    free(m->index);
    free(m->material);
}

static model scattered(uint32_t triangles) {
    model m = soup(triangles);
    uint32_t seed = 7;
    for (uint32_t i = 0; i < triangles; i++) {
        const float x = 20.0f * random_unit(&seed) - 10.0f, y = 5.0f * random_unit(&seed), z = 20.0f * random_unit(&seed);
        put_triangle(&m, i, x, y, z, 0.01f + 0.3f * random_unit(&seed));
    }
    return m;
}

typedef struct bounds {
    float lo[3], hi[3];
} bounds;

typedef struct walk {
    const model *m;
    const bvh *b;
    uint8_t *seen; /* by position in leaf order */
    uint32_t visited, deepest, next_triangle;
} walk;

static void grow(bounds *a, const float lo[3], const float hi[3]) {
    for (int k = 0; k < 3; k++) {
        a->lo[k] = fminf(a->lo[k], lo[k]);
        a->hi[k] = fmaxf(a->hi[k], hi[k]);
    }
}

static bounds nothing(void) {
    return (bounds){{3.0e38f, 3.0e38f, 3.0e38f}, {-3.0e38f, -3.0e38f, -3.0e38f}};
}

/* The box that the contract gives triangle `t`, computed in its words: min - pad, max + pad, in float. */
static bounds grown(const model *m, uint32_t t, float pad) {
    bounds a = nothing();
    for (uint32_t c = 0; c < 3; c++) {
        const float *p = m->position + 3 * (size_t)m->index[3 * t + c];
        grow(&a, p, p);
    }
    for (int k = 0; k < 3; k++) {
        a.lo[k] = a.lo[k] - pad;
        a.hi[k] = a.hi[k] + pad;
    }
    return a;
}

static bounds check_node(walk *w, uint32_t index, uint32_t depth);

static bounds check_child(walk *w, uint32_t parent, uint32_t child, const float lo[3], const float hi[3], uint32_t depth) {
    bounds below = nothing();
    if (!(child & VIT_LEAF_BIT)) {
        assert_true(child > parent);
        assert_true(child < w->b->node_count);
        below = check_node(w, child, depth + 1);
    } else {
        const uint32_t first = child & VIT_LEAF_FIRST, count = (child >> VIT_LEAF_SHIFT & 7u) + 1;
        assert_true(count <= 4);
        assert_int_equal(first, w->next_triangle); /* depth-first: leaves follow one another */
        for (uint32_t i = first; i < first + count; i++) {
            assert_true(i < w->m->triangles);
            assert_false(w->seen[i]);
            w->seen[i] = 1;
            if (i > first)
                assert_true(w->b->order[i] > w->b->order[i - 1]);
            const bounds t = grown(w->m, w->b->order[i], w->b->box_pad);
            grow(&below, t.lo, t.hi);
        }
        w->next_triangle += count;
    }
    assert_memory_equal(below.lo, lo, sizeof below.lo); /* exactly around what is below, hence inside the parent's */
    assert_memory_equal(below.hi, hi, sizeof below.hi);
    return below;
}

static bounds check_node(walk *w, uint32_t index, uint32_t depth) {
    const vit_bvh_node *n = w->b->nodes + index;
    w->visited++;
    w->deepest = depth > w->deepest ? depth : w->deepest;
    assert_int_equal(n->pad[0] | n->pad[1], 0);
    bounds all = check_child(w, index, n->child0, n->lo0, n->hi0, depth);
    const bool single = index == 0 && n->lo1[0] > n->hi1[0];
    if (single) {
        assert_int_equal(n->child1, VIT_LEAF_BIT);
        assert_true(n->lo1[1] > n->hi1[1] && n->lo1[2] > n->hi1[2]);
        return all;
    }
    const bounds second = check_child(w, index, n->child1, n->lo1, n->hi1, depth);
    grow(&all, second.lo, second.hi);
    return all;
}

static void check_tree(const model *m, const bvh *b) {
    walk w = {.m = m, .b = b, .seen = calloc(m->triangles, 1)};
    uint8_t *listed = calloc(m->triangles, 1);
    assert_true(w.seen && listed);
    check_node(&w, 0, 1);
    assert_int_equal(w.visited, b->node_count);
    assert_int_equal(w.next_triangle, m->triangles);
    assert_int_equal(w.deepest, b->depth);
    assert_true(b->depth < VIT_BVH_STACK);
    for (uint32_t i = 0; i < m->triangles; i++) {
        assert_true(b->order[i] < m->triangles);
        assert_false(listed[b->order[i]]);
        listed[b->order[i]] = 1;
    }
    free(w.seen);
    free(listed);
}

static void build_and_check(model m) {
    bvh b;
    vit_text why = {""};
    if (bvh_build(&m, 2, &b, &why) != VIT_OK)
        fail_msg("%s", why.text);
    check_tree(&m, &b);
    bvh_free(&b);
    drop(&m);
}

static void every_triangle_is_in_one_leaf_inside_exact_boxes(void **state) {
    (void)state;
    build_and_check(scattered(2000));
}

static void small_models_get_a_root_with_an_empty_second_child(void **state) {
    (void)state;
    for (uint32_t triangles = 1; triangles <= 9; triangles++)
        build_and_check(scattered(triangles));
}

static void a_thousand_equal_triangles_are_no_trouble(void **state) {
    (void)state;
    model m = soup(1000);
    for (uint32_t i = 0; i < m.triangles; i++)
        put_triangle(&m, i, 1.0f, 2.0f, 3.0f, 1.0f);
    build_and_check(m);
}

/* Each split peels off few triangles, so that a greedy builder goes down one level a triangle. */
static void triangles_that_grow_exponentially_stay_within_the_stack(void **state) {
    (void)state;
    for (uint32_t triangles = 50; triangles <= 3200; triangles *= 2) {
        model m = soup(triangles);
        for (uint32_t i = 0; i < triangles; i++) {
            const double scale = pow(10.0, 8.0 - 38.0 * (double)i / triangles);
            put_triangle(&m, i, (float)(scale * (i % 2 ? -1.0 : 1.0)), 0.0f, 0.0f, (float)(scale * 0.01));
        }
        build_and_check(m);
    }
}

static void nested_triangles_with_a_common_corner_stay_within_the_stack(void **state) {
    (void)state;
    model m = soup(3000);
    for (uint32_t i = 0; i < m.triangles; i++)
        put_triangle(&m, i, 0.0f, 0.0f, 0.0f, (float)pow(1.02, -(double)i));
    build_and_check(m);
}

static void a_tree_that_embree_refuses_is_built_by_medians(void **state) {
    (void)state;
    model m = scattered(100000);
    bvh embree, median;
    vit_text why = {""};
    assert_int_equal(bvh_build(&m, 2, &embree, &why), VIT_OK);
    assert_int_equal(bvh_build_shallow(&m, 2, &median, &why), VIT_OK);
    check_tree(&m, &median);
    assert_true(embree.depth > 17); /* above the 10 levels, so Embree did refuse */
    assert_int_equal(median.depth, 15);
    bvh_free(&embree);
    bvh_free_shallow(&median);
    drop(&m);
}

static void one_thread_and_two_give_the_same_bytes(void **state) {
    (void)state;
    model m = scattered(120000);
    for (uint32_t i = 0; i < 20000; i++) /* a clump of equal centres, which only a split in the middle can part */
        put_triangle(&m, i, 1.0f, 2.0f, 3.0f, 0.25f);
    bvh one;
    vit_text why = {""};
    assert_int_equal(bvh_build(&m, 1, &one, &why), VIT_OK);
    check_tree(&m, &one);
    for (unsigned run = 0; run < 6; run++) {
        bvh other;
        assert_int_equal(bvh_build(&m, run % 3 == 2 ? 0 : 2, &other, &why), VIT_OK);
        assert_int_equal(one.node_count, other.node_count);
        assert_memory_equal(one.nodes, other.nodes, one.node_count * sizeof *one.nodes);
        assert_memory_equal(one.order, other.order, m.triangles * sizeof *one.order);
        bvh_free(&other);
    }
    bvh_free(&one);
    drop(&m);
}

static void boxes_are_grown_by_a_millionth_of_the_largest_coordinate(void **state) {
    (void)state;
    model m = soup(2);
    put_triangle(&m, 0, -48.0f, 0.0f, 0.0f, 1.0f);
    put_triangle(&m, 1, 3.0f, 0.0f, 0.0f, 1.0f);
    bvh b;
    vit_text why = {""};
    assert_int_equal(bvh_build(&m, 1, &b, &why), VIT_OK);
    assert_true(b.box_pad == 48.0f * 0x1p-20f);
    assert_true(b.nodes[0].lo0[0] == -48.0f - b.box_pad);
    bvh_free(&b);
    drop(&m);
}

static void a_coordinate_that_would_overflow_is_bad_input(void **state) {
    (void)state;
    const float bad[] = {1e30f, INFINITY};
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        model m = scattered(10);
        m.position[4] = bad[i];
        bvh b;
        vit_text why = {""};
        assert_int_equal(bvh_build(&m, 1, &b, &why), VIT_BAD_INPUT);
        assert_non_null(strstr(why.text, "coordinate"));
        drop(&m);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_triangle_is_in_one_leaf_inside_exact_boxes),
        cmocka_unit_test(small_models_get_a_root_with_an_empty_second_child),
        cmocka_unit_test(a_thousand_equal_triangles_are_no_trouble),
        cmocka_unit_test(triangles_that_grow_exponentially_stay_within_the_stack),
        cmocka_unit_test(nested_triangles_with_a_common_corner_stay_within_the_stack),
        cmocka_unit_test(a_tree_that_embree_refuses_is_built_by_medians),
        cmocka_unit_test(one_thread_and_two_give_the_same_bytes),
        cmocka_unit_test(boxes_are_grown_by_a_millionth_of_the_largest_coordinate),
        cmocka_unit_test(a_coordinate_that_would_overflow_is_bad_input),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
