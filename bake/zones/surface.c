/* Area points, the photons of the path's mean frame, and which points light can reach. A closed surface, the inside of a wall
 * or the floor under a column, must not count as area that light falls on: everything beside it would be too dark. */
#include "light/photons.h"
#include "zones/parts.h"
#include <stdlib.h>
#include <string.h>

#define MOST_POINTS (1u << 23)
#define PILOT_MOST (1u << 20) /* paths of the pilot */
#define PILOT_LEAST (1u << 15)
#define PILOT_A_PATCH 32u
#define PILOT_FRAMES 8u
#define PILOT_FIRST 0x40000000u /* path numbers, and so random numbers, that playing does not use */

/* A lattice, shifted for each stream. */
static void spread(uint32_t stream, uint32_t i, float *u, float *v) {
    *u = lattice_u(i, pcg(stream * 2u));
    *v = lattice_v(i, pcg(stream * 2u + 1u));
}

/* Surfaces farther than the radius from all that is seen do not matter. */
typedef struct nearness {
    const zones *z;
    grid g;
    vec3 *at;
    uint32_t count;
    uint8_t *near; /* a patch */
    bool found;
} nearness;

static void found_one(void *user, uint32_t item) {
    (void)item;
    ((nearness *)user)->found = true;
}

static bool place_points(zones *z, nearness *n) {
    const float want = ZONES_POINTS / (z->radius * z->radius);
    double area = 0.0;
    for (uint32_t pass = 0; pass < 2; pass++) { /* measures the area, then places the points */
        const double density = area * (double)want > MOST_POINTS ? MOST_POINTS / area : (double)want;
        double carry = 0.0;
        for (uint32_t i = 0; i < z->c->count; i++) {
            const uint32_t side = z->c->side_of[i], mine = z->patch_of[i];
            if (mine == VIT_NONE || !n->near[mine])
                continue;
            const uint32_t parts = z->c->sides[side] >> VIT_SIDE_PARTS_SHIFT;
            const double a = (double)side_area(z->g, side) / (parts * parts);
            area += pass ? 0.0 : a;
            const cell_corners k = cells_corners(z->c, i);
            for (carry += pass ? a * density : 0.0; carry >= 1.0 && z->point_count < MOST_POINTS; carry -= 1.0) {
                float u, v;
                spread(i, z->point_count, &u, &v);
                u = sqrtf(u);
                const float w0 = 1.0f - u, w1 = u * (1.0f - v), w2 = u * v;
                const float b1 = w0 * k.b1[0] + w1 * k.b1[1] + w2 * k.b1[2], b2 = w0 * k.b2[0] + w1 * k.b2[1] + w2 * k.b2[2];
                z->points[z->point_count++] =
                    (area_point){side_place(z->g, side, b1, b2), side_face(z->g, side), (float)(1.0 / density), mine, i, 0.0f};
            }
        }
        if (pass == 0) {
            const double count = area * (double)want;
            z->points = malloc(((size_t)(count < MOST_POINTS ? count : MOST_POINTS) + 16) * sizeof *z->points);
            if (!z->points)
                return false;
        }
    }
    return true;
}

/* Patches that lie within the radius of a seen cell. */
static bool find_near(zones *z, nearness *n) {
    n->near = calloc(z->patch_count + 1u, 1);
    n->at = malloc((z->c->count + 1u) * sizeof *n->at);
    if (!n->near || !n->at)
        return false;
    for (uint32_t i = 0; i < z->c->count; i++)
        if (z->receiver_of[i] != VIT_NONE)
            n->at[n->count++] = cells_center(z->c, z->g, i);
    if (!grid_make(&n->g, n->at, sizeof *n->at, n->count, z->radius))
        return false;
    /* The caller frees what `n` holds, whatever is returned. NOLINTNEXTLINE(clang-analyzer-unix.Malloc) */
    for (uint32_t i = 0; i < z->c->count; i++) {
        const uint32_t mine = z->patch_of[i];
        if (mine == VIT_NONE || n->near[mine] || n->count == 0)
            continue;
        n->found = false;
        grid_near(&n->g, cells_center(z->c, z->g, i), z->radius * (1.0f + ZONES_COARSE), found_one, n);
        n->near[mine] = n->found;
    }
    return true;
}

/* Photons that land in cells, W in the mean frame: the same paths as while playing, with other random numbers. */
static vit_status count_photons(zones *z, float *flux, vit_text *why) {
    const vit_scene *s = z->in->scene;
    const uint32_t probes = s->frames < PILOT_FRAMES ? s->frames : PILOT_FRAMES;
    uint32_t paths = z->patch_count < PILOT_MOST / PILOT_A_PATCH ? z->patch_count * PILOT_A_PATCH : PILOT_MOST;
    paths = (paths < PILOT_LEAST ? PILOT_LEAST : paths) / probes;
    photons_light *lights = calloc(s->lights + 2u, sizeof *lights);
    vit_status status = lights ? VIT_OK : VIT_FAILED;
    for (uint32_t f = 0; f < probes && status == VIT_OK; f++) {
        const vit_light *frame =
            z->in->tracks->lights + (size_t)(probes > 1 ? f * (s->frames - 1) / (probes - 1) : 0) * s->lights;
        uint32_t count = 0, found = 0;
        for (uint32_t i = 0; i < s->lights; i++)
            if (z->in->gives_photons[i] && frame[i].intensity[0] + frame[i].intensity[1] + frame[i].intensity[2] > 0.0f)
                lights[count++] = (photons_light){.light = frame[i], .guide = photon_guiding_of(z->in->guiding, i)};
        if (z->in->area_lights)
            lights[count++] =
                (photons_light){.area = z->in->area_lights, .guide = photon_guiding_of(z->in->guiding, s->lights)};
        if (z->in->sky)
            lights[count++] = *z->in->sky;
        for (uint32_t i = 0; i < count; i++)
            lights[i].paths = paths / count > 0 ? paths / count : 1;
        photons_input in = {.triangles = z->g->triangles,
                            .attributes = z->g->attributes,
                            .triangle_count = z->in->triangles,
                            .materials = z->in->materials,
                            .atlas = z->in->atlas,
                            .ray_offset = s->ray_offset,
                            .box_pad = s->box_pad,
                            .radius = s->radius,
                            .effects = s->effects,
                            .bounces = s->bounces,
                            .first_path = PILOT_FIRST + f * PILOT_MOST,
                            .cells = z->c,
                            .lights = lights,
                            .light_count = count};
        vit_photon *photons = NULL;
        status = count ? photons_bake(&in, z->in->threads, &photons, &found, why) : VIT_OK;
        for (uint32_t i = 0; i < found; i++)
            flux[photons[i].zone] += (photons[i].power[0] + photons[i].power[1] + photons[i].power[2]) * photons[i].radius2 /
                                     (float)probes; /* powers are per area of each photon's own disc */
        free(photons);
    }
    free(lights);
    return status;
}

typedef struct opening {
    zones *z;
    float far; /* metres */
} opening;

/* Does a photon that comes down on the point's place land there: not on a face that lies in the same place or closely in front,
 * and not in a hole? Then it is surface for one face alone, however many a file holds there. */
static bool catches(const zones *z, const area_point *p, vec3 from) {
    const uint32_t triangle = z->c->side_of[p->cell] / 2;
    return !photon_rays_covered(&z->rays, triangle, from, p->n) &&
           photon_opaque_at(&z->scene, from, vec3_scale(p->n, -1.0f), triangle);
}

/* A point is open if one of a few rays from it goes far, to a side that light reaches, or leaves the scene, or meets a mirror
 * or glass. */
static void look_out(void *user, uint32_t i) {
    const opening *o = user;
    zones *z = o->z;
    area_point *p = z->points + i;
    const vec3 from = vec3_along(p->p, p->n, z->in->scene->ray_offset);
    const uint32_t tries = catches(z, p, from) ? ZONES_TRIES : 0;
    vec3 ax, ay;
    vec3_across(p->n, &ax, &ay);
    for (uint32_t k = 0; k < tries; k++) {
        float u, v, s, c, t;
        spread(i, k, &u, &v);
        sincos_turn(v, &s, &c);
        const float r = sqrtf(u), h = sqrtf(float_max(1.0f - u, 4e-4f)); /* not along its own surface */
        const vec3 d = vec3_unit(vec3_along(vec3_along(vec3_scale(p->n, h), ax, r * c), ay, r * s));
        const uint32_t triangle = photon_rays_nearest(&z->rays, from, d, &t);
        if (triangle == VIT_NONE || !zones_lands(z, triangle))
            return;
        const uint32_t side = 2 * triangle + (vec3_dot(side_face(z->g, 2 * triangle), d) > 0.0f);
        if (t > o->far && !side_is_dark(z->g, side))
            return;
    }
    p->area = 0.0f;
}

/* Sorts the open points by patch, keeping their order, and sums patches up. A cell's photons belong to its points; those of
 * cells too small to have any, to all points of their patch. */
static bool settle_points(zones *z, const float *flux) {
    area_point *sorted = malloc((z->point_count + 1u) * sizeof *sorted);
    uint32_t *open_of_cell = calloc(z->c->count, sizeof *open_of_cell);
    float *pointless = calloc(z->patch_count + 1u, sizeof *pointless); /* W */
    if (!sorted || !open_of_cell || !pointless) {
        free(sorted);
        free(open_of_cell);
        free(pointless);
        return false;
    }
    for (uint32_t i = 0; i < z->point_count; i++) {
        z->patches[z->points[i].patch].count += z->points[i].area > 0.0f;
        open_of_cell[z->points[i].cell] += z->points[i].area > 0.0f;
    }
    for (uint32_t i = 0; i < z->c->count; i++)
        if (open_of_cell[i] == 0 && z->patch_of[i] != VIT_NONE)
            pointless[z->patch_of[i]] += flux[i];
    for (uint32_t i = 0, at = 0; i < z->patch_count; i++) {
        if (z->patches[i].count)
            pointless[i] /= (float)z->patches[i].count;
        z->patches[i].first = at;
        at += z->patches[i].count;
        z->patches[i].count = 0;
    }
    uint32_t kept = 0;
    for (uint32_t i = 0; i < z->point_count; i++) {
        area_point p = z->points[i];
        if (!(p.area > 0.0f))
            continue;
        patch *of = z->patches + p.patch;
        p.flux = flux[p.cell] / (float)open_of_cell[p.cell] + pointless[p.patch];
        of->center = vec3_along(of->center, p.p, 1.0f);
        of->area += p.area;
        z->found->open_area += (double)p.area;
        sorted[of->first + of->count++] = p;
        kept++;
    }
    for (uint32_t i = 0; i < z->patch_count; i++)
        if (z->patches[i].count)
            z->patches[i].center = vec3_scale(z->patches[i].center, 1.0f / (float)z->patches[i].count);
    free(open_of_cell);
    free(pointless);
    free(z->points);
    z->points = sorted;
    z->point_count = kept;
    return true;
}

static float diagonal(const zones *z) {
    vec3 lo = vec3_load(z->g->triangles[0].v0), hi = lo;
    for (uint32_t i = 0; i < z->in->triangles; i++) {
        const vit_triangle *t = z->g->triangles + i;
        const float *v[3] = {t->v0, t->v1, t->v2};
        for (int k = 0; k < 3; k++) {
            lo = (vec3){float_min(lo.x, v[k][0]), float_min(lo.y, v[k][1]), float_min(lo.z, v[k][2])};
            hi = (vec3){float_max(hi.x, v[k][0]), float_max(hi.y, v[k][1]), float_max(hi.z, v[k][2])};
        }
    }
    const vec3 d = vec3_sub(hi, lo);
    return sqrtf(vec3_dot(d, d));
}

bool zones_patches(zones *z, vit_text *why) {
    nearness n = {.z = z};
    float *flux = calloc(z->c->count, sizeof *flux);
    z->patches = calloc(z->patch_count + 1u, sizeof *z->patches);
    bool fine = flux && z->patches && find_near(z, &n) && count_photons(z, flux, why) == VIT_OK && place_points(z, &n);
    if (fine) {
        for (uint32_t i = 0; i < z->c->count; i++)
            if (z->patch_of[i] != VIT_NONE)
                z->patches[z->patch_of[i]].flux += flux[i];
        opening o = {z, float_min(z->radius, diagonal(z) * ZONES_FAR)};
        parallel_for(z->in->threads, z->point_count, look_out, &o);
        fine = settle_points(z, flux);
    }
    grid_free(&n.g);
    free(n.at);
    free(n.near);
    free(flux);
    return fine;
}
