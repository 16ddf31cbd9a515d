/* How still indirect light is where nothing moves, and how right its changes are, over a second of 24 frames: with a light that
 * moves, a camera that does, or both. The camera comes back to where it began, so that the first frame and the last show the
 * same places.
 *
 * noise: of the irradiance at fixed places of surfaces from frame to frame, root of the mean square over the mean, %. A place
 * is a pixel's in one frame; it is looked up in the two frames before and the two after between the four pixels about it, if
 * all four lie on its plane. Light that changes smoothly leaves nothing in the fourth difference E(-2) - 4 E(-1) + 6 E(0) - 4
 * E(1) + E(2), and noise of variance v leaves 70 v there; two frames differ by 2 v. Whatever jumps from frame to frame is noise
 * by this, true shadow edges that pass included, which indirect light has not. step, largest: where no light moves nothing
 * changes; the same of E(1) - E(0) itself, and the largest of all, over the mean. change: error of the last frame less the
 * first against the path tracer's, root of the mean square over that of the true change,
 * %, each less what the path tracer's own noise adds, which is stated: an error far below it is not known well. */
#ifndef VIT_BENCH_INDIRECT_MOTION_H
#define VIT_BENCH_INDIRECT_MOTION_H

#include "indirect_methods.h"
#include "indirect_truth.h"
#include "oracle/view_sample.h"

enum { MOTION_SPAN = 5 };
#define MOTION_NOISE 3e-4  /* NMSE of the path tracer's frames: less than elsewhere, since differences are what counts */
#define MOTION_PLANE 2e-3  /* of the distance from the eye: so far from a place's plane lies what is on it */
#define MOTION_TURN 0.9999 /* cosine between normals of one plane */

/* What a frame shows, pixel by pixel. */
typedef struct moment {
    vit_camera camera;
    uint32_t width, height;
    bool *hit;
    double *position, *normal; /* 3 a pixel */
    double *light;             /* irradiance, W/m2, times exposure, 3 a pixel */
} moment;

static inline moment moment_of(player *p, uint32_t frame) {
    player_frame(p, frame);
    const vit_scene *s = p->v->pack.scene;
    vit_camera *cameras = player_buffer(p, B_cameras);
    uint32_t *hit = player_buffer(p, B_hit_triangle), *normal = player_buffer(p, B_normal);
    void *position = player_buffer(p, B_position);
    float *light = player_buffer(p, B_indirect);
    const size_t pixels = (size_t)s->width * s->height;
    moment m = {.camera = cameras[frame], .width = s->width, .height = s->height, .hit = bench_array(pixels, sizeof *m.hit)};
    m.position = bench_array(3 * pixels, sizeof *m.position);
    m.normal = bench_array(3 * pixels, sizeof *m.normal);
    m.light = bench_array(3 * pixels, sizeof *m.light);
    for (uint32_t i = 0; i < pixels; i++) {
        const uint32_t sample = oracle_number(s, i % s->width, i / s->width);
        m.hit[i] = hit[sample] != VIT_NONE;
        oracle_position(s, position, sample, m.position + 3 * (size_t)i);
        oracle_normal(normal[sample], m.normal + 3 * (size_t)i);
        for (size_t k = 0; k < 3; k++)
            m.light[3 * (size_t)i + k] = (double)light[k * s->samples + sample];
    }
    free(cameras);
    free(hit);
    free(normal);
    free(position);
    free(light);
    return m;
}

static inline void moment_free(moment *m) {
    free(m->hit);
    free(m->position);
    free(m->normal);
    free(m->light);
}

/* Where a place is in the frame, in pixels from the corner; false: behind the eye. */
static inline bool moment_project(const moment *m, const double place[3], double at[2]) {
    double c[3][3], to[3], inverse[3];
    for (int k = 0; k < 3; k++) {
        c[0][k] = (double)m->camera.right[k];
        c[1][k] = (double)m->camera.down[k];
        c[2][k] = (double)m->camera.corner[k];
        to[k] = place[k] - (double)m->camera.eye[k];
    }
    for (int i = 0; i < 3; i++) { /* to = x right + y down + z corner, by cross products */
        const double *a = c[(i + 1) % 3], *b = c[(i + 2) % 3];
        const double across[3] = {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
        inverse[i] = oracle_dot(across, to) / oracle_dot(across, c[i]);
    }
    at[0] = inverse[0] / inverse[2];
    at[1] = inverse[1] / inverse[2];
    return inverse[2] > 0;
}

/* Irradiance in frame `m` at the place of pixel i of frame `of`. False: it is not seen whole. */
static inline bool moment_look_up(const moment *m, const moment *of, size_t i, double light[3]) {
    const double *place = of->position + 3 * i, *normal = of->normal + 3 * i;
    double at[2], eye[3], far = 0;
    memset(light, 0, 3 * sizeof *light);
    if (memcmp(&m->camera, &of->camera, sizeof m->camera) == 0) {
        memcpy(light, m->light + 3 * i, 3 * sizeof *light);
        return true;
    }
    if (!moment_project(m, place, at))
        return false;
    const double x = floor(at[0] - 0.5), y = floor(at[1] - 0.5), u = at[0] - 0.5 - x, v = at[1] - 0.5 - y;
    if (!(x >= 0 && y >= 0 && x + 1 < m->width && y + 1 < m->height))
        return false;
    for (int k = 0; k < 3; k++) {
        eye[k] = place[k] - (double)m->camera.eye[k];
        far += eye[k] * eye[k];
    }
    for (int corner = 0; corner < 4; corner++) {
        const size_t j = ((size_t)y + (size_t)(corner / 2)) * m->width + (size_t)x + (size_t)(corner % 2);
        const double *p = m->position + 3 * j, off[3] = {p[0] - place[0], p[1] - place[1], p[2] - place[2]};
        const double weight = (corner % 2 ? u : 1 - u) * (corner / 2 ? v : 1 - v);
        if (!m->hit[j] || oracle_dot(m->normal + 3 * j, normal) < MOTION_TURN ||
            fabs(oracle_dot(off, normal)) > MOTION_PLANE * sqrt(far))
            return false;
        for (int k = 0; k < 3; k++)
            light[k] += weight * m->light[3 * j + (size_t)k];
    }
    return true;
}

typedef struct stillness {
    double noise, step, largest,
        used; /* shares of the mean; used: of pixels that show surfaces, in all frames that have two before and after */
} stillness;

/* Sums of squares, and of light, over the places of the middle one of five frames. */
typedef struct stillness_sums {
    double noise, step, largest, light, values, pixels;
} stillness_sums;

static inline void stillness_add(const moment window[MOTION_SPAN], stillness_sums *s) {
    static const double fourth[MOTION_SPAN] = {1, -4, 6, -4, 1};
    const moment *middle = window + MOTION_SPAN / 2;
    const size_t pixels = (size_t)middle->width * middle->height;
    for (size_t i = 0; i < pixels; i++) {
        double light[MOTION_SPAN][3];
        bool seen = middle->hit[i];
        for (int f = 0; f < MOTION_SPAN && seen; f++)
            seen = moment_look_up(window + f, middle, i, light[f]);
        s->pixels += middle->hit[i];
        for (int k = 0; k < 3 && seen; k++) {
            double off = 0;
            for (int f = 0; f < MOTION_SPAN; f++)
                off += fourth[f] * light[f][k];
            const double step = light[MOTION_SPAN / 2 + 1][k] - light[MOTION_SPAN / 2][k];
            s->noise += off * off;
            s->step += step * step;
            s->largest = fmax(s->largest, fabs(step));
            s->light += light[MOTION_SPAN / 2][k];
            s->values += 1;
        }
    }
}

static inline stillness stillness_of(const pack_image *pack, uint32_t frames) {
    moment window[MOTION_SPAN] = {{.hit = NULL}};
    stillness_sums s = {0};
    player p = player_open(pack, 0, VIT_DEVICE_HOST);
    for (uint32_t f = 0; f < frames; f++) {
        moment_free(window);
        memmove(window, window + 1, (MOTION_SPAN - 1) * sizeof *window);
        window[MOTION_SPAN - 1] = moment_of(&p, f);
        if (f + 1 >= MOTION_SPAN)
            stillness_add(window, &s);
    }
    for (int f = 0; f < MOTION_SPAN; f++)
        moment_free(window + f);
    player_close(&p);
    if (!(s.light > 0))
        bench_fail("motion: no place is seen in five frames, or none is lit");
    const double mean = s.light / s.values;
    return (stillness){.noise = sqrt(s.noise / s.values * 2 / 70) / mean,
                       .step = sqrt(s.step / s.values) / mean,
                       .largest = s.largest / mean,
                       .used = s.values / (3 * s.pixels)};
}

typedef struct change {
    double error, own; /* over the true change: the method's, and what the path tracer's noise alone would make of it */
} change;

/* first, last: the method's light; truths: the path tracer's of the same frames. */
static inline change change_of(const float *first, const float *last, const truth truths[2], int part) {
    const truth_part *a = &truths[0].part[part], *b = &truths[1].part[part];
    const size_t values = 3 * (size_t)truths[0].r.width * truths[0].r.height;
    double wrong = 0, right = 0, noise = 0;
    for (size_t i = 0; i < values; i++) {
        const double true_change = b->light[i] - a->light[i], off = (double)last[i] - (double)first[i] - true_change;
        wrong += off * off;
        right += true_change * true_change;
        noise += a->variance[i] + b->variance[i];
    }
    if (!(right > noise))
        bench_fail("motion: the reference is too noisy to tell what changes");
    return (change){sqrt(fmax(wrong - noise, 0) / (right - noise)), sqrt(noise / (right - noise))};
}

#endif
