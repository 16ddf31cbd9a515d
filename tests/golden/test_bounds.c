/* Bounds: the baker's are exact, and bounds that are too small drop by index, count what they drop, and change nothing else.
 *
 * Why this is hard: whether a bound is exact, only a second way of counting can tell. Strategy: an oracle counts nodes,
 * clusters and dropped samples from the samples' keys alone, which vit_trace() shows, by sorting them; the frame that needs the
 * largest bound is then played with one entry or node less, where what is lost is known to the entry and to the sample, and
 * with ends that have a picture of their own: no list of a cluster left, or one node, must leave exactly the direct light. The
 * pack's size is whole tiles, so that every sample is a pixel. */
#include "open_pack.h"
#include "pack_read.h"

/* A frame's samples: their cluster keys in ascending order, and what the hierarchy over them must be. */
typedef struct keyed {
    uint32_t *keys;
    size_t count;    /* samples with a key */
    uint32_t levels; /* of the hierarchy, the root's not counted */
    uint32_t nodes, clusters;
} keyed;

static int ascending(const void *a, const void *b) {
    uint32_t x, y;
    memcpy(&x, a, sizeof x);
    memcpy(&y, b, sizeof y);
    return (x > y) - (x < y);
}

/* Different values among the keys without their low bits. */
static uint32_t prefixes(const keyed *k, uint32_t low_bits) {
    uint32_t count = 0;
    for (size_t i = 0; i < k->count; i++)
        count += i == 0 || k->keys[i] >> low_bits != k->keys[i - 1] >> low_bits;
    return count;
}

typedef struct catcher {
    const void *scratch;
    uint64_t bytes;
    uint32_t *copy;
} catcher;

static void catch_keys(void *user, const char *pass, uint64_t hash) {
    catcher *c = user;
    (void)hash;
    if (strcmp(pass, "cluster_keys.keys") == 0)
        memcpy(c->copy, c->scratch, (size_t)c->bytes);
}

static keyed keys_of(open_pack *p, uint32_t index) {
    vit_pack pack;
    keyed k = {0};
    uint64_t bytes = pack_buffer_bytes(p, "keys"), largest = 0;
    assert_vit_ok(p, vit_pack_read(p->bytes, p->info.pack_size, &pack, &p->why));
    k.levels = pack.scene->levels;
    for (uint32_t i = 0; i < p->need.buffer_count; i++)
        largest = p->need.buffers[i].bytes > largest ? p->need.buffers[i].bytes : largest;
    void *scratch = malloc((size_t)largest);
    k.keys = malloc((size_t)bytes);
    assert_non_null(scratch);
    assert_non_null(k.keys);
    catcher c = {scratch, bytes, k.keys};
    assert_vit_ok(p, vit_trace(p->v, index, scratch, (size_t)largest, catch_keys, &c, &p->why));
    free(scratch);
    qsort(k.keys, (size_t)bytes / sizeof *k.keys, sizeof *k.keys, ascending);
    while (k.count < bytes / sizeof *k.keys && k.keys[k.count] != VIT_NONE)
        k.count++;
    k.clusters = prefixes(&k, 0);
    k.nodes = 1;
    for (uint32_t level = 0; level < k.levels; level++)
        k.nodes += prefixes(&k, 5 * level);
    return k;
}

/* Samples whose cluster has no place among the first `bound` nodes: clusters are numbered last, in the order of their keys. */
static uint64_t beyond(const keyed *k, uint32_t bound) {
    uint32_t node = k->nodes - k->clusters;
    for (size_t i = 0; i < k->count; i++) {
        node += i > 0 && k->keys[i] != k->keys[i - 1];
        if (node >= bound)
            return k->count - i;
    }
    return 0;
}

static const char *const packs[] = {"whole-tiles", "list", "buckets", "raw", "normal-keys", "room"};
#define EACH_PACK(i) for (size_t i = 0; i < sizeof packs / sizeof packs[0]; i++)

/* The bounds as sizes of buffers: what is really allocated. */
static uint32_t bound_of_nodes(const open_pack *p) {
    return (uint32_t)(pack_buffer_bytes(p, "node_first") / 4);
}

static uint32_t bound_of_list(const open_pack *p) {
    return (uint32_t)(pack_buffer_bytes(p, "list") / 4);
}

static void baked_bounds_drop_nothing_and_are_reached(void **state) {
    (void)state;
    EACH_PACK(i) {
        open_pack p;
        pack_open(&p, packs[i], (vit_open_info){0});
        uint32_t nodes = 0, list = 1; /* a list has room for one entry at least */
        for (uint32_t f = 0; f < p.need.frames; f++) {
            pack_frame(&p, f);
            const vit_statistics s = pack_stats(&p);
            nodes = s.nodes > nodes ? s.nodes : nodes;
            list = s.list > list ? s.list : list;
        }
        const vit_statistics s = pack_stats(&p);
        assert_int_equal(s.frames, p.need.frames);
        assert_int_equal(s.dropped_samples, 0);
        assert_int_equal(s.dropped_entries, 0);
        assert_int_equal(nodes, bound_of_nodes(&p));
        assert_int_equal(list, bound_of_list(&p));
        assert_int_equal(s.max_nodes, nodes);
        assert_int_equal(s.max_list, s.list == 0 ? 0 : list);
        pack_close(&p);
    }
}

static void work_of_each_frame_is_the_packs(void **state) {
    (void)state;
    EACH_PACK(i) {
        open_pack p;
        vit_pack pack;
        pack_open(&p, packs[i], (vit_open_info){0});
        assert_vit_ok(&p, vit_pack_read(p.bytes, p.info.pack_size, &pack, &p.why));
        const vit_gold *gold = pack.section[VIT_SECTION_GOLD];
        for (uint32_t f = 0; f < p.need.frames; f++) {
            pack_frame(&p, f);
            const vit_statistics s = pack_stats(&p);
            assert_int_equal(s.nodes, gold[f].nodes);
            assert_int_equal(s.clusters, gold[f].clusters);
            assert_int_equal(s.photons, gold[f].photons);
            assert_int_equal(s.list, gold[f].list);
            assert_int_equal(s.pairs, gold[f].pairs);
            assert_int_equal(s.largest, gold[f].largest);
        }
        pack_close(&p);
    }
}

static void nodes_and_clusters_are_those_of_the_sorted_keys(void **state) {
    (void)state;
    EACH_PACK(i) {
        open_pack p;
        pack_open(&p, packs[i], (vit_open_info){0});
        for (uint32_t f = 0; f < p.need.frames; f++) {
            keyed k = keys_of(&p, f);
            const vit_statistics s = pack_stats(&p);
            assert_true(k.clusters > 1);
            assert_int_equal(s.clusters, k.clusters);
            assert_int_equal(s.nodes, k.nodes);
            free(k.keys);
        }
        pack_close(&p);
    }
}

/* What a bound leaves of a frame: its statistics, and its pixels in RGBA32F. */
typedef struct outcome {
    vit_statistics stats;
    float *pixels; /* 4 a pixel */
    size_t count;  /* pixels */
    uint32_t width;
} outcome;

static outcome outcome_of(const char *name, uint32_t frame, uint32_t max_nodes, uint32_t max_list, vit_view view) {
    open_pack p;
    pack_open(&p, name,
              (vit_open_info){.format = VIT_FORMAT_RGBA32F, .view = view, .max_nodes = max_nodes, .max_list = max_list});
    pack_frame(&p, frame);
    outcome o = {
        .stats = pack_stats(&p), .pixels = malloc(p.need.frame_bytes), .count = p.need.frame_bytes / 16, .width = p.need.width};
    assert_non_null(o.pixels);
    memcpy(o.pixels, p.frame, p.need.frame_bytes);
    pack_close(&p);
    return o;
}

/* The whole-tiles pack, its keys, bounds, and the frames that reach them. */
typedef struct exact {
    uint32_t nodes, list, nodes_frame, list_frame, pairs;
} exact;

static exact find_exact(void) {
    open_pack p;
    exact e = {0};
    pack_open(&p, "whole-tiles", (vit_open_info){0});
    e.nodes = bound_of_nodes(&p);
    e.list = bound_of_list(&p);
    for (uint32_t f = 0; f < p.need.frames; f++) {
        pack_frame(&p, f);
        const vit_statistics s = pack_stats(&p);
        if (s.nodes == e.nodes)
            e.nodes_frame = f;
        if (s.list == e.list) {
            e.list_frame = f;
            e.pairs = s.pairs;
        }
    }
    pack_close(&p);
    return e;
}

/* Pixels of `b` that differ from those of `a`, none of which is brighter; all must lie in one tile of 32. */
static size_t darkened_in_one_tile(const outcome *a, const outcome *b) {
    size_t count = 0, tile = 0;
    assert_int_equal(a->count, b->count);
    for (size_t i = 0; i < a->count; i++) {
        const float *x = a->pixels + 4 * i, *y = b->pixels + 4 * i;
        if (memcmp(x, y, 16) == 0)
            continue;
        const size_t here = i / a->width / 32 * 65536 + i % a->width / 32;
        assert_true(y[0] <= x[0] && y[1] <= x[1] && y[2] <= x[2]);
        assert_true(count++ == 0 || here == tile);
        tile = here;
    }
    return count;
}

static void one_list_entry_less_drops_the_last_entry_alone(void **state) {
    (void)state;
    const exact e = find_exact();
    outcome whole = outcome_of("whole-tiles", e.list_frame, 0, 0, VIT_VIEW_indirect);
    outcome less = outcome_of("whole-tiles", e.list_frame, 0, e.list - 1, VIT_VIEW_indirect);
    assert_int_equal(whole.stats.dropped_entries, 0);
    assert_int_equal(less.stats.dropped_entries, 1);
    assert_int_equal(less.stats.dropped_samples, 0);
    assert_int_equal(less.stats.list, e.list); /* what the frame wants is still told */
    assert_int_equal(less.stats.max_list, e.list);
    (void)darkened_in_one_tile(&whole, &less);
    free(whole.pixels);
    free(less.pixels);
}

static void one_node_less_drops_the_samples_of_the_last_cluster_alone(void **state) {
    (void)state;
    const exact e = find_exact();
    open_pack p;
    pack_open(&p, "whole-tiles", (vit_open_info){0});
    keyed k = keys_of(&p, e.nodes_frame);
    pack_close(&p);
    outcome whole = outcome_of("whole-tiles", e.nodes_frame, 0, 0, VIT_VIEW_indirect);
    outcome less = outcome_of("whole-tiles", e.nodes_frame, e.nodes - 1, 0, VIT_VIEW_indirect);
    const uint64_t last = beyond(&k, e.nodes - 1);
    assert_in_range(last, 1, k.count);
    assert_int_equal(less.stats.dropped_samples, last);
    assert_int_equal(less.stats.nodes, e.nodes);
    assert_int_equal(less.stats.max_nodes, e.nodes);
    assert_in_range(darkened_in_one_tile(&whole, &less), 1, last);
    for (size_t i = 0; i < whole.count; i++)
        if (memcmp(whole.pixels + 4 * i, less.pixels + 4 * i, 16) != 0)
            assert_true(less.pixels[4 * i] == 0.0f && less.pixels[4 * i + 1] == 0.0f && less.pixels[4 * i + 2] == 0.0f);
    free(whole.pixels);
    free(less.pixels);
    free(k.keys);
}

static void samples_dropped_at_any_bound_are_those_of_the_clusters_beyond_it(void **state) {
    (void)state;
    static const char *const names[] = {"whole-tiles", "normal-keys", "buckets"};
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++) {
        open_pack p;
        pack_open(&p, names[i], (vit_open_info){0});
        keyed k = keys_of(&p, 0);
        pack_close(&p);
        const uint32_t inner = k.nodes - k.clusters;
        const uint32_t bounds[] = {k.nodes, k.nodes - 2, inner + k.clusters / 2, inner + 1, inner, inner / 2 + 1, 1};
        for (size_t b = 0; b < sizeof bounds / sizeof bounds[0]; b++) {
            outcome o = outcome_of(names[i], 0, bounds[b], 0, VIT_VIEW_final);
            assert_int_equal(o.stats.dropped_samples, beyond(&k, bounds[b]));
            assert_int_equal(o.stats.nodes, k.nodes);
            free(o.pixels);
        }
        free(k.keys);
    }
}

static void what_is_left_without_clusters_or_their_lists_is_the_direct_light(void **state) {
    (void)state;
    const exact e = find_exact();
    outcome direct = outcome_of("whole-tiles", e.list_frame, 0, 0, VIT_VIEW_direct);
    outcome no_lists = outcome_of("whole-tiles", e.list_frame, 0, e.list - e.pairs, VIT_VIEW_final);
    outcome one_node = outcome_of("whole-tiles", e.list_frame, 1, 1, VIT_VIEW_final);
    assert_int_equal(no_lists.stats.dropped_entries, e.pairs);
    assert_int_equal(no_lists.stats.dropped_samples, 0);
    assert_memory_equal(no_lists.pixels, direct.pixels, 16 * direct.count);
    assert_memory_equal(one_node.pixels, direct.pixels, 16 * direct.count);
    assert_true(one_node.stats.dropped_samples > 0);
    free(direct.pixels);
    free(no_lists.pixels);
    free(one_node.pixels);
}

static void bounds_larger_than_needed_change_no_bit(void **state) {
    (void)state;
    static const char *const names[] = {"whole-tiles", "buckets"};
    for (size_t i = 0; i < 2; i++) {
        open_pack p, q;
        pack_open(&p, names[i], (vit_open_info){0});
        pack_open(&q, names[i],
                  (vit_open_info){.max_nodes = bound_of_nodes(&p) * 2 + 7, .max_list = bound_of_list(&p) * 3 + 1});
        for (uint32_t f = 0; f < p.need.frames; f++)
            assert_int_equal(pack_frame_hash(&q, f), vit_golden(p.v, f));
        assert_int_equal(pack_stats(&q).dropped_entries + pack_stats(&q).dropped_samples, 0);
        pack_close(&q);
        pack_close(&p);
    }
}

/* Baked irradiance has no hierarchy and no lists: there is nothing to bound and nothing to drop. */
static void a_basis_has_no_bounds(void **state) {
    (void)state;
    static const char *const names[] = {"basis", "basis-shine", "live", "live-33x47"};
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++) {
        open_pack p;
        pack_open(&p, names[i], (vit_open_info){.max_nodes = 1, .max_list = 1, .device = VIT_DEVICE_HOST});
        assert_int_equal(bound_of_nodes(&p) + bound_of_list(&p), 0);
        for (uint32_t f = 0; f < p.need.frames; f++)
            assert_int_equal(pack_frame_hash(&p, f), vit_golden(p.v, f));
        const vit_statistics s = pack_stats(&p);
        assert_int_equal(s.dropped_samples + s.dropped_entries, 0);
        assert_int_equal(s.nodes + s.clusters + s.photons + s.list + s.pairs, 0);
        pack_close(&p);
    }
}

static tool_run r;

/* Compilers below OpenCL tell how many warnings they have, on the same stream: the player's lines alone are left. */
static void keep_own_lines(char *text) {
    char *to = text;
    for (const char *line = text, *end; *line; line = end) {
        end = strchr(line, '\n');
        end = end ? end + 1 : line + strlen(line);
        if (strncmp(line, "vitrine-play: ", 14) != 0)
            continue;
        memmove(to, line, (size_t)(end - line));
        to += end - line;
    }
    *to = '\0';
}

/* The player with these bounds: the frames' hashes, and the line that tells what was dropped. */
static void play_bounded(const char *environment, const char *name, uint32_t max_nodes, uint32_t max_list,
                         const char *options) {
    char bounds[80] = "";
    size_t n = 0;
    if (max_nodes)
        n = (size_t)snprintf(bounds, sizeof bounds, "--max-nodes %u ", max_nodes);
    if (max_list)
        (void)snprintf(bounds + n, sizeof bounds - n, "--max-list %u", max_list);
    tool(&r, "%s " TOOL_PLAY " %s --quiet --hash %s %s", environment, test_pack(name), bounds, options);
    tool_succeeds(&r);
    keep_own_lines(r.err);
}

static void bounds_that_are_too_small_drop_the_same_however_it_is_played(void **state) {
    (void)state;
    static const struct {
        const char *environment, *options;
    } ways[] = {{"POCL_MAX_PTHREAD_COUNT=1", ""},
                {"POCL_MAX_PTHREAD_COUNT=2", "--lanes 1 --group 256"},
                {"POCL_DEVICES=basic", "--lanes 16 --group 32"}};
    static const char *const names[] = {"buckets", "normal-keys"};
    static char out[TOOL_TEXT], err[TOOL_TEXT];
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++) {
        open_pack p;
        pack_open(&p, names[i], (vit_open_info){0});
        const uint32_t nodes = bound_of_nodes(&p), list = bound_of_list(&p);
        pack_close(&p);
        const uint32_t bounds[][2] = {{nodes / 2, 0}, {0, (list + 1) / 2}, {nodes / 2, list / 2}, {1, 1}};
        for (size_t b = 0; b < sizeof bounds / sizeof bounds[0]; b++) {
            play_bounded("", names[i], bounds[b][0], bounds[b][1], "");
            memcpy(out, r.out, sizeof out);
            memcpy(err, r.err, sizeof err);
            if (bounds[b][1] != list) /* a hierarchy of one level has no list to make smaller */
                assert_non_null(strstr(err, "were dropped"));
            for (size_t w = 0; w < sizeof ways / sizeof ways[0]; w++) {
                play_bounded(ways[w].environment, names[i], bounds[b][0], bounds[b][1], ways[w].options);
                if (strcmp(r.out, out) != 0 || strcmp(r.err, err) != 0)
                    fail_msg("%s\n%s%s\nbut the plain run\n%s%s", r.line, r.out, r.err, out, err);
            }
        }
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(baked_bounds_drop_nothing_and_are_reached),
        cmocka_unit_test(work_of_each_frame_is_the_packs),
        cmocka_unit_test(nodes_and_clusters_are_those_of_the_sorted_keys),
        cmocka_unit_test(one_list_entry_less_drops_the_last_entry_alone),
        cmocka_unit_test(one_node_less_drops_the_samples_of_the_last_cluster_alone),
        cmocka_unit_test(samples_dropped_at_any_bound_are_those_of_the_clusters_beyond_it),
        cmocka_unit_test(what_is_left_without_clusters_or_their_lists_is_the_direct_light),
        cmocka_unit_test(bounds_larger_than_needed_change_no_bit),
        cmocka_unit_test(a_basis_has_no_bounds),
        cmocka_unit_test(bounds_that_are_too_small_drop_the_same_however_it_is_played),
    };
    return cmocka_run_group_tests_name("bounds", tests, NULL, NULL);
}
