#include "common/parallel.h"
#include "light/panes.h"
#include "radiosity/transport_parts.h"
#include <stdlib.h>
#include <string.h>

#define LEAST_SAMPLES 4u    /* of each light that is found by chance, at each of a cell's places */
#define VARIES 0.25         /* deviation over mean of direct light, from which on a cell's mean is not good enough close by */
#define BLOCK 64u           /* cells that are alike in how light varies on them */
#define MOST_SAMPLES 16384u /* of a cell */

/* A light that is everywhere else than at one place or in one direction: looked at by chance. */
static bool is_sampled(const photons_light *l) {
    return l->area || l->sky;
}

typedef struct lighting {
    transport *t;
    float *radiosity;
    float *weight;    /* a number: how much of its light receivers get, summed */
    double all;       /* of weight, summed */
    double looks;     /* that a place takes, at least: lights of all states */
    double *variance; /* a number: of one sample, all columns added up */
    double *mean;     /* a number: of the same samples */
    uint32_t *more;   /* a number: further samples */
    bool again;       /* these are taken */
} lighting;

/* How near an area light is if it is so near that places on it are a poor choice, as its squared distance varies much: rays
 * that a cell sends out meet it there. m */
static float near_of(const transport *t, const photons_light *l) {
    return l->area && !t->in->panes ? sqrtf((float)(l->area->area / (4.0 * 3.14159265358979))) : 0.0f;
}

typedef struct spot {
    vec3 position, face, normal, albedo;
} spot;

static spot spot_at(const transport *t, const transport_place *p, float edge) {
    const photon_scene *s = t->in->rays->s;
    const vec3 face = side_face(t->in->geometry, p->side);
    const float high = float_max(edge, 4.0f * s->ray_offset);
    float b[3];
    const vec3 above = vec3_along(transport_place_at(t, p), face, high);
    const photon_surface at = photon_surface_seen(s, above, vec3_scale(face, -1.0f), high, p->side / 2, 0.25f, b);
    return (spot){.position = vec3_along(transport_place_at(t, p), face, s->ray_offset),
                  .face = face,
                  .normal = at.normal,
                  .albedo = photon_reflectance(s, &at)};
}

static vec3 light_that_passes(const transport *t, const spot *at, const arrival *a, uint32_t *likely) {
    float mirror;
    if (t->in->panes)
        return panes_pass(t->in->rays, true, at->position, a->direction, a->distance, &mirror);
    const float part = photon_rays_occluded_likely(t->in->rays, at->position, a->direction,
                                                   a->distance - 2.0f * t->in->rays->s->ray_offset, likely)
                           ? 0.0f
                           : 1.0f;
    return (vec3){part, part, part};
}

/* Radiosity by one look at a light. */
static vec3 look(const transport *t, const photons_light *l, const spot *at, double x, double y, uint32_t *likely,
                 uint64_t *rays) {
    const arrival a = photon_arrival(t->in->rays, l, at->position, x, y);
    if (a.distance < near_of(t, l))
        return (vec3){0.0f, 0.0f, 0.0f};
    const float cosine = vec3_dot(at->normal, a.direction);
    if (!(cosine > 0.0f) || !(vec3_dot(at->face, a.direction) > 0.0f) ||
        !(a.irradiance.x + a.irradiance.y + a.irradiance.z > 0.0f))
        return (vec3){0.0f, 0.0f, 0.0f};
    *rays += 1;
    return vec3_times(vec3_times(vec3_scale(a.irradiance, cosine), light_that_passes(t, at, &a, likely)), at->albedo);
}

static bool shines(const area_lights *e, uint32_t side) {
    uint32_t low = 0, high = e->count;
    while (low < high) {
        const uint32_t middle = low + (high - low) / 2;
        if (e->side[middle] < side)
            low = middle + 1;
        else
            high = middle;
    }
    return low < e->count && e->side[low] == side;
}

/* Radiosity by one ray to what shines near by. */
static vec3 look_near(const transport *t, const photons_light *l, const spot *at, float x, float y, uint64_t *rays) {
    const photon_scene *s = t->in->rays->s;
    const vec3 d = vec3_cosine(at->normal, x, y), none = {0.0f, 0.0f, 0.0f};
    float distance;
    if (!(vec3_dot(at->face, d) > 0.0f))
        return none;
    *rays += 1;
    const uint32_t triangle = photon_rays_nearest(t->in->rays, at->position, d, &distance);
    if (triangle == VIT_NONE || !(distance < near_of(t, l)))
        return none;
    const uint32_t side = 2 * triangle + (vec3_dot(d, side_face(t->in->geometry, 2 * triangle)) > 0.0f);
    if (!shines(l->area, side))
        return none;
    const float *own = s->materials[s->attributes[triangle].material & VIT_MATERIAL_INDEX].emission;
    return vec3_scale(vec3_times(vec3_load(own), at->albedo), 3.14159265f);
}

static void add(float *to, vec3 v, float scale) {
    to[0] += v.x * scale;
    to[1] += v.y * scale;
    to[2] += v.z * scale;
}

static float numbers(uint32_t seed, uint32_t i, float *v) {
    *v = lattice_v(i, pcg(seed ^ 0x68bc21ebu));
    return lattice_u(i, seed);
}

/* One sample of a cell's radiosity in all states; repeats: of lights that are found by chance. Returns the sum. */
static double light_place(const transport *t, const spot *at, uint32_t seed, uint32_t first, uint32_t repeats, float scale,
                          float *to, transport_shadows *known, uint64_t *rays) {
    double sum = 0.0;
    uint32_t n = 0;
    for (uint32_t s = 0; s < t->in->state_count; s++)
        for (uint32_t i = 0; i < t->in->states[s].count; i++) {
            const photons_light *light = t->in->states[s].lights + i;
            const uint32_t looks = is_sampled(light) ? repeats : 1;
            uint32_t *likely = known->triangle + n++ % TRANSPORT_SHADOWS;
            *likely = *likely == VIT_NONE ? known->last : *likely;
            for (uint32_t k = 0; k < looks; k++) {
                float v;
                const float u = numbers(pcg(seed ^ pcg(i)), first + k, &v);
                vec3 e = look(t, light, at, (double)u, (double)v, likely, rays);
                if (near_of(t, light) > 0.0f)
                    e = vec3_along(e, look_near(t, light, at, v, u, rays), 1.0f);
                add(to + 3 * s, e, scale / (float)looks);
                sum += ((double)e.x + (double)e.y + (double)e.z) / looks;
            }
            known->last = *likely;
        }
    return sum;
}

void transport_light_at(const transport *t, uint32_t n, const transport_place *p, uint32_t seed, float scale, float *to,
                        transport_shadows *known, uint64_t *rays) {
    const spot at = spot_at(t, p, t->edge[t->cells.side_of[transport_cell(t, n)]]);
    light_place(t, &at, seed, 0, 1, scale, to, known, rays);
}

/* At how many places a cell is looked at first: fewer where receivers get little from it and looks are many. */
static uint32_t first_places(const lighting *l, uint32_t n) {
    const double wanted =
        l->all > 0.0 ? ceil(l->t->in->looks / l->looks * (double)l->weight[n] * l->t->in->cells / l->all) : 0.0;
    const uint32_t most = l->t->place_count[n];
    return wanted < 1.0 ? 1 : wanted < most ? (uint32_t)wanted : most;
}

static void light_cell(void *user, uint32_t n, uint64_t *rays) {
    const lighting *l = user;
    const transport *t = l->t;
    float *to = l->radiosity + (size_t)n * t->columns;
    const uint32_t places = first_places(l, n);
    const float edge = t->edge[t->cells.side_of[transport_cell(t, n)]];
    double sum = 0.0, squares = 0.0;
    transport_shadows known;
    memset(&known, 0xff, sizeof known);
    memset(to, 0, t->columns * sizeof *to);
    for (uint32_t p = 0; p < places; p++) {
        const spot at = spot_at(t, t->places + (size_t)n * TRANSPORT_PLACES + p, edge);
        const double all = light_place(t, &at, n, p * LEAST_SAMPLES, LEAST_SAMPLES, 1.0f / (float)places, to, &known, rays);
        sum += all;
        squares += all * all;
    }
    /* A single place tells nothing of how light varies: as much as it is itself. */
    const double mean = l->mean[n] = sum / places;
    const double spread = squares - mean * sum; /* rounding may make it negative */
    l->variance[n] = places == 1 ? mean * mean : spread > 0.0 ? spread / (places - 1) : 0.0;
}

/* A place of the cell's part that chance finds, if one of the places where rays met it sees it. */
static bool further_place(const transport *t, uint32_t n, uint32_t k, float edge, transport_place *out) {
    const uint32_t cell = transport_cell(t, n), side = t->cells.side_of[cell];
    const cell_corners c = cells_corners(&t->cells, cell);
    const vec3 up = vec3_scale(side_face(t->in->geometry, side), separation_lift(t->in->rays, edge));
    const float u = sqrtf(lattice_u(k, pcg(n))), v = lattice_v(k, pcg(n ^ 0x5bd1e995u));
    const float w[3] = {1.0f - u, u * (1.0f - v), u * v};
    *out = (transport_place){.side = side};
    for (int i = 0; i < 3; i++) {
        out->b1 += w[i] * c.b1[i];
        out->b2 += w[i] * c.b2[i];
    }
    const vec3 at = transport_place_at(t, out);
    if (separations_part(&t->apart, cell, at) != t->cell[n] % SEPARATION_PARTS)
        return false;
    const transport_place *known = t->places + (size_t)n * TRANSPORT_PLACES + pcg(k) % t->place_count[n];
    return separation_sees(t->in->rays, vec3_along(at, up, 1.0f), vec3_along(transport_place_at(t, known), up, 1.0f));
}

static void light_more(void *user, uint32_t n, uint64_t *rays) {
    const lighting *l = user;
    const transport *t = l->t;
    if (l->more[n] == 0)
        return;
    float *to = l->radiosity + (size_t)n * t->columns;
    const uint32_t places = first_places(l, n);
    const float edge = t->edge[t->cells.side_of[transport_cell(t, n)]];
    uint32_t count = places;
    double sum = 0.0, squares = 0.0;
    transport_shadows known;
    memset(&known, 0xff, sizeof known);
    for (uint32_t c = 0; c < t->columns; c++)
        to[c] *= (float)places;
    for (uint32_t k = 0; k < l->more[n]; k++) {
        transport_place p;
        if (!further_place(t, n, k, edge, &p))
            continue;
        const spot at = spot_at(t, &p, edge);
        const double all = light_place(t, &at, n, places * LEAST_SAMPLES + k, 1, 1.0f, to, &known, rays);
        sum += all;
        squares += all * all;
        count++;
    }
    if (count > places) {
        const double mean = sum / (count - places), spread = squares - mean * sum;
        l->mean[n] = mean;
        l->variance[n] = count == places + 1 ? mean * mean : spread > 0.0 ? spread / (count - places - 1) : 0.0;
    }
    for (uint32_t c = 0; c < t->columns; c++)
        to[c] /= (float)count;
}

/* Of a block's two halves, each every second of its cells, the one that this cell is in. */
static uint32_t half_of(const transport *t, uint32_t n) {
    const uint32_t cell = transport_cell(t, n);
    return 2u * (cell / BLOCK) + (cell & 1u);
}

/* How many more samples each cell gets: half of them in proportion to what receivers get from it, half to what its deviation
 * does to them. The deviation is that of other cells round about, every second one: if a cell's own first samples had a say, it
 * would be left alone where they have missed the light, and so light would be lost. False: out of memory. */
static bool share_out(lighting *l) {
    const transport *t = l->t;
    const uint32_t blocks = 2u * (t->cells.count / BLOCK + 1u);
    double all = 0.0, *variance = calloc(blocks, sizeof *variance);
    uint32_t *count = calloc(blocks, sizeof *count);
    if (variance && count && l->looks > 0.0) {
        for (uint32_t i = 0; i < t->count; i++) {
            variance[half_of(t, i)] += l->variance[i];
            count[half_of(t, i)]++;
        }
        for (uint32_t b = 0; b < blocks; b++)
            variance[b] = count[b] ? sqrt(variance[b] / count[b]) : 0.0;
        for (uint32_t i = 0; i < t->count; i++)
            all += (double)l->weight[i] * variance[half_of(t, i) ^ 1u];
        for (uint32_t i = 0; i < t->count && all > 0.0; i++) {
            const double w = (double)l->weight[i];
            const double part =
                (w / l->all + w * variance[half_of(t, i) ^ 1u] / all) * 0.5 * t->in->looks * t->in->cells / l->looks;
            l->more[i] = part < MOST_SAMPLES ? (uint32_t)part : MOST_SAMPLES;
        }
    }
    const bool fine = variance && count;
    free(variance);
    free(count);
    return fine;
}

static void find_weight(lighting *l) {
    const transport_rows *g = &l->t->gathers;
    for (size_t k = 0; k < g->first[g->count]; k++)
        l->weight[g->to[k]] += g->factor[k];
    for (uint32_t i = 0; i < l->t->count; i++)
        l->all += (double)l->weight[i];
    for (uint32_t s = 0; s < l->t->in->state_count; s++)
        l->looks += l->t->in->states[s].count;
}

static void lighting_step(void *user, double fraction) {
    const lighting *l = user;
    transport_step(l->t, TRANSPORT_BOUNCED, TRANSPORT_LIT, ((l->again ? 1.0 : 0.0) + fraction) / 2);
}

bool transport_direct(transport *t, float *radiosity) {
    lighting l = {.t = t, .radiosity = radiosity};
    l.weight = calloc(t->count + 1u, sizeof *l.weight);
    l.variance = malloc((t->count + 1u) * sizeof *l.variance);
    l.mean = malloc((t->count + 1u) * sizeof *l.mean);
    l.more = calloc(t->count + 1u, sizeof *l.more);
    t->varies = malloc((t->count + 1u) * sizeof *t->varies);
    bool fine = l.weight && l.variance && l.mean && l.more && t->varies;
    if (fine) {
        find_weight(&l);
        parallel_work work = {
            .run = light_cell, .done = lighting_step, .user = &l, .step = 1, .count = t->count, .threads = t->in->threads};
        parallel_run(&work, &t->report->light_rays);
        fine = share_out(&l);
        work.run = light_more;
        l.again = true;
        parallel_run(&work, &t->report->light_rays);
        for (uint32_t i = 0; i < t->count; i++)
            t->varies[i] = l.variance[i] > VARIES * VARIES * l.mean[i] * l.mean[i];
    }
    free(l.weight);
    free(l.variance);
    free(l.mean);
    free(l.more);
    return fine;
}

void transport_albedo(const transport *t, uint32_t n, float out[3]) {
    const float edge = t->edge[t->cells.side_of[transport_cell(t, n)]];
    out[0] = out[1] = out[2] = 0.0f;
    for (uint32_t p = 0; p < t->place_count[n]; p++)
        add(out, spot_at(t, t->places + (size_t)n * TRANSPORT_PLACES + p, edge).albedo, 1.0f / (float)t->place_count[n]);
}
