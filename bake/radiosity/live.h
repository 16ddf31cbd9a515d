/* live.c: what a pack has to find indirect light of lights that are not known beforehand: patches with points where shadow rays
 * ask for direct light on them, the transfer matrix between them, and what each receiver sees of them. */
#ifndef VIT_RADIOSITY_LIVE_H
#define VIT_RADIOSITY_LIVE_H

#include "radiosity/codec.h"
#include "radiosity/receivers.h"

struct baked;

typedef struct live_input {
    const photon_rays *rays;
    const geometry *geometry;
    const tracks *tracks;
    uint32_t frames, width, height;
    const receiver *receivers;
    uint32_t receiver_count, rows; /* rows: at least as many; those beyond see nothing */
    const uint32_t *moving;        /* lights that are live */
    uint32_t moving_count;
    uint32_t patches, points;                  /* quality.patches; quality.patch_points */
    uint32_t codec;                            /* VIT_TRANSFER_* */
    uint32_t receiver_rays;                    /* quality.receiver_rays */
    uint32_t reflections;                      /* between light and receiver, at most, or TRANSFER_CONVERGED */
    unsigned threads;                          /* 0: all cores; changes no byte */
    void (*progress)(void *user, double done); /* may be NULL */
    void *user;
} live_input;

/* What need not be kept, or computed, as no view sample asks for it. */
typedef struct live_saving {
    uint32_t receivers, words;  /* that there were, */
    uint32_t kept;              /* receivers that are looked up in some frame */
    double looked_up, gathered; /* receivers, words in a frame, mean */
    uint32_t patches;           /* that these see */
} live_saving;

typedef struct live {
    vit_patch *patches;      /* section PATC */
    vit_patch_point *points; /* section PPNT; a multiple of 16 */
    vit_gather_row *rows;    /* section GROW: a receiver */
    vit_u32 *words;          /* section GATH */
    vit_u32 *looked;         /* section LOOK; at first one set for all frames, of all receivers */
    coded transfer;          /* section XFER; empty with one reflection */
    uint32_t patch_count, point_count, row_count, word_count;
    uint32_t each;          /* points of a patch, on average, at most: what was asked for, or what there is room for */
    uint32_t looked_frames; /* that share a set */
    live_saving saving;     /* by live_keep() */
    double unequal;         /* form_factors.unequal */
    double spectral[3];     /* transfer_matrix.spectral */
} live;

/* VIT_FAILED: out of memory. VIT_BAD_INPUT: the matrix is too large, or all reflections are too many. On failure there is
 * nothing to free. */
vit_status live_find(const live_input *in, live *out, vit_text *why);
/* One set of all receivers for all `frames`: before it is known what they look up. VIT_FAILED: out of memory. */
vit_status live_look_at_all(live *l, uint32_t receiver_count, uint32_t frames, vit_text *why);
/* Keeps what frames look up: receivers, in the order that they had, with their rows and what still light gives them; cells get
 * their new numbers. `b` is good for packing alone after that: its receivers.receivers are the old ones. bits: frames x
 * receivers / 32 words, a bit a receiver. VIT_FAILED: out of memory. */
vit_status live_keep(live *l, struct baked *b, const vit_u32 *bits, uint32_t frames, vit_text *why);
void live_free(live *l);
/* Points that so many patches have room for on average, each: columns have 16 bits. */
uint32_t live_points_room(uint32_t patches);

#endif
