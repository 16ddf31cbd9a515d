/* Live radiosity (METHODS.md, "Live radiosity"): light on patches by shadow rays from their points (patch_light, patch_mean),
 * what reflections add to it by the product with a coded transfer matrix (transfer_product.cl, patch_reflect), and what of it
 * receivers see (gather_patches). `radiosity`: four floats a column, the channels and one that is 0; columns are the patches,
 * to a whole sixteen, then all patches' points. */
#if VIT_WITH(RADIOSITY)

/* Radiosity of points by the lights that are live. */
kernel void patch_light(RAY_SCENE_PARAMETERS, uint frame, global const vit_light *lights, global const vit_patch_point *points,
                        global float *radiosity WORK_PARAMETERS) {
    uint first = (uint)get_global_id(0) * VIT_LANES;
    if (first >= scene->patch_points)
        return;
    global const float *p = (global const float *)points;
    const int words = (int)(sizeof(vit_patch_point) / sizeof(float));
    li at = (L_INDEX + (int)first) * words;
    lit_sample s;
    s.p = lv3_set(L_GATHER(lf, p, at), L_GATHER(lf, p + 1, at), L_GATHER(lf, p + 2, at));
    s.n = s.face = lv3_set(L_GATHER(lf, p + 4, at), L_GATHER(lf, p + 5, at), L_GATHER(lf, p + 6, at));
    s.hit = L_GT(L_GATHER(lf, p + 7, at), L_F(0));
    lv3 e = lv3_set(L_F(0), L_F(0), L_F(0));
    WORK_BEGIN
    for (uint i = 0; i < scene->lights; i++) {
        global const vit_light *light = lights + (size_t)frame * scene->lights + i;
        if (!(scene->live[i / 32u] >> (i % 32u) & 1u))
            continue;
        lv3 to;
        lf cosine, d;
        lv3 l = lit_way(scene, light, &s, &to, &d, &cosine);
        li lit = s.hit & L_GT(cosine, L_F(0)); /* a way round the ray where none is makes NVIDIA's 580 fault at 8 lanes */
        ray_packet r = ray_make(s.p, l);
        WORK_LANES(shadow_rays, lit);
        lit &= ~ray_occluded(RAY_SCENE, &r, lit, d);
        WORK_TRACED(r);
        e = lv3_along(e, lv3_load(light->intensity), l_sel(lit, cosine, L_F(0)));
    }
    float value[3][VIT_LANES];
    L_STORE(e.x * L_GATHER(lf, p + 8, at), value[0]);
    L_STORE(e.y * L_GATHER(lf, p + 9, at), value[1]);
    L_STORE(e.z * L_GATHER(lf, p + 10, at), value[2]);
    for (uint i = 0; i < VIT_LANES; i++)
        vstore4(VIT_FLOAT4(value[0][i], value[1][i], value[2][i], 0.0f), VIT_PATCH_STRIDE(scene) + first + i, radiosity);
    WORK_END
}

/* Radiosity of patches: of their points, in their order. */
kernel void patch_mean(global const vit_scene *scene, global const vit_patch *patches, global const vit_patch_point *points,
                       global float *radiosity) {
    uint patch = (uint)get_global_id(0), stride = VIT_PATCH_STRIDE(scene);
    if (patch >= stride)
        return;
    float4 sum = VIT_FLOAT4(0.0f, 0.0f, 0.0f, 0.0f);
    uint end = patch < scene->patches ? patches[patch].end : 0;
    for (uint i = end ? patches[patch].first : 0; i < end; i++)
        sum = vit_along4(sum, points[i].weight, vload4(stride + i, radiosity));
    vstore4(sum, patch, radiosity);
}
#endif

#if VIT_WITH(TRANSFER)
/* At least 0, which is what is no number, too. */
static inline float radiosity_reflected(global const vit_scene *scene, float y) {
    y = y > 0.0f ? y : 0.0f;
    return y < scene->most_reflected ? y : scene->most_reflected;
}

/* Adds what reflections give a patch to its column, or to a point's by its own albedo. */
kernel void patch_reflect(global const vit_scene *scene, global const vit_patch_point *points, global const float *reflected,
                          global float *radiosity) {
    uint column = (uint)get_global_id(0), stride = VIT_PATCH_STRIDE(scene);
    if (column >= stride + scene->patch_points)
        return;
    global const vit_patch_point *p = points + (column < stride ? 0 : column - stride);
    uint patch = column < stride ? column : p->patch;
    for (uint k = 0; k < 3; k++) {
        float share = column < stride ? 1.0f : p->reflect[k];
        radiosity[4 * column + k] =
            fma(radiosity_reflected(scene, reflected[k * stride + patch]), share, radiosity[4 * column + k]);
    }
}
#endif

#if VIT_WITH(RADIOSITY)
/* Four sums of columns of weight 1, two a word: column i belongs to sum i % 4. */
static inline float4 gather_ones(global const uint *at, uint count, global const float *radiosity) {
    float4 a = VIT_FLOAT4(0.0f, 0.0f, 0.0f, 0.0f), b = a, c = a, d = a;
    uint i = 0;
    for (; i + 4 <= count; i += 4) {
        uint first = at[i / 2], second = at[i / 2 + 1];
        a += vload4(first & 0xffffu, radiosity);
        b += vload4(first >> 16, radiosity);
        c += vload4(second & 0xffffu, radiosity);
        d += vload4(second >> 16, radiosity);
    }
    if (i < count)
        a += vload4(at[i / 2] & 0xffffu, radiosity);
    if (i + 1 < count)
        b += vload4(at[i / 2] >> 16, radiosity);
    if (i + 2 < count)
        c += vload4(at[i / 2 + 1] & 0xffffu, radiosity);
    return (a + b) + (c + d);
}

/* Two sums of weighted columns, even and odd ones. */
static inline float4 gather_weighted(global const uint *at, uint count, global const float *radiosity) {
    float4 even = VIT_FLOAT4(0.0f, 0.0f, 0.0f, 0.0f), odd = even;
    uint i = 0;
    for (; i + 2 <= count; i += 2) {
        even = vit_along4(even, (float)(at[i] >> 16), vload4(at[i] & 0xffffu, radiosity));
        odd = vit_along4(odd, (float)(at[i + 1] >> 16), vload4(at[i + 1] & 0xffffu, radiosity));
    }
    if (i < count)
        even = vit_along4(even, (float)(at[i] >> 16), vload4(at[i] & 0xffffu, radiosity));
    return even + odd;
}

/* Irradiance of a receiver that the frame looks up: of light that stays, and of what it sees. */
kernel void gather_patches(global const vit_scene *scene, uint frame, global const vit_gather_row *rows,
                           global const uint *words, global const uint *looked_up, global const vit_receiver *receivers,
                           global const float *radiosity, global float *relit WORK_PARAMETERS) {
    uint receiver = (uint)get_global_id(0);
    if (receiver >= scene->receivers)
        return;
    if (!(looked_up[frame / scene->looked_frames * (scene->receivers / 32u) + receiver / 32u] >> receiver % 32u & 1u)) {
        vstore4(VIT_FLOAT4(0.0f, 0.0f, 0.0f, 0.0f), receiver, relit);
        return;
    }
    global const vit_gather_row *row = rows + receiver;
    global const uint *at = words + row->first;
    global const float *still = receivers[receiver].irradiance;
    WORK_BEGIN
    WORK_ADD(evaluations, row->ones + row->weighted);
    WORK_ADD(bytes, sizeof(vit_gather_row) + sizeof(vit_receiver) + 4u * VIT_GATHER_WORDS(row));
    float4 ones = gather_ones(at, row->ones, radiosity);
    float4 e = vit_along4(ones, 1.0f / VIT_GATHER_ONE, gather_weighted(at + (row->ones + 1u) / 2u, row->weighted, radiosity));
    vstore4(vit_along4(VIT_FLOAT4(still[0], still[1], still[2], 0.0f), row->scale, e), receiver, relit);
    WORK_END
}
#endif
