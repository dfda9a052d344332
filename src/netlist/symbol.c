#include "netlist/symbol.h"

bool dea_symbol_of_part(const dea_scene *scene, const dea_model *model, const char *name, dea_symbol *symbol)
{
    dea_part_parameter list[DEA_PART_PARAMETERS];
    *symbol = (dea_symbol){.meaning = scene->actuator.kind == DEA_DOT ? "dielectric elastomer dot actuator"
                                                                      : "dielectric elastomer lens actuator",
                           .pins = {"p", "n", "edge", "p2", "n2"},
                           .pin_count = scene->antagonist.there ? 5 : 3,
                           .parameter_count = DEA_SYMBOL_PARAMETERS};
    if (!dea_part_name_of(scene->actuator.kind, model, symbol->name)) {
        return false;
    }
    if (name) {
        snprintf(symbol->name, sizeof symbol->name, "%s", name);
    }
    dea_part_parameters(scene, model, list);
    for (size_t i = 0; i < DEA_SYMBOL_PARAMETERS; i++) {
        symbol->parameters[i] = list[i]; /* geometry stands first */
    }
    return true;
}

static dea_symbol helper(const char *prefix, const char *ending, const char *meaning, const dea_part_parameter *parameter)
{
    dea_symbol symbol = {
        .meaning = meaning, .pins = {"a", "b"}, .pin_count = 2, .parameters = {*parameter}, .parameter_count = 1};
    snprintf(symbol.name, sizeof symbol.name, "%s_%s", prefix, ending);
    return symbol;
}

dea_symbol dea_symbol_spring(const char *prefix)
{
    const dea_part_parameter stiffness = {.name = "stiffness", .unit = "N/m", .meaning = "force over stretch", .value = 100.0};
    return helper(prefix, "spring", "spring between two edges", &stiffness);
}

dea_symbol dea_symbol_lever(const char *prefix)
{
    const dea_part_parameter ratio = {.name = "ratio", .unit = "1", .meaning = "velocity of b over that of a", .value = -1.0};
    return helper(prefix, "lever", "lever between two edges; ratio -1 turns the sense", &ratio);
}
