/* KiCad symbols, in the syntax of version 7, which later versions read too. Lengths in mm. */
#include "netlist/part_text.h"
#include "netlist/symbol.h"

static const char font[] = "(effects (font (size 1.27 1.27))";

static void property(FILE *out, const char *name, const char *value, const char *y, bool hidden)
{
    fprintf(out, "    (property \"%s\" \"%s\" (at 0 %s 0) %s%s))\n", name, value, y, font, hidden ? " hide" : "");
}

static void pin(FILE *out, const char *name, size_t number, const char *place)
{
    fprintf(out, "      (pin passive line (at %s) (length 2.54) (name \"%s\" %s)) (number \"%zu\" %s)))\n", place, name, font,
            number, font);
}

void dea_symbol_kicad_begin(FILE *out)
{
    fputs("(kicad_symbol_lib (version 20220914) (generator deaspice)\n", out);
}

void dea_symbol_kicad(FILE *out, const dea_symbol *symbol, const char *library)
{
    fprintf(out, "  (symbol \"%s\" (pin_names (offset 0.508)) (in_bom yes) (on_board no)\n", symbol->name);
    property(out, "Reference", "X", "6.35", false);
    property(out, "Value", symbol->name, "-6.35", false);
    property(out, "Footprint", "", "0", true);
    property(out, "Datasheet", "", "0", true);
    property(out, "ki_description", symbol->meaning, "0", true);
    property(out, "Sim.Device", "SUBCKT", "0", true);
    property(out, "Sim.Name", symbol->name, "0", true);
    property(out, "Sim.Library", library, "0", true);
    fputs("    (property \"Sim.Pins\" \"", out);
    for (size_t i = 0; i < symbol->pin_count; i++) {
        fprintf(out, "%s%zu=%s", i > 0 ? " " : "", i + 1, symbol->pins[i]);
    }
    fprintf(out, "\" (at 0 0 0) %s hide))\n    (property \"Sim.Params\" \"", font);
    for (size_t i = 0; i < symbol->parameter_count; i++) {
        fprintf(out, "%s%s=", i > 0 ? " " : "", symbol->parameters[i].name);
        dea_part_number(out, symbol->parameters[i].value);
    }
    fprintf(out, "\" (at 0 0 0) %s hide))\n    (symbol \"%s_0_1\"\n", font, symbol->name);
    fputs("      (rectangle (start -5.08 5.08) (end 5.08 -5.08) (stroke (width 0.254) (type default)) (fill (type background)))\n"
          "    )\n",
          out);
    fprintf(out, "    (symbol \"%s_1_1\"\n", symbol->name);
    for (size_t i = 0; i < symbol->pin_count; i++) {
        static const char *const film[DEA_SYMBOL_PINS] = {"-7.62 2.54 0", "-7.62 -2.54 0", "7.62 0 180", "7.62 2.54 180", "7.62 -2.54 180"};
        static const char *const helper[] = {"-7.62 0 0", "7.62 0 180"};
        pin(out, symbol->pins[i], i + 1, symbol->pin_count > 2 ? film[i] : helper[i]);
    }
    fputs("    )\n  )\n", out);
}

void dea_symbol_kicad_end(FILE *out)
{
    fputs(")\n", out);
}
