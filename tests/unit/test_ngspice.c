/* libngspice and its traps. Every test runs the library in a process of its own: the library can crash, and changes its process.
 */
#include "scenes.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <locale.h>
#include <signal.h>
#include <stdbool.h>
#include <stdlib.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <ngspice/sharedspice.h>

#include "engine/ngspice/library.h"
#include "network/units.h"

#if defined(__has_feature)
#if __has_feature(address_sanitizer)
#define SANITIZED
#endif
#endif
#ifdef __SANITIZE_ADDRESS__
#define SANITIZED
#endif

static const char *const divider = "* a divider of one volt\n"
                                   "v1 a 0 1\n"
                                   "r1 a b 1\n"
                                   "r2 b 0 3\n"
                                   ".dc v1 1 3 1\n"
                                   ".end\n";

/* What a child found wrong, in memory shared with the test. */
typedef struct verdict {
    int line; /* 0: nothing */
    char text[DEA_ERROR_LENGTH + 256];
} verdict;

typedef void in_child(verdict *found, const char *folder);

#define CHECK(condition, ...)                                                                                                    \
    do {                                                                                                                         \
        if (!(condition)) {                                                                                                      \
            found->line = __LINE__;                                                                                              \
            snprintf(found->text, sizeof found->text, __VA_ARGS__);                                                              \
            return;                                                                                                              \
        }                                                                                                                        \
    } while (0)

static int remove_tree(const char *path)
{
    char command[512];
    snprintf(command, sizeof command, "rm -rf '%s'", path);
    return system(command);
}

static size_t count_entries(const char *path)
{
    DIR *folder = opendir(path);
    size_t count = 0;
    assert_non_null(folder);
    for (const struct dirent *entry = readdir(folder); entry; entry = readdir(folder)) {
        count += strcmp(entry->d_name, ".") != 0 && strcmp(entry->d_name, "..") != 0 ? 1 : 0;
    }
    closedir(folder);
    return count;
}

/* Runs a check in a child whose working directory and TMPDIR are a fresh folder; returns how the child ended. */
static int run_child(in_child *check, verdict *copy)
{
    char folder[] = "/tmp/deaspice-test-XXXXXX";
    assert_non_null(mkdtemp(folder));
    assert_int_equal(chmod(folder, 0777), 0);
    verdict *found = mmap(NULL, sizeof *found, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    assert_true(found != MAP_FAILED);
    fflush(NULL);
    const pid_t pid = fork();
    assert_true(pid >= 0);
    if (pid == 0) {
        alarm(600);
        signal(SIGSEGV, SIG_DFL); /* not the test runner's */
        signal(SIGABRT, SIG_DFL);
        if (chdir(folder) != 0 || setenv("TMPDIR", folder, 1) != 0) {
            _exit(9);
        }
        check(found, folder);
        _exit(0);
    }
    int ended = 0;
    assert_int_equal(waitpid(pid, &ended, 0), pid);
    *copy = *found;
    munmap(found, sizeof *found);
    assert_int_equal(remove_tree(folder), 0);
    return ended;
}

static void pass_in_child(in_child *check)
{
    verdict found;
    const int ended = run_child(check, &found);
    if (found.line) {
        fail_msg("line %d: %s", found.line, found.text);
    }
    if (!WIFEXITED(ended) || WEXITSTATUS(ended) != 0) {
        fail_msg("the child ended with %s %d", WIFSIGNALED(ended) ? "signal" : "status",
                 WIFSIGNALED(ended) ? WTERMSIG(ended) : WEXITSTATUS(ended));
    }
}

/* One vector of a run. */
typedef struct vector_result {
    double *values;
    size_t count;
} vector_result;

static dea_status run_vector(dea_ngspice *library, const char *netlist, const char *vector, vector_result *result, dea_error *error)
{
    dea_ngspice_table table;
    const dea_status status = dea_ngspice_run_all(library, netlist, &vector, 1, &table, error);
    *result = (vector_result){table.columns[0], table.count};
    return status;
}

/* True where the divider is solved: 0.75, 1.5, 2.25 V. */
static bool solves_divider(dea_ngspice *library, dea_error *error)
{
    vector_result result;
    const dea_status status = run_vector(library, divider, "b", &result, error);
    const bool right = status == DEA_OK && result.count == 3 && fabs(result.values[0] - 0.75) < 1e-9 &&
                       fabs(result.values[1] - 1.5) < 1e-9 && fabs(result.values[2] - 2.25) < 1e-9;
    free(result.values);
    return right;
}

/* True where the commands behind a netlist make its capacitor discharge from that voltage with that time constant. */
static bool discharges(dea_ngspice *library, double voltage, double time, dea_error *error)
{
    char netlist[256];
    vector_result result;
    snprintf(netlist, sizeof netlist,
             "* RC\nR1 a 0 1\nC1 a 0 1\n.options method=trap trtol=1e30\n.end\nalter C1 ic=%g\nalter C1=%g\ntran 1e-3 1 0 1e-2 uic\n", voltage, time);
    const dea_status status = run_vector(library, netlist, "a", &result, error);
    const bool right = status == DEA_OK && result.count > 50 && fabs(result.values[result.count - 1] - voltage * exp(-1.0 / time)) < 1e-4;
    free(result.values);
    return right;
}

static void discharge_by_commands(verdict *found, const char *folder)
{
    dea_error error = {0};
    dea_ngspice *library;
    (void)folder;
    CHECK(dea_ngspice_open(&library, &error) == DEA_OK, "%s", error.message);
    CHECK(discharges(library, 1.0, 1.0, &error), "%s", error.message);
    CHECK(discharges(library, -0.5, 2.0, &error), "%s", error.message); /* the circuit of the run before */
    CHECK(solves_divider(library, &error), "%s", error.message);
    CHECK(discharges(library, 2.0, 0.5, &error), "%s", error.message);
    dea_ngspice_close(library);
}

static void commands_change_the_circuit_that_is_loaded(void **state)
{
    (void)state;
    pass_in_child(discharge_by_commands);
}

static void solve_divider(verdict *found, const char *folder)
{
    dea_error error = {0};
    dea_ngspice *library;
    (void)folder;
    CHECK(dea_ngspice_open(&library, &error) == DEA_OK, "%s", error.message);
    CHECK(solves_divider(library, &error), "%s", error.message);
    dea_ngspice_close(library);
}

static void circuit_is_solved(void **state)
{
    (void)state;
    pass_in_child(solve_divider);
}

static void write_text(const char *path, const char *text)
{
    FILE *file = fopen(path, "w");
    if (!file || fputs(text, file) < 0 || fclose(file) != 0) {
        _exit(8);
    }
}

/* A start-up file that leaves a mark, wherever it is run. */
static void write_trap(const char *path, const char *folder)
{
    char text[512];
    snprintf(text, sizeof text, "shell touch %s/marker\nset ngbehavior=psa\n", folder);
    write_text(path, text);
}

static int silent_line(char *text, int id, void *user)
{
    (void)text, (void)id, (void)user;
    return 0;
}

static int silent_exit(int code, NG_BOOL immediate, NG_BOOL quit, int id, void *user)
{
    (void)code, (void)immediate, (void)quit, (void)id, (void)user;
    return 0;
}

/* The library by itself runs a foreign start-up file: else the test after this one could not fail. */
static void start_bare_library(verdict *found, const char *folder)
{
    write_trap(".spiceinit", folder);
    CHECK(ngSpice_Init(silent_line, silent_line, silent_exit, NULL, NULL, NULL, NULL) == 0, "no start");
    CHECK(access("marker", F_OK) == 0, "the bare library does not run .spiceinit any more");
}

static void start_beside_foreign_files(verdict *found, const char *folder)
{
    write_trap(".spiceinit", folder);
    write_trap("spinit", folder);
    setenv("HOME", folder, 1);
    setenv("SPICE_USERINIT_DIR", folder, 1);
    solve_divider(found, folder);
    char path[256];
    snprintf(path, sizeof path, "%s/marker", folder);
    CHECK(found->line || access(path, F_OK) != 0, "a foreign start-up file was run");
}

static void foreign_start_up_files_are_not_run(void **state)
{
    (void)state;
    pass_in_child(start_bare_library);
    pass_in_child(start_beside_foreign_files);
}

static void become_unknown(verdict *found, const char *folder)
{
    CHECK(setgid(54321) == 0 && setuid(54321) == 0, "no other user");
    solve_divider(found, folder);
}

static void user_without_a_name_can_solve(void **state)
{
    (void)state;
    if (geteuid() != 0) {
        skip();
    }
    pass_in_child(become_unknown);
}

/* A locale with a decimal comma, installed or made here by localedef. */
static bool comma_locale(const char *folder)
{
    static const char *const names[] = {"de_DE.UTF-8", "de_DE.utf8", "fr_FR.UTF-8", "de_DE"};
    char command[512];
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        if (setlocale(LC_ALL, names[i])) {
            return localeconv()->decimal_point[0] == ',';
        }
    }
    snprintf(command, sizeof command, "localedef -i de_DE -f UTF-8 %s/de_DE.UTF-8 >/dev/null 2>&1", folder);
    setenv("LOCPATH", folder, 1);
    return system(command) != -1 && setlocale(LC_ALL, "de_DE.UTF-8") && localeconv()->decimal_point[0] == ',';
}

enum { NO_LOCALE = -1 };

static void solve_under_a_comma(verdict *found, const char *folder)
{
    dea_error error = {0};
    dea_ngspice *library;
    vector_result result;
    if (!comma_locale(folder)) {
        found->line = NO_LOCALE;
        return;
    }
    setenv("LC_ALL", "de_DE.UTF-8", 1);
    CHECK(dea_ngspice_open(&library, &error) == DEA_OK, "%s", error.message);
    static const char *const netlist = "* comma\n.param p=2.5\nv1 a 0 1\nb1 b 0 v={p}*v(a)+0.25\n.dc v1 1 1 1\n.end\n";
    CHECK(run_vector(library, netlist, "b", &result, &error) == DEA_OK, "%s", error.message);
    CHECK(result.count == 1 && fabs(result.values[0] - 2.75) < 1e-12, "%zu values, %.17g", result.count,
          result.count ? result.values[0] : 0.0);
}

static void decimal_comma_of_the_user_does_not_matter(void **state)
{
    (void)state;
    verdict found;
    const int ended = run_child(solve_under_a_comma, &found);
    if (found.line == NO_LOCALE) {
        skip();
    }
    if (ended != 0 || found.line) {
        fail_msg("line %d: %s", found.line, found.text);
    }
}

static void solve_without_scripts(verdict *found, const char *folder)
{
    setenv("SPICE_SCRIPTS", "/nowhere/at/all", 1);
    setenv("SPICE_LIB_DIR", "/nowhere/at/all", 1);
    setenv("SPICE_EXEC_DIR", "/nowhere/at/all", 1);
    setenv("SPICE_ASCIIRAWFILE", "1", 1);
    solve_divider(found, folder);
}

static void solve_beside_foreign_scripts(verdict *found, const char *folder)
{
    char path[256];
    CHECK(mkdir("scripts", 0755) == 0, "no folder");
    write_trap("scripts/spinit", folder);
    snprintf(path, sizeof path, "%s/scripts", folder);
    setenv("SPICE_SCRIPTS", path, 1);
    setenv("SPICE_LIB_DIR", folder, 1);
    solve_divider(found, folder);
    snprintf(path, sizeof path, "%s/marker", folder);
    CHECK(found->line || access(path, F_OK) != 0, "a foreign spinit was run");
}

static void missing_or_foreign_scripts_do_not_matter(void **state)
{
    (void)state;
    pass_in_child(solve_without_scripts);
    pass_in_child(solve_beside_foreign_scripts);
}

/* Netlists that the library refuses or cannot solve. */
static const char *const refused[] = {
    "* unknown subcircuit\nv1 a 0 1\nxq a b nobody\nr2 b 0 3\n.dc v1 1 3 1\n.end\n",
    "* no end\nv1 a 0 1\nr1 a b 1\nr2 b 0 3\n.dc v1 1 3 1\n",
    "* bad element\nv1 a 0 1\nr1 a b 1\ng2 b 0 3\n.dc v1 1 3 1\n.end\n",
    "* bad expression\nv1 a 0 1\nb1 b 0 v=v(a)*(2\nr2 b 0 3\n.dc v1 1 3 1\n.end\n",
    "* no analysis\nv1 a 0 1\nr1 a b 1\nr2 b 0 3\n.end\n",
    "* two sources against each other\nv1 a 0 1\nv2 a 0 2\nr1 a b 1\nr2 b 0 3\n.dc v1 1 3 1\n.end\n",
    "",
    "* a title alone\n",
};
enum { REFUSED = sizeof refused / sizeof refused[0] };

static void alternate_good_and_bad(verdict *found, const char *folder)
{
    dea_error error = {0};
    dea_ngspice *library;
    (void)folder;
    CHECK(dea_ngspice_open(&library, &error) == DEA_OK, "%s", error.message);
    for (size_t i = 0; i < 3 * REFUSED; i++) {
        vector_result result;
        const bool solved = solves_divider(library, &error);
        if (!solved && i > 0 && error.status == DEA_ERROR_ENGINE) {
            break; /* newer releases of ngspice are lost after some of these, and say so; the engine then takes a fresh worker */
        }
        CHECK(solved, "before bad netlist %zu: %s", i, error.message);
        error = (dea_error){0};
        const dea_status status = run_vector(library, refused[i % REFUSED], "b", &result, &error);
        CHECK(result.count == 0, "bad netlist %zu gave %zu values", i, result.count);
        CHECK(status == DEA_OK || error.message[0], "bad netlist %zu is refused without a word", i);
        CHECK(i % REFUSED == 4 || i % REFUSED == 5 || status == DEA_ERROR_ENGINE, "bad netlist %zu is not refused", i);
        free(result.values);
    }
}

static void refused_circuit_is_never_answered_by_the_one_before(void **state)
{
    (void)state;
    pass_in_child(alternate_good_and_bad);
}

/* After an undefined parameter the library is poisoned: it may refuse everything, or crash, but must not give wrong numbers. */
static void run_after_poison(verdict *found, const char *folder)
{
    dea_error error = {0};
    dea_ngspice *library;
    vector_result result;
    (void)folder;
    CHECK(dea_ngspice_open(&library, &error) == DEA_OK, "%s", error.message);
    CHECK(solves_divider(library, &error), "%s", error.message);
    static const char *const poison = "* poison\nv1 a 0 1\nr1 a b {nobody}\nr2 b 0 3\n.dc v1 1 3 1\n.end\n";
    CHECK(run_vector(library, poison, "b", &result, &error) == DEA_ERROR_ENGINE, "an undefined parameter is not refused");
    CHECK(result.count == 0, "an undefined parameter gave numbers");
    CHECK(error.message[0], "no word about it");
    for (int i = 0; i < 3; i++) {
        error = (dea_error){0};
        const dea_status status = run_vector(library, divider, "b", &result, &error);
        CHECK(status == DEA_ERROR_ENGINE ? result.count == 0 : result.count == 3 && fabs(result.values[2] - 2.25) < 1e-9,
              "a poisoned library gave %zu numbers, status %d", result.count, (int)status);
    }
}

static void poisoned_library_gives_no_numbers(void **state)
{
    (void)state;
    verdict found;
    const int ended = run_child(run_after_poison, &found);
    if (found.line) {
        fail_msg("line %d: %s", found.line, found.text);
    }
    assert_true(ended == 0 || (WIFSIGNALED(ended) && WTERMSIG(ended) == SIGSEGV));
}

static void ask_for_constants(verdict *found, const char *folder)
{
    static const char *const names[] = {"c",      "e",   "i",  "pi",   "kelvin", "boltz", "echarge",
                                        "planck", "yes", "no", "true", "false",  "nobody"};
    dea_error error = {0};
    dea_ngspice *library;
    (void)folder;
    CHECK(dea_ngspice_open(&library, &error) == DEA_OK, "%s", error.message);
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++) {
        vector_result result;
        const dea_status status = run_vector(library, divider, names[i], &result, &error);
        CHECK(result.count == 0, "node %s has %zu values, the first %g (status %d)", names[i], result.count, result.values[0],
              (int)status);
        free(result.values);
    }
    CHECK(solves_divider(library, &error), "%s", error.message);
}

static void constant_is_never_taken_for_a_node(void **state)
{
    (void)state;
    pass_in_child(ask_for_constants);
}

static void leave_the_domain(verdict *found, const char *folder)
{
    /* v(b) is finite up to 2 V; beyond, either the run stops or its values are no numbers */
    static const char *const netlists[] = {
        "* root\nv1 a 0 1\nb1 b 0 v=sqrt(2.5-v(a))\nr1 b 0 1\n.dc v1 1 5 1\n.end\n",
        "* overflow\nv1 a 0 1\nb1 b 0 v=v(a) > 2.5 ? (1e308*v(a)*10)-(1e308*v(a)*10) : v(a)\nr1 b 0 1\n.dc v1 1 5 1\n.end\n",
    };
    dea_error error = {0};
    dea_ngspice *library;
    (void)folder;
    CHECK(dea_ngspice_open(&library, &error) == DEA_OK, "%s", error.message);
    for (size_t i = 0; i < 2; i++) {
        vector_result result;
        (void)run_vector(library, netlists[i], "b", &result, &error);
        CHECK(result.count == 2, "netlist %zu: %zu values", i, result.count);
        for (size_t k = 0; k < result.count; k++) {
            CHECK(isfinite(result.values[k]), "netlist %zu: value %zu is no number", i, k);
        }
        free(result.values);
    }
}

static void values_end_before_the_first_that_is_no_number(void **state)
{
    (void)state;
    pass_in_child(leave_the_domain);
}

static void complain_without_end(verdict *found, const char *folder)
{
    dea_error error = {0};
    dea_ngspice *library;
    char *text = malloc(1 << 20);
    size_t length = 0;
    (void)folder;
    CHECK(text, "no memory");
    length += (size_t)sprintf(text, "* many lines in error\nv1 a 0 1\n");
    for (int i = 0; i < 3000; i++) {
        length +=
            (size_t)sprintf(text + length, "x%d a 0 nobody%d_with_a_name_that_is_rather_long_so_that_the_log_fills_up\n", i, i);
    }
    (void)sprintf(text + length, ".dc v1 1 2 1\n.end\n");
    CHECK(dea_ngspice_open(&library, &error) == DEA_OK, "%s", error.message);
    vector_result result;
    CHECK(run_vector(library, text, "a", &result, &error) == DEA_ERROR_ENGINE, "not refused");
    CHECK(memchr(error.message, '\0', sizeof error.message) && error.message[0], "no bounded message");
    static const char *const logarithm = "* negative\nv1 a 0 1\nb1 b 0 v=ln(v(b)-2)*v(a)\nr1 b 0 1\n.dc v1 1 200 1\n.end\n";
    (void)run_vector(library, logarithm, "b", &result, &error);
    CHECK(result.count == 0 || isfinite(result.values[0]), "no numbers");
    CHECK(memchr(error.message, '\0', sizeof error.message), "no bounded message");
    CHECK(solves_divider(library, &error), "%s", error.message);
}

static void log_is_bounded(void **state)
{
    (void)state;
    pass_in_child(complain_without_end);
}

/* Descriptors 1 and 2 go to files while everything that can fail does. */
static void keep_quiet(verdict *found, const char *folder)
{
    char path[2][256];
    for (int i = 0; i < 2; i++) {
        snprintf(path[i], sizeof path[i], "%s/stream-%d", folder, i + 1);
        const int file = open(path[i], O_CREAT | O_WRONLY | O_TRUNC, 0600);
        CHECK(file >= 0 && dup2(file, i + 1) == i + 1, "no file for the stream");
    }
    alternate_good_and_bad(found, folder);
    if (!found->line) {
        run_after_poison(found, folder);
    }
    fflush(NULL);
    for (int i = 0; i < 2 && !found->line; i++) {
        struct stat about;
        CHECK(stat(path[i], &about) == 0 && about.st_size == 0, "%ld bytes on stream %d", (long)about.st_size, i + 1);
    }
}

static void nothing_is_printed(void **state)
{
    (void)state;
    verdict found;
    (void)run_child(keep_quiet, &found); /* a poisoned library may end it */
    if (found.line) {
        fail_msg("line %d: %s", found.line, found.text);
    }
}

static long resident_kib(void)
{
    long pages = 0;
    FILE *file = fopen("/proc/self/statm", "r");
    if (!file || fscanf(file, "%*d %ld", &pages) != 1) {
        pages = -1;
    }
    if (file) {
        fclose(file);
    }
    return pages * (sysconf(_SC_PAGESIZE) / 1024);
}

static void run_many(verdict *found, const char *folder)
{
    dea_error error = {0};
    dea_ngspice *library;
    (void)folder;
    CHECK(dea_ngspice_open(&library, &error) == DEA_OK, "%s", error.message);
    for (int i = 0; i < 200; i++) {
        CHECK(solves_divider(library, &error), "%s", error.message);
    }
    const long before = resident_kib();
    CHECK(before > 0, "no /proc");
    for (int i = 0; i < 2000; i++) {
        CHECK(solves_divider(library, &error), "circuit %d: %s", i, error.message);
    }
    const long growth = resident_kib() - before;
    CHECK(growth < 400, "%ld KiB more after 2000 circuits", growth);
}

static void memory_stays_flat_over_two_thousand_circuits(void **state)
{
    (void)state;
#ifdef SANITIZED
    (void)run_many;
    skip(); /* the sanitizer keeps freed memory back */
#else
    pass_in_child(run_many);
#endif
}

static void leave_nothing(verdict *found, const char *folder)
{
    solve_divider(found, folder);
    CHECK(found->line || count_entries(folder) == 0, "%zu files left", count_entries(folder));
}

static void start_up_folder_is_gone_at_once(void **state)
{
    (void)state;
    pass_in_child(leave_nothing);
}

static void start_without_a_place(verdict *found, const char *folder)
{
    static const char *const places[] = {"/nowhere/at/all", "/dev/null", "relative", ""};
    (void)folder;
    for (size_t i = 0; i < sizeof places / sizeof places[0]; i++) {
        dea_error error = {0};
        dea_ngspice *library;
        setenv("TMPDIR", places[i], 1);
        CHECK(dea_ngspice_open(&library, &error) == DEA_OK, "no start with TMPDIR=%s: %s", places[i], error.message);
        dea_ngspice_close(library);
    }
}

static void folder_for_temporary_files_that_is_none_does_no_harm(void **state)
{
    (void)state;
    pass_in_child(start_without_a_place);
}

static dea_status count_rows(void *user, size_t first, const void *points, size_t count, dea_error *error)
{
    const dea_row *rows = points;
    size_t *good = user;
    (void)first, (void)error;
    for (size_t i = 0; i < count; i++) {
        *good += rows[i].state == DEA_STATE_OK ? 1 : 0;
    }
    return DEA_OK;
}

static void study_away_from_home(verdict *found, const char *folder)
{
    dea_scene scene = paper_scene(DEA_DOT, 1.2, 0.4, 3000.0);
    dea_error error = {0};
    size_t good = 0;
    const dea_run_options options = {.jobs = 2, .points = count_rows, .user = &good};
    char before[256];
    (void)folder;
    scene.models[0] = dea_model_find("coverage");
    setenv("SPICE_LIB_DIR", "/somewhere", 1);
    CHECK(getcwd(before, sizeof before), "no folder");
    CHECK(dea_study_run(&scene, dea_engine_find("ngspice"), &options, &error) == DEA_OK && good == 1, "%s", error.message);
    char after[256];
    CHECK(getcwd(after, sizeof after) && strcmp(before, after) == 0, "the study left its folder");
    CHECK(strcmp(getenv("SPICE_LIB_DIR"), "/somewhere") == 0, "the study changed the environment");
}

static void study_keeps_its_own_process(void **state)
{
    (void)state;
    pass_in_child(study_away_from_home);
}

static void times_of_a_study_enter_its_units_together(void **state)
{
    (void)state;
    const dea_units units = {.length = 2.0, .thickness = 4.0, .stress = 0.5, .voltage = 0.25, .time = 8.0};
    dea_scene scene = paper_scene(DEA_DOT, 1.2, 0.5, 4500.0), inside;
    scene.study = DEA_STUDY_TRANSIENT;
    scene.transient = (dea_transient){.until = 25.0, .every = 0.01};
    scene.reduction.ring = 0.25;
    assert_int_equal(dea_units_enter(&units, &scene, &inside, NULL), DEA_OK);
    assert_true(inside.transient.until == 200.0 && inside.transient.every == 0.08);
    assert_true(inside.reduction.ring == 2.0); /* what is left out is left out at the same moment */
    dea_units_leave(&inside);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(circuit_is_solved),
        cmocka_unit_test(commands_change_the_circuit_that_is_loaded),
        cmocka_unit_test(times_of_a_study_enter_its_units_together),
        cmocka_unit_test(foreign_start_up_files_are_not_run),
        cmocka_unit_test(user_without_a_name_can_solve),
        cmocka_unit_test(decimal_comma_of_the_user_does_not_matter),
        cmocka_unit_test(missing_or_foreign_scripts_do_not_matter),
        cmocka_unit_test(refused_circuit_is_never_answered_by_the_one_before),
        cmocka_unit_test(poisoned_library_gives_no_numbers),
        cmocka_unit_test(constant_is_never_taken_for_a_node),
        cmocka_unit_test(values_end_before_the_first_that_is_no_number),
        cmocka_unit_test(log_is_bounded),
        cmocka_unit_test(nothing_is_printed),
        cmocka_unit_test(memory_stays_flat_over_two_thousand_circuits),
        cmocka_unit_test(start_up_folder_is_gone_at_once),
        cmocka_unit_test(folder_for_temporary_files_that_is_none_does_no_harm),
        cmocka_unit_test(study_keeps_its_own_process),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
