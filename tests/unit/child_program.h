/* The program in a child, in a folder of the test's own; DEASPICE names it, else build/deaspice. */
#ifndef DEA_TEST_CHILD_PROGRAM_H
#define DEA_TEST_CHILD_PROGRAM_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <fcntl.h>
#include <signal.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

enum { CHILD_WORDS = 40, CHILD_TEXT = 1 << 14 };

static char child_folder[64];
static char child_home[4096]; /* the project's folder */
static char child_path[4096];
static int child_status; /* exit status, or minus the signal */
static char child_out[CHILD_TEXT], child_err[CHILD_TEXT];

static inline void file_write(const char *name, const void *bytes, size_t size)
{
    FILE *file = fopen(name, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(bytes, 1, size, file), size);
    assert_int_equal(fclose(file), 0);
}

/* The whole file, NUL behind it; the caller frees it. */
static inline char *file_read(const char *name, size_t *size)
{
    FILE *file = fopen(name, "rb");
    if (!file) {
        fail_msg("%s is not there", name);
    }
    struct stat about;
    assert_int_equal(fstat(fileno(file), &about), 0);
    char *bytes = malloc((size_t)about.st_size + 1);
    assert_non_null(bytes);
    *size = fread(bytes, 1, (size_t)about.st_size, file);
    bytes[*size] = '\0';
    fclose(file);
    return bytes;
}

static inline bool file_exists(const char *name)
{
    struct stat about;
    return stat(name, &about) == 0;
}

static inline long file_size(const char *name)
{
    struct stat about;
    return stat(name, &about) == 0 ? (long)about.st_size : -1;
}

static inline bool same_bytes(const char *one, const char *other)
{
    size_t sizes[2];
    char *first = file_read(one, &sizes[0]), *second = file_read(other, &sizes[1]);
    const bool same = sizes[0] == sizes[1] && memcmp(first, second, sizes[0]) == 0;
    free(first);
    free(second);
    return same;
}

/* Starts the program with the words up to NULL; files may grow to @p most bytes, 0: without bound. */
static inline pid_t child_start(size_t most, const char *const *words)
{
    char *arguments[CHILD_WORDS] = {child_path};
    for (size_t i = 0; words[i]; i++) {
        assert_true(i + 2 < CHILD_WORDS);
        arguments[i + 1] = (char *)(uintptr_t)words[i];
    }
    const pid_t pid = fork();
    if (pid == 0) {
        signal(SIGINT, SIG_DFL); /* whoever runs the test in the background ignores them */
        signal(SIGHUP, SIG_DFL);
        signal(SIGXFSZ, SIG_IGN);
        dup2(open("/dev/null", O_RDONLY), STDIN_FILENO);
        dup2(open("out.txt", O_WRONLY | O_CREAT | O_TRUNC, 0600), STDOUT_FILENO);
        dup2(open("err.txt", O_WRONLY | O_CREAT | O_TRUNC, 0600), STDERR_FILENO);
        const struct rlimit limit = {most, most};
        if (most > 0 && setrlimit(RLIMIT_FSIZE, &limit) != 0) {
            _exit(126);
        }
        execv(child_path, arguments);
        _exit(127);
    }
    return pid;
}

static inline void text_of(const char *name, char text[CHILD_TEXT])
{
    size_t size;
    char *bytes = file_read(name, &size);
    snprintf(text, CHILD_TEXT, "%s", bytes);
    free(bytes);
}

static inline void child_wait(pid_t pid)
{
    int status;
    assert_int_equal(waitpid(pid, &status, 0), pid);
    child_status = WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
    text_of("out.txt", child_out);
    text_of("err.txt", child_err);
}

#define WORDS(...) ((const char *const[]){__VA_ARGS__, NULL})
#define RUN(...) child_wait(child_start(0, WORDS(__VA_ARGS__)))

static inline void check_done(int status, const char *file, int line)
{
    if (child_status != status) {
        print_error("exit status %d, wanted %d: %s\n", child_status, status, child_err);
        _fail(file, line);
    }
}

static inline void check_says(const char *words, const char *file, int line)
{
    if (!strstr(child_err, words)) {
        print_error("\"%s\" is not in \"%s\"\n", words, child_err);
        _fail(file, line);
    }
}

#define assert_status(status) check_done(status, __FILE__, __LINE__)
#define assert_says(words) check_says(words, __FILE__, __LINE__)

static inline int child_enter(void **state)
{
    (void)state;
    const char *given = getenv("DEASPICE");
    char *whole = realpath(given ? given : "build/deaspice", NULL);
    if (!whole || !getcwd(child_home, sizeof child_home)) {
        return -1;
    }
    snprintf(child_path, sizeof child_path, "%s", whole);
    free(whole);
    snprintf(child_folder, sizeof child_folder, "/tmp/deaspice-test-XXXXXX");
    return mkdtemp(child_folder) && chdir(child_folder) == 0 ? 0 : -1;
}

static inline int child_leave(void **state)
{
    (void)state;
    char command[128];
    snprintf(command, sizeof command, "rm -rf %s", child_folder);
    return chdir("/") == 0 && system(command) == 0 ? 0 : -1;
}

#endif
