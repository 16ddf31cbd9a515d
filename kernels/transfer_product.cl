/* The passes transfer_project, transfer_mix, transfer_partial and transfer_sum: the product with a coded transfer matrix
 * (transfer_product.clh), in this order; without a rank the last two alone. VIT_TRANSFER_PRODUCT: for tests, without a scene.
 */
#if VIT_WITH(TRANSFER) || defined(VIT_TRANSFER_PRODUCT)
kernel void transfer_project(global const vit_transfer *code, global const float *x, global float *projected) {
    uint item = (uint)get_global_id(0);
    if (item < code->rank / VIT_LANES * transfer_column_chunks(code))
        transfer_project_item(item, code, x, projected);
}

kernel void transfer_mix(global const vit_transfer *code, global const float *projected, global float *mixed) {
    uint item = (uint)get_global_id(0);
    if (item < 3 * (code->rank / VIT_LANES))
        transfer_mix_item(item, code, projected, mixed);
}

kernel void transfer_partial(global const vit_transfer *code, global const float *x, global const float *mixed,
                             global float *sums) {
    uint item = (uint)get_global_id(0);
    if (item < code->stride / VIT_LANES * transfer_sums(code))
        transfer_sums_item(item, code, x, mixed, sums);
}

kernel void transfer_sum(global const vit_transfer *code, global const float *sums, global float *y) {
    uint item = (uint)get_global_id(0);
    if (item < code->stride / VIT_LANES)
        transfer_add_item(item, code, sums, y);
}
#endif
