/** @file status.h
 * Status codes and the error that a caller owns. The library never prints and never exits.
 */
#ifndef DEASPICE_STATUS_H
#define DEASPICE_STATUS_H

#include <stdbool.h>
#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

#if defined(__GNUC__)
#define DEA_API __attribute__((visibility("default")))
#define DEA_PRINTF(text, first) __attribute__((__format__(__printf__, text, first)))
#else
#define DEA_API
#define DEA_PRINTF(text, first)
#endif

/** The one list of status codes: name, value, text. 0 is fine, < 0 is a failure. */
#define DEA_STATUS_LIST(X)                                        \
    X(DEA_OK, 0, "done")                                          \
    X(DEA_ERROR_SCENE, -1, "the scene is not valid")              \
    X(DEA_ERROR_USAGE, -2, "the call is not valid")               \
    X(DEA_ERROR_UNSUPPORTED, -3, "this engine cannot do that")    \
    X(DEA_ERROR_ENGINE, -4, "the engine failed")                  \
    X(DEA_ERROR_IO, -5, "a file could not be read or written")    \
    X(DEA_ERROR_MEMORY, -6, "out of memory")                      \
    X(DEA_ERROR_INTERRUPTED, -7, "interrupted")                   \
    X(DEA_ERROR_DISAGREE, -8, "the engines disagree")             \
    X(DEA_ERROR_MISSING, -9, "a program or library is not installed") \
    X(DEA_ERROR_DATA, -10, "the data give no result")

typedef enum dea_status {
#define X(name, value, text) name = value,
    DEA_STATUS_LIST(X)
#undef X
} dea_status;

/** Room for one message, and for the log that an engine hands over with it. */
enum { DEA_ERROR_LENGTH = 4096, DEA_EXCERPT_LENGTH = 1024 };

/** What went wrong, owned by the caller; `message` is empty while `status` is DEA_OK. */
typedef struct dea_error {
    dea_status status;
    char message[DEA_ERROR_LENGTH];   /**< UTF-8, one or more lines, no final line break */
    char excerpt[DEA_EXCERPT_LENGTH]; /**< of a bad scene or material: the source line, and a caret under the place; may be empty */
} dea_error;

/** Text of a status code; never NULL. */
DEA_API const char *dea_status_text(dea_status status);

/** Fills @p error (which may be NULL) and returns @p status, so that `return dea_fail(...)` reads as one step. */
DEA_API dea_status dea_fail(dea_error *error, dea_status status, const char *format, ...) DEA_PRINTF(3, 4);

#ifdef __cplusplus
}
#endif
#endif
