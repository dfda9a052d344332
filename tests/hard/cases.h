/* The suite of hard cases: a scene each, what every engine must do with it, and a judge that is none of them. */
#ifndef DEA_HARD_CASES_H
#define DEA_HARD_CASES_H

#include <stdio.h>
#include <time.h>

#include "motion.h"

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

/* What is right. */
typedef enum hard_judge { HARD_STATICS, HARD_RADAU, HARD_CREEP, HARD_RING, HARD_AC } hard_judge;

typedef struct hard_case {
    const char *name;  /* of the scene in tests/hard */
    const char *title; /* as the table prints it */
    hard_judge judge;
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

#define CASE(name, title, judge, ...)                                                                                            \
    {                                                                                                                            \
        name, title, judge, {__VA_ARGS__}, NULL                                                                                  \
    }
#define THINNED(name, title, judge, setting, ...)                                                                                \
    {                                                                                                                            \
        name, title, judge, {__VA_ARGS__}, setting                                                                               \
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

typedef union hard_known {
    hard_answer statics;
    hard_sample *samples;     /* owned */
    hard_response *responses; /* owned */
} hard_known;

static inline hard_sample *hard_samples(size_t rows)
{
    hard_sample *samples = calloc(rows, sizeof *samples);
    if (!samples) {
        abort();
    }
    return samples;
}

/* u = u_static (1 - cos omega t) behind a jump at t = 0. */
static inline hard_sample *hard_ring(const hard_motion *m, size_t rows)
{
    hard_sample *samples = hard_samples(rows);
    const long double voltage = hard_source(m, 0.0L, true);
    const hard_edge rest = hard_edge_at(&m->film, 0.0L), slope = hard_edge_slope(&m->film, 0.0L);
    const long double stiffness = slope.stress - slope.push * voltage * voltage;
    for (size_t i = 0; i < rows; i++) {
        const long double t = dea_layout_place(m->scene, i);
        const long double u = rest.push * voltage * voltage / stiffness * (1.0L - cosl(sqrtl(stiffness / m->mass) * t));
        samples[i] = (hard_sample){u, hard_edge_at(&m->film, u).capacitance * voltage, (long double)NAN};
    }
    return samples;
}

/* Largest differences of two answers over the peaks. */
static inline double hard_distance(const hard_sample *a, const hard_sample *b, size_t rows)
{
    long double u = 0.0L, peak = 0.0L;
    for (size_t i = 0; i < rows; i++) {
        u = fmaxl(u, fabsl(a[i].u - b[i].u));
        peak = fmaxl(peak, fabsl(b[i].u));
    }
    return peak > 0.0L ? (double)(u / peak) : 0.0;
}

/* Product integration on three meshes, extrapolated twice: its error is even in the width of the steps. */
static inline hard_sample *hard_creep(const hard_motion *m, size_t rows, double *own_error)
{
    hard_sample *runs[3];
    for (int i = 0; i < 3; i++) {
        runs[i] = hard_samples(rows);
        hard_creep_run(m, 1 << i, rows, runs[i]);
    }
    for (size_t i = 0; i < rows; i++) {
        runs[0][i].u = (4.0L * runs[1][i].u - runs[0][i].u) / 3.0L;
        runs[1][i].u = (4.0L * runs[2][i].u - runs[1][i].u) / 3.0L;
        runs[2][i].u = (16.0L * runs[1][i].u - runs[0][i].u) / 15.0L;
        const long double voltage = hard_source(m, dea_layout_place(m->scene, i), i == 0);
        runs[2][i].charge = hard_edge_at(&m->film, runs[2][i].u).capacitance * voltage;
    }
    *own_error = hard_distance(runs[1], runs[2], rows);
    free(runs[0]);
    free(runs[1]);
    return runs[2];
}

static inline hard_sample *hard_step_through(const hard_motion *m, size_t rows, double *own_error)
{
    hard_sample *coarse = hard_samples(rows), *fine = hard_samples(rows);
    hard_radau(m, 1, rows, coarse);
    hard_radau(m, 2, rows, fine);
    *own_error = hard_distance(coarse, fine, rows) / 30.0;
    free(coarse);
    return fine;
}

static inline hard_response *hard_responses(const hard_motion *m, size_t rows)
{
    hard_response *responses = calloc(rows, sizeof *responses);
    hard_film still = m->film;
    if (!responses) {
        abort();
    }
    still.voltage = (long double)m->scene->ac.bias / (1.0L + m->series * m->conductance);
    const long double u = hard_statics(&still).strain * m->film.edge;
    for (size_t i = 0; i < rows; i++) {
        responses[i] = hard_respond(m, m->scene->ac.bias, u, dea_layout_place(m->scene, i));
    }
    return responses;
}

/* The truth of one point, and an estimate of its own error. */
static inline hard_known hard_know(const hard_case *c, const dea_scene *here, const dea_model *model, double *own_error)
{
    const size_t rows = dea_layout_of(here).rows;
    const hard_motion m = hard_motion_of(here, model);
    *own_error = 0.0;
    switch (c->judge) {
    case HARD_RADAU:
        return (hard_known){.samples = hard_step_through(&m, rows, own_error)};
    case HARD_CREEP:
        return (hard_known){.samples = hard_creep(&m, rows, own_error)};
    case HARD_RING:
        return (hard_known){.samples = hard_ring(&m, rows)};
    case HARD_AC:
        return (hard_known){.responses = hard_responses(&m, rows)};
    case HARD_STATICS:
        break;
    }
    return (hard_known){.statics = hard_statics(&m.film)};
}

/* ---- comparison */

static inline void hard_complain(hard_verdict *v, const char *what, size_t point, size_t row, double got, double wanted)
{
    if (v->wrong[0] == '\0') {
        snprintf(v->wrong, sizeof v->wrong, "%s of point %zu, row %zu: %.17g, wanted %.17g", what, point, row, got, wanted);
    }
}

static inline void hard_compare_static(hard_verdict *v, size_t point, const dea_row *row, const hard_answer *known)
{
    if (row->state == DEA_STATE_FAILED && known->state != DEA_STATE_FAILED) {
        v->failed++;
    } else if (row->state != known->state) {
        hard_complain(v, dea_state_name(row->state), point, 0, row->strain, (double)known->strain);
    } else if (row->state == DEA_STATE_OK || row->state == DEA_STATE_SLACK) {
        const long double miss = fabsl(row->strain - known->strain);
        const double error = miss == 0.0L ? 0.0 : (double)(miss / fabsl(known->strain));
        v->error = fmax(v->error, error);
        if (!(error <= v->accuracy)) {
            hard_complain(v, "strain", point, 0, row->strain, (double)known->strain);
        }
    }
}

/* Largest |a - b|/peak; a NAN counts as infinitely wrong. */
static inline double hard_over_peak(long double miss, long double peak)
{
    return miss == 0.0L ? 0.0 : !(miss >= 0.0L) || peak == 0.0L ? (double)INFINITY : (double)(miss / peak);
}

static inline void hard_compare_samples(hard_verdict *v, size_t point, const dea_sample *got, const hard_sample *known,
                                        size_t rows)
{
    hard_sample miss = {0}, peak = {0};
    for (size_t i = 0; i < rows; i++) {
        if (got[i].state == DEA_STATE_FAILED) {
            v->failed++;
            return;
        }
        const bool port = !isnan(got[i].charge), flows = port && !isnan((double)known[i].current);
        peak.u = fmaxl(peak.u, fabsl(known[i].u));
        peak.charge = fmaxl(peak.charge, fabsl(known[i].charge));
        peak.current = flows ? fmaxl(peak.current, fabsl(known[i].current)) : peak.current;
        const long double u = fabsl(got[i].displacement - known[i].u);
        miss.u = u >= 0.0L ? fmaxl(miss.u, u) : (long double)INFINITY;
        miss.charge = port ? fmaxl(miss.charge, fabsl(got[i].charge - known[i].charge)) : miss.charge;
        miss.current = flows ? fmaxl(miss.current, fabsl(got[i].current - known[i].current)) : miss.current;
    }
    const double error = fmax(hard_over_peak(miss.u, peak.u), hard_over_peak(miss.charge, peak.charge));
    v->error = fmax(v->error, error);
    const long double mean =
        peak.charge / got[rows - 1].time; /* a current that no sample sees brings the charge within the run */
    v->current = fmax(v->current, hard_over_peak(miss.current, fmaxl(peak.current, mean)));
    if (!(error <= v->accuracy)) {
        hard_complain(v, "displacement or charge", point, rows, error, 0.0);
    }
}

static inline double hard_polar_error(double magnitude, double degrees, long double complex known)
{
    const long double complex got = magnitude * cexpl(I * (degrees * hard_pi / 180.0L));
    const long double size = cabsl(known), miss = cabsl(got - known);
    return miss == 0.0L ? 0.0 : !(miss >= 0.0L) ? (double)INFINITY : (double)(miss / size);
}

static inline void hard_compare_responses(hard_verdict *v, size_t point, const dea_response *got, const hard_response *known,
                                          size_t rows)
{
    double error = 0.0;
    for (size_t i = 0; i < rows; i++) {
        if (got[i].state == DEA_STATE_FAILED) {
            v->failed++;
            return;
        }
        const double u = hard_polar_error(got[i].displacement, got[i].displacement_phase, known[i].displacement);
        error = fmax(error, fmax(u, hard_polar_error(got[i].impedance, got[i].impedance_phase, known[i].impedance)));
    }
    v->error = fmax(v->error, error);
    if (!(error <= v->accuracy)) {
        hard_complain(v, "response", point, rows, error, 0.0);
    }
}

static inline void hard_compare_point(const hard_case *c, hard_verdict *v, size_t point, const void *got, const hard_known *known,
                                      size_t rows)
{
    if (c->judge == HARD_STATICS) {
        hard_compare_static(v, point, got, &known->statics);
    } else if (c->judge == HARD_AC) {
        hard_compare_responses(v, point, got, known->responses, rows);
    } else {
        hard_compare_samples(v, point, got, known->samples, rows);
    }
}

/* ---- running */

/* A scene, and the truth of all points of all its models. */
typedef struct hard_subject {
    const hard_case *of;
    dea_scene scene;
    size_t points; /* of one model */
    hard_known *known;
    double own_error; /* of the truth */
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

static inline dea_status hard_take(void *user, size_t first, const void *points, size_t count, dea_error *error)
{
    const hard_run *run = user;
    (void)error;
    for (size_t i = 0; i < count; i++) {
        const hard_known *known = &run->subject->known[run->model * run->subject->points + first + i];
        hard_compare_point(run->subject->of, run->verdict, first + i, (const char *)points + i * run->layout.point_size, known,
                           run->layout.rows);
        run->verdict->points++;
    }
    return DEA_OK;
}

static inline double hard_now(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

/* Places the axes of a study at a point, the last one fastest. */
static inline void hard_place_axes(dea_scene *scene, size_t point)
{
    for (size_t i = scene->axis_count; i-- > 0;) {
        const dea_axis *axis = &scene->axes[i];
        const double value = axis->values[point % axis->count];
        memcpy((char *)scene + axis->offset, &value, sizeof value);
        point /= axis->count;
    }
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
        double own = 0.0;
        hard_place_axes(&here, i % s->points);
        s->known[i] = hard_know(c, &here, s->scene.models[i / s->points], &own);
        s->own_error = fmax(s->own_error, own);
    }
    return true;
}

static inline void hard_end(hard_subject *s)
{
    for (size_t i = 0; s->known && s->of->judge != HARD_STATICS && i < s->points * s->scene.model_count; i++) {
        free(s->known[i].samples); /* or responses: one place */
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
