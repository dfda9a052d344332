/* The film along its radius: the disc is uniform, lambda_1 = lambda_2 = lambda_pre (1 + s), the annulus as its model has it. True
 * stresses lambda_a P_a - eps E^2, E = U lambda_1 lambda_2/H, where electroded with what its skin holds and electrostriction adds. */
#include "engine/direct/direct.h"

#include <math.h>
#include <stdlib.h>

#include "film/point.h"

enum { SAMPLES = 65, HALVINGS = 60 };

/* A film in equilibrium. */
typedef struct film {
    const dea_point *point;
    const dea_model *model;
    double strain;
} film;

/* Everything but the displacement that follows from the stretches; @p outside: of the annulus. */
static void fill_stretched(const film *f, dea_stretches l, bool outside, dea_station *at)
{
    const dea_point *point = f->point;
    const double pre = point->film.prestretch, area = l.radial * l.hoop, nominal = dea_point_nominal_field(point);
    const bool electroded = outside == (point->kind == DEA_LENS);
    const double k = point->film.permittivity * dea_film_electric(&point->film, area).first * nominal * nominal;
    const double pressure = electroded ? k * area * area : 0.0;
    const double e1 = l.radial / pre - 1.0, e2 = l.hoop / pre - 1.0;
    dea_biaxial s = dea_film_biaxial(&point->film, e1, e2);
    if (electroded && point->skin_share > 0.0) {
        dea_point_coat(point, e1, e2, &s);
    }
    at->stretch[0] = l.radial;
    at->stretch[1] = l.hoop;
    at->thickness = point->film_thickness / point->layers / area;
    at->stress[0] = l.radial * (point->film.tension + s.p1) - pressure;
    at->stress[1] = l.hoop * (point->film.tension + s.p2) - pressure;
    at->field = electroded ? fabs(nominal) * point->layers * area : 0.0;
    at->state = at->field > point->film.breakdown                ? DEA_STATE_BREAKDOWN
                : fmin(at->stress[0], at->stress[1]) > 0.0 ? DEA_STATE_OK
                                                                 : DEA_STATE_SLACK;
}

/* Displacement of the annulus: lambda_2 R - lambda_pre R, or of a model that knows no more of it than its mean stretches a straight
 * line to the frame. */
static double annulus_displacement(const film *f, double radius, double hoop)
{
    const dea_point *point = f->point;
    const double edge = dea_point_divide(point);
    return f->model->membrane ? radius * (hoop / point->film.prestretch - 1.0)
                              : f->strain * edge * (point->frame_radius - radius) / (point->frame_radius - edge);
}

/* The annulus at x = ln(R/R_a). */
static bool annulus_at(const film *f, double x, dea_station *at)
{
    dea_stretches l;
    const bool there = f->model->along(f->point, f->strain, 1, &x, &l);
    if (there) {
        fill_stretched(f, l, true, at);
    }
    return there;
}

static dea_station disc_of(const film *f)
{
    dea_station at;
    const double l = f->point->film.prestretch * (1.0 + f->strain);
    fill_stretched(f, (dea_stretches){l, l}, false, &at);
    return at;
}

/* ---- the weakest places */

static double tension_of(const dea_station *at)
{
    return fmin(at->stress[0], at->stress[1]);
}

/* What is looked for: the smallest of these. */
static double weakness(const dea_station *at, bool field)
{
    return field ? -at->field : tension_of(at);
}

/* Golden section between two places about a sample that is smaller than its neighbours. */
static double refine(const film *f, bool field, double low, double high)
{
    const double golden = 0.5 * (sqrt(5.0) - 1.0);
    dea_station a, b;
    for (int i = 0; i < HALVINGS; i++) {
        const double left = high - golden * (high - low), right = low + golden * (high - low);
        if (!annulus_at(f, left, &a) || !annulus_at(f, right, &b)) {
            break;
        }
        *(weakness(&a, field) < weakness(&b, field) ? &high : &low) = weakness(&a, field) < weakness(&b, field) ? right : left;
    }
    return 0.5 * (low + high);
}

/* The weakest place of the annulus, by samples evenly in ln R and then between the neighbours of the best. */
static bool weakest_place(const film *f, bool field, double length, double *place, dea_station *best)
{
    size_t found = 0;
    for (size_t i = 0; i < SAMPLES; i++) {
        dea_station at;
        if (!annulus_at(f, length * (double)i / (SAMPLES - 1), &at)) {
            return false;
        }
        if (i == 0 || weakness(&at, field) < weakness(best, field)) {
            *best = at;
            found = i;
        }
    }
    const double step = length / (SAMPLES - 1);
    *place = (double)found * step;
    if (found > 0 && found + 1 < SAMPLES && f->model->membrane) {
        *place = refine(f, field, *place - step, *place + step);
        return annulus_at(f, *place, best);
    }
    return true;
}

static bool find_weakest(const film *f, dea_weakest *weakest)
{
    const double edge = dea_point_divide(f->point), length = -log(f->point->coverage);
    const dea_station disc = disc_of(f);
    double field_place, tension_place;
    dea_station strongest, slackest;
    if (!weakest_place(f, true, length, &field_place, &strongest) || !weakest_place(f, false, length, &tension_place, &slackest)) {
        return false;
    }
    const bool dot = f->point->kind == DEA_DOT, inside = tension_of(&disc) < tension_of(&slackest);
    *weakest = (dea_weakest){.field = dot ? disc.field : strongest.field,
                             .field_radius = dot ? 0.0 : edge * exp(field_place),
                             .tension = inside ? tension_of(&disc) : tension_of(&slackest),
                             .tension_radius = inside ? 0.0 : edge * exp(tension_place)};
    return true;
}

/* ---- rows */

/* Stations of the annulus, from number @p first on. */
static bool fill_annulus(const film *f, dea_station *stations, size_t first, size_t count)
{
    const double edge = dea_point_divide(f->point);
    double *x = malloc((count - first + 1) * sizeof *x);
    dea_stretches *l = malloc((count - first + 1) * sizeof *l);
    bool there = x && l;
    for (size_t i = first; i < count && there; i++) {
        x[i - first] = log(stations[i].radius / edge);
    }
    there = there && f->model->along(f->point, f->strain, count - first, x, l);
    for (size_t i = first; i < count && there; i++) {
        fill_stretched(f, l[i - first], true, &stations[i]);
        stations[i].displacement = annulus_displacement(f, stations[i].radius, l[i - first].hoop);
    }
    free(x);
    free(l);
    return there;
}

/* From the disc, to which the edge belongs, to the frame. */
static bool fill_stations(const film *f, dea_station *stations, size_t count)
{
    const double edge = dea_point_divide(f->point) * (1.0 + 1e-12);
    const dea_station disc = disc_of(f);
    size_t i = 0;
    for (; i < count && stations[i].radius <= edge; i++) {
        const double radius = stations[i].radius;
        stations[i] = disc;
        stations[i].radius = radius;
        stations[i].displacement = f->strain * radius;
    }
    if (!fill_annulus(f, stations, i, count)) {
        return false;
    }
    stations[count - 1].displacement = 0.0; /* the frame holds it */
    return true;
}

static void refuse(const dea_scene *scene, const dea_layout *layout, dea_station *stations, dea_state state)
{
    dea_layout_fail(scene, layout, stations);
    for (size_t i = 0; i < layout->rows; i++) {
        stations[i].state = state;
    }
}

dea_status dea_direct_profile(void *session, const dea_scene *scene, const dea_model *model, const dea_layout *layout, void *point,
                              dea_error *error)
{
    (void)session;
    dea_station *stations = point;
    dea_row row = dea_row_failed();
    dea_point at;
    dea_film_prepare(scene, &at.film);
    dea_point_place(scene, &at);
    if (!dea_point_valid(&at)) {
        char fault[DEA_FAULT_LENGTH];
        return dea_fail(error, DEA_ERROR_USAGE, "%s", dea_film_fault(&at.film, fault));
    }
    dea_model_solve(model, &at, 0.01 * scene->accuracy, &row);
    dea_layout_fail(scene, layout, point);
    const film f = {&at, model, row.strain};
    const bool there = !isnan(row.strain) && fill_stations(&f, stations, layout->rows) && find_weakest(&f, dea_layout_weakest(layout, point));
    if (!there) {
        refuse(scene, layout, stations, isnan(row.strain) ? row.state : DEA_STATE_FAILED);
    }
    return DEA_OK;
}
