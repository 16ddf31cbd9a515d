/* The atrium's surfaces. Colours are sRGB; every pattern repeats over the unit square. */
#include "textures.h"
#include "noise.h"
#include "vector.h"

static void mix(double rgb[3], const double to[3], double t) {
    for (int k = 0; k < 3; k++)
        rgb[k] = lerp(rgb[k], to[k], t);
}

static void set(double rgb[3], const double from[3], double brightness) {
    for (int k = 0; k < 3; k++)
        rgb[k] = from[k] * brightness;
}

/* Distance from the border of the cell that x lies in, cells of size 1. */
static double border(double x) {
    double f = x - floor(x);
    return f < 0.5 ? f : 1.0 - f;
}

static void marble_pattern(double u, double v, double rgb[3]) {
    static const double cream[3] = {0.86, 0.83, 0.77}, warm[3] = {0.78, 0.70, 0.60}, grey[3] = {0.52, 0.49, 0.47};
    set(rgb, cream, 1.0);
    mix(rgb, warm, 0.75 * smoothstep(0.35, 0.75, noise_fractal(u, v, 4, 5, 11)));
    mix(rgb, grey, 0.55 * noise_veins(u, v, 3, 6, 14.0, 21));
    mix(rgb, grey, 0.30 * noise_veins(u, v, 7, 5, 12.0, 31));
}

/* 4 x 4 marble slabs, dark and light by turns, each with its own piece of vein pattern. */
static void court_pattern(double u, double v, double rgb[3]) {
    static const double light[3] = {0.84, 0.80, 0.73}, vein_light[3] = {0.62, 0.56, 0.50};
    static const double dark[3] = {0.44, 0.30, 0.26}, vein_dark[3] = {0.72, 0.60, 0.52}, grout[3] = {0.36, 0.33, 0.30};
    double x = u * 4.0, y = v * 4.0;
    int i = (int)floor(x) & 3, j = (int)floor(y) & 3;
    bool is_dark = ((i + j) & 1) != 0;
    double tone = 0.92 + 0.12 * noise_cell(i, j, 5);
    double su = u + noise_cell(i, j, 6), sv = v + noise_cell(i, j, 7); /* slabs do not continue each other's veins */
    set(rgb, is_dark ? dark : light, tone * (0.90 + 0.18 * noise_fractal(su, sv, 8, 5, 3)));
    mix(rgb, is_dark ? vein_dark : vein_light, 0.55 * noise_veins(su, sv, 5, 6, 12.0, is_dark ? 41 : 42));
    double edge = border(x) < border(y) ? border(x) : border(y);
    mix(rgb, grout, 1.0 - smoothstep(0.010, 0.020, edge));
}

/* 6 x 6 terracotta tiles. */
static void terracotta_pattern(double u, double v, double rgb[3]) {
    static const double clay[3] = {0.76, 0.47, 0.34}, pale[3] = {0.84, 0.62, 0.46}, grout[3] = {0.55, 0.50, 0.44};
    double x = u * 6.0, y = v * 6.0;
    int i = (int)floor(x) % 6, j = (int)floor(y) % 6;
    set(rgb, clay, 0.86 + 0.20 * noise_cell(i, j, 51));
    mix(rgb, pale, 0.6 * noise_cell(i, j, 52) * noise_fractal(u, v, 12, 4, 53));
    double speck = noise_fractal(u, v, 64, 2, 54);
    set(rgb, rgb, 0.93 + 0.14 * speck);
    double edge = border(x) < border(y) ? border(x) : border(y);
    edge += 0.012 * (noise_value(u, v, 64, 55) - 0.5);
    mix(rgb, grout, 1.0 - smoothstep(0.022, 0.042, edge));
}

/* Ashlar: 8 courses of 4 blocks, every other course shifted by half a block. */
static void ashlar_pattern(double u, double v, double rgb[3]) {
    static const double stone[3] = {0.84, 0.80, 0.73}, tint[3] = {0.80, 0.71, 0.60}, joint[3] = {0.58, 0.52, 0.44};
    double y = v * 8.0;
    int j = (int)floor(y) & 7;
    double x = u * 4.0 + 0.5 * (j & 1) + 0.12 * (noise_cell(j, 0, 61) - 0.5);
    int i = (int)floor(x) & 3;
    set(rgb, stone, 0.90 + 0.13 * noise_cell(i, j, 62));
    mix(rgb, tint, 0.55 * noise_cell(i, j, 63));
    double grain = noise_fractal(u, v, 16, 6, 64);
    set(rgb, rgb, 0.86 + 0.26 * grain);
    double edge_x = border(x) * 2.0, edge_y = border(y); /* a block is twice as long as high */
    double edge = (edge_x < edge_y ? edge_x : edge_y) + 0.02 * (noise_value(u, v, 96, 65) - 0.5);
    mix(rgb, joint, 1.0 - smoothstep(0.015, 0.045, edge));
}

static void plaster_pattern(double u, double v, double rgb[3]) {
    static const double ochre[3] = {0.87, 0.79, 0.66}, pale[3] = {0.88, 0.84, 0.76}, stain[3] = {0.77, 0.67, 0.54};
    set(rgb, ochre, 1.0);
    mix(rgb, pale, smoothstep(0.35, 0.7, noise_fractal(u, v, 4, 6, 71)));
    mix(rgb, stain, 0.35 * smoothstep(0.55, 0.8, noise_fractal(u, v, 6, 6, 72)));
    set(rgb, rgb, 0.96 + 0.08 * noise_fractal(u, v, 64, 3, 73));
}

/* Eight planks along u. */
static void wood_pattern(double u, double v, double rgb[3]) {
    static const double brown[3] = {0.56, 0.38, 0.25}, dark[3] = {0.38, 0.24, 0.15};
    double y = v * 8.0;
    int j = (int)floor(y) & 7;
    double su = u + noise_cell(j, 1, 81), grain = noise_value(su, v, 64, 82) * 0.2;
    double rings = 0.5 + 0.5 * sine(2.0 * PI * (6.0 * (y - floor(y)) + 3.0 * noise_fractal(su, v, 4, 4, 83)));
    set(rgb, brown, 0.85 + 0.25 * noise_cell(j, 0, 84));
    mix(rgb, dark, 0.45 * rings * rings + grain);
    mix(rgb, dark, 1.0 - smoothstep(0.01, 0.035, border(y)));
}

/* 1 where x is less than `limit`, with a soft edge. */
static double within(double x, double limit) {
    return 1.0 - smoothstep(limit - 0.006, limit + 0.006, x);
}

/* Painted pottery: a band of waves and one of lozenges between rings, on a pale glaze. */
static void glaze_pattern(double u, double v, double rgb[3]) {
    static const double pale[3] = {0.86, 0.84, 0.78}, blue[3] = {0.14, 0.26, 0.56}, gold[3] = {0.78, 0.58, 0.24};
    set(rgb, pale, 0.95 + 0.06 * noise_fractal(u, v, 16, 3, 91));
    double wave = 0.5 + 0.16 * sine(2.0 * PI * 6.0 * u), lozenge = border(u * 12.0) + border(v * 4.0);
    mix(rgb, blue, within(fabs(v - wave), 0.05));
    double fields = v < 0.25 || v > 0.75 ? 1.0 : 0.0;
    mix(rgb, blue, fields * within(lozenge, 0.42));
    mix(rgb, gold, fields * within(lozenge, 0.2));
    mix(rgb, gold, within(fabs(v - 0.28), 0.015));
    mix(rgb, gold, within(fabs(v - 0.72), 0.015));
    mix(rgb, gold, within(border(v), 0.015));
}

/* Woven cloth: v = 0..1 from top to hem. A gold border, and gold lozenges with a flower of four leaves in each. */
static void cloth(double u, double v, const double ground[3], const double thread[3], double rgb[3]) {
    double weave = 0.94 + 0.06 * sine(2.0 * PI * 128.0 * u) * sine(2.0 * PI * 256.0 * v);
    set(rgb, ground, weave * (0.92 + 0.14 * noise_fractal(u, v, 8, 4, 101)));
    double x = u * 5.0 - 0.5, y = v * 10.0 - 0.5;
    double fx = x - floor(x + 0.5), fy = y - floor(y + 0.5);
    double ring = fabs(fabs(fx) + fabs(fy) - 0.42);
    double d = sqrt(fx * fx + fy * fy), petals = d > 0.0 ? 2.0 * fabs(fx * fy) / (d * d) : 0.0;
    double flower = d - 0.09 - 0.12 * petals;
    double gold = 0.45 * (1.0 - smoothstep(0.015, 0.035, ring)) + 0.7 * (1.0 - smoothstep(-0.01, 0.02, flower));
    double side = border(u), hem = v < 0.5 ? 1.0 : 1.0 - v;
    bool inside = side > 0.085 && hem > 0.05;
    if (!inside)
        gold = (side > 0.02 && side < 0.075) || (hem > 0.012 && hem < 0.04 && side > 0.02) ? 0.85 : 0.0;
    mix(rgb, thread, clamp01(gold) * weave);
}

static const double gold_thread[3] = {0.83, 0.64, 0.27};

static void red_pattern(double u, double v, double rgb[3]) {
    static const double red[3] = {0.76, 0.12, 0.11};
    cloth(u, v, red, gold_thread, rgb);
}

static void green_pattern(double u, double v, double rgb[3]) {
    static const double green[3] = {0.13, 0.52, 0.24};
    cloth(u, v, green, gold_thread, rgb);
}

static void blue_pattern(double u, double v, double rgb[3]) {
    static const double blue[3] = {0.13, 0.27, 0.70};
    cloth(u, v, blue, gold_thread, rgb);
}

/* Boxed leaves: light specks on dark green. */
static void leaves_pattern(double u, double v, double rgb[3]) {
    static const double shade[3] = {0.16, 0.30, 0.10}, leaf[3] = {0.46, 0.62, 0.24};
    set(rgb, shade, 1.0);
    mix(rgb, leaf, smoothstep(0.35, 0.7, noise_fractal(u, v, 48, 3, 111)));
}

const texture *atrium_textures(size_t *count) {
    static const texture list[] = {
        {"marble.png", 1024, 1024, marble_pattern},       {"court.png", 1024, 1024, court_pattern},
        {"terracotta.png", 512, 512, terracotta_pattern}, {"ashlar.png", 1024, 1024, ashlar_pattern},
        {"plaster.png", 512, 512, plaster_pattern},       {"wood.png", 512, 512, wood_pattern},
        {"glaze.png", 1024, 1024, glaze_pattern},         {"red.png", 512, 1024, red_pattern},
        {"green.png", 512, 1024, green_pattern},          {"blue.png", 512, 1024, blue_pattern},
        {"leaves.png", 256, 256, leaves_pattern},
    };
    *count = sizeof list / sizeof list[0];
    return list;
}
