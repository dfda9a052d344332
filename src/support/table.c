#define _GNU_SOURCE /* strtod_l */
#include "support/table.h"

#include <ctype.h>
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "support/text.h"

enum {
    LOOK_AHEAD = 1000, /* rows that tell whether numbers have a decimal comma */
    HEADER_LINES = 40, /* lines of title and header before the first row */
    UNIT_ROOM = 32,    /* longest unit */
    NUMERIC_LEAST = 2  /* numbers that make a line a row */
};

/* A line of the text. */
typedef struct line {
    const char *start, *stop;
    size_t number;
    bool comment;
} line;

dea_status dea_table_fail(const dea_table *t, size_t column, const char *problem)
{
    if (t->failed) {
        *t->failed = column;
    }
    return dea_fail(t->error, DEA_ERROR_SCENE, "%.300s:%zu:%zu: %s%s", t->name, t->line, column, t->subject ? t->subject : "",
                    problem);
}

static dea_status fail_field(const dea_table *t, const dea_field *f, const char *problem)
{
    char shown[DEA_TEXT_ROOM];
    char whole[DEA_TEXT_ROOM + 300];
    if (t->guarded) {
        return dea_table_fail(t, f->column, problem);
    }
    snprintf(whole, sizeof whole, "%s \"%s\"", problem, dea_text_clip(f->text, DEA_TEXT_SHOWN, shown, sizeof shown));
    return dea_table_fail(t, f->column, whole);
}

static bool is_blank(char letter)
{
    return letter == ' ' || letter == '\t';
}

/* The next line that is not blank; false at the end. */
static bool line_next(const char **next, const char *end, line *out)
{
    while (*next < end) {
        const char *start = *next;
        const char *stop = start;
        while (stop < end && *stop != '\n' && *stop != '\r') {
            stop++;
        }
        *next = stop < end ? stop + 1 : stop;
        *next += stop + 1 < end && stop[0] == '\r' && stop[1] == '\n';
        out->number++;
        const char *first = start;
        while (first < stop && is_blank(*first)) {
            first++;
        }
        if (first < stop) {
            out->start = start;
            out->stop = stop;
            out->comment = *first == '#';
            return true;
        }
    }
    return false;
}

static bool parts(char separator, char letter)
{
    return separator == ' ' ? is_blank(letter) : letter == separator;
}

/* Takes the text of one field, quotes off it, a doubled quote as one; returns what is wrong with it, NULL: nothing. */
static const char *field_take(char separator, const char **at, const char *stop, dea_field *out)
{
    const char *next = *at;
    size_t used = 0;
    const bool quoted = next < stop && *next == '"';
    bool open = quoted;
    next += quoted;
    while (next < stop && (open || !parts(separator, *next))) {
        const char letter = *next++;
        if (letter == '"' && open) {
            open = next < stop && *next == '"';
            if (!open) {
                continue;
            }
            next++;
        } else if (iscntrl((unsigned char)letter) && letter != '\t') {
            return "a control character";
        }
        if (used + 1 >= sizeof out->text) {
            return "this field is too long";
        }
        out->text[used++] = letter;
    }
    while (used > 0 && is_blank(out->text[used - 1])) {
        used--;
    }
    out->text[used] = '\0';
    *at = next;
    return open ? "a quote is not closed on its line" : NULL;
}

/* Splits a line into fields; returns what is wrong with the last of them, NULL: nothing. */
static const char *split(char separator, const line *row, dea_field *fields, size_t *count)
{
    const char *at = row->start;
    for (*count = 0;; at++) {
        while (at < row->stop && is_blank(*at) && separator != *at) {
            at++;
        }
        if (at >= row->stop && (separator == ' ' || is_blank(separator)) && *count > 0) {
            return NULL; /* blanks at the end of the line hold no field */
        }
        if (*count == DEA_TABLE_FIELDS) {
            return "too many fields";
        }
        dea_field *field = &fields[(*count)++];
        field->column = (size_t)(at - row->start) + 1;
        const char *wrong = field_take(separator, &at, row->stop, field);
        if (wrong || at >= row->stop) {
            return wrong;
        }
    }
}

/* Factor of a scale suffix of SPICE, whatever its case, and of the unit letters behind it; 0 for other text. */
static double suffix_factor(const char *text)
{
    static const struct {
        const char *name;
        double factor;
    } suffixes[] = {{"meg", 1e6}, {"t", 1e12}, {"g", 1e9},   {"k", 1e3},   {"m", 1e-3},
                    {"u", 1e-6},  {"n", 1e-9}, {"p", 1e-12}, {"f", 1e-15}, {"", 1.0}};
    char small[8] = "";
    for (size_t i = 0; text[i]; i++) {
        if (i + 1 >= sizeof small) {
            return 0.0;
        }
        small[i] = (char)tolower((unsigned char)text[i]);
    }
    for (size_t i = 0; i < sizeof suffixes / sizeof *suffixes; i++) {
        const size_t length = strlen(suffixes[i].name);
        const char *unit = small + length;
        if (strncmp(small, suffixes[i].name, length) == 0 && (!*unit || strcmp(unit, "s") == 0 || strcmp(unit, "v") == 0)) {
            return suffixes[i].factor;
        }
    }
    return 0.0;
}

/* Reads a plain decimal number, with a suffix where @p suffixes. */
static bool number_read(const dea_table *t, const char *text, char point, bool suffixes, double *value)
{
    char plain[DEA_TABLE_FIELD];
    char *end;
    const size_t digits = strspn(text, "0123456789+-.,eE");
    if (strchr(text, point == '.' ? ',' : '.')) {
        return false; /* of the other kind, or a mark between thousands: too little to go by */
    }
    snprintf(plain, sizeof plain, "%s", text);
    for (char *comma = plain; point == ',' && (comma = strchr(comma, ',')); *comma = '.') {
    }
    *value = strtod_l(plain, &end, t->numbers);
    if (end == plain || (size_t)(end - plain) > digits) {
        return false;
    }
    end += *end == ' ';
    const double factor = *end == '\0' ? 1.0 : suffixes ? suffix_factor(end) : 0.0;
    *value = dea_unit_scale(*value, factor > 0.0 ? factor : 1.0);
    return factor > 0.0;
}

static bool any_suffixes(const dea_table *t)
{
    for (size_t i = 0; i < t->wanted_count; i++) {
        if (t->wanted[i].suffixes) {
            return true;
        }
    }
    return false;
}

static bool is_numeric(const dea_table *t, const char *text)
{
    double value;
    const bool suffixes = any_suffixes(t);
    return number_read(t, text, '.', suffixes, &value) || number_read(t, text, ',', suffixes, &value);
}

/* Fields of a line that are numbers, and whether all are; 0 where the line does not split. */
static size_t count_numbers(dea_table *t, char separator, const line *row, bool *all)
{
    size_t numbers = 0;
    t->count = 0;
    if (row->comment || split(separator, row, t->fields, &t->count)) {
        return 0;
    }
    for (size_t i = 0; i < t->count; i++) {
        numbers += is_numeric(t, t->fields[i].text);
    }
    *all = numbers == t->count;
    return numbers;
}

/* The first row: a line of two numbers or more, followed, where there is another line, by one of the same kind. A first pass
 * takes only rows that are all numbers, so that "0,5 3000,2" is two numbers and not three fields. */
static bool first_row(dea_table *t, char separator, bool strict, line *first)
{
    const char *next = t->next;
    line row = {.number = 0};
    for (size_t lines = 0; lines < HEADER_LINES && line_next(&next, t->end, &row); lines++) {
        bool all = false, all_after = false;
        const size_t numbers = count_numbers(t, separator, &row, &all);
        const size_t width = t->count;
        if (numbers < NUMERIC_LEAST || (strict && !all)) {
            continue;
        }
        const char *rest = next;
        line after = row;
        bool found = false;
        while (!found && line_next(&rest, t->end, &after)) {
            found = !after.comment;
        }
        if (!found || (count_numbers(t, separator, &after, &all_after) == numbers && t->count == width)) {
            *first = row;
            t->width = width;
            return true;
        }
    }
    return false;
}

/* Where a field of the first rows has a comma, commas are decimal ones. */
static char point_of(dea_table *t, const line *first)
{
    const char *next = first->start;
    line row = {.number = 0};
    for (size_t i = 0; t->separator != ',' && i < LOOK_AHEAD && line_next(&next, t->end, &row); i++) {
        if (row.comment || split(t->separator, &row, t->fields, &t->count)) {
            continue;
        }
        for (size_t k = 0; k < t->count; k++) {
            if (strchr(t->fields[k].text, ',') && is_numeric(t, t->fields[k].text)) {
                return ',';
            }
        }
    }
    return '.';
}

static const char separators[] = {'\t', ';', ',', ' '};

/* Any line of numbers alone, in whatever form. */
static bool has_numbers(dea_table *t)
{
    const char *next = t->next;
    line row = {.number = 0};
    while (line_next(&next, t->end, &row)) {
        for (size_t i = 0; i < sizeof separators; i++) {
            bool all = false;
            if (count_numbers(t, separators[i], &row, &all) >= NUMERIC_LEAST && all) {
                return true;
            }
        }
    }
    return false;
}

static bool form_find(dea_table *t, line *first)
{
    for (int strict = 1; strict >= 0; strict--) {
        for (size_t i = 0; i < sizeof separators; i++) {
            if (first_row(t, separators[i], strict, first)) {
                t->separator = separators[i];
                t->point = point_of(t, first);
                return true;
            }
        }
    }
    return false;
}

/* Letters and digits of a name in small letters, one blank for all that stands between; an apostrophe is a prime (E'). */
static void plain_name(const char *text, size_t length, char out[DEA_TABLE_FIELD])
{
    static const char prime[] = "prime";
    size_t used = 0;
    for (size_t i = 0; i < length && used + 2 < DEA_TABLE_FIELD; i++) {
        const unsigned char letter = (unsigned char)text[i];
        if (letter == '\'' && used + strlen(prime) + 2 < DEA_TABLE_FIELD) {
            used += (size_t)snprintf(out + used, DEA_TABLE_FIELD - used, "%s", prime);
        } else if (isalnum(letter) || letter >= 0x80) {
            out[used++] = (char)tolower(letter);
        } else if (used > 0 && out[used - 1] != ' ') {
            out[used++] = ' ';
        }
    }
    used -= used > 0 && out[used - 1] == ' ';
    out[used] = '\0';
}

/* The wanted column of that name, wanted_count: none. */
static size_t wanted_find(const dea_table *t, const char *text, size_t length)
{
    char name[DEA_TABLE_FIELD];
    plain_name(text, length, name);
    for (size_t i = 0; i < t->wanted_count; i++) {
        const char *const *alias = t->wanted[i].aliases;
        bool same = strcmp(name, t->wanted[i].name) == 0;
        for (; alias && *alias && !same; alias++) {
            same = strcmp(name, *alias) == 0;
        }
        if (same) {
            return i;
        }
    }
    return t->wanted_count;
}

static bool converts(const dea_table *t, size_t wanted, const char *unit, double *factor)
{
    const char *target = t->wanted[wanted].unit;
    return target && dea_unit_factor(t->units, unit, target, factor);
}

/* What a heading says: the wanted column, and its unit, "" where it names none. */
typedef struct heading {
    size_t wanted;
    char unit[UNIT_ROOM];
} heading;

static void unit_take(heading *h, const char *from, size_t length)
{
    while (length > 0 && strchr("([ ])", from[0])) {
        from++;
        length--;
    }
    while (length > 0 && strchr("([ ])", from[length - 1])) {
        length--;
    }
    snprintf(h->unit, sizeof h->unit, "%.*s", (int)(length < sizeof h->unit ? length : 0), from);
}

/* "time_ms", "Voltage (kV)", "Strain [%]", "stress / MPa", "time ms", "(s)": the unit stands last. */
static heading heading_read(const dea_table *t, const char *text)
{
    heading h = {.wanted = t->wanted_count};
    const char *mark = strpbrk(text, "([/");
    if (!mark) {
        h.wanted = wanted_find(t, text, strlen(text));
    }
    if (!mark && h.wanted == t->wanted_count) {
        const char *joint = strrchr(text, '_'), *blank = strrchr(text, ' ');
        mark = joint > blank || !blank ? joint : blank;
    }
    if (mark && *mark == '/' && wanted_find(t, text, (size_t)(mark - text)) == t->wanted_count) { /* omega_rad/s */
        const char *joint = strchr(text, '_');
        mark = joint && joint < mark ? joint : mark;
    }
    if (mark) {
        h.wanted = wanted_find(t, text, (size_t)(mark - text));
        const size_t skip = *mark == '/' || *mark == '_';
        unit_take(&h, mark + skip, strlen(mark + skip));
    }
    return h;
}

/* Headings that name what is looked for; a line with a number in it has none. */
static size_t count_wanted(const dea_table *t, const dea_field *fields)
{
    size_t named = 0;
    for (size_t i = 0; i < t->width; i++) {
        if (is_numeric(t, fields[i].text)) {
            return 0;
        }
        named += heading_read(t, fields[i].text).wanted < t->wanted_count;
    }
    return named;
}

/* A row of units holds nothing else, and one at least that is looked for. */
static bool all_units(const dea_table *t, const dea_field *fields)
{
    size_t looked_for = 0;
    for (size_t i = 0; i < t->width; i++) {
        heading h;
        double factor;
        bool known = !fields[i].text[0];
        unit_take(&h, fields[i].text, strlen(fields[i].text));
        for (size_t k = 0; k < t->wanted_count && !known; k++) {
            known = converts(t, k, h.unit, &factor);
            looked_for += known;
        }
        if (is_numeric(t, fields[i].text) || (!known && !dea_unit_factor(t->units, h.unit, h.unit, &factor))) {
            return false;
        }
    }
    return looked_for > 0;
}

/* A heading with blanks in it, split at them, is put together again: "Time (s)" and a bracket belong to the word before. */
static void join_brackets(dea_field *fields, size_t *count)
{
    size_t kept = 0;
    for (size_t i = 0; i < *count; i++) {
        const bool bracket = kept > 0 && strchr("([/", fields[i].text[0]) && fields[i].text[0];
        if (bracket) {
            dea_field *before = &fields[kept - 1];
            const size_t used = strlen(before->text);
            snprintf(before->text + used, sizeof before->text - used, " %s", fields[i].text);
        } else {
            fields[kept++] = fields[i];
        }
    }
    *count = kept;
}

/* Splits a line of the head as the rows are split; false where it does not have their width. */
static bool head_split(dea_table *t, const line *head, dea_field *fields)
{
    size_t count = 0;
    line text = *head;
    while (text.comment && text.start < text.stop && (is_blank(*text.start) || *text.start == '#')) {
        text.start++;
    }
    if (split(t->separator, &text, fields, &count)) {
        return false;
    }
    if (t->separator == ' ') {
        join_brackets(fields, &count);
    }
    t->count = count;
    return count == t->width;
}

/* The two last lines before the first row. */
typedef struct head {
    line above, beyond;
    size_t lines;
    line comment; /* the last comment */
    bool commented;
} head;

static head head_find(const dea_table *t, const line *first)
{
    head found = {.lines = 0};
    const char *next = t->next;
    line row = {.number = 0};
    while (line_next(&next, t->end, &row) && row.start < first->start) {
        if (row.comment) {
            found.comment = row;
            found.commented = true;
        } else {
            found.beyond = found.above;
            found.above = row;
            found.lines++;
        }
    }
    return found;
}

static dea_status note_column(dea_table *t, size_t column, const heading *h, const dea_field *field)
{
    const dea_wanted *wanted = &t->wanted[h->wanted];
    const char *unit = h->unit[0] ? h->unit : wanted->assumed;
    char problem[200];
    double factor = 1.0;
    if (t->seen[h->wanted]) {
        return fail_field(t, field, "a second column of the same kind; give the one that is not meant another name:");
    }
    if (wanted->unit && !unit) {
        snprintf(problem, sizeof problem, "a column without unit (write e.g. %s_k%s):", wanted->name, wanted->unit);
        return fail_field(t, field, problem);
    }
    if (wanted->unit && !dea_unit_factor(t->units, unit, wanted->unit, &factor)) {
        snprintf(problem, sizeof problem, "the unit does not convert to %s:", wanted->unit);
        return fail_field(t, field, problem);
    }
    t->seen[h->wanted] = true;
    t->columns[column].wanted = h->wanted;
    t->columns[column].factor = factor;
    return DEA_OK;
}

/* A foreign name with the unit of a column that is still looked for, the only one of its dimension. */
static dea_status take_by_unit(dea_table *t, const heading *headings, const dea_field *fields)
{
    for (size_t k = 0; k < t->wanted_count; k++) {
        size_t matches = 0, column = 0;
        double factor;
        for (size_t i = 0; i < t->width && t->wanted[k].by_unit && !t->seen[k]; i++) {
            if (t->columns[i].wanted == t->wanted_count && headings[i].unit[0] && converts(t, k, headings[i].unit, &factor)) {
                matches++;
                column = i;
            }
        }
        heading h = headings[column];
        h.wanted = k;
        const dea_status status = matches == 1 ? note_column(t, column, &h, &fields[column]) : DEA_OK;
        if (status != DEA_OK) {
            return status;
        }
    }
    return DEA_OK;
}

/* Where a unit does not fit a column, but another that may have the same name, it is that one: a frequency in rad/s. */
static void turn_to_unit(const dea_table *t, heading *h)
{
    double factor;
    if (!h->unit[0] || converts(t, h->wanted, h->unit, &factor)) {
        return;
    }
    const char *name = t->wanted[h->wanted].name;
    for (size_t i = 0; i < t->wanted_count; i++) {
        const char *const *alias = t->wanted[i].aliases;
        for (; alias && *alias; alias++) {
            if (i != h->wanted && strcmp(*alias, name) == 0 && converts(t, i, h->unit, &factor)) {
                h->wanted = i;
                return;
            }
        }
    }
}

static dea_status take_columns(dea_table *t, const dea_field *names, const dea_field *units)
{
    heading headings[DEA_TABLE_FIELDS];
    for (size_t i = 0; i < t->width; i++) {
        headings[i] = heading_read(t, names[i].text);
        if (!headings[i].unit[0] && units) {
            unit_take(&headings[i], units[i].text, strlen(units[i].text));
        }
        const bool named = headings[i].wanted < t->wanted_count;
        if (named) {
            turn_to_unit(t, &headings[i]);
        }
        const dea_status status = named ? note_column(t, i, &headings[i], &names[i]) : DEA_OK;
        if (status != DEA_OK) {
            return status;
        }
    }
    return take_by_unit(t, headings, names);
}

/* What was taken for what, in words; @p names NULL: there is no header. */
static void tell(dea_table *t, const dea_field *names, const dea_field *units)
{
    size_t used = 0;
    t->told[0] = '\0';
    for (size_t i = 0; i < t->width && used + 1 < sizeof t->told; i++) {
        const size_t wanted = t->columns[i].wanted;
        char shown[DEA_TEXT_ROOM] = "";
        char unit[UNIT_ROOM + 4] = "";
        if (names) {
            dea_text_clip(names[i].text, 24, shown, sizeof shown);
        }
        if (wanted < t->wanted_count && t->wanted[wanted].unit && (!names || (units && units[i].text[0]))) {
            const char *text = names ? units[i].text : t->wanted[wanted].assumed;
            heading h;
            unit_take(&h, text, strlen(text));
            snprintf(unit, sizeof unit, " [%s]", h.unit);
        }
        const int more =
            snprintf(t->told + used, sizeof t->told - used, "%scolumn %zu%s%s%s%s %s%s", i ? ", " : "", i + 1, names ? " \"" : "",
                     shown, names ? "\"" : "", unit, wanted < t->wanted_count ? "is the " : "is left alone",
                     wanted < t->wanted_count ? t->wanted[wanted].name : "");
        used += more > 0 ? (size_t)more : 0;
    }
}

static dea_status take_told(dea_table *t, const dea_field *units)
{
    const dea_status status = take_columns(t, t->names, units);
    tell(t, t->names, units);
    return status;
}

static dea_status take_order(dea_table *t)
{
    for (size_t i = 0; i < t->width && i < t->wanted_count; i++) {
        const dea_field field = {.column = 1};
        const heading h = {.wanted = i};
        const dea_status status = note_column(t, i, &h, &field);
        if (status != DEA_OK) {
            return status;
        }
    }
    tell(t, NULL, NULL);
    return DEA_OK;
}

static dea_status without_header(dea_table *t, const head *found)
{
    char problem[300] = "no header row that names the columns:";
    size_t used = strlen(problem);
    if (found->commented && head_split(t, &found->comment, t->names) && count_wanted(t, t->names) > 0) {
        t->line = found->comment.number;
        return take_told(t, NULL);
    }
    for (size_t i = 0; i < t->wanted_count; i++) {
        const int more = snprintf(problem + used, sizeof problem - used, "%s %s", i ? "," : "", t->wanted[i].name);
        used += more > 0 && used + (size_t)more < sizeof problem ? (size_t)more : 0;
    }
    return t->headless ? take_order(t) : dea_table_fail(t, 1, problem);
}

/* A heading of foreign name whose unit is that of a column which may be told by it. */
static bool told_by_unit(const dea_table *t, const heading *h)
{
    double factor;
    bool told = false;
    for (size_t k = 0; k < t->wanted_count && h->unit[0] && h->wanted == t->wanted_count; k++) {
        told = told || (t->wanted[k].by_unit && converts(t, k, h->unit, &factor));
    }
    return told;
}

/* How many headings tell what is looked for, by a name, or two and more by their units; a line with a number in it tells nothing. */
static size_t count_told(const dea_table *t, const dea_field *fields)
{
    const size_t named = count_wanted(t, fields);
    size_t units = 0;
    for (size_t i = 0; i < t->width; i++) {
        const heading h = heading_read(t, fields[i].text);
        units += told_by_unit(t, &h);
        if (is_numeric(t, fields[i].text)) {
            return 0;
        }
    }
    return named > 0 || units > 1 ? named + units : 0;
}

/* The line of the head that tells most of what is looked for, and how its fields stand apart; false where none does. */
static bool names_find(dea_table *t, line *names)
{
    const char *next = t->next;
    line row = {.number = 0};
    size_t most = 0;
    for (size_t lines = 0; lines < HEADER_LINES && line_next(&next, t->end, &row); lines++) {
        for (size_t i = 0; i < sizeof separators && !row.comment; i++) {
            dea_table trial = *t;
            trial.separator = separators[i];
            (void)head_split(&trial, &row, trial.names);
            trial.width = trial.count;
            const size_t told = count_told(&trial, trial.names);
            if (told > most) {
                most = told;
                *names = row;
                t->separator = separators[i];
            }
        }
    }
    return most > 0;
}

/* Rows follow the line of names, and a line of units where there is one. */
static dea_status named_begin(dea_table *t, const line *names)
{
    dea_field units[DEA_TABLE_FIELDS];
    const char *next = names->stop;
    line row = {.number = names->number - 1};
    (void)head_split(t, names, t->names);
    t->width = t->count;
    t->next = names->start;
    (void)line_next(&t->next, t->end, &row); /* passes the names */
    t->line = names->number;
    next = t->next;
    line below = row;
    const bool has_units =
        line_next(&next, t->end, &below) && !below.comment && head_split(t, &below, units) && all_units(t, units);
    const dea_status status = take_told(t, has_units ? units : NULL);
    if (has_units) {
        t->next = next;
        t->line = below.number;
    }
    const line first = {.start = t->next};
    t->point = point_of(t, &first);
    return status;
}

/* Nothing is named: units, a comment above the rows, or the order of the columns tell them. */
static dea_status nameless_begin(dea_table *t)
{
    line first;
    if (!form_find(t, &first)) {
        return dea_table_fail(t, 1, "no row of two or more numbers, apart by comma, semicolon, tab or blanks, and no header");
    }
    const head found = head_find(t, &first);
    dea_status status;
    t->line = found.lines > 0 ? found.above.number : first.number;
    if (found.lines > 0 && head_split(t, &found.above, t->names) && all_units(t, t->names)) {
        dea_field units[DEA_TABLE_FIELDS];
        memcpy(units, t->names, sizeof units);
        if (found.lines > 1 && !head_split(t, &found.beyond, t->names)) {
            memcpy(t->names, units, sizeof units);
        }
        status = take_told(t, units);
    } else {
        status = without_header(t, &found);
    }
    t->next = first.start;
    t->line = first.number - 1;
    return status;
}

dea_status dea_table_begin(dea_table *t, const char *text, size_t length)
{
    static const char mark[] = "\xef\xbb\xbf";
    line names;
    t->next = text + (length >= 3 && memcmp(text, mark, 3) == 0 ? 3 : 0);
    t->end = text + length;
    t->line = 1;
    t->numbers = newlocale(LC_ALL_MASK, "C", (locale_t)0);
    if (!t->numbers) {
        return dea_fail(t->error, DEA_ERROR_MEMORY, "out of memory");
    }
    for (size_t i = 0; i < DEA_TABLE_FIELDS; i++) {
        t->columns[i].wanted = t->wanted_count;
    }
    if (length >= 2 && (memcmp(text, "\xff\xfe", 2) == 0 || memcmp(text, "\xfe\xff", 2) == 0)) {
        return dea_table_fail(t, 1, "text in UTF-16, as \"Unicode text\" of spreadsheets; save it as CSV, in UTF-8");
    }
    t->guarded = t->guarded && !has_numbers(t);
    return names_find(t, &names) ? named_begin(t, &names) : nameless_begin(t);
}

void dea_table_end(dea_table *t)
{
    if (t->numbers) {
        freelocale(t->numbers);
        t->numbers = (locale_t)0;
    }
}

static dea_status word_read(const dea_table *t, const dea_field *field, const dea_wanted *wanted, double *value)
{
    size_t index = 0;
    while (wanted->words[index] && strcmp(wanted->words[index], field->text) != 0) {
        index++;
    }
    *value = (double)index;
    if (wanted->words[index]) {
        return DEA_OK;
    }
    char problem[200];
    int used = snprintf(problem, sizeof problem, "unknown %s (accepted:", wanted->name);
    for (size_t i = 0; wanted->words[i] && (size_t)used < sizeof problem; i++) {
        used += snprintf(problem + used, sizeof problem - (size_t)used, "%s %s", i ? "," : "", wanted->words[i]);
    }
    snprintf(problem + strlen(problem), sizeof problem - strlen(problem), "):");
    return fail_field(t, field, problem);
}

static dea_status field_read(const dea_table *t, size_t column, double values[DEA_TABLE_WANTED])
{
    const dea_field *field = &t->fields[column];
    const dea_wanted *wanted = &t->wanted[t->columns[column].wanted];
    double *value = &values[t->columns[column].wanted];
    if (!wanted->unit) {
        return word_read(t, field, wanted, value);
    }
    if (!field->text[0]) {
        return dea_table_fail(t, field->column, "an empty field where a number belongs");
    }
    if (!number_read(t, field->text, t->point, wanted->suffixes, value)) {
        return fail_field(t, field,
                          t->point == ',' ? "not a number (with decimal comma, as in the first rows):" : "not a number:");
    }
    *value = dea_unit_scale(*value, t->columns[column].factor);
    return isfinite(*value) ? DEA_OK : fail_field(t, field, "this number is too large:");
}

dea_status dea_table_row(dea_table *t, double values[DEA_TABLE_WANTED], bool *more)
{
    line row = {.number = t->line, .comment = true};
    do {
        *more = line_next(&t->next, t->end, &row);
    } while (*more && row.comment);
    t->line = row.number;
    for (size_t i = 0; i < DEA_TABLE_WANTED; i++) {
        values[i] = NAN;
    }
    if (!*more) {
        return DEA_OK;
    }
    const char *wrong = split(t->separator, &row, t->fields, &t->count);
    if (wrong) {
        return dea_table_fail(t, t->count ? t->fields[t->count - 1].column : 1, wrong);
    }
    if (t->count != t->width) {
        char problem[140];
        snprintf(problem, sizeof problem, "%zu field%s where the header has %zu%s", t->count, t->count == 1 ? "" : "s", t->width,
                 t->separator == ',' && t->count == 2 * t->width ? "; a decimal comma wants ; or a tab between the fields" : "");
        return dea_table_fail(t, 1, problem);
    }
    dea_status status = DEA_OK;
    for (size_t i = 0; i < t->width && status == DEA_OK; i++) {
        status = t->columns[i].wanted < t->wanted_count ? field_read(t, i, values) : DEA_OK;
    }
    return status;
}

static const dea_field *field_of(const dea_table *t, size_t wanted)
{
    size_t column = 0;
    while (column + 1 < t->width && t->columns[column].wanted != wanted) {
        column++;
    }
    return &t->fields[column];
}

size_t dea_table_place(const dea_table *t, size_t wanted)
{
    return field_of(t, wanted)->column;
}

dea_status dea_table_fail_at(const dea_table *t, size_t wanted, const char *problem)
{
    return fail_field(t, field_of(t, wanted), problem);
}

dea_status dea_table_missing(const dea_table *t, size_t wanted, const char *advice)
{
    char problem[DEA_TABLE_TOLD + 300];
    bool likely = false;
    if (t->guarded) {
        snprintf(problem, sizeof problem, "no column of %s; %s", t->wanted[wanted].name, advice);
        return dea_table_fail(t, 1, problem);
    }
    for (size_t i = 0; i < t->width; i++) {
        const char *name = t->names[i].text;
        char bare[DEA_TABLE_FIELD];
        snprintf(bare, sizeof bare, "%.*s", (int)strcspn(name, "_ (["), name);
        if (t->columns[i].wanted == t->wanted_count && dea_text_likely(bare, dea_text_distance(bare, t->wanted[wanted].name))) {
            likely = true;
            snprintf(problem, sizeof problem, "no column of %s; did you mean \"%s\"? (%s)", t->wanted[wanted].name, bare,
                     t->told);
        }
    }
    if (!likely) {
        snprintf(problem, sizeof problem, "no column of %s (%s); %s", t->wanted[wanted].name, t->told, advice);
    }
    return dea_table_fail(t, 1, problem);
}
