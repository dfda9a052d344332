#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "deaspice/fit.h"
#include "deaspice/plot.h"
#include "program/program.h"
#include "support/atomic.h"
#include "support/memory_text.h"

/* Data and fits of one call. */
typedef struct work {
    dea_fit_data stretch;           /* owned */
    dea_relaxation_data relaxation; /* owned */
    dea_fit law;
    dea_relaxation prony;
    const dea_fit *law_given; /* NULL: no data of that kind */
    const dea_relaxation *prony_given;
} work;

static dea_load load_of(dea_given_mode mode)
{
    static const dea_load loads[] = {DEA_LOAD_UNKNOWN, DEA_LOAD_UNIAXIAL, DEA_LOAD_EQUIBIAXIAL};
    return loads[mode];
}

/* A name that is neither a law nor auto, or a number of terms that goes with neither. */
static bool complain_law(const dea_arguments *arguments)
{
    size_t index;
    if (!arguments->law || dea_law_find(arguments->law)) {
        return false;
    }
    if (strcmp(arguments->law, "auto") == 0 && arguments->terms > 0) {
        dea_complain("--terms does not go with --law auto");
        return true;
    }
    return !dea_word_choose("law", arguments->law, dea_law_word, &index);
}

/* Kind of the test that is given, DEA_TESTS: none. */
static dea_test_kind test_of(const dea_arguments *arguments)
{
    dea_test_kind kind = DEA_TEST_RELAXATION;
    while (kind < DEA_TESTS && !arguments->tests[kind]) {
        kind++;
    }
    return kind;
}

static bool complain_mismatch(const dea_arguments *arguments)
{
    if (complain_law(arguments)) {
        return true;
    }
    const dea_test_kind kind = test_of(arguments);
    const bool test = kind < DEA_TESTS;
    size_t given = 0;
    for (size_t i = 0; i < DEA_TESTS; i++) {
        given += arguments->tests[i] != NULL;
    }
    if (!test && arguments->operand_count == 0) {
        dea_complain("fit needs a file; see deaspice fit --help");
    } else if (given > 1) {
        dea_complain("the branches of a film come from one test: one of --relaxation, --dma and --creep");
    } else if (!test && (!isnan(arguments->ramp) || arguments->branches > 0)) {
        dea_complain(isnan(arguments->ramp) ? "--branches goes with --relaxation, --dma or --creep" : "--ramp goes with --relaxation or --creep");
    } else if (kind == DEA_TEST_DYNAMIC && !isnan(arguments->ramp)) {
        dea_complain("--ramp goes with --relaxation or --creep: a dynamic test has none");
    } else if (test && arguments->operand_count == 0 && arguments->terms > 0) {
        dea_complain("--terms goes with data of stress over stretch");
    } else {
        return false;
    }
    return true;
}

/* What the columns of a table were taken for; nothing where it was refused. */
static void tell_columns(const dea_arguments *arguments, const char *path, const char *columns)
{
    if (!arguments->quiet && columns[0]) {
        dea_complain("note: %s: %s", path, columns);
    }
}

static dea_status fit_stretch(const dea_arguments *arguments, work *w, dea_error *error)
{
    dea_status status = DEA_OK;
    w->stretch.specimen = arguments->specimen;
    for (size_t i = 0; i < arguments->operand_count && status == DEA_OK; i++) {
        status = dea_fit_read(arguments->operands[i].path, load_of(arguments->operands[i].mode), &w->stretch, error);
        tell_columns(arguments, arguments->operands[i].path, w->stretch.columns);
    }
    if (status == DEA_OK) {
        const dea_law *law = dea_law_find(arguments->law ? arguments->law : "yeoh");
        status = law ? dea_fit_law(&w->stretch, law, (int)arguments->terms, arguments->relative, &w->law, error)
                     : dea_fit_auto(&w->stretch, arguments->relative, &w->law, error);
        w->law_given = &w->law;
    }
    return status;
}

static dea_status fit_relaxation(const dea_arguments *arguments, work *w, dea_error *error)
{
    w->relaxation.kind = test_of(arguments);
    const char *path = arguments->tests[w->relaxation.kind];
    w->relaxation.ramp = isnan(arguments->ramp) ? 0.0 : arguments->ramp;
    w->relaxation.specimen = arguments->specimen;
    dea_status status = dea_relaxation_read(path, &w->relaxation, error);
    tell_columns(arguments, path, w->relaxation.columns);
    if (status == DEA_OK) {
        status = dea_fit_relaxation(&w->relaxation, arguments->branches, arguments->relative, &w->prony, error);
        w->prony_given = &w->prony;
    }
    return status;
}

static dea_status write_fit(const work *w, const dea_arguments *arguments, const char *path, dea_error *error)
{
    dea_material film = dea_material_default();
    film.permittivity = arguments->permittivity;
    film.density = arguments->density;
    film.breakdown = arguments->breakdown;
    dea_memory_text text;
    dea_status status = dea_memory_text_begin(&text, error);
    status = status ? status : dea_fit_print(w->law_given, w->prony_given, &film, text.out, error);
    status = dea_memory_text_end(&text, status, error);
    status = status ? status : dea_atomic_put(path, text.text, text.length, error);
    free(text.text);
    return status;
}

static void warn(const work *w)
{
    if (w->law_given && !isnan(w->law.unloads_from)) {
        dea_complain("warning: the data unload from stretch %.4g on: loading and unloading differ; fit the loading alone",
                     w->law.unloads_from);
    }
    if (w->law_given && w->law.trials[w->law.terms - 1].p > 0.05) {
        dea_complain("warning: the data do not tell %s from 0 (F test, p = %.2g)", w->law.law->constants[w->law.terms - 1].name,
                     w->law.trials[w->law.terms - 1].p);
    }
    if (w->prony_given && w->prony.prony_count > 0 && isnan(w->prony.long_term_deviation)) {
        dea_complain("warning: the points do not tell the standard errors of these branches");
    }
    if (w->law_given && !isnan(w->law.unstable_stretch)) {
        dea_complain("warning: a tangent modulus of the fit is not positive from stretch %.4g on", w->law.unstable_stretch);
    }
    if (w->prony_given && w->prony.prony_count == 0) {
        dea_complain("warning: the film does not relax measurably; no branch");
    }
    if (w->prony_given && dea_relaxation_slow(&w->prony)) {
        dea_complain("warning: the slowest branch is slower than the test; the long-term share is extrapolated");
    }
    if (w->prony_given && dea_relaxation_fast(&w->prony)) {
        dea_complain("warning: the fastest branch is faster than the highest frequency; the instantaneous modulus is extrapolated");
    }
}

static void tell_stretch(const dea_fit *fit)
{
    char explained[32] = "";
    if (isfinite(fit->r_squared)) {
        snprintf(explained, sizeof explained, "R^2 = %.6f, ", fit->r_squared);
    }
    fprintf(stderr,
            "%s, %d constant%s from %zu uniaxial and %zu equi-biaxial points, stretch %.4g to %.4g: %srms residual %.4g Pa\n",
            fit->law->name, fit->terms, fit->terms == 1 ? "" : "s", fit->count[DEA_LOAD_UNIAXIAL], fit->count[DEA_LOAD_EQUIBIAXIAL],
            fit->stretch_min, fit->stretch_max, explained, fit->residual_rms);
}

static void tell_relaxation(const dea_relaxation *fit)
{
    fprintf(stderr, "%8s %12s %10s\n", "branch", "tau [s]", "g");
    for (size_t i = 0; i < fit->prony_count; i++) {
        fprintf(stderr, "%8zu %12.6g %10.6f\n", i + 1, fit->prony[i].tau, fit->prony[i].g);
    }
    fprintf(stderr, "%8s %12s %10.6f\n", "rest", "long-term", fit->long_term);
    const bool swings = fit->kind == DEA_TEST_DYNAMIC;
    fprintf(stderr, "%zu branch%s from %zu points of a %s, %.4g %s to %.4g %s: rms error %.3g %%; up to %zu tried, no further one: %s\n",
            fit->prony_count, fit->prony_count == 1 ? "" : "es", fit->count, dea_test_name(fit->kind),
            swings ? 0.5 / DEA_PI / fit->time_max : fit->time_min, swings ? "Hz" : "s",
            swings ? 0.5 / DEA_PI / fit->time_min : fit->time_max, swings ? "Hz" : "s", 100.0 * fit->residual_relative,
            fit->trial_count - 1, dea_relaxation_reason(fit));
}

static dea_status work_out(const dea_arguments *arguments, work *w, dea_error *error)
{
    dea_status status = arguments->operand_count > 0 ? fit_stretch(arguments, w, error) : DEA_OK;
    if (status == DEA_OK && test_of(arguments) < DEA_TESTS) {
        status = fit_relaxation(arguments, w, error);
    }
    if (status == DEA_OK && (arguments->output || !arguments->plot)) {
        status = write_fit(w, arguments, arguments->output ? arguments->output : "-", error);
    }
    if (status == DEA_OK && arguments->plot) {
        status = dea_plot_fit(w->law_given, &w->stretch, w->prony_given, &w->relaxation, arguments->plot,
                              &arguments->picture, error);
    }
    return status;
}

static dea_exit run(const dea_arguments *arguments)
{
    work w = {.law_given = NULL};
    dea_error error = {0};
    dea_files files = {0};
    const bool fits = !complain_mismatch(arguments) && dea_inputs_note(arguments, &files) && dea_targets_free(arguments, &files);
    dea_files_free(&files);
    if (!fits) {
        return DEA_EXIT_USAGE;
    }
    dea_signals_catch();
    const dea_status status = work_out(arguments, &w, &error);
    if (status == DEA_OK) {
        warn(&w);
    }
    const bool talk = status == DEA_OK && !arguments->quiet && (arguments->output || arguments->plot);
    if (talk && w.law_given) {
        tell_stretch(&w.law);
    }
    if (talk && w.prony_given) {
        tell_relaxation(&w.prony);
    }
    if (talk && arguments->output && w.law_given && isnan(arguments->permittivity)) {
        fprintf(stderr, "a scene needs a permittivity too: --permittivity 2.8 writes that of your film into %s\n",
                arguments->output);
    }
    dea_fit_data_free(&w.stretch);
    dea_relaxation_data_free(&w.relaxation);
    return status == DEA_OK ? DEA_EXIT_DONE : dea_complain_error(&error);
}

const dea_command dea_command_fit = {
    .name = "fit",
    .summary = "material constants from measured data",
    .help = "Usage: deaspice fit [OPTION]... [DATA]...\n"
            "\n"
            "Fits a law to measured stress over stretch, Prony branches to a test of relaxation,\n"
            "of creep, or of dynamic moduli, or both, and prints them as a material for a\n"
            "scene. DATA is a table (comma, semicolon, tab or blanks between the fields, decimal\n"
            "point or comma) whose header names columns with their units, others are left alone:\n"
            "stretch, strain or displacement; nominal stress or force; mode (uniaxial or\n"
            "equibiaxial); - is standard input. Files without the column mode are given by\n"
            "--uniaxial or --equibiaxial.\n"
            "\n",
    .further = "Examples:\n"
               "  deaspice fit --uniaxial pull.csv --equibiaxial bulge.csv --permittivity 2.8 -o film.yaml\n"
               "  deaspice fit --uniaxial pull.csv --relaxation hold.csv --ramp \"2 s\" -o film.yaml\n",
    .takes = DEA_TAKES_OUTPUT | DEA_TAKES_PLOT | DEA_TAKES_QUIET | DEA_TAKES_FIT,
    .least = 0,
    .most = SIZE_MAX,
    .files = ".csv",
    .run = run,
};
