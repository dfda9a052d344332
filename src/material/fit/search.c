/* Unknowns without bounds for the method of least squares: a constant above a limit is limit + e^x, a modulus without one is
 * x times the shear modulus of a neo-Hookean film through the data, and other constants are themselves. */
#include "material/fit/plausible.h"

#include <math.h>
#include <string.h>

#include "material/law.h"
#include "support/minpack.h"

typedef struct search {
    const dea_fit_data *data;
    const dea_law *law;
    size_t count;          /* of constants in use */
    const double *weights; /* of the points */
    double modulus;        /* of a neo-Hookean film through the data [Pa] */
} search;

static const dea_constant *constant_at(const search *s, size_t index)
{
    return &s->law->constants[index % s->law->constant_count];
}

static void constants_of(const search *s, const double *x, double constants[DEA_LAW_CONSTANTS])
{
    memset(constants, 0, DEA_LAW_CONSTANTS * sizeof *constants);
    for (size_t i = 0; i < s->count; i++) {
        const dea_constant *constant = constant_at(s, i);
        const double unit = constant->modulus ? s->modulus : 1.0;
        constants[i] = isinf(constant->low) ? unit * x[i] : constant->low + unit * exp(x[i]);
    }
}

static double unknown_of(const search *s, size_t index, double value)
{
    const dea_constant *constant = constant_at(s, index);
    const double unit = constant->modulus ? s->modulus : 1.0;
    return isinf(constant->low) ? value / unit : log((value - constant->low) / unit);
}

static void residuals(void *user, const double *x, double *residual)
{
    const search *s = user;
    double constants[DEA_LAW_CONSTANTS];
    constants_of(s, x, constants);
    for (size_t i = 0; i < s->data->count; i++) {
        const dea_fit_point *point = &s->data->points[i];
        residual[i] = s->weights[i] * (point->stress - dea_fit_stress(s->law, constants, point->load, point->stretch));
    }
}

/* mu of the neo-Hookean film with the least squares. */
static double modulus_of(const dea_fit_data *data, const double *weights)
{
    const double unit[DEA_LAW_CONSTANTS] = {1.0};
    double above = 0.0, below = 0.0;
    for (size_t i = 0; i < data->count; i++) {
        const dea_fit_point *point = &data->points[i];
        const double square = weights[i] * weights[i];
        const double stress = dea_fit_stress(&dea_law_neo_hookean, unit, point->load, point->stretch);
        above += square * stress * point->stress;
        below += square * stress * stress;
    }
    return fabs(above / below);
}

/* Start number @p number: moduli that share that of the film, other constants by the law's starts, shifted from entry to entry. */
static void start_at(const search *s, size_t number, double *x)
{
    const size_t entries = s->count / s->law->constant_count;
    for (size_t i = 0; i < s->count; i++) {
        const dea_constant *constant = constant_at(s, i);
        const size_t entry = i / s->law->constant_count;
        const double other = s->law->starts[(number + entry) % DEA_LAW_STARTS];
        const double share = s->law->entries > 1 ? 2.0 * s->modulus / (other * (double)entries) : s->modulus;
        x[i] = unknown_of(s, i, constant->modulus ? share : other);
    }
}

dea_status dea_fit_search(const dea_fit_data *data, const dea_law *law, size_t entries, const double *weights,
                          double constants[DEA_LAW_CONSTANTS], dea_error *error)
{
    search s = {data, law, entries * law->constant_count, weights, modulus_of(data, weights)};
    double least = INFINITY;
    for (size_t number = 0; number < DEA_LAW_STARTS; number++) {
        double x[DEA_LAW_CONSTANTS], found[DEA_LAW_CONSTANTS], squares = INFINITY;
        start_at(&s, number, x);
        const dea_status status = dea_minpack_least(residuals, &s, data->count, s.count, x, &squares, error);
        if (status != DEA_OK) {
            return status;
        }
        constants_of(&s, x, found);
        if (squares < least && dea_law_valid(law, found)) {
            least = squares;
            memcpy(constants, found, sizeof found);
        }
    }
    return least < INFINITY ? DEA_OK
                            : dea_fail(error, DEA_ERROR_DATA, "no film of the law %s describes the data: look at the columns",
                                       law->name);
}
