#include "deaspice/result.h"

#include <math.h>

const char *dea_state_name(dea_state state)
{
    static const char *const names[DEA_STATE_COUNT] = {
#define X(code, name, meaning) [code] = name,
        DEA_STATE_LIST(X)
#undef X
    };
    return (unsigned)state < DEA_STATE_COUNT ? names[state] : "failed";
}

const dea_column dea_row_columns[DEA_ROW_COLUMNS] = {
    {"strain", "radial strain of the disc edge", "1", offsetof(dea_row, strain)},
    {"displacement_m", "radial displacement of the disc edge", "m", offsetof(dea_row, displacement)},
    {"force_N", "electrostatic force over the full circumference", "N", offsetof(dea_row, force)},
    {"field_V_per_m", "largest true electric field in the electroded film", "V/m", offsetof(dea_row, field)},
    {"capacitance_F", "capacitance of the deformed film", "F", offsetof(dea_row, capacitance)},
    {"charge_C", "charge of the film", "C", offsetof(dea_row, charge)},
    {"area_strain", "relative change of the electroded area", "1", offsetof(dea_row, area_strain)},
    {"focal_length_m", "focal length of the lens", "m", offsetof(dea_row, focal_length)},
    {"energy_J", "energy of the electric field in the film", "J", offsetof(dea_row, energy)},
    {"antagonist_field_V_per_m", "largest true electric field in the second film", "V/m", offsetof(dea_row, second_field)},
};

dea_row dea_row_failed(void)
{
    return (dea_row){NAN, NAN, NAN, NAN, NAN, NAN, NAN, NAN, NAN, NAN, DEA_STATE_FAILED};
}
