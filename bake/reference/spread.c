#include "reference/spread.h"

#ifdef VIT_MPI
#include <mpi.h>
#include <stdlib.h>

#define MOST ((size_t)1 << 24) /* elements a call: MPI counts in int */

static struct {
    bool on;
    int rank, size, neighbours;
} spread = {.size = 1, .neighbours = 1};

/* Is this a process of an MPI run? Starting MPI alone would cost time and complain where there is no network. */
static bool under_mpirun(void) {
    return getenv("OMPI_COMM_WORLD_SIZE") || getenv("PMI_SIZE") || getenv("PMIX_RANK");
}

void spread_begin(int *argc, char ***argv) {
    MPI_Comm machine;
    if (!under_mpirun() || MPI_Init(argc, argv) != MPI_SUCCESS)
        return;
    spread.on = true;
    MPI_Comm_rank(MPI_COMM_WORLD, &spread.rank);
    MPI_Comm_size(MPI_COMM_WORLD, &spread.size);
    MPI_Comm_split_type(MPI_COMM_WORLD, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &machine);
    MPI_Comm_size(machine, &spread.neighbours);
    MPI_Comm_free(&machine);
}

void spread_end(void) {
    if (spread.on)
        MPI_Finalize();
    spread.on = false;
}

unsigned spread_rank(void) {
    return (unsigned)spread.rank;
}

unsigned spread_size(void) {
    return (unsigned)spread.size;
}

unsigned spread_neighbours(void) {
    return (unsigned)spread.neighbours;
}

void spread_gather(double *values, size_t count) {
    for (size_t first = 0; spread.on && first < count; first += MOST)
        MPI_Allreduce(MPI_IN_PLACE, values + first, (int)(count - first < MOST ? count - first : MOST), MPI_DOUBLE, MPI_SUM,
                      MPI_COMM_WORLD);
}

uint64_t spread_sum(uint64_t value) {
    if (spread.on)
        MPI_Allreduce(MPI_IN_PLACE, &value, 1, MPI_UINT64_T, MPI_SUM, MPI_COMM_WORLD);
    return value;
}

bool spread_any(bool value) {
    return spread_sum(value) > 0;
}

void spread_share(void *bytes, size_t size) {
    for (size_t first = 0; spread.on && first < size; first += MOST)
        MPI_Bcast((unsigned char *)bytes + first, (int)(size - first < MOST ? size - first : MOST), MPI_BYTE, 0,
                  MPI_COMM_WORLD);
}

#else

void spread_begin(int *argc, char ***argv) {
    (void)argc;
    (void)argv;
}

void spread_end(void) {}

unsigned spread_rank(void) {
    return 0;
}

unsigned spread_size(void) {
    return 1;
}

unsigned spread_neighbours(void) {
    return 1;
}

void spread_gather(double *values, size_t count) {
    (void)values;
    (void)count;
}

uint64_t spread_sum(uint64_t value) {
    return value;
}

bool spread_any(bool value) {
    return value;
}

void spread_share(void *bytes, size_t size) {
    (void)bytes;
    (void)size;
}
#endif
