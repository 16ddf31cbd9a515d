/* Walls pierced by round arches, and their mouldings. */
#include "atrium_parts.h"

static uint32_t corner(mesh *m, const arch *a, double x, double y, double z, double nz) {
    return mesh_vertex(m, (vertex){.p = {x, y, z}, .n = {0, 0, nz}, .u = x / a->uv, .v = y / a->uv});
}

/* One face, as upright strips that end on the arch or, beside it, on the springing line. */
static void face(mesh *m, const arch *a, double z, double nz) {
    uint32_t low = corner(m, a, a->x0, a->y0, z, nz), high = corner(m, a, a->x0, a->y1, z, nz);
    for (int i = 0; i <= a->segments + 1; i++) {
        double angle = PI * i / a->segments, x = a->x1, y = a->y0;
        if (i <= a->segments) {
            x = a->middle - a->radius * cosine(angle);
            y = a->y0 + a->radius * sine(angle);
        }
        uint32_t next_low = corner(m, a, x, y, z, nz), next_high = corner(m, a, x, a->y1, z, nz);
        mesh_triangle(m, low, next_low, next_high);
        mesh_triangle(m, low, next_high, high);
        low = next_low;
        high = next_high;
    }
}

/* A strip round the arch between two (radius, z) points. */
typedef struct strip {
    const arch *arch;
    double r0, z0, r1, z1;
} strip;

static void strip_point(const void *user, double s, double t, vertex *out) {
    const strip *k = user;
    double angle = PI * s, r = lerp(k->r0, k->r1, t);
    out->p = v3_of(k->arch->middle - r * cosine(angle), k->arch->y0 + r * sine(angle), lerp(k->z0, k->z1, t));
    out->u = PI * s * k->arch->radius;
    out->v = r + out->p.z;
}

void atrium_arch(mesh *m, const arch *a, const char *wall) {
    mesh_group_begin(m, "arcade_walls", wall);
    face(m, a, a->z1, 1.0);
    face(m, a, a->z0, -1.0);
    mesh_group_begin(m, "arch_insides", "trim");
    const strip inside = {a, a->radius, a->z0, a->radius, a->z1};
    shape_sheet(m, a->segments, 1, strip_point, &inside, false);
}

void atrium_archivolt(mesh *m, const arch *a, const char *trim) {
    const double r = a->radius, z = a->z1;
    /* From inside the arch, over two steps, back to the wall. */
    const double profile[6][2] = {{r - 0.02, z - 0.06}, {r - 0.02, z + 0.07}, {r + 0.10, z + 0.07},
                                  {r + 0.10, z + 0.04}, {r + 0.19, z + 0.04}, {r + 0.19, z}};
    mesh_group_begin(m, "archivolts", trim);
    for (int i = 0; i < 5; i++) {
        const strip k = {a, profile[i][0], profile[i][1], profile[i + 1][0], profile[i + 1][1]};
        shape_sheet(m, a->segments, 1, strip_point, &k, false);
    }
    double top = a->y0 + r;
    const double low = 0.09, high = 0.14, z1 = z + 0.11;
    const double front[4][2] = {{-low, top - 0.06}, {low, top - 0.06}, {high, top + 0.24}, {-high, top + 0.24}};
    for (int i = 0; i < 5; i++) { /* the front and four sides of the wedge */
        const double *p = front[i & 3], *q = front[(i + 1) & 3];
        v3 n = i == 4 ? v3_of(0, 0, 1) : v3_unit(v3_of(q[1] - p[1], p[0] - q[0], 0));
        uint32_t at[4];
        for (int c = 0; c < 4; c++) {
            const double *f = i == 4 ? front[c] : c == 0 || c == 3 ? p : q;
            v3 place = {a->middle + f[0], f[1], i == 4 || c > 1 ? z1 : z - 0.1};
            at[c] = mesh_vertex(m, (vertex){.p = place, .n = n, .u = f[0], .v = f[1] + place.z});
        }
        mesh_triangle(m, at[0], at[1], at[2]);
        mesh_triangle(m, at[0], at[2], at[3]);
    }
}
