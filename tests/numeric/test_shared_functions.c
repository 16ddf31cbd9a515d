/* Functions that kernels and baker both have: the light model, sampling, the sky, mirrors and glass.
 *
 * What can go wrong: one of the two is changed, and photons baked are no longer the photons traced while playing, or the
 * reference has another light than the frame. The bounds: the same bits where the C functions say that they compute as the
 * kernels do, for numbers all over the domains and at their ends; where the reference computes in double, what the kernel's
 * roundings explain. */
#include "catalogue.h"
#include "common/colour.h"
#include "common/octahedral.h"
#include "host_lab.h"
#include "light/light_model.h"
#include "light/photon_emission.h"
#include "light/photon_specular.h"
#include "light/sky.h"
#include "reference/specular.h"

enum { COUNT = 1 << 14, MOST = 12, SKY = 16 };

static const uint32_t floats_in[] = {
#define X(name, in, out) in,
    HOST_LAB_FUNCTIONS(X)
#undef X
};
static const uint32_t floats_out[] = {
#define X(name, in, out) out,
    HOST_LAB_FUNCTIONS(X)
#undef X
};

static float in[MOST * COUNT], out[MOST * COUNT];

/* ---- numbers that go in ---- */

static uint32_t random_state;

static float random_unit(void) {
    return unit_float(random_state = pcg(random_state));
}

static float bits_float(uint32_t bits) {
    float f;
    memcpy(&f, &bits, 4);
    return f;
}

static uint32_t float_bits(float f) {
    uint32_t bits;
    memcpy(&bits, &f, 4);
    return bits;
}

/* Words whose exponent bits are not all ones are floats that loads and stores leave alone. */
static float any_word(uint32_t i) {
    const uint32_t word = i < 32 ? 1u << i : i < 64 ? (1u << (i - 32)) - 1u : (random_state = pcg(random_state));
    return bits_float((word & 0x7f800000u) == 0x7f800000u ? word & ~0x00800000u : word);
}

static float between(uint32_t i, float least, float most) {
    return i % 64 == 0 ? least : i % 64 == 1 ? most : least + (most - least) * random_unit();
}

/* Along axes, in their planes, next to -z where the basis is worst, and anywhere. */
static vec3 any_direction(uint32_t i) {
    const float x = 2 * random_unit() - 1, y = 2 * random_unit() - 1, z = 2 * random_unit() - 1;
    switch (i % 8) {
    case 0:
        return (vec3){i / 8 % 3 == 0 ? 1.0f : 0.0f, i / 8 % 3 == 1 ? -1.0f : 0.0f, i / 8 % 3 == 2 ? -1.0f : 0.0f};
    case 1:
        return vec3_unit((vec3){x, i & 8 ? 0.0f : -0.0f, z});
    case 2:
        return vec3_unit((vec3){x, y, i & 8 ? 0.0f : -0.0f});
    case 3:
        return vec3_unit((vec3){1e-4f * x, 1e-4f * y, -1});
    default:
        return vec3_unit((vec3){x, y, z});
    }
}

static void put3(uint32_t plane, uint32_t i, vec3 v) {
    in[plane * COUNT + i] = v.x;
    in[(plane + 1) * COUNT + i] = v.y;
    in[(plane + 2) * COUNT + i] = v.z;
}

static void fill(host_lab_function f, uint32_t i) {
    float *number = in + i;
    const vec3 d = any_direction(i), e = any_direction(i / 8 + 5), g = any_direction(i / 64 + 6);
    switch (f) {
    case HOST_LAB_pcg:
    case HOST_LAB_unit_float:
    case HOST_LAB_even_bits:
    case HOST_LAB_normal:
        *number = any_word(i);
        return;
    case HOST_LAB_sincos:
        *number = between(i, 0, 1);
        return;
    case HOST_LAB_exp2:
        *number = between(i, -126, 126);
        return;
    case HOST_LAB_srgb:
        *number = between(i, -0.5f, 1.5f);
        return;
    case HOST_LAB_unit:
    case HOST_LAB_place:
        put3(0, i, vec3_scale(d, i == 64 ? 0 : ldexpf(1, (int)(i % 81) - 40)));
        return;
    case HOST_LAB_falloff:
    case HOST_LAB_left:
        *number = ldexpf(1 + random_unit(), (int)(i % 60) - 30);
        return;
    case HOST_LAB_way: /* on the light itself, and within the least distance, too */
        put3(0, i, vec3_along((vec3){0.5f, -0.25f, 2}, d, i % 16 == 0 ? 0 : ldexpf(random_unit(), (int)(i % 40) - 30)));
        put3(3, i, e);
        return;
    case HOST_LAB_emission:
        *number = bits_float(16 + i % 4096);
        return;
    case HOST_LAB_mean:
        put3(0, i, (vec3){random_unit(), random_unit(), random_unit()});
        number[3 * COUNT] = between(i, VIT_MIN_ALPHA, 1);
        return;
    case HOST_LAB_absorbed:
        number[0] = between(i, 0, 100);
        number[COUNT] = between(i / 64, 0, 10);
        return;
    default:
        put3(0, i, d);
        put3(3, i, e);
        put3(6, i, g);
        number[9 * COUNT] = f == HOST_LAB_lobe ? 1 + 9999 * random_unit() * random_unit() : (float)(i & 1);
        number[10 * COUNT] = (float)(i >> 1 & 1);
        number[11 * COUNT] = between(i, 1, 2.5f);
        if (f == HOST_LAB_cosine) {
            number[3 * COUNT] = between(i, 0, 1);
            number[4 * COUNT] = between(i / 64, 0, 1);
        }
    }
}

/* ---- what the baker computes of them ---- */

static vec3 get3(const float *a) {
    return (vec3){a[0], a[1], a[2]};
}

static void give3(vec3 v, float *b) {
    b[0] = v.x;
    b[1] = v.y;
    b[2] = v.z;
}

static void baker_sampling(host_lab_function f, const float *a, float *b) {
    vec3 x, y;
    switch (f) {
    case HOST_LAB_pcg:
        *b = bits_float(pcg(float_bits(*a)));
        return;
    case HOST_LAB_unit_float:
        *b = unit_float(float_bits(*a));
        return;
    case HOST_LAB_even_bits:
        *b = bits_float(even_bits(float_bits(*a)));
        return;
    case HOST_LAB_sincos:
        sincos_turn(*a, b, b + 1);
        return;
    case HOST_LAB_exp2:
        *b = power_of_two(*a);
        return;
    case HOST_LAB_unit:
        give3(vec3_unit(get3(a)), b);
        return;
    case HOST_LAB_basis:
        vec3_across(get3(a), &x, &y);
        give3(x, b);
        give3(y, b + 3);
        return;
    case HOST_LAB_cosine:
        give3(vec3_cosine(get3(a), a[3], a[4]), b);
        return;
    case HOST_LAB_place:
        octahedral_place(get3(a), b, b + 1);
        return;
    default:
        give3(decoded_normal(float_bits(*a)), b);
    }
}

static void baker_light(host_lab_function f, const host_lab_given *with, const float *a, float *b) {
    const vit_light *light = with->light;
    vec3 l;
    switch (f) {
    case HOST_LAB_cone:
        *b = light_cone(light, get3(a));
        return;
    case HOST_LAB_falloff:
        *b = light_falloff(light, *a);
        return;
    case HOST_LAB_left:
        *b = light_left(light, *a);
        return;
    case HOST_LAB_way:
        b[4] = light_irradiance(light, with->scene->ray_offset, get3(a), get3(a + 3), &l, b + 3);
        give3(l, b);
        return;
    case HOST_LAB_emission: {
        const photons_light source = {.light = *light, .paths = light->path_count};
        const uint32_t path = float_bits(*a);
        const emission e = photon_leave(NULL, &source, path - light->path_first, path);
        give3(e.origin, b);
        give3(e.direction, b + 3);
        give3(e.power, b + 6);
        return;
    }
    case HOST_LAB_sky:
        give3(sky_picture(with->sky, with->scene->sky_size, get3(a)), b);
        return;
    case HOST_LAB_mirrored:
        give3(specular_mirrored(get3(a), get3(a + 3), get3(a + 6)), b);
        return;
    case HOST_LAB_glass: {
        const specular_paths p = specular_at_glass(get3(a), get3(a + 3), get3(a + 6), a[9] > 0, a[10] > 0, a[11]);
        give3(p.mirrored, b);
        give3(p.refracted, b + 3);
        b[6] = p.mirror;
        return;
    }
    case HOST_LAB_mean:
        give3(specular_mean(get3(a), a[3]), b);
        return;
    default:
        *b = specular_absorbed((vec3){a[0], 0, 0}, a[1]).x;
    }
}

/* ---- comparisons ---- */

static void call(host_lab_function f, const host_lab_given *with) {
    random_state = 1u + (uint32_t)f;
    memset(in, 0, sizeof in);
    for (uint32_t i = 0; i < COUNT; i++)
        fill(f, i);
    host_lab_find()->call(f, with, in, COUNT, out);
}

static void numbers_of(host_lab_function f, uint32_t i, float a[MOST]) {
    for (uint32_t k = 0; k < floats_in[f]; k++)
        a[k] = in[k * COUNT + i];
}

/* Results whose bits differ. */
static uint64_t apart(host_lab_function f, const host_lab_given *with) {
    uint64_t wrong = 0;
    call(f, with);
    for (uint32_t i = 0; i < COUNT; i++) {
        float a[MOST] = {0}, b[MOST] = {0};
        bool same = true;
        numbers_of(f, i, a);
        if (f < HOST_LAB_srgb)
            baker_sampling(f, a, b);
        else
            baker_light(f, with, a, b);
        for (uint32_t k = 0; k < floats_out[f]; k++)
            same &= float_bits(b[k]) == float_bits(out[k * COUNT + i]);
        wrong += !same;
    }
    return wrong;
}

static void sampling_has_the_same_bits(void **state) {
    uint64_t wrong = 0;
    (void)state;
    for (int f = 0; f < HOST_LAB_srgb; f++) {
        const uint64_t here = apart((host_lab_function)f, NULL);
        if (here > 0)
            print_error("function %d of HOST_LAB_FUNCTIONS: %llu of %d\n", f, (unsigned long long)here, COUNT);
        wrong += here;
    }
    catalogue_none("shared functions", "numbers and directions: results of other bits than the kernel's", wrong,
                   (uint64_t)HOST_LAB_srgb * COUNT, "results");
}

/* Every kind, with each falloff. */
static vit_light light_of(uint32_t i) {
    vit_light l = {.position = {0.5f, -0.25f, 2},
                   .kind = i % 3 == 0   ? VIT_LIGHT_POINT
                           : i % 3 == 1 ? VIT_LIGHT_SPOT
                                        : VIT_LIGHT_DIRECTIONAL,
                   .cos_outer = -1,
                   .intensity = {3, 2, 1},
                   .path_first = 16,
                   .path_count = 4096,
                   .spot_offset = 1};
    const vec3 axis = vec3_unit((vec3){0.3f, -0.9f, -0.2f});
    l.direction[0] = axis.x;
    l.direction[1] = axis.y;
    l.direction[2] = axis.z;
    if (l.kind == VIT_LIGHT_SPOT) {
        l.cos_outer = 0.3f;
        l.spot_scale = 1 / (0.8f - 0.3f);
        l.spot_offset = -0.3f * l.spot_scale;
    } else if (l.kind == VIT_LIGHT_DIRECTIONAL)
        l.spot_scale = 4.5f;
    if (l.kind != VIT_LIGHT_DIRECTIONAL && i / 3 > 0) {
        l.inv_range2 = 0.04f;
        l.falloff = i / 3 == 1 ? VIT_FALLOFF_INVERSE_SQUARE : VIT_FALLOFF_WINDOW;
    }
    return l;
}

static void light_has_the_same_bits(void **state) {
    static vit_sky_texel sky[(SKY + 2) * (SKY + 2)];
    const vit_scene meta = {.ray_offset = 1e-4f, .sky_size = SKY};
    uint64_t wrong = 0, count = 0;
    (void)state;
    for (uint32_t i = 0; i < sizeof sky / sizeof *sky; i++)
        for (int k = 0; k < 3; k++)
            sky[i].radiance[k] = 10 * random_unit();
    for (uint32_t i = 0; i < 9; i++) {
        const vit_light light = light_of(i);
        const host_lab_given with = {&meta, &light, sky};
        for (int f = HOST_LAB_cone; f < HOST_LAB_FUNCTION_COUNT; f++)
            if (f != HOST_LAB_lobe) {
                const uint64_t here = apart((host_lab_function)f, &with);
                if (here > 0)
                    print_error("light %u, function %d of HOST_LAB_FUNCTIONS: %llu of %d\n", i, f, (unsigned long long)here,
                                COUNT);
                wrong += here;
                count += COUNT;
            }
    }
    catalogue_none("shared functions", "lights, sky, mirrors, glass: results of other bits than the kernel's", wrong, count,
                   "results");
}

static void what_is_computed_in_double_is_near(void **state) {
    double curve = 0, lobe = 0, normal = 0, back = 0;
    (void)state;
    call(HOST_LAB_srgb, NULL);
    for (uint32_t i = 0; i < COUNT; i++)
        curve = fmax(curve, fabs((double)out[i] - srgb_encoded((double)in[i])));
    call(HOST_LAB_lobe, &(host_lab_given){0});
    for (uint32_t i = 0; i < COUNT; i++) {
        float a[MOST];
        double reflected[3];
        numbers_of(HOST_LAB_lobe, i, a);
        const path_vertex v = {.normal = get3(a), .out = get3(a + 6), .specular = {1, 1, 1}, .exponent = a[9], .glossy = true};
        specular_reflectance(&v, get3(a + 3), reflected);
        lobe = fmax(lobe, fabs((double)out[i] * PI - reflected[0]) / ((double)a[9] * ((double)a[9] + 2) / 2));
    }
    call(HOST_LAB_normal, NULL);
    for (uint32_t i = 0; i < COUNT; i++) {
        const uint32_t code = float_bits(in[i]);
        const int s[2] = {(int16_t)(code & 0xffffu), (int16_t)(code >> 16)};
        float n[3];
        double solid;
        float u, v;
        if (s[0] == -32768 || s[1] == -32768) /* no encoder gives it */
            continue;
        octahedral_decode(s, 32767, n);
        for (uint32_t k = 0; k < 3; k++)
            normal = fmax(normal, fabs((double)n[k] - (double)out[k * COUNT + i]));
        octahedral_place(sky_place(s[0] / 32767.0, s[1] / 32767.0, &solid), &u, &v);
        const vec3 again = sky_place((double)u, (double)v, &solid), d = vec3_sub(again, (vec3){n[0], n[1], n[2]});
        back = fmax(back, sqrt((double)vec3_dot(d, d)));
    }
    catalogue_row("shared functions", "sRGB curve in double", curve, 1.5e-7, "of 1");
    catalogue_row("shared functions", "Phong lobe in double, over its peak and its exponent", lobe, 3e-7, "of the peak");
    catalogue_row("shared functions", "octahedral normals by division", normal, 3e-7, "of 1");
    catalogue_row("shared functions", "octahedral square there and back", back, 5e-7, "radians");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sampling_has_the_same_bits),
        cmocka_unit_test(light_has_the_same_bits),
        cmocka_unit_test(what_is_computed_in_double_is_near),
    };
    return cmocka_run_group_tests_name("shared functions", tests, NULL, NULL);
}
