/* noise.c: hashes and value noise that repeats with a whole period, so that textures tile. */
#ifndef VIT_SCENES_NOISE_H
#define VIT_SCENES_NOISE_H

#include <stdint.h>

/* In [0, 1), the same for the same cell and seed. */
double noise_cell(int x, int y, uint32_t seed);

/* Value noise on a lattice of `period` x `period` cells over the unit square; in [0, 1]. */
double noise_value(double u, double v, int period, uint32_t seed);

/* Sum of `octaves` value noises, each twice as fine and half as strong, scaled into [0, 1]. */
double noise_fractal(double u, double v, int period, int octaves, uint32_t seed);

/* Thin bright lines where fractal noise crosses its middle: 1 on the line, 0 away from it; `sharp` >= 1 makes them thinner. */
double noise_veins(double u, double v, int period, int octaves, double sharp, uint32_t seed);

#endif
