/* Sides that light can reach: seconds of CPU, all threads, and rays over the number of triangles, the exponent that fits the
 * seconds (1 is linear) and the memory of the process at its most. Only dark_sides_find() is timed. Argument: the most
 * triangles, default 5 million. */
#include "dark_sides/dark_sides.h"
#include "dark_side_models.h"
#include <sys/resource.h>

#define LEAST 10000u
#define MOST 5000000u
#define SIZES 12

static struct rusage usage(void) {
    struct rusage r;
    if (getrusage(RUSAGE_SELF, &r) != 0)
        bench_fail("getrusage");
    return r;
}

static double cpu_seconds(void) {
    const struct rusage r = usage();
    return (double)(r.ru_utime.tv_sec + r.ru_stime.tv_sec) + 1e-6 * (double)(r.ru_utime.tv_usec + r.ru_stime.tv_usec);
}

/* Its `seconds` become those of CPU: other processes do not count. */
static dark_sides measure(bool balls, uint32_t triangles, uint32_t *made) {
    reach_model r;
    bvh b;
    geometry g;
    dark_sides found;
    vit_text why = {""};
    reach_model_make(&r, balls, triangles);
    if (bvh_build(&r.m, 0, &b, &why) != VIT_OK || geometry_pack(&r.m, &b, &g, &why) != VIT_OK)
        bench_fail("%s", why.text);
    const double start = cpu_seconds();
    if (dark_sides_find(&(const dark_sides_input){.model = &r.m, .tracks = &r.t, .frames = DARK_SIDES_FRAMES}, &g, &found,
                        &why) != VIT_OK)
        bench_fail("%s", why.text);
    found.seconds = cpu_seconds() - start;
    *made = r.m.triangles;
    if (!(found.dark_front + found.dark_back > 0.3 * found.area)) /* backs, at least */
        bench_fail("%u triangles: hardly anything is dark", r.m.triangles);
    geometry_free(&g);
    bvh_free(&b);
    reach_model_close(&r);
    return found;
}

static void measure_all(csv *c, bool balls, uint32_t most) {
    const char *name = balls ? "balls" : "parts";
    double triangles[SIZES], seconds[SIZES];
    int count = 0;
    for (uint32_t want = LEAST; want <= most && count < SIZES;
         want = want < most && 3 * (uint64_t)want > most ? most : 3 * want) {
        uint32_t made;
        char size[16];
        const dark_sides found = measure(balls, want, &made);
        const series s = series_exact(found.seconds), rays = series_exact((double)found.rays / (2.0 * made));
        (void)snprintf(size, sizeof size, "%u", made);
        csv_row(c, name, size, "seconds", &s, "s");
        csv_row(c, name, size, "rays a side", &rays, "1");
        printf("%-6s %8u triangles  %8.2f s  %6.1f rays a side  %5.1f %% dark  %5ld MB\n", name, made, found.seconds,
               rays.value[0], 100.0 * (found.dark_front + found.dark_back) / found.area, usage().ru_maxrss / 1024);
        triangles[count] = made;
        seconds[count++] = found.seconds;
    }
    const int from = count > 3 ? count - 3 : 0; /* small ones are mostly light rays, whose number is given */
    if (count - from >= 2) {
        const series slope = series_exact(bench_exponent(triangles + from, seconds + from, count - from));
        csv_row(c, name, "", "exponent of the largest three", &slope, "1");
        printf("%-6s seconds ~ triangles^%.2f over the largest %d\n", name, slope.value[0], count - from);
    }
}

int main(int argc, char **argv) {
    const unsigned long most = argc > 1 ? strtoul(argv[1], NULL, 10) : bench_smoke() ? 3ul * LEAST : MOST;
    csv c = csv_open("reach");
    measure_all(&c, false, (uint32_t)most);
    measure_all(&c, true, (uint32_t)most);
    csv_close(&c, "reach");
    return VIT_OK;
}
