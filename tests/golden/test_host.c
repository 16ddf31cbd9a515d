/* The device `host`: there without OpenCL, chosen by name, and undisturbed by what a program around it does.
 *
 * That its bits are those of OpenCL, pass by pass, is in test_same_bits.c. Here golden hashes, made by an OpenCL device, stand
 * for them; "no OpenCL" is an ICD loader that finds no driver. Without one of its own effects, threads or floating-point
 * environment a vit would take its neighbour's: two are played in turns, and one under a rounding mode that is not its own. */
#include "open_pack.h"
#include <fenv.h>

#define NO_OPENCL "OCL_ICD_VENDORS=/nonexistent/ "

static tool_run r;

static void host_is_listed_with_and_without_opencl(void **state) {
    (void)state;
    tool(&r, TOOL_PLAY " --list-devices");
    tool_succeeds(&r);
    assert_non_null(strstr(r.out, "\nhost Vitrine / "));
    tool(&r, NO_OPENCL TOOL_PLAY " --list-devices");
    tool_succeeds(&r);
    assert_int_equal(strncmp(r.out, "host Vitrine / ", 15), 0);
    assert_null(strstr(strchr(r.out, '\n') + 1, "\n"));
}

static void without_opencl_the_player_takes_host_and_says_so(void **state) {
    (void)state;
    tool(&r, NO_OPENCL TOOL_PLAY " %s --verify", test_pack("33x47"));
    tool_succeeds(&r);
    assert_non_null(strstr(r.err, "built-in device host"));
    tool(&r, NO_OPENCL TOOL_PLAY " %s --verify --quiet", test_pack("33x47"));
    tool_succeeds(&r);
    assert_string_equal(r.err, "");
    tool(&r, NO_OPENCL TOOL_PLAY " %s --quiet --device 0", test_pack("33x47"));
    tool_refuses(&r, "vitrine-play", VIT_FAILED, "no OpenCL platform");
}

static void a_device_or_instruction_set_that_there_is_not_is_refused(void **state) {
    (void)state;
    tool(&r, TOOL_PLAY " %s --device hots", test_pack("33x47"));
    tool_refuses(&r, "vitrine-play", VIT_FAILED, "there is no device 'hots'");
    tool(&r, TOOL_PLAY " %s --device host --host-isa z80", test_pack("33x47"));
    tool_refuses(&r, "vitrine-play", VIT_USAGE, "baseline");
    tool(&r, TOOL_PLAY " %s --device 4294967296", test_pack("33x47"));
    tool_refuses(&r, "vitrine-play", VIT_FAILED, "there is no device '4294967296'");
    tool(&r, TOOL_PLAY " %s --device host --threads 0", test_pack("33x47"));
    tool_refuses(&r, "vitrine-play", VIT_USAGE, "--threads");
    tool(&r, TOOL_PLAY " %s --device host --wide-divide", test_pack("33x47"));
    tool_refuses(&r, "vitrine-play", VIT_USAGE, "wide_divide");
}

/* Nothing that was asked for is left out in silence. */
static void options_of_host_want_host_to_play(void **state) {
    (void)state;
    static const char *const options[] = {"--threads", "--threads 2", "--host-isa", "--host-isa avx9"};
    for (size_t i = 0; i < 4; i += 2) {
        tool(&r, TOOL_PLAY " %s %s", test_pack("33x47"), options[i + 1]);
        tool_refuses(&r, "vitrine-play", VIT_USAGE, options[i]);
        assert_non_null(strstr(r.err, "is for --device host, not for the default, "));
    }
    tool(&r, NO_OPENCL TOOL_PLAY " %s --verify --threads 2 --host-isa baseline", test_pack("33x47"));
    tool_succeeds(&r);
    tool(&r, NO_OPENCL TOOL_PLAY " %s --quiet --host-isa avx9", test_pack("33x47"));
    tool_refuses(&r, "vitrine-play", VIT_USAGE, "baseline");
}

static void the_baker_makes_the_same_bytes_with_opencl_and_without(void **state) {
    static const char *const ways[][2] = {{"", "--device 0"}, {NO_OPENCL, ""}};
    (void)state;
    const size_t i = test_packs_find("room");
    size_t size[2];
    void *host = read_file(test_pack("room"), &size[0]);
    for (size_t k = 0; k < sizeof ways / sizeof ways[0]; k++) {
        tool(&r, "%s" TOOL_BAKE " %s -o " TEST_PACKS "/host.vit --quiet --no-check --threads 3 %s %s", ways[k][0],
             test_packs[i].input, ways[k][1], test_packs[i].options);
        tool_succeeds(&r);
        void *other = read_file(TEST_PACKS "/host.vit", &size[1]);
        assert_int_equal(size[0], size[1]);
        assert_memory_equal(host, other, size[0]);
        free(other);
    }
    free(host);
    tool(&r, TOOL_BAKE " %s --quiet --device hots -o " TEST_PACKS "/host.vit", test_packs[i].input);
    tool_refuses(&r, "vitrine-bake", VIT_FAILED, "there is no device 'hots'");
}

/* PoCL keeps what it compiles: an empty folder tells that nothing was. */
static void what_is_not_timed_has_no_kernel_compiled(void **state) {
    static const char *const lines[] = {
        TOOL_BAKE " " TEST_PACKS "/room.cfg -o " TEST_PACKS "/host.vit --quiet --all-formats --explain",
        TOOL_BAKE " " TEST_PACKS "/room.cfg -o " TEST_PACKS "/host.vit --quiet --zones 1 --effective-area 1",
        TOOL_COST " " TEST_PACKS "/room.cfg --quiet --size 48x32 --fit-work 1e15 --settings 6 --no-cache --max-samples 16"};
    (void)state;
    test_packs_begin();
    for (size_t i = 0; i < sizeof lines / sizeof lines[0]; i++) {
        char cache[TEST_FOLDER];
        folder_make_temporary(cache);
        tool(&r, "POCL_CACHE_DIR=%s %s", cache, lines[i]);
        tool_succeeds(&r);
        assert_int_equal(rmdir(cache), 0); /* fails if there is anything in it */
    }
}

static vit_open_info on_host(vit_open_info how) {
    how.device = VIT_DEVICE_HOST;
    how.threads = 2;
    return how;
}

static void assert_golden(open_pack *p, uint32_t index) {
    assert_true(vit_golden(p->v, index) != 0);
    assert_true(pack_frame_hash(p, index) == vit_golden(p->v, index));
}

static void two_packs_of_other_effects_are_played_in_turns(void **state) {
    (void)state;
    open_pack a, b;
    pack_open(&a, "list", on_host((vit_open_info){.lanes = 8}));
    pack_open(&b, "room-buckets", on_host((vit_open_info){.lanes = 8}));
    for (uint32_t i = 0; i < 2; i++) {
        assert_golden(&a, i);
        assert_golden(&b, i);
    }
    pack_close(&a);
    pack_close(&b);
}

static void the_callers_rounding_mode_counts_for_nothing_and_stays(void **state) {
    (void)state;
    open_pack p;
    pack_open(&p, "33x47", on_host((vit_open_info){0}));
    assert_int_equal(fesetround(FE_UPWARD), 0);
    pack_frame(&p, 1);
    const int after = fegetround();
    assert_int_equal(fesetround(FE_TONEAREST), 0);
    assert_int_equal(after, FE_UPWARD);
    assert_true(vit_hash(p.frame, p.need.frame_bytes) == vit_golden(p.v, 1));
    pack_close(&p);
}

static void frames_go_where_the_caller_wants_them(void **state) {
    (void)state;
    static _Alignas(64) uint8_t own[64 * 64 * 4], wide[64 * 256];
    open_pack p, plain;
    pack_open(&plain, "33x47", on_host((vit_open_info){0}));
    pack_open(&p, "33x47", on_host((vit_open_info){.framebuffer = own}));
    assert_true(p.need.host_bytes < plain.need.host_bytes);
    assert_vit_ok(&p, vit_frame(p.v, 0, own, p.stride, &p.why));
    assert_true(vit_hash(own, p.need.frame_bytes) == vit_golden(p.v, 0));
    assert_vit_ok(&p, vit_frame(p.v, 0, wide, 256, &p.why));
    for (uint32_t y = 0; y < p.need.height; y++) {
        assert_memory_equal(wide + y * 256, own + y * p.stride, p.stride);
        assert_int_equal(wide[y * 256 + p.stride], 0);
    }
    pack_close(&p);
    pack_close(&plain);
}

static void an_arena_without_room_for_the_buffers_is_refused(void **state) {
    (void)state;
    open_pack p;
    vit *v = NULL;
    pack_open(&p, "33x47", on_host((vit_open_info){0}));
    assert_true(p.need.host_bytes > p.need.frame_bytes);
    p.info.arena_size = p.need.host_bytes - 1;
    vit_close(p.v);
    p.v = NULL;
    assert_int_equal(vit_open(&p.info, &v, &p.why), VIT_USAGE);
    assert_null(v);
    pack_close(&p);
}

/* Counts of frame 0. */
static vit_statistics counted(const char *pack, vit_open_info how) {
    open_pack p;
    how.count_work = 1;
    pack_open(&p, pack, how);
    assert_golden(&p, 0);
    const vit_statistics s = pack_stats(&p);
    pack_close(&p);
    return s;
}

static void work_counts_are_those_of_opencl(void **state) {
    (void)state;
    static const char *const packs[] = {"room-buckets", "zones-sparse"};
    for (size_t i = 0; i < sizeof packs / sizeof packs[0]; i++) {
        const vit_statistics cl = counted(packs[i], (vit_open_info){.lanes = 8}),
                             host = counted(packs[i], on_host((vit_open_info){.lanes = 8}));
        uint64_t all = 0;
        assert_int_equal(cl.pass_count, host.pass_count);
        for (uint32_t p = 0; p < cl.pass_count; p++)
            for (uint32_t k = 0; k < cl.work_count; k++) {
                if (cl.pass_work[p][k] != host.pass_work[p][k])
                    fail_msg("%s: %s of %s", packs[i], cl.work_names[k], cl.pass_names[p]);
                all += cl.pass_work[p][k];
            }
        assert_true(all > 0);
        assert_true(host.pass_work[0][0] > 0); /* view rays of the first pass */
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(host_is_listed_with_and_without_opencl),
        cmocka_unit_test(without_opencl_the_player_takes_host_and_says_so),
        cmocka_unit_test(a_device_or_instruction_set_that_there_is_not_is_refused),
        cmocka_unit_test(options_of_host_want_host_to_play),
        cmocka_unit_test(the_baker_makes_the_same_bytes_with_opencl_and_without),
        cmocka_unit_test(what_is_not_timed_has_no_kernel_compiled),
        cmocka_unit_test(two_packs_of_other_effects_are_played_in_turns),
        cmocka_unit_test(the_callers_rounding_mode_counts_for_nothing_and_stays),
        cmocka_unit_test(frames_go_where_the_caller_wants_them),
        cmocka_unit_test(an_arena_without_room_for_the_buffers_is_refused),
        cmocka_unit_test(work_counts_are_those_of_opencl),
    };
    return cmocka_run_group_tests_name("host", tests, NULL, NULL);
}
