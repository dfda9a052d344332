#include "output/gnuplot.h"

#include "support/number.h"

#include <ctype.h>
#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <spawn.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/wait.h>
#include <unistd.h>

extern char **environ;

enum { TEXT_MAX = 110, WORDS_MAX = 1000, COPY_BLOCK = 1 << 15 };

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

/* A file without a name that children do not inherit. */
static FILE *scratch_open(void)
{
    FILE *file = tmpfile();
    if (file && fcntl(fileno(file), F_SETFD, FD_CLOEXEC) != 0) {
        fclose(file);
        file = NULL;
    }
    return file;
}

dea_status dea_gnuplot_begin(dea_gnuplot *picture, const char *path, dea_error *error)
{
    *picture = (dea_gnuplot){.file.fd = -1};
    const char *dot = strrchr(path, '.');
    const bool svg = dot && strcasecmp(dot, ".svg") == 0;
    picture->png = dot && strcasecmp(dot, ".png") == 0;
    if (!svg && !picture->png) {
        return dea_fail(error, DEA_ERROR_USAGE, "%.400s: a picture ends in .svg or .png", path);
    }
    if (!gnuplot_found()) {
        return gnuplot_missing(error);
    }
    const dea_status status = dea_atomic_open(&picture->file, path, error);
    if (status != DEA_OK) {
        return status;
    }
    picture->script = scratch_open();
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

/* Length of the UTF-8 character at @p text, 0 where it is none that may be shown. */
static size_t character_length(const unsigned char *text)
{
    const unsigned char lead = text[0];
    if (lead < 0x80) {
        return lead >= 0x20 && lead != 0x7f ? 1 : 0;
    }
    const size_t length = lead >= 0xf0 && lead < 0xf5 ? 4 : lead >= 0xe0 && lead < 0xf0 ? 3 : lead >= 0xc2 && lead < 0xe0 ? 2 : 0;
    for (size_t i = 1; i < length; i++) {
        if ((text[i] & 0xc0) != 0x80) {
            return 0;
        }
    }
    const bool control = length == 2 && lead == 0xc2 && text[1] < 0xa0;
    return control ? 0 : length;
}

/* Letters and blanks stand for themselves; every other byte is written as an octal escape, so that quotes, backticks, macros and
 * backslashes never meet the parser. Digits too: gnuplot reads an octal number as long as digits follow. */
void dea_gnuplot_text(FILE *script, const char *text)
{
    const unsigned char *next = (const unsigned char *)text;
    fputc('"', script);
    for (int shown = 0; *next; shown++) {
        if (shown == TEXT_MAX) {
            fputs("\\342\\200\\246", script); /* an ellipsis */
            break;
        }
        const size_t length = character_length(next);
        for (size_t i = 0; i < length; i++) {
            fprintf(script, (next[i] < 0x80 && isalpha(next[i])) || next[i] == ' ' ? "%c" : "\\%03o", next[i]);
        }
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

/* Did the image end as its format ends? A full disk or a crash leaves it without. */
static bool image_whole(FILE *image, bool png)
{
    char tail[13] = "";
    if (fseek(image, -12, SEEK_END) != 0 || fread(tail, 1, 12, image) != 12) {
        return false;
    }
    return png ? memcmp(tail + 4, "IEND\xae\x42\x60\x82", 8) == 0 : strstr(tail, "</svg>") != NULL;
}

static dea_status image_copy(FILE *image, dea_atomic *file, dea_error *error)
{
    char block[COPY_BLOCK];
    rewind(image);
    size_t length;
    while ((length = fread(block, 1, sizeof block, image)) > 0) {
        const dea_status status = dea_atomic_write(file, block, length, error);
        if (status != DEA_OK) {
            return status;
        }
    }
    return ferror(image) ? dea_fail(error, DEA_ERROR_IO, "cannot read the picture back") : DEA_OK;
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

static dea_status gnuplot_draw(dea_gnuplot *picture, FILE *image, FILE *words, dea_error *error)
{
    if (!image || !words || fflush(picture->script) != 0 || ferror(picture->script)) {
        return dea_fail(error, DEA_ERROR_IO, "cannot write a temporary file for gnuplot: %s", strerror(errno));
    }
    rewind(picture->script);
    int ended = 0;
    const dea_status status = gnuplot_spawn(picture->script, image, words, &ended, error);
    if (status != DEA_OK) {
        return status;
    }
    if (!WIFEXITED(ended) || WEXITSTATUS(ended) != 0 || !image_whole(image, picture->png)) {
        return gnuplot_complain(words, ended, error);
    }
    return image_copy(image, &picture->file, error);
}

dea_status dea_gnuplot_finish(dea_gnuplot *picture, bool keep, dea_error *error)
{
    dea_status status = DEA_OK;
    if (keep && picture->script) {
        FILE *image = scratch_open();
        FILE *words = scratch_open();
        status = gnuplot_draw(picture, image, words, error);
        if (image) {
            fclose(image);
        }
        if (words) {
            fclose(words);
        }
    }
    if (picture->script) {
        fclose(picture->script);
        picture->script = NULL;
    }
    const dea_status closed = dea_atomic_close(&picture->file, keep && status == DEA_OK, error);
    return status != DEA_OK ? status : closed;
}
