/* The pass chains: view rays go on from them to what is seen there. A chain has at most vit_scene.chain rays beyond the
 * first. At its first glass a chain splits: layer 0 of the pixel goes on refracted, layer 1 mirrored, each with its Fresnel
 * part as weight. At later glass a chain takes the greater part with the whole weight: no light is lost, only its picture is
 * simpler. What is caught in glass or between panes leaves with the chain's last ray, straight on where it cannot be refracted.
 * A chain that does not end on a matt surface or in the sky is black. */
#if VIT_WITH(CHAINS)
/* Lanes whose triangle's material is a mirror or glass. */
static inline li chain_goes_on(global const vit_attributes *attributes, global const vit_material *materials, li hit,
                               li triangle) {
    li r = L_I(0), own;
    while (l_any(hit)) {
        uint word = attributes[surface_next(&hit, triangle, &own)].material;
        if (VIT_KIND_WITH(materials[word & VIT_MATERIAL_INDEX].kind, VIT_EFFECT_MIRROR, VIT_EFFECT_GLASS) != VIT_MATTE)
            r |= own;
    }
    return r;
}

kernel void chains(RAY_SCENE_PARAMETERS, global const vit_maps *maps, ROUND_PARAMETERS, global uint *hit_triangle,
                   global float *hit_distance, global float *rays, volatile global uint *split,
                   volatile global uint *reached WORK_PARAMETERS) {
    uint first = (uint)get_global_id(0) * VIT_LANES, n = scene->samples;
    if (first >= n || round_skips(first, active))
        return;
    /* 1. The view rays, and which of them met a mirror or glass. */
    global const vit_camera *camera = cameras + frame;
    li x, y, layer = L_I((int)(round % layers)), splits = L_I(0);
    l_pixel(scene, first, &x, &y);
    li triangle = L_AS_INT(L_LOAD(hit_triangle + first));
    lf t = L_LOAD(hit_distance + first), length = L_F(0);
    lv3 o = lv3_load(camera->eye), d = l_camera_ray(scene, camera, round / layers, x, y),
        weight = lv3_set(L_F(1), L_F(1), L_F(1));
    li going = chain_goes_on(attributes, materials,
                             round_active(scene, first, x, y, active) & L_NE(triangle, L_I((int)VIT_NONE)), triangle);
    lf cone = L_F(camera_cone(scene, camera, round / layers));
    WORK_BEGIN
    for (uint i = 0; i < scene->chain && l_any(going); i++) {
        /* 2. The surface there; as a mirror, it sends the ray back. */
        WORK_LANES(surface_points, going);
        if (VIT_EFFECT_REACH)
            reach_note(scene, attributes, reached, going, triangle, VIT_REACHED_VIEW);
        surface s = surface_at(SURFACE_SCENE, maps, o, d, l_sel(going, t, L_F(1)), going, triangle, cone);
        WORK_LANES(texture_fetches, s.textured);
        WORK_LANES(texture_fetches, s.mapped);
        li glass = VIT_EFFECT_GLASS ? going & L_NE(s.specular.kind, L_I((int)VIT_MIRROR)) : L_I(0);
        lv3 next = specular_mirrored(d, s.normal, s.face), tint = s.specular.specular, from = s.position;
        /* 3. Glass: the first one forks into the two layers, later ones take the greater part, the chain's last ray leaves. */
        if (VIT_EFFECT_GLASS && l_any(glass)) {
            li thin = L_EQ(s.specular.kind, L_I((int)VIT_THIN_GLASS)), inside = glass & s.back & ~thin;
            specular_paths p = specular_at_glass(d, s.normal, s.face, s.back, thin, s.specular.ior);
            li leaves = i + 1 == scene->chain ? inside | (glass & thin) : L_I(0), caught = leaves & L_GE(p.mirror, L_F(1));
            li forks = glass & ~splits & ~caught & L_LT(p.mirror, L_F(1)),
               mirrored = glass & ~leaves & L_GT(p.mirror, L_F(0.5f));
            mirrored = l_sel_i(forks, L_NE(layer, L_I(0)), mirrored);
            lf part = l_sel(forks, l_sel(mirrored, p.mirror, 1.0f - p.mirror), L_F(1));
            li through = glass & ~mirrored;
            splits |= forks;
            weight = lv3_sel(inside, specular_left(weight, s.specular.absorption, t), weight);
            weight = lv3_scale(weight, l_sel(glass, part, L_F(1)));
            next = lv3_sel(through, lv3_sel(caught, d, p.refracted), lv3_sel(glass, p.mirrored, next));
            from = lv3_sel(through, s.beyond, from);
            tint = lv3_sel(glass & mirrored, lv3_set(L_F(1), L_F(1), L_F(1)), tint);
        }
        /* 4. On, with what the surface leaves of the light. */
        weight = lv3_sel(going, lv3_set(weight.x * tint.x, weight.y * tint.y, weight.z * tint.z), weight);
        length += l_sel(going, t, L_F(0));
        o = lv3_sel(going, from, o);
        d = lv3_sel(going, next, d);
        /* 5. What the next ray meets. */
        lf reach = L_F(3e38f);
        li found = L_I((int)VIT_NONE);
        ray_packet r = ray_make(o, d);
        WORK_LANES(chain_rays, going);
        ray_nearest(RAY_SCENE, &r, going, &reach, &found);
        WORK_TRACED(r);
        t = l_sel(going, reach, t);
        triangle = l_sel_i(going, found, triangle);
        going = chain_goes_on(attributes, materials, going & L_NE(triangle, L_I((int)VIT_NONE)), triangle);
    }
    /* 6. The chains' ends. What still goes on is black, and hits nothing. */
    triangle = l_sel_i(going, L_I((int)VIT_NONE), triangle);
    weight = lv3_sel(going, lv3_set(L_F(0), L_F(0), L_F(0)), weight);
    L_STORE(L_AS_UINT(triangle), hit_triangle + first);
    L_STORE(t, hit_distance + first);
    lv3_store_planes(o, rays, n, first);
    lv3_store_planes(d, VIT_PLANE(rays, 3, n), n, first);
    L_STORE(length + l_sel(L_NE(triangle, L_I((int)VIT_NONE)), t, L_F(0)), VIT_PLANE(rays, 6, n) + first);
    lv3_store_planes(weight, VIT_PLANE(rays, 7, n), n, first);
    if (VIT_EFFECT_GLASS && VIT_EFFECT_FILM && round % layers == 0) {
        uint bits = l_bits(splits) << (first & 15u);
        if (bits)
            atomic_or(split + (first >> 4), bits);
    }
    WORK_END
}
#endif
