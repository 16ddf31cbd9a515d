/* Indirect light at the world-space cache's points instead of at receivers: what each can hold, for its bytes.
 *
 * What is to be held is the irradiance that receivers at a third of their usual spacing give, of the scenes of
 * bench_indirect.c. Receivers at the default are baked anew, rays and all; the cache's points get the values that fit each
 * pixel's irradiance best (cache/fit.h), which no bake could better, 8, 4 and 2 pixels apart. Error: NMSE over all pixels.
 * Bytes: of receivers, cells and sides; of a cell's key, tag and 8 points of three colours of 10 bits.
 *
 * bench_cache_indirect [SCENE...]; what looking up costs: bench_cache.c and bench_soft_light.c. */
#include "indirect_motion.h"

#include "cache/fit.h"

#define CELL_BYTES (4 + 2 + 8 * 4) /* as much as 16 for one colour */

static const char *const scenes[] = {"door20", "house", "court"};
static const double spacings[] = {8, 4, 2};

static vit_text why;

static moment look(const untuned_scene *s, const char *options, uint64_t *bytes, double *cpu) {
    method m = {.name = options};
    pack_image image = method_bake(s, &m);
    player p = player_open(&image, 0, VIT_DEVICE_HOST);
    const vit_scene *meta = p.v->pack.scene;
    const moment r = moment_of(&p, s->frames - 1);
    *bytes = meta->receivers * sizeof(vit_receiver) + meta->receiver_cells * sizeof(vit_receiver_cell) +
             meta->receiver_splits * sizeof(vit_receiver_split) + (uint64_t)meta->triangles * 8;
    *cpu = m.cpu;
    player_close(&p);
    image_free(&image);
    return r;
}

/* Of pixels that have light; NAN: none. */
static double nmse_of(const moment *right, const double *light) {
    double square = 0, mean = 0, count = 0;
    for (size_t i = 0; i < (size_t)right->width * right->height; i++)
        for (size_t k = 3 * i; k < 3 * i + 3 && right->hit[i] && isfinite(light[k]); k++, count++) {
            square += (light[k] - right->light[k]) * (light[k] - right->light[k]);
            mean += right->light[k];
        }
    return square / count / (mean / count * mean / count);
}

/* Places of all pixels, in their order; `pixel`: whose. */
static cache_sights places_of(const moment *m, uint32_t *pixel) {
    const uint32_t pixels = m->width * m->height;
    cache_sights s = {.sight = bench_array(pixels, sizeof *s.sight), .nearest = INFINITY};
    for (uint32_t i = 0; i < pixels; i++) {
        if (!m->hit[i])
            continue;
        const double *p = m->position + 3 * (size_t)i, *n = m->normal + 3 * (size_t)i;
        const vec3 at = {(float)p[0], (float)p[1], (float)p[2]}, normal = {(float)n[0], (float)n[1], (float)n[2]},
                   way = vec3_sub(at, vec3_load(m->camera.eye));
        const float distance = sqrtf(vec3_dot(way, way));
        s.nearest = fminf(s.nearest, distance);
        s.farthest = fmaxf(s.farthest, distance);
        pixel[s.count] = i;
        s.sight[s.count++] = (cache_sight){at, normal, normal, distance, 0, 0, 0};
    }
    const vec3 across = vec3_load(m->camera.right);
    s.pixel = sqrtf(vec3_dot(across, across));
    return s;
}

/* Levels as cache/occlusion.c chooses them. */
static vit_scene levels_of(const cache_sights *s, double spacing) {
    const float edge = s->pixel * (float)spacing;
    vit_scene meta = {.cache_levels = 1, .cache_step = s->nearest * edge};
    while (meta.cache_levels < VIT_CACHE_LEVELS &&
           s->farthest * edge > meta.cache_step * (float)(1u << (meta.cache_levels - 1u)))
        meta.cache_levels++;
    meta.cache_detail = edge / meta.cache_step;
    return meta;
}

/* The best light that the cache's points give each pixel, and its cells. */
static uint32_t best_of_points(const moment *right, double spacing, double *light) {
    const uint32_t pixels = right->width * right->height;
    uint32_t *pixel = bench_array(pixels, sizeof *pixel);
    float *value = bench_array(pixels, sizeof *value);
    cache_sights s = places_of(right, pixel);
    const vit_scene meta = levels_of(&s, spacing);
    cache_met met = {0};
    double held_out;
    if (cache_met_find(&meta, &s, 255, NULL, &met, &why) != VIT_OK)
        bench_fail("%s", why.text);
    for (size_t k = 0; k < 3; k++) {
        for (uint32_t row = 0; row < met.taken_count; row++)
            value[row] = (float)right->light[3 * pixel[met.taken[row]] + k];
        float *point = cache_fit(&met, value, NULL, &held_out);
        if (!point)
            bench_fail("out of memory");
        for (uint32_t row = 0; row < met.taken_count; row++) {
            double sum = 0, weight = 0;
            for (size_t i = met.first[row]; i < met.first[row + 1]; i++)
                if (isfinite(point[met.reads[i].point])) {
                    sum += (double)met.reads[i].weight * (double)point[met.reads[i].point];
                    weight += (double)met.reads[i].weight;
                }
            light[3 * pixel[met.taken[row]] + k] = weight > 0 ? sum / weight : 0;
        }
        free(point);
    }
    const uint32_t cells = met.cell_count;
    cache_met_free(&met);
    free(s.sight);
    free(value);
    free(pixel);
    return cells;
}

static void put(csv *out, const char *of, const char *what, double error, double bytes) {
    const series e = series_exact(error), b = series_exact(bytes);
    printf("%-8s %-34s NMSE %9.6f %9.1f kB\n", of, what, error, 1e-3 * bytes);
    csv_row(out, of, "192x144", what, &e, "NMSE");
    csv_row(out, of, "192x144", what, &b, "B");
}

static void run(const untuned_scene *s, csv *out) {
    if (!untuned_write(s, bench_smoke() ? "48x36" : "192x144"))
        return;
    uint64_t bytes[2];
    double cpu[2];
    char what[64];
    const char *const fine = bench_smoke() ? "basis+receiver-rays=64+receiver-spacing=16"
                                           : "basis+receiver-spacing=3+receiver-rays=1024",
                      *const plain = bench_smoke() ? "basis+receiver-rays=64+receiver-spacing=24" : "basis";
    moment right = look(s, fine, &bytes[0], &cpu[0]), usual = look(s, plain, &bytes[1], &cpu[1]);
    double *light = bench_array(3 * (size_t)right.width * right.height, sizeof *light);
    snprintf(what, sizeof what, "receivers, baked in %.0f s", cpu[1]);
    put(out, s->name, what, nmse_of(&right, usual.light), (double)bytes[1]);
    for (size_t i = 0; i < sizeof spacings / sizeof *spacings; i++) {
        for (size_t k = 0; k < 3 * (size_t)right.width * right.height; k++)
            light[k] = NAN; /* pixels whose points many others read before are not fitted */
        const uint32_t cells = best_of_points(&right, spacings[i], light);
        snprintf(what, sizeof what, "points %g pixels apart, best fit", spacings[i]);
        put(out, s->name, what, nmse_of(&right, light), (double)cells * CELL_BYTES);
    }
    fflush(stdout);
    free(light);
    moment_free(&right);
    moment_free(&usual);
}

int main(int argc, char **argv) {
    csv out = csv_open("cache_indirect");
    for (size_t i = 0; i < sizeof scenes / sizeof *scenes; i++)
        for (size_t k = 0; k < UNTUNED_SCENES; k++)
            if (strcmp(untuned_scenes[k].name, scenes[i]) == 0 &&
                (argc > 1 ? strcmp(argv[1], scenes[i]) == 0 : !bench_smoke() || i == 0))
                run(&untuned_scenes[k], &out);
    csv_close(&out, "cache_indirect");
    return VIT_OK;
}
