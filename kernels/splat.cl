/* The passes splat_*: which photons reach which clusters. METHODS.md, "Splatting": a work-group owns a node and sorts its
 * photons into its children, level by level from the root, which holds all. Lists are in the photons' order by construction, so
 * no atomics, and sums over them are the same on every device. Tests of a batch of photons against a child run in lanes. */

#define SPLAT_BATCH 256

/* A batch of the owner's photons, as planes. */
typedef struct splat_batch {
    float x[SPLAT_BATCH], y[SPLAT_BATCH], z[SPLAT_BATCH], radius2[SPLAT_BATCH];
    float dx[SPLAT_BATCH], dy[SPLAT_BATCH], dz[SPLAT_BATCH];
    uint id[SPLAT_BATCH];
    uint zone[VIT_WITH(ZONES) ? SPLAT_BATCH : 1];
} splat_batch;

/* Fills the batch with photons begin .. begin + SPLAT_BATCH - 1 of a list; what is beyond `count` is empty. */
static inline void splat_load(local splat_batch *b, global const vit_photon *photons, global const uint *list, int all,
                              uint begin, uint count) {
    for (uint i = (uint)get_local_id(0); i < SPLAT_BATCH; i += (uint)get_local_size(0)) {
        int used = begin + i < count;
        uint id = used ? (all ? begin + i : list[begin + i]) : 0;
        global const vit_photon *p = photons + id;
        b->x[i] = p->position[0];
        b->y[i] = p->position[1];
        b->z[i] = p->position[2];
        b->radius2[i] = used ? p->radius2 : -1.0f;
        b->dx[i] = p->direction[0];
        b->dy[i] = p->direction[1];
        b->dz[i] = p->direction[2];
        b->id[i] = id;
        if (VIT_EFFECT_ZONES)
            b->zone[i] = p->zone;
    }
}

typedef struct splat_box {
    float lo[3], hi[3], nlo[3], nhi[3];
    uint accept; /* with zones: those that count for any sample in it */
} splat_box;

static inline splat_box splat_node(global const int *bounds, uint max_nodes, uint node) {
    splat_box r;
    for (int k = 0; k < 3; k++) {
        r.lo[k] = vit_from_ordered(VIT_PLANE(bounds, k, max_nodes)[node]);
        r.hi[k] = vit_from_ordered(VIT_PLANE(bounds, 3 + k, max_nodes)[node]);
        r.nlo[k] = vit_from_ordered(VIT_PLANE(bounds, 6 + k, max_nodes)[node]);
        r.nhi[k] = vit_from_ordered(VIT_PLANE(bounds, 9 + k, max_nodes)[node]);
    }
    r.accept = VIT_EFFECT_ZONES ? (uint)VIT_PLANE(bounds, 12, max_nodes)[node] : 0;
    return r;
}

#define SPLAT_LOAD(p) L_LOAD((local const float *)(p))

/* A photon is left out of a node only if it counts for no sample in it, after all roundings: so estimates from lists do not
 * depend on how samples are clustered, to the bit. The box's distance rounds as a sample's does and is never greater; 1 / r^2
 * may be rounded down, which lets a sample see a little beyond r; and the two sums of three products below 1 are off by less
 * than 5e-7 together. */
#define SPLAT_BEYOND 1.000001f
#define SPLAT_BEHIND 1e-6f

/* Photons i .. i + VIT_LANES - 1 of the batch whose sphere meets the box and which do not come from behind for every
 * normal in it (METHODS.md, "Splatting" (18)); or, with zones, which lie in a zone that counts for one of its samples. */
static inline li splat_touch(local const splat_batch *b, uint i, const splat_box *box) {
    lf x = SPLAT_LOAD(b->x + i), y = SPLAT_LOAD(b->y + i), z = SPLAT_LOAD(b->z + i);
    lf ox = x - l_max(L_F(box->lo[0]), l_min(x, L_F(box->hi[0]))), oy = y - l_max(L_F(box->lo[1]), l_min(y, L_F(box->hi[1]))),
       oz = z - l_max(L_F(box->lo[2]), l_min(z, L_F(box->hi[2])));
    li near = L_LT(fma(oz, oz, fma(oy, oy, ox * ox)), SPLAT_LOAD(b->radius2 + i) * SPLAT_BEYOND);
    if (VIT_EFFECT_ZONES)
        return near & L_NE(L_AS_INT(L_LOAD((local const uint *)(b->zone + i)) & box->accept), L_I(0));
    lf dx = SPLAT_LOAD(b->dx + i), dy = SPLAT_LOAD(b->dy + i), dz = SPLAT_LOAD(b->dz + i);
    lf least = l_min(dx * box->nlo[0], dx * box->nhi[0]) + l_min(dy * box->nlo[1], dy * box->nhi[1]) +
               l_min(dz * box->nlo[2], dz * box->nhi[2]);
    return near & L_LT(least, L_F(SPLAT_BEHIND));
}

/* A level's work: a work-group owns a node of the level, its work-items the node's children. The root's list, all photons, is
 * long: there, `chunks` work-groups each own a stretch of it, and splat_place puts the stretches' entries in order; chunks is 1
 * for the other levels. */
typedef struct splat_owned {
    uint chunk;                 /* the work-group's, of the node's stretches */
    uint child_first, children; /* 0 children: the node does not exist */
    uint list;                  /* where the node's list begins; the root has none */
    uint begin, end;            /* the stretch, in the list */
} splat_owned;

static inline splat_owned splat_own(global const vit_scene *scene, uint max_nodes, uint level, uint chunks,
                                    global const uint *prefix, global const uint *node_first, global const uint *node_count,
                                    global const uint *list_first, global const uint *list_count, global const uint *counters) {
    splat_owned own;
    uint group = (uint)get_group_id(0), node = level_begin(scene, prefix, level) + group / chunks;
    int exists = node < level_end(scene, prefix, counters, level, max_nodes);
    own.chunk = group % chunks;
    own.child_first = exists ? node_first[node] : 0;
    own.children = exists ? node_count[node] : 0;
    own.list = exists && level > 0 ? list_first[node] : 0;
    uint size = 0;
    if (exists)
        size = level > 0 ? list_count[node] : scene->photons;
    uint stretch = (size + chunks - 1) / chunks;
    own.begin = min(own.chunk * stretch, size);
    own.end = min(own.begin + stretch, size);
    return own;
}

/* Fills the batch from photon `begin` of the owner's list on, once all work-items are done with the last one. How many photons
 * are in it. All work-items of the group call this together. */
static inline uint splat_fill(local splat_batch *b, const splat_owned *own, global const vit_photon *photons,
                              global const uint *list, uint level, uint begin) {
    barrier(CLK_LOCAL_MEM_FENCE);
    splat_load(b, photons, list + own->list, level == 0, begin, own->end);
    barrier(CLK_LOCAL_MEM_FENCE);
    return min(own->end - begin, (uint)SPLAT_BATCH);
}

/* The lowest bit that is set: the first lane of a mask. */
static inline uint splat_lowest(uint bits) {
    return 31u - (uint)clz(bits & (~bits + 1u));
}

#define SPLAT_CHILDREN 32 /* of a node, at most: places a chunk has in chunk_count */

#if VIT_WITH(PHOTONS)
/* How many photons each child gets, or of each stretch of the root's. */
kernel void splat_count(global const vit_scene *scene, uint max_nodes, uint level, uint chunks,
                        global const vit_photon *photons, global const uint *prefix, global const uint *node_first,
                        global const uint *node_count, global const int *bounds, global const uint *list_first,
                        global uint *list_count, global const uint *list, global uint *chunk_count,
                        global const uint *counters WORK_PARAMETERS) {
    local splat_batch batch;
    WORK_BEGIN
    splat_owned own =
        splat_own(scene, max_nodes, level, chunks, prefix, node_first, node_count, list_first, list_count, counters);
    global uint *counts = level == 0 ? chunk_count + own.chunk * SPLAT_CHILDREN : list_count + own.child_first;
    for (uint c = (uint)get_local_id(0); c < own.children; c += (uint)get_local_size(0))
        counts[c] = 0;
    for (uint begin = own.begin; begin < own.end; begin += SPLAT_BATCH) {
        uint used = splat_fill(&batch, &own, photons, list, level, begin);
        for (uint c = (uint)get_local_id(0); c < own.children; c += (uint)get_local_size(0)) {
            splat_box box = splat_node(bounds, max_nodes, own.child_first + c);
            WORK_ADD(node_tests, used);
            uint sum = 0;
            for (uint i = 0; i < used; i += VIT_LANES)
                sum += (uint)popcount(l_bits(splat_touch(&batch, i, &box)));
            counts[c] += sum;
            WORK_ADD(pairs, level + 1 == scene->levels ? sum : 0);
        }
    }
    WORK_END
}

/* Places the lists of the level's children one after another; what lies beyond max_list is dropped, the last entries first. One
 * work-group. Sums saturate: saturating addition is associative, so the stretches of the scan do not show. */
kernel void splat_place(global const vit_scene *scene, uint max_nodes, uint max_list, uint level, uint chunks,
                        global const uint *prefix, global uint *list_first, global uint *list_count, global uint *chunk_count,
                        volatile global uint *counters) {
    local uint partial[256];
    uint begin = level_begin(scene, prefix, level + 1),
         end = level_end(scene, prefix, (global const uint *)counters, level + 1, max_nodes);
    begin = min(begin, end);
    uint id = (uint)get_local_id(0), size = (uint)get_local_size(0), length = (end - begin + size - 1) / size;
    uint a = min(begin + id * length, end), b = min(a + length, end), sum = 0, start = counters[VIT_COUNTER_list], largest = 0;
    for (uint i = a; i < b; i++) {
        if (level == 0) { /* a child's chunks: their sum, and where each begins */
            uint all = 0;
            for (uint k = 0; k < chunks; k++) {
                uint count = chunk_count[k * SPLAT_CHILDREN + i - begin];
                chunk_count[k * SPLAT_CHILDREN + i - begin] = all;
                all += count;
            }
            list_count[i] = all;
        }
        sum = add_sat(sum, list_count[i]);
        largest = max(largest, list_count[i]);
    }
    partial[id] = sum;
    barrier(CLK_LOCAL_MEM_FENCE | CLK_GLOBAL_MEM_FENCE);
    uint at = start, total = start, dropped = 0;
    for (uint i = 0; i < size; i++) {
        at = add_sat(at, i < id ? partial[i] : 0u);
        total = add_sat(total, partial[i]);
    }
    for (uint i = a; i < b; i++) {
        uint count = list_count[i], kept = at < max_list ? min(count, max_list - at) : 0;
        list_first[i] = min(at, max_list);
        list_count[i] = kept;
        at = add_sat(at, count);
        dropped = add_sat(dropped, count - kept);
    }
    if (dropped > 0)
        atomic_add(counters + VIT_COUNTER_dropped_entries, dropped);
    if (level + 1 == scene->levels)
        atomic_max(counters + VIT_COUNTER_largest, largest);
    if (id == 0) {
        counters[VIT_COUNTER_list] = total;
        if (level + 1 == scene->levels)
            counters[VIT_COUNTER_pairs] = total - start;
    }
}

/* Writes the lists of the level's children, in the places that splat_place gave them. */
kernel void splat_write(global const vit_scene *scene, uint max_nodes, uint level, uint chunks,
                        global const vit_photon *photons, global const uint *prefix, global const uint *node_first,
                        global const uint *node_count, global const int *bounds, global const uint *list_first,
                        global const uint *list_count, global uint *list, global uint *cursor, global uint *chunk_count,
                        global const uint *counters WORK_PARAMETERS) {
    local splat_batch batch;
    WORK_BEGIN
    splat_owned own =
        splat_own(scene, max_nodes, level, chunks, prefix, node_first, node_count, list_first, list_count, counters);
    global uint *cursors =
        level == 0 ? chunk_count + own.chunk * SPLAT_CHILDREN : cursor + own.child_first; /* written so far */
    for (uint c = (uint)get_local_id(0); c < own.children && level > 0; c += (uint)get_local_size(0))
        cursors[c] = 0;
    for (uint begin = own.begin; begin < own.end; begin += SPLAT_BATCH) {
        uint used = splat_fill(&batch, &own, photons, list, level, begin);
        for (uint c = (uint)get_local_id(0); c < own.children; c += (uint)get_local_size(0)) {
            uint child = own.child_first + c;
            splat_box box = splat_node(bounds, max_nodes, child);
            WORK_ADD(node_tests, used);
            uint at = list_first[child] + cursors[c], end = list_first[child] + list_count[child];
            for (uint i = 0; i < used; i += VIT_LANES) {
                for (uint hits = l_bits(splat_touch(&batch, i, &box)); hits != 0; hits &= hits - 1) {
                    if (at < end)
                        list[at] = batch.id[i + splat_lowest(hits)];
                    at++;
                }
            }
            cursors[c] = at - list_first[child];
        }
    }
    WORK_END
}

#endif

/* Buckets of a cluster: raw, directions on a cube, 6 faces x 3 x 3 (METHODS.md, "Buckets" (20)), else octants (19): whether a
 * photon comes from the front of an axis-parallel surface is exact. */
#define BUCKETS (VIT_EFFECT_RAW_BUCKETS ? 54u : 8u)

static inline uint bucket_of(float x, float y, float z) {
    if (!VIT_EFFECT_RAW_BUCKETS)
        return (x < 0 ? 1u : 0u) | (y < 0 ? 2u : 0u) | (z < 0 ? 4u : 0u);
    float ax = fabs(x), ay = fabs(y), az = fabs(z);
    int on_x = ax >= ay && ax >= az, on_y = !on_x && ay >= az;
    float major = z;
    if (on_x || on_y)
        major = on_x ? x : y;
    float u = on_x ? y : x, v = on_x || on_y ? z : y;
    float scale = vit_div(1.5f, vit_max(fabs(major), 1e-9f));
    int iu = min((int)fma(u, scale, 1.5f), 2), iv = min((int)fma(v, scale, 1.5f), 2);
    int axis = 4;
    if (on_x || on_y)
        axis = on_x ? 0 : 2;
    return (uint)(axis + (major < 0 ? 1 : 0)) * 9u + (uint)(iv * 3 + iu);
}

#if VIT_WITH(BUCKETS)
/* Adds photons of the batch to the child's buckets: their power, weighted by the kernel at the box's centre, into the bucket of
 * the direction that they come from. How many touch the box. */
static inline uint splat_into_buckets(global const vit_scene *scene, local const splat_batch *b, uint used,
                                      const splat_box *box, global const vit_photon *photons, uint child,
                                      global float *buckets) {
    float cx = 0.5f * (box->lo[0] + box->hi[0]), cy = 0.5f * (box->lo[1] + box->hi[1]), cz = 0.5f * (box->lo[2] + box->hi[2]);
    uint sum = 0;
    for (uint i = 0; i < used; i += VIT_LANES) {
        uint hits = l_bits(splat_touch(b, i, box));
        if (hits == 0)
            continue;
        sum += (uint)popcount(hits);
        /* 1. The kernel's weight at the centre. */
        lf ox = SPLAT_LOAD(b->x + i) - cx, oy = SPLAT_LOAD(b->y + i) - cy, oz = SPLAT_LOAD(b->z + i) - cz;
        lf d2 = fma(oz, oz, fma(oy, oy, ox * ox)), r2 = SPLAT_LOAD(b->radius2 + i);
        if (VIT_EFFECT_FLATTENED) {
            float mx = box->nlo[0] + box->nhi[0], my = box->nlo[1] + box->nhi[1], mz = box->nlo[2] + box->nhi[2];
            float m2 = fma(mz, mz, fma(my, my, mx * mx)), unit = m2 > 0 ? vit_div(1.0f, vit_sqrt(m2)) : 0;
            lf off = fma(oz, L_F(mz * unit), fma(oy, L_F(my * unit), ox * (mx * unit)));
            d2 = fma(off * off, L_F(scene->flatten), d2);
        }
        hits &= l_bits(L_LT(d2, r2));
        float weight[VIT_LANES];
        L_STORE(1.0f - l_div(d2, r2), weight);
        /* 2. Photons one after another, in their order. */
        for (; hits != 0; hits &= hits - 1) {
            uint lane = splat_lowest(hits), k = i + lane;
            global const vit_photon *p = photons + b->id[k];
            uint at = child * BUCKETS + bucket_of(-b->dx[k], -b->dy[k], -b->dz[k]);
            vstore4(vload4(at, buckets) + VIT_FLOAT4(p->power[0], p->power[1], p->power[2], 1.0f) * weight[lane], at, buckets);
        }
    }
    return sum;
}

/* The clusters' level (chunks is 1): photons go into buckets rather than lists. */
kernel void splat_buckets(global const vit_scene *scene, uint max_nodes, uint level, uint chunks,
                          global const vit_photon *photons, global const uint *prefix, global const uint *node_first,
                          global const uint *node_count, global const int *bounds, global const uint *list_first,
                          global uint *list_count, global const uint *list, volatile global uint *counters,
                          global float *buckets WORK_PARAMETERS) {
    uint pairs = 0;
    local splat_batch batch;
    WORK_BEGIN
    splat_owned own = splat_own(scene, max_nodes, level, chunks, prefix, node_first, node_count, list_first, list_count,
                                (global const uint *)counters);
    for (uint c = (uint)get_local_id(0); c < own.children; c += (uint)get_local_size(0)) {
        list_count[own.child_first + c] = 0;
        for (uint i = 0; i < BUCKETS; i++)
            vstore4(VIT_FLOAT4(0, 0, 0, 0), (own.child_first + c) * BUCKETS + i, buckets);
    }
    for (uint begin = own.begin; begin < own.end; begin += SPLAT_BATCH) {
        uint used = splat_fill(&batch, &own, photons, list, level, begin);
        for (uint c = (uint)get_local_id(0); c < own.children; c += (uint)get_local_size(0)) {
            uint child = own.child_first + c;
            splat_box box = splat_node(bounds, max_nodes, child);
            WORK_ADD(node_tests, used);
            uint sum = splat_into_buckets(scene, &batch, used, &box, photons, child, buckets);
            list_count[child] += sum;
            pairs += sum;
            WORK_ADD(pairs, sum);
        }
    }
    WORK_END
    if (pairs > 0)
        atomic_add(counters + VIT_COUNTER_pairs, pairs);
    for (uint c = (uint)get_local_id(0); c < own.children; c += (uint)get_local_size(0))
        atomic_max(counters + VIT_COUNTER_largest, list_count[own.child_first + c]);
}
#endif
