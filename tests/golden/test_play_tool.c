/* The player with real packs: exit codes, one-line errors, what is written. Strategy as in test_bake_tool.c; what the player
 * refuses before it reads a pack is in tests/unit/test_player.c. */
#include "pack_image.h"
#include "test_packs.h"
#define FOLDER TEST_PACKS "/play-tool"
#include "tools_lab.h"
#include <fcntl.h>

/* What is asked here is the same on every device, and this one compiles nothing. */
#define PLAY_HOST TOOL_PLAY " --device host"

/* Changes frame `index`'s golden hash of XRGB8888 and makes all of the pack's hashes right again. */
static void alter_golden(const char *from, const char *to, uint32_t index) {
    image im = {0};
    im.bytes = read_file(from, &im.size);
    im.header = im.bytes;
    im.table = (vit_pack_entry *)(im.header + 1);
    im.golds = section(&im, VIT_SECTION_GOLD);
    im.golds[index].xrgb8888[0] ^= 1;
    forge(&im);
    put_bytes(to, im.bytes, im.size);
    free(im.bytes);
}

static void verify_tells_the_first_frame_that_differs(void **state) {
    (void)state;
    alter_golden(test_pack("list"), FOLDER "/altered.vit", 1);
    tool(&r, TOOL_PLAY " --quiet --verify " FOLDER "/altered.vit");
    tool_refuses(&r, "vitrine-play", VIT_MISMATCH, "frame 1: expected ");
    assert_non_null(strstr(r.err, "1 of 3 frames differ"));
    tool(&r, PLAY_HOST " --quiet --verify --frames 2 " FOLDER "/altered.vit");
    tool_succeeds(&r);
    tool(&r, PLAY_HOST " --quiet " FOLDER "/altered.vit"); /* who does not ask is not told */
    tool_succeeds(&r);
    (void)empty(FOLDER);
}

static void verify_of_a_format_without_golden_hashes_is_a_mismatch(void **state) {
    (void)state;
    tool(&r, PLAY_HOST " --quiet --verify --format rgb565 %s", test_pack("dark"));
    tool_refuses(&r, "vitrine-play", VIT_MISMATCH, "no golden hashes");
}

static void a_pack_cut_short_or_flipped_is_bad_input(void **state) {
    (void)state;
    size_t size;
    char *bytes = read_file(test_pack("lamp"), &size);
    put_bytes(FOLDER "/bad.vit", bytes, size - 1);
    tool(&r, PLAY_HOST " --quiet --verify " FOLDER "/bad.vit");
    tool_refuses(&r, "vitrine-play", VIT_BAD_INPUT, FOLDER "/bad.vit: ");
    bytes[size / 2] ^= 1;
    put_bytes(FOLDER "/bad.vit", bytes, size);
    tool(&r, PLAY_HOST " --quiet --verify " FOLDER "/bad.vit");
    tool_refuses(&r, "vitrine-play", VIT_BAD_INPUT, FOLDER "/bad.vit: ");
    free(bytes);
    (void)empty(FOLDER);
}

static void each_view_shows_something_else(void **state) {
    (void)state;
    static const char *const views[] = {
#define X(name, light, meaning) #name,
        VIT_VIEWS(X)
#undef X
    };
    enum { COUNT = sizeof views / sizeof views[0] };
    char hashes[COUNT][64];
    for (size_t i = 0; i < COUNT; i++) {
        tool(&r, PLAY_HOST " --quiet --hash --frames 0 --view %s %s", views[i], test_pack("33x47"));
        tool_succeeds(&r);
        assert_int_equal(strlen(r.out), 24); /* "000000 0123456789abcdef\n" */
        (void)snprintf(hashes[i], sizeof hashes[0], "%.40s", r.out);
        for (size_t k = 0; k < i; k++)
            if (strcmp(hashes[i], hashes[k]) == 0)
                fail_msg("the views %s and %s are the same picture", views[i], views[k]);
    }
}

/* Bytes of a file; -1: it is not there. */
static long bytes_of(const char *path) {
    struct stat s;
    return stat(path, &s) == 0 ? (long)s.st_size : -1;
}

static void frames_in_files_have_the_right_sizes(void **state) {
    (void)state;
    const char *pack = test_pack("33x47");
    const long pixels = 33 * 47;
    char header[160];
    tool(&r, PLAY_HOST " --quiet %s --out raw:" FOLDER "/a.raw", pack);
    tool_succeeds(&r);
    assert_int_equal(bytes_of(FOLDER "/a.raw"), 2 * 4 * pixels);
    tool(&r, PLAY_HOST " --quiet %s --format rgb565 --out raw:" FOLDER "/a.raw", pack);
    tool_succeeds(&r);
    assert_int_equal(bytes_of(FOLDER "/a.raw"), 2 * 2 * pixels);
    tool(&r, PLAY_HOST " --quiet %s --format rgba32f --out raw:" FOLDER "/a.raw", pack);
    tool_succeeds(&r);
    assert_int_equal(bytes_of(FOLDER "/a.raw"), 2 * 16 * pixels);
    tool(&r, PLAY_HOST " --quiet %s --out y4m:" FOLDER "/a.y4m", pack);
    tool_succeeds(&r);
    FILE *f = fopen(FOLDER "/a.y4m", "rb");
    assert_non_null(f);
    assert_non_null(fgets(header, sizeof header, f));
    (void)fclose(f);
    assert_int_equal(strncmp(header, "YUV4MPEG2 W33 H47 F24:1 ", 24), 0);
    assert_int_equal(bytes_of(FOLDER "/a.y4m"), (long)strlen(header) + 2 * (6 + 3 * pixels));
    tool(&r, PLAY_HOST " --quiet %s --out ppm:" FOLDER "/ppm", pack);
    tool_succeeds(&r);
    assert_int_equal(bytes_of(FOLDER "/ppm/frame_00000.ppm"), 13 + 3 * pixels); /* "P6\n33 47\n255\n" */
    assert_int_equal(bytes_of(FOLDER "/ppm/frame_00001.ppm"), 13 + 3 * pixels);
    assert_int_equal(bytes_of(FOLDER "/ppm/frame_00002.ppm"), -1);
}

static void a_png_says_its_size(void **state) {
    (void)state;
    tool(&r, PLAY_HOST " --quiet %s --frames 1 --out png:" FOLDER "/png", test_pack("33x47"));
    tool_succeeds(&r);
    size_t size;
    unsigned char *png = read_file(FOLDER "/png/frame_00001.png", &size);
    static const unsigned char head[] = {0x89, 'P', 'N', 'G', 13, 10, 26, 10, 0, 0, 0,  13, 'I',
                                         'H',  'D', 'R', 0,   0,  0,  33, 0,  0, 0, 47, 8,  2};
    assert_true(size > 200);
    assert_memory_equal(png, head, sizeof head);
    assert_memory_equal(png + size - 8, "IEND", 4);
    free(png);
    assert_int_equal(bytes_of(FOLDER "/png/frame_00000.png"), -1);
}

static void a_raw_frame_is_what_is_hashed(void **state) {
    (void)state;
    char want[64];
    size_t size;
    tool(&r, PLAY_HOST " --quiet --hash %s --frames 1 --out raw:" FOLDER "/a.raw", test_pack("33x47"));
    tool_succeeds(&r);
    void *frame = read_file(FOLDER "/a.raw", &size);
    (void)snprintf(want, sizeof want, "000001 %016llx\n", (unsigned long long)vit_hash(frame, size));
    assert_string_equal(r.out, want);
    free(frame);
    (void)empty(FOLDER);
}

static void frames_beyond_the_path_are_refused_with_what_there_is(void **state) {
    (void)state;
    tool(&r, PLAY_HOST " --quiet %s --frames 2:9", test_pack("33x47"));
    tool_refuses(&r, "vitrine-play", VIT_USAGE, "frames 0 to 1");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(verify_tells_the_first_frame_that_differs),
        cmocka_unit_test(verify_of_a_format_without_golden_hashes_is_a_mismatch),
        cmocka_unit_test(a_pack_cut_short_or_flipped_is_bad_input),
        cmocka_unit_test(each_view_shows_something_else),
        cmocka_unit_test(frames_in_files_have_the_right_sizes),
        cmocka_unit_test(a_png_says_its_size),
        cmocka_unit_test(a_raw_frame_is_what_is_hashed),
        cmocka_unit_test(frames_beyond_the_path_are_refused_with_what_there_is),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
