/* Arithmetic of functions of one variable with their first two derivatives, which carry how far they have come from rest: a
 * difference of two values that lie close together keeps its digits, whatever it is made of. */
#ifndef DEA_JET_H
#define DEA_JET_H

#include <math.h>

typedef struct jet {
    long double value, slope, curve;
    long double change; /* of the value, from rest */
} jet;

static inline jet plain(long double value)
{
    return (jet){value, 0.0L, 0.0L, 0.0L};
}

static inline jet times(long double factor, jet a)
{
    return (jet){factor * a.value, factor * a.slope, factor * a.curve, factor * a.change};
}

static inline jet plus(jet a, jet b)
{
    return (jet){a.value + b.value, a.slope + b.slope, a.curve + b.curve, a.change + b.change};
}

static inline jet minus(jet a, jet b)
{
    return (jet){a.value - b.value, a.slope - b.slope, a.curve - b.curve, a.change - b.change};
}

static inline jet by(jet a, jet b)
{
    return (jet){a.value * b.value, a.slope * b.value + a.value * b.slope,
                 a.curve * b.value + 2.0L * a.slope * b.slope + a.value * b.curve,
                 a.change * b.value + (a.value - a.change) * b.change};
}

static inline jet inverse(jet a)
{
    const long double v = 1.0L / a.value;
    return (jet){v, -a.slope * v * v, 2.0L * a.slope * a.slope * v * v * v - a.curve * v * v, -a.change * v / (a.value - a.change)};
}

/* a^p, a > 0. */
static inline jet power(jet a, long double p)
{
    const long double rest = a.value - a.change, before = powl(rest, p), change = before * expm1l(p * log1pl(a.change / rest));
    const long double v = change > -0.5L * before ? before + change : powl(a.value, p); /* no small difference of the two */
    const long double first = p * v / a.value, second = (p - 1.0L) * first / a.value;
    return (jet){v, first * a.slope, first * a.curve + second * a.slope * a.slope, change};
}

/* What has come since rest, as a function of its own. */
static inline jet since_rest(jet a)
{
    a.value = a.change;
    return a;
}

#endif
