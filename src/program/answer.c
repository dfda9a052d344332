#include "program/answer.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "film/point.h"
#include "needs/nearness.h"
#include "network/swing.h"
#include "program/omissions.h"
#include "scene/line.h"
#include "study/study.h"
#include "support/number.h"

dea_answer dea_answer_begin(void)
{
    const dea_spot none = {.value = (double)NAN};
    dea_answer answer = {.strain = none, .displacement = none, .field = none, .charge = none, .capacitance = (double)NAN};
    for (size_t i = 0; i < DEA_STATE_COUNT; i++) {
        answer.firsts[i] = none;
    }
    return answer;
}

double dea_answer_column(const dea_layout *layout, const void *row, const char *name)
{
    for (size_t i = 0; i < layout->column_count; i++) {
        if (strcmp(layout->columns[i].name, name) == 0) {
            return dea_layout_number(row, layout->columns[i].offset);
        }
    }
    return (double)NAN;
}

/* Keeps the larger one; of two rows one that is `ok`, where @p sound is asked for. */
static bool keep_larger(dea_spot *spot, dea_spot here, bool sound)
{
    const bool was = spot->state == DEA_STATE_OK, is = here.state == DEA_STATE_OK;
    const bool better = sound && was != is ? is : fabs(here.value) > fabs(spot->value);
    const bool takes = isfinite(here.value) && (isnan(spot->value) || better);
    if (takes) {
        *spot = here;
    }
    return takes;
}

static void take_row(dea_answer *answer, const dea_layout *layout, dea_spot here, const void *row)
{
    answer->states[here.state]++;
    if (isnan(answer->firsts[here.state].value)) {
        here.value = 0.0;
        answer->firsts[here.state] = here;
    }
    here.value = dea_answer_column(layout, row, "strain");
    keep_larger(&answer->strain, here, true);
    here.value = dea_answer_column(layout, row, "displacement_m");
    keep_larger(&answer->displacement, here, true);
    here.value = dea_answer_column(layout, row, "field_V_per_m");
    keep_larger(&answer->field, here, false);
    here.value = dea_answer_column(layout, row, "charge_C");
    if (keep_larger(&answer->charge, here, false)) {
        answer->capacitance = dea_answer_column(layout, row, "capacitance_F");
    }
}

void dea_answer_take(dea_answer *answer, const dea_layout *layout, size_t number, const void *point)
{
    for (size_t i = 0; i < layout->rows; i++) {
        const void *row = (const char *)point + i * layout->row_size;
        take_row(answer, layout, (dea_spot){.number = number, .row = i, .state = dea_layout_state(layout, row)}, row);
    }
}

/* Digits that a relative error leaves. */
static int digits_of(double error)
{
    return error < 5e-5 ? 4 : error < 5e-4 ? 3 : 2;
}

const char *dea_answer_place(const dea_scene *scene, size_t number, const char *before)
{
    for (size_t i = 0; i < scene->axis_count; i++) {
        const dea_axis *axis = &scene->axes[i];
        const char *dot = strrchr(axis->key, '.');
        const char *whose = strncmp(axis->key, "antagonist.", 11) == 0 ? "antagonist " : "";
        fprintf(stderr, "%s%s%s = %s", before, whose, dot ? dot + 1 : axis->key,
                DEA_QUANTITY(axis->values[dea_axis_index(scene, i, number)], axis->unit, 6));
        before = ", ";
    }
    return before;
}

/* " at coverage = 0.5, voltage = 4.5 kV, t = 2 s", nothing where there is one row only. */
static void print_place(const dea_scene *scene, const dea_spot *spot)
{
    const char *before = dea_answer_place(scene, spot->number, " at ");
    const char *sign = dea_study_of(scene)->sign;
    if (sign) {
        fprintf(stderr, "%s%s = %s", before, sign,
                DEA_QUANTITY(dea_layout_place(scene, spot->row), dea_layout_of(scene).columns[0].unit, 6));
    }
}

static void print_state(const dea_spot *spot)
{
    if (spot->state != DEA_STATE_OK) {
        fprintf(stderr, " (%s)", dea_state_name(spot->state));
    }
}

static bool same_place(const dea_spot *a, const dea_spot *b)
{
    return a->number == b->number && a->row == b->row;
}

/* Do rows tell how far the edge moves? */
static bool tells_stroke(const dea_scene *scene)
{
    const dea_layout layout = dea_layout_of(scene);
    bool told = false;
    for (size_t i = 0; i < layout.column_count; i++) {
        told = told || strcmp(layout.columns[i].name, "strain") == 0;
    }
    return told;
}

static void print_stroke(const dea_answer *answer, const dea_scene *scene)
{
    char text[DEA_NUMBER_LENGTH];
    const int digits = digits_of(scene->accuracy);
    if (isnan(answer->displacement.value)) {
        fputs("no row with numbers\n", stderr);
        return;
    }
    const bool together = same_place(&answer->strain, &answer->displacement);
    fprintf(stderr, "largest strain %s %%", dea_number_text(text, 100.0 * answer->strain.value, digits));
    if (!together) {
        print_place(scene, &answer->strain);
        print_state(&answer->strain);
        fputs(", largest", stderr);
    } else {
        fputs(" and", stderr);
    }
    fprintf(stderr, " displacement %s", DEA_QUANTITY(answer->displacement.value, "m", digits));
    print_place(scene, &answer->displacement);
    print_state(&answer->displacement);
    fputc('\n', stderr);
}

static void print_field(const dea_answer *answer, const dea_scene *scene)
{
    if (isnan(answer->field.value)) {
        return;
    }
    const int digits = digits_of(10.0 * scene->accuracy);
    const double strength = dea_scene_of_run(scene, answer->field.number).material.breakdown;
    fprintf(stderr, "  true field at most %s", DEA_QUANTITY(answer->field.value, "V/m", digits));
    print_place(scene, &answer->field);
    if (isfinite(strength)) {
        fprintf(stderr, ", %.*g %% of the strength %s", digits, 100.0 * answer->field.value / strength, DEA_QUANTITY(strength, "V/m", 6));
    } else {
        fputs("; strength unknown", stderr);
    }
    fputc('\n', stderr);
}

/* What the film takes where it takes most. */
static void print_charge(const dea_answer *answer, const dea_scene *scene)
{
    const int digits = digits_of(10.0 * scene->accuracy);
    if (isnan(answer->charge.value)) {
        return;
    }
    fprintf(stderr, "  charge at most %s", DEA_QUANTITY(answer->charge.value, "C", digits));
    print_place(scene, &answer->charge);
    if (!isnan(answer->capacitance)) {
        const int fewer = digits_of(30.0 * scene->accuracy); /* two columns, one of them squared */
        fprintf(stderr, ", capacitance %s and energy %s there", DEA_QUANTITY(answer->capacitance, "F", fewer),
                DEA_QUANTITY(0.5 * answer->charge.value * answer->charge.value / answer->capacitance, "J", fewer));
    }
    fputc('\n', stderr);
}

/* Of the film at rest and 0 V, in the place of the largest displacement; a transient tells of its resonance itself. */
static void print_rest(const dea_answer *answer, const dea_scene *scene, const dea_model *model)
{
    dea_point point;
    dea_scene here = dea_scene_of_run(scene, answer->displacement.number);
    here.drive.voltage = 0.0;
    dea_film_prepare(&here, &point.film);
    dea_point_place(&here, &point);
    if (!dea_point_valid(&point)) {
        return;
    }
    const double capacitance = dea_point_capacitance(&point);
    const dea_swing swing = dea_swing_free(&here, model);
    fputs("  ", stderr);
    if (scene->axis_count > 0 && isnan(answer->displacement.value)) { /* no line before has named a place */
        dea_answer_place(scene, answer->displacement.number, "at ");
        fputs(", ", stderr);
    } else if (scene->axis_count > 0) {
        fputs("there, ", stderr);
    }
    fprintf(stderr, "at rest and 0 V: capacitance %s", DEA_QUANTITY(capacitance, "F", 4));
    const double series = dea_series_resistance(&here);
    if (!isnan(series)) {
        fprintf(stderr, ", R_s C %s", DEA_QUANTITY(series * capacitance, "s", 4));
    }
    if (isfinite(swing.frequency) && !dea_study_of(scene)->timed) {
        fprintf(stderr, ", first resonance %s", DEA_QUANTITY(swing.frequency, "Hz", 4));
    }
    fputc('\n', stderr);
}

static void print_states(const dea_answer *answer, const dea_scene *scene)
{
    for (size_t i = DEA_STATE_OK + 1; i < DEA_STATE_COUNT; i++) {
        if (answer->states[i] > 0) {
            fprintf(stderr, "  %s in %zu row%s, first", dea_state_name((dea_state)i), answer->states[i],
                    answer->states[i] == 1 ? "" : "s");
            print_place(scene, &answer->firsts[i]);
            fputc('\n', stderr);
        }
    }
}

/* A deviation in percent, its sign told: two digits, or what is left below a hundredth of a percent; or no digit behind the point. */
static const char *deviation_text(char *text, double deviation, bool whole)
{
    char number[DEA_NUMBER_LENGTH];
    const double percent = whole ? round(100.0 * deviation) : 100.0 * deviation;
    const bool tiny = fabs(percent) < 1e-2;
    snprintf(text, DEA_NUMBER_LENGTH, "%s%s %%", tiny || percent < 0.0 ? "" : "+",
             tiny ? (whole ? "0" : "0.00") : dea_number_text(number, percent, whole ? 4 : 2));
    return text;
}

/* " WHAT off by LOW to HIGH", one number where both print alike. */
static void print_deviation(const char *what, double least, double largest, bool whole)
{
    char low[DEA_NUMBER_LENGTH], high[DEA_NUMBER_LENGTH];
    fprintf(stderr, " %s off by %s", what, deviation_text(low, least, whole));
    if (strcmp(low, deviation_text(high, largest, whole)) != 0) {
        fprintf(stderr, " to %s", high);
    }
}

/* How far the model is from the membrane, at rest under the drive of the study. */
static void print_nearness(const dea_scene *scene, const dea_model *model)
{
    dea_nearness near;
    if (model->membrane || dea_nearness_measure(scene, model, &near, NULL) != DEA_OK ||
        (near.compared + near.unlike == 0 && isnan(near.slow))) {
        return;
    }
    fprintf(stderr, "  against the membrane (field)%s:", dea_study_of(scene)->at ? dea_study_of(scene)->at : "");
    if (near.compared > 0) {
        print_deviation("strain", near.low, near.high, false);
    }
    if (near.unlike > 0) {
        fprintf(stderr, "%s pull-in of one alone at %zu", near.compared > 0 ? "," : "", near.unlike);
    }
    if (!isnan(near.slow)) {
        fputs(near.compared + near.unlike > 0 ? "," : "", stderr);
        print_deviation("first resonance", near.slow, near.fast, false);
    }
    if (!isnan(near.least_peak)) {
        fputc(',', stderr);
        print_deviation("first peak", near.least_peak, near.largest_peak, true);
    }
    if (!near.whole) {
        fprintf(stderr, ", %zu of %zu points compared", near.compared + near.unlike, dea_scene_point_count(scene));
    }
    fputc('\n', stderr);
}

void dea_answer_print(const dea_answer *answer, const dea_scene *scene, size_t model, bool truth)
{
    if (!tells_stroke(scene)) {
        print_rest(answer, scene, scene->models[model]);
        if (truth) {
            print_nearness(scene, scene->models[model]);
        }
        if (dea_study_of(scene)->sign) {
            print_states(answer, scene);
        }
        return;
    }
    if (scene->model_count > 1) {
        fprintf(stderr, "%s: ", scene->models[model]->name);
    }
    print_stroke(answer, scene);
    if (truth) {
        print_nearness(scene, scene->models[model]);
    }
    print_rest(answer, scene, scene->models[model]);
    print_field(answer, scene);
    print_charge(answer, scene);
    print_states(answer, scene);
}
