/* From the arguments to the scene and the engine that they ask for. */
#include <math.h>
#include <stdio.h>

#include "deaspice/needs.h"
#include "program/omissions.h"
#include "program/program.h"

bool dea_engine_named(const dea_scene *scene, const dea_engine *engine)
{
    bool named = scene->engine_count == 0;
    for (size_t i = 0; i < scene->engine_count; i++) {
        named = named || scene->engines[i] == engine;
    }
    return named;
}

bool dea_inputs_note(const dea_arguments *arguments, dea_files *files)
{
    dea_error error = {0};
    dea_status status = DEA_OK;
    for (size_t i = 0; i < DEA_TESTS && status == DEA_OK; i++) {
        status = arguments->tests[i] ? dea_files_note_path(files, arguments->tests[i], &error) : DEA_OK;
    }
    for (size_t i = 0; i < arguments->operand_count && status == DEA_OK; i++) {
        status = dea_files_note_path(files, arguments->operands[i].path, &error);
    }
    if (status != DEA_OK) {
        dea_complain_error(&error);
    }
    return status == DEA_OK;
}

bool dea_targets_free(const dea_arguments *arguments, dea_files *files)
{
    const char *standard = arguments->output || arguments->plot ? NULL : "-";
    const char *paths[] = {arguments->output, arguments->plot, standard};
    dea_error error = {0};
    for (size_t i = 0; i < sizeof paths / sizeof *paths; i++) {
        if (paths[i] && dea_files_target(files, paths[i], arguments->force, &error) != DEA_OK) {
            dea_complain_error(&error);
            return false;
        }
    }
    return true;
}

bool dea_scene_open(const dea_arguments *arguments, const char *path, dea_scene *scene, dea_exit *outcome)
{
    dea_error error = {0};
    const dea_reading how = {.settings = arguments->settings,
                             .setting_count = arguments->setting_count,
                             .model = arguments->model,
                             .engine = arguments->engine,
                             .no_files = arguments->no_files};
    const dea_status status = dea_scene_read_as(path, &how, scene, &error);
    if (status == DEA_OK) {
        scene->full = arguments->full;
        *outcome = DEA_EXIT_USAGE;
        if (dea_inputs_note(arguments, scene->files) && dea_targets_free(arguments, scene->files)) {
            if (scene->drive.waveform.columns[0] && !arguments->quiet) {
                dea_complain("note: waveform file: %s", scene->drive.waveform.columns);
            }
            return true;
        }
        dea_scene_free(scene);
        return false;
    }
    *outcome = dea_complain_error(&error);
    if (status == DEA_ERROR_IO) {
        *outcome = DEA_EXIT_USAGE;
    }
    return false;
}

static bool can_do_all(const dea_engine *engine, const dea_scene *scene)
{
    for (size_t i = 0; i < scene->model_count; i++) {
        if (dea_crew_of(scene, engine, scene->models[i]).count == 0) {
            return false;
        }
    }
    return true;
}

bool dea_engines_unfit(const dea_scene *scene)
{
    if (can_do_all(NULL, scene)) {
        return false;
    }
    for (size_t i = 0; i < scene->model_count; i++) {
        const bool unfit = dea_crew_of(scene, NULL, scene->models[i]).count == 0;
        for (size_t k = 0; unfit && k < dea_engine_count(); k++) {
            const dea_engine *engine = dea_engine_at(k);
            const char *why = dea_engine_refuses(engine, scene, scene->models[i]);
            if (why && dea_engine_named(scene, engine)) {
                dea_complain("engine %s cannot do model %s: %s", engine->name, scene->models[i]->name, why);
            }
        }
    }
    for (size_t i = 0; i < dea_engine_count(); i++) {
        if (can_do_all(dea_engine_at(i), scene)) {
            dea_complain("--engine %s can do it", dea_engine_at(i)->name);
        }
    }
    return true;
}

static void complain_choice(const dea_scene *scene, const dea_engine *engine, const dea_model_choice *choice)
{
    char bound[32];
    const char *name = engine ? engine->name : "any engine";
    const char *truth = choice->truth->name;
    if (!choice->next) {
        dea_complain("model auto: %s can do none of the models for this study", name);
    } else if (isinf(choice->bound)) {
        dea_complain("model auto: %s can do no model that could be held against %s, its states included; name one with --model",
                     name, truth);
    } else {
        dea_complain("model auto: %s can do no model that is within the model error, %g, of %s; the best, %s, is within %s",
                     name, scene->model_error, truth, choice->next->name, dea_bound_text(choice->bound, bound));
    }
    for (size_t i = 0; i < dea_engine_count(); i++) {
        if (!dea_engine_refuses(dea_engine_at(i), scene, choice->truth)) {
            dea_complain("--engine %s can do %s", dea_engine_at(i)->name, truth);
        }
    }
}

bool dea_model_settle(dea_scene *scene, const dea_engine *engine, bool quiet, dea_model_choice *choice, dea_exit *outcome)
{
    char text[32];
    dea_error error = {0};
    *choice = (dea_model_choice){0};
    if (!scene->automatic) {
        return true;
    }
    if (dea_needs_model(scene, engine, choice, &error) != DEA_OK) {
        *outcome = dea_complain_error(&error);
        return false;
    }
    if (!choice->model) {
        complain_choice(scene, engine, choice);
        *outcome = DEA_EXIT_USAGE;
        return false;
    }
    scene->models[0] = choice->model;
    scene->automatic = false;
    if (!quiet && choice->model == choice->truth) {
        fprintf(stderr, "model auto: %s, nothing cheaper is good enough\n", choice->model->name);
    } else if (!quiet) {
        fprintf(stderr, "model auto: %s, within %s of %s\n", choice->model->name, dea_bound_text(choice->bound, text),
                choice->truth->name);
    }
    if (!quiet && choice->unsolved && choice->truth != dea_needs_truth(scene->study)) {
        const char *finest = dea_needs_truth(scene->study)->name;
        fprintf(stderr, "%s was not solved at once, so that how far %s is from it is not known: --model %s tries it, a damper "
                        "(material.retardation) and a slower rise make it easier\n", finest, choice->truth->name, finest);
    }
    return true;
}
