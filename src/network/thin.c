/* The film takes in the square P of the voltage by its impulse response, u(t) = int g(t - s) P(s) ds. Over an interval, P goes for its
 * projection p on polynomials of degree d = 11: the moments of both agree, so that behind the interval all but what the best
 * polynomial of that degree leaves of g vanishes,
 *
 *     |du|/u <= 2 (Omega h/4)^(d+1)/(d+1)! A mean|P - p|/P_mean
 *
 * with the fastest rate Omega of g, and A = Omega int|g|/g_max in which its swing adds up; or, whatever g is, A max|P - p|/P_mean.
 * Inside of it the film shows what P - p has brought so far, Omega^2 int int (P - p), or Omega int (P - p) without mass. So the ends
 * of intervals are samples where they can be. */
#include "network/thin.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "deaspice/result.h"
#include "support/grow.h"

/* Share of the accuracy that thinning takes, all errors of a sample together. */
static const double share = 0.05;

/* Fewest lines of a signal, and of one interval, for which it pays. */
enum { MANY_LINES = 64, FEWEST = 8 };

/* Longest interval, in times 1/Omega. */
static const double longest = 64.0;

/* (d + 1)! */
static const double factorial = 479001600.0;

/* What bounds are taken for: Omega is that at rest and under the largest voltage, and the film may be softer or faster between. */
static const double safety = 4.0;

typedef struct film {
    double rate;  /* Omega [1/s] */
    double adds;  /* A [1] */
    bool heavy;   /* with mass */
    double least; /* P_mean, times what of its displacement at rest the film gets to within the run [V^2] */
    double strain; /* of the narrower of disc and annulus under the largest voltage [1] */
    double pace;  /* 1/T of the velocity [1/s] */
    double allowed; /* error of the displacement [1] */
} film;

typedef struct thinner {
    dea_signal *signal;
    const dea_segment *lines; /* what the signal was */
    size_t line_count;
    film film;
    const double *stops; /* times at which the film is seen [s] */
    size_t stop_count, stop;
    dea_segment *made; /* what it becomes */
    size_t count, room;
    double *terms;
    size_t term_count, term_room; /* polynomials */
    size_t line;       /* of the time that is reached */
    size_t held;       /* line of the last segment made, SIZE_MAX: a polynomial */
    bool exhausted;
} thinner;

/* An interval, its polynomial, and what that leaves, over its length h. */
typedef struct interval {
    double from, to;
    size_t first, count; /* lines */
    bool seen;           /* a stop lies inside */
    double terms[DEA_TERMS];
    double mean, most;   /* of |P - p| [V^2] */
    double below;        /* int max(-p, 0)/h: what its root leaves out [V^2] */
    double once, twice;  /* largest int (P - p)/h, int int (P - p)/h^2 on the way [V^2] */
} interval;

/* ---- the film */

/* Rate and A of the film at a displacement under a voltage. */
static void rate_at(dea_dynamics *d, double u, double voltage, double until, film *f)
{
    const dea_edge e = dea_dynamics_edge(d, u);
    const double relaxed = dea_dynamics_stiffness(d, u, voltage, true), resistance = dea_edge_resistance(d, &e);
    const double held = relaxed + dea_edge_viscous(d, &e) * d->total_share;
    if (!(relaxed > 0.0)) {
        f->rate = INFINITY;
        return;
    }
    double rate = resistance > 0.0 ? held / resistance : (double)INFINITY, adds = 1.0, reached = fmin(1.0, until * relaxed / resistance);
    if (d->mass > 0.0) {
        const double omega = sqrt(held / d->mass), ratio = 0.5 * resistance / (d->mass * omega);
        rate = fmax(omega, resistance / d->mass);
        adds = fmin(1.0 + 1.0 / ratio, 1.0 + omega * until);
        reached = fmin(resistance > 0.0 ? reached : 1.0, 0.5 * until * until * relaxed / d->mass);
    }
    f->rate = fmax(f->rate, rate);
    f->adds = fmax(f->adds, adds * held / relaxed);
    f->least = fmin(f->least, reached);
}

/* A branch of time tau adds a part of size c (Omega tau)^n to what is seen at the end of an interval, n = 4 with mass, else 2. */
static void rate_of_branches(const dea_dynamics *d, film *f)
{
    const double film_rate = f->rate;
    for (size_t i = 0; i < d->branch_count; i++) {
        const double tau = d->branches[i].tau, part = d->branches[i].share * pow(film_rate * tau, f->heavy ? 4.0 : 2.0);
        f->rate = part > f->allowed ? fmax(f->rate, 1.0 / tau) : f->rate;
    }
}

/* int U^2 dt over the signal, over its length [V^2]. */
static double mean_square(const dea_signal *signal)
{
    double sum = 0.0;
    for (size_t i = 0; i < signal->count; i++) {
        const dea_segment *s = &signal->segments[i];
        sum += (s->to - s->from) * (s->start * s->start + s->start * s->end + s->end * s->end) / 3.0;
    }
    return sum / signal->segments[signal->count - 1].to;
}

static film film_of(const dea_signal *signal, const dea_scene *scene, dea_dynamics *d, double pace)
{
    const double still = isnan(d->rest) ? 0.0 : d->rest, until = scene->transient.until;
    film f = {.heavy = d->mass > 0.0, .least = 1.0, .pace = fmax(pace, 1.0 / until), .allowed = share * scene->accuracy};
    double u = still;
    rate_at(d, still, 0.0, until, &f);
    if (dea_dynamics_equilibrium(d, signal->largest, &u)) {
        rate_at(d, u, signal->largest, until, &f);
    }
    f.strain = fabs(u) / fmin(d->radius, d->point.frame_radius - d->radius);
    f.least *= mean_square(signal);
    rate_of_branches(d, &f);
    return f;
}

/* ---- the polynomial */

/* Gauss-Legendre rules: of seven places, exact for the square of a line times P_11; of three for lines that are a hundredth of the
 * interval at most, over which P_11 is of the fifth degree but for 1e-9 and less. */
typedef struct rule {
    int places;
    double place[7], weight[7];
} rule;
static const rule seven = {7,
                           {-0.94910791234275852453, -0.74153118559939443986, -0.40584515137739716691, 0.0, 0.40584515137739716691,
                            0.74153118559939443986, 0.94910791234275852453},
                           {0.12948496616886969327, 0.27970539148927666790, 0.38183005050511894495, 0.41795918367346938776,
                            0.38183005050511894495, 0.27970539148927666790, 0.12948496616886969327}};
static const rule three = {3, {-0.77459666924148337704, 0.0, 0.77459666924148337704}, {5.0 / 9.0, 8.0 / 9.0, 5.0 / 9.0}};
static const double tiny = 0.01;

static const rule *rule_of(const interval *v, double width)
{
    return width <= tiny * (v->to - v->from) ? &three : &seven;
}

static double square_at(const dea_segment *line, double time)
{
    const double voltage = dea_segment_voltage(NULL, line, time);
    return voltage * voltage;
}

/* c_n = (2n + 1)/2 int P P_n dx, a line's part. */
static void project_line(interval *v, const dea_segment *line)
{
    const double from = fmax(line->from, v->from), to = fmin(line->to, v->to), half = 0.5 * (to - from);
    const rule *r = rule_of(v, to - from);
    for (int g = 0; g < r->places; g++) {
        const double time = from + half * (1.0 + r->place[g]), x = 2.0 * (time - v->from) / (v->to - v->from) - 1.0;
        const double part = half * r->weight[g] / (v->to - v->from) * square_at(line, time);
        double p0 = 1.0, p1 = x;
        for (int n = 0; n < DEA_TERMS; n++) {
            v->terms[n] += (2 * n + 1) * part * p0;
            const double p2 = ((2 * n + 3) * x * p1 - (n + 1) * p0) / (n + 2);
            p0 = p1, p1 = p2;
        }
    }
}

/* What the polynomial leaves of a line, in times of the interval's length. */
static void compare_line(interval *v, const dea_segment *line, const dea_segment *whole, double *once, double *twice)
{
    const double h = v->to - v->from, from = fmax(line->from, v->from), to = fmin(line->to, v->to), half = 0.5 * (to - from);
    const rule *r = rule_of(v, to - from);
    double moment = 0.0, sum = 0.0;
    for (int g = 0; g < r->places; g++) {
        const double time = from + half * (1.0 + r->place[g]), part = half * r->weight[g] / h;
        const double p = dea_segment_square(whole, time), off = square_at(line, time) - fmax(p, 0.0);
        v->below += part * fmax(-p, 0.0);
        v->mean += part * fabs(off);
        v->most = fmax(v->most, fabs(off));
        sum += part * off;
        moment += part * off * half * (1.0 - r->place[g]) / h;
    }
    *twice += *once * (to - from) / h + moment;
    *once += sum;
    v->once = fmax(v->once, fabs(*once));
    v->twice = fmax(v->twice, fabs(*twice));
}

static void fit(const thinner *t, interval *v)
{
    const dea_segment whole = {.from = v->from, .to = v->to, .sine = true, .terms = v->terms};
    double once = 0.0, twice = 0.0;
    for (size_t i = 0; i < v->count; i++) {
        project_line(v, &t->lines[v->first + i]);
    }
    for (size_t i = 0; i < v->count; i++) {
        compare_line(v, &t->lines[v->first + i], &whole, &once, &twice);
    }
}

/* Error of a sample by an interval [1]. A film whose force or stiffness varies over its strain answers to the ripple inside, too. */
static double error_of(const film *f, const interval *v)
{
    const double angle = f->rate * (v->to - v->from), most = f->adds * v->most;
    const double best = 2.0 * pow(0.25 * angle, DEA_TERMS) / factorial;
    const double end = fmin(most, f->adds * (best * v->mean + v->below));
    const double inside = fmin(most, f->heavy ? angle * angle * v->twice : angle * v->once);
    const double rate = fmin(f->rate * most, f->heavy ? f->rate * angle * v->once : f->rate * inside);
    const double ripple = f->strain * inside * v->most / f->least;
    const double seen = fmax(v->seen ? inside : 0.0, (v->seen ? rate : f->rate * end) / (10.0 * f->pace));
    return safety * (fmax(end, seen) + ripple) / f->least;
}

/* ---- the signal */

static void make(thinner *t, dea_segment segment)
{
    dea_segment *made = dea_grow(t->made, t->count, &t->room, sizeof *made);
    if (!made) {
        t->exhausted = true;
        return;
    }
    t->made = made;
    made[t->count++] = segment;
}

static void keep_polynomial(thinner *t, const interval *v)
{
    double *terms = dea_grow(t->terms, t->term_count, &t->term_room, sizeof v->terms);
    if (!terms) {
        t->exhausted = true;
        return;
    }
    t->terms = terms;
    memcpy(terms + DEA_TERMS * t->term_count++, v->terms, sizeof v->terms);
    make(t, (dea_segment){.from = v->from, .to = v->to, .sine = true, .lines = &t->lines[v->first], .line_count = v->count});
    t->held = SIZE_MAX;
}

/* The part of a line within an interval; what continues the last segment joins it. */
static void keep_line(thinner *t, size_t index, double from, double to)
{
    const dea_segment *line = &t->lines[index];
    dea_segment part = *line;
    part.from = fmax(from, line->from);
    part.to = fmin(to, line->to);
    if (!line->sine) {
        part.start = part.from > line->from ? dea_segment_voltage(NULL, line, part.from) : line->start;
        part.end = dea_segment_voltage(NULL, line, part.to);
    }
    if (t->held == index && t->count > 0) {
        t->made[t->count - 1].to = part.to;
        t->made[t->count - 1].end = part.end;
    } else {
        make(t, part);
    }
    t->held = index;
}

static void keep_lines(thinner *t, const interval *v)
{
    for (size_t i = 0; i < v->count; i++) {
        keep_line(t, v->first + i, v->from, v->to);
    }
}

/* End of an interval from a time on that takes no longer than @p reach: the last stop in reach, or an equal part of the way to the
 * next one. */
static double end_of(thinner *t, double from, double reach, double limit, bool *seen)
{
    while (t->stop < t->stop_count && t->stops[t->stop] <= from) {
        t->stop++;
    }
    size_t next = t->stop;
    while (next < t->stop_count && t->stops[next] <= fmin(from + reach, limit)) {
        next++;
    }
    *seen = next > t->stop + 1;
    if (next > t->stop) {
        return t->stops[next - 1];
    }
    const double to = fmin(limit, next < t->stop_count ? t->stops[next] : limit);
    return to - from <= reach ? to : from + (to - from) / ceil((to - from) / reach);
}

/* Lines of an interval from the line that is reached on. */
static void take_lines(const thinner *t, interval *v)
{
    v->first = t->line;
    while (v->first + 1 < t->line_count && t->lines[v->first].to <= v->from) {
        v->first++;
    }
    v->count = 1;
    while (v->first + v->count < t->line_count && t->lines[v->first + v->count].from < v->to) {
        v->count++;
    }
}

/* Thins from a time on, up to a limit behind which is no line; the time that it came to. */
static double thin_on(thinner *t, double from, double limit, double *reach)
{
    for (;;) {
        interval v = {.from = from};
        v.to = end_of(t, from, *reach, limit, &v.seen);
        take_lines(t, &v);
        if (v.count < FEWEST) {
            keep_lines(t, &v);
            t->line = v.first;
            *reach = fmin(2.0 * *reach, longest / t->film.rate);
            return v.to;
        }
        fit(t, &v);
        const double error = error_of(&t->film, &v);
        if (error <= t->film.allowed) {
            keep_polynomial(t, &v);
            t->signal->thinned = fmax(t->signal->thinned, error);
            t->line = v.first;
            *reach = fmin(2.0 * *reach, longest / t->film.rate);
            return v.to;
        }
        *reach = 0.5 * fmin(*reach, v.to - from);
    }
}

/* All lines between sines. */
static void thin_all(thinner *t)
{
    double reach = longest / t->film.rate;
    for (size_t i = 0, end; i < t->line_count && !t->exhausted; i = end) {
        end = i + 1;
        if (t->lines[i].sine) {
            keep_line(t, i, t->lines[i].from, t->lines[i].to);
            continue;
        }
        while (end < t->line_count && !t->lines[end].sine) {
            end++;
        }
        t->line = i;
        for (double time = t->lines[i].from; time < t->lines[end - 1].to && !t->exhausted;) {
            time = thin_on(t, time, t->lines[end - 1].to, &reach);
        }
    }
}

/* Ends of the polynomials, which other arrays must not move for. */
static void close_segments(thinner *t)
{
    size_t next = 0;
    for (size_t i = 0; i < t->count; i++) {
        dea_segment *s = &t->made[i];
        if (s->sine && s->lines) {
            s->terms = t->terms + DEA_TERMS * next++;
            s->start = dea_segment_voltage(t->signal, s, s->from);
            s->end = dea_segment_voltage(t->signal, s, s->to);
        }
    }
}

static int by_time(const void *a, const void *b)
{
    const double *x = a, *y = b;
    return (*x > *y) - (*x < *y);
}

/* Times of the samples and ends of the windows. */
static double *find_stops(const dea_scene *scene, size_t *count)
{
    const size_t rows = dea_layout_of(scene).rows;
    double *stops = malloc((rows + 2 * scene->transient.average_count) * sizeof *stops);
    *count = 0;
    for (size_t i = 0; stops && i < rows; i++) {
        stops[(*count)++] = dea_layout_place(scene, i);
    }
    for (size_t i = 0; stops && i < scene->transient.average_count; i++) {
        stops[(*count)++] = scene->transient.averages[i].from;
        stops[(*count)++] = scene->transient.averages[i].to;
    }
    if (stops && scene->transient.average_count > 0) {
        qsort(stops, *count, sizeof *stops, by_time);
    }
    return stops;
}

static bool applies(const dea_signal *signal, const dea_dynamics *d)
{
    return signal->count >= MANY_LINES && d->series == 0.0 && !dea_dynamics_is_free(d) && signal->largest > 0.0;
}

dea_status dea_signal_thin(dea_signal *signal, const dea_scene *scene, dea_dynamics *d, double pace, dea_error *error)
{
    if (!applies(signal, d)) {
        return DEA_OK;
    }
    thinner t = {.signal = signal, .lines = signal->segments, .line_count = signal->count, .held = SIZE_MAX};
    t.film = film_of(signal, scene, d, pace);
    if (!isfinite(t.film.rate) || !(t.film.least > 0.0)) {
        return DEA_OK;
    }
    double *stops = find_stops(scene, &t.stop_count);
    t.stops = stops;
    t.exhausted = !stops;
    if (stops) {
        thin_all(&t);
    }
    free(stops);
    if (t.exhausted || t.term_count == 0) {
        free(t.made);
        free(t.terms);
        signal->thinned = 0.0;
        return t.exhausted ? dea_fail(error, DEA_ERROR_MEMORY, "out of memory while a drive is thinned") : DEA_OK;
    }
    close_segments(&t);
    signal->record = signal->segments;
    signal->segments = t.made;
    signal->count = t.count;
    signal->terms = t.terms;
    return DEA_OK;
}
