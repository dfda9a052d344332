/* Statics of the exact membrane: by collocation against integration along the radius, which knows nothing of it. */
#include "model/field.h"
#include "random_scenes.h"

static const struct {
    const char *name;
    double constants[DEA_LAW_CONSTANTS];
} laws[] = {{"yeoh", {178426.0, -6023.0, 4234.0}},
            {"neo_hookean", {44e3}},
            {"gent", {45e3, 12.0}},
            {"mooney_rivlin", {16e3, 7.3e3}},
            {"ogden", {43.4e3, 1.445, 84.2, 4.248, -2.4e3, -1.5}},
            {"arruda_boyce", {40e3, 5.99}}};
enum { LAWS = sizeof laws / sizeof *laws };

/* A film of a law, pre-stretched a little or much, of any coverage from 1e-3 to 1 - 1e-4, under a voltage of which @p most is near
 * pull-in for many. */
static dea_point random_point(uint64_t *seed, size_t law, double most)
{
    const double where = random_unit(seed), prestretch = random_between(seed, 1.0, 1.6);
    dea_point point = {.kind = random_chance(seed, 0.5) ? DEA_DOT : DEA_LENS,
                       .frame_radius = 0.03,
                       .film_thickness = 1e-4,
                       .layers = 1.0,
                       .focal_length = (double)NAN,
                       .refractive_index = (double)NAN};
    point.film = dea_law_film(dea_law_find(laws[law].name), laws[law].constants, prestretch);
    point.film.permittivity = 4.0 * DEA_EPSILON_0;
    point.coverage = where < 0.2   ? random_decades(seed, 1e-3, 0.1)
                     : where < 0.4 ? 1.0 - random_decades(seed, 1e-4, 0.1)
                                   : random_between(seed, 0.05, 0.95);
    const double unit = 1e-4 * sqrt(point.film.w11 / point.film.permittivity) / prestretch;
    point.voltage = unit * most * (random_chance(seed, 0.2) ? random_decades(seed, 1e-5, 1.0) : sqrt(random_unit(seed)));
    return point;
}

static dea_row integrated(const dea_point *point)
{
    dea_row row;
    dea_field_solve(point, (dea_field_mesh){0.13, 1e-13}, &row);
    return row;
}

/* Points of a law that collocation solves, of @p count; they are right within the accuracy. */
static size_t count_solved(uint64_t *seed, size_t law, size_t count, double most, double accuracy)
{
    size_t solved = 0;
    for (size_t i = 0; i < count; i++) {
        const dea_point point = random_point(seed, law, most);
        const dea_row wanted = integrated(&point);
        dea_row row;
        bool done;
        dea_collocation_solve(&point, 1, accuracy, &row, &done);
        solved += done || wanted.state == DEA_STATE_PULL_IN ? 1 : 0;
        if (done) {
            assert_state(row, wanted.state);
            assert_relative(row.strain, wanted.strain, accuracy);
            assert_relative(row.force, wanted.force, accuracy);
            assert_relative(row.capacitance, wanted.capacitance, accuracy);
            assert_relative(row.field, wanted.field, fmax(accuracy, 1e-8)); /* by a cubic between the steps of the integration */
        }
    }
    return solved;
}

static void collocation_is_right_within_the_accuracy(void **state)
{
    (void)state;
    static const double accuracies[] = {1e-4, 1e-6, 1e-9, 1e-12};
    uint64_t seed = UINT64_C(0x2545f4914f6cdd1d);
    for (size_t i = 0; i < 4; i++) {
        for (size_t law = 0; law < LAWS; law++) {
            const size_t count = law == 4 ? 4 : 20; /* powers take their time */
            assert_true(count_solved(&seed, law, count, 0.4, accuracies[i]) >= count - 1);
        }
    }
}

/* Up to pull-in and past it. */
static void no_root_is_taken_that_is_not_connected_to_rest(void **state)
{
    (void)state;
    uint64_t seed = UINT64_C(0x9e3779b97f4a7c15);
    for (size_t law = 0; law < LAWS; law++) {
        for (int i = 0; i < (law == 4 ? 3 : 12); i++) {
            const dea_point point = random_point(&seed, law, 1.0);
            dea_row row;
            bool done;
            dea_collocation_solve(&point, 1, 1e-6, &row, &done);
            if (done) {
                const dea_row wanted = integrated(&point);
                assert_state(row, wanted.state);
                assert_relative(row.strain, wanted.strain, 1e-6);
            }
        }
    }
}

/* A film of the third law ends at I1 - 3 = 12: at 97 % and 99.9 % of that. */
static void gent_films_near_their_end_are_right(void **state)
{
    (void)state;
    static const double ends[] = {0.97, 0.999};
    for (size_t i = 0; i < 2; i++) {
        uint64_t seed = 77 + i;
        dea_point point = random_point(&seed, 2, 0.3);
        double low = 1.0, high = 4.0;
        while (high - low > 1e-12) {
            const double l = 0.5 * (low + high);
            *(2.0 * l * l + 1.0 / (l * l * l * l) - 3.0 < ends[i] * 12.0 ? &low : &high) = l;
        }
        point.film = dea_law_film(dea_law_find("gent"), laws[2].constants, low);
        point.film.permittivity = 4.0 * DEA_EPSILON_0;
        dea_row row;
        dea_model_find("field")->solve(&point, 1e-9, &row);
        const dea_row wanted = integrated(&point);
        assert_state(row, wanted.state);
        assert_relative(row.strain, wanted.strain, 1e-9);
    }
}

static bool same(const dea_row *a, const dea_row *b)
{
    const size_t numbers = offsetof(dea_row, state);
    return a->state == b->state && memcmp(a, b, numbers) == 0;
}

/* Rows of a line are those of its points alone, bit for bit, whoever goes beside them. */
static void the_digits_do_not_depend_on_who_goes_abreast(void **state)
{
    (void)state;
    enum { COUNT = 45 };
    static const char *models[] = {"field", "coverage"};
    for (size_t m = 0; m < sizeof models / sizeof *models; m++) {
        const dea_model *model = dea_model_find(models[m]);
        for (size_t law = 0; law < LAWS; law++) {
            uint64_t seed = 5 + law;
            dea_point points[COUNT];
            dea_row rows[COUNT], alone;
            for (size_t i = 0; i < COUNT; i++) {
                points[i] = random_point(&seed, law, i % 9 == 8 ? 0.9 : 0.4);
                points[i].kind = points[0].kind;
                points[i].film = points[0].film;
            }
            const size_t count = law == 4 ? 9 : COUNT;
            assert_non_null(model->solve_many);
            model->solve_many(points, count, 1e-7, rows);
            for (size_t i = 0; i < count; i++) {
                model->solve(&points[i], 1e-7, &alone);
                assert_true(same(&rows[i], &alone));
            }
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(collocation_is_right_within_the_accuracy),
        cmocka_unit_test(no_root_is_taken_that_is_not_connected_to_rest),
        cmocka_unit_test(gent_films_near_their_end_are_right),
        cmocka_unit_test(the_digits_do_not_depend_on_who_goes_abreast),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
