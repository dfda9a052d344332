#include "netlist/curve_cards.h"

#include <math.h>
#include <stdio.h>

bool dea_signal_curves(const dea_signal *signal)
{
    for (size_t i = 0; i < signal->count; i++) {
        if (signal->segments[i].sine) {
            return true;
        }
    }
    return false;
}

bool dea_curve_cards_fit(const dea_signal *signal)
{
    size_t curves = 0;
    for (size_t i = 0; i < signal->count; i++) {
        curves += signal->segments[i].sine;
    }
    return curves <= DEA_CURVE_CARDS_MAX;
}

static bool is_steady(const dea_curve *curve)
{
    for (size_t i = 0; i < curve->count; i++) {
        if (curve->tones[i].rate != 0.0 || curve->tones[i].growth != 0.0) {
            return false;
        }
    }
    return true;
}

/* The one curved segment, at the end of the netlist; NULL: there are several, or one that ends before. */
static const dea_segment *last_alone(const dea_curve_cards *c)
{
    const dea_segment *last = &c->signal->segments[c->first + c->count - 1];
    size_t curves = 0;
    for (size_t i = 0; i < c->count; i++) {
        curves += c->signal->segments[c->first + i].sine;
    }
    return curves == 1 && last->sine ? last : NULL;
}

/* Sources in series, the offset in the first of them. */
static void write_sines(const dea_curve_cards *c, const dea_segment *segment)
{
    const dea_curve *curve = &c->signal->curve;
    const double from = fmax(segment->from, c->begin);
    for (size_t i = 0; i < curve->count; i++) {
        const dea_tone *tone = &curve->tones[i];
        const double turns = tone->frequency * (from - segment->origin);
        const double phase = 360.0 * (turns - floor(turns)) + tone->phase * 180.0 / DEA_PI;
        const double numbers[] = {i > 0 ? 0.0 : curve->offset, tone->amplitude, tone->frequency, from - c->begin, 0.0, phase};
        char plus[32], minus[32] = "0";
        char name[32] = "SOURCE";
        snprintf(plus, sizeof plus, "%.20s", c->node);
        if (i > 0) {
            snprintf(name, sizeof name, "WAVE%zu", i);
            snprintf(plus, sizeof plus, "wave%zu", i);
        }
        if (i + 1 < curve->count) {
            snprintf(minus, sizeof minus, "wave%zu", i + 1);
        }
        fprintf(c->out, "V%s %s %s sin(", name, plus, minus);
        for (size_t k = 0; k < sizeof numbers / sizeof *numbers; k++) {
            fputs(k > 0 ? " " : "", c->out);
            dea_part_number(c->out, numbers[k]);
        }
        fputs(")\n", c->out);
    }
}

/* Age within a segment, as the netlist's time has it: constant before and behind. */
static void write_age(const dea_curve_cards *c, const dea_segment *segment)
{
    dea_part_print(c->out, "min(max(time-(%g),0),%g)",
                   fmax(segment->from, c->begin) - c->begin, segment->to - fmax(segment->from, c->begin));
}

/* sin(phase + 2 pi turns) of one tone. */
static void write_tone(const dea_curve_cards *c, const dea_segment *segment, const dea_tone *whole)
{
    const dea_tone tone = dea_tone_from(whole, fmax(segment->from, c->begin) - segment->origin);
    dea_part_print(c->out, "%g*sin(%g+(", tone.amplitude, tone.phase);
    if (tone.growth != 0.0) {
        dea_part_print(c->out, "%g)*(exp((%g)*", 2.0 * DEA_PI * tone.frequency / tone.growth, tone.growth);
        write_age(c, segment);
        fputs(")-1))", c->out);
        return;
    }
    dea_part_print(c->out, "%g+(%g)*", 2.0 * DEA_PI * tone.frequency, DEA_PI * tone.rate);
    write_age(c, segment);
    fputs(")*", c->out);
    write_age(c, segment);
    fputc(')', c->out);
}

/* Behavioural sources in series, one a segment: all but the first begin and end where they add nothing. */
static void write_chain(const dea_curve_cards *c)
{
    const dea_curve *curve = &c->signal->curve;
    size_t links = 0;
    dea_part_print(c->out, "VSOURCE %s wave0 %g\n", c->node, curve->offset);
    for (size_t i = c->first; i < c->first + c->count; i++) {
        const dea_segment *segment = &c->signal->segments[i];
        if (!segment->sine) {
            continue;
        }
        char name[24], plus[24], minus[24];
        snprintf(name, sizeof name, "wave%zu", links);
        snprintf(plus, sizeof plus, "wave%zu", links);
        snprintf(minus, sizeof minus, "wave%zu", ++links);
        dea_dialect_source_begin(c->dialect, c->out, DEA_VOLTAGE, name, plus, minus);
        for (size_t k = 0; k < curve->count; k++) {
            fputs(k > 0 ? "+" : "", c->out);
            write_tone(c, segment, &curve->tones[k]);
        }
        dea_dialect_source_end(c->dialect, c->out);
    }
    fprintf(c->out, "VWAVES wave%zu 0 0\n", links);
}

/* Makes begin and end of the curves time points. */
static void write_corners(const dea_curve_cards *c)
{
    const dea_segment *end = &c->signal->segments[c->first + c->count - 1];
    fputs("* makes begin and end of the curves time points\nVDELAY delay 0 pwl(0 0", c->out);
    for (size_t i = c->first + 1; i < c->first + c->count; i++) {
        fputs(i % 4 == 0 ? "\n+ " : " ", c->out);
        dea_part_print(c->out, "%g 0", c->signal->segments[i].from - c->begin);
    }
    dea_part_print(c->out, " %g 0)\nRDELAY delay 0 1\n",
                   end->to - c->begin + (c->signal->segments[c->first + 1].from - c->begin));
}

void dea_curve_cards_write(const dea_curve_cards *c)
{
    const dea_segment *alone = last_alone(c);
    if (alone && is_steady(&c->signal->curve)) {
        write_sines(c, alone);
    } else {
        write_chain(c);
    }
    if (c->count > 1) {
        write_corners(c);
    }
}
