/* Panels of a picture: their places on the canvas, axes and tics, colours and dashes. */
#ifndef DEASPICE_PICTURE_PANEL_H
#define DEASPICE_PICTURE_PANEL_H

#include "deaspice/scene.h"
#include "picture/gnuplot.h"
#include "picture/label.h"

#include <stdbool.h>

/* Room above the panels, with a title and without. */
enum { DEA_TITLE = 54, DEA_NO_TITLE = 28 };

/* Numbers along an axis, as drawn. Empty: low above high. */
typedef struct dea_span {
    double low, high;
    bool logarithmic; /* numbers at or below zero do not count */
} dea_span;

/* Text of a tic. */
typedef void dea_name(double value, char text[DEA_LABEL_LENGTH]);

/* Colours of a map and of many curves, dark to light, 0 <= share <= 1. */
void dea_plot_gradient(double share, char colour[8]);
/* "dashtype ..." of curves of one kind, from 1; number 1 is solid. */
const char *dea_plot_dash(size_t number);
/* Lines of a script that every picture begins with: tics, grid, border. */
void dea_plot_style(FILE *script);
/* Sets the palette to the gradient up to @p end. */
void dea_plot_palette(FILE *script, double end);
/* Begins a multiplot with a title over it, none where it is empty. It is label 2, to be unset behind the first panel. */
void dea_plot_title(FILE *script, const char *title, int width, int height);
/* Room above the panels. */
double dea_plot_top(const char *title);
/* Puts the next panel into a box of a canvas of that size. */
void dea_plot_place(FILE *script, int width, int height, dea_box box);
/* Fails for a canvas that leaves a panel no room. */
dea_status dea_plot_cramped(dea_canvas canvas, dea_error *error);

/* Widens a span by a number; those that are none, or have no logarithm, are passed over. */
void dea_span_take(dea_span *span, double value);
/* Share of the way along a span at which a number stands; 0 where it has no place. */
double dea_span_share(const dea_span *span, double value);
/* Leaves room beyond the numbers, so that none lies on the frame: below zero only where @p floats. A single number gets a range. */
void dea_span_pad(dea_span *span, bool floats);
/* Sets range and kind of the axis named @p axis ("x", "y", "y2", "cb") that is @p length units long, and the tics of a logarithmic
 * one: at the decades, and at 2 and 5 or all numbers between them on a short one. */
void dea_span_write(FILE *script, const char *axis, const dea_span *span, double length, dea_name *name);
/* Writes those tics alone, at the logarithms of their numbers where @p placed. */
void dea_span_tics(FILE *script, const char *axis, const dea_span *span, double length, dea_name *name, bool placed);
/* Sets tics of a linear axis in steps of 1, 2 or 5 times a power of ten, @p count steps at most and two tics at least. */
void dea_span_steps(FILE *script, const char *axis, const dea_span *span, double count);
/* Drops what lies more than eight decades below the top of a logarithmic span: rounding has numbers there too. */
void dea_span_limit(dea_span *span);
/* Names of tics: none, "10⁻²", "0.01", and with a prefix, "2k". */
void dea_name_power(double value, char text[DEA_LABEL_LENGTH]);
void dea_name_none(double value, char text[DEA_LABEL_LENGTH]);
void dea_name_plain(double value, char text[DEA_LABEL_LENGTH]);
void dea_name_prefixed(double value, char text[DEA_LABEL_LENGTH]);
/* Positive values with a constant ratio over two decades or more ask for a logarithmic axis. */
bool dea_axis_logarithmic(const dea_axis *axis);

#endif
