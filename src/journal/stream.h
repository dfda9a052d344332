/* Bytes to or from a place in a file, through a buffer, with their digest. The file's own position stays where it is. */
#ifndef DEASPICE_JOURNAL_STREAM_H
#define DEASPICE_JOURNAL_STREAM_H

#include <stdbool.h>

#include "support/digest.h"

enum { DEA_STREAM_BUFFER = 1 << 18 };

typedef struct dea_stream {
    int fd;
    uint64_t at;           /* place in the file behind the buffer's content when reading, of its begin when writing */
    dea_digest digest;     /* of all bytes that were read, or that left the buffer */
    unsigned char *buffer; /* DEA_STREAM_BUFFER bytes, lent */
    size_t next, held;     /* of the buffer: next byte, bytes in it */
} dea_stream;

/* A stream from place @p at on. */
dea_stream dea_stream_begin(int fd, uint64_t at, unsigned char *buffer);
/* Reads @p size bytes; false with errno where the file ends before (errno 0) or fails. @p bytes NULL: only their digest. */
bool dea_stream_get(dea_stream *stream, void *bytes, size_t size);
/* Writes @p size bytes, at most DEA_STREAM_BUFFER; false with errno. */
bool dea_stream_put(dea_stream *stream, const void *bytes, size_t size);
/* Writes what is in the buffer; false with errno. */
bool dea_stream_flush(dea_stream *stream);

#endif
