#include "program/findings.h"

#include <math.h>
#include <string.h>

#include "deaspice/model.h"
#include "drive/wave.h"
#include "program/omissions.h"
#include "scene/line.h"
#include "study/study.h"
#include "support/number.h"

static const double negligible = 1e-4; /* overshoot: below it is what samples and an engine's error make of none */
static const double doubtful = 2e-3;   /* relative width of an interval that is told as such */
static const double aliased = 0.5;     /* periods from one sample to the next that show another frequency */

static void print_number(FILE *stream, double value)
{
    char text[DEA_NUMBER_LENGTH + 1];
    text[dea_number_write(text, value)] = '\0';
    fputs(text, stream);
}

dea_findings dea_findings_begin(const dea_scene *scene, FILE *averages)
{
    const double none = (double)NAN;
    const bool averaged = dea_study_of(scene)->timed && scene->transient.average_count > 0;
    dea_findings findings = {.scene = scene,
                             .layout = dea_layout_of(scene),
                             .averages = averaged ? averages : NULL,
                             .error = none,
                             .velocity_error = none,
                             .current_error = none,
                             .residual = none,
                             .pull_in = none,
                             .resonance = {none, none}};
    for (size_t i = 0; i < scene->model_count; i++) {
        findings.answers[i] = dea_answer_begin();
    }
    if (findings.averages) {
        fputs(scene->model_count > 1 ? "model," : "", averages);
        for (size_t i = 0; i < scene->axis_count; i++) {
            fprintf(averages, "%s,", scene->axes[i].column);
        }
        size_t count;
        const dea_column *columns = dea_window_columns(scene, &count);
        fputs("from_s,to_s,strain,displacement_m", averages);
        for (size_t i = 0; i < count; i++) {
            fprintf(averages, ",%s", columns[i].name);
        }
        fputc('\n', averages);
    }
    return findings;
}

/* Model and axes of run number @p number: last axis fastest, models slowest. */
static void print_place(FILE *stream, const dea_scene *scene, size_t number)
{
    if (scene->model_count > 1) {
        fprintf(stream, "%s,", scene->models[number / dea_scene_point_count(scene)]->name);
    }
    for (size_t i = 0; i < scene->axis_count; i++) {
        print_number(stream, scene->axes[i].values[dea_axis_index(scene, i, number)]);
        fputc(',', stream);
    }
}

/* Windows of a run: means, then what the samples tell of them. */
static void print_averages(const dea_findings *findings, size_t number, const dea_scene *placed, const dea_sample *samples)
{
    size_t told;
    const dea_column *columns = dea_window_columns(placed, &told);
    for (size_t i = 0; findings->averages && i < placed->transient.average_count; i++) {
        const dea_window window = placed->transient.averages[i];
        const dea_average mean = findings->summary.averages[i];
        const dea_window_figures f = dea_measure_window(placed, samples, findings->layout.rows, &findings->summary, i);
        const double means[] = {window.from, window.to, mean.strain, mean.displacement};
        print_place(findings->averages, findings->scene, number);
        for (size_t k = 0; k < sizeof means / sizeof *means; k++) {
            print_number(findings->averages, means[k]);
            fputc(',', findings->averages);
        }
        for (size_t k = 0; k < told; k++) {
            print_number(findings->averages, dea_layout_number(&f, columns[k].offset));
            fputc(k + 1 < told ? ',' : '\n', findings->averages);
        }
    }
}

/* The weakest places of a run that tells them. */
static void take_weakest(dea_findings *findings, const dea_sample *samples)
{
    dea_weakest *weakest = &findings->weakest;
    *weakest = (dea_weakest){.field = -INFINITY, .tension = INFINITY};
    for (size_t i = 0; i < findings->layout.rows; i++) {
        const dea_weakest *here = &samples[i].weakest;
        if (here->field > weakest->field) {
            weakest->field = here->field;
            weakest->field_radius = here->field_radius;
            findings->weakest_times[0] = samples[i].time;
        }
        if (here->tension < weakest->tension) {
            weakest->tension = here->tension;
            weakest->tension_radius = here->tension_radius;
            findings->weakest_times[1] = samples[i].time;
        }
    }
}

static void take_transient(dea_findings *findings, size_t number, const void *point)
{
    const dea_layout *layout = &findings->layout;
    const dea_sample *samples = point;
    findings->summary = *dea_layout_summary(layout, point);
    findings->error = fmax(findings->error, findings->summary.error);
    findings->velocity_error = fmax(findings->velocity_error, findings->summary.velocity_error);
    findings->current_error = fmax(findings->current_error, findings->summary.current_error);
    findings->residual = fmax(findings->residual, findings->summary.residual);
    findings->reduced += findings->summary.omitted > 0.0 ? 1 : 0;
    findings->omitted = fmax(findings->omitted, findings->summary.omitted);
    const dea_scene placed = dea_scene_of_run(findings->scene, number);
    if (dea_scene_point_count(findings->scene) * findings->scene->model_count == 1) { /* of several runs they are not told */
        findings->edge_count = dea_measure_edges(&placed, samples, layout->rows, &findings->summary, findings->edges);
    }
    for (size_t i = 0; i < layout->rows; i++) {
        if (samples[i].state == DEA_STATE_PULL_IN) {
            findings->pulled++;
            findings->pull_in = fmin(findings->pull_in, samples[i].time);
            break;
        }
    }
    if (layout->spread_count > 0) {
        take_weakest(findings, samples);
    }
    print_averages(findings, number, &placed, samples);
}

static void take_resonance(dea_findings *findings, double resonance)
{
    findings->resonance[0] = fmin(findings->resonance[0], resonance);
    findings->resonance[1] = fmax(findings->resonance[1], resonance);
}

static void take_response(dea_findings *findings, const void *point)
{
    findings->band = *dea_layout_band(&findings->layout, point);
    take_resonance(findings, findings->band.resonance);
}

void dea_findings_take(dea_findings *findings, size_t first, const void *points, size_t count)
{
    const dea_study *study = dea_study_of(findings->scene);
    const dea_layout *layout = &findings->layout;
    for (size_t i = 0; i < count; i++) {
        const char *point = (const char *)points + i * layout->point_size;
        const size_t each = dea_scene_point_count(findings->scene), number = first + i;
        dea_answer_take(&findings->answers[number / each], layout, number % each, point);
        dea_covered_take(&findings->covered, findings->scene, layout, first + i, point);
        for (size_t k = 0; k < layout->rows; k++) {
            findings->states[dea_layout_state(layout, point + k * layout->row_size)]++;
        }
        if (study->timed) {
            take_transient(findings, first + i, point);
        } else if (study->phasors) {
            take_response(findings, point);
        } else if (study->resonance > 0) {
            take_resonance(findings, dea_layout_number(point, study->resonance));
        } else if (study->stations) {
            findings->weakest = *dea_layout_weakest(layout, point);
        }
    }
    findings->points += count;
}

static void print_states(const dea_findings *findings)
{
    const char *before = ": ";
    for (size_t i = 0; i < DEA_STATE_COUNT; i++) {
        if (findings->states[i] > 0) {
            fprintf(stderr, "%s%zu %s", before, findings->states[i], dea_state_name((dea_state)i));
            before = ", ";
        }
    }
    fputc('\n', stderr);
}

/* "12 points", "2501 samples", "6 runs of 2501 samples" */
void dea_findings_instead(dea_findings *findings, const dea_engine *engine, size_t count)
{
    size_t place = 0;
    while (place + 1 < DEA_ENGINES && findings->instead[place].engine && findings->instead[place].engine != engine) {
        place++;
    }
    findings->instead[place].engine = engine;
    findings->instead[place].count += count;
}

/* "(direct; 3 of 40 by ida instead)" */
static void print_engines(const dea_findings *findings)
{
    char names[512];
    dea_crew_names(findings->scene, NULL, names, sizeof names);
    fprintf(stderr, " (%s", names);
    for (size_t i = 0; i < DEA_ENGINES && findings->instead[i].engine; i++) {
        fprintf(stderr, "%s %zu of %zu by %s instead", i == 0 ? ";" : ",", findings->instead[i].count, findings->points,
                findings->instead[i].engine->name);
    }
    fputc(')', stderr);
}

static void print_amount(const dea_findings *findings)
{
    const dea_study *study = dea_study_of(findings->scene);
    const size_t count = study->along ? findings->layout.rows : findings->points;
    if (study->along && findings->points != 1) {
        fprintf(stderr, "%zu %s of ", findings->points, study->points[1]);
    }
    fprintf(stderr, "%zu %s", count, study->rows[count != 1]);
}

/* Three digits, rounded outwards. */
static double outwards(double value, bool up)
{
    const double unit = pow(10.0, floor(log10(value)) - 2.0), digits = value / unit;
    return (up ? ceil(digits - 1e-9) : floor(digits + 1e-9)) * unit;
}

/* A time that samples or the engine's error may leave open. */
static void print_interval(dea_interval time)
{
    if (time.late - time.early <= doubtful * time.late) {
        fprintf(stderr, "in %s", DEA_QUANTITY(0.5 * (time.early + time.late), "s", 3));
    } else if (time.early > 0.0) {
        fprintf(stderr, "in %s to %s", DEA_QUANTITY(outwards(time.early, false), "s", 3), DEA_QUANTITY(outwards(time.late, true), "s", 3));
    } else {
        fprintf(stderr, "in less than %s", DEA_QUANTITY(outwards(time.late, true), "s", 3));
    }
}

/* Digits behind the point of a percentage that may be off by that share. */
static int decimals(double error)
{
    const double places = floor(-log10(200.0 * error));
    return places >= 2.0 ? 2 : places > 0.0 ? (int)places : 0;
}

static void print_edge(const dea_findings *findings, const dea_edge_answer *edge)
{
    if (isnan(edge->change) || !(fabs(edge->change) > 0.0)) {
        return;
    }
    fprintf(stderr, "%s at %s", edge->rising ? "switched on" : "switched off", DEA_QUANTITY(edge->time, "s", 4));
    if (!edge->reached) {
        fputs(": does not settle within the run\n", stderr);
        return;
    }
    fputs(": 10-90 % ", stderr);
    print_interval(edge->rise);
    if (edge->settled) {
        fputs(", settled to 2 % ", stderr);
        print_interval(edge->settling);
    } else {
        fputs(", does not settle within the run", stderr);
    }
    if (edge->overshoot < fmax(negligible, 2.0 * findings->summary.error)) {
        fputs(", no overshoot\n", stderr);
        return;
    }
    const double error = fmax(findings->summary.error, 0.5 * negligible) * (1.0 + edge->overshoot);
    fprintf(stderr, ", overshoot %.*f %%\n", decimals(error), 100.0 * edge->overshoot);
}

/* What samples are too coarse for. */
static void print_aliases(const dea_findings *findings)
{
    const dea_scene placed = dea_scene_of_run(findings->scene, 0), *scene = &placed;
    const double every = dea_measure_interval(scene, &findings->summary), resonance = findings->summary.resonance;
    const dea_waveform *wave = &scene->drive.waveform;
    if (findings->edge_count == 0 && dea_measure_lives(scene, &findings->summary) && every * resonance > aliased) {
        fprintf(stderr, "samples every %s alias the first resonance\n", DEA_QUANTITY(every, "s", 4));
    }
    if (dea_wave_is_pure(wave) && wave->sine.amplitude != 0.0 && 2.0 * every * wave->sine.frequency > aliased) {
        fprintf(stderr, "samples every %s alias the displacement, which follows the square of a sine of %s; means do not rest on samples\n",
                DEA_QUANTITY(every, "s", 4), DEA_QUANTITY(wave->sine.frequency, "Hz", 4));
    }
}

/* How the film answered a step, where the samples can tell. */
static void print_edges(const dea_findings *findings)
{
    const dea_scene placed = dea_scene_of_run(findings->scene, 0), *scene = &placed;
    const double resonance = findings->summary.resonance;
    if (findings->edge_count > 0 && dea_measure_lives(scene, &findings->summary) &&
        !dea_measure_shows(scene, &findings->summary)) {
        fprintf(stderr, "no rise and settling times: samples every %s do not show the first resonance, those every %s would\n",
                DEA_QUANTITY(dea_measure_interval(scene, &findings->summary), "s", 4),
                DEA_QUANTITY(outwards(1.0 / (DEA_SAMPLES_A_SWING * resonance), false), "s", 3));
        return;
    }
    for (size_t i = 0; i < findings->edge_count; i++) {
        print_edge(findings, &findings->edges[i]);
    }
}

/* What was left out, found anew for a single run. */
static void print_omissions(const dea_findings *findings)
{
    char text[DEA_OMISSION_LENGTH];
    dea_needs needs;
    if (findings->reduced == 0) {
        return;
    }
    if (findings->points > 1) {
        fprintf(stderr, "left out in %zu of %zu runs: at most %s of the largest displacement\n", findings->reduced,
                findings->points, dea_bound_text(findings->omitted, text));
        return;
    }
    const dea_scene placed = dea_scene_of_run(findings->scene, 0);
    const dea_crew crew = dea_crew_of(&placed, NULL, placed.models[0]);
    if (crew.count > 0 && dea_needs_find(&placed, placed.models[0], crew.engines[0], &needs, NULL) == DEA_OK && needs.count > 0) {
        for (size_t i = 0; i < needs.count; i++) {
            fprintf(stderr, "%s%s", i == 0 ? "left out: " : ", ", dea_omission_text(&needs.omissions[i], &placed, text));
        }
        fputc('\n', stderr);
    }
}

/* Estimates of the columns that are rates, each of its own scale. */
static void print_rates(const dea_findings *findings)
{
    if (!isnan(findings->velocity_error)) {
        fprintf(stderr, " (velocity %.2g", findings->velocity_error);
        if (!isnan(findings->current_error)) {
            fprintf(stderr, ", current %.2g", findings->current_error);
        }
        fputc(')', stderr);
    }
}

static void print_errors(const dea_findings *findings)
{
    const char *worst = findings->points > 1 ? "worst " : "";
    if (!isnan(findings->error)) {
        fprintf(stderr, "%sestimated error %.2g of the largest displacement", worst, findings->error);
        print_rates(findings);
        fputs(isnan(findings->residual) ? "\n" : ", ", stderr);
    }
    if (!isnan(findings->residual)) {
        fprintf(stderr, "%senergy balance off by %.2g\n", worst, findings->residual);
    }
    print_omissions(findings);
}

/* Where a film is nearest to its limits, and in time when: of a uniform film there is no place, and in statics no time. */
static void print_where(double radius, const double *time)
{
    if (!isnan(radius)) {
        fprintf(stderr, " at radius %s", DEA_QUANTITY(radius, "m", 4));
    }
    if (time) {
        fprintf(stderr, " at %s", DEA_QUANTITY(*time, "s", 4));
    }
}

static void print_weakest(const dea_weakest *weakest, const double *times)
{
    fprintf(stderr, "largest true field %s", DEA_QUANTITY(weakest->field, "V/m", 4));
    print_where(weakest->field_radius, times);
    fprintf(stderr, ", least tension %s", DEA_QUANTITY(weakest->tension, "Pa", 4));
    print_where(weakest->tension_radius, times ? times + 1 : NULL);
    fputc('\n', stderr);
}

/* What films did in time. */
static void print_motions(const dea_findings *findings)
{
    if (findings->points == 1 && !isnan(findings->summary.resonance)) {
        fprintf(stderr, "first resonance %s%s\n", DEA_QUANTITY(findings->summary.resonance, "Hz", 4),
                findings->summary.decay > 0.0 ? "" : ", undamped: the material has no retardation and no branch");
    }
    if (findings->points == 1 && findings->summary.peak_current > 0.0) {
        const double told = findings->summary.current_error, error = isnan(told) ? 10.0 * findings->summary.error : told;
        fprintf(stderr, "peak current %s at %s\n", DEA_QUANTITY(findings->summary.peak_current, "A", error < 5e-5 ? 4 : error < 2e-3 ? 3 : 2),
                DEA_QUANTITY(findings->summary.peak_time, "s", 4));
    }
    if (findings->points == 1) {
        print_aliases(findings);
        print_edges(findings);
    }
    if (findings->points == 1 && findings->layout.spread_count > 0 && isfinite(findings->weakest.tension)) {
        print_weakest(&findings->weakest, findings->weakest_times);
    }
    if (findings->pulled > 0) {
        fprintf(stderr, "pull_in from t = %s on", DEA_QUANTITY(findings->pull_in, "s", 4));
        if (findings->points > 1) {
            fprintf(stderr, " at the earliest, in %zu of %zu runs", findings->pulled, findings->points);
        }
        fputc('\n', stderr);
    }
}

static void print_responses(const dea_findings *findings)
{
    const double *resonance = findings->resonance;
    if (!isnan(resonance[0]) && findings->points > 1) {
        fprintf(stderr, "resonances from %s to %s\n", DEA_QUANTITY(resonance[0], "Hz", 4), DEA_QUANTITY(resonance[1], "Hz", 4));
    } else if (!isnan(resonance[0])) {
        fprintf(stderr, "resonance %s\n", DEA_QUANTITY(resonance[0], "Hz", 4));
    }
    if (dea_study_of(findings->scene)->phasors && findings->points == 1 && !isnan(findings->band.bandwidth)) {
        fprintf(stderr, "bandwidth (-3 dB) %s\n", DEA_QUANTITY(findings->band.bandwidth, "Hz", 4));
    }
}

void dea_findings_print(const dea_findings *findings, double seconds)
{
    const dea_study *study = dea_study_of(findings->scene);
    for (size_t i = 0; i < findings->scene->model_count && findings->points > 0; i++) {
        dea_answer_print(&findings->answers[i], findings->scene, i, !findings->alone);
    }
    if (study->timed) {
        print_motions(findings);
    } else if (study->phasors || study->resonance > 0) {
        print_responses(findings);
    } else if (study->stations && findings->points == 1 && isfinite(findings->weakest.tension)) {
        print_weakest(&findings->weakest, NULL);
    }
    print_amount(findings);
    fprintf(stderr, " in %.3g s", seconds);
    print_engines(findings);
    print_states(findings);
    if (study->timed) {
        print_errors(findings);
    }
}
