/* PoCL compiles at run time and keeps that in a folder. Where the folder cannot be written, PoCL has no device or cannot build
 * a program; where the disk fills up while it compiles, its compiler ends the process. A player on a full disk must show its
 * picture all the same: the built-in device gives the same bits. So where there is little room, a child opens the pack first.
 */
#include "device.h"
#include "failure.h"
#include "pocl_cache.h"
#include "sinks/output.h"
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#define ON_HOST "; playing on the built-in device host"
#define NO_DRIVER "no OpenCL device (a driver makes one, PoCL for one): playing on the built-in device host"

/* What the child found out. */
typedef struct finding {
    vit_status status;
    vit_text why;
} finding;

/* The device of --device, or the default. */
static vit_status find(const play_options *o, vit_open_info *info, vit_text *why) {
    if (o->device != NULL)
        return vit_device_find(o->device, &info->device, why);
    info->device = vit_device_default();
    return VIT_OK;
}

static vit_status open_once(const play_options *o, vit_open_info info, vit_text *why) {
    vit_requirements need;
    vit *v;
    vit_status status = find(o, &info, why);
    if (status == VIT_OK && info.device == VIT_DEVICE_HOST)
        return vit_device_name(0, why) != NULL || !pocl_is_named(why->text) || o->device != NULL ? VIT_OK : VIT_FAILED;
    if (status == VIT_OK)
        status = vit_require(&info, &need, why);
    if (status != VIT_OK)
        return status == VIT_BAD_INPUT ? VIT_OK : status; /* the pack: the parent says so */
    info.arena_size = (need.host_bytes + 63) / 64 * 64;
    info.arena = aligned_alloc(64, info.arena_size);
    if (info.arena == NULL)
        return play_fail(why, VIT_FAILED, "out of memory: %zu bytes for the library's arena", info.arena_size);
    status = vit_open(&info, &v, why);
    vit_close(v);
    free(info.arena);
    return status;
}

/* In the child, which has said nothing yet if it ends in between. */
static void report_to(int to, const play_options *o, const vit_open_info *info) {
    finding found = {.why = {""}};
    int nowhere = open("/dev/null", O_WRONLY | O_CLOEXEC);
    if (nowhere >= 0 && (dup2(nowhere, STDOUT_FILENO) < 0 || dup2(nowhere, STDERR_FILENO) < 0))
        _exit(1);
    found.status = open_once(o, *info, &found.why);
    _exit(write(to, &found, sizeof found) == (ssize_t)sizeof found ? 0 : 1);
}

/* Opens the pack in a process that may come to an end over it. */
static vit_status try_apart(const play_options *o, const vit_open_info *info, vit_text *why) {
    finding found;
    int ends[2];
    (void)fflush(NULL); /* the child's exit would write it again */
    if (pipe(ends) != 0)
        return VIT_OK;
    const pid_t child = fork();
    if (child == 0)
        report_to(ends[1], o, info);
    (void)close(ends[1]);
    ssize_t got = 0;
    do
        got = child > 0 ? read(ends[0], &found, sizeof found) : 0;
    while (got < 0 && errno == EINTR);
    (void)close(ends[0]);
    if (child > 0)
        (void)waitpid(child, NULL, 0);
    if (got != (ssize_t)sizeof found)
        return play_fail(why, VIT_FAILED, "OpenCL ended the process while it compiled");
    *why = found.why;
    return found.status;
}

/* Has PoCL to do with the failure of --device? */
static bool is_pocls(const play_options *o, const vit_text *why) {
    vit_text name;
    uint32_t device;
    return pocl_is_named(why->text) || (vit_device_find(o->device, &device, NULL) == VIT_OK &&
                                        vit_device_name(device, &name) != NULL && pocl_is_named(name.text));
}

/* With little room for PoCL's cache, of which `trouble` tells. */
static vit_status choose_in_trouble(const play_options *o, vit_open_info *info, const vit_text *trouble, vit_text *note,
                                    vit_text *why) {
    vit_text cause = {""};
    const vit_status status = try_apart(o, info, &cause);
    if (status == VIT_OK)
        return find(o, info, why);
    if (o->device == NULL && status == VIT_FAILED) {
        info->device = VIT_DEVICE_HOST;
        (void)play_fail(note, VIT_OK, "%.480s" ON_HOST, trouble->text);
        return VIT_OK;
    }
    return is_pocls(o, &cause) ? play_fail(why, status, "%.230s; %.270s", cause.text, trouble->text)
                               : play_fail(why, status, "%s", cause.text);
}

vit_status device_choose(const play_options *o, vit_open_info *info, vit_text *note, vit_text *why) {
    vit_text trouble, none;
    const bool host = o->device != NULL && strcmp(o->device, "host") == 0;
    vit_status status = !host && !o->explain && pocl_cache_in_trouble(&trouble)
                            ? choose_in_trouble(o, info, &trouble, note, why)
                            : find(o, info, why);
    if (status != VIT_OK || o->device != NULL || info->device != VIT_DEVICE_HOST || note->text[0] != '\0')
        return status;
    if (vit_device_name(0, &none) == NULL && pocl_is_named(none.text))
        (void)play_fail(note, VIT_OK, "%.470s" ON_HOST, none.text);
    else if (!o->quiet) /* nobody should wonder why it is slower than yesterday */
        (void)play_fail(note, VIT_OK, NO_DRIVER);
    return VIT_OK;
}

bool device_fall_back(const play_options *o, vit_open_info *info, vit_text *note, const vit_text *why) {
    if (o->device != NULL || info->device == VIT_DEVICE_HOST)
        return false;
    info->device = VIT_DEVICE_HOST;
    (void)play_fail(note, VIT_OK, "%.470s" ON_HOST, why->text);
    return true;
}

vit_status device_list(vit_text *why) {
    vit_text name, trouble;
    uint32_t count = 0;
    bool pocl = false;
    for (const char *text; (text = vit_device_name(count, &name)) != NULL; count++) {
        (void)printf("%u %s\n", count, text);
        pocl |= pocl_is_named(text);
    }
    pocl |= pocl_is_named(name.text); /* what it says beyond the last names who has none */
    (void)printf("host %s\n", vit_device_name(VIT_DEVICE_HOST, &name));
    vit_status status = output_flush_stdout(why);
    if (pocl && pocl_cache_in_trouble(&trouble))
        (void)fprintf(stderr, "vitrine-play: %s\n", trouble.text);
    return status;
}
