/* What glTF keeps compressed: buffer views (EXT_meshopt_compression), primitives (KHR_draco_mesh_compression), WebP pictures.
 * What is hard: that nothing is lost on the way, and what is broken must end in one line. Strategy: packed here by the
 * libraries' own encoders, where they have one for C, and read back bit by bit; a block of Draco's own encoder; filters against
 * what they stand for; every block cut short, and with bytes changed. */
#define FOLDER VIT_BUILD_DIR "/tests/unit/gltf_packed"
#include "gltf_lab.h"

#include <meshoptimizer.h>
#include <webp/encode.h>

/* ---- EXT_meshopt_compression ---- */

enum { GRID = 16, VERTICES = GRID * GRID, TRIANGLES = 2 * (GRID - 1) * (GRID - 1) };

static void make_grid(float position[3 * VERTICES], uint32_t corner[3 * TRIANGLES]) {
    uint32_t *to = corner;
    for (uint32_t i = 0; i < VERTICES; i++) {
        position[3 * i] = (float)(i % GRID) * 0.37f;
        position[3 * i + 1] = (float)(i / GRID) * 1.13f;
        position[3 * i + 2] = (float)(i * 7 % 11) * 0.01f;
    }
    for (uint32_t y = 0; y + 1 < GRID; y++)
        for (uint32_t x = 0; x + 1 < GRID; x++) {
            const uint32_t a = y * GRID + x, quad[6] = {a, a + 1, a + GRID, a + 1, a + GRID + 1, a + GRID};
            memcpy(to, quad, sizeof quad);
            to += 6;
        }
}

/* A view whose bytes are compressed: `size` of them, which stand for count * stride. */
static int packed_view(gltf_lab *l, const uint8_t *bytes, size_t size, size_t count, size_t stride, const char *mode,
                       const char *filter) {
    const size_t at = (l->size + 3) / 4 * 4;
    assert_true(at + size <= sizeof l->bin);
    memcpy(l->bin + at, bytes, size);
    l->size = at + size;
    lab_text(l->views, sizeof l->views,
             "%s{\"buffer\":1,\"byteLength\":%zu,\"byteStride\":%zu,\"extensions\":{\"EXT_meshopt_compression\":{\"buffer\":0,"
             "\"byteOffset\":%zu,\"byteLength\":%zu,\"byteStride\":%zu,\"count\":%zu,\"mode\":\"%s\"%s}}}",
             l->view_count ? "," : "", count * stride, stride, at, size, stride, count, mode, filter);
    return l->view_count++;
}

#define GRID_MESH                                                                                                              \
    "\"extensionsRequired\":[\"EXT_meshopt_compression\"]," LAB_SCENE                                                          \
    "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"indices\":1}]}]"

static void pack_grid(gltf_lab *l, const char *mode, uint8_t *index_bytes, size_t index_size) {
    static float position[3 * VERTICES];
    static uint32_t corner[3 * TRIANGLES];
    uint8_t bytes[4096];
    make_grid(position, corner);
    const size_t size = meshopt_encodeVertexBuffer(bytes, sizeof bytes, position, VERTICES, 12);
    assert_true(size > 0);
    (void)lab_accessor(l, packed_view(l, bytes, size, VERTICES, 12, "ATTRIBUTES", ""), GLTF_FLOAT, "VEC3", VERTICES, "");
    (void)lab_accessor(l, packed_view(l, index_bytes, index_size, 3 * TRIANGLES, 4, mode, ""), GLTF_UINT, "SCALAR",
                       3 * TRIANGLES, "");
}

/* By the library's encoder of triangles, or of any indices. */
static size_t encode_indices(bool triangles, uint8_t *bytes, size_t room) {
    static float position[3 * VERTICES];
    static uint32_t corner[3 * TRIANGLES];
    make_grid(position, corner);
    meshopt_encodeIndexVersion(1);
    return triangles ? meshopt_encodeIndexBuffer(bytes, room, corner, 3 * TRIANGLES)
                     : meshopt_encodeIndexSequence(bytes, room, corner, 3 * TRIANGLES);
}

static void views_are_decoded_to_the_same_bits(void **state) {
    static float position[3 * VERTICES];
    static uint32_t corner[3 * TRIANGLES];
    static uint8_t bytes[8192];
    (void)state;
    make_grid(position, corner);
    for (int triangles = 0; triangles < 2; triangles++) {
        gltf_lab l = {.size = 0};
        model m;
        const size_t size = encode_indices(triangles, bytes, sizeof bytes);
        pack_grid(&l, triangles ? "TRIANGLES" : "INDICES", bytes, size);
        lab_write(&l, "lab", GRID_MESH);
        import_good(LAB_FILE, &m);
        assert_int_equal(m.triangles, TRIANGLES);
        /* Triangles may begin at another of their corners. */
        for (uint32_t t = 0; t < TRIANGLES; t++)
            for (int k = 0, first = 0; k < 3; k++) {
                const float *is = m.position + 3 * m.index[3 * t];
                while (first < 3 && memcmp(is, position + 3 * corner[3 * t + (uint32_t)first], 12) != 0)
                    first++;
                assert_in_range(first, 0, 2);
                assert_memory_equal(m.position + 3 * m.index[3 * t + (uint32_t)k],
                                    position + 3 * corner[3 * t + (uint32_t)((first + k) % 3)], 12);
            }
        model_free(&m);
    }
}

/* Unit vectors as the extension's octahedra of 8 and of 16 bits, packed. */
static void octahedral_normals_come_out_as_unit_vectors(void **state) {
    static const float normals[12] = {0.6f, 0, 0.8f, 0, 0.6f, -0.8f, -0.48f, 0.64f, -0.6f};
    (void)state;
    for (int wide = 0; wide < 2; wide++) {
        const double most = wide ? 32767.0 : 127.0;
        int16_t words[12] = {0};
        int8_t bytes[12] = {0};
        for (int i = 0; i < 3; i++) {
            const double x = (double)normals[3 * i], y = (double)normals[3 * i + 1], z = (double)normals[3 * i + 2];
            const double sum = fabs(x) + fabs(y) + fabs(z), u = x / sum, v = y / sum;
            const double fold[2] = {z < 0 ? (u < 0 ? -1 : 1) * (1 - fabs(v)) : u, z < 0 ? (v < 0 ? -1 : 1) * (1 - fabs(u)) : v};
            for (int k = 0; k < 2; k++) {
                words[4 * i + k] = (int16_t)lrint(fold[k] * most);
                bytes[4 * i + k] = (int8_t)lrint(fold[k] * (wide ? 1 : most));
            }
            words[4 * i + 2] = (int16_t)most;
            bytes[4 * i + 2] = 127;
        }
        gltf_lab l = {.size = 0};
        model m;
        uint8_t packed[512];
        const size_t stride = wide ? 8 : 4;
        const size_t size = meshopt_encodeVertexBuffer(packed, sizeof packed, wide ? (const void *)words : bytes, 3, stride);
        (void)lab_triangle(&l);
        (void)lab_accessor(&l, packed_view(&l, packed, size, 3, stride, "ATTRIBUTES", ",\"filter\":\"OCTAHEDRAL\""),
                           wide ? GLTF_SHORT : GLTF_BYTE, "VEC3", 3, ",\"normalized\":true");
        lab_import(&l, "\"POSITION\":0,\"NORMAL\":1", "", "", &m);
        const float at[3][2] = {{0, 0}, {1, 0}, {0, 1}};
        for (int i = 0; i < 3; i++) {
            const float *n = m.normal + 3 * vertex_at(&m, at[i][0], at[i][1], 0);
            for (int k = 0; k < 3; k++)
                assert_true(fabs((double)(n[k] - normals[3 * i + k])) < (wide ? 1e-4 : 0.03));
        }
        model_free(&m);
    }
}

/* Three numbers of 24 bits, whose exponents are -2, 0 and 1. */
static void exponential_positions_are_mantissa_times_power(void **state) {
    static const uint32_t words[9] = {0xfe000000, 0xfe000000, 0, 0xfe000006, 0, 0, 0x01fffffe, 0x00000005, 0};
    gltf_lab l = {.size = 0};
    model m;
    uint8_t packed[512];
    const size_t size = meshopt_encodeVertexBuffer(packed, sizeof packed, words, 3, 12);
    (void)state;
    (void)lab_accessor(&l, packed_view(&l, packed, size, 3, 12, "ATTRIBUTES", ",\"filter\":\"EXPONENTIAL\""), GLTF_FLOAT,
                       "VEC3", 3, "");
    lab_import(&l, "\"POSITION\":0", "", "", &m);
    box_is(&m, -4, 0, 0, 1.5, 5, 0);
    model_free(&m);
}

/* Instances turned by quaternions of 16 bits: the second half round about z, whose largest component is z. */
static void quaternions_have_their_largest_component_back(void **state) {
    static const float at[6] = {0, 0, 0, 10, 0, 0};
    const int16_t turns[8] = {0, 0, 0, 0x7fff, 0, 0, 0, 0x7ffe}; /* the last two bits: which is the largest */
    gltf_lab l = {.size = 0};
    model m;
    uint8_t packed[512];
    const size_t size = meshopt_encodeVertexBuffer(packed, sizeof packed, turns, 2, 8);
    (void)state;
    (void)lab_triangle(&l);
    (void)lab_data(&l, at, sizeof at, GLTF_FLOAT, "VEC3", 2, "");
    (void)lab_accessor(&l, packed_view(&l, packed, size, 2, 8, "ATTRIBUTES", ",\"filter\":\"QUATERNION\""), GLTF_SHORT, "VEC4",
                       2, ",\"normalized\":true");
    lab_write(&l, "lab",
              "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0}}]}],\"nodes\":[{\"mesh\":0,\"extensions\":"
              "{\"EXT_mesh_gpu_instancing\":{\"attributes\":{\"TRANSLATION\":1,\"ROTATION\":2}}}}]");
    import_good(LAB_FILE, &m);
    box_is(&m, 0, -1, 0, 10, 1, 0);
    model_free(&m);
}

static void packed_refused(size_t size, size_t count, size_t stride, const char *mode, const char *filter, const char *what) {
    static uint8_t bytes[8192];
    gltf_lab l = {.size = 0};
    (void)encode_indices(true, bytes, sizeof bytes);
    (void)lab_triangle(&l);
    (void)lab_accessor(&l, packed_view(&l, bytes, size, count, stride, mode, filter), GLTF_UINT, "SCALAR", 3, "");
    lab_refused(&l, LAB_SCENE "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"indices\":1}]}]", what);
}

static void views_that_cannot_be_decoded_are_refused(void **state) {
    static uint8_t bytes[8192];
    const size_t size = encode_indices(true, bytes, sizeof bytes), count = 3 * TRIANGLES;
    (void)state;
    packed_refused(size - 40, count, 4, "TRIANGLES", "", "compressed data cannot be read");
    packed_refused(size, count, 4, "ATTRIBUTES", "", "compressed data cannot be read");
    packed_refused(size, count, 4, "ANYTHING", "", "compressed data cannot be read");
    packed_refused(size, count, 4, "TRIANGLES", ",\"filter\":\"ANYTHING\"", "compressed data cannot be read");
    packed_refused(size, count, 4, "TRIANGLES", ",\"filter\":\"QUATERNION\"", "compressed data cannot be read");
    packed_refused(size, count, 3, "TRIANGLES", "", "compressed data cannot be read");
    packed_refused(size, count - 1, 4, "TRIANGLES", "", "compressed data cannot be read");
    packed_refused(size, count, 0, "TRIANGLES", "", "no sizes that could be");
    packed_refused(size, (size_t)1 << 40, 4, "TRIANGLES", "", "no sizes that could be");
    packed_refused(size, size * 60, 256, "ATTRIBUTES", "", "more than its compression can hold");
}

/* ---- KHR_draco_mesh_compression ---- */

/* Made by Draco 1.5.5's encoder of the square of edge 4 with texture coordinates 0 and 1: positions of 11 bits, which they are
 * exact in, texture coordinates of 8. */
static const uint8_t square[] = {
    0x44, 0x52, 0x41, 0x43, 0x4f, 0x02, 0x02, 0x01, 0x01, 0x00, 0x00, 0x00, 0x04, 0x02, 0x01, 0x02, 0x00, 0x00, 0x01,
    0x1f, 0xff, 0x01, 0x11, 0xff, 0x01, 0x11, 0x02, 0xff, 0x00, 0x00, 0x00, 0x00, 0x00, 0x01, 0x00, 0x09, 0x03, 0x00,
    0x00, 0x02, 0x01, 0x03, 0x09, 0x02, 0x00, 0x01, 0x02, 0x01, 0x01, 0x01, 0x00, 0x03, 0x03, 0x01, 0x30, 0x01, 0x10,
    0x03, 0x00, 0x28, 0x82, 0x98, 0x00, 0x00, 0x00, 0x00, 0x00, 0xff, 0x07, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00,
    0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x80, 0x40, 0x0b, 0x05, 0x01, 0x01, 0x00, 0x02, 0x03, 0x01,
    0x40, 0x01, 0x00, 0x0c, 0x02, 0x00, 0x00, 0x00, 0x80, 0x02, 0x80, 0x70, 0x00, 0x00, 0x00, 0x00, 0xff, 0x00, 0x00,
    0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x80, 0x3f, 0x08,
};

#define DRACO_MESH                                                                                                             \
    "\"extensionsRequired\":[\"KHR_draco_mesh_compression\"]," LAB_SCENE                                                       \
    "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0,\"TEXCOORD_0\":1},\"indices\":2,\"material\":0,"             \
    "\"extensions\":{\"KHR_draco_mesh_compression\":{\"bufferView\":0,\"attributes\":{%s}}}}]}],"                              \
    "\"materials\":[{\"pbrMetallicRoughness\":{\"baseColorTexture\":{\"index\":0}}}],\"textures\":[{\"source\":0}],"           \
    "\"images\":[{\"uri\":\"image.tga\"}]"

static void put_square(const uint8_t *bytes, size_t size, const char *ids) {
    gltf_lab l = {.size = 0};
    char rest[1024];
    (void)lab_view(&l, bytes, size, "");
    (void)lab_accessor(&l, -1, GLTF_FLOAT, "VEC3", 4, "");
    (void)lab_accessor(&l, -1, GLTF_FLOAT, "VEC2", 4, "");
    (void)lab_accessor(&l, -1, GLTF_UINT, "SCALAR", 6, "");
    put_image(FILE_OF("image.tga"), 255);
    (void)snprintf(rest, sizeof rest, DRACO_MESH, ids);
    lab_write(&l, "lab", rest);
}

static void a_draco_block_has_its_attributes_by_their_ids(void **state) {
    model m;
    (void)state;
    put_square(square, sizeof square, "\"POSITION\":0,\"TEXCOORD_0\":1");
    import_good(LAB_FILE, &m);
    check_promises(&m);
    box_is(&m, 0, 0, 0, 4, 4, 0);
    assert_int_equal(m.triangles, 2);
    uv_is(&m, vertex_at(&m, 4, 0, 0), 1, 0);
    uv_is(&m, vertex_at(&m, 0, 4, 0), 0, 1);
    model_free(&m);
    put_square(square, sizeof square, "\"POSITION\":0"); /* the other has a view of its own: here none, which is zeros */
    import_good(LAB_FILE, &m);
    uv_is(&m, vertex_at(&m, 4, 0, 0), 0, 0);
    model_free(&m);
}

static void draco_blocks_that_are_none_are_refused(void **state) {
    uint8_t broken[sizeof square];
    (void)state;
    put_square(square, sizeof square, "\"POSITION\":7");
    refuse(LAB_FILE, false, "Draco's block has no POSITION");
    put_square(square, sizeof square, "\"POSITION\":1,\"TEXCOORD_0\":0");
    refuse(LAB_FILE, false, "Draco's block has no POSITION");
    for (size_t cut = 1; cut < sizeof square; cut += 13) {
        put_square(square, cut, "\"POSITION\":0");
        refuse(LAB_FILE, false, "Draco's block cannot be read");
    }
    for (size_t i = 0; i < sizeof square; i += 7) { /* whatever it says then, it must end */
        model m;
        vit_text why;
        memcpy(broken, square, sizeof square);
        broken[i] ^= 0x5a;
        put_square(broken, sizeof broken, "\"POSITION\":0");
        if (import_file(LAB_FILE, false, &m, &why) == VIT_OK)
            model_free(&m);
    }
}

/* ---- EXT_texture_webp ---- */

static size_t put_webp(const char *name, const uint8_t texels[16]) {
    uint8_t *bytes;
    const size_t size = WebPEncodeLosslessRGBA(texels, 2, 2, 8, &bytes);
    assert_true(size > 0);
    put_bytes(name, bytes, size);
    WebPFree(bytes);
    return size;
}

#define PICTURE(texture, images)                                                                                               \
    ",\"extensionsUsed\":[\"EXT_texture_webp\",\"KHR_texture_basisu\"],\"materials\":[{\"name\":\"m\","                        \
    "\"pbrMetallicRoughness\":{\"baseColorTexture\":{\"index\":0}}}],\"textures\":[{" texture "}],\"images\":[" images "]"
#define WEBP(n) "\"extensions\":{\"EXT_texture_webp\":{\"source\":" #n "}}"

static void import_picture(const char *rest, model *m) {
    static const float uv[6] = {0, 0, 1, 0, 0, 1};
    gltf_lab l = {.size = 0};
    (void)lab_triangle(&l);
    (void)lab_data(&l, uv, sizeof uv, GLTF_FLOAT, "VEC2", 3, "");
    lab_import(&l, "\"POSITION\":0,\"TEXCOORD_0\":1", ",\"material\":0", rest, m);
}

static void webp_goes_before_what_stands_beside_it_if_it_can_be_read(void **state) {
    static const uint8_t texels[16] = {1, 2, 3, 255, 4, 5, 6, 255, 7, 8, 9, 128, 250, 251, 252, 255};
    model m;
    (void)state;
    (void)put_webp(FILE_OF("a.webp"), texels);
    put_image(FILE_OF("image.tga"), 255);
    put(FILE_OF("broken.webp"), "RIFF\1\0\0\0WEBPVP8 ");
    import_picture(PICTURE("\"source\":0," WEBP(1), "{\"uri\":\"image.tga\"},{\"uri\":\"a.webp\"}"), &m);
    assert_int_equal(m.image_count, 1);
    assert_true(m.images[0].width == 2 && m.images[0].height == 2);
    assert_memory_equal(m.images[0].rgba, texels, sizeof texels);
    assert_string_equal(warnings, "");
    model_free(&m);
    import_picture(PICTURE(WEBP(0), "{\"uri\":\"a.webp\"}"), &m);
    assert_memory_equal(m.images[0].rgba, texels, sizeof texels);
    model_free(&m);
    for (int k = 0; k < 2; k++) {
        import_picture(k ? PICTURE("\"source\":0," WEBP(1), "{\"uri\":\"image.tga\"},{\"uri\":\"nowhere.webp\"}")
                         : PICTURE("\"source\":0," WEBP(1), "{\"uri\":\"image.tga\"},{\"uri\":\"broken.webp\"}"),
                       &m);
        assert_true(m.image_count == 1 && m.images[0].rgba[0] == 255); /* the red of the other */
        model_free(&m);
    }
}

static void a_plain_picture_does_for_one_that_is_not_read(void **state) {
    model m;
    vit_text why;
    (void)state;
    put_image(FILE_OF("image.tga"), 255);
    put(FILE_OF("a.ktx2"), "\xabKTX 20\xbb\r\n\x1a\n");
    import_picture(PICTURE("\"source\":0,\"extensions\":{\"KHR_texture_basisu\":{\"source\":1}}",
                           "{\"uri\":\"image.tga\"},{\"uri\":\"a.ktx2\"}"),
                   &m);
    assert_int_equal(m.image_count, 1);
    assert_string_equal(warnings, "");
    model_free(&m);
    assert_int_equal(import_file(LAB_FILE, true, &m, &why), VIT_OK);
    model_free(&m);
}

static void a_picture_that_cannot_be_had_is_told_of(void **state) {
    model m;
    (void)state;
    put(FILE_OF("broken.webp"), "RIFF\1\0\0\0WEBPVP8 ");
    import_picture(PICTURE(WEBP(0), "{\"uri\":\"broken.webp\"}"), &m);
    assert_int_equal(m.image_count, 0);
    assert_non_null(strstr(warnings, "texture 'broken.webp' is not an image that can be read"));
    model_free(&m);
    refuse(LAB_FILE, true, "texture 'broken.webp'");
    put(FILE_OF("a.ktx2"), "\xabKTX 20\xbb\r\n\x1a\n");
    import_picture(PICTURE("\"extensions\":{\"KHR_texture_basisu\":{\"source\":0}}", "{\"uri\":\"a.ktx2\"}"), &m);
    assert_non_null(strstr(warnings, "texture 'a.ktx2' is KTX2, which is not read"));
    assert_non_null(strstr(warnings, "extension 'KHR_texture_basisu' is used and not read"));
    model_free(&m);
    import_picture(PICTURE("\"sampler\":0", "{\"uri\":\"a.ktx2\"}"), &m); /* no picture at all */
    assert_non_null(strstr(warnings, "texture 'textures[0]' is missing"));
    model_free(&m);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        T(views_are_decoded_to_the_same_bits),
        T(octahedral_normals_come_out_as_unit_vectors),
        T(exponential_positions_are_mantissa_times_power),
        T(quaternions_have_their_largest_component_back),
        T(views_that_cannot_be_decoded_are_refused),
        T(a_draco_block_has_its_attributes_by_their_ids),
        T(draco_blocks_that_are_none_are_refused),
        T(webp_goes_before_what_stands_beside_it_if_it_can_be_read),
        T(a_plain_picture_does_for_one_that_is_not_read),
        T(a_picture_that_cannot_be_had_is_told_of),
    };
    return cmocka_run_group_tests(tests, make_folder, NULL);
}
