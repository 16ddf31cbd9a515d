/* More photons and a smaller radius give a better picture, step after step.
 *
 * What makes this hard to test: the error of a density estimate has two parts that pull apart. Noise falls with N r^2, the
 * photons inside the radius; bias (light that leaks round corners, blurred shadows) falls with the radius, and more photons
 * alone do not touch it. Both vanish if N grows and r shrinks so that N r^2 still grows. Each step takes 4 times the photons
 * and r / sqrt 2, that is r ~ N^(-1/4): N r^2 doubles, so the variance halves, and so does the square of the bias near edges,
 * which goes with r there (with r^2 elsewhere). N^(-1/6), best for smooth surfaces, would leave the edges of the boxes behind.
 *
 * The yardstick is a run of our own with 64 times the photons of the fourth step, about as many as a frame may have, and half
 * the radius of the fifth. It spreads its paths otherwise (the strata of the emission depend on their number), so its errors
 * are its own. Error: mean squared difference over the squared mean of the indirect light, linear. Whether the limit is the
 * right picture is what the furnace tests. */
#include "scene_lab.h"
#include <math.h>

#define SIDE 128 /* pixels of the frame's edge */
#define FLOATS ((size_t)4 * SIDE * SIDE)
#define STEPS 5
#define FIRST_PATHS 240  /* 61 440 at the last step, 983 040 for the yardstick */
#define FIRST_RADIUS 0.6 /* m, in a room 2 m wide; 0.15 at the last step, 0.075 for the yardstick */
#define LAST_ERROR 0.03  /* at most; measured 0.021. A yardstick that is wrong itself shows here */
#define YARDSTICK 6      /* the step that the yardstick would be, the first is 0 */

static void play_step(scene_lab *l, int step, float *pixels) {
    char options[128];
    (void)snprintf(options, sizeof options, "--size %dx%d --frames 1 --photons %d --radius %.5f", SIDE, SIDE,
                   FIRST_PATHS << (2 * step), FIRST_RADIUS * pow(2, -0.5 * step));
    scene_lab_indirect(l, VIT_BUILD_DIR "/scenes/cornell.cfg", options, pixels, FLOATS);
}

static double error_against(const float *truth, const float *pixels) {
    double mean = 0, squares = 0;
    for (size_t i = 0; i < FLOATS; i++)
        if (i % 4 != 3) {
            const double d = (double)pixels[i] - (double)truth[i];
            mean += (double)truth[i];
            squares += d * d;
        }
    const double n = 3.0 * SIDE * SIDE;
    return squares / n / (mean / n * mean / n);
}

static void error_falls_with_every_step(void **state) {
    static float truth[FLOATS], pixels[FLOATS];
    double before = INFINITY;
    play_step(*state, YARDSTICK, truth);
    for (int step = 0; step < STEPS; step++) {
        play_step(*state, step, pixels);
        const double error = error_against(truth, pixels);
        printf("%6d paths, radius %.3f m: NMSE %.4f\n", FIRST_PATHS << (2 * step), FIRST_RADIUS * pow(2, -0.5 * step), error);
        assert_true(error < before);
        before = error;
    }
    assert_true(before < LAST_ERROR);
}

static int set_up(void **state) {
    static scene_lab lab;
    scene_lab_open(&lab);
    *state = &lab;
    return 0;
}

static int tear_down(void **state) {
    scene_lab_close(*state);
    return 0;
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(error_falls_with_every_step)};
    return cmocka_run_group_tests_name("convergence", tests, set_up, tear_down);
}
