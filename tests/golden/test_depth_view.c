/* The view `depth`: bright to dark over what the path sees.
 *
 * Strategy: frames as floats, so that brightness is read as it is. Its range must be used, whatever the scene's size and
 * whether slices of depth were measured (photons) or not; and the farther of two samples is never the brighter. */
#include "open_pack.h"
#include "read_buffer.h"

#include <math.h>

static const float DARKEST = 0.0625f; /* of what is there; nothing is 0 */

typedef struct range {
    float least, most; /* of what is there */
    uint32_t nothing;
} range;

/* Brightness of frame `index`, and a hash of it. */
static range look(const char *name, uint32_t device, uint32_t index, uint64_t *hash) {
    open_pack p;
    range r = {.least = 2, .most = -1};
    pack_open(&p, name, (vit_open_info){.view = VIT_VIEW_depth, .format = VIT_FORMAT_RGBA32F, .device = device});
    *hash = pack_frame_hash(&p, index);
    const float *pixels = (const float *)p.frame;
    for (size_t i = 0; i < (size_t)p.need.width * p.need.height; i++) {
        const float v = pixels[4 * i];
        assert_true(v == pixels[4 * i + 1] && v == pixels[4 * i + 2]);
        r.nothing += v == 0.0f;
        if (v == 0.0f)
            continue;
        r.least = v < r.least ? v : r.least;
        r.most = v > r.most ? v : r.most;
    }
    pack_close(&p);
    return r;
}

static void the_range_is_used_with_the_same_bits_on_any_device(void **state) {
    (void)state;
    static const char *const packs[] = {"list", "dark"}; /* the second without photons */
    for (size_t i = 0; i < sizeof packs / sizeof packs[0]; i++) {
        uint64_t host, other;
        const range r = look(packs[i], VIT_DEVICE_HOST, 0, &host);
        (void)look(packs[i], vit_device_default(), 0, &other);
        assert_int_equal(host, other);
        if (r.least < DARKEST || r.most > 1 || r.most < 0.6f || r.most - r.least < 0.3f)
            fail_msg("%s: brightness from %g to %g", packs[i], (double)r.least, (double)r.most);
    }
}

static int by_distance(const void *a, const void *b) {
    const float x = *(const float *)a, y = *(const float *)b;
    return (x > y) - (x < y);
}

/* Pixels and samples lie in different orders, so both are sorted: the brightest against the nearest. */
static void brightness_falls_evenly_with_the_logarithm_of_depth(void **state) {
    (void)state;
    open_pack p;
    pack_open(&p, "list", (vit_open_info){.view = VIT_VIEW_depth, .format = VIT_FORMAT_RGBA32F, .device = VIT_DEVICE_HOST});
    pack_frame(&p, 0);
    const vit_scene *s = p.v->pack.scene;
    const size_t pixels = (size_t)s->width * s->height;
    float *distance = read_buffer(&p, B_hit_distance), *shown = malloc(pixels * sizeof *shown);
    uint32_t *triangle = read_buffer(&p, B_hit_triangle);
    size_t hits = 0, lit = 0;
    assert_non_null(shown);
    for (size_t i = 0; i < s->samples; i++)
        if (triangle[i] != VIT_NONE)
            distance[hits++] = distance[i];
    for (size_t i = 0; i < pixels; i++)
        if (((const float *)p.frame)[4 * i] > 0)
            shown[lit++] = ((const float *)p.frame)[4 * i];
    assert_true(lit > 100);
    assert_int_equal(hits, lit);
    qsort(distance, hits, sizeof *distance, by_distance);
    qsort(shown, lit, sizeof *shown, by_distance);
    const double octaves = (double)s->slice_count / (double)s->slice_scale,
                 first = (double)s->slice_first / (double)s->slice_scale;
    for (size_t i = 0; i < hits; i++) {
        double part = (log2((double)distance[i] / (double)s->slice_near) - first) / octaves;
        part = part < 0 ? 0 : part > 1 ? 1 : part;
        assert_true(fabs(1 - 0.9375 * part - (double)shown[lit - 1 - i]) < 1e-4);
    }
    free(distance);
    free(triangle);
    free(shown);
    pack_close(&p);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_range_is_used_with_the_same_bits_on_any_device),
        cmocka_unit_test(brightness_falls_evenly_with_the_logarithm_of_depth),
    };
    return cmocka_run_group_tests_name("depth view", tests, NULL, NULL);
}
