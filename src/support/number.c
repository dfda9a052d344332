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
