/* Numbers as decimals, and as text, with '.' as decimal point whatever the locale. */
#ifndef DEA_SUPPORT_NUMBER_H
#define DEA_SUPPORT_NUMBER_H

#include <stdbool.h>
#include <stddef.h>

enum { DEA_NUMBER_LENGTH = 32 };

/* Writes @p value as "%.17g" would in the C locale, -0 as 0, without its final NUL; returns the length. NAN gives no character. */
size_t dea_number_write(char text[DEA_NUMBER_LENGTH], double value);
/* Writes @p value as "%.<digits>g" would in the C locale, -0 as 0, NUL-terminated; returns @p text. */
const char *dea_number_text(char text[DEA_NUMBER_LENGTH], double value, int digits);

/* Power of ten p = 1 ... 1e22 that makes a whole number of a decimal: the double nearest to *whole/p is @p value, and *whole is
 * exact. 0: there is none, as for 1/3. */
double dea_number_power(double value, double *whole);
/* The same for a given power; false where it does not make a whole number. */
bool dea_number_over(double value, double power, double *whole);

#endif
