#include "material/fit/test.h"

#include "support/number.h"

#include <math.h>

static void print_number(FILE *stream, const char *before, double value, int digits, const char *after)
{
    char text[DEA_NUMBER_LENGTH];
    fprintf(stream, "%s%s%s", before, dea_number_text(text, value, digits), after);
}

/* What was compared, and by what. */
static void print_choices(const dea_fit *fit, FILE *stream)
{
    if (fit->choice_count > 0) {
        fputs("# Compared by Akaike's criterion for few points (AICc): the least is the best.\n", stream);
    }
    for (size_t i = 0; i < fit->choice_count; i++) {
        const dea_fit_choice *choice = &fit->choices[i];
        fprintf(stream, "#   %s, %d constant%s rms error ", choice->law->name, choice->terms, choice->terms == 1 ? ":" : "s:");
        print_number(stream, "", 100.0 * choice->residual_relative, 4, " %");
        print_number(stream, ", AICc ", choice->criterion, 5, "");
        fputs(choice->law == fit->law && choice->terms == fit->terms ? "  <- taken\n" : "\n", stream);
    }
}

static void print_terms_tried(const dea_fit *fit, FILE *stream)
{
    if (!isfinite(fit->trials[0].residual_relative)) {
        return;
    }
    fputs("# Tried, each against one constant less by an F test:\n", stream);
    for (int i = 0; i < DEA_YEOH_TERMS && isfinite(fit->trials[i].residual_relative); i++) {
        fprintf(stream, "#   %d constant%s rms error ", i + 1, i == 0 ? ": " : "s:");
        print_number(stream, "", 100.0 * fit->trials[i].residual_relative, 4, " %");
        if (isfinite(fit->trials[i].p)) {
            print_number(stream, ", p = ", fit->trials[i].p, 3, "");
        }
        fputs(i + 1 == fit->terms ? "  <- taken\n" : "\n", stream);
    }
}

/* "C1", of a list "mu 1". */
static void print_name(const dea_fit *fit, int index, FILE *stream)
{
    const int stride = (int)fit->law->constant_count;
    fputs(fit->law->constants[index % stride].name, stream);
    if (fit->law->entries > 1) {
        fprintf(stream, " %d", index / stride + 1);
    }
}

static const char *unit_of(const dea_fit *fit, int index)
{
    return fit->law->constants[(size_t)index % fit->law->constant_count].modulus ? " Pa" : "";
}

static void print_law_quality(const dea_fit *fit, FILE *stream)
{
    fprintf(stream, "# Fit of %d %s constant%s to %zu uniaxial and %zu equi-biaxial points", fit->terms, fit->law->title,
            fit->terms == 1 ? "" : "s", fit->count[DEA_LOAD_UNIAXIAL], fit->count[DEA_LOAD_EQUIBIAXIAL]);
    print_number(stream, ", stretch ", fit->stretch_min, 6, "");
    print_number(stream, " to ", fit->stretch_max, 6, ".\n");
    print_number(stream, "# Residual ", fit->residual_rms, 4, " Pa rms");
    print_number(stream, " (", 100.0 * fit->residual_relative, 3, " %)");
    if (isfinite(fit->r_squared)) {
        print_number(stream, ", R^2 ", fit->r_squared, 6, "");
    }
    print_number(stream, ", condition number ", fit->condition, 3, ".\n# Standard errors:");
    for (int i = 0; i < fit->terms; i++) {
        fputs(i > 0 ? ", " : " ", stream);
        print_name(fit, i, stream);
        if (isfinite(fit->deviation[i])) {
            print_number(stream, " ", fit->deviation[i], 3, unit_of(fit, i));
        } else {
            fputs(" unknown (as many points as constants)", stream);
        }
    }
    fputs(".\n", stream);
    print_terms_tried(fit, stream);
    print_choices(fit, stream);
    if (isfinite(fit->unloads_from)) {
        print_number(stream, "# WARNING: the data unload from stretch ", fit->unloads_from, 5,
                     " on: loading and unloading differ; the constants are of neither.\n");
    }
    if (isfinite(fit->unstable_stretch)) {
        print_number(stream, "# WARNING: a tangent modulus is not positive from stretch ", fit->unstable_stretch, 5, " on.\n");
    }
}

static void print_law(const dea_fit *fit, FILE *stream)
{
    const int stride = (int)fit->law->constant_count;
    const bool list = fit->law->entries > 1;
    fprintf(stream, "%s: %s", fit->law->name, list ? "[" : "");
    for (int i = 0; i < fit->terms; i++) {
        fprintf(stream, "%s%s: ", i == 0 ? "{" : i % stride == 0 ? "}, {" : ", ", fit->law->constants[i % stride].name);
        print_number(stream, "", fit->constants[i], 8, unit_of(fit, i));
    }
    fputs(list ? "}]\n" : "}\n", stream);
    print_number(stream, "stretches: [", fmin(fit->stretch_min, 1.0), 6, "");
    print_number(stream, ", ", fmax(fit->stretch_max, 1.0), 6, "]  # that the data cover\n");
}

static void print_trials(const dea_relaxation *fit, FILE *stream)
{
    for (size_t i = 0; i < fit->trial_count; i++) {
        const dea_relaxation_trial *trial = &fit->trials[i];
        fprintf(stream, "#   %2zu branch%s rms error ", i, i == 1 ? ":  " : "es:");
        print_number(stream, "", 100.0 * trial->residual_relative, 4, " %");
        print_number(stream, ", long-term share ", trial->long_term, 4, "");
        if (isfinite(trial->p)) {
            print_number(stream, ", p = ", trial->p, 3, "");
        }
        fputs(i == fit->prony_count ? "  <- taken\n" : "\n", stream);
    }
}

/* " +- error", or nothing where the data does not tell it. */
static void print_deviation(FILE *stream, double deviation, const char *unit)
{
    if (isfinite(deviation)) {
        print_number(stream, " +- ", deviation, 3, unit);
    }
}

/* The range that was measured, and the ramp before it. */
static void print_range(const dea_relaxation *fit, FILE *stream)
{
    if (dea_test_of(fit->kind)->periodic) {
        print_number(stream, ", ", 0.5 / DEA_PI / fit->time_max, 6, " Hz");
        print_number(stream, " to ", 0.5 / DEA_PI / fit->time_min, 6, " Hz.\n");
        return;
    }
    print_number(stream, ", ", fit->time_min, 6, " s");
    print_number(stream, " to ", fit->time_max, 6, " s");
    print_number(stream, " after a ramp of ", fit->ramp, 6, " s.\n");
}

static void print_relaxation_quality(const dea_relaxation *fit, FILE *stream)
{
    const dea_test *test = dea_test_of(fit->kind);
    fprintf(stream, "# Fit of %zu Prony branch%s to %zu points of a %s", fit->prony_count, fit->prony_count == 1 ? "" : "es", fit->count,
            test->name);
    print_range(fit, stream);
    print_number(stream, "# Residual ", fit->residual_rms, 4, test->unit);
    print_number(stream, " rms (", 100.0 * fit->residual_relative, 3, " %), ");
    fputs(test->step, stream);
    print_number(stream, " ", fit->instantaneous, 6, test->unit);
    print_number(stream, ", long-term share ", fit->long_term, 6, "");
    print_deviation(stream, fit->long_term_deviation, "");
    fputs(".\n# Tried, each against one branch less by an F test:\n", stream);
    print_trials(fit, stream);
    fprintf(stream, "# No further branch: %s.\n", dea_relaxation_reason(fit));
    if (dea_relaxation_slow(fit)) {
        fputs("# WARNING: the slowest branch is slower than the test; the long-term share is extrapolated.\n", stream);
    }
    if (dea_relaxation_fast(fit)) {
        fputs("# WARNING: the fastest branch is faster than the highest frequency; the instantaneous modulus is extrapolated.\n", stream);
    }
}

static void print_prony(const dea_relaxation *fit, FILE *stream)
{
    fputs(fit->prony_count > 0 ? "prony:\n" : "prony: []\n", stream);
    for (size_t i = 0; i < fit->prony_count; i++) {
        print_number(stream, "  - {g: ", fit->prony[i].g, 8, "");
        print_number(stream, ", tau: ", fit->prony[i].tau, 8, " s}");
        if (isfinite(fit->deviation[i].g) && isfinite(fit->deviation[i].tau)) {
            fputs("  #", stream);
            print_deviation(stream, fit->deviation[i].g, ",");
            print_deviation(stream, fit->deviation[i].tau, " s");
        }
        fputc('\n', stream);
    }
}

/* How a scene names the file, with what it lacks. */
static void print_use(const dea_fit *fit, const dea_material *film, FILE *stream)
{
    const bool whole = film && isfinite(film->permittivity);
    if (fit && whole) {
        fputs("# A material file: name it in a scene as  material: FILE\n", stream);
    } else if (fit) {
        fputs("# A material file: name it in a scene as  material: {base: FILE, permittivity: 2.8}  with the value of your film, "
              "or "
              "let\n# deaspice fit --permittivity 2.8  write that here.\n",
              stream);
    } else {
        fprintf(stream,
                "# A material file: name it in a scene as  material: {base: FILE, yeoh: {C1: 180 kPa}%s}  with the\n"
                "# values of your film, or give it a line  base: elastosil-2030  with the name of yours.\n",
                whole ? "" : ", permittivity: 2.8");
    }
}

static void print_given(const char *key, double value, const char *unit, FILE *stream)
{
    enum { DECIMALS = 15 }; /* of any decimal number, as it was given */
    if (isfinite(value)) {
        fprintf(stream, "%s: ", key);
        print_number(stream, "", value, DECIMALS, unit);
    }
}

dea_status dea_fit_print(const dea_fit *fit, const dea_relaxation *relaxation, const dea_material *film, FILE *stream,
                         dea_error *error)
{
    if (fit) {
        print_law_quality(fit, stream);
    }
    if (relaxation) {
        print_relaxation_quality(relaxation, stream);
    }
    print_use(fit, film, stream);
    if (fit) {
        print_law(fit, stream);
    }
    if (fit && relaxation) {
        fputs("moduli: long-term  # instantaneous, where the stretch was measured faster than the film relaxes\n", stream);
    }
    if (relaxation) {
        print_prony(relaxation, stream);
    }
    if (film) {
        print_given("permittivity", film->permittivity, "\n", stream);
        print_given("density", film->density, " kg/m^3\n", stream);
        print_given("breakdown", film->breakdown, " V/m\n", stream);
    }
    return ferror(stream) ? dea_fail(error, DEA_ERROR_IO, "the fit could not be printed") : DEA_OK;
}
