/* The passes cache_sample, cache_merge and ambient_light: ambient light that surfaces keep from each other; point_light.
 * METHODS.md, "World-space cache". The first two only where the cache is filled while playing: then words of `counts` are rays
 * of a point in all frames (low half) and how many of these were open, `frame_counts` two words a point, of the frame's own. */

#if VIT_WITH(LIVE_CACHE)
/* Record times VIT_CACHE_POINTS plus point that the lanes' samples count for; -1: none. */
static inline li cache_target(global const vit_scene *scene, global const uint *cells, lv3 p, lv3 n, lf distance, li lanes,
                              lu random) {
    uint seeds[CACHE_NEAR * VIT_LANES], tags[CACHE_NEAR * VIT_LANES];
    int of_cell[3 * VIT_LANES], of_q[3 * VIT_LANES];
    cache_table t = cache_of_occlusion(scene, cells, 0);
    lf next, u = l_unit_float(l_pcg(random + 1u));
    li level = cache_level(&t, distance, &next);
    level -= L_LT(l_unit_float(l_pcg(random)), next);
    cache_place place = cache_place_of(p, L_F(vit_div(1.0f, scene->cache_step)) * L_AS_FLOAT((127 - level) << 23));
    cache_seeds((place.x - 1) >> 1, (place.y - 1) >> 1, (place.z - 1) >> 1, L_AS_UINT(level), seeds, tags);
    /* 1. The side, by shares. */
    lf share[3] = {cache_share(n.x), cache_share(n.y), cache_share(n.z)};
    u *= share[0] + share[1] + share[2];
    li y = L_GE(u, share[0]), z = L_GE(u, share[0] + share[1]) & y;
    li side = -2 * y - 2 * z - L_LT(l_sel(z, n.z, l_sel(y, n.y, n.x)), L_F(0));
    /* 2. The point, by distances. */
    cache_nearest near = cache_nearest_of(&place, seeds);
    for (int i = 0; i < 3; i++) {
        L_STORE(near.cell[i], of_cell + i * VIT_LANES);
        L_STORE(near.q[i], of_q + i * VIT_LANES);
    }
    li chosen = cache_choose(&near, l_unit_float(l_pcg(random + 2u))) * VIT_LANES + L_INDEX;
    li of = L_GATHER(li, of_cell, chosen), cell = of * VIT_LANES + L_INDEX;
    lv3 at = cache_from_corner(&place, ((place.x - 1) >> 1) + (of & 1), ((place.y - 1) >> 1) + (of >> 1 & 1),
                               ((place.z - 1) >> 1) + (of >> 2));
    li record = cache_find_part(&t, lanes, L_GATHER(lu, seeds, cell), L_AS_UINT(side), L_GATHER(lu, tags, cell), at);
    return l_sel_i(lanes & L_GE(record, L_I(0)), record * (int)VIT_CACHE_POINTS + L_GATHER(li, of_q, chosen), L_I(-1));
}

/* Lanes whose point is not known well enough: its value's variance, of one more open and one more closed ray than there were,
 * is above that of cache_error. */
static inline li cache_wants(global const vit_scene *scene, global const uint *counts, li target) {
    lu word = l_gather_u(counts, target & L_GE(target, L_I(0)));
    lf rays = L_FROM_INT(L_AS_INT(word & 0xffffu)), open = L_FROM_INT(L_AS_INT(word >> CACHE_HALF)), all = rays + 2.0f;
    lf bound = all * all * (all + 1.0f) * (scene->cache_error * scene->cache_error);
    return L_GT((open + 1.0f) * (rays - open + 1.0f), bound) & L_GE(target, L_I(0));
}

/* One ray a sample, for one of the points near it. */
kernel void cache_sample(RAY_SCENE_PARAMETERS, ROUND_PARAMETERS, global const uint *hit_triangle, global const float *position,
                         global const uint *normal, global const uint *cells, global const uint *counts,
                         volatile global uint *frame_counts WORK_PARAMETERS) {
    uint first = (uint)get_global_id(0) * VIT_LANES;
    if (first >= scene->samples || round_skips(first, active))
        return;
    li triangle = L_AS_INT(L_LOAD(hit_triangle + first)), hit = L_NE(triangle, L_I((int)VIT_NONE));
    if (!l_any(hit))
        return;
    WORK_BEGIN
    lv3 p = sample_position(scene, position, first), n = l_decode_normal(L_LOAD(normal + first)),
        way = lv3_sub(p, lv3_load((cameras + frame)->eye));
    lu random = l_pcg(L_AS_UINT((int)first + L_INDEX) + l_pcg(L_U(frame)));
    li target = cache_target(scene, cells, p, n, l_sqrt(lv3_dot(way, way)), hit, random);
    li wants = cache_wants(scene, counts, target);
    if (l_any(wants)) {
        lv3 d = ray_cosine(n, l_unit_float(l_pcg(random + 3u)), l_unit_float(l_pcg(random + 4u)));
        li open = wants;
        if (VIT_EFFECT_SMOOTH)
            open &= L_GT(lv3_dot(lit_face(triangles, hit, triangle, p), d), L_F(0));
        ray_packet r = ray_make(p, d);
        WORK_LANES(shadow_rays, open);
        open &= ~ray_occluded(RAY_SCENE, &r, open, L_F(scene->ambient_radius));
        WORK_TRACED(r);
        int at[VIT_LANES], is_open[VIT_LANES];
        L_STORE(l_sel_i(wants, target, L_I(-1)), at);
        L_STORE(open, is_open);
        for (int i = 0; i < VIT_LANES; i++)
            if (at[i] >= 0) {
                atomic_add(frame_counts + 2 * (uint)at[i], 1u);
                if (is_open[i])
                    atomic_add(frame_counts + 2 * (uint)at[i] + 1u, 1u);
            }
    }
    WORK_END
}

/* Adds the frame's rays to all frames'. A point gets at most 2^26 rays a frame, one of each sample, on top of 2^16: 32 bits
 * hold them. */
kernel void cache_merge(global const vit_scene *scene, global uint *frame_counts, global uint *counts) {
    uint record = (uint)get_global_id(0);
    if (record >= scene->cache_cells)
        return;
    for (uint q = 0; q < VIT_CACHE_POINTS; q++) {
        uint point = record * VIT_CACHE_POINTS + q, before = counts[point];
        uint rays = (before & 0xffffu) + frame_counts[2 * point], open = (before >> CACHE_HALF) + frame_counts[2 * point + 1];
        while (rays >> CACHE_HALF) { /* both are halved: the mean stays what it is, but for less than one ray of 2^15 */
            rays >>= 1;
            open >>= 1;
        }
        counts[point] = rays | open << CACHE_HALF;
        frame_counts[2 * point] = frame_counts[2 * point + 1] = 0;
    }
}
#endif

#if VIT_WITH(OCCLUSION)
kernel void ambient_light(global const vit_scene *scene, ROUND_PARAMETERS, global const uint *hit_triangle,
                          global const float *position, global const uint *normal, global const uint *albedo,
                          global const uint *specular, global const uint *cells, global const uint *counts,
                          global float *direct WORK_PARAMETERS) {
    uint first = (uint)get_global_id(0) * VIT_LANES, n = scene->samples;
    if (first >= n || round_skips(first, active))
        return;
    li hit = L_NE(L_AS_INT(L_LOAD(hit_triangle + first)), L_I((int)VIT_NONE));
    if (!l_any(hit))
        return;
    WORK_BEGIN
    lv3 p = sample_position(scene, position, first), way = lv3_sub(p, lv3_load((cameras + frame)->eye));
    lf open = cache_open(scene, cells, VIT_EFFECT_LIVE_CACHE ? counts : 0, p, l_decode_normal(L_LOAD(normal + first)),
                         l_sqrt(lv3_dot(way, way)), hit WORK_PASS);
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

#if VIT_WITH(POINTS)
/* Indirect light of the basis where its receivers are points: the irradiance of view samples. */
kernel void point_light(global const vit_scene *scene, ROUND_PARAMETERS, global const uint *hit_triangle,
                        global const float *position, global const uint *normal, global const uint *albedo,
                        global const uint *cells, global const float *receivers, global const float *relit,
                        global float *indirect WORK_PARAMETERS) {
    uint first = (uint)get_global_id(0) * VIT_LANES, n = scene->samples;
    if (first >= n || round_skips(first, active))
        return;
    li hit = L_NE(L_AS_INT(L_LOAD(hit_triangle + first)), L_I((int)VIT_NONE));
    if (!l_any(hit))
        return;
    WORK_BEGIN
    li lit = hit & L_EQ(L_AS_INT(L_LOAD(albedo + first) & VIT_SAMPLE_DARK), L_I(0));
    lv3 p = sample_position(scene, position, first), way = lv3_sub(p, lv3_load((cameras + frame)->eye));
    lv3 e = cache_irradiance(scene, cells, VIT_EFFECT_RELIGHT ? relit : receivers, p, l_decode_normal(L_LOAD(normal + first)),
                             l_sqrt(lv3_dot(way, way)), lit WORK_PASS);
    lv3_store_planes(lv3_sel(lit, e, lv3_set(L_F(0), L_F(0), L_F(0))), indirect, n, first);
    WORK_END
}
#endif
