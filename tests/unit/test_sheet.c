/* Resistive electrodes of the moving membrane: against diffusion in a film that rests, finite elements of a film that moves, the one
 * resistance of a slow film, and the balance of energy. */
#include <complex.h>

#include "moving_membrane.h"

enum { POINTS = 61, THICKNESS = 4, FIELD = 7 };

static const double epsilon = 8.8541878128e-12 * 2.8;

/* The paper's film, its electrodes rho a square each, under a step. */
static dea_scene sheet_scene(dea_kind kind, double rho, double voltage, double rise, double until, size_t samples)
{
    dea_scene scene = paper_scene(kind, 1.2, 0.5, (double)NAN);
    scene.models[0] = dea_model_find("field");
    scene.study = DEA_STUDY_TRANSIENT;
    scene.accuracy = 1e-5;
    scene.electrode = (dea_electrode){.thickness = (double)NAN, .density = (double)NAN, .sheet_resistance = rho};
    scene.material.density = 1080.0;
    scene.material.retardation = 5e-5;
    scene.drive.waveform = (dea_waveform){
        .kind = DEA_WAVE_STEP, .step = {.off = (double)NAN, .voltage = voltage, .rise = rise}, .period = (double)NAN};
    scene.transient = (dea_transient){.until = until, .every = until / (double)samples, .points = POINTS};
    return scene;
}

/* Voltage across the film at a radius. */
static double voltage_at(const dea_layout *layout, const dea_sample *samples, size_t row, size_t radius)
{
    const double *entry = dea_layout_entry(layout, samples, row, radius);
    return entry[FIELD] * entry[THICKNESS];
}

/* Zeros of J0, by Newton's method from McMahon's places. */
static double bessel_zero(int n)
{
    double x = ((double)n - 0.25) * 3.14159265358979323846;
    for (int i = 0; i < 20; i++) {
        x += j0(x) / j1(x);
    }
    return x;
}

/* A film that hardly moves, fed at the rim r = a of its disc by a ramp up to T: with k_n = x_n^2/(rho c a^2), J0(x_n) = 0,
 * V = 1 - sum 2 J0(x_n r/a)/(x_n J1(x_n)) (e^-k_n(t - T) - e^-k_n t)/(k_n T). */
static void a_resting_disc_charges_as_bessel_functions_say(void **state)
{
    (void)state;
    const double rho = 1e7, rise = 1e-4, a = 0.015;
    const dea_scene scene = sheet_scene(DEA_DOT, rho, 1.0, rise, 4e-3, 20);
    dea_layout layout;
    dea_sample *samples = fly(&scene, &layout);
    const double areal = epsilon * 1.44 / 1e-4; /* c of the pre-stretched film */
    for (size_t k = 1; k <= 20; k++) {
        double wanted[POINTS], charge = 1.0;
        for (size_t i = 0; i < POINTS; i++) {
            wanted[i] = 1.0;
        }
        for (int n = 1; n <= 60; n++) {
            const double x = bessel_zero(n), rate = x * x / (2.0 * rho * areal * a * a), t = samples[k].time;
            const double gone = (exp(-rate * (t - rise)) - exp(-rate * t)) / (rate * rise);
            charge -= 4.0 / (x * x) * gone;
            for (size_t i = 0; i < POINTS; i++) {
                const double r = dea_layout_radius(&scene, &layout, i);
                wanted[i] -= 2.0 / (x * j1(x)) * j0(x * fmin(1.0, r / a)) * gone;
            }
        }
        assert_true(fabs(samples[k].charge / (areal * 3.14159265358979 * a * a) - charge) <= 1e-4);
        assert_true(fabs(samples[k].film_voltage - charge) <= 1e-4);
        for (size_t i = 0; i <= POINTS / 2; i++) {
            assert_true(fabs(voltage_at(&layout, samples, k, i) - wanted[i]) <= 2e-4);
        }
    }
    free(samples);
}

/* The same annulus by finite volumes, fed at the frame: (c r dr) V' = flux out - flux in, implicit midpoint. */
static void a_resting_annulus_charges_as_finite_volumes_do(void **state)
{
    (void)state;
    enum { CELLS = 1500, STEPS = 4000 };
    const double rho = 1e7, rise = 1e-4, from = 0.015, to = 0.03, end = 2e-3;
    const dea_scene scene = sheet_scene(DEA_LENS, rho, 1.0, rise, end, 4);
    dea_layout layout;
    dea_sample *samples = fly(&scene, &layout);
    const double areal = epsilon * 1.44 / 1e-4, dr = (to - from) / CELLS, dt = end / STEPS, d = 1.0 / (2.0 * rho * areal);
    static double v[CELLS], upper[CELLS], right[CELLS];
    memset(v, 0, sizeof v);
    for (size_t k = 0; k < STEPS; k++) {
        const double rim = fmin(1.0, ((double)k + 0.5) * dt / rise);
        for (size_t i = 0; i < CELLS; i++) { /* of the midpoint: (2/dt + A) w = 2/dt v, v = 2 w - v */
            const double r = from + ((double)i + 0.5) * dr, unit = d / (r * dr * dr);
            const double inner = i > 0 ? unit * (r - 0.5 * dr) : 0.0, outer = (i + 1 < CELLS ? 1.0 : 2.0) * unit * (r + 0.5 * dr);
            const double diagonal = 2.0 / dt + inner + outer - (i > 0 ? inner * upper[i - 1] : 0.0);
            upper[i] = (i + 1 < CELLS ? outer : 0.0) / diagonal;
            right[i] = (2.0 / dt * v[i] + (i + 1 < CELLS ? 0.0 : outer * rim) + (i > 0 ? inner * right[i - 1] : 0.0)) / diagonal;
        }
        for (size_t i = CELLS; i-- > 0;) {
            right[i] += i + 1 < CELLS ? upper[i] * right[i + 1] : 0.0;
            v[i] = 2.0 * right[i] - v[i];
        }
    }
    double charge = 0.0;
    for (size_t i = 0; i < CELLS; i++) {
        charge += areal * 2.0 * 3.14159265358979 * (from + ((double)i + 0.5) * dr) * dr * v[i];
    }
    assert_relative(samples[4].charge, charge, 1e-4);
    for (size_t i = POINTS / 2 + 1; i < POINTS; i++) {
        const double place = (dea_layout_radius(&scene, &layout, i) - from) / dr - 0.5;
        const size_t cell = (size_t)fmin(CELLS - 2, fmax(0.0, floor(place)));
        const double wanted = v[cell] + (place - (double)cell) * (v[cell + 1] - v[cell]);
        assert_true(fabs(voltage_at(&layout, samples, 4, i) - wanted) <= 2e-4);
    }
    free(samples);
}

/* ---- a film that moves: finite elements of degree six for the potential too, their capacitance not diagonal */

typedef struct fe_sheet {
    size_t first, count; /* nodes of the electrode, the last one fed */
    double rho;          /* of both electrodes together */
} fe_sheet;

typedef struct fe_charged {
    fe_state film;
    double q[FE_NODES]; /* of all but the fed node */
} fe_charged;

/* Gauss on a full matrix. */
static void solve(size_t n, double (*a)[FE_NODES], double *b)
{
    for (size_t k = 0; k < n; k++) {
        for (size_t i = k + 1; i < n; i++) {
            const double factor = a[i][k] / a[k][k];
            for (size_t j = k; j < n; j++) {
                a[i][j] -= factor * a[k][j];
            }
            b[i] -= factor * b[k];
        }
    }
    for (size_t k = n; k-- > 0;) {
        for (size_t j = k + 1; j < n; j++) {
            b[k] -= a[k][j] * b[j];
        }
        b[k] /= a[k][k];
    }
}

/* Potentials v of the nodes and of the places; returns the charge of the film. */
static double fe_potentials(const fe_film *f, const fe_sheet *s, const fe_charged *y, double source, double *v, double *places)
{
    static double c[FE_NODES][FE_NODES];
    double all = 0.0;
    memset(c, 0, sizeof c);
    for (size_t p = 0; p < FE_PLACES; p++) {
        const size_t e = p / DEA_GAUSS_POINTS * FE_DEGREE, g = p % DEA_GAUSS_POINTS;
        double l[2];
        fe_stretches(f, p, y->film.u, f->prestretch, l);
        const double own = 2.0 * fe_pi * f->radius[p] * f->weight[p] * f->permittivity / f->thickness * l[0] * l[0] * l[1] * l[1];
        for (size_t i = 0; i <= FE_DEGREE && fe_electroded(f, p); i++) {
            for (size_t j = 0; j <= FE_DEGREE; j++) {
                c[e + i - s->first][e + j - s->first] += own * f->shape[g][i] * f->shape[g][j];
            }
        }
    }
    const size_t rim = s->count - 1;
    double held[FE_NODES] = {0.0};
    for (size_t i = 0; i < rim; i++) {
        held[i] = c[rim][i];
        v[i] = y->q[i] - c[i][rim] * source;
        all += y->q[i];
    }
    const double own = c[rim][rim];
    solve(rim, c, v);
    v[rim] = source;
    for (size_t i = 0; i < rim; i++) {
        all += held[i] * v[i];
    }
    for (size_t p = 0; p < FE_PLACES; p++) {
        const size_t e = p / DEA_GAUSS_POINTS * FE_DEGREE, g = p % DEA_GAUSS_POINTS;
        places[p] = 0.0;
        for (size_t i = 0; i <= FE_DEGREE && fe_electroded(f, p); i++) {
            places[p] += f->shape[g][i] * v[e + i - s->first];
        }
    }
    return all + own * source;
}

static void fe_charged_rates(fe_film *f, const fe_sheet *s, double time, const fe_charged *y, fe_charged *d)
{
    static double places[FE_PLACES];
    double v[FE_NODES];
    fe_potentials(f, s, y, fe_source(f, time), v, places);
    f->potential = places;
    fe_rates(f, time, &y->film, &d->film);
    memset(d->q, 0, sizeof d->q);
    for (size_t p = 0; p < FE_PLACES; p++) {
        const size_t e = p / DEA_GAUSS_POINTS * FE_DEGREE;
        double l[2], gradient = 0.0;
        fe_stretches(f, p, y->film.u, f->prestretch, l);
        for (size_t i = 0; i <= FE_DEGREE && fe_electroded(f, p); i++) {
            gradient += f->slope[p][i] * v[e + i - s->first];
        }
        const double flux = 2.0 * fe_pi * f->radius[p] * f->weight[p] / s->rho * l[1] / l[0] * gradient;
        for (size_t i = 0; i <= FE_DEGREE && fe_electroded(f, p); i++) {
            d->q[e + i - s->first] -= f->slope[p][i] * flux;
        }
    }
    d->q[s->count - 1] = 0.0;
}

static void fe_charged_step(fe_film *f, const fe_sheet *s, double time, double h, fe_charged *y)
{
    static const double at[] = {0.0, 0.5, 0.5, 1.0}, share[] = {1.0 / 6.0, 1.0 / 3.0, 1.0 / 3.0, 1.0 / 6.0};
    enum { SIZE = sizeof(fe_charged) / sizeof(double) };
    static fe_charged here, rate, sum;
    double *const old = (double *)y, *const x = (double *)&here, *const k = (double *)&rate, *const total = (double *)&sum;
    memset(&rate, 0, sizeof rate);
    memset(&sum, 0, sizeof sum);
    for (int i = 0; i < 4; i++) {
        for (size_t j = 0; j < SIZE; j++) {
            x[j] = old[j] + h * at[i] * k[j];
        }
        fe_charged_rates(f, s, time + h * at[i], &here, &rate);
        for (size_t j = 0; j < SIZE; j++) {
            total[j] += share[i] * k[j];
        }
    }
    for (size_t j = 0; j < SIZE; j++) {
        old[j] += h * total[j];
    }
}

/* Rows `each`, 2 each, ... of a run against the finite elements, in that many steps of h from one to the next. */
static void check_moving(const dea_scene *scene, size_t each, size_t steps, double tolerance)
{
    dea_layout layout;
    dea_sample *samples = fly(scene, &layout);
    static fe_film f;
    static fe_charged y;
    static double places[FE_PLACES];
    double v[FE_NODES];
    memset(&y, 0, sizeof y);
    fe_open(scene, &f);
    fe_rest(&f, &y.film);
    const bool dot = scene->actuator.kind == DEA_DOT;
    const size_t edge = fe_edge(&f);
    const fe_sheet sheet = {dot ? 0 : edge, dot ? edge + 1 : FE_NODES - edge, 2.0 * scene->electrode.sheet_resistance};
    const double width = scene->transient.every * (double)each, h = width / (double)steps;
    for (size_t k = 1; k <= 2; k++) {
        for (size_t i = 0; i < steps; i++) {
            fe_charged_step(&f, &sheet, width * (double)(k - 1) + h * (double)i, h, &y);
        }
        const dea_sample *at = &samples[k * each];
        const double charge = fe_potentials(&f, &sheet, &y, f.voltage, v, places);
        assert_true(fabs(at->displacement - y.film.u[edge]) <= 2.0 * tolerance * 3e-4);
        assert_true(fabs(at->velocity - y.film.v[edge]) <= 20.0 * tolerance);
        assert_relative(at->charge, charge, 10.0 * tolerance);
        assert_relative(at->film_voltage * fe_capacitance(&f, y.film.u), charge, 10.0 * tolerance);
        for (size_t n = dot ? 0 : FE_DEGREE; n < sheet.count; n += FE_DEGREE) { /* at the edge the radius is the disc's */
            const double rim = scene->actuator.frame_radius, edge_radius = rim * f.coverage;
            const double share = (double)n / (double)(sheet.count - 1), radius = dot ? share * edge_radius : edge_radius + share * (rim - edge_radius);
            const size_t told = (size_t)lround(radius / rim * (double)(layout.spread_points - 1));
            assert_true(fabs(voltage_at(&layout, samples, k * each, told) - v[n]) <= fmax(2e-3, 10.0 * tolerance) * f.voltage);
        }
    }
    free(samples);
}

static void a_moving_film_charges_as_finite_elements_do(void **state)
{
    (void)state;
    for (int kind = DEA_DOT; kind <= DEA_LENS; kind++) {
        const dea_scene scene = sheet_scene((dea_kind)kind, 2e7, 4500.0, 1e-4, 6e-4, 2);
        check_moving(&scene, 1, 2400, scene.accuracy);
    }
}

/* examples/slow-electrode.yaml; its strain travels ahead of its charge. */
static void the_slow_electrode_of_the_example_charges_as_finite_elements_do(void **state)
{
    (void)state;
    dea_scene scene;
    dea_layout layout;
    dea_error error = {0};
    assert_int_equal(dea_scene_read("examples/slow-electrode.yaml", NULL, 0, NULL, &scene, &error), DEA_OK);
    check_moving(&scene, 25, 2500, scene.accuracy);
    dea_sample *samples = fly(&scene, &layout);
    const size_t inside = 49, row = 40; /* next to the lens, at 0.8 ms */
    assert_true(dea_layout_entry(&layout, samples, row, inside)[0] < -5e-5); /* it moves */
    assert_true(voltage_at(&layout, samples, row, inside) < 0.03 * 4500.0);  /* without charge */
    free(samples);
    dea_scene_free(&scene);
}

/* ---- what holds of all of them */

/* A slow voltage sees the one resistance of the films of one node: rho/(8 pi) an electrode of a disc. */
static void a_slow_voltage_sees_one_resistance(void **state)
{
    (void)state;
    for (int kind = DEA_DOT; kind <= DEA_LENS; kind++) {
        dea_scene scene = sheet_scene((dea_kind)kind, 1e9, 1000.0, 2.0, 1.9, 10);
        scene.material.retardation = 5e-3;
        scene.transient.points = 0;
        dea_layout layout;
        dea_sample *samples = fly(&scene, &layout);
        for (size_t k = 5; k <= 10; k++) { /* the mean lags by R C dU/dt: C moves by a part in a thousand */
            const double lag = dea_series_resistance(&scene) * samples[k].current;
            assert_relative(samples[k].voltage - samples[k].film_voltage, lag, 2e-3);
            assert_true(kind == DEA_LENS || is_close(dea_series_resistance(&scene), 2e9 / (8.0 * 3.14159265358979), 1e-12, 0.0));
        }
        free(samples);
    }
}

static void energy_balances_whatever_the_sheets_are(void **state)
{
    (void)state;
    static const double sheets[] = {1e-3, 1.0, 1e4, 1e6, 1e7, 1e8};
    for (size_t i = 0; i < sizeof sheets / sizeof *sheets; i++) {
        for (int variant = 0; variant < 6; variant++) {
            dea_scene scene = sheet_scene(variant == 1 ? DEA_LENS : DEA_DOT, sheets[i], 3500.0, 1e-4, 2e-3, 20);
            scene.accuracy = 1e-4;
            scene.transient.points = 0;
            scene.drive.series_resistance = variant == 2 ? 1e6 : (double)NAN;
            scene.drive.leakage_resistance = variant == 3 ? 1e8 : (double)NAN;
            scene.material.density = variant >= 4 ? (double)NAN : 1080.0; /* without mass, then without damper too */
            scene.material.retardation = variant == 5 ? (double)NAN : 5e-5;
            if (variant >= 4) {
                scene.material.prony[0] = (dea_prony){.g = 0.2, .tau = 3e-4};
                scene.material.prony_count = 1;
            }
            dea_layout layout;
            dea_sample *samples = fly(&scene, &layout);
            const dea_summary *summary = dea_layout_summary(&layout, samples);
            if (!(summary->residual <= 10.0 * scene.accuracy && summary->dissipated > 0.0 && summary->work > 0.0)) {
                fail_msg("%g Ohm, variant %d: balance off by %g", sheets[i], variant, summary->residual);
            }
            free(samples);
        }
    }
}

/* Where the sheets conduct well the film moves as without them. */
static void good_sheets_are_as_none(void **state)
{
    (void)state;
    for (int variant = 0; variant < 3; variant++) {
        dea_scene scene = sheet_scene(variant == 1 ? DEA_LENS : DEA_DOT, 1e-3, 4500.0, 1e-4, 2e-3, 20);
        dea_layout layout;
        scene.drive.series_resistance = variant == 2 ? 1e6 : (double)NAN;
        scene.drive.leakage_resistance = 1e10; /* both have a current */
        dea_sample *with = fly(&scene, &layout);
        scene.electrode.sheet_resistance = (double)NAN;
        dea_sample *without = fly(&scene, &layout);
        double current = 0.0;
        for (size_t k = 0; k <= 20; k++) {
            current = fmax(current, fabs(without[k].current));
        }
        for (size_t k = 1; k <= 20; k++) {
            assert_true(fabs(with[k].displacement - without[k].displacement) <= 3e-5 * 1e-3);
            assert_true(fabs(with[k].current - without[k].current) <= 3e-4 * current);
            assert_relative(with[k].charge, without[k].charge, 1e-4);
        }
        free(with);
        free(without);
    }
}

/* From a bias the charge rests until the voltage changes. */
static void from_a_bias_nothing_moves(void **state)
{
    (void)state;
    dea_scene scene = sheet_scene(DEA_DOT, 1e6, 4000.0, 1e-4, 1e-3, 10);
    double times[] = {0.0, 2.0}, voltages[] = {3000.0, 3000.0};
    scene.drive.waveform = (dea_waveform){.kind = DEA_WAVE_POINTS, .times = times, .voltages = voltages, .point_count = 2, .period = (double)NAN};
    scene.transient.from_bias = true;
    dea_layout layout;
    dea_sample *samples = fly(&scene, &layout);
    for (size_t k = 0; k <= 10; k++) {
        assert_true(fabs(samples[k].displacement / samples[0].displacement - 1.0) <= 1e-9);
        assert_true(fabs(samples[k].current) <= 1e-4 * samples[0].charge / 1e-3);
        assert_relative(samples[k].film_voltage, 3000.0, 1e-9);
    }
    free(samples);
}

static void a_jump_into_bare_sheets_is_refused_by_name(void **state)
{
    (void)state;
    const dea_scene scene = sheet_scene(DEA_DOT, 1e6, 4000.0, 0.0, 1e-3, 10);
    const dea_engine *ida = dea_engine_find("ida");
    const dea_layout layout = dea_layout_of(&scene);
    dea_error error = {0};
    void *session = NULL;
    dea_sample *samples = calloc(1, layout.point_size);
    assert_int_equal(ida->begin(&session, &error), DEA_OK);
    assert_int_equal(ida->transient(session, &scene, scene.models[0], samples, dea_layout_summary(&layout, samples), &error), DEA_OK);
    assert_non_null(strstr(error.message, "electrode.sheet_resistance"));
    assert_int_equal(samples[5].state, DEA_STATE_FAILED);
    ida->end(session);
    free(samples);
}

/* ---- in frequency */

static dea_scene tone_scene(dea_kind kind, double rho, double bias, double from, double to)
{
    dea_scene scene = sheet_scene(kind, rho, 1.0, 1e-4, 1e-3, 10);
    scene.study = DEA_STUDY_AC;
    scene.accuracy = 1e-6;
    scene.drive.waveform = (dea_waveform){.kind = DEA_WAVE_NONE, .period = (double)NAN};
    scene.drive.voltage = bias;
    scene.ac = (dea_ac){.from = from, .to = to, .points_per_decade = 2, .bias = bias};
    return scene;
}

/* Rows of a response by `direct`; the caller frees them. */
static dea_response *respond(const dea_scene *scene, size_t *count)
{
    dea_error error = {0};
    const dea_layout layout = dea_layout_of(scene);
    dea_response *rows = calloc(1, layout.point_size);
    *count = layout.rows;
    assert_null(dea_engine_refuses(dea_engine_find("direct"), scene, scene->models[0]));
    assert_int_equal(dea_engine_find("direct")->ac(NULL, scene, scene->models[0], rows, NULL, &error), DEA_OK);
    assert_string_equal(error.message, "");
    return rows;
}

/* Modified Bessel functions I0 and I1 by their series. */
static double complex modified(int order, double complex z)
{
    double complex term = order ? 0.5 * z : 1.0, sum = term;
    for (int k = 1; k < 200; k++) {
        term *= 0.25 * z * z / ((double)k * (double)(k + order));
        sum += term;
    }
    return sum;
}

/* A disc at rest, fed at its rim: I/U = 2 pi x I1(x)/(rho I0(x)), x^2 = i w c rho a^2. */
static void a_resting_disc_has_the_impedance_of_diffusion(void **state)
{
    (void)state;
    const double rho = 1e7, a = 0.015, areal = epsilon * 1.44 / 1e-4;
    const dea_scene scene = tone_scene(DEA_DOT, rho, 0.0, 1.0, 1e5);
    size_t count;
    dea_response *rows = respond(&scene, &count);
    for (size_t i = 0; i < count; i++) {
        const double omega = 2.0 * 3.14159265358979323846 * rows[i].frequency;
        const double complex x = csqrt(I * (omega * areal * 2.0 * rho)) * a;
        const double complex impedance = 2.0 * rho * modified(0, x) / (2.0 * 3.14159265358979323846 * x * modified(1, x));
        assert_relative(rows[i].impedance, cabs(impedance), 2e-6);
        assert_true(fabs(rows[i].impedance_phase - carg(impedance) * 180.0 / 3.14159265358979323846) <= 2e-4);
        assert_true(rows[i].displacement == 0.0);
    }
    free(rows);
}

/* With good sheets the response is that of the equation along the radius, which knows no rings. */
static void a_response_with_good_sheets_is_that_without(void **state)
{
    (void)state;
    for (int kind = DEA_DOT; kind <= DEA_LENS; kind++) {
        size_t count;
        dea_scene scene = tone_scene((dea_kind)kind, 1e-3, 3000.0, 1.0, 1e4);
        scene.drive.series_resistance = kind == DEA_DOT ? (double)NAN : 1e5;
        dea_response *with = respond(&scene, &count);
        scene.electrode.sheet_resistance = (double)NAN;
        dea_response *without = respond(&scene, &count);
        for (size_t i = 0; i < count; i++) {
            assert_relative(with[i].displacement, without[i].displacement, 2e-6);
            assert_relative(with[i].impedance, without[i].impedance, 2e-6);
            assert_true(fabs(with[i].displacement_phase - without[i].displacement_phase) <= 2e-4);
        }
        free(with);
        free(without);
    }
}

/* A small tone on the bias, in time: the last of its periods against the response. */
static void a_small_tone_in_time_moves_the_film_as_its_response_says(void **state)
{
    (void)state;
    enum { PERIODS = 24, EACH = 20 };
    for (int kind = DEA_DOT; kind <= DEA_LENS; kind++) {
        const double tone = 400.0, small = 3.0;
        const double resistance = kind == DEA_DOT ? 1e6 : (double)NAN; /* before the rim of the dot */
        dea_scene scene = sheet_scene((dea_kind)kind, 1e7, 1.0, 1e-4, PERIODS / tone, PERIODS * EACH);
        scene.accuracy = 1e-6;
        scene.material.retardation = 2e-4;
        scene.transient.points = 0;
        scene.transient.from_bias = true;
        scene.drive.series_resistance = resistance;
        scene.drive.waveform = (dea_waveform){
            .kind = DEA_WAVE_SINE, .sine = {.offset = 3000.0, .amplitude = small, .frequency = tone}, .period = (double)NAN};
        dea_layout layout;
        dea_sample *samples = fly(&scene, &layout);
        double complex u = 0.0, i = 0.0, source = 0.0;
        for (size_t k = (PERIODS - 1) * EACH; k < PERIODS * EACH; k++) {
            const double complex turn = cexp(-2.0 * I * 3.14159265358979323846 * tone * samples[k].time) * (2.0 / EACH);
            u += samples[k].displacement * turn;
            i += samples[k].current * turn;
            source += samples[k].voltage * turn;
        }
        free(samples);
        size_t count;
        scene = tone_scene((dea_kind)kind, 1e7, 3000.0, tone, tone);
        scene.material.retardation = 2e-4;
        scene.drive.series_resistance = resistance;
        dea_response *row = respond(&scene, &count);
        assert_relative(cabs(u / source), row->displacement, 2e-3);
        assert_relative(cabs(source / i), row->impedance, 2e-3);
        assert_true(fabs(carg(u / source) * 180.0 / 3.14159265358979323846 - row->displacement_phase) <= 0.2);
        assert_true(fabs(carg(source / i) * 180.0 / 3.14159265358979323846 - row->impedance_phase) <= 0.2);
        free(row);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_resting_disc_charges_as_bessel_functions_say),
        cmocka_unit_test(a_resting_annulus_charges_as_finite_volumes_do),
        cmocka_unit_test(a_moving_film_charges_as_finite_elements_do),
        cmocka_unit_test(the_slow_electrode_of_the_example_charges_as_finite_elements_do),
        cmocka_unit_test(a_slow_voltage_sees_one_resistance),
        cmocka_unit_test(energy_balances_whatever_the_sheets_are),
        cmocka_unit_test(good_sheets_are_as_none),
        cmocka_unit_test(from_a_bias_nothing_moves),
        cmocka_unit_test(a_resting_disc_has_the_impedance_of_diffusion),
        cmocka_unit_test(a_response_with_good_sheets_is_that_without),
        cmocka_unit_test(a_small_tone_in_time_moves_the_film_as_its_response_says),
        cmocka_unit_test(a_jump_into_bare_sheets_is_refused_by_name),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
