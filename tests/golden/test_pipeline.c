/* Many packs from one import. What is stated: a frame that was chosen has the bits that it has among all frames, whatever
 * radius "auto" finds; a pack does not depend on the packs made before it; and another size is what that size bakes to on its
 * own. */
#include "pack/pipeline.h"
#include "test_packs.h"

typedef struct lab {
    progress progress;
    pipeline pipeline;
    vit_text why;
} lab;

static void lab_open(lab *l, int width, int height) {
    memset(l, 0, sizeof *l);
    l->progress = progress_make(true);
    l->pipeline.progress = &l->progress;
    test_packs_begin();
    if (pipeline_read(TEST_PACKS "/room.cfg", &l->pipeline.scene, &l->why) != VIT_OK)
        fail_msg("%s", l->why.text);
    l->pipeline.scene.width = width;
    l->pipeline.scene.height = height;
    l->pipeline.scene.frames = 6;
    l->pipeline.scene.quality.radius = 0; /* auto */
    if (pipeline_load(&l->pipeline, &l->why) != VIT_OK)
        fail_msg("%s", l->why.text);
}

static void pack(lab *l, const pipeline_choice *choice, pipeline_packed *out) {
    if (pipeline_pack(&l->pipeline, choice, out, &l->why) != VIT_OK)
        fail_msg("%s", l->why.text);
}

static void a_chosen_frame_has_the_bits_that_it_has_among_all(void **state) {
    const uint32_t frames[] = {0, 3, 5};
    lab l;
    pipeline_packed all, some;
    (void)state;
    lab_open(&l, 96, 64);
    pipeline_choice choice = pipeline_default(&l.pipeline);
    pack(&l, &choice, &all);
    choice.frames = frames;
    choice.frame_count = 3;
    pack(&l, &choice, &some);
    assert_int_equal(some.plan.scene.frames, 3);
    assert_memory_equal(&some.plan.scene.radius, &all.plan.scene.radius, sizeof(float));
    for (uint32_t i = 0; i < 3; i++)
        assert_memory_equal(some.gold[i].xrgb8888, all.gold[frames[i]].xrgb8888, sizeof all.gold[0].xrgb8888);
    assert_memory_not_equal(some.gold[0].xrgb8888, some.gold[1].xrgb8888, sizeof all.gold[0].xrgb8888);
    pipeline_packed_free(&some);
    pipeline_packed_free(&all);
    pipeline_free(&l.pipeline);
}

static void a_pack_does_not_depend_on_those_made_before(void **state) {
    lab l;
    pipeline_packed first, other, again;
    (void)state;
    lab_open(&l, 96, 64);
    const pipeline_choice plain = pipeline_default(&l.pipeline);
    pipeline_choice buckets = plain;
    buckets.quality.buckets = true;
    buckets.quality.photons = 512;
    buckets.quality.vertex_bits = 16; /* a shape of its own */
    buckets.quality.normal_bits = 8;
    pack(&l, &plain, &first);
    pack(&l, &buckets, &other);
    pack(&l, &plain, &again);
    assert_int_equal(first.size, again.size);
    assert_memory_equal(first.bytes, again.bytes, first.size);
    assert_memory_not_equal(other.geometry->triangles, first.geometry->triangles,
                            first.model->triangles * sizeof(vit_triangle));
    assert_true(other.size != first.size || memcmp(other.bytes, first.bytes, first.size) != 0);
    pipeline_packed_free(&first);
    pipeline_packed_free(&other);
    pipeline_packed_free(&again);
    pipeline_free(&l.pipeline);
}

static void another_size_is_what_that_size_bakes_to_on_its_own(void **state) {
    lab large, small;
    pipeline_packed a, b;
    (void)state;
    lab_open(&large, 96, 64);
    lab_open(&small, 40, 30);
    pipeline_choice choice = pipeline_default(&large.pipeline);
    choice.width = 40;
    choice.height = 30;
    pack(&large, &choice, &a);
    choice = pipeline_default(&small.pipeline);
    pack(&small, &choice, &b);
    assert_int_equal(a.size, b.size);
    assert_memory_equal(a.bytes, b.bytes, a.size);
    pipeline_packed_free(&a);
    pipeline_packed_free(&b);
    pipeline_free(&large.pipeline);
    pipeline_free(&small.pipeline);
}

/* Zones and areas are kept from pack to pack; a fresh pipeline, which has kept nothing, makes the same. */
static void kept_zones_are_those_that_would_be_baked(void **state) {
    static const char *const settings[] = {"zones = true; effective_area = true; radius = 1.0;",
                                           "zones = true; effective_area = true; radius = 1.0; photons = 1000;",
                                           "zones = true; effective_area = true; radius = 0.8;",
                                           "zones = true; light_zones = true; effective_area = true; radius = 1.0;",
                                           "zones = true; effective_area = false; radius = 1.0;",
                                           "zones = true; effective_area = true; radius = 1.0; bounces = 2;",
                                           "zones = true; effective_area = true; radius = 1.0; kernel = \"flattened\";",
                                           "zones = true; effective_area = true; radius = 1.0; vertex_bits = 16;"};
    enum { TRIED = sizeof settings / sizeof settings[0] };
    lab l;
    (void)state;
    lab_open(&l, 96, 64);
    for (size_t i = 0; i < TRIED; i++) {
        lab fresh;
        pipeline_packed of_many, alone;
        pipeline_choice choice = pipeline_default(&l.pipeline);
        assert_int_equal(scene_quality_apply(settings[i], &choice.quality, &l.why), VIT_OK);
        lab_open(&fresh, 96, 64);
        pack(&fresh, &choice, &alone);
        pack(&l, &choice, &of_many);
        assert_int_equal(of_many.size, alone.size);
        assert_memory_equal(of_many.bytes, alone.bytes, alone.size);
        pipeline_packed_free(&of_many);
        pipeline_packed_free(&alone);
        pipeline_free(&fresh.pipeline);
    }
    /* only what photons and vertex_bits changed was not kept */
    uint32_t kept = 0;
    for (int i = 0; i < ZONES_KEPT; i++)
        kept += l.pipeline.kept->one[i].asked > 0;
    assert_int_equal(kept, TRIED - 2);
    pipeline_free(&l.pipeline);
}

/* The same of baked light: what does not touch it finds it, what does does not. */
static void kept_light_is_that_which_would_be_baked(void **state) {
#define BASIS "indirect = \"basis\"; receiver_rays = 32; "
    static const struct {
        const char *text;
        bool found; /* among what is kept */
    } settings[] = {{BASIS, false},
                    {BASIS "photons = 1000; tile = 8; sample_bits = 16;", true},
                    {BASIS "receiver_spacing = 24.0;", false},
                    {BASIS "light_samples = 4;", true},
                    {BASIS "bounces = 2;", false},
                    {BASIS "basis_error = 0.1;", false},
                    {BASIS "vertex_bits = 16;", false}, /* which is not kept either */
                    {BASIS "receiver_spacing = 20.0;", false},
                    {BASIS "receiver_spacing = 24.0;", false}}; /* kept no more */
#undef BASIS
    const uint32_t frames[] = {1, 4};
    uint64_t found = 0;
    lab l;
    (void)state;
    lab_open(&l, 48, 32);
    for (size_t i = 0; i < sizeof settings / sizeof settings[0]; i++) {
        lab fresh;
        pipeline_packed of_many, alone;
        pipeline_choice choice = pipeline_default(&l.pipeline);
        assert_int_equal(scene_quality_apply(settings[i].text, &choice.quality, &l.why), VIT_OK);
        choice.frames = i % 2 ? frames : NULL; /* frames that are left out are still in what is kept */
        choice.frame_count = 2;
        lab_open(&fresh, 48, 32);
        pack(&fresh, &choice, &alone);
        pack(&l, &choice, &of_many);
        assert_int_equal(l.pipeline.kept_baked->found > found, settings[i].found);
        found = l.pipeline.kept_baked->found;
        assert_int_equal(of_many.size, alone.size);
        assert_memory_equal(of_many.bytes, alone.bytes, alone.size);
        pipeline_packed_free(&of_many);
        pipeline_packed_free(&alone);
        pipeline_free(&fresh.pipeline);
    }
    pipeline_free(&l.pipeline);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_chosen_frame_has_the_bits_that_it_has_among_all),
        cmocka_unit_test(a_pack_does_not_depend_on_those_made_before),
        cmocka_unit_test(kept_zones_are_those_that_would_be_baked),
        cmocka_unit_test(kept_light_is_that_which_would_be_baked),
        cmocka_unit_test(another_size_is_what_that_size_bakes_to_on_its_own),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
