#include "support/file.h"

#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static const char no_memory[] = "out of memory";

static const char *too_large(size_t most)
{
    return most > DEA_FILE_MAX ? "larger than 64 MiB" : "larger than 16 MiB";
}

int dea_file_drain(int file, size_t most, char **text, size_t *length)
{
    size_t room = 16384;
    size_t used = 0;
    char *bytes = malloc(room);
    *text = NULL;
    while (bytes) {
        const ssize_t got = read(file, bytes + used, room - used);
        if (got < 0 && errno == EINTR) {
            continue;
        }
        if (got <= 0) {
            *text = bytes;
            *length = used;
            return got < 0 ? errno : 0;
        }
        used += (size_t)got;
        *text = bytes;
        if (used > most) {
            return EFBIG;
        }
        if (used == room) {
            room *= 2;
            char *grown = realloc(bytes, room);
            *text = grown ? grown : bytes;
            bytes = grown;
        }
    }
    return ENOMEM;
}

/* The rest of a file, and why it has none. */
static const char *take_in(int file, size_t most, char **text, size_t *length)
{
    const int failed = dea_file_drain(file, most * 1024 * 1024, text, length);
    return failed == ENOMEM ? no_memory : failed == EFBIG ? too_large(most) : failed ? strerror(failed) : NULL;
}

static const char *type_refused(mode_t mode, bool pipe)
{
    if (S_ISDIR(mode)) {
        return "it is a directory";
    }
    if (!S_ISREG(mode) && !(pipe && S_ISFIFO(mode))) {
        return pipe ? "it is neither a regular file nor a pipe" : "it is not a regular file";
    }
    return NULL;
}

static const char *fault_of(bool failed)
{
    return failed ? strerror(errno) : NULL;
}

/* Opens a file of the right type; asked before too, since opening alone can wait for ever or do harm. */
static const char *open_typed(const char *path, bool pipe, int *file, struct stat *about)
{
    const char *refused = fault_of(stat(path, about) != 0);
    refused = refused ? refused : type_refused(about->st_mode, pipe);
    if (!refused) {
        *file = open(path, O_RDONLY | O_CLOEXEC | O_NOCTTY);
        refused = fault_of(*file < 0 || fstat(*file, about) != 0);
    }
    return refused ? refused : type_refused(about->st_mode, pipe);
}

dea_status dea_file_read(const char *path, bool pipe, size_t most, char **text, size_t *length, dea_files *seen, const char **why)
{
    struct stat about;
    const bool standard = strcmp(path, "-") == 0;
    int file = standard ? STDIN_FILENO : -1;
    *text = NULL;
    *length = 0;
    const char *refused = standard ? fault_of(fstat(file, &about) != 0) : open_typed(path, pipe, &file, &about);
    if (!refused && seen && dea_files_note(seen, standard ? "standard input" : path, &about, NULL) != DEA_OK) {
        refused = no_memory;
    }
    refused = refused ? refused : take_in(file, most, text, length);
    if (file >= 0 && !standard) {
        close(file);
    }
    *why = refused;
    if (!refused) {
        return DEA_OK;
    }
    free(*text);
    *text = NULL;
    return refused == no_memory ? DEA_ERROR_MEMORY : DEA_ERROR_IO;
}
