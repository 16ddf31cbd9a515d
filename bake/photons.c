/* The method of kernels/photons.cl, step for step and operation for operation; only the hits come from Embree, which finds the
 * same triangle but for rounding at edges. Power: see vit_photon. */
#include "photons.h"
#include "photon_rays.h"
#include <pthread.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

#define CHUNK 1024u /* paths that a thread takes at a time */
#define MAX_THREADS 256u

typedef struct baking {
    const photons_input *in;
    photon_rays rays;
    vit_photon *slots;         /* zero: empty */
    uint64_t paths;            /* of all lights */
    atomic_uint_fast64_t next; /* chunk */
} baking;

/* Fraction of a light's intensity that goes into `direction`; light_cone() of kernels/direct.cl. */
static float cone(const vit_light *light, vec3 direction) {
    if (light->kind != VIT_LIGHT_SPOT)
        return 1.0f;
    const float cosine = vec3_dot(direction, vec3_load(light->direction));
    const float a = float_min(float_max(fmaf(cosine, light->spot_scale, light->spot_offset), 0.0f), 1.0f);
    return a * a;
}

/* What a range changes about the light's irradiance at squared distance d2; light_falloff() of kernels/direct.cl, times d2. */
static float range_factor(const vit_light *light, float d2) {
    if (!(light->inv_range2 > 0.0f))
        return 1.0f;
    const float q = d2 * light->inv_range2;
    if (light->falloff == VIT_FALLOFF_WINDOW)
        return float_max(1.0f - q, 0.0f) * d2;
    const float window = float_max(1.0f - q * q, 0.0f);
    return window * window / d2 * d2;
}

/* Path i of n takes a random point of the i-th n-th of a Z-order curve over the unit square of directions. `number`: the path's
 * number among all lights'. *weight: the light's intensity in that direction over that on its axis. */
static vec3 emission(const vit_light *light, uint32_t count, uint32_t i, uint32_t number, float *weight) {
    const uint32_t high = (i << 12) / count, rest = (i << 12) - high * count; /* i * 2^32 / count in two exact steps */
    const uint32_t r = pcg(number * 2u + 0x9e3779b9u);
    const uint32_t within = (uint32_t)(((uint64_t)r * (0xffffffffu / count)) >> 32);
    const uint32_t curve = (high << 20) + (((rest << 10) / count) << 10) + within;
    const float u = ((float)even_bits(curve) + unit_float(pcg(r))) * (1.0f / 65536.0f);
    const float v = ((float)even_bits(curve >> 1) + unit_float(pcg(r ^ 0x85ebca6bu))) * (1.0f / 65536.0f);
    const float c = fmaf(u, light->cos_outer - 1.0f, 1.0f), s = sqrtf(float_max(1.0f - c * c, 0.0f));
    float sp, cp;
    sincos_turn(v, &sp, &cp);
    const vec3 axis = light->kind == VIT_LIGHT_SPOT ? vec3_load(light->direction) : (vec3){0.0f, 1.0f, 0.0f};
    vec3 ax, ay;
    vec3_across(axis, &ax, &ay);
    const vec3 d = vec3_unit(vec3_along(vec3_along(vec3_scale(axis, c), ax, s * cp), ay, s * sp));
    *weight = cone(light, d);
    return d;
}

/* Cosine-distributed direction about n from the bounce's two random numbers; photon_numbers() of kernels/photons.cl. */
static vec3 bounce(vec3 n, uint32_t number, uint32_t hit, bool sequence) {
    static const uint32_t alpha[6] = VIT_BOUNCE_ALPHA;
    const uint32_t seed = pcg(number ^ pcg(hit * 2u + 1u)), k = hit % 3u * 2u;
    const float a = unit_float(sequence ? number * alpha[k] + pcg(hit * 2u + 1u) : seed);
    const float b = unit_float(sequence ? number * alpha[k + 1u] + pcg(hit * 2u + 2u) : pcg(seed));
    const float s = sqrtf(a), c = sqrtf(float_max(1.0f - a, 0.0f));
    float sp, cp;
    sincos_turn(b, &sp, &cp);
    vec3 ax, ay;
    vec3_across(n, &ax, &ay);
    return vec3_unit(vec3_along(vec3_along(vec3_scale(n, c), ax, s * cp), ay, s * sp));
}

/* power: W, incident. */
static void store(vit_photon *q, vec3 p, vec3 d, vec3 power, float radius, uint32_t zone) {
    const float r2 = radius * radius, inv = 1.0f / r2, scale = 2.0f * PHOTON_INV_PI * inv;
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

/* Path i of a light; its k-th photon goes to slots[k * paths + i]. A photon is stored at every hit but the first, which is
 * direct light. */
static void trace_path(const baking *b, const photons_light *l, vit_photon *slots, uint32_t i, uint32_t number) {
    const uint32_t bounces = b->in->bounces;
    float weight;
    vec3 o = vec3_load(l->light.position), d = emission(&l->light, l->paths, i, number, &weight);
    const float share = weight * (2.0f * PHOTON_PI * (1.0f - l->light.cos_outer) / (float)l->paths);
    vec3 power = vec3_scale(vec3_load(l->light.intensity), share);
    if (!(share > 0.0f))
        return;
    for (uint32_t hit = 0; hit < bounces; hit++) {
        float t = 0.0f;
        const uint32_t triangle = photon_rays_nearest(&b->rays, o, d, &t);
        if (triangle == VIT_NONE)
            return;
        float weight_of[3];
        const photon_surface s = photon_surface_seen(b->rays.s, o, d, t, triangle, PHOTON_CONE, weight_of);
        if (hit > 0)
            store(slots + (size_t)(hit - 1) * l->paths + i, s.position, d, power, b->in->radius, cell_of(b, d, triangle, weight_of));
        else
            power = vec3_scale(power, range_factor(&l->light, t * t));
        power = vec3_times(power, s.albedo);
        if (!(power.x + power.y + power.z > 0.0f))
            return;
        d = bounce(s.face, number, hit, b->in->sequence);
        o = s.position;
    }
}

static void trace_chunk(const baking *b, uint64_t chunk) {
    const uint64_t last = (chunk + 1) * CHUNK < b->paths ? (chunk + 1) * CHUNK : b->paths;
    const photons_light *l = b->in->lights;
    uint64_t first = 0; /* path of light l */
    for (uint64_t path = chunk * CHUNK; path < last; path++) {
        while (path - first >= l->paths)
            first += l++->paths;
        vit_photon *slots = b->slots + first * (b->in->bounces - 1);
        trace_path(b, l, slots, (uint32_t)(path - first), (uint32_t)(b->in->first_path + path));
    }
}

/* Takes chunks until none is left. Threads touch no slot twice, so their order leaves no trace. */
static void trace_chunks(baking *b, bool reports) {
    const uint64_t chunks = (b->paths + CHUNK - 1) / CHUNK;
    for (;;) {
        const uint64_t chunk = atomic_fetch_add(&b->next, 1);
        if (chunk >= chunks)
            return;
        trace_chunk(b, chunk);
        if (reports && b->in->progress)
            b->in->progress(b->in->user, (double)chunk / (double)chunks);
    }
}

static void *worker(void *user) {
    trace_chunks(user, false);
    return NULL;
}

/* On `threads` threads, this one included; on fewer if the system gives no more. */
static void trace_all(baking *b, unsigned threads) {
    pthread_t pool[MAX_THREADS];
    unsigned started = 0;
    while (started + 1 < threads && pthread_create(pool + started, NULL, worker, b) == 0)
        started++;
    trace_chunks(b, true);
    for (unsigned i = 0; i < started; i++)
        pthread_join(pool[i], NULL);
    if (b->in->progress)
        b->in->progress(b->in->user, 1.0);
}

/* Moves the photons to the front, in their order; how many there are. */
static uint32_t compact(vit_photon *slots, size_t count) {
    uint32_t kept = 0;
    for (size_t i = 0; i < count; i++)
        if (slots[i].radius2 > 0.0f)
            slots[kept++] = slots[i];
    return kept;
}

static unsigned thread_count(unsigned asked) {
    const long cores = sysconf(_SC_NPROCESSORS_ONLN);
    const unsigned threads = asked ? asked : cores > 0 ? (unsigned)cores : 1;
    return threads < MAX_THREADS ? threads : MAX_THREADS;
}

/* Counts the paths of all lights. Both they and the slots must stay below 2^32: path numbers and photon indices are 32 bits. */
static vit_status count_paths(const photons_input *in, uint64_t *paths, vit_text *why) {
    *paths = 0;
    for (uint32_t i = 0; i < in->light_count; i++) {
        if (in->lights[i].paths > PHOTONS_MAX_PATHS) {
            snprintf(why->text, sizeof why->text, "photons: a light has at most %u paths, still light %u has %u",
                     PHOTONS_MAX_PATHS, i, in->lights[i].paths);
            return VIT_BAD_INPUT;
        }
        *paths += in->lights[i].paths;
    }
    if (*paths + in->first_path <= UINT32_MAX && *paths * (in->bounces - 1) <= UINT32_MAX)
        return VIT_OK;
    snprintf(why->text, sizeof why->text, "photons: %llu paths of %u bounces are too many", (unsigned long long)*paths,
             in->bounces);
    return VIT_BAD_INPUT;
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
    threads = thread_count(threads);
    const size_t slots = (size_t)b.paths * (in->bounces - 1);
    b.slots = slots <= SIZE_MAX / sizeof *b.slots ? calloc(slots, sizeof *b.slots) : NULL;
    if (!b.slots || !photon_rays_open(&s, threads, &b.rays)) {
        snprintf(why->text, sizeof why->text, "photons: %s", b.slots ? "Embree fails" : "out of memory");
        free(b.slots);
        return VIT_FAILED;
    }
    trace_all(&b, threads);
    photon_rays_close(&b.rays);
    *count = compact(b.slots, slots);
    *out = *count ? realloc(b.slots, *count * sizeof *b.slots) : NULL;
    if (!*out && *count)
        *out = b.slots; /* it did not shrink, and is as good */
    else if (!*count)
        free(b.slots);
    return VIT_OK;
}
