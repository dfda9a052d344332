/* A material law, a model, a load and a dialect from outside the library's sources: all that each takes is one entry, which every engine and
 * every export then can do. */
#include "scenes.h"

#include <stdlib.h>

#include "material/form.h"
#include "material/invariant.h"
#include "model/models.h"
#include "netlist/export.h"
#include "network/network.h"

enum { MOST = 1 << 16 };

/* ---- a law: Fung and Demiray, W = mu/(2 b) (exp(b (I1 - 3)) - 1) */

enum { MU, STIFFENING };

DEA_INLINE dea_slopes fung_slopes(const double *c, double j)
{
    const double w = 0.5 * c[MU] * exp(c[STIFFENING] * j);
    return (dea_slopes){w, c[STIFFENING] * w, c[STIFFENING] * c[STIFFENING] * w};
}

DEA_INLINE double fung_gain(const double *c, double j, double dj)
{
    return fung_slopes(c, j).w * expm1(c[STIFFENING] * dj);
}

static double fung_energy(const double *c, double l1, double l2)
{
    return 0.5 * c[MU] / c[STIFFENING] * expm1(c[STIFFENING] * dea_invariant(l1, l2));
}

static dea_stress fung_stress(const double *c, double l1, double l2)
{
    return dea_invariant_stress(fung_slopes, c, l1, l2);
}

static double fung_rise(const double *c, double l, double d1, double d2)
{
    return dea_invariant_rise(fung_slopes, fung_gain, c, l, d1, d2);
}

static void fung_prepare(dea_film *film)
{
    film->rest[0] = fung_slopes(film->constants, film->j).w;
}

static void fung_change(const dea_film *film, size_t count, const double *strains, dea_change *changes)
{
    for (size_t i = 0; i < count; i++) {
        changes[i] = dea_invariant_change(fung_slopes, fung_gain, film, strains[i]);
    }
}

static void fung_form(dea_pool *pool, const dea_expr *c, dea_expr l1, dea_expr l2, dea_law_form *form)
{
    const dea_form_invariants at = dea_form_invariants_of(pool, l1, l2);
    const dea_expr growth = dea_expr_of(pool, DEA_EXP, MUL(c[STIFFENING], at.j));
    dea_form_stresses(pool, &at, SCALE(0.5, MUL(c[MU], growth)), NUM(0.0), form);
    form->room = NUM(1.0);
}

static const dea_constant fung_constants[] = {
    {"mu", "Pa", true, 0.0, NAN, "a shear modulus > 0"},
    {"b", "1", false, 0.0, NAN, "a number > 0"},
};

static const dea_law fung = {
    .name = "fung",
    .title = "Fung and Demiray",
    .energy_text = "W = mu/(2 b) (exp(b (I1 - 3)) - 1)",
    .accepted = "a mapping with mu and b",
    .constants = fung_constants,
    .constant_count = 2,
    .entries = 1,
    .energy = fung_energy,
    .stress = fung_stress,
    .rise = fung_rise,
    .prepare = fung_prepare,
    .change = fung_change,
    .form = fung_form,
};

/* ---- a model: a disc under a bias force that a spring of film to the frame gives back half of, u = F n_a/1.5 */

static void half_solve(const dea_point *point, double accuracy, dea_row *row)
{
    (void)accuracy;
    const double pressure = dea_point_stress_per_volt(point) * point->voltage * point->voltage;
    const double strain = pressure / (1.5 * point->film.modulus), stretch = 1.0 + strain;
    dea_row_fill(row, point,
                 (dea_found){.strain = strain,
                             .force = pressure * dea_point_cross_section(point),
                             .stretch = point->film.square * stretch * stretch,
                             .capacitance = dea_point_capacitance(point) * (1.0 + 4.0 * strain),
                             .taut = true});
}

static void half_network(const dea_symbols *symbols, dea_network *network)
{
    dea_pool *pool = symbols->pool;
    const dea_expr section = dea_symbols_cross_section(symbols), divide = MUL(symbols->coverage, symbols->frame_radius);
    const dea_expr stiffness = DIV(MUL(symbols->modulus, section), divide);
    const dea_expr stress = dea_symbols_stress_per_volt(symbols);
    dea_network_add(network, DEA_ROLE_SPRING, "n_a", "compliance of the disc [m/N]", stiffness);
    dea_network_add(network, DEA_ROLE_SPRING, "n_b", "compliance of the bias spring [m/N]", SCALE(0.5, stiffness));
    dea_network_add(network, DEA_ROLE_SOURCE, "f_dea", "electrostatic force [N]",
                    MUL(MUL(stress, SQUARE(symbols->voltage)), section));
    network->capacitance =
        ADD(dea_symbols_capacitance(symbols), MUL(SCALE(2.0, MUL(stress, section)), network->edge));
    dea_network_taut(network, NUM(1.0));
    dea_network_limit_area(symbols, network);
}

static void half_linear(const dea_point *point, dea_linear *linear)
{
    const double section = dea_point_cross_section(point);
    *linear = (dea_linear){.stiffness = 1.5 * point->film.modulus * section / dea_point_divide(point),
                           .force = dea_point_stress_per_volt(point) * section};
    linear->capacitance[0] = dea_point_capacitance(point);
    linear->capacitance[1] = 2.0 * linear->force;
}

static const dea_model half = {
    .name = "half",
    .equation = "of this test",
    .leaves_out = "nearly all",
    .solve = half_solve,
    .network = half_network,
    .linear = half_linear,
    .dynamic = true,
};

/* ---- a load: a spring that stiffens, k u^3 */

static dea_spring cubic_spring(double number, double u)
{
    return (dea_spring){number * u * u * u, 3.0 * number * u * u};
}

static dea_expr cubic_form(dea_pool *pool, dea_expr number, dea_expr u)
{
    return MUL(number, MUL(u, SQUARE(u)));
}

static const dea_load_kind cubic = {
    .name = "cubic",
    .unit = "N/m^3",
    .suffix = "_N_per_m3",
    .low = 0.0,
    .high = INFINITY,
    .accepted = "a number > 0",
    .element = "k_load",
    .meaning = "spring that stiffens [N]",
    .length = -2,
    .spring = cubic_spring,
    .form = cubic_form,
};

/* As stiff at 0.3 mm as the paper's film, some 600 N/m. */
static const double cubic_stiffness = 6e9;

/* ---- running */

typedef struct answer {
    size_t size;
    _Alignas(16) char bytes[MOST];
} answer;

static dea_status take(void *user, size_t first, const void *points, size_t count, dea_error *error)
{
    answer *a = user;
    (void)error;
    assert_true((first + count) * a->size <= MOST);
    memcpy(a->bytes + first * a->size, points, count * a->size);
    return DEA_OK;
}

static void tell(void *user, const char *line)
{
    (void)user;
    fprintf(stderr, "%s\n", line);
}

static void run(const dea_scene *scene, const char *engine, answer *a)
{
    dea_error error = {0};
    const dea_run_options options = {.jobs = 1, .points = take, .log = tell, .user = a};
    a->size = dea_layout_of(scene).point_size;
    assert_int_equal(dea_study_run(scene, dea_engine_find(engine), &options, &error), DEA_OK);
}

static const char *const engines[] = {"direct", "ngspice", "ida"};

static dea_scene fung_scene(dea_kind kind, double voltage)
{
    dea_scene scene = paper_scene(kind, 1.2, 0.5, voltage);
    scene.material.law = &fung;
    memset(scene.material.constants, 0, sizeof scene.material.constants);
    scene.material.constants[MU] = 300e3;
    scene.material.constants[STIFFENING] = 0.2;
    scene.accuracy = 1e-9;
    return scene;
}

/* sigma of equal stretches in long double: 2 (y - y^-2) f', f' = mu/2 exp(b (2 y + y^-2 - 3)). */
static long double cauchy(long double l)
{
    const long double y = l * l;
    return 300e3L * (y - 1.0L / (y * y)) * expl(0.2L * (2.0L * y + 1.0L / (y * y) - 3.0L));
}

/* Eq. 18 by bisection. */
static double balanced(double voltage)
{
    const long double field = voltage / 1e-4L, unit = 2.8L * 8.8541878128e-12L * field * field;
    long double low = 0.0L, high = 0.3L;
    for (int i = 0; i < 100; i++) {
        const long double s = 0.5L * (low + high), l = 1.2L * (1.0L + s), p = 1.2L * (1.0L - s);
        *(cauchy(l) - cauchy(p) < unit * l * l * l * l ? &low : &high) = s;
    }
    return (double)low;
}

/* ---- tests */

static void a_law_is_one_entry_in_statics(void **state)
{
    (void)state;
    for (size_t e = 0; e < 3; e++) {
        dea_scene scene = fung_scene(DEA_DOT, 4000.0);
        answer a;
        scene.models[0] = dea_model_find("coverage");
        run(&scene, engines[e], &a);
        assert_state(*(const dea_row *)(const void *)a.bytes, DEA_STATE_OK);
        assert_relative(((const dea_row *)(const void *)a.bytes)->strain, balanced(4000.0), 1e-9);
        for (int kind = DEA_DOT; kind <= DEA_LENS; kind++) {
            answer ring;
            const dea_scene membrane = fung_scene((dea_kind)kind, 4000.0);
            scene.actuator.kind = (dea_kind)kind;
            scene.models[0] = dea_model_find("ring");
            run(&scene, engines[e], &ring);
            assert_relative(((const dea_row *)(const void *)ring.bytes)->strain, solve_direct(&membrane, "field").strain, 1e-3);
        }
    }
}

static void a_law_is_one_entry_in_time_and_frequency(void **state)
{
    (void)state;
    static const char *const models[] = {"coverage", "ring"};
    for (size_t m = 0; m < 2; m++) {
        dea_scene scene = fung_scene(DEA_DOT, 4000.0);
        answer still, moving[2], small[2];
        scene.models[0] = dea_model_find(models[m]);
        scene.accuracy = 1e-6;
        run(&scene, "direct", &still);
        scene.drive.voltage = (double)NAN;
        scene.material.density = 1080.0;
        scene.material.retardation = 1e-3;
        scene.study = DEA_STUDY_AC;
        scene.ac = (dea_ac){.from = 10.0, .to = 1000.0, .points_per_decade = 2, .bias = 3000.0};
        run(&scene, "direct", &small[0]);
        run(&scene, "ngspice", &small[1]);
        const dea_response *p = (const void *)small[0].bytes, *q = (const void *)small[1].bytes;
        for (size_t i = 0; i < dea_layout_of(&scene).rows; i++) {
            assert_relative(p[i].displacement, q[i].displacement, 1e-6);
        }
        scene.study = DEA_STUDY_TRANSIENT;
        scene.accuracy = 1e-4;
        scene.drive.waveform = (dea_waveform){
            .kind = DEA_WAVE_STEP, .step = {.off = (double)NAN, .voltage = 4000.0, .rise = 1e-4}, .period = (double)NAN};
        scene.transient = (dea_transient){.until = 0.04, .every = 1e-3};
        run(&scene, "ida", &moving[0]);
        run(&scene, "ngspice", &moving[1]);
        const dea_sample *a = (const void *)moving[0].bytes, *b = (const void *)moving[1].bytes;
        const double rest = ((const dea_row *)(const void *)still.bytes)->displacement;
        for (size_t i = 0; i < dea_layout_of(&scene).rows; i++) {
            assert_near(a[i].displacement, b[i].displacement, 2e-4 * rest);
        }
        assert_relative(a[40].displacement, rest, 1e-4);
    }
}

static void a_model_is_one_entry(void **state)
{
    (void)state;
    for (size_t e = 0; e < 3; e++) {
        dea_scene scene = paper_scene(DEA_DOT, 1.2, 0.5, 3000.0);
        answer a;
        scene.models[0] = &half;
        run(&scene, engines[e], &a);
        const dea_row still = *(const dea_row *)(const void *)a.bytes;
        const dea_row pelrine = solve_direct(&scene, "lumped"); /* s = (1 - B) M lambda_pre^4/Y of the same film */
        assert_relative(still.strain, pelrine.strain / (0.5 * 1.5), 1e-9);
        scene.study = DEA_STUDY_TRANSIENT;
        scene.drive.voltage = (double)NAN;
        scene.material.density = 1080.0;
        scene.material.retardation = 1e-3;
        scene.drive.waveform = (dea_waveform){
            .kind = DEA_WAVE_STEP, .step = {.off = (double)NAN, .voltage = 3000.0, .rise = 1e-4}, .period = (double)NAN};
        scene.transient = (dea_transient){.until = 0.04, .every = 1e-3};
        scene.accuracy = 1e-4;
        run(&scene, engines[e], &a);
        assert_relative(((const dea_sample *)(const void *)a.bytes)[40].displacement, still.displacement, 2e-4);
    }
}

static dea_scene cubic_scene(dea_kind kind, const char *model, double voltage)
{
    dea_scene scene = paper_scene(kind, 1.2, 0.5, voltage);
    dea_scene_unload(&scene);
    scene.models[0] = dea_model_find(model);
    scene.loads[dea_load_count()] = (dea_edge_load){&cubic, cubic_stiffness};
    scene.accuracy = 1e-8;
    return scene;
}

/* The same scene with springs that are linear instead and touch the cubic one at @p u. */
static dea_scene touching(dea_scene scene, double u)
{
    dea_scene_unload(&scene);
    *dea_scene_load(&scene, "stiffness") = 3.0 * cubic_stiffness * u * u;
    *dea_scene_load(&scene, "force") = 2.0 * cubic_stiffness * u * u * u;
    return scene;
}

static void a_load_is_one_entry_in_statics(void **state)
{
    (void)state;
    static const char *const models[] = {"lumped", "coverage", "ring", "lame", "field"};
    for (size_t m = 0; m < 5 * 3 * 2; m++) {
        answer a;
        dea_axis axis;
        double values[] = {0.5 * cubic_stiffness, cubic_stiffness};
        dea_scene scene = cubic_scene(m % 2 ? DEA_LENS : DEA_DOT, models[m / 6], m % 2 ? 3500.0 : 4000.0);
        add_axis(&scene, &axis, &scene.loads[dea_load_count()].number, values, 2);
        run(&scene, engines[m / 2 % 3], &a);
        for (size_t i = 0; i < 2; i++) {
            const dea_row *row = &((const dea_row *)(const void *)a.bytes)[i];
            dea_scene linear = scene; /* which holds as much there */
            dea_scene_unload(&linear);
            *dea_scene_load(&linear, "stiffness") = values[i] * row->displacement * row->displacement;
            const dea_row other = solve_direct(&linear, models[m / 6]);
            assert_state(*row, other.state);
            assert_relative(row->displacement, other.displacement, 3e-8);
            assert_relative(row->capacitance, other.capacitance, 1e-8);
            dea_scene_unload(&linear);
            assert_true(fabs(row->displacement) < 0.99 * fabs(solve_direct(&linear, models[m / 6]).displacement));
        }
    }
}

static void a_load_is_one_entry_in_frequency(void **state)
{
    (void)state;
    static const char *const models[] = {"lumped", "coverage", "field"};
    for (size_t m = 0; m < 3 * 2; m++) {
        dea_scene scene = cubic_scene(DEA_DOT, models[m / 2], 3000.0);
        const double u = solve_direct(&scene, models[m / 2]).displacement;
        answer a, b;
        scene.drive.voltage = (double)NAN;
        scene.material.density = 1080.0;
        scene.material.retardation = 1e-3;
        scene.study = DEA_STUDY_AC;
        scene.ac = (dea_ac){.from = 10.0, .to = 1000.0, .points_per_decade = 2, .bias = 3000.0};
        scene.accuracy = 1e-6;
        dea_scene linear = touching(scene, u);
        run(&scene, engines[m % 2], &a);
        run(&linear, "direct", &b);
        const dea_response *p = (const void *)a.bytes, *q = (const void *)b.bytes;
        for (size_t i = 0; i < dea_layout_of(&scene).rows; i++) {
            assert_relative(p[i].displacement, q[i].displacement, 1e-6);
        }
    }
}

static void a_load_is_one_entry_in_time(void **state)
{
    (void)state;
    static const char *const models[] = {"coverage", "field"};
    for (size_t m = 0; m < 2; m++) {
        dea_scene scene = cubic_scene(DEA_DOT, models[m], 4000.0);
        const double rest = solve_direct(&scene, models[m]).displacement;
        answer moving[2];
        scene.drive.voltage = (double)NAN;
        scene.material.density = 1080.0;
        scene.material.retardation = 1e-3;
        scene.study = DEA_STUDY_TRANSIENT;
        scene.accuracy = 1e-4;
        scene.drive.waveform = (dea_waveform){
            .kind = DEA_WAVE_STEP, .step = {.off = (double)NAN, .voltage = 4000.0, .rise = 1e-4}, .period = (double)NAN};
        scene.transient = (dea_transient){.until = 0.02, .every = 5e-4};
        run(&scene, "ida", &moving[0]);
        run(&scene, "ngspice", &moving[1]);
        const dea_layout layout = dea_layout_of(&scene);
        const dea_sample *a = (const void *)moving[0].bytes, *b = (const void *)moving[1].bytes;
        for (size_t i = 0; i < layout.rows; i++) {
            assert_near(a[i].displacement, b[i].displacement, 2e-4 * rest);
        }
        assert_relative(a[40].displacement, rest, 1e-4);
        for (size_t e = 0; e < 2; e++) { /* what the spring stores is counted */
            assert_true(dea_layout_summary(&layout, moving[e].bytes)->residual <= 1e-3);
        }
        assert_non_null(dea_engine_refuses(dea_engine_find("direct"), &scene, scene.models[0]));
    }
}

/* What the engine runs is the text that is exported (test_one_writer): that it stands there is left. */
static void a_load_is_one_entry_in_exports(void **state)
{
    (void)state;
    static const char *const models[] = {"coverage", "field"};
    for (size_t m = 0; m < 2 * 2; m++) {
        dea_scene scene = cubic_scene(DEA_DOT, models[m / 2], 4000.0);
        if (m % 2) {
            scene.drive.voltage = (double)NAN;
            scene.material.retardation = 1e-3;
            scene.study = DEA_STUDY_TRANSIENT;
            scene.accuracy = 1e-4;
            scene.drive.waveform = (dea_waveform){
                .kind = DEA_WAVE_STEP, .step = {.off = (double)NAN, .voltage = 4000.0, .rise = 1e-4}, .period = (double)NAN};
            scene.transient = (dea_transient){.until = 0.02, .every = 5e-4};
        }
        char *text = NULL;
        size_t size = 0;
        dea_error error = {0};
        dea_export export = {.scene = &scene, .dialect = dea_dialect_find("ngspice"), .analogy = dea_analogy_at(0), .out = open_memstream(&text, &size)};
        assert_int_equal(dea_export_netlist(&export, &error), DEA_OK);
        fclose(export.out);
        assert_non_null(strstr(text, m == 2 ? "BLOAD" : "load_cubic")); /* a still film of rings has numbers alone */
        free(text);
    }
}

static void a_dialect_is_one_entry(void **state)
{
    (void)state;
    dea_dialect shouting = *dea_dialect_find("ngspice");
    shouting.name = "shouting";
    shouting.title = "A simulator of this test";
    shouting.open = "<<";
    shouting.close = ">>";
    dea_scene scene = fung_scene(DEA_DOT, 4000.0);
    scene.models[0] = dea_model_find("coverage");
    char *text = NULL;
    size_t size = 0;
    dea_error error = {0};
    dea_export export = {.scene = &scene, .dialect = &shouting, .analogy = dea_analogy_at(0), .out = open_memstream(&text, &size)};
    assert_int_equal(dea_export_netlist(&export, &error), DEA_OK);
    fclose(export.out);
    assert_non_null(strstr(text, "A simulator of this test"));
    assert_non_null(strstr(text, "<<"));
    assert_non_null(strstr(text, "exp("));
    free(text);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_law_is_one_entry_in_statics),
        cmocka_unit_test(a_law_is_one_entry_in_time_and_frequency),
        cmocka_unit_test(a_model_is_one_entry),
        cmocka_unit_test(a_load_is_one_entry_in_statics),
        cmocka_unit_test(a_load_is_one_entry_in_frequency),
        cmocka_unit_test(a_load_is_one_entry_in_time),
        cmocka_unit_test(a_load_is_one_entry_in_exports),
        cmocka_unit_test(a_dialect_is_one_entry),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
