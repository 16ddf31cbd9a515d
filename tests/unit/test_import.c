/* The importer. What is hard: meshes come from strangers, in formats that disagree on where v = 0 is, what alpha means and
 * whether a normal is there at all, and through a library whose releases differ. Strategy: tiny OBJ, PLY and glTF files that
 * the tests write themselves, each of which shows one rule in numbers that can be worked out by hand (a unit quad, an image of
 * two by two texels); then, where the test scenes are at hand (VITRINE_SCENES or ../shared/scenes), real and malformed files,
 * whose triangle counts were taken independently. Without them those tests are skipped. */
#define FOLDER VIT_BUILD_DIR "/tests/unit/import_files"
#include "import_lab.h"

/* ---- texture coordinates and images ---- */

static void an_obj_quad_has_v_0_in_the_first_row_of_its_image(void **state) {
    static const uint8_t rows[16] = {255, 0, 0, 255, 0, 255, 0, 255, 0, 0, 255, 255, 255, 255, 255, 255};
    model m;
    (void)state;
    put_image(FILE_OF("image.tga"), 255);
    put_obj("newmtl m\nKd 0.5 0.25 1\nmap_Kd image.tga\n");
    import_good(FILE_OF("quad.obj"), &m);
    check_promises(&m);
    uv_at(&m, 0, 1, 0, 0);
    uv_at(&m, 1, 0, 1, 1);
    assert_true(m.image_count == 1 && m.images[0].width == 2 && m.images[0].height == 2);
    assert_memory_equal(m.images[0].rgba, rows, sizeof rows);
    assert_true(m.materials[0].image == 0 && m.materials[0].albedo[0] == 0.5f && m.materials[0].albedo[1] == 0.25f);
    model_free(&m);
}

static void a_gltf_quad_has_v_0_in_the_first_row_of_its_image(void **state) {
    model m;
    (void)state;
    put_image(FILE_OF("image.tga"), 255);
    put_gltf(UVS, ONE_NODE "," TEXTURE("") "," MATERIAL(BASE("\"baseColorTexture\":{\"index\":0}")));
    import_good(FILE_OF("quad.gltf"), &m);
    check_promises(&m);
    uv_at(&m, 0, 1, 0, 0);
    uv_at(&m, 1, 0, 1, 1);
    assert_int_equal(m.materials[0].image, 0);
    assert_true(m.materials[0].wrap_u == VIT_WRAP_REPEAT && m.materials[0].wrap_v == VIT_WRAP_REPEAT);
    model_free(&m);
}

static void a_texture_may_name_the_second_uv_set_and_its_wrap_modes(void **state) {
    model m;
    (void)state;
    put_image(FILE_OF("image.tga"), 255);
    put_gltf(UVS, ONE_NODE "," TEXTURE("\"wrapS\":33071,\"wrapT\":33648") "," MATERIAL(
                      BASE("\"baseColorTexture\":{\"index\":0,\"texCoord\":1}")));
    import_good(FILE_OF("quad.gltf"), &m);
    uv_at(&m, 1, 0, 0.5f, 0.5f);
    assert_true(m.materials[0].wrap_u == VIT_WRAP_CLAMP && m.materials[0].wrap_v == VIT_WRAP_MIRROR);
    model_free(&m);
}

/* Offset (0.5, 0.25), a quarter turn, scale (2, 4): u' = 4 v + 0.5, v' = -2 u + 0.25. */
static void a_texture_transform_moves_the_uv(void **state) {
    model m;
    (void)state;
    put_image(FILE_OF("image.tga"), 255);
    put_gltf(UVS, "\"extensionsUsed\":[\"KHR_texture_transform\"]," ONE_NODE "," TEXTURE("") "," MATERIAL(
                      BASE("\"baseColorTexture\":{\"index\":0,\"extensions\":{\"KHR_texture_transform\":"
                           "{\"offset\":[0.5,0.25],\"rotation\":1.5707963267948966,\"scale\":[2,4]}}}")));
    import_good(FILE_OF("quad.gltf"), &m);
    uv_at(&m, 0, 1, 0.5f, 0.25f);
    uv_at(&m, 1, 1, 0.5f, -1.75f);
    uv_at(&m, 0, 0, 4.5f, 0.25f);
    model_free(&m);
}

static void an_embedded_image_is_decoded(void **state) {
    model m;
    (void)state;
    put_gltf(UVS,
             ONE_NODE ",\"textures\":[{\"source\":0}],\"images\":[{\"bufferView\":6,\"mimeType\":\"image/png\"}]," MATERIAL(
                 BASE("\"baseColorTexture\":{\"index\":0}")));
    import_good(FILE_OF("quad.gltf"), &m);
    assert_true(m.image_count == 1 && m.images[0].width == 2 && m.images[0].rgba[0] == 255 && m.images[0].rgba[1] == 0);
    assert_string_equal(m.images[0].name, FILE_OF("quad.gltf") "#0");
    model_free(&m);
}

static void backslashes_percent_signs_and_foreign_folders_find_their_texture(void **state) {
    static const char *const names[] = {"textures\\wood one.tga", "textures/wood%20one.tga", "C:\\work\\image.tga",
                                        "/home/image.tga"};
    (void)state;
    folder_make(FILE_OF("textures"));
    put_image(FILE_OF("textures/wood one.tga"), 255);
    put_image(FILE_OF("image.tga"), 255);
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        char mtl[256];
        model m;
        (void)snprintf(mtl, sizeof mtl, "newmtl m\nKd 1 1 1\nmap_Kd %s\n", names[i]);
        put_obj(mtl);
        import_good(FILE_OF("quad.obj"), &m);
        assert_int_equal(m.image_count, 1);
        model_free(&m);
    }
}

/* Of two that differ from the name in case alone it is the first by its bytes; the exact name goes before both. */
static void names_are_found_in_any_case(void **state) {
    static const char *const names[][2] = {{"TEXTURES\\Wood One.TGA", "textures/wood one.tga"},
                                           {"Textures//wood%20ONE.tga", "textures//wood one.tga"},
                                           {"two.tga", "TWO.TGA"},
                                           {"Two.tga", "Two.tga"}};
    (void)state;
    folder_make(FILE_OF("textures"));
    put_image(FILE_OF("textures/wood one.tga"), 255);
    put_image(FILE_OF("Two.tga"), 255);
    put_image(FILE_OF("TWO.TGA"), 255);
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        char mtl[256], found[256];
        model m;
        (void)snprintf(mtl, sizeof mtl, "newmtl m\nKd 1 1 1\nmap_Kd %s\n", names[i][0]);
        (void)snprintf(found, sizeof found, FOLDER "/%s", names[i][1]);
        put_obj(mtl);
        import_good(FILE_OF("quad.obj"), &m);
        assert_int_equal(m.image_count, 1);
        assert_string_equal(m.images[0].name, found);
        assert_string_equal(warnings, "");
        model_free(&m);
    }
}

static void a_missing_texture_is_a_warning_and_the_plain_colour(void **state) {
    model m;
    (void)state;
    put_obj("newmtl m\nKd 0.5 0.5 0.5\nmap_Kd nowhere.png\n");
    import_good(FILE_OF("quad.obj"), &m);
    assert_true(m.image_count == 0 && m.materials[0].image == -1 && m.materials[0].albedo[0] == 0.5f && m.warnings == 1);
    assert_non_null(strstr(last_warning, "material 'm': texture 'nowhere.png' is missing"));
    model_free(&m);
}

static void a_missing_texture_is_refused_if_strict(void **state) {
    (void)state;
    put_obj("newmtl m\nKd 0.5 0.5 0.5\nmap_Kd nowhere.png\n");
    refuse(FILE_OF("quad.obj"), true, "material 'm': texture 'nowhere.png' is missing");
}

/* 18 bytes that promise 16384 x 16384 texels: a gigabyte, were they believed. */
static void an_image_that_promises_more_than_its_bytes_can_hold_is_broken(void **state) {
    static const uint8_t head[18] = {[2] = 2, [13] = 0x40, [15] = 0x40, [16] = 32};
    model m;
    (void)state;
    put_bytes(FILE_OF("image.tga"), head, sizeof head);
    put_obj("newmtl m\nmap_Kd image.tga\n");
    import_good(FILE_OF("quad.obj"), &m);
    assert_true(m.image_count == 0);
    assert_non_null(strstr(last_warning, "is broken"));
    model_free(&m);
}

static void a_broken_texture_is_a_warning(void **state) {
    model m;
    (void)state;
    put(FILE_OF("broken.png"), "\x89PNG\r\n\x1a\nnothing more");
    put_obj("newmtl m\nKd 0.5 0.5 0.5\nmap_Kd broken.png\n");
    import_good(FILE_OF("quad.obj"), &m);
    assert_true(m.materials[0].image == -1 && m.warnings == 1);
    model_free(&m);
    refuse(FILE_OF("quad.obj"), true, "texture 'broken.png'");
}

static void a_texture_of_20000_pixels_is_not_decoded(void **state) {
    uint8_t bytes[34];
    (void)state;
    (void)make_image(bytes, 255);
    bytes[12] = 20000 & 255;
    bytes[13] = 20000 >> 8;
    put_bytes(FILE_OF("wide.tga"), bytes, sizeof bytes);
    put_obj("newmtl m\nKd 0.5 0.5 0.5\nmap_Kd wide.tga\n");
    refuse(FILE_OF("quad.obj"), true, "texture 'wide.tga' is larger than 16384 pixels");
}

/* ---- materials ---- */

static void colours_and_emission_of_gltf_are_linear_factors(void **state) {
    model m;
    (void)state;
    put_gltf("",
             ONE_NODE ",\"extensionsUsed\":[\"KHR_materials_emissive_strength\"]," MATERIAL(BASE(
                 "\"baseColorFactor\":[0.5,0.25,0.125,0.5],\"metallicFactor\":1") ",\"emissiveFactor\":[1,0.5,0],"
                                                                                  "\"extensions\":{\"KHR_materials_emissive_"
                                                                                  "strength\":{\"emissiveStrength\":3}}"));
    import_good(FILE_OF("quad.gltf"), &m);
    const model_material *a = &m.materials[0];
    assert_string_equal(a->name, "m");
    assert_true(a->albedo[0] == 0.5f && a->albedo[1] == 0.25f && a->albedo[2] == 0.125f && a->image == -1);
    assert_true(a->emission[1] > 0.0f && a->emission[0] == 2.0f * a->emission[1] && a->emission[2] == 0.0f);
    assert_true(a->emission[0] == 3.0f || a->emission[0] == 1.0f); /* releases before 5.3 do not pass the strength on */
    assert_true(a->cutoff == 0.0f && a->alpha == 1.0f);            /* opaque whatever its alpha says */
    model_free(&m);
}

static void an_obj_emits_its_ke(void **state) {
    model m;
    (void)state;
    put_obj("newmtl m\nKd 0.5 0.5 0.5\nKe 17 12 4\n");
    import_good(FILE_OF("quad.obj"), &m);
    assert_true(m.materials[0].emission[0] == 17.0f && m.materials[0].emission[2] == 4.0f);
    model_free(&m);
}

static void import_masked(const char *alpha_mode, uint8_t texel_alpha, model *m) {
    char rest[1024];
    put_image(FILE_OF("image.tga"), texel_alpha);
    (void)snprintf(rest, sizeof rest,
                   ONE_NODE "," TEXTURE("") ",\"materials\":[{\"name\":\"m\",%s," BASE(
                       "\"baseColorTexture\":{\"index\":0},\"baseColorFactor\":[1,1,1,0.75]") "}]",
                   alpha_mode);
    put_gltf(UVS, rest);
    import_good(FILE_OF("quad.gltf"), m);
}

static void alpha_modes_become_cut_outs_only_where_there_is_a_hole(void **state) {
    model m;
    (void)state;
    import_masked("\"alphaMode\":\"MASK\",\"alphaCutoff\":0.25", 0, &m);
    assert_true(m.materials[0].cutoff == 0.25f && m.materials[0].alpha == 0.75f);
    model_free(&m);
    import_masked("\"alphaMode\":\"MASK\",\"alphaCutoff\":0.25", 255, &m);
    assert_true(m.materials[0].cutoff == 0.0f);
    model_free(&m);
    import_masked("\"alphaMode\":\"BLEND\"", 0, &m);
    assert_true(m.materials[0].cutoff == 0.5f);
    model_free(&m);
    import_masked("\"alphaMode\":\"OPAQUE\"", 0, &m);
    assert_true(m.materials[0].cutoff == 0.0f);
    model_free(&m);
}

static void glass_alone_is_shown_with_one_warning(void **state) {
    model m;
    (void)state;
    put_gltf("", ONE_NODE "," MATERIAL("\"alphaMode\":\"BLEND\"," BASE("\"baseColorFactor\":[1,1,1,0.25]")));
    import_good(FILE_OF("quad.gltf"), &m);
    assert_true(m.triangles == 2 && m.warnings == 1);
    assert_non_null(strstr(last_warning, "shown opaque"));
    model_free(&m);
}

static void an_obj_of_d_below_one_half_is_left_out(void **state) {
    model m;
    (void)state;
    put(FILE_OF("quad.mtl"), "newmtl m\nKd 1 1 1\nd 0.25\nnewmtl n\nKd 1 1 1\nd 0.5\n");
    put(FILE_OF("quad.obj"), "mtllib quad.mtl\n" OBJ_QUAD "usemtl m\nf 1/1 2/2 3/3\nusemtl n\nf 1/1 3/3 4/4\n");
    import_good(FILE_OF("quad.obj"), &m);
    check_promises(&m);
    assert_true(m.triangles == 1 && m.material_count == 1 && m.warnings == 2);
    assert_non_null(strstr(warnings, "1 triangles of half transparent materials ('n') are shown opaque"));
    assert_string_equal(m.materials[0].name, "n");
    model_free(&m);
}

static void an_obj_cuts_out_by_the_alpha_of_its_own_texture(void **state) {
    model m;
    (void)state;
    put_image(FILE_OF("image.tga"), 0);
    put_obj("newmtl m\nKd 1 1 1\nmap_Kd image.tga\nmap_d image.tga\n");
    import_good(FILE_OF("quad.obj"), &m);
    assert_true(m.materials[0].cutoff == 0.5f && m.warnings == 0);
    model_free(&m);
    put_obj("newmtl m\nKd 1 1 1\nmap_Kd image.tga\nmap_d other.tga\n");
    import_good(FILE_OF("quad.obj"), &m);
    assert_true(m.materials[0].cutoff == 0.0f && m.warnings == 1);
    model_free(&m);
}

static void a_constant_vertex_colour_multiplies_and_a_varying_one_warns(void **state) {
    model m;
    (void)state;
    put_gltf(",\"COLOR_0\":3", ONE_NODE "," MATERIAL(BASE("\"baseColorFactor\":[0.5,0.5,0.5,1]")));
    import_good(FILE_OF("quad.gltf"), &m);
    assert_true(m.materials[0].albedo[0] == 0.25f && m.materials[0].albedo[1] == 0.125f && m.materials[0].albedo[2] == 0.5f);
    assert_int_equal(m.warnings, 0);
    model_free(&m);
    put_gltf(",\"COLOR_0\":4", ONE_NODE "," MATERIAL(BASE("\"baseColorFactor\":[0.5,0.5,0.5,1]")));
    import_good(FILE_OF("quad.gltf"), &m);
    assert_true(m.materials[0].albedo[0] == 0.5f && m.warnings == 1);
    model_free(&m);
}

static void materials_and_images_without_a_triangle_are_left_out(void **state) {
    model m;
    (void)state;
    put_obj("newmtl other\nKd 1 0 0\nmap_Kd nowhere.png\nnewmtl m\nKd 0 1 0\n");
    import_good(FILE_OF("quad.obj"), &m);
    assert_true(m.material_count == 1 && m.image_count == 0 && m.warnings == 0);
    assert_string_equal(m.materials[0].name, "m");
    model_free(&m);
}

static void the_scenes_materials_beat_the_meshs(void **state) {
    scene s;
    model m;
    vit_text why;
    (void)state;
    put_image(FILE_OF("image.tga"), 0);
    put_obj("newmtl m\nKd 0.5 0.5 0.5\nmap_Kd nowhere.png\n");
    put(FILE_OF("test.cfg"),
        "meshes = ( { file = \"quad.obj\"; } );\ncamera: { use = \"c\"; };\n"
        "materials = ( { name = \"m\"; color = (0.25, 0.5, 1); texture = \"image.tga\"; emission = (1, 2, 3);\n"
        "cutoff = 0.125; }, { name = \"typo\"; } );\n");
    assert_int_equal(scene_read(FILE_OF("test.cfg"), &s, &why), VIT_OK);
    assert_int_equal(model_import(&s, true, remember, NULL, &m, &why), VIT_BAD_INPUT);
    assert_non_null(strstr(why.text, "test.cfg: line 4: no mesh uses a material 'typo'; there is 'm'"));
    assert_int_equal(model_import(&s, false, remember, NULL, &m, &why), VIT_OK);
    const model_material *a = &m.materials[0];
    assert_true(a->albedo[0] == 0.25f && a->albedo[2] == 1.0f && a->emission[1] == 2.0f && a->cutoff == 0.125f &&
                a->image == 0);
    assert_int_equal(m.warnings, 1);
    assert_non_null(strstr(last_warning, "no mesh uses a material 'typo'; there is 'm'"));
    model_free(&m);
    scene_free(&s);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        T(an_obj_quad_has_v_0_in_the_first_row_of_its_image),
        T(a_gltf_quad_has_v_0_in_the_first_row_of_its_image),
        T(a_texture_may_name_the_second_uv_set_and_its_wrap_modes),
        T(a_texture_transform_moves_the_uv),
        T(an_embedded_image_is_decoded),
        T(backslashes_percent_signs_and_foreign_folders_find_their_texture),
        T(names_are_found_in_any_case),
        T(a_missing_texture_is_a_warning_and_the_plain_colour),
        T(a_missing_texture_is_refused_if_strict),
        T(an_image_that_promises_more_than_its_bytes_can_hold_is_broken),
        T(a_broken_texture_is_a_warning),
        T(a_texture_of_20000_pixels_is_not_decoded),
        T(colours_and_emission_of_gltf_are_linear_factors),
        T(an_obj_emits_its_ke),
        T(alpha_modes_become_cut_outs_only_where_there_is_a_hole),
        T(glass_alone_is_shown_with_one_warning),
        T(an_obj_of_d_below_one_half_is_left_out),
        T(an_obj_cuts_out_by_the_alpha_of_its_own_texture),
        T(a_constant_vertex_colour_multiplies_and_a_varying_one_warns),
        T(materials_and_images_without_a_triangle_are_left_out),
        T(the_scenes_materials_beat_the_meshs),
    };
    return cmocka_run_group_tests(tests, make_folder, NULL);
}
