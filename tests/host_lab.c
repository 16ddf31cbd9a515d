/* Which host_lab this machine can run: host_labs.h, made by the Makefile, has a line LAB(isa) each. */
#include "host_lab.h"
#include "host/host.h"

#include <string.h>

#define LAB(isa) extern const host_lab host_lab_##isa;
#include "host_labs.h"
#undef LAB

static const host_lab *const all_labs[] = {
#define LAB(isa) &host_lab_##isa,
#include "host_labs.h"
#undef LAB
};

const host_lab *host_lab_find(void) {
    for (size_t i = 0; i + 1 < sizeof all_labs / sizeof *all_labs; i++)
        if (strcmp(all_labs[i]->isa, vit_host_isa(0)) == 0)
            return all_labs[i];
    return all_labs[sizeof all_labs / sizeof *all_labs - 1];
}
