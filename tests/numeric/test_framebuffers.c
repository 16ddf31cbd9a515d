/* Framebuffers of 1 x 1 to 7680 x 4320 pixels, odd ones, paths of 1 to 100 000 frames, and cameras that jump.
 *
 * What can go wrong: tiles stand over the edge and their padding writes beyond it; a number of a pixel, sample or record runs
 * over 32 bits; a frame takes over something of the frame before: masks, lists, counters. The bound is the same bits: a pixel's
 * ray and light do not depend on the picture round it, so any part of a picture is the same picture rendered alone (rays and
 * their sums are exact in float here), and any frame of a path is the same frame as the only one. 7680 x 4320 pixels and 100
 * 000 frames under `make numeric`. */
#include "catalogue.h"
#include "rig.h"

#define PIXEL 0x1p-12f /* of the view plane at 1 m: sums with it are exact */
enum { PHOTONS = 64, CAMERAS = 7 };

/* The window of width x height pixels whose top left pixel is (x, y), counted from the view's axis. */
static vit_camera window(const vit_scene *s, int x, int y) {
    vit_camera c = rig_camera_at(s, 0.125f, -0.25f, 0.375f);
    c.right[0] = PIXEL;
    c.down[1] = -PIXEL;
    c.corner[0] = PIXEL * (float)x;
    c.corner[1] = -PIXEL * (float)y;
    return c;
}

typedef struct picture {
    uint32_t width, height;
    int x, y;
    uint32_t *pixels;
} picture;

/* Direct and indirect light in the turned room. */
static picture render(uint32_t width, uint32_t height, int x, int y, uint32_t tile) {
    static vit_photon photons[PHOTONS];
    picture out = {width, height, x, y, NULL};
    uint64_t state = 53;
    rig r;
    open_pack p;
    rig_begin(&r, width, height);
    rig_room(&r, 3, rig_keep);
    vit_light light = rig_light(0.2f, 0.7f, -0.1f, 40);
    vit_camera camera = window(&r.scene, x, y);
    for (int i = 0; i < PHOTONS; i++) {
        float q[3] = {0, 0, -1}, d[3];
        random_direction(&state, d);
        d[2] = -fabsf(d[2]);
        q[0] = 3 * lab_uniform(&state) - 1.5f;
        q[1] = 3 * lab_uniform(&state) - 1.5f;
        photons[i] = rig_photon(q, d, 0.5f, 1);
    }
    r.cameras = &camera;
    r.lights = &light;
    r.scene.lights = 1;
    r.scene.tile = tile;
    r.scene.max_list = 1u << 20;
    rig_photons(&r, photons, PHOTONS, 0.5f);
    rig_open(&r, &p, (vit_open_info){.device = VIT_DEVICE_HOST});
    pack_frame(&p, 0);
    assert_int_equal(pack_stats(&p).dropped_entries + pack_stats(&p).dropped_samples, 0);
    out.pixels = malloc(p.need.frame_bytes);
    assert_non_null(out.pixels);
    memcpy(out.pixels, p.frame, p.need.frame_bytes);
    pack_close(&p);
    rig_free(&r);
    return out;
}

/* Pixels of `part` that are other ones in `whole`. */
static uint64_t apart(const picture *part, const picture *whole, uint64_t *count) {
    uint64_t wrong = 0;
    for (uint32_t y = 0; y < part->height; y++)
        for (uint32_t x = 0; x < part->width; x++) {
            const size_t at = (size_t)((int)y + part->y - whole->y) * whole->width + (size_t)((int)x + part->x - whole->x);
            wrong += part->pixels[(size_t)y * part->width + x] != whole->pixels[at];
        }
    *count += (uint64_t)part->width * part->height;
    return wrong;
}

static void parts_of_a_picture_are_the_picture_in_parts(void **state) {
    static const struct {
        uint32_t width, height, tile;
        int x, y;
    } parts[] = {{1, 1, 8, 0, 0},      {1, 1, 64, 255, 127}, {1, 256, 16, 3, -128},   {256, 1, 32, 0, 100},
                 {33, 47, 8, 17, -11}, {65, 63, 64, -1, -1}, {255, 255, 16, 0, -127}, {7, 129, 32, 200, -100}};
    picture whole = render(257, 257, -1, -128, 16);
    uint64_t wrong = 0, count = 0;
    (void)state;
    for (size_t i = 0; i < sizeof parts / sizeof *parts; i++) {
        picture part = render(parts[i].width, parts[i].height, parts[i].x, parts[i].y, parts[i].tile);
        wrong += apart(&part, &whole, &count);
        free(part.pixels);
    }
    free(whole.pixels);
    catalogue_none("framebuffers", "1x1 to 255x255: pixels unlike the same ones of a larger picture", wrong, count, "pixels");
}

static void the_largest_pictures_are_right_in_all_corners(void **state) {
    static const struct { uint32_t width, height; } large[] = {{7680, 1}, {1, 4320}, {7680, 4320}};
    uint64_t wrong = 0, count = 0;
    (void)state;
    for (int i = 0; i < (catalogue_whole() ? 3 : 2); i++) {
        const int x = -(int)large[i].width / 2, y = -(int)large[i].height / 2;
        const uint32_t w = large[i].width < 64 ? large[i].width : 64, h = large[i].height < 64 ? large[i].height : 64;
        picture whole = render(large[i].width, large[i].height, x, y, 64);
        for (int corner = 0; corner < 5; corner++) { /* four corners and the middle */
            const int right = corner == 4 ? (int)large[i].width / 2 - (int)w / 2 : corner & 1 ? (int)(large[i].width - w) : 0;
            const int down = corner == 4 ? (int)large[i].height / 2 - (int)h / 2 : corner & 2 ? (int)(large[i].height - h) : 0;
            picture part = render(w, h, x + right, y + down, 16);
            wrong += apart(&part, &whole, &count);
            free(part.pixels);
        }
        free(whole.pixels);
    }
    catalogue_none("framebuffers",
                   catalogue_whole() ? "7680x4320, 7680x1, 1x4320: pixels unlike those rendered alone"
                                     : "7680x1, 1x4320: pixels unlike those rendered alone",
                   wrong, count, "pixels");
}

/* A path of `frames` frames that jumps through CAMERAS places in turns, with a light whose photons are traced; or, from `only`
 * on, the one frame of that place. Hashes of all frames. */
static void play_path(uint32_t frames, uint32_t only, uint64_t *hashes) {
    rig r;
    open_pack p;
    rig_begin(&r, 24, 24);
    rig_room(&r, 2, rig_keep);
    r.cameras = ray_lab_array(frames, sizeof *r.cameras);
    r.lights = ray_lab_array(frames, sizeof *r.lights);
    for (uint32_t i = 0; i < frames; i++) {
        const float k = (float)((i + only) % CAMERAS);
        r.cameras[i] = rig_camera_at(&r.scene, 0.1f * k - 0.4f, 0.05f * k, 0.9f - 0.2f * k);
        r.lights[i] = rig_light(0.7f - 0.2f * k, 0.6f, 0.1f * k, 30 + k);
        r.lights[i].path_count = 32;
    }
    r.scene.frames = frames;
    r.scene.lights = 1;
    r.scene.paths = 32;
    r.scene.radius = 0.7f;
    r.scene.effects = VIT_BIT(LIGHTS) | VIT_BIT(INDIRECT) | VIT_BIT(PHOTONS) | VIT_BIT(TRACED) | VIT_BIT(LIST);
    vit_open_info how = rig_on_host();
    how.threads = 1;
    rig_open(&r, &p, how);
    for (uint32_t i = 0; i < frames; i++)
        hashes[i] = pack_frame_hash(&p, i);
    pack_close(&p);
    free(r.cameras);
    free(r.lights);
    rig_free(&r);
}

static void every_frame_of_a_path_is_that_frame_alone(void **state) {
    const uint32_t frames = catalogue_whole() ? 100000 : 2000;
    uint64_t alone[CAMERAS], *hashes = ray_lab_array(frames, sizeof *hashes), wrong = 0;
    (void)state;
    for (uint32_t k = 0; k < CAMERAS; k++) {
        play_path(1, k, &alone[k]);
        assert_true(k == 0 || alone[k] != alone[k - 1]);
    }
    play_path(frames, 0, hashes);
    for (uint32_t i = 0; i < frames; i++)
        wrong += hashes[i] != alone[i % CAMERAS];
    free(hashes);
    catalogue_none("paths", "frames after a jump unlike that frame as the only one", wrong, frames, "frames");
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(parts_of_a_picture_are_the_picture_in_parts),
                                       cmocka_unit_test(the_largest_pictures_are_right_in_all_corners),
                                       cmocka_unit_test(every_frame_of_a_path_is_that_frame_alone)};
    return cmocka_run_group_tests_name("framebuffers", tests, NULL, NULL);
}
