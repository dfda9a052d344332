#include "support/file.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

struct dea_file_entry {
    dev_t device; /* of the file, or of the folder in which it will be */
    ino_t inode;
    char *within; /* its name in that folder, NULL: it is there; owned */
    char *name;   /* for messages; owned */
    bool target;
};

static dea_status no_memory(dea_error *error)
{
    return dea_fail(error, DEA_ERROR_MEMORY, "out of memory");
}

static void entry_free(dea_file_entry *entry)
{
    free(entry->within);
    free(entry->name);
}

/* Takes over the entry, also on failure. */
static dea_status entry_add(dea_files *files, dea_file_entry *entry, dea_error *error)
{
    dea_file_entry *grown = entry->name ? realloc(files->entries, (files->count + 1) * sizeof *grown) : NULL;
    if (!grown) {
        entry_free(entry);
        return no_memory(error);
    }
    files->entries = grown;
    files->entries[files->count++] = *entry;
    return DEA_OK;
}

dea_status dea_files_note(dea_files *files, const char *name, const struct stat *about, dea_error *error)
{
    if (!S_ISREG(about->st_mode)) {
        return DEA_OK;
    }
    dea_file_entry entry = {.device = about->st_dev, .inode = about->st_ino, .name = strdup(name)};
    return entry_add(files, &entry, error);
}

dea_status dea_files_note_path(dea_files *files, const char *path, dea_error *error)
{
    struct stat about;
    const bool standard = strcmp(path, "-") == 0;
    const int there = standard ? fstat(STDIN_FILENO, &about) : stat(path, &about);
    return there == 0 ? dea_files_note(files, standard ? "standard input" : path, &about, error) : DEA_OK;
}

/* Finds where a target is or will be; @p lies is false for what no file can be lost by: pipes, devices, folders that are not
 * there. */
static dea_status target_place(const char *path, dea_file_entry *entry, bool *lies, dea_error *error)
{
    struct stat about = {0};
    const bool standard = strcmp(path, "-") == 0;
    const bool there = (standard ? fstat(STDOUT_FILENO, &about) : stat(path, &about)) == 0;
    const char *slash = strrchr(path, '/');
    char *folder = slash ? strndup(path, (size_t)(slash - path) + 1) : strdup(".");
    const bool begun = folder && !there && !standard && stat(folder, &about) == 0;
    *entry = (dea_file_entry){.device = about.st_dev, .inode = about.st_ino, .target = true};
    entry->within = begun ? strdup(slash ? slash + 1 : path) : NULL;
    *lies = begun || (there && S_ISREG(about.st_mode));
    const bool sound = folder && (!begun || entry->within);
    free(folder);
    return sound ? DEA_OK : no_memory(error);
}

static bool same_place(const dea_file_entry *one, const dea_file_entry *other)
{
    const bool both = one->within && other->within;
    return one->device == other->device && one->inode == other->inode &&
           (both ? strcmp(one->within, other->within) == 0 : !one->within && !other->within);
}

static dea_status fail_same(const char *path, const dea_file_entry *other, dea_error *error)
{
    const char *shown = strcmp(path, "-") == 0 ? "standard output" : path;
    if (other->target) {
        return dea_fail(error, DEA_ERROR_USAGE, "%.400s and %.400s, two targets, are the same file", other->name, shown);
    }
    return dea_fail(error, DEA_ERROR_USAGE,
                    "%.400s would overwrite %.400s, an input: it is the same file; choose another target, or give --force", shown,
                    other->name);
}

dea_status dea_files_target(dea_files *files, const char *path, bool force, dea_error *error)
{
    dea_file_entry entry;
    bool lies;
    const dea_status status = target_place(path, &entry, &lies, error);
    if (status != DEA_OK || !lies) {
        return status;
    }
    for (size_t i = 0; i < files->count; i++) {
        const dea_file_entry *other = &files->entries[i];
        if (same_place(&entry, other) && (other->target || !force)) {
            entry_free(&entry);
            return fail_same(path, other, error);
        }
    }
    entry.name = strdup(path);
    return entry_add(files, &entry, error);
}

void dea_files_free(dea_files *files)
{
    for (size_t i = 0; i < files->count; i++) {
        entry_free(&files->entries[i]);
    }
    free(files->entries);
    *files = (dea_files){0};
}
