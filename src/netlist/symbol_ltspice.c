/* LTspice symbols. Pins lie on its grid of 16. */
#include "netlist/part_text.h"
#include "netlist/symbol.h"

static void pin(FILE *out, const char *name, size_t order, int x, int y)
{
    fprintf(out, "PIN %d %d %s 8\nPINATTR PinName %s\nPINATTR SpiceOrder %zu\n", x, y, x < 0 ? "LEFT" : "RIGHT", name, order);
}

void dea_symbol_ltspice(FILE *out, const dea_symbol *symbol, const char *library)
{
    fputs("Version 4\nSymbolType CELL\nRECTANGLE Normal -64 -64 64 64\nWINDOW 0 0 -72 Bottom 2\nWINDOW 3 0 72 Top 2\n", out);
    fprintf(out, "SYMATTR Prefix X\nSYMATTR Value %s\nSYMATTR ModelFile %s\nSYMATTR Description %s\nSYMATTR SpiceLine ",
            symbol->name, library, symbol->meaning);
    for (size_t i = 0; i < symbol->parameter_count; i++) {
        fprintf(out, "%s%s=", i > 0 ? " " : "", symbol->parameters[i].name);
        dea_part_number(out, symbol->parameters[i].value);
    }
    fputc('\n', out);
    for (size_t i = 0; i < symbol->pin_count; i++) {
        static const int film[DEA_SYMBOL_PINS][2] = {{-64, -32}, {-64, 32}, {64, 0}, {64, -32}, {64, 32}}, helper[][2] = {{-64, 0}, {64, 0}};
        const int *place = symbol->pin_count > 2 ? film[i] : helper[i];
        pin(out, symbol->pins[i], i + 1, place[0], place[1]);
    }
}
