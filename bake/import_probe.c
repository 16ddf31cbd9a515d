#include "importer.h"
#include <assimp/cimport.h>
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

/* Processor time for a file: seconds, and seconds a MiB. Sibenik's 9 MiB take 1 s. */
enum { LEAST_SECONDS = 8, SECONDS_A_MIB = 4 };

/* What the user would otherwise see of assertions and sanitizers. */
static void be_silent(void) {
    const int nowhere = open("/dev/null", O_WRONLY);
    if (nowhere >= 0) {
        (void)dup2(nowhere, STDOUT_FILENO);
        (void)dup2(nowhere, STDERR_FILENO);
    }
}

/* A handler of our process's must not go on in the child. */
static void die_by_signals(void) {
    static const int signals[] = {SIGABRT, SIGBUS, SIGFPE, SIGILL, SIGSEGV, SIGXCPU, SIGINT, SIGTERM};
    for (size_t i = 0; i < sizeof signals / sizeof signals[0]; i++)
        (void)signal(signals[i], SIG_DFL);
}

__attribute__((noreturn)) static void read_and_leave(importer *im, size_t size) {
    const rlim_t seconds = LEAST_SECONDS + SECONDS_A_MIB * (size >> 20);
    const struct rlimit time = {seconds, seconds + 1}, none = {0, 0};
    be_silent();
    die_by_signals();
    (void)setrlimit(RLIMIT_CPU, &time);
    (void)setrlimit(RLIMIT_CORE, &none);
    im->ai = aiImportFile(im->file, 0);
    if (im->ai)
        (void)import_triangulate(im);
    _exit(0);
}

bool import_probe(importer *im, size_t size) {
    int status = 0;
    const pid_t child = fork();
    if (child < 0) /* no process to spare: do without */
        return true;
    if (child == 0)
        read_and_leave(im, size);
    while (waitpid(child, &status, 0) < 0)
        if (errno != EINTR)
            return true;
    if (status == 0)
        return true;
    if (WIFSIGNALED(status) && WTERMSIG(status) == SIGXCPU)
        return import_fail(im, "takes the mesh reader too long");
    return import_fail(im, "the mesh reader breaks down on it");
}
