#include "zones/zones.h"
#include "common/fail.h"
#include "light/photon_specular.h"
#include "zones/parts.h"
#include <float.h>
#include <stdlib.h>
#include <string.h>

#define MOST_LOOKS (1u << 21) /* rays that look what the path sees */
#define LEAST_FRAMES 16u
#define MOST_BOXES (1u << 24)

bool grid_make(grid *g, const vec3 *at, size_t stride, uint32_t count, float edge) {
    vec3 hi = {-1e30f, -1e30f, -1e30f};
    *g = (grid){.lo = {1e30f, 1e30f, 1e30f}};
#define AT(i) ((const vec3 *)(const void *)((const char *)at + (i)*stride))
    for (uint32_t i = 0; i < count; i++) {
        const vec3 *p = AT(i);
        g->lo = (vec3){float_min(g->lo.x, p->x), float_min(g->lo.y, p->y), float_min(g->lo.z, p->z)};
        hi = (vec3){float_max(hi.x, p->x), float_max(hi.y, p->y), float_max(hi.z, p->z)};
    }
    const vec3 size = count ? vec3_sub(hi, g->lo) : (vec3){0, 0, 0};
    while ((size.x / edge + 1.0f) * (size.y / edge + 1.0f) * (size.z / edge + 1.0f) > (float)MOST_BOXES)
        edge *= 2.0f;
    g->inv = 1.0f / edge;
    g->nx = (int)(size.x * g->inv) + 1;
    g->ny = (int)(size.y * g->inv) + 1;
    g->nz = (int)(size.z * g->inv) + 1;
    const size_t boxes = (size_t)g->nx * (size_t)g->ny * (size_t)g->nz;
    g->start = calloc(boxes + 2, sizeof *g->start);
    g->item = malloc((count + 1u) * sizeof *g->item);
    if (!g->start || !g->item)
        return false;
    for (int fill = 0; fill < 2; fill++) { /* counts, then items behind one another */
        for (uint32_t i = 0; i < count; i++) {
            const vec3 p = vec3_sub(*AT(i), g->lo);
            const size_t box = ((size_t)(int)(p.z * g->inv) * (size_t)g->ny + (size_t)(int)(p.y * g->inv)) * (size_t)g->nx +
                               (size_t)(int)(p.x * g->inv);
            if (fill)
                g->item[g->start[box + 1]++] = i;
            else
                g->start[box + 2]++;
        }
        for (size_t b = 2; b < boxes + 2 && !fill; b++)
            g->start[b] += g->start[b - 1];
    }
#undef AT
    return true;
}

void grid_free(grid *g) {
    free(g->start);
    free(g->item);
    memset(g, 0, sizeof *g);
}

static int box_number(float x, float inv, int n) {
    const float b = floorf(x * inv);
    return b < 0.0f ? 0 : b < (float)n ? (int)b : n - 1;
}

void grid_rows(const grid *g, vec3 p, float reach, void (*f)(void *user, uint32_t begin, uint32_t end), void *user) {
    const vec3 q = vec3_sub(p, g->lo);
    const int x1 = box_number(q.x + reach, g->inv, g->nx), y1 = box_number(q.y + reach, g->inv, g->ny),
              z1 = box_number(q.z + reach, g->inv, g->nz);
    for (int z = box_number(q.z - reach, g->inv, g->nz); z <= z1; z++)
        for (int y = box_number(q.y - reach, g->inv, g->ny); y <= y1; y++) {
            const size_t row = ((size_t)z * (size_t)g->ny + (size_t)y) * (size_t)g->nx;
            f(user, g->start[row + (size_t)box_number(q.x - reach, g->inv, g->nx)], g->start[row + (size_t)x1 + 1]);
        }
}

typedef struct each {
    const grid *g;
    void (*f)(void *user, uint32_t item);
    void *user;
} each;

static void each_item(void *user, uint32_t begin, uint32_t end) {
    const each *e = user;
    for (uint32_t i = begin; i < end; i++)
        e->f(e->user, e->g->item[i]);
}

void grid_near(const grid *g, vec3 p, float reach, void (*f)(void *user, uint32_t item), void *user) {
    each e = {g, f, user};
    grid_rows(g, p, reach, each_item, &e);
}

bool grid_align(grid *g, uint32_t width, uint32_t *slots) {
    const size_t boxes = (size_t)g->nx * (size_t)g->ny * (size_t)g->nz;
    size_t count = 0;
    for (size_t b = 0; b < boxes; b++)
        count += (g->start[b + 1] - g->start[b] + width - 1) / width * width;
    uint32_t *item = count < VIT_NONE ? malloc((count + 1) * sizeof *item) : NULL;
    if (!item)
        return false;
    uint32_t at = 0;
    for (size_t b = 0; b < boxes; b++) {
        const uint32_t begin = g->start[b], end = g->start[b + 1];
        g->start[b] = at;
        for (uint32_t i = begin; i < end; i++)
            item[at++] = g->item[i];
        while (at % width)
            item[at++] = VIT_NONE;
    }
    g->start[boxes] = at;
    free(g->item);
    g->item = item;
    *slots = at;
    return true;
}

float zones_kernel(const zones *z, vec3 p, vec3 n, vec3 q) {
    const vec3 o = vec3_sub(q, p);
    const float off = vec3_dot(o, n);
    return float_max(1.0f - fmaf(off * off, z->flatten, vec3_dot(o, o)) / (z->radius * z->radius), 0.0f);
}

static uint64_t cube(float x, float edge) {
    return (uint64_t)(int64_t)floorf(x / edge) & 0xfffff;
}

uint64_t zones_key(vec3 p, vec3 n, float edge) {
    const vec3 a = {fabsf(n.x), fabsf(n.y), fabsf(n.z)};
    const uint64_t axis = a.x >= a.y && a.x >= a.z ? 0 : a.y >= a.z ? 1 : 2;
    const float sign = axis == 0 ? n.x : axis == 1 ? n.y : n.z;
    p = vec3_along(p, n, edge * 0x1p-6f); /* surfaces on a cube's face lie in the cube in front */
    const float thin = edge * 0.25f;      /* along the normal: a curtain's front and the wall behind it are apart */
    return (cube(p.x, axis == 0 ? thin : edge) << 40 | cube(p.y, axis == 1 ? thin : edge) << 20 |
            cube(p.z, axis == 2 ? thin : edge))
               << 3 |
           axis << 1 | (sign < 0.0f ? 1u : 0u) | (uint64_t)1 << 63;
}

/* What the camera's rays meet, on a grid of pixels and frames. */
typedef struct look {
    zones *z;
    uint32_t step, columns, rows, frame_step;
    uint32_t *side;
    float (*weight)[2]; /* b1, b2 */
} look;

/* Mirrors and glass send rays on; at the first glass every second pixel looks through. */
static uint32_t look_on(const zones *z, vec3 o, vec3 d, uint32_t pixel, photon_surface *s, float b[3]) {
    const uint32_t most = z->in->scene->chain;
    for (uint32_t k = 0;; k++) {
        float t;
        const uint32_t triangle = photon_rays_nearest(&z->rays, o, d, &t);
        if (triangle == VIT_NONE)
            return VIT_NONE;
        *s = photon_surface_seen(&z->scene, o, d, t, triangle, 0.0f, b);
        if (s->material->kind == VIT_MATTE)
            return triangle;
        if (k == most)
            return VIT_NONE;
        o = s->position;
        if (s->material->kind == VIT_MIRROR) {
            d = specular_mirrored(d, s->normal, s->face);
            continue;
        }
        const specular_paths p =
            specular_at_glass(d, s->normal, s->face, s->back, s->material->kind == VIT_THIN_GLASS, s->material->ior);
        const bool through = p.mirror < 1.0f && (k == 0 ? pixel % 2 == 0 : p.mirror <= 0.5f);
        d = through ? p.refracted : p.mirrored;
        o = through ? s->beyond : o;
    }
}

static void look_once(void *user, uint32_t i) {
    look *l = user;
    const zones *z = l->z;
    const uint32_t x = i % l->columns, y = i / l->columns % l->rows, frame = i / (l->columns * l->rows) * l->frame_step;
    const vit_camera *c = z->in->tracks->cameras + frame;
    const vec3 o = vec3_load(c->eye);
    vec3 d = vec3_along(vec3_load(c->corner), vec3_load(c->right), (float)(x * l->step) + 0.5f);
    d = vec3_unit(vec3_along(d, vec3_load(c->down), (float)(y * l->step) + 0.5f));
    float b[3];
    photon_surface s;
    const uint32_t triangle = look_on(z, o, d, x + y, &s, b);
    l->side[i] = VIT_NONE;
    if (triangle == VIT_NONE)
        return;
    l->side[i] = 2 * triangle + s.back;
    l->weight[i][0] = b[1];
    l->weight[i][1] = b[2];
}

bool zones_lands(const zones *z, uint32_t triangle) {
    return z->in->materials[z->g->attributes[triangle].material & VIT_MATERIAL_INDEX].kind == VIT_MATTE;
}

static uint32_t slot_of(uint64_t key, uint32_t room) {
    return (pcg((uint32_t)key) ^ pcg((uint32_t)(key >> 32) * 0x9e3779b9u)) & (room - 1);
}

static bool was_seen(const zones *z, uint64_t key) {
    uint32_t slot = slot_of(key, z->seen_room);
    while (z->seen[slot] && z->seen[slot] != key)
        slot = (slot + 1) & (z->seen_room - 1);
    return z->seen[slot] != 0;
}

/* Numbers keys in the order in which they come. */
typedef struct numbering {
    uint64_t *key;
    uint32_t *number, room, count;
} numbering;

static uint32_t number_of(numbering *n, uint64_t key) {
    uint32_t slot = slot_of(key, n->room);
    while (n->key[slot] && n->key[slot] != key)
        slot = (slot + 1) & (n->room - 1);
    if (!n->key[slot]) {
        n->key[slot] = key;
        n->number[slot] = n->count++;
    }
    return n->number[slot];
}

static float cell_edge(void *user, uint32_t side) {
    const zones *z = user;
    return z->radius * (z->seen_side[side] ? ZONES_FINE : ZONES_COARSE);
}

/* Divides the surface, finely where the path sees it, and notes the cubes of the cells that it sees. */
static vit_status find_seen(zones *z, vit_text *why) {
    const vit_scene *s = z->in->scene;
    const uint32_t least = s->frames < LEAST_FRAMES ? s->frames : LEAST_FRAMES;
    look l = {.z = z, .step = 1};
    while (((uint64_t)s->width / l.step + 1) * (s->height / l.step + 1) * least > MOST_LOOKS)
        l.step++;
    l.columns = (s->width + l.step - 1) / l.step;
    l.rows = (s->height + l.step - 1) / l.step;
    const uint64_t in_frame = (uint64_t)l.columns * l.rows;
    l.frame_step = (uint32_t)((s->frames * in_frame + MOST_LOOKS - 1) / MOST_LOOKS);
    const uint32_t looks = (uint32_t)(in_frame * ((s->frames + l.frame_step - 1) / l.frame_step));
    l.side = malloc(looks * sizeof *l.side);
    l.weight = malloc(looks * sizeof *l.weight);
    z->seen_side = calloc(2 * (size_t)z->in->triangles, 1);
    for (z->seen_room = 1024; z->seen_room < 2 * looks; z->seen_room *= 2)
        ;
    z->seen = calloc(z->seen_room, sizeof *z->seen);
    vit_status status = VIT_FAILED;
    if (l.side && l.weight && z->seen_side && z->seen) {
        parallel_for(z->in->threads, looks, look_once, &l);
        for (uint32_t i = 0; i < looks; i++)
            if (l.side[i] != VIT_NONE)
                z->seen_side[l.side[i]] = 1;
        status = cells_divide(z->g, z->in->triangles, cell_edge, z, z->c, why);
        z->seen_at = status == VIT_OK ? malloc((z->c->count + 1u) * sizeof *z->seen_at) : NULL;
        z->seen_off = status == VIT_OK ? malloc((z->c->count + 1u) * sizeof *z->seen_off) : NULL;
        status = z->seen_at && z->seen_off ? status : VIT_FAILED;
        for (uint32_t i = 0; status == VIT_OK && i < z->c->count; i++)
            z->seen_off[i] = FLT_MAX;
    }
    for (uint32_t i = 0; status == VIT_OK && i < looks; i++) {
        if (l.side[i] == VIT_NONE)
            continue;
        const uint32_t cell = cells_at(z->c, l.side[i], l.weight[i][0], l.weight[i][1]);
        const vec3 center = cells_center(z->c, z->g, cell);
        const uint64_t key = zones_key(center, side_face(z->g, l.side[i]), ZONES_COARSE * z->radius);
        const vec3 off = vec3_sub(side_place(z->g, l.side[i], l.weight[i][0], l.weight[i][1]), center);
        if (vec3_dot(off, off) < z->seen_off[cell]) {
            z->seen_off[cell] = vec3_dot(off, off);
            memcpy(z->seen_at[cell], l.weight[i], sizeof l.weight[i]);
        }
        uint32_t slot = slot_of(key, z->seen_room);
        while (z->seen[slot] && z->seen[slot] != key)
            slot = (slot + 1) & (z->seen_room - 1);
        z->seen[slot] = key;
    }
    free(l.side);
    free(l.weight);
    return status;
}

/* Groups cells into patches and, where they are seen, receivers. */
static bool group_cells(zones *z) {
    const uint32_t count = z->c->count;
    numbering patches = {.room = 1024}, receivers = {.room = 1024};
    while (patches.room < 2 * count)
        patches.room *= 2;
    receivers.room = patches.room;
    patches.key = calloc(patches.room, sizeof *patches.key);
    patches.number = calloc(patches.room, sizeof *patches.number);
    receivers.key = calloc(receivers.room, sizeof *receivers.key);
    receivers.number = calloc(receivers.room, sizeof *receivers.number);
    z->patch_of = malloc(count * sizeof *z->patch_of);
    z->receiver_of = malloc(count * sizeof *z->receiver_of);
    const bool fine = patches.key && patches.number && receivers.key && receivers.number && z->patch_of && z->receiver_of;
    for (uint32_t i = 0; fine && i < count; i++) {
        const uint32_t side = z->c->side_of[i];
        const vec3 p = cells_center(z->c, z->g, i), n = side_face(z->g, side);
        const uint64_t key = zones_key(p, n, ZONES_COARSE * z->radius);
        z->patch_of[i] = z->receiver_of[i] = VIT_NONE;
        if (side_is_dark(z->g, side) || !zones_lands(z, side / 2))
            continue;
        z->patch_of[i] = number_of(&patches, key);
        if (was_seen(z, key))
            z->receiver_of[i] = number_of(&receivers, zones_key(p, n, ZONES_FINE * z->radius));
    }
    z->patch_count = patches.count;
    z->receiver_count = receivers.count;
    free(patches.key);
    free(patches.number);
    free(receivers.key);
    free(receivers.number);
    return fine;
}

static void release(zones *z) {
    photon_rays_close(&z->rays);
    free(z->seen);
    free(z->seen_side);
    free(z->seen_at);
    free(z->seen_off);
    free(z->patch_of);
    free(z->receiver_of);
    free(z->patches);
    free(z->points);
    free(z->receivers);
    free(z->pairs);
}

static void report(const zones *z, double done) {
    if (z->in->progress)
        z->in->progress(z->in->user, done);
}

static vit_status fill(zones *z, vit_text *why) {
    const vit_status failed = bake_fail(why, VIT_FAILED, "zones: out of memory"); /* where no step says more */
    const vit_status status = find_seen(z, why);
    report(z, 0.05);
    if (status != VIT_OK)
        return status;
    bool fine = group_cells(z) && zones_patches(z, why);
    report(z, 0.35);
    fine = fine && zones_pairs(z);
    report(z, 0.75);
    fine = fine && zones_colour(z);
    report(z, 0.85);
    fine = fine && zones_areas(z);
    report(z, 1.0);
    return fine ? VIT_OK : failed;
}

vit_status zones_bake(const zones_input *in, cells *out, zones_found *found, vit_text *why) {
    const vit_scene *s = in->scene;
    zones z = {.in = in,
               .g = in->geometry,
               .scene = {.triangles = in->geometry->triangles,
                         .attributes = in->geometry->attributes,
                         .triangle_count = in->triangles,
                         .materials = in->materials,
                         .atlas = in->atlas,
                         .ray_offset = s->ray_offset,
                         .box_pad = s->box_pad,
                         .effects = s->effects},
               .radius = s->radius,
               .flatten = s->flatten,
               .c = out,
               .found = found};
    memset(out, 0, sizeof *out);
    *found = (zones_found){0};
    vit_status status;
    if (photon_rays_open(&z.scene, in->threads, &z.rays))
        status = fill(&z, why);
    else
        status = bake_fail(why, VIT_FAILED, "zones: Embree fails");
    found->receivers = z.receiver_count;
    found->patches = z.patch_count;
    release(&z);
    if (status != VIT_OK)
        cells_free(out);
    return status;
}

void zones_assign(const cells *c, vit_photon *photons, uint32_t count) {
    for (uint32_t i = 0; i < count; i++)
        photons[i].zone = 1u << (c->cells[photons[i].zone].word >> 27);
}
