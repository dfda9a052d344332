#include "support/number.h"

#include <locale.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

const char *dea_number_text(char text[DEA_NUMBER_LENGTH], double value, int digits)
{
    const struct lconv *convention = localeconv();
    snprintf(text, DEA_NUMBER_LENGTH, "%.*g", digits, value + 0.0); /* -0 + 0 is 0 */
    char *point = strstr(text, convention->decimal_point);
    if (point && strcmp(convention->decimal_point, ".") != 0) {
        const size_t length = strlen(convention->decimal_point);
        *point = '.';
        memmove(point + 1, point + length, strlen(point + length) + 1);
    }
    return text;
}

size_t dea_number_write(char text[DEA_NUMBER_LENGTH], double value)
{
    return isnan(value) ? 0 : strlen(dea_number_text(text, value, 17));
}

static const double exact = 0x1p53; /* whole numbers up to here are doubles */

bool dea_number_over(double value, double power, double *whole)
{
    *whole = nearbyint(value * power);
    return fabs(*whole) <= exact && *whole / power == value;
}

double dea_number_power(double value, double *whole)
{
    double power = 1.0;
    while (power <= 1e22 && !dea_number_over(value, power, whole)) {
        power = fabs(*whole) <= exact ? 10.0 * power : (double)INFINITY;
    }
    return power <= 1e22 ? power : 0.0;
}
