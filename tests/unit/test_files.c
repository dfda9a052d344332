/* No result takes the place of a file that it was made from; scenes of strangers. */
#include "child_program.h"

#include <sys/file.h>

#include "output/image.h"

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
        assert_true(strstr(child_err, "too large") || strstr(child_err, "whole picture"));
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

static bool is_xml(const char *path)
{
    size_t size;
    char *text = file_read(path, &size);
    const bool whole =
        dea_image_svg_whole(text, size) && !strstr(text, "]]>") && !strstr(text, "\xef\xbf\xbe") && !strstr(text, "\xef\xbf\xbf");
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

/* Every piece that a write could lose is missed. */
static void a_picture_with_a_hole_is_none(void **state)
{
    enum { PIECE = 4096 };
    size_t sizes[2], holes = 0;
    (void)state;
    inputs_write();
    RUN("run", "sweep.yaml", "--plot", "res.svg");
    assert_status(0);
    RUN("run", "sweep.yaml", "--plot", "res.png");
    assert_status(0);
    char *svg = file_read("res.svg", &sizes[0]), *png = file_read("res.png", &sizes[1]);
    assert_true(dea_image_svg_whole(svg, sizes[0]) && dea_image_png_whole(png, sizes[1]));
    for (size_t length = 0; length < sizes[1]; length += 97) {
        assert_false(dea_image_png_whole(png, length));
    }
    for (size_t at = 0; at + PIECE < sizes[1]; at += PIECE, holes++) {
        png[at + 7] ^= 1;
        assert_false(dea_image_png_whole(png, sizes[1]));
        png[at + 7] ^= 1;
    }
    for (size_t length = 0; length + 7 < sizes[0]; length += 97) {
        assert_false(dea_image_svg_whole(svg, length));
    }
    assert_true(holes > 3);
    assert_true(dea_image_svg_whole("<svg><!-- <a> --><b c='>'/>x</svg>\n", 35));
    assert_false(dea_image_svg_whole("<svg><b></svg></b>", 18));
    assert_false(dea_image_svg_whole("<svg><b c='</svg>", 17));
    free(svg);
    free(png);
}

/* gnuplot writes line by line and goes on behind a write that failed: here the first drawing lacks a line of a curve. */
static void a_picture_that_lost_a_line_is_refused(void **state)
{
    static const char lossy[] = "#!/bin/sh\n"
                                "PATH=${PATH#*:} gnuplot \"$@\" >drawn || exit\n"
                                "if test -e once; then cat drawn; else touch once; LC_ALL=C sed \"$LOST\" drawn; fi\n";
    static const struct {
        const char *name, *lost;
    } cases[] = {{"res.svg", "/gridline/d"}, {"res.svg", "100d"}, {"res.svg", "$d"}, {"res.svg", "3d"}, {"res.eps", "100d"},
                 {"res.eps", "$d"},          {"res.pdf", "2d"},   {"res.pdf", "$d"}, {"res.pdf", "8d"}};
    char path[4096];
    (void)state;
    inputs_write();
    assert_int_equal(mkdir("lossy", 0700), 0);
    file_write("lossy/gnuplot", lossy, sizeof lossy - 1);
    assert_int_equal(chmod("lossy/gnuplot", 0700), 0);
    const char *before = getenv("PATH");
    snprintf(path, sizeof path, "%s/lossy:%s", child_folder, before);
    char *kept = strdup(before);
    assert_non_null(kept);
    setenv("PATH", path, 1);
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        unlink("once");
        unlink(cases[i].name);
        setenv("LOST", cases[i].lost, 1);
        RUN("run", "sweep.yaml", "--engine", "direct", "--plot", cases[i].name);
        assert_status(1);
        assert_says("whole picture");
        assert_false(file_exists(cases[i].name));
    }
    static const char *const whole[] = {"res.svg", "res.eps", "res.pdf"};
    for (size_t i = 0; i < 3; i++) {
        RUN("run", "sweep.yaml", "--engine", "direct", "--plot", whole[i]);
        assert_status(0);
    }
    setenv("PATH", kept, 1);
    free(kept);
}

/* What a PDF lacks moves what lies behind it away from where its table of objects says. */
static void a_pdf_with_a_hole_is_none(void **state)
{
    size_t size, holes = 0;
    (void)state;
    inputs_write();
    RUN("run", "sweep.yaml", "--plot", "res.pdf");
    assert_status(0);
    char *whole = file_read("res.pdf", &size), *text = calloc(1, size + 1);
    assert_non_null(text);
    memcpy(text, whole, size);
    assert_true(dea_image_pdf_whole(text, size));
    for (size_t at = 0; at + 100 < size; at += 997, holes++) {
        memcpy(text, whole, at);
        memcpy(text + at, whole + at + 100, size - at - 100);
        text[size - 100] = '\0';
        assert_false(dea_image_pdf_whole(text, size - 100));
        memcpy(text, whole, at);
        text[at] = '\0';
        assert_false(dea_image_pdf_whole(text, at));
    }
    assert_true(holes > 5);
    free(whole);
    free(text);
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
        cmocka_unit_test(a_picture_with_a_hole_is_none),
        cmocka_unit_test(a_picture_that_lost_a_line_is_refused),
        cmocka_unit_test(a_pdf_with_a_hole_is_none),
    };
    return cmocka_run_group_tests_name("files", tests, child_enter, child_leave);
}
