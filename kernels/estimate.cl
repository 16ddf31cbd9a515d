/* Irradiance of view samples from photons, from lists or buckets; indirect.cl calls it. A density estimate: E = sum of Phi
 * K(d), K(d) = 2 / (pi r^2) (1 - d^2 / r^2), over photons that arrive from the front. METHODS.md, "Density estimate" (21).
 * vit_photon.power is Phi 2 / (pi r^2). */

/* What a sample knows besides its place: which zones' photons count for it, and what its sum is divided by, the part of the
 * kernel's disc that lies on surfaces in those zones. METHODS.md, "Light-leak partition" and METHODS.md, "Effective area". */
#define ESTIMATE_BAKED global const uint *accept, global const float *inverse_area
typedef struct estimate_sample {
    lv3 p, s;        /* position, unit normal */
    li accept;       /* with zones */
    lf inverse_area; /* with areas, else 1 */
} estimate_sample;

static inline estimate_sample estimate_load(global const vit_scene *scene, uint first, global const float *position,
                                            global const uint *normal, ESTIMATE_BAKED) {
    estimate_sample r;
    r.p = sample_position(scene, position, first);
    r.s = l_decode_normal(L_LOAD(normal + first));
    r.accept = L_I(-1);
    r.inverse_area = L_F(1);
    if (VIT_EFFECT_ZONES)
        r.accept = L_AS_INT(L_LOAD(accept + first));
    if (VIT_EFFECT_AREA)
        r.inverse_area = L_LOAD(inverse_area + first);
    return r;
}

/* The samples of these numbers. */
static inline estimate_sample estimate_load_at(global const vit_scene *scene, li at, global const float *position,
                                               global const uint *normal, ESTIMATE_BAKED) {
    estimate_sample r;
    r.p = sample_position_of(scene, position, at);
    r.s = l_decode_normal(l_gather_u(normal, at));
    r.accept = L_I(-1);
    r.inverse_area = L_F(1);
    if (VIT_EFFECT_ZONES)
        r.accept = L_AS_INT(l_gather_u(accept, at));
    if (VIT_EFFECT_AREA)
        r.inverse_area = L_GATHER(lf, inverse_area, at);
    return r;
}

/* Does a photon count for a sample? Without zones, if it arrives from the front of the surface. */
static inline li estimate_accepts(const estimate_sample *sample, global const vit_photon *photon) {
    if (VIT_EFFECT_ZONES)
        return L_NE(sample->accept & (int)photon->zone, L_I(0));
    return L_LT(lv3_dot(sample->s, lv3_load(photon->direction)), L_F(0));
}

static inline lv3 estimate_normalise(const estimate_sample *sample, lv3 sum) {
    return VIT_EFFECT_AREA ? lv3_scale(sum, sample->inverse_area) : sum;
}

#define ESTIMATE_PARAMETERS                                                                                                    \
    global const vit_scene *scene, uint max_nodes, global const uint *masks, global const uint *prefix,                        \
        global const uint *list_first, global const uint *list_count, global const uint *list,                                 \
        global const vit_photon *photons
#define ESTIMATE_ARGUMENTS scene, max_nodes, masks, prefix, list_first, list_count, list, photons

/* Irradiance of the lanes' samples, W/m2; key: negative for none, 0 there. Lanes may have any keys. */
static inline lv3 estimate_gather(ESTIMATE_PARAMETERS, li key, const estimate_sample *sample WORK_PASSED) {
    li rest = L_GE(key, L_I(0));
    lv3 total = lv3_set(L_F(0), L_F(0), L_F(0));
    while (l_any(rest)) {
        uint k = (uint)l_reduce_max(l_sel_i(rest, key, L_I(-1)));
        li own = rest & L_EQ(key, L_I((int)k));
        rest &= ~own;
        uint cluster = cluster_of(scene, masks, prefix, k);
        if (cluster >= max_nodes)
            continue;
        global const uint *at = list + list_first[cluster], *end = at + list_count[cluster];
        lv3 sum = lv3_set(L_F(0), L_F(0), L_F(0));
        WORK_ADD(evaluations, (ulong)popcount(l_bits(own)) * (ulong)(end - at));
        for (; at < end; at++) {
            global const vit_photon *q = photons + *at;
            lv3 o = lv3_sub(sample->p, lv3_load(q->position));
            lf d2 = lv3_dot(o, o);
            if (VIT_EFFECT_FLATTENED) {
                lf off = lv3_dot(o, sample->s);
                d2 = fma(off * off, L_F(scene->flatten), d2);
            }
            lf w = l_max(fma(d2, L_F(-q->inv_radius2), L_F(1)), L_F(0));
            w = l_sel(estimate_accepts(sample, q), w, L_F(0));
            sum = lv3_along(sum, lv3_load(q->power), w);
        }
        total = lv3_sel(own, estimate_normalise(sample, sum), total);
    }
    return total;
}

#define BUCKET_PARAMETERS                                                                                                      \
    global const vit_scene *scene, global const vit_camera *cameras, uint frame, uint max_nodes, global const uint *masks,     \
        global const uint *prefix, global const int *bounds, global const float *buckets
#define BUCKET_ARGUMENTS scene, cameras, frame, max_nodes, masks, prefix, bounds, buckets

/* As published, without mixing: each sample takes its cluster's 54 directions, and blocks show. METHODS.md, "Buckets" (20). As
 * estimate_gather. */
static inline lv3 bucket_gather_raw(BUCKET_PARAMETERS, li key, const estimate_sample *sample WORK_PASSED) {
    lv3 s = sample->s;
    li rest = L_GE(key, L_I(0));
    lv3 total = lv3_set(L_F(0), L_F(0), L_F(0));
    while (l_any(rest)) {
        uint k = (uint)l_reduce_max(l_sel_i(rest, key, L_I(-1)));
        li own = rest & L_EQ(key, L_I((int)k));
        rest &= ~own;
        uint cluster = cluster_of(scene, masks, prefix, k);
        if (cluster >= max_nodes)
            continue;
        lv3 sum = lv3_set(L_F(0), L_F(0), L_F(0));
        for (uint b = 0; b < BUCKETS; b++) {
            global const float *power = buckets + ((size_t)cluster * BUCKETS + b) * 4;
            if (!(power[3] > 0))
                continue;
            WORK_LANES(evaluations, own);
            uint face = b / 9;
            float sign = (face & 1) ? -1.0f : 1.0f, u = (float)((int)(b % 3) - 1) * 0.666666667f,
                  v = (float)((int)(b % 9 / 3) - 1) * 0.666666667f;
            float dx = face < 2 ? sign : u, dy = face < 2 ? u : face < 4 ? sign : v, dz = face < 4 ? v : sign;
            float unit = vit_div(1.0f, vit_sqrt(fma(dz, dz, fma(dy, dy, dx * dx))));
            lf w = 2.0f * l_max(lv3_dot(s, lv3_set(L_F(dx * unit), L_F(dy * unit), L_F(dz * unit))), L_F(0));
            sum = lv3_along(sum, lv3_load(power), w);
        }
        total = lv3_sel(own, estimate_normalise(sample, sum), total);
    }
    return total;
}

/* Irradiance of a cluster on a surface of normal s, x, y, z in scalar planes. An octant counts as far as it lies in front:
 * clamp(1 + s o), o = (+-1, +-1, +-1). Exact for axis-parallel surfaces, continuous for all; a surface that is lit evenly and
 * tilted keeps at least 95 % of its light (blending axes by their squares, as ambient cubes do, would lose up to 21 %). */
static inline lv3 bucket_irradiance(global const float *octants, lv3 s) {
    lv3 r = lv3_set(L_F(0), L_F(0), L_F(0));
    for (uint o = 0; o < 8; o++) {
        lf front = ((o & 1) ? -s.x : s.x) + ((o & 2) ? -s.y : s.y) + ((o & 4) ? -s.z : s.z);
        r = lv3_along(r, lv3_load(octants + o * 4), l_min(l_max(1.0f + front, L_F(0)), L_F(1)));
    }
    return r;
}

/* Interpolated: the eight clusters round a sample (two tiles across, two down, two slices deep), weighted trilinearly and by
 * how near their centres are to the sample's tangent plane. Own tile and slice are always among them. As estimate_gather; x, y:
 * pixels. */
static inline lv3 bucket_gather_smooth(BUCKET_PARAMETERS, li key, const estimate_sample *sample, li x, li y WORK_PASSED) {
    /* 1. Where the sample lies between the centres of tiles and slices. */
    lv3 p = sample->p, s = sample->s;
    li rest = L_GE(key, L_I(0));
    lv3 total = lv3_set(L_F(0), L_F(0), L_F(0));
    global const vit_camera *camera = cameras + frame;
    lf edge = L_F(vit_div(1.0f, (float)scene->tile));
    lf fx = fma(L_FROM_INT(x) + 0.5f, edge, L_F(-0.5f)), fy = fma(L_FROM_INT(y) + 0.5f, edge, L_F(-0.5f));
    lf depth = l_max(lv3_dot(lv3_sub(p, lv3_load(camera->eye)), lv3_load(camera->forward)), L_F(scene->slice_near));
    lf fz = l_log2(l_div(depth, scene->slice_near)) * scene->slice_scale - (float)scene->slice_first - 0.5f;
    fz = l_min(l_max(fz, L_F(-0.5f)), L_F((float)scene->slice_count - 0.5f));
    lf ix = floor(fx), iy = floor(fy), iz = floor(fz);
    fx -= ix;
    fy -= iy;
    fz -= iz;
    li x0 = L_TRUNC(ix), y0 = L_TRUNC(iy), z0 = L_TRUNC(iz);
    /* A tile's width at the sample: clusters farther than that from the tangent plane hardly count. */
    lv3 pixel = lv3_load(camera->right);
    lf cell = depth * (l_sqrt(lv3_dot(pixel, pixel)) * (float)scene->tile);
    while (l_any(rest)) {
        /* 2. Lanes between the same tile centres and slices, and with the same direction bits in their keys. */
        int z = l_reduce_max(l_sel_i(rest, z0, L_I(-1000000)));
        li own = rest & L_EQ(z0, L_I(z));
        int tx = l_reduce_max(l_sel_i(own, x0, L_I(-1000000)));
        own &= L_EQ(x0, L_I(tx));
        int ty = l_reduce_max(l_sel_i(own, y0, L_I(-1000000)));
        own &= L_EQ(y0, L_I(ty));
        uint direction = 0;
        if (VIT_EFFECT_NORMAL_KEYS) {
            direction = (uint)l_reduce_max(l_sel_i(own, key & 63, L_I(0)));
            own &= L_EQ(key & 63, L_I((int)direction));
        }
        rest &= ~own;
        /* 3. The eight clusters, those that there are. METHODS.md, "Buckets". */
        lv3 sum = lv3_set(L_F(0), L_F(0), L_F(0));
        lf weights = L_F(0);
        for (int corner = 0; corner < 8; corner++) {
            int cx = tx + (corner & 1), cy = ty + ((corner >> 1) & 1), cz = z + (corner >> 2);
            if (cx < 0 || cy < 0 || cz < 0 || cx >= (int)scene->tiles_x || cy >= (int)scene->tiles_y ||
                cz >= (int)scene->slice_count)
                continue;
            uint k = direction | key_spread(scene, 0, scene->key_bits_x, (uint)cx) |
                     key_spread(scene, 1, scene->key_bits_y, (uint)cy) | key_spread(scene, 2, scene->key_bits_z, (uint)cz);
            uint cluster = cluster_if_any(scene, masks, prefix, k);
            if (cluster >= max_nodes)
                continue;
            WORK_ADD(evaluations, popcount(l_bits(own)) * BUCKETS);
            splat_box box = splat_node(bounds, max_nodes, cluster);
            lv3 c = lv3_set(L_F(0.5f * (box.lo[0] + box.hi[0])), L_F(0.5f * (box.lo[1] + box.hi[1])),
                            L_F(0.5f * (box.lo[2] + box.hi[2])));
            lf off = l_div(lv3_dot(lv3_sub(c, p), s), cell);
            lf w = l_max(1.0f - off * off, L_F(0.01f));
            w *= ((corner & 1) ? fx : 1.0f - fx) * (((corner >> 1) & 1) ? fy : 1.0f - fy) * ((corner >> 2) ? fz : 1.0f - fz);
            sum = lv3_along(sum, bucket_irradiance(buckets + (size_t)cluster * (BUCKETS * 4), s), w);
            weights += w;
        }
        /* 4. Their mean. */
        lf scale = l_sel(L_GT(weights, L_F(0)), l_div(1.0f, l_max(weights, L_F(1e-20f))), L_F(0));
        total = lv3_sel(own, estimate_normalise(sample, lv3_scale(sum, scale)), total);
    }
    return total;
}

static inline lv3 bucket_gather(BUCKET_PARAMETERS, li key, const estimate_sample *sample, li x, li y WORK_PASSED) {
    if (VIT_EFFECT_RAW_BUCKETS)
        return bucket_gather_raw(BUCKET_ARGUMENTS, key, sample WORK_PASS);
    return bucket_gather_smooth(BUCKET_ARGUMENTS, key, sample, x, y WORK_PASS);
}
