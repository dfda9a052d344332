/* The benchmark: one table, goals beside what was measured, errors beside speeds. */
#ifndef DEA_BENCH_H
#define DEA_BENCH_H

#include "deaspice/engine.h"

enum { BENCH_RUNS = 5 };

/* Prints one row of the table; met < 0: there is no goal. */
void bench_row(const char *what, const char *goal, int met, const char *measured, const char *error);
/* Ends the program with a message. */
_Noreturn void bench_give_up(const char *format, ...) DEA_PRINTF(1, 2);

/* Seconds of a steady clock. */
double bench_now(void);
/* Sorts the values and returns their median. */
double bench_median(double *values, size_t count);
/* Zeroed memory that forked children share with this process; ends with it. */
void *bench_shared(size_t size);
/* Runs the function in a child process and waits for it; false where it did not return. */
bool bench_fork(void (*function)(void *), void *argument);

/* One actuator of the paper (30 mm, 100 um, Elastosil 2030) with the lines of a `sweep:`, each with its indent; freed by the
 * caller. */
dea_scene bench_scene(const char *kind, const char *model, double prestretch, double accuracy, const char *sweep);
/* Rows of all points of the scene's first model by that engine, in this process or in a child. Seconds of sweep() alone. */
double bench_sweep(const dea_engine *engine, const dea_scene *scene, dea_row *rows);
/* The same of one transient, the median of BENCH_RUNS runs; NAN where the engine failed. The samples lie in memory of bench_shared(). */
double bench_transient(const dea_engine *engine, const dea_scene *scene, dea_sample *samples);
/* Largest relative difference of any column of ok rows; infinite where states differ. */
double bench_difference(const dea_row *rows, const dea_row *reference, size_t count);

/* Starts the program, waits, and returns seconds; *megabytes is the resident memory of its largest process. */
double bench_program_seconds(char *const *arguments, double *megabytes);

/* Strain by the equations of the model in extended precision; NAN where the model has none here. */
long double bench_strain(const char *model, const dea_point *point);

/* Groups of rows. @p program is the path of deaspice, @p peers the folder of the scripts. */
void bench_agreement(void);
void bench_engines(const char *peers);
void bench_workers(void);
void bench_program(const char *program);
void bench_transients(const char *program, const char *peers);
void bench_membranes(void);
void bench_omissions(const char *examples);
void bench_peers(const char *peers);

#endif
