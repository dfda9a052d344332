/* The suite of hard cases: a scene each, what every engine must do with it, and a judge that is none of them. */
#ifndef DEA_HARD_CASES_H
#define DEA_HARD_CASES_H

#include <complex.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "../promises/truths.h"
#include "scene/line.h"

/* What an engine must do with a scene. */
typedef enum hard_demand {
    HARD_NONE,    /* nothing is written down: a failure of the suite */
    HARD_RIGHT,   /* every point right to the accuracy of the scene; with words: it must say these too, about the current */
    HARD_PARTLY,  /* some points failed, with these words, all others right */
    HARD_REFUSED, /* every point failed, with these words */
    HARD_CANNOT   /* the engine refuses all models of the scene at once, with these words */
} hard_demand;

typedef struct hard_cell {
    hard_demand demand;
    const char *words;
} hard_cell;

enum { HARD_ENGINES = 3, HARD_LOG = 16384 };
static const char *const hard_engine_names[HARD_ENGINES] = {"direct", "ngspice", "ida"};

typedef struct hard_case {
    const char *name;  /* of the scene in tests/hard */
    const char *title; /* as the table prints it */
    bool swings; /* for ever: an undamped linear film, whose truth is its closed form */
    hard_cell cells[HARD_ENGINES];
    const char *thinned; /* setting with which a test runs it, NULL: as it is */
} hard_case;

/* What became of a case with one engine. */
typedef struct hard_verdict {
    bool runs; /* the engine takes at least one model of the scene */
    size_t points, failed;
    double error;    /* of strain or displacement and charge, relative: to itself in statics and AC, to its peak in time */
    double current;  /* the same of the current, where it is judged */
    double accuracy; /* wanted */
    double seconds;
    char wrong[512];    /* the first point whose state or number is wrong, empty: none */
    char log[HARD_LOG]; /* all that the engine said */
} hard_verdict;

#define CASE(name, title, ...)                                                                                                   \
    {                                                                                                                            \
        name, title, false, {__VA_ARGS__}, NULL                                                                                  \
    }
#define SWINGS(name, title, ...)                                                                                                 \
    {                                                                                                                            \
        name, title, true, {__VA_ARGS__}, NULL                                                                                   \
    }
#define THINNED(name, title, setting, ...)                                                                                       \
    {                                                                                                                            \
        name, title, false, {__VA_ARGS__}, setting                                                                               \
    }
#define RIGHT                                                                                                                    \
    {                                                                                                                            \
        HARD_RIGHT, NULL                                                                                                         \
    }
#define DOUBTED(words)                                                                                                           \
    {                                                                                                                            \
        HARD_RIGHT, words                                                                                                        \
    }
#define PARTLY(words)                                                                                                            \
    {                                                                                                                            \
        HARD_PARTLY, words                                                                                                       \
    }
#define REFUSED(words)                                                                                                           \
    {                                                                                                                            \
        HARD_REFUSED, words                                                                                                      \
    }
#define CANNOT(words)                                                                                                            \
    {                                                                                                                            \
        HARD_CANNOT, words                                                                                                       \
    }

#include "table.h"

enum { HARD_CASES = sizeof hard_cases / sizeof *hard_cases };

/* ---- references, one point of one model */

/* Rows of what is right, as the scene's layout has them. */
typedef struct hard_known {
    void *rows;   /* owned */
    double error; /* of their own, relative */
} hard_known;

/* u = u_static (1 - cos omega t) behind a jump at t = 0. */
static inline void hard_swing(const dea_scene *here, const dea_model *model, size_t rows, dea_sample *samples)
{
    const true_film film = film_of(here, model);
    const long double voltage = here->drive.waveform.step.voltage, square = voltage * voltage;
    const true_edge rest = film_edge(&film, 0.0L);
    const long double stiffness = edge_viscous(&rest) - rest.push.slope * square, pace = sqrtl(stiffness / film.mass);
    for (size_t i = 0; i < rows; i++) {
        const double time = dea_layout_place(here, i);
        const long double u = rest.push.value * square / stiffness * (1.0L - cosl(pace * time));
        const dea_row row = film_row(&film, u, voltage);
        samples[i] = (dea_sample){.time = time, .displacement = (double)u, .charge = row.charge, .state = row.state};
    }
}

static inline void hard_move(const dea_scene *here, const dea_model *model, hard_known *known)
{
    true_run run = moving_truth(here, model, 1.0);
    memcpy(known->rows, run.samples, run.count * sizeof *run.samples);
    known->error = run.why ? (double)INFINITY : run.error;
    true_run_free(&run);
}

/* An electrode as wide as the frame is no actuator. */
static inline void hard_rest(const dea_scene *here, const dea_model *model, hard_known *known)
{
    true_row truth = {.row = dea_row_failed()};
    if (film_of(here, model).coverage < 1.0L) {
        truth = still_truth(here, model, 1.0);
    }
    *(dea_row *)known->rows = truth.row;
    known->error = truth.error;
}

/* The truth of one point; the caller frees its rows. */
static inline hard_known hard_know(const hard_case *c, const dea_scene *here, const dea_model *model)
{
    const dea_layout layout = dea_layout_of(here);
    hard_known known = {.rows = calloc(layout.rows, layout.row_size)};
    if (!known.rows) {
        abort();
    }
    if (c->swings) {
        hard_swing(here, model, layout.rows, known.rows);
    } else if (here->study == DEA_STUDY_TRANSIENT) {
        hard_move(here, model, &known);
    } else if (here->study == DEA_STUDY_AC) {
        known.error = response_truth(here, model, known.rows);
    } else {
        hard_rest(here, model, &known);
    }
    return known;
}

/* ---- comparison */

static inline void hard_complain(hard_verdict *v, const char *what, size_t point, size_t row, double got, double wanted)
{
    if (v->wrong[0] == '\0') {
        snprintf(v->wrong, sizeof v->wrong, "%s of point %zu, row %zu: %.17g, wanted %.17g", what, point, row, got, wanted);
    }
}

static inline void hard_compare_static(hard_verdict *v, size_t point, const dea_row *row, const dea_row *known)
{
    if (row->state == DEA_STATE_FAILED && known->state != DEA_STATE_FAILED) {
        v->failed++;
    } else if (row->state != known->state) {
        hard_complain(v, dea_state_name(row->state), point, 0, row->strain, known->strain);
    } else if (row->state == DEA_STATE_OK || row->state == DEA_STATE_SLACK) {
        const double miss = fabs(row->strain - known->strain);
        const double error = miss <= 0.0 ? 0.0 : miss / fabs(known->strain);
        v->error = fmax(v->error, error);
        if (!(error <= v->accuracy)) {
            hard_complain(v, "strain", point, 0, row->strain, known->strain);
        }
    }
}

/* Largest miss over the largest value of a column; a miss that is no number counts as infinitely wrong. */
typedef struct hard_column {
    double miss, peak;
} hard_column;

static inline void hard_widen(hard_column *column, double got, double known)
{
    const double miss = fabs(got - known);
    column->peak = fmax(column->peak, fabs(known));
    column->miss = miss >= 0.0 ? fmax(column->miss, miss) : (double)INFINITY;
}

static inline double hard_over_peak(const hard_column *column)
{
    return column->miss <= 0.0 ? 0.0 : column->peak <= 0.0 ? (double)INFINITY : column->miss / column->peak;
}

/* The current is judged behind a resistance: that of a jump is none. */
static inline void hard_compare_samples(hard_verdict *v, size_t point, const dea_sample *got, const dea_sample *known,
                                        size_t rows, bool resists)
{
    hard_column u = {0}, charge = {0}, current = {0};
    for (size_t i = 0; i < rows; i++) {
        if (got[i].state == DEA_STATE_FAILED) {
            v->failed++;
            return;
        }
        if ((got[i].state == DEA_STATE_PULL_IN) != (known[i].state == DEA_STATE_PULL_IN)) {
            hard_complain(v, dea_state_name(got[i].state), point, i, got[i].displacement, known[i].displacement);
        }
        if (got[i].state == DEA_STATE_PULL_IN) {
            continue;
        }
        const bool port = !isnan(got[i].charge);
        hard_widen(&u, got[i].displacement, known[i].displacement);
        hard_widen(&charge, port ? got[i].charge : 0.0, port ? known[i].charge : 0.0);
        hard_widen(&current, port && resists ? got[i].current : 0.0, port && resists ? known[i].current : 0.0);
    }
    const double error = fmax(hard_over_peak(&u), hard_over_peak(&charge));
    v->error = fmax(v->error, error);
    current.peak = fmax(current.peak, charge.peak / got[rows - 1].time); /* one that no sample sees brings the charge within the run */
    v->current = fmax(v->current, hard_over_peak(&current));
    if (!(error <= v->accuracy)) {
        hard_complain(v, "displacement or charge", point, rows, error, 0.0);
    }
}

static inline double hard_polar_error(double size, double degrees, double known_size, double known_degrees)
{
    const double angle = (degrees - known_degrees) * (3.14159265358979323846 / 180.0);
    const double miss = cabs(size * cexp(I * angle) - known_size);
    return miss <= 0.0 ? 0.0 : !(miss >= 0.0) ? (double)INFINITY : miss / known_size;
}

static inline void hard_compare_responses(hard_verdict *v, size_t point, const dea_response *got, const dea_response *known,
                                          size_t rows)
{
    double error = 0.0;
    for (size_t i = 0; i < rows; i++) {
        const dea_response *a = &got[i], *b = &known[i];
        if (a->state == DEA_STATE_FAILED) {
            v->failed++;
            return;
        }
        if ((a->state == DEA_STATE_PULL_IN) != (b->state == DEA_STATE_PULL_IN)) {
            hard_complain(v, dea_state_name(a->state), point, i, a->displacement, b->displacement);
        }
        if (a->state != DEA_STATE_PULL_IN) {
            error = fmax(error, hard_polar_error(a->displacement, a->displacement_phase, b->displacement, b->displacement_phase));
            error = fmax(error, hard_polar_error(a->impedance, a->impedance_phase, b->impedance, b->impedance_phase));
        }
    }
    v->error = fmax(v->error, error);
    if (!(error <= v->accuracy)) {
        hard_complain(v, "response", point, rows, error, 0.0);
    }
}

/* ---- running */

/* A scene, and the truth of all points of all its models. */
typedef struct hard_subject {
    const hard_case *of;
    dea_scene scene;
    size_t points; /* of one model */
    hard_known *known; /* owned, points of one model after the other */
    double own_error;  /* of the truth */
} hard_subject;

typedef struct hard_run {
    const hard_subject *subject;
    size_t model; /* which of the scene */
    dea_layout layout;
    hard_verdict *verdict;
} hard_run;

static inline void hard_note(hard_verdict *v, const char *line)
{
    const size_t used = strlen(v->log);
    snprintf(v->log + used, sizeof v->log - used, "%s\n", line);
}

static inline void hard_take_log(void *user, const char *line)
{
    const hard_run *run = user;
    hard_note(run->verdict, line);
}

static inline void hard_compare(const hard_run *run, size_t point, const void *got, const void *known)
{
    const dea_scene *scene = &run->subject->scene;
    if (scene->study == DEA_STUDY_SWEEP) {
        hard_compare_static(run->verdict, point, got, known);
    } else if (scene->study == DEA_STUDY_AC) {
        hard_compare_responses(run->verdict, point, got, known, run->layout.rows);
    } else {
        dea_scene here = *scene;
        dea_axes_place(&here, point);
        hard_compare_samples(run->verdict, point, got, known, run->layout.rows, here.drive.series_resistance > 0.0);
    }
}

static inline dea_status hard_take(void *user, size_t first, const void *points, size_t count, dea_error *error)
{
    const hard_run *run = user;
    (void)error;
    for (size_t i = 0; i < count; i++) {
        const hard_known *known = &run->subject->known[run->model * run->subject->points + first + i];
        hard_compare(run, first + i, (const char *)points + i * run->layout.point_size, known->rows);
        run->verdict->points++;
    }
    return DEA_OK;
}

/* Time of the processor that this process has taken: a busy machine does not count. */
static inline double hard_now(void)
{
    struct timespec now;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

/* Reads a scene, thinned or whole, and finds its truth; false with a message. The caller ends it with hard_end(). */
static inline bool hard_begin(const hard_case *c, const char *folder, bool whole, hard_subject *s, dea_error *error)
{
    char path[512];
    const dea_setting setting = {c->thinned};
    snprintf(path, sizeof path, "%s/%s.yaml", folder, c->name);
    *s = (hard_subject){.of = c};
    if (dea_scene_read(path, &setting, !whole && c->thinned ? 1 : 0, NULL, &s->scene, error) != DEA_OK) {
        return false;
    }
    s->points = dea_scene_point_count(&s->scene);
    s->known = calloc(s->points * s->scene.model_count, sizeof *s->known);
    if (!s->known) {
        abort();
    }
    for (size_t i = 0; i < s->points * s->scene.model_count; i++) {
        dea_scene here = s->scene;
        dea_axes_place(&here, i % s->points);
        s->known[i] = hard_know(c, &here, s->scene.models[i / s->points]);
        s->own_error = fmax(s->own_error, s->known[i].error);
    }
    return true;
}

static inline void hard_end(hard_subject *s)
{
    for (size_t i = 0; s->known && i < s->points * s->scene.model_count; i++) {
        free(s->known[i].rows);
    }
    free(s->known);
    dea_scene_free(&s->scene);
}

/* All models of the scene that the engine takes, one after the other. */
static inline hard_verdict hard_try(const hard_subject *s, size_t engine)
{
    const dea_engine *of = dea_engine_find(hard_engine_names[engine]);
    hard_verdict v = {.accuracy = s->scene.accuracy};
    for (size_t i = 0; i < s->scene.model_count; i++) {
        dea_scene one = s->scene;
        dea_error error = {0};
        hard_run run = {s, i, dea_layout_of(&one), &v};
        const dea_run_options options = {.jobs = 1, .points = hard_take, .log = hard_take_log, .user = &run};
        one.models[0] = s->scene.models[i];
        one.model_count = 1;
        const char *why = dea_engine_refuses(of, &one, one.models[0]);
        if (why) {
            hard_note(&v, why);
            continue;
        }
        v.runs = true;
        const double from = hard_now();
        if (dea_study_run(&one, of, &options, &error) != DEA_OK) {
            hard_note(&v, error.message);
            v.failed += s->points;
            v.points += s->points;
        }
        v.seconds += hard_now() - from;
    }
    return v;
}

/* A current is a slope: it may be so much worse than what it is the slope of. */
static const double current_slack = 30.0;

/* NULL where the verdict meets the demand, else what is wrong, in @p text. */
static inline const char *hard_shortfall(const hard_cell *cell, const hard_verdict *v, double own_error, char *text, size_t size)
{
    const bool said = !cell->words || strstr(v->log, cell->words) != NULL;
    const bool judges = cell->demand == HARD_RIGHT || cell->demand == HARD_PARTLY;
    const char *why = NULL;
    if (cell->demand == HARD_NONE) {
        why = "nothing is expected of this engine";
    } else if ((cell->demand == HARD_CANNOT) == v->runs) {
        why = v->runs ? "it runs" : "it does not run";
    } else if (!said) {
        why = "it does not say so";
    } else if (v->wrong[0] != '\0') {
        why = v->wrong;
    } else if (judges && !(own_error <= 0.1 * v->accuracy)) {
        why = "the reference is not good enough";
    } else if (cell->demand == HARD_RIGHT && v->failed > 0) {
        why = "points failed";
    } else if (cell->demand == HARD_PARTLY && (v->failed == 0 || v->failed == v->points)) {
        why = "none or all of the points failed";
    } else if (cell->demand == HARD_REFUSED && v->failed < v->points) {
        why = "points did not fail";
    } else if (cell->demand == HARD_RIGHT && !cell->words && !(v->current <= current_slack * v->accuracy)) {
        why = "the current is wrong";
    }
    if (why) {
        snprintf(text, size, "%s; %zu of %zu points failed, error %.3g, current %.3g, reference %.3g\n%s", why, v->failed,
                 v->points, v->error, v->current, own_error, v->log);
    }
    return why ? text : NULL;
}

#endif
