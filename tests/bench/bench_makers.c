/* What indirect light costs by who makes it: photons, baked irradiance, live radiosity, of our demo and the Cornell box.
 * Verified first: the packs' own golden hashes. They take turns frame by frame, with the same scene without indirect light, so
 * that what slows the machine for a while slows all: beside the passes that a method adds it has the look-ups within the
 * others, by the difference of all passes to those without.
 *
 * bench_makers [SCENE...]; its packs are those of makers.h. */
#include "makers.h"

#define ROUNDS 2 /* of all frames that are timed, after one that warms up and verifies */

enum { FRAMES_TIMED = 12 };

typedef struct contest {
    const maker_scene *scene;
    const char *size;
    pack_image pack[MAKERS];
    player player[MAKERS];
    series pass[MAKERS][VIT_MAX_PASSES], own[MAKERS], more[MAKERS]; /* ms: a pass, those that it adds, all beyond none's */
    series own_part[MAKERS], more_part[MAKERS];                     /* of photons' in the same turn */
} contest;

static void contest_open(contest *c) {
    const variant without = {.estimate = 0};
    for (int m = PHOTONS; m < MAKERS; m++)
        c->pack[m] = maker_pack(c->scene, m);
    c->pack[NONE] = image_variant(&c->pack[PHOTONS], &without);
    for (int m = 0; m < MAKERS; m++)
        c->player[m] = player_open(&c->pack[m], 0, bench_device());
}

static void contest_close(contest *c) {
    for (int m = 0; m < MAKERS; m++) {
        player_close(&c->player[m]);
        image_free(&c->pack[m]);
    }
}

/* Frame k of those that are timed: evenly over the path. */
static uint32_t frame_of(const contest *c, uint32_t k) {
    return (uint32_t)((uint64_t)k * c->player[NONE].need.frames / FRAMES_TIMED);
}

static void verify(contest *c) {
    for (int m = PHOTONS; m < MAKERS; m++)
        for (uint32_t k = 0; k < FRAMES_TIMED; k++) {
            player *p = &c->player[m];
            player_frame(p, frame_of(c, k));
            if (vit_hash(p->pixels, p->need.frame_bytes) != vit_golden(p->v, frame_of(c, k)))
                bench_fail("%s by %s: frame %u is not the pack's", c->scene->name, maker_names[m], frame_of(c, k));
        }
}

static void time_frame(contest *c, uint32_t frame) {
    double own[MAKERS] = {0}, all[MAKERS] = {0};
    for (int m = 0; m < MAKERS; m++) {
        player *p = &c->player[m];
        player_frame(p, frame);
        for (uint32_t i = 0; i < vit_pass_count; i++) {
            if (!vit_pass_called(i, &p->v->launch))
                continue;
            series_add(&c->pass[m][i], p->v->pass_ms[i]);
            all[m] += p->v->pass_ms[i];
            own[m] += vit_pass_called(i, &c->player[NONE].v->launch) ? 0 : p->v->pass_ms[i];
        }
    }
    for (int m = PHOTONS; m < MAKERS; m++) {
        series_add(&c->own[m], own[m]);
        series_add(&c->more[m], all[m] - all[NONE]);
        series_add(&c->own_part[m], own[m] / own[PHOTONS]);
        series_add(&c->more_part[m], (all[m] - all[NONE]) / (all[PHOTONS] - all[NONE]));
    }
}

static void put(csv *out, const contest *c, int m, const char *what, const series *s, const char *unit) {
    char name[96];
    snprintf(name, sizeof name, "%s: %s", maker_names[m], what);
    csv_row(out, c->scene->name, c->size, name, s, unit);
}

static void report(csv *out, const contest *c) {
    printf("\n%s, %s, ms, medians of %d frames; x: of photons' in the same turn\n%-10s %18s %10s %18s %10s %10s\n",
           c->scene->name, c->size, c->own[PHOTONS].count, "", "its passes", "", "with look-ups", "", "MB");
    for (int m = PHOTONS; m < MAKERS; m++) {
        const series bytes = series_exact((double)c->player[m].need.device_bytes);
        printf("%-10s %9.3f +- %5.2f %9.4f x %9.3f +- %5.2f %9.4f x %9.1f\n", maker_names[m], series_median(&c->own[m]),
               series_mad(&c->own[m]), series_median(&c->own_part[m]), series_median(&c->more[m]), series_mad(&c->more[m]),
               series_median(&c->more_part[m]), series_median(&bytes) * 1e-6);
        put(out, c, m, "its passes", &c->own[m], "ms");
        put(out, c, m, "with look-ups", &c->more[m], "ms");
        put(out, c, m, "its passes, of photons'", &c->own_part[m], "1");
        put(out, c, m, "with look-ups, of photons'", &c->more_part[m], "1");
        put(out, c, m, "device memory", &bytes, "B");
    }
    for (uint32_t i = 0; i < vit_pass_count; i++) {
        const bool called = c->pass[BASIS][i].count + c->pass[RADIOSITY][i].count > 0;
        if (!called)
            continue;
        printf("  %-18s", vit_passes[i].name);
        for (int m = 0; m < MAKERS; m++)
            printf(" %10.3f", series_median(&c->pass[m][i]));
        printf("\n");
        for (int m = 0; m < MAKERS; m++)
            if (c->pass[m][i].count > 0)
                put(out, c, m, vit_passes[i].name, &c->pass[m][i], "ms");
    }
}

int main(int argc, char **argv) {
    csv out = csv_open("makers");
    for (size_t i = 0; i < MAKER_SCENES; i++) {
        if (!maker_asked_for(&maker_scenes[i], argc, argv))
            continue;
        contest *c = bench_array(1, sizeof *c);
        *c = (contest){.scene = &maker_scenes[i], .size = maker_size(&maker_scenes[i])};
        contest_open(c);
        verify(c);
        for (int round = 0; round < bench_rounds(ROUNDS); round++)
            for (uint32_t k = 0; k < FRAMES_TIMED; k++)
                time_frame(c, frame_of(c, k));
        report(&out, c);
        contest_close(c);
        free(c);
    }
    csv_close(&out, "makers");
    return VIT_OK;
}
