#include "journal/stream.h"

#include <errno.h>
#include <string.h>
#include <unistd.h>

dea_stream dea_stream_begin(int fd, uint64_t at, unsigned char *buffer)
{
    return (dea_stream){.fd = fd, .at = at, .digest = dea_digest_begin(), .buffer = buffer};
}

static bool stream_fill(dea_stream *stream)
{
    ssize_t got;
    do {
        got = pread(stream->fd, stream->buffer, DEA_STREAM_BUFFER, (off_t)stream->at);
    } while (got < 0 && errno == EINTR);
    if (got <= 0) {
        errno = got < 0 ? errno : 0;
        return false;
    }
    stream->at += (uint64_t)got;
    stream->next = 0;
    stream->held = (size_t)got;
    return true;
}

bool dea_stream_get(dea_stream *stream, void *bytes, size_t size)
{
    unsigned char *out = bytes;
    while (size > 0) {
        if (stream->next == stream->held && !stream_fill(stream)) {
            return false;
        }
        const size_t here = stream->held - stream->next, taken = size < here ? size : here;
        const unsigned char *from = stream->buffer + stream->next;
        dea_digest_take(&stream->digest, from, taken);
        if (out) {
            memcpy(out, from, taken);
            out += taken;
        }
        stream->next += taken;
        size -= taken;
    }
    return true;
}

bool dea_stream_flush(dea_stream *stream)
{
    const unsigned char *next = stream->buffer;
    dea_digest_take(&stream->digest, next, stream->held);
    while (stream->held > 0) {
        const ssize_t written = pwrite(stream->fd, next, stream->held, (off_t)stream->at);
        if (written < 0 && errno == EINTR) {
            continue;
        }
        if (written <= 0) {
            errno = written < 0 ? errno : EIO;
            return false;
        }
        next += written;
        stream->at += (uint64_t)written;
        stream->held -= (size_t)written;
    }
    return true;
}

bool dea_stream_put(dea_stream *stream, const void *bytes, size_t size)
{
    if (stream->held + size > DEA_STREAM_BUFFER && !dea_stream_flush(stream)) {
        return false;
    }
    memcpy(stream->buffer + stream->held, bytes, size);
    stream->held += size;
    return true;
}
