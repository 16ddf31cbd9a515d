/* Depth slices: floor(log2(depth / near) * scale), at and beyond the nearest and the farthest slice.
 *
 * What can go wrong: a depth of 0, of less than near, negative, subnormal or infinite has no logarithm or an enormous one, and
 * a conversion to int of what is no int is undefined; the polynomial of log2 may step back where its octaves join, and then a
 * farther sample lies in a nearer slice. The bounds: slices never step back, from -FLT_MAX to infinity; the number before
 * slice_first is in 0..8191; and a border between slices lies where double has it but for roundings, 2e-6 of its depth at 8 to
 * 1000 slices a doubling. */
#include "catalogue.h"
#include "host_lab.h"
#include <float.h>
#include <math.h>

#define PER_OCTAVE 4096
#define LEAST (-150)
#define MOST 128
#define COUNT ((uint32_t)(MOST - LEAST) * PER_OCTAVE)

/* Ascending depths: octaves from the least subnormal to FLT_MAX, evenly filled. */
static float *depths(void) {
    float *z = malloc(COUNT * sizeof *z);
    assert_non_null(z);
    for (uint32_t i = 0; i < COUNT; i++)
        z[i] = (float)ldexp(1.0 + (double)(i % PER_OCTAVE) / PER_OCTAVE, LEAST + (int)(i / PER_OCTAVE));
    return z;
}

static void check_scale(float near, float scale, uint64_t *back, uint64_t *outside, double *border) {
    const vit_scene s = {.slice_near = near, .slice_scale = scale};
    float *z = depths();
    int32_t *slice = malloc(COUNT * sizeof *slice);
    assert_non_null(slice);
    host_lab_find()->slices(&s, z, COUNT, slice);
    for (uint32_t i = 0; i < COUNT; i++) {
        *back += i > 0 && slice[i] < slice[i - 1];
        *outside += slice[i] < 0 || slice[i] > 8191;
        const double at = (double)z[i] / (double)near, exact = fmax(floor(log2(fmax(at, 1)) * (double)scale), 0);
        if (exact > 8191 || at > (double)FLT_MAX || (double)slice[i] == exact) /* clamped; a quotient that is no float */
            continue;
        /* The border between them, and how far off the depth is. */
        const double edge = exp2(fmax(exact, (double)slice[i]) / (double)scale);
        *border = fmax(*border, fabs(at / edge - 1));
    }
    free(z);
    free(slice);
}

static void slices_are_monotone_clamped_and_where_double_has_them(void **state) {
    static const float nears[] = {1e-6f, 0.05f, 0.125f, 1e6f}, scales[] = {0.3f, 8, 22.7f, 1000};
    uint64_t back = 0, outside = 0, count = 0;
    double border = 0;
    (void)state;
    for (int i = 0; i < 4; i++)
        for (int k = 0; k < 4; k++, count += COUNT)
            check_scale(nears[i], scales[k], &back, &outside, &border);
    catalogue_none("depth slices", "a farther sample in a nearer slice", back, count, "depths");
    catalogue_none("depth slices", "slices out of 0..8191", outside, count, "depths");
    catalogue_row("depth slices", "distance of a border between slices from its place", border, 1e-5, "of its depth");
}

static void depths_that_are_none_lie_in_the_ends(void **state) {
    const float odd[HOST_LAB_LANES] = {0, -0.0f, -1, -FLT_MAX, -INFINITY, 1e-45f, INFINITY, FLT_MAX};
    const int32_t first = -5, last = 8191 - 5;
    const int32_t expected[HOST_LAB_LANES] = {first, first, first, first, first, first, last, last};
    const vit_scene s = {.slice_near = 0.125f, .slice_scale = 1000, .slice_first = 5};
    int32_t slice[HOST_LAB_LANES];
    uint64_t wrong = 0;
    (void)state;
    host_lab_find()->slices(&s, odd, HOST_LAB_LANES, slice);
    for (uint32_t i = 0; i < HOST_LAB_LANES; i++)
        wrong += slice[i] != expected[i];
    catalogue_none("depth slices", "0, negative, subnormal and infinite depths not in the end slices", wrong, HOST_LAB_LANES,
                   "depths");
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(slices_are_monotone_clamped_and_where_double_has_them),
                                       cmocka_unit_test(depths_that_are_none_lie_in_the_ends)};
    return cmocka_run_group_tests_name("depth slices", tests, NULL, NULL);
}
