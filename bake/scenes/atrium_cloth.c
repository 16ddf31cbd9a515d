/* Curtains in the lower arches, tied back to the columns; banners over the gallery's balustrade. */
#include "atrium_parts.h"

/* Half a curtain. It hangs from a rod, is gathered by a tie towards its column and falls free below. */
typedef struct curtain {
    double edge;               /* x at the column */
    double way;                /* 1: it spreads to +x, -1: to -x */
    double top, tie, bottom;   /* heights */
    double spread, waist, hem; /* widths at these heights */
    double phase;
} curtain;

static double curtain_width(const curtain *c, double y) {
    if (y > c->tie) {
        double down = clamp01((c->top - y) / (c->top - c->tie));
        return lerp(c->spread, c->waist, down * down * (1.6 - 0.6 * down));
    }
    return lerp(c->waist, c->hem, smoothstep(0.0, 1.0, (c->tie - y) / (c->tie - c->bottom)));
}

static void curtain_point(const void *user, double s, double t, vertex *out) {
    const curtain *c = user;
    double y = lerp(c->top, c->bottom, t), width = curtain_width(c, y);
    /* The narrower it is gathered the deeper its folds, as the cloth keeps its length. */
    double gathered = clamp01((c->spread - width) / (c->spread - c->waist));
    double depth = lerp(0.055, 0.10, gathered) * smoothstep(-0.02, 0.15, t + 0.03);
    double angle = 2.0 * PI * 6.0 * s + c->phase + 0.9 * sine(3.0 * t + c->phase);
    double wave = sine(angle) + 0.35 * sine(1.7 * angle + 2.0 * t + c->phase);
    double sag = 0.22 * s * s * sine(PI * clamp01((c->top - y) / (c->top - c->tie)));
    double sway = 0.08 * width / 6.0 * cosine(angle);
    out->p = v3_of(c->edge + c->way * (s * width + sway), y - sag, depth * wave + 0.04 * gathered * sine(PI * s));
    out->u = s * 0.999;
    out->v = 1.0 - t;
}

static void tie(mesh *m, const curtain *c) {
    static const lathe_point band[] = {
        {0.9, -0.05, true}, {1.0, -0.03, false}, {1.04, 0.0, false}, {1.0, 0.03, false}, {0.9, 0.05, true}};
    shape_lathe l = {.profile = band, .count = 5, .segments = 20, .rings = 1};
    l.foot = v3_of(c->edge + c->way * (c->waist / 2.0), c->tie, 0.02);
    l.wide = c->waist / 2.0 + 0.06;
    shape_lathe_add(m, &l);
}

static void curtain_pair(mesh *m, double middle, const char *material, double phase, double spread) {
    const double rod = 3.34, half = BAY / 2.0 - 0.245;
    for (int end = -1; end <= 1; end += 2) {
        curtain c = {.edge = middle + end * (half - 0.02), .way = -end, .top = rod + 0.02, .tie = 1.35, .bottom = 0.06};
        c.spread = spread;
        c.waist = 0.26;
        c.hem = 0.46;
        c.phase = phase + end;
        mesh_group_begin(m, "curtains", material);
        shape_sheet(m, 42, 16, curtain_point, &c, end < 0);
        mesh_group_begin(m, "ties", "gilt");
        tie(m, &c);
    }
    mesh_group_begin(m, "rods", "gilt");
    shape_box(m, v3_of(middle - half, rod, -0.02), v3_of(middle + half, rod + 0.04, 0.02), 1.0, SIDE_LEFT | SIDE_RIGHT);
}

void atrium_curtains(mesh *m) {
    /* From x = -9.6 on; red and green face each other where the area light passes lowest. */
    static const char *const cloth[2][4] = {{"blue_cloth", "red_cloth", "blue_cloth", "green_cloth"},
                                            {"red_cloth", "green_cloth", "red_cloth", "blue_cloth"}};
    for (int side = 0; side < 4; side += 2) {
        atrium_side s = atrium_side_of(side);
        m->frame = s.frame;
        for (int i = 0; i < s.bays; i += 2)
            curtain_pair(m, atrium_bay(&s, i), side ? cloth[1][3 - i / 2] : cloth[0][i / 2], i * 1.3 + side, 1.33);
    }
    m->frame = mesh_frame_at(v3_of(0, 0, 0), 0);
}

/* A banner's path from the rail over the string course down the wall: (out, height) of the arcade's line. */
static const double path[5][2] = {{0.00, 6.975}, {0.27, 6.97}, {0.63, 6.02}, {0.64, 5.2}, {0.50, 3.75}};

typedef struct banner {
    double middle, half, phase;
} banner;

static void banner_point(const void *user, double s, double t, vertex *out) {
    const banner *b = user;
    static const double at[5] = {0.0, 0.08, 0.40, 0.63, 1.0}; /* arc length of the path's points */
    double x = 2.0 * s - 1.0, cut = 1.0 - 0.16 * fabs(x);     /* the hem is a point */
    double l = t * cut;
    int i = l < at[1] ? 0 : l < at[2] ? 1 : l < at[3] ? 2 : 3;
    double f = (l - at[i]) / (at[i + 1] - at[i]);
    double loose = smoothstep(0.35, 1.0, l);
    double fold =
        sine(2.0 * PI * 1.5 * s + b->phase + 1.5 * l) * 0.05 * loose + 0.012 * sine(2.0 * PI * 4.0 * s + b->phase) * loose;
    out->p = v3_of(b->middle + b->half * x * (1.0 - 0.05 * loose), lerp(path[i][1], path[i + 1][1], f) + 0.005,
                   lerp(path[i][0], path[i + 1][0], f) + fold);
    out->u = s;
    out->v = 1.0 - t;
}

void atrium_banners(mesh *m) {
    static const char *const cloth[3] = {"green_cloth", "red_cloth", "blue_cloth"};
    for (int side = 0; side < 4; side++) {
        atrium_side s = atrium_side_of(side);
        m->frame = s.frame;
        for (int i = s.is_long ? 1 : 0; i < s.bays; i += 2) {
            banner b = {atrium_bay(&s, i), 0.72, i * 1.7 + side};
            mesh_group_begin(m, "banners", cloth[(i + side) % 3]);
            shape_sheet(m, 16, 25, banner_point, &b, true);
        }
    }
    m->frame = mesh_frame_at(v3_of(0, 0, 0), 0);
}
