/* The pass resolve: light to pixels. METHODS.md, "Film and resolve" (30): radiance = direct + albedo / pi * irradiance;
 * exposure; transfer curve. VIT_VIEW and VIT_FORMAT are numbers of vit_view and vit_format (vitrine_frame.h). */

/* IEC 61966-2-1 curve, 0..1. Absolute error below 1.5e-7 (tests/numeric). */
static inline lf srgb_curve(lf x) {
    lf c = l_min(l_max(x, L_F(0)), L_F(1));
    lf low = c * 12.92f;
    lf high = fma(l_exp2(l_log2(l_max(c, L_F(1e-4f))) * (1.0f / 2.4f)), L_F(1.055f), L_F(-0.055f));
    return l_sel(L_LE(c, L_F(0.0031308f)), low, high);
}

static inline li to_steps(lf x, float steps) {
    return L_TRUNC(fma(x, L_F(steps), L_F(0.5f)));
}

static inline void write_floats(const int *at, const int *in, lv3 c, global float *framebuffer) {
    float r[VIT_LANES], g[VIT_LANES], b[VIT_LANES];
    L_STORE(c.x, r);
    L_STORE(c.y, g);
    L_STORE(c.z, b);
    for (int i = 0; i < VIT_LANES; i++)
        if (in[i])
            vstore4(VIT_FLOAT4(r[i], g[i], b[i], 1.0f), (size_t)at[i], framebuffer);
}

static inline void write_half_words(const int *at, const int *in, lv3 c, global ushort *framebuffer) {
    int v[VIT_LANES];
    L_STORE((to_steps(c.x, 31.0f) << 11) | (to_steps(c.y, 63.0f) << 5) | to_steps(c.z, 31.0f), v);
    for (int i = 0; i < VIT_LANES; i++)
        if (in[i])
            framebuffer[at[i]] = (ushort)v[i];
}

static inline void write_words(const int *at, const int *in, li inside, lv3 c, global uint *framebuffer) {
    int v[VIT_LANES];
    L_STORE((to_steps(c.x, 255.0f) << 16) | (to_steps(c.y, 255.0f) << 8) | to_steps(c.z, 255.0f), v);
    if (VIT_LANES >= 4 && !l_any(~inside)) { /* lanes are rows of four pixels */
        for (int i = 0; i < VIT_LANES; i += 4)
            for (int k = 0; k < 4; k++)
                framebuffer[at[i] + k] = (uint)v[i + k];
        return;
    }
    for (int i = 0; i < VIT_LANES; i++)
        if (in[i])
            framebuffer[at[i]] = (uint)v[i];
}

/* Writes display values 0..1 (or linear ones for RGBA32F) to the pixels' places. */
static inline void write_pixels(uint pitch, li x, li y, li inside, lv3 c, global uchar *framebuffer) {
    int at[VIT_LANES], in[VIT_LANES];
    L_STORE(y * (int)pitch + x, at);
    L_STORE(inside, in);
    switch ((vit_format)VIT_FORMAT) {
    case VIT_FORMAT_XRGB8888:
        write_words(at, in, inside, c, (global uint *)framebuffer);
        break;
    case VIT_FORMAT_RGB565:
        write_half_words(at, in, c, (global ushort *)framebuffer);
        break;
    case VIT_FORMAT_RGBA32F:
        write_floats(at, in, c, (global float *)framebuffer);
        break;
    }
}

/* Black, blue, green, yellow, red, white over 0..1. */
static inline lv3 heat_colour(lf h) {
    lf x = l_min(l_max(h, L_F(0)), L_F(1)) * 5.0f;
    lf zero = L_F(0), one = L_F(1);
    lf r = l_min(l_max(x - 2.0f, zero), one);
    lf g = l_min(l_max(x - 1.0f, zero), one) - l_min(l_max(x - 3.0f, zero), one) + l_max(x - 4.0f, zero);
    lf b = l_min(x, one) - l_min(l_max(x - 1.0f, zero), one) + l_max(x - 4.0f, zero);
    return lv3_set(r, g, b);
}

/* A colour a cluster, shaded by the normal. */
static inline lv3 cluster_colour(lu key, lu normal) {
    lu h = l_pcg(key);
    lf shade = L_FROM_INT(L_AS_INT(normal >> 8) & 0xff) * (0.3f / 255.0f) + 0.6f;
    return lv3_scale(
        lv3_set(L_FROM_INT(L_AS_INT(h & 255u)), L_FROM_INT(L_AS_INT((h >> 8) & 255u)), L_FROM_INT(L_AS_INT((h >> 16) & 255u))),
        shade * (1.0f / 255.0f));
}

/* Photons of the lanes' clusters; white from 4095 on. */
static inline lv3 cluster_heat(global const vit_scene *scene, lu key, uint max_nodes, global const uint *masks,
                               global const uint *prefix, global const uint *list_count) {
    uint k[VIT_LANES];
    float count[VIT_LANES];
    L_STORE(key, k);
    for (int i = 0; i < VIT_LANES; i++) {
        uint cluster = k[i] == VIT_NONE ? VIT_NONE : cluster_of(scene, masks, prefix, k[i]);
        count[i] = cluster < max_nodes ? (float)list_count[cluster] : 0.0f;
    }
    return heat_colour(l_log2(L_LOAD(count) + 1.0f) * (1.0f / 12.0f));
}

/* The least and the greatest view depth of the scene's box, metres; in front of the camera, and not more than 2^7 apart. */
static inline void box_depths(global const vit_scene *scene, global const vit_camera *camera, global const vit_bvh_node *bvh,
                              float *near, float *far) {
    *near = *far = 0;
    for (int k = 0; k < 3; k++) {
        float axis = camera->forward[k], lo = vit_min(bvh->lo0[k], bvh->lo1[k]), hi = vit_max(bvh->hi0[k], bvh->hi1[k]);
        *near = fma(axis, (axis > 0 ? lo : hi) - camera->eye[k], *near);
        *far = fma(axis, (axis > 0 ? hi : lo) - camera->eye[k], *far);
    }
    *far = vit_max(*far, scene->slice_near * 2.0f);
    *near = vit_min(vit_max(*near, vit_max(scene->slice_near, *far * 0x1p-7f)), *far * 0.5f);
}

/* The length of the view ray, all of its chain, as brightness, in even steps of its logarithm: 1 for the nearest, 1/16 for the
 * farthest, so that it is not taken for nothing. The range is what the path sees, by the depth slices in use; without them, the
 * scene's box. Both are of depth along the view axis, a little less than the ray's length off the middle. */
static inline lf depth_shade(global const vit_scene *scene, global const vit_camera *camera, global const vit_bvh_node *bvh,
                             lf depth) {
    lf least = L_F(scene->slice_near), octaves = L_F(vit_div((float)scene->slice_count, scene->slice_scale)), skipped = L_F(0);
    if (VIT_EFFECT_PHOTONS)
        skipped = L_F(vit_div((float)scene->slice_first, scene->slice_scale));
    else {
        float near, far;
        box_depths(scene, camera, bvh, &near, &far);
        least = L_F(near);
        octaves = l_log2(L_F(vit_div(far, near)));
    }
    lf part = l_div(l_log2(l_div(l_max(depth, least), least)) - skipped, octaves);
    return fma(l_min(l_max(part, L_F(0)), L_F(1)), L_F(-0.9375f), L_F(1));
}

/* The photons' colours over c, where there is a dot. */
static inline lv3 over_dots(global const vit_scene *scene, li x, li y, li inside, lv3 c, global const uint *dots,
                            global const vit_photon *photons) {
    int px[VIT_LANES], py[VIT_LANES], in[VIT_LANES];
    float r[VIT_LANES], g[VIT_LANES], b[VIT_LANES];
    L_STORE(x, px);
    L_STORE(y, py);
    L_STORE(inside, in);
    L_STORE(c.x, r);
    L_STORE(c.y, g);
    L_STORE(c.z, b);
    for (int i = 0; i < VIT_LANES; i++) {
        uint dot = in[i] ? dots[(size_t)py[i] * scene->width + (size_t)px[i]] : 0;
        if (dot > 0) {
            global const vit_photon *p = photons + dot - 1;
            float top = vit_max(vit_max(p->power[0], p->power[1]), vit_max(p->power[2], 1e-30f));
            r[i] = vit_div(p->power[0], top);
            g[i] = vit_div(p->power[1], top);
            b[i] = vit_div(p->power[2], top);
        }
    }
    return lv3_set(L_LOAD(r), L_LOAD(g), L_LOAD(b));
}

kernel void resolve(global const vit_scene *scene, global const vit_camera *cameras, uint frame, global const vit_bvh_node *bvh,
                    global const uint *hit_triangle, global const float *hit_distance, global const uint *normal,
                    global const uint *albedo, global const float *direct, uint max_nodes, global const float *indirect,
                    global const uint *keys, global const uint *masks, global const uint *prefix, global const uint *list_count,
                    global const uint *dots, global const vit_photon *photons, global const uint *specular,
                    global const float *rays, global const float *film, global const uint *edges, uint pitch,
                    global uchar *framebuffer) {
    uint first = (uint)get_global_id(0) * VIT_LANES, n = scene->samples;
    if (first >= n)
        return;
    li x, y;
    l_pixel(scene, first, &x, &y);
    li inside = l_inside(scene, x, y);
    if (!l_any(inside))
        return;
    /* 1. The pixel's light, of all its samples or of its only one. */
    float exposure = cameras[frame].exposure;
    li hit = L_NE(L_AS_INT(L_LOAD(hit_triangle + first)), L_I((int)VIT_NONE));
    lv3 zero = lv3_set(L_F(0), L_F(0), L_F(0)), c = zero;
    int display = 0; /* is c a display value already? */
    if (VIT_EFFECT_FILM) {
        c = lv3_load_planes(film, n, first);
        if (VIT_EFFECT_ANTIALIAS) {
            c = lv3_scale(c, l_sel(block_bits(edges, first), L_F(vit_div(1.0f, (float)scene->copies)), L_F(1)));
        }
    } else
        c = sample_radiance(n, first, albedo, direct, indirect, specular, rays);
    /* 2. Or the method's insides. */
    switch ((vit_view)VIT_VIEW) {
    case VIT_VIEW_final:
    case VIT_VIEW_direct:
    case VIT_VIEW_indirect:
    case VIT_VIEW_photons:
        break;
    case VIT_VIEW_clusters:
    case VIT_VIEW_heat:
        if (VIT_EFFECT_PHOTONS) {
            lu key = L_LOAD(keys + first);
            c = VIT_VIEW == VIT_VIEW_heat ? cluster_heat(scene, key, max_nodes, masks, prefix, list_count)
                                          : cluster_colour(key, L_LOAD(normal + first));
            c = lv3_sel(L_NE(L_AS_INT(key), L_I((int)VIT_NONE)), c, zero);
            display = 1;
        }
        break;
    case VIT_VIEW_normals: {
        lv3 s = l_decode_normal(L_LOAD(normal + first));
        c = lv3_sel(
            hit, lv3_set(fma(s.x, L_F(0.5f), L_F(0.5f)), fma(s.y, L_F(0.5f), L_F(0.5f)), fma(s.z, L_F(0.5f), L_F(0.5f))), zero);
        display = 1;
        break;
    }
    case VIT_VIEW_depth: {
        lf depth = VIT_EFFECT_CHAINS ? chain_length(rays, n, first) : L_LOAD(hit_distance + first);
        lf shown = depth_shade(scene, cameras + frame, bvh, l_sel(hit, depth, L_F(scene->slice_near)));
        c = lv3_sel(hit, lv3_set(shown, shown, shown), zero);
        display = 1;
        break;
    }
    case VIT_VIEW_albedo:
        c = lv3_sel(hit, l_decode_albedo(L_LOAD(albedo + first)), zero);
        exposure = 1.0f;
        break;
    }
    /* 3. To display values, and to memory. */
    if (!display)
        c = lv3_scale(c, L_F(exposure));
    if (VIT_FORMAT != VIT_FORMAT_RGBA32F && !display)
        c = lv3_set(srgb_curve(c.x), srgb_curve(c.y), srgb_curve(c.z));
    if (VIT_EFFECT_DOTS)
        c = over_dots(scene, x, y, inside, c, dots, photons);
    write_pixels(pitch, x, y, inside, c, framebuffer);
}

#if VIT_WITH(DOTS)
kernel void dots_clear(global const vit_scene *scene, global uint *dots) {
    uint i = (uint)get_global_id(0);
    if (i < scene->width * scene->height)
        dots[i] = 0;
}

/* The view `photons`: each visible photon as 2 x 2 pixels; where several fall on one, the greatest index shows. */
kernel void photon_dots(global const vit_scene *scene, global const vit_camera *cameras, uint frame,
                        global const vit_photon *photons, global const float *hit_distance, volatile global uint *dots) {
    uint i = (uint)get_global_id(0);
    if (i >= scene->photons || !(photons[i].radius2 > 0))
        return;
    global const vit_camera *c = cameras + frame;
    float q[3], z = 0, a = 0, b = 0, right2 = 0, down2 = 0, d2 = 0;
    for (int k = 0; k < 3; k++) {
        q[k] = photons[i].position[k] - c->eye[k];
        z = fma(q[k], c->forward[k], z);
        a = fma(q[k], c->right[k], a);
        b = fma(q[k], c->down[k], b);
        right2 = fma(c->right[k], c->right[k], right2);
        down2 = fma(c->down[k], c->down[k], down2);
        d2 = fma(q[k], q[k], d2);
    }
    if (!(z > 0))
        return;
    float px = vit_div(a, right2 * z) + 0.5f * (float)scene->width, py = vit_div(b, down2 * z) + 0.5f * (float)scene->height;
    if (!(px >= 0) || !(py >= 0) || !(px < (float)scene->width - 1) || !(py < (float)scene->height - 1))
        return;
    uint x = (uint)px, y = (uint)py;
    if (vit_sqrt(d2) > hit_distance[sample_at(scene, x, y)] * 1.01f)
        return;
    for (uint k = 0; k < 4; k++)
        atomic_max(dots + (size_t)(y + k / 2) * scene->width + x + k % 2, i + 1);
}
#endif

#if VIT_WITH(PHOTONS)
/* Puts a fault of the frame behind those before it; the oldest makes room. */
static inline void note_fault(global uint *faults, uint frame, uint code, uint count) {
    uint noted = faults[0], at = 1 + 3 * (noted % VIT_FAULT_RING);
    if (count == 0)
        return;
    faults[at] = frame;
    faults[at + 1] = code;
    faults[at + 2] = count;
    /* beyond 2^32 - 1 the ring turns on: only that some were lost is told */
    faults[0] = noted + 1 != 0 ? noted + 1 : VIT_FAULT_RING * 2;
}

static inline uint account_sum(uint counter, uint a, uint b) {
    if (counter == VIT_COUNTER_slice_min)
        return min(a, b);
    return counter == VIT_COUNTER_dropped_samples || counter == VIT_COUNTER_dropped_entries ? add_sat(a, b) : max(a, b);
}

/* Last: adds the round's counters, which come first, to the frame's, which come third, and to those since vit_open, between
 * them: sums for what was dropped, extremes for the rest. Notes faults. */
kernel void account(global uint *counters, uint frame, uint round, global uint *faults) {
    for (uint i = (uint)get_local_id(0); i < VIT_COUNTER_COUNT; i += (uint)get_local_size(0)) {
        global uint *total = counters + VIT_COUNTER_COUNT + i, *whole = counters + 2 * VIT_COUNTER_COUNT + i;
        *total = i == VIT_COUNTER_slice_min ? max(*total, counters[i]) : account_sum(i, *total, counters[i]);
        *whole = round == 0 ? counters[i] : account_sum(i, *whole, counters[i]);
    }
    if (get_local_id(0) == 0) {
        note_fault(faults, frame, VIT_FAULT_samples_dropped, counters[VIT_COUNTER_dropped_samples]);
        note_fault(faults, frame, VIT_FAULT_entries_dropped, counters[VIT_COUNTER_dropped_entries]);
    }
}
#endif
