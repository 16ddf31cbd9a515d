/* What a run of the player holds. main.c fills it, conclude.c tells about it. */
#ifndef VIT_PLAY_PLAYER_H
#define VIT_PLAY_PLAYER_H

#include "framebuffer.h"
#include "golden.h"
#include "machine_load.h"
#include "options.h"
#include "pacing.h"
#include "pack_file.h"
#include "report.h"
#include "verify.h"
#include "work_budget.h"

typedef struct player {
    const play_options *options;
    pack_file pack;
    vit_open_info info;
    vit_requirements need;
    uint32_t first, end; /* frames of a round, checked against the pack */
    uint64_t all;        /* frames of all rounds; UINT64_MAX: without an end */
    void *arena;
    framebuffer frame;
    vit *v;
    void *sink; /* the sink's state */
    bool sink_is_open;
    report report;
    verdict verdict;
    uint64_t *hashes, *golden; /* of the frames of the range, played and of --golden; NULL: not asked for */
    pacing pacing;
    machine_load load;   /* before the first frame */
    double others;       /* part of the processors' time that others had during the frames; -1: not known */
    uint64_t done;       /* frames that were rendered, checked and written */
    vit_statistics last; /* of the last of them */
    work_budget limit;   /* --work-budget, read */
    work_counts work;
    int stopped_by; /* signal that ended it; 0: none */
} player;

/* What the hashes of the frames are of. */
golden_frames player_frames(const player *p);

/* conclude.c: tables, files and verdicts at the end, also of a run that was interrupted (VIT_FAILED). VIT_MISMATCH and
 * VIT_BUDGET: what did not hold. */
vit_status conclude(player *p, vit_text *why);

#endif
