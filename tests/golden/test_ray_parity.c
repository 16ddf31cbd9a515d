/* The kernels' rays against Embree's.
 *
 * What makes this hard to test: both engines round, in different places, so near an edge they may name different triangles and
 * at a grazing angle different distances, and neither is wrong. Where a scene has two surfaces at one place (Sponza has many)
 * ours is the smallest index and Embree's is anyone's guess. So every disagreement is put before a third engine, one ray
 * against one triangle in double, and has to be one of these:
 *   coincident  the ray passes through both triangles, and their exact distances are equal to a few roundings: the scene's
 *               own ambiguity; counted and printed, without a limit
 *   edge        the ray passes within EDGE of an edge of one of the two triangles: at most 1 ray in 100 000
 * Anything else is a failure. Distances of the same triangle agree to 1e-5, or, at grazing angles where the distance along
 * the ray is ill-conditioned, to ACROSS measured across the surface. */
#include "embree_reference.h"

#define RAYS (1u << 20)
#define FEW (1u << 16)  /* rays for what is checked exactly at every width */
#define MOST_EDGES 1e-5 /* of the rays */
#define COINCIDENT                                                                                                             \
    0x1p-21            /* of the largest coordinate or the distance: how far apart two triangles are that are one surface      \
                        */
#define EDGE 0x1p-23   /* of the largest coordinate; measured 0x1.6p-24 */
#define ACROSS 0x1p-20 /* of the largest coordinate; measured 0x1.ap-22: what box_pad is there to cover */

/* A closed hall of 99 372 triangles with bumpy walls. */
static void bumpy_hall(float p[3]) {
    const double x = (double)p[0], y = (double)p[1], z = (double)p[2], l = sqrt(x * x + y * y + z * z);
    const double r = 12 + 1.8 * sin(9 * x / l) * sin(11 * y / l + 1) * sin(7 * z / l) + 0.5 * sin(37 * x / l) * sin(41 * y / l);
    p[0] = (float)(x * r);
    p[1] = (float)(y * r * 0.5);
    p[2] = (float)(z * r);
}

static void make_hall(ray_mesh *r) {
    mesh_cube(r, 91, bumpy_hall);
}

static void make_box(ray_mesh *r, const float centre[3], const float half[3], float angle) {
    static const uint32_t quad[6][4] = {{0, 1, 3, 2}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 3, 7, 5}};
    const uint32_t first = r->m.vertices;
    const float c = cosf(angle), s = sinf(angle);
    for (int i = 0; i < 8; i++) {
        const float x = i & 1 ? half[0] : -half[0], y = i & 2 ? half[1] : -half[1], z = i & 4 ? half[2] : -half[2];
        mesh_vertex(r, centre[0] + x * c - z * s, centre[1] + y, centre[2] + x * s + z * c);
    }
    for (int f = 0; f < 6; f++) {
        mesh_triangle(r, first + quad[f][0], first + quad[f][1], first + quad[f][2]);
        mesh_triangle(r, first + quad[f][0], first + quad[f][2], first + quad[f][3]);
    }
}

/* 3000 boxes through one another, every second one turned, in a box that holds them all. */
static void make_boxes(ray_mesh *r) {
    static const float centre[3] = {0, 0, 0}, half[3] = {11, 11, 11};
    uint64_t state = 5;
    mesh_reserve(r, 8 * 3001, 12 * 3001);
    make_box(r, centre, half, 0);
    for (int i = 0; i < 3000; i++) {
        float c[3], h[3];
        for (int k = 0; k < 3; k++) {
            c[k] = 20 * lab_uniform(&state) - 10;
            h[k] = 0.8f * lab_uniform(&state) + 0.05f;
        }
        make_box(r, c, h, i & 1 ? 6.28f * lab_uniform(&state) : 0);
    }
}

static void ignore_warning(void *user, const char *line) {
    (void)user;
    (void)line;
}

/* False: there is no such file. */
static bool import_file(ray_mesh *r, const char *path) {
    vit_text why;
    FILE *f = fopen(path, "rb");
    if (!f) {
        print_message("skipped: there is no %s\n", path);
        return false;
    }
    fclose(f);
    *r = (ray_mesh){0};
    scene *s = ray_lab_array(1, sizeof *s);
    if (scene_for_mesh(path, s, &why) != VIT_OK || model_import(s, false, ignore_warning, NULL, &r->m, &why) != VIT_OK)
        fail_msg("%s", why.text);
    scene_free(s);
    free(s);
    return true;
}

static bool import_scene(ray_mesh *r, const char *name) {
    const char *folder = getenv("VITRINE_SCENES");
    char path[1024];
    snprintf(path, sizeof path, "%s/%s", folder ? folder : "../shared/scenes", name);
    return import_file(r, path);
}

static void mesh_box(const ray_mesh *r, float lo[3], float hi[3]) {
    for (int k = 0; k < 3; k++) {
        lo[k] = (float)INFINITY;
        hi[k] = -(float)INFINITY;
    }
    for (uint32_t i = 0; i < r->m.triangles; i++) {
        const vit_triangle *t = r->packed.triangles + i;
        for (int k = 0; k < 3; k++) {
            lo[k] = fminf(lo[k], fminf(t->v0[k], fminf(t->v1[k], t->v2[k])));
            hi[k] = fmaxf(hi[k], fmaxf(t->v0[k], fmaxf(t->v1[k], t->v2[k])));
        }
    }
}

/* A ray from inside the box to a random point of a random triangle, at 0.06 to 6 degrees from its plane. */
static void grazing_ray(uint64_t *state, const ray_mesh *r, const float lo[3], const float hi[3], float o[3], float d[3]) {
    const vit_triangle *t = r->packed.triangles + lab_random(state) % r->m.triangles;
    float a = lab_uniform(state), b = lab_uniform(state), n[3] = {t->nx, t->ny, t->nz}, p[3];
    if (a + b > 1) {
        a = 1 - a;
        b = 1 - b;
    }
    unit_float(n);
    random_direction(state, d);
    const float along = d[0] * n[0] + d[1] * n[1] + d[2] * n[2], slope = powf(10, -1 - 2 * lab_uniform(state));
    for (int k = 0; k < 3; k++)
        d[k] -= along * n[k];
    unit_float(d);
    for (int k = 0; k < 3; k++)
        d[k] += slope * n[k];
    unit_float(d);
    float back = (hi[0] - lo[0]) * lab_uniform(state);
    for (int k = 0; k < 3; k++) {
        p[k] = t->v0[k] + a * (t->v1[k] - t->v0[k]) + b * (t->v2[k] - t->v0[k]);
        if (p[k] - d[k] * back < lo[k])
            back = (p[k] - lo[k]) / d[k];
        if (p[k] - d[k] * back > hi[k])
            back = (p[k] - hi[k]) / d[k];
    }
    for (int k = 0; k < 3; k++)
        o[k] = p[k] - d[k] * fmaxf(back, 0);
}

/* Origins in the scene's box; of eight rays five are random, one has one component of exactly 0, one two, one is grazing. */
static ray_set parity_rays(const ray_mesh *r) {
    ray_set s = rays_new(RAYS);
    uint64_t state = 1;
    float lo[3], hi[3];
    mesh_box(r, lo, hi);
    for (uint32_t i = 0; i < s.n; i++) {
        float o[3], d[3];
        for (int k = 0; k < 3; k++)
            o[k] = lo[k] + (hi[k] - lo[k]) * lab_uniform(&state);
        random_direction(&state, d);
        const uint64_t axis = lab_random(&state) % 3;
        if (i % 8 == 5) {
            d[axis] = 0;
            unit_float(d);
        }
        for (uint64_t k = 0; k < 3 && i % 8 == 6; k++)
            d[k] = k == axis ? copysignf(1, d[k]) : 0;
        if (i % 8 == 7)
            grazing_ray(&state, r, lo, hi, o, d);
        rays_set(&s, i, o, d, RAY_FAR);
    }
    return s;
}

typedef struct verdicts {
    uint32_t hits, coincident, edges, misses; /* misses: edges where one engine hits nothing */
    double worst_edge, worst_across, worst_t; /* of the largest coordinate; relative */
} verdicts;

/* Two different answers, a and b, to one ray. */
static void judge_difference(verdicts *v, const ray_mesh *r, uint32_t ray, const float o[3], const float d[3], uint32_t a,
                             uint32_t b, double largest) {
    exact_hit x[2] = {{0}, {0}};
    const uint32_t triangle[2] = {a, b};
    double edge = INFINITY;
    for (int i = 0; i < 2; i++)
        if (triangle[i] != VIT_NONE) {
            x[i] = exact_cast(r->packed.triangles + triangle[i], o, d);
            edge = fmin(edge, x[i].edge / largest);
        }
    if (x[0].inside && x[1].inside && fabs(x[0].t - x[1].t) <= COINCIDENT * fmax(x[0].t, largest)) {
        v->coincident++;
        return;
    }
    v->edges++;
    v->misses += a == VIT_NONE || b == VIT_NONE;
    v->worst_edge = fmax(v->worst_edge, edge);
    if (!(edge <= EDGE))
        fail_msg("ray %u: triangle %d (exactly at %g), Embree %d (exactly at %g), nearest edge %g m away", ray, (int)a, x[0].t,
                 (int)b, x[1].t, edge * largest);
}

static void judge_distance(verdicts *v, const vit_triangle *t, uint32_t ray, const float o[3], const float d[3], float ours,
                           float theirs, double largest) {
    const exact_hit x = exact_cast(t, o, d);
    const double apart = fabs((double)ours - (double)theirs), across = fabs((double)ours - x.t) * x.cosine / largest;
    v->worst_across = fmax(v->worst_across, across);
    if (across <= ACROSS && apart <= 1e-5 * (double)theirs) {
        v->worst_t = fmax(v->worst_t, apart / (double)theirs);
        return;
    }
    if (!(across <= ACROSS && apart * x.cosine <= ACROSS * largest))
        fail_msg("ray %u: at %.9g, Embree at %.9g, exactly at %.9g, cosine %g", ray, (double)ours, (double)theirs, x.t,
                 x.cosine);
}

static void compare_with_embree(const char *name, const ray_mesh *r, const ray_set *s, const ray_hits *h) {
    embree e = embree_open(r, RTC_SCENE_FLAG_ROBUST);
    const double largest = (double)r->tree.box_pad * 0x1p20;
    verdicts v = {0};
    for (uint32_t i = 0; i < s->n; i++) {
        float o[3], d[3], t;
        rays_get(s, i, o, d);
        const uint32_t theirs = embree_nearest(&e, o, d, RAY_FAR, &t), ours = h->triangle[i];
        v.hits += ours != VIT_NONE;
        if (ours != theirs)
            judge_difference(&v, r, i, o, d, ours, theirs, largest);
        else if (ours != VIT_NONE)
            judge_distance(&v, r->packed.triangles + ours, i, o, d, h->distance[i], t, largest);
    }
    embree_close(&e);
    print_message(
        "%s: %u triangles, %u rays, %u hits; %u on coincident surfaces, %u at edges (hit or miss %u), the farthest %.2g of the "
        "scene's size away; distances wrong by %.2g of it across the surface\n",
        name, r->m.triangles, s->n, v.hits, v.coincident, v.edges, v.misses, v.worst_edge, v.worst_across);
    assert_true(v.hits > s->n / 4);
    assert_true((double)v.edges < MOST_EDGES * (double)s->n);
}

/* The first rays again: every width gives the same bits; with a limit at, just below or beyond the hit, or anywhere, and with
 * inactive lanes, the answers follow from the nearest hits, to the bit. */
static void check_widths_and_limits(const ray_mesh *r, const ray_set *s, const ray_hits *nearest) {
    ray_set few = rays_new(FEW);
    uint64_t state = 2;
    for (uint32_t i = 0; i < few.n; i++) {
        float o[3], d[3];
        const float t = nearest->distance[i], kind[] = {t, nextafterf(t, 0), RAY_FAR, 30 * lab_uniform(&state), RAY_NOT_CAST};
        rays_get(s, i, o, d);
        rays_set(&few, i, o, d, kind[lab_random(&state) % 5]);
    }
    ray_hits h[LAB_WIDTHS];
    for (unsigned w = 0; w < LAB_WIDTHS; w++) {
        lab l = lab_open(lab_lanes[w], 0, ray_lab_kernels);
        h[w] = rays_cast(&l, lab_lanes[w], r, &few);
        lab_close(&l);
        hits_equal(&h[0], &h[w]);
    }
    for (uint32_t i = 0; i < few.n; i++) {
        const float limit = rays_limit(&few)[i];
        const bool hit = nearest->triangle[i] != VIT_NONE && nearest->distance[i] <= limit;
        assert_int_equal(h[0].occluded[i], hit ? ~0u : 0);
        assert_int_equal(h[0].triangle[i], hit ? nearest->triangle[i] : VIT_NONE);
        assert_true(h[0].distance[i] == (hit ? nearest->distance[i] : limit));
    }
    for (unsigned w = 0; w < LAB_WIDTHS; w++)
        hits_free(&h[w]);
    free(few.plane);
}

static void check_scene(const char *name, ray_mesh *r) {
    mesh_bake(r);
    ray_set s = parity_rays(r);
    lab l = lab_open(8, 0, ray_lab_kernels); /* the fastest width for rays in random directions */
    ray_hits h = rays_cast(&l, 8, r, &s);
    lab_close(&l);
    compare_with_embree(name, r, &s, &h);
    check_widths_and_limits(r, &s, &h);
    hits_free(&h);
    free(s.plane);
    mesh_free(r);
}

static void a_bumpy_hall_gives_embrees_hits(void **state) {
    ray_mesh r;
    (void)state;
    make_hall(&r);
    check_scene("bumpy hall", &r);
}

static void boxes_through_one_another_give_embrees_hits(void **state) {
    ray_mesh r;
    (void)state;
    make_boxes(&r);
    check_scene("boxes", &r);
}

static void the_cornell_box_gives_embrees_hits(void **state) {
    ray_mesh r;
    (void)state;
    if (!import_file(&r, VIT_BUILD_DIR "/scenes/cornell.obj"))
        skip();
    check_scene("cornell", &r);
}

static void sibenik_gives_embrees_hits(void **state) {
    ray_mesh r;
    (void)state;
    if (!import_scene(&r, "sibenik/sibenik.obj"))
        skip();
    check_scene("sibenik", &r);
}

static void sponza_gives_embrees_hits(void **state) {
    ray_mesh r;
    (void)state;
    if (!import_scene(&r, "sponza/sponza.gltf"))
        skip();
    check_scene("sponza", &r);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_bumpy_hall_gives_embrees_hits),    cmocka_unit_test(boxes_through_one_another_give_embrees_hits),
        cmocka_unit_test(the_cornell_box_gives_embrees_hits), cmocka_unit_test(sibenik_gives_embrees_hits),
        cmocka_unit_test(sponza_gives_embrees_hits),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
