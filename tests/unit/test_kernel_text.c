/* The kernels' text holds nothing whose bits differ between devices (kernels/README.md, "Strict arithmetic").
 *
 * A text test cannot see types, so it is about names: calls of built-ins that are not correctly rounded, types and literals of
 * other precisions, image filters, atomics whose result depends on the order of work-items. Our own functions (l_log2, lv3_dot)
 * are other names, and comments are not read. min() and max() on floats are beyond it. */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <cmocka.h>
#include <ctype.h>
#include <dirent.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "kernel_sources.h"
#include "test_folder.h"

/* Functions, refused where they are called. */
static const char *const loose_calls[] = {
    "mad",       "rsqrt",  "mix",        "dot",     "cross",   "normalize", "length", "distance", "sin",      "sinh",
    "sinpi",     "cos",    "cosh",       "cospi",   "tan",     "tanh",      "tanpi",  "sincos",   "asin",     "asinh",
    "asinpi",    "acos",   "acosh",      "acospi",  "atan",    "atanh",     "atanpi", "atan2",    "atan2pi",  "exp",
    "exp2",      "exp10",  "expm1",      "log",     "log2",    "log10",     "log1p",  "logb",     "pow",      "pown",
    "powr",      "rootn",  "cbrt",       "hypot",   "erf",     "erfc",      "tgamma", "lgamma",   "lgamma_r", "fmod",
    "remainder", "remquo", "smoothstep", "radians", "degrees", "fract",     "sqrt"}; /* vit_sqrt, l_sqrt */

/* Words, refused anywhere. Exchanges give what another work-item happened to leave; atomics on floats are made of them. */
static const char *const words[] = {"double",      "sampler_t",      "printf",     "cl_khr_fp64", "cl_khr_int64_base_atomics",
                                    "atomic_xchg", "atomic_cmpxchg", "FP_FAST_FMA"};

/* Beginnings of functions, refused where they are called, and of words, refused anywhere. Of the last, a digit follows. */
static const char *const loose_families[] = {"native_", "half_", "fast_", "atom_"};
static const char *const beginnings[] = {"read_image", "write_image", "get_image_",  "convert_double",
                                         "as_double",  "CLK_FILTER",  "CLK_ADDRESS", "CLK_NORMALIZED"};
static const char *const numbered[] = {"image", "double"};

#define COUNT(a) (sizeof(a) / sizeof *(a))

static bool is_one_of(const char *word, const char *const *list, size_t count) {
    for (size_t i = 0; i < count; i++)
        if (strcmp(word, list[i]) == 0)
            return true;
    return false;
}

static bool begins_like_one_of(const char *word, const char *const *list, size_t count) {
    for (size_t i = 0; i < count; i++)
        if (strncmp(word, list[i], strlen(list[i])) == 0)
            return true;
    return false;
}

static bool is_numbered(const char *word) {
    for (size_t i = 0; i < COUNT(numbered); i++) {
        const size_t n = strlen(numbered[i]);
        if (strncmp(word, numbered[i], n) == 0 && isdigit((unsigned char)word[n]))
            return true;
    }
    return false;
}

static bool is_loose_word(const char *word) {
    return is_numbered(word) || is_one_of(word, words, COUNT(words)) || begins_like_one_of(word, beginnings, COUNT(beginnings));
}

static bool is_loose_call(const char *word) {
    return is_one_of(word, loose_calls, COUNT(loose_calls)) || begins_like_one_of(word, loose_families, COUNT(loose_families));
}

/* A floating literal that is not float: a double on devices that have them. */
static bool is_loose_number(const char *number) {
    const bool hex = number[0] == '0' && (number[1] == 'x' || number[1] == 'X');
    const char last = number[strlen(number) - 1];
    if (strpbrk(number, hex ? "pP" : ".eE") == NULL)
        return false;
    return last != 'f' && last != 'F';
}

/* The text without comments, with as many lines; free() it. */
static char *without_comments(const char *text) {
    char *out = malloc(strlen(text) + 1), *o = out;
    assert_non_null(out);
    while (*text) {
        if (text[0] == '/' && text[1] == '/')
            while (*text && *text != '\n')
                text++;
        else if (text[0] == '/' && text[1] == '*') {
            for (text += 2; *text && !(text[0] == '*' && text[1] == '/'); text++)
                if (*text == '\n')
                    *o++ = '\n';
            text += *text ? 2 : 0;
            *o++ = ' ';
        } else
            *o++ = *text++;
    }
    *o = 0;
    return out;
}

/* Blanks what strict.clh says of division and roots, where alone doubles and sqrt() are right; lines stay. */
static void blank_wide_division(char *code) {
    char *begin = strstr(code, "#ifdef VIT_WIDE_DIVIDE\n"), *end = begin ? strstr(begin, "\n\n") : NULL;
    for (; begin && begin != end && *begin; begin++)
        if (*begin != '\n')
            *begin = ' ';
}

static const char *skip_blanks(const char *s) {
    while (*s == ' ' || *s == '\t')
        s++;
    return s;
}

#define WORD 256

/* Next word or number from *at on, in `word`; false at the end. */
static bool next_word(const char **at, int *line, char word[WORD]) {
    const char *s = *at;
    while (*s && !isalnum((unsigned char)*s) && *s != '_' && !(*s == '.' && isdigit((unsigned char)s[1])))
        *line += *s++ == '\n';
    size_t n = 0;
    const bool number = isdigit((unsigned char)*s) || *s == '.';
    const bool hex = s[0] == '0' && (s[1] == 'x' || s[1] == 'X');
    while (n < WORD - 1 && (isalnum((unsigned char)*s) || *s == '_' || (number && *s == '.') ||
                            (number && (*s == '+' || *s == '-') && strchr(hex ? "pP" : "eE", s[-1]))))
        word[n++] = *s++;
    word[n] = 0;
    *at = s;
    return n > 0;
}

/* Line of the first thing in the text that a kernel must not have, named in `what`; 0 if there is none. */
static int refuse(const char *text, char what[WORD]) {
    char *code = without_comments(text);
    const char *at = code;
    int line = 1, bad = 0;
    while (!bad && next_word(&at, &line, what)) {
        if (isdigit((unsigned char)what[0]) || what[0] == '.') {
            if (is_loose_number(what))
                bad = line;
        } else if (strcmp(what, "FP_CONTRACT") == 0) {
            if (strncmp(skip_blanks(at), "OFF", 3) != 0)
                bad = line;
        } else if (is_loose_word(what) || (*skip_blanks(at) == '(' && is_loose_call(what)))
            bad = line;
    }
    free(code);
    return bad;
}

static bool is_kernel_file(const char *name) {
    const char *dot = strrchr(name, '.');
    return dot && (strcmp(dot, ".cl") == 0 || strcmp(dot, ".clh") == 0);
}

/* Is the text one of those that the library joins? Each is preceded there by a #line of its own. */
static bool is_joined(const char *text) {
    for (unsigned i = 0; i < vit_kernel_source_count; i++) {
        const char *own = strchr(vit_kernel_sources[i], '\n');
        if (own && strcmp(own + 1, text) == 0)
            return true;
    }
    return false;
}

/* The file is part of the program, and holds nothing that differs between devices. */
static void check_strict(const char *path) {
    char what[WORD], *text = read_file(path, NULL);
    if (!is_joined(text))
        fail_msg("%s is not part of the program", path);
    if (strcmp(path, "kernels/strict.clh") == 0)
        blank_wide_division(text);
    const int line = refuse(text, what);
    if (line)
        fail_msg("%s:%d: %s is not strict arithmetic", path, line, what);
    free(text);
}

static void no_kernel_holds_what_differs_between_devices(void **state) {
    DIR *folder = opendir("kernels");
    unsigned files = 0;
    (void)state;
    assert_non_null(folder);
    for (struct dirent *d; (d = readdir(folder)) != NULL;) {
        char path[300];
        if (!is_kernel_file(d->d_name))
            continue;
        snprintf(path, sizeof path, "kernels/%s", d->d_name);
        check_strict(path);
        files++;
    }
    closedir(folder);
    check_strict("include/vitrine_frame.h"); /* names of views and formats */
    assert_int_equal(files + 1, vit_kernel_source_count);
}

/* The first function body of a text without comments: ")", then "{", not in a preprocessor line; NULL if there is none. */
static const char *first_function(const char *code) {
    for (const char *s = code; *s; s++) {
        if (*s == '#') {
            while (*s && !(*s == '\n' && s[-1] != '\\'))
                s++;
            if (!*s)
                return NULL;
        }
        if (*s != ')')
            continue;
        const char *after = s + 1;
        while (isspace((unsigned char)*after))
            after++;
        if (*after == '{')
            return s;
    }
    return NULL;
}

static bool contraction_is_off_first(const char *text) {
    char *code = without_comments(text);
    const char *off = strstr(code, "#pragma OPENCL FP_CONTRACT OFF\n"), *function = first_function(code);
    const bool first = off && (!function || off < function);
    free(code);
    return first;
}

static void contraction_is_off_before_the_first_function(void **state) {
    size_t size = 1;
    (void)state;
    for (unsigned i = 0; i < vit_kernel_source_count; i++)
        size += strlen(vit_kernel_sources[i]);
    char *joined = calloc(1, size);
    assert_non_null(joined);
    for (unsigned i = 0; i < vit_kernel_source_count; i++)
        strcat(joined, vit_kernel_sources[i]);
    assert_true(contraction_is_off_first(joined));
    free(joined);
    assert_true(contraction_is_off_first("#define F(x) { x; }\n#pragma OPENCL FP_CONTRACT OFF\nvoid f(void)\n{\n}\n"));
    assert_false(contraction_is_off_first("void f(void)\n{\n}\n#pragma OPENCL FP_CONTRACT OFF\n"));
    assert_false(contraction_is_off_first("/*\n#pragma OPENCL FP_CONTRACT OFF\n*/ void f(void) {}"));
    assert_false(contraction_is_off_first("float x;\n"));
}

static void the_runtime_asks_for_no_loose_arithmetic(void **state) {
    static const char *const options[] = {"-cl-fast",
                                          "-cl-mad-enable",
                                          "-cl-unsafe-math",
                                          "-cl-finite-math",
                                          "-cl-no-signed-zero",
                                          "-cl-denorms-are-zero",
                                          "-cl-single-precision-constant"};
    char *text = read_file("runtime/device_opencl.c", NULL);
    (void)state;
    for (size_t i = 0; i < COUNT(options); i++)
        assert_null(strstr(text, options[i]));
    assert_non_null(strstr(text, "-cl-fp32-correctly-rounded-divide-sqrt"));
    free(text);
}

static void the_checker_catches_each_forbidden_kind(void **state) {
    static const char *const bad[] = {"x = native_sin(y);",
                                      "x = native_recip(y);",
                                      "x = half_sqrt(y);",
                                      "x = fast_length(v);",
                                      "x = fast_normalize(v);",
                                      "x = mad(a, b, c);",
                                      "x = rsqrt (y);",
                                      "x = 1.0f / sqrt(y);",
                                      "x = mix(a, b, t);",
                                      "x = dot(a, b);",
                                      "v = cross(a, b);",
                                      "v = normalize(a);",
                                      "x = length(v);",
                                      "x = distance(a, b);",
                                      "x = sin(y);",
                                      "x = cos(y);",
                                      "x = tan(y);",
                                      "x = sincos(y, &c);",
                                      "x = exp(y);",
                                      "x = exp2(y);",
                                      "x = exp10(y);",
                                      "x = log(y);",
                                      "x = log2(y);",
                                      "x = log10(y);",
                                      "x = pow(y, z);",
                                      "x = pown(y, 2);",
                                      "x = powr(y, z);",
                                      "x = atan2(y, z);",
                                      "x = cbrt(y);",
                                      "x = hypot(y, z);",
                                      "x = fmod(y, z);",
                                      "x = smoothstep(a, b, c);",
                                      "sampler_t s;",
                                      "read_only image2d_t i;",
                                      "c = read_imagef(i, s, p);",
                                      "printf(\"%d\", i);",
                                      "double x;",
                                      "double4 x;",
                                      "x = convert_double(y);",
                                      "x = as_double(y);",
                                      "#pragma OPENCL EXTENSION cl_khr_fp64 : enable",
                                      "#pragma OPENCL FP_CONTRACT ON",
                                      "#pragma OPENCL FP_CONTRACT DEFAULT",
                                      "old = atomic_cmpxchg(p, a, b);",
                                      "old = atomic_xchg(p, a);",
                                      "atom_add(p, 1);",
                                      "x = 1.0;",
                                      "x = .5;",
                                      "x = 1.;",
                                      "x = 1e-3;",
                                      "x = 1.5e+3;",
                                      "x = 0x1p-3;",
                                      "x = y * 2.0 + 1.0f;",
                                      "/* */ x = 2.0; // ok"};
    static const char *const good[] = {"",
                                       "x = lv3_dot(a, b);",
                                       "x = l_log2(y) + l_exp2(y);",
                                       "l_sincos_turn(u, &s, &c);",
                                       "/* sin(x), 1.0 */",
                                       "// mad(a, b, c) 1.0\n",
                                       "float distance = t; length = distance * cross;",
                                       "x = 1.0f + .5f + 1e-3f + 0x1p-3f;",
                                       "i = 0xe5 + 0x1E + 10u + 3;",
                                       "vstore_half_rte(x, 0, p);",
                                       "#pragma OPENCL FP_CONTRACT OFF",
                                       "atomic_add(p, 1); atomic_min(p, i);",
                                       "l_sqrt(x); vit_sqrt(y); fma(a, b, c);",
                                       "images[3] = image_count;",
                                       "v.s0 = v.x; p[1].y;",
                                       "li powers(int i);",
                                       "uint4 doubles;",
                                       "x = a.lo.hi;",
                                       "half_turn = x * 0.5f;",
                                       "barrier(CLK_LOCAL_MEM_FENCE);",
                                       "i = v.s1 + 7;"};
    char what[WORD];
    (void)state;
    for (size_t i = 0; i < COUNT(bad); i++)
        if (refuse(bad[i], what) != 1)
            fail_msg("let through: %s", bad[i]);
    for (size_t i = 0; i < COUNT(good); i++)
        if (refuse(good[i], what) != 0)
            fail_msg("refused for %s: %s", what, good[i]);
    for (size_t i = 0; i < COUNT(loose_calls); i++) {
        char text[300];
        snprintf(text, sizeof text, "/* one\n two */\nx = l_%s(y) +\n    %s(y);", loose_calls[i], loose_calls[i]);
        assert_int_equal(refuse(text, what), 4);
        assert_string_equal(what, loose_calls[i]);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(no_kernel_holds_what_differs_between_devices),
        cmocka_unit_test(contraction_is_off_before_the_first_function),
        cmocka_unit_test(the_runtime_asks_for_no_loose_arithmetic),
        cmocka_unit_test(the_checker_catches_each_forbidden_kind),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
