/* Pictures of the sky: where each direction's light comes from, that none is lost on the way from longitude and latitude to the
 * octahedral square, that the square's edges do not show, and that directions are chosen as they shine. Truths are sums over
 * the picture in double. */
#include "light/sky.h"
#include "test_folder.h"

#include <stdbool.h>
#include <math.h>

#define PI 3.14159265358979
enum { WIDE = 128, HIGH = 64 };

typedef struct picture {
    float rgb[3 * WIDE * HIGH];
} picture;

static float *at(picture *p, int x, int y) {
    return p->rgb + 3 * (y * WIDE + x);
}

static void fill(picture *p, float value) {
    for (int i = 0; i < 3 * WIDE * HIGH; i++)
        p->rgb[i] = value;
}

static environment make(const picture *p, double rotate) {
    environment s;
    vit_text why = {""};
    if (sky_from_texels(p->rgb, WIDE, HIGH, rotate, &s, &why) != VIT_OK)
        fail_msg("%s", why.text);
    return s;
}

/* The direction of the middle of a texel, by the words of sky.h. */
static vec3 direction(double x, double y) {
    const double angle = 2 * PI * ((x + 0.5) / WIDE - 0.5), from_top = PI * (y + 0.5) / HIGH;
    return (vec3){(float)(sin(from_top) * sin(angle)), (float)cos(from_top), (float)(-sin(from_top) * cos(angle))};
}

static double exact_power(picture *p, int channel) {
    double sum = 0;
    for (int y = 0; y < HIGH; y++)
        for (int x = 0; x < WIDE; x++)
            sum += (double)at(p, x, y)[channel] * (cos(PI * y / HIGH) - cos(PI * (y + 1) / HIGH)) * 2 * PI / WIDE;
    return sum;
}

/* By an even walk over the sphere. */
static double looked_up_power(const environment *s, int channel) {
    enum { STEPS = 1 << 20 };
    double sum = 0;
    for (int i = 0; i < STEPS; i++) {
        const double z = 1 - 2 * (i + 0.5) / STEPS, a = i * 2.39996322972865332, r = sqrt(1 - z * z);
        const vec3 c = sky_radiance(s, (vec3){(float)(r * cos(a)), (float)z, (float)(r * sin(a))});
        sum += (double)(channel == 0 ? c.x : channel == 1 ? c.y : c.z);
    }
    return sum / STEPS * 4 * PI;
}

static void close_to(double is, double should, double within) {
    if (!(fabs(is / should - 1.0) <= within))
        fail_msg("%.9g should be %.9g within %g", is, should, within);
}

static float noise(uint32_t i) {
    return unit_float(pcg(i));
}

static void a_smooth_picture_is_seen_where_it_is(void **state) {
    (void)state;
    picture p;
    for (int y = 0; y < HIGH; y++)
        for (int x = 0; x < WIDE; x++) { /* linear in the direction */
            const vec3 d = direction(x, y);
            at(&p, x, y)[0] = 2 + d.x;
            at(&p, x, y)[1] = 2 + d.y;
            at(&p, x, y)[2] = 2 + d.z;
        }
    static const double turns[] = {0, 90, -37.5};
    for (int k = 0; k < 3; k++) {
        const double a = turns[k] * PI / 180;
        environment s = make(&p, turns[k]);
        double worst = 0;
        for (int i = 0; i < 5000; i++) {
            const double y = 2 * noise(3u * (uint32_t)i) - 1.0, b = 2 * PI * (double)noise(3u * (uint32_t)i + 1),
                         r = sqrt(1 - y * y);
            const vec3 d = {(float)(r * cos(b)), (float)y, (float)(r * sin(b))}, c = sky_radiance(&s, d);
            /* What is seen in direction d is what the picture has where d was before the turn about y. */
            const double x = (double)d.x * cos(a) - (double)d.z * sin(a), z = (double)d.x * sin(a) + (double)d.z * cos(a);
            worst = fmax(worst, fmax(fabs((double)c.x - 2 - x), fmax(fabs((double)c.y - 2 - y), fabs((double)c.z - 2 - z))));
        }
        print_message("turned by %g: %.4f off at most\n", turns[k], worst);
        assert_true(worst < 0.03); /* a texel of the picture is 0.05 wide */
        sky_free(&s);
    }
}

static void no_light_is_lost(void **state) {
    (void)state;
    picture p;
    for (uint32_t i = 0; i < 3 * WIDE * HIGH; i++)
        p.rgb[i] = noise(i) * (i % 7 == 0 ? 20.0f : 1.0f);
    environment s = make(&p, 20);
    for (int k = 0; k < 3; k++) {
        close_to(s.irradiance[k], exact_power(&p, k), 1e-5);
        close_to(looked_up_power(&s, k), exact_power(&p, k), 0.005);
    }
    sky_free(&s);
}

static void a_sun_of_one_texel_keeps_its_power_and_place_anywhere(void **state) {
    (void)state;
    static const int places[][2] = {{5, 0}, {64, 1}, {17, 13}, {127, 31}, {0, 32}, {90, 47}, {33, 63}};
    for (size_t i = 0; i < sizeof places / sizeof *places; i++) {
        picture p;
        fill(&p, 0);
        at(&p, places[i][0], places[i][1])[1] = 1e4f;
        environment s = make(&p, 0);
        close_to(s.irradiance[1], exact_power(&p, 1), 1e-5);
        close_to(looked_up_power(&s, 1), exact_power(&p, 1), 0.005);
        const vec3 sun = direction(places[i][0], places[i][1]);
        double mean[3] = {0};
        vit_light_sample sets[VIT_PATTERNS * 16];
        sky_sets(&s, 16, sets);
        for (int k = 0; k < VIT_PATTERNS * 16; k++)
            for (int c = 0; c < 3; c++)
                mean[c] += (double)sets[k].power[1] * (double)sets[k].position[c] / exact_power(&p, 1) / VIT_PATTERNS;
        const double off = fabs(mean[0] - (double)sun.x) + fabs(mean[1] - (double)sun.y) + fabs(mean[2] - (double)sun.z);
        if (!(off < 0.08)) /* texels of the square are 0.06 wide */
            fail_msg("sun %zu seems to be %.3f off", i, off);
        sky_free(&s);
    }
}

/* Over the square's edges, where z < 0 and x or y is 0, and at its corners, -z. */
static void edges_of_the_square_do_not_show(void **state) {
    (void)state;
    picture p;
    for (uint32_t i = 0; i < 3 * WIDE * HIGH; i++)
        p.rgb[i] = noise(i);
    environment s = make(&p, 0);
    double worst = 0, range = 0;
    for (int i = 0; i < 2000; i++) {
        const float a = (float)(PI / 2 + PI * (i + 0.5) / 2000), tiny = 1e-5f;
        const bool flat = i % 2;
        const vec3 d = {flat ? cosf(a + 1.5707963f) : tiny, flat ? tiny : cosf(a + 1.5707963f),
                        -fabsf(sinf(a + 1.5707963f)) - tiny};
        const vec3 e = {flat ? d.x : -tiny, flat ? -tiny : d.y, d.z};
        const vec3 c = sky_radiance(&s, vec3_unit(d)), f = sky_radiance(&s, vec3_unit(e));
        worst = fmax(worst, fabs((double)c.x - (double)f.x));
        range = fmax(range, fabs((double)c.x - 0.5));
    }
    print_message("over edges %.5f, range %.2f\n", worst, range);
    assert_true(range > 0.2);
    assert_true(worst < 2e-3);
    sky_free(&s);
}

static void directions_follow_radiance_and_give_back_all_of_it(void **state) {
    (void)state;
    picture p;
    for (int y = 0; y < HIGH; y++)
        for (int x = 0; x < WIDE; x++)
            for (int k = 0; k < 3; k++)
                at(&p, x, y)[k] = y < HIGH / 2 ? 1.0f + (float)(x / 16) : 0.0f;
    environment s = make(&p, 0);
    for (uint32_t samples = 1; samples <= 64; samples *= 8) {
        vit_light_sample *sets = calloc(VIT_PATTERNS * samples, sizeof *sets);
        assert_non_null(sets);
        sky_sets(&s, samples, sets);
        double up = 0;
        for (uint32_t k = 0; k < VIT_PATTERNS; k++) {
            double power = 0;
            for (uint32_t i = 0; i < samples; i++) {
                const vit_light_sample *e = sets + k * samples + i;
                const double l =
                    sqrt((double)e->position[0] * (double)e->position[0] + (double)e->position[1] * (double)e->position[1] +
                         (double)e->position[2] * (double)e->position[2]);
                assert_true(fabs(l - 1) < 1e-5 && e->radius2 == 0.0f && e->normal[0] == 0.0f);
                assert_true(e->position[1] > -0.08f);
                power += (double)e->power[0];
                up += (double)e->power[0] * (double)e->position[1] / VIT_PATTERNS;
            }
            close_to(power, s.irradiance[0], 1e-5); /* grey: whichever directions are chosen */
        }
        close_to(up, PI * 4.5, samples == 1 ? 0.05 : 0.01); /* on the ground: the mean of radiances 1 to 8 */
        free(sets);
    }
    sky_free(&s);
}

static void a_sky_without_a_picture_is_even(void **state) {
    (void)state;
    static const double radiance[3] = {1, 2, 3};
    vit_light_sample sets[VIT_PATTERNS * 16];
    environment s;
    sky_constant(radiance, &s);
    sky_sets(&s, 16, sets);
    for (int k = 0; k < VIT_PATTERNS; k++) {
        double mean[3] = {0}, power = 0;
        for (int i = 0; i < 16; i++) {
            power += (double)sets[16 * k + i].power[2];
            for (int c = 0; c < 3; c++)
                mean[c] += (double)sets[16 * k + i].position[c] / 16;
        }
        close_to(power, 4 * PI * 3, 1e-5);
        assert_true(fabs(mean[0]) < 0.15 && fabs(mean[1]) < 0.15 &&
                    fabs(mean[2]) < 0.15); /* of random ones the worst is 0.35 off */
    }
    assert_true(sky_radiance(&s, (vec3){0, 1, 0}).y == 2.0f);
    sky_free(&s);
}

/* ---- files ---- */

static const char *write_file(const void *bytes, size_t size) {
    static char path[64];
    (void)snprintf(path, sizeof path, "/tmp/vitrine-sky-%ld", (long)getpid());
    put_bytes(path, bytes, size);
    return path;
}

/* A Radiance picture of plain texels with lines of the header's; rgbe: 4 bytes. Returns its size. */
static size_t hdr_with(const char *lines, uint8_t *bytes, int width, int height, const uint8_t rgbe[4]) {
    size_t n = (size_t)sprintf((char *)bytes, "#?RADIANCE\n%sFORMAT=32-bit_rle_rgbe\n\n-Y %d +X %d\n", lines, height, width);
    for (int i = 0; i < width * height; i++, n += 4)
        memcpy(bytes + n, rgbe, 4);
    return n;
}

static size_t hdr(uint8_t *bytes, int width, int height, const uint8_t rgbe[4]) {
    return hdr_with("", bytes, width, height, rgbe);
}

/* Radiance is what a texel says divided by every EXPOSURE and COLORCORR of the header. */
static void a_pictures_exposure_is_taken_back(void **state) {
    (void)state;
    static uint8_t bytes[8192];
    vit_text why;
    environment s;
    const size_t n = hdr_with("EXPOSURE=4\nVIEW= -vtv\nEXPOSURE= 0.5\nCOLORCORR=1 2 0.25\n", bytes, 4, 2,
                              (const uint8_t[]){128, 128, 128, 132});
    assert_int_equal(sky_load(write_file(bytes, n), 1, 0, &s, &why), VIT_OK);
    const vec3 c = sky_radiance(&s, (vec3){0.6f, 0.0f, -0.8f});
    close_to((double)c.x, 4.0, 1e-5);
    close_to((double)c.y, 2.0, 1e-5);
    close_to((double)c.z, 16.0, 1e-5);
    sky_free(&s);
}

static void radiance_and_targa_files_are_read(void **state) {
    (void)state;
    static uint8_t bytes[8192];
    vit_text why;
    environment s;
    /* 0.5 * 2^3, 0.25 * 2^3, 0: (c + 0.0) / 256 * 2^(e - 128). */
    size_t n = hdr(bytes, 4, 2, (const uint8_t[]){128, 64, 0, 131});
    assert_int_equal(sky_load(write_file(bytes, n), 0.5, 0, &s, &why), VIT_OK);
    const vec3 c = sky_radiance(&s, (vec3){0.6f, 0.0f, -0.8f});
    close_to((double)c.x, 2.0, 1e-5);
    close_to((double)c.y, 1.0, 1e-5);
    assert_true(c.z == 0.0f);
    sky_free(&s);
    /* 8 bits are sRGB: 188 is 0.5029. */
    memset(bytes, 0, sizeof bytes);
    bytes[2] = 2;
    bytes[12] = 4;
    bytes[14] = 2;
    bytes[16] = 24;
    memset(bytes + 18, 188, 24);
    assert_int_equal(sky_load(write_file(bytes, 18 + 24), 3, 0, &s, &why), VIT_OK);
    close_to((double)sky_radiance(&s, (vec3){0, 1, 0}).x, 3 * 0.50289, 1e-3);
    sky_free(&s);
}

static void refused(const char *path, double scale, const char *what) {
    vit_text why = {""};
    environment s;
    assert_int_equal(sky_load(path, scale, 0, &s, &why), VIT_BAD_INPUT);
    if (!strstr(why.text, what) || !strstr(why.text, path) || strchr(why.text, '\n'))
        fail_msg("'%s' does not say '%s'", why.text, what);
    assert_null(s.texels);
}

static void bad_pictures_are_told_by_name(void **state) {
    (void)state;
    static uint8_t bytes[8192];
    refused("/nonexistent/sky.hdr", 1, "is not there");
    refused(write_file("#?RADIANCE\nnothing", 18), 1, "is not an image");
    refused(write_file(bytes, hdr(bytes, 6, 2, (const uint8_t[]){128, 128, 128, 128})), 1, "twice as wide");
    refused(write_file(bytes, hdr(bytes, 4, 2, (const uint8_t[]){128, 128, 128, 200})), 1, "0..1e12");
    refused(write_file(bytes, hdr(bytes, 4, 2, (const uint8_t[]){128, 128, 128, 128})), 1e14, "0..1e12");
    refused(write_file(bytes, hdr_with("EXPOSURE=0\n", bytes, 4, 2, (const uint8_t[]){128, 128, 128, 128})), 1, "EXPOSURE");
    refused(write_file(bytes, hdr_with("COLORCORR=1 2\n", bytes, 4, 2, (const uint8_t[]){128, 128, 128, 128})), 1, "COLORCORR");
    refused(write_file(bytes, hdr(bytes, 4, 2, (const uint8_t[]){128, 128, 128, 128}) - 4), 1, "cut short");
    const char runs[] =
        "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 2 +X 4\n\x80\x80\x80\x80\x01\x01\x01\x07"; /* one texel, seven more like it */
    refused(write_file(runs, sizeof runs - 1), 1, "run lengths of the old kind");
    const char huge[] = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 8192 +X 16384\n";
    refused(write_file(huge, sizeof huge - 1), 1, "2^25 texels");
    const char cut[] = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1024 +X 2048\n";
    refused(write_file(cut, sizeof cut - 1), 1, "is broken");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_smooth_picture_is_seen_where_it_is),
        cmocka_unit_test(no_light_is_lost),
        cmocka_unit_test(a_sun_of_one_texel_keeps_its_power_and_place_anywhere),
        cmocka_unit_test(edges_of_the_square_do_not_show),
        cmocka_unit_test(directions_follow_radiance_and_give_back_all_of_it),
        cmocka_unit_test(a_sky_without_a_picture_is_even),
        cmocka_unit_test(a_pictures_exposure_is_taken_back),
        cmocka_unit_test(radiance_and_targa_files_are_read),
        cmocka_unit_test(bad_pictures_are_told_by_name),
    };
    const int failed = cmocka_run_group_tests(tests, NULL, NULL);
    char path[64];
    (void)snprintf(path, sizeof path, "/tmp/vitrine-sky-%ld", (long)getpid());
    (void)unlink(path);
    return failed;
}
