/* Columns, piers' pedestals and balusters. */
#include "atrium_parts.h"

/* Attic base, shaft with a slight swelling, astragal; radii in metres for the ground storey. */
static const lathe_point base[] = {{0.36, 0.20, true},   {0.385, 0.22, false}, {0.395, 0.27, false}, {0.36, 0.33, true},
                                   {0.33, 0.34, true},   {0.30, 0.37, false},  {0.315, 0.41, true},  {0.335, 0.43, false},
                                   {0.335, 0.47, false}, {0.30, 0.50, true},   {0.275, 0.53, true}};
static const lathe_point shaft[] = {{0.275, 0.53, true},  {0.262, 0.62, false}, {0.262, 1.6, false},
                                    {0.252, 2.5, false},  {0.230, 3.36, false}, {0.245, 3.40, true},
                                    {0.270, 3.42, false}, {0.270, 3.46, false}, {0.235, 3.49, true}};
static const lathe_point bell[] = {{0.235, 3.49, true}, {0.255, 3.56, false}, {0.27, 3.66, false},
                                   {0.33, 3.74, true},  {0.26, 3.74, true},   {0.285, 3.82, false},
                                   {0.32, 3.93, false}, {0.42, 4.02, true},   {0.38, 4.03, true}};

static void turned(mesh *m, v3 foot, const lathe_point *profile, int count, double scale, double wide, int lobes,
                   int segments) {
    shape_lathe l = {.foot = foot, .profile = profile, .count = count, .segments = segments, .rings = 1, .scale = scale};
    l.wide = wide;
    l.lobes = lobes;
    l.lobe = lobes ? 0.07 : 0.0;
    l.around = 1.0;
    l.uv = 1.8;
    shape_lathe_add(m, &l);
}

void atrium_column(mesh *m, v3 foot, double scale, double wide, int segments) {
    const int leaves = segments / 4 + 2;
    double plinth = 0.42 * scale * wide, abacus = 0.42 * scale * wide;
    mesh_group_begin(m, "column_bases", "trim");
    shape_box(m, v3_of(foot.x - plinth, foot.y, foot.z - plinth),
              v3_of(foot.x + plinth, foot.y + 0.20 * scale, foot.z + plinth), 1.0, SIDE_BOTTOM);
    turned(m, foot, base, 11, scale, wide, 0, segments);
    mesh_group_begin(m, "columns", "marble");
    turned(m, foot, shaft, 9, scale, wide, 0, segments);
    mesh_group_begin(m, "capitals", "trim");
    turned(m, foot, bell, 9, scale, wide, leaves, 4 * leaves);
    double y = foot.y + 4.03 * scale;
    shape_box(m, v3_of(foot.x - abacus, y, foot.z - abacus), v3_of(foot.x + abacus, y + 0.09 * scale, foot.z + abacus), 1.0,
              SIDE_TOP);
    abacus *= 1.08;
    shape_box(m, v3_of(foot.x - abacus, y + 0.09 * scale, foot.z - abacus),
              v3_of(foot.x + abacus, y + 0.17 * scale, foot.z + abacus), 1.0, 0);
}

static void baluster(mesh *m, v3 foot) {
    static const lathe_point profile[] = {{0.075, 0.00, true},  {0.075, 0.05, true}, {0.05, 0.07, true},   {0.055, 0.14, false},
                                          {0.080, 0.24, false}, {0.06, 0.36, false}, {0.035, 0.50, false}, {0.045, 0.60, true},
                                          {0.07, 0.62, true},   {0.07, 0.68, true}};
    shape_lathe l = {.foot = foot, .profile = profile, .count = 10, .segments = 8, .rings = 1, .uv = 1.0};
    shape_lathe_add(m, &l);
}

/* Between two pedestals; x is along the rails. */
void atrium_balustrade(mesh *m, double x0, double x1, double y, double z) {
    const int count = 7;
    mesh_group_begin(m, "balustrades", "marble");
    shape_box(m, v3_of(x0, y, z - 0.13), v3_of(x1, y + 0.14, z + 0.13), 1.7, SIDE_LEFT | SIDE_RIGHT | SIDE_BOTTOM);
    shape_box(m, v3_of(x0, y + 0.82, z - 0.14), v3_of(x1, y + 0.96, z + 0.14), 1.7, SIDE_LEFT | SIDE_RIGHT);
    mesh_group_begin(m, "balusters", "trim");
    for (int i = 0; i < count; i++)
        baluster(m, v3_of(lerp(x0, x1, (i + 0.5) / count), y + 0.14, z));
}

void atrium_pedestal(mesh *m, v3 foot, double half, double height) {
    mesh_group_begin(m, "pedestals", "trim");
    const double steps[3][3] = {{0.04, 0.0, 0.12}, {0.0, 0.12, height - 0.12}, {0.05, height - 0.12, height}};
    for (int i = 0; i < 3; i++) {
        double r = half + steps[i][0];
        shape_box(m, v3_of(foot.x - r, foot.y + steps[i][1], foot.z - r), v3_of(foot.x + r, foot.y + steps[i][2], foot.z + r),
                  1.0, i == 2 ? 0 : SIDE_BOTTOM);
    }
}
