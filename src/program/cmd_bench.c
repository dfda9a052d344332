#include <math.h>
#include <stdio.h>
#include <string.h>

#include "deaspice/bench.h"
#include "output/progress.h"
#include "program/program.h"
#include "study/study.h"

enum { CELL = 24 };

static void take_progress(void *user, size_t done, size_t total)
{
    dea_progress_show(user, done, total);
}

static void take_log(void *user, const char *line)
{
    dea_progress_clear(user);
    dea_complain("%s", line);
}

static void print_reference(const dea_bench_model *model)
{
    if (!model->reference) {
        puts("  no reference: no engine solved it, errors are not known");
        return;
    }
    printf("  reference: %s", model->reference->name);
    if (model->exact) {
        printf(" in closed form");
    } else {
        printf(" at %.0e, itself judged by its own tightest run", model->reference_accuracy);
    }
    if (model->check) {
        printf("; %s at %.0e is %.2g away", model->check->name, model->check_accuracy, model->apart);
    }
    putchar('\n');
}

static void print_limits(const dea_bench_model *model)
{
    const char *before = "  rows of the reference that are not ok: ";
    for (size_t state = 1; state < DEA_STATE_COUNT; state++) {
        if (model->states[state] > 0) {
            printf("%s%zu %s", before, model->states[state], dea_state_name((dea_state)state));
            before = ", ";
        }
    }
    if (before[0] == ',') {
        putchar('\n');
    }
}

static void print_model_error(const dea_study *study, const dea_bench_model *model)
{
    if (isnan(model->error_median)) {
        return;
    }
    printf("  error of the model: %s off from field by %.3g %% in the median, %.3g %% rms, %.3g %% at worst%s, over %zu %s",
           study->along ? "displacement" : "strain", 100.0 * model->error_median, 100.0 * model->error_rms, 100.0 * model->error_worst,
           study->timed ? " of its peak" : "", model->error_points, study->rows[model->error_points != 1]);
    if (model->error_left_out > 0) {
        printf(" (%zu not ok in one of the two)", model->error_left_out);
    }
    putchar('\n');
}

static void print_heading(const char *path, const dea_bench *bench, const dea_bench_model *model)
{
    printf("%s: %s (%s), %zu %s\n", path, model->model->name, model->model->equation, bench->rows,
           dea_study_of(bench->scene)->rows[1]);
    print_reference(model);
    print_limits(model);
    print_model_error(dea_study_of(bench->scene), model);
    printf("  %-8s %-12s %8s %8s %9s %9s %9s %5s %9s %9s  %s\n", "engine", "accuracy", "error", "of_asked", "time_ms", "25_%", "75_%", "runs",
           "start_ms", dea_study_of(bench->scene)->unit_head, "verdict");
}

static const char *accuracy_text(const dea_bench_setting *setting, char text[CELL])
{
    if (setting->any) {
        snprintf(text, CELL, "any");
    } else if (setting->loosest > setting->accuracy) {
        snprintf(text, CELL, "%.0e..%.0e", setting->loosest, setting->accuracy);
    } else {
        snprintf(text, CELL, "%.0e", setting->accuracy);
    }
    return text;
}

/* The error over @p unit. */
static const char *error_text(const dea_bench_setting *setting, double unit, char text[CELL])
{
    if (setting->reference || isnan(setting->error)) {
        snprintf(text, CELL, "-");
    } else {
        snprintf(text, CELL, "%.1e", setting->error / unit);
    }
    return text;
}

static void print_verdict(const dea_bench_setting *setting)
{
    const char *before = "  ";
    const struct {
        bool holds;
        const char *words;
    } verdicts[] = {
        {setting->reference, "reference"},
        {setting->broken, "*** PROMISE BROKEN ***"},
        {setting->dominated, "dominated"},
    };
    for (size_t i = 0; i < sizeof verdicts / sizeof *verdicts; i++) {
        if (verdicts[i].holds) {
            printf("%s%s", before, verdicts[i].words);
            before = ", ";
        }
    }
    if (setting->states > 0) {
        printf("%s%zu states differ", before, setting->states);
        before = ", ";
    }
    if (setting->failed > 0) {
        printf("%s%zu rows not solved", before, setting->failed);
    }
    putchar('\n');
}

static void print_setting(const dea_bench *bench, const dea_bench_setting *setting)
{
    static const char *const words[] = {
        [DEA_BENCH_REFUSED] = "cannot", [DEA_BENCH_SKIPPED] = "skipped", [DEA_BENCH_FAILED] = "FAILED"};
    char accuracy[CELL], error[CELL], share[CELL];
    const double scale = dea_study_of(bench->scene)->unit_scale;
    if (setting->state != DEA_BENCH_MEASURED) {
        printf("  %-8s %-12s %s: %s\n", setting->engine->name,
               setting->state == DEA_BENCH_REFUSED ? "-" : accuracy_text(setting, accuracy), words[setting->state],
               setting->reason);
        return;
    }
    printf("  %-8s %-12s %8s %8s %9.3g %9.3g %9.3g %5zu %9.2g %9.3g", setting->engine->name, accuracy_text(setting, accuracy),
           error_text(setting, 1.0, error), error_text(setting, setting->accuracy, share), 1e3 * setting->seconds, 1e3 * setting->lower, 1e3 * setting->upper, setting->runs,
           1e3 * setting->start, scale * setting->seconds / bench->units);
    print_verdict(setting);
}

static void print_bench(const char *path, const dea_bench *bench)
{
    for (size_t i = 0; i < bench->model_count; i++) {
        if (i > 0) {
            putchar('\n');
        }
        print_heading(path, bench, &bench->models[i]);
        for (size_t k = 0; k < bench->setting_count; k++) {
            if (bench->settings[k].model == i) {
                print_setting(bench, &bench->settings[k]);
            }
        }
    }
}

static dea_exit tell(const dea_bench *bench)
{
    size_t measured = 0, broken = 0;
    for (size_t i = 0; i < bench->setting_count; i++) {
        measured += bench->settings[i].state == DEA_BENCH_MEASURED;
        broken += bench->settings[i].broken;
    }
    if (broken > 0) {
        dea_complain("%zu setting%s broke the promise of its accuracy", broken, broken == 1 ? "" : "s");
        return DEA_EXIT_DISAGREED;
    }
    if (measured == 0) {
        dea_complain("nothing was measured");
        return DEA_EXIT_FAILED;
    }
    return DEA_EXIT_DONE;
}

/* Where the CSV goes to standard output, the table stays away. */
static bool has_table(const dea_arguments *arguments)
{
    return !arguments->quiet && !(arguments->output && strcmp(arguments->output, "-") == 0);
}

static dea_bench_options options_of(const dea_arguments *arguments, const dea_scene *scene, dea_progress *progress)
{
    dea_bench_options options = dea_bench_options_default();
    options.engine = arguments->engine && scene->engine_count > 0 ? scene->engines[0] : NULL;
    options.jobs = arguments->jobs ? arguments->jobs : options.jobs;
    options.runs = arguments->runs ? arguments->runs : options.runs;
    options.budget = isnan(arguments->budget) ? options.budget : arguments->budget;
    options.progress = take_progress;
    options.log = arguments->quiet ? NULL : take_log;
    options.stop = dea_signals_stop;
    options.user = progress;
    return options;
}

static dea_exit bench_scene(const dea_arguments *arguments, const char *path, const dea_scene *scene)
{
    dea_error error = {0};
    dea_bench bench = {0};
    dea_bench_output *output;
    dea_signals_catch();
    dea_status status = dea_bench_output_open(arguments->output, arguments->plot, &arguments->picture, &output, &error);
    if (status == DEA_OK) {
        dea_progress *progress = arguments->quiet ? NULL : dea_progress_begin();
        const dea_bench_options options = options_of(arguments, scene, progress);
        status = dea_bench_run(scene, &options, &bench, &error);
        dea_progress_end(progress);
    }
    const bool measured = status == DEA_OK;
    if (measured && has_table(arguments)) {
        print_bench(path, &bench);
    } else if (!measured && dea_signals_caught() != 0 && !dea_signals_broken_pipe()) {
        dea_complain("interrupted, nothing written");
    }
    const dea_status written = dea_bench_output_finish(output, measured ? &bench : NULL, measured ? &error : NULL);
    const dea_exit outcome = measured && written == DEA_OK ? tell(&bench) : dea_complain_error(&error);
    dea_bench_free(&bench);
    return outcome;
}

static dea_exit run(const dea_arguments *arguments)
{
    dea_scene scene;
    dea_exit outcome = DEA_EXIT_USAGE;
    const char *path = arguments->operands[0].path;
    if (!dea_scene_open(arguments, path, &scene, &outcome)) {
        return outcome;
    }
    if (arguments->engine && scene.engine_count > 1) {
        dea_complain("bench measures all engines, or one of them: --engine %s names %zu", arguments->engine, scene.engine_count);
        dea_scene_free(&scene);
        return DEA_EXIT_USAGE;
    }
    if (!arguments->model || scene.automatic) {
        dea_bench_all_models(&scene);
    }
    outcome = bench_scene(arguments, path, &scene);
    dea_scene_free(&scene);
    return outcome;
}

const dea_command dea_command_bench = {
    .name = "bench",
    .summary = "time against error: every engine, accuracy and model of a scene",
    .help = "Usage: deaspice bench [OPTION]... SCENE\n"
            "\n"
            "Solves the study of a scene by every engine that can do it, at accuracies from\n"
            "1e-2 down to the best that the engine takes, for every model that fits, and shows\n"
            "what each setting costs beside the error that it really has. Settings that give\n"
            "the very same numbers share one row.\n"
            "\n"
            "time is the median wall time of the study with its quartiles; start_ms, the start\n"
            "of the engine with its worker process, is part of it, as of the time a point, a\n"
            "simulated second (transient) or a frequency (ac). The runs take turns, so that all\n"
            "meet the same drifts of the machine.\n"
            "error is the largest difference to the model's reference over the columns that\n"
            "check compares: those of a sweep, relative to themselves; those of a transient,\n"
            "relative to the peak of the run; magnitudes and phases (in radian) of an ac study.\n"
            "The reference is the engine that promises most, at its tightest.\n"
            "of_asked is that error over the accuracy, of a row of several over the tightest.\n"
            "PROMISE BROKEN: the error is above the accuracy that was asked for. dominated:\n"
            "another setting of the model is at least as fast and as accurate, and better in\n"
            "one. The error of the model is that of its strain against field, over time that of\n"
            "its displacement over the peak, over frequency that of its displacement per volt.\n"
            "--engine leaves out all others. There is one job unless --jobs says more, so that\n"
            "the times of the engines compare.\n"
            "\n",
    .further = "Exit status: 0 done, 1 nothing measured or a file not written, 2 usage or a bad\n"
               "scene, 3 a promise was broken.\n"
               "\n"
               "Example:\n"
               "  deaspice bench examples/figure10.yaml -o bench.csv --plot bench.svg\n",
    .takes = DEA_TAKES_ENGINE | DEA_TAKES_SCENE | DEA_TAKES_OUTPUT | DEA_TAKES_PLOT | DEA_TAKES_JOBS | DEA_TAKES_QUIET |
             DEA_TAKES_BENCH,
    .least = 1,
    .most = 1,
    .files = ".yaml",
    .run = run,
};
