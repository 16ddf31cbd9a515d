/* The indirect light of lists against its definition: the sum over all photons, in double.
 *
 * What can go wrong: a photon that counts for a sample is culled with its cluster or an ancestor of it, is dropped from a list,
 * or is counted twice; a sum of many photons loses what is small. The bound: one rounding an added photon, of the largest
 * irradiance in the frame; a photon lost would show as its whole share. Photons within 1e-6 of grazing may count or not and are
 * allowed for. Packs of the Cornell box and a room with textures and a moving light: plain, flattened, with normals in keys,
 * zones, areas, and all of it. */
#include "catalogue.h"
#include "list_check.h"

static void check_pack(const char *name, double bound) {
    open_pack p;
    char what[96];
    pack_open(&p, name, (vit_open_info){.device = VIT_DEVICE_HOST});
    pack_frame(&p, p.need.frames - 1);
    const list_check c = list_check_frame(&p, catalogue_whole() ? 1 : 7);
    assert_true(c.lit > c.samples / 4);
    (void)snprintf(what, sizeof what, "%s: irradiance against the sum over all photons", name);
    catalogue_row("list estimate", what, c.worst, bound, "of the largest irradiance");
    pack_close(&p);
}

static void plain_lists(void **state) {
    (void)state;
    check_pack("list", 2e-6);
    check_pack("room", 2e-6);
    check_pack("normal-keys", 2e-6);
}

static void flattened_lists(void **state) {
    (void)state;
    check_pack("flattened", 2e-6);
}

static void lists_with_zones_and_areas(void **state) {
    (void)state;
    check_pack("zones-areas", 2e-6);
    check_pack("zones-alone", 2e-6);
    check_pack("areas-alone", 2e-6);
    check_pack("zones", 2e-6);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(plain_lists), cmocka_unit_test(flattened_lists),
                                       cmocka_unit_test(lists_with_zones_and_areas)};
    return cmocka_run_group_tests_name("list estimate", tests, NULL, NULL);
}
