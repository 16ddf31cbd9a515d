/* Would the world-space cache help with the soft shadow of an area light that moves? Its points would keep the part of the
 * light that is seen from them, as an average over frames of which what was found h frames ago counts half.
 *
 * Offline: cells are those of a progressive cache, points are filled by a ray from each view sample as kernels/cache.cl fills
 * them, averages fade, and cache_open() reads them. Beside it rays to points of the light, n a view sample, by themselves and
 * as the mean of 4 x 4 pixels on one plane. Error: root of the mean square of the part that is seen, over the places that face
 * the light, in frames of a lamp on a track, against 256 rays; what rays take as long follows from CPU time in turns.
 *
 * bench_cache_moving [SCENE...] */
#include "common/parallel.h"
#include "cache/points.h"
#include "host_lab.h"
#include "pack/pipeline.h"
#include "scenes.h"
#include <sys/resource.h>

enum { WIDTH = 240, HEIGHT = 176, FRAMES = 48, TRUTH = 256, LIVES = 5, MOST_PLACES = WIDTH * HEIGHT, BLOCK = 4 };
#define EACH 4.0f  /* of a counted ray in the words that cache_open() reads */
#define TARGET 0.3 /* of a look-up's time: what finding a ray's point takes (kernels/cache.cl, measured in frames) */

static const double lives[LIVES] = {1, 2, 4, 8, INFINITY};

typedef struct view {
    const char *name, *mesh, *camera;
    float from[3], to[3], edge; /* of the lamp's middle; m. It is square and lies flat. */
    bool own;
} view;

static const view views[] = {
    {"rooms",
     "rooms.obj",
     "eye = [3.6, 1.6, 1.6]; target = [0.3, 1.1, -0.3]; fov = 65.0;",
     {1, 2, -1},
     {3, 2, 0.7f},
     0.4f,
     true},
    {"atrium",
     "atrium.obj",
     "eye = [-9.6, 1.7, 1.7]; target = [2.0, 3.3, -0.9]; fov = 62.0;",
     {-6, 3, 0},
     {-4, 3, 0},
     0.5f,
     true},
    {"sponza",
     "sponza/sponza.gltf",
     "eye = [-10.0, 2.0, -0.5]; target = [5.0, 4.0, -0.5]; fov = 60.0;",
     {-6, 3, -1},
     {-4, 3, 0},
     0.5f,
     false},
};

typedef struct lab {
    const view *of;
    pipeline p;
    pipeline_packed packed;
    cache_sights sights;
    photon_rays rays;
    photon_scene scene;
    vec3 lamp; /* this frame's */
    uint32_t frame, count;
    float *truth, *got, *planes, *rays_planes;
    float *sum[LIVES]; /* 2 a point: rays, those that saw the light */
    uint32_t *counts;
} lab;

static vit_text why;

static void must(vit_status status) {
    if (status != VIT_OK)
        bench_fail("%s", why.text);
}

static void open_scene(lab *l) {
    char path[BENCH_PATH], mesh[BENCH_PATH];
    const bench_scene s = {.name = l->of->name, .mesh = l->of->mesh, .own = l->of->own};
    if (!scene_mesh_path(&s, mesh))
        bench_fail("%s is not there", l->of->mesh);
    snprintf(path, BENCH_PATH, "%s/cache-moving.cfg", bench_results());
    FILE *f = fopen(path, "w");
    if (!f)
        bench_fail("%s: %s", path, strerror(errno));
    fprintf(f,
            "output: { width = %d; height = %d; frames = 1; };\nmeshes = ( { file = \"%s\"; } );\nambient = [1.0, 1.0, 1.0];\n"
            "ambient_radius = 1.5;\ncamera: { keys = ( { %s } ); };\nquality: { cache = \"progressive\"; };\n",
            WIDTH, HEIGHT, mesh, l->of->camera);
    fclose(f);
    must(pipeline_read(path, &l->p.scene, &why));
    must(pipeline_load(&l->p, &why));
    const pipeline_choice choice = pipeline_default(&l->p);
    must(pipeline_pack(&l->p, &choice, &l->packed, &why));
    l->scene = (photon_scene){.triangles = l->packed.geometry->triangles,
                              .attributes = l->packed.geometry->attributes,
                              .triangle_count = l->packed.model->triangles,
                              .materials = l->packed.plan.materials,
                              .atlas = &l->p.atlas,
                              .ray_offset = l->packed.geometry->ray_offset,
                              .box_pad = l->packed.plan.scene.box_pad,
                              .effects = l->packed.plan.scene.effects};
    if (!photon_rays_open(&l->scene, 0, &l->rays))
        bench_fail("Embree fails");
    const cache_sights_input in = {
        .rays = &l->rays, .tracks = &l->packed.tracks, .frames = 1, .width = WIDTH, .height = HEIGHT};
    must(cache_sights_find(&in, &l->sights, &why));
    l->count = (l->sights.count + HOST_LAB_LANES - 1) / HOST_LAB_LANES * HOST_LAB_LANES;
}

/* The way to a point of the lamp; false: the place does not face it. */
static bool way_to(const lab *l, const cache_sight *s, float u, float v, vec3 *d, float *length) {
    const vec3 at = {l->lamp.x + (u - 0.5f) * l->of->edge, l->lamp.y, l->lamp.z + (v - 0.5f) * l->of->edge},
               way = vec3_sub(at, s->position);
    *length = sqrtf(vec3_dot(way, way));
    *d = vec3_scale(way, 1.0f / *length);
    return vec3_dot(s->normal, *d) > 0.0f && vec3_dot(s->face, *d) > 0.0f && way.y > 0.0f;
}

static bool faces(const lab *l, uint32_t i) {
    vec3 d;
    float length;
    return way_to(l, l->sights.sight + i, 0.5f, 0.5f, &d, &length);
}

static float seen_by(const lab *l, uint32_t i, uint32_t n, uint32_t seed) {
    const cache_sight *s = l->sights.sight + i;
    const uint32_t shift = pcg(i ^ pcg(seed)), other = pcg(shift);
    uint32_t seen = 0;
    for (uint32_t k = 0; k < n; k++) {
        vec3 d;
        float length;
        seen += way_to(l, s, lattice_u(k, shift), lattice_v(k, other), &d, &length) &&
                !photon_rays_occluded(&l->rays, s->position, d, length);
    }
    return (float)seen / (float)n;
}

typedef struct seeing {
    const lab *l;
    uint32_t rays, seed;
    float *out;
} seeing;

static void see_one(void *user, uint32_t i) {
    const seeing *w = user;
    w->out[i] = faces(w->l, i) ? seen_by(w->l, i, w->rays, w->seed) : NAN;
}

static void see(const lab *l, uint32_t rays, uint32_t seed, float *out) {
    seeing w = {l, rays, seed, out};
    parallel_for(0, l->sights.count, see_one, &w);
}

/* Record times VIT_CACHE_POINTS plus point, as cache_target() of kernels/cache.cl chooses; VIT_NONE: none. */
static uint32_t target_of(const lab *l, const cache_sight *s, uint32_t random) {
    const vit_scene *c = &l->packed.plan.scene;
    const float p[3] = {s->position.x, s->position.y, s->position.z}, n[3] = {s->normal.x, s->normal.y, s->normal.z};
    float next, best[3] = {64, 64, 64}, share[3], u = unit_float(pcg(random + 1u));
    uint32_t level = cache_level(c, s->distance, &next), seeds[3] = {0}, tags[3] = {0}, q[3] = {0};
    level += unit_float(pcg(random)) < next;
    const cache_place at = cache_place_of(p, 1.0f / c->cache_step / (float)(1u << level));
    for (int k = 0; k < 3; k++)
        share[k] = cache_share(n[k]);
    u *= share[0] + share[1] + share[2];
    const int axis = u < share[0] ? 0 : u < share[0] + share[1] ? 1 : 2;
    for (int box = 0; box < 27; box++) {
        const int by[3] = {box % 3 - 1, box / 3 % 3 - 1, box / 9 - 1};
        int32_t cell[3];
        uint32_t point = 0;
        for (int k = 0; k < 3; k++) {
            cell[k] = cache_half(at.box[k] + by[k]);
            point |= ((uint32_t)(at.box[k] + by[k]) & 1u) << k;
        }
        uint32_t seed = cache_seed(cell, level), tag = cache_tag(cell);
        float d2 = cache_distance2(&at, by, pcg(seed + point));
        for (int k = 0; k < 3; k++)
            if (d2 < best[k]) {
                const float d = best[k];
                const uint32_t other[3] = {seeds[k], tags[k], q[k]};
                best[k] = d2;
                seeds[k] = seed;
                tags[k] = tag;
                q[k] = point;
                d2 = d;
                seed = other[0];
                tag = other[1];
                point = other[2];
            }
    }
    const float first = best[1] * best[2], second = best[0] * best[2], all = first + second + best[0] * best[1],
                v = unit_float(pcg(random + 2u)) * all;
    const int chosen = v < first || !(all > 0.0f) ? 0 : v < first + second ? 1 : 2;
    const uint32_t key = cache_key(seeds[chosen], 2 * (uint32_t)axis + (n[axis] < 0.0f)),
                   record = cache_table_find(&l->packed.occlusion.table, key, tags[chosen]);
    return record == VIT_NONE ? VIT_NONE : record * VIT_CACHE_POINTS + q[chosen];
}

/* A frame's rays, one a place, into all averages. */
static void fill(lab *l) {
    const uint32_t points = l->packed.occlusion.table.count * VIT_CACHE_POINTS;
    see(l, 1, 1000 + l->frame, l->got);
    for (int h = 0; h < LIVES; h++)
        for (uint32_t i = 0; i < 2 * points; i++)
            l->sum[h][i] *= (float)pow(0.5, 1 / lives[h]);
    for (uint32_t i = 0; i < l->sights.count; i++) {
        const uint32_t to = isnan(l->got[i]) ? VIT_NONE : target_of(l, l->sights.sight + i, pcg(i + pcg(l->frame)));
        for (int h = 0; h < LIVES && to != VIT_NONE; h++) {
            l->sum[h][2 * (size_t)to] += 1;
            l->sum[h][2 * (size_t)to + 1] += l->got[i];
        }
    }
}

static void put_planes(lab *l) {
    for (uint32_t i = 0; i < l->count; i++) {
        const cache_sight *s = &l->sights.sight[i < l->sights.count ? i : 0];
        vec3 d;
        float length;
        (void)way_to(l, s, unit_float(pcg(i)), unit_float(pcg(i + 77u)), &d, &length);
        const float place[7] = {s->position.x, s->position.y, s->position.z, s->normal.x,
                                s->normal.y,   s->normal.z,   s->distance},
                    ray[7] = {s->position.x, s->position.y, s->position.z, d.x, d.y, d.z, length};
        for (uint32_t k = 0; k < 7; k++) {
            l->planes[(size_t)k * l->count + i] = place[k];
            l->rays_planes[(size_t)k * l->count + i] = ray[k];
        }
    }
}

static void look_up(lab *l, int life) {
    const uint32_t points = l->packed.occlusion.table.count * VIT_CACHE_POINTS;
    for (uint32_t i = 0; i < points; i++) {
        const float *s = l->sum[life] + 2 * (size_t)i, scale = fminf(EACH, 65535.0f / fmaxf(s[0], 1.0f));
        l->counts[i] = (uint32_t)lrintf(s[0] * scale) | (uint32_t)lrintf(s[1] * scale) << 16;
    }
    host_lab_find()->open(&l->packed.plan.scene, l->packed.occlusion.table.records, l->counts, l->planes, l->count, l->got);
}

static double error_of(const lab *l, const float *got) {
    double sum = 0, count = 0;
    for (uint32_t i = 0; i < l->sights.count; i++)
        if (isfinite(l->truth[i]) && isfinite(got[i])) {
            sum += ((double)got[i] - (double)l->truth[i]) * ((double)got[i] - (double)l->truth[i]);
            count++;
        }
    return sqrt(sum / count);
}

/* Means over the places of 4 x 4 neighbours that lie on one plane. Sights are a picture's, if all of it is seen. */
static void filter(const lab *l, const float *in, float *out) {
    for (uint32_t i = 0; i < l->sights.count; i++) {
        const cache_sight *s = l->sights.sight + i;
        double sum = 0, count = 0;
        for (int dy = -BLOCK / 2; dy < BLOCK / 2; dy++)
            for (int dx = -BLOCK / 2; dx < BLOCK / 2; dx++) {
                const int64_t j = (int64_t)i + dy * WIDTH + dx;
                if (j < 0 || j >= l->sights.count || !isfinite(in[j]))
                    continue;
                const cache_sight *o = l->sights.sight + j;
                const vec3 way = vec3_sub(o->position, s->position);
                if (vec3_dot(o->normal, s->normal) < 0.99f || fabsf(vec3_dot(way, s->normal)) > 0.002f * s->distance)
                    continue;
                sum += (double)in[j];
                count++;
            }
        out[i] = count > 0 ? (float)(sum / count) : in[i];
    }
}

static double cpu_ms(void) {
    struct rusage u;
    getrusage(RUSAGE_SELF, &u);
    return 1e3 * (double)(u.ru_utime.tv_sec + u.ru_stime.tv_sec) + 1e-3 * (double)(u.ru_utime.tv_usec + u.ru_stime.tv_usec);
}

/* Rays a view sample that take as long as a frame of the cache: a ray, its point, a look-up. */
static double equal_rays(lab *l) {
    const host_lab_mesh m = {&l->packed.plan.scene, l->packed.geometry->triangles, l->packed.geometry->attributes,
                             l->packed.plan.materials, l->packed.bvh->nodes};
    uint32_t *occluded = bench_array(l->count, sizeof *occluded);
    series ratio = {0};
    look_up(l, 0);
    for (int round = 0; round < bench_rounds(9); round++) { /* in turns */
        const double a = cpu_ms();
        host_lab_find()->occluded(&m, l->rays_planes, l->count, occluded);
        const double b = cpu_ms();
        host_lab_find()->open(&l->packed.plan.scene, l->packed.occlusion.table.records, l->counts, l->planes, l->count, l->got);
        series_add(&ratio, (cpu_ms() - b) / (b - a));
    }
    free(occluded);
    return 1 + (1 + TARGET) * series_median(&ratio);
}

static void put(csv *out, const lab *l, const char *what, double error) {
    const series s = series_exact(error);
    printf("%-8s %-40s off by %.4f\n", l->of->name, what, error);
    csv_row(out, l->of->name, "240x176", what, &s, "error");
    if (!(error < 1))
        bench_fail("%s, %s: the error is %g", l->of->name, what, error);
}

static double play(lab *l, uint32_t frames, double error[LIVES], double plain[4][2]) {
    static const uint32_t rays[4] = {1, 2, 4, 16};
    double looks = 0;
    float *other = bench_array(MOST_PLACES, sizeof *other), *mean = bench_array(MOST_PLACES, sizeof *mean);
    for (l->frame = 0; l->frame < frames; l->frame++) {
        const float t = (float)l->frame / (float)(frames - 1);
        const vec3 a = vec3_load(l->of->from), b = vec3_load(l->of->to);
        l->lamp = vec3_along(a, vec3_sub(b, a), t);
        fill(l);
        if (l->frame < frames / 2 || l->frame % (frames / 4) != frames / 4 - 1)
            continue;
        looks++;
        see(l, bench_smoke() ? TRUTH / 16 : TRUTH, 1, l->truth);
        put_planes(l);
        for (int h = 0; h < LIVES; h++) {
            look_up(l, h);
            error[h] += error_of(l, l->got);
        }
        for (int k = 0; k < 4; k++) {
            see(l, rays[k], 2 + l->frame, other);
            filter(l, other, mean);
            plain[k][0] += error_of(l, other);
            plain[k][1] += error_of(l, mean);
        }
    }
    free(other);
    free(mean);
    return looks;
}

static void run(const view *v, progress *shown, csv *out) {
    lab l = {.of = v, .p = {.progress = shown}};
    open_scene(&l);
    const size_t points = (size_t)l.packed.occlusion.table.count * VIT_CACHE_POINTS;
    l.truth = bench_array(l.count, sizeof *l.truth);
    l.got = bench_array(l.count, sizeof *l.got);
    l.planes = bench_array(7 * (size_t)l.count, sizeof *l.planes);
    l.rays_planes = bench_array(7 * (size_t)l.count, sizeof *l.rays_planes);
    l.counts = bench_array(points, sizeof *l.counts);
    for (int h = 0; h < LIVES; h++)
        l.sum[h] = bench_array(2 * points, sizeof *l.sum[h]);
    for (int slow = 0; slow < (bench_smoke() ? 1 : 2); slow++) {
        double error[LIVES] = {0}, plain[4][2] = {{0}};
        for (int h = 0; h < LIVES; h++)
            memset(l.sum[h], 0, 2 * points * sizeof *l.sum[h]);
        const double looks = play(&l, slow ? FRAMES : FRAMES / 4, error, plain);
        char what[64];
        for (int h = 0; h < LIVES; h++) {
            snprintf(what, sizeof what, "%d frames a way, half-life %g", slow ? FRAMES : FRAMES / 4, lives[h]);
            put(out, &l, what, error[h] / looks);
        }
        for (int k = 0; k < 4; k++) {
            snprintf(what, sizeof what, "%d rays a sample", k == 3 ? 16 : 1 << k);
            put(out, &l, what, plain[k][0] / looks);
            snprintf(what, sizeof what, "%d rays a sample, 4 x 4 pixels", k == 3 ? 16 : 1 << k);
            put(out, &l, what, plain[k][1] / looks);
        }
    }
    printf("%-8s a frame of the cache takes as long as %.1f rays a sample\n", v->name, equal_rays(&l));
    for (int h = 0; h < LIVES; h++)
        free(l.sum[h]);
    free(l.counts);
    free(l.truth);
    free(l.got);
    free(l.planes);
    free(l.rays_planes);
    photon_rays_close(&l.rays);
    cache_sights_free(&l.sights);
    pipeline_packed_free(&l.packed);
    pipeline_free(&l.p);
    fflush(stdout);
}

int main(int argc, char **argv) {
    progress shown = progress_make(true);
    csv out = csv_open("cache_moving");
    for (size_t i = 0; i < sizeof views / sizeof *views; i++)
        if (argc > 1 ? strcmp(argv[1], views[i].name) == 0 : !bench_smoke() || i == 0)
            run(&views[i], &shown, &out);
    csv_close(&out, "cache_moving");
    return VIT_OK;
}
