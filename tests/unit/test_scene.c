/* The scene reader: good scenes, axes, units, settings, materials, and a corpus of bad scenes. Runs from the project's folder. */
#include <dirent.h>
#include <locale.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cmocka.h>

#include "deaspice/model.h"
#include "deaspice/scene.h"

#define BAD "tests/bad/"

#define DOT                                                                                                                      \
    "actuator: {kind: dot, frame_radius: 30 mm, coverage: 0.5, film_thickness: 100 um, prestretch: 1.2}\n"                       \
    "material: elastosil-2030\n"                                                                                                 \
    "drive: {voltage: 4500 V}\n"                                                                                                 \
    "model: lumped\n"
#define ONE "study: {sweep: {}}\n"
/* What a scene without a drive holds, and the step of a film that is switched on and off. */
#define FILM                                                                                                                     \
    "actuator: {kind: dot, frame_radius: 30 mm, coverage: 0.5, film_thickness: 100 um, prestretch: 1.2}\n"                       \
    "material: elastosil-2030\nmodel: lumped\n"
#define SWITCHED "drive: {waveform: {step: {on: 5 s, off: 15 s, voltage: 4500 V}}}\n"
#define TRANSIENT "study: {transient: {until: 25 s}}\n"
#define AC "study: {ac: {from: 1 Hz, to: 10 kHz}}\n"

/* A scene that must be good. */
typedef struct loaded {
    dea_scene scene;
    dea_error error;
} loaded;

static dea_status parse(loaded *self, const char *text, const char *setting, const char *model)
{
    const dea_setting settings[] = {{.text = setting}};
    self->error = (dea_error){.status = DEA_OK};
    return dea_scene_parse(text, strlen(text), "t", "tests/bad/parts", settings, setting ? 1 : 0, model, &self->scene,
                           &self->error);
}

static void load(loaded *self, const char *text, const char *setting)
{
    if (parse(self, text, setting, NULL) != DEA_OK) {
        fail_msg("%s", self->error.message);
    }
}

/* The scene must be refused with a message that starts so. */
static void refuse(const char *text, const char *setting, const char *message)
{
    loaded it;
    const dea_status status = parse(&it, text, setting, NULL);
    dea_scene_free(&it.scene);
    if (status != DEA_ERROR_SCENE || strncmp(it.error.message, message, strlen(message)) != 0) {
        fail_msg("wanted \"%s\", got status %d and \"%s\"", message, (int)status, status ? it.error.message : "");
    }
}

/* The scene must be refused, with these lines and this caret. */
static void refuse_showing(const char *text, const char *setting, const char *excerpt)
{
    loaded it;
    assert_int_equal(parse(&it, text, setting, NULL), DEA_ERROR_SCENE);
    assert_string_equal(it.error.excerpt, excerpt);
}

static void frame_radius_reads(const char *quantity, double wanted)
{
    char setting[128];
    static const char thin[] =
        "actuator: {kind: dot, frame_radius: 1 m, coverage: 0.5, film_thickness: 1e-300 m, prestretch: 1}\n"
        "material: elastosil-2030\ndrive: {voltage: 1 V}\nmodel: lumped\n" ONE;
    loaded it;
    snprintf(setting, sizeof setting, "frame_radius=%s", quantity);
    load(&it, thin, setting);
    if (it.scene.actuator.frame_radius != wanted) {
        fail_msg("%s is %.17g m, not %.17g m", quantity, it.scene.actuator.frame_radius, wanted);
    }
    dea_scene_free(&it.scene);
}

static void scene_of_the_documentation_is_read(void **state)
{
    (void)state;
    loaded it;
    load(&it,
         "title: Elastosil 2030 dot actuator, 4.5 kV\n" DOT
         "study:\n  sweep:\n    coverage: {from: 0.05, to: 0.95, points: 181}\n"
         "    prestretch: [1.1, 1.2, 1.3]\n    voltage: {from: 0 V, to: 4500 V, points: 10}\naccuracy: 1e-7\n",
         NULL);
    assert_string_equal(it.scene.title, "Elastosil 2030 dot actuator, 4.5 kV");
    assert_int_equal(it.scene.actuator.kind, DEA_DOT);
    assert_true(it.scene.actuator.frame_radius == 0.03);
    assert_true(it.scene.actuator.film_thickness == 1e-4);
    assert_true(it.scene.actuator.coverage == 0.5);
    assert_true(isnan(it.scene.actuator.divide_radius));
    assert_true(isnan(it.scene.actuator.electrode_mass));
    assert_true(it.scene.actuator.prestretch == 1.2);
    assert_true(it.scene.drive.voltage == 4500.0);
    assert_true(it.scene.accuracy == 1e-7);
    assert_string_equal(it.scene.material.name, "elastosil-2030");
    assert_true(it.scene.material.constants[1] == -6023.0);
    assert_ptr_equal(it.scene.models[0], dea_model_find("lumped"));
    assert_int_equal(it.scene.axis_count, 3);
    assert_int_equal(dea_scene_point_count(&it.scene), 181 * 3 * 10);
    dea_scene_free(&it.scene);
}

static void what_a_scene_leaves_out_has_its_default(void **state)
{
    (void)state;
    loaded it;
    load(&it, DOT ONE, NULL);
    assert_string_equal(it.scene.title, "");
    assert_true(it.scene.accuracy == 1e-6);
    assert_true(isnan(it.scene.drive.series_resistance));
    assert_true(isnan(it.scene.drive.leakage_resistance));
    assert_true(isnan(it.scene.material.breakdown));
    assert_int_equal(it.scene.axis_count, 0);
    assert_int_equal(dea_scene_point_count(&it.scene), 1);
    dea_scene_free(&it.scene);
}

static void axis_knows_its_key_column_unit_and_place(void **state)
{
    (void)state;
    static const struct {
        const char *axis, *key, *column, *unit;
        size_t offset;
        bool changes_film;
    } cases[] = {
        {"coverage: [0.5]", "actuator.coverage", "coverage", "1", offsetof(dea_scene, actuator.coverage), false},
        {"drive.voltage: [1 V]", "drive.voltage", "voltage_V", "V", offsetof(dea_scene, drive.voltage), false},
        {"frame_radius: [3 cm]", "actuator.frame_radius", "frame_radius_m", "m", offsetof(dea_scene, actuator.frame_radius),
         false},
        {"prestretch: [1.1]", "actuator.prestretch", "prestretch", "1", offsetof(dea_scene, actuator.prestretch), true},
        {"yeoh.C1: [1 kPa]", "material.yeoh.C1", "C1_Pa", "Pa", offsetof(dea_scene, material.constants[0]), true},
        {"breakdown: [80 V/um]", "material.breakdown", "breakdown_V_per_m", "V/m", offsetof(dea_scene, material.breakdown), true},
        {"series_resistance: [1 MOhm]", "drive.series_resistance", "series_resistance_Ohm", "ohm",
         offsetof(dea_scene, drive.series_resistance), false},
        {"permittivity.constant: [2]", "material.permittivity.constant", "permittivity_constant", "1",
         offsetof(dea_scene, material.permittivity), true},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char text[1024];
        loaded it;
        snprintf(text, sizeof text, DOT "study: {sweep: {%s}}\n", cases[i].axis);
        load(&it, text, NULL);
        const dea_axis *axis = &it.scene.axes[0];
        assert_string_equal(axis->key, cases[i].key);
        assert_string_equal(axis->column, cases[i].column);
        assert_string_equal(axis->unit, cases[i].unit);
        assert_int_equal(axis->offset, cases[i].offset);
        assert_int_equal(axis->changes_film, cases[i].changes_film);
        dea_scene_free(&it.scene);
    }
}

static void uniform_axis_is_evenly_spaced_with_exact_ends(void **state)
{
    (void)state;
    loaded it;
    load(&it, DOT "study: {sweep: {coverage: {from: 0.05, to: 0.95, points: 181}}}\n", NULL);
    const dea_axis *axis = &it.scene.axes[0];
    assert_true(axis->uniform);
    assert_int_equal(axis->count, 181);
    assert_true(axis->values[0] == 0.05 && axis->values[180] == 0.95);
    for (size_t i = 0; i < axis->count; i++) {
        assert_true(fabs(axis->values[i] - (0.05 + 0.9 * (double)i / 180.0)) <= 1e-15);
    }
    dea_scene_free(&it.scene);
}

/* What a reader of the scene would write down for a place on the axis, read by strtod() to the nearest double. */
static void axis_values_are_the_decimals_meant(void **state)
{
    (void)state;
    static const struct {
        const char *axis, *decimal; /* of step i: i times this many times 10^exponent */
        long first, step;
    } axes[] = {
        {"coverage: {from: 0.05, to: 0.95, points: 181}", "e-3", 50, 5},
        {"voltage: {from: 0 V, to: 4500 V, points: 451}", "e0", 0, 10},
        {"voltage: {from: 4.5 kV, to: -4.5 kV, points: 91}", "e2", 45, -1},
        {"film_thickness: {from: 1 um, to: 300 um, points: 300}", "e-6", 1, 1},
        {"frame_radius: {from: 0.1 mm, to: 30 mm, points: 300}", "e-4", 1, 1},
        {"prestretch: {from: 1.05, to: 2.35, points: 131}", "e-2", 105, 1},
        {"material.yeoh.C1: {from: 0.123 MPa, to: 0.323 MPa, points: 2001}", "e2", 1230, 1},
    };
    for (size_t a = 0; a < sizeof axes / sizeof *axes; a++) {
        char text[1024], decimal[64];
        loaded it;
        snprintf(text, sizeof text,
                 "actuator: {kind: dot, frame_radius: 30 mm, coverage: 0.5, film_thickness: 100 um, prestretch: 1.2}\n"
                 "material: {yeoh: {C1: 178426 Pa, C2: -6023 Pa, C3: 4234 Pa}, permittivity: 2.8}\nmodel: lumped\n"
                 "drive: {voltage: 4500 V}\nstudy: {sweep: {%s}}\n",
                 axes[a].axis);
        load(&it, text, NULL);
        for (size_t i = 0; i < it.scene.axes[0].count; i++) {
            snprintf(decimal, sizeof decimal, "%ld%s", axes[a].first + axes[a].step * (long)i, axes[a].decimal);
            if (it.scene.axes[0].values[i] != strtod(decimal, NULL)) {
                fail_msg("%s: value %zu is %.17g, not %s", axes[a].axis, i, it.scene.axes[0].values[i], decimal);
            }
        }
        dea_scene_free(&it.scene);
    }
}

static void values_and_samples_are_the_decimals_meant(void **state)
{
    (void)state;
    loaded it;
    char decimal[64], text[4096] = DOT "study: {sweep: {film_thickness: [";
    for (int i = 1; i < 100; i++) {
        snprintf(text + strlen(text), sizeof text - strlen(text), "%s0.%02d mm", i > 1 ? ", " : "", i);
    }
    strcat(text, "]}}\n");
    load(&it, text, NULL);
    for (int i = 1; i < 100; i++) {
        snprintf(decimal, sizeof decimal, "%de-5", i);
        assert_true(it.scene.axes[0].values[i - 1] == strtod(decimal, NULL));
    }
    dea_scene_free(&it.scene);
    load(&it, FILM SWITCHED "study: {transient: {until: 25 s, every: 10 ms}}\n", NULL);
    for (int i = 0; i <= 2500; i++) {
        snprintf(decimal, sizeof decimal, "%de-2", i);
        assert_true(dea_layout_place(&it.scene, (size_t)i) == strtod(decimal, NULL));
    }
    it.scene.transient.every = 1.0 / 3.0; /* not on the grid that was read */
    assert_true(dea_layout_place(&it.scene, 7) == 7.0 * (1.0 / 3.0));
    dea_scene_free(&it.scene);
}

static void logarithmic_axis_has_equal_ratios(void **state)
{
    (void)state;
    loaded it;
    load(&it, DOT "study: {sweep: {series_resistance: {from: 1 kOhm, to: 1 GOhm, points: 7, spacing: log}}}\n", NULL);
    const dea_axis *axis = &it.scene.axes[0];
    assert_false(axis->uniform);
    assert_true(axis->values[6] == 1e9);
    for (size_t i = 1; i < axis->count; i++) {
        assert_true(fabs(axis->values[i] / axis->values[i - 1] - 10.0) <= 1e-12);
    }
    dea_scene_free(&it.scene);
}

static void axis_of_one_point_is_its_start(void **state)
{
    (void)state;
    loaded it;
    load(&it, DOT "study: {sweep: {voltage: {from: 1 kV, points: 1}}}\n", NULL);
    assert_int_equal(it.scene.axes[0].count, 1);
    assert_true(it.scene.axes[0].values[0] == 1000.0);
    assert_false(it.scene.axes[0].uniform);
    dea_scene_free(&it.scene);
}

static void swept_key_counts_as_given(void **state)
{
    (void)state;
    loaded it;
    load(&it,
         "actuator: {kind: dot, frame_radius: 30 mm, film_thickness: 100 um}\nmaterial: elastosil-2030\nmodel: lumped\n"
         "study: {sweep: {prestretch: [1.3, 1.1], coverage: [0.25, 0.5], voltage: [1 kV]}}\n",
         NULL);
    assert_true(it.scene.actuator.prestretch == 1.3);
    assert_true(it.scene.actuator.coverage == 0.25);
    assert_true(it.scene.drive.voltage == 1000.0);
    dea_scene_free(&it.scene);
}

static void scalar_of_the_scene_survives_its_sweep(void **state)
{
    (void)state;
    loaded it;
    load(&it, DOT "study: {sweep: {coverage: [0.25]}}\n", NULL);
    assert_true(it.scene.actuator.coverage == 0.5);
    dea_scene_free(&it.scene);
}

static void clashing_columns_take_more_of_their_path(void **state)
{
    (void)state;
    loaded it;
    load(&it, DOT "study: {sweep: {material.prony.0.tau: [1 s], material.prony.1.tau: [2 s]}}\n",
         "material.prony=[{g: 0.1, tau: 1 s}, {g: 0.1, tau: 2 s}]");
    assert_string_equal(it.scene.axes[0].column, "prony_0_tau_s");
    assert_string_equal(it.scene.axes[1].column, "prony_1_tau_s");
    assert_int_equal(it.scene.axes[1].offset, offsetof(dea_scene, material.prony[1].tau));
    dea_scene_free(&it.scene);
}

static void corner_of_a_grid_past_the_frame_is_no_scene_error(void **state)
{
    (void)state;
    loaded it;
    load(&it, DOT "study: {sweep: {frame_radius: [1 cm, 3 cm]}}\n", "electrode_radius=15 mm");
    assert_true(it.scene.actuator.divide_radius == 0.015);
    assert_true(isnan(it.scene.actuator.coverage));
    dea_scene_free(&it.scene);
}

static void units_convert_to_the_nearest_double(void **state)
{
    (void)state;
    frame_radius_reads("30 mm", 0.03);
    frame_radius_reads("30mm", 0.03);
    frame_radius_reads("100 um", 1e-4);
    frame_radius_reads("100 \xC2\xB5m", 1e-4);
    frame_radius_reads("100 \xCE\xBCm", 1e-4);
    frame_radius_reads("3 cm", 0.03);
    frame_radius_reads("+.03 m", 0.03);
    frame_radius_reads("3.E-2 m", 0.03);
    frame_radius_reads("7 nm", 7e-9);
    frame_radius_reads("0.03 km / km * m", 0.03);
}

static void rare_units_come_from_the_database(void **state)
{
    (void)state;
    loaded it;
    load(&it, DOT ONE, "frame_radius=1 inch");
    assert_true(fabs(it.scene.actuator.frame_radius - 0.0254) <= 1e-17);
    dea_scene_free(&it.scene);
}

static void quantities_of_every_dimension_are_read(void **state)
{
    (void)state;
    static const struct {
        const char *setting;
        size_t offset;
        double value;
    } cases[] = {
        {"coverage=48 %", offsetof(dea_scene, actuator.coverage), 0.48},
        {"breakdown=80 V/um", offsetof(dea_scene, material.breakdown), 80e6},
        {"breakdown=80 kV/mm", offsetof(dea_scene, material.breakdown), 80e6},
        {"modulus=1.2 MPa", offsetof(dea_scene, material.modulus), 1.2e6},
        {"modulus=1.2 N/mm^2", offsetof(dea_scene, material.modulus), 1.2e6},
        {"modulus=12 N mm-2", offsetof(dea_scene, material.modulus), 12e6},
        {"modulus=12 N.mm^-2", offsetof(dea_scene, material.modulus), 12e6},
        {"electrode_mass=25 g/m^2", offsetof(dea_scene, actuator.electrode_mass), 0.025},
        {"electrode_mass=25 g/m\xC2\xB2", offsetof(dea_scene, actuator.electrode_mass), 0.025},
        {"density=1.08 g/cm^3", offsetof(dea_scene, material.density), 1080.0},
        {"retardation=1 ms", offsetof(dea_scene, material.retardation), 1e-3},
        {"retardation=2 min", offsetof(dea_scene, material.retardation), 120.0},
        {"series_resistance=0 Ohm", offsetof(dea_scene, drive.series_resistance), 0.0},
        {"series_resistance=1 MOhm", offsetof(dea_scene, drive.series_resistance), 1e6},
        {"series_resistance=1 k\xCE\xA9", offsetof(dea_scene, drive.series_resistance), 1e3},
        {"leakage_resistance=100 GOhm", offsetof(dea_scene, drive.leakage_resistance), 1e11},
        {"voltage=-4.5 kV", offsetof(dea_scene, drive.voltage), -4500.0},
        {"C2=-6.023 kPa", offsetof(dea_scene, material.constants[1]), -6023.0},
        {"accuracy=1e-3", offsetof(dea_scene, accuracy), 1e-3},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        loaded it;
        load(&it, DOT ONE, cases[i].setting);
        const double value = *(double *)((char *)&it.scene + cases[i].offset);
        if (!(fabs(value - cases[i].value) <= 4e-16 * fabs(cases[i].value))) {
            fail_msg("%s gives %.17g", cases[i].setting, value);
        }
        dea_scene_free(&it.scene);
    }
}

static void broken_quantities_are_refused(void **state)
{
    (void)state;
    static const char *const bad[] = {
        "",        "mm",      "30",      "30 s",   "30 mm 3", "30 mm;",   "30 mm; x",   "30 m m",   "30 mm^",
        "30 mm^x", "30 (mm)", "30 mm@0", "30 m-",  "30 /mm",  "30 mm/",   "30 mm//s*s", "inf m",    "nan m",
        "NaN",     "1e999 m", "-1 m",    "0 m",    "0x1p3 m", "1_000 mm", "30,5 mm",    "30 30 mm", "1e-999 m",
        "30 %",    "30 degC", "30 dB",   "--3 mm", "+-3 mm",  "3 mm\tx",  "1e400 km",   "1e308 km", "3..1 m",
    };
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        char setting[64];
        snprintf(setting, sizeof setting, "frame_radius=%s", bad[i]);
        refuse(DOT ONE, setting, "--set frame_radius=");
    }
    refuse(DOT ONE, "coverage=0.5 mm", "--set coverage=0.5 mm: actuator.coverage: takes a bare number");
}

static void missing_unit_database_is_named(void **state)
{
    (void)state;
    const char *before = getenv("UDUNITS2_XML_PATH");
    setenv("UDUNITS2_XML_PATH", "/nonexistent/udunits2.xml", 1);
    frame_radius_reads("30 mm", 0.03);
    refuse(DOT ONE, "frame_radius=1 inch",
           "--set frame_radius=1 inch: actuator.frame_radius: unknown unit \"inch\", and the UDUNITS database of further units "
           "cannot be read");
    before ? setenv("UDUNITS2_XML_PATH", before, 1) : unsetenv("UDUNITS2_XML_PATH");
}

/* A locale with a decimal comma: one that is installed, else one built by localedef in a scratch folder; skipped without both. */
static bool comma_locale(void)
{
    static const char *const names[] = {"de_DE.UTF-8", "de_DE.utf8", "fr_FR.UTF-8", "de_DE"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        if (setlocale(LC_ALL, names[i])) {
            return localeconv()->decimal_point[0] == ',';
        }
    }
    char folder[] = "/tmp/dea-locale-XXXXXX";
    char command[256];
    if (!mkdtemp(folder)) {
        return false;
    }
    snprintf(command, sizeof command, "localedef -i de_DE -f UTF-8 %s/de_DE.UTF-8 >/dev/null 2>&1", folder);
    setenv("LOCPATH", folder, 1);
    const bool found = system(command) != -1 && setlocale(LC_ALL, "de_DE.UTF-8") && localeconv()->decimal_point[0] == ',';
    unsetenv("LOCPATH");
    snprintf(command, sizeof command, "rm -rf %s", folder);
    return system(command) == 0 && found;
}

static void numbers_do_not_depend_on_the_locale(void **state)
{
    (void)state;
    if (!comma_locale()) {
        setlocale(LC_ALL, "C");
        skip();
    }
    frame_radius_reads("30.5 mm", 0.0305);
    loaded it;
    load(&it, DOT ONE, "frame_radius=2.5 inch");
    const double inches = it.scene.actuator.frame_radius;
    dea_scene_free(&it.scene);
    const char comma = localeconv()->decimal_point[0];
    setlocale(LC_ALL, "C");
    assert_int_equal(comma, ',');
    assert_true(fabs(inches - 0.0635) <= 1e-16);
}

static void setting_replaces_what_the_file_says(void **state)
{
    (void)state;
    loaded it;
    load(&it, DOT ONE, "actuator.prestretch=1.3");
    assert_true(it.scene.actuator.prestretch == 1.3);
    dea_scene_free(&it.scene);
    load(&it, DOT ONE, " title = dot #3: [x] ");
    assert_string_equal(it.scene.title, "dot #3: [x]");
    dea_scene_free(&it.scene);
    load(&it, DOT ONE, "material=vhb-4910");
    assert_string_equal(it.scene.material.name, "vhb-4910");
    dea_scene_free(&it.scene);
    load(&it, DOT ONE, "model=[lame, coverage]");
    assert_int_equal(it.scene.model_count, 2);
    dea_scene_free(&it.scene);
}

static void later_setting_of_a_key_wins(void **state)
{
    (void)state;
    const dea_setting settings[] = {{"prestretch=1.3"}, {"actuator.prestretch=1.1"}};
    loaded it = {.error = {.status = DEA_OK}};
    assert_int_equal(dea_scene_parse(DOT ONE, strlen(DOT ONE), "t", NULL, settings, 2, NULL, &it.scene, &it.error), DEA_OK);
    assert_true(it.scene.actuator.prestretch == 1.1);
    dea_scene_free(&it.scene);
}

static void coverage_and_radius_replace_each_other_by_setting(void **state)
{
    (void)state;
    loaded it;
    load(&it, DOT ONE, "electrode_radius=10 mm");
    assert_true(it.scene.actuator.divide_radius == 0.01 && isnan(it.scene.actuator.coverage));
    dea_scene_free(&it.scene);
    load(&it, DOT ONE, "study.sweep.electrode_radius=[5 mm, 10 mm]");
    assert_true(it.scene.actuator.divide_radius == 0.005 && isnan(it.scene.actuator.coverage));
    dea_scene_free(&it.scene);
}

static void setting_of_an_axis_replaces_or_adds_it(void **state)
{
    (void)state;
    loaded it;
    load(&it, DOT "study: {sweep: {actuator.coverage: [0.2], voltage: [1 V]}}\n",
         "study.sweep.coverage={from: 0.1, to: 0.9, points: 5}");
    assert_int_equal(it.scene.axis_count, 2);
    assert_string_equal(it.scene.axes[0].key, "actuator.coverage");
    assert_int_equal(it.scene.axes[0].count, 5);
    dea_scene_free(&it.scene);
    load(&it, DOT ONE, "sweep.prestretch=[1.1, 1.2]");
    assert_int_equal(dea_scene_point_count(&it.scene), 2);
    dea_scene_free(&it.scene);
    load(&it, DOT, "study.sweep={voltage: [1 V, 2 V, 3 V]}");
    assert_int_equal(dea_scene_point_count(&it.scene), 3);
    dea_scene_free(&it.scene);
}

static void bad_settings_are_refused_by_name(void **state)
{
    (void)state;
    static const char sweep[] = DOT "study: {sweep: {prestretch: [1.1, 1.2]}}\n";
    refuse(DOT ONE, "covrage=0.4", "--set covrage=0.4: covrage: unknown key; did you mean actuator.coverage?");
    refuse(DOT ONE, "actuator.covrage=0.4", "--set actuator.covrage=0.4: actuator.covrage: unknown key; did you mean coverage?");
    refuse(DOT ONE, "actuator.voltage=2 V",
           "--set actuator.voltage=2 V: actuator.voltage: unknown key; voltage stands in drive; ");
    refuse(DOT ONE, "nothing=2", "--set nothing=2: nothing: unknown key; accepted: keys of the scene, e.g. actuator.prestretch");
    refuse(DOT ONE, "prony[0].tau=1 s",
           "--set prony[0].tau=1 s: prony[0].tau: unknown key; an index, counted from 0, stands between points: prony.0.tau");
    refuse(DOT ONE, "study.sweep.prony[0].tau=[1 s]",
           "--set study.sweep.prony[0].tau=[1 s]: study.sweep.prony[0].tau: unknown key; an index, counted from 0, stands ");
    refuse(DOT ONE, "voltage=4.5 kv",
           "--set voltage=4.5 kv: drive.voltage: unknown unit \"kv\", did you mean kV? (4.5 kv); accepted: ");
    refuse(DOT ONE, "coverage=2", "--set coverage=2: actuator.coverage: out of range (2); accepted: a ratio > 0 and < 1");
    refuse(DOT ONE, "coverage", "--set coverage: setting: not of the form key=value");
    refuse(DOT ONE, "=1", "--set =1: setting: not of the form key=value");
    refuse(DOT ONE, "coverage=[0.5", "--set coverage=[0.5: syntax: ");
    refuse(DOT ONE, "coverage=0.5\x01", "--set coverage=0.5\\x01: setting: a control character");
    refuse(DOT ONE, "drive.waveform={step: {}}",
           "--set drive.waveform={step: {}}: drive.waveform: belongs to study.transient, but the study is sweep");
    refuse(DOT ONE, "study.transient={until: 1 s}",
           "t:3:18: drive.waveform: missing; a transient takes it in place of drive.voltage");
    refuse(DOT ONE, "prony.0={g: 0.1, tau: 1 s}",
           "--set prony.0={g: 0.1, tau: 1 s}: material.prony.0: cannot be set as a whole; accepted: all of material.prony");
    refuse(DOT ONE, "prony.0.tau=1 s", "--set prony.0.tau=1 s: material.prony.0.tau: the material has 0 branches");
    refuse(sweep, "prestretch=1.3",
           "--set prestretch=1.3: actuator.prestretch: is swept by the scene; set study.sweep.actuator.prestretch=[1.3] instead");
    refuse(DOT "study: {sweep: {coverage: [0.5]}}\n", "electrode_radius=1 mm",
           "--set electrode_radius=1 mm: actuator.electrode_radius: contradicts actuator.coverage, which the scene sweeps");
}

static void mistake_is_shown_with_its_line_and_a_caret(void **state)
{
    (void)state;
    refuse_showing("title: x\nactuator:\n  kind: dot\n  coverge: 0.5\n", NULL, "    4 |   coverge: 0.5\n      |   ^");
    refuse_showing("title: x\r\nmodel:\t[lumpd]\r\n", NULL, "    2 | model:\t[lumpd]\n      |       \t ^");
    refuse_showing("title: \"\u00b5m\"\nmodel: x # \u00b5m\u202e\n", NULL, "    2 | model: x # \u00b5m?\n      |        ^");
    refuse_showing("title: x", "study.sweep.coverage=[0.5, 5]", "      | [0.5, 5]\n      |       ^");
    refuse_showing("title: x", "coverage=5", "");
    refuse_showing("", NULL, "");
    refuse_showing("\x01\x02\x03\x04\x05", NULL, "");
}

static void long_line_is_shown_around_its_mistake(void **state)
{
    (void)state;
    char text[1200];
    char wanted[400];
    snprintf(text, sizeof text, "{title: \"%0500d\", modle: lumped, x: %0100d}\n", 0, 0);
    snprintf(wanted, sizeof wanted, "    1 | ...%057d\", modle: lumped, x: %022d...\n      | %63s^", 0, 0, "");
    refuse_showing(text, NULL, wanted);
}

static void file_that_is_no_material_is_not_shown(void **state)
{
    (void)state;
    static const char front[] = "actuator: {kind: dot}\nmaterial: ";
    char text[200];
    snprintf(text, sizeof text, "%s./word.csv\n", front);
    refuse_showing(text, NULL, "");
    snprintf(text, sizeof text, "%s./negative.yaml\n", front);
    refuse_showing(text, NULL, "    2 |   C1: -5 Pa\n      |       ^");
}

static void model_argument_replaces_the_models_of_the_scene(void **state)
{
    (void)state;
    loaded it;
    assert_int_equal(parse(&it, DOT ONE, NULL, "field,lame"), DEA_OK);
    assert_int_equal(it.scene.model_count, 2);
    assert_ptr_equal(it.scene.models[0], dea_model_find("field"));
    dea_scene_free(&it.scene);
    assert_int_equal(parse(&it, DOT ONE, NULL, "field, lame"), DEA_OK);
    assert_int_equal(it.scene.model_count, 2);
    dea_scene_free(&it.scene);
    assert_int_equal(parse(&it, DOT ONE, NULL, "field lame"), DEA_ERROR_SCENE);
    assert_non_null(strstr(it.error.message, "unknown model (field lame); several are written field,lame; accepted: "));
    assert_int_equal(parse(&it, DOT ONE, NULL, "field,"), DEA_ERROR_SCENE);
    assert_int_equal(strncmp(it.error.message, "--model: model: unknown model", 29), 0);
    assert_int_equal(parse(&it, DOT ONE, NULL, "field,field"), DEA_ERROR_SCENE);
    assert_int_equal(strncmp(it.error.message, "--model: model: named twice", 27), 0);
}

static void material_is_written_out_or_built_on_another(void **state)
{
    (void)state;
    loaded it;
    load(&it, DOT ONE, "material={yeoh: {C1: 20 kPa}, permittivity: 4.7, density: 960 kg/m^3}");
    assert_string_equal(it.scene.material.name, "scene");
    assert_true(it.scene.material.constants[0] == 20e3 && it.scene.material.constants[1] == 0.0 && it.scene.material.constants[2] == 0.0);
    assert_true(isnan(it.scene.material.breakdown));
    dea_scene_free(&it.scene);
    load(&it, DOT ONE, "material={base: elastosil-2030-solano, yeoh: {C2: 0 Pa}}");
    assert_true(it.scene.material.constants[0] == 180700.0 && it.scene.material.constants[1] == 0.0 && it.scene.material.constants[2] == 6600.0);
    assert_true(it.scene.material.permittivity == 2.76 && it.scene.material.permittivity_per_stretch == -0.28);
    assert_string_equal(it.scene.material.source, "elastosil-2030-solano, with changes");
    dea_scene_free(&it.scene);
    load(&it, DOT ONE, "material={base: elastosil-2030-solano, permittivity: 3}");
    assert_true(it.scene.material.permittivity == 3.0 && it.scene.material.permittivity_per_stretch == 0.0);
    dea_scene_free(&it.scene);
    load(&it, DOT ONE, "material.moduli=instantaneous");
    assert_true(it.scene.material.instantaneous);
    assert_true(it.scene.material.constants[0] == 178426.0);
    dea_scene_free(&it.scene);
}

static void material_file_is_found_beside_the_scene(void **state)
{
    (void)state;
    loaded it;
    load(&it, DOT ONE, "material=soft.yaml");
    assert_string_equal(it.scene.material.name, "soft.yaml");
    assert_string_equal(it.scene.material.source, "made up for the tests");
    assert_true(it.scene.material.constants[0] == 25e3);
    assert_int_equal(it.scene.material.prony_count, 1);
    dea_scene_free(&it.scene);
    load(&it, DOT ONE, "material={base: ./soft.yaml, density: 900 kg/m^3}");
    assert_true(it.scene.material.constants[0] == 25e3 && it.scene.material.density == 900.0);
    dea_scene_free(&it.scene);
}

static void no_material_file_is_read_without_a_folder(void **state)
{
    (void)state;
    const dea_setting settings[] = {{"material=/etc/hostname.d"}};
    loaded it;
    assert_int_equal(dea_scene_parse(DOT ONE, strlen(DOT ONE), "t", NULL, settings, 1, NULL, &it.scene, &it.error),
                     DEA_ERROR_SCENE);
    assert_non_null(strstr(it.error.message, "material: files cannot be named here"));
}

static void builtin_materials_carry_their_source(void **state)
{
    (void)state;
    for (size_t i = 0; i < dea_material_count(); i++) {
        const dea_material *material = dea_material_builtin(i);
        assert_ptr_equal(dea_material_find(material->name), material);
        assert_true(strlen(material->source) > 10);
        assert_true(material->constants[0] > 0.0 && material->permittivity > 0.0);
    }
    const dea_material *vhb = dea_material_find("vhb-4910-neo-hookean");
    assert_non_null(vhb);
    assert_null(dea_material_builtin(dea_material_count()));
    assert_null(dea_material_find("vhb"));
    assert_true(fabs(2.0 * vhb->constants[0] / (1.0 - vhb->prony[0].g - vhb->prony[1].g - vhb->prony[2].g) - 78.78e3) <= 1e-9);
}

static void lens_takes_its_own_keys(void **state)
{
    (void)state;
    loaded it;
    load(&it,
         "actuator: {lens_radius: 8 mm, optics: {focal_length: 22 mm, refractive_index: 1.4}, kind: lens, frame_radius: 30 mm,\n"
         "           film_thickness: 100 um, prestretch: 2}\nmaterial: vhb-4910\ndrive: {voltage: 0 V}\nmodel: field\n" ONE,
         NULL);
    assert_int_equal(it.scene.actuator.kind, DEA_LENS);
    assert_true(it.scene.actuator.divide_radius == 0.008);
    assert_true(it.scene.actuator.focal_length == 0.022 && it.scene.actuator.refractive_index == 1.4);
    dea_scene_free(&it.scene);
}

static void step_of_the_documentation_is_read(void **state)
{
    (void)state;
    loaded it;
    load(&it,
         FILM
         "drive: {waveform: {step: {on: 5 s, off: 15 s, voltage: 4500 V, rise: 1 ms}, period: 20 s}, series_resistance: 1 MOhm}\n"
         "study: {transient: {until: 25 s, every: 10 ms, average: {from: 6 s, to: 8 s}, start: bias}}\n",
         NULL);
    const dea_waveform *waveform = &it.scene.drive.waveform;
    assert_int_equal(it.scene.study, DEA_STUDY_TRANSIENT);
    assert_int_equal(waveform->kind, DEA_WAVE_STEP);
    assert_true(waveform->step.on == 5.0 && waveform->step.off == 15.0);
    assert_true(waveform->step.voltage == 4500.0 && waveform->step.rise == 1e-3);
    assert_true(waveform->period == 20.0);
    assert_true(isnan(it.scene.drive.voltage));
    assert_true(it.scene.drive.series_resistance == 1e6);
    assert_true(it.scene.transient.until == 25.0 && it.scene.transient.every == 0.01);
    assert_true(it.scene.transient.from_bias);
    assert_int_equal(it.scene.transient.average_count, 1);
    assert_true(it.scene.transient.averages[0].from == 6.0 && it.scene.transient.averages[0].to == 8.0);
    assert_int_equal(dea_scene_point_count(&it.scene), 1);
    dea_scene_free(&it.scene);
}

static void what_a_transient_leaves_out_has_its_default(void **state)
{
    (void)state;
    loaded it;
    load(&it, FILM "drive: {waveform: {step: {on: 0 s, voltage: 1 kV}}}\n" TRANSIENT, NULL);
    assert_true(it.scene.drive.waveform.step.rise == 1e-6);
    assert_true(isnan(it.scene.drive.waveform.step.off));
    assert_true(isnan(it.scene.drive.waveform.period));
    assert_true(it.scene.transient.every == 0.025);
    assert_false(it.scene.transient.from_bias);
    assert_int_equal(it.scene.transient.average_count, 0);
    assert_int_equal(it.scene.axis_count, 0);
    dea_scene_free(&it.scene);
    load(&it, FILM "drive: {waveform: {sine: {amplitude: 100 V, frequency: 50 Hz}}}\n" TRANSIENT, NULL);
    assert_true(it.scene.drive.waveform.sine.offset == 0.0);
    assert_true(it.scene.drive.waveform.sine.phase == 0.0 && it.scene.drive.waveform.sine.delay == 0.0);
    dea_scene_free(&it.scene);
}

static void jump_of_a_step_is_a_rise_of_zero(void **state)
{
    (void)state;
    loaded it;
    load(&it, FILM SWITCHED TRANSIENT, "rise=0 s");
    assert_true(it.scene.drive.waveform.step.rise == 0.0);
    dea_scene_free(&it.scene);
    load(&it, FILM "drive: {waveform: {step: {on: 1 s, off: 2 s, voltage: 1 kV, rise: 1 s}, period: 3 s}}\n" TRANSIENT, NULL);
    assert_true(it.scene.drive.waveform.step.rise == 1.0);
    dea_scene_free(&it.scene);
}

static void points_are_read_in_their_order(void **state)
{
    (void)state;
    loaded it;
    load(&it, FILM "drive: {waveform: {points: [[0 s, 0 V], [5 s, 4.5 kV], [5001 ms, -1 V]], period: 6 s}}\n" TRANSIENT, NULL);
    const dea_waveform *waveform = &it.scene.drive.waveform;
    assert_int_equal(waveform->kind, DEA_WAVE_POINTS);
    assert_int_equal(waveform->point_count, 3);
    assert_true(waveform->times[0] == 0.0 && waveform->times[1] == 5.0 && waveform->times[2] == 5.001);
    assert_true(waveform->voltages[0] == 0.0 && waveform->voltages[1] == 4500.0 && waveform->voltages[2] == -1.0);
    assert_true(waveform->period == 6.0);
    dea_scene_free(&it.scene);
}

static void sine_is_read_with_its_phase_in_degrees_or_radians(void **state)
{
    (void)state;
    static const struct {
        const char *phase;
        double radians;
    } cases[] = {{"phase=90 deg", DEA_PI / 2.0}, {"phase=-1.5 rad", -1.5}, {"phase=180\xC2\xB0", DEA_PI}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        loaded it;
        load(&it,
             FILM "drive: {waveform: {sine: {offset: 4 kV, amplitude: 100 V, frequency: 1 kHz, phase: 0 rad, delay: 2 "
                  "ms}}}\n" TRANSIENT,
             cases[i].phase);
        const dea_sine *sine = &it.scene.drive.waveform.sine;
        assert_int_equal(it.scene.drive.waveform.kind, DEA_WAVE_SINE);
        assert_true(sine->offset == 4000.0 && sine->amplitude == 100.0 && sine->frequency == 1000.0 && sine->delay == 0.002);
        assert_true(fabs(sine->phase - cases[i].radians) <= 1e-15);
        dea_scene_free(&it.scene);
    }
}

/* Writes @p text to a file in a new scratch folder, reads a scene beside it, and cleans up. */
static dea_status read_beside(loaded *self, const char *text, size_t length)
{
    char folder[] = "/tmp/dea-wave-XXXXXX";
    char path[64];
    static const char scene[] = FILM "drive: {waveform: {file: drive.csv}}\n" TRANSIENT;
    assert_non_null(mkdtemp(folder));
    snprintf(path, sizeof path, "%s/drive.csv", folder);
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    assert_int_equal(fwrite(text, 1, length, file), length);
    assert_int_equal(fclose(file), 0);
    const dea_status status = dea_scene_parse(scene, strlen(scene), "t", folder, NULL, 0, NULL, &self->scene, &self->error);
    unlink(path);
    rmdir(folder);
    return status;
}

static void waveform_of_a_file_is_read_with_and_without_a_header(void **state)
{
    (void)state;
    static const char *const files[] = {
        "time_s,voltage_V\n0,0\n5,4500\n5.5,-1e-3\n",
        "0,0\n5,4500\n5.5,-1e-3",
        "\xEF\xBB\xBFtime_s, voltage_V\r\n0 ,0\r\n\r\n 5,\t+4500.\r\n5.5,-.001\r\n\r\n",
    };
    for (size_t i = 0; i < sizeof files / sizeof *files; i++) {
        loaded it;
        assert_int_equal(read_beside(&it, files[i], strlen(files[i])), DEA_OK);
        const dea_waveform *waveform = &it.scene.drive.waveform;
        assert_int_equal(waveform->kind, DEA_WAVE_POINTS);
        assert_int_equal(waveform->point_count, 3);
        assert_true(waveform->times[0] == 0.0 && waveform->times[1] == 5.0 && waveform->times[2] == 5.5);
        assert_true(waveform->voltages[0] == 0.0 && waveform->voltages[1] == 4500.0 && waveform->voltages[2] == -1e-3);
        dea_scene_free(&it.scene);
    }
}

/* A million rows are read, one more is refused. */
static void waveform_of_a_file_has_at_most_a_million_rows(void **state)
{
    (void)state;
    for (size_t rows = 1000000; rows <= 1000001; rows++) {
        char *text = malloc(rows * 16);
        size_t used = 0;
        loaded it;
        assert_non_null(text);
        for (size_t i = 0; i < rows; i++) {
            used += (size_t)snprintf(text + used, 16, "%zu,%zu\n", i, i % 7);
        }
        const dea_status status = read_beside(&it, text, used);
        free(text);
        if (rows == 1000000) {
            assert_int_equal(status, DEA_OK);
            assert_int_equal(it.scene.drive.waveform.point_count, rows);
            assert_true(it.scene.drive.waveform.times[rows - 1] == (double)(rows - 1));
            dea_scene_free(&it.scene);
        } else {
            assert_int_equal(status, DEA_ERROR_SCENE);
            assert_non_null(strstr(it.error.message, "drive.csv:1000001:1: drive.waveform.file: too many rows"));
        }
    }
}

static void no_waveform_file_is_read_without_a_folder(void **state)
{
    (void)state;
    static const char text[] = FILM "drive: {waveform: {file: drive.csv}}\n" TRANSIENT;
    loaded it;
    assert_int_equal(dea_scene_parse(text, strlen(text), "t", NULL, NULL, 0, NULL, &it.scene, &it.error), DEA_ERROR_SCENE);
    assert_non_null(strstr(it.error.message, "drive.waveform.file: files cannot be named here"));
}

static void averages_are_one_window_or_a_list(void **state)
{
    (void)state;
    loaded it;
    load(&it, FILM SWITCHED "study: {transient: {until: 25 s, average: [{from: 6 s, to: 8 s}, {from: 16 s, to: 25 s}]}}\n",
         "average.1.from=17 s");
    assert_int_equal(it.scene.transient.average_count, 2);
    assert_true(it.scene.transient.averages[0].from == 6.0 && it.scene.transient.averages[0].to == 8.0);
    assert_true(it.scene.transient.averages[1].from == 17.0 && it.scene.transient.averages[1].to == 25.0);
    dea_scene_free(&it.scene);
    load(&it, FILM SWITCHED "study: {transient: {until: 25 s, average: {from: 6 s, to: 8 s}}}\n",
         "study.transient.average.to=9 s");
    assert_true(it.scene.transient.averages[0].to == 9.0);
    dea_scene_free(&it.scene);
    refuse(FILM SWITCHED "study: {transient: {until: 25 s, average: [{from: 6 s, to: 8 s}]}}\n", "average.1.to=9 s",
           "--set average.1.to=9 s: study.transient.average.1.to: the transient has 1 windows, counted from 0");
    refuse(FILM SWITCHED "study: {transient: {until: 25 s, average: [{from: 1 s, to: 2 s}, {from: 3 s, to: 4 s}]}}\n",
           "average.to=9 s", "--set average.to=9 s: study.transient.average.to: the transient has 2 windows; name one of them");
    refuse(FILM SWITCHED TRANSIENT, "average.to=9 s",
           "--set average.to=9 s: study.transient.average.to: the scene has no study.transient.average");
}

static void frequency_response_takes_its_bias_from_the_study_or_the_drive(void **state)
{
    (void)state;
    loaded it;
    load(&it, DOT AC, NULL);
    assert_int_equal(it.scene.study, DEA_STUDY_AC);
    assert_true(it.scene.ac.from == 1.0 && it.scene.ac.to == 1e4);
    assert_int_equal(it.scene.ac.points_per_decade, 50);
    assert_true(it.scene.ac.bias == 4500.0 && it.scene.drive.voltage == 4500.0);
    dea_scene_free(&it.scene);
    load(&it, FILM "study: {ac: {from: 1 Hz, to: 1 Hz, points_per_decade: 10000, bias: 3 kV}}\n", NULL);
    assert_int_equal(it.scene.ac.points_per_decade, 10000);
    assert_true(it.scene.ac.bias == 3000.0);
    assert_true(isnan(it.scene.drive.voltage));
    dea_scene_free(&it.scene);
    load(&it, FILM "study: {ac: {from: 1 Hz, to: 10 Hz}, over: {bias: [1 kV, 2 kV]}}\n", NULL);
    assert_true(it.scene.ac.bias == 1000.0);
    assert_string_equal(it.scene.axes[0].column, "bias_V");
    assert_int_equal(it.scene.axes[0].offset, offsetof(dea_scene, ac.bias));
    dea_scene_free(&it.scene);
}

static void over_stands_inside_its_study_or_beside_it(void **state)
{
    (void)state;
    static const char *const texts[] = {
        FILM SWITCHED "study: {transient: {until: 25 s, over: {coverage: [0.2, 0.5], prestretch: [1.1, 1.2, 1.3]}}}\n",
        FILM SWITCHED "study: {transient: {until: 25 s}, over: {coverage: [0.2, 0.5], prestretch: [1.1, 1.2, 1.3]}}\n",
        DOT "study: {ac: {from: 1 Hz, to: 10 Hz, over: {coverage: [0.2, 0.5], prestretch: [1.1, 1.2, 1.3]}}}\n",
        DOT "study: {over: {coverage: [0.2, 0.5], prestretch: [1.1, 1.2, 1.3]}, ac: {from: 1 Hz, to: 10 Hz}}\n",
    };
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        loaded it;
        load(&it, texts[i], NULL);
        assert_int_equal(it.scene.axis_count, 2);
        assert_string_equal(it.scene.axes[0].key, "actuator.coverage");
        assert_string_equal(it.scene.axes[1].key, "actuator.prestretch");
        assert_true(it.scene.axes[1].changes_film);
        assert_int_equal(dea_scene_point_count(&it.scene), 6);
        dea_scene_free(&it.scene);
        load(&it, texts[i], "over.coverage=[0.1, 0.2, 0.3]");
        assert_int_equal(it.scene.axis_count, 2);
        assert_int_equal(it.scene.axes[0].count, 3);
        dea_scene_free(&it.scene);
        load(&it, texts[i], "study.over={prestretch: [1.1]}");
        assert_int_equal(dea_scene_point_count(&it.scene), 1);
        dea_scene_free(&it.scene);
    }
}

static void scalars_of_the_waveform_are_axes(void **state)
{
    (void)state;
    static const struct {
        const char *waveform, *axis, *key, *column;
        size_t offset;
    } cases[] = {
        {"step: {on: 1 s, voltage: 1 V}", "voltage: [1 V]", "drive.waveform.step.voltage", "step_voltage_V",
         offsetof(dea_scene, drive.waveform.step.voltage)},
        {"step: {on: 1 s}", "step.voltage: [1 V]", "drive.waveform.step.voltage", "step_voltage_V",
         offsetof(dea_scene, drive.waveform.step.voltage)},
        {"step: {voltage: 1 V}", "on: [1 s]", "drive.waveform.step.on", "step_on_s", offsetof(dea_scene, drive.waveform.step.on)},
        {"step: {on: 1 s, voltage: 1 V}", "rise: [1 ms]", "drive.waveform.step.rise", "step_rise_s",
         offsetof(dea_scene, drive.waveform.step.rise)},
        {"sine: {amplitude: 1 V}", "frequency: [1 Hz]", "drive.waveform.sine.frequency", "sine_frequency_Hz",
         offsetof(dea_scene, drive.waveform.sine.frequency)},
        {"sine: {amplitude: 1 V, frequency: 1 Hz}", "phase: [90 deg]", "drive.waveform.sine.phase", "sine_phase_rad",
         offsetof(dea_scene, drive.waveform.sine.phase)},
        {"points: [[0 s, 1 V]]", "period: [1 s]", "drive.waveform.period", "period_s",
         offsetof(dea_scene, drive.waveform.period)},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char text[1024];
        loaded it;
        snprintf(text, sizeof text, FILM "drive: {waveform: {%s}}\nstudy: {transient: {until: 1 s}, over: {%s}}\n",
                 cases[i].waveform, cases[i].axis);
        load(&it, text, NULL);
        assert_string_equal(it.scene.axes[0].key, cases[i].key);
        assert_string_equal(it.scene.axes[0].column, cases[i].column);
        assert_int_equal(it.scene.axes[0].offset, cases[i].offset);
        assert_true(*(double *)((char *)&it.scene + cases[i].offset) == 1.0 || it.scene.axes[0].values[0] != 1.0);
        dea_scene_free(&it.scene);
    }
}

static void axis_of_the_focal_length_leaves_the_column_of_a_transient_alone(void **state)
{
    (void)state;
    loaded it;
    load(&it,
         "actuator: {kind: lens, frame_radius: 30 mm, coverage: 0.5, film_thickness: 100 um, prestretch: 1.2,\n"
         "           optics: {refractive_index: 1.4}}\nmaterial: elastosil-2030\nmodel: lumped\n" SWITCHED
         "study: {transient: {until: 25 s}, over: {focal_length: [20 mm, 22 mm]}}\n",
         NULL);
    assert_string_equal(it.scene.axes[0].column, "optics_focal_length_m");
    dea_scene_free(&it.scene);
}

static void voltage_is_that_of_the_step_where_a_scene_has_one(void **state)
{
    (void)state;
    loaded it;
    load(&it, FILM SWITCHED TRANSIENT, "voltage=3 kV");
    assert_true(it.scene.drive.waveform.step.voltage == 3000.0);
    assert_true(isnan(it.scene.drive.voltage));
    dea_scene_free(&it.scene);
    load(&it, DOT ONE, "voltage=3 kV");
    assert_true(it.scene.drive.voltage == 3000.0);
    dea_scene_free(&it.scene);
    load(&it, DOT AC, "voltage=3 kV");
    assert_true(it.scene.ac.bias == 3000.0);
    dea_scene_free(&it.scene);
    refuse(FILM "drive: {waveform: {points: [[0 s, 0 V]]}}\n" TRANSIENT, "voltage=3 kV",
           "--set voltage=3 kV: voltage: could mean several keys; accepted: one of drive.voltage, drive.waveform.step.voltage");
    refuse(FILM SWITCHED TRANSIENT, "drive.voltage=3 kV",
           "--set drive.voltage=3 kV: drive.voltage: contradicts drive.waveform, which is given too");
    refuse(
        FILM "drive: {waveform: {sine: {amplitude: 1 V, frequency: 1 Hz}}}\n" TRANSIENT, "rise=1 s",
        "--set rise=1 s: rise: could mean several keys; accepted: one of drive.waveform.step.rise, drive.waveform.pulse.rise");
}

static void settings_change_a_transient(void **state)
{
    (void)state;
    loaded it;
    load(&it, FILM SWITCHED TRANSIENT, "study.transient={until: 10 s, every: 1 s}");
    assert_true(it.scene.transient.until == 10.0 && it.scene.transient.every == 1.0);
    dea_scene_free(&it.scene);
    load(&it, FILM SWITCHED TRANSIENT, "study.transient.until=10s");
    assert_true(it.scene.transient.until == 10.0 && it.scene.transient.every == 0.01);
    dea_scene_free(&it.scene);
    load(&it, FILM SWITCHED TRANSIENT, "study={transient: {until: 1 s, start: bias}}");
    assert_true(it.scene.transient.until == 1.0 && it.scene.transient.from_bias);
    dea_scene_free(&it.scene);
    load(&it, FILM SWITCHED TRANSIENT, "start=bias");
    assert_true(it.scene.transient.from_bias && it.scene.transient.until == 25.0);
    dea_scene_free(&it.scene);
    load(&it, FILM SWITCHED TRANSIENT, "step.off=20 s");
    assert_true(it.scene.drive.waveform.step.off == 20.0);
    dea_scene_free(&it.scene);
    load(&it, FILM SWITCHED TRANSIENT, "drive.waveform.points=[[0 s, 0 V], [1 s, 1 V]]");
    assert_int_equal(it.scene.drive.waveform.kind, DEA_WAVE_POINTS);
    assert_true(isnan(it.scene.drive.waveform.step.on));
    dea_scene_free(&it.scene);
    load(&it, DOT AC, "points_per_decade=7");
    assert_int_equal(it.scene.ac.points_per_decade, 7);
    dea_scene_free(&it.scene);
}

static dea_status parse_with(loaded *self, const char *text, const char *first, const char *second)
{
    const dea_setting settings[] = {{first}, {second}};
    self->error = (dea_error){.status = DEA_OK};
    return dea_scene_parse(text, strlen(text), "t", NULL, settings, 2, NULL, &self->scene, &self->error);
}

static void settings_turn_a_static_scene_into_a_transient_and_back(void **state)
{
    (void)state;
    static const char *const waveform[] = {"drive.waveform={step: {on: 0 s, voltage: 1 V}}", "study.transient={until: 1 s}"};
    static const char *const voltage[] = {"drive.voltage=2 kV", "study.sweep={}"};
    loaded it;
    for (size_t first = 0; first < 2; first++) {
        assert_int_equal(parse_with(&it, DOT ONE, waveform[first], waveform[1 - first]), DEA_OK);
        assert_int_equal(it.scene.study, DEA_STUDY_TRANSIENT);
        assert_true(isnan(it.scene.drive.voltage));
        dea_scene_free(&it.scene);
        assert_int_equal(parse_with(&it, FILM SWITCHED TRANSIENT, voltage[first], voltage[1 - first]), DEA_OK);
        assert_int_equal(it.scene.study, DEA_STUDY_SWEEP);
        assert_true(it.scene.drive.voltage == 2000.0);
        assert_int_equal(it.scene.drive.waveform.kind, DEA_WAVE_NONE);
        dea_scene_free(&it.scene);
        const dea_status status =
            parse_with(&it, DOT ONE, first ? "voltage=7 V" : waveform[0], first ? waveform[0] : "voltage=7 V");
        assert_int_equal(status, DEA_ERROR_SCENE);
    }
    assert_int_equal(parse_with(&it, DOT "study: {transient: {until: 1 s}}\n", "voltage=7 V", waveform[0]), DEA_OK);
    assert_true(it.scene.drive.waveform.step.voltage == 7.0);
    dea_scene_free(&it.scene);
}

static void swept_step_is_checked_at_all_its_values(void **state)
{
    (void)state;
    loaded it;
    load(&it, FILM SWITCHED "study: {transient: {until: 25 s}, over: {on: [1 s, 14 s], rise: [0 s, 1 s]}}\n", NULL);
    dea_scene_free(&it.scene);
    refuse(FILM SWITCHED "study: {transient: {until: 25 s}, over: {on: [1 s, 14 s], rise: [0 s, 2 s]}}\n", NULL,
           "t:4:41: drive.waveform.step.off: out of range (15 s)");
    refuse(
        FILM
        "drive: {waveform: {points: [[0 s, 0 V], [2 s, 1 V]]}}\nstudy: {transient: {until: 25 s}, over: {period: [3 s, 1 s]}}\n",
        NULL, "t:5:50: drive.waveform.period: out of range");
}

static void model_argument_is_checked_against_the_study(void **state)
{
    (void)state;
    loaded it;
    assert_int_equal(parse(&it, FILM SWITCHED TRANSIENT, NULL, "coverage,lame"), DEA_OK);
    dea_scene_free(&it.scene);
    assert_int_equal(parse(&it, FILM SWITCHED TRANSIENT, NULL, "lumped,pelrine"), DEA_ERROR_SCENE);
    assert_string_equal(it.error.message,
                        "--model: model: cannot do a transient (pelrine); accepted: lumped, coverage, lame, ring, field, auto");
    dea_scene_free(&it.scene);
}

/* First line of a bad scene: "# expect: LINE:COLUMN: KEY: ...", or "# expect: @FILE:LINE..." where a material file is to blame.
 */
static bool expectation(const char *path, char out[512])
{
    char line[400];
    FILE *file = fopen(path, "r");
    const bool read = file && fgets(line, sizeof line, file) && strncmp(line, "# expect: ", 10) == 0;
    if (file) {
        fclose(file);
    }
    if (read) {
        line[strcspn(line, "\n")] = '\0';
        const bool elsewhere = line[10] == '@';
        snprintf(out, 512, "%s%s%s", elsewhere ? BAD : path, elsewhere ? "" : ":", line + 10 + elsewhere);
    }
    return read;
}

static void every_bad_scene_is_refused_at_its_place(void **state)
{
    (void)state;
    DIR *folder = opendir(BAD);
    size_t count = 0;
    assert_non_null(folder);
    for (const struct dirent *entry = readdir(folder); entry; entry = readdir(folder)) {
        char path[300];
        char wanted[512];
        loaded it = {.error = {.status = DEA_OK}};
        const char *ending = strrchr(entry->d_name, '.');
        if (!ending || strcmp(ending, ".yaml") != 0) {
            continue;
        }
        snprintf(path, sizeof path, BAD "%.255s", entry->d_name);
        const dea_status status = dea_scene_read(path, NULL, 0, NULL, &it.scene, &it.error);
        if (!expectation(path, wanted) || status != DEA_ERROR_SCENE || strncmp(it.error.message, wanted, strlen(wanted)) != 0) {
            fail_msg("wanted \"%s\", got status %d and \"%s\"", wanted, (int)status, it.error.message);
        }
        assert_null(it.scene.title);
        count++;
    }
    closedir(folder);
    assert_true(count >= 215);
}

static void hostile_bytes_are_refused(void **state)
{
    (void)state;
    static const struct {
        const char *text;
        size_t length;
        const char *message;
    } cases[] = {
        {"", 0, "t:1:1: scene: the text is empty"},          {"a: 1\0b", 6, "t:1:5: syntax: not a text"},
        {"a: \xFF", 4, "t:1:4: syntax: not a text"},         {"a:\n  \x1b[0m", 8, "t:2:3: syntax: not a text"},
        {"\xFE\xFF\0a", 4, "t:1:1: syntax: not a text"},     {"a: \xC0\x80", 5, "t:1:4: syntax: not a text"},
        {"a: \xED\xA0\x80", 6, "t:1:4: syntax: not a text"}, {"a: \xF5\x80\x80\x80", 7, "t:1:4: syntax: not a text"},
        {"...", 3, "t:1:1: scene: the text is empty"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        loaded it;
        assert_int_equal(dea_scene_parse(cases[i].text, cases[i].length, "t", NULL, NULL, 0, NULL, &it.scene, &it.error),
                         DEA_ERROR_SCENE);
        assert_int_equal(strncmp(it.error.message, cases[i].message, strlen(cases[i].message)), 0);
    }
}

static void huge_texts_are_refused_shortly(void **state)
{
    (void)state;
    static const char *const parts[] = {"x", "[", "{", "- ", "? ", "&", "!", "a: ", "\"", "\n"};
    const size_t length = 1 << 20;
    char *text = malloc(length + 1);
    assert_non_null(text);
    for (size_t i = 0; i < sizeof parts / sizeof *parts; i++) {
        loaded it;
        for (size_t at = 0; at < length; at++) {
            text[at] = parts[i][at % strlen(parts[i])];
        }
        text[length] = '\0';
        assert_int_equal(parse(&it, text, NULL, NULL), DEA_ERROR_SCENE);
        assert_true(strlen(it.error.message) < 1000);
    }
    free(text);
}

static void things_that_are_no_files_are_refused(void **state)
{
    (void)state;
    static const char *const paths[] = {"/dev/zero", "/dev/full", "/dev/null", "tests", "tests/bad/nowhere.yaml", "", "a\nb"};
    for (size_t i = 0; i < sizeof paths / sizeof *paths; i++) {
        loaded it;
        assert_int_equal(dea_scene_read(paths[i], NULL, 0, NULL, &it.scene, &it.error), DEA_ERROR_IO);
        assert_non_null(strstr(it.error.message, ": cannot read the scene: "));
        assert_null(strchr(it.error.message, '\n'));
    }
}

static void file_above_the_limit_is_refused(void **state)
{
    (void)state;
    char path[] = "/tmp/dea-scene-XXXXXX";
    const int file = mkstemp(path);
    loaded it;
    assert_true(file >= 0 && ftruncate(file, 16 * 1024 * 1024 + 1) == 0);
    const dea_status status = dea_scene_read(path, NULL, 0, NULL, &it.scene, &it.error);
    close(file);
    unlink(path);
    assert_int_equal(status, DEA_ERROR_IO);
    assert_non_null(strstr(it.error.message, "larger than 16 MiB"));
}

static void hostile_values_are_escaped_and_cut(void **state)
{
    (void)state;
    char setting[400];
    loaded it;
    memset(setting, 'x', sizeof setting);
    memcpy(setting, "kind=\xE2\x80\xAE", 8);
    setting[sizeof setting - 1] = '\0';
    assert_int_equal(parse(&it, DOT ONE, setting, NULL), DEA_ERROR_SCENE);
    assert_true(strlen(it.error.message) < 300);
    assert_non_null(strstr(it.error.message, "\\u202E"));
    assert_null(strstr(it.error.message, "\xE2\x80\xAE"));
}

static void freeing_nothing_is_fine(void **state)
{
    (void)state;
    dea_scene scene = {0};
    dea_scene_free(NULL);
    dea_scene_free(&scene);
    dea_scene_free(&scene);
    assert_null(scene.axes);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(scene_of_the_documentation_is_read),
        cmocka_unit_test(what_a_scene_leaves_out_has_its_default),
        cmocka_unit_test(axis_knows_its_key_column_unit_and_place),
        cmocka_unit_test(uniform_axis_is_evenly_spaced_with_exact_ends),
        cmocka_unit_test(axis_values_are_the_decimals_meant),
        cmocka_unit_test(values_and_samples_are_the_decimals_meant),
        cmocka_unit_test(logarithmic_axis_has_equal_ratios),
        cmocka_unit_test(axis_of_one_point_is_its_start),
        cmocka_unit_test(swept_key_counts_as_given),
        cmocka_unit_test(scalar_of_the_scene_survives_its_sweep),
        cmocka_unit_test(clashing_columns_take_more_of_their_path),
        cmocka_unit_test(corner_of_a_grid_past_the_frame_is_no_scene_error),
        cmocka_unit_test(units_convert_to_the_nearest_double),
        cmocka_unit_test(rare_units_come_from_the_database),
        cmocka_unit_test(quantities_of_every_dimension_are_read),
        cmocka_unit_test(broken_quantities_are_refused),
        cmocka_unit_test(missing_unit_database_is_named),
        cmocka_unit_test(numbers_do_not_depend_on_the_locale),
        cmocka_unit_test(setting_replaces_what_the_file_says),
        cmocka_unit_test(later_setting_of_a_key_wins),
        cmocka_unit_test(coverage_and_radius_replace_each_other_by_setting),
        cmocka_unit_test(setting_of_an_axis_replaces_or_adds_it),
        cmocka_unit_test(bad_settings_are_refused_by_name),
        cmocka_unit_test(mistake_is_shown_with_its_line_and_a_caret),
        cmocka_unit_test(long_line_is_shown_around_its_mistake),
        cmocka_unit_test(file_that_is_no_material_is_not_shown),
        cmocka_unit_test(model_argument_replaces_the_models_of_the_scene),
        cmocka_unit_test(material_is_written_out_or_built_on_another),
        cmocka_unit_test(material_file_is_found_beside_the_scene),
        cmocka_unit_test(no_material_file_is_read_without_a_folder),
        cmocka_unit_test(builtin_materials_carry_their_source),
        cmocka_unit_test(lens_takes_its_own_keys),
        cmocka_unit_test(step_of_the_documentation_is_read),
        cmocka_unit_test(what_a_transient_leaves_out_has_its_default),
        cmocka_unit_test(jump_of_a_step_is_a_rise_of_zero),
        cmocka_unit_test(points_are_read_in_their_order),
        cmocka_unit_test(sine_is_read_with_its_phase_in_degrees_or_radians),
        cmocka_unit_test(waveform_of_a_file_is_read_with_and_without_a_header),
        cmocka_unit_test(waveform_of_a_file_has_at_most_a_million_rows),
        cmocka_unit_test(no_waveform_file_is_read_without_a_folder),
        cmocka_unit_test(averages_are_one_window_or_a_list),
        cmocka_unit_test(frequency_response_takes_its_bias_from_the_study_or_the_drive),
        cmocka_unit_test(over_stands_inside_its_study_or_beside_it),
        cmocka_unit_test(scalars_of_the_waveform_are_axes),
        cmocka_unit_test(axis_of_the_focal_length_leaves_the_column_of_a_transient_alone),
        cmocka_unit_test(voltage_is_that_of_the_step_where_a_scene_has_one),
        cmocka_unit_test(settings_change_a_transient),
        cmocka_unit_test(settings_turn_a_static_scene_into_a_transient_and_back),
        cmocka_unit_test(swept_step_is_checked_at_all_its_values),
        cmocka_unit_test(model_argument_is_checked_against_the_study),
        cmocka_unit_test(every_bad_scene_is_refused_at_its_place),
        cmocka_unit_test(hostile_bytes_are_refused),
        cmocka_unit_test(huge_texts_are_refused_shortly),
        cmocka_unit_test(things_that_are_no_files_are_refused),
        cmocka_unit_test(file_above_the_limit_is_refused),
        cmocka_unit_test(hostile_values_are_escaped_and_cut),
        cmocka_unit_test(freeing_nothing_is_fine),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
