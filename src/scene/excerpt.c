/* The line of a text that a message is about, with a caret under the place. */
#include <stdio.h>
#include <string.h>

#include "scene/tree.h"
#include "support/text.h"

/* Characters before the place, and of the line, where it is long; those that no terminal shows, more of which are no text. */
enum { BEFORE = 60, SHOWN = 100, HIDDEN = 3 };

/* Steps over one character; one that a terminal would not show is a "?" in @p out, which holds a NUL at its end, and counted. */
static size_t character_copy(const char *from, const char *stop, char out[5], size_t *hidden)
{
    unsigned code = 0;
    const size_t size = dea_text_character(from, (size_t)(stop - from), &code);
    const bool shown = size > 0 && (code == '\t' || !dea_text_hidden(code));
    memcpy(out, shown ? from : "?", shown ? size : 1);
    out[shown ? size : 1] = '\0';
    *hidden += !shown;
    return size ? size : 1;
}

/* Skips @p count characters of the line; less where it ends. */
static const char *skip(const char *from, const char *stop, int count)
{
    char ignored[5];
    size_t hidden = 0;
    for (; count > 0 && from < stop; count--) {
        from += character_copy(from, stop, ignored, &hidden);
    }
    return from;
}

void dea_place_excerpt(const dea_place *place, char *out, size_t room)
{
    const dea_origin *origin = place->origin;
    const char *stop = NULL;
    const char *line = origin->text ? dea_text_line(origin->text, origin->length, place->line, &stop) : NULL;
    out[0] = '\0';
    if (!line || stop == line) {
        return;
    }
    const int first = place->column > BEFORE ? place->column - BEFORE : 1;
    char under[SHOWN + 1];
    char number[16] = "";
    size_t width = 0;
    size_t hidden = 0;
    if (!origin->setting) {
        snprintf(number, sizeof number, "%d", place->line);
    }
    size_t used = (size_t)snprintf(out, room, "%5s | %s", number, first > 1 ? "..." : "");
    const char *at = skip(line, stop, first - 1);
    for (int column = first; at < stop && column < first + SHOWN && used + 5 < room; column++) {
        char character[5];
        at += character_copy(at, stop, character, &hidden);
        used += (size_t)snprintf(out + used, room - used, "%s", character);
        if (column < place->column) {
            under[width++] = character[0] == '\t' ? '\t' : ' ';
        }
    }
    under[width] = '\0';
    if (hidden > HIDDEN) {
        out[0] = '\0';
        return;
    }
    snprintf(out + used, room - used, "%s\n      | %s%s^", at < stop ? "..." : "", first > 1 ? "   " : "", under);
}
