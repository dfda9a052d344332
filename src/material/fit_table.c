/* Tables of measured points. */
#define _GNU_SOURCE /* strtod_l */
#include "material/fit_table.h"

#include <ctype.h>
#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "support/text.h"

enum { FILE_SIZE_MAX = 64 << 20, READ_BLOCK = 1 << 16 };

dea_status dea_table_fail(const dea_table *t, size_t column, const char *problem, const char *value)
{
    char shown[DEA_TEXT_ROOM] = "";
    if (value) {
        dea_text_clip(value, DEA_TEXT_SHOWN, shown, sizeof shown);
    }
    return dea_fail(t->error, DEA_ERROR_SCENE, "%.300s:%zu:%zu: %s%s%s%s", t->name, t->line, column, problem, value ? " \"" : "",
                    shown, value ? "\"" : "");
}

/* Splits off one field; quotes may hold separators, doubled quotes stand for one. */
static dea_status field_split(dea_table *t, const char *line, const char **at, const char *stop, dea_field *out)
{
    const char *next = *at;
    size_t used = 0;
    while (next < stop && (*next == ' ' || (*next == '\t' && t->separator != '\t'))) {
        next++;
    }
    out->column = (size_t)(next - line) + 1;
    const bool quoted = next < stop && *next == '"';
    bool open = quoted;
    next += quoted;
    while (next < stop && (open || *next != t->separator)) {
        char letter = *next++;
        if (letter == '"' && open) {
            const bool doubled = next < stop && *next == '"';
            open = doubled;
            if (!doubled) {
                continue;
            }
            next++;
        } else if (iscntrl((unsigned char)letter) && letter != '\t') {
            return dea_table_fail(t, (size_t)(next - line), "a control character", NULL);
        }
        if (used + 1 >= sizeof out->text) {
            return dea_table_fail(t, out->column, "this field is too long", NULL);
        }
        out->text[used++] = letter;
    }
    if (open) {
        return dea_table_fail(t, out->column, "a quote is not closed on its line", NULL);
    }
    while (used > 0 && (out->text[used - 1] == ' ' || out->text[used - 1] == '\t')) {
        used--;
    }
    out->text[used] = '\0';
    *at = next;
    return DEA_OK;
}

/* The next line that is neither blank nor a comment, split; count 0 at the end of the text. */
static dea_status row_next(dea_table *t)
{
    t->count = 0;
    while (t->next < t->end) {
        const char *line = t->next, *stop = memchr(line, '\n', (size_t)(t->end - line));
        stop = stop ? stop : t->end;
        t->next = stop < t->end ? stop + 1 : stop;
        t->line++;
        stop -= stop > line && stop[-1] == '\r';
        const char *first = line;
        while (first < stop && (*first == ' ' || *first == '\t')) {
            first++;
        }
        if (first == stop || *first == '#') {
            continue;
        }
        for (const char *at = line;; at++) {
            if (t->count == DEA_TABLE_FIELDS) {
                return dea_table_fail(t, (size_t)(at - line) + 1, "too many fields", NULL);
            }
            const dea_status status = field_split(t, line, &at, stop, &t->fields[t->count++]);
            if (status != DEA_OK || at >= stop) {
                return status;
            }
        }
    }
    return DEA_OK;
}

/* The separator is the first of , ; and tab that the header has. */
static char separator_find(const char *text, const char *end)
{
    bool comment = false, seen = false;
    for (; text < end; text++) {
        comment = comment || (*text == '#' && !seen);
        if (*text == '\n') {
            if (seen) {
                break;
            }
            comment = false;
        } else if (!comment && strchr(",;\t", *text) && *text) {
            return *text;
        } else if (!comment && !isspace((unsigned char)*text)) {
            seen = true;
        }
    }
    return ',';
}

static dea_status column_unknown(const dea_table *t, const dea_field *f)
{
    const char *nearest = NULL;
    size_t best = SIZE_MAX;
    for (size_t i = 0; i < t->column_count; i++) {
        const size_t distance = dea_text_distance(f->text, t->columns[i].name);
        if (distance < best && dea_text_likely(f->text, distance)) {
            best = distance;
            nearest = t->columns[i].name;
        }
    }
    char problem[400];
    snprintf(problem, sizeof problem, "unknown column%s%s%s (accepted: %s%s%s):", nearest ? " (did you mean " : "",
             nearest ? nearest : "", nearest ? "?)" : "", t->accepted, nearest ? "" : "; ", nearest ? "" : t->advice);
    return dea_table_fail(t, f->column, problem, f->text);
}

dea_status dea_table_header(dea_table *t)
{
    dea_status status = row_next(t);
    if (status != DEA_OK) {
        return status;
    }
    if (t->count == 0) {
        char problem[200];
        snprintf(problem, sizeof problem, "no header row; its columns: %s", t->accepted);
        return dea_table_fail(t, 1, problem, NULL);
    }
    for (size_t i = 0; i < t->count; i++) {
        dea_field *f = &t->fields[i];
        size_t kind = 0;
        while (kind < t->column_count && strcmp(t->columns[kind].name, f->text) != 0) {
            kind++;
        }
        if (kind == t->column_count) {
            return column_unknown(t, f);
        }
        f->holds = &t->columns[kind];
        if (t->seen[f->holds->role]) {
            return dea_table_fail(t, f->column, "a second column of the same kind:", f->text);
        }
        t->seen[f->holds->role] = true;
    }
    t->width = t->count;
    return DEA_OK;
}

dea_status dea_table_row(dea_table *t)
{
    const dea_status status = row_next(t);
    if (status == DEA_OK && t->count > 0 && t->count != t->width) {
        char problem[80];
        snprintf(problem, sizeof problem, "%zu fields where the header has %zu", t->count, t->width);
        return dea_table_fail(t, 1, problem, NULL);
    }
    return status;
}

dea_status dea_table_number(const dea_table *t, const dea_field *f, double *value)
{
    char *end;
    errno = 0;
    *value = strtod_l(f->text, &end, t->numbers);
    if (*f->text == '\0') {
        return dea_table_fail(t, f->column, "an empty field where a number belongs", NULL);
    }
    if (*end != '\0' || f->text[strspn(f->text, "0123456789+-.eE")] != '\0') {
        return dea_table_fail(t, f->column, "not a number:", f->text);
    }
    *value *= f->holds->factor;
    return isfinite(*value) ? DEA_OK : dea_table_fail(t, f->column, "this number is too large:", f->text);
}

dea_status dea_table_begin(dea_table *t, const char *text, size_t length, const char *name, dea_error *error)
{
    const size_t mark = length >= 3 && memcmp(text, "\xef\xbb\xbf", 3) == 0 ? 3 : 0;
    t->name = name;
    t->next = text + mark;
    t->end = text + length;
    t->error = error;
    t->separator = separator_find(t->next, t->end);
    t->numbers = newlocale(LC_ALL_MASK, "C", (locale_t)0);
    return t->numbers ? DEA_OK : dea_fail(error, DEA_ERROR_MEMORY, "out of memory");
}

void dea_table_end(dea_table *t)
{
    if (t->numbers) {
        freelocale(t->numbers);
    }
}

/* Reads all of an open file; *text is malloc'd. */
static dea_status file_slurp(int fd, const char *path, char **text, size_t *length, dea_error *error)
{
    size_t room = 0;
    for (;;) {
        if (*length + READ_BLOCK > room) {
            room = 2 * room + READ_BLOCK;
            char *more = realloc(*text, room);
            if (!more) {
                return dea_fail(error, DEA_ERROR_MEMORY, "out of memory");
            }
            *text = more;
        }
        const ssize_t got = read(fd, *text + *length, READ_BLOCK);
        if (got < 0 && errno == EINTR) {
            continue;
        }
        if (got < 0) {
            return dea_fail(error, DEA_ERROR_IO, "cannot read %.400s: %s", path, strerror(errno));
        }
        *length += (size_t)got;
        if (got == 0) {
            return DEA_OK;
        }
        if (*length > FILE_SIZE_MAX) {
            return dea_fail(error, DEA_ERROR_IO, "%.400s is larger than %d MiB", path, FILE_SIZE_MAX >> 20);
        }
    }
}

dea_status dea_table_open(const char *path, dea_table_parser *parse, void *user, dea_error *error)
{
    const bool standard = strcmp(path, "-") == 0;
    const int fd = standard ? STDIN_FILENO : open(path, O_RDONLY | O_CLOEXEC | O_NOCTTY);
    struct stat about;
    if (fd < 0 || fstat(fd, &about) != 0) {
        return dea_fail(error, DEA_ERROR_IO, "cannot read %.400s: %s", path, strerror(errno));
    }
    char *text = NULL;
    size_t length = 0;
    dea_status status;
    if (!S_ISREG(about.st_mode) && !S_ISFIFO(about.st_mode) && !standard) {
        status = dea_fail(error, DEA_ERROR_IO, "%.400s is neither a file nor a pipe", path);
    } else {
        status = file_slurp(fd, path, &text, &length, error);
    }
    if (status == DEA_OK) {
        status = parse(text, length, standard ? "standard input" : path, user, error);
    }
    free(text);
    if (!standard) {
        close(fd);
    }
    return status;
}
