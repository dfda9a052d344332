#include "journal/journal.h"

#include <stdio.h>
#include <stdlib.h>

enum { LIST_ROOM = 200 };

typedef struct part {
    const char *path;
    dea_shard shard;
} part;

/* Opens a part and reads what it says of itself. */
static dea_status part_check(const dea_journal_study *study, part *checked, const dea_run_options *options, dea_error *error)
{
    dea_journal *journal;
    dea_status status = dea_journal_read(study, checked->path, &journal, error);
    if (status == DEA_OK) {
        checked->shard = dea_journal_tell(journal).shard;
        status = dea_journal_complete(journal, error);
        if (status == DEA_OK && dea_journal_tell(journal).lost > 0 && options->log) {
            char line[DEA_ERROR_LENGTH];
            snprintf(line, sizeof line, "%s: the blocks of %zu points lost their workers; run that shard again with --resume",
                     checked->path, dea_journal_tell(journal).lost);
            options->log(options->user, line);
        }
        dea_journal_close(journal, DEA_JOURNAL_STAYS, NULL, NULL);
    }
    return status;
}

static int compare_parts(const void *a, const void *b)
{
    const part *one = a, *other = b;
    return one->shard.number < other->shard.number ? -1 : one->shard.number > other->shard.number;
}

/* "3", "17 to 19": the missing shards below @p below, from @p from on. */
static void list_missing(char list[LIST_ROOM], size_t *used, size_t from, size_t below)
{
    if (from >= below || *used >= LIST_ROOM) {
        return;
    }
    const char *between = *used > 0 ? ", " : "";
    *used += (size_t)(below - from > 1 ? snprintf(list + *used, LIST_ROOM - *used, "%s%zu-%zu", between, from, below - 1)
                                       : snprintf(list + *used, LIST_ROOM - *used, "%s%zu", between, from));
}

/* Are the sorted parts all shards, each once? */
static dea_status parts_fit(const dea_journal_study *study, const part *parts, size_t count, dea_error *error)
{
    char list[LIST_ROOM] = "";
    size_t used = 0, next = 1;
    dea_shard missing = {0, parts->shard.count};
    for (size_t i = 0; i < count; i++) {
        const dea_shard shard = parts[i].shard;
        const dea_stretch points = dea_shard_points(study, shard);
        if (shard.count != parts->shard.count) {
            return dea_fail(error, DEA_ERROR_USAGE, "%s is shard %zu/%zu, but %s is %zu/%zu: they are of different divisions",
                            parts[i].path, shard.number, shard.count, parts->path, parts->shard.number, parts->shard.count);
        }
        if (i > 0 && shard.number == parts[i - 1].shard.number) {
            return dea_fail(error, DEA_ERROR_USAGE, "%s and %s are both shard %zu/%zu: points %zu to %zu are there twice",
                            parts[i - 1].path, parts[i].path, shard.number, shard.count, points.first,
                            points.first + points.count - (points.count > 0));
        }
        list_missing(list, &used, next, shard.number);
        missing.number = missing.number == 0 && next < shard.number ? next : missing.number;
        next = shard.number + 1;
    }
    list_missing(list, &used, next, parts->shard.count + 1);
    missing.number = missing.number == 0 && next <= parts->shard.count ? next : missing.number;
    if (missing.number == 0) {
        return DEA_OK;
    }
    const dea_stretch points = dea_shard_points(study, missing);
    return dea_fail(error, DEA_ERROR_USAGE, "no part is shard %s%s of %zu; shard %zu has points %zu to %zu", list,
                    used >= LIST_ROOM ? "..." : "", missing.count, missing.number, points.first,
                    points.first + points.count - (points.count > 0));
}

static dea_status part_replay(const dea_journal_study *study, const part *replayed, const dea_run_options *options,
                              dea_error *error)
{
    dea_journal *journal;
    dea_status status = dea_journal_read(study, replayed->path, &journal, error);
    if (status != DEA_OK) {
        return status;
    }
    if (dea_journal_tell(journal).shard.number != replayed->shard.number ||
        dea_journal_tell(journal).shard.count != replayed->shard.count) {
        status = dea_fail(error, DEA_ERROR_IO, "%s has changed while it was read", replayed->path);
    } else {
        status = dea_journal_replay(journal, options, error);
    }
    dea_journal_close(journal, DEA_JOURNAL_STAYS, NULL, NULL);
    return status;
}

dea_status dea_merge_parts(const dea_journal_study *study, const char *const *paths, size_t count, const dea_run_options *options,
                           dea_error *error)
{
    dea_status status = DEA_OK;
    part *parts = calloc(count + 1, sizeof *parts);
    if (!parts) {
        return dea_fail(error, DEA_ERROR_MEMORY, "out of memory");
    }
    for (size_t i = 0; i < count && status == DEA_OK; i++) {
        parts[i].path = paths[i];
        status = part_check(study, &parts[i], options, error);
    }
    if (status == DEA_OK) {
        qsort(parts, count, sizeof *parts, compare_parts);
        status = parts_fit(study, parts, count, error);
    }
    for (size_t i = 0; i < count && status == DEA_OK; i++) {
        status = part_replay(study, &parts[i], options, error);
    }
    free(parts);
    return status;
}
