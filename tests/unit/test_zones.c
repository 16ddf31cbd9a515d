/* Zones and effective areas, in rooms whose answers can be written down: a plane, its edge, a convex and an inner edge, a box
 * on a floor, two rooms on either side of a thin wall. Light and camera reach everything, so that every cell is baked.
 *
 * The kernel is 1 - d^2 / r^2 over a sphere of radius r. In units of its integral over a plane, pi r^2 / 2: the part of a plane
 * on the near side of a line at distance h r is half_plane(h), and half a plane that stands at distance h r across it is (1 -
 * h^2)^2 / 2. */
#include "photon_room.h"
#include "dark_sides/dark_sides.h"
#include "zones/zones.h"

#include <stdio.h>

enum { VIEWS = 6, PIXELS = 64, MOST_FRAMES = 2 * VIEWS };
#define RADIUS 0.25f

typedef struct fixture {
    room *r;
    vit_camera cameras[MOST_FRAMES];
    vit_light lights[MOST_FRAMES * ROOM_LIGHTS]; /* the same in all frames */
    bool gives[ROOM_LIGHTS];
    tracks t;
    vit_scene scene;
    zones_input in;
    cells c;
    zones_found found;
} fixture;

/* Six square views with a field of view of 90 degrees see everything about a point. */
static void add_views(fixture *f, float x, float y, float z) {
    static const float axes[VIEWS][3] = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
    for (int i = 0; i < VIEWS; i++) {
        vit_camera *c = f->cameras + f->scene.frames++;
        c->eye[0] = x;
        c->eye[1] = y;
        c->eye[2] = z;
        for (int k = 0; k < 3; k++) {
            const float right = axes[i][(k + 1) % 3], up = axes[i][(k + 2) % 3];
            c->right[k] = right * 2.0f / PIXELS;
            c->down[k] = up * 2.0f / PIXELS;
            c->corner[k] = axes[i][k] - right - up;
            c->forward[k] = axes[i][k];
        }
    }
}

/* Everything that is baked before zones. `r` is the fixture's from now on. */
static void begin(fixture *f, room *r, uint32_t lights) {
    vit_text why = {""};
    dark_sides found;
    *f = (fixture){.r = r};
    room_finish(r, lights, 3);
    for (uint32_t i = 0; i < MOST_FRAMES * lights; i++)
        f->lights[i] = r->lights[i % lights].light;
    for (uint32_t i = 0; i < lights; i++)
        f->gives[i] = true;
    f->t = (tracks){.cameras = f->cameras, .lights = f->lights, .light_count = lights};
    assert_int_equal(dark_sides_find(&(const dark_sides_input){.model = &r->m, .tracks = &f->t, .frames = 1, .threads = 2},
                                     &r->g, &found, &why),
                     VIT_OK);
    f->scene = (vit_scene){.width = PIXELS,
                           .height = PIXELS,
                           .bounces = r->in.bounces,
                           .radius = RADIUS,
                           .box_pad = r->in.box_pad,
                           .ray_offset = r->in.ray_offset,
                           .lights = lights};
    f->in = (zones_input){.geometry = &r->g,
                          .triangles = r->m.triangles,
                          .materials = r->materials,
                          .atlas = &r->a,
                          .tracks = &f->t,
                          .gives_photons = f->gives,
                          .scene = &f->scene,
                          .zones = true,
                          .areas = true,
                          .threads = 2};
}

static void bake(fixture *f) {
    vit_text why = {""};
    cells_free(&f->c);
    if (zones_bake(&f->in, &f->c, &f->found, &why) != VIT_OK)
        fail_msg("zones_bake: %s", why.text);
}

static void drop(fixture *f) {
    cells_free(&f->c);
    room_drop(f->r);
}

/* A side and weights there. */
typedef struct place {
    uint32_t side;
    float b1, b2;
} place;

/* The place at p of the side that faces n. */
static place find(const fixture *f, vec3 p, vec3 n) {
    for (uint32_t side = 0; side < 2 * f->r->m.triangles; side++) {
        const vit_triangle *t = f->r->g.triangles + side / 2;
        const vec3 v0 = vec3_load(t->v0), u = vec3_sub(vec3_load(t->v1), v0), v = vec3_sub(vec3_load(t->v2), v0),
                   o = vec3_sub(p, v0);
        if (fabsf(vec3_dot(o, side_face(&f->r->g, side))) > 1e-5f || vec3_dot(n, side_face(&f->r->g, side)) < 0.99f)
            continue;
        const float uu = vec3_dot(u, u), uv = vec3_dot(u, v), vv = vec3_dot(v, v), ou = vec3_dot(o, u), ov = vec3_dot(o, v);
        const float d = uu * vv - uv * uv, b1 = (ou * vv - ov * uv) / d, b2 = (ov * uu - ou * uv) / d;
        if (b1 >= -1e-4f && b2 >= -1e-4f && b1 + b2 <= 1.0001f)
            return (place){side, b1, b2};
    }
    fail_msg("nothing at %g %g %g", (double)p.x, (double)p.y, (double)p.z);
    return (place){0, 0, 0};
}

static const vec3 up = {0, 1, 0}, right = {1, 0, 0};

/* Effective area at p, as the kernels compute it. */
static double area(const fixture *f, vec3 p, vec3 n) {
    const place at = find(f, p, n);
    const uint32_t cell = cells_at(&f->c, at.side, at.b1, at.b2), word = f->c.cells[cell].word;
    const cell_corners k = cells_corners(&f->c, cell);
    const double ux = (double)(k.b1[1] - k.b1[0]), uy = (double)(k.b2[1] - k.b2[0]), vx = (double)(k.b1[2] - k.b1[0]),
                 vy = (double)(k.b2[2] - k.b2[0]), px = (double)(at.b1 - k.b1[0]), py = (double)(at.b2 - k.b2[0]);
    const double d = ux * vy - uy * vx, w1 = (px * vy - py * vx) / d, w2 = (ux * py - uy * px) / d;
    const double w[3] = {1.0 - w1 - w2, w1, w2};
    double sum = 0.0;
    for (int i = 0; i < 3; i++)
        sum += w[i] * pow(word >> 9 * i & 511u, 2.0) * (double)VIT_CELL_AREA_SCALE;
    return sum;
}

/* Marginal of the kernel along one axis of the plane: 8 / (3 pi) (1 - x^2)^(3/2). */
static double half_plane(double h) {
    enum { STEPS = 1000 };
    double sum = 0.0;
    for (int i = 0; i < STEPS; i++)
        sum += pow(1.0 - pow(h * (i + 0.5) / STEPS, 2.0), 1.5) / STEPS;
    return 0.5 + h * sum * 8.0 / (3.0 * 3.14159265358979);
}

static double half_across(double h) {
    return 0.5 * pow(1.0 - h * h, 2.0);
}

/* Along a line, since the area points are random: the mean must be right within 2 %, each within 6 %. */
static void expect_area(const fixture *f, const char *what, vec3 p, vec3 along, vec3 n, double wanted) {
    enum { PLACES = 9 };
    double sum = 0.0;
    for (int i = 0; i < PLACES; i++) {
        const double found = area(f, vec3_along(p, along, 0.05f * (float)(i - PLACES / 2)), n);
        if (fabs(found - wanted) > 0.06 * wanted + 0.01)
            fail_msg("%s: %.4f, not %.4f", what, found, wanted);
        sum += found;
    }
    print_message("  %-40s %.4f, expected %.4f\n", what, sum / PLACES, wanted);
    assert_true(fabs(sum / PLACES - wanted) < 0.02 * wanted + 0.003);
}

static room *lit_room(void) {
    room *r = room_closed(0.6f);
    r->lights[0] = room_point_light(0.3f, 0.5f, 0.4f, 1024);
    return r;
}

static void a_plane_has_the_whole_kernel_and_an_inner_edge_that_of_both_planes(void **state) {
    (void)state;
    fixture f;
    begin(&f, lit_room(), 1);
    add_views(&f, 0.05f, 0.02f, -0.03f);
    bake(&f);
    expect_area(&f, "middle of the floor", (vec3){0, -1, 0}, right, up, 1.0);
    for (int i = 0; i <= 4; i++) {
        char what[64];
        const float h = 0.25f * (float)i;
        (void)snprintf(what, sizeof what, "floor, %.2f radii from a wall", (double)h);
        expect_area(&f, what, (vec3){0, -1, h * RADIUS - 1.0f}, right, up, half_plane((double)h) + half_across((double)h));
    }
    f.in.zones = false; /* of even light, half of the photons on a wall arrive from above */
    bake(&f);
    expect_area(&f, "without zones, beside a wall", (vec3){0, -1, -1}, right, up, 0.5 + 0.25);
    expect_area(&f, "half a radius from it", (vec3){0, -1, 0.5f * RADIUS - 1.0f}, right, up,
                half_plane(0.5) + 0.5 * half_across(0.5));
    drop(&f);
}

/* A plate in the air, both of whose sides are lit. */
static void at_the_edge_of_a_plate_half_of_the_kernel_is_left_and_at_its_corner_a_quarter(void **state) {
    (void)state;
    fixture f;
    room *r = lit_room();
    room_quad(r, (const float[]){-0.5f, 0, 0.5f}, (const float[]){1, 0, 0}, (const float[]){0, 0, -1}, WALL_FLOOR);
    begin(&f, r, 1);
    add_views(&f, 0.05f, 0.4f, -0.03f);
    add_views(&f, 0.05f, -0.4f, -0.03f);
    bake(&f);
    expect_area(&f, "a plate's middle", (vec3){0, 0, 0}, right, up, 1.0);
    expect_area(&f, "its edge", (vec3){0, 0, 0.5f}, right, up, 0.5);
    expect_area(&f, "its edge, from below", (vec3){0, 0, 0.5f}, right, (vec3){0, -1, 0}, 0.5);
    expect_area(&f, "half a radius from it", (vec3){0, 0, 0.5f - 0.5f * RADIUS}, right, up, half_plane(0.5));
    const double corner = area(&f, (vec3){0.5f, 0, 0.5f}, up);
    print_message("  %-40s %.4f, expected %.4f\n", "its corner", corner, 0.25);
    assert_true(fabs(corner - 0.25) < 0.02);
    drop(&f);
}

/* A plate in the air, and what else lies in its place: x, z of the corner, of u and of v, height, material. */
typedef struct sheet {
    float corner[2], u[2], v[2], y;
    uint32_t material;
} sheet;

static const sheet plate = {{-0.5f, 0.5f}, {1, 0}, {0, -1}, 0, WALL_FLOOR};

static void add_sheet(room *r, const sheet *s) {
    room_quad(r, (const float[]){s->corner[0], s->y, s->corner[1]}, (const float[]){s->u[0], 0, s->u[1]},
              (const float[]){s->v[0], 0, s->v[1]}, s->material);
}

/* However often a place's surface is in the file, photons land on it once. */
static void faces_in_one_place_are_one_surface(void **state) {
    (void)state;
    static const struct {
        const char *what;
        sheet more[2];
    } rows[] = {
        {"twice, in two materials", {{{-0.5f, 0.5f}, {1, 0}, {0, -1}, 0, WALL_BACK}}},
        {"with its back up", {{{-0.5f, 0.5f}, {0, -1}, {1, 0}, 0, WALL_FLOOR}}},
        {"cut along the other diagonal", {{{0.5f, 0.5f}, {0, -1}, {-1, 0}, 0, WALL_FLOOR}}},
        {"by a larger one", {{{-0.5f, 0.5f}, {1.03f, 0}, {0, -1.02f}, 0, WALL_FLOOR}}},
        {"three times", {{{-0.5f, 0.5f}, {0, -1}, {1, 0}, 0, WALL_FLOOR}, {{-0.5f, 0.5f}, {1, 0}, {0, -1}, 0, WALL_FLOOR}}},
        {"nearer than rays keep", {{{-0.5f, 0.5f}, {1, 0}, {0, -1}, 5e-6f, WALL_FLOOR}}},
        {"slanting pieces over it",
         {{{-0.41f, 0}, {0.41f, 0.43f}, {0.43f, -0.41f}, 0, WALL_BACK},
          {{-0.2f, 0.2f}, {0.3f, 0.1f}, {0.1f, -0.3f}, 0, WALL_FLOOR}}},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        fixture f;
        room *r = lit_room();
        if (i % 2 == 0) /* the plate is before or behind the others in the file */
            add_sheet(r, &plate);
        for (int k = 0; k < 2 && rows[i].more[k].u[0] + rows[i].more[k].v[0] != 0.0f; k++)
            add_sheet(r, rows[i].more + k);
        if (i % 2)
            add_sheet(r, &plate);
        begin(&f, r, 1);
        add_views(&f, 0.05f, 0.4f, -0.03f);
        f.in.zones = i != 0;
        bake(&f);
        expect_area(&f, rows[i].what, (vec3){0, rows[i].more[0].y, 0}, right, up, 1.0);
        expect_area(&f, "its edge", (vec3){0, rows[i].more[0].y, 0.5f}, right, up, 0.5);
        drop(&f);
    }
}

/* A sheet on the floor, and one whose half is cut out. */
static void what_lies_on_the_floor_hides_it_but_not_where_it_is_cut_out(void **state) {
    (void)state;
    fixture f;
    room *r = lit_room();
    const sheet carpet = {{-0.5f, 0.5f}, {1, 0}, {0, -1}, -1, WALLS};
    add_sheet(r, &carpet);
    room_texture(r, WALLS, 0, 200, 0, 200, 255);
    r->model_materials[WALLS].cutoff = 0.5f;
    begin(&f, r, 1);
    add_views(&f, 0.05f, 0.02f, -0.03f);
    bake(&f);
    expect_area(&f, "a carpet with a hole", (vec3){0, -1, 0}, right, up, 1.0);
    expect_area(&f, "its edge", (vec3){0, -1, 0.5f}, right, up, 1.0);
    drop(&f);
}

static void add_box(room *r) { /* stands on the floor, open below; 1 m wide and deep, 0.6 m high */
    room_quad(r, (const float[]){-0.5f, -0.4f, 0.5f}, (const float[]){1, 0, 0}, (const float[]){0, 0, -1}, WALL_FLOOR);
    room_quad(r, (const float[]){-0.5f, -1, 0.5f}, (const float[]){1, 0, 0}, (const float[]){0, 0.6f, 0}, WALL_FLOOR);
    room_quad(r, (const float[]){0.5f, -1, 0.5f}, (const float[]){0, 0, -1}, (const float[]){0, 0.6f, 0}, WALL_FLOOR);
    room_quad(r, (const float[]){0.5f, -1, -0.5f}, (const float[]){-1, 0, 0}, (const float[]){0, 0.6f, 0}, WALL_FLOOR);
    room_quad(r, (const float[]){-0.5f, -1, -0.5f}, (const float[]){0, 0, 1}, (const float[]){0, 0.6f, 0}, WALL_FLOOR);
}

static void a_box_hides_the_floor_under_it_and_its_sides_from_each_other(void **state) {
    (void)state;
    fixture f;
    room *r = lit_room();
    add_box(r);
    begin(&f, r, 1);
    add_views(&f, 0.3f, -0.1f, 0.85f);
    bake(&f);
    expect_area(&f, "a box's top", (vec3){0, -0.4f, 0}, right, up, 1.0);
    expect_area(&f, "the top's edge", (vec3){0, -0.4f, 0.5f}, right, up, 0.5);
    expect_area(&f, "the side's upper edge", (vec3){0, -0.4f, 0.5f}, right, (vec3){0, 0, 1}, 0.5);
    expect_area(&f, "the floor where the box stands on it", (vec3){0, -1, 0.5f}, right, up, 1.0);
    expect_area(&f, "half a radius from the box", (vec3){0, -1, 0.5f + 0.5f * RADIUS}, right, up,
                half_plane(0.5) + half_across(0.5));
    drop(&f);
}

/* Two rooms side by side: x < -0.01 and x > 0.01. */
static void begin_two_rooms(fixture *f) {
    room *r = room_closed(0.6f);
    room_quad(r, (const float[]){-0.01f, -1, -1}, (const float[]){0, 2, 0}, (const float[]){0, 0, 2}, WALLS);
    room_quad(r, (const float[]){0.01f, -1, 1}, (const float[]){0, 2, 0}, (const float[]){0, 0, -2}, WALLS);
    r->lights[0] = room_point_light(-0.5f, 0.3f, 0.2f, 1024);
    r->lights[1] = room_point_light(0.4f, 0.1f, -0.2f, 1024);
    for (int k = 0; k < 3; k++)
        r->lights[1].light.intensity[k] *= 0.01f;
    begin(f, r, 2);
    add_views(f, -0.5f, 0.02f, -0.03f);
    add_views(f, 0.5f, 0.02f, -0.03f);
}

/* -1 or 1; 0: neither. The wall's own pieces of floor and ceiling, and what lies half under it, do not count. */
static int room_of(vec3 p, vec3 n) {
    p = vec3_along(p, n, 1e-3f);
    if (fmaxf(fmaxf(fabsf(p.x), fabsf(p.y)), fabsf(p.z)) > 1.0f || fabsf(p.x) < 0.01f ||
        (fabsf(n.x) < 0.5f && fabsf(p.x) < 0.01f + RADIUS / 16))
        return 0;
    return p.x < 0.0f ? -1 : 1;
}

typedef struct near_cell {
    vec3 p;
    float area;
    int room;
    uint32_t accept, zone; /* bits */
} near_cell;

/* Cells within a radius of the wall. */
static near_cell *cells_by_the_wall(const fixture *f, uint32_t *count) {
    near_cell *found = malloc(f->c.count * sizeof *found);
    assert_non_null(found);
    *count = 0;
    for (uint32_t i = 0; i < f->c.count; i++) {
        const vec3 p = cells_center(&f->c, &f->r->g, i);
        const int where = room_of(p, side_face(&f->r->g, f->c.side_of[i]));
        if (where != 0 && fabsf(p.x) < RADIUS)
            found[(*count)++] =
                (near_cell){p, cells_area(&f->c, &f->r->g, i), where, f->c.cells[i].accept, 1u << (f->c.cells[i].word >> 27)};
    }
    return found;
}

typedef struct leak {
    double own, own_accepted, other, other_accepted; /* kernel weights of pairs of cells */
} leak;

static leak measure_leak(const fixture *f) {
    leak l = {0};
    uint32_t count;
    near_cell *all = cells_by_the_wall(f, &count);
    for (uint32_t i = 0; i < count; i += 37)
        for (uint32_t k = 0; k < count; k++) {
            const vec3 d = vec3_sub(all[k].p, all[i].p);
            const double weight = 1.0 - (double)(vec3_dot(d, d) / (RADIUS * RADIUS));
            if (weight <= 0.0)
                continue;
            const double w = weight * (double)all[k].area, accepted = all[i].accept & all[k].zone ? w : 0.0;
            *(all[k].room == all[i].room ? &l.own : &l.other) += w;
            *(all[k].room == all[i].room ? &l.own_accepted : &l.other_accepted) += accepted;
        }
    free(all);
    return l;
}

static void rooms_beside_a_thin_wall_do_not_accept_each_others_light(void **state) {
    (void)state;
    fixture f;
    begin_two_rooms(&f);
    for (int by_light = 0; by_light < 2; by_light++) {
        f.in.by_light = by_light;
        bake(&f);
        const leak l = measure_leak(&f);
        print_message("  through the wall %.3f %%, in the room %.1f %%; 32 zones miss %.2f %%\n",
                      100.0 * l.other_accepted / l.other, 100.0 * l.own_accepted / l.own, 100.0 * f.found.wrong);
        assert_true(l.other > 0.1 * l.own); /* or nothing was to be parted */
        assert_true(l.other_accepted < 0.005 * l.other);
        assert_true(l.own_accepted > 0.9 * l.own);
        assert_true(f.found.wrong < 0.02);
    }
    f.in.zones = false;
    bake(&f);
    const leak l = measure_leak(&f);
    assert_true(l.other_accepted == l.other);
    drop(&f);
}

/* A plate of triangles so small that only one in five has an area point: its light is that of the points all the same. */
static void tiny_triangles_are_lit_like_their_neighbours(void **state) {
    (void)state;
    enum { TILES = 24 };
    const float edge = 0.18f / TILES;
    fixture f;
    room *r = lit_room();
    for (int i = 0; i < TILES * TILES; i++)
        room_quad(r, (const float[]){(float)(i % TILES) * edge - 0.09f, 0, (float)(i / TILES) * edge},
                  (const float[]){edge, 0, 0}, (const float[]){0, 0, -edge}, WALL_FLOOR);
    begin(&f, r, 1);
    add_views(&f, 0.0f, 0.2f, 0.12f);
    f.in.by_light = true;
    bake(&f);
    uint32_t *on = malloc(f.c.count * sizeof *on), count = 0; /* cells of the plate's upper side */
    assert_non_null(on);
    for (uint32_t i = 0; i < f.c.count; i++)
        if (fabsf(cells_center(&f.c, &r->g, i).y) < 1e-5f && side_face(&r->g, f.c.side_of[i]).y > 0.5f)
            on[count++] = i;
    double all = 0.0, accepted = 0.0;
    for (uint32_t i = 0; i < count; i++)
        for (uint32_t k = 0; k < count; k++) {
            all += (double)cells_area(&f.c, &r->g, on[k]);
            accepted +=
                f.c.cells[on[i]].accept >> (f.c.cells[on[k]].word >> 27) & 1u ? (double)cells_area(&f.c, &r->g, on[k]) : 0.0;
        }
    free(on);
    print_message("  of the plate's light %.1f %% is accepted on it\n", 100.0 * accepted / all);
    assert_true(all > 0.0 && accepted > 0.95 * all);
    drop(&f);
}

static void what_the_path_never_sees_accepts_everything(void **state) {
    (void)state;
    fixture f;
    begin_two_rooms(&f);
    f.scene.frames = VIEWS; /* the left room alone */
    bake(&f);
    uint32_t count[2] = {0}, all[2] = {0};
    for (uint32_t i = 0; i < f.c.count; i++) {
        const int where = room_of(cells_center(&f.c, &f.r->g, i), side_face(&f.r->g, f.c.side_of[i]));
        if (where != 0) {
            count[where > 0]++;
            all[where > 0] += f.c.cells[i].accept == ~0u;
        }
    }
    assert_int_equal(all[1], count[1]);
    assert_true(all[0] < count[0] / 50);
    drop(&f);
}

static void without_zones_all_is_accepted_and_without_areas_all_are_1(void **state) {
    (void)state;
    fixture f;
    begin(&f, lit_room(), 1);
    add_views(&f, 0.05f, 0.02f, -0.03f);
    f.in.zones = f.in.areas = false;
    bake(&f);
    for (uint32_t i = 0; i < f.c.count; i++) {
        assert_int_equal(f.c.cells[i].accept, ~0u);
        for (int k = 0; k < 3; k++)
            assert_in_range(f.c.cells[i].word >> 9 * k & 511u, 255, 256); /* squares to 1 within 0.4 % */
    }
    drop(&f);
}

static void any_number_of_threads_bakes_the_same_bytes(void **state) {
    (void)state;
    static const unsigned threads[] = {1, 5};
    fixture f;
    begin_two_rooms(&f);
    f.in.by_light = true;
    cells first = {0};
    for (int i = 0; i < 2; i++) {
        f.in.threads = threads[i];
        bake(&f);
        if (i > 0) {
            assert_int_equal(f.c.count, first.count);
            assert_memory_equal(f.c.sides, first.sides, 2 * f.r->m.triangles * sizeof *first.sides);
            assert_memory_equal(f.c.cells, first.cells, first.count * sizeof *first.cells);
            continue;
        }
        first = f.c;
        f.c = (cells){0};
    }
    cells_free(&first);
    drop(&f);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_plane_has_the_whole_kernel_and_an_inner_edge_that_of_both_planes),
        cmocka_unit_test(at_the_edge_of_a_plate_half_of_the_kernel_is_left_and_at_its_corner_a_quarter),
        cmocka_unit_test(faces_in_one_place_are_one_surface),
        cmocka_unit_test(what_lies_on_the_floor_hides_it_but_not_where_it_is_cut_out),
        cmocka_unit_test(a_box_hides_the_floor_under_it_and_its_sides_from_each_other),
        cmocka_unit_test(rooms_beside_a_thin_wall_do_not_accept_each_others_light),
        cmocka_unit_test(tiny_triangles_are_lit_like_their_neighbours),
        cmocka_unit_test(what_the_path_never_sees_accepts_everything),
        cmocka_unit_test(without_zones_all_is_accepted_and_without_areas_all_are_1),
        cmocka_unit_test(any_number_of_threads_bakes_the_same_bytes),
    };
    return cmocka_run_group_tests_name("zones", tests, NULL, NULL);
}
