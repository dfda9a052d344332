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

enum { TEXT_MAX = 110, WORDS_MAX = 1000, CHARACTER_MOST = 4 };

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

dea_status dea_gnuplot_begin(dea_gnuplot *picture, const char *path, dea_error *error)
{
    *picture = (dea_gnuplot){.file.fd = -1};
    const char *dot = strrchr(path, '.');
    const bool svg = dot && strcasecmp(dot, ".svg") == 0;
    picture->png = dot && strcasecmp(dot, ".png") == 0;
    if (!svg && !picture->png) {
        const char *name = strrchr(path, '/') ? strrchr(path, '/') + 1 : path;
        return dea_fail(error, DEA_ERROR_USAGE, "%.400s: a picture ends in .svg or .png; write for example %.*s.svg", path,
                        (int)strcspn(name, "."), name);
    }
    if (!gnuplot_found()) {
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

void dea_gnuplot_size(dea_gnuplot *picture, int width, int height)
{
    const char *font = "DejaVu Sans,12";
    fputs("set encoding utf8\n", picture->script);
    if (picture->png) {
        fprintf(picture->script,
                "set terminal pngcairo size %d,%d font '%s' fontscale 2 linewidth 2 dashlength 2 pointscale 2 noenhanced\n",
                2 * width, 2 * height, font);
    } else {
        fprintf(picture->script, "set terminal svg size %d,%d font '%s' background '#ffffff' noenhanced\n", width, height, font);
    }
}

/* Length of the UTF-8 character at @p text, 0 where it is none that may be shown: controls, and what XML has not. */
static size_t character_length(const unsigned char *text)
{
    unsigned code = 0;
    const size_t length = dea_text_character((const char *)text, strnlen((const char *)text, CHARACTER_MOST), &code);
    return code < 0x20 || (code >= 0x7f && code < 0xa0) || code == 0xfffe || code == 0xffff ? 0 : length;
}

/* Letters and blanks stand for themselves; every other byte is written as an octal escape, so that quotes, backticks, macros and
 * backslashes never meet the parser. Digits too: gnuplot reads an octal number as long as digits follow. */
void dea_gnuplot_text(FILE *script, const char *text)
{
    const unsigned char *next = (const unsigned char *)text;
    int brackets = 0;
    fputc('"', script);
    for (int shown = 0; *next; shown++) {
        if (shown == TEXT_MAX) {
            fputs("\\342\\200\\246", script); /* an ellipsis */
            break;
        }
        const size_t length = character_length(next);
        if (*next == '>' && brackets > 1) {
            fputs("\\342\\201\\240", script); /* a word joiner, which has no width: XML keeps "]]>" for itself */
        }
        for (size_t i = 0; i < length; i++) {
            fprintf(script, (next[i] < 0x80 && isalpha(next[i])) || next[i] == ' ' ? "%c" : "\\%03o", next[i]);
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

/* Runs gnuplot from one file into two others; its wait status. */
static dea_status gnuplot_spawn(FILE *script, FILE *image, FILE *words, int *ended, dea_error *error)
{
    char *const arguments[] = {"gnuplot", "-d", NULL};
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

/* All of the image, malloc'd; NULL with errno. */
static char *image_read(FILE *image, size_t *size)
{
    const long length = fseek(image, 0, SEEK_END) == 0 ? ftell(image) : -1;
    char *bytes = length >= 0 ? malloc((size_t)length + 1) : NULL;
    rewind(image);
    *size = bytes ? fread(bytes, 1, (size_t)length, image) : 0;
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

/* Is the same drawn again? gnuplot looks at none of its writes and goes on behind one that failed. A line that an SVG lacks can
 * be anything, and seldom breaks its form; to be lost twice it would have to be another line, since the second time has one
 * write more before it. */
static dea_status svg_compare(FILE *script, const char *bytes, size_t size, bool *same, dea_error *error)
{
    char *others = NULL;
    size_t other_size = 0;
    FILE *again = script_again(script);
    if (!again) {
        return dea_fail(error, DEA_ERROR_IO, "cannot write a temporary file for gnuplot: %s", strerror(errno));
    }
    const dea_status status = script_draw(again, &others, &other_size, error);
    *same = status == DEA_OK && other_size == size && memcmp(bytes, others, size) == 0;
    free(others);
    fclose(again);
    return status;
}

static dea_status gnuplot_draw(dea_gnuplot *picture, dea_error *error)
{
    char *bytes = NULL;
    size_t size = 0;
    dea_status status = script_draw(picture->script, &bytes, &size, error);
    bool whole =
        status == DEA_OK && (picture->png ? dea_image_png_whole((unsigned char *)bytes, size) : dea_image_svg_whole(bytes, size));
    if (whole && !picture->png) {
        status = svg_compare(picture->script, bytes, size, &whole, error);
    }
    if (status == DEA_OK) {
        status = whole ? dea_atomic_write(&picture->file, bytes, size, error)
                       : dea_fail(error, DEA_ERROR_ENGINE, "gnuplot could not write the whole picture");
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
