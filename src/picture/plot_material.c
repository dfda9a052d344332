/* Pictures of a material and of a fit: stress and modulus over stretch, stress over time. */
#include "picture/figure.h"

#include "support/number.h"

#include <math.h>
#include <string.h>

enum { PANEL = 340, LEFT = 96, CURVE_STEPS = 200, POINTS_MAX = 2000, NATURAL = 640 /* width of a panel of a fit */ };

static const char *const stretch_label = "Stretch λ", *const stress_label = "Engineering stress P [kPa]";

/* How the curve and the points of a load look: told apart in grey too. */
static const struct {
    const char *title, *colour;
    size_t dash;
    int symbol;
} loads[DEA_LOAD_COUNT] = {{"uniaxial", "#404040", 1, 6}, {"equi-biaxial", "#b03060", 2, 8}};

/* An entry in the looks of a load. */
static void add_entry(dea_legend *legend, size_t load, const char *title, const char *what, bool line, bool point)
{
    dea_legend_entry *entry = dea_legend_add(legend);
    snprintf(entry->label, sizeof entry->label, "%s%s", title, what);
    snprintf(entry->colour, sizeof entry->colour, "%s", loads[load].colour);
    entry->dash = line ? loads[load].dash : 0;
    entry->symbol = point ? loads[load].symbol : 0;
}

/* Begins the line of a load on a panel, or its points. */
static void begin_curve(dea_figure *figure, size_t panel, size_t load, bool line)
{
    dea_look look = {.dash = loads[load].dash, .symbol = line ? 0 : loads[load].symbol, .size = 0.7};
    snprintf(look.colour, sizeof look.colour, "%s", loads[load].colour);
    dea_figure_curve(figure, panel, look, line ? 1.8 : 0.0);
}

/* A panel from zero on; what is drawn of it is @p factor times its numbers. */
static size_t add_panel(dea_figure *figure, const char *label, double factor, size_t across, const char *along)
{
    dea_panel *panel = dea_figure_panel(figure, PANEL, label);
    panel->factor = factor;
    panel->zero = true;
    panel->across = across;
    snprintf(figure->across[across].label, DEA_LABEL_LENGTH, "%s", along);
    return figure->count - 1;
}

/* Nominal stress over stretch. */
static void add_stress(dea_figure *figure, size_t panel, const dea_law *law, const double *constants, size_t load, double from, double to)
{
    begin_curve(figure, panel, load, true);
    for (int i = 0; i <= CURVE_STEPS; i++) {
        const double stretch = from + (to - from) * i / CURVE_STEPS;
        dea_figure_point(figure, stretch, dea_fit_stress(law, constants, (dea_load)load, stretch), 0);
    }
}

/* Lays legend and panels, draws, and ends the picture. */
static dea_status finish(dea_figure *figure, dea_error *error)
{
    dea_gnuplot *picture = figure->picture;
    figure->left = LEFT;
    const size_t kinds[] = {0, figure->legend.count};
    figure->foot = dea_legend_lay(&figure->legend, kinds, 1, picture->canvas.width);
    const dea_status status = dea_figure_end(figure, dea_figure_pair(figure, 0.5, PANEL, error), error);
    const dea_status drawn = dea_gnuplot_finish(picture, status == DEA_OK, status == DEA_OK ? error : NULL);
    return status != DEA_OK ? status : drawn;
}

dea_status dea_plot_material(const dea_material *material, double to, const char *path, const dea_plot_options *options,
                             dea_error *error)
{
    dea_gnuplot picture;
    double constants[DEA_LAW_CONSTANTS];
    const dea_status status = dea_gnuplot_begin(&picture, path, options, error);
    if (status != DEA_OK) {
        return status;
    }
    dea_figure figure = dea_figure_begin(&picture, material->name, false);
    dea_material_long_term(material, constants);
    const size_t stress = add_panel(&figure, stress_label, 1e-3, 0, stretch_label);
    for (size_t load = 0; load < DEA_LOAD_COUNT; load++) {
        add_stress(&figure, stress, material->law, constants, load, 1.0, to);
        add_entry(&figure.legend, load, loads[load].title, "", true, false);
    }
    begin_curve(&figure, add_panel(&figure, "Operating modulus Y [MPa]", 1e-6, 0, stretch_label), DEA_LOAD_EQUIBIAXIAL, true);
    for (int i = 0; i <= CURVE_STEPS; i++) {
        const double stretch = 1.0 + (to - 1.0) * i / CURVE_STEPS;
        dea_figure_point(&figure, stretch, dea_law_modulus(material->law, constants, stretch), 0);
    }
    return finish(&figure, error);
}

/* Stress over stretch: the measured points, evenly thinned where there are very many, and the fit. */
static void add_fit(dea_figure *figure, const dea_fit *fit, const dea_fit_data *data)
{
    const size_t panel = add_panel(figure, stress_label, 1e-3, 0, stretch_label);
    for (size_t load = 0; load < DEA_LOAD_COUNT; load++) {
        const size_t step = fit->count[load] / POINTS_MAX + 1;
        size_t seen = 0;
        if (fit->count[load] == 0) {
            continue;
        }
        begin_curve(figure, panel, load, false);
        for (size_t i = 0; i < data->count; i++) {
            if (data->points[i].load == (dea_load)load && seen++ % step == 0) {
                dea_figure_point(figure, data->points[i].stretch, data->points[i].stress, 0);
            }
        }
        add_stress(figure, panel, fit->law, fit->constants, load, fmin(fit->stretch_min, 1.0), fmax(fit->stretch_max, 1.0));
        add_entry(&figure->legend, load, loads[load].title, ", measured", false, true);
        add_entry(&figure->legend, load, loads[load].title, ", fit", true, false);
    }
}

/* How a test is drawn: its axes, the factor to their unit, the curves and their names. */
typedef struct drawn_test {
    const char *across, *up;
    double factor;
    size_t curves;
    const char *titles[2];
} drawn_test;

static const drawn_test drawn_tests[DEA_TESTS] = {
    [DEA_TEST_RELAXATION] = {"Time since the end of the ramp t [s]", "Engineering stress P [kPa]", 1e-3, 1, {"uniaxial", NULL}},
    [DEA_TEST_DYNAMIC] = {"Frequency f [Hz]", "Modulus [kPa]", 1e-3, 2, {"storage", "loss"}},
    [DEA_TEST_CREEP] = {"Time since the end of the ramp t [s]", "Strain over the largest one", 1.0, 1, {"creep", NULL}},
};

/* Where a time or an angular frequency stands on the axis: log10 of the frequency; or log10(1 + t/t_1), t_1 the first time after 0,
 * which is logarithmic and yet has a place for t = 0. */
static double test_place(const dea_relaxation *fit, double at, double first)
{
    return log10(fit->kind == DEA_TEST_DYNAMIC ? 0.5 * at / DEA_PI : 1.0 + at / first);
}

/* Whole decades of the frequency, or of the time, and 0. */
static void write_tics(const dea_relaxation *fit, double first, dea_across *across)
{
    const bool swings = fit->kind == DEA_TEST_DYNAMIC;
    const double turn = swings ? 2.0 * DEA_PI : 1.0, from = swings ? across->span.low : log10(0.99 * first);
    const double to = swings ? across->span.high : log10(fit->time_max);
    int used = snprintf(across->tics, DEA_TICS, swings ? "" : "\"0\" 0");
    for (double power = ceil(from - 1e-9); power <= to + 1e-9 && used < DEA_TICS; power += 1.0) {
        char label[DEA_NUMBER_LENGTH], place[DEA_NUMBER_LENGTH];
        dea_number_text(label, pow(10.0, power), 3);
        dea_number_text(place, test_place(fit, turn * pow(10.0, power), first), 9);
        used += snprintf(across->tics + used, (size_t)(DEA_TICS - used), "%s\"%s\" %s", used > 0 ? ", " : "", label, place);
    }
}

static double largest_of(const dea_relaxation_data *data)
{
    double largest = 0.0;
    for (size_t i = 0; i < data->count; i++) {
        largest = fmax(largest, data->points[i].stress);
    }
    return largest;
}

/* A test of relaxation, of dynamic moduli or of creep: what was measured, and the fit. */
static void add_test(dea_figure *figure, const dea_relaxation *fit, const dea_relaxation_data *data)
{
    const drawn_test *drawn = &drawn_tests[fit->kind];
    const dea_relaxation_point *points = data->points;
    const bool swings = fit->kind == DEA_TEST_DYNAMIC;
    const double first = points[0].time > 0.0 ? points[0].time : points[1].time;
    const double from = swings ? test_place(fit, first, first) : 0.0, to = test_place(fit, points[data->count - 1].time, first);
    const size_t panel = add_panel(figure, drawn->up, fit->kind == DEA_TEST_CREEP ? 1.0 / largest_of(data) : drawn->factor, 1, drawn->across);
    for (size_t curve = 0; curve < drawn->curves; curve++) {
        begin_curve(figure, panel, curve, false);
        for (size_t i = 0; i < data->count; i += data->count / POINTS_MAX + 1) {
            dea_figure_point(figure, test_place(fit, points[i].time, first), curve == 0 ? points[i].stress : points[i].loss, 0);
        }
        begin_curve(figure, panel, curve, true);
        for (int i = 0; i <= CURVE_STEPS; i++) {
            const double place = from + (to - from) * i / CURVE_STEPS, power = pow(10.0, place);
            const double at = swings ? 2.0 * DEA_PI * power : first * (power - 1.0);
            dea_figure_point(figure, place, curve == 0 ? dea_relaxation_stress(fit, at) : dea_relaxation_loss(fit, at), 0);
        }
    }
    write_tics(fit, first, &figure->across[1]);
}

/* What curves and points of a test are; those of a relaxation are of the uniaxial load, and listed once. */
static void list_test(const dea_fit *fit, const dea_relaxation *test, dea_legend *legend)
{
    const bool listed = test->kind == DEA_TEST_RELAXATION && fit && fit->count[DEA_LOAD_UNIAXIAL] > 0;
    for (size_t curve = 0; !listed && curve < drawn_tests[test->kind].curves; curve++) {
        add_entry(legend, curve, drawn_tests[test->kind].titles[curve], ", measured", false, true);
        add_entry(legend, curve, drawn_tests[test->kind].titles[curve], ", fit", true, false);
    }
}

dea_status dea_plot_fit(const dea_fit *fit, const dea_fit_data *data, const dea_relaxation *relaxation,
                        const dea_relaxation_data *held, const char *path, const dea_plot_options *options, dea_error *error)
{
    dea_gnuplot picture;
    const dea_status status = dea_gnuplot_begin(&picture, path, options, error);
    if (status != DEA_OK) {
        return status;
    }
    if (picture.canvas.height == 0) {
        picture.canvas.width = fit && relaxation ? 2 * NATURAL : NATURAL;
    }
    dea_figure figure = dea_figure_begin(&picture, "", false);
    if (fit) {
        add_fit(&figure, fit, data);
    }
    if (relaxation) {
        add_test(&figure, relaxation, held);
        list_test(fit, relaxation, &figure.legend);
    }
    return finish(&figure, error);
}
