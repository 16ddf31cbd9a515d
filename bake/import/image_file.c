#include "import/image_file.h"
#include "common/file_trouble.h"
#include <stdio.h>
#include <stdlib.h>

uint8_t *image_file_read(const char *path, int *size) {
    FILE *file = file_trouble(path) ? NULL : fopen(path, "rb"); /* a pipe is not waited for */
    uint8_t *bytes = NULL;
    long end = -1;
    if (file && fseek(file, 0, SEEK_END) == 0 && (end = ftell(file)) > 0 && end <= IMAGE_FILE_MOST &&
        fseek(file, 0, SEEK_SET) == 0)
        bytes = malloc((size_t)end);
    if (bytes && fread(bytes, 1, (size_t)end, file) != (size_t)end) {
        free(bytes);
        bytes = NULL;
    }
    if (file)
        (void)fclose(file);
    *size = (int)end;
    return bytes;
}
