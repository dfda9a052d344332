/* The k-th call that can fail does, for all k: a command ends with its result whole and right, or with a status, a message and
 * whatever was there before; nothing hangs, crashes, leaks or stays behind. Calls that come from one place by one way stand for each
 * other: the first and the last of them fail. So do, now and then, all calls from one on. */
#define _GNU_SOURCE
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <dirent.h>
#include <math.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>

#include "faults.h"

/* A process takes ten times as long under sanitizers: the plain build tries the even calls, they every second of the odd ones. With
 * FAULTS=all in the environment every one is tried. */
#if defined(__SANITIZE_ADDRESS__)
enum { SHARE = 4, FIRST = 1 };
#else
enum { SHARE = 2, FIRST = 0 };
#endif

enum { WORDS = 24, SECONDS = 600, TEXT = 1 << 16, PERSISTENT = 4 };

int deaspice_main(int argc, char **argv); /* the program's main */

static const char sweep_text[] =
    "actuator: {kind: dot, frame_radius: 30 mm, coverage: 0.5, film_thickness: 100 um, prestretch: 1.2}\n"
    "material: elastosil-2030\n"
    "drive: {voltage: 3 kV}\n"
    "model: lumped\n"
    "study: {sweep: {prestretch: [1.1, 1.2], coverage: [0.2, 0.5, 0.8]}}\n";
static const char step_text[] =
    "actuator: {kind: dot, frame_radius: 30 mm, coverage: 0.5, film_thickness: 100 um, prestretch: 1.2}\n"
    "material: {base: elastosil-2030, density: 1080 kg/m^3, retardation: 1 ms}\n"
    "drive: {waveform: {step: {on: 1 ms, voltage: 3 kV, rise: 0.1 ms}}}\n"
    "model: lumped\n"
    "accuracy: 1e-3\n"
    "study: {transient: {until: 5 ms, every: 1 ms}}\n";
static const char pull_text[] = "stretch,stress_Pa,mode\n1.0,0,uniaxial\n1.2,98000,uniaxial\n1.4,161000,uniaxial\n"
                                "1.6,207000,uniaxial\n1.8,245000,uniaxial\n2.0,280000,uniaxial\n2.2,312000,uniaxial\n";

static const char hold_text[] = "time_s,stress_Pa\n0,100000\n0.5,93935\n1,89197\n2,82600\n3,78600\n5,74700\n7,73300\n10,72650\n"
                                "20,72500\n50,72500\n";

/* One representative run of a command. */
typedef struct command {
    const char *words[WORDS];
    const char *targets[3]; /* files that it writes */
    const char *journal;    /* what may stay besides */
    bool varies;            /* its numbers differ from run to run */
    double accuracy;        /* of its numbers; 0: its result is exact */
} command;

/* How a run ended. */
typedef struct ending {
    int status; /* exit status, or minus a signal */
    char words[TEXT];
} ending;

static char folder[64];
static fault_record *record;
static ending last;

static void put(const char *name, const char *text)
{
    FILE *file = fopen(name, "w");
    assert_non_null(file);
    assert_true(fputs(text, file) >= 0 && fclose(file) == 0);
}

/* The whole of a file, NULL where it is not there. */
static char *get(const char *name, size_t *size)
{
    FILE *file = fopen(name, "r");
    char *text = file ? calloc(1, TEXT * 16) : NULL;
    *size = text ? fread(text, 1, TEXT * 16 - 1, file) : 0;
    if (file) {
        fclose(file);
    }
    return text;
}

static bool same(const char *one, const char *other)
{
    size_t sizes[2];
    char *texts[2] = {get(one, &sizes[0]), get(other, &sizes[1])};
    const bool alike = texts[0] && texts[1] && sizes[0] == sizes[1] && memcmp(texts[0], texts[1], sizes[0]) == 0;
    free(texts[0]);
    free(texts[1]);
    return alike;
}

static void clear(const char *name)
{
    char words[64];
    snprintf(words, sizeof words, "rm -rf %s && mkdir %s", name, name);
    assert_int_equal(system(words), 0);
}

static bool is_known(const command *run, const char *name)
{
    for (size_t i = 0; run->targets[i]; i++) {
        if (strcmp(run->targets[i] + strlen("out/"), name) == 0) {
            return true;
        }
    }
    return run->journal && strcmp(run->journal + strlen("out/"), name) == 0;
}

/* Something in the folder that nobody asked for. */
static const char *litter(const command *run, const char *name)
{
    static char found[256];
    DIR *open_folder = opendir(name);
    assert_non_null(open_folder);
    found[0] = '\0';
    for (const struct dirent *entry = readdir(open_folder); entry; entry = readdir(open_folder)) {
        const bool dots = strcmp(entry->d_name, ".") == 0 || strcmp(entry->d_name, "..") == 0;
        if (!dots && !(run && is_known(run, entry->d_name))) {
            snprintf(found, sizeof found, "%s/%.200s", name, entry->d_name);
        }
    }
    closedir(open_folder);
    return found[0] ? found : NULL;
}

/* The program with the fault that is set, in a process of its own. */
static _Noreturn void live(const command *run)
{
    char *words[WORDS + 1] = {(char *)(uintptr_t)"deaspice"};
    int count = 1;
    for (; run->words[count - 1]; count++) {
        words[count] = (char *)(uintptr_t)run->words[count - 1];
    }
    alarm(SECONDS);
    if (!freopen("/dev/null", "r", stdin) || !freopen("out.txt", "w", stdout) || !freopen("err.txt", "w", stderr)) {
        _exit(99);
    }
    fault.armed = true;
    const int status = deaspice_main(count, words);
    fault.armed = false;
    exit(status);
}

static void start(const command *run, bool recorded, size_t role, size_t target, bool persistent)
{
    size_t size;
    int status;
    const char *left = litter(NULL, "out");
    if (left) {
        clear("out");
    }
    for (size_t i = 0; run->targets[i]; i++) {
        put(run->targets[i], "old\n");
    }
    fault.record = record;
    fault.recorded = recorded;
    fault.wanted_role = role;
    fault.target = target;
    fault.persistent = persistent;
    const pid_t pid = __real_fork();
    if (pid == 0) {
        live(run);
    }
    assert_int_equal(waitpid(pid, &status, 0), pid);
    last.status = WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
    char *words = get("err.txt", &size);
    snprintf(last.words, TEXT, "%s", words ? words : "");
    free(words);
}

/* True where two fields are the same, or numbers that are as close as the engine promises: it may have gone another way. */
static bool alike(const char *field, const char *wanted, double tolerance)
{
    char *ends[2];
    const double values[2] = {strtod(field, &ends[0]), strtod(wanted, &ends[1])};
    const bool numbers = ends[0] != field && ends[1] != wanted && *ends[0] == '\0' && *ends[1] == '\0';
    return strcmp(field, wanted) == 0 || (numbers && fabs(values[0] - values[1]) <= tolerance * fabs(values[1]));
}

static bool alike_rows(char *row, char *wanted, double tolerance)
{
    while (row && wanted) {
        if (!alike(strsep(&row, ","), strsep(&wanted, ","), tolerance)) {
            return false;
        }
    }
    return !row && !wanted;
}

/* True where a table has the rows of the right one, but for some that are told as failed. */
static bool alike_tables(const char *name, const char *right, double tolerance)
{
    size_t sizes[2];
    char *texts[2] = {get(name, &sizes[0]), get(right, &sizes[1])};
    bool fine = texts[0] && texts[1];
    char *rest[2] = {texts[0], texts[1]};
    const bool failed = last.status == 1 && strstr(last.words, "not solved");
    while (fine && rest[0] && rest[1]) {
        char *row = strsep(&rest[0], "\n"), *wanted = strsep(&rest[1], "\n");
        const size_t length = strlen(row);
        fine = (failed && length > 7 && strcmp(row + length - 7, ",failed") == 0) || alike_rows(row, wanted, tolerance);
    }
    fine = fine && !rest[0] && !rest[1];
    free(texts[0]);
    free(texts[1]);
    return fine;
}

/* An engine whose call failed may have found its answer in another way. */
static double tolerance_of(const command *run)
{
    static const char *const engines[] = {"ngSpice_", "ngGet_", "IDA", "ARK", "KIN", "N_V", "SUN"};
    for (size_t i = 0; i < sizeof engines / sizeof *engines; i++) {
        if (strncmp(record->failed, engines[i], strlen(engines[i])) == 0) {
            return 10.0 * run->accuracy;
        }
    }
    return 0.0;
}

static const char *judge_target(const command *run, size_t i)
{
    char right[64];
    size_t size;
    snprintf(right, sizeof right, "right-%zu", i);
    const bool table = strstr(run->targets[i], ".csv") != NULL;
    const bool whole = run->varies || same(run->targets[i], right) ||
                       (table && alike_tables(run->targets[i], right, tolerance_of(run)));
    if (whole) {
        return NULL;
    }
    char *text = get(run->targets[i], &size);
    const bool old = text && strcmp(text, "old\n") == 0;
    free(text);
    if (last.status == 0) {
        return old ? "status 0, but the old file is there" : "status 0, but the result is not right";
    }
    const bool told = !table && last.status == 1 && strstr(last.words, "not solved");
    return old || told ? NULL : text ? "the file is neither the old one nor right" : "the old file is gone";
}

/* What is wrong with the ending; NULL where nothing is. */
static const char *judge(const command *run)
{
    if (last.status == -SIGALRM) {
        return "it hangs";
    }
    if (last.status < 0 || last.status > 3) {
        return "it crashed or leaked";
    }
    if (waitpid(-1, NULL, WNOHANG) != -1 || errno != ECHILD) {
        return "it left a process behind";
    }
    if (last.status != 0 && !strstr(last.words, "deaspice:")) {
        return "no word why";
    }
    for (size_t i = 0; run->targets[i]; i++) {
        const char *wrong = judge_target(run, i);
        if (wrong) {
            return wrong;
        }
    }
    const char *left = litter(run, "out");
    left = left ? left : litter(NULL, "tmp");
    return left ? left : access(".spiceinit", F_OK) != 0 ? "a file of the user is gone" : NULL;
}

static size_t broken, tried;

static void try_call(const command *run, size_t role, size_t target, bool persistent)
{
    record->failed[0] = '\0';
    start(run, false, role, target, persistent);
    const char *wrong = judge(run);
    tried++;
    if (wrong) {
        broken++;
        print_error("%s %s, process %zu, call %zu (%s)%s: %s (status %d)\n%.2000s\n", run->words[0], run->words[1], role, target,
                    record->failed, persistent ? " and all behind it" : "", wrong, last.status, last.words);
        while (waitpid(-1, NULL, WNOHANG) > 0) {
        }
        clear("tmp");
        put(".spiceinit", "* mine\n");
    }
}

/* Ways to a call that an earlier command has walked: how a scene is read is tried once. */
static uint64_t walked[FAULT_CALLS];
static size_t walked_count;

static bool is_walked(uint64_t stack, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        if (walked[i] == stack) {
            return true;
        }
    }
    return false;
}

/* First and last call of each way to a call that is new. */
static bool stands_for_others(size_t role, size_t call, size_t before)
{
    const uint64_t stack = record->stacks[role][call];
    bool first = true, end = true;
    if (is_walked(stack, before)) {
        return false;
    }
    for (size_t i = 0; i < record->counts[role] && (first || end); i++) {
        const bool alike_call = record->stacks[role][i] == stack;
        first = first && !(alike_call && i < call);
        end = end && !(alike_call && i > call);
    }
    if (first && walked_count < FAULT_CALLS) {
        walked[walked_count++] = stack;
    }
    return first || end;
}

static void walk(const command *run)
{
    memset(record, 0, sizeof *record);
    broken = tried = 0;
    start(run, true, 0, 0, false);
    if (last.status != 0) {
        fail_msg("without a fault: status %d, %s", last.status, last.words);
    }
    for (size_t i = 0; run->targets[i]; i++) {
        char right[64];
        snprintf(right, sizeof right, "right-%zu", i);
        assert_int_equal(rename(run->targets[i], right), 0);
    }
    size_t chosen = 0, calls = 0;
    const size_t before = walked_count;
    for (size_t role = 0; role < FAULT_ROLES; role++) {
        for (size_t call = 0; call < record->counts[role] && call < FAULT_CALLS; call++) {
            calls++;
            if (stands_for_others(role, call, before) && (chosen++ % SHARE == FIRST || getenv("FAULTS"))) {
                try_call(run, role, call + 1, false);
                if (chosen / SHARE % PERSISTENT == 0) {
                    try_call(run, role, call + 1, true);
                }
            }
        }
    }
    print_message("%s: %zu calls, %zu tried, %zu broken\n", run->words[0], calls, tried, broken);
    assert_true(calls > 30 && tried > 0);
    assert_int_equal(broken, 0);
}

static const command run_csv = {.words = {"run", "sweep.yaml", "--engine", "direct", "-j", "1", "-o", "out/a.csv"}, .targets = {"out/a.csv"}};
static const command run_netcdf = {.words = {"run", "sweep.yaml", "--engine", "direct", "-j", "1", "-o", "out/a.nc"}, .targets = {"out/a.nc"}};
static const command run_raw = {.words = {"run", "sweep.yaml", "--engine", "direct", "-j", "1", "-o", "out/a.raw"}, .targets = {"out/a.raw"}};
static const command run_plot = {
    .words = {"run", "sweep.yaml", "--engine", "direct", "-j", "1", "-o", "out/a.csv", "--plot", "out/a.svg"}, .targets = {"out/a.csv", "out/a.svg"}};
static const command run_script = {
    .words = {"run", "sweep.yaml", "--engine", "direct", "-j", "1", "--plot", "out/a.gp", "--size", "8.5x6cm"}, .targets = {"out/a.gp"}};
static const command run_ngspice = {.words = {"run", "sweep.yaml", "--engine", "ngspice", "-j", "1", "-o", "out/a.csv"}, .targets = {"out/a.csv"}, .accuracy = 1e-6};
static const command step_direct = {.words = {"run", "step.yaml", "--engine", "direct", "-j", "1", "-o", "out/a.csv"}, .targets = {"out/a.csv"}};
static const command step_ida = {
    .words = {"run", "step.yaml", "--engine", "ida", "-j", "1", "-o", "out/a.csv"}, .targets = {"out/a.csv"}, .accuracy = 1e-3};
static const command step_ngspice = {
    .words = {"run", "step.yaml", "--engine", "ngspice", "-j", "1", "-o", "out/a.csv"}, .targets = {"out/a.csv"}, .accuracy = 1e-3};
static const command resume = {.words = {"run", "sweep.yaml", "--engine", "direct", "-j", "1", "-o", "out/a.csv", "--resume"},
                               .targets = {"out/a.csv"},
                               .journal = "out/a.csv.journal"};
static const command merge = {.words = {"merge", "sweep.yaml", "--engine", "direct", "one.dea", "two.dea", "-o", "out/a.csv"},
                              .targets = {"out/a.csv"}};
static const command check = {.words = {"check", "sweep.yaml", "-j", "1"}, .targets = {NULL}};
static const command bench = {.words = {"bench", "sweep.yaml", "--engine", "direct", "--model", "lumped", "--runs", "1", "--budget", "0.01",
                               "-o", "out/a.csv"},
                              .targets = {"out/a.csv"},
                              .varies = true};
static const command netlist = {.words = {"export", "--as", "netlist", "step.yaml", "-o", "out/a.cir"}, .targets = {"out/a.cir"}};
static const command part = {.words = {"export", "--as", "kicad", "step.yaml", "-o", "out/a.kicad_sym"}, .targets = {"out/a.kicad_sym", "out/a.lib"}};
static const command fit = {.words = {"fit", "pull.csv", "-o", "out/a.yaml"}, .targets = {"out/a.yaml"}};
static const command relax = {.words = {"fit", "--uniaxial", "pull.csv", "--relaxation", "hold.csv", "-o", "out/a.yaml"},
                              .targets = {"out/a.yaml"}};
static const command materials = {.words = {"materials", "elastosil-2030", "-o", "out/a.csv"}, .targets = {"out/a.csv"}};

#define WALK(name)                              \
    static void walk_##name(void **state)       \
    {                                           \
        (void)state;                            \
        walk(&name);                            \
    }
WALK(run_csv)
WALK(run_netcdf)
WALK(run_raw)
WALK(run_plot)
WALK(run_script)
WALK(run_ngspice)
WALK(step_direct)
WALK(step_ida)
WALK(step_ngspice)
WALK(resume)
WALK(merge)
WALK(check)
WALK(bench)
WALK(netlist)
WALK(part)
WALK(fit)
WALK(relax)
WALK(materials)

static void make_part(const char *shard, const char *name)
{
    const command made = {.words = {"run", "sweep.yaml", "--engine", "direct", "-j", "1", "--shard", shard, "-o", name}};
    start(&made, false, 0, 0, false);
    assert_int_equal(last.status, 0);
}

static int enter(void **state)
{
    (void)state;
    void *frames[2];
    backtrace(frames, 2); /* loads what it needs */
    prctl(PR_SET_CHILD_SUBREAPER, 1);
    record = mmap(NULL, sizeof *record, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    snprintf(folder, sizeof folder, "/tmp/deaspice-test-XXXXXX");
    if (record == MAP_FAILED || !mkdtemp(folder) || chdir(folder) != 0 || mkdir("out", 0700) != 0 || mkdir("tmp", 0700) != 0) {
        return -1;
    }
    char path[80];
    snprintf(path, sizeof path, "%s/tmp", folder);
    setenv("TMPDIR", path, 1);
    setenv("UDUNITS2_XML_PATH", "/nonexistent", 1); /* a run need not read it each time */
    put("sweep.yaml", sweep_text);
    put("step.yaml", step_text);
    put("pull.csv", pull_text);
    put("hold.csv", hold_text);
    put(".spiceinit", "* mine\n");
    make_part("1/2", "one.dea");
    make_part("2/2", "two.dea");
    return 0;
}

static int leave(void **state)
{
    (void)state;
    char words[128];
    snprintf(words, sizeof words, "rm -rf %s", folder);
    return chdir("/") == 0 && system(words) == 0 ? 0 : -1;
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(walk_run_csv),     cmocka_unit_test(walk_run_netcdf),   cmocka_unit_test(walk_run_raw),
        cmocka_unit_test(walk_run_plot),    cmocka_unit_test(walk_run_ngspice),  cmocka_unit_test(walk_run_script),  cmocka_unit_test(walk_step_direct),
        cmocka_unit_test(walk_step_ida),    cmocka_unit_test(walk_step_ngspice), cmocka_unit_test(walk_resume),
        cmocka_unit_test(walk_merge),       cmocka_unit_test(walk_check),        cmocka_unit_test(walk_bench),
        cmocka_unit_test(walk_netlist),     cmocka_unit_test(walk_part),         cmocka_unit_test(walk_fit),
        cmocka_unit_test(walk_relax),       cmocka_unit_test(walk_materials),
    };
    if (argc > 1) {
        cmocka_set_test_filter(argv[1]);
    }
    return cmocka_run_group_tests(tests, enter, leave);
}
