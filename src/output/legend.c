#include "output/legend.h"

#include "output/gnuplot.h"
#include "output/picture.h"

static const double sample = 34.0;   /* length of a line */
static const double apart = 8.0;     /* from the line to its text */
static const double gap = 26.0;      /* from a text to the next line */
static const double character = 8.2; /* mean width of one */

enum { FIRST_TAG = 100 };

double dea_legend_room(const dea_legend_entry *entry)
{
    size_t letters = 0;
    for (const char *byte = entry->label; *byte; byte++) {
        letters += ((unsigned char)*byte & 0xc0) != 0x80;
    }
    return sample + apart + character * (double)letters + gap;
}

static void write_place(const dea_legend *legend, double x, double y)
{
    fputs(" screen ", legend->script);
    dea_gnuplot_number(legend->script, x / legend->width);
    fputs(", screen ", legend->script);
    dea_gnuplot_number(legend->script, y / legend->height);
}

void dea_legend_put(dea_legend *legend, const dea_legend_entry *entry, double x, double y)
{
    FILE *script = legend->script;
    const int tag = FIRST_TAG + 2 * legend->next++;
    if (entry->dash > 0) {
        fprintf(script, "set arrow %d from", tag);
        write_place(legend, x, y);
        fputs(" to", script);
        write_place(legend, x + sample, y);
        fputs(" nohead front ", script);
        dea_plot_dash(script, entry->dash);
        fprintf(script, " linewidth 1.8 linecolor '%s'\n", entry->colour);
    }
    if (entry->symbol > 0) {
        fprintf(script, "set label %d '' at", tag);
        write_place(legend, x + sample / 2.0, y);
        fprintf(script, " point pointtype %d pointsize 0.8 linewidth 1.3 linecolor '%s'\n", entry->symbol, entry->colour);
    }
    fprintf(script, "set label %d ", tag + 1);
    dea_gnuplot_text(script, entry->label);
    fputs(" at", script);
    write_place(legend, x + sample + apart, y);
    fputs(" left front textcolor '#202020'\n", script);
}

void dea_legend_clear(dea_legend *legend)
{
    for (int tag = FIRST_TAG; tag < FIRST_TAG + 2 * legend->next; tag++) {
        fprintf(legend->script, "unset arrow %d\nunset label %d\n", tag, tag);
    }
    legend->next = 0;
}
