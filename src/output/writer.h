/* File formats of studies behind one table: a format is one file and one line in writer.c. */
#ifndef DEASPICE_OUTPUT_WRITER_H
#define DEASPICE_OUTPUT_WRITER_H

#include "deaspice/output.h"
#include "support/atomic.h"

typedef struct dea_format {
    const char *name; /* of --format, and the ending of files */
    bool straight;    /* can be written to a pipe or device */
    /* Starts a file; scene and file outlive the state. Returns the state through @p state, which the caller ends with close(). */
    dea_status (*open)(const dea_scene *scene, const char *engine, dea_atomic *file, void **state, dea_error *error);
    /* What a reader ought to know: dea_writer_note(); NULL: nothing. */
    bool (*note)(const void *state, char text[DEA_NOTE_LENGTH]);
    /* Appends points as the scene's dea_layout has them; they come in order, without gaps. */
    dea_status (*points)(void *state, size_t first, const void *points, size_t count, dea_error *error);
    /* Writes what is left when @p keep is true and frees the state; NULL is fine. */
    dea_status (*close)(void *state, bool keep, dea_error *error);
} dea_format;

extern const dea_format dea_format_csv, dea_format_netcdf, dea_format_raw;

#endif
