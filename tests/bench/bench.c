#include "bench.h"

#include <stdlib.h>

int main(int count, char **arguments)
{
    if (count != 4) {
        bench_give_up("usage: %s PATH_OF_DEASPICE FOLDER_OF_PEERS FOLDER_OF_EXAMPLES", arguments[0]);
    }
    bench_row("what", "goal", -1, "measured (median)", "error");
    bench_row("---", "---", -1, "---", "---");
    bench_agreement();
    bench_engines(arguments[2]);
    bench_workers();
    bench_program(arguments[1]);
    bench_transients(arguments[1], arguments[2]);
    bench_membranes();
    bench_omissions(arguments[3]);
    bench_peers(arguments[2]);
    return 0;
}
