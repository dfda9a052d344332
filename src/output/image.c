#include "output/image.h"

#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { SIGNATURE = 8, CHUNK = 12, DEPTH = 64 };

static uint32_t number_at(const unsigned char *bytes)
{
    return (uint32_t)bytes[0] << 24 | (uint32_t)bytes[1] << 16 | (uint32_t)bytes[2] << 8 | bytes[3];
}

/* CRC-32 of ISO 3309, bit by bit. */
static uint32_t checksum(const unsigned char *bytes, size_t size)
{
    uint32_t rest = UINT32_MAX;
    for (size_t i = 0; i < size; i++) {
        rest ^= bytes[i];
        for (int bit = 0; bit < 8; bit++) {
            rest = rest >> 1 ^ (rest & 1 ? UINT32_C(0xedb88320) : 0);
        }
    }
    return ~rest;
}

bool dea_image_png_whole(const char *text, size_t size)
{
    const unsigned char *bytes = (const unsigned char *)text;
    static const unsigned char signature[SIGNATURE] = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
    if (size < SIGNATURE || memcmp(bytes, signature, SIGNATURE) != 0) {
        return false;
    }
    for (size_t at = SIGNATURE; size - at >= CHUNK;) { /* length, type, data, checksum of type and data */
        const size_t length = number_at(bytes + at);
        if (length > size - at - CHUNK || checksum(bytes + at + 4, length + 4) != number_at(bytes + at + 8 + length)) {
            return false;
        }
        if (memcmp(bytes + at + 4, "IEND", 4) == 0) {
            return at + CHUNK + length == size;
        }
        at += CHUNK + length;
    }
    return false;
}

/* Names of the open elements, in the text. */
typedef struct stack {
    const char *names[DEPTH];
    size_t lengths[DEPTH];
    size_t depth;
} stack;

static bool is_of_name(char letter)
{
    return (letter >= 'a' && letter <= 'z') || (letter >= 'A' && letter <= 'Z') || (letter >= '0' && letter <= '9') ||
           (letter != '\0' && strchr(":_-.", letter));
}

/* End of a tag that begins at @p at: its ">" outside of quotes; NULL where another begins before. */
static const char *tag_end(const char *at, const char *end)
{
    char quote = '\0';
    for (at++; at < end && *at != '<' && (*at != '>' || quote); at++) {
        quote = quote == *at ? '\0' : !quote && (*at == '"' || *at == '\'') ? *at : quote;
    }
    return at < end && *at == '>' ? at : NULL;
}

/* Takes a tag in; false where it closes another element than the last. */
static bool tag_take(stack *open, const char *tag, const char *last)
{
    const bool closes = tag[1] == '/';
    const char *name = tag + 1 + closes;
    size_t length = 0;
    while (name + length < last && is_of_name(name[length])) {
        length++;
    }
    if (tag[1] == '?' || tag[1] == '!') {
        return true;
    }
    if (!closes && last[-1] != '/') {
        open->names[open->depth] = name;
        open->lengths[open->depth] = length;
        return length > 0 && ++open->depth < DEPTH;
    }
    if (!closes) {
        return length > 0;
    }
    return open->depth-- > 0 && open->lengths[open->depth] == length && memcmp(open->names[open->depth], name, length) == 0;
}

bool dea_image_svg_whole(const char *text, size_t size)
{
    const char *end = text + size;
    stack open = {.depth = 0};
    bool ended = false;
    for (const char *at = memchr(text, '<', size); at; at = memchr(at, '<', (size_t)(end - at))) {
        const bool comment = end - at > 4 && memcmp(at, "<!--", 4) == 0;
        const char *last = comment ? memchr(at, '>', (size_t)(end - at)) : tag_end(at, end);
        if (!last || ended || !tag_take(&open, at, last)) {
            return false;
        }
        ended = open.depth == 0 && at[1] == '/';
        at = last;
    }
    return ended;
}

/* Number that follows the last @p word of the text, -1 without one. */
static long number_behind(const char *text, size_t size, const char *word)
{
    const size_t length = strlen(word);
    for (size_t at = size < length ? 0 : size - length; at > 0; at--) {
        if (memcmp(text + at, word, length) == 0) {
            return strtol(text + at + length, NULL, 10);
        }
    }
    return -1;
}

/* Entry number @p index of the table of objects: "offset generation n", of a used object "index generation obj" stands there. */
static bool object_stands(const char *text, size_t size, const char *entry, long index)
{
    char head[24];
    if (entry[17] != 'n') {
        return entry[17] == 'f';
    }
    const int length = snprintf(head, sizeof head, "%ld 0 obj", index);
    const long at = strtol(entry, NULL, 10);
    return at > 0 && (size_t)at + (size_t)length < size && memcmp(text + at, head, (size_t)length) == 0;
}

bool dea_image_pdf_whole(const char *text, size_t size)
{
    enum { ENTRY = 20 };
    static const char end[] = "%%EOF";
    long count = 0;
    int used = 0;
    while (size > 0 && (text[size - 1] == '\n' || text[size - 1] == '\r')) {
        size--;
    }
    const long table = size > 1024 && memcmp(text, "%PDF-", 5) == 0 ? number_behind(text, size, "startxref") : -1;
    if (table <= 0 || (size_t)table >= size - sizeof end || memcmp(text + size - sizeof end + 1, end, sizeof end - 1) != 0) {
        return false;
    }
    if (memcmp(text + table, "xref", 4) != 0) { /* a compressed table is an object */
        return sscanf(text + table, "%*d 0 ob%*c%n", &used) == 0 && used > 0;
    }
    if (sscanf(text + table, "xref 0 %ld%n", &count, &used) != 1 || count < 1 ||
        (size_t)count >= (size - (size_t)table) / ENTRY) {
        return false;
    }
    const char *entry = text + table + used + strspn(text + table + used, " \r\n");
    for (long i = 0; i < count; i++, entry += ENTRY) {
        if (!object_stands(text, size, entry, i)) {
            return false;
        }
    }
    return true;
}
