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

#include "cost/report_parts.h"
#include "report_lab.h"
#include <png.h>
#include <sys/stat.h>
#include <unistd.h>

typedef struct bench {
    char folder[64], out[96];
    cost_results results;
} bench;

static int set_up(void **state) {
    static bench b;
    (void)snprintf(b.folder, sizeof b.folder, "/tmp/vitrine-report-XXXXXX");
    assert_non_null(mkdtemp(b.folder));
    (void)snprintf(b.out, sizeof b.out, "%s/a/b", b.folder);
    b.results = lab_results(64, 36);
    *state = &b;
    return 0;
}

static int tear_down(void **state) {
    bench *b = *state;
    const char *names[] = {"a/b/report.csv", "a/b/report.json", "a/b/index.html", "a/b", "a", "file"};
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++) {
        char path[160];
        (void)snprintf(path, sizeof path, "%s/%s", b->folder, names[i]);
        (void)remove(path);
    }
    lab_free(&b->results);
    return rmdir(b->folder); /* fails if a temporary file was left behind */
}

/* The whole file, ended with a zero; NULL: there is none. The caller frees it. */
static char *file_text(const bench *b, const char *name) {
    char path[160];
    (void)snprintf(path, sizeof path, "%s/%s", b->out, name);
    FILE *f = fopen(path, "rb");
    if (!f)
        return NULL;
    assert_int_equal(fseek(f, 0, SEEK_END), 0);
    const long size = ftell(f);
    rewind(f);
    char *text = malloc((size_t)size + 1);
    assert_non_null(text);
    assert_int_equal(fread(text, 1, (size_t)size, f), size);
    text[size] = '\0';
    (void)fclose(f);
    return text;
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
        assert_int_equal(atoi(row[front]), s->front);
        if (i == 2)
            assert_string_equal(row[psnr], "");
    }
    assert_int_equal(i, b->results.count);
    free(text);
}

/* ---- JSON ---- */

static const char *json_space(const char *t) {
    return t + strspn(t, " \n\r\t");
}

static const char *json_text(const char *t) {
    if (*t++ != '"')
        return NULL;
    for (; *t != '"'; t++) {
        if ((unsigned char)*t < 0x20)
            return NULL;
        if (*t != '\\')
            continue;
        t++;
        if (*t == 'u' && strspn(t + 1, "0123456789abcdefABCDEF") >= 4)
            t += 4;
        else if (!*t || !strchr("\"\\/bfnrt", *t))
            return NULL;
    }
    return t + 1;
}

static const char *json_number(const char *t) {
    t += *t == '-';
    const size_t whole = strspn(t, "0123456789");
    if (whole == 0 || (whole > 1 && *t == '0'))
        return NULL;
    t += whole;
    if (*t == '.') {
        const size_t digits = strspn(++t, "0123456789");
        if (digits == 0)
            return NULL;
        t += digits;
    }
    if (*t == 'e' || *t == 'E') {
        t++;
        t += *t == '-' || *t == '+';
        const size_t digits = strspn(t, "0123456789");
        if (digits == 0)
            return NULL;
        t += digits;
    }
    return t;
}

/* Past one value as RFC 8259 has it; NULL: it is none. */
static const char *json_value(const char *t) {
    t = json_space(t);
    const char *words[] = {"null", "true", "false"};
    for (int i = 0; i < 3; i++)
        if (strncmp(t, words[i], strlen(words[i])) == 0)
            return t + strlen(words[i]);
    if (*t == '"')
        return json_text(t);
    if (*t != '{' && *t != '[')
        return json_number(t);
    const char end = *t == '{' ? '}' : ']';
    t = json_space(t + 1);
    if (*t == end)
        return t + 1;
    for (;;) {
        if (end == '}') {
            t = json_text(json_space(t));
            t = t ? json_space(t) : NULL;
            if (!t || *t++ != ':')
                return NULL;
        }
        t = json_value(t);
        t = t ? json_space(t) : NULL;
        if (!t || (*t != ',' && *t != end))
            return NULL;
        if (*t++ == end)
            return t;
    }
}

static bool json_valid(const char *text) {
    const char *end = json_value(text);
    return end && *json_space(end) == '\0';
}

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
        b->results.settings[i].front = true;
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
    (void)snprintf(path, sizeof path, "%s/file", b->folder);
    FILE *f = fopen(path, "w");
    assert_non_null(f);
    assert_int_equal(fclose(f), 0);
    (void)snprintf(path, sizeof path, "%s/file/out", b->folder);
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

/* ---- what is derived ---- */

static void prices_say_what_a_knob_buys_and_order_by_it(void **state) {
    const bench *b = *state;
    report_price prices[LAB_SETTINGS];
    const uint32_t count = report_prices(&b->results, REPORT_NMSE, prices);
    assert_int_equal(count, LAB_SETTINGS - 3); /* without the default and two combinations */
    uint32_t of_lanes = 0, of_photons = 0;
    for (uint32_t i = 0; i < count; i++) {
        if (i > 0)
            assert_true(prices[i].kind >= prices[i - 1].kind);
        if (i > 0 && prices[i].kind == REPORT_BUYS && prices[i - 1].kind == REPORT_BUYS)
            assert_true(prices[i].rate <= prices[i - 1].rate);
        if (prices[i].setting == 15)
            of_lanes = i;
        if (prices[i].setting == 2)
            of_photons = i;
    }
    assert_int_equal(prices[of_lanes].kind, REPORT_SAME);
    assert_int_equal(prices[of_photons].kind, REPORT_BUYS);
    assert_true(fabs(prices[of_photons].rate - (0.061 - 0.038) / (41.5 - 22.1)) < 1e-12);
}

static void a_time_within_the_noise_is_no_gain_in_speed(void **state) {
    bench *b = *state;
    report_price prices[LAB_SETTINGS];
    cost_setting *d = &b->results.settings[0], *s = &b->results.settings[1];
    b->results.count = 2;
    s->ms = d->ms - 0.1;
    s->ms_mad = d->ms_mad = 0.05;
    assert_int_equal(report_prices(&b->results, REPORT_NMSE, prices), 1);
    assert_int_equal(prices[0].kind, REPORT_LOSES);
    s->ms = d->ms - 0.3;
    assert_int_equal(report_prices(&b->results, REPORT_NMSE, prices), 1);
    assert_int_equal(prices[0].kind, REPORT_SAVES);
    b->results.count = LAB_SETTINGS;
}

static void labels_hide_no_point_and_not_each_other(void **state) {
    (void)state;
    report_label labels[12];
    report_span avoid[12];
    const report_span inside = {0, 0, 800, 500};
    for (int i = 0; i < 12; i++) { /* a front whose points stand closer than a label is wide or high */
        labels[i] = (report_label){.x = 300 + 14 * i, .y = 200 + 11 * i, .width = 90, .height = 14};
        avoid[i] = (report_span){labels[i].x - 5, labels[i].y - 5, labels[i].x + 5, labels[i].y + 5};
    }
    report_place_labels(labels, 12, avoid, 12, &inside);
    for (int i = 0; i < 12; i++) {
        const report_label *l = &labels[i];
        assert_true(l->left >= 0 && l->top >= 0 && l->left + l->width <= 800 && l->top + l->height <= 500);
        for (int k = 0; k < 12; k++) {
            assert_false(l->left < avoid[k].x1 && avoid[k].x0 < l->left + l->width && l->top < avoid[k].y1 &&
                         avoid[k].y0 < l->top + l->height);
            const report_label *o = &labels[k];
            if (k != i)
                assert_false(l->left < o->left + o->width && o->left < l->left + l->width && l->top < o->top + o->height &&
                             o->top < l->top + l->height);
        }
    }
}

/* ---- pictures ---- */

typedef bool uri_fn(const cost_setting *s, const cost_results *r, const report_pictures *p, FILE *to);

/* Decodes a picture of the report's; the caller frees it. RGB, 3 bytes a pixel. */
static uint8_t *decode(const bench *b, const report_pictures *p, uri_fn *uri) {
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    char *text = NULL;
    size_t length = 0, size = 0;
    FILE *to = open_memstream(&text, &length);
    assert_true(uri(&b->results.settings[0], &b->results, p, to));
    assert_int_equal(fclose(to), 0);
    const char *start = "data:image/png;base64,";
    assert_memory_equal(text, start, strlen(start));
    uint8_t *file = malloc(length);
    uint32_t word = 0;
    for (const char *c = text + strlen(start); *c && *c != '='; c++) {
        const char *digit = strchr(digits, *c);
        assert_non_null(digit);
        word = word << 6 | (uint32_t)(digit - digits);
        const size_t i = (size_t)(c - text) - strlen(start);
        if (i % 4 != 0)
            file[size++] = (uint8_t)(word >> (6 - 2 * (i % 4)));
    }
    png_image image = {.version = PNG_IMAGE_VERSION};
    assert_true(png_image_begin_read_from_memory(&image, file, size));
    image.format = PNG_FORMAT_RGB;
    assert_int_equal(image.width, p->width);
    assert_int_equal(image.height, p->height);
    uint8_t *rgb = malloc(PNG_IMAGE_SIZE(image));
    assert_true(png_image_finish_read(&image, NULL, rgb, 0, NULL));
    free(file);
    free(text);
    return rgb;
}

static void pictures_show_the_frame_and_the_sign_and_size_of_its_error(void **state) {
    bench *b = *state;
    const size_t values = (size_t)b->results.reference.width * b->results.reference.height * 3;
    for (size_t i = 0; i < values; i++) {
        b->results.reference.direct[i] = 0.2;
        b->results.reference.limited[i] = 0.3;
        b->results.settings[0].image[i] = i < 3 ? 1.5f : i < 6 ? 0.0f : 0.5f; /* too bright, too dark, right */
    }
    report_pictures p;
    assert_true(report_pictures_choose(&b->results, &p));
    assert_int_equal(p.settings[0], 0);
    uint8_t *frame = decode(b, &p, report_frame_uri), *with_sign = decode(b, &p, report_signed_uri),
            *squared = decode(b, &p, report_squared_uri);
    const uint8_t frames[] = {255, 255, 255, 0, 0, 0, 188, 188, 188}; /* sRGB of 0.5: 188 */
    assert_memory_equal(frame, frames, 9);
    const report_map signs = report_map_signed(), sizes = report_map_squared();
    assert_memory_equal(with_sign, signs.rgb[REPORT_COLOURS - 1], 3);
    assert_true(with_sign[3] < 60 && with_sign[5] > 90); /* blue */
    assert_memory_equal(with_sign + 6, signs.rgb[REPORT_COLOURS / 2], 3);
    const int mark =
        (int)lround((log10(1 / (0.5 * 0.5)) + 4) / 5 * (REPORT_COLOURS - 1)); /* about: the mean is 0.5 within 0.1 % */
    assert_true(abs(squared[0] - sizes.rgb[mark][0]) < 12);
    assert_memory_equal(squared + 6, sizes.rgb[0], 3);
    free(frame);
    free(with_sign);
    free(squared);
    report_pictures_free(&p);
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
        TEST(prices_say_what_a_knob_buys_and_order_by_it),
        TEST(a_time_within_the_noise_is_no_gain_in_speed),
        TEST(labels_hide_no_point_and_not_each_other),
        TEST(pictures_show_the_frame_and_the_sign_and_size_of_its_error),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
