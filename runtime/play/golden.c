#include "golden.h"
#include "failure.h"
#include "line_reader.h"
#include "sinks/output.h"
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

#define HEAD "vitrine-golden 1"
#define HASH_DIGITS 16

static bool read_range(char *text, char between, uint32_t *a, uint32_t *b) {
    uint64_t first, second;
    char *mid = strchr(text, between);
    if (mid == NULL)
        return false;
    *mid = '\0';
    const bool good = line_number(text, UINT32_MAX, &first) && line_number(mid + 1, UINT32_MAX, &second);
    *a = good ? (uint32_t)first : 0;
    *b = good ? (uint32_t)second : 0;
    return good;
}

static vit_status read_head(line_reader *r, const golden_frames *of, vit_text *why) {
    char *words[8];
    uint32_t first, end, width, height;
    vit_status status = line_next(r, why);
    if (status == VIT_OK && strcmp(r->text, HEAD) != 0)
        return line_bad(r, why, "not a file of golden hashes: the first line must be '" HEAD "'");
    if (status == VIT_OK)
        status = line_next(r, why);
    if (status != VIT_OK)
        return status;
    if (!line_split(r->text, words, 8, GOLDEN_NAME) || strcmp(words[0], "frames") != 0 || strcmp(words[2], "view") != 0 ||
        strcmp(words[4], "format") != 0 || strcmp(words[6], "size") != 0 || !read_range(words[1], ':', &first, &end) ||
        !read_range(words[7], 'x', &width, &height) || first >= end)
        return line_bad(r, why, "must be 'frames A:B view NAME format NAME size WxH' with A < B");
    if (first == of->first && end == of->end && strcmp(words[3], of->view) == 0 && strcmp(words[5], of->format) == 0 &&
        width == of->width && height == of->height)
        return VIT_OK;
    return play_fail(
        why, VIT_USAGE,
        "--golden %.150s is of --frames %u:%u --view %s --format %s, %ux%u, but %u:%u %s %s, %ux%u is to be played", r->path,
        first, end, words[3], words[5], width, height, of->first, of->end, of->view, of->format, of->width, of->height);
}

static bool read_hash(const char *word, uint64_t *out) {
    if (strlen(word) != HASH_DIGITS || strspn(word, "0123456789abcdef") != HASH_DIGITS)
        return false;
    *out = strtoull(word, NULL, 16);
    return true;
}

static vit_status read_rows(line_reader *r, const golden_frames *of, uint64_t *hashes, vit_text *why) {
    for (uint32_t i = of->first; i < of->end; i++) {
        char *words[2];
        uint64_t frame;
        vit_status status = line_next(r, why);
        if (status != VIT_OK)
            return status;
        if (!line_split(r->text, words, 2, GOLDEN_NAME) || !line_number(words[0], UINT32_MAX, &frame) ||
            !read_hash(words[1], &hashes[i - of->first]))
            return line_bad(r, why, "must be 'FRAME HASH' with a hash of 16 hexadecimal digits");
        if (frame != i)
            return line_bad(r, why, "frames must follow one another, and all of the range be there");
    }
    return line_end(r, why);
}

vit_status golden_read(const char *path, const golden_frames *of, uint64_t *hashes, vit_text *why) {
    line_reader r;
    vit_status status = line_open(&r, path, why);
    if (status != VIT_OK)
        return status;
    status = read_head(&r, of, why);
    if (status == VIT_OK)
        status = read_rows(&r, of, hashes, why);
    line_close(&r);
    return status;
}

vit_status golden_write(const char *path, const golden_frames *of, const uint64_t *hashes, vit_text *why) {
    char *text = NULL;
    size_t size = 0;
    FILE *to = open_memstream(&text, &size);
    if (to == NULL)
        return play_fail(why, VIT_FAILED, "%s: out of memory", path);
    (void)fprintf(to, HEAD "\n# Hashes of the frames of vitrine-play, equal on every device: frame, XXH3-64 of its pixels.\n");
    (void)fprintf(to, "frames %u:%u view %s format %s size %ux%u\n", of->first, of->end, of->view, of->format, of->width,
                  of->height);
    for (uint32_t i = of->first; i < of->end; i++)
        (void)fprintf(to, "%u %016" PRIx64 "\n", i, hashes[i - of->first]);
    (void)fputs("end\n", to);
    vit_status status =
        fclose(to) == 0 ? output_file(path, text, size, why) : play_fail(why, VIT_FAILED, "%s: out of memory", path);
    free(text);
    return status;
}
