/* View samples and the direct light at them, against closed forms in double.
 *
 * What can go wrong: a sample is another pixel's, or behind its surface; a light's cone, range or distance is taken wrongly; a
 * shadow is missed, or is there where nothing is in the way, or reaches beyond the light. The bounds: a position is the eye and
 * a float's distance along a float's direction, and some roundings more at grazing angles, of the distance; on the grid of
 * small samples it is rounded to the nearest step, half a step an axis and what the float before it was off. Light is a dozen
 * roundings, of the largest in the frame. A shadow is right or wrong: rays within a millionth of the scene's size of an edge or
 * a plane, or a thousandth of a texel from a hole's, are left out and counted. */
#include "catalogue.h"
#include "oracle/direct_light.h"
#include "edited_pack.h"
#include "view_frame.h"

static open_pack pack;

static view_frame open_frame(const char *name, pack_edit *edit) {
    pack_open_edited(&pack, name, edit);
    pack_frame(&pack, pack.need.frames - 1);
    return view_frame_read(&pack, pack.need.frames - 1);
}

static void row(const char *name, const char *what, double worst, double bound, const char *unit) {
    char text[96];
    (void)snprintf(text, sizeof text, "%s: %s", name, what);
    catalogue_row("direct light", text, worst, bound, unit);
}

static void none(const char *name, const char *what, uint64_t wrong, uint64_t count, const char *things) {
    char text[96];
    (void)snprintf(text, sizeof text, "%s: %s", name, what);
    catalogue_none("direct light", text, wrong, count, things);
}

/* How far positions are from where they should be; small ones from 0.87 steps off the surface, which keeps them before it. */
static void check_positions(const char *name, double bound) {
    view_frame f = open_frame(name, NULL);
    const bool small = f.s->effects & VIT_BIT(SMALL_SAMPLES);
    const double step = (double)f.s->grid_step;
    vit_triangle *triangles = read_buffer(&pack, B_triangles);
    double worst = 0;
    uint64_t seen = 0, behind = 0;
    for (uint32_t y = 0; y < f.s->height; y++)
        for (uint32_t x = 0; x < f.s->width; x++) {
            const uint32_t i = oracle_number(f.s, x, y);
            if (f.hit[i] == VIT_NONE)
                continue;
            const oracle_sample own = view_frame_sample(&f, i);
            double p[3], face[3], off[3];
            const double far = oracle_hit_point(f.s, f.camera, triangles + f.hit[i], x, y, p, face);
            for (int k = 0; k < 3; k++) {
                off[k] = own.position[k] - p[k];
                const double error = small ? fabs(off[k] - 0.87 * step * face[k]) / step : fabs(off[k]) / far;
                worst = isfinite(error) ? fmax(worst, error) : INFINITY;
            }
            seen++;
            behind += oracle_dot(off, face) < (small ? -0.02 * step : -0.5 * (double)f.s->ray_offset);
        }
    assert_true(seen > f.s->samples / 2);
    row(name, "positions against the hit point", worst, bound, small ? "steps" : "of the distance");
    none(name, "positions that moved towards the surface", behind, seen, "samples");
    free(triangles);
    view_frame_free(&f);
    pack_close(&pack);
}

static void samples_are_where_rays_hit(void **state) {
    (void)state;
    check_positions("list", 1e-6);
    check_positions("room", 1e-6);
    check_positions("small", 0.52);
}

typedef struct lit {
    oracle_blockers b;
    view_frame f;
    vit_light *lights; /* of the frame */
    uint32_t *albedo;
    float *direct;
} lit;

typedef struct light_check {
    double worst, largest;
    uint64_t samples, open, shadowed, shadows_wrong, doubtful;
} light_check;

/* How far a light is before the sample's triangle, as seen from the side that the sample is on, m. */
static double light_before(const vit_triangle *t, const vit_light *light, const double p[3]) {
    const double n[3] = {(double)t->nx, (double)t->ny, (double)t->nz};
    double own[3], to[3];
    for (int c = 0; c < 3; c++) {
        own[c] = p[c] - (double)t->v0[c];
        to[c] = (double)light->position[c] - p[c];
    }
    return (oracle_dot(n, own) < 0 ? -1 : 1) * oracle_dot(n, to) / sqrt(oracle_dot(n, n));
}

/* Sum over lights of what arrives at the sample; `facing` counts those that would reach it, `blocked` those that do not. */
static oracle_verdict sum_lights(const lit *l, uint32_t i, double sum[3], int *facing, int *blocked) {
    const oracle_sample own = view_frame_sample(&l->f, i);
    const vit_scene *s = l->f.s;
    const double margin = (double)s->ray_offset / 16; /* the ray offset is 2^-16 of the largest coordinate */
    for (uint32_t k = 0; k < s->lights; k++) {
        const double e = oracle_light(l->lights + k, own.position, own.normal);
        const double before = light_before(l->b.triangles + l->f.hit[i], l->lights + k, own.position);
        float o[3], d[3];
        if (!(e > 0) || before < -margin) /* from behind the triangle none comes, whatever its interpolated normal */
            continue;
        if (before < margin)
            return ORACLE_DOUBTFUL;
        for (int c = 0; c < 3; c++) {
            o[c] = (float)own.position[c];
            d[c] = l->lights[k].position[c] - o[c];
        }
        const oracle_verdict v = oracle_shadow(&l->b, o, d, margin);
        if (v == ORACLE_DOUBTFUL)
            return v;
        ++*facing;
        *blocked += v == ORACLE_BLOCKED;
        for (int c = 0; c < 3; c++)
            sum[c] += v == ORACLE_FREE ? e * (double)l->lights[k].intensity[c] : 0;
    }
    return ORACLE_FREE;
}

static void check_sample(const lit *l, uint32_t i, light_check *c) {
    const vit_scene *s = l->f.s;
    const vit_material *m = l->b.materials + (l->b.attributes[l->f.hit[i]].material & VIT_MATERIAL_INDEX);
    double sum[3] = {0, 0, 0};
    int facing = 0, blocked = 0;
    bool wrong = false;
    c->samples++;
    if (sum_lights(l, i, sum, &facing, &blocked) == ORACLE_DOUBTFUL) {
        c->doubtful++;
        return;
    }
    for (uint32_t k = 0; k < 3; k++) {
        const double root = (l->albedo[i] >> 10 * k & 1023) / 1023.0, due = root * root * sum[k] / 3.14159265358979324;
        const double is = (double)l->direct[(size_t)k * s->samples + i] - (double)m->emission[k];
        wrong = wrong || (facing == blocked && is != 0);
        c->worst = isfinite(is) ? fmax(c->worst, fabs(is - due)) : INFINITY;
        c->largest = fmax(c->largest, due);
    }
    c->open += facing > 0 && blocked == 0;
    c->shadowed += facing > 0 && blocked == facing;
    c->shadows_wrong += wrong;
}

/* edges: how many samples rounding may decide, of all. */
static void check_light(const char *name, const char *pack_name, pack_edit *edit, uint32_t stride, double edges) {
    lit l = {.f = open_frame(pack_name, edit)};
    vit_light *lights = read_buffer(&pack, B_lights);
    light_check c = {0};
    const bool textured = l.f.s->effects & (VIT_BIT(TEXTURES) | VIT_BIT(CUTOUT));
    l.lights = lights + (size_t)(pack.need.frames - 1) * l.f.s->lights;
    l.albedo = read_buffer(&pack, B_albedo);
    l.direct = read_buffer(&pack, B_direct);
    l.b = (oracle_blockers){
        .s = l.f.s, .triangles = read_buffer(&pack, B_triangles), .attributes = read_buffer(&pack, B_attributes)};
    l.b.materials = read_buffer(&pack, B_materials);
    l.b.textures = textured ? read_buffer(&pack, B_textures) : NULL;
    l.b.mips = textured ? read_buffer(&pack, B_mips) : NULL;
    l.b.texels = textured ? read_buffer(&pack, B_texels) : NULL;
    for (uint32_t i = 0; i < l.f.s->samples; i += catalogue_whole() ? 1 : stride)
        if (l.f.hit[i] != VIT_NONE)
            check_sample(&l, i, &c);
    (void)printf("%s: %llu samples, %llu open, %llu in full shadow, %llu doubtful\n", name, (unsigned long long)c.samples,
                 (unsigned long long)c.open, (unsigned long long)c.shadowed, (unsigned long long)c.doubtful);
    row(name, "radiance against albedo / pi times the closed form", c.worst / c.largest, 1e-6, "of the largest");
    none(name, "samples lit that no light reaches", c.shadows_wrong, c.samples, "samples");
    row(name, "samples left out; near an edge", (double)c.doubtful / (double)c.samples, edges, "of all");
    assert_true(c.open > c.samples / 4 && c.shadowed > c.samples / 100);
    free(lights);
    free(l.albedo);
    free(l.direct);
    free(l.b.triangles);
    free(l.b.attributes);
    free(l.b.materials);
    free(l.b.textures);
    free(l.b.mips);
    free(l.b.texels);
    view_frame_free(&l.f);
    pack_close(&pack);
}

static void light_is_the_closed_form_or_is_shadowed(void **state) {
    (void)state;
    check_light("list", "list", NULL, 7, 0.01);
    check_light("small", "small", NULL, 7, 0);
    check_light("room", "room", NULL, 1, 0.01);
}

/* Ranges that end in the room, of one light by a window alone. */
static void shorten(vit_scene *s, vit_camera *cameras, vit_light *lights) {
    (void)cameras;
    assert_true(s->lights == 2 && s->effects & VIT_BIT(RANGE));
    for (uint32_t i = 0; i < s->frames; i++) {
        lights[2 * i].inv_range2 = 1 / (1.5f * 1.5f);
        lights[2 * i].falloff = VIT_FALLOFF_WINDOW;
        lights[2 * i + 1].inv_range2 = 1 / (1.75f * 1.75f);
    }
}

static void ranges_end_where_they_say(void **state) {
    (void)state;
    check_light("room; short ranges; one a window", "room", shorten, 1, 0.01);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(samples_are_where_rays_hit),
                                       cmocka_unit_test(light_is_the_closed_form_or_is_shadowed),
                                       cmocka_unit_test(ranges_end_where_they_say)};
    return cmocka_run_group_tests_name("direct light", tests, NULL, NULL);
}
