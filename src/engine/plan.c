#include "engine/plan.h"
#include "study/study.h"
#include "scene/line.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>

enum {
    MOST_ALONE = 64,  /* points that are isolated one by one in a run */
    MOST_LOSSES = 16, /* lost workers after which failing ranges are no longer halved */
    HOPELESS_LOSSES = 32,
    HOPELESS_STREAK = 16,
    MOST_LINES = 200,
    LINE_LENGTH = DEA_ERROR_LENGTH + 512
};

/* How often a range is tried before it is halved or given up, and whether a point given up for that reason is settled for good. A
 * journal keeps what is settled, and goes on with the rest. */
static const struct {
    size_t tries;
    bool final;
} faults[] = {[DEA_FAULT_REFUSED] = {1, true},
              [DEA_FAULT_OVERDUE] = {1, false},
              [DEA_FAULT_CRASHED] = {2, false},
              [DEA_FAULT_KILLED] = {4, false}};

dea_fault dea_fault_of(dea_status status)
{
    return status == DEA_ERROR_MEMORY || status == DEA_ERROR_IO ? DEA_FAULT_CRASHED : DEA_FAULT_REFUSED;
}

dea_status dea_plan_make(const dea_scene *scene, const dea_engine *engine, const dea_run_options *options, dea_plan *plan,
                         dea_error *error)
{
    *plan = (dea_plan){.scene = scene, .engine = engine, .options = options, .layout = dea_layout_of(scene)};
    const dea_status status = dea_cut_make(scene, engine, &plan->cut, error);
    if (status != DEA_OK)
        return status;
    plan->blocks = plan->cut.blocks;
    plan->points = plan->cut.total;
    for (size_t i = 0; options->wanted && i < plan->cut.blocks; i++) {
        if (!options->wanted(options->user, i)) {
            plan->blocks--;
            plan->points -= dea_cut_range(&plan->cut, i).count;
        }
    }
    return DEA_OK;
}

bool dea_plan_here(const dea_plan *plan)
{
    const bool apart = plan->options->apart && dea_study_of(plan->scene)->timed;
    return !plan->cut.isolated && !apart && (plan->options->jobs == 1 || plan->blocks == 1);
}

dea_span dea_plan_next(const dea_plan *plan, size_t *block)
{
    const dea_run_options *options = plan->options;
    while (options->wanted && *block + 1 < plan->cut.blocks && !options->wanted(options->user, *block))
        ++*block;
    const dea_range range = dea_cut_range(&plan->cut, (*block)++);
    return (dea_span){
        .model = plan->scene->models[range.model], .first = range.first, .place = range.place, .count = range.count};
}

dea_attempt dea_attempt_start(size_t count)
{
    return (dea_attempt){.count = count, .end = count};
}

bool dea_attempt_over(const dea_attempt *attempt)
{
    return attempt->next == attempt->count;
}

static void try_next_range(dea_attempt *attempt)
{
    attempt->tries = attempt->skip = 0;
    if (attempt->suspect > attempt->next) {
        size_t half = (attempt->suspect - attempt->next) / 2;
        attempt->end = attempt->next + (half > 0 ? half : 1);
    } else {
        attempt->suspect = 0;
        attempt->end = attempt->count;
    }
}

void dea_attempt_solved(dea_attempt *attempt, const dea_hands *hands, dea_damage *damage)
{
    damage->streak = 0;
    attempt->again = attempt->again || attempt->skip > 0; /* with the first engine the whole would cost a worker again */
    for (size_t i = 0; i < DEA_ENGINES; i++)
        attempt->hands.by[i] += hands->by[i];
    attempt->next = attempt->end;
    if (dea_attempt_over(attempt) && attempt->cut && attempt->lost == 0 && !attempt->again) {
        attempt->again = true; /* no point was to blame: an answer may depend on where its range begins */
        attempt->next = attempt->suspect = 0;
        attempt->hands = (dea_hands){0};
    }
    try_next_range(attempt);
}

static bool isolates(const dea_damage *damage)
{
    return damage->alone < MOST_ALONE && damage->losses < MOST_LOSSES;
}

bool dea_damage_hopeless(const dea_damage *damage)
{
    return damage->losses >= HOPELESS_LOSSES || damage->streak >= HOPELESS_STREAK;
}

void dea_plan_log(const dea_plan *plan, dea_damage *damage, const char *format, ...)
{
    if (!plan->options->log || damage->lines >= MOST_LINES)
        return;
    damage->lines++;
    char line[LINE_LENGTH];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(line, sizeof line, format, arguments);
    va_end(arguments);
    plan->options->log(plan->options->user, line);
    if (damage->lines == MOST_LINES)
        plan->options->log(plan->options->user, "more failures follow and are not listed");
}

void dea_plan_place(const dea_scene *scene, size_t point, char *text, size_t size)
{
    size_t used = 0;
    text[0] = '\0';
    for (size_t i = 0; i < scene->axis_count && used < size; i++) {
        const dea_axis *axis = &scene->axes[i];
        double value = axis->values[dea_axis_index(scene, i, point)];
        int length = snprintf(text + used, size - used, "%s%s=%.9g", i == 0 ? " (" : ", ", axis->column, value);
        used += length > 0 ? (size_t)length : 0;
    }
    if (scene->axis_count > 0 && used < size)
        snprintf(text + used, size - used, ")");
}

/* Who was asked first for the range that is tried now. */
static const char *asked_first(const dea_plan *plan, const dea_model *model, const dea_attempt *attempt)
{
    const dea_crew crew = dea_crew_of(plan->scene, plan->engine, model);
    return attempt->skip < crew.count ? crew.engines[attempt->skip]->name : "no engine";
}

/* Who is asked after that one, NULL: nobody. Of what an engine refuses, the whole crew was asked in one go. */
static const dea_engine *asked_next(const dea_plan *plan, const dea_span *span, const dea_attempt *attempt, dea_fault fault)
{
    const dea_crew crew = dea_crew_of(plan->scene, plan->engine, span->model);
    const bool fell = fault == DEA_FAULT_OVERDUE || fault == DEA_FAULT_CRASHED;
    return fell && attempt->skip + 1 < crew.count ? crew.engines[attempt->skip + 1] : NULL;
}

static void log_failure(const dea_plan *plan, const dea_span *span, const dea_attempt *attempt, const char *why,
                        dea_damage *damage)
{
    char place[256];
    size_t first = span->first + attempt->next;
    if (attempt->end - attempt->next == 1) {
        dea_plan_place(plan->scene, first, place, sizeof place);
        dea_plan_log(plan, damage, "%s, %s, point %zu%s: %s", asked_first(plan, span->model, attempt), span->model->name, first, place, why);
    } else {
        dea_plan_log(plan, damage, "%s, %s, points %zu to %zu, not isolated after too many failures: %s", asked_first(plan, span->model, attempt),
                     span->model->name, first, span->first + attempt->end - 1, why);
    }
}

void dea_attempt_remark(const dea_attempt *attempt, const dea_plan *plan, const dea_span *span, const char *why,
                        dea_damage *damage)
{
    if (why[0] == '\0')
        return;
    char place[256];
    const size_t first = span->first + attempt->next;
    if (!dea_study_of(plan->scene)->along) { /* of many points, it names its own */
        dea_plan_log(plan, damage, "%s, %s: %s", asked_first(plan, span->model, attempt), span->model->name, why);
        return;
    }
    dea_plan_place(plan->scene, first, place, sizeof place);
    dea_plan_log(plan, damage, "%s, %s, point %zu%s: %s", asked_first(plan, span->model, attempt), span->model->name, first, place, why);
}

static char *point_at(const dea_plan *plan, void *points, size_t index)
{
    return (char *)points + index * plan->layout.point_size;
}

/* Makes the rows of the range that is tried now failed, and goes on behind it. */
static void give_up(dea_attempt *attempt, const dea_plan *plan, void *points, bool final)
{
    attempt->lost += final ? 0 : attempt->end - attempt->next;
    for (; attempt->next < attempt->end; attempt->next++)
        dea_layout_fail(plan->scene, &plan->layout, point_at(plan, points, attempt->next));
    attempt->suspect = 0;
    try_next_range(attempt);
}

void dea_attempt_abandon(dea_attempt *attempt, const dea_plan *plan, void *points)
{
    attempt->end = attempt->count;
    give_up(attempt, plan, points, false);
}

double dea_plan_patience(const dea_plan *plan, const dea_model *model, size_t count)
{
    double patience = 0.0;
    const bool sweep = !dea_study_of(plan->scene)->along;
    const dea_crew crew = dea_crew_of(plan->scene, plan->engine, model);
    for (size_t i = 0; i < crew.count; i++)
        patience += sweep ? crew.engines[i]->patience : crew.engines[i]->run_patience;
    return patience * (double)count;
}

void dea_attempt_failed(dea_attempt *attempt, const dea_plan *plan, const dea_span *span, void *points, dea_fault fault,
                        const char *why, dea_damage *damage)
{
    const bool alone = attempt->end - attempt->next == 1;
    if (++attempt->tries < faults[fault].tries)
        return;
    if (!alone && isolates(damage)) {
        attempt->cut = attempt->cut || !faults[fault].final;
        attempt->suspect = attempt->end;
        try_next_range(attempt);
        return;
    }
    if (!isolates(damage))
        damage->streak++;
    if (alone)
        damage->alone++;
    const dea_engine *next = asked_next(plan, span, attempt, fault);
    if (next) {
        char both[LINE_LENGTH];
        snprintf(both, sizeof both, "%s; %s is asked instead", why, next->name);
        log_failure(plan, span, attempt, both, damage);
        attempt->skip++;
        attempt->tries = 0;
        return;
    }
    log_failure(plan, span, attempt, why, damage);
    give_up(attempt, plan, points, alone && faults[fault].final && attempt->skip == 0);
}

dea_status dea_plan_deliver(const dea_plan *plan, const dea_span *span, const void *points, const dea_attempt *attempt, size_t *done,
                            dea_error *error)
{
    const dea_run_options *options = plan->options;
    const dea_crew crew = dea_crew_of(plan->scene, plan->engine, span->model);
    if (attempt->lost > 0 && options->lost)
        options->lost(options->user, attempt->lost);
    for (size_t i = 1; i < crew.count && options->instead; i++) {
        if (attempt->hands.by[i] > 0)
            options->instead(options->user, crew.engines[i], attempt->hands.by[i]);
    }
    dea_status status = options->points(options->user, span->place, points, span->count, error);
    *done += span->count;
    if (status == DEA_OK && options->progress)
        options->progress(options->user, *done, plan->points);
    return status;
}

bool dea_plan_stopped(const dea_plan *plan)
{
    return plan->options->stop && plan->options->stop(plan->options->user);
}
