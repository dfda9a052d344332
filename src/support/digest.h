/* A 64-bit digest of bytes that come piece by piece, to find damage; no secret and no defence against forgers. Each step is a
 * bijection of the state for a given word, and of the word for a given state, so that a change within one word of 8 bytes never
 * goes unseen. Words are read in the byte order of the machine. */
#ifndef DEA_SUPPORT_DIGEST_H
#define DEA_SUPPORT_DIGEST_H

#include <stddef.h>
#include <stdint.h>

typedef struct dea_digest {
    uint64_t state;
    uint64_t length;       /* bytes taken */
    unsigned char rest[8]; /* the last length % 8 of them */
} dea_digest;

/* Digest of nothing yet. */
dea_digest dea_digest_begin(void);
/* Takes @p size bytes more. */
void dea_digest_take(dea_digest *digest, const void *bytes, size_t size);
/* Digest of all that was taken. */
uint64_t dea_digest_end(const dea_digest *digest);

#endif
