/* The moving membrane as cards, mobility analogy: what parts, exports and the engine `ngspice` share.
 *
 *   ring q: e_1 = v(a<q>), e_2 = v(b<q>), of the thickness e_3 = v(w<q>), their rates v(c<q>), v(d<q>), v(r<q>), changes of the
 *   Cauchy stresses v(s<q>), v(t<q>), with what branches and damper add v(x<q>), v(y<q>), and lambda_pre (P_a + x_a/lambda_a)
 *   less the voltage's part v(f<q>), v(g<q>); z relaxes to the stress: v(z<i>s<q>), v(z<i>t<q>). v(pressure) = eps E^2 at rest. Node n: velocity v(v<n>), displacement v(u<n>), at r_a v(edge) and v(u).
 *   v(swell) = C/C_rest - 1, of an electroded ring v(h<q>) = (1 + e_1)^2 (1 + e_2)^2 - 1.
 *
 * The text refers to parameters of those who use it: `per_r`, strain over displacement and radius; `newton`, 2 pi H F^2/r in the
 * units of force over stress; of branch i `share<i>`, `c_relax<i>`. */
#ifndef DEA_RINGS_MOVING_H
#define DEA_RINGS_MOVING_H

#include "netlist/rings_text.h"

typedef struct dea_rings_moving {
    dea_rings_cards cards;
    size_t branches;
    bool damped; /* there are rates and what they do */
    bool free;   /* forces act on nodes of displacement: neither mass nor damper holds velocities */
    bool stops;  /* strains are held where a film is: an iterate of Newton's method may leave that */
    bool whole;  /* the branches of the stress that holds no node, across at the frame, are written too */
    dea_expr cauchy[DEA_RINGS_STRAINS][2];     /* changes of sigma_a */
    dea_expr rates[DEA_RINGS_STRAINS][2];      /* their slopes over time */
    dea_expr nominal[DEA_RINGS_STRAINS][2][2]; /* bare and electroded; of x_a, see above */
    dea_expr push;                             /* of the pressure over U^2, eps lambda_pre^4/H^2 */
    dea_expr damp;                             /* Kelvin-Voigt retardation time */
    dea_expr swell;                            /* (1 + e_1)^2 (1 + e_2)^2 - 1 */
    dea_expr rest;                             /* sigma at rest */
    dea_expr masses[DEA_RINGS_NODES];
    dea_expr weights[DEA_RINGS_MOST]; /* shares of electroded rings in the capacitance at rest */
} dea_rings_moving;

/* What symbols of a network do not hold. */
typedef struct dea_rings_numbers {
    dea_expr density, areal; /* of film and electrodes */
    dea_expr damp;           /* Kelvin-Voigt retardation time; NUM(0): none */
    double stress;           /* unit of the moduli [Pa] */
    double held;             /* share of branches that are springs alone: S is that of film and these */
} dea_rings_numbers;

/* Builds the expressions of a mesh, whose disc has two degrees at least where it is to move by waves, in the pool of the symbols
 * and the unit of their moduli. */
void dea_rings_moving_make(const dea_symbols *symbols, const dea_rings_numbers *numbers, dea_rings_mesh mesh, size_t branches,
                           dea_rings_moving *moving);
/* Declares what dea_rings_moving_write() will write; @p charged: and dea_rings_moving_swell(). */
void dea_rings_moving_declare(const dea_rings_moving *moving, bool charged, dea_part_text *text);

/* What a ring writes besides. */
typedef void dea_rings_extra(const void *user, const dea_rings_writer *w, size_t ring);

/* Strains, stresses, branches and forces of all rings; @p volts: the film's voltage as a piece of dea_part_text_format(); @p rate: what turns a
 * `radial` into rates over velocities, "/radius". @p extra may be NULL. */
void dea_rings_moving_write(const dea_rings_moving *moving, const char *volts, const char *rate, dea_rings_extra *extra, const void *user,
                            dea_part_text *text);
/* Node `swell`, behind the rings. */
void dea_rings_moving_swell(const dea_rings_moving *moving, dea_part_text *text);

#endif
