/* Our own transcendental functions against libm's doubles, over their whole domains, and the encodings of samples there and
 * back.
 *
 * The bounds below are those that the kernels' comments state. Each must hold everywhere and must not be slack: a bound several
 * times the measured error would let a wrong coefficient through. Domains too large to walk are walked where the error has its
 * extremes (all mantissas of an exponent) and sampled at random elsewhere. */
#include "catalogue.h"
#include "kernel_lab.h"
#include <math.h>

#define CHUNK (1u << 22)
#define SINCOS_BOUND 8e-8
#define LOG2_BOUND_NEAR_ONE 1.1e-7
#define LOG2_BOUND 9e-8
#define EXP2_BOUND 8e-8
#define SRGB_BOUND 1.5e-7
#define NORMAL_BOUND 6.6e-5 /* radians; half a step of 1/32767 along both axes, stretched by the projection */
#define TWO_PI 6.283185307179586476925286766559

/* x in; y out; sincos has two results. What takes or gives words takes or gives their bits. */
static const char kernels[] =
    "#define MAP(name, expression)                                                                   \\\n"
    "    kernel void name(global const float *in, global float *out, global float *second)           \\\n"
    "    {                                                                                           \\\n"
    "        size_t i = get_global_id(0) * VIT_LANES;                                                \\\n"
    "        lf x = L_LOAD(in + i), y, z = (lf)0;                                                    \\\n"
    "        expression;                                                                             \\\n"
    "        L_STORE(y, out + i);                                                                    \\\n"
    "        L_STORE(z, second + i);                                                                 \\\n"
    "    }\n"
    "MAP(map_sincos, l_sincos_turn(x, &y, &z))\n"
    "MAP(map_log2, y = l_log2(x))\n"
    "MAP(map_exp2, y = l_exp2(x))\n"
    "MAP(map_srgb, y = srgb_curve(x); z = L_FROM_INT(to_steps(y, 255.0f)))\n"
    "MAP(map_albedo, lv3 a = l_decode_albedo(L_AS_UINT(x)); y = a.x + a.y * 2.0f + a.z * 4.0f; z = "
    "L_AS_FLOAT(l_encode_albedo(a)))\n"
    "MAP(map_whole, li w = L_AS_INT(x); y = l_snorm16((w << 16) >> 16); z = L_FROM_INT(l_nearest(L_FROM_INT(w) * 0.25f)))\n"
    "kernel void map_normal(global const float *in, global float *out, global float *second)\n" /* 3 planes; 3 planes; codes */
    "{\n"
    "    size_t i = get_global_id(0) * VIT_LANES, n = get_global_size(0) * VIT_LANES;\n"
    "    lu code = l_encode_normal(lv3_load_planes(in, (uint)n, (uint)i));\n"
    "    L_STORE(L_AS_FLOAT(code), second + i);\n"
    "    lv3_store_planes(l_decode_normal(code), out, (uint)n, (uint)i);\n"
    "}\n";

typedef struct map {
    lab l;
    unsigned lanes;
    float *in, *out, *second; /* 3 CHUNK, 3 CHUNK, CHUNK */
} map;

static map map_open(unsigned lanes) {
    map m = {.l = lab_open(lanes, 0, kernels), .lanes = lanes};
    m.in = calloc(3 * (size_t)CHUNK, 4);
    m.out = calloc(3 * (size_t)CHUNK, 4);
    m.second = calloc(CHUNK, 4);
    assert_true(m.in && m.out && m.second);
    return m;
}

static void map_close(map *m) {
    lab_close(&m->l);
    free(m->in);
    free(m->out);
    free(m->second);
}

static void map_run(map *m, const char *kernel, unsigned planes) {
    const size_t bytes = (size_t)CHUNK * 4;
    const cl_mem a[] = {lab_buffer(&m->l, m->in, planes * bytes), lab_buffer(&m->l, NULL, planes * bytes),
                        lab_buffer(&m->l, NULL, bytes)};
    lab_run(&m->l, kernel, CHUNK / m->lanes, a, 3);
    lab_read(&m->l, a[1], m->out, planes * bytes);
    lab_read(&m->l, a[2], m->second, bytes);
    for (int i = 0; i < 3; i++)
        clReleaseMemObject(a[i]);
}

static float from_bits(uint32_t bits) {
    float f;
    memcpy(&f, &bits, 4);
    return f;
}

static uint32_t to_bits(float f) {
    uint32_t bits;
    memcpy(&bits, &f, 4);
    return bits;
}

typedef struct worst {
    double error;
    float at;
} worst;

static void worst_of(worst *w, double error, float at) {
    if (!(error <= w->error)) /* NaN is worst */
        *w = (worst){error, at};
}

static void check_bound(const char *what, worst w, double bound) {
    print_message("%s: worst at %.9g\n", what, (double)w.at);
    catalogue_row("polynomials", what, w.error, bound, "");
    assert_true(bound <= 2 * w.error);
}

static void sine_and_cosine_keep_their_bound_on_every_24_bit_turn(void **state) {
    map m = map_open(16);
    worst s = {0}, c = {0}, length = {0};
    (void)state;
    for (uint32_t first = 0; first <= 1u << 24; first += CHUNK) {
        for (uint32_t i = 0; i < CHUNK; i++)
            m.in[i] = (float)(first + i <= 1u << 24 ? first + i : 0) * 0x1p-24f;
        map_run(&m, "map_sincos", 1);
        for (uint32_t i = 0; i < CHUNK && first + i <= 1u << 24; i++) {
            const double a = TWO_PI * (double)m.in[i], x = (double)m.out[i], y = (double)m.second[i];
            worst_of(&s, fabs(x - sin(a)), m.in[i]);
            worst_of(&c, fabs(y - cos(a)), m.in[i]);
            worst_of(&length, fabs(sqrt(x * x + y * y) - 1), m.in[i]);
        }
    }
    map_close(&m);
    check_bound("sine, absolute", s, SINCOS_BOUND);
    check_bound("cosine, absolute", c, SINCOS_BOUND);
    check_bound("length of (sine, cosine) - 1", length, SINCOS_BOUND);
}

static void log2_chunk(map *m, worst *near_one, worst *elsewhere) {
    map_run(m, "map_log2", 1);
    for (uint32_t i = 0; i < CHUNK; i++) {
        const double exact = log2((double)m->in[i]), error = fabs((double)m->out[i] - exact);
        if (fabs(exact) <= 1)
            worst_of(near_one, error, m->in[i]);
        else
            worst_of(elsewhere, error / fabs(exact), m->in[i]);
    }
}

static void log2_keeps_its_bound_on_all_mantissas(void **state) {
    static const uint32_t exponents[] = {1, 125, 126, 127, 128, 254};
    map m = map_open(16);
    worst near_one = {0}, elsewhere = {0};
    uint64_t random = 3;
    (void)state;
    for (size_t e = 0; e < sizeof exponents / sizeof *exponents; e++)
        for (uint32_t first = 0; first < 1u << 23; first += CHUNK) {
            for (uint32_t i = 0; i < CHUNK; i++)
                m.in[i] = from_bits(exponents[e] << 23 | (first + i));
            log2_chunk(&m, &near_one, &elsewhere);
        }
    for (uint32_t i = 0; i < CHUNK; i++)
        m.in[i] = from_bits(0x00800000u + (uint32_t)(lab_random(&random) % 0x7f000000u));
    log2_chunk(&m, &near_one, &elsewhere);
    m.in[0] = 1.0f;
    map_run(&m, "map_log2", 1);
    assert_true(m.out[0] == 0.0f);
    map_close(&m);
    check_bound("log2 on 1/2..2, absolute", near_one, LOG2_BOUND_NEAR_ONE);
    check_bound("log2 elsewhere, relative", elsewhere, LOG2_BOUND);
}

static void exp2_chunk(map *m, worst *w) {
    map_run(m, "map_exp2", 1);
    for (uint32_t i = 0; i < CHUNK; i++) {
        const double exact = exp2((double)m->in[i]);
        worst_of(w, fabs((double)m->out[i] - exact) / exact, m->in[i]);
    }
}

static void exp2_keeps_its_bound(void **state) {
    map m = map_open(16);
    worst w = {0};
    (void)state;
    for (uint32_t first = 0; first < 1u << 23; first += CHUNK) { /* -126..126 in even steps */
        for (uint32_t i = 0; i < CHUNK; i++)
            m.in[i] = (float)(first + i) * (252.0f / 8388608.0f) - 126.0f;
        exp2_chunk(&m, &w);
    }
    for (uint32_t sign = 0; sign < 2; sign++) /* the floats of -1..1 in even steps of their bits */
        for (uint32_t first = 0; first < 1u << 23; first += CHUNK) {
            for (uint32_t i = 0; i < CHUNK; i++)
                m.in[i] = from_bits(sign << 31 | (first + i) * 127u);
            exp2_chunk(&m, &w);
        }
    for (uint32_t i = 0; i < CHUNK; i++)
        m.in[i] = (float)((int)(i % 253) - 126);
    map_run(&m, "map_exp2", 1);
    for (uint32_t i = 0; i < CHUNK; i++)
        assert_true((double)m.out[i] == exp2((double)m.in[i])); /* whole numbers: exact */
    map_close(&m);
    check_bound("exp2, relative", w, EXP2_BOUND);
}

static double srgb_exact(double x) {
    return x <= 0.0031308 ? 12.92 * x : 1.055 * pow(x, 1 / 2.4) - 0.055;
}

static void the_transfer_curve_keeps_its_bound_and_never_steps_down(void **state) {
    map m = map_open(16);
    worst w = {0};
    float step = 0;
    uint64_t random = 4;
    (void)state;
    for (uint32_t first = 0; first <= 1u << 24; first += CHUNK) {
        for (uint32_t i = 0; i < CHUNK; i++)
            m.in[i] = (float)(first + i <= 1u << 24 ? first + i : 1u << 24) * 0x1p-24f;
        map_run(&m, "map_srgb", 1);
        for (uint32_t i = 0; i < CHUNK; i++) {
            assert_true(m.second[i] >= step);
            step = m.second[i];
            worst_of(&w, fabs((double)m.out[i] - srgb_exact((double)m.in[i])), m.in[i]);
        }
    }
    assert_true(step == 255);
    for (uint32_t i = 0; i < CHUNK; i++) /* small ones and what is clamped */
        m.in[i] = i % 2 ? 200 * lab_uniform(&random) - 100 : from_bits((uint32_t)(lab_random(&random) % 0x3f800000u));
    map_run(&m, "map_srgb", 1);
    for (uint32_t i = 0; i < CHUNK; i++) {
        const double x = (double)m.in[i];
        worst_of(&w, fabs((double)m.out[i] - srgb_exact(x < 0 ? 0 : x > 1 ? 1 : x)), m.in[i]);
        assert_in_range((int)m.second[i], 0, 255);
    }
    map_close(&m);
    check_bound("sRGB curve, absolute", w, SRGB_BOUND);
}

/* Unit vectors, some with components of 0 or near it: the folds of the octahedron. */
static void random_normals(float *planes) {
    uint64_t random = 5;
    for (uint32_t i = 0; i < CHUNK; i++) {
        double v[3], l2 = 0;
        for (int k = 0; k < 3; k++) {
            v[k] = 2 * (double)lab_uniform(&random) - 1;
            if (i % 8 == (uint32_t)k)
                v[k] *= i % 16 < 8 ? 0 : 1e-4;
            l2 += v[k] * v[k];
        }
        if (l2 == 0)
            v[2] = l2 = 1;
        for (int k = 0; k < 3; k++)
            planes[(size_t)k * CHUNK + i] = (float)(v[k] / sqrt(l2));
    }
}

static void normals_come_back_within_their_bound(void **state) {
    map m = map_open(16);
    worst angle = {0}, length = {0};
    (void)state;
    random_normals(m.in);
    map_run(&m, "map_normal", 3);
    for (uint32_t i = 0; i < CHUNK; i++) {
        double a[3], b[3], d2 = 0, l2 = 0;
        for (size_t k = 0; k < 3; k++) {
            a[k] = (double)m.in[k * CHUNK + i];
            b[k] = (double)m.out[k * CHUNK + i];
            d2 += (a[k] - b[k]) * (a[k] - b[k]);
            l2 += b[k] * b[k];
        }
        worst_of(&angle, 2 * asin(0.5 * sqrt(d2)), m.in[i]);
        worst_of(&length, fabs(sqrt(l2) - 1), m.in[i]);
    }
    map_close(&m);
    check_bound("normal, radians", angle, NORMAL_BOUND);
    check_bound("length of a decoded normal - 1", length, 3e-7);
}

static void every_albedo_code_comes_back_as_itself(void **state) {
    map m = map_open(16);
    worst w = {0};
    (void)state;
    for (uint32_t i = 0; i < CHUNK; i++) /* all 1024 steps of each channel */
        m.in[i] = from_bits((i & 1023u) | ((i * 7u + (i >> 10)) & 1023u) << 10 | ((i * 13u + (i >> 12)) & 1023u) << 20);
    map_run(&m, "map_albedo", 1);
    for (uint32_t i = 0; i < CHUNK; i++) {
        const uint32_t code = to_bits(m.in[i]);
        const double r = (code & 1023u) / 1023.0, g = (code >> 10 & 1023u) / 1023.0, b = (code >> 20 & 1023u) / 1023.0;
        assert_int_equal(to_bits(m.second[i]), code);
        worst_of(&w, fabs((double)m.out[i] - (r * r + 2 * g * g + 4 * b * b)), m.in[i]);
    }
    map_close(&m);
    check_bound("sum of decoded albedos 1, 2, 4", w, 1.5e-6);
}

/* The inputs of each function: its domain at random, with the ends. */
static void sixteen_bits_are_divided_and_quarters_rounded_to_the_bit(void **state) {
    map m = map_open(16);
    (void)state;
    for (int32_t i = 0; i < (int32_t)CHUNK; i++)
        m.in[i] = from_bits((uint32_t)(i - (int32_t)CHUNK / 2)); /* each 16-bit number many times; quarters up to 2^19 */
    map_run(&m, "map_whole", 1);
    for (int32_t i = 0; i < (int32_t)CHUNK; i++) {
        const int32_t x = i - (int32_t)CHUNK / 2;
        assert_int_equal(to_bits(m.out[i]), to_bits((float)(int16_t)(x & 0xffff) / 32767.0f));
        assert_int_equal((int32_t)m.second[i], (int32_t)nearbyint(x * 0.25)); /* ties to even */
    }
    map_close(&m);
}

static void domain(const char *kernel, float *in, uint64_t seed) {
    if (strcmp(kernel, "map_normal") == 0) {
        random_normals(in);
        return;
    }
    for (uint32_t i = 0; i < CHUNK; i++) {
        const uint64_t r = lab_random(&seed);
        const uint32_t normal = 0x00800000u + (uint32_t)(r % 0x7f000000u);
        in[i] = strcmp(kernel, "map_sincos") == 0 ? (float)(r % ((1u << 24) + 1)) * 0x1p-24f
                : strcmp(kernel, "map_log2") == 0 ? from_bits(normal)
                : strcmp(kernel, "map_exp2") == 0 ? (float)(r >> 40) * (252 * 0x1p-24f) - 126
                : strcmp(kernel, "map_srgb") == 0 ? from_bits((uint32_t)(r % 0x40000000u))
                                                  : from_bits((uint32_t)r & 0x3fffffffu);
    }
}

static void one_eight_and_sixteen_lanes_give_the_same_bits(void **state) {
    static const char *const names[] = {"map_sincos", "map_log2", "map_exp2", "map_srgb", "map_albedo", "map_normal"};
    map m[LAB_WIDTHS];
    (void)state;
    for (unsigned w = 0; w < LAB_WIDTHS; w++)
        m[w] = map_open(lab_lanes[w]);
    for (size_t k = 0; k < sizeof names / sizeof *names; k++)
        for (unsigned w = 0; w < LAB_WIDTHS; w++) {
            const unsigned planes = strcmp(names[k], "map_normal") == 0 ? 3 : 1;
            domain(names[k], m[w].in, 6 + k);
            map_run(&m[w], names[k], planes);
            assert_memory_equal(m[w].out, m[0].out, planes * (size_t)CHUNK * 4);
            assert_memory_equal(m[w].second, m[0].second, (size_t)CHUNK * 4);
        }
    for (unsigned w = 0; w < LAB_WIDTHS; w++)
        map_close(&m[w]);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sine_and_cosine_keep_their_bound_on_every_24_bit_turn),
        cmocka_unit_test(log2_keeps_its_bound_on_all_mantissas),
        cmocka_unit_test(exp2_keeps_its_bound),
        cmocka_unit_test(the_transfer_curve_keeps_its_bound_and_never_steps_down),
        cmocka_unit_test(normals_come_back_within_their_bound),
        cmocka_unit_test(every_albedo_code_comes_back_as_itself),
        cmocka_unit_test(sixteen_bits_are_divided_and_quarters_rounded_to_the_bit),
        cmocka_unit_test(one_eight_and_sixteen_lanes_give_the_same_bits),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
