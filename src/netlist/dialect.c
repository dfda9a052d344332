#include "netlist/dialect.h"
#include "support/named.h"

#include <ctype.h>
#include <stdbool.h>
#include <string.h>

/* What stands round expressions and their parameters: these are put in as text, or the expression in braces knows them. */
#define B_SOURCES .source = {"B", "B"}, .equals = {" v=", " i="}
#define PUT_IN .open = "", .close = "", .left = "({", .right = "})"
#define IN_BRACES .open = "{", .close = "}", .left = "", .right = ""
#define NO_CARDS .transient = "", .ac = "", .sweep = ""

static const dea_dialect dialects[] = {
    {
        .name = "ngspice",
        .title = "ngspice",
        B_SOURCES,
        PUT_IN,
        .inside = ".",
        .solver = ".options",
        .inductor = "",
        /* every step is as long as tmax only without a control of the error */
        .transient = "* every step as long as tmax, no control of the error: it falls with the square of tmax\n"
                     ".options method=trap trtol=1e30 itl4=50 pivtol=1e-60 pivrel=0.3 chgtol=1e-30\n",
        .ac = "* the network is linear: no operating point\n.options noopac pivtol=1e-60\n",
        .sweep = ".options itl1=200 itl2=200\n",
        .table = "pwl",
        .save = ".save",
    },
    {
        .name = "ltspice",
        .title = "LTspice",
        B_SOURCES,
        PUT_IN,
        .inside = ":",
        .solver = ".options",
        .inductor = " rser=0", /* else 1 mOhm */
        NO_CARDS,
        .save = ".save",
    },
    {
        .name = "xyce",
        .title = "Xyce",
        B_SOURCES,
        IN_BRACES,
        .inside = ":",
        .solver = NULL,
        .inductor = "",
        /* steps up to tmax as long as Newton converges: its control of the error stops at edges, and tighter tolerances of its
         * Newton at rounding */
        .transient = "* every step as long as tmax, no control of the error: it falls with the square of tmax\n"
                     ".options timeint erroption=1\n",
        .ac = "",
        .sweep = "",
    },
    {
        .name = "pspice",
        .title = "PSpice",
        .source = {"E", "G"},
        .equals = {" value=", " value="},
        IN_BRACES,
        /* PSpice calls the natural logarithm log, and has no ln */
        .text = {[DEA_LN] = "log(@)", [DEA_POW] = "pwr(@,#)"},
        .inside = ".",
        .solver = ".options",
        .inductor = "",
        NO_CARDS,
    },
};

DEA_NAMED_ROWS(dea_dialect, dialects, &dialects[index])

void dea_dialect_source_begin(const dea_dialect *dialect, FILE *out, dea_quantity quantity, const char *name, const char *plus,
                              const char *minus)
{
    fputs(dialect->source[quantity], out);
    for (; *name; name++) {
        fputc(toupper((unsigned char)*name), out);
    }
    fprintf(out, " %s %s%s%s", plus, minus, dialect->equals[quantity], dialect->open);
}

void dea_dialect_source_end(const dea_dialect *dialect, FILE *out)
{
    fprintf(out, "%s\n", dialect->close);
}

void dea_dialect_parameter(const dea_dialect *dialect, FILE *out, const char *name)
{
    fprintf(out, "%s%s%s", dialect->left, name, dialect->right);
}

void dea_dialect_operation(const dea_dialect *dialect, FILE *out, dea_operation operation, bool moves,
                           dea_operand_writer *operand, void *user)
{
    const dea_operation_row *row = dea_operation_of(operation);
    const char *text = dialect->text[operation] ? dialect->text[operation] : row->text;
    for (; *text; text++) {
        if (*text == '@' && moves && row->held) {
            for (const char *held = row->held; *held; held++) {
                *held == '@' ? operand(user, 0) : (void)fputc(*held, out);
            }
        } else if (*text == '@' || *text == '#') {
            operand(user, *text == '#');
        } else {
            fputc(*text, out);
        }
    }
}

void dea_dialect_comment(FILE *out, const char *text)
{
    fputs("* ", out);
    for (size_t i = 0; text && text[i] && i < DEA_COMMENT_LENGTH; i++) {
        const char c = text[i];
        fputc(c >= ' ' && c <= '~' && c != '\\' ? c : ' ', out);
    }
    fputc('\n', out);
}

/* Length of the next piece: up to the last place where a line may be broken, behind a blank, `*` or `,`. */
static size_t piece(const char *text, size_t length)
{
    if (length <= DEA_CARD_LENGTH) {
        return length;
    }
    size_t end = DEA_CARD_LENGTH;
    while (end > 1 && !strchr(" *,", text[end - 1])) {
        end--;
    }
    return end > 1 ? end : length;
}

void dea_dialect_wrap(FILE *out, const char *text)
{
    while (*text) {
        size_t left = strcspn(text, "\n");
        size_t name = isalpha((unsigned char)*text) ? strcspn(text, " \n") : 0;
        const bool comment = *text == '*';
        for (size_t i = 0; i < name; i++) {
            fputc(toupper((unsigned char)text[i]), out);
        }
        do {
            const size_t length = comment ? left : piece(text, left);
            fwrite(text + name, 1, length - name, out);
            name = 0;
            text += length;
            left -= length;
            fputs(left > 0 ? "\n+ " : "\n", out);
        } while (left > 0);
        text += *text == '\n';
    }
}
