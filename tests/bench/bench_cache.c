/* Ambient occlusion by the world-space cache against plain rays and against fixed voxels, on Sponza and our atrium and rooms,
 * one still view each: error of all ambient light against 2048 rays a pixel, and CPU time.
 *
 * Both sides are kernels compiled as C on one thread (tests/host_lab.h), in turns: the cache's look-up (cache_open) and packets
 * of shadow rays (ray_occluded), whose directions cost nothing here. Progressive frames are played. Pictures lie side by side
 * in build/bench/cache-NAME.ppm: rays, baked, progressive after 1 and 64 frames, voxels. Sponza is left out where it is not
 * there. */
#include "baselines/voxel_cache.h"
#include "common/parallel.h"
#include "cost/effect_cost.h"
#include "host_lab.h"
#include "pack/opened.h"
#include "pack/pipeline.h"
#include "scenes.h"
#include <sys/resource.h>

enum { FRAMES = 64, TRUTH = 2048, MOST_RAYS = 1024, PICTURES = 5 };

typedef struct view {
    const char *name, *mesh, *camera;
    double radius;
    bool own;
} view;

static const view views[] = {
    {"rooms", "rooms.obj", "eye = [3.6, 1.6, 1.6]; target = [0.3, 1.1, -0.3]; fov = 65.0;", 1.0, true},
    {"atrium", "atrium.obj", "eye = [-9.6, 1.7, 1.7]; target = [2.0, 3.3, -0.9]; fov = 62.0;", 1.5, true},
    {"sponza", "sponza/sponza.gltf", "eye = [-10.0, 2.0, -0.5]; target = [5.0, 4.0, -0.5]; fov = 60.0;", 1.5, false},
};

typedef struct lab {
    const view *of;
    pipeline p;
    uint32_t width, height, frames, truth_rays;
    cache_sights sights;
    photon_rays rays;
    photon_scene scene;
    float *truth, *other, *planes, *ray_planes;
    float *picture[PICTURES];
} lab;

static vit_text why;

static void must(vit_status status) {
    if (status != VIT_OK)
        bench_fail("%s", why.text);
}

static bool write_scene(lab *l, const char *cache, char path[BENCH_PATH]) {
    char mesh[BENCH_PATH];
    const bench_scene s = {.name = l->of->name, .mesh = l->of->mesh, .own = l->of->own};
    if (!scene_mesh_path(&s, mesh))
        return false;
    snprintf(path, BENCH_PATH, "%s/cache-%s.cfg", bench_results(), l->of->name);
    FILE *f = fopen(path, "w");
    if (!f)
        bench_fail("%s: %s", path, strerror(errno));
    fprintf(f,
            "output: { width = %u; height = %u; frames = %u; };\nmeshes = ( { file = \"%s\"; } );\nambient = [1.0, 1.0, 1.0];\n"
            "ambient_radius = %g;\ncamera: { keys = ( { %s } ); };\nquality: { cache = \"%s\"; %s };\n",
            l->width, l->height, l->frames, mesh, l->of->radius, l->of->camera, cache,
            bench_smoke() ? "cache_error = 0.2;" : "cache_error = 0.01;");
    fclose(f);
    return true;
}

static float open_by_rays(const lab *l, uint32_t place, uint32_t count, uint32_t seed) {
    const cache_sight *s = &l->sights.sight[place];
    const uint32_t shift = pcg(place ^ seed), other = pcg(shift);
    uint32_t open = 0;
    for (uint32_t i = 0; i < count; i++) {
        const vec3 d = vec3_cosine(s->normal, lattice_u(i, shift), lattice_v(i, other));
        open += vec3_dot(s->face, d) > 0.0f && !photon_rays_occluded(&l->rays, s->position, d, (float)l->of->radius);
    }
    return (float)open / (float)count;
}

static void ask(void *user, uint32_t place) {
    lab *l = user;
    l->truth[place] = open_by_rays(l, place, l->truth_rays, 1);
}

static double error_of(const lab *l, const float *got) {
    double sum = 0;
    for (uint32_t i = 0; i < l->sights.count; i++)
        sum += ((double)got[i] - (double)l->truth[i]) * ((double)got[i] - (double)l->truth[i]);
    return sqrt(sum / l->sights.count);
}

/* Of this process: clocks say little where others work too. */
static double cpu_ms(void) {
    struct rusage u;
    getrusage(RUSAGE_SELF, &u);
    return 1e3 * (double)(u.ru_utime.tv_sec + u.ru_stime.tv_sec) + 1e-3 * (double)(u.ru_utime.tv_usec + u.ru_stime.tv_usec);
}

/* For a ray a pixel, ms. */
static double time_rays(lab *l, const host_lab_mesh *m, uint32_t n) {
    uint32_t *occluded = bench_array(n, sizeof *occluded);
    for (uint32_t i = 0; i < n; i++) {
        const cache_sight *s = &l->sights.sight[i < l->sights.count ? i : 0];
        const vec3 d = vec3_cosine(s->normal, unit_float(pcg(i)), unit_float(pcg(i + n)));
        const float plane[7] = {s->position.x, s->position.y, s->position.z, d.x, d.y, d.z, (float)l->of->radius};
        for (uint32_t k = 0; k < 7; k++)
            l->ray_planes[(size_t)k * n + i] = plane[k];
    }
    const double began = cpu_ms();
    host_lab_find()->occluded(m, l->ray_planes, n, occluded);
    const double ms = cpu_ms() - began;
    free(occluded);
    return ms;
}

static double time_cache(lab *l, const pipeline_packed *packed, uint32_t n) {
    for (uint32_t i = 0; i < n; i++) {
        const cache_sight *s = &l->sights.sight[i < l->sights.count ? i : 0];
        const float plane[7] = {s->position.x, s->position.y, s->position.z, s->normal.x,
                                s->normal.y,   s->normal.z,   s->distance};
        for (uint32_t k = 0; k < 7; k++)
            l->planes[(size_t)k * n + i] = plane[k];
    }
    const double began = cpu_ms();
    host_lab_find()->open(&packed->plan.scene, packed->occlusion.table.records, NULL, l->planes, n, l->other);
    return cpu_ms() - began;
}

/* The pixel that a place is seen at: p = eye + t corner + t x right + t y down. */
static uint32_t pixel_of(const lab *l, const cache_sight *s) {
    const vit_camera *c = l->p.tracks.cameras;
    const vec3 a = vec3_load(c->corner), b = vec3_load(c->right), d = vec3_load(c->down),
               p = vec3_sub(s->position, vec3_load(c->eye));
    const vec3 bd = {b.y * d.z - b.z * d.y, b.z * d.x - b.x * d.z, b.x * d.y - b.y * d.x};
    const vec3 ad = {a.y * d.z - a.z * d.y, a.z * d.x - a.x * d.z, a.x * d.y - a.y * d.x};
    const vec3 ab = {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
    const float t = vec3_dot(p, bd), x = -vec3_dot(p, ad) / t, y = vec3_dot(p, ab) / t;
    return (uint32_t)y * l->width + (uint32_t)x;
}

/* Green light of a frame's pixels. */
static void play(const void *pack, size_t size, uint32_t frame, float *out, uint32_t pixels) {
    opened o;
    const vit_open_info how = {.pack = pack, .pack_size = size, .device = VIT_DEVICE_HOST, .format = VIT_FORMAT_RGBA32F};
    must(opened_begin(&how, &o, &why));
    must(opened_frame(&o, frame, &why));
    for (uint32_t i = 0; i < pixels; i++)
        out[i] = ((const float *)(const void *)o.frame)[4 * (size_t)i + 1];
    opened_end(&o);
}

static void report(const lab *l, csv *out, const char *what, double error, double ms) {
    series s = {0};
    char time[32] = "";
    if (ms > 0)
        snprintf(time, sizeof time, "%9.2f ms", ms);
    printf("%-8s %-24s off by %.4f  %s\n", l->of->name, what, error, time);
    series_add(&s, error);
    csv_row(out, l->of->name, "320x240", what, &s, "error");
    if (!isfinite(error) || !(error < 1))
        bench_fail("%s, %s: the error is %g", l->of->name, what, error);
}

/* Open parts are a frame's light over that of the same pack without occlusion; where that is black nothing is compared. */
static void progressive(lab *l, csv *out) {
    char path[BENCH_PATH], what[32];
    pipeline p = {.progress = l->p.progress};
    pipeline_packed packed;
    void *bare = NULL;
    size_t bare_size;
    const uint32_t pixels = l->width * l->height;
    float *light = bench_array(pixels, sizeof *light), *plain = bench_array(pixels, sizeof *plain);
    (void)write_scene(l, "progressive", path);
    must(pipeline_read(path, &p.scene, &why));
    must(pipeline_load(&p, &why));
    const pipeline_choice choice = pipeline_default(&p);
    must(pipeline_pack(&p, &choice, &packed, &why));
    must(effect_cost_without(&packed.sections, VIT_BIT(OCCLUSION), &bare, &bare_size, &why));
    play(bare, bare_size, 0, plain, pixels);
    for (uint32_t frames = 1; frames <= l->frames; frames *= 4) {
        play(packed.bytes, packed.size, frames - 1, light, pixels);
        float *got = l->picture[frames == 1 ? 2 : 3];
        for (uint32_t i = 0; i < l->sights.count; i++) {
            const uint32_t at = pixel_of(l, &l->sights.sight[i]);
            got[i] = at < pixels && plain[at] > 0.0f ? light[at] / plain[at] : l->truth[i];
        }
        snprintf(what, sizeof what, "progressive, %u frames", frames);
        report(l, out, what, error_of(l, got), 0);
    }
    free(bare);
    pipeline_packed_free(&packed);
    pipeline_free(&p);
    free(light);
    free(plain);
}

/* Rays a pixel whose error is as small as `known`: between numbers that were tried on a line in logarithms. */
static double rays_as_good(lab *l, double known, double ray, csv *out) {
    double needed = 0, error = 0, last = 0;
    char what[48];
    for (uint32_t rays = 1; rays <= MOST_RAYS / (bench_smoke() ? 16 : 1); rays *= 4) {
        for (uint32_t i = 0; i < l->sights.count; i++)
            l->other[i] = open_by_rays(l, i, rays, 2);
        error = error_of(l, l->other);
        snprintf(what, sizeof what, "%u rays a pixel", rays);
        report(l, out, what, error, ray * rays);
        if (needed == 0 && error <= known)
            needed = rays == 1 ? 1 : rays / 4.0 * pow(last / known, log(4.0) / log(last / error));
        last = error;
    }
    return needed;
}

static void against_rays(lab *l, const pipeline_packed *packed, csv *out) {
    const host_lab_mesh m = {&packed->plan.scene, packed->geometry->triangles, packed->geometry->attributes,
                             packed->plan.materials, packed->bvh->nodes};
    const uint32_t n = (l->sights.count + HOST_LAB_LANES - 1) / HOST_LAB_LANES * HOST_LAB_LANES;
    series ray = {0}, look = {0}, ratio = {0};
    for (int round = 0; round < bench_rounds(9); round++) { /* in turns */
        series_add(&ray, time_rays(l, &m, n));
        series_add(&look, time_cache(l, packed, n));
        series_add(&ratio, ray.value[round] / look.value[round]);
    }
    memcpy(l->picture[1], l->other, l->sights.count * sizeof *l->other);
    const double known = error_of(l, l->other), times = series_median(&ratio);
    report(l, out, "baked", known, series_median(&look));
    const double needed = rays_as_good(l, known, series_median(&ray), out);
    printf("%-8s a ray a pixel takes %.2f times a look-up (deviation %.2f): at equal time %.2f rays a pixel\n", l->of->name,
           times, series_mad(&ratio), 1 / times);
    if (needed > 0)
        printf("%-8s at equal error: %.0f rays a pixel, %.0f times the time of the cache\n", l->of->name, needed,
               needed * times);
    else
        printf("%-8s at equal error: more than %d rays a pixel\n", l->of->name, MOST_RAYS);
}

static void voxels(lab *l, const pipeline_packed *packed, csv *out) {
    voxel_cache c = {0};
    if (!voxel_cache_fill(&packed->plan.scene, &l->sights, l->truth, &c))
        bench_fail("out of memory");
    for (uint32_t i = 0; i < l->sights.count; i++)
        l->picture[4][i] = (float)voxel_cache_read(&packed->plan.scene, &c, &l->sights.sight[i]);
    report(l, out, "fixed voxels", error_of(l, l->picture[4]), 0);
    free(c.slots);
}

static void write_pictures(const lab *l) {
    char path[BENCH_PATH];
    const uint32_t w = l->width, h = l->height;
    uint8_t *row = bench_array((size_t)w * h * PICTURES, 3);
    memset(row, 60, (size_t)w * h * PICTURES * 3);
    for (uint32_t i = 0; i < l->sights.count; i++) {
        const uint32_t at = pixel_of(l, &l->sights.sight[i]);
        for (uint32_t k = 0; k < PICTURES && at < w * h; k++)
            memset(row + ((size_t)(at / w) * w * PICTURES + k * w + at % w) * 3,
                   (int)(255 * pow(fmin(fmax((double)l->picture[k][i], 0), 1), 1 / 2.2)), 3);
    }
    snprintf(path, sizeof path, "%s/cache-%s.ppm", bench_results(), l->of->name);
    FILE *f = fopen(path, "wb");
    if (!f)
        bench_fail("%s: %s", path, strerror(errno));
    fprintf(f, "P6\n%u %u\n255\n", w * PICTURES, h);
    fwrite(row, 3, (size_t)w * h * PICTURES, f);
    fclose(f);
    free(row);
}

static void run(const view *v, progress *shown, csv *out) {
    char path[BENCH_PATH];
    lab l = {.of = v, .p = {.progress = shown}, .width = 320, .height = 240, .frames = FRAMES, .truth_rays = TRUTH};
    pipeline_packed packed;
    if (bench_smoke()) {
        l.width = l.height = 48;
        l.frames = 4;
        l.truth_rays = 64;
    }
    if (!write_scene(&l, "baked", path))
        return;
    must(pipeline_read(path, &l.p.scene, &why));
    l.p.scene.frames = 1;
    must(pipeline_load(&l.p, &why));
    const pipeline_choice choice = pipeline_default(&l.p);
    must(pipeline_pack(&l.p, &choice, &packed, &why));
    l.scene = (photon_scene){.triangles = packed.geometry->triangles,
                             .attributes = packed.geometry->attributes,
                             .triangle_count = packed.model->triangles,
                             .materials = packed.plan.materials,
                             .atlas = &l.p.atlas,
                             .ray_offset = packed.geometry->ray_offset,
                             .box_pad = packed.plan.scene.box_pad,
                             .effects = packed.plan.scene.effects};
    if (!photon_rays_open(&l.scene, 0, &l.rays))
        bench_fail("Embree fails");
    const cache_sights_input in = {
        .rays = &l.rays, .tracks = &packed.tracks, .frames = 1, .width = l.width, .height = l.height};
    must(cache_sights_find(&in, &l.sights, &why));
    const uint32_t n = l.sights.count + HOST_LAB_LANES;
    l.truth = l.picture[0] = bench_array(n, sizeof(float));
    l.other = bench_array(n, sizeof(float));
    l.planes = bench_array(7 * (size_t)n, sizeof(float));
    l.ray_planes = bench_array(7 * (size_t)n, sizeof(float));
    for (int k = 1; k < PICTURES; k++)
        l.picture[k] = bench_array(n, sizeof(float));
    parallel_for(0, l.sights.count, ask, &l);
    printf("%-8s %u triangles, %u places; table %zu bytes, %u cells, baked in %.1f s\n", v->name, packed.model->triangles,
           l.sights.count, packed.occlusion.table.count * sizeof *packed.occlusion.table.records, packed.occlusion.cells,
           packed.occlusion.seconds);
    against_rays(&l, &packed, out);
    voxels(&l, &packed, out);
    progressive(&l, out);
    write_pictures(&l);
    for (int k = 0; k < PICTURES; k++)
        free(l.picture[k]);
    free(l.other);
    free(l.planes);
    free(l.ray_planes);
    photon_rays_close(&l.rays);
    cache_sights_free(&l.sights);
    pipeline_packed_free(&packed);
    pipeline_free(&l.p);
}

int main(int argc, char **argv) {
    progress shown = progress_make(true);
    csv out = csv_open("cache");
    for (size_t i = 0; i < sizeof views / sizeof *views; i++)
        if (argc > 1 ? strcmp(argv[1], views[i].name) == 0 : !bench_smoke() || views[i].own)
            run(&views[i], &shown, &out);
    csv_close(&out, "cache");
    return VIT_OK;
}
