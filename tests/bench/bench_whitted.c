/* Ray tracing in the manner of Whitted: view rays, smooth normals and hard shadows of one point light, no photons, 1280x968.
 * Frames a second against those that Kristek 2011 states for its GPU (kernels/METHODS.md, "The four systems"), on the Stanford
 * bunny and on our balls, which stand in for its scene of as many triangles. Every frame's hash is checked before any is timed;
 * scenes and settings then take turns. */
#include "scenes.h"
#include "vitrine.h"

#define ROUNDS 9
#define PAGE 4096u

typedef struct whitted_scene {
    const char *name;
    double source[4]; /* frames a second of the source, 1280x968, for each of the modes */
    const char *cfg;
    const char *effects; /* what the materials call for, with a comma behind */
    bench_scene mesh;
} whitted_scene;

static const whitted_scene scenes[] = {
    {"bunny", {0.94, 0.93, 0.28, 0.26}, NULL, "", {.name = "bunny", .mesh = "stanford/bun_zipper.ply"}},
    {"balls",
     {1.85, 1.54, 0.58, 0.58},
     VIT_BUILD_DIR "/scenes/balls.cfg",
     "mirror,glass,",
     {.name = "balls", .mesh = "balls.obj", .own = true}},
};
#define SCENES (sizeof scenes / sizeof *scenes)

/* The columns of Kristek's table: with and without its two improvements, interpolated normals and 4x anti-aliasing. */
static const struct {
    const char *name, *effects, *antialias;
    double goal; /* frames per second on two cores */
} modes[] = {
    {"plain", "none", "1", 60},
    {"smooth normals", "smooth-normals", "1", 60},
    {"4x anti-aliasing", "antialias", "4", 15},
    {"both", "smooth-normals,antialias", "4", 15},
};
#define MODES (sizeof modes / sizeof *modes)

/* The view of the README of the test scenes; the camera moves a little. */
static const char bunny[] =
    "name = \"bunny\";\noutput: { width = 1280; height = 968; fps = 24.0; frames = 8; };\nmeshes = ( { file = \"%s\"; } );\n"
    "camera: { keys = ( { eye = [-0.02, 0.15, 0.35]; target = [-0.02, 0.11, 0.0]; fov = 40.0; }, { time = 0.3; eye = [0.02, "
    "0.15, 0.35]; } ); };\n"
    "lights = ( { type = \"point\"; keys = ( { position = [0.2, 0.4, 0.4]; power = [4.0, 4.0, 4.0]; } ); } );\nquality: { "
    "photons = 0; };\n";

typedef struct contestant {
    uint8_t *pack, *pixels;
    void *arena;
    vit *v;
    vit_requirements need;
    uint32_t triangles;
    series fps, pass_ms[VIT_MAX_PASSES];
} contestant;

static bool write_bunny(const char *mesh, const char *path) {
    char text[4096];
    snprintf(text, sizeof text, bunny, mesh);
    if (file_says(path, text))
        return true;
    FILE *f = fopen(path, "w");
    return f && fputs(text, f) >= 0 && fclose(f) == 0;
}

/* False if the scene is not at hand. */
static bool bake(const whitted_scene *s, size_t mode, char out[BENCH_PATH]) {
    char mesh[BENCH_PATH], cfg[BENCH_PATH], baker[] = VIT_BUILD_DIR "/vitrine-bake", to[] = "-o", quiet[] = "--quiet",
                                            no_check[] = "--no-check", effects[] = "--effects", chosen[64],
                                            antialias[] = "--antialias", copies[32], size[] = "--size", tiny[] = "96x72";
    if ((bench_smoke() && !s->mesh.own) || !scene_mesh_path(&s->mesh, mesh))
        return false;
    bench_folder(BENCH_FOLDER);
    snprintf(cfg, sizeof cfg, "%s", s->cfg ? s->cfg : BENCH_FOLDER "/whitted-bunny.cfg");
    if (!s->cfg && !write_bunny(mesh, cfg))
        bench_fail("%s: %s", cfg, strerror(errno));
    snprintf(out, BENCH_PATH, BENCH_FOLDER "/whitted-%s-%zu%s.vit", s->name, mode, bench_smoke() ? "-tiny" : "");
    if (is_newer(out, cfg) && is_newer(out, baker) && is_newer(out, mesh))
        return true;
    printf("baking %s\n", out);
    const bool none = s->effects[0] != 0 && strcmp(modes[mode].effects, "none") == 0; /* of its own, but the materials' */
    snprintf(chosen, sizeof chosen, "%.*s%s", (int)strlen(s->effects) - none, s->effects, none ? "" : modes[mode].effects);
    snprintf(copies, sizeof copies, "%s", modes[mode].antialias);
    char *const argv[] = {baker, cfg, to, out, quiet, no_check, effects, chosen, antialias, copies, bench_smoke() ? size : NULL,
                          tiny,  NULL};
    child_run(argv, NULL, false);
    return true;
}

static void *read_pack(const char *path, size_t *size) {
    struct stat s;
    FILE *f = fopen(path, "rb");
    if (!f || fstat(fileno(f), &s) != 0 || s.st_size <= 0)
        bench_fail("%s: %s", path, strerror(errno));
    *size = (size_t)s.st_size;
    void *p = aligned_alloc(PAGE, (*size / PAGE + 1) * PAGE);
    if (!p || fread(p, 1, *size, f) != *size)
        bench_fail("%s: cannot be read", path);
    fclose(f);
    return p;
}

/* As vitrine-play opens a pack: frames are rendered in place. */
static void open_pack(contestant *c, const char *path) {
    vit_text why;
    vit_open_info info = {.profile = 1, .device = bench_device()};
    *c = (contestant){0};
    info.pack = c->pack = read_pack(path, &info.pack_size);
    if (vit_require(&info, &c->need, &why) != VIT_OK)
        bench_fail("%s: %s", path, why.text);
    info.arena = c->arena = aligned_alloc(64, c->need.host_bytes);
    info.arena_size = c->need.host_bytes;
    info.framebuffer = c->pixels = aligned_alloc(PAGE, (c->need.frame_bytes / PAGE + 1) * PAGE);
    if (!c->arena || !c->pixels)
        bench_fail("out of memory");
    if (vit_open(&info, &c->v, &why) != VIT_OK)
        bench_fail("%s: %s", path, why.text);
    for (uint32_t i = 0; i < c->need.buffer_count; i++)
        if (strcmp(c->need.buffers[i].name, "triangles") == 0)
            c->triangles = (uint32_t)(c->need.buffers[i].bytes / 48);
}

static void frame(contestant *c, uint32_t index) {
    vit_text why;
    if (vit_frame(c->v, index, c->pixels, c->need.frame_bytes / c->need.height, &why) != VIT_OK)
        bench_fail("%s", why.text);
}

static void verify(contestant *c, const char *name) {
    for (uint32_t i = 0; i < c->need.frames; i++) {
        frame(c, i);
        if (vit_hash_frame(c->pixels, VIT_FORMAT_XRGB8888, c->need.frame_bytes) != vit_golden(c->v, i))
            bench_fail("%s: frame %u is not the pack's", name, i);
    }
}

/* The whole path once. */
static void round_of(contestant *c) {
    vit_statistics s;
    vit_text why;
    const double began = bench_seconds();
    for (uint32_t i = 0; i < c->need.frames; i++)
        frame(c, i);
    series_add(&c->fps, c->need.frames / (bench_seconds() - began));
    if (vit_stats(c->v, &s, &why) != VIT_OK)
        bench_fail("%s", why.text);
    for (uint32_t i = 0; i < c->need.pass_count; i++)
        series_add(&c->pass_ms[i], s.pass_ms[i]); /* of the last frame */
}

static void close_pack(contestant *c) {
    vit_close(c->v);
    free(c->pack);
    free(c->arena);
    free(c->pixels);
}

static void report(csv *out, const whitted_scene *s, size_t mode, const contestant *c) {
    char size[32], what[96];
    const double fps = series_median(&c->fps);
    snprintf(size, sizeof size, "%ux%u", c->need.width, c->need.height);
    printf("%-6s %9u triangles  %-18s %7.2f +- %.2f frames/s, goal %.0f; the source %.2f: %.1f times\n", s->name, c->triangles,
           modes[mode].name, fps, series_mad(&c->fps), modes[mode].goal, s->source[mode], fps / s->source[mode]);
    snprintf(what, sizeof what, "%s, frames a second", modes[mode].name);
    csv_row(out, s->name, size, what, &c->fps, "1/s");
    for (uint32_t i = 0; i < c->need.pass_count; i++) {
        printf("  %-22s %7.2f +- %.2f ms\n", c->need.passes[i], series_median(&c->pass_ms[i]), series_mad(&c->pass_ms[i]));
        snprintf(what, sizeof what, "%s, %s", modes[mode].name, c->need.passes[i]);
        csv_row(out, s->name, size, what, &c->pass_ms[i], "ms");
    }
}

int main(int argc, char **argv) {
    static contestant c[SCENES][MODES];
    csv out = csv_open("whitted");
    for (size_t i = 0; i < SCENES * MODES; i++) {
        const whitted_scene *s = &scenes[i / MODES];
        char path[BENCH_PATH];
        if ((argc > 1 && strncmp(modes[i % MODES].name, argv[1], strlen(argv[1])) != 0) || !bake(s, i % MODES, path))
            continue;
        open_pack(&c[i / MODES][i % MODES], path);
        verify(&c[i / MODES][i % MODES], s->name);
    }
    for (int round = 0; round < bench_rounds(ROUNDS); round++)
        for (size_t i = 0; i < SCENES * MODES; i++)
            if (c[i / MODES][i % MODES].v)
                round_of(&c[i / MODES][i % MODES]);
    for (size_t i = 0; i < SCENES * MODES; i++)
        if (c[i / MODES][i % MODES].v) {
            report(&out, &scenes[i / MODES], i % MODES, &c[i / MODES][i % MODES]);
            close_pack(&c[i / MODES][i % MODES]);
        }
    csv_close(&out, "whitted");
    return VIT_OK;
}
