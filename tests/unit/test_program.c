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

static void read_file(const char *name, char *text)
{
    FILE *file = fopen(name, "r");
    text[0] = '\0';
    if (!file)
        return;
    text[fread(text, 1, TEXT_LENGTH - 1, file)] = '\0';
    fclose(file);
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

static void wrong_usage_is_told_with_a_guess(void **state)
{
    (void)state;
    RUN("rum", "dot.yaml");
    check_wrong("did you mean \"run\"");
    RUN("run", "dot.yaml", "--modle", "lumped");
    check_wrong("did you mean \"--model\"");
    RUN("run", "dot.yaml", "--engine", "ngspise");
    check_wrong("did you mean \"ngspice\"");
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
}

static void run_prints_csv(void **state)
{
    (void)state;
    RUN("run", "dot.yaml", "--engine", "direct");
    assert_int_equal(last.status, 0);
    assert_int_equal(lines_of(last.out), 10);
    assert_true(strncmp(last.out, "coverage,strain,displacement_m,force_N,field_V_per_m,state\n", 59) == 0);
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
    RUN("run", "dot.yaml", "--engine", "ngspice", "--model", "field");
    check_wrong("cannot do model field");
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

static void sleep_ms(long ms)
{
    struct timespec nap = {.tv_sec = ms / 1000, .tv_nsec = ms % 1000 * 1000000};
    nanosleep(&nap, NULL);
}

static void signal_ends_the_run_and_leaves_nothing(void **state)
{
    (void)state;
    static const int signals[] = {SIGINT, SIGTERM, SIGHUP};
    for (size_t i = 0; i < 6; i++) {
        const char *jobs = i < 3 ? "1" : "2";
        pid_t pid =
            start("out.txt", (const char *const[]){"run", "long.yaml", "--engine", "direct", "-o", "long.csv", "-j", jobs, NULL});
        sleep_ms(300);
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
        cmocka_unit_test(wrong_usage_is_told_with_a_guess),
        cmocka_unit_test(run_prints_csv),
        cmocka_unit_test(run_writes_a_file_and_sums_up),
        cmocka_unit_test(jobs_do_not_change_the_result),
        cmocka_unit_test(unwritable_target_fails_before_the_run),
        cmocka_unit_test(full_device_is_told),
        cmocka_unit_test(unsupported_engine_names_one_that_can),
        cmocka_unit_test(engines_agree_in_a_check),
        cmocka_unit_test(disagreement_exits_with_three),
        cmocka_unit_test(materials_are_listed_and_shown),
        cmocka_unit_test(fit_recovers_the_material_of_a_curve),
        cmocka_unit_test(signal_ends_the_run_and_leaves_nothing),
        cmocka_unit_test(reader_that_leaves_ends_the_run_quietly),
    };
    return cmocka_run_group_tests(tests, enter_folder, leave_folder);
}
