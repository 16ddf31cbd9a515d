/* matrix_order.c: patches in an order in which like ones are neighbours, so that blocks of the matrix are even and compress
 * well (Shcherbakov 2017): from a row on to the one of those left that is nearest by the sum of absolute differences, then the
 * same for columns. Rows and columns are moved together: it is the patches that get another number. */
#ifndef VIT_RADIOSITY_MATRIX_ORDER_H
#define VIT_RADIOSITY_MATRIX_ORDER_H

#include "radiosity/transfer_matrix.h"

#define MATRIX_ORDER_PASSES 2u /* at most: 0 leaves the order, 1 looks at rows, 2 at rows and then at columns */

/* patch_at[i]: which patch comes i-th; count numbers. Time grows with count^3. VIT_FAILED: out of memory. */
vit_status matrix_order_find(const transfer_matrix *m, uint32_t passes, unsigned threads, uint32_t *patch_at, vit_text *why);
/* The matrix in that order. VIT_FAILED: out of memory; `out` is then empty. */
vit_status matrix_order_apply(const transfer_matrix *m, const uint32_t *patch_at, transfer_matrix *out, vit_text *why);

#endif
