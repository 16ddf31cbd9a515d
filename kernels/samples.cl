/* The pass samples: view samples, what each pixel's ray found, or with mirrors and glass what it found in the end. */

/* Radiance of the sky in direction d, W/(m2 sr). */
static inline lv3 sky_radiance(global const vit_scene *scene, global const vit_sky_texel *sky, lv3 d) {
    if (!VIT_EFFECT_SKY_IMAGE)
        return lv3_load(scene->background);
    /* The octahedral square, -1..1, to texels; the gutter holds what lies beyond its edges. */
    lf x, y, size = L_F((float)scene->sky_size);
    l_octahedral(d, &x, &y);
    lf u = fma(fma(x, L_F(0.5f), L_F(0.5f)), size, L_F(-0.5f)), v = fma(fma(y, L_F(0.5f), L_F(0.5f)), size, L_F(-0.5f));
    u = l_min(l_max(u, L_F(-1)), size - 0.5f);
    v = l_min(l_max(v, L_F(-1)), size - 0.5f);
    lf fu = floor(u), fv = floor(v);
    int pitch = (int)scene->sky_size + 2;
    li at = ((L_TRUNC(fv) + 1) * pitch + L_TRUNC(fu) + 1) * 4;
    u -= fu;
    v -= fv;
    global const float *texels = (global const float *)sky;
    lf c[3];
    for (int k = 0; k < 3; k++) {
        lf c00 = L_GATHER(lf, texels + k, at), c10 = L_GATHER(lf, texels + k, at + 4);
        lf c01 = L_GATHER(lf, texels + k, at + pitch * 4), c11 = L_GATHER(lf, texels + k, at + pitch * 4 + 4);
        lf top = fma(c10 - c00, u, c00), bottom = fma(c11 - c01, u, c01);
        c[k] = l_max(fma(bottom - top, v, top), L_F(0));
    }
    return lv3_set(c[0], c[1], c[2]);
}

/* Makes the packet's samples nothing: zeros. */
static inline void samples_clear(global const vit_scene *scene, uint first, global float *position, global uint *normal,
                                 global uint *albedo, global uint *accept, global float *inverse_area, global uint *specular,
                                 global float *indirect, global uint *by_rays) {
    lv3 zero = lv3_set(L_F(0), L_F(0), L_F(0));
    sample_store_position(scene, zero, zero, L_I(0), position, first);
    L_STORE(L_U(0), normal + first);
    L_STORE(L_U(VIT_SAMPLE_NOTHING), albedo + first);
    if (VIT_EFFECT_SPECULAR) {
        L_STORE(L_U(0), specular + first);
        L_STORE(L_U(0), specular + scene->samples + first);
    }
    if (VIT_EFFECT_ZONES)
        L_STORE(L_U(0), accept + first);
    if (VIT_EFFECT_AREA)
        L_STORE(L_F(0), inverse_area + first);
    if (VIT_EFFECT_RECEIVERS)
        lv3_store_planes(zero, indirect, scene->samples, first);
    if (VIT_EFFECT_LIGHTMAP_RAYS)
        L_STORE(L_U(0), by_rays + first);
}

/* Radiance of surfaces that needs no light source: emission and ambient light. */
static inline lv3 sample_own_light(global const vit_scene *scene, const surface *s) {
    if (!VIT_EFFECT_AMBIENT || VIT_EFFECT_OCCLUSION) /* with occlusion the pass ambient_light adds it */
        return s->emission;
    lv3 all = VIT_EFFECT_SPECULAR ? lv3_along(s->albedo, s->specular.specular, L_F(1)) : s->albedo;
    return lv3_set(fma(all.x, L_F(scene->ambient[0]), s->emission.x), fma(all.y, L_F(scene->ambient[1]), s->emission.y),
                   fma(all.z, L_F(scene->ambient[2]), s->emission.z));
}

/* Of light that is baked for the unbent normal, what one that is bent by a normal map gets: as if the half space before the
 * surface were evenly bright. METHODS.md, "View samples". */
static inline lf sample_open_part(const surface *s) {
    return fma(lv3_dot(s->normal, s->smooth), L_F(0.5f), L_F(0.5f));
}

kernel void samples(SURFACE_PARAMETERS, global const vit_maps *maps, ROUND_PARAMETERS, global const uint *hit_triangle,
                    global const float *hit_distance, global const float *rays, global const vit_sky_texel *sky,
                    global const uint *sides, global const uint *cells, global float *position, global uint *normal,
                    global uint *albedo, global float *direct, global uint *accept, global float *inverse_area,
                    global uint *specular, RECEIVER_PARAMETERS, global float *indirect, LIGHTMAP_PARAMETERS,
                    global uint *by_rays, volatile global uint *reached WORK_PARAMETERS) {
    uint first = (uint)get_global_id(0) * VIT_LANES, n = scene->samples;
    if (first >= n || round_skips(first, active))
        return;
    global const vit_camera *camera = cameras + frame;
    li x, y;
    l_pixel(scene, first, &x, &y);
    li triangle = L_AS_INT(L_LOAD(hit_triangle + first));
    li hit = L_NE(triangle, L_I((int)VIT_NONE));
    lv3 light = lv3_load(scene->background), eye = lv3_load(camera->eye), d = eye;
    lf t = l_sel(hit, L_LOAD(hit_distance + first), L_F(1)), whole = t;
    /* 1. The ray that found the sample. */
    if (VIT_EFFECT_CHAINS) {
        eye = chain_origin(rays, n, first);
        d = chain_direction(rays, n, first);
        whole = l_sel(hit, chain_length(rays, n, first), L_F(1));
    } else if (VIT_EFFECT_SKY_IMAGE || l_any(hit))
        d = l_camera_ray(scene, camera, round / layers, x, y);
    /* 2. Where nothing is hit, the sky. */
    if (VIT_EFFECT_SKY_IMAGE && l_any(~hit))
        light = sky_radiance(scene, sky, d);
    if (VIT_EFFECT_REACH) {
        reach_note(scene, attributes, reached, hit, triangle, VIT_REACHED_VIEW);
        if (l_any(round_active(scene, first, x, y, active) & ~hit))
            atomic_or(reached + scene->materials + 1u, VIT_REACHED_VIEW);
    }
    WORK_BEGIN
    WORK_LANES(surface_points, hit);
    /* 3. The surface: position, normal, reflectances. */
    if (l_any(hit)) {
        lf cone = L_F(camera_cone(scene, camera, round / layers));
        /* The footprint goes on widening behind a mirror as if it were flat. */
        if (VIT_EFFECT_CHAINS)
            cone *= l_div(whole, l_max(t, L_F(1e-30f)));
        surface s = surface_at(SURFACE_SCENE, maps, eye, d, t, hit, triangle, cone);
        WORK_LANES(texture_fetches, s.textured);
        WORK_LANES(texture_fetches, s.mapped);
        /* Lanes that hit nothing are zeros, as in packets that hit nothing: traces are the same at every width. */
        sample_store_position(scene, s.position, s.face, hit, position, first);
        L_STORE(l_sel_u(hit, l_encode_normal(s.normal), L_U(0)), normal + first);
        li emits = L_GT(s.emission.x + s.emission.y + s.emission.z, L_F(0));
        lu flags = l_sel_u(s.dark, L_U(VIT_SAMPLE_DARK), L_U(0));
        if (VIT_EFFECT_AREA_LIGHTS && VIT_EFFECT_EMISSION)
            flags = l_sel_u(emits & ~s.dark, L_U(VIT_SAMPLE_AREA_LIGHT), flags);
        L_STORE(l_sel_u(hit, l_encode_albedo(s.albedo) | flags, L_U(VIT_SAMPLE_NOTHING)), albedo + first);
        if (VIT_EFFECT_SPECULAR) {
            L_STORE(l_sel_u(hit, l_encode_albedo(s.specular.specular), L_U(0)), specular + first);
            L_STORE(l_sel_u(hit, L_AS_UINT(s.specular.exponent), L_U(0)), specular + n + first);
        }
        /* 4. Its own light. */
        light = lv3_sel(hit, sample_own_light(scene, &s), light);
        /* 5. What is baked for its cell. */
        if (VIT_EFFECT_ZONES || VIT_EFFECT_AREA) {
            cell_place cell = cell_at(sides, hit, triangle, s.back, s.b1, s.b2);
            if (VIT_EFFECT_ZONES)
                L_STORE(l_sel_u(hit, cell_accept(cells, &cell), L_U(0)), accept + first);
            if (VIT_EFFECT_AREA)
                L_STORE(l_sel(hit, cell_inverse_area(cells, &cell), L_F(0)), inverse_area + first);
        }
        if (VIT_EFFECT_ON_CELLS) {
            lv3 e = receivers_light(sides, receiver_cells, receiver_splits, VIT_EFFECT_LIVE ? relit : receivers, hit & ~s.dark,
                                    triangle, s.back, s.b1, s.b2, s.position,
                                    VIT_EFFECT_REACH ? reached + scene->materials + VIT_REACHED_MORE : reached);
            lv3_store_planes(VIT_EFFECT_NORMAL_MAPS ? lv3_scale(e, sample_open_part(&s)) : e, indirect, n, first);
        }
        /* 6. Baked light of the sky and of area lights. */
        if (VIT_EFFECT_LIGHTMAP) {
            lv3 e = receivers_light(LIGHTMAP, hit & ~s.dark, triangle, s.back, s.b1, s.b2, s.position, 0);
            li unknown = L_LT(e.x, L_F(0));
            if (VIT_EFFECT_NORMAL_MAPS)
                e = lv3_scale(e, sample_open_part(&s));
            if (VIT_EFFECT_LIGHTMAP_RAYS)
                L_STORE(L_AS_UINT(unknown & 1), by_rays + first);
            lv3 a = lv3_scale(l_decode_albedo(l_encode_albedo(s.albedo)), l_sel(hit & ~unknown, L_F(VIT_INV_PI), L_F(0)));
            light = lv3_set(fma(a.x, e.x, light.x), fma(a.y, e.y, light.y), fma(a.z, e.z, light.z));
        }
    } else if (l_any(L_NE(L_AS_INT(L_LOAD(albedo + first)), L_I((int)VIT_SAMPLE_NOTHING))))
        /* Else all this stands there already. */
        samples_clear(scene, first, position, normal, albedo, accept, inverse_area, specular, indirect, by_rays);
    else if (!VIT_EFFECT_SKY_IMAGE)
        return;
    /* Radiance that needs no light source: emission, ambient light and background. Direct light is added to it. */
    lv3_store_planes(light, direct, n, first);
    WORK_END
}
