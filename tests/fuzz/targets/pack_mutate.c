/* How libFuzzer changes a script of pack.c: it adds, replaces or drops a line. */
#include "fuzz.h"
#include "vitrine_pack.h"

#include <stdio.h>
#include <string.h>

static const char codes[][5] = {
#define X(code, type, records) #code,
    VIT_SECTIONS(X)
#undef X
        "HEAD",
    "TABL",
    "FILE",
    "META",
    "META",
    "BVHN",
    "MIPS",
    "TEXR",
    "SIDE",
    "RCEL",
    "BGRP",
    "BFRM",
    "PATC",
    "GROW",
    "GATH",
    "LOOK",
    "XFER",
    "CACH",
    "MSID",
    "MCEL",
    "MSPL",
};

static const char *const bases[] = {"basis", "live", "points", "lightmap"};

static const uint32_t values[] = {
    0,          1,          2,          3,          0x10,       0x40,       0xff,       0x1000,
    0x7fffffff, 0x80000000, 0xffffffff, 0xfffffff0, 0x3f800000, 0xbf800000, 0x7f800000, 0xff800000,
    0x7fc00000, 0x7f7fffff, 0xff7fffff, 0x00800000, 0x00000001, 0x40000000,
};

static uint32_t next(uint64_t *state) {
    *state = *state * 6364136223846793005u + 1442695040888963407u;
    return (uint32_t)(*state >> 33);
}

/* Length of the line at `at`, its feed included. */
static size_t line_length(const uint8_t *data, size_t size, size_t at) {
    const uint8_t *feed = memchr(data + at, '\n', size - at);
    return feed ? (size_t)(feed - data) - at + 1 : size - at;
}

static size_t a_line(const uint8_t *data, size_t size, uint64_t *state) {
    size_t at = 0;
    for (uint32_t skip = next(state) % 16; skip > 0 && at < size; skip--) {
        const size_t length = line_length(data, size, at);
        at = at + length < size ? at + length : 0;
    }
    return at;
}

static int new_line(char *line, size_t room, uint64_t *state) {
    const uint32_t kind = next(state) % 32, index = next(state) % (next(state) % 4 ? 64 : 4096);
    uint32_t value = values[next(state) % (sizeof values / sizeof values[0])];
    if (next(state) % 4 == 0)
        value = next(state) >> next(state) % 32;
    if (kind == 0)
        return snprintf(line, room, "chain %u\n", 1 + next(state) % 95);
    if (kind == 3)
        return snprintf(line, room, "%s\n", bases[next(state) % (sizeof bases / sizeof bases[0])]);
    if (kind == 1)
        return snprintf(line, room, next(state) % 2 ? "plain\n" : "kept\n");
    if (kind == 2)
        return snprintf(line, room, "cut %u\n", next(state) % 70000);
    return snprintf(line, room, "%s %u %c %x\n", codes[next(state) % (sizeof codes / sizeof codes[0])], index,
                    "==+^"[next(state) % 4], value);
}

size_t fuzz_pack_mutate(uint8_t *data, size_t size, size_t most, unsigned seed) {
    uint64_t state = seed * (uint64_t)0x9e3779b97f4a7c15u + size;
    char line[64] = "";
    size_t at = size > 0 ? a_line(data, size, &state) : 0, gone = 0;
    const uint32_t how = next(&state) % 4;
    if (how >= 2 && at < size) /* replace or drop */
        gone = line_length(data, size, at);
    const size_t length = how == 3 && size > 0 ? 0 : (size_t)new_line(line, sizeof line, &state);
    if (size - gone + length > most)
        return size;
    memmove(data + at + length, data + at + gone, size - at - gone);
    memcpy(data + at, line, length);
    return size - gone + length;
}
