/* A waveform from a table: two columns, time_s and voltage_V, with commas between. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "scene/file.h"
#include "scene/reader.h"

enum { ROWS_MAX = 1000000, CELL_LENGTH = 128 };

#define ACCEPTED "two columns, time_s,voltage_V, of numbers in s and V, with . as decimal point"

/* The table being read. */
typedef struct table {
    dea_reader *reader;
    const char *path; /* of the key */
    dea_origin *origin;
    const char *next, *end; /* the rest of the text */
    int line;
    bool numbers; /* a row of numbers is in it: what it holds may be quoted */
} table;

/* Part of a line, without blanks around it. */
typedef struct cell {
    const char *text;
    size_t length;
    int column;
} cell;

typedef struct row {
    cell cells[2];
    size_t count; /* of the cells on the line, which can be more than two */
} row;

static dea_status table_fail(const table *self, int column, const char *what, const cell *culprit, const char *accepted)
{
    const dea_place place = {.origin = self->origin, .line = self->line, .column = column};
    char text[CELL_LENGTH] = "";
    char shown[DEA_TEXT_ROOM] = "";
    if (culprit && self->numbers) {
        snprintf(text, sizeof text, "%.*s", (int)(culprit->length < sizeof text ? culprit->length : sizeof text - 1),
                 culprit->text);
        dea_text_clip(text, DEA_TEXT_SHOWN, shown, sizeof shown);
    }
    return dea_place_fail(&place, self->reader->error, self->path, "%s%s%s%s; accepted: %s", what, shown[0] ? " (" : "", shown,
                          shown[0] ? ")" : "", accepted);
}

static cell cell_trim(const char *line, const char *from, const char *to)
{
    while (from < to && (*from == ' ' || *from == '\t')) {
        from++;
    }
    while (to > from && (to[-1] == ' ' || to[-1] == '\t' || to[-1] == '\r')) {
        to--;
    }
    return (cell){.text = from, .length = (size_t)(to - from), .column = (int)(from - line) + 1};
}

/* The next line that is not blank; false at the end. */
static bool row_next(table *self, row *out)
{
    while (self->next < self->end) {
        const char *line = self->next;
        const char *stop = memchr(line, '\n', (size_t)(self->end - line));
        stop = stop ? stop : self->end;
        self->next = stop < self->end ? stop + 1 : stop;
        self->line++;
        if (cell_trim(line, line, stop).length == 0) {
            continue;
        }
        out->count = 0;
        for (const char *at = line; at && at <= stop; out->count++) {
            const char *comma = memchr(at, ',', (size_t)(stop - at));
            if (out->count < 2) {
                out->cells[out->count] = cell_trim(line, at, comma ? comma : stop);
            }
            at = comma ? comma + 1 : NULL;
        }
        return true;
    }
    return false;
}

static bool cell_is(const cell *self, const char *word)
{
    return self->length == strlen(word) && memcmp(self->text, word, self->length) == 0;
}

/* A row that does not begin with a number is a header, which names the units and so must be right. */
static dea_status header_check(const table *self, const row *first, bool *header)
{
    double number = 0.0;
    *header = !dea_number_read(self->reader->units, first->cells[0].text, first->cells[0].length, &number);
    if (!*header || (first->count == 2 && cell_is(&first->cells[0], "time_s") && cell_is(&first->cells[1], "voltage_V"))) {
        return DEA_OK;
    }
    return table_fail(self, first->cells[0].column, "neither a number nor the header", &first->cells[0], ACCEPTED);
}

static dea_status row_read(const table *self, const row *at, size_t index)
{
    dea_waveform *waveform = &self->reader->scene->drive.waveform;
    double *const numbers[] = {&waveform->times[index], &waveform->voltages[index]};
    if (at->count != 2) {
        return table_fail(self, 1, at->count < 2 ? "one column" : "more than two columns", NULL, ACCEPTED);
    }
    for (size_t i = 0; i < 2; i++) {
        if (!dea_number_read(self->reader->units, at->cells[i].text, at->cells[i].length, numbers[i])) {
            return table_fail(self, at->cells[i].column, "not a number of double precision", &at->cells[i], ACCEPTED);
        }
    }
    const char *fault = dea_points_fault(waveform, index);
    return fault ? table_fail(self, at->cells[0].column, fault, &at->cells[0], "times >= 0 that increase strictly") : DEA_OK;
}

/* A line of numbers with something between them, in whatever format. */
static bool is_of_numbers(const char *line, const char *stop)
{
    bool digit = false, apart = false;
    for (const char *at = line; at < stop; at++) {
        digit = digit || (*at >= '0' && *at <= '9');
        apart = apart || (digit && strchr(",; \t", *at));
        if (!*at || !strchr("0123456789+-.eE,; \t\r", *at)) {
            return false;
        }
    }
    return apart;
}

/* Is the file a table at all? What else it may be, a message is no place for. */
static bool has_numbers(const table *self)
{
    const char *stop;
    for (const char *line = self->next; line < self->end; line = stop + 1) {
        stop = memchr(line, '\n', (size_t)(self->end - line));
        stop = stop ? stop : self->end;
        if (is_of_numbers(line, stop)) {
            return true;
        }
    }
    return false;
}

static size_t lines_of(const table *self)
{
    size_t lines = 1;
    for (const char *at = self->next; (at = memchr(at, '\n', (size_t)(self->end - at))); at++) {
        lines++;
    }
    return lines;
}

static dea_status rows_read(table *self)
{
    row at;
    bool header = true;
    size_t count = 0;
    const size_t lines = lines_of(self);
    dea_status status = dea_points_new(self->reader, lines < ROWS_MAX ? lines : ROWS_MAX);
    for (bool first = true; !status && row_next(self, &at); first = false) {
        header = false;
        status = first ? header_check(self, &at, &header) : DEA_OK;
        if (!status && !header && count == ROWS_MAX) {
            return table_fail(self, 1, "too many rows", NULL, "at most 1000000");
        }
        if (!status && !header) {
            status = row_read(self, &at, count++);
        }
    }
    self->reader->scene->drive.waveform.point_count = count;
    self->line += self->line == 0;
    return status || count > 0 ? status : table_fail(self, 1, "no row of numbers", NULL, ACCEPTED);
}

static dea_status table_read(table *self, const char *text, size_t length)
{
    int column = 1;
    if (!dea_tree_text_clean(text, length, &self->line, &column)) {
        return table_fail(self, column, "not a text: a control character, or bytes that are not UTF-8", NULL, ACCEPTED);
    }
    const size_t mark = length >= 3 && memcmp(text, "\xEF\xBB\xBF", 3) == 0 ? 3 : 0;
    self->next = text + mark;
    self->end = text + length;
    self->line = 0;
    self->numbers = has_numbers(self);
    if (self->numbers) {
        self->origin->text = text;
        self->origin->length = length;
    }
    return rows_read(self);
}

dea_status dea_read_wave_file(dea_reader *reader, const dea_ref *ref, const dea_node *node)
{
    char shown[DEA_TEXT_ROOM];
    char *text = NULL;
    size_t length = 0;
    const char *refused = NULL;
    if (node->kind != DEA_NODE_SCALAR || !node->text[0]) {
        return dea_reader_refuse(reader, ref, node, node->kind == DEA_NODE_SCALAR ? "has no value" : "not a file name");
    }
    const dea_status named = dea_reader_names_file(reader, ref, node);
    if (named) {
        return named;
    }
    char *path = dea_reader_path(reader, node);
    dea_origin *origin = path ? dea_reader_origin(reader, path) : NULL;
    const dea_status read =
        origin ? dea_file_read(path, false, DEA_WAVE_FILE_MAX, &text, &length, reader->scene->files, &refused) : DEA_ERROR_MEMORY;
    if (read == DEA_ERROR_MEMORY) {
        return dea_reader_memory(reader);
    }
    if (read) {
        return dea_place_fail(&node->place, reader->error, ref->path, "cannot read the file %s: %s", dea_reader_show(node, shown),
                              refused);
    }
    table self = {.reader = reader, .path = ref->path, .origin = origin};
    const dea_status status = table_read(&self, text, length);
    free(text);
    return status;
}
