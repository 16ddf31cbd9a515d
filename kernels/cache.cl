/* The pass ambient_light: ambient light that surfaces keep from each other. METHODS.md, "World-space cache". */

#if VIT_WITH(OCCLUSION)
kernel void ambient_light(global const vit_scene *scene, ROUND_PARAMETERS, global const uint *hit_triangle,
                          global const float *position, global const uint *normal, global const uint *albedo,
                          global const uint *specular, global const uint *cells, global float *direct WORK_PARAMETERS) {
    uint first = (uint)get_global_id(0) * VIT_LANES, n = scene->samples;
    if (first >= n || round_skips(first, active))
        return;
    li hit = L_NE(L_AS_INT(L_LOAD(hit_triangle + first)), L_I((int)VIT_NONE));
    if (!l_any(hit))
        return;
    WORK_BEGIN
    lv3 p = sample_position(scene, position, first), way = lv3_sub(p, lv3_load((cameras + frame)->eye));
    lf open = cache_open(scene, cells, p, l_decode_normal(L_LOAD(normal + first)), l_sqrt(lv3_dot(way, way)), hit WORK_PASS);
    open = l_sel(hit, open, L_F(0));
    lv3 all = l_decode_albedo(L_LOAD(albedo + first)), out = lv3_load_planes(direct, n, first);
    if (VIT_EFFECT_SPECULAR)
        all = lv3_along(all, l_decode_albedo(L_LOAD(specular + first)), L_F(1));
    out = lv3_set(fma(all.x, open * scene->ambient[0], out.x), fma(all.y, open * scene->ambient[1], out.y),
                  fma(all.z, open * scene->ambient[2], out.z));
    lv3_store_planes(out, direct, n, first);
    WORK_END
}
#endif
