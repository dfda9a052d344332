/* The moving network of a scene as cards, in one of the two analogies: what the engine `ngspice` runs and what is exported is this
 * one text. It names its numbers, which stand in `.param` cards before it, so that it is the same in all units and from every
 * start; sources, steps, tolerances and what is read off are the deck behind it. Only what the scene has becomes an element. */
#ifndef DEA_MOBILITY_H
#define DEA_MOBILITY_H

#include "netlist/part_text.h"
#include "network/dynamics.h"

/* How mechanical quantities become electrical ones. Mobility: velocity -> voltage, force -> current, elements between the edge
 * and the frame. Impedance: force -> voltage, velocity -> current, the same elements as links of one loop. */
typedef struct dea_analogy {
    const char *name;    /* as on the command line */
    const char *meaning; /* one line for the head of a netlist */
    char mass, spring;   /* letters of the elements */
    bool loop;           /* elements are links of a loop; else they lie between edge and frame */
} dea_analogy;

/* Analogy number @p index, the default first, NULL past the end; by name, NULL if there is none. */
size_t dea_analogy_count(void);
const dea_analogy *dea_analogy_at(size_t index);
const dea_analogy *dea_analogy_find(const char *name);

/* What the cards are written from. */
typedef struct dea_mobility {
    const dea_dynamics *dynamics;              /* borrowed; of a part it tells which elements there are, and no numbers */
    dea_network network;                       /* owned: built under 1 V, so that the force is phi */
    dea_quantities quantities;                 /* its symbols */
    dea_network_stress stresses[DEA_STRESSES]; /* S_a and B_a, as many as the dynamics have */
    dea_expr tension, push;                    /* G, phi */
    bool tense;                                /* there is a G */
    dea_expr resistance;                       /* sum B_a S_a', which a damper scales by tau_KV [N/m] */
    double stiffness;                          /* of all linear springs [N/m]; NAN where the springs are hyperelastic */
    double rest;                               /* capacitance of the film at rest [F] */
    bool displaced;                            /* set by dea_mobility_displace() */
} dea_mobility;

/* States of the network: what one piece of a run hands to the next. */
typedef struct dea_mobility_state {
    double u, v;               /* [m], [m/s] */
    double charge;             /* of the film [C], where there is a series resistance */
    double z[DEA_RELAXED_MAX]; /* relaxed stresses of the branches, as the dynamics number them */
} dea_mobility_state;

/* Builds what the cards are written from; the caller ends it with dea_mobility_close(), also after a failure. */
dea_status dea_mobility_open(const dea_scene *scene, const dea_dynamics *dynamics, dea_mobility *mobility, dea_error *error);
void dea_mobility_close(dea_mobility *mobility);
/* The expressions of a network that is built already. */
dea_status dea_mobility_take(dea_mobility *mobility, dea_error *error);

/* The network of a transient as engine and exports write it, with the dynamics behind it; the caller ends both, also after a
 * failure. */
dea_status dea_mobility_prepare(const dea_scene *scene, const dea_model *model, const dea_analogy *analogy, dea_dynamics *dynamics,
                                dea_mobility *mobility, dea_error *error);

/* Transients of a film without mass and damper in the displacement form from here on: nothing holds its velocity, a difference of
 * displacements over a step that drowns in rounding where steps are short. */
void dea_mobility_displace(dea_mobility *mobility);

/* Node of stress number @p index: `stress` where it is alone. */
typedef struct dea_stress_node {
    char name[32];
} dea_stress_node;

/* What a text is cured of that stands in a circuit of strangers, with options, starts and neighbours that are not ours: it has an
 * operating point, holds no edge of its own, and bears shunts, m= and default tolerances. */
typedef struct dea_cures {
    double per_metre; /* displacements are in um: the tolerance of voltages, 1e-6, is then 1 pm */
    double drift;     /* share of itself by which a displacement leaks [1/s]: springs in parallel have an operating point */
    double inertia;   /* forces of inertia pass a capacitor so many times smaller [1/N]: the tolerance of currents, 1e-12, is then one
                         of 1e-6 N; that force is 0 at rest, where a kink of the voltage would ask for steps without end */
    double lightest;  /* least mass over the stiffness at rest [s^2]: without mass nothing else holds the node of the mass */
    double stop;      /* stiffness of the stops short of centre and frame, over that of the film [1] */
    double fastest;   /* bound of the velocity in the damper [m/s]: an iterate that runs away would overflow the product, which ends
                         a run instead of shortening its step. A film without mass follows an edge of 1 ns at 1e5 m/s, and a bound
                         below that is a kink at which no step converges */
    double sense;     /* conductance that makes a node of the film's current [S]: its tolerance, 1e-6 V, is one of 1 nA, which the
                         digits of kilovolts can keep in short steps */
} dea_cures;
extern const dea_cures dea_part_cures;

/* Which text. */
typedef struct dea_cards_form {
    const dea_dialect *dialect;
    const dea_analogy *analogy;
    bool numbers;           /* parameters as numbers; else as formulas of those of the scene */
    const dea_cures *cures; /* of a part, whose checks have made the parameters that its cards name; NULL: a deck of our own */
} dea_cards_form;

/* Numbers of the elements that are not the network's own. */
typedef struct dea_cards_numbers {
    dea_mobility_state start;
    double mass; /* [kg] */
    double unit; /* in which currents of the port are counted [A] */
} dea_cards_numbers;

/* A text on its way out. */
typedef struct dea_cards {
    dea_cards_form form;
    FILE *out;                    /* borrowed, as the next two */
    const dea_mobility *mobility; /* NULL: small signals */
    const dea_dynamics *dynamics;
    dea_part_text text;  /* owned */
    const char **symbols; /* owned: names of the quantities */
    double *values;       /* owned: of all terms at rest; dea_cards_start(): at the start */
    char node[64];        /* what stands for the displacement */
    int links;            /* of the loop so far */
    char ends[2][16];     /* nodes between which the next element of the mechanics lies */
} dea_cards;

/* Starts a transient's text or a part's; false without memory. The caller ends it with dea_cards_close() in either case. */
bool dea_cards_open(const dea_mobility *mobility, const dea_cards_form *form, FILE *out, dea_cards *cards);
void dea_cards_close(dea_cards *cards);
/* Declares all that the network writes; of a part behind all else that is written from its text. */
void dea_cards_declare(dea_cards *cards);
/* The quantities of a scene as parameters. */
void dea_cards_write_quantities(const dea_quantities *quantities, FILE *out);
/* In this order: the numbers, the network, and behind it where Newton starts in the first step, ` v(node)=value` of every node. */
void dea_cards_write_numbers(dea_cards *cards, const dea_cards_numbers *numbers);
void dea_cards_write_network(dea_cards *cards);
void dea_cards_write_start(dea_cards *cards, const dea_cards_numbers *numbers, double source);

/* Node @p node as the integral of the velocity between two nodes, with the cures of a part. The velocity enters with a large factor,
 * so that pivoting finds it from the integrator and not from a difference of forces: only so do springs in parallel share right at
 * the operating point. */
void dea_cards_write_integral(const dea_cures *cures, const char *tag, const char *node, const char *from, const char *to, FILE *out);
/* The mass of a capacitor's card at a node of velocity; @p tag is behind the names of its elements. */
void dea_cards_write_inertia(const dea_cures *cures, const char *tag, const char *node, const char *mass, FILE *out);

/* The film of a part at its pins behind v(film), the charge over that at rest, and its leakage. */
void dea_cards_write_capacitor(const dea_cures *cures, FILE *out);

/* A small-signal network about an equilibrium. */
typedef struct dea_mobility_bias {
    double u;       /* [m] */
    double voltage; /* of the film [V] */
} dea_mobility_bias;

/* Its numbers and its network; the source of the port is not among them. v(disp) is the displacement. */
void dea_cards_write_small(dea_dynamics *dynamics, const dea_mobility_bias *bias, const dea_cards_form *form, FILE *out);

/* Frequencies: points_per_decade of a decade from `from` on; or, where they are 0, `count` evenly, or one alone. */
typedef struct dea_mobility_band {
    double from, to; /* [Hz] */
    size_t points_per_decade, count;
} dea_mobility_band;

/* Its analysis, and the end of the netlist. */
void dea_cards_write_band(const dea_mobility_band *band, FILE *out);

/* First and last line of every network. */
#define DEA_CARDS_BEGIN "* the network\n"
#define DEA_CARDS_END "* end of the network\n"

#endif
