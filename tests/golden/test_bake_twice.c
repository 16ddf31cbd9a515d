/* Baking the same scene twice gives the same bytes, with any number of threads.
 *
 * Why this is hard: the baker's threads race for work, Embree builds its tree with all of them, and an uninitialised byte of a
 * record may be equal by luck. Strategy: whole files are compared, byte by byte, between bakes with one thread and with
 * several, of the baker and of the device that measures, on scenes that reach every stage: traced photons, photons of still
 * lights, textures with holes, sides that no light reaches, buckets. The first bytes that differ are named by their section. */
#include "test_packs.h"
#include "vitrine_pack.h"

static tool_run r;

static const char *section_of(const void *pack, size_t at) {
    static char text[32] = "the header";
    const vit_pack_entry *table = (const vit_pack_entry *)((const char *)pack + sizeof(vit_pack_header));
    for (int i = 0; i < VIT_SECTION_COUNT; i++)
        if (at >= table[i].offset && at < table[i].offset + table[i].size)
            (void)snprintf(text, sizeof text, "%.4s + %zu", table[i].code, at - (size_t)table[i].offset);
    return text;
}

static void assert_same_files(const char *a, const char *b, const char *line) {
    size_t size_a, size_b, at = 0;
    unsigned char *x = read_file(a, &size_a), *y = read_file(b, &size_b);
    assert_true(size_a > sizeof(vit_pack_header));
    while (at < size_a && at < size_b && x[at] == y[at])
        at++;
    if (at < size_a && at < size_b) /* the table differs wherever a section does: what counts comes after it */
        for (size_t i = VIT_PACK_ALIGN; i < size_a && i < size_b; i++)
            if (x[i] != y[i]) {
                at = i;
                break;
            }
    if (size_a != size_b || at != size_a)
        fail_msg("%s\nwrote %zu bytes, the first bake %zu; the first difference is in %s", line, size_b, size_a,
                 section_of(x, at < size_a ? at : size_a - 1));
    free(x);
    free(y);
}

/* OpenCL's device measures the same: asked where its compiler has not to make yet another program. */
enum { HOST_WAYS = 2, ALL_WAYS };

static void assert_bakes_alike(const char *input, const char *options, size_t count) {
    static const struct {
        const char *environment, *options;
    } ways[ALL_WAYS] = {{"", "--threads 1"}, {"", "--threads 3"}, {"POCL_DEVICES=basic", "--threads 2 --device 0"}};
    char path[2][128];
    test_packs_begin();
    for (size_t i = 0; i < count; i++) {
        (void)snprintf(path[i > 0], sizeof path[0], TEST_PACKS "/twice-%d.vit", i > 0);
        tool(&r, "%s " TOOL_BAKE " %s --quiet -o %s %s %s", ways[i].environment, input, path[i > 0], ways[i].options, options);
        tool_succeeds(&r);
        if (i > 0)
            assert_same_files(path[0], path[1], r.line);
    }
    (void)unlink(path[0]);
    (void)unlink(path[1]);
}

static void a_box_with_a_moving_light_bakes_to_the_same_bytes(void **state) {
    (void)state;
    assert_bakes_alike(TEST_SCENES "/cornell.cfg", "--indirect photons --size 160x120 --frames 3 --photons 5000", ALL_WAYS);
}

static void baked_light_of_a_moving_light_bakes_to_the_same_bytes(void **state) {
    (void)state;
    assert_bakes_alike(TEST_SCENES "/cornell.cfg", "--indirect basis --size 96x64 --frames 12 --receiver-rays 16", ALL_WAYS);
}

static void baked_light_at_points_bakes_to_the_same_bytes(void **state) {
    (void)state;
    assert_bakes_alike(TEST_SCENES "/cornell.cfg",
                       "--indirect basis --size 96x64 --frames 12 --receiver-rays 16 --basis-receivers points", HOST_WAYS);
}

static void a_room_with_still_lights_textures_and_holes_bakes_to_the_same_bytes(void **state) {
    (void)state;
    assert_bakes_alike(TEST_PACKS "/room.cfg", "--estimate buckets", HOST_WAYS);
}

static void zones_and_areas_bake_to_the_same_bytes(void **state) {
    (void)state;
    assert_bakes_alike(TEST_PACKS "/room.cfg", "--zones 2 --effective-area 1 --bounce-sequence 1 --radius 0.3", ALL_WAYS);
}

static void a_mesh_without_a_scene_file_bakes_to_the_same_bytes(void **state) {
    (void)state;
    assert_bakes_alike(TEST_SCENES "/furnace.obj", "--indirect photons --size 64x48 --frames 2 --photons 1000", HOST_WAYS);
    assert_bakes_alike(TEST_SCENES "/furnace.obj", "--size 64x48 --frames 2 --receiver-rays 16", HOST_WAYS); /* by default */
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_box_with_a_moving_light_bakes_to_the_same_bytes),
        cmocka_unit_test(baked_light_of_a_moving_light_bakes_to_the_same_bytes),
        cmocka_unit_test(baked_light_at_points_bakes_to_the_same_bytes),
        cmocka_unit_test(a_room_with_still_lights_textures_and_holes_bakes_to_the_same_bytes),
        cmocka_unit_test(zones_and_areas_bake_to_the_same_bytes),
        cmocka_unit_test(a_mesh_without_a_scene_file_bakes_to_the_same_bytes),
    };
    return cmocka_run_group_tests_name("bake twice", tests, NULL, NULL);
}
