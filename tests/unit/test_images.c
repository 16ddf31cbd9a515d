/* Kinds of pictures that their decoder reads only with help, or that mean nothing without a word on it. Each is written here:
 * BMP and JPEG byte by byte (a JPEG of one block of one colour, whose only coefficient is 8 times the sample: T.81, A.3.3), PNG
 * by libpng. Right is worked out by hand. */
#define FOLDER VIT_BUILD_DIR "/tests/unit/images"
#include "case_model.h"
#include "import/image_head.h"
#include "light/sky.h"
#include <png.h>

/* The file as the texture of a triangle, which must be there. */
static void import_picture(const char *name, model *m) {
    char mtl[256];
    (void)snprintf(mtl, sizeof mtl, "newmtl m\nKd 1 1 1\nmap_Kd %s\n", name);
    put_obj(mtl);
    import_good(FILE_OF("quad.obj"), m);
    if (m->image_count != 1)
        fail_msg("%s", warnings);
}

static void refuse_picture(const char *name, const char *what) {
    char mtl[256];
    model m;
    (void)snprintf(mtl, sizeof mtl, "newmtl m\nKd 1 1 1\nmap_Kd %s\n", name);
    put_obj(mtl);
    import_good(FILE_OF("quad.obj"), &m);
    if (!strstr(warnings, what))
        fail_msg("no '%s' in '%s'", what, warnings);
    assert_int_equal(m.image_count, 0);
    model_free(&m);
    refuse(FILE_OF("quad.obj"), true, what);
}

static void texel_is(const model *m, int x, int y, int r, int g, int b, int a) {
    const int want[4] = {r, g, b, a};
    const uint8_t *got = m->images[0].rgba + 4 * (y * m->images[0].width + x);
    for (int k = 0; k < 4; k++)
        if (abs(got[k] - want[k]) > 1)
            fail_msg("(%d, %d): %d %d %d %d, not %d %d %d %d", x, y, got[0], got[1], got[2], got[3], r, g, b, a);
}

/* ---- BMP ---- */

static void rows_of_a_bmp_may_begin_at_the_top(void **state) {
    uint8_t bmp[54 + 8] = {'B', 'M', 62, 0, 0, 0, 0, 0, 0, 0, 54, 0, 0, 0, 40, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 1, 0, 24};
    model m;
    (void)state;
    bmp[54 + 2] = 255; /* BGR: the file's first row is red, its second blue */
    bmp[58] = 255;
    for (int top = 0; top < 2; top++) {
        const int32_t height = top ? -2 : 2;
        for (int k = 0; k < 4; k++)
            bmp[22 + k] = (uint8_t)((uint32_t)height >> (8 * k));
        put_bytes(FILE_OF("p.bmp"), bmp, sizeof bmp - 2);
        refuse_picture("p.bmp", "is cut short");
        put_bytes(FILE_OF("p.bmp"), bmp, sizeof bmp - 1); /* a pixel and the row's filling but for its last byte */
        import_picture("p.bmp", &m);
        model_free(&m);
        put_bytes(FILE_OF("p.bmp"), bmp, sizeof bmp);
        import_picture("p.bmp", &m);
        assert_string_equal(warnings, "");
        assert_true(m.images[0].width == 1 && m.images[0].height == 2);
        texel_is(&m, 0, top ? 0 : 1, 255, 0, 0, 255);
        texel_is(&m, 0, top ? 1 : 0, 0, 0, 255, 255);
        model_free(&m);
    }
}

static void case_bmp_top_down(void **state) {
    model m;
    (void)state;
    (void)import_case("bmp-top-down/tri.obj", &m);
    assert_string_equal(warnings, "");
    texel_is(&m, 0, 0, 255, 0, 0, 255);
    texel_is(&m, 0, 1, 0, 0, 255, 255);
    model_free(&m);
}

static void a_bmp_with_run_lengths_is_told(void **state) {
    uint8_t bmp[54 + 8] = {'B', 'M', 62, 0, 0, 0, 0, 0, 0, 0, 54, 0, 0, 0, 40, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 8, 0, 1};
    (void)state;
    put_bytes(FILE_OF("p.bmp"), bmp, sizeof bmp);
    refuse_picture("p.bmp", "is a BMP with run lengths");
}

/* ---- TGA ---- */

/* Two by two pixels, red and green over blue and white, in any order, packed or not. The last byte of the head says from which
 * corner the file goes: 0x10 the right, 0x20 the top. */
static void a_tga_may_begin_at_any_corner(void **state) {
    static const uint8_t bgr[4][3] = {{0, 0, 255}, {0, 255, 0}, {255, 0, 0}, {255, 255, 255}};
    (void)state;
    for (unsigned k = 0; k < 8; k++) {
        const bool right = k & 1, top = k & 2, packed = k & 4;
        uint8_t tga[18 + 16] = {0, 0, packed ? 10 : 2, 0, 0, 0, 0, 0, 0, 0, 0, 0, 2, 0, 2, 0, 24};
        size_t size = 18;
        model m;
        tga[17] = (uint8_t)((right ? 0x10 : 0) | (top ? 0x20 : 0));
        for (unsigned i = 0; i < 4; i++) {
            const unsigned x = i % 2 ^ (right ? 1 : 0), y = i / 2 ^ (top ? 0 : 1);
            if (packed)
                tga[size++] = 0x80; /* a run of one */
            memcpy(tga + size, bgr[2 * y + x], 3);
            size += 3;
        }
        put_bytes(FILE_OF("p.tga"), tga, size);
        import_picture("p.tga", &m);
        assert_string_equal(warnings, "");
        for (int i = 0; i < 4; i++)
            texel_is(&m, i % 2, i / 2, bgr[i][2], bgr[i][1], bgr[i][0], 255);
        model_free(&m);
        put_bytes(FILE_OF("p.tga"), tga, size - 1);
        refuse_picture("p.tga", "is cut short");
    }
}

/* ---- JPEG ---- */

typedef struct bits {
    uint8_t *to;
    size_t size;
    unsigned held, count;
} bits;

static void put_bits(bits *b, unsigned value, unsigned count) {
    while (count-- > 0) {
        b->held = b->held << 1 | (value >> count & 1u);
        if (++b->count == 8) {
            b->to[b->size++] = (uint8_t)b->held;
            if ((b->held & 255u) == 255u)
                b->to[b->size++] = 0;
            b->count = 0;
        }
    }
}

static size_t put_segment(uint8_t *to, size_t at, int marker, const uint8_t *bytes, size_t size) {
    const uint8_t head[4] = {0xff, (uint8_t)marker, (uint8_t)((size + 2) >> 8), (uint8_t)(size + 2)};
    memcpy(to + at, head, 4);
    memcpy(to + at + 4, bytes, size);
    return at + 4 + size;
}

/* p.jpg: 8 x 8 of one colour; adobe: transform of the Adobe marker, -1: none. frame: SOF marker. */
static void put_jpeg(const uint8_t *samples, int channels, int adobe, int frame) {
    uint8_t file[1024] = {0xff, 0xd8}, part[128] = {'A', 'd', 'o', 'b', 'e', 0, 100, 0, 0, 0, 0, (uint8_t)adobe};
    size_t at = adobe >= 0 ? put_segment(file, 2, 0xee, part, 12) : 2;
    memset(part, 1, 65);
    part[0] = 0;
    at = put_segment(file, at, 0xdb, part, 65); /* quantisation by 1 */
    memset(part, 0, sizeof part);
    part[4] = 12; /* lengths of DC codes: 12 of 4 bits, for 0 to 11 */
    for (int i = 0; i < 12; i++)
        part[17 + i] = (uint8_t)i;
    at = put_segment(file, at, 0xc4, part, 29);
    memset(part, 0, sizeof part);
    part[0] = 0x10;
    part[1] = 1; /* AC: "0" ends the block */
    at = put_segment(file, at, 0xc4, part, 18);
    uint8_t start[32] = {8, 0, 8, 0, 8, (uint8_t)channels}, scan[16] = {(uint8_t)channels};
    for (int i = 0; i < channels; i++) {
        start[6 + 3 * i] = scan[1 + 2 * i] = (uint8_t)(i + 1);
        start[7 + 3 * i] = 0x11;
    }
    scan[2 + 2 * channels] = 63;
    at = put_segment(file, at, frame, start, 6 + 3 * (size_t)channels);
    at = put_segment(file, at, 0xda, scan, 4 + 2 * (size_t)channels);
    bits b = {.to = file, .size = at};
    for (int i = 0; i < channels; i++) {
        const int dc = 8 * (samples[i] - 128);
        unsigned length = 0;
        while (abs(dc) >> length)
            length++;
        put_bits(&b, length, 4);
        put_bits(&b, (unsigned)(dc >= 0 ? dc : dc + (1 << length) - 1), length);
        put_bits(&b, 0, 1);
    }
    put_bits(&b, 127, 7);
    file[b.size++] = 0xff;
    file[b.size++] = 0xd9;
    put_bytes(FILE_OF("p.jpg"), file, b.size);
}

/* Adobe's CMYK holds 255 - ink; YCCK's first three are CMY as Y, Cb, Cr of their complement. */
static void channels_of_a_jpeg_are_what_its_adobe_marker_says(void **state) {
    static const struct {
        uint8_t samples[4];
        int channels, adobe, r, g, b;
    } rows[] = {{{200, 128, 128}, 3, -1, 200, 200, 200},   {{200, 128, 128}, 3, 1, 200, 200, 200},
                {{200, 100, 50}, 3, 0, 200, 100, 50},      {{90}, 1, -1, 90, 90, 90},
                {{255, 128, 0, 255}, 4, 0, 255, 128, 0},   {{255, 255, 100, 51}, 4, 0, 51, 51, 20},
                {{55, 128, 128, 255}, 4, 2, 200, 200, 200}};
    model m;
    (void)state;
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        put_jpeg(rows[i].samples, rows[i].channels, rows[i].adobe, 0xc0);
        import_picture("p.jpg", &m);
        assert_string_equal(warnings, "");
        texel_is(&m, 3, 3, rows[i].r, rows[i].g, rows[i].b, 255);
        model_free(&m);
    }
}

static void a_jpeg_that_cannot_be_read_right_is_told(void **state) {
    static const uint8_t ink[4] = {255, 128, 0, 255};
    (void)state;
    put_jpeg(ink, 4, -1, 0xc0);
    refuse_picture("p.jpg", "four channels that does not say which (no Adobe marker): save it as RGB");
    put_jpeg(ink, 3, -1, 0xc9);
    refuse_picture("p.jpg", "a kind that is not read (arithmetic");
}

static void a_jpeg_without_its_end_is_told(void **state) {
    static const uint8_t grey[1] = {90};
    uint8_t bytes[1024];
    (void)state;
    put_jpeg(grey, 1, -1, 0xc0);
    FILE *file = fopen(FILE_OF("p.jpg"), "rb");
    assert_non_null(file);
    const size_t size = fread(bytes, 1, sizeof bytes, file);
    assert_int_equal(fclose(file), 0);
    put_bytes(FILE_OF("p.jpg"), bytes, size - 2);
    refuse_picture("p.jpg", "is cut short");
}

/* ---- PNG ---- */

typedef struct png_kind {
    int bits, color, interlace;
    double gamma; /* 0: none */
    bool srgb, palette;
} png_kind;

/* Rows as libpng takes them. */
static void put_png(const char *path, int width, int height, const png_kind *kind, png_bytep *rows) {
    static const png_color colors[3] = {{255, 0, 0}, {0, 255, 0}, {0, 0, 255}};
    static const png_byte alphas[2] = {255, 51};
    FILE *file = fopen(path, "wb");
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, NULL, NULL, NULL);
    png_infop info = png ? png_create_info_struct(png) : NULL;
    assert_true(file && info);
    png_init_io(png, file);
    png_set_IHDR(png, info, (png_uint_32)width, (png_uint_32)height, kind->bits, kind->color, kind->interlace,
                 PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    if (kind->palette) {
        png_set_PLTE(png, info, colors, 3);
        png_set_tRNS(png, info, alphas, 2, NULL);
    }
    if (kind->gamma > 0.0)
        png_set_gAMA(png, info, kind->gamma);
    if (kind->srgb)
        png_set_sRGB(png, info, PNG_sRGB_INTENT_PERCEPTUAL);
    png_set_rows(png, info, rows);
    png_write_png(png, info, PNG_TRANSFORM_IDENTITY, NULL);
    png_destroy_write_struct(&png, &info);
    assert_int_equal(fclose(file), 0);
}

static void a_png_may_be_interlaced(void **state) {
    enum { SIDE = 9 };
    static png_byte texels[SIDE][3 * SIDE];
    png_bytep rows[SIDE];
    model m;
    (void)state;
    for (int y = 0; y < SIDE; y++) {
        rows[y] = texels[y];
        for (int x = 0; x < SIDE; x++) {
            texels[y][3 * x] = (png_byte)(20 * x);
            texels[y][3 * x + 1] = (png_byte)(20 * y);
        }
    }
    put_png(FILE_OF("p.png"), SIDE, SIDE, &(png_kind){8, PNG_COLOR_TYPE_RGB, PNG_INTERLACE_ADAM7, 0, false, false}, rows);
    import_picture("p.png", &m);
    for (int i = 0; i < SIDE * SIDE; i++)
        texel_is(&m, i % SIDE, i / SIDE, 20 * (i % SIDE), 20 * (i / SIDE), 0, 255);
    model_free(&m);
}

static void a_palette_may_be_transparent(void **state) {
    png_byte row[1] = {0 << 6 | 1 << 4 | 2 << 2}; /* two bits each */
    png_bytep rows[1] = {row};
    model m;
    (void)state;
    put_png(FILE_OF("p.png"), 3, 1, &(png_kind){2, PNG_COLOR_TYPE_PALETTE, PNG_INTERLACE_NONE, 0, false, true}, rows);
    import_picture("p.png", &m);
    texel_is(&m, 0, 0, 255, 0, 0, 255);
    texel_is(&m, 1, 0, 0, 255, 0, 51);
    texel_is(&m, 2, 0, 0, 0, 255, 255);
    model_free(&m);
}

static void a_gamma_that_is_not_srgbs_is_told(void **state) {
    static const struct {
        double gamma;
        bool srgb, told;
    } kinds[] = {{0.45455, false, false}, {1.0, false, true}, {0.45455, true, false}, {0, false, false}};
    png_byte row[3] = {10, 20, 30};
    png_bytep rows[1] = {row};
    model m;
    (void)state;
    for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++) {
        put_png(FILE_OF("p.png"), 1, 1,
                &(png_kind){8, PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE, kinds[i].gamma, kinds[i].srgb, false}, rows);
        import_picture("p.png", &m);
        assert_int_equal(strstr(warnings, "states a gamma of 1; it is taken as sRGB") != NULL, kinds[i].told);
        texel_is(&m, 0, 0, 10, 20, 30, 255);
        model_free(&m);
        if (kinds[i].told)
            refuse(FILE_OF("quad.obj"), true, "states a gamma that is not sRGB's");
    }
}

/* libpng writes no such file: gAMA of 1, then sRGB. */
static void srgb_goes_before_gamma(void **state) {
    uint8_t png[] = "\x89PNG\r\n\x1a\n\0\0\0\4gAMA\0\1\x86\xa0....\0\0\0\1sRGB\0....\0\0\0\0IDAT....";
    (void)state;
    assert_true(image_head_gamma(png, sizeof png - 1) == 0.0);
    memcpy(png + 28, "tEXt", 4);
    assert_true(image_head_gamma(png, sizeof png - 1) == 1.0);
    for (size_t cut = 0; cut < sizeof png; cut++) /* nothing is read beyond */
        (void)image_head_gamma(png, cut);
}

/* ---- the sky ---- */

/* Codes 0x0180 are between 8-bit codes 1 and 2: 384/65535/12.92 of sRGB's line. */
static void a_sky_of_16_bits_keeps_them(void **state) {
    png_byte row[12] = {1, 0x80, 1, 0x80, 1, 0x80, 1, 0x80, 1, 0x80, 1, 0x80};
    png_bytep rows[1] = {row};
    vit_text why;
    environment s;
    (void)state;
    put_png(FILE_OF("s.png"), 2, 1, &(png_kind){16, PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE, 0, false, false}, rows);
    assert_int_equal(sky_load(FILE_OF("s.png"), 1, 0, &s, &why), VIT_OK);
    const double want = 384.0 / 65535.0 / 12.92, got = (double)sky_radiance(&s, (vec3){0, 1, 0}).x;
    assert_true(fabs(got / want - 1.0) < 1e-4);
    sky_free(&s);
}

enum { WIDE = 8, HIGH = 4 };

/* Texel (x, y), from the top left, of a picture whose texels all differ. */
static void texel(int x, int y, uint8_t rgbe[4]) {
    const uint8_t made[4] = {(uint8_t)(128 + 8 * x), (uint8_t)(128 + 16 * y), 128, 129};
    memcpy(rgbe, made, 4);
}

/* The picture of those texels in the order of `resolution`. */
static environment sky_in_order(const char *resolution) {
    uint8_t bytes[512];
    vit_text why;
    environment s;
    size_t n = (size_t)snprintf((char *)bytes, sizeof bytes, "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n%s\n", resolution);
    const bool columns = resolution[1] == 'X';
    const char *minus_x = strstr(resolution, "-X"), *plus_y = strstr(resolution, "+Y");
    for (int i = 0; i < WIDE * HIGH; i++, n += 4) {
        const int length = columns ? HIGH : WIDE, scan = i / length, pixel = i % length;
        const int x = columns ? scan : pixel, y = columns ? pixel : scan;
        texel(minus_x ? WIDE - 1 - x : x, plus_y ? HIGH - 1 - y : y, bytes + n);
    }
    put_bytes(FILE_OF("s.hdr"), bytes, n);
    if (sky_load(FILE_OF("s.hdr"), 1, 0, &s, &why) != VIT_OK)
        fail_msg("%s: %s", resolution, why.text);
    return s;
}

static void radiance_pictures_may_begin_at_any_corner(void **state) {
    static const char *const orders[] = {"-Y 4 +X 8", "+Y 4 +X 8", "-Y 4 -X 8", "+Y 4 -X 8",
                                         "+X 8 -Y 4", "-X 8 -Y 4", "+X 8 +Y 4", "-X 8 +Y 4"};
    (void)state;
    float rgb[3 * WIDE * HIGH];
    vit_text why;
    environment usual;
    for (int i = 0; i < WIDE * HIGH; i++) {
        uint8_t rgbe[4];
        texel(i % WIDE, i / WIDE, rgbe);
        for (int k = 0; k < 3; k++)
            rgb[3 * i + k] = (float)rgbe[k] / 128.0f; /* 2^(129 - 128 - 8) */
    }
    assert_int_equal(sky_from_texels(rgb, WIDE, HIGH, 0, &usual, &why), VIT_OK);
    const size_t texels = (size_t)(usual.size + 2) * (usual.size + 2);
    for (size_t i = 0; i < sizeof orders / sizeof *orders; i++) {
        environment s = sky_in_order(orders[i]);
        assert_int_equal(s.size, usual.size);
        assert_memory_equal(s.texels, usual.texels, texels * sizeof *s.texels);
        sky_free(&s);
    }
    sky_free(&usual);
}

static void radiance_pictures_that_cannot_be_read_right_are_refused(void **state) {
    static const struct {
        const char *text, *what;
    } rows[] = {{"#?RADIANCE\nFORMAT=32-bit_rle_xyze\n\n-Y 1 +X 2\n12345678", "holds CIE XYZ"},
                {"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +Y 2\n12345678", "it has no resolution"},
                {"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1\n12345678", "it has no resolution"},
                {"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n", "it has no resolution"}};
    vit_text why;
    environment s;
    (void)state;
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        put(FILE_OF("s.hdr"), rows[i].text);
        assert_int_equal(sky_load(FILE_OF("s.hdr"), 1, 0, &s, &why), VIT_BAD_INPUT);
        if (!strstr(why.text, rows[i].what))
            fail_msg("%s", why.text);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        T(rows_of_a_bmp_may_begin_at_the_top),
        T(case_bmp_top_down),
        T(a_bmp_with_run_lengths_is_told),
        T(a_tga_may_begin_at_any_corner),
        T(channels_of_a_jpeg_are_what_its_adobe_marker_says),
        T(a_jpeg_that_cannot_be_read_right_is_told),
        T(a_jpeg_without_its_end_is_told),
        T(a_png_may_be_interlaced),
        T(a_palette_may_be_transparent),
        T(a_gamma_that_is_not_srgbs_is_told),
        T(srgb_goes_before_gamma),
        T(a_sky_of_16_bits_keeps_them),
        T(radiance_pictures_may_begin_at_any_corner),
        T(radiance_pictures_that_cannot_be_read_right_are_refused),
    };
    return cmocka_run_group_tests(tests, make_folder, NULL);
}
