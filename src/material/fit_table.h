/* Tables of measured points: a header that names the columns with their units, then rows of numbers and words. */
#ifndef DEA_MATERIAL_FIT_TABLE_H
#define DEA_MATERIAL_FIT_TABLE_H

#include <locale.h>
#include <stddef.h>

#include "deaspice/status.h"

enum { DEA_TABLE_FIELDS = 64, DEA_TABLE_FIELD_LENGTH = 64, DEA_TABLE_ROLES = 8 };

/* A column that a table may have. */
typedef struct dea_column {
    const char *name;
    int role;      /* what it holds, 0 ... DEA_TABLE_ROLES - 1; one column of each role in a table */
    double factor; /* from its unit to SI */
} dea_column;

/* One field of the row at hand, unquoted. */
typedef struct dea_field {
    char text[DEA_TABLE_FIELD_LENGTH];
    size_t column;           /* where it begins, counted from 1 */
    const dea_column *holds; /* set once the header is read */
} dea_field;

/* A table being read; borrows its text and columns. */
typedef struct dea_table {
    const char *name, *next, *end; /* for messages; the rest of the text */
    const dea_column *columns;     /* accepted ones */
    size_t column_count;
    const char *accepted; /* the same in words */
    const char *advice;   /* how to get them from what test machines write */
    size_t line;
    char separator;
    dea_field fields[DEA_TABLE_FIELDS];
    size_t count;               /* fields of the row at hand */
    size_t width;               /* fields of the header */
    bool seen[DEA_TABLE_ROLES]; /* roles that the header has */
    locale_t numbers;           /* owned */
    dea_error *error;
} dea_table;

/* Begins with a text; the caller ends it with dea_table_end(). @p table holds columns, column_count, accepted and advice. */
dea_status dea_table_begin(dea_table *table, const char *text, size_t length, const char *name, dea_error *error);
/* Frees what the table owns. */
void dea_table_end(dea_table *table);
/* Reads the header. */
dea_status dea_table_header(dea_table *table);
/* Splits the next row that is neither blank nor a comment; count 0 at the end of the text. Refuses one of another width. */
dea_status dea_table_row(dea_table *table);
/* Reads a field as a plain decimal number in the unit of its column; *value in SI. */
dea_status dea_table_number(const dea_table *table, const dea_field *field, double *value);
/* Fills the error with "name:line:column: problem" and, unless it is NULL, the value in quotes. */
dea_status dea_table_fail(const dea_table *table, size_t column, const char *problem, const char *value);

/* What takes the text of a file; @p name stands in messages. */
typedef dea_status dea_table_parser(const char *text, size_t length, const char *name, void *user, dea_error *error);
/* Reads all of a regular file or pipe, "-" for standard input, at most 64 MiB, and hands it to @p parse. */
dea_status dea_table_open(const char *path, dea_table_parser *parse, void *user, dea_error *error);

#endif
