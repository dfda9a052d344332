#include "deaspice/status.h"

#include <stdarg.h>
#include <stdio.h>

const char *dea_status_text(dea_status status)
{
    switch (status) {
#define X(name, value, text)                                                                                                     \
    case name:                                                                                                                   \
        return text;
        DEA_STATUS_LIST(X)
#undef X
    }
    return "unknown status";
}

dea_status dea_fail(dea_error *error, dea_status status, const char *format, ...)
{
    if (error) {
        va_list arguments;
        va_start(arguments, format);
        error->status = status;
        error->excerpt[0] = '\0';
        vsnprintf(error->message, sizeof error->message, format, arguments);
        va_end(arguments);
    }
    return status;
}
