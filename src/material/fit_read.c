/* Tables of measured points. */
#define _GNU_SOURCE /* strtod_l */
#include "deaspice/fit.h"

#include <ctype.h>
#include <errno.h>
#include <fcntl.h>
#include <locale.h>
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "support/text.h"

enum { FILE_SIZE_MAX = 64 << 20, FIELDS_MAX = 64, FIELD_LENGTH = 64, READ_BLOCK = 1 << 16 };

/* What a column holds. */
typedef enum role { ROLE_STRETCH, ROLE_STRESS, ROLE_MODE } role;

static const struct {
    const char *name;
    role role;
    double factor;
} columns[] = {
    {"stretch", ROLE_STRETCH, 1.0},   {"stress_Pa", ROLE_STRESS, 1.0}, {"stress_kPa", ROLE_STRESS, 1e3},
    {"stress_MPa", ROLE_STRESS, 1e6}, {"mode", ROLE_MODE, 1.0},
};
enum { COLUMNS = sizeof columns / sizeof *columns };

/* One field of the row at hand, unquoted. */
typedef struct field {
    char text[FIELD_LENGTH];
    size_t column; /* where it begins, counted from 1 */
} field;

typedef struct table {
    const char *name, *next, *end; /* for messages; the rest of the text */
    size_t line;
    char separator;
    field fields[FIELDS_MAX];
    size_t count;             /* fields of the row at hand */
    size_t kinds[FIELDS_MAX]; /* entry of columns[] for each field */
    size_t width;             /* fields of the header */
    locale_t numbers;
    dea_error *error;
} table;

static dea_status table_fail(const table *t, size_t column, const char *problem, const char *value)
{
    char shown[DEA_TEXT_ROOM] = "";
    if (value) {
        dea_text_clip(value, DEA_TEXT_SHOWN, shown, sizeof shown);
    }
    return dea_fail(t->error, DEA_ERROR_SCENE, "%.300s:%zu:%zu: %s%s%s%s", t->name, t->line, column, problem, value ? " \"" : "",
                    shown, value ? "\"" : "");
}

/* Splits off one field; quotes may hold separators, doubled quotes stand for one. */
static dea_status field_split(table *t, const char *line, const char **at, const char *stop, field *out)
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
            return table_fail(t, (size_t)(next - line), "a control character", NULL);
        }
        if (used + 1 >= sizeof out->text) {
            return table_fail(t, out->column, "this field is too long", NULL);
        }
        out->text[used++] = letter;
    }
    if (open) {
        return table_fail(t, out->column, "a quote is not closed on its line", NULL);
    }
    while (used > 0 && (out->text[used - 1] == ' ' || out->text[used - 1] == '\t')) {
        used--;
    }
    out->text[used] = '\0';
    *at = next;
    return DEA_OK;
}

/* The next line that is neither blank nor a comment, split; count 0 at the end of the text. */
static dea_status row_next(table *t)
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
            if (t->count == FIELDS_MAX) {
                return table_fail(t, (size_t)(at - line) + 1, "too many fields", NULL);
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

static dea_status column_unknown(const table *t, const field *f)
{
    const char *nearest = NULL;
    size_t best = SIZE_MAX;
    for (size_t i = 0; i < COLUMNS; i++) {
        const size_t distance = dea_text_distance(f->text, columns[i].name);
        if (distance < best && dea_text_likely(f->text, distance)) {
            best = distance;
            nearest = columns[i].name;
        }
    }
    char problem[200];
    snprintf(problem, sizeof problem, "unknown column%s%s%s (accepted: stretch, stress_Pa, stress_kPa, stress_MPa, mode):",
             nearest ? " (did you mean " : "", nearest ? nearest : "", nearest ? "?)" : "");
    return table_fail(t, f->column, problem, f->text);
}

static dea_status header_read(table *t, dea_load load)
{
    bool seen[ROLE_MODE + 1] = {false};
    dea_status status = row_next(t);
    if (status != DEA_OK) {
        return status;
    }
    if (t->count == 0) {
        return table_fail(t, 1, "no header row; wanted: stretch, stress_Pa (or _kPa, _MPa) and perhaps mode", NULL);
    }
    for (size_t i = 0; i < t->count; i++) {
        size_t kind = 0;
        while (kind < COLUMNS && strcmp(columns[kind].name, t->fields[i].text) != 0) {
            kind++;
        }
        if (kind == COLUMNS) {
            return column_unknown(t, &t->fields[i]);
        }
        if (seen[columns[kind].role]) {
            return table_fail(t, t->fields[i].column, "a second column of the same kind:", t->fields[i].text);
        }
        seen[columns[kind].role] = true;
        t->kinds[i] = kind;
    }
    t->width = t->count;
    if (!seen[ROLE_STRETCH] || !seen[ROLE_STRESS]) {
        return table_fail(t, 1, seen[ROLE_STRETCH] ? "no column stress_Pa, stress_kPa or stress_MPa" : "no column stretch", NULL);
    }
    if (!seen[ROLE_MODE] && load == DEA_LOAD_UNKNOWN) {
        return table_fail(t, 1, "no column mode, and no load given for the file (uniaxial or equibiaxial)", NULL);
    }
    return DEA_OK;
}

/* A plain decimal number: no hexadecimal, no inf, nothing after it. */
static dea_status number_read(const table *t, const field *f, double *value)
{
    char *end;
    errno = 0;
    *value = strtod_l(f->text, &end, t->numbers);
    if (*f->text == '\0') {
        return table_fail(t, f->column, "an empty field where a number belongs", NULL);
    }
    if (*end != '\0' || f->text[strspn(f->text, "0123456789+-.eE")] != '\0') {
        return table_fail(t, f->column, "not a number:", f->text);
    }
    return isfinite(*value) ? DEA_OK : table_fail(t, f->column, "this number is too large:", f->text);
}

static dea_status point_read(const table *t, dea_fit_point *point)
{
    if (t->count != t->width) {
        char problem[80];
        snprintf(problem, sizeof problem, "%zu fields where the header has %zu", t->count, t->width);
        return table_fail(t, 1, problem, NULL);
    }
    for (size_t i = 0; i < t->count; i++) {
        const field *f = &t->fields[i];
        const role what = columns[t->kinds[i]].role;
        if (what == ROLE_MODE) {
            point->load = dea_load_find(f->text);
            if (point->load == DEA_LOAD_UNKNOWN) {
                return table_fail(t, f->column, "unknown mode (accepted: uniaxial, equibiaxial):", f->text);
            }
            continue;
        }
        double *value = what == ROLE_STRETCH ? &point->stretch : &point->stress;
        const dea_status status = number_read(t, f, value);
        if (status != DEA_OK) {
            return status;
        }
        if (what == ROLE_STRETCH && !(*value > 0.0)) {
            return table_fail(t, f->column, "a stretch is above 0 (1 is the film at rest):", f->text);
        }
        *value *= columns[t->kinds[i]].factor;
    }
    return isfinite(point->stress) ? DEA_OK : table_fail(t, 1, "this stress is too large", NULL);
}

static dea_status table_read(table *t, dea_load load, dea_fit_data *data)
{
    dea_status status = header_read(t, load);
    const size_t before = data->count;
    while (status == DEA_OK) {
        status = row_next(t);
        if (status != DEA_OK || t->count == 0) {
            break;
        }
        dea_fit_point point = {.load = load};
        status = point_read(t, &point);
        if (status == DEA_OK) {
            status = dea_fit_add(data, point, t->error);
        }
    }
    return status == DEA_OK && data->count == before ? table_fail(t, 1, "no measured points below the header", NULL) : status;
}

dea_status dea_fit_parse(const char *text, size_t length, const char *name, dea_load load, dea_fit_data *data, dea_error *error)
{
    const size_t mark = length >= 3 && memcmp(text, "\xef\xbb\xbf", 3) == 0 ? 3 : 0;
    table t = {.name = name, .next = text + mark, .end = text + length, .error = error};
    t.numbers = newlocale(LC_ALL_MASK, "C", (locale_t)0);
    if (!t.numbers) {
        return dea_fail(error, DEA_ERROR_MEMORY, "out of memory");
    }
    t.separator = separator_find(t.next, t.end);
    const size_t before = data->count;
    const dea_status status = table_read(&t, load, data);
    if (status != DEA_OK) {
        data->count = before;
    }
    freelocale(t.numbers);
    return status;
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

dea_status dea_fit_read(const char *path, dea_load load, dea_fit_data *data, dea_error *error)
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
        status = dea_fit_parse(text, length, standard ? "standard input" : path, load, data, error);
    }
    free(text);
    if (!standard) {
        close(fd);
    }
    return status;
}
