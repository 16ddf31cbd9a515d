/* Normals that disagree with their face, and texture coordinates that are huge, negative or none.
 *
 * What can go wrong: a normal from the file points to the back, or lies in the face's plane, and three of them may add up to
 * nothing: then a unit vector is 0 / 0, or light comes from behind the surface. A texture coordinate of 1e30 has no fraction
 * left, and one that is no number becomes an address. The bounds: shading normals are of unit length and never point behind the
 * face; no float of a picture is none; wrapped coordinates are in 0..1 whatever went in, and exact where the fraction is; a
 * mesh file with such coordinates is baked and played, or refused, never worse. */
#include "catalogue.h"
#include "host_rays.h"
#include "common/octahedral.h"
#include "test_folder.h"
#include "tool_run.h"
#include <float.h>

#define RAYS (1u << 14)

static void keep(float p[3]) {
    (void)p;
}

/* Normals of a triangle: anything; backwards; within the plane; three that cancel. */
static void spoil_normals(ray_mesh *r) {
    uint64_t state = 61;
    for (uint32_t i = 0; i < r->m.triangles; i++) {
        const vit_triangle *t = r->packed.triangles + i;
        float face[3] = {t->nx, t->ny, t->nz}, edge[3], first[3] = {0, 0, 0};
        unit_float(face);
        for (int k = 0; k < 3; k++)
            edge[k] = t->v1[k] - t->v0[k];
        unit_float(edge);
        for (int v = 0; v < 3; v++) {
            float n[3];
            int code[2];
            random_direction(&state, n);
            for (int k = 0; k < 3; k++) {
                if (i % 4 == 1)
                    n[k] = -face[k];
                if (i % 4 == 2)
                    n[k] = edge[k];
                if (i % 4 == 3)
                    n[k] = v == 0 ? edge[k] : -first[k];
                first[k] = v == 0 ? n[k] : first[k];
            }
            octahedral_encode(n, 32767, code);
            r->packed.attributes[i].normal[v] = ((vit_u32)code[0] & 0xffffu) | (vit_u32)code[1] << 16;
        }
    }
}

/* Are the triangle's normals, all three alike, in its plane to the bit? Along an axis nothing rounds. */
static bool in_the_plane(const vit_triangle *t, uint32_t index) {
    int zeros = 0;
    for (int k = 0; k < 3; k++)
        zeros += t->v1[k] == t->v0[k];
    return index % 4 == 2 && zeros == 2;
}

static void shading_normals_stay_before_the_face(void **state) {
    ray_mesh r;
    vit_scene constants;
    uint64_t random = 67, behind = 0, hits = 0, sideways = 0, in_plane = 0;
    double length = 0;
    (void)state;
    mesh_cube(&r, 8, keep);
    mesh_bake(&r);
    spoil_normals(&r);
    const host_lab_mesh m = host_mesh(&r, &constants);
    ray_set s = rays_new(RAYS);
    for (uint32_t i = 0; i < s.n; i++) {
        float o[3], d[3];
        random_direction(&random, d);
        for (int k = 0; k < 3; k++)
            o[k] = lab_uniform(&random) - 0.5f;
        rays_set(&s, i, o, d, RAY_FAR);
    }
    ray_hits h = host_cast(&m, &s);
    float *surface = ray_lab_array(12 * (size_t)s.n, sizeof(float));
    host_lab_find()->surfaces(&m, s.plane, h.distance, h.triangle, s.n, surface);
    for (uint32_t i = 0; i < s.n; i++) {
        double front = 0, l2 = 0;
        for (size_t k = 0; k < 3; k++) {
            const double face = (double)surface[(3 + k) * s.n + i], n = (double)surface[(6 + k) * s.n + i];
            front += face * n;
            l2 += n * n;
        }
        hits += h.triangle[i] != VIT_NONE;
        behind += !(front >= -1e-7);
        if (h.triangle[i] != VIT_NONE && in_the_plane(r.packed.triangles + h.triangle[i], h.triangle[i])) {
            in_plane++;
            sideways += front < 0.999;
        }
        length = fmax(length, isfinite(l2) ? fabs(sqrt(l2) - 1) : 1);
    }
    free(surface);
    hits_free(&h);
    free(s.plane);
    mesh_free(&r);
    catalogue_none("normals", "shading normals behind the face", behind, hits, "hits");
    catalogue_none("normals", "of normals in the very plane of the face: not replaced", sideways, in_plane, "hits");
    catalogue_row("normals", "length of shading normals against 1", length, 5e-7, "relative");
}

static void coordinates_wrap_into_0_to_1(void **state) {
    static const float odd[] = {0,        -0.0f,     1,       -1,       0.25f,   -0.25f, 3.75f,       -3.75f,
                                1e6f,     -1e6f,     0x1p23f, -0x1p23f, 1e30f,   -1e30f, FLT_MAX,     -FLT_MAX,
                                INFINITY, -INFINITY, NAN,     1e-45f,   -1e-45f, -1e-9f, 0.99999994f, -0.99999994f};
    enum { ODD = sizeof odd / sizeof *odd };
    uint64_t outside = 0, wrong = 0;
    float wrapped[ODD];
    (void)state;
    assert_int_equal(ODD % HOST_LAB_LANES, 0);
    for (uint32_t mode = 0; mode < 3; mode++) {
        host_lab_find()->wrap(odd, mode, ODD, wrapped);
        for (int i = 0; i < ODD; i++) {
            const double x = (double)odd[i], w = (double)wrapped[i];
            outside += !(w >= 0 && w <= 1);
            if (!isfinite(x) || fabs(x) >= 0x1p22)
                continue;
            const double turn = x - 2 * floor(x / 2);
            const double exact = mode == VIT_WRAP_CLAMP    ? fmin(fmax(x, 0), 1)
                                 : mode == VIT_WRAP_MIRROR ? (turn > 1 ? 2 - turn : turn)
                                                           : x - floor(x);
            wrong += fabs(w - exact) > 6e-8;
        }
    }
    catalogue_none("texture coordinates", "huge, negative, none: wrapped out of 0..1", outside, 3 * ODD, "coordinates");
    catalogue_none("texture coordinates", "wrapped coordinates that are off by more than an ulp of 1", wrong, 3 * ODD,
                   "coordinates");
}

/* A textured floor whose coordinates and normals are those given. */
static void meshes_with_such_coordinates_are_baked_or_refused(void **state) {
    static const char *const lines[] = {"vt 1e30 -1e30\nvt -1e38 1e38\nvt 0.5 1e7\nvt -7.25 3.5",
                                        "vt nan nan\nvt 0 0\nvt 1 0\nvt nan 1", "vt inf -inf\nvt 0 0\nvt 1 0\nvt 1e39 1"};
    enum { LINES = sizeof lines / sizeof *lines };
    static tool_run t;
    uint64_t worse = 0, bad = 0, floats = 0;
    (void)state;
    folder_make(VIT_BUILD_DIR "/numeric");
    put(VIT_BUILD_DIR "/numeric/odd.mtl", "newmtl m\nKd 0.8 0.8 0.8\nmap_Kd ../scenes/wood.png\n");
    for (int i = 0; i < LINES; i++) {
        char text[1024];
        (void)snprintf(
            text, sizeof text,
            "mtllib odd.mtl\nusemtl m\nv -1 0 -1\nv 1 0 -1\nv 1 0 1\nv -1 0 1\n%s\nvn 0 1 0\nvn 0 -1 0\nvn nan 0 0\nvn 1 0 0\n"
            "f 1/1/1 2/2/2 3/3/3 4/4/4\n",
            lines[i]);
        put(VIT_BUILD_DIR "/numeric/odd.obj", text);
        tool(&t, TOOL_BAKE " " VIT_BUILD_DIR "/numeric/odd.obj -o " VIT_BUILD_DIR
                           "/numeric/odd.vit --quiet --no-check --device host --size 64x48 --frames 2 --photons 500");
        worse += t.code != 0 && t.code != 5;
        if (t.code != 0)
            continue;
        tool(&t, TOOL_PLAY " " VIT_BUILD_DIR "/numeric/odd.vit --quiet --device host --format rgba32f --out raw:" VIT_BUILD_DIR
                           "/numeric/odd.raw");
        worse += t.code != 0;
        FILE *f = fopen(VIT_BUILD_DIR "/numeric/odd.raw", "rb");
        assert_non_null(f);
        float value;
        while (fread(&value, sizeof value, 1, f) == 1) {
            bad += isfinite(value) ? 0 : 1;
            floats++;
        }
        (void)fclose(f);
    }
    catalogue_none("texture coordinates", "mesh files with 1e30, nan and inf neither baked nor refused", worse, LINES, "files");
    catalogue_none("texture coordinates", "floats of their pictures that are none", bad, floats, "floats");
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(shading_normals_stay_before_the_face),
                                       cmocka_unit_test(coordinates_wrap_into_0_to_1),
                                       cmocka_unit_test(meshes_with_such_coordinates_are_baked_or_refused)};
    return cmocka_run_group_tests_name("attributes", tests, NULL, NULL);
}
