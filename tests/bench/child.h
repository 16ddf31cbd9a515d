/* Child processes of the benches: our own tools, timed as a user meets them. */
#ifndef VIT_BENCH_CHILD_H
#define VIT_BENCH_CHILD_H

#include "measure.h"
#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

/* In the child: stdout into the pipe or away, the caches of compiled kernels in `cache` (NULL: where they always are). */
#ifdef __GNUC__
__attribute__((noreturn))
#endif
static inline void
child_become(char *const argv[], int out, const char *cache) {
    const int to = out >= 0 ? out : open("/dev/null", O_WRONLY);
    dup2(to, STDOUT_FILENO);
    if (cache && (setenv("POCL_CACHE_DIR", cache, 1) != 0 || setenv("CUDA_CACHE_PATH", cache, 1) != 0))
        _exit(127);
    execv(argv[0], argv);
    _exit(127);
}

static inline void child_end(pid_t pid, const char *name) {
    int status;
    if (waitpid(pid, &status, 0) != pid || !WIFEXITED(status) || WEXITSTATUS(status) != 0)
        bench_fail("%s failed", name);
}

/* Milliseconds until `argv` has ended; with `first_byte`, until it has written something to stdout (it then runs to its end).
 */
static inline double child_run(char *const argv[], const char *cache, bool first_byte) {
    int ends[2];
    char byte;
    fflush(NULL);
    if (pipe(ends) != 0)
        bench_fail("pipe: %s", strerror(errno));
    const double began = bench_seconds();
    const pid_t pid = fork();
    if (pid < 0)
        bench_fail("fork: %s", strerror(errno));
    if (pid == 0)
        child_become(argv, first_byte ? ends[1] : -1, cache);
    close(ends[1]);
    const bool written = read(ends[0], &byte, 1) == 1; /* without `first_byte` the pipe closes when the child ends */
    double ms = (bench_seconds() - began) * 1e3;
    while (written && read(ends[0], &byte, 1) == 1)
        ;
    close(ends[0]);
    child_end(pid, argv[0]);
    if (first_byte && !written)
        bench_fail("%s wrote nothing", argv[0]);
    return ms;
}

/* Removes a folder of caches and all in it. */
static inline void child_remove(const char *folder) {
    char rm[] = "/bin/rm", flags[] = "-rf", path[512];
    snprintf(path, sizeof path, "%s", folder);
    char *const argv[] = {rm, flags, path, NULL};
    child_run(argv, NULL, false);
}

#endif
