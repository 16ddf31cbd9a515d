#include "pack/bounds.h"
#include "common/fail.h"
#include "pack/opened.h"
#include <stdlib.h>
#include <string.h>

#define FIRST_NODES 65536u
#define FIRST_LIST (1u << 20)
#define MOST_NODES (1u << 26)
#define MOST_LIST (1u << 28)

/* A pack in memory, opened. */
typedef struct run {
    void *pack;
    opened o;
} run;

static void run_end(run *r) {
    opened_end(&r->o);
    free(r->pack);
    memset(r, 0, sizeof *r);
}

static vit_status out_of_memory(vit_text *why) {
    return bake_fail(why, VIT_FAILED, "out of memory");
}

static vit_status run_begin(run *r, const bounds_input *in, const pack_sections *sections, vit_format format, bool record_reach,
                            vit_text *why) {
    vit_open_info info = {.device = in->device, .threads = in->threads, .format = format};
    info.record_reach = record_reach;
    info.count_work = record_reach && (in->scene->effects & VIT_BIT(CUTOUT)) != 0;
    memset(r, 0, sizeof *r);
    vit_status status = pack_assemble(sections, &r->pack, &info.pack_size, why);
    if (status != VIT_OK)
        return status;
    info.pack = r->pack;
    status = opened_begin(&info, &r->o, why);
    if (status != VIT_OK)
        run_end(r);
    return status;
}

static vit_status frame(bounds_input *in, run *r, uint32_t index, const char *stage, vit_text *why) {
    vit_status status = opened_frame(&r->o, index, why);
    if (in->progress)
        in->progress(in->user, stage, (index + 1.0) / in->scene->frames);
    return status;
}

/* The hierarchy of a scene lit by one empty photon: all that clusters need. */
static vit_status measure_slices(bounds_input *in, vit_text *why) {
    static const vit_photon none = {.radius2 = -1.0f};
    vit_scene s = *in->scene;
    pack_sections sections = *in->sections;
    run r;
    /* 1. the scene with clusters and without light */
    s.effects = (s.effects & ~vit_effects_upon(VIT_BIT(INDIRECT))) | VIT_BIT(INDIRECT) | VIT_BIT(PHOTONS) | VIT_BIT(LIST);
    s.cells = 0;
    s.paths = 0;
    s.baked = 1;
    s.tile = 64; /* slices do not depend on it, and keys stay short */
    s.slice_first = 0;
    s.slice_count = 4096;
    s.max_nodes = 2;
    s.max_list = 1;
    vit_light *dark = calloc((size_t)s.frames * s.lights, sizeof *dark);
    if (!dark)
        return out_of_memory(why);
    memcpy(dark, sections.data[VIT_SECTION_LITE], (size_t)s.frames * s.lights * sizeof *dark);
    for (size_t i = 0; i < (size_t)s.frames * s.lights; i++) {
        dark[i].path_first = dark[i].path_count = 0;
        dark[i].cos_outer = -1.0f;
    }
    sections.data[VIT_SECTION_META] = &s;
    sections.data[VIT_SECTION_LITE] = dark;
    sections.data[VIT_SECTION_PHOT] = &none;
    vit_status status = vit_pack_derive(&s, why);
    if (in->progress)
        in->progress(in->user, "depth slices", 0);
    if (status == VIT_OK)
        status = run_begin(&r, in, &sections, VIT_FORMAT_XRGB8888, false, why);
    free(dark);
    if (status != VIT_OK)
        return status;
    uint32_t least = UINT32_MAX, most = 0; /* 2. the slices that its frames use */
    for (uint32_t i = 0; i < s.frames && status == VIT_OK; i++) {
        vit_statistics stats;
        status = frame(in, &r, i, "depth slices", why);
        if (status == VIT_OK)
            status = vit_stats(r.o.v, &stats, why);
        if (status != VIT_OK || stats.slice_min > stats.slice_max) /* nothing in view */
            continue;
        least = stats.slice_min < least ? stats.slice_min : least;
        most = stats.slice_max > most ? stats.slice_max : most;
    }
    run_end(&r);
    in->scene->slice_first = least == UINT32_MAX ? 0 : least;
    in->scene->slice_count = least == UINT32_MAX ? 1 : most - least + 1;
    if (in->scene->slice_count > 4096)
        in->scene->slice_count = 4096;
    return status;
}

static void split(uint32_t out[2], uint64_t hash) {
    out[0] = (uint32_t)hash;
    out[1] = (uint32_t)(hash >> 32);
}

static uint32_t doubled(uint32_t want, uint32_t most) {
    return want > most / 2 ? most : want * 2;
}

/* What the frame's rays reached; words: room for the runtime's. */
static vit_status note_reached(bounds_input *in, const run *r, const vit_statistics *t, uint32_t index, uint32_t *words,
                               vit_text *why) {
    const vit_scene *s = in->scene;
    const size_t receivers = s->receivers / 32;
    uint64_t tests = 0;
    for (uint32_t p = 0; p < t->pass_count && t->work_count > 0; p++)
        tests += t->pass_work[p][VIT_WORK_cutout_tests];
    const vit_status status = vit_reached(r->o.v, words, VIT_REACHED_WORDS(s), why);
    if (status == VIT_OK && in->reached)
        effects_note(in->reached, s->materials, words, tests, index);
    if (status == VIT_OK && in->looked_up)
        memcpy(in->looked_up + index * receivers, words + s->materials + VIT_REACHED_MORE, receivers * sizeof *words);
    return status;
}

/* One run over the path from frame *next; stops early, with the bounds raised, at the first frame that overflows. */
static vit_status measure_frames(bounds_input *in, uint32_t *next, uint32_t *nodes, uint32_t *list, vit_text *why) {
    vit_scene *s = in->scene;
    run r = {0};
    if (in->progress)
        in->progress(in->user, "frames", (double)*next / s->frames);
    const bool records = in->reached || in->looked_up;
    uint32_t *words = records ? calloc(VIT_REACHED_WORDS(s), sizeof *words) : NULL;
    vit_status status = records && !words ? out_of_memory(why) : VIT_OK;
    if (status == VIT_OK)
        status = run_begin(&r, in, in->sections, VIT_FORMAT_XRGB8888, words != NULL, why);
    while (status == VIT_OK && *next < s->frames) {
        vit_statistics t;
        status = frame(in, &r, *next, "frames", why);
        if (status == VIT_OK)
            status = vit_stats(r.o.v, &t, why);
        if (status != VIT_OK)
            break;
        if (t.nodes > s->max_nodes || t.list > s->max_list) {
            if ((t.nodes > s->max_nodes && s->max_nodes == MOST_NODES) || (t.list > s->max_list && s->max_list == MOST_LIST)) {
                status = bake_fail(why, VIT_BAD_INPUT,
                                   "frame %u needs %u hierarchy nodes and %u list entries, "
                                   "at most %u and %u are possible: lower quality.radius or "
                                   "quality.photons",
                                   *next, t.nodes, t.list, MOST_NODES, MOST_LIST);
                break;
            }
            s->max_nodes = t.nodes > s->max_nodes ? doubled(t.nodes, MOST_NODES) : s->max_nodes;
            s->max_list = t.list > s->max_list ? doubled(t.list, MOST_LIST) : s->max_list;
            break;
        }
        if (words && (status = note_reached(in, &r, &t, *next, words, why)) != VIT_OK)
            break;
        *nodes = t.nodes > *nodes ? t.nodes : *nodes;
        *list = t.list > *list ? t.list : *list;
        vit_gold *g = &in->gold[*next];
        split(vit_gold_hash(g, VIT_FORMAT_XRGB8888), vit_hash_frame(r.o.frame, VIT_FORMAT_XRGB8888, r.o.stride * s->height));
        g->nodes = t.nodes;
        g->clusters = t.clusters;
        g->photons = t.photons;
        g->list = t.list;
        g->pairs = t.pairs;
        g->largest = t.largest;
        ++*next;
    }
    run_end(&r);
    free(words);
    return status;
}

static vit_status hash_format(bounds_input *in, vit_format format, vit_text *why) {
    static const char *const names[] = {
#define X(name, word, bytes, word_bytes, meaning) #name " hashes",
        VIT_FORMATS(X)
#undef X
    };
    run r;
    vit_status status = run_begin(&r, in, in->sections, format, false, why);
    for (uint32_t i = 0; i < in->scene->frames && status == VIT_OK; i++) {
        status = frame(in, &r, i, names[format], why);
        split(vit_gold_hash(&in->gold[i], format), vit_hash_frame(r.o.frame, format, r.o.stride * in->scene->height));
    }
    run_end(&r);
    return status;
}

vit_status bounds_count_photons(bounds_input *in, double *stored, vit_text *why) {
    const uint32_t probes = in->scene->frames < 5 ? in->scene->frames : 5;
    vit_scene *s = in->scene, kept = *s;
    run r;
    s->slice_first = 0;
    s->slice_count = 1;
    s->max_nodes = 2;
    s->max_list = 1;
    *stored = 0;
    if (in->progress)
        in->progress(in->user, "photon radius", 0);
    vit_status status = vit_pack_derive(s, why);
    if (status == VIT_OK)
        status = run_begin(&r, in, in->sections, VIT_FORMAT_XRGB8888, false, why);
    if (status != VIT_OK)
        return status;
    for (uint32_t i = 0; i < probes && status == VIT_OK; i++) {
        vit_statistics t;
        status = frame(in, &r, i * (s->frames - 1) / (probes > 1 ? probes - 1 : 1), "photon radius", why);
        if (status == VIT_OK)
            status = vit_stats(r.o.v, &t, why);
        *stored += status == VIT_OK ? (double)t.photons / probes : 0;
    }
    run_end(&r);
    *s = kept;
    return status;
}

vit_status bounds_measure(bounds_input *in, vit_text *why) {
    vit_scene *s = in->scene;
    vit_status status = VIT_OK;
    uint32_t next = 0, nodes = 1, list = 1;
    s->slice_first = 0;
    s->slice_count = 1;
    s->max_nodes = s->max_list = 1;
    if (s->effects & VIT_BIT(PHOTONS)) {
        status = vit_pack_derive(s, why); /* the shared constants of all runs */
        if (status == VIT_OK)
            status = measure_slices(in, why);
        s->max_nodes = FIRST_NODES;
        s->max_list = FIRST_LIST;
    }
    if (status == VIT_OK)
        status = vit_pack_derive(s, why);
    while (status == VIT_OK && next < s->frames)
        status = measure_frames(in, &next, &nodes, &list, why);
    if (status == VIT_OK) {
        s->max_nodes = nodes;
        s->max_list = list;
    }
    for (int f = 1; f < VIT_FORMAT_COUNT && in->all_formats && status == VIT_OK; f++)
        status = hash_format(in, (vit_format)f, why);
    return status;
}
