#include "network/hyperelastic.h"

#include "expression/derivative.h"
#include "material/form.h"

static dea_expr stretch_at(const dea_symbols *symbols, dea_expr e)
{
    dea_pool *pool = symbols->pool;
    return MUL(symbols->prestretch, ADD(NUM(1.0), e));
}

/* Cauchy stresses at two relative stretches. */
static dea_law_form form_at(const dea_symbols *symbols, dea_expr e1, dea_expr e2)
{
    dea_pool *pool = symbols->pool;
    const dea_expr l1 = stretch_at(symbols, e1), l2 = stretch_at(symbols, e2);
    dea_law_form form = {0};
    if (!pool->exhausted) {
        symbols->law->form(pool, symbols->constants, l1, l2, &form);
    }
    return form;
}

dea_expr dea_hyperelastic_thin(const dea_symbols *symbols, dea_expr e1, dea_expr e2)
{
    const dea_expr l1 = stretch_at(symbols, e1), l2 = stretch_at(symbols, e2);
    return symbols->pool->exhausted ? 0 : dea_expr_change(symbols->pool, dea_form_invariants_of(symbols->pool, l1, l2).v);
}

dea_expr dea_hyperelastic_principal(const dea_symbols *symbols, dea_expr e1, dea_expr e2)
{
    return dea_expr_change(symbols->pool, form_at(symbols, e1, e2).stress[0]);
}

void dea_hyperelastic_cauchy(const dea_symbols *symbols, dea_expr e1, dea_expr e2, dea_expr stress[2])
{
    const dea_law_form form = form_at(symbols, e1, e2);
    stress[0] = dea_expr_change(symbols->pool, form.stress[0]);
    stress[1] = dea_expr_change(symbols->pool, form.stress[1]);
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
    const dea_expr electric = dea_symbols_electric(symbols, stretch, stretch).first;
    return MUL(MUL(dea_symbols_cross_section(symbols), MUL(electric, rest)), MUL(cube, ratio));
}
