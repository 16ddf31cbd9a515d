/* Prints the golden and the played hash of every frame of a pack, on the device host: the smallest program that plays. For
 * machines other than this one: cross-compiled it needs the C library alone. hashes pack.vit [lanes]      exit 0 if all are
 * equal, 4 if not */
#include "vitrine.h"
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>

static void *read_file(const char *path, size_t *size) {
    FILE *f = fopen(path, "rb");
    long length = f && fseek(f, 0, SEEK_END) == 0 ? ftell(f) : -1;
    void *bytes = length > 0 ? aligned_alloc(4096, ((size_t)length + 4095) / 4096 * 4096) : NULL;
    if (bytes && (rewind(f), fread(bytes, 1, (size_t)length, f) != (size_t)length)) {
        free(bytes);
        bytes = NULL;
    }
    if (f)
        (void)fclose(f);
    *size = bytes ? (size_t)length : 0;
    return bytes;
}

int main(int argc, char **argv) {
    vit_requirements need;
    vit_text why = {"cannot be read"};
    vit *v = NULL;
    vit_open_info info = {.device = VIT_DEVICE_HOST, .lanes = argc > 2 ? (uint32_t)atoi(argv[2]) : 0};
    if (argc < 2)
        return VIT_USAGE;
    info.pack = read_file(argv[1], &info.pack_size);
    vit_status status = info.pack ? vit_require(&info, &need, &why) : VIT_FAILED;
    unsigned char *frame = NULL;
    if (status == VIT_OK) {
        info.arena_size = (need.host_bytes + 63) / 64 * 64;
        info.arena = aligned_alloc(64, info.arena_size);
        frame = malloc(need.frame_bytes);
        status = info.arena && frame ? vit_open(&info, &v, &why) : VIT_FAILED;
    }
    int differ = 0;
    for (uint32_t i = 0; status == VIT_OK && i < need.frames; i++) {
        status = vit_frame(v, i, frame, need.frame_bytes / need.height, &why);
        const uint64_t golden = vit_golden(v, i), hash = vit_hash_frame(frame, info.format, need.frame_bytes);
        differ += golden != hash;
        printf("%016" PRIx64 " %016" PRIx64 "\n", golden, hash);
    }
    if (status != VIT_OK)
        fprintf(stderr, "%s: %s\n", argv[1], why.text);
    vit_close(v);
    free(frame);
    free(info.arena);
    free((void *)(uintptr_t)info.pack);
    return status != VIT_OK ? (int)status : differ ? VIT_MISMATCH : VIT_OK;
}
