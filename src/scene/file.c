#include "scene/file.h"

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

static const char *drain(int file, size_t most, char **text, size_t *length)
{
    size_t room = 16384;
    size_t used = 0;
    char *bytes = malloc(room);
    while (bytes) {
        const ssize_t got = read(file, bytes + used, room - used);
        if (got < 0 && errno == EINTR) {
            continue;
        }
        if (got <= 0) {
            *text = bytes;
            *length = used;
            return got < 0 ? strerror(errno) : NULL;
        }
        used += (size_t)got;
        *text = bytes;
        if (used > most * 1024 * 1024) {
            return too_large(most);
        }
        if (used == room) {
            room *= 2;
            char *grown = realloc(bytes, room);
            *text = grown ? grown : bytes;
            bytes = grown;
        }
    }
    return no_memory;
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

dea_status dea_file_read(const char *path, bool pipe, size_t most, char **text, size_t *length, const char **why)
{
    struct stat status;
    *text = NULL;
    *length = 0;
    const char *refused = NULL;
    if (strcmp(path, "-") == 0) {
        refused = drain(STDIN_FILENO, most, text, length);
    } else {
        refused = stat(path, &status) ? strerror(errno) : type_refused(status.st_mode, pipe);
        const int file = refused ? -1 : open(path, O_RDONLY | O_CLOEXEC | O_NOCTTY);
        if (!refused) {
            refused = file < 0 ? strerror(errno) : fstat(file, &status) ? strerror(errno) : type_refused(status.st_mode, pipe);
            refused = refused ? refused : drain(file, most, text, length);
        }
        if (file >= 0) {
            close(file);
        }
    }
    *why = refused;
    if (!refused) {
        return DEA_OK;
    }
    free(*text);
    *text = NULL;
    return refused == no_memory ? DEA_ERROR_MEMORY : DEA_ERROR_IO;
}
