#include <signal.h>
#include <stddef.h>

#include "program/program.h"

/* A handler can reach nothing but this. */
static volatile sig_atomic_t caught;

static void take_signal(int number)
{
    caught = number;
}

void dea_signals_catch(void)
{
    static const int numbers[] = {SIGINT, SIGTERM, SIGHUP, SIGPIPE};
    for (size_t i = 0; i < sizeof numbers / sizeof numbers[0]; i++) {
        struct sigaction before;
        struct sigaction action = {.sa_handler = take_signal, .sa_flags = (int)SA_RESETHAND};
        sigemptyset(&action.sa_mask);
        if (numbers[i] == SIGPIPE)
            action.sa_flags = 0;
        if (sigaction(numbers[i], NULL, &before) == 0 && before.sa_handler != SIG_IGN)
            sigaction(numbers[i], &action, NULL);
    }
}

int dea_signals_caught(void)
{
    return caught;
}

bool dea_signals_broken_pipe(void)
{
    return caught == SIGPIPE;
}

bool dea_signals_stop(void *user)
{
    (void)user;
    return caught != 0;
}

void dea_signals_raise(void)
{
    if (caught == 0)
        return;
    signal(caught, SIG_DFL);
    raise(caught);
}
