/* Visibility and shadow rays against Embree's packets of 16, in one process, in turn, on the same rays in the same order and
 * the same number of threads. Both sides are verified against each other before anything is timed. Cut-outs are filled on both
 * sides. */
#include "occlusion_lab.h"
#include "scenes.h"
#include "view_rays.h"
#include <unistd.h>

#define ROUNDS 11
#define MOST_RACES 16

enum { RIVAL_FAST, RIVAL_ROBUST, RIVALS };
static const char *const rival_names[RIVALS] = {"Embree", "Embree robust"};

typedef struct race {
    const char *scene, *size;
    pack_image pack;
    player player;
    thread_pool pool;
    rival_scene rival[RIVALS];
    ray_planes view, shadow;
    uint32_t view_count, shadow_count;
    occlusion_lab lab;
    float *t;
    uint32_t *triangle, *occluded;
    series visibility, direct, occlusion, nearest_ms[RIVALS], any_ms[RIVALS];
} race;

static uint32_t device_threads(const player *p) {
    const vit_opencl *d = p->v->state;
    cl_uint units = 0;
    if (d->is_cpu && clGetDeviceInfo(d->id, CL_DEVICE_MAX_COMPUTE_UNITS, sizeof units, &units, NULL) == CL_SUCCESS)
        return units;
    const long cores = sysconf(_SC_NPROCESSORS_ONLN);
    return cores > 0 ? (uint32_t)cores : 1;
}

static double cast_nearest(race *r, int rival) {
    const rival_job job = {.scene = r->rival[rival].scene, .rays = &r->view, .t = r->t, .triangle = r->triangle};
    return pool_run(&r->pool, &job);
}

static double cast_any(race *r, int rival) {
    const rival_job job = {.scene = r->rival[rival].scene, .rays = &r->shadow, .occluded = r->occluded};
    return pool_run(&r->pool, &job);
}

/* Share of the camera's rays on which both say hit or both say miss; among common hits, the share of equal triangles and the
 * largest relative difference of equal triangles' distances. */
static void verify_view(race *r, int rival) {
    uint32_t *triangle = player_buffer(&r->player, B_hit_triangle), agree = 0, hits = 0, same = 0;
    float *t = player_buffer(&r->player, B_hit_distance);
    double worst = 0;
    cast_nearest(r, rival);
    for (uint32_t i = 0; i < r->view.n; i++) {
        if (ray_plane(&r->view, 6)[i] < 0)
            continue;
        const bool ours = triangle[i] != VIT_NONE, theirs = r->triangle[i] != VIT_NONE;
        agree += ours == theirs;
        hits += ours && theirs;
        if (!ours || triangle[i] != r->triangle[i])
            continue;
        same++;
        worst = fmax(worst, fabs((double)t[i] - (double)r->t[i]) / (double)t[i]);
    }
    printf("%-8s %s verified with %s: hit or miss equal on %.5f %% of %u view rays, triangle on %.4f %% of hits, t within %.1e",
           r->scene, r->size, rival_names[rival], 100.0 * agree / r->view_count, r->view_count, hits ? 100.0 * same / hits : 0,
           worst);
    if (agree < 0.999 * r->view_count)
        bench_fail("%s: hits differ from Embree's", r->scene);
    free(triangle);
    free(t);
}

static void verify_shadow(race *r, int rival) {
    uint32_t *ours = occlusion_read(&r->lab, &r->player), agree = 0, dark = 0;
    cast_any(r, rival);
    for (uint32_t i = 0; i < r->shadow.n; i++) {
        agree += ray_plane(&r->shadow, 6)[i] >= 0 && ours[i] == r->occluded[i];
        dark += r->occluded[i];
    }
    printf("; occlusion on %.5f %% of %u shadow rays (%.0f %% dark)\n", r->shadow_count ? 100.0 * agree / r->shadow_count : 0,
           r->shadow_count, r->shadow_count ? 100.0 * dark / r->shadow_count : 0);
    if (agree < 0.999 * r->shadow_count)
        bench_fail("%s: shadows differ from Embree's", r->scene);
    free(ours);
}

static void race_open(race *r, const char *path) {
    pack_image baked = image_load(path);
    const variant plain = {.solid = true};
    r->pack = image_variant(&baked, &plain);
    image_free(&baked);
    r->player = player_open(&r->pack, 0, 0);
    player_frame(&r->player, 0);
    const vit_pack *p = &r->player.v->pack;
    const enum RTCSceneFlags flags[RIVALS] = {RTC_SCENE_FLAG_NONE, RTC_SCENE_FLAG_ROBUST};
    for (int i = 0; i < RIVALS; i++)
        r->rival[i] = rival_open(p->section[VIT_SECTION_GEOM], p->scene->triangles, flags[i]);
    uint32_t *triangle = player_buffer(&r->player, B_hit_triangle), *normal = player_buffer(&r->player, B_normal);
    float *position = player_buffer(&r->player, B_position);
    r->view_count = rays_of_camera(p->scene, p->section[VIT_SECTION_CAMS], &r->view);
    r->shadow_count = rays_to_light(p->scene, p->section[VIT_SECTION_LITE], triangle, position, normal, &r->shadow);
    free(triangle);
    free(normal);
    free(position);
    r->lab = occlusion_open(&r->player, &r->shadow);
    r->t = bench_array(p->scene->samples, sizeof *r->t);
    r->triangle = bench_array(p->scene->samples, sizeof *r->triangle);
    r->occluded = bench_array(p->scene->samples, sizeof *r->occluded);
    pool_open(&r->pool, device_threads(&r->player));
}

/* In turn, so that what slows the machine for a while slows all. The first round warms up. */
static void race_run(race *r) {
    for (int round = 0; round <= bench_rounds(ROUNDS); round++) {
        double nearest[RIVALS], any[RIVALS];
        player_frame(&r->player, 0);
        for (int i = 0; i < RIVALS; i++)
            nearest[i] = cast_nearest(r, i);
        const double occlusion = occlusion_run(&r->lab, &r->player);
        for (int i = 0; i < RIVALS; i++)
            any[i] = cast_any(r, i);
        if (round == 0)
            continue;
        series_add(&r->visibility, player_pass_ms(&r->player, "visibility"));
        series_add(&r->direct, player_pass_ms(&r->player, "direct_light"));
        series_add(&r->occlusion, occlusion);
        for (int i = 0; i < RIVALS; i++) {
            series_add(&r->nearest_ms[i], nearest[i]);
            series_add(&r->any_ms[i], any[i]);
        }
    }
}

/* The times stay. */
static void race_close(race *r) {
    pool_close(&r->pool);
    occlusion_close(&r->lab);
    for (int i = 0; i < RIVALS; i++)
        rival_close(&r->rival[i]);
    player_close(&r->player);
    image_free(&r->pack);
    rays_free(&r->view);
    rays_free(&r->shadow);
    free(r->t);
    free(r->triangle);
    free(r->occluded);
}

/* One line: rates of ours and of the rivals, and the quotients. */
static void report_rates(csv *c, const race *r, const char *what, uint32_t rays, const series *ours,
                         const series rivals[RIVALS]) {
    char name[96];
    const double amount = 1e-3 * rays; /* ms to M rays/s */
    const series own = series_rate(ours, amount);
    printf("%-8s %-10s %-22s %8.1f", r->scene, r->size, what, series_median(&own));
    snprintf(name, sizeof name, "%s, ours", what);
    csv_row(c, r->scene, r->size, name, &own, "Mray/s");
    double rates[RIVALS];
    for (int i = 0; i < RIVALS; i++) {
        const series rival = series_rate(&rivals[i], amount);
        rates[i] = series_median(&rival);
        printf(" %8.1f", rates[i]);
        snprintf(name, sizeof name, "%s, %s", what, rival_names[i]);
        csv_row(c, r->scene, r->size, name, &rival, "Mray/s");
    }
    for (int i = 0; i < RIVALS; i++) {
        const series quotient = series_exact(series_median(&own) / rates[i]);
        printf(" %7.2fx", quotient.value[0]);
        snprintf(name, sizeof name, "%s, ours / %s", what, rival_names[i]);
        csv_row(c, r->scene, r->size, name, &quotient, "ratio");
    }
    printf("   ms %.2f +- %.2f\n", series_median(ours), series_mad(ours));
}

static void report(csv *c, const race *races, int count) {
    printf("\n%-8s %-10s %-22s %8s %8s %8s %8s %8s   (M rays/s, medians of %d)\n", "scene", "size", "rays", "ours", "Embree",
           "robust", "ratio", "robust", bench_rounds(ROUNDS));
    for (int i = 0; i < count; i++) {
        const race *r = &races[i];
        report_rates(c, r, "view rays", r->view_count, &r->visibility, r->nearest_ms);
        report_rates(c, r, "shadow rays", r->shadow_count, &r->occlusion, r->any_ms);
        report_rates(c, r, "shadow rays + shading", r->shadow_count, &r->direct, r->any_ms);
    }
}

int main(void) {
    csv c = csv_open("rays");
    race *races = bench_array(MOST_RACES, sizeof *races);
    int count = 0;
    for (size_t i = 0; i < BENCH_SCENES; i++)
        for (size_t k = 0; bench_size(k) && count < MOST_RACES; k++) {
            char pack[BENCH_PATH];
            race *r = &races[count];
            *r = (race){.scene = bench_scenes[i].name, .size = bench_size(k)};
            if (!scene_pack(&bench_scenes[i], r->size, pack))
                continue;
            race_open(r, pack);
            occlusion_run(&r->lab, &r->player);
            for (int rival = 0; rival < RIVALS; rival++) {
                verify_view(r, rival);
                verify_shadow(r, rival);
            }
            race_run(r);
            race_close(r);
            count++;
        }
    report(&c, races, count);
    csv_close(&c, "rays");
    free(races);
    return VIT_OK;
}
