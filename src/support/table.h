/* Tables of numbers that users bring, as instruments and spreadsheets write them.
 *
 * Fields stand apart by tab, semicolon, comma or blanks; numbers have a decimal point or, but for commas between the fields, a
 * decimal comma. Byte order mark, CRLF, quotes, blank lines, comments (#) and title lines are passed over. A header names the
 * columns in any order and case, each with its unit ("time_ms", "Voltage (kV)", "Strain [%]", or a row of units below); columns
 * of other names are left alone. */
#ifndef DEA_SUPPORT_TABLE_H
#define DEA_SUPPORT_TABLE_H

#include <locale.h>
#include <stddef.h>

#include "deaspice/status.h"
#include "support/quantity.h"

enum { DEA_TABLE_FIELDS = 64, DEA_TABLE_FIELD = 64, DEA_TABLE_WANTED = 8, DEA_TABLE_TOLD = 400 };

/* A column that the reader of a table looks for. */
typedef struct dea_wanted {
    const char *name;           /* "time" */
    const char *const *aliases; /* further names in small letters, NULL at the end; may be NULL */
    const char *unit;           /* SI unit of its values, "1": a ratio, percent too; NULL: a word */
    const char *assumed;        /* unit where the table names none; NULL: it must name one */
    const char *const *words;   /* what a word may be, NULL at the end */
    bool by_unit;               /* a column of foreign name is this one where no other has a unit of this dimension */
    bool suffixes;              /* numbers may have the scale factors of SPICE (10m, 3k, 1meg) */
} dea_wanted;

/* One field of a line, unquoted. */
typedef struct dea_field {
    char text[DEA_TABLE_FIELD];
    size_t column; /* where it begins, counted from 1 */
} dea_field;

/* A table being read; borrows text, names and wanted columns. */
typedef struct dea_table {
    const char *name;    /* of the file, for messages */
    const char *subject; /* stands between position and message, e.g. "drive.waveform.file: "; may be "" */
    const dea_wanted *wanted;
    size_t wanted_count; /* at most DEA_TABLE_WANTED */
    bool headless;       /* a table without a header is taken too, its columns in the order of the wanted ones */
    bool guarded;        /* a text without a row of numbers is none of the user's tables: nothing of it stands in a message */
    dea_units *units;
    dea_error *error;
    size_t *failed; /* set to the column of a failure, on the line of the table; may be NULL */
    /* found by dea_table_begin() */
    const char *next, *end; /* the rest of the text */
    size_t line;            /* of the row at hand */
    char separator;         /* ' ': any blanks */
    char point;             /* decimal sign */
    size_t width;
    struct {
        size_t wanted; /* wanted_count: none */
        double factor; /* from its unit to SI */
    } columns[DEA_TABLE_FIELDS];
    bool seen[DEA_TABLE_WANTED];       /* the table has that column */
    dea_field names[DEA_TABLE_FIELDS]; /* of the header */
    dea_field fields[DEA_TABLE_FIELDS];
    size_t count;              /* fields of the row at hand */
    char told[DEA_TABLE_TOLD]; /* what each column was taken for, in words */
    locale_t numbers;          /* owned */
} dea_table;

/* Finds form, header and columns of a text; the caller ends the table with dea_table_end(), also after a failure. What a wanted
 * column lacks is the caller's to refuse. DEA_ERROR_SCENE ("name:line:column: ..."), DEA_ERROR_MEMORY. */
dea_status dea_table_begin(dea_table *table, const char *text, size_t length);
void dea_table_end(dea_table *table);
/* The next row: values[i] of wanted column i in SI, of a word its index, NAN where the table has no such column. *more is false
 * at the end of the text. */
dea_status dea_table_row(dea_table *table, double values[DEA_TABLE_WANTED], bool *more);
/* Where in the line of the row at hand wanted column @p wanted begins, counted from 1. */
size_t dea_table_place(const dea_table *table, size_t wanted);
/* Fails at the field of the row at hand that holds wanted column @p wanted, its text in quotes. */
dea_status dea_table_fail_at(const dea_table *table, size_t wanted, const char *problem);
/* Fails because a wanted column is missing: names the columns that there are, and the nearest. @p advice says what to do. */
dea_status dea_table_missing(const dea_table *table, size_t wanted, const char *advice);
/* Fills the error with "name:line:column: problem". */
dea_status dea_table_fail(const dea_table *table, size_t column, const char *problem);

#endif
