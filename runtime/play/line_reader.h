/* line_reader.c: the lines of a small text file that may hold anything: work budgets and golden hashes. */
#ifndef VIT_PLAY_LINE_READER_H
#define VIT_PLAY_LINE_READER_H

#include "vitrine.h"
#include <stdbool.h>
#include <stdio.h>

#define LINE_BYTES 256

typedef struct line_reader {
    FILE *file;
    const char *path;
    uint32_t line;         /* that it is at, from 1 */
    char text[LINE_BYTES]; /* without its line feed */
} line_reader;

/* VIT_BAD_INPUT: it cannot be opened; there is nothing to close then. */
vit_status line_open(line_reader *r, const char *path, vit_text *why);
void line_close(line_reader *r);

/* VIT_BAD_INPUT with the file's name and line. */
vit_status line_bad(const line_reader *r, vit_text *why, const char *cause);
/* The next line that does not begin with '#'. VIT_BAD_INPUT: there is none, or it is too long or has no end. */
vit_status line_next(line_reader *r, vit_text *why);
/* The line 'end' must come next, or be the line that it is at, and nothing after it. VIT_BAD_INPUT. */
vit_status line_end(line_reader *r, vit_text *why);

/* A number of digits only, up to the end of `word`. */
bool line_number(const char *word, uint64_t most, uint64_t *out);
/* Splits at single spaces into exactly `count` words that are neither empty nor of `room` characters and more. */
bool line_split(char *text, char **words, uint32_t count, size_t room);

#endif
