/* Dark sides. Random rays decide, so the tests use scenes in which the answer is beyond doubt: closed boxes, boxes with a hole,
 * faces that touch. The front of a box's face is outside. What must never happen is a lit side that is called dark; several
 * tests are about what could lead to it: small triangles, cut-outs, lights that are somewhere for one frame only. */
#include "pack/planner.h"
#include "dark_sides/dark_sides.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

#define MAX_TRIANGLES 40000
#define MAX_FRAMES 100

enum { OPAQUE, CUT_OUT, MIRROR, GLASS, THIN_GLASS, LAMP };

typedef struct fixture {
    model m;
    model_material materials[6]; /* opaque, cut out, mirror, glass, thin glass, lamp */
    bvh b;
    geometry g;
    vit_light lights[MAX_FRAMES];
    vit_camera *cameras; /* a frame; NULL: nothing is looked at */
    uint32_t frames;
    bool sky;
    uint32_t flags[MAX_TRIANGLES]; /* found, by the triangle's number in the model */
    dark_sides r;
} fixture;

static fixture *make(void) {
    fixture *f = calloc(1, sizeof *f);
    assert_non_null(f);
    f->m.position = calloc(9 * MAX_TRIANGLES, sizeof(float));
    f->m.normal = calloc(9 * MAX_TRIANGLES, sizeof(float));
    f->m.uv = calloc(6 * MAX_TRIANGLES, sizeof(float));
    f->m.index = calloc(3 * MAX_TRIANGLES, sizeof(uint32_t));
    f->m.material = calloc(MAX_TRIANGLES, sizeof(uint32_t));
    assert_true(f->m.position && f->m.normal && f->m.uv && f->m.index && f->m.material);
    f->m.materials = f->materials;
    f->m.material_count = 6;
    for (int i = 0; i < 6; i++)
        f->materials[i] = (model_material){.image = -1, .exponent = 1.0f, .ior = 1.5f};
    f->materials[MIRROR].kind = VIT_MIRROR;
    f->materials[GLASS].kind = VIT_GLASS;
    f->materials[THIN_GLASS].kind = VIT_THIN_GLASS;
    f->materials[LAMP].emission[1] = 1.0f;
    f->materials[LAMP].area_light = true;
    f->materials[1].cutoff = 0.5f;
    return f;
}

static void drop(fixture *f) {
    bvh_free(&f->b);
    geometry_free(&f->g);
    free(f->m.position);
    free(f->m.normal);
    free(f->m.uv);
    free(f->m.index);
    free(f->m.material);
    free(f);
}

static void add_triangle(fixture *f, const float a[3], const float b[3], const float c[3]) {
    assert_true(f->m.triangles < MAX_TRIANGLES);
    const float *corner[3] = {a, b, c};
    for (uint32_t i = 0; i < 3; i++) {
        memcpy(f->m.position + 3 * (size_t)f->m.vertices, corner[i], 3 * sizeof(float));
        f->m.normal[3 * (size_t)f->m.vertices + 1] = 1.0f;
        f->m.index[3 * (size_t)f->m.triangles + i] = f->m.vertices++;
    }
    f->m.triangles++;
}

/* Two triangles a cell; the front is where `u` x `v` points. */
static void add_plate(fixture *f, const float o[3], const float u[3], const float v[3], int cells) {
    for (int j = 0; j < cells; j++)
        for (int i = 0; i < cells; i++) {
            float p[4][3];
            for (int c = 0; c < 4; c++)
                for (int k = 0; k < 3; k++)
                    p[c][k] = o[k] + u[k] * (float)(i + (c & 1)) / (float)cells + v[k] * (float)(j + (c >> 1)) / (float)cells;
            add_triangle(f, p[0], p[1], p[3]);
            add_triangle(f, p[0], p[3], p[2]);
        }
}

/* A closed box: faces -x +x -y +y -z +z, each of 2 cells^2 triangles. Returns its first triangle. */
static uint32_t add_box(fixture *f, const float lo[3], const float hi[3], int cells) {
    const uint32_t first = f->m.triangles;
    for (int axis = 0; axis < 3; axis++)
        for (int side = 0; side < 2; side++) {
            float o[3] = {lo[0], lo[1], lo[2]}, u[3] = {0, 0, 0}, v[3] = {0, 0, 0};
            const int a = (axis + 1) % 3, b = (axis + 2) % 3;
            o[axis] = side ? hi[axis] : lo[axis];
            u[side ? a : b] = side ? hi[a] - lo[a] : hi[b] - lo[b];
            v[side ? b : a] = side ? hi[b] - lo[b] : hi[a] - lo[a];
            add_plate(f, o, u, v, cells);
        }
    return first;
}

static void add_light(fixture *f, float x, float y, float z) {
    f->lights[f->frames++] = (vit_light){.position = {x, y, z}, .intensity = {1.0f, 1.0f, 1.0f}, .cos_outer = -1.0f};
}

static void search(fixture *f, unsigned threads) {
    const tracks t = {.cameras = f->cameras, .lights = f->lights, .light_count = f->frames > 0};
    vit_text why = {""};
    bvh_free(&f->b);
    geometry_free(&f->g);
    const dark_sides_input in = {
        .model = &f->m, .tracks = &t, .frames = f->frames > 0 ? f->frames : 1, .sky_light = f->sky, .threads = threads};
    if (bvh_build(&f->m, 1, &f->b, &why) != VIT_OK || geometry_pack(&f->m, &f->b, &f->g, &why) != VIT_OK ||
        dark_sides_find(&in, &f->g, &f->r, &why) != VIT_OK)
        fail_msg("%s", why.text);
    for (uint32_t i = 0; i < f->m.triangles; i++)
        f->flags[f->b.order[i]] = f->g.attributes[i].material & (VIT_SIDE_DARK_FRONT | VIT_SIDE_DARK_BACK);
}

static void paint(fixture *f, uint32_t first, uint32_t count, uint32_t material) {
    for (uint32_t i = first; i < first + count; i++)
        f->m.material[i] = material;
}

static void expect(const fixture *f, uint32_t first, uint32_t count, uint32_t wanted) {
    for (uint32_t i = first; i < first + count; i++)
        assert_int_equal(f->flags[i], wanted);
}

#define ROOM ((const float[3]){-5, 0, -5}), ((const float[3]){5, 5, 5})

static void the_inside_of_a_closed_box_is_dark_and_its_outside_lit(void **state) {
    (void)state;
    fixture *f = make();
    const uint32_t room = add_box(f, ROOM, 1), box = add_box(f, (const float[]){-1, 1, -1}, (const float[]){1, 2, 1}, 4);
    add_light(f, 0, 4, 0);
    search(f, 2);
    expect(f, room, 12, VIT_SIDE_DARK_FRONT); /* nothing is outside */
    expect(f, box, 6 * 32, VIT_SIDE_DARK_BACK);
    assert_true(fabs(f->r.area - 2.0 * (400.0 + 16.0)) < 1e-3);
    assert_true(fabs(f->r.dark_front - 400.0) < 1e-3);
    assert_true(fabs(f->r.dark_back - 16.0) < 1e-3);
    assert_int_equal(f->r.dark_sides, 12 + 6 * 32);
    drop(f);
}

static void light_finds_its_way_through_a_hole(void **state) {
    (void)state;
    fixture *f = make();
    add_box(f, ROOM, 1);
    const uint32_t box = add_box(f, (const float[]){-1, 1, -1}, (const float[]){1, 2, 1}, 4);
    add_light(f, 4, 4, 4);
    const float elsewhere[9] = {3, 1, 3, 3.5f, 1, 3, 3, 1, 3.5f}; /* where one triangle of the box's 192 goes */
    memcpy(f->m.position + 9 * (size_t)(box + 40), elsewhere, sizeof elsewhere);
    search(f, 2);
    expect(f, box, 6 * 32, 0);
    drop(f);
}

static void faces_that_touch_are_dark_on_both_sides(void **state) {
    (void)state;
    fixture *f = make();
    add_box(f, ROOM, 1);
    const uint32_t left = add_box(f, (const float[]){-1, 1, -1}, (const float[]){0, 2, 1}, 3);
    const uint32_t right = add_box(f, (const float[]){0, 1, -1}, (const float[]){1, 2, 1}, 4);
    add_light(f, 0, 4, 0);
    search(f, 2);
    expect(f, left, 18, VIT_SIDE_DARK_BACK);
    expect(f, left + 18, 18, VIT_SIDE_DARK_FRONT | VIT_SIDE_DARK_BACK); /* +x face */
    expect(f, left + 36, 72, VIT_SIDE_DARK_BACK);
    expect(f, right, 32, VIT_SIDE_DARK_FRONT | VIT_SIDE_DARK_BACK); /* -x face */
    expect(f, right + 32, 160, VIT_SIDE_DARK_BACK);
    drop(f);
}

static void no_small_triangle_is_darkened_by_bad_luck(void **state) {
    (void)state;
    fixture *f = make();
    const uint32_t room = add_box(f, ROOM, 50); /* 30 000 triangles */
    const uint32_t dust = f->m.triangles;       /* plates of 2 mm, far fewer light rays than triangles hit one */
    for (int i = 0; i < 500; i++)
        add_plate(f, (const float[]){-4.0f + 0.016f * (float)i, 0.5f, -3.0f + 0.01f * (float)(i % 37)},
                  (const float[]){0, 0, 0.002f}, (const float[]){0.002f, 0, 0}, 1);
    add_light(f, 0, 4, 0);
    search(f, 2);
    expect(f, room, 30000, VIT_SIDE_DARK_FRONT);
    expect(f, dust, 1000, 0);
    drop(f);
}

/* Specks of 2 mm in a row, facing down. */
static uint32_t add_specks(fixture *f, int count, float y) {
    const uint32_t first = f->m.triangles;
    for (int i = 0; i < count; i++)
        add_plate(f, (const float[]){-0.3f + 0.6f * (float)i / (float)count, y, 0}, (const float[]){0.002f, 0, 0},
                  (const float[]){0, 0, 0.002f}, 1);
    return first;
}

/* In the plane of the plate, so that nothing but the light lights them. */
static void specks_that_see_the_light_alone_are_lit(void **state) {
    (void)state;
    fixture *f = make();
    add_plate(f, (const float[]){3, 3, 0}, (const float[]){1, 0, 0}, (const float[]){0, 0, 1}, 2);
    const uint32_t specks = add_specks(f, 100, 3);
    add_light(f, 0, 0, 0);
    search(f, 2);
    expect(f, specks, 200, VIT_SIDE_DARK_BACK);
    drop(f);
}

/* A plate that fills a twentieth of what the specks see is lit by a spot light that shines away from them. */
static void specks_that_see_something_lit_in_a_corner_of_their_view_are_lit(void **state) {
    (void)state;
    fixture *f = make();
    add_plate(f, (const float[]){-0.4f, 0, -0.4f}, (const float[]){0, 0, 0.8f}, (const float[]){0.8f, 0, 0}, 2);
    const uint32_t specks = add_specks(f, 100, 2);
    add_light(f, 0, 1, 0);
    f->lights[0].kind = VIT_LIGHT_SPOT;
    f->lights[0].direction[1] = -1.0f;
    f->lights[0].cos_outer = 0.9f;
    search(f, 2);
    expect(f, specks, 200, VIT_SIDE_DARK_BACK);
    drop(f);
}

/* Rays start above the surface; near a sharp edge that would be outside. */
static void the_inside_of_a_sharp_wedge_is_dark(void **state) {
    (void)state;
    fixture *f = make();
    add_box(f, ROOM, 1);
    const uint32_t wedge = f->m.triangles; /* 17 degrees at x = -1 */
    const float a[2][3] = {{-1, 1, -1}, {-1, 1, 1}}, b[2][3] = {{1, 1, -1}, {1, 1, 1}}, c[2][3] = {{1, 1.6f, -1}, {1, 1.6f, 1}};
    const float along[3] = {0, 0, 2};
    add_plate(f, a[0], (const float[]){2, 0, 0}, along, 40);
    add_plate(f, b[0], (const float[]){0, 0.6f, 0}, along, 40);
    add_plate(f, a[0], along, (const float[]){2, 0.6f, 0}, 40);
    add_triangle(f, a[0], c[0], b[0]);
    add_triangle(f, a[1], b[1], c[1]);
    add_light(f, 0, 4, 0);
    search(f, 2);
    expect(f, wedge, f->m.triangles - wedge, VIT_SIDE_DARK_BACK);
    drop(f);
}

static void light_passes_the_holes_of_a_cut_out(void **state) {
    (void)state;
    fixture *f = make();
    add_box(f, ROOM, 1);
    const uint32_t outer = add_box(f, (const float[]){-1, 1, -1}, (const float[]){1, 2, 1}, 2);
    const uint32_t inner = add_box(f, (const float[]){-0.5f, 1.2f, -0.5f}, (const float[]){0.5f, 1.8f, 0.5f}, 2);
    for (uint32_t i = outer; i < inner; i++)
        f->m.material[i] = 1;
    add_light(f, 0, 4, 0);
    search(f, 2);
    expect(f, outer, inner - outer, 0);
    expect(f, inner, f->m.triangles - inner, VIT_SIDE_DARK_BACK);
    drop(f);
}

static void a_room_that_the_light_visits_for_one_frame_is_lit(void **state) {
    (void)state;
    fixture *f = make();
    const uint32_t room = add_box(f, ROOM, 2), other = add_box(f, (const float[]){20, 0, 0}, (const float[]){26, 3, 4}, 2);
    const uint32_t never = add_box(f, (const float[]){40, 0, 0}, (const float[]){46, 3, 4}, 2);
    for (int i = 0; i < MAX_FRAMES; i++)
        add_light(f, i == 61 ? 23.0f : 0.02f * (float)i, 2, i == 61 ? 2.0f : 0.0f);
    search(f, 2);
    expect(f, room, 48, VIT_SIDE_DARK_FRONT);
    expect(f, other, 48, VIT_SIDE_DARK_FRONT);
    expect(f, never, 48, VIT_SIDE_DARK_FRONT | VIT_SIDE_DARK_BACK);
    drop(f);
}

static void a_spot_light_lights_only_its_cone(void **state) {
    (void)state;
    for (int spot = 0; spot < 2; spot++) {
        fixture *f = make(); /* two plates above the light; their back is below */
        add_plate(f, (const float[]){-0.5f, 3, -0.5f}, (const float[]){0, 0, 1}, (const float[]){1, 0, 0}, 2);
        add_plate(f, (const float[]){2.5f, 3, -0.5f}, (const float[]){0, 0, 1}, (const float[]){1, 0, 0}, 2);
        add_light(f, 0, 1, 0);
        if (spot) {
            f->lights[0].kind = VIT_LIGHT_SPOT;
            f->lights[0].direction[1] = 1.0f;
            f->lights[0].cos_outer = 0.95f;
        }
        search(f, 2);
        expect(f, 0, 8, VIT_SIDE_DARK_FRONT);
        expect(f, 8, 8, spot ? VIT_SIDE_DARK_FRONT | VIT_SIDE_DARK_BACK : VIT_SIDE_DARK_FRONT);
        drop(f);
    }
}

/* Rays, not seconds: boxes in a closed box; 112 rays per side would tell the same. */
static void insides_of_bodies_cost_few_rays(void **state) {
    (void)state;
    fixture *f = make();
    add_box(f, ROOM, 1);
    const uint32_t housing = add_box(f, (const float[]){-2, 1, -2}, (const float[]){2, 3, 2}, 8), parts = f->m.triangles;
    for (int i = 0; i < 80; i++) {
        const float x = 0.35f * (float)(i % 10) - 1.8f, z = 0.45f * (float)(i / 10) - 1.8f;
        add_box(f, (const float[]){x, 1.5f, z}, (const float[]){x + 0.3f, 2, z + 0.3f}, 5);
    }
    add_light(f, 4, 4, 4);
    search(f, 2);
    expect(f, housing, parts - housing, VIT_SIDE_DARK_BACK);
    expect(f, parts, f->m.triangles - parts, VIT_SIDE_DARK_FRONT | VIT_SIDE_DARK_BACK);
    const uint64_t sides = 2 * (uint64_t)f->m.triangles, of_lights = 1u << 18;
    assert_true(f->r.rays > of_lights && f->r.rays < of_lights + 40 * sides);
    drop(f);
}

/* A wall across the long room of the next function, with a square hole of `width` m about (x, 2.5, z). */
static void add_wall(fixture *f, float x, float z, float width) {
    const float near = z - 0.5f * width, far = z + 0.5f * width, beside = 2.5f - 0.5f * width;
    add_plate(f, (const float[]){x, 0, -5}, (const float[]){0, 5, 0}, (const float[]){0, 0, near + 5}, 8);
    add_plate(f, (const float[]){x, 0, far}, (const float[]){0, 5, 0}, (const float[]){0, 0, 5 - far}, 8);
    add_plate(f, (const float[]){x, 0, near}, (const float[]){0, beside, 0}, (const float[]){0, 0, width}, 2);
    add_plate(f, (const float[]){x, 5 - beside, near}, (const float[]){0, beside, 0}, (const float[]){0, 0, width}, 2);
}

/* Looks along x, 90 degrees wide, 100 pixels. */
static vit_camera camera_at(float x, float y, float z, float forward) {
    return (vit_camera){.eye = {x, y, z},
                        .exposure = 1.0f,
                        .corner = {forward, 1.0f, -forward},
                        .right = {0, 0, 0.02f * forward},
                        .down = {0, -0.02f, 0},
                        .forward = {forward, 0, 0}};
}

/* Three rooms of 400 m2 in a row, the lamp in the first, each open to the next by a hole out of the lamp's sight: what comes
 * in, 0.8 E width^2, is what 0.2 of the walls swallow, so each has 1e-2 width^2 of the irradiance before it; the threshold
 * is 1.8e-5 of the first. Returns the part of the last one's outer walls that is lit. All outsides must be dark, as must a
 * closed box in the last room. */
static double lit_behind_two_holes(float width, vit_camera *cameras) {
    fixture *f = make();
    const uint32_t box = add_box(f, (const float[]){-15, 0, -5}, (const float[]){15, 5, 5}, 24), end = f->m.triangles;
    add_wall(f, 5, -3, width);
    add_wall(f, -5, 3, width);
    const uint32_t inner = add_box(f, (const float[]){-11, 0.1f, -2}, (const float[]){-10.6f, 0.5f, -1.6f}, 4);
    f->cameras = cameras;
    add_light(f, 10, 4, 4);
    search(f, 2);
    uint32_t walls = 0, lit = 0;
    for (uint32_t i = box; i < end; i++) {
        const float *p = f->m.position + 9 * (size_t)i;
        assert_true(f->flags[i] & VIT_SIDE_DARK_FRONT);
        if (p[0] + p[3] + p[6] < 3 * -5.0f) {
            walls++;
            lit += !(f->flags[i] & VIT_SIDE_DARK_BACK);
        }
    }
    for (uint32_t i = inner; i < f->m.triangles; i++)
        assert_true(f->flags[i] & VIT_SIDE_DARK_BACK);
    drop(f);
    return (double)lit / walls;
}

static void a_dim_room_is_lit_and_a_dimmer_one_dark(void **state) {
    (void)state;
    const double dim = lit_behind_two_holes(0.9f, NULL), dimmer = lit_behind_two_holes(0.5f, NULL);
    print_message("lit: %.4f with 3.6 times the threshold, %.4f with 0.35 of it\n", dim, dimmer);
    assert_true(dim > 0.98);
    assert_true(dimmer < 0.05);
}

/* Seen from within, the dimmer room is all that there is; from the first room it is nothing. */
static void a_dim_room_that_fills_a_frame_is_lit(void **state) {
    (void)state;
    vit_camera there = camera_at(-6, 2.5f, -4, -1), here = camera_at(8, 2.5f, 0, -1);
    const double seen = lit_behind_two_holes(0.5f, &there), narrow = lit_behind_two_holes(0.1f, &there),
                 unseen = lit_behind_two_holes(0.5f, &here);
    print_message("lit: %.4f and %.4f seen from within, with 0.35 and 0.0006 of the threshold, %.4f from afar\n", seen, narrow,
                  unseen);
    assert_true(seen > 0.98 && narrow > 0.98);
    assert_true(unseen < 0.05);
}

static void without_light_nothing_is_flagged(void **state) {
    (void)state;
    fixture *f = make();
    add_box(f, ROOM, 1);
    add_light(f, 0, 4, 0);
    memset(f->lights[0].intensity, 0, sizeof f->lights[0].intensity);
    search(f, 2);
    expect(f, 0, 12, 0);
    assert_int_equal(f->r.dark_sides, 0);
    drop(f);
}

static void one_thread_and_two_flag_the_same_sides(void **state) {
    (void)state;
    fixture *f = make();
    add_box(f, ROOM, 12);
    for (int i = 0; i < 60; i++) { /* a heap of boxes that overlap, so that many sides are near the threshold */
        const float x = 0.13f * (float)(i * 17 % 31) - 2.0f, y = 0.11f * (float)(i * 7 % 13),
                    z = 0.12f * (float)(i * 11 % 29) - 2.0f;
        add_box(f, (const float[]){x, y, z}, (const float[]){x + 0.7f, y + 0.6f, z + 0.5f}, 3);
    }
    add_light(f, 0, 4, 0);
    search(f, 1);
    assert_true(f->r.dark_back > 0.0);
    uint32_t one[MAX_TRIANGLES];
    memcpy(one, f->flags, sizeof one);
    for (unsigned run = 0; run < 3; run++) {
        search(f, run == 2 ? 0 : 2);
        assert_memory_equal(f->flags, one, sizeof one);
    }
    drop(f);
}

/* Of chords of a convex body that begin evenly over its surface and along the cosine the mean is 4 volumes over the surface.
 * All faces of a cube are alike, so light that does not lie evenly has the same mean. */
static void light_goes_the_mean_chord_of_a_cube(void **state) {
    (void)state;
    for (int size = 1; size <= 4; size *= 4) {
        fixture *f = make();
        const float s = (float)size;
        add_box(f, (const float[]){0, 0, 0}, (const float[]){s, s, s}, 12);
        add_light(f, 0.5f * s, 0.5f * s, 0.5f * s);
        search(f, 1);
        const double one = f->r.free_path, chord = 4.0 * s * s * s / (6.0 * s * s);
        assert_true(fabs(one / chord - 1.0) < 0.02);
        search(f, 3);
        assert_memory_equal(&f->r.free_path, &one, sizeof one);
        drop(f);
    }
}

static void light_that_leaves_the_scene_goes_no_way(void **state) {
    (void)state;
    fixture *f = make();
    add_plate(f, (const float[]){-50, 0, -50}, (const float[]){0, 0, 100}, (const float[]){100, 0, 0}, 20);
    add_light(f, 0, 1, 0);
    search(f, 2);
    assert_true(f->r.free_path >= 0.0 && f->r.free_path <= 0.0); /* an even floor: light finds nothing */
    drop(f);
}

/* The radius "auto": a fifth of the way, but 4 to 150 photons a disc, and always a number that is one. */
static void the_automatic_radius_follows_the_way_of_light_within_bounds(void **state) {
    static const double ways[] = {0.0, 0.1, 1.0, 5.0, 1e30, (double)NAN};
    (void)state;
    for (size_t i = 0; i < sizeof ways / sizeof ways[0]; i++) {
        const plan p = {.lit_area = 100.0, .free_path = ways[i]};
        double last = INFINITY;
        for (double stored = 1.0; stored < 1e9; stored *= 3.0) {
            const double radius = plan_radius(&p, stored), held = 3.14159265358979 * radius * radius * stored / 100.0;
            assert_true(held > 4.0 * 0.999 && held < 150.0 * 1.001);
            assert_true(radius <= last);
            last = radius;
            if (held > 4.01 && held < 149.0)
                assert_true(fabs(radius / (0.2 * ways[i]) - 1.0) < 0.001);
        }
    }
    const plan room = {.lit_area = 100.0, .free_path = 3.0};
    assert_true(fabs(plan_radius(&room, 2000.0) - 0.6) < 0.001);
}

/* A box in a glass box, in a room with a lamp: glass lets light in, to both sides of what stands there, and is not dark itself.
 */
static void light_gets_into_glass(void **state) {
    (void)state;
    for (uint32_t kind = GLASS; kind <= THIN_GLASS; kind++) {
        fixture *f = make();
        add_box(f, ROOM, 1);
        const uint32_t glass = add_box(f, (const float[]){-1, 1, -1}, (const float[]){1, 3, 1}, 2),
                       inner = add_box(f, (const float[]){-0.5f, 1.5f, -0.5f}, (const float[]){0.5f, 2.5f, 0.5f}, 4);
        paint(f, glass, inner - glass, kind);
        add_light(f, 4, 4, 4);
        search(f, 2);
        expect(f, glass, inner - glass, 0);
        expect(f, inner, 6 * 32, VIT_SIDE_DARK_BACK);
        assert_true(fabs(f->r.area - 2.0 * (400.0 + 6.0)) < 1e-3); /* without the glass */
        drop(f);
    }
}

/* Two rooms with a window between them. */
static void light_passes_a_window(void **state) {
    (void)state;
    for (int window = 0; window < 2; window++) {
        fixture *f = make();
        add_box(f, ROOM, 4);
        const uint32_t wall = f->m.triangles;
        add_plate(f, (const float[]){0, 0, -5}, (const float[]){0, 0, 10}, (const float[]){0, 5, 0}, 4);
        paint(f, wall + 10, 2, window ? THIN_GLASS : OPAQUE);
        add_light(f, 3, 3, 1);
        search(f, 2);
        uint32_t beyond = 0, dark = 0;
        for (uint32_t i = 0; i < wall; i++) { /* the room's far wall */
            const float *p = f->m.position + 9 * (size_t)i;
            if (p[0] > -4.99f || p[3] > -4.99f || p[6] > -4.99f)
                continue;
            beyond++;
            dark += f->flags[i] == (VIT_SIDE_DARK_FRONT | VIT_SIDE_DARK_BACK);
        }
        assert_int_equal(beyond, 32);
        assert_int_equal(dark, window ? 0 : 32);
        drop(f);
    }
}

/* Round a corner by a mirror alone: a narrow duct whose walls are mirrors but for a plate at its end. */
static void mirrors_hand_light_on(void **state) {
    (void)state;
    for (int mirror = 0; mirror < 2; mirror++) {
        fixture *f = make();
        add_box(f, (const float[]){0, 0, 0}, (const float[]){6, 1, 1}, 1);
        const uint32_t duct = f->m.triangles;
        paint(f, 0, duct, mirror ? MIRROR : OPAQUE);
        add_plate(f, (const float[]){5.9f, 0.2f, 0.2f}, (const float[]){0, 0, 0.6f}, (const float[]){0, 0.6f, 0}, 2);
        add_light(f, 0.5f, 0.5f, 0.5f);
        f->lights[0].kind = VIT_LIGHT_SPOT; /* away from the plate */
        f->lights[0].direction[1] = 1.0f;
        f->lights[0].cos_outer = 0.7f;
        search(f, 2);
        /* Both sides: the plate's back sees the end. */
        expect(f, duct, 8, 0);
        if (mirror)
            assert_true(fabs(f->r.area - 2 * 0.36) < 1e-4);
        drop(f);
    }
}

/* A lamp of its own light: what it shines on is lit, what hangs before its other side, in a box, too; a covered side sends
 * none. */
static void area_lights_light(void **state) {
    (void)state;
    fixture *f = make();
    const uint32_t room = add_box(f, ROOM, 1), box = add_box(f, (const float[]){-1, 1, -1}, (const float[]){1, 2, 1}, 4),
                   lamp = f->m.triangles;
    add_plate(f, (const float[]){3, 4.9999f, 3}, (const float[]){1, 0, 0}, (const float[]){0, 0, 1}, 2); /* on the ceiling */
    paint(f, lamp, 8, LAMP);
    search(f, 2);
    expect(f, room, 12, VIT_SIDE_DARK_FRONT);
    expect(f, box, 6 * 32, VIT_SIDE_DARK_BACK);
    for (uint32_t i = lamp; i < lamp + 8; i++) /* one of the two: the one against the ceiling */
        assert_true(f->flags[i] == VIT_SIDE_DARK_FRONT || f->flags[i] == VIT_SIDE_DARK_BACK);
    drop(f);
}

static void the_sky_lights_what_is_open_to_it(void **state) {
    (void)state;
    fixture *f = make();
    const uint32_t closed = add_box(f, (const float[]){-1, 0, -1}, (const float[]){1, 2, 1}, 2), open = f->m.triangles;
    add_plate(f, (const float[]){2, 0, 2}, (const float[]){0, 0, 2}, (const float[]){2, 0, 0}, 2);
    f->sky = true;
    f->m.lo[0] = f->m.lo[2] = -1;
    f->m.hi[0] = f->m.hi[2] = 4;
    f->m.hi[1] = 2;
    search(f, 2);
    expect(f, closed, open - closed, VIT_SIDE_DARK_BACK);
    expect(f, open, 8, 0);
    drop(f);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_inside_of_a_closed_box_is_dark_and_its_outside_lit),
        cmocka_unit_test(light_finds_its_way_through_a_hole),
        cmocka_unit_test(faces_that_touch_are_dark_on_both_sides),
        cmocka_unit_test(no_small_triangle_is_darkened_by_bad_luck),
        cmocka_unit_test(specks_that_see_the_light_alone_are_lit),
        cmocka_unit_test(specks_that_see_something_lit_in_a_corner_of_their_view_are_lit),
        cmocka_unit_test(the_inside_of_a_sharp_wedge_is_dark),
        cmocka_unit_test(light_passes_the_holes_of_a_cut_out),
        cmocka_unit_test(a_room_that_the_light_visits_for_one_frame_is_lit),
        cmocka_unit_test(a_spot_light_lights_only_its_cone),
        cmocka_unit_test(insides_of_bodies_cost_few_rays),
        cmocka_unit_test(a_dim_room_is_lit_and_a_dimmer_one_dark),
        cmocka_unit_test(a_dim_room_that_fills_a_frame_is_lit),
        cmocka_unit_test(without_light_nothing_is_flagged),
        cmocka_unit_test(one_thread_and_two_flag_the_same_sides),
        cmocka_unit_test(light_goes_the_mean_chord_of_a_cube),
        cmocka_unit_test(light_that_leaves_the_scene_goes_no_way),
        cmocka_unit_test(the_automatic_radius_follows_the_way_of_light_within_bounds),
        cmocka_unit_test(light_gets_into_glass),
        cmocka_unit_test(light_passes_a_window),
        cmocka_unit_test(mirrors_hand_light_on),
        cmocka_unit_test(area_lights_light),
        cmocka_unit_test(the_sky_lights_what_is_open_to_it),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
