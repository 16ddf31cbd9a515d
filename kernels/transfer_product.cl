/* The product with a coded transfer matrix (transfer_product.clh) as four kernels, in this order; without a rank the last two
 * alone. Compiled where VIT_TRANSFER_PRODUCT is defined: no pass of a frame calls them. */
#ifdef VIT_TRANSFER_PRODUCT
kernel void transfer_project(global const vit_transfer *code, global const float *x, global float *projected) {
    transfer_project_item((uint)get_global_id(0), code, x, projected);
}

kernel void transfer_mix(global const vit_transfer *code, global const float *projected, global float *mixed) {
    transfer_mix_item((uint)get_global_id(0), code, projected, mixed);
}

kernel void transfer_partial(global const vit_transfer *code, global const float *x, global const float *mixed,
                             global float *sums) {
    transfer_sums_item((uint)get_global_id(0), code, x, mixed, sums);
}

kernel void transfer_sum(global const vit_transfer *code, global const float *sums, global float *y) {
    transfer_add_item((uint)get_global_id(0), code, sums, y);
}
#endif
