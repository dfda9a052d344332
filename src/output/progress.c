#include "output/progress.h"
#include "support/clock.h"

#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { BAR_WIDTH = 30, TEXT_LENGTH = 320 };

struct dea_progress {
    bool coloured;      /* false where NO_COLOR is set */
    bool shown;         /* a bar stands on the line */
    size_t before;      /* work that was done before the bar began */
    double begun, last; /* times of the start and of the latest bar [s] */
};

static const double interval = 0.1; /* between two bars [s] */
static const double patience = 0.3; /* work that is over by then never shows a bar [s] */

dea_progress *dea_progress_begin(void)
{
    const char *terminal = getenv("TERM");
    const char *plain = getenv("NO_COLOR");
    if (!isatty(STDERR_FILENO) || !terminal || strcmp(terminal, "dumb") == 0) {
        return NULL;
    }
    dea_progress *bar = calloc(1, sizeof *bar);
    if (bar) {
        *bar = (dea_progress){.coloured = !plain || !*plain, .begun = dea_clock()};
    }
    return bar;
}

void dea_progress_from(dea_progress *bar, size_t done)
{
    if (bar) {
        bar->before = done;
    }
}

static void bar_write(const char *text, size_t length)
{
    const ssize_t written = write(STDERR_FILENO, text, length);
    (void)written; /* a bar that cannot be shown is no failure */
}

/* "12 s", "3 min 20 s" or "2 h 05 min". */
static void duration_text(double seconds, char text[32])
{
    const long whole = seconds < 3.6e8 ? (long)(seconds + 0.5) : 360000000L;
    if (whole < 60) {
        snprintf(text, 32, "%ld s", whole);
    } else if (whole < 3600) {
        snprintf(text, 32, "%ld min %02ld s", whole / 60, whole % 60);
    } else {
        snprintf(text, 32, "%ld h %02ld min", whole / 3600, whole / 60 % 60);
    }
}

void dea_progress_show(dea_progress *bar, size_t done, size_t total)
{
    if (!bar || total == 0) {
        return;
    }
    const double now = dea_clock(), spent = now - bar->begun;
    if (spent < patience || now - bar->last < interval) {
        return;
    }
    const double share = done < total ? (double)done / (double)total : 1.0;
    const int full = (int)(share * BAR_WIDTH);
    char left[32] = "?", text[TEXT_LENGTH], filled[BAR_WIDTH + 1], rest[BAR_WIDTH + 1];
    if (done > bar->before) {
        duration_text(spent * (double)(total - done) / (double)(done - bar->before), left);
    }
    memset(filled, '=', sizeof filled);
    memset(rest, ' ', sizeof rest);
    filled[full] = '\0';
    rest[BAR_WIDTH - full] = '\0';
    const int length = snprintf(text, sizeof text, "\r[%s%s%s%s] %3d %%  %zu/%zu  %s left\033[K", bar->coloured ? "\033[36m" : "",
                                filled, bar->coloured ? "\033[0m" : "", rest, (int)(100.0 * share), done, total, left);
    bar_write(text, (size_t)length);
    bar->last = now;
    bar->shown = true;
}

void dea_progress_clear(dea_progress *bar)
{
    if (bar && bar->shown) {
        bar_write("\r\033[K", 4);
        bar->shown = false;
        bar->last = 0.0;
    }
}

void dea_progress_end(dea_progress *bar)
{
    dea_progress_clear(bar);
    free(bar);
}
