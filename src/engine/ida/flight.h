/* One run of a transient at one tolerance. Every segment of the voltage, cut where a source comes to its limit or from it, is a
 * problem of its own, solved
 *
 *   - by IDA (variable order BDF) in general, in the turning frame of a swing where the network is linear;
 *   - by an explicit Runge-Kutta method (ARKODE) while a light swing lives in a film that is not linear, or under a
 *     voltage that varies: BDF would crawl through its periods. */
#ifndef DEA_IDA_FLIGHT_H
#define DEA_IDA_FLIGHT_H

#include "engine/ida/rotation.h"
#include "engine/ida/sundials.h"
#include "network/peak.h"

/* What a run leaves: the moments of its samples up to where it ended. */
typedef struct dea_trace {
    dea_moment *moments;           /* owned by the user: room for all rows */
    size_t count;                  /* samples in use */
    dea_state end;                 /* ok, or what all samples from count on are */
    double largest_u, largest_v;   /* on the way [m], [m/s] */
    double integrals[DEA_WINDOWS]; /* of u over the windows of the scene [m s] */
    dea_peak peak;                 /* of the current, behind a series resistance */
} dea_trace;

typedef struct dea_flight {
    const dea_scene *scene; /* borrowed, as signal */
    const dea_signal *signal;
    dea_motion motion;
    dea_rotation *swing;            /* owned */
    dea_integrator integrator; /* owned */
    N_Vector between;          /* owned: w between two steps */
    size_t rows;
    bool peaks; /* the current between samples is known */
    long spent;     /* steps of all runs */
    double loosest; /* tolerance of the first run */
    dea_error why;  /* what the last run that failed was about, "" before */
    /* of one run */
    double tolerance;
    dea_trace *trace;
    dea_audit *audit; /* NULL: not wanted */
    double y[DEA_MOTION_MOST];
    double reach[DEA_MOTION_MOST]; /* largest of each unknown on the way */
    long steps;
    double crawled; /* time of the segment at the last look whether it still passes [s] */
    int unseen;     /* steps since then */
    bool cut;       /* the segment ended early: the source came to its limit or from it */
    double cut_at;  /* time of the segment there [s] */
} dea_flight;

/* Prepares runs of a scene; the caller ends them with dea_flight_close(), also after a failure. */
dea_status dea_flight_open(const dea_sundials *sun, const dea_scene *scene, dea_dynamics *dynamics, const dea_signal *signal,
                           dea_flight *flight, dea_error *error);
void dea_flight_close(dea_flight *flight);

/* Its integrator; part of opening. */
dea_status dea_flight_integrator(const dea_sundials *sun, dea_flight *flight, dea_error *error);

/* Runs; with a summary, fills its energies. */
void dea_flight_run(dea_flight *flight, double tolerance, dea_trace *trace, dea_summary *summary);

/* Fits the sizes of the unknowns, which tolerances refer to, to what the last run reached: a film behind a large resistance, or
 * one too heavy or viscous to follow, gets nowhere near its equilibrium. True where one had to shrink. */
bool dea_flight_fit(dea_flight *flight);

/* Time of the next sample [s], infinite behind the last. */
double dea_flight_next_sample(const dea_flight *flight);
/* Keeps the state at a time of the segment as the next sample; false where the film has left its frame. */
bool dea_flight_record(dea_flight *flight, double time, const double *y);
/* True where so many steps are left. */
bool dea_flight_affords(dea_flight *flight, double steps);
/* Takes w of the end of a step as the state; `failed` past the most steps, `pull_in` where the film runs away. */
dea_state dea_flight_step(dea_flight *flight, double time, const double *w);

/* State at a time of the last step; false where there is none. */
typedef bool dea_flight_state(void *user, double time, double *y);
/* Time within the last step at which a source comes to its limit or from it, where the segment is then cut; else the end of the
 * step. */
double dea_flight_cut(dea_flight *flight, double before, double time, dea_flight_state *at, void *user);

/* `failed`, because a solver ended with an error code at a time of the segment. */
dea_state dea_flight_broke(dea_flight *flight, const char *solver, int code, double time);

/* Lines of the voltage up to that long are for Runge-Kutta, to whose steps a corner between two of them is nothing [s]; 0 where
 * the film does not swing. */
double dea_flight_short_line(dea_flight *flight);
/* The segment from a time on to its end, by IDA; what happened. */
dea_state dea_flight_implicit(dea_flight *flight, double from);
/* The segment up to a time, by Runge-Kutta. */
dea_state dea_flight_explicit(dea_flight *flight, double to);

#endif
