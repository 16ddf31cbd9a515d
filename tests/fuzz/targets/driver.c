/* libFuzzer's entry points for one target; FUZZ_TARGET is its name. */
#include "fuzz.h"

#define JOINED_(a, b) a##b
#define JOINED(a, b) JOINED_(a, b)

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    JOINED(fuzz_, FUZZ_TARGET)(data, size);
    return 0;
}

#ifdef FUZZ_SCRIPT
size_t LLVMFuzzerCustomMutator(uint8_t *data, size_t size, size_t most, unsigned seed);
size_t LLVMFuzzerMutate(uint8_t *data, size_t size, size_t most);
size_t LLVMFuzzerCustomMutator(uint8_t *data, size_t size, size_t most, unsigned seed) {
    return seed % 4 == 0 ? LLVMFuzzerMutate(data, size, most) : fuzz_pack_mutate(data, size, most, seed);
}
#endif
