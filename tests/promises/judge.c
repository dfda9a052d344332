/* Runs engines and holds their rows against the truth, column by column as `deaspice check` compares them. */
#include <float.h>
#include <math.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>

#include "scene/line.h"
#include "promises.h"
#include "radial.h"

enum { COLUMNS = 9 };

static const double negligible = 1e-9;  /* share of a column's largest value below which numbers count as that */
static const double least_swing = 0.01; /* share of what the largest voltage does at rest that a peak counts as */

typedef enum measure { OVER_ITSELF, OVER_PEAK, OVER_RADIAN } measure;

typedef struct column {
    dea_study_kind study;
    size_t offset;
    measure how;
    const char *name;
} column;

static const column columns[] = {
    {DEA_STUDY_SWEEP, offsetof(dea_row, strain), OVER_ITSELF, "strain"},
    {DEA_STUDY_SWEEP, offsetof(dea_row, displacement), OVER_ITSELF, "displacement"},
    {DEA_STUDY_SWEEP, offsetof(dea_row, force), OVER_ITSELF, "force"},
    {DEA_STUDY_SWEEP, offsetof(dea_row, field), OVER_ITSELF, "field"},
    {DEA_STUDY_SWEEP, offsetof(dea_row, capacitance), OVER_ITSELF, "capacitance"},
    {DEA_STUDY_SWEEP, offsetof(dea_row, charge), OVER_ITSELF, "charge"},
    {DEA_STUDY_SWEEP, offsetof(dea_row, area_strain), OVER_ITSELF, "area_strain"},
    {DEA_STUDY_SWEEP, offsetof(dea_row, focal_length), OVER_ITSELF, "focal_length"},
    {DEA_STUDY_SWEEP, offsetof(dea_row, energy), OVER_ITSELF, "energy"},
    {DEA_STUDY_TRANSIENT, offsetof(dea_sample, displacement), OVER_PEAK, "displacement"},
    {DEA_STUDY_TRANSIENT, offsetof(dea_sample, strain), OVER_PEAK, "strain"},
    {DEA_STUDY_AC, offsetof(dea_response, displacement), OVER_ITSELF, "displacement"},
    {DEA_STUDY_AC, offsetof(dea_response, displacement_phase), OVER_RADIAN, "phase"},
    {DEA_STUDY_AC, offsetof(dea_response, impedance), OVER_ITSELF, "impedance"},
    {DEA_STUDY_AC, offsetof(dea_response, impedance_phase), OVER_RADIAN, "impedance_phase"},
};

/* Processor time of this process and of the workers that it has waited for [s]. */
static double spent(void)
{
    const int whom[] = {RUSAGE_SELF, RUSAGE_CHILDREN};
    double sum = 0.0;
    for (int i = 0; i < 2; i++) {
        struct rusage u;
        getrusage(whom[i], &u);
        sum += (double)(u.ru_utime.tv_sec + u.ru_stime.tv_sec) + 1e-6 * (double)(u.ru_utime.tv_usec + u.ru_stime.tv_usec);
    }
    return sum;
}

/* Columns of the study that this scene has. */
static size_t columns_of(const judged *j, column chosen[COLUMNS])
{
    size_t count = 0;
    for (size_t i = 0; i < sizeof columns / sizeof *columns; i++) {
        for (size_t k = 0; columns[i].study == j->scene.study && k < j->layout.column_count; k++) {
            if (j->layout.columns[k].offset == columns[i].offset) {
                chosen[count++] = columns[i];
            }
        }
    }
    return count;
}

static const char *row_of(const judged *j, const void *points, size_t point, size_t row)
{
    return (const char *)points + point * j->layout.point_size + row * j->layout.row_size;
}

/* ---- the truth */

static dea_scene scene_at(const judged *j, size_t point)
{
    dea_scene here = j->scene;
    dea_axes_place(&here, point);
    here.accuracy = j->tightest;
    return here;
}

static void find_truth(judged *j, size_t point)
{
    const dea_scene here = scene_at(j, point);
    char *rows = (char *)j->truth + point * j->layout.point_size;
    if (here.study == DEA_STUDY_SWEEP) {
        const true_row truth = still_truth(&here, here.models[0], 1.0);
        memcpy(rows, &truth.row, sizeof truth.row);
        j->errors[point] = truth.error;
    } else if (here.study == DEA_STUDY_AC) {
        j->errors[point] = response_truth(&here, here.models[0], (dea_response *)rows);
    } else {
        j->runs[point] = moving_truth(&here, here.models[0], 1.0);
        memcpy(rows, j->runs[point].samples, j->runs[point].count * sizeof(dea_sample));
        j->errors[point] = j->runs[point].error;
        j->why = j->runs[point].why;
    }
}

void judge_find(judged *j)
{
    for (size_t i = 0; i < j->points && !j->found; i++) {
        find_truth(j, i);
    }
    j->found = true;
}

bool judge_open(judged *j, const char *text, size_t number)
{
    dea_error error = {0};
    *j = (judged){.number = number, .tightest = 1e-12};
    if (dea_scene_parse(text, strlen(text), "promise", ".", NULL, 0, NULL, &j->scene, &error) != DEA_OK) {
        fprintf(stderr, "scene %zu: %s\n", number, error.message);
        return false;
    }
    j->layout = dea_layout_of(&j->scene);
    j->points = dea_scene_point_count(&j->scene);
    j->truth = calloc(j->points, j->layout.point_size);
    j->errors = calloc(j->points, sizeof *j->errors);
    j->runs = calloc(j->points, sizeof *j->runs);
    return true;
}

void judge_close(judged *j)
{
    for (size_t i = 0; i < j->points; i++) {
        true_run_free(&j->runs[i]);
    }
    free(j->truth);
    free(j->errors);
    free(j->runs);
    dea_scene_free(&j->scene);
}

/* ---- states */

/* What the state of a row is where the voltage, or the row itself, is off by the accuracy. */
static bool near_limit(const judged *j, size_t point, size_t row, dea_state state, double accuracy)
{
    const dea_scene here = scene_at(j, point);
    for (int side = -1; side <= 1; side += 2) {
        const double factor = 1.0 + 2.0 * side * accuracy;
        if (here.study == DEA_STUDY_SWEEP) {
            if (still_truth(&here, here.models[0], factor).row.state == state) {
                return true;
            }
        } else if (here.study == DEA_STUDY_TRANSIENT) {
            true_run other = moving_truth(&here, here.models[0], factor);
            const bool same = other.samples[row].state == state;
            true_run_free(&other);
            if (same) {
                return true;
            }
        } else {
            dea_scene moved = here;
            moved.ac.bias *= factor;
            dea_response *rows = calloc(j->layout.rows, sizeof *rows);
            (void)response_truth(&moved, here.models[0], rows);
            const bool same = rows[row].state == state;
            free(rows);
            if (same) {
                return true;
            }
        }
    }
    return false;
}

/* Errors of stretches and stresses along the radius over that of the edge, relative to the accuracy. */
static const double along_radius = 20.0;

/* A membrane's state follows from its stretches all along the radius. */
static bool near_margin(const judged *j, size_t point, size_t row, dea_state state, double u_peak, double accuracy)
{
    const radial_margins *margins = &j->runs[point].margins[row];
    dea_sample sample;
    memcpy(&sample, row_of(j, j->truth, point, row), sizeof sample);
    const bool breaks = state == DEA_STATE_BREAKDOWN || sample.state == DEA_STATE_BREAKDOWN;
    const double strain = fmin(1.0, sample.displacement != 0.0 ? u_peak * fabs(sample.strain / sample.displacement) : 1.0);
    return breaks ? margins->strength <= along_radius * accuracy : margins->tension <= along_radius * accuracy * strain;
}

/* A sample's state follows from displacement and film voltage, each good to the accuracy of its peak. */
static bool near_sample(const judged *j, size_t point, size_t row, dea_state state, double u_peak, double accuracy)
{
    const dea_scene here = scene_at(j, point);
    const true_film film = film_of(&here, here.models[0]);
    dea_sample sample;
    memcpy(&sample, row_of(j, j->truth, point, row), sizeof sample);
    for (int k = 0; k < 4 && sample.state != DEA_STATE_PULL_IN; k++) {
        const long double u = sample.displacement + (k & 1 ? 1.0 : -1.0) * accuracy * u_peak;
        const long double volts = sample.voltage * (1.0 + (k & 2 ? 1.0 : -1.0) * 2.0 * accuracy);
        if (film_row(&film, u, volts).state == state) {
            return true;
        }
    }
    return false;
}

/* ---- comparison */

typedef struct found {
    const char *column;
    size_t point, row;
    double error; /* over the accuracy or not */
    bool state;   /* a state is wrong */
    dea_state got, wanted;
    size_t failed; /* rows */
} found;

static double gap(measure how, double a, double b, double scale, double peak)
{
    if (isnan(a) && isnan(b)) {
        return 0.0;
    }
    const double angle = 3.14159265358979323846 / 180.0;
    const double off = how == OVER_RADIAN ? fabs(remainder(a - b, 360.0)) * angle : fabs(a - b);
    const double over = how == OVER_RADIAN ? 1.0
                        : how == OVER_PEAK ? fmax(peak, negligible * scale)
                                           : fmax(fabs(b), negligible * scale);
    return !(off > 0.0) && isfinite(off) ? 0.0 : isfinite(off) ? off / over : (double)INFINITY;
}

/* A hundredth of what the largest voltage would do at rest. */
static void set_least(const judged *j, size_t point, const column *chosen, size_t count, double *least)
{
    const double u = least_swing * j->runs[point].still;
    const true_film film = film_of(&j->scene, j->scene.models[0]);
    const dea_sample swing = {.displacement = u, .strain = u / (double)film.divide};
    for (size_t c = 0; c < count; c++) {
        least[c] = number_at(&swing, chosen[c].offset);
    }
}

static double peak_of(const judged *j, size_t point, size_t offset)
{
    double peak = 0.0;
    for (size_t i = 0; i < j->layout.rows; i++) {
        peak = fmax(peak, fabs(number_at(row_of(j, j->truth, point, i), offset)));
    }
    return peak;
}

static bool states_agree(const judged *j, size_t point, size_t row, dea_state got, dea_state wanted, double u_peak,
                         double accuracy)
{
    if (got == wanted) {
        return true;
    }
    const bool sampled = j->scene.study == DEA_STUDY_TRANSIENT;
    if (sampled && j->runs[point].margins && wanted != DEA_STATE_PULL_IN && got != DEA_STATE_PULL_IN) {
        return near_margin(j, point, row, got, u_peak, accuracy);
    }
    return (sampled && got != DEA_STATE_PULL_IN && wanted != DEA_STATE_PULL_IN &&
            near_sample(j, point, row, got, u_peak, accuracy)) ||
           near_limit(j, point, row, got, accuracy);
}

/* What four ulps of all frequencies do to a row of a response, d ln|u|/d ln w = 2 m w^2/|D|, next to a resonance of quality Q 2 Q: as
 * much as twice as many of the spring K in D = K - m w^2 + ..., which a double holds to some. */
static double rounding(const judged *j, size_t point, size_t row, const column *c, double scale, double peak)
{
    const double ulps = 4.0 * DBL_EPSILON, nudge = 1e-9;
    if (c->study != DEA_STUDY_AC) {
        return 0.0;
    }
    dea_scene moved = scene_at(j, point);
    moved.ac.from *= 1.0 + nudge;
    moved.ac.to *= 1.0 + nudge;
    dea_response *rows = calloc(j->layout.rows, sizeof *rows);
    (void)response_truth(&moved, moved.models[0], rows);
    const char *here = row_of(j, j->truth, point, row);
    const double change = gap(c->how, number_at((const char *)&rows[row], c->offset), number_at(here, c->offset), scale, peak);
    free(rows);
    return ulps / nudge * change;
}

static void take_column(found *worst, size_t point, column_error other)
{
    if (other.error > worst->error) {
        worst->error = other.error;
        worst->column = other.column;
        worst->point = point;
        worst->row = other.row;
    }
}

static found compare(const judged *j, const void *points, double accuracy)
{
    column chosen[COLUMNS];
    double scale[COLUMNS] = {0.0}, least[COLUMNS] = {0.0};
    const size_t count = columns_of(j, chosen);
    found worst = {.column = ""};
    if (j->scene.study == DEA_STUDY_TRANSIENT) {
        set_least(j, 0, chosen, count, least); /* a transient is drawn with one point */
    }
    for (size_t c = 0; c < count; c++) {
        for (size_t p = 0; p < j->points; p++) {
            scale[c] = fmax(scale[c], fmax(least[c], peak_of(j, p, chosen[c].offset)));
        }
    }
    for (size_t p = 0; p < j->points; p++) {
        double peaks[COLUMNS];
        for (size_t c = 0; c < count; c++) {
            peaks[c] = fmax(least[c], peak_of(j, p, chosen[c].offset));
        }
        for (size_t i = 0; i < j->layout.rows; i++) {
            const char *row = row_of(j, points, p, i), *wanted = row_of(j, j->truth, p, i);
            const dea_state got = dea_layout_state(&j->layout, row), right = dea_layout_state(&j->layout, wanted);
            if (got == DEA_STATE_FAILED) {
                worst.failed++;
                continue;
            }
            if (!worst.state && !states_agree(j, p, i, got, right, peaks[0], accuracy)) {
                worst.state = true;
                worst.got = got;
                worst.wanted = right;
                worst.point = p;
                worst.row = i;
            }
            if ((got == DEA_STATE_PULL_IN) != (right == DEA_STATE_PULL_IN)) {
                continue;
            }
            for (size_t c = 0; c < count; c++) {
                const size_t at = chosen[c].offset;
                const double error = gap(chosen[c].how, number_at(row, at), number_at(wanted, at), scale[c], peaks[c]);
                if (error > worst.error && !worst.state &&
                    !(error > accuracy && error <= rounding(j, p, i, &chosen[c], scale[c], peaks[c]))) {
                    worst.error = error;
                    worst.column = chosen[c].name;
                    worst.point = p;
                    worst.row = i;
                }
            }
        }
    }
    for (size_t p = 0; p < j->points && j->scene.study == DEA_STUDY_TRANSIENT && !worst.state; p++) {
        const dea_sample *rows = (const dea_sample *)(const void *)row_of(j, points, p, 0);
        take_column(&worst, p, columns_error(j, p, rows, accuracy));
        if (worst.failed == 0) {
            const dea_summary *summary = (const dea_summary *)(const void *)row_of(j, points, p, j->layout.rows);
            const size_t at = offsetof(dea_sample, displacement);
            take_column(&worst, p, means_error(j, p, summary, fmax(least[0], peak_of(j, p, at)), accuracy));
        }
    }
    return worst;
}

/* ---- engines */

typedef struct hearing {
    const judged *j;
    void *points;
    char said[REASON_LENGTH];
} hearing;

static dea_status hear_points(void *user, size_t first, const void *points, size_t count, dea_error *error)
{
    hearing *h = user;
    (void)error;
    memcpy((char *)h->points + first * h->j->layout.point_size, points, count * h->j->layout.point_size);
    return DEA_OK;
}

static void hear_line(void *user, const char *line)
{
    hearing *h = user;
    if (h->said[0] == '\0') {
        snprintf(h->said, sizeof h->said, "%s", line);
    }
}

/* Counts a reason, numbers taken out. */
static void count_reason(tally *t, const char *kind, const char *text)
{
    char plain[REASON_LENGTH];
    const char *colon = strstr(text, "): ");
    size_t used = (size_t)snprintf(plain, sizeof plain, "%s: ", kind);
    colon = colon ? colon + 3 : strstr(text, ": ") ? strstr(text, ": ") + 2 : text;
    for (const char *c = colon; *c && *c != '\n' && used + 2 < sizeof plain; c++) {
        const bool digit = strchr("0123456789", *c) != NULL;
        if (digit && used > 0 && plain[used - 1] == '#') {
            continue;
        }
        if (digit || (strchr(".e+-", *c) && plain[used - 1] == '#' && strchr("0123456789+-", c[1]) && c[1])) {
            if (plain[used - 1] != '#') {
                plain[used++] = '#';
            }
            continue;
        }
        plain[used++] = *c;
    }
    plain[used] = '\0';
    for (size_t i = 0; i < MOST_REASONS; i++) {
        if (t->reasons[i].count == 0) {
            snprintf(t->reasons[i].text, sizeof t->reasons[i].text, "%s", plain);
        }
        if (strcmp(t->reasons[i].text, plain) == 0) {
            t->reasons[i].count++;
            return;
        }
    }
}

double best_accuracy(const dea_engine *engine, const dea_scene *scene)
{
    static const double tried[] = {1e-12, 1e-9, 1e-6};
    dea_scene here = *scene;
    for (size_t i = 0; i < sizeof tried / sizeof *tried; i++) {
        here.accuracy = tried[i];
        const char *why = dea_engine_refuses(engine, &here, here.models[0]);
        if (!why || !strstr(why, "wants more")) {
            return tried[i];
        }
    }
    return 1e-6;
}

static bool tell(const judged *j, const dea_engine *engine, double accuracy, const found *f, char *text, size_t size)
{
    const dea_scene here = scene_at(j, f->point);
    int used =
        snprintf(text, size, "scene %zu, %s, %s, accuracy %.0e: ", j->number, engine->name, here.models[0]->name, accuracy);
    if (f->state) {
        snprintf(text + used, size - (size_t)used, "state of point %zu, row %zu is %s, not %s", f->point, f->row,
                 dea_state_name(f->got), dea_state_name(f->wanted));
    } else {
        snprintf(text + used, size - (size_t)used, "%s of point %zu, row %zu is off by %.2g (truth good to %.1g)", f->column,
                 f->point, f->row, f->error, j->errors[f->point]);
    }
    return true;
}

/* Errors that summaries tell, of which the worst stays. */
static void take_told(const judged *j, const void *points, tally *t)
{
    for (size_t p = 0; p < j->points && j->scene.study == DEA_STUDY_TRANSIENT; p++) {
        const dea_sample *rows = (const dea_sample *)(const void *)row_of(j, points, p, 0);
        const column_error off = told_error(j, p, rows, (const dea_summary *)(const void *)row_of(j, points, p, j->layout.rows));
        t->told = off.error > t->told.error ? off : t->told;
    }
}

bool judge_engine(judged *j, const dea_engine *engine, double accuracy, tally *t, char *text, size_t size)
{
    dea_scene *scene = &j->scene;
    scene->accuracy = accuracy;
    t->scenes++;
    const char *why = dea_engine_refuses(engine, scene, scene->models[0]);
    if (why) {
        t->refused++;
        count_reason(t, "refused", why);
        return false;
    }
    judge_find(j);
    hearing h = {.j = j, .points = calloc(j->points, j->layout.point_size)};
    dea_error error = {0};
    const dea_run_options options = {.jobs = 1, .points = hear_points, .log = hear_line, .user = &h};
    const double from = spent();
    const dea_status status = dea_study_run(scene, engine, &options, &error);
    t->seconds += spent() - from;
    bool broken = false;
    found f = {0};
    if (status == DEA_OK) {
        f = compare(j, h.points, accuracy);
    }
    double truth = 0.0;
    for (size_t i = 0; i < j->points; i++) {
        truth = fmax(truth, j->errors[i]);
    }
    if (status != DEA_OK || f.failed > 0) {
        t->failed++;
        count_reason(t, h.said[0] || status != DEA_OK ? "failed" : "failed without a word",
                     status != DEA_OK ? error.message : h.said);
    }
    const bool all_failed = status != DEA_OK || f.failed == j->points * j->layout.rows;
    if (all_failed) {
        /* nothing delivered */
    } else if (j->why || !(truth <= 0.1 * accuracy)) {
        t->unjudged++;
        count_reason(t, "not judged", j->why ? j->why : "the truth is not good enough");
    } else {
        t->delivered++;
        broken = f.state || f.error > accuracy;
        t->broken += broken ? 1 : 0;
        t->worst = fmax(t->worst, f.error / accuracy);
        take_told(j, h.points, t);
        if (broken) {
            tell(j, engine, accuracy, &f, text, size);
        }
    }
    free(h.points);
    return broken;
}
