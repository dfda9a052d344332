#include "netlist/symbol.h"

bool dea_symbol_of_part(const dea_scene *scene, const dea_model *model, dea_symbol *symbol)
{
    dea_part_parameter list[DEA_PART_PARAMETERS];
    *symbol = (dea_symbol){.meaning = scene->actuator.kind == DEA_DOT ? "dielectric elastomer dot actuator"
                                                                      : "dielectric elastomer lens actuator",
                           .pins = {"p", "n", "edge"},
                           .pin_count = 3,
                           .parameter_count = DEA_SYMBOL_PARAMETERS};
    if (!dea_part_name_of(scene->actuator.kind, model, symbol->name)) {
        return false;
    }
    dea_part_parameters(scene, model, list);
    for (size_t i = 0; i < DEA_SYMBOL_PARAMETERS; i++) {
        symbol->parameters[i] = list[i]; /* geometry stands first */
    }
    return true;
}

dea_symbol dea_symbol_spring(void)
{
    return (dea_symbol){.name = "dea_spring",
                        .meaning = "spring between two edges",
                        .pins = {"a", "b"},
                        .pin_count = 2,
                        .parameters = {{.name = "stiffness", .unit = "N/m", .meaning = "force over stretch", .value = 100.0}},
                        .parameter_count = 1};
}

dea_symbol dea_symbol_lever(void)
{
    return (dea_symbol){.name = "dea_lever",
                        .meaning = "lever between two edges; ratio -1 turns the sense",
                        .pins = {"a", "b"},
                        .pin_count = 2,
                        .parameters = {{.name = "ratio", .unit = "1", .meaning = "velocity of b over that of a", .value = -1.0}},
                        .parameter_count = 1};
}
