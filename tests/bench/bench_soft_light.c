/* Soft light at equal error: the sky's and area lights' matt light baked (lightmap) and by rays of 4 to 1024 points or
 * directions a view sample, on a court and a house under the sky, a lamp under its ceiling and a bulb (indirect_scenes.h).
 *
 * Error: NMSE of all direct light against the path tracer's, less its own noise. Time: CPU of a frame on the device host, one
 * thread, less that of the pack without light of sky and surfaces; all packs of a scene in turns.
 *
 * bench_soft_light [SCENE...]. */
#include "indirect_methods.h"
#include "indirect_truth.h"

#include "cost/effect_cost.h"
#include "pack/opened.h"

enum { EVERY = 2, SIDES = 6, ROUNDS = 9, SECONDS = 60 };
#define NOISE 2e-5 /* NMSE of the path tracer's direct light that is enough */

static const char *const scenes[] = {"court", "house", "ceiling", "bulb"};

typedef struct side {
    char name[96];
    uint32_t points; /* a view sample; 0: baked */
    pack_image image;
    method baked;
    opened o;
    series ms;
    double nmse;
} side;

typedef struct lab {
    const untuned_scene *of;
    side side[SIDES + 1]; /* the last: without such light */
    truth truth;
} lab;

static double cpu_ms(void) {
    struct rusage u;
    getrusage(RUSAGE_SELF, &u);
    return 1e3 * (double)(u.ru_utime.tv_sec + u.ru_stime.tv_sec) + 1e-3 * (double)(u.ru_utime.tv_usec + u.ru_stime.tv_usec);
}

static void must(vit_status status, const vit_text *why) {
    if (status != VIT_OK)
        bench_fail("%s", why->text);
}

static void open_side(side *s) {
    vit_text why;
    const vit_open_info how = {
        .pack = s->image.bytes, .pack_size = s->image.size, .device = VIT_DEVICE_HOST, .threads = 1, .view = VIT_VIEW_direct};
    must(opened_begin(&how, &s->o, &why), &why);
}

/* Until its noise is small or twice as many paths would take more than SECONDS. */
static void trace(lab *l) {
    const pack_sections sections = pack_sections_of(l->side[0].image.bytes);
    char folder[BENCH_PATH];
    vit_text why;
    untuned_path(folder, "", "");
    reference_input in = {.sections = &sections, .every = EVERY, .bounces = TRUTH_BOUNCES, .target = 1e-12, .cache = folder};
    for (in.max_samples = REFERENCE_ROUND; in.max_samples <= REFERENCE_MOST; in.max_samples *= 2) {
        reference_free(&l->truth.r);
        must(reference_render(&in, &l->truth.r, &why), &why);
        const reference *r = &l->truth.r;
        const truth_part p = truth_part_of(r->direct, r->direct_variance, 3 * (size_t)r->width * r->height);
        if (p.noise <= NOISE || bench_smoke() || 2 * r->seconds > SECONDS)
            break;
        while (in.max_samples < r->samples) /* of an earlier run */
            in.max_samples *= 2;
    }
    truth_finish(&l->truth);
}

static void bake_side(lab *l, side *s, uint32_t points) {
    s->points = points;
    if (points == 0)
        snprintf(s->name, sizeof s->name, "photons+photons=0+lightmap=baked");
    else
        snprintf(s->name, sizeof s->name, "photons+photons=0+lightmap=rays+sky-samples=%u+light-samples=%u", points, points);
    s->baked.name = s->name;
    s->image = method_bake(l->of, &s->baked);
}

/* The pack without such light, in a copy that lies as a pack must. */
static void bare_side(const side *of, side *s) {
    const pack_sections sections = pack_sections_of(of->image.bytes);
    vit_text why;
    void *bytes;
    must(effect_cost_without(&sections, VIT_BIT(SKY_LIGHT) | VIT_BIT(AREA_LIGHTS), &bytes, &s->image.size, &why), &why);
    s->image.bytes = bytes;
    snprintf(s->name, sizeof s->name, "without");
}

static void judge(lab *l, side *s) {
    const vit_scene *meta = pack_sections_of(s->image.bytes).data[VIT_SECTION_META];
    const images_grid grid = {meta->width, meta->height, EVERY};
    s->baked.direct = method_play(&s->image, VIT_VIEW_direct, 0, &grid);
    s->nmse = truth_compare(&l->truth, DIRECT, s->baked.direct).nmse;
}

/* CPU of a frame, each side in its turn. */
static void time_sides(lab *l) {
    vit_text why;
    for (int round = -1; round < bench_rounds(ROUNDS); round++)
        for (int k = 0; k <= SIDES; k++) {
            const double began = cpu_ms();
            must(opened_frame(&l->side[k].o, 0, &why), &why);
            if (round >= 0)
                series_add(&l->side[k].ms, cpu_ms() - began);
        }
}

/* What side k's light takes, round by round. */
static series light_ms(const lab *l, int k) {
    series r = {.count = l->side[k].ms.count};
    for (int i = 0; i < r.count; i++)
        r.value[i] = l->side[k].ms.value[i] - l->side[SIDES].ms.value[i];
    return r;
}

/* Rays' time at the error of what is baked, between two numbers of points on a line in logarithms; 0: no number is as good. */
static double ms_as_good(const lab *l) {
    const double known = fmax(l->side[0].nmse, 1e-9);
    for (int k = 1; k < SIDES; k++) {
        const series at = light_ms(l, k), before = light_ms(l, k - 1);
        if (l->side[k].nmse > known)
            continue;
        if (k == 1)
            return series_median(&at);
        const double part = log(l->side[k - 1].nmse / known) / log(l->side[k - 1].nmse / fmax(l->side[k].nmse, 1e-12));
        return series_median(&before) * pow(series_median(&at) / series_median(&before), part);
    }
    return 0;
}

static void report(const lab *l, csv *out) {
    const series first = light_ms(l, 0);
    for (int k = 0; k < SIDES; k++) {
        const side *s = &l->side[k];
        const series ms = light_ms(l, k), error = series_exact(s->nmse);
        char what[32] = "baked";
        if (s->points)
            snprintf(what, sizeof what, "%u rays", s->points);
        printf("%-8s %-10s NMSE %9.6f (truth's own %.6f) %9.2f ms, deviation %.2f; bake %.1f s, pack %.3f MB\n", l->of->name,
               what, s->nmse, l->truth.part[DIRECT].noise, series_median(&ms), series_mad(&ms), s->baked.cpu,
               (double)s->image.size * 1e-6);
        csv_row(out, l->of->name, "192x144", what, &ms, "ms");
        csv_row(out, l->of->name, "192x144", what, &error, "NMSE");
    }
    const double rays = ms_as_good(l);
    if (rays > 0)
        printf("%-8s at equal error rays take %.1f times as long as what is baked\n", l->of->name,
               rays / series_median(&first));
    else {
        const series most = light_ms(l, SIDES - 1);
        printf("%-8s no number of rays is as good as what is baked: more than %.0f times as long\n", l->of->name,
               series_median(&most) / series_median(&first));
    }
    fflush(stdout);
}

static void run(const untuned_scene *of, csv *out) {
    lab l = {.of = of};
    if (!untuned_write(of, bench_smoke() ? "48x36" : "192x144"))
        return;
    for (int k = 0; k < SIDES; k++)
        bake_side(&l, &l.side[k], k == 0 ? 0 : 1u << 2 * k);
    bare_side(&l.side[1], &l.side[SIDES]);
    trace(&l);
    for (int k = 0; k < SIDES; k++)
        judge(&l, &l.side[k]);
    for (int k = 0; k <= SIDES; k++)
        open_side(&l.side[k]);
    time_sides(&l);
    report(&l, out);
    for (int k = 0; k <= SIDES; k++) {
        opened_end(&l.side[k].o);
        free(l.side[k].baked.direct);
        image_free(&l.side[k].image);
    }
    truth_free(&l.truth);
}

static bool asked_for(const char *name, int argc, char **argv) {
    for (int i = 1; i < argc; i++)
        if (strcmp(argv[i], name) == 0)
            return true;
    return argc == 1;
}

int main(int argc, char **argv) {
    csv out = csv_open("soft_light");
    for (size_t i = 0; i < sizeof scenes / sizeof *scenes; i++)
        for (size_t k = 0; k < UNTUNED_SCENES; k++)
            if (strcmp(untuned_scenes[k].name, scenes[i]) == 0 && asked_for(scenes[i], argc, argv) &&
                (!bench_smoke() || i == 2))
                run(&untuned_scenes[k], &out);
    csv_close(&out, "soft_light");
    return VIT_OK;
}
