#include "light/photon_emission.h"
#include "light/guiding_tree.h"
#include "light/light_model.h"

/* Path i of n takes a random point of the i-th n-th of a Z-order curve over the unit square. `number`: the path's number among
 * all lights'. */
static void curve_point(uint32_t count, uint32_t i, uint32_t number, float *u, float *v) {
    const uint32_t high = (i << 12) / count, rest = (i << 12) - high * count; /* i * 2^32 / count in two exact steps */
    const uint32_t r = pcg(number * 2u + 0x9e3779b9u);
    const uint32_t within = (uint32_t)(((uint64_t)r * (0xffffffffu / count)) >> 32);
    const uint32_t curve = (high << 20) + (((rest << 10) / count) << 10) + within;
    *u = ((float)even_bits(curve) + unit_float(pcg(r))) * (1.0f / 65536.0f);
    *v = ((float)even_bits(curve >> 1) + unit_float(pcg(r ^ 0x85ebca6bu))) * (1.0f / 65536.0f);
}

/* Of a point, spot or directional light. */
static emission leave_light(const vit_light *light, uint32_t count, float u, float v) {
    emission e = {.power = vec3_load(light->intensity)};
    float weight;
    e.direction = light_emission(light, u, v, &e.origin, &weight);
    e.power = vec3_scale(e.power, weight * (light_whole(light) / (float)count));
    return e;
}

/* A plane sequence for the dimensions that the curve leaves (Roberts 2018), so that any stretch of paths, which start alike in
 * the curve's two, is spread in these. */
static void plane_point(uint32_t i, double *x, double *y) {
    *x = ((double)(i * LATTICE_U) + 0.5) * 0x1p-32;
    *y = ((double)(i * LATTICE_V) + 0.5) * 0x1p-32;
}

/* From a point of a shining side, by the cosine: flux pi L dA. */
static emission leave_surface(const photon_rays *rays, const area_lights *area, uint32_t count, const double at[4]) {
    const area_light_point from = area_lights_point(area, at[0], at[1]);
    if (photon_rays_covered(rays, from.triangle, from.position, from.normal))
        return (emission){.origin = from.position, .direction = from.normal};
    return (emission){.origin = from.position,
                      .direction = vec3_cosine(from.normal, (float)at[2], (float)at[3]),
                      .power = vec3_scale(from.power, KERNEL_PI / (float)count)};
}

/* Back to where it was seen from the other edge of -half .. half. */
static float wrapped(float x, float half) {
    return x - 2.0f * half * floorf((x + half) / (2.0f * half));
}

/* A square round the same disc, `around` in its middle and its edges joined. */
static emission leave_sky_guided(const photons_light *l, const double at[4]) {
    const sky_ray from = sky_choose(l->sky, at[0], at[1]);
    const float radius = l->light.spot_scale;
    const vec3 center = vec3_load(l->light.position), off = vec3_sub(l->around, center);
    vec3 ax, ay;
    vec3_across(from.direction, &ax, &ay);
    const float x = wrapped(vec3_dot(off, ax) + ((float)at[2] - 0.5f) * 2.0f * radius, radius),
                y = wrapped(vec3_dot(off, ay) + ((float)at[3] - 0.5f) * 2.0f * radius, radius);
    const float area = x * x + y * y < radius * radius ? 4.0f * radius * radius : 0.0f;
    return (emission){.origin = vec3_along(vec3_along(vec3_along(center, from.direction, radius), ax, x), ay, y),
                      .direction = vec3_scale(from.direction, -1.0f),
                      .power = vec3_scale(from.power, area / (float)l->paths)};
}

/* From the disc that the scene's sphere shows to a direction of the sky: flux L dw dA. */
static emission leave_sky(const photons_light *l, const double at[4]) {
    if (l->guide)
        return leave_sky_guided(l, at);
    const sky_ray from = sky_choose(l->sky, at[0], at[1]);
    const float radius = l->light.spot_scale;
    const vec3 center = vec3_along(vec3_load(l->light.position), from.direction, radius);
    return (emission){.origin = vec3_disc(center, from.direction, radius, (float)at[2], (float)at[3]),
                      .direction = vec3_scale(from.direction, -1.0f),
                      .power = vec3_scale(from.power, KERNEL_PI * radius * radius / (float)l->paths)};
}

uint32_t photon_emission_numbers(const photons_light *l) {
    return l->area || l->sky ? 4 : 2;
}

static emission leave_by(const photon_rays *rays, const photons_light *l, const double at[4]) {
    if (l->area)
        return leave_surface(rays, l->area, l->paths, at);
    return l->sky ? leave_sky(l, at) : leave_light(&l->light, l->paths, (float)at[0], (float)at[1]);
}

static emission leave_guided(const photon_rays *rays, const photons_light *l, uint32_t i, uint32_t number) {
    float at[GUIDING_DIMENSIONS];
    const float density = guiding_tree_point(l->guide, l->paths, i, number, at);
    const double from[4] = {(double)at[0] + 0x1p-25, (double)at[1] + 0x1p-25, (double)at[2], (double)at[3]};
    const uint32_t first = photon_emission_numbers(l);
    emission e = leave_by(rays, l, from);
    e.power = vec3_scale(e.power, 1.0f / density);
    e.bounce[0] = at[first];
    e.bounce[1] = at[first + 1];
    return e;
}

emission photon_leave(const photon_rays *rays, const photons_light *l, uint32_t i, uint32_t number) {
    if (l->guide)
        return leave_guided(rays, l, i, number);
    float u, v;
    double x, y;
    curve_point(l->paths, i, number, &u, &v);
    plane_point(i, &x, &y);
    if (photon_emission_numbers(l) == 4)
        return leave_by(rays, l, (const double[]){x, y, (double)u, (double)v});
    return leave_by(rays, l, (const double[]){(double)u, (double)v, 0, 0});
}

/* The angle of (x, y) in turns, 0..1, to 2e-6: Abramowitz and Stegun 4.4.47, so that it is the same with any libm. */
static float turn(float x, float y) {
    const float ax = fabsf(x), ay = fabsf(y), most = float_max(ax, ay), q = most > 0.0f ? float_min(ax, ay) / most : 0.0f,
                q2 = q * q;
    float a = q * (0.9998660f + q2 * (-0.3302995f + q2 * (0.1801410f + q2 * (-0.0851330f + q2 * 0.0208351f))));
    a *= 0.159154943f;
    a = ay > ax ? 0.25f - a : a;
    a = x < 0.0f ? 0.5f - a : a;
    return y < 0.0f ? 1.0f - a : a;
}

static float below_one(float x) {
    return float_min(float_max(x, 0.0f), 0x1.fffffep-1f);
}

/* The numbers of a point of the disc about `center` across n, seen along n. False: it is not in it. */
static bool disc_numbers(vec3 center, vec3 n, float radius, vec3 p, float *u, float *v) {
    vec3 ax, ay;
    vec3_across(n, &ax, &ay);
    const vec3 off = vec3_sub(p, center);
    const float x = vec3_dot(off, ax), y = vec3_dot(off, ay);
    *u = (x * x + y * y) / (radius * radius);
    *v = below_one(turn(x, y));
    return *u < 1.0f;
}

void photon_cosine_numbers(vec3 n, vec3 d, float *a, float *b) {
    vec3 ax, ay;
    vec3_across(n, &ax, &ay);
    const float c = vec3_dot(n, d);
    *a = below_one(1.0f - c * c);
    *b = below_one(turn(vec3_dot(d, ax), vec3_dot(d, ay)));
}

static arrival from_light(const vit_light *light, vec3 p) {
    arrival a = {.distance = 2.0f * light->spot_scale, .irradiance = vec3_load(light->intensity)};
    const vec3 axis = light->kind == VIT_LIGHT_POINT ? (vec3){0.0f, 1.0f, 0.0f} : vec3_load(light->direction);
    const vec3 position = vec3_load(light->position), way = vec3_sub(p, position);
    if (light->kind == VIT_LIGHT_DIRECTIONAL) {
        a.direction = vec3_scale(axis, -1.0f);
        a.distance = vec3_dot(way, axis);
        if (!disc_numbers(position, axis, light->spot_scale, p, a.at, a.at + 1))
            a.irradiance = (vec3){0.0f, 0.0f, 0.0f};
        return a;
    }
    const float d2 = vec3_dot(way, way);
    const vec3 d = vec3_unit(way);
    vec3 ax, ay;
    vec3_across(axis, &ax, &ay);
    a.direction = vec3_scale(d, -1.0f);
    a.distance = sqrtf(d2);
    a.at[0] = (1.0f - vec3_dot(d, axis)) / float_max(1.0f - light->cos_outer, 1e-20f);
    a.at[1] = below_one(turn(vec3_dot(d, ax), vec3_dot(d, ay)));
    const bool reached = a.at[0] < 1.0f && d2 > 0.0f;
    a.at[0] = below_one(a.at[0]);
    a.irradiance = vec3_scale(a.irradiance, reached ? light_cone(light, a.direction) * light_left(light, d2) / d2 : 0.0f);
    return a;
}

arrival photon_arrival(const photon_rays *rays, const photons_light *l, vec3 p, double x, double y) {
    arrival a = {.at = {below_one((float)x), below_one((float)y)}};
    if (l->area) {
        const area_light_point from = area_lights_point(l->area, x, y);
        const vec3 way = vec3_sub(p, from.position), d = vec3_unit(way);
        const float d2 = vec3_dot(way, way), facing = vec3_dot(d, from.normal);
        a.direction = vec3_scale(d, -1.0f);
        a.distance = sqrtf(d2);
        photon_cosine_numbers(from.normal, d, a.at + 2, a.at + 3);
        if (facing > 0.0f && d2 > 0.0f && !photon_rays_covered(rays, from.triangle, from.position, from.normal))
            a.irradiance = vec3_scale(from.power, facing / d2);
        return a;
    }
    if (!l->sky)
        return from_light(&l->light, p);
    const sky_ray from = sky_choose(l->sky, x, y);
    const float radius = l->light.spot_scale;
    const vec3 off = vec3_sub(p, l->around);
    vec3 ax, ay;
    vec3_across(from.direction, &ax, &ay);
    a.direction = from.direction;
    a.distance = 2.0f * radius;
    a.irradiance = from.power;
    a.at[2] = below_one(wrapped(vec3_dot(off, ax), radius) / (2.0f * radius) + 0.5f);
    a.at[3] = below_one(wrapped(vec3_dot(off, ay), radius) / (2.0f * radius) + 0.5f);
    return a;
}
