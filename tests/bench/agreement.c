/* Do the engines agree, with each other and with the equations in extended precision? */
#include "bench.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static const char *const grid = "    prestretch: [1.1, 1.2, 1.3]\n    voltage: [1500 V, 4500 V]\n"
                                "    coverage: {from: 0.05, to: 0.95, points: 91}\n";
enum { GRID = 3 * 2 * 91 };

/* Largest relative error of the strain of rows over the grid. */
static double error_of(const char *model, const dea_scene *scene, const dea_row *rows)
{
    double worst = 0.0;
    for (size_t i = 0; i < GRID; i++) {
        dea_scene here = *scene;
        here.actuator.prestretch = scene->axes[0].values[i / (2 * 91)];
        here.drive.voltage = scene->axes[1].values[i / 91 % 2];
        here.actuator.coverage = scene->axes[2].values[i % 91];
        dea_point point;
        dea_film_prepare(&here, &point.film);
        dea_point_place(&here, &point);
        const long double exact = bench_strain(model, &point);
        const double error = (double)(fabsl((long double)rows[i].strain - exact) / fabsl(exact));
        worst = error <= worst ? worst : isnan(error) ? INFINITY : error;
    }
    return worst;
}

/* Errors of direct against the equations, of IDA and ngspice against direct; the larger of those already there. */
static void compare_engines(const char *kind, const char *model, double errors[3])
{
    static dea_row *rows[2];
    const char *const others[] = {"ida", "ngspice"};
    dea_scene scene = bench_scene(kind, model, 1.2, 1e-9, grid);
    for (int i = 0; i < 2; i++) {
        rows[i] = rows[i] ? rows[i] : bench_shared(GRID * sizeof **rows);
    }
    bench_sweep(dea_engine_find("direct"), &scene, rows[0]);
    errors[0] = fmax(errors[0], error_of(model, &scene, rows[0]));
    for (int i = 0; i < 2; i++) {
        const double seconds = bench_sweep(dea_engine_find(others[i]), &scene, rows[1]);
        errors[i + 1] = fmax(errors[i + 1], isnan(seconds) ? INFINITY : bench_difference(rows[1], rows[0], GRID));
    }
    dea_scene_free(&scene);
}

static void agreement_row(const char *what, const char *const *models, size_t count, const double goals[3])
{
    double errors[3] = {0.0, 0.0, 0.0};
    for (size_t i = 0; i < count; i++) {
        compare_engines("dot", models[i], errors);
        if (dea_model_find(models[i])->lens) {
            compare_engines("lens", models[i], errors);
        }
    }
    char goal[64], measured[64];
    snprintf(goal, sizeof goal, "%.0e / %.0e / %.0e relative", goals[0], goals[1], goals[2]);
    snprintf(measured, sizeof measured, "%.1e / %.1e / %.1e", errors[0], errors[1], errors[2]);
    bench_row(what, goal, errors[0] <= goals[0] && errors[1] <= goals[1] && errors[2] <= goals[2], measured, "");
}

/* One line of the table of physics.md, section 3. */
typedef struct table_line {
    double prestretch, coverage, dot, lens;
} table_line;

static double field_strain(const char *kind, const table_line *line, double accuracy)
{
    char sweep[64];
    dea_row row;
    snprintf(sweep, sizeof sweep, "    coverage: [%g]\n", line->coverage);
    dea_scene scene = bench_scene(kind, "field", line->prestretch, accuracy, sweep);
    bench_sweep(dea_engine_find("direct"), &scene, &row);
    dea_scene_free(&scene);
    return row.strain;
}

/* Against all printed digits, and against the same solver on the finer mesh of a wanted error of 1e-12. */
static void field_row(void)
{
    static const table_line table[] = {{1.1, 0.10, 0.03762647, -0.02932674},
                                       {1.1, 0.50, 0.02651626, -0.02338631},
                                       {1.2, 0.25, 0.06092621, -0.04432166},
                                       {1.2, 0.50, 0.04503297, -0.03741631},
                                       {1.3, 0.75, 0.03289753, -0.03263280}};
    double off = 0.0, change = 0.0;
    for (size_t i = 0; i < sizeof table / sizeof *table; i++) {
        const double dot = field_strain("dot", &table[i], 1e-6), lens = field_strain("lens", &table[i], 1e-6);
        off = fmax(off, fmax(fabs(dot - table[i].dot), fabs(lens - table[i].lens)));
        change = fmax(change, fabs(dot / field_strain("dot", &table[i], 1e-12) - 1.0));
        change = fmax(change, fabs(lens / field_strain("lens", &table[i], 1e-12) - 1.0));
    }
    char measured[64];
    snprintf(measured, sizeof measured, "off by %.1e of 1e-8; %.1e", off / 1e-8, change);
    bench_row("field against the printed table; against a finer mesh", "0.5 of the last digit, 1e-8; 1e-10",
              off <= 0.5001e-8 && change <= 1e-10, measured, "");
}

/* How far the closed form of lame is from the membrane at the paper's conditions. */
static void lame_row(void)
{
    static const char *const sweep = "    prestretch: [1.1, 1.2, 1.3]\n    coverage: {from: 0.1, to: 0.9, points: 81}\n";
    enum { POINTS = 3 * 81 };
    static const char *const models[] = {"lame", "field"};
    dea_row rows[2][POINTS];
    double low = INFINITY, high = -INFINITY;
    for (int k = 0; k < 2; k++) {
        dea_scene scene = bench_scene("dot", models[k], 1.2, 1e-9, sweep);
        bench_sweep(dea_engine_find("direct"), &scene, rows[k]);
        dea_scene_free(&scene);
    }
    for (size_t i = 0; i < POINTS; i++) {
        const double off = rows[0][i].strain / rows[1][i].strain - 1.0;
        low = isnan(off) ? -INFINITY : fmin(low, off);
        high = fmax(high, off);
    }
    char measured[64];
    snprintf(measured, sizeof measured, "%+.1f to %+.1f %%", 100.0 * low, 100.0 * high);
    bench_row("lame against field, 4.5 kV, 1.1-1.3, coverage 0.1-0.9", "-8 to +8 %, rounded", fmax(-low, high) < 0.085, measured,
              "");
}

void bench_agreement(void)
{
    static const char *const linear[] = {"lumped", "lame"}, *const hyperelastic[] = {"coverage", "constant_force"};
    agreement_row("direct/ida/ngspice agree: lumped, lame", linear, 2, (const double[]){1e-12, 1e-9, 1e-9});
    agreement_row("direct/ida/ngspice agree: coverage, constant_force", hyperelastic, 2, (const double[]){1e-12, 1e-9, 1e-8});
    field_row();
    lame_row();
}
