/* report_gnuplot.c: gnuplot reads its script from a file without a name and draws into another: nothing to clean up. */
#include "report/report_parts.h"
#include "common/fail.h"

#include <ctype.h>
#include <errno.h>
#include <spawn.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

extern char **environ;

typedef struct gnuplot_files {
    FILE *script, *drawing, *errors;
} gnuplot_files;

static void close_files(gnuplot_files *f) {
    FILE *files[] = {f->script, f->drawing, f->errors};
    for (size_t i = 0; i < sizeof files / sizeof files[0]; i++)
        if (files[i])
            (void)fclose(files[i]);
}

static bool open_files(gnuplot_files *f, const report_drawing *d, const char *script) {
    *f = (gnuplot_files){tmpfile(), tmpfile(), tmpfile()};
    if (!f->script || !f->drawing || !f->errors)
        return false;
    (void)fprintf(f->script, "set encoding utf8\nset term svg noenhanced dynamic size %u,%u font 'sans-serif,12'\n%s", d->width,
                  d->height, script);
    return fflush(f->script) == 0 && !ferror(f->script) && lseek(fileno(f->script), 0, SEEK_SET) == 0;
}

/* Waits for gnuplot -d (without the user's start-up files). Returns 0 or the errno for which it could not start. */
static int run(gnuplot_files *f, int *code) {
    char *const arguments[] = {"gnuplot", "-d", NULL};
    posix_spawn_file_actions_t actions;
    int error = posix_spawn_file_actions_init(&actions);
    if (error != 0)
        return error;
    FILE *files[] = {f->script, f->drawing, f->errors};
    for (int i = 0; i < 3 && error == 0; i++)
        error = posix_spawn_file_actions_adddup2(&actions, fileno(files[i]), i);
    pid_t child;
    if (error == 0)
        error = posix_spawnp(&child, "gnuplot", &actions, NULL, arguments, environ);
    (void)posix_spawn_file_actions_destroy(&actions);
    if (error != 0)
        return error;
    int status;
    while (waitpid(child, &status, 0) < 0)
        if (errno != EINTR)
            return errno;
    *code = WIFEXITED(status) ? WEXITSTATUS(status) : 128;
    return 0;
}

/* The whole file from its start, ended with a zero; the caller frees it. */
static char *slurp(FILE *from) {
    const off_t size = lseek(fileno(from), 0, SEEK_END);
    char *text = size < 0 ? NULL : malloc((size_t)size + 1);
    if (text)
        text[pread(fileno(from), text, (size_t)size, 0) == size ? size : 0] = '\0';
    return text;
}

/* The light page's --cN, from the style sheet, without its space and semicolon. */
static void print_light_colour(int n, FILE *to) {
    char name[16];
    const int length = snprintf(name, sizeof name, "--c%d:", n);
    const char *at = strstr(report_css, name);
    if (at)
        (void)fprintf(to, "%.*s", (int)strcspn(at + length + 1, ";"), at + length + 1);
}

/* "rgb( 1, 1, N)" becomes "var(--cN)", or the colour itself. Returns what follows, NULL if this is no such colour. */
static const char *copy_colour(const char *text, const report_drawing *d, FILE *to) {
    int red, green, blue, length = 0;
    /* NOLINTNEXTLINE(cert-err34-c): nine digits do not overflow. */
    if (sscanf(text, "rgb( %9d , %9d , %9d )%n", &red, &green, &blue, &length) != 3 || length == 0 || red != 1 || green != 1)
        return NULL;
    if (d->alone)
        print_light_colour(blue, to);
    else
        (void)fprintf(to, "var(--c%d)", blue);
    return text + length;
}

/* gnuplot's names are the same in every drawing, and its titles would pop up over the lines. */
static const char *copy_name(const char *text, const char *id, FILE *to) {
    static const char *const names[] = {"'gp", "'#gp", "\"gnuplot_", "'textbox'", "'greybox'"};
    if (strncmp(text, "<title>", 7) == 0) {
        const char *end = strstr(text, "</title>");
        return end ? end + 8 : NULL;
    }
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++) {
        const size_t length = strlen(names[i]), mark = names[i][1] == '#' ? 2 : 1;
        if (strncmp(text, names[i], length) != 0)
            continue;
        (void)fprintf(to, "%.*s%s-%s", (int)mark, names[i], id, names[i] + mark);
        return text + length;
    }
    return NULL;
}

static bool copy_drawing(const char *svg, const report_drawing *d, FILE *to) {
    const char *at = strstr(svg, "<g id=\"gnuplot_canvas\""), *end = strstr(svg, "</svg>");
    if (!at || !end)
        return false;
    if (d->alone)
        (void)fprintf(to, "<?xml version=\"1.0\" encoding=\"utf-8\"?>\n");
    (void)fprintf(to, "<svg id=\"%s\" class=\"plot\" viewBox=\"0 0 %u %u\" role=\"img\" ", d->id, d->width, d->height);
    if (d->alone)
        (void)fprintf(to, "xmlns=\"http://www.w3.org/2000/svg\" width=\"%u\" height=\"%u\" style=\"background: white\" ",
                      d->width, d->height);
    (void)fputs("aria-label=\"", to);
    text_html(to, d->alt);
    (void)fputs("\" xmlns:xlink=\"http://www.w3.org/1999/xlink\">\n", to);
    while (at < end) {
        const char *next = *at == 'r'                                ? copy_colour(at, d, to)
                           : *at == '<' || *at == '\'' || *at == '"' ? copy_name(at, d->id, to)
                                                                     : NULL;
        if (next)
            at = next;
        else
            (void)fputc(*at++, to);
    }
    (void)fputs("</svg>\n", to);
    return true;
}

/* gnuplot shows the line, points at the place and then says what is wrong: the last line with text. */
static vit_status fail_script(vit_text *why, const report_drawing *d, int code, char *errors) {
    char *last = "it drew nothing", *rest = NULL;
    for (char *line = strtok_r(errors, "\n", &rest); line; line = strtok_r(NULL, "\n", &rest)) {
        while (isspace((unsigned char)*line))
            line++;
        if (*line)
            last = line;
    }
    return bake_fail(why, VIT_FAILED, "gnuplot: plot '%s': exit code %d: %.300s", d->id, code, last);
}

vit_status report_gnuplot(const report_drawing *d, const char *script, FILE *to, vit_text *why) {
    gnuplot_files files;
    int code = 0;
    if (!open_files(&files, d, script)) {
        close_files(&files);
        return bake_fail(why, VIT_FAILED, "gnuplot: plot '%s': cannot write a temporary file: %s", d->id, strerror(errno));
    }
    const int error = run(&files, &code);
    if (error != 0) {
        close_files(&files);
        return error == ENOENT
                   ? bake_fail(why, VIT_FAILED, "gnuplot: not found: the report's plots need it (Debian: gnuplot-nox)")
                   : bake_fail(why, VIT_FAILED, "gnuplot: cannot run it: %s", strerror(error));
    }
    char *svg = slurp(files.drawing), *errors = slurp(files.errors);
    vit_status status = VIT_OK;
    if (!svg || !errors)
        status = bake_fail(why, VIT_FAILED, "gnuplot: plot '%s': out of memory", d->id);
    else if (code != 0 || !copy_drawing(svg, d, to))
        status = fail_script(why, d, code, errors);
    free(svg);
    free(errors);
    close_files(&files);
    return status;
}
