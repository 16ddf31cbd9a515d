/* How right indirect light is where nobody tuned: scenes that no constant of the baker was chosen on, by the methods and at the
 * settings that a user gets who says nothing, against path tracing; and how still it is where nothing moves
 * (indirect_motion.h).
 *
 * Each method's pack is baked by vitrine-bake without its check, played on the device host, and compared with the reference:
 * its indirect light with that of all reflections, and of as many as the default of `bounces` lets photons have; the whole
 * picture with the whole. In build/bench/indirect/ a picture a scene: above the reference and each method's indirect light at
 * one exposure, below what is too much (bright) or too little (dark); and each method's at every pixel.
 *
 * bench_indirect [SCENE...]; METHODS="basis photons basis+receiver-rays=2048" says which methods, `+` before each further
 * option of the baker; WORST=3: how many bad pixels are printed. */
#include "indirect_motion.h"

/* Of the pixels along an edge, one in so many has the reference. */
enum { STILL_EVERY = 2, MOTION_EVERY = 8 };

typedef struct trial {
    const untuned_scene *scene;
    const char *size;
    method methods[METHODS_MOST];
    size_t count;
    truth truth;
    uint32_t every;
    csv *csv;
} trial;

static void put_row(const trial *t, const method *m, const char *what, double value, const char *unit) {
    char of[128];
    const series s = series_exact(value);
    snprintf(of, sizeof of, "%s: %s", m->name, what);
    csv_row(t->csv, t->scene->name, t->size, of, &s, unit);
}

static void print_verdict(const trial *t, const method *m, int part) {
    static const char *const kinds[TRUTH_PARTS] = {"all", "as", "sum", "dir"}, *const of[TRUTH_PARTS] = {
                                                                                   "indirect light",
                                                                                   "indirect light, as many reflections",
                                                                                   "all light", "direct light"};
    const float *const light[TRUTH_PARTS] = {m->light, m->light, m->picture, m->direct};
    const verdict v = truth_compare(&t->truth, part, light[part]);
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
        char what[96];
        snprintf(what, sizeof what, "%s: %s", of[part], rows[i].what);
        put_row(t, m, what, rows[i].value, "1");
    }
}

static void print_method(const trial *t, const method *m) {
    const char *worst = getenv("WORST");
    for (int part = 0; part < TRUTH_PARTS; part++)
        print_verdict(t, m, part);
    truth_print_worst(&t->truth, m->light, t->every, worst ? atoi(worst) : 3);
    put_row(t, m, "bake, CPU", m->cpu, "s");
    put_row(t, m, "pack", (double)m->bytes, "B");
}

/* Above: light at one exposure, the reference first. Below: differences over the mean, 0 as grey, the first all grey. */
static void write_pictures(const trial *t, int part, const char *ending) {
    FILE *f = untuned_create(t->scene->name, ending);
    const truth_part *p = &t->truth.part[part];
    const size_t w = t->truth.r.width, h = t->truth.r.height;
    fprintf(f, "P6\n%zu %zu\n255\n", w * (t->count + 1), 2 * h);
    for (size_t y = 0; y < 2 * h; y++)
        for (size_t x = 0; x < w * (t->count + 1); x++)
            for (size_t k = 0; k < 3; k++) {
                const size_t at = 3 * (y % h * w + x % w) + k;
                const double right = p->light[at], got = x < w ? right
                                                               : (double)(part == DIRECT ? t->methods[x / w - 1].direct
                                                                                         : t->methods[x / w - 1].light)[at];
                const double off = fmin(fmax((got - right) / p->mean, -1), 1);
                fputc(y < h ? truth_shade(0.25 * got / p->mean) : (int)(127.5 + 127.5 * off), f);
            }
    fclose(f);
}

static void write_every_pixel(const trial *t, const method *m, const images_grid *g) {
    char name[256];
    snprintf(name, sizeof name, "%s-%s", t->scene->name, m->name);
    FILE *f = untuned_create(name, ".ppm");
    fprintf(f, "P6\n%u %u\n255\n", g->width, g->height);
    for (size_t i = 0; i < 3 * (size_t)g->width * g->height; i++)
        fputc(truth_shade(0.25 * (double)m->every_pixel[i] / t->truth.part[ALL].mean), f);
    fclose(f);
}

static images_grid grid_of(const pack_image *image, uint32_t every) {
    const vit_scene *meta = pack_sections_of(image->bytes).data[VIT_SECTION_META];
    return (images_grid){meta->width, meta->height, every};
}

/* The path tracer's picture of a frame of the pack, whatever method that is by. */
static void trace(const trial *t, const pack_image *image, uint32_t frame, double noise, truth *out) {
    const pack_sections sections = pack_sections_of(image->bytes);
    char folder[BENCH_PATH];
    untuned_path(folder, "", "");
    reference_input in = {.sections = &sections, .frame = frame, .every = t->every, .cache = folder};
    truth_trace(&in, noise, bench_smoke() ? 0.2 : t->scene->seconds, out);
}

static void run(trial *t) {
    const untuned_scene *s = t->scene;
    const uint32_t frame = s->frames - 1;
    images_grid all = {0}, grid = {0};
    pack_image image = {0};
    for (size_t i = 0; i < t->count; i++) {
        method *m = t->methods + i;
        image_free(&image);
        image = method_bake(s, m);
        all = grid_of(&image, 1);
        grid = grid_of(&image, t->every);
        m->every_pixel = method_play(&image, VIT_VIEW_indirect, frame, &all);
        m->light = method_play(&image, VIT_VIEW_indirect, frame, &grid);
        m->picture = method_play(&image, VIT_VIEW_final, frame, &grid);
        m->direct = method_play(&image, VIT_VIEW_direct, frame, &grid);
    }
    trace(t, &image, frame, TRUTH_NOISE, &t->truth);
    for (size_t i = 0; i < t->count; i++) {
        print_method(t, t->methods + i);
        write_every_pixel(t, t->methods + i, &all);
    }
    write_pictures(t, ALL, ".ppm");
    write_pictures(t, DIRECT, "-direct.ppm");
    for (size_t i = 0; i < t->count; i++) {
        free(t->methods[i].light);
        free(t->methods[i].picture);
        free(t->methods[i].direct);
        free(t->methods[i].every_pixel);
    }
    truth_free(&t->truth);
    image_free(&image);
}

/* Where a light moves, which takes a reference; the same for all methods. */
static void print_change(const trial *t, const method *m, const pack_image *image, const truth truths[2]) {
    const images_grid grid = grid_of(image, t->every);
    float *first = method_play(image, VIT_VIEW_indirect, 0, &grid);
    float *last = method_play(image, VIT_VIEW_indirect, t->scene->frames - 1, &grid);
    const change all = change_of(first, last, truths, ALL), as = change_of(first, last, truths, LIMITED);
    printf(" %8.2f %8.2f %8.2f", 100 * all.error, 100 * as.error, 100 * all.own);
    put_row(t, m, "change, indirect light", 100 * all.error, "%");
    put_row(t, m, "change, as many reflections", 100 * as.error, "%");
    put_row(t, m, "change, own", 100 * all.own, "%");
    free(first);
    free(last);
}

static void run_motion(trial *t) {
    truth truths[2] = {{.sum = NULL}};
    for (size_t i = 0; i < t->count; i++) {
        method *m = t->methods + i;
        pack_image image = method_bake(t->scene, m);
        const stillness v = stillness_of(&image, t->scene->frames);
        printf("%-15s %-24s %7.3f", t->scene->name, m->name, 100 * v.noise);
        put_row(t, m, "noise", 100 * v.noise, "%");
        if (!(t->scene->seconds > 0)) {
            printf(" %7.3f %7.2f", 100 * v.step, 100 * v.largest);
            put_row(t, m, "step", 100 * v.step, "%");
            put_row(t, m, "largest step", 100 * v.largest, "%");
        } else
            printf(" %7s %7s", "", "");
        printf(" %7.1f", 100 * v.used);
        for (uint32_t k = 0; k < 2 && i == 0 && t->scene->seconds > 0; k++)
            trace(t, &image, k * (t->scene->frames - 1), MOTION_NOISE, truths + k);
        if (t->scene->seconds > 0)
            print_change(t, m, &image, truths);
        printf("\n");
        fflush(stdout);
        image_free(&image);
    }
    truth_free(&truths[0]);
    truth_free(&truths[1]);
}

static bool asked_for(const untuned_scene *s, int argc, char **argv) {
    for (int i = 1; i < argc; i++)
        if (strcmp(argv[i], s->name) == 0)
            return true;
    return argc == 1 && (s->smoke || !bench_smoke());
}

static void run_each(trial *t, int argc, char **argv) {
    printf("all: indirect light of all reflections; as: of %u bounces, as photons' default; sum: with direct light. NMSE and "
           "relMSE are less\nthe reference's own\n%-9s %-24s %-4s %6s %6s %6s %6s  %8s %8s  %7s %7s %8s %8s\n",
           TRUTH_BOUNCES, "", "", "", "red", "green", "blue", "dark", "NMSE", "relMSE", "own", "own", "bake s", "MB");
    t->every = STILL_EVERY;
    t->size = bench_smoke() ? "48x36" : "192x144";
    for (size_t i = 0; i < UNTUNED_SCENES; i++)
        if (asked_for(untuned_scenes + i, argc, argv) && untuned_write(untuned_scenes + i, t->size)) {
            t->scene = untuned_scenes + i;
            run(t);
            fflush(stdout);
        }
    printf("\n%% of indirect light; used: of surfaces seen; change: its error over a second; own: by the reference's noise\n"
           "%-15s %-24s %7s %7s %7s %7s %8s %8s %8s\n",
           "", "", "noise", "step", "largest", "used", "change", "as", "own");
    t->every = bench_smoke() ? STILL_EVERY : MOTION_EVERY;
    t->size = bench_smoke() ? "48x36" : "512x384";
    for (size_t i = 0; i < UNTUNED_MOTIONS; i++) {
        untuned_scene s = untuned_motions[i];
        s.frames = bench_smoke() ? MOTION_SPAN : s.frames;
        if (asked_for(&s, argc, argv) && untuned_write(&s, t->size)) {
            t->scene = &s;
            run_motion(t);
        }
    }
}

int main(int argc, char **argv) {
    char words[256], *rest = NULL;
    const char *given = getenv("METHODS");
    csv c = csv_open("indirect");
    trial t = {.csv = &c};
    snprintf(words, sizeof words, "%s", given ? given : "basis photons");
    for (char *word = strtok_r(words, " ", &rest); word && t.count < METHODS_MOST; word = strtok_r(NULL, " ", &rest))
        t.methods[t.count++].name = word;
    run_each(&t, argc, argv);
    csv_close(&c, "indirect");
    return VIT_OK;
}
