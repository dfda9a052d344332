/* A text that is written into memory. */
#ifndef DEA_SUPPORT_MEMORY_TEXT_H
#define DEA_SUPPORT_MEMORY_TEXT_H

#include <stdio.h>

#include "deaspice/status.h"

typedef struct dea_memory_text {
    FILE *out;     /* where it is written */
    char *text;    /* of `length` bytes and a NUL once it has ended */
    size_t length;
} dea_memory_text;

/* DEA_ERROR_MEMORY; ends with dea_memory_text_end() in either case. */
dea_status dea_memory_text_begin(dea_memory_text *memory, dea_error *error);
/* Returns @p status, that of the writing, or DEA_ERROR_MEMORY where a part of the text was lost. On DEA_OK the text belongs to the
 * caller, else it is NULL. */
dea_status dea_memory_text_end(dea_memory_text *memory, dea_status status, dea_error *error);

#endif
