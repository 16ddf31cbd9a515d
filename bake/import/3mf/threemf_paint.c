/* Colours of corners as a picture. A triangle whose corners differ in colour has a square of texels of its own, in which its
 * colours run from corner to corner as the specification has it: barycentric, in sRGB (Materials 1.3). Squares lie in Morton's
 * order, so that what is coarser, where a triangle is smaller than a pixel, is a mean of triangles that follow each other. */
#include "import/3mf/threemf_file.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { SQUARE = 4 }; /* texels of its edge: filters are linear between them, which is not how sRGB runs */
#define MOST_PLACES ((size_t)(IMPORT_EDGE / SQUARE) * (IMPORT_EDGE / SQUARE))

bool threemf_paint(threemf_file *f, const uint8_t *const rgba[3], uint32_t *place) {
    if (f->paint_count == MOST_PLACES)
        return import_fail(f->im, "has more than %zu triangles with colours of corners", MOST_PLACES);
    if (!import_room(f->im, &f->paint, &f->paint_room, f->paint_count + 1, sizeof *f->paint))
        return false;
    for (int k = 0; k < 3; k++)
        memcpy(f->paint[f->paint_count][k], rgba[k], 3);
    *place = (uint32_t)f->paint_count++;
    return true;
}

/* Squares of the picture's edges: powers of two, the second as large as the first or half of it. */
static void size_of(const threemf_file *f, uint32_t edge[2]) {
    edge[0] = edge[1] = 1;
    for (int k = 0; (size_t)edge[0] * edge[1] < f->paint_count; k ^= 1)
        edge[k] *= 2;
}

static uint32_t every_second_bit(uint32_t value) {
    uint32_t out = 0;
    for (int i = 0; i < 16; i++)
        out |= (value >> i) & UINT32_C(1) << i;
    return out;
}

static void corner_of(uint32_t place, uint32_t texel[2]) {
    texel[0] = SQUARE * every_second_bit(place);
    texel[1] = SQUARE * every_second_bit(place >> 1);
}

void threemf_paint_uv(const threemf_file *f, uint32_t key, float uv[2]) {
    static const double within[4][2] = {{0.5, 0.5}, {SQUARE - 0.5, 0.5}, {0.5, SQUARE - 0.5}, {0.5 * SQUARE, 0.5 * SQUARE}};
    uint32_t edge[2], texel[2];
    size_of(f, edge);
    corner_of(key / 4, texel);
    for (int k = 0; k < 2; k++)
        uv[k] = (float)((texel[k] + within[key % 4][k]) / (double)(SQUARE * edge[k]));
}

/* Weights of the corners, in thirds, which beyond the third side go on as they were, so that filters see no edge there. */
static void paint_square(uint8_t colors[3][3], uint8_t *first, size_t pitch) {
    for (int y = 0; y < SQUARE; y++)
        for (int x = 0; x < SQUARE; x++) {
            uint8_t *to = first + pitch * (size_t)y + 4 * (size_t)x;
            for (int k = 0; k < 3; k++) {
                const int sum = (SQUARE - 1 - x - y) * colors[0][k] + x * colors[1][k] + y * colors[2][k],
                          value = sum <= 0 ? 0 : (2 * sum + SQUARE - 1) / (2 * (SQUARE - 1));
                to[k] = (uint8_t)(value > 255 ? 255 : value);
            }
            to[3] = 255;
        }
}

const char *threemf_paint_image(const threemf_file *f, model_image *out) {
    uint32_t edge[2], texel[2];
    size_of(f, edge);
    const size_t pitch = 4 * (size_t)SQUARE * edge[0];
    import_allow_texels(f->im, (uint64_t)SQUARE * SQUARE * edge[0] * edge[1]);
    out->width = (int)(SQUARE * edge[0]);
    out->height = (int)(SQUARE * edge[1]);
    out->rgba = calloc(SQUARE * (size_t)edge[1], pitch);
    for (uint32_t i = 0; out->rgba && i < f->paint_count; i++) {
        corner_of(i, texel);
        paint_square(f->paint[i], out->rgba + pitch * texel[1] + 4 * (size_t)texel[0], pitch);
    }
    return out->rgba ? NULL : "does not fit in memory";
}
