/* The network of an actuator: the one description from which netlists are written and the IDA residual is made.
 *
 * Displacement form, for statics: the one node `edge` carries the displacement u of the disc edge [m], every element acts between
 * it and the frame (ground). At equilibrium the elastic forces balance the sources. */
#ifndef DEA_NETWORK_H
#define DEA_NETWORK_H

#include "deaspice/model.h"
#include "expression/tape.h"

/* Most levers of a film, of two of them. */
enum { DEA_NETWORK_STRESSES = 2 * 3 };

/* What a model's network is built from: numbers, or expressions of symbol 0 where the swept scalar enters. */
typedef struct dea_symbols {
    dea_pool *pool;
    dea_kind kind;
    dea_expr frame_radius;         /* r [m] */
    dea_expr coverage;             /* B [1] */
    dea_expr film_thickness;       /* H, of all layers together [m] */
    dea_expr layers;               /* of the stack [1] */
    dea_expr prestretch;           /* lambda_pre [1] */
    const dea_law *law;                    /* of the film */
    dea_expr constants[DEA_LAW_CONSTANTS]; /* of it, long-term; those out of use 0 */
    dea_expr modulus;              /* Y [Pa]: the scene's, or dsigma/dlambda at the pre-stretch */
    dea_expr permittivity;         /* absolute at the pre-stretch, times layers^2 [F/m] */
    dea_expr electrostriction;     /* its slope over the mean stretch, over itself, NUM(0): it does not follow the strain [1] */
    dea_expr breakdown;            /* breakdown strength [V/m], +inf: none */
    const dea_law *skin;                        /* of the electrodes' skin, NULL: there is none */
    dea_expr skin_constants[DEA_LAW_CONSTANTS]; /* of it */
    dea_expr skin_share;                        /* t/H [1] */
    const dea_load_kind *load_kinds[DEA_LOADS]; /* of the elements that act on the edge, NULL: none */
    dea_expr loads[DEA_LOADS];                  /* its numbers */
    bool loaded;                   /* the film is not alone with its edge */
    const struct dea_symbols *second; /* of the other film on the edge, NULL: there is none */
    bool relaxes;                  /* damper and branches of the first film are those of the second too */
    dea_expr voltage;              /* across the film [V] */
    dea_expr focal_length;         /* of a lens at rest [m], NAN: no optics */
    dea_expr refractive_index;     /* of its liquid [1] */
} dea_symbols;

typedef enum dea_role { DEA_ROLE_SPRING, DEA_ROLE_SOFTENING, DEA_ROLE_HYPERELASTIC, DEA_ROLE_TENSION, DEA_ROLE_BESIDE, DEA_ROLE_STEADY, DEA_ROLE_SOURCE } dea_role;

/* One element between edge and frame. */
typedef struct dea_element {
    dea_role role;
    const char *name;    /* netlist name, e.g. "n_a" */
    const char *meaning; /* what it is, with its unit and equation */
    bool second;         /* of the second film */
    dea_expr value; /* spring, softening: stiffness 1/n [N/m]; hyperelastic spring: change of its stress from rest [Pa]; tension:
                       what the stress at rest does by its levers, and what is elastic beside the film, against u [N]; beside:
                       stiffness of what neither damps nor relaxes [N/m]; steady: outward force that no voltage of the film changes
                       [N]; source: outward force [N] */
    dea_expr lever; /* of a hyperelastic spring: force against u over stress [m^2] */
} dea_element;

/* A stress of the relaxed film that its branches and damper follow: the change of stress of all hyperelastic springs that share a
 * lever [Pa], or the force of all linear springs with the lever 1 [N]. */
typedef struct dea_network_stress {
    dea_expr stress, lever;
} dea_network_stress;

/* A term that texts of the network call by its name. */
typedef struct dea_named_term {
    dea_expr ref;
    const char *name, *meaning; /* borrowed */
} dea_named_term;

typedef struct dea_network {
    dea_pool pool;
    dea_named_term *named; /* owned */
    int named_count;
    dea_element *elements; /* owned */
    int element_count;
    dea_expr capacitance; /* of the film [F] */
    dea_expr voltage;     /* across it [V] */
    dea_expr coverage, radius;               /* B [1], r_a [m] */
    dea_expr focal_length, refractive_index; /* of a lens at rest [m], [1]; NAN: no optics */
    dea_expr edge;        /* u [m] */
    dea_expr strain;      /* s [1] */
    dea_expr field;       /* true field, signed as U [V/m] */
    dea_expr *tension;    /* owned; one per region and place: > 0 while taut */
    int tension_count;
    dea_expr length;    /* displacement that changes the stretch of the more strained region by its own size [m] */
    bool ends;          /* a region vanishes where the edge comes to the centre or the frame; else nothing ends */
    dea_expr breakdown; /* breakdown strength [V/m], > 0 */
    dea_expr second_field, second_breakdown; /* of the second film; 0 and +inf: there is none */
    dea_expr *range;    /* owned; each must be > 0 for the point to make sense: B, 1 - B, permittivity, those of the law */
    int range_count;
    dea_kind kind;
    double sign; /* of u: +1 dot, -1 lens */
} dea_network;

/* Builds the network of @p model for the scene; @p axis (may be NULL) is the scalar that stays symbol 0.
 * The caller frees it with dea_network_free(), also after a failure. */
dea_status dea_network_build(const dea_scene *scene, const dea_model *model, const dea_axis *axis, dea_network *network,
                             dea_error *error);
/* Numbers of a scene that have a dimension and stay symbols 1, 2, ... of its network: its expressions are then the same whatever
 * the units. Symbol 0 is that of the axis. */
enum { DEA_QUANTITIES = 2 * (5 + DEA_LOADS + 2 * DEA_LAW_CONSTANTS), DEA_QUANTITY_NAME = 24 }; /* of two films */
typedef struct dea_quantities {
    int count;
    char names[DEA_QUANTITIES + 1][DEA_QUANTITY_NAME]; /* by symbol; of symbol 0 "" */
    double values[DEA_QUANTITIES + 1];                 /* in SI, or the units of the scene */
} dea_quantities;
dea_status dea_network_build_named(const dea_scene *scene, const dea_model *model, const dea_axis *axis,
                                   dea_quantities *quantities, dea_network *network, dea_error *error);
/* Name of a law's constant as a parameter: in lower case, of a list with the number of its entry. */
void dea_constant_name(const dea_law *law, size_t index, char name[DEA_QUANTITY_NAME]);
/* Name of the number of a load as a parameter. */
const char *dea_load_parameter(const dea_load_kind *kind, char name[DEA_QUANTITY_NAME]);
/* The same from symbols whose pool is that of the zeroed network. */
dea_status dea_network_build_symbols(const dea_symbols *symbols, const dea_model *model, dea_network *network, dea_error *error);
void dea_network_free(dea_network *network);
/* These add to a network; without memory its pool is exhausted, which the end of the building tells.
 * An element that is no hyperelastic spring; names and meanings are borrowed for the life of the network. */
void dea_network_add(dea_network *network, dea_role role, const char *name, const char *meaning, dea_expr value);
/* A hyperelastic spring: a change of stress from rest and its lever. */
void dea_network_add_stress(dea_network *network, const char *name, const char *meaning, dea_expr stress, dea_expr lever);

/* A name for a term, and what it is with its unit; borrowed for the life of the network. */
void dea_network_call(dea_network *network, dea_expr ref, const char *name, const char *meaning);
/* Draws the parameters of every product of elements, capacitance and named terms together (dea_expr_gathered()). */
void dea_network_gather(dea_network *network);

/* Something that is positive while the film is taut. */
void dea_network_taut(dea_network *network, dea_expr tension);
/* Demands a permittivity > 0 of the film under lambda_pre l1, lambda_pre l2 where it follows them. */
void dea_network_insulate(const dea_symbols *symbols, dea_network *network, dea_expr l1, dea_expr l2);
/* Sets the true field from the area that disc (dot) or annulus (lens) has at u: U lambda_pre^2/H times the area ratio. */
void dea_network_limit_area(const dea_symbols *symbols, dea_network *network);

/* The stresses of the film, at most DEA_NETWORK_STRESSES; their number. Stress times lever, summed, and dea_network_tension() are
 * the restoring force without softening [N], less what is steady. */
int dea_network_stresses(dea_network *network, dea_network_stress *stresses);
dea_expr dea_network_tension(dea_network *network);
/* Stiffness that the voltage adds, negative where it softens [N/m]. */
dea_expr dea_network_softening(dea_network *network);
/* Sum of the elastic forces (restoring), less what is steady, of what is steady (outward) and of the sources (outward) as
 * expressions of u [N]. */
dea_expr dea_network_elastic(dea_network *network);
dea_expr dea_network_steady(dea_network *network);
dea_expr dea_network_load(dea_network *network);

/* Shared pieces of the models' networks. */
/* What springs at the edge hold against u [N]; NUM(0): there is none. */
dea_expr dea_symbols_springs(const dea_symbols *symbols, dea_expr u);
/* Steady force of the loads on the edge, outward [N]. */
dea_expr dea_symbols_force(const dea_symbols *symbols);
/* The symbols of a scene: numbers, or expressions of symbol 0 where the axis (may be NULL) enters. */
dea_symbols dea_symbols_of(const dea_scene *scene, const dea_axis *axis, dea_pool *pool);
/* Cauchy stress of the film at the pre-stretch, the same in all directions of its plane [Pa]. */
dea_expr dea_symbols_rest_stress(const dea_symbols *symbols);
/* Tangent moduli W11 and W12 at the pre-stretch [Pa]. */
typedef struct dea_tangent {
    dea_expr w11, w12;
} dea_tangent;
dea_tangent dea_symbols_tangent(const dea_symbols *symbols);
/* Tangent moduli of the skin at rest times t/H, and dsigma/dlambda, t lambda_pre/H Y_e(1): what it adds to the film [Pa]. Only where
 * there is a skin. */
dea_tangent dea_symbols_skin_tangent(const dea_symbols *symbols);
dea_expr dea_symbols_skin_modulus(const dea_symbols *symbols);
/* Y = dsigma/dlambda at the pre-stretch [Pa]. */
dea_expr dea_symbols_modulus(const dea_symbols *symbols);
/* True field of the film at rest in one of its layers, layers U/H [V/m] without pre-stretch. */
dea_expr dea_symbols_nominal_field(const dea_symbols *symbols);
/* M = eps (U/H)^2 [Pa]. */
dea_expr dea_symbols_pressure(const dea_symbols *symbols);
/* eps lambda_pre^4/H^2 [Pa/V^2], the electrostatic stress at the pre-stretch per U^2. */
dea_expr dea_symbols_stress_per_volt(const dea_symbols *symbols);
/* dea_electric of a film under the stretches lambda_pre l1, lambda_pre l2; numbers 1 where nothing follows. */
typedef struct dea_symbols_factors {
    dea_expr own, first, second;
} dea_symbols_factors;
dea_symbols_factors dea_symbols_electric(const dea_symbols *symbols, dea_expr l1, dea_expr l2);
/* Capacitance at rest [F]: eps lambda_pre^2/H times pi r_a^2 (dot) or pi (r^2 - r_a^2) (lens). */
dea_expr dea_symbols_capacitance(const dea_symbols *symbols);
/* A_cross = 2 pi r_a H/lambda_pre^2 [m^2]. */
dea_expr dea_symbols_cross_section(const dea_symbols *symbols);
/* Radial strain of the annulus, -u/(r - r_a) (Eq. 17) [1]. */
dea_expr dea_symbols_annulus_strain(const dea_symbols *symbols);
/* r - r_a [m]. */
dea_expr dea_symbols_annulus_width(const dea_symbols *symbols);

#endif
