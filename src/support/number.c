/* Shortest road to a correctly rounded %.17g: with |x| = m 2^e, m < 2^53, and X the decimal exponent of x, the 17 digits are
 * round(m 5^k 2^(e+k)) with k = 16 - X. For 0 <= k <= 27 the product is below 2^116, so 128-bit integers make it exact.
 * Everything else goes through snprintf. */
#include "support/number.h"

#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

enum { DIGITS = 17, POWER_MAX = 27 };

/* Replaces a decimal point of the locale, of any length, by '.'. */
static size_t point_force(char *text)
{
    size_t to = 0;
    bool inside = false;
    for (const char *from = text; *from; from++) {
        const bool plain = strchr("0123456789+-einfa", *from) != NULL;
        if (plain) {
            text[to++] = *from;
        } else if (!inside) {
            text[to++] = '.';
        }
        inside = !plain;
    }
    text[to] = '\0';
    return to;
}

const char *dea_number_text(char text[DEA_NUMBER_LENGTH], double value, int digits)
{
    snprintf(text, DEA_NUMBER_LENGTH, "%.*g", digits, value);
    point_force(text);
    return text;
}

static size_t number_write_slow(char *text, double value)
{
    snprintf(text, DEA_NUMBER_LENGTH, "%.17g", value);
    return point_force(text);
}

#ifdef __SIZEOF_INT128__
__extension__ typedef unsigned __int128 wide;

/* round-half-even(mantissa 5^power 2^(exponent + power)); 0 where that is not the exact path's business. */
static uint64_t digits_scale(uint64_t mantissa, int exponent, int power)
{
    static const uint64_t ten_16 = UINT64_C(10000000000000000);
    if (power < 0 || power > POWER_MAX) {
        return 0;
    }
    uint64_t five = 1;
    for (int i = 0; i < power; i++) {
        five *= 5;
    }
    const wide product = (wide)mantissa * five;
    const int shift = -(exponent + power);
    if (shift <= 0) {
        return shift > -11 && product < ((wide)1 << 64) ? (uint64_t)(product << -shift) : 0;
    }
    if (shift > 126) {
        return 0;
    }
    const wide half = (wide)1 << (shift - 1);
    const wide rest = product & ((half << 1) - 1);
    uint64_t digits = (uint64_t)(product >> shift);
    if (rest > half || (rest == half && (digits & 1u))) {
        digits++;
    }
    return digits >= ten_16 ? digits : 0;
}

/* Lays out 17 digits as %g does for decimal exponent @p decimal: fixed from -4 to 16, no trailing zeros. */
static size_t digits_layout(char *text, uint64_t digits, int decimal)
{
    char figures[DIGITS];
    for (int i = DIGITS - 1; i >= 0; i--, digits /= 10) {
        figures[i] = (char)('0' + digits % 10);
    }
    int used = DIGITS;
    while (used > 1 && figures[used - 1] == '0') {
        used--;
    }
    char *out = text;
    const bool scientific = decimal < -4;
    const int whole = scientific ? 1 : decimal + 1; /* digits before the point */
    if (whole <= 0) {
        *out++ = '0';
        *out++ = '.';
        for (int i = whole; i < 0; i++) {
            *out++ = '0';
        }
    }
    for (int i = 0; i < used || i < whole; i++) {
        if (i == whole && whole > 0) {
            *out++ = '.';
        }
        *out++ = i < used ? figures[i] : '0';
    }
    if (scientific) {
        const int size = -decimal;
        *out++ = 'e';
        *out++ = '-';
        *out++ = (char)('0' + size / 10);
        *out++ = (char)('0' + size % 10);
    }
    return (size_t)(out - text);
}

size_t dea_number_write(char text[DEA_NUMBER_LENGTH], double value)
{
    static const uint64_t ten_17 = UINT64_C(100000000000000000);
    if (isnan(value)) {
        return 0;
    }
    if (value == 0.0) {
        memcpy(text, "-0", 2);
        text[0] = signbit(value) ? '-' : '0';
        return signbit(value) ? 2 : 1;
    }
    const double size = fabs(value);
    if (!(size >= 1e-10 && size < 1e16)) {
        return number_write_slow(text, value);
    }
    int exponent;
    const uint64_t mantissa = (uint64_t)ldexp(frexp(size, &exponent), 53);
    exponent -= 53;
    int decimal = (int)floor((exponent + 52) * 0.30102999566398120);
    uint64_t digits = digits_scale(mantissa, exponent, DIGITS - 1 - decimal);
    if (digits >= ten_17) { /* the estimate was one too small */
        decimal++;
        digits = digits_scale(mantissa, exponent, DIGITS - 1 - decimal);
    }
    if (digits == 0 || digits >= ten_17) {
        return number_write_slow(text, value);
    }
    const bool negative = value < 0.0;
    text[0] = '-';
    return (negative ? 1u : 0u) + digits_layout(text + (negative ? 1 : 0), digits, decimal);
}
#else
size_t dea_number_write(char text[DEA_NUMBER_LENGTH], double value)
{
    return isnan(value) ? 0 : number_write_slow(text, value);
}
#endif
