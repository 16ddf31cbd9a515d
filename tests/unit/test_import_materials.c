/* What the importer makes of MTL's materials that are not matt, and of what a scene file says over them. What is hard: programs
 * write highlights, mirrors and transparency that nobody meant, and mean what they do not write. Strategy: tiny files written
 * here, one rule each, with numbers that can be worked out by hand; where the test scenes are at hand (VITRINE_SCENES or
 * ../shared/scenes), a real one. */
#define FOLDER VIT_BUILD_DIR "/tests/unit/import_materials_files"
#include "import_lab.h"
#include "import/metallic_roughness.h"

/* `mtl` holds materials "a", "b" and so on, `count` of them. */
static void import_mtl(const char *mtl, int count, const char *overrides, model *m) {
    char obj[512];
    size_t used = (size_t)snprintf(obj, sizeof obj, "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\n");
    for (int i = 0; i < count; i++)
        used += (size_t)snprintf(obj + used, sizeof obj - used, "usemtl %c\nf 1/1 2/1 3/1\n", 'a' + i);
    put(FILE_OF("m.mtl"), mtl);
    put(FILE_OF("m.obj"), obj);
    import_scene("m.obj", overrides, m);
    assert_int_equal(m->material_count, count);
}

/* ---- MTL ---- */

static void a_highlight_is_a_lobe_of_its_exponent(void **state) {
    model m;
    (void)state;
    import_mtl("newmtl a\nKd 0.5 0.25 0\nKs 0.25 0.5 0.125\nNs 40\nillum 2\n", 1, "", &m);
    assert_true(m.materials[0].kind == VIT_MATTE && m.materials[0].exponent == 40.0f);
    assert_true(near3(m.materials[0].albedo, 0.5, 0.25, 0) && near3(m.materials[0].specular, 0.25, 0.5, 0.125));
    model_free(&m);
}

static void no_highlight_is_matt(void **state) {
    model m;
    (void)state;
    import_mtl("newmtl a\nKd 1 1 1\nKs 0 0 0\nNs 40\nillum 2\n" /* black */
               "newmtl b\nKd 1 1 1\nKs 0.5 0.5 0.5\nNs 0\nillum 2\n"
               "newmtl c\nKd 1 1 1\nKs 0.5 0.5 0.5\nNs 40\nillum 1\n" /* without highlights */
               "newmtl d\nKd 1 1 1\nKs 0.5 0.5 0.5\nNs 50\n",         /* nothing says with */
               4, "", &m);
    for (int i = 0; i < 4; i++)
        assert_true(is_matt(&m.materials[i]) && near3(m.materials[i].albedo, 1, 1, 1));
    model_free(&m);
}

static void what_reflects_too_much_is_scaled_with_its_hues(void **state) {
    model m;
    (void)state;
    import_mtl("newmtl a\nKd 0.9 0.45 0\nKs 0.6 0.6 0.6\nNs 40\nillum 2\n", 1, "", &m);
    assert_true(near3(m.materials[0].albedo, 0.6, 0.3, 0) && near3(m.materials[0].specular, 0.4, 0.4, 0.4));
    for (int k = 0; k < 3; k++)
        assert_true(m.materials[0].albedo[k] + m.materials[0].specular[k] <= 1.0f);
    model_free(&m);
}

/* As Blender writes a material: Ka 1, the index that users leave. */
#define BLENDER(name, kd, ns)                                                                                                  \
    "newmtl " name "\nNs " ns "\nKa 1 1 1\nKd " kd "\nKs 0.5 0.5 0.5\nKe 0 0 0\nNi 1.45\nd 1\nillum 2\n"
#define CHOSEN "newmtl %c\nKd 0.4 0.4 0.4\nKs 0.3 0.3 0.3\nNs 80\nillum 2\n"

static void an_exporters_default_highlight_is_none_whatever_else_the_file_holds(void **state) {
    static const char *const defaults[][2] = {{"0.5 0.5 0.5", "250"},
                                              {"0.500000 0.500000 0.500000", "250.000000"},
                                              {"0.5 0.5 0.5", "360.000000"},
                                              {"0.5 0.5 0.5", "225.000000"},
                                              {"0.5 0.5 0.5", "323.999994"},
                                              {"0.500000 0.500000 0.500000", "96.078431"},
                                              {"0.50 0.50 0.50", "18.00"},
                                              {"0.9000 0.9000 0.9000", "10.0000"},
                                              {"0.898039 0.898039 0.898039", "10.0000"},
                                              {"0.4 0.4 0.4", "10"}};
    (void)state;
    for (size_t i = 0; i < sizeof defaults / sizeof defaults[0]; i++)
        for (int others = 0; others < 4; others++) { /* materials beside it, of a highlight that somebody chose */
            char text[1024];
            model m;
            int used = snprintf(text, sizeof text, "newmtl a\nNs %s\nKd 0.8 0.7 0.6\nKs %s\nillum 2\n", defaults[i][1],
                                defaults[i][0]);
            for (int k = 1; k <= others; k++)
                used += snprintf(text + used, sizeof text - (size_t)used, CHOSEN, 'a' + k);
            import_mtl(text, 1 + others, "", &m);
            if (!is_matt(&m.materials[0]) || !near3(m.materials[0].albedo, 0.8, 0.7, 0.6))
                fail_msg("Ks %s, Ns %s beside %d others: a lobe", defaults[i][0], defaults[i][1], others);
            assert_true(m.default_highlights == 1);
            for (int k = 1; k <= others; k++)
                assert_true(m.materials[k].exponent == 80.0f && near3(m.materials[k].specular, 0.3, 0.3, 0.3));
            model_free(&m);
        }
}

static void a_default_in_the_whole_file_is_told_by_its_first(void **state) {
    model m;
    (void)state;
    import_mtl(BLENDER("a", "1 0 0", "250.000000") BLENDER("b", "0 1 0", "250.000000") BLENDER("c", "0 0 1", "250.000000"), 3,
               "", &m);
    for (int i = 0; i < 3; i++)
        assert_true(is_matt(&m.materials[i]) && m.materials[i].albedo[i] == 1.0f);
    assert_int_equal(m.default_highlights, 3);
    assert_string_equal(m.default_highlight, "Ks 0.5, Ns 250: Blender");
    model_free(&m);
}

static void a_highlight_near_a_default_is_meant(void **state) {
    static const char *const meant[][2] = {{"0.5 0.5 0.5", "40"},  {"0.5 0.5 0.5", "251"}, {"0.51 0.51 0.51", "250"},
                                           {"0.5 0.5 0.4", "250"}, {"0.9 0.9 0.9", "40"},  {"0.8 0.8 0.8", "10"}};
    (void)state;
    for (size_t i = 0; i < sizeof meant / sizeof meant[0]; i++) {
        char text[512];
        model m;
        (void)snprintf(text, sizeof text, "newmtl a\nNs %s\nKa 0.1 0.1 0.1\nKd 0.05 0.05 0.05\nKs %s\nillum 2\n", meant[i][1],
                       meant[i][0]);
        import_mtl(text, 1, "", &m);
        if (m.materials[0].exponent != strtof(meant[i][1], NULL) || m.materials[0].specular[0] != strtof(meant[i][0], NULL))
            fail_msg("Ks %s, Ns %s: exponent %g, reflectance %g", meant[i][0], meant[i][1], (double)m.materials[0].exponent,
                     (double)m.materials[0].specular[0]);
        assert_true(m.default_highlights == 0 && m.principled == 0);
        model_free(&m);
    }
}

/* Level 0.5 is a reflection of 4 %; Ns is 1000 (1 - roughness)^2. */
static void blenders_level_is_no_reflectance(void **state) {
    model m;
    (void)state;
    import_mtl(BLENDER("a", "0.8 0.8 0.8", "490.000000")                                             /* roughness 0.3 */
               BLENDER("b", "0.8 0.8 0.8", "40.000000")                                              /* 0.8: no lobe */
               "newmtl c\nNs 490\nKa 1 1 1\nKd 0.3 0.2 0.1\nKs 0.5 0.5 0.5\nNi 1.5\nd 1\nillum 3\n", /* metal, no mirror */
               3, "", &m);
    assert_true(near3(m.materials[0].specular, 0.04, 0.04, 0.04) && near3(m.materials[0].albedo, 0.768, 0.768, 0.768));
    assert_true(fabs((double)m.materials[0].exponent / (double)specular_exponent(0.3f) - 1.0) < 1e-5);
    assert_true(is_matt(&m.materials[1]) && near3(m.materials[1].albedo, 0.8, 0.8, 0.8));
    assert_true(m.materials[2].kind == VIT_MATTE && near3(m.materials[2].specular, 0.3, 0.2, 0.1) &&
                near3(m.materials[2].albedo, 0, 0, 0));
    assert_true(m.default_highlights == 0 && m.principled == 3);
    model_free(&m);
}

static void a_mirror_reflects_more_than_it_scatters(void **state) {
    model m;
    (void)state;
    import_mtl("newmtl a\nKd 0.1 0.1 0.1\nKs 0.9 0.8 0.7\nNs 10\nillum 3\n"
               "newmtl b\nKd 0.01 0.01 0.01\nKs 0.95 0.95 0.95\nillum 5\n"
               "newmtl c\nKd 0.5 0.5 0.5\nKs 0.25 0.25 0.25\nNs 60\nillum 3\n"
               "newmtl d\nKd 0.1 0.1 0.1\nKs 0.9 0.9 0.9\nKe 1 1 1\nNs 60\nillum 3\n",
               4, "", &m);
    assert_true(m.materials[0].kind == VIT_MIRROR && near3(m.materials[0].specular, 0.9, 0.8, 0.7));
    assert_true(near3(m.materials[0].albedo, 0, 0, 0) && m.materials[0].exponent == 1.0f);
    assert_true(m.materials[1].kind == VIT_MIRROR && near3(m.materials[1].specular, 0.95, 0.95, 0.95));
    assert_true(m.materials[2].kind == VIT_MATTE && m.materials[2].exponent == 60.0f);
    assert_true(m.materials[3].kind == VIT_MATTE && near3(m.materials[3].emission, 1, 1, 1)); /* what emits is seen */
    model_free(&m);
}

static void glass_must_be_transparent(void **state) {
    model m;
    (void)state;
    import_mtl("newmtl a\nKd 0.5 0.5 0.5\nd 0.1\nNi 1.33\nillum 7\n"         /* refracts */
               "newmtl b\nKd 0.5 0.5 0.5\nTf 0.25 0.81 1\nNi 1.6\nillum 6\n" /* Tf: of two surfaces */
               "newmtl c\nKd 0.5 0.5 0.5\nTf 0.25 0.81 1\nNi 1.6\nillum 4\n" /* no refraction: a pane */
               "newmtl d\nKd 0.5 0.5 0.5\nd 0.4\nillum 9\n"                  /* no index */
               "newmtl e\nKd 0.5 0.5 0.5\nd 1\nTf 1 1 1\nNi 1.5\nillum 4\n"  /* as many programs write of all */
               "newmtl f\nKd 0 0 0\nNi 2\nillum 7\n"                         /* nothing else to see */
               "newmtl g\nKd 0.5 0.5 0.5\nd 0.6\nNi 1.5\nillum 2\n",         /* as before: opaque enough */
               7, "", &m);
    const model_material *a = m.materials;
    assert_true(a[0].kind == VIT_GLASS && a[0].ior == 1.33f && near3(a[0].specular, 1, 1, 1) && near3(a[0].albedo, 0, 0, 0));
    assert_true(a[0].cutoff == 0.0f && a[0].triangles == 1); /* no hole */
    assert_true(a[1].kind == VIT_GLASS && a[1].ior == 1.6f && near3(a[1].specular, 0.5, 0.9, 1));
    assert_true(a[2].kind == VIT_THIN_GLASS && a[2].ior == 1.6f && near3(a[2].specular, 0.25, 0.81, 1));
    assert_true(a[3].kind == VIT_THIN_GLASS && a[3].ior == 1.5f && near3(a[3].specular, 1, 1, 1));
    assert_true(is_matt(&a[4]) && is_matt(&a[6]));
    assert_true(a[5].kind == VIT_GLASS && a[5].ior == 2.0f);
    model_free(&m);
}

/* ---- the scene file over the mesh ---- */

static void a_scene_file_makes_any_material_of_any(void **state) {
    static const char plain[] = "newmtl a\nKd 0.5 0.25 0.125\n", pane[] = "newmtl a\nKd 0.5 0.5 0.5\nd 0.1\n";
    model m;
    (void)state;
    import_mtl(plain, 1, "materials = ( { name = \"a\"; kind = \"mirror\"; specular = (0.9, 0.8, 0.7); } );", &m);
    assert_true(m.materials[0].kind == VIT_MIRROR && near3(m.materials[0].specular, 0.9, 0.8, 0.7) &&
                near3(m.materials[0].albedo, 0, 0, 0));
    model_free(&m);
    import_mtl(plain, 1, "materials = ( { name = \"a\"; kind = \"glass\"; absorption = (1, 2, 3); } );", &m);
    assert_true(m.materials[0].kind == VIT_GLASS && m.materials[0].ior == 1.5f && near3(m.materials[0].absorption, 1, 2, 3));
    assert_true(near3(m.materials[0].specular, 1, 1, 1));
    model_free(&m);
    import_mtl(plain, 1, "materials = ( { name = \"a\"; specular = (0.25, 0.25, 0.25); } );", &m);
    assert_true(m.materials[0].exponent == 50.0f && near3(m.materials[0].albedo, 0.5, 0.25, 0.125));
    model_free(&m);
    import_mtl(plain, 1, "materials = ( { name = \"a\"; exponent = 20; specular = (1, 1, 1); color = (1, 1, 1); } );", &m);
    assert_true(m.materials[0].exponent == 20.0f && near3(m.materials[0].albedo, 0.5, 0.5, 0.5) &&
                near3(m.materials[0].specular, 0.5, 0.5, 0.5));
    model_free(&m);
    import_mtl(plain, 1, "materials = ( { name = \"a\"; roughness = 0.5; specular = (0.25, 0.25, 0.25); } );", &m);
    assert_true(m.materials[0].lobe_alpha == 0.25f && near3(m.materials[0].specular, 0.25, 0.25, 0.25));
    model_free(&m);
    import_mtl(plain, 1, "materials = ( { name = \"a\"; roughness = 0; specular = (0.25, 0.25, 0.25); } );", &m);
    assert_true(m.materials[0].lobe_alpha == VIT_MIN_ALPHA);
    model_free(&m);
    import_mtl(plain, 1, "materials = ( { name = \"a\"; roughness = 0.5; } );", &m);
    assert_true(is_matt(&m.materials[0]) && m.materials[0].lobe_alpha == 0.0f); /* nor that it could be the roughness of */
    model_free(&m);
    import_mtl(plain, 1, "materials = ( { name = \"a\"; exponent = 20; } );", &m);
    assert_true(is_matt(&m.materials[0])); /* no lobe that it could be the exponent of */
    model_free(&m);
    import_mtl(pane, 1, "materials = ( { name = \"a\"; kind = \"thin_glass\"; ior = 1.6; } );", &m);
    assert_true(m.materials[0].kind == VIT_THIN_GLASS && m.materials[0].ior == 1.6f && m.triangles == 1); /* no hole any more */
    model_free(&m);
    import_mtl(plain, 1, "materials = ( { name = \"a\"; ior = 1.6; } );", &m);
    assert_non_null(strstr(last_warning, "a setting does nothing"));
    model_free(&m);
}

static void what_emits_is_an_area_light_unless_told_otherwise(void **state) {
    model m;
    (void)state;
    import_mtl("newmtl a\nKd 0.5 0.5 0.5\nKe 1 2 3\n", 1, "", &m);
    assert_true(m.materials[0].area_light && near3(m.materials[0].emission, 1, 2, 3));
    model_free(&m);
    import_mtl("newmtl a\nKd 0.5 0.5 0.5\nKe 1 2 3\n", 1, "materials = ( { name = \"a\"; area_light = false; } );", &m);
    assert_true(!m.materials[0].area_light && near3(m.materials[0].emission, 1, 2, 3));
    model_free(&m);
}

/* ---- a real scene ---- */

static void the_glossy_cornell_box_has_two_lobes(void **state) {
    model m;
    (void)state;
    if (!real_scene("cornell_box/CornellBox-Glossy.obj", &m))
        skip();
    const model_material *sphere = named(&m, "sphere"), *box = named(&m, "shortBox");
    assert_true(sphere->exponent == 40.0f && near3(sphere->specular, 0.9 / 1.563, 0.9 / 1.563, 0.9 / 1.563));
    assert_true(box->exponent == 40.0f && near3(box->albedo, 0.525 / 1.325, 0.51 / 1.325, 0.48 / 1.325));
    assert_true(is_matt(named(&m, "leftWall")) && is_matt(named(&m, "floor")) && named(&m, "light")->area_light);
    model_free(&m);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_highlight_is_a_lobe_of_its_exponent),
        cmocka_unit_test(no_highlight_is_matt),
        cmocka_unit_test(what_reflects_too_much_is_scaled_with_its_hues),
        cmocka_unit_test(an_exporters_default_highlight_is_none_whatever_else_the_file_holds),
        cmocka_unit_test(a_default_in_the_whole_file_is_told_by_its_first),
        cmocka_unit_test(a_highlight_near_a_default_is_meant),
        cmocka_unit_test(blenders_level_is_no_reflectance),
        cmocka_unit_test(a_mirror_reflects_more_than_it_scatters),
        cmocka_unit_test(glass_must_be_transparent),
        cmocka_unit_test(a_scene_file_makes_any_material_of_any),
        cmocka_unit_test(what_emits_is_an_area_light_unless_told_otherwise),
        cmocka_unit_test(the_glossy_cornell_box_has_two_lobes),
    };
    return cmocka_run_group_tests(tests, make_folder, NULL);
}
