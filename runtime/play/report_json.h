/* report_json.c: --report FILE.json, what was measured for machines to read. */
#ifndef VIT_PLAY_REPORT_JSON_H
#define VIT_PLAY_REPORT_JSON_H

#include "report.h"
#include "work_count.h"

typedef struct report_json {
    const char *pack, *device, *view, *format; /* names */
    uint32_t first, end;                       /* frames of a round */
    const report *times;
    const vit_requirements *need;
    const vit_statistics *last; /* of the last frame */
    uint64_t late;
    const work_counts *work; /* NULL: not counted */
    const uint64_t *hashes;  /* of the first `hash_count` frames of the round */
    uint64_t hash_count;
    bool verified, golden; /* the hashes were compared with the pack's, with a file's */
    vit_status verdict;
    const char *verdict_text; /* "" if all is well */
    const char *noise;        /* what is to be known of --budget's verdict; "": nothing */
} report_json;

/* VIT_FAILED: the file cannot be written. runtime/README.md has the layout. */
vit_status report_json_write(const char *path, const report_json *r, vit_text *why);

#endif
