/* A scene made by a test, baked and played by the real programs, its indirect light read back as linear floats. All files lie
 * in a folder of the test's own. Programs run as from a shell, so what is tested is what a user gets; on the device `host`,
 * which has the bits of all others (test_same_bits.c) and compiles nothing. */
#ifndef VIT_TESTS_SCENE_LAB_H
#define VIT_TESTS_SCENE_LAB_H

#include "test_folder.h"
#include "vitrine.h"
#include <fcntl.h>
#include <stdbool.h>
#include <sys/wait.h>

#define SCENE_LAB_FILES 16
#define SCENE_LAB_WORDS 40
#define SCENE_LAB_SECONDS 7200 /* a program that hangs is killed */

typedef struct scene_lab {
    char folder[TEST_FOLDER];
    char files[SCENE_LAB_FILES][96]; /* what scene_lab_close() removes */
    size_t file_count;
} scene_lab;

static inline void scene_lab_open(scene_lab *l) {
    *l = (scene_lab){.file_count = 0};
    folder_make_temporary(l->folder);
}

static inline void scene_lab_close(scene_lab *l) {
    for (size_t i = 0; i < l->file_count; i++)
        (void)unlink(l->files[i]);
    (void)rmdir(l->folder);
}

/* For a group of tests that share one. */
static inline int scene_lab_set_up(void **state) {
    static scene_lab lab;
    scene_lab_open(&lab);
    *state = &lab;
    return 0;
}

static inline int scene_lab_tear_down(void **state) {
    scene_lab_close(*state);
    return 0;
}

/* Path of a file in the folder. */
static inline const char *scene_lab_path(scene_lab *l, const char *name) {
    char path[96];
    path_join(path, sizeof path, l->folder, name);
    for (size_t i = 0; i < l->file_count; i++)
        if (strcmp(l->files[i], path) == 0)
            return l->files[i];
    assert_true(l->file_count < SCENE_LAB_FILES);
    return strcpy(l->files[l->file_count++], path);
}

static inline FILE *scene_lab_create(scene_lab *l, const char *name) {
    FILE *f = fopen(scene_lab_path(l, name), "w");
    assert_non_null(f);
    return f;
}

/* A closed box of half the edges `half` about (at, 0, at), without materials. */
static inline void scene_lab_write_room(scene_lab *l, const char *name, const double half[3], double at) {
    static const int side[6][4] = {{1, 2, 4, 3}, {5, 7, 8, 6}, {1, 5, 6, 2}, {3, 4, 8, 7}, {1, 3, 7, 5}, {2, 6, 8, 4}};
    FILE *f = scene_lab_create(l, name);
    for (int i = 0; i < 8; i++)
        (void)fprintf(f, "v %.17g %.17g %.17g\n", at + (i & 4 ? half[0] : -half[0]), i & 2 ? half[1] : -half[1],
                      at + (i & 1 ? half[2] : -half[2]));
    for (int i = 0; i < 6; i++)
        (void)fprintf(f, "f %d %d %d %d\n", side[i][0], side[i][1], side[i][2], side[i][3]);
    (void)fclose(f);
}

/* Runs a program of the build with the words of `line`, split at spaces; it must succeed. What it prints is shown only if not.
 */
static inline void scene_lab_run(scene_lab *l, const char *program, const char *line) {
    char path[256], copy[1024], *words[SCENE_LAB_WORDS + 2] = {path}, *rest = NULL;
    size_t count = 1;
    const char *out = scene_lab_path(l, "out.txt");
    (void)snprintf(path, sizeof path, "%s/%s", VIT_BUILD_DIR, program);
    assert_true(snprintf(copy, sizeof copy, "%s", line) < (int)sizeof copy);
    for (char *word = strtok_r(copy, " ", &rest); word != NULL; word = strtok_r(NULL, " ", &rest)) {
        assert_true(count <= SCENE_LAB_WORDS);
        words[count++] = word;
    }
    pid_t child = fork();
    assert_true(child >= 0);
    if (child == 0) {
        int to = open(out, O_WRONLY | O_CREAT | O_TRUNC, 0600);
        if (to >= 0 && dup2(to, STDOUT_FILENO) >= 0 && dup2(to, STDERR_FILENO) >= 0) {
            (void)alarm(SCENE_LAB_SECONDS);
            (void)execv(path, words);
        }
        _exit(127);
    }
    int status;
    assert_int_equal(waitpid(child, &status, 0), child);
    if (WIFEXITED(status) && WEXITSTATUS(status) == VIT_OK)
        return;
    char text[2048];
    read_into(out, text, sizeof text);
    fail_msg("%s %s\nexit %d\n%s", path, line, WIFEXITED(status) ? WEXITSTATUS(status) : -1, text);
}

/* Bakes `scene`, a file of the folder or a whole path, with more options; then scene_lab_said(). By photons, unless an option
 * says otherwise. */
static inline void scene_lab_bake(scene_lab *l, const char *scene, const char *options) {
    char line[1024];
    const char *pack = scene_lab_path(l, "scene.vit");
    (void)snprintf(line, sizeof line, "%s -o %s --quiet --no-check --device host --indirect photons %s",
                   scene[0] == '/' || strchr(scene, '/') ? scene : scene_lab_path(l, scene), pack, options);
    scene_lab_run(l, "vitrine-bake", line);
}

/* Did the program that ran last say this? */
static inline bool scene_lab_said(scene_lab *l, const char *text) {
    char said[16384];
    read_into(scene_lab_path(l, "out.txt"), said, sizeof said);
    return strstr(said, text) != NULL;
}

/* Plays what was baked: `pixels` takes the radiance of `view`, times exposure, of all frames, four floats a pixel. */
static inline void scene_lab_play(scene_lab *l, const char *view, float *pixels, size_t floats) {
    char line[1024];
    const char *pack = scene_lab_path(l, "scene.vit"), *raw = scene_lab_path(l, "frames.raw");
    (void)snprintf(line, sizeof line, "%s --view %s --format rgba32f --out raw:%s --quiet --device host", pack, view, raw);
    scene_lab_run(l, "vitrine-play", line);
    size_t size;
    void *bytes = read_file(raw, &size);
    assert_int_equal(size, floats * sizeof *pixels);
    memcpy(pixels, bytes, size);
    free(bytes);
}

/* Both, for the indirect light. */
static inline void scene_lab_indirect(scene_lab *l, const char *scene, const char *options, float *pixels, size_t floats) {
    scene_lab_bake(l, scene, options);
    scene_lab_play(l, "indirect", pixels, floats);
}

#endif
