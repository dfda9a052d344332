/* The membrane as a part: a fixed mesh of rings between the pins p, n (film) and edge (velocity of r_a), mobility analogy. Its text
 * refers to parameters that the part's checks have made: `many`, `ok`, `damp`, `inertia` and, of branch i, `share<i>`, `c_relax<i>`.
 *
 *   ring q: e_1 = v(a<q>), e_2 = v(b<q>), their rates v(c<q>), v(d<q>) [1/s], changes of the Cauchy stresses v(s<q>), v(t<q>) [MPa],
 *   lambda_pre (P_a + x_a/lambda_a) less the voltage's part v(f<q>), v(g<q>) [MPa], (lambda_1 lambda_2)^2 over that at rest, less 1,
 *   v(h<q>) where electroded. Node n: velocity v(v<n>) [m/s], displacement v(u<n>) [um]. */
#ifndef DEA_RINGS_PART_H
#define DEA_RINGS_PART_H

#include "netlist/rings_cards.h"

/* The mesh of the parts: for coverages 0.15 ... 0.85 and pre-stretches 1.1 ... 1.3 its static strain at 4.5 kV is good to 1e-8, its
 * first two modes to 1e-5 and 1e-3 (measured on the paper's film, against 14 and 18 degrees). */
extern const dea_rings_mesh dea_rings_part_mesh;

typedef struct dea_rings_part {
    dea_rings_cards cards;
    size_t branches;
    dea_expr cauchy[DEA_RINGS_STRAINS][2];  /* changes of sigma_a [MPa] */
    dea_expr rates[DEA_RINGS_STRAINS][2];   /* their slopes over time [MPa/s] */
    dea_expr nominal[DEA_RINGS_STRAINS][2][2]; /* [MPa], bare and electroded; of x_a, see above, and the rates */
    dea_expr swell;                         /* (1 + e_1)^2 (1 + e_2)^2 - 1 */
    dea_expr rest;                          /* sigma at rest [MPa] */
    dea_expr masses[DEA_RINGS_NODES];       /* [kg] */
    dea_expr weights[DEA_RINGS_MOST];       /* shares of electroded rings in the capacitance at rest */
    dea_expr frame_radius;                  /* [m] */
    dea_expr field, force;                  /* per volt [V/um] and per square volt [N], of the electroded ring at r_a */
} dea_rings_part;

/* What symbols of a network do not hold. */
typedef struct dea_rings_numbers {
    dea_expr density, areal; /* of the film [kg/m^3], of the electrodes [kg/m^2] */
    dea_expr damp;           /* Kelvin-Voigt retardation time [s] */
} dea_rings_numbers;

/* Builds the expressions in the pool of the symbols, whose moduli are in MPa. */
void dea_rings_part_make(const dea_symbols *symbols, const dea_rings_numbers *numbers, size_t branches, dea_rings_part *part);
void dea_rings_part_declare(const dea_rings_part *part, dea_part_text *text);
/* The mechanics, up to node `swell`: (C/C_rest) - 1, and the outputs force, field and tension; tension [MPa] is the least of the
 * stresses on both sides of r_a and at the frame. */
void dea_rings_part_write(const dea_rings_part *part, dea_part_text *text);

#endif
