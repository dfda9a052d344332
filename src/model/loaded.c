#include "model/loaded.h"

#include <stdint.h>

#include "model/path.h"

/* The membrane's force on its edge is integrated: right to so much. */
static const double rough = 1e-12;

/* What acts on one edge. */
typedef struct parties {
    const dea_holder *holder;
    const dea_point *point;
    const dea_point *second; /* NULL: none */
    double radius;           /* r_a [m] */
    double base, toward;     /* strain from which the way begins, and the sign in which it goes */
    double begin;            /* what grows there, outward [N] */
    bool driven;             /* what grows is the voltage of the film; else force and second film */
    bool *lost;              /* borrowed: set where a place was asked for at which the films hold no edge */
} parties;

/* Forces on the edge, those of rest inward, and their slopes over u. */
typedef struct edge_forces {
    double held, held_slope; /* of films and springs without voltage */
    double load, load_slope; /* of force and second film, outward */
    double push, push_slope; /* of the film's voltage, outward */
    dea_found found, second;
} edge_forces;

static bool look(const parties *p, double strain, bool plain, edge_forces *f)
{
    dea_hold one = {.plain = plain}, other = {.plain = plain};
    const dea_holder *h = p->holder;
    if (!h->hold(h->user, p->point, strain, &one) || (p->second && !h->hold(h->user, p->second, strain, &other))) {
        *p->lost = true;
        return false;
    }
    const dea_spring spring = dea_point_spring(p->point, strain * p->radius);
    *f = (edge_forces){.held = one.held + other.held + spring.force,
                       .held_slope = one.held_slope + other.held_slope + spring.slope,
                       .load = p->point->force + other.push,
                       .load_slope = other.push_slope,
                       .push = one.push,
                       .push_slope = one.push_slope,
                       .found = one.found,
                       .second = other.found};
    return true;
}

static dea_path_place place_at(const void *user, double x)
{
    const parties *p = user;
    const double none = (double)NAN, sign = p->toward;
    edge_forces f;
    if (!look(p, p->base + sign * x, false, &f)) {
        return (dea_path_place){none, none, none, none};
    }
    const double slope = sign * p->radius / p->begin;
    return p->driven ? (dea_path_place){sign * (f.held - f.load), (f.held_slope - f.load_slope) * p->radius, f.push / p->begin,
                                        f.push_slope * slope}
                     : (dea_path_place){sign * f.held, f.held_slope * p->radius, f.load / p->begin, f.load_slope * slope};
}

/* Distance in strain from the base at which a region has vanished; linear films go on. */
static double end_of(const parties *p)
{
    const double b = p->point->coverage;
    if (p->holder->endless) {
        return 1e9;
    }
    return p->toward > 0.0 ? (1.0 - b) / b - p->base : 1.0 + p->base;
}

/* Newton from the linear answer, where it leads to a place so near that no fold can lie between. */
static bool is_near(const dea_path *path, double m, double *x)
{
    enum { ROUNDS = 8 };
    double at = m / path->rest;
    for (int i = 0; i < ROUNDS && at > 0.0 && at < path->end; i++) {
        const dea_path_place place = path->at(path->film, at);
        const double step = (place.held - m * place.weight) / (place.slope - m * place.weight_slope);
        *x = at -= step;
        if (fabs(step) <= fmax(2e-16, path->rough) * at) {
            return dea_path_cannot_fold(path, m, at, &place);
        }
    }
    return false;
}

/* Moves the base to where the load m is held, on a way whose slope there is `slope` [N/m]; false: it is held nowhere. The base is NAN
 * where it is, and was not found. */
static bool advance(parties *p, dea_path_place (*at)(const void *user, double x), double slope, double m)
{
    const dea_path path = {.at = at,
                           .film = p,
                           .rest = slope * p->radius,
                           .end = end_of(p),
                           .rough = p->holder->rough,
                           .share = 1.0 - p->point->coverage};
    double x = 0.0;
    if (!(slope > 0.0) || (m != 0.0 && !is_near(&path, m, &x) && !dea_path_trace(&path, m, &x))) {
        return false;
    }
    p->base += p->toward * x;
    return true;
}

/* Moves the base along the way of what grows; false: no equilibrium. */
static bool grow(parties *p, bool driven)
{
    edge_forces f;
    p->driven = driven;
    if (!look(p, p->base, false, &f)) {
        return false;
    }
    const double weight = driven ? f.push : f.load, slope = driven ? f.held_slope - f.load_slope : f.held_slope;
    p->toward = weight < 0.0 ? -1.0 : 1.0;
    p->begin = weight;
    const double stays = driven ? f.push_slope : f.load_slope;
    return (weight != 0.0 || slope > stays) && advance(p, place_at, slope, fabs(weight));
}

/* What the films hold beyond what acts on them at the voltage of the point, from the base on. */
static dea_path_place net_at(const void *user, double x)
{
    const parties *p = user;
    const double none = (double)NAN;
    edge_forces f;
    if (!look(p, p->base + p->toward * x, false, &f)) {
        return (dea_path_place){none, none, none, none};
    }
    return (dea_path_place){p->toward * (f.held - f.load - f.push) + p->begin,
                            (f.held_slope - f.load_slope - f.push_slope) * p->radius, 1.0, 0.0};
}

/* Moves the base to the equilibrium next to it under the voltage of the point; false: there is none, or it was not found. */
static bool settle(parties *p)
{
    const double base = p->base;
    edge_forces f;
    if (!look(p, base, false, &f)) {
        return false;
    }
    const double net = f.held - f.load - f.push;
    p->toward = net > 0.0 ? -1.0 : 1.0;
    p->begin = fabs(net);
    const bool stands = advance(p, net_at, f.held_slope - f.load_slope - f.push_slope, fabs(net)) && !isnan(p->base);
    p->base = stands ? p->base : base;
    return stands;
}

/* Is the base, under the voltage of the point, far from a fold: are the films some tenth as stiff there as without it? */
static bool is_stiff(const parties *p, double rest)
{
    edge_forces f;
    return look(p, p->base, false, &f) && f.held_slope - f.load_slope - f.push_slope > 0.1 * rest;
}

/* The voltage grows in parts, each from the place of the one before: the annulus of a lens may stand nowhere on the way under the whole
 * of it, and stand at its end. The base is NAN where the films are far from a fold and yet not found. */
static bool grow_by_parts(parties *p)
{
    const double least = 1.0 / 64.0; /* of the square: what does not go on so has come to its fold */
    const dea_point *whole = p->point;
    dea_point part = *whole;
    edge_forces f;
    double at = 0.0;
    p->point = &part;
    part.voltage = 0.0;
    const double rest = look(p, p->base, false, &f) ? f.held_slope - f.load_slope : (double)NAN;
    for (double step = 0.5; at < 1.0 && step >= least;) {
        const double next = fmin(1.0, at + step);
        part.voltage = whole->voltage * sqrt(next);
        *p->lost = false;
        const bool stands = settle(p);
        at = stands ? next : at;
        step *= stands ? 1.5 : 0.5;
    }
    part.voltage = whole->voltage * sqrt(at);
    const bool missed = at < 1.0 && *p->lost && is_stiff(p, rest);
    p->base = missed ? (double)NAN : p->base;
    p->point = whole;
    return at >= 1.0 || missed;
}

/* The row of the films: its state is that of the worse one, broken down or slack. */
static void fill(const parties *p, const edge_forces *f, dea_row *row)
{
    dea_row other;
    dea_row_fill(row, p->point, f->found);
    if (!p->second) {
        return;
    }
    dea_row_fill(&other, p->second, f->second);
    row->second_field = other.field;
    if (other.state == DEA_STATE_BREAKDOWN || (other.state == DEA_STATE_SLACK && row->state == DEA_STATE_OK)) {
        row->state = other.state;
    }
}

static parties parties_of(const dea_holder *holder, const dea_point *point, const dea_point *second, bool *lost)
{
    return (parties){.holder = holder,
                     .point = point,
                     .second = point->second.there ? second : NULL,
                     .radius = dea_point_divide(point),
                     .lost = lost};
}

void dea_loaded_solve(const dea_holder *holder, const dea_point *point, dea_row *row)
{
    const dea_point second = dea_point_second(point);
    bool lost = false;
    parties p = parties_of(holder, point, &second, &lost);
    edge_forces f;
    dea_point still = *point; /* force and second film come before the voltage, under which the film need not stand there */
    still.voltage = 0.0;
    p.point = &still;
    bool stands = grow(&p, false); /* it may stand, and not be found */
    p.point = point;
    if (stands && !isnan(p.base)) {
        lost = false;
        stands = grow(&p, true) || (lost && grow_by_parts(&p));
    }
    if (!stands || !look(&p, p.base, true, &f)) {
        dea_row_refuse(row, stands ? DEA_STATE_FAILED : DEA_STATE_PULL_IN);
        return;
    }
    fill(&p, &f, row);
}

void dea_loaded_hold(const dea_holder *holder, const dea_point *point, double displacement, dea_row *row)
{
    const dea_point second = dea_point_second(point);
    bool lost = false;
    const parties p = parties_of(holder, point, &second, &lost);
    const double room = point->frame_radius - p.radius;
    edge_forces f;
    dea_row_refuse(row, displacement > -p.radius && displacement < room ? DEA_STATE_PULL_IN : DEA_STATE_FAILED);
    if (row->state == DEA_STATE_PULL_IN && look(&p, displacement / p.radius, true, &f)) {
        fill(&p, &f, row);
        row->force = f.push + f.load - f.held;
    }
    row->displacement = displacement;
}

dea_status dea_loaded_curve(const dea_scene *scene, void (*hold)(void *user, const dea_point *point, double displacement, dea_row *row),
                            void *user, dea_row *rows, dea_error *error)
{
    dea_point point;
    dea_film_prepare(scene, &point.film);
    dea_point_place(scene, &point);
    if (!dea_point_valid(&point)) {
        return dea_fail(error, DEA_ERROR_USAGE, "a number is out of its range");
    }
    for (size_t i = 0; i < scene->force.points; i++) {
        hold(user, &point, dea_layout_place(scene, i), &rows[i]);
    }
    return DEA_OK;
}

static bool hold_by_model(void *user, const dea_point *point, double strain, dea_hold *hold)
{
    const dea_model *const *model = user;
    return (*model)->hold(point, strain, hold);
}

static dea_holder holder_of(const dea_model *const *model)
{
    return (dea_holder){hold_by_model, (void *)(uintptr_t)model, (*model)->linear != NULL, (*model)->membrane ? rough : 0.0};
}

void dea_model_hold(const dea_model *model, const dea_point *point, double displacement, dea_row *row)
{
    const dea_holder holder = holder_of(&model);
    dea_loaded_hold(&holder, point, displacement, row);
}

void dea_model_solve(const dea_model *model, const dea_point *point, double accuracy, dea_row *row)
{
    if (!dea_point_is_shared(point)) {
        model->solve(point, accuracy, row);
    } else if (!model->hold) {
        dea_row_refuse(row, DEA_STATE_FAILED); /* it has no edge */
    } else {
        const dea_holder holder = holder_of(&model);
        dea_loaded_solve(&holder, point, row);
    }
}
