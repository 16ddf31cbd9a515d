/* Effective areas: A(x), the integral of the photon kernel about x over the open surfaces whose photons x accepts, in units of
 * its integral over a plane. The sum of photons is divided by it. */
#include "zones/parts.h"
#include <stdlib.h>

#define WIDTH 4
typedef float wide __attribute__((vector_size(4 * WIDTH)));
typedef int32_t wide_i __attribute__((vector_size(4 * WIDTH)));
#define SMALL 0.25f /* cells of so much of a fine cell's area have one effective area, not three */

/* Points in the order of a grid's boxes, WIDTH side by side; rows of boxes begin at multiples of it, the gaps hold points of no
 * area. */
typedef struct area_block {
    wide x, y, z, nx, ny, nz, area;
    wide_i zone; /* bit */
} area_block;

typedef struct areas {
    zones *z;
    grid points;
    area_block *blocks;
} areas;

typedef struct corner {
    const areas *a;
    vec3 p, n;
    uint32_t accept, alike;
    wide accepted, lit_alike, front; /* sums: zones accepted, lit alike; all surfaces in front, without zones by the share of
                                      * their photons that count */
} corner;

static void add_block(corner *c, const area_block *b) {
    const zones *z = c->a->z;
    const wide zero = {0};
    const wide x = b->x - c->p.x, y = b->y - c->p.y, w = b->z - c->p.z;
    const wide off = x * c->n.x + y * c->n.y + w * c->n.z;
    wide k = 1.0f - (x * x + y * y + w * w + off * off * z->flatten) * (1.0f / (z->radius * z->radius));
    k = (wide)((wide_i)(k * b->area) & (wide_i)(k > zero));
    c->accepted += (wide)((wide_i)k & (wide_i)((b->zone & (int32_t)c->accept) != 0));
    c->lit_alike += (wide)((wide_i)k & (wide_i)((b->zone & (int32_t)c->alike) != 0));
    const wide cosine = b->nx * c->n.x + b->ny * c->n.y + b->nz * c->n.z;
    if (z->in->zones)
        c->front += (wide)((wide_i)k & (wide_i)(cosine > zero));
    else /* photons count that arrive from the front: of even light, (1 + cos) / 2 of those on a surface turned by that angle */
        c->front += k * (0.5f + 0.5f * cosine);
}

static void add_blocks(void *user, uint32_t begin, uint32_t end) {
    corner *c = user;
    for (uint32_t i = begin / WIDTH; i < (end + WIDTH - 1) / WIDTH; i++)
        add_block(c, c->a->blocks + i);
}

static float total(wide v) {
    return (v[0] + v[1]) + (v[2] + v[3]);
}

static uint32_t coded(float area) {
    const float q = floorf(sqrtf(float_max(area, 0.0f) / VIT_CELL_AREA_SCALE) + 0.5f);
    return q < (float)VIT_CELL_AREA_LEAST ? VIT_CELL_AREA_LEAST : q > 511.0f ? 511u : (uint32_t)q;
}

static bool enough(const float area[3]) {
    return area[0] + area[1] + area[2] >= 3.0f * ZONES_LEAST_AREA;
}

/* Effective areas at the cell's corners. Returns the zones that it accepts. */
static uint32_t integrate(const areas *a, uint32_t cell, float area[3]) {
    const zones *z = a->z;
    const receiver *r = z->receivers + z->receiver_of[cell];
    const uint32_t side = z->c->side_of[cell];
    const cell_corners k = cells_corners(z->c, cell);
    const float disc = 0.5f * KERNEL_PI * z->radius * z->radius; /* the kernel's integral over a plane */
    const float fine = ZONES_FINE * z->radius;
    const bool small = cells_area(z->c, z->g, cell) < SMALL * fine * fine;
    float front[3], accepted[3], lit_alike[3];
    for (int m = 0; m < 3; m++) {
        if (small && m > 0) {
            front[m] = front[0];
            accepted[m] = accepted[0];
            lit_alike[m] = lit_alike[0];
            continue;
        }
        const float b1 = small ? (k.b1[0] + k.b1[1] + k.b1[2]) / 3.0f : k.b1[m];
        const float b2 = small ? (k.b2[0] + k.b2[1] + k.b2[2]) / 3.0f : k.b2[m];
        corner c = {.a = a,
                    .p = side_place(z->g, side, b1, b2),
                    .n = side_shading(z->g, side, b1, b2),
                    .accept = r->accept,
                    .alike = r->alike};
        grid_rows(&a->points, c.p, z->radius, add_blocks, &c);
        accepted[m] = total(c.accepted) / disc;
        lit_alike[m] = total(c.lit_alike) / disc;
        front[m] = total(c.front) / disc;
    }
    /* Where hardly anything is seen, light from surfaces lit alike is better than none; from all of them it would be worse. */
    const bool stand_in = z->in->zones && !enough(accepted) && enough(lit_alike);
    for (int m = 0; m < 3; m++)
        area[m] = float_max(!z->in->zones ? front[m] : stand_in ? lit_alike[m] : accepted[m], 0.5f * ZONES_LEAST_AREA);
    return !z->in->zones ? ~0u : stand_in ? r->alike : r->accept;
}

static void fill_cell(void *user, uint32_t i) {
    const areas *a = user;
    const zones *z = a->z;
    const uint32_t mine = z->patch_of[i];
    uint32_t word = mine == VIT_NONE ? 0u : z->patches[mine].zone << 27;
    float area[3] = {1.0f, 1.0f, 1.0f};
    z->c->cells[i].accept = z->receiver_of[i] == VIT_NONE ? ~0u : integrate(a, i, area);
    for (int m = 0; m < 3; m++)
        word |= coded(z->in->areas ? area[m] : 1.0f) << 9 * m;
    z->c->cells[i].word = word;
}

static bool make_blocks(areas *a) {
    const zones *z = a->z;
    uint32_t slots; /* none where no light reaches what the path sees */
    if (!grid_align(&a->points, WIDTH, &slots))
        return false;
    a->blocks = aligned_alloc(sizeof(wide), (size_t)(slots / WIDTH + 1) * sizeof *a->blocks);
    if (!a->blocks)
        return false;
    for (uint32_t i = 0; i < slots; i++) {
        area_block *b = a->blocks + i / WIDTH;
        const uint32_t k = i % WIDTH, item = a->points.item[i];
        static const area_point none = {.p = {0, 0, 0}};
        const area_point *p = item == VIT_NONE ? &none : z->points + item;
        b->x[k] = p->p.x;
        b->y[k] = p->p.y;
        b->z[k] = p->p.z;
        b->nx[k] = p->n.x;
        b->ny[k] = p->n.y;
        b->nz[k] = p->n.z;
        b->area[k] = p->area;
        b->zone[k] = item == VIT_NONE ? 0 : (int32_t)(1u << z->patches[p->patch].zone);
    }
    return true;
}

bool zones_areas(zones *z) {
    areas a = {.z = z};
    const bool fine =
        grid_make(&a.points, &z->points[0].p, sizeof *z->points, z->point_count, z->radius * 0.5f) && make_blocks(&a);
    if (fine)
        parallel_for(z->in->threads, z->c->count, fill_cell, &a);
    grid_free(&a.points);
    free(a.blocks);
    return fine;
}
