#include "picture/legend.h"

#include "picture/gnuplot.h"
#include "picture/panel.h"
#include "support/text.h"

static const double sample = 34.0;   /* length of a line */
static const double apart = 8.0;     /* from the line to its text */
static const double gap = 26.0;      /* from a text to the next line */
static const double margin = 20.0;   /* beside a row, both sides together */
static const double character = 8.2; /* mean width of one */

dea_legend_entry *dea_legend_add(dea_legend *legend)
{
    legend->count += legend->count < DEA_LEGEND_ENTRIES;
    dea_legend_entry *entry = &legend->entries[legend->count - 1];
    *entry = (dea_legend_entry){.label = ""};
    return entry;
}

static double entry_room(const dea_legend_entry *entry)
{
    return sample + apart + character * (double)dea_text_letters(entry->label) + gap;
}

static double room_of(const dea_legend *legend, size_t from, size_t to)
{
    double room = 0.0;
    for (size_t i = from; i < to; i++) {
        room += entry_room(&legend->entries[i]);
    }
    return room;
}

/* End of the row that begins with entry @p from: all that is left where it fits, else as much of one kind as fits. */
static size_t row_end(const dea_legend *legend, const size_t *kinds, size_t kind_count, size_t from, int width)
{
    if (room_of(legend, from, legend->count) <= width - margin) {
        return legend->count;
    }
    size_t end = legend->count;
    for (size_t kind = kind_count; kind > 0 && kinds[kind] > from; kind--) {
        end = kinds[kind];
    }
    while (end > from + 1 && room_of(legend, from, end) > width - margin) {
        end--;
    }
    return end;
}

int dea_legend_lay(dea_legend *legend, const size_t *kinds, size_t kind_count, int width)
{
    double y = 0.0;
    for (size_t from = 0; from < legend->count; y -= DEA_LEGEND_ROW) {
        const size_t end = row_end(legend, kinds, kind_count, from, width);
        double x = 0.5 * (width + margin - room_of(legend, from, end));
        for (; from < end; from++) {
            legend->entries[from].x = x;
            legend->entries[from].y = y;
            x += entry_room(&legend->entries[from]);
        }
    }
    for (size_t i = 0; i < legend->count; i++) {
        legend->entries[i].y += 8.0 - y - DEA_LEGEND_ROW / 2.0;
    }
    return (int)-y + (y < 0.0 ? 8 : 0);
}

/* Data of one entry: the middle of its sample, then its ends. */
static void write_sample(FILE *script, const dea_legend_entry *entry, size_t number)
{
    dea_gnuplot_put(script, "$point%z << END\n%g %g\nEND\n", number, entry->x + sample / 2.0, entry->y);
    dea_gnuplot_put(script, "$line%z << END\n%g %g\n%g %g\nEND\n", number, entry->x, entry->y, entry->x + sample, entry->y);
    dea_gnuplot_put(script, "set label %z %q at %g, %g left textcolor '#202020'\n", number + 1, entry->label,
                    entry->x + sample + apart, entry->y);
}

void dea_legend_draw(const dea_legend *legend, FILE *script, int width, int height)
{
    if (legend->count == 0) {
        return;
    }
    fprintf(
        script,
        "unset label\nunset colorbox\nunset title\nunset xlabel\nunset ylabel\nunset border\nunset tics\nunset grid\nunset logscale\nunset key\n"
        "set xrange [0:%d]\nset yrange [0:%d]\n"
        "set lmargin at screen 0\nset rmargin at screen 1\nset bmargin at screen 0\nset tmargin at screen 1\n",
        width, height);
    for (size_t i = 0; i < legend->count; i++) {
        write_sample(script, &legend->entries[i], i);
    }
    const char *before = "plot ";
    for (size_t i = 0; i < legend->count; i++) {
        const dea_legend_entry *entry = &legend->entries[i];
        if (entry->dash > 0) {
            fprintf(script, "%s$line%zu using 1:2 with lines linewidth 1.8 linecolor '%s' %s", before, i, entry->colour,
                    dea_plot_dash(entry->dash));
            before = ", \\\n ";
        }
        if (entry->symbol > 0) {
            fprintf(script, "%s$point%zu using 1:2 with points pointtype %d pointsize 0.8*ps linewidth 1.3 linecolor '%s'", before,
                    i, entry->symbol, entry->colour);
            before = ", \\\n ";
        }
    }
    fputc('\n', script);
}
