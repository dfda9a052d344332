/* Engine `direct`: the models' own equations, point after point; the closed forms of the linear network over time and frequency.
 */
#include <stddef.h>

#include "engine/direct/direct.h"
#include "engine/engines.h"
#include "film/point.h"
#include "scene/line.h"
#include "study/study.h"

typedef struct visit_state {
    const dea_model *model;
    dea_row *rows;
} visit_state;

static const char *refuses(const dea_scene *scene, const dea_model *model)
{
    if (!model->solve) {
        return "it has no equation of its own";
    }
    const char *why = dea_study_of(scene)->timed ? dea_direct_refuses_transient(scene, model) : NULL;
    if (why) {
        return why;
    }
    return scene->accuracy < 1e-12 ? "double precision ends at 1e-12, the scene wants more" : NULL;
}

static dea_status begin(void **session, dea_error *error)
{
    (void)error;
    *session = NULL;
    return DEA_OK;
}

static void solve_point(const dea_model *model, const dea_scene *scene, const dea_point *point, dea_row *row)
{
    if (dea_point_valid(point)) {
        dea_model_solve(model, point, scene->accuracy, row);
    } else {
        *row = dea_row_failed();
    }
}

static void solve_one_by_one(const visit_state *state, dea_scene *here, const dea_line *line)
{
    dea_point point;
    dea_film_prepare(here, &point.film);
    for (size_t i = 0; i < line->count; i++) {
        if (line->axis) {
            dea_axis_set(line->axis, here, line->axis->values[line->from + i]);
            if (line->axis->changes_film) {
                dea_film_prepare(here, &point.film);
            }
        }
        dea_point_place(here, &point);
        solve_point(state->model, here, &point, &state->rows[line->row + i * line->stride]);
    }
}

/* True where a line moves actuator or drive alone, without a skin whose share the thickness of the film would change. */
static bool shapes_alone(const dea_scene *scene, const dea_line *line)
{
    const size_t place = line->axis->offset, actuator = offsetof(dea_scene, actuator), drive = offsetof(dea_scene, drive);
    return !scene->electrode.law && ((place >= actuator && place < actuator + sizeof scene->actuator) ||
                                     (place >= drive && place < drive + sizeof scene->drive));
}

/* Valid points in front of others that are not, whose rows are made failed; number[i] is the place of point i on the line. */
static size_t gather(const visit_state *state, dea_scene *here, const dea_line *line, size_t from, size_t count, dea_point *points,
                     size_t *number)
{
    void (*const place)(const dea_scene *, dea_point *) = shapes_alone(here, line) ? dea_point_shape : dea_point_place;
    size_t gathered = 0;
    for (size_t i = from; i < from + count; i++) {
        dea_axis_set(line->axis, here, line->axis->values[line->from + i]);
        place(here, &points[gathered]);
        if (dea_point_valid(&points[gathered])) {
            number[gathered++] = i;
        } else {
            state->rows[line->row + i * line->stride] = dea_row_failed();
        }
    }
    return gathered;
}

/* Points that share a film go many at a time. */
static void solve_abreast(const visit_state *state, dea_scene *here, const dea_line *line)
{
    enum { MANY = 32 }; /* their points stay in the nearest cache */
    dea_point points[MANY];
    dea_row rows[MANY];
    size_t number[MANY];
    dea_film_prepare(here, &points[0].film);
    dea_point_place(here, &points[0]);
    for (size_t i = 1; i < MANY && i < line->count; i++) {
        points[i] = points[0];
    }
    for (size_t from = 0; from < line->count; from += MANY) {
        const size_t some = line->count - from < MANY ? line->count - from : MANY;
        const size_t count = gather(state, here, line, from, some, points, number);
        const bool in_place = line->stride == 1 && count == some;
        state->model->solve_many(points, count, here->accuracy, in_place ? &state->rows[line->row + from] : rows);
        for (size_t i = 0; i < count && !in_place; i++) {
            state->rows[line->row + number[i] * line->stride] = rows[i];
        }
    }
}

static dea_status solve_line(void *user, const dea_scene *scene, const dea_line *line, dea_error *error)
{
    (void)error;
    dea_scene here = *scene;
    const visit_state *state = user;
    const bool alone = !dea_scene_is_pulled(scene) && !dea_scene_edge(scene).bent && line->axis;
    const bool abreast = state->model->solve_many && alone && !line->axis->changes_film;
    (abreast ? solve_abreast : solve_one_by_one)(state, &here, line);
    return DEA_OK;
}

static dea_status sweep(void *session, const dea_scene *scene, const dea_model *model, size_t first, size_t count, dea_row *rows,
                        dea_error *error)
{
    (void)session;
    visit_state state = {model, rows};
    return dea_lines_visit(scene, first, count, solve_line, &state, error);
}

static void end(void *session)
{
    (void)session;
}

const dea_engine dea_engine_direct = {
    .name = "direct",
    .summary = "the models' own equations: closed forms and safeguarded roots",
    .isolated = false,
    .patience = 1.0,
    .run_patience = 60.0,
    .block = 16384,
    .costs = {[DEA_STUDY_SWEEP] = {2e-8, 2e-8, 4e-7, 1e-6},
              [DEA_STUDY_TRANSIENT] = {[DEA_FORM_LINEAR] = 3e-4},
              [DEA_STUDY_MODES] = {[DEA_FORM_LINEAR] = 1e-5, [DEA_FORM_HYPERELASTIC] = 1e-5, [DEA_FORM_MEMBRANE] = 1e-2},
              [DEA_STUDY_PROFILE] = {[DEA_FORM_HYPERELASTIC] = 1e-5, [DEA_FORM_MEMBRANE] = 5e-3},
              [DEA_STUDY_FORCE] = {[DEA_FORM_LINEAR] = 1e-6, [DEA_FORM_HYPERELASTIC] = 1e-5, [DEA_FORM_MEMBRANE] = 5e-3},
              [DEA_STUDY_AC] = {[DEA_FORM_LINEAR] = 1e-4, [DEA_FORM_HYPERELASTIC] = 1e-4, [DEA_FORM_MEMBRANE] = 3e-2}},
    .refuses = refuses,
    .begin = begin,
    .sweep = sweep,
    .transient = dea_direct_transient,
    .ac = dea_direct_ac,
    .solves = {[DEA_STUDY_MODES] = dea_direct_modes, [DEA_STUDY_PROFILE] = dea_direct_profile, [DEA_STUDY_FORCE] = dea_direct_force},
    .end = end,
};
