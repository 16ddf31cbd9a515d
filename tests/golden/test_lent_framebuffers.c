/* Memory that the caller lends for frames: rows as far apart as it says, rendered into in place, nothing between them touched.
 *
 * Strategy: the memory is filled with a pattern, the rows in it must be those of a frame that is tightly packed, and the
 * pattern must still be between and behind them. A frame that nobody asked to be transferred is there all the same: so it was
 * rendered there. The player's sink `map` lends a file. */
#include "open_pack.h"

#define FOLDER TEST_PACKS "/lent"
enum { PATTERN = 0xa5, ROOM = 1 << 16, APART = 64 };

static tool_run r;
static const uint32_t devices[] = {VIT_DEVICE_HOST, 0};
enum { DEVICES = sizeof devices / sizeof devices[0] };

/* A pack whose frames lie in memory of their own, `apart` bytes between their rows. */
typedef struct lent {
    open_pack p;
    uint8_t *memory;
    size_t pitch, size; /* of the memory, as the library knows it; there is more behind it */
} lent;

static vit_open_info how_of(uint32_t device, vit_format format) {
    return (vit_open_info){.device = device, .format = format};
}

static void lent_open(lent *l, vit_open_info how, size_t apart) {
    open_pack plain;
    pack_open(&plain, "33x47", how);
    l->pitch = plain.stride + apart;
    l->size = l->pitch * (plain.need.height - 1) + plain.stride;
    l->memory = aligned_alloc(64, ROOM);
    assert_non_null(l->memory);
    assert_true(l->size + APART <= ROOM);
    memset(l->memory, PATTERN, ROOM);
    how.framebuffer = l->memory;
    how.framebuffer_pitch = l->pitch;
    how.framebuffer_size = l->size;
    pack_close(&plain);
    pack_open(&l->p, "33x47", how);
}

static void lent_close(lent *l) {
    pack_close(&l->p);
    free(l->memory);
}

/* The rows are those of the tight frame, and the pattern is where none is. */
static void assert_rows(const lent *l, const uint8_t *tight) {
    const size_t row = l->p.stride;
    for (uint32_t y = 0; y < l->p.need.height; y++) {
        const uint8_t *at = l->memory + y * l->pitch;
        const size_t end = y + 1 < l->p.need.height ? l->pitch : row + APART;
        assert_memory_equal(at, tight + y * row, row);
        for (size_t i = row; i < end; i++)
            assert_int_equal(at[i], PATTERN);
    }
}

static void rows_lie_as_far_apart_as_the_caller_says(void **state) {
    (void)state;
    for (size_t d = 0; d < DEVICES; d++)
        for (int format = 0; format < VIT_FORMAT_COUNT; format++)
            for (size_t apart = 0; apart <= 5 * 16; apart += 5 * 16) {
                const vit_open_info how = how_of(devices[d], (vit_format)format);
                open_pack plain;
                lent l;
                pack_open(&plain, "33x47", how);
                lent_open(&l, how, apart);
                for (uint32_t i = 0; i < 2; i++) {
                    pack_frame(&plain, i);
                    assert_vit_ok(&l.p, vit_frame(l.p.v, i, l.memory, l.pitch, &l.p.why));
                    assert_rows(&l, plain.frame);
                    assert_true(vit_hash_frame(plain.frame, (vit_format)format, plain.need.frame_bytes) ==
                                vit_golden(l.p.v, i));
                }
                lent_close(&l);
                pack_close(&plain);
            }
}

static void a_frame_is_in_the_lent_memory_without_a_transfer(void **state) {
    (void)state;
    for (size_t d = 0; d < DEVICES; d++) {
        const vit_open_info how = how_of(devices[d], VIT_FORMAT_XRGB8888);
        open_pack plain;
        lent l;
        pack_open(&plain, "33x47", how);
        lent_open(&l, how, 28);
        pack_frame(&plain, 1);
        assert_vit_ok(&l.p, vit_frame(l.p.v, 1, NULL, 0, &l.p.why));
        assert_rows(&l, plain.frame);
        lent_close(&l);
        pack_close(&plain);
    }
}

static void a_frame_goes_elsewhere_too(void **state) {
    (void)state;
    static uint8_t wide[ROOM];
    for (size_t d = 0; d < DEVICES; d++) {
        lent l;
        lent_open(&l, how_of(devices[d], VIT_FORMAT_XRGB8888), 28);
        assert_true(pack_frame_hash(&l.p, 1) == vit_golden(l.p.v, 1)); /* tightly packed */
        memset(wide, PATTERN, sizeof wide);
        assert_vit_ok(&l.p, vit_frame(l.p.v, 1, wide, 256, &l.p.why));
        for (uint32_t y = 0; y < l.p.need.height; y++) {
            assert_memory_equal(wide + y * 256, l.p.frame + y * l.p.stride, l.p.stride);
            assert_int_equal(wide[y * 256 + l.p.stride], PATTERN);
        }
        lent_close(&l);
    }
}

static void framebuffers_hash(void *user, const char *pass, uint64_t hash) {
    if (strstr(pass, ".framebuffer"))
        *(uint64_t *)user = hash;
}

static void a_trace_does_not_see_what_lies_between_rows(void **state) {
    (void)state;
    static uint8_t scratch[1 << 22];
    uint64_t hashes[2] = {0, 1};
    for (size_t i = 0; i < 2; i++) {
        lent l;
        lent_open(&l, how_of(VIT_DEVICE_HOST, VIT_FORMAT_RGB565), i * 30);
        assert_vit_ok(&l.p, vit_trace(l.p.v, 1, scratch, sizeof scratch, framebuffers_hash, &hashes[i], &l.p.why));
        lent_close(&l);
    }
    assert_true(hashes[0] == hashes[1]);
}

/* `how` is refused with these words, before anything is opened. */
static void refuses(open_pack *p, vit_open_info how, const char *words) {
    vit_requirements need;
    vit_text why = {""};
    how.pack = p->bytes;
    how.pack_size = p->info.pack_size;
    assert_int_equal(vit_require(&how, &need, &why), VIT_USAGE);
    if (!strstr(why.text, words))
        fail_msg("expected '%s', got '%s'", words, why.text);
}

static void memory_that_cannot_hold_a_frame_is_refused(void **state) {
    (void)state;
    static _Alignas(64) uint8_t memory[ROOM];
    open_pack p;
    pack_open(&p, "33x47", how_of(VIT_DEVICE_HOST, VIT_FORMAT_XRGB8888));
    vit_open_info how = {.device = VIT_DEVICE_HOST, .framebuffer = memory};
    how.framebuffer_pitch = 33 * 4 - 4;
    refuses(&p, how, "framebuffer_pitch must be 132 to 262144 bytes, in pixels of 4, got 128");
    how.framebuffer_pitch = 33 * 4 + 2;
    refuses(&p, how, "got 134");
    how.framebuffer_pitch = SIZE_MAX / 4 * 4;
    refuses(&p, how, "framebuffer_pitch must be");
    how.framebuffer_pitch = 256;
    how.framebuffer_size = 46 * 256 + 33 * 4 - 1;
    refuses(&p, how, "framebuffer_size: 47 rows 256 bytes apart need 11908 bytes, there are 11907");
    how.framebuffer_pitch = 0;
    how.framebuffer_size = 33 * 47 * 4 - 1;
    refuses(&p, how, "need 6204 bytes, there are 6203");
    how.framebuffer_size = 0;
    how.framebuffer = memory + 16;
    refuses(&p, how, "aligned to 64 bytes");
    pack_close(&p);
}

/* The file of --out map:FILE has the rows of the last frame of --out raw:FILE, at multiples of 64 bytes. */
static void assert_mapped(const char *map, const char *raw) {
    size_t size, raw_size;
    uint8_t *mapped = read_file(map, &size), *frames = read_file(raw, &raw_size);
    const size_t row = 33 * 4, pitch = 192, height = 47;
    assert_int_equal(size, pitch * height);
    assert_int_equal(raw_size, 2 * row * height);
    for (size_t y = 0; y < height; y++)
        assert_memory_equal(mapped + y * pitch, frames + (height + y) * row, row);
    free(mapped);
    free(frames);
}

static void the_player_renders_into_a_mapped_file(void **state) {
    (void)state;
    static const char *const options[] = {"--device host", "--device pocl"};
    const char *pack = test_pack("33x47");
    folder_make(FOLDER);
    for (size_t i = 0; i < 2; i++) {
        (void)unlink(FOLDER "/frame");
        tool(&r, TOOL_PLAY " %s --quiet %s --out raw:" FOLDER "/raw", pack, options[i]);
        tool_succeeds(&r);
        tool(&r, TOOL_PLAY " %s --quiet %s --verify --out map:" FOLDER "/frame", pack, options[i]);
        tool_succeeds(&r);
        assert_mapped(FOLDER "/frame", FOLDER "/raw");
        /* over a file that is there, shorter and longer */
        assert_int_equal(truncate(FOLDER "/frame", i == 0 ? 10 : 100000), 0);
        tool(&r, TOOL_PLAY " %s --quiet %s --out map:" FOLDER "/frame", pack, options[i]);
        tool_succeeds(&r);
        assert_mapped(FOLDER "/frame", FOLDER "/raw");
    }
}

static void a_run_that_shows_no_frame_leaves_no_file(void **state) {
    (void)state;
    const char *pack = test_pack("33x47");
    folder_make(FOLDER);
    (void)unlink(FOLDER "/none");
    tool(&r, TOOL_PLAY " %s --quiet --device host --host-isa nonsense --out map:" FOLDER "/none", pack);
    tool_refuses(&r, "vitrine-play", VIT_USAGE, "nonsense");
    assert_int_equal(access(FOLDER "/none", F_OK), -1);
    tool(&r, TOOL_PLAY " %s --quiet --device host --out map:/dev/full", pack);
    tool_refuses(&r, "vitrine-play", VIT_FAILED, "/dev/full");
    tool(&r, TOOL_PLAY " %s --quiet --device host --out map:-", pack);
    tool_refuses(&r, "vitrine-play", VIT_USAGE, "file's name");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rows_lie_as_far_apart_as_the_caller_says),
        cmocka_unit_test(a_frame_is_in_the_lent_memory_without_a_transfer),
        cmocka_unit_test(a_frame_goes_elsewhere_too),
        cmocka_unit_test(a_trace_does_not_see_what_lies_between_rows),
        cmocka_unit_test(memory_that_cannot_hold_a_frame_is_refused),
        cmocka_unit_test(the_player_renders_into_a_mapped_file),
        cmocka_unit_test(a_run_that_shows_no_frame_leaves_no_file),
    };
    return cmocka_run_group_tests_name("lent framebuffers", tests, NULL, NULL);
}
