/* option_text.c: words of a command line, as vitrine-bake and vitrine-cost read them. */
#ifndef VIT_BAKE_OPTION_TEXT_H
#define VIT_BAKE_OPTION_TEXT_H

#include <stdbool.h>
#include <stddef.h>

#define OPTION_NAME 32 /* bytes, with its end */

/* One option: "--name VALUE", "--name=VALUE" or "-o VALUE". */
typedef struct option_words {
    char name[OPTION_NAME]; /* without '=' and what follows; cut if it is longer than any name */
    const char *value;      /* NULL: there is none */
    bool joined;            /* by '=' */
} option_words;

/* `next` is the word behind `word`, or NULL. Another option ("--...") is no value unless joined by '='. */
option_words option_split(const char *word, const char *next);

/* Numbers are decimal and whole to their last character: no space, sign +, hexadecimal, infinity. False as well beyond the
 * bounds. */
bool option_whole(const char *text, long least, long most, long *out);
bool option_number(const char *text, double least, double most, double *out);
/* WIDTHxHEIGHT, up to 7680x4320. */
bool option_size(const char *text, int *width, int *height);

#endif
