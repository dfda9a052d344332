/* Runs of a membrane by SUNDIALS. Every segment of the voltage is a problem of its own, solved
 *
 *   - by IDA (variable order BDF) in general, with all unknowns but the displacements eliminated from Newton's method;
 *   - by an explicit Runge-Kutta method (ARKODE) while a film with mass swings that nothing stiff holds: BDF would damp its faster
 *     modes or crawl through their periods. */
#ifndef DEA_IDA_RINGS_SOLVER_H
#define DEA_IDA_RINGS_SOLVER_H

#include "engine/ida/sundials.h"
#include "engine/rings_flight.h"

typedef struct dea_rings_solver {
    dea_rings_flight flight;
    const dea_sundials *sun; /* borrowed */
    double loosest; /* tolerance that samples alone would cut the steps of */
    N_Vector y, yp, between, slope, tolerances; /* owned, as all below: state, derivative, both between steps */
    SUNMatrix matrix, dense;
    SUNLinearSolver solver, inner;
    N_Vector reduced;
    void *ida;
    dea_rings_schur schur;
} dea_rings_solver;

/* Cuts the film of a scene and prepares runs; the caller ends them with dea_rings_solver_close(), also after a failure. */
dea_status dea_rings_solver_open(const dea_sundials *sun, const dea_scene *scene, const dea_model *model, const dea_signal *signal,
                                 dea_rings_mesh mesh, dea_rings_solver *solver, dea_error *error);
void dea_rings_solver_close(dea_rings_solver *solver);
/* IDA with its matrix; part of opening. */
dea_status dea_rings_implicit_open(dea_rings_solver *solver, dea_error *error);
void dea_rings_implicit_close(dea_rings_solver *solver);

/* Runs; with a summary, fills its energies. */
void dea_rings_solver_run(dea_rings_solver *solver, double tolerance, dea_rings_trace *trace, dea_summary *summary);
/* Shrinks the sizes of the unknowns to what the last run reached, where that is much less; true where it did. */
bool dea_rings_solver_fit(dea_rings_solver *solver);

/* The segment from a time on to its end by IDA, and up to a time by Runge-Kutta; what happened. */
dea_state dea_rings_implicit(dea_rings_solver *solver, double from);
dea_state dea_rings_explicit(dea_rings_solver *solver, double to);

#endif
