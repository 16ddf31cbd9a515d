/* The fault log: none in an exact bake, one a frame for each bound that was too small, the latest when there are too many, and
 * a device that fails; read back without disturbing the frames. */
#include "open_pack.h"
#include "vit.h"

static uint32_t faults_of(open_pack *p, vit_fault *out, int *lost) {
    uint32_t count;
    assert_vit_ok(p, vit_faults(p->v, out, &count, lost, &p->why));
    return count;
}

static void an_exact_bake_has_no_fault(void **state) {
    (void)state;
    open_pack p;
    vit_fault f[VIT_MAX_FAULTS];
    int lost;
    pack_open(&p, "whole-tiles", (vit_open_info){.device = VIT_DEVICE_HOST});
    for (uint32_t i = 0; i < p.need.frames; i++)
        pack_frame(&p, i);
    assert_int_equal(faults_of(&p, f, &lost), 0);
    assert_int_equal(lost, 0);
    pack_close(&p);
}

static void what_a_bound_drops_is_noted_with_frame_pass_and_count(void **state) {
    (void)state;
    open_pack p;
    vit_fault f[VIT_MAX_FAULTS];
    int lost;
    uint64_t entries = 0, samples = 0;
    pack_open(&p, "whole-tiles", (vit_open_info){.device = VIT_DEVICE_HOST, .max_list = 100, .max_nodes = 40});
    for (uint32_t i = 1; i < 3; i++)
        pack_frame(&p, i);
    const vit_statistics s = pack_stats(&p);
    assert_int_equal(faults_of(&p, f, &lost), 4);
    assert_int_equal(lost, 0);
    for (uint32_t i = 0; i < 4; i++) {
        const int list = strcmp(f[i].code, "entries_dropped") == 0;
        assert_string_equal(f[i].code, list ? "entries_dropped" : "samples_dropped");
        assert_string_equal(f[i].pass, list ? "splat_place" : "cluster_bounds");
        assert_string_equal(f[i].level, "warning");
        assert_int_equal(f[i].frame, 1 + i / 2);
        *(list ? &entries : &samples) += f[i].count;
    }
    assert_int_equal(entries, s.dropped_entries);
    assert_int_equal(samples, s.dropped_samples);
    assert_true(entries > 0 && samples > 0);
    pack_close(&p);
}

static void of_too_many_the_latest_are_kept(void **state) {
    (void)state;
    open_pack p;
    vit_fault f[VIT_MAX_FAULTS];
    int lost;
    pack_open(&p, "whole-tiles", (vit_open_info){.device = VIT_DEVICE_HOST, .max_list = 100});
    for (uint32_t i = 0; i < VIT_FAULT_RING + 3; i++)
        pack_frame(&p, i % p.need.frames);
    assert_int_equal(faults_of(&p, f, &lost), VIT_FAULT_RING);
    assert_int_equal(lost, 1);
    for (uint32_t i = 0; i < VIT_FAULT_RING; i++)
        assert_int_equal(f[i].frame, (i + 3) % p.need.frames);
    pack_close(&p);
}

/* A device whose passes fail from the second one on: the rest is the real one's. */
static vit_device broken;

static vit_status run_first_pass(void *device, const vit_step *step, vit_text *why) {
    if (strcmp(vit_passes[step->pass].name, "visibility") == 0)
        return vit_device_host.run(device, step, why);
    (void)snprintf(why->text, sizeof why->text, "lost");
    return VIT_FAILED;
}

static void a_device_that_fails_is_noted_with_its_pass(void **state) {
    (void)state;
    open_pack p;
    vit_fault f[VIT_MAX_FAULTS];
    int lost;
    pack_open(&p, "whole-tiles", (vit_open_info){.device = VIT_DEVICE_HOST});
    broken = vit_device_host;
    broken.run = run_first_pass;
    p.v->device = &broken;
    for (uint32_t i = 0; i < VIT_HOST_FAULTS + 1; i++)
        assert_int_equal(vit_frame(p.v, i % p.need.frames, p.frame, p.stride, &p.why), VIT_FAILED);
    assert_int_equal(faults_of(&p, f, &lost), VIT_HOST_FAULTS);
    assert_int_equal(lost, 1);
    for (uint32_t i = 0; i < VIT_HOST_FAULTS; i++) {
        assert_string_equal(f[i].level, "error");
        assert_string_equal(f[i].code, "device_failed");
        assert_string_equal(f[i].pass, "samples");
        assert_int_equal(f[i].frame, (i + 1) % p.need.frames);
        assert_int_equal(f[i].count, 1);
    }
    p.v->device = &vit_device_host;
    pack_close(&p);
}

static void the_player_prints_them_at_exit(void **state) {
    (void)state;
    static tool_run r;
    tool(&r, TOOL_PLAY " %s --device host --frames 1 --max-list 100", test_pack("whole-tiles"));
    assert_int_equal(r.code, 0);
    assert_non_null(strstr(r.err, "warning: frame 1, splat_place: photons were left out"));
}

static void every_pass_that_notices_faults_is_one_of_the_frame(void **state) {
    (void)state;
#define X(name, level, pass, meaning) pass,
    static const char *const passes[] = {VIT_FAULTS(X)};
#undef X
    for (size_t i = 0; i < sizeof passes / sizeof passes[0]; i++) {
        int found = passes[i] == NULL;
        for (uint32_t p = 0; p < vit_pass_count; p++)
            found |= passes[i] != NULL && strcmp(passes[i], vit_passes[p].name) == 0;
        if (!found)
            fail_msg("there is no pass '%s'", passes[i]);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(an_exact_bake_has_no_fault),
        cmocka_unit_test(what_a_bound_drops_is_noted_with_frame_pass_and_count),
        cmocka_unit_test(of_too_many_the_latest_are_kept),
        cmocka_unit_test(a_device_that_fails_is_noted_with_its_pass),
        cmocka_unit_test(every_pass_that_notices_faults_is_one_of_the_frame),
        cmocka_unit_test(the_player_prints_them_at_exit),
    };
    return cmocka_run_group_tests_name("faults", tests, NULL, NULL);
}
