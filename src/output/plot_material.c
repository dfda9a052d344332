/* Pictures of a material and of a fit: stress and modulus over stretch, stress over time. */
#include "output/picture.h"

#include "output/legend.h"
#include "support/number.h"

#include <math.h>
#include <string.h>

enum { WIDTH = 960, HEIGHT = 420, FIT_WIDTH = 640, FIT_HEIGHT = 440, CURVE_STEPS = 200, POINTS_MAX = 2000 };

static const char *const load_colours[DEA_LOAD_COUNT] = {"#0072b2", "#d55e00"};
static const char *const load_titles[DEA_LOAD_COUNT] = {"uniaxial", "equi-biaxial"};

/* Left and right edge of the axes, and their height, as shares of the canvas. */
static void write_place(FILE *script, double left, double right, double bottom, double top)
{
    static const char *const names[] = {"lmargin", "rmargin", "bmargin", "tmargin"};
    const double values[] = {left, right, bottom, top};
    for (int i = 0; i < 4; i++) {
        fprintf(script, "set %s at screen ", names[i]);
        dea_gnuplot_number(script, values[i]);
        fputc('\n', script);
    }
}

static void write_setting(FILE *script, const char *setting, const char *text)
{
    fprintf(script, "set %s ", setting);
    dea_gnuplot_text(script, text);
    fputc('\n', script);
}

static void write_pair(FILE *script, double x, double y)
{
    dea_gnuplot_number(script, x);
    fputc(' ', script);
    dea_gnuplot_number(script, y);
    fputc('\n', script);
}

/* Adds an entry below those that are there, from the corner x, y down. */
static void add_entry(dea_legend *legend, int load, const char *what, size_t dash, int symbol, double x, double y)
{
    const double row = (double)legend->count;
    dea_legend_entry *entry = dea_legend_add(legend);
    snprintf(entry->label, sizeof entry->label, "%s%s", load_titles[load], what);
    snprintf(entry->colour, sizeof entry->colour, "%s", load_colours[load]);
    entry->dash = dash;
    entry->symbol = symbol;
    entry->x = x + 16.0;
    entry->y = y - 18.0 - DEA_LEGEND_ROW * row;
}

/* Data block $fit<load> of nominal stress [kPa] over stretch. */
static void write_stress(FILE *script, const dea_law *law, const double *constants, dea_load load, double from, double to)
{
    fprintf(script, "$fit%d << END\n", (int)load);
    for (int i = 0; i <= CURVE_STEPS; i++) {
        const double stretch = from + (to - from) * i / CURVE_STEPS;
        write_pair(script, stretch, 1e-3 * dea_fit_stress(law, constants, load, stretch));
    }
    fputs("END\n", script);
}

static void write_material(const dea_material *material, double to, FILE *script)
{
    double constants[DEA_LAW_CONSTANTS];
    dea_material_long_term(material, constants);
    for (int load = 0; load < DEA_LOAD_COUNT; load++) {
        write_stress(script, material->law, constants, (dea_load)load, 1.0, to);
    }
    fputs("$modulus << END\n", script);
    for (int i = 0; i <= CURVE_STEPS; i++) {
        const double stretch = 1.0 + (to - 1.0) * i / CURVE_STEPS;
        write_pair(script, stretch, 1e-6 * dea_law_modulus(material->law, constants, stretch));
    }
    fputs("END\n", script);
    dea_plot_style(script);
    fputs("unset key\nset multiplot\nset xrange [1:", script);
    dea_gnuplot_number(script, to);
    fputs("]\nset yrange [0:*]\nset label 1 '(a)' at graph 0, graph 1.045\n", script);
    write_setting(script, "label 2", material->name);
    fprintf(script, "set label 2 at screen 0.5, screen 0.96 center\n");
    write_setting(script, "xlabel", "Stretch λ");
    write_setting(script, "ylabel", "Engineering stress P [kPa]");
    write_place(script, 0.095, 0.48, 0.15, 0.865);
    dea_legend legend = {.count = 0};
    for (int load = 0; load < DEA_LOAD_COUNT; load++) {
        add_entry(&legend, load, "", (size_t)load + 1, 0, 0.095 * WIDTH, 0.865 * HEIGHT);
    }
    for (int load = 0; load < DEA_LOAD_COUNT; load++) {
        fprintf(script, "%s$fit%d with lines linewidth 1.8 linecolor '%s' ", load > 0 ? ", " : "plot ", load, load_colours[load]);
        dea_plot_dash(script, (size_t)load + 1);
    }
    fputs("\nunset label 2\nset label 1 '(b)' at graph 0, graph 1.045\n", script);
    write_setting(script, "ylabel", "Operating modulus Y [MPa]");
    write_place(script, 0.59, 0.975, 0.15, 0.865);
    fprintf(script, "plot $modulus with lines linewidth 1.8 linecolor '%s' notitle\n", load_colours[DEA_LOAD_EQUIBIAXIAL]);
    dea_legend_draw(&legend, script, WIDTH, HEIGHT);
    fputs("unset multiplot\nunset output\n", script);
}

dea_status dea_plot_material(const dea_material *material, double to, const char *path, dea_error *error)
{
    dea_gnuplot picture;
    const dea_status status = dea_gnuplot_begin(&picture, path, error);
    if (status != DEA_OK) {
        return status;
    }
    dea_gnuplot_size(&picture, WIDTH, HEIGHT);
    write_material(material, to, picture.script);
    return dea_gnuplot_finish(&picture, true, error);
}

/* Data block $data<load> of the measured points, evenly thinned where there are very many. */
static void write_points(FILE *script, const dea_fit_data *data, const dea_fit *fit, dea_load load)
{
    const size_t step = fit->count[load] / POINTS_MAX + 1;
    size_t seen = 0;
    fprintf(script, "$data%d << END\n", (int)load);
    for (size_t i = 0; i < data->count; i++) {
        if (data->points[i].load == load && seen++ % step == 0) {
            write_pair(script, data->points[i].stretch, 1e-3 * data->points[i].stress);
        }
    }
    fputs("END\n", script);
}

/* Where axes stand, as shares of the canvas. */
typedef struct panel {
    double left, right;
    int width; /* of the canvas, 1/100 inch */
} panel;

enum { LINE_ENTRY = 1, POINT_ENTRY = 6 };
static const double panel_bottom = 0.13, panel_top = 0.965;

/* Opens axes with their titles. */
static void write_panel(FILE *script, const panel *at, double from, double to, const char *across)
{
    fputs("set xrange [", script);
    dea_gnuplot_number(script, from);
    fputc(':', script);
    dea_gnuplot_number(script, to);
    fputs("]\n", script);
    write_setting(script, "xlabel", across);
    write_setting(script, "ylabel", "Engineering stress P [kPa]");
    write_place(script, at->left, at->right, panel_bottom, panel_top);
}

static void write_fit(const dea_fit *fit, const dea_fit_data *data, const panel *at, FILE *script, dea_legend *legend)
{
    const double from = fmin(fit->stretch_min, 1.0), to = fmax(fit->stretch_max, 1.0);
    write_panel(script, at, from, to, "Stretch λ");
    const char *before = "plot ";
    for (int load = 0; load < DEA_LOAD_COUNT; load++) {
        if (fit->count[load] > 0) {
            write_stress(script, fit->law, fit->constants, (dea_load)load, from, to);
            write_points(script, data, fit, (dea_load)load);
            add_entry(legend, load, ", measured", 0, POINT_ENTRY, at->left * at->width, panel_top * FIT_HEIGHT);
            add_entry(legend, load, ", Yeoh fit", LINE_ENTRY, 0, at->left * at->width, panel_top * FIT_HEIGHT);
        }
    }
    for (int load = 0; load < DEA_LOAD_COUNT; load++) {
        if (fit->count[load] > 0) {
            fprintf(script, "%s$data%d with points pointtype 6 pointsize 0.7 linewidth 1 linecolor '%s'", before, load,
                    load_colours[load]);
            fprintf(script, ", $fit%d with lines linewidth 1.8 linecolor '%s'", load, load_colours[load]);
            before = ", ";
        }
    }
    fputc('\n', script);
}

/* The time axis is log10(1 + t/t_1), t_1 the first time after 0: logarithmic, and yet with a place for t = 0. */
static double time_place(double time, double first)
{
    return log10(1.0 + time / first);
}

static void write_time_tics(FILE *script, double first, double last)
{
    fputs("set xtics (\"0\" 0", script);
    for (double tic = pow(10.0, floor(log10(first))); tic <= last; tic *= 10.0) {
        if (tic >= 0.99 * first) {
            char label[DEA_NUMBER_LENGTH];
            fprintf(script, ", \"%s\" ", dea_number_text(label, tic, 3));
            dea_gnuplot_number(script, time_place(tic, first));
        }
    }
    fputs(")\n", script);
}

static void write_relaxation_points(FILE *script, const dea_relaxation_data *data, double first)
{
    const size_t step = data->count / POINTS_MAX + 1;
    fputs("$held << END\n", script);
    for (size_t i = 0; i < data->count; i += step) {
        write_pair(script, time_place(data->points[i].time, first), 1e-3 * data->points[i].stress);
    }
    fputs("END\n", script);
}

static void write_relaxation_curve(FILE *script, const dea_relaxation *fit, double first)
{
    const double to = time_place(fit->time_max, first);
    fputs("$relaxed << END\n", script);
    for (int i = 0; i <= CURVE_STEPS; i++) {
        const double place = to * i / CURVE_STEPS;
        write_pair(script, place, 1e-3 * dea_relaxation_stress(fit, first * (pow(10.0, place) - 1.0)));
    }
    fputs("END\n", script);
}

static void write_relaxation(const dea_relaxation *fit, const dea_relaxation_data *data, const panel *at, FILE *script,
                             dea_legend *legend)
{
    const double first = data->points[0].time > 0.0 ? data->points[0].time : data->points[1].time;
    write_panel(script, at, 0.0, time_place(fit->time_max, first), "Time since the end of the ramp t [s]");
    fputs("set yrange [0:*]\n", script);
    write_time_tics(script, first, fit->time_max);
    write_relaxation_points(script, data, first);
    write_relaxation_curve(script, fit, first);
    static const char *const labels[] = {"measured", "Prony fit"};
    for (int i = 0; i < 2; i++) {
        dea_legend_entry *entry = dea_legend_add(legend);
        snprintf(entry->label, sizeof entry->label, "%s", labels[i]);
        snprintf(entry->colour, sizeof entry->colour, "%s", load_colours[0]);
        entry->dash = i == 0 ? 0 : LINE_ENTRY;
        entry->symbol = i == 0 ? POINT_ENTRY : 0;
        entry->x = at->left * at->width + 16.0;
        entry->y = panel_bottom * FIT_HEIGHT + 18.0 + DEA_LEGEND_ROW * (1 - i);
    }
    fprintf(script, "plot $held with points pointtype 6 pointsize 0.7 linewidth 1 linecolor '%s'", load_colours[0]);
    fprintf(script, ", $relaxed with lines linewidth 1.8 linecolor '%s'\n", load_colours[0]);
}

dea_status dea_plot_fit(const dea_fit *fit, const dea_fit_data *data, const dea_relaxation *relaxation,
                        const dea_relaxation_data *held, const char *path, dea_error *error)
{
    dea_gnuplot picture;
    const dea_status status = dea_gnuplot_begin(&picture, path, error);
    if (status != DEA_OK) {
        return status;
    }
    const bool both = fit && relaxation;
    const int width = both ? 2 * FIT_WIDTH : FIT_WIDTH;
    const double half = both ? 0.5 : 1.0;
    const panel first = {0.125 * half, 0.97 * half, width}, second = {1.0 - 0.875 * half, 1.0 - 0.03 * half, width};
    dea_legend legend = {.count = 0};
    dea_gnuplot_size(&picture, width, FIT_HEIGHT);
    dea_plot_style(picture.script);
    fputs("unset key\nset multiplot\n", picture.script);
    if (fit) {
        write_fit(fit, data, &first, picture.script, &legend);
    }
    if (relaxation) {
        write_relaxation(relaxation, held, &second, picture.script, &legend);
    }
    dea_legend_draw(&legend, picture.script, width, FIT_HEIGHT);
    fputs("unset multiplot\nunset output\n", picture.script);
    return dea_gnuplot_finish(&picture, true, error);
}
