/* The film as a network of rings of film (physics: section 7): displacements u_n of nodes at reference radii R_n, stretches that
 * are linear in them at every ring, and forces that are the gradient of one energy.
 *
 *     lambda_a = lambda_pre (1 + e_a),   e_1 = sum_n radial_n u_n,   e_2 = sum_n hoop_n u_n
 *     force against u_n = sum_rings volume lambda_pre (radial_n s_1 + hoop_n s_2),   s_a = P_a - k (lambda_1 lambda_2)^2/lambda_a
 *     C = (eps/H^2) sum_electroded volume (lambda_1 lambda_2)^2,   k = eps (U/H)^2 where electroded, else 0
 *
 * Disc and annulus are one element each, with Gauss-Lobatto nodes that are the places of its rings too, so that the mass is
 * diagonal. A uniform stress at rest holds no node, so that changes of P_a from rest may stand for P_a: then all is 0 at rest. */
#ifndef DEA_RINGS_H
#define DEA_RINGS_H

#include "deaspice/model.h"

/* Largest degree of an element, and what follows: most rings of a film, and moving nodes of two on one edge. */
enum { DEA_RINGS_DEGREE = 40, DEA_RINGS_MOST = 2 * DEA_RINGS_DEGREE + 1, DEA_RINGS_NODES = 4 * DEA_RINGS_DEGREE - 3 };

/* How fine: degrees of the elements of disc and annulus, 1 ... DEA_RINGS_DEGREE, and whether the nodes of the annulus lie evenly in
 * ln R, which statics and small discs want, or in R. */
typedef struct dea_rings_mesh {
    size_t disc, annulus;
    bool logarithmic;
} dea_rings_mesh;

/* One ring: a place of the quadrature. */
typedef struct dea_ring {
    double radius; /* R in the reference film [m], > 0 */
    double volume; /* [m^3] */
    bool disc, electroded;
    size_t first, count;                 /* the moving nodes that strain it: first ... first + count - 1 */
    double radial[DEA_RINGS_DEGREE + 1]; /* de_1/du of each [1/m] */
    double hoop[DEA_RINGS_DEGREE + 1];   /* de_2/du of each [1/m] */
    double tie[2];                       /* de_a/du of the edge where it is none of these, else 0 [1/m] */
} dea_ring;

typedef struct dea_rings {
    dea_rings_mesh mesh;
    size_t node_count; /* moving ones, from the centre out: disc + annulus - 1 */
    size_t edge;       /* number of that at r_a */
    double radii[DEA_RINGS_NODES]; /* R_n in the reference film [m] */
    double areas[DEA_RINGS_NODES]; /* of reference film that moves with each, electroded or not [m^2] */
    double coated[DEA_RINGS_NODES]; /* and of electroded film [m^2] */
    double rim;  /* F [m] */
    size_t ring_count;
    dea_ring rings[DEA_RINGS_MOST]; /* from the centre out; the edge has one of the disc and one of the annulus */
} dea_rings;

/* Cuts the film of a point into rings; its numbers are in their ranges. */
void dea_rings_cut(const dea_point *point, dea_rings_mesh mesh, dea_rings *rings);
/* Numbers the nodes that strain a film's rings anew, from @p first on, without the edge, by which they are tied to another film. */
void dea_rings_tie(dea_rings *rings, size_t first);

/* Reference element of a degree, 1 ... DEA_RINGS_DEGREE, over x in [-1, 1]: its places and their weights, and the derivatives of
 * its polynomials there. */
typedef struct dea_rings_slopes {
    double places[DEA_RINGS_DEGREE + 1], weights[DEA_RINGS_DEGREE + 1];
    double of[DEA_RINGS_DEGREE + 1][DEA_RINGS_DEGREE + 1]; /* [place][node] */
} dea_rings_slopes;
void dea_rings_slopes_of(size_t degree, dea_rings_slopes *slopes);

/* Derivatives d/dR [1/m] at the rings of the disc, or of the annulus, by values at its rings, from the centre out; of what is smooth
 * at the centre. */
void dea_rings_derivative(const dea_rings *rings, bool disc, double (*gradient)[DEA_RINGS_DEGREE + 1]);

/* Largest value over the disc, or over the annulus, of what has these values at the rings (ring_count of them, those of the other
 * element are not looked at): of the polynomial through them, since it may lie between two places. *@p radius becomes where, in the
 * reference film [m], unless it is NULL. */
double dea_rings_largest(const dea_rings *rings, bool disc, const double *values, double *radius);

/* The matrix (rows: moving nodes of @p to, columns: those of @p from) that takes displacements of one mesh to the nodes of
 * another by the polynomials of its elements; both even in R or in ln R. And its product with displacements. */
void dea_rings_transfer(dea_rings_mesh from, dea_rings_mesh to, double *matrix);
void dea_rings_move(const double *matrix, size_t from_count, const double *u, size_t to_count, double *v);

/* One reference radius, and what polynomials of its element have there by their values at the places of the element. */
typedef struct dea_rings_spot {
    double radius; /* R [m] */
    bool disc;
    size_t degree;
    double value[DEA_RINGS_DEGREE + 1]; /* of each place [1] */
    double slope[DEA_RINGS_DEGREE + 1]; /* d/dR [1/m] */
    double even[DEA_RINGS_DEGREE + 1];  /* as value, of what is known at rings alone: at the centre its slope is 0 */
} dea_rings_spot;

/* At R, 0 ... F, at the edge that of the annulus where @p outside. */
dea_rings_spot dea_rings_spot_at(const dea_rings *rings, double radius, bool outside);
/* Displacement there of displacements of the nodes [m]; *@p slope becomes du/dR [1]. */
double dea_rings_displacement(const dea_rings *rings, const dea_rings_spot *spot, const double *u, double *slope);
/* What is smooth over the element and has these values at the rings, @p stride apart: its value there. */
double dea_rings_value(const dea_rings *rings, const dea_rings_spot *spot, const double *values, size_t stride);

#endif
