/* Groin vaults between ribs over the lower aisles; a coffered ceiling over the gallery. */
#include "atrium.h"

#define AISLE_IN (COURT_Z + WALL) /* of the long aisles, from the middle */
#define RISE 1.35

/* One of the four webs of a groin vault over half sizes hx, hz. Turned by quarters, `across` is the half width of its barrel
 * and `along` its length from the middle. Parameter s runs along the barrel's arc, t from the middle outward. */
typedef struct web {
    double across, along;
} web;

static void web_point(const void *user, double s, double t, vertex *out) {
    const web *w = user;
    double angle = PI / 2.0 * (2.0 * s - 1.0);
    /* Between the two groins x runs from -t to t of the half width. */
    double x = t * sine(angle), rise = 1.0 - x * x;
    out->p = v3_of(w->across * x, SPRING + RISE * sqrt(rise > 0.0 ? rise : 0.0), w->along * t);
    out->u = w->across * x / 3.0;
    out->v = w->along * t / 3.0;
}

static void vault(mesh *m, double x, double z, double hx, double hz) {
    for (int quarter = 0; quarter < 4; quarter++) {
        web w = {quarter & 1 ? hz : hx, quarter & 1 ? hx : hz};
        m->frame = mesh_frame_at(v3_of(x, 0, z), quarter);
        shape_sheet(m, 12, 5, web_point, &w, false);
    }
}

/* Rib on a half ellipse across an aisle; x across the aisle, z along it. Four faces of it show. */
typedef struct rib {
    double half, rise;   /* of the curve */
    double z0, z1;       /* the strip between them */
    double grow0, grow1; /* added to half and rise at z0 and z1 */
} rib;

static void rib_point(const void *user, double s, double t, vertex *out) {
    const rib *r = user;
    double a = PI * s, grow = lerp(r->grow0, r->grow1, t);
    out->p = v3_of(-(r->half + grow) * cosine(a), SPRING + (r->rise + grow) * sine(a), lerp(r->z0, r->z1, t));
    out->u = s * 4.0;
    out->v = (out->p.z + grow) / 1.0;
}

static void rib_add(mesh *m, v3 middle, int quarters, double half, double z0, double z1) {
    const double thick = 0.14;
    const rib under = {half, RISE - 0.1, z0, z1, 0, 0};
    const rib back = {half, RISE - 0.1, z0, z0, thick, 0}, front = {half, RISE - 0.1, z1, z1, 0, thick};
    m->frame = mesh_frame_at(middle, quarters);
    shape_sheet(m, 16, 1, rib_point, &under, false);
    shape_sheet(m, 16, 1, rib_point, &back, false);
    shape_sheet(m, 16, 1, rib_point, &front, false);
}

static void vaults(mesh *m) {
    const double depth = BAY - WALL, half = depth / 2.0 + 0.02;
    const double mid_z = AISLE_IN + depth / 2.0, mid_x = COURT_X + WALL + depth / 2.0;
    mesh_group_begin(m, "vaults", "plaster");
    for (int side = -1; side <= 1; side += 2) {
        for (int i = 0; i < LONG_BAYS; i++)
            vault(m, (i - 3) * BAY, side * mid_z, BAY / 2.0, half);
        for (int i = 0; i < SHORT_BAYS; i++)
            vault(m, side * mid_x, (i - 1) * BAY, half, BAY / 2.0);
        vault(m, side * mid_x, mid_z, half, half);
        vault(m, side * mid_x, -mid_z, half, half);
    }
    mesh_group_begin(m, "ribs", "trim");
    for (int side = -1; side <= 1; side += 2) {
        for (int i = 0; i <= LONG_BAYS; i++) {
            double x = (i - 0.5 * LONG_BAYS) * BAY, in = i == 0 ? 0.4 : 0.18, out = i == LONG_BAYS ? 0.4 : 0.18;
            /* Turned by one quarter: frame x runs to -z, frame z to x. */
            rib_add(m, v3_of(x, 0, side * mid_z), 1, half, -in, out);
        }
        for (int i = 0; i <= SHORT_BAYS; i++) {
            double z = (i - 0.5 * SHORT_BAYS) * BAY, in = i == 0 ? 0.4 : 0.18, out = i == SHORT_BAYS ? 0.4 : 0.18;
            rib_add(m, v3_of(side * mid_x, 0, z), 0, half, -in, out);
        }
    }
    m->frame = mesh_frame_at(v3_of(0, 0, 0), 0);
    /* Where two wide ribs meet at a corner of the court they need more to stand on than the wall's end. */
    const double in = 0.1, out = 0.42;
    for (int i = 0; i < 4; i++) {
        double x = i & 1 ? COURT_X : -COURT_X, z = i & 2 ? COURT_Z : -COURT_Z;
        v3 lo = {x - (i & 1 ? in : out), SPRING, z - (i & 2 ? in : out)};
        v3 hi = {x + (i & 1 ? out : in), GALLERY, z + (i & 2 ? out : in)};
        shape_box(m, lo, hi, 1.0, SIDE_TOP);
    }
}

/* Planks on cross beams and two lengthwise ones. */
static void coffers(mesh *m) {
    const double y = 11.0, ix = COURT_X - WALL, iz = COURT_Z - WALL;
    const double piece[4][4] = {
        {-OUTER_X, OUTER_X, -OUTER_Z, -iz}, {-OUTER_X, OUTER_X, iz, OUTER_Z}, {-OUTER_X, -ix, -iz, iz}, {ix, OUTER_X, -iz, iz}};
    mesh_group_begin(m, "gallery_ceiling", "wood");
    for (int i = 0; i < 4; i++) {
        const double *p = piece[i];
        shape_quad_add(
            m, &(shape_quad){.o = {p[0], y, p[2]}, .a = {p[1] - p[0], 0, 0}, .b = {0, 0, p[3] - p[2]}, .nu = 4, .uv = 1.6});
    }
    for (int i = 0; i < 4; i++) {
        atrium_side s = atrium_side_of(i);
        m->frame = s.frame;
        for (int k = 0; k <= 2 * s.bays; k++) {
            double x = atrium_bay(&s, 0.5 * k - 0.5), wide = k & 1 ? 0.08 : 0.13, deep = k & 1 ? 0.16 : 0.28;
            shape_box(m, v3_of(x - wide, y - deep, -BAY), v3_of(x + wide, y, -WALL + 0.05), 1.6,
                      SIDE_TOP | SIDE_BACK | SIDE_FRONT);
        }
    }
    m->frame = mesh_frame_at(v3_of(0, 0, 0), 0);
}

void atrium_ceilings(mesh *m) {
    vaults(m);
    coffers(m);
}
