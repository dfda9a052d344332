/* Prints the figures as Markdown tables; with --compilers only what programs differ by, by the engines in their own process. */
#include "stability.h"

#include "../bench/bench.h"

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Most that programs may differ by, relative to the peak: closed forms and roots by their rounding, what goes in steps by about
 * the accuracy of the examples. */
static const double rounding = 1e-11;
static const double accuracy = 2e-5;

enum { MOST_PROGRAMS = 16 };

static const char *verdict(bool good)
{
    return good ? "yes" : "NO";
}

static void print_closed_forms(void)
{
    static const char *const models[] = {"lumped", "lame", "coverage", "constant_force"};
    printf("\n## Closed forms and roots: rounding alone\n\n| model | actuator | error of the strain |\n|---|---|---|\n");
    for (size_t i = 0; i < sizeof models / sizeof models[0]; i++) {
        printf("| %s | dot | %.1e |\n", models[i], stability_rounding(models[i], DEA_DOT));
        if (dea_model_find(models[i])->lens) {
            printf("| %s | lens | %.1e |\n", models[i], stability_rounding(models[i], DEA_LENS));
        }
    }
}

static void print_orders(void)
{
    static const char *const knobs[] = {"step", "1/steps taken", "tolerance", "accuracy"};
    printf("\n## Orders of convergence\n\n| engine | method | error falls with | power, theory | measured | errors | as it "
           "should |\n"
           "|---|---|---|---|---|---|---|\n");
    for (size_t i = 0; i < stability_case_count(); i++) {
        const stability_order o = stability_order_of(i);
        printf("| %s | %s | %s | %s | %.2f | %.1e ... %.1e | %s |\n", o.which->engine, o.which->name, knobs[o.which->knob],
               o.which->theory, o.slope, o.largest, o.least, verdict(o.slope > o.which->least && o.slope < o.which->most));
        fflush(stdout);
    }
}

static void print_condition(double value)
{
    if (isinf(value)) {
        printf(" > 1e15 |");
    } else {
        printf(" %.1e |", value);
    }
}

static void print_conditions(void)
{
    printf("\n## Condition numbers of one time step\n\n| actuator | ngspice, SI | units of the run | best scaling | IDA, SI "
           "| unknowns of size 1 |\n|---|---|---|---|---|---|\n");
    for (size_t i = 0; i < stability_condition_count(); i++) {
        const stability_condition c = stability_condition_of(i);
        printf("| %s |", c.name);
        print_condition(c.network);
        print_condition(c.network_scaled);
        print_condition(c.network_best);
        print_condition(c.ida);
        print_condition(c.ida_scaled);
        printf("\n");
    }
}

static void print_similarities(void)
{
    printf("\n## Twins under similarity transforms: largest difference of any column over its peak\n\n"
           "| engine | study | powers of two | powers of ten |\n|---|---|---|---|\n");
    for (size_t i = 0; i < stability_subject_count(); i++) {
        const stability_subject *subject = stability_subject_at(i);
        printf("| %s | %s |", subject->engine, subject->name);
        for (int exact = 1; exact >= 0; exact--) {
            const stability_change change = stability_similarity(subject, exact == 1, SIZE_MAX);
            if (change.worst) {
                printf(" %.1e: %s |", change.largest, change.worst->name);
            } else {
                printf(" none: equal to the bit |");
            }
            fflush(stdout);
        }
        printf("\n");
    }
}

/* One engine's rows of the table; true where no program differs by more than it may. */
static bool print_engine(const dea_engine *engine, const char *folder, const char *const *programs, char **names, size_t count)
{
    stability_difference_found found[MOST_PROGRAMS];
    const double most = strcmp(engine->name, "direct") == 0 ? rounding : accuracy;
    bool good = true;
    stability_compare_programs(programs, count, folder, engine->name, found);
    for (size_t i = 1; i < count; i++) {
        printf("| %s | %s | %zu |", engine->name, names[i], found[i].examples);
        if (found[i].largest > 0.0) {
            printf(" %.1e in %s |\n", found[i].largest, found[i].where);
        } else {
            printf(" none: equal in all digits |\n");
        }
        good = good && found[i].examples > 0 && found[i].largest <= most;
    }
    fflush(stdout);
    return good;
}

/* @p names: NAME=PROGRAM each; @p quick: only by engines that need no process of their own. */
static bool print_programs(const char *folder, char **names, size_t count, bool quick)
{
    const char *programs[MOST_PROGRAMS];
    bool good = true;
    for (size_t i = 0; i < count; i++) {
        char *equals = strrchr(names[i], '=');
        if (!equals) {
            bench_give_up("%s: NAME=PROGRAM is wanted", names[i]);
        }
        *equals = '\0';
        programs[i] = equals + 1;
    }
    printf("\n## The examples by other compilers and flags, against %s\n\n| engine | built with | examples | largest difference "
           "|\n|---|---|---|---|\n",
           names[0]);
    for (size_t k = 0; k < dea_engine_count(); k++) {
        const dea_engine *engine = dea_engine_at(k);
        good = ((quick && engine->isolated) || print_engine(engine, folder, programs, names, count)) && good;
    }
    return good;
}

int main(int count, char **arguments)
{
    const bool quick = count > 1 && strcmp(arguments[1], "--compilers") == 0;
    const int first = quick ? 2 : 1;
    if (count < first + 3 || count - first - 1 > MOST_PROGRAMS) {
        bench_give_up("usage: %s [--compilers] FOLDER_OF_SCENES NAME=PROGRAM NAME=PROGRAM...", arguments[0]);
    }
    if (!quick) {
        print_closed_forms();
        print_orders();
        print_conditions();
        print_similarities();
    }
    return print_programs(arguments[first], arguments + first + 1, (size_t)(count - first - 1), quick) ? 0 : 1;
}
