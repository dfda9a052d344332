/* Ordinary transients of one kind: a film with mass, damper and branches behind a resistance, switched on and off for seconds,
 * sampled every millisecond or so. Fast and slow times lie 10^4 to 10^7 apart, so that a simulator's tolerances and steps meet
 * every size of time and velocity in one run. */
#include "promises.h"

#include <stdio.h>
#include <stdlib.h>

#include "../unit/random_transients.h"

enum { TEXT = 4096, MOST_BRANCHES = 3 };

/* Appends to the text as printf does. */
static void put(char *text, const char *format, ...) DEA_PRINTF(2, 3);

static void put(char *text, const char *format, ...)
{
    va_list arguments;
    const size_t used = strlen(text);
    va_start(arguments, format);
    vsnprintf(text + used, TEXT - used, format, arguments);
    va_end(arguments);
}

static void put_material(char *text, uint64_t *seed)
{
    const int branches = (int)((MOST_BRANCHES + 1) * random_unit(seed));
    put(text, "material:\n  base: elastosil-2030\n  density: %.17g kg/m^3\n  retardation: %.17g s\n",
        random_between(seed, 900.0, 1200.0), random_decades(seed, 1e-6, 2e-3));
    put(text, branches > 0 ? "  prony:\n" : "");
    for (int i = 0; i < branches; i++) {
        put(text, "    - {g: %.17g, tau: %.17g s}\n", random_between(seed, 0.02, 0.2), random_decades(seed, 1e-3, 10.0));
    }
}

static void put_drive(char *text, uint64_t *seed, double until)
{
    const double on = random_chance(seed, 0.3) ? 0.0 : until * random_between(seed, 0.01, 0.2);
    put(text, "drive:\n");
    if (random_chance(seed, 0.7)) {
        put(text, "  series_resistance: %.17g Ohm\n", random_decades(seed, 1e3, 1e8));
    }
    put(text, "  waveform:\n    step: {on: %.17g s, off: %.17g s, voltage: %.17g V}\n", on,
        on + until * random_between(seed, 0.2, 0.7), random_between(seed, 500.0, 3500.0));
}

char *draw_stall(uint64_t seed, size_t number)
{
    static const char *const models[] = {"lumped", "lumped", "lame", "coverage"};
    uint64_t own = (seed + 1u) * UINT64_C(0xA24BAED4963EE407) ^ ((uint64_t)number + 1u) * UINT64_C(0x9FB21C651E98DF25);
    char *text = malloc(TEXT);
    for (int i = 0; i < 8; i++) {
        (void)random_unit(&own);
    }
    if (text) {
        const double until = random_decades(&own, 0.3, 30.0);
        snprintf(text, TEXT, "title: stall %zu of seed %llu\n", number, (unsigned long long)seed);
        put(text, "actuator:\n  kind: %s\n  frame_radius: %.17g m\n  coverage: %.17g\n  film_thickness: 100 um\n  prestretch: %.17g\n",
            random_chance(&own, 0.7) ? "dot" : "lens", random_decades(&own, 5e-3, 5e-2), random_between(&own, 0.2, 0.8),
            random_between(&own, 1.05, 1.3));
        put_material(text, &own);
        put_drive(text, &own, until);
        put(text, "model: %s\nstudy:\n  transient: {until: %.17g s, every: %.17g s}\naccuracy: %.0e\n",
            models[(int)(4.0 * random_unit(&own))], until, random_decades(&own, 5e-4, 1e-2),
            pow(10.0, -3.0 - (int)(4.0 * random_unit(&own))));
    }
    return text;
}
