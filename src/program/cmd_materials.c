#include <math.h>
#include <stdio.h>
#include <string.h>

#include "deaspice/material.h"
#include "deaspice/plot.h"
#include "program/program.h"
#include "support/atomic.h"
#include "support/number.h"

enum { CURVE_POINTS = 101, CURVE_COLUMNS = 4 };

static const double usual_end = 2; /* stretch of curves and tables */

static const char *material_word(size_t index, char room[DEA_NAME_LENGTH])
{
    (void)room;
    const dea_material *material = dea_material_builtin(index);
    return material ? material->name : NULL;
}

static void print_list(void)
{
    int width = 0;
    for (size_t i = 0; i < dea_material_count(); i++) {
        int length = (int)strlen(dea_material_builtin(i)->name);
        width = length > width ? length : width;
    }
    for (size_t i = 0; i < dea_material_count(); i++) {
        const dea_material *material = dea_material_builtin(i);
        printf("%-*s  %s\n", width, material->name, material->source);
    }
}

static void print_number(const char *name, double value, const char *unit)
{
    if (isnan(value))
        printf("%-22s not given, and a scene needs it\n", name);
    else
        printf("%-22s %.9g%s\n", name, value, unit);
}

static void print_optional(const char *name, double value, const char *unit)
{
    if (!isnan(value))
        printf("%-22s %.9g%s\n", name, value, unit);
}

static void print_relaxation(const dea_material *material)
{
    printf("%-22s %s\n", "moduli", material->instantaneous ? "instantaneous" : "long-term");
    for (size_t i = 0; i < material->prony_count; i++)
        printf("prony %zu                g = %.9g, tau = %.9g s\n", i + 1, material->prony[i].g, material->prony[i].tau);
}

/* The law and its constants, those of a list entry after entry. */
static void print_law(const dea_material *material)
{
    const dea_law *law = material->law;
    printf("%-22s %s: %s\n", "law", law->name, law->energy_text);
    for (size_t i = 0; i < material->entry_count * law->constant_count; i++) {
        const dea_constant *constant = &law->constants[i % law->constant_count];
        char name[DEA_NAME_LENGTH];
        snprintf(name, sizeof name, law->entries > 1 ? "%s %zu" : "%s", constant->name, i / law->constant_count + 1);
        print_number(name, material->constants[i], constant->modulus ? " Pa" : "");
    }
}

/* What is known of other temperatures. */
static void print_thermal(const dea_material *material)
{
    const dea_shift *shift = &material->shift;
    if (shift->c1 > 0)
        printf("%-22s WLF, C1 = %.9g, C2 = %.9g K, reference = %.9g K\n", "shift of the times", shift->c1, shift->c2, shift->reference);
    for (size_t i = 0; i < shift->count; i++) {
        printf("%-22s %.9g at %.9g K\n", "shift of the times", shift->table[i][1], shift->table[i][0]);
    }
    if (!isnan(material->modulus_slope))
        printf("%-22s %.9g/K, reference = %.9g K\n", "slope of the moduli", material->modulus_slope, material->modulus_reference);
}

static void print_constants(const dea_material *material)
{
    printf("%-22s %s\n", "name", material->name);
    if (material->source[0] != '\0')
        printf("%-22s %s\n", "source", material->source);
    print_law(material);
    if (material->stretches[1] > 0)
        printf("%-22s %.9g to %.9g\n", "data of stretches", material->stretches[0], material->stretches[1]);
    if (fabs(material->permittivity_per_stretch) > 0)
        printf("%-22s %.9g %+.9g %s\n", "permittivity", material->permittivity, material->permittivity_per_stretch,
               material->permittivity_follows ? "stretch, that of the strained film" : "stretch");
    else
        print_number("permittivity", material->permittivity, "");
    print_optional("density", material->density, " kg/m^3");
    print_optional("retardation", material->retardation, " s");
    print_optional("modulus", material->modulus, " Pa");
    print_optional("breakdown", material->breakdown, " V/m");
    if (material->prony_count > 0)
        print_relaxation(material);
    print_thermal(material);
}

/* What follows from the long-term constants at usual pre-stretches. */
static void print_moduli(const dea_material *material, double to)
{
    static const double stretches[] = {1.0, 1.1, 1.2, 1.3, 1.5, 2.0, 2.5, 3.0, 3.5, 4.0, 5.0, 6.0, 8.0, 10.0};
    double constants[DEA_LAW_CONSTANTS];
    dea_material_long_term(material, constants);
    printf("\n%10s %12s %12s %12s %12s\n", "prestretch", "stress_Pa", "Y_Pa", "W11_Pa", "W12_Pa");
    for (size_t i = 0; i < sizeof stretches / sizeof stretches[0] && stretches[i] <= to; i++) {
        double stretch = stretches[i];
        const dea_stress stress = dea_law_stress(material->law, constants, stretch, stretch);
        if (!isfinite(stress.p1)) {
            printf("%10g %12s\n", stretch, "past the end of the energy: no film");
            break;
        }
        printf("%10g %12.1f %12.1f %12.1f %12.1f\n", stretch, stress.p1, dea_law_modulus(material->law, constants, stretch),
               stress.w11, stress.w12);
    }
}

/* A film pulled one way only narrows by stretch^-1/2 in both other directions. */
static dea_status write_curve_row(dea_atomic *file, const dea_law *law, const double *constants, double stretch, dea_error *error)
{
    const double values[CURVE_COLUMNS] = {stretch, dea_law_stress(law, constants, stretch, 1 / sqrt(stretch)).p1,
                                          dea_law_stress(law, constants, stretch, stretch).p1,
                                          dea_law_modulus(law, constants, stretch)};
    char line[CURVE_COLUMNS * (DEA_NUMBER_LENGTH + 1)];
    size_t used = 0;
    for (size_t i = 0; i < CURVE_COLUMNS; i++) {
        used += dea_number_write(line + used, values[i]);
        line[used++] = i + 1 < CURVE_COLUMNS ? ',' : '\n';
    }
    return dea_atomic_write(file, line, used, error);
}

static dea_status write_curves(const dea_material *material, double to, const char *path, dea_error *error)
{
    static const char header[] = "stretch,uniaxial_Pa,equibiaxial_Pa,modulus_Pa\n";
    double constants[DEA_LAW_CONSTANTS];
    dea_atomic file;
    dea_material_long_term(material, constants);
    dea_status status = dea_atomic_open(&file, path, error);
    if (status != DEA_OK)
        return status;
    status = dea_atomic_write(&file, header, sizeof header - 1, error);
    for (int i = 0; i < CURVE_POINTS && status == DEA_OK; i++)
        status = write_curve_row(&file, material->law, constants, 1 + (to - 1) * i / (CURVE_POINTS - 1), error);
    dea_status closed = dea_atomic_close(&file, status == DEA_OK, status == DEA_OK ? error : NULL);
    return status != DEA_OK ? status : closed;
}

/* The built-in material or the file of that name; says what is wrong. */
static bool material_choose(const char *name, dea_material *material, dea_exit *outcome)
{
    size_t index;
    dea_error error = {0};
    *outcome = DEA_EXIT_USAGE;
    if (!dea_material_find(name) && strpbrk(name, "./")) {
        const bool read = dea_material_read(name, material, &error) == DEA_OK;
        *outcome = read ? *outcome : dea_complain_error(&error);
        return read;
    }
    const bool chosen = dea_word_choose("material", name, material_word, &index);
    if (chosen) {
        *material = *dea_material_builtin(index);
    }
    return chosen;
}

static dea_status show(const dea_material *material, const dea_arguments *arguments, double to, dea_error *error)
{
    const bool elastic = dea_law_valid(material->law, material->constants);
    dea_status status = DEA_OK;
    if (!arguments->output && !arguments->plot) {
        print_constants(material);
        if (elastic)
            print_moduli(material, to);
        return DEA_OK;
    }
    if (!elastic)
        return dea_fail(error, DEA_ERROR_USAGE, "%s gives no elastic constants, e.g. yeoh: {C1: 180 kPa}", material->name);
    if (arguments->output)
        status = write_curves(material, to, arguments->output, error);
    if (arguments->plot && status == DEA_OK)
        status = dea_plot_material(material, to, arguments->plot, &arguments->picture, error);
    return status;
}

static dea_exit run(const dea_arguments *arguments)
{
    if (arguments->operand_count == 0) {
        if (arguments->output || arguments->plot || !isnan(arguments->to)) {
            dea_complain("-o, --plot and --to need the name of a material");
            return DEA_EXIT_USAGE;
        }
        print_list();
        return DEA_EXIT_DONE;
    }
    const char *name = arguments->operands[0].path;
    dea_material material;
    dea_exit outcome;
    if (!material_choose(name, &material, &outcome))
        return outcome;
    dea_files files = {0};
    const bool file = !dea_material_find(name);
    const bool apart = (!file || dea_inputs_note(arguments, &files)) && dea_targets_free(arguments, &files);
    dea_files_free(&files);
    if (!apart)
        return DEA_EXIT_USAGE;
    dea_error error = {0};
    dea_signals_catch();
    const dea_status status = show(&material, arguments, isnan(arguments->to) ? usual_end : arguments->to, &error);
    return status == DEA_OK ? DEA_EXIT_DONE : dea_complain_error(&error);
}

const dea_command dea_command_materials = {
    .name = "materials",
    .summary = "what is built in, or what a material file holds",
    .help = "Usage: deaspice materials [OPTION]... [NAME | FILE]\n"
            "\n"
            "Lists the built-in materials, or shows the constants of one, or of a material\n"
            "file, and what follows from them at usual pre-stretches: nominal stress, operating\n"
            "modulus Y, tangent moduli.\n"
            "\n",
    .further = "Examples:\n"
               "  deaspice materials\n"
               "  deaspice materials elastosil-2030 --plot elastosil.svg\n"
               "  deaspice materials film.yaml --to 4 -o film.csv\n",
    .takes = DEA_TAKES_OUTPUT | DEA_TAKES_PLOT | DEA_TAKES_CURVES,
    .least = 0,
    .most = 1,
    .words = material_word,
    .files = ".yaml",
    .run = run,
};
