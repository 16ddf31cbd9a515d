#include "sink.h"
#include <string.h>

const sink_kind *sink_at(uint32_t index) {
    static const sink_kind *const kinds[] = {
#define X(name) &sink_##name,
        SINKS(X)
#undef X
    };
    return index < sizeof kinds / sizeof kinds[0] ? kinds[index] : NULL;
}

bool sink_uses_stdout(const sink_kind *kind, const char *target) {
    return kind->writes == SINK_STREAM && strcmp(target, "-") == 0;
}
