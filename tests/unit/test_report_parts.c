/* The report's parts that can be wrong without anybody seeing it: what is derived from the results, where labels go, what
 * colours pictures have. Strategy: hand-made cases with known answers; pictures are decoded again and looked at pixel by pixel.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>

#include "report/report_parts.h"
#include "report_lab.h"
#include <png.h>

static int set_up(void **state) {
    static cost_results results;
    results = lab_results(64, 36);
    *state = &results;
    return 0;
}

static int tear_down(void **state) {
    lab_free(*state);
    return 0;
}

/* ---- what is derived ---- */

static void prices_say_what_a_knob_buys_and_order_by_it(void **state) {
    cost_results *r = *state;
    report_price prices[LAB_SETTINGS];
    const uint32_t count = report_prices(r, REPORT_NMSE, prices);
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
    cost_results *r = *state;
    report_price prices[LAB_SETTINGS];
    cost_setting *d = &r->settings[0], *s = &r->settings[1];
    r->count = 2;
    s->ms = d->ms - 0.08; /* twice its standard error: 2 sqrt(2) 1.858 x 0.05 / sqrt(9) = 0.0876 */
    s->ms_mad = d->ms_mad = 0.05;
    assert_int_equal(report_prices(r, REPORT_NMSE, prices), 1);
    assert_int_equal(prices[0].kind, REPORT_LOSES);
    s->ms = d->ms - 0.1;
    assert_int_equal(report_prices(r, REPORT_NMSE, prices), 1);
    assert_int_equal(prices[0].kind, REPORT_SAVES);
    r->count = LAB_SETTINGS;
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

/* Decodes a picture of the report's; the caller frees it. RGB, 3 bytes per pixel. */
static uint8_t *decode(const cost_results *r, const report_pictures *p, uri_fn *uri) {
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    char *text = NULL;
    size_t length = 0, size = 0;
    FILE *to = open_memstream(&text, &length);
    assert_true(uri(&r->settings[0], r, p, to));
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
    cost_results *r = *state;
    const size_t values = (size_t)r->reference.width * r->reference.height * 3;
    for (size_t i = 0; i < values; i++) {
        r->reference.direct[i] = 0.2;
        r->reference.limited[i] = 0.3;
        r->settings[0].image[i] = i < 3 ? 1.5f : i < 6 ? 0.0f : 0.5f; /* too bright, too dark, right */
    }
    report_pictures p;
    assert_true(report_pictures_choose(r, &p));
    assert_int_equal(p.settings[0], 0);
    uint8_t *frame = decode(r, &p, report_frame_uri), *with_sign = decode(r, &p, report_signed_uri),
            *squared = decode(r, &p, report_squared_uri);
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

static void numbers_keep_what_they_mean(void **state) {
    (void)state;
    const struct {
        double value;
        const char *exact, *digits;
    } rows[] = {{0.1, "0.1", "0.100"},
                {1.0 / 3, "0.3333333333333333", "0.333"},
                {0.0099996, "0.0099996", "0.0100"},
                {123456, "123456", "123456"},
                {9.996, "9.996", "10.0"},
                {-0.0512, "-0.0512",
                 "\xE2\x88\x92"
                 "0.0512"},
                {0, "0", "0"},
                {1e-7, "1e-07",
                 "1.00e\xE2\x88\x92"
                 "07"},
                {(double)NAN, "null", "\xE2\x80\x93"},
                {(double)INFINITY, "null", "\xE2\x80\x93"}};
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        char text[2][64] = {"", ""};
        for (int k = 0; k < 2; k++) {
            FILE *to = fmemopen(text[k], sizeof text[k], "w");
            assert_non_null(to);
            if (k == 0)
                text_number(to, rows[i].value, "null");
            else
                text_3digits(to, rows[i].value);
            assert_int_equal(fclose(to), 0);
        }
        assert_string_equal(text[0], rows[i].exact);
        assert_string_equal(text[1], rows[i].digits);
    }
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, set_up, tear_down)

int main(void) {
    const struct CMUnitTest tests[] = {
        TEST(prices_say_what_a_knob_buys_and_order_by_it),
        TEST(a_time_within_the_noise_is_no_gain_in_speed),
        TEST(labels_hide_no_point_and_not_each_other),
        TEST(pictures_show_the_frame_and_the_sign_and_size_of_its_error),
        TEST(numbers_keep_what_they_mean),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
