/* What the importer makes of glTF's materials that are not matt: lobes of roughness and metalness, transmission. Strategy as in
 * test_import_materials.c. */
#define FOLDER VIT_BUILD_DIR "/tests/unit/import_gltf_materials_files"
#include "import_lab.h"

/* One material, its fields in `material`; `more` goes into the top level. */
static void import_gltf(const char *material, const char *more, const char *overrides, model *m) {
    char text[4096];
    (void)snprintf(text, sizeof text,
                   "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0]}],\"nodes\":[{\"mesh\":0}],"
                   "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0,\"TEXCOORD_0\":1},\"material\":0}]}],"
                   "\"buffers\":[{\"byteLength\":60,\"uri\":\"data:application/octet-stream;base64,"
                   "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAA\"}],"
                   "\"bufferViews\":[{\"buffer\":0,\"byteLength\":36},{\"buffer\":0,\"byteOffset\":36,\"byteLength\":24}],"
                   "\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\",\"min\":[0,0,0],"
                   "\"max\":[1,1,0]},"
                   "{\"bufferView\":1,\"componentType\":5126,\"count\":3,\"type\":\"VEC2\"}],"
                   "\"materials\":[{\"name\":\"a\",%s}]%s}",
                   material, more);
    put(FILE_OF("m.gltf"), text);
    import_scene("m.gltf", overrides, m);
    assert_int_equal(m->material_count, 1);
}

#define PBR(text) "\"pbrMetallicRoughness\":{" text "}"

static void roughness_and_metalness_make_lobes(void **state) {
    model m;
    (void)state;
    import_gltf(PBR("\"baseColorFactor\":[0.5,0.25,1,1],\"metallicFactor\":0,\"roughnessFactor\":0.5"), "", "", &m);
    /* alpha = 1/4: 1 / (2 alpha^2) - 2 = 6. */
    assert_true(m.materials[0].kind == VIT_MATTE && m.materials[0].exponent == 6.0f);
    assert_true(near3(m.materials[0].specular, 0.04, 0.04, 0.04) && near3(m.materials[0].albedo, 0.48, 0.24, 0.96));
    model_free(&m);
    import_gltf(PBR("\"baseColorFactor\":[0.5,0.25,1,1],\"metallicFactor\":0.5,\"roughnessFactor\":0.5"), "", "", &m);
    assert_true(near3(m.materials[0].specular, 0.27, 0.145, 0.52) && near3(m.materials[0].albedo, 0.24, 0.12, 0.48));
    model_free(&m);
    import_gltf(PBR("\"baseColorFactor\":[0.5,0.25,1,1],\"metallicFactor\":0,\"roughnessFactor\":1"), "", "", &m);
    assert_true(is_matt(&m.materials[0]) && near3(m.materials[0].albedo, 0.5, 0.25, 1));
    model_free(&m);
    import_gltf("\"doubleSided\":true", "", "", &m); /* glTF's own default: a metal as rough as can be */
    assert_true(is_matt(&m.materials[0]) && near3(m.materials[0].albedo, 1, 1, 1));
    model_free(&m);
}

/* glTF's own lobe: alpha is the square of the roughness, at every roughness. */
static void a_setting_makes_lobes_gltfs_own(void **state) {
#define OWN "quality: { lobe = \"ggx\"; };"
    static const struct {
        const char *pbr;
        double alpha, specular[3], albedo[3];
    } cases[] = {{"\"metallicFactor\":0,\"roughnessFactor\":0.5", 0.25, {0.04, 0.04, 0.04}, {0.48, 0.24, 0.96}},
                 {"\"metallicFactor\":0.5,\"roughnessFactor\":0.5", 0.25, {0.27, 0.145, 0.52}, {0.24, 0.12, 0.48}},
                 {"\"metallicFactor\":0,\"roughnessFactor\":1", 1, {0.04, 0.04, 0.04}, {0.48, 0.24, 0.96}},
                 {"\"metallicFactor\":0,\"roughnessFactor\":0", 0.0078125, {0.04, 0.04, 0.04}, {0.48, 0.24, 0.96}},
                 {"\"roughnessFactor\":0.8", 0.64, {0.5, 0.25, 1}, {0, 0, 0}},
                 {"\"roughnessFactor\":0.2", 0.04, {0.5, 0.25, 1}, {0, 0, 0}}};
    model m;
    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char text[256];
        (void)snprintf(text, sizeof text, PBR("\"baseColorFactor\":[0.5,0.25,1,1],%s"), cases[i].pbr);
        import_gltf(text, "", OWN, &m);
        const model_material *k = m.materials;
        assert_true(k->kind == VIT_MATTE && fabs((double)k->lobe_alpha - cases[i].alpha) < 1e-6);
        assert_true(near3(k->specular, cases[i].specular[0], cases[i].specular[1], cases[i].specular[2]));
        assert_true(near3(k->albedo, cases[i].albedo[0], cases[i].albedo[1], cases[i].albedo[2]));
        model_free(&m);
        import_gltf(text, "", "", &m);
        assert_true(m.materials[0].lobe_alpha == 0.0f);
        model_free(&m);
    }
    import_gltf(PBR("\"roughnessFactor\":0.1"), "", OWN, &m);
    assert_true(m.materials[0].kind == VIT_MIRROR && m.materials[0].lobe_alpha == 0.0f);
    model_free(&m);
    import_gltf("\"extensions\":{\"KHR_materials_pbrSpecularGlossiness\":{\"diffuseFactor\":[0.5,0.25,0.75,1],"
                "\"specularFactor\":[0.25,0.5,0.125],\"glossinessFactor\":0.1}}",
                ",\"extensionsUsed\":[\"KHR_materials_pbrSpecularGlossiness\"]", OWN, &m);
    assert_true(fabs((double)m.materials[0].lobe_alpha - 0.81) < 1e-6 && near3(m.materials[0].specular, 0.25, 0.5, 0.125));
    assert_true(near3(m.materials[0].albedo, 0.25, 0.125, 0.375));
    model_free(&m);
    /* The scene file may take it back. */
    import_gltf(PBR("\"roughnessFactor\":0.5"), "", OWN "materials = ( { name = \"a\"; exponent = 9; } );", &m);
    assert_true(m.materials[0].lobe_alpha == 0.0f && m.materials[0].exponent == 9.0f);
    model_free(&m);
}

static void smooth_metal_is_a_mirror_and_a_scene_file_may_unmake_it(void **state) {
    static const char metal[] = PBR("\"baseColorFactor\":[0.5,0.25,1,1],\"roughnessFactor\":0.05");
    model m;
    (void)state;
    import_gltf(metal, "", "", &m);
    assert_true(m.materials[0].kind == VIT_MIRROR && near3(m.materials[0].specular, 0.5, 0.25, 1) &&
                near3(m.materials[0].albedo, 0, 0, 0));
    model_free(&m);
    import_gltf(metal, "", "materials = ( { name = \"a\"; kind = \"matt\"; } );", &m);
    assert_true(is_matt(&m.materials[0]) && near3(m.materials[0].albedo, 0.5, 0.25, 1));
    model_free(&m);
    import_gltf(metal, "", "materials = ( { name = \"a\"; kind = \"mirror\"; } );", &m);
    assert_true(m.materials[0].kind == VIT_MIRROR && near3(m.materials[0].specular, 0.5, 0.25, 1));
    model_free(&m);
    import_gltf(metal, "", "materials = ( { name = \"a\"; color = (1, 0, 0); } );", &m);
    assert_non_null(strstr(last_warning, "a setting does nothing"));
    model_free(&m);
}

/* 2 x 1 texels, TGA: red (255, 0, 0) and (0, 255, 128), the latter with alpha 0.4. */
static void put_texture(void) {
    static const uint8_t bytes[26] = {0, 0, 2, 0,  0,    0, 0, 0,   0,   0,   0,   0, 2,
                                      0, 1, 0, 32, 0x28, 0, 0, 255, 255, 128, 255, 0, 102};
    put_bytes(FILE_OF("t.tga"), bytes, sizeof bytes);
}
#define IMAGE ",\"textures\":[{\"source\":0}],\"images\":[{\"uri\":\"t.tga\"}]"

static void lobes_take_the_mean_of_textures(void **state) {
    model m;
    (void)state;
    put_texture();
    /* Green is roughness, blue metalness: 0.5 * 128 / 255. */
    import_gltf(PBR("\"baseColorFactor\":[0.5,0.25,1,1],\"metallicFactor\":0.5,\"metallicRoughnessTexture\":{\"index\":0}"),
                IMAGE, "", &m);
    const double metallic = 0.5 * 0.5 * 128 / 255;
    assert_true(m.materials[0].exponent == 6.0f && m.materials[0].image < 0 && m.image_count == 0);
    assert_true(near3(m.materials[0].specular, 0.04 + 0.46 * metallic, 0.04 + 0.21 * metallic, 0.04 + 0.96 * metallic));
    assert_true(near3(m.materials[0].albedo, 0.48 * (1 - metallic), 0.24 * (1 - metallic), 0.96 * (1 - metallic)));
    model_free(&m);
    /* A metal's colour; its texture is of no more use. */
    import_gltf(PBR("\"baseColorFactor\":[0.5,1,1,1],\"roughnessFactor\":0.5,\"baseColorTexture\":{\"index\":0}"), IMAGE, "",
                &m);
    assert_true(near3(m.materials[0].specular, 0.25, 0.5, 0.5 * pow((128 / 255.0 + 0.055) / 1.055, 2.4)));
    assert_true(near3(m.materials[0].albedo, 0, 0, 0) && m.materials[0].image < 0 && m.image_count == 0);
    model_free(&m);
    /* A dielectric keeps it. */
    import_gltf(PBR("\"metallicFactor\":0,\"roughnessFactor\":0.5,\"baseColorTexture\":{\"index\":0}"), IMAGE, "", &m);
    assert_true(near3(m.materials[0].albedo, 0.96, 0.96, 0.96) && m.materials[0].image == 0);
    model_free(&m);
    import_gltf(PBR("\"metallicRoughnessTexture\":{\"index\":0}"),
                ",\"textures\":[{\"source\":0}],\"images\":[{\"uri\":\"none.tga\"}]", "", &m);
    assert_true(is_matt(&m.materials[0]));
    assert_non_null(strstr(last_warning, "texture 'none.tga' is missing; done without it"));
    model_free(&m);
}

static void transmission_is_glass(void **state) {
    model m;
    (void)state;
#define USED ",\"extensionsUsed\":[\"KHR_materials_transmission\",\"KHR_materials_ior\",\"KHR_materials_volume\"]"
#define TRANSMITS(factor, more) "\"extensions\":{\"KHR_materials_transmission\":{\"transmissionFactor\":" factor "}" more "}"
    import_gltf(
        PBR("\"baseColorFactor\":[1,0.5,0.25,1],\"metallicFactor\":0,\"roughnessFactor\":0") "," TRANSMITS(
            "1",
            ",\"KHR_materials_ior\":{\"ior\":1.25},\"KHR_materials_volume\":{\"thicknessFactor\":1,\"attenuationDistance\":0.5,"
            "\"attenuationColor\":[1,0.5,0]}"),
        USED, "", &m);
    assert_true(m.materials[0].kind == VIT_GLASS && m.materials[0].ior == 1.25f &&
                near3(m.materials[0].specular, 1, 0.5, 0.25));
    assert_true(m.materials[0].absorption[0] == 0.0f && fabsf(m.materials[0].absorption[1] - 2.0f * 0.69314718f) < 1e-6f);
    assert_true(m.materials[0].absorption[2] == 1e9f && near3(m.materials[0].albedo, 0, 0, 0));
    model_free(&m);
    import_gltf(PBR("\"metallicFactor\":0") "," TRANSMITS("0.5", ""), USED, "", &m);
    assert_true(m.materials[0].kind == VIT_THIN_GLASS && m.materials[0].ior == 1.5f &&
                near3(m.materials[0].absorption, 0, 0, 0));
    model_free(&m);
    import_gltf(PBR("\"metallicFactor\":0") "," TRANSMITS("0.4", ""), USED, "", &m);
    assert_true(m.materials[0].kind == VIT_MATTE);
    model_free(&m);
}

/* Only what is no metal lets light through, and a material that says nothing is a metal (3.9.2). */
static void a_metal_lets_nothing_through(void **state) {
    model m;
    (void)state;
    import_gltf(TRANSMITS("1", ""), USED, "", &m);
    assert_true(is_matt(&m.materials[0]) && near3(m.materials[0].albedo, 1, 1, 1));
    model_free(&m);
    import_gltf(PBR("\"metallicFactor\":0.6") "," TRANSMITS("1", ""), USED, "", &m);
    assert_true(m.materials[0].kind == VIT_MATTE);
    model_free(&m);
    import_gltf(PBR("\"metallicFactor\":0.4") "," TRANSMITS("1", ""), USED, "", &m);
    assert_true(m.materials[0].kind == VIT_THIN_GLASS);
    model_free(&m);
}

static void what_is_clear_by_alpha_as_well_is_glass_and_no_hole(void **state) {
    model m;
    (void)state;
    put_texture();
    import_gltf(PBR("\"metallicFactor\":0,\"baseColorTexture\":{\"index\":0}") ",\"alphaMode\":\"BLEND\"," TRANSMITS("1", ""),
                USED IMAGE, "", &m);
    assert_true(m.materials[0].kind == VIT_THIN_GLASS && m.materials[0].cutoff == 0.0f && m.materials[0].image < 0);
    assert_true(near3(m.materials[0].specular, 0.5, 0.5, 0.5 * pow((128 / 255.0 + 0.055) / 1.055, 2.4)));
    model_free(&m);
}

static void specular_and_glossiness_make_a_lobe(void **state) {
    model m;
    (void)state;
    put_texture();
    import_gltf("\"extensions\":{\"KHR_materials_pbrSpecularGlossiness\":{\"diffuseFactor\":[0.5,0.25,0.75,1],"
                "\"specularFactor\":[0.25,0.5,0.125],"
                "\"glossinessFactor\":0.5}}",
                ",\"extensionsUsed\":[\"KHR_materials_pbrSpecularGlossiness\"]", "", &m);
    assert_true(m.materials[0].exponent == 6.0f && near3(m.materials[0].specular, 0.25, 0.5, 0.125));
    assert_true(near3(m.materials[0].albedo, 0.25, 0.125, 0.375));
    model_free(&m);
    /* Glossiness is the texture's alpha: 0.7 on average. */
    import_gltf("\"extensions\":{\"KHR_materials_pbrSpecularGlossiness\":{\"specularFactor\":[0.25,0.5,0.125],"
                "\"specularGlossinessTexture\":{\"index\":0}}}",
                ",\"extensionsUsed\":[\"KHR_materials_pbrSpecularGlossiness\"]" IMAGE, "", &m);
    assert_true(fabs((double)m.materials[0].exponent - (0.5 / pow(0.3, 4) - 2)) < 1e-2);
    assert_true(near3(m.materials[0].specular, 0.125, 0.25, 0.0625 * pow((128 / 255.0 + 0.055) / 1.055, 2.4)));
    model_free(&m);
}

static void what_emits_does_so_at_its_strength(void **state) {
    static const struct {
        const char *extension;
        double want;
    } cases[] = {{"", 0.5},
                 {",\"extensions\":{\"KHR_materials_emissive_strength\":{\"emissiveStrength\":10}}", 5},
                 {",\"extensions\":{\"KHR_materials_emissive_strength\":{}}", 0.5}};
    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        model m;
        char text[256];
        (void)snprintf(text, sizeof text, "\"emissiveFactor\":[0.5,0,0.25]%s", cases[i].extension);
        import_gltf(text, "", "", &m);
        assert_true(near3(m.materials[0].emission, cases[i].want, 0, cases[i].want / 2) && m.materials[0].states_unit);
        model_free(&m);
    }
}

/* f0 = ((n - 1) / (n + 1))^2; what is reflected is missing from the albedo. */
static void index_and_specular_factors_make_the_lobe_of_dielectrics(void **state) {
#define SMOOTH PBR("\"metallicFactor\":0,\"roughnessFactor\":0.3")
    const double f = (1.4 / 3.4) * (1.4 / 3.4);
    model m;
    (void)state;
    import_gltf(SMOOTH ",\"extensions\":{\"KHR_materials_ior\":{\"ior\":2.4}}", "", "", &m);
    assert_true(near3(m.materials[0].specular, f, f, f) && near3(m.materials[0].albedo, 1 - f, 1 - f, 1 - f));
    model_free(&m);
    import_gltf(SMOOTH
                ",\"extensions\":{\"KHR_materials_specular\":{\"specularFactor\":0.5,\"specularColorFactor\":[1,0.5,30]}}",
                "", "", &m);
    assert_true(near3(m.materials[0].specular, 0.02, 0.01, 0.5)); /* of 0.04, 0.02 and at most 1 */
    assert_true(near3(m.materials[0].albedo, 0.5, 0.5, 0.5));
    model_free(&m);
    import_gltf(SMOOTH ",\"extensions\":{\"KHR_materials_specular\":{\"specularFactor\":0}}", "", "", &m);
    assert_true(near3(m.materials[0].specular, 0, 0, 0) && near3(m.materials[0].albedo, 1, 1, 1));
    model_free(&m);
    put_texture(); /* its alpha is 0.7 on average */
    import_gltf(SMOOTH ",\"extensions\":{\"KHR_materials_specular\":{\"specularTexture\":{\"index\":0}}}", IMAGE, "", &m);
    assert_true(near3(m.materials[0].specular, 0.028, 0.028, 0.028));
    model_free(&m);
}

static void a_black_factor_is_black(void **state) {
    model m;
    (void)state;
    put_texture();
    import_gltf(PBR("\"baseColorFactor\":[0,0,0,1],\"metallicFactor\":0,\"baseColorTexture\":{\"index\":0}"), IMAGE, "", &m);
    assert_true(near3(m.materials[0].albedo, 0, 0, 0));
    assert_string_equal(warnings, "");
    model_free(&m);
}

/* 3.9.4 */
static void a_cutoff_above_1_cuts_all_of_it_away(void **state) {
    model m;
    vit_text why;
    (void)state;
    import_gltf("\"alphaMode\":\"MASK\",\"alphaCutoff\":1.5", "", "materials = ( { name = \"a\"; cutoff = 0.0; } );", &m);
    assert_int_equal(m.triangles, 1);
    model_free(&m);
    import_gltf("\"alphaMode\":\"MASK\",\"alphaCutoff\":1", "", "", &m);
    model_free(&m);
    import_gltf("\"alphaCutoff\":1.5", "", "", &m); /* of an opaque one nothing */
    model_free(&m);
    import_gltf("\"alphaMode\":\"MASK\",\"alphaCutoff\":1.5", "", "materials = ( { name = \"a\"; cutoff = 0.0; } );", &m);
    model_free(&m);
    assert_int_equal(import_in_scene("m.gltf", "", &m, &why), VIT_BAD_INPUT);
    assert_non_null(strstr(why.text, "no triangle that is not transparent"));
}

/* Coordinates of set 0 are (0, 0), (1, 0), (0, 1); set 1 is not there. */
static void a_transform_says_which_set_of_coordinates(void **state) {
    static const float corners[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0}, none[6] = {0}, fixed[6] = {0.1f, 0.2f, 0.1f, 0.2f, 0.1f, 0.2f};
    uint8_t bin[84];
    model m;
    (void)state;
    put_texture();
    put_floats(bin, corners, 9);
    put_floats(bin + 36, none, 6);
    put_floats(bin + 60, fixed, 6);
    put_bytes(FILE_OF("sets.bin"), bin, sizeof bin);
    put(FILE_OF("sets.gltf"),
        "{\"asset\":{\"version\":\"2.0\"},\"nodes\":[{\"mesh\":0}],"
        "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0,"
        "\"TEXCOORD_0\":1,\"TEXCOORD_1\":2},\"material\":0}]}],\"buffers\":[{\"byteLength\":84,\"uri\":\"sets.bin\"}],"
        "\"bufferViews\":[{\"buffer\":0,\"byteLength\":36},{\"buffer\":0,\"byteOffset\":36,\"byteLength\":24},{\"buffer\":0,"
        "\"byteOffset\":60,\"byteLength\":24}],\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":"
        "\"VEC3\"},{\"bufferView\":1,\"componentType\":5126,\"count\":3,\"type\":\"VEC2\"},{\"bufferView\":2,\"componentType\":"
        "5126,\"count\":3,\"type\":\"VEC2\"}],\"materials\":[{\"pbrMetallicRoughness\":{\"baseColorTexture\":{\"index\":0,"
        "\"texCoord\":0,\"extensions\":{\"KHR_texture_transform\":{\"offset\":[0.25,0.5],\"texCoord\":1}}}}}]" IMAGE "}");
    import_good(FILE_OF("sets.gltf"), &m);
    for (size_t i = 0; i < m.vertices; i++)
        assert_true(fabs((double)m.uv[2 * i] - 0.35) < 1e-6 && fabs((double)m.uv[2 * i + 1] - 0.7) < 1e-6);
    model_free(&m);
}

static void a_normal_map_is_taken_with_its_scale(void **state) {
    static const struct {
        const char *map;
        float scale;
    } cases[] = {{"{\"index\":0}", 1.0f},
                 {"{\"index\":0,\"scale\":-0.5}", -0.5f},
                 {"{\"index\":0,\"scale\":1e9}", VIT_MAX_NORMAL_SCALE},
                 {"{\"index\":0,\"scale\":0}", 0.0f},
                 {"{}", 0.0f}};
    (void)state;
    put_texture();
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        model m;
        char material[256];
        (void)snprintf(material, sizeof material, PBR("\"baseColorTexture\":{\"index\":0}") ",\"normalTexture\":%s",
                       cases[i].map);
        import_gltf(material, IMAGE, "", &m);
        assert_true(m.materials[0].normal_scale == cases[i].scale);
        assert_true(m.image_count == 1 && m.materials[0].normal_image == 0); /* the same picture, once */
        model_free(&m);
    }
}

/* A warning, and an error if strict. */
static void what_is_not_done_is_said(void **state) {
    static const struct {
        const char *material, *more, *what;
    } cases[] = {{"\"extensions\":{\"KHR_materials_unlit\":{}}", "", "unlit materials are lit like any other (material 'a'"},
                 {PBR("\"baseColorTexture\":{\"index\":0,\"texCoord\":1}") ",\"normalTexture\":{\"index\":0}", IMAGE,
                  "normal maps with other coordinates than the colour are left out (material 'a'"},
                 {"\"emissiveFactor\":[1,1,1],\"emissiveTexture\":{\"index\":0}", IMAGE, "emissive textures are not supported"},
                 {"\"doubleSided\":true", ",\"extensionsUsed\":[\"KHR_materials_clearcoat\"]",
                  "extension 'KHR_materials_clearcoat' is used and not read"},
                 {"\"doubleSided\":true",
                  ",\"animations\":[{\"channels\":[{\"sampler\":0,\"target\":{\"node\":0,\"path\":\"translation\"}}]}]",
                  "animations are left out"},
                 {PBR("\"metallicFactor\":0") "," TRANSMITS("0.4", ""), USED,
                  "transmission of less than half of the light, or of what emits, is left out (material 'a'"},
                 {PBR("\"metallicFactor\":0") ",\"emissiveFactor\":[1,1,1]," TRANSMITS("1", ""), USED,
                  "transmission of less than half of the light, or of what emits, is left out"}};
    (void)state;
    put_texture();
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        model m;
        import_gltf(cases[i].material, cases[i].more, "", &m);
        assert_non_null(strstr(warnings, cases[i].what));
        model_free(&m);
        refuse(FILE_OF("m.gltf"), true, cases[i].what);
    }
    model m;
    import_gltf("\"doubleSided\":true", ",\"extensionsUsed\":[\"KHR_materials_variants\"]", "", &m); /* changes nothing */
    assert_string_equal(warnings, "");
    model_free(&m);
    import_gltf(PBR("\"metallicFactor\":0") "," TRANSMITS("0", ""), USED, "", &m); /* so does this */
    assert_string_equal(warnings, "");
    model_free(&m);
}

static void the_dragon_is_of_amber(void **state) {
    model m;
    (void)state;
    if (!real_scene("stanford/DragonAttenuation/DragonAttenuation.gltf", &m))
        skip();
    const model_material *dragon = named(&m, "Dragon with Attenuation"), *cloth = named(&m, "Cloth Backdrop");
    assert_true(dragon->kind == VIT_GLASS && dragon->ior == 1.5f);
    assert_true(fabs((double)dragon->absorption[2] + log(0.064) / 0.155) < 1e-3);
    assert_true(cloth->kind == VIT_MATTE && cloth->exponent > 6.0f && cloth->exponent < 7.0f &&
                near3(cloth->specular, 0.04, 0.04, 0.04));
    model_free(&m);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(roughness_and_metalness_make_lobes),
        cmocka_unit_test(a_setting_makes_lobes_gltfs_own),
        cmocka_unit_test(smooth_metal_is_a_mirror_and_a_scene_file_may_unmake_it),
        cmocka_unit_test(lobes_take_the_mean_of_textures),
        cmocka_unit_test(transmission_is_glass),
        cmocka_unit_test(a_metal_lets_nothing_through),
        cmocka_unit_test(what_is_clear_by_alpha_as_well_is_glass_and_no_hole),
        cmocka_unit_test(specular_and_glossiness_make_a_lobe),
        cmocka_unit_test(what_emits_does_so_at_its_strength),
        cmocka_unit_test(index_and_specular_factors_make_the_lobe_of_dielectrics),
        cmocka_unit_test(a_black_factor_is_black),
        cmocka_unit_test(a_cutoff_above_1_cuts_all_of_it_away),
        cmocka_unit_test(a_transform_says_which_set_of_coordinates),
        cmocka_unit_test(a_normal_map_is_taken_with_its_scale),
        cmocka_unit_test(what_is_not_done_is_said),
        cmocka_unit_test(the_dragon_is_of_amber),
    };
    return cmocka_run_group_tests(tests, make_folder, NULL);
}
