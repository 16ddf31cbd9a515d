/* The one table of quality settings. Stated: each row's default is a value that it allows; what an option takes is what the
 * scene file takes; the ends of a range are allowed and what lies beyond is not; every value to try can be tried;
 * bake/README.md has the table as it is. */
#include "scene/setting_rows.h"
#include "scene/scene.h"
#include <float.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

#define LENGTH 256

/* The default as scene file text, in `text`; as it is put by the scene file's reader it changes nothing. */
static void defaults_are_allowed_and_are_what_the_scene_file_has(void **state) {
    (void)state;
    for (int i = 0; i < SETTINGS; i++) {
        const setting_row *s = &setting_rows[i];
        char text[LENGTH], with[2 * LENGTH];
        vit_text why = {""};
        scene_quality q = settings_default;
        assert_true(fields_write(&s->field, &q, text, sizeof text) > 0);
        snprintf(with, sizeof with, "%s%s", i == SETTING_AT_flatten ? "kernel = \"flattened\"; " : "", text);
        if (scene_quality_apply(with, &q, &why) != VIT_OK)
            fail_msg("%s", why.text);
        q.flattened = settings_default.flattened;
        for (int k = 0; k < SETTINGS; k++) {
            char a[LENGTH], b[LENGTH];
            (void)fields_write(&setting_rows[k].field, &q, a, sizeof a);
            (void)fields_write(&setting_rows[k].field, &settings_default, b, sizeof b);
            assert_string_equal(a, b);
        }
    }
}

/* Puts text as an option and says whether the scene file's reader makes the same of it. */
static bool taken(const setting_row *s, const char *text, const char *in_file) {
    scene_quality by_option = settings_default, by_file = settings_default;
    char with[LENGTH];
    vit_text why = {""};
    by_option.flattened = by_option.buckets = by_option.zones = true; /* what other settings need */
    by_file = by_option;
    const bool option = settings_put(s, text, &by_option);
    snprintf(with, sizeof with, "%s = %s;", s->field.name, in_file);
    const bool file = scene_quality_apply(with, &by_file, &why) == VIT_OK;
    if (option != file)
        fail_msg("%s: %s as an option %d, %s in the file %d: %s", s->field.name, text, option, in_file, file, why.text);
    char a[LENGTH], b[LENGTH];
    (void)fields_write(&s->field, &by_option, a, sizeof a);
    (void)fields_write(&s->field, &by_file, b, sizeof b);
    assert_string_equal(a, b);
    return option;
}

static void numbers_are_allowed_up_to_the_ends_of_their_range(void **state) {
    int ranges = 0;
    (void)state;
    for (int i = 0; i < SETTINGS; i++) {
        const setting_row *s = &setting_rows[i];
        const bool whole = s->field.kind == FIELD_WHOLE;
        if (!whole && s->field.kind != FIELD_NUMBER && s->field.kind != FIELD_AUTO)
            continue;
        char *end, text[64];
        const double low = strtod(s->field.allowed + 1, &end), high = strtod(end + 1, &end);
        const double values[] = {low, high, whole ? low - 1 : nextafter(low, -DBL_MAX),
                                 whole ? high + 1 : nextafter(high, DBL_MAX)};
        const bool right[] = {s->field.allowed[0] == '[', *end == ']', false, false};
        for (int k = 0; k < 4; k++) {
            snprintf(text, sizeof text, whole ? "%.0f" : "%.17g", values[k]);
            if (!whole && !strpbrk(text, ".e"))
                strcat(text, ".0");
            if (taken(s, text, text) != right[k])
                fail_msg("%s = %s", s->field.name, text);
        }
        assert_false(settings_put(s, "4294967297", &(scene_quality){0}));
        assert_false(settings_put(s, "1x", &(scene_quality){0}));
        assert_false(settings_put(s, "", &(scene_quality){0}));
        assert_false(settings_put(s, NULL, &(scene_quality){0}));
        ranges++;
    }
    assert_true(ranges >= 7);
}

static void words_are_those_of_the_list(void **state) {
    (void)state;
    for (int i = 0; i < SETTINGS; i++) {
        const setting_row *s = &setting_rows[i];
        const bool quoted = s->field.kind == FIELD_CHOICE || s->field.kind == FIELD_WORD,
                   on_off = s->field.kind == FIELD_SWITCH;
        if (!quoted && !on_off && s->field.kind != FIELD_AMONG)
            continue;
        char list[LENGTH], in_file[LENGTH], *rest;
        snprintf(list, sizeof list, "%s", on_off ? "0|1" : s->field.allowed);
        for (char *word = strtok_r(list, "|", &rest); word; word = strtok_r(NULL, "|", &rest)) {
            snprintf(in_file, sizeof in_file, quoted ? "\"%s\"" : "%s", on_off ? (*word == '1' ? "true" : "false") : word);
            assert_true(taken(s, word, in_file));
        }
        assert_false(taken(s, "7", quoted ? "\"7\"" : "7"));
        assert_false(taken(s, "", "\"\""));
    }
}

static void a_name_is_found_with_dashes_and_not_by_its_beginning(void **state) {
    (void)state;
    assert_ptr_equal(settings_named("light-samples", 13), &setting_rows[SETTING_AT_light_samples]);
    assert_ptr_equal(settings_named("light_samples", 13), &setting_rows[SETTING_AT_light_samples]);
    assert_null(settings_named("light-samples", 5));
    assert_null(settings_named("radius2", 7));
    assert_null(settings_named("", 0));
}

static void what_an_option_wants_is_said_in_words(void **state) {
    char text[LENGTH];
    (void)state;
    settings_wants(&setting_rows[SETTING_AT_tile], text, sizeof text);
    assert_string_equal(text, "8, 16, 32 or 64");
    settings_wants(&setting_rows[SETTING_AT_caustics], text, sizeof text);
    assert_string_equal(text, "0 or 1");
    settings_wants(&setting_rows[SETTING_AT_radius], text, sizeof text);
    assert_string_equal(text, "1e-12 to 1e6 m, or auto");
    settings_wants(&setting_rows[SETTING_AT_flatten], text, sizeof text);
    assert_string_equal(text, "above 0 to 1e4");
}

/* Values to try name settings and values that exist: "value | value", "[label: ]value[, word value]...", "x2". */
static void every_value_to_try_can_be_tried(void **state) {
    int values = 0;
    (void)state;
    for (int i = 0; i < SETTINGS; i++) {
        char tried[LENGTH], *at = tried;
        snprintf(tried, sizeof tried, "%s", setting_rows[i].tried ? setting_rows[i].tried : "");
        while (*at) {
            scene_quality q = settings_default;
            char *bar = strstr(at, " | "), *next = bar ? bar + 3 : at + strlen(at), *rest;
            if (bar)
                *bar = '\0';
            char *colon = strstr(at, ": "), *word = strtok_r(colon ? colon + 2 : at, ",", &rest);
            assert_true(*word == 'x' ? strtod(word + 1, NULL) > 0 : settings_put(&setting_rows[i], word, &q));
            while ((word = strtok_r(NULL, ",", &rest)) != NULL) {
                word += strspn(word, " ");
                const setting_row *other = settings_named(word, strcspn(word, " "));
                assert_non_null(other);
                assert_true(settings_put(other, word + strcspn(word, " ") + 1, &q));
            }
            values++;
            at = next;
        }
    }
    assert_true(values > 60);
}

static void the_readme_has_the_table(void **state) {
    static char table[32768], readme[262144];
    FILE *to = fmemopen(table, sizeof table - 1, "w"), *from = fopen("bake/README.md", "r");
    (void)state;
    assert_non_null(to);
    assert_non_null(from);
    settings_table(to);
    fclose(to);
    readme[fread(readme, 1, sizeof readme - 1, from)] = '\0';
    fclose(from);
    if (!strstr(readme, table))
        fail_msg("bake/README.md does not have the table of settings as it is: make readme");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(defaults_are_allowed_and_are_what_the_scene_file_has),
        cmocka_unit_test(numbers_are_allowed_up_to_the_ends_of_their_range),
        cmocka_unit_test(words_are_those_of_the_list),
        cmocka_unit_test(a_name_is_found_with_dashes_and_not_by_its_beginning),
        cmocka_unit_test(what_an_option_wants_is_said_in_words),
        cmocka_unit_test(every_value_to_try_can_be_tried),
        cmocka_unit_test(the_readme_has_the_table),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
