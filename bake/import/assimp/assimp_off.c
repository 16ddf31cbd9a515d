/* OFF: whether it has colours. Assimp leaves aside those of faces without a word, and takes those of vertices, 0 to 1 or 0 to
 * 255, all for the former. */
#include "import/assimp/assimp_scene.h"
#include <ctype.h>

typedef struct off_text {
    const char *at, *end;
} off_text;

/* The next line that has words, from its first on; at its end if there is none. */
static void next_line(off_text *t) {
    while (t->at < t->end && (isspace((unsigned char)*t->at) || *t->at == '#'))
        if (*t->at++ == '#')
            while (t->at < t->end && *t->at != '\n')
                t->at++;
}

/* The next number of this line; false: there is none. */
static bool next_number(off_text *t, double *out) {
    while (t->at < t->end && (*t->at == ' ' || *t->at == '\t' || *t->at == '\r'))
        t->at++;
    const char *behind = t->at < t->end ? import_number(t->at, t->end, false, out) : NULL;
    t->at = behind ? behind : t->at;
    return behind != NULL;
}

static void end_line(off_text *t) {
    while (t->at < t->end && *t->at != '\n')
        t->at++;
}

void assimp_read_off(assimp_scene *a, const char *text, size_t size) {
    off_text t = {text, text + size};
    double vertices = 0.0, faces = 0.0, corners, value;
    next_line(&t);
    for (; t.at < t.end &&
           (isalpha((unsigned char)*t.at) || (*t.at == '4' && t.end - t.at > 1 && isalpha((unsigned char)t.at[1])));
         t.at++)
        a->off_colors = a->off_colors || *t.at == 'C';
    next_line(&t);
    if (!next_number(&t, &vertices) || !next_number(&t, &faces))
        return;
    end_line(&t);
    for (double i = 0.0; i < vertices && t.at < t.end; i++) {
        next_line(&t);
        end_line(&t);
    }
    for (double i = 0.0; i < faces && t.at < t.end && !a->off_colors; i++) {
        next_line(&t);
        if (!next_number(&t, &corners))
            return;
        while (corners > 0.0 && next_number(&t, &value))
            corners--;
        a->off_colors = next_number(&t, &value);
        end_line(&t);
    }
}
