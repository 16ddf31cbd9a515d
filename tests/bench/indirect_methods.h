/* The methods that bench_indirect.c compares: a pack by each, and its light. */
#ifndef VIT_BENCH_INDIRECT_METHODS_H
#define VIT_BENCH_INDIRECT_METHODS_H

#include "../pack_sections.h"
#include "cost/images.h"
#include "indirect_scenes.h"
#include "variant.h"
#include <sys/resource.h>

enum { METHODS_MOST = 8, METHOD_OPTIONS = 15 };

typedef struct method {
    const char *name;                /* as METHODS has it */
    double cpu;                      /* seconds of the bake */
    size_t bytes;                    /* of the pack */
    float *light, *picture, *direct; /* indirect, all, direct light on the reference's grid */
    float *every_pixel;              /* indirect */
} method;

static inline double children_seconds(void) {
    struct rusage u;
    getrusage(RUSAGE_CHILDREN, &u);
    return (double)(u.ru_utime.tv_sec + u.ru_stime.tv_sec) + 1e-6 * (double)(u.ru_utime.tv_usec + u.ru_stime.tv_usec);
}

/* Bakes the scene's pack by the method: `--indirect NAME`, and an option for each +NAME=VALUE. */
static inline pack_image method_bake(const untuned_scene *s, method *m) {
    char scene[BENCH_PATH], pack[BENCH_PATH], words[256], options[METHOD_OPTIONS][64], baker[] = VIT_BUILD_DIR "/vitrine-bake";
    char to[] = "-o", quiet[] = "--quiet", no_check[] = "--no-check", indirect[] = "--indirect", *rest = NULL, *word;
    untuned_path(scene, s->name, ".cfg");
    untuned_path(pack, s->name, ".vit");
    snprintf(words, sizeof words, "%s", m->name);
    char *argv[METHOD_OPTIONS + 9] = {baker, scene, to, pack, quiet, no_check, indirect, strtok_r(words, "+", &rest)};
    for (size_t i = 0; (word = strtok_r(NULL, "+", &rest)) != NULL; i++) {
        if (i == METHOD_OPTIONS)
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

/* A frame's light at the grid's points, radiance times exposure. */
static inline float *method_play(const pack_image *pack, vit_view view, uint32_t frame, const images_grid *g) {
    const vit_open_info how = {.pack = pack->bytes, .pack_size = pack->size, .device = VIT_DEVICE_HOST, .view = view};
    float *out = bench_array((size_t)images_across(g) * images_down(g) * 3, sizeof *out);
    vit_text why;
    if (images_render(&how, frame, g, out, NULL, &why) != VIT_OK)
        bench_fail("%s", why.text);
    return out;
}

#endif
