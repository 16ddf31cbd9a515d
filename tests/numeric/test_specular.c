/* Mirrors, glass and the Phong lobe (kernels/specular.clh) at every width, against Fresnel, Snell and Phong in double.
 *
 * What can go wrong: light is made (reflected and refracted parts are more than 1, a lobe reflects more than it is given),
 * lost, or goes where it does not; at the critical angle, at normal and at grazing incidence most easily. Fresnel's part has a
 * vertical tangent at the critical angle, where a rounding of the sine's square, 2^-24, becomes its root, 2^-12: such angles
 * have rows of their own. A lobe is exp2(m log2 c), so that roundings of c, which is near 1 where it matters, count m times. */

#define NEAR_CRITICAL 1e-3 /* of the sine's square */

/* Planes in: d, n, face, ior, back, thin (0 or 1). Planes out: the mirrored part, mirrored and refracted direction, a spare. */
static const char kernels[] =
    "kernel void map_glass(global const float *in, global float *out)\n"
    "{\n"
    "    uint i = (uint)get_global_id(0) * VIT_LANES, n = (uint)get_global_size(0) * VIT_LANES;\n"
    "    li back = L_GT(L_LOAD(VIT_PLANE(in, 10, n) + i), L_F(0)), thin = L_GT(L_LOAD(VIT_PLANE(in, 11, n) + i), L_F(0));\n"
    "    specular_paths p = specular_at_glass(lv3_load_planes(in, n, i), lv3_load_planes(VIT_PLANE(in, 3, n), n, i),\n"
    "                                   lv3_load_planes(VIT_PLANE(in, 6, n), n, i), back, thin, L_LOAD(VIT_PLANE(in, 9, n) + "
    "i));\n"
    "    L_STORE(p.mirror, out + i);\n"
    "    lv3_store_planes(p.mirrored, VIT_PLANE(out, 1, n), n, i);\n"
    "    lv3_store_planes(p.refracted, VIT_PLANE(out, 4, n), n, i);\n"
    "    L_STORE(specular_absorbed(L_LOAD(in + i), L_LOAD(VIT_PLANE(in, 9, n) + i)), VIT_PLANE(out, 7, n) + i);\n"
    "}\n"
    "kernel void map_lobe(global const float *in, global float *out)\n" /* n, l, v, exponent */
    "{\n"
    "    uint i = (uint)get_global_id(0) * VIT_LANES, n = (uint)get_global_size(0) * VIT_LANES;\n"
    "    L_STORE(specular_lobe(lv3_load_planes(in, n, i), lv3_load_planes(VIT_PLANE(in, 3, n), n, i),\n"
    "                       lv3_load_planes(VIT_PLANE(in, 6, n), n, i), L_LOAD(VIT_PLANE(in, 9, n) + i)), out + i);\n"
    "}\n";

#include "specular_lab.h"

/* A ray that meets n at an angle of cosine c, in input i. */
static void put_ray(bench *b, uint32_t i, uint64_t *random, double c, double ior, bool back, bool thin) {
    double n[3], t[3], s[3], d[3];
    random_unit(random, n);
    axes(n, t, s);
    const double a = 2 * PI * (double)lab_uniform(random), sine = sqrt(1 - c * c);
    for (int k = 0; k < 3; k++)
        d[k] = -c * n[k] + sine * (cos(a) * t[k] + sin(a) * s[k]);
    put(b, 0, i, d);
    put(b, 3, i, n);
    put(b, 6, i, n);
    b->in[9 * (size_t)COUNT + i] = (float)ior;
    b->in[10 * (size_t)COUNT + i] = back;
    b->in[11 * (size_t)COUNT + i] = thin;
}

/* What happens at input i, in double. */
typedef struct exact {
    double d[3], n[3], ci, st2, eta; /* eta = n1 / n2 */
    double mirror, through;          /* both worked out by themselves */
    bool thin;
} exact;

static exact exactly(const bench *b, uint32_t i) {
    exact e;
    get(b->in, 0, i, e.d);
    get(b->in, 3, i, e.n);
    const double ior = (double)b->in[9 * (size_t)COUNT + i];
    e.thin = b->in[11 * (size_t)COUNT + i] > 0;
    e.eta = b->in[10 * (size_t)COUNT + i] > 0 && !e.thin ? ior : 1 / ior;
    e.ci = -dot(e.d, e.n) / sqrt(dot(e.d, e.d) * dot(e.n, e.n));
    e.st2 = e.eta * e.eta * (1 - e.ci * e.ci);
    e.mirror = 1;
    e.through = 0;
    if (e.st2 < 1) {
        const double ct = sqrt(1 - e.st2), rs = (e.eta * e.ci - ct) / (e.eta * e.ci + ct),
                     rp = (e.ci - e.eta * ct) / (e.ci + e.eta * ct);
        const double ts = 2 * e.eta * e.ci / (e.eta * e.ci + ct), tp = 2 * e.eta * e.ci / (e.ci + e.eta * ct);
        e.mirror = 0.5 * (rs * rs + rp * rp);
        e.through = ct / (e.eta * e.ci) * 0.5 * (ts * ts + tp * tp);
    }
    return e;
}

/* Rays at all angles, grazing and normal ones more often; ior 1 to 10, most of it 1.3 to 1.8; half come from inside. */
static void random_rays(bench *b, bool thin) {
    uint64_t random = 11;
    for (uint32_t i = 0; i < COUNT; i++) {
        const double u = (double)lab_uniform(&random), few = (double)lab_uniform(&random);
        const double c = i % 8 == 0 ? pow(10, -6 * u) : i % 8 == 1 ? 1 - 1e-6 * u : u + 1e-7;
        put_ray(b, i, &random, fmin(c, 1), i % 4 ? 1.3 + 0.5 * few : 1 + 9 * few, i & 1, thin);
    }
}

static void glass_neither_makes_nor_loses_light(void **state) {
    bench *b = *state;
    double worst = 0, critical = 0, sum = 0;
    uint64_t leaks = 0, totals = 0;
    random_rays(b, false);
    run(b, "map_glass", OUT);
    for (uint32_t i = 0; i < COUNT; i++) {
        const exact e = exactly(b, i);
        const double got = (double)b->out[0][i], error = fabs(got - e.mirror);
        assert_true(got >= 0 && got <= 1);
        if (fabs(e.st2 - 1) < NEAR_CRITICAL) {
            critical = fmax(critical, error);
            continue;
        }
        worst = fmax(worst, error);
        sum = fmax(sum, fabs(got + e.through - 1));
        totals += e.st2 > 1;
        leaks += e.st2 > 1 && got != 1.0;
    }
    assert_true(totals > COUNT / 16);
    catalogue_row("glass", "Fresnel: mirrored part", worst, 3e-5, "");
    catalogue_row("glass", "mirrored and refracted part together against 1", sum, 3e-5, "");
    catalogue_row("glass", "Fresnel within 0.001 of the critical angle (sine squared)", critical, 1e-4, "");
    catalogue_none("glass", "rays past the critical angle that are not all mirrored", leaks, totals, "rays");
}

static void normal_incidence_and_brewsters_angle(void **state) {
    bench *b = *state;
    uint64_t random = 12;
    double normal = 0, brewster = 0;
    for (uint32_t i = 0; i < COUNT; i++) {
        /* tan of Brewster's angle is n2 / n1. */
        const double ior = 1 + 4 * (double)lab_uniform(&random), ratio = i & 2 ? 1 / ior : ior;
        put_ray(b, i, &random, i & 1 ? 1 : 1 / sqrt(1 + ratio * ratio), ior, (i & 2) != 0, false);
    }
    run(b, "map_glass", OUT);
    for (uint32_t i = 0; i < COUNT; i++) {
        const double ior = (double)b->in[9 * (size_t)COUNT + i], r = (ior - 1) / (ior + 1),
                     s = (ior * ior - 1) / (ior * ior + 1);
        const double got = (double)b->out[0][i];
        if (i & 1)
            normal = fmax(normal, fabs(got - r * r));
        else
            brewster = fmax(brewster, fabs(got - 0.5 * s * s)); /* r_p is 0, r_s is this */
    }
    catalogue_row("glass", "normal incidence: ((n - 1) / (n + 1))^2", normal, 2e-7, "");
    catalogue_row("glass", "Brewster's angle: r_p is 0", brewster, 7e-6, "");
}

static void refracted_rays_obey_snell(void **state) {
    bench *b = *state;
    double snell = 0, plane = 0, length = 0, mirror = 0;
    uint64_t seen = 0;
    random_rays(b, false);
    run(b, "map_glass", OUT);
    for (uint32_t i = 0; i < COUNT; i++) {
        const exact e = exactly(b, i);
        double t[3], r[3], out[3];
        get(b->out[0], 1, i, r);
        for (int k = 0; k < 3; k++)
            mirror = fmax(mirror, fabs(r[k] - (e.d[k] - 2 * dot(e.d, e.n) * e.n[k])));
        if (e.st2 > 1 - NEAR_CRITICAL || b->out[0][i] >= 1)
            continue;
        seen++;
        get(b->out[0], 4, i, t);
        length = fmax(length, fabs(sqrt(dot(t, t)) - 1));
        /* Snell's law as vectors: the tangential part is eta times as long. */
        const double ct = -dot(t, e.n), tangential = dot(e.d, e.n);
        double error = 0, across[3];
        for (int k = 0; k < 3; k++) {
            out[k] = t[k] + ct * e.n[k] - e.eta * (e.d[k] - tangential * e.n[k]);
            across[k] = e.d[(k + 1) % 3] * e.n[(k + 2) % 3] - e.d[(k + 2) % 3] * e.n[(k + 1) % 3];
            error += out[k] * out[k];
        }
        snell = fmax(snell, sqrt(error));
        plane = fmax(plane, fabs(dot(t, across)));
        assert_true(ct > 0);
    }
    assert_true(seen > COUNT / 2);
    catalogue_row("glass", "Snell: tangential part of the refracted direction", snell, 5e-7, "");
    catalogue_row("glass", "refracted direction off the plane of incidence", plane, 1.5e-7, "");
    catalogue_row("glass", "length of the refracted direction - 1", length, 2.5e-7, "");
    catalogue_row("glass", "mirrored direction; a component", mirror, 4e-7, "");
}

static void panes_sum_all_their_reflections_and_bend_nothing(void **state) {
    bench *b = *state;
    double worst = 0;
    uint64_t bent = 0;
    random_rays(b, true);
    run(b, "map_glass", OUT);
    for (uint32_t i = 0; i < COUNT; i++) {
        const exact e = exactly(b, i);
        /* F + (1 - F)^2 (F + F^3 + F^5 + ...) */
        double sum = e.mirror, inside = (1 - e.mirror) * (1 - e.mirror) * e.mirror;
        for (int k = 0; k < 100000 && inside > 1e-12; k++, inside *= e.mirror * e.mirror)
            sum += inside;
        worst = fmax(worst, fabs((double)b->out[0][i] - sum));
        for (unsigned k = 0; k < 3; k++)
            bent += b->out[0][(4 + k) * (size_t)COUNT + i] != b->in[k * (size_t)COUNT + i];
    }
    catalogue_row("glass", "pane: series of inner reflections", worst, 3e-6, "");
    catalogue_none("glass", "components of rays through panes that are bent", bent, 3 * (uint64_t)COUNT, "components");
}

/* Shading normals up to 60 degrees off the face's. */
static void shading_normals_send_nothing_through_the_surface(void **state) {
    bench *b = *state;
    uint64_t random = 13, wrong = 0, refracted = 0;
    for (uint32_t i = 0; i < COUNT; i++) {
        double face[3], d[3], off[3], n[3], length;
        put_ray(b, i, &random, 1e-3 + 0.999 * (double)lab_uniform(&random), 1 + 2 * (double)lab_uniform(&random), i & 1, false);
        get(b->in, 0, i, d);
        get(b->in, 6, i, face);
        do {
            random_unit(&random, off);
            for (int k = 0; k < 3; k++)
                n[k] = face[k] + 0.85 * off[k];
            length = sqrt(dot(n, n));
        } while (dot(n, face) < 0.5 * length);
        for (int k = 0; k < 3; k++)
            n[k] /= length;
        put(b, 3, i, n);
    }
    run(b, "map_glass", OUT);
    for (uint32_t i = 0; i < COUNT; i++) {
        double face[3], r[3], t[3];
        get(b->in, 6, i, face);
        get(b->out[0], 1, i, r);
        get(b->out[0], 4, i, t);
        wrong += !(dot(r, face) > -1e-6); /* a flat mirrored grazing ray is a rounding off the face's plane */
        if (b->out[0][i] < 1) {
            refracted++;
            wrong += !(dot(t, face) < 0);
        }
    }
    assert_true(refracted > COUNT / 4);
    catalogue_none("glass", "bent normals: rays that leave on the wrong side of the face", wrong, COUNT, "rays");
}

static void absorption_is_beers(void **state) {
    bench *b = *state;
    double worst = 0;
    for (uint32_t i = 0; i < COUNT; i++) {
        b->in[i] = (float)(i % 1024) * 0.01f;
        b->in[9 * (size_t)COUNT + i] = (float)(i / 1024) * 0.03f;
    }
    run(b, "map_glass", OUT);
    for (uint32_t i = 0; i < COUNT; i++) {
        const double want = exp(-(double)b->in[i] * (double)b->in[9 * (size_t)COUNT + i]),
                     got = (double)b->out[0][7 * (size_t)COUNT + i];
        worst = fmax(worst, fabs(got - want) / fmax(want, 1e-30));
    }
    catalogue_row("glass", "exp(- absorption * way) down to 1e-30; relative", worst, 1.2e-5, "");
}

static void random_lobes(bench *b, double least, double most) {
    uint64_t random = 14;
    for (uint32_t i = 0; i < COUNT; i++) {
        double n[3], t[3], s[3], v[3], l[3], r[3];
        const double c = 0.01 + 0.99 * (double)lab_uniform(&random),
                     m = least * pow(most / least, (double)lab_uniform(&random));
        random_unit(&random, n);
        axes(n, t, s);
        for (int k = 0; k < 3; k++) {
            v[k] = c * n[k] + sqrt(1 - c * c) * t[k];
            r[k] = c * n[k] - sqrt(1 - c * c) * t[k];
        }
        /* As far from the mirrored direction as the lobe reaches, and beyond. */
        const double off = acos(pow(10, -3 * (double)lab_uniform(&random) / m)), a = 2 * PI * (double)lab_uniform(&random);
        axes(r, t, s);
        for (int k = 0; k < 3; k++)
            l[k] = cos(off) * r[k] + sin(off) * (cos(a) * t[k] + sin(a) * s[k]);
        put(b, 0, i, n);
        put(b, 3, i, l);
        put(b, 6, i, v);
        b->in[9 * (size_t)COUNT + i] = (float)m;
    }
}

static double worst_lobe(bench *b, double least, double most) {
    double worst = 0;
    random_lobes(b, least, most);
    run(b, "map_lobe", 1);
    for (uint32_t i = 0; i < COUNT; i++) {
        double n[3], l[3], v[3];
        get(b->in, 0, i, n);
        get(b->in, 3, i, l);
        get(b->in, 6, i, v);
        const double m = (double)b->in[9 * (size_t)COUNT + i], c = 2 * dot(n, l) * dot(n, v) - dot(l, v);
        const double want = c > 0 ? pow(fmin(c, 1), m) : 0, got = (double)b->out[0][i] * 2 * PI / (m + 2);
        worst = fmax(worst, fabs(got - want));
    }
    return worst;
}

static void lobes_are_phongs(void **state) {
    catalogue_row("lobe", "exponents 1 to 100; of the peak", worst_lobe(*state, 1, 100), 3e-5, "");
    catalogue_row("lobe", "exponents 100 to 10000; of the peak", worst_lobe(*state, 100, 10000), 3e-3, "");
}

/* Reflectance of a lobe of 1 for light from one direction, by the kernel's values at points that are as dense as the lobe is
 * high. */
static double lobe_albedo(bench *b, double m, double degrees) {
    enum { EDGE = 512 };
    const double c = cos(degrees * PI / 180), sine = sin(degrees * PI / 180), n[3] = {0, 0, 1}, v[3] = {sine, 0, c},
                 r[3] = {-sine, 0, c};
    double t[3], s[3], sum = 0;
    axes(r, t, s);
    for (uint32_t i = 0; i < COUNT; i++) {
        double l[3];
        const double z = pow((i / EDGE + 0.5) / EDGE, 1 / (m + 1)), w = sqrt(1 - z * z), a = 2 * PI * (i % EDGE + 0.5) / EDGE;
        for (int k = 0; k < 3; k++)
            l[k] = z * r[k] + w * (cos(a) * t[k] + sin(a) * s[k]);
        put(b, 0, i, n);
        put(b, 3, i, l);
        put(b, 6, i, v);
        b->in[9 * (size_t)COUNT + i] = (float)m;
    }
    run(b, "map_lobe", 1);
    for (uint32_t i = 0; i < COUNT; i++) {
        const double z = pow((i / EDGE + 0.5) / EDGE, 1 / (m + 1)), nl = (double)b->in[5 * (size_t)COUNT + i];
        sum += nl > 0 ? (double)b->out[0][i] * nl * 2 * PI / ((m + 1) * pow(z, m)) : 0;
    }
    return sum / COUNT;
}

static void lobes_make_no_light(void **state) {
    static const double exponents[] = {1, 10, 100, 1000, 10000}, angles[] = {0, 30, 60, 85};
    static const double bounds[] = {1e-6, 0.14, 0.51, 0.92};
    double more = -1;
    for (size_t a = 0; a < 4; a++) {
        double lost = -1;
        char text[64];
        for (size_t k = 0; k < 5; k++) {
            const double albedo = lobe_albedo(*state, exponents[k], angles[a]);
            lost = fmax(lost, 1 - albedo);
            more = fmax(more, albedo - 1);
        }
        (void)snprintf(text, sizeof text, "reflectance lost at %g degrees; exponents 1 to 10000", angles[a]);
        catalogue_row("lobe", text, lost, bounds[a], "");
    }
    catalogue_row("lobe", "reflectance over 1", more, 6e-5, "");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(glass_neither_makes_nor_loses_light),
        cmocka_unit_test(normal_incidence_and_brewsters_angle),
        cmocka_unit_test(refracted_rays_obey_snell),
        cmocka_unit_test(panes_sum_all_their_reflections_and_bend_nothing),
        cmocka_unit_test(shading_normals_send_nothing_through_the_surface),
        cmocka_unit_test(absorption_is_beers),
        cmocka_unit_test(lobes_are_phongs),
        cmocka_unit_test(lobes_make_no_light),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
