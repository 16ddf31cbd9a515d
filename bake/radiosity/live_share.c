/* How many points each patch gets: the more, the more light differs within it and the more paths meet it (the optimal shares of
 * a stratified sample). Beside a lamp's way a patch has a bright spot that few points would miss. Half of the points are shared
 * out evenly, for lights elsewhere. */
#include "common/parallel.h"
#include "light/photon_emission.h"
#include "radiosity/live_parts.h"
#include <stdlib.h>

#define FRAMES 16u  /* at which lights are looked at, at most */
#define HALVINGS 64 /* of the interval in which the scale of shares lies */

typedef struct sharing {
    const live_input *in;
    const patch_set *p;
    double *wish; /* a patch */
} sharing;

static double luminous(const sharing *w, const vit_light *light, const patch_point *at) {
    const photons_light l = {.light = *light};
    const vec3 face = side_face(w->in->geometry, at->side),
               from = vec3_along(side_place(w->in->geometry, at->side, at->b1, at->b2), face, w->in->rays->s->ray_offset);
    const arrival a = photon_arrival(w->in->rays, &l, from, 0.0, 0.0);
    const float cosine = vec3_dot(face, a.direction), sum = a.irradiance.x + a.irradiance.y + a.irradiance.z;
    if (!(cosine > 0.0f) || !(sum > 0.0f) || photon_rays_occluded(w->in->rays, from, a.direction, a.distance))
        return 0.0;
    return (double)(sum * cosine);
}

/* Deviation of the light on the places where paths met the patch, times the paths. */
static void find_wish(void *user, uint32_t patch) {
    const sharing *w = user;
    const live_input *in = w->in;
    const uint32_t places = w->p->point_count[patch], frames = in->frames < FRAMES ? in->frames : FRAMES;
    double variance = 0.0;
    for (uint32_t f = 0; f < frames && places > 1; f++) {
        const vit_light *lights = in->tracks->lights + (uint64_t)f * in->frames / frames * in->tracks->light_count;
        double sum = 0.0, squares = 0.0;
        for (uint32_t i = 0; i < places; i++) {
            double light = 0.0;
            for (uint32_t k = 0; k < in->moving_count; k++)
                light += luminous(w, lights + in->moving[k], w->p->points + (size_t)patch * PATCHES_POINTS + i);
            sum += light;
            squares += light * light;
        }
        variance += squares - sum * sum / places;
    }
    w->wish[patch] = variance > 0.0 ? sqrt(variance / places) * w->p->met[patch] : 0.0;
}

/* Returns how many that makes. */
static uint64_t share_out(const sharing *w, uint32_t least, double scale, uint32_t *share) {
    uint64_t all = 0;
    for (uint32_t i = 0; i < w->p->count; i++) {
        const uint32_t met = w->p->point_count[i], most = met > least ? met : least;
        const double wish = least + w->wish[i] * scale;
        share[i] = wish < most ? (uint32_t)wish : most;
        all += share[i];
    }
    return all;
}

bool live_share(const live_input *in, const patch_set *p, uint32_t points, uint32_t *share) {
    const sharing w = {in, p, malloc((p->count + 1u) * sizeof *w.wish)};
    const uint32_t least = (points + 1u) / 2u;
    const uint64_t all = (uint64_t)points * p->count;
    double low = 0.0, high = 1.0;
    if (!w.wish)
        return false;
    parallel_for(in->threads, p->count, find_wish, (void *)(uintptr_t)&w);
    for (uint32_t i = 0; i < p->count; i++) /* at `high` all have as many as they can have, or as there are */
        high = w.wish[i] > 0.0 ? fmax(high, (double)PATCHES_POINTS / w.wish[i]) : high;
    for (int i = 0; i < HALVINGS; i++) {
        const double middle = 0.5 * (low + high);
        if (share_out(&w, least, middle, share) > all)
            high = middle;
        else
            low = middle;
    }
    (void)share_out(&w, least, low, share);
    free(w.wish);
    return true;
}
