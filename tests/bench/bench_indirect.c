/* How right indirect light is where nobody tuned: scenes that no constant of the baker was chosen on, by the methods and at the
 * settings that a user gets who says nothing, against path tracing.
 *
 * Each method's pack is baked by vitrine-bake without its check, played on the device host, and compared with the reference:
 * its indirect light with that of all reflections, and of as many as the default of `bounces` lets photons have; the whole
 * picture with the whole. In build/bench/indirect/ a picture a scene: above the reference and each method's indirect light at
 * one exposure, below what is too much (bright) or too little (dark); and each method's at every pixel.
 *
 * bench_indirect [SCENE...]; METHODS="basis photons basis+receiver-rays=2048" says which methods, `+` before each further
 * option of the baker; WORST=3: how many bad pixels are printed. */
#include "indirect_truth.h"
#include "../pack_sections.h"
#include "variant.h"

#include "cost/images.h"
#include <sys/resource.h>

enum { METHODS_MOST = 8, OPTIONS_MOST = 15 };

typedef struct method {
    const char *name;                     /* as METHODS has it */
    double cpu;                           /* seconds of the bake */
    size_t bytes;                         /* of the pack */
    float *light, *picture, *every_pixel; /* indirect, all light on the reference's grid; indirect */
} method;

typedef struct trial {
    const untuned_scene *scene;
    const char *size;
    method methods[METHODS_MOST];
    size_t count;
    truth truth;
} trial;

static double children_seconds(void) {
    struct rusage u;
    getrusage(RUSAGE_CHILDREN, &u);
    return (double)(u.ru_utime.tv_sec + u.ru_stime.tv_sec) + 1e-6 * (double)(u.ru_utime.tv_usec + u.ru_stime.tv_usec);
}

/* Bakes the scene's pack by the method: `--indirect NAME`, and an option for each +NAME=VALUE. */
static pack_image bake(const untuned_scene *s, method *m) {
    char scene[BENCH_PATH], pack[BENCH_PATH], words[256], options[OPTIONS_MOST][64], baker[] = VIT_BUILD_DIR "/vitrine-bake";
    char to[] = "-o", quiet[] = "--quiet", no_check[] = "--no-check", indirect[] = "--indirect", *rest = NULL, *word;
    untuned_path(scene, s->name, ".cfg");
    untuned_path(pack, s->name, ".vit");
    snprintf(words, sizeof words, "%s", m->name);
    char *argv[OPTIONS_MOST + 9] = {baker, scene, to, pack, quiet, no_check, indirect, strtok_r(words, "+", &rest)};
    for (size_t i = 0; (word = strtok_r(NULL, "+", &rest)) != NULL; i++) {
        if (i == OPTIONS_MOST)
            bench_fail("METHODS: too many options: %s", m->name);
        snprintf(options[i], sizeof options[i], "--%.60s", word);
        argv[8 + i] = options[i];
    }
    const double before = children_seconds();
    child_run(argv, NULL, false);
    m->cpu = children_seconds() - before;
    const pack_image image = image_load(pack);
    m->bytes = image.size;
    return image;
}

static float *play(const pack_image *pack, vit_view view, uint32_t frame, const images_grid *g) {
    const vit_open_info how = {.pack = pack->bytes, .pack_size = pack->size, .device = VIT_DEVICE_HOST, .view = view};
    float *out = bench_array((size_t)images_across(g) * images_down(g) * 3, sizeof *out);
    vit_text why;
    if (images_render(&how, frame, g, out, NULL, &why) != VIT_OK)
        bench_fail("%s", why.text);
    return out;
}

static void print_verdict(csv *c, const trial *t, const method *m, int part) {
    static const char *const kinds[TRUTH_PARTS] = {"all", "as", "sum"}, *const of[TRUTH_PARTS] = {
                                                                            "indirect light",
                                                                            "indirect light, as many reflections", "all light"};
    const verdict v = truth_compare(&t->truth, part, part == PICTURE ? m->picture : m->light);
    const struct {
        const char *what;
        double value;
    } rows[] = {{"flux red", v.flux[0]}, {"flux green", v.flux[1]}, {"flux blue", v.flux[2]}, {"dark half", v.dark},
                {"NMSE", v.nmse},        {"relMSE", v.relmse},      {"own NMSE", v.noise[0]}, {"own relMSE", v.noise[1]}};
    if (!isfinite(v.nmse) || !isfinite(v.flux[0]))
        bench_fail("%s, %s: the light is no number", t->scene->name, m->name);
    printf("%-9s %-24s %-4s %6.3f %6.3f %6.3f %6.3f  %8.4f %8.4f  %7.4f %7.4f", t->scene->name, m->name, kinds[part], v.flux[0],
           v.flux[1], v.flux[2], v.dark, v.nmse, v.relmse, v.noise[0], v.noise[1]);
    if (part == ALL)
        printf(" %8.2f %8.3f", m->cpu, (double)m->bytes * 1e-6);
    printf("\n");
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        char what[128];
        const series s = series_exact(rows[i].value);
        snprintf(what, sizeof what, "%s: %s: %s", m->name, of[part], rows[i].what);
        csv_row(c, t->scene->name, t->size, what, &s, "1");
    }
}

static void print_method(csv *c, const trial *t, const method *m) {
    const char *worst = getenv("WORST");
    char what[128];
    for (int part = 0; part < TRUTH_PARTS; part++)
        print_verdict(c, t, m, part);
    truth_print_worst(&t->truth, m->light, t->scene->every, worst ? atoi(worst) : 3);
    const series cpu = series_exact(m->cpu), bytes = series_exact((double)m->bytes);
    snprintf(what, sizeof what, "%s: bake, CPU", m->name);
    csv_row(c, t->scene->name, t->size, what, &cpu, "s");
    snprintf(what, sizeof what, "%s: pack", m->name);
    csv_row(c, t->scene->name, t->size, what, &bytes, "B");
}

static int shade(double linear) {
    const double c = linear < 0 ? 0 : linear > 1 ? 1 : linear;
    return (int)(255 * (c <= 0.0031308 ? 12.92 * c : 1.055 * pow(c, 1 / 2.4) - 0.055) + 0.5);
}

/* Above: light at one exposure, the reference first. Below: differences over the mean, 0 as grey, the first all grey. */
static void write_pictures(const trial *t) {
    FILE *f = untuned_create(t->scene->name, ".ppm");
    const truth_part *p = &t->truth.part[ALL];
    const size_t w = t->truth.r.width, h = t->truth.r.height;
    fprintf(f, "P6\n%zu %zu\n255\n", w * (t->count + 1), 2 * h);
    for (size_t y = 0; y < 2 * h; y++)
        for (size_t x = 0; x < w * (t->count + 1); x++)
            for (size_t k = 0; k < 3; k++) {
                const size_t at = 3 * (y % h * w + x % w) + k;
                const double right = p->light[at], got = x < w ? right : (double)t->methods[x / w - 1].light[at];
                const double off = fmin(fmax((got - right) / p->mean, -1), 1);
                fputc(y < h ? shade(0.25 * got / p->mean) : (int)(127.5 + 127.5 * off), f);
            }
    fclose(f);
}

static void write_every_pixel(const trial *t, const method *m, const images_grid *g) {
    char name[256];
    snprintf(name, sizeof name, "%s-%s", t->scene->name, m->name);
    FILE *f = untuned_create(name, ".ppm");
    fprintf(f, "P6\n%u %u\n255\n", g->width, g->height);
    for (size_t i = 0; i < 3 * (size_t)g->width * g->height; i++)
        fputc(shade(0.25 * (double)m->every_pixel[i] / t->truth.part[ALL].mean), f);
    fclose(f);
}

/* Packs are played as soon as they are baked; all have the reference's scene. */
static void run(csv *c, trial *t) {
    const untuned_scene *s = t->scene;
    const uint32_t frame = s->frames - 1;
    char folder[BENCH_PATH];
    images_grid grid = {.every = 1};
    pack_image image = {0};
    if (!untuned_write(s, t->size))
        return;
    for (size_t i = 0; i < t->count; i++) {
        method *m = t->methods + i;
        image_free(&image);
        image = bake(s, m);
        const vit_scene *meta = pack_sections_of(image.bytes).data[VIT_SECTION_META];
        grid = (images_grid){meta->width, meta->height, 1};
        m->every_pixel = play(&image, VIT_VIEW_indirect, frame, &grid);
        grid.every = s->every;
        m->light = play(&image, VIT_VIEW_indirect, frame, &grid);
        m->picture = play(&image, VIT_VIEW_final, frame, &grid);
    }
    const pack_sections sections = pack_sections_of(image.bytes);
    untuned_path(folder, "", "");
    reference_input in = {.sections = &sections, .frame = frame, .every = s->every, .cache = folder};
    truth_trace(&in, bench_smoke() ? 0.2 : s->seconds, &t->truth);
    for (size_t i = 0; i < t->count; i++) {
        print_method(c, t, t->methods + i);
        write_every_pixel(t, t->methods + i, &grid);
    }
    write_pictures(t);
    fflush(stdout);
    for (size_t i = 0; i < t->count; i++) {
        free(t->methods[i].light);
        free(t->methods[i].picture);
        free(t->methods[i].every_pixel);
    }
    truth_free(&t->truth);
    image_free(&image);
}

static bool asked_for(const untuned_scene *s, int argc, char **argv) {
    for (int i = 1; i < argc; i++)
        if (strcmp(argv[i], s->name) == 0)
            return true;
    return argc == 1 && (s->smoke || !bench_smoke());
}

int main(int argc, char **argv) {
    char words[256], *rest = NULL;
    const char *given = getenv("METHODS");
    trial t = {.size = bench_smoke() ? "48x36" : "192x144"};
    snprintf(words, sizeof words, "%s", given ? given : "basis photons");
    for (char *word = strtok_r(words, " ", &rest); word && t.count < METHODS_MOST; word = strtok_r(NULL, " ", &rest))
        t.methods[t.count++].name = word;
    csv c = csv_open("indirect");
    printf(
        "all: indirect light of all reflections; as: of %u bounces, as photons' default; sum: with direct light. NMSE and relMSE "
        "are less the reference's own\n%-9s %-24s %-4s %6s %6s %6s %6s  %8s %8s  %7s %7s %8s %8s\n",
        TRUTH_BOUNCES, "", "", "", "red", "green", "blue", "dark", "NMSE", "relMSE", "own", "own", "bake s", "MB");
    for (size_t i = 0; i < UNTUNED_SCENES; i++)
        if (asked_for(untuned_scenes + i, argc, argv)) {
            t.scene = untuned_scenes + i;
            run(&c, &t);
        }
    csv_close(&c, "indirect");
    return VIT_OK;
}
