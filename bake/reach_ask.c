/* Step 4 of reach.c. A side that nothing was found out about is asked by rays of its own; up to ASK_LIGHTS towards lights and
 * ASK_RAYS into the room say that it is dark. Sides that hang together mostly share their fate, so they share these rays:
 *   - sides beside one that is lit are asked with all rays each, and so on from those that turn out lit;
 *   - the others together get as many rays as one side would; as long as that finds a lit one, it goes on from there and they
 *     are asked again.
 * A side is never called lit for its neighbours' sake, and what costs all rays is the rim of what is lit, not the inside of
 * every body. Large sides are many times as much of the picture as small ones, and are asked as many times more. A patch of
 * triangles is one thread's work and needs nothing of the others. */
#include "reach_parts.h"
#include <math.h>

#define ASK_LIGHTS 16u
#define ASK_RAYS 96u
#define FIRST_LIGHTS 4u /* of each side by itself: light that comes straight is the sharpest, and cheap to ask for */
#define LARGE 8192.0    /* a side of more than 1 / LARGE of the whole surface asks by itself, */
#define LARGER 2048.0   /* of more than 1 / LARGER as many times the rays */

typedef struct asking {
    const reach_search *s;
    reach_patch patch;
    bool lit[PATCH_SIDES], open[PATCH_SIDES];        /* open: not known, and rays are left */
    bool alone[PATCH_SIDES];                         /* too large to share */
    uint32_t lights[PATCH_SIDES], rays[PATCH_SIDES]; /* asked so far */
    float larger[PATCH_SIDES];                       /* >= 1: times the rays of a small side */
    float reflected[PATCH_SIDES];
    uint16_t fresh[PATCH_SIDES]; /* lit sides whose neighbours are to be asked */
    uint32_t fresh_count;
    uint32_t shot;
} asking;

static void found_lit(asking *a, uint16_t side) {
    a->lit[side] = true;
    a->open[side] = false;
    a->fresh[a->fresh_count++] = side;
}

static uint32_t most_lights(const asking *a, uint16_t side) {
    return (uint32_t)(a->larger[side] * (float)ASK_LIGHTS);
}

static uint32_t most_rays(const asking *a, uint16_t side) {
    return (uint32_t)(a->larger[side] * (float)ASK_RAYS);
}

/* Asks so many more, as far as there are, or until the side is lit or one ray alone saw what could light it. True: the latter.
 */
static bool ask(asking *a, uint16_t side, uint32_t lights, uint32_t rays) {
    const reach_search *s = a->s;
    const uint32_t whole = 2 * a->patch.first + side, all_lights = most_lights(a, side), all_rays = most_rays(a, side);
    const uint32_t gathered = s->found_first[whole + 1] - s->found_first[whole];
    const ray_side from = side_of(s->g, whole);
    bool seen = false;
    for (; a->open[side] && lights > 0 && a->lights[side] < all_lights; lights--, a->shot++)
        if (lights_ask(s, whole, &from, a->lights[side]++))
            found_lit(a, side);
    for (; a->open[side] && !seen && rays > 0 && a->rays[side] < all_rays; rays--, a->shot++) {
        float distance;
        const uint32_t found = reach_look(s, whole, &from, gathered + a->rays[side]++, &distance);
        const float gives = REACH_ALBEDO * (found < s->sides ? s->irradiance[found] : 0.0f);
        seen = gives >= s->threshold;
        a->reflected[side] += gives / (float)all_rays;
        if (a->reflected[side] >= s->threshold)
            found_lit(a, side);
    }
    if (a->lights[side] == all_lights && a->rays[side] == all_rays)
        a->open[side] = false;
    return seen;
}

static void ask_all(asking *a, uint16_t side) {
    while (a->open[side])
        ask(a, side, ASK_LIGHTS, ASK_RAYS);
}

/* From lit sides to their neighbours, as far as they are lit. */
static void spread(asking *a) {
    while (a->fresh_count > 0) {
        const uint16_t *beside = a->patch.beside[a->fresh[--a->fresh_count]];
        for (int k = 0; k < 3; k++)
            if (beside[k] != PATCH_NONE && a->open[beside[k]])
                ask_all(a, beside[k]);
    }
}

/* The open sides of the group whose least one is `group`. */
static uint32_t count_open(const asking *a, uint16_t group) {
    uint32_t count = 0;
    for (uint32_t i = group; i < 2 * a->patch.count; i++)
        count += a->patch.group[i] == group && a->open[i];
    return count;
}

/* Of all that a side may ask, its part among `count` sides of a group; large ones ask all. */
static uint32_t part(const asking *a, uint16_t side, uint32_t all, uint32_t count) {
    return a->alone[side] ? all : (all + count - 1) / count;
}

/* One round for the open sides of a group. True: some are lit. */
static bool ask_together(asking *a, uint16_t group) {
    const uint32_t count = count_open(a, group);
    bool some = false;
    for (uint32_t i = group; i < 2 * a->patch.count; i++) {
        const uint16_t side = (uint16_t)i;
        if (a->patch.group[i] != group || !a->open[i])
            continue;
        if (ask(a, side, part(a, side, most_lights(a, side), count), part(a, side, most_rays(a, side), count)))
            ask_all(a, side);
        some |= a->lit[i];
        spread(a);
    }
    return some;
}

/* What steps 1 to 3 say. A side that any light shines on is lit, however weakly; the threshold is for reflected light alone. */
static void take_known(asking *a) {
    const reach_search *s = a->s;
    for (uint32_t i = 0; i < 2 * a->patch.count; i++) {
        const uint32_t side = 2 * a->patch.first + i;
        if (side_material(s->m, s->g, side)->kind != VIT_MATTE)
            continue; /* neither lit nor dark */
        a->open[i] = true;
        a->alone[i] = LARGE * reach_part(s, side) > 1.0;
        a->larger[i] = (float)fmax(1.0, LARGER * reach_part(s, side));
        if (s->direct[side] > 0.0f || s->irradiance[side] >= s->threshold)
            found_lit(a, (uint16_t)i);
    }
}

void reach_ask_patch(void *search, uint32_t patch) {
    reach_search *s = search;
    const uint32_t first = patch * PATCH_TRIANGLES, left = s->m->triangles - first;
    asking a = {.s = s};
    patch_link(s->g, first, left < PATCH_TRIANGLES ? left : PATCH_TRIANGLES, &a.patch);
    take_known(&a);
    const uint32_t sides = 2 * a.patch.count;
    for (uint32_t i = 0; i < sides; i++)
        if (a.open[i])
            ask(&a, (uint16_t)i, FIRST_LIGHTS, 0);
    spread(&a);
    for (uint32_t i = 0; i < sides; i++)
        while (a.patch.group[i] == i && ask_together(&a, (uint16_t)i))
            ;
    for (uint32_t i = 0; i < sides; i++)
        s->lit[2 * first + i] = a.lit[i];
    atomic_fetch_add_explicit(&s->shot, a.shot, memory_order_relaxed);
}
