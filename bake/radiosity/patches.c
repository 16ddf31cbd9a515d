#include "radiosity/patches.h"
#include "common/fail.h"
#include "common/parallel.h"
#include "radiosity/gather.h"
#include "radiosity/patches_met.h"
#include "radiosity/patches_parted.h"
#include <stdlib.h>
#include <string.h>

#define CELLS_PER_PATCH 6.0f /* cells are that much smaller than patches, if triangles are not small enough by themselves */
#define BEND 1.0f            /* a quarter turn weighs as much as a distance of that many square roots of a patch's mean area */
#define PAIRS 32u            /* pairs of a cluster's cells that are asked whether they see each other */
#define LIFT 0.05f           /* how far above the surface these look, in square roots of the cluster's area */
#define HIDDEN_WEIGHT 15.0   /* a cluster whose cells are all hidden from each other weighs so many times as much again */
#define KEPT_FOR_HIDDEN 8u   /* of so many patches one is kept for clusters with hidden cells, however small they are */
#define ALBEDO_SAMPLES 4u    /* places of a cell whose texels are looked at */

typedef struct cluster {
    uint32_t first, count; /* of order[] */
    double badness;
    uint32_t fork, right; /* of which fork it is which half; VIT_NONE: it is all */
    double hidden;        /* share of pairs */
    uint32_t apart[2];    /* cells that are hidden from each other, where some are */
    float lift;           /* m, above the surface where cells look at each other */
    float axis[6];        /* unit, in the space of place and normal times `bend` */
    float middle;         /* along it */
} cluster;

/* How a cluster was split, for cells that no path has met. */
typedef struct fork {
    float axis[6], middle; /* or, with `pair`, between two cells */
    bool pair;
    uint32_t apart[2];
    uint32_t next[2]; /* left and right: a fork, or a cluster with LEAF */
} fork;
#define LEAF 0x80000000u

typedef struct clustering {
    const patches_input *in;
    patch_set *p;
    uint32_t *order;
    float *at; /* 6 a cell: place, m, and normal times `bend` */
    float *area;
    patches_met met;
    float *worth; /* a cell: patches_met_worth() */
    float bend;
    cluster *clusters; /* a heap: the worst first */
    fork *forks;
    uint32_t fork_count;
    uint32_t count;
    bool last; /* the patches that are kept for clusters with hidden cells */
} clustering;

static float cell_edge(void *user, uint32_t side) {
    (void)side;
    return *(const float *)user;
}

static bool reflects(const photon_scene *s, uint32_t triangle) {
    const vit_material *m = s->materials + (s->attributes[triangle].material & VIT_MATERIAL_INDEX);
    return gather_is_matt(s, triangle) &&
           m->albedo[0] + m->albedo[1] + m->albedo[2] + m->specular[0] + m->specular[1] + m->specular[2] > 0.0f;
}

static bool is_in(const patches_input *in, uint32_t side) {
    return !side_is_dark(in->geometry, side) && reflects(in->rays->s, side / 2) && side_area(in->geometry, side) > 0.0f;
}

/* Cells of sides that belong to patches, in order[], with places and normals. False: out of memory. */
static bool find_cells(clustering *k) {
    const cells *c = &k->p->cells;
    k->order = malloc((c->count + 1u) * sizeof *k->order);
    k->at = malloc((c->count + 1u) * 6u * sizeof *k->at);
    k->area = malloc((c->count + 1u) * sizeof *k->area);
    k->worth = patches_met_worth(&k->met, c);
    if (!k->order || !k->at || !k->area || !k->worth)
        return false;
    uint32_t count = 0;
    for (uint32_t i = 0; i < c->count; i++) {
        k->p->patch_of[i] = VIT_NONE;
        k->area[i] = cells_area(c, k->in->geometry, i);
        if (!is_in(k->in, c->side_of[i]) || !(k->area[i] > 0.0f) || !(k->worth[i] > 0.0f) || k->p->apart.of[i] != VIT_NONE)
            continue;
        k->p->area += (double)k->area[i];
        k->order[count++] = i;
    }
    k->clusters[0] = (cluster){.count = count, .fork = VIT_NONE};
    k->bend = BEND * (float)sqrt(k->p->area / k->in->count);
    for (uint32_t i = 0; i < count; i++) {
        float *at = k->at + 6 * (size_t)k->order[i];
        const vec3 p = cells_center(c, k->in->geometry, k->order[i]), n = side_face(k->in->geometry, c->side_of[k->order[i]]);
        const float values[6] = {p.x, p.y, p.z, n.x * k->bend, n.y * k->bend, n.z * k->bend};
        memcpy(at, values, sizeof values);
    }
    return true;
}

/* Does a cell of the cluster see another, from a little above the surface? Cells that turn away from each other do not count.
 */
enum { SEEN, HIDDEN, TURNED };
static int sees(const clustering *k, const cluster *c, uint32_t a, uint32_t b) {
    const float *pa = k->at + 6 * (size_t)a, *pb = k->at + 6 * (size_t)b;
    const vec3 na = vec3_unit(vec3_load(pa + 3)), nb = vec3_unit(vec3_load(pb + 3));
    const vec3 from = vec3_along(vec3_load(pa), na, c->lift), to = vec3_along(vec3_load(pb), nb, c->lift);
    const vec3 way = vec3_sub(to, from);
    const float distance = sqrtf(vec3_dot(way, way));
    if (a == b || !(distance > 0.0f))
        return SEEN;
    if (vec3_dot(na, nb) <= 0.0f)
        return TURNED;
    return photon_rays_occluded(k->in->rays, from, vec3_scale(way, 1.0f / distance), distance) ? HIDDEN : SEEN;
}

/* Share of pairs of the cluster's cells that something between them hides from each other, seen from a little above. */
static double hidden_share(const clustering *k, cluster *c) {
    const uint32_t all = c->count * (c->count - 1) / 2, pairs = c->count < 12 && all < PAIRS ? all : PAIRS;
    uint32_t hidden = 0;
    for (uint32_t i = 0, x = 0, y = 1; i < pairs && c->count > 1; i++) {
        const uint32_t a = k->order[c->first + (pairs == all ? x : pcg(2 * i) % c->count)],
                       b = k->order[c->first + (pairs == all ? y : pcg(2 * i + 1) % c->count)];
        if (sees(k, c, a, b) == HIDDEN) {
            hidden++;
            c->apart[0] = a;
            c->apart[1] = b;
        }
        if (++y == c->count) {
            x++;
            y = x + 1;
        }
    }
    return pairs ? (double)hidden / pairs : 0.0;
}

/* How much a cluster wants to be split, and where: across the axis along which it is longest (the largest eigenvector of its
 * covariance, by powers of the matrix). */
static void judge(void *user, uint32_t item) {
    clustering *k = user;
    cluster *c = k->clusters + item;
    double sum = 0.0, area = 0.0, mean[6] = {0}, covariance[6][6] = {{0}};
    for (uint32_t i = c->first; i < c->first + c->count; i++) {
        const double a = (double)k->worth[k->order[i]];
        sum += a;
        area += (double)k->area[k->order[i]];
        for (int d = 0; d < 6; d++)
            mean[d] += a * (double)k->at[6 * (size_t)k->order[i] + (size_t)d];
    }
    for (int d = 0; d < 6; d++)
        mean[d] /= sum > 0.0 ? sum : 1.0;
    for (uint32_t i = c->first; i < c->first + c->count; i++) {
        const double a = (double)k->worth[k->order[i]];
        double v[6];
        for (int d = 0; d < 6; d++)
            v[d] = (double)k->at[6 * (size_t)k->order[i] + (size_t)d] - mean[d];
        for (int x = 0; x < 6; x++)
            for (int y = 0; y < 6; y++)
                covariance[x][y] += a * v[x] * v[y];
    }
    double axis[6] = {1.0, 0.9, 0.8, 0.7, 0.6, 0.5}, extent = 0.0;
    for (int step = 0; step < 24; step++) {
        double next[6] = {0}, length = 0.0;
        for (int x = 0; x < 6; x++) {
            for (int y = 0; y < 6; y++)
                next[x] += covariance[x][y] * axis[y];
            length += next[x] * next[x];
        }
        length = sqrt(length);
        extent = length;
        for (int x = 0; x < 6 && length > 0.0; x++)
            axis[x] = next[x] / length;
    }
    c->middle = 0.0f;
    for (int d = 0; d < 6; d++) {
        c->axis[d] = (float)axis[d];
        c->middle += (float)(axis[d] * mean[d]);
    }
    c->lift = LIFT * (float)sqrt(area);
    c->hidden = hidden_share(k, c);
    c->badness = c->count < 2 ? 0.0 : k->last ? sum * c->hidden + 1e-9 * extent : extent * (1.0 + HIDDEN_WEIGHT * c->hidden);
}

static void sink(clustering *k, uint32_t i) {
    for (;;) {
        uint32_t worst = i;
        for (uint32_t child = 2 * i + 1; child <= 2 * i + 2 && child < k->count; child++)
            if (k->clusters[child].badness > k->clusters[worst].badness)
                worst = child;
        if (worst == i)
            return;
        const cluster c = k->clusters[i];
        k->clusters[i] = k->clusters[worst];
        k->clusters[worst] = c;
        i = worst;
    }
}

static void rise(clustering *k, uint32_t i) {
    while (i > 0 && k->clusters[i].badness > k->clusters[(i - 1) / 2].badness) {
        const cluster c = k->clusters[i];
        k->clusters[i] = k->clusters[(i - 1) / 2];
        k->clusters[(i - 1) / 2] = c;
        i = (i - 1) / 2;
    }
}

static float distance2(const clustering *k, uint32_t a, uint32_t b) {
    float sum = 0.0f;
    for (size_t d = 0; d < 6; d++) {
        const float way = k->at[6 * (size_t)a + d] - k->at[6 * (size_t)b + d];
        sum += way * way;
    }
    return sum;
}

/* In which half of its cluster is the cell? With the one that it sees of two that are hidden from each other. */
static bool is_left(const clustering *k, const cluster *c, uint32_t cell) {
    if (c->hidden > 0.0) {
        const bool a = sees(k, c, cell, c->apart[0]) == SEEN, b = sees(k, c, cell, c->apart[1]) == SEEN;
        return a != b ? a : distance2(k, cell, c->apart[0]) < distance2(k, cell, c->apart[1]);
    }
    float sum = 0.0f;
    for (int d = 0; d < 6; d++)
        sum += c->axis[d] * k->at[6 * (size_t)cell + (size_t)d];
    return sum < c->middle;
}

/* Splits the worst cluster in two; false: it is one cell, or all its cells are in one place. */
static bool split(clustering *k) {
    const cluster c = k->clusters[0];
    uint32_t low = c.first, high = c.first + c.count;
    if (!(c.badness > 0.0))
        return false;
    while (low < high) {
        const uint32_t cell = k->order[low];
        if (is_left(k, &c, cell)) {
            low++;
            continue;
        }
        k->order[low] = k->order[--high];
        k->order[high] = cell;
    }
    uint32_t left = low - c.first;
    if (left == 0 || left == c.count)
        left = c.count / 2;
    const uint32_t at = k->fork_count++;
    fork *f = k->forks + at;
    *f = (fork){.middle = c.middle, .pair = c.hidden > 0.0, .apart = {c.apart[0], c.apart[1]}};
    memcpy(f->axis, c.axis, sizeof f->axis);
    if (c.fork != VIT_NONE)
        k->forks[c.fork].next[c.right] = at;
    k->clusters[0] = (cluster){.first = c.first, .count = left, .fork = at, .right = 0};
    k->clusters[k->count] = (cluster){.first = c.first + left, .count = c.count - left, .fork = at, .right = 1};
    judge(k, 0);
    judge(k, k->count);
    k->count++;
    sink(k, 0);
    rise(k, k->count - 1);
    return true;
}

/* Mean reflectance of a cell, with that of its lobe, which in indirect light reflects as much as a matt surface would. */
static void cell_albedo(const patches_input *in, const cells *c, uint32_t cell, float edge, double out[3]) {
    const photon_scene *s = in->rays->s;
    const uint32_t side = c->side_of[cell];
    const cell_corners k = cells_corners(c, cell);
    const vec3 face = side_face(in->geometry, side);
    for (uint32_t i = 0; i < ALBEDO_SAMPLES; i++) {
        const float u = sqrtf(((float)i + 0.5f) / ALBEDO_SAMPLES), v = unit_float(i * 0x9e3779b9u + 0x40000000u);
        const float w[3] = {1.0f - u, u * (1.0f - v), u * v};
        float b1 = 0.0f, b2 = 0.0f, b[3];
        for (int corner = 0; corner < 3; corner++) {
            b1 += w[corner] * k.b1[corner];
            b2 += w[corner] * k.b2[corner];
        }
        const vec3 origin = vec3_along(side_place(in->geometry, side, b1, b2), face, edge);
        const photon_surface found = photon_surface_seen(s, origin, vec3_scale(face, -1.0f), edge, side / 2, 0.5f, b);
        const vec3 reflectance = photon_reflectance(s, &found);
        out[0] += (double)reflectance.x / ALBEDO_SAMPLES;
        out[1] += (double)reflectance.y / ALBEDO_SAMPLES;
        out[2] += (double)reflectance.z / ALBEDO_SAMPLES;
    }
}

/* The patch of a cell that was not clustered: that where the tree of splits leads. */
static uint32_t place(const clustering *k, uint32_t cell) {
    const vec3 p = cells_center(&k->p->cells, k->in->geometry, cell), n = side_face(k->in->geometry, k->p->cells.side_of[cell]);
    const float at[6] = {p.x, p.y, p.z, n.x * k->bend, n.y * k->bend, n.z * k->bend};
    memcpy(k->at + 6 * (size_t)cell, at, sizeof at);
    uint32_t i = k->fork_count ? 0 : LEAF;
    while (!(i & LEAF)) {
        const fork *f = k->forks + i;
        float sum = 0.0f;
        for (int d = 0; d < 6; d++)
            sum += f->axis[d] * at[d];
        const bool left = f->pair ? distance2(k, cell, f->apart[0]) < distance2(k, cell, f->apart[1]) : sum < f->middle;
        i = f->next[left ? 0 : 1];
    }
    return i & ~LEAF;
}

static int by_first(const void *a, const void *b) {
    const cluster *x = a, *y = b;
    return x->first < y->first ? -1 : x->first > y->first;
}

static int by_index(const void *a, const void *b) {
    const uint32_t x = *(const uint32_t *)a, y = *(const uint32_t *)b;
    return x < y ? -1 : x > y;
}

typedef struct finishing {
    clustering *k;
    float edge;
} finishing;

/* What a patch is, from the cells of its cluster. */
static void finish(void *user, uint32_t item) {
    const finishing *f = user;
    clustering *k = f->k;
    patch_set *p = k->p;
    const cluster *c = k->clusters + item;
    double sum = 0.0, center[3] = {0}, normal[3] = {0}, albedo[3] = {0};
    for (uint32_t i = c->first; i < c->first + c->count; i++) {
        const uint32_t cell = p->cell[i];
        const double a = (double)k->area[cell];
        double reflected[3] = {0};
        cell_albedo(k->in, &p->cells, cell, f->edge, reflected);
        sum += a;
        p->cell_sum[i] = sum;
        p->patch_of[cell] = item;
        for (int d = 0; d < 3; d++) {
            center[d] += a * (double)k->at[6 * (size_t)cell + (size_t)d];
            normal[d] += a * (double)k->at[6 * (size_t)cell + 3 + (size_t)d];
            albedo[d] += a * reflected[d];
        }
    }
    radiosity_patch *out = p->patch + item;
    out->first = c->first;
    out->area = (float)sum;
    out->center = (vec3){(float)(center[0] / sum), (float)(center[1] / sum), (float)(center[2] / sum)};
    out->normal = vec3_unit((vec3){(float)normal[0], (float)normal[1], (float)normal[2]});
    for (int d = 0; d < 3; d++)
        out->albedo[d] = float_min((float)(albedo[d] / sum), VIT_MAX_ALBEDO);
}

/* From one cluster of all cells to as many as are wanted. */
static void split_all(clustering *k) {
    k->count = 1;
    judge(k, 0);
    while (k->count < k->in->count - k->in->count / KEPT_FOR_HIDDEN && split(k))
        continue;
    k->last = true;
    for (uint32_t i = k->count; i-- > 0;) {
        judge(k, i);
        sink(k, i);
    }
    while (k->count < k->in->count && split(k))
        continue;
}

vit_status patches_make(const patches_input *in, patch_set *out, vit_text *why) {
    clustering k = {.in = in, .p = out};
    memset(out, 0, sizeof *out);
    out->geometry = in->geometry;
    double area = 0.0;
    for (uint32_t side = 0; side < 2 * in->rays->s->triangle_count; side++)
        area += is_in(in, side) ? (double)side_area(in->geometry, side) : 0.0;
    float edge = area > 0.0 ? (float)sqrt(area / in->count / (double)CELLS_PER_PATCH) : 1.0f;
    vit_status status = cells_divide(in->geometry, in->rays->s->triangle_count, cell_edge, &edge, &out->cells, why);
    if (status != VIT_OK)
        return status;
    out->patch_of = malloc((out->cells.count + 1u) * sizeof *out->patch_of);
    k.clusters = calloc(in->count, sizeof *k.clusters);
    k.forks = calloc(in->count, sizeof *k.forks);
    bool fine = out->patch_of && k.clusters && k.forks && patches_find_parts(in, edge, out) && patches_find_met(in, &k.met) &&
                find_cells(&k);
    if (fine && k.clusters[0].count > 0)
        split_all(&k);
    const uint32_t used = fine ? (k.count ? out->cells.count : 0) : 0;
    out->patch = calloc(k.count + 1u, sizeof *out->patch);
    out->cell_sum = malloc((used + 1u) * sizeof *out->cell_sum);
    out->points = malloc((k.count + 1u) * PATCHES_POINTS * sizeof *out->points);
    out->point_count = calloc(k.count + 1u, sizeof *out->point_count);
    out->met = calloc(k.count + 1u, sizeof *out->met);
    fine = fine && out->patch && out->cell_sum && out->points && out->point_count && out->met;
    if (fine) {
        out->cell = k.order;
        k.order = NULL;
        out->count = k.count;
        qsort(k.clusters, k.count, sizeof *k.clusters, by_first);
        for (uint32_t i = 0; i < k.count; i++) {
            qsort(out->cell + k.clusters[i].first, k.clusters[i].count, sizeof *out->cell, by_index);
            out->hidden += k.clusters[i].hidden / k.count;
            out->patch[k.count].first += k.clusters[i].count;
        }
        finishing f = {&k, edge};
        parallel_for(in->threads, k.count, finish, &f);
        for (uint32_t i = 0; i < k.count; i++)
            if (k.clusters[i].fork != VIT_NONE)
                k.forks[k.clusters[i].fork].next[k.clusters[i].right] = LEAF | i;
        for (uint32_t i = 0; i < out->cells.count; i++)
            if (out->patch_of[i] == VIT_NONE && is_in(in, out->cells.side_of[i]))
                out->patch_of[i] = place(&k, i);
        fine = patches_place_parts(in, &k.met, edge, out);
        patches_keep_points(&k.met, out);
    }
    if (!fine) {
        status = bake_fail(why, VIT_FAILED, "patches: out of memory");
    }
    free(k.order);
    free(k.at);
    free(k.area);
    free(k.worth);
    free(k.forks);
    patches_met_free(&k.met);
    free(k.clusters);
    if (status != VIT_OK)
        patches_free(out);
    return status;
}

void patches_free(patch_set *p) {
    cells_free(&p->cells);
    free(p->patch);
    free(p->cell);
    free(p->cell_sum);
    free(p->points);
    free(p->point_count);
    free(p->met);
    free(p->patch_of);
    separations_free(&p->apart);
    free(p->beside);
    memset(p, 0, sizeof *p);
}

uint32_t patches_place(const patch_set *p, uint32_t of, float u, float v, float w, float *b1, float *b2) {
    uint32_t low = p->patch[of].first, high = p->patch[of + 1].first - 1;
    const double at = (double)u * p->cell_sum[high];
    while (low < high) {
        const uint32_t middle = (low + high) / 2;
        if (p->cell_sum[middle] > at)
            high = middle;
        else
            low = middle + 1;
    }
    const cell_corners k = cells_corners(&p->cells, p->cell[low]);
    const float root = sqrtf(v), weight[3] = {1.0f - root, root * (1.0f - w), root * w};
    *b1 = weight[0] * k.b1[0] + weight[1] * k.b1[1] + weight[2] * k.b1[2];
    *b2 = weight[0] * k.b2[0] + weight[1] * k.b2[1] + weight[2] * k.b2[2];
    return p->cells.side_of[p->cell[low]];
}

uint32_t patches_at(const patch_set *p, uint32_t side, float b1, float b2) {
    const uint32_t cell = cells_at(&p->cells, side, b1, b2), apart = p->apart.of[cell];
    if (apart == VIT_NONE)
        return p->patch_of[cell];
    return p->beside[apart][separations_front(&p->apart, cell, side_place(p->geometry, side, b1, b2)) ? 0 : 1];
}
