#include "journal/journal.h"

#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#include "journal/stream.h"
#include "support/atomic.h"
#include "support/clock.h"

enum { IDENTITY_MOST = 1 << 20, LOCK_TRIES = 50, LOCK_WAIT_MS = 20, ROW_MOST = DEA_LAYOUT_COLUMNS * sizeof(double) + 1 };

static const char journal_magic[] = "deaspice part 1\n"; /* its NUL is not written */
static const uint64_t byte_order = UINT64_C(0x0102030405060708);
static const uint64_t other_byte_order = UINT64_C(0x0807060504030201);
static const uint64_t record_mark = UINT64_C(0x6b636f6c62616564); /* "deablock" */
static const uint64_t lost_mark = UINT64_C(0x2174736f6c616564);   /* "dealost!" */
static const double sync_interval = 10.0;                         /* [s] */

/* Begin of the file; the identity follows. */
typedef struct journal_head {
    char magic[16];
    uint64_t order;
    uint64_t identity;              /* bytes of it */
    uint64_t number, count;         /* shard */
    uint64_t points, block, packed; /* of the study, of a block, bytes of a point */
    uint64_t digest;                /* of all before and of the identity */
} journal_head;

/* Begin of a record; its points follow, then a digest of head and points. */
typedef struct record_head {
    uint64_t mark; /* of a record; lost_mark: points of it were lost, and another run shall compute the block again */
    uint64_t block;
    uint64_t count;  /* points */
    uint64_t digest; /* of all before */
} record_head;

/* What the journal has of a block. */
typedef struct kept_block {
    uint64_t place; /* of its last record, 0: none */
    bool lost;      /* that has the lost_mark */
} kept_block;

struct dea_journal {
    const dea_journal_study *study;
    dea_shard shard;
    dea_stretch blocks; /* of the shard */
    int fd;
    char *path;          /* for messages too; owned */
    bool named;          /* a file of its own, which stays; else what follows */
    bool open;           /* named, locked, and of this study */
    dea_atomic file;     /* that becomes its target */
    uint64_t end;        /* of the last whole record */
    uint64_t cut;        /* bytes behind it that were cut off */
    uint64_t damaged;    /* bytes before it that are no record */
    uint64_t damage;     /* place of the first of those */
    size_t points;       /* in it, for good */
    size_t lost;         /* in blocks that another run shall compute again */
    kept_block *kept;    /* of the shard's blocks; owned */
    unsigned char *room; /* buffer of streams; owned */
    double waiting;      /* since when a record has waited for the disk [s], 0: none does */
    int broken;          /* errno of the disk that did not take one, 0: fine */
};

static dea_status fail_io(dea_error *error, const char *verb, const char *path)
{
    return dea_fail(error, DEA_ERROR_IO, "cannot %s %s: %s", verb, path, strerror(errno));
}

/* ---- studies and shards ---- */

dea_status dea_journal_study_make(const dea_scene *scene, const dea_engine *engine, dea_journal_study *study, dea_error *error)
{
    *study = (dea_journal_study){.scene = scene, .layout = dea_layout_of(scene)};
    const dea_layout *layout = &study->layout;
    study->packed =
        layout->rows * (layout->column_count * sizeof(double) + 1) + layout->point_size - layout->rows * layout->row_size;
    const dea_status status = dea_cut_make(scene, engine, &study->cut, error);
    return status == DEA_OK ? dea_identity_write(scene, engine, &study->identity, error) : status;
}

void dea_journal_study_free(dea_journal_study *study)
{
    free(study->identity);
    study->identity = NULL;
}

dea_stretch dea_shard_blocks(const dea_journal_study *study, dea_shard shard)
{
    const size_t share = study->cut.blocks / shard.count, more = study->cut.blocks % shard.count, before = shard.number - 1;
    return (dea_stretch){before * share + (before < more ? before : more), share + (before < more ? 1 : 0)};
}

/* Points of a range of blocks. */
static dea_stretch points_of(const dea_journal_study *study, dea_stretch blocks)
{
    if (blocks.count == 0) {
        return (dea_stretch){0, 0};
    }
    const dea_range first = dea_cut_range(&study->cut, blocks.first);
    const dea_range last = dea_cut_range(&study->cut, blocks.first + blocks.count - 1);
    return (dea_stretch){first.place, last.place + last.count - first.place};
}

dea_stretch dea_shard_points(const dea_journal_study *study, dea_shard shard)
{
    return points_of(study, dea_shard_blocks(study, shard));
}

/* ---- header ---- */

static uint64_t head_digest(const journal_head *head, const char *identity)
{
    dea_digest digest = dea_digest_begin();
    dea_digest_take(&digest, head, offsetof(journal_head, digest));
    dea_digest_take(&digest, identity, head->identity);
    return dea_digest_end(&digest);
}

static journal_head head_of(const dea_journal *journal)
{
    const dea_journal_study *study = journal->study;
    journal_head head = {.order = byte_order,
                         .identity = strlen(study->identity),
                         .number = journal->shard.number,
                         .count = journal->shard.count,
                         .points = study->cut.total,
                         .block = study->cut.block,
                         .packed = study->packed};
    memcpy(head.magic, journal_magic, sizeof head.magic);
    head.digest = head_digest(&head, study->identity);
    return head;
}

static dea_status head_write(dea_journal *journal, dea_error *error)
{
    const journal_head head = head_of(journal);
    dea_stream out = dea_stream_begin(journal->fd, 0, journal->room);
    if (ftruncate(journal->fd, 0) != 0 || !dea_stream_put(&out, &head, sizeof head) ||
        !dea_stream_put(&out, journal->study->identity, head.identity) || !dea_stream_flush(&out)) {
        return fail_io(error, "write", journal->path);
    }
    journal->end = out.at;
    return DEA_OK;
}

/* True where the file is the begin of the header that this journal would write: the process that wrote it was killed there. */
static bool head_is_torn(const dea_journal *journal, uint64_t size)
{
    const journal_head head = head_of(journal);
    const char *identity = journal->study->identity;
    dea_stream in = dea_stream_begin(journal->fd, 0, journal->room);
    if (size >= sizeof head + head.identity) {
        return false;
    }
    for (uint64_t at = 0; at < size; at++) {
        char byte;
        const char wanted = at < sizeof head ? ((const char *)&head)[at] : identity[at - sizeof head];
        if (!dea_stream_get(&in, &byte, 1) || byte != wanted) {
            return false;
        }
    }
    return true;
}

/* What @p head says of itself, apart from the study. */
static dea_status head_check(const dea_journal *journal, const journal_head *head, dea_error *error)
{
    if (memcmp(head->magic, journal_magic, sizeof head->magic) != 0) {
        return dea_fail(error, DEA_ERROR_USAGE, "%s is no part of a study that deaspice wrote", journal->path);
    }
    if (head->order == other_byte_order) {
        return dea_fail(error, DEA_ERROR_USAGE, "%s was written by a machine of the other byte order", journal->path);
    }
    if (head->order != byte_order || head->identity > IDENTITY_MOST) {
        return dea_fail(error, DEA_ERROR_USAGE, "%s is damaged in its header", journal->path);
    }
    return DEA_OK;
}

/* What the header says of the study. */
static dea_status head_match(const dea_journal *journal, const journal_head *head, const char *identity, dea_error *error)
{
    const dea_journal_study *study = journal->study;
    if (head->digest != head_digest(head, identity)) {
        return dea_fail(error, DEA_ERROR_USAGE, "%s is damaged in its header", journal->path);
    }
    if (strcmp(identity, study->identity) != 0) {
        char difference[DEA_IDENTITY_DIFFERENCE];
        dea_identity_compare(identity, study->identity, difference);
        return dea_fail(error, DEA_ERROR_USAGE, "%s belongs to another study: %s", journal->path, difference);
    }
    if (head->points != study->cut.total || head->block != study->cut.block || head->packed != study->packed) {
        return dea_fail(error, DEA_ERROR_USAGE, "%s belongs to another study: its blocks are cut in another way", journal->path);
    }
    if (head->number < 1 || head->number > head->count || head->count > SIZE_MAX / 2) {
        return dea_fail(error, DEA_ERROR_USAGE, "%s is damaged in its header", journal->path);
    }
    return DEA_OK;
}

/* Reads the header and finds the shard in it. */
static dea_status head_read(dea_journal *journal, dea_error *error)
{
    journal_head head;
    dea_stream in = dea_stream_begin(journal->fd, 0, journal->room);
    if (!dea_stream_get(&in, &head, sizeof head)) {
        return errno ? fail_io(error, "read", journal->path)
                     : dea_fail(error, DEA_ERROR_USAGE, "%s is cut short in its header", journal->path);
    }
    dea_status status = head_check(journal, &head, error);
    if (status != DEA_OK) {
        return status;
    }
    char *identity = calloc(1, head.identity + 1);
    if (!identity) {
        return dea_fail(error, DEA_ERROR_MEMORY, "out of memory");
    }
    if (dea_stream_get(&in, identity, head.identity)) {
        status = head_match(journal, &head, identity, error);
    } else if (errno) {
        status = fail_io(error, "read", journal->path);
    } else {
        status = dea_fail(error, DEA_ERROR_USAGE, "%s is cut short in its header", journal->path);
    }
    free(identity);
    journal->shard = (dea_shard){(size_t)head.number, (size_t)head.count};
    journal->end = sizeof head + head.identity;
    return status;
}

/* ---- records ---- */

static uint64_t record_digest(const record_head *head)
{
    dea_digest digest = dea_digest_begin();
    dea_digest_take(&digest, head, offsetof(record_head, digest));
    return dea_digest_end(&digest);
}

/* Bytes of a record. */
static uint64_t record_size(const dea_journal *journal, size_t count)
{
    return sizeof(record_head) + (uint64_t)count * journal->study->packed + sizeof(uint64_t);
}

static bool point_put(const dea_layout *layout, dea_stream *out, const char *point)
{
    bool fine = true;
    for (size_t i = 0; i < layout->rows && fine; i++) {
        const char *row = point + i * layout->row_size;
        unsigned char packed[ROW_MOST];
        for (size_t k = 0; k < layout->column_count; k++) {
            memcpy(packed + k * sizeof(double), row + layout->columns[k].offset, sizeof(double));
        }
        packed[layout->column_count * sizeof(double)] = (unsigned char)dea_layout_state(layout, row);
        fine = dea_stream_put(out, packed, layout->column_count * sizeof(double) + 1);
    }
    const size_t rows = layout->rows * layout->row_size;
    return fine && dea_stream_put(out, point + rows, layout->point_size - rows);
}

static bool point_get(const dea_layout *layout, dea_stream *in, char *point)
{
    for (size_t i = 0; i < layout->rows; i++) {
        char *row = point + i * layout->row_size;
        unsigned char packed[ROW_MOST];
        if (!dea_stream_get(in, packed, layout->column_count * sizeof(double) + 1)) {
            return false;
        }
        for (size_t k = 0; k < layout->column_count; k++) {
            memcpy(row + layout->columns[k].offset, packed + k * sizeof(double), sizeof(double));
        }
        const dea_state state = (dea_state)packed[layout->column_count * sizeof(double)];
        if (packed[layout->column_count * sizeof(double)] >= DEA_STATE_COUNT) {
            errno = 0;
            return false;
        }
        memcpy(row + layout->state_offset, &state, sizeof state);
    }
    const size_t rows = layout->rows * layout->row_size;
    return dea_stream_get(in, point + rows, layout->point_size - rows);
}

/* The digest at the end of a record; false with errno where it cannot be read, 0 where it is another one. */
static bool digest_get(dea_stream *in)
{
    uint64_t there;
    const uint64_t wanted = dea_digest_end(&in->digest);
    if (!dea_stream_get(in, &there, sizeof there)) {
        return false;
    }
    errno = 0;
    return there == wanted;
}

/* What is found at a place of the file. */
typedef enum record_kind {
    RECORD_WHOLE,
    RECORD_TORN,
    RECORD_DAMAGED,
    RECORD_FOREIGN,
    RECORD_TWICE,
    RECORD_UNREADABLE
} record_kind;

/* Verifies the points of the record at @p place. */
static record_kind record_verify(const dea_journal *journal, uint64_t place, const record_head *head)
{
    dea_stream in = dea_stream_begin(journal->fd, place, journal->room);
    if (dea_stream_get(&in, NULL, (size_t)(record_size(journal, (size_t)head->count) - sizeof(uint64_t))) && digest_get(&in)) {
        return RECORD_WHOLE;
    }
    return errno ? RECORD_UNREADABLE : RECORD_DAMAGED;
}

/* Reads so many bytes at a place; false with errno where the file ends before (errno 0) or fails. */
static bool bytes_at(const dea_journal *journal, uint64_t place, void *bytes, size_t size)
{
    size_t have = 0;
    while (have < size) {
        const ssize_t got = pread(journal->fd, (char *)bytes + have, size - have, (off_t)(place + have));
        if (got < 0 && errno == EINTR) {
            continue;
        }
        if (got <= 0) {
            errno = got < 0 ? errno : 0;
            return false;
        }
        have += (size_t)got;
    }
    return true;
}

static kept_block *kept_of(const dea_journal *journal, uint64_t block)
{
    return &journal->kept[block - journal->blocks.first];
}

/* The head of a record at @p place in a file of @p size bytes. */
static record_kind record_find(const dea_journal *journal, uint64_t place, uint64_t size, record_head *head)
{
    if (size - place < sizeof *head) {
        return RECORD_TORN;
    }
    if (!bytes_at(journal, place, head, sizeof *head)) {
        return errno ? RECORD_UNREADABLE : RECORD_TORN;
    }
    if ((head->mark != record_mark && head->mark != lost_mark) || head->digest != record_digest(head) ||
        head->block >= journal->study->cut.blocks ||
        head->count != dea_cut_range(&journal->study->cut, (size_t)head->block).count) {
        return RECORD_DAMAGED;
    }
    if (record_size(journal, (size_t)head->count) > size - place) {
        return RECORD_TORN;
    }
    if (head->block < journal->blocks.first || head->block - journal->blocks.first >= journal->blocks.count) {
        return RECORD_FOREIGN;
    }
    const kept_block *kept = kept_of(journal, head->block);
    return kept->place != 0 && !kept->lost ? RECORD_TWICE : RECORD_WHOLE;
}

/* Looks for the next head of a record behind place *@p place, to which it moves; to the end of the file where there is none. */
static dea_status record_next(const dea_journal *journal, uint64_t size, uint64_t *place, dea_error *error)
{
    const size_t overlap = sizeof(record_head) - 1;
    for (uint64_t from = *place + 1; size - from > overlap;) {
        const size_t here = size - from < DEA_STREAM_BUFFER ? (size_t)(size - from) : DEA_STREAM_BUFFER;
        if (!bytes_at(journal, from, journal->room, here)) {
            return fail_io(error, "read", journal->path);
        }
        for (size_t i = 0; i + overlap < here; i++) {
            record_head head;
            memcpy(&head, journal->room + i, sizeof head);
            if ((head.mark == record_mark || head.mark == lost_mark) && head.digest == record_digest(&head)) {
                *place = from + i;
                return DEA_OK;
            }
        }
        from += here - overlap;
    }
    *place = size;
    return DEA_OK;
}

static void record_keep(dea_journal *journal, const record_head *head, uint64_t place)
{
    const size_t count = (size_t)head->count;
    kept_block *kept = kept_of(journal, head->block);
    const bool lost = head->mark == lost_mark;
    journal->lost -= kept->lost ? count : 0;
    journal->lost += lost ? count : 0;
    journal->points += lost ? 0 : count;
    *kept = (kept_block){.place = place, .lost = lost};
}

static dea_status record_refuse(const dea_journal *journal, record_kind kind, const record_head *head, dea_error *error)
{
    if (kind == RECORD_TORN) {
        return dea_fail(error, DEA_ERROR_USAGE,
                        "%s is cut short: it ends within a block, behind %zu of its points; run that shard again with --resume",
                        journal->path, journal->points);
    }
    if (kind == RECORD_DAMAGED) {
        return dea_fail(error, DEA_ERROR_USAGE,
                        "%s is damaged at byte %" PRIu64 ", behind %zu of its points; run that shard again with --resume",
                        journal->path, journal->end, journal->points);
    }
    const dea_range range = dea_cut_range(&journal->study->cut, (size_t)head->block);
    return dea_fail(error, DEA_ERROR_USAGE,
                    kind == RECORD_TWICE ? "%s has points %zu to %zu twice" : "%s has points %zu to %zu, which its shard has not",
                    journal->path, range.place, range.place + range.count - 1);
}

/* Steps over what is no record at the end of those that are known, to the next head or, where there is none, ends them: at a torn
 * end, which is cut off, or with @p strict true refused. Nothing is cut off unless the file could be read to its end. */
static dea_status records_heal(dea_journal *journal, bool strict, record_kind kind, uint64_t *size, dea_error *error)
{
    uint64_t next = journal->end;
    const dea_status status = record_next(journal, *size, &next, error);
    if (status != DEA_OK) {
        return status;
    }
    if (next < *size) {
        journal->damage = journal->damaged > 0 ? journal->damage : journal->end;
        journal->damaged += next - journal->end;
        journal->end = next;
        return DEA_OK;
    }
    if (strict) {
        return record_refuse(journal, kind, NULL, error);
    }
    journal->cut = *size - journal->end;
    *size = journal->end;
    return ftruncate(journal->fd, (off_t)journal->end) == 0 ? DEA_OK : fail_io(error, "write", journal->path);
}

static void records_forget(dea_journal *journal, uint64_t begin)
{
    memset(journal->kept, 0, journal->blocks.count * sizeof *journal->kept);
    journal->end = begin;
    journal->points = journal->lost = 0;
}

/* Finds all records, also those behind a damaged one. With @p strict false a torn end is cut off. The points of all records are
 * verified, but for a strict search that meets one whole record after the other: they are verified when they are used. */
static dea_status records_find(dea_journal *journal, bool strict, dea_error *error)
{
    struct stat about;
    const uint64_t begin = journal->end;
    bool verify = !strict;
    if (fstat(journal->fd, &about) != 0) {
        return fail_io(error, "read", journal->path);
    }
    dea_status status = DEA_OK;
    for (uint64_t size = (uint64_t)about.st_size; journal->end < size && status == DEA_OK;) {
        record_head head;
        record_kind kind = record_find(journal, journal->end, size, &head);
        if (!verify && kind != RECORD_WHOLE) {
            records_forget(journal, begin);
            verify = true;
            continue;
        }
        if (verify && (kind == RECORD_WHOLE || kind == RECORD_TWICE)) {
            const record_kind verified = record_verify(journal, journal->end, &head);
            kind = verified == RECORD_WHOLE ? kind : verified;
        }
        if (kind == RECORD_UNREADABLE) {
            status = fail_io(error, "read", journal->path);
        } else if (kind == RECORD_FOREIGN || (kind == RECORD_TWICE && strict)) {
            status = record_refuse(journal, kind, &head, error);
        } else if (kind == RECORD_TORN || kind == RECORD_DAMAGED) {
            status = records_heal(journal, strict, kind, &size, error);
        } else {
            if (kind == RECORD_WHOLE) {
                record_keep(journal, &head, journal->end);
            }
            journal->end += record_size(journal, (size_t)head.count);
        }
    }
    return status;
}

/* ---- a journal's life ---- */

static void journal_free(dea_journal *journal)
{
    free(journal->path);
    free(journal->kept);
    free(journal->room);
    free(journal);
}

static dea_journal *journal_new(const dea_journal_study *study, const char *path, dea_error *error)
{
    dea_journal *journal = calloc(1, sizeof *journal);
    if (journal) {
        *journal = (dea_journal){.study = study, .fd = -1};
        journal->path = strdup(path);
        journal->room = malloc(DEA_STREAM_BUFFER);
    }
    if (!journal || !journal->path || !journal->room) {
        if (journal) {
            journal_free(journal);
        }
        dea_fail(error, DEA_ERROR_MEMORY, "out of memory");
        return NULL;
    }
    return journal;
}

static dea_status journal_index(dea_journal *journal, dea_error *error)
{
    journal->blocks = dea_shard_blocks(journal->study, journal->shard);
    journal->kept = calloc(journal->blocks.count + 1, sizeof *journal->kept);
    return journal->kept ? DEA_OK : dea_fail(error, DEA_ERROR_MEMORY, "out of memory");
}

/* Locks the file; one that another process just removed or replaced is opened anew. A worker of a run that was killed may hold
 * the lock for a moment longer. */
static dea_status lock(dea_journal *journal, dea_error *error)
{
    const char *path = journal->path;
    for (int tries = 0; tries < LOCK_TRIES; tries++) {
        struct stat opened, named;
        journal->fd = open(path, O_RDWR | O_CREAT | O_CLOEXEC, 0666);
        if (journal->fd < 0 || fstat(journal->fd, &opened) != 0) {
            return fail_io(error, "write", path);
        }
        if (!S_ISREG(opened.st_mode)) {
            return dea_fail(error, DEA_ERROR_USAGE, "%s: a journal needs a regular file", path);
        }
        const bool locked = flock(journal->fd, LOCK_EX | LOCK_NB) == 0;
        if (!locked && errno != EWOULDBLOCK && errno != EINTR) {
            return fail_io(error, "lock", path);
        }
        if (locked && stat(path, &named) == 0 && named.st_ino == opened.st_ino && named.st_dev == opened.st_dev) {
            return DEA_OK;
        }
        close(journal->fd);
        journal->fd = -1;
        nanosleep(&(struct timespec){.tv_nsec = LOCK_WAIT_MS * 1000000L}, NULL);
    }
    return dea_fail(error, DEA_ERROR_USAGE, "%s is in use by another run", path);
}

/* A new journal gets its header; an older one must have it. */
static dea_status journal_start(dea_journal *journal, dea_error *error)
{
    struct stat about;
    const dea_shard shard = journal->shard;
    if (fstat(journal->fd, &about) != 0) {
        return fail_io(error, "read", journal->path);
    }
    if (head_is_torn(journal, (uint64_t)about.st_size)) {
        return head_write(journal, error);
    }
    const dea_status status = head_read(journal, error);
    if (status == DEA_OK && (journal->shard.number != shard.number || journal->shard.count != shard.count)) {
        return dea_fail(error, DEA_ERROR_USAGE, "%s is of shard %zu/%zu, not of %zu/%zu", journal->path, journal->shard.number,
                        journal->shard.count, shard.number, shard.count);
    }
    return status;
}

/* Hands over a journal whose opening came to @p status, or ends it. */
static dea_status journal_hand(dea_journal *opened, dea_status status, dea_journal **journal)
{
    if (status != DEA_OK) {
        dea_journal_close(opened, DEA_JOURNAL_STAYS, NULL, NULL);
        return status;
    }
    *journal = opened;
    return DEA_OK;
}

dea_status dea_journal_open(const dea_journal_study *study, dea_shard shard, const char *path, dea_journal **journal,
                            dea_error *error)
{
    *journal = NULL;
    dea_journal *opened = journal_new(study, path, error);
    if (!opened) {
        return DEA_ERROR_MEMORY;
    }
    opened->named = true;
    opened->shard = shard;
    dea_status status = lock(opened, error);
    status = status ? status : journal_start(opened, error);
    status = status ? status : journal_index(opened, error);
    status = status ? status : records_find(opened, false, error);
    opened->open = status == DEA_OK;
    return journal_hand(opened, status, journal);
}

dea_status dea_journal_create(const dea_journal_study *study, dea_shard shard, const char *target, dea_journal **journal,
                              dea_error *error)
{
    *journal = NULL;
    dea_journal *opened = journal_new(study, target, error);
    if (!opened) {
        return DEA_ERROR_MEMORY;
    }
    opened->shard = shard;
    dea_status status = dea_atomic_open(&opened->file, target, error);
    if (status == DEA_OK && opened->file.direct) {
        status = dea_fail(error, DEA_ERROR_USAGE, "%s: a part of a study needs a regular file", target);
    }
    opened->fd = opened->file.fd;
    status = status ? status : journal_index(opened, error);
    status = status ? status : head_write(opened, error);
    return journal_hand(opened, status, journal);
}

dea_status dea_journal_read(const dea_journal_study *study, const char *path, dea_journal **journal, dea_error *error)
{
    *journal = NULL;
    dea_journal *opened = journal_new(study, path, error);
    if (!opened) {
        return DEA_ERROR_MEMORY;
    }
    struct stat about;
    opened->named = true;
    opened->fd = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    dea_status status = DEA_OK;
    if (opened->fd < 0 || fstat(opened->fd, &about) != 0) {
        status = dea_fail(error, DEA_ERROR_USAGE, "cannot read %s: %s", path, strerror(errno));
    }
    if (status == DEA_OK && !S_ISREG(about.st_mode)) {
        status = dea_fail(error, DEA_ERROR_USAGE, "%s is no regular file", path);
    }
    status = status ? status : head_read(opened, error);
    status = status ? status : journal_index(opened, error);
    status = status ? status : records_find(opened, true, error);
    return journal_hand(opened, status, journal);
}

dea_journal_content dea_journal_tell(const dea_journal *journal)
{
    return (dea_journal_content){journal->shard, journal->points, journal->lost, journal->cut, journal->damaged};
}

bool dea_journal_wants(const dea_journal *journal, size_t block)
{
    return block >= journal->blocks.first && block - journal->blocks.first < journal->blocks.count &&
           (kept_of(journal, block)->place == 0 || kept_of(journal, block)->lost);
}

dea_status dea_journal_complete(const dea_journal *journal, dea_error *error)
{
    const kept_block *kept = journal->kept;
    size_t from = 0, to;
    char where[64] = "is not complete";
    while (from < journal->blocks.count && kept[from].place != 0) {
        from++;
    }
    if (from == journal->blocks.count) {
        return DEA_OK;
    }
    for (to = from; to < journal->blocks.count && kept[to].place == 0; to++) {
    }
    if (journal->damaged > 0) {
        snprintf(where, sizeof where, "is damaged at byte %" PRIu64, journal->damage);
    }
    const dea_stretch points = points_of(journal->study, (dea_stretch){journal->blocks.first + from, to - from});
    const size_t all = points_of(journal->study, journal->blocks).count;
    return dea_fail(error, DEA_ERROR_USAGE, "%s %s: points %zu to %zu are missing%s", journal->path, where, points.first,
                    points.first + points.count - 1,
                    journal->points + journal->lost + points.count < all ? ", and more" : "");
}

static void journal_sync(dea_journal *journal)
{
    if (fdatasync(journal->fd) != 0 && errno != EINVAL) {
        journal->broken = errno;
    }
    journal->waiting = 0.0;
}

void dea_journal_settle(dea_journal *journal)
{
    if (journal->waiting > 0.0 && dea_clock() - journal->waiting >= sync_interval) {
        journal_sync(journal);
    }
}

dea_status dea_journal_append(dea_journal *journal, size_t first, const void *points, size_t count, bool lost, dea_error *error)
{
    const dea_journal_study *study = journal->study;
    const size_t block = dea_cut_block(&study->cut, first);
    const dea_range range = dea_cut_range(&study->cut, block);
    if (!dea_journal_wants(journal, block) || range.place != first || range.count != count) {
        return dea_fail(error, DEA_ERROR_USAGE, "%s: %zu points from %zu on are no block that is missing", journal->path, count,
                        first);
    }
    record_head head = {.mark = lost ? lost_mark : record_mark, .block = block, .count = count};
    head.digest = record_digest(&head);
    dea_stream out = dea_stream_begin(journal->fd, journal->end, journal->room);
    bool fine = dea_stream_put(&out, &head, sizeof head);
    for (size_t i = 0; i < count && fine; i++) {
        fine = point_put(&study->layout, &out, (const char *)points + i * study->layout.point_size);
    }
    if (fine) {
        dea_digest digest = out.digest;
        dea_digest_take(&digest, out.buffer, out.held);
        const uint64_t last = dea_digest_end(&digest);
        fine = dea_stream_put(&out, &last, sizeof last) && dea_stream_flush(&out);
    }
    if (!fine) {
        const dea_status status = fail_io(error, "write", journal->path);
        return ftruncate(journal->fd, (off_t)journal->end) == 0 ? status : status; /* what stays is cut off later */
    }
    record_keep(journal, &head, journal->end);
    journal->end += record_size(journal, count);
    journal->waiting = journal->waiting > 0.0 ? journal->waiting : dea_clock();
    dea_journal_settle(journal);
    errno = journal->broken;
    return journal->broken ? fail_io(error, "write", journal->path) : DEA_OK;
}

/* Reads the points of block number @p block. */
static dea_status block_read(dea_journal *journal, size_t block, char *points, dea_error *error)
{
    const dea_journal_study *study = journal->study;
    const dea_range range = dea_cut_range(&study->cut, block);
    record_head head;
    dea_stream in = dea_stream_begin(journal->fd, kept_of(journal, block)->place, journal->room);
    bool fine = dea_stream_get(&in, &head, sizeof head);
    for (size_t i = 0; i < range.count && fine; i++) {
        fine = point_get(&study->layout, &in, points + i * study->layout.point_size);
    }
    fine = fine && digest_get(&in);
    if (!fine && errno) {
        return fail_io(error, "read", journal->path);
    }
    if (!fine) {
        return dea_fail(error, DEA_ERROR_USAGE,
                        "%s is damaged: points %zu to %zu do not match their digest; run that shard again with --resume", journal->path,
                        range.place, range.place + range.count - 1);
    }
    return DEA_OK;
}

dea_status dea_journal_replay(dea_journal *journal, const dea_run_options *options, dea_error *error)
{
    const dea_journal_study *study = journal->study;
    dea_status status = dea_journal_complete(journal, error);
    char *points = malloc(study->cut.block * study->layout.point_size);
    if (!points) {
        return dea_fail(error, DEA_ERROR_MEMORY, "out of memory for a block of %zu points", study->cut.block);
    }
    memset(points, 0, study->cut.block * study->layout.point_size);
    for (size_t i = 0; i < journal->blocks.count && status == DEA_OK; i++) {
        const dea_range range = dea_cut_range(&study->cut, journal->blocks.first + i);
        if (options->stop && options->stop(options->user)) {
            status = dea_fail(error, DEA_ERROR_INTERRUPTED, "interrupted");
        } else {
            status = block_read(journal, journal->blocks.first + i, points, error);
        }
        status = status ? status : options->points(options->user, range.place, points, range.count, error);
    }
    free(points);
    return status;
}

/* Brings the names in the folder of @p path to the disk. A file system that cannot do that is none of the caller's business. */
static void folder_sync(const char *path)
{
    const char *slash = strrchr(path, '/');
    char *folder = slash ? strndup(path, (size_t)(slash - path) + 1) : strdup(".");
    const int fd = folder ? open(folder, O_RDONLY | O_DIRECTORY | O_CLOEXEC) : -1;
    if (fd >= 0) {
        (void)fsync(fd);
        close(fd);
    }
    free(folder);
}

static dea_status part_place(dea_journal *journal, const char *target, dea_error *error)
{
    journal_sync(journal);
    errno = journal->broken;
    if (journal->broken) {
        return fail_io(error, "write", journal->path);
    }
    if (strcmp(journal->path, target) == 0) {
        return DEA_OK;
    }
    if (rename(journal->path, target) != 0) {
        return fail_io(error, "write", target);
    }
    folder_sync(target);
    return DEA_OK;
}

dea_status dea_journal_close(dea_journal *journal, dea_journal_end end, const char *target, dea_error *error)
{
    if (!journal) {
        return DEA_OK;
    }
    dea_status status = DEA_OK;
    if (!journal->named) {
        status = dea_atomic_close(&journal->file, end == DEA_JOURNAL_IS_PART, error);
        journal->fd = -1;
    } else if (end == DEA_JOURNAL_IS_PART) {
        status = part_place(journal, target, error);
    } else if (end == DEA_JOURNAL_GOES || (journal->open && journal->points == 0)) {
        folder_sync(journal->path); /* the result's name is on the disk before the journal's goes */
        unlink(journal->path);
    } else if (journal->open) {
        journal_sync(journal);
    }
    if (journal->fd >= 0) {
        close(journal->fd); /* and with it the lock */
    }
    journal_free(journal);
    return status;
}
