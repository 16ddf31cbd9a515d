#include "common/parallel.h"
#include "radiosity/gather.h"
#include "radiosity/receivers_parts.h"
#include <stdlib.h>
#include <string.h>

#define FRAMES_LOOKED_AT 48u /* of the path, at most */
#define RAYS 6e6             /* from the cameras, over all of these; at most one a pixel */
#define UNSEEN_APART 0.02f   /* of the scene's size: receivers of sides that no ray met, should they be seen after all */
#define UNSEEN_BY_LIGHT 0.1f /* likewise, where the light of each is looked for by itself */
#define MOST_REACH 8.0f      /* cells round one that a ray met that others may meet, each way */

static float pixel_angle(const vit_camera *c) {
    const vec3 right = vec3_load(c->right);
    return sqrtf(vec3_dot(right, right));
}

typedef struct looking {
    const placing *p;
    uint32_t frame;
    uint32_t across;
    gather_hit *hit;
} looking;

static void look_row(void *user, uint32_t row) {
    const looking *l = user;
    const receivers_input *in = l->p->in;
    const vit_camera *c = in->tracks->cameras + l->frame;
    for (uint32_t i = 0; i < l->across; i++) {
        const uint32_t chance = pcg(row * l->across + i + pcg(l->frame));
        const bool all = l->p->step == 1; /* then as the frame's own */
        const float x = ((float)i + (all ? 0.5f : unit_float(chance))) * (float)l->p->step,
                    y = ((float)row + (all ? 0.5f : unit_float(pcg(chance)))) * (float)l->p->step;
        const vec3 d = vec3_unit(vec3_along(vec3_along(vec3_load(c->corner), vec3_load(c->right), x), vec3_load(c->down), y));
        l->hit[(size_t)row * l->across + i] = gather(in->rays, in->geometry, vec3_load(c->eye), d, pcg(chance ^ 1u));
    }
}

static bool takes_light(const receivers_input *in, uint32_t side) {
    return !side_is_dark(in->geometry, side) && gather_is_matt(in->rays->s, side / 2);
}

static uint32_t vertex_slot(const float v[3], uint32_t slots) {
    uint32_t word[3];
    memcpy(word, v, sizeof word);
    return pcg(word[0] ^ pcg(word[1] ^ pcg(word[2]))) & (slots - 1);
}

static bool faces_camera(const placing *p, uint32_t side, uint32_t frames) {
    const vec3 middle = side_place(p->in->geometry, side, 1.0f / 3.0f, 1.0f / 3.0f), face = side_face(p->in->geometry, side);
    for (uint32_t f = 0; f < frames; f++) {
        const vit_camera *c = p->in->tracks->cameras + (uint64_t)f * p->in->frames / frames;
        if (vec3_dot(face, vec3_sub(vec3_load(c->eye), middle)) > 0.0f)
            return true;
    }
    return false;
}

/* Small triangles may lie between the cameras' rays: sides that face a camera beside seen ones count as seen. A table of the
 * seen ones' vertices has what spacing they have; vertices that fall together there by chance do no harm. False: out of
 * memory. */
static bool spread_seen(placing *p, uint32_t frames) {
    const receivers_input *in = p->in;
    const uint32_t triangles = in->rays->s->triangle_count;
    uint32_t slots = 4096;
    while (slots < triangles * 4u && slots < 1u << 28)
        slots *= 2;
    float *least = malloc(slots * sizeof *least);
    if (!least)
        return false;
    for (uint32_t i = 0; i < slots; i++)
        least[i] = INFINITY;
    for (uint32_t i = 0; i < 2 * triangles; i++) {
        const vit_triangle *t = in->geometry->triangles + i / 2;
        const float *v[3] = {t->v0, t->v1, t->v2};
        for (int k = 0; k < 3 && p->seen[i]; k++) {
            float *at = least + vertex_slot(v[k], slots);
            *at = float_min(*at, p->spacing[i]);
        }
    }
    for (uint32_t i = 0; i < 2 * triangles; i++) {
        const vit_triangle *t = in->geometry->triangles + i / 2;
        if (p->seen[i] || !takes_light(in, i))
            continue;
        const float spacing = float_min(least[vertex_slot(t->v0, slots)],
                                        float_min(least[vertex_slot(t->v1, slots)], least[vertex_slot(t->v2, slots)]));
        if (!(spacing < INFINITY) || !faces_camera(p, i, frames))
            continue;
        p->seen[i] = true;
        p->spacing[i] = spacing;
        p->at[i][0] = p->at[i][1] = 1.0f / 3.0f;
    }
    free(least);
    return true;
}

bool receivers_find_spacing(placing *p) {
    const receivers_input *in = p->in;
    const uint32_t sides = 2 * in->rays->s->triangle_count,
                   frames = in->frames < FRAMES_LOOKED_AT ? in->frames : FRAMES_LOOKED_AT;
    p->step = (uint32_t)ceil(sqrt((double)in->width * in->height * frames / RAYS));
    looking l = {.p = p, .across = (in->width + p->step - 1) / p->step};
    const uint32_t down = (in->height + p->step - 1) / p->step;
    p->spacing = malloc(((size_t)sides + 1u) * sizeof *p->spacing);
    p->seen = calloc((size_t)sides + 1u, sizeof *p->seen);
    p->met = calloc((size_t)sides + 1u, sizeof *p->met);
    p->at = malloc(((size_t)sides + 1u) * sizeof *p->at);
    l.hit = malloc(((size_t)l.across * down + 1u) * sizeof *l.hit);
    p->sights = malloc(((size_t)l.across * down * frames + 1u) * sizeof *p->sights);
    if (!p->spacing || !p->seen || !p->at || !p->met || !l.hit || !p->sights) {
        free(l.hit);
        return false;
    }
    p->unseen = in->size * (in->light ? UNSEEN_BY_LIGHT : UNSEEN_APART);
    for (uint32_t i = 0; i < sides; i++)
        p->spacing[i] = INFINITY;
    for (uint32_t f = 0; f < frames; f++) {
        l.frame = (uint32_t)((uint64_t)f * in->frames / frames);
        const vit_camera *c = in->tracks->cameras + l.frame;
        parallel_for(in->threads, down, look_row, &l);
        for (size_t i = 0; i < (size_t)l.across * down; i++) {
            const gather_hit h = l.hit[i];
            if (h.side == VIT_NONE || !takes_light(in, h.side))
                continue;
            const vec3 way = vec3_sub(side_place(in->geometry, h.side, h.b1, h.b2), vec3_load(c->eye));
            const float pixel = sqrtf(vec3_dot(way, way)) * pixel_angle(c), wide = pixel * in->spacing,
                        slope = fabsf(vec3_dot(vec3_unit(way), side_face(in->geometry, h.side)));
            p->sights[p->sight_count++] = (receiver_sight){h.side, h.b1, h.b2, pixel * (float)p->step / float_max(slope, 0.1f)};
            if (wide < p->spacing[h.side]) {
                p->spacing[h.side] = float_max(wide, in->rays->s->ray_offset * 8.0f);
                p->at[h.side][0] = h.b1;
                p->at[h.side][1] = h.b2;
            }
            p->seen[h.side] = p->met[h.side] = true;
        }
    }
    free(l.hit);
    if ((p->step > 1 || frames < in->frames || in->within) && !spread_seen(p, frames))
        return false;
    for (uint32_t i = 0; i < sides; i++) {
        const bool takes = takes_light(in, i);
        p->out->lit_sides += takes;
        p->out->seen_sides += p->seen[i];
        p->spacing[i] = p->seen[i] ? p->spacing[i] : takes ? p->unseen : 0.0f;
    }
    return true;
}

/* Cells that another ray beside the sight's may meet, with those next to them. */
static void look_at(placing *p, const receiver_sight *s) {
    const uint32_t n = p->cells.sides[s->side] >> VIT_SIDE_PARTS_SHIFT;
    const int reach = (int)float_min(1.0f + s->wide / p->spacing[s->side], MOST_REACH);
    for (int i = -reach; i <= reach; i++)
        for (int j = -reach; j <= reach; j++) {
            const float b1 = s->b1 + (float)i / (float)n, b2 = s->b2 + (float)j / (float)n;
            if (b1 >= 0.0f && b2 >= 0.0f && b1 + b2 <= 1.0f)
                p->looked_at[cells_at(&p->cells, s->side, b1, b2)] = true;
        }
}

bool receivers_find_looked_at(placing *p) {
    p->looked_at = malloc((p->cells.count + 1u) * sizeof *p->looked_at);
    if (!p->looked_at)
        return false;
    for (uint32_t i = 0; i < p->cells.count; i++)
        p->looked_at[i] = !p->met[p->cells.side_of[i]] || p->cells.sides[p->cells.side_of[i]] >> VIT_SIDE_PARTS_SHIFT == 1;
    for (size_t i = 0; i < p->sight_count; i++)
        look_at(p, p->sights + i);
    return true;
}
