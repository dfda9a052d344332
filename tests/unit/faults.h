/* Calls of the program's own objects that can be made to fail: the linker puts __wrap_x in the place of x in them (--wrap, see the
 * Makefile, which reads the names from this file), and leaves foreign libraries alone. Memory, files, processes, engines. */
#ifndef DEA_TEST_FAULTS_H
#define DEA_TEST_FAULTS_H

#include <errno.h>
#include <dlfcn.h>
#include <execinfo.h>
#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

#include <ida/ida.h>
#include <arkode/arkode_arkstep.h>
#include <kinsol/kinsol.h>
#include <libfyaml.h>
#include <ngspice/sharedspice.h>
#include <nvector/nvector_serial.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <udunits2.h>

enum { FAULT_ROLES = 3, FAULT_CALLS = 1 << 15, FAULT_DEPTH = 10 };

/* What a run without faults called, by process: 0 is the program, n its n-th fork. Shared with the children. */
typedef struct fault_record {
    size_t counts[FAULT_ROLES];
    uint64_t stacks[FAULT_ROLES][FAULT_CALLS]; /* of the call: a digest of the return addresses */
    char failed[64];                           /* name of the last call that was made to fail */
} fault_record;

/* State of one process. */
static struct {
    bool armed;
    bool persistent;      /* all calls from the target on fail, else it alone */
    size_t role, forks;   /* of this process */
    size_t count;         /* calls so far */
    size_t wanted_role;   /* process in which */
    size_t target;        /* this call fails, counted from 1; 0: none */
    bool recorded;        /* calls are recorded */
    fault_record *record;
} fault;

static inline uint64_t fault_stack(void)
{
    void *frames[FAULT_DEPTH];
    uint64_t digest = 14695981039346656037U;
    const int depth = backtrace(frames, FAULT_DEPTH);
    for (int i = 0; i < depth; i++) {
        digest = (digest ^ (uint64_t)(uintptr_t)frames[i]) * 1099511628211U;
    }
    return digest;
}

/* True where this call is to fail. */
static inline bool fault_due(const char *name, int number)
{
    if (!fault.armed) {
        return false;
    }
    fault.count++;
    if (fault.recorded && fault.role < FAULT_ROLES && fault.count <= FAULT_CALLS) {
        fault.record->counts[fault.role] = fault.count;
        fault.record->stacks[fault.role][fault.count - 1] = fault_stack();
    }
    const bool due = fault.target > 0 && fault.role == fault.wanted_role &&
                     (fault.count == fault.target || (fault.persistent && fault.count > fault.target));
    if (due) {
        snprintf(fault.record->failed, sizeof fault.record->failed, "%s", name);
        errno = number;
    }
    return due;
}

#define FAULT_CALL(name, type, parameters, arguments, value, number) \
    type __real_##name parameters;                                   \
    type __wrap_##name parameters;                                   \
    type __wrap_##name parameters                                    \
    {                                                                \
        return fault_due(#name, number) ? value : __real_##name arguments;  \
    }

/* memory */
FAULT_CALL(malloc, void *, (size_t size), (size), NULL, ENOMEM)
FAULT_CALL(calloc, void *, (size_t count, size_t size), (count, size), NULL, ENOMEM)
FAULT_CALL(realloc, void *, (void *old, size_t size), (old, size), NULL, ENOMEM)
FAULT_CALL(strdup, char *, (const char *text), (text), NULL, ENOMEM)
FAULT_CALL(strndup, char *, (const char *text, size_t size), (text, size), NULL, ENOMEM)
FAULT_CALL(open_memstream, FILE *, (char **text, size_t *size), (text, size), NULL, ENOMEM)
FAULT_CALL(mmap, void *, (void *at, size_t size, int protection, int flags, int fd, off_t offset),
           (at, size, protection, flags, fd, offset), MAP_FAILED, ENOMEM)
FAULT_CALL(realpath, char *, (const char *path, char *whole), (path, whole), NULL, ENOMEM)

/* files */
FAULT_CALL(fopen, FILE *, (const char *path, const char *mode), (path, mode), NULL, EMFILE)
FAULT_CALL(tmpfile, FILE *, (void), (), NULL, ENOSPC)
FAULT_CALL(fflush, int, (FILE *file), (file), EOF, ENOSPC)
FAULT_CALL(fseek, int, (FILE *file, long offset, int whence), (file, offset, whence), -1, EIO)
FAULT_CALL(read, ssize_t, (int fd, void *bytes, size_t size), (fd, bytes, size), -1, EIO)
FAULT_CALL(pread, ssize_t, (int fd, void *bytes, size_t size, off_t at), (fd, bytes, size, at), -1, EIO)
FAULT_CALL(write, ssize_t, (int fd, const void *bytes, size_t size), (fd, bytes, size), -1, ENOSPC)
FAULT_CALL(pwrite, ssize_t, (int fd, const void *bytes, size_t size, off_t at), (fd, bytes, size, at), -1, ENOSPC)
FAULT_CALL(fsync, int, (int fd), (fd), -1, EIO)
FAULT_CALL(fdatasync, int, (int fd), (fd), -1, EIO)
FAULT_CALL(ftruncate, int, (int fd, off_t size), (fd, size), -1, EIO)
FAULT_CALL(rename, int, (const char *from, const char *to), (from, to), -1, EIO)
FAULT_CALL(mkdtemp, char *, (char *path), (path), NULL, ENOSPC)
FAULT_CALL(mkdir, int, (const char *path, mode_t mode), (path, mode), -1, ENOSPC)
FAULT_CALL(chdir, int, (const char *path), (path), -1, EIO)
FAULT_CALL(flock, int, (int fd, int operation), (fd, operation), -1, ENOLCK)
FAULT_CALL(fstat, int, (int fd, struct stat *about), (fd, about), -1, EIO)
FAULT_CALL(dup2, int, (int from, int to), (from, to), -1, EIO)

enum { FAULT_FERROR = 0x20 }; /* what makes ferror() true in the GNU C library */

size_t __real_fread(void *bytes, size_t size, size_t count, FILE *file);
size_t __wrap_fread(void *bytes, size_t size, size_t count, FILE *file);
size_t __wrap_fread(void *bytes, size_t size, size_t count, FILE *file)
{
    if (!fault_due("fread", EIO)) {
        return __real_fread(bytes, size, count, file);
    }
    file->_flags |= FAULT_FERROR;
    return 0;
}

/* Messages are the way in which faults are told. */
size_t __real_fwrite(const void *bytes, size_t size, size_t count, FILE *file);
size_t __wrap_fwrite(const void *bytes, size_t size, size_t count, FILE *file);
size_t __wrap_fwrite(const void *bytes, size_t size, size_t count, FILE *file)
{
    if (file == stderr || file == stdout || !fault_due("fwrite", ENOSPC)) {
        return __real_fwrite(bytes, size, count, file);
    }
    file->_flags |= FAULT_FERROR;
    return 0;
}

/* They have released what they hold all the same. */
int __real_fclose(FILE *file);
int __wrap_fclose(FILE *file);
int __wrap_fclose(FILE *file)
{
    const bool due = fault_due("fclose", ENOSPC);
    const int status = __real_fclose(file);
    errno = due ? ENOSPC : errno;
    return due ? EOF : status;
}

int __real_close(int fd);
int __wrap_close(int fd);
int __wrap_close(int fd)
{
    const bool due = fault_due("close", EIO);
    const int status = __real_close(fd);
    errno = due ? EIO : errno;
    return due ? -1 : status;
}

int __real_open(const char *path, int flags, ...);
int __wrap_open(const char *path, int flags, ...);
int __wrap_open(const char *path, int flags, ...)
{
    va_list list;
    va_start(list, flags);
    const mode_t mode = flags & O_CREAT ? va_arg(list, mode_t) : 0;
    va_end(list);
    return fault_due("open", EMFILE) ? -1 : __real_open(path, flags, mode);
}

/* processes */
FAULT_CALL(pipe2, int, (int ends[2], int flags), (ends, flags), -1, EMFILE)
FAULT_CALL(socketpair, int, (int domain, int type, int protocol, int ends[2]), (domain, type, protocol, ends), -1, EMFILE)
FAULT_CALL(send, ssize_t, (int fd, const void *bytes, size_t size, int flags), (fd, bytes, size, flags), -1, ECONNRESET)
FAULT_CALL(recv, ssize_t, (int fd, void *bytes, size_t size, int flags), (fd, bytes, size, flags), -1, ECONNRESET)
FAULT_CALL(posix_spawn_file_actions_init, int, (posix_spawn_file_actions_t * actions), (actions), ENOMEM, ENOMEM)
FAULT_CALL(posix_spawn_file_actions_adddup2, int, (posix_spawn_file_actions_t * actions, int from, int to), (actions, from, to),
           ENOMEM, ENOMEM)
FAULT_CALL(posix_spawnp, int,
           (pid_t * pid, const char *file, const posix_spawn_file_actions_t *actions, const posix_spawnattr_t *attributes,
            char *const arguments[], char *const environment[]),
           (pid, file, actions, attributes, arguments, environment), EAGAIN, EAGAIN)

pid_t __real_fork(void);
pid_t __wrap_fork(void);
pid_t __wrap_fork(void)
{
    if (fault_due("fork", EAGAIN)) {
        return -1;
    }
    fault.forks++;
    const pid_t pid = __real_fork();
    if (pid == 0) {
        fault.role = fault.forks;
        fault.count = 0;
    }
    return pid;
}

/* engines and readers; 1 and -1 are failures in all of them */
FAULT_CALL(ngSpice_Init, int,
           (SendChar * line, SendStat *status, ControlledExit *ended, SendData *data, SendInitData *first, BGThreadRunning *thread,
            void *user),
           (line, status, ended, data, first, thread, user), 1, ENOMEM)
FAULT_CALL(ngSpice_Circ, int, (char **cards), (cards), 1, ENOMEM)
FAULT_CALL(ngSpice_Command, int, (char *command), (command), 1, ENOMEM)
FAULT_CALL(ngSpice_CurPlot, char *, (void), (), NULL, ENOMEM)
FAULT_CALL(ngSpice_AllVecs, char **, (char *plot), (plot), NULL, ENOMEM)
FAULT_CALL(ngGet_Vec_Info, pvector_info, (char *name), (name), NULL, ENOMEM)
FAULT_CALL(dlopen, void *, (const char *name, int flags), (name, flags), NULL, ENOENT)
FAULT_CALL(ut_new_system, ut_system *, (void), (), NULL, ENOMEM)
FAULT_CALL(ut_read_xml, ut_system *, (const char *path), (path), NULL, ENOMEM)
FAULT_CALL(ut_new_base_unit, ut_unit *, (ut_system * system), (system), NULL, ENOMEM)
FAULT_CALL(ut_parse, ut_unit *, (const ut_system *system, const char *text, ut_encoding encoding), (system, text, encoding), NULL,
           ENOMEM)
FAULT_CALL(ut_scale, ut_unit *, (double factor, const ut_unit *unit), (factor, unit), NULL, ENOMEM)
FAULT_CALL(ut_get_converter, cv_converter *, (ut_unit * from, ut_unit *to), (from, to), NULL, ENOMEM)
FAULT_CALL(fy_diag_create, struct fy_diag *, (const struct fy_diag_cfg *settings), (settings), NULL, ENOMEM)
FAULT_CALL(fy_parser_create, struct fy_parser *, (const struct fy_parse_cfg *settings), (settings), NULL, ENOMEM)
FAULT_CALL(fy_parser_set_string, int, (struct fy_parser * parser, const char *text, size_t size), (parser, text, size), -1, ENOMEM)
FAULT_CALL(fy_parser_parse, struct fy_event *, (struct fy_parser * parser), (parser), NULL, ENOMEM)
FAULT_CALL(fy_token_get_text, const char *, (struct fy_token * token, size_t *size), (token, size), NULL, ENOMEM)

/* Functions of libraries that are loaded while the program runs get their substitutes from dlsym(). */
#define FAULT_LOADED(name, type, parameters, arguments, value, number)      \
    static type(*loaded_##name) parameters;                                 \
    static type failing_##name parameters                                   \
    {                                                                       \
        return fault_due(#name, number) ? value : loaded_##name arguments;  \
    }

FAULT_LOADED(N_VNew_Serial, N_Vector, (sunindextype length, SUNContext context), (length, context), NULL, ENOMEM)
FAULT_LOADED(N_VClone, N_Vector, (N_Vector vector), (vector), NULL, ENOMEM)
FAULT_LOADED(SUNDenseMatrix, SUNMatrix, (sunindextype rows, sunindextype columns, SUNContext context), (rows, columns, context), NULL,
           ENOMEM)
FAULT_LOADED(SUNLinSol_Dense, SUNLinearSolver, (N_Vector vector, SUNMatrix matrix, SUNContext context), (vector, matrix, context),
           NULL, ENOMEM)
FAULT_LOADED(IDACreate, void *, (SUNContext context), (context), NULL, ENOMEM)
FAULT_LOADED(IDASetUserData, int, (void *memory, void *user), (memory, user), -1, ENOMEM)
FAULT_LOADED(IDASetLinearSolver, int, (void *memory, SUNLinearSolver solver, SUNMatrix matrix), (memory, solver, matrix), -1, ENOMEM)
FAULT_LOADED(IDASolve, int, (void *memory, double until, double *at, N_Vector y, N_Vector slope, int task),
           (memory, until, at, y, slope, task), -1, ENOMEM)
FAULT_LOADED(IDACalcIC, int, (void *memory, int kind, double until), (memory, kind, until), -1, ENOMEM)
FAULT_LOADED(ARKStepEvolve, int, (void *memory, double until, N_Vector y, double *at, int task), (memory, until, y, at, task), -1,
           ENOMEM)
FAULT_LOADED(KINCreate, void *, (SUNContext context), (context), NULL, ENOMEM)
FAULT_LOADED(KINSol, int, (void *memory, N_Vector u, int strategy, N_Vector scale, N_Vector weight),
           (memory, u, strategy, scale, weight), -1, ENOMEM)

#define FAULT_LOADED_LIST(X) \
    X(N_VNew_Serial) X(N_VClone) X(SUNDenseMatrix) X(SUNLinSol_Dense) X(IDACreate) X(IDASetUserData) \
    X(IDASetLinearSolver) X(IDASolve) X(IDACalcIC) X(ARKStepEvolve) X(KINCreate) X(KINSol)

void *__real_dlsym(void *library, const char *name);
void *__wrap_dlsym(void *library, const char *name);
void *__wrap_dlsym(void *library, const char *name)
{
#define X(known) {#known, (void **)&loaded_##known, (void *)(uintptr_t)failing_##known},
    static const struct {
        const char *name;
        void **loaded, *failing;
    } list[] = {
        FAULT_LOADED_LIST(X)
    };
#undef X
    void *found = fault_due("dlsym", ENOENT) ? NULL : __real_dlsym(library, name);
    for (size_t i = 0; i < sizeof list / sizeof *list && found; i++) {
        if (strcmp(list[i].name, name) == 0) {
            *list[i].loaded = found;
            return list[i].failing;
        }
    }
    return found;
}

#endif
