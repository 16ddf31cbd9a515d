/* Fountain, vases, benches and clipped trees. */
#include "atrium_parts.h"
#include "noise.h"

typedef struct turned {
    const char *object, *material;
    const lathe_point *profile;
    int count, segments, rings;
    double uv, around;
} turned;

static void turned_add(mesh *m, const turned *k, v3 foot, double scale) {
    shape_lathe l = {.foot = foot, .profile = k->profile, .count = k->count, .segments = k->segments, .rings = k->rings};
    l.scale = scale;
    l.uv = k->uv;
    l.around = k->around;
    mesh_group_begin(m, k->object, k->material);
    shape_lathe_add(m, &l);
}

static void fountain(mesh *m, v3 foot) {
    static const lathe_point basin[] = {{1.75, 0.0, true},   {1.75, 0.10, true}, {1.60, 0.14, true},  {1.56, 0.24, false},
                                        {1.58, 0.36, false}, {1.66, 0.44, true}, {1.74, 0.46, true},  {1.78, 0.50, false},
                                        {1.74, 0.55, true},  {1.50, 0.55, true}, {1.46, 0.50, false}, {1.44, 0.20, true}};
    static const lathe_point water[] = {{1.46, 0.40, true}, {0.0, 0.40, true}};
    static const lathe_point foot_and_bowl[] = {
        {0.42, 0.30, true},  {0.42, 0.55, true},  {0.30, 0.60, true},  {0.20, 0.72, false}, {0.17, 0.95, false},
        {0.22, 1.12, false}, {0.16, 1.22, true},  {0.20, 1.25, true},  {0.45, 1.32, false}, {0.72, 1.45, false},
        {0.86, 1.60, true},  {0.90, 1.61, false}, {0.90, 1.66, false}, {0.85, 1.67, true},  {0.78, 1.58, true}};
    static const lathe_point pond[] = {{0.80, 1.61, true}, {0.0, 1.61, true}};
    static const lathe_point figure[] = {{0.22, 1.55, true},  {0.22, 1.72, true},  {0.14, 1.76, true},  {0.11, 1.90, false},
                                         {0.16, 2.06, false}, {0.20, 2.20, false}, {0.15, 2.36, false}, {0.08, 2.46, true},
                                         {0.13, 2.48, true},  {0.13, 2.52, true},  {0.06, 2.54, true},  {0.05, 2.60, true},
                                         {0.13, 2.65, false}, {0.17, 2.77, false}, {0.13, 2.89, false}, {0.0, 2.94, true}};
    const turned parts[5] = {{"fountain_basin", "marble", basin, 12, 56, 2, 1.5, 4.0},
                             {"fountain_water", "water", water, 2, 64, 1, 1.0, 1.0},
                             {"fountain_bowl", "marble", foot_and_bowl, 15, 40, 2, 1.5, 2.0},
                             {"fountain_pond", "water", pond, 2, 48, 1, 1.0, 1.0},
                             {"fountain_figure", "gilt", figure, 16, 28, 2, 1.0, 1.0}};
    for (int i = 0; i < 5; i++)
        turned_add(m, parts + i, foot, 1.0);
}

/* 1 m high at scale 1. The texture runs once from foot to lip. */
static const lathe_point amphora[] = {{0.17, 0.00, true},  {0.18, 0.04, true},  {0.13, 0.07, true},  {0.20, 0.20, false},
                                      {0.32, 0.45, false}, {0.34, 0.62, false}, {0.26, 0.78, false}, {0.15, 0.86, true},
                                      {0.14, 0.92, false}, {0.20, 0.99, true},  {0.19, 1.00, true},  {0.12, 0.92, false},
                                      {0.10, 0.80, true}};
static const lathe_point jar[] = {{0.22, 0.00, true}, {0.34, 0.14, false}, {0.42, 0.36, false}, {0.36, 0.58, false},
                                  {0.24, 0.68, true}, {0.24, 0.74, true},  {0.30, 0.77, false}, {0.30, 0.80, false},
                                  {0.25, 0.80, true}, {0.20, 0.70, true}};

static void vases(mesh *m) {
    const turned tall = {"vases", "glaze", amphora, 13, 24, 2, 1.35, 1.0}, low = {"jars", "clay", jar, 10, 24, 2, 1.0, 1.0};
    for (int side = -1; side <= 1; side += 2) {
        for (int k = -1; k <= 1; k++) {
            turned_add(m, &tall, v3_of(k * 2.0 * BAY + BAY / 2.0, COURT_FLOOR, side * 3.35), 1.25);
            turned_add(m, &low, v3_of(k * 2.0 * BAY + 2.3, COURT_FLOOR, side * 3.45), 0.8);
        }
    }
}

static void bench(mesh *m, v3 at) {
    mesh_group_begin(m, "benches", "trim");
    for (int end = -1; end <= 1; end += 2) {
        double x = at.x + end * 0.62;
        shape_box(m, v3_of(x - 0.10, at.y, at.z - 0.17), v3_of(x + 0.10, at.y + 0.06, at.z + 0.17), 1.0, SIDE_BOTTOM);
        shape_box(m, v3_of(x - 0.07, at.y + 0.06, at.z - 0.13), v3_of(x + 0.07, at.y + 0.36, at.z + 0.13), 1.0, SIDE_BOTTOM);
        shape_box(m, v3_of(x - 0.10, at.y + 0.36, at.z - 0.17), v3_of(x + 0.10, at.y + 0.40, at.z + 0.17), 1.0, SIDE_TOP);
    }
    mesh_group_begin(m, "bench_seats", "marble");
    shape_box(m, v3_of(at.x - 0.9, at.y + 0.40, at.z - 0.21), v3_of(at.x + 0.9, at.y + 0.48, at.z + 0.21), 1.7, 0);
}

/* A sphere made uneven, for a clipped crown. */
typedef struct crown {
    v3 middle;
    double radius;
    uint32_t seed;
} crown;

static void crown_point(const void *user, double s, double t, vertex *out) {
    const crown *c = user;
    double around = -2.0 * PI * s, up = PI * (t - 0.5);
    double r = c->radius * (1.0 + 0.16 * (noise_fractal(s, 0.5 * t, 16, 2, c->seed) - 0.5) * cosine(up));
    out->p = v3_add(c->middle, v3_of(r * cosine(up) * cosine(around), r * sine(up), r * cosine(up) * sine(around)));
    out->u = 2.0 * s;
    out->v = t;
}

static void tree(mesh *m, v3 at, uint32_t seed) {
    const double half = 0.34;
    mesh_group_begin(m, "planters", "clay");
    shape_box(m, v3_of(at.x - half, at.y, at.z - half), v3_of(at.x + half, at.y + 0.56, at.z + half), 1.0, SIDE_BOTTOM);
    shape_box(m, v3_of(at.x - half - 0.05, at.y + 0.56, at.z - half - 0.05),
              v3_of(at.x + half + 0.05, at.y + 0.64, at.z + half + 0.05), 1.0, 0);
    static const lathe_point trunk[] = {{0.06, 0.64, true}, {0.045, 1.0, false}, {0.045, 1.5, true}};
    turned_add(m, &(turned){"trunks", "wood", trunk, 3, 10, 2, 1.0, 1.0}, at, 1.0);
    mesh_group_begin(m, "crowns", "leaves");
    crown c = {v3_of(at.x, at.y + 1.75, at.z), 0.52, seed};
    shape_sheet(m, 30, 18, crown_point, &c, false);
}

/* A cap on a chain; the scene file puts a light under it. */
static void lantern(mesh *m, v3 light, double chain) {
    static const lathe_point cap[] = {{0.20, 0.20, true},  {0.24, 0.22, true}, {0.23, 0.25, true},  {0.16, 0.32, false},
                                      {0.05, 0.38, false}, {0.02, 0.44, true}, {0.012, 0.46, true}, {0.012, 1.0, true}};
    static const lathe_point inside[] = {{0.0, 0.30, true}, {0.20, 0.20, true}};
    lathe_point with_chain[8];
    for (int i = 0; i < 8; i++)
        with_chain[i] = cap[i];
    with_chain[7].y = chain;
    turned_add(m, &(turned){"lanterns", "gilt", with_chain, 8, 20, 2, 1.0, 1.0}, light, 1.0);
    turned_add(m, &(turned){"lanterns", "gilt", inside, 2, 20, 1, 1.0, 1.0}, light, 1.0);
}

void atrium_props(mesh *m) {
    fountain(m, v3_of(BAY, COURT_FLOOR, 0));
    lantern(m, v3_of(COURT_X + 1.75, 3.3, 0), 2.3);
    vases(m);
    for (int side = -1; side <= 1; side += 2) {
        bench(m, v3_of(0, COURT_FLOOR, side * 3.4));
        bench(m, v3_of(-2.0 * BAY, COURT_FLOOR, side * 3.4));
        tree(m, v3_of(COURT_X - 1.7, COURT_FLOOR, side * 3.1), side < 0 ? 121 : 122);
        tree(m, v3_of(-COURT_X + 1.7, COURT_FLOOR, side * 3.1), side < 0 ? 123 : 124);
    }
}
