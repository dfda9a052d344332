/* Numerical stability: methods have their order, no answer depends on the size of the actuator, and no unknown of IDA on units.
 */
#include "scenes.h"

#include "../stability/stability.h"

static void errors_fall_with_the_order_of_their_method(void **state)
{
    (void)state;
    for (size_t i = 0; i < stability_case_count(); i++) {
        const stability_order o = stability_order_of(i);
        if (!(o.slope > o.which->least && o.slope < o.which->most && o.least < o.largest)) {
            print_error("%s, %s: power %.2f, theory %s, errors %.1e to %.1e\n", o.which->engine, o.which->name, o.slope,
                        o.which->theory, o.largest, o.least);
            fail();
        }
    }
}

static void closed_forms_err_by_rounding_alone(void **state)
{
    (void)state;
    static const char *const models[] = {"lumped", "lame", "coverage", "constant_force"};
    for (size_t i = 0; i < sizeof models / sizeof models[0]; i++) {
        assert_near(stability_rounding(models[i], DEA_DOT), 0.0, 1e-13);
        if (dea_model_find(models[i])->lens) {
            assert_near(stability_rounding(models[i], DEA_LENS), 0.0, 1e-13);
        }
    }
}

static bool is_static_ngspice(const stability_subject *subject)
{
    return strcmp(subject->engine, "ngspice") == 0 && strncmp(subject->name, "static", 6) == 0;
}

/* Factors that are powers of two change no digit: what is left is a number in the code that has a unit. ngspice reads the numbers
 * of a static network in SI and ends Newton's iteration at a relative change. */
static void answer_does_not_depend_on_the_size_of_the_actuator(void **state)
{
    (void)state;
    size_t changed = 0;
    for (size_t i = 0; i < stability_subject_count(); i++) {
        const stability_subject *subject = stability_subject_at(i);
        const bool slow = strcmp(subject->engine, "ngspice") == 0;
        const stability_change change = stability_similarity(subject, true, slow ? 2 : SIZE_MAX);
        const double tolerance = is_static_ngspice(subject) ? 1e-10 : 0.0;
        if (!(change.largest <= tolerance)) {
            print_error("%s, %s: %s changes it by %.1e\n", subject->engine, subject->name, change.worst->name, change.largest);
            changed++;
        }
    }
    assert_int_equal(changed, 0);
}

static void scaling_conditions_every_time_step(void **state)
{
    (void)state;
    for (size_t i = 0; i < stability_condition_count(); i++) {
        const stability_condition c = stability_condition_of(i);
        if (!(c.ida_scaled < 1e8 && c.ida_scaled < 0.1 * c.ida && c.network_best < 1e8 && c.network_scaled <= 1.1 * c.network)) {
            print_error("%s: %.1e, %.1e, %.1e, %.1e, %.1e\n", c.name, c.network, c.network_scaled, c.network_best, c.ida,
                        c.ida_scaled);
            fail();
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(errors_fall_with_the_order_of_their_method),
        cmocka_unit_test(closed_forms_err_by_rounding_alone),
        cmocka_unit_test(answer_does_not_depend_on_the_size_of_the_actuator),
        cmocka_unit_test(scaling_conditions_every_time_step),
    };
    return cmocka_run_group_tests_name("stability", tests, NULL, NULL);
}
