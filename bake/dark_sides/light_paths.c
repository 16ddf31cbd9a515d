/* Light leaves lights, and sides ask lights: points, directions, area lights, the sky; any light that shines at all counts as
 * much as any other. */
#include "dark_sides/parts.h"
#include "light/sky.h"
#include <float.h>
#include <math.h>
#include <stdlib.h>

#define LIGHT_STREAM 0xffffffffu

static double mean_intensity(const vit_light *l) {
    return ((double)l->intensity[0] + (double)l->intensity[1] + (double)l->intensity[2]) / 3.0;
}

static vec plus(vec a, float s, vec b) {
    return (vec){a.x + s * b.x, a.y + s * b.y, a.z + s * b.z};
}

static vec vec_of(const float p[3]) {
    return (vec){p[0], p[1], p[2]};
}

/* Even over the cone cos >= least about n; the whole sphere for -1. */
static vec cone_direction(vec n, float least, float u, float v) {
    const float z = 1.0f - u * (1.0f - least), r = sqrtf(fmaxf(0.0f, 1.0f - z * z));
    float sine, cosine;
    sincos_turn(v, &sine, &cosine);
    return direction_about(n, r * cosine, r * sine, z);
}

static vec disc_point(vec center, vec n, float radius, float u, float v) {
    const float r = radius * sqrtf(u);
    float sine, cosine;
    sincos_turn(v, &sine, &cosine);
    return plus(center, 1.0f, direction_about(n, r * cosine, r * sine, 0.0f));
}

static const vit_light *light_of(const dark_sides_lights *l, uint32_t source, uint32_t frame) {
    return l->t->lights + (size_t)frame * l->t->light_count + source;
}

static bool is_sky(const dark_sides_lights *l, uint32_t source) {
    return l->sky && source + 1 == l->sources;
}

/* False: out of memory. */
static bool find_area_lights(dark_sides_search *s) {
    dark_sides_lights *l = &s->lights;
    double area = 0.0, sum = 0.0;
    for (uint32_t i = 0; i < s->m->triangles; i++)
        if (material_lights(side_material(s->m, s->g, 2 * i))) {
            area += (double)s->area[i];
            l->area_light_count++;
        }
    l->area_lights = malloc((l->area_light_count + 1u) * sizeof *l->area_lights);
    l->area_light_sum = malloc((l->area_light_count + 1u) * sizeof *l->area_light_sum);
    if (!l->area_lights || !l->area_light_sum)
        return false;
    for (uint32_t i = 0, k = 0; k < l->area_light_count; i++)
        if (material_lights(side_material(s->m, s->g, 2 * i))) {
            sum += (double)s->area[i] / area + 1.0 / l->area_light_count;
            l->area_lights[k] = i;
            l->area_light_sum[k++] = sum;
        }
    return true;
}

bool lights_open(dark_sides_search *s, const tracks *t, uint32_t frames, bool sky_light) {
    float center[3];
    s->lights = (dark_sides_lights){.t = t, .frames = frames, .sky = sky_light};
    if (!find_area_lights(s))
        return false;
    s->lights.sources = t->light_count + (s->lights.area_light_count > 0) + sky_light;
    sky_sphere(s->m->lo, s->m->hi, center, &s->lights.radius);
    s->lights.center = vec_of(center);
    return true;
}

void lights_close(dark_sides_lights *l) {
    free(l->area_lights);
    free(l->area_light_sum);
}

bool lights_emit(const dark_sides_lights *l) {
    for (size_t i = 0; i < (size_t)l->frames * l->t->light_count; i++)
        if (mean_intensity(l->t->lights + i) > 0.0)
            return true;
    return l->sky || l->area_light_count > 0;
}

static uint32_t choose_area_light(const dark_sides_lights *l, float x) {
    uint32_t low = 0, high = l->area_light_count - 1;
    while (low < high) {
        const uint32_t middle = (low + high) / 2;
        if (l->area_light_sum[middle] > 2.0 * (double)x)
            high = middle;
        else
            low = middle + 1;
    }
    return l->area_lights[low];
}

bool lights_leave(const dark_sides_search *s, uint32_t ray, vec *origin, vec *direction) {
    const dark_sides_lights *all = &s->lights;
    const uint32_t source = ray % all->sources, frame = (uint32_t)((uint64_t)ray * all->frames / s->light_rays);
    const float a = sequence(LIGHT_STREAM, ray, 0), b = sequence(LIGHT_STREAM, ray, 1), c = sequence(LIGHT_STREAM, ray, 2),
                d = sequence(LIGHT_STREAM, ray, 3);
    if (is_sky(all, source)) {
        const vec from = cone_direction((vec){0.0f, 0.0f, 1.0f}, -1.0f, a, b);
        *origin = disc_point(plus(all->center, all->radius, from), from, all->radius, c, d);
        *direction = (vec){-from.x, -from.y, -from.z};
        return true;
    }
    if (source == all->t->light_count) { /* no dimension is left for the area light and its side */
        const uint32_t side = 2 * choose_area_light(all, sequence(ray, 0, 0)) + (sequence(ray, 0, 1) < 0.5f);
        const ray_side area_light = side_of(s->g, side);
        *origin = side_point(&area_light, a, b);
        *direction = cosine_direction(area_light.normal, c, d);
        return !ray_scene_covered(&s->rays, side, *origin);
    }
    const vit_light *l = light_of(all, source, frame);
    *origin = vec_of(l->position);
    if (l->kind == VIT_LIGHT_DIRECTIONAL) {
        *direction = vec_of(l->direction);
        *origin = disc_point(*origin, *direction, l->spot_scale, a, b);
    } else {
        const bool spot = l->kind == VIT_LIGHT_SPOT;
        *direction = cone_direction(spot ? vec_of(l->direction) : (vec){0.0f, 0.0f, 1.0f}, spot ? l->cos_outer : -1.0f, a, b);
    }
    return mean_intensity(l) > 0.0;
}

static uint32_t pick(float u, uint32_t count) {
    const uint32_t i = (uint32_t)(u * (float)count);
    return i < count ? i : count - 1;
}

/* A point of an area light, on the side of it that `o` is on. False: something covers it there. */
static bool lamp_point(const dark_sides_search *s, uint32_t other, vec o, vec *at, vec *across) {
    const uint32_t area_light = 2 * choose_area_light(&s->lights, sequence(other, 1, 0));
    const ray_side face = side_of(s->g, area_light);
    const vec front = side_point(&face, sequence(other, 1, 1), sequence(other, 1, 2)), n = face.normal;
    const bool before = (o.x - front.x) * n.x + (o.y - front.y) * n.y + (o.z - front.z) * n.z > 0.0f;
    *at = before ? front : plus(front, -2.0f * s->g->ray_offset, n);
    *across = n;
    return !ray_scene_covered(&s->rays, area_light + !before, *at);
}

static float along(vec a, vec b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

/* Of a light of power 1, W/m2, at a place that sees it in unit direction `to`, d metres away. */
static float irradiance_of(const vit_light *l, vec n, vec to, float d) {
    const float cosine = along(to, n);
    if (l->kind == VIT_LIGHT_DIRECTIONAL)
        return cosine / (KERNEL_PI * l->spot_scale * l->spot_scale);
    return cosine / (2.0f * KERNEL_PI * (l->kind == VIT_LIGHT_SPOT ? 1.0f - l->cos_outer : 2.0f) * d * d);
}

float lights_ask(const dark_sides_search *s, uint32_t side, const ray_side *from, uint32_t i) {
    const dark_sides_lights *all = &s->lights;
    const uint32_t source = pick(side_sequence(from, i, 2), all->sources), frame = pick(side_sequence(from, i, 3), all->frames);
    const vec n = from->normal, o = side_point(from, side_sequence(from, i, 0), side_sequence(from, i, 1));
    const uint32_t other = side + i; /* for other numbers */
    if (is_sky(all, source)) {
        const vec up = cosine_direction(n, sequence(other, 1, 0), sequence(other, 1, 1));
        return ray_scene_passes(&s->rays, o, up, INFINITY) ? 1.0f / (4.0f * KERNEL_PI * all->radius * all->radius) : 0.0f;
    }
    const vit_light *l = source < all->t->light_count ? light_of(all, source, frame) : NULL;
    if (l && !(mean_intensity(l) > 0.0))
        return 0.0f;
    vec at = {0.0f, 0.0f, 0.0f}, axis = {0.0f, 0.0f, 0.0f};
    if (l) {
        at = vec_of(l->position);
        axis = vec_of(l->direction);
    } else if (!lamp_point(s, other, o, &at, &axis))
        return 0.0f;
    const vec to = {at.x - o.x, at.y - o.y, at.z - o.z};
    const float d = fmaxf(sqrtf(to.x * to.x + to.y * to.y + to.z * to.z), s->g->ray_offset);
    const bool parallel = l && l->kind == VIT_LIGHT_DIRECTIONAL;
    const vec unit = parallel ? (vec){-axis.x, -axis.y, -axis.z} : (vec){to.x / d, to.y / d, to.z / d};
    if (!(along(unit, n) > 0.0f) || (l && l->kind == VIT_LIGHT_SPOT && !(-along(unit, axis) >= l->cos_outer)))
        return 0.0f;
    if (!ray_scene_passes(&s->rays, o, unit, parallel ? INFINITY : d))
        return 0.0f;
    if (l) /* an area light has half of its power on either side */
        return irradiance_of(l, n, unit, d);
    return fmaxf(along(unit, n) * fabsf(along(unit, axis)) / (2.0f * KERNEL_PI * d * d), FLT_MIN);
}
