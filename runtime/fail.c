#include "fail.h"
#include <stdarg.h>
#include <stdio.h>

vit_status vit_fail(vit_text *why, vit_status status, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    if (why)
        vsnprintf(why->text, sizeof why->text, format, arguments);
    va_end(arguments);
    return status;
}
