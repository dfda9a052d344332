/* Tables as instruments, spreadsheets and simulators write them: drives, pulls and holds. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

#include "deaspice/fit.h"
#include "deaspice/scene.h"

static const char scene_text[] =
    "actuator: {kind: dot, frame_radius: 30 mm, coverage: 0.5, film_thickness: 100 um, prestretch: 1.2}\n"
    "material: elastosil-2030\nmodel: lumped\ndrive: {waveform: {file: drive.csv}}\n"
    "study: {transient: {until: 40 ms, every: 5 ms}}\n";

/* Reads a scene beside a drive of that text. */
static dea_status read_drive(const char *text, dea_scene *scene, dea_error *error)
{
    char folder[] = "/tmp/dea-table-XXXXXX";
    char path[64];
    *error = (dea_error){0};
    assert_non_null(mkdtemp(folder));
    snprintf(path, sizeof path, "%s/drive.csv", folder);
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    assert_int_equal(fputs(text, file) >= 0, 1);
    assert_int_equal(fclose(file), 0);
    const dea_status status = dea_scene_parse(scene_text, strlen(scene_text), "t", folder, NULL, 0, NULL, scene, error);
    unlink(path);
    rmdir(folder);
    return status;
}

/* All of them are 0 V at 0 s, 3 kV at 10 ms and at 40 ms, to the last bit. */
static void drives_of_many_shapes_are_one_drive(void **state)
{
    static const char *const texts[] = {
        "time_s,voltage_V\n0,0\n0.01,3000\n0.04,3000\n",
        "time_ms,voltage_kV\n0,0\n10,3\n40,3\n",
        "voltage_kV;time_ms\n0;0\n3;10\n3;40\n",
        "Time (ms)\tVoltage (kV)\n0\t0\n10\t3\n40\t3\n",
        "Time [ms]; Voltage [kV]\r\n0,0; 0,0\r\n10,0; 3,0\r\n40,0; 3,0\r\n",
        "time_s;voltage_V\n0;0\n0,01;3000\n0,04;3000\n",
        "# channel 1, divider 1000:1\ntime_s,voltage_V\n0,0\n0.01,3000\n0.04,3000\n",
        "time_s,voltage_V\ns,V\n0,0\n0.01,3000\n0.04,3000\n",
        "Time,Voltage\n(ms),(kV)\n\"0\",\"0\"\n\"10\",\"3\"\n\"40\",\"3\"\n",
        "TIME,CH1\ns,V\n0,0\n0.01,3000\n0.04,3000\n",
        "time_s,voltage_V,current_A\n0,0,1e-6\n0.01,3000,1e-6\n0.04,3000,1e-6\n",
        "index,t / ms,U / kV,comment\n1,0,0,begin\n2,10,3,top\n3,40,3,end\n",
        "\xEF\xBB\xBFvoltage_V,time_s\n0,0\n3e3,1e-2\n3e3,4e-2\n",
        "0 0\n10m 3k\n40m 3k\n",
        "0s 0V\n10ms 3kV\n40000us 0.003meg\n",
        "0,0\n0.01,3000\n0.04,3000",
        "time_s,voltage_V\r0,0\r0.01,3000\r0.04,3000\r",
        "sep=;\r\ntime_s;voltage_V\r\n0;0\r\n0,01;3000\r\n0,04;3000\r\n",
        "0\t0\n\n0.01\t3000\n0.04\t3000\n\n",
        "# time_ms voltage_kV\n0 0\n10 3\n40 3\n",
        "Recorder 7 of the lab\nmeasured by A. B., 2024\n\ntime ms  voltage kV\n",
        "Export of run 3\n\nTime (s)   Voltage (V)\n0.00   0\n0.01   3000\n0.04   3000\n",
        "  time_s ,  voltage_V  \n  0 ,  0 \n 0.01 , 3000\n 0.04,3000 \n",
        "time_s,voltage_V\n-0.01,0\n0,0\n0.01,3000\n0.04,3000\n",
        "Zeit [ms];Hochspannung (kV)\n0,0;0\n10,0;3,0\n40;3\n",
        "Zeit [ms];voltage (kV)\n0,0;0\n10,0;3,0\n40;3\n",
    };
    (void)state;
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        dea_scene scene;
        dea_error error;
        const dea_status status = read_drive(texts[i], &scene, &error);
        if (i == 20) { /* a head without rows */
            assert_int_equal(status, DEA_ERROR_SCENE);
            continue;
        }
        if (status != DEA_OK) {
            fail_msg("drive %zu: %s", i, error.message);
        }
        const dea_waveform *wave = &scene.drive.waveform;
        assert_int_equal(wave->point_count, 3);
        assert_true(wave->times[0] == 0.0 && wave->times[1] == 0.01 && wave->times[2] == 0.04);
        assert_true(wave->voltages[0] == 0.0 && wave->voltages[1] == 3000.0 && wave->voltages[2] == 3000.0);
        assert_non_null(strstr(wave->columns, "is the time"));
        dea_scene_free(&scene);
    }
}

static void a_record_before_its_trigger_is_cut_at_zero(void **state)
{
    dea_scene scene;
    dea_error error;
    (void)state;
    assert_int_equal(read_drive("time_s,voltage_V\n-3,100\n-1,200\n3,600\n5,0\n", &scene, &error), DEA_OK);
    const dea_waveform *wave = &scene.drive.waveform;
    assert_int_equal(wave->point_count, 3);
    assert_true(wave->times[0] == 0.0 && wave->voltages[0] == 300.0 && wave->times[1] == 3.0);
    assert_non_null(strstr(wave->columns, "before time 0"));
    dea_scene_free(&scene);
    assert_int_equal(read_drive("time_s,voltage_V\n-3,100\n-1,200\n", &scene, &error), DEA_OK);
    assert_int_equal(scene.drive.waveform.point_count, 1);
    assert_true(scene.drive.waveform.voltages[0] == 200.0);
    dea_scene_free(&scene);
}

static void two_rows_of_one_time_are_a_jump(void **state)
{
    static const double times[] = {0.0, 0.01, 0.01, 0.02, 0.02, 0.04}, voltages[] = {0, 0, 3000, 3000, 0, 0};
    dea_scene scene;
    dea_error error;
    (void)state;
    assert_int_equal(
        read_drive("time_s,voltage_V\n0,0\n0.01,0\n0.01,1000\n0.01,3000\n0.02,3000\n0.02,0\n0.04,0\n", &scene, &error), DEA_OK);
    assert_int_equal(scene.drive.waveform.point_count, 6);
    assert_memory_equal(scene.drive.waveform.times, times, sizeof times);
    assert_memory_equal(scene.drive.waveform.voltages, voltages, sizeof voltages);
    dea_scene_free(&scene);
}

/* Teeth of 1 s: each falls at once where it ends. */
static void a_sawtooth_keeps_its_teeth(void **state)
{
    dea_scene scene;
    dea_error error;
    (void)state;
    assert_int_equal(read_drive("time_s,voltage_V\n0,0\n1,1000\n1,0\n2,1000\n2,0\n3,1000\n3,0\n", &scene, &error), DEA_OK);
    const dea_waveform *wave = &scene.drive.waveform;
    assert_int_equal(wave->point_count, 7);
    for (size_t i = 0; i < 7; i++) {
        assert_true(wave->voltages[i] == (i % 2 ? 1000.0 : 0.0) && wave->times[i] == (double)((i + 1) / 2));
    }
    assert_non_null(strstr(wave->columns, "two rows at one time are a jump"));
    dea_scene_free(&scene);
}

/* What is wrong with a drive is named, with what to do. */
static void drives_that_are_none_say_what_to_change(void **state)
{
    static const char *const cases[][2] = {
        {"0 0 10m 1k 20m 3k\n", "a single row of numbers; accepted: two or more"},
        {"time_s,voltage_V\n0,100\n", "a single row of numbers"},
        {"\xff\xfet,V\n0,0\n1,1\n", "UTF-16"},
        {"X,CH1,CH2\nSecond,Volt,Volt\n0,0,1\n0.01,1000,1\n", "a second column of the same kind; give the one that is not meant another name: \"Volt\""},
        {"time_s,voltage_V\n0,0\n0.02,1\n0.01,2\n", ":4:1: drive.waveform.file: this time lies before that of the row above"},
        {"time_s,voltage_V\n0,0\n0.02,\n", ":3:6: drive.waveform.file: an empty field"},
        {"time_s,voltage_V\n0,0\n0.02,nan\n", "not a number: \"nan\""},
        {"time_s;voltage_V\n0;0\n0,02;3.000\n", "with decimal comma"},
        {"time_s,voltage_V\n0,0\n0,01,1,5\n", "4 fields where the header has 2; a decimal comma wants ; or a tab"},
    };
    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        dea_scene scene;
        dea_error error;
        assert_int_equal(read_drive(cases[i][0], &scene, &error), DEA_ERROR_SCENE);
        if (!strstr(error.message, cases[i][1])) {
            fail_msg("drive %zu: %s", i, error.message);
        }
    }
}

/* A clock of 0.1 s under samples every 0.05 s: no jumps but means. */
static void rows_of_a_coarse_clock_become_their_mean(void **state)
{
    char text[4096] = "time_s,voltage_V\n";
    dea_scene scene;
    dea_error error;
    (void)state;
    for (int i = 0; i < 100; i++) {
        snprintf(text + strlen(text), sizeof text - strlen(text), "%.1f,%d\n", floor(i / 2) / 10.0, 10 * i);
    }
    assert_int_equal(read_drive(text, &scene, &error), DEA_OK);
    assert_int_equal(scene.drive.waveform.point_count, 50);
    assert_non_null(strstr(scene.drive.waveform.columns, "counts their mean"));
    assert_true(scene.drive.waveform.voltages[7] == 145.0 && scene.drive.waveform.times[7] == 0.7);
    dea_scene_free(&scene);
}

/* Stretch 1.1 and 1.2 under 100 and 200 kPa, whatever was measured of it. */
static void pulls_of_many_shapes_are_one_pull(void **state)
{
    static const char *const texts[] = {
        "stretch,stress_kPa\n1.1,100\n1.2,200\n",
        "Strain (%);Stress (MPa)\n10,0;0,1\n20,0;0,2\n",
        "strain,nominal stress [kPa]\n0.1,100\n0.2,200\n",
        "\nTime,Displacement,Force\n(s),(mm),(kN)\n\"0.0\",\"4\",\"0.002\"\n\"0.5\",\"8\",\"0.004\"\n",
        "\r\n\xca\xb1\xbc\xe4,\xce\xbb\xd2\xc6,\xc1\xa6\r\n(s),(mm),(N)\r\n\"0\",\"4\",\"2\"\r\n\"1\",\"8\",\"4\"\r\n",
        "Extension_mm\tLoad_N\tremark\n4\t2\tslow\n8\t4\tslow\n",
    };
    (void)state;
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        dea_fit_data data = {.specimen = {.length = 0.04, .area = 20e-6}};
        dea_error error = {0};
        if (dea_fit_parse(texts[i], strlen(texts[i]), "pull.csv", DEA_LOAD_UNIAXIAL, &data, &error) != DEA_OK) {
            fail_msg("pull %zu: %s", i, error.message);
        }
        assert_int_equal(data.count, 2);
        if (fabs(data.points[0].stretch - 1.1) > 1e-12) {
            fail_msg("pull %zu: %.17g %.17g, %s", i, data.points[0].stretch, data.points[0].stress, data.columns);
        }
        assert_true(fabs(data.points[0].stretch - 1.1) < 1e-12 && fabs(data.points[1].stretch - 1.2) < 1e-12);
        assert_true(fabs(data.points[0].stress - 1e5) < 1e-9 && fabs(data.points[1].stress - 2e5) < 1e-9);
        dea_fit_data_free(&data);
    }
}

/* A machine writes the ramp too: the displacement tells when the hold begins. */
static void the_displacement_tells_ramp_and_hold(void **state)
{
    static const char text[] = "time_s,displacement_mm,force_N\n"
                               "5,0,0\n6,0,0\n7,20,3\n8,40,5\n9,40,4\n10,40,3.5\n12,40.01,3\n16,40,2.5\n";
    dea_relaxation_data data = {.specimen = {.area = 1e-6}};
    dea_error error = {0};
    (void)state;
    assert_int_equal(dea_relaxation_parse(text, strlen(text), "hold.csv", &data, &error), DEA_OK);
    assert_int_equal(data.count, 5);
    assert_true(data.ramp == 2.0 && data.points[0].time == 0.0 && data.points[4].time == 8.0);
    assert_true(fabs(data.points[0].stress - 5e6) < 1e-6);
    dea_relaxation_data_free(&data);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(drives_of_many_shapes_are_one_drive), cmocka_unit_test(a_record_before_its_trigger_is_cut_at_zero),
        cmocka_unit_test(two_rows_of_one_time_are_a_jump),     cmocka_unit_test(rows_of_a_coarse_clock_become_their_mean),
        cmocka_unit_test(a_sawtooth_keeps_its_teeth),          cmocka_unit_test(drives_that_are_none_say_what_to_change),
        cmocka_unit_test(pulls_of_many_shapes_are_one_pull),   cmocka_unit_test(the_displacement_tells_ramp_and_hold),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
