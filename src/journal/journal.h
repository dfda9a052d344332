/* A journal: the finished blocks of a study, or of one shard of it, in the order in which they were finished. A run that is
 * killed goes on from it, and a finished one is the part of a study that a merge takes.
 *
 * The file has a header (magic, byte order, shard, cut, the study's identity as text) and then a record for each block: its
 * number, its points, their columns and states packed without gaps, and digests of head and points. A record that is not whole
 * is as if it were not there: what follows it is found by the next head. A block that has points which were lost, not refused by
 * the engine (dea_run_options.lost), is marked so, and counts as not computed; the record that a later run appends replaces it.
 *
 * What lasts: a record stands once dea_journal_append() returned, whatever becomes of the process (SIGKILL too). It is on the
 * disk, safe from a loss of power, 10 s later (at the next call of dea_journal_settle() or dea_journal_append()) and once the
 * journal ends; what such a loss leaves half written fails its digest, is cut off and computed again. */
#ifndef DEASPICE_JOURNAL_JOURNAL_H
#define DEASPICE_JOURNAL_JOURNAL_H

#include <stdint.h>

#include "deaspice/engine.h"
#include "engine/cut.h"

/* A shard of a study: a range of its blocks, so that a merge is a concatenation. */
typedef struct dea_shard {
    size_t number, count; /* 1 <= number <= count; {1, 1}: the whole study */
} dea_shard;

/* A range of points of the study, or of its blocks: first ... first + count - 1. */
typedef struct dea_stretch {
    size_t first, count;
} dea_stretch;

/* What journals of a study have in common. */
typedef struct dea_journal_study {
    const dea_scene *scene;
    dea_layout layout;
    dea_cut cut;
    size_t packed;  /* bytes of a point in a journal */
    char *identity; /* owned */
} dea_journal_study;

/* Prepares what the journals of a study need; scene and engine outlive it. Free with dea_journal_study_free(). */
dea_status dea_journal_study_make(const dea_scene *scene, const dea_engine *engine, dea_journal_study *study, dea_error *error);
/* Frees it; a zeroed one is fine. */
void dea_journal_study_free(dea_journal_study *study);
/* Blocks of a shard: numbers differ by one at most. */
dea_stretch dea_shard_blocks(const dea_journal_study *study, dea_shard shard);
/* Points of a shard. */
dea_stretch dea_shard_points(const dea_journal_study *study, dea_shard shard);

typedef struct dea_journal dea_journal;

/* What a journal holds. */
typedef struct dea_journal_content {
    dea_shard shard;  /* of the file */
    size_t points;    /* for good */
    size_t lost;      /* points whose block another run shall compute again */
    uint64_t cut;     /* bytes of a torn end that were cut off when it was opened */
    uint64_t damaged; /* bytes between its records that are none */
} dea_journal_content;

/* How a journal ends. */
typedef enum dea_journal_end {
    DEA_JOURNAL_STAYS,  /* to be gone on with; one without a name of its own is removed */
    DEA_JOURNAL_GOES,   /* its result is in place: removed */
    DEA_JOURNAL_IS_PART /* it takes the place of its target */
} dea_journal_end;

/* Opens the journal of that name and locks it, or creates it. What is in it is verified; a torn end is cut off. The study
 * outlives the journal, which the caller ends with dea_journal_close().
 * DEA_ERROR_USAGE: of another study or shard, or in use by another process; DEA_ERROR_IO: it cannot be read to its end. The file is
 * as it was. */
dea_status dea_journal_open(const dea_journal_study *study, dea_shard shard, const char *path, dea_journal **journal,
                            dea_error *error);
/* A new journal without a name, beside @p target. */
dea_status dea_journal_create(const dea_journal_study *study, dea_shard shard, const char *target, dea_journal **journal,
                              dea_error *error);
/* Opens a part to read it. Its records are found; their points are verified when they are read. Its shard is what the file says.
 * DEA_ERROR_USAGE: not a part, of another study, or damaged; the message names file and points. */
dea_status dea_journal_read(const dea_journal_study *study, const char *path, dea_journal **journal, dea_error *error);
/* What is in it. */
dea_journal_content dea_journal_tell(const dea_journal *journal);
/* True where the block belongs to the shard and is not in the journal for good. */
bool dea_journal_wants(const dea_journal *journal, size_t block);
/* DEA_OK where it has all points of its shard; else a message that names the first that are missing. */
dea_status dea_journal_complete(const dea_journal *journal, dea_error *error);
/* Appends the points of one whole block; @p lost: points of it are, so that another run shall compute it again. */
dea_status dea_journal_append(dea_journal *journal, size_t first, const void *points, size_t count, bool lost, dea_error *error);
/* Brings to the disk what has waited for 10 s; to be called now and then. A disk that fails is told by the next call that can. */
void dea_journal_settle(dea_journal *journal);
/* Hands the points of a complete journal to options->points in order, verified. progress and stop are used as in a run. */
dea_status dea_journal_replay(dea_journal *journal, const dea_run_options *options, dea_error *error);
/* Ends the journal and frees it, NULL is fine. @p target: what a part is called; NULL else. */
dea_status dea_journal_close(dea_journal *journal, dea_journal_end end, const char *target, dea_error *error);

/* ---- The parts of a study become its result again. */

/* Hands the points of all parts to options->points in order; options->stop ends it as interrupted. First all headers and places
 * of records are checked, then the points are verified as they come: one block of them is in memory, one file open at a time.
 * DEA_ERROR_USAGE: a part is missing, there twice, incomplete, damaged or of another study; the message names file and points. */
dea_status dea_merge_parts(const dea_journal_study *study, const char *const *paths, size_t count, const dea_run_options *options,
                           dea_error *error);

/* ---- All of a scene, its engine and their versions that decides the numbers of a study, as text: lines "name=value". Two studies
 * with the same text have the same numbers, bit by bit, on machines whose libraries compute alike. */

enum { DEA_IDENTITY_DIFFERENCE = 256 };

/* Writes the text into @p text, which the caller frees. @return DEA_OK, DEA_ERROR_MEMORY */
dea_status dea_identity_write(const dea_scene *scene, const dea_engine *engine, char **text, dea_error *error);
/* First difference of two texts, in words: "actuator.prestretch is 1.3 there and 1.2 here". */
void dea_identity_compare(const char *there, const char *here, char difference[DEA_IDENTITY_DIFFERENCE]);

#endif
