#include "support/atomic.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

enum { NAME_TRIES = 100 };

static dea_status file_fail(dea_error *error, const char *verb, const char *path, int number)
{
    return dea_fail(error, DEA_ERROR_IO, "cannot %s %s: %s", verb, path, strerror(number));
}

static void atomic_clear(dea_atomic *file)
{
    free(file->target);
    free(file->temporary);
    *file = (dea_atomic){.fd = -1};
}

/* Where a rename onto @p path must go so that a symbolic link stays one; malloc'd, NULL with errno. */
static char *target_resolve(const char *path)
{
    struct stat about;
    if (lstat(path, &about) == 0 && S_ISLNK(about.st_mode)) {
        return realpath(path, NULL);
    }
    return strdup(path);
}

/* Process that a file in a folder of targets was made by, 0 where it is none of ours. */
static pid_t maker_of(const char *name)
{
    long pid, moment;
    int number, length = 0;
    const bool ours = sscanf(name, ".deaspice-%ld-%ld-%d.part%n", &pid, &moment, &number, &length) == 3 && length > 0;
    return ours && name[length] == '\0' && pid > 0 && pid <= INT_MAX ? (pid_t)pid : 0;
}

/* Removes what killed runs left in a folder: files of this user whose maker is gone, here and, as nobody has them locked, on any
 * other machine. */
static void leftovers_remove(const char *path)
{
    DIR *folder = opendir(path);
    for (struct dirent *entry; folder && (entry = readdir(folder));) {
        struct stat about;
        const pid_t maker = maker_of(entry->d_name);
        if (maker == 0 || kill(maker, 0) == 0 || errno != ESRCH) {
            continue;
        }
        const int fd = openat(dirfd(folder), entry->d_name, O_RDWR | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
        if (fd >= 0 && fstat(fd, &about) == 0 && S_ISREG(about.st_mode) && about.st_uid == geteuid() &&
            flock(fd, LOCK_EX | LOCK_NB) == 0) {
            unlinkat(dirfd(folder), entry->d_name, 0);
        }
        if (fd >= 0) {
            close(fd);
        }
    }
    if (folder) {
        closedir(folder);
    }
}

/* Creates a new file in the folder of the target. */
static dea_status beside_open(dea_atomic *file, dea_error *error)
{
    const char *slash = strrchr(file->target, '/');
    const int folder = slash ? (int)(slash - file->target) + 1 : 0;
    const size_t room = (size_t)folder + 80;
    file->temporary = malloc(room);
    if (!file->temporary) {
        return dea_fail(error, DEA_ERROR_MEMORY, "out of memory");
    }
    snprintf(file->temporary, room, "%.*s", folder, file->target);
    leftovers_remove(folder > 0 ? file->temporary : ".");
    for (int i = 0; i < NAME_TRIES; i++) {
        struct timespec now = {0};
        clock_gettime(CLOCK_REALTIME, &now);
        snprintf(file->temporary, room, "%.*s.deaspice-%ld-%ld-%d.part", folder, file->target, (long)getpid(), now.tv_nsec, i);
        file->fd = open(file->temporary, O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
        if (file->fd >= 0) {
            (void)flock(file->fd, LOCK_EX | LOCK_NB); /* tells other machines that its maker is there */
            return DEA_OK;
        }
        if (errno != EEXIST) {
            break;
        }
    }
    const int number = errno;
    free(file->temporary);
    file->temporary = NULL;
    return file_fail(error, "write", file->target, number);
}

/* Opens the target itself: a pipe, a terminal, a device. */
static dea_status direct_open(dea_atomic *file, dea_error *error)
{
    file->direct = true;
    const bool standard = strcmp(file->target, "standard output") == 0 || strcmp(file->target, "/dev/stdout") == 0;
    file->fd = standard ? fcntl(STDOUT_FILENO, F_DUPFD_CLOEXEC, 0) : open(file->target, O_WRONLY | O_CLOEXEC);
    return file->fd >= 0 ? DEA_OK : file_fail(error, "write", file->target, errno);
}

static dea_status target_open(dea_atomic *file, const char *path, dea_error *error)
{
    struct stat about;
    const bool standard = strcmp(path, "-") == 0;
    const bool exists = !standard && stat(path, &about) == 0;
    if (*path == '\0') {
        return dea_fail(error, DEA_ERROR_IO, "cannot write a file without a name");
    }
    if (exists && S_ISDIR(about.st_mode)) {
        return file_fail(error, "write", path, EISDIR);
    }
    const bool direct = standard || strcmp(path, "/dev/stdout") == 0 || (exists && !S_ISREG(about.st_mode));
    file->target = standard ? strdup("standard output") : direct ? strdup(path) : target_resolve(path);
    if (!file->target) {
        return file_fail(error, "write", path, errno);
    }
    if (direct) {
        return direct_open(file, error);
    }
    if (exists && access(path, W_OK) != 0) {
        return file_fail(error, "write", path, errno);
    }
    return beside_open(file, error);
}

dea_status dea_atomic_open(dea_atomic *file, const char *path, dea_error *error)
{
    *file = (dea_atomic){.fd = -1};
    const dea_status status = target_open(file, path, error);
    if (status != DEA_OK) {
        atomic_clear(file);
    }
    return status;
}

dea_status dea_atomic_write(dea_atomic *file, const void *bytes, size_t size, dea_error *error)
{
    const char *next = bytes;
    while (size > 0) {
        const ssize_t written = write(file->fd, next, size);
        if (written < 0 && errno == EINTR) {
            continue;
        }
        if (written <= 0) {
            return file_fail(error, "write", file->target, written < 0 ? errno : EIO);
        }
        next += written;
        size -= (size_t)written;
    }
    return DEA_OK;
}

dea_status dea_atomic_close(dea_atomic *file, bool keep, dea_error *error)
{
    if (!file->target) {
        return DEA_OK;
    }
    int failed = 0;
    if (!file->direct && keep && fsync(file->fd) != 0 && errno != EINVAL) {
        failed = errno;
    }
    if (close(file->fd) != 0 && !failed && errno != EINTR) {
        failed = errno;
    }
    if (file->temporary) {
        if (keep && !failed && rename(file->temporary, file->target) != 0) {
            failed = errno;
        }
        if (!keep || failed) {
            unlink(file->temporary);
        }
    }
    const dea_status status = keep && failed ? file_fail(error, "write", file->target, failed) : DEA_OK;
    atomic_clear(file);
    return status;
}

dea_status dea_atomic_put(const char *path, const char *text, size_t length, dea_error *error)
{
    dea_atomic file;
    dea_status status = dea_atomic_open(&file, path, error);
    if (status != DEA_OK) {
        return status;
    }
    status = dea_atomic_write(&file, text, length, error);
    const dea_status closed = dea_atomic_close(&file, status == DEA_OK, status == DEA_OK ? error : NULL);
    return status != DEA_OK ? status : closed;
}
