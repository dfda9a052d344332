#include "deaspice/fit.h"

#include "support/number.h"

#include <math.h>

static void print_number(FILE *stream, const char *before, double value, int digits, const char *after)
{
    char text[DEA_NUMBER_LENGTH];
    fprintf(stream, "%s%s%s", before, dea_number_text(text, value, digits), after);
}

static void print_quality(const dea_fit *fit, FILE *stream)
{
    static const char *const names[DEA_YEOH_TERMS] = {"C1", "C2", "C3"};
    fprintf(stream, "# Fit of %d Yeoh constants to %zu uniaxial and %zu equi-biaxial points", fit->terms,
            fit->count[DEA_LOAD_UNIAXIAL], fit->count[DEA_LOAD_EQUIBIAXIAL]);
    print_number(stream, ", stretch ", fit->stretch_min, 6, "");
    print_number(stream, " to ", fit->stretch_max, 6, ".\n");
    print_number(stream, "# Residual ", fit->residual_rms, 4, " Pa rms");
    print_number(stream, " (", 100.0 * fit->residual_relative, 3, " %)");
    print_number(stream, ", R^2 ", fit->r_squared, 6, "");
    print_number(stream, ", condition number ", fit->condition, 3, ".\n# Standard errors:");
    for (int i = 0; i < fit->terms; i++) {
        fprintf(stream, "%s %s", i > 0 ? "," : "", names[i]);
        if (isfinite(fit->deviation[i])) {
            print_number(stream, " ", fit->deviation[i], 3, " Pa");
        } else {
            fputs(" unknown (as many points as constants)", stream);
        }
    }
    fputs(".\n", stream);
    if (isfinite(fit->unstable_stretch)) {
        print_number(stream, "# WARNING: a tangent modulus is not positive from stretch ", fit->unstable_stretch, 5, " on.\n");
    }
    if (!(fit->yeoh[0] > 0.0)) {
        fputs("# WARNING: C1 is not positive; a scene refuses these constants.\n", stream);
    }
}

dea_status dea_fit_print(const dea_fit *fit, FILE *stream, dea_error *error)
{
    static const char *const before[DEA_YEOH_TERMS] = {"C1: ", ", C2: ", ", C3: "};
    print_quality(fit, stream);
    fputs("# A material file: name it in a scene as  material: {base: FILE, permittivity: 2.8}  with the value of your film.\nyeoh: {", stream);
    for (int i = 0; i < fit->terms; i++) {
        print_number(stream, before[i], fit->yeoh[i], 8, " Pa");
    }
    fputs("}\n", stream);
    return ferror(stream) ? dea_fail(error, DEA_ERROR_IO, "the fit could not be printed") : DEA_OK;
}
