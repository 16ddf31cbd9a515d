/* What the files of a sweep share. */
#ifndef VIT_COST_SWEEP_PARTS_H
#define VIT_COST_SWEEP_PARTS_H

#include "cost/images.h"
#include "cost/knobs.h"
#include "cost/sweep.h"

/* A setting's pack; bytes NULL: not kept, to be made again. */
typedef struct sweep_pack {
    void *bytes;
    size_t size;
} sweep_pack;

/* A picture of direct light, and what it was made from. */
typedef struct sweep_direct_image {
    uint64_t key;
    float *image;
} sweep_direct_image;

typedef struct sweep {
    const sweep_input *in;
    progress *progress; /* the caller's; packs are made with a quiet one */
    cost_results *out;
    uint32_t frames[SWEEP_FRAMES], frame_count;
    uint32_t at; /* the compared frame among frames[] */
    bool brief;  /* packs of settings hold the compared frame alone: they are for pictures, not for times */
    images_grid grid;
    size_t points;         /* of the grid */
    pipeline_packed base;  /* the default's: the reference reads it */
    bool *direct_only;     /* a light: photons = false */
    reference_input truth; /* what out->reference was made from */
    knob_list knobs;       /* settings as out->settings */
    sweep_pack *packs;
    uint64_t kept;               /* bytes of packs */
    float **indirect;            /* a setting: its indirect light on the grid */
    sweep_direct_image *directs; /* direct_count of at most one a setting */
    uint32_t direct_count;
} sweep;

bool sweep_cancelled(const sweep *s, vit_text *why);

/* sweep_packs.c: the pack of setting i, made again if it was not kept. */
vit_status sweep_take_pack(sweep *s, uint32_t i, vit_text *why);
void sweep_drop_pack(sweep *s, uint32_t i);
/* The compared frame's place in such a pack. */
uint32_t sweep_place(const sweep *s);
/* Pack, bytes, images and work of the settings first .. out->count - 1. */
vit_status sweep_pictures(sweep *s, uint32_t first, vit_text *why);
/* sweep_direct.c: direct light of setting i, whose pack is there, on the grid. */
vit_status sweep_direct(sweep *s, uint32_t i, const float **image, vit_text *why);
/* Fills out->direct from the default's. */
void sweep_compare_direct(sweep *s);

/* sweep_search.c: fills the list of settings. First the default, each knob alone and some combinations; then, round by round,
 * what lies beside the settings on the front of error against work, so that the front gets dense where it is. Needs a
 * reference. */
vit_status sweep_search(sweep *s, vit_text *why);

/* sweep_normals.c: fills out->normals. All ranks of an MPI run call it. */
vit_status sweep_normals(sweep *s, vit_text *why);

/* sweep_times.c: ms of every setting, and the path tracer's. */
vit_status sweep_times(sweep *s, vit_text *why);

/* The same for the settings list[0 .. count - 1], the default first, alone. */
vit_status sweep_time_some(sweep *s, const uint32_t *list, uint32_t count, vit_text *why);
/* sweep_fit.c: ms of the settings that could be the most accurate within in->fit_ms; infinite for all others. */
vit_status sweep_times_to_fit(sweep *s, vit_text *why);

/* sweep_errors.c: errors of every setting against the reference as it stands. */
vit_status sweep_errors(sweep *s, vit_text *why);
/* Is the reference's own error taken off the settings' total NMSE? */
bool sweep_own_error_off(const sweep *s);
/* The smallest total NMSE of any setting. */
double sweep_smallest_error(const sweep *s);

#endif
