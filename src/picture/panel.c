#include "picture/panel.h"

#include "support/text.h"

#include <math.h>

enum {
    STOPS = 9,          /* of a palette */
    TITLE_LETTERS = 12, /* height */
    ACROSS = 40,        /* room of a tic with its label along x, and along others */
    UP = 17
};

void dea_plot_gradient(double share, char colour[8])
{
    static const unsigned char stops[][3] = {{68, 1, 84}, {59, 82, 139}, {33, 145, 140}, {94, 201, 98}, {253, 231, 37}};
    const double place = fmin(fmax(share, 0.0), 1.0) * 4.0;
    const int stop = place >= 4.0 ? 3 : (int)place;
    unsigned mixed[3];
    for (int i = 0; i < 3; i++) {
        mixed[i] = (unsigned)lround(stops[stop][i] + (place - stop) * (stops[stop + 1][i] - stops[stop][i])) & 0xffu;
    }
    snprintf(colour, 8, "#%02x%02x%02x", mixed[0], mixed[1], mixed[2]);
}

const char *dea_plot_dash(size_t number)
{
    static const char *const dashes[] = {"dashtype solid",           "dashtype (8, 5)",  "dashtype (0.5, 4)",
                                         "dashtype (8, 4, 0.5, 4)",  "dashtype (16, 6)", "dashtype (8, 4, 0.5, 4, 0.5, 4)",
                                         "dashtype (4, 4)",          "dashtype (16, 5, 4, 5)"};
    return dashes[(number - 1) % (sizeof dashes / sizeof *dashes)];
}

void dea_plot_style(FILE *script)
{
    fputs("set format '%h'\n"
          "set border 15 linewidth 0.8 linecolor '#404040'\n"
          "set tics nomirror in scale 0.6 textcolor '#202020'\n"
          "set grid linetype 1 linewidth 0.5 linecolor '#e2e2e2'\n"
          "set xlabel textcolor '#202020'\nset ylabel textcolor '#202020'\n",
          script);
}

void dea_plot_place(FILE *script, int width, int height, dea_box box)
{
    const struct {
        const char *name;
        double share;
    } margins[] = {
        {"lmargin", box.left / width},
        {"rmargin", (box.left + box.width) / width},
        {"tmargin", 1.0 - box.top / height},
        {"bmargin", 1.0 - (box.top + box.height) / height},
    };
    for (size_t i = 0; i < sizeof margins / sizeof *margins; i++) {
        dea_gnuplot_put(script, "set %s at screen %g\n", margins[i].name, margins[i].share);
    }
}

void dea_plot_palette(FILE *script, double end)
{
    fputs("set palette defined (", script);
    for (int i = 0; i < STOPS; i++) {
        char colour[8];
        dea_plot_gradient(end * i / (STOPS - 1.0), colour);
        fprintf(script, "%s%d '%s'", i > 0 ? ", " : "", i, colour);
    }
    fputs(")\n", script);
}

double dea_plot_top(const char *title)
{
    return *title ? DEA_TITLE : DEA_NO_TITLE;
}

/* A title that is wider than its canvas gets smaller letters, to two thirds of them. */
void dea_plot_title(FILE *script, const char *title, int width, int height)
{
    fputs("set datafile missing 'NaN'\nset datafile separator whitespace\nunset key\nset multiplot\n", script);
    const double fitting = (width - 16.0) / (0.66 * (double)(dea_text_letters(title) + 1));
    if (*title) {
        dea_gnuplot_put(script, "set label 2 %q at screen 0.5, screen %g center font ',%g'\n", title, 1.0 - 17.0 / height,
                        fmin(TITLE_LETTERS, fmax(fitting, TITLE_LETTERS * 2.0 / 3.0)));
    }
}

dea_status dea_plot_cramped(dea_canvas canvas, dea_error *error)
{
    return dea_fail(error, DEA_ERROR_USAGE, "%.3g cm x %.3g cm are too little for this picture: its panels would have no room",
                    2.54 * canvas.unit * canvas.width, 2.54 * canvas.unit * canvas.height);
}

void dea_span_take(dea_span *span, double value)
{
    if (isfinite(value) && (value > 0.0 || !span->logarithmic)) {
        span->low = fmin(span->low, value);
        span->high = fmax(span->high, value);
    }
}

void dea_span_pad(dea_span *span, bool floats)
{
    static const double share = 0.06;
    if (!(span->low <= span->high)) {
        span->low = 1.0;
        span->high = 10.0;
    }
    if (span->logarithmic) {
        const double factor = pow(span->high > span->low ? span->high / span->low : 10.0, share);
        span->low /= factor;
        span->high *= factor;
        return;
    }
    const double width = span->high - span->low;
    const double pad = width > 0.0 ? share * width : span->low != 0.0 ? 0.1 * fabs(span->low) : 1.0;
    span->low -= span->low != 0.0 || floats || !(width > 0.0) ? pad : 0.0;
    span->high += span->high != 0.0 || floats || !(width > 0.0) ? pad : 0.0;
}

double dea_span_share(const dea_span *span, double value)
{
    if (!(span->high > span->low) || (span->logarithmic && !(value > 0.0))) {
        return 0.0;
    }
    return span->logarithmic ? log(value / span->low) / log(span->high / span->low) : (value - span->low) / (span->high - span->low);
}

void dea_span_limit(dea_span *span)
{
    span->low = span->logarithmic ? fmax(span->low, 1e-8 * span->high) : span->low;
}

void dea_name_none(double value, char text[DEA_LABEL_LENGTH])
{
    (void)value;
    *text = '\0';
}

void dea_name_power(double value, char text[DEA_LABEL_LENGTH])
{
    static const char *const digits[] = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
    const int decade = (int)floor(log10(value) + 1e-9), size = (decade < 0 ? -decade : decade) % 100;
    const double number = value / pow(10.0, decade);
    char before[16] = "";
    if (number > 1.5) {
        snprintf(before, sizeof before, "%.0f·", number);
    }
    snprintf(text, DEA_LABEL_LENGTH, "%s10%s%s%s", before, decade < 0 ? "⁻" : "", size > 9 ? digits[size / 10] : "",
             digits[size % 10]);
}

void dea_name_plain(double value, char text[DEA_LABEL_LENGTH])
{
    if (value < 0.9e-2 || value >= 1e4) {
        dea_name_power(value, text);
    } else {
        snprintf(text, DEA_LABEL_LENGTH, "%.4g", value);
    }
}

void dea_name_prefixed(double value, char text[DEA_LABEL_LENGTH])
{
    static const char *const prefixes[] = {"p", "n", "µ", "m", "", "k", "M", "G", "T"};
    const int step = (int)fmin(fmax(floor(log10(value) / 3.0 + 1e-9), -4.0), 4.0);
    snprintf(text, DEA_LABEL_LENGTH, "%.3g%s", value * pow(10.0, -3.0 * step), prefixes[step + 4]);
}

static const double few_decades = 2.5;

/* Is a number of a decade named? The decade alone, or on a short axis 2 and 5, or all, where a decade has room for so many labels. */
static bool is_named(int number, int decade, int step, double room, double decades)
{
    if (number == 1) {
        return decade % step == 0;
    }
    if (decades > few_decades) {
        return false;
    }
    return room >= 12.0 || (room >= 3.0 && (number == 2 || number == 5));
}

/* Smallest of 1, 2, 5 times a power of ten that is not below @p least > 0. */
static double step_choose(double least)
{
    const double power = pow(10.0, floor(log10(least)));
    const double rest = least / power;
    return power * (rest <= 1.0 ? 1.0 : rest <= 2.0 ? 2.0 : rest <= 5.0 ? 5.0 : 10.0);
}

void dea_span_steps(FILE *script, const char *axis, const dea_span *span, double count)
{
    double step = step_choose((span->high - span->low) / fmax(1.0, count));
    while (floor(span->high / step) - ceil(span->low / step) < 1.0) {
        const double digit = step / pow(10.0, floor(log10(step) + 1e-9));
        step *= digit > 4.5 ? 0.8 : 0.5;
    }
    dea_gnuplot_put(script, "set %stics %g\n", axis, step);
}

static bool needs_tenths(const dea_span *span)
{
    return log10(span->high / span->low) < 0.3;
}

void dea_span_tics(FILE *script, const char *axis, const dea_span *span, double length, dea_name *name, bool placed)
{
    const double low = log10(span->low), high = log10(span->high);
    const int first = (int)floor(low), last = (int)floor(high);
    const double room = length / (high - low) / (*axis == 'x' ? ACROSS : UP);
    const int step = room > 1.0 ? 1 : 1 + (int)(1.0 / room);
    const char *before = "(";
    fprintf(script, "set %stics ", axis);
    for (int decade = first; decade <= last; decade++) {
        for (int number = 1; number <= 9; number++) {
            const double value = number * pow(10.0, decade), place = log10(value);
            const bool named = is_named(number, decade, step, room, high - low);
            char text[DEA_LABEL_LENGTH] = "";
            if (place < low - 1e-9 || place > high + 1e-9 || (!named && step > 1 && number > 1)) {
                continue;
            }
            if (named) {
                name(value, text);
            }
            dea_gnuplot_put(script, "%s%q %g%s", before, text, placed ? place : value, named ? "" : " 1");
            before = ", ";
        }
    }
    fputs(*before == '(' ? "autofreq\n" : ")\n", script);
}

void dea_span_write(FILE *script, const char *axis, const dea_span *span, double length, dea_name *name)
{
    dea_gnuplot_put(script, "set %srange [%g:%g]\nset format %s '%%h'\n%sset logscale %s\n", axis, span->low, span->high, axis,
                    span->logarithmic ? "" : "un", axis);
    if (span->logarithmic && !needs_tenths(span)) {
        dea_span_tics(script, axis, span, length, name, false);
    } else if (span->logarithmic) {
        fprintf(script, "set %stics autofreq\n", axis);
    } else {
        dea_span_steps(script, axis, span, length / (*axis == 'x' ? 1.3 * ACROSS : 2.0 * UP));
    }
}

bool dea_axis_logarithmic(const dea_axis *axis)
{
    const double *values = axis->values;
    const size_t count = axis->count;
    if (axis->uniform || count < 4 || !(values[0] > 0.0) || !(values[count - 1] >= 100.0 * values[0])) {
        return false;
    }
    const double ratio = pow(values[count - 1] / values[0], 1.0 / (double)(count - 1));
    for (size_t i = 1; i < count; i++) {
        if (!(fabs(values[i] / (values[i - 1] * ratio) - 1.0) < 0.05)) {
            return false;
        }
    }
    return true;
}
