/* Schematic symbols of the parts. A symbol shows the geometry of its part; the other numbers keep the defaults of the library
 * that it names. */
#ifndef DEA_SYMBOL_H
#define DEA_SYMBOL_H

#include <stdio.h>

#include "netlist/part.h"

enum { DEA_SYMBOL_PINS = 5, DEA_SYMBOL_PARAMETERS = 4 };

typedef struct dea_symbol {
    char name[DEA_PART_TITLE];
    const char *meaning;
    const char *pins[DEA_SYMBOL_PINS]; /* in the order of the .subckt card */
    size_t pin_count;
    dea_part_parameter parameters[DEA_SYMBOL_PARAMETERS];
    size_t parameter_count;
} dea_symbol;

/* Symbol of the part of a scene, called @p name or, where that is NULL, as dea_part_name_of() says; false where the model is no
 * part. */
bool dea_symbol_of_part(const dea_scene *scene, const dea_model *model, const char *name, dea_symbol *symbol);
/* Symbols of the mechanical helpers whose names begin with @p prefix. */
dea_symbol dea_symbol_spring(const char *prefix);
dea_symbol dea_symbol_lever(const char *prefix);

/* A KiCad symbol library (version 7 and later read it): begin, symbols, end. @p library is the file that holds the subcircuits.
 */
void dea_symbol_kicad_begin(FILE *out);
void dea_symbol_kicad(FILE *out, const dea_symbol *symbol, const char *library);
void dea_symbol_kicad_end(FILE *out);

/* An LTspice symbol, one a file. */
void dea_symbol_ltspice(FILE *out, const dea_symbol *symbol, const char *library);

#endif
