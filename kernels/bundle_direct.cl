/* The pass direct_light where lanes are more than one: 8 x 8 shadow rays to a light go down the tree together (bundle.clh). */
#if VIT_WITH(LIGHTS) && VIT_BUNDLE > 1
kernel void direct_light(RAY_SCENE_PARAMETERS, ROUND_PARAMETERS, global const vit_light *lights,
                         LIT_PARAMETERS WORK_PARAMETERS) {
    uint bundle = (uint)get_global_id(0);
    if (bundle * 64 >= scene->samples)
        return;
    lit_sample s[VIT_BUNDLE];
    li lit[VIT_BUNDLE];
    uint hits = 0; /* packets with hits */
    for (uint i = 0; i < VIT_BUNDLE; i++) {
        uint first = bundle_sample(scene, bundle, i);
        li hit = L_NE(L_AS_INT(L_LOAD(hit_triangle + first)), L_I((int)VIT_NONE));
        if (!l_any(hit))
            continue;
        hits |= 1u << i;
        s[i] = lit_load(scene, ROUND, triangles, first, hit, hit_triangle, position, normal, rays, specular);
    }
    if (hits == 0)
        return;
    ray_packet ray[VIT_BUNDLE];
    lf d[VIT_BUNDLE], e[VIT_BUNDLE], x[VIT_BUNDLE], y[VIT_BUNDLE], z[VIT_BUNDLE];
    WORK_BEGIN
    for (uint k = 0; k < scene->lights; k++) {
        global const vit_light *light = lights + (size_t)frame * scene->lights + k;
        uint cast = 0; /* packets with rays */
        for (uint i = 0; i < VIT_BUNDLE; i++) {
            if (!(hits >> i & 1u))
                continue;
            lv3 to, l = lit_way(scene, light, s + i, &to, d + i, e + i);
            lit[i] = s[i].hit & L_GT(e[i], L_F(0));
            if (!l_any(lit[i]))
                continue;
            cast |= 1u << i;
            x[i] = to.x;
            y[i] = to.y;
            z[i] = to.z;
            ray[i] = ray_make(s[i].p, l);
            WORK_LANES(shadow_rays, lit[i]);
        }
        if (cast == 0)
            continue;
        if (VIT_EFFECT_DIRECTIONAL && light->kind == VIT_LIGHT_DIRECTIONAL) { /* its rays pass no one point */
            for (uint i = 0; i < VIT_BUNDLE; i++)
                if (cast >> i & 1u)
                    lit[i] &= ~ray_occluded(RAY_SCENE, ray + i, lit[i], d[i]);
        } else
            bundle_shadows(RAY_SCENE, ray, cast, d, x, y, z, light->position, lit);
        for (uint i = 0; i < VIT_BUNDLE; i++)
            if (cast >> i & 1u) {
                lit_add(s + i, ray[i].d, l_sel(lit[i], e[i], L_F(0)), lv3_load(light->intensity));
                WORK_TRACED(ray[i]);
            }
    }
    for (uint i = 0; i < VIT_BUNDLE; i++)
        if (hits >> i & 1u)
            lit_store(scene, s + i, bundle_sample(scene, bundle, i), albedo, specular, direct);
    WORK_END
}
#endif
