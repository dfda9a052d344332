#include "material/form.h"

dea_form_invariants dea_form_invariants_of(dea_pool *pool, dea_expr l1, dea_expr l2)
{
    dea_form_invariants at = {.y = {SQUARE(l1), SQUARE(l2)}};
    const bool swapped = at.y[1] < at.y[0]; /* one order, so that both stresses of a region share terms */
    const dea_expr low = at.y[swapped], high = at.y[!swapped];
    at.v = DIV(NUM(1.0), MUL(low, high));
    at.j = SUB(ADD(ADD(low, high), at.v), NUM(3.0));
    return at;
}

void dea_form_stresses(dea_pool *pool, const dea_form_invariants *at, dea_expr first, dea_expr second, dea_law_form *form)
{
    for (int a = 0; a < 2; a++) {
        const dea_expr w = ADD(first, MUL(at->y[1 - a], second));
        form->stress[a] = SCALE(2.0, MUL(SUB(at->y[a], at->v), w));
    }
    form->room = NUM(1.0);
}
