/* Photons baked with Embree against the same photons traced by kernels/photons.cl: on a room with everything in it that either
 * side treats, each slot must hold the same photon. Hits may differ by rounding where a ray meets an edge, and the path from
 * there on with them, so a few may differ. */
#include "photon_room.h"
#include "kernel_lab.h"
#include "zones.h"

/* The kernel with its frame number fixed: the laboratory passes buffers only. */
static const char frame_zero[] =
    "kernel void photon_paths_of_frame_0(RAY_SCENE_PARAMETERS, global const vit_light *lights, global const uint *sides,\n"
    "                                    global const uint *cells, global vit_photon *photons,\n"
    "                                    volatile global uint *counters)\n"
    "{\n"
    "    photon_paths(RAY_SCENE, lights, 0u, sides, cells, photons, counters, 0);\n"
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
                     VIT_BIT(LIGHTS) | VIT_BIT(SPOT) | VIT_BIT(RANGE) | VIT_BIT(TEXTURES) |
                         VIT_BIT(CUTOUT) | VIT_BIT(PHOTONS) | VIT_BIT(TRACED) | r->in.effects,
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

/* effects: a texture filter, SEQUENCE, ZONES. */
static void compare(uint64_t effects) {
    room *r = furnished_room();
    cells c = some_cells(r);
    r->in.effects = effects;
    r->in.sequence = (effects & VIT_BIT(SEQUENCE)) != 0;
    r->in.cells = effects & VIT_BIT(ZONES) ? &c : NULL;
    const uint32_t paths = r->lights[0].paths, stored = r->in.bounces - 1;
    uint32_t count, alike = 0, same = 0, zones = 0;
    vit_photon *baked = room_bake(r, 2, &count), *traced = kernel_photons(r, &c, 2 * paths);
    if (r->in.cells)
        zones_assign(&c, baked, count);
    double watts = 0.0, expected = 0.0;
    assert_int_equal(count, 2 * paths * stored);
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t light = i / (paths * stored), bounce = i / paths % stored, path = light * paths + i % paths;
        const vit_photon *p = &baked[i], *q = &traced[bounce * 2 * paths + path];
        double distance = 0.0;
        for (int k = 0; k < 3; k++) {
            distance = fmax(distance, fabs((double)p->position[k] - (double)q->position[k]));
            watts += room_watts(r, p, k);
            expected += room_watts(r, q, k);
        }
        zones |= p->zone;
        same += memcmp(p, q, sizeof *p) == 0;
        alike += distance < 2e-3 && q->radius2 == p->radius2;
    }
    print_message("%u of %u slots alike, %u to the bit; power %.6f of the kernel's\n", alike, count, same, watts / expected);
    assert_true(alike >= 0.99 * count);
    assert_true(fabs(watts / expected - 1.0) < 1e-3);
    assert_true(same >= 0.9 * count);
    assert_int_equal(zones, r->in.cells ? ~0u : 0u);
    cells_free(&c);
    free(traced);
    free(baked);
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

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(still_lights_have_the_photons_that_the_kernel_gives_moving_ones),
        cmocka_unit_test(so_they_do_with_other_texture_filters),
        cmocka_unit_test(so_they_do_with_zones_and_the_bounce_sequence),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
