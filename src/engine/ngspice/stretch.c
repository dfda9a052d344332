#include "engine/ngspice/stretch.h"

enum { SHORTEST_SWEEP = 32 };

dea_status dea_stretch_solve(const dea_stretch *s, dea_error *error)
{
    size_t reach = s->longest;
    size_t i = 0;
    dea_status status = DEA_OK;
    while (i < s->count && status == DEA_OK) {
        if (s->can_start(s->user, i)) {
            size_t good;
            const size_t left = s->count - i;
            const size_t count = left < reach ? left : reach;
            status = s->sweep(s->user, i, count, &good, error);
            i += good;
            reach = good < count ? SHORTEST_SWEEP : 2 * reach < s->longest ? 2 * reach : s->longest;
            if (status != DEA_OK || good == count) {
                continue;
            }
        }
        status = s->alone(s->user, i++, error);
    }
    return status;
}
