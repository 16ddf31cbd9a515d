/* strict_math.c: elementary functions made of + - * / alone. The C library's differ in the last bit between its versions and
 * with the machine's instruction set, and what the baker computes becomes bytes of a pack. Errors: at most 4 units in the last
 * place of a double. */
#ifndef VIT_BAKE_STRICT_MATH_H
#define VIT_BAKE_STRICT_MATH_H

double strict_sin(double x); /* radians, |x| <= 1e5 */
double strict_cos(double x);
double strict_tan(double x);
double strict_atan(double x);
double strict_log(double x); /* normal x > 0 */
/* Linear value of an sRGB component in [0, 1]: IEC 61966-2-1. */
double srgb_linear(double c);

#endif
