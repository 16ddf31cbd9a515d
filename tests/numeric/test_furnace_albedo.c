/* Closed rooms of albedo 0, 1 and colours between, with 2 to 32 bounces.
 *
 * What can go wrong: an albedo that is stored a little above 1 feeds itself, and after 32 reflections the room glows; one
 * stored below 1 loses light at each; black must give nothing, not nearly nothing. In a closed room of area A round a light of
 * power Phi the mean of indirect irradiance is Phi / A * (rho + ... + rho^(bounces - 1)), whatever the room's shape; photon
 * powers add up to exactly that, so the mean has no noise. The bound is the estimate's loss over the box's edges, less than 2 %
 * with this radius (tests/golden/test_furnace.c); light of later reflections lies nearer to the edges, so more of it is lost,
 * but what is lost does not grow with the number of reflections, since estimates are not fed back. A black room's bound is 0.
 */
#include "catalogue.h"
#include "furnace_box.h"

#define POWER 60.0

static const double colours[][3] = {{0, 0, 0}, {1, 1, 1}, {0.9, 0.5, 0.1}};
static const char *const names[] = {"black", "white", "coloured"};

static int set_up(void **state) {
    static scene_lab lab;
    scene_lab_open(&lab);
    FILE *f = scene_lab_create(&lab, "half.mtl");
    for (int i = 0; i < 3; i++)
        (void)fprintf(f, "newmtl %s\nKd %g %g %g\n", names[i], colours[i][0], colours[i][1], colours[i][2]);
    (void)fclose(f);
    f = scene_lab_create(&lab, "box.cfg");
    (void)fprintf(f, "output: { width = %d; height = %d; fps = 1.0; frames = %d; };\nmeshes = ( { file = \"box.obj\"; } );\n",
                  SIDE, SIDE, VIEWS);
    write_views(f, eye);
    (void)fprintf(
        f,
        "lights = ( { type = \"point\"; keys = ( { position = [-0.3, 0.2, 0.4]; power = [%.1f, %.1f, %.1f]; } ); } );\n"
        "quality: { radius = 0.15; tile = 16; };\n",
        POWER, POWER, POWER);
    (void)fclose(f);
    *state = &lab;
    return 0;
}

static double closed_form(double albedo, int bounces) {
    double sum = 0, part = 1;
    for (int k = 1; k < bounces; k++)
        sum += part *= albedo;
    return POWER / box_area() * sum;
}

/* Largest deviation of a channel's mean irradiance from the closed form; of a black room, its largest pixel. */
static double deviation(scene_lab *l, int colour, int bounces) {
    static float pixels[FLOATS];
    char options[96];
    double worst = 0;
    write_box(l, names[colour]);
    (void)snprintf(options, sizeof options, "--photons 4096 --bounces %d", bounces);
    scene_lab_indirect(l, "box.cfg", options, pixels, FLOATS);
    for (int c = 0; c < 3; c++) {
        double light = 0, most = 0;
        for (int i = 0; i < VIEWS; i++)
            for (int y = 0; y < SIDE; y++)
                for (int x = 0; x < SIDE; x++) {
                    const double p = (double)pixels[4 * ((i * SIDE + y) * SIDE + x) + c];
                    light += pixel_area(i, x, y) * p * PI;
                    most = fmax(most, fabs(p));
                }
        const double albedo = colours[colour][c], truth = closed_form(albedo, bounces);
        const double off = truth > 0 ? fabs(light / box_area() / stored_albedo(albedo) / truth - 1) : most;
        (void)printf("%-9s %2d bounces, channel %d: off by %.3g\n", names[colour], bounces, c, off);
        worst = fmax(worst, off);
    }
    return worst;
}

static void black_rooms_give_nothing(void **state) {
    catalogue_row("furnace", "black, 2 and 32 bounces: largest pixel", fmax(deviation(*state, 0, 2), deviation(*state, 0, 32)),
                  0, "W/(m2 sr)");
}

static void white_rooms_keep_all_light(void **state) {
    catalogue_row("furnace", "white, 2 bounces: mean irradiance against the closed form", deviation(*state, 1, 2), 0.005,
                  "relative");
    catalogue_row("furnace", "white, 32 bounces: mean irradiance against the closed form", deviation(*state, 1, 32), 0.02,
                  "relative");
}

static void coloured_rooms_keep_each_channels_share(void **state) {
    catalogue_row("furnace", "coloured, 8 bounces: mean irradiance against the closed form", deviation(*state, 2, 8), 0.02,
                  "relative");
    catalogue_row("furnace", "coloured, 32 bounces: mean irradiance against the closed form", deviation(*state, 2, 32), 0.02,
                  "relative");
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(black_rooms_give_nothing), cmocka_unit_test(white_rooms_keep_all_light),
                                       cmocka_unit_test(coloured_rooms_keep_each_channels_share)};
    return cmocka_run_group_tests_name("furnace albedo", tests, set_up, scene_lab_tear_down);
}
