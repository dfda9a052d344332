#include "network/along.h"

#include <math.h>
#include <stdlib.h>

#include "film/point.h"

dea_status dea_along_open(const dea_membrane *m, const dea_scene *scene, const dea_layout *layout, dea_along *along, dea_error *error)
{
    *along = (dea_along){.count = layout->spread_points, .accuracy = scene->accuracy};
    along->spots = along->count > 0 ? malloc(along->count * sizeof *along->spots) : NULL;
    if (along->count > 0 && !along->spots) {
        return dea_fail(error, DEA_ERROR_MEMORY, "out of memory for %zu radii", along->count);
    }
    for (size_t i = 0; i < along->count; i++) {
        const double radius = fmin(dea_layout_radius(scene, layout, i) / m->film.point.film.prestretch, m->rings.rim);
        along->spots[i] = dea_rings_spot_at(&m->rings, radius, false);
    }
    return DEA_OK;
}

void dea_along_close(dea_along *along)
{
    free(along->spots);
}

static bool electroded(const dea_membrane *m, bool disc)
{
    return disc == (m->film.point.kind == DEA_DOT);
}

/* True stresses lambda_a (P_0 + P_a) of film, held branches and skin at stretches lambda_pre (1 + e_a) [Pa]. */
static void elastic_stress(const dea_membrane *m, bool coated, const double e[2], double stress[2])
{
    const dea_film *film = &m->film.point.film;
    const dea_biaxial own = dea_film_biaxial(film, e[0], e[1]);
    const double p[2] = {own.p1, own.p2};
    dea_biaxial skin = {0};
    if (coated && m->film.point.skin_share > 0.0) {
        dea_point_coat(&m->film.point, e[0], e[1], &skin);
    }
    const double coat[2] = {skin.p1, skin.p2};
    for (int a = 0; a < 2; a++) {
        const double l = film->prestretch * (1.0 + e[a]);
        const double change = l * p[a] + film->prestretch * e[a] * film->tension;
        stress[a] = l * (film->tension + p[a] + coat[a]) + m->film.held * change;
    }
}

/* eps E^2 of a true field over the layers, eps (U lambda_1 lambda_2/H)^2 [Pa], and the field of one layer [V/m]. */
static double pressure_of(const dea_point *point, double voltage, double area, double *field)
{
    const double nominal = voltage / point->film_thickness * area;
    *field = fabs(nominal) * point->layers;
    return point->film.permittivity * dea_film_electric(&point->film, area).first * nominal * nominal;
}

static void tell_spot(const dea_membrane *m, const dea_rings_spot *spot, const dea_along_state *state, double *entry)
{
    const dea_point *point = &m->film.point;
    const double l0 = point->film.prestretch;
    double slope, gradient, stress[2], field;
    const double u = dea_rings_displacement(&m->rings, spot, state->u, &slope);
    const double v = dea_rings_displacement(&m->rings, spot, state->v, &gradient);
    const double e[2] = {slope / l0, spot->radius > 0.0 ? u / (spot->radius * l0) : slope / l0};
    const double area = l0 * l0 * (1.0 + e[0]) * (1.0 + e[1]);
    const bool coated = electroded(m, spot->disc);
    const bool spread = state->look->spread && coated;
    const double local = spread ? dea_rings_value(&m->rings, spot, state->look->voltages, 1) : state->voltage;
    const double pressure = pressure_of(point, coated ? local : 0.0, area, &field);
    elastic_stress(m, coated, e, stress);
    for (int a = 0; a < 2; a++) {
        stress[a] += dea_rings_value(&m->rings, spot, &state->x[0][a], 2) - pressure;
    }
    const double told[DEA_SPREAD_COLUMNS] = {
        [DEA_ALONG_DISPLACEMENT] = u,
        [DEA_ALONG_VELOCITY] = v,
        [DEA_ALONG_RADIAL] = l0 * (1.0 + e[0]),
        [DEA_ALONG_HOOP] = l0 * (1.0 + e[1]),
        [DEA_ALONG_THICKNESS] = point->film_thickness / point->layers / area,
        [DEA_ALONG_RADIAL_STRESS] = stress[0],
        [DEA_ALONG_HOOP_STRESS] = stress[1],
        [DEA_ALONG_FIELD] = field,
    };
    for (size_t i = 0; i < DEA_SPREAD_COLUMNS; i++) {
        entry[i] = told[i] + 0.0; /* no -0 */
    }
}

void dea_along_tell(const dea_along *along, const dea_membrane *m, const dea_along_state *state, double *entries)
{
    for (size_t i = 0; i < along->count; i++) {
        tell_spot(m, &along->spots[i], state, entries + i * DEA_SPREAD_COLUMNS);
    }
}

/* Looks for a largest value of the film, at first -INFINITY, in an element; its radius is that at rest. */
static void search(const dea_membrane *m, bool disc, const double *values, double *largest, double *radius)
{
    const double grain = 1e-3 * m->rings.rim;
    double place;
    const double here = dea_rings_largest(&m->rings, disc, values, &place);
    if (here > *largest) {
        *largest = here;
        *radius = grain * m->film.point.film.prestretch * round(place / grain);
    }
}

/* Range of values at the rings, of the electroded ones alone or of all. */
static double range_of(const dea_membrane *m, bool coated_alone, const double *values)
{
    double low = INFINITY, high = -INFINITY;
    for (size_t r = 0; r < m->rings.ring_count; r++) {
        const bool counts = m->rings.rings[r].electroded || !coated_alone;
        low = counts ? fmin(low, values[r]) : low;
        high = counts ? fmax(high, values[r]) : high;
    }
    return high - low;
}

dea_weakest dea_along_weakest(const dea_along *along, const dea_membrane *m, const dea_along_state *state)
{
    const double least = 10.0 * along->accuracy;
    double field[DEA_RINGS_MOST], loss[2][DEA_RINGS_MOST], most = -INFINITY, spread = 0.0; /* of tension */
    dea_weakest weakest = {.field = -INFINITY};
    for (size_t r = 0; r < m->rings.ring_count; r++) {
        const dea_ring_look *at = &state->look->rings[r];
        const double voltage = dea_membrane_voltage(m, state->look, r, state->voltage);
        const double pressure = pressure_of(&m->film.point, voltage, at->stretch[0] * at->stretch[1], &field[r]);
        for (int a = 0; a < 2; a++) {
            loss[a][r] = pressure - at->stretch[a] * (m->film.point.film.tension + at->nominal[a]) - state->x[r][a];
        }
    }
    search(m, m->film.point.kind == DEA_DOT, field, &weakest.field, &weakest.field_radius);
    for (int i = 0; i < 4; i++) {
        search(m, i < 2, loss[i % 2], &most, &weakest.tension_radius);
        spread = fmax(spread, range_of(m, false, loss[i % 2]));
    }
    weakest.tension = -most;
    weakest.field_radius = range_of(m, true, field) > least * weakest.field ? weakest.field_radius : (double)NAN;
    weakest.tension_radius = spread > least * fabs(weakest.tension) ? weakest.tension_radius : (double)NAN;
    return weakest;
}
