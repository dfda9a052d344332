/* Numbers with units, independent of the locale of the caller. */
#ifndef DEA_SUPPORT_QUANTITY_H
#define DEA_SUPPORT_QUANTITY_H

#include <stdbool.h>
#include <stddef.h>

enum { DEA_REASON_LENGTH = 384 };

typedef struct dea_units dea_units;

/* NULL without memory; free with dea_units_close(). Unit systems are built when a unit first needs them. */
dea_units *dea_units_open(void);
/* NULL is fine. */
void dea_units_close(dea_units *units);

/* The unit of temperatures, which may be given in degC and degF too; that of their differences is "kelvin". */
#define DEA_UNIT_TEMPERATURE "K"

/* Reads "30 mm" as a number of @p unit ("1": a bare number or a percentage). On false, @p reason says why not. */
bool dea_quantity_read(dea_units *units, const char *text, const char *unit, double *value, char reason[DEA_REASON_LENGTH]);
/* Factor from the bare @p unit, as a table's header has it ("kV", "%"), to @p target; false where it is no such unit. */
bool dea_unit_factor(dea_units *units, const char *unit, const char *target, double *factor);
/* number * factor, the factor taken as the whole number, or the inverse of one, that it is: 100 um are 1e-4 m to the last bit. */
double dea_unit_scale(double number, double factor);
/* Reads a whole number 1 ... @p most. */
bool dea_count_read(const char *text, size_t most, size_t *value);

#endif
