#ifndef VIT_BAKE_PI_H
#define VIT_BAKE_PI_H

/* In double; KERNEL_PI of kernel_math.h is the kernels' float. */
#define PI 3.14159265358979323846

#endif
