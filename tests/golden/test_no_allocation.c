/* The library never allocates, opens a file or prints: neither in the frame loop nor anywhere else.
 *
 * Why this is hard: the OpenCL implementation below the library does all of that, in the same process and inside our calls.
 * Strategy: two views from outside. The objects' lists of undefined symbols are held to a list of what is allowed: what is not
 * linked cannot be called. And this program is linked with --wrap for each forbidden function, which redirects the calls of the
 * objects that are linked statically (the library's and this file's) but not those of shared libraries; they are counted while
 * the library runs. Both must be able to see: a call of this file's own is counted first. */
#include "open_pack.h"
#include <fcntl.h>

/* X(result, name, parameters, arguments): functions that are counted. tests/test.mk wraps the same ones. */
#define FORBIDDEN(X)                                                                                                           \
    X(void *, malloc, (size_t size), (size))                                                                                   \
    X(void *, calloc, (size_t count, size_t size), (count, size))                                                              \
    X(void *, realloc, (void *block, size_t size), (block, size))                                                              \
    X(void *, aligned_alloc, (size_t alignment, size_t size), (alignment, size))                                               \
    X(FILE *, fopen, (const char *path, const char *mode), (path, mode))                                                       \
    X(FILE *, fopen64, (const char *path, const char *mode), (path, mode))                                                     \
    X(int, puts, (const char *text), (text))                                                                                   \
    X(int, putchar, (int byte), (byte))                                                                                        \
    X(int, fputs, (const char *text, FILE *to), (text, to))                                                                    \
    X(size_t, fwrite, (const void *from, size_t size, size_t count, FILE *to), (from, size, count, to))                        \
    X(int, vfprintf, (FILE * to, const char *format, va_list list), (to, format, list))                                        \
    X(ssize_t, write, (int file, const void *from, size_t size), (file, from, size))

static int calls; /* of forbidden functions since it was set to 0 */

#define X(result, name, parameters, arguments)                                                                                 \
    result __real_##name parameters;                                                                                           \
    result __wrap_##name parameters;                                                                                           \
    result __wrap_##name parameters {                                                                                          \
        calls++;                                                                                                               \
        return __real_##name arguments;                                                                                        \
    }
FORBIDDEN(X)
#undef X

void __real_free(void *block);
void __wrap_free(void *block);
void __wrap_free(void *block) {
    calls++;
    __real_free(block);
}

/* With `...` there is no way on but the v-function, or for open() the mode. */
int __wrap_printf(const char *format, ...) __attribute__((format(printf, 1, 2)));
int __wrap_printf(const char *format, ...) {
    va_list list;
    calls++;
    va_start(list, format);
    const int n = __real_vfprintf(stdout, format, list);
    va_end(list);
    return n;
}

int __wrap_fprintf(FILE *to, const char *format, ...) __attribute__((format(printf, 2, 3)));
int __wrap_fprintf(FILE *to, const char *format, ...) {
    va_list list;
    calls++;
    va_start(list, format);
    const int n = __real_vfprintf(to, format, list);
    va_end(list);
    return n;
}

/* The same as compilers call them that check by default, as Ubuntu's does (_FORTIFY_SOURCE). */
int __wrap___printf_chk(int checks, const char *format, ...) __attribute__((format(printf, 2, 3)));
int __wrap___printf_chk(int checks, const char *format, ...) {
    va_list list;
    (void)checks;
    calls++;
    va_start(list, format);
    const int n = __real_vfprintf(stdout, format, list);
    va_end(list);
    return n;
}

int __wrap___fprintf_chk(FILE *to, int checks, const char *format, ...) __attribute__((format(printf, 3, 4)));
int __wrap___fprintf_chk(FILE *to, int checks, const char *format, ...) {
    va_list list;
    (void)checks;
    calls++;
    va_start(list, format);
    const int n = __real_vfprintf(to, format, list);
    va_end(list);
    return n;
}

/* glibc's names with and without 64-bit file offsets. */
int __real_open64(const char *path, int flags, ...);
int __wrap_open64(const char *path, int flags, ...);
int __wrap_open64(const char *path, int flags, ...) {
    calls++;
    return __real_open64(path, flags, 0600);
}

int __wrap_open(const char *path, int flags, ...);
int __wrap_open(const char *path, int flags, ...) {
    calls++;
    return __real_open64(path, flags, 0600);
}

/* What the library's objects may need from outside: OpenCL, threads, memory and text in place, arithmetic, and what compilers
 * put in. */
static const char *const allowed[] = {"memcpy",
                                      "memset",
                                      "memmove",
                                      "memcmp",
                                      "memchr",
                                      "strlen",
                                      "strcmp",
                                      "strncmp",
                                      "strchr",
                                      "strstr",
                                      "snprintf",
                                      "vsnprintf",
                                      "__snprintf_chk",
                                      "__vsnprintf_chk",
                                      "__memcpy_chk",
                                      "__memset_chk",
                                      "__stack_chk_fail",
                                      "_GLOBAL_OFFSET_TABLE_",
                                      "floor",
                                      "floorf",
                                      "sqrtf",
                                      "fmaf",
                                      "rintf",
                                      "fegetenv",
                                      "fesetenv",
                                      "sched_getaffinity",
                                      "__sched_cpucount",
                                      "clock_gettime",
                                      "__cpu_model",
                                      "__popcountdi2",
                                      "__tls_get_addr"};
static const char *const allowed_beginnings[] = {"cl", "pthread_", "__asan_", "__ubsan_", "__gcov_", "__llvm_"};

static int is_allowed(const char *name) {
    for (size_t i = 0; i < sizeof allowed / sizeof allowed[0]; i++)
        if (strcmp(name, allowed[i]) == 0)
            return 1;
    for (size_t i = 0; i < sizeof allowed_beginnings / sizeof allowed_beginnings[0]; i++)
        if (strncmp(name, allowed_beginnings[i], strlen(allowed_beginnings[i])) == 0)
            return 1;
    return 0;
}

static void the_librarys_objects_name_nothing_that_allocates_opens_or_prints(void **state) {
    (void)state;
    /* One relocatable object of the whole library: symbols that it defines itself are not undefined in it. */
    static tool_run r;
    test_packs_begin();
    tool(&r, "ld -r --whole-archive " VIT_BUILD_DIR "/libvitrine.a -o " TEST_PACKS "/libvitrine.o");
    tool_succeeds(&r);
    tool(&r, "nm -u -P " TEST_PACKS "/libvitrine.o");
    tool_succeeds(&r);
    (void)unlink(TEST_PACKS "/libvitrine.o");
    int seen = 0;
    char *rest = NULL;
    for (char *line = strtok_r(r.out, "\n", &rest); line; line = strtok_r(NULL, "\n", &rest), seen++) {
        line[strcspn(line, " ")] = '\0';
        if (!is_allowed(line))
            fail_msg("libvitrine.a calls %s", line);
    }
    assert_true(seen > 20);
}

static void a_call_of_a_forbidden_function_is_counted(void **state) {
    (void)state;
    calls = 0;
    void *volatile block = malloc(1);
    free(block);
    (void)fprintf(stderr, "%.*s", 0, "x");
    const int file = open("/dev/null", O_RDONLY);
    assert_int_equal(calls, 4);
    (void)close(file);
}

static void pass_seen(void *user, const char *pass, uint64_t hash) {
    (void)pass;
    (void)hash;
    ++*(int *)user;
}

/* Every function of vitrine.h, from the first look at the pack to the end. */
static int calls_of_a_whole_life(const char *name, vit_open_info how) {
    static uint8_t scratch[1 << 22];
    open_pack p;
    vit_text device;
    int passes = 0;
    pack_open(&p, name, how); /* for the memory */
    vit_close(p.v);
    calls = 0;
    vit_status status = vit_device_name(0, &device) ? VIT_OK : VIT_FAILED;
    status = status == VIT_OK ? vit_require(&p.info, &p.need, &p.why) : status;
    status = status == VIT_OK ? vit_open(&p.info, &p.v, &p.why) : status;
    vit_statistics s = {0};
    for (uint32_t i = 0; i < p.need.frames && status == VIT_OK; i++) {
        status = vit_frame(p.v, i, p.frame, p.stride, &p.why);
        status = status == VIT_OK ? vit_stats(p.v, &s, &p.why) : status;
        (void)vit_golden(p.v, i);
        (void)vit_hash(p.frame, p.need.frame_bytes);
    }
    status = status == VIT_OK ? vit_trace(p.v, 0, scratch, sizeof scratch, pass_seen, &passes, &p.why) : status;
    (void)vit_frame(p.v, 1000000, p.frame, p.stride, &device); /* errors make their text in place */
    vit_close(p.v);
    const int seen = calls;
    assert_vit_ok(&p, status);
    assert_true(passes > 3);
    p.v = NULL;
    pack_close(&p);
    return seen;
}

static void nothing_is_allocated_opened_or_printed_from_open_to_close(void **state) {
    (void)state;
    assert_int_equal(calls_of_a_whole_life("room", (vit_open_info){0}), 0);
    assert_int_equal(calls_of_a_whole_life("room-buckets", (vit_open_info){0}), 0);
    assert_int_equal(calls_of_a_whole_life("dark", (vit_open_info){0}), 0);
    assert_int_equal(calls_of_a_whole_life("basis", (vit_open_info){0}), 0);
    assert_int_equal(calls_of_a_whole_life("live", (vit_open_info){0}), 0);
}

static void the_device_host_takes_all_its_memory_from_the_caller(void **state) {
    (void)state;
    assert_int_equal(calls_of_a_whole_life("room", (vit_open_info){.device = VIT_DEVICE_HOST, .threads = 3}), 0);
    assert_int_equal(
        calls_of_a_whole_life("room-buckets", (vit_open_info){.device = VIT_DEVICE_HOST, .profile = 1, .count_work = 1}), 0);
    assert_int_equal(calls_of_a_whole_life("basis-shine", (vit_open_info){.device = VIT_DEVICE_HOST, .count_work = 1}), 0);
}

static void nothing_is_allocated_when_the_caller_lends_the_framebuffer(void **state) {
    (void)state;
    static _Alignas(64) uint8_t lent[64 * 512]; /* 96 x 64 pixels */
    const vit_open_info how = {.framebuffer = lent, .framebuffer_pitch = 512, .framebuffer_size = sizeof lent};
    assert_int_equal(calls_of_a_whole_life("room", how), 0);
    vit_open_info host = how;
    host.device = VIT_DEVICE_HOST;
    assert_int_equal(calls_of_a_whole_life("room", host), 0);
}

static void nothing_is_allocated_when_passes_are_timed_or_bounds_are_too_small(void **state) {
    (void)state;
    assert_int_equal(calls_of_a_whole_life("room", (vit_open_info){.profile = 1}), 0);
    assert_int_equal(calls_of_a_whole_life("room", (vit_open_info){.max_nodes = 3, .max_list = 1}), 0);
}

static void a_pack_is_refused_without_allocation(void **state) {
    (void)state;
    static _Alignas(8) const char nothing[64] = "VITRINE";
    vit_requirements need;
    vit_text why;
    calls = 0;
    const vit_status status = vit_require(&(vit_open_info){.pack = nothing, .pack_size = sizeof nothing}, &need, &why);
    assert_int_equal(calls, 0);
    assert_int_equal(status, VIT_BAD_INPUT);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_librarys_objects_name_nothing_that_allocates_opens_or_prints),
        cmocka_unit_test(a_call_of_a_forbidden_function_is_counted),
        cmocka_unit_test(nothing_is_allocated_opened_or_printed_from_open_to_close),
        cmocka_unit_test(the_device_host_takes_all_its_memory_from_the_caller),
        cmocka_unit_test(nothing_is_allocated_when_the_caller_lends_the_framebuffer),
        cmocka_unit_test(nothing_is_allocated_when_passes_are_timed_or_bounds_are_too_small),
        cmocka_unit_test(a_pack_is_refused_without_allocation),
    };
    return cmocka_run_group_tests_name("no allocation", tests, NULL, NULL);
}
