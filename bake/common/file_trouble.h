/* file_trouble.c: why a file cannot be read, in words that say whose mistake it is. */
#ifndef VIT_BAKE_FILE_TROUBLE_H
#define VIT_BAKE_FILE_TROUBLE_H

/* "is not there", "is a folder", ...; NULL: it is a plain file that can be read. */
const char *file_trouble(const char *path);

#endif
