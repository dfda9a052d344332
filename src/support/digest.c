#include "support/digest.h"

#include <string.h>

static uint64_t step(uint64_t state, uint64_t word)
{
    state ^= word;
    state *= UINT64_C(0x9e3779b97f4a7c15); /* odd: a bijection */
    return state << 29 | state >> 35;
}

static uint64_t word_at(const unsigned char *bytes)
{
    uint64_t word;
    memcpy(&word, bytes, sizeof word);
    return word;
}

dea_digest dea_digest_begin(void)
{
    return (dea_digest){.state = UINT64_C(0x243f6a8885a308d3)};
}

void dea_digest_take(dea_digest *digest, const void *bytes, size_t size)
{
    const unsigned char *next = bytes;
    for (size_t used = digest->length % 8; size > 0 && (used > 0 || size < 8); size--) {
        digest->rest[used++] = *next++;
        digest->length++;
        if (used == 8) {
            digest->state = step(digest->state, word_at(digest->rest));
            used = 0;
        }
    }
    for (; size >= 8; size -= 8, next += 8, digest->length += 8) {
        digest->state = step(digest->state, word_at(next));
    }
    if (size > 0) {
        memcpy(digest->rest, next, size);
        digest->length += size;
    }
}

uint64_t dea_digest_end(const dea_digest *digest)
{
    unsigned char last[8] = {0};
    memcpy(last, digest->rest, digest->length % 8);
    uint64_t state = step(step(digest->state, word_at(last)), digest->length);
    state ^= state >> 32; /* what the last words changed reaches all bits */
    state *= UINT64_C(0x9e3779b97f4a7c15);
    return state ^ state >> 29;
}
