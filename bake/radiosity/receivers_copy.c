#include "radiosity/receivers.h"
#include <stdlib.h>
#include <string.h>

void receivers_free(receivers *r) {
    free(r->sides);
    free(r->cells);
    free(r->splits);
    free(r->receivers);
    free(r->followers);
    free(r->irradiance);
    *r = (receivers){0};
}

void *receivers_copied(const void *from, size_t count, size_t size) {
    void *to = from ? malloc(count * size + 1) : NULL;
    return to ? memcpy(to, from, count * size) : NULL;
}

bool receivers_copy(const receivers *from, uint32_t placed, receivers *to) {
    *to = *from;
    to->receivers = receivers_copied(placed ? from->receivers : NULL, placed, sizeof *from->receivers);
    to->sides = receivers_copied(from->sides, from->side_count, sizeof *from->sides);
    to->cells = receivers_copied(from->cells, from->cell_count, sizeof *from->cells);
    to->splits = receivers_copied(from->splits, from->split_count, sizeof *from->splits);
    to->followers = NULL;
    to->irradiance = NULL;
    if ((to->receivers || !placed) && !to->sides == !from->sides && !to->cells == !from->cells && !to->splits == !from->splits)
        return true;
    receivers_free(to);
    return false;
}
