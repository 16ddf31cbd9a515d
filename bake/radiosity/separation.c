#include "radiosity/separation.h"
#include "common/parallel.h"
#include <stdlib.h>

#define NEAR_CORNER 0.98f /* of the way from the middle to a corner */
#define EVEN 16u          /* places even over the cell; the last three are its corners */
#define CANDIDATES 12u    /* planes that are tried, at most */
#define LOOKS 4           /* ways in which a place looks for what is round it */
#define PARALLEL 0.99f    /* cosine of two faces of a wall, at least */
#define APART 4.0f        /* ray offsets: faces so close are one */
#define INSIDE 3u         /* of these that end on backs: the place may be inside of a body */

bool separation_sees(const photon_rays *rays, vec3 a, vec3 b) {
    const vec3 way = vec3_sub(b, a);
    const float distance = sqrtf(vec3_dot(way, way));
    return !(distance > 0.0f) || !photon_rays_occluded(rays, a, vec3_scale(way, 1.0f / distance), distance);
}

/* Rows of 1, 3, 5 and 7 small triangles: their middles. */
void separation_place(const cell_corners *k, uint32_t i, float *b1, float *b2) {
    if (i >= EVEN) {
        const float m1 = (k->b1[0] + k->b1[1] + k->b1[2]) / 3.0f, m2 = (k->b2[0] + k->b2[1] + k->b2[2]) / 3.0f;
        *b1 = m1 + (k->b1[i - EVEN] - m1) * NEAR_CORNER;
        *b2 = m2 + (k->b2[i - EVEN] - m2) * NEAR_CORNER;
        return;
    }
    uint32_t row = 0;
    while ((row + 1) * (row + 1) <= i)
        row++;
    const uint32_t in_row = i - row * row, column = in_row / 2, down = in_row & 1;
    const float third = 1.0f / 3.0f;
    const float y = ((float)row + (down ? third : 2.0f * third)) * 0.25f, /* from corner 0 */
        x = ((float)column + (down ? 2.0f * third : third)) * 0.25f;      /* from the edge 0-1 */
    const float w[3] = {1.0f - y, y - x, x};
    *b1 = w[0] * k->b1[0] + w[1] * k->b1[1] + w[2] * k->b1[2];
    *b2 = w[0] * k->b2[0] + w[1] * k->b2[1] + w[2] * k->b2[2];
}

typedef struct search {
    const photon_rays *rays;
    const geometry *g;
    vec3 at[SEPARATION_PLACES];
    uint32_t hidden[SEPARATION_PLACES]; /* bits: places that this one does not see */
    uint32_t planes;
    uint32_t triangle[CANDIDATES]; /* that stand in between */
} search;

/* Notes what stands between two places. */
static void note(search *s, vec3 a, vec3 b) {
    const vec3 way = vec3_sub(b, a);
    const float distance = sqrtf(vec3_dot(way, way));
    float t;
    const uint32_t triangle = photon_rays_nearest(s->rays, a, vec3_scale(way, 1.0f / distance), &t);
    bool known = triangle == VIT_NONE || t > distance || s->planes == CANDIDATES;
    for (uint32_t i = 0; i < s->planes; i++)
        known = known || s->triangle[i] == triangle;
    if (!known)
        s->triangle[s->planes++] = triangle;
}

/* Cheap: corners. A plane that crosses a triangle parts one of them from the others, so that most cells pass, and are done. */
static bool looks_open(search *s, const separation_cell *c) {
    const vec3 face = side_face(s->g, c->side);
    vec3 p[3];
    for (uint32_t i = 0; i < 3; i++) {
        float b1, b2;
        separation_place(&c->corners, EVEN + i, &b1, &b2);
        p[i] = vec3_along(side_place(s->g, c->side, b1, b2), face, c->lift);
    }
    bool open = true;
    for (int a = 0; a < 3; a++) {
        const vec3 from = p[a], to = p[(a + 1) % 3];
        if (separation_sees(s->rays, from, to))
            continue;
        note(s, from, to);
        note(s, to, from);
        open = false;
    }
    return open;
}

static void look_round(search *s, const separation_cell *c) {
    const vec3 face = side_face(s->g, c->side);
    for (uint32_t i = 0; i < SEPARATION_PLACES; i++) {
        float b1, b2;
        separation_place(&c->corners, i, &b1, &b2);
        s->at[i] = vec3_along(side_place(s->g, c->side, b1, b2), face, c->lift);
        s->hidden[i] = 0;
    }
    for (uint32_t a = 0; a < SEPARATION_PLACES; a++)
        for (uint32_t b = a + 1; b < SEPARATION_PLACES; b++)
            if (!separation_sees(s->rays, s->at[a], s->at[b])) {
                if (s->planes < CANDIDATES)
                    note(s, s->at[a], s->at[b]);
                s->hidden[a] |= 1u << b;
                s->hidden[b] |= 1u << a;
            }
}

/* How many looks from a place end on the backs of triangles. */
static uint32_t backs_seen(const search *s, const separation_cell *c, vec3 at) {
    const vec3 face = side_face(s->g, c->side);
    vec3 across, up;
    uint32_t backs = 0;
    vec3_across(face, &across, &up);
    for (int i = 0; i < LOOKS; i++) {
        const vec3 aside = vec3_scale(i & 1 ? up : across, i & 2 ? -1.0f : 1.0f), d = vec3_unit(vec3_along(face, aside, 1.0f));
        float t;
        const uint32_t triangle = photon_rays_nearest(s->rays, at, d, &t);
        backs += triangle != VIT_NONE && vec3_dot(side_face(s->g, 2 * triangle), d) > 0.0f;
    }
    return backs;
}

/* Bits: places inside of a body that stands on the cell. They see backs alone, where others do not. */
static uint32_t find_buried(const search *s, const separation_cell *c) {
    uint32_t inside = 0, outside = 0;
    for (uint32_t i = 0; i < SEPARATION_PLACES; i++) {
        const uint32_t backs = backs_seen(s, c, s->at[i]);
        inside |= backs >= INSIDE ? 1u << i : 0u;
        outside |= backs <= LOOKS - INSIDE ? 1u << i : 0u;
    }
    return outside ? inside : 0;
}

/* Pairs in `hidden` of the places not alone: both ways. */
static int pairs_between(const search *s, uint32_t from, uint32_t to, bool hidden) {
    int sum = 0;
    for (uint32_t i = 0; i < SEPARATION_PLACES; i++)
        if (from >> i & 1)
            sum += __builtin_popcount((hidden ? s->hidden[i] : ~s->hidden[i]) & to & ~(1u << i));
    return sum;
}

/* The plane between the places that parts most pairs of those in `among` that do not see each other, and fewest that do. False:
 * none does. */
static bool find_plane(const search *s, uint32_t among, separation *out) {
    int best = 0;
    for (uint32_t c = 0; c < s->planes; c++) {
        const vec3 n = side_face(s->g, 2 * s->triangle[c]);
        const float offset = vec3_dot(n, vec3_load(s->g->triangles[s->triangle[c]].v0));
        uint32_t front = 0;
        for (uint32_t i = 0; i < SEPARATION_PLACES; i++)
            front |= vec3_dot(n, s->at[i]) > offset ? 1u << i : 0u;
        const uint32_t a = front, b = ~front & SEPARATION_EVERYWHERE;
        const int score = pairs_between(s, a & among, b & among, true) - pairs_between(s, a & among, b & among, false);
        if (a && b && score > best) {
            best = score;
            *out = (separation){.normal = {n.x, n.y, n.z}, .offset = offset, .places = a, .further = {VIT_NONE, VIT_NONE}};
        }
    }
    return best > 0;
}

/* A wall with two faces closer to each other than places are: another plane than `first` that parts all places alike and is on
 * its side `half` (0: in front), the farthest one. What lies between the two is within the wall. False: there is none. */
static bool find_other_face(const search *s, const separation *first, int half, separation *out) {
    const vec3 n = vec3_load(first->normal);
    float farthest = APART * s->rays->s->ray_offset;
    bool found = false;
    for (uint32_t c = 0; c < s->planes; c++) {
        const vec3 m = side_face(s->g, 2 * s->triangle[c]), on = vec3_load(s->g->triangles[s->triangle[c]].v0);
        const float offset = vec3_dot(m, on), off = (vec3_dot(n, on) - first->offset) * (half ? -1.0f : 1.0f);
        uint32_t front = 0;
        for (uint32_t i = 0; i < SEPARATION_PLACES; i++)
            front |= vec3_dot(m, s->at[i]) > offset ? 1u << i : 0u;
        if (fabsf(vec3_dot(m, n)) < PARALLEL || !(off > farthest) ||
            (front != first->places && front != (~first->places & SEPARATION_EVERYWHERE)))
            continue;
        farthest = off;
        found = true;
        *out = (separation){.normal = {m.x, m.y, m.z}, .offset = offset, .places = front, .further = {VIT_NONE, VIT_NONE}};
    }
    return found;
}

/* Of a cell: what parts it, and what parts the places in front of that, and behind, once more. */
typedef struct parting {
    separation plane[3];
    bool is[3];
} parting;

typedef struct finding {
    const separations_input *in;
    parting *found; /* a cell */
    uint32_t *alone, *buried;
} finding;

static void find(void *user, uint32_t number) {
    const finding *f = user;
    search s = {.rays = f->in->rays, .g = f->in->geometry};
    separation_cell c;
    parting *out = f->found + number;
    f->alone[number] = f->buried[number] = 0;
    if (!f->in->cell(f->in->user, number, &c) || looks_open(&s, &c))
        return;
    look_round(&s, &c);
    f->alone[number] = f->buried[number] = find_buried(&s, &c);
    for (uint32_t i = 0; i < SEPARATION_PLACES; i++)
        f->alone[number] |= (s.hidden[i] | 1u << i) == SEPARATION_EVERYWHERE ? 1u << i : 0u;
    const uint32_t not_alone = SEPARATION_EVERYWHERE & ~f->alone[number];
    out->is[0] = find_plane(&s, not_alone, out->plane) || find_plane(&s, SEPARATION_EVERYWHERE, out->plane);
    for (int k = 0; k < 2 && out->is[0]; k++) {
        const uint32_t half = SEPARATION_EVERYWHERE & (k ? ~out->plane[0].places : out->plane[0].places);
        out->is[1 + k] = find_plane(&s, not_alone & half, out->plane + 1 + k) || find_plane(&s, half, out->plane + 1 + k) ||
                         find_other_face(&s, out->plane, k, out->plane + 1 + k);
    }
}

/* As lists. False: out of memory. */
static bool list(const separations_input *in, const finding *f, separations *out) {
    uint32_t first = 0, all = 0;
    for (uint32_t i = 0; i < in->count; i++) {
        const bool *is = f->found[i].is;
        out->of[i] = is[0] ? first++ : VIT_NONE;
        all += (uint32_t)is[0] + is[1] + is[2];
    }
    out->found = malloc((all + 1u) * sizeof *out->found);
    out->count = out->found ? first : 0;
    for (uint32_t i = 0; i < in->count && out->found; i++) {
        parting *p = f->found + i;
        for (int k = 0; k < 2; k++)
            if (p->is[1 + k]) {
                p->plane[0].further[k] = out->count;
                out->found[out->count++] = p->plane[1 + k];
            }
        if (p->is[0])
            out->found[out->of[i]] = p->plane[0];
    }
    return out->found != NULL;
}

bool separations_find(const separations_input *in, separations *out) {
    const size_t room = (size_t)in->count + 1u;
    *out = (separations){.of = malloc(room * sizeof *out->of),
                         .alone = malloc(room * sizeof *out->alone),
                         .buried = malloc(room * sizeof *out->buried)};
    finding f = {in, calloc(room, sizeof *f.found), out->alone, out->buried};
    bool fine = out->of && out->alone && out->buried && f.found;
    if (fine) {
        parallel_for(in->threads, in->count, find, &f);
        fine = list(in, &f, out);
    }
    free(f.found);
    if (!fine)
        separations_free(out);
    return fine;
}

void separations_free(separations *s) {
    free(s->of);
    free(s->alone);
    free(s->buried);
    free(s->found);
    *s = (separations){0};
}
