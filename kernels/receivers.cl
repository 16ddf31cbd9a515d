/* Indirect light at baked places, the receivers (METHODS.md, "Irradiance basis"): the pass relight, or with live radiosity the
 * pass gather_patches (radiosity.cl), brings their irradiance up to where the frame's lights are; the pass samples interpolates
 * between the three receivers of their cell. */
#define VIT_EFFECT_RECEIVERS (VIT_EFFECT_BASIS || VIT_EFFECT_RADIOSITY)
#define VIT_EFFECT_ON_CELLS (VIT_EFFECT_POINTS ? 0 : VIT_EFFECT_RECEIVERS) /* at points the pass point_light looks them up */
#define VIT_EFFECT_LIVE (VIT_EFFECT_RELIGHT || VIT_EFFECT_RADIOSITY)       /* their irradiance is the frame's own */

/* What of it a kernel reads: buffers that the pack's effects do not call for are NULL. */
#define RECEIVER_PARAMETERS                                                                                                    \
    global const uint *receiver_cells, global const vit_receiver_split *receiver_splits, global const float *receivers,        \
        global const float *relit

/* Likewise of the lightmap, whose light is that of its receivers. */
#define LIGHTMAP_PARAMETERS                                                                                                    \
    global const uint *map_sides, global const uint *map_cells, global const vit_receiver_split *map_splits,                   \
        global const float *map_receivers
#define LIGHTMAP map_sides, map_cells, map_splits, map_receivers

#if VIT_WITH(RELIGHT)
#define RELIGHT_HALF (VIT_BASIS_GROUP / 2) /* words of a vector: receivers i and i + RELIGHT_HALF of the group share word i */

/* A work-item has the receivers of as many words as there are lanes. */
kernel void relight(global const vit_scene *scene, uint frame, global const vit_light *lights,
                    global const vit_basis_group *groups, global const uint *words,
                    global const vit_basis_coefficient *coefficients, global const vit_basis_frame *frames,
                    global const vit_receiver *receivers, global float *relit WORK_PARAMETERS) {
    uint first = (uint)get_global_id(0) * VIT_LANES;
    if (first >= scene->receivers / 2)
        return;
    uint group = first / RELIGHT_HALF, slot = first % RELIGHT_HALF;
    lv3 low = lv3_set(L_F(0), L_F(0), L_F(0)), high = low;
    WORK_BEGIN
    for (uint l = 0; l < scene->basis_lights; l++) {
        global const vit_basis_frame *at = frames + frame * scene->basis_lights + l;
        global const vit_basis_group *g = groups + group * scene->basis_lights + l;
        global const float *intensity = lights[frame * scene->lights + at->light].intensity;
        float weight = at->weight;
        uint rank = g->rank;
        global const vit_basis_coefficient *c = coefficients + g->first_coefficient + at->knot * rank;
        global const vit_basis_coefficient *next = weight > 0 ? c + rank : c;
        global const uint *vector = words + g->first_word + slot;
        WORK_ADD(evaluations, (ulong)rank * (2 * VIT_LANES));
        for (uint k = 0; k < rank; k++) {
            lu word = L_LOAD(vector + k * RELIGHT_HALF); /* two signed halves */
            lf a = L_FROM_INT(L_AS_INT(word << 16) >> 16), b = L_FROM_INT(L_AS_INT(word) >> 16);
            lv3 e = lv3_set(L_F(fma(next[k].rgb[0] - c[k].rgb[0], weight, c[k].rgb[0]) * intensity[0]),
                            L_F(fma(next[k].rgb[1] - c[k].rgb[1], weight, c[k].rgb[1]) * intensity[1]),
                            L_F(fma(next[k].rgb[2] - c[k].rgb[2], weight, c[k].rgb[2]) * intensity[2]));
            low = lv3_along(low, e, a);
            high = lv3_along(high, e, b);
        }
    }
    float value[6][VIT_LANES];
    L_STORE(low.x, value[0]);
    L_STORE(low.y, value[1]);
    L_STORE(low.z, value[2]);
    L_STORE(high.x, value[3]);
    L_STORE(high.y, value[4]);
    L_STORE(high.z, value[5]);
    uint r = group * VIT_BASIS_GROUP + slot;
    for (uint i = 0; i < VIT_LANES; i++)
        for (uint k = 0; k < 3; k++) { /* what the products leave may be below 0 */
            relit[(size_t)(r + i) * 4 + k] = vit_max(receivers[r + i].irradiance[k] + value[k][i], 0.0f);
            relit[(size_t)(r + i + RELIGHT_HALF) * 4 + k] =
                vit_max(receivers[r + i + RELIGHT_HALF].irradiance[k] + value[3 + k][i], 0.0f);
        }
    WORK_END
}
#endif

/* The lane's place among its cell's receivers: which three, and whether something parts the cell. */
static inline global const uint *receivers_of(global const uint *cells, global const vit_receiver_split *splits, int index,
                                              float x, float y, float z) {
    global const uint *cell = cells + (size_t)index * 4;
    if (cell[3] == VIT_NONE || cell[3] == VIT_RECEIVER_BY_RAYS)
        return cell;
    global const vit_receiver_split *s = splits + cell[3];
    return fma(z, s->normal[2], fma(y, s->normal[1], x * s->normal[0])) > s->offset ? cell : s->receiver;
}

/* Irradiance, W/m2, of the lanes' places p, at barycentric weights b1, b2 of a side of a triangle (back: -1 for the back); 0
 * elsewhere, and -1 where a lightmap's cell says that rays have to find it. Lane by lane: reads that wait for memory do not
 * wait for each other, and neighbours mostly share a cell. looked_up: with VIT_EFFECT_REACH, gets the receivers' bits; NULL:
 * nothing does. */
static inline lv3 receivers_light(global const uint *sides, global const uint *cells, global const vit_receiver_split *splits,
                                  global const float *light, li lanes, li triangle, li back, lf b1, lf b2, lv3 p,
                                  volatile global uint *looked_up) {
    cell_place at = cell_at(sides, lanes, triangle, back, b1, b2);
    for (int level = 0; level < VIT_RECEIVER_LEVELS; level++) {
        lu kind = l_gather_u(cells, at.index * 4 + 3);
        li divided = lanes & L_LT(L_AS_INT(kind), L_I(-1)) & L_NE(L_AS_INT(kind & 255u), L_I(0)); /* VIT_RECEIVER_IS_DIVIDED */
        if (!l_any(divided))
            break;
        cell_place within =
            cell_among(L_AS_INT(l_gather_u(cells, divided & (at.index * 4))), L_AS_INT(kind & 255u), at.w1, at.w2);
        at.index = l_sel_i(divided, within.index, at.index);
        at.w0 = l_sel(divided, within.w0, at.w0);
        at.w1 = l_sel(divided, within.w1, at.w1);
        at.w2 = l_sel(divided, within.w2, at.w2);
    }
    float value[3][VIT_LANES], w[3][VIT_LANES], place[3][VIT_LANES];
    int index[VIT_LANES];
    L_STORE(l_sel_i(lanes, at.index, L_I(-1)), index);
    L_STORE(at.w0, w[0]);
    L_STORE(at.w1, w[1]);
    L_STORE(at.w2, w[2]);
    L_STORE(p.x, place[0]);
    L_STORE(p.y, place[1]);
    L_STORE(p.z, place[2]);
    for (int i = 0; i < VIT_LANES; i++) {
        float4 e = VIT_FLOAT4(0.0f, 0.0f, 0.0f, 0.0f);
        if (index[i] >= 0) {
            global const uint *of = receivers_of(cells, splits, index[i], place[0][i], place[1][i], place[2][i]);
            for (int k = 0; VIT_EFFECT_REACH && looked_up && k < 3; k++)
                atomic_or(looked_up + of[k] / 32u, 1u << of[k] % 32u);
            e = vload4(of[0], light) * w[0][i];
            e = vit_along4(e, w[1][i], vload4(of[1], light));
            e = vit_along4(e, w[2][i], vload4(of[2], light));
            if (VIT_EFFECT_LIGHTMAP_RAYS && cells[(size_t)index[i] * 4 + 3] == VIT_RECEIVER_BY_RAYS)
                e = VIT_FLOAT4(-1.0f, -1.0f, -1.0f, 0.0f);
        }
        float out[4];
        vstore4(e, 0, out);
        for (int k = 0; k < 3; k++)
            value[k][i] = out[k];
    }
    return lv3_set(L_LOAD(value[0]), L_LOAD(value[1]), L_LOAD(value[2]));
}
