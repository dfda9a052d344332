/* One libngspice in this process: start it, run a circuit, read its vectors. Runs only in a worker process, which it changes
 * (working directory, locale, environment) and which must end after a failure that leaves the library unusable. */
#ifndef DEA_NGSPICE_LIBRARY_H
#define DEA_NGSPICE_LIBRARY_H

#include "deaspice/status.h"

typedef struct dea_ngspice dea_ngspice;

/* A membrane of 60 nodes with six branches. */
enum { DEA_NGSPICE_COLUMNS = 1024 };

/* What came of a circuit: vectors of its plot, each with a value per point, or with real and imaginary part where it is complex.
 */
typedef struct dea_ngspice_table {
    double *columns[DEA_NGSPICE_COLUMNS]; /* owned by the caller: dea_ngspice_table_free() */
    size_t count;                         /* points that were solved, may be fewer than wanted */
} dea_ngspice_table;

/* Writes the file name of the library that is loaded, which tells its version ("libngspice.so.0.0.6"); in any process. */
void dea_ngspice_name(char *text, size_t size);
/* Starts the library with no start-up file of anybody. Ends with dea_ngspice_close(). */
dea_status dea_ngspice_open(dea_ngspice **library, dea_error *error);
void dea_ngspice_close(dea_ngspice *library);

/* Ends the next run, and no other, once it has so many points. */
void dea_ngspice_limit(dea_ngspice *library, size_t points);

/* Most characters of a command: the library copies it into 1024. */
enum { DEA_NGSPICE_COMMAND = 1000 };

/* Loads a netlist (one card a line) and runs its analysis, or where lines follow its `.end` card, these commands of the library in its
 * place: then the same netlist is not read again for the next ones, which change its numbers (`alter`). Copies the vectors @p names of the new plot, DEA_NGSPICE_COLUMNS at
 * most. A run that ends early is no failure of this call: it gives the points before its end. DEA_ERROR_ENGINE with the library's
 * log: the netlist was refused, or the library is lost. */
dea_status dea_ngspice_run_all(dea_ngspice *library, const char *netlist, const char *const *names, size_t name_count,
                               dea_ngspice_table *table, dea_error *error);
/* What the library said about a failure of the last run, "" where it said nothing. */
const char *dea_ngspice_complaint(const dea_ngspice *library);
void dea_ngspice_table_free(dea_ngspice_table *table);

#endif
