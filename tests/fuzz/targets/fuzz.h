/* What is fuzzed: functions that take any bytes as one input and check what must hold for each. libFuzzer calls them through
 * driver.c (make fuzz), test_fuzz_corpus.c with every seed (make test). */
#ifndef VIT_FUZZ_H
#define VIT_FUZZ_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* X(name, most bytes of an input): function fuzz_NAME, seeds in tests/fuzz/seeds/NAME. */
#define FUZZ_TARGETS(X)                                                                                                        \
    X(pack, 4096)                                                                                                              \
    X(scene, 8192)                                                                                                             \
    X(mesh, 4096)                                                                                                              \
    X(gltf, 4096)                                                                                                              \
    X(obj, 4096)                                                                                                               \
    X(ply, 4096)                                                                                                               \
    X(stl, 4096)                                                                                                               \
    X(3mf, 8192)                                                                                                               \
    X(assimp, 4096)

#define X(name, most) void fuzz_##name(const uint8_t *data, size_t size);
FUZZ_TARGETS(X)
#undef X

/* Ends the process with one line if `what` is false. */
#define FUZZ_HOLDS(what) ((what) ? (void)0 : fuzz_failed(__FILE__, __LINE__, #what))
__attribute__((noreturn)) void fuzz_failed(const char *file, int line, const char *what);

/* An error must be one line, ended within `room` bytes. */
void fuzz_one_line(const char *text, size_t room);

/* files.c: an input as files. A line "=== NAME" begins the file NAME, which the target must know; what stands before the first
 * such line goes into `first`. Each call removes the files of the call before. */
typedef struct fuzz_files {
    const char *const *names; /* that the target knows, NULL at the end; the first is the default */
    const char *main;         /* path of the first file of the input */
} fuzz_files;
void fuzz_write_files(fuzz_files *f, const uint8_t *data, size_t size);

/* model.c: imports a mesh file in this process. */
void fuzz_import(const char *file);

/* mesh.c: every input goes through all steps. */
extern bool fuzz_mesh_whole;

/* pack_mutate.c: how libFuzzer changes an input of that target: lines of an edit script rather than bytes. */
size_t fuzz_pack_mutate(uint8_t *data, size_t size, size_t most, unsigned seed);

#endif
