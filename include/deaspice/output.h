/** @file output.h
 * Writers of studies (CSV, NetCDF, SPICE raw). Points come in order, block after block, so memory does not grow
 * with the study (raw: it holds one run of the last axis). A file appears whole under its name or not at all.
 */
#ifndef DEASPICE_OUTPUT_H
#define DEASPICE_OUTPUT_H

#include "deaspice/result.h"
#include "deaspice/scene.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct dea_writer dea_writer;

/** Opens a writer of the study's rows; the scene must outlive it. Where the target cannot be written this fails, before any work.
 *
 * @param path   target, "-" for standard output (CSV and raw)
 * @param format "csv", "nc" or "raw"; NULL: from the ending of @p path, csv where it has none
 * @param engine name of the engine, for the provenance of the file
 * @param[out] writer the caller ends it with dea_writer_finish()
 * @return DEA_OK, DEA_ERROR_USAGE (unknown format), DEA_ERROR_IO, DEA_ERROR_MISSING (no NetCDF library), DEA_ERROR_MEMORY
 */
DEA_API dea_status dea_writer_open(const dea_scene *scene, const char *engine, const char *path, const char *format,
                                   dea_writer **writer, dea_error *error);
enum { DEA_NOTE_LENGTH = 256 };
/** Writes into @p text what whoever reads the file ought to know of its format; false where there is nothing. */
DEA_API bool dea_writer_note(const dea_writer *writer, char text[DEA_NOTE_LENGTH]);
/** Appends the rows of @p count points, laid out as dea_layout_of() says, the first of them being point number @p first: models
 * slowest, last axis fastest. */
DEA_API dea_status dea_writer_points(dea_writer *writer, size_t first, const void *points, size_t count, dea_error *error);
/** Ends the file: renames it into place when @p keep is true and all points came, else removes what was written. Frees the
 * writer; NULL is fine. A program that catches a signal calls it with @p keep false, from its main flow. */
DEA_API dea_status dea_writer_finish(dea_writer *writer, bool keep, dea_error *error);

#ifdef __cplusplus
}
#endif
#endif
