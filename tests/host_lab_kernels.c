/* host_lab.h for one instruction set: compiled as runtime/host/kernels.c is, once for each, with another name (HOST_LAB). */
#include "tests/host_lab.h"
#include "runtime/host/opencl_c.h"

_Static_assert(VIT_LANES == HOST_LAB_LANES, "as the header says");

/* Lights of all kinds, for what is called with one light; rays and surfaces do not look at these. */
#define LIGHT_EFFECTS (VIT_BIT(SPOT) | VIT_BIT(RANGE) | VIT_BIT(DIRECTIONAL) | VIT_BIT(SKY_IMAGE))
#define X(bit, name, macro, why) static const uint VIT_EFFECT_##macro = (LIGHT_EFFECTS & VIT_BIT(macro)) != 0;
VIT_EFFECTS(X)
#undef X
#define X(macro) static const uint VIT_EFFECT_##macro = 0;
VIT_MODES(X)
#undef X
static const vit_view VIT_VIEW = VIT_VIEW_final;
static const vit_format VIT_FORMAT = VIT_FORMAT_XRGB8888;
#define VIT_WITH(effect) 1
#define VIT_WITH_DENSE 1
#define VIT_COUNT_WORK 0

#include "kernel_list.h"

#define MESH m->scene, m->triangles, m->attributes, m->materials, NULL, NULL, NULL
#define RAYS MESH, m->nodes

static ray_packet packet(const float *rays, uint n, uint first, lf *limit) {
    *limit = L_LOAD(VIT_PLANE(rays, 6, n) + first);
    return ray_make(lv3_load_planes(rays, n, first), lv3_load_planes(VIT_PLANE(rays, 3, n), n, first));
}

static void nearest(const host_lab_mesh *m, const float *rays, uint32_t n, float *distance, uint32_t *triangle,
                    uint32_t *dark) {
    for (uint i = 0; i < n; i += VIT_LANES) {
        lf limit, t;
        ray_packet r = packet(rays, n, i, &limit);
        li found, active = L_GE(limit, L_F(0));
        t = limit;
        ray_nearest(RAYS, &r, active, &t, &found);
        L_STORE(t, distance + i);
        L_STORE(L_AS_UINT(found), triangle + i);
        L_STORE(L_AS_UINT(ray_occluded(RAYS, &r, active, limit)), dark + i);
    }
}

static void nearest_of_all(const host_lab_mesh *m, const float *rays, uint32_t n, float *distance, uint32_t *triangle,
                           uint32_t *dark) {
    for (uint i = 0; i < n; i += VIT_LANES) {
        lf limit;
        ray_packet r = packet(rays, n, i, &limit);
        lf best = limit;
        li found = L_I((int)VIT_NONE), active = L_GE(limit, L_F(0)), any = L_I(0);
        for (uint k = 0; k < m->scene->triangles; k++) {
            lf d = best;
            li hit = ray_triangle(RAYS, &r, k, active, limit, &d);
            any |= hit;
            hit &= L_LT(d, best) | (L_EQ(d, best) & L_EQ(found, L_I((int)VIT_NONE)));
            best = l_sel(hit, d, best);
            found = l_sel_i(hit, L_I((int)k), found);
        }
        L_STORE(best, distance + i);
        L_STORE(L_AS_UINT(found), triangle + i);
        L_STORE(L_AS_UINT(any), dark + i);
    }
}

static void occluded(const host_lab_mesh *m, const float *rays, uint32_t n, uint32_t *dark) {
    for (uint i = 0; i < n; i += VIT_LANES) {
        lf limit;
        ray_packet r = packet(rays, n, i, &limit);
        L_STORE(L_AS_UINT(ray_occluded(RAYS, &r, L_GE(limit, L_F(0)), limit)), dark + i);
    }
}

static void surfaces(const host_lab_mesh *m, const float *rays, const float *distance, const uint32_t *triangle, uint32_t n,
                     float *out) {
    for (uint i = 0; i < n; i += VIT_LANES) {
        lf limit;
        ray_packet r = packet(rays, n, i, &limit);
        li found = L_AS_INT(L_LOAD(triangle + i)), hit = L_NE(found, L_I((int)VIT_NONE));
        surface s = surface_at(MESH, 0, r.o, r.d, l_sel(hit, L_LOAD(distance + i), L_F(1)), hit, found, L_F(0));
        lv3_store_planes(s.position, out, n, i);
        lv3_store_planes(s.face, VIT_PLANE(out, 3, n), n, i);
        lv3_store_planes(s.normal, VIT_PLANE(out, 6, n), n, i);
        lv3_store_planes(s.albedo, VIT_PLANE(out, 9, n), n, i);
    }
}

static void slices(const vit_scene *s, const float *depth, uint32_t n, int32_t *slice) {
    for (uint i = 0; i < n; i += VIT_LANES)
        L_STORE(cluster_slice(s, L_LOAD(depth + i)), slice + i);
}

static void wrap(const float *coordinate, uint32_t mode, uint32_t n, float *wrapped) {
    for (uint i = 0; i < n; i += VIT_LANES)
        L_STORE(texture_wrap(L_LOAD(coordinate + i), mode), wrapped + i);
}

#define IN(k) L_LOAD(VIT_PLANE(in, k, n) + i)
#define IN3(k) lv3_load_planes(VIT_PLANE(in, k, n), n, i)
#define OUT(v, k) L_STORE(v, VIT_PLANE(out, k, n) + i)
#define OUT3(v, k) lv3_store_planes(v, VIT_PLANE(out, k, n), n, i)

/* Numbers and directions, of eight lanes from i on. */
static void call_sampling(host_lab_function f, const float *in, uint n, uint i, float *out) {
    lf a, b;
    switch (f) {
    case HOST_LAB_pcg:
        OUT(L_AS_FLOAT(l_pcg(L_AS_UINT(IN(0)))), 0);
        break;
    case HOST_LAB_unit_float:
        OUT(l_unit_float(L_AS_UINT(IN(0))), 0);
        break;
    case HOST_LAB_even_bits:
        OUT(L_AS_FLOAT(l_even_bits(L_AS_UINT(IN(0)))), 0);
        break;
    case HOST_LAB_sincos:
        l_sincos_turn(IN(0), &a, &b);
        OUT(a, 0);
        OUT(b, 1);
        break;
    case HOST_LAB_exp2:
        OUT(l_exp2(IN(0)), 0);
        break;
    case HOST_LAB_unit:
        OUT3(lv3_unit(IN3(0)), 0);
        break;
    case HOST_LAB_basis: {
        ray_packet frame = ray_make(IN3(0), IN3(0));
        OUT3(frame.ax, 0);
        OUT3(frame.ay, 3);
        break;
    }
    case HOST_LAB_cosine:
        OUT3(ray_cosine(IN3(0), IN(3), IN(4)), 0);
        break;
    case HOST_LAB_place:
        l_octahedral(IN3(0), &a, &b);
        OUT(a, 0);
        OUT(b, 1);
        break;
    case HOST_LAB_normal:
        OUT3(l_decode_normal(L_AS_UINT(IN(0))), 0);
        break;
    case HOST_LAB_choose: {
        const cache_nearest near = {{IN(0), IN(1), IN(2)}, {L_I(0)}, {L_I(0)}};
        OUT(L_FROM_INT(cache_choose(&near, IN(3))), 0);
        break;
    }
    default:
        OUT(srgb_curve(IN(0)), 0);
    }
}

/* Light that leaves, arrives and is sent on. */
static void call_light(host_lab_function f, const host_lab_given *given, const float *in, uint n, uint i, float *out) {
    const vit_light *light = given->light;
    lf a, b;
    lv3 o, d;
    switch (f) {
    case HOST_LAB_cone:
        OUT(light_cone(light, IN3(0)), 0);
        break;
    case HOST_LAB_falloff:
        OUT(light_falloff(light, IN(0)), 0);
        break;
    case HOST_LAB_left:
        OUT(light_left(light, IN(0)), 0);
        break;
    case HOST_LAB_way: {
        const lit_sample s = {.p = IN3(0), .n = IN3(3)};
        OUT3(lit_way(given->scene, light, &s, &o, &a, &b), 0);
        OUT(a, 3);
        OUT(b, 4);
        break;
    }
    case HOST_LAB_emission: { /* as photon_paths has it */
        d = photon_emission(light, L_AS_UINT(IN(0)), &o, &a);
        const float whole = light->kind == VIT_LIGHT_DIRECTIONAL ? VIT_PI * light->spot_scale * light->spot_scale
                                                                 : 2.0f * VIT_PI * (1.0f - light->cos_outer);
        OUT3(o, 0);
        OUT3(d, 3);
        OUT3(lv3_scale(lv3_load(light->intensity), a * vit_div(whole, (float)light->path_count)), 6);
        break;
    }
    case HOST_LAB_sky:
        OUT3(sky_radiance(given->scene, given->sky, IN3(0)), 0);
        break;
    case HOST_LAB_lobe:
        OUT(specular_lobe(IN3(0), IN3(3), IN3(6), IN(9)), 0);
        break;
    case HOST_LAB_mirrored:
        OUT3(specular_mirrored(IN3(0), IN3(3), IN3(6)), 0);
        break;
    case HOST_LAB_glass: {
        const specular_paths p = specular_at_glass(IN3(0), IN3(3), IN3(6), L_GT(IN(9), L_F(0)), L_GT(IN(10), L_F(0)), IN(11));
        OUT3(p.mirrored, 0);
        OUT3(p.refracted, 3);
        OUT(p.mirror, 6);
        break;
    }
    case HOST_LAB_mean:
        OUT3(specular_mean(IN3(0), IN(3)), 0);
        break;
    default:
        OUT(specular_absorbed(IN(0), IN(1)), 0);
    }
}

static void call(host_lab_function f, const host_lab_given *given, const float *in, uint32_t n, float *out) {
    for (uint i = 0; i < n; i += VIT_LANES)
        if (f < HOST_LAB_cone)
            call_sampling(f, in, n, i, out);
        else
            call_light(f, given, in, n, i, out);
}

static void open_parts(const vit_scene *s, const vit_cache_cell *cells, const uint32_t *counts, const float *in, uint32_t n,
                       float *out) {
    for (uint i = 0; i < n; i += VIT_LANES) {
        OUT(cache_open(s, (const uint *)cells, counts, IN3(0), IN3(3), IN(6), L_GE(IN(6), L_F(0))), 0);
    }
}

static void points(const vit_scene *s, const vit_cache_cell *cells, const float *receivers, const float *in, uint32_t n,
                   float *out) {
    for (uint i = 0; i < n; i += VIT_LANES) {
        const lv3 e = cache_irradiance(s, (const uint *)cells, receivers, IN3(0), IN3(3), IN(6), L_GE(IN(6), L_F(0)));
        OUT3(e, 0);
    }
}

static void transfer(const vit_transfer *code, const float *x, float *projected, float *mixed, float *sums, float *y) {
    const uint groups = code->rank / VIT_LANES, rows = code->stride / VIT_LANES;
    for (uint i = 0; i < groups * transfer_column_chunks(code); i++)
        transfer_project_item(i, code, x, projected);
    for (uint i = 0; i < 3 * groups; i++)
        transfer_mix_item(i, code, projected, mixed);
    for (uint i = 0; i < rows * transfer_sums(code); i++)
        transfer_sums_item(i, code, x, mixed, sums);
    for (uint i = 0; i < rows; i++)
        transfer_add_item(i, code, sums, y);
}

static void relit(const host_lab_received *r, uint32_t frame, float *out) {
    for (host_item = 0; host_item < r->scene->receivers / 2 / VIT_LANES; host_item++)
        relight(r->scene, frame, r->lights, r->groups, r->words, r->coefficients, r->frames, r->receivers, out);
}

static void receive(const host_lab_received *r, const float *light, const float *places, const uint32_t *triangle,
                    const int32_t *back, uint32_t n, float *irradiance) {
    for (uint i = 0; i < n; i += VIT_LANES) {
        const li found = L_AS_INT(L_LOAD(triangle + i)), hit = L_NE(found, L_I((int)VIT_NONE));
        const lf b1 = L_LOAD(VIT_PLANE(places, 3, n) + i), b2 = L_LOAD(VIT_PLANE(places, 4, n) + i);
        lv3_store_planes(receivers_light(r->sides, (const uint *)r->cells, r->splits, light, hit, found, L_LOAD(back + i), b1,
                                         b2, lv3_load_planes(places, n, i), NULL),
                         irradiance, n, i);
    }
}

static void weights(const host_lab_mesh *m, const float *rays, const float *distance, const uint32_t *triangle, uint32_t n,
                    float *b1_b2, int32_t *back) {
    for (uint i = 0; i < n; i += VIT_LANES) {
        lf limit;
        ray_packet r = packet(rays, n, i, &limit);
        li found = L_AS_INT(L_LOAD(triangle + i)), hit = L_NE(found, L_I((int)VIT_NONE));
        surface s = surface_at(MESH, 0, r.o, r.d, l_sel(hit, L_LOAD(distance + i), L_F(1)), hit, found, L_F(0));
        L_STORE(s.b1, b1_b2 + i);
        L_STORE(s.b2, VIT_PLANE(b1_b2, 1, n) + i);
        L_STORE(s.back, back + i);
    }
}

extern const host_lab HOST_LAB;
const host_lab HOST_LAB = {HOST_ISA, nearest, nearest_of_all, occluded, surfaces,   slices, wrap,
                           call,     relit,   receive,        weights,  open_parts, points, transfer};
