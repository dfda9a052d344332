/* Which files a call has read and is about to write, by device and inode, so that no result takes the place of its own input. */
#ifndef DEA_SUPPORT_FILES_H
#define DEA_SUPPORT_FILES_H

#include <sys/stat.h>

#include "deaspice/status.h"

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

#endif
