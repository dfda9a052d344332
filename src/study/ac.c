/* Frequency response about the equilibrium under a bias. */
#include <math.h>
#include <stdio.h>

#include "netlist/export.h"
#include "scene/key_forms.h"
#include "picture/picture.h"
#include "study/study.h"

#define AC "study.ac"

static const dea_key keys[] = {
    OTHER(AC, dea_read_mapping, "a mapping with from, to, points_per_decade, bias and over, e.g. {from: 1 Hz, to: 10 kHz}"),
    PART(AC ".from", ac.from, "Hz", "_Hz", 0, INFINITY, true, 0, AC, "a frequency > 0, e.g. 1 Hz"),
    PART(AC ".to", ac.to, "Hz", "_Hz", 0, INFINITY, true, 0, AC, "a frequency >= from, e.g. 10 kHz"),
    AMOUNT(AC ".points_per_decade", ac.points_per_decade, 1, 10000, AC, "a whole number 1 ... 10000"),
    PART(AC ".bias", ac.bias, "V", "_V", -INFINITY, INFINITY, true, 1, AC, "a voltage, e.g. 4500 V"),
    OVER(AC ".over"),
};

static dea_status finish(dea_reader *reader)
{
    const dea_ac *ac = &reader->scene->ac;
    if (isnan(ac->from) || isnan(ac->to)) {
        return dea_reader_missing(reader, AC, isnan(ac->from) ? AC ".from" : AC ".to");
    }
    const dea_place *place = dea_reader_place(reader, offsetof(dea_scene, ac.to), AC);
    if (!(ac->from <= ac->to)) {
        return dea_place_fail(place, reader->error, AC ".to", "out of range (%g Hz); accepted: a frequency >= from, %g Hz",
                              ac->to, ac->from);
    }
    if (!(ceil(log10(ac->to / ac->from) * (double)ac->points_per_decade) + 1.0 <= DEA_SAMPLES_MAX)) {
        return dea_place_fail(place, reader->error, AC ".to",
                              "too many frequencies (%g Hz); accepted: at most 4000000 from %g Hz on", ac->to, ac->from);
    }
    return dea_reader_bias(reader, &reader->scene->ac.bias);
}

static dea_status rest(dea_scene *scene, dea_error *error)
{
    (void)error;
    scene->drive.voltage = scene->ac.bias;
    return DEA_OK;
}

static void identify(FILE *out, const dea_scene *scene)
{
    fprintf(out, AC ".points_per_decade=%zu\n", scene->ac.points_per_decade);
}

static const dea_column columns[] = {
    {"frequency_Hz", "frequency", "Hz", offsetof(dea_response, frequency)},
    {"displacement_m_per_V", "displacement per volt of the source", "m/V", offsetof(dea_response, displacement)},
    {"displacement_phase_deg", "phase of the displacement", "degree", offsetof(dea_response, displacement_phase)},
    {"impedance_Ohm", "input impedance", "Ohm", offsetof(dea_response, impedance)},
    {"impedance_phase_deg", "phase of the input impedance", "degree", offsetof(dea_response, impedance_phase)},
};

static const dea_column figures[] = {
    {"resonance_Hz", "frequency of the highest peak of the displacement per volt", "Hz", offsetof(dea_band, resonance)},
    {"bandwidth_Hz", "frequency at which the displacement per volt falls to 1/sqrt(2) of its first value", "Hz",
     offsetof(dea_band, bandwidth)},
};

static const dea_study_column compared[] = {
    {offsetof(dea_response, displacement), DEA_OVER_ITSELF, "displacement"},
    {offsetof(dea_response, displacement_phase), DEA_OVER_RADIAN, "phase"},
    {offsetof(dea_response, impedance), DEA_OVER_ITSELF, "impedance"},
    {offsetof(dea_response, impedance_phase), DEA_OVER_RADIAN, "phase"},
};

static const size_t drawn[] = {offsetof(dea_response, displacement), offsetof(dea_response, displacement_phase),
                               offsetof(dea_response, impedance), offsetof(dea_response, impedance_phase)};

static void lay(const dea_scene *scene, dea_layout *layout)
{
    const dea_ac *ac = &scene->ac;
    layout->rows = (size_t)ceil(log10(ac->to / ac->from) * (double)ac->points_per_decade * (1.0 - 1e-12)) + 1;
}

/* The last frequency is the end of the range, so that the steps of a decade fit only up to there. */
static double place(const dea_scene *scene, size_t index)
{
    const dea_ac *ac = &scene->ac;
    return fmin(ac->from * pow(10.0, (double)index / (double)ac->points_per_decade), ac->to);
}

static void fail(const dea_layout *layout, void *point)
{
    *dea_layout_band(layout, point) = (dea_band){(double)NAN, (double)NAN};
}

static bool offered(const dea_engine *engine)
{
    return engine->ac != NULL;
}

static dea_status solve(const dea_engine *engine, void *session, dea_scene *here, const dea_model *model, const dea_layout *layout,
                        void *point, dea_error *error)
{
    return engine->ac(session, here, model, point, dea_layout_band(layout, point), error);
}

const dea_study dea_study_ac = {
    .name = "ac",
    .path = AC,
    .axes = AC ".over",
    .title = "frequency response",
    .points = {"run", "runs"},
    .rows = {"frequency", "frequencies"},
    .along = true,
    .phasors = true,
    .bias = AC ".bias",
    .model_fails = "cannot do a frequency response",
    .model_lacks = "the model is static",
    .engine_fails = "it has no frequency domain",
    .at = " at the bias",
    .plot_name = "AC Analysis",
    .unit = "frequency",
    .unit_head = "us/freq",
    .unit_label = "Wall time per frequency",
    .unit_scale = 1e6,
    .keys = keys,
    .key_count = sizeof keys / sizeof *keys,
    .columns = columns,
    .column_count = sizeof columns / sizeof *columns,
    .row_size = sizeof(dea_response),
    .state_offset = offsetof(dea_response, state),
    .behind = sizeof(dea_band),
    .compared = compared,
    .compared_count = sizeof compared / sizeof *compared,
    .figures = figures,
    .figure_count = sizeof figures / sizeof *figures,
    .drawer = &dea_drawer_runs,
    .drawn = drawn,
    .drawn_count = sizeof drawn / sizeof *drawn,
    .takes = dea_study_moves,
    .finish = finish,
    .rest = rest,
    .identify = identify,
    .lay = lay,
    .place = place,
    .fail = fail,
    .offered = offered,
    .solve = solve,
    .netlist = dea_export_ac,
};
