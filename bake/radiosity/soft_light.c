/* Three ways of looking, each a function over the unit square: into directions by the cosine, at points of the area lights,
 * into directions by a sky picture's radiance. The square is divided evenly, more finely where all there could be is much of
 * what was found, and a look is taken in each part; parts that differ from those beside them, as at the edges of shadows, are
 * divided again and again (Mitchell 1987). */
#include "radiosity/soft_light.h"

#define LEAST_EDGE 16u /* parts along the square's edge, */
#define MOST_EDGE 64u  /* or so many */
#define BELIEVED 8.0f  /* errors: all there could be in a part, if the parts are to be small enough */
#define DEPTH 3        /* times that a part is divided, at most */

enum { BY_COSINE, AT_POINTS, AT_PICTURE, WAYS };

/* A place that looks for light. */
typedef struct look {
    const soft_lights *l;
    vec3 from, normal, face;
    uint32_t rays;
} look;

typedef struct square {
    uint32_t edge;
    float light[MOST_EDGE * MOST_EDGE][3], sum[3]; /* W/m2 */
} square;

static float all_of(const float light[3]) {
    return light[0] + light[1] + light[2];
}

static void set(float light[3], vec3 radiance, float factor) {
    light[0] = radiance.x * factor;
    light[1] = radiance.y * factor;
    light[2] = radiance.z * factor;
}

/* What each of two ways counts of the light that both find, by their densities: the power heuristic (Veach 1995). */
static float share(float own, float other) {
    return own * own / float_max(own * own + other * other, 1e-30f);
}

static float by_cosine(const look *k, vec3 d) {
    return vec3_dot(k->normal, d) * KERNEL_INV_PI;
}

/* Density of directions to points of which one stands for an area, 1/sr. */
static float by_points(float area, float d2, float cosine) {
    return d2 / float_max(area * cosine, 1e-30f);
}

/* The sky, or area lights. */
static void look_by_cosine(look *k, float u, float v, float light[3]) {
    const soft_lights *l = k->l;
    const photon_scene *s = l->rays->s;
    const vec3 d = vec3_cosine(k->normal, u, v);
    const float own = by_cosine(k, d);
    float t;
    if (!(vec3_dot(d, k->face) > 0.0f && own > 0.0f))
        return;
    k->rays++;
    const uint32_t triangle = photon_rays_nearest(l->rays, k->from, d, &t);
    if (triangle == VIT_NONE) {
        if (l->sky && l->sky->size == 0)
            set(light, vec3_load(l->sky->background), KERNEL_PI);
        return;
    }
    if (!l->area)
        return;
    const float facing = -vec3_dot(d, side_face(l->geometry, 2 * triangle));
    const float area = area_lights_spread(l->area, 2 * triangle + (facing < 0.0f));
    if (area > 0.0f)
        set(light, vec3_load(s->materials[s->attributes[triangle].material & VIT_MATERIAL_INDEX].emission),
            KERNEL_PI * share(own, by_points(area, t * t, fabsf(facing))));
}

/* Returns what there would be without shadows. */
static float look_at_point(look *k, float u, float v, float light[3]) {
    const area_light_point p = area_lights_point(k->l->area, (double)u, (double)v);
    const vec3 to = vec3_sub(p.position, k->from);
    const float d2 = vec3_dot(to, to), distance = sqrtf(d2);
    if (!(distance > 0.0f))
        return 0.0f;
    const vec3 d = vec3_scale(to, 1.0f / distance);
    const float own = by_cosine(k, d), facing = -vec3_dot(p.normal, d);
    float open[3];
    if (!(own > 0.0f && facing > 0.0f && vec3_dot(d, k->face) > 0.0f))
        return 0.0f;
    set(open, p.power, own * KERNEL_PI * facing / d2 * share(by_points(p.area, d2, facing), own));
    k->rays++;
    if (!photon_rays_occluded(k->l->rays, k->from, d, distance))
        memcpy(light, open, sizeof open);
    return all_of(open);
}

static float look_at_picture(look *k, float u, float v, float light[3]) {
    const sky_ray r = sky_choose(k->l->sky, (double)u, (double)v);
    const float cosine = vec3_dot(k->normal, r.direction);
    float open[3];
    if (!(cosine > 0.0f && vec3_dot(r.direction, k->face) > 0.0f))
        return 0.0f;
    set(open, r.power, cosine);
    k->rays++;
    if (!photon_rays_occluded(k->l->rays, k->from, r.direction, 3e38f))
        memcpy(light, open, sizeof open);
    return all_of(open);
}

/* At a place of the square, 0 < x, y < 1. Light, and what there would be without shadows; of the directions by the cosine the
 * latter is the sky's. */
static float look_at(look *k, int way, float x, float y, float light[3]) {
    light[0] = light[1] = light[2] = 0.0f;
    if (way == AT_POINTS)
        return look_at_point(k, x, y, light);
    if (way == AT_PICTURE)
        return look_at_picture(k, x, y, light);
    look_by_cosine(k, x, y, light);
    return k->l->sky && k->l->sky->size == 0 ? all_of(k->l->sky->background) * KERNEL_PI : 0.0f;
}

static uint32_t reversed(uint32_t i, uint32_t edge) {
    uint32_t r = 0;
    for (uint32_t bit = 1; bit < edge; bit *= 2)
        r = 2 * r + ((i & bit) != 0);
    return r;
}

/* A look in each part, so that all are even along both edges too (Chiu et al. 1994): few of the
 * parts may have all the light. Returns what there would be without shadows. */
static float look_round(look *k, int way, uint32_t edge, square *s) {
    const float size = 1.0f / (float)edge;
    float open = 0.0f;
    *s = (square){.edge = edge};
    for (uint32_t i = 0; i < edge * edge; i++) {
        const uint32_t row = i / edge, column = i % edge;
        const float x = ((float)row + ((float)reversed(column, edge) + 0.5f) * size) * size,
                    y = ((float)column + ((float)reversed(row, edge) + 0.5f) * size) * size;
        open += look_at(k, way, x, y, s->light[i]);
        for (int c = 0; c < 3; c++)
            s->sum[c] += s->light[i][c];
    }
    for (int c = 0; c < 3; c++)
        s->sum[c] *= size * size;
    return open * size * size;
}

/* In a part of the square, at a place that depends on the part alone. */
static void look_into(look *k, int way, const float part[2], float size, float light[3]) {
    const uint32_t chance = pcg((uint32_t)(part[0] * 4096.0f) + pcg((uint32_t)(part[1] * 4096.0f) + (uint32_t)way));
    (void)look_at(k, way, float_max(part[0] + size * unit_float(chance), 0x1p-24f),
                  float_max(part[1] + size * unit_float(pcg(chance)), 0x1p-24f), light);
}

/* Adds the light of a part, by its four quarters. */
static void look_closer(look *k, int way, const float at[2], float size, int depth, float allowed, float sum[3]) {
    float light[4][3], least = INFINITY, most = 0.0f;
    const float half = 0.5f * size;
    for (int i = 0; i < 4; i++) {
        const float part[2] = {at[0] + (i & 1 ? half : 0.0f), at[1] + (i & 2 ? half : 0.0f)};
        look_into(k, way, part, half, light[i]);
        least = float_min(least, all_of(light[i]));
        most = float_max(most, all_of(light[i]));
    }
    for (int i = 0; i < 4; i++) {
        const float part[2] = {at[0] + (i & 1 ? half : 0.0f), at[1] + (i & 2 ? half : 0.0f)};
        if (depth > 1 && (most - least) * half * half > allowed)
            look_closer(k, way, part, half, depth - 1, allowed, sum);
        else
            for (int c = 0; c < 3; c++)
                sum[c] += light[i][c] * half * half;
    }
}

/* The largest step to a part beside part i. */
static float step_of(const square *s, uint32_t i) {
    const uint32_t row = i / s->edge, column = i % s->edge;
    const float own = all_of(s->light[i]);
    float step = 0.0f;
    if (row > 0)
        step = float_max(step, fabsf(all_of(s->light[i - s->edge]) - own));
    if (row + 1 < s->edge)
        step = float_max(step, fabsf(all_of(s->light[i + s->edge]) - own));
    if (column > 0)
        step = float_max(step, fabsf(all_of(s->light[i - 1]) - own));
    if (column + 1 < s->edge)
        step = float_max(step, fabsf(all_of(s->light[i + 1]) - own));
    return step;
}

/* Parts that differ from those beside them become the mean of smaller ones, which may differ from others beside them. */
static void add_square(look *k, int way, square *s, float allowed, float sum[3]) {
    const float size = 1.0f / (float)s->edge, area = size * size;
    bool closer[MOST_EDGE * MOST_EDGE] = {false}, more = true;
    while (more) {
        more = false;
        for (uint32_t i = 0; i < s->edge * s->edge; i++) {
            const float at[2] = {(float)(i / s->edge) * size, (float)(i % s->edge) * size};
            float light[3] = {0.0f};
            if (closer[i] || step_of(s, i) * area <= allowed)
                continue;
            look_closer(k, way, at, size, DEPTH, allowed, light);
            for (int c = 0; c < 3; c++)
                s->light[i][c] = light[c] / area;
            closer[i] = more = true;
        }
    }
    for (uint32_t i = 0; i < s->edge * s->edge; i++)
        for (int c = 0; c < 3; c++)
            sum[c] += s->light[i][c] * area;
}

uint32_t soft_light_at(const soft_lights *l, uint32_t side, float b1, float b2, float irradiance[3]) {
    const vec3 face = side_face(l->geometry, side);
    look k = {.l = l, .normal = side_shading(l->geometry, side, b1, b2), .face = face};
    k.from = vec3_along(side_place(l->geometry, side, b1, b2), face, l->rays->s->ray_offset);
    const bool picture = l->sky && l->sky->size > 0, even = l->sky && !picture,
               wanted[WAYS] = {even || l->area, l->area != NULL, picture};
    square s[WAYS];
    float open[WAYS] = {0.0f}, allowed;
    uint32_t edge = LEAST_EDGE;
    for (;; edge *= 2) {
        float all = 0.0f, most = 0.0f;
        for (int w = 0; w < WAYS; w++) {
            if (!wanted[w])
                continue;
            open[w] = look_round(&k, w, edge, s + w);
            all += all_of(s[w].sum);
            most = float_max(most, open[w]);
        }
        allowed = l->error * float_max(all, l->dim);
        if (edge == MOST_EDGE || most <= BELIEVED * allowed * (float)(edge * edge))
            break;
    }
    irradiance[0] = irradiance[1] = irradiance[2] = 0.0f;
    for (int w = 0; w < WAYS; w++)
        if (wanted[w])
            add_square(&k, w, s + w, allowed, irradiance);
    return k.rays;
}
