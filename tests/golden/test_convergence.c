/* More photons and a smaller radius give a better picture, step after step.
 *
 * What makes this hard to test: the error of a density estimate has two parts that pull apart. Noise falls with N r^2, the photons
 * inside the radius; bias (light that leaks round corners, blurred shadows) falls with the radius, and more photons alone
 * do not touch it. Both vanish if N grows and r shrinks so that N r^2 still grows. Each step takes 4 times the photons and
 * r / sqrt 2, that is r ~ N^(-1/4): N r^2 doubles, so the variance halves, and so does the square of the bias near edges, which goes
 * with r there (with r^2 elsewhere). N^(-1/6), best for smooth surfaces, would leave the edges of the boxes behind.
 *
 * The yardstick is a run of our own, 64 times the photons of the last step and the radius of three steps more. It spreads its
 * paths otherwise (the strata of the emission depend on their number), so its errors are its own. Error: mean squared
 * difference over the squared mean of the indirect light, linear. Whether the limit is the right picture is what the furnace
 * tests. */
#include "scene_lab.h"
#include <math.h>

#define SIDE 128 /* pixels of the frame's edge */
#define FLOATS ((size_t)4 * SIDE * SIDE)
#define STEPS 5
#define FIRST_PATHS 48   /* 12 288 at the last step, 786 432 for the yardstick: multiples of 16, as the baker shares paths out */
#define FIRST_RADIUS 0.8 /* m, in a room 2 m wide; 0.2 at the last step, 0.07 for the yardstick */
#define YARDSTICK 3      /* steps of 4 times the photons beyond the last */

static void play_step(scene_lab *l, int step, float *pixels) {
    char options[128];
    (void)snprintf(options, sizeof options, "--size %dx%d --frames 1 --photons %d --radius %.5f", SIDE, SIDE, FIRST_PATHS << (2 * step),
                   FIRST_RADIUS * pow(2, -0.5 * step));
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
    double before = INFINITY, first = 0, last = 0;
    play_step(*state, STEPS - 1 + YARDSTICK, truth);
    for (int step = 0; step < STEPS; step++) {
        play_step(*state, step, pixels);
        last = error_against(truth, pixels);
        printf("%6d paths, radius %.3f m: NMSE %.4f\n", FIRST_PATHS << (2 * step), FIRST_RADIUS * pow(2, -0.5 * step), last);
        assert_true(last < before);
        before = last;
        first = step == 0 ? last : first;
    }
    assert_true(last < first / 8); /* halving at each of the 4 steps would give 16 */
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
