#include "light/photon_guiding.h"
#include "common/fail.h"
#include "common/parallel.h"
#include "light/panes.h"
#include "light/photon_emission.h"
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#define PATHS 65536u     /* from cameras, a round */
#define MOST_ROUNDS 8u   /* light that comes in by small holes is found by few paths */
#define ENOUGH 4096u     /* samples of each source that any were found of in the first round: no more rounds */
#define MOST_SAMPLES 8u  /* a path: lights that it is joined with */
#define MOST_FRAMES 64u  /* that it may start from */
#define MOST_HITS 8u     /* matt ones of a path */
#define MOST_MIRRORS 16u /* and others */

typedef struct finding {
    const photon_guiding_input *in;
    photon_rays rays;
    uint32_t sources; /* lights, area lights, sky */
    uint32_t groups;  /* of sources: path i is joined with those of group i % groups */
    uint32_t share;   /* sources of a group */
    vec3 around;
    uint32_t round;
    guiding_tree_sample *samples; /* [share][PATHS], of the round */
    double *sums;                 /* of weights, likewise */
    guiding_tree_sample **found;  /* a source: of all rounds, those that weigh anything */
    uint32_t *count;              /* of them */
    bool panes;                   /* light comes through thin glass */
} finding;

/* Random numbers of a path. */
typedef struct dice {
    uint32_t state;
} dice;

static float throw(dice * d) {
    d->state = pcg(d->state + 0x9e3779b9u);
    return unit_float(d->state);
}

static photons_light source(const finding *f, uint32_t source, uint32_t frame) {
    const uint32_t lights = f->in->tracks->light_count;
    if (source < lights && f->in->gives_photons[source])
        return (photons_light){.light = f->in->tracks->lights[(size_t)frame * lights + source], .paths = 1};
    if (source == lights && f->in->area)
        return (photons_light){.area = f->in->area, .paths = 1};
    if (source == lights + 1 && f->in->sky)
        return (photons_light){.light = f->in->sky->light, .sky = f->in->sky->sky, .around = f->around, .paths = 1};
    return (photons_light){.paths = 0};
}

/* One of the samples that a path has of a source is kept, in proportion to weights, and has all their weight. */
static void keep(finding *f, uint32_t path, uint32_t slot, const guiding_tree_sample *s, float chance) {
    const size_t i = (size_t)slot * PATHS + path % PATHS;
    f->sums[i] += (double)s->weight;
    if ((double)chance * f->sums[i] < (double)s->weight)
        f->samples[i] = *s;
    f->samples[i].weight = (float)f->sums[i];
}

/* A photon's first matt hit could be here, and its next at the place before, in direction `back`; or, seen: here, where the
 * camera looks, if the light comes through a pane. power: what of it would show. */
static void join(finding *f, uint32_t path, uint32_t frame, const photon_surface *at, vec3 back, vec3 power, bool seen,
                 dice *d) {
    for (uint32_t slot = 0; slot < f->share; slot++) {
        const uint32_t number = slot * f->groups + path % f->groups;
        const photons_light l = number < f->sources ? source(f, number, frame) : (photons_light){.paths = 0};
        if (l.paths == 0)
            continue;
        const double x = (double) throw(d) + 0x1p-25, y = (double) throw(d) + 0x1p-25;
        const arrival a = photon_arrival(&f->rays, &l, at->position, x, y);
        const float cosine = vec3_dot(at->face, a.direction);
        const vec3 light = vec3_times(vec3_scale(a.irradiance, float_max(cosine, 0.0f)), power);
        const float chance = throw(d), u = throw(d), v = throw(d);
        if (!(light.x + light.y + light.z > 0.0f))
            continue;
        float mirror;
        const vec3 arrived = vec3_times(light, panes_pass(&f->rays, f->panes, at->position, a.direction, a.distance, &mirror));
        guiding_tree_sample s = {.weight = arrived.x + arrived.y + arrived.z};
        if (!(s.weight > 0.0f) || (seen && mirror < 0.0f))
            continue;
        const uint32_t first = photon_emission_numbers(&l);
        memcpy(s.at, a.at, first * sizeof *s.at);
        if (mirror >= 0.0f) { /* the first hit is the pane's, and the photon is to go through */
            s.at[first] = float_min(mirror + (1.0f - mirror) * u, 0x1.fffffep-1f);
            s.at[first + 1] = v;
        } else {
            photon_cosine_numbers(at->face, back, s.at + first, s.at + first + 1);
        }
        keep(f, path, slot, &s, chance);
    }
}

static vec3 camera_ray(const finding *f, uint32_t path, uint32_t frame) {
    const vit_camera *c = f->in->tracks->cameras + frame;
    const float x = (float)((double)(path * LATTICE_U) * 0x1p-32 * f->in->width),
                y = (float)((double)(path * LATTICE_V) * 0x1p-32 * f->in->height);
    return vec3_unit(vec3_along(vec3_along(vec3_load(c->corner), vec3_load(c->right), x), vec3_load(c->down), y));
}

static void trace(void *user, uint32_t slot) {
    finding *f = user;
    const uint32_t path = f->round * PATHS + slot;
    const photon_guiding_input *in = f->in;
    const uint64_t effects = in->scene.effects;
    const uint32_t frames = in->frames < MOST_FRAMES ? in->frames : MOST_FRAMES,
                   frame = (uint32_t)((uint64_t)(pcg(path) % frames) * in->frames / frames);
    vec3 o = vec3_load(in->tracks->cameras[frame].eye), d = camera_ray(f, path, frame), power = {1.0f, 1.0f, 1.0f};
    dice random = {path};
    for (uint32_t matt = 0, others = 0; others < MOST_MIRRORS;) {
        float t;
        const uint32_t triangle = photon_rays_nearest(&f->rays, o, d, &t);
        if (triangle == VIT_NONE)
            return;
        const photon_surface s = photon_surface_at(&in->scene, o, d, t, triangle);
        const float u = throw(&random), v = throw(&random);
        if (!photon_is_matt(&in->scene, s.material)) {
            d = photons_specular_bounce(&s, d, t, u, &o, &power);
            others++;
            continue;
        }
        const vec3 specular = effects & VIT_BIT(SPECULAR) && s.material->kind == VIT_MATTE ? vec3_load(s.material->specular)
                                                                                           : (vec3){0.0f, 0.0f, 0.0f};
        power = vec3_times(power, vec3_along(s.albedo, specular, 1.0f));
        if (!(power.x + power.y + power.z > 0.0f))
            return;
        if (matt > 0 || f->panes)
            join(f, path, frame, &s, vec3_scale(d, -1.0f), power, matt == 0, &random);
        if (++matt == MOST_HITS || matt >= in->bounces)
            return;
        d = vec3_cosine(s.face, u, v);
        o = s.position;
    }
}

/* Adds a round's samples. False: out of memory. */
static bool collect(finding *f) {
    for (uint32_t i = 0; i < f->sources; i++) {
        const guiding_tree_sample *from = f->samples + (size_t)(i / f->groups) * PATHS;
        guiding_tree_sample *to = realloc(f->found[i], (f->count[i] + PATHS / f->groups + 1u) * sizeof *to);
        if (!to)
            return false;
        f->found[i] = to;
        for (uint32_t k = 0; k < PATHS; k++)
            if ((f->round * PATHS + k) % f->groups == i % f->groups && from[k].weight > 0.0f)
                to[f->count[i]++] = from[k];
    }
    return true;
}

static bool is_enough(const finding *f) {
    for (uint32_t i = 0; i < f->sources; i++)
        if (f->count[i] > 0 && f->count[i] < ENOUGH)
            return false;
    return true;
}

static bool trace_rounds(finding *f) {
    do {
        memset(f->samples, 0, (size_t)f->share * PATHS * sizeof *f->samples);
        memset(f->sums, 0, (size_t)f->share * PATHS * sizeof *f->sums);
        parallel_for(f->in->threads, PATHS, trace, f);
        if (!collect(f))
            return false;
    } while (++f->round < MOST_ROUNDS && !is_enough(f));
    return true;
}

/* Trees of the sources that stand still, and what each source is worth. */
static bool settle(finding *f, photon_guiding *out) {
    double all = 0;
    for (uint32_t i = 0; i < f->sources; i++) {
        const photons_light l = source(f, i, 0);
        for (uint32_t k = 0; k < f->count[i]; k++)
            out->worth[i] += (double)f->found[i][k].weight;
        all += out->worth[i];
        if (l.paths > 0 && (l.area || l.sky || f->in->tracks->still[i]) &&
            !guiding_tree_build(f->found[i], f->count[i], photon_emission_numbers(&l) + 2, out->guide + i))
            return false;
    }
    for (uint32_t i = 0; i < f->sources && all > 0; i++)
        out->worth[i] /= all;
    return true;
}

static void drop(finding *f) {
    for (uint32_t i = 0; i < f->sources && f->found; i++)
        free(f->found[i]);
    free(f->found);
    free(f->count);
    free(f->samples);
    free(f->sums);
}

vit_status photon_guiding_find(const photon_guiding_input *in, photon_guiding *out, vit_text *why) {
    const long cores = sysconf(_SC_NPROCESSORS_ONLN);
    finding f = {.in = in, .sources = in->tracks->light_count + 2};
    f.groups = (f.sources + MOST_SAMPLES - 1) / MOST_SAMPLES;
    f.share = (f.sources + f.groups - 1) / f.groups;
    f.panes = (in->scene.effects & VIT_BIT(CAUSTICS)) && panes_there(&in->scene);
    f.samples = malloc((size_t)f.share * PATHS * sizeof *f.samples);
    f.sums = malloc((size_t)f.share * PATHS * sizeof *f.sums);
    f.found = calloc(f.sources, sizeof *f.found);
    f.count = calloc(f.sources, sizeof *f.count);
    for (uint32_t i = 0; i < in->frames; i++)
        f.around = vec3_along(f.around, vec3_load(in->tracks->cameras[i].eye), 1.0f / (float)in->frames);
    *out = (photon_guiding){.around = f.around,
                            .guide = calloc(f.sources, sizeof *out->guide),
                            .worth = calloc(f.sources, sizeof *out->worth),
                            .count = f.sources};
    const vit_status failed = bake_fail(why, VIT_FAILED, "guides of photons: out of memory, or Embree fails");
    bool fine = f.samples && f.sums && f.found && f.count && out->guide && out->worth &&
                photon_rays_open(&in->scene,
                                 in->threads ? in->threads
                                 : cores > 0 ? (unsigned)cores
                                             : 1,
                                 &f.rays);
    if (fine) {
        fine = trace_rounds(&f) && settle(&f, out);
        photon_rays_close(&f.rays);
    }
    drop(&f);
    if (!fine)
        photon_guiding_free(out);
    return fine ? VIT_OK : failed;
}

void photon_guiding_free(photon_guiding *g) {
    for (uint32_t i = 0; i < g->count && g->guide; i++)
        guiding_tree_free(g->guide + i);
    free(g->guide);
    free(g->worth);
    *g = (photon_guiding){0};
}

const guiding_tree *photon_guiding_of(const photon_guiding *g, uint32_t source) {
    return g && g->guide[source].nodes ? g->guide + source : NULL;
}
