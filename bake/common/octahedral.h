/* octahedral.c: unit vectors as two whole numbers (Cigolle et al. 2014, "A Survey of Efficient Representations for Independent
 * Unit Vectors"). */
#ifndef VIT_BAKE_OCTAHEDRAL_H
#define VIT_BAKE_OCTAHEDRAL_H

/* sx, sy in -most..most: 32767 for 16 bits per component, 127 for 8. In float and in this order:
 *     x = sx / most;  y = sy / most;  z = (1 - |x|) - |y|
 *     if z < 0:  x, y = (1 - |y|) * sign(x), (1 - |x|) * sign(y)        (with the old x and y; the sign of 0 is +)
 *     l = sqrt((x * x + y * y) + z * z);  n = (x / l, y / l, z / l) */
void octahedral_decode(const int s[2], int most, float n[3]);

/* The nearest of the four codes around n, which need not be of unit length; the zero vector gives 0, 0, which is +z. Off by
 * less than 5e-5 radians with 16 bits, 1.3e-2 with 8 (tests/unit/test_geometry.c and test_quantise.c measure it). */
void octahedral_encode(const float n[3], int most, int s[2]);

#endif
