#include "common/fail.h"
#include <stdarg.h>
#include <stdio.h>

vit_status bake_fail(vit_text *why, vit_status status, const char *format, ...) {
    if (why) {
        va_list arguments;
        va_start(arguments, format);
        (void)vsnprintf(why->text, sizeof why->text, format, arguments);
        va_end(arguments);
    }
    return status;
}

vit_status bake_fail_plain(vit_text *why, vit_status status, const char *format, ...) {
    if (why) {
        va_list arguments;
        va_start(arguments, format);
        (void)vsnprintf(why->text, sizeof why->text, format, arguments);
        va_end(arguments);
        for (char *c = why->text; *c; c++)
            if ((unsigned char)*c < 0x20 || *c == 0x7f)
                *c = '?';
    }
    return status;
}
