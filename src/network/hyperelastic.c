#include "network/hyperelastic.h"

#include "expression/formula.h"

dea_expr dea_hyperelastic_change(const dea_symbols *symbols, dea_expr e)
{
    dea_pool *pool = symbols->pool;
    const dea_yeoh_terms t = dea_symbols_yeoh(symbols);
    const dea_expr two = NUM(2.0);
    const dea_expr c2 = SCALE(2.0, symbols->yeoh[1]);
    const dea_expr c3 = SCALE(3.0, symbols->yeoh[2]);
    const dea_expr d = MUL(t.square, MUL(e, ADD(two, e))); /* y - y0, y = lambda^2 */
    const dea_expr y = ADD(t.square, d);
    const dea_expr q = DIV(ADD(y, t.square), MUL(SQUARE(t.square), SQUARE(y)));
    const dea_expr dj = MUL(d, SUB(two, q));    /* of J = 2 y + y^-2 - 3 */
    const dea_expr dg = SUB(SCALE(3.0, d), dj); /* of g = y - y^-2 = 3 (y - 1) - J */
    const dea_expr sum = ADD(SCALE(2.0, t.j), dj);
    const dea_expr dw = MUL(dj, ADD(c2, MUL(c3, sum))); /* of w */
    const dea_expr w = ADD(t.w, dw);
    return SCALE(2.0, ADD(MUL(dg, w), MUL(t.g, dw)));
}

/* y - y0 of a stretch lambda_pre (1 + e), y = lambda^2. */
static dea_expr square_change(const dea_symbols *symbols, dea_expr e)
{
    dea_pool *pool = symbols->pool;
    return MUL(SQUARE(symbols->prestretch), MUL(e, ADD(NUM(2.0), e)));
}

/* sigma_1 = 2 w (y1 - v), J = y1 + y2 + v - 3, v = 1/(y1 y2). */
dea_expr dea_hyperelastic_principal(const dea_symbols *symbols, dea_expr e1, dea_expr e2)
{
    dea_pool *pool = symbols->pool;
    const dea_yeoh_terms t = dea_symbols_yeoh(symbols);
    const dea_expr d1 = square_change(symbols, e1), d2 = square_change(symbols, e2);
    const dea_expr a = d1 < d2 ? d1 : d2, b = d1 < d2 ? d2 : d1; /* one order, so that both stresses of a ring share terms */
    const dea_expr product = MUL(SQUARE(t.square), MUL(ADD(t.square, a), ADD(t.square, b)));
    const dea_expr sum = ADD(a, b);
    const dea_expr dv = NEG(DIV(ADD(MUL(t.square, sum), MUL(a, b)), product));
    const dea_expr dj = ADD(sum, dv);
    const dea_expr c2 = SCALE(2.0, symbols->yeoh[1]), c3 = SCALE(3.0, symbols->yeoh[2]);
    const dea_expr dw = MUL(dj, ADD(c2, MUL(c3, ADD(SCALE(2.0, t.j), dj))));
    return SCALE(2.0, ADD(MUL(SUB(d1, dv), ADD(t.w, dw)), MUL(t.g, dw)));
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
