/* Work counters: exact, equal however a frame is rendered, and no burden on the frame.
 *
 * Why this is hard: a count that is off by one packet still looks like a count. Strategy: what can be known otherwise is worked
 * out again on the host from the frame's own buffers (hits, keys, lists, nodes) and must match to the unit; what cannot must
 * hold bounds; and every kind that says `same` must not move with lanes or groups, which catches counting packets instead of
 * lanes. Threads and devices are settings of a process: tests/golden/test_budget.c holds files of counts to each other. */
#include "counted_work.h"
#include <math.h>

static const char *const packs[] = {"list",           "buckets", "room",          "room-buckets", "raw",
                                    "normal-keys",    "33x47",   "still",         "dark",         "sparse",
                                    "sparse-buckets", "zones",   "zones-buckets", "basis",        "basis-33x47"};
enum { PACKS = sizeof packs / sizeof packs[0] };

/* Most of the time is PoCL's compiler, which makes each width and group size anew: not every pack in all ways, and the device
 * host for widths where it stands for them. */
static void counts_are_the_same_for_any_lanes_and_groups(void **state) {
    (void)state;
    static const struct {
        uint32_t device, lanes, group;
        size_t packs; /* the first of them */
    } ways[] = {{VIT_DEVICE_HOST, 1, 0, 6},
                {0, 16, 0, 3},
                {VIT_DEVICE_HOST, 8, 0, 6},
                {0, 1, 0, 2},
                {0, 8, 0, 2},
                {0, 1, 64, 1},
                {0, 16, 2, 1}};
    static vit_statistics s[sizeof ways / sizeof ways[0]]; /* large for a stack */
    for (size_t i = 0; i < 6; i++)
        for (size_t w = 0; w < sizeof ways / sizeof ways[0]; w++) {
            if (i >= ways[w].packs)
                continue;
            uint64_t hash;
            char what[96];
            (void)snprintf(what, sizeof what, "%s, device %x, lanes %u, group %u", packs[i], ways[w].device, ways[w].lanes,
                           ways[w].group);
            s[w] = count(packs[i], ways[w].device, ways[w].lanes, ways[w].group, &hash);
            for (size_t u = 0; u < w; u++)
                if (i < ways[u].packs)
                    assert_equal_work(&s[u], &s[w], ways[w].lanes == ways[u].lanes, what);
        }
}

/* The first two packs are also counted by OpenCL's device, whose compiler takes long; the test above holds both devices' counts
 * together. */
static uint32_t device_for(const char *pack) {
    return strcmp(pack, packs[0]) == 0 || strcmp(pack, packs[1]) == 0 ? 0 : VIT_DEVICE_HOST;
}

static counted *count_and_read(const char *pack, vit_open_info how) {
    how.device = device_for(pack);
    return count_frame(pack, how);
}

static void counting_changes_no_bit(void **state) {
    (void)state;
    for (size_t i = 0; i < PACKS; i++) {
        open_pack p;
        uint64_t hash;
        const vit_statistics whole = count(packs[i], device_for(packs[i]), 0, 0, &hash);
        pack_open(&p, packs[i], (vit_open_info){.device = device_for(packs[i])});
        const uint64_t plain = pack_frame_hash(&p, p.need.frames > 1 ? 1 : 0);
        const vit_statistics s = pack_stats(&p);
        assert_true(hash == plain);
        assert_int_equal(s.work_count, 0);
        assert_int_equal(s.pass_count, whole.pass_count);
        assert_int_equal(s.pairs, whole.pairs);
        assert_int_equal(pack_buffer_bytes(&p, "work"), 0);
        pack_close(&p);
    }
}

/* Node of a key's cluster: the bits before it in its word of the last level's masks, after the word's first child. */
static uint32_t cluster_of(const counted *c, uint32_t key) {
    const uint32_t word = c->scene->level_first[c->scene->levels - 1] + (key >> 5);
    return c->prefix[word] + (uint32_t)__builtin_popcount(c->masks[word] & ((1u << (key & 31)) - 1u));
}

static void rays_and_hits_are_those_of_the_buffers(void **state) {
    (void)state;
    for (size_t i = 0; i < PACKS; i++) {
        counted *c = count_and_read(packs[i], (vit_open_info){0});
        const vit_attributes *a = c->p.v->pack.section[VIT_SECTION_ATTR];
        const vit_material *m = c->p.v->pack.section[VIT_SECTION_MATL];
        uint64_t hits = 0, textured = 0;
        for (uint32_t k = 0; k < c->scene->samples; k++) {
            if (c->hits[k] == VIT_NONE)
                continue;
            hits++;
            textured += m[a[c->hits[k]].material & VIT_MATERIAL_INDEX].texture != VIT_NONE;
        }
        assert_int_equal(WORK(&c->s, visibility, view_rays), (uint64_t)c->scene->width * c->scene->height);
        assert_int_equal(total(&c->s, VIT_WORK_view_rays), WORK(&c->s, visibility, view_rays));
        assert_int_equal(WORK(&c->s, samples, surface_points), hits);
        assert_int_equal(WORK(&c->s, samples, texture_fetches), c->scene->effects & VIT_BIT(TEXTURES) ? textured : 0);
        assert_in_range(WORK(&c->s, direct_light, shadow_rays), hits / 2, hits * c->scene->lights);
        drop(c);
    }
}

/* Bounds of a work item's counts in another way: a photon is stored at each hit but the first. */
static void photon_rays_are_between_what_hit_and_what_could(void **state) {
    (void)state;
    counted *c = count_and_read("list", (vit_open_info){0});
    const uint64_t rays = WORK(&c->s, photon_paths, photon_rays), hits = WORK(&c->s, photon_paths, surface_points);
    assert_in_range(hits, (uint64_t)c->s.photons + 1, (uint64_t)c->s.photons + c->scene->paths);
    assert_in_range(rays, hits, (uint64_t)c->scene->paths * c->scene->bounces);
    assert_int_equal(total(&c->s, VIT_WORK_photon_rays), rays);
    drop(c);
    c = count_and_read("still", (vit_open_info){0}); /* its photons are baked */
    assert_int_equal(total(&c->s, VIT_WORK_photon_rays), 0);
    assert_true(total(&c->s, VIT_WORK_evaluations) > 0);
    drop(c);
}

/* Unit normal of octahedral 2 x snorm16, in doubles. */
static void decode_normal(uint32_t code, double n[3]) {
    const double x = (int16_t)(code & 0xffff) / 32767.0, y = (int16_t)(code >> 16) / 32767.0, z = 1.0 - fabs(x) - fabs(y);
    n[0] = z < 0 ? (x < 0 ? -1 : 1) * (1.0 - fabs(y)) : x;
    n[1] = z < 0 ? (y < 0 ? -1 : 1) * (1.0 - fabs(x)) : y;
    n[2] = z;
    const double unit = 1.0 / sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    for (int k = 0; k < 3; k++)
        n[k] *= unit;
}

/* A ray goes to a light where the surface faces it and its cone reaches; only at the edges of both may rounding decide. */
static void shadow_rays_go_where_light_could_come_from(void **state) {
    (void)state;
    counted *c = count_and_read("list", (vit_open_info){0});
    const vit_light *light = (const vit_light *)c->p.v->pack.section[VIT_SECTION_LITE] + c->scene->lights;
    float *position = read_buffer(&c->p, B_position);
    uint32_t *normal = read_buffer(&c->p, B_normal);
    const size_t n = c->scene->samples;
    uint64_t surely = 0, perhaps = 0;
    assert_int_equal(c->scene->lights, 1);
    for (size_t i = 0; i < n; i++) {
        double to[3], s[3], d2 = 0, facing = 0, cosine = 0;
        if (c->hits[i] == VIT_NONE)
            continue;
        decode_normal(normal[i], s);
        for (size_t k = 0; k < 3; k++) {
            to[k] = (double)light->position[k] - (double)position[k * n + i];
            d2 += to[k] * to[k];
            facing += s[k] * to[k];
            cosine -= to[k] * (double)light->direction[k];
        }
        facing /= sqrt(d2);
        cosine = cosine / sqrt(d2) - (double)light->cos_outer;
        surely += facing > 1e-5 && cosine > 1e-5;
        perhaps += facing > -1e-5 && cosine > -1e-5;
    }
    print_message("shadow rays %llu, host %llu to %llu\n", (unsigned long long)WORK(&c->s, direct_light, shadow_rays),
                  (unsigned long long)surely, (unsigned long long)perhaps);
    assert_in_range(WORK(&c->s, direct_light, shadow_rays), surely, perhaps);
    free(position);
    free(normal);
    drop(c);
}

static void evaluations_of_a_list_are_the_lists_of_the_samples(void **state) {
    (void)state;
    static const char *const lists[] = {"list", "normal-keys", "33x47", "room", "still", "zones"};
    for (size_t i = 0; i < sizeof lists / sizeof lists[0]; i++) {
        counted *c = count_and_read(lists[i], (vit_open_info){0});
        uint64_t expected = 0;
        for (uint32_t k = 0; k < c->scene->samples; k++)
            if (c->keys[k] != VIT_NONE)
                expected += c->list[cluster_of(c, c->keys[k])];
        assert_true(expected > 0);
        assert_int_equal(WORK(&c->s, estimate_all, evaluations), expected);
        assert_int_equal(total(&c->s, VIT_WORK_evaluations), expected);
        drop(c);
    }
}

/* At one sample in 4 or 16: the coarse grid's lists, and those of the samples that are flagged. */
static void evaluations_of_a_sparse_list_are_those_of_coarse_and_flagged_samples(void **state) {
    (void)state;
    static const struct {
        const char *pack;
        uint32_t step;
    } lists[] = {{"sparse", 2}, {"sparse-16", 4}, {"sparse-room", 4}};
    for (size_t i = 0; i < sizeof lists / sizeof lists[0]; i++) {
        counted *c = count_and_read(lists[i].pack, (vit_open_info){0});
        uint32_t *flags = read_buffer(&c->p, B_flags);
        uint64_t coarse = 0, flagged = 0;
        for (uint32_t k = 0; k < c->scene->samples; k++) {
            const uint64_t photons = c->keys[k] == VIT_NONE ? 0 : c->list[cluster_of(c, c->keys[k])];
            coarse += k % 4 % lists[i].step == 0 && k / 4 % 4 % lists[i].step == 0 ? photons : 0;
            flagged += flags[k / 16] >> k % 16 & 1u ? photons : 0;
        }
        assert_true(coarse > 0 && flagged > 0);
        assert_int_equal(WORK(&c->s, estimate_sparse, evaluations), coarse);
        assert_int_equal(WORK(&c->s, estimate_rest, evaluations), flagged);
        assert_int_equal(total(&c->s, VIT_WORK_evaluations), coarse + flagged);
        free(flags);
        drop(c);
    }
}

/* With a bound that is too small for all clusters and photons, only what was kept is evaluated. */
static void what_was_dropped_is_not_evaluated(void **state) {
    (void)state;
    counted *c = count_and_read("list", (vit_open_info){.max_nodes = 40, .max_list = 20000});
    uint64_t expected = 0;
    for (uint32_t k = 0; k < c->scene->samples; k++)
        if (c->keys[k] != VIT_NONE && cluster_of(c, c->keys[k]) < 40)
            expected += c->list[cluster_of(c, c->keys[k])];
    assert_true(c->s.dropped_samples > 0 && c->s.dropped_entries > 0);
    assert_int_equal(total(&c->s, VIT_WORK_evaluations), expected);
    drop(c);
}

/* Raw buckets: a sample takes those of its cluster's 54 that hold light. */
static void evaluations_of_raw_buckets_are_those_that_hold_light(void **state) {
    (void)state;
    counted *c = count_and_read("raw", (vit_open_info){0});
    float *buckets = read_buffer(&c->p, B_buckets);
    uint64_t expected = 0;
    for (uint32_t k = 0; k < c->scene->samples; k++)
        for (uint32_t b = 0; b < 54 && c->keys[k] != VIT_NONE; b++)
            expected += buckets[(cluster_of(c, c->keys[k]) * 54 + b) * 4 + 3] > 0;
    assert_true(expected > 0);
    assert_int_equal(total(&c->s, VIT_WORK_evaluations), expected);
    free(buckets);
    drop(c);
}

/* Smoothed buckets: eight octants of one to eight clusters. */
static void evaluations_of_smoothed_buckets_are_whole_clusters(void **state) {
    (void)state;
    counted *c = count_and_read("buckets", (vit_open_info){0});
    const uint64_t evaluations = total(&c->s, VIT_WORK_evaluations);
    uint64_t samples = 0;
    for (uint32_t k = 0; k < c->scene->samples; k++)
        samples += c->keys[k] != VIT_NONE;
    assert_int_equal(evaluations % 8, 0);
    assert_in_range(evaluations, samples * 8, samples * 64);
    drop(c);
}

/* A photon in a node's list is tested against each of the node's children; the root's list is all photons. */
static uint64_t tests_of_nodes(const counted *c, uint32_t first, uint32_t end) {
    uint64_t sum = 0;
    for (uint32_t node = first; node < end; node++)
        sum += (uint64_t)(node == 0 ? c->scene->photons : c->list[node]) * c->children[node];
    return sum;
}

static void node_tests_and_pairs_are_those_of_the_hierarchy(void **state) {
    (void)state;
    for (size_t i = 0; i < PACKS; i++) {
        counted *c = count_and_read(packs[i], (vit_open_info){0});
        if (!c->keys) { /* no photons, no such work */
            assert_int_equal(total(&c->s, VIT_WORK_node_tests) + total(&c->s, VIT_WORK_pairs), 0);
            drop(c);
            continue;
        }
        const uint32_t inner = c->s.nodes - c->s.clusters, *level = c->scene->level_first;
        const uint32_t last = c->scene->levels == 1 ? 0 : c->prefix[level[c->scene->levels - 2]];
        const int lists = (c->scene->effects & VIT_BIT(LIST)) != 0;
        const uint64_t listed = tests_of_nodes(c, 0, lists ? inner : last);
        assert_int_equal(WORK(&c->s, splat_count, node_tests), listed);
        assert_int_equal(WORK(&c->s, splat_write, node_tests), listed);
        assert_int_equal(WORK(&c->s, splat_buckets, node_tests), lists ? 0 : tests_of_nodes(c, last, inner));
        assert_int_equal(total(&c->s, VIT_WORK_pairs), c->s.pairs);
        drop(c);
    }
}

static void work_that_depends_on_the_lanes_says_so_and_is_bounded(void **state) {
    (void)state;
    counted *c = count_and_read("room", (vit_open_info){.lanes = 1});
    const uint64_t rays =
        total(&c->s, VIT_WORK_view_rays) + total(&c->s, VIT_WORK_shadow_rays) + total(&c->s, VIT_WORK_photon_rays);
    static const uint32_t dependent[] = {VIT_WORK_box_tests, VIT_WORK_triangle_tests, VIT_WORK_cutout_tests};
    for (size_t i = 0; i < 3; i++) {
        assert_int_equal(c->s.work_same[dependent[i]], 0);
        assert_true(total(&c->s, dependent[i]) > 0);
    }
    /* One ray a packet: at most every node's two boxes and every triangle. */
    assert_in_range(total(&c->s, VIT_WORK_box_tests), rays * 2, rays * 2 * c->scene->nodes);
    assert_in_range(total(&c->s, VIT_WORK_triangle_tests), rays / 2, rays * c->scene->triangles);
    assert_in_range(total(&c->s, VIT_WORK_cutout_tests), 1, total(&c->s, VIT_WORK_triangle_tests));
    drop(c);
    c = count_and_read("list", (vit_open_info){0}); /* nothing in it is cut out */
    assert_int_equal(total(&c->s, VIT_WORK_cutout_tests), 0);
    drop(c);
}

/* The table of formulas has a row for every pass: no pass moves nothing. */
static void every_pass_of_every_pack_moves_bytes(void **state) {
    (void)state;
    static const char *const all_passes[] = {"list", "buckets", "basis"};
    static const vit_view views[] = {VIT_VIEW_final, VIT_VIEW_photons};
    for (size_t i = 0; i < sizeof all_passes / sizeof all_passes[0]; i++)
        for (size_t k = 0; k < 2; k++) {
            counted *c = count_and_read(all_passes[i], (vit_open_info){.view = views[k]});
            for (uint32_t p = 0; p < c->s.pass_count; p++)
                if (c->s.pass_work[p][VIT_WORK_bytes] == 0)
                    fail_msg("%s: pass %s moves no bytes: runtime/work.c lacks its row", all_passes[i], c->s.pass_names[p]);
            drop(c);
        }
}

/* One formula by hand, from the buffers' own sizes. */
static void bytes_are_sizes_times_counts(void **state) {
    (void)state;
    counted *c = count_and_read("list", (vit_open_info){0});
    assert_int_equal(WORK(&c->s, visibility, bytes),
                     pack_buffer_bytes(&c->p, "hit_triangle") + pack_buffer_bytes(&c->p, "hit_distance"));
    assert_int_equal(WORK(&c->s, estimate_all, bytes), pack_buffer_bytes(&c->p, "keys") + pack_buffer_bytes(&c->p, "position") +
                                                           pack_buffer_bytes(&c->p, "normal") +
                                                           pack_buffer_bytes(&c->p, "indirect") +
                                                           WORK(&c->s, estimate_all, evaluations) * 52);
    assert_int_equal(WORK(&c->s, photon_paths, bytes), pack_buffer_bytes(&c->p, "photons") +
                                                           c->scene->lights * sizeof(vit_light) +
                                                           WORK(&c->s, photon_paths, surface_points) * (48 + 48 + 80));
    drop(c);
}

static void a_frame_is_counted_from_nothing(void **state) {
    (void)state;
    open_pack p;
    static vit_statistics once, again;
    pack_open(&p, "list", (vit_open_info){.count_work = 1});
    pack_frame(&p, 2);
    once = pack_stats(&p);
    pack_frame(&p, 0);
    pack_frame(&p, 2);
    again = pack_stats(&p);
    assert_equal_work(&once, &again, 1, "frame 2, first and third");
    pack_close(&p);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(counts_are_the_same_for_any_lanes_and_groups),
        cmocka_unit_test(counting_changes_no_bit),
        cmocka_unit_test(rays_and_hits_are_those_of_the_buffers),
        cmocka_unit_test(photon_rays_are_between_what_hit_and_what_could),
        cmocka_unit_test(shadow_rays_go_where_light_could_come_from),
        cmocka_unit_test(evaluations_of_a_list_are_the_lists_of_the_samples),
        cmocka_unit_test(evaluations_of_a_sparse_list_are_those_of_coarse_and_flagged_samples),
        cmocka_unit_test(what_was_dropped_is_not_evaluated),
        cmocka_unit_test(evaluations_of_raw_buckets_are_those_that_hold_light),
        cmocka_unit_test(evaluations_of_smoothed_buckets_are_whole_clusters),
        cmocka_unit_test(node_tests_and_pairs_are_those_of_the_hierarchy),
        cmocka_unit_test(work_that_depends_on_the_lanes_says_so_and_is_bounded),
        cmocka_unit_test(every_pass_of_every_pack_moves_bytes),
        cmocka_unit_test(bytes_are_sizes_times_counts),
        cmocka_unit_test(a_frame_is_counted_from_nothing),
    };
    return cmocka_run_group_tests_name("work counts", tests, NULL, NULL);
}
