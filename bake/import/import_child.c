#include "import/importer.h"
#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>
#ifdef __linux__
#include <sys/prctl.h>
#endif
#if defined(__has_feature)
#if __has_feature(address_sanitizer)
#define __SANITIZE_ADDRESS__ 1
#endif
#endif

/* Processor time for a mesh file and what it refers to: seconds, seconds a MiB of files, texels per second. Sibenik's 9 MiB
 * take 1 s. */
enum { LEAST_SECONDS = 8, SECONDS_A_MIB = 4, TEXELS_A_SECOND = 1 << 22 };
/* Memory beyond what the process has: MiB, and for each MiB of files. Text of an OBJ file becomes 30 times as much, a packed
 * file more. */
enum { LEAST_MIB = 4096, MIB_A_MIB = 512 };
/* Without any processor time for so long it waits for what never comes. */
enum { STUCK_SECONDS = 120 };

/* ---- in the child ---- */

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
    static const int signals[] = {SIGABRT, SIGBUS, SIGFPE, SIGILL, SIGSEGV, SIGXCPU, SIGINT, SIGTERM, SIGPIPE};
    for (size_t i = 0; i < sizeof signals / sizeof signals[0]; i++)
        (void)signal(signals[i], SIG_DFL);
#ifdef __linux__
    (void)prctl(PR_SET_PDEATHSIG, SIGKILL);
#endif
}

/* Address space in use, bytes; 0: not known. */
static uint64_t mapped_now(void) {
    unsigned long long pages = 0;
    FILE *f = fopen("/proc/self/statm", "r");
    if (f && fscanf(f, "%20llu", &pages) != 1) /* NOLINT(cert-err34-c): the system's own number */
        pages = 0;
    if (f)
        (void)fclose(f);
    return (uint64_t)pages * (uint64_t)sysconf(_SC_PAGESIZE);
}

/* Lowers or raises the soft limit. */
static void limit(int what, uint64_t most) {
    struct rlimit now;
    if (getrlimit(what, &now) != 0)
        return;
    now.rlim_cur = now.rlim_max == RLIM_INFINITY || most < now.rlim_max ? (rlim_t)most : now.rlim_max;
    (void)setrlimit(what, &now);
}

static void set_limits(const importer *im) {
    const uint64_t mib = im->allowed >> 20;
    limit(RLIMIT_CPU, LEAST_SECONDS + SECONDS_A_MIB * mib + im->allowed_texels / TEXELS_A_SECOND);
#ifndef __SANITIZE_ADDRESS__ /* its shadow takes all the address space that there is */
    if (im->mapped)
        limit(RLIMIT_AS, im->mapped + ((LEAST_MIB + MIB_A_MIB * mib) << 20));
#endif
}

void import_allow(importer *im, size_t bytes) {
    im->allowed += bytes;
    if (im->to_parent)
        set_limits(im);
}

void import_allow_texels(importer *im, uint64_t texels) {
    im->allowed_texels += texels;
    if (im->to_parent)
        set_limits(im);
}

static void send_warning(void *user, const char *line) {
    wire_send(user, WIRE_WARNING, line, strlen(line));
}

/* Starts with an empty model, but for the images: those that are there already are not read again. */
__attribute__((noreturn)) static void read_and_leave(const importer *of_parent, const scene_mesh *mesh, int to) {
    wire out = {.fd = to};
    model fresh = {.images = of_parent->m->images, .image_count = of_parent->m->image_count};
    importer im = *of_parent;
    be_silent();
    die_by_signals();
    limit(RLIMIT_CORE, 0);
    im.mapped = mapped_now();
    im.to_parent = &out;
    im.m = &fresh;
    im.vertex_room = im.triangle_room = im.material_room = 0;
    im.user = im.warn ? &out : NULL;
    im.warn = im.warn ? send_warning : NULL;
    const int before = fresh.image_count;
    set_limits(&im);
    if (import_file(&im, mesh))
        wire_send_model(&im, before, &out);
    else
        wire_send(&out, WIRE_FAILURE, im.why->text, strlen(im.why->text));
    /* The image of the process goes as a whole: what would free Assimp's tree may not survive it. */
    _exit(out.failed ? 1 : 0);
}

/* ---- in the parent ---- */

/* Waits until there is something to read. False: the child is stuck. */
static bool wait_for(const wire *in, pid_t child) {
    struct pollfd p = {.fd = in->fd, .events = POLLIN};
    clockid_t clock;
    struct timespec used = {0}, before = {0};
    const bool timed = clock_getcpuclockid(child, &clock) == 0;
    for (int still = 0; still < STUCK_SECONDS;) {
        const int ready = poll(&p, 1, 1000);
        if (ready > 0)
            return true;
        if (ready < 0 && errno != EINTR)
            return false;
        const bool moved =
            !timed || clock_gettime(clock, &used) != 0 || used.tv_sec != before.tv_sec || used.tv_nsec != before.tv_nsec;
        before = used;
        still = moved ? 0 : still + 1;
    }
    return false;
}

typedef enum outcome { READ, REFUSED, ENDED, STUCK, NONSENSE } outcome;

/* The child's next words. */
static outcome hear(importer *im, wire *in, bool *last) {
    char line[1024];
    wire_head head;
    *last = true;
    if (!wire_receive_head(in, &head))
        return ENDED;
    if (head.kind == WIRE_MODEL && wire_receive_model(im, head.size, in))
        return READ;
    if (head.kind == WIRE_MODEL)
        return in->refused ? REFUSED : in->ended ? ENDED : NONSENSE;
    if (!wire_receive_text(in, head.size, line, sizeof line))
        return in->ended ? ENDED : NONSENSE;
    if (head.kind == WIRE_FAILURE) {
        (void)snprintf(im->why->text, sizeof im->why->text, "%.*s", (int)sizeof im->why->text - 1, line);
        return REFUSED;
    }
    if (head.kind != WIRE_WARNING)
        return NONSENSE;
    *last = false;
    im->m->warnings++;
    if (im->warn)
        im->warn(im->user, line);
    return READ;
}

/* The child has ended without a last word. */
static bool fail_by(importer *im, int status) {
    const int number = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
    if (number == SIGXCPU)
        return import_fail(im, "takes the mesh reader too long");
    if (number == SIGKILL)
        return import_fail(im, "the mesh reader was ended from outside: the machine's memory may not do");
    if (number == SIGINT || number == SIGTERM) {
        im->status = VIT_FAILED;
        return import_fail(im, "interrupted");
    }
    return import_fail(im, "the mesh reader breaks down on it; as glTF, OBJ or PLY it may be read");
}

bool import_in_child(importer *im, const scene_mesh *mesh) {
    int ends[2], status = 0;
    const pid_t child = pipe(ends) == 0 ? fork() : -1;
    if (child < 0) {
        im->status = VIT_FAILED;
        return import_fail(im, "no process for the mesh reader: %s", strerror(errno));
    }
    if (child == 0) {
        (void)close(ends[0]);
        read_and_leave(im, mesh, ends[1]);
    }
    (void)close(ends[1]);
    wire in = {.fd = ends[0]};
    outcome heard = READ;
    for (bool last = false; !last && heard == READ;)
        heard = wait_for(&in, child) ? hear(im, &in, &last) : STUCK;
    (void)close(ends[0]);
    if (heard == STUCK || heard == NONSENSE)
        (void)kill(child, SIGKILL);
    while (waitpid(child, &status, 0) < 0)
        if (errno != EINTR)
            break;
    if (heard == STUCK)
        return import_fail(im, "the mesh reader waits for something that never comes");
    if (heard == NONSENSE)
        return import_fail(im, "the mesh reader breaks down on it; as glTF, OBJ or PLY it may be read");
    return heard == ENDED ? fail_by(im, status) : heard == READ;
}
