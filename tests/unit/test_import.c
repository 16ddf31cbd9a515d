/* The importer. What is hard: meshes come from strangers, in formats that disagree on where v = 0 is, what alpha means and
 * whether a normal is there at all, and through a library whose releases differ. Strategy: tiny OBJ, PLY and glTF files that
 * the tests write themselves, each of which shows one rule in numbers that can be worked out by hand (a unit quad, an image of
 * two by two texels); then, where the test scenes are at hand (VITRINE_SCENES or ../shared/scenes), real and malformed files,
 * whose triangle counts were taken independently. Without them those tests are skipped. */
#include "import/model.h"
#include "vitrine_pack.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>
#include <cmocka.h>

#define FOLDER VIT_BUILD_DIR "/tests/unit/import_files"
#define FILE_OF(name) FOLDER "/" name

/* ---- files made here ---- */

static void put_bytes(const char *path, const void *bytes, size_t size) {
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(bytes, 1, size, file), size);
    assert_int_equal(fclose(file), 0);
}

static void put(const char *path, const char *text) {
    put_bytes(path, text, strlen(text));
}

/* A TGA of two by two texels: red green over blue white, the last with alpha `alpha`. Returns its size. */
static size_t make_image(uint8_t out[34], uint8_t alpha) {
    static const uint8_t head[18] = {0, 0, 2, 0, 0, 0, 0, 0, 0, 0, 0, 0, 2, 0, 2, 0, 32, 0x28}; /* 0x28: rows from the top */
    static const uint8_t bgra[16] = {0, 0, 255, 255, 0, 255, 0, 255, 255, 0, 0, 255, 255, 255, 255, 255};
    memcpy(out, head, sizeof head);
    memcpy(out + 18, bgra, sizeof bgra);
    out[33] = alpha;
    return 34;
}

static void put_image(const char *path, uint8_t alpha) {
    uint8_t bytes[34];
    put_bytes(path, bytes, make_image(bytes, alpha));
}

static void put_floats(uint8_t *at, const float *values, size_t count) {
    for (size_t i = 0; i < count; i++) {
        uint32_t word;
        memcpy(&word, &values[i], sizeof word);
        for (size_t k = 0; k < 4; k++)
            at[4 * i + k] = (uint8_t)(word >> (8 * k));
    }
}

/* quad.gltf: the unit square in z = 0 with uv 0 upright (top left is (0, 0)), uv 1 = half of uv 0, accessor 3 a constant
 * colour, accessor 4 a varying one, buffer view 6 an image. `attributes` goes behind POSITION, `rest` into the top level. */
static void put_gltf(const char *attributes, const char *rest) {
    static const float position[12] = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
    static const float uv0[8] = {0, 1, 1, 1, 1, 0, 0, 0}, uv1[8] = {0, 0.5f, 0.5f, 0.5f, 0.5f, 0, 0, 0};
    static const float constant[12] = {0.5f, 0.25f, 1, 0.5f, 0.25f, 1, 0.5f, 0.25f, 1, 0.5f, 0.25f, 1};
    static const float varying[12] = {1, 0, 0, 0, 1, 0, 0, 0, 1, 1, 1, 1};
    static const uint8_t index[12] = {0, 0, 1, 0, 2, 0, 0, 0, 2, 0, 3, 0};
    uint8_t bin[256] = {0};
    char json[8192];
    put_floats(bin, position, 12);
    put_floats(bin + 48, uv0, 8);
    put_floats(bin + 80, uv1, 8);
    put_floats(bin + 112, constant, 12);
    put_floats(bin + 160, varying, 12);
    memcpy(bin + 208, index, sizeof index);
    (void)make_image(bin + 220, 255);
    put_bytes(FILE_OF("quad.bin"), bin, sizeof bin);
    const int used = snprintf(
        json, sizeof json,
        "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"buffers\":[{\"uri\":\"quad.bin\",\"byteLength\":256}],\"bufferViews\":["
        "{\"buffer\":0,\"byteOffset\":0,\"byteLength\":48},{\"buffer\":0,\"byteOffset\":48,\"byteLength\":32},"
        "{\"buffer\":0,\"byteOffset\":80,\"byteLength\":32},{\"buffer\":0,\"byteOffset\":112,\"byteLength\":48},"
        "{\"buffer\":0,\"byteOffset\":160,\"byteLength\":48},{\"buffer\":0,\"byteOffset\":208,\"byteLength\":12},"
        "{\"buffer\":0,\"byteOffset\":220,\"byteLength\":34}],\"accessors\":["
        "{\"bufferView\":0,\"componentType\":5126,\"count\":4,\"type\":\"VEC3\",\"min\":[0,0,0],\"max\":[1,1,0]},"
        "{\"bufferView\":1,\"componentType\":5126,\"count\":4,\"type\":\"VEC2\"},"
        "{\"bufferView\":2,\"componentType\":5126,\"count\":4,\"type\":\"VEC2\"},"
        "{\"bufferView\":3,\"componentType\":5126,\"count\":4,\"type\":\"VEC3\"},"
        "{\"bufferView\":4,\"componentType\":5126,\"count\":4,\"type\":\"VEC3\"},"
        "{\"bufferView\":5,\"componentType\":5123,\"count\":6,\"type\":\"SCALAR\"}],"
        "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0%s},\"indices\":5,\"material\":0}]}],%s}",
        attributes, rest);
    assert_true(used > 0 && (size_t)used < sizeof json);
    put(FILE_OF("quad.gltf"), json);
}

#define ONE_NODE "\"scenes\":[{\"nodes\":[0]}],\"nodes\":[{\"mesh\":0}]"
#define UVS ",\"TEXCOORD_0\":1,\"TEXCOORD_1\":2"
#define TEXTURE(sampler)                                                                                                       \
    "\"textures\":[{\"source\":0,\"sampler\":0}],\"samplers\":[{" sampler "}],\"images\":[{\"uri\":\"image.tga\"}]"
#define MATERIAL(text) "\"materials\":[{\"name\":\"m\"," text "}]"
#define BASE(text) "\"pbrMetallicRoughness\":{" text "}"

/* ---- importing ---- */

static char last_warning[1024];

static void remember(void *user, const char *line) {
    (void)user;
    assert_null(strchr(line, '\n'));
    (void)snprintf(last_warning, sizeof last_warning, "%s", line);
}

static vit_status import_file(const char *path, bool strict, model *m, vit_text *why) {
    scene s;
    *why = (vit_text){{0}};
    last_warning[0] = '\0';
    assert_int_equal(scene_for_mesh(path, &s, why), VIT_OK);
    const vit_status status = model_import(&s, strict, remember, NULL, m, why);
    scene_free(&s);
    return status;
}

static void import_good(const char *path, model *m) {
    vit_text why;
    const vit_status status = import_file(path, false, m, &why);
    if (status != VIT_OK)
        print_error("%s\n", why.text);
    assert_int_equal(status, VIT_OK);
}

static void refuse(const char *path, bool strict, const char *what) {
    model m;
    vit_text why;
    assert_int_equal(import_file(path, strict, &m, &why), VIT_BAD_INPUT);
    if (strncmp(why.text, path, strlen(path)) != 0 || !strstr(why.text, what))
        print_error("expected '%s' in '%s'\n", what, why.text);
    assert_int_equal(strncmp(why.text, path, strlen(path)), 0);
    assert_non_null(strstr(why.text, what));
    assert_null(strchr(why.text, '\n'));
}

/* What model.h promises of every model. */
static void check_promises(const model *m) {
    uint64_t uses = 0;
    assert_true(m->triangles >= 1 && m->material_count >= 1 && m->vertices >= 1);
    for (size_t i = 0; i < m->vertices; i++) {
        const float *p = m->position + 3 * i, *n = m->normal + 3 * i, *t = m->uv + 2 * i;
        assert_true(isfinite(p[0]) && isfinite(p[1]) && isfinite(p[2]) && isfinite(t[0]) && isfinite(t[1]));
        assert_true(fabs(sqrt((double)(n[0] * n[0] + n[1] * n[1] + n[2] * n[2])) - 1.0) < 1e-5);
        for (size_t k = 0; k < 3; k++)
            assert_true((double)p[k] >= m->lo[k] && (double)p[k] <= m->hi[k]);
    }
    for (size_t i = 0; i < m->triangles; i++) {
        const uint32_t *v = m->index + 3 * i;
        assert_true(v[0] < m->vertices && v[1] < m->vertices && v[2] < m->vertices);
        assert_true(m->material[i] < (uint32_t)m->material_count);
    }
    for (int i = 0; i < m->material_count; i++) {
        assert_true(m->materials[i].triangles > 0 && m->materials[i].image < m->image_count);
        for (int k = 0; k < 3; k++)
            assert_true(m->materials[i].albedo[k] >= 0.0f && m->materials[i].albedo[k] <= VIT_MAX_ALBEDO);
        uses += m->materials[i].triangles;
    }
    assert_true(uses == m->triangles);
}

/* The vertex nearest to (x, y, z). */
static size_t vertex_at(const model *m, float x, float y, float z) {
    size_t best = 0;
    float least = INFINITY;
    for (size_t i = 0; i < m->vertices; i++) {
        const float *p = m->position + 3 * i;
        const float d = (p[0] - x) * (p[0] - x) + (p[1] - y) * (p[1] - y) + (p[2] - z) * (p[2] - z);
        if (d < least) {
            least = d;
            best = i;
        }
    }
    assert_true(least < 1e-8f);
    return best;
}

static void uv_at(const model *m, float x, float y, float u, float v) {
    const float *uv = m->uv + 2 * vertex_at(m, x, y, 0.0f);
    if (fabsf(uv[0] - u) > 1e-5f || fabsf(uv[1] - v) > 1e-5f)
        print_error("at (%g, %g): uv (%g, %g), expected (%g, %g)\n", (double)x, (double)y, (double)uv[0], (double)uv[1],
                    (double)u, (double)v);
    assert_true(fabsf(uv[0] - u) <= 1e-5f && fabsf(uv[1] - v) <= 1e-5f);
}

static void normal_at(const model *m, float x, float y, float z, float nx, float ny, float nz) {
    const float *n = m->normal + 3 * vertex_at(m, x, y, z);
    assert_true(fabsf(n[0] - nx) < 1e-5f && fabsf(n[1] - ny) < 1e-5f && fabsf(n[2] - nz) < 1e-5f);
}

/* ---- texture coordinates and images ---- */

#define OBJ_QUAD "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
#define OBJ_FACES "f 1/1 2/2 3/3\nf 1/1 3/3 4/4\n"

static void put_obj(const char *mtl) {
    put(FILE_OF("quad.mtl"), mtl);
    put(FILE_OF("quad.obj"), "mtllib quad.mtl\n" OBJ_QUAD "usemtl m\n" OBJ_FACES);
}

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
    (void)mkdir(FILE_OF("textures"), 0777);
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
    assert_true(m.triangles == 1 && m.material_count == 1 && m.warnings == 1);
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

/* ---- geometry ---- */

static void nodes_instances_and_the_scene_place_the_triangles(void **state) {
    scene s;
    model m;
    vit_text why;
    (void)state;
    put_gltf("", "\"scenes\":[{\"nodes\":[0]}],\"nodes\":[{\"translation\":[10,0,0],\"children\":[1,2]},{\"mesh\":0},"
                 "{\"mesh\":0,\"scale\":[1,2,1],\"translation\":[0,5,0]}]," MATERIAL(BASE("")));
    put(FILE_OF("test.cfg"),
        "meshes = ( { file = \"quad.gltf\"; translate = (0, 0, 7); }, { file = \"quad.gltf\"; scale = 0.5; } );\n"
        "camera: { use = \"c\"; };\n");
    assert_int_equal(scene_read(FILE_OF("test.cfg"), &s, &why), VIT_OK);
    assert_int_equal(model_import(&s, false, NULL, NULL, &m, &why), VIT_OK);
    check_promises(&m);
    assert_int_equal(m.triangles, 8);
    (void)vertex_at(&m, 11, 1, 7);
    (void)vertex_at(&m, 10, 7, 7);
    (void)vertex_at(&m, 5.5f, 3.5f, 0);
    assert_true(m.lo[0] == 5.0 && m.hi[0] == 11.0 && m.lo[1] == 0.0 && m.hi[1] == 7.0 && m.hi[2] == 7.0);
    model_free(&m);
    scene_free(&s);
}

/* (v1 - v0) x (v2 - v0), z. */
static float winding(const model *m, size_t t) {
    const float *a = m->position + 3 * m->index[3 * t], *b = m->position + 3 * m->index[3 * t + 1];
    const float *c = m->position + 3 * m->index[3 * t + 2];
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

static void a_mirrored_node_keeps_its_front_in_front(void **state) {
    model m;
    (void)state;
    put_gltf("", "\"scenes\":[{\"nodes\":[0]}],\"nodes\":[{\"mesh\":0,\"scale\":[-1,1,1]}]," MATERIAL(BASE("")));
    import_good(FILE_OF("quad.gltf"), &m);
    assert_true(m.lo[0] == -1.0 && m.hi[0] == 0.0);
    assert_true(winding(&m, 0) > 0.0f && winding(&m, 1) > 0.0f);
    normal_at(&m, -1, 0, 0, 0, 0, 1);
    model_free(&m);
}

/* Normals of the file under scale (1, 4, 1): (0, 0.6, 0.8) becomes (0, 0.15, 0.8), normalised; mirrored in x, (1, 0, 0) turns.
 */
static void normals_go_by_the_inverse_transpose(void **state) {
    scene s;
    model m;
    vit_text why;
    (void)state;
    put(FILE_OF("n.obj"), "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0.6 0.8\nvn 1 0 0\nvn 0 0 0\nf 1//1 2//2 3//3\n");
    put(FILE_OF("test.cfg"), "meshes = ( { file = \"n.obj\"; scale = [-1.0, 4.0, 1.0]; } );\ncamera: { use = \"c\"; };\n");
    assert_int_equal(scene_read(FILE_OF("test.cfg"), &s, &why), VIT_OK);
    assert_int_equal(model_import(&s, false, NULL, NULL, &m, &why), VIT_OK);
    const float length = sqrtf(0.15f * 0.15f + 0.64f);
    normal_at(&m, 0, 0, 0, 0, 0.15f / length, 0.8f / length);
    normal_at(&m, -1, 0, 0, -1, 0, 0);
    normal_at(&m, 0, 4, 0, 0, 0, 1); /* a normal of no length: the face's */
    model_free(&m);
    scene_free(&s);
}

static void missing_normals_are_smooth_over_a_flat_ridge(void **state) {
    model m;
    (void)state;
    /* Two faces that fall by 45 degrees in all (slopes of 22.5 to each side of the ridge x = 0). */
    put(FILE_OF("ridge.obj"), "v 0 0 0\nv 0 0 1\nv 1 -0.41421356 0\nv -1 -0.41421356 0\nf 1 2 3\nf 1 4 2\n");
    import_good(FILE_OF("ridge.obj"), &m);
    check_promises(&m);
    normal_at(&m, 0, 0, 0, 0, 1, 0);
    normal_at(&m, 0, 0, 1, 0, 1, 0);
    normal_at(&m, 1, -0.41421356f, 0, 0.38268343f, 0.92387953f, 0);
    model_free(&m);
}

static void missing_normals_keep_an_edge_of_90_degrees(void **state) {
    model m;
    (void)state;
    put(FILE_OF("edge.obj"), "v 0 0 0\nv 0 0 1\nv 1 0 0\nv 0 -1 0\nf 1 2 3\nf 1 4 2\n");
    import_good(FILE_OF("edge.obj"), &m);
    for (size_t t = 0; t < m.triangles; t++)
        for (size_t k = 0; k < 3; k++) {
            const float *n = m.normal + 3 * m.index[3 * t + k];
            assert_true(fmaxf(fabsf(n[0]), fabsf(n[1])) > 0.99999f);
        }
    model_free(&m);
}

static void triangles_without_area_are_dropped_and_counted(void **state) {
    model m;
    (void)state;
    put(FILE_OF("flat.obj"), "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 2 0 0\nv 1 0 0\nf 1 2 3\nf 1 2 4\nf 1 2 5\nf 3 3 1\n");
    import_good(FILE_OF("flat.obj"), &m);
    assert_true(m.triangles == 1 && m.degenerate == 3 && m.warnings == 0);
    model_free(&m);
}

static void triangles_that_are_not_finite_are_dropped_with_one_warning(void **state) {
    model m;
    (void)state;
    put(FILE_OF("nan.obj"), "v 0 0 0\nv 1 0 0\nv 1 1 0\nv nan 0 0\nv 0 inf 0\nf 1 2 3\nf 1 2 4\nf 1 2 5\n");
    import_good(FILE_OF("nan.obj"), &m);
    assert_true(m.triangles == 1 && m.not_finite == 2 && m.warnings == 1 && m.hi[0] == 1.0);
    assert_non_null(strstr(last_warning, "nan.obj: 2 triangles"));
    model_free(&m);
}

static void triangles_that_go_too_far_out_are_dropped_with_one_warning(void **state) {
    model m;
    (void)state;
    put(FILE_OF("far.obj"),
        "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 -1e30 0\nv 2e9 0 0\nv 1e9 0 0\nf 1 2 3\nf 1 2 4\nf 1 3 5\nf 1 3 6\n");
    import_good(FILE_OF("far.obj"), &m);
    assert_true(m.triangles == 2 && m.not_finite == 0 && m.warnings == 1 && m.lo[1] == 0.0 && m.hi[0] == 1e9);
    assert_non_null(
        strstr(last_warning, "far.obj: 2 triangles with a vertex farther out than 1e+09 m dropped, one at 1e+30 m"));
    model_free(&m);
    put(FILE_OF("far.obj"), "v 0 0 0\nv 1 0 0\nv 1e30 1 0\nf 1 2 3\n");
    refuse(FILE_OF("far.obj"), false, "has no triangle nearer than 1e+09 m: a vertex is at 1e+30 m");
}

static void points_and_lines_are_dropped_and_counted(void **state) {
    model m;
    (void)state;
    put(FILE_OF("mixed.obj"), "v 0 0 0\nv 1 0 0\nv 1 1 0\np 1\nl 1 2\nf 1 2 3\n");
    import_good(FILE_OF("mixed.obj"), &m);
    assert_true(m.triangles == 1 && m.not_triangles == 2);
    model_free(&m);
}

static void a_ply_without_normals_is_imported(void **state) {
    model m;
    (void)state;
    put(FILE_OF("a.ply"),
        "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
        "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n");
    import_good(FILE_OF("a.ply"), &m);
    check_promises(&m);
    assert_int_equal(m.triangles, 2);
    normal_at(&m, 0, 1, 0, 0, 0, 1);
    model_free(&m);
}

static void importing_twice_gives_the_same_bytes(void **state) {
    model a, b;
    (void)state;
    put_image(FILE_OF("image.tga"), 255);
    put_obj("newmtl m\nKd 0.5 0.25 1\nmap_Kd image.tga\n");
    import_good(FILE_OF("quad.obj"), &a);
    import_good(FILE_OF("quad.obj"), &b);
    assert_true(a.vertices == b.vertices && a.triangles == b.triangles);
    assert_memory_equal(a.position, b.position, 12 * (size_t)a.vertices);
    assert_memory_equal(a.normal, b.normal, 12 * (size_t)a.vertices);
    assert_memory_equal(a.uv, b.uv, 8 * (size_t)a.vertices);
    assert_memory_equal(a.index, b.index, 12 * (size_t)a.triangles);
    assert_memory_equal(a.material, b.material, 4 * (size_t)a.triangles);
    model_free(&a);
    model_free(&b);
}

/* ---- cameras and lights ---- */

#define LIGHTS(text)                                                                                                           \
    "\"extensionsUsed\":[\"KHR_lights_punctual\"],\"extensions\":{\"KHR_lights_punctual\":{\"lights\":[" text "]}},"

static void a_camera_stands_where_its_node_is(void **state) {
    model m;
    (void)state;
    /* The node is turned by 90 degrees about y: -z becomes -x. */
    put_gltf("",
             "\"scenes\":[{\"nodes\":[0,1]}],\"nodes\":[{\"mesh\":0},{\"name\":\"Cam\",\"camera\":0,\"translation\":[1,2,3],"
             "\"rotation\":[0,0.70710678,0,0.70710678]}],\"cameras\":[{\"type\":\"perspective\",\"perspective\":"
             "{\"yfov\":1.0,\"aspectRatio\":2.0,\"znear\":0.1,\"zfar\":10}}]," MATERIAL(BASE("")));
    import_good(FILE_OF("quad.gltf"), &m);
    assert_int_equal(m.camera_count, 1);
    const model_camera *c = &m.cameras[0];
    assert_string_equal(c->name, "Cam");
    assert_true(c->eye[0] == 1.0 && c->eye[1] == 2.0 && c->eye[2] == 3.0);
    assert_true(fabs(c->target[0] - 0.0) < 1e-6 && fabs(c->target[1] - 2.0) < 1e-6 && fabs(c->target[2] - 3.0) < 1e-6);
    assert_true(fabs(c->up[1] - 1.0) < 1e-6 && fabs(c->fov - 57.29577951) < 1e-3);
    model_free(&m);
}

static void an_orthographic_camera_is_warned_of(void **state) {
    model m;
    (void)state;
    put_gltf("", "\"scenes\":[{\"nodes\":[0,1]}],\"nodes\":[{\"mesh\":0},{\"name\":\"Cam\",\"camera\":0}],"
                 "\"cameras\":[{\"type\":\"orthographic\","
                 "\"orthographic\":{\"xmag\":2,\"ymag\":1,\"znear\":0.1,\"zfar\":10}}]," MATERIAL(BASE("")));
    import_good(FILE_OF("quad.gltf"), &m);
    assert_true(m.camera_count == 1 && m.cameras[0].fov == 0.0 && m.warnings == 1);
    assert_non_null(strstr(last_warning, "camera 'Cam' is orthographic"));
    model_free(&m);
}

static void lights_have_their_power_cone_and_range(void **state) {
    model m;
    (void)state;
#define LIT_NODE(name, more, light)                                                                                            \
    "{\"name\":\"" name "\"," more "\"extensions\":{\"KHR_lights_punctual\":{\"light\":" light "}}}"
    /* clang-format off */
    put_gltf("",
             LIGHTS("{\"type\":\"point\",\"color\":[1,0.5,0.25],\"intensity\":8},"
                    "{\"type\":\"spot\",\"intensity\":1,\"range\":6,"
                    "\"spot\":{\"innerConeAngle\":0.25,\"outerConeAngle\":0.5}},"
                    "{\"type\":\"directional\",\"color\":[1,0.5,0.25],\"intensity\":3}")
             "\"scenes\":[{\"nodes\":[0,1,2,3]}],\"nodes\":[{\"mesh\":0},"
             LIT_NODE("Bulb", "\"translation\":[0,2,0],", "0") ","
             LIT_NODE("Spot", "\"rotation\":[-0.70710678,0,0,0.70710678],", "1") ","
             LIT_NODE("Sun", "\"rotation\":[-0.70710678,0,0,0.70710678],", "2") "],"
             MATERIAL(BASE("")));
    /* clang-format on */
    import_good(FILE_OF("quad.gltf"), &m);
    assert_true(m.light_count == 3 && m.warnings == 0);
    const model_light *bulb = &m.lights[0], *spot = &m.lights[1], *sun = &m.lights[2];
    const double watts = 4.0 * 3.14159265358979 * 8.0 / 683.0, lux = 1.0 / 683.0;
    assert_string_equal(bulb->name, "Bulb");
    assert_true(bulb->kind == VIT_LIGHT_POINT && bulb->position[1] == 2.0 && bulb->range == 0.0);
    assert_true(fabs(bulb->power[0] - watts) < 1e-6 && fabs(bulb->power[2] - 0.25 * watts) < 1e-6 && bulb->stated[0] == 8.0);
    assert_true(spot->kind == VIT_LIGHT_SPOT && spot->range == 6.0 && fabs(spot->direction[1] + 1.0) < 1e-6);
    assert_true(fabs(spot->inner - 14.3239449) < 1e-4 && fabs(spot->outer - 28.6478898) < 1e-4);
    assert_true(sun->kind == VIT_LIGHT_DIRECTIONAL && sun->range == 0.0 && fabs(sun->direction[1] + 1.0) < 1e-6);
    assert_true(fabs(sun->power[0] - 3.0 * lux) < 1e-9 && fabs(sun->power[1] - 1.5 * lux) < 1e-9 &&
                fabs(sun->power[2] - 0.75 * lux) < 1e-9);
    model_free(&m);
}

/* Blender up to 3.5 turns lamps and cameras by a node of its own below the one that the user named. */
static void lights_and_cameras_answer_to_the_node_above(void **state) {
    model m;
    (void)state;
    /* clang-format off */
    put_gltf("",
             LIGHTS("{\"type\":\"point\"},{\"type\":\"point\",\"intensity\":2}")
             "\"scenes\":[{\"nodes\":[0,1,3,5]}],\"nodes\":[{\"mesh\":0},{\"name\":\"Lamp\",\"children\":[2]},"
             LIT_NODE("Lamp_Orientation", "", "0")
             ",{\"name\":\"Eye\",\"children\":[4]},{\"name\":\"Eye_Orientation\",\"camera\":0},"
             LIT_NODE("Other", "", "1")
             "],\"cameras\":[{\"type\":\"perspective\",\"perspective\":{\"yfov\":1.0,\"znear\":0.1}}],"
             MATERIAL(BASE("")));
    /* clang-format on */
    import_good(FILE_OF("quad.gltf"), &m);
    assert_true(m.light_count == 2 && m.camera_count == 1);
    assert_ptr_equal(model_light_named(&m, "Lamp"), model_light_named(&m, "Lamp_Orientation"));
    assert_string_equal(model_light_named(&m, "Lamp")->name, "Lamp_Orientation");
    assert_true(model_light_named(&m, "Other")->stated[0] == 2.0 && !model_light_named(&m, "Lam"));
    assert_ptr_equal(model_camera_named(&m, "Eye"), &m.cameras[0]);
    assert_ptr_equal(model_camera_named(&m, "Eye_Orientation"), &m.cameras[0]);
    assert_null(model_camera_named(&m, "Lamp"));
    model_free(&m);
}

/* ---- files that are not good ---- */

static void a_file_without_a_triangle_is_refused(void **state) {
    (void)state;
    put(FILE_OF("none.obj"), "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n# and not a triangle more\n");
    refuse(FILE_OF("none.obj"), false, "has no triangle");
}

static void a_missing_mesh_is_refused(void **state) {
    (void)state;
    refuse(FILE_OF("nowhere.obj"), false, "is not there");
    refuse(FOLDER, false, "is a folder");
}

static void a_missing_material_file_is_a_warning_or_an_error_if_strict(void **state) {
    model m;
    (void)state;
    put(FILE_OF("lost.obj"), "mtllib gone.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl x\nf 1 2 3\n");
    import_good(FILE_OF("lost.obj"), &m);
    assert_int_equal(m.warnings, 1);
    assert_non_null(strstr(last_warning, "lost.obj: its material file 'gone.mtl' is not there"));
    model_free(&m);
    refuse(FILE_OF("lost.obj"), true, "its material file 'gone.mtl' is not there");
    put(FILE_OF("gone.mtl"), "newmtl x\nKd 1 1 1\n");
    import_good(FILE_OF("lost.obj"), &m);
    assert_int_equal(m.warnings, 0);
    assert_true(inputs_hold(&m.files, FILE_OF("gone.mtl")));
    model_free(&m);
    assert_int_equal(unlink(FILE_OF("gone.mtl")), 0);
}

static void files_of_no_known_kind_are_refused(void **state) {
    (void)state;
    put(FILE_OF("a.xyz"), "hello");
    put(FILE_OF("bad.gltf"), "{\"asset\":{\"version\":\"2.0\"},\"nodes\":[");
    put(FILE_OF("bad.glb"), "glTF\x02");
    refuse(FILE_OF("a.xyz"), false, "");
    refuse(FILE_OF("bad.gltf"), false, "");
    refuse(FILE_OF("bad.glb"), false, "");
}

/* In a tilted plane, from either side: n - 2 triangles, which cover the area of the outline once. */
static void assert_cut(double (*outline)[2], size_t n, bool backwards) {
    char text[8192];
    size_t used = 0;
    double area = 0.0, sum = 0.0, sides[3] = {0.0, 0.0, 0.0};
    model m;
    for (size_t i = 0; i < n; i++) {
        const double *p = outline[i], *q = outline[(i + 1) % n];
        used += (size_t)snprintf(text + used, sizeof text - used, "v %.9g %.9g %.9g\n", p[0], 0.6 * p[1], 0.8 * p[1]);
        area += (p[0] * q[1] - p[1] * q[0]) / 2.0;
    }
    used += (size_t)snprintf(text + used, sizeof text - used, "f");
    for (size_t i = 0; i < n; i++)
        used += (size_t)snprintf(text + used, sizeof text - used, " %zu", backwards ? n - i : i + 1);
    assert_true(area > 0.0 && used < sizeof text - 2);
    put(FILE_OF("polygon.obj"), strcat(text, "\n"));
    import_good(FILE_OF("polygon.obj"), &m);
    check_promises(&m);
    assert_int_equal(m.triangles + m.degenerate, n - 2);
    for (size_t t = 0; t < m.triangles; t++) {
        const float *a = m.position + 3 * (size_t)m.index[3 * t], *b = m.position + 3 * (size_t)m.index[3 * t + 1];
        const float *c = m.position + 3 * (size_t)m.index[3 * t + 2];
        double square = 0.0;
        for (int k = 0; k < 3; k++) {
            const int u = (k + 1) % 3, v = (k + 2) % 3;
            const double twice = (double)(b[u] - a[u]) * (double)(c[v] - a[v]) - (double)(b[v] - a[v]) * (double)(c[u] - a[u]);
            square += twice * twice;
            sides[k] += twice / 2.0;
        }
        sum += sqrt(square) / 2.0;
    }
    assert_true(fabs(sum - area) < 1e-5 * area);
    assert_true(fabs((0.6 * sides[2] - 0.8 * sides[1]) - (backwards ? -area : area)) < 1e-5 * area);
    model_free(&m);
}

/* Assimp 5.3 leaves out parts of such polygons. */
static void polygons_that_are_not_convex_are_cut_whole(void **state) {
    (void)state;
    enum { POINTS = 34, TEETH = 16 };
    double ring[][2] = {{0, 0}, {3, 0}, {3, 3}, {0, 3}, {0, 0}, {1, 1}, {1, 2}, {2, 2}, {2, 1}, {1, 1}};
    double house[][2] = {{0, 0}, {1, 0}, {2, 0}, {2, 1}, {1, 1.5}, {0, 1}};
    double star[POINTS][2], comb[4 * TEETH][2];
    for (int i = 0; i < POINTS; i++) {
        const double angle = 2.0 * 3.14159265358979 * i / POINTS, r = i % 2 ? 0.3 : 1.0;
        star[i][0] = r * cos(angle);
        star[i][1] = r * sin(angle);
    }
    for (int i = 0; i < 2 * TEETH; i++) { /* teeth up in a wave and back along it, so that no line across sees it all */
        const double x = i, y = 4.0 * sin(0.4 * i) + (i % 2 ? 3.0 : 0.0);
        comb[i][0] = comb[4 * TEETH - 1 - i][0] = x;
        comb[i][1] = y;
        comb[4 * TEETH - 1 - i][1] = y + 1.0;
    }
    for (int side = 0; side < 2; side++) {
        assert_cut(star, POINTS, side == 1);
        assert_cut(comb, 4 * TEETH, side == 1);
        assert_cut(ring, sizeof ring / sizeof ring[0], side == 1);
        assert_cut(house, sizeof house / sizeof house[0], side == 1);
    }
}

/* Assimp 5.4 cuts off no corner that is nearly straight, and drops what is left when it finds no other: more than half of
 * these. */
static void polygons_with_nearly_straight_corners_are_cut_whole(void **state) {
    enum { ROUND = 24 };
    double ring[2 * ROUND + 2][2];
    double strip[][2] = {{0, 0}, {4, 0}, {4, 0.001}, {3, 0.0011}, {2, 0.0011}, {1, 0.0011}, {0, 0.001}};
    (void)state;
    for (int i = 0; i < 2 * ROUND + 2; i++) { /* round, in by a pair of edges, back round the hole */
        const double angle = 2.0 * 3.14159265358979 * ((i <= ROUND ? i : 2 * ROUND + 1 - i) % ROUND) / ROUND;
        ring[i][0] = (i <= ROUND ? 1.0 : 0.8) * cos(angle);
        ring[i][1] = (i <= ROUND ? 1.0 : 0.8) * sin(angle);
    }
    for (int side = 0; side < 2; side++) {
        assert_cut(ring, 2 * ROUND + 2, side == 1);
        assert_cut(strip, sizeof strip / sizeof strip[0], side == 1);
    }
}

static void a_ply_with_a_broken_header_is_refused(void **state) {
    (void)state;
    put(FILE_OF("b.ply"), "ply\nformat ascii 1.0\nelement vertex 0\nend_headr\n");
    refuse(FILE_OF("b.ply"), false, "line 4: not a PLY header");
    put(FILE_OF("b.ply"), "ply\nformat ascii 1.0\nelement vertex 0\n");
    refuse(FILE_OF("b.ply"), false, "the PLY header has no end");
    put(FILE_OF("b.ply"), "");
    refuse(FILE_OF("b.ply"), false, "is no PLY file");
}

/* ---- the test scenes ---- */

static const char *scene_path(const char *name) {
    static char path[SCENE_PATH];
    const char *folder = getenv("VITRINE_SCENES");
    (void)snprintf(path, sizeof path, "%s/%s", folder ? folder : "../shared/scenes", name);
    if (access(path, R_OK) == 0)
        return path;
    print_message("%s is not here: skipped\n", path);
    skip();
    return NULL;
}

/* Triangles of the file, points and lines, textures in use; counted by other means. */
static void counts(const char *name, uint64_t triangles, uint64_t other, int images) {
    model m;
    const char *path = scene_path(name);
    import_good(path, &m);
    check_promises(&m);
    if (m.triangles + m.degenerate != triangles)
        print_error("%s: %u + %u triangles\n", name, m.triangles, (unsigned)m.degenerate);
    assert_true(m.triangles + m.degenerate == triangles && m.not_triangles == other && m.image_count == images);
    model_free(&m);
}

static void real_scenes_have_the_triangles_that_others_counted(void **state) {
    (void)state;
    counts("sponza/sponza.gltf", 262267, 0, 24);
    counts("sibenik/sibenik.obj", 80479, 0, 3);
    counts("cornell_box/CornellBox-Original.obj", 36, 0, 0);
    counts("cornell_box/CornellBox-Glossy.obj", 1112, 0, 0);
    counts("stanford/bun_zipper.ply", 69451, 0, 0);
    counts("stanford/DragonAttenuation/DragonAttenuation.gltf", 134995, 0, 1);
}

static void all_but_the_glass_of_the_kitchen_is_there(void **state) {
    model m;
    (void)state;
    import_good(scene_path("country_kitchen/country_kitchen.gltf"), &m);
    check_promises(&m);
    assert_true(m.triangles + m.degenerate + 3434 == 251099 && m.image_count == 11);
    model_free(&m);
}

static void gltf_samples_have_their_triangles_and_textures(void **state) {
    (void)state;
    counts("gltf/BoxTextured/BoxTextured.gltf", 12, 0, 1);
    counts("gltf/Duck/Duck.gltf", 4212, 0, 1);
    counts("gltf/TextureSettingsTest/TextureSettingsTest.gltf", 72, 0, 3);
    counts("gltf/TextureTransformTest/TextureTransformTest.gltf", 24, 0, 5);
    counts("gltf/MultiUVTest/MultiUVTest.gltf", 12, 0, 1);
    counts("gltf/VertexColorTest/VertexColorTest.gltf", 36, 0, 2);
    counts("gltf/SimpleSparseAccessor/SimpleSparseAccessor.gltf", 12, 0, 0);
    counts("gltf/CubeScaledInstances/cube_att.gltf", 48, 0, 0);
    counts("gltf/CesiumMilkTruck/CesiumMilkTruck.gltf", 3624, 0, 1);
    counts("gltf/Lantern/Lantern.gltf", 5394, 0, 1);
    counts("odd/testmixed.obj", 12, 42, 0);
    counts("odd/concave_polygon.obj", 64, 0, 0);
    counts("odd/deg_faces.obj", 4, 0, 0);
    counts("odd/partial_materials/three_meshes_two_materials_one_no_material.gltf", 36, 0, 2);
    counts("odd/PrimitiveMode/Mesh_PrimitiveMode_05.gltf", 2, 0, 0);
    counts("odd/PrimitiveMode/Mesh_PrimitiveMode_06.gltf", 2, 0, 0);
    counts("odd/IndexOutOfRange/IndexOutOfRange.gltf", 11, 0, 0);
}

static void malformed_files_are_refused_with_one_line(void **state) {
    static const char *const names[] = {
        "odd/BoxWithInfinites.glb",
        "odd/IndexOutOfRange/AllIndicesOutOfRange.gltf",
        "odd/MissingBin/BoxTextured.gltf",
        "odd/PrimitiveMode/Mesh_PrimitiveMode_00.gltf",
        "odd/PrimitiveMode/Mesh_PrimitiveMode_02.gltf",
        "odd/box_UTF16BE.obj",
        "odd/degenerate_mesh.obj",
        "odd/empty.obj",
        "odd/empty.ply",
        "odd/malformed.obj",
        "odd/number_formats.obj",
    };
    (void)state;
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        refuse(scene_path(names[i]), false, ": ");
}

static int make_folder(void **state) {
    (void)state;
    (void)mkdir(FOLDER, 0777);
    return 0;
}

#define T(name) cmocka_unit_test(name)

int main(void) {
    static const struct CMUnitTest tests[] = {
        T(an_obj_quad_has_v_0_in_the_first_row_of_its_image),
        T(a_gltf_quad_has_v_0_in_the_first_row_of_its_image),
        T(a_texture_may_name_the_second_uv_set_and_its_wrap_modes),
        T(a_texture_transform_moves_the_uv),
        T(an_embedded_image_is_decoded),
        T(backslashes_percent_signs_and_foreign_folders_find_their_texture),
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
        T(nodes_instances_and_the_scene_place_the_triangles),
        T(a_mirrored_node_keeps_its_front_in_front),
        T(normals_go_by_the_inverse_transpose),
        T(missing_normals_are_smooth_over_a_flat_ridge),
        T(missing_normals_keep_an_edge_of_90_degrees),
        T(triangles_without_area_are_dropped_and_counted),
        T(triangles_that_are_not_finite_are_dropped_with_one_warning),
        T(triangles_that_go_too_far_out_are_dropped_with_one_warning),
        T(points_and_lines_are_dropped_and_counted),
        T(a_ply_without_normals_is_imported),
        T(importing_twice_gives_the_same_bytes),
        T(a_camera_stands_where_its_node_is),
        T(an_orthographic_camera_is_warned_of),
        T(lights_have_their_power_cone_and_range),
        T(lights_and_cameras_answer_to_the_node_above),
        T(a_file_without_a_triangle_is_refused),
        T(a_missing_mesh_is_refused),
        T(a_missing_material_file_is_a_warning_or_an_error_if_strict),
        T(files_of_no_known_kind_are_refused),
        T(polygons_that_are_not_convex_are_cut_whole),
        T(polygons_with_nearly_straight_corners_are_cut_whole),
        T(a_ply_with_a_broken_header_is_refused),
        T(real_scenes_have_the_triangles_that_others_counted),
        T(all_but_the_glass_of_the_kitchen_is_there),
        T(gltf_samples_have_their_triangles_and_textures),
        T(malformed_files_are_refused_with_one_line),
    };
    return cmocka_run_group_tests(tests, make_folder, NULL);
}
