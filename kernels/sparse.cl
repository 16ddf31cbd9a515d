/* The passes estimate_sparse, interpolate and estimate_rest: irradiance at fewer samples. METHODS.md, "Sparse samples". It is
 * estimated at one sample of each 2 x 2 or 4 x 4 pixels, the coarse grid, and the other samples get it from the four coarse
 * ones around them, weighted bilinearly and by whether they lie on the same surface (and with zones, take the same photons):
 * Kopf et al., "Joint Bilateral Upsampling", SIGGRAPH 2007. A sample that no coarse one agrees with is estimated after all.
 * Albedo is applied later, so that textures stay sharp. */

#define SPARSE_ROW_BITS (VIT_EFFECT_SPARSE_16 ? 0 : 1)
#define SPARSE_ROW (1 << SPARSE_ROW_BITS) /* coarse samples a row of a block of 4 x 4 pixels */
#define SPARSE_BLOCK (SPARSE_ROW * SPARSE_ROW)
#define SPARSE_STEP (4 >> SPARSE_ROW_BITS) /* pixels between coarse samples */
#define SPARSE_LEAST 0.1f /* sum of weights below which a sample has no neighbours; 1: four of the same plane and normal */

/* A coarse sample: its sum before estimate_normalise, which each sample does for itself; position; unit normal: 3 floats each.
 * A sum of -1: it has no key. A block's are side by side, the one of the least pixel first. */
#define SPARSE_FLOATS 9

static inline uint sparse_count(global const vit_scene *scene) {
    return scene->samples >> 4 << 2 * SPARSE_ROW_BITS;
}

/* View sample of coarse sample i. */
static inline li sparse_sample(li i) {
    li at = i & (SPARSE_BLOCK - 1);
    return (i >> (2 * SPARSE_ROW_BITS)) * 16 + (at >> SPARSE_ROW_BITS) * (SPARSE_STEP * 4) +
           (at & (SPARSE_ROW - 1)) * SPARSE_STEP;
}

/* Estimates the first `used` of the lanes' slots, which have this key, and stores them. Slots are coarse samples where `flags`
 * is NULL, else the view samples flagged there. */
static inline void sparse_estimate(INDIRECT_PARAMETERS, global const uint *flags, global float *out, const int *slots,
                                   uint used, int key WORK_PASSED) {
    uint n = scene->samples;
    li slot = L_LOAD(slots), sample = flags ? slot : sparse_sample(slot);
    estimate_sample found = estimate_load_at(scene, sample, position, normal, accept, inverse_area);
    lv3 p = found.p, s = found.s;
    if (!flags)
        found.inverse_area = L_F(1);
    li keyed = l_sel_i(L_LT(L_INDEX, L_I((int)used)), L_I(key), L_I(-1));
    lv3 e = indirect_gather(INDIRECT_ARGUMENTS, keyed, &found, sample WORK_PASS);
    float value[SPARSE_FLOATS][VIT_LANES];
    L_STORE(e.x, value[0]);
    L_STORE(e.y, value[1]);
    L_STORE(e.z, value[2]);
    L_STORE(p.x, value[3]);
    L_STORE(p.y, value[4]);
    L_STORE(p.z, value[5]);
    L_STORE(s.x, value[6]);
    L_STORE(s.y, value[7]);
    L_STORE(s.z, value[8]);
    for (uint i = 0; i < used; i++)
        if (flags)
            for (uint k = 0; k < 3; k++)
                VIT_PLANE(out, k, n)[slots[i]] = value[k][i];
        else
            for (uint k = 0; k < SPARSE_FLOATS; k++)
                out[(size_t)slots[i] * SPARSE_FLOATS + k] = value[k][i];
}

/* Keys of the slots from `first` on; negative beyond `end` and where nothing is to be estimated. */
static inline li sparse_keys(global const uint *keys, global const uint *flags, uint first, uint end) {
    li slot = (int)first + L_INDEX;
    if (flags) { /* end is a multiple of 16 */
        li flagged = (L_I((int)(flags[first / 16] >> (first & 15))) >> L_INDEX) & 1;
        return l_any(flagged) ? indirect_keys(keys, first) | (flagged - 1) : L_I(-1);
    }
    li key = indirect_keys_at(keys, sparse_sample(min(slot, L_I((int)(end - 1)))));
    return l_sel_i(L_LT(slot, L_I((int)end)), key, L_I(-1));
}

/* All slots of a tile, those of one key together: lanes that share a list take it in one go. Which lanes go together
 * changes no bit. */
static inline void sparse_tile(INDIRECT_PARAMETERS, global const uint *flags, global float *out, uint tile,
                               uint slots WORK_PASSED) {
    uint begin = tile * slots, end = begin + slots;
    for (int key = 0x7fffffff, next; key >= 0; key = next) { /* descending; the first round only looks for the greatest */
        int mine[2 * VIT_LANES];
        uint found = 0;
        li below = L_I(-1);
        for (uint first = begin; first < end; first += VIT_LANES) {
            li k = sparse_keys(keys, flags, first, end);
            below = max(below, l_sel_i(L_LT(k, L_I(key)), k, L_I(-1)));
            for (uint hits = l_bits(L_EQ(k, L_I(key))); hits != 0; hits &= hits - 1)
                mine[found++] = (int)(first + 31u - (uint)clz(hits & (~hits + 1u)));
            if (found < VIT_LANES)
                continue;
            sparse_estimate(INDIRECT_ARGUMENTS, flags, out, mine, VIT_LANES, key WORK_PASS);
            found -= VIT_LANES;
            for (uint i = 0; i < found; i++)
                mine[i] = mine[VIT_LANES + i];
        }
        if (found > 0) {
            for (uint i = found; i < VIT_LANES; i++)
                mine[i] = mine[0];
            sparse_estimate(INDIRECT_ARGUMENTS, flags, out, mine, found, key WORK_PASS);
        }
        next = l_reduce_max(below);
    }
}

#if VIT_WITH(SPARSE)
/* The coarse samples: a work-item's are those of a tile, or with one lane, where nothing need go together, a single one. */
kernel void estimate_sparse(INDIRECT_PARAMETERS, global float *coarse WORK_PARAMETERS) {
    uint id = (uint)get_global_id(0), slots = scene->tile * scene->tile / (16u / SPARSE_BLOCK),
         count = VIT_LANES == 1 ? 1 : slots;
    if (id >= sparse_count(scene) / count)
        return;
    for (uint i = id * count; i < (id + 1) * count; i++)
        for (uint k = 0; k < SPARSE_FLOATS; k++)
            coarse[(size_t)i * SPARSE_FLOATS + k] = k < 3 ? -1.0f : 0.0f;
    WORK_BEGIN
    sparse_tile(INDIRECT_ARGUMENTS, (global const uint *)0, coarse, id, count WORK_PASS);
    WORK_END
}

/* The samples that `interpolate` flagged. */
kernel void estimate_rest(INDIRECT_PARAMETERS, global const uint *flags, global float *indirect WORK_PARAMETERS) {
    uint id = (uint)get_global_id(0), count = VIT_LANES == 1 ? 1 : scene->tile * scene->tile;
    if (id >= scene->samples / count)
        return;
    WORK_BEGIN
    sparse_tile(INDIRECT_ARGUMENTS, flags, indirect, id, count WORK_PASS);
    WORK_END
}

#endif

/* How far a sample at q of normal t lies on the same surface as the lanes' samples at p of normal s, 0..1: 1 - (distance from
 * their tangent plane / step)^2 times the 8th power of the normals' cosine. The step between coarse samples is 1 / per_step
 * metres there. *off: the distance, m. */
static inline lf sparse_agreement(lv3 q, lv3 t, lv3 p, lv3 s, lf per_step, lf *off) {
    *off = lv3_dot(lv3_sub(p, q), s);
    lf steps = *off * per_step, cosine = l_max(lv3_dot(s, t), L_F(0));
    cosine *= cosine;
    cosine *= cosine;
    return l_max(fma(-steps, steps, L_F(1)), L_F(0)) * (cosine * cosine);
}

/* Light between an area light and a surface close to it changes within their distance, which may be much less than a step:
 * where a sample agrees with one that is an area light while it is none, or the other way round, but lies beside its plane, it
 * is estimated after all. An area light in the very plane of its ceiling has no gap. */
#define SPARSE_FLAT 4.0f /* ray_offsets off the plane that do not count: what rounding makes of it */

/* Lanes of samples marked `mark` that lie across such a gap from a sample marked `other`. */
static inline li sparse_gap(global const vit_scene *scene, li mark, li other, lf agreement, lf off) {
    float flat = vit_max(scene->ray_offset * SPARSE_FLAT, scene->grid_step * 2.0f);
    return L_NE(mark, other) & L_GT(agreement, L_F(0)) & L_GT(fabs(off), L_F(flat));
}

/* -1 where samples are area lights. */
static inline li sparse_area_lights(lu albedo) {
    return L_NE(L_AS_INT(albedo & VIT_SAMPLE_AREA_LIGHT), L_I(0)) & L_EQ(L_AS_INT(albedo & VIT_SAMPLE_DARK), L_I(0));
}

/* Number of the block x, y of the picture, or VIT_NONE beyond it. */
static inline uint sparse_block(global const vit_scene *scene, uint x, uint y) {
    uint shift = 29u - (uint)clz(scene->tile), across = scene->tiles_x << shift, down = scene->tiles_y << shift,
         inner = (1u << shift) - 1;
    if (x >= across || y >= down)
        return VIT_NONE;
    return (((y >> shift) * scene->tiles_x + (x >> shift)) << (2 * shift)) + ((y & inner) << shift) + (x & inner);
}

#if VIT_WITH(SPARSE)
/* Every sample's irradiance from the coarse ones; a work-item has a block of 4 x 4. Bit k of flags[block]: its sample k has a
 * key and no light yet. */
kernel void interpolate(global const vit_scene *scene, global const vit_camera *cameras, uint frame, global const uint *keys,
                        global const float *position, global const uint *normal, global const uint *albedo, ESTIMATE_BAKED,
                        global const float *coarse, global float *indirect, global uint *flags) {
    uint block = (uint)get_global_id(0), n = scene->samples, flagged = 0;
    if (block >= n / 16)
        return;
    global const vit_camera *camera = cameras + frame;
    float rx = camera->right[0], ry = camera->right[1], rz = camera->right[2],
          step = (float)SPARSE_STEP * vit_sqrt(fma(rz, rz, fma(ry, ry, rx * rx)));
    uint shift = 29u - (uint)clz(scene->tile), tile = block >> (2 * shift), in_tile = block & ((1u << (2 * shift)) - 1);
    uint bx = ((tile % scene->tiles_x) << shift) + (in_tile & ((1u << shift) - 1)),
         by = ((tile / scene->tiles_x) << shift) + (in_tile >> shift);
    uint around[4];
    for (uint k = 0; k < 4; k++)
        around[k] = sparse_block(scene, bx + (k & 1), by + (k >> 1));
    uint area_lights = 0; /* bit k: sample k of the block is an area light; coarse samples may miss it */
    for (uint at = 0; VIT_EFFECT_AREA_LIGHTS && at < 16; at += VIT_LANES)
        area_lights |= l_bits(sparse_area_lights(L_LOAD(albedo + block * 16 + at))) << at;
    for (uint at = 0; at < 16; at += VIT_LANES) {
        uint first = block * 16 + at;
        li has = L_GE(indirect_keys(keys, first), L_I(0)), pixel = (int)at + L_INDEX;
        estimate_sample own = estimate_load(scene, first, position, normal, accept, inverse_area);
        lv3 sum = lv3_set(L_F(0), L_F(0), L_F(0)), p = own.p, s = own.s;
        lf depth = lv3_dot(lv3_sub(p, lv3_load(camera->eye)), lv3_load(camera->forward)),
           per_step = l_div(1.0f, l_max(depth * step, L_F(1e-30f)));
        li area_light = -((L_I((int)area_lights) >> pixel) & 1), apart = L_I(0);
        lf weights = L_F(0), off, x = L_FROM_INT(pixel & 3) * vit_div(1.0f, SPARSE_STEP),
           y = L_FROM_INT(pixel >> 2) * vit_div(1.0f, SPARSE_STEP);
        for (uint cy = 0; cy <= SPARSE_ROW; cy++)
            for (uint cx = 0; cx <= SPARSE_ROW; cx++) {
                uint from = around[cx / SPARSE_ROW + 2 * (cy / SPARSE_ROW)], k = cy % SPARSE_ROW * SPARSE_ROW + cx % SPARSE_ROW;
                lf tent = l_max(1.0f - fabs(x - (float)cx), L_F(0)) * l_max(1.0f - fabs(y - (float)cy), L_F(0));
                global const float *c = coarse + ((size_t)from * SPARSE_BLOCK + k) * SPARSE_FLOATS;
                if (from == VIT_NONE || !l_any(has & L_GT(tent, L_F(0))) || c[0] < 0)
                    continue;
                lf w = tent * sparse_agreement(lv3_load(c + 3), lv3_load(c + 6), p, s, per_step, &off);
                uint sample = from * 16 + cy % SPARSE_ROW * (SPARSE_STEP * 4) + cx % SPARSE_ROW * SPARSE_STEP;
                if (VIT_EFFECT_AREA_LIGHTS)
                    apart |= sparse_gap(scene, area_light, sparse_area_lights(L_U(albedo[sample])), w, off);
                if (VIT_EFFECT_ZONES) /* the same photons count for both */
                    w = l_sel(L_EQ(own.accept, L_I((int)accept[sample])), w, L_F(0));
                sum = lv3_along(sum, lv3_load(c), w);
                weights += w;
            }
        if (VIT_EFFECT_AREA_LIGHTS && area_lights != 0 &&
            area_lights != 0xffffu) { /* the block's first area light, for those that it is none of */
            li first_area_light = L_I((int)(block * 16 + 31u - (uint)clz(area_lights & (~area_lights + 1u))));
            lf w = sparse_agreement(sample_position_of(scene, position, first_area_light),
                                    l_decode_normal(l_gather_u(normal, first_area_light)), p, s, per_step, &off);
            apart |= sparse_gap(scene, area_light, L_I(-1), w, off);
        }
        li good = has & L_GE(weights, L_F(SPARSE_LEAST)) & ~apart;
        lf scale = l_sel(good, l_div(1.0f, l_max(weights, L_F(SPARSE_LEAST))), L_F(0));
        lv3_store_planes(estimate_normalise(&own, lv3_scale(sum, scale)), indirect, n, first);
        flagged |= l_bits(has & ~good) << at;
    }
    flags[block] = flagged;
}
#endif
