/* Indirect light from photons, by list or by buckets: the pass estimate_all, and what it and sparse.cl ask of either. Which
 * samples are to be lit, and which go together: indirect_keys. Their irradiance: indirect_gather. A further way to gather
 * photons adds its branch there, its buffers to INDIRECT_PARAMETERS and ARGS_INDIRECT (runtime/pass_table.h). Light that is
 * looked up at a sample's place, of baked receivers, is added where samples are made (receivers.cl, samples.cl). */

/* Buffers that the pack's effects do not call for are NULL. */
#define INDIRECT_PARAMETERS                                                                                                    \
    global const vit_scene *scene, global const vit_camera *cameras, uint frame, uint max_nodes, global const uint *masks,     \
        global const uint *prefix, global const uint *list_first, global const uint *list_count, global const uint *list,      \
        global const vit_photon *photons, global const int *bounds, global const float *buckets, global const uint *keys,      \
        global const float *position, global const uint *normal, ESTIMATE_BAKED
#define INDIRECT_ARGUMENTS                                                                                                     \
    scene, cameras, frame, max_nodes, masks, prefix, list_first, list_count, list, photons, bounds, buckets, keys, position,   \
        normal, accept, inverse_area

/* Keys of the lanes' samples from `first` on, those of a cluster the same; negative where they get no indirect light: nothing
 * hit or a dark side. Samples of one key are best estimated together. */
static inline li indirect_keys(global const uint *keys, uint first) {
    return L_AS_INT(L_LOAD(keys + first));
}

/* Of the samples of these numbers. */
static inline li indirect_keys_at(global const uint *keys, li at) {
    return L_AS_INT(l_gather_u(keys, at));
}

/* Irradiance of the lanes' samples, W/m2; 0 where the key is negative. at: their numbers. */
static inline lv3 indirect_gather(INDIRECT_PARAMETERS, li key, const estimate_sample *sample, li at WORK_PASSED) {
    if (VIT_EFFECT_LIST)
        return estimate_gather(ESTIMATE_ARGUMENTS, key, sample WORK_PASS);
    li x, y;
    l_pixel_of(scene, at, &x, &y);
    return bucket_gather(BUCKET_ARGUMENTS, key, sample, x, y WORK_PASS);
}

#if VIT_WITH(PHOTONS) && VIT_WITH_DENSE
kernel void estimate_all(INDIRECT_PARAMETERS, global float *indirect WORK_PARAMETERS) {
    uint first = (uint)get_global_id(0) * VIT_LANES, n = scene->samples;
    if (first >= n)
        return;
    li key = indirect_keys(keys, first);
    lv3 total = lv3_set(L_F(0), L_F(0), L_F(0));
    WORK_BEGIN
    if (l_any(L_GE(key, L_I(0)))) {
        estimate_sample sample = estimate_load(scene, first, position, normal, accept, inverse_area);
        total = indirect_gather(INDIRECT_ARGUMENTS, key, &sample, (int)first + L_INDEX WORK_PASS);
    }
    lv3_store_planes(total, indirect, n, first);
    WORK_END
}
#endif
