#include "network/units.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "drive/wave.h"

/* The power of two that takes a size to [1, 2). */
static double unit_for(double size)
{
    return size > 0.0 && isfinite(size) ? ldexp(1.0, -ilogb(size)) : 1.0;
}

/* Of these units of stress and force. */
static dea_units units_from(const dea_sizes *sizes, double stress, double force)
{
    const double length = unit_for(sizes->displacement);
    return (dea_units){.length = length,
                       .thickness = force / (stress * length),
                       .stress = stress,
                       .voltage = unit_for(sizes->voltage),
                       .time = unit_for(sizes->time)};
}

/* The force is a stress on an area of length times thickness. Where the springs are linear no stress stands for itself. */
dea_units dea_units_of(dea_dynamics *dynamics, const dea_sizes *sizes)
{
    const dea_edge rest = dea_dynamics_edge(dynamics, 0.0);
    const double stress = fabs(rest.stress_slope[0]) * sizes->displacement;
    const double force = unit_for(dea_edge_viscous(dynamics, &rest) * sizes->displacement);
    return units_from(sizes, dynamics->linear ? force / unit_for(sizes->displacement) : unit_for(stress), force);
}

dea_units dea_units_of_rings(const dea_membrane *membrane, const dea_membrane_rest *rest, const dea_sizes *sizes)
{
    const dea_dynamics *d = &membrane->film;
    const dea_film *film = &d->point.film;
    const double stress = (1.0 + d->held) * film->square * film->w11 * sizes->displacement / d->radius;
    const double force = fabs(rest->force) * sizes->voltage * sizes->voltage;
    return units_from(sizes, unit_for(stress), unit_for(force));
}

/* m u'' is a force, phi U^2 too: rho H r^2 u/t^2 and eps (U/H)^2 H r. */
static double density(const dea_units *u)
{
    return u->stress * u->time * u->time / (u->length * u->length);
}

static double permittivity(const dea_units *u)
{
    return u->stress * u->thickness * u->thickness / (u->voltage * u->voltage);
}

static double charge(const dea_units *u)
{
    return permittivity(u) * u->length * u->length / u->thickness * u->voltage;
}

static double resistance(const dea_units *u)
{
    return u->voltage * u->time / charge(u);
}

static void enter_law(const dea_units *u, const dea_law *law, double constants[DEA_LAW_CONSTANTS])
{
    for (size_t i = 0; law && i < DEA_LAW_CONSTANTS; i++) {
        constants[i] *= law->constants[i % law->constant_count].modulus ? u->stress : 1.0;
    }
}

static void enter_material(const dea_units *u, dea_material *material)
{
    enter_law(u, material->law, material->constants);
    material->modulus *= u->stress;
    material->permittivity *= permittivity(u);
    material->permittivity_per_stretch *= permittivity(u);
    material->density *= density(u);
    material->retardation *= u->time;
    material->breakdown *= u->voltage / u->thickness;
    for (size_t i = 0; i < material->prony_count; i++) {
        material->prony[i].tau *= u->time;
    }
}

static dea_status enter_points(const dea_units *u, dea_waveform *wave, dea_error *error)
{
    double *times = malloc(2 * wave->point_count * sizeof *times);
    if (!times) {
        return dea_fail(error, DEA_ERROR_MEMORY, "out of memory for the points of a waveform");
    }
    double *voltages = times + wave->point_count;
    for (size_t i = 0; i < wave->point_count; i++) {
        times[i] = wave->times[i] * u->time;
        voltages[i] = wave->voltages[i] * u->voltage;
    }
    wave->times = times;
    wave->voltages = voltages;
    return DEA_OK;
}

static void enter_wave(const dea_units *u, dea_waveform *wave)
{
    const dea_wave *kind = dea_wave_of(wave->kind);
    const struct {
        const char *unit;
        double factor;
    } factors[] = {{"V", u->voltage}, {"s", u->time}, {"Hz", 1.0 / u->time}};
    const size_t entries = kind && kind->stride ? wave->sine_count : 1;
    for (size_t i = 0; kind && i < kind->number_count * entries; i++) {
        const size_t number = i % kind->number_count;
        for (size_t k = 0; k < sizeof factors / sizeof *factors; k++) {
            const bool fits = strcmp(kind->numbers[number].unit, factors[k].unit) == 0;
            *dea_wave_at(kind, wave, number, i / kind->number_count) *= fits ? factors[k].factor : 1.0;
        }
    }
    wave->period *= u->time;
}

static void enter_loads(const dea_units *u, dea_edge_load *loads)
{
    for (size_t i = 0; i < DEA_LOADS; i++) {
        const dea_load_kind *kind = loads[i].kind;
        loads[i].number *= kind ? u->stress * u->thickness * pow(u->length, kind->length) * pow(u->time, kind->time) : 1.0;
    }
}

dea_status dea_units_enter(const dea_units *units, const dea_scene *scene, dea_scene *inside, dea_error *error)
{
    *inside = *scene;
    dea_actuator *actuator = &inside->actuator;
    actuator->frame_radius *= units->length;
    actuator->divide_radius *= units->length;
    actuator->focal_length *= units->length;
    actuator->film_thickness *= units->thickness;
    actuator->electrode_mass *= density(units) * units->thickness;
    inside->electrode.thickness *= units->thickness;
    inside->electrode.density *= density(units);
    inside->electrode.sheet_resistance *= resistance(units);
    enter_law(units, inside->electrode.law, inside->electrode.constants);
    enter_loads(units, inside->loads);
    inside->antagonist.frame_radius *= units->length;
    inside->antagonist.film_thickness *= units->thickness;
    inside->antagonist.voltage *= units->voltage;
    enter_material(units, &inside->antagonist.material);
    enter_material(units, &inside->material);
    inside->drive.series_resistance *= resistance(units);
    inside->drive.leakage_resistance *= resistance(units);
    inside->drive.current_limit *= charge(units) / units->time;
    enter_wave(units, &inside->drive.waveform);
    inside->transient.until *= units->time;
    inside->transient.every *= units->time;
    inside->transient.first *= units->time;
    inside->transient.grid /= units->time;
    for (size_t i = 0; i < inside->transient.average_count; i++) {
        inside->transient.averages[i].from *= units->time;
        inside->transient.averages[i].to *= units->time;
    }
    inside->reduction.ring *= units->time;
    inside->ac.from /= units->time;
    inside->ac.to /= units->time;
    inside->ac.bias *= units->voltage;
    return dea_wave_is_listed(&inside->drive.waveform) ? enter_points(units, &inside->drive.waveform, error) : DEA_OK;
}

void dea_units_leave(dea_scene *inside)
{
    if (dea_wave_is_listed(&inside->drive.waveform)) {
        free(inside->drive.waveform.times);
    }
}

void dea_units_return_sample(const dea_units *units, dea_sample *sample)
{
    sample->time /= units->time;
    sample->voltage /= units->voltage;
    sample->displacement /= units->length;
    sample->velocity /= units->length / units->time;
    sample->force /= units->stress * units->thickness * units->length;
    sample->current /= charge(units) / units->time;
    sample->charge /= charge(units);
    sample->focal_length /= units->length;
    sample->film_voltage /= units->voltage;
    sample->capacitance /= charge(units) / units->voltage;
}

void dea_units_return_response(const dea_units *units, dea_response *row)
{
    row->frequency *= units->time;
    row->displacement /= units->length / units->voltage;
    row->impedance /= resistance(units);
}

void dea_units_return_summary(const dea_units *units, dea_summary *summary)
{
    const double energy = units->stress * units->thickness * units->length * units->length;
    summary->work /= energy;
    summary->electric /= energy;
    summary->elastic /= energy;
    summary->kinetic /= energy;
    summary->dissipated /= energy;
    summary->peak_current /= charge(units) / units->time;
    summary->peak_time /= units->time;
    for (size_t i = 0; i < DEA_WINDOWS; i++) {
        summary->averages[i].displacement /= units->length;
    }
}
