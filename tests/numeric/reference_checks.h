/* What tests of the reference with effects share: checks whose worst is a row of the catalogue, and a floor with a camera
 * above.
 *
 * What is drawn at random is held to five times the standard error that the reference states, and that error to a bound, so
 * that no check passes for its noise. */
#ifndef VIT_TESTS_REFERENCE_CHECKS_H
#define VIT_TESTS_REFERENCE_CHECKS_H

#include "catalogue.h"
#include "reference_lab.h"
#include <stdio.h>

#define WITHIN 1e-3
#define EXACT 2e-5 /* what is not random: floats, and rays that leave surfaces by an offset */

static double worst; /* of all that was expected, as a part of what is allowed, times WITHIN */

static inline void expect_within(const char *what, double found, double wanted, double bound) {
    const double off = wanted != 0 ? fabs(found / wanted - 1) : fabs(found);
    worst = fmax(worst, off / bound * WITHIN);
    printf("%-66s %12.6g, wanted %12.6g: %+.4f %%\n", what, found, wanted,
           wanted != 0 ? 100 * (found / wanted - 1) : 100 * found);
    if (!(off < bound))
        fail_msg("%s: %.8g, wanted %.8g", what, found, wanted);
}

static inline void expect(const char *what, double found, double wanted) {
    expect_within(what, found, wanted, WITHIN);
}

/* Errors of `frames` frames' direct light in the first channel, pixel by pixel, against `wanted`: their squares over the stated
 * variances, 1 on average; the mean, within 5 standard errors and WITHIN. The frames differ in their random numbers alone. */
static inline void expect_pixels(const char *what, reference_lab *l, uint32_t frames, const double *wanted) {
    const size_t pixels = (size_t)l->meta.width * l->meta.height;
    double squares = 0, stated = 0, sum = 0, sum_wanted = 0;
    for (uint32_t f = 0; f < frames; f++) {
        l->cameras[f] = l->cameras[0];
        reference r = lab_render(l, f);
        for (size_t i = 0; i < pixels; i++) {
            squares += pow(r.direct[3 * i] - wanted[i], 2);
            stated += r.direct_variance[3 * i];
            sum += r.direct[3 * i];
            sum_wanted += wanted[i];
        }
        reference_free(&r);
    }
    printf("%s: squared errors over the stated variance: %.3f; standard error %.4f %%\n", what, squares / stated,
           100 * sqrt(stated) / sum_wanted);
    expect(what, sum / (double)pixels / frames, sum_wanted / (double)pixels / frames);
    assert_true(stated > 0 && squares / stated > 1 / 1.4 && squares / stated < 1.4);
    assert_true(fabs(sum - sum_wanted) < 5 * sqrt(stated));
}

static const float origin[3] = {0, 0, 0}, x_axis[3] = {1, 0, 0}, z_axis[3] = {0, 0, 1}, back[3] = {0, 0, -1};

static inline void material_of(reference_lab *l, uint32_t i, uint32_t kind, float specular, float exponent, float ior) {
    vit_material *m = l->room->materials + i;
    m->kind = kind;
    m->exponent = exponent;
    m->ior = ior;
    for (int k = 0; k < 3; k++) {
        m->specular[k] = specular;
        if (kind != VIT_MATTE)
            m->albedo[k] = 0;
    }
}

static inline void emits(reference_lab *l, uint32_t i, float radiance, uint32_t lights) {
    vit_material *m = l->room->materials + i;
    m->lights = lights;
    for (int k = 0; k < 3; k++)
        m->emission[k] = radiance * (float)(k + 1);
}

static inline void sky_of(reference_lab *l, float radiance) {
    l->meta.effects |= VIT_BIT(SKY_LIGHT);
    for (int k = 0; k < 3; k++)
        l->meta.background[k] = radiance * (float)(k + 1);
}

/* A floor of the unit square about the origin at y = -1/2, normal up, material 0; frame 0 sees it all from `eye`. */
static const float floor_corner[3] = {-0.5f, -0.5f, 0.5f};

static inline void add_floor(room *r) {
    room_quad(r, floor_corner, x_axis, back, 0);
}

static inline void see_floor(reference_lab *l, const float eye[3]) {
    lab_look(l, 0, eye, floor_corner, x_axis, back);
}

/* After the last check; `of`: what was checked. */
static inline void checks_row(const char *of) {
    assert_true(worst > 0);
    catalogue_row("reference", of, worst / WITHIN, 1, "bounds");
}

#endif
