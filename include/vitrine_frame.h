/* What a frame shows and how its pixels lie in memory: a part of vitrine.h, and the first lines of the kernels' program, so it
 * is C, C++ and OpenCL C, and includes nothing. */
#ifndef VITRINE_FRAME_H
#define VITRINE_FRAME_H

/* Framebuffer formats: X(name, what options, reports and golden hashes call it, bytes per pixel, bytes of the words that it is
 * made of, meaning). Words, half words and floats are in the machine's byte order. */
#define VIT_FORMATS(X)                                                                                                         \
    X(XRGB8888, xrgb8888, 4, 4, "0x00RRGGBB words, sRGB curve")                                                                \
    X(RGB565, rgb565, 2, 2, "rrrrrggggggbbbbb half words, sRGB curve")                                                         \
    X(RGBA32F, rgba32f, 16, 4, "four floats, linear radiance times exposure, alpha 1")

typedef enum vit_format {
#define X(name, word, bytes, word_bytes, meaning) VIT_FORMAT_##name,
    VIT_FORMATS(X)
#undef X
} vit_format;

/* Light that a view shows, as the sum of these; 0: it shows the method's insides, by the first sample of each pixel. */
#define VIT_SHOWS_DIRECT 1
#define VIT_SHOWS_INDIRECT 2

/* What the frame shows: X(name, light, meaning). */
#define VIT_VIEWS(X)                                                                                                           \
    X(final, VIT_SHOWS_DIRECT + VIT_SHOWS_INDIRECT, "the picture")                                                             \
    X(direct, VIT_SHOWS_DIRECT, "direct light alone")                                                                          \
    X(indirect, VIT_SHOWS_INDIRECT, "indirect light alone, albedo applied")                                                    \
    X(clusters, 0, "view-sample clusters, a colour each")                                                                      \
    X(photons, VIT_SHOWS_DIRECT + VIT_SHOWS_INDIRECT, "photons as dots over the picture")                                      \
    X(heat, 0, "photons of each pixel's cluster as a heat map")                                                                \
    X(normals, 0, "shading normals as colours")                                                                                \
    X(depth, 0, "length of the view ray, from bright to dark over what the path sees, in even steps of its logarithm")         \
    X(albedo, 0, "diffuse reflectance")

typedef enum vit_view {
#define X(name, light, meaning) VIT_VIEW_##name,
    VIT_VIEWS(X)
#undef X
} vit_view;

enum {
#define X(name, word, bytes, word_bytes, meaning) +1
    VIT_FORMAT_COUNT = 0 VIT_FORMATS(X),
#undef X
#define X(name, light, meaning) +1
    VIT_VIEW_COUNT = 0 VIT_VIEWS(X)
#undef X
};

#endif
