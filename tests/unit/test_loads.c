/* What else acts on the edge: forces, dampers, a second film, something that holds it. The judge is the film in long double: the
 * equations of physics.md, sections 3 and 7, with nothing of the library's. */
#include "answers.h"

#include <complex.h>
#include <stdlib.h>

typedef long double real;

/* ---- a film in long double */

typedef struct film {
    bool dot;
    real r, b, h, pre, voltage;
    real c[3];
} film;

static const real eps = 8.8541878128e-12L * 2.8L;
static const real pi = 3.14159265358979323846264338327950288L;

static film paper(bool dot, real voltage)
{
    return (film){dot, 30e-3L, 0.5L, 100e-6L, 1.2L, voltage, {178426.0L, -6023.0L, 4234.0L}};
}

/* Nominal stress P1 and both moduli that a derivative over lambda_1 needs are from w, its slope over I being q. */
static real slope_of_energy(const film *f, real l1, real l2)
{
    const real j = l1 * l1 + l2 * l2 + 1.0L / (l1 * l1 * l2 * l2) - 3.0L;
    return f->c[0] + j * (2.0L * f->c[1] + 3.0L * f->c[2] * j);
}

static real nominal(const film *f, real l1, real l2)
{
    return slope_of_energy(f, l1, l2) * 2.0L * (l1 - 1.0L / (l1 * l1 * l1 * l2 * l2));
}

static real cauchy(const film *f, real l)
{
    return l * nominal(f, l, l);
}

/* W11 and W12 at the pre-stretch. */
static void tangents(const film *f, real *w11, real *w12)
{
    const real l = f->pre, a = 2.0L * (l - powl(l, -5)), j = 2.0L * l * l + powl(l, -4) - 3.0L;
    const real w = slope_of_energy(f, l, l), q = 2.0L * f->c[1] + 6.0L * f->c[2] * j;
    *w11 = w * (2.0L + 6.0L * powl(l, -6)) + q * a * a;
    *w12 = 4.0L * w * powl(l, -6) + q * a * a;
}

/* eps (U/H)^2. */
static real pressure(const film *f)
{
    return eps * f->voltage * f->voltage / (f->h * f->h);
}

static real lumped(const film *f, real u)
{
    real w11, w12;
    tangents(f, &w11, &w12);
    const real ra = f->b * f->r, area = 2.0L * pi * ra * f->h / (f->pre * f->pre);
    const real modulus = f->pre * (w11 + w12) + nominal(f, f->pre, f->pre); /* d(lambda P)/dlambda */
    const real force = pressure(f) * powl(f->pre, 4) * area;
    return (f->dot ? force : -force) - modulus * area * u * (1.0L / ra + 1.0L / (f->r - ra));
}

static real lame(const film *f, real u)
{
    real w11, w12;
    tangents(f, &w11, &w12);
    const real soft = pressure(f) * f->pre * f->pre, b2 = f->b * f->b, q = (1.0L + b2) / (1.0L - b2);
    const real disc = f->dot ? w11 + w12 - 3.0L * soft : w11 + w12;
    const real annulus = f->dot ? w11 * q - w12 : (w11 - soft) * q - (w12 - 2.0L * soft);
    const real force = 2.0L * pi * f->h * soft * f->b * f->r;
    return (f->dot ? force : -force) - 2.0L * pi * f->h * (disc + annulus) * u;
}

static real coverage(const film *f, real u)
{
    const real disc = f->pre * (1.0L + u / (f->b * f->r)), annulus = f->pre * (1.0L - u / (f->r - f->b * f->r));
    const real area = 2.0L * pi * f->b * f->r * f->h / (f->pre * disc), electric = pressure(f) * powl(f->dot ? disc : annulus, 4);
    return area * (cauchy(f, annulus) - cauchy(f, disc) + (f->dot ? electric : -electric));
}

static real ring(const film *f, real u)
{
    const real a = f->b * f->r / f->pre, rim = f->r / f->pre, k = pressure(f);
    const real disc = f->pre + u / a, l1 = f->pre - u / (rim - a), l2 = f->pre + u / (rim + a);
    const real in = nominal(f, disc, disc) - (f->dot ? k * disc * disc * disc : 0.0L);
    const real radial = nominal(f, l1, l2) - (f->dot ? 0.0L : k * l1 * l2 * l2);
    const real hoop = nominal(f, l2, l1) - (f->dot ? 0.0L : k * l2 * l1 * l1);
    return -(2.0L * pi * a * f->h * in + pi * f->h * ((rim - a) * hoop - (rim + a) * radial));
}

/* ds1/dR + (s1 - s2)/R = 0 as slopes of the stretches over x = ln R, dl1/dx = [s2 - s1 - s12 (l1 - l2)]/s11, the moduli by
 * differences. */
static void slopes(const film *f, real k, real l1, real l2, real out[2])
{
    const real h = 1e-7L;
    const real s11 = (nominal(f, l1 + h, l2) - nominal(f, l1 - h, l2)) / (2.0L * h) - k * l2 * l2;
    const real s12 = (nominal(f, l1, l2 + h) - nominal(f, l1, l2 - h)) / (2.0L * h) - 2.0L * k * l1 * l2;
    const real s1 = nominal(f, l1, l2) - k * l1 * l2 * l2, s2 = nominal(f, l2, l1) - k * l2 * l1 * l1;
    out[0] = (s2 - s1 - s12 * (l1 - l2)) / s11;
    out[1] = l1 - l2;
}

/* lambda_2 - lambda_pre at the frame, by the classical Runge-Kutta rule. */
static real miss(const film *f, real k, real l1, real l2)
{
    enum { STEPS = 400 };
    const real h = -logl(f->b) / STEPS;
    for (int i = 0; i < STEPS; i++) {
        real a[2], b[2], c[2], d[2];
        slopes(f, k, l1, l2, a);
        slopes(f, k, l1 + 0.5L * h * a[0], l2 + 0.5L * h * a[1], b);
        slopes(f, k, l1 + 0.5L * h * b[0], l2 + 0.5L * h * b[1], c);
        slopes(f, k, l1 + h * c[0], l2 + h * c[1], d);
        l1 += h / 6.0L * (a[0] + 2.0L * b[0] + 2.0L * c[0] + d[0]);
        l2 += h / 6.0L * (a[1] + 2.0L * b[1] + 2.0L * c[1] + d[1]);
    }
    return l2 - f->pre;
}

/* l - lambda_1 behind an edge that is pulled outward so far that secants leave the film: by halves, from the film that has l there to the
 * one that has lost its radial stretch. */
static real jump_by_halves(const film *f, real k, real l)
{
    real low = 0.0L, high = l;
    for (int i = 0; i < 64; i++) {
        const real d = 0.5L * (low + high);
        *(miss(f, k, l - d, l) > 0.0L ? &low : &high) = d;
    }
    return low;
}

static real field(const film *f, real u)
{
    const real a = f->b * f->r / f->pre, l = f->pre + u / a, k = f->dot ? 0.0L : pressure(f);
    real d0 = 0.0L, d1 = 2.0L * u / (a * (1.0L - f->b * f->b));
    real m0 = miss(f, k, l - d0, l);
    for (int i = 0; i < 40 && d1 != d0; i++) {
        const real m1 = miss(f, k, l - d1, l), next = m1 == m0 ? d1 : d1 - m1 * (d1 - d0) / (m1 - m0);
        d0 = d1;
        m0 = m1;
        d1 = next;
    }
    d1 = u > 0.0L && !(fabsl(m0) < 1e-12L) ? jump_by_halves(f, k, l) : d1;
    const real disc = nominal(f, l, l) - (f->dot ? pressure(f) * l * l * l : 0.0L);
    return 2.0L * pi * f->h * a * (nominal(f, l - d1, l) - k * (l - d1) * l * l - disc);
}

/* What a film exerts on its edge, outward, held at u. */
static const struct {
    const char *name;
    real (*exerted)(const film *f, real u);
} models[] = {{"lumped", lumped}, {"lame", lame}, {"coverage", coverage}, {"ring", ring}, {"field", field}};
enum { MODELS = sizeof models / sizeof *models, FIELD = MODELS - 1 };

/* Where all that acts on the edge is in balance. */
static real rest_of(size_t model, const film *first, const film *second, real stiffness, real force)
{
    real low = -3e-3L, high = 3e-3L;
    for (int i = 0; i < (model == FIELD ? 46 : 70); i++) {
        const real u = 0.5L * (low + high);
        const real net = models[model].exerted(first, u) + (second ? models[model].exerted(second, u) : 0.0L) - stiffness * u + force;
        *(net > 0.0L ? &low : &high) = u;
    }
    return 0.5L * (low + high);
}

/* ---- the library */

#define FILM(kind) \
    "actuator: {kind: " kind ", frame_radius: 30 mm, coverage: 0.5, film_thickness: 100 um, prestretch: 1.2}\n" \
    "material: {yeoh: {C1: 178426 Pa, C2: -6023 Pa, C3: 4234 Pa}, permittivity: 2.8, density: 1080 kg/m^3"

static const dea_row *rows_of(const answer *a)
{
    return (const dea_row *)a->bytes;
}

static const dea_summary *summary_of(answer *a)
{
    return (const dea_summary *)(void *)(a->bytes + a->rows * sizeof(dea_sample));
}

/* ---- statics */

static void a_held_edge_feels_what_film_and_voltage_exert(void **state)
{
    (void)state;
    enum { PLACES = 4 };
    for (size_t m = 0; m < MODELS; m++) {
        for (int lens = 0; lens < 2; lens++) {
            const char *text = lens ? FILM("lens") "}\ndrive: {voltage: 4 kV}\nstudy: {force: {displacement: {from: -0.6 mm, to: 0.6 mm, points: 4}}}\n"
                                    : FILM("dot") "}\ndrive: {voltage: 4 kV}\nstudy: {force: {displacement: {from: -0.6 mm, to: 0.6 mm, points: 4}}}\n";
            const film f = paper(!lens, 4000.0L);
            real wanted[PLACES], largest = 0.0L;
            for (int i = 0; i < PLACES; i++) {
                wanted[i] = models[m].exerted(&f, -0.6e-3L + 0.4e-3L * (real)i);
                largest = fmaxl(largest, fabsl(wanted[i]));
            }
            size_t engines_that_do = 0;
            for (size_t e = 0; e < ENGINES; e++) {
                if (run(text, models[m].name, engines[e], &one)) {
                    engines_that_do++;
                    for (int i = 0; i < PLACES; i++) {
                        assert_near(rows_of(&one)[i].force, (double)wanted[i], 1e-9 * (double)largest);
                    }
                }
            }
            assert_int_equal(engines_that_do, 2);
        }
    }
}

/* Films far from Lame's, from whose answer the searches of both engines begin: a soft lens under a voltage that wrinkles its annulus, at
 * whose last place alike stretches on both sides of the edge, the other place of a secant, would have lost their stiffness; and a dot
 * pulled to twice its radius, in which a search that goes far away ends in a root of rounding. */
static void soft_films_are_held_far_from_rest(void **state)
{
    (void)state;
    enum { PLACES = 4 };
    static const struct {
        film film;
        real from, step;
        const char *text;
    } held[] = {
        {{false, 4e-3L, 0.25L, 300e-6L, 1.25L, 3000.0L, {1500.0L, 0.0L, 0.0L}}, -0.2e-3L, 0.1e-3L,
         "actuator: {kind: lens, frame_radius: 4 mm, coverage: 0.25, film_thickness: 300 um, prestretch: 1.25}\n"
         "material: {yeoh: {C1: 1500 Pa, C2: 0 Pa, C3: 0 Pa}, permittivity: 2.8}\ndrive: {voltage: 3 kV}\n"
         "study: {force: {displacement: {from: -0.2 mm, to: 0.1 mm, points: 4}}}\n"},
        {{true, 3.27e-3L, 0.314L, 200e-6L, 3.5L, 26000.0L, {42000.0L, -2100.0L, 350.0L}}, 0.9e-3L, 0.1e-3L,
         "actuator: {kind: dot, frame_radius: 3.27 mm, coverage: 0.314, film_thickness: 200 um, prestretch: 3.5}\n"
         "material: {yeoh: {C1: 42 kPa, C2: -2100 Pa, C3: 350 Pa}, permittivity: 2.8}\ndrive: {voltage: 26 kV}\n"
         "study: {force: {displacement: {from: 0.9 mm, to: 1.2 mm, points: 4}}}\n"},
    };
    for (size_t k = 0; k < sizeof held / sizeof *held; k++) {
        size_t engines_that_do = 0;
        for (size_t e = 0; e < ENGINES; e++) {
            if (run(held[k].text, "field", engines[e], &one)) {
                engines_that_do++;
                for (int i = 0; i < PLACES; i++) {
                    const double wanted = (double)field(&held[k].film, held[k].from + held[k].step * (real)i);
                    assert_near(rows_of(&one)[i].force, wanted, 1e-8 * fabs((double)field(&held[k].film, held[k].from)));
                }
            }
        }
        assert_int_equal(engines_that_do, 2);
    }
}

/* At displacement 0 a film pushes with the force of its voltage alone; where it rests it pushes with none. */
static void the_curve_of_forces_ends_where_the_free_film_rests(void **state)
{
    (void)state;
    for (size_t m = 0; m < MODELS; m++) {
        char text[1024];
        run(FILM("dot") "}\ndrive: {voltage: 4 kV}\nstudy: {sweep: {}}\n", models[m].name, "direct", &one);
        const double free_one = rows_of(&one)->displacement, push = rows_of(&one)->force;
        snprintf(text, sizeof text, FILM("dot") "}\ndrive: {voltage: 4 kV}\nstudy: {force: {displacement: {from: 0 m, to: %.17g m, points: 2}}}\n",
                 free_one);
        run(text, models[m].name, "direct", &one);
        assert_near(rows_of(&one)[1].force, 0.0, 1e-9 * push);
        assert_true(rows_of(&one)[0].force > 0.5 * push);
    }
}

static void a_film_under_a_force_rests_where_forces_balance(void **state)
{
    (void)state;
    static const double forces[] = {-0.3, 0.05, 1.0};
    for (size_t m = 0; m < MODELS; m++) {
        for (int lens = 0; lens < 2; lens++) {
            const char *text = lens ? FILM("lens") "}\ndrive: {voltage: 4 kV}\nload: {stiffness: 200 N/m}\n"
                                      "study: {sweep: {load.force: [-300 mN, 50 mN, 1 N]}}\naccuracy: 1e-9\n"
                                    : FILM("dot") "}\ndrive: {voltage: 4 kV}\nload: {stiffness: 200 N/m}\n"
                                      "study: {sweep: {load.force: [-300 mN, 50 mN, 1 N]}}\naccuracy: 1e-9\n";
            const film f = paper(!lens, 4000.0L);
            real wanted[3];
            for (int i = 0; i < 3; i++) {
                wanted[i] = rest_of(m, &f, NULL, 200.0L, forces[i]);
            }
            for (size_t e = 0; e < ENGINES; e++) {
                if ((m == FIELD && e == 1 && lens) || !run(text, models[m].name, engines[e], &one)) {
                    continue; /* the dot is enough of what takes IDA seconds */
                }
                for (int i = 0; i < 3; i++) {
                    assert_relative(rows_of(&one)[i].displacement, (double)wanted[i], e == 2 ? 1e-8 : 1e-9);
                }
            }
        }
    }
}

static void antagonists_rest_where_their_forces_balance(void **state)
{
    (void)state;
    const char *text = FILM("dot") "}\ndrive: {voltage: 4 kV}\nload: {force: 20 mN}\n"
                       "antagonist: {actuator: {kind: lens, film_thickness: 120 um, prestretch: 1.3},\n"
                       "  material: {yeoh: {C1: 150 kPa, C2: -5 kPa, C3: 4 kPa}, permittivity: 2.8}, drive: {voltage: 5 kV}}\nstudy: {sweep: {drive.voltage: [0 V, 4 kV]}}\n";
    const film lens = {false, 30e-3L, 0.5L, 120e-6L, 1.3L, 5000.0L, {150e3L, -5e3L, 4e3L}};
    for (size_t m = 0; m < MODELS; m++) {
        real wanted[2];
        for (int i = 0; i < 2; i++) {
            const film dot = paper(true, i ? 4000.0L : 0.0L);
            wanted[i] = rest_of(m, &dot, &lens, 0.0L, 20e-3L);
        }
        assert_true(wanted[0] < 0.0L && wanted[1] > wanted[0]); /* the lens pulls inward, the dot outward */
        for (size_t e = 0; e < ENGINES; e++) {
            const bool done = run(text, models[m].name, engines[e], &one);
            for (int i = 0; i < 2 && done; i++) {
                assert_relative(rows_of(&one)[i].displacement, (double)wanted[i], e == 2 ? 1e-8 : 1e-9);
            }
        }
    }
}

/* A dot and a lens alike but for their kind, under voltages that differ little: what is left is small beside what each does. */
static void films_that_all_but_cancel_keep_their_balance(void **state)
{
    (void)state;
    const char *text = FILM("dot") "}\ndrive: {voltage: 2.99 kV}\nantagonist: {actuator: {kind: lens}, drive: {voltage: 3 kV}}\nstudy: {sweep: {}}\n";
    const film dot = paper(true, 2990.0L), still = paper(true, 0.0L), lens = paper(false, 3000.0L);
    for (size_t m = 0; m < MODELS; m++) {
        const double wanted = (double)rest_of(m, &dot, &lens, 0.0L, 0.0L), pulled = (double)rest_of(m, &still, &lens, 0.0L, 0.0L);
        assert_true(fabs(wanted) < 0.02 * fabs(pulled));
        for (size_t e = 0; e < ENGINES; e++) {
            if (run(text, models[m].name, engines[e], &one)) {
                assert_near(rows_of(&one)->displacement, wanted, 1e-9 * fabs(pulled));
            }
        }
    }
}

/* Two films of one kind under one voltage, each half as thick: the edge stays where the whole film has it. */
static void two_films_abreast_move_as_one_that_is_twice_as_thick(void **state)
{
    (void)state;
    run(FILM("dot") "}\ndrive: {voltage: 3 kV}\nantagonist: {actuator: {kind: dot}, drive: {voltage: 3 kV}}\nstudy: {sweep: {}}\n", "coverage",
        "direct", &one);
    run(FILM("dot") "}\ndrive: {voltage: 3 kV}\nstudy: {sweep: {}}\n", "coverage", "direct", &other);
    assert_relative(rows_of(&one)->displacement, rows_of(&other)->displacement, 1e-12);
    assert_relative(rows_of(&one)->charge, rows_of(&other)->charge, 1e-12);
    assert_relative(rows_of(&one)->second_field, rows_of(&other)->field, 1e-12);
}

/* A second film past its own pull-in leaves no rest, whatever the voltage of the first; one past its breakdown tells so. */
static void limits_of_the_second_film_are_told(void **state)
{
    (void)state;
    const char *folds = FILM("dot") "}\ndrive: {voltage: 1 kV}\nantagonist: {actuator: {kind: dot}, drive: {voltage: 20 kV}}\nstudy: {sweep: {}}\n";
    const char *breaks = FILM("dot") "}\ndrive: {voltage: 1 kV}\nantagonist: {actuator: {kind: lens}, drive: {voltage: 3 kV},\n"
                         "  material: {neo_hookean: {mu: 350 kPa}, permittivity: 2.8, breakdown: 30 V/um}}\nstudy: {sweep: {}}\n";
    const char *slack = FILM("dot") "}\ndrive: {voltage: 1 kV}\nload: {force: -12 N}\nstudy: {sweep: {}}\n";
    for (size_t m = 0; m < MODELS; m++) {
        for (size_t e = 0; e < ENGINES; e++) {
            if (strcmp(models[m].name, "lame") == 0 && run(folds, models[m].name, engines[e], &one)) {
                assert_int_equal(rows_of(&one)->state, DEA_STATE_PULL_IN);
                assert_true(isnan(rows_of(&one)->displacement));
            }
            if (run(breaks, models[m].name, engines[e], &one)) {
                assert_int_equal(rows_of(&one)->state, DEA_STATE_BREAKDOWN);
            }
            if (run(slack, models[m].name, engines[e], &one)) {
                assert_int_equal(rows_of(&one)->state, DEA_STATE_SLACK);
            }
        }
    }
}

/* ---- time and frequency */

static void a_film_rests_under_its_load_until_the_voltage_comes(void **state)
{
    (void)state;
    const char *text = FILM("dot") ", retardation: 20 us, prony: [{g: 0.2, tau: 1 ms}]}\ndrive: {waveform: {points: [[0 s, 0 V], [2 ms, 0 V], [2.1 ms, 3 kV]]}}\n"
                       "load: {force: -100 mN, damping: 0.01 N s/m}\naccuracy: 1e-5\nstudy: {transient: {until: 4 ms, every: 0.5 ms}}\n";
    for (size_t m = 0; m < MODELS; m++) {
        const film f = paper(true, 0.0L);
        const double rest = (double)rest_of(m, &f, NULL, 0.0L, -0.1L);
        for (size_t e = 1; e < ENGINES; e++) {
            if ((m == FIELD && e == 2) || !run(text, models[m].name, engines[e], &one)) {
                continue; /* the membrane in ngspice takes longer than a test may */
            }
            const dea_sample *rows = (const dea_sample *)one.bytes;
            for (int i = 0; i < 4; i++) {
                assert_relative(rows[i].displacement, rest, 1e-5);
            }
            assert_true(rows[8].displacement > rest + 1e-4);
        }
    }
}

/* m u'' + r u' + K u = F_DEA + F from F/K on: a swing about the new rest. */
static void a_linear_film_swings_as_mass_spring_and_damper(void **state)
{
    (void)state;
    const char *text = FILM("dot") "}\ndrive: {waveform: {step: {on: 0 s, voltage: 3 kV, rise: 0 s}}}\nload: {mass: 1 g, damping: 0.3 N s/m%s}\n"
                       "accuracy: 1e-6\nstudy: {transient: {until: 20 ms, every: 1 ms}}\n";
    const film f = paper(true, 3000.0L);
    const real push = lumped(&f, 0.0L), stiffness = (push - lumped(&f, 1e-4L)) / 1e-4L;
    for (int pulled = 0; pulled < 2; pulled++) {
        char whole[1024];
        snprintf(whole, sizeof whole, text, pulled ? ", force: 50 mN" : "");
        const real begin = pulled ? 0.05L / stiffness : 0.0L, jump = push / stiffness;
        for (size_t e = 0; e < ENGINES; e++) {
            if (!run(whole, "lumped", engines[e], &one)) {
                assert_true(pulled && e == 0); /* no closed form of a film that is pulled */
                continue;
            }
            dea_scene scene;
            dea_point point;
            assert_int_equal(dea_scene_parse(whole, strlen(whole), "t", ".", NULL, 0, "lumped", &scene, NULL), DEA_OK);
            dea_film_prepare(&scene, &point.film);
            dea_point_place(&scene, &point);
            const real mass = dea_point_mass(&scene, &point), decay = 0.15L / mass, omega = sqrtl(stiffness / mass - decay * decay);
            dea_scene_free(&scene);
            const dea_sample *rows = (const dea_sample *)one.bytes;
            for (size_t i = 1; i < one.rows; i++) {
                const real t = 1e-3L * (real)i, fade = expl(-decay * t);
                const real u = begin + jump * (1.0L - fade * (cosl(omega * t) + decay / omega * sinl(omega * t)));
                assert_near(rows[i].displacement, (double)u, 2e-6 * (double)(begin + 2.0L * jump));
            }
        }
    }
}

#define LIGHT \
    "actuator: {kind: dot, frame_radius: 30 mm, coverage: 0.5, film_thickness: 100 um, prestretch: 1.2}\n" \
    "antagonist: {actuator: {kind: lens}, drive: {voltage: 0 V}}\n" \
    "material: {yeoh: {C1: 178426 Pa, C2: -6023 Pa, C3: 4234 Pa}, permittivity: 2.8, prony: [{g: 0.2, tau: 1 s}]"

/* Two linear films without mass that relax alike, c = g/(1 - g): K u + c K (u - z) = F, z' = (u - z)/tau. Behind a step
 * u = F/K (1 - c/(1 + c) exp(-t/(tau (1 + c)))), shaken u = F/(K (1 + c i w tau/(1 + i w tau) + i w tau_KV)). */
static void films_of_one_material_relax_together(void **state)
{
    (void)state;
    const film f = paper(true, 3000.0L);
    const real push = lumped(&f, 0.0L), stiffness = 2.0L * (push - lumped(&f, 1e-4L)) / 1e-4L, c = 0.25L;
    for (size_t e = 1; e < ENGINES; e++) {
        run(LIGHT "}\ndrive: {waveform: {step: {on: 0 s, voltage: 3 kV, rise: 0 s}}}\naccuracy: 1e-6\nstudy: {transient: {until: 3 s, every: 0.25 s}}\n",
            "lumped", engines[e], &one);
        for (size_t i = 1; i < one.rows; i++) {
            const real u = push / stiffness * (1.0L - c / (1.0L + c) * expl(-0.25L * (real)i / (1.0L + c)));
            assert_relative(((const dea_sample *)one.bytes)[i].displacement, (double)u, 3e-6);
        }
    }
    for (size_t e = 0; e < ENGINES; e += 2) {
        run(LIGHT ", retardation: 100 ms}\nstudy: {ac: {from: 0.1 Hz, to: 10 Hz, points_per_decade: 2, bias: 3 kV}}\n", "lumped", engines[e], &one);
        for (size_t i = 0; i < one.rows; i++) {
            const dea_response *row = &((const dea_response *)one.bytes)[i];
            const real w = 2.0L * pi * row->frequency;
            const real lost = c * w / (1.0L + w * w) + 0.1L * w, kept = 1.0L + c * w * w / (1.0L + w * w);
            assert_relative(row->displacement, (double)(2.0L * push / 3000.0L / stiffness / hypotl(kept, lost)), 1e-6);
            assert_near(row->displacement_phase, (double)(-atan2l(lost, kept) * 180.0L / pi), 1e-4);
        }
    }
}

static void keep_energy_of_two_films(const char *material)
{
    char text[1024];
    snprintf(text, sizeof text, FILM("dot") ", prony: [{g: 0.2, tau: 1 ms}]}\ndrive: {waveform: {step: {on: 0.2 ms, off: 2 ms, voltage: 4 kV, rise: 0.1 ms}}, series_resistance: 1 MOhm}\n"
                       "load: {force: -100 mN, damping: 0.01 N s/m, mass: 50 mg, stiffness: 100 N/m}\naccuracy: 1e-5\n"
                       "antagonist: {actuator: {kind: lens}%s, drive: {voltage: 2 kV}}\n"
                       "study: {transient: {until: 4 ms, every: 0.1 ms}}\n", material);
    for (size_t m = 0; m < FIELD; m++) {
        run(text, models[m].name, "ida", &one);
        assert_true(summary_of(&one)->residual <= 1e-4);
        run(text, models[m].name, "ngspice", &other);
        assert_true(summary_of(&other)->residual <= 1e-4);
        const dea_sample *rows = (const dea_sample *)one.bytes, *wanted = (const dea_sample *)other.bytes;
        for (size_t i = 0; i < one.rows; i++) {
            assert_near(rows[i].displacement, wanted[i].displacement, 3e-5 * 3e-4);
        }
    }
}

static void energy_is_kept_with_loads_and_two_films(void **state)
{
    (void)state;
    keep_energy_of_two_films(", material: {neo_hookean: {mu: 350 kPa}, permittivity: 2.8, density: 1080 kg/m^3}");
    keep_energy_of_two_films("");
}

#define PAIR                                                                                                             \
    FILM("dot") ", retardation: 50 us}\nmodel: field\naccuracy: 1e-7\n"                                                \
                "antagonist: {actuator: {kind: lens, film_thickness: 80 um, prestretch: 1.3}, drive: {voltage: 3 kV}, "   \
                "material: {neo_hookean: {mu: 350 kPa}, permittivity: 2.8, density: 1000 kg/m^3, retardation: 40 us}}\n"

/* Slowly by the slope of its rests; fast by a small sine of the film that moves in time, which knows forces alone, no stiffness. */
static void two_membranes_are_shaken_as_they_rest_and_move(void **state)
{
    (void)state;
    static answer wave;
    enum { EVERY = 40, PERIODS = 10 };
    double complex moved = 0.0;
    assert_true(run(PAIR "study: {ac: {from: 0.05 Hz, to: 500 Hz, points_per_decade: 1, bias: 3 kV}}\n", "field", "direct", &one));
    assert_true(run(PAIR "study: {sweep: {drive.voltage: [2999 V, 3001 V]}}\n", "field", "direct", &other));
    const dea_response *shaken = (const dea_response *)one.bytes;
    const dea_row *still = rows_of(&other);
    assert_relative(shaken[0].displacement, 0.5 * (still[1].displacement - still[0].displacement), 1e-6);
    assert_relative(1.0 / (0.1 * DEA_PI * shaken[0].impedance), 0.5 * (still[1].charge - still[0].charge), 1e-6);
    assert_true(run(PAIR "drive: {waveform: {sine: {amplitude: 3 V, offset: 3 kV, frequency: 500 Hz}}}\n"
                         "study: {transient: {until: 60 ms, every: 0.05 ms, start: bias}}\n", "field", "ida", &wave));
    const dea_sample *samples = (const dea_sample *)wave.bytes;
    for (size_t i = wave.rows - 1 - EVERY * PERIODS; i + 1 < wave.rows; i++) {
        moved += samples[i].displacement * 2.0 / (EVERY * PERIODS) * cexp(-I * 1000.0 * DEA_PI * samples[i].time);
    }
    dea_scene scene;
    read_scene(PAIR "study: {ac: {from: 1 Hz, to: 500 Hz, bias: 3 kV}}\n", "field", &scene);
    assert_non_null(dea_engine_refuses(dea_engine_find("ngspice"), &scene, scene.models[0])); /* its rings are those of one film */
    dea_scene_free(&scene);
    const double complex per_volt = shaken[4].displacement * cexp(I * DEA_PI / 180.0 * shaken[4].displacement_phase);
    assert_near(cabs(moved / (-3.0 * I) - per_volt), 0.0, 2e-4 * cabs(per_volt));
}

/* Those in which both move alike are modes of one film, of the double mass; between them lie those that leave the edge at rest. */
static void two_like_membranes_have_the_modes_of_one(void **state)
{
    (void)state;
    const char *alone = FILM("dot") ", retardation: 50 us}\nstudy: {modes: {count: 2, bias: 2 kV}}\n";
    const char *both = FILM("dot") ", retardation: 50 us}\nantagonist: {actuator: {kind: dot}, drive: {voltage: 2 kV}}\n"
                       "study: {modes: {count: 3, bias: 2 kV}}\n";
    assert_true(run(alone, "field", "direct", &one));
    assert_true(run(both, "field", "direct", &other));
    const dea_mode *single = (const dea_mode *)one.bytes, *pair = (const dea_mode *)other.bytes;
    assert_true(pair[1].frequency > single[0].frequency && pair[1].frequency < single[1].frequency && pair[1].edge_share < 1e-20);
    for (size_t k = 0; k < 2; k++) {
        assert_relative(pair[2 * k].frequency, single[k].frequency, 1e-6);
        assert_relative(pair[2 * k].damping_ratio, single[k].damping_ratio, 1e-5);
        assert_relative(pair[2 * k].edge_share, single[k].edge_share, 1e-5);
        assert_relative(pair[2 * k].edge_mass, 2.0 * single[k].edge_mass, 1e-5);
    }
}

static void a_membrane_under_a_load_keeps_its_energy(void **state)
{
    (void)state;
    const char *text = FILM("dot") ", retardation: 20 us}\ndrive: {waveform: {step: {on: 0.2 ms, voltage: 3 kV, rise: 0.1 ms}}}\n"
                       "load: {force: -50 mN, damping: 0.02 N s/m, mass: 200 mg}\naccuracy: 1e-5\nstudy: {transient: {until: 3 ms, every: 0.1 ms}}\n";
    assert_true(run(text, "field", "ida", &one));
    assert_true(summary_of(&one)->residual <= 1e-4);
    assert_true(summary_of(&one)->dissipated > 0.0);
}

/* A film without mass under a damper: u = 2 phi U/(K + i w r), phi = F_DEA/U^2. */
static void a_damper_lags_a_shaken_film(void **state)
{
    (void)state;
    const char *text = FILM("dot") "}\nload: {damping: 5 N s/m, mass: 1 ug}\nstudy: {ac: {from: 10 Hz, to: 20 Hz, points_per_decade: 1, bias: 3 kV}}\n";
    const film f = paper(true, 3000.0L);
    const real push = lumped(&f, 0.0L), stiffness = (push - lumped(&f, 1e-4L)) / 1e-4L, lag = 2.0L * pi * 10.0L * 5.0L;
    for (size_t e = 0; e < ENGINES; e += 2) {
        assert_true(run(text, "lumped", engines[e], &one));
        const dea_response *row = (const dea_response *)one.bytes;
        assert_relative(row->displacement, (double)(2.0L * push / 3000.0L / sqrtl(stiffness * stiffness + lag * lag)), 1e-3); /* but for the film's mass */
        assert_near(row->displacement_phase, (double)(-atan2l(lag, stiffness) * 180.0L / pi), 0.05);
    }
}

/* Slowly shaken, a film under a force moves as its statics say. */
static void a_slowly_shaken_film_follows_its_statics_under_a_force(void **state)
{
    (void)state;
    for (size_t m = 0; m < MODELS; m++) {
        run(FILM("dot") "}\ndrive: {voltage: 3 kV}\nload: {force: 400 mN}\nstudy: {sweep: {voltage: [2999.9 V, 3000.1 V]}}\n", models[m].name,
            "direct", &other);
        const double slope = (rows_of(&other)[1].displacement - rows_of(&other)[0].displacement) / 0.2;
        for (size_t e = 0; e < ENGINES; e += 2) {
            assert_true(run(FILM("dot") "}\nload: {force: 400 mN}\nstudy: {ac: {from: 0.01 Hz, to: 0.01 Hz, bias: 3 kV}}\n", models[m].name,
                            engines[e], &one));
            assert_relative(((const dea_response *)one.bytes)->displacement, slope, 1e-6);
        }
    }
}

/* A damper that all but takes a mode's swing: zeta = r/(2 sqrt(K m)) of the one node; the membrane's first mode, which moves almost
 * so under a heavy load, has it too. */
static void a_damper_on_a_heavy_edge_damps_its_mode(void **state)
{
    (void)state;
    const char *text = FILM("dot") "}\nload: {mass: 20 g, damping: 0.5 N s/m}\nstudy: {modes: {count: 1}}\n";
    run(text, "ring", "direct", &one);
    run(text, "field", "direct", &other);
    const dea_mode *ring_mode = (const dea_mode *)one.bytes, *mode = (const dea_mode *)other.bytes;
    const double ratio = 0.5 / (2.0 * 2.0 * DEA_PI * ring_mode->undamped * ring_mode->edge_mass);
    assert_relative(ring_mode->damping_ratio, ratio, 1e-9);
    assert_relative(mode->damping_ratio, ratio, 1e-3);
}

/* A film whose load leaves it no rest has no motion either. */
static void a_run_without_a_rest_says_so(void **state)
{
    (void)state;
    const char *text = FILM("dot") "}\ndrive: {waveform: {step: {on: 0 s, voltage: 1 kV}}}\nantagonist: {actuator: {kind: dot}, drive: {voltage: 20 kV}}\n"
                       "study: {transient: {until: 1 ms, every: 0.1 ms}}\n";
    for (size_t e = 1; e < ENGINES; e++) {
        run(text, "lame", engines[e], &one);
        for (size_t i = 0; i < one.rows; i++) {
            assert_int_equal(((const dea_sample *)one.bytes)[i].state, DEA_STATE_PULL_IN);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_held_edge_feels_what_film_and_voltage_exert),
        cmocka_unit_test(soft_films_are_held_far_from_rest),
        cmocka_unit_test(the_curve_of_forces_ends_where_the_free_film_rests),
        cmocka_unit_test(a_film_under_a_force_rests_where_forces_balance),
        cmocka_unit_test(antagonists_rest_where_their_forces_balance),
        cmocka_unit_test(films_that_all_but_cancel_keep_their_balance),
        cmocka_unit_test(two_films_abreast_move_as_one_that_is_twice_as_thick),
        cmocka_unit_test(limits_of_the_second_film_are_told),
        cmocka_unit_test(a_film_rests_under_its_load_until_the_voltage_comes),
        cmocka_unit_test(a_linear_film_swings_as_mass_spring_and_damper),
        cmocka_unit_test(films_of_one_material_relax_together),
        cmocka_unit_test(energy_is_kept_with_loads_and_two_films),
        cmocka_unit_test(two_membranes_are_shaken_as_they_rest_and_move),
        cmocka_unit_test(two_like_membranes_have_the_modes_of_one),
        cmocka_unit_test(a_membrane_under_a_load_keeps_its_energy),
        cmocka_unit_test(a_damper_lags_a_shaken_film),
        cmocka_unit_test(a_slowly_shaken_film_follows_its_statics_under_a_force),
        cmocka_unit_test(a_damper_on_a_heavy_edge_damps_its_mode),
        cmocka_unit_test(a_run_without_a_rest_says_so),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
