#include "support/quantity.h"

#include <ctype.h>
#include <errno.h>
#include <locale.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <udunits2.h>

#include "support/number.h"
#include "support/text.h"

enum { UNIT_LENGTH = 64, CASES_MOST = 6 };

/* A unit system; the whole one takes milliseconds to load, so units that actuator labs write have a small one. */
typedef struct unit_system {
    ut_system *system;
    bool tried;
} unit_system;

struct dea_units {
    locale_t locale; /* "C", for UDUNITS and numbers */
    unit_system small, whole;
    char last_unit[UNIT_LENGTH], last_target[UNIT_LENGTH]; /* of the last conversion */
    double last_factor;                                    /* its value = factor * number */
};

dea_units *dea_units_open(void)
{
    dea_units *units = calloc(1, sizeof *units);
    if (units) {
        units->locale = newlocale(LC_ALL_MASK, "C", (locale_t)0);
        if (units->locale == (locale_t)0) {
            free(units);
            return NULL;
        }
    }
    return units;
}

void dea_units_close(dea_units *units)
{
    if (units) {
        if (units->small.system) {
            ut_free_system(units->small.system);
        }
        if (units->whole.system) {
            ut_free_system(units->whole.system);
        }
        freelocale(units->locale);
        free(units);
    }
}

typedef struct prefix {
    char letter;
    double factor;
} prefix;

typedef struct unit_symbol {
    const char *name, *definition;
    bool prefixed;
} unit_symbol;

/* Maps a symbol and its prefixed forms. Prefixes are not told to UDUNITS, which would keep them for ever. */
static bool is_mapped(const char *name, ut_unit *unit)
{
    const ut_status status = unit ? ut_map_symbol_to_unit(name, UT_ASCII, unit) : UT_OS;
    return status == UT_SUCCESS || status == UT_EXISTS; /* a prefix can make a name that is there: kg */
}

static bool symbol_map(ut_system *system, const unit_symbol *symbol)
{
    static const prefix prefixes[] = {{'T', 1e12}, {'G', 1e9},  {'M', 1e6},  {'k', 1e3},   {'c', 1e-2},
                                      {'m', 1e-3}, {'u', 1e-6}, {'n', 1e-9}, {'p', 1e-12}, {'f', 1e-15}};
    ut_unit *unit = symbol->definition ? ut_parse(system, symbol->definition, UT_ASCII) : ut_new_base_unit(system);
    bool whole = is_mapped(symbol->name, unit);
    for (size_t i = 0; whole && symbol->prefixed && i < sizeof prefixes / sizeof *prefixes; i++) {
        char name[8];
        ut_unit *scaled = ut_scale(prefixes[i].factor, unit);
        snprintf(name, sizeof name, "%c%s", prefixes[i].letter, symbol->name);
        whole = is_mapped(name, scaled);
        ut_free(scaled);
    }
    ut_free(unit);
    return whole;
}

/* NULL where memory runs out on the way: a system without some of its units would deny that they exist. */
static ut_system *small_build(void)
{
    static const unit_symbol symbols[] = {
        {"m", NULL, true},      {"kg", NULL, false},     {"s", NULL, true},
        {"A", NULL, true},      {"g", "0.001 kg", true}, {"N", "kg.m.s-2", true},
        {"Pa", "N.m-2", true},  {"J", "N.m", true},      {"W", "J.s-1", true},
        {"C", "A.s", true},     {"V", "W.A-1", true},    {"ohm", "V.A-1", true},
        {"F", "C.V-1", true},   {"Hz", "s-1", true},     {"min", "60 s", false},
        {"h", "3600 s", false}, {"rad", NULL, false},    {"deg", "0.017453292519943295 rad", false},
        {"K", NULL, false},     {"kelvin", "K", false},  {"percent", "0.01", false},
    };
    ut_system *system = ut_new_system();
    for (size_t i = 0; system && i < sizeof symbols / sizeof *symbols; i++) {
        if (!symbol_map(system, &symbols[i])) {
            ut_free_system(system);
            system = NULL;
        }
    }
    return system;
}

/* Length of the decimal number that @p text starts with, 0 without one. */
static size_t number_length(const char *text)
{
    size_t at = text[0] == '+' || text[0] == '-';
    const size_t whole = strspn(text + at, "0123456789");
    at += whole;
    const size_t part = text[at] == '.' ? strspn(text + at + 1, "0123456789") : 0;
    if (whole + part == 0) {
        return 0;
    }
    at += text[at] == '.' ? part + 1 : 0;
    if (text[at] == 'e' || text[at] == 'E') {
        const size_t sign = text[at + 1] == '+' || text[at + 1] == '-';
        const size_t power = strspn(text + at + 1 + sign, "0123456789");
        at += power ? 1 + sign + power : 0;
    }
    return at;
}

typedef struct spelling {
    const char *written, *meant;
} spelling;

/* Replacement of what @p text starts with (UTF-8 signs to ASCII), NULL without one. */
static const spelling *spelling_find(const char *text)
{
    static const spelling signs[] = {
        {"\xC2\xB5", "u"},  {"\xCE\xBC", "u"}, {"\xCE\xA9", "ohm"}, {"\xE2\x84\xA6", "ohm"}, {"\xC2\xB2", "^2"},
        {"\xC2\xB3", "^3"}, {"\xC2\xB7", "."}, {"Ohm", "ohm"},      {"\xC2\xB0", "deg"}, {"%", "percent"},
    };
    for (size_t i = 0; i < sizeof signs / sizeof *signs; i++) {
        if (strncmp(text, signs[i].written, strlen(signs[i].written)) == 0) {
            return &signs[i];
        }
    }
    return NULL;
}

/* Spells a unit in ASCII, 1/MPa as MPa-1; false where it does not fit. */
static bool unit_spell(const char *text, char out[UNIT_LENGTH])
{
    static const char over[] = "1/";
    const size_t begin = strncmp(text, over, strlen(over)) == 0 && !strpbrk(text + strlen(over), "*./^ ") ? strlen(over) : 0;
    size_t used = 0;
    for (size_t at = begin; text[at];) {
        const spelling *sign = spelling_find(text + at);
        const size_t length = sign ? strlen(sign->meant) : 1;
        if (used + length >= UNIT_LENGTH) {
            return false;
        }
        memcpy(out + used, sign ? sign->meant : text + at, length);
        used += length;
        at += sign ? strlen(sign->written) : 1;
    }
    if (begin > 0 && used + 2 < UNIT_LENGTH) {
        used += (size_t)snprintf(out + used, UNIT_LENGTH - used, "-1");
    }
    out[used] = '\0';
    return true;
}

static size_t letters(const char *text)
{
    size_t count = 0;
    while ((text[count] >= 'a' && text[count] <= 'z') || (text[count] >= 'A' && text[count] <= 'Z')) {
        count++;
    }
    return count;
}

/* unit = factor { (blank | "*" | "." | "/") factor },  factor = letters [ ["^"] ["-" | "+"] digit ] */
static bool unit_sound(const char *text)
{
    for (size_t at = 0;;) {
        const size_t name = letters(text + at);
        if (name == 0) {
            return false;
        }
        at += name;
        const size_t mark = text[at] == '^';
        const size_t sign = text[at + mark] == '-' || text[at + mark] == '+';
        const size_t digit = isdigit((unsigned char)text[at + mark + sign]) ? 1 : 0;
        if (!digit && mark + sign > 0) {
            return false;
        }
        at += digit ? mark + sign + digit : 0;
        if (text[at] == '\0') {
            return true;
        }
        const size_t before = strspn(text + at, " ");
        const size_t joint = text[at + before] != '\0' && strchr("*./", text[at + before]) ? 1 : 0;
        const size_t after = strspn(text + at + before + joint, " ");
        if (before + joint + after == 0) {
            return false;
        }
        at += before + joint + after;
    }
}

/* UDUNITS reads a blank as a product only between names without a sign before them: write every blank product as ".". */
static void unit_join(char *text)
{
    char *out = text;
    for (char *in = text; *in; in++) {
        if (*in != ' ') {
            *out++ = *in;
        } else if (out[-1] != '.' && out[-1] != '/' && out[-1] != '*') {
            const char next = in[strspn(in, " ")];
            if (next != '.' && next != '/' && next != '*') {
                *out++ = '.';
            }
        }
    }
    *out = '\0';
}

typedef enum conversion { CONVERTED, UNKNOWN_UNIT, OTHER_DIMENSION } conversion;

/* Factor from @p unit to @p target; only proportional units have one (no degrees Celsius, no decibels). */
static conversion convert(ut_system *system, const char *unit, const char *target, double *factor)
{
    ut_unit *from = ut_parse(system, unit, UT_ASCII);
    ut_unit *to = ut_parse(system, target, UT_ASCII);
    cv_converter *converter = from && to ? ut_get_converter(from, to) : NULL;
    conversion result = from && to ? OTHER_DIMENSION : UNKNOWN_UNIT;
    if (converter) {
        *factor = cv_convert_double(converter, 1.0);
        if (cv_convert_double(converter, 0.0) == 0.0 && cv_convert_double(converter, -1.0) == -*factor && *factor > 0.0 &&
            isfinite(*factor)) {
            result = CONVERTED;
        }
    }
    cv_free(converter);
    ut_free(from);
    ut_free(to);
    return result;
}

/* The whole system takes an angle as a mere number, which would make 6.28 Hz of 60 rpm. */
static bool angle_slips_in(const char *target)
{
    return strcmp(target, "Hz") == 0;
}

static conversion convert_any(dea_units *units, const char *unit, const char *target, double *factor)
{
    conversion result = UNKNOWN_UNIT;
    const locale_t before = uselocale(units->locale);
    const ut_error_message_handler handler = ut_set_error_message_handler(ut_ignore);
    if (!units->small.tried) {
        units->small = (unit_system){small_build(), true};
    }
    if (units->small.system) {
        result = convert(units->small.system, unit, target, factor);
    }
    if (result == UNKNOWN_UNIT && !angle_slips_in(target)) {
        if (!units->whole.tried) {
            units->whole = (unit_system){ut_read_xml(NULL), true};
        }
        if (units->whole.system) {
            result = convert(units->whole.system, unit, target, factor);
        }
    }
    ut_set_error_message_handler(handler);
    uselocale(before);
    return result;
}

/* Units of the target's dimension that differ from @p unit in the case of letters alone: ", did you mean kV?", else "". */
static void unit_suggest(dea_units *units, const char *unit, const char *target, char out[UNIT_LENGTH])
{
    char meant[UNIT_LENGTH];
    size_t places[CASES_MOST];
    size_t count = 0;
    size_t used = 0;
    out[0] = '\0';
    for (size_t at = 0; unit[at]; at++) {
        if (isalpha((unsigned char)unit[at]) && count++ < CASES_MOST) {
            places[count - 1] = at;
        }
    }
    const locale_t before = uselocale(units->locale);
    const ut_error_message_handler handler = ut_set_error_message_handler(ut_ignore);
    for (unsigned cases = 0; units->small.system && count <= CASES_MOST && cases < 1u << count; cases++) {
        double factor;
        snprintf(meant, sizeof meant, "%s", unit);
        for (size_t i = 0; i < count; i++) {
            char *letter = &meant[places[i]];
            *letter = (char)(cases >> i & 1 ? toupper((unsigned char)*letter) : tolower((unsigned char)*letter));
        }
        if (used + 2 * strlen(meant) + 24 < UNIT_LENGTH && convert(units->small.system, meant, target, &factor) == CONVERTED) {
            used += (size_t)snprintf(out + used, UNIT_LENGTH - used, "%s%s", used ? " or " : ", did you mean ", meant);
        }
    }
    if (used) {
        snprintf(out + used, UNIT_LENGTH - used, "?");
    }
    ut_set_error_message_handler(handler);
    uselocale(before);
}

static bool factor_find(dea_units *units, const char *written, const char *target, double *factor, char reason[DEA_REASON_LENGTH])
{
    char unit[UNIT_LENGTH];
    char meant[UNIT_LENGTH];
    char shown[DEA_REASON_LENGTH / 2];
    dea_text_clip(written, 24, shown, sizeof shown);
    if (!unit_spell(written, unit) || !unit_sound(unit)) {
        snprintf(reason, DEA_REASON_LENGTH, "what follows the number is not a unit, \"%s\"", shown);
        return false;
    }
    unit_join(unit);
    if (strcmp(unit, units->last_unit) != 0 || strcmp(target, units->last_target) != 0) {
        const conversion result = convert_any(units, unit, target, factor);
        if (result != CONVERTED) {
            unit_suggest(units, unit, target, meant);
        }
        if (result == UNKNOWN_UNIT) {
            const char *missing =
                units->whole.system || !units->whole.tried ? "" : ", and the UDUNITS database of further units cannot be read";
            snprintf(reason, DEA_REASON_LENGTH, "unknown unit \"%s\"%s%s", shown, meant, missing);
        } else if (result == OTHER_DIMENSION) {
            snprintf(reason, DEA_REASON_LENGTH, "wrong dimension: \"%s\" does not convert to %s%s", shown, target, meant);
        }
        if (result != CONVERTED) {
            return false;
        }
        snprintf(units->last_unit, UNIT_LENGTH, "%s", unit);
        snprintf(units->last_target, UNIT_LENGTH, "%s", target);
        units->last_factor = *factor;
    }
    *factor = units->last_factor;
    return true;
}

static bool number_convert(dea_units *units, const char *text, double *value, char reason[DEA_REASON_LENGTH])
{
    const locale_t before = uselocale(units->locale);
    errno = 0;
    *value = strtod(text, NULL);
    const bool fits = errno != ERANGE && isfinite(*value);
    uselocale(before);
    if (!fits) {
        snprintf(reason, DEA_REASON_LENGTH, "too large or too small for a number of double precision");
    }
    return fits;
}

double dea_unit_scale(double number, double factor)
{
    const bool small = factor < 1.0;
    const double ratio = small ? 1.0 / factor : factor;
    const double whole = round(ratio);
    double digits;
    const double power = dea_number_power(number, &digits);
    const bool exact = power > 0.0 && (small ? power * whole <= 0x1p53 : fabs(digits) * whole <= 0x1p53);
    if (fabs(ratio - whole) <= 1e-13 * whole) {
        return exact ? small ? digits / (power * whole) : digits * whole / power : small ? number / whole : number * whole;
    }
    return number * factor;
}

/* A text where a unit should be, most likely a comment. */
static bool is_comment(const char *written)
{
    return written[0] == '#' || strncmp(written, "//", 2) == 0;
}

/* T = (100 number + origin)/parts in K: in hundredths, so that 20 degC and 68 degF become the very number of 293.15 K. */
typedef struct thermometer {
    const char *name;
    double origin, parts;
} thermometer;

static bool temperature_apply(const char *written, double *value)
{
    static const thermometer scales[] = {{"degC", 27315.0, 100.0}, {"degF", 45967.0, 180.0}};
    char unit[UNIT_LENGTH];
    for (size_t i = 0; unit_spell(written, unit) && i < sizeof scales / sizeof *scales; i++) {
        if (strcmp(unit, scales[i].name) == 0) {
            *value = (100.0 * *value + scales[i].origin) / scales[i].parts;
            return true;
        }
    }
    return false;
}

static bool unit_apply(dea_units *units, const char *written, const char *unit, double *value, char reason[DEA_REASON_LENGTH])
{
    const bool plain = strcmp(unit, "1") == 0;
    double factor = 1.0;
    if (plain && strcmp(written, "%") == 0) {
        factor = 0.01;
    } else if (is_comment(written)) {
        snprintf(reason, DEA_REASON_LENGTH, "a comment starts with a blank and #");
        return false;
    } else if (plain && written[0]) {
        snprintf(reason, DEA_REASON_LENGTH, "takes a bare number, without a unit");
        return false;
    } else if (!plain && !written[0]) {
        snprintf(reason, DEA_REASON_LENGTH, "needs a unit");
        return false;
    } else if (strcmp(unit, DEA_UNIT_TEMPERATURE) == 0 && temperature_apply(written, value)) {
        return true;
    } else if (!plain && !factor_find(units, written, unit, &factor, reason)) {
        return false;
    }
    const double number = *value;
    *value = dea_unit_scale(number, factor);
    if (!isfinite(*value) || (*value == 0.0) != (number == 0.0)) {
        snprintf(reason, DEA_REASON_LENGTH, "too large or too small for a number of double precision");
        return false;
    }
    return true;
}

static bool is_digit(char c)
{
    return c >= '0' && c <= '9';
}

/* "4,5 kV" is written 4.5 kV; "1,000 V" may also be meant as 1000 V, and several commas can only be that. */
static void explain_comma(const char *text, char reason[DEA_REASON_LENGTH])
{
    char shown[DEA_REASON_LENGTH / 2];
    char plain[DEA_REASON_LENGTH / 2];
    size_t used = 0;
    dea_text_clip(text, 24, shown, sizeof shown);
    const char *comma = strchr(shown, ',');
    const bool several = strchr(comma + 1, ',') != NULL;
    const bool thousands = several || (strspn(comma + 1, "0123456789") == 3 && shown[0] != '0');
    for (const char *at = shown; *at; at++) {
        if (*at != ',') {
            plain[used++] = *at;
        }
    }
    plain[used] = '\0';
    char point[DEA_REASON_LENGTH / 2];
    snprintf(point, sizeof point, "%s", shown);
    point[comma - shown] = '.';
    snprintf(reason, DEA_REASON_LENGTH, "a comma in a number; write %s%s%s", several ? "" : point,
             thousands && !several ? " or " : "", thousands ? plain : "");
}

bool dea_quantity_read(dea_units *units, const char *text, const char *unit, double *value, char reason[DEA_REASON_LENGTH])
{
    char number[UNIT_LENGTH];
    const size_t length = number_length(text);
    if (length == 0) {
        snprintf(reason, DEA_REASON_LENGTH, text[0] ? "not a number" : "has no value");
        return false;
    }
    if (length >= sizeof number) {
        snprintf(reason, DEA_REASON_LENGTH, "more digits than a number can have here");
        return false;
    }
    if (text[length] == ',' && is_digit(text[length + 1]) && length < 16) {
        explain_comma(text, reason);
        return false;
    }
    memcpy(number, text, length);
    number[length] = '\0';
    const char *written = text + length;
    written += strspn(written, " \t");
    return number_convert(units, number, value, reason) && unit_apply(units, written, unit, value, reason);
}

bool dea_unit_factor(dea_units *units, const char *unit, const char *target, double *factor)
{
    char reason[DEA_REASON_LENGTH];
    *factor = 1.0;
    if (strcmp(target, "1") == 0) {
        *factor = strcmp(unit, "%") == 0 ? 0.01 : 1.0;
        return *factor < 1.0 || strcmp(unit, "1") == 0 || strcmp(unit, "-") == 0 || strcmp(unit, "mm/mm") == 0;
    }
    return factor_find(units, unit, target, factor, reason);
}

bool dea_count_read(const char *text, size_t most, size_t *value)
{
    const size_t length = strspn(text, "0123456789");
    if (length == 0 || length > 15 || text[length]) {
        return false;
    }
    const unsigned long long count = strtoull(text, NULL, 10);
    *value = (size_t)count;
    return count >= 1 && count <= most;
}
