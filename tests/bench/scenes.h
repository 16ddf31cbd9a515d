/* The scenes of the benches, and their packs: baked by vitrine-bake when missing or older than the baker, kept for the next
 * run. */
#ifndef VIT_BENCH_SCENES_H
#define VIT_BENCH_SCENES_H

#include "child.h"

#define BENCH_FOLDER VIT_BUILD_DIR "/bench"
#define BENCH_FRAMES 4u

typedef struct bench_scene {
    const char *name;
    const char *mesh; /* in the folder of test scenes, or of our own */
    bool own;         /* made by make-scenes */
    double radius;    /* metres: a second one beside auto; 0: none */
    const char *camera, *light;
} bench_scene;

/* One moving point light each; in frame 0 Sponza's and Sibenik's are where the README of the test scenes has them. */
static const bench_scene bench_scenes[] = {
    {"atrium", "atrium.obj", true, 0, "eye = [-9.6, 1.7, 1.7]; target = [2.0, 3.3, -0.9]; fov = 62.0;",
     "{ position = [-2.4, 2.8, -2.0]; power = [1100.0, 860.0, 570.0]; }, { time = 0.125; position = [2.6, 5.2, 1.6]; }"},
    {"sponza", "sponza/sponza.gltf", false, 1.5, "eye = [-10.0, 2.0, -0.5]; target = [5.0, 4.0, -0.5]; fov = 60.0;",
     "{ position = [0.0, 10.0, 0.0]; power = [2000.0, 2000.0, 2000.0]; }, { time = 0.125; position = [4.0, 7.0, 0.5]; }"},
    {"sibenik", "sibenik/sibenik.obj", false, 2.0, "eye = [24.0, 2.5, 0.0]; target = [0.0, 5.0, 0.0]; fov = 60.0;",
     "{ position = [8.0, 14.0, 0.0]; power = [4000.0, 4000.0, 4000.0]; }, { time = 0.125; position = [2.0, 11.0, 1.0]; }"},
};
#define BENCH_SCENES (sizeof bench_scenes / sizeof *bench_scenes)

/* Size `i` of the pictures, NULL: there are no more. */
static inline const char *bench_size(size_t i) {
    static const char *const sizes[] = {"1280x720", "1920x1080", NULL}, *const smoke[] = {"96x64", NULL};
    return bench_smoke() ? smoke[i] : sizes[i];
}

#define BENCH_PATH 1024

/* Absolute path of the scene's mesh; false, with a message, if there is none. */
static inline bool scene_mesh_path(const bench_scene *s, char out[BENCH_PATH]) {
    const char *given = getenv("VITRINE_SCENES"), *folder = s->own  ? VIT_BUILD_DIR "/scenes"
                                                            : given ? given
                                                                    : "../shared/scenes";
    char path[BENCH_PATH / 2], here[BENCH_PATH / 2 - 1];
    snprintf(path, sizeof path, "%s/%s", folder, s->mesh);
    if (access(path, R_OK) != 0) {
        printf("%s: skipped, there is no %s (VITRINE_SCENES names the folder of test scenes)\n", s->name, path);
        return false;
    }
    if (!getcwd(here, sizeof here))
        bench_fail("the current folder has no path: %s", strerror(errno));
    snprintf(out, BENCH_PATH, "%s%s%s", path[0] == '/' ? "" : here, path[0] == '/' ? "" : "/", path);
    return true;
}

static inline bool file_says(const char *path, const char *text) {
    char old[4096];
    FILE *f = fopen(path, "r");
    if (!f)
        return false;
    const size_t n = fread(old, 1, sizeof old - 1, f);
    fclose(f);
    old[n] = 0;
    return strcmp(old, text) == 0;
}

/* Writes the scene file unless it says the same already: its age decides whether packs are baked anew. */
static inline void scene_write(const bench_scene *s, const char *mesh, const char *path) {
    char text[4096];
    snprintf(text, sizeof text,
             "name = \"%s\";\noutput: { frames = %u; fps = 24.0; };\nbackground = [0.1, 0.1, 0.1];\nmeshes = ( { file = "
             "\"%s\"; } );\n"
             "camera: { keys = ( { %s } ); };\nlights = ( { type = \"point\"; keys = ( %s ); } );\n"
             "quality: { indirect = \"photons\"; photons = 17000; "
             "bounces = 4; radius = \"auto\"; tile = 32; estimate = \"list\"; };\n",
             s->name, BENCH_FRAMES, mesh, s->camera, s->light);
    if (file_says(path, text))
        return;
    FILE *f = fopen(path, "w");
    if (!f || fputs(text, f) < 0 || fclose(f) != 0)
        bench_fail("%s: %s", path, strerror(errno));
}

static inline bool is_newer(const char *path, const char *than) {
    struct stat a, b;
    if (stat(path, &a) != 0 || stat(than, &b) != 0)
        return false;
    return a.st_mtim.tv_sec > b.st_mtim.tv_sec ||
           (a.st_mtim.tv_sec == b.st_mtim.tv_sec && a.st_mtim.tv_nsec >= b.st_mtim.tv_nsec);
}

/* Path of the pack of scene and size, baked if need be; false if the scene is not at hand. A smoke run takes our own alone. */
static inline bool scene_pack(const bench_scene *s, const char *size, char out[BENCH_PATH]) {
    char mesh[BENCH_PATH], cfg[BENCH_PATH], picture[32], baker[] = VIT_BUILD_DIR "/vitrine-bake";
    char to[] = "-o", size_option[] = "--size", quiet[] = "--quiet", no_check[] = "--no-check";
    if ((bench_smoke() && !s->own) || !scene_mesh_path(s, mesh))
        return false;
    bench_folder(BENCH_FOLDER);
    snprintf(cfg, sizeof cfg, BENCH_FOLDER "/%s.cfg", s->name);
    snprintf(out, BENCH_PATH, BENCH_FOLDER "/%s-%s.vit", s->name, size);
    snprintf(picture, sizeof picture, "%s", size);
    scene_write(s, mesh, cfg);
    if (is_newer(out, cfg) && is_newer(out, baker) && is_newer(out, mesh))
        return true;
    printf("baking %s\n", out);
    char *const argv[] = {baker, cfg, to, out, size_option, picture, quiet, no_check, NULL};
    child_run(argv, NULL, false);
    return true;
}

#endif
