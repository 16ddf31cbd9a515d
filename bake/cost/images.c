#include "cost/images.h"
#include "pack/opened.h"
#include <stdbool.h>
#include <stddef.h>

static uint32_t points(uint32_t pixels, uint32_t every) {
    return pixels > every / 2 ? (pixels - every / 2 + every - 1) / every : 1;
}

uint32_t images_across(const images_grid *g) {
    return points(g->width, g->every);
}

uint32_t images_down(const images_grid *g) {
    return points(g->height, g->every);
}

/* The two pixels beside a grid point along one axis, and the second one's weight. */
typedef struct beside {
    uint32_t a, b;
    float weight;
} beside;

static beside find(uint32_t point, uint32_t every, uint32_t frame, uint32_t pixels) {
    uint32_t pixel = every * point + every / 2;
    pixel = pixel < frame ? pixel : frame - 1;
    if (pixels == frame)
        return (beside){pixel, pixel, 0};
    const double at = (pixel + 0.5) * pixels / frame - 0.5, inside = at > 0 ? at < pixels - 1 ? at : pixels - 1 : 0;
    const uint32_t a = (uint32_t)inside;
    return (beside){a, a + 1 < pixels ? a + 1 : a, (float)(inside - a)};
}

void images_sample(const images_grid *g, const float *rgba, uint32_t width, uint32_t height, float *out) {
    const uint32_t across = images_across(g), down = images_down(g);
    for (uint32_t j = 0; j < down; j++) {
        const beside y = find(j, g->every, g->height, height);
        for (uint32_t i = 0; i < across; i++) {
            const beside x = find(i, g->every, g->width, width);
            const float *top = rgba + 4 * (size_t)width * y.a, *bottom = rgba + 4 * (size_t)width * y.b;
            for (uint32_t k = 0; k < 3; k++) {
                const float t = top[4 * (size_t)x.a + k] * (1 - x.weight) + top[4 * (size_t)x.b + k] * x.weight;
                const float u = bottom[4 * (size_t)x.a + k] * (1 - x.weight) + bottom[4 * (size_t)x.b + k] * x.weight;
                out[3 * ((size_t)j * across + i) + k] = t * (1 - y.weight) + u * y.weight;
            }
        }
    }
}

vit_status images_render(const vit_open_info *how, uint32_t index, const images_grid *g, float *out, vit_statistics *stats,
                         vit_text *why) {
    vit_open_info info = *how;
    opened o;
    info.format = VIT_FORMAT_RGBA32F;
    vit_status status = opened_begin(&info, &o, why);
    if (status != VIT_OK)
        return status;
    status = opened_frame(&o, index, why);
    if (status == VIT_OK && stats)
        status = vit_stats(o.v, stats, why);
    if (status == VIT_OK)
        images_sample(g, (const float *)(const void *)o.frame, o.need.width, o.need.height, out);
    opened_end(&o);
    return status;
}
