/* How the result of one point lies in memory, per kind of study. */
#include <math.h>
#include <string.h>

#include "deaspice/model.h"
#include "deaspice/result.h"
#include "support/number.h"

static void add(dea_layout *layout, const char *name, const char *long_name, const char *unit, size_t offset)
{
    layout->columns[layout->column_count++] = (dea_column){name, long_name, unit, offset};
}

static void lay_transient(const dea_scene *scene, dea_layout *layout)
{
    const dea_drive *drive = &scene->drive;
    add(layout, "time_s", "time", "s", offsetof(dea_sample, time));
    add(layout, "voltage_V", "voltage of the source", "V", offsetof(dea_sample, voltage));
    add(layout, "displacement_m", "radial displacement of the disc edge", "m", offsetof(dea_sample, displacement));
    add(layout, "strain", "radial strain of the disc edge", "1", offsetof(dea_sample, strain));
    add(layout, "velocity_m_per_s", "velocity of the disc edge", "m/s", offsetof(dea_sample, velocity));
    add(layout, "force_N", "electrostatic force over the full circumference", "N", offsetof(dea_sample, force));
    if (!isnan(drive->series_resistance) || !isnan(drive->leakage_resistance)) {
        add(layout, "current_A", "current of the source", "A", offsetof(dea_sample, current));
        add(layout, "charge_C", "charge of the film", "C", offsetof(dea_sample, charge));
    }
    if (!isnan(scene->actuator.focal_length)) {
        add(layout, "focal_length_m", "focal length of the lens", "m", offsetof(dea_sample, focal_length));
    }
    if (!isnan(drive->series_resistance)) {
        add(layout, "film_voltage_V", "voltage across the film", "V", offsetof(dea_sample, film_voltage));
    }
    layout->rows = (size_t)floor(scene->transient.until / scene->transient.every * (1.0 + 1e-12)) + 1;
    layout->row_size = sizeof(dea_sample);
    layout->state_offset = offsetof(dea_sample, state);
    layout->point_size = layout->rows * sizeof(dea_sample) + sizeof(dea_summary);
}

static void lay_ac(const dea_scene *scene, dea_layout *layout)
{
    const dea_ac *ac = &scene->ac;
    add(layout, "frequency_Hz", "frequency", "Hz", offsetof(dea_response, frequency));
    add(layout, "displacement_m_per_V", "displacement per volt of the source", "m/V", offsetof(dea_response, displacement));
    add(layout, "displacement_phase_deg", "phase of the displacement", "degree", offsetof(dea_response, displacement_phase));
    add(layout, "impedance_Ohm", "input impedance", "Ohm", offsetof(dea_response, impedance));
    add(layout, "impedance_phase_deg", "phase of the input impedance", "degree", offsetof(dea_response, impedance_phase));
    layout->rows = (size_t)ceil(log10(ac->to / ac->from) * (double)ac->points_per_decade * (1.0 - 1e-12)) + 1;
    layout->row_size = sizeof(dea_response);
    layout->state_offset = offsetof(dea_response, state);
    layout->point_size = layout->rows * sizeof(dea_response) + sizeof(dea_band);
}

dea_layout dea_layout_of(const dea_scene *scene)
{
    dea_layout layout = {
        .rows = 1, .row_size = sizeof(dea_row), .state_offset = offsetof(dea_row, state), .point_size = sizeof(dea_row)};
    if (scene->study == DEA_STUDY_TRANSIENT) {
        lay_transient(scene, &layout);
    } else if (scene->study == DEA_STUDY_AC) {
        lay_ac(scene, &layout);
    } else {
        memcpy(layout.columns, dea_row_columns, sizeof dea_row_columns);
        layout.column_count = isnan(scene->actuator.focal_length) ? DEA_ROW_COLUMNS - 1 : DEA_ROW_COLUMNS;
    }
    return layout;
}

/* The last frequency of an AC study is its end, so that the steps of a decade fit only up to there. */
double dea_layout_place(const dea_scene *scene, size_t index)
{
    const dea_ac *ac = &scene->ac;
    if (scene->study == DEA_STUDY_TRANSIENT) {
        const double every = scene->transient.every, grid = scene->transient.grid;
        double whole;
        const bool decimal = grid > 0.0 && dea_number_over(every, grid, &whole);
        return fmin(decimal ? whole * (double)index / grid : every * (double)index, scene->transient.until);
    }
    if (scene->study == DEA_STUDY_AC) {
        return fmin(ac->from * pow(10.0, (double)index / (double)ac->points_per_decade), ac->to);
    }
    return 0.0;
}

dea_state dea_layout_state(const dea_layout *layout, const void *row)
{
    dea_state state;
    memcpy(&state, (const char *)row + layout->state_offset, sizeof state);
    return state;
}

dea_summary *dea_layout_summary(const dea_layout *layout, void *point)
{
    return (dea_summary *)(void *)((char *)point + layout->rows * layout->row_size);
}

dea_band *dea_layout_band(const dea_layout *layout, void *point)
{
    return (dea_band *)(void *)((char *)point + layout->rows * layout->row_size);
}

dea_summary dea_summary_failed(void)
{
    const double none = (double)NAN;
    dea_summary summary = {none, none, none, 0.0, none, none, none, none, none, none, none, none, none, none, {{none, none}}};
    for (size_t i = 0; i < DEA_WINDOWS; i++) {
        summary.averages[i] = (dea_average){none, none};
    }
    return summary;
}

void dea_layout_fail(const dea_scene *scene, const dea_layout *layout, void *point)
{
    for (size_t i = 0; i < layout->rows; i++) {
        char *row = (char *)point + i * layout->row_size;
        for (size_t k = 0; k < layout->column_count; k++) {
            const double value = k == 0 && scene->study != DEA_STUDY_SWEEP ? dea_layout_place(scene, i) : (double)NAN;
            memcpy(row + layout->columns[k].offset, &value, sizeof value);
        }
        const dea_state failed = DEA_STATE_FAILED;
        memcpy(row + layout->state_offset, &failed, sizeof failed);
    }
    if (scene->study == DEA_STUDY_TRANSIENT) {
        *dea_layout_summary(layout, point) = dea_summary_failed();
    } else if (scene->study == DEA_STUDY_AC) {
        *dea_layout_band(layout, point) = (dea_band){(double)NAN, (double)NAN};
    }
}
