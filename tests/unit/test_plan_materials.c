/* What the planner makes of materials, lights and settings: effects, chains, samples per pixel, a directional light's disc and
 * its share of the photons. What is hard: an effect too many costs time in every frame, one too few leaves a material black.
 * Strategy: one room with one thing more each, through the steps of the baker that need no device; what is called for is held
 * to be that and nothing else. */
#define FOLDER VIT_BUILD_DIR "/tests/unit/plan_materials_files"
#include "pack/planner.h"
#include "test_folder.h"
#include <math.h>

typedef struct planned {
    scene s;
    model m;
    tracks t;
    bvh b;
    geometry g;
    atlas a;
    plan p;
} planned;

#define LAMP "lights = ( { type = \"point\"; keys = ( { position = (0, 1, 0); power = (1, 1, 1); } ); } );\n"
#define MAKES(text) "materials = ( { name = \"floor\"; " text " } );\n"

/* A floor of one material and a triangle of another, from (-1, 0, -2) to (1, 3, 2). */
static void plan_scene(const char *text, planned *x) {
    char cfg[2048];
    vit_text why = {{0}};
    const dark_sides r = {.area = 16, .free_path = 1};
    memset(x, 0, sizeof *x);
    put(FOLDER "/m.mtl", "newmtl floor\nKd 0.5 0.5 0.5\nnewmtl other\nKd 0.5 0.5 0.5\n");
    put(FOLDER "/m.obj",
        "mtllib m.mtl\nv -1 0 -2\nv 1 0 -2\nv 1 0 2\nv -1 0 2\nv 1 3 2\nusemtl floor\nf 1 2 3 4\nusemtl other\nf 1 2 5\n");
    (void)snprintf(cfg, sizeof cfg,
                   "meshes = ( { file = \"m.obj\"; } );\ncamera: { keys = ( { eye = (0, 1, 3); target = (0, 1, 0); } ); };\n%s",
                   text);
    put(FOLDER "/m.cfg", cfg);
    vit_status status = scene_read(FOLDER "/m.cfg", &x->s, &why);
    if (status == VIT_OK)
        status = model_import(&x->s, false, NULL, NULL, &x->m, &why);
    if (status == VIT_OK)
        status = tracks_evaluate(&x->s, &x->m, &x->t, &why);
    if (status == VIT_OK)
        status = bvh_build(&x->m, 1, &x->b, &why);
    if (status == VIT_OK)
        status = geometry_pack(&x->m, &x->b, &x->g, &why);
    if (status == VIT_OK)
        status = atlas_pack(&x->m, &x->a, &why);
    const plan_input in = {.scene = &x->s,
                           .model = &x->m,
                           .tracks = &x->t,
                           .atlas = &x->a,
                           .bvh = &x->b,
                           .geometry = &x->g,
                           .dark_sides = &r,
                           .sky = &(const environment){0},
                           .threads = 1};
    x->s.quality.indirect = INDIRECT_PHOTONS;
    if (status == VIT_OK)
        status = plan_make(&in, &x->p, &why);
    if (status != VIT_OK)
        print_error("%s\n", why.text);
    assert_int_equal(status, VIT_OK);
}

static void plan_scene_free(planned *x) {
    plan_free(&x->p);
    atlas_free(&x->a);
    geometry_free(&x->g);
    bvh_free(&x->b);
    tracks_free(&x->t);
    model_free(&x->m);
    scene_free(&x->s);
}

/* Effects that `text` adds to those of the bare room with a lamp. */
static vit_u64 added(const char *text) {
    planned x;
    char whole[1024];
    plan_scene(LAMP, &x);
    const vit_u64 bare = x.p.scene.effects;
    plan_scene_free(&x);
    (void)snprintf(whole, sizeof whole, LAMP "%s", text);
    plan_scene(whole, &x);
    const vit_u64 effects = x.p.scene.effects;
    assert_true((bare & ~effects) == 0);
    plan_scene_free(&x);
    return effects & ~bare;
}

static void each_thing_calls_for_its_effect_alone(void **state) {
    (void)state;
    assert_true(added("") == 0);
    assert_true(added("ambient = (0, 0, 0.1);") == VIT_BIT(AMBIENT));
    assert_true(added("ambient = (0, 0, 0.1); ambient_radius = 2;") == (VIT_BIT(AMBIENT) | VIT_BIT(OCCLUSION)));
    assert_true(added("ambient_radius = 2;") == 0);
    assert_true(added(MAKES("specular = (0.1, 0, 0);")) == VIT_BIT(SPECULAR));
    assert_true(added(MAKES("specular = (0, 0, 0); exponent = 20;")) == 0);
    assert_true(added(MAKES("specular = (0.1, 0, 0); roughness = 0.5;")) == (VIT_BIT(SPECULAR) | VIT_BIT(GGX)));
    assert_true(added(MAKES("specular = (0, 0, 0); roughness = 0.5;")) == 0);
    /* Surroundings, unless photons make the light of what is seen in them, as here. */
    static const char none[] = "quality: { photons = 0; };", few[] = "quality: { photons = 0; gloss_rays = 0; };";
    vit_u64 gloss[2];
    for (int i = 0; i < 2; i++) {
        planned x;
        char whole[1024];
        (void)snprintf(whole, sizeof whole, LAMP "%s%s", MAKES("specular = (0.1, 0, 0); roughness = 0.5;"), i ? few : none);
        plan_scene(whole, &x);
        gloss[i] = x.p.scene.effects & VIT_BIT(GLOSS);
        assert_int_equal(x.p.scene.gloss_rays, i ? 0 : 8);
        plan_scene_free(&x);
    }
    assert_true(gloss[0] && !gloss[1]);
    assert_true(added(MAKES("kind = \"mirror\";")) == (VIT_BIT(MIRROR) | VIT_BIT(CAUSTICS)));
    assert_true(added(MAKES("kind = \"glass\";")) == (VIT_BIT(GLASS) | VIT_BIT(CAUSTICS)));
    assert_true(added(MAKES("kind = \"thin_glass\";") "quality: { caustics = false; };") == VIT_BIT(GLASS));
    assert_true(added("quality: { antialias = 2; };") == VIT_BIT(ANTIALIAS));
    assert_true(added("quality: { antialias_filter = \"tent\"; specular_depth = 20; };") == 0);
}

static void without_photons_there_are_no_caustics(void **state) {
    planned x;
    (void)state;
    plan_scene(LAMP MAKES("kind = \"mirror\";") "quality: { photons = 0; };", &x);
    assert_true(x.p.scene.effects == (VIT_BIT(LIGHTS) | VIT_BIT(MIRROR)));
    plan_scene_free(&x);
}

static void chains_are_as_long_as_the_scene_says_where_there_are_any(void **state) {
    planned x;
    (void)state;
    plan_scene(LAMP "quality: { specular_depth = 20; };", &x);
    assert_int_equal(x.p.scene.chain, 0);
    plan_scene_free(&x);
    plan_scene(
        LAMP MAKES(
            "kind = \"glass\"; ior = 1.25; specular = (1, 0.5, 0.25); absorption = (3, 2, 1);") "quality: { specular_depth = "
                                                                                                "20; };",
        &x);
    const vit_material *m = &x.p.materials[0];
    assert_int_equal(x.p.scene.chain, 20);
    assert_true(m->kind == VIT_GLASS && m->ior == 1.25f && m->specular[1] == 0.5f && m->absorption[0] == 3.0f &&
                m->albedo[0] == 0.0f);
    assert_true(x.p.materials[1].kind == VIT_MATTE && x.p.materials[1].exponent == 1.0f && x.p.materials[1].ior == 1.0f);
    plan_scene_free(&x);
}

static void samples_of_a_pixel_follow_the_settings(void **state) {
    planned x;
    (void)state;
    plan_scene(LAMP "quality: { antialias = 8; antialias_contrast = 0.5; };", &x);
    assert_true(x.p.scene.copies == 8 && x.p.scene.contrast == 0.5f && x.p.scene.offset[7][0] != 0.0f &&
                x.p.scene.offset[8][0] == 0.0f);
    plan_scene_free(&x);
    plan_scene(LAMP "ambient = (1, 2, 3);", &x);
    assert_true(x.p.scene.copies == 1 && x.p.scene.contrast == 0.0f && x.p.scene.offset[0][0] == 0.0f);
    assert_true(x.p.scene.ambient[0] == 1.0f && x.p.scene.ambient[2] == 3.0f);
    plan_scene_free(&x);
}

static void what_emits_lights_unless_it_must_not(void **state) {
    planned x;
    (void)state;
    plan_scene(LAMP MAKES("emission = (0, 1, 0);"), &x);
    assert_true(x.p.materials[0].lights == 1 && x.p.materials[1].lights == 0);
    plan_scene_free(&x);
    plan_scene(LAMP MAKES("emission = (0, 1, 0); area_light = false;"), &x);
    assert_true(x.p.materials[0].lights == 0 && x.p.materials[0].emission[1] == 1.0f);
    plan_scene_free(&x);
}

#define SUN "{ type = \"directional\"; keys = ( { position = (5, 4, 3); target = (4, 2, 2); irradiance = (3, 2, 1); } ); }"

static void a_directional_lights_disc_covers_the_model(void **state) {
    planned x;
    (void)state;
    plan_scene("lights = ( " SUN " );", &x);
    const vit_light *l = x.t.lights;
    const double d[3] = {-1 / sqrt(6), -2 / sqrt(6), -1 / sqrt(6)};
    assert_true(x.p.scene.effects & VIT_BIT(DIRECTIONAL));
    assert_true(l->kind == VIT_LIGHT_DIRECTIONAL && l->cos_outer == 1.0f && l->intensity[0] == 3.0f && l->inv_range2 == 0.0f);
    for (int k = 0; k < 3; k++)
        assert_true(fabs((double)l->direction[k] - d[k]) < 1e-6);
    for (uint32_t i = 0; i < x.m.vertices; i++) {
        double along = 0, square = 0;
        for (int k = 0; k < 3; k++) {
            const double to = (double)x.m.position[3 * i + (uint32_t)k] - (double)l->position[k];
            along += to * d[k];
            square += to * to;
        }
        assert_true(along > 0); /* every vertex is ahead of the disc, and before it */
        assert_true(square - along * along < (double)l->spot_scale * (double)l->spot_scale);
    }
    plan_scene_free(&x);
}

static void photons_are_shared_by_power(void **state) {
    planned x;
    (void)state;
    /* The box has a half diagonal of sqrt(1 + 4 + 2.25). */
    const double sun = (3 + 2 + 1) * 3.14159265358979 * 7.25 * 1.001 * 1.001, lamp = 300, all = 17000;
    plan_scene("lights = ( " SUN ", { type = \"point\"; keys = ( { position = (0, 1, 0); power = (100, 100, 100); } ); } );",
               &x);
    assert_true(fabs(x.p.baked_paths[0] - all * sun / (sun + lamp)) <= 17);
    assert_true(fabs(x.p.baked_paths[1] - all * lamp / (sun + lamp)) <= 17);
    plan_scene_free(&x);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_thing_calls_for_its_effect_alone),
        cmocka_unit_test(without_photons_there_are_no_caustics),
        cmocka_unit_test(chains_are_as_long_as_the_scene_says_where_there_are_any),
        cmocka_unit_test(samples_of_a_pixel_follow_the_settings),
        cmocka_unit_test(what_emits_lights_unless_it_must_not),
        cmocka_unit_test(a_directional_lights_disc_covers_the_model),
        cmocka_unit_test(photons_are_shared_by_power),
    };
    return cmocka_run_group_tests(tests, make_folder, NULL);
}
