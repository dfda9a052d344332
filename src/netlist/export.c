#include "netlist/export.h"

#include "study/study.h"

void dea_export_head(const dea_export *export, const char *meaning)
{
    const dea_scene *scene = export->scene;
    dea_dialect_comment(export->out, scene->title && *scene->title ? scene->title : "dielectric elastomer actuator");
    fprintf(export->out, "* %s, model %s (%s), for %s\n* %s\n", scene->actuator.kind == DEA_DOT ? "dot" : "lens",
            scene->models[0]->name, scene->models[0]->equation, export->dialect->title, meaning);
}

void dea_export_band(const dea_export *export, const char *u, const char *v)
{
    const dea_scene *scene = export->scene;
    const size_t last = dea_layout_of(scene).rows - 1;
    const dea_mobility_band band = {.from = scene->ac.from,
                                    .to = dea_layout_place(scene, last),
                                    .points_per_decade = last > 0 ? scene->ac.points_per_decade : 0,
                                    .count = 1};
    fprintf(export->out,
            "* results: displacement v(%s) [m] and velocity v(%s) [m/s] per volt, input admittance -v(current) [S]\n"
            "HCURRENT current 0 VSOURCE 1\n.print ac vm(%s) vp(%s) vm(%s) vp(%s) vm(current) vp(current)\n%s",
            u, v, u, u, v, v, export->dialect->ac);
    dea_cards_write_band(&band, export->out);
}

static dea_status refuse_models(const dea_scene *scene, dea_error *error)
{
    if (scene->model_count > 1) {
        return dea_fail(error, DEA_ERROR_UNSUPPORTED, "a netlist holds one model, the scene has %zu: choose one, --model %s",
                        scene->model_count, scene->models[0]->name);
    }
    if (scene->models[0]->membrane && dea_study_of(scene)->along && scene->electrode.sheet_resistance > 0.0) {
        return dea_fail(error, DEA_ERROR_UNSUPPORTED, "the potential along a sheet resistance of the model %s is no netlist: --model ring "
                                                      "has one resistance for it", scene->models[0]->name);
    }
    const bool still = !dea_study_of(scene)->along || dea_study_of(scene)->still;
    if (scene->models[0]->membrane && still && scene->antagonist.there) {
        return dea_fail(error, DEA_ERROR_UNSUPPORTED, "the model %s with a second film at rest is no netlist: --model ring is one",
                        scene->models[0]->name);
    }
    if (scene->models[0]->membrane && !still && scene->antagonist.there) {
        return dea_fail(error, DEA_ERROR_UNSUPPORTED, "the model %s with a second film that moves is no netlist: --as subckt has both films, "
                                                      "--model ring is one", scene->models[0]->name);
    }
    if (!scene->models[0]->network && !scene->models[0]->membrane) {
        return dea_fail(error, DEA_ERROR_UNSUPPORTED, "the model %s is not a network: --model lumped is one",
                        scene->models[0]->name);
    }
    return DEA_OK;
}

static dea_status refuse_runs(const dea_scene *scene, dea_error *error)
{
    if (!scene->models[0]->dynamic) {
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
