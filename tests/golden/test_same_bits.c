/* The product's promise: the same pack gives the same bits, whatever plays it and however.
 *
 * Why this is hard: there is no reference picture to compare with, and a race may show only once in many frames. Strategy:
 * the pack's golden hashes are one witness, a first plain run is the second; then everything that must not matter is varied,
 * one thing at a time and some together: run, thread count, lanes, work-group size, PoCL's device and its way of making
 * work-groups, order of frames. Each run must print exactly the lines of the first. Traces say the same of every buffer after
 * every pass, so that a difference that a later pass hides shows too. Threads and devices are settings of a whole process, so
 * the real player runs as a child. */
#include "test_packs.h"
#include "vitrine.h"
#include "vitrine_pack.h"

#include <stdbool.h>

enum { AT_ONCE = 2 };          /* most of a run's time is PoCL's compiler, which has one thread */
static tool_run runs[AT_ONCE]; /* too large for a stack */

/* Lines that the variants are held to. */
static char expected[TOOL_TEXT];

static void begin(tool_run *r, const char *environment, const char *pack, const char *what, const char *options) {
    tool_line(r, "%s " TOOL_PLAY " %s --quiet %s %s", environment, pack, what, options);
    tool_begin(r);
}

/* Plays and keeps the lines as those that others are held to. */
static void play_first(const char *pack, const char *what, const char *options) {
    begin(&runs[0], "", pack, what, options);
    tool_end(&runs[0]);
    tool_succeeds(&runs[0]);
    memcpy(expected, runs[0].out, sizeof expected);
    assert_true(expected[0] != '\0');
}

static void play_plain(const char *pack, const char *what) {
    play_first(pack, what, "");
}

static void assert_as_expected(const tool_run *r) {
    size_t at = 0;
    tool_succeeds(r);
    if (strcmp(r->out, expected) == 0)
        return;
    while (r->out[at] == expected[at])
        at++;
    while (at > 0 && r->out[at - 1] != '\n')
        at--;
    fail_msg("%s\nis different from the first run; the first line that differs:\n%.99s\nbut the first run's\n%.99s", r->line,
             r->out + at, expected + at);
}

/* Every environment and set of options gives the lines of the first; `what` goes with all. */
typedef struct variant {
    const char *environment, *options;
} variant;

static void assert_alike(const char *pack, const char *what, const variant *variants, size_t count) {
    for (size_t i = 0; i < count; i += AT_ONCE) {
        const size_t n = count - i < AT_ONCE ? count - i : AT_ONCE;
        for (size_t k = 0; k < n; k++)
            begin(&runs[k], variants[i + k].environment, pack, what, variants[i + k].options);
        for (size_t k = 0; k < n; k++)
            tool_end(&runs[k]);
        for (size_t k = 0; k < n; k++)
            assert_as_expected(&runs[k]);
    }
}

static void assert_all_alike(const char *pack, const char *what, const variant *variants, size_t count) {
    play_plain(pack, what);
    assert_alike(pack, what, variants, count);
}

#define COUNT(a) (sizeof(a) / sizeof(a)[0])
/* PoCL's ways of making work-groups (auto is the plain run's), each with a cache of its own: what was compiled another way must
 * not be taken. */
#define METHOD(m) "POCL_WORK_GROUP_METHOD=" m " POCL_CACHE_DIR=" TEST_PACKS "/pocl-" m

/* Ways of OpenCL's. Its compiler makes each anew, which takes 3 to 8 s, so that a pack is played in those that are named with
 * it, and each effect meets all of them in one pack or another: every_effect_meets_every_way. `make matrix` has devices,
 * threads and lanes in all their pairs. */
enum { ONE_LANE = 1, EIGHT_LANES = 2, SIXTEEN_LANES = 4, BY_DEFAULT = 8, ALL_WAYS = 15, WAYS_OF_OPENCL = 4 };
static const variant of_opencl[WAYS_OF_OPENCL] = {{"POCL_MAX_PTHREAD_COUNT=2", "--lanes 1 --group 256"},
                                                  {"POCL_DEVICES=pthread", "--lanes 8 --group 1"},
                                                  {"POCL_DEVICES=basic", "--lanes 16 --group 32"},
                                                  {"POCL_MAX_PTHREAD_COUNT=1", ""}};

/* Ways that need no program. */
static const variant of_no_compiler[] = {{"", "--device host --threads 3"},
                                         {"", "--device host --threads 1 --lanes 1"},
                                         {"", "--device host --threads 2 --lanes 8 --host-isa baseline"}};

/* Played by one pack alone. */
static const variant rare[] = {{"", ""},
                               {"POCL_MAX_PTHREAD_COUNT=2", ""},
                               {METHOD("loops"), ""},
                               {METHOD("loopvec"), ""},
                               {"", "--device 0 --wide-divide"},
                               {"", "--device 0 --wide-divide --lanes 1"}};

static const struct {
    const char *pack;
    unsigned ways; /* of OpenCL's */
} played[] = {
    {"list", ALL_WAYS},
    {"room", ALL_WAYS},
    {"live", ALL_WAYS},
    {"progressive", ALL_WAYS},
    {"buckets", ONE_LANE},
    {"normal-keys", ONE_LANE | SIXTEEN_LANES},
    {"sparse", EIGHT_LANES},
    {"sparse-buckets", SIXTEEN_LANES},
    {"small-sparse", ONE_LANE},
    {"zones", ONE_LANE},
    {"zones-buckets", EIGHT_LANES},
    {"zones-sparse-buckets", SIXTEEN_LANES},
    {"basis", ONE_LANE},
    {"basis-33x47", EIGHT_LANES},
    {"basis-shine", ALL_WAYS},
    {"points", ALL_WAYS},
    {"points-shine", BY_DEFAULT},
    {"shine", ONE_LANE | BY_DEFAULT},
    {"live-shine", EIGHT_LANES},
    {"live-33x47", ONE_LANE},
    {"mesh", BY_DEFAULT},
    {"raw", BY_DEFAULT},
    {"flattened", BY_DEFAULT},
    {"sparse-16", BY_DEFAULT},
    {"sparse-room", BY_DEFAULT},
    {"nearest", BY_DEFAULT},
    {"trilinear", BY_DEFAULT},
    {"small", BY_DEFAULT},
    {"zones-sparse", BY_DEFAULT},
    {"areas-alone", BY_DEFAULT},
    {"basis-still", BY_DEFAULT},
    {"basis-16", BY_DEFAULT},
    {"live-once", BY_DEFAULT},
    {"dark", BY_DEFAULT},
    {"atrium", BY_DEFAULT},
};

static unsigned ways_of(const char *pack) {
    for (size_t i = 0; i < COUNT(played); i++)
        if (strcmp(played[i].pack, pack) == 0)
            return played[i].ways;
    fail_msg("no ways are named for '%s'", pack);
    return 0;
}

/* In its own ways, as the table has them, the first by OpenCL's default or, without that, by the device host. */
static void assert_pack_alike(const char *pack, const char *what) {
    variant all[COUNT(of_no_compiler) + WAYS_OF_OPENCL];
    size_t count = COUNT(of_no_compiler);
    const unsigned ways = ways_of(pack);
    memcpy(all, of_no_compiler, sizeof of_no_compiler);
    for (int i = 0; i < WAYS_OF_OPENCL; i++)
        if (ways >> i & 1)
            all[count++] = of_opencl[i];
    play_first(test_pack(pack), what, ways & BY_DEFAULT ? "" : "--device host");
    assert_alike(test_pack(pack), what, all, count);
}

/* Lines or two of a kernel that is played in all ways without them; caustics are photons, in a program that takes long to make.
 */
static const uint64_t in_few_ways = VIT_BIT(RAW_BUCKETS) | VIT_BIT(FLATTENED) | VIT_BIT(NEAREST) | VIT_BIT(TRILINEAR) |
                                    VIT_BIT(SPARSE_16) | VIT_BIT(SMALL_SAMPLES) | VIT_BIT(AREA) | VIT_BIT(CAUSTICS);

static void every_effect_meets_every_way(void **state) {
    uint64_t met[WAYS_OF_OPENCL] = {0}, all = 0, any = 0;
    (void)state;
    for (size_t i = 0; i < COUNT(played); i++) {
        vit_requirements need;
        vit_text why = {""};
        size_t size;
        void *bytes = read_file(test_pack(played[i].pack), &size);
        if (vit_require(&(vit_open_info){.pack = bytes, .pack_size = size}, &need, &why) != VIT_OK)
            fail_msg("%s: %s", played[i].pack, why.text);
        free(bytes);
        all |= need.effects;
        any |= played[i].ways ? need.effects : 0;
        for (int k = 0; k < WAYS_OF_OPENCL; k++)
            met[k] |= played[i].ways >> k & 1 ? need.effects : 0;
    }
    assert_int_equal(any, all);
    for (int k = 0; k < WAYS_OF_OPENCL; k++)
        if (all & ~in_few_ways & ~met[k])
            fail_msg("no pack with the effects %llx is played with '%s %s'", (unsigned long long)(all & ~in_few_ways & ~met[k]),
                     of_opencl[k].environment, of_opencl[k].options);
}

/* The device host: each number of threads, lanes, set of instructions that this machine has. */
static const variant on_host[] = {
    {"", "--device host"},
    {"", "--device host --threads 1 --lanes 1"},
    {"", "--device host --threads 2 --lanes 8"},
    {"", "--device host --threads 3 --lanes 16"},
    {"", "--device host --threads 2 --lanes 1 --host-isa baseline"},
    {"", "--device host --threads 1 --lanes 8 --host-isa baseline"},
    {"", "--device host --threads 2 --lanes 16 --host-isa baseline"},
};

static void the_device_host_gives_the_bits_of_opencl(void **state) {
    (void)state;
    assert_all_alike(test_pack("list"), "--verify --hash", on_host, COUNT(on_host));
    assert_all_alike(test_pack("room"), "--trace", on_host, COUNT(on_host));
    assert_all_alike(test_pack("zones-sparse-buckets"), "--trace", on_host, COUNT(on_host));
    assert_all_alike(test_pack("basis-33x47"), "--trace", on_host, COUNT(on_host));
    assert_all_alike(test_pack("basis-shine"), "--trace", on_host, COUNT(on_host));
    assert_all_alike(test_pack("live"), "--trace", on_host, COUNT(on_host));
}

static void make_caches(void) {
    test_packs_begin();
    folder_make(TEST_PACKS "/pocl-loops");
    folder_make(TEST_PACKS "/pocl-loopvec");
}

static void a_frame_hashes_the_same_however_it_is_played(void **state) {
    (void)state;
    make_caches();
    assert_pack_alike("list", "--verify --hash");
    assert_all_alike(test_pack("list"), "--verify --hash", rare, COUNT(rare));
}

/* The table that frames fill has the same contents after each: traces hash what rays were counted for it. */
static void a_cache_that_fills_has_the_same_contents(void **state) {
    (void)state;
    assert_pack_alike("progressive", "--trace");
}

#define ALIKE(name, pack)                                                                                                      \
    static void name(void **state) {                                                                                           \
        (void)state;                                                                                                           \
        assert_pack_alike(pack, "--verify --hash");                                                                            \
    }
ALIKE(buckets_hash_the_same, "buckets")
ALIKE(raw_buckets_hash_the_same, "raw")
ALIKE(flattened_photons_hash_the_same, "flattened")
ALIKE(keys_with_normals_and_small_tiles_hash_the_same, "normal-keys")
ALIKE(interpolated_light_hashes_the_same, "sparse")
ALIKE(interpolated_buckets_hash_the_same, "sparse-buckets")
ALIKE(one_sample_in_16_and_small_tiles_hash_the_same, "sparse-16")
ALIKE(nearest_texels_hash_the_same, "nearest")
ALIKE(trilinear_textures_hash_the_same, "trilinear")
ALIKE(small_samples_hash_the_same, "small")
ALIKE(small_samples_with_interpolated_light_hash_the_same, "small-sparse")
ALIKE(zones_areas_and_sequence_hash_the_same, "zones")
ALIKE(zones_in_buckets_hash_the_same, "zones-buckets")
ALIKE(zones_at_few_samples_hash_the_same, "zones-sparse")
ALIKE(zones_in_buckets_at_few_samples_hash_the_same, "zones-sparse-buckets")
ALIKE(areas_alone_hash_the_same, "areas-alone")
ALIKE(baked_irradiance_of_a_light_that_moves_hashes_the_same, "basis")
ALIKE(baked_irradiance_of_still_light_hashes_the_same, "basis-still")
ALIKE(baked_irradiance_in_small_tiles_hashes_the_same, "basis-16")
ALIKE(baked_irradiance_on_parted_cells_and_small_samples_hashes_the_same, "basis-33x47")
ALIKE(baked_irradiance_at_points_hashes_the_same, "points")
ALIKE(baked_irradiance_at_points_with_mirrors_glass_and_copies_hashes_the_same, "points-shine")
ALIKE(live_radiosity_hashes_the_same, "live")
ALIKE(live_radiosity_of_one_reflection_hashes_the_same, "live-once")
ALIKE(live_radiosity_by_bc1_hashes_the_same, "live-33x47")
ALIKE(live_radiosity_with_mirrors_glass_sky_area_light_and_copies_hashes_the_same, "live-shine")
ALIKE(baked_irradiance_with_mirrors_glass_both_lobes_sky_area_light_and_copies_hashes_the_same, "basis-shine")
ALIKE(frames_without_photons_hash_the_same, "dark")
ALIKE(baked_and_traced_photons_textures_holes_and_emission_hash_the_same, "room")
ALIKE(a_mesh_without_a_scene_file_hashes_the_same, "mesh")
ALIKE(a_large_scene_hashes_the_same, "atrium")
ALIKE(mirrors_glass_gloss_soft_light_and_several_samples_a_pixel_hash_the_same, "shine")

static void a_frame_hashes_the_same_in_any_order(void **state) {
    (void)state;
    const char *pack = test_pack("list");
    play_plain(pack, "--verify --hash");
    static char twice[TOOL_TEXT];
    const char *second = strchr(expected, '\n') + 1, *third = strchr(second, '\n') + 1;
    (void)snprintf(twice, sizeof twice, "%s%s", second, second);
    begin(&runs[0], "", pack, "--verify --hash --frames 2", "");
    begin(&runs[1], "", pack, "--verify --hash --frames 1:3 --loop 2", ""); /* 1 2 1 2: each after the other */
    tool_end(&runs[0]);
    tool_end(&runs[1]);
    assert_string_equal(runs[0].out, third);
    assert_string_equal(runs[1].out, twice);
}

static void frames_of_a_path_differ_from_each_other(void **state) {
    (void)state; /* or hashes could be equal because nothing was drawn */
    play_plain(test_pack("list"), "--hash");
    const char *second = strchr(expected, '\n') + 1, *third = strchr(second, '\n') + 1;
    assert_int_not_equal(strncmp(expected + 7, second + 7, 16), 0);
    assert_int_not_equal(strncmp(second + 7, third + 7, 16), 0);
}

static void every_buffer_is_the_same_after_every_pass(void **state) {
    (void)state;
    static const char *const packs[] = {"list",        "buckets",        "normal-keys", "room",          "small-sparse",
                                        "sparse-room", "sparse-buckets", "zones",       "zones-buckets", "mesh",
                                        "shine",       "basis",          "points",      "live"};
    for (size_t i = 0; i < COUNT(packs); i++)
        assert_pack_alike(packs[i], "--trace");
}

/* Every format and size at every width by the device host. In OpenCL's ways the size of which neither edge is whole tiles, a
 * way each of the others, and the formats, which are one kernel's, without photons, whose programs are quick to make. */
static const char *const other_formats[] = {"--hash --format rgb565", "--hash --format rgba32f"};
static const variant of_host[] = {
    {"", "--device host --lanes 1"}, {"", "--device host --lanes 8"}, {"", "--device host --lanes 16"}};

static void every_format_and_odd_size_is_the_same_at_every_width(void **state) {
    (void)state;
    static const char *const packs[] = {"list", "1x1", "17x1", "33x47", "sparse-17x1"};
    for (size_t i = 0; i < COUNT(packs); i++) {
        assert_all_alike(test_pack(packs[i]), "--verify --hash", of_host, COUNT(of_host));
        for (size_t f = 0; f < COUNT(other_formats); f++) {
            char what[64];
            (void)snprintf(what, sizeof what, "--verify %s --device host", other_formats[f]);
            assert_all_alike(test_pack(packs[i]), what, of_host, COUNT(of_host));
        }
    }
    assert_all_alike(test_pack("33x47"), "--verify --hash", of_opencl, WAYS_OF_OPENCL);
    assert_all_alike(test_pack("1x1"), "--verify --hash", of_opencl, 1);
    assert_all_alike(test_pack("17x1"), "--verify --hash", of_opencl + 1, 1);
    for (size_t f = 0; f < COUNT(other_formats); f++)
        assert_all_alike(test_pack("dark"), other_formats[f], of_opencl, WAYS_OF_OPENCL);
}

/* Those that show nothing of photons by OpenCL without photons, too. */
static void every_view_is_the_same_at_every_width(void **state) {
    (void)state;
    static const struct {
        const char *name;
        bool of_photons;
    } views[] = {
#define X(name, light, meaning)                                                                                                \
    {#name, (light)&VIT_SHOWS_INDIRECT || VIT_VIEW_##name == VIT_VIEW_clusters || VIT_VIEW_##name == VIT_VIEW_heat},
        VIT_VIEWS(X)
#undef X
    };
    for (size_t i = 0; i < COUNT(views); i++) {
        char what[64];
        (void)snprintf(what, sizeof what, "--hash --view %s%s", views[i].name, views[i].of_photons ? "" : " --device host");
        assert_all_alike(test_pack("33x47"), what, of_host, COUNT(of_host));
        (void)snprintf(what, sizeof what, "--hash --view %s", views[i].name);
        if (!views[i].of_photons)
            assert_all_alike(test_pack("dark"), what, of_host, COUNT(of_host));
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_effect_meets_every_way),
        cmocka_unit_test(a_frame_hashes_the_same_however_it_is_played),
        cmocka_unit_test(the_device_host_gives_the_bits_of_opencl),
        cmocka_unit_test(a_cache_that_fills_has_the_same_contents),
        cmocka_unit_test(buckets_hash_the_same),
        cmocka_unit_test(raw_buckets_hash_the_same),
        cmocka_unit_test(flattened_photons_hash_the_same),
        cmocka_unit_test(keys_with_normals_and_small_tiles_hash_the_same),
        cmocka_unit_test(interpolated_light_hashes_the_same),
        cmocka_unit_test(interpolated_buckets_hash_the_same),
        cmocka_unit_test(one_sample_in_16_and_small_tiles_hash_the_same),
        cmocka_unit_test(nearest_texels_hash_the_same),
        cmocka_unit_test(trilinear_textures_hash_the_same),
        cmocka_unit_test(small_samples_hash_the_same),
        cmocka_unit_test(small_samples_with_interpolated_light_hash_the_same),
        cmocka_unit_test(zones_areas_and_sequence_hash_the_same),
        cmocka_unit_test(zones_in_buckets_hash_the_same),
        cmocka_unit_test(zones_at_few_samples_hash_the_same),
        cmocka_unit_test(zones_in_buckets_at_few_samples_hash_the_same),
        cmocka_unit_test(areas_alone_hash_the_same),
        cmocka_unit_test(baked_irradiance_of_a_light_that_moves_hashes_the_same),
        cmocka_unit_test(baked_irradiance_of_still_light_hashes_the_same),
        cmocka_unit_test(baked_irradiance_in_small_tiles_hashes_the_same),
        cmocka_unit_test(baked_irradiance_on_parted_cells_and_small_samples_hashes_the_same),
        cmocka_unit_test(baked_irradiance_with_mirrors_glass_both_lobes_sky_area_light_and_copies_hashes_the_same),
        cmocka_unit_test(baked_irradiance_at_points_hashes_the_same),
        cmocka_unit_test(baked_irradiance_at_points_with_mirrors_glass_and_copies_hashes_the_same),
        cmocka_unit_test(live_radiosity_hashes_the_same),
        cmocka_unit_test(live_radiosity_of_one_reflection_hashes_the_same),
        cmocka_unit_test(live_radiosity_by_bc1_hashes_the_same),
        cmocka_unit_test(live_radiosity_with_mirrors_glass_sky_area_light_and_copies_hashes_the_same),
        cmocka_unit_test(frames_without_photons_hash_the_same),
        cmocka_unit_test(baked_and_traced_photons_textures_holes_and_emission_hash_the_same),
        cmocka_unit_test(a_mesh_without_a_scene_file_hashes_the_same),
        cmocka_unit_test(a_large_scene_hashes_the_same),
        cmocka_unit_test(mirrors_glass_gloss_soft_light_and_several_samples_a_pixel_hash_the_same),
        cmocka_unit_test(a_frame_hashes_the_same_in_any_order),
        cmocka_unit_test(frames_of_a_path_differ_from_each_other),
        cmocka_unit_test(every_buffer_is_the_same_after_every_pass),
        cmocka_unit_test(every_format_and_odd_size_is_the_same_at_every_width),
        cmocka_unit_test(every_view_is_the_same_at_every_width),
    };
    return cmocka_run_group_tests_name("same bits", tests, NULL, NULL);
}
