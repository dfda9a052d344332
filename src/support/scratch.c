#include "support/file.h"

#include <errno.h>
#include <fcntl.h>
#include <stdbool.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

enum { PATH_ROOM = 4096 };

const char *dea_scratch_folder(void)
{
    struct stat about;
    const char *wanted = getenv("TMPDIR");
    const bool fits = wanted && wanted[0] == '/' && stat(wanted, &about) == 0 && S_ISDIR(about.st_mode);
    return fits && access(wanted, W_OK | X_OK) == 0 ? wanted : "/tmp";
}

FILE *dea_scratch_open(void)
{
    char name[PATH_ROOM];
    const int length = snprintf(name, sizeof name, "%s/deaspice-XXXXXX", dea_scratch_folder());
    const int fd = length > 0 && (size_t)length < sizeof name ? mkstemp(name) : -1;
    if (fd < 0) {
        return NULL;
    }
    unlink(name);
    FILE *file = fcntl(fd, F_SETFD, FD_CLOEXEC) == 0 ? fdopen(fd, "w+b") : NULL;
    if (!file) {
        const int number = errno;
        close(fd);
        errno = number;
    }
    return file;
}
