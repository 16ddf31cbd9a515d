/* The packs of bench_makers.c and bench_pictures.c: our demo and the Cornell box by each maker of indirect light, baked by
 * vitrine-bake when missing or older than it. */
#ifndef VIT_BENCH_MAKERS_H
#define VIT_BENCH_MAKERS_H

#include "scenes.h"
#include "variant.h"

enum { NONE = 0, PHOTONS, BASIS, RADIOSITY, MAKERS };
static const char *const maker_names[MAKERS] = {"none", "photons", "basis", "radiosity"};

typedef struct maker_scene {
    const char *name, *cfg, *size;
} maker_scene;

static const maker_scene maker_scenes[] = {{"cornell", VIT_BUILD_DIR "/scenes/cornell.cfg", "512x512"},
                                           {"atrium", VIT_BUILD_DIR "/scenes/atrium.cfg", "1280x720"}};
#define MAKER_SCENES (sizeof maker_scenes / sizeof *maker_scenes)

static inline const char *maker_size(const maker_scene *s) {
    return bench_smoke() ? "96x64" : s->size;
}

/* Is the scene one of those that the arguments name, or is none named? A smoke run takes the first alone. */
static inline bool maker_asked_for(const maker_scene *s, int argc, char **argv) {
    for (int i = 1; i < argc; i++)
        if (strcmp(argv[i], s->name) == 0)
            return true;
    return argc < 2 && (s == maker_scenes || !bench_smoke());
}

static inline pack_image maker_pack(const maker_scene *s, int maker) {
    char path[BENCH_PATH], baker[] = VIT_BUILD_DIR "/vitrine-bake", cfg[128], of[16], to[] = "-o", picture[32];
    char quiet[] = "--quiet", indirect[] = "--indirect", size_option[] = "--size", no_check[] = "--no-check";
    char rays[] = "--receiver-rays=32", patches[] = "--patches=64", frames[] = "--frames=2";
    snprintf(cfg, sizeof cfg, "%s", s->cfg);
    snprintf(of, sizeof of, "%s", maker_names[maker]);
    snprintf(picture, sizeof picture, "%s", maker_size(s));
    snprintf(path, sizeof path, "%s/makers-%s-%s-%s.vit", bench_results(), s->name, picture, of);
    char *argv[] = {baker, cfg, to, path, indirect, of, size_option, picture, quiet, no_check, NULL, NULL, NULL, NULL};
    if (bench_smoke()) {
        argv[10] = rays;
        argv[11] = patches;
        argv[12] = frames;
    }
    if (!is_newer(path, cfg) || !is_newer(path, baker)) {
        printf("baking %s\n", path);
        child_run(argv, NULL, false);
    }
    return image_load(path);
}

#endif
