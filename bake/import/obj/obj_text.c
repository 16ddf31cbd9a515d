/* Lines and words. A line that ends in a backslash goes on in the next. */
#include "import/obj/obj_file.h"
#include <string.h>
#include <strings.h>

static bool is_blank(char c) {
    return c == ' ' || (c >= '\t' && c <= '\r');
}

/* A backslash at the end of a line. */
static bool continues(obj_text text) {
    const char *next = text.at + 1;
    if (*text.at != '\\')
        return false;
    return next == text.end || *next == '\n' || *next == '\r';
}

obj_lines obj_lines_of(const import_bytes *bytes) {
    obj_lines lines = {.newline = '\n', .next_number = 1};
    if (!bytes->at)
        return lines;
    lines.rest = (obj_text){(const char *)bytes->at, (const char *)bytes->at + bytes->size};
    if (!memchr(bytes->at, '\n', bytes->size))
        lines.newline = '\r';
    if (bytes->size >= 3 && memcmp(bytes->at, "\xef\xbb\xbf", 3) == 0)
        lines.rest.at += 3;
    return lines;
}

/* The next end of a line before `end`. */
static const char *end_of_line(const obj_lines *lines, const char *from) {
    const char *at = memchr(from, lines->newline, (size_t)(lines->rest.end - from));
    return at ? at : lines->rest.end;
}

static bool goes_on(const obj_lines *lines, const char *end) {
    const char *last = end;
    if (last > lines->rest.at && last[-1] == '\r')
        last--;
    return end < lines->rest.end && last > lines->rest.at && last[-1] == '\\';
}

bool obj_next_line(obj_lines *lines, obj_text *line) {
    if (lines->rest.at == lines->rest.end)
        return false;
    const char *end = end_of_line(lines, lines->rest.at);
    lines->number = lines->next_number++;
    while (goes_on(lines, end)) {
        end = end_of_line(lines, end + 1);
        lines->next_number++;
    }
    *line = (obj_text){lines->rest.at, end};
    lines->rest.at = end < lines->rest.end ? end + 1 : end;
    return true;
}

static void skip_blanks(obj_text *line) {
    while (line->at < line->end && (is_blank(*line->at) || continues(*line)))
        line->at++;
}

static bool is_end(obj_text line) {
    return line.at == line.end || is_blank(*line.at) || continues(line);
}

obj_text obj_word(obj_text *line) {
    skip_blanks(line);
    obj_text word = {line->at, line->at};
    if (line->at < line->end && *line->at == '#')
        line->at = line->end;
    else
        while (!is_end(*line))
            line->at++;
    word.end = line->at;
    if (word.at < word.end && *word.at == '#')
        word.end = word.at;
    return word;
}

obj_text obj_rest(obj_text line) {
    skip_blanks(&line);
    while (line.end > line.at && is_blank(line.end[-1]))
        line.end--;
    return line;
}

bool obj_is(obj_text text, const char *word) {
    const size_t size = (size_t)(text.end - text.at);
    return size == strlen(word) && strncasecmp(text.at, word, size) == 0;
}

bool obj_number(obj_text *line, float *out) {
    double value;
    skip_blanks(line);
    const char *end = import_number(line->at, line->end, true, &value);
    if (!end || !is_end((obj_text){end, line->end}))
        return false;
    line->at = end;
    *out = (float)value;
    return true;
}
