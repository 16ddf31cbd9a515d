/* state.c: an unfinished reference: sums a pixel over the rounds so far. state_cache.c keeps it in a file. */
#ifndef VIT_COST_STATE_H
#define VIT_COST_STATE_H

#include "reference/paths.h"

/* Sums over the paths of each sequence. */
typedef struct pixel_sums {
    double direct[3]; /* not a sum: what view samples see without paths */
    path_sums paths[REFERENCE_SEQUENCES];
} pixel_sums;

typedef struct reference_state {
    uint64_t key; /* of the input */
    uint32_t width, height, pixels, rounds;
    double seconds;
    uint64_t rays;
    pixel_sums *sums;
} reference_state;

vit_status state_make(uint32_t width, uint32_t height, reference_state *out, vit_text *why);
void state_free(reference_state *s);
/* One more round's sums, those of all pixels; view samples are those of any round. */
void state_add(reference_state *s, const pixel_sums *round);
/* NMSE of the standard error of direct + limited; 0 for a black picture, infinite before the first round. */
double state_error(const reference_state *s);
vit_status state_finish(const reference_state *s, reference *out, vit_text *why);

/* state_cache.c: one file a key in a folder, `KEY.reference`: a header, then the sums, in this machine's byte order.
 * What the picture depends on: XXH3-64 of the sections' records and of the settings; not of `target` and `max_samples`. */
uint64_t state_key(const reference_input *in);
/* Makes the folder if there is none. VIT_FAILED: it cannot be written. */
vit_status state_folder(const char *folder, vit_text *why);
/* Takes the sums over from the file of s->key; leaves `s` as it is if there is none, or it is damaged or of something else. */
void state_load(reference_state *s, const char *folder);
/* Writes the file whole, under another name at first. */
vit_status state_save(const reference_state *s, const char *folder, vit_text *why);

#endif
