/* What COLLADA says of its cameras' fields of view, which Assimp does not hand on. Its cameras are called as the nodes are, by
 * their ids. */
#include "import/assimp/assimp_scene.h"
#include "common/pi.h"
#include "common/strict_math.h"
#include <ctype.h>
#include <stdio.h>
#include <string.h>

enum { WORD = 256 }; /* bytes of an id */

typedef struct span {
    const char *at, *end;
} span;

static bool starts(span text, const char *at, const char *word) {
    return (size_t)(text.end - at) >= strlen(word) && memcmp(at, word, strlen(word)) == 0;
}

/* From the first `word` on; at: NULL if there is none. */
static span find(span text, const char *word) {
    for (; text.at && text.at < text.end; text.at++) {
        text.at = memchr(text.at, word[0], (size_t)(text.end - text.at));
        if (!text.at || starts(text, text.at, word))
            return text;
    }
    return (span){NULL, NULL};
}

/* The value of an attribute of the tag that begins at tag.at; "" if it is not there. */
static void attribute(span tag, const char *name, char out[WORD]) {
    const char *close = memchr(tag.at, '>', (size_t)(tag.end - tag.at));
    const size_t length = strlen(name);
    out[0] = '\0';
    for (span rest = find((span){tag.at, close ? close : tag.end}, name); rest.at;
         rest = find((span){rest.at + 1, rest.end}, name)) {
        const char *c = rest.at + length;
        if (!isspace((unsigned char)rest.at[-1]) || rest.end - c < 3 || c[0] != '=' || (c[1] != '"' && c[1] != '\''))
            continue;
        const char *last = memchr(c + 2, c[1], (size_t)(rest.end - c - 2));
        if (last && last - c - 2 < WORD)
            (void)snprintf(out, WORD, "%.*s", (int)(last - c - 2), c + 2);
        return;
    }
}

/* The <node> that holds what stands at `at`; at: NULL if none does. */
static span node_of(span text, const char *at) {
    int closed = 0;
    while (at > text.at) {
        at--;
        if (*at != '<')
            continue;
        if (starts(text, at, "</node>"))
            closed++;
        else if (starts(text, at, "<node") && text.end - at > 5 && (isspace((unsigned char)at[5]) || at[5] == '>')) {
            const char *close = memchr(at, '>', (size_t)(text.end - at));
            if (close && close[-1] != '/' && closed-- == 0)
                return (span){at, text.end};
        }
    }
    return (span){NULL, NULL};
}

/* What stands between the tags of the camera of this id. */
static span camera_of(span text, const char *id) {
    char word[WORD];
    for (span c = find(text, "<camera "); c.at; c = find((span){c.at + 1, c.end}, "<camera ")) {
        attribute(c, "id", word);
        const span close = find(c, "</camera>");
        if (strcmp(word, id) == 0)
            return close.at ? (span){c.at, close.at} : c;
    }
    return (span){NULL, NULL};
}

/* The number in the first element of that name; 0: none. */
static double element(span camera, const char *tag) {
    const span from = find(camera, tag);
    const char *at = from.at ? memchr(from.at, '>', (size_t)(from.end - from.at)) : NULL;
    double value = 0.0;
    if (!at)
        return 0.0;
    for (at++; at < from.end && isspace((unsigned char)*at);)
        at++;
    return import_number(at, from.end, false, &value) && value > 0.0 && value < 180.0 ? value : 0.0;
}

static double vertical_fov(span camera) {
    const double y = element(camera, "<yfov"), x = element(camera, "<xfov"), aspect = element(camera, "<aspect_ratio");
    if (y > 0.0 || x == 0.0 || aspect == 0.0)
        return y > 0.0 ? y : x;
    return 2.0 * strict_atan(strict_tan(0.5 * x * PI / 180.0) / aspect) * 180.0 / PI;
}

double assimp_collada_fov(importer *im, const char *node, bool *orthographic) {
    import_bytes file;
    double fov = 0.0;
    *orthographic = false;
    if (!import_map(im, im->file, &file))
        return 0.0;
    const span text = {(const char *)file.at, (const char *)file.at + file.size};
    for (span at = find(text, "<instance_camera"); at.at; at = find((span){at.at + 1, at.end}, "<instance_camera")) {
        char word[WORD] = "", url[WORD];
        const span holds = node_of(text, at.at);
        if (holds.at)
            attribute(holds, "id", word);
        if (!word[0] || strcmp(word, node) != 0)
            continue;
        attribute(at, "url", url);
        const span camera = camera_of(text, url + (url[0] == '#'));
        *orthographic = find(camera, "<orthographic").at != NULL;
        fov = *orthographic || !camera.at ? 0.0 : vertical_fov(camera);
        break;
    }
    import_drop_bytes(&file);
    return fov;
}
