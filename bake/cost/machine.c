#include "cost/machine.h"
#include <errno.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

const char *machine_cache_folder(char *folder, size_t room) {
    const char *base = getenv("XDG_CACHE_HOME"), *home = getenv("HOME");
    const bool xdg = base && base[0] == '/';
    if (!xdg && !(home && home[0] == '/'))
        return NULL;
    const int used = snprintf(folder, room, "%s%s", xdg ? base : home, xdg ? "" : "/.cache");
    if (used < 0 || (size_t)used + sizeof "/vitrine" > room)
        return NULL;
    (void)mkdir(folder, 0777);
    (void)snprintf(folder + used, room - (size_t)used, "/vitrine");
    return (mkdir(folder, 0777) == 0 || errno == EEXIST) && access(folder, W_OK | X_OK) == 0 ? folder : NULL;
}

uint64_t machine_memory(void) {
    const long pages = sysconf(_SC_PHYS_PAGES), page = sysconf(_SC_PAGESIZE);
    return pages > 0 && page > 0 ? (uint64_t)pages / 4 * (uint64_t)page : (uint64_t)1 << 30;
}

void machine_cpu(char *name, size_t room) {
    char line[256];
    FILE *info = fopen("/proc/cpuinfo", "r");
    name[0] = '\0';
    while (info && !name[0] && fgets(line, sizeof line, info)) {
        const char *colon = strncmp(line, "model name", 10) == 0 ? strchr(line, ':') : NULL;
        if (colon && colon[1])
            (void)snprintf(name, room, "%.*s", (int)strcspn(colon + 2, "\n"), colon + 2);
    }
    if (info)
        (void)fclose(info);
}
