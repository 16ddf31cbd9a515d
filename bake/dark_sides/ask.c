/* Steps 4 and 6 of dark_sides.c. Sides that hang together mostly share their fate: a group none of whose sides any ray connects
 * to light is the inside of a body, most often, and its sides share what one side may ask, up to ASK_LIGHTS rays towards lights
 * and ASK_RAYS into the room. Once any of them has found light, however little, every one is looked at by itself (step 4) and
 * asked with all rays each (step 6). A side is never called lit for the others' sake, and costs more than a handful of rays
 * where light is near alone. Large sides are many times as much of the picture as small ones, and are asked as many times more.
 * A patch of triangles is one thread's work and needs nothing of the others. */
#include "dark_sides/parts.h"
#include <math.h>

#define ASK_LIGHTS 16u
#define ASK_RAYS 96u
#define FIRST_LIGHTS 2u /* of each side by itself: light that comes straight is the sharpest, and cheap to ask for */
#define LARGE 8192.0    /* a side of more than 1 / LARGE of the whole surface asks by itself, */
#define LARGER 4096.0   /* of more than 1 / LARGER as many times the rays */
#define IN_DOUBT 4u     /* as many times the rays while the mean may as well be on the other side of the threshold, */
#define DOUBT 2.0f      /* standard errors away at most */

typedef struct asking {
    const dark_sides_search *s;
    dark_sides_patch patch;
    bool light[PATCH_SIDES];                         /* a group, by its least side: some ray found light */
    bool lit[PATCH_SIDES], open[PATCH_SIDES];        /* open: not known, and rays are left */
    bool alone[PATCH_SIDES];                         /* too large to share */
    uint32_t lights[PATCH_SIDES], rays[PATCH_SIDES]; /* asked so far */
    float larger[PATCH_SIDES];                       /* >= 1: times the rays of a small side */
    float sum[PATCH_SIDES], squares[PATCH_SIDES];    /* of irradiance by reflection over all its rays, those of step 2 too */
    uint32_t shot;
} asking;

static uint32_t most_lights(const asking *a, uint16_t side) {
    return (uint32_t)(a->larger[side] * (float)ASK_LIGHTS);
}

static uint32_t most_rays(const asking *a, uint16_t side) {
    return (uint32_t)(a->larger[side] * (float)ASK_RAYS);
}

static uint32_t gathered(const asking *a, uint16_t side) {
    const uint32_t whole = 2 * a->patch.first + side;
    return a->s->found_first[whole + 1] - a->s->found_first[whole];
}

static void found_lit(asking *a, uint16_t side) {
    a->lit[side] = a->light[a->patch.group[side]] = true;
    a->open[side] = false;
}

/* Adds what a ray found. */
static void add_light(asking *a, uint16_t side, uint32_t found) {
    const float gives = found < a->s->sides ? DARK_SIDES_ALBEDO * a->s->irradiance[found] : 0.0f;
    if (!(gives > 0.0f))
        return;
    a->light[a->patch.group[side]] = true;
    a->sum[side] += gives;
    a->squares[side] += gives * gives;
}

/* Decides if the mean over `all` rays in the end is sure to reach the threshold, or if, once there are so many, it is on one
 * side of it beyond doubt. */
static void judge(asking *a, uint16_t side, uint32_t rays) {
    const uint32_t first = gathered(a, side), all = first + most_rays(a, side), last = first + IN_DOUBT * most_rays(a, side);
    const float threshold = a->s->least[2 * a->patch.first + side], doubt = DOUBT * sqrtf(a->squares[side]), sum = a->sum[side];
    if (sum >= threshold * (float)last || (sum >= threshold * (float)all && sum - threshold * (float)all >= doubt))
        found_lit(a, side);
    else if (rays >= all && (rays >= last || fabsf(sum - threshold * (float)rays) >= doubt)) {
        if (sum >= threshold * (float)rays)
            found_lit(a, side);
        a->open[side] = false;
    }
}

/* Asks so many more, or until it is decided; more than most_rays() where it is in doubt. */
static void ask(asking *a, uint16_t side, uint32_t lights, uint32_t rays) {
    const dark_sides_search *s = a->s;
    const uint32_t whole = 2 * a->patch.first + side, all_lights = most_lights(a, side), first = gathered(a, side);
    const ray_side from = side_of(s->g, whole);
    for (; a->open[side] && lights > 0 && a->lights[side] < all_lights; lights--, a->shot++)
        if (lights_ask(s, whole, &from, a->lights[side]++) > 0.0f)
            found_lit(a, side);
    for (; a->open[side] && rays > 0; rays--, a->shot++) {
        float distance;
        add_light(a, side, dark_sides_look(s, whole, &from, first + a->rays[side]++, &distance));
        judge(a, side, first + a->rays[side]);
    }
}

/* The open sides of the group whose least one is `group`. */
static uint32_t count_open(const asking *a, uint16_t group) {
    uint32_t count = 0;
    for (uint32_t i = group; i < 2 * a->patch.count; i++)
        count += a->patch.group[i] == group && a->open[i];
    return count;
}

/* Of all that a side may ask, its part among `count` sides of a group; all, where light is near and for large ones. */
static uint32_t part(const asking *a, uint16_t side, uint32_t all, uint32_t count) {
    return a->light[a->patch.group[side]] || a->alone[side] ? IN_DOUBT * all : (all + count - 1) / count;
}

static void ask_group(asking *a, uint16_t group) {
    const uint32_t count = count_open(a, group);
    for (int turn = 0; turn < 2; turn++) /* those that were asked before light was found are asked again */
        for (uint32_t i = group; i < 2 * a->patch.count && (turn == 0 || a->light[group]); i++) {
            const uint16_t side = (uint16_t)i;
            if (a->patch.group[i] == group && a->open[i])
                ask(a, side, part(a, side, most_lights(a, side), count), part(a, side, most_rays(a, side), count));
        }
}

/* What is known. A side that any light shines on is lit, however weakly; the threshold is for reflected light alone. */
static void take_known(asking *a, dark_sides_search *s, uint32_t patch) {
    const uint32_t first = patch * PATCH_TRIANGLES, left = s->m->triangles - first;
    a->s = s;
    patch_link(s->g, first, left < PATCH_TRIANGLES ? left : PATCH_TRIANGLES, &a->patch);
    for (uint32_t i = 0; i < 2 * a->patch.count; i++) {
        const uint32_t whole = 2 * first + i;
        if (side_material(s->m, s->g, whole)->kind != VIT_MATTE)
            continue; /* neither lit nor dark */
        const uint16_t side = (uint16_t)i;
        a->open[i] = true;
        a->alone[i] = LARGE * dark_sides_part(s, whole) > 1.0;
        a->larger[i] = (float)fmax(1.0, LARGER * dark_sides_part(s, whole));
        if (s->direct[whole] > 0.0f)
            found_lit(a, side);
        else {
            for (uint32_t k = s->found_first[whole]; k < s->found_first[whole + 1]; k++)
                add_light(a, side, s->found[k]);
            judge(a, side, gathered(a, side));
        }
    }
}

/* By the mean of the group, not by its own irradiance: to shoot more rays only where the first ones had no luck, and keep the
 * others' luck, would make dim places too bright. */
void dark_sides_find_faint(void *search, uint32_t patch) {
    dark_sides_search *s = search;
    asking a = {0};
    float sum[PATCH_SIDES] = {0.0f};
    uint32_t count[PATCH_SIDES] = {0};
    take_known(&a, s, patch);
    for (uint32_t i = 0; i < 2 * a.patch.count; i++)
        if (!(s->direct[2 * a.patch.first + i] > 0.0f)) {
            sum[a.patch.group[i]] += s->irradiance[2 * a.patch.first + i];
            count[a.patch.group[i]]++;
        }
    for (uint32_t i = 0; i < 2 * a.patch.count; i++) {
        const uint32_t whole = 2 * a.patch.first + i, group = a.patch.group[i];
        const bool faint = side_material(s->m, s->g, whole)->kind == VIT_MATTE && a.light[group] &&
                           !(s->direct[whole] > 0.0f) && sum[group] < DARK_SIDES_FAINT * s->threshold * (float)count[group];
        s->more[whole] = faint ? DARK_SIDES_LOOKED : 0;
    }
}

void dark_sides_ask_patch(void *search, uint32_t patch) {
    dark_sides_search *s = search;
    asking a = {0};
    take_known(&a, s, patch);
    const uint32_t sides = 2 * a.patch.count;
    for (uint32_t i = 0; i < sides; i++)
        if (a.open[i])
            ask(&a, (uint16_t)i, FIRST_LIGHTS, 0);
    for (uint32_t i = 0; i < sides; i++)
        if (a.patch.group[i] == i)
            ask_group(&a, (uint16_t)i);
    for (uint32_t i = 0; i < sides; i++)
        s->lit[2 * a.patch.first + i] = a.lit[i];
    atomic_fetch_add_explicit(&s->shot, a.shot, memory_order_relaxed);
}
