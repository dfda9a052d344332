/* What a newcomer to YAML most likely did, where libfyaml could not read a text. */
#include <stdio.h>
#include <string.h>

#include "scene/tree.h"
#include "support/text.h"

enum { BRACKETS_MOST = 64, PIECE = 80 };

/* A line without its comment and the blanks around it. */
typedef struct line {
    int number;
    const char *start;       /* of the whole line */
    const char *from, *stop; /* of what it holds */
    const char *colon;       /* first one that ends a key, NULL: none */
    size_t colons;           /* of such, outside quotes and brackets */
} line;

/* A bracket or a quote that is open. */
typedef struct opening {
    char mark;
    dea_place place;
} opening;

static bool is_blank(char c)
{
    return c == ' ' || c == '\t' || c == '\r' || c == '\n';
}

/* Past the quoted text at @p at, @p stop where it does not end. */
static const char *quote_skip(const char *at, const char *stop)
{
    const char mark = *at++;
    while (at < stop && *at != mark) {
        at += *at == '\\' && mark == '"' ? 2 : 1;
    }
    return at < stop ? at + 1 : stop;
}

/* Does a quoted text start here, rather than an apostrophe inside a word? */
static bool is_quote(const char *start, const char *at)
{
    return (*at == '"' || *at == '\'') && (at == start || is_blank(at[-1]) || strchr("[{,:", at[-1]));
}

static bool is_comment(const char *start, const char *at)
{
    return *at == '#' && (at == start || is_blank(at[-1]));
}

static bool line_take(const char *text, size_t length, int number, line *out)
{
    const char *stop;
    const char *start = number > 0 ? dea_text_line(text, length, number, &stop) : NULL;
    int depth = 0;
    if (!start) {
        return false;
    }
    *out = (line){.number = number, .start = start, .from = start, .stop = stop};
    while (out->from < stop && is_blank(*out->from)) {
        out->from++;
    }
    for (const char *at = out->from; at < out->stop;) {
        if (is_comment(start, at)) {
            out->stop = at;
            break;
        }
        depth += (*at == '[' || *at == '{') - (*at == ']' || *at == '}');
        if (*at == ':' && depth == 0 && (at + 1 == stop || is_blank(at[1]))) {
            out->colon = out->colon ? out->colon : at;
            out->colons++;
        }
        at = is_quote(start, at) ? quote_skip(at, stop) : at + 1;
    }
    while (out->stop > out->from && is_blank(out->stop[-1])) {
        out->stop--;
    }
    return true;
}

static void place_move(dea_place *place, const line *at, const char *where)
{
    place->line = at->number;
    place->column = dea_text_column(at->start, where);
}

/* A part of the line fit for a message. */
static const char *piece(const char *from, const char *stop, char out[DEA_TEXT_ROOM])
{
    char text[4 * PIECE];
    snprintf(text, sizeof text, "%.*s", (int)(stop - from < (long)sizeof text ? stop - from : (long)sizeof text - 1), from);
    return dea_text_clip(text, PIECE, out, DEA_TEXT_ROOM);
}

static bool explain_tab(const line *at, dea_place *place, char out[DEA_SYNTAX_ROOM])
{
    const char *tab = memchr(at->start, '\t', (size_t)(at->from - at->start));
    if (!tab) {
        return false;
    }
    place_move(place, at, tab);
    snprintf(out, DEA_SYNTAX_ROOM, "a tab; indent with blanks");
    return true;
}

/* libfyaml names the quote, or what comes after it. */
static bool explain_quote(const line *at, dea_place *place, char out[DEA_SYNTAX_ROOM])
{
    char shown[DEA_TEXT_ROOM];
    for (const char *quote = at->from; quote < at->stop; quote++) {
        if (!is_quote(at->start, quote)) {
            continue;
        }
        const char *after = quote_skip(quote, at->stop);
        if (after < at->stop || (after - quote > 1 && after[-1] == *quote)) {
            quote = after - 1;
            continue;
        }
        place_move(place, at, quote);
        snprintf(out, DEA_SYNTAX_ROOM, "the quote is not closed; write %s%c", piece(quote, at->stop, shown), *quote);
        return true;
    }
    return false;
}

/* Brackets that are open at the end of the text; the innermost is returned, its mark 0 where there is none. */
static opening bracket_find(const char *text, size_t length, const dea_place *place)
{
    opening open[BRACKETS_MOST];
    size_t count = 0;
    line at;
    for (int number = 1; line_take(text, length, number, &at); number++) {
        for (const char *c = at.from; c < at.stop; c = is_quote(at.start, c) ? quote_skip(c, at.stop) : c + 1) {
            if ((*c == '[' || *c == '{') && count < BRACKETS_MOST) {
                open[count] = (opening){.mark = *c, .place = *place};
                place_move(&open[count++].place, &at, c);
            } else if ((*c == ']' || *c == '}') && count > 0) {
                count--;
            }
        }
    }
    return count > 0 ? open[count - 1] : (opening){.mark = '\0', .place = *place};
}

static bool explain_bracket(const char *text, size_t length, dea_place *place, char out[DEA_SYNTAX_ROOM])
{
    const opening open = bracket_find(text, length, place);
    if (!open.mark || open.place.line > place->line) {
        return false;
    }
    *place = open.place;
    snprintf(out, DEA_SYNTAX_ROOM, "the bracket %c is not closed; write %c where it ends", open.mark,
             open.mark == '[' ? ']' : '}');
    return true;
}

static bool explain_colon(const line *at, dea_place *place, char out[DEA_SYNTAX_ROOM])
{
    char key[DEA_TEXT_ROOM];
    char value[DEA_TEXT_ROOM];
    const char *end = at->from;
    while (end < at->stop && !is_blank(*end) && *end != ':' && *end != '=') {
        end++;
    }
    if (at->colon || end == at->from || strchr("-[{]}\"'", *at->from)) {
        return false;
    }
    const char *rest = end;
    while (rest < at->stop && (is_blank(*rest) || *rest == '=' || *rest == ':')) {
        rest++;
    }
    const bool close = end < at->stop && *end == ':';
    place_move(place, at, end);
    snprintf(out, DEA_SYNTAX_ROOM, "a %s is missing; write %s:%s%s", close ? "blank after the colon" : "colon after the key",
             piece(at->from, end, key), rest < at->stop ? " " : "", piece(rest, at->stop, value));
    return true;
}

static bool explain_text(const line *at, dea_place *place, char out[DEA_SYNTAX_ROOM])
{
    char key[DEA_TEXT_ROOM];
    char value[DEA_TEXT_ROOM];
    if (at->colons < 2) {
        return false;
    }
    const char *rest = at->colon + 1;
    while (rest < at->stop && is_blank(*rest)) {
        rest++;
    }
    place_move(place, at, rest);
    snprintf(out, DEA_SYNTAX_ROOM, "a colon inside a text; put that in quotes: %s: \"%s\"", piece(at->from, at->colon, key),
             piece(rest, at->stop, value));
    return true;
}

/* "key: value", and the next line deeper. */
static bool explain_indentation(const char *text, size_t length, const line *at, dea_place *place, char out[DEA_SYNTAX_ROOM])
{
    line next;
    int number = at->number + 1;
    bool found;
    while ((found = line_take(text, length, number, &next)) && next.from == next.stop) {
        number++;
    }
    if (!found || !at->colon || at->colon + 1 >= at->stop || next.from - next.start <= at->from - at->start) {
        return false;
    }
    place_move(place, at, at->from);
    snprintf(out, DEA_SYNTAX_ROOM,
             "line %d is indented deeper than this one, which has its value; the keys of one mapping start in one column",
             number);
    return true;
}

bool dea_syntax_explain(dea_place *place, char out[DEA_SYNTAX_ROOM])
{
    const char *text = place->origin->text;
    const size_t length = place->origin->length;
    line at;
    if (!text) {
        return false;
    }
    if (explain_bracket(text, length, place, out)) {
        return true;
    }
    if (!line_take(text, length, place->line, &at)) {
        return false;
    }
    return explain_tab(&at, place, out) || explain_quote(&at, place, out) || explain_colon(&at, place, out) ||
           explain_text(&at, place, out) || explain_indentation(text, length, &at, place, out);
}
