/* machine.c: what the machine offers. */
#ifndef VIT_COST_MACHINE_H
#define VIT_COST_MACHINE_H

#include <stddef.h>
#include <stdint.h>

/* Makes the folder for finished and unfinished references, $XDG_CACHE_HOME/vitrine or ~/.cache/vitrine, and writes its name.
 * NULL: there is no home for it, or it cannot be written. */
const char *machine_cache_folder(char *folder, size_t room);
/* A quarter of the machine's memory, bytes. */
uint64_t machine_memory(void);
/* As the system calls it; "" if it does not say. */
void machine_cpu(char *name, size_t room);

#endif
