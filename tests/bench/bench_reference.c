/* The path tracer that references are made with: rays per second, and seconds until a picture's standard error is small enough.
 * Also what one path a pixel costs and how wrong it is: the rival at equal error. On every fourth pixel of 1280 x 720, that is
 * 320 x 180. */
#include "../pack_sections.h"
#include "reference/reference.h"
#include "scenes.h"

#define EVERY 4u
#define FRAMES 9u /* of one path a pixel */

static void *load(const char *path) {
    struct stat s;
    FILE *f = fopen(path, "rb");
    if (!f || fstat(fileno(f), &s) != 0)
        bench_fail("%s: %s", path, strerror(errno));
    void *bytes = bench_array((size_t)s.st_size, 1);
    if (fread(bytes, 1, (size_t)s.st_size, f) != (size_t)s.st_size)
        bench_fail("%s: cannot be read", path);
    fclose(f);
    return bytes;
}

static void row(csv *c, const char *scene, const char *what, double value, const char *unit) {
    const series s = series_exact(value);
    printf("%-8s %-44s %12.4g %s\n", scene, what, value, unit);
    csv_row(c, scene, "320x180", what, &s, unit);
}

static void run(csv *c, const char *scene, const char *path) {
    static const double usual[] = {0.002, 0.0005}, smoke[] = {0.5, 0.2};
    const double *targets = bench_smoke() ? smoke : usual;
    void *pack = load(path);
    const pack_sections sections = pack_sections_of(pack);
    const vit_scene *meta = sections.data[VIT_SECTION_META];
    reference_input in = {.sections = &sections, .every = EVERY, .bounces = meta->bounces, .max_samples = 1u << 16};
    vit_text why;
    reference r = {0};
    reference_timing t;
    for (size_t i = 0; i < sizeof usual / sizeof *usual; i++) {
        char what[64];
        reference_free(&r);
        in.target = targets[i];
        if (reference_render(&in, &r, &why) != VIT_OK)
            bench_fail("%s", why.text);
        snprintf(what, sizeof what, "seconds to NMSE %g (%u paths a pixel)", targets[i], r.samples);
        row(c, scene, what, r.seconds, "s");
    }
    row(c, scene, "paths, reflections without end", (double)r.samples * r.width * r.height / r.seconds * 1e-6, "M/s");
    row(c, scene, "rays", (double)r.rays / r.seconds * 1e-6, "M/s");
    if (reference_time(&in, &r, FRAMES, &t, &why) != VIT_OK)
        bench_fail("%s", why.text);
    row(c, scene, "one path a pixel of 1280x720", t.ms, "ms");
    row(c, scene, "its rays", (double)t.rays / t.ms * 1e-3, "M/s");
    row(c, scene, "its NMSE", t.nmse, "1");
    row(c, scene, "its relMSE", t.relmse, "1");
    reference_free(&r);
    free(pack);
}

int main(void) {
    csv c = csv_open("reference");
    for (size_t i = 0; i < BENCH_SCENES; i++) {
        char pack[BENCH_PATH];
        if (scene_pack(&bench_scenes[i], bench_size(0), pack))
            run(&c, bench_scenes[i].name, pack);
    }
    csv_close(&c, "reference");
    return VIT_OK;
}
