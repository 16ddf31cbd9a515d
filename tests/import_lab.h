/* Mesh files made here, and what must hold of what is imported from them. A program defines FOLDER, where its files are,
 * before it includes this. */
#ifndef VIT_TESTS_IMPORT_LAB_H
#define VIT_TESTS_IMPORT_LAB_H

#include "import/model.h"
#include "test_folder.h"
#include "vitrine_pack.h"
#include <math.h>

/* ---- files made here ---- */

/* A TGA of two by two texels: red green over blue white, the last with alpha `alpha`. Returns its size. */
static inline size_t make_image(uint8_t out[34], uint8_t alpha) {
    static const uint8_t head[18] = {0, 0, 2, 0, 0, 0, 0, 0, 0, 0, 0, 0, 2, 0, 2, 0, 32, 0x28}; /* 0x28: rows from the top */
    static const uint8_t bgra[16] = {0, 0, 255, 255, 0, 255, 0, 255, 255, 0, 0, 255, 255, 255, 255, 255};
    memcpy(out, head, sizeof head);
    memcpy(out + 18, bgra, sizeof bgra);
    out[33] = alpha;
    return 34;
}

static inline void put_image(const char *path, uint8_t alpha) {
    uint8_t bytes[34];
    put_bytes(path, bytes, make_image(bytes, alpha));
}

static inline void put_floats(uint8_t *at, const float *values, size_t count) {
    for (size_t i = 0; i < count; i++) {
        uint32_t word;
        memcpy(&word, &values[i], sizeof word);
        for (size_t k = 0; k < 4; k++)
            at[4 * i + k] = (uint8_t)(word >> (8 * k));
    }
}

/* quad.gltf: the unit square in z = 0 with uv 0 upright (top left is (0, 0)), uv 1 = half of uv 0, accessor 3 a constant
 * colour, accessor 4 a varying one, buffer view 6 an image. `attributes` goes behind POSITION, `rest` into the top level. */
static inline void put_gltf(const char *attributes, const char *rest) {
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

static char last_warning[1024], warnings[4096]; /* the last one alone; all, a line each */

static inline void remember(void *user, const char *line) {
    const size_t used = strlen(warnings);
    (void)user;
    assert_null(strchr(line, '\n'));
    (void)snprintf(last_warning, sizeof last_warning, "%s", line);
    (void)snprintf(warnings + used, sizeof warnings - used, "%s\n", line);
}

static inline void forget_warnings(void) {
    last_warning[0] = warnings[0] = '\0';
}

static inline vit_status import_file(const char *path, bool strict, model *m, vit_text *why) {
    scene s;
    *why = (vit_text){{0}};
    forget_warnings();
    assert_int_equal(scene_for_mesh(path, &s, why), VIT_OK);
    const vit_status status = model_import(&s, strict, remember, NULL, m, why);
    scene_free(&s);
    return status;
}

/* The mesh file of FOLDER in a scene of which `rest` is the rest. */
static inline vit_status import_in_scene(const char *mesh, const char *rest, model *m, vit_text *why) {
    char text[2048];
    scene s;
    (void)snprintf(text, sizeof text,
                   "meshes = ( { file = \"%s\"; } ); camera: { keys = ( { eye = (0, 1, 3); target = (0, 1, 0); } ); };\n%s\n",
                   mesh, rest);
    put(FILE_OF("m.cfg"), text);
    *why = (vit_text){{0}};
    forget_warnings();
    if (scene_read(FILE_OF("m.cfg"), &s, why) != VIT_OK)
        fail_msg("%s", why->text);
    const vit_status status = model_import(&s, false, remember, NULL, m, why);
    scene_free(&s);
    return status;
}

static inline void import_good(const char *path, model *m) {
    vit_text why;
    const vit_status status = import_file(path, false, m, &why);
    if (status != VIT_OK)
        print_error("%s\n", why.text);
    assert_int_equal(status, VIT_OK);
}

static inline void refuse(const char *path, bool strict, const char *what) {
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
static inline void check_promises(const model *m) {
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
static inline size_t vertex_at(const model *m, float x, float y, float z) {
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

static inline void uv_at(const model *m, float x, float y, float u, float v) {
    const float *uv = m->uv + 2 * vertex_at(m, x, y, 0.0f);
    if (fabsf(uv[0] - u) > 1e-5f || fabsf(uv[1] - v) > 1e-5f)
        print_error("at (%g, %g): uv (%g, %g), expected (%g, %g)\n", (double)x, (double)y, (double)uv[0], (double)uv[1],
                    (double)u, (double)v);
    assert_true(fabsf(uv[0] - u) <= 1e-5f && fabsf(uv[1] - v) <= 1e-5f);
}

static inline void normal_at(const model *m, float x, float y, float z, float nx, float ny, float nz) {
    const float *n = m->normal + 3 * vertex_at(m, x, y, z);
    assert_true(fabsf(n[0] - nx) < 1e-5f && fabsf(n[1] - ny) < 1e-5f && fabsf(n[2] - nz) < 1e-5f);
}

#define OBJ_QUAD "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
#define OBJ_FACES "f 1/1 2/2 3/3\nf 1/1 3/3 4/4\n"

static inline void put_obj(const char *mtl) {
    put(FILE_OF("quad.mtl"), mtl);
    put(FILE_OF("quad.obj"), "mtllib quad.mtl\n" OBJ_QUAD "usemtl m\n" OBJ_FACES);
}

/* ---- materials ---- */

/* The mesh through a scene whose `materials` are `overrides`; it must be good. */
static inline void import_scene(const char *mesh, const char *overrides, model *m) {
    vit_text why;
    if (import_in_scene(mesh, overrides, m, &why) != VIT_OK)
        fail_msg("%s", why.text);
}

static inline bool near3(const float got[3], double x, double y, double z) {
    const double want[3] = {x, y, z};
    for (int k = 0; k < 3; k++)
        if (!(fabs((double)got[k] - want[k]) < 1e-5))
            return false;
    return true;
}

static inline bool is_matt(const model_material *m) {
    return m->kind == VIT_MATTE && near3(m->specular, 0, 0, 0) && m->exponent == 1.0f && m->ior == 1.0f;
}

static inline bool real_scene(const char *file, model *m) {
    const char *folder = getenv("VITRINE_SCENES");
    char path[512];
    vit_text why = {{0}};
    scene s;
    (void)snprintf(path, sizeof path, "%s/%s", folder ? folder : "../shared/scenes", file);
    if (access(path, R_OK) != 0)
        return false;
    assert_int_equal(scene_for_mesh(path, &s, &why), VIT_OK);
    assert_int_equal(model_import(&s, false, remember, NULL, m, &why), VIT_OK);
    scene_free(&s);
    return true;
}

static inline const model_material *named(const model *m, const char *name) {
    for (int i = 0; i < m->material_count; i++)
        if (!strcmp(m->materials[i].name, name))
            return &m->materials[i];
    fail_msg("there is no material '%s'", name);
    return NULL;
}

#define T(name) cmocka_unit_test(name)

static inline void box_is(const model *m, double x, double y, double z, double far_x, double far_y, double far_z) {
    const double lo[3] = {x, y, z}, hi[3] = {far_x, far_y, far_z};
    for (int k = 0; k < 3; k++)
        if (fabs(m->lo[k] - lo[k]) > 1e-7 || fabs(m->hi[k] - hi[k]) > 1e-7)
            fail_msg("axis %d: %.9g to %.9g, not %.9g to %.9g", k, m->lo[k], m->hi[k], lo[k], hi[k]);
}

#endif
