#include <signal.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "program/program.h"
#include "support/text.h"

void dea_complain(const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    fputs("deaspice: ", stderr);
    vfprintf(stderr, format, arguments);
    fputc('\n', stderr);
    va_end(arguments);
}

static dea_exit exit_of(dea_status status)
{
    switch (status) {
    case DEA_OK:
        return DEA_EXIT_DONE;
    case DEA_ERROR_SCENE:
    case DEA_ERROR_USAGE:
    case DEA_ERROR_UNSUPPORTED:
        return DEA_EXIT_USAGE;
    case DEA_ERROR_DISAGREE:
        return DEA_EXIT_DISAGREED;
    default:
        return DEA_EXIT_FAILED;
    }
}

dea_exit dea_complain_error(const dea_error *error)
{
    if (dea_signals_caught() == 0)
        dea_complain("%s%s%s", error->message[0] != '\0' ? error->message : dea_status_text(error->status),
                     error->excerpt[0] != '\0' ? "\n" : "", error->excerpt);
    return exit_of(error->status);
}

void dea_complain_unknown(const char *what, const char *given, const char *const *names, size_t count)
{
    char shown[DEA_TEXT_ROOM];
    const char *nearest = NULL;
    size_t best = (size_t)-1;
    for (size_t i = 0; i < count; i++) {
        size_t distance = dea_text_distance(given, names[i]);
        if (distance < best) {
            best = distance;
            nearest = names[i];
        }
    }
    dea_text_clip(given, DEA_TEXT_SHOWN, shown, sizeof shown);
    if (nearest && dea_text_likely(given, best)) {
        dea_complain("unknown %s \"%s\"; did you mean \"%s\"?", what, shown, nearest);
        return;
    }
    fprintf(stderr, "deaspice: unknown %s \"%s\"; accepted:", what, shown);
    for (size_t i = 0; i < count; i++)
        fprintf(stderr, "%s %s", i > 0 ? "," : "", names[i]);
    fputc('\n', stderr);
}

bool dea_word_choose(const char *what, const char *given, dea_word *words, size_t *index)
{
    enum { MOST = 64 };
    const char *names[MOST];
    char room[DEA_NAME_LENGTH];
    size_t count = 0;
    for (; count < MOST && (names[count] = words(count, room)); count++) {
        if (strcmp(names[count], given) == 0) {
            *index = count;
            return true;
        }
    }
    dea_complain_unknown(what, given, names, count);
    return false;
}
