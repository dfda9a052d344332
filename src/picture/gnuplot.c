#define _GNU_SOURCE /* pipe2 */
#include "picture/gnuplot.h"

#include "support/file.h"
#include "support/number.h"
#include "support/text.h"

#include <ctype.h>
#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <spawn.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/wait.h>
#include <unistd.h>

extern char **environ;

enum { TEXT_MAX = 110, WORDS_MAX = 1000, CHARACTER_MOST = 4, WIDTH = 960, PICTURE_MOST = 1 << 30 };

static const double screen = 1.0 / 96.0;            /* a pixel of one [inch] */
static const double small_unit = 7.0 / 12.0 / 72.0;                                /* of a picture of a wanted size [inch] */
static const double wide = 18.0 / 2.54;                                            /* from here on letters grow [inch] */

/* What gnuplot calls a kind of picture. */
struct dea_picture_kind {
    const char *ending, *terminal;
    bool inches;       /* its size is in inches, else in pixels */
    double pixel[2];   /* of its letters and points [inch], without a wanted size and with one */
    double line, dash; /* what it takes for a line one pixel wide, for a dash one pixel long */
    const char *words; /* of its setting */
    bool script;       /* is the script itself, which draws a picture of that terminal */
};

static const dea_picture_kind kinds[] = {
    {".svg", "svg", false, {1.0 / 96.0, 1.0 / 96.0}, 1.0, 1.0, "background '#ffffff'", false},
    {".png", "pngcairo", false, {1.0 / 192.0, 1.0 / 300.0}, 1.0, 1.0, "", false},
    {".pdf", "pdfcairo", true, {1.0 / 72.0, 1.0 / 72.0}, 2.0, 3.5, "", false},
    {".eps", "epscairo", true, {1.0 / 72.0, 1.0 / 72.0}, 2.0, 3.5, "", false},
    {".gp", "svg", false, {1.0 / 96.0, 1.0 / 96.0}, 1.0, 1.0, "background '#ffffff'", true},
};

static dea_status gnuplot_missing(dea_error *error)
{
    return dea_fail(error, DEA_ERROR_MISSING, "pictures need the program gnuplot (Debian: package gnuplot-nox)");
}

/* Is there a gnuplot on the search path? Asked before the work, not after it. */
static bool gnuplot_found(void)
{
    const char *path = getenv("PATH");
    for (const char *folder = path ? path : "/usr/bin:/bin"; folder;) {
        const char *end = strchr(folder, ':');
        const int length = end ? (int)(end - folder) : (int)strlen(folder);
        char name[4096];
        const int used = snprintf(name, sizeof name, "%.*s/gnuplot", length, length > 0 ? folder : ".");
        if (used > 0 && (size_t)used < sizeof name && access(name, X_OK) == 0) {
            return true;
        }
        folder = end ? end + 1 : NULL;
    }
    return false;
}

static const dea_picture_kind *kind_of(const char *path)
{
    const char *dot = strrchr(path, '.');
    for (size_t i = 0; dot && i < sizeof kinds / sizeof *kinds; i++) {
        if (strcasecmp(dot, kinds[i].ending) == 0) {
            return &kinds[i];
        }
    }
    return NULL;
}

static bool is_side(double length)
{
    return length >= DEA_PLOT_SIDE_LEAST && length <= DEA_PLOT_SIDE_MOST;
}

static dea_canvas canvas_of(const dea_plot_options *options)
{
    if (!options || !(options->width > 0.0)) {
        return (dea_canvas){WIDTH, 0, screen};
    }
    const double width = options->width / 0.0254, unit = small_unit * fmax(1.0, width / wide);
    return (dea_canvas){(int)lround(width / unit), (int)lround(options->height / 0.0254 / unit), unit};
}

dea_status dea_gnuplot_begin(dea_gnuplot *picture, const char *path, const dea_plot_options *options, dea_error *error)
{
    *picture = (dea_gnuplot){.file.fd = -1, .kind = kind_of(path), .canvas = canvas_of(options)};
    if (!picture->kind) {
        const char *name = strrchr(path, '/') ? strrchr(path, '/') + 1 : path;
        return dea_fail(error, DEA_ERROR_USAGE, "%.400s: a picture ends in .svg, .png, .pdf, .eps or .gp; write for example %.*s.svg",
                        path, (int)strcspn(name, "."), name);
    }
    if (options && (options->width != 0.0 || options->height != 0.0) && !(is_side(options->width) && is_side(options->height))) {
        return dea_fail(error, DEA_ERROR_USAGE, "a picture of %g m x %g m: each side needs 0.04 m to 2 m", options->width,
                        options->height);
    }
    picture->log_x = options && options->log_x;
    picture->log_y = options && options->log_y;
    if (!picture->kind->script && !gnuplot_found()) {
        return gnuplot_missing(error);
    }
    const dea_status status = dea_atomic_open(&picture->file, path, error);
    if (status != DEA_OK) {
        return status;
    }
    picture->script = dea_scratch_open();
    if (!picture->script) {
        const int number = errno;
        dea_gnuplot_finish(picture, false, NULL);
        return dea_fail(error, DEA_ERROR_IO, "cannot make a temporary file: %s", strerror(number));
    }
    return DEA_OK;
}

/* What a script that is left says of itself, and where it draws. */
static void write_head(const dea_gnuplot *picture)
{
    const char *name = strrchr(picture->file.target, '/');
    char drawn[TEXT_MAX + 1];
    name = name ? name + 1 : picture->file.target;
    snprintf(drawn, sizeof drawn, "%.*s.svg", (int)(strlen(name) - strlen(picture->kind->ending)), name);
    dea_gnuplot_put(picture->script,
                    "# Data and drawing of a picture by deaspice: gnuplot FILE draws it. For other formats change the terminal (pngcairo,\n"
                    "# pdfcairo, epscairo) and the name of the output.\n"
                    "set output %q\n",
                    drawn);
}

/* A side of the canvas as the terminal takes it. */
static double side_of(const dea_gnuplot *picture, double units)
{
    const double inches = units * picture->canvas.unit;
    const double whole = round(inches / picture->kind->pixel[picture->canvas.height > 0]);
    return picture->kind->inches ? (whole + 0.01) / 72.0 : whole; /* of which it cuts the points */
}

void dea_gnuplot_size(dea_gnuplot *picture, int height)
{
    const dea_picture_kind *kind = picture->kind;
    const double scale = picture->canvas.unit / kind->pixel[picture->canvas.height > 0];
    const char *unit = kind->inches ? "in" : "";
    if (kind->script) {
        write_head(picture);
    }
    dea_gnuplot_put(picture->script,
                    "set encoding utf8\nset terminal %s size %g%s,%g%s font 'DejaVu Sans,12' fontscale %g linewidth %g dashlength %g "
                    "rounded noenhanced %s\nps = %g\n",
                    kind->terminal, side_of(picture, picture->canvas.width), unit, side_of(picture, height), unit, scale,
                    scale * kind->line, scale * kind->dash, kind->words, scale);
}

/* Length of the UTF-8 character at @p text, 0 where it is none that may be shown: controls, and what XML has not. */
static size_t character_length(const unsigned char *text)
{
    unsigned code = 0;
    const size_t length = dea_text_character((const char *)text, strnlen((const char *)text, CHARACTER_MOST), &code);
    return code < 0x20 || (code >= 0x7f && code < 0xa0) || code == 0xfffe || code == 0xffff ? 0 : length;
}

/* Does an ASCII character stand for itself in a quoted string? Quotes, backticks, macros and backslashes do not, nor what a shell
 * or a format could take for its own. */
static bool is_plain(unsigned char letter)
{
    return letter == ' ' || isalnum(letter) || strchr(".,:;=()[]+-/_<>", letter);
}

/* What is not plain ASCII or a whole character beyond it is written as an octal escape, and so is a digit behind one: gnuplot
 * reads an octal number as long as digits follow. */
static void write_text(FILE *script, const char *text)
{
    const unsigned char *next = (const unsigned char *)text;
    int brackets = 0;
    bool escaped = false;
    fputc('"', script);
    for (int shown = 0; *next; shown++) {
        if (shown == TEXT_MAX) {
            fputs("\xe2\x80\xa6", script); /* an ellipsis */
            break;
        }
        const size_t length = character_length(next);
        if (*next == '>' && brackets > 1) {
            fputs("\xe2\x81\xa0", script); /* a word joiner, which has no width: XML keeps "]]>" for itself */
        }
        if (length > 1 || (length == 1 && is_plain(*next) && !(escaped && isdigit(*next)))) {
            fwrite(next, 1, length, script);
            escaped = false;
        } else if (length == 1) {
            fprintf(script, "\\%03o", *next);
            escaped = true;
        }
        brackets = *next == ']' ? brackets + 1 : length > 0 ? 0 : brackets;
        next += length > 0 ? length : 1;
    }
    fputc('"', script);
}

void dea_gnuplot_put(FILE *script, const char *format, ...)
{
    va_list values;
    va_start(values, format);
    for (; *format; format++) {
        if (*format != '%') {
            fputc(*format, script);
        } else if (*++format == 'g') {
            char text[DEA_NUMBER_LENGTH];
            const double value = va_arg(values, double);
            fputs(isfinite(value) ? dea_number_text(text, value, 9) : "NaN", script);
        } else if (*format == 'q') {
            write_text(script, va_arg(values, const char *));
        } else if (*format == 's') {
            fputs(va_arg(values, const char *), script);
        } else if (*format == 'd') {
            fprintf(script, "%d", va_arg(values, int));
        } else if (*format == 'z') {
            fprintf(script, "%zu", va_arg(values, size_t));
        } else {
            fputc(*format, script); /* %% */
        }
    }
    va_end(values);
}

/* Starts gnuplot, from a file into a pipe and its words into another file. Its standard input it reads byte by byte unless it opens it by
 * name, which takes a third of the time and tells the line of a fault. */
static dea_status gnuplot_spawn(FILE *script, int picture, FILE *words, pid_t *child, dea_error *error)
{
    char *const arguments[] = {"gnuplot", "-d", "/dev/stdin", NULL};
    posix_spawn_file_actions_t actions;
    if (posix_spawn_file_actions_init(&actions) != 0) {
        return dea_fail(error, DEA_ERROR_MEMORY, "out of memory");
    }
    int failed = posix_spawn_file_actions_adddup2(&actions, fileno(script), STDIN_FILENO);
    failed = failed ? failed : posix_spawn_file_actions_adddup2(&actions, picture, STDOUT_FILENO);
    failed = failed ? failed : posix_spawn_file_actions_adddup2(&actions, fileno(words), STDERR_FILENO);
    failed = failed ? failed : posix_spawnp(child, arguments[0], &actions, NULL, arguments, environ);
    posix_spawn_file_actions_destroy(&actions);
    if (failed == ENOENT) {
        return gnuplot_missing(error);
    }
    return failed ? dea_fail(error, DEA_ERROR_ENGINE, "cannot start gnuplot: %s", strerror(failed)) : DEA_OK;
}

/* Takes in what gnuplot draws, malloc'd, and waits for its end. It looks at none of its writes and goes on behind one that failed;
 * those into a pipe cannot fail while its other end is read. */
static dea_status gnuplot_run(FILE *script, FILE *words, char **bytes, size_t *size, int *ended, dea_error *error)
{
    int ends[2];
    pid_t child;
    if (pipe2(ends, O_CLOEXEC) != 0) {
        return dea_fail(error, DEA_ERROR_IO, "cannot make a pipe for gnuplot: %s", strerror(errno));
    }
    const dea_status status = gnuplot_spawn(script, ends[1], words, &child, error);
    close(ends[1]);
    const int failed = status == DEA_OK ? dea_file_drain(ends[0], PICTURE_MOST, bytes, size) : 0;
    close(ends[0]); /* ends a gnuplot that draws too much */
    while (status == DEA_OK && waitpid(child, ended, 0) < 0) {
        if (errno != EINTR) {
            return dea_fail(error, DEA_ERROR_ENGINE, "cannot wait for gnuplot: %s", strerror(errno));
        }
    }
    return failed ? dea_fail(error, DEA_ERROR_IO, "cannot read the picture: %s", strerror(failed)) : status;
}

/* What gnuplot said, as an error. */
static dea_status gnuplot_complain(FILE *words, int ended, dea_error *error)
{
    char said[WORDS_MAX + 1];
    rewind(words);
    size_t length = fread(said, 1, WORDS_MAX, words);
    while (length > 0 && isspace((unsigned char)said[length - 1])) {
        length--;
    }
    said[length] = '\0';
    for (char *letter = said; *letter; letter++) {
        *letter = (unsigned char)*letter < 0x20 && *letter != '\n' ? ' ' : *letter;
    }
    if (WIFSIGNALED(ended)) {
        return dea_fail(error, DEA_ERROR_ENGINE, "gnuplot was ended by signal %d\n%s", WTERMSIG(ended), said);
    }
    return dea_fail(error, DEA_ERROR_ENGINE, "gnuplot failed (exit status %d)\n%s", WEXITSTATUS(ended), said);
}

/* Draws the script into malloc'd bytes. */
static dea_status script_draw(FILE *script, char **bytes, size_t *size, dea_error *error)
{
    FILE *words = dea_scratch_open();
    int ended = 0;
    dea_status status = DEA_OK;
    if (!words) {
        return dea_fail(error, DEA_ERROR_IO, "cannot write a temporary file for gnuplot: %s", strerror(errno));
    }
    status = gnuplot_run(script, words, bytes, size, &ended, error);
    if (status == DEA_OK && (!WIFEXITED(ended) || WEXITSTATUS(ended) != 0)) {
        status = gnuplot_complain(words, ended, error);
    }
    fclose(words);
    return status;
}

/* The picture, malloc'd: drawn, or the script itself. */
static dea_status gnuplot_make(dea_gnuplot *picture, char **bytes, size_t *size, dea_error *error)
{
    FILE *script = picture->script;
    fputs("unset multiplot\nunset output\n", script);
    if (fflush(script) != 0 || ferror(script) || lseek(fileno(script), 0, SEEK_SET) != 0) {
        return dea_fail(error, DEA_ERROR_IO, "cannot write a temporary file: %s", strerror(errno));
    }
    if (!picture->kind->script) {
        return script_draw(script, bytes, size, error);
    }
    const int failed = dea_file_drain(fileno(script), PICTURE_MOST, bytes, size);
    return failed ? dea_fail(error, DEA_ERROR_IO, "cannot read a temporary file: %s", strerror(failed)) : DEA_OK;
}

static dea_status gnuplot_draw(dea_gnuplot *picture, dea_error *error)
{
    char *bytes = NULL;
    size_t size = 0;
    dea_status status = gnuplot_make(picture, &bytes, &size, error);
    status = status ? status : dea_atomic_write(&picture->file, bytes, size, error);
    free(bytes);
    return status;
}

dea_status dea_gnuplot_finish(dea_gnuplot *picture, bool keep, dea_error *error)
{
    dea_status status = DEA_OK;
    if (keep && picture->script) {
        status = gnuplot_draw(picture, error);
    }
    if (picture->script) {
        fclose(picture->script);
        picture->script = NULL;
    }
    const dea_status closed = dea_atomic_close(&picture->file, keep && status == DEA_OK, error);
    return status != DEA_OK ? status : closed;
}
