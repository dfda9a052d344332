#include "expression/operation.h"

#include "expression/formula.h"

#define X(NAME, OPERANDS, VALUE, SLOPE, DERIVATIVE, CHANGE)                                                                      \
    static double value_##NAME(double x, double y)                                                                               \
    {                                                                                                                            \
        (void)y;                                                                                                                 \
        return VALUE;                                                                                                            \
    }                                                                                                                            \
    static dea_expr derivative_##NAME(dea_pool *pool, dea_expr own, dea_expr a, dea_expr b, dea_expr da, dea_expr db)            \
    {                                                                                                                            \
        (void)pool, (void)own, (void)a, (void)b, (void)da, (void)db;                                                             \
        return DERIVATIVE;                                                                                                       \
    }                                                                                                                            \
    static dea_expr change_##NAME(dea_pool *pool, dea_expr rest, const dea_operand_change *left,                                 \
                                  const dea_operand_change *right)                                                               \
    {                                                                                                                            \
        const dea_expr a0 = left->rest, a1 = left->now, da = left->change;                                                       \
        const dea_expr b0 = right->rest, b1 = right->now, db = right->change;                                                    \
        (void)pool, (void)rest, (void)a0, (void)a1, (void)da, (void)b0, (void)b1, (void)db;                                      \
        return CHANGE;                                                                                                           \
    }
DEA_OPERATION_LIST(X)
#undef X

#define FUNCTIONS(NAME) .value = value_##NAME, .derivative = derivative_##NAME, .change = change_##NAME

/* log1p and expm1 by functions that every simulator has: 2 atanh(x/(2 + x)) and 2 sinh(x/2) exp(x/2) keep the digits of a small
 * x, ln(1 + x) and exp(x) - 1 do not. */
static const dea_operation_row rows[DEA_OPERATIONS] = {
    [DEA_NUMBER] = {.name = "number", .precedence = 3},
    [DEA_SYMBOL] = {.name = "symbol", .precedence = 3},
    [DEA_NODE] = {.name = "node", .precedence = 3},
    [DEA_ADD] = {"add", 2, 1, false, "@+#", FUNCTIONS(ADD)},
    [DEA_SUB] = {"sub", 2, 1, true, "@-#", FUNCTIONS(SUB)},
    [DEA_MUL] = {"mul", 2, 2, false, "@*#", NULL, true, FUNCTIONS(MUL)},
    [DEA_DIV] = {"div", 2, 2, true, "@/#", NULL, true, FUNCTIONS(DIV)},
    [DEA_LN] = {"ln", 1, 3, false, "ln(@)", "max(@,1e-6)", FUNCTIONS(LN)},
    [DEA_EXP] = {"exp", 1, 3, false, "exp(@)", "min(@,80)", true, FUNCTIONS(EXP)},
    [DEA_SQRT] = {"sqrt", 1, 3, false, "sqrt(@)", "max(@,1e-12)", FUNCTIONS(SQRT)},
    [DEA_LOG1P] = {"log1p", 1, 3, false, "(2*atanh((@)/(2+(@))))", "max(min(@,1e3),-0.999999)", .inner = true, FUNCTIONS(LOG1P)},
    [DEA_EXPM1] = {"expm1", 1, 3, false, "(2*sinh(0.5*(@))*exp(0.5*(@)))", "max(min(@,80),-80)", FUNCTIONS(EXPM1)},
    [DEA_POW] = {"pow", 2, 3, false, "pow(@,#)", "max(min(@,1e4),1e-6)", true, true, FUNCTIONS(POW)},
    [DEA_POSITIVE] = {"positive", 1, 3, false, "max(@,1e-6)", NULL, true, FUNCTIONS(POSITIVE)},
};

const dea_operation_row *dea_operation_of(dea_operation operation)
{
    return &rows[operation];
}
