/* A file that appears whole under its name or not at all: written beside the target, then renamed. */
#ifndef DEA_ATOMIC_H
#define DEA_ATOMIC_H

#include "deaspice/status.h"

typedef struct dea_atomic {
    int fd;          /* open for reading and writing, or for writing alone where direct */
    bool direct;     /* standard output, a pipe or a device: written straight */
    char *target;    /* name under which the file shall appear, for messages too; owned */
    char *temporary; /* file beside the target, NULL where direct; owned */
} dea_atomic;

/* Opens @p path ("-": standard output) for writing; the caller ends it with dea_atomic_close().
 * Fails before any work is done where the result could not be put there. */
dea_status dea_atomic_open(dea_atomic *file, const char *path, dea_error *error);
/* Writes all of @p size bytes. */
dea_status dea_atomic_write(dea_atomic *file, const void *bytes, size_t size, dea_error *error);
/* Renames into place when @p keep is true, else removes what was written; a closed or never opened (zeroed) file is fine. */
dea_status dea_atomic_close(dea_atomic *file, bool keep, dea_error *error);
/* Writes a whole file at once: opens, writes and closes. */
dea_status dea_atomic_put(const char *path, const char *text, size_t length, dea_error *error);

#endif
