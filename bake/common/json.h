/* json.c: numbers and text as JSON (RFC 8259) wants them. Text that is no UTF-8 is mended with U+FFFD. */
#ifndef VIT_BAKE_JSON_H
#define VIT_BAKE_JSON_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

/* Fewest digits that read back as `value`; `otherwise`: not finite. */
void text_number(FILE *to, double value, const char *otherwise);
void text_json(FILE *to, const char *text); /* with its quotes; safe inside <script> as well */

/* ---- for other languages' text ---- */
/* Bytes of the UTF-8 character that begins here (RFC 3629, without its overlong forms and surrogates); 0: none does. */
uint32_t text_character(const char *text);
/* One character, mended; returns where the next begins. */
const char *text_copy_character(FILE *to, const char *text);
bool text_is_control(char c);

#endif
