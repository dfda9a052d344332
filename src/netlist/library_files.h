/* The ready-made library of netlists/: parts in every dialect and symbols. */
#ifndef DEA_LIBRARY_FILES_H
#define DEA_LIBRARY_FILES_H

#include "deaspice/status.h"

/* Writes the library below @p folder, one folder a tool, made where they are missing; files of the same names are replaced whole.
 * DEA_ERROR_IO, DEA_ERROR_MEMORY. */
dea_status dea_library_write(const char *folder, dea_error *error);

#endif
