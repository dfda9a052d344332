/* The hard cases in time. */
#include "hard_cases.h"

int main(void)
{
    return hard_run_all(true);
}
