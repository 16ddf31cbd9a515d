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

enum { AT_ONCE = 2 };          /* most of a run's time is PoCL's compiler, which has one thread */
static tool_run runs[AT_ONCE]; /* too large for a stack */

/* Lines that the variants are held to. */
static char expected[TOOL_TEXT];

static void begin(tool_run *r, const char *environment, const char *pack, const char *what, const char *options) {
    tool_line(r, "%s " TOOL_PLAY " %s --quiet %s %s", environment, pack, what, options);
    tool_begin(r);
}

/* Plays and keeps the lines as those that others are held to. */
static void play_plain(const char *pack, const char *what) {
    begin(&runs[0], "", pack, what, "");
    tool_end(&runs[0]);
    tool_succeeds(&runs[0]);
    memcpy(expected, runs[0].out, sizeof expected);
    assert_true(expected[0] != '\0');
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
    fail_msg("%s\nis different from the plain run; the first line that differs:\n%.99s\nbut the plain run's\n%.99s", r->line,
             r->out + at, expected + at);
}

/* Every environment and set of options gives the lines of the first; `what` goes with all. */
typedef struct variant {
    const char *environment, *options;
} variant;

static void assert_all_alike(const char *pack, const char *what, const variant *variants, size_t count) {
    play_plain(pack, what);
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

#define COUNT(a) (sizeof(a) / sizeof(a)[0])
/* PoCL's ways of making work-groups (auto is the plain run's), each with a cache of its own: what was compiled another way must
 * not be taken. */
#define METHOD(m) "POCL_WORK_GROUP_METHOD=" m " POCL_CACHE_DIR=" TEST_PACKS "/pocl-" m

static const variant one_at_a_time[] = {
    {"", ""},
    {"POCL_MAX_PTHREAD_COUNT=1", ""},
    {"POCL_MAX_PTHREAD_COUNT=2", ""},
    {"", "--lanes 1"},
    {"", "--lanes 8"},
    {"", "--lanes 16"},
    {"", "--group 1"},
    {"", "--group 32"},
    {"", "--group 256"},
    {"POCL_DEVICES=basic", ""},
    {"POCL_DEVICES=pthread", ""},
    {METHOD("loops"), ""},
    {METHOD("loopvec"), ""},
    {"", "--device 0 --wide-divide"},
    {"", "--device 0 --wide-divide --lanes 1"},
};

/* The same settings, several at once: fewer runs that still hold each kind of lanes, groups, threads and devices. */
static const variant together[] = {
    {"POCL_MAX_PTHREAD_COUNT=1", ""},
    {"POCL_MAX_PTHREAD_COUNT=2", "--lanes 1 --group 256"},
    {"POCL_DEVICES=pthread", "--lanes 8 --group 1"},
    {"POCL_DEVICES=basic", "--lanes 16 --group 32"},
    {"", "--device host --threads 3"},
    {"", "--device host --threads 1 --lanes 1"},
    {"", "--device host --threads 2 --lanes 8 --host-isa baseline"},
};

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

/* For what differs little from a pack that is played in all ways. */
static const variant few[] = {
    {"POCL_MAX_PTHREAD_COUNT=1", ""},
    {"POCL_DEVICES=basic", "--lanes 1 --group 256"},
    {"", "--device host --threads 1"},
    {"", "--device host --threads 3 --lanes 1"},
};

/* The same without another program for PoCL to compile, which takes seconds: for packs whose kernels others are played by at
 * another width, all but a texture's filter or a like detail. */
static const variant fewest[] = {
    {"POCL_MAX_PTHREAD_COUNT=1", ""},
    {"", "--device host --threads 1"},
    {"", "--device host --threads 3 --lanes 1"},
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
    assert_all_alike(test_pack("list"), "--verify --hash", one_at_a_time, COUNT(one_at_a_time));
}

#define ALIKE(name, pack, ways)                                                                                                \
    static void name(void **state) {                                                                                           \
        (void)state;                                                                                                           \
        assert_all_alike(test_pack(pack), "--verify --hash", ways, COUNT(ways));                                               \
    }
ALIKE(buckets_hash_the_same, "buckets", few)
ALIKE(raw_buckets_hash_the_same, "raw", fewest)
ALIKE(flattened_photons_hash_the_same, "flattened", fewest)
ALIKE(keys_with_normals_and_small_tiles_hash_the_same, "normal-keys", few)
ALIKE(interpolated_light_hashes_the_same, "sparse", few)
ALIKE(interpolated_buckets_hash_the_same, "sparse-buckets", together)
ALIKE(one_sample_in_16_and_small_tiles_hash_the_same, "sparse-16", fewest)
ALIKE(nearest_texels_hash_the_same, "nearest", fewest)
ALIKE(trilinear_textures_hash_the_same, "trilinear", fewest)
ALIKE(small_samples_hash_the_same, "small", fewest)
ALIKE(small_samples_with_interpolated_light_hash_the_same, "small-sparse", few)
ALIKE(zones_areas_and_sequence_hash_the_same, "zones", few)
ALIKE(zones_in_buckets_hash_the_same, "zones-buckets", together)
ALIKE(zones_at_few_samples_hash_the_same, "zones-sparse", fewest)
ALIKE(zones_in_buckets_at_few_samples_hash_the_same, "zones-sparse-buckets", few)
ALIKE(areas_alone_hash_the_same, "areas-alone", fewest)
ALIKE(baked_irradiance_of_a_light_that_moves_hashes_the_same, "basis", together)
ALIKE(baked_irradiance_of_still_light_hashes_the_same, "basis-still", fewest)
ALIKE(baked_irradiance_in_small_tiles_hashes_the_same, "basis-16", fewest)
ALIKE(baked_irradiance_on_parted_cells_and_small_samples_hashes_the_same, "basis-33x47", few)
ALIKE(live_radiosity_hashes_the_same, "live", together)
ALIKE(live_radiosity_of_one_reflection_hashes_the_same, "live-once", fewest)
ALIKE(live_radiosity_by_bc1_hashes_the_same, "live-33x47", few)
ALIKE(live_radiosity_with_mirrors_glass_sky_area_light_and_copies_hashes_the_same, "live-shine", together)
ALIKE(baked_irradiance_with_mirrors_glass_sky_area_light_and_copies_hashes_the_same, "basis-shine", together)
ALIKE(frames_without_photons_hash_the_same, "dark", fewest)
ALIKE(baked_and_traced_photons_textures_holes_and_emission_hash_the_same, "room", together)
ALIKE(a_mesh_without_a_scene_file_hashes_the_same, "mesh", few)
ALIKE(a_large_scene_hashes_the_same, "atrium", fewest)
ALIKE(mirrors_glass_gloss_soft_light_and_several_samples_a_pixel_hash_the_same, "shine", few)

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
    assert_all_alike(test_pack("list"), "--trace", few, COUNT(few));
    assert_all_alike(test_pack("buckets"), "--trace", few, COUNT(few));
    assert_all_alike(test_pack("normal-keys"), "--trace", few, COUNT(few));
    assert_all_alike(test_pack("room"), "--trace", few, COUNT(few));
    assert_all_alike(test_pack("small-sparse"), "--trace", few, COUNT(few));
    assert_all_alike(test_pack("sparse-room"), "--trace", few, COUNT(few));
    assert_all_alike(test_pack("sparse-buckets"), "--trace", few, COUNT(few));
    assert_all_alike(test_pack("zones"), "--trace", few, COUNT(few));
    assert_all_alike(test_pack("zones-buckets"), "--trace", few, COUNT(few));
    assert_all_alike(test_pack("mesh"), "--trace", few, COUNT(few));
    assert_all_alike(test_pack("shine"), "--trace", few, COUNT(few));
    assert_all_alike(test_pack("basis"), "--trace", few, COUNT(few));
    assert_all_alike(test_pack("live"), "--trace", few, COUNT(few));
}

/* Every format at every width by the device host; OpenCL's compiler makes each pair anew, so that there each width has one
 * format of the three beside the plain run's, for the packs whose effects others have been compiled for. */
static void every_format_and_odd_size_is_the_same_at_every_width(void **state) {
    (void)state;
    static const char *const packs[] = {"list", "1x1", "17x1", "33x47", "sparse-17x1"};
    static const struct {
        const char *what;
        variant opencl; /* a width of OpenCL's */
    } formats[] = {{"--verify --hash", {"", "--lanes 1"}},
                   {"--verify --hash --format rgb565", {"", "--lanes 8"}},
                   {"--verify --hash --format rgba32f", {"", "--lanes 16"}}};
    for (size_t i = 0; i < COUNT(packs); i++)
        for (size_t f = 0; f < COUNT(formats); f++) {
            const variant ways[] = {{"", "--device host --lanes 1"},
                                    {"", "--device host --lanes 8"},
                                    {"", "--device host --lanes 16"},
                                    formats[f].opencl};
            assert_all_alike(test_pack(packs[i]), formats[f].what, ways, COUNT(ways));
        }
}

static void every_view_is_the_same_at_every_width(void **state) {
    (void)state;
    static const char *const views[] = {
#define X(name, light, meaning) #name,
        VIT_VIEWS(X)
#undef X
    };
    static const variant lanes[] = {{"POCL_MAX_PTHREAD_COUNT=1", ""},
                                    {"", "--device host --lanes 1"},
                                    {"", "--device host --lanes 8"},
                                    {"", "--device host --lanes 16"}};
    for (size_t i = 0; i < COUNT(views); i++) {
        char what[64];
        (void)snprintf(what, sizeof what, "--hash --view %s", views[i]);
        assert_all_alike(test_pack("33x47"), what, lanes, COUNT(lanes));
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_frame_hashes_the_same_however_it_is_played),
        cmocka_unit_test(the_device_host_gives_the_bits_of_opencl),
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
        cmocka_unit_test(baked_irradiance_with_mirrors_glass_sky_area_light_and_copies_hashes_the_same),
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
