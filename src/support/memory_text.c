#include "support/memory_text.h"

#include <stdbool.h>
#include <stdlib.h>

dea_status dea_memory_text_begin(dea_memory_text *memory, dea_error *error)
{
    *memory = (dea_memory_text){0};
    memory->out = open_memstream(&memory->text, &memory->length);
    return memory->out ? DEA_OK : dea_fail(error, DEA_ERROR_MEMORY, "out of memory for a text");
}

dea_status dea_memory_text_end(dea_memory_text *memory, dea_status status, dea_error *error)
{
    const bool lost = !memory->out || ferror(memory->out) != 0;
    const bool whole = memory->out && fclose(memory->out) == 0 && !lost;
    memory->out = NULL;
    if (status == DEA_OK && !whole) {
        status = dea_fail(error, DEA_ERROR_MEMORY, "out of memory for a text");
    }
    if (status != DEA_OK) {
        free(memory->text);
        memory->text = NULL;
    }
    return status;
}
