/* The passes sky_light and sky_filter. METHODS.md, "Sky light". Each pixel of 4 x 4 looks into another set of directions, all
 * sets together are even, and whatever 4 x 4 pixels a window shows, it holds each set once: a sample's irradiance is the mean
 * over the window about it of those on the same surface, so that 16 times as many directions count as are traced. Albedo comes
 * after, so textures stay sharp. */

#if VIT_WITH(SKY_RAYS) || VIT_WITH(GLOSS)
#define SKYLIGHT_BENT 16.0f /* over (height / distance)^2 of a neighbour: no weight is left from 1/4 of the way on */
#define SKYLIGHT_FLAT 4.0f  /* ray_offsets of height that do not count: what rounding makes of a plane */

/* Corners of the samples' windows of 4 x 4 pixels, which lie in the picture whole where it is that large. */
static inline void skylight_window(global const vit_scene *scene, uint first, li *x, li *y) {
    l_pixel(scene, first, x, y);
    *x = max(min(*x - 2, L_I((int)scene->width - 4)), L_I(0));
    *y = max(min(*y - 2, L_I((int)scene->height - 4)), L_I(0));
}

/* Weights, 0..1, of samples at p of unit normal s in what those at `at` of normal `own` (packed: own_code) get. */
static inline lf skylight_weight(lv3 at, lv3 own, lu own_code, lv3 p, lu code, float flat) {
    lv3 to = lv3_sub(p, at);
    lf height = l_max(fabs(lv3_dot(to, own)) - flat, L_F(0)), d2 = l_max(lv3_dot(to, to), L_F(1e-30f));
    lf w = l_max(1.0f - l_div(height * height * SKYLIGHT_BENT, d2), L_F(0));
    li turned = L_NE(L_AS_INT(code), L_AS_INT(own_code));
    if (l_any(turned)) {
        lf cosine = l_max(lv3_dot(own, l_decode_normal(code)), L_F(0));
        cosine *= cosine;
        cosine *= cosine;
        w *= l_sel(turned, cosine * cosine, L_F(1));
    }
    return w;
}
#endif

#if VIT_WITH(SKY_RAYS)
/* Irradiance, and with specular reflection what the lobe reflects, into planes of `skylight`; -1 where there is no sample. */
kernel void sky_light(RAY_SCENE_PARAMETERS, ROUND_PARAMETERS, global const vit_light_sample *area_lights,
                      global const uint *hit_triangle, global const float *position, global const uint *normal,
                      global const float *rays, global const uint *specular, global float *skylight WORK_PARAMETERS) {
    uint first = (uint)get_global_id(0) * VIT_LANES, n = scene->samples;
    if (first >= n || round_skips(first, active))
        return;
    li triangle = L_AS_INT(L_LOAD(hit_triangle + first)), hit = L_NE(triangle, L_I((int)VIT_NONE));
    if (VIT_EFFECT_LIGHTMAP) /* the matt light of others is baked */
        hit &= lit_shines(specular, first);
    lit_sample s = lit_load(scene, ROUND, triangles, first, hit, hit_triangle, position, normal, rays, specular);
    if (VIT_EFFECT_GLOSS) { /* rays find the sky for GGX lobes */
        s.no_lobe = L_LT(s.exponent, L_F(0));
        if (VIT_EFFECT_LIGHTMAP)
            s.hit = hit &= ~s.no_lobe;
    }
    if (l_any(hit)) {
        WORK_BEGIN
        lit_by_area_lights(RAY_SCENE, area_lights + VIT_PATTERNS * scene->area_samples, scene->sky_samples, 1,
                           lit_set(first, round / layers), triangle, &s WORK_PASS);
        WORK_END
    }
    s.matt.x = l_sel(hit, s.matt.x, L_F(-1));
    lv3_store_planes(s.matt, skylight, n, first);
    if (VIT_EFFECT_SPECULAR)
        lv3_store_planes(s.glossy, skylight + 3 * (size_t)n, n, first);
}

kernel void sky_filter(global const vit_scene *scene, global const float *position, global const uint *normal,
                       global const uint *albedo, global const uint *specular, global const float *skylight,
                       global float *direct) {
    uint first = (uint)get_global_id(0) * VIT_LANES, n = scene->samples;
    if (first >= n)
        return;
    li hit = L_GE(L_LOAD(skylight + first), L_F(0));
    if (!l_any(hit))
        return;
    li x, y;
    skylight_window(scene, first, &x, &y);
    li right = L_I((int)scene->width - 1), bottom = L_I((int)scene->height - 1);
    lit_sample s;
    s.hit = hit;
    s.p = sample_position(scene, position, first);
    lu code = L_LOAD(normal + first);
    s.n = l_decode_normal(code);
    s.matt = s.glossy = lv3_set(L_F(0), L_F(0), L_F(0));
    lf weights = L_F(0), lobe_weights = L_F(0);
    for (int dy = 0; dy < 4; dy++)
        for (int dx = 0; dx < 4; dx++) {
            li there = l_sample_at(scene, min(x + dx, right), min(y + dy, bottom));
            lv3 e = lv3_set(L_GATHER(lf, skylight, there), L_GATHER(lf, VIT_PLANE(skylight, 1, n), there),
                            L_GATHER(lf, VIT_PLANE(skylight, 2, n), there));
            lu its = l_gather_u(normal, there);
            lf w = skylight_weight(s.p, s.n, code, sample_position_of(scene, position, there), its,
                                   scene->ray_offset * SKYLIGHT_FLAT);
            w = l_sel(L_GE(e.x, L_F(0)), w, L_F(0));
            weights += w;
            s.matt = lv3_along(s.matt, e, w);
            if (VIT_EFFECT_SPECULAR) { /* a lobe turns twice as far as its surface: only where that does not turn */
                w = l_sel(L_EQ(L_AS_INT(its), L_AS_INT(code)), w, L_F(0));
                lobe_weights += w;
                global const float *lobe = skylight + 3 * (size_t)n;
                e = lv3_set(L_GATHER(lf, lobe, there), L_GATHER(lf, VIT_PLANE(lobe, 1, n), there),
                            L_GATHER(lf, VIT_PLANE(lobe, 2, n), there));
                s.glossy = lv3_along(s.glossy, e, w);
            }
        }
    lf scale = l_sel(hit, l_div(1.0f, l_max(weights, L_F(1e-30f))), L_F(0));
    s.matt = lv3_scale(s.matt, VIT_EFFECT_LIGHTMAP ? L_F(0) : scale);
    s.glossy = lv3_scale(s.glossy, l_sel(hit, l_div(1.0f, l_max(lobe_weights, L_F(1e-30f))), L_F(0)));
    lit_store(scene, &s, first, albedo, specular, direct);
}
#endif
