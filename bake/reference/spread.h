/* spread.c: the reference's work over the processes of an MPI run (`mpirun vitrine-cost ...`). Built with MPI only where it is
 * installed (-DVIT_MPI=1); without it, or outside mpirun, there is one rank and all of this does nothing.
 *
 * Ranks run the same program on the same input and call these functions in the same order. */
#ifndef VIT_COST_SPREAD_H
#define VIT_COST_SPREAD_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* At the start and at the end of main(), once. */
void spread_begin(int *argc, char ***argv);
void spread_end(void);

unsigned spread_rank(void); /* 0 .. spread_size() - 1 */
unsigned spread_size(void);
unsigned spread_neighbours(void); /* ranks on this machine, this one included */

/* Joins arrays of which every rank has filled a part of its own and left zeros elsewhere: afterwards all have the whole. Exact,
 * since each element is one number plus zeros. */
void spread_gather(double *values, size_t count);
uint64_t spread_sum(uint64_t value);
bool spread_any(bool value);
/* Rank 0's bytes to all. */
void spread_share(void *bytes, size_t size);

#endif
