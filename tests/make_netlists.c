/* Writes the library of netlists/ into the folder that it is given. */
#include <stdio.h>

#include "netlist/part.h"

int main(int argc, char **argv)
{
    dea_error error = {0};
    if (argc != 2 || dea_library_write(argv[1], &error) != DEA_OK) {
        fprintf(stderr, "%s\n", argc == 2 ? error.message : "usage: make_netlists FOLDER");
        return 1;
    }
    return 0;
}
