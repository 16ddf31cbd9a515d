/* glTF's metallic-roughness materials as Phong lobes (bake/import/metallic_roughness.c), against glTF's own BRDF (GGX, Smith,
 * Schlick; glTF 2.0, appendix B) in double, integrated over the hemisphere.
 *
 * What can go wrong: highlights are too sharp or too wide, too bright or too dark, at some roughness or angle. Nothing makes a
 * Phong lobe a GGX lobe: it has no tails, it does not stretch at grazing angles, where it also loses light below the horizon,
 * and there is no Fresnel factor. The bounds are what the mapping does now, for who changes it. The RMS of lobes is of f - g,
 * weighted with the cosine, relative to g's, glTF's. With the exponent of Blinn's lobe, 2 / alpha^2 - 2, it would be 1.7 at
 * normal incidence, not 0.3. What a rough metal of ours reflects too much, 0.55 of 0.8 at roughness 1, is what GGX with one
 * scattering loses. */
#include "catalogue.h"
#include "import/metallic_roughness.h"
#include "vitrine_pack.h"
#include <math.h>

#define PI 3.14159265358979323846
enum { POLAR = 800, AROUND = 400 };

/* Sums over directions of light, for one direction of view. */
typedef struct compared {
    double ours, theirs;   /* directional albedo */
    double squares, error; /* of theirs, of the difference */
} compared;

static double phong(const model_material *m, const double l[3], const double v[3]) {
    const double c = -l[0] * v[0] - l[1] * v[1] + l[2] * v[2]; /* to the mirrored direction, n being z */
    const double lobe = c > 0 ? ((double)m->exponent + 2) / (2 * PI) * pow(c, (double)m->exponent) : 0;
    return (double)m->albedo[0] / PI + (double)m->specular[0] * lobe;
}

static double gltf(double base, double metallic, double roughness, const double l[3], const double v[3]) {
    const double a2 = pow(roughness, 4);
    double h[3] = {l[0] + v[0], l[1] + v[1], l[2] + v[2]};
    const double length = sqrt(h[0] * h[0] + h[1] * h[1] + h[2] * h[2]);
    for (int k = 0; k < 3; k++)
        h[k] /= length;
    const double q = h[2] * h[2] * (a2 - 1) + 1, d = a2 / (PI * q * q);
    const double vis = 0.5 / (l[2] * sqrt(v[2] * v[2] * (1 - a2) + a2) + v[2] * sqrt(l[2] * l[2] * (1 - a2) + a2));
    const double grazing = pow(1 - (v[0] * h[0] + v[1] * h[1] + v[2] * h[2]), 5);
    const double metal = d * vis * (base + (1 - base) * grazing), f = 0.04 + 0.96 * grazing;
    return metallic * metal + (1 - metallic) * (base / PI * (1 - f) + d * vis * f);
}

static const float dielectric[3] = {SPECULAR_DIELECTRIC, SPECULAR_DIELECTRIC, SPECULAR_DIELECTRIC};

static model_material mapped(double base, double metallic, double roughness) {
    const float c[3] = {(float)base, (float)base, (float)base};
    model_material m = {0};
    specular_from_metallic(&m, c, c, dielectric, (float)metallic, (float)roughness);
    assert_int_equal(m.kind, VIT_MATTE);
    return m;
}

static compared compare(double base, double metallic, double roughness, double degrees) {
    const model_material m = mapped(base, metallic, roughness);
    const double t = degrees * PI / 180, v[3] = {sin(t), 0, cos(t)};
    compared c = {0};
    for (int i = 0; i < POLAR; i++)
        for (int k = 0; k < AROUND; k++) {
            const double polar = (i + 0.5) / POLAR * PI / 2, around = (k + 0.5) / AROUND * PI;
            const double l[3] = {sin(polar) * cos(around), sin(polar) * sin(around), cos(polar)};
            const double weight = l[2] * sin(polar) * (PI / 2 / POLAR) * (2 * PI / AROUND);
            const double f = phong(&m, l, v), g = gltf(base, metallic, roughness, l, v);
            c.ours += f * weight;
            c.theirs += g * weight;
            c.squares += g * g * weight;
            c.error += (f - g) * (f - g) * weight;
        }
    return c;
}

typedef struct bounds {
    double roughness, albedo, rms, grazing_albedo, grazing_rms;
} bounds;

/* At 0, 30 and 60 degrees, and at 75. */
static void check(const char *what, double base, double metallic, const bounds *b, size_t count) {
    for (size_t i = 0; i < count; i++) {
        static const double angles[] = {0, 30, 60, 75};
        double albedo[2] = {0, 0}, rms[2] = {0, 0};
        char text[96];
        for (size_t k = 0; k < 4; k++) {
            const compared c = compare(base, metallic, b[i].roughness, angles[k]);
            albedo[k == 3] = fmax(albedo[k == 3], fabs(c.ours - c.theirs));
            rms[k == 3] = fmax(rms[k == 3], sqrt(c.error / c.squares));
        }
        (void)snprintf(text, sizeof text, "%s of roughness %g: albedo to 60 degrees", what, b[i].roughness);
        catalogue_row("gloss of glTF", text, albedo[0], b[i].albedo, "");
        (void)snprintf(text, sizeof text, "%s of roughness %g: RMS of lobes to 60 degrees", what, b[i].roughness);
        catalogue_row("gloss of glTF", text, rms[0], b[i].rms, "of glTF's");
        (void)snprintf(text, sizeof text, "%s of roughness %g: albedo at 75 degrees", what, b[i].roughness);
        catalogue_row("gloss of glTF", text, albedo[1], b[i].grazing_albedo, "");
        (void)snprintf(text, sizeof text, "%s of roughness %g: RMS of lobes at 75 degrees", what, b[i].roughness);
        catalogue_row("gloss of glTF", text, rms[1], b[i].grazing_rms, "of glTF's");
    }
}

static void metals_have_lobes_like_gltfs(void **state) {
    static const bounds b[] = {{0.2, 0.43, 0.69, 0.66, 0.95},  {0.3, 0.41, 0.69, 0.61, 0.95},  {0.5, 0.3, 0.67, 0.46, 0.88},
                               {0.63, 0.18, 0.62, 0.31, 0.78}, {0.65, 0.22, 0.84, 0.18, 0.89}, {0.8, 0.38, 0.85, 0.24, 0.66},
                               {1, 0.59, 2.4, 0.35, 0.77}};
    (void)state;
    check("metal", 0.8, 1, b, sizeof b / sizeof *b);
}

static void dielectrics_have_lobes_like_gltfs(void **state) {
    static const bounds b[] = {{0.2, 0.051, 0.74, 0.24, 1.1},    {0.3, 0.051, 0.57, 0.2, 1.1},
                               {0.5, 0.035, 0.31, 0.095, 0.82},  {0.63, 0.019, 0.17, 0.054, 0.49},
                               {0.65, 0.021, 0.17, 0.047, 0.45}, {0.8, 0.0096, 0.066, 0.025, 0.19},
                               {1, 0.0082, 0.018, 0.008, 0.056}};
    (void)state;
    check("grey", 0.5, 0, b, sizeof b / sizeof *b);
}

/* Where a lobe begins to be one, and how its error grows with roughness. */
static void the_error_over_roughness(void **state) {
    enum { STEPS = 18 };
    catalogue_point rms[STEPS], albedo[STEPS];
    (void)state;
    for (int i = 0; i < STEPS; i++) {
        const double roughness = 0.15 + 0.05 * i;
        const compared c = compare(0.8, 1, roughness, 0);
        rms[i] = (catalogue_point){roughness, sqrt(c.error / c.squares)};
        albedo[i] = (catalogue_point){roughness, fabs(c.ours - c.theirs)};
        assert_true(c.ours <= 0.8 + 1e-3);
    }
    catalogue_sweep("rms", "roughness of a metal", "RMS of lobes at normal incidence, of glTF's", rms, STEPS);
    catalogue_sweep("albedo", "roughness of a metal", "error of the albedo at normal incidence", albedo, STEPS);
}

static void smooth_metals_are_mirrors_and_wide_lobes_matt(void **state) {
    static const float base[3] = {0.9f, 0.7f, 0.5f};
    model_material m = {0};
    (void)state;
    specular_from_metallic(&m, base, base, dielectric, 1.0f, 0.1f);
    assert_true(m.kind == VIT_MIRROR && m.specular[1] == 0.7f && m.exponent == 1.0f);
    specular_from_metallic(&m, base, base, dielectric, 1.0f, 0.11f);
    assert_true(m.kind == VIT_MATTE && m.specular[1] == 0.7f && m.albedo[1] == 0.0f && m.exponent > 3000.0f);
    specular_from_metallic(&m, base, base, dielectric, 0.89f, 0.1f);
    assert_true(m.kind == VIT_MATTE && m.specular[0] < 0.9f && m.albedo[0] > 0.0f && m.albedo[0] + m.specular[0] <= 1.0f);
    specular_from_metallic(&m, base, base, dielectric, 1.0f, 0.7f);
    assert_true(m.kind == VIT_MATTE && m.specular[0] == 0.0f && m.albedo[0] == 0.9f && m.exponent == 1.0f);
    m.emission[1] = 1.0f; /* what emits is seen: no mirror */
    specular_from_metallic(&m, base, base, dielectric, 1.0f, 0.0f);
    assert_true(m.kind == VIT_MATTE && m.specular[0] == 0.9f && m.exponent == VIT_MAX_EXPONENT);
    float last = VIT_MAX_EXPONENT;
    for (int i = 0; i <= 1000; i++) {
        const float e = specular_exponent((float)i / 1000.0f);
        assert_true(e <= last && (e == 0.0f || e >= 1.0f));
        last = e;
    }
    assert_true(last == 0.0f);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(smooth_metals_are_mirrors_and_wide_lobes_matt),
        cmocka_unit_test(metals_have_lobes_like_gltfs),
        cmocka_unit_test(dielectrics_have_lobes_like_gltfs),
        cmocka_unit_test(the_error_over_roughness),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
