#include "network/hyperelastic.h"

#include "expression/derivative.h"
#include "expression/formula.h"

dea_expr dea_hyperelastic_change(const dea_symbols *symbols, dea_expr e)
{
    dea_pool *pool = symbols->pool;
    const dea_expr y = SQUARE(MUL(symbols->prestretch, ADD(NUM(1.0), e)));
    const dea_expr v = DIV(NUM(1.0), SQUARE(y));
    const dea_expr j = SUB(ADD(SCALE(2.0, y), v), NUM(3.0));
    const dea_expr w = ADD(symbols->yeoh[0], MUL(j, ADD(SCALE(2.0, symbols->yeoh[1]), SCALE(3.0, MUL(symbols->yeoh[2], j)))));
    return dea_expr_change(pool, SCALE(2.0, MUL(SUB(y, v), w)));
}

dea_expr dea_hyperelastic_area(const dea_symbols *symbols, dea_expr strain)
{
    dea_pool *pool = symbols->pool;
    return DIV(dea_symbols_cross_section(symbols), ADD(NUM(1.0), strain));
}

dea_expr dea_hyperelastic_field(const dea_symbols *symbols, dea_expr e)
{
    dea_pool *pool = symbols->pool;
    const dea_expr stretch = MUL(symbols->prestretch, ADD(NUM(1.0), e));
    return MUL(DIV(symbols->voltage, symbols->film_thickness), SQUARE(stretch));
}

dea_expr dea_hyperelastic_force(const dea_symbols *symbols, dea_expr strain, dea_expr e)
{
    dea_pool *pool = symbols->pool;
    const dea_expr one = NUM(1.0);
    const dea_expr rest = MUL(dea_symbols_pressure(symbols), SQUARE(SQUARE(symbols->prestretch)));
    const dea_expr stretch = ADD(one, e);
    const dea_expr cube = MUL(SQUARE(stretch), stretch);
    const dea_expr ratio = e == strain ? one : DIV(stretch, ADD(one, strain)); /* the area shrinks as 1/(1 + s) */
    return MUL(MUL(dea_symbols_cross_section(symbols), rest), MUL(cube, ratio));
}
