#include "network/hyperelastic.h"

dea_ref dea_hyperelastic_change(const dea_symbols *symbols, dea_ref e)
{
    dea_pool *pool = symbols->pool;
    const dea_yeoh_terms t = dea_symbols_yeoh(symbols);
    const dea_ref two = dea_number(pool, 2.0);
    const dea_ref c2 = dea_scale(pool, 2.0, symbols->yeoh[1]);
    const dea_ref c3 = dea_scale(pool, 3.0, symbols->yeoh[2]);
    const dea_ref d = dea_mul(pool, t.square, dea_mul(pool, e, dea_add(pool, two, e))); /* y - y0, y = lambda^2 */
    const dea_ref y = dea_add(pool, t.square, d);
    const dea_ref q = dea_div(pool, dea_add(pool, y, t.square), dea_mul(pool, dea_square(pool, t.square), dea_square(pool, y)));
    const dea_ref dj = dea_mul(pool, d, dea_sub(pool, two, q));                            /* of J = 2 y + y^-2 - 3 */
    const dea_ref dg = dea_sub(pool, dea_scale(pool, 3.0, d), dj);                         /* of g = y - y^-2 = 3 (y - 1) - J */
    const dea_ref sum = dea_add(pool, dea_scale(pool, 2.0, t.j), dj);
    const dea_ref dw = dea_mul(pool, dj, dea_add(pool, c2, dea_mul(pool, c3, sum)));       /* of w */
    const dea_ref w = dea_add(pool, t.w, dw);
    return dea_scale(pool, 2.0, dea_add(pool, dea_mul(pool, dg, w), dea_mul(pool, t.g, dw)));
}

dea_ref dea_hyperelastic_area(const dea_symbols *symbols, dea_ref strain)
{
    dea_pool *pool = symbols->pool;
    return dea_div(pool, dea_symbols_cross_section(symbols), dea_add(pool, dea_number(pool, 1.0), strain));
}

dea_ref dea_hyperelastic_field(const dea_symbols *symbols, dea_ref e)
{
    dea_pool *pool = symbols->pool;
    const dea_ref stretch = dea_mul(pool, symbols->prestretch, dea_add(pool, dea_number(pool, 1.0), e));
    return dea_mul(pool, dea_div(pool, symbols->voltage, symbols->film_thickness), dea_square(pool, stretch));
}

dea_ref dea_hyperelastic_force(const dea_symbols *symbols, dea_ref strain, dea_ref e)
{
    dea_pool *pool = symbols->pool;
    const dea_ref one = dea_number(pool, 1.0);
    const dea_ref rest = dea_mul(pool, dea_symbols_pressure(symbols), dea_square(pool, dea_square(pool, symbols->prestretch)));
    const dea_ref stretch = dea_add(pool, one, e);
    const dea_ref cube = dea_mul(pool, dea_square(pool, stretch), stretch);
    const dea_ref ratio = e == strain ? one : dea_div(pool, stretch, dea_add(pool, one, strain)); /* the area shrinks as 1/(1 + s) */
    return dea_mul(pool, dea_mul(pool, dea_symbols_cross_section(symbols), rest), dea_mul(pool, cube, ratio));
}
