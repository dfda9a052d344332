/* How the result of one point lies in memory: what the kinds of study have in common. */
#include <math.h>
#include <string.h>

#include "deaspice/model.h"
#include "study/study.h"

void dea_layout_add(dea_layout *layout, dea_column column)
{
    layout->columns[layout->column_count++] = column;
}

dea_layout dea_layout_of(const dea_scene *scene)
{
    const dea_study *study = dea_study_of(scene);
    dea_layout layout = {.rows = 1, .row_size = sizeof(dea_row), .state_offset = offsetof(dea_row, state)};
    if (study->row_size > 0) {
        layout.row_size = study->row_size;
        layout.state_offset = study->state_offset;
    }
    for (size_t i = 0; i < study->column_count; i++) {
        dea_layout_add(&layout, study->columns[i]);
    }
    study->lay(scene, &layout);
    layout.spread_offset = layout.rows * layout.row_size + study->behind;
    layout.point_size = layout.spread_offset + layout.rows * layout.spread_points * layout.spread_count * sizeof(double);
    return layout;
}

double dea_layout_place(const dea_scene *scene, size_t index)
{
    const dea_study *study = dea_study_of(scene);
    return study->place ? study->place(scene, index) : 0.0;
}

double dea_layout_index(const dea_scene *scene, double time)
{
    const dea_study *study = dea_study_of(scene);
    return study->index ? study->index(scene, time) : 0.0;
}

double dea_layout_radius(const dea_scene *scene, const dea_layout *layout, size_t index)
{
    return scene->actuator.frame_radius * (double)index / (double)(layout->spread_points - 1);
}

double *dea_layout_entry(const dea_layout *layout, const void *point, size_t row, size_t index)
{
    const size_t size = layout->spread_count * sizeof(double);
    return (double *)(void *)((const char *)point + layout->spread_offset + (row * layout->spread_points + index) * size);
}

void dea_layout_spread(dea_layout *layout, const dea_column *columns, size_t count, size_t points)
{
    for (layout->spread_count = 0; layout->spread_count < count; layout->spread_count++) {
        layout->spread[layout->spread_count] = columns[layout->spread_count];
        layout->spread[layout->spread_count].offset = layout->spread_count * sizeof(double);
    }
    layout->spread_points = points;
}

double dea_layout_number(const void *row, size_t offset)
{
    double value;
    memcpy(&value, (const char *)row + offset, sizeof value);
    return value;
}

dea_state dea_layout_state(const dea_layout *layout, const void *row)
{
    dea_state state;
    memcpy(&state, (const char *)row + layout->state_offset, sizeof state);
    return state;
}

dea_summary *dea_layout_summary(const dea_layout *layout, const void *point)
{
    return (dea_summary *)(void *)((const char *)point + layout->rows * layout->row_size);
}

dea_weakest *dea_layout_weakest(const dea_layout *layout, const void *point)
{
    return (dea_weakest *)(void *)((const char *)point + layout->rows * layout->row_size);
}

dea_band *dea_layout_band(const dea_layout *layout, const void *point)
{
    return (dea_band *)(void *)((const char *)point + layout->rows * layout->row_size);
}

dea_summary dea_summary_failed(void)
{
    const double none = (double)NAN;
    dea_summary summary = {none, none, none, 0.0, none, none, none, none, none, none, none, none, none, none, {{none, none}}};
    for (size_t i = 0; i < DEA_WINDOWS; i++) {
        summary.averages[i] = (dea_average){none, none};
    }
    return summary;
}

void dea_layout_fail(const dea_scene *scene, const dea_layout *layout, void *point)
{
    const dea_study *study = dea_study_of(scene);
    for (size_t i = 0; i < layout->rows; i++) {
        char *row = (char *)point + i * layout->row_size;
        for (size_t k = 0; k < layout->column_count; k++) {
            const double value = k == 0 && study->along ? dea_layout_place(scene, i) : (double)NAN;
            memcpy(row + layout->columns[k].offset, &value, sizeof value);
        }
        const dea_state failed = DEA_STATE_FAILED;
        memcpy(row + layout->state_offset, &failed, sizeof failed);
    }
    if (study->fail) {
        study->fail(layout, point);
    }
    const size_t entries = layout->rows * layout->spread_points * layout->spread_count;
    for (size_t i = 0; i < entries; i++) {
        dea_layout_entry(layout, point, 0, 0)[i] = (double)NAN;
    }
}
