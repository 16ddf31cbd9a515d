/* Rounds of a frame: which samples each takes, and the film that adds up what they see. Anti-aliasing takes further copies of
 * the view samples, at other places in their pixels, only where the first copy shows an edge: Whitted, CACM 23(6), 1980.
 * Filters are where the copies lie (vit_scene.offset): filter importance sampling, Ernst et al. 2006, so that no pixel writes
 * to another. */

/* Light that the view shows: VIT_SHOWS_DIRECT, VIT_SHOWS_INDIRECT. */
static inline int view_light(vit_view view) {
    switch (view) {
#define X(name, light, meaning)                                                                                                \
    case VIT_VIEW_##name:                                                                                                      \
        return light;
        VIT_VIEWS(X)
#undef X
    }
    return 0;
}

/* A view of indirect light alone: `direct` holds lobes' part of it (gloss_filter). */
#define FILM_GLOSS_ALONE                                                                                                       \
    (VIT_EFFECT_GLOSS && (view_light((vit_view)VIT_VIEW) & (VIT_SHOWS_DIRECT | VIT_SHOWS_INDIRECT)) == VIT_SHOWS_INDIRECT)

/* What a pixel's sample sees, W/(m2 sr), by VIT_VIEW, before exposure. */
static inline lv3 sample_radiance(uint n, uint first, global const uint *albedo, global const float *direct,
                                  global const float *indirect, global const uint *specular, global const float *rays) {
    lv3 c = lv3_set(L_F(0), L_F(0), L_F(0));
    int light = view_light((vit_view)VIT_VIEW);
    if ((light & VIT_SHOWS_DIRECT) || FILM_GLOSS_ALONE)
        c = lv3_load_planes(direct, n, first);
    if (VIT_EFFECT_INDIRECT && (light & VIT_SHOWS_INDIRECT)) {
        lv3 a = l_decode_albedo(L_LOAD(albedo + first)), e = lv3_load_planes(indirect, n, first);
        if (VIT_EFFECT_SPECULAR) { /* indirect light comes from all about: the lobe reflects as much as a matt surface would */
            lf part = L_F(1);
            if (VIT_EFFECT_GLOSS) /* but for those that have it by rays */
                part = l_sel(L_LT(L_AS_FLOAT(L_LOAD(specular + n + first)), L_F(0)), L_F(0), part);
            a = lv3_along(a, l_decode_albedo(L_LOAD(specular + first)), part);
        }
        a = lv3_scale(a, L_F(VIT_INV_PI));
        c = lv3_set(fma(a.x, e.x, c.x), fma(a.y, e.y, c.y), fma(a.z, e.z, c.z));
    }
    if (VIT_EFFECT_CHAINS && light != 0) {
        lv3 w = chain_weight(rays, n, first);
        c = lv3_set(c.x * w.x, c.y * w.y, c.z * w.z);
    }
    return c;
}

#if VIT_WITH(FILM)
/* Samples of the round: all of the first copy, then those on edges; of the second layer, those whose chain split in the first.
 */
kernel void activate(global const vit_scene *scene, uint round, uint layers, global const uint *edges, global uint *split,
                     global uint *active) {
    uint block = (uint)get_global_id(0), bits = 0;
    if (block >= scene->samples / 16)
        return;
    for (uint first = block * 16u; first < block * 16u + 16u; first += VIT_LANES) {
        li x, y;
        l_pixel(scene, first, &x, &y);
        bits |= l_bits(l_inside(scene, x, y)) << (first & 15u);
    }
    if (VIT_EFFECT_ANTIALIAS && round >= layers)
        bits &= edges[block];
    if (VIT_EFFECT_GLASS && round % layers != 0)
        bits &= split[block];
    else if (VIT_EFFECT_GLASS)
        split[block] = 0;
    active[block] = bits;
}

/* Adds what the round's samples see to the film. */
kernel void expose(global const vit_scene *scene, ROUND_PARAMETERS, global const uint *albedo, global const float *direct,
                   global const float *indirect, global const uint *specular, global const float *rays, global float *film,
                   global uint *shown) {
    uint first = (uint)get_global_id(0) * VIT_LANES, n = scene->samples;
    if (first >= n || round_skips(first, active))
        return;
    li x, y;
    l_pixel(scene, first, &x, &y);
    lv3 c = lv3_sel(round_active(scene, first, x, y, active),
                    sample_radiance(n, first, albedo, direct, indirect, specular, rays), lv3_set(L_F(0), L_F(0), L_F(0)));
    if (round > 0)
        c = lv3_along(lv3_load_planes(film, n, first), c, L_F(1));
    lv3_store_planes(c, film, n, first);
    if (VIT_EFFECT_ANTIALIAS && round < layers) {
        lv3 display = lv3_scale(c, L_F(cameras[frame].exposure));
        L_STORE(l_encode_albedo(lv3_set(l_min(display.x, L_F(1)), l_min(display.y, L_F(1)), l_min(display.z, L_F(1)))),
                shown + first);
    }
}
#endif

#if VIT_WITH(ANTIALIAS)
static inline li film_difference(lu a, lu b) {
    li x = L_AS_INT(a), y = L_AS_INT(b);
    return max(x, y) - min(x, y);
}

/* Greatest difference of a channel between two packed colours. */
static inline li shown_difference(lu a, lu b) {
    li r = film_difference(a & 1023u, b & 1023u), g = film_difference((a >> 10) & 1023u, (b >> 10) & 1023u),
       c = film_difference((a >> 20) & 1023u, (b >> 20) & 1023u);
    return max(max(r, g), c);
}

/* Pixels that differ from one of their four neighbours: a bit a sample. */
kernel void find_edges(global const vit_scene *scene, global const uint *shown, global uint *edges) {
    uint block = (uint)get_global_id(0), bits = 0;
    if (block >= scene->samples / 16)
        return;
    int least = (int)(scene->contrast * 1023.0f);
    for (uint first = block * 16u; first < block * 16u + 16u; first += VIT_LANES) {
        li x, y, most = L_I(0);
        l_pixel(scene, first, &x, &y);
        li inside = l_inside(scene, x, y), right = L_I((int)scene->width - 1), bottom = L_I((int)scene->height - 1);
        x = min(x, right);
        y = min(y, bottom);
        lu own = l_gather_u(shown, l_sample_at(scene, x, y));
        most = max(most, shown_difference(own, l_gather_u(shown, l_sample_at(scene, max(x - 1, L_I(0)), y))));
        most = max(most, shown_difference(own, l_gather_u(shown, l_sample_at(scene, min(x + 1, right), y))));
        most = max(most, shown_difference(own, l_gather_u(shown, l_sample_at(scene, x, max(y - 1, L_I(0))))));
        most = max(most, shown_difference(own, l_gather_u(shown, l_sample_at(scene, x, min(y + 1, bottom)))));
        bits |= l_bits(inside & L_GE(most, L_I(least))) << (first & 15u);
    }
    edges[block] = bits;
}
#endif
