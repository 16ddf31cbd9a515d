#include "cost/rewrite.h"
#include "common/fail.h"
#include "pack/pack_write.h"
#include "scene/scene.h"
#include <ctype.h>
#include <errno.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#define MOST_BYTES ((size_t)16 << 20) /* as scene.c */

/* Past a comment or a string that begins at p; p itself if none does. libconfig: #, // and C comments, "..." with \ escapes. */
static const char *past_quiet(const char *p) {
    if (*p == '#' || (p[0] == '/' && p[1] == '/'))
        return p + strcspn(p, "\n");
    if (p[0] == '/' && p[1] == '*') {
        const char *end = strstr(p + 2, "*/");
        return end ? end + 2 : p + strlen(p);
    }
    if (*p == '"') {
        for (p++; *p && *p != '"'; p++)
            p += *p == '\\' && p[1] != '\0';
        return *p ? p + 1 : p;
    }
    return p;
}

static bool in_name(char c) {
    return isalnum((unsigned char)c) || c == '_' || c == '-' || c == '*';
}

/* Past space and comments. */
static const char *past_space(const char *p) {
    for (;;) {
        const char *next = *p != '"' ? past_quiet(p) : p;
        while (isspace((unsigned char)*next))
            next++;
        if (next == p)
            return p;
        p = next;
    }
}

/* The brace that opens the group whose name ends before p, or the quote of a word in its place ("auto"); NULL: p is followed by
 * something else. */
static const char *opening(const char *p) {
    p = past_space(p);
    if (*p != ':' && *p != '=')
        return NULL;
    p = past_space(p + 1);
    return *p == '{' || *p == '"' ? p : NULL;
}

/* The opening brace of the group called `quality` at depth 0; NULL if there is none. */
static const char *find_quality(const char *text) {
    int depth = 0;
    for (const char *p = text; *p;) {
        const char *next = past_quiet(p);
        if (next != p) {
            p = next;
            continue;
        }
        depth += strchr("{([", *p) != NULL;
        depth -= strchr("})]", *p) != NULL;
        if (!in_name(*p)) {
            p++;
            continue;
        }
        for (next = p; in_name(*next);)
            next++;
        const char *brace = depth == 0 && next - p == 7 && strncmp(p, "quality", 7) == 0 ? opening(next) : NULL;
        if (brace)
            return brace;
        p = next;
    }
    return NULL;
}

static const char *closing(const char *brace) {
    int depth = 0;
    if (*brace == '"')
        return past_quiet(brace);
    for (const char *p = brace; *p;) {
        const char *next = past_quiet(p);
        if (next != p) {
            p = next;
            continue;
        }
        depth += *p == '{';
        depth -= *p == '}';
        if (depth == 0)
            return p;
        p++;
    }
    return NULL;
}

char *rewrite_text(const char *text, const char *settings) {
    const size_t length = strlen(text), room = length + strlen(settings) + 64;
    const char *open = find_quality(text), *close = open ? closing(open) : NULL;
    char *out = open && !close ? NULL : malloc(room);
    if (out && open)
        (void)snprintf(out, room, "%.*s{ %s%s%s", (int)(open - text), text, settings, *open == '"' ? "}" : "", close);
    else if (out)
        (void)snprintf(out, room, "%s%squality: { %s};\n", text, length > 0 && text[length - 1] != '\n' ? "\n" : "", settings);
    return out;
}

/* The whole file as a string; NULL: why. */
static char *read_file(const char *path, vit_text *why) {
    FILE *f = fopen(path, "rb");
    char *text = f ? malloc(MOST_BYTES + 2) : NULL;
    const size_t got = text ? fread(text, 1, MOST_BYTES + 1, f) : 0;
    const bool fine = text && !ferror(f) && got <= MOST_BYTES && !memchr(text, '\0', got);
    if (!fine) {
        (void)bake_fail(why, VIT_BAD_INPUT, "%.300s: %s", path,
                        !f     ? strerror(errno)
                        : text ? "is no scene file"
                               : "out of memory");
        free(text);
        text = NULL;
    } else
        text[got] = '\0';
    if (f)
        (void)fclose(f);
    return text;
}

/* What was written must read back as the scene that it was, with the new block. */
static vit_status check(const char *path, const char *settings, vit_text *why) {
    scene s;
    char got[SCENE_QUALITY], want[SCENE_QUALITY];
    scene_quality q;
    vit_status status = scene_read(path, &s, why);
    if (status != VIT_OK)
        return status;
    q = s.quality;
    status = scene_quality_apply(settings, &q, why);
    scene_quality_text(&s.quality, got, sizeof got);
    scene_quality_text(&q, want, sizeof want);
    scene_free(&s);
    if (status == VIT_OK && strcmp(got, want) != 0) {
        status = bake_fail(why, VIT_BAD_INPUT, "%.300s: its quality block could not be found", path);
    }
    return status;
}

vit_status rewrite_file(const char *path, const char *settings, vit_text *why) {
    char aside[SCENE_PATH + 32];
    char *text = read_file(path, why);
    if (!text)
        return VIT_BAD_INPUT;
    char *changed = rewrite_text(text, settings);
    vit_status status;
    (void)snprintf(aside, sizeof aside, "%.*s.new-%ld", SCENE_PATH, path, (long)getpid());
    if (changed)
        status = pack_save(aside, changed, strlen(changed), why);
    else
        status = bake_fail(why, VIT_FAILED, "%.300s: out of memory, or its quality block does not end", path);
    if (status == VIT_OK) {
        status = check(aside, settings, why);
        if (status == VIT_OK && rename(aside, path) != 0) {
            status = bake_fail(why, VIT_FAILED, "%.300s: %s", path, strerror(errno));
        }
        if (status != VIT_OK)
            (void)unlink(aside);
    }
    free(changed);
    free(text);
    return status;
}

vit_status rewrite_check(const char *path, vit_text *why) {
    scene s;
    vit_status status = scene_read(path, &s, why);
    if (status != VIT_OK)
        return status;
    scene_free(&s);
    if (access(path, W_OK) == 0)
        return VIT_OK;
    return bake_fail(why, VIT_FAILED, "%.300s: %s", path, strerror(errno));
}
