/* Bytes of a file, read whole. */
#ifndef DEA_SUPPORT_FILE_H
#define DEA_SUPPORT_FILE_H

#include <sys/stat.h>
#include <stdio.h>
#include <stdbool.h>
#include "deaspice/status.h"

/* ---- Which files a call has read and is about to write, by device and inode, so that no result takes the place of its own input. */

typedef struct dea_file_entry dea_file_entry;

/* The register; zeroed is empty. Owns its entries; end with dea_files_free(). */
typedef struct dea_files {
    dea_file_entry *entries;
    size_t count;
} dea_files;

/* Notes a file that was read, under the name that messages shall call it; all but regular files are passed over.
 * DEA_OK or DEA_ERROR_MEMORY. */
dea_status dea_files_note(dea_files *files, const char *name, const struct stat *about, dea_error *error);
/* The same for a file of the command line, read or not yet ("-": standard input); one that is not there is passed over. */
dea_status dea_files_note_path(dea_files *files, const char *path, dea_error *error);
/* Fails (DEA_ERROR_USAGE) where @p path ("-": standard output) is a file that was noted, whatever its spelling and links, unless
 * @p force, or an earlier target of this call. Then notes it as a target. A target that is not there yet is known by its folder.
 */
dea_status dea_files_target(dea_files *files, const char *path, bool force, dea_error *error);
/* Empties the register. */
void dea_files_free(dea_files *files);


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

/* ---- Temporary files. */

/* The folder for them: $TMPDIR where that is an absolute path of a folder that can be written, else /tmp. */
const char *dea_scratch_folder(void);
/* A file without a name that children do not inherit; NULL with errno. The caller closes it. */
FILE *dea_scratch_open(void);

#endif
