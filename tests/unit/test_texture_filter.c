/* Texture filters of the kernels against the same filters written plainly in doubles, on a small repeated texture of random
 * texels with all its mip levels; and at every lane width the same bits. What a filter is must show where it differs from the
 * others, so positions and footprints cover finer than the finest level to coarser than the coarsest. */
#include "kernel_lab.h"
#include <math.h>

enum { EDGE = 8, LEVELS = 4, POINTS = 4096, GUTTERED = 12 * 12 + 6 * 6 + 4 * 4 + 3 * 3 };

/* One point a lane: coordinates s and t, squared footprint in m2 on a triangle of 1 m2 doubled area and 1 texture. */
static const char kernels[] =
    "kernel void filter_texture(global const vit_texture *texture, global const vit_mip *mips, global const uint *texels,\n"
    "                           global const float *in, global float *out)\n"
    "{\n"
    "    uint n = (uint)get_global_size(0) * VIT_LANES, first = (uint)get_global_id(0) * VIT_LANES;\n"
    "    surface_records r;\n"
    "    lf one = (lf)1, zero = (lf)0;\n"
    "    r.s0 = r.s2 = L_LOAD(in + first);\n"
    "    r.t0 = r.t1 = L_LOAD(in + n + first);\n"
    "    r.s1 = r.s0 + 1.0f;\n"
    "    r.t2 = r.t0 + 1.0f;\n"
    "    lv3_store_planes(surface_texture(texture, mips, texels, 0, &r, (li)-1, one, zero, zero, L_LOAD(in + 2 * n + first), "
    "one), out, n, first);\n"
    "}\n";

typedef struct image {
    vit_texture texture;
    vit_mip mips[LEVELS];
    vit_u32 texels[GUTTERED];
} image;

static vit_u32 texel(const image *m, int level, int x, int y) {
    const vit_mip *mip = &m->mips[level];
    return m->texels[(int)mip->offset + y * (int)mip->pitch + x];
}

static void image_make(image *m) {
    uint64_t random = 5;
    *m = (image){.texture = {.mip_count = LEVELS, .wrap_u = VIT_WRAP_REPEAT, .wrap_v = VIT_WRAP_REPEAT}};
    vit_u32 at = 0;
    for (int level = 0; level < LEVELS; level++) {
        const int size = EDGE >> level, pitch = size + 2;
        m->mips[level] = (vit_mip){at + (vit_u32)pitch + 1, (vit_u32)size, (vit_u32)size, (vit_u32)pitch};
        vit_u32 inner[EDGE * EDGE];
        for (int i = 0; i < size * size; i++)
            inner[i] = (vit_u32)lab_random(&random) & 0x3fffffffu;
        for (int y = -1; y <= size; y++)
            for (int x = -1; x <= size; x++)
                m->texels[(int)m->mips[level].offset + y * pitch + x] = inner[(y + size) % size * size + (x + size) % size];
        at += (vit_u32)(pitch * pitch);
    }
}

static double channel(vit_u32 code, int k) {
    const double root = (double)(code >> (10 * k) & 1023u) / 1023.0;
    return root * root;
}

static double bilinear(const image *m, int level, double s, double t, int k) {
    const int size = EDGE >> level;
    const double u = s * size - 0.5, v = t * size - 0.5;
    const int x = (int)floor(u), y = (int)floor(v);
    const double fu = u - x, fv = v - y;
    return (channel(texel(m, level, x, y), k) * (1 - fu) + channel(texel(m, level, x + 1, y), k) * fu) * (1 - fv) +
           (channel(texel(m, level, x, y + 1), k) * (1 - fu) + channel(texel(m, level, x + 1, y + 1), k) * fu) * fv;
}

/* What the filter should give; *near: how near the choice of texel or level is to its neighbour. */
static double expected(const image *m, vit_u64 effects, const float in[3], int k, double *near) {
    int exponent;
    const double mantissa = 2 * frexp((double)in[2] * EDGE * EDGE, &exponent), lambda = (exponent - 1 + mantissa - 1) / 2;
    const double s = in[0], t = in[1];
    *near = 1;
    if (effects & VIT_BIT(TRILINEAR)) {
        const double level = fmin(fmax(lambda, 0), LEVELS - 1);
        const int fine = (int)level, coarse = fine + 1 < LEVELS ? fine + 1 : fine;
        return bilinear(m, fine, s, t, k) * (1 - (level - fine)) + bilinear(m, coarse, s, t, k) * (level - fine);
    }
    const int rounded = (int)fmin(fmax(floor(lambda + 0.5), 0), LEVELS - 1), size = EDGE >> rounded;
    if (!(effects & VIT_BIT(NEAREST)))
        return bilinear(m, rounded, s, t, k);
    *near = fmin(fabs(s * size - round(s * size)), fabs(t * size - round(t * size)));
    return channel(texel(m, rounded, (int)(s * size), (int)(t * size)), k);
}

static void points_make(float in[3 * POINTS]) {
    uint64_t random = 9;
    for (int i = 0; i < POINTS; i++) {
        in[i] = floorf(lab_uniform(&random) * 4096.0f) / 4096.0f; /* s + 1 - s is 1 */
        in[POINTS + i] = floorf(lab_uniform(&random) * 4096.0f) / 4096.0f;
        in[2 * POINTS + i] = exp2f(12.0f * lab_uniform(&random) - 9.0f); /* 2^-3 to 2^9 texels */
    }
}

static void filter(const image *m, vit_u64 effects, unsigned lanes, const float *in, float *out) {
    lab l = lab_open(lanes, VIT_BIT(TEXTURES) | effects, kernels);
    const size_t size = 3 * POINTS * sizeof(float);
    const cl_mem arguments[] = {lab_buffer(&l, &m->texture, sizeof m->texture), lab_buffer(&l, m->mips, sizeof m->mips),
                                lab_buffer(&l, m->texels, sizeof m->texels), lab_buffer(&l, in, size),
                                lab_buffer(&l, NULL, size)};
    lab_run(&l, "filter_texture", POINTS / lanes, arguments, 5);
    lab_read(&l, arguments[4], out, size);
    for (int i = 0; i < 5; i++)
        clReleaseMemObject(arguments[i]);
    lab_close(&l);
}

static void check(vit_u64 effects) {
    static image m;
    static float in[3 * POINTS], out[3 * POINTS], wide[3 * POINTS];
    image_make(&m);
    points_make(in);
    filter(&m, effects, 1, in, out);
    for (int i = 0; i < POINTS; i++)
        for (int k = 0; k < 3; k++) {
            const float point[3] = {in[i], in[POINTS + i], in[2 * POINTS + i]};
            double near;
            const double want = expected(&m, effects, point, k, &near), got = (double)out[k * POINTS + i];
            if (near > 1e-5 && fabs(got - want) > 3e-6)
                fail_msg("s %g t %g footprint %g: channel %d is %g, not %g", (double)point[0], (double)point[1],
                         (double)point[2], k, got, want);
        }
    for (unsigned w = 1; w < LAB_WIDTHS; w++) {
        filter(&m, effects, lab_lanes[w], in, wide);
        assert_memory_equal(out, wide, sizeof out);
    }
}

static void nearest_takes_the_texel_under_the_point(void **state) {
    (void)state;
    check(VIT_BIT(NEAREST));
}

static void bilinear_blends_four_texels_of_the_nearest_level(void **state) {
    (void)state;
    check(0);
}

static void trilinear_blends_two_levels(void **state) {
    (void)state;
    check(VIT_BIT(TRILINEAR));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(nearest_takes_the_texel_under_the_point),
        cmocka_unit_test(bilinear_blends_four_texels_of_the_nearest_level),
        cmocka_unit_test(trilinear_blends_two_levels),
    };
    return cmocka_run_group_tests_name("texture filters", tests, NULL, NULL);
}
