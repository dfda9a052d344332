#define _GNU_SOURCE /* memmem */
#include "output/gnuplot.h"

#include "output/image.h"
#include "support/number.h"
#include "support/scratch.h"
#include "support/text.h"

#include <ctype.h>
#include <errno.h>
#include <math.h>
#include <spawn.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/wait.h>
#include <unistd.h>

extern char **environ;

enum { TEXT_MAX = 110, WORDS_MAX = 1000, CHARACTER_MOST = 4, WIDTH = 960 };

static const double screen = 1.0 / 96.0;            /* a pixel of one [inch] */
static const double small_unit = 7.0 / 12.0 / 72.0;                                /* of a picture of a wanted size [inch] */
static const double wide = 18.0 / 2.54;                                            /* from here on letters grow [inch] */

/* What gnuplot calls a kind of picture, and how it is seen whether it is whole. */
struct dea_picture_kind {
    const char *ending, *terminal;
    bool inches;       /* its size is in inches, else in pixels */
    double pixel[2];   /* of its letters and points [inch], without a wanted size and with one */
    double line, dash; /* what it takes for a line one pixel wide, for a dash one pixel long */
    const char *words; /* of its setting */
    bool (*whole)(const char *bytes, size_t size); /* NULL: only drawing it again tells */
    bool again;        /* is drawn a second time to be compared */
    bool script;       /* is the script itself, which draws a picture of that terminal */
};

static const dea_picture_kind kinds[] = {
    {".svg", "svg", false, {1.0 / 96.0, 1.0 / 96.0}, 1.0, 1.0, "background '#ffffff'", dea_image_svg_whole, true, false},
    {".png", "pngcairo", false, {1.0 / 192.0, 1.0 / 300.0}, 1.0, 1.0, "", dea_image_png_whole, false, false},
    {".pdf", "pdfcairo", true, {1.0 / 72.0, 1.0 / 72.0}, 2.0, 3.5, "", dea_image_pdf_whole, true, false},
    {".eps", "epscairo", true, {1.0 / 72.0, 1.0 / 72.0}, 2.0, 3.5, "", NULL, true, false},
    {".gp", "svg", false, {1.0 / 96.0, 1.0 / 96.0}, 1.0, 1.0, "background '#ffffff'", NULL, false, true},
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
    fputs("# Data and drawing of a picture by deaspice: gnuplot FILE draws it. For other formats change the terminal (pngcairo,\n"
          "# pdfcairo, epscairo) and the name of the output.\n"
          "set output ",
          picture->script);
    dea_gnuplot_text(picture->script, drawn);
    fputc('\n', picture->script);
}

static void write_side(FILE *script, double units, const dea_gnuplot *picture, const char *end)
{
    const double inches = units * picture->canvas.unit;
    const double whole = round(inches / picture->kind->pixel[picture->canvas.height > 0]);
    dea_gnuplot_number(script, picture->kind->inches ? (whole + 0.01) / 72.0 : whole); /* of which it cuts the points */
    fprintf(script, "%s%s", picture->kind->inches ? "in" : "", end);
}

static void write_scale(FILE *script, const char *before, double scale)
{
    fputs(before, script);
    dea_gnuplot_number(script, scale);
}

void dea_gnuplot_size(dea_gnuplot *picture, int height)
{
    FILE *script = picture->script;
    const dea_picture_kind *kind = picture->kind;
    const double scale = picture->canvas.unit / kind->pixel[picture->canvas.height > 0];
    if (kind->script) {
        write_head(picture);
    }
    fprintf(script, "set encoding utf8\nset terminal %s size ", kind->terminal);
    write_side(script, picture->canvas.width, picture, ",");
    write_side(script, height, picture, " font 'DejaVu Sans,12'");
    write_scale(script, " fontscale ", scale);
    write_scale(script, " linewidth ", scale * kind->line);
    write_scale(script, " dashlength ", scale * kind->dash);
    fprintf(script, " rounded noenhanced %s\n", kind->words);
    write_scale(script, "ps = ", scale);
    fputc('\n', script);
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
void dea_gnuplot_text(FILE *script, const char *text)
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

void dea_gnuplot_number(FILE *script, double value)
{
    char text[DEA_NUMBER_LENGTH];
    fputs(isfinite(value) ? dea_number_text(text, value, 9) : "NaN", script);
}

/* Runs gnuplot from one file into two others; its wait status. Its standard input it reads byte by byte unless it opens it by name,
 * which takes a third of the time and tells the line of a fault. */
static dea_status gnuplot_spawn(FILE *script, FILE *image, FILE *words, int *ended, dea_error *error)
{
    char *const arguments[] = {"gnuplot", "-d", "/dev/stdin", NULL};
    posix_spawn_file_actions_t actions;
    if (posix_spawn_file_actions_init(&actions) != 0) {
        return dea_fail(error, DEA_ERROR_MEMORY, "out of memory");
    }
    pid_t child;
    int failed = posix_spawn_file_actions_adddup2(&actions, fileno(script), STDIN_FILENO);
    failed = failed ? failed : posix_spawn_file_actions_adddup2(&actions, fileno(image), STDOUT_FILENO);
    failed = failed ? failed : posix_spawn_file_actions_adddup2(&actions, fileno(words), STDERR_FILENO);
    failed = failed ? failed : posix_spawnp(&child, arguments[0], &actions, NULL, arguments, environ);
    posix_spawn_file_actions_destroy(&actions);
    if (failed == ENOENT) {
        return gnuplot_missing(error);
    }
    if (failed) {
        return dea_fail(error, DEA_ERROR_ENGINE, "cannot start gnuplot: %s", strerror(failed));
    }
    while (waitpid(child, ended, 0) < 0) {
        if (errno != EINTR) {
            return dea_fail(error, DEA_ERROR_ENGINE, "cannot wait for gnuplot: %s", strerror(errno));
        }
    }
    return DEA_OK;
}

/* All of the image, malloc'd, a NUL behind it; NULL with errno. */
static char *image_read(FILE *image, size_t *size)
{
    const long length = fseek(image, 0, SEEK_END) == 0 ? ftell(image) : -1;
    char *bytes = length >= 0 ? malloc((size_t)length + 1) : NULL;
    rewind(image);
    *size = bytes ? fread(bytes, 1, (size_t)length, image) : 0;
    if (bytes) {
        bytes[*size] = '\0';
    }
    if (bytes && *size != (size_t)length) {
        free(bytes);
        bytes = NULL;
    }
    return bytes;
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
    FILE *image = dea_scratch_open();
    FILE *words = dea_scratch_open();
    int ended = 0;
    dea_status status = DEA_OK;
    if (!image || !words || fflush(script) != 0 || ferror(script)) {
        status = dea_fail(error, DEA_ERROR_IO, "cannot write a temporary file for gnuplot: %s", strerror(errno));
    } else {
        rewind(script);
        status = gnuplot_spawn(script, image, words, &ended, error);
    }
    if (status == DEA_OK && (!WIFEXITED(ended) || WEXITSTATUS(ended) != 0)) {
        status = gnuplot_complain(words, ended, error);
    }
    if (status == DEA_OK && !(*bytes = image_read(image, size))) {
        status = dea_fail(error, DEA_ERROR_IO, "cannot read the picture back: %s", strerror(errno));
    }
    if (image) {
        fclose(image);
    }
    if (words) {
        fclose(words);
    }
    return status;
}

/* The same script behind a word to standard error, which makes one write more of it. */
static FILE *script_again(FILE *script)
{
    FILE *again = dea_scratch_open();
    rewind(script);
    if (again) {
        fputs("print 'again'\n", again);
        for (int letter; (letter = getc(script)) != EOF;) {
            putc(letter, again);
        }
    }
    return again;
}

/* Are two drawings the same but for the line that tells when they were made? */
static bool is_same(const char *bytes, size_t size, const char *others, size_t other_size)
{
    static const char dated[] = "CreationDate";
    const char *first = size == other_size ? memmem(bytes, size, dated, sizeof dated - 1) : bytes;
    const size_t before = first ? (size_t)(first - bytes) : size;
    const char *line = first ? memchr(first, '\n', size - before) : NULL;
    const size_t after = line ? (size_t)(line - bytes) : size;
    return size == other_size && memcmp(bytes, others, before) == 0 && memcmp(bytes + after, others + after, size - after) == 0;
}

/* Is the same drawn again? gnuplot looks at none of its writes and goes on behind one that failed. A line that a picture lacks can
 * be anything, and seldom breaks its form; to be lost twice it would have to be another line, since the second time has one
 * write more before it. */
static dea_status picture_compare(FILE *script, const char *bytes, size_t size, bool *same, dea_error *error)
{
    char *others = NULL;
    size_t other_size = 0;
    FILE *again = script_again(script);
    if (!again) {
        return dea_fail(error, DEA_ERROR_IO, "cannot write a temporary file for gnuplot: %s", strerror(errno));
    }
    const dea_status status = script_draw(again, &others, &other_size, error);
    *same = status == DEA_OK && is_same(bytes, size, others, other_size);
    free(others);
    fclose(again);
    return status;
}

/* The picture, malloc'd: drawn and found whole, or the script itself. */
static dea_status gnuplot_make(dea_gnuplot *picture, char **bytes, size_t *size, dea_error *error)
{
    const dea_picture_kind *kind = picture->kind;
    bool whole = true;
    if (kind->script) {
        const bool written = fflush(picture->script) == 0 && !ferror(picture->script);
        *bytes = written ? image_read(picture->script, size) : NULL;
        return *bytes ? DEA_OK : dea_fail(error, DEA_ERROR_IO, "cannot write a temporary file: %s", strerror(errno));
    }
    dea_status status = script_draw(picture->script, bytes, size, error);
    if (status == DEA_OK && kind->whole) {
        whole = kind->whole(*bytes, *size);
    }
    if (status == DEA_OK && whole && kind->again) {
        status = picture_compare(picture->script, *bytes, *size, &whole, error);
    }
    if (status == DEA_OK && !whole) {
        status = dea_fail(error, DEA_ERROR_ENGINE, "gnuplot could not write the whole picture");
    }
    return status;
}

static dea_status gnuplot_draw(dea_gnuplot *picture, dea_error *error)
{
    char *bytes = NULL;
    size_t size = 0;
    dea_status status = gnuplot_make(picture, &bytes, &size, error);
    if (status == DEA_OK) {
        status = dea_atomic_write(&picture->file, bytes, size, error);
    }
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
