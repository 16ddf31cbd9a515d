/* Pass 3: direct light with hard shadows. METHODS.md P, step 2, in radiometric units. */

/* Fraction of a light's intensity that goes into direction -l (l: unit, towards the light). glTF KHR_lights_punctual. */
static inline lf light_cone(global const vit_light *light, lv3 l)
{
    if (VIT_EFFECT_SPOT && light->kind == VIT_LIGHT_SPOT) {
        lf cosine = -lv3_dot(l, lv3_load(light->direction));
        lf a = l_min(l_max(fma(cosine, L_F(light->spot_scale), L_F(light->spot_offset)), L_F(0)), L_F(1));
        return a * a;
    }
    return L_F(1);
}

/* Irradiance on a surface facing the light, a unit of intensity, at squared distance d2: 1/m2. */
static inline lf light_falloff(global const vit_light *light, lf d2)
{
    if (!VIT_EFFECT_RANGE)
        return l_div(1.0f, d2);
    lf q = d2 * light->inv_range2;
    if (light->falloff == VIT_FALLOFF_WINDOW)
        return l_max(1.0f - q, L_F(0));
    lf window = l_max(1.0f - q * q, L_F(0));
    return l_div(window * window, d2);
}

#if VIT_WITH(LIGHTS) && VIT_BUNDLE == 1
kernel void direct_light(RAY_SCENE_PARAMETERS, global const vit_light *lights, uint frame, global const uint *hit_triangle,
                         global const float *position, global const uint *normal, global const uint *albedo, global float *direct WORK_PARAMETERS)
{
    uint first = (uint)get_global_id(0) * VIT_LANES, n = scene->samples;
    if (first >= n)
        return;
    li hit = L_NE(L_AS_INT(L_LOAD(hit_triangle + first)), L_I((int)VIT_NONE));
    if (!l_any(hit))
        return;
    lv3 p = sample_position(scene, position, first), s = l_decode_normal(L_LOAD(normal + first));
    lv3 sum = lv3_set(L_F(0), L_F(0), L_F(0));
    float least = scene->ray_offset * 0.0625f, least2 = least * least; /* of distances, relative to the scene's size */
    WORK_BEGIN
    for (uint i = 0; i < scene->lights; i++) {
        global const vit_light *light = lights + (size_t)frame * scene->lights + i;
        lv3 to = lv3_sub(lv3_load(light->position), p);
        lf d2 = l_max(lv3_dot(to, to), L_F(least2)), d = l_sqrt(d2);
        lv3 l = lv3_scale(to, l_div(1.0f, d));
        lf e = l_max(lv3_dot(s, l), L_F(0)) * light_cone(light, l) * light_falloff(light, d2);
        li lit = hit & L_GT(e, L_F(0));
        if (!l_any(lit))
            continue;
        ray_packet r = ray_make(p, l);
        WORK_LANES(shadow_rays, lit);
        lit &= ~ray_occluded(RAY_SCENE, &r, lit, d);
        WORK_TRACED(r);
        sum = lv3_along(sum, lv3_load(light->intensity), l_sel(lit, e, L_F(0)));
    }
    lv3 a = lv3_scale(l_decode_albedo(L_LOAD(albedo + first)), L_F(VIT_INV_PI));
    lv3 out = lv3_load_planes(direct, n, first);
    lv3_store_planes(lv3_set(fma(a.x, sum.x, out.x), fma(a.y, sum.y, out.y), fma(a.z, sum.z, out.z)), direct, n, first);
    WORK_END
}
#elif VIT_WITH(LIGHTS)
/* The same for a bundle. */
kernel void direct_light(RAY_SCENE_PARAMETERS, global const vit_light *lights, uint frame, global const uint *hit_triangle,
                         global const float *position, global const uint *normal, global const uint *albedo, global float *direct WORK_PARAMETERS)
{
    uint bundle = (uint)get_global_id(0), n = scene->samples;
    if (bundle * 64 >= n)
        return;
    li hit[VIT_BUNDLE], lit[VIT_BUNDLE], all = L_I(0);
    for (uint i = 0; i < VIT_BUNDLE; i++) {
        hit[i] = L_NE(L_AS_INT(L_LOAD(hit_triangle + bundle_sample(scene, bundle, i))), L_I((int)VIT_NONE));
        all |= hit[i];
    }
    if (!l_any(all))
        return;
    ray_packet ray[VIT_BUNDLE];
    lv3 sum[VIT_BUNDLE];
    lf d[VIT_BUNDLE], e[VIT_BUNDLE], x[VIT_BUNDLE], y[VIT_BUNDLE], z[VIT_BUNDLE];
    float least = scene->ray_offset * 0.0625f, least2 = least * least; /* of distances, relative to the scene's size */
    WORK_BEGIN
    for (uint i = 0; i < VIT_BUNDLE; i++)
        sum[i] = lv3_set(L_F(0), L_F(0), L_F(0));
    for (uint k = 0; k < scene->lights; k++) {
        global const vit_light *light = lights + (size_t)frame * scene->lights + k;
        uint cast = 0; /* packets with rays */
        for (uint i = 0; i < VIT_BUNDLE; i++) {
            uint first = bundle_sample(scene, bundle, i);
            lit[i] = L_I(0);
            if (!l_any(hit[i]))
                continue;
            lv3 p = sample_position(scene, position, first), s = l_decode_normal(L_LOAD(normal + first)), to = lv3_sub(lv3_load(light->position), p);
            lf d2 = l_max(lv3_dot(to, to), L_F(least2));
            d[i] = l_sqrt(d2);
            lv3 l = lv3_scale(to, l_div(1.0f, d[i]));
            e[i] = l_max(lv3_dot(s, l), L_F(0)) * light_cone(light, l) * light_falloff(light, d2);
            lit[i] = hit[i] & L_GT(e[i], L_F(0));
            if (!l_any(lit[i]))
                continue;
            cast |= 1u << i;
            x[i] = to.x;
            y[i] = to.y;
            z[i] = to.z;
            ray[i] = ray_make(p, l);
            WORK_LANES(shadow_rays, lit[i]);
        }
        if (cast == 0)
            continue;
        bundle_shadows(RAY_SCENE, ray, cast, d, x, y, z, light->position, lit);
        for (uint i = 0; i < VIT_BUNDLE; i++) {
            if (l_any(lit[i]))
                sum[i] = lv3_along(sum[i], lv3_load(light->intensity), l_sel(lit[i], e[i], L_F(0)));
            if (cast >> i & 1u) {
                WORK_TRACED(ray[i]);
            }
        }
    }
    for (uint i = 0; i < VIT_BUNDLE; i++) {
        uint first = bundle_sample(scene, bundle, i);
        if (!l_any(hit[i]))
            continue;
        lv3 a = lv3_scale(l_decode_albedo(L_LOAD(albedo + first)), L_F(VIT_INV_PI)), out = lv3_load_planes(direct, n, first);
        lv3_store_planes(lv3_set(fma(a.x, sum[i].x, out.x), fma(a.y, sum[i].y, out.y), fma(a.z, sum[i].z, out.z)), direct, n, first);
    }
    WORK_END
}
#endif
