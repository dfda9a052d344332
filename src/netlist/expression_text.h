/* Expressions of a network as text of ngspice B sources. A term that is used more than once gets a voltage node of its own, and
 * every number stands in a .param: literals inside B expressions keep 11 digits only. */
#ifndef DEA_EXPRESSION_TEXT_H
#define DEA_EXPRESSION_TEXT_H

#include <stdio.h>

#include "expression/expression.h"
#include "netlist/dialect.h"

typedef struct dea_expression_text {
    const dea_pool *pool;
    const dea_dialect *dialect; /* ngspice */
    FILE *out;
    const char *node; /* what stands for node 0, e.g. "v(edge)" */
    int *uses;        /* owned: how often an expression of the netlist uses the term */
    bool *named;      /* owned: it has a node of its own */
    double *rest;     /* owned: values of all terms at the start of the iteration */
} dea_expression_text;

/* Starts a text of the pool's expressions; the pool must not grow any more. False without memory. End it with
 * dea_expression_text_close() in either case. */
bool dea_expression_text_open(dea_expression_text *text, const dea_pool *pool, FILE *out, const char *node);
void dea_expression_text_close(dea_expression_text *text);

/* Declares an expression that the netlist will use, then gives nodes to all that is shared among those. */
void dea_expression_text_use(dea_expression_text *text, dea_expr ref);
void dea_expression_text_share(dea_expression_text *text);

/* The cards that the expressions need: .param of their numbers, B sources of the shared nodes. */
void dea_expression_text_parameters(const dea_expression_text *text);
void dea_expression_text_nodes(const dea_expression_text *text);
/* ` v(x7)=0.5` for every shared node: their values at symbol 0 and node 0, for .nodeset or .ic. Zeros would be divided by. */
void dea_expression_text_start(dea_expression_text *text, double symbol, double node);

/* Writes the expression; as a factor: in brackets where it is a sum. */
void dea_expression_text_write(const dea_expression_text *text, dea_expr ref);
void dea_expression_text_factor(const dea_expression_text *text, dea_expr ref);

/* Writes a number with all its digits. */
void dea_netlist_number(FILE *out, double value);

#endif
