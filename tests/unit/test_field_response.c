/* Frequency response of the exact membrane by `direct`, against physics.md and against shooting along the radius in long double. */
#include <complex.h>

#include "random_scenes.h"

typedef long double real;
typedef long double complex cplx;

/* What the source sees at one frequency [Hz]. */
static dea_response respond(dea_scene scene, double frequency)
{
    dea_response row;
    dea_error error = {0};
    scene.study = DEA_STUDY_AC;
    scene.ac = (dea_ac){.from = frequency, .to = frequency, .points_per_decade = 1, .bias = scene.drive.voltage};
    scene.models[0] = dea_model_find("field");
    assert_int_equal(dea_engine_find("direct")->ac(NULL, &scene, scene.models[0], &row, NULL, &error), DEA_OK);
    return row;
}

/* The film of a test: Yeoh, its masses, damper and branches. */
static dea_scene moving_scene(dea_kind kind, double prestretch, double coverage, double voltage)
{
    dea_scene scene = paper_scene(kind, prestretch, coverage, voltage);
    scene.material.density = 1080.0;
    return scene;
}

static void add_branch(dea_scene *scene, double g, double tau)
{
    scene->material.prony[scene->material.prony_count++] = (dea_prony){g, tau};
}

/* ---- the judge */

/* State along x = ln(R/R_a): the static stretches, two solutions (u, T = xi ds1) with R_a as unit of length, free and driven by
 * 1 V, and what they do to the integral of the capacitance. */
typedef struct ray {
    real l1, l2;
    cplx u[2], t[2], c[2];
} ray;

typedef struct judge {
    const dea_scene *scene;
    real k_disc, k_annulus, slope_disc, slope_annulus; /* eps (U/H)^2 and its slope over U */
    real rho_disc, rho_annulus;                        /* over the reference volume */
    real radius;                                       /* R_a */
    real omega;
    cplx v;
} judge;

typedef struct moduli {
    real p1, p2, w11, w12, w22;
} moduli;

static moduli moduli_at(const judge *j, real a, real b)
{
    const double *c = j->scene->material.constants;
    const real i = a * a + b * b + 1.0L / (a * a * b * b) - 3.0L;
    const real w = c[0] + 2.0L * c[1] * i + 3.0L * c[2] * i * i, q = 2.0L * c[1] + 6.0L * c[2] * i;
    const real a1 = 2.0L * (a - 1.0L / (a * a * a * b * b)), a2 = 2.0L * (b - 1.0L / (b * b * b * a * a));
    return (moduli){w * a1, w * a2, w * (2.0L + 6.0L / (a * a * a * a * b * b)) + q * a1 * a1,
                    4.0L * w / (a * a * a * b * b * b) + q * a1 * a2, w * (2.0L + 6.0L / (b * b * b * b * a * a)) + q * a2 * a2};
}

/* The slopes over x of physics.md, section 3, and of its linearisation. */
static ray ray_slope(const judge *j, real x, const ray *y)
{
    const moduli m = moduli_at(j, y->l1, y->l2);
    const real a = y->l1, b = y->l2, k = j->k_annulus, xi = expl(x);
    const real s11 = m.w11 - k * b * b, s12 = m.w12 - 2.0L * k * a * b;
    const real s1 = m.p1 - k * a * b * b, s2 = m.p2 - k * b * a * a;
    const cplx z11 = (1.0L + j->v) * m.w11 + j->v * m.p1 / a - k * b * b, z12 = (1.0L + j->v) * m.w12 - 2.0L * k * a * b;
    const cplx z22 = (1.0L + j->v) * m.w22 + j->v * m.p2 / b - k * a * a;
    ray slope = {(s2 - s1 - s12 * (a - b)) / s11, a - b, {0}, {0}, {0}};
    for (int i = 0; i < 2; i++) {
        const real f1 = i == 1 ? -j->slope_annulus * a * b * b : 0.0L, f2 = i == 1 ? -j->slope_annulus * a * a * b : 0.0L;
        const cplx radial = ((y->t[i] - xi * f1) - z12 * y->u[i]) / z11; /* xi du/dR */
        slope.u[i] = radial;
        slope.t[i] = z12 * radial + z22 * y->u[i] + xi * f2 -
                     j->rho_annulus * j->omega * j->omega * j->radius * j->radius * xi * xi * y->u[i];
        slope.c[i] = xi * (a * b * b * radial + a * a * b * y->u[i]);
    }
    return slope;
}

static ray along(const ray *y, real h, const ray *slope)
{
    ray next = {y->l1 + h * slope->l1, y->l2 + h * slope->l2, {0}, {0}, {0}};
    for (int i = 0; i < 2; i++) {
        next.u[i] = y->u[i] + h * slope->u[i];
        next.t[i] = y->t[i] + h * slope->t[i];
        next.c[i] = y->c[i] + h * slope->c[i];
    }
    return next;
}

/* To the frame by the classical Runge-Kutta rule. */
static ray to_frame(const judge *j, ray y, int steps)
{
    const real h = -logl((real)j->scene->actuator.coverage) / steps;
    for (int i = 0; i < steps; i++) {
        const real x = i * h;
        const ray k1 = ray_slope(j, x, &y), y2 = along(&y, 0.5L * h, &k1);
        const ray k2 = ray_slope(j, x + 0.5L * h, &y2), y3 = along(&y, 0.5L * h, &k2);
        const ray k3 = ray_slope(j, x + 0.5L * h, &y3), y4 = along(&y, h, &k3);
        const ray k4 = ray_slope(j, x + h, &y4);
        y = along(&y, h / 6.0L, &k1);
        y = along(&y, h / 3.0L, &k2);
        y = along(&y, h / 3.0L, &k3);
        y = along(&y, h / 6.0L, &k4);
    }
    return y;
}

/* J1'(z) z/J1(z) by the power series in the square of z. */
static cplx bessel_slope(cplx square)
{
    cplx term = 1.0L, value = 1.0L, slope = 1.0L;
    for (int k = 1; k < 200; k++) {
        term *= -square / (4.0L * k * (k + 1));
        value += term;
        slope += (2.0L * k + 1.0L) * term;
    }
    return slope / value;
}

/* The edge under the stretch l of the disc: lambda_1 behind it from the continuity of s1, u = 1 free, u = 0 driven. */
static ray from_edge(const judge *j, real l)
{
    const moduli disc = moduli_at(j, l, l);
    const real s1 = disc.p1 - j->k_disc * l * l * l;
    ray y = {l, l, {1.0L, 0.0L}, {0}, {0}};
    for (int i = 0; i < 50; i++) {
        const moduli m = moduli_at(j, y.l1, l);
        y.l1 -= (m.p1 - j->k_annulus * y.l1 * l * l - s1) / (m.w11 - j->k_annulus * l * l);
    }
    const cplx z11 = (1.0L + j->v) * disc.w11 + j->v * disc.p1 / l - j->k_disc * l * l;
    const cplx z12 = (1.0L + j->v) * disc.w12 - 2.0L * j->k_disc * l * l;
    const cplx square = j->rho_disc * j->omega * j->omega * j->radius * j->radius / z11;
    y.t[0] = z11 * bessel_slope(square) + z12;
    y.t[1] = -j->slope_disc * l * l * l;
    return y;
}

/* Displacement of the edge and charge per volt on the film. */
typedef struct judged {
    cplx displacement, charge;
} judged;

static judged judge_by(const judge *j, int steps, double strain)
{
    const dea_actuator *film = &j->scene->actuator;
    const real pre = film->prestretch;
    real l = pre * (1.0L + strain), step = 1e-6L * pre, last = 0.0L;
    ray end = {0};
    for (int i = 0; i < 6; i++) { /* secant to lambda_2 = lambda_pre at the frame */
        end = to_frame(j, from_edge(j, l), steps);
        const real miss = end.l2 - pre, slope = i > 0 && miss != last ? (miss - last) / step : 1.0L;
        last = miss;
        step = -miss / slope;
        if (fabsl(step) < 1e-17L || i == 5) {
            break;
        }
        l += step;
    }
    const real eps = (real)DEA_EPSILON_0 * j->scene->material.permittivity, unit = 4.0L * DEA_PI * eps * j->radius * j->radius / film->film_thickness;
    const cplx u = -end.u[1] / end.u[0], change = end.c[1] + u * end.c[0];
    const bool dot = film->kind == DEA_DOT;
    const double rest = solve_direct(j->scene, "field").capacitance;
    return (judged){j->radius * u, rest + j->scene->drive.voltage * unit * (dot ? l * l * l * u : change)};
}

/* By Runge-Kutta on two meshes, extrapolated. */
static judged judge_scene(const dea_scene *scene, double frequency, int steps)
{
    const dea_actuator *film = &scene->actuator;
    const bool dot = film->kind == DEA_DOT;
    const real e = (real)DEA_EPSILON_0 * scene->material.permittivity / ((real)film->film_thickness * film->film_thickness);
    const real k = e * scene->drive.voltage * scene->drive.voltage, slope = 2.0L * e * scene->drive.voltage;
    const real omega = 2.0L * acosl(-1.0L) * frequency, film_mass = isnan(scene->material.density) ? 0.0L : scene->material.density;
    const real coat = isnan(film->electrode_mass) || film_mass == 0.0L
                          ? 0.0L
                          : (real)film->electrode_mass * film->prestretch * film->prestretch / film->film_thickness;
    judge j = {scene, dot ? k : 0.0L, dot ? 0.0L : k, dot ? slope : 0.0L, dot ? 0.0L : slope, film_mass + (dot ? coat : 0.0L),
               film_mass + (dot ? 0.0L : coat), (real)film->coverage * film->frame_radius / film->prestretch, omega, 0.0L};
    real share = 1.0L;
    for (size_t i = 0; i < scene->material.prony_count; i++) {
        share -= scene->material.prony[i].g;
    }
    j.v = isnan(scene->material.retardation) ? 0.0L : (cplx)I * omega * (real)scene->material.retardation;
    for (size_t i = 0; i < scene->material.prony_count; i++) {
        const cplx s = (cplx)I * omega * (real)scene->material.prony[i].tau;
        j.v += scene->material.prony[i].g / share * s / (1.0L + s);
    }
    const double strain = solve_direct(scene, "field").strain;
    const judged coarse = judge_by(&j, steps, strain), fine = judge_by(&j, 2 * steps, strain);
    return (judged){fine.displacement + (fine.displacement - coarse.displacement) / 15.0L,
                    fine.charge + (fine.charge - coarse.charge) / 15.0L};
}

/* Largest relative difference of displacement and charge to the judge's. */
static double difference(const dea_scene *scene, double frequency, int steps)
{
    const dea_response row = respond(*scene, frequency);
    const judged truth = judge_scene(scene, frequency, steps);
    const double radian = DEA_PI / 180.0, omega = 2.0 * DEA_PI * frequency;
    const cplx u = row.displacement * cexp(I * row.displacement_phase * radian);
    const cplx q = 1.0 / (row.impedance * cexp(I * row.impedance_phase * radian) * I * omega);
    return (double)fmaxl(cabsl(u - truth.displacement) / cabsl(truth.displacement), cabsl(q - truth.charge) / cabsl(truth.charge));
}

/* ---- tests */

static void the_response_is_that_of_the_reference_table(void **state)
{
    (void)state;
    static const double wanted[][5] = {{1.0, 1.958684830e-07, -0.061248, 5.081569720e8, -89.991833},
                                       {600.0, 8.019089950e-07, -44.117392, 6.441899044e5, -73.197756},
                                       {1200.0, 2.869630393e-08, -93.249076, 4.891210525e5, -88.709063}};
    dea_scene scene = moving_scene(DEA_DOT, 1.2, 0.5, 3000.0);
    scene.material.retardation = 20e-6;
    add_branch(&scene, 0.1 / 1.1, 1e-3);
    scene.accuracy = 1e-12;
    for (size_t i = 0; i < 3; i++) {
        const dea_response row = respond(scene, wanted[i][0]);
        assert_int_equal(row.state, DEA_STATE_OK);
        assert_relative(row.displacement, wanted[i][1], 6e-10);
        assert_true(fabs(row.displacement_phase - wanted[i][2]) < 6e-7);
        assert_relative(row.impedance, wanted[i][3], 6e-10);
        assert_true(fabs(row.impedance_phase - wanted[i][4]) < 6e-7);
    }
}

/* Where nothing damps it the response changes its sign at a mode. */
static void modes_lie_where_the_response_changes_its_sign(void **state)
{
    (void)state;
    static const struct {
        dea_kind kind;
        double prestretch, coverage, modes[3], digit[3];
    } cases[] = {{DEA_DOT, 1.1, 0.50, {629.520, 1177.549, 1698.65}, {6e-4, 6e-4, 6e-3}},
                 {DEA_DOT, 1.2, 0.25, {587.717, 1088.681, 1612.00}, {6e-4, 6e-4, 6e-3}},
                 {DEA_DOT, 1.3, 0.75, {596.617, 1075.283, 1553.98}, {6e-4, 6e-4, 6e-3}},
                 {DEA_LENS, 1.2, 0.50, {628.647, 1108.445, 1635.81}, {6e-4, 6e-4, 6e-3}}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        const dea_scene scene = moving_scene(cases[i].kind, cases[i].prestretch, cases[i].coverage, 4500.0);
        for (size_t m = 0; m < 3; m++) {
            const double below = respond(scene, cases[i].modes[m] - cases[i].digit[m]).displacement_phase;
            const double above = respond(scene, cases[i].modes[m] + cases[i].digit[m]).displacement_phase;
            assert_true(fabs(fabs(remainder(below - above, 360.0)) - 180.0) < 1e-3);
        }
    }
}

/* Films of all kinds, damped a little or much, with and without mass, up to modes beyond the tenth. */
static dea_scene random_film(uint64_t *seed, double *frequency)
{
    const double b = random_chance(seed, 0.3) ? random_decades(seed, 0.02, 0.2) : random_between(seed, 0.2, 0.98);
    dea_scene scene = moving_scene(random_chance(seed, 0.5) ? DEA_DOT : DEA_LENS, random_between(seed, 1.05, 1.4), b,
                                   random_between(seed, 500.0, 5000.0));
    scene.material.density = random_chance(seed, 0.2) ? (double)NAN : scene.material.density;
    scene.material.retardation = random_chance(seed, 0.2) ? (double)NAN : random_decades(seed, 1e-8, 1e-2);
    scene.actuator.electrode_mass = random_chance(seed, 0.5) ? (double)NAN : random_decades(seed, 1e-4, 0.1);
    for (int i = 0; i < 3 && random_chance(seed, 0.5); i++) {
        add_branch(&scene, random_between(seed, 0.01, 0.3), random_decades(seed, 1e-7, 10.0));
    }
    *frequency = random_chance(seed, 0.5) ? random_decades(seed, 1e-3, 1000.0) : random_between(seed, 300.0, 6000.0);
    scene.accuracy = 1e-9;
    return scene;
}

static void random_films_answer_as_shooting_in_long_double_does(void **state)
{
    (void)state;
    uint64_t seed = UINT64_C(0x9e3779b97f4a7c15);
    for (int i = 0; i < 40; i++) {
        double frequency;
        const dea_scene scene = random_film(&seed, &frequency);
        assert_true(difference(&scene, frequency, 1000) <= 2e-9);
    }
}

/* Past the tenth mode, bare; about a bias near pull-in; heavily damped: a thin film of the wave at the edge. */
static void hard_films_answer_as_shooting_in_long_double_does(void **state)
{
    (void)state;
    dea_scene scene = moving_scene(DEA_DOT, 1.2, 0.5, 3000.0);
    scene.accuracy = 1e-10;
    assert_true(difference(&scene, 6200.0, 1000) <= 1e-10);
    scene.material.retardation = 1e-2;
    assert_true(difference(&scene, 1e4, 2000) <= 1e-9);
    scene.material.retardation = 1e-6;
    scene.material.constants[1] = scene.material.constants[2] = 0.0; /* neo-Hookean: it folds */
    scene.actuator.coverage = 0.1;
    double low = 3000.0, high = 9000.0;
    while (high - low > 1.0) {
        scene.drive.voltage = 0.5 * (low + high);
        *(solve_direct(&scene, "field").state == DEA_STATE_PULL_IN ? &high : &low) = scene.drive.voltage;
    }
    scene.drive.voltage = low;
    assert_true(difference(&scene, 10.0, 2000) <= 1e-7);
    assert_true(difference(&scene, 600.0, 2000) <= 1e-7);
}

/* No bias moves nothing; the film is a capacitor. */
static void without_a_bias_the_film_is_its_capacitance(void **state)
{
    (void)state;
    for (int kind = DEA_DOT; kind <= DEA_LENS; kind++) {
        const dea_scene scene = moving_scene((dea_kind)kind, 1.2, 0.3, 0.0);
        const dea_response row = respond(scene, 600.0);
        assert_near(row.displacement, 0.0, 0.0);
        assert_relative(row.impedance, 1.0 / (2.0 * DEA_PI * 600.0 * solve_direct(&scene, "field").capacitance), 1e-14);
    }
}

static void no_equilibrium_under_the_bias_is_pull_in(void **state)
{
    (void)state;
    dea_scene scene = moving_scene(DEA_DOT, 1.2, 0.3, 50000.0);
    scene.material.constants[1] = scene.material.constants[2] = 0.0;
    const dea_response row = respond(scene, 600.0);
    assert_int_equal(row.state, DEA_STATE_PULL_IN);
    assert_true(isnan(row.displacement) && isnan(row.impedance));
}

/* s11 = mu (1 + 3/lambda^6) - k lambda^2 of a neo-Hookean disc [Pa]. */
static double disc_firmness(const dea_scene *scene, double stretch)
{
    const double field = scene->drive.voltage / scene->actuator.film_thickness;
    const double k = DEA_EPSILON_0 * scene->material.permittivity * field * field;
    return 2.0 * scene->material.constants[0] * (1.0 + 3.0 * pow(stretch, -6.0)) - k * stretch * stretch;
}

/* A wide disc rests, slack, long after its radial stiffness has gone: what moves about that rest runs away. */
static void a_disc_without_radial_stiffness_does_not_answer(void **state)
{
    (void)state;
    bool seen[2] = {false, false};
    dea_scene scene = moving_scene(DEA_DOT, 1.55, 0.97, 0.0);
    scene.material.constants[1] = scene.material.constants[2] = 0.0;
    for (int i = 1; i <= 12; i++) {
        scene.drive.voltage = 1000.0 * i;
        const dea_row still = solve_direct(&scene, "field");
        if (still.state != DEA_STATE_PULL_IN) {
            const bool firm = disc_firmness(&scene, 1.55 * (1.0 + still.strain)) > 0.0;
            const dea_response row = respond(scene, 100.0);
            seen[firm] = true;
            assert_int_equal(row.state, firm ? still.state : DEA_STATE_PULL_IN);
            assert_int_equal(isnan(row.displacement), !firm);
        }
    }
    assert_true(seen[0] && seen[1]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_response_is_that_of_the_reference_table),
        cmocka_unit_test(modes_lie_where_the_response_changes_its_sign),
        cmocka_unit_test(random_films_answer_as_shooting_in_long_double_does),
        cmocka_unit_test(hard_films_answer_as_shooting_in_long_double_does),
        cmocka_unit_test(without_a_bias_the_film_is_its_capacitance),
        cmocka_unit_test(no_equilibrium_under_the_bias_is_pull_in),
        cmocka_unit_test(a_disc_without_radial_stiffness_does_not_answer),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
