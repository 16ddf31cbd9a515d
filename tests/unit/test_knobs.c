/* The knobs of a sweep. Stated: the default comes first and unchanged; a setting that bears one knob's name differs from the
 * default in what belongs to that knob; no two settings are alike; the list is the same every time, bounded, and reaches every
 * knob even when short; combinations turn several knobs and are spread; what a setting says reads back through the quality
 * block's own reader. */
#include "cost/knobs.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

static scene_quality base; /* defaults of a scene file, but for what begin() states */

static int begin(void **state) {
    scene s;
    vit_text why = {""};
    (void)state;
    assert_int_equal(scene_for_mesh("none.obj", &s, &why), VIT_OK);
    base = s.quality;
    scene_free(&s);
    return scene_quality_apply("indirect = \"photons\"; photons = 10000; bounces = 4; radius = 0.8; tile = 32", &base, &why);
}

static knob_list make_for(uint64_t effects, const scene_quality *q, double radius, const char *only, uint32_t most) {
    knob_list l;
    vit_text why = {""};
    const knobs_input in = {.base = q, .radius = radius, .effects = effects, .only = only, .most = most};
    if (knobs_open(&in, &l, &why) != VIT_OK || knobs_spread(&l, most, &why) != VIT_OK)
        fail_msg("%s", why.text);
    return l;
}

static knob_list make(const scene_quality *q, double radius, const char *only, uint32_t most) {
    return make_for(~(uint64_t)0, q, radius, only, most);
}

static const char *text_of(const scene_quality *q) {
    static char text[4][SCENE_QUALITY];
    static int turn;
    turn = (turn + 1) % 4;
    scene_quality_text(q, text[turn], sizeof text[turn]);
    return text[turn];
}

static const knob_setting *find(const knob_list *l, const char *name) {
    for (uint32_t i = 0; i < l->count; i++)
        if (strcmp(l->settings[i].name, name) == 0)
            return &l->settings[i];
    fail_msg("no setting '%s'", name);
    return NULL;
}

static void the_default_comes_first_and_each_knob_alone_changes_its_own(void **state) {
    knob_list l = make(&base, 0.8, NULL, 128);
    (void)state;
    assert_string_equal(l.settings[0].name, "default");
    assert_string_equal(text_of(&l.settings[0].quality), text_of(&base));
    assert_true(knobs_in_quality(&l.settings[0]));
    assert_int_equal(find(&l, "photons 2500")->quality.photons, 2500);
    assert_int_equal(find(&l, "photons 40000")->quality.photons, 40000);
    assert_true(find(&l, "radius 0.4")->quality.radius == 0.4);
    assert_true(find(&l, "radius auto")->quality.radius == 0.0);
    assert_true(find(&l, "estimate buckets")->quality.buckets && !find(&l, "estimate buckets")->quality.raw);
    assert_true(find(&l, "estimate raw buckets")->quality.raw);
    assert_true(find(&l, "kernel flattened")->quality.flattened);
    assert_int_equal(find(&l, "tile 8")->quality.tile, 8);
    assert_int_equal(find(&l, "bounces 2")->quality.bounces, 2);
    assert_true(find(&l, "normal_keys on")->quality.normal_keys);
    assert_true(find(&l, "size 0.5")->scale == 0.5 && !knobs_in_quality(find(&l, "size 0.5")));
    assert_true(find(&l, "lanes 8")->lanes == 8 && !knobs_in_quality(find(&l, "lanes 8")));
    for (uint32_t i = 0; i < l.count; i++) /* the default's own values are no settings of their own */
        assert_true(strcmp(l.settings[i].name, "tile 32") != 0 && strcmp(l.settings[i].name, "estimate list") != 0);
    knobs_close(&l);
}

static void no_two_settings_are_alike_and_the_list_is_the_same_each_time(void **state) {
    knob_list a = make(&base, 0.8, NULL, 80), b = make(&base, 0.8, NULL, 80);
    (void)state;
    assert_int_equal(a.count, 80);
    assert_int_equal(b.count, 80);
    for (uint32_t i = 0; i < a.count; i++) {
        assert_string_equal(a.settings[i].name, b.settings[i].name);
        for (uint32_t k = 0; k < i; k++) {
            assert_string_not_equal(a.settings[i].name, a.settings[k].name);
            assert_true(a.settings[i].scale != a.settings[k].scale || a.settings[i].lanes != a.settings[k].lanes ||
                        strcmp(text_of(&a.settings[i].quality), text_of(&a.settings[k].quality)) != 0);
        }
    }
    knobs_close(&a);
    knobs_close(&b);
}

static void combinations_turn_several_knobs_and_reach_all_values(void **state) {
    knob_list l = make(&base, 0.8, "photons,radius,estimate", 1000);
    uint32_t several = 0, buckets = 0, few = 0;
    (void)state;
    assert_int_equal(l.count, 5 * 7 * 3); /* the whole product: the list ends when it does */
    for (uint32_t i = 0; i < l.count; i++) {
        const scene_quality *q = &l.settings[i].quality;
        const int turned = (q->photons != base.photons) + (q->radius != base.radius) + q->buckets;
        assert_true((strcmp(l.settings[i].knob, "several") == 0) == (turned >= 2));
        several += turned >= 2;
    }
    assert_int_equal(several, 5 * 7 * 3 - 1 - 4 - 6 - 2);
    knobs_close(&l);
    l = make(&base, 0.8, "photons,radius,estimate", 40); /* a part is spread over it */
    for (uint32_t i = 13; i < l.count; i++) {
        buckets += l.settings[i].quality.buckets;
        few += l.settings[i].quality.photons == 2500;
    }
    assert_in_range(buckets, 10, 25);
    assert_in_range(few, 3, 8);
    knobs_close(&l);
}

static void what_lies_beside_a_setting_differs_from_it_in_one_knob(void **state) {
    knob_list l = make(&base, 0.8, "photons,radius,estimate", 13); /* the default and the knobs alone */
    vit_status status = VIT_OK;
    vit_text why = {""};
    uint32_t from, step = 0;
    (void)state;
    l.settings = realloc(l.settings, 100 * sizeof *l.settings);
    l.most = 100;
    assert_non_null(l.settings);
    from = (uint32_t)(find(&l, "estimate buckets") - l.settings);
    while (knobs_beside(&l, from, step, &status, &why))
        step++;
    assert_int_equal(status, VIT_OK);
    assert_int_equal(step, 5 + 7 + 3);
    assert_int_equal(l.count, 13 + 4 + 6); /* photons or radius too; the other estimates alone are there */
    for (uint32_t i = 13; i < l.count; i++) {
        const scene_quality *q = &l.settings[i].quality;
        assert_true(q->buckets && !q->raw);
        assert_int_equal((q->photons != base.photons) + (q->radius != base.radius), 1);
        assert_string_equal(l.settings[i].knob, "several");
    }
    knobs_close(&l);
}

static void a_short_list_still_has_every_knob(void **state) {
    knob_list l = make(&base, 0.8, NULL, 10);
    (void)state;
    assert_int_equal(l.count, 10);
    for (uint32_t i = 1; i < l.count; i++)
        for (uint32_t k = 0; k < i; k++)
            assert_string_not_equal(l.settings[i].knob, l.settings[k].knob);
    knobs_close(&l);
}

static void only_knobs_that_are_named_are_turned_and_unknown_ones_refused(void **state) {
    knob_list l = make(&base, 0.8, "tile,lanes", 64);
    const knobs_input in = {.base = &base, .radius = 0.8, .only = "tile,speed", .most = 9};
    knob_list none;
    vit_text why = {""};
    (void)state;
    assert_int_equal(l.count, 1 + 3 + 3);
    knobs_close(&l);
    assert_int_equal(knobs_open(&in, &none, &why), VIT_USAGE);
    assert_non_null(strstr(why.text, "'speed'"));
    assert_non_null(strstr(why.text, "normal_keys"));
}

static void without_photons_nothing_is_a_multiple_of_them(void **state) {
    scene_quality q = base;
    q.photons = 0;
    knob_list l = make(&q, 0, "photons,radius", 64);
    (void)state;
    for (uint32_t i = 0; i < l.count; i++)
        assert_true(l.settings[i].quality.photons == 0);
    assert_in_range(l.count, 1, 2); /* the default, and perhaps radius auto */
    knobs_close(&l);
}

/* Settings of photons need photons, the sparse samples too, those of the basis need it. */
static void knobs_of_indirect_light_need_what_they_turn(void **state) {
    static const char only[] = "estimate,kernel,indirect_samples,receiver_rays";
    const uint64_t none = ~vit_effects_upon(VIT_BIT(INDIRECT)), other = none | VIT_BIT(INDIRECT);
    (void)state;
    knob_list l = make_for(none, &base, 0.8, only, 100);
    assert_int_equal(l.count, 1);
    knobs_close(&l);
    l = make_for(other, &base, 0.8, only, 100);
    assert_int_equal(l.count, 1);
    knobs_close(&l);
    l = make_for(other | VIT_BIT(PHOTONS), &base, 0.8, only, 100);
    assert_string_equal(l.settings[1].knob, "estimate");
    assert_int_equal(l.count, 3 * 2 * 3); /* combined, too */
    knobs_close(&l);
    scene_quality by_basis = base;
    by_basis.indirect = INDIRECT_BASIS;
    l = make_for(other | VIT_BIT(BASIS), &by_basis, 0.8, only, 100);
    assert_int_equal(l.count, 1 + 2);
    assert_string_equal(l.settings[1].knob, "receiver_rays");
    knobs_close(&l);
}

/* Ways of making indirect light are a knob; settings of the others than the default's make no difference, and are named. */
static void ways_of_making_indirect_light_are_a_knob(void **state) {
    static const char only[] = "photons,estimate,indirect,receiver_rays,tile";
    const uint64_t all = ~(vit_effects_upon(VIT_BIT(INDIRECT))) | VIT_BIT(INDIRECT);
    char idle[256];
    scene_quality q = base;
    (void)state;
    knobs_input in = {.base = &q, .radius = 0.8, .effects = all | VIT_BIT(PHOTONS), .only = only, .most = 1};
    knob_list l = make_for(in.effects, &q, 0.8, only, 100);
    assert_int_equal(find(&l, "indirect basis")->quality.indirect, INDIRECT_BASIS);
    for (uint32_t i = 0; i < l.count; i++) /* the default; "estimate buckets" are the buckets already */
        assert_null(strstr(l.settings[i].name, "indirect photons"));
    knobs_close(&l);
    knobs_idle(&in, idle, sizeof idle);
    assert_string_equal(idle, "receiver_rays");
    q.indirect = INDIRECT_BASIS;
    q.buckets = true; /* which the basis does not care for */
    in.effects = all | VIT_BIT(BASIS);
    l = make_for(in.effects, &q, 0, only, 100);
    assert_int_equal(l.count, 1 + 3 + 3 + 2);
    assert_int_equal(find(&l, "indirect radiosity")->quality.indirect, INDIRECT_RADIOSITY);
    assert_true(find(&l, "indirect photons list")->quality.indirect == INDIRECT_PHOTONS);
    assert_false(find(&l, "indirect photons list")->quality.buckets);
    assert_true(find(&l, "indirect photons buckets")->quality.buckets);
    assert_int_equal(find(&l, "receiver_rays 128")->quality.receiver_rays, 128);
    knobs_close(&l);
    knobs_idle(&in, idle, sizeof idle);
    assert_string_equal(idle, "photons, estimate");
}

static void what_a_setting_says_reads_back(void **state) {
    knob_list l = make(&base, 1.0 / 3, NULL, 200);
    (void)state;
    for (uint32_t i = 0; i < l.count; i++) {
        vit_text why = {""};
        scene_quality q = l.settings[(i * 7 + 3) % l.count].quality; /* over anything */
        if (scene_quality_apply(text_of(&l.settings[i].quality), &q, &why) != VIT_OK)
            fail_msg("%s", why.text);
        assert_string_equal(text_of(&q), text_of(&l.settings[i].quality));
        assert_true(q.radius == l.settings[i].quality.radius);
        assert_true(q.flatten == l.settings[i].quality.flatten && q.raw == l.settings[i].quality.raw);
    }
    knobs_close(&l);
}

static void bad_settings_are_refused_and_change_nothing(void **state) {
    static const char *const bad[] = {"tile = 9",      "tile = 24",    "speed = 1", "tile =", "smoothing = \"raw\"",
                                      "flatten = 3.0", "photons = 1.5"};
    (void)state;
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        scene_quality q = base;
        vit_text why = {""};
        assert_int_equal(scene_quality_apply(bad[i], &q, &why), VIT_BAD_INPUT);
        assert_string_equal(text_of(&q), text_of(&base));
        assert_true(why.text[0] && !strchr(why.text, '\n'));
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_default_comes_first_and_each_knob_alone_changes_its_own),
        cmocka_unit_test(no_two_settings_are_alike_and_the_list_is_the_same_each_time),
        cmocka_unit_test(combinations_turn_several_knobs_and_reach_all_values),
        cmocka_unit_test(what_lies_beside_a_setting_differs_from_it_in_one_knob),
        cmocka_unit_test(a_short_list_still_has_every_knob),
        cmocka_unit_test(only_knobs_that_are_named_are_turned_and_unknown_ones_refused),
        cmocka_unit_test(without_photons_nothing_is_a_multiple_of_them),
        cmocka_unit_test(knobs_of_indirect_light_need_what_they_turn),
        cmocka_unit_test(ways_of_making_indirect_light_are_a_knob),
        cmocka_unit_test(what_a_setting_says_reads_back),
        cmocka_unit_test(bad_settings_are_refused_and_change_nothing),
    };
    return cmocka_run_group_tests(tests, begin, NULL);
}
