#include "radiosity/patches_met.h"
#include "common/parallel.h"
#include "radiosity/gather.h"
#include <stdlib.h>

#define SEEN_WORTH 0.0625f /* of a cell that a camera sees, a path: it may give light, too */
#define PATHS_PER_PATCH 64u
#define PATHS_LEAST 262144u
#define PATHS_MOST 1048576u
#define PATH_HITS 8u /* at most */

/* Paths from the cameras, matt reflections as they come by chance. */
typedef struct pilot {
    const patches_input *in;
    patch_point *met; /* PATH_HITS per path; side VIT_NONE: no more */
} pilot;

static void pilot_path(void *user, uint32_t path) {
    const pilot *w = user;
    const patches_input *in = w->in;
    const photon_scene *s = in->rays->s;
    const vit_camera *c = in->tracks->cameras + pcg(path) % in->frames;
    uint32_t chance = pcg(path ^ 0x5bd1e995u);
    patch_point *met = w->met + (size_t)PATH_HITS * path;
    const float x = lattice_u(path, 0) * (float)in->width, y = lattice_v(path, 0) * (float)in->height;
    vec3 o = vec3_load(c->eye),
         d = vec3_unit(vec3_along(vec3_along(vec3_load(c->corner), vec3_load(c->right), x), vec3_load(c->down), y));
    for (uint32_t hit = 0; hit < PATH_HITS; hit++)
        met[hit] = (patch_point){.side = VIT_NONE};
    for (uint32_t hit = 0; hit < PATH_HITS; hit++) {
        const gather_hit at = gather(in->rays, in->geometry, o, d, chance);
        if (at.side == VIT_NONE)
            return;
        met[hit] = (patch_point){at.side, at.b1, at.b2};
        const float *albedo = s->materials[s->attributes[at.side / 2].material & VIT_MATERIAL_INDEX].albedo;
        chance = pcg(chance);
        if (unit_float(chance) > (albedo[0] + albedo[1] + albedo[2]) / 3.0f)
            return;
        chance = pcg(chance);
        const float u = unit_float(chance);
        chance = pcg(chance);
        const vec3 face = side_face(in->geometry, at.side);
        d = vec3_cosine(face, u, unit_float(chance));
        o = vec3_along(side_place(in->geometry, at.side, at.b1, at.b2), face, s->ray_offset);
    }
}

bool patches_find_met(const patches_input *in, patches_met *out) {
    const uint64_t wanted = (uint64_t)in->count * PATHS_PER_PATCH;
    const uint32_t paths = wanted < PATHS_LEAST ? PATHS_LEAST : wanted < PATHS_MOST ? (uint32_t)wanted : PATHS_MOST;
    out->count = (size_t)PATH_HITS * paths;
    out->places = malloc(out->count * sizeof *out->places);
    if (!out->places)
        return false;
    pilot w = {in, out->places};
    parallel_for(in->threads, paths, pilot_path, &w);
    return true;
}

void patches_met_free(patches_met *m) {
    free(m->places);
    *m = (patches_met){0};
}

/* Hits but a path's first: what a camera sees itself gets light, what is met from there gives it. */
static bool is_looked_for(size_t hit, patch_point met) {
    return hit % PATH_HITS > 0 && met.side != VIT_NONE;
}

float *patches_met_worth(const patches_met *m, const cells *c) {
    float *worth = calloc(c->count + 1u, sizeof *worth);
    for (size_t i = 0; i < m->count && worth; i++)
        if (m->places[i].side != VIT_NONE)
            worth[cells_at(c, m->places[i].side, m->places[i].b1, m->places[i].b2)] +=
                is_looked_for(i, m->places[i]) ? 1.0f : SEEN_WORTH;
    return worth;
}

void patches_keep_points(const patches_met *m, patch_set *p) {
    for (size_t i = 0; i < m->count; i++) {
        const patch_point at = m->places[i];
        const uint32_t patch = is_looked_for(i, at) ? patches_at(p, at.side, at.b1, at.b2) : VIT_NONE;
        if (patch == VIT_NONE)
            continue;
        const uint32_t before = p->met[patch]++;
        const uint32_t slot = before < PATCHES_POINTS ? before : pcg((uint32_t)i) % (before + 1);
        if (slot < PATCHES_POINTS)
            p->points[(size_t)patch * PATCHES_POINTS + slot] = at;
    }
    for (uint32_t i = 0; i < p->count; i++)
        p->point_count[i] = p->met[i] < PATCHES_POINTS ? p->met[i] : PATCHES_POINTS;
}
