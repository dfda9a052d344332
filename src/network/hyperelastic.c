#include "network/hyperelastic.h"

#include "expression/derivative.h"
#include "material/form.h"

dea_expr dea_hyperelastic_principal(const dea_symbols *symbols, dea_expr e1, dea_expr e2)
{
    dea_pool *pool = symbols->pool;
    const dea_expr one = NUM(1.0);
    dea_law_form form = {0};
    if (!pool->exhausted) {
        const dea_expr l1 = MUL(symbols->prestretch, ADD(one, e1)), l2 = MUL(symbols->prestretch, ADD(one, e2));
        symbols->law->form(pool, symbols->constants, l1, l2, &form);
    }
    return dea_expr_change(pool, form.stress[0]);
}

dea_expr dea_hyperelastic_skin(const dea_symbols *symbols, dea_expr e1, dea_expr e2)
{
    dea_pool *pool = symbols->pool;
    const dea_expr one = NUM(1.0);
    dea_law_form form = {0};
    if (!pool->exhausted) {
        symbols->skin->form(pool, symbols->skin_constants, ADD(one, e1), ADD(one, e2), &form);
    }
    return MUL(MUL(symbols->skin_share, SQUARE(symbols->prestretch)), dea_expr_change(pool, form.stress[0]));
}

void dea_hyperelastic_nominal(const dea_symbols *symbols, dea_expr e1, dea_expr e2, dea_expr stress[2])
{
    dea_pool *pool = symbols->pool;
    const dea_expr stretch[2] = {ADD(NUM(1.0), e1), ADD(NUM(1.0), e2)};
    dea_law_form form = {0};
    if (!pool->exhausted) {
        symbols->law->form(pool, symbols->constants, MUL(symbols->prestretch, stretch[0]), MUL(symbols->prestretch, stretch[1]),
                           &form);
    }
    for (int a = 0; a < 2; a++) {
        stress[a] = dea_expr_change(pool, DIV(form.stress[a], stretch[a]));
    }
}

dea_expr dea_hyperelastic_change(const dea_symbols *symbols, dea_expr e)
{
    return dea_hyperelastic_principal(symbols, e, e);
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
    return MUL(dea_symbols_nominal_field(symbols), SQUARE(stretch));
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
