/* Lobes of microfacets (kernels/specular.clh) at every width, against glTF 2.0's formulas in double.
 *
 * What can go wrong: D's peak drowns in cancellation, 1 - (n.h)^2 being about alpha^2 there; light is made; light and eye
 * cannot change places. Unit vectors in float are off by 2^-24, which turns h by about as much: of the angle alpha that a
 * smooth lobe is wide that is 2^-24 / alpha, and D goes by its fourth power, so that smooth lobes have a bound of their own. */
static const char kernels[] =
    "kernel void map_facets(global const float *in, global float *out)\n" /* n, l, v, alpha */
    "{\n"
    "    uint i = (uint)get_global_id(0) * VIT_LANES, n = (uint)get_global_size(0) * VIT_LANES;\n"
    "    specular_facets f = specular_at_facets(lv3_load_planes(in, n, i), lv3_load_planes(VIT_PLANE(in, 3, n), n, i),\n"
    "                       lv3_load_planes(VIT_PLANE(in, 6, n), n, i), L_LOAD(VIT_PLANE(in, 9, n) + i));\n"
    "    L_STORE(f.lobe, out + i);\n"
    "    L_STORE(f.grazing, VIT_PLANE(out, 1, n) + i);\n"
    "}\n";

#include "specular_lab.h"

/* glTF 2.0, appendix B: D V, and (1 - v.h)^5, from the floats that the kernel gets; unit to double's precision. */
static void gltf_facets(const bench *b, uint32_t i, double out[2]) {
    double w[3][3], h[3];
    const double a2 = pow((double)b->in[9 * (size_t)COUNT + i], 2);
    for (unsigned p = 0; p < 3; p++) {
        get(b->in, 3 * p, i, w[p]);
        const double length = sqrt(dot(w[p], w[p]));
        for (int k = 0; k < 3; k++)
            w[p][k] /= length;
    }
    for (int k = 0; k < 3; k++)
        h[k] = w[1][k] + w[2][k];
    const double length = sqrt(dot(h, h)), nh = dot(w[0], h) / length, nl = dot(w[0], w[1]), nv = dot(w[0], w[2]);
    const double q = nh * nh * (a2 - 1) + 1, d = a2 / (PI * q * q);
    out[0] = d * 0.5 / (nl * sqrt(nv * nv * (1 - a2) + a2) + nv * sqrt(nl * nl * (1 - a2) + a2));
    out[1] = pow(fmax(1 - dot(w[2], h) / length, 0), 5);
}

/* Light and view at all angles above the surface, the half vector as far from n as the lobe reaches and farther. */
static void random_facets(bench *b, double least, double most) {
    uint64_t random = 15;
    for (uint32_t i = 0; i < COUNT; i++) {
        double n[3], t[3], s[3], v[3], l[3], h[3], nl;
        const double alpha = least * pow(most / least, (double)lab_uniform(&random));
        do {
            const double c = 0.01 + 0.98 * (double)lab_uniform(&random), u = (double)lab_uniform(&random),
                         c2 = (1 - u) / (1 - u + alpha * alpha * u), a = 2 * PI * (double)lab_uniform(&random);
            random_unit(&random, n);
            axes(n, t, s);
            for (int k = 0; k < 3; k++) {
                v[k] = c * n[k] + sqrt(1 - c * c) * t[k];
                h[k] = sqrt(c2) * n[k] + sqrt(1 - c2) * (cos(a) * t[k] + sin(a) * s[k]);
            }
            for (int k = 0; k < 3; k++)
                l[k] = 2 * dot(v, h) * h[k] - v[k];
            nl = dot(n, l);
        } while (nl < 0.01);
        put(b, 0, i, n);
        put(b, 3, i, l);
        put(b, 6, i, v);
        b->in[9 * (size_t)COUNT + i] = (float)alpha;
    }
}

static void check_facets(bench *b, const char *what, double least, double most, double bound) {
    double lobe = 0, grazing = 0;
    char text[96];
    random_facets(b, least, most);
    run(b, "map_facets", 2);
    for (uint32_t i = 0; i < COUNT; i++) {
        double want[2];
        gltf_facets(b, i, want);
        lobe = fmax(lobe, fabs((double)b->out[0][i] / want[0] - 1) * 0x1p23);
        grazing = fmax(grazing, fabs((double)b->out[0][COUNT + i] - want[1]) * 0x1p23);
    }
    (void)snprintf(text, sizeof text, "D V, alpha %s; relative", what);
    catalogue_row("facets", text, lobe, bound, "ulp of 1");
    (void)snprintf(text, sizeof text, "Fresnel's way to 1, alpha %s", what);
    catalogue_row("facets", text, grazing, 12, "ulp of 1");
}

static void facets_are_gltfs(void **state) {
    check_facets(*state, "0.1 to 1", 0.1, 1, 100);
    check_facets(*state, "1/128 to 0.1", 0.0078125, 0.1, 4000);
}

/* Whoever is the light and who the eye, to the bit. */
static void facets_are_reciprocal(void **state) {
    bench *b = *state;
    float *first = malloc(2 * (size_t)COUNT * 4);
    uint64_t unlike = 0;
    assert_non_null(first);
    random_facets(b, 0.0078125, 1);
    run(b, "map_facets", 2);
    memcpy(first, b->out[0], 2 * (size_t)COUNT * 4);
    for (uint32_t i = 0; i < COUNT; i++) {
        double l[3], v[3];
        get(b->in, 3, i, l);
        get(b->in, 6, i, v);
        put(b, 3, i, v);
        put(b, 6, i, l);
    }
    run(b, "map_facets", 2);
    for (uint32_t i = 0; i < COUNT; i++) {
        unlike += fabs((double)first[i] / (double)b->out[0][i] - 1) > 3e-7;
        unlike += first[COUNT + i] != b->out[0][COUNT + i];
    }
    free(first);
    catalogue_none("facets", "values that change when light and eye change places", unlike, 2 * (uint64_t)COUNT, "values");
}

/* Reflectance of white metal (one scattering) by the kernel's values at light mirrored by microfacets that D chose. */
static double facets_albedo(bench *b, double alpha, double degrees) {
    enum { EDGE = 512 };
    const double c = cos(degrees * PI / 180), sine = sin(degrees * PI / 180), n[3] = {0, 0, 1}, v[3] = {sine, 0, c};
    const double a2 = alpha * alpha;
    double sum = 0;
    for (uint32_t i = 0; i < COUNT; i++) {
        const double u = (i / EDGE + 0.5) / EDGE, z2 = (1 - u) / (1 - u + a2 * u), a = 2 * PI * (i % EDGE + 0.5) / EDGE;
        const double h[3] = {sqrt(1 - z2) * cos(a), sqrt(1 - z2) * sin(a), sqrt(z2)};
        double l[3];
        for (int k = 0; k < 3; k++)
            l[k] = 2 * dot(v, h) * h[k] - v[k];
        put(b, 0, i, n);
        put(b, 3, i, l);
        put(b, 6, i, v);
        b->in[9 * (size_t)COUNT + i] = (float)alpha;
    }
    run(b, "map_facets", 2);
    for (uint32_t i = 0; i < COUNT; i++) {
        const double u = (i / EDGE + 0.5) / EDGE, z2 = (1 - u) / (1 - u + a2 * u), a = 2 * PI * (i % EDGE + 0.5) / EDGE;
        const double vh = sine * sqrt(1 - z2) * cos(a) + c * sqrt(z2), q = z2 * (a2 - 1) + 1, d = a2 / (PI * q * q),
                     nl = (double)b->in[5 * (size_t)COUNT + i];
        sum += nl > 0 && vh > 0 ? (double)b->out[0][i] * nl * 4 * vh / (d * sqrt(z2)) : 0;
    }
    return sum / COUNT;
}

/* The same as an integral over directions of light, by glTF's formulas in double: polar angle about n, in steps as fine as the
 * lobe where it is. Weak furnace [Heitz 2014]: never more than 1. */
static double facets_integral(double alpha, double degrees) {
    enum { POLAR = 3000, AROUND = 1500 };
    const double c = cos(degrees * PI / 180), sine = sin(degrees * PI / 180), a2 = alpha * alpha;
    double sum = 0;
    for (int i = 0; i < POLAR; i++)
        for (int k = 0; k < AROUND; k++) { /* cubes of -1..1: most steps where light is mirrored */
            const double x = (i + 0.5) / POLAR, y = (k + 0.5) / AROUND, t = degrees * PI / 180;
            const double low = -cbrt(t), high = cbrt(PI / 2 - t), p = low + (high - low) * x, polar = t + p * p * p,
                         around = PI * y * y * y;
            const double nl = cos(polar), lh[3] = {sine - sin(polar) * cos(around), sin(polar) * sin(around), c + nl};
            const double nh = lh[2] / sqrt(dot(lh, lh)), q = nh * nh * (a2 - 1) + 1, d = a2 / (PI * q * q);
            const double smith = nl * sqrt(c * c * (1 - a2) + a2) + c * sqrt(nl * nl * (1 - a2) + a2);
            sum += d * 0.5 / smith * nl * sin(polar) * 3 * p * p * (high - low) / POLAR * 2 * PI * 3 * y * y / AROUND;
        }
    return sum;
}

static void white_metal_in_a_furnace(void **state) {
    static const double roughnesses[] = {0.1, 0.2, 0.3, 0.5, 0.64, 0.8, 1}, angles[] = {0, 30, 60, 80};
    double worst = 0, least = 1, most = 0;
    for (size_t r = 0; r < 7; r++)
        for (size_t a = 0; a < 4; a++) {
            const double alpha = roughnesses[r] * roughnesses[r], got = facets_albedo(*state, alpha, angles[a]),
                         want = facets_integral(alpha, angles[a]);
            worst = fmax(worst, fabs(got / want - 1));
            least = fmin(least, want);
            most = fmax(most, got);
        }
    /* At roughness 1 and normal incidence D is 1 / pi and V 1 / (2 (n.l + 1)), whose integral is this. */
    assert_true(fabs(least / (1 - log(2)) - 1) < 1e-3);
    catalogue_row("facets", "white metal in a furnace, roughness 0.1 to 1, 0 to 80 degrees, against its integral", worst, 0.01,
                  "");
    catalogue_row("facets", "white metal in a furnace: reflectance over 1", most - 1, 1e-4, "");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(facets_are_gltfs),
        cmocka_unit_test(facets_are_reciprocal),
        cmocka_unit_test(white_metal_in_a_furnace),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
