/* Shapes of a finite element that are good to high degrees, and Gauss's rule, in long double. */
#ifndef DEA_LEGENDRE_H
#define DEA_LEGENDRE_H

enum { SHAPES_MOST = 13 };

/* Shapes on -1..1 at a place: two linear ones and integrated Legendre polynomials, with two derivatives. */
typedef struct shape {
    long double value[SHAPES_MOST], slope[SHAPES_MOST], curve[SHAPES_MOST];
} shape;

/* The shapes 0 ... degree at a place. */
shape shape_at(int degree, long double xi);
/* Places and weights of Gauss on -1..1. */
void gauss_rule(int count, long double *places, long double *weights);

#endif
