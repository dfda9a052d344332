/* Two moving membranes on one edge. The judge is two films of finite elements, each with its own mass matrix, that hold each other at
 * the edge by the one force that lets both accelerate alike. */
#include "moving_membrane.h"

enum { MOST_ROWS = 64, STATE = sizeof(fe_state) / sizeof(double) };

typedef struct pair {
    fe_film films[2];
    double potential[FE_PLACES]; /* of the second film, which stays */
} pair;

static void pair_rates(const pair *p, double time, const fe_state *s, fe_state *d)
{
    const size_t edge = fe_edge(&p->films[0]);
    double between = 0.0, give = 0.0;
    for (int k = 0; k < 2; k++) {
        fe_rates(&p->films[k], time, &s[k], &d[k]);
        between += k == 0 ? -d[k].v[edge] : d[k].v[edge];
        give += p->films[k].inverse[edge][edge];
    }
    for (size_t i = 0; i < FE_NODES; i++) {
        d[0].v[i] += p->films[0].inverse[i][edge] * between / give;
        d[1].v[i] -= p->films[1].inverse[i][edge] * between / give;
    }
}

/* One step of the classical method. */
static void pair_step(const pair *p, double time, double h, fe_state *s)
{
    static const double at[] = {0.0, 0.5, 0.5, 1.0}, share[] = {1.0 / 6.0, 1.0 / 3.0, 1.0 / 3.0, 1.0 / 6.0};
    static fe_state here[2], rate[2], sum[2];
    double *const y = (double *)s, *const x = (double *)here, *const k = (double *)rate, *const total = (double *)sum;
    memset(rate, 0, sizeof rate);
    memset(sum, 0, sizeof sum);
    for (int i = 0; i < 4; i++) {
        for (size_t j = 0; j < 2 * STATE; j++) {
            x[j] = y[j] + h * at[i] * k[j];
        }
        pair_rates(p, time + h * at[i], here, rate);
        for (size_t j = 0; j < 2 * STATE; j++) {
            total[j] += share[i] * k[j];
        }
    }
    for (size_t j = 0; j < 2 * STATE; j++) {
        y[j] += h * total[j];
    }
}

static void pair_open(const dea_scene *scene, pair *p)
{
    const dea_antagonist *own = &scene->antagonist;
    dea_scene second = *scene;
    second.actuator.kind = own->kind;
    second.actuator.electrode_mass = second.drive.series_resistance = second.drive.leakage_resistance = (double)NAN;
    second.actuator.film_thickness = own->film_thickness;
    second.actuator.prestretch = own->prestretch;
    second.material = own->material;
    fe_open(scene, &p->films[0]);
    fe_open(&second, &p->films[1]);
    for (size_t i = 0; i < FE_PLACES; i++) {
        p->potential[i] = own->voltage;
    }
    p->films[1].potential = p->potential;
}

/* The films where they rest under the voltage of the second: all that moves is slowed down until nothing does, and branches are relaxed
 * there. */
static void pair_rest(pair *p, double h, fe_state *s)
{
    const size_t branches = p->films[0].branches;
    p->films[0].branches = 0;
    fe_rest(&p->films[0], &s[0]);
    fe_rest(&p->films[1], &s[1]);
    for (double time = 0.0; time < 6e-3; time += h) {
        pair_step(p, 0.0, h, s);
        for (size_t n = 0; n < FE_NODES; n++) {
            s[0].v[n] *= 1.0 - 8000.0 * h;
            s[1].v[n] *= 1.0 - 8000.0 * h;
        }
        s[0].q = 0.0;
    }
    p->films[0].branches = branches;
    for (size_t q = 0; q < FE_PLACES; q++) {
        double l[2], stress[2];
        fe_stretches(&p->films[0], q, s[0].u, p->films[0].prestretch, l);
        fe_cauchy(&p->films[0], l, stress);
        for (size_t i = 0; i < FE_BRANCHES; i++) {
            s[0].z[q][0][i] = stress[0];
            s[0].z[q][1][i] = stress[1];
        }
    }
    for (int k = 0; k < 2; k++) {
        memset(s[k].v, 0, sizeof s[k].v);
    }
}

/* Largest differences over what the columns promise. */
static double pair_broken(const dea_scene *scene, const dea_sample *samples, size_t rows)
{
    static pair p;
    static fe_state s[2];
    const dea_scales scales = dea_scales_open(scene, dea_model_find("field"));
    const dea_sample size = dea_scales_of(&scales, samples, rows);
    const int steps = 2 * fe_judge_steps(scene); /* the second film is stiffer */
    const double h = scene->transient.every / steps;
    double worst = 0.0;
    pair_open(scene, &p);
    pair_rest(&p, h, s);
    const size_t edge = fe_edge(&p.films[0]);
    for (size_t i = 0; i < rows; i++) {
        const double voltage = fe_voltage(&p.films[0], samples[i].time, &s[0]);
        worst = fmax(worst, fabs(samples[i].displacement - s[0].u[edge]) / size.displacement);
        worst = fmax(worst, 0.1 * fabs(samples[i].velocity - s[0].v[edge]) / size.velocity);
        worst = fmax(worst, 0.1 * fabs(samples[i].film_voltage - voltage) / size.film_voltage);
        if (!isnan(samples[i].charge)) {
            worst = fmax(worst, 0.1 * fabs(samples[i].charge - fe_capacitance(&p.films[0], s[0].u) * voltage) / size.charge);
        }
        for (int k = 0; k < steps; k++) {
            pair_step(&p, samples[i].time + k * h, h, s); /* the rise ends at a sample */
        }
    }
    return worst / scene->accuracy;
}

static dea_scene pair_scene(dea_kind first, dea_kind second)
{
    dea_scene scene = fe_step_scene(first, 1.2, 0.5, 4000.0, 2e-4);
    scene.material.retardation = 5e-5;
    scene.transient = (dea_transient){.until = 1.5e-3, .every = 5e-5};
    scene.accuracy = 1e-5;
    scene.models[0] = dea_model_find("field");
    scene.antagonist = (dea_antagonist){.there = true,
                                        .kind = second,
                                        .own_material = true,
                                        .material = scene.material,
                                        .frame_radius = (double)NAN,
                                        .coverage = (double)NAN,
                                        .film_thickness = 8e-5,
                                        .layers = 1.0,
                                        .prestretch = 1.25,
                                        .voltage = 2500.0};
    scene.antagonist.material.constants[0] *= 0.8;
    scene.antagonist.material.density = 1000.0;
    scene.antagonist.material.retardation = 4e-5;
    return scene;
}

static void two_membranes_move_as_the_judge_has_them(void **state)
{
    (void)state;
    for (int rich = 0; rich < 2; rich++) {
        dea_scene scene = pair_scene(rich ? DEA_LENS : DEA_DOT, DEA_LENS);
        dea_layout layout;
        if (rich) {
            scene.material.prony_count = 1;
            scene.material.prony[0] = (dea_prony){0.15, 5e-4};
            scene.drive.series_resistance = 5e5;
            scene.drive.leakage_resistance = 1e9;
        }
        dea_sample *samples = fly(&scene, &layout);
        assert_true(fabs(samples[0].displacement) > 1e-5); /* the second film has moved the edge before */
        assert_true(pair_broken(&scene, samples, layout.rows) <= 1.0);
        assert_true(dea_layout_summary(&layout, samples)->residual <= 10.0 * scene.accuracy);
        free(samples);
    }
}

/* Without mass both films follow the voltage through their equilibria. */
static void two_membranes_without_mass_pass_through_their_equilibria(void **state)
{
    (void)state;
    for (int damped = 0; damped < 2; damped++) {
        dea_scene scene = pair_scene(DEA_DOT, DEA_LENS);
        dea_layout layout;
        scene.material.density = scene.antagonist.material.density = (double)NAN;
        scene.material.retardation = scene.antagonist.material.retardation = damped ? 1e-9 : (double)NAN;
        scene.drive.waveform.step.rise = 1.0;
        scene.transient = (dea_transient){.until = 1.0, .every = 1.0 / 8.0};
        dea_sample *samples = fly(&scene, &layout);
        dea_scene still = scene;
        still.study = DEA_STUDY_SWEEP;
        for (size_t i = 0; i < layout.rows; i++) {
            dea_row row;
            dea_point point;
            still.drive.voltage = samples[i].voltage;
            dea_film_prepare(&still, &point.film);
            dea_point_place(&still, &point);
            dea_model_solve(dea_model_find("field"), &point, 1e-10, &row);
            assert_int_equal(samples[i].state, row.state);
            assert_near(samples[i].displacement, row.displacement, 1e-5 * 1e-4);
        }
        free(samples);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(two_membranes_move_as_the_judge_has_them),
        cmocka_unit_test(two_membranes_without_mass_pass_through_their_equilibria),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
