/* What each effect costs and what it is worth: milliseconds of a frame, bytes of the device's buffers and error against the
 * path tracer, with the effect and with the pack's effects less it, on a scene that calls for it. A room, open at the front,
 * with three balls. */
#include "measure.h"

#include "cost/effect_cost.h"
#include "cost/images.h"
#include "reference/metrics.h"
#include "reference/reference.h"
#include "pack/pipeline.h"

enum {
    WIDTH = 320,
    HEIGHT = 240,
    SMOKE = 4 /* times smaller then */,
    EVERY = 5 /* no multiple of the sets of points on lights: each has its turn */,
    ROUNDS = 9,
    STEPS = 20
};

/* X(effect, light, materials of the balls, more of the scene, more of the quality block). */
#define LAMP "{ type = \"point\"; keys = ( { position = [0.2, 1.9, 0.9]; power = [30.0, 28.0, 24.0]; } ); }"
/* Behind the glass ball. Its photons are traced while playing, as those of lights that stand still are not. */
#define MOVING                                                                                                                 \
    "{ type = \"point\"; keys = ( { position = [0.6, 1.3, -0.8]; power = [30.0, 28.0, 24.0]; }, { time = 1.0; position = "     \
    "[0.6, 1.2, -0.8]; } ); }"
#define SPOTLIGHT                                                                                                              \
    "{ type = \"spot\"; inner = 20.0; outer = 35.0; keys = ( { position = [0.2, 1.9, 0.9]; target = [0.0, 0.3, 0.2]; power = " \
    "[30.0, 28.0, 24.0]; } ); }"
#define RANGED "{ type = \"point\"; range = 2.5; keys = ( { position = [0.2, 1.9, 0.9]; power = [30.0, 28.0, 24.0]; } ); }"
#define SUN                                                                                                                    \
    "{ type = \"directional\"; keys = ( { position = [0.5, 1.6, 2.0]; target = [0.0, 0.5, 0.0]; irradiance = [4.0, 3.8, "      \
    "3.2]; } ); }"
#define MATT "{ name = \"left\"; color = [0.6, 0.3, 0.2]; }, { name = \"right\"; color = [0.2, 0.4, 0.6]; }"
#define ROWS(X)                                                                                                                \
    X(INDIRECT, LAMP, MATT, "", "")                                                                                            \
    X(SMOOTH, LAMP, MATT, "", "")                                                                                              \
    X(TEXTURES, LAMP, MATT ", { name = \"floor\"; texture = \"wood.png\"; }", "", "")                                          \
    X(SPECULAR, LAMP,                                                                                                          \
      "{ name = \"left\"; color = [0.4, 0.2, 0.1]; specular = [0.4, 0.4, 0.4]; exponent = 40.0; },"                            \
      "{ name = \"right\"; color = [0.1, 0.2, 0.3]; specular = [0.5, 0.5, 0.5]; exponent = 200.0; }",                          \
      "", "")                                                                                                                  \
    X(GGX, LAMP,                                                                                                               \
      "{ name = \"left\"; color = [0.4, 0.2, 0.1]; specular = [0.4, 0.4, 0.4]; roughness = 0.3; },"                            \
      "{ name = \"right\"; color = [0.1, 0.2, 0.3]; specular = [0.5, 0.5, 0.5]; roughness = 0.6; }",                           \
      "", "")                                                                                                                  \
    X(NORMAL_MAPS, LAMP, MATT ", { name = \"floor\"; normal_map = \"wood.png\"; }", "", "")                                    \
    X(GLOSS, LAMP,                                                                                                             \
      "{ name = \"left\"; color = [0.4, 0.2, 0.1]; specular = [0.4, 0.4, 0.4]; roughness = 0.3; },"                            \
      "{ name = \"right\"; color = [0.1, 0.2, 0.3]; specular = [0.5, 0.5, 0.5]; roughness = 0.6; }",                           \
      "background = [0.8, 1.0, 1.3]; sky: { light = true; };", "")                                                             \
    X(MIRROR, LAMP, "{ name = \"left\"; kind = \"mirror\"; specular = [0.9, 0.9, 0.9]; }", "", "")                             \
    X(GLASS, LAMP, "{ name = \"right\"; kind = \"glass\"; ior = 1.5; absorption = [0.6, 0.3, 0.1]; }", "",                     \
      "caustics = false;")                                                                                                     \
    X(CAUSTICS, MOVING, "{ name = \"right\"; kind = \"glass\"; ior = 1.5; }", "",                                              \
      "photons = 100000; radius = 0.06; indirect_samples = 1;")                                                                \
    X(AREA_LIGHTS, "", MATT ", { name = \"lamp\"; emission = [20.0, 18.0, 15.0]; area_light = true; }", "", "")                \
    X(CUTOUT, LAMP, MATT ", { name = \"floor\"; texture = \"holes.tga\"; cutoff = 0.5; }", "", "")                             \
    X(EMISSION, LAMP, MATT ", { name = \"lamp\"; emission = [2.0, 1.8, 1.5]; area_light = false; }", "", "")                   \
    X(SPOT, SPOTLIGHT, MATT, "", "")                                                                                           \
    X(RANGE, RANGED, MATT, "", "")                                                                                             \
    X(SKY_IMAGE, LAMP, MATT, "sky: { image = \"sky.tga\"; light = false; };", "")                                              \
    X(DIRECTIONAL, SUN, MATT, "", "")                                                                                          \
    X(SKY_LIGHT, "", MATT, "background = [0.8, 1.0, 1.3]; sky: { light = true; };", "")                                        \
    X(AMBIENT, LAMP, MATT, "ambient = [0.1, 0.1, 0.12];", "")                                                                  \
    X(ANTIALIAS, LAMP, MATT, "", "antialias = 4;")

static const struct {
    const char *name;
    uint64_t effect;
    const char *lights, *materials, *scene, *quality;
} rows[] = {
#define X(macro, lights, materials, scene, quality) {#macro, VIT_BIT(macro), lights, materials, scene, quality},
    ROWS(X)
#undef X
};

static int width(void) {
    return bench_smoke() ? WIDTH / SMOKE : WIDTH;
}

static int height(void) {
    return bench_smoke() ? HEIGHT / SMOKE : HEIGHT;
}

/* A file of the bench's own. */
static void path_of(const char *name, char path[256]) {
    snprintf(path, 256, "%s/effects%s%s", bench_results(), name[0] ? "/" : "", name);
}

static FILE *create(const char *name) {
    char path[256];
    path_of(name, path);
    FILE *f = fopen(path, "w");
    if (!f)
        bench_fail("%s: %s", path, strerror(errno));
    return f;
}

/* A sphere of latitudes and longitudes, wound outwards, its vertices from number `first` on; returns the next one's. */
static int put_ball(FILE *f, const char *material, const double at[3], double radius, int first) {
    const double pi = 3.14159265358979324;
    const int row = 2 * STEPS + 1;
    fprintf(f, "usemtl %s\n", material);
    for (int i = 0; i <= STEPS; i++)
        for (int j = 0; j < row; j++) {
            const double a = pi * i / STEPS, b = pi * j / STEPS, n[3] = {sin(a) * cos(b), cos(a), sin(a) * sin(b)};
            fprintf(f, "v %.9g %.9g %.9g\nvn %.9g %.9g %.9g\n", at[0] + radius * n[0], at[1] + radius * n[1],
                    at[2] + radius * n[2], n[0], n[1], n[2]);
        }
    for (int i = 0; i < STEPS; i++)
        for (int j = 0; j + 1 < row; j++) {
            const int a = first + i * row + j, b = a + 1, c = a + row, d = c + 1;
            if (i > 0)
                fprintf(f, "f %d//%d %d//%d %d//%d\n", a, a, b, b, d, d);
            if (i + 1 < STEPS)
                fprintf(f, "f %d//%d %d//%d %d//%d\n", a, a, d, d, c, c);
        }
    return first + (STEPS + 1) * row;
}

static void write_meshes(void) {
    FILE *f = create("balls.obj");
    int next = put_ball(f, "left", (const double[]){-0.42, 0.35, 0.0}, 0.35, 1);
    next = put_ball(f, "right", (const double[]){0.45, 0.3, 0.3}, 0.3, next);
    put_ball(f, "left", (const double[]){0.1, 0.18, 0.75}, 0.18, next);
    fclose(f);
    f = create("room.obj");
    fputs("mtllib room.mtl\nv -1 0 -1\nv 1 0 -1\nv 1 0 1\nv -1 0 1\nv -1 2 -1\nv 1 2 -1\nv 1 2 1\nv -1 2 1\n"
          "v -0.3 1.98 -0.3\nv 0.3 1.98 -0.3\nv 0.3 1.98 0.3\nv -0.3 1.98 0.3\nvt 0 0\nvt 2 0\nvt 2 2\nvt 0 2\n"
          "usemtl floor\nf 4/1 3/2 2/3 1/4\nusemtl wall\nf 1/1 2/2 6/3 5/4\nusemtl red\nf 4/1 1/2 5/3 8/4\nusemtl green\nf 2/1 "
          "3/2 7/3 6/4\n"
          "usemtl lamp\nf 9/1 10/2 11/3 12/4\n",
          f);
    fclose(f);
    f = create("room.mtl");
    fputs("newmtl floor\nKd 0.7 0.7 0.7\nnewmtl wall\nKd 0.7 0.7 0.7\nnewmtl red\nKd 0.6 0.1 0.1\nnewmtl green\nKd 0.1 0.5 "
          "0.1\nnewmtl lamp\nKd 0.5 0.5 0.5\n",
          f);
    fclose(f);
}

/* A picture of 4 bytes per texel: bluish above and brown below, every other one a hole. */
static void write_picture_file(const char *name, int width, int height) {
    const unsigned char header[18] = {
        [2] = 2, [12] = (unsigned char)width, [14] = (unsigned char)height, [16] = 32, [17] = 0x28};
    FILE *f = create(name);
    fwrite(header, 1, sizeof header, f);
    for (int i = 0; i < width * height; i++) {
        const bool above = i < width * height / 2, hole = (i + i / width) % 2;
        const unsigned char texel[4] = {above ? 220 : 60, above ? 170 : 90, above ? 140 : 120, hole ? 0 : 255};
        fwrite(texel, 1, sizeof texel, f);
    }
    fclose(f);
}

static void write_scene(size_t i) {
    FILE *f = create("scene.cfg");
    fprintf(
        f,
        "output: { width = %d; height = %d; frames = 2; };\nmeshes = ( { file = \"room.obj\"; }, { file = \"balls.obj\"; } );\n"
        "camera: { keys = ( { eye = [0.0, 0.9, 3.3]; target = [0.0, 0.75, 0.0]; fov = 40.0; } ); };\nlights = ( %s );\n"
        "materials = ( %s );\n%s\nquality: { indirect = \"%s\"; bounces = 4; %s%s };\n",
        width(), height(), rows[i].lights, rows[i].materials, rows[i].scene,
        rows[i].effect == VIT_BIT(GLOSS) ? "basis" : "photons", /* with which there is none */
        strstr(rows[i].quality, "photons") ? "" : "photons = 20000; radius = 0.2; ", rows[i].quality);
    fclose(f);
}

#define TRY(call)                                                                                                              \
    do {                                                                                                                       \
        if ((call) != VIT_OK)                                                                                                  \
            bench_fail("%s: %s", rows[i].name, why.text);                                                                      \
    } while (0)

static float *render(const void *pack, size_t size, const images_grid *g, uint64_t *device_bytes) {
    vit_text why = {""};
    vit_requirements need;
    const vit_open_info how = {.pack = pack, .pack_size = size, .device = VIT_DEVICE_HOST};
    float *out = bench_array((size_t)images_across(g) * images_down(g) * 3, sizeof *out);
    if (vit_require(&how, &need, &why) != VIT_OK || images_render(&how, 0, g, out, NULL, &why) != VIT_OK)
        bench_fail("render: %s", why.text);
    *device_bytes = need.device_bytes;
    return out;
}

static void write_picture(const char *name, const char *what, const float *rgb, uint32_t width, uint32_t height) {
    char path[256];
    snprintf(path, sizeof path, "%s-%s.ppm", name, what);
    FILE *f = create(path);
    fprintf(f, "P6\n%u %u\n255\n", width, height);
    for (size_t i = 0; i < (size_t)width * height * 3; i++) {
        const double c = rgb[i] < 0 ? 0 : rgb[i] > 1 ? 1 : (double)rgb[i];
        fputc((int)(255 * (c <= 0.0031308 ? 12.92 * c : 1.055 * pow(c, 1 / 2.4) - 0.055) + 0.5), f);
    }
    fclose(f);
}

/* Frames of two packs in turns. */
typedef struct player {
    vit *v;
    void *arena;
    series ms;
} player;

static void player_open(player *p, const void *pack, size_t size) {
    vit_text why = {""};
    vit_requirements need;
    vit_open_info how = {.pack = pack, .pack_size = size, .device = bench_device()};
    memset(p, 0, sizeof *p);
    if (vit_require(&how, &need, &why) != VIT_OK)
        bench_fail("%s", why.text);
    how.arena = p->arena = aligned_alloc(64, (need.host_bytes + 63) / 64 * 64);
    how.arena_size = need.host_bytes;
    if (!p->arena || vit_open(&how, &p->v, &why) != VIT_OK)
        bench_fail("%s", why.text);
}

static void player_time(player *p, int keep) {
    vit_text why = {""};
    const double began = bench_seconds();
    if (vit_frame(p->v, 0, NULL, 0, &why) != VIT_OK)
        bench_fail("%s", why.text);
    if (keep)
        series_add(&p->ms, 1e3 * (bench_seconds() - began));
}

static void player_close(player *p) {
    vit_close(p->v);
    free(p->arena);
}

static void run(csv *c, size_t i) {
    progress silent = progress_make(true);
    pipeline p = {.device = VIT_DEVICE_HOST, .progress = &silent};
    pipeline_packed packed;
    vit_text why = {""};
    char path[256], size[32];
    write_scene(i); /* 1. the pack with the effect */
    path_of("scene.cfg", path);
    TRY(pipeline_read(path, &p.scene, &why));
    TRY(pipeline_load(&p, &why));
    const pipeline_choice choice = pipeline_default(&p);
    TRY(pipeline_pack(&p, &choice, &packed, &why));
    if (!(packed.plan.scene.effects & rows[i].effect))
        bench_fail("%s: its scene does not call for it: %s", rows[i].name, path);
    const uint64_t lamps = VIT_BIT(SPOT) | VIT_BIT(RANGE) | VIT_BIT(DIRECTIONAL); /* the scene's only light is such a one */
    const uint64_t dropped = rows[i].effect | (rows[i].effect & lamps ? VIT_BIT(LIGHTS) : 0);
    size_t less_size; /* 2. the pack without it */
    void *less = NULL;
    TRY(effect_cost_without(&packed.sections, dropped, &less, &less_size, &why));
    const images_grid grid = {(uint32_t)width(), (uint32_t)height(), EVERY};
    reference truth; /* 3. the path tracer's picture of the first */
    const reference_input in = {.sections = &packed.sections,
                                .every = EVERY,
                                .bounces = packed.plan.scene.bounces,
                                .target = 2e-4,
                                .max_samples = bench_smoke() ? 16 : 4096};
    TRY(reference_render(&in, &truth, &why));
    const size_t floats = (size_t)truth.width * truth.height * 3;
    uint64_t bytes[2]; /* 4. both pictures, and their errors */
    float *with = render(packed.bytes, packed.size, &grid, &bytes[0]), *bare = render(less, less_size, &grid, &bytes[1]);
    float *picture = bench_array(floats, sizeof *picture);
    double *whole = bench_array(floats, sizeof *whole);
    for (size_t k = 0; k < floats; k++)
        picture[k] = (float)(whole[k] = truth.direct[k] + truth.limited[k]);
    const cost_error a = metrics_compare(whole, with, NULL, truth.width, truth.height),
                     b = metrics_compare(whole, bare, NULL, truth.width, truth.height);
    write_picture(rows[i].name, "with", with, truth.width, truth.height);
    write_picture(rows[i].name, "without", bare, truth.width, truth.height);
    write_picture(rows[i].name, "reference", picture, truth.width, truth.height);
    player players[2]; /* 5. times, in turns */
    player_open(&players[0], packed.bytes, packed.size);
    player_open(&players[1], less, less_size);
    for (int round = -1; round < bench_rounds(ROUNDS); round++)
        for (int k = 0; k < 2; k++)
            player_time(&players[k], round >= 0);
    const double ms[2] = {series_median(&players[0].ms), series_median(&players[1].ms)};
    printf("%-12s %8.2f %8.2f %+8.2f %10.2f %+9.2f %9.5f %9.5f %+9.5f %+7.2f %9.5f\n", rows[i].name, ms[0], ms[1],
           ms[0] - ms[1], (double)bytes[0] * 1e-6, ((double)bytes[0] - (double)bytes[1]) * 1e-6, a.nmse, b.nmse,
           b.nmse - a.nmse, 100 * a.bias, truth.error);
    fflush(stdout); /* 6. the row as CSV */
    snprintf(size, sizeof size, "%dx%d", width(), height());
    csv_row(c, rows[i].name, size, "ms with", &players[0].ms, "ms");
    csv_row(c, rows[i].name, size, "ms without", &players[1].ms, "ms");
    const series exact[] = {series_exact((double)bytes[0]), series_exact((double)bytes[1]), series_exact(a.nmse),
                            series_exact(b.nmse)};
    csv_row(c, rows[i].name, size, "bytes with", &exact[0], "bytes");
    csv_row(c, rows[i].name, size, "bytes without", &exact[1], "bytes");
    csv_row(c, rows[i].name, size, "NMSE with", &exact[2], "");
    csv_row(c, rows[i].name, size, "NMSE without", &exact[3], "");
    for (int k = 0; k < 2; k++)
        player_close(&players[k]);
    reference_free(&truth);
    free(whole);
    free(picture);
    free(with);
    free(bare);
    free(less);
    pipeline_packed_free(&packed);
    pipeline_free(&p);
}

int main(int argc, char **argv) {
    csv c = csv_open("effects");
    char folder[256];
    path_of("", folder);
    bench_folder(folder);
    write_meshes();
    write_picture_file("holes.tga", 8, 8);
    write_picture_file("sky.tga", 64, 32);
    FILE *wood = fopen(VIT_BUILD_DIR "/scenes/wood.png", "rb"), *copy = create("wood.png");
    for (int byte; wood && (byte = fgetc(wood)) != EOF;)
        fputc(byte, copy);
    if (!wood || fclose(copy) != 0)
        bench_fail("wood.png cannot be copied");
    fclose(wood);
    printf("%-12s %8s %8s %8s %10s %9s %9s %9s %9s %7s %9s\n", "effect", "ms", "without", "adds", "MB", "adds", "NMSE",
           "without", "removed", "bias %", "reference");
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++)
        if (argc < 2 || strcmp(argv[1], rows[i].name) == 0)
            run(&c, i);
    csv_close(&c, "effects");
    return VIT_OK;
}
