/* Runs the hard cases and prints them as a Markdown table: delivered error and time of every engine, or the words with which it
 * refuses. Usage: hard FOLDER [NAME [ENGINE]]. Exit status 1 where one is not what the suite expects. */
#include "cases.h"

static void print_cell(const hard_cell *cell, const hard_verdict *v)
{
    if (cell->demand == HARD_CANNOT) {
        printf(" - |");
    } else if (cell->demand == HARD_REFUSED) {
        printf(" refused: \"%s\", %.2g s |", cell->words, v->seconds);
    } else {
        printf(" %.1e, %.2g s%s%s%s |", v->error, v->seconds, cell->words ? "; says \"" : "", cell->words ? cell->words : "",
               cell->words ? "\"" : "");
    }
}

int main(int argc, char **argv)
{
    int bad = 0;
    if (argc < 2) {
        fprintf(stderr, "usage: hard FOLDER [NAME [ENGINE]]\n");
        return 2;
    }
    printf("| case | direct | ngspice | ida |\n|---|---|---|---|\n");
    for (size_t i = 0; i < HARD_CASES; i++) {
        const hard_case *c = &hard_cases[i];
        hard_subject subject;
        dea_error error = {0};
        if (argc > 2 && argv[2][0] != '\0' && strcmp(argv[2], c->name) != 0) {
            continue;
        }
        if (!hard_begin(c, argv[1], true, &subject, &error)) {
            fprintf(stderr, "%s: %s\n", c->name, error.message);
            return 1;
        }
        printf("| %s |", c->title);
        for (size_t k = 0; k < HARD_ENGINES; k++) {
            char text[HARD_LOG + 1024];
            if (argc > 3 && strcmp(argv[3], hard_engine_names[k]) != 0) {
                continue;
            }
            const hard_verdict v = hard_try(&subject, k);
            const char *why = hard_shortfall(&c->cells[k], &v, subject.own_error, text, sizeof text);
            print_cell(&c->cells[k], &v);
            fflush(stdout);
            if (why) {
                fprintf(stderr, "%s, %s: %s\n", c->name, hard_engine_names[k], why);
                bad++;
            }
        }
        printf("\n");
        hard_end(&subject);
    }
    return bad > 0;
}
