/* See film_balance.h. The law gives stress differences to the pre-stretch that keep their digits at a strain of 1e-12. */
#include "model/film_balance.h"

#include "model/path.h"
#include "support/lanes.h"

/* Points on their way at once: two vectors of the widest hide each other's waits. */
enum { ABREAST = 2 * DEA_LANES };

#define EACH(l) for (size_t l = 0; l < ABREAST; l++)

typedef struct balance {
    double load;  /* N = sigma_A - sigma_P [Pa] */
    double slope; /* dN/de */
    double curve; /* d2N/de2 */
    double fold;  /* (1 + e) dN/de - 4 N, sign of dU/de */
} balance;

/* Two films of which the passive one gives back `ratio` of the active one's strain, the active one with its skin. */
typedef struct film_pair {
    const dea_film *film;
    double ratio;
    const dea_film *skin; /* NULL: none */
    double share;         /* t lambda_pre^2/H: its Cauchy stress counts so much [1] */
    double load, turn;    /* a spring at the edge adds load e (1 + turn e) [Pa], turn e being the strain of the disc */
} film_pair;

static inline balance balance_at(const film_pair *pair, double e)
{
    const dea_film *film = pair->film;
    const double ratio = pair->ratio;
    const double strains[] = {e, -ratio * e};
    dea_change changes[2];
    film->law->change(film, ratio > 0.0 ? 2 : 1, strains, changes);
    const dea_change active = changes[0];
    balance b = {active.value, active.slope, active.curve, 0.0};
    if (ratio > 0.0) {
        const dea_change passive = changes[1];
        b.load -= passive.value;
        b.slope += ratio * passive.slope;
        b.curve -= ratio * ratio * passive.curve;
    }
    if (pair->skin) {
        dea_change skin;
        pair->skin->law->change(pair->skin, 1, &e, &skin);
        b.load += pair->share * skin.value;
        b.slope += pair->share * skin.slope;
        b.curve += pair->share * skin.curve;
    }
    b.load += pair->load * e * (1.0 + pair->turn * e);
    b.slope += pair->load * (1.0 + 2.0 * pair->turn * e);
    b.curve += 2.0 * pair->load * pair->turn;
    b.fold = (1.0 + e) * b.slope - 4.0 * b.load;
    return b;
}

static dea_path_place place_at(const void *user, double e)
{
    const film_pair *pair = user;
    const balance b = balance_at(pair, e);
    const double square = (1.0 + e) * (1.0 + e), cube = square * (1.0 + e);
    const dea_electric electric = dea_film_electric(pair->film, pair->film->square * square);
    return (dea_path_place){b.load, b.slope, electric.first * square * square, 2.0 * cube * (electric.first + electric.second)};
}

/* Films abreast on their way to a root: of one film and skin, each with its own ratio, load and pressure. */
typedef struct walkers {
    const dea_film *film, *skin; /* as of a pair */
    double share[ABREAST], spring[ABREAST], turn[ABREAST]; /* spring: load of the pair [Pa] */
    double ratio[ABREAST], m[ABREAST];
    double end[ABREAST]; /* strain of the active film at which a region vanishes, or the energy of the material ends */
    double stiffness[ABREAST], curvature[ABREAST]; /* dN/de and d2N/de2 at rest */
    double strain[ABREAST], last[ABREAST];
    double load[ABREAST], slope[ABREAST], curve[ABREAST]; /* of N where it was evaluated last */
    double live[ABREAST];                                     /* 1: goes on, 0: has come to its end */
    double root[ABREAST];                                     /* 1: that is a root */
    double fold[ABREAST], clear[ABREAST];                   /* (1 + e) dN/de - 4 N there; 1: no fold can lie before */
} walkers;

/* N at rest. Without a skin or a passive film what they add is 0, and the end of the latter infinitely far. */
DEA_INLINE void rest(walkers *w)
{
    const dea_film *film = w->film;
    const double slope = film->prestretch * film->slope, curvature = film->square * film->curvature;
    const double skin_slope = w->skin ? w->skin->slope : 0.0, skin_curvature = w->skin ? w->skin->curvature : 0.0;
    const double shrinks = film->shrinks, grows = w->skin ? fmin(film->grows, w->skin->grows) : film->grows;
    EACH(l)
    {
        const double ratio = w->ratio[l], spring = w->spring[l], share = w->share[l], passive = shrinks / ratio;
        w->stiffness[l] = slope * (1.0 + ratio) + share * skin_slope + spring;
        w->curvature[l] = curvature * (1.0 - ratio * ratio) + share * skin_curvature + 2.0 * spring * w->turn[l];
        w->end[l] = passive < grows ? passive : grows;
    }
}

/* The second-order answer: N = K e + c e^2/2 + ..., m (1 + e)^4 = m (1 + 4 e + 6 e^2 + ...). */
DEA_INLINE void set_off(walkers *w)
{
    EACH(l)
    {
        const double room = w->stiffness[l] - 4.0 * w->m[l];
        const double bend = 0.5 * w->curvature[l] - 6.0 * w->m[l];
        const double linear = w->m[l] / room;
        w->strain[l] = w->last[l] = linear / (1.0 + bend * linear / room);
        w->root[l] = w->load[l] = w->slope[l] = w->curve[l] = 0.0;
        w->live[l] = ((w->strain[l] >= 0.0) & (w->strain[l] < w->end[l])) ? 1.0 : 0.0;
    }
}

static void add_skin(const walkers *w, const double *strains, const dea_changes *changes)
{
    double value[ABREAST], slope[ABREAST], curve[ABREAST];
    dea_film_changes(w->skin, ABREAST, strains, &(dea_changes){value, slope, curve});
    EACH(l)
    {
        changes->value[l] += w->share[l] * value[l];
        changes->slope[l] += w->share[l] * slope[l];
        changes->curve[l] += w->share[l] * curve[l];
    }
}

/* One step of Halley's iteration. Convergence is cubic, so the step after the next one is foreseen as step^4/last^3, and where that
 * is below rounding the present step was the last one needed. */
DEA_INLINE void step_on(walkers *w)
{
    double strains[2 * ABREAST], value[2 * ABREAST], slope[2 * ABREAST], curve[2 * ABREAST];
    const dea_changes changes = {value, slope, curve};
    EACH(l)
    {
        strains[l] = w->strain[l];
        strains[ABREAST + l] = -w->ratio[l] * w->strain[l];
    }
    dea_film_changes(w->film, 2 * ABREAST, strains, &changes);
    if (w->skin) {
        add_skin(w, strains, &changes);
    }
    EACH(l)
    {
        const double e = w->strain[l], last = w->last[l], ratio = w->ratio[l], m = w->m[l];
        const double square = (1.0 + e) * (1.0 + e);
        const double spring = w->spring[l], turn = w->turn[l];
        const double load = value[l] - value[ABREAST + l] + spring * e * (1.0 + turn * e);
        const double first = slope[l] + ratio * slope[ABREAST + l] + spring * (1.0 + 2.0 * turn * e);
        const double second = curve[l] - ratio * ratio * curve[ABREAST + l] + 2.0 * spring * turn;
        const double residual = load - m * square * square;
        const double steep = first - 4.0 * m * square * (1.0 + e);
        const double bent = second - 12.0 * m * square;
        const double step = -2.0 * residual * steep / (2.0 * steep * steep - residual * bent);
        const double next = e + step, cube = last * last * last;
        const bool live = w->live[l] > 0.0, inside = (next >= 0.0) & (next < w->end[l]);
        const bool is_root = fabs(residual) <= 2.0 * fabs(steep * step); /* at a fold steps are short, too, but the residual is not */
        const bool small = (fabs(step) <= 1e-3 * fabs(next)) & (step * step * step * step <= 1e-16 * fabs(next * cube));
        const bool done = is_root & small;
        w->load[l] = live ? load : w->load[l];
        w->slope[l] = live ? first : w->slope[l];
        w->curve[l] = live ? second : w->curve[l];
        w->strain[l] = live ? next : e;
        w->last[l] = live ? step : last;
        w->root[l] = (live & done & inside) ? 1.0 : w->root[l];
        w->live[l] = (live & inside & !done) ? 1.0 : 0.0;
    }
}

DEA_INLINE bool any_lives(const walkers *w)
{
    long long live = 0; /* as wide as the numbers, so that it goes in vectors */
    EACH(l)
    {
        live |= w->live[l] > 0.0;
    }
    return live != 0;
}

/* Notes where `fold` keeps far from zero all the way from rest to the root, next to which N was evaluated: over so short a way two
 * values and two tangents of it that stay within a factor of two leave no room for a fold between. Spares the samples of
 * dea_path_grows(). */
DEA_INLINE void look_for_folds(walkers *w)
{
    EACH(l)
    {
        const double e = w->strain[l], ratio = w->ratio[l], stiffness = w->stiffness[l];
        const double fold = (1.0 + e) * w->slope[l] - 4.0 * w->load[l];
        const double slope_at_rest = w->curvature[l] - 3.0 * stiffness;
        const double slope_at_end = (1.0 + e) * w->curve[l] - 3.0 * w->slope[l];
        const double tangent_at_rest = stiffness + slope_at_rest * e;
        const double tangent_at_end = fold - slope_at_end * e;
        const double half = 0.5 * (stiffness > fold ? stiffness : fold);
        const bool far = (tangent_at_rest > half) & (tangent_at_end > half) & (stiffness > half) & (fold > half);
        w->fold[l] = fold;
        w->clear[l] = (far & (e * (1.0 + ratio) <= 0.15)) ? 1.0 : 0.0;
    }
}

DEA_INLINE void settle_body(walkers *w)
{
    rest(w);
    set_off(w);
    for (int i = 0; i < 12 && any_lives(w); i++) {
        step_on(w);
    }
    look_for_folds(w);
}

DEA_LANES_DISPATCH(settle, settle_body, (walkers *w), (w))

/* Strain of the disc per strain of the active film. */
static double turn_of(const dea_point *point, double ratio)
{
    return point->kind == DEA_DOT ? 1.0 : -ratio;
}

/* The spring at the edge, as the pair takes it [Pa]. */
static double spring_of(const dea_point *point, double turn)
{
    return point->load != 0.0 ? point->load * dea_point_divide(point) / dea_point_cross_section(point) * fabs(turn) : 0.0;
}

static film_pair pair_of(const dea_point *point, double ratio)
{
    const double turn = turn_of(point, ratio);
    return (film_pair){.film = &point->film,
                       .ratio = ratio,
                       .skin = point->skin_share > 0.0 ? &point->skin : NULL,
                       .share = point->skin_share * point->film.square,
                       .load = spring_of(point, turn),
                       .turn = turn};
}

/* The first root from rest of a lane whose own may not be that: where U grows all the way to it, it is. False where there is none. */
static bool trace(const dea_point *point, const walkers *w, size_t l, double *strain)
{
    const film_pair pair = pair_of(point, w->ratio[l]);
    const dea_path path = {place_at, &pair, w->stiffness[l], w->end[l], 1.0 / (1.0 + w->ratio[l]), 0.0};
    if (!(w->stiffness[l] > 0.0) || !isfinite(w->m[l])) {
        return false;
    }
    const bool constant = point->film.electrostriction == 0.0;
    const bool first = constant && w->root[l] > 0.0 && w->fold[l] > 0.0 && (w->clear[l] > 0.0 || dea_path_grows(&path, *strain));
    return first || dea_path_trace(&path, w->m[l], strain);
}

/* Strains of up to ABREAST films of as many points, each with its own ratio, under the pressures m; false where there is none. */
static void find(const dea_point *points, size_t count, const double *ratio, const double *m, double *strain, bool *found)
{
    walkers w; /* set whole here and as they set off: to clear it first would cost a tenth of the way */
    w.film = &points[0].film;
    w.skin = points[0].skin_share > 0.0 ? &points[0].skin : NULL;
    EACH(l)
    {
        const size_t from = l < count ? l : 0; /* an idle lane does what the first does */
        w.ratio[l] = ratio[from];
        w.m[l] = m[from];
        w.share[l] = points[from].skin_share * points[0].film.square;
        w.turn[l] = turn_of(&points[from], ratio[from]);
        w.spring[l] = spring_of(&points[from], w.turn[l]);
    }
    settle(&w);
    const bool constant = points[0].film.electrostriction == 0.0; /* as the films abreast are taken */
    for (size_t l = 0; l < count; l++) {
        strain[l] = m[l] == 0.0 ? 0.0 : w.strain[l];
        const bool clear = (w.root[l] > 0.0) & (w.fold[l] > 0.0) & (w.clear[l] > 0.0) & (w.stiffness[l] > 0.0);
        found[l] = m[l] == 0.0 || (clear && constant) || trace(&points[l], &w, l, &strain[l]);
    }
}

/* Points from the first on that can go abreast: each may have a skin of its own, which then goes alone. */
static size_t abreast(const dea_point *points, size_t count)
{
    size_t some = 1;
    while (some < count && some < ABREAST && points[0].skin_share == 0.0 && points[some].skin_share == 0.0) {
        some++;
    }
    return some;
}

void dea_film_balances_solve(const dea_point *points, size_t count, double (*ratio)(const dea_point *point),
                             void (*fill)(const dea_point *point, double pressure, double strain, dea_row *row), dea_row *rows)
{
    for (size_t from = 0, some; from < count; from += some) {
        some = abreast(points + from, count - from);
        double ratios[ABREAST], pressures[ABREAST], strains[ABREAST];
        bool found[ABREAST];
        for (size_t l = 0; l < some; l++) {
            ratios[l] = ratio(&points[from + l]);
            pressures[l] = dea_point_pressure(&points[from + l]);
        }
        find(&points[from], some, ratios, pressures, strains, found);
        for (size_t l = 0; l < some; l++) {
            if (found[l]) {
                fill(&points[from + l], pressures[l], strains[l], &rows[from + l]);
            } else {
                dea_row_refuse(&rows[from + l], DEA_STATE_PULL_IN);
            }
        }
    }
}
