/* The method of kernels/photons.cl, step for step and operation for operation; hits are the kernels', too, of triangles
 * that Embree proposes (triangle_rays.c). Power: see vit_photon. */
#include "light/photons.h"
#include "common/fail.h"
#include "common/parallel.h"
#include "light/light_model.h"
#include "light/photon_emission.h"
#include "light/photon_specular.h"
#include <stdlib.h>

#define CHUNK 1024u /* paths that a thread takes at a time */

typedef struct baking {
    const photons_input *in;
    photon_rays rays;
    vit_photon *slots; /* zero: empty */
    uint64_t paths;    /* of all lights */
} baking;

/* The bounce's two random numbers; photon_numbers() of kernels/photons.cl. */
static void bounce_numbers(uint32_t number, uint32_t hit, bool sequence, float *u, float *v) {
    static const uint32_t alpha[6] = VIT_BOUNCE_ALPHA;
    const uint32_t seed = pcg(number ^ pcg(hit * 2u + 1u)), k = hit % 3u * 2u;
    *u = unit_float(sequence ? number * alpha[k] + pcg(hit * 2u + 1u) : seed);
    *v = unit_float(sequence ? number * alpha[k + 1u] + pcg(hit * 2u + 2u) : pcg(seed));
}

/* Of one that lands `way` metres from the surface that reflected it; photon_radius() of kernels/photons.cl. */
static float photon_radius(float radius, float way, float facing) {
    const float near = VIT_PHOTON_NEAR * way / float_max(facing, 1e-6f);
    return float_min(radius, float_max(near, VIT_PHOTON_LEAST * radius));
}

/* power: W, incident; whole: the scene's radius. As photon_store() of kernels/photons.cl. */
static void store(vit_photon *q, vec3 p, vec3 d, vec3 power, float radius, float whole, uint32_t zone) {
    const float r2 = radius * radius, inv = 1.0f / r2, spread = float_max(radius, VIT_PHOTON_CAP * whole),
                scale = 2.0f * KERNEL_INV_PI * (1.0f / (spread * spread));
    *q = (vit_photon){.position = {p.x, p.y, p.z},
                      .radius2 = r2,
                      .direction = {d.x, d.y, d.z},
                      .inv_radius2 = inv,
                      .power = {power.x * scale, power.y * scale, power.z * scale},
                      .zone = zone};
}

static uint32_t cell_of(const baking *b, vec3 direction, uint32_t triangle, const float weight[3]) {
    const vit_triangle *t = b->in->triangles + triangle;
    const uint32_t back = vec3_dot((vec3){t->nx, t->ny, t->nz}, direction) > 0.0f;
    return b->in->cells ? cells_at(b->in->cells, 2 * triangle + back, weight[1], weight[2]) : 0;
}

static bool has_power(vec3 p) {
    return p.x + p.y + p.z > 0.0f;
}

vec3 photons_specular_bounce(const photon_surface *s, vec3 d, float t, float u, vec3 *o, vec3 *power) {
    const vit_material *m = s->material;
    vec3 tint = vec3_load(m->specular);
    vec3 on = specular_mirrored(d, s->normal, s->face);
    *o = s->position;
    if (m->kind != VIT_MIRROR) {
        const bool thin = m->kind == VIT_THIN_GLASS;
        const specular_paths p = specular_at_glass(d, s->normal, s->face, s->back, thin, m->ior);
        if (s->back && !thin)
            *power = vec3_times(*power, specular_absorbed(vec3_load(m->absorption), t));
        if (u >= p.mirror) {
            on = p.refracted;
            *o = s->beyond;
        } else {
            on = p.mirrored;
            tint = (vec3){1.0f, 1.0f, 1.0f};
        }
    }
    *power = vec3_times(*power, tint);
    return on;
}

/* Path i of a light; its k-th photon goes to slots[k * paths + i]. A photon is stored at every matt hit but the first hit,
 * which is direct light. */
static void trace_path(const baking *b, const photons_light *l, vit_photon *slots, uint32_t i, uint32_t number) {
    const uint32_t bounces = b->in->bounces;
    const uint64_t effects = b->in->effects;
    const emission start = photon_leave(&b->rays, l, i, number);
    vec3 o = start.origin, d = start.direction, power = start.power;
    vec3 from = {0.0f, 0.0f, 0.0f}; /* normal of the matt surface that the photon comes from; 0: of none */
    if (!has_power(power))
        return;
    for (uint32_t hit = 0; hit < bounces; hit++) {
        float t = 0.0f;
        const uint32_t triangle = photon_rays_nearest(&b->rays, o, d, &t);
        if (triangle == VIT_NONE)
            return;
        float weight_of[3], u, v;
        const photon_surface s = photon_surface_seen(b->rays.s, o, d, t, triangle, PHOTON_CONE, weight_of);
        if (b->in->met)
            __atomic_store_n(&b->in->met[s.material - b->in->materials], 1, __ATOMIC_RELAXED);
        const bool matt = photon_is_matt(b->rays.s, s.material);
        if (!matt && !(effects & VIT_BIT(CAUSTICS)))
            return;
        if (hit > 0 && matt)
            store(slots + (size_t)(hit - 1) * l->paths + i, s.position, d, power,
                  photon_radius(b->in->radius, t, -vec3_dot(from, s.face)), b->in->radius, cell_of(b, d, triangle, weight_of));
        if (hit == 0 && !l->area && !l->sky)
            power = vec3_scale(power, light_left(&l->light, t * t));
        bounce_numbers(number, hit, b->in->sequence, &u, &v);
        if (hit == 0 && l->guide) {
            u = start.bounce[0];
            v = start.bounce[1];
        }
        if (matt) {
            const vec3 specular = effects & VIT_BIT(SPECULAR) && s.material->kind == VIT_MATTE ? vec3_load(s.material->specular)
                                                                                               : (vec3){0.0f, 0.0f, 0.0f};
            power = vec3_times(power, vec3_along(s.albedo, specular, 1.0f));
            d = vec3_cosine(s.face, u, v);
            o = s.position;
            from = s.face;
        } else {
            from = (vec3){0.0f, 0.0f, 0.0f};
            d = photons_specular_bounce(&s, d, t, u, &o, &power);
        }
        if (!has_power(power))
            return;
    }
}

/* Threads touch no slot twice, so their order leaves no trace. */
static void trace_chunk(void *user, uint32_t chunk, uint64_t *sum) {
    const baking *b = user;
    const uint64_t begin = (uint64_t)chunk * CHUNK, last = begin + CHUNK < b->paths ? begin + CHUNK : b->paths;
    (void)sum;
    const photons_light *l = b->in->lights;
    uint64_t first = 0; /* path of light l */
    for (uint64_t path = begin; path < last; path++) {
        while (path - first >= l->paths)
            first += l++->paths;
        vit_photon *slots = b->slots + first * (b->in->bounces - 1);
        trace_path(b, l, slots, (uint32_t)(path - first), (uint32_t)(b->in->first_path + path));
    }
}

static void report(void *user, double fraction) {
    const baking *b = user;
    if (b->in->progress)
        b->in->progress(b->in->user, fraction);
}

/* Moves the photons to the front, in their order; how many there are. */
static uint32_t compact(vit_photon *slots, size_t count) {
    uint32_t kept = 0;
    for (size_t i = 0; i < count; i++)
        if (slots[i].radius2 > 0.0f)
            slots[kept++] = slots[i];
    return kept;
}

/* Counts the paths of all lights. Both they and the slots must stay below 2^32: path numbers and photon indices are 32 bits. */
static vit_status count_paths(const photons_input *in, uint64_t *paths, vit_text *why) {
    *paths = 0;
    for (uint32_t i = 0; i < in->light_count; i++) {
        if (in->lights[i].paths > PHOTONS_MAX_PATHS) {
            return bake_fail(why, VIT_BAD_INPUT, "photons: a light has at most %u paths, still light %u has %u",
                             PHOTONS_MAX_PATHS, i, in->lights[i].paths);
        }
        *paths += in->lights[i].paths;
    }
    if (*paths + in->first_path <= UINT32_MAX && *paths * (in->bounces - 1) <= UINT32_MAX)
        return VIT_OK;
    return bake_fail(why, VIT_BAD_INPUT, "photons: %llu paths of %u bounces are too many", (unsigned long long)*paths,
                     in->bounces);
}

vit_status photons_bake(const photons_input *in, unsigned threads, vit_photon **out, uint32_t *count, vit_text *why) {
    *out = NULL;
    *count = 0;
    const photon_scene s = {.triangles = in->triangles,
                            .attributes = in->attributes,
                            .triangle_count = in->triangle_count,
                            .materials = in->materials,
                            .atlas = in->atlas,
                            .ray_offset = in->ray_offset,
                            .box_pad = in->box_pad,
                            .effects = in->effects};
    baking b = {.in = in};
    if (in->bounces < 2)
        return VIT_OK;
    const vit_status status = count_paths(in, &b.paths, why);
    if (status != VIT_OK || b.paths == 0)
        return status;
    threads = parallel_threads(threads, 1);
    const size_t slots = (size_t)b.paths * (in->bounces - 1);
    b.slots = slots <= SIZE_MAX / sizeof *b.slots ? calloc(slots, sizeof *b.slots) : NULL;
    if (!b.slots || !photon_rays_open(&s, threads, &b.rays)) {
        const bool room = b.slots != NULL;
        free(b.slots);
        return bake_fail(why, VIT_FAILED, "photons: %s", room ? "Embree fails" : "out of memory");
    }
    const parallel_work work = {.run = trace_chunk,
                                .done = report,
                                .user = &b,
                                .step = 1,
                                .count = (uint32_t)((b.paths + CHUNK - 1) / CHUNK),
                                .threads = threads};
    uint64_t sum = 0;
    (void)parallel_run(&work, &sum); /* cannot be cancelled */
    report(&b, 1.0);
    photon_rays_close(&b.rays);
    *count = compact(b.slots, slots);
    *out = *count ? realloc(b.slots, *count * sizeof *b.slots) : NULL;
    if (!*out && *count)
        *out = b.slots; /* it did not shrink, and is as good */
    else if (!*count)
        free(b.slots);
    return VIT_OK;
}
