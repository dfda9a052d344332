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
    dea_layout layout = {
        .rows = 1, .row_size = sizeof(dea_row), .state_offset = offsetof(dea_row, state), .point_size = sizeof(dea_row)};
    dea_study_of(scene)->lay(scene, &layout);
    return layout;
}

double dea_layout_place(const dea_scene *scene, size_t index)
{
    const dea_study *study = dea_study_of(scene);
    return study->place ? study->place(scene, index) : 0.0;
}

dea_state dea_layout_state(const dea_layout *layout, const void *row)
{
    dea_state state;
    memcpy(&state, (const char *)row + layout->state_offset, sizeof state);
    return state;
}

dea_summary *dea_layout_summary(const dea_layout *layout, void *point)
{
    return (dea_summary *)(void *)((char *)point + layout->rows * layout->row_size);
}

dea_band *dea_layout_band(const dea_layout *layout, void *point)
{
    return (dea_band *)(void *)((char *)point + layout->rows * layout->row_size);
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
}
