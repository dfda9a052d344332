/* No result takes the place of a file that it was made from; scenes of strangers. */
#include "child_program.h"

#include <sys/file.h>

#define FILM "actuator: {kind: dot, frame_radius: 30 mm, coverage: 0.5, film_thickness: 100 um, prestretch: 1.2}\n"

static const char wave_scene[] = FILM "material: film.mat\n"
                                      "drive: {waveform: {file: drive.csv}}\n"
                                      "model: lumped\n"
                                      "study: {transient: {until: 10 ms, every: 1 ms}}\n";
static const char sweep_scene[] = FILM "material: elastosil-2030\n"
                                       "drive: {voltage: 3 kV}\n"
                                       "model: lumped\n"
                                       "study: {sweep: {coverage: {from: 0.1, to: 0.9, points: 5}}}\n";
static const char material[] = "base: elastosil-2030\nretardation: 1 ms\n";
static const char wave[] = "time_s,voltage_V\n0,0\n1e-3,1000\n";
static const char pull[] = "stretch,stress_Pa\n1.1,40e3\n1.2,75e3\n1.3,110e3\n1.4,140e3\n";
static const char hold[] = "time_s,stress_Pa\n0,1000\n1,700\n2,600\n4,560\n8,550\n16,549\n";

typedef struct input {
    const char *name, *text;
} input;

static const input inputs[] = {{"wave.yaml", wave_scene}, {"sweep.yaml", sweep_scene}, {"film.mat", material},
                               {"drive.csv", wave},       {"pull.csv", pull},          {"hold.csv", hold}};

enum { INPUTS = sizeof inputs / sizeof *inputs };

static void link_to(const char *name, const char *other, bool hard)
{
    unlink(other);
    assert_int_equal(hard ? link(name, other) : symlink(name, other), 0);
}

static void inputs_write(void)
{
    for (size_t i = 0; i < INPUTS; i++) {
        file_write(inputs[i].name, inputs[i].text, strlen(inputs[i].text));
    }
    link_to("drive.csv", "hard.csv", true);
    link_to("drive.csv", "soft.csv", false);
    link_to("film.mat", "film.svg", true);
    link_to("sweep.yaml", "sweep.lib", false);
    link_to("sweep.yaml", "res.csv.journal", true);
    link_to("pull.csv", "pull.png", false);
    link_to(".", "here", false);
}

static void inputs_unchanged(const char *what)
{
    for (size_t i = 0; i < INPUTS; i++) {
        size_t size;
        char *text = file_read(inputs[i].name, &size);
        if (strcmp(text, inputs[i].text) != 0) {
            fail_msg("%s changed %s", what, inputs[i].name);
        }
        free(text);
    }
}

/* A call whose target is the input that the message names. */
typedef struct loss {
    const char *named, *words[10];
} loss;

static const loss losses[] = {
    {"wave.yaml", {"run", "wave.yaml", "--format", "csv", "-o", "wave.yaml"}},
    {"drive.csv", {"run", "wave.yaml", "-o", "drive.csv"}},
    {"drive.csv", {"run", "wave.yaml", "-o", "./drive.csv"}},
    {"drive.csv", {"run", "wave.yaml", "-o", "here/drive.csv"}},
    {"drive.csv", {"run", "wave.yaml", "-o", "hard.csv"}},
    {"drive.csv", {"run", "wave.yaml", "-o", "soft.csv"}},
    {"drive.csv", {"run", "wave.yaml", "-o", "drive.csv", "--resume"}},
    {"film.mat", {"run", "wave.yaml", "--format", "nc", "-o", "film.mat"}},
    {"film.mat", {"run", "wave.yaml", "--plot", "film.svg"}},
    {"film.mat", {"run", "wave.yaml", "--shard", "1/2", "-o", "film.mat"}},
    {"sweep.yaml", {"run", "sweep.yaml", "-o", "res.csv", "--resume"}},
    {"part.dea", {"merge", "sweep.yaml", "part.dea", "--format", "csv", "-o", "here/part.dea"}},
    {"sweep.yaml", {"merge", "sweep.yaml", "part.dea", "--format", "csv", "-o", "sweep.yaml"}},
    {"drive.csv", {"export", "--as", "netlist", "wave.yaml", "-o", "drive.csv"}},
    {"sweep.yaml", {"export", "--as", "kicad", "sweep.yaml", "-o", "sweep.kicad_sym"}},
    {"sweep.yaml", {"bench", "sweep.yaml", "-o", "sweep.yaml"}},
    {"film.mat", {"bench", "wave.yaml", "--plot", "here/film.svg"}},
    {"pull.csv", {"fit", "--uniaxial", "pull.csv", "-o", "pull.csv"}},
    {"pull.csv", {"fit", "--uniaxial", "pull.csv", "--plot", "pull.png"}},
    {"hold.csv", {"fit", "--relaxation", "hold.csv", "-o", "here/./hold.csv"}},
    /* the other target */
    {"here/x.svg", {"run", "sweep.yaml", "--format", "csv", "-o", "here/x.svg", "--plot", "x.svg"}},
    {"x.svg", {"bench", "sweep.yaml", "-o", "x.svg", "--plot", "./x.svg"}},
    {"x.svg", {"fit", "--uniaxial", "pull.csv", "-o", "x.svg", "--plot", "./x.svg"}},
    {"x.svg", {"materials", "elastosil-2030", "-o", "x.svg", "--plot", "./x.svg"}},
    {"x.svg", {"merge", "sweep.yaml", "part.dea", "--format", "csv", "-o", "x.svg", "--plot", "here/x.svg"}},
};

static void refused(const loss *it)
{
    char what[256] = "";
    for (size_t i = 0; it->words[i]; i++) {
        snprintf(what + strlen(what), sizeof what - strlen(what), "%s ", it->words[i]);
    }
    child_wait(child_start(0, it->words));
    if (child_status != 2 || !strstr(child_err, it->named) || !strstr(child_err, "same file")) {
        fail_msg("%s: exit status %d, %s", what, child_status, child_err);
    }
    inputs_unchanged(what);
    assert_false(file_exists("x.svg"));
}

static void no_target_takes_the_place_of_an_input(void **state)
{
    (void)state;
    inputs_write();
    RUN("run", "sweep.yaml", "--shard", "1/1", "-o", "part.dea");
    assert_status(0);
    for (size_t i = 0; i < sizeof losses / sizeof *losses; i++) {
        refused(&losses[i]);
    }
}

static void force_lets_a_target_take_the_place_of_an_input(void **state)
{
    (void)state;
    inputs_write();
    RUN("run", "wave.yaml", "-o", "drive.csv", "--force", "-q");
    assert_status(0);
    size_t size;
    char *text = file_read("drive.csv", &size);
    assert_non_null(strstr(text, "displacement_m"));
    free(text);
    RUN("fit", "--uniaxial", "pull.csv", "-o", "x.svg", "--plot", "x.svg", "--force");
    assert_status(2);
}

/* What an earlier run wrote is no input. */
static void a_result_may_be_written_again(void **state)
{
    (void)state;
    inputs_write();
    unlink("res.csv.journal");
    for (int i = 0; i < 2; i++) {
        RUN("run", "sweep.yaml", "-o", "res.csv", "--plot", "res.svg");
        assert_status(0);
        RUN("run", "sweep.yaml", "-o", "res.csv", "--resume");
        assert_status(0);
        RUN("run", "sweep.yaml", "--shard", "1/1", "-o", "part.dea", "--resume");
        assert_status(0);
        RUN("export", "--as", "kicad", "sweep.yaml", "-o", "part.kicad_sym");
        assert_status(0);
    }
}

static void a_scene_of_a_stranger_names_no_files(void **state)
{
    (void)state;
    inputs_write();
    RUN("run", "wave.yaml", "--no-files");
    assert_status(2);
    assert_says("wave.yaml:2:11: material: names a file (film.mat)");
    RUN("run", "wave.yaml", "--no-files", "--set", "material=elastosil-2030");
    assert_status(2);
    assert_says("wave.yaml:3:26: drive.waveform.file: names a file (drive.csv)");
    RUN("export", "--as", "netlist", "wave.yaml", "--no-files", "--set", "material={base: film.mat}");
    assert_status(2);
    assert_says("material.base: names a file (film.mat)");
    RUN("run", "sweep.yaml", "--no-files");
    assert_status(0);
}

/* A file of another kind, named by mistake or on purpose, is not told. */
static void a_message_tells_nothing_of_a_foreign_file(void **state)
{
    static const char *const foreign[] = {"root:$6$secret:19000:0:99999:7:::\n",
                                          "[client]\npassword=secret\n",
                                          "secret: hunter2\n",
                                          "secret\n",
                                          "secret,secret\n",
                                          "\"secret\": [1, 2\n"};
    (void)state;
    inputs_write();
    for (size_t i = 0; i < sizeof foreign / sizeof *foreign; i++) {
        file_write("drive.csv", foreign[i], strlen(foreign[i]));
        RUN("run", "wave.yaml");
        assert_status(2);
        assert_says("drive.csv:1:");
        assert_null(strstr(child_err, "secret"));
        file_write("film.mat", foreign[i], strlen(foreign[i]));
        RUN("run", "wave.yaml");
        assert_status(2);
        assert_says("film.mat:");
        assert_null(strstr(child_err, "secret"));
        file_write("film.mat", material, sizeof material - 1);
    }
}

static int parts_there(void)
{
    return system("exit $(ls -A | grep -c '^[.]deaspice-.*[.]part$')") / 256;
}

/* A file that a run of process @p pid, which may be gone, left. */
static void part_leave(long pid, char name[64])
{
    snprintf(name, 64, ".deaspice-%ld-1-0.part", pid);
    file_write(name, "half", 4);
}

static void what_killed_runs_left_goes_with_the_next_one(void **state)
{
    char dead[64], locked[64], alive[64];
    (void)state;
    inputs_write();
    part_leave(999999999, dead); /* no process has such a number */
    part_leave(999999998, locked);
    part_leave((long)getpid(), alive);
    const int fd = open(locked, O_RDWR);
    assert_int_equal(flock(fd, LOCK_EX), 0);
    RUN("run", "sweep.yaml", "-o", "here/res.csv");
    assert_status(0);
    assert_false(file_exists(dead));
    assert_true(file_exists(locked) && file_exists(alive));
    assert_int_equal(parts_there(), 2);
    close(fd);
    unlink(locked);
    unlink(alive);
}

/* As users meet it: by the shell's ulimit, the signal not ignored. */
static void a_limit_of_file_size_is_told(void **state)
{
    char command[CHILD_TEXT];
    static const char *const targets[] = {"-o big.csv", "-o big.nc", "-o big.raw", "--plot big.svg", "--plot big.pdf", "--plot big.gp"};
    (void)state;
    inputs_write();
    for (size_t i = 0; i < sizeof targets / sizeof *targets; i++) {
        snprintf(command, sizeof command,
                 "ulimit -f 8; exec '%s' run sweep.yaml --engine direct --set 'study.sweep.coverage={from: 0.1, to: 0.9, points: "
                 "2000}' %s 2>err.txt",
                 child_path, targets[i]);
        const int status = system(command);
        text_of("err.txt", child_err);
        assert_true(WIFEXITED(status));
        assert_int_equal(WEXITSTATUS(status), 1);
        assert_non_null(strstr(child_err, "too large"));
        assert_false(file_exists("big.csv") || file_exists("big.nc") || file_exists("big.raw") || file_exists("big.svg"));
        assert_int_equal(parts_there(), 0);
    }
}

static void a_folder_for_temporary_files_that_is_not_there_does_no_harm(void **state)
{
    static const char *const folders[] = {"/nowhere/at/all", "relative", "/etc/passwd", ""};
    (void)state;
    inputs_write();
    for (size_t i = 0; i < sizeof folders / sizeof *folders; i++) {
        setenv("TMPDIR", folders[i], 1);
        RUN("run", "sweep.yaml", "--engine", "ngspice", "--plot", "res.svg");
        unsetenv("TMPDIR");
        assert_status(0);
    }
}

enum { DEPTH = 64 };

/* Names of the open elements, in the text. */
typedef struct stack {
    const char *names[DEPTH];
    size_t lengths[DEPTH];
    size_t depth;
} stack;

static bool is_of_name(char letter)
{
    return (letter >= 'a' && letter <= 'z') || (letter >= 'A' && letter <= 'Z') || (letter >= '0' && letter <= '9') ||
           (letter != '\0' && strchr(":_-.", letter));
}

/* End of a tag that begins at @p at: its ">" outside of quotes; NULL where another begins before. */
static const char *tag_end(const char *at, const char *end)
{
    char quote = '\0';
    for (at++; at < end && *at != '<' && (*at != '>' || quote); at++) {
        quote = quote == *at ? '\0' : !quote && (*at == '"' || *at == '\'') ? *at : quote;
    }
    return at < end && *at == '>' ? at : NULL;
}

/* Takes a tag in; false where it closes another element than the last. */
static bool tag_take(stack *open, const char *tag, const char *last)
{
    const bool closes = tag[1] == '/';
    const char *name = tag + 1 + closes;
    size_t length = 0;
    while (name + length < last && is_of_name(name[length])) {
        length++;
    }
    if (tag[1] == '?' || tag[1] == '!') {
        return true;
    }
    if (!closes && last[-1] != '/') {
        open->names[open->depth] = name;
        open->lengths[open->depth] = length;
        return length > 0 && ++open->depth < DEPTH;
    }
    if (!closes) {
        return length > 0;
    }
    return open->depth-- > 0 && open->lengths[open->depth] == length && memcmp(open->names[open->depth], name, length) == 0;
}

/* Every element that is opened is closed in its turn, the first one last; attributes have both quotes. */
static bool svg_is_whole(const char *text, size_t size)
{
    const char *end = text + size;
    stack open = {.depth = 0};
    bool ended = false;
    for (const char *at = memchr(text, '<', size); at; at = memchr(at, '<', (size_t)(end - at))) {
        const bool comment = end - at > 4 && memcmp(at, "<!--", 4) == 0;
        const char *last = comment ? memchr(at, '>', (size_t)(end - at)) : tag_end(at, end);
        if (!last || ended || !tag_take(&open, at, last)) {
            return false;
        }
        ended = open.depth == 0 && at[1] == '/';
        at = last;
    }
    return ended;
}

static bool is_xml(const char *path)
{
    size_t size;
    char *text = file_read(path, &size);
    const bool whole =
        svg_is_whole(text, size) && !strstr(text, "]]>") && !strstr(text, "\xef\xbf\xbe") && !strstr(text, "\xef\xbf\xbf");
    free(text);
    return whole;
}

static void a_title_never_breaks_the_picture(void **state)
{
    static const char *const titles[] = {"title=\"a ]]> b\"", "title=\"a ]]]]>>> b\"", "title=\"<![CDATA[ & ]]>\"",
                                         "title=\"x\\uFFFEy\\uFFFFz\"", "title=\"]]> </text>\""};
    (void)state;
    inputs_write();
    for (size_t i = 0; i < sizeof titles / sizeof *titles; i++) {
        RUN("run", "sweep.yaml", "--set", titles[i], "--plot", "res.svg");
        assert_status(0);
        assert_true(is_xml("res.svg"));
    }
}

/* gnuplot goes on behind a write that failed; what it draws goes through a pipe, so that no full disk and no limit is in its way: the
 * picture is whole, or the limit is told by who writes the file. */
static void a_picture_is_whole_or_none(void **state)
{
    static const char partial[] = "#!/bin/sh\nPATH=${PATH#*:} gnuplot \"$@\" | head -c 5000\nkill -9 $$\n";
    static const char *const names[] = {"res.svg", "res.png", "res.pdf", "res.eps"};
    char path[4096], command[CHILD_TEXT];
    (void)state;
    inputs_write();
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        size_t size;
        unlink(names[i]);
        RUN("run", "sweep.yaml", "--engine", "direct", "--plot", names[i]);
        assert_status(0);
        free(file_read(names[i], &size));
        assert_true(size > 5000);
        unlink(names[i]);
        snprintf(command, sizeof command, "ulimit -f %zu; exec '%s' run sweep.yaml --engine direct --plot %s 2>err.txt", (size - 1) / 512,
                 child_path, names[i]);
        assert_int_equal(WEXITSTATUS(system(command)), 1);
        text_of("err.txt", child_err);
        assert_non_null(strstr(child_err, "too large"));
        assert_false(file_exists(names[i]));
    }
    assert_int_equal(mkdir("killed", 0700), 0);
    file_write("killed/gnuplot", partial, sizeof partial - 1);
    assert_int_equal(chmod("killed/gnuplot", 0700), 0);
    const char *before = getenv("PATH");
    snprintf(path, sizeof path, "%s/killed:%s", child_folder, before);
    char *kept = strdup(before);
    assert_non_null(kept);
    setenv("PATH", path, 1);
    RUN("run", "sweep.yaml", "--engine", "direct", "--plot", "res.svg");
    setenv("PATH", kept, 1);
    free(kept);
    assert_status(1);
    assert_says("signal 9");
    assert_false(file_exists("res.svg"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(no_target_takes_the_place_of_an_input),
        cmocka_unit_test(force_lets_a_target_take_the_place_of_an_input),
        cmocka_unit_test(a_result_may_be_written_again),
        cmocka_unit_test(a_scene_of_a_stranger_names_no_files),
        cmocka_unit_test(a_message_tells_nothing_of_a_foreign_file),
        cmocka_unit_test(what_killed_runs_left_goes_with_the_next_one),
        cmocka_unit_test(a_limit_of_file_size_is_told),
        cmocka_unit_test(a_folder_for_temporary_files_that_is_not_there_does_no_harm),
        cmocka_unit_test(a_title_never_breaks_the_picture),
        cmocka_unit_test(a_picture_is_whole_or_none),
    };
    return cmocka_run_group_tests_name("files", tests, child_enter, child_leave);
}
