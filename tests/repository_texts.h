/* The repository's files as tests read them: C's comments alone, line ends as blanks. */
#ifndef VIT_TESTS_REPOSITORY_TEXTS_H
#define VIT_TESTS_REPOSITORY_TEXTS_H

#include "test_folder.h"
#include <dirent.h>
#include <stdbool.h>

#define MOST_FILES 2048u

typedef struct file {
    char path[256];
    char *text;    /* line ends and comment marks are blanks */
    char *comment; /* the same but for what is no comment: 0x01 */
    char *raw;
} file;

typedef struct library {
    file files[MOST_FILES];
    size_t count;
    unsigned faults;
    char last[512]; /* the last fault */
    bool quiet;
} library;

static inline bool ends_with(const char *path, const char *ending) {
    const size_t n = strlen(path), e = strlen(ending);
    return n >= e && strcmp(path + n - e, ending) == 0;
}

static inline bool is_code(const char *path) {
    return ends_with(path, ".c") || ends_with(path, ".h") || ends_with(path, ".cl") || ends_with(path, ".clh");
}

static inline bool is_text(const char *path) {
    return is_code(path) || ends_with(path, ".md") || ends_with(path, ".mk") || ends_with(path, ".sh") ||
           ends_with(path, ".cfg") || ends_with(path, "Makefile");
}

/* Blanks what is between comments with 0x01. */
static inline void keep_comments(char *s) {
    while (*s) {
        if (s[0] == '/' && s[1] == '*') {
            for (s += 2; *s && !(s[0] == '*' && s[1] == '/');)
                s++;
            for (int i = 0; i < 2 && *s; i++)
                *s++ = 1;
        } else if (s[0] == '/' && s[1] == '/') {
            while (*s && *s != '\n')
                s++;
        } else if (*s == '"' || *s == '\'') {
            const char quote = *s;
            for (*s++ = 1; *s && *s != quote && *s != '\n'; *s++ = 1)
                if (*s == '\\' && s[1] && s[1] != '\n')
                    *s++ = 1;
            if (*s == quote)
                *s++ = 1;
        } else
            *s++ = 1;
    }
}

static inline void blank_line_ends(char *s) {
    for (; *s; s++) {
        if (*s != '\n')
            continue;
        *s = ' ';
        char *t = s + 1;
        while (*t == ' ' || *t == '\t')
            *t++ = ' ';
        if ((*t == '*' && t[1] != '/') || *t == '#')
            *t = ' ';
    }
}

static inline void add(library *l, const char *path, const char *text) {
    assert_true(l->count < MOST_FILES && strlen(path) < sizeof l->files[0].path);
    file *f = l->files + l->count++;
    snprintf(f->path, sizeof f->path, "%s", path);
    f->text = f->comment = f->raw = NULL;
    if (!text)
        return;
    f->raw = strdup(text);
    f->text = strdup(text);
    f->comment = strdup(text);
    assert_true(f->raw && f->text && f->comment);
    keep_comments(f->comment);
    blank_line_ends(f->comment);
    blank_line_ends(f->text);
}

static inline void add_from_disc(library *l, const char *path) {
    char *text = is_text(path) ? read_file(path, NULL) : NULL;
    add(l, path, text);
    free(text);
}

static inline void walk(library *l, const char *folder) {
    DIR *d = opendir(folder);
    assert_non_null(d);
    for (struct dirent *e; (e = readdir(d)) != NULL;) {
        char path[256];
        struct stat s;
        if (e->d_name[0] == '.')
            continue;
        assert_true((size_t)snprintf(path, sizeof path, "%s/%s", folder, e->d_name) < sizeof path);
        if (stat(path, &s) != 0)
            continue; /* of a test that runs at the same time */
        if (S_ISDIR(s.st_mode))
            walk(l, path);
        else if (S_ISREG(s.st_mode))
            add_from_disc(l, path);
    }
    closedir(d);
}

static inline void read_repository(library *l) {
    static const char *const folders[] = {"bake", "kernels", "runtime", "include", "tests", "findings"};
    for (size_t i = 0; i < sizeof folders / sizeof *folders; i++)
        walk(l, folders[i]);
    add_from_disc(l, "README.md");
    add_from_disc(l, "Makefile");
}

static inline void release(library *l) {
    for (size_t i = 0; i < l->count; i++) {
        free(l->files[i].raw);
        free(l->files[i].text);
        free(l->files[i].comment);
    }
    free(l);
}

static inline const file *find_exactly(const library *l, const char *path) {
    for (size_t i = 0; i < l->count; i++)
        if (strcmp(l->files[i].path, path) == 0)
            return l->files + i;
    return NULL;
}

/* A file by its path from the folder of the file that cites it, or from the root. */
static inline const file *find_cited(const library *l, const file *from, const char *name, int length) {
    char path[512];
    const char *slash = strrchr(from->path, '/');
    snprintf(path, sizeof path, "%.*s%.*s", slash ? (int)(slash - from->path) + 1 : 0, from->path, length, name);
    const file *found = find_exactly(l, path);
    snprintf(path, sizeof path, "%.*s", length, name);
    return found ? found : find_exactly(l, path);
}

#endif
