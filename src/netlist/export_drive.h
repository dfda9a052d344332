/* The part of a transient's deck that asks for no film. */
#ifndef DEA_EXPORT_DRIVE_H
#define DEA_EXPORT_DRIVE_H

#include "drive/signal.h"
#include "network/pace.h"
#include "netlist/export.h"

typedef struct dea_export_drive {
    dea_export *export; /* borrowed */
    FILE *out;
    const dea_dialect *dialect;
    dea_signal signal; /* owned */
    double step;       /* longest time step [s] */
    bool rings;        /* the step is that of a ring */
    double expected;   /* error of that step [1] */
    double quick;      /* shortest time of the film: a radian of its ring, or its fastest relaxation [s] */
    double evenly;     /* time over which a source at its limit charges the film, at least, behind each edge of a step [s], 0: at once */
} dea_export_drive;

/* Opens the scene's waveform; the caller ends it with dea_export_drive_close(), also after a failure. DEA_ERROR_UNSUPPORTED for one
 * that no netlist holds. */
dea_status dea_export_drive_open(dea_export *export, dea_export_drive *drive, dea_error *error);
void dea_export_drive_close(dea_export_drive *drive);
/* Sets the step for a film of these paces, and the note of the export where it is too long for the accuracy. */
void dea_export_drive_steps(dea_export_drive *drive, const dea_pace *paces, size_t count);
/* The source of the voltage at a node. */
void dea_export_drive_source(const dea_export_drive *drive, const char *node);
/* What is read off, the velocity from that node, and the analysis; last lines of the file. */
void dea_export_drive_analysis(const dea_export_drive *drive, const char *velocity);

#endif
