/* Films as they are built: stacks of layers, skins of electrodes, a permittivity that follows the strain. Judges are one film alone, figures from elsewhere, the energy in
 * long double, and other engines. */
#include "answers.h"

#include <stdlib.h>

#include "netlist/export.h"
#include "netlist/part.h"

#define FILM(kind, more)                                                                                                        \
    "actuator: {kind: " kind ", frame_radius: 30 mm, coverage: 0.5, film_thickness: 100 um, prestretch: 1.2" more "}\n"
#define PAPER "material: {base: elastosil-2030, yeoh: {C1: 178426 Pa, C2: -6023 Pa, C3: 4234 Pa}, permittivity: 2.8}\n"
#define STILL "drive: {voltage: 4500 V}\nstudy: {sweep: {}}\n"
#define REST "drive: {voltage: 0 V}\nstudy: {sweep: {}}\n"

static void solve(const char *text, const char *model, const char *engine, answer *a)
{
    assert_true(run(text, model, engine, a));
}

static dea_row row_of(const char *text, const char *model, const char *engine)
{
    solve(text, model, engine, &one);
    return *(const dea_row *)one.bytes;
}

/* True where the engine can do the scene with the model. */
static bool can(const char *text, const char *model, const char *engine)
{
    dea_scene scene;
    read_scene(text, model, &scene);
    const bool able = !dea_engine_refuses(dea_engine_find(engine), &scene, scene.models[0]);
    dea_scene_free(&scene);
    return able;
}

/* Strain and field as of one layer, force, capacitance and charge five times. */
static void a_stack_is_as_many_films_side_by_side(void **state)
{
    (void)state;
    for (size_t e = 0; e < ENGINES; e++) {
        for (size_t m = 0; m < dea_model_count(); m++) {
            const dea_model *model = dea_model_at(m);
            for (int lens = 0; lens <= (int)model->lens; lens++) {
                const char *single = lens ? FILM("lens", "") PAPER STILL : FILM("dot", "") PAPER STILL;
                const char *stack = lens ? FILM("lens", ", layers: 5") PAPER STILL : FILM("dot", ", layers: 5") PAPER STILL;
                if (!can(single, model->name, engines[e])) {
                    continue;
                }
                const dea_row film = row_of(single, model->name, engines[e]), five = row_of(stack, model->name, engines[e]);
                assert_int_equal(five.state, film.state);
                assert_relative(five.strain, film.strain, 1e-10);
                assert_relative(five.field, film.field, 1e-10);
                assert_relative(five.force, 5.0 * film.force, 1e-10);
                assert_relative(five.capacitance, 5.0 * film.capacitance, 1e-10);
                assert_relative(five.charge, 5.0 * film.charge, 1e-10);
            }
        }
    }
}

static void charge_of_a_stack_is_the_printed_one(void **state)
{
    (void)state;
    assert_printed(1e6 * row_of(FILM("dot", "") PAPER STILL, "field", "direct").charge, 1.354360, 6);
    assert_printed(1e6 * row_of(FILM("dot", ", layers: 5") PAPER STILL, "field", "direct").charge, 6.771800, 6);
    assert_printed(1e6 * row_of(FILM("dot", ", layers: 5") PAPER STILL, "field", "ida").charge, 6.771800, 6);
}

#define LOSSY "material: {base: elastosil-2030, density: 1080 kg/m^3, retardation: 0.1 ms, prony: [{g: 0.1, tau: 2 ms}]}\n"
#define SWITCHED(resistance) "drive: {waveform: {step: {on: 0 s, voltage: 4 kV, rise: 0.1 ms}}, series_resistance: " resistance "}\n"
#define MOVED "accuracy: 1e-5\nstudy: {transient: {until: 4 ms, every: 0.1 ms}}\n"
#define SHAKEN "study: {ac: {from: 10 Hz, to: 1 kHz, points_per_decade: 3, bias: 3 kV}}\n"

/* Behind a fifth of the resistance five layers move as one does, and take five times the current. */
static void a_stack_moves_as_one_film(void **state)
{
    (void)state;
    static const char *const models[] = {"lumped", "lame", "coverage", "ring"};
    for (size_t e = 0; e < ENGINES; e++) {
        for (size_t m = 0; m < 4; m++) {
            const char *single = FILM("dot", "") LOSSY SWITCHED("1 MOhm") MOVED;
            if (!can(single, models[m], engines[e])) {
                continue;
            }
            solve(single, models[m], engines[e], &one);
            solve(FILM("dot", ", layers: 5") LOSSY SWITCHED("200 kOhm") MOVED, models[m], engines[e], &other);
            const dea_sample *film = (const dea_sample *)one.bytes, *five = (const dea_sample *)other.bytes;
            assert_true(one.rows == 41 && film[40].displacement > 1e-4);
            for (size_t i = 0; i < one.rows; i++) {
                assert_near(five[i].displacement, film[i].displacement, 1e-5 * film[40].displacement);
                assert_near(five[i].force, 5.0 * film[i].force, 1e-4 * film[40].force);
                assert_near(five[i].charge, 5.0 * film[i].charge, 1e-4 * film[40].charge);
            }
        }
    }
}

static void a_stack_answers_with_a_fifth_of_the_impedance(void **state)
{
    (void)state;
    static const char *const models[] = {"lumped", "lame", "coverage", "ring"};
    for (size_t e = 0; e < ENGINES; e++) {
        for (size_t m = 0; m < 4; m++) {
            const char *single = FILM("dot", "") LOSSY "drive: {series_resistance: 1 MOhm}\n" SHAKEN;
            if (!can(single, models[m], engines[e])) {
                continue;
            }
            solve(single, models[m], engines[e], &one);
            solve(FILM("dot", ", layers: 5") LOSSY "drive: {series_resistance: 200 kOhm}\n" SHAKEN, models[m], engines[e], &other);
            const dea_response *film = (const dea_response *)one.bytes, *five = (const dea_response *)other.bytes;
            for (size_t i = 0; i < one.rows; i++) {
                assert_relative(five[i].displacement, film[i].displacement, 1e-5);
                assert_relative(five[i].impedance, film[i].impedance / 5.0, 1e-5);
            }
        }
    }
}

#define SKIN "electrode: {thickness: 25 um, neo_hookean: {mu: 20 kPa}, density: 1010 kg/m^3}\n"

static void a_skin_costs_the_printed_strain(void **state)
{
    (void)state;
    static const char *const membranes[] = {"direct", "ida"};
    for (size_t e = 0; e < 2; e++) {
        assert_printed(row_of(FILM("dot", "") PAPER SKIN STILL, "field", membranes[e]).strain, 0.0442776413, 10);
        assert_printed(row_of(FILM("lens", "") PAPER SKIN STILL, "field", membranes[e]).strain, -0.0370009643, 10);
        assert_printed(row_of(FILM("dot", "") PAPER STILL, "field", membranes[e]).strain, 0.0450329722, 10);
    }
}

static long double invariant(long double a, long double b)
{
    return a * a + b * b + 1.0L / (a * a * b * b) - 3.0L;
}

static long double yeoh(long double a, long double b)
{
    const long double j = invariant(a, b);
    return j * (178426.0L + j * (-6023.0L + j * 4234.0L));
}

/* A film of one ring each for disc and annulus, by its energy alone: B = 0.5, r = 30 mm, H = 100 um, lambda_pre = 1.2. */
typedef struct energy_film {
    bool dot;
    long double skin;    /* t mu [N/m] */
    long double voltage; /* [V] */
    long double load;    /* stiffness of a spring at the edge [N/m] */
    bool follows;        /* eps_r = 2.76 - 0.28 sqrt(lambda_1 lambda_2), else 2.8 */
} energy_film;

/* W and the skin's W_e over their volumes less U^2 C/2 [J]. */
static long double energy_at(const energy_film *f, long double u)
{
    const long double pi = acosl(-1.0L), pre = 1.2L, r = 0.03L, a = 0.015L, h = 1e-4L, vacuum = 8.8541878128e-12L;
    const long double disc = 1.0L + u / a, radial = 1.0L - u / (r - a), hoop = 1.0L + u / (r + a);
    const long double inside = pi * a * a, outside = pi * (r * r - a * a); /* of pre-stretched film */
    const long double elastic = (inside * yeoh(pre * disc, pre * disc) + outside * yeoh(pre * radial, pre * hoop)) * h / (pre * pre);
    const long double skin = 0.5L * f->skin * (f->dot ? inside * invariant(disc, disc) : outside * invariant(radial, hoop));
    const long double area = f->dot ? disc * disc : radial * hoop;
    const long double epsilon = vacuum * (f->follows ? 2.76L - 0.28L * pre * sqrtl(area) : 2.8L);
    const long double capacitance = epsilon * pre * pre / h * (f->dot ? inside : outside) * area * area;
    return elastic + skin + 0.5L * f->load * u * u - 0.5L * capacitance * f->voltage * f->voltage;
}

static long double force_at(const energy_film *f, long double u)
{
    const long double h = 1e-6L;
    const long double near = energy_at(f, u + h) - energy_at(f, u - h), far = energy_at(f, u + 2.0L * h) - energy_at(f, u - 2.0L * h);
    return (8.0L * near - far) / (12.0L * h);
}

/* Where the energy is least between two displacements. */
static double rest_of(const energy_film *f, long double low, long double high)
{
    for (int i = 0; i < 80; i++) {
        const long double middle = 0.5L * (low + high);
        *(force_at(f, middle) < 0.0L ? &low : &high) = middle;
    }
    return (double)low;
}

static void a_skinned_film_of_rings_rests_where_its_energy_is_least(void **state)
{
    (void)state;
    for (size_t e = 0; e < ENGINES; e++) {
        const energy_film dot = {true, 25e-6L * 20e3L, 4500.0L, 0.0L, false}, lens = {false, 25e-6L * 20e3L, 4500.0L, 0.0L, false};
        assert_relative(row_of(FILM("dot", "") PAPER SKIN STILL, "ring", engines[e]).displacement, rest_of(&dot, 0.0L, 2e-3L), 1e-9);
        assert_relative(row_of(FILM("lens", "") PAPER SKIN STILL, "ring", engines[e]).displacement, rest_of(&lens, -2e-3L, 0.0L), 1e-9);
    }
}

static void engines_agree_on_skins(void **state)
{
    (void)state;
    for (size_t m = 0; m < dea_model_count(); m++) {
        const dea_model *model = dea_model_at(m);
        for (int lens = 0; lens <= (int)model->lens; lens++) {
            const char *text = lens ? FILM("lens", ", layers: 2") PAPER SKIN STILL : FILM("dot", ", layers: 2") PAPER SKIN STILL;
            const char *bare = lens ? FILM("lens", ", layers: 2") PAPER STILL : FILM("dot", ", layers: 2") PAPER STILL;
            const dea_row wanted = row_of(text, model->name, "direct");
            assert_true(fabs(wanted.strain) < 0.999 * fabs(row_of(bare, model->name, "direct").strain));
            for (size_t e = 1; e < ENGINES; e++) {
                if (can(text, model->name, engines[e])) {
                    const dea_row row = row_of(text, model->name, engines[e]);
                    assert_relative(row.strain, wanted.strain, 1e-7);
                    assert_int_equal(row.state, wanted.state);
                }
            }
        }
    }
}

/* The skin moves with the film but neither damps nor relaxes. */
static void engines_agree_on_moving_skins(void **state)
{
    (void)state;
    static const char *const models[] = {"lumped", "lame", "coverage", "ring"};
    static const char *const drives[] = {SWITCHED("1 MOhm"), "drive: {waveform: {step: {on: 0 s, voltage: 4 kV, rise: 0 s}}}\n"};
    for (size_t m = 0; m < 4; m++) {
        for (size_t d = 0; d < 2; d++) {
            char text[1024];
            snprintf(text, sizeof text, "%s%s", FILM("dot", "") LOSSY SKIN MOVED, drives[d]);
            solve(text, models[m], "ida", &one);
            const dea_sample *wanted = (const dea_sample *)one.bytes;
            for (size_t e = 0; e < ENGINES; e += 2) {
                if (!can(text, models[m], engines[e])) {
                    continue;
                }
                solve(text, models[m], engines[e], &other);
                const dea_sample *rows = (const dea_sample *)other.bytes;
                for (size_t i = 0; i < one.rows; i++) {
                    assert_near(rows[i].displacement, wanted[i].displacement, 2e-5 * wanted[40].displacement);
                }
            }
        }
        assert_true(m > 1 || can(FILM("dot", "") LOSSY SKIN MOVED "drive: {waveform: {points: [[0 s, 4 kV]]}}\n", models[m], "direct"));
    }
}

static void engines_agree_on_shaken(const char *text)
{
    static const char *const models[] = {"lumped", "lame", "coverage", "ring"};
    for (size_t m = 0; m < 4; m++) {
        solve(text, models[m], "direct", &one);
        solve(text, models[m], "ngspice", &other);
        const dea_response *wanted = (const dea_response *)one.bytes, *rows = (const dea_response *)other.bytes;
        for (size_t i = 0; i < one.rows; i++) {
            assert_relative(rows[i].displacement, wanted[i].displacement, 1e-6);
            assert_relative(rows[i].impedance, wanted[i].impedance, 1e-6);
        }
    }
}

static void engines_agree_on_shaken_skins(void **state)
{
    (void)state;
    engines_agree_on_shaken(FILM("dot", "") LOSSY SKIN "drive: {series_resistance: 1 MOhm}\n" SHAKEN);
}

/* So slowly that the film follows, the membrane answers with the slope of its static displacement. */
static void a_slow_membrane_moves_its_skin_along(void **state)
{
    (void)state;
    static const char *const kinds[] = {FILM("dot", "") PAPER SKIN "drive: {voltage: 3 kV}\nstudy: {sweep: {}}\n",
                                        FILM("lens", "") PAPER SKIN "drive: {voltage: 3 kV}\nstudy: {sweep: {}}\n"};
    for (int k = 0; k < 2; k++) {
        dea_scene scene;
        dea_error error = {0};
        dea_response row;
        read_scene(kinds[k], "field", &scene);
        scene.accuracy = 1e-9;
        scene.drive.voltage = 3001.0;
        const double above = solve_direct(&scene, "field").displacement;
        scene.drive.voltage = 2999.0;
        const double below = solve_direct(&scene, "field").displacement;
        scene.study = DEA_STUDY_AC;
        scene.ac = (dea_ac){.from = 1e-3, .to = 1e-3, .points_per_decade = 1, .bias = 3000.0};
        assert_int_equal(dea_engine_find("direct")->ac(NULL, &scene, scene.models[0], &row, NULL, &error), DEA_OK);
        assert_relative(row.displacement, fabs(0.5 * (above - below)), 1e-6);
        dea_scene_free(&scene);
    }
}

/* I^2 R = sum over electrodes of the integral of I(r)^2/(2 pi r), the charge going evenly into the film; inner electrodes feed two
 * films. */
static void sheets_are_one_resistance_of_the_same_loss(void **state)
{
    (void)state;
    static const double coverages[] = {0.1, 0.5, 0.88, 0.9, 0.999};
    for (size_t i = 0; i < sizeof coverages / sizeof *coverages; i++) {
        for (int lens = 0; lens < 2; lens++) {
            const int cuts = 20000, layers = 1 + (int)i;
            const long double inner = lens ? (long double)coverages[i] : 0.0L, width = (1.0L - inner) / cuts;
            long double loss = 0.0L, all = 0.0L;
            for (int k = 0; k < cuts; k++) {
                const long double r = inner + (k + 0.5L) * width;
                const long double flow = (r - inner) * (r + inner) / ((1.0L - inner) * (1.0L + inner));
                loss += flow * flow / (2.0L * acosl(-1.0L) * r) * width;
            }
            for (int sheet = 0; sheet <= layers; sheet++) {
                const long double films = sheet == 0 || sheet == layers ? 1.0L : 2.0L;
                all += loss * films * films / ((long double)layers * layers);
            }
            assert_relative(dea_sheet_share(lens ? DEA_LENS : DEA_DOT, coverages[i], layers), (double)all, 1e-7);
        }
    }
}

static void sheets_add_to_the_series_resistance(void **state)
{
    (void)state;
    for (int k = 0; k < 2; k++) {
        char sheets[1024], one_resistance[1024];
        const double own = 50e6 * dea_sheet_share(k ? DEA_LENS : DEA_DOT, 0.5, 2.0);
        const char *film = k ? FILM("lens", ", layers: 2") LOSSY MOVED : FILM("dot", ", layers: 2") LOSSY MOVED;
        const char *step = "waveform: {step: {on: 0 s, voltage: 4 kV, rise: 0.1 ms}}, leakage_resistance: 1 GOhm";
        snprintf(sheets, sizeof sheets, "%selectrode: {sheet_resistance: 50 MOhm}\ndrive: {%s, series_resistance: 100 kOhm}\n", film, step);
        snprintf(one_resistance, sizeof one_resistance, "%sdrive: {%s, series_resistance: %.17g Ohm}\n", film, step, 1e5 + own);
        solve(sheets, "ring", "ida", &one);
        solve(one_resistance, "ring", "ida", &other);
        const dea_sample *wanted = (const dea_sample *)other.bytes, *rows = (const dea_sample *)one.bytes;
        for (size_t i = 0; i < one.rows; i++) {
            assert_near(rows[i].displacement, wanted[i].displacement, 1e-9 * fabs(wanted[40].displacement));
            assert_near(rows[i].current, wanted[i].current, 1e-9 * wanted[1].current);
        }
        snprintf(sheets, sizeof sheets, "%s" PAPER "electrode: {sheet_resistance: 5 GOhm}\ndrive: {voltage: 4 kV, leakage_resistance: 1 GOhm}\n"
                 "study: {sweep: {coverage: [0.3, 0.6]}}\n", k ? FILM("lens", "") : FILM("dot", ""));
        solve(sheets, "ring", "direct", &other);
        for (size_t e = 1; e < ENGINES; e++) {
            solve(sheets, "ring", engines[e], &one);
            for (int i = 0; i < 2; i++) {
                assert_relative(((const dea_row *)one.bytes)[i].charge, ((const dea_row *)other.bytes)[i].charge, 1e-8);
            }
        }
    }
}

#define LOAD "load: {mass: 2 g, stiffness: 500 N/m}\n"

static void a_film_against_a_spring_rests_where_its_energy_is_least(void **state)
{
    (void)state;
    for (size_t e = 0; e < ENGINES; e++) {
        const energy_film dot = {true, 0.0L, 4500.0L, 500.0L, false}, lens = {false, 0.0L, 4500.0L, 500.0L, false};
        const double out = row_of(FILM("dot", "") PAPER "load: {stiffness: 500 N/m}\n" STILL, "ring", engines[e]).displacement;
        const double in = row_of(FILM("lens", "") PAPER "load: {stiffness: 500 N/m}\n" STILL, "ring", engines[e]).displacement;
        assert_relative(out, rest_of(&dot, 0.0L, 2e-3L), 1e-9);
        assert_relative(in, rest_of(&lens, -2e-3L, 0.0L), 1e-9);
    }
}

/* A mesh of rings has nothing to resolve then. */
static void without_voltage_every_engine_has_the_film_at_rest(void **state)
{
    (void)state;
    for (size_t m = 0; m < dea_model_count(); m++) {
        const dea_model *model = dea_model_at(m);
        for (int lens = 0; lens < 2 && model->edge; lens++) {
            const char *film = lens ? FILM("lens", ", layers: 2") PAPER SKIN REST : FILM("dot", ", layers: 2") PAPER SKIN REST;
            const double share = lens ? 0.75 : 0.25, wanted = share * 2.0 * DEA_PI * 2.8 * 8.8541878128e-12 * 9e-4 * 1.44 / 1e-4;
            for (size_t e = 0; e < ENGINES; e++) {
                if (can(film, model->name, engines[e])) {
                    const dea_row row = row_of(film, model->name, engines[e]);
                    assert_true(row.strain == 0.0 && row.force == 0.0);
                    assert_relative(row.capacitance, wanted, 1e-12);
                }
            }
        }
    }
}

/* The film is the spring that the load takes its force from: against one that gives way by nothing all of it is left. */
static void engines_agree_on_loads(void **state)
{
    (void)state;
    for (size_t m = 0; m < dea_model_count(); m++) {
        const dea_model *model = dea_model_at(m);
        for (int lens = 0; lens < 2 && model->edge; lens++) {
            char text[1024], stiff[1024];
            const char *film = lens ? FILM("lens", ", layers: 2") PAPER SKIN STILL : FILM("dot", ", layers: 2") PAPER SKIN STILL;
            snprintf(text, sizeof text, "%sload: {stiffness: 700 N/m}\n", film);
            snprintf(stiff, sizeof stiff, "%sload: {stiffness: 1 GN/m}\n", film);
            const dea_row wanted = row_of(text, model->name, "direct"), held = row_of(stiff, model->name, "direct");
            assert_true(fabs(wanted.strain) < 0.9 * fabs(row_of(film, model->name, "direct").strain));
            assert_relative(held.displacement, held.force / 1e9, 1e-5);
            for (size_t e = 1; e < ENGINES; e++) {
                if (can(text, model->name, engines[e])) {
                    const dea_row row = row_of(text, model->name, engines[e]), stuck = row_of(stiff, model->name, engines[e]);
                    assert_relative(row.strain, wanted.strain, 1e-7);
                    assert_relative(row.force, wanted.force, 1e-7);
                    assert_relative(row.field, wanted.field, 1e-7);
                    assert_relative(stuck.strain, held.strain, 1e-7);
                    assert_relative(stuck.force, held.force, 1e-7);
                    assert_relative(stuck.field, held.field, 1e-7);
                }
            }
        }
    }
}

static void engines_agree_on_moving_loads(void **state)
{
    (void)state;
    static const char *const models[] = {"lumped", "lame", "coverage", "ring"};
    for (size_t m = 0; m < 4; m++) {
        for (size_t d = 0; d < 2; d++) {
            const char *text = d ? FILM("dot", "") LOSSY LOAD SWITCHED("1 MOhm") MOVED
                                 : FILM("lens", "") LOSSY SKIN LOAD "drive: {waveform: {points: [[0 s, 4 kV]]}}\n" MOVED;
            solve(text, models[m], "ida", &one);
            const dea_sample *wanted = (const dea_sample *)one.bytes;
            for (size_t e = 0; e < ENGINES; e += 2) {
                if (!can(text, models[m], engines[e])) {
                    continue;
                }
                solve(text, models[m], engines[e], &other);
                const dea_sample *rows = (const dea_sample *)other.bytes;
                for (size_t i = 0; i < one.rows; i++) {
                    assert_near(rows[i].displacement, wanted[i].displacement, 4e-5 * fabs(wanted[40].displacement));
                }
            }
        }
    }
    assert_true(can(FILM("lens", "") LOSSY SKIN LOAD "drive: {waveform: {points: [[0 s, 4 kV]]}}\n" MOVED, "lumped", "direct"));
}

static void engines_agree_on_shaken_loads(void **state)
{
    (void)state;
    engines_agree_on_shaken(FILM("dot", "") LOSSY LOAD SHAKEN);
}

/* Under a heavy load the film is a spring: membrane and ring swing alike, at sqrt(k/m). */
static void a_heavy_load_makes_the_membrane_a_spring(void **state)
{
    (void)state;
    const char *film = FILM("dot", "") PAPER "drive: {voltage: 1 V}\nstudy: {sweep: {}}\nload: {stiffness: 500 N/m}\n";
    dea_scene scene;
    dea_error error = {0};
    dea_response row;
    read_scene(film, "field", &scene);
    const dea_row rest = solve_direct(&scene, "field");
    scene.material.density = 1e-3;
    *dea_scene_load(&scene, "mass") = 1.0;
    scene.study = DEA_STUDY_AC;
    scene.ac = (dea_ac){.from = 1.0, .to = 1.0, .points_per_decade = 1, .bias = 1.0};
    assert_int_equal(dea_engine_find("direct")->ac(NULL, &scene, scene.models[0], &row, NULL, &error), DEA_OK);
    const double turn = 4.0 * DEA_PI * DEA_PI, stiffness = rest.force / rest.displacement;
    assert_relative(row.displacement, 2.0 * rest.force / (stiffness - turn), 1e-5);
    dea_scene_free(&scene);
}

#define PERMITTIVITY(follows) "{constant: 2.76, per_stretch: -0.28, follows: " follows "}"
#define FOLLOWED "material: {base: elastosil-2030, yeoh: {C1: 178426 Pa, C2: -6023 Pa, C3: 4234 Pa}, permittivity: " PERMITTIVITY("strain") "}\n"
#define HELD "material: {base: elastosil-2030, yeoh: {C1: 178426 Pa, C2: -6023 Pa, C3: 4234 Pa}, permittivity: " PERMITTIVITY("prestretch") "}\n"

static void a_permittivity_that_follows_costs_the_printed_strain(void **state)
{
    (void)state;
    for (size_t e = 0; e < ENGINES; e++) {
        const dea_row followed = row_of(FILM("dot", "") FOLLOWED STILL "accuracy: 1e-8\n", "field", engines[e]);
        assert_printed(followed.strain, 0.0364111198, 10);
        assert_printed(1e6 * followed.charge, 1.128546676, 9);
        assert_printed(row_of(FILM("dot", "") HELD STILL "accuracy: 1e-8\n", "field", engines[e]).strain, 0.0381750588, 10);
    }
}

static void a_film_of_rings_rests_where_its_electrical_energy_lets_it(void **state)
{
    (void)state;
    for (size_t e = 0; e < ENGINES; e++) {
        const energy_film dot = {true, 0.0L, 4500.0L, 0.0L, true}, lens = {false, 0.0L, 4500.0L, 0.0L, true};
        assert_relative(row_of(FILM("dot", "") FOLLOWED STILL, "ring", engines[e]).displacement, rest_of(&dot, 0.0L, 2e-3L), 1e-9);
        assert_relative(row_of(FILM("lens", "") FOLLOWED STILL, "ring", engines[e]).displacement, rest_of(&lens, -2e-3L, 0.0L), 1e-9);
    }
}

/* F = U^2/2 dC/du, from the capacitances of equilibria on both sides; of the membrane no one displacement has that, and `lame` has a part of it
 * in its softening. */
static void electrostriction_is_the_slope_of_the_capacitance(void **state)
{
    (void)state;
    static const char *const models[] = {"lumped", "coverage", "ring", "constant_force"};
    for (size_t m = 0; m < sizeof models / sizeof *models; m++) {
        for (int lens = 0; lens <= (int)dea_model_find(models[m])->lens; lens++) {
            dea_scene scene;
            dea_row rows[3];
            read_scene(lens ? FILM("lens", "") FOLLOWED STILL : FILM("dot", "") FOLLOWED STILL, models[m], &scene);
            scene.accuracy = 1e-10;
            for (int i = 0; i < 3; i++) {
                scene.drive.voltage = 3999.0 + i;
                rows[i] = solve_direct(&scene, models[m]);
            }
            const double slope = (rows[2].capacitance - rows[0].capacitance) / (rows[2].displacement - rows[0].displacement);
            assert_relative(rows[1].force, 0.5 * 4000.0 * 4000.0 * slope, 1e-6);
            dea_scene_free(&scene);
        }
    }
}

static void engines_agree_on_permittivities_that_follow(void **state)
{
    (void)state;
    for (size_t m = 0; m < dea_model_count(); m++) {
        const dea_model *model = dea_model_at(m);
        for (int lens = 0; lens <= (int)model->lens; lens++) {
            const char *text = lens ? FILM("lens", ", layers: 2") FOLLOWED SKIN STILL : FILM("dot", ", layers: 2") FOLLOWED SKIN STILL;
            const char *held = lens ? FILM("lens", ", layers: 2") HELD SKIN STILL : FILM("dot", ", layers: 2") HELD SKIN STILL;
            const dea_row wanted = row_of(text, model->name, "direct");
            assert_true(fabs(wanted.strain) < 0.99 * fabs(row_of(held, model->name, "direct").strain));
            for (size_t e = 1; e < ENGINES; e++) {
                if (can(text, model->name, engines[e])) {
                    const dea_row row = row_of(text, model->name, engines[e]);
                    assert_relative(row.strain, wanted.strain, 1e-7);
                    assert_relative(row.force, wanted.force, 1e-7);
                    assert_relative(row.charge, wanted.charge, 1e-7);
                }
            }
        }
    }
}

/* Beside a force and a second film, and where the edge is held. */
static void engines_agree_on_pulled_permittivities_that_follow(void **state)
{
    (void)state;
    static const char *const models[] = {"lumped", "lame", "coverage", "ring", "field"};
    static const char *const pulled[] = {
        FILM("dot", "") FOLLOWED STILL "load: {force: 0.05 N}\nantagonist: {actuator: {kind: lens, film_thickness: 50 um}, drive: {voltage: 2 kV}}\n",
        FILM("lens", "") FOLLOWED STILL "load: {force: -0.05 N}\nantagonist: {actuator: {kind: dot}, drive: {voltage: 3 kV}}\n",
        FILM("lens", "") FOLLOWED "drive: {voltage: 4 kV}\nstudy: {force: {displacement: {from: -0.4 mm, to: 0.4 mm, points: 3}}}\n"};
    for (size_t m = 0; m < 5; m++) {
        for (size_t p = 0; p < 3; p++) {
            solve(pulled[p], models[m], "direct", &one);
            for (size_t e = 1; e < ENGINES; e++) {
                if (!can(pulled[p], models[m], engines[e])) {
                    continue;
                }
                solve(pulled[p], models[m], engines[e], &other);
                const dea_row *wanted = (const dea_row *)one.bytes, *rows = (const dea_row *)other.bytes;
                for (size_t i = 0; i < one.rows; i++) {
                    assert_relative(rows[i].displacement, wanted[i].displacement, 1e-7);
                    assert_relative(rows[i].force, wanted[i].force, 1e-7);
                    assert_relative(rows[i].charge, wanted[i].charge, 1e-7);
                }
            }
        }
    }
}

#define YIELDING "material: {base: elastosil-2030, density: 1080 kg/m^3, retardation: 0.1 ms, prony: [{g: 0.1, tau: 2 ms}], permittivity: " \
    PERMITTIVITY("strain") "}\n"

/* In time engines agree, the energy balances, and at the end the film is where statics has it. */
static void a_film_whose_permittivity_follows_keeps_its_energy(void **state)
{
    (void)state;
    static const char *const models[] = {"lumped", "lame", "coverage", "ring", "field"};
    for (size_t m = 0; m < 5; m++) {
        for (int lens = 0; lens < 2; lens++) {
            const char *text = lens ? FILM("lens", "") YIELDING SWITCHED("1 MOhm") "accuracy: 1e-5\nstudy: {transient: {until: 60 ms, every: 1 ms}}\n"
                                    : FILM("dot", "") YIELDING SWITCHED("1 MOhm") "accuracy: 1e-5\nstudy: {transient: {until: 60 ms, every: 1 ms}}\n";
            const char *still = lens ? FILM("lens", "") YIELDING "drive: {voltage: 4 kV}\nstudy: {sweep: {}}\n"
                                     : FILM("dot", "") YIELDING "drive: {voltage: 4 kV}\nstudy: {sweep: {}}\n";
            const double rest = row_of(still, models[m], "direct").displacement;
            dea_scene scene;
            read_scene(text, models[m], &scene);
            solve(text, models[m], "ida", &one);
            const dea_layout layout = dea_layout_of(&scene);
            assert_true(dea_layout_summary(&layout, one.bytes)->residual < 1e-4);
            assert_near(((const dea_sample *)one.bytes)[60].displacement, rest, 2e-5 * fabs(rest));
            dea_scene_free(&scene);
        }
    }
}

static void engines_agree_on_moving_permittivities(void **state)
{
    (void)state;
    static const char *const models[] = {"lame", "ring"};
    const char *text = FILM("dot", "") YIELDING SWITCHED("1 MOhm") MOVED;
    for (size_t m = 0; m < 2; m++) {
        solve(text, models[m], "ida", &one);
        solve(text, models[m], "ngspice", &other);
        const dea_sample *wanted = (const dea_sample *)one.bytes, *rows = (const dea_sample *)other.bytes;
        for (size_t i = 0; i < one.rows; i++) {
            assert_near(rows[i].displacement, wanted[i].displacement, 2e-5 * wanted[40].displacement);
            assert_near(rows[i].charge, wanted[i].charge, 4e-5 * wanted[40].charge);
        }
    }
}

static void engines_agree_on_shaken_permittivities(void **state)
{
    (void)state;
    static const char *const models[] = {"lumped", "lame", "coverage", "ring", "field"};
    for (size_t m = 0; m < 5; m++) {
        for (int lens = 0; lens < 2; lens++) {
            const char *text = lens ? FILM("lens", "") YIELDING "drive: {series_resistance: 1 MOhm}\n" SHAKEN
                                    : FILM("dot", "") YIELDING "drive: {series_resistance: 1 MOhm}\n" SHAKEN;
            solve(text, models[m], "direct", &one);
            solve(text, models[m], "ngspice", &other);
            const dea_response *wanted = (const dea_response *)one.bytes, *rows = (const dea_response *)other.bytes;
            for (size_t i = 0; i < one.rows; i++) {
                assert_relative(rows[i].displacement, wanted[i].displacement, 1e-6);
                assert_relative(rows[i].impedance, wanted[i].impedance, 1e-6);
            }
        }
    }
}

/* eps(l) + l eps'/4 <= 0: the film would shrink under voltage; and no film has a permittivity below 0. */
static void a_film_that_voltage_shrinks_is_refused(void **state)
{
    (void)state;
    static const char *const words[][2] = {
        {"{constant: 2.76, per_stretch: -1.84, follows: strain}", "test:2:128: material.permittivity.per_stretch: -1.84"},
        {"{constant: 2.76, per_stretch: -2.4, follows: strain}", "test:2:128: material.permittivity: falls to -0.12"},
        {"{constant: 2.76, per_stretch: -0.28, follows: strian}", "did you mean strain?"},
    };
    for (size_t i = 0; i < sizeof words / sizeof *words; i++) {
        char text[1024];
        dea_scene scene;
        dea_error error = {0};
        snprintf(text, sizeof text, "%smaterial: {base: elastosil-2030, yeoh: {C1: 178426 Pa, C2: -6023 Pa, C3: 4234 Pa}, permittivity: %s}\n" STILL,
                 FILM("dot", ""), words[i][0]);
        assert_int_equal(dea_scene_parse(text, strlen(text), "test", ".", NULL, 0, "ring", &scene, &error), DEA_ERROR_SCENE);
        if (!strstr(error.message, words[i][1])) {
            fail_msg("%s", error.message);
        }
    }
    const char *swept = FILM("dot", "") FOLLOWED "drive: {voltage: 4500 V}\nstudy: {sweep: {material.permittivity.per_stretch: [-1.9, -0.28]}}\n";
    for (size_t e = 0; e < ENGINES; e++) {
        solve(swept, "ring", engines[e], &one);
        assert_int_equal(((const dea_row *)one.bytes)[0].state, DEA_STATE_FAILED);
        assert_int_equal(((const dea_row *)one.bytes)[1].state, DEA_STATE_OK);
    }
}

/* A force draws the film to where its permittivity, 3.2 - 1.5 lambda, would be below 0. */
static void a_film_drawn_past_its_permittivity_has_no_numbers(void **state)
{
    (void)state;
    static const char *const models[] = {"lumped", "lame", "coverage", "ring", "field"};
    const char *drawn = "actuator: {kind: dot, frame_radius: 30 mm, coverage: 0.3, film_thickness: 100 um, prestretch: 1.2}\n"
                        "material: {neo_hookean: {mu: 60 kPa}, permittivity: {constant: 3.2, per_stretch: -1.5, follows: strain}}\n"
                        "drive: {voltage: 1 kV}\nstudy: {sweep: {load.force: [0.3 N, 2 N]}}\nload: {force: 2 N}\n";
    for (size_t m = 0; m < 5; m++) {
        for (size_t e = 0; e < ENGINES; e++) {
            if (can(drawn, models[m], engines[e])) {
                solve(drawn, models[m], engines[e], &one);
                const dea_row *rows = (const dea_row *)one.bytes;
                assert_true(rows[0].state == DEA_STATE_OK && rows[0].capacitance > 0.0);
                assert_true(rows[1].state == DEA_STATE_FAILED && isnan(rows[1].strain));
            }
        }
    }
}

/* Who cannot do what with a membrane says so, and somebody else does it, or another model. */
static void what_a_membrane_cannot_is_refused_by_name(void **state)
{
    static const struct {
        const char *more, *engine, *says, *able, *model;
    } cases[] = {
        {"antagonist: {actuator: {kind: lens}}\n" STILL, "ngspice", "at rest has no second film", "ida", "field"},
        {"drive: {voltage: 3 kV}\nstudy: {force: {displacement: {from: 0 mm, to: 0.1 mm, points: 3}}}\n", "ngspice",
         "does not hold the edge", "ida", "field"},
        {SWITCHED("1 MOhm, current_limit: 1 mA") MOVED, "ida", "no current limit; ring does", "ida", "ring"},
        {SWITCHED("1 MOhm, current_limit: 1 mA") MOVED, "ngspice", "no current limit; ring does", "ngspice", "ring"},
    };
    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char text[1024];
        dea_scene scene;
        snprintf(text, sizeof text, "%s" LOSSY "%s", FILM("dot", ""), cases[i].more);
        read_scene(text, "field", &scene);
        const char *says = dea_engine_refuses(dea_engine_find(cases[i].engine), &scene, scene.models[0]);
        assert_true(says && strstr(says, cases[i].says));
        assert_null(dea_engine_refuses(dea_engine_find(cases[i].able), &scene, dea_model_find(cases[i].model)));
        dea_scene_free(&scene);
    }
}

/* What a file for circuits leaves out is refused with what can be done, or told: nothing is written that is not the scene's film. */
static void what_no_circuit_file_holds_is_refused_or_told(void **state)
{
    static const struct {
        const char *more, *model;
        bool part; /* a part, not a netlist */
        const char *says; /* NULL: it is written */
        const char *note;
    } cases[] = {
        {"load: {force: 0.1 N}\n", "field", false, NULL, ""},
        {"antagonist: {actuator: {kind: lens}}\n", "field", false, "--model ring is one", ""},
        {"load: {stiffness: 100 N/m}\n", "field", false, NULL, ""},
        {"load: {force: 0.1 N}\n", "ring", false, NULL, ""},
        {SKIN, "ring", true, NULL, ""},
        {"antagonist: {actuator: {kind: lens}}\n", "ring", true, NULL, ""},
        {"antagonist: {actuator: {kind: lens}}\nload: {mass: 1 g}\n", "ring", true, NULL, "the rest of the scene: the load at its pin edge"},
        {"electrode: {sheet_resistance: 40 kOhm}\n", "field", true, "--model ring is one", ""},
        {"electrode: {sheet_resistance: 40 kOhm}\nload: {mass: 1 g}\n", "ring", true, NULL,
         "a resistor of 3183.1 Ohm before its pin p, and the load at its pin edge"}, /* rho/(8 pi) of each of two electrodes */
        {"load: {mass: 1 g}\n", "field", true, NULL, "the rest of the scene: the load at its pin edge"},
        {"", "field", true, NULL, ""},
    };
    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char text[1024];
        dea_scene scene;
        dea_error error = {0};
        snprintf(text, sizeof text, "%s" PAPER "%s" STILL, FILM("dot", ""), cases[i].more);
        read_scene(text, cases[i].model, &scene);
        dea_export export = {.scene = &scene, .dialect = dea_dialect_at(0), .analogy = dea_analogy_at(0), .out = tmpfile()};
        assert_non_null(export.out);
        const dea_status status = cases[i].part ? dea_part_of_scene(&scene, scene.models[0], NULL, export.dialect, export.out, &error)
                                                : dea_export_netlist(&export, &error);
        assert_int_equal(status, cases[i].says ? DEA_ERROR_UNSUPPORTED : DEA_OK);
        assert_true(!cases[i].says || strstr(error.message, cases[i].says));
        if (cases[i].part && !cases[i].says) {
            dea_part_note(&scene, export.note, sizeof export.note);
            assert_true(*cases[i].note ? strstr(export.note, cases[i].note) != NULL : *export.note == '\0');
        }
        fclose(export.out);
        dea_scene_free(&scene);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_stack_is_as_many_films_side_by_side),
        cmocka_unit_test(charge_of_a_stack_is_the_printed_one),
        cmocka_unit_test(a_stack_moves_as_one_film),
        cmocka_unit_test(a_stack_answers_with_a_fifth_of_the_impedance),
        cmocka_unit_test(a_skin_costs_the_printed_strain),
        cmocka_unit_test(a_skinned_film_of_rings_rests_where_its_energy_is_least),
        cmocka_unit_test(engines_agree_on_skins),
        cmocka_unit_test(engines_agree_on_moving_skins),
        cmocka_unit_test(engines_agree_on_shaken_skins),
        cmocka_unit_test(a_slow_membrane_moves_its_skin_along),
        cmocka_unit_test(a_film_against_a_spring_rests_where_its_energy_is_least),
        cmocka_unit_test(without_voltage_every_engine_has_the_film_at_rest),
        cmocka_unit_test(engines_agree_on_loads),
        cmocka_unit_test(engines_agree_on_moving_loads),
        cmocka_unit_test(engines_agree_on_shaken_loads),
        cmocka_unit_test(a_heavy_load_makes_the_membrane_a_spring),
        cmocka_unit_test(sheets_are_one_resistance_of_the_same_loss),
        cmocka_unit_test(sheets_add_to_the_series_resistance),
        cmocka_unit_test(a_permittivity_that_follows_costs_the_printed_strain),
        cmocka_unit_test(a_film_of_rings_rests_where_its_electrical_energy_lets_it),
        cmocka_unit_test(electrostriction_is_the_slope_of_the_capacitance),
        cmocka_unit_test(engines_agree_on_permittivities_that_follow),
        cmocka_unit_test(engines_agree_on_pulled_permittivities_that_follow),
        cmocka_unit_test(a_film_whose_permittivity_follows_keeps_its_energy),
        cmocka_unit_test(engines_agree_on_moving_permittivities),
        cmocka_unit_test(engines_agree_on_shaken_permittivities),
        cmocka_unit_test(a_film_that_voltage_shrinks_is_refused),
        cmocka_unit_test(a_film_drawn_past_its_permittivity_has_no_numbers),
        cmocka_unit_test(what_a_membrane_cannot_is_refused_by_name),
        cmocka_unit_test(what_no_circuit_file_holds_is_refused_or_told),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
