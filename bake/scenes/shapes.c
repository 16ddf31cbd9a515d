#include "shapes.h"

void shape_quad_add(mesh *m, const shape_quad *q) {
    int nu = q->nu > 0 ? q->nu : 1, nv = q->nv > 0 ? q->nv : 1;
    double uv = q->uv > 0.0 ? q->uv : 1.0;
    double du = sqrt(v3_dot(q->a, q->a)) / uv, dv = sqrt(v3_dot(q->b, q->b)) / uv;
    v3 n = v3_unit(v3_cross(q->a, q->b));
    uint32_t first = 0;
    for (int j = 0; j <= nv; j++) {
        for (int i = 0; i <= nu; i++) {
            double s = (double)i / nu, t = (double)j / nv;
            v3 p = v3_add(q->o, v3_add(v3_scale(q->a, s), v3_scale(q->b, t)));
            uint32_t at = mesh_vertex(m, (vertex){.p = p, .n = n, .u = q->u0 + s * du, .v = q->v0 + t * dv});
            first = i == 0 && j == 0 ? at : first;
        }
    }
    for (int j = 0; j < nv; j++) {
        for (int i = 0; i < nu; i++) {
            uint32_t at = first + (uint32_t)(j * (nu + 1) + i), up = at + (uint32_t)nu + 1;
            mesh_triangle(m, at, at + 1, up + 1);
            mesh_triangle(m, at, up + 1, up);
        }
    }
}

void shape_box(mesh *m, v3 lo, v3 hi, double uv, unsigned open) {
    v3 d = v3_sub(hi, lo), x = {d.x, 0, 0}, y = {0, d.y, 0}, z = {0, 0, d.z}, mx = {-d.x, 0, 0}, mz = {0, 0, -d.z};
    const struct {
        v3 o, a, b;
        double u0, v0;
        unsigned side;
    } faces[6] = {
        {lo, z, y, lo.z, lo.y, SIDE_LEFT},
        {{hi.x, lo.y, hi.z}, mz, y, -hi.z, lo.y, SIDE_RIGHT},
        {lo, x, z, lo.x, lo.z, SIDE_BOTTOM},
        {{lo.x, hi.y, hi.z}, x, mz, lo.x, -hi.z, SIDE_TOP},
        {{hi.x, lo.y, lo.z}, mx, y, -hi.x, lo.y, SIDE_BACK},
        {{lo.x, lo.y, hi.z}, x, y, lo.x, lo.y, SIDE_FRONT},
    };
    for (int i = 0; i < 6; i++) {
        if (open & faces[i].side)
            continue;
        shape_quad q = {.o = faces[i].o, .a = faces[i].a, .b = faces[i].b, .uv = uv};
        q.u0 = faces[i].u0 / uv;
        q.v0 = faces[i].v0 / uv;
        shape_quad_add(m, &q);
    }
}
