/* Motion in time, from rest or from a bias. */
#include <math.h>
#include <stdio.h>

#include "deaspice/model.h"
#include "deaspice/needs.h"
#include "drive/signal.h"
#include "netlist/export.h"
#include "network/swing.h"
#include "result/scales.h"
#include "scene/key_forms.h"
#include "picture/picture.h"
#include "study/study.h"
#include "support/number.h"

#define TRANSIENT "study.transient"
#define AVERAGE TRANSIENT ".average"
#define SAMPLES TRANSIENT ".samples"
#define PROFILE TRANSIENT ".profile"

/* Most samples times radii of a run. */
enum { ENTRIES_MOST = 1000000 };

/* ---- reading */

static dea_status window_read(dea_reader *reader, const dea_ref *ref, const dea_node *node, dea_window *window)
{
    *window = (dea_window){.from = NAN, .to = NAN};
    const dea_status status = node->kind == DEA_NODE_MAPPING ? dea_reader_children(reader, ref->path, node)
                                                             : dea_reader_refuse(reader, ref, node, "not a window");
    if (!status && (isnan(window->from) || isnan(window->to))) {
        return dea_reader_refuse(reader, ref, node, isnan(window->from) ? "from is missing" : "to is missing");
    }
    return status;
}

/* One window, or a list of them. */
static dea_status read_average(dea_reader *reader, const dea_ref *ref, const dea_node *node)
{
    dea_transient *transient = &reader->scene->transient;
    if (node->kind != DEA_NODE_SEQUENCE) {
        transient->average_count = 1;
        return window_read(reader, ref, node, &transient->averages[0]);
    }
    if (node->count > DEA_WINDOWS) {
        return dea_reader_refuse(reader, ref, node, "too many windows");
    }
    dea_status status = DEA_OK;
    for (const dea_node *window = node->first; window && !status; window = window->next) {
        char path[DEA_NAME_LENGTH];
        dea_ref own;
        const size_t index = transient->average_count++;
        snprintf(path, sizeof path, AVERAGE ".%zu", index);
        status =
            dea_key_find(path, &own) ? window_read(reader, &own, window, &transient->averages[index]) : dea_reader_memory(reader);
    }
    return status;
}

static dea_status read_profile(dea_reader *reader, const dea_ref *ref, const dea_node *node)
{
    reader->scene->transient.points = 101;
    return dea_read_mapping(reader, ref, node);
}

static const dea_key keys[] = {
    OTHER(TRANSIENT, dea_read_mapping,
          "a mapping with until, every, samples, from, points_per_decade, average, start, profile and over, e.g. {until: 25 s, every: 10 ms}"),
    PART(TRANSIENT ".until", transient.until, "s", "_s", 0, INFINITY, true, 0, TRANSIENT, "a time > 0, e.g. 25 s"),
    PART(TRANSIENT ".every", transient.every, "s", "_s", 0, INFINITY, true, 0, TRANSIENT, "a time > 0, e.g. 10 ms"),
    CHOICE(SAMPLES, transient.logarithmic, "even", "log"),
    PART(TRANSIENT ".from", transient.first, "s", "_s", 0, INFINITY, true, 0, SAMPLES, "a time > 0, e.g. 1 us"),
    AMOUNT(TRANSIENT ".points_per_decade", transient.points_per_decade, 1, 10000, SAMPLES, "a whole number 1 ... 10000"),
    OTHER(AVERAGE, read_average, "a window of time, e.g. {from: 6 s, to: 8 s}, or a list of at most 8"),
    PART(AVERAGE ".from", transient.averages[0].from, "s", "_s", 0, INFINITY, false, 0, AVERAGE, "a time >= 0, e.g. 6 s"),
    PART(AVERAGE ".to", transient.averages[0].to, "s", "_s", 0, INFINITY, true, 0, AVERAGE, "a time > from, e.g. 8 s"),
    OTHER(AVERAGE ".#", dea_read_mapping, "a window of time, e.g. {from: 6 s, to: 8 s}"),
    ENTRY(AVERAGE ".#.from", transient.averages, from, "s", "_s", 0, INFINITY, false, 0, "a time >= 0, e.g. 6 s"),
    ENTRY(AVERAGE ".#.to", transient.averages, to, "s", "_s", 0, INFINITY, true, 0, "a time > from, e.g. 8 s"),
    CHOICE(TRANSIENT ".start", transient.from_bias, "rest", "bias"),
    OTHER(PROFILE, read_profile, "a mapping with points, e.g. {points: 51}"),
    AMOUNT(PROFILE ".points", transient.points, 2, DEA_RADII_MAX, NULL, "a whole number of radii, 2 ... 10001, at which each sample tells the film, e.g. 51"),
    OVER(TRANSIENT ".over"),
};

static dea_status fail_value(dea_reader *reader, size_t offset, const char *parent, const char *path, const char *what,
                             double value, const char *accepted)
{
    return dea_place_fail(dea_reader_place(reader, offset, parent), reader->error, path, "%s (%g s); accepted: %s", what, value,
                          accepted);
}

static dea_status windows_finish(dea_reader *reader)
{
    const dea_transient *transient = &reader->scene->transient;
    for (size_t i = 0; i < transient->average_count; i++) {
        const dea_window *window = &transient->averages[i];
        const size_t from = offsetof(dea_scene, transient.averages) + i * sizeof *window + offsetof(dea_window, from);
        const size_t to = offsetof(dea_scene, transient.averages) + i * sizeof *window + offsetof(dea_window, to);
        const char *path = dea_reader_given(reader, to)->ref.path;
        if (window->to > transient->until) {
            return fail_value(reader, to, AVERAGE, path, "beyond the end of the run", window->to,
                              "a time <= until");
        }
        if (!(window->from < window->to)) {
            return fail_value(reader, from, AVERAGE, dea_reader_given(reader, from)->ref.path, "out of range",
                              window->from, "a time >= 0 and < to");
        }
    }
    return DEA_OK;
}

/* Ratio of the times of two neighbours among logarithmic samples. */
static double ratio_of(const dea_transient *transient)
{
    return pow(10.0, 1.0 / (double)transient->points_per_decade);
}

/* Rows of a transient: one at 0, and logarithmic ones from `first` on up to the end, which need not lie on their grid. */
static double rows_of(const dea_transient *transient)
{
    if (!transient->logarithmic) {
        return floor(transient->until / transient->every * (1.0 + 1e-12)) + 1.0;
    }
    const double decades = log10(transient->until / transient->first);
    return ceil(decades * (double)transient->points_per_decade * (1.0 - 1e-12)) + 2.0;
}

/* The film along its radius, of a model that moves along it. */
static dea_status profile_finish(dea_reader *reader)
{
    const dea_scene *scene = reader->scene;
    const size_t points = scene->transient.points;
    const double samples = rows_of(&scene->transient);
    if (points == 0) {
        return DEA_OK;
    }
    const dea_place *place = &dea_tree_find(reader->root, PROFILE)->place;
    for (size_t i = 0; i < scene->model_count; i++) {
        if (!scene->models[i]->membrane || scene->automatic) {
            return dea_place_fail(place, reader->error, PROFILE, "is not told of the model %s, which %s in one shape; accepted: beside the model field alone",
                                  scene->automatic ? "auto" : scene->models[i]->name, scene->automatic ? "may move" : "moves");
        }
    }
    if ((double)points * samples > ENTRIES_MOST) {
        return dea_place_fail(place, reader->error, PROFILE, "too many (%zu radii of %.0f samples); accepted: at most %d entries of a run",
                              points, samples, ENTRIES_MOST);
    }
    return dea_reader_frame(reader, PROFILE);
}

/* What stands beside the samples. */
static dea_status further_finish(dea_reader *reader)
{
    const dea_status status = windows_finish(reader);
    return status ? status : profile_finish(reader);
}

/* Where the keys of one kind of samples stand beside the other. */
static dea_status samples_apart(dea_reader *reader)
{
    const bool logarithmic = reader->scene->transient.logarithmic;
    const dea_node *every = dea_reader_given(reader, offsetof(dea_scene, transient.every))->node;
    const dea_node *first = dea_reader_given(reader, offsetof(dea_scene, transient.first))->node;
    const dea_node *points = dea_tree_find(reader->root, TRANSIENT ".points_per_decade");
    if (logarithmic && every) {
        return dea_place_fail(&every->key_at, reader->error, TRANSIENT ".every",
                              "contradicts samples: log; accepted: from and points_per_decade, or samples: even");
    }
    if (!logarithmic && (first || points)) {
        return dea_place_fail(first ? &first->key_at : &points->key_at, reader->error,
                              first ? TRANSIENT ".from" : TRANSIENT ".points_per_decade",
                              "belongs to samples: log; accepted: every, or samples: log");
    }
    return DEA_OK;
}

static dea_status logarithmic_finish(dea_reader *reader)
{
    dea_transient *transient = &reader->scene->transient;
    const size_t first = offsetof(dea_scene, transient.first);
    transient->first = isnan(transient->first) ? transient->until / 1e6 : transient->first;
    transient->points_per_decade = transient->points_per_decade == 0 ? 50 : transient->points_per_decade;
    if (!(transient->first < transient->until)) {
        return fail_value(reader, first, TRANSIENT, TRANSIENT ".from", "out of range", transient->first, "a time > 0 and < until");
    }
    transient->every = fmax(transient->first, transient->until * (1.0 - 1.0 / ratio_of(transient)));
    return rows_of(transient) <= DEA_SAMPLES_MAX ? further_finish(reader)
                                                 : fail_value(reader, first, TRANSIENT, TRANSIENT ".from", "too many samples",
                                                              transient->first, "at most 4000000 samples up to until");
}

static dea_status finish(dea_reader *reader)
{
    dea_transient *transient = &reader->scene->transient;
    const size_t every = offsetof(dea_scene, transient.every);
    const dea_status status = isnan(transient->until) ? dea_reader_missing(reader, TRANSIENT, TRANSIENT ".until")
                                                      : samples_apart(reader);
    if (status || transient->logarithmic) {
        return status ? status : logarithmic_finish(reader);
    }
    transient->every = isnan(transient->every) ? transient->until / 1000.0 : transient->every;
    if (!(transient->every > 0.0 && transient->every <= transient->until)) {
        return fail_value(reader, every, TRANSIENT, TRANSIENT ".every", "out of range", transient->every,
                          "a time > 0 and <= until");
    }
    if (!(rows_of(transient) <= DEA_SAMPLES_MAX)) {
        return fail_value(reader, every, TRANSIENT, TRANSIENT ".every", "too many samples", transient->every,
                          "at most 4000000 samples up to until");
    }
    double whole;
    transient->grid = dea_number_power(transient->every, &whole);
    return further_finish(reader);
}

/* At the largest voltage of the run. */
static dea_status rest(dea_scene *scene, dea_error *error)
{
    dea_signal signal;
    const dea_status status = dea_signal_open(scene, &signal, error);
    scene->drive.voltage = signal.largest;
    dea_signal_close(&signal);
    return status;
}

static void identify(FILE *out, const dea_scene *scene)
{
    const dea_transient *transient = &scene->transient;
    fputs(AVERAGE "=", out);
    for (size_t i = 0; i < transient->average_count; i++) {
        fprintf(out, "%s%.17g,%.17g", i > 0 ? "," : "", transient->averages[i].from, transient->averages[i].to);
    }
    fprintf(out, "\n" TRANSIENT ".start=%s\n", transient->from_bias ? "bias" : "rest");
    if (transient->points > 0) {
        fprintf(out, PROFILE ".points=%zu\n", transient->points);
    }
    if (transient->logarithmic) {
        fprintf(out, TRANSIENT ".points_per_decade=%zu\n", transient->points_per_decade);
    }
}

/* ---- rows */

/* Numbers of an entry: dea_along_tell(). */
static const dea_column spread[DEA_SPREAD_COLUMNS] = {
    {"profile_displacement_m", "radial displacement of the film from its place at rest and 0 V", "m", 0},
    {"profile_velocity_m_per_s", "radial velocity of the film", "m/s", 0},
    {"stretch_radial", "stretch along the radius, pre-stretch included", "1", 0},
    {"stretch_hoop", "stretch along the hoop, pre-stretch included", "1", 0},
    {"thickness_m", "thickness of each layer of the deformed film", "m", 0},
    {"stress_radial_Pa", "true radial stress of film and voltage together", "Pa", 0},
    {"stress_hoop_Pa", "true hoop stress of film and voltage together", "Pa", 0},
    {"field_V_per_m", "true electric field, 0 without electrode", "V/m", 0},
};

static const dea_column weakest[] = {
    {"largest_field_V_per_m", "largest true electric field", "V/m", offsetof(dea_sample, weakest.field)},
    {"largest_field_radius_m", "radius of the largest field, at rest and 0 V", "m", offsetof(dea_sample, weakest.field_radius)},
    {"least_tension_Pa", "smallest true stress in the plane of the film", "Pa", offsetof(dea_sample, weakest.tension)},
    {"least_tension_radius_m", "radius of the smallest stress, at rest and 0 V", "m", offsetof(dea_sample, weakest.tension_radius)},
};

static const dea_column columns[] = {
    {"time_s", "time", "s", offsetof(dea_sample, time)},
    {"voltage_V", "voltage of the source", "V", offsetof(dea_sample, voltage)},
    {"displacement_m", "radial displacement of the disc edge", "m", offsetof(dea_sample, displacement)},
    {"strain", "radial strain of the disc edge", "1", offsetof(dea_sample, strain)},
    {"velocity_m_per_s", "velocity of the disc edge", "m/s", offsetof(dea_sample, velocity)},
    {"force_N", "electrostatic force over the full circumference", "N", offsetof(dea_sample, force)},
};

static void lay(const dea_scene *scene, dea_layout *layout)
{
    const bool series = !isnan(dea_series_resistance(scene));
    const bool port = series || !isnan(scene->drive.leakage_resistance);
    if (port) {
        dea_layout_add(layout, (dea_column){"current_A", "current of the source", "A", offsetof(dea_sample, current)});
        dea_layout_add(layout, (dea_column){"charge_C", "charge of the film", "C", offsetof(dea_sample, charge)});
    }
    if (!isnan(scene->actuator.focal_length)) {
        dea_layout_add(layout, (dea_column){"focal_length_m", "focal length of the lens", "m", offsetof(dea_sample, focal_length)});
    }
    if (series) {
        dea_layout_add(layout, (dea_column){"film_voltage_V", "voltage across the film", "V", offsetof(dea_sample, film_voltage)});
    }
    if (port) {
        dea_layout_add(layout, (dea_column){"capacitance_F", "capacitance of the deformed film", "F", offsetof(dea_sample, capacitance)});
    }
    layout->rows = (size_t)rows_of(&scene->transient);
    if (scene->transient.points > 0) {
        for (size_t i = 0; i < sizeof weakest / sizeof *weakest; i++) {
            dea_layout_add(layout, weakest[i]);
        }
        dea_layout_spread(layout, spread, DEA_SPREAD_COLUMNS, scene->transient.points);
    }
}

static double place(const dea_scene *scene, size_t index)
{
    const dea_transient *transient = &scene->transient;
    const double every = transient->every, grid = transient->grid;
    double whole;
    if (transient->logarithmic) {
        const double decades = ((double)index - 1.0) / (double)transient->points_per_decade;
        return index == 0 ? 0.0 : fmin(transient->first * pow(10.0, decades), transient->until);
    }
    const bool decimal = grid > 0.0 && dea_number_over(every, grid, &whole);
    return fmin(decimal ? whole * (double)index / grid : every * (double)index, scene->transient.until);
}

/* Inverse of place(), between samples too. */
static double index_of(const dea_scene *scene, double time)
{
    const dea_transient *transient = &scene->transient;
    if (!transient->logarithmic) {
        return time / transient->every;
    }
    const double behind = 1.0 + log10(time / transient->first) * (double)transient->points_per_decade;
    return time < transient->first ? time / transient->first : behind;
}

static void fail(const dea_layout *layout, void *point)
{
    *dea_layout_summary(layout, point) = dea_summary_failed();
}

static const dea_study_column compared[] = {
    {offsetof(dea_sample, displacement), DEA_OVER_PEAK, "displacement"},
    {offsetof(dea_sample, strain), DEA_OVER_PEAK, "strain"},
    {offsetof(dea_sample, velocity), DEA_OVER_PEAK, "velocity"},
    {offsetof(dea_sample, force), DEA_OVER_PEAK, "force"},
    {offsetof(dea_sample, current), DEA_OVER_PEAK, "current"},
    {offsetof(dea_sample, charge), DEA_OVER_PEAK, "charge"},
    {offsetof(dea_sample, focal_length), DEA_OVER_PEAK, "focal_length"},
    {offsetof(dea_sample, film_voltage), DEA_OVER_PEAK, "film_voltage"},
    {offsetof(dea_sample, capacitance), DEA_OVER_PEAK, "capacitance"},
};

static const dea_column figures[] = {
    {"estimated_error", "estimated error of the displacement, relative to its peak", "1", offsetof(dea_summary, error)},
    {"estimated_velocity_error", "estimated error of the velocity, relative to its scale", "1",
     offsetof(dea_summary, velocity_error)},
    {"estimated_current_error", "estimated error of the current, relative to its scale", "1", offsetof(dea_summary, current_error)},
    {"work_J", "work of the source", "J", offsetof(dea_summary, work)},
    {"electric_energy_J", "change of the energy in the film's capacitance", "J", offsetof(dea_summary, electric)},
    {"elastic_energy_J", "change of the elastic energy", "J", offsetof(dea_summary, elastic)},
    {"kinetic_energy_J", "change of the kinetic energy", "J", offsetof(dea_summary, kinetic)},
    {"dissipated_energy_J", "energy dissipated in dampers, branches and resistances", "J", offsetof(dea_summary, dissipated)},
    {"energy_residual", "residual of the energy balance, relative to the largest energy", "1", offsetof(dea_summary, residual)},
    {"peak_current_A", "largest magnitude of the source's current", "A", offsetof(dea_summary, peak_current)},
    {"peak_current_time_s", "time of the largest current", "s", offsetof(dea_summary, peak_time)},
    {"resonance_Hz", "damped swing of the free film", "Hz", offsetof(dea_summary, resonance)},
};

static const size_t drawn[] = {offsetof(dea_sample, strain), offsetof(dea_sample, voltage), offsetof(dea_sample, current),
                               offsetof(dea_sample, film_voltage), offsetof(dea_sample, focal_length)};

/* ---- running */

static bool offered(const dea_engine *engine)
{
    return engine->transient != NULL;
}

/* A transient whose energies do not add up says so, where the engine itself has said nothing. */
static void doubt_balance(const dea_scene *scene, const dea_summary *summary, dea_error *error)
{
    if (summary->residual > 10.0 * scene->accuracy && error->message[0] == '\0')
        dea_fail(
            error, DEA_OK,
            "its energy balance is off by %.2g, more than ten times the accuracy: current and energies are not to be trusted",
            summary->residual);
}

/* Of a window that reaches past the last row with numbers there is no mean. */
static void drop_means(const dea_scene *scene, const dea_sample *samples, size_t rows, dea_summary *summary)
{
    size_t good = 0;
    while (good < rows && isfinite(samples[good].displacement)) {
        good++;
    }
    const double last = good == rows ? scene->transient.until : good > 0 ? samples[good - 1].time : -1.0;
    for (size_t i = 0; i < DEA_WINDOWS; i++) {
        if (i >= scene->transient.average_count || scene->transient.averages[i].to > last) {
            summary->averages[i] = (dea_average){(double)NAN, (double)NAN};
        }
    }
}

/* The swing of the film with all that a run may leave out, unless the engine has found it in its own way. */
static void tell_swing(dea_swing swing, dea_summary *summary)
{
    if (isnan(summary->resonance)) {
        summary->resonance = swing.frequency;
        summary->decay = swing.decay;
    }
}

/* One transient, without what it does not need: the engine gets what accuracy that leaves. */
static dea_status run(const dea_engine *engine, void *session, dea_scene *here, const dea_model *model, dea_sample *samples,
                      dea_summary *summary, dea_error *error)
{
    dea_needs needs;
    if (here->full) {
        here->reduction.ring = (double)INFINITY;
        const dea_status whole = engine->transient(session, here, model, samples, summary, error);
        tell_swing(dea_swing_free(here, model), summary);
        return whole;
    }
    dea_status status = dea_needs_find(here, model, engine, &needs, error);
    if (status == DEA_OK) {
        here->reduction = dea_needs_reduction(needs.omissions, needs.count);
        here->accuracy -= needs.bound;
        status = engine->transient(session, here, model, samples, summary, error);
    }
    tell_swing((dea_swing){needs.resonance, needs.decay}, summary);
    summary->omitted = needs.bound;
    summary->error += needs.bound;
    summary->velocity_error += dea_scales_allowance(offsetof(dea_sample, velocity)) * needs.bound;
    summary->current_error += dea_scales_allowance(offsetof(dea_sample, current)) * needs.bound;
    return status;
}

static dea_status solve(const dea_engine *engine, void *session, dea_scene *here, const dea_model *model, const dea_layout *layout,
                        void *point, dea_error *error)
{
    dea_summary *summary = dea_layout_summary(layout, point);
    const dea_status status = run(engine, session, here, model, point, summary, error);
    if (status == DEA_OK) {
        drop_means(here, point, layout->rows, summary);
        doubt_balance(here, summary, error);
    }
    return status;
}

const dea_study dea_study_transient = {
    .name = "transient",
    .path = TRANSIENT,
    .axes = TRANSIENT ".over",
    .title = "transient study",
    .points = {"run", "runs"},
    .rows = {"sample", "samples"},
    .along = true,
    .timed = true,
    .waveform = true,
    .sign = "t",
    .model_fails = "cannot do a transient",
    .model_lacks = "the model is static",
    .engine_fails = "it has no time domain",
    .at = " at rest under the largest voltage",
    .plot_name = "Transient Analysis",
    .unit = "simulated_second",
    .unit_head = "ms/sim_s",
    .unit_label = "Wall time per simulated second",
    .unit_scale = 1e3,
    .keys = keys,
    .key_count = sizeof keys / sizeof *keys,
    .columns = columns,
    .column_count = sizeof columns / sizeof *columns,
    .row_size = sizeof(dea_sample),
    .state_offset = offsetof(dea_sample, state),
    .behind = sizeof(dea_summary),
    .compared = compared,
    .compared_count = sizeof compared / sizeof *compared,
    .figures = figures,
    .figure_count = sizeof figures / sizeof *figures,
    .drawer = &dea_drawer_runs,
    .spread_drawer = &dea_drawer_waves,
    .drawn = drawn,
    .drawn_count = sizeof drawn / sizeof *drawn,
    .takes = dea_study_moves,
    .finish = finish,
    .rest = rest,
    .identify = identify,
    .lay = lay,
    .place = place,
    .index = index_of,
    .fail = fail,
    .offered = offered,
    .solve = solve,
    .netlist = dea_export_transient,
};
