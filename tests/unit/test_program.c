/* The program as a user meets it; DEASPICE names it, else build/deaspice. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <fcntl.h>
#include <signal.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include <math.h>

enum { MOST_WORDS = 24, TEXT_LENGTH = 1 << 16 };

typedef struct result {
    int status; /* exit status, or minus the signal */
    char out[TEXT_LENGTH];
    char err[TEXT_LENGTH];
} result;

static char folder[64];
static char program[4096];
static result last;

static const char scene[] = "title: test\n"
                            "actuator: {kind: dot, frame_radius: 30 mm, coverage: 0.5, film_thickness: 100 um, prestretch: 1.2}\n"
                            "material: elastosil-2030\n"
                            "drive: {voltage: 4500 V}\n"
                            "model: lumped\n"
                            "study: {sweep: {coverage: {from: 0.1, to: 0.9, points: 9}}}\n";

static const char step_scene[] =
    "title: switched on and off\n"
    "actuator: {kind: dot, frame_radius: 30 mm, coverage: 0.5, film_thickness: 100 um, prestretch: 1.2}\n"
    "material: {base: elastosil-2030, retardation: 1 ms}\n"
    "drive: {waveform: {step: {on: 10 ms, off: 60 ms, voltage: 4500 V, rise: 0 s}}}\n"
    "model: lumped\n"
    "study: {transient: {until: 100 ms, every: 0.5 ms, average: [{from: 40 ms, to: 60 ms}, {from: 80 ms, to: 100 ms}]}}\n";

static const char response_scene[] =
    "actuator: {kind: dot, frame_radius: 30 mm, coverage: 0.5, film_thickness: 100 um, prestretch: 1.2}\n"
    "material: {base: elastosil-2030, retardation: 0.1 ms}\n"
    "drive: {voltage: 4500 V}\n"
    "model: lumped\n"
    "study: {ac: {from: 1 Hz, to: 10 kHz}}\n";

/* Large enough that a run takes a while on any machine. */
static const char long_scene[] =
    "actuator: {kind: dot, frame_radius: 30 mm, coverage: 0.5, film_thickness: 100 um, prestretch: 1.2}\n"
    "material: elastosil-2030\n"
    "drive: {voltage: 4500 V}\n"
    "model: field\n"
    "study: {sweep: {coverage: {from: 0.1, to: 0.9, points: 3000}, prestretch: {from: 1.1, to: 1.3, points: "
    "3000}}}\n";

static void write_file(const char *name, const char *text)
{
    FILE *file = fopen(name, "w");
    assert_non_null(file);
    assert_true(fputs(text, file) >= 0);
    assert_int_equal(fclose(file), 0);
}

/* Reads a file and ends it with a NUL; returns its length, 0 where there is none. */
static size_t read_bytes(const char *name, char *bytes)
{
    FILE *file = fopen(name, "rb");
    bytes[0] = '\0';
    if (!file)
        return 0;
    const size_t length = fread(bytes, 1, TEXT_LENGTH - 1, file);
    bytes[length] = '\0';
    fclose(file);
    return length;
}

static void read_file(const char *name, char *text)
{
    (void)read_bytes(name, text);
}

/* Starts the program in the test's folder with the words up to NULL. */
static pid_t start(const char *out, const char *const *words)
{
    char *arguments[MOST_WORDS] = {program};
    for (size_t i = 0; words[i] && i + 2 < MOST_WORDS; i++)
        arguments[i + 1] = (char *)(uintptr_t)words[i];
    pid_t pid = fork();
    if (pid == 0) {
        signal(SIGINT, SIG_DFL); /* whoever runs the test in the background ignores them */
        signal(SIGHUP, SIG_DFL);
        dup2(open("/dev/null", O_RDONLY), STDIN_FILENO);
        dup2(open(out, O_WRONLY | O_CREAT | O_TRUNC, 0600), STDOUT_FILENO);
        dup2(open("err.txt", O_WRONLY | O_CREAT | O_TRUNC, 0600), STDERR_FILENO);
        execv(program, arguments);
        _exit(127);
    }
    return pid;
}

static int ended(pid_t pid)
{
    int status;
    assert_int_equal(waitpid(pid, &status, 0), pid);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
}

static void run_to(const char *out, const char *const *words)
{
    last.status = ended(start(out, words));
    if (strcmp(out, "out.txt") == 0)
        read_file("out.txt", last.out);
    read_file("err.txt", last.err);
}

#define RUN(...) run_to("out.txt", (const char *const[]){__VA_ARGS__, NULL})

static size_t lines_of(const char *text)
{
    size_t count = 0;
    for (; *text; text++)
        count += *text == '\n';
    return count;
}

static bool begins(const char *text, const char *with)
{
    return strncmp(text, with, strlen(with)) == 0;
}

static bool exists(const char *name)
{
    struct stat about;
    return stat(name, &about) == 0;
}

static void check_wrong(const char *says)
{
    assert_int_equal(last.status, 2);
    assert_string_equal(last.out, "");
    assert_true(strncmp(last.err, "deaspice: ", 10) == 0);
    assert_non_null(strstr(last.err, says));
}

static void program_alone_shows_usage(void **state)
{
    (void)state;
    run_to("out.txt", (const char *const[]){NULL});
    assert_int_equal(last.status, 2);
    assert_non_null(strstr(last.err, "Usage: deaspice"));
    assert_string_equal(last.out, "");
}

static void help_and_version_succeed(void **state)
{
    (void)state;
    RUN("--help");
    assert_int_equal(last.status, 0);
    assert_non_null(strstr(last.out, "Usage: deaspice"));
    RUN("--version");
    assert_int_equal(last.status, 0);
    assert_true(strncmp(last.out, "deaspice ", 9) == 0);
    static const char *const commands[] = {"run", "check", "fit", "materials"};
    for (size_t i = 0; i < 4; i++) {
        RUN(commands[i], "--help");
        assert_int_equal(last.status, 0);
        assert_non_null(strstr(last.out, commands[i]));
        assert_non_null(strstr(last.out, "Example"));
    }
}

static void help_of_a_command_is_its_own_help(void **state)
{
    static char wanted[TEXT_LENGTH];
    (void)state;
    RUN("fit", "--help");
    memcpy(wanted, last.out, sizeof wanted);
    RUN("help", "fit");
    assert_int_equal(last.status, 0);
    assert_string_equal(last.out, wanted);
    RUN("--help");
    memcpy(wanted, last.out, sizeof wanted);
    RUN("help");
    assert_int_equal(last.status, 0);
    assert_string_equal(last.out, wanted);
    RUN("help", "fitt");
    check_wrong("did you mean \"fit\"");
}

/* The options of every command as its completion knows them, on lines that a terminal holds. */
static void every_option_stands_in_its_help(void **state)
{
    static char script[TEXT_LENGTH];
    size_t commands = 0;
    (void)state;
    RUN("completion", "bash");
    assert_int_equal(last.status, 0);
    memcpy(script, last.out, sizeof script);
    for (char *at = script; (at = strstr(at, ") options='")); commands++) {
        char *name = at;
        while (name > script && name[-1] != ' ')
            name--;
        *at = '\0';
        RUN(name, "--help");
        assert_int_equal(last.status, 0);
        for (const char *line = last.out; *line; line += strcspn(line, "\n") + (line[strcspn(line, "\n")] == '\n')) {
            assert_true(strncmp(line, "      ", 6) != 0 || strcspn(line, "\n") <= 80);
        }
        char *end = strchr(at + strlen(" options='") + 1, '\'');
        assert_non_null(end);
        *end = '\0';
        for (const char *option = strtok(at + strlen(") options='"), " "); option; option = strtok(NULL, " ")) {
            if (!strstr(last.out, option))
                fail_msg("the help of %s has no %s", name, option);
        }
        at = end + 1;
    }
    assert_int_equal(commands, 9);
}

static void bash_completes(void **state)
{
    static const struct {
        const char *words, *offers;
    } cases[] = {
        {"''", "help run merge check bench export fit materials init completion"},
        {"mat", "materials"},
        {"help mat", "materials"},
        {"run --eng", "--engine"},
        {"run --engine n", "ngspice"},
        {"run --engine = d", "direct"},
        {"run --model fie", "field"},
        {"run --format ''", "csv nc raw"},
        {"run --set drive.vol", "drive.voltage="},
        {"run --set coverage = ''", ""},
        {"run --jobs ''", ""},
        {"run only", "only.yaml"},
        {"run -o only", "only.csv only.yaml"},
        {"fit only", "only.csv"},
        {"export --as kic", "kicad"},
        {"export --dialect x", "xyce"},
        {"init ''", "dot lens transient ac modes profile force sweep"},
        {"materials vhb-4910-", "vhb-4910-neo-hookean"},
        {"completion ''", "bash zsh fish"},
        {"check --resu", ""},
    };
    (void)state;
    write_file("only.yaml", "");
    write_file("only.csv", "");
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char script[8192 + 512];
        snprintf(script, sizeof script,
                 "source <('%s' completion bash)\nCOMP_WORDS=(deaspice %s)\nCOMP_CWORD=$((${#COMP_WORDS[@]}-1))\n_deaspice\n"
                 "IFS=' '\nprintf '%%s' \"${COMPREPLY[*]}\"\n",
                 program, cases[i].words);
        write_file("complete.sh", script);
        assert_int_equal(system("bash complete.sh >offers.txt"), 0);
        read_file("offers.txt", last.out);
        if (strcmp(last.out, cases[i].offers) != 0)
            fail_msg("deaspice %s offers \"%s\", not \"%s\"", cases[i].words, last.out, cases[i].offers);
    }
    RUN("completion", "tcsh");
    check_wrong("unknown shell \"tcsh\"");
}

static void every_scene_to_start_from_runs(void **state)
{
    static const char *const kinds[] = {"dot", "lens", "transient", "ac", "modes", "profile", "force", "sweep"};
    (void)state;
    for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++) {
        static char straight[TEXT_LENGTH];
        char name[32];
        snprintf(name, sizeof name, "start-%s.yaml", kinds[i]);
        RUN("init", kinds[i]);
        assert_int_equal(last.status, 0);
        memcpy(straight, last.out, sizeof straight);
        RUN("init", kinds[i], "-o", name);
        assert_int_equal(last.status, 0);
        assert_non_null(strstr(last.err, name));
        read_file(name, last.out);
        assert_string_equal(last.out, straight);
        RUN("run", name, "-o", "start.csv");
        assert_int_equal(last.status, 0);
        assert_non_null(strstr(last.err, "ok"));
        assert_null(strstr(last.err, "warning"));
        write_file(name, "mine\n");
        RUN("init", kinds[i], "-o", name);
        check_wrong("is there already; choose another name, or give --force");
        read_file(name, last.out);
        assert_string_equal(last.out, "mine\n");
        RUN("init", kinds[i], "-o", name, "--force", "--quiet");
        assert_int_equal(last.status, 0);
        assert_string_equal(last.err, "");
        read_file(name, last.out);
        assert_string_equal(last.out, straight);
    }
    RUN("init");
    assert_int_equal(last.status, 0);
    assert_int_equal(lines_of(last.out), 8);
    RUN("init", "lense");
    check_wrong("did you mean \"lens\"");
}

static void wrong_usage_is_told_with_a_guess(void **state)
{
    (void)state;
    RUN("rum", "dot.yaml");
    check_wrong("did you mean \"run\"");
    RUN("run", "dot.yaml", "--modle", "lumped");
    check_wrong("did you mean \"--model\"");
    RUN("run", "dot.yaml", "--engine", "ngspise");
    check_wrong("did you mean ngspice?");
    RUN("run", "dot.yaml", "--terms", "3");
    check_wrong("--terms");
    RUN("run", "dot.yaml", "-o");
    check_wrong("needs a value");
    RUN("run", "dot.yaml", "-j", "many");
    check_wrong("whole number");
    RUN("run", "dot.yaml", "dot.yaml");
    check_wrong("one too many");
    RUN("run", "--engine", "direct", "missing.yaml");
    check_wrong("missing.yaml");
    RUN("run", "--engine", "direct", "dot.yaml", "--set", "actuator.coverage=3");
    check_wrong("coverage");
    RUN("materials", "elastosil-2031");
    check_wrong("did you mean \"elastosil-2030\"");
    RUN("materials", "elastosil-2030", "--to", "1");
    check_wrong("--to 1: out of range; accepted: a stretch above 1");
    RUN("fit", "--density", "1080", "kg/m^3");
    check_wrong("--density 1080: needs a unit; accepted: a density above 0, for example \"1080 kg/m^3\"");
    RUN("dot.yaml");
    check_wrong("\"dot.yaml\" is a file; the command comes first, for example deaspice run dot.yaml");
    RUN("--versoin");
    check_wrong("did you mean \"--version\"");
    RUN("run", "dot.yaml", "--plot", "x.jpg");
    check_wrong("x.jpg: a picture ends in .svg, .png, .pdf, .eps or .gp; write for example x.svg");
}

static void raw_file_and_standard_output_hold_the_same(void **state)
{
    (void)state;
    static char file[TEXT_LENGTH], pipe[TEXT_LENGTH];
    setenv("SOURCE_DATE_EPOCH", "1700000000", 1);
    RUN("run", "step.yaml", "--engine", "direct", "-q", "-o", "step.raw");
    assert_int_equal(last.status, 0);
    RUN("run", "step.yaml", "--engine", "direct", "-q", "--format", "raw");
    unsetenv("SOURCE_DATE_EPOCH");
    assert_int_equal(last.status, 0);
    assert_true(begins(last.out, "Title: switched on and off\nDate: Tue Nov 14 22:13:20  2023\nPlotname: Transient Analysis\n"));
    const size_t length = read_bytes("step.raw", file);
    assert_true(length >= 201 * 7 * sizeof(double) && length <= 201 * 7 * sizeof(double) + 600); /* 0 to 100 ms, header */
    assert_int_equal(read_bytes("out.txt", pipe), length);
    assert_memory_equal(pipe, file, length);
}

static void run_prints_csv(void **state)
{
    (void)state;
    RUN("run", "dot.yaml", "--engine", "direct");
    assert_int_equal(last.status, 0);
    assert_int_equal(lines_of(last.out), 10);
    assert_true(strncmp(last.out, "coverage,strain,displacement_m,force_N,field_V_per_m,capacitance_F,charge_C,area_strain,energy_J,state\n",
                        94) == 0);
    assert_non_null(strstr(last.out, ",ok\n"));
    assert_string_equal(last.err, "");
}

static void run_writes_a_file_and_sums_up(void **state)
{
    (void)state;
    RUN("run", "dot.yaml", "--engine", "direct", "--model", "lumped,lame", "-j", "2", "-o", "dot.csv");
    assert_int_equal(last.status, 0);
    assert_string_equal(last.out, "");
    assert_non_null(strstr(last.err, "18 points in "));
    assert_non_null(strstr(last.err, "18 ok"));
    read_file("dot.csv", last.out);
    assert_int_equal(lines_of(last.out), 19);
    RUN("run", "dot.yaml", "--engine", "direct", "-q", "-o", "dot.csv");
    assert_string_equal(last.err, "");
}

/* Against numbers that the summary does not come from: eps eps0 lambda^4 A/H of the film, Eq. 22 for its strain. */
static void summary_speaks_of_the_actuator_first(void **state)
{
    double strain, micrometres, picofarads, microseconds;
    (void)state;
    RUN("run", "dot.yaml", "-o", "dot.csv", "--set", "study.sweep={}", "--set", "coverage=0.5", "--set", "prestretch=1.2", "--set",
        "series_resistance=1 MOhm");
    assert_int_equal(last.status, 0);
    assert_int_equal(sscanf(last.err, "largest strain %lf %% and displacement %lf", &strain, &micrometres), 2);
    assert_true(fabs(strain / 100.0 * 15e3 - micrometres) < 1e-3 * micrometres);
    const char *rest = strstr(last.err, "at rest and 0 V: capacitance ");
    assert_non_null(rest);
    assert_int_equal(sscanf(rest, "at rest and 0 V: capacitance %lf pF, R_s C %lf", &picofarads, &microseconds), 2);
    const double area = 3.14159265358979 * 15e-3 * 15e-3, expected = 2.8 * 8.8541878128e-12 * 1.44 * area / 100e-6;
    assert_true(fabs(picofarads * 1e-12 - expected) < 1e-3 * expected);
    assert_true(fabs(microseconds - picofarads) < 1e-3 * picofarads); /* 1 MOhm times 1 pF is 1 us */
    assert_non_null(strstr(last.err, "; strength unknown\n"));
    assert_non_null(strstr(last.err, "1 point in "));
    assert_non_null(strstr(last.err, " (direct): 1 ok\n"));
    RUN("run", "dot.yaml", "-o", "dot.csv", "--set", "breakdown=60 V/um", "--set", "study.sweep={voltage: [1 kV, 3 kV, 6 kV]}", "--set",
        "coverage=0.5");
    assert_non_null(strstr(last.err, " % of the strength 60 MV/m\n"));
    assert_non_null(strstr(last.err, "  breakdown in 1 row, first at voltage = 6 kV\n"));
    assert_non_null(strstr(last.err, " at voltage = 3 kV\n")); /* a film that broke down moves no more */
}

static void transient_writes_its_samples_and_prints_its_averages(void **state)
{
    (void)state;
    RUN("run", "step.yaml", "--engine", "direct", "-o", "step.csv");
    assert_int_equal(last.status, 0);
    assert_true(begins(last.out, "from_s,to_s,strain,displacement_m,least_m,largest_m,peak_to_peak_m\n0.040000000000000001,0.059999999999999998,0.037"));
    assert_int_equal(lines_of(last.out), 3);
    assert_non_null(strstr(last.err, "201 samples in "));
    assert_non_null(strstr(last.err, "201 ok\n"));
    assert_non_null(strstr(last.err, "estimated error "));
    assert_non_null(strstr(last.err, "energy balance off by "));
    assert_non_null(strstr(last.err, "switched on at 10 ms: 10-90 % in "));
    assert_non_null(strstr(last.err, "switched off at 60 ms: 10-90 % in "));
    read_file("step.csv", last.out);
    assert_int_equal(lines_of(last.out), 202);
    assert_true(begins(last.out, "time_s,voltage_V,displacement_m,strain,velocity_m_per_s,force_N,state\n0,0,0,0,"));
}

static void averages_stand_beside_a_result_on_standard_output(void **state)
{
    (void)state;
    RUN("run", "step.yaml", "--engine", "direct", "--set", "transient.every=10 ms");
    assert_int_equal(last.status, 0);
    assert_true(begins(last.out, "time_s,"));
    assert_null(strstr(last.out, "from_s"));
    assert_int_equal(lines_of(last.out), 12);
    assert_true(begins(last.err, "from_s,to_s,strain,displacement_m,least_m,largest_m,peak_to_peak_m\n"));
    RUN("run", "step.yaml", "--engine", "direct", "-q", "--set", "transient.every=10 ms");
    assert_string_equal(last.err, "");
    RUN("run", "step.yaml", "--engine", "direct", "-q", "-o", "step.csv");
    assert_int_equal(lines_of(last.out), 3);
    assert_string_equal(last.err, "");
}

static void runs_over_an_axis_carry_it_in_front(void **state)
{
    (void)state;
    RUN("run", "step.yaml", "--engine", "direct", "--model", "lumped,lame", "--set", "study.over={prestretch: [1.1, 1.2]}", "-o",
        "step.csv");
    assert_int_equal(last.status, 0);
    assert_int_equal(lines_of(last.out), 9);
    assert_true(begins(last.out, "model,prestretch,from_s,to_s,strain,displacement_m,least_m,largest_m,peak_to_peak_m\nlumped,1.1"));
    assert_non_null(strstr(last.out, "\nlame,1.2"));
    assert_non_null(strstr(last.err, "4 runs of 201 samples in "));
    assert_non_null(strstr(last.err, "worst estimated error "));
    assert_null(strstr(last.err, "switched on"));
    read_file("step.csv", last.out);
    assert_true(begins(last.out, "model,prestretch,time_s,voltage_V,"));
}

static void coarse_samples_tell_no_rise_time(void **state)
{
    (void)state;
    RUN("run", "step.yaml", "--engine", "direct", "-o", "step.csv", "--set", "transient.every=1 ms", "--set", "retardation=1 us");
    assert_int_equal(last.status, 0);
    assert_non_null(strstr(last.err, "no rise and settling times: samples every 1 ms do not show the first resonance"));
    assert_null(strstr(last.err, "10-90"));
}

#define SWINGING(more, drive, study)                                                                                             \
    "actuator: {kind: dot, frame_radius: 30 mm, coverage: 0.5, film_thickness: 100 um, prestretch: 1.2}\n"                       \
    "material: {yeoh: {C1: 178426 Pa, C2: -6023 Pa, C3: 4234 Pa}, permittivity: 2.8, density: 1080 kg/m^3" more "}\n"            \
    "drive: {waveform: {" drive "}}\nmodel: lumped\nstudy: {transient: {" study "}}\n"

/* What the summary of films says that swing, creep or do neither, by every engine. */
static void figures_of_a_step_are_those_that_the_film_has(void **state)
{
    (void)state;
    static const struct {
        const char *scene, *says[3], *hides;
    } cases[] = {
        {SWINGING("", "step: {on: 1 ms, voltage: 3 kV}", "until: 20 ms, every: 20 us"),
         {"first resonance 716.1 Hz, undamped", "does not settle within the run, overshoot 100", "10-90 % in 227 "},
         "settled"},
        {SWINGING(", prony: [{g: 0.5, tau: 3 us}]", "step: {on: 2 ms, voltage: 3 kV}", "until: 20 ms, every: 20 us"),
         {"first resonance 716.1 Hz\n", "does not settle within the run, overshoot 97.9", ""},
         "undamped"},
        {SWINGING(", retardation: 5 ms", "step: {on: 2 ms, voltage: 3 kV}", "until: 60 ms, every: 20 us"),
         {"10-90 % in 11 ms", "settled to 2 % in 19.5 ms", "no overshoot"},
         "resonance"},
        {SWINGING(", retardation: 1 ms, prony: [{g: 0.5, tau: 60 s}]", "step: {on: 1 s, voltage: 3 kV}",
                  "until: 11 s, every: 10 ms"),
         {"switched on at 1 s: does not settle within the run\n", "", ""},
         "overshoot"},
        {SWINGING(", retardation: 20 us", "sine: {amplitude: 3 kV, frequency: 50 Hz}", "until: 0.1 s, every: 10 ms"),
         {"samples every 10 ms alias the displacement, which follows the square of a sine of 50 Hz", "", ""},
         "10-90"},
        {SWINGING("", "points: [[0 s, 0 V], [1 ms, 3 kV]]", "until: 0.1 s, every: 1 ms"),
         {"samples every 1 ms alias the first resonance", "", ""},
         "10-90"},
    };
    static const char *const engines[] = {"direct", "ida", "ngspice"};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        write_file("film.yaml", cases[i].scene);
        for (size_t e = 0; e < 3; e++) {
            RUN("run", "film.yaml", "--engine", engines[e], "-o", "film.csv", "--set", "accuracy=1e-5");
            assert_int_equal(last.status, 0);
            for (size_t k = 0; k < 3; k++) {
                if (!strstr(last.err, cases[i].says[k])) {
                    fail_msg("%s, film %zu: no \"%s\" in: %s", engines[e], i, cases[i].says[k], last.err);
                }
            }
            assert_null(strstr(last.err, cases[i].hides));
        }
    }
}

static void pull_in_of_a_transient_is_physics_and_named(void **state)
{
    (void)state;
    write_file("soft.yaml", "actuator: {kind: dot, frame_radius: 30 mm, coverage: 0.4, film_thickness: 100 um, prestretch: 1.4}\n"
                            "material: {yeoh: {C1: 25 kPa}, permittivity: 2.8}\n"
                            "drive: {waveform: {points: [[0 s, 0 V], [1 s, 8 kV]]}}\n"
                            "model: lame\n"
                            "study: {transient: {until: 1 s, every: 10 ms}}\n");
    RUN("run", "soft.yaml", "--engine", "ida", "-o", "soft.csv", "--plot", "soft.svg");
    assert_int_equal(last.status, 0);
    assert_non_null(strstr(last.err, "pull_in from t = 390 ms on\n"));
    assert_true(exists("soft.svg"));
    read_file("soft.csv", last.out);
    assert_non_null(strstr(last.out, "\n0.39000000000000001,3120,,,,,pull_in\n"));
    assert_non_null(strstr(last.out, "\n1,8000,,,,,pull_in\n"));
    assert_null(strstr(last.out, "failed"));
}

static void response_tells_resonance_and_bandwidth(void **state)
{
    (void)state;
    RUN("run", "response.yaml", "--engine", "direct", "-o", "response.csv");
    assert_int_equal(last.status, 0);
    assert_string_equal(last.out, "");
    assert_non_null(strstr(last.err, "201 frequencies in "));
    assert_non_null(strstr(last.err, "\nresonance "));
    assert_non_null(strstr(last.err, "\nbandwidth (-3 dB) "));
    read_file("response.csv", last.out);
    assert_int_equal(lines_of(last.out), 202);
}

static void runs_are_drawn(void **state)
{
    (void)state;
    static const char *const scenes[] = {"step.yaml", "response.yaml"};
    for (size_t i = 0; i < 2; i++) {
        RUN("run", scenes[i], "--engine", "direct", "--plot", "runs.svg");
        assert_int_equal(last.status, 0);
        assert_int_equal(lines_of(last.out), i == 0 ? 3 : 0);
        read_file("runs.svg", last.out);
        assert_true(begins(last.out, "<?xml"));
        assert_int_equal(remove("runs.svg"), 0);
    }
}

static void pictures_take_sizes_and_logarithmic_axes(void **state)
{
    (void)state;
    static const char *const wrong[][2] = {{"--size", "8.5x6"},   {"--size", "8.5cm"},      {"--size", "3x6cm"}, {"--size", "8.5x300cm"},
                                           {"--size", "8x6furlong"}, {"--size", "nanxnancm"}, {"--size", "8x6cmm"}, {"--log", "z"},
                                           {"--log", "yx"}};
    static const char *const right[][2] = {{"--size", "8.5x6cm"}, {"--size", "85mm x 6cm"}, {"--size", "6x4in"}, {"--size", "300x200 pt"},
                                           {"--log", "x"},        {"--log", "y"},           {"--log", "xy"}};
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        RUN("run", "step.yaml", "--engine", "direct", "--plot", "sized.gp", wrong[i][0], wrong[i][1]);
        assert_int_equal(last.status, 2);
        assert_non_null(strstr(last.err, wrong[i][0]));
        assert_false(exists("sized.gp"));
    }
    for (size_t i = 0; i < sizeof right / sizeof *right; i++) {
        RUN("run", "step.yaml", "--engine", "direct", "--plot", "sized.svg", right[i][0], right[i][1]);
        assert_int_equal(last.status, 0);
        assert_int_equal(remove("sized.svg"), 0);
    }
}

static void engines_agree_about_a_transient(void **state)
{
    (void)state;
    RUN("check", "step.yaml", "--engine", "ida");
    assert_int_equal(last.status, 0);
    assert_non_null(strstr(last.out, "1 run of 201 samples"));
    assert_non_null(strstr(last.out, " balance "));
    assert_non_null(strstr(last.out, "agrees"));
    RUN("check", "step.yaml", "--engine", "ida", "--tolerance", "1e-300");
    assert_int_equal(last.status, 3);
    assert_non_null(strstr(last.out, "DISAGREES"));
}

static void jobs_do_not_change_the_result(void **state)
{
    (void)state;
    static char alone[TEXT_LENGTH];
    RUN("run", "dot.yaml", "--engine", "ngspice", "-j", "1");
    assert_int_equal(last.status, 0);
    memcpy(alone, last.out, sizeof alone);
    RUN("run", "dot.yaml", "--engine", "ngspice", "-j", "4");
    assert_int_equal(last.status, 0);
    assert_string_equal(last.out, alone);
}

static void unwritable_target_fails_before_the_run(void **state)
{
    (void)state;
    double begun = (double)time(NULL);
    RUN("run", "long.yaml", "--engine", "direct", "-o", "nowhere/dot.csv");
    assert_int_equal(last.status, 1);
    assert_non_null(strstr(last.err, "nowhere/dot.csv"));
    assert_true((double)time(NULL) - begun < 5);
}

static void full_device_is_told(void **state)
{
    (void)state;
    run_to("/dev/full", (const char *const[]){"run", "dot.yaml", "--engine", "direct", NULL});
    assert_int_equal(last.status, 1);
    assert_non_null(strstr(last.err, "No space left"));
    run_to("/dev/full", (const char *const[]){"materials", NULL});
    assert_int_equal(last.status, 1);
    assert_non_null(strstr(last.err, "No space left"));
}

static void unsupported_engine_names_one_that_can(void **state)
{
    (void)state;
    RUN("run", "dot.yaml", "--engine", "ngspice", "--model", "pelrine");
    check_wrong("cannot do model pelrine");
    assert_non_null(strstr(last.err, "--engine direct"));
}

static void engines_agree_in_a_check(void **state)
{
    (void)state;
    RUN("check", "dot.yaml", "--model", "lumped,coverage");
    assert_int_equal(last.status, 0);
    assert_non_null(strstr(last.out, "reference"));
    assert_non_null(strstr(last.out, "agrees"));
    assert_null(strstr(last.out, "DISAGREES"));
    RUN("check", "dot.yaml", "missing.yaml", "-q");
    assert_int_equal(last.status, 2);
    assert_non_null(strstr(last.err, "missing.yaml"));
}

static void disagreement_exits_with_three(void **state)
{
    (void)state;
    RUN("check", "dot.yaml", "--model", "coverage", "--set", "accuracy=1e-3", "--tolerance", "1e-300");
    assert_int_equal(last.status, 3);
    assert_non_null(strstr(last.out, "DISAGREES"));
    assert_non_null(strstr(last.err, "disagree"));
}

static void materials_are_listed_and_shown(void **state)
{
    (void)state;
    RUN("materials");
    assert_int_equal(last.status, 0);
    assert_non_null(strstr(last.out, "elastosil-2030"));
    RUN("materials", "elastosil-2030");
    assert_int_equal(last.status, 0);
    assert_non_null(strstr(last.out, "1369207.2"));
    RUN("materials", "elastosil-2030", "-o", "curve.csv");
    assert_int_equal(last.status, 0);
    read_file("curve.csv", last.out);
    assert_int_equal(lines_of(last.out), 102);
    assert_true(strncmp(last.out, "stretch,uniaxial_Pa,equibiaxial_Pa,modulus_Pa\n1,0,0,", 51) == 0);
}

static void material_file_is_shown_like_a_builtin_one(void **state)
{
    (void)state;
    write_file("soft.yaml", "base: elastosil-2030\nsource: made up\ndensity: 1000 kg/m^3\nprony: [{g: 0.2, tau: 0.5 s}]\n");
    RUN("materials", "soft.yaml", "--to", "3");
    assert_int_equal(last.status, 0);
    assert_non_null(strstr(last.out, "soft.yaml\n"));
    assert_non_null(strstr(last.out, "made up\n"));
    assert_non_null(strstr(last.out, "1000 kg/m^3\n"));
    assert_non_null(strstr(last.out, "\n         3 "));
    assert_null(strstr(last.out, "\n         4 "));
    RUN("materials", "soft.yaml", "--to", "4", "-o", "-");
    assert_int_equal(last.status, 0);
    assert_int_equal(lines_of(last.out), 102);
    assert_non_null(strstr(last.out, "\n4,"));
    write_file("relaxes.yaml", "prony: [{g: 0.2, tau: 0.5 s}]\n");
    RUN("materials", "relaxes.yaml");
    assert_int_equal(last.status, 0);
    assert_non_null(strstr(last.out, "C1                     not given, and a scene needs it\n"));
    RUN("materials", "relaxes.yaml", "-o", "-");
    check_wrong("relaxes.yaml gives no elastic constants");
    RUN("materials", "soft.yaml", "-o", "./soft.yaml");
    check_wrong("would overwrite soft.yaml");
    write_file("bad.yaml", "yeoh:\n  C1: 180 kV\n");
    RUN("materials", "bad.yaml");
    check_wrong("bad.yaml:2:7: material.yeoh.C1: wrong dimension");
    assert_non_null(strstr(last.err, "\n    2 |   C1: 180 kV\n      |       ^\n"));
    write_file("bad.yaml", "yeoh: {C1: 180 kPa}\nprony: [{g: 0.7, tau: 1 s}, {g: 0.6, tau: 2 s}]\n");
    RUN("materials", "bad.yaml");
    check_wrong("the shares g sum to 1.3");
    RUN("materials", "nowhere.yaml");
    check_wrong("nowhere.yaml");
}

static void fit_writes_a_material_that_a_scene_names_as_it_is(void **state)
{
    static char changed[sizeof scene + 64];
    (void)state;
    write_file("pull.csv", "stretch,stress_kPa\n1.1,56.9\n1.2,108.2\n1.3,157\n1.5,255\n1.8,417\n2.0,553\n");
    RUN("fit", "--uniaxial", "pull.csv", "-o", "film.yaml", "--permittivity", "2.8", "--density", "1080 kg/m^3", "--breakdown",
        "80 V/um");
    assert_int_equal(last.status, 0);
    assert_null(strstr(last.err, "permittivity"));
    read_file("film.yaml", last.out);
    assert_non_null(strstr(last.out, "\npermittivity: 2.8\ndensity: 1080 kg/m^3\nbreakdown: 80000000 V/m\n"));
    const char *name = strstr(scene, "elastosil-2030");
    snprintf(changed, sizeof changed, "%.*sfilm.yaml%s", (int)(name - scene), scene, name + strlen("elastosil-2030"));
    write_file("fitted.yaml", changed);
    RUN("run", "fitted.yaml");
    assert_int_equal(last.status, 0);
    RUN("fit", "--uniaxial", "pull.csv", "-o", "film.yaml");
    assert_non_null(strstr(last.err, "--permittivity 2.8 writes that of your film into film.yaml"));
    RUN("run", "fitted.yaml");
    check_wrong("film.yaml gives none; write one there (permittivity: 2.8)");
}

static void fit_recovers_the_material_of_a_curve(void **state)
{
    (void)state;
    write_file("pull.csv", "stretch,stress_kPa\n1.1,56.9\n1.2,108.2\n1.3,157\n1.5,255\n1.8,417\n2.0,553\n");
    RUN("fit", "--uniaxial", "pull.csv", "--terms", "1");
    assert_int_equal(last.status, 0);
    assert_non_null(strstr(last.out, "C1"));
    RUN("fit", "pull.csv");
    assert_int_equal(last.status, 2);
    RUN("fit", "--uniaxial", "pull.csv", "-o", "film.yaml");
    assert_int_equal(last.status, 0);
    assert_true(exists("film.yaml"));
}

static void relaxation_gives_the_branches_of_a_material(void **state)
{
    (void)state;
    write_file("pull.csv", "stretch,stress_kPa\n1.1,56.9\n1.2,108.2\n1.3,157\n1.5,255\n1.8,417\n2.0,553\n");
    write_file("hold.csv", "time_s,stress_kPa\n0,66.5\n1,50.2\n3,41.4\n10,33\n30,26.7\n100,21.3\n200,18.9\n380,17\n");
    RUN("fit", "--relaxation", "hold.csv", "--ramp", "2 s");
    assert_int_equal(last.status, 0);
    assert_non_null(strstr(last.out, "\nprony:\n  - {g: 0.577"));
    assert_null(strstr(last.out, "\nyeoh"));
    RUN("fit", "--relaxation", "hold.csv", "--uniaxial", "pull.csv", "--branches", "3", "-o", "both.yaml", "--plot", "both.svg");
    assert_int_equal(last.status, 0);
    assert_non_null(strstr(last.err, "3 branches from 8 points"));
    assert_true(exists("both.svg"));
    read_file("both.yaml", last.out);
    assert_non_null(strstr(last.out, "\nyeoh: {C1"));
    assert_non_null(strstr(last.out, "\nmoduli: long-term"));
    assert_non_null(strstr(last.out, "\nprony:\n"));
    RUN("fit", "--relaxation", "hold.csv", "--plot", "hold.png");
    assert_int_equal(last.status, 0);
    assert_true(exists("hold.png"));
}

/* Stresses that are all alike leave nothing to be explained: no R^2 is told, wherever a fit tells it. */
static void fit_of_stresses_alike_tells_no_share(void **state)
{
    static const char *const texts[] = {"stretch,stress_kPa\n1.1,10.1\n", "stretch,stress_kPa\n1.1,10.1\n1.1,10.1\n1.1,10.1\n"};
    (void)state;
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        write_file("alike.csv", texts[i]);
        RUN("fit", "--uniaxial", "alike.csv", "-o", "alike.yaml", "--force");
        assert_int_equal(last.status, 0);
        assert_non_null(strstr(last.err, "rms residual"));
        assert_null(strstr(last.err, "R^2"));
        read_file("alike.yaml", last.out);
        assert_non_null(strstr(last.out, "# Residual"));
        assert_null(strstr(last.out, "R^2"));
    }
}

static void bad_relaxation_is_named_and_ends_with_2(void **state)
{
    static const struct {
        const char *text, *says;
    } files[] = {
        {"time_s,stress_Pa\n0,3\n1,-2\n2,1\n", "bad.csv:3:3: "}, {"time_s,stress_Pa\n1,3\n0,2\n2,1\n", "bad.csv:3:1: "},
        {"time_s,stress_Pa\n0,3\n1,2\n", "bad.csv:3:1: "},       {"time_s,stress_Pa\n0,3\n1,nan\n2,1\n", "bad.csv:3:3: "},
        {"time_s,stress_Pa\n0,3\n1,soft\n", "bad.csv:3:3: "},    {"time_s,stress_Pa\n0,1\n1,2\n2,3\n", "the stress grows"},
    };
    (void)state;
    for (size_t i = 0; i < sizeof files / sizeof *files; i++) {
        write_file("bad.csv", files[i].text);
        RUN("fit", "--relaxation", "bad.csv");
        assert_int_equal(last.status, 2);
        assert_non_null(strstr(last.err, files[i].says));
    }
    write_file("hold.csv", "time_s,stress_Pa\n0,4\n1,3\n2,2.5\n3,2.25\n");
    static const char *const options[][2] = {{"--ramp", "2"},     {"--ramp", "-1 s"},  {"--ramp", "1 m"},
                                             {"--branches", "0"}, {"--branches", "2"}, {"--terms", "2"}};
    for (size_t i = 0; i < sizeof options / sizeof *options; i++) {
        RUN("fit", "--relaxation", "hold.csv", options[i][0], options[i][1]);
        assert_int_equal(last.status, 2);
    }
    RUN("fit", "hold.csv", "--ramp", "2 s");
    assert_int_equal(last.status, 2);
    assert_non_null(strstr(last.err, "--ramp goes with --relaxation"));
    RUN("fit");
    assert_int_equal(last.status, 2);
}

static void fit_without_a_result_leaves_no_file(void **state)
{
    (void)state;
    write_file("percent.csv", "stretch,stress_kPa\n110,56.9\n120,108.2\n130,157\n150,255\n180,417\n200,553\n");
    RUN("fit", "--uniaxial", "percent.csv", "-o", "none.yaml");
    assert_int_equal(last.status, 1);
    assert_non_null(strstr(last.err, "look like percent"));
    assert_false(exists("none.yaml"));
}

static void stretch_beyond_the_data_is_told(void **state)
{
    static const char *const inside = "study.sweep.prestretch=[1.1, 1.15]", *const outside =
                                                                                "study.sweep.prestretch=[1.1, 1.4, 1.5]";
    (void)state;
    write_file("near.csv", "stretch,stress_kPa\n1.05,32.3\n1.1,60.9\n1.15,86.7\n1.2,110.8\n");
    RUN("fit", "--uniaxial", "near.csv", "-o", "near.yaml");
    assert_int_equal(last.status, 0);
    write_file("far.yaml", "actuator: {kind: dot, frame_radius: 30 mm, coverage: 0.5, film_thickness: 100 um, prestretch: 1.2}\n"
                           "material: {base: ./near.yaml, permittivity: 2.8}\ndrive: {voltage: 500 V}\nmodel: lumped\n"
                           "study: {sweep: {}}\n");
    RUN("run", "far.yaml", "--engine", "direct", "--set", inside);
    assert_int_equal(last.status, 0);
    assert_null(strstr(last.err, "warning"));
    RUN("run", "far.yaml", "--engine", "direct", "--set", outside);
    assert_int_equal(last.status, 0);
    assert_non_null(strstr(last.err, "cover stretches 1 to 1.2, the film has"));
    assert_non_null(strstr(last.err, "at prestretch = 1.5, and 1 other point beyond"));
    RUN("run", "far.yaml", "--engine", "direct", "--set", outside, "--set", "material.yeoh={C1: 90 kPa}");
    assert_null(strstr(last.err, "warning"));
}

static void sleep_ms(long ms)
{
    struct timespec nap = {.tv_sec = ms / 1000, .tv_nsec = ms % 1000 * 1000000};
    nanosleep(&nap, NULL);
}

/* Has the run opened its output? Its handlers are there by then. */
static bool is_writing(void)
{
    return system("ls -A | grep -q '[.]part$'") == 0;
}

static void signal_ends_the_run_and_leaves_nothing(void **state)
{
    (void)state;
    static const int signals[] = {SIGINT, SIGTERM, SIGHUP};
    for (size_t i = 0; i < 6; i++) {
        const char *jobs = i < 3 ? "1" : "2";
        pid_t pid =
            start("out.txt", (const char *const[]){"run", "long.yaml", "--engine", "direct", "-o", "long.csv", "-j", jobs, NULL});
        while (!is_writing() && waitpid(pid, NULL, WNOHANG) == 0) {
            sleep_ms(10);
        }
        kill(pid, signals[i % 3]);
        assert_int_equal(ended(pid), -signals[i % 3]);
        read_file("err.txt", last.err);
        assert_string_equal(last.err, "deaspice: interrupted, nothing written\n");
        assert_false(exists("long.csv"));
        assert_int_equal(system("test -z \"$(ls -A | grep part)\""), 0);
    }
}

static void reader_that_leaves_ends_the_run_quietly(void **state)
{
    (void)state;
    int ends[2];
    char name[32];
    assert_int_equal(pipe(ends), 0);
    fcntl(ends[0], F_SETFD, FD_CLOEXEC);
    fcntl(ends[1], F_SETFD, FD_CLOEXEC);
    snprintf(name, sizeof name, "/dev/fd/%d", ends[1]);
    pid_t pid = start(name, (const char *const[]){"run", "long.yaml", "--engine", "direct", "-j", "2", NULL});
    close(ends[1]);
    char first[16];
    assert_true(read(ends[0], first, sizeof first) > 0);
    close(ends[0]);
    assert_int_equal(ended(pid), -SIGPIPE);
    read_file("err.txt", last.err);
    assert_string_equal(last.err, "");
}

static int enter_folder(void **state)
{
    (void)state;
    const char *given = getenv("DEASPICE");
    char *whole = realpath(given ? given : "build/deaspice", NULL);
    if (!whole)
        return -1;
    snprintf(program, sizeof program, "%s", whole);
    free(whole);
    snprintf(folder, sizeof folder, "/tmp/deaspice-test-XXXXXX");
    if (!mkdtemp(folder) || chdir(folder) != 0)
        return -1;
    write_file("dot.yaml", scene);
    write_file("step.yaml", step_scene);
    write_file("response.yaml", response_scene);
    write_file("long.yaml", long_scene);
    return 0;
}

static int leave_folder(void **state)
{
    (void)state;
    char command[128];
    snprintf(command, sizeof command, "rm -rf %s", folder);
    return chdir("/") == 0 && system(command) == 0 ? 0 : -1;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(program_alone_shows_usage),
        cmocka_unit_test(help_and_version_succeed),
        cmocka_unit_test(help_of_a_command_is_its_own_help),
        cmocka_unit_test(every_option_stands_in_its_help),
        cmocka_unit_test(bash_completes),
        cmocka_unit_test(every_scene_to_start_from_runs),
        cmocka_unit_test(wrong_usage_is_told_with_a_guess),
        cmocka_unit_test(run_prints_csv),
        cmocka_unit_test(raw_file_and_standard_output_hold_the_same),
        cmocka_unit_test(run_writes_a_file_and_sums_up),
        cmocka_unit_test(summary_speaks_of_the_actuator_first),
        cmocka_unit_test(transient_writes_its_samples_and_prints_its_averages),
        cmocka_unit_test(averages_stand_beside_a_result_on_standard_output),
        cmocka_unit_test(runs_over_an_axis_carry_it_in_front),
        cmocka_unit_test(coarse_samples_tell_no_rise_time),
        cmocka_unit_test(figures_of_a_step_are_those_that_the_film_has),
        cmocka_unit_test(pull_in_of_a_transient_is_physics_and_named),
        cmocka_unit_test(response_tells_resonance_and_bandwidth),
        cmocka_unit_test(runs_are_drawn),
        cmocka_unit_test(pictures_take_sizes_and_logarithmic_axes),
        cmocka_unit_test(engines_agree_about_a_transient),
        cmocka_unit_test(jobs_do_not_change_the_result),
        cmocka_unit_test(unwritable_target_fails_before_the_run),
        cmocka_unit_test(full_device_is_told),
        cmocka_unit_test(unsupported_engine_names_one_that_can),
        cmocka_unit_test(engines_agree_in_a_check),
        cmocka_unit_test(disagreement_exits_with_three),
        cmocka_unit_test(materials_are_listed_and_shown),
        cmocka_unit_test(material_file_is_shown_like_a_builtin_one),
        cmocka_unit_test(fit_writes_a_material_that_a_scene_names_as_it_is),
        cmocka_unit_test(fit_recovers_the_material_of_a_curve),
        cmocka_unit_test(fit_without_a_result_leaves_no_file),
        cmocka_unit_test(stretch_beyond_the_data_is_told),
        cmocka_unit_test(relaxation_gives_the_branches_of_a_material),
        cmocka_unit_test(fit_of_stresses_alike_tells_no_share),
        cmocka_unit_test(bad_relaxation_is_named_and_ends_with_2),
        cmocka_unit_test(signal_ends_the_run_and_leaves_nothing),
        cmocka_unit_test(reader_that_leaves_ends_the_run_quietly),
    };
    return cmocka_run_group_tests(tests, enter_folder, leave_folder);
}
