/* Bytes of a file, read whole. */
#ifndef DEA_SUPPORT_FILE_H
#define DEA_SUPPORT_FILE_H

#include <stdbool.h>

#include "support/files.h"

/* Largest file [MiB]: of a scene or a material, and of a waveform. */
enum { DEA_FILE_MAX = 16, DEA_WAVE_FILE_MAX = 64 };

/* Reads @p path ("-": standard input), at most @p most MiB, into @p text, which the caller frees; a pipe is taken only where
 * @p pipe is true. Notes it in @p seen, which may be NULL.
 * Returns DEA_OK, or DEA_ERROR_IO or DEA_ERROR_MEMORY with @p why (static, or from strerror) saying why not. */
dea_status dea_file_read(const char *path, bool pipe, size_t most, char **text, size_t *length, dea_files *seen,
                         const char **why);

/* All that is left to read, at most @p most bytes, malloc'd; 0 or why not: EFBIG, ENOMEM, what read() failed with. The caller frees
 * *@p text in any case. */
int dea_file_drain(int file, size_t most, char **text, size_t *length);

#endif
