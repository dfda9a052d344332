#include "netlist/part.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "netlist/symbol.h"
#include "support/atomic.h"
#include "support/memory_text.h"

enum { PATH_ROOM = 4096 };

static dea_status make_folder(const char *folder, dea_error *error)
{
    if (mkdir(folder, 0777) != 0 && errno != EEXIST) {
        return dea_fail(error, DEA_ERROR_IO, "%s: %s", folder, strerror(errno));
    }
    return DEA_OK;
}

/* Puts @p length bytes into folder/tool/name. */
static dea_status put_file(const char *folder, const char *tool, const char *name, const char *text, size_t length,
                           dea_error *error)
{
    char path[PATH_ROOM];
    dea_atomic file = {0};
    snprintf(path, sizeof path, "%s/%s", folder, tool);
    dea_status status = make_folder(path, error);
    if (status != DEA_OK) {
        return status;
    }
    if ((size_t)snprintf(path, sizeof path, "%s/%s/%s", folder, tool, name) >= sizeof path) {
        return dea_fail(error, DEA_ERROR_IO, "the name of the folder is too long");
    }
    status = dea_atomic_open(&file, path, error);
    status = status ? status : dea_atomic_write(&file, text, length, error);
    const dea_status closed = dea_atomic_close(&file, status == DEA_OK, status == DEA_OK ? error : NULL);
    return status == DEA_OK ? closed : status;
}

/* Ends a text and puts it on disk where it is whole. */
static dea_status close_memory(dea_memory_text *file, dea_status status, const char *folder, const char *tool, const char *name,
                               dea_error *error)
{
    status = dea_memory_text_end(file, status, error);
    status = status ? status : put_file(folder, tool, name, file->text, file->length, error);
    free(file->text);
    return status;
}

static dea_status write_parts(const char *folder, const char *tool, const dea_dialect *dialect, dea_error *error)
{
    dea_memory_text file;
    const dea_status status = dea_memory_text_begin(&file, error);
    if (status != DEA_OK) {
        return status;
    }
    return close_memory(&file, dea_part_library(dialect, file.out, error), folder, tool, "dea.lib", error);
}

/* Symbol number @p index of the library; false past the end. */
static bool symbol_at(size_t index, dea_symbol *symbol)
{
    size_t count = 0;
    for (size_t i = 0; i < dea_model_count(); i++) {
        for (int kind = DEA_DOT; kind <= DEA_LENS; kind++) {
            const dea_scene scene = dea_part_paper((dea_kind)kind);
            if (dea_symbol_of_part(&scene, dea_model_at(i), NULL, symbol) && count++ == index) {
                return true;
            }
        }
    }
    *symbol = index == count ? dea_symbol_spring(DEA_PART_PREFIX) : dea_symbol_lever(DEA_PART_PREFIX);
    return index < count + 2;
}

static dea_status write_kicad(const char *folder, dea_error *error)
{
    dea_memory_text file;
    dea_symbol symbol;
    const dea_status status = dea_memory_text_begin(&file, error);
    if (status != DEA_OK) {
        return status;
    }
    dea_symbol_kicad_begin(file.out);
    for (size_t i = 0; symbol_at(i, &symbol); i++) {
        dea_symbol_kicad(file.out, &symbol, "dea.lib");
    }
    dea_symbol_kicad_end(file.out);
    return close_memory(&file, DEA_OK, folder, "kicad", "dea.kicad_sym", error);
}

static dea_status write_ltspice(const char *folder, dea_error *error)
{
    dea_symbol symbol;
    dea_status status = DEA_OK;
    for (size_t i = 0; status == DEA_OK && symbol_at(i, &symbol); i++) {
        dea_memory_text file;
        char name[DEA_PART_TITLE + 8];
        status = dea_memory_text_begin(&file, error);
        if (status == DEA_OK) {
            snprintf(name, sizeof name, "%s.asy", symbol.name);
            dea_symbol_ltspice(file.out, &symbol, "dea.lib");
            status = close_memory(&file, DEA_OK, folder, "ltspice", name, error);
        }
    }
    return status;
}

dea_status dea_library_write(const char *folder, dea_error *error)
{
    dea_status status = make_folder(folder, error);
    for (size_t i = 0; status == DEA_OK && i < dea_dialect_count(); i++) {
        status = write_parts(folder, dea_dialect_at(i)->name, dea_dialect_at(i), error);
    }
    if (status == DEA_OK) {
        status = write_parts(folder, "kicad", dea_dialect_find("ngspice"), error); /* KiCad simulates with ngspice */
    }
    status = status ? status : write_kicad(folder, error);
    return status == DEA_OK ? write_ltspice(folder, error) : status;
}
