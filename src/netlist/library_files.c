#include "netlist/library_files.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "netlist/symbol.h"
#include "output/atomic.h"
#include "support/text.h"

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
    if (status == DEA_OK) {
        status = dea_atomic_write(&file, text, length, error);
    }
    const dea_status closed = dea_atomic_close(&file, status == DEA_OK, status == DEA_OK ? error : NULL);
    return status == DEA_OK ? closed : status;
}

/* A file in memory that is written to disk when it is whole. */
typedef struct memory_file {
    FILE *out;
    char *text;
    size_t length;
} memory_file;

static dea_status open_memory(memory_file *file, dea_error *error)
{
    *file = (memory_file){0};
    file->out = open_memstream(&file->text, &file->length);
    return file->out ? DEA_OK : dea_fail(error, DEA_ERROR_MEMORY, "out of memory while a library is written");
}

static dea_status close_memory(memory_file *file, dea_status status, const char *folder, const char *tool, const char *name,
                               dea_error *error)
{
    const bool whole = dea_text_close(file->out);
    if (status == DEA_OK && !whole) {
        status = dea_fail(error, DEA_ERROR_MEMORY, "out of memory while a library is written");
    }
    if (status == DEA_OK) {
        status = put_file(folder, tool, name, file->text, file->length, error);
    }
    free(file->text);
    return status;
}

static dea_status write_parts(const char *folder, const char *tool, const dea_dialect *dialect, dea_error *error)
{
    memory_file file;
    const dea_status status = open_memory(&file, error);
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
    memory_file file;
    dea_symbol symbol;
    const dea_status status = open_memory(&file, error);
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
        memory_file file;
        char name[DEA_PART_TITLE + 8];
        status = open_memory(&file, error);
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
    if (status == DEA_OK) {
        status = write_kicad(folder, error);
    }
    return status == DEA_OK ? write_ltspice(folder, error) : status;
}
