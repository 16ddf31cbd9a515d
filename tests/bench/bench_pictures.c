/* Pictures of one frame, to look at: our demo and the Cornell box by the path tracer, by photons in lists and in buckets, by
 * live radiosity and by the basis, side by side in build/bench/indirect/pictures-NAME.ppm: all light, indirect light, and
 * what is too much (bright) or too little (dark) of it, over the mean. Printed: flux, NMSE and relMSE of indirect light.
 *
 * bench_pictures [SCENE...]; EVERY=4: every fourth pixel each way; SECONDS=120: for the path tracer. */
#include "indirect_methods.h"
#include "indirect_truth.h"
#include "makers.h"

enum { LISTS = 0, BUCKETS, LIVE, BAKED, METHODS };
static const char *const method_names[METHODS] = {"list", "buckets", "radiosity", "basis"};
static const int made_by[METHODS] = {PHOTONS, PHOTONS, RADIOSITY, BASIS};

typedef struct gallery {
    const maker_scene *scene;
    truth truth;
    float *light[METHODS], *picture[METHODS];
} gallery;

static int number(const char *name, int usual) {
    const char *given = getenv(name);
    const int n = given ? atoi(given) : usual;
    return n > 0 ? n : usual;
}

/* Value k of a row of pictures; column 0 is the path tracer's. */
static int value(const gallery *g, int row, int column, size_t k) {
    const truth_part *part = &g->truth.part[row == 0 ? PICTURE : ALL];
    const double right = part->light[k];
    const double got = column == 0 ? right : (double)(row == 0 ? g->picture : g->light)[column - 1][k];
    if (row < 2)
        return truth_shade((row == 0 ? 0.18 : 0.25) * got / part->mean);
    return (int)(127.5 + 127.5 * fmin(fmax((got - right) / part->mean, -1), 1));
}

static void write_pictures(const gallery *g) {
    char name[64];
    const size_t w = g->truth.r.width, h = g->truth.r.height;
    snprintf(name, sizeof name, "pictures-%s", g->scene->name);
    FILE *f = untuned_create(name, ".ppm");
    fprintf(f, "P6\n%zu %zu\n255\n", w * (METHODS + 1), 3 * h);
    for (size_t y = 0; y < 3 * h; y++)
        for (size_t x = 0; x < w * (METHODS + 1); x++)
            for (size_t k = 0; k < 3; k++)
                fputc(value(g, (int)(y / h), (int)(x / w), 3 * (y % h * w + x % w) + k), f);
    if (fclose(f) != 0)
        bench_fail("pictures of %s: %s", g->scene->name, strerror(errno));
}

static void trace(gallery *g, const pack_image *image, uint32_t frame, uint32_t every) {
    char folder[BENCH_PATH];
    const pack_sections sections = pack_sections_of(image->bytes);
    untuned_path(folder, "", "");
    bench_folder(folder);
    reference_input in = {.sections = &sections, .frame = frame, .every = every, .cache = folder};
    truth_trace(&in, TRUTH_NOISE, bench_smoke() ? 0.2 : number("SECONDS", 120), &g->truth);
}

static void render(gallery *g, int m, const pack_image *image, uint32_t frame, const images_grid *grid) {
    const variant buckets = {.estimate = VIT_BIT(BUCKETS)};
    pack_image own = m == BUCKETS ? image_variant(image, &buckets) : *image;
    g->light[m] = method_play(&own, VIT_VIEW_indirect, frame, grid);
    g->picture[m] = method_play(&own, VIT_VIEW_final, frame, grid);
    if (m == BUCKETS)
        image_free(&own);
}

static void report(csv *out, const gallery *g, int m) {
    const verdict v = truth_compare(&g->truth, ALL, g->light[m]);
    const struct {
        const char *what;
        double value;
    } rows[] = {
        {"flux red", v.flux[0]}, {"flux green", v.flux[1]}, {"flux blue", v.flux[2]}, {"NMSE", v.nmse}, {"relMSE", v.relmse}};
    if (!isfinite(v.nmse) || !isfinite(v.flux[0]))
        bench_fail("%s, %s: the light is no number", g->scene->name, method_names[m]);
    printf("%-8s %-10s flux %.3f %.3f %.3f  NMSE %.4f  relMSE %.4f  (own %.4f, %.4f)\n", g->scene->name, method_names[m],
           v.flux[0], v.flux[1], v.flux[2], v.nmse, v.relmse, v.noise[0], v.noise[1]);
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        char what[64];
        const series s = series_exact(rows[i].value);
        snprintf(what, sizeof what, "%s: %s", method_names[m], rows[i].what);
        csv_row(out, g->scene->name, maker_size(g->scene), what, &s, "1");
    }
}

static void show(csv *out, const maker_scene *s) {
    gallery g = {.scene = s};
    const uint32_t every = (uint32_t)number("EVERY", bench_smoke() ? 4 : 2);
    for (int m = 0; m < METHODS; m++) {
        pack_image image = maker_pack(s, made_by[m]);
        const vit_scene *meta = pack_sections_of(image.bytes).data[VIT_SECTION_META];
        const uint32_t frame = meta->frames * 5 / 12;
        const images_grid grid = {meta->width, meta->height, every};
        if (m == 0)
            trace(&g, &image, frame, every);
        render(&g, m, &image, frame, &grid);
        report(out, &g, m);
        image_free(&image);
    }
    write_pictures(&g);
    for (int m = 0; m < METHODS; m++) {
        free(g.light[m]);
        free(g.picture[m]);
    }
    truth_free(&g.truth);
}

int main(int argc, char **argv) {
    csv out = csv_open("pictures");
    for (size_t i = 0; i < MAKER_SCENES; i++)
        if (maker_asked_for(&maker_scenes[i], argc, argv))
            show(&out, &maker_scenes[i]);
    csv_close(&out, "pictures");
    return VIT_OK;
}
