/* The report's page in a browser: what headless Chromium makes of index.html.
 *
 * Why this is hard: the page's script and style sheet run nowhere else. Strategy: load the page as a user would (from a file,
 * without a network), let the browser print the document after the script has run, and look there for what only the script can
 * have made; let it draw the page, and count pixels of the front's colour, which reaches the plots only through the style
 * sheet. The browser's log must hold no error and nothing refused. Chromium is big, so it is no dependency: without it (package
 * chromium) these tests are skipped. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>

#include "report_lab.h"
#include "test_folder.h"
#include <png.h>

typedef struct bench {
    char folder[64], page[96], log[96], shot[96];
    const char *browser; /* NULL: none */
    cost_results results;
} bench;

static const char *find_browser(void) {
    static const char *const names[] = {"chromium", "chromium-browser", "google-chrome"};
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++) {
        char line[96];
        (void)snprintf(line, sizeof line, "%s --version >/dev/null 2>&1", names[i]);
        if (system(line) == 0)
            return names[i];
    }
    return NULL;
}

static int set_up(void **state) {
    static bench b;
    vit_text why;
    folder_make_temporary(b.folder);
    path_join(b.page, sizeof b.page, b.folder, "index.html");
    path_join(b.log, sizeof b.log, b.folder, "log");
    path_join(b.shot, sizeof b.shot, b.folder, "shot.png");
    b.browser = find_browser();
    b.results = lab_results(80, 45);
    (void)snprintf(b.results.settings[3].name, COST_NAME, "a <b>bold</b> & \"odd\" name");
    if (report_write(&b.results, b.folder, &why) != VIT_OK)
        fail_msg("%s", why.text);
    *state = &b;
    return 0;
}

static int tear_down(void **state) {
    bench *b = *state;
    char line[128];
    lab_free(&b->results);
    (void)snprintf(line, sizeof line, "rm -rf %s", b->folder);
    return system(line);
}

static void needs_browser(const bench *b) {
    if (b->browser)
        return;
    print_message("skipped: no browser (Debian: chromium)\n");
    skip();
}

/* What the browser prints, ended with a zero; its log goes to b->log. The caller frees it. */
static char *browse(const bench *b, const char *options) {
    char line[1024], *text = malloc(1);
    size_t size = 0, got;
    (void)snprintf(line, sizeof line,
                   "timeout 7200 %s --headless --no-sandbox --disable-gpu --hide-scrollbars --enable-logging=stderr "
                   "--user-data-dir=%s/profile %s "
                   "file://%s 2>%s",
                   b->browser, b->folder, options, b->page, b->log);
    FILE *from = popen(line, "r");
    assert_non_null(from);
    do {
        text = realloc(text, size + 65537);
        assert_non_null(text);
        got = fread(text + size, 1, 65536, from);
        size += got;
    } while (got > 0);
    text[size] = '\0';
    assert_int_equal(pclose(from), 0);
    return text;
}

/* Chromium logs what a page's script does wrong and what its policy refuses as CONSOLE lines. */
static void nothing_went_wrong(const bench *b) {
    FILE *f = fopen(b->log, "r");
    char line[1024];
    assert_non_null(f);
    while (fgets(line, sizeof line, f))
        if (strstr(line, "CONSOLE"))
            fail_msg("%s", line);
    (void)fclose(f);
}

static uint32_t count_between(const char *text, const char *from, const char *until, const char *what) {
    const char *at = strstr(text, from), *end = at ? strstr(at, until) : NULL;
    uint32_t count = 0;
    if (!end)
        fail_msg("no %s ... %s", from, until);
    while (at && (at = strstr(at + 1, what)) && at < end)
        count++;
    return count;
}

static void the_script_names_dots_makes_rows_and_fills_choosers(void **state) {
    bench *b = *state;
    needs_browser(b);
    char *page = browse(b, "--dump-dom");
    nothing_went_wrong(b);
    /* Each setting is a dot with a name in both plots, the passes are rows, and all settings can be chosen. */
    assert_int_equal(count_between(page, "<svg id=\"plot-nmse\"", "</svg>", "data-point="), LAB_SETTINGS);
    assert_int_equal(count_between(page, "<svg id=\"plot-relmse\"", "</svg>", "data-point="), LAB_SETTINGS);
    assert_int_equal(count_between(page, "<table id=\"pass-table\"", "</table>", "<tr>"), LAB_PASSES + 2);
    assert_int_equal(count_between(page, "<select id=\"setting\"", "</select>", "<option"), LAB_SETTINGS);
    assert_true(count_between(page, "<select id=\"picture\"", "</select>", "<option") >= 4);
    assert_non_null(strstr(page, "<title>photons 65536\n41.5 ms"));
    assert_non_null(strstr(page, "a &lt;b&gt;bold&lt;/b&gt; &amp; \"odd\" name</option>"));
    assert_non_null(strstr(page, "<svg id=\"plot-stack\""));
    free(page);
}

/* A dot's place along the axis must be its own setting's time, not another's. */
static void each_dot_has_its_own_settings_name(void **state) {
    bench *b = *state;
    needs_browser(b);
    char *page = browse(b, "--dump-dom");
    const char *at = strstr(page, "<svg id=\"plot-nmse\""), *end = at ? strstr(at, "</svg>") : NULL;
    assert_non_null(end);
    double x[LAB_SETTINGS] = {0};
    while ((at = strstr(at, "<use ")) && at < end) {
        const char *place = strstr(at, "translate("), *point = strstr(at, "data-point=\""), *close = strchr(at, '>');
        if (place && point && point < close && place < close)
            x[atoi(point + strlen("data-point=\""))] = strtod(place + strlen("translate("), NULL);
        at = close;
    }
    for (uint32_t i = 0; i < LAB_SETTINGS; i++)
        for (uint32_t k = 0; k < LAB_SETTINGS; k++)
            if (b->results.settings[i].ms < 0.99 * b->results.settings[k].ms && !(x[i] < x[k]))
                fail_msg("settings %u and %u: %g and %g ms, at %g and %g", i, k, b->results.settings[i].ms,
                         b->results.settings[k].ms, x[i], x[k]);
    free(page);
}

static void the_table_of_settings_is_sorted_by_time(void **state) {
    bench *b = *state;
    needs_browser(b);
    char *page = browse(b, "--dump-dom");
    const char *at = strstr(page, "<table id=\"settings\""), *end = at ? strstr(at, "</table>") : NULL;
    assert_non_null(end);
    assert_int_equal(count_between(at, "<thead>", "</thead>", "<button"), 19);
    double before = 0;
    uint32_t rows = 0;
    while ((at = strstr(at, "<tr data-setting=\"")) && at < end) {
        at += strlen("<tr data-setting=\"");
        const double ms = b->results.settings[atoi(at)].ms;
        assert_true(ms >= before);
        before = ms;
        rows++;
    }
    assert_int_equal(rows, LAB_SETTINGS);
    free(page);
}

/* Pixels of exactly this colour in the browser's picture of the page. */
static size_t pixels_of(const bench *b, uint8_t red, uint8_t green, uint8_t blue) {
    png_image image = {.version = PNG_IMAGE_VERSION};
    assert_true(png_image_begin_read_from_file(&image, b->shot));
    image.format = PNG_FORMAT_RGB;
    uint8_t *rgb = malloc(PNG_IMAGE_SIZE(image));
    assert_true(png_image_finish_read(&image, NULL, rgb, 0, NULL));
    size_t count = 0;
    for (size_t i = 0; i < PNG_IMAGE_SIZE(image); i += 3)
        count += rgb[i] == red && rgb[i + 1] == green && rgb[i + 2] == blue;
    free(rgb);
    return count;
}

static void the_plots_have_the_style_sheets_colours_in_the_light_and_in_the_dark(void **state) {
    bench *b = *state;
    needs_browser(b);
    char options[256];
    (void)snprintf(options, sizeof options, "--window-size=1200,2200 --screenshot=%s", b->shot);
    free(browse(b, options));
    assert_true(pixels_of(b, 0x1b, 0x6c, 0xb0) > 1000); /* --c5, the front */
    assert_true(pixels_of(b, 255, 255, 255) > 1000000);
    (void)snprintf(options, sizeof options, "--blink-settings=preferredColorScheme=0 --window-size=1200,2200 --screenshot=%s",
                   b->shot);
    free(browse(b, options));
    assert_true(pixels_of(b, 0x6f, 0xb3, 0xf2) > 1000);
    assert_true(pixels_of(b, 0x13, 0x16, 0x1b) > 1000000);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_script_names_dots_makes_rows_and_fills_choosers),
        cmocka_unit_test(each_dot_has_its_own_settings_name),
        cmocka_unit_test(the_table_of_settings_is_sorted_by_time),
        cmocka_unit_test(the_plots_have_the_style_sheets_colours_in_the_light_and_in_the_dark),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
