/* Bytes of a file, read whole. */
#ifndef DEA_SCENE_FILE_H
#define DEA_SCENE_FILE_H

#include <stdbool.h>

#include "deaspice/status.h"

/* Largest scene or material file [bytes]. */
enum { DEA_FILE_MAX = 16 * 1024 * 1024 };

/* Reads @p path ("-": standard input) into @p text, which the caller frees; a pipe is taken only where @p pipe is true.
 * Returns DEA_OK, or DEA_ERROR_IO or DEA_ERROR_MEMORY with @p why (static, or from strerror) saying why not. */
dea_status dea_file_read(const char *path, bool pipe, char **text, size_t *length, const char **why);

#endif
