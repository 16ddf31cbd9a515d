/* Milliseconds a pass with list, buckets and raw buckets; photons per cluster; memory; what containment would save. The three
 * estimates take turns frame by frame, so that what slows the machine for a while slows all. Verified first: the pack's own
 * golden hashes. */
#include "containment.h"
#include "scenes.h"

#define ROUNDS 3 /* of all frames, after one that warms up and verifies */

enum { LIST, BUCKETS, RAW, ESTIMATES };
static const char *const estimate_names[ESTIMATES] = {"list", "buckets", "raw"};
static const uint32_t estimate_effects[ESTIMATES] = {VIT_BIT(LIST), VIT_BIT(BUCKETS), VIT_BIT(BUCKETS) | VIT_BIT(RAW_BUCKETS)};

typedef struct contest {
    const char *scene, *size;
    char setting[48]; /* scene and radius */
    double radius;    /* metres; 0: the pack's, auto */
    pack_image pack[ESTIMATES];
    player player[ESTIMATES];
    series pass_ms[ESTIMATES][VIT_MAX_PASSES], frame_ms[ESTIMATES];
} contest;

/* Opens the pack with a list as large as its frames want and no larger, as a bake would have it. */
static player open_exact(const pack_image *pack) {
    uint32_t list = 1u << 20;
    for (;;) {
        player p = player_open(pack, list, bench_device());
        for (uint32_t f = 0; f < p.need.frames; f++)
            player_frame(&p, f);
        const uint32_t want = player_stats(&p).max_list;
        if (want == list)
            return p;
        player_close(&p);
        list = want;
    }
}

static void contest_open(contest *c, const pack_image *baked) {
    for (int e = 0; e < ESTIMATES; e++) {
        const variant v = {.estimate = estimate_effects[e], .radius = c->radius};
        c->pack[e] = image_variant(baked, &v);
        c->player[e] = open_exact(&c->pack[e]);
    }
    snprintf(c->setting, sizeof c->setting, "%s r %.3g%s", c->scene, (double)c->player[LIST].v->pack.scene->radius,
             c->radius > 0 ? "" : " auto");
}

static void contest_close(contest *c) {
    for (int e = 0; e < ESTIMATES; e++) {
        player_close(&c->player[e]);
        image_free(&c->pack[e]);
    }
}

/* List and automatic radius are what was baked: those frames must have the pack's hashes. None may drop anything. */
static void verify(contest *c) {
    for (int e = 0; e < ESTIMATES; e++) {
        player *p = &c->player[e];
        for (uint32_t f = 0; f < p->need.frames; f++) {
            player_frame(p, f);
            if (e == LIST && c->radius == 0 && vit_hash(p->pixels, p->need.frame_bytes) != vit_golden(p->v, f))
                bench_fail("%s %s: frame %u is not the pack's (are vitrine-bake and this program of one build?)", c->setting,
                           c->size, f);
        }
        const vit_statistics s = player_stats(p);
        if (s.dropped_samples || s.dropped_entries)
            bench_fail("%s %s, %s: something was dropped", c->setting, c->size, estimate_names[e]);
    }
}

static void contest_run(contest *c) {
    for (int round = 0; round < bench_rounds(ROUNDS); round++)
        for (uint32_t f = 0; f < c->player[LIST].need.frames; f++)
            for (int e = 0; e < ESTIMATES; e++) {
                player *p = &c->player[e];
                series_add(&c->frame_ms[e], player_frame(p, f));
                for (uint32_t i = 0; i < vit_pass_count; i++)
                    if (vit_pass_called(i, &p->v->launch))
                        series_add(&c->pass_ms[e][i], p->v->pass_ms[i]);
            }
}

static void report_row(csv *out, const contest *c, const char *name, const series *of[ESTIMATES]) {
    char what[96];
    printf("  %-18s", name);
    for (int e = 0; e < ESTIMATES; e++) {
        if (of[e]->count == 0) {
            printf(" %18s", "");
            continue;
        }
        printf(" %9.2f +- %5.2f", series_median(of[e]), series_mad(of[e]));
        snprintf(what, sizeof what, "%s, %s", estimate_names[e], name);
        csv_row(out, c->setting, c->size, what, of[e], "ms");
    }
    putchar('\n');
}

static void report_times(csv *out, const contest *c) {
    const series *of[ESTIMATES];
    printf("\n%s, %s, ms, medians of %d frames\n  %-18s %18s %18s %18s\n", c->setting, c->size, c->frame_ms[LIST].count, "pass",
           estimate_names[LIST], estimate_names[BUCKETS], estimate_names[RAW]);
    for (uint32_t i = 0; i < vit_pass_count; i++) {
        int called = 0;
        for (int e = 0; e < ESTIMATES; e++) {
            of[e] = &c->pass_ms[e][i];
            called += of[e]->count;
        }
        if (called)
            report_row(out, c, vit_passes[i].name, of);
    }
    for (int e = 0; e < ESTIMATES; e++)
        of[e] = &c->frame_ms[e];
    report_row(out, c, "whole frame", of);
}

/* Exact numbers, of the last frame. */
static void report_number(csv *out, const contest *c, const char *what, double value, const char *unit) {
    const series s = series_exact(value);
    csv_row(out, c->setting, c->size, what, &s, unit);
}

static void report_work(csv *out, contest *c) {
    const vit_statistics s = player_stats(&c->player[LIST]), b = player_stats(&c->player[BUCKETS]);
    const double mean = s.clusters ? (double)s.pairs / s.clusters : 0;
    printf(
        "  photons %u, clusters %u, pairs %u: %.1f photons a cluster, at most %u; list entries %u with list, %u with buckets\n",
        s.photons, s.clusters, s.pairs, mean, s.largest, s.list, b.list);
    report_number(out, c, "photons", s.photons, "1");
    report_number(out, c, "clusters", s.clusters, "1");
    report_number(out, c, "photon-cluster pairs", s.pairs, "1");
    report_number(out, c, "photons a cluster, mean", mean, "1");
    report_number(out, c, "photons a cluster, largest", s.largest, "1");
    report_number(out, c, "list, list entries", s.list, "1");
    report_number(out, c, "buckets, list entries", b.list, "1");
    printf("  device memory, MiB:");
    for (int e = 0; e < ESTIMATES; e++) {
        char what[64];
        const vit_requirements *n = &c->player[e].need;
        uint64_t frame = 0;
        for (uint32_t i = 0; i < n->buffer_count; i++)
            for (uint32_t k = 0; k < B_COUNT; k++)
                if (vit_buffer_sections[k] == VIT_SECTION_NONE && strcmp(vit_buffer_names[k], n->buffers[i].name) == 0)
                    frame += n->buffers[i].bytes;
        printf(" %s %.1f (%.1f without the scene)", estimate_names[e], (double)n->device_bytes / 0x1p20,
               (double)frame / 0x1p20);
        snprintf(what, sizeof what, "%s, device memory", estimate_names[e]);
        report_number(out, c, what, (double)n->device_bytes, "B");
        snprintf(what, sizeof what, "%s, device memory without the scene", estimate_names[e]);
        report_number(out, c, what, (double)frame, "B");
    }
    putchar('\n');
}

static double percent(uint64_t part, uint64_t whole) {
    return whole ? 100.0 * (double)part / (double)whole : 0;
}

static void report_containment(csv *out, contest *c) {
    descent a, b;
    containment_count(&c->player[LIST], &a, &b);
    const uint64_t pairs = b.leaf_pairs + b.inner_pairs;
    printf("  containment: pairs %llu without, %llu with (%.1f %%), of them %llu on inner nodes, which stand for %llu (%.1f "
           "%%) of those without\n",
           (unsigned long long)a.leaf_pairs, (unsigned long long)pairs, percent(pairs, a.leaf_pairs),
           (unsigned long long)b.inner_pairs, (unsigned long long)(a.leaf_pairs - b.leaf_pairs),
           percent(a.leaf_pairs - b.leaf_pairs, a.leaf_pairs));
    printf("               entries of all levels %.1f %%, photon-node tests %.1f %%, sample-photon evaluations %.1f %% of "
           "those without\n",
           percent(pairs + b.passed, a.leaf_pairs + a.passed), percent(b.tests, a.tests),
           percent(b.evaluations, a.evaluations));
    report_number(out, c, "containment, pairs without", (double)a.leaf_pairs, "1");
    report_number(out, c, "containment, pairs with", (double)pairs, "1");
    report_number(out, c, "containment, pairs on inner nodes", (double)b.inner_pairs, "1");
    report_number(out, c, "containment, entries without", (double)(a.leaf_pairs + a.passed), "1");
    report_number(out, c, "containment, entries with", (double)(pairs + b.passed), "1");
    report_number(out, c, "containment, tests without", (double)a.tests, "1");
    report_number(out, c, "containment, tests with", (double)b.tests, "1");
    report_number(out, c, "containment, evaluations without", (double)a.evaluations, "1");
    report_number(out, c, "containment, evaluations with", (double)b.evaluations, "1");
}

static void run(csv *out, const char *scene, const char *size, double radius, const pack_image *baked) {
    contest *c = bench_array(1, sizeof *c);
    *c = (contest){.scene = scene, .size = size, .radius = radius};
    contest_open(c, baked);
    verify(c);
    contest_run(c);
    report_times(out, c);
    report_work(out, c);
    report_containment(out, c);
    contest_close(c);
    free(c);
}

int main(void) {
    csv out = csv_open("passes");
    for (size_t i = 0; i < BENCH_SCENES; i++)
        for (size_t k = 0; bench_size(k); k++) {
            const bench_scene *s = &bench_scenes[i];
            char path[BENCH_PATH];
            if (!scene_pack(s, bench_size(k), path))
                continue;
            pack_image baked = image_load(path);
            run(&out, s->name, bench_size(k), 0, &baked);
            if (s->radius > 0)
                run(&out, s->name, bench_size(k), s->radius, &baked);
            image_free(&baked);
        }
    csv_close(&out, "passes");
    return VIT_OK;
}
