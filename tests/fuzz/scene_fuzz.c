/* libFuzzer target of the scene reader. Files cannot be named (no folder), axes are kept short by -DDEA_AXIS_VALUES_MAX. */
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "deaspice/scene.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);
const char *__lsan_default_suppressions(void);

/* libfyaml 0.7.12 loses 2 KiB for a quoted scalar with very many escapes. */
const char *__lsan_default_suppressions(void)
{
    return "leak:libfyaml.so";
}

/* A first byte of '!' turns the first line into a setting of the scene that follows. */
static size_t setting_split(const uint8_t *data, size_t size, char **setting)
{
    const uint8_t *end = size > 0 && data[0] == '!' ? memchr(data, '\n', size) : NULL;
    const size_t length = end ? (size_t)(end - data) : 0;
    *setting = length > 0 ? calloc(length, 1) : NULL;
    if (*setting) {
        memcpy(*setting, data + 1, length - 1);
    }
    return *setting ? length + 1 : 0;
}

/* What engines rely on in a scene that has been read. */
static bool scene_sound(const dea_scene *scene)
{
    const dea_waveform *waveform = &scene->drive.waveform;
    const dea_transient *transient = &scene->transient;
    const bool times = waveform->kind != DEA_WAVE_POINTS || (waveform->point_count > 0 && waveform->times && waveform->voltages);
    const bool step = waveform->kind != DEA_WAVE_STEP || !(waveform->step.off < waveform->step.on + waveform->step.rise);
    if (scene->study == DEA_STUDY_TRANSIENT) {
        return times && step && waveform->kind != DEA_WAVE_NONE && transient->every > 0.0 && transient->every <= transient->until;
    }
    const dea_ac *ac = &scene->ac;
    const bool range = scene->study != DEA_STUDY_AC || (ac->from > 0.0 && ac->from <= ac->to && isfinite(ac->bias));
    return waveform->kind == DEA_WAVE_NONE && range;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    dea_scene scene;
    dea_error error = {.status = DEA_OK};
    char *text = NULL;
    const size_t start = setting_split(data, size, &text);
    const dea_setting setting = {.text = text};
    const dea_status status =
        dea_scene_parse((const char *)data + start, size - start, "fuzz", NULL, &setting, text ? 1 : 0, NULL, &scene, &error);
    if ((status == DEA_OK) != (error.message[0] == '\0') ||
        (status == DEA_OK && (dea_scene_point_count(&scene) == 0 || !scene_sound(&scene)))) {
        abort();
    }
    for (const char *c = error.message; *c; c++) {
        if ((unsigned char)*c < 0x20) {
            abort();
        }
    }
    dea_scene_free(&scene);
    free(text);
    return 0;
}
