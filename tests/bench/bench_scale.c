/* What the bake of indirect light takes over how fine it is: CPU seconds and peak memory of vitrine-bake on the Cornell box,
 * with live radiosity over the number of patches, with baked irradiance over the number of receivers; and the exponents that
 * fit the three largest. Less what the same bake takes without indirect light. Verified: each pack has what was asked for.
 *
 * bench_scale [MOST]: patches at most; 4096 unless stated, since 16 384 take most of an hour. */
#define _DEFAULT_SOURCE /* wait4() */
#include "../pack_sections.h"
#include "scenes.h"
#include "variant.h"
#include <sys/resource.h>

enum { LEAST_PATCHES = 256, SMOKE_PATCHES = 32, USUAL_PATCHES = 4096, SPACINGS = 5, FITTED = 3, MOST_STEPS = 16 };

typedef struct step {
    double count, seconds, bytes; /* patches or receivers; CPU; peak of the process */
} step;

/* Bakes, and says what that took and what came of it. */
static step bake(const char *method, const char *option, const char *value, vit_scene *out) {
    char baker[] = VIT_BUILD_DIR "/vitrine-bake", scene[] = VIT_BUILD_DIR "/scenes/cornell.cfg", to[] = "-o", pack[128];
    char quiet[] = "--quiet", no_check[] = "--no-check", indirect[] = "--indirect", of[16], size[] = "--size=160x160";
    char frames[] = "--frames=2", name[32], with[32], rays[] = "--receiver-rays=64";
    snprintf(pack, sizeof pack, "%s/scale.vit", bench_results());
    snprintf(of, sizeof of, "%s", method);
    snprintf(name, sizeof name, "%s", option);
    snprintf(with, sizeof with, "%s", value);
    char *const argv[] = {baker, scene, to, pack, quiet, no_check, indirect, of, size, frames, rays, name, with, NULL};
    fflush(NULL);
    const pid_t pid = fork();
    if (pid < 0)
        bench_fail("fork: %s", strerror(errno));
    if (pid == 0)
        child_become(argv, -1, NULL);
    struct rusage u;
    int status;
    if (wait4(pid, &status, 0, &u) != pid || !WIFEXITED(status) || WEXITSTATUS(status) != 0)
        bench_fail("vitrine-bake failed");
    pack_image image = image_load(pack);
    *out = *(const vit_scene *)pack_sections_of(image.bytes).data[VIT_SECTION_META];
    image_free(&image);
    return (step){.seconds = (double)(u.ru_utime.tv_sec + u.ru_stime.tv_sec) +
                             1e-6 * (double)(u.ru_utime.tv_usec + u.ru_stime.tv_usec),
                  .bytes = 1024.0 * (double)u.ru_maxrss};
}

/* Of seconds, or bytes, of the largest. */
static double fitted(const step *s, int count, bool bytes) {
    double x[FITTED] = {0}, y[FITTED] = {0};
    const int n = count < FITTED ? count : FITTED;
    for (int i = 0; i < n; i++) {
        const step *of = s + count - n + i;
        x[i] = of->count;
        y[i] = bytes ? of->bytes : of->seconds;
    }
    return n > 1 ? bench_exponent(x, y, n) : 0;
}

static void put(csv *c, const char *what, const step *s, int count) {
    printf("\n%-10s %10s %10s\n", what, "CPU s", "MB");
    for (int i = 0; i < count; i++) {
        char of[64];
        const series seconds = series_exact(s[i].seconds), bytes = series_exact(s[i].bytes);
        printf("%-10.0f %10.2f %10.1f\n", s[i].count, s[i].seconds, s[i].bytes * 1e-6);
        snprintf(of, sizeof of, "%.0f %s", s[i].count, what);
        csv_row(c, "cornell", "160x160", of, &seconds, "s");
        csv_row(c, "cornell", "160x160", of, &bytes, "B");
    }
    const series of_time = series_exact(fitted(s, count, false)), of_memory = series_exact(fitted(s, count, true));
    printf("exponent   %10.2f %10.2f   of the last %d\n", of_time.value[0], of_memory.value[0],
           count < FITTED ? count : FITTED);
    csv_row(c, what, "160x160", "exponent of CPU seconds", &of_time, "1");
    csv_row(c, what, "160x160", "exponent of memory", &of_memory, "1");
}

/* Without what the bake takes anyway. */
static void note(step *s, step found, double count, const step *without) {
    found.count = count;
    found.seconds = fmax(found.seconds - without->seconds, 1e-3);
    found.bytes = fmax(found.bytes - without->bytes, 1.0);
    *s = found;
}

int main(int argc, char **argv) {
    csv c = csv_open("scale");
    step of_patches[MOST_STEPS], of_receivers[SPACINGS];
    vit_scene scene;
    int count = 0;
    const int least = bench_smoke() ? SMOKE_PATCHES : LEAST_PATCHES, most = argc > 1        ? atoi(argv[1])
                                                                            : bench_smoke() ? least
                                                                                            : USUAL_PATCHES;
    const step without = bake("photons", "--photons", "0", &scene);
    if (scene.effects & VIT_BIT(INDIRECT))
        bench_fail("without photons there is indirect light");
    for (int n = least; n <= most && count < MOST_STEPS; n *= 2, count++) {
        char number[16];
        snprintf(number, sizeof number, "%d", n);
        const step found = bake("radiosity", "--patches", number, &scene);
        if (scene.patches == 0 || scene.patches > (vit_u32)n)
            bench_fail("%u patches instead of %d", scene.patches, n);
        note(of_patches + count, found, scene.patches, &without);
    }
    put(&c, "patches", of_patches, count);
    static const char *const spacings[SPACINGS] = {"16", "8", "4", "2", "1"};
    const int spacing_count = bench_smoke() ? 1 : SPACINGS;
    for (int i = 0; i < spacing_count; i++) {
        const step found = bake("basis", "--receiver-spacing", spacings[i], &scene);
        if (scene.receivers == 0)
            bench_fail("there are no receivers");
        note(of_receivers + i, found, scene.receivers, &without);
    }
    put(&c, "receivers", of_receivers, spacing_count);
    csv_close(&c, "scale");
    return VIT_OK;
}
