#include "reference/caustics.h"
#include "common/parallel.h"
#include "light/light_model.h"
#include "reference/sequence.h"
#include <stdlib.h>
#include <string.h>

#define PATHS (1u << 16) /* of a map, shared by the lights */
#define LEAST 1024u      /* of a light */
#define CHUNK 1024u      /* paths that a thread takes at a time */
#define EVENTS 64u       /* mirrors and glass on a path, at most */
#define ALPHA (2.0 / 3)  /* Knaus and Zwicker: squared radii go with round^(ALPHA - 1) */
#define NEIGHBOURS 12    /* photons within the first radius of a photon, about */
#define ASKED 256u       /* photons that are asked for their neighbours */
#define FLAT 0.25f       /* of the radius: how far from a place's plane photons count */

static bool gives_indirect(const path_scene *p, uint32_t light) {
    return !(p->direct_only && p->direct_only[light]);
}

bool caustics_possible(const path_scene *p) {
    bool lit = false, sent = false;
    for (uint32_t i = 0; i < p->meta->lights; i++)
        lit |= gives_indirect(p, i);
    for (uint32_t i = 0; i < p->meta->materials; i++)
        sent |= p->scene.materials[i].kind != VIT_MATTE;
    return lit && sent;
}

typedef struct tracing {
    const path_scene *p;
    caustic_photon *slots; /* of each path; passed 0: it stored none */
    uint32_t seed, of_light, paths;
} tracing;

/* Where a path starts, and the power that it has. */
static void emit(const vit_light *light, uint32_t paths, float u, float v, vec3 *o, vec3 *d, float power[3]) {
    float weight;
    *d = light_emission(light, u, v, o, &weight);
    for (int k = 0; k < 3; k++)
        power[k] = light->intensity[k] * (weight * (light_whole(light) / (float)paths));
}

/* Path i of all. */
static void trace_path(const tracing *w, uint32_t i, uint64_t *rays) {
    const path_scene *p = w->p;
    const uint32_t number = i / w->of_light, seed = pcg(w->seed ^ pcg(number));
    const vit_light *light = p->lights + number;
    caustic_photon *out = w->slots + i;
    float u, v;
    vec3 o, d;
    double weight[3] = {1, 1, 1};
    bool straight = true;
    out->passed = 0;
    if (!gives_indirect(p, number))
        return;
    sequence_point(seed, i % w->of_light, &u, &v);
    emit(light, w->of_light, u, v, &o, &d, out->power);
    for (uint32_t hit = 0; hit <= EVENTS && out->power[0] + out->power[1] + out->power[2] > 0.0f; hit++) {
        float t = 0.0f;
        *rays += 1;
        const uint32_t triangle = photon_rays_nearest(&p->rays, o, d, &t);
        if (triangle == VIT_NONE)
            return;
        const photon_surface s = photon_surface_at(&p->scene, o, d, t, triangle);
        if (hit == 0 && light->inv_range2 > 0.0f) /* the same light that direct lighting sees */
            for (int k = 0; k < 3; k++)
                out->power[k] *= light_left(light, t * t);
        if (s.material->kind == VIT_MATTE) {
            if (straight)
                return;
            for (int k = 0; k < 3; k++)
                out->power[k] = (float)((double)out->power[k] * weight[k]);
            out->position = s.position;
            out->direction = d;
            out->passed = hit;
            return;
        }
        const vec3 before = d;
        sequence_point(pcg(seed ^ pcg(hit + 1)), i % w->of_light, &u, &v);
        paths_pass_on(&s, t, (double)u, &o, &d, weight);
        straight &= s.material->kind == VIT_THIN_GLASS && vec3_dot(before, d) > 0.9999f;
    }
}

static void trace_chunk(void *user, uint32_t chunk, uint64_t *rays) {
    const tracing *w = user;
    for (uint32_t i = chunk * CHUNK; i < (chunk + 1) * CHUNK && i < w->paths; i++)
        trace_path(w, i, rays);
}

/* Number of the cell along an axis. */
static int32_t cell_of(float x, float radius) {
    return (int32_t)floorf(float_min(float_max(x / (2.0f * radius), -1e9f), 1e9f));
}

static uint32_t hash_of(const int32_t cell[3]) {
    return pcg((uint32_t)cell[0] ^ pcg((uint32_t)cell[1] ^ pcg((uint32_t)cell[2])));
}

static void cells_of(vec3 p, float radius, int32_t cell[3]) {
    cell[0] = cell_of(p.x, radius);
    cell[1] = cell_of(p.y, radius);
    cell[2] = cell_of(p.z, radius);
}

static uint32_t bucket_of(const caustics *c, vec3 p) {
    int32_t cell[3];
    cells_of(p, c->radius, cell);
    return hash_of(cell) & (c->hashes - 1);
}

/* Sorts the photons of all slots by their cells' hashes; in a cell they stay in the paths' order. */
static bool sort(const caustic_photon *slots, uint32_t paths, caustics *out) {
    out->hashes = 1;
    while (out->hashes < out->count)
        out->hashes *= 2;
    out->photons = calloc(out->count ? out->count : 1, sizeof *out->photons);
    out->first = calloc((size_t)out->hashes + 1, sizeof *out->first);
    if (!out->photons || !out->first)
        return false;
    for (uint32_t i = 0; i < paths; i++)
        if (slots[i].passed > 0)
            out->first[bucket_of(out, slots[i].position) + 1]++;
    for (uint32_t h = 0; h < out->hashes; h++)
        out->first[h + 1] += out->first[h];
    for (uint32_t i = paths; i-- > 0;) /* backwards: each bucket's end moves to its beginning */
        if (slots[i].passed > 0)
            out->photons[--out->first[bucket_of(out, slots[i].position) + 1]] = slots[i];
    memmove(out->first, out->first + 1, out->hashes * sizeof *out->first);
    out->first[out->hashes] = out->count;
    return true;
}

/* The photons of a map, unsorted. NULL: out of memory. */
static caustic_photon *trace(const path_scene *p, uint32_t number, unsigned threads, uint32_t *paths, uint32_t *count,
                             uint64_t *rays) {
    const uint32_t share = PATHS / p->meta->lights;
    tracing w = {.p = p, .seed = pcg(number ^ 0x7f4a7c15u), .of_light = share > LEAST ? share : LEAST};
    w.paths = *paths = w.of_light * p->meta->lights;
    w.slots = calloc(w.paths, sizeof *w.slots);
    if (!w.slots)
        return NULL;
    const parallel_work work = {
        .run = trace_chunk, .user = &w, .step = 1, .count = (w.paths + CHUNK - 1) / CHUNK, .threads = threads};
    (void)parallel_run(&work, rays); /* cannot be cancelled */
    *count = 0;
    for (uint32_t i = 0; i < w.paths; i++)
        *count += w.slots[i].passed > 0;
    return w.slots;
}

static int by_size(const void *a, const void *b) {
    const float x = *(const float *)a, y = *(const float *)b;
    return (x > y) - (x < y);
}

/* Squared distance to the photon's NEIGHBOURS-th nearest. */
static float neighbourhood(const caustic_photon *photons, uint32_t count, uint32_t of) {
    float near[NEIGHBOURS];
    for (int k = 0; k < NEIGHBOURS; k++)
        near[k] = INFINITY;
    for (uint32_t i = 0; i < count; i++) {
        const vec3 to = vec3_sub(photons[i].position, photons[of].position);
        float d2 = vec3_dot(to, to);
        for (int k = 0; k < NEIGHBOURS && i != of; k++)
            if (d2 < near[k]) {
                const float further = near[k];
                near[k] = d2;
                d2 = further;
            }
    }
    return near[NEIGHBOURS - 1];
}

float caustics_first_radius(const path_scene *p, unsigned threads) {
    uint32_t paths, count, asked = 0;
    uint64_t rays = 0;
    float squares[ASKED];
    caustic_photon *photons = trace(p, ~0u, threads, &paths, &count, &rays);
    if (!photons)
        return -1;
    for (uint32_t i = 0, k = 0; i < paths; i++)
        if (photons[i].passed > 0)
            photons[k++] = photons[i];
    for (; count > NEIGHBOURS && asked < ASKED && asked < count; asked++)
        squares[asked] = neighbourhood(photons, count, (uint32_t)((uint64_t)asked * count / ASKED) % count);
    free(photons);
    qsort(squares, asked, sizeof *squares, by_size);
    return asked > 0 ? float_max(sqrtf(squares[asked / 2]), 4.0f * p->meta->ray_offset) : 0.0f;
}

bool caustics_trace(const path_scene *p, float first_radius, uint32_t number, uint32_t round, unsigned threads, caustics *out,
                    uint64_t *rays) {
    uint32_t paths;
    double r2 = (double)first_radius * (double)first_radius;
    *out = (caustics){.count = 0};
    if (!(first_radius > 0.0f))
        return true;
    for (uint32_t i = 1; i <= round; i++)
        r2 *= (i + ALPHA) / (i + 1);
    out->radius = (float)sqrt(r2);
    caustic_photon *slots = trace(p, number, threads, &paths, &out->count, rays);
    const bool fine = slots && sort(slots, paths, out);
    free(slots);
    if (!fine)
        caustics_free(out);
    return fine;
}

void caustics_free(caustics *c) {
    free(c->photons);
    free(c->first);
    *c = (caustics){.count = 0};
}

static void add_photon(const caustics *c, const caustic_photon *q, const path_vertex *place, int most, double limited[3],
                       double all[3]) {
    const vec3 to = vec3_sub(q->position, place->position);
    const float r2 = c->radius * c->radius;
    double reflected[3] = {1, 1, 1};
    if (!(vec3_dot(to, to) < r2) || fabsf(vec3_dot(to, place->face)) > FLAT * c->radius ||
        !(vec3_dot(q->direction, place->face) < 0.0f))
        return;
    if (place->glossy)
        specular_reflectance(place, vec3_scale(q->direction, -1.0f), reflected);
    for (int k = 0; k < 3; k++) {
        const double light = reflected[k] * (double)q->power[k] / (PI * (double)r2);
        all[k] += light;
        limited[k] += (int)q->passed <= most ? light : 0;
    }
}

void caustics_gather(const caustics *c, const path_vertex *place, int most, double limited[3], double all[3]) {
    for (int k = 0; k < 3; k++)
        limited[k] = all[k] = 0;
    if (c->count == 0)
        return;
    int32_t low[3], high[3], cell[3], own[3];
    const vec3 p = place->position;
    const float r = c->radius;
    cells_of((vec3){p.x - r, p.y - r, p.z - r}, r, low);
    cells_of((vec3){p.x + r, p.y + r, p.z + r}, r, high);
    for (cell[2] = low[2]; cell[2] <= high[2]; cell[2]++)
        for (cell[1] = low[1]; cell[1] <= high[1]; cell[1]++)
            for (cell[0] = low[0]; cell[0] <= high[0]; cell[0]++) {
                const uint32_t h = hash_of(cell) & (c->hashes - 1);
                for (uint32_t i = c->first[h]; i < c->first[h + 1]; i++) {
                    cells_of(c->photons[i].position, r, own); /* other cells may have the same hash */
                    if (memcmp(own, cell, sizeof cell) == 0)
                        add_photon(c, c->photons + i, place, most, limited, all);
                }
            }
}
