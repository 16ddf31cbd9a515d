/* Radiosity as of old (Goral and others 1984): k times, the light of the reflection before times the form factors, times the
 * albedo. Stands behind the library's kernels, a lane a row, laid out for lanes as kernels/transfer_product.clh has it, so that
 * what differs is the method.
 *
 * factors: [panel of 16 rows][column][row]; light, reflected, all, albedo: a plane a channel of `stride` floats; sums: [chunk
 * of VIT_TRANSFER_CHUNK columns][channel][row]; size[0]: stride, size[1]: chunks. */

kernel void radiosity_gather(global const uint *size, global const float *factors, global const float *light,
                             global float *sums) {
    const uint item = (uint)get_global_id(0), parts = VIT_TRANSFER_ROWS / VIT_LANES, stride = size[0];
    const uint r = item % parts * VIT_LANES, chunk = item / parts % size[1], panel = item / parts / size[1];
    const uint first = chunk * VIT_TRANSFER_CHUNK, end = min(stride, first + VIT_TRANSFER_CHUNK);
    global const float *p = factors + ((size_t)panel * stride + first) * 16 + r;
    lf red = L_F(0), green = L_F(0), blue = L_F(0);
    for (uint j = first; j < end; j++, p += 16) {
        const lf f = L_LOAD(p);
        red = fma(f, L_F(light[4 * j]), red);
        green = fma(f, L_F(light[4 * j + 1]), green);
        blue = fma(f, L_F(light[4 * j + 2]), blue);
    }
    global float *to = sums + (size_t)chunk * 3 * stride + panel * 16 + r;
    L_STORE(red, to);
    L_STORE(green, to + stride);
    L_STORE(blue, to + 2 * stride);
}

/* The sums, times the albedo, become this reflection's light and are added to all that was reflected; begin[0]: nothing was. */
kernel void radiosity_reflect(global const uint *size, global const float *albedo, global const float *sums,
                              global float *reflected, global float *all, global const uint *begin) {
    const uint stride = size[0], first = (uint)get_global_id(0) * VIT_LANES;
    for (uint c = 0; c < 3; c++) {
        lf sum = L_F(0);
        for (uint k = 0; k < size[1]; k++)
            sum = sum + L_LOAD(sums + ((size_t)k * 3 + c) * stride + first);
        sum = sum * L_LOAD(albedo + (size_t)c * stride + first);
        float one[VIT_LANES];
        L_STORE(sum, one);
        for (uint l = 0; l < VIT_LANES; l++)
            reflected[4 * (first + l) + c] = one[l];
        L_STORE(begin[0] ? sum : sum + L_LOAD(all + (size_t)c * stride + first), all + (size_t)c * stride + first);
    }
}
