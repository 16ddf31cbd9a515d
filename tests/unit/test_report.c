/* The report of vitrine-cost: its three files against the results that they were made from.
 *
 * Why this is hard: most of a report is for eyes. Strategy: made-up results of a known shape (report_lab.h); what is for
 * machines (CSV, JSON) is read back and compared number by number, what is derived is held to hand-made cases, pictures are
 * decoded again, and of the page the promises are checked: nothing loaded from anywhere, all text escaped, the plots there.
 * What the page does in a browser is test_report_browser.c's subject. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>

#include "json_check.h"
#include "report_lab.h"
#include "test_folder.h"

typedef struct bench {
    char folder[64], out[96];
    cost_results results;
} bench;

static int set_up(void **state) {
    static bench b;
    folder_make_temporary(b.folder);
    path_join(b.out, sizeof b.out, b.folder, "a/b");
    b.results = lab_results(64, 36);
    *state = &b;
    return 0;
}

static int tear_down(void **state) {
    bench *b = *state;
    const char *names[] = {"a/b/report.csv", "a/b/report.json", "a/b/index.html", "a/b", "a", "file"};
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++) {
        char path[160];
        path_join(path, sizeof path, b->folder, names[i]);
        (void)remove(path);
    }
    lab_free(&b->results);
    return rmdir(b->folder); /* fails if a temporary file was left behind */
}

/* The whole file, ended with a zero; NULL: there is none. The caller frees it. */
static char *file_text(const bench *b, const char *name) {
    char path[160];
    path_join(path, sizeof path, b->out, name);
    return access(path, F_OK) == 0 ? read_file(path, NULL) : NULL;
}

static void write_report(const bench *b) {
    vit_text why = {""};
    if (report_write(&b->results, b->out, &why) != VIT_OK)
        fail_msg("%s", why.text);
}

/* ---- CSV ---- */

/* Splits one row in place (RFC 4180 without line breaks inside quotes); returns how many fields. */
static int split_row(char *row, char *fields[], int most) {
    int count = 0;
    for (char *at = row; count < most;) {
        char *out = at;
        fields[count++] = out;
        const bool quoted = *at == '"';
        at += quoted;
        while (*at && (quoted ? *at != '"' || at[1] == '"' : *at != ',')) {
            at += quoted && *at == '"';
            *out++ = *at++;
        }
        at += quoted;
        const bool more = *at == ',';
        *out = '\0';
        if (!more)
            break;
        at++;
    }
    return count;
}

static int column(char *fields[], int count, const char *name) {
    for (int i = 0; i < count; i++)
        if (strcmp(fields[i], name) == 0)
            return i;
    fail_msg("no column '%s'", name);
    return -1;
}

static void the_csv_reads_back_to_the_same_numbers(void **state) {
    bench *b = *state;
    (void)snprintf(b->results.settings[1].name, COST_NAME, "a \"quoted\", name");
    b->results.settings[2].total.psnr = (double)NAN;
    write_report(b);
    char *text = file_text(b, "report.csv"), *rest = NULL, *head[64], *row[64];
    assert_non_null(text);
    const int columns = split_row(strtok_r(text, "\n", &rest), head, 64);
    const int name = column(head, columns, "name"), nmse = column(head, columns, "total_nmse"),
              ms = column(head, columns, "ms"), unlimited = column(head, columns, "unlimited_relmse"),
              device = column(head, columns, "device_bytes"), front = column(head, columns, "front"),
              psnr = column(head, columns, "total_psnr"), equal = column(head, columns, "path_tracer_ms_at_nmse");
    uint32_t i = 0;
    for (char *line = strtok_r(NULL, "\n", &rest); line; line = strtok_r(NULL, "\n", &rest), i++) {
        const cost_setting *s = &b->results.settings[i];
        assert_int_equal(split_row(line, row, 64), columns);
        assert_string_equal(row[name], s->name);
        assert_true(strtod(row[ms], NULL) == s->ms);
        assert_true(strtod(row[nmse], NULL) == s->total.nmse);
        assert_true(strtod(row[unlimited], NULL) == s->unlimited.relmse);
        assert_true(strtod(row[equal], NULL) == 57.3 * (1.96 / s->total.nmse));
        assert_int_equal(strtoull(row[device], NULL, 10), s->device_bytes);
        assert_int_equal(atoi(row[front]), s->pareto);
        if (i == 2)
            assert_string_equal(row[psnr], "");
    }
    assert_int_equal(i, b->results.count);
    free(text);
}

/* ---- JSON ---- */

static void the_json_is_strict_and_holds_passes_and_work(void **state) {
    bench *b = *state;
    b->results.settings[3].total.nmse = (double)INFINITY;
    b->results.settings[4].pass_ms[2] = (double)NAN;
    (void)snprintf(b->results.settings[5].name, COST_NAME, "tab\there, \"quotes\", \\ and a cut \xC3");
    write_report(b);
    char *text = file_text(b, "report.json"), wanted[128];
    assert_non_null(text);
    assert_true(json_valid(text));
    assert_false(json_valid("{\"a\": nan}")); /* the check itself can fail */
    assert_false(json_valid("[1,]"));
    assert_non_null(strstr(text, "tab\\u0009here, \\\"quotes\\\", \\\\ and a cut \xEF\xBF\xBD\""));
    const cost_setting *s = &b->results.settings[7];
    (void)snprintf(wanted, sizeof wanted, "\"name\": \"%s\", \"ms\": ", s->pass_names[6]);
    assert_non_null(strstr(text, wanted));
    (void)snprintf(wanted, sizeof wanted, "\"work\": [0, %llu, 0, 0, 0]", (unsigned long long)s->pass_work[6][1]);
    assert_non_null(strstr(text, wanted));
    assert_non_null(strstr(text, "\"path_tracer\": {\"ms\": 57.3, \"nmse\": 1.96, \"relmse\": 2.9}"));
    free(text);
}

/* ---- HTML ---- */

/* Every occurrence of `attribute` must be followed by `start` (without the quote). */
static void only_from(const char *page, const char *attribute, const char *start) {
    uint32_t found = 0;
    for (const char *at = strstr(page, attribute); at; at = strstr(at + 1, attribute), found++)
        if (strncmp(at + strlen(attribute) + 1, start, strlen(start)) != 0)
            fail_msg("%.60s", at);
    assert_int_not_equal(found, 0);
}

static void the_page_loads_nothing_and_has_its_plots(void **state) {
    bench *b = *state;
    write_report(b);
    char *page = file_text(b, "index.html");
    assert_non_null(page);
    only_from(page, " src=", "data:image/png;base64,");
    only_from(page, "xlink:href=", "#");
    assert_null(strstr(page, "<link"));
    assert_null(strstr(page, "@import"));
    assert_null(strstr(page, "url("));
    assert_null(strstr(page, "<script src"));
    assert_null(strstr(page, "rgb(")); /* all of the plots' colours follow the style sheet */
    const char *ids[] = {"plot-nmse", "plot-relmse", "plot-stack", "plot-tracer-nmse", "plot-tracer-relmse"};
    for (size_t i = 0; i < sizeof ids / sizeof ids[0]; i++) {
        char id[64];
        (void)snprintf(id, sizeof id, "<svg id=\"%s\"", ids[i]);
        const char *svg = strstr(page, id);
        assert_non_null(svg);
        assert_non_null(strstr(svg, "</svg>"));
        assert_true(strstr(svg, "<path") < strstr(svg, "</svg>"));
    }
    free(page);
}

static void names_are_text_in_every_language(void **state) {
    bench *b = *state;
    const char *trap = "/tmp/vitrine-trap";
    (void)unlink(trap);
    (void)snprintf(b->results.scene, COST_NAME, "</title><script>alert(1)</script>");
    (void)snprintf(b->results.settings[0].name, COST_NAME, "`>%s`'.\"<b>&", trap);
    (void)snprintf(b->results.settings[2].name, COST_NAME, "</script><i>'\nEOD\nset output");
    (void)snprintf(b->results.settings[2].values, COST_VALUES, "\"><u>");
    (void)snprintf(b->results.settings[0].pass_names[0], 32, "<em>&");
    write_report(b);
    char *page = file_text(b, "index.html"), *json = file_text(b, "report.json");
    assert_non_null(page);
    assert_true(json_valid(json));
    const char *raw[] = {"<script>alert", "<i>'", "<b>&", "<u>", "<em>"};
    for (size_t i = 0; i < sizeof raw / sizeof raw[0]; i++)
        assert_null(strstr(page, raw[i]));
    assert_non_null(strstr(page, "&lt;/title&gt;&lt;script&gt;alert(1)"));
    assert_int_equal(access(trap, F_OK), -1); /* gnuplot ran no command of the name's */
    free(page);
    free(json);
}

static void a_page_of_many_noisy_pictures_stays_below_10_megabytes(void **state) {
    bench *b = *state;
    lab_free(&b->results);
    b->results = lab_results(640, 360);
    for (uint32_t i = 0; i < b->results.count; i++) {
        b->results.settings[i].pareto = true;
        uint32_t seed = i;
        for (size_t k = 0; k < (size_t)640 * 360 * 3; k++)
            b->results.settings[i].image[k] = (float)lab_random(&seed);
    }
    write_report(b);
    char *page = file_text(b, "index.html");
    assert_in_range(strlen(page), 1000000, 10000000);
    free(page);
}

static void results_with_nothing_in_them_make_a_report(void **state) {
    bench *b = *state;
    cost_setting *s = &b->results.settings[0];
    free(s->image);
    const uint32_t count = b->results.count;
    *s = (cost_setting){.name = "default", .knob = "default"};
    b->results.count = 1;
    b->results.path_tracer_ms = 0;
    write_report(b);
    char *page = file_text(b, "index.html");
    assert_non_null(strstr(page, "there is nothing to plot"));
    assert_non_null(strstr(page, "The results hold no images"));
    free(page);
    b->results.count = count;
}

/* ---- failures ---- */

static void a_folder_that_cannot_be_made_gives_one_line(void **state) {
    bench *b = *state;
    char path[128];
    vit_text why = {""};
    path_join(path, sizeof path, b->folder, "file");
    put(path, "");
    path_join(path, sizeof path, b->folder, "file/out");
    assert_int_equal(report_write(&b->results, path, &why), VIT_FAILED);
    assert_non_null(strstr(why.text, "/file/out: cannot make this folder: Not a directory"));
    assert_null(strchr(why.text, '\n'));
}

static void without_gnuplot_the_numbers_are_written_and_the_line_says_what_is_missing(void **state) {
    bench *b = *state;
    char *path = strdup(getenv("PATH"));
    vit_text why = {""};
    assert_int_equal(setenv("PATH", b->folder, 1), 0);
    const vit_status status = report_write(&b->results, b->out, &why);
    assert_int_equal(setenv("PATH", path, 1), 0);
    free(path);
    assert_int_equal(status, VIT_FAILED);
    assert_string_equal(why.text, "gnuplot: not found: the report's plots need it (Debian: gnuplot-nox)");
    char *csv = file_text(b, "report.csv"), *json = file_text(b, "report.json");
    assert_non_null(csv);
    assert_non_null(json);
    assert_null(file_text(b, "index.html"));
    free(csv);
    free(json);
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, set_up, tear_down)

int main(void) {
    const struct CMUnitTest tests[] = {
        TEST(the_csv_reads_back_to_the_same_numbers),
        TEST(the_json_is_strict_and_holds_passes_and_work),
        TEST(the_page_loads_nothing_and_has_its_plots),
        TEST(names_are_text_in_every_language),
        TEST(a_page_of_many_noisy_pictures_stays_below_10_megabytes),
        TEST(results_with_nothing_in_them_make_a_report),
        TEST(a_folder_that_cannot_be_made_gives_one_line),
        TEST(without_gnuplot_the_numbers_are_written_and_the_line_says_what_is_missing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
