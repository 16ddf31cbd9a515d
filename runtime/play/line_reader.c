#include "line_reader.h"
#include "failure.h"
#include <errno.h>
#include <stdlib.h>
#include <string.h>

vit_status line_open(line_reader *r, const char *path, vit_text *why) {
    *r = (line_reader){.path = path, .file = fopen(path, "rb")};
    return r->file != NULL ? VIT_OK : play_fail(why, VIT_BAD_INPUT, "%s: %s", path, strerror(errno));
}

void line_close(line_reader *r) {
    (void)fclose(r->file);
}

vit_status line_bad(const line_reader *r, vit_text *why, const char *cause) {
    return play_fail(why, VIT_BAD_INPUT, "%s:%u: %s", r->path, r->line, cause);
}

vit_status line_next(line_reader *r, vit_text *why) {
    do {
        r->line++;
        if (fgets(r->text, sizeof r->text, r->file) == NULL)
            return line_bad(r, why, ferror(r->file) ? "cannot be read" : "the file ends before the line 'end'");
        char *feed = strchr(r->text, '\n');
        if (feed == NULL)
            return line_bad(
                r, why, strlen(r->text) + 1 == sizeof r->text ? "the line is too long" : "the line has no end or a zero byte");
        *feed = '\0';
    } while (r->text[0] == '#');
    return VIT_OK;
}

vit_status line_end(line_reader *r, vit_text *why) {
    vit_status status = strcmp(r->text, "end") == 0 ? VIT_OK : line_next(r, why);
    if (status == VIT_OK && strcmp(r->text, "end") != 0)
        return line_bad(r, why, "the line 'end' must come here");
    r->line++;
    if (status == VIT_OK && fgetc(r->file) != EOF)
        return line_bad(r, why, "there is more after the line 'end'");
    return status;
}

bool line_number(const char *word, uint64_t most, uint64_t *out) {
    char *end;
    if (word[0] == '\0' || strspn(word, "0123456789") != strlen(word))
        return false;
    errno = 0;
    *out = strtoull(word, &end, 10);
    return errno == 0 && *out <= most;
}

bool line_split(char *text, char **words, uint32_t count, size_t room) {
    for (uint32_t i = 0; i < count; i++) {
        char *space = strchr(text, ' ');
        words[i] = text;
        if ((space == NULL) != (i + 1 == count))
            return false;
        if (space != NULL)
            *space = '\0';
        if (text[0] == '\0' || strlen(text) >= room)
            return false;
        text = space != NULL ? space + 1 : text;
    }
    return true;
}
