#include "reference/light_sampling.h"
#include "common/colour.h"
#include "light/sky.h"
#include <stdlib.h>

static const vit_material *material_of(const photon_scene *s, uint32_t triangle) {
    return s->materials + (s->attributes[triangle].material & VIT_MATERIAL_INDEX);
}

static vec3 normal_of(const photon_scene *s, uint32_t triangle) {
    const vit_triangle *t = s->triangles + triangle;
    return (vec3){t->nx, t->ny, t->nz};
}

static double area_of(const photon_scene *s, uint32_t triangle) {
    const vec3 n = normal_of(s, triangle);
    return 0.5 * sqrt((double)n.x * (double)n.x + (double)n.y * (double)n.y + (double)n.z * (double)n.z);
}

static double light_of(const photon_scene *s, uint32_t triangle) {
    const vit_material *m = material_of(s, triangle);
    return m->lights ? luminance_of(m->emission) : 0;
}

static bool open_area(light_sampler *e) {
    const photon_scene *s = e->scene;
    double sum = 0;
    for (uint32_t i = 0; i < s->triangle_count; i++)
        e->count += light_of(s, i) > 0;
    if (e->count == 0)
        return true;
    e->triangles = calloc(e->count, sizeof *e->triangles);
    e->ends = calloc(e->count, sizeof *e->ends);
    e->density = calloc((size_t)s->triangle_count + 1, sizeof *e->density);
    if (!e->triangles || !e->ends || !e->density)
        return false;
    for (uint32_t i = 0, k = 0; i < s->triangle_count; i++)
        if (light_of(s, i) > 0) {
            sum += light_of(s, i) * area_of(s, i);
            e->triangles[k] = i;
            e->ends[k++] = sum;
        }
    for (uint32_t k = 0; k < e->count; k++)
        e->density[e->triangles[k]] = light_of(s, e->triangles[k]) / sum;
    return true;
}

/* Texel (x, y) of -1 .. sky_size. */
static const float *texel(const light_sampler *e, int64_t x, int64_t y) {
    return e->sky[(y + 1) * (e->sky_size + 2) + x + 1].radiance;
}

/* What the texel's square gets of the picture between texels, by the square's solid angle. */
static double share_of(const light_sampler *e, uint32_t x, uint32_t y) {
    static const double part[3] = {0.125, 0.75, 0.125}; /* the mean of linear interpolation over the square */
    double sum = 0;
    for (int j = -1; j <= 1; j++)
        for (int i = -1; i <= 1; i++)
            sum += part[i + 1] * part[j + 1] * luminance_of(texel(e, (int64_t)x + i, (int64_t)y + j));
    double solid;
    (void)sky_place(2 * (x + 0.5) / e->sky_size - 1, 2 * (y + 0.5) / e->sky_size - 1, &solid);
    return sum * solid;
}

static bool open_sky(light_sampler *e) {
    const size_t size = e->sky_size;
    if (!e->sky || !e->sky_lights)
        return true;
    e->sky_rows = calloc(size, sizeof *e->sky_rows);
    e->sky_texels = calloc(size * size, sizeof *e->sky_texels);
    if (!e->sky_rows || !e->sky_texels)
        return false;
    double rows = 0;
    for (uint32_t y = 0; y < size; y++) {
        double sum = 0;
        for (uint32_t x = 0; x < size; x++) {
            sum += share_of(e, x, y);
            e->sky_texels[y * size + x] = sum;
        }
        rows += sum;
        e->sky_rows[y] = rows;
    }
    return true;
}

bool light_sampler_open(const vit_scene *meta, const photon_scene *s, const vit_sky_texel *sky, light_sampler *out) {
    *out = (light_sampler){.scene = s,
                           .background = meta->background,
                           .sky = meta->sky_size > 0 ? sky : NULL,
                           .sky_size = meta->sky_size,
                           .sky_lights = (meta->effects & VIT_BIT(SKY_LIGHT)) != 0};
    if (open_area(out) && open_sky(out))
        return true;
    light_sampler_close(out);
    return false;
}

void light_sampler_close(light_sampler *e) {
    free(e->triangles);
    free(e->ends);
    free(e->density);
    free(e->sky_rows);
    free(e->sky_texels);
    *e = (light_sampler){0};
}

void light_sampler_sky(const light_sampler *e, vec3 d, double radiance[3]) {
    const vec3 c = e->sky ? sky_picture(e->sky, e->sky_size, d) : vec3_load(e->background);
    radiance[0] = (double)c.x;
    radiance[1] = (double)c.y;
    radiance[2] = (double)c.z;
}

bool light_sampler_has(const light_sampler *e, uint32_t triangle) {
    return e->density && e->density[triangle] > 0;
}

/* The part that holds *at, of parts that end at ends[0] < ends[1] < ...; *at becomes the place in it, 0..1. */
static uint32_t choose(const double *ends, uint32_t count, double *at) {
    const double sought = *at * ends[count - 1];
    uint32_t low = 0, high = count - 1;
    while (low < high) {
        const uint32_t middle = low + (high - low) / 2;
        if (ends[middle] > sought)
            high = middle;
        else
            low = middle + 1;
    }
    const double from = low > 0 ? ends[low - 1] : 0, size = ends[low] - from;
    *at = size > 0 ? fmin((sought - from) / size, 1) : 0;
    return low;
}

bool light_sampler_area_point(const light_sampler *e, vec3 p, double u, double v, light_sampler_point *out) {
    const uint32_t triangle = e->triangles[choose(e->ends, e->count, &u)];
    const vit_triangle *t = e->scene->triangles + triangle;
    const double root = sqrt(u), b1 = root * (1 - v), b2 = root * v, b0 = 1 - root;
    vec3 to;
    to.x = (float)(b0 * (double)t->v0[0] + b1 * (double)t->v1[0] + b2 * (double)t->v2[0] - (double)p.x);
    to.y = (float)(b0 * (double)t->v0[1] + b1 * (double)t->v1[1] + b2 * (double)t->v2[1] - (double)p.y);
    to.z = (float)(b0 * (double)t->v0[2] + b1 * (double)t->v1[2] + b2 * (double)t->v2[2] - (double)p.z);
    const float distance = sqrtf(vec3_dot(to, to));
    out->to = vec3_unit(to);
    out->distance = distance * 0.9999f; /* not the light itself */
    out->density = light_sampler_area_density(e, triangle, out->to, distance);
    for (int k = 0; k < 3; k++)
        out->radiance[k] = (double)material_of(e->scene, triangle)->emission[k];
    return isfinite(out->density) && out->density > 0 && photon_opaque_at(e->scene, p, out->to, triangle);
}

bool light_sampler_sky_point(const light_sampler *e, double u, double v, light_sampler_point *out) {
    const uint32_t size = e->sky_size;
    if (!e->sky_rows || !(e->sky_rows[size - 1] > 0))
        return false;
    const uint32_t y = choose(e->sky_rows, size, &v), x = choose(e->sky_texels + (size_t)y * size, size, &u);
    double solid;
    out->to = sky_place(2 * (x + u) / size - 1, 2 * (y + v) / size - 1, &solid);
    out->distance = 3e38f;
    out->density = light_sampler_sky_density(e, out->to);
    light_sampler_sky(e, out->to, out->radiance);
    return out->density > 0;
}

double light_sampler_area_density(const light_sampler *e, uint32_t triangle, vec3 d, float distance) {
    const double cosine = fabs((double)vec3_dot(vec3_unit(normal_of(e->scene, triangle)), d));
    return e->density ? e->density[triangle] * (double)distance * (double)distance / fmax(cosine, 1e-12) : 0;
}

/* A piece dx dy of the square is the piece of the unit octahedron |x| + |y| + |z| = 1 above it, of solid angle dx dy / (x2 + y2
 * + z2)^1.5. */
double light_sampler_sky_density(const light_sampler *e, vec3 d) {
    if (!e->sky_rows || !(e->sky_rows[e->sky_size - 1] > 0))
        return 0;
    float u, v;
    const uint32_t size = e->sky_size;
    octahedral_place(d, &u, &v);
    const uint32_t x = (uint32_t)fmin(((double)u + 1) / 2 * size, size - 1.0),
                   y = (uint32_t)fmin(((double)v + 1) / 2 * size, size - 1.0);
    const double *row = e->sky_texels + (size_t)y * size;
    const double share = (row[x] - (x > 0 ? row[x - 1] : 0)) / e->sky_rows[size - 1];
    const double sum = fabs((double)d.x) + fabs((double)d.y) + fabs((double)d.z); /* of a unit vector: 1 / length there */
    return share * size * size / 4 / (sum * sum * sum);
}
