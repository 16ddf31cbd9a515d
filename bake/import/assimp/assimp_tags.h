/* assimp_tags.c: tags and attributes in the text of XML files, before Assimp sees it. Private to its reader. */
#ifndef VIT_BAKE_ASSIMP_TAGS_H
#define VIT_BAKE_ASSIMP_TAGS_H

#include <stdbool.h>

typedef struct tag_span {
    char *at, *end;
} tag_span;

bool tag_blank(char c);
bool tag_begins(tag_span s, const char *with);
/* The next tag of that name in `in`, or of any but comments if it is NULL, from its "<" to its ">". False: there is none. */
bool tag_find(tag_span in, const char *name, tag_span *out);
/* Behind the element of that name that the tag begins. */
char *tag_behind(tag_span tag, const char *name, char *end);
/* The value of the tag's attribute. */
bool tag_value(tag_span tag, const char *name, tag_span *out);
/* The whole value but for blanks is a positive number, from `from` on. */
bool tag_length(tag_span value, char **from, double *metres);

#endif
