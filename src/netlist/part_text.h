/* Expressions of a network as text of its cards: what depends on parameters alone becomes `.param` cards, what depends on the
 * displacement is written into behavioural sources, what those share into nodes. Literals inside the expression of a source keep 11
 * digits in ngspice, hence a parameter for every number in one. */
#ifndef DEA_PART_TEXT_H
#define DEA_PART_TEXT_H

#include "deaspice/material.h"
#include "netlist/dialect.h"
#include "network/network.h"

enum { DEA_PART_NAME = 40 };

/* A term that has a name and a meaning of its own. */
typedef struct dea_part_name {
    dea_expr ref;
    char name[DEA_PART_NAME];
    char meaning[96];
} dea_part_name;

/* After whom terms without a name of their own are called: name_1, name_2, ... */
typedef struct dea_part_root {
    char name[DEA_PART_NAME - 12];
    int count;
} dea_part_root;

/* What is known of a term. */
typedef struct dea_part_term {
    int uses;     /* how often it is written */
    int places;   /* how often the displacement stands in it, up to a bound */
    int owner;    /* its root + 1, 0: none */
    int number;   /* its number there */
    bool carded;  /* a source refers to it, so that it needs a .param card */
    bool moves;   /* depends on the displacement */
    bool divides; /* stands in a divisor or a logarithm */
    bool nodal;   /* becomes a node where it is shared */
    bool factor;  /* and where it stands once */
    bool written; /* has its .param card or its node */
} dea_part_term;

typedef struct dea_part_text {
    const dea_pool *pool;
    const dea_dialect *dialect;
    FILE *out;
    const char *const *symbols; /* names of the parameters behind the pool's symbols */
    const char *node;           /* what stands for the displacement [m], a factor */
    const double *values;       /* of all terms at rest: parameters are written as these numbers; NULL: as formulas */
    const char *const *nodes;   /* what stands for each node of a pool of several, NULL: `node` for all */
    const char *suffix;         /* of the nodes of shared terms that move with nodes of the pool, NULL: none */
    dea_part_name *names;       /* owned */
    size_t name_count;
    dea_part_term *terms;       /* owned: of each term of the pool */
    bool dividing;              /* nodes may stand in divisors: Newton does not start with every node at 0 */
    dea_part_root *roots;       /* owned */
    int root_count, root;       /* the one at hand is number root - 1 */
    bool exhausted;             /* memory ran out: a name is missing */
} dea_part_text;

/* Starts a text; the pool must not grow any more. False without memory. End it with dea_part_text_close() in either case. */
bool dea_part_text_open(dea_part_text *text, const dea_pool *pool, const dea_dialect *dialect, FILE *out);
void dea_part_text_close(dea_part_text *text);

/* Every moving term that is used twice gets a node of its own, but for a mere parameter times another: simulators differentiate an
 * expression by each of its nodes, so that short ones are worth it. Where all nodes are given their values at the start. */
void dea_part_text_share(dea_part_text *text);
/* Terms that the expressions declared from here on are made of are called after this one, unless they have a name. */
void dea_part_text_root(dea_part_text *text, const char *name);
/* Gives the names that a network has, and calls what its elements are made of after them: n_disc -> disc_1, disc_2, ... */
void dea_part_text_call(dea_part_text *text, const dea_network *network);
/* Names a term; the first of two names of a term stays. */
void dea_part_text_name(dea_part_text *text, dea_expr ref, const char *name, const char *meaning);
/* Lets symbol number @p index move as the displacement does: its name is that of a voltage. Terms of it alone may be nodes. */
void dea_part_text_move_symbol(dea_part_text *text, int index);
/* Declares that a source will write the expression, as a whole or as a number on a card of its own. */
void dea_part_text_use(dea_part_text *text, dea_expr ref);
/* Declares an expression that is written beside the network, after all else is declared: its parameters get cards, its terms no
 * nodes, and all other text stays the same. */
void dea_part_text_use_aside(dea_part_text *text, dea_expr ref);
/* Like dea_part_text_use() of an expression that multiplies what is 0 at the start of Newton's iterations, the last to be declared: its shared
 * terms become nodes whatever they are at rest, which keeps derivatives short. */
void dea_part_text_use_as_factor(dea_part_text *text, dea_expr ref);

/* The cards that the declared expressions need: .param, then nodes of shared moving terms. */
void dea_part_text_parameters(dea_part_text *text);
void dea_part_text_nodes(dea_part_text *text);
/* The nodes of terms that a symbol alone moves; before those of dea_part_text_nodes(). */
void dea_part_text_swept(dea_part_text *text);
/* Those that one declared expression needs. */
void dea_part_text_nodes_of(dea_part_text *text, dea_expr ref);
/* Forgets those of dea_part_text_nodes_of(): the same expressions of other nodes are next. */
void dea_part_text_again(dea_part_text *text);

/* ` v(name)=0.5` for every node, for .ic and .nodeset; @p inside stands before the names, @p values are those of all terms. */
void dea_part_text_start(const dea_part_text *text, const char *inside, const double *values);

/* Writes an expression inside a behavioural source, as a factor: in brackets where it is a sum. */
void dea_part_text_write(const dea_part_text *text, dea_expr ref);
/* Writes a piece of such an expression: `[name]` in it stands for a parameter and `[]` for the next term. */
void dea_part_text_format(const dea_part_text *text, const char *format, ...);
/* A behavioural source whose expression is such a piece. */
void dea_part_text_source(const dea_part_text *text, dea_quantity quantity, const char *name, const char *plus, const char *minus,
                          const char *format, ...);
/* Name of the node or .param of a declared term; a plain number is its own name. */
const char *dea_part_text_parameter(const dea_part_text *text, dea_expr ref, char name[DEA_PART_NAME]);

/* A number with as few digits as give it back. */
void dea_part_number(FILE *out, double value);
/* As fprintf() with %s, %zu, %d and %c, but %g is such a number. */
void dea_part_print(FILE *out, const char *format, ...) DEA_PRINTF(2, 3);
/* `.param name=value` */
void dea_part_value(FILE *out, const char *name, double value);

#endif
