/* Frequency responses of a film about its bias, whatever its network: its elements are linear, so that no operating point is looked
 * for and every frequency is solved exactly. */
#ifndef DEA_NGSPICE_BANDS_H
#define DEA_NGSPICE_BANDS_H

#include <complex.h>

#include "deaspice/measures.h"
#include "engine/ngspice/library.h"
#include "netlist/mobility.h"

/* Per volt of the source: displacement of the edge [m/V], and what the source sees [Ohm]. */
typedef struct dea_answer {
    double complex displacement, impedance;
} dea_answer;

typedef struct dea_bands {
    dea_ngspice *library; /* borrowed */
    const dea_scene *scene;
    const dea_dynamics *film; /* borrowed: its resistances */
    double capacitance;       /* at the bias [F] */
    double transduction;      /* 2 phi U at the bias [A s/m]; NAN: the node `motion` holds the charge that the motion brings */
    const char *edge;         /* node of the displacement; that of the film's voltage is `film` */
    const void *user;         /* borrowed */
    void (*write)(const void *user, FILE *out); /* the network with its source of 1 V */
} dea_bands;

/* A film of one node at its bias. */
typedef struct dea_biased_film {
    dea_dynamics *dynamics; /* borrowed */
    dea_mobility_bias bias;
} dea_biased_film;
dea_bands dea_bands_of_film(const dea_biased_film *film, const dea_scene *scene, dea_ngspice *library);

/* The netlist of a band; on DEA_OK the caller frees *text. */
dea_status dea_bands_write(const dea_bands *bands, const dea_mobility_band *band, char **text, dea_error *error);
/* Answers at all frequencies of the scene, @p count. */
dea_status dea_bands_run(const dea_bands *bands, size_t count, dea_answer *answers, dea_error *error);
/* Fills the rows from them, without numbers where @p state has none, and, where it is not NULL, resonance and bandwidth. */
void dea_bands_fill(const dea_bands *bands, size_t count, const dea_answer *answers, dea_state state, dea_response *rows,
                    dea_band *band);

#endif
