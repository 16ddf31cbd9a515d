/* Photons baked with Embree against the same photons traced by kernels/photons.cl: on rooms with everything in them that either
 * side treats, each slot must hold the same photon, to the bit: what a photon does stands in both languages, and Embree only
 * proposes what a ray may hit (bake/geometry/triangle_rays.c). Likeness is counted too, since it says by how much two codes
 * part. */
#include "photon_room.h"
#include "kernel_lab.h"
#include "zones/zones.h"

/* The kernel with its frame number fixed: the laboratory passes buffers only. */
static const char frame_zero[] =
    "kernel void photon_paths_of_frame_0(RAY_SCENE_PARAMETERS, global const vit_light *lights, global const uint *sides,\n"
    "                                    global const uint *cells, global vit_photon *photons,\n"
    "                                    volatile global uint *counters)\n"
    "{\n"
    "    photon_paths(RAY_SCENE, 0, lights, 0u, sides, cells, photons, counters, 0);\n"
    "}\n";

/* The lights of `r` as moving ones, traced by kernels/photons.cl: all slots, all lights side by side. */
static vit_photon *kernel_photons(const room *r, const cells *c, uint32_t paths) {
    const size_t size = (size_t)paths * (r->in.bounces - 1) * sizeof(vit_photon);
    const vit_scene s = {.triangles = r->m.triangles,
                         .nodes = r->b.node_count,
                         .materials = ROOM_MATERIALS,
                         .lights = r->in.light_count,
                         .paths = paths,
                         .bounces = r->in.bounces,
                         .radius = r->in.radius,
                         .ray_offset = r->in.ray_offset,
                         .box_pad = r->in.box_pad};
    vit_light lights[ROOM_LIGHTS];
    for (uint32_t i = 0, first = 0; i < r->in.light_count; first += r->lights[i++].paths) {
        lights[i] = r->lights[i].light;
        lights[i].path_first = first;
        lights[i].path_count = r->lights[i].paths;
    }
    lab l = lab_open(1,
                     VIT_BIT(LIGHTS) | VIT_BIT(SPOT) | VIT_BIT(RANGE) | VIT_BIT(TEXTURES) | VIT_BIT(CUTOUT) |
                         VIT_BIT(INDIRECT) | VIT_BIT(PHOTONS) | VIT_BIT(TRACED) | r->in.effects,
                     frame_zero);
    const cl_mem arguments[] = {lab_buffer(&l, &s, sizeof s),
                                lab_buffer(&l, r->g.triangles, r->m.triangles * sizeof *r->g.triangles),
                                lab_buffer(&l, r->g.attributes, r->m.triangles * sizeof *r->g.attributes),
                                lab_buffer(&l, r->materials, sizeof r->materials),
                                lab_buffer(&l, r->a.textures, r->a.texture_count * sizeof *r->a.textures),
                                lab_buffer(&l, r->a.mips, r->a.mip_count * sizeof *r->a.mips),
                                lab_buffer(&l, r->a.texels, r->a.texel_count * sizeof *r->a.texels),
                                lab_buffer(&l, r->b.nodes, r->b.node_count * sizeof *r->b.nodes),
                                lab_buffer(&l, lights, sizeof lights),
                                lab_buffer(&l, c->sides, 2 * r->m.triangles * sizeof *c->sides),
                                lab_buffer(&l, c->cells, c->count * sizeof *c->cells),
                                lab_buffer(&l, NULL, size),
                                lab_buffer(&l, NULL, VIT_COUNTER_COUNT * sizeof(cl_uint))};
    enum { ARGUMENTS = sizeof arguments / sizeof arguments[0] };
    vit_photon *photons = malloc(size);
    assert_non_null(photons);
    lab_run(&l, "photon_paths_of_frame_0", paths, arguments, ARGUMENTS);
    lab_read(&l, arguments[11], photons, size);
    for (int i = 0; i < ARGUMENTS; i++)
        clReleaseMemObject(arguments[i]);
    lab_close(&l);
    return photons;
}

/* A room with a tilted mirrored texture, a cut-out, a spot light and a point light, each with a range; no path ends early. */
static room *furnished_room(void) {
    room *r = room_closed(0.7f);
    room_texture(r, WALL_FLOOR, 0, 250, 255, 90, 255);
    r->model_materials[WALL_FLOOR].wrap_u = VIT_WRAP_MIRROR;
    room_texture(r, WALLS, 1, 255, 255, 120, 0);
    r->model_materials[WALLS].wrap_u = VIT_WRAP_CLAMP;
    r->model_materials[WALLS].cutoff = 0.5f;
    room_quad(r, (const float[]){-0.7f, -0.2f, 0.6f}, (const float[]){1.3f, 0.2f, 0.1f}, (const float[]){0.1f, 0.3f, -1.2f},
              WALLS);
    room_quad(r, (const float[]){-0.5f, -0.9f, 0.1f}, (const float[]){0.4f, 0.1f, 0.2f}, (const float[]){0.0f, 0.5f, -0.3f},
              WALL_FLOOR);
    for (uint32_t i = 0; i < 2 * r->m.vertices; i++)
        r->m.uv[i] = 2.7f * r->m.uv[i] - 1.2f;
    r->lights[0] = room_point_light(0.1f, 0.8f, -0.1f, 4096);
    r->lights[0].light.inv_range2 = 0.01f;
    r->lights[1] = room_point_light(0.5f, 0.9f, 0.3f, 4096);
    r->lights[1].light.kind = VIT_LIGHT_SPOT;
    r->lights[1].light.cos_outer = 0.7f;
    r->lights[1].light.spot_scale = 4.0f;
    r->lights[1].light.spot_offset = -2.75f;
    r->lights[1].light.inv_range2 = 0.04f;
    r->lights[1].light.falloff = VIT_FALLOFF_WINDOW;
    room_finish(r, 2, 5);
    return r;
}

static float a_tenth(void *user, uint32_t side) {
    (void)user;
    (void)side;
    return 0.1f;
}

/* Any zones will do: neighbouring cells have different ones. */
static cells some_cells(const room *r) {
    cells c;
    vit_text why = {""};
    assert_int_equal(cells_divide(&r->g, r->m.triangles, a_tenth, NULL, &c, &why), VIT_OK);
    for (uint32_t i = 0; i < c.count; i++)
        c.cells[i].word = (i * 7u + i / 32u) << 27;
    return c;
}

typedef struct likeness {
    uint32_t stored, alike, same; /* by the kernel; baked ones that lie where they do; and are so to the bit */
    double watts, expected;
    uint32_t zones;
} likeness;

static bool is_alike(const vit_photon *p, const vit_photon *q) {
    double distance = 0.0;
    for (int k = 0; k < 3; k++)
        distance = fmax(distance, fabs((double)p->position[k] - (double)q->position[k]));
    return distance < 2e-3 && fabsf(q->radius2 / p->radius2 - 1.0f) < 1e-3f;
}

/* Baked photons keep the order of slots but leave the empty ones out: where the two differ, a few are looked ahead. */
static likeness compare_photons(const room *r, const vit_photon *baked, uint32_t count, const vit_photon *traced,
                                uint32_t paths) {
    enum { AHEAD = 8 };
    const uint32_t stored = r->in.bounces - 1, each = paths / r->in.light_count;
    likeness l = {0};
    for (uint32_t i = 0; i < count; i++) {
        l.zones |= baked[i].zone;
        for (int k = 0; k < 3; k++)
            l.watts += room_watts(baked + i, k);
    }
    for (uint32_t i = 0, at = 0; i < paths * stored; i++) {
        const uint32_t light = i / (each * stored), bounce = i / each % stored, path = light * each + i % each;
        const vit_photon *q = &traced[bounce * paths + path];
        if (!(q->radius2 > 0.0f))
            continue;
        l.stored++;
        for (int k = 0; k < 3; k++)
            l.expected += room_watts(q, k);
        for (uint32_t k = at; k < at + AHEAD && k < count; k++)
            if (is_alike(baked + k, q)) {
                l.alike++;
                l.same += memcmp(baked + k, q, sizeof *q) == 0;
                at = k + 1;
                break;
            }
    }
    print_message("%u baked, %u traced, %u alike, %u to the bit; power %.6f of the kernel's\n", count, l.stored, l.alike,
                  l.same, l.watts / l.expected);
    return l;
}

/* effects: of the room, and a texture filter, SEQUENCE, ZONES. */
static likeness compare_room(room *r, uint64_t effects) {
    cells c = some_cells(r);
    r->in.effects = effects;
    r->in.sequence = (effects & VIT_BIT(SEQUENCE)) != 0;
    r->in.cells = effects & VIT_BIT(ZONES) ? &c : NULL;
    uint32_t count, paths = 0;
    for (uint32_t i = 0; i < r->in.light_count; i++)
        paths += r->lights[i].paths;
    vit_photon *baked = room_bake(r, 2, &count), *traced = kernel_photons(r, &c, paths);
    if (r->in.cells)
        zones_assign(&c, baked, count);
    const likeness l = compare_photons(r, baked, count, traced, paths);
    assert_int_equal(count, l.stored);
    assert_int_equal(l.alike, l.stored);
    assert_int_equal(l.same, l.stored);
    assert_int_equal(l.zones, r->in.cells ? ~0u : 0u);
    cells_free(&c);
    free(traced);
    free(baked);
    return l;
}

static void compare(uint64_t effects) {
    room *r = furnished_room();
    const likeness l = compare_room(r, effects);
    assert_int_equal(l.stored, 2 * r->lights[0].paths * (r->in.bounces - 1)); /* no path ends early */
    room_drop(r);
}

static void still_lights_have_the_photons_that_the_kernel_gives_moving_ones(void **state) {
    (void)state;
    compare(0);
}

static void so_they_do_with_other_texture_filters(void **state) {
    (void)state;
    compare(VIT_BIT(NEAREST));
    compare(VIT_BIT(TRILINEAR));
}

static void so_they_do_with_zones_and_the_bounce_sequence(void **state) {
    (void)state;
    compare(VIT_BIT(SEQUENCE));
    compare(VIT_BIT(ZONES));
    compare(VIT_BIT(ZONES) | VIT_BIT(SEQUENCE));
}

static void so_they_do_in_a_gap(void **state) {
    (void)state;
    room *r = room_closed(0.5f);
    room_quad(r, (const float[]){-0.8f, 0.97f, 0.8f}, (const float[]){1.6f, 0, 0}, (const float[]){0, 0, -1.6f}, WALL_FLOOR);
    room_texture(r, WALL_BACK, 0, 250, 255, 90, 255);
    r->lights[0] = room_point_light(0.01f, 0.985f, 0.02f, 8192);
    room_finish(r, 1, 5);
    uint32_t count, narrow = 0;
    (void)compare_room(r, 0);
    vit_photon *baked = room_bake(r, 1, &count);
    for (uint32_t i = 0; i < count; i++)
        narrow += baked[i].radius2 < 0.01f * r->in.radius * r->in.radius;
    assert_true(narrow > count / 4); /* or there was nothing to compare */
    free(baked);
    room_drop(r);
}

enum { GLASS_BALL = WALLS, PANE };

/* A ball of green glass with smooth normals and a pane above a glossy floor, a mirror at the side, a lamp and a beam of
 * parallel light. */
static room *shining_room(void) {
    room *r = room_closed(0.5f);
    room_ball(r, (const float[]){0.1f, -0.3f, 0.2f}, 0.45f, GLASS_BALL);
    room_quad(r, (const float[]){-0.9f, 0.3f, -0.9f}, (const float[]){0.8f, 0.0f, 0.1f}, (const float[]){0.1f, 0.1f, 0.8f},
              PANE);
    room_texture(r, WALL_BACK, 0, 250, 255, 90, 255);
    r->lights[0] = room_point_light(0.1f, 0.8f, -0.1f, 8192);
    r->lights[1] = (photons_light){.light = {.position = {0.2f, 0.8f, 0.1f},
                                             .kind = VIT_LIGHT_DIRECTIONAL,
                                             .direction = {-0.36f, -0.8f, 0.48f},
                                             .cos_outer = 1.0f,
                                             .intensity = {4.0f, 3.0f, 2.0f},
                                             .spot_scale = 0.15f},
                                   .paths = 8192};
    room_finish(r, 2, 7);
    r->materials[WALL_LEFT] =
        (vit_material){.texture = VIT_NONE, .kind = VIT_MIRROR, .specular = {0.9f, 0.8f, 0.95f}, .exponent = 1, .ior = 1};
    r->materials[GLASS_BALL] = (vit_material){.texture = VIT_NONE,
                                              .kind = VIT_GLASS,
                                              .specular = {1.0f, 0.98f, 0.96f},
                                              .absorption = {3.0f, 0.2f, 2.0f},
                                              .exponent = 1,
                                              .ior = 1.5f};
    r->materials[PANE] =
        (vit_material){.texture = VIT_NONE, .kind = VIT_THIN_GLASS, .specular = {0.9f, 0.9f, 1.0f}, .exponent = 1, .ior = 1.5f};
    r->materials[WALL_FLOOR].specular[0] = 0.4f;
    r->materials[WALL_FLOOR].specular[1] = 0.3f;
    r->materials[WALL_FLOOR].exponent = 50.0f;
    return r;
}

static void so_they_do_with_mirrors_glass_gloss_and_parallel_light(void **state) {
    (void)state;
    const uint64_t shine = VIT_BIT(SMOOTH) | VIT_BIT(SPECULAR) | VIT_BIT(MIRROR) | VIT_BIT(GLASS) | VIT_BIT(DIRECTIONAL);
    room *r = shining_room();
    const likeness ends = compare_room(r, shine), on = compare_room(r, shine | VIT_BIT(CAUSTICS));
    assert_true(on.stored > 1.5 * ends.stored); /* without caustics many paths end at mirrors and glass */
    (void)compare_room(r, shine | VIT_BIT(CAUSTICS) | VIT_BIT(SEQUENCE) | VIT_BIT(ZONES));
    room_drop(r);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(still_lights_have_the_photons_that_the_kernel_gives_moving_ones),
        cmocka_unit_test(so_they_do_with_other_texture_filters),
        cmocka_unit_test(so_they_do_with_zones_and_the_bounce_sequence),
        cmocka_unit_test(so_they_do_in_a_gap),
        cmocka_unit_test(so_they_do_with_mirrors_glass_gloss_and_parallel_light),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
