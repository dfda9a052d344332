/* Numbers as text, with '.' as decimal point whatever the locale. */
#ifndef DEA_SUPPORT_NUMBER_H
#define DEA_SUPPORT_NUMBER_H

#include <stddef.h>

enum { DEA_NUMBER_LENGTH = 32 };

/* Writes @p value as "%.17g" would in the C locale, -0 as 0, without its final NUL; returns the length. NAN gives no character. */
size_t dea_number_write(char text[DEA_NUMBER_LENGTH], double value);
/* Writes @p value as "%.<digits>g" would in the C locale, -0 as 0, NUL-terminated; returns @p text. */
const char *dea_number_text(char text[DEA_NUMBER_LENGTH], double value, int digits);

#endif
