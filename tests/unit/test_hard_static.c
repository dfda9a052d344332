/* The hard cases of statics and frequency responses. */
#include "hard_cases.h"

int main(void)
{
    return hard_run_all(false);
}
