/* Baked indirect light (METHODS.md, "Irradiance basis"): the pass relight brings receivers' irradiance up to where the frame's
 * lights are; samples interpolate between the three receivers of their cell. */

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
        WORK_ADD(evaluations, (ulong)rank * VIT_LANES);
        for (uint k = 0; k < rank; k++) {
            li word = L_AS_INT(L_LOAD(vector + k * RELIGHT_HALF));
            lf a = L_FROM_INT((word << 16) >> 16), b = L_FROM_INT(word >> 16);
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

#define RECEIVER_PARAMETERS                                                                                                    \
    global const vit_triangle *triangles, global const uint *hit_triangle, global const uint *sides,                           \
        global const uint *receiver_cells, global const float *receiver_splits, global const float *receivers,                 \
        global const float *relit
#define RECEIVER_ARGUMENTS triangles, hit_triangle, sides, receiver_cells, receiver_splits, receivers, relit

/* Barycentric weights of the lanes' places p in their triangles, and whether they are on the back: normals s say. Neighbours
 * mostly share a triangle: each is read once. */
static inline void receiver_place(global const vit_triangle *triangles, li lanes, li triangle, lv3 p, lv3 s, lf *b1, lf *b2,
                                  li *back) {
    *b1 = *b2 = L_F(0);
    *back = L_I(0);
    li own;
    while (l_any(lanes)) {
        global const vit_triangle *t = triangles + surface_next(&lanes, triangle, &own);
        float largest = vit_max(vit_max(fabs(t->nx), vit_max(fabs(t->ny), fabs(t->nz))), 1e-37f);
        float inverse = vit_div(1.0f, largest), nx = t->nx * inverse, ny = t->ny * inverse, nz = t->nz * inverse,
              scale = vit_div(inverse, fma(nz, nz, fma(ny, ny, nx * nx)));
        float ax = t->v1[0] - t->v0[0], ay = t->v1[1] - t->v0[1], az = t->v1[2] - t->v0[2];
        float bx = t->v2[0] - t->v0[0], by = t->v2[1] - t->v0[1], bz = t->v2[2] - t->v0[2];
        /* (q x b) . n = q . (b x n), and (a x q) . n = q . (n x a) */
        float ux = by * nz - bz * ny, uy = bz * nx - bx * nz, uz = bx * ny - by * nx;
        float vx = ny * az - nz * ay, vy = nz * ax - nx * az, vz = nx * ay - ny * ax;
        lv3 q = lv3_sub(p, lv3_load(t->v0));
        *b1 = l_sel(own, l_max(L_F(0), fma(q.z, L_F(uz), fma(q.y, L_F(uy), q.x * ux)) * scale), *b1);
        *b2 = l_sel(own, l_max(L_F(0), fma(q.z, L_F(vz), fma(q.y, L_F(vy), q.x * vx)) * scale), *b2); /* no NaN either */
        lf facing = fma(s.z, L_F(nz), fma(s.y, L_F(ny), s.x * nx));
        *back = l_sel_i(own, L_LT(facing, L_F(0)), *back);
    }
}

static inline lf receiver_light(global const float *light, li a, li b, li c, const cell_place *at) {
    return fma(at->w2, L_GATHER(lf, light, c), fma(at->w1, L_GATHER(lf, light, b), at->w0 * L_GATHER(lf, light, a)));
}

/* Irradiance of the lanes' samples, W/m2; 0 where the key is negative. at: their numbers. */
static inline lv3 receiver_gather(RECEIVER_PARAMETERS, li key, const estimate_sample *sample, li at) {
    global const float *light = VIT_EFFECT_RELIGHT ? relit : receivers;
    li lanes = L_GE(key, L_I(0)), back;
    if (!l_any(lanes))
        return lv3_set(L_F(0), L_F(0), L_F(0));
    lf b1, b2;
    li triangle = lanes & L_AS_INT(l_gather_u(hit_triangle, at));
    receiver_place(triangles, lanes, triangle, sample->p, sample->s, &b1, &b2, &back);
    cell_place cell = cell_at(sides, lanes, triangle, back, b1, b2);
    li first = cell.index * 4;
    li a = L_AS_INT(l_gather_u(receiver_cells, first)), b = L_AS_INT(l_gather_u(receiver_cells, first + 1)),
       c = L_AS_INT(l_gather_u(receiver_cells, first + 2)), split = L_AS_INT(l_gather_u(receiver_cells, first + 3));
    li apart = lanes & L_NE(split, L_I((int)VIT_NONE));
    if (l_any(apart)) { /* behind the plane: other receivers */
        li record = (apart & split) * 8;
        lf front = fma(
            sample->p.z, L_GATHER(lf, receiver_splits + 2, record),
            fma(sample->p.y, L_GATHER(lf, receiver_splits + 1, record), sample->p.x * L_GATHER(lf, receiver_splits, record)));
        apart &= ~L_GT(front, L_GATHER(lf, receiver_splits + 3, record));
        a = l_sel_i(apart, L_AS_INT(l_gather_u((global const uint *)receiver_splits + 4, record)), a);
        b = l_sel_i(apart, L_AS_INT(l_gather_u((global const uint *)receiver_splits + 5, record)), b);
        c = l_sel_i(apart, L_AS_INT(l_gather_u((global const uint *)receiver_splits + 6, record)), c);
    }
    a *= 4;
    b *= 4;
    c *= 4;
    lv3 e = lv3_set(receiver_light(light, a, b, c, &cell), receiver_light(light + 1, a, b, c, &cell),
                    receiver_light(light + 2, a, b, c, &cell));
    return lv3_sel(lanes, e, lv3_set(L_F(0), L_F(0), L_F(0)));
}
