/* One run of a membrane on one mesh at one tolerance, as what solves it sees it: segment after segment of the voltage, the samples and
 * energies that it keeps, the steps that it may take. */
#ifndef DEA_RINGS_FLIGHT_H
#define DEA_RINGS_FLIGHT_H

#include "network/along.h"
#include "network/membrane_sample.h"
#include "network/peak.h"
#include "network/rings_motion.h"

/* What a run leaves: its samples up to where it ended. */
typedef struct dea_rings_trace {
    dea_sample *samples;           /* owned by the user: room for all rows */
    double *entries;               /* owned by the user: of each row over the radius, NULL: not wanted */
    size_t count;                  /* in use */
    dea_state end;                 /* ok, or what all samples from count on are */
    double largest;                /* |u| at the edge on the way [m] */
    double integrals[DEA_WINDOWS]; /* of u over the windows of the scene [m s] */
    dea_peak peak;                 /* of the current */
} dea_rings_trace;

typedef struct dea_rings_flight {
    const dea_scene *scene; /* borrowed, as the signal */
    const dea_signal *signal;
    dea_membrane membrane;
    dea_rings_motion motion;
    size_t rows;
    dea_along along; /* radii that samples tell the film at */
    bool peaks;    /* the current between samples is known */
    dea_error why; /* what a run that failed was about, "" before */
    dea_rings_state state; /* room for a look */
    /* of one run */
    double tolerance;
    dea_rings_trace *trace;
    dea_audit *audit; /* NULL: not wanted */
    bool derived;     /* rates that come with a state are those of the solver */
    long steps;
} dea_rings_flight;

/* Cuts the film of a scene and prepares runs; the caller closes `along`, also after a failure. */
dea_status dea_rings_flight_prepare(const dea_scene *scene, const dea_model *model, const dea_signal *signal, dea_rings_mesh mesh,
                                    dea_rings_flight *flight, dea_error *error);

/* Takes the displacements of a film without mass and damper to where the voltage at the begin of the segment wants them; false where
 * there is no such place. */
bool dea_rings_jump(dea_rings_flight *flight, double *y);
/* What is stored at y. */
dea_membrane_energy dea_rings_energy(dea_rings_flight *flight, double time, const double *y);
/* Time of the next sample [s], infinite behind the last. */
double dea_rings_next_sample(const dea_rings_flight *flight);
/* Keeps y, with its derivative, as the next sample and along the radius, at a time of the segment; @p charging: y' tells the current. False where the
 * film cannot be there. */
bool dea_rings_record(dea_rings_flight *flight, double time, const double *y, const double *rates, bool charging);
/* Current of the source at y [A]. */
double dea_rings_current(dea_rings_flight *flight, double time, const double *y, const double *rates, bool charging);
/* Adds @p weight times the powers at y to the audit. */
void dea_rings_audit(dea_rings_flight *flight, double time, const double *y, const double *rates, bool charging, double weight);
/* Counts a step that ended at y: `failed` past the most steps, `pull_in` where the film has no stable state left. */
dea_state dea_rings_step(dea_rings_flight *flight, double time, const double *y);
/* True where so many steps are left. */
bool dea_rings_affords(dea_rings_flight *flight, double steps);
/* `failed`, because a solver ended with an error code at a time of the segment. */
dea_state dea_rings_broke(dea_rings_flight *flight, const char *solver, int code, double time);

#endif
