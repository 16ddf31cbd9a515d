/* Rays for dark_sides.c. Starting points and hits keep away from edges: a ray that starts within rounding of a neighbour, or a
 * hit on a silhouette, would connect the two sides of a closed wall. */
#include "dark_sides/rays.h"
#define INSET 4.0f    /* ray offsets that starting points keep from a triangle's edges, if it is large enough */
#define GRAZING 1e-3f /* a hit at a smaller cosine, or nearer to an edge (barycentric), tells no side */
#define EDGE 1e-4f
#define GLASS_MIRRORS 0.25f /* of the light that may pass: more than it does, but both ways are looked at */
#define LONGEST 32u         /* mirrors and panes in a row */
#define ONE_PLACE 0x1p-6f   /* of ray_offset: faces so close lie in one place, and the first of them is seen */

static vec scaled_sum(vec a, float s, vec b) {
    return (vec){a.x + s * b.x, a.y + s * b.y, a.z + s * b.z};
}

static float dot(vec a, vec b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static vec unit(vec a) {
    const float l = sqrtf(dot(a, a));
    return (vec){a.x / l, a.y / l, a.z / l};
}

static vec vec_of(const float p[3]) {
    return (vec){p[0], p[1], p[2]};
}

/* The four-dimensional R sequence (Roberts 2018), shifted by a hash. */
static float shifted(uint32_t shift, uint32_t i, uint32_t d) {
    static const uint32_t alpha[4] = {0xdb4f0b91u, 0xbbe05633u, 0xa0f2ec75u, 0x89e18285u}; /* 2^32 / phi4^(d + 1) */
    return (float)((shift + (i + 1u) * alpha[d]) >> 8) * 0x1p-24f;
}

float sequence(uint32_t stream, uint32_t i, uint32_t d) {
    return shifted(pcg(stream * 4u + d), i, d);
}

float side_sequence(const ray_side *s, uint32_t i, uint32_t d) {
    return shifted(s->shift[d], i, d);
}

double triangle_area(const vit_triangle *t) {
    return 0.5 * sqrt((double)t->nx * (double)t->nx + (double)t->ny * (double)t->ny + (double)t->nz * (double)t->nz);
}

static vec triangle_normal(const vit_triangle *t) {
    const float m = fmaxf(fabsf(t->nx), fmaxf(fabsf(t->ny), fabsf(t->nz))); /* first scaled: tiny and huge triangles alike */
    return unit((vec){t->nx / m, t->ny / m, t->nz / m});
}

vec side_normal(const geometry *g, uint32_t side) {
    const vec n = triangle_normal(g->triangles + side / 2);
    return side & 1 ? (vec){-n.x, -n.y, -n.z} : n;
}

const model_material *side_material(const model *m, const geometry *g, uint32_t side) {
    return m->materials + (g->attributes[side / 2].material & VIT_MATERIAL_INDEX);
}

bool material_lights(const model_material *m) {
    return m->area_light && m->kind == VIT_MATTE && (m->emission[0] > 0 || m->emission[1] > 0 || m->emission[2] > 0);
}

static float distance(const float a[3], const float b[3]) {
    const vec d = scaled_sum(vec_of(a), -1.0f, vec_of(b));
    return sqrtf(dot(d, d));
}

ray_side side_of(const geometry *g, uint32_t side) {
    const vit_triangle *t = g->triangles + side / 2;
    const float inset = INSET * g->ray_offset, twice_area = (float)(2.0 * triangle_area(t));
    const float edge[3] = {distance(t->v1, t->v2), distance(t->v2, t->v0), distance(t->v0, t->v1)};
    const vec corner[3] = {vec_of(t->v0), vec_of(t->v1), vec_of(t->v2)};
    ray_side s = {.normal = side_normal(g, side)};
    float rest = 1.0f;
    for (uint32_t k = 0; k < 4; k++)
        s.shift[k] = pcg(side * 4u + k);
    for (int k = 0; k < 3; k++) { /* barycentric: a share of the height above each edge */
        const float margin = fminf(0.25f, inset * edge[k] / twice_area);
        s.corner = scaled_sum(s.corner, margin, corner[k]);
        rest -= margin;
    }
    s.corner = scaled_sum(scaled_sum(s.corner, rest, corner[0]), g->ray_offset, s.normal);
    for (int k = 0; k < 2; k++) {
        const vec along = scaled_sum(corner[k + 1], -1.0f, corner[0]);
        s.along[k] = (vec){rest * along.x, rest * along.y, rest * along.z};
    }
    return s;
}

vec side_point(const ray_side *s, float u, float v) {
    const float root = sqrtf(u);
    return scaled_sum(scaled_sum(s->corner, root * (1.0f - v), s->along[0]), root * v, s->along[1]);
}

vec direction_about(vec n, float x, float y, float z) {
    const float sign = copysignf(1.0f, n.z), a = -1.0f / (sign + n.z), b = n.x * n.y * a;
    return (vec){(1.0f + sign * n.x * n.x * a) * x + b * y + n.x * z, sign * b * x + (sign + n.y * n.y * a) * y + n.y * z,
                 -sign * n.x * x - n.y * y + n.z * z};
}

vec cosine_direction(vec n, float u, float v) {
    const float r = sqrtf(u), height = sqrtf(fmaxf(0.0f, 1.0f - u));
    float sine, cosine;
    sincos_turn(v, &sine, &cosine);
    return unit(direction_about(n, r * cosine, r * sine, fmaxf(height, 0.02f))); /* not along its own surface */
}

/* Whose hits do not count. */
typedef struct rule {
    const ray_scene *s;
    uint32_t skip; /* a triangle that is not there for the ray; RAY_NOTHING: all are */
} rule;

static bool is_there(const void *user, const triangle_hit *h) {
    const rule *r = user;
    return h->triangle != r->skip && !(r->s->holes && side_material(r->s->m, r->s->g, 2 * h->triangle)->cutoff > 0.0f);
}

bool ray_scene_open(const model *m, const geometry *g, unsigned threads, ray_scene *out) {
    *out = (ray_scene){.g = g, .m = m, .matt = true};
    for (int i = 0; i < m->material_count; i++) {
        out->matt &= m->materials[i].kind == VIT_MATTE;
        out->holes |= m->materials[i].cutoff > 0.0f;
    }
    return triangle_rays_open(g->triangles, m->triangles, g->box_pad, threads, &out->rays);
}

void ray_scene_close(ray_scene *s) {
    triangle_rays_close(&s->rays);
}

static vec3 vec3_of(vec a) {
    return (vec3){a.x, a.y, a.z};
}

/* Distance of the line through the hit from the nearest edge, as a share of the triangle's height above it. */
static float least_share(const float weight[3]) {
    const float sum = fabsf(weight[0]) + fabsf(weight[1]) + fabsf(weight[2]);
    return float_min(float_min(fabsf(weight[0]), fabsf(weight[1])), fabsf(weight[2])) / float_max(sum, 1e-30f);
}

static uint32_t cast_but(const ray_scene *s, uint32_t skip, vec origin, vec direction, float *distance) {
    const rule r = {s, skip};
    triangle_hit h;
    if (!triangle_rays_nearest(&s->rays, vec3_of(origin), vec3_of(direction), *distance,
                               s->holes || skip != RAY_NOTHING ? is_there : NULL, &r, &h))
        return RAY_NOTHING;
    *distance = h.distance;
    const float cosine = dot(triangle_normal(s->g->triangles + h.triangle), direction);
    if (fabsf(cosine) < GRAZING || least_share(h.weight) < EDGE)
        return RAY_UNSURE;
    return 2 * h.triangle + (cosine > 0.0f);
}

static bool is_occluded(const ray_scene *s, vec origin, vec direction, float distance) {
    const rule r = {s, RAY_NOTHING};
    return triangle_rays_any(&s->rays, vec3_of(origin), vec3_of(direction), distance, s->holes ? is_there : NULL, &r);
}

uint32_t ray_scene_cast(const ray_scene *s, vec origin, vec direction, float *distance) {
    return cast_but(s, RAY_NOTHING, origin, direction, distance);
}

/* Where light goes at a mirror or glass with unit normal n on d's side. */
static vec sent_on(const model_material *m, vec d, vec n, bool back, float chance) {
    const float cosine = -dot(d, n), eta = back ? m->ior : 1.0f / m->ior, rest = 1.0f - eta * eta * (1.0f - cosine * cosine);
    const bool mirrored = m->kind == VIT_MIRROR || (m->kind == VIT_GLASS && rest < 0.0f) || chance < GLASS_MIRRORS;
    if (mirrored)
        return unit(scaled_sum(d, 2.0f * cosine, n));
    if (m->kind == VIT_THIN_GLASS)
        return d;
    const vec bent = {eta * d.x, eta * d.y, eta * d.z};
    return unit(scaled_sum(bent, eta * cosine - sqrtf(rest), n));
}

uint32_t ray_scene_follow(const ray_scene *s, vec origin, vec direction, uint32_t chance, float *distance) {
    float whole = 0.0f, way = *distance;
    if (s->matt)
        return ray_scene_cast(s, origin, direction, distance);
    for (uint32_t i = 0; i < LONGEST; i++) {
        const uint32_t side = ray_scene_cast(s, origin, direction, &way);
        const bool found = side < 2 * s->m->triangles;
        if (!found || side_material(s->m, s->g, side)->kind == VIT_MATTE) {
            if (side != RAY_NOTHING)
                *distance = whole + way;
            return side;
        }
        const vec n = side_normal(s->g, side);
        const vec on = sent_on(side_material(s->m, s->g, side), direction, n, side & 1, sequence(chance, i, 0));
        origin = scaled_sum(scaled_sum(origin, way, direction), dot(on, n) > 0.0f ? s->g->ray_offset : -s->g->ray_offset, n);
        direction = on;
        whole += way;
        way = INFINITY;
    }
    *distance = whole;
    return RAY_UNSURE;
}

bool ray_scene_passes(const ray_scene *s, vec p, vec direction, float distance) {
    if (s->matt)
        return !is_occluded(s, p, direction, distance);
    for (uint32_t i = 0; i < LONGEST; i++) {
        float way = distance;
        const uint32_t side = ray_scene_cast(s, p, direction, &way);
        if (side == RAY_NOTHING)
            return true;
        if (side >= 2 * s->m->triangles || side_material(s->m, s->g, side)->kind < VIT_GLASS)
            return false;
        way += 2.0f * s->g->ray_offset;
        p = scaled_sum(p, way, direction);
        distance -= way;
        if (!(distance > 0.0f))
            return true;
    }
    return false;
}

bool ray_scene_covered(const ray_scene *s, uint32_t side, vec p) {
    const vec n = side_normal(s->g, side);
    const float own = s->g->ray_offset;
    float t = own * (1.0f + ONE_PLACE);
    const uint32_t other = cast_but(s, side / 2, p, (vec){-n.x, -n.y, -n.z}, &t);
    return other < 2 * s->m->triangles && (other / 2 < side / 2 || t < own * (1.0f - ONE_PLACE));
}
