/* What differs between the simulators that read our netlists: one table, so that no other place asks which simulator it is.
 *
 * All else stays within what they have in common: names of elements in upper case, which editors of netlists want, all else in
 * lower, no indentation, numbers without suffixes, `.param name={...}`, the
 * elements r c l v i g e f h k x, products instead of powers, min and max instead of conditions. */
#ifndef DEA_DIALECT_H
#define DEA_DIALECT_H

#include <stddef.h>
#include <stdio.h>

#include "expression/operation.h"

typedef struct dea_dialect {
    const char *name;                 /* as on the command line, e.g. "ngspice" */
    const char *title;                /* as its makers write it */
    const char *source[2];            /* letter of a behavioural source of voltage, of current: "B", or "E" and "G" */
    const char *equals[2];            /* what stands before its expression: " v=", " i=", or " value=" */
    const char *open, *close;         /* round the expression of a behavioural source */
    const char *left, *right;         /* round a parameter inside such an expression; brackets where it is put in as text */
    const char *text[DEA_OPERATIONS]; /* of an operation, where it is not that of its row */
    const char *inside;               /* between the name of an instance and a node of it: v(x1.u) */
    const char *solver;               /* card of solver options that reltol, abstol and vntol follow, NULL: none */
    const char *inductor;             /* what stands behind every inductor */
    const char *transient;            /* lines before a transient of a whole study, */
    const char *ac;                   /* its frequency response, */
    const char *sweep;                /* its sweep */
    const char *table;                /* function of a value and a list of pairs, between which it is linear; NULL: none */
    const char *save;                 /* card that the nodes to be kept follow, NULL: none */
} dea_dialect;

typedef enum dea_quantity { DEA_VOLTAGE, DEA_CURRENT } dea_quantity;

size_t dea_dialect_count(void);
/* Dialect number @p index, NULL past the end; by name, NULL if there is none. */
const dea_dialect *dea_dialect_at(size_t index);
const dea_dialect *dea_dialect_find(const char *name);

/* A behavioural source from node @p plus to @p minus, its name in capitals: begin, then the expression, then end.
 * `BFORCE 0 edge i=` ... */
void dea_dialect_source_begin(const dea_dialect *dialect, FILE *out, dea_quantity quantity, const char *name, const char *plus,
                              const char *minus);
void dea_dialect_source_end(const dea_dialect *dialect, FILE *out);
/* A parameter inside the expression of a behavioural source. */
void dea_dialect_parameter(const dea_dialect *dialect, FILE *out, const char *name);
/* Writes operand number 0 or 1 of an operation. */
typedef void dea_operand_writer(void *user, int operand);
/* The text of an operation; one that moves holds its operand inside its range. */
void dea_dialect_operation(const dea_dialect *dialect, FILE *out, dea_operation operation, bool moves,
                           dea_operand_writer *operand, void *user);
/* One comment line: printable ASCII of at most DEA_COMMENT_LENGTH characters, without backslashes, which can join lines; anything
 * else becomes a space, so that text of strangers stays a comment. NULL is an empty one. */
enum { DEA_COMMENT_LENGTH = 120 };
void dea_dialect_comment(FILE *out, const char *text);

/* Writes @p text, lines of cards, with those past DEA_CARD_LENGTH continued behind a `+`, and names of elements in capitals: an
 * editor of circuits refuses others. */
enum { DEA_CARD_LENGTH = 120 };
void dea_dialect_wrap(FILE *out, const char *text);

#endif
