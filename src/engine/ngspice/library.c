#define _GNU_SOURCE
#include "engine/ngspice/library.h"

#include <dlfcn.h>
#include <locale.h>
#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>
#include <unistd.h>

#include <ngspice/sharedspice.h>

#include "support/file.h"

enum { LOG_SIZE = 3000, LINE_SIZE = 160, COMMAND_SIZE = DEA_NGSPICE_COMMAND + 1 };

struct dea_ngspice {
    char log[LOG_SIZE];        /* first lines of what the library said since the last run, repeats left out */
    char last[LINE_SIZE];      /* last line of the log */
    char complaint[LINE_SIZE]; /* first line that names an error, without its end */
    bool complained;           /* a line of the log names an error */
    bool lost;                 /* the library asked to be detached */
    bool loaded;               /* a circuit is loaded */
    char *circuit;             /* owned: its netlist, up to the end; NULL: it is not to run again */
    size_t limit;              /* most points of the next run, 0: no limit */
};

/* Words of a line that names a failure; texts differ from version to version. */
static bool names_failure(const char *line)
{
    static const char *const words[] = {"error",   "singular",          "aborted", "failed",
                                        "unusual", "resistance to low", "cannot",  "too small"};
    for (size_t i = 0; i < sizeof words / sizeof words[0]; i++) {
        const size_t length = strlen(words[i]);
        for (const char *at = line; *at; at++) {
            if (strncasecmp(at, words[i], length) == 0) {
                return true;
            }
        }
    }
    return false;
}

static int on_line(char *text, int id, void *user)
{
    dea_ngspice *library = user;
    const bool from_stderr = strncmp(text, "stderr ", 7) == 0;
    const char *line = from_stderr || strncmp(text, "stdout ", 7) == 0 ? text + 7 : text;
    (void)id;
    if (from_stderr && names_failure(line)) {
        if (!library->complained) {
            snprintf(library->complaint, LINE_SIZE, "%.*s", (int)strcspn(line, "\r\n"), line);
        }
        library->complained = true;
    }
    if (from_stderr && strncmp(line, library->last, LINE_SIZE - 1) != 0) {
        const size_t used = strlen(library->log);
        snprintf(library->last, LINE_SIZE, "%s", line);
        snprintf(library->log + used, LOG_SIZE - used, "%s%s", used ? "\n" : "", library->last);
    }
    return 0;
}

static int on_status(char *text, int id, void *user)
{
    (void)text, (void)id, (void)user;
    return 0;
}

static int on_detach(int code, bool immediate, bool quit, int id, void *user)
{
    dea_ngspice *library = user;
    (void)code, (void)immediate, (void)quit, (void)id;
    library->lost = true;
    return 0;
}

/* A private folder with empty start-up files: no .spiceinit or spinit of anybody else is run. The folder goes at once after
 * start-up. */
static dea_status enter_private_folder(char *folder, size_t size, dea_error *error)
{
    const char *base = dea_scratch_folder();
    snprintf(folder, size, "%s/deaspice-XXXXXX", base);
    if (!mkdtemp(folder) || chdir(folder) != 0) {
        return dea_fail(error, DEA_ERROR_IO, "no private start-up folder for ngspice under %s", base);
    }
    static const char *const files[] = {".spiceinit", "scripts/spinit"};
    bool written = mkdir("scripts", 0700) == 0;
    for (size_t i = 0; written && i < 2; i++) {
        FILE *file = fopen(files[i], "w");
        written = file && fclose(file) == 0;
    }
    if (!written) {
        return dea_fail(error, DEA_ERROR_IO, "the private start-up folder %s cannot be written", folder);
    }
    setenv("SPICE_LIB_DIR", folder, 1);
    unsetenv("SPICE_SCRIPTS");
    return DEA_OK;
}

/* By its whole name: where the process could not enter it, other files of these names are somebody's own. */
static void leave_private_folder(const char *folder)
{
    static const char *const names[] = {"/scripts/spinit", "/.spiceinit", "/scripts", ""};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        char path[4352];
        snprintf(path, sizeof path, "%s%s", folder, names[i]);
        (void)remove(path);
    }
}

static void command(const char *text)
{
    char line[64];
    snprintf(line, sizeof line, "%s", text);
    ngSpice_Command(line);
}

void dea_ngspice_name(char *text, size_t size)
{
    Dl_info place = {0};
    void *function;
    int (*const start)(SendChar *, SendStat *, ControlledExit *, SendData *, SendInitData *, BGThreadRunning *, void *) =
        ngSpice_Init;
    memcpy(&function, &start, sizeof function);
    char *path = dladdr(function, &place) != 0 ? realpath(place.dli_fname, NULL) : NULL;
    const char *slash = path ? strrchr(path, '/') : NULL;
    snprintf(text, size, "%s", slash ? slash + 1 : "libngspice");
    free(path);
}

dea_status dea_ngspice_open(dea_ngspice **library, dea_error *error)
{
    char folder[4096];
    *library = NULL;
    dea_ngspice *mine = calloc(1, sizeof *mine);
    if (!mine) {
        return dea_fail(error, DEA_ERROR_MEMORY, "out of memory while ngspice starts");
    }
    setlocale(LC_ALL, "C"); /* the library reads numbers in the process's locale */
    dea_status status = enter_private_folder(folder, sizeof folder, error);
    if (status == DEA_OK && ngSpice_Init(on_line, on_status, on_detach, NULL, NULL, NULL, mine) != 0) {
        status = dea_fail(error, DEA_ERROR_ENGINE, "ngspice did not start: %s", mine->log);
    }
    leave_private_folder(folder);
    if (status != DEA_OK) {
        free(mine);
        return status;
    }
    command("set noaskquit");
    command("set nomoremode");
    command("unset ngbehavior");
    *library = mine;
    return DEA_OK;
}

const char *dea_ngspice_complaint(const dea_ngspice *library)
{
    return library->complaint;
}

void dea_ngspice_close(dea_ngspice *library)
{
    if (library) {
        free(library->circuit);
    }
    free(library);
}

static void clear_log(dea_ngspice *library)
{
    library->log[0] = library->last[0] = library->complaint[0] = '\0';
    library->complained = false;
}

void dea_ngspice_limit(dea_ngspice *library, size_t points)
{
    library->limit = points;
}

/* The commands, one a line, that follow a netlist behind its end, else `run`. */
static void run_commands(const char *commands)
{
    char line[COMMAND_SIZE];
    if (!*commands) {
        command("run");
    }
    for (; *commands; commands += strspn(commands, "\n")) {
        const size_t length = strcspn(commands, "\n");
        snprintf(line, sizeof line, "%.*s", (int)length, commands);
        ngSpice_Command(line);
        commands += length;
    }
}

/* Runs the loaded circuit; a breakpoint of the library ends it at the limit. */
static void run_loaded(const char *commands, size_t limit)
{
    char stop[64];
    snprintf(stop, sizeof stop, "stop after %zu", limit);
    if (limit > 0) {
        command(stop);
    }
    run_commands(commands);
    if (limit > 0) {
        command("delete all");
    }
}

/* Length of a netlist without the commands behind its end. */
static size_t length_of(const char *netlist)
{
    static const char end[] = "\n.end\n";
    const char *at = strstr(netlist, end);
    return at ? (size_t)(at - netlist) + sizeof end - 1 : strlen(netlist);
}

/* Cuts a copy of the netlist into cards and loads it. */
static dea_status load(dea_ngspice *library, const char *netlist, size_t length, dea_error *error)
{
    size_t lines = 0;
    for (size_t i = 0; i < length; i++) {
        lines += netlist[i] == '\n';
    }
    if (lines == 0) {
        return dea_fail(error, DEA_ERROR_ENGINE, "ngspice takes no netlist without a line");
    }
    char *text = strndup(netlist, length);
    char **cards = calloc(lines + 1, sizeof *cards);
    if (!text || !cards) {
        free(cards);
        free(text);
        return dea_fail(error, DEA_ERROR_MEMORY, "out of memory for a netlist of %zu lines", lines);
    }
    size_t count = 0;
    char *rest = text;
    for (char *card = strsep(&rest, "\n"); card && count < lines; card = strsep(&rest, "\n")) {
        cards[count++] = card;
    }
    const int code = ngSpice_Circ(cards);
    free(cards);
    free(text);
    library->loaded = true;
    if (code != 0 || library->lost || library->complained) {
        return dea_fail(error, DEA_ERROR_ENGINE, "ngspice refused the netlist: %s", library->log);
    }
    library->circuit = netlist[length] ? strndup(netlist, length) : NULL; /* without memory for it, it is read again */
    return DEA_OK;
}

/* True where the plot has the vector itself: by name alone the library would also find it among its constants. */
static bool has_vector(char *plot, const char *vector)
{
    char **names = ngSpice_AllVecs(plot);
    for (size_t i = 0; names && names[i]; i++) {
        if (strcasecmp(names[i], vector) == 0) {
            return true;
        }
    }
    return false;
}

/* Vector @p name of the plot, NULL where it has none with numbers. */
static pvector_info find(char *plot, const char *name)
{
    char whole[128];
    if (!has_vector(plot, name)) {
        return NULL;
    }
    snprintf(whole, sizeof whole, "%s.%s", plot, name);
    const pvector_info info = ngGet_Vec_Info(whole);
    return info && (info->v_realdata || info->v_compdata) && info->v_length > 0 ? info : NULL;
}

/* Points up to the first that is not finite: what follows a NaN is no answer. */
static size_t sound_points(const double *values, size_t count, size_t width)
{
    for (size_t i = 0; i < count * width; i++) {
        if (!isfinite(values[i])) {
            return i / width;
        }
    }
    return count;
}

/* Numbers that a vector has per point: 2 where it is complex. */
static size_t width_of(const vector_info *info)
{
    return info->v_realdata ? 1 : 2;
}

static dea_status copy_vector(const vector_info *info, double **values, size_t *count, dea_error *error)
{
    const size_t width = width_of(info);
    const size_t size = (size_t)info->v_length * width * sizeof(double);
    *values = malloc(size);
    if (!*values) {
        return dea_fail(error, DEA_ERROR_MEMORY, "out of memory for the answer of ngspice");
    }
    memcpy(*values, info->v_realdata ? (const void *)info->v_realdata : (const void *)info->v_compdata, size);
    const size_t sound = sound_points(*values, (size_t)info->v_length, width);
    *count = sound < *count ? sound : *count;
    return DEA_OK;
}

/* Copies the vectors of the plot that the run made. The old plot, or the plot of constants, must never be taken for it. */
static dea_status copy(const char *plot_before, const char *const *names, size_t name_count, dea_ngspice_table *table,
                       dea_error *error)
{
    char *plot = ngSpice_CurPlot();
    if (!plot || strcmp(plot, plot_before) == 0) {
        return DEA_OK; /* nothing was solved */
    }
    size_t count = SIZE_MAX;
    for (size_t i = 0; i < name_count; i++) {
        const pvector_info info = find(plot, names[i]);
        if (!info) {
            return DEA_OK;
        }
        const dea_status status = copy_vector(info, &table->columns[i], &count, error);
        if (status != DEA_OK) {
            return status;
        }
    }
    table->count = count;
    return DEA_OK;
}

void dea_ngspice_table_free(dea_ngspice_table *table)
{
    for (size_t i = 0; i < DEA_NGSPICE_COLUMNS; i++) {
        free(table->columns[i]);
    }
    *table = (dea_ngspice_table){0};
}

/* Takes the circuit out; without that a refused one would leave the old one to run again. */
static void unload(dea_ngspice *library)
{
    if (library->loaded) {
        command("remcirc");
    }
    free(library->circuit);
    library->circuit = NULL;
    library->loaded = false;
}

/* Loads a circuit, unless it is the one that commands have run before; a circuit that failed is read anew. */
static dea_status take(dea_ngspice *library, const char *netlist, size_t length, dea_error *error)
{
    const char *circuit = library->circuit;
    if (circuit && netlist[length] && strncmp(circuit, netlist, length) == 0 && !circuit[length]) {
        return DEA_OK;
    }
    unload(library);
    return load(library, netlist, length, error);
}

dea_status dea_ngspice_run_all(dea_ngspice *library, const char *netlist, const char *const *names, size_t name_count,
                               dea_ngspice_table *table, dea_error *error)
{
    char before[64];
    *table = (dea_ngspice_table){0};
    if (name_count > DEA_NGSPICE_COLUMNS) {
        return dea_fail(error, DEA_ERROR_ENGINE, "%zu vectors, at most %d are read of a run", name_count, (int)DEA_NGSPICE_COLUMNS);
    }
    const size_t limit = library->limit, length = length_of(netlist);
    library->limit = 0;
    clear_log(library);
    const dea_status status = take(library, netlist, length, error);
    if (status != DEA_OK) {
        return status;
    }
    command("optran 1 1 1 0 0 0"); /* no rescue by a transient: it gives wrong numbers without an error */
    const char *plot = ngSpice_CurPlot();
    snprintf(before, sizeof before, "%s", plot ? plot : "");
    run_loaded(netlist + length, limit);
    const dea_status copied = library->lost ? dea_fail(error, DEA_ERROR_ENGINE, "ngspice gave up: %s", library->log)
                                            : copy(before, names, name_count, table, error);
    if (library->complained) {
        free(library->circuit);
        library->circuit = NULL;
    }
    command("destroy all");
    ngSpice_Command(NULL); /* frees its command history */
    if (copied != DEA_OK) {
        dea_ngspice_table_free(table);
    }
    return copied;
}
