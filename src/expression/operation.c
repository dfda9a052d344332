#include "expression/operation.h"

#include <stddef.h>

#define X(NAME, OPERANDS, VALUE, SLOPE, DERIVATIVE, CHANGE)                                                                      \
    static double value_##NAME(double x, double y)                                                                               \
    {                                                                                                                            \
        (void)y;                                                                                                                 \
        return VALUE;                                                                                                            \
    }
DEA_OPERATION_LIST(X)
#undef X

/* log1p and expm1 by functions that every simulator has: 2 atanh(x/(2 + x)) and 2 sinh(x/2) exp(x/2) keep the digits of a small
 * x, ln(1 + x) and exp(x) - 1 do not. */
static const dea_operation_row rows[DEA_OPERATIONS] = {
    [DEA_NUMBER] = {.name = "number", .precedence = 3},
    [DEA_SYMBOL] = {.name = "symbol", .precedence = 3},
    [DEA_NODE] = {.name = "node", .precedence = 3},
    [DEA_ADD] = {"add", 2, 1, false, "@+#", .value = value_ADD},
    [DEA_SUB] = {"sub", 2, 1, true, "@-#", .value = value_SUB},
    [DEA_MUL] = {"mul", 2, 2, false, "@*#", NULL, true, .value = value_MUL},
    [DEA_DIV] = {"div", 2, 2, true, "@/#", NULL, true, .value = value_DIV},
    [DEA_LN] = {"ln", 1, 3, false, "ln(@)", "max(@,1e-6)", .value = value_LN},
    [DEA_EXP] = {"exp", 1, 3, false, "exp(@)", "min(@,80)", true, .value = value_EXP},
    [DEA_SQRT] = {"sqrt", 1, 3, false, "sqrt(@)", "max(@,1e-12)", .value = value_SQRT},
    [DEA_LOG1P] = {"log1p", 1, 3, false, "(2*atanh((@)/(2+(@))))", "max(min(@,1e3),-0.999999)", .inner = true, .value = value_LOG1P},
    [DEA_EXPM1] = {"expm1", 1, 3, false, "(2*sinh(0.5*(@))*exp(0.5*(@)))", "max(min(@,80),-80)", .value = value_EXPM1},
    [DEA_POW] = {"pow", 2, 3, false, "pow(@,#)", "max(min(@,1e4),1e-6)", true, true, .value = value_POW},
    [DEA_POSITIVE] = {"positive", 1, 3, false, "max(@,1e-6)", NULL, true, .value = value_POSITIVE},
};

const dea_operation_row *dea_operation_of(dea_operation operation)
{
    return &rows[operation];
}
