/* The library is loaded when an engine needs it and not before: the core of SUNDIALS can bring an MPI along, which takes longer
 * to start than most runs. */
#include "engine/ida/sundials.h"

#include <dlfcn.h>
#include <stdio.h>

#if SUNDIALS_VERSION_MAJOR < 7
void dea_sundials_ignore(int code, const char *module, const char *function, char *message, void *user)
{
    (void)code, (void)module, (void)function, (void)message, (void)user;
}
#endif

#ifdef DEA_SUNDIALS /* names of the shared libraries, as string literals with commas between; without them it is linked in */

static const char *const files[] = {DEA_SUNDIALS};

enum { FILES = sizeof files / sizeof *files };

static void *symbol_find(void *const *handles, const char *name)
{
    void *found = NULL;
    for (size_t i = 0; i < FILES && !found; i++) {
        found = dlsym(handles[i], name);
    }
    return found;
}

#define DEA_TEXT(name) DEA_TEXT_OF(name)
#define DEA_TEXT_OF(name) #name

static dea_status table_fill(dea_sundials *sun, void **handles, dea_error *error)
{
    for (size_t i = 0; i < FILES; i++) {
        handles[i] = dlopen(files[i], RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE);
        if (!handles[i]) {
            return dea_fail(error, DEA_ERROR_MISSING, "the engine ida needs SUNDIALS %d: %s", SUNDIALS_VERSION_MAJOR, dlerror());
        }
    }
#define X(name)                                                                                                                  \
    *(void **)&sun->name = symbol_find(handles, DEA_TEXT(name));                                                                 \
    if (!sun->name) {                                                                                                            \
        return dea_fail(error, DEA_ERROR_MISSING, "this SUNDIALS has no " DEA_TEXT(name) ": it is not the one of the build");    \
    }
    DEA_SUNDIALS_LIST(X)
#undef X
    return DEA_OK;
}

#if SUNDIALS_VERSION_MAJOR < 7
static void *no_communicator(void *const *handles)
{
    (void)handles;
    return NULL;
}
#else
/* "No communicator" is a constant, or the address of a variable of the MPI library that came with SUNDIALS. */
static SUNComm no_communicator(void *const *handles)
{
#if SUNDIALS_MPI_ENABLED && defined(OMPI_PREDEFINED_GLOBAL)
    return (SUNComm)symbol_find(handles, "ompi_mpi_comm_null");
#else
    (void)handles;
    return SUN_COMM_NULL;
#endif
}
#endif

#else

enum { FILES = 1 };

static dea_status table_fill(dea_sundials *sun, void **handles, dea_error *error)
{
    (void)handles, (void)error;
#define X(name) sun->name = name;
    DEA_SUNDIALS_LIST(X)
#undef X
    return DEA_OK;
}

#if SUNDIALS_VERSION_MAJOR < 7
#define no_communicator(handles) NULL
#else
#define no_communicator(handles) SUN_COMM_NULL
#endif

#endif

/* Structures differ between major versions. */
static dea_status version_check(const dea_sundials *sun, dea_error *error)
{
    int major = 0, minor = 0, patch = 0;
    char label[16];
    if (sun->SUNDIALSGetVersionNumber(&major, &minor, &patch, label, (int)sizeof label) == 0 && major == SUNDIALS_VERSION_MAJOR) {
        return DEA_OK;
    }
    return dea_fail(error, DEA_ERROR_MISSING, "SUNDIALS %d.%d is installed, this program was built for SUNDIALS %d.%d", major,
                    minor, SUNDIALS_VERSION_MAJOR, SUNDIALS_VERSION_MINOR);
}

dea_status dea_sundials_open(dea_sundials *sun, dea_error *error)
{
    void *handles[FILES];
    *sun = (dea_sundials){0};
    dea_status status = table_fill(sun, handles, error);
    if (status == DEA_OK) {
        status = version_check(sun, error);
    }
    if (status == DEA_OK && sun->SUNContext_Create(no_communicator(handles), &sun->context) != 0) {
        status = dea_fail(error, DEA_ERROR_MEMORY, "SUNDIALS did not start");
    }
#if SUNDIALS_VERSION_MAJOR >= 7
    if (status == DEA_OK) {
        sun->SUNContext_ClearErrHandlers(sun->context);
    }
#endif
    return status;
}

void dea_sundials_close(dea_sundials *sun)
{
    if (sun->context) {
        sun->SUNContext_Free(&sun->context);
    }
}

const char *dea_sundials_version(char *text, size_t size)
{
    dea_sundials sun = {0};
    void *handles[FILES];
    if (table_fill(&sun, handles, NULL) != DEA_OK || sun.SUNDIALSGetVersion(text, (int)size) != 0) {
        snprintf(text, size, "%s", SUNDIALS_VERSION);
    }
    return text;
}
