/* vitrine-cost as a user runs it, on a small room with a still and a moving light. Hard to test since times vary: what is
 * stated holds whatever the times are. One sweep is made, and its CSV is the witness: it agrees with the JSON; the fronts are
 * what a look at all pairs finds; settings that change no bit have the default's errors; the choice of --fit is what an
 * exhaustive look at the CSV of the same run says, and of
 * --fit-work the same in two runs; a budget too small is exit 3 with the closest miss; --write changes the quality block and
 * nothing else, and what it wrote bakes. */
#include "scene/scene.h"
#include "test_packs.h"
#include <math.h>
#include <stdbool.h>
#include <sys/stat.h>

#define LAB VIT_BUILD_DIR "/tests/golden/cost"
#define SCENE TEST_PACKS "/room.cfg"
#define SWEEP                                                                                                                  \
    TOOL_COST                                                                                                                  \
    " " SCENE " --settings 7 --knobs photons,estimate,tile,lanes --repeats 7 --reference-error 0.01 --max-samples 64 "         \
    "--cache " LAB "/cache --quiet "

/* The choice is looked for on the device that compiles nothing. */
#define MEASURE SWEEP "--device host "

enum { ROWS = 32, COLUMNS = 48, CELL = 1024 };

typedef struct table {
    int rows, columns;
    char head[COLUMNS][64];
    char cell[ROWS][COLUMNS][CELL];
} table;

static table csv;
static tool_run run;

/* One cell of RFC 4180 text from *at on; true: it was the last of its line. */
static bool read_cell(const char **at, char *out, size_t room) {
    size_t used = 0;
    bool quoted = **at == '"';
    const char *p = *at + quoted;
    for (; *p && (quoted || (*p != ',' && *p != '\n')); p++) {
        if (quoted && *p == '"') {
            if (p[1] != '"') {
                quoted = false;
                continue;
            }
            p++;
        }
        assert_true(used + 1 < room);
        out[used++] = *p;
    }
    out[used] = '\0';
    const bool last = *p != ',';
    *at = *p ? p + 1 : p;
    return last;
}

static void read_csv(const char *path) {
    char *text = read_file(path, NULL);
    const char *at = text;
    memset(&csv, 0, sizeof csv);
    while (!read_cell(&at, csv.head[csv.columns++], sizeof csv.head[0]))
        assert_true(csv.columns < COLUMNS);
    while (*at) {
        assert_true(csv.rows < ROWS);
        for (int c = 0; c < csv.columns; c++)
            assert_int_equal(read_cell(&at, csv.cell[csv.rows][c], CELL), c + 1 == csv.columns);
        csv.rows++;
    }
    free(text);
}

static const char *text_at(int row, const char *column) {
    for (int c = 0; c < csv.columns; c++)
        if (strcmp(csv.head[c], column) == 0)
            return csv.cell[row][c];
    fail_msg("no column '%s'", column);
    return NULL;
}

static double at(int row, const char *column) {
    return strtod(text_at(row, column), NULL);
}

static int row_of(const char *name) {
    for (int i = 0; i < csv.rows; i++)
        if (strcmp(text_at(i, "name"), name) == 0)
            return i;
    fail_msg("no setting '%s'", name);
    return -1;
}

static int sweep_once(void **state) {
    (void)state;
    test_packs_begin();
    folder_make(LAB);
    tool(&run, SWEEP "-o " LAB "/report --fit 100000");
    tool_succeeds(&run);
    read_csv(LAB "/report/report.csv");
    return 0;
}

static void every_setting_is_there_with_numbers_that_make_sense(void **state) {
    (void)state;
    assert_int_equal(csv.rows, 7);
    assert_string_equal(text_at(0, "name"), "default");
    for (int i = 0; i < csv.rows; i++) {
        assert_true(at(i, "ms") > 0 && at(i, "ms_p95") >= at(i, "ms") && at(i, "timed") == 7);
        assert_true(at(i, "total_nmse") > 0 && at(i, "total_nmse") < 1 && at(i, "work") > 0);
        assert_true(at(i, "device_bytes") > 1e5 && at(i, "pack_bytes") > 1e4);
    }
    const int few = row_of("photons 500"), buckets = row_of("estimate buckets");
    assert_true(at(few, "total_nmse") > at(0, "total_nmse")); /* fewer photons, more noise */
    assert_true(at(few, "work") < at(0, "work") && at(buckets, "work") < at(0, "work"));
    assert_true(at(buckets, "total_nmse") != at(0, "total_nmse"));
}

static void what_changes_no_bit_has_the_defaults_errors(void **state) {
    int same = 0;
    (void)state;
    for (int i = 1; i < csv.rows; i++) {
        const char *knob = text_at(i, "knob");
        if (strcmp(knob, "lanes") != 0 && strcmp(knob, "tile") != 0)
            continue;
        same++;
        assert_string_equal(text_at(i, "total_nmse"), text_at(0, "total_nmse"));
        assert_string_equal(text_at(i, "unlimited_ssim"), text_at(0, "unlimited_ssim"));
        if (strcmp(knob, "lanes") == 0)
            assert_string_equal(text_at(i, "work"), text_at(0, "work")); /* exact counts that are equal at every width */
        assert_int_equal(at(i, "elsewhere"), strcmp(knob, "lanes") == 0);
    }
    assert_int_equal(same, 2);
}

static void json_says_the_same_as_csv(void **state) {
    char *json = read_file(LAB "/report/report.json", NULL), *p = json;
    (void)state;
    for (int i = 0; i < csv.rows; i++) {
        char want[CELL + 64];
        (void)snprintf(want, sizeof want, "\"name\": \"%s\"", text_at(i, "name"));
        p = strstr(p, want);
        if (!p)
            fail_msg("report.json lacks %s", want);
        (void)snprintf(want, sizeof want, "\"ms\": %s", text_at(i, "ms"));
        assert_non_null(strstr(p, want));
        (void)snprintf(want, sizeof want, "\"work\": %s,", text_at(i, "work"));
        assert_non_null(strstr(p, want));
        (void)snprintf(want, sizeof want, "\"nmse\": %s", text_at(i, "total_nmse"));
        assert_non_null(strstr(p, want));
    }
    free(json);
    free(read_file(LAB "/report/index.html", NULL));
}

static bool beaten(int i, const char *error) {
    for (int k = 0; k < csv.rows; k++) {
        const double ms = at(k, "ms") - at(i, "ms"), worse = at(k, error) - at(i, error);
        if (k != i && at(k, "elsewhere") == 0 && ms <= 0 && worse <= 0 && (ms < 0 || worse < 0 || k < i))
            return true;
    }
    return false;
}

static void the_fronts_are_what_a_look_at_all_pairs_finds(void **state) {
    int on = 0;
    (void)state;
    for (int i = 0; i < csv.rows; i++) {
        const bool takes_part = at(i, "elsewhere") == 0;
        assert_int_equal(at(i, "front"), takes_part && !beaten(i, "total_nmse"));
        assert_int_equal(at(i, "front_relmse"), takes_part && !beaten(i, "total_relmse"));
        on += at(i, "front") == 1;
    }
    assert_true(on >= 1); /* alone is there what is both the quickest, on a busy machine by chance, and the most accurate */
}

/* Of the CSV at hand: the least error whose price fits. */
static int best_of(const char *price, double budget) {
    int best = -1;
    for (int i = 0; i < csv.rows; i++)
        if (at(i, "elsewhere") == 0 && at(i, price) <= budget &&
            (best < 0 || at(i, "total_nmse") < at(best, "total_nmse") ||
             (at(i, "total_nmse") == at(best, "total_nmse") && at(i, price) < at(best, price))))
            best = i;
    return best;
}

/* The name of the choice in what the tool printed: the line before its quality block. */
static void chosen_name(char *name, size_t room) {
    char *block = strstr(run.out, "\nquality: {");
    assert_non_null(block);
    *block = '\0';
    (void)snprintf(name, room, "%s", strrchr(run.out, '\n') + 1);
}

static void the_choice_is_what_the_table_says(void **state) {
    char name[128], again[128];
    (void)state;
    tool(&run, MEASURE "-o " LAB "/other --fit 100000");
    tool_succeeds(&run);
    read_csv(LAB "/other/report.csv");
    chosen_name(name, sizeof name);
    assert_string_equal(name, text_at(best_of("ms_p95", 100000), "name"));
    const double budget = (at(row_of("photons 500"), "work") + at(0, "work")) / 2;
    tool(&run, MEASURE "--fit-work %.0f", floor(budget));
    tool_succeeds(&run);
    chosen_name(name, sizeof name);
    assert_string_equal(name, text_at(best_of("work", floor(budget)), "name"));
    tool(&run, MEASURE "--fit-work %.0f --threads 1", floor(budget));
    tool_succeeds(&run);
    chosen_name(again, sizeof again);
    assert_string_equal(name, again);
}

static void a_budget_that_nothing_fits_names_the_closest_miss(void **state) {
    int least = 0;
    char want[160];
    (void)state;
    for (int i = 1; i < csv.rows; i++)
        least = at(i, "elsewhere") == 0 && at(i, "work") < at(least, "work") ? i : least;
    tool(&run, MEASURE "--fit-work 1000");
    assert_int_equal(run.code, VIT_BUDGET);
    (void)snprintf(want, sizeof want, "vitrine-cost: no setting fits 1000 work units a frame: the closest, '%s', takes %s, ",
                   text_at(least, "name"), text_at(least, "work"));
    assert_non_null(strstr(run.err, want)); /* perhaps after a warning */
    tool(&run, MEASURE "--fit 0.001");
    assert_int_equal(run.code, VIT_BUDGET);
    assert_non_null(strstr(run.err, "no setting fits 0.001 ms: the closest, '"));
}

static void write_changes_the_quality_block_and_nothing_else(void **state) {
    char *before = read_file(SCENE, NULL), name[128];
    (void)state;
    put(TEST_PACKS "/room-fit.cfg", before); /* beside the mesh that it names */
    tool(&run, MEASURE "--fit-work 1000000000000 --write " TEST_PACKS "/room-fit.cfg");
    tool_succeeds(&run);
    char block[1024];
    (void)snprintf(block, sizeof block, "%.1000s", strstr(run.out, "\nquality: {") + 1);
    chosen_name(name, sizeof name);
    char *after = read_file(TEST_PACKS "/room-fit.cfg", NULL), *at_before = strstr(before, "quality:"),
         *at_after = strstr(after, "quality:");
    assert_true(at_before && at_after && at_before - before == at_after - after);
    assert_memory_equal(before, after, (size_t)(at_before - before));
    assert_string_equal(at_after, block); /* the block is the scene's last line */
    tool(&run, VIT_BUILD_DIR "/vitrine-bake " TEST_PACKS "/room-fit.cfg -o " LAB "/fit.vit --quiet");
    tool_succeeds(&run);
    free(before);
    free(after);
}

/* A row for each way of making indirect light, with the time of its bake; a label in the plot; and a word about knobs that turn
 * nothing. */
static void ways_of_making_indirect_light_are_compared(void **state) {
    char *scene_text = read_file(SCENE, NULL), with[4096];
    static const char stated[] = "indirect = \"photons\"; ";
    const char *block = strstr(scene_text, stated);
    (void)state;
    (void)snprintf(with, sizeof with, "%.*sindirect = \"basis\"; receiver_rays = 64; receiver_spacing = 24.0; %s",
                   (int)(block - scene_text), scene_text, block + strlen(stated));
    put(TEST_PACKS "/room-basis.cfg", with);
    free(scene_text);
    tool(&run, TOOL_COST " " TEST_PACKS "/room-basis.cfg --size 48x32 --knobs indirect,photons,tile --settings 9 --repeats 7 "
                         "--reference-error 0.01 --max-samples 64 --no-cache --device host -o " LAB "/methods");
    tool_succeeds(&run);
    assert_non_null(strstr(run.err, "indirect light by basis: nothing to turn is left to photons\n"));
    read_csv(LAB "/methods/report.csv");
    assert_int_equal(csv.rows, 1 + 3 + 3);
    const int list = row_of("indirect photons list"), buckets = row_of("indirect photons buckets"), tile = row_of("tile 8");
    assert_true(at(list, "total_nmse") > at(0, "total_nmse") && at(buckets, "total_nmse") != at(list, "total_nmse"));
    assert_true(at(list, "device_bytes") != at(0, "device_bytes"));
    assert_string_equal(text_at(tile, "indirect_nmse"), text_at(0, "indirect_nmse"));
    assert_true(at(list, "bake_seconds") > 0 && at(0, "bake_seconds") > 0);
    char *page = read_file(LAB "/methods/index.html", NULL);
    assert_non_null(strstr(page, ">default: basis<"));
    assert_non_null(strstr(page, ">indirect photons list<"));
    assert_non_null(strstr(page, ">indirect radiosity<"));
    free(page);
}

static void mistakes_are_named(void **state) {
    (void)state;
    tool(&run, TOOL_COST " " SCENE);
    tool_refuses(&run, "vitrine-cost", VIT_USAGE, "what for?");
    tool(&run, TOOL_COST " " SCENE " -o " LAB "/none --knobs photons,wrong");
    assert_int_equal(run.code, VIT_USAGE);
    assert_non_null(strstr(run.err, "there is no knob 'wrong'"));
    tool(&run, TOOL_COST " " SCENE " -o " LAB "/none --quiet --frame 2");
    tool_refuses(&run, "vitrine-cost", VIT_USAGE, "the path has frames 0 to 1");
    tool(&run, TOOL_COST " " SCENE " -o " LAB "/none --repeats 6");
    tool_refuses(&run, "vitrine-cost", VIT_USAGE, "--repeats");
    tool(&run, TOOL_COST " " SCENE " --fit 33 --fit-work 5");
    tool_refuses(&run, "vitrine-cost", VIT_USAGE, "one budget at a time");
    tool(&run, TOOL_COST " " SCENE " --converge 6");
    tool_refuses(&run, "vitrine-cost", VIT_USAGE, "--converge: goes with -o");
    tool(&run, TOOL_COST " " SCENE " --converge 4 -o " LAB "/none");
    tool_refuses(&run, "vitrine-cost", VIT_USAGE, "a whole number, 5 to 12");
    tool(&run, TOOL_COST " no-such.cfg -o " LAB "/none");
    assert_int_equal(run.code, VIT_BAD_INPUT);
    tool(&run, TOOL_COST " --help");
    tool_succeeds(&run);
    assert_non_null(strstr(run.out, "--fit-work"));
    assert_non_null(strstr(run.out, "normal_keys"));
}

/* However fast the machine: all fit, so the three most accurate and the default do. */
static void a_fit_times_only_what_could_be_the_answer(void **state) {
    (void)state;
    unsigned timed = 0, all = 0;
    tool(&run,
         TOOL_COST " " TEST_PACKS "/room.cfg --size 48x32 --knobs photons,radius,estimate --settings 10 --fit 1e6 --repeats 7 "
                   "--max-samples 16 --reference-error 1 --no-cache --device host");
    tool_succeeds(&run);
    const char *line = strstr(run.err, "times: ");
    while (line && sscanf(line, "times: %u of %u settings", &timed, &all) != 2)
        line = strstr(line + 1, "times: ");
    assert_true(all >= 8 && all <= 10);
    assert_true(timed >= 3 && timed <= 4);
    assert_non_null(strstr(run.out, "\n> "));
}

/* The default alone is left of these. */
static void a_fit_makes_no_pictures_of_what_it_cannot_choose(void **state) {
    (void)state;
    tool(&run, TOOL_COST " " TEST_PACKS "/room.cfg --size 48x32 --knobs lanes,size --settings 10 --fit 1e6 --repeats 7 "
                         "--max-samples 16 --reference-error 1 --no-cache --device host");
    tool_succeeds(&run);
    assert_non_null(strstr(run.err, "times: 1 of 1 settings"));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(mistakes_are_named),
        cmocka_unit_test(every_setting_is_there_with_numbers_that_make_sense),
        cmocka_unit_test(what_changes_no_bit_has_the_defaults_errors),
        cmocka_unit_test(json_says_the_same_as_csv),
        cmocka_unit_test(the_fronts_are_what_a_look_at_all_pairs_finds),
        cmocka_unit_test(the_choice_is_what_the_table_says),
        cmocka_unit_test(a_budget_that_nothing_fits_names_the_closest_miss),
        cmocka_unit_test(ways_of_making_indirect_light_are_compared),
        cmocka_unit_test(a_fit_times_only_what_could_be_the_answer),
        cmocka_unit_test(a_fit_makes_no_pictures_of_what_it_cannot_choose),
        cmocka_unit_test(write_changes_the_quality_block_and_nothing_else),
    };
    return cmocka_run_group_tests(tests, sweep_once, NULL);
}
