#include "netlist/export.h"

#include <string.h>

#include "study/study.h"

static const dea_analogy analogies[] = {
    {"mobility", "mobility analogy: v(edge) = velocity [m/s], current = force [N], compliance = inductor, mass = capacitor", 'c',
     'l', false},
    {"impedance", "impedance analogy: voltage = force [N], current = velocity [m/s], compliance = capacitor, mass = inductor",
     'l', 'c', true},
};

enum { ANALOGIES = sizeof analogies / sizeof *analogies };

const dea_analogy *dea_analogy_at(size_t index)
{
    return index < ANALOGIES ? &analogies[index] : NULL;
}

const dea_analogy *dea_analogy_find(const char *name)
{
    for (size_t i = 0; i < ANALOGIES; i++) {
        if (strcmp(analogies[i].name, name) == 0) {
            return &analogies[i];
        }
    }
    return NULL;
}

void dea_export_share(dea_part_text *text)
{
    for (int i = 0; i < text->pool->count; i++) {
        const dea_term *term = &text->pool->terms[i];
        text->nodal[i] = text->moves[i] && term->operation >= DEA_ADD && !dea_expr_is_scaled(text->pool, i);
    }
}

void dea_export_number(FILE *out, double value)
{
    dea_part_number(out, value);
}

void dea_export_parameter(FILE *out, const char *name, double value)
{
    fprintf(out, ".param %s=", name);
    dea_part_number(out, value);
    fputc('\n', out);
}

void dea_export_head(const dea_export *export, const char *meaning)
{
    const dea_scene *scene = export->scene;
    dea_dialect_comment(export->out, scene->title && *scene->title ? scene->title : "dielectric elastomer actuator");
    fprintf(export->out, "* %s, model %s (%s), for %s\n* %s\n", scene->actuator.kind == DEA_DOT ? "dot" : "lens",
            scene->models[0]->name, scene->models[0]->equation, export->dialect->title, meaning);
}

static dea_status refuse_models(const dea_scene *scene, dea_error *error)
{
    if (scene->model_count > 1) {
        return dea_fail(error, DEA_ERROR_UNSUPPORTED, "a netlist holds one model, the scene has %zu: choose one, --model %s",
                        scene->model_count, scene->models[0]->name);
    }
    if (!scene->models[0]->network && !(scene->models[0]->membrane && scene->study == DEA_STUDY_SWEEP)) {
        return dea_fail(error, DEA_ERROR_UNSUPPORTED, "the model %s is not a network: --model lumped is one",
                        scene->models[0]->name);
    }
    return DEA_OK;
}

static dea_status refuse_runs(const dea_scene *scene, dea_error *error)
{
    if (!scene->models[0]->dynamic || scene->models[0]->membrane) {
        return dea_fail(error, DEA_ERROR_UNSUPPORTED, "the model %s is one of statics alone: --model lumped has a time domain",
                        scene->models[0]->name);
    }
    if (scene->axis_count > 0) {
        return dea_fail(error, DEA_ERROR_UNSUPPORTED,
                        "a netlist holds one run, the scene's study.over asks for %zu: --set study.over={} and a value of %s, "
                        "such as --set %s=...",
                        dea_scene_point_count(scene), scene->axes[0].key, scene->axes[0].key);
    }
    return DEA_OK;
}

dea_status dea_export_netlist(dea_export *export, dea_error *error)
{
    const dea_study *study = dea_study_of(export->scene);
    export->note[0] = '\0';
    dea_status status = study->netlist ? refuse_models(export->scene, error)
                                       : dea_fail(error, DEA_ERROR_UNSUPPORTED, "no netlist does a study of %s", study->name);
    if (status == DEA_OK && study->along) {
        status = refuse_runs(export->scene, error);
    }
    return status == DEA_OK ? study->netlist(export, error) : status;
}
