#include "common/names.h"
#include <ctype.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

/* Names that are shown; characters that are looked at, and shown, of each. */
enum { SHOWN = 5, LOOKED_AT = 64, LENGTH = 40 };

/* Insertions, deletions and changes of a character between two names, whatever their case (V. Levenshtein, 1966). */
static unsigned distance(const char *a, const char *b) {
    unsigned row[LOOKED_AT + 1];
    size_t n = strlen(a), m = strlen(b);
    n = n < LOOKED_AT ? n : LOOKED_AT;
    m = m < LOOKED_AT ? m : LOOKED_AT;
    for (size_t k = 0; k <= m; k++)
        row[k] = (unsigned)k;
    for (size_t i = 1; i <= n; i++) {
        unsigned corner = row[0];
        row[0] = (unsigned)i;
        for (size_t k = 1; k <= m; k++) {
            const unsigned same = corner + (tolower((unsigned char)a[i - 1]) != tolower((unsigned char)b[k - 1]));
            const unsigned other = (row[k] < row[k - 1] ? row[k] : row[k - 1]) + 1;
            corner = row[k];
            row[k] = same < other ? same : other;
        }
    }
    return row[m];
}

static bool is_among(const char *name, const char *const *names, int count) {
    for (int i = 0; i < count; i++)
        if (strcmp(names[i], name) == 0)
            return true;
    return false;
}

void names_offer(const char *wanted, name_fn *name, const void *list, int count, char text[NAMES_TEXT]) {
    const char *best[SHOWN];
    unsigned far[SHOWN];
    int found = 0, left = 0;
    for (int i = 0; i < count; i++) {
        const char *candidate = name(list, i);
        if (!candidate[0] || is_among(candidate, best, found))
            continue;
        const unsigned d = distance(wanted, candidate);
        int at = found;
        while (at > 0 && far[at - 1] > d)
            at--;
        left += found == SHOWN;
        if (at == SHOWN)
            continue;
        found += found < SHOWN;
        for (int k = found - 1; k > at; k--) {
            best[k] = best[k - 1];
            far[k] = far[k - 1];
        }
        best[at] = candidate;
        far[at] = d;
    }
    int used = snprintf(text, NAMES_TEXT, found == 0 ? "; there is none" : found == 1 ? "; there is " : "; there are ");
    for (int i = 0; i < found; i++)
        used += snprintf(text + used, NAMES_TEXT - (size_t)used, "%s'%.*s'",
                         i == 0                        ? ""
                         : i + 1 == found && left == 0 ? " and "
                                                       : ", ",
                         LENGTH, best[i]);
    if (left > 0)
        (void)snprintf(text + used, NAMES_TEXT - (size_t)used, " and more");
}
