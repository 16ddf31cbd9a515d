/* Runs a program as a shell would: one line of words, with the environment that stands before the program. */
#ifndef VIT_TESTS_TOOL_RUN_H
#define VIT_TESTS_TOOL_RUN_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/types.h>
#include <sys/wait.h>
#include <unistd.h>

#define TOOL_BAKE VIT_BUILD_DIR "/vitrine-bake"
#define TOOL_PLAY VIT_BUILD_DIR "/vitrine-play"
#define TOOL_COST VIT_BUILD_DIR "/vitrine-cost"
#define TOOL_SIGNAL_AT VIT_BUILD_DIR "/tests/signal_at.so" /* for LD_PRELOAD: tests/preload/signal_at.c */

enum { TOOL_TEXT = 1 << 16, TOOL_WORDS = 48 };

/* A program that hangs is killed by its alarm; what works is through long before, on any machine that one would wait for. */
enum { TOOL_SECONDS = 7200 };

typedef struct tool_run {
    char line[1024];
    pid_t child;
    FILE *to_out, *to_err; /* of the child; files without a name */
    int code;              /* exit code; -1: killed by a signal */
    char out[TOOL_TEXT], err[TOOL_TEXT];
} tool_run;

/* In the child: never returns. `line` is split at spaces; words NAME=value before the program are its environment. */
static inline void tool_become(const tool_run *r) {
    char line[sizeof r->line];
    char *words[TOOL_WORDS + 1] = {NULL}, *rest = NULL;
    int count = 0;
    memcpy(line, r->line, sizeof line);
    for (char *word = strtok_r(line, " ", &rest); word && count < TOOL_WORDS; word = strtok_r(NULL, " ", &rest)) {
        char *equals = count == 0 ? strchr(word, '=') : NULL;
        if (equals) {
            *equals = '\0';
            (void)setenv(word, equals + 1, 1);
        } else
            words[count++] = word;
    }
    if (count > 0 && dup2(fileno(r->to_out), STDOUT_FILENO) >= 0 && dup2(fileno(r->to_err), STDERR_FILENO) >= 0) {
        (void)alarm(TOOL_SECONDS);
        (void)execvp(words[0], words);
    }
    _exit(127);
}

static inline void tool_begin(tool_run *r) {
    r->to_out = tmpfile();
    r->to_err = tmpfile();
    assert_non_null(r->to_out);
    assert_non_null(r->to_err);
    r->child = fork();
    assert_true(r->child >= 0);
    if (r->child == 0)
        tool_become(r);
}

/* What the file holds so far; the child may still write to it. */
static inline void tool_text(FILE *from, char text[TOOL_TEXT]) {
    const ssize_t got = pread(fileno(from), text, TOOL_TEXT - 1, 0);
    text[got > 0 ? got : 0] = '\0';
}

static inline void tool_end(tool_run *r) {
    int status;
    assert_int_equal(waitpid(r->child, &status, 0), r->child);
    r->code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    tool_text(r->to_out, r->out);
    tool_text(r->to_err, r->err);
    (void)fclose(r->to_out);
    (void)fclose(r->to_err);
}

static inline void tool_line(tool_run *r, const char *format, ...) __attribute__((format(printf, 2, 3)));
static inline void tool_line(tool_run *r, const char *format, ...) {
    va_list list;
    va_start(list, format);
    const int length = vsnprintf(r->line, sizeof r->line, format, list);
    va_end(list);
    assert_in_range(length, 1, sizeof r->line - 1);
}

#define tool(r, ...) (tool_line(r, __VA_ARGS__), tool_begin(r), tool_end(r))

/* A tool's error: its exit code, nothing on stdout, one line on stderr that begins with the tool's name and holds `says`. */
static inline void tool_refuses(tool_run *r, const char *name, int code, const char *says) {
    const char *feed = strchr(r->err, '\n');
    const size_t length = strlen(name);
    if (r->code != code || r->out[0] || !feed || feed[1] || strncmp(r->err, name, length) != 0 || r->err[length] != ':' ||
        !strstr(r->err, says))
        fail_msg("%s\nexit %d, want %d; stderr must be one line '%s: ...%s...'\nstderr: %s\nstdout: %s", r->line, r->code, code,
                 name, says, r->err, r->out);
}

/* A run that must go well. */
static inline void tool_succeeds(const tool_run *r) {
    if (r->code != 0)
        fail_msg("%s\nexit %d\nstderr: %s", r->line, r->code, r->err);
}

#endif
