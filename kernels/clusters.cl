/* The passes cluster_*, number_nodes and make_nodes: view-sample clusters. METHODS.md, "Clusters". A key exists by one bit: the
 * bits are the leaf masks of the hierarchy, and each set bit also sets its ancestors' bits, so that one prefix sum over all
 * masks numbers all nodes. */

/* Where bit i of x (axis 0), y (1) or z (2) lies in a key: see vit_scene.key_bits. */
static inline uint key_bit(global const vit_scene *scene, uint axis, uint i) {
    return scene->key_bits_n + min(i + (axis > 0 ? 1u : 0u), scene->key_bits_x) +
           min(i + (axis > 1 ? 1u : 0u), scene->key_bits_y) + min(i, scene->key_bits_z);
}

static inline uint key_spread(global const vit_scene *scene, uint axis, uint bits, uint value) {
    uint key = 0;
    for (uint i = 0; i < bits; i++)
        key |= ((value >> i) & 1u) << key_bit(scene, axis, i);
    return key;
}

/* Depth slice of view depth z, counted from slice_first. METHODS.md, "Clusters" (16). */
static inline li cluster_slice(global const vit_scene *scene, lf z) {
    lf k = floor(l_log2(l_div(l_max(z, L_F(scene->slice_near)), scene->slice_near)) * scene->slice_scale);
    return L_TRUNC(l_min(k, L_F(8191.0f))) - (int)scene->slice_first;
}

/* Direction on a cube, 6 faces x 3 x 3: 0..53. */
static inline li cluster_direction(lv3 n) {
    lf ax = fabs(n.x), ay = fabs(n.y), az = fabs(n.z);
    li on_x = L_GE(ax, ay) & L_GE(ax, az), on_y = ~on_x & L_GE(ay, az);
    lf major = l_sel(on_x, n.x, l_sel(on_y, n.y, n.z)), u = l_sel(on_x, n.y, n.x), v = l_sel(on_x | on_y, n.z, n.y);
    lf scale = l_div(1.5f, l_max(fabs(major), L_F(1e-9f)));
    li iu = min(L_TRUNC(fma(u, scale, L_F(1.5f))), L_I(2)), iv = min(L_TRUNC(fma(v, scale, L_F(1.5f))), L_I(2));
    li face = l_sel_i(on_x, L_I(0), l_sel_i(on_y, L_I(2), L_I(4))) + (L_LT(major, L_F(0)) & 1);
    return face * 9 + iv * 3 + iu;
}

#if VIT_WITH(PHOTONS)
/* Clears what the round counts up; photons are those of the first round. */
kernel void clear_masks(global const vit_scene *scene, uint round, global uint *masks, volatile global uint *counters) {
    uint i = (uint)get_global_id(0);
    if (i < scene->mask_words)
        masks[i] = 0;
    if (i < VIT_COUNTER_COUNT)
        counters[i] = i == VIT_COUNTER_slice_min ? 0xffffffffu : i == VIT_COUNTER_photons && round > 0 ? counters[i] : 0;
}

#endif

static inline void mark_key(global const vit_scene *scene, volatile global uint *masks, uint key) {
    for (uint level = scene->levels; level-- > 0;) {
        atomic_or(masks + scene->level_first[level] + (key >> 5), 1u << (key & 31u));
        key >>= 5;
    }
}

#if VIT_WITH(PHOTONS)
/* Keys of the samples, and their existence bits. A work-item takes `run` samples in a row. */
kernel void cluster_keys(global const vit_scene *scene, global const vit_camera *cameras, uint frame, uint run,
                         global const uint *hit_triangle, global const float *position, global const uint *normal,
                         global const uint *albedo, volatile global uint *masks, global uint *keys,
                         volatile global uint *counters) {
    uint n = scene->samples, begin = (uint)get_global_id(0) * run, end = min(begin + run, n),
         per_tile = scene->tile * scene->tile;
    global const vit_camera *camera = cameras + frame;
    lv3 eye = lv3_load(camera->eye), forward = lv3_load(camera->forward);
    uint known = VIT_NONE; /* neighbours mostly share a key: mark a run of equal ones once */
    li nearest = L_I(0x7fffffff), farthest = L_I(-1);
    for (uint first = begin; first < end; first += VIT_LANES) {
        uint tile = first / per_tile;
        uint base = key_spread(scene, 0, scene->key_bits_x, tile % scene->tiles_x) |
                    key_spread(scene, 1, scene->key_bits_y, tile / scene->tiles_x);
        li valid = L_NE(L_AS_INT(L_LOAD(hit_triangle + first)), L_I((int)VIT_NONE));
        if (VIT_EFFECT_DARK_SIDES)
            valid &= L_EQ(L_AS_INT(L_LOAD(albedo + first) & VIT_SAMPLE_DARK), L_I(0));
        li key = L_I((int)VIT_NONE);
        if (l_any(valid)) {
            lv3 p = sample_position(scene, position, first);
            li slice = cluster_slice(scene, lv3_dot(lv3_sub(p, eye), forward));
            nearest = min(nearest, l_sel_i(valid, slice, nearest));
            farthest = max(farthest, l_sel_i(valid, slice, farthest));
            slice = min(max(slice, L_I(0)), L_I((int)(scene->slice_count - 1)));
            key = L_I((int)base);
            for (uint i = 0; i < scene->key_bits_z; i++)
                key |= ((slice >> (int)i) & 1) << (int)key_bit(scene, 2, i);
            if (VIT_EFFECT_NORMAL_KEYS)
                key |= cluster_direction(l_decode_normal(L_LOAD(normal + first)));
            key = l_sel_i(valid, key, L_I((int)VIT_NONE));
            while (l_any(valid)) {
                uint k = (uint)l_reduce_max(l_sel_i(valid, key, L_I(-1))); /* keys have at most 30 bits */
                if (k != known)
                    mark_key(scene, masks, k);
                known = k;
                valid &= L_NE(key, L_I((int)k));
            }
        }
        L_STORE(L_AS_UINT(key), keys + first);
    }
    int lo = l_reduce_min(nearest), hi = l_reduce_max(farthest);
    if (hi >= lo) {
        atomic_min(counters + VIT_COUNTER_slice_min, (uint)max(lo + (int)scene->slice_first, 0));
        atomic_max(counters + VIT_COUNTER_slice_max, (uint)max(hi + (int)scene->slice_first, 0));
    }
}

/* Exclusive prefix sum by one work-group: out[i] = start + sum of values before i; returns the total. Each work-item sums a
 * stretch, the stretches' sums are added up, each writes its stretch. `value` is an expression in i. */
#define GROUP_SCAN(count, start, value, out, partial, total)                                                                   \
    do {                                                                                                                       \
        uint scan_n = (count), scan_size = (uint)get_local_size(0), scan_id = (uint)get_local_id(0);                           \
        uint scan_len = (scan_n + scan_size - 1) / scan_size, scan_a = min(scan_id * scan_len, scan_n),                        \
             scan_b = min(scan_a + scan_len, scan_n), scan_sum = 0;                                                            \
        for (uint i = scan_a; i < scan_b; i++)                                                                                 \
            scan_sum += (value);                                                                                               \
        partial[scan_id] = scan_sum;                                                                                           \
        barrier(CLK_LOCAL_MEM_FENCE);                                                                                          \
        uint scan_at = (start);                                                                                                \
        total = (start);                                                                                                       \
        for (uint i = 0; i < scan_size; i++) {                                                                                 \
            scan_at += i < scan_id ? partial[i] : 0u;                                                                          \
            total += partial[i];                                                                                               \
        }                                                                                                                      \
        for (uint i = scan_a; i < scan_b; i++) {                                                                               \
            uint scan_value = (value);                                                                                         \
            out[i] = scan_at;                                                                                                  \
            scan_at += scan_value;                                                                                             \
        }                                                                                                                      \
    } while (0)

/* Numbers all nodes breadth first: prefix[w] is the index of the first child of mask word w; node 0 is the root. */
kernel void number_nodes(global const vit_scene *scene, global const uint *masks, global uint *prefix,
                         volatile global uint *counters) {
    local uint partial[256];
    uint total;
    GROUP_SCAN(scene->mask_words, 1u, popcount(masks[i]), prefix, partial, total);
    barrier(CLK_GLOBAL_MEM_FENCE);
    if (get_local_id(0) == 0) {
        counters[VIT_COUNTER_nodes] = total;
        counters[VIT_COUNTER_clusters] = total - prefix[scene->level_first[scene->levels - 1]];
    }
}

/* Children of every node, and empty bounds. One work-item a mask word. Nodes from max_nodes on are dropped. */
kernel void make_nodes(global const vit_scene *scene, uint max_nodes, global const uint *masks, global const uint *prefix,
                       global uint *node_first, global uint *node_count, global int *bounds) {
    uint w = (uint)get_global_id(0);
    if (w >= scene->mask_words)
        return;
    uint level = 0;
    while (level + 1 < scene->levels && w >= scene->level_first[level + 1])
        level++;
    uint mask = masks[w], child = prefix[w], below = level + 1 < scene->levels ? scene->level_first[level + 1] : VIT_NONE;
    uint word = (w - scene->level_first[level]) << 5;
    if (w == 0) {
        node_first[0] = 1;
        node_count[0] = min((uint)popcount(mask), max_nodes - 1);
    }
    for (; mask != 0; mask &= mask - 1, child++) {
        if (child >= max_nodes)
            break;
        uint bit = 31u - (uint)clz(mask & (~mask + 1u)), grandchild = max_nodes, grandchildren = 0;
        if (below != VIT_NONE) {
            grandchild = min(prefix[below + word + bit], max_nodes);
            grandchildren = min((uint)popcount(masks[below + word + bit]), max_nodes - grandchild);
        }
        node_first[child] = grandchild;
        node_count[child] = grandchildren;
        for (uint k = 0; k < 12; k++)
            VIT_PLANE(bounds, k, max_nodes)[child] = (k % 6) < 3 ? 0x7fffffff : (int)0x80000000;
        if (VIT_EFFECT_ZONES)
            VIT_PLANE(bounds, 12, max_nodes)[child] = 0;
    }
}
#endif

/* Node index of a key's cluster; at least max_nodes if it was dropped. */
static inline uint cluster_of(global const vit_scene *scene, global const uint *masks, global const uint *prefix, uint key) {
    uint w = scene->level_first[scene->levels - 1] + (key >> 5);
    return prefix[w] + (uint)popcount(masks[w] & ((1u << (key & 31u)) - 1u));
}

/* Also for keys that may not exist: VIT_NONE then. */
static inline uint cluster_if_any(global const vit_scene *scene, global const uint *masks, global const uint *prefix,
                                  uint key) {
    uint w = scene->level_first[scene->levels - 1] + (key >> 5);
    return (masks[w] >> (key & 31u)) & 1u ? prefix[w] + (uint)popcount(masks[w] & ((1u << (key & 31u)) - 1u)) : VIT_NONE;
}

/* accepted: zones of the samples, 0 without zones. */
static inline void widen(volatile global int *bounds, uint max_nodes, uint node, const int *lo, const int *hi, uint accepted) {
    if (VIT_EFFECT_ZONES)
        atomic_or(VIT_PLANE(bounds, 12, max_nodes) + node, (int)accepted);
    for (int k = 0; k < 3; k++) {
        atomic_min(VIT_PLANE(bounds, k, max_nodes) + node, lo[k]);
        atomic_max(VIT_PLANE(bounds, 3 + k, max_nodes) + node, hi[k]);
        atomic_min(VIT_PLANE(bounds, 6 + k, max_nodes) + node, lo[3 + k]);
        atomic_max(VIT_PLANE(bounds, 9 + k, max_nodes) + node, hi[3 + k]);
    }
}

#if VIT_WITH(PHOTONS)
/* Clusters' boxes of positions (planes 0..5 of bounds: lo, hi) and of normals (6..11). The box of normals stands for the
 * normal cone: a photon that comes from behind for each corner of it comes from behind for every sample. With zones, plane 12
 * has those that any sample accepts. Minima and maxima of integers that order as the floats do, and bits: no order of execution
 * shows. */
kernel void cluster_bounds(global const vit_scene *scene, uint max_nodes, uint run, global const uint *keys,
                           global const float *position, global const uint *normal, global const uint *accept,
                           global const uint *masks, global const uint *prefix, volatile global int *bounds,
                           volatile global uint *counters) {
    uint n = scene->samples, begin = (uint)get_global_id(0) * run, end = min(begin + run, n);
    uint known = VIT_NONE, node = VIT_NONE;
    int lo[6], hi[6];
    uint accepted = 0;
    for (uint first = begin; first < end; first += VIT_LANES) {
        li key = L_AS_INT(L_LOAD(keys + first));
        li rest = L_GE(key, L_I(0));
        if (!l_any(rest))
            continue;
        lv3 p = sample_position(scene, position, first), s = l_decode_normal(L_LOAD(normal + first));
        li q[6] = {L_AS_INT(p.x), L_AS_INT(p.y), L_AS_INT(p.z), L_AS_INT(s.x), L_AS_INT(s.y), L_AS_INT(s.z)};
        for (int k = 0; k < 6; k++)
            q[k] ^= (q[k] >> 31) & 0x7fffffff;
        while (l_any(rest)) {
            uint k = (uint)l_reduce_max(l_sel_i(rest, key, L_I(-1)));
            li own = rest & L_EQ(key, L_I((int)k));
            rest &= ~own;
            if (k != known) {
                if (node < max_nodes)
                    widen(bounds, max_nodes, node, lo, hi, accepted);
                known = k;
                node = cluster_of(scene, masks, prefix, k);
                accepted = 0;
                for (int i = 0; i < 6; i++) {
                    lo[i] = 0x7fffffff;
                    hi[i] = (int)0x80000000;
                }
            }
            if (VIT_EFFECT_ZONES)
                accepted |= l_or(l_sel_u(own, L_LOAD(accept + first), L_U(0)));
            if (node >= max_nodes)
                atomic_add(counters + VIT_COUNTER_dropped_samples, (uint)popcount(l_bits(own)));
            for (int i = 0; i < 6; i++) {
                lo[i] = min(lo[i], l_reduce_min(l_sel_i(own, q[i], L_I(0x7fffffff))));
                hi[i] = max(hi[i], l_reduce_max(l_sel_i(own, q[i], L_I((int)0x80000000))));
            }
        }
    }
    if (node < max_nodes)
        widen(bounds, max_nodes, node, lo, hi, accepted);
}
#endif
